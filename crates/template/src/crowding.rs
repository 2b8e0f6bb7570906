//! Template nodes that fall together, or past each other, on one particular body.
//!
//! Two feature curves that lie a hand apart on one person may coincide on another (the chest above the bust on a man). A
//! patch through both rows then has a fold of no width, and no smooth surface goes through it. One node of such a pair is
//! moved on towards its next neighbour, and the garment's person is told.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::complex::Patch;
use crate::layout::Layout;
use crate::skin::Skin;

/// Two neighbours nearer than this share of their spacing have fallen together.
const TOO_NEAR: f64 = 0.22;
/// ... but not if they are this far apart, mm.
const FAR_ENOUGH: f64 = 20.0;
/// In a triangle that lies upside down, the shortest edge is to blame if it is below this share of the longest.
const SHORT_EDGE: f64 = 0.6;
/// Where the moved node goes on the way from its partner to the next neighbour.
const SHARE: f64 = 0.35;

/// A node that gives way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Move {
    node: u32,
    /// The node that it fell together with.
    partner: u32,
    /// The node towards which it goes.
    next: u32,
}

/// Finds the nodes to be moved; twins are moved alike.
pub(crate) fn find(layout: &Layout, patches: &[Patch], positions: &[DVec3], skin: &Skin) -> Vec<Move> {
    let mut around: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    let mut suspects: BTreeSet<[u32; 2]> = BTreeSet::new();
    let place = |n: u32| positions[n as usize];
    let length = |a: u32, b: u32| place(a).distance(place(b));
    for patch in patches {
        for f in &patch.faces {
            let ids = f.map(|v| patch.nodes[v as usize]);
            for i in 0..3 {
                around.entry(ids[i]).or_default().insert(ids[(i + 1) % 3]);
                around.entry(ids[(i + 1) % 3]).or_default().insert(ids[i]);
            }
            let [a, b, c] = ids.map(place);
            let normal = (b - a).cross(c - a);
            let outward = skin.look((a + b + c) / 3.0).normal;
            let mut edges = [[ids[0], ids[1]], [ids[1], ids[2]], [ids[2], ids[0]]];
            edges.sort_by(|p, q| length(p[0], p[1]).total_cmp(&length(q[0], q[1])));
            let (short, long) = (length(edges[0][0], edges[0][1]), length(edges[2][0], edges[2][1]));
            if normal.dot(outward) < -0.3 * normal.length() && short < SHORT_EDGE * long {
                let [a, b] = edges[0];
                suspects.insert([a.min(b), a.max(b)]);
            }
        }
    }
    for (a, others) in &around {
        for b in others.range(a + 1..) {
            let spacing = |n: u32, other: u32| {
                let rest: Vec<f64> =
                    around[&n].iter().filter(|m| **m != other).map(|m| length(n, *m)).collect();
                rest.iter().sum::<f64>() / rest.len().max(1) as f64
            };
            let near = TOO_NEAR * spacing(*a, *b).min(spacing(*b, *a));
            if length(*a, *b) < near.min(FAR_ENOUGH) {
                suspects.insert([*a, *b]);
            }
        }
    }
    // Who gives way is the same for twins: nodes without an ease, then those that come first.
    let rank = |n: u32| {
        let node = &layout.nodes[n as usize];
        (node.spec.ease.is_some(), node.twin.map_or(n, |t| t.min(n)))
    };
    let mut out: Vec<Move> = Vec::new();
    let crowded: BTreeSet<u32> =
        suspects.iter().map(|[a, b]| if rank(*a) <= rank(*b) { *a } else { *b }).collect();
    let mut done: BTreeSet<u32> = BTreeSet::new();
    for [a, b] in suspects {
        let (node, partner) = if rank(a) <= rank(b) { (a, b) } else { (b, a) };
        if done.contains(&node) || done.contains(&partner) {
            continue;
        }
        let free = |m: &&u32| **m != partner && !around[&partner].contains(*m) && !crowded.contains(*m);
        // The neighbour that lies nearest beyond it; it must be farther off than the pair is apart.
        let next = around[&node]
            .iter()
            .filter(free)
            .min_by(|p, q| length(node, **p).total_cmp(&length(node, **q)).then(rank(**p).cmp(&rank(**q))));
        if let Some(next) = next
            && length(partner, *next) > length(node, partner)
        {
            done.insert(node);
            out.push(Move { node, partner, next: *next });
        }
    }
    out
}

/// Moves the nodes: on the way to their neighbour, as far from the skin as both are.
pub(crate) fn apply(moves: &[Move], positions: &mut [DVec3], skin: &Skin) {
    for m in moves {
        let (from, to) = (positions[m.partner as usize], positions[m.next as usize]);
        let straight = from.lerp(to, SHARE);
        let lift = skin.look(from).distance * (1.0 - SHARE) + skin.look(to).distance * SHARE;
        let sight = skin.look(straight);
        // Far from the body the nearest place says little; stay on the straight way there.
        positions[m.node as usize] =
            if sight.distance.abs() < 60.0 { sight.point + lift * sight.normal } else { straight };
    }
}

/// What to tell about it.
pub(crate) fn tell(layout: &Layout, moves: &[Move]) -> Option<String> {
    let name = |n: u32| layout.nodes[n as usize].name.as_str();
    let first = moves.first()?;
    let more = if moves.len() > 1 { format!(" (and {} more)", moves.len() - 1) } else { String::new() };
    Some(format!(
        "on this body the node `{}` falls together with `{}`; it was moved towards `{}`{more}",
        name(first.node),
        name(first.partner),
        name(first.next)
    ))
}
