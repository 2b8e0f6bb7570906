//! A mesh whose nodes at exactly the same place are one: seams of files without shared nodes close.

use crate::TriMesh;
use crate::files::weld::{Welder, key};

/// The mesh with nodes at the same place made one; faces keep their order.
pub(super) fn welded(mesh: &TriMesh) -> TriMesh {
    let mut welder = Welder::<3>::with_capacity(mesh.positions.len());
    let mut positions = Vec::with_capacity(mesh.positions.len());
    let numbers: Vec<u32> = mesh
        .positions
        .iter()
        .map(|p| {
            let (number, new) = welder.number(p.to_array().map(key));
            if new {
                positions.push(*p);
            }
            number
        })
        .collect();
    TriMesh::new(positions, mesh.faces.iter().map(|face| face.map(|v| numbers[v as usize])).collect())
}
