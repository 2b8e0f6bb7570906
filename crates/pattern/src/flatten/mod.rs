//! Patches to the plane with least stretch, sewing partners with equal lengths.
//!
//! 1. Every patch is checked and, where it must, cut open ([`cut`]).
//! 2. Every patch goes to the plane on its own: conformal start, Newton ([`initial`], [`newton`]).
//! 3. Patches that are sewn together are solved as one, their seam edges held to equal lengths ([`joined`], [`coupled`]).

mod coupled;
mod cut;
mod energy;
mod initial;
pub(crate) mod joined;
mod newton;
mod ordering;
mod overlap;
mod sheet;
mod sparse;
pub(crate) mod topology;

pub(crate) use self::overlap::crossings;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use self::{
    coupled::EdgeOf,
    cut::OpenPatch,
    joined::FlatSeam,
    newton::{Outcome, Stop},
    sheet::Sheet,
    topology::{DisjointSets, NONE, Topology},
};
use crate::{Flat, HolePolicy, PatternError, PatternInput, PatternOptions, PieceReport};

/// All patches in the plane.
pub(crate) struct Flattened {
    pub(crate) patches: Vec<FlatPatch>,
    pub(crate) seams: Vec<FlatSeam>,
    pub(crate) warnings: Vec<String>,
}

/// One patch in the plane.
pub(crate) struct FlatPatch {
    /// Incidence before cutting.
    pub(crate) before: Topology,
    /// Incidence after cutting, over flat nodes.
    pub(crate) after: Topology,
    pub(crate) flat: Flat,
    pub(crate) report: PieceReport,
}

/// Mean change of area above which cloth is unlikely to follow.
const MEAN_AREA_CHANGE: f64 = 0.01;

/// A kept hole that costs more stretch than this is cut open after all.
const POOR_STRETCH: f64 = 0.01;

struct Work {
    before: Topology,
    open: OpenPatch,
    sheet: Sheet,
    outcome: Outcome,
}

/// Flattens all patches. Parallel over patches; the result does not depend on the number of threads.
pub(crate) fn flatten(input: &PatternInput, options: &PatternOptions) -> Result<Flattened, PatternError> {
    if input.patches.is_empty() {
        return Err(PatternError::Empty);
    }
    let checked: Vec<_> = input.patches.par_iter().map(Topology::of_patch).collect();
    let before = checked.into_iter().collect::<Result<Vec<_>, _>>()?;
    joined::check(input, &before)?;
    let solved: Vec<_> = before
        .into_par_iter()
        .enumerate()
        .map(|(p, topology)| flatten_one(input, options, p, topology))
        .collect();
    let mut work = solved.into_iter().collect::<Result<Vec<Work>, _>>()?;
    let mut warnings = Vec::new();

    let seams = {
        let before: Vec<Topology> = work.iter().map(|w| w.before.clone()).collect();
        let after: Vec<&Topology> = work.iter().map(|w| &w.open.topology).collect();
        let paths: Vec<&[Vec<u32>]> = work.iter().map(|w| w.open.cut_paths.as_slice()).collect();
        joined::flat_seams(input, &before, &after, &paths)
    };
    if options.match_seams {
        fit_seams(input, options, &mut work, &seams, &mut warnings);
    }
    let patches: Vec<FlatPatch> =
        work.into_par_iter().enumerate().map(|(p, w)| finish(&input.patches[p].positions, w)).collect();
    for (patch, flat) in input.patches.iter().zip(&patches) {
        if flat.report.overlaps > 0 {
            warnings.push(format!(
                "piece {:?} lies on itself in {} place(s): divide the surface or open it along a cut",
                patch.name, flat.report.overlaps
            ));
        }
        if flat.report.mean_area_change > MEAN_AREA_CHANGE {
            warnings.push(format!(
                "piece {:?}: areas change by {:.1} % on average, the surface is too curved for one flat piece; a dart \
                 or another seam would help",
                patch.name,
                100.0 * flat.report.mean_area_change
            ));
        }
    }
    Ok(Flattened { patches, seams, warnings })
}

