//! Lines that nobody wrote: joints and free edges without a line become smooth curves through their template nodes
//! (T5: free boundary chains faired as curves; a cubic spline is the curve of least bending).

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use mesh_kernel::body::JointSpec;

use crate::complex::{Patch, chain_edges};
use crate::layout::{Layout, LayoutLine};

/// A turn of the polygon beyond this is a corner, not a curve: 50°.
const CORNER: f64 = 0.87;

/// A chain that grows over edges of one kind.
struct Kind {
    name: String,
    edges: BTreeSet<[u32; 2]>,
}

/// The lines to add for joints and free edges that no line of the template covers.
pub(crate) fn missing_lines(
    layout: &Layout,
    patches: &[Patch],
    joints: &[JointSpec],
    positions: &[DVec3],
) -> Vec<LayoutLine> {
    let covered: BTreeSet<[u32; 2]> =
        layout.lines.iter().flat_map(|l| chain_edges(&l.nodes, l.closed)).collect();
    let mut taken = covered.clone();
    let mut kinds: Vec<Kind> = Vec::new();
    for joint in joints {
        let Some(chain) = joint.chains.first() else { continue };
        let nodes: Vec<u32> = chain.nodes.iter().map(|v| patches[chain.surface].nodes[*v as usize]).collect();
        let edges: BTreeSet<[u32; 2]> =
            chain_edges(&nodes, chain.closed).into_iter().filter(|e| taken.insert(*e)).collect();
        kinds.push(Kind { name: format!("joint {}", joint.name.as_deref().unwrap_or("")), edges });
    }
    let mut free = BTreeSet::new();
    for patch in patches {
        let mut sides: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        for f in &patch.faces {
            for i in 0..3 {
                let (a, b) = (f[i], f[(i + 1) % 3]);
                *sides.entry([a.min(b), a.max(b)]).or_default() += 1;
            }
        }
        for ([a, b], count) in sides {
            let (a, b) = (patch.nodes[a as usize], patch.nodes[b as usize]);
            let key = [a.min(b), a.max(b)];
            if count == 1 && !taken.contains(&key) {
                free.insert(key);
            }
        }
    }
    kinds.push(Kind { name: "edge".into(), edges: free });
    let mut out = Vec::new();
    for kind in kinds {
        let many = chains(&kind.edges);
        for (k, (nodes, closed)) in many.into_iter().enumerate() {
            let name = if k == 0 { kind.name.clone() } else { format!("{} {}", kind.name, k + 1) };
            let corners = corners(&nodes, closed, positions);
            out.push(LayoutLine { name, nodes, closed, shape: None, corners, continues: None, hold: None });
        }
    }
    out
}

/// Maximal chains of edges, ended where not exactly two meet.
fn chains(edges: &BTreeSet<[u32; 2]>) -> Vec<(Vec<u32>, bool)> {
    let mut around: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for [a, b] in edges {
        around.entry(*a).or_default().push(*b);
        around.entry(*b).or_default().push(*a);
    }
    let mut used: BTreeSet<[u32; 2]> = BTreeSet::new();
    let mut out = Vec::new();
    let walk = |start: u32, next: u32, used: &mut BTreeSet<[u32; 2]>| {
        let mut nodes = vec![start];
        let (mut from, mut to) = (start, next);
        while used.insert([from.min(to), from.max(to)]) {
            nodes.push(to);
            let [a, b] = around[&to][..] else { break };
            (from, to) = (to, if a == from { b } else { a });
        }
        let closed = nodes.len() > 3 && nodes[0] == nodes[nodes.len() - 1] && around[&start].len() == 2;
        if closed {
            nodes.pop();
        }
        (nodes, closed)
    };
    for (node, others) in &around {
        if others.len() != 2 {
            for next in others {
                if !used.contains(&[*node.min(next), *node.max(next)]) {
                    out.push(walk(*node, *next, &mut used));
                }
            }
        }
    }
    for [a, b] in edges {
        if !used.contains(&[*a, *b]) {
            out.push(walk(*a, *b, &mut used));
        }
    }
    out
}

fn corners(nodes: &[u32], closed: bool, positions: &[DVec3]) -> Vec<u32> {
    let n = nodes.len();
    let place = |i: usize| positions[nodes[i % n] as usize];
    let inner = if closed { 0..n } else { 1..n.saturating_sub(1) };
    inner
        .filter(|i| (place(*i) - place(i + n - 1)).angle_between(place(i + 1) - place(*i)) > CORNER)
        .map(|i| nodes[i])
        .collect()
}
