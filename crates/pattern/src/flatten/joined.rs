//! Seams: which flat edges must get the same length.

use super::topology::{DisjointSets, NONE, Topology};
use crate::{PatternError, PatternInput};

/// One flat edge of a seam side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct FlatEdge {
    pub(crate) patch: u32,
    /// Half-edge of the patch, whose face tells on which side of a cut it lies.
    pub(crate) half_edge: u32,
    /// Whether the half-edge runs along the seam.
    pub(crate) forward: bool,
}

/// One side of a seam on the opened patches.
#[derive(Clone, Debug)]
pub(crate) struct FlatSide {
    pub(crate) patch: usize,
    /// Edges in the seam's order.
    pub(crate) edges: Vec<FlatEdge>,
}

/// A seam on the opened patches. A side along a cut becomes two.
#[derive(Clone, Debug)]
pub(crate) struct FlatSeam {
    pub(crate) name: String,
    pub(crate) sides: Vec<FlatSide>,
    pub(crate) from_cut: bool,
}

/// Checks that all indices of seams, marks, lines and cuts exist and that seams correspond.
pub(crate) fn check(input: &PatternInput, topologies: &[Topology]) -> Result<(), PatternError> {
    let path = |what: String, patch: usize, nodes: &[u32]| -> Result<(), PatternError> {
        let Some(p) = input.patches.get(patch) else {
            return Err(PatternError::NoSuchPatch { what, patch, patches: input.patches.len() });
        };
        let count = p.positions.len();
        if let Some(&node) = nodes.iter().find(|&&v| v as usize >= count) {
            return Err(PatternError::NodeOutOfRange { patch: p.name.clone(), what, node, nodes: count });
        }
        for pair in nodes.windows(2) {
            if topologies[patch].half_edges(pair[0], pair[1]).next().is_none() {
                return Err(PatternError::NotAnEdge { patch: p.name.clone(), what, a: pair[0], b: pair[1] });
            }
        }
        Ok(())
    };
    for seam in &input.seams {
        let Some(first) = seam.sides.first() else {
            return Err(PatternError::ShortSeam { seam: seam.name.clone() });
        };
        for side in &seam.sides {
            path(format!("seam {:?}", seam.name), side.patch, &side.nodes)?;
            if side.nodes.len() != first.nodes.len() {
                return Err(PatternError::UnequalSides {
                    seam: seam.name.clone(),
                    first: first.nodes.len(),
                    other: side.nodes.len(),
                });
            }
        }
        if seam.sides.len() < 2 || first.nodes.len() < 2 {
            return Err(PatternError::ShortSeam { seam: seam.name.clone() });
        }
    }
    for mark in &input.marks {
        path(format!("mark {:?}", mark.name), mark.patch, &[mark.node])?;
    }
    for line in &input.lines {
        path(format!("line {:?}", line.name), line.patch, &line.nodes)?;
    }
    for cut in &input.cuts {
        path(format!("cut {:?}", cut.name), cut.patch, &cut.nodes)?;
    }
    for (p, patch) in input.patches.iter().enumerate() {
        if let Some(fold) = &patch.piece.on_fold {
            path("the fold".to_owned(), p, fold)?;
        }
        for edge in &patch.piece.edges {
            if let crate::EdgeChain::Nodes(nodes) = &edge.chain {
                path("an edge with its own allowance".to_owned(), p, nodes)?;
            }
        }
    }
    Ok(())
}

/// The sides of a path of patch nodes: one, or two where it runs along a cut.
fn sides_of(patch: usize, before: &Topology, after: &Topology, nodes: &[u32]) -> Vec<FlatSide> {
    let mut left = FlatSide { patch, edges: Vec::new() };
    let mut right = left.clone();
    let mut two = false;
    for pair in nodes.windows(2) {
        let mut along = NONE;
        let mut against = NONE;
        for h in before.half_edges(pair[0], pair[1]) {
            if before.origin(h) == pair[0] {
                along = h;
            } else {
                against = h;
            }
        }
        let edge = |half_edge: u32, forward: bool| FlatEdge { patch: patch as u32, half_edge, forward };
        let (l, r) = match (along, against) {
            (NONE, g) => (edge(g, false), edge(g, false)),
            (h, NONE) => (edge(h, true), edge(h, true)),
            (h, g) => {
                two |= after.twin[h as usize] == NONE;
                (edge(h, true), edge(g, false))
            }
        };
        left.edges.push(l);
        right.edges.push(r);
    }
    if two { vec![left, right] } else { vec![left] }
}

/// The input's seams and the seams made by cuts.
pub(crate) fn flat_seams(
    input: &PatternInput,
    before: &[Topology],
    after: &[&Topology],
    cut_paths: &[&[Vec<u32>]],
) -> Vec<FlatSeam> {
    let mut seams: Vec<FlatSeam> = input
        .seams
        .iter()
        .map(|seam| FlatSeam {
            name: seam.name.clone(),
            sides: seam
                .sides
                .iter()
                .flat_map(|s| sides_of(s.patch, &before[s.patch], after[s.patch], &s.nodes))
                .collect(),
            from_cut: false,
        })
        .collect();
    for (patch, paths) in cut_paths.iter().enumerate() {
        for (k, nodes) in paths.iter().enumerate() {
            let sides = sides_of(patch, &before[patch], after[patch], nodes);
            if sides.len() == 2 {
                let name = format!("{} cut {}", input.patches[patch].name, k + 1);
                seams.push(FlatSeam { name, sides, from_cut: true });
            }
        }
    }
    seams
}

/// Sets of flat edges (patch, half-edge) that must have the same length, those of one member left out. Every edge is
/// named by one half-edge; order is that of first appearance.
pub(crate) fn equal_length_groups(seams: &[FlatSeam], after: &[&Topology]) -> Vec<Vec<(u32, u32)>> {
    let mut offset = vec![0u32];
    for t in after {
        offset.push(offset[offset.len() - 1] + t.twin.len() as u32);
    }
    let name = |e: &FlatEdge| {
        let twin = after[e.patch as usize].twin[e.half_edge as usize];
        offset[e.patch as usize] + e.half_edge.min(twin)
    };
    let mut sets = DisjointSets::new(offset[after.len()] as usize);
    let mut members: Vec<u32> = Vec::new();
    for seam in seams {
        for side in &seam.sides {
            for (e, first) in side.edges.iter().zip(&seam.sides[0].edges) {
                sets.join(name(e), name(first));
                members.push(name(e));
            }
        }
    }
    members.sort_unstable();
    members.dedup();
    let mut keyed: Vec<(u32, u32)> = members.iter().map(|&m| (sets.root(m), m)).collect();
    keyed.sort_unstable();
    keyed
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|group| group.len() > 1)
        .map(|group| {
            group
                .iter()
                .map(|&(_, m)| {
                    let patch = offset.partition_point(|&o| o <= m) - 1;
                    (patch as u32, m - offset[patch])
                })
                .collect()
        })
        .collect()
}
