//! The solid that is deflated: one closed, oriented skin without crossings.

use std::collections::BTreeMap;

use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::query::{Adjacency, Crossings, RayCaster};

use super::DeflateError;
use super::seams::Merged;
use crate::cleaning::weld;

/// A face whose height is less than this share of its longest side has no normal of its own.
const FLAT: f64 = 1e-9;
/// Sharply turned away from all about them, faces that are lower than this share of the solid's size, and smaller together than a
/// square on the other, have none either: tessellations are so rough at the poles of round faces and in small fillets. The ends of a thin
/// wall are as low, but lead on.
const LOW: f64 = 3e-4;
pub(super) const SPECK: f64 = 1e-3;
/// Edges that fold by more than this, in radians, are sharp: no tessellation of a smooth face is so coarse.
pub(super) const SHARP: f64 = 40.0 / 180.0 * std::f64::consts::PI;

/// A closed skin with what is asked of its faces again and again.
#[derive(Debug)]
pub(super) struct Solid {
    /// Nodes in one place are one; faces are wound outward; groups are gone.
    pub(super) mesh: TriMesh,
    /// For rays through it.
    pub(super) caster: RayCaster,
    pub(super) adjacency: Adjacency,
    /// Unit normals; of a face that has none of its own, that of the neighbour across its longest side.
    pub(super) normals: Vec<DVec3>,
    /// Areas in mm².
    pub(super) areas: Vec<f64>,
    /// Diagonal of the bounding box.
    pub(super) size: f64,
    /// By how much its file rounds coordinates, in mm; 0 if hardly.
    pub(super) rounding: f64,
    /// Volume in mm³.
    pub(super) volume: f64,
}

impl Solid {
    /// Cleans a solid and makes sure that it is one. O(n log n).
    pub(super) fn new(input: &TriMesh) -> Result<Self, DeflateError> {
        if let Some(node) = input.positions.iter().position(|p| !p.is_finite()) {
            return Err(DeflateError::NotFinite { node: node as u32 });
        }
        let (positions, node) = weld(&input.positions);
        let faces = input.faces.iter().map(|f| f.map(|v| node[v as usize]));
        // A face with two nodes in one place is an edge; leaving it out closes the gap by itself.
        let (sources, faces): (Vec<u32>, Vec<[u32; 3]>) =
            (0..).zip(faces).filter(|(_, [a, b, c])| a != b && b != c && c != a).unzip();
        let mut mesh = TriMesh::new(positions, faces);
        let size = mesh.bounds().map_or(0.0, |[lo, hi]| (hi - lo).length());
        let area: f64 = (0..mesh.faces.len() as u32).map(|f| mesh.area_normal(f).length()).sum::<f64>() / 2.0;
        if !(area > 0.0 && size > 0.0) {
            return Err(DeflateError::Empty);
        }
        let mut adjacency = Adjacency::new(&mesh);
        check_closed(&mesh, &adjacency, &sources)?;
        let crossings = Crossings::new(&mesh);
        let pairs = crossings.self_crossing();
        if let Some(&(f, g)) = pairs.first() {
            let pairs = pairs.len();
            let [a, b, c] = mesh.corners(f);
            let faces = [sources[f as usize], sources[g as usize]];
            return Err(DeflateError::SelfCrossing { pairs, faces, at: (a + b + c) / 3.0 });
        }
        let mut volume = volume(&mesh);
        if volume < 0.0 {
            mesh.faces.iter_mut().for_each(|f| f.swap(1, 2));
            adjacency = Adjacency::new(&mesh);
            volume = -volume;
        }
        let caster = crossings.caster(&mesh);
        let (normals, areas) = normals_and_areas(&mesh, &adjacency, size);
        Ok(Self { mesh, caster, adjacency, normals, areas, size, rounding: 0.0, volume })
    }

    /// The same faces with nodes in other places; `None` if they would cross each other.
    pub(super) fn with_nodes_at(&self, positions: Vec<DVec3>) -> Option<Self> {
        let mesh = TriMesh::new(positions, self.mesh.faces.clone());
        let crossings = Crossings::new(&mesh);
        if !crossings.self_crossing().is_empty() {
            return None;
        }
        let caster = crossings.caster(&mesh);
        let adjacency = Adjacency::new(&mesh);
        let (normals, areas) = normals_and_areas(&mesh, &adjacency, self.size);
        let volume = volume(&mesh);
        let Self { size, rounding, .. } = *self;
        Some(Self { mesh, caster, adjacency, normals, areas, size, rounding, volume })
    }

