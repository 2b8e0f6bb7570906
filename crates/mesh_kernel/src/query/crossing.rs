//! Faces of one mesh that cross faces of another, or of the same.

use glam::{DVec3, Vec4};
use rayon::prelude::*;

use super::RayCaster;
use super::bvh::{Bvh, Child};
use super::triangle_pair::{faces_meet_beyond_shared, triangles_meet};
use crate::TriMesh;

/// A mesh prepared for finding the faces of others that cross its own.
///
/// Boxes give candidates, exact predicates decide (touching counts as crossing). Faces with corners that are not finite
/// are left out.
#[derive(Clone, Debug)]
pub struct Crossings {
    bvh: Bvh,
    positions: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    /// Faces in the hierarchy; later ones are compared with these, not with each other.
    known: u32,
}

/// Faces that one thread handles at a time.
const CHUNK: usize = 512;

impl Crossings {
    /// Builds the hierarchy. O(n log n).
    pub fn new(mesh: &TriMesh) -> Self {
        Self::with_bvh(Bvh::new(mesh), mesh, mesh.faces.len())
    }

    /// Goes on as a caster of rays, with the same hierarchy; `mesh` is what this was made of, its faces wound either way. O(n).
    pub fn caster(self, mesh: &TriMesh) -> RayCaster {
        RayCaster::with_bvh(self.bvh, mesh)
    }

    /// With a hierarchy over the first `known` faces of the mesh alone.
    pub(super) fn with_bvh(bvh: Bvh, mesh: &TriMesh, known: usize) -> Self {
        Self { bvh, positions: mesh.positions.clone(), faces: mesh.faces.clone(), known: known as u32 }
    }

    /// All pairs (face of `other`, face of this mesh) that have a point in common, in ascending order. O(n log m) plus
    /// candidates; on all threads.
    pub fn faces_crossing(&self, other: &TriMesh) -> Vec<(u32, u32)> {
        self.collect(other.faces.len(), |f, candidates, pairs| {
            let triangle = other.corners(f);
            self.candidates(&triangle, 0, candidates);
            pairs.extend(
                candidates.iter().filter(|g| triangles_meet(&triangle, &self.corners(**g))).map(|g| (f, *g)),
            );
        })
    }

    /// All pairs of own faces (smaller number first, ascending) that have more in common than the nodes they share:
    /// self-intersections, contacts, folds flat onto a neighbour, duplicates.
    pub fn self_crossing(&self) -> Vec<(u32, u32)> {
        self.collect(self.faces.len(), |f, candidates, pairs| {
            // Every pair once; faces outside the hierarchy are never found.
            self.candidates(&self.corners(f), if f < self.known { f + 1 } else { 0 }, candidates);
            let meeting = candidates.iter().filter(|g| self.own_faces_meet(f, **g));
            pairs.extend(meeting.map(|g| (f.min(*g), f.max(*g))));
        })
    }

    fn collect(
        &self,
        faces: usize,
        find: impl Fn(u32, &mut Vec<u32>, &mut Vec<(u32, u32)>) + Sync,
    ) -> Vec<(u32, u32)> {
        let chunks: Vec<Vec<(u32, u32)>> = (0..faces.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let (mut candidates, mut pairs) = (Vec::new(), Vec::new());
                for f in chunk * CHUNK..((chunk + 1) * CHUNK).min(faces) {
                    find(f as u32, &mut candidates, &mut pairs);
                }
                pairs
            })
            .collect();
        chunks.concat()
    }

    fn corners(&self, f: u32) -> [DVec3; 3] {
        self.faces[f as usize].map(|v| self.positions[v as usize])
    }

    /// Own faces from number `first` on whose boxes meet the box of `triangle`, ascending.
    fn candidates(&self, triangle: &[DVec3; 3], first: u32, found: &mut Vec<u32>) {
        found.clear();
        let [a, b, c] = *triangle;
        if !(a.is_finite() && b.is_finite() && c.is_finite()) || self.bvh.order.is_empty() {
            return;
        }
        let (lo, hi) = (a.min(b).min(c), a.max(b).max(c));
        let (from, to) = (lo - self.bvh.origin, hi - self.bvh.origin);
        // Twice the rounding of the differences and of the conversion.
        let slack = (from.abs().max(to.abs()).max_element() + self.bvh.extent) * f64::from(f32::EPSILON);
        let (from, to) = ((from - slack).as_vec3().to_array(), (to + slack).as_vec3().to_array());
        let mut stack = vec![Child::ROOT];
        while let Some(child) = stack.pop() {
            match child.get() {
                Err(node) => {
                    let node = &self.bvh.nodes[node];
                    let mut apart = 0;
                    for axis in 0..3 {
                        apart |= node.lo[axis].cmpgt(Vec4::splat(to[axis])).bitmask();
                        apart |= node.hi[axis].cmplt(Vec4::splat(from[axis])).bitmask();
                    }
                    stack.extend((0..4).filter(|k| apart & (1 << k) == 0).map(|k| node.children[k]));
                }
                Ok(leaf) => {
                    for g in self.bvh.order[leaf].iter().filter(|g| **g >= first) {
                        let [a, b, c] = self.corners(*g);
                        if a.min(b).min(c).cmple(hi).all() && a.max(b).max(c).cmpge(lo).all() {
                            found.push(*g);
                        }
                    }
                }
            }
        }
        found.sort_unstable();
    }

    fn own_faces_meet(&self, f: u32, g: u32) -> bool {
        let at = |v: u32| self.positions[v as usize];
        faces_meet_beyond_shared(self.faces[f as usize], self.faces[g as usize], at)
    }
}
