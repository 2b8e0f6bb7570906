//! Rounds of cutting until no two faces meet but in nodes and edges of both.
//!
//! A round finds the faces that meet, puts nodes where they do, rounded to the grid, and cuts the faces there. Rounding
//! moves nodes by up to a cell and so may make faces cross that did not before: the next round looks at the new faces
//! against all. It ends when an *exact* test finds nothing left (iterated snap rounding in space; Lazard & Valque, *Removing
//! self-intersections in triangle meshes*, 2025). Two things hold after every round whatever rounding did, for a face is
//! only ever replaced by faces with the same boundary, and nodes that come to one place are made one: a closed chain stays
//! closed, and no face is farther from the input than the cells that nodes moved by.

use rayon::prelude::*;

use super::MergeError;
use super::box_tree::BoxTree;
use super::complex::Complex;
use super::marks::{Finding, Mark};
use super::meeting::{Verdict, meet};
use super::round::Round;
use crate::query::faces_meet_beyond_shared;

/// Every round after the first, which only concerns what is still in a knot, takes twice the distance of the one before for
/// coincident, so that what rounding turns over is not left as it is; so often at most.
const MOST_DOUBLINGS: u32 = 14;
/// Parts that all faces together are cut into, times their number, after which a knot is reported.
const MOST_PARTS: usize = 200;
/// Rounds after which a knot is reported.
const MAX_ROUNDS: u32 = 40;

/// What resolving took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Effort {
    pub(super) rounds: u32,
    /// Faces that were cut.
    pub(super) cut: usize,
}

/// Cuts faces until none meet but in nodes and edges of both; what is within `near` cells of each other coincides. Near linear
/// in faces, plus what crosses.
pub(super) fn resolve(
    complex: &mut Complex,
    near: f64,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Result<Effort, MergeError> {
    let mut effort = Effort::default();
    let first_faces = complex.faces.len();
    let mut layers: Vec<BoxTree> = Vec::new();
    let mut new: Vec<u32> = complex.present().collect();
    loop {
        if cancelled() {
            return Err(MergeError::Cancelled);
        }
        let round = effort.rounds;
        let near = near * f64::from(1u32 << round.min(MOST_DOUBLINGS));
        let findings = look(complex, &new, &mut layers, near, round == 0, cancelled);
        if cancelled() {
            return Err(MergeError::Cancelled);
        }
        if findings.is_empty() {
            return Ok(effort);
        }
        if round == MAX_ROUNDS || complex.faces.len() > MOST_PARTS * (first_faces + MOST_PARTS) {
            return Err(MergeError::Tangled { faces: new.len() });
        }
        effort.rounds += 1;
        let before = complex.faces.len();
        new = Round::new(complex, near, cancelled).run(findings);
        effort.cut += complex.faces.len() - before;
    }
}

/// What new faces and all others have in common, and those that are too thin. In the first round whatever is near counts,
/// afterwards only what meets exactly.
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
    let visit = |f: u32, g: u32, out: &mut Vec<Finding>| {
        let skip = |f: u32| complex.gone[f as usize] || thin[f as usize];
        if skip(f) || skip(g) || cancelled() {
            return;
        }
        let (one, other) = (complex.corners(f), complex.corners(g));
        let crossing = || faces_meet_beyond_shared(one.nodes, other.nodes, |v| complex.at[v as usize]);
        if !first && !crossing() {
            return;
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
    findings
}
