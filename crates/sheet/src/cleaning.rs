//! What every use of a file's triangles begins with: nodes in one place are one, doubles are found, groups are told.

use glam::DVec3;
use mesh_kernel::TriMesh;

/// A face whose height is less than this share of its longest side has no area: its normal is rounding.
pub(crate) const FLAT: f64 = 1e-12;

/// The group of every face; faces in none are one more patch after the last group.
pub(crate) fn patch_of_faces(sheet: &TriMesh) -> Vec<u32> {
    let mut patches = vec![sheet.groups.len() as u32; sheet.faces.len()];
    for (g, group) in sheet.groups.iter().enumerate() {
        for f in group.faces.clone() {
            if let Some(patch) = patches.get_mut(f as usize) {
                *patch = g as u32;
            }
        }
    }
    patches
}

/// Nodes in exactly the same place become one: the positions that stay, in the order of their first node, and the new
/// number of every node.
pub(crate) fn weld(positions: &[DVec3]) -> (Vec<DVec3>, Vec<u32>) {
    // Adding zero turns −0 into 0, so that both are one place.
    let key = |v: u32| (positions[v as usize] + DVec3::ZERO).to_array().map(f64::to_bits);
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.sort_by_key(|&v| (key(v), v));
    let mut first = vec![0; positions.len()];
    for run in order.chunk_by(|&v, &w| key(v) == key(w)) {
        for &v in run {
            first[v as usize] = run[0];
        }
    }
    let (mut kept, mut node) = (Vec::with_capacity(positions.len()), vec![0; positions.len()]);
    for v in 0..positions.len() {
        node[v] = if first[v] as usize == v {
            kept.push(positions[v]);
            kept.len() as u32 - 1
        } else {
            node[first[v] as usize]
        };
    }
    (kept, node)
}

/// Whether another face before it has the same three nodes.
pub(crate) fn doubles(sheet: &TriMesh, node: &[u32]) -> Vec<bool> {
    let mut keys: Vec<([u32; 3], u32)> = sheet
        .faces
        .iter()
        .zip(0..)
        .map(|(corners, f)| {
            let mut key = corners.map(|v| node[v as usize]);
            key.sort_unstable();
            (key, f)
        })
        .collect();
    keys.sort_unstable();
    let mut doubled = vec![false; keys.len()];
    for pair in keys.windows(2) {
        doubled[pair[1].1 as usize] = pair[0].0 == pair[1].0;
    }
    doubled
}
