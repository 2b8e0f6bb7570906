//! Nodes in one place made one.

use glam::DVec3;

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
