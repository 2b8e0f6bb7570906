//! Boundary loops under edits that touch a few of their edges.
//!
//! Loops are canonical: each starts at its edge with the lowest number, or at the first chain of a joint from there on, and
//! they stand in the order of these edges, chains of joints before all others. So they do not depend on the way on which a
//! surface came about. Most edits leave that as it is; where one does not, loops are cut anew from the edges that they
//! have.

use crate::body::build::make_loop;
use crate::body::chain::{Chain, Loop};
use crate::body::surface::{NO_CHAIN, chain_slot};
use crate::body::{ChainId, DirectedEdge, EdgeId, LoopId, Surface};

/// Chains and loops of a surface, to be put back.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Loops {
    chains: Vec<Chain>,
    loops: Vec<Loop>,
}

impl Loops {
    /// O(edges of chains).
    pub(super) fn of(s: &Surface) -> Self {
        Self { chains: s.chains.clone(), loops: s.loops.clone() }
    }

    /// Puts them back into a surface that has the edges of that time again. O(edges of chains).
    pub(super) fn restore(&self, s: &mut Surface) {
        for d in s.chains.iter().flat_map(|c| &c.edges) {
            // Edges that came after are gone.
            if let Some(slot) = s.edge_chain.get_mut(d.edge().index()) {
                *slot = NO_CHAIN;
            }
        }
        s.chains.clone_from(&self.chains);
        s.loops.clone_from(&self.loops);
        for (c, chain) in s.chains.iter().enumerate() {
            for d in &chain.edges {
                s.edge_chain[d.edge().index()] = chain_slot(ChainId(c as u32));
            }
        }
    }
}

/// The chain of a loop that is nothing but one chain on no joint.
fn whole(s: &Surface, l: LoopId) -> Option<&Chain> {
    match s.loops[l.index()].chains[..] {
        [c] if s.chain(c).joint.is_none() => Some(s.chain(c)),
        _ => None,
    }
}

/// The lowest edge of a loop that is one chain on no joint. O(1).
pub(super) fn lowest_of_whole(s: &Surface, l: LoopId) -> Option<EdgeId> {
    whole(s, l).map(|chain| chain.edges[0].edge())
}

/// The lowest edge of a loop. O(1) where the loop is one chain on no joint, else O(length).
pub(super) fn lowest(s: &Surface, l: LoopId) -> EdgeId {
    if let Some(chain) = whole(s, l) {
        return chain.edges[0].edge();
    }
    let edges = s.loops[l.index()].chains.iter().flat_map(|&c| &s.chain(c).edges);
    edges.map(|d| d.edge()).min().unwrap_or(EdgeId(0))
}

/// Whether the loop of an edge, if it is on one, has to be found anew when `second` becomes its half at its second node.
pub(super) fn split_unsettles(s: &Surface, edge: EdgeId, second: u32) -> bool {
    let Some(c) = s.edge_chain(edge) else { return false };
    let Some(l) = s.chain(c).on_loop else { return false };
    let lowest = lowest(s, l);
    // The loop has its face on the left of its edges, so it runs backwards over an edge without a left face.
    second < lowest.0 || (lowest == edge && s.face_left(DirectedEdge::new(edge, false)) == crate::body::NONE)
}

/// Cuts the loops anew from the edges that they have. O(edges of chains).
pub(super) fn rebuild(s: &mut Surface) {
    let mut cycles: Vec<Vec<DirectedEdge>> = Vec::with_capacity(s.loops.len());
    for l in &s.loops {
        let mut cycle: Vec<DirectedEdge> =
            l.chains.iter().flat_map(|&c| s.chain(c).edges.iter().copied()).collect();
        let first = (0..cycle.len()).min_by_key(|&i| cycle[i].edge()).unwrap_or(0);
        cycle.rotate_left(first);
        if !cycle.is_empty() {
            cycles.push(cycle);
        }
    }
    cycles.sort_by_key(|cycle| cycle[0].edge());
    s.drop_loops();
    for cycle in &cycles {
        make_loop(s, cycle);
    }
}