    /// How many faces there are.
    pub(super) fn len(&self) -> u32 {
        self.mesh.faces.len() as u32
    }

    /// In how many parts it is, cavities left out. O(n log n).
    pub(super) fn parts(&self) -> usize {
        let mut merged = Merged::new(self.mesh.positions.len());
        for [a, b, c] in &self.mesh.faces {
            merged.join(*a, *b);
            merged.join(*b, *c);
        }
        merged.flatten();
        let mut volumes: BTreeMap<u32, f64> = BTreeMap::new();
        let about = self.mesh.positions.first().copied().unwrap_or_default();
        for (f, face) in (0u32..).zip(&self.mesh.faces) {
            *volumes.entry(merged.find(face[0])).or_default() += six_volumes(&self.mesh, f, about);
        }
        volumes.values().filter(|volume| **volume > 0.0).count()
    }

    /// The face across side `h` (three times the face, and the side).
    pub(super) fn across(&self, h: u32) -> u32 {
        // The skin is closed, so there is one.
        self.adjacency.partner(h).map_or(h / 3, |p| p / 3)
    }

    /// The middle of a face.
    pub(super) fn centroid(&self, f: u32) -> DVec3 {
        let [a, b, c] = self.mesh.corners(f);
        (a + b + c) / 3.0
    }

    /// Cosine of the angle between the normals at a side.
    pub(super) fn fold_cosine(&self, h: u32) -> f64 {
        self.normals[h as usize / 3].dot(self.normals[self.across(h) as usize])
    }

    /// The length of a side, in mm.
    pub(super) fn length(&self, h: u32) -> f64 {
        let [a, b] = self.adjacency.ends(h).map(|v| self.mesh.positions[v as usize]);
        a.distance(b)
    }

    /// The length of a side times the angle by which its faces bend away from each other, or if less than nothing, towards each
    /// other; in mm and radians.
    pub(super) fn bend(&self, h: u32) -> f64 {
        let bend = self.length(h) * self.fold_cosine(h).clamp(-1.0, 1.0).acos();
        if self.is_convex(h) { bend } else { -bend }
    }

    /// Whether material fills less than half of the space about a side: its faces bend away from each other.
    pub(super) fn is_convex(&self, h: u32) -> bool {
        let other = self.across(h);
        let [a, _] = self.adjacency.ends(h);
        let away = self.centroid(other) - self.mesh.positions[a as usize];
        self.normals[h as usize / 3].dot(away) < 0.0
    }
}

fn check_closed(mesh: &TriMesh, adjacency: &Adjacency, sources: &[u32]) -> Result<(), DeflateError> {
    let middle = |e: u32| {
        let [a, b] = adjacency.edges()[e as usize].map(|v| mesh.positions[v as usize]);
        (a + b) / 2.0
    };
    let (mut open, mut wrong) = (Vec::new(), Vec::new());
    for e in 0..adjacency.edges().len() as u32 {
        match adjacency.half_edges(e) {
            [_] => open.push(e),
            [a, b] if adjacency.ends(*a) != adjacency.ends(*b) => {}
            _ => wrong.push(e),
        }
    }
    if let Some(&first) = open.first() {
        let face = adjacency.half_edges(first).first().map_or(0, |h| sources[*h as usize / 3]);
        return Err(DeflateError::Open { edges: open.len(), face, at: middle(first) });
    }
    match wrong.first() {
        Some(&first) => Err(DeflateError::NotManifold { edges: wrong.len(), at: middle(first) }),
        None => Ok(()),
    }
}

/// Six-fold sums are taken about a node, where digits are not lost.
fn volume(mesh: &TriMesh) -> f64 {
    let about = mesh.positions.first().copied().unwrap_or_default();
    (0..mesh.faces.len() as u32).map(|f| six_volumes(mesh, f, about)).sum::<f64>() / 6.0
}

/// Six times the volume between a face and a point, in mm³.
fn six_volumes(mesh: &TriMesh, f: u32, about: DVec3) -> f64 {
    let [a, b, c] = mesh.corners(f).map(|p| p - about);
    a.cross(b).dot(c)
}

