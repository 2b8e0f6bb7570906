//! Flat patches to pieces: sewing line, cut line, notches, grain, text, layout.

mod allowance;
mod interior;
mod layout;
mod notches;
mod outline;
mod simplify;

use glam::DVec2;
use rayon::prelude::*;

use self::notches::Wanted;
use crate::{
    Flat, InnerLine, Patch, Pattern, PatternError, PatternInput, PatternOptions, Piece, SeamCheck, SeamRef,
    flatten::{FlatPatch, Flattened, topology::NONE},
};

pub(crate) use self::{
    interior::{bounds, inside},
    layout::lay_out,
};

/// Widest seam allowance, in millimetres: ten metres, as far as a template's lengths go.
const WIDEST: f64 = 10_000.0;

/// Checks the numbers of the options and piece specifications.
pub(crate) fn check(input: &PatternInput, options: &PatternOptions) -> Result<(), PatternError> {
    let allowance = |what: &str, value: f64| {
        if (0.0..=WIDEST).contains(&value) {
            return Ok(());
        }
        let wanted = format!("a number of millimetres from 0 to {WIDEST}");
        Err(PatternError::BadOption { what: what.to_owned(), wanted, value })
    };
    let at_least = |what: &str, value: f64, low: f64| {
        if value.is_finite() && value >= low {
            return Ok(());
        }
        let wanted = if low > 0.0 {
            format!("a number of {low} or more")
        } else {
            "a number, not negative".to_owned()
        };
        Err(PatternError::BadOption { what: what.to_owned(), wanted, value })
    };
    at_least("the corner angle", options.corner_angle, 1e-3)?;
    at_least("the weight of areas", options.area_weight, 0.0)?;
    at_least("the mitre limit", options.mitre_limit, 1.0)?;
    at_least("the line tolerance", options.line_tolerance_mm, 0.0)?;
    at_least("the notch depth", options.notch_depth_mm, 0.0)?;
    at_least("the fabric width", options.fabric_width_mm, 10.0)?;
    at_least("the gap of the layout", options.layout_gap_mm, 0.0)?;
    for patch in &input.patches {
        allowance(&format!("the seam allowance of {:?}", patch.name), patch.piece.allowance_mm)?;
        for edge in &patch.piece.edges {
            allowance(&format!("an edge's seam allowance of {:?}", patch.name), edge.allowance_mm)?;
        }
    }
    Ok(())
}

/// Makes the pieces of flat patches.
///
/// # Errors
/// [`PatternError::NoOutline`].
pub(crate) fn make(
    input: &PatternInput,
    mut flat: Flattened,
    options: &PatternOptions,
) -> Result<Pattern, PatternError> {
    flat.patches.par_iter_mut().zip(&input.patches).for_each(|(f, patch)| stand_up(patch, f));
    let (wanted, notch_mismatch) = notches::wanted(input, &flat);
    let pieces: Vec<Piece> = (0..input.patches.len())
        .into_par_iter()
        .map(|p| piece(input, &flat, p, &wanted[p], options))
        .collect();
    if let Some(piece) = pieces.iter().find(|p| !has_outline(p)) {
        return Err(PatternError::NoOutline { patch: piece.name.clone(), area: piece.report.area_3d });
    }
    let mut warnings = std::mem::take(&mut flat.warnings);
    for piece in &pieces {
        if let Some(fold) = &piece.fold
            && let (Some(&a), Some(&b)) = (fold.first(), fold.last())
            && let Some(off) =
                fold.iter().map(|&p| simplify::distance_to_segment(p, a, b)).max_by(f64::total_cmp)
            && off > 0.5
        {
            warnings.push(format!(
                "piece {:?}: its fold is no straight line (off by {off:.1} mm); cut it as two halves with a seam",
                piece.name
            ));
        }
    }
    let seams = seam_checks(input, &flat, &notch_mismatch);
    for seam in seams.iter().filter(|s| s.mismatch > 0.5) {
        warnings.push(format!("seam {:?}: its sides differ by {:.2} mm", seam.name, seam.mismatch));
    }
    let layout = lay_out(&pieces, options.fabric_width_mm, options.layout_gap_mm, DVec2::ZERO);
    let flats: Vec<Flat> = flat.patches.into_iter().map(|p| p.flat).collect();
    Ok(Pattern { pieces, flats, seams, layout, warnings })
}

fn has_outline(piece: &Piece) -> bool {
    !piece.cut.is_empty() && piece.cut.iter().flat_map(|c| &c.points).all(|p| p.is_finite())
}

/// Part of a piece's size that its lines may be off by, however small it is.
const FINEST: f64 = 1e-3;

/// Turns a flat patch so that its grain points up, and moves it into the positive quadrant.
fn stand_up(patch: &Patch, flat: &mut FlatPatch) {
    let turn = DVec2::from_angle(interior::grain_turn(patch, flat));
    let mut used = vec![false; flat.flat.uv.len()];
    flat.flat.faces.iter().flatten().for_each(|&v| used[v as usize] = true);
    flat.flat.uv.iter_mut().for_each(|p| *p = turn.rotate(*p));
    let [low, _] = bounds(flat.flat.uv.iter().zip(&used).filter(|(_, u)| **u).map(|(p, _)| *p));
    for (p, used) in flat.flat.uv.iter_mut().zip(used) {
        *p = if used { *p - low } else { DVec2::ZERO };
    }
}

