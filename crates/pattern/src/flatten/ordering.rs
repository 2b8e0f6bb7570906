//! Nested dissection by coordinates: an elimination order with little fill for meshes.
//!
//! A. George, *Nested dissection of a regular finite element mesh*, 1973; halves are found by coordinates, which for
//! a surface patch is as good as a general graph partitioner and far cheaper.

use glam::DVec3;

/// Neighbours of every node, in one array.
pub(crate) struct Neighbours {
    start: Vec<u32>,
    list: Vec<u32>,
}

impl Neighbours {
    /// From undirected edges, each given once.
    pub(crate) fn new(nodes: usize, edges: &[[u32; 2]]) -> Self {
        let mut start = vec![0u32; nodes + 1];
        for e in edges {
            start[e[0] as usize + 1] += 1;
            start[e[1] as usize + 1] += 1;
        }
        for v in 0..nodes {
            start[v + 1] += start[v];
        }
        let mut fill = start.clone();
        let mut list = vec![0u32; 2 * edges.len()];
        for &[a, b] in edges {
            list[fill[a as usize] as usize] = b;
            fill[a as usize] += 1;
            list[fill[b as usize] as usize] = a;
            fill[b as usize] += 1;
        }
        Self { start, list }
    }

    pub(crate) fn of(&self, v: u32) -> &[u32] {
        &self.list[self.start[v as usize] as usize..self.start[v as usize + 1] as usize]
    }
}

/// Parts of this size are not divided any further.
const LEAF: usize = 12;

/// Position of every node in the elimination order. O(n log² n).
pub(crate) fn nested_dissection(positions: &[DVec3], neighbours: &Neighbours) -> Vec<u32> {
    let n = positions.len();
    let mut nodes: Vec<u32> = (0..n as u32).collect();
    let mut place = vec![0u32; n];
    // In which part of the current division a node lies: 2 k for the low half of division k, 2 k + 1 for the high.
    let mut side = vec![u32::MAX; n];
    let mut stamp = 0;
    divide(&mut nodes, 0, positions, neighbours, &mut side, &mut stamp, &mut place);
    place
}

fn divide(
    nodes: &mut [u32],
    first_place: u32,
    positions: &[DVec3],
    neighbours: &Neighbours,
    side: &mut [u32],
    stamp: &mut u32,
    place: &mut [u32],
) {
    if nodes.len() <= LEAF {
        for (i, &v) in nodes.iter().enumerate() {
            place[v as usize] = first_place + i as u32;
        }
        return;
    }
    let mut low = DVec3::INFINITY;
    let mut high = DVec3::NEG_INFINITY;
    for &v in nodes.iter() {
        low = low.min(positions[v as usize]);
        high = high.max(positions[v as usize]);
    }
    let size = high - low;
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let middle = nodes.len() / 2;
    nodes.select_nth_unstable_by(middle, |&a, &b| {
        positions[a as usize][axis].total_cmp(&positions[b as usize][axis]).then(a.cmp(&b))
    });
    *stamp += 1;
    let (mine, other) = (2 * *stamp, 2 * *stamp + 1);
    nodes[..middle].iter().for_each(|&v| side[v as usize] = mine);
    nodes[middle..].iter().for_each(|&v| side[v as usize] = other);
    // The separator: nodes of the high half that touch the low half.
    let mut rest = middle;
    for i in middle..nodes.len() {
        let v = nodes[i];
        if !neighbours.of(v).iter().any(|&w| side[w as usize] == mine) {
            nodes.swap(i, rest);
            rest += 1;
        }
    }
    let (inner, separator) = nodes.split_at_mut(rest);
    // Along the separator's own direction neighbours follow each other: less fill inside it.
    let run = if axis == 0 { 1 } else { 0 };
    separator.sort_unstable_by(|&a, &b| {
        positions[a as usize][run].total_cmp(&positions[b as usize][run]).then(a.cmp(&b))
    });
    for (i, &v) in separator.iter().enumerate() {
        place[v as usize] = first_place + rest as u32 + i as u32;
    }
    let (a, b) = inner.split_at_mut(middle);
    divide(a, first_place, positions, neighbours, side, stamp, place);
    divide(b, first_place + middle as u32, positions, neighbours, side, stamp, place);
}
