//! Notches at marks, on every side of the seam that carries the mark.

use glam::DVec2;

use super::outline::BoundaryEdge;
use crate::{
    CutLoop, Drill, Mark, MarkKind, Notch, PatternInput, PatternOptions, SeamRef,
    flatten::{
        FlatPatch, Flattened,
        joined::{FlatSeam, FlatSide},
        topology::NONE,
    },
};

/// A notch or hole to be made at a flat node.
#[derive(Clone, Debug)]
pub(crate) struct Wanted {
    pub(crate) node: u32,
    pub(crate) kind: MarkKind,
    pub(crate) name: String,
    pub(crate) seam: Option<(SeamRef, f64)>,
}

/// Flat node at position `k` of a side.
pub(crate) fn flat_node(patches: &[FlatPatch], side: &FlatSide, k: usize) -> u32 {
    let topology = &patches[side.patch].after;
    let (edge, start) = if k < side.edges.len() { (side.edges[k], true) } else { (side.edges[k - 1], false) };
    if edge.forward == start { topology.origin(edge.half_edge) } else { topology.head(edge.half_edge) }
}

/// Distance from the side's start to its position `k`, on the flat piece.
pub(crate) fn along(patches: &[FlatPatch], side: &FlatSide, k: usize) -> f64 {
    let uv = &patches[side.patch].flat.uv;
    side.edges[..k]
        .iter()
        .map(|e| {
            let t = &patches[side.patch].after;
            uv[t.origin(e.half_edge) as usize].distance(uv[t.head(e.half_edge) as usize])
        })
        .sum()
}

/// Marks of the input on every side of their seams, a list a patch, and the largest difference of the distances from
/// the seam's start, a number a seam. The first mark on a node wins.
pub(crate) fn wanted(input: &PatternInput, flat: &Flattened) -> (Vec<Vec<Wanted>>, Vec<f64>) {
    let patches = &flat.patches;
    let mut lists: Vec<Vec<Wanted>> = vec![Vec::new(); patches.len()];
    let mut mismatch = vec![0.0f64; flat.seams.len()];
    let mut add = |patch: usize, one: Wanted| {
        if lists[patch].iter().all(|w| w.node != one.node) {
            lists[patch].push(one);
        }
    };
    for mark in &input.marks {
        let places = places_on_seams(mark, flat);
        for &(s, k) in &places {
            let (low, high) = flat.seams[s]
                .sides
                .iter()
                .map(|side| along(patches, side, k))
                .fold((f64::INFINITY, 0.0f64), |(low, high), d| (low.min(d), high.max(d)));
            mismatch[s] = mismatch[s].max(high - low);
            if mark.kind == MarkKind::Drill {
                continue;
            }
            for (i, side) in flat.seams[s].sides.iter().enumerate() {
                let seam = SeamRef { seam: s, side: i, reversed: false };
                let node = flat_node(patches, side, k);
                let seam = Some((seam, along(patches, side, k)));
                add(side.patch, Wanted { node, kind: mark.kind, name: mark.name.clone(), seam });
            }
        }
        if places.is_empty() || mark.kind == MarkKind::Drill {
            add(mark.patch, Wanted { node: mark.node, kind: mark.kind, name: mark.name.clone(), seam: None });
        }
    }
    // Where a seam ends in the middle of a smooth edge, the maker needs to see where.
    for (s, seam) in flat.seams.iter().enumerate() {
        for (i, side) in seam.sides.iter().enumerate() {
            for k in [0, side.edges.len()] {
                let seam_ref = SeamRef { seam: s, side: i, reversed: false };
                let node = flat_node(patches, side, k);
                let name = format!("{} {}", seam.name, if k == 0 { "start" } else { "end" });
                let seam = Some((seam_ref, along(patches, side, k)));
                add(side.patch, Wanted { node, kind: MarkKind::Notch, name, seam });
            }
        }
    }
    (lists, mismatch)
}

