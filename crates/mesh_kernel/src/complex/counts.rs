//! Counts, the right side of the identity independent of the left.

use super::Complex;
use super::connected::Sets;
use super::homology::rank_of_faces;
use super::ids::{FaceId, Loop};
use crate::body::Counts;

impl Complex {
    /// Counts of the complex; `v − e + f − r = c − ch + cc`.
    ///
    /// The right side is found without the left: components by union–find over edges and over faces between their loops; holes of
    /// complexes by ranks over GF(2), a ring counting as a loop that a bridge joins to the outer one; cavities by the radial order
    /// of faces. O(all loops), and what the elimination of non-manifold edges costs.
    pub fn counts(&self) -> Counts {
        let mut sets = Sets::new(self.vertices.bound());
        // Edges and bridges of a spanning forest: the rank of the boundary of edges.
        let mut forest = 0;
        for (_, edge) in self.edges.iter() {
            let [a, b] = edge.ends;
            forest += i64::from(sets.union(a.0, b.0));
        }
        let mut rings = 0;
        for (_, face) in self.faces.iter() {
            let mut firsts = face.loops.iter().filter_map(|l| match l {
                Loop::Vertex(v) => Some(*v),
                Loop::Walk(walk) => walk.first().and_then(|d| self.origin(*d)),
            });
            if let Some(outer) = firsts.next() {
                for ring in firsts {
                    rings += 1;
                    forest += i64::from(sets.union(outer.0, ring.0));
                }
            }
        }
        let (v, e, f) = (self.vertices.len() as i64, self.edges.len() as i64, self.faces.len() as i64);
        let filled = i64::from(rank_of_faces(self.faces.iter().map(|(i, _)| self.loops(FaceId(i)))));
        Counts { v, e, f, r: rings, c: v - forest, ch: e + rings - forest - filled, cc: self.cavities() }
    }
}
