//! Better triangles for curved pieces: diagonals turn, nodes inside move; how edges close is told in [`super::closing`].
//!
//! Borders, joints, and whatever a plane piece has a part in stay as they are. Operations run in passes over edges that have
//! nothing to do with each other, so the result does not depend on threads.

use std::collections::BTreeSet;

use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::query::Adjacency;
use rayon::prelude::*;

use super::assemble::{Sheet, Source};
use super::solid::Solid;
use super::star::Star;

/// Faces lean by no more than this, in radians, from what they came from.
const LEAN: f64 = 50.0 / 180.0 * std::f64::consts::PI;
/// Neighbours do not come to fold by more than this, in radians.
const FOLD: f64 = 24.0 / 180.0 * std::f64::consts::PI;
/// Faces do not become flatter than this: their height over their longest side.
pub(super) const FLATTEST: f64 = 0.1;
/// Opposite angles that sum up to more than a straight one and this, in radians, have the wrong diagonal.
const STRAIGHT: f64 = 1e-6;
/// Passes of turning diagonals.
const TURNS: usize = 8;
/// A node moves this share of the way to the middle of its faces.
const EASE: f64 = 0.5;

/// A diagonal that could turn.
pub(super) struct Diagonal<'a> {
    /// What the faces beside it came from.
    pub(super) sources: [Source; 2],
    /// Its nodes as it is, and as it would be.
    pub(super) old: [u32; 2],
    pub(super) new: [u32; 2],
    /// Where all nodes are.
    pub(super) positions: &'a [DVec3],
}

/// Whether a diagonal may turn.
pub(super) type May<'a> = dyn Fn(&Diagonal<'_>) -> bool + Sync + 'a;

/// A sheet with what its faces came from.
pub(super) struct Remesh<'a> {
    pub(super) solid: &'a Solid,
    /// Whether what came from each face of the solid stays as it is; empty: nothing does.
    pub(super) held: &'a [bool],
}

/// What is known of the nodes of a sheet.
pub(super) struct Nodes {
    pub(super) adjacency: Adjacency,
    pub(super) mesh: TriMesh,
    /// Whether each node is inside of a curved piece.
    pub(super) inside: Vec<bool>,
    pub(super) star: Star,
}

impl Nodes {
    /// The nodes beside one, each twice if it is inside.
    pub(super) fn about(&self, v: u32) -> impl Iterator<Item = u32> {
        self.faces(v).flat_map(|f| self.mesh.faces[f as usize]).filter(move |w| *w != v)
    }

    /// The faces at a node.
    pub(super) fn faces(&self, v: u32) -> impl Iterator<Item = u32> {
        self.star.of(v).iter().map(|c| c / 3)
    }
}