fn normals_and_areas(mesh: &TriMesh, adjacency: &Adjacency, size: f64) -> (Vec<DVec3>, Vec<f64>) {
    let longest = |f: u32| {
        let [a, b, c] = mesh.corners(f);
        let sides = [b - a, c - b, a - c].map(DVec3::length_squared);
        let k = (0..3).max_by(|a, b| sides[*a].total_cmp(&sides[*b])).unwrap_or(0);
        (3 * f + k as u32, sides[k])
    };
    let mut without = Vec::new();
    let mut normals = Vec::with_capacity(mesh.faces.len());
    let mut areas = Vec::with_capacity(mesh.faces.len());
    for f in 0..mesh.faces.len() as u32 {
        let normal = mesh.area_normal(f);
        let is_flat = normal.length() <= FLAT * longest(f).1;
        if is_flat {
            without.push(f);
        }
        normals.push(if is_flat { DVec3::ZERO } else { normal.normalize() });
        areas.push(normal.length() / 2.0);
    }
    let is_low = |f: u32| 2.0 * areas[f as usize] < LOW * size * longest(f).1.sqrt();
    let away = turned_away(adjacency, &normals, &areas, is_low, SPECK * SPECK * size * size);
    away.iter().for_each(|f| normals[*f as usize] = DVec3::ZERO);
    without.extend(away);
    // They may lie in rows; each round reaches one more.
    for _ in 0..8 {
        without.retain(|f| {
            let partner = adjacency.partner(longest(*f).0).map(|h| normals[h as usize / 3]);
            normals[*f as usize] = partner.unwrap_or_default();
            normals[*f as usize] == DVec3::ZERO
        });
    }
    // Two that have their longest side in common look at their other sides.
    for _ in 0..8 {
        without.retain(|f| {
            let partners = (3 * f..3 * f + 3).filter_map(|h| adjacency.partner(h));
            let found = partners.map(|h| normals[h as usize / 3]).find(|n| *n != DVec3::ZERO);
            normals[*f as usize] = found.unwrap_or_default();
            found.is_none()
        });
    }
    without.iter().for_each(|f| normals[*f as usize] = DVec3::Z);
    (normals, areas)
}

/// Faces from which smooth ways lead only to low ones, and to no more than `most` mm². O(n).
fn turned_away(
    adjacency: &Adjacency,
    normals: &[DVec3],
    areas: &[f64],
    is_low: impl Fn(u32) -> bool,
    most: f64,
) -> Vec<u32> {
    let mut seen = vec![false; normals.len()];
    let mut away = Vec::new();
    for seed in (0..normals.len() as u32).filter(|f| is_low(*f)) {
        if std::mem::replace(&mut seen[seed as usize], true) {
            continue;
        }
        let (mut reached, mut at, mut area, mut leads_on) = (vec![seed], 0, 0.0, false);
        while at < reached.len() && !leads_on {
            let f = reached[at];
            at += 1;
            area += areas[f as usize];
            for g in (3 * f..3 * f + 3).filter_map(|h| adjacency.partner(h)).map(|h| h / 3) {
                let is_smooth = normals[f as usize].dot(normals[g as usize]) > SHARP.cos();
                // What was seen from another one leads on, or this one had been reached from there.
                if is_smooth && !reached.contains(&g) {
                    leads_on |= std::mem::replace(&mut seen[g as usize], true);
                    reached.push(g);
                }
            }
            leads_on |= area > most || !is_low(f);
        }
        if !leads_on {
            away.extend(reached);
        }
    }
    away
}

/// Of a triangle, in mm.
pub(super) fn longest_side([a, b, c]: &[DVec3; 3]) -> f64 {
    a.distance(*b).max(b.distance(*c)).max(c.distance(*a))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three nodes of an arc across a fillet, as a face of their own: it stands up from the faces on both sides of it, which make one skin.
    #[test]
    fn needles_that_stand_up_face_as_those_beside_them() {
        let nodes = [[0.0, 0.0, 0.0], [4e-3, 0.0, 2e-4], [8e-3, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]];
        let faces = vec![[0, 1, 3], [1, 2, 3], [0, 4, 2], [0, 2, 1]];
        let mesh = TriMesh::new(nodes.map(DVec3::from).to_vec(), faces);
        let (normals, areas) = normals_and_areas(&mesh, &Adjacency::new(&mesh), 1.0);
        assert!(normals.iter().all(|n| n.z > 0.99), "{normals:?}");
        assert!(areas[3] > 0.0);
    }
}
