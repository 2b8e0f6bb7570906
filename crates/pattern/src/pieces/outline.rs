//! The sewing line as chains: which boundary edges belong together, their seams and allowances.

use glam::DVec2;

use super::simplify::needed;
use crate::{
    CornerStyle, EdgeChain, Outline, OutlineChain, Patch, PatternOptions, SeamRef,
    flatten::{FlatPatch, joined::FlatSeam, topology::NONE},
};

/// What is known about one boundary half-edge.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BoundaryEdge {
    pub(crate) seams: Vec<SeamRef>,
    pub(crate) allowance: f64,
    pub(crate) corner: CornerStyle,
    pub(crate) on_fold: bool,
}

/// A sewing line with what the cut line needs to know.
pub(crate) struct SewingLine {
    pub(crate) outline: Outline,
    /// Corner style of every chain.
    pub(crate) corners: Vec<CornerStyle>,
}

/// What is known about every half-edge of the patch; `None` inside.
pub(crate) fn boundary_edges(
    p: usize,
    patch: &Patch,
    flat: &FlatPatch,
    seams: &[FlatSeam],
) -> Vec<Option<BoundaryEdge>> {
    let mut edges: Vec<Option<BoundaryEdge>> = flat
        .after
        .twin
        .iter()
        .map(|&t| {
            (t == NONE).then(|| BoundaryEdge {
                seams: Vec::new(),
                allowance: patch.piece.allowance_mm,
                corner: CornerStyle::default(),
                on_fold: false,
            })
        })
        .collect();
    for (s, seam) in seams.iter().enumerate() {
        for (k, side) in seam.sides.iter().enumerate().filter(|(_, side)| side.patch == p) {
            for e in &side.edges {
                if let Some(edge) = &mut edges[e.half_edge as usize] {
                    edge.seams.push(SeamRef { seam: s, side: k, reversed: !e.forward });
                }
            }
        }
    }
    for spec in &patch.piece.edges {
        let wanted: Vec<usize> = match &spec.chain {
            EdgeChain::Nodes(nodes) => half_edges_of(flat, nodes),
            EdgeChain::Seam(name) => seams
                .iter()
                .filter(|s| s.name == *name)
                .flat_map(|s| s.sides.iter().filter(|side| side.patch == p))
                .flat_map(|side| side.edges.iter().map(|e| e.half_edge as usize))
                .collect(),
            EdgeChain::Free => {
                (0..edges.len()).filter(|&h| edges[h].as_ref().is_some_and(|e| e.seams.is_empty())).collect()
            }
        };
        for h in wanted {
            if let Some(edge) = &mut edges[h] {
                edge.allowance = spec.allowance_mm;
                edge.corner = spec.corner;
            }
        }
    }
    for h in patch.piece.on_fold.iter().flat_map(|nodes| half_edges_of(flat, nodes)) {
        if let Some(edge) = &mut edges[h] {
            edge.allowance = 0.0;
            edge.on_fold = true;
        }
    }
    edges
}

fn half_edges_of(flat: &FlatPatch, nodes: &[u32]) -> Vec<usize> {
    nodes.windows(2).flat_map(|w| flat.before.half_edges(w[0], w[1])).map(|h| h as usize).collect()
}

/// Turn at `b` on the way from `a` to `c`, in radians; left is positive.
pub(crate) fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).angle_to(c - b)
}

/// Sewing lines of a piece, the outer one first. `keep[flat node]` stays a point of the line.
pub(crate) fn sewing_lines(
    flat: &FlatPatch,
    edges: &[Option<BoundaryEdge>],
    keep: &[bool],
    options: &PatternOptions,
) -> Vec<SewingLine> {
    let uv = &flat.flat.uv;
    let at = |v: u32| uv[v as usize];
    let mut lines: Vec<(f64, SewingLine)> = Vec::new();
    for rim in flat.after.boundary_loops() {
        let n = rim.len();
        let node = |i: usize| flat.after.origin(rim[i % n]);
        let info = |i: usize| &edges[rim[i % n] as usize];
        // Whether a chain starts at node i, that is between edges i - 1 and i.
        let starts = |i: usize| {
            info(i + n - 1) != info(i)
                || turn(at(node(i + n - 1)), at(node(i)), at(node(i + 1))).abs() > options.corner_angle
        };
        let breaks: Vec<usize> = (0..n).filter(|&i| starts(i)).collect();
        let breaks = if breaks.is_empty() { vec![0] } else { breaks };
        let mut chains = Vec::new();
        let mut corners = Vec::new();
        for (k, &from) in breaks.iter().enumerate() {
            let to = if k + 1 < breaks.len() { breaks[k + 1] } else { breaks[0] + n };
            let nodes: Vec<u32> = (from..=to).map(node).collect();
            let exact: Vec<DVec2> = nodes.iter().map(|&v| at(v)).collect();
            // A closed chain needs a point on its far side, or it would collapse.
            let middle = (to - from == n).then_some((to - from) / 2);
            let stay =
                needed(&exact, options.line_tolerance_mm, |i| keep[nodes[i] as usize] || middle == Some(i));
            let Some(edge) = info(from) else { continue };
            corners.push(edge.corner);
            chains.push(OutlineChain {
                seams: edge.seams.clone(),
                allowance_mm: edge.allowance,
                on_fold: edge.on_fold,
                points: stay.into_iter().map(|i| exact[i]).collect(),
                length: exact.windows(2).map(|w| w[0].distance(w[1])).sum(),
                nodes,
            });
        }
        let outline = Outline { chains };
        let area = super::simplify::signed_area(&outline.points());
        lines.push((area, SewingLine { outline, corners }));
    }
    // Only the outer rim of a flat piece encloses positive area.
    lines.sort_by(|a, b| b.0.total_cmp(&a.0));
    lines.into_iter().map(|l| l.1).collect()
}