impl Remesh<'_> {
    /// The normal that a curved face had on the solid; none for what stays as it is.
    pub(super) fn normal(&self, sheet: &Sheet, f: u32) -> Option<DVec3> {
        self.free(sheet.sources[f as usize]).map(|source| self.solid.normals[source as usize])
    }

    /// What a face came from, if it is of a curved piece and not held.
    fn free(&self, source: Source) -> Option<u32> {
        match source {
            Source::Facet(f) => (!self.held.get(f as usize).is_some_and(|held| *held)).then_some(f),
            Source::Plane(_) => None,
        }
    }

    /// O(n log n).
    pub(super) fn nodes(&self, sheet: &Sheet) -> Nodes {
        let mesh = TriMesh::new(sheet.positions.clone(), sheet.faces.clone());
        let adjacency = Adjacency::new(&mesh);
        let mut inside = vec![true; sheet.positions.len()];
        for (face, source) in sheet.faces.iter().zip(&sheet.sources) {
            if self.free(*source).is_none() {
                face.iter().for_each(|v| inside[*v as usize] = false);
            }
        }
        for (e, ends) in (0u32..).zip(adjacency.edges()) {
            if !matches!(adjacency.half_edges(e), [h, k] if adjacency.ends(*h) != adjacency.ends(*k)) {
                ends.iter().for_each(|v| inside[*v as usize] = false);
            }
        }
        let star = Star::new(&mesh.faces, mesh.positions.len());
        Nodes { adjacency, mesh, inside, star }
    }

    /// Whether a face would stand too askew to what it came from.
    pub(super) fn leans(&self, sheet: &Sheet, f: u32, corners: [DVec3; 3]) -> bool {
        self.normal(sheet, f).is_some_and(|normal| unit_normal(corners).dot(normal) < LEAN.cos())
    }

    /// Turns diagonals until opposite angles are small (Delaunay's criterion), but for those that would fold more.
    /// `may` is asked about each.
    pub(super) fn turn(&self, sheet: &mut Sheet, may: &May) {
        for _ in 0..TURNS {
            let mesh = TriMesh::new(sheet.positions.clone(), sheet.faces.clone());
            let adjacency = Adjacency::new(&mesh);
            let turned = |e: u32| self.turned(sheet, &mesh, &adjacency, e, may);
            let mut found: Vec<(f64, [u32; 2], [[u32; 3]; 2])> =
                (0..adjacency.edges().len() as u32).into_par_iter().filter_map(turned).collect();
            found.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            let mut touched = vec![false; sheet.faces.len()];
            let mut made: BTreeSet<[u32; 2]> = BTreeSet::new();
            for (_, pair, faces) in found {
                let [_, d, c] = faces[0];
                if pair.iter().any(|f| touched[*f as usize]) || !made.insert([c.min(d), c.max(d)]) {
                    continue;
                }
                for (f, face) in pair.into_iter().zip(faces) {
                    touched[f as usize] = true;
                    sheet.faces[f as usize] = face;
                }
            }
            if made.is_empty() {
                return;
            }
        }
    }

    /// The faces about an edge with their other diagonal, if that one is better, and by how much.
    fn turned(
        &self,
        sheet: &Sheet,
        mesh: &TriMesh,
        adjacency: &Adjacency,
        e: u32,
        may: &May,
    ) -> Option<(f64, [u32; 2], [[u32; 3]; 2])> {
        let [h, k] = adjacency.half_edges(e) else { return None };
        let pair = [h / 3, k / 3];
        let [f, g] = pair;
        let (m, n) = (self.normal(sheet, f)?, self.normal(sheet, g)?);
        let [a, b] = adjacency.ends(*h);
        let apex = |h: u32| mesh.faces[h as usize / 3][(h as usize % 3 + 2) % 3];
        let (c, d) = (apex(*h), apex(*k));
        let at = |v: u32| mesh.positions[v as usize];
        let angle = |v: u32| (at(a) - at(v)).angle_between(at(b) - at(v));
        let excess = angle(c) + angle(d) - std::f64::consts::PI;
        let opposed = adjacency.ends(*k) == [b, a];
        if !(excess > STRAIGHT && opposed) || c == d || adjacency.find_edge(c, d).is_some() {
            return None;
        }
        let turned = [[a, d, c], [d, b, c]];
        let corners = turned.map(|face| face.map(at));
        let sound = corners.iter().zip(pair).all(|(corners, f)| !self.leans(sheet, f, *corners));
        let fold = |[p, q]: [[DVec3; 3]; 2]| unit_normal(p).dot(unit_normal(q));
        let before = fold(pair.map(|f| mesh.faces[f as usize].map(at)));
        let sound = sound && fold(corners) > before.min(FOLD.cos());
        // A fold that the solid has not goes in any case.
        let unasked = before < FOLD.cos() && m.dot(n) > FOLD.cos();
        let sources = pair.map(|f| sheet.sources[f as usize]);
        let diagonal = Diagonal { sources, old: [a, b], new: [c, d], positions: &mesh.positions };
        (sound && (unasked || may(&diagonal))).then_some((excess, pair, turned))
    }

    /// Moves nodes inside of curved pieces within the surface to the middle of their faces. O(n).
    pub(super) fn smooth(&self, sheet: &mut Sheet) {
        let nodes = self.nodes(sheet);
        let moved: Vec<Option<DVec3>> = (0..sheet.positions.len() as u32)
            .into_par_iter()
            .map(|v| {
                let star = nodes.star.of(v);
                if !nodes.inside[v as usize] || star.is_empty() {
                    return None;
                }
                let (mut normal, mut sum, mut weight) = (DVec3::ZERO, DVec3::ZERO, 0.0);
                let p = nodes.mesh.positions[v as usize];
                for c in star {
                    let [q, r, s] = nodes.mesh.corners(c / 3);
                    let across = (r - q).cross(s - q);
                    let area = across.length();
                    normal += across;
                    sum += ((q + r + s) / 3.0 - p) * area;
                    weight += area;
                }
                let normal = normal.normalize_or_zero();
                let step = sum / weight * EASE;
                let to = p + step - normal * normal.dot(step);
                let sound = star.iter().all(|c| {
                    let face = nodes.mesh.faces[*c as usize / 3];
                    let corners = face.map(|w| if w == v { to } else { nodes.mesh.positions[w as usize] });
                    !self.leans(sheet, c / 3, corners) && flatness(corners) > FLATTEST
                });
                sound.then_some(to)
            })
            .collect();
        for (p, to) in sheet.positions.iter_mut().zip(moved) {
            *p = to.unwrap_or(*p);
        }
    }
}

fn unit_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

/// The height of a triangle over its longest side.
pub(super) fn flatness([a, b, c]: [DVec3; 3]) -> f64 {
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    (b - a).cross(c - a).length() / (longest * longest).max(f64::MIN_POSITIVE)
}