fn unsolvable(patch: &str) -> PatternError {
    PatternError::Unsolvable {
        patch: patch.to_owned(),
        reason: "its triangles are too thin or too different in size for the solver; remesh it".to_owned(),
    }
}

fn flatten_one(
    input: &PatternInput,
    options: &PatternOptions,
    p: usize,
    before: Topology,
) -> Result<Work, PatternError> {
    let patch = &input.patches[p];
    let given: Vec<Vec<u32>> = input.cuts.iter().filter(|c| c.patch == p).map(|c| c.nodes.clone()).collect();
    let mut preferred = vec![false; before.twin.len()];
    let features = input
        .lines
        .iter()
        .filter(|l| l.patch == p)
        .map(|l| &l.nodes)
        .chain(input.seams.iter().flat_map(|s| &s.sides).filter(|s| s.patch == p).map(|s| &s.nodes));
    for pair in features.flat_map(|nodes| nodes.windows(2)) {
        for h in before.half_edges(pair[0], pair[1]) {
            preferred[h as usize] = true;
        }
    }
    let mut policy = options.holes;
    loop {
        let open = cut::open(&patch.name, &before, &patch.positions, &given, &preferred, policy)?;
        let space: Vec<DVec3> = open.classes.node_of.iter().map(|&v| patch.positions[v as usize]).collect();
        let sewn =
            !open.cut_paths.is_empty() || input.seams.iter().flat_map(|s| &s.sides).any(|s| s.patch == p);
        let stop = if sewn && options.match_seams { Stop::ROUGH } else { Stop::default() };
        let mut sheet =
            Sheet::new(&open.topology, &space, options.area_weight).map_err(|_| unsolvable(&patch.name))?;
        if !start_from(&mut sheet, input.start.get(p), &open) {
            initial::start(&mut sheet).map_err(|_| unsolvable(&patch.name))?;
        }
        let outcome = newton::minimise(&mut sheet, stop).map_err(|_| unsolvable(&patch.name))?;
        if open.kept_holes {
            let (stretch, _) = stretches(&sheet);
            if stretch > POOR_STRETCH || overlap::crossings(&sheet.flat, &sheet.loops) > 0 {
                policy = HolePolicy::Cut;
                continue;
            }
        }
        return Ok(Work { before, open, sheet, outcome });
    }
}

/// Takes over earlier flat positions when they fit.
fn start_from(sheet: &mut Sheet, earlier: Option<&Flat>, open: &OpenPatch) -> bool {
    let Some(earlier) = earlier.filter(|e| e.faces == open.topology.faces) else { return false };
    for (&c, &p) in sheet.compact.iter().zip(&earlier.uv) {
        if c != NONE {
            sheet.flat[c as usize] = p;
        }
    }
    earlier.uv.len() == sheet.compact.len()
        && sheet.is_flip_free(&sheet.flat)
        && sheet.excess(&sheet.flat).is_finite()
}