fn piece(
    input: &PatternInput,
    flat: &Flattened,
    p: usize,
    wanted: &[Wanted],
    options: &PatternOptions,
) -> Piece {
    let patch = &input.patches[p];
    let one = &flat.patches[p];
    let [low, high] = bounds(one.flat.uv.iter().copied());
    let line_tolerance_mm = options.line_tolerance_mm.min(FINEST * (high - low).max_element());
    let options = &PatternOptions { line_tolerance_mm, ..options.clone() };
    let edges = outline::boundary_edges(p, patch, one, &flat.seams);
    let mut keep = vec![false; one.flat.uv.len()];
    wanted.iter().for_each(|w| keep[w.node as usize] = true);
    let lines = outline::sewing_lines(one, &edges, &keep, options);
    let cut = allowance::cut_lines(&lines, options);
    let (notches, drills) = notches::place(wanted, one, &edges, &cut, &flat.seams, options);
    let sew: Vec<_> = lines.into_iter().map(|l| l.outline).collect();
    let loops: Vec<Vec<DVec2>> = sew.iter().map(|o| o.points()).collect();
    let text_at = interior::deep_point(&loops);
    let fold = sew.iter().flat_map(|o| &o.chains).filter(|c| c.on_fold).map(|c| c.points.clone()).reduce(
        |mut a, b| {
            a.extend(b.into_iter().skip(1));
            a
        },
    );
    let label = if patch.piece.label.is_empty() { patch.name.clone() } else { patch.piece.label.clone() };
    Piece {
        name: patch.name.clone(),
        grain: interior::grain_line(&loops, text_at, label.chars().count()),
        label,
        quantity: patch.piece.quantity,
        material: patch.piece.material.clone(),
        sew,
        cut,
        notches,
        drills,
        fold,
        lines: inner_lines(input, flat, p, options),
        text_at,
        report: one.report.clone(),
    }
}

/// Lines of the input and inner seam sides.
fn inner_lines(input: &PatternInput, flat: &Flattened, p: usize, options: &PatternOptions) -> Vec<InnerLine> {
    let one = &flat.patches[p];
    let thin = |points: Vec<DVec2>| simplify::simplified(&points, options.line_tolerance_mm);
    let mut lines = Vec::new();
    for (s, seam) in flat.seams.iter().enumerate() {
        for (k, side) in seam.sides.iter().enumerate().filter(|(_, side)| side.patch == p) {
            // Runs of edges that are not on the boundary.
            let mut i = 0;
            while i < side.edges.len() {
                let from = i;
                while i < side.edges.len() && one.after.twin[side.edges[i].half_edge as usize] != NONE {
                    i += 1;
                }
                if i > from {
                    let points = (from..=i)
                        .map(|k| one.flat.uv[notches::flat_node(&flat.patches, side, k) as usize])
                        .collect();
                    let seam_ref = SeamRef { seam: s, side: k, reversed: false };
                    lines.push(InnerLine {
                        name: seam.name.clone(),
                        seam: Some(seam_ref),
                        points: thin(points),
                    });
                }
                i += 1;
            }
        }
    }
    for line in input.lines.iter().filter(|l| l.patch == p && l.nodes.len() > 1) {
        // A line may run along a cut: either rim will do, so the first flat node of each patch node is taken.
        let points = line.nodes.iter().map(|&v| one.flat.uv[v as usize]).collect();
        lines.push(InnerLine { name: line.name.clone(), seam: None, points: thin(points) });
    }
    lines
}

/// Lengths of all seams on the flat pieces.
fn seam_checks(input: &PatternInput, flat: &Flattened, notch_mismatch: &[f64]) -> Vec<SeamCheck> {
    let edge_length = |e: &crate::flatten::joined::FlatEdge| {
        let one = &flat.patches[e.patch as usize];
        let (a, b) = (one.after.origin(e.half_edge), one.after.head(e.half_edge));
        let space = |v: u32| input.patches[e.patch as usize].positions[one.flat.node_of[v as usize] as usize];
        (one.flat.uv[a as usize].distance(one.flat.uv[b as usize]), space(a).distance(space(b)))
    };
    let check = |(s, seam): (usize, &crate::flatten::joined::FlatSeam)| {
        let lengths: Vec<Vec<(f64, f64)>> =
            seam.sides.iter().map(|side| side.edges.iter().map(edge_length).collect()).collect();
        let lengths_2d: Vec<f64> = lengths.iter().map(|l| l.iter().map(|x| x.0).sum()).collect();
        let spread = |values: &mut dyn Iterator<Item = f64>| {
            let (low, high) =
                values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
            high - low
        };
        let edge_mismatch = (0..seam.sides[0].edges.len())
            .map(|k| spread(&mut lengths.iter().map(|l| l[k].0)) / lengths[0][k].1)
            .fold(0.0, f64::max);
        SeamCheck {
            name: seam.name.clone(),
            patches: seam.sides.iter().map(|side| side.patch).collect(),
            length_3d: lengths[0].iter().map(|x| x.1).sum(),
            mismatch: spread(&mut lengths_2d.iter().copied()),
            lengths_2d,
            edge_mismatch,
            notch_mismatch: notch_mismatch[s],
            from_cut: seam.from_cut,
        }
    };
    flat.seams.iter().enumerate().map(check).collect()
}
