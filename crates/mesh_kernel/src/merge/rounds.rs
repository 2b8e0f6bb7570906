//! Rounds of cutting until no two faces meet but in nodes and edges of both.
//!
//! A round finds the faces that meet, puts nodes where they do, rounded to the grid, and cuts the faces there. Rounding
//! moves nodes by up to a cell and so may make faces cross that did not before: the next round looks at the new faces
//! against all. It ends when an *exact* test finds nothing left (iterated snap rounding in space; Lazard & Valque, *Removing
//! self-intersections in triangle meshes*, 2025). Two things hold after every round whatever rounding did, for a face is
//! only ever replaced by faces with the same boundary, and nodes that come to one place are made one: a closed chain stays
//! closed, and no face is farther from the input than the cells that nodes moved by.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use rayon::prelude::*;

use super::MergeError;
use super::box_tree::BoxTree;
use super::complex::Complex;
use super::grid::Grid;
use super::marks::{Finding, Mark};
use super::meeting::{Verdict, meet};
use super::round::Round;
use crate::query::faces_meet_beyond_shared;

/// Parts that all faces together are cut into, times their number, after which a knot is reported.
const MOST_PARTS: usize = 200;
/// Findings of a later round, times those of the first, beyond which faces run away from each other instead of parting; and
/// how many are always let pass.
const RUNAWAY: usize = 4;
const ALWAYS: usize = 20_000;
/// Rounds after which a knot is given up.
const MAX_ROUNDS: u32 = 40;
/// A knot is tried again from the start with what coincides stretched by these.
const STRETCHED: [f64; 3] = [1.0, 8.0, 64.0];

/// What resolving took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Effort {
    pub(super) rounds: u32,
    /// Faces that were cut.
    pub(super) cut: usize,
}

/// Cuts the faces of a complex until none meet but in nodes and edges of both; what is within [`Grid::near`] of each other
/// coincides. Near linear in faces, plus what crosses.
///
/// On a coarse grid what is a few cells apart may tie a knot that rounding ties anew in every round; there, what
/// coincides is stretched and all is done again.
pub(super) fn resolve(
    complex: impl Fn() -> Complex,
    grid: &Grid,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Result<(Complex, Effort), MergeError> {
    let mut knot = None;
    for stretched in STRETCHED {
        let mut complex = complex();
        match resolve_once(&mut complex, stretched * grid.near, grid.farthest_near, cancelled) {
            Err(tangled @ MergeError::Tangled { .. }) => knot.get_or_insert(tangled),
            done => return done.map(|effort| (complex, effort)),
        };
    }
    Err(knot.unwrap_or(MergeError::Cancelled))
}

/// Every round after the first, which only concerns what is still in a knot, takes twice the distance of the one before for
/// coincident, up to `farthest`, so that what rounding turns over is not left as it is.
fn resolve_once(
    complex: &mut Complex,
    near: f64,
    farthest: f64,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Result<Effort, MergeError> {
    let mut effort = Effort::default();
    let first_faces = complex.faces.len();
    let mut first_findings = 0;
    let mut layers: Vec<BoxTree> = Vec::new();
    let mut new: Vec<u32> = complex.present().collect();
    loop {
        if cancelled() {
            return Err(MergeError::Cancelled);
        }
        let round = effort.rounds;
        let near = near.max((near * f64::from(round).exp2()).min(farthest));
        let findings = look(complex, &new, &mut layers, near, round == 0, cancelled);
        if cancelled() {
            return Err(MergeError::Cancelled);
        }
        if findings.is_empty() {
            return Ok(effort);
        }
        first_findings = first_findings.max(if round == 0 { findings.len() } else { 0 });
        let runs_away = findings.len() > RUNAWAY * first_findings + ALWAYS;
        if runs_away || round == MAX_ROUNDS || complex.faces.len() > MOST_PARTS * (first_faces + MOST_PARTS) {
            return Err(MergeError::Tangled { faces: new.len() });
        }
        effort.rounds += 1;
        let before = complex.faces.len();
        new = Round::new(complex, near, cancelled).run(findings);
        effort.cut += complex.faces.len() - before;
    }
}

/// What new faces and all others have in common, and those that are too thin. In the first round whatever is near counts,
/// afterwards only what meets exactly: thin faces alone, which cutting may turn into others as thin, are no reason to go on.
fn look(
    complex: &Complex,
    new: &[u32],
    layers: &mut Vec<BoxTree>,
    near: f64,
    first: bool,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Vec<Finding> {
    let collapses: Vec<(u32, Mark)> =
        new.par_iter().filter_map(|&f| Some((f, complex.corners(f).collapsed(near)?))).collect();
    let mut thin = vec![false; complex.faces.len()];
    collapses.iter().for_each(|(f, _)| thin[*f as usize] = true);
    let mut findings: Vec<Finding> = collapses.into_iter().map(|(_, m)| Finding::Mark(m)).collect();
    let meeting =
        AtomicBool::new(first || new.par_iter().any(|&f| complex.corners(f).collapsed(0.0).is_some()));
    let visit = |f: u32, g: u32, out: &mut Vec<Finding>| {
        if [f, g].iter().any(|&f| complex.gone[f as usize]) || cancelled() {
            return;
        }
        let is_thin = thin[f as usize] || thin[g as usize];
        if is_thin && meeting.load(Relaxed) {
            return;
        }
        let (one, other) = (complex.corners(f), complex.corners(g));
        let crossing = || faces_meet_beyond_shared(one.nodes, other.nodes, |v| complex.at[v as usize]);
        if !first {
            if !crossing() {
                return;
            }
            meeting.store(true, Relaxed);
            if is_thin {
                return;
            }
        }
        let verdict = meet(&one, &other, near, out);
        if verdict == Verdict::Unclear && (!first || crossing()) {
            meet(&one, &other, 0.0, out);
        }
    };
    let margin = if first { near } else { 0.0 };
    let tree = BoxTree::new(new, |f| complex.corners(f).at, margin);
    findings.extend(tree.own_pairs(&visit));
    for layer in &*layers {
        findings.extend(tree.pairs_with(layer, &visit));
    }
    layers.push(tree);
    if !meeting.into_inner() {
        findings.clear();
    }
    findings
}
