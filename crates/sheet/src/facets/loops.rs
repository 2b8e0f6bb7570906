//! The loops of every facet, as lines.

use std::collections::BTreeMap;

use super::Side;
use super::lines::{Shape, Traced};
use super::regions::Regions;

/// Loops of every facet: walks along its lines with the facet to the left. O(n log n).
pub(super) fn walk(shape: &Shape<'_>, regions: &Regions, traced: &Traced) -> Vec<Vec<Vec<Side>>> {
    let mut loops = vec![Vec::new(); regions.count];
    // Sides of turned triangles by their directed nodes within a facet: a facet walks an edge once each way at most.
    let mut half_edges: BTreeMap<(u32, u32, u32), u32> = BTreeMap::new();
    for (t, face) in (0..).zip(shape.triangles) {
        for i in 0..3 {
            half_edges.insert((regions.of[t as usize], face[i], face[(i + 1) % 3]), t);
        }
    }
    let edge_of = |a: u32, b: u32| {
        shape.edges.nodes.binary_search(&[a.min(b), a.max(b)]).map_or(u32::MAX, |e| e as u32)
    };
    let third = |t: u32, a: u32, b: u32| {
        let face = shape.triangles[t as usize];
        face.into_iter().find(|v| *v != a && *v != b).unwrap_or(a)
    };
    let mut seen: BTreeMap<(u32, u32, u32), bool> = BTreeMap::new();
    for &(facet, a, b) in half_edges.keys() {
        let e = edge_of(a, b);
        if traced.of_edge.get(e as usize).is_none_or(|l| *l == u32::MAX) || seen.contains_key(&(facet, a, b))
        {
            continue;
        }
        let mut sides: Vec<Side> = Vec::new();
        let (mut from, mut to) = (a, b);
        loop {
            seen.insert((facet, from, to), true);
            let e = edge_of(from, to) as usize;
            let side = Side { line: traced.of_edge[e], along: traced.along_edge[e] == (from < to) };
            let starts = starts_line(traced, side, from);
            if starts || sides.is_empty() {
                sides.push(side);
            }
            // Round the node to the facet's next edge that is on a line.
            let Some(&t) = half_edges.get(&(facet, from, to)) else { break };
            let mut tip = third(t, from, to);
            while traced.of_edge[edge_of(to, tip) as usize] == u32::MAX {
                let Some(&over) = half_edges.get(&(facet, tip, to)) else { break };
                tip = third(over, tip, to);
            }
            (from, to) = (to, tip);
            if (from, to) == (a, b) {
                break;
            }
        }
        // A walk that began inside a line ends with the same line's beginning.
        if sides.len() > 1 && sides.first() == sides.last() {
            sides.pop();
        }
        loops[facet as usize].push(sides);
    }
    loops
}

/// Whether a side begins at a node.
fn starts_line(traced: &Traced, side: Side, node: u32) -> bool {
    let nodes = &traced.lines[side.line as usize].nodes;
    (if side.along { nodes.first() } else { nodes.last() }) == Some(&node)
}
