//! Which edges are cut so that a patch can lie flat.

use std::{cmp::Reverse, collections::BinaryHeap};

use glam::DVec3;

use super::topology::{CornerClasses, NONE, Topology, turning};
use crate::{HolePolicy, PatternError};

/// A patch opened along its cuts.
pub(crate) struct OpenPatch {
    pub(crate) topology: Topology,
    pub(crate) classes: CornerClasses,
    /// The cuts as paths of patch nodes.
    pub(crate) cut_paths: Vec<Vec<u32>>,
    /// Whether [`HolePolicy::Auto`] decided to leave a hole: worth another try when the result is poor.
    pub(crate) kept_holes: bool,
}

/// Opens `topology` along the given paths and, as the policy wants, along shortest paths between its rims.
/// `preferred[h]` marks half-edges on feature lines, along which cuts run at half the price.
pub(crate) fn open(
    name: &str,
    topology: &Topology,
    positions: &[DVec3],
    given: &[Vec<u32>],
    preferred: &[bool],
    policy: HolePolicy,
) -> Result<OpenPatch, PatternError> {
    let mut cut = vec![false; topology.twin.len()];
    let mut cut_paths = Vec::new();
    for path in given {
        for pair in path.windows(2) {
            for h in topology.half_edges(pair[0], pair[1]) {
                cut[h as usize] = topology.twin[h as usize] != NONE;
            }
        }
        cut_paths.extend(inner_runs(topology, path));
    }
    loop {
        let (open, classes) = topology.opened(&cut);
        let parts = open.components();
        if parts > 1 {
            return Err(PatternError::CutsThrough { patch: name.to_owned(), parts });
        }
        let loops = open.boundary_loops();
        if loops.is_empty() {
            return Err(PatternError::Closed { patch: name.to_owned() });
        }
        let handles = open.genus(loops.len());
        if handles > 0 {
            return Err(PatternError::Handles { patch: name.to_owned(), handles });
        }
        let space: Vec<DVec3> = classes.node_of.iter().map(|&v| positions[v as usize]).collect();
        let turn: Vec<f64> = loops.iter().map(|rim| turning(&open, &space, rim)).collect();
        let outer =
            (0..loops.len()).max_by(|&a, &b| turn[a].total_cmp(&turn[b]).then(b.cmp(&a))).unwrap_or(0);
        let must_cut = |i: usize| match policy {
            HolePolicy::Keep => false,
            HolePolicy::Cut => i != outer,
            HolePolicy::Auto => i != outer && turn[i] > -std::f64::consts::PI,
        };
        let Some(rim) = (0..loops.len()).find(|&i| must_cut(i)) else {
            return Ok(OpenPatch {
                kept_holes: loops.len() > 1 && policy == HolePolicy::Auto,
                topology: open,
                classes,
                cut_paths,
            });
        };
        let path = shortest_cut(&open, &space, &loops, rim, preferred);
        for &h in &path {
            cut[h as usize] = true;
        }
        let mut nodes: Vec<u32> = path.iter().map(|&h| topology.origin(h)).collect();
        nodes.extend(path.last().map(|&h| topology.head(h)));
        cut_paths.push(nodes);
    }
}

/// Maximal runs of a path along inner edges.
fn inner_runs(topology: &Topology, path: &[u32]) -> Vec<Vec<u32>> {
    let mut runs: Vec<Vec<u32>> = Vec::new();
    let mut open = false;
    for pair in path.windows(2) {
        let inner = topology.half_edges(pair[0], pair[1]).any(|h| topology.twin[h as usize] != NONE);
        match (inner, open) {
            (true, true) => runs[..].last_mut().into_iter().for_each(|r| r.push(pair[1])),
            (true, false) => runs.push(pair.to_vec()),
            _ => {}
        }
        open = inner;
    }
    runs
}

/// Half-edges of the cheapest path over inner edges from loop `rim` to any other loop (Dijkstra). A connected patch
/// with two loops always has one.
fn shortest_cut(
    open: &Topology,
    positions: &[DVec3],
    loops: &[Vec<u32>],
    rim: usize,
    preferred: &[bool],
) -> Vec<u32> {
    let n = open.node_count;
    let mut loop_of = vec![usize::MAX; n];
    for (i, one) in loops.iter().enumerate() {
        for &h in one {
            loop_of[open.origin(h) as usize] = i;
        }
    }
    // Outgoing inner half-edges by node.
    let mut start = vec![0u32; n + 1];
    for h in 0..open.twin.len() as u32 {
        start[open.origin(h) as usize + 1] += 1;
    }
    for v in 0..n {
        start[v + 1] += start[v];
    }
    let mut fill = start.clone();
    let mut out = vec![0u32; open.twin.len()];
    for h in 0..open.twin.len() as u32 {
        let v = open.origin(h) as usize;
        out[fill[v] as usize] = h;
        fill[v] += 1;
    }
    let mut cost = vec![f64::INFINITY; n];
    let mut came = vec![NONE; n];
    let mut heap = BinaryHeap::new();
    for &h in &loops[rim] {
        let v = open.origin(h);
        cost[v as usize] = 0.0;
        heap.push(Reverse((0u64, v)));
    }
    let mut end = None;
    while let Some(Reverse((bits, v))) = heap.pop() {
        // Non-negative doubles order like their bits.
        let so_far = f64::from_bits(bits);
        if so_far > cost[v as usize] {
            continue;
        }
        if loop_of[v as usize] != usize::MAX && loop_of[v as usize] != rim {
            end = Some(v);
            break;
        }
        for &h in &out[start[v as usize] as usize..start[v as usize + 1] as usize] {
            if open.twin[h as usize] == NONE {
                continue;
            }
            let w = open.head(h);
            if loop_of[w as usize] == rim {
                continue;
            }
            let length = positions[v as usize].distance(positions[w as usize]);
            let next_cost = so_far + if preferred[h as usize] { 0.5 * length } else { length };
            if next_cost < cost[w as usize] {
                cost[w as usize] = next_cost;
                came[w as usize] = h;
                heap.push(Reverse((next_cost.to_bits(), w)));
            }
        }
    }
    let mut path = Vec::new();
    let mut v = end.unwrap_or(NONE);
    while v != NONE && came[v as usize] != NONE {
        path.push(came[v as usize]);
        v = open.origin(came[v as usize]);
    }
    path.reverse();
    path
}
