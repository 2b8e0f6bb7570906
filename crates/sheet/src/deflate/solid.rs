//! The solid that is deflated: one closed, oriented skin without crossings.

use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::query::{Adjacency, Crossings, RayCaster};

use super::DeflateError;
use crate::cleaning::weld;

/// A face whose height is less than this share of its longest side has no normal of its own.
const FLAT: f64 = 1e-9;

/// A closed skin with what is asked of its faces again and again.
#[derive(Debug)]
pub(super) struct Solid {
    /// Nodes in one place are one; faces are wound outward; groups are gone.
    pub(super) mesh: TriMesh,
    /// For rays through it.
    pub(super) caster: RayCaster,
    pub(super) adjacency: Adjacency,
    /// Unit normals; of a face without area, that of the neighbour across its longest side.
    pub(super) normals: Vec<DVec3>,
    /// Areas in mm².
    pub(super) areas: Vec<f64>,
    /// Diagonal of the bounding box.
    pub(super) size: f64,
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
        let (normals, areas) = normals_and_areas(&mesh, &adjacency);
        Ok(Self { mesh, caster, adjacency, normals, areas, size, volume })
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
        let (normals, areas) = normals_and_areas(&mesh, &adjacency);
        let volume = volume(&mesh);
        Some(Self { mesh, caster, adjacency, normals, areas, size: self.size, volume })
    }

    /// How many faces there are.
    pub(super) fn len(&self) -> u32 {
        self.mesh.faces.len() as u32
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
    let six = |f: u32| {
        let [a, b, c] = mesh.corners(f).map(|p| p - about);
        a.cross(b).dot(c)
    };
    (0..mesh.faces.len() as u32).map(six).sum::<f64>() / 6.0
}

fn normals_and_areas(mesh: &TriMesh, adjacency: &Adjacency) -> (Vec<DVec3>, Vec<f64>) {
    let faces = 0..mesh.faces.len() as u32;
    let sides = |f: u32| {
        let [a, b, c] = mesh.corners(f);
        [b - a, c - b, a - c].map(DVec3::length_squared)
    };
    let mut flat = Vec::new();
    let mut normals = Vec::with_capacity(mesh.faces.len());
    let mut areas = Vec::with_capacity(mesh.faces.len());
    for f in faces {
        let normal = mesh.area_normal(f);
        let longest = sides(f).into_iter().fold(0.0, f64::max);
        if normal.length() <= FLAT * longest {
            flat.push(f);
            normals.push(DVec3::ZERO);
        } else {
            normals.push(normal.normalize());
        }
        areas.push(normal.length() / 2.0);
    }
    // Flat faces may lie in rows; each round reaches one more.
    for _ in 0..8 {
        for &f in &flat {
            if normals[f as usize] == DVec3::ZERO {
                let lengths = sides(f);
                let longest = (0..3).max_by(|a, b| lengths[*a].total_cmp(&lengths[*b])).unwrap_or(0);
                if let Some(partner) = adjacency.partner(3 * f + longest as u32) {
                    normals[f as usize] = normals[partner as usize / 3];
                }
            }
        }
    }
    for &f in &flat {
        if normals[f as usize] == DVec3::ZERO {
            normals[f as usize] = DVec3::Z;
        }
    }
    (normals, areas)
}
