//! Counts of a mid-surface.

use mesh_kernel::TriMesh;
use mesh_kernel::query::Adjacency;

use super::seams::Merged;

/// Counts of a mesh in which any number of faces may meet at an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Topology {
    /// Curves of edges with three and more faces, cut where they branch or end.
    pub(super) joints: usize,
    /// Independent cycles of edges with one face.
    pub(super) free_loops: usize,
    /// Parts that hang together, if only by a node.
    pub(super) components: usize,
}

impl Topology {
    /// Counts. O(n log n).
    pub(super) fn of(mesh: &TriMesh) -> Self {
        let adjacency = Adjacency::new(mesh);
        let of_faces = |wanted: fn(usize) -> bool| -> Vec<[u32; 2]> {
            let all = adjacency.edges().iter().zip(0u32..);
            all.filter(|(_, e)| wanted(adjacency.half_edges(*e).len())).map(|(ends, _)| *ends).collect()
        };
        let nodes = mesh.positions.len();
        let (free, junction) = (of_faces(|n| n == 1), of_faces(|n| n > 2));
        let (free_nodes, free_parts) = parts(nodes, free.iter().copied());
        Self {
            joints: curves(nodes, &junction),
            free_loops: free.len() + free_parts - free_nodes,
            components: components(nodes, &mesh.faces),
        }
    }
}

/// In how many parts faces hang together, if only by a node. O(n log n).
pub(super) fn components(nodes: usize, faces: &[[u32; 3]]) -> usize {
    parts(nodes, faces.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c]])).1
}

/// How many nodes some edges have, and in how many parts they hang together.
fn parts(nodes: usize, edges: impl IntoIterator<Item = [u32; 2]>) -> (usize, usize) {
    let mut merged = Merged::new(nodes);
    let mut used = vec![false; nodes];
    for [a, b] in edges {
        merged.join(a, b);
        used[a as usize] = true;
        used[b as usize] = true;
    }
    merged.flatten();
    let count = used.iter().filter(|u| **u).count();
    let roots = (0..nodes as u32).filter(|v| used[*v as usize] && merged.find(*v) == *v).count();
    (count, roots)
}

/// How many curves some edges make, cut where other than two meet.
fn curves(nodes: usize, edges: &[[u32; 2]]) -> usize {
    let mut degree = vec![0u32; nodes];
    for v in edges.iter().flatten() {
        degree[*v as usize] += 1;
    }
    // Edges that share a node of two belong to one curve.
    let mut merged = Merged::new(edges.len());
    let mut first = vec![u32::MAX; nodes];
    for (e, ends) in (0u32..).zip(edges) {
        for v in ends.map(|v| v as usize).into_iter().filter(|v| degree[*v] == 2) {
            if first[v] == u32::MAX {
                first[v] = e;
            } else {
                merged.join(first[v], e);
            }
        }
    }
    (0..edges.len() as u32).filter(|e| merged.find(*e) == *e).count()
}