/// Seams and positions in them where a mark lies.
fn places_on_seams(mark: &Mark, flat: &Flattened) -> Vec<(usize, usize)> {
    let mut places = Vec::new();
    for (s, seam) in flat.seams.iter().enumerate() {
        let found = seam.sides.iter().filter(|side| side.patch == mark.patch).find_map(|side| {
            (0..=side.edges.len()).find(|&k| {
                let v = flat_node(&flat.patches, side, k);
                flat.patches[mark.patch].flat.node_of[v as usize] == mark.node
            })
        });
        places.extend(found.map(|k| (s, k)));
    }
    places
}

/// Notches and drill holes of one piece.
pub(crate) fn place(
    wanted: &[Wanted],
    flat: &FlatPatch,
    edges: &[Option<BoundaryEdge>],
    cut: &[CutLoop],
    seams: &[FlatSeam],
    options: &PatternOptions,
) -> (Vec<Notch>, Vec<Drill>) {
    let uv = &flat.flat.uv;
    let topology = &flat.after;
    // Boundary half-edges that leave and reach every node.
    let mut leaves = vec![NONE; uv.len()];
    let mut reaches = vec![NONE; uv.len()];
    for h in (0..topology.twin.len() as u32).filter(|&h| topology.twin[h as usize] == NONE) {
        leaves[topology.origin(h) as usize] = h;
        reaches[topology.head(h) as usize] = h;
    }
    let mut notches = Vec::new();
    let mut drills = Vec::new();
    for w in wanted {
        let v = w.node as usize;
        let (out, into) = (leaves[v], reaches[v]);
        if w.kind == MarkKind::Drill {
            drills.push(Drill { name: w.name.clone(), at: uv[v] });
            continue;
        }
        if out == NONE || into == NONE {
            // Inside the piece there is nothing to cut into; a seam that ends there is drawn as a line.
            continue;
        }
        let p = uv[v];
        let before = (p - uv[topology.origin(into) as usize]).normalize_or_zero();
        let after = (uv[topology.head(out) as usize] - p).normalize_or_zero();
        if before.angle_to(after).abs() > options.corner_angle {
            continue;
        }
        let outward = -(before + after).normalize_or(before).perp();
        let width = [out, into]
            .iter()
            .filter_map(|&h| edges[h as usize].as_ref())
            .map(|e| e.allowance)
            .fold(0.0, f64::max);
        let on_cut = ray_hit(p, outward, cut, 4.0 * width + 1.0).unwrap_or(p + outward * width);
        let depth =
            if width > 0.0 { options.notch_depth_mm.min((width - 1.0).max(0.4 * width)) } else { 2.0 };
        let across = outward.perp();
        let offsets: &[f64] = if w.kind == MarkKind::DoubleNotch { &[-3.0, 3.0] } else { &[0.0] };
        let slits = offsets
            .iter()
            .map(|&d| {
                let foot = p + across * d;
                let start = ray_hit(foot, outward, cut, 4.0 * width + 1.0).unwrap_or(on_cut + across * d);
                [start, start - outward * depth]
            })
            .collect();
        notches.push(Notch {
            name: w.name.clone(),
            kind: w.kind,
            sew: p,
            cut: on_cut,
            inward: -outward,
            depth,
            slits,
            seam: w.seam.as_ref().map(|s| s.0.clone()),
            seam_name: w.seam.as_ref().map(|s| seams[s.0.seam].name.clone()).unwrap_or_default(),
            along: w.seam.as_ref().map(|s| s.1),
        });
    }
    (notches, drills)
}

/// Nearest place where a ray leaves the cut lines, within `reach`.
fn ray_hit(p: DVec2, direction: DVec2, cut: &[CutLoop], reach: f64) -> Option<DVec2> {
    let mut best: Option<f64> = None;
    for one in cut {
        for i in 0..one.points.len() {
            let (a, b) = (one.points[i], one.points[(i + 1) % one.points.len()]);
            let d = b - a;
            let det = direction.perp_dot(d);
            if det.abs() < 1e-12 * d.length() {
                continue;
            }
            let t = (a - p).perp_dot(d) / det;
            let s = (a - p).perp_dot(direction) / det;
            if (-1e-9..=1.0 + 1e-9).contains(&s) && (-0.1..=reach).contains(&t) {
                best = Some(best.map_or(t, |x: f64| x.min(t)));
            }
        }
    }
    best.map(|t| p + direction * t)
}
