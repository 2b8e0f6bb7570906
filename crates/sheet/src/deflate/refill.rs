//! Plane pieces triangulated anew where something else came to be joined to them.

use std::collections::{BTreeMap, BTreeSet};

use mesh_kernel::TriMesh;
use mesh_kernel::query::Adjacency;

use super::assemble::{Sheet, Source};
use super::fill::{Outline, fill};

impl Sheet {
    /// Fills some planes, given by their numbers, from their borders and the joints on them: what nodes were inside are gone, with the
    /// slivers that cutting made beside them. A plane that would lose an edge stays as it is. O(n log n).
    pub(super) fn refill(&mut self, numbers: &BTreeSet<u32>) {
        let adjacency = Adjacency::new(&TriMesh::new(self.positions.clone(), self.faces.clone()));
        let source = |h: u32| self.sources[h as usize / 3];
        let mut edges: BTreeMap<u32, Vec<[u32; 2]>> = BTreeMap::new();
        for e in 0..adjacency.edges().len() as u32 {
            let half_edges = adjacency.half_edges(e);
            let is_inside = half_edges.len() == 2 && source(half_edges[0]) == source(half_edges[1]);
            for &h in half_edges.iter().filter(|_| !is_inside) {
                match source(h) {
                    Source::Plane(k) if numbers.contains(&k) => {
                        edges.entry(k).or_default().push(adjacency.ends(h));
                    }
                    _ => {}
                }
            }
        }
        for (k, edges) in edges {
            let piece = &self.planes[k as usize];
            let outline = Outline { plane: piece.plane, edges, lines: vec![], inside: vec![] };
            let filled = fill(&outline, &self.positions, piece.cells);
            if filled.lost > 0 {
                continue;
            }
            let mut stays = self.sources.iter().map(|source| *source != Source::Plane(k));
            self.faces.retain(|_| stays.next().unwrap_or(true));
            self.sources.retain(|source| *source != Source::Plane(k));
            self.positions.extend(filled.added);
            self.sources.extend(filled.faces.iter().map(|_| Source::Plane(k)));
            self.faces.extend(filled.faces);
        }
    }
}
