//! Chains hold together; loops close and cover the boundary.

use super::Defect;
use crate::body::{Body, ChainId, DirectedEdge, EdgeId, LoopId, NONE, Surface, SurfaceId};

pub(super) fn check(body: &Body, defects: &mut Vec<Defect>) {
    for (id, s) in body.surfaces() {
        chains(id, s, defects);
        membership(id, s, defects);
        loops(id, s, defects);
    }
}

fn chains(id: SurfaceId, s: &Surface, defects: &mut Vec<Defect>) {
    let mut found: Vec<(EdgeId, ChainId)> = Vec::new();
    for (c, chain) in s.chains.iter().enumerate() {
        let chain_id = ChainId(c as u32);
        let mut expected = chain.start;
        for (at, &d) in chain.edges.iter().enumerate() {
            let [start, end] = s.ends(d);
            if start != expected {
                defects.push(Defect::ChainBroken {
                    surface: id,
                    chain: chain_id,
                    at,
                    expected,
                    found: start,
                });
            }
            expected = end;
            found.push((d.edge(), chain_id));
        }
        // A loop's chain has its face on the left only; an inner chain has faces on both sides, or on none.
        let wire = chain.edges.first().is_some_and(|d| s.edge_faces[d.edge().index()] == [NONE; 2]);
        for &d in &chain.edges {
            let [left, right] = [d, d.flipped()].map(|d| s.face_left(d) != NONE);
            let fits = match chain.on_loop {
                Some(_) => left && !right,
                None => left == right && left != wire,
            };
            if !fits {
                let faces = s.edge_faces[d.edge().index()];
                let place = if chain.on_loop.is_some() { "a loop" } else { "the inside" };
                defects.push(Defect::ChainPlace {
                    surface: id,
                    chain: chain_id,
                    edge: d.edge(),
                    faces,
                    place,
                });
            }
        }
    }
    found.sort_unstable();
    let mut rest = &found[..];
    for e in 0..s.edges.len() as u32 {
        let edge = EdgeId(e);
        let n = rest.iter().take_while(|(x, _)| *x == edge).count();
        let (own, others) = rest.split_at(n);
        rest = others;
        let recorded = s.edge_chain(edge);
        let fits = match own {
            [] => recorded.is_none(),
            [(_, only)] => recorded == Some(*only),
            _ => false,
        };
        if !fits {
            let found = own.iter().map(|(_, c)| *c).collect();
            defects.push(Defect::EdgeChain { surface: id, edge, recorded, found });
        }
    }
}

fn membership(id: SurfaceId, s: &Surface, defects: &mut Vec<Defect>) {
    let mut found: Vec<Vec<LoopId>> = vec![Vec::new(); s.chains.len()];
    for (l, cycle) in s.loops.iter().enumerate() {
        for c in &cycle.chains {
            found[c.index()].push(LoopId(l as u32));
        }
    }
    for (c, (chain, found)) in s.chains.iter().zip(found).enumerate() {
        if found.as_slice() != chain.on_loop.as_slice() {
            let chain_id = ChainId(c as u32);
            defects.push(Defect::ChainLoop { surface: id, chain: chain_id, recorded: chain.on_loop, found });
        }
    }
    for (e, sides) in s.edge_faces.iter().enumerate() {
        let edge = EdgeId(e as u32);
        if (sides[0] == NONE) != (sides[1] == NONE)
            && s.edge_chain(edge).is_none_or(|c| s.chain(c).on_loop.is_none())
        {
            defects.push(Defect::BoundaryNotInLoop { surface: id, edge });
        }
    }
}

fn loops(id: SurfaceId, s: &Surface, defects: &mut Vec<Defect>) {
    for (l, cycle) in s.loops.iter().enumerate() {
        let edges: Vec<DirectedEdge> =
            cycle.chains.iter().flat_map(|&c| s.chain(c).edges.iter().copied()).collect();
        for (i, &d) in edges.iter().enumerate() {
            let next = edges[(i + 1) % edges.len()];
            let expected = s.next_on_boundary(d);
            if expected != Some(next) {
                defects.push(Defect::LoopOpen {
                    surface: id,
                    cycle: LoopId(l as u32),
                    from: d.edge(),
                    to: next.edge(),
                    expected: expected.map(DirectedEdge::edge),
                });
            }
        }
    }
}
