//! Several ways to put a sheet together, and which one is kept.
//!
//! Which side of a wall knows more, and whether what was to be removed is better gone, is only seen when the sheet is there: whether it
//! crosses itself, has lost edges, or has left the middle of its walls.

use mesh_kernel::TriMesh;

use super::assemble::{Moved, Sheet, assemble};
use super::exact::Exact;
use super::follow::{follow, split_to};
use super::middle::Middles;
use super::offset::read_off;
use super::segments::Segments;
use super::solid::Solid;
use super::topology::Topology;
use super::twins::Twins;
use super::untangle::{astray, untangle};
use super::walls::Walls;
use super::{DeflateError, DeflateOptions, Watcher};

/// If more than this share of a sheet's curved pieces is astray, it may be made of flat facets.
const FOLDED: f64 = 5e-3;
/// More than this share of them astray is worth another trial.
const ASTRAY: f64 = 0.05;
/// A sheet is truer than another if it has less than this share of what that has astray.
const TRUER: f64 = 0.5;

/// What all trials are made of.
pub(super) struct Trials<'a> {
    pub(super) solid: &'a Solid,
    pub(super) segments: &'a Segments,
    pub(super) walls: &'a Walls,
    pub(super) middles: &'a Middles,
    pub(super) moved: &'a Moved,
    pub(super) exact: &'a Exact,
    pub(super) twins: &'a Twins,
    pub(super) options: &'a DeflateOptions,
}

/// A sheet as it came out.
pub(super) struct Made {
    pub(super) sheet: Sheet,
    /// Pairs of faces that cross.
    pub(super) crossing: usize,
    /// The share of its curved pieces that is not in the middle of the wall.
    astray: f64,
}

/// The sheet that is kept.
pub(super) struct Chosen {
    pub(super) made: Made,
    /// Whether it has what was to be removed.
    pub(super) with_features: bool,
}

impl Made {
    fn faults(&self) -> usize {
        self.crossing + self.sheet.lost
    }

    /// How many joints and parts it has.
    fn seams(&self) -> usize {
        let mesh = TriMesh::new(self.sheet.positions.clone(), self.sheet.faces.clone());
        let topology = Topology::of(&mesh);
        topology.joints + topology.components
    }
}

impl Trials<'_> {
    /// Makes the sheet of the kept groups, without those that are gone. What comes out crossed or astray is tried facet by facet, with the
    /// other sides of walls, and with what was to be removed.
    ///
    /// # Errors
    /// [`DeflateError::Cancelled`] between two trials.
    pub(super) fn best(
        &self,
        gone: &[bool],
        kept: &[bool],
        others: &[bool],
        watcher: &dyn Watcher,
    ) -> Result<Chosen, DeflateError> {
        let mut best = self.stitched(gone, kept);
        if best.faults() > 0 || best.astray > FOLDED {
            best = self.read_off().filter(|made| made.faults() == 0).unwrap_or(best);
        }
        let with_all = vec![false; gone.len()];
        let without = [(gone, others)];
        let with: &[_] = &[(&with_all[..], kept), (&with_all[..], others)];
        let with = if gone.contains(&true) { with } else { &[] };
        let mut with_features = false;
        for (k, (gone, kept)) in without.iter().chain(with).enumerate() {
            let is_with = k > 0;
            if best.faults() == 0 && (best.astray < ASTRAY || is_with) {
                break;
            }
            if watcher.cancelled() {
                return Err(DeflateError::Cancelled);
            }
            let trial = self.stitched(gone, kept);
            let fewer = trial.faults() < best.faults();
            let truer = trial.faults() == best.faults() && trial.astray < TRUER * best.astray;
            // Where it does not meet the rest, it is in pieces or has joints beside each other. With features it has more anyway.
            let meets = (is_with && !with_features) || trial.seams() <= best.seams();
            if (fewer || truer) && meets {
                best = trial;
                with_features = is_with;
            }
        }
        Ok(Chosen { made: best, with_features })
    }

    fn stitched(&self, gone: &[bool], kept: &[bool]) -> Made {
        let Self { solid, segments, walls, middles, moved, exact, twins, options } = *self;
        let kept: Vec<bool> = kept.iter().zip(gone).map(|(kept, gone)| *kept && !gone).collect();
        let mut sheet = assemble(solid, segments, walls, middles, gone, &kept, moved, options);
        follow(&mut sheet, solid, segments, walls, exact, twins, options.edge_length);
        self.made(sheet)
    }

    /// The sheet read off facet by facet, if it can be.
    fn read_off(&self) -> Option<Made> {
        let mut sheet = read_off(self.solid, self.walls)?;
        if let Some(length) = self.options.edge_length {
            split_to(&mut sheet, self.solid, length);
        }
        Some(self.made(sheet))
    }

    fn made(&self, mut sheet: Sheet) -> Made {
        let Self { solid, segments, walls, .. } = *self;
        let crossing = untangle(&mut sheet, solid, segments, walls);
        let astray = astray(&sheet, solid, segments, walls);
        Made { sheet, crossing, astray }
    }
}
