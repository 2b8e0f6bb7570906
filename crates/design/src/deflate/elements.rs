//! Numbers for finite elements: nodes in the middle of edges.

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use mesh_kernel::query::Adjacency;

/// A mesh with a node in the middle of every edge, numbered after the others.
pub(super) struct Quadratic {
    /// Corner nodes, then middles.
    pub(super) positions: Vec<DVec3>,
    /// The three corners, then the middles of the sides from each to the next.
    pub(super) elements: Vec<[u32; 6]>,
    /// The ends of the edge of every middle.
    pub(super) edges: Vec<[u32; 2]>,
}

/// Adds the middles; faces that share an edge share its middle. O(n log n).
pub(super) fn quadratic(mesh: &TriMesh) -> Quadratic {
    let adjacency = Adjacency::new(mesh);
    let first = mesh.positions.len() as u32;
    let middle = |[a, b]: [u32; 2]| (mesh.positions[a as usize] + mesh.positions[b as usize]) / 2.0;
    let mut positions = mesh.positions.clone();
    positions.extend(adjacency.edges().iter().map(|e| middle(*e)));
    let elements = (0..)
        .zip(&mesh.faces)
        .map(|(f, [a, b, c])| {
            let side = |k: u32| adjacency.edge_of(3 * f + k).map_or(*a, |e| first + e);
            [*a, *b, *c, side(0), side(1), side(2)]
        })
        .collect();
    Quadratic { positions, elements, edges: adjacency.edges().to_vec() }
}