/// Brings corresponding seam edges to equal lengths at the least total stretch: all pieces that are sewn together are
/// solved as one, starting from their own best shapes.
fn fit_seams(
    input: &PatternInput,
    options: &PatternOptions,
    work: &mut [Work],
    seams: &[FlatSeam],
    warnings: &mut Vec<String>,
) {
    let groups = {
        let after: Vec<&Topology> = work.iter().map(|w| &w.open.topology).collect();
        joined::equal_length_groups(seams, &after)
    };
    let mut sewn = DisjointSets::new(work.len());
    for group in &groups {
        group.iter().for_each(|e| {
            sewn.join(group[0].0, e.0);
        });
    }
    // Garments: sets of patches sewn together, with their groups.
    let mut garment_of = vec![usize::MAX; work.len()];
    let mut garments: Vec<(Vec<usize>, Vec<Vec<EdgeOf>>)> = Vec::new();
    let mut place = vec![0; work.len()];
    for group in &groups {
        let root = sewn.root(group[0].0) as usize;
        if garment_of[root] == usize::MAX {
            garment_of[root] = garments.len();
            let members: Vec<usize> =
                (0..work.len()).filter(|&p| sewn.root(p as u32) as usize == root).collect();
            members.iter().enumerate().for_each(|(i, &p)| place[p] = i);
            garments.push((members, Vec::new()));
        }
        let edges = group
            .iter()
            .map(|&(patch, h)| {
                let face = work[patch as usize].sheet.faces[h as usize / 3];
                let nodes = [face[h as usize % 3], face[(h as usize + 1) % 3]];
                EdgeOf { sheet: place[patch as usize], nodes }
            })
            .collect();
        garments[garment_of[root]].1.push(edges);
    }
    let solved: Vec<_> = garments
        .par_iter()
        .map(|(members, groups)| {
            let sheets: Vec<&Sheet> = members.iter().map(|&p| &work[p].sheet).collect();
            let mut merged = coupled::merge(&sheets, groups, options.area_weight)?;
            let outcome = newton::minimise(&mut merged, Stop::default())?;
            Ok((merged, outcome))
        })
        .collect::<Vec<Result<(Sheet, Outcome), sparse::NotDefinite>>>();
    for ((members, _), result) in garments.iter().zip(solved) {
        let names = || members.iter().map(|&p| input.patches[p].name.as_str()).collect::<Vec<_>>().join(", ");
        let Ok((merged, outcome)) = result else {
            // The free shapes are still sound; the seam checks will show by how much their sides differ.
            warnings.push(format!("the seams of {} could not be brought to equal lengths", names()));
            continue;
        };
        let mut sheets: Vec<&mut Sheet> = work
            .iter_mut()
            .enumerate()
            .filter(|(p, _)| members.contains(p))
            .map(|(_, w)| &mut w.sheet)
            .collect();
        coupled::hand_back(&merged, &mut sheets);
        for &p in members {
            work[p].outcome.steps += outcome.steps;
        }
        if outcome.hold_error > 1e-4 {
            warnings.push(format!(
                "not all seam edges of {} could be brought to their partners' lengths (largest relative difference \
                 {:.1e})",
                names(),
                outcome.hold_error
            ));
        }
    }
}

/// Area-weighted mean and maximum of |1 − σ|.
fn stretches(sheet: &Sheet) -> (f64, f64) {
    let (mut mean, mut max) = (0.0, 0.0f64);
    for f in 0..sheet.faces.len() {
        let [a, b] = energy::singular_values(sheet.jacobian(&sheet.flat, f));
        mean += 0.5 * sheet.rest[f].area * ((1.0 - a).abs() + (1.0 - b).abs());
        max = max.max((1.0 - a).abs()).max((1.0 - b).abs());
    }
    (mean / sheet.area, max)
}

fn finish(positions: &[DVec3], work: Work) -> FlatPatch {
    let Work { before, open, sheet, outcome } = work;
    let (mean_stretch, max_stretch) = stretches(&sheet);
    let mut report = PieceReport {
        area_3d: sheet.area,
        mean_stretch,
        max_stretch,
        energy: 4.0 + sheet.excess(&sheet.flat) / sheet.area,
        overlaps: overlap::crossings(&sheet.flat, &sheet.loops),
        steps: outcome.steps,
        ..PieceReport::default()
    };
    let mut stretch = Vec::with_capacity(sheet.faces.len());
    for f in 0..sheet.faces.len() {
        let j = sheet.jacobian(&sheet.flat, f);
        let det = energy::determinant(j);
        report.area_2d += sheet.rest[f].area * det;
        report.mean_area_change += sheet.rest[f].area * (1.0 - det).abs() / sheet.area;
        report.flipped += usize::from(det <= 0.0);
        stretch.push(energy::singular_values(j));
    }
    let mut uv = vec![DVec2::ZERO; open.topology.node_count];
    for (v, &c) in sheet.compact.iter().enumerate() {
        if c != NONE {
            uv[v] = sheet.flat[c as usize];
        }
    }
    debug_assert!(open.classes.node_of.iter().all(|&v| (v as usize) < positions.len()));
    let flat = Flat { uv, faces: open.topology.faces.clone(), node_of: open.classes.node_of, stretch };
    FlatPatch { before, after: open.topology, flat, report }
}
