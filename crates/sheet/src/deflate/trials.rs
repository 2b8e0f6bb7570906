//! Several ways to put a sheet together, and which one is kept.
//!
//! Which side of a wall knows more, and whether what was to be removed is better gone, is only seen when the sheet is there: whether it
//! crosses itself, has lost edges, is in parts, or has left the middle of its walls.

use std::cell::OnceCell;
use std::collections::BTreeSet;

use mesh_kernel::TriMesh;
use mesh_kernel::query::{Crossings, RayCaster};

use super::assemble::{Moved, Sheet, Source, assemble};
use super::bare::Bare;
use super::exact::Exact;
use super::follow::{Follow, split_to};
use super::imprint::{Imprinted, imprinted};
use super::looks::mean_thickness;
use super::loose::{Beside, Buried};
use super::middle::Middles;
use super::offset::read_off;
use super::remesh::Remesh;
use super::replace::{Replacement, Way};
use super::segments::Segments;
use super::solid::Solid;
use super::topology::{Topology, components};
use super::twins::Twins;
use super::untangle::{astray, untangle};
use super::walls::Walls;
use super::{DeflateError, DeflateOptions, Steps, Watcher};

/// If more than this share of a sheet's curved pieces is astray, it may be made of flat facets.
const FOLDED: f64 = 5e-3;
/// More than this share of them astray is worth another trial.
const ASTRAY: f64 = 0.05;
/// A sheet is truer than another if it has less than this share of what that has astray.
const TRUER: f64 = 0.5;
/// Imprinting is of use if this share of the borders is not loose any more.
const MOSTLY: f64 = 0.5;
/// So many times what comes to cross is held before.
const HOLDINGS: usize = 5;

/// What all trials are made of.
pub(super) struct Trials<'a> {
    pub(super) solid: &'a Solid,
    /// In how many parts the solid is.
    pub(super) parts: usize,
    pub(super) segments: &'a Segments,
    pub(super) walls: &'a Walls,
    /// By group, which set of walls it is of that are kept on one side or the other together.
    pub(super) set_of: Vec<u32>,
    pub(super) middles: &'a Middles,
    pub(super) replacement: &'a Replacement<'a>,
    pub(super) exact: &'a Exact,
    pub(super) twins: &'a Twins,
    pub(super) options: &'a DeflateOptions,
    pub(super) watcher: &'a dyn Watcher,
}

/// A sheet as it came out.
pub(super) struct Made {
    pub(super) sheet: Sheet,
    /// Pairs of faces that cross.
    pub(super) crossing: Vec<(u32, u32)>,
    /// Rays that its faces stop.
    caster: RayCaster,
    /// In how many more parts than the solid it is.
    torn: usize,
    /// The share of its curved pieces that is not in the middle of the wall.
    astray: f64,
}

/// The sheet that is kept.
pub(super) struct Chosen {
    pub(super) made: Made,
    /// Whether it has what was to be removed.
    pub(super) with_features: bool,
    /// What has no mid-surface.
    pub(super) bare: Bare,
    /// What ends inside the material.
    pub(super) buried: Buried,
}

impl Made {
    fn faults(&self) -> usize {
        self.crossing.len() + self.sheet.lost
    }

    /// How many joints, borders and parts it has.
    fn seams(&self) -> usize {
        let mesh = TriMesh::new(self.sheet.positions.clone(), self.sheet.faces.clone());
        let topology = Topology::of(&mesh);
        topology.joints + topology.free_loops + topology.components
    }
}

impl Trials<'_> {
    /// Makes the sheet of the kept groups, without those that are gone, with nodes where middles meet. What comes out crossed, in parts or astray
    /// is tried facet by facet, with nodes moved upright, with the other sides of walls, and with what was to be removed.
    ///
    /// # Errors
    /// [`DeflateError::Cancelled`] between two trials.
    pub(super) fn best(
        &self,
        gone: &[bool],
        kept: &[bool],
        others: &[bool],
        meeting: Moved,
    ) -> Result<Chosen, DeflateError> {
        let (assembled, mut best) = self.as_it_comes(gone, kept, &meeting);
        if best.faults() > 0 {
            // Webs that end beside a wall may cross it, and nothing else may be wrong.
            let bare = self.bare(&best, gone);
            best = self.joined(best, bare, gone).0;
        }
        if best.faults() > 0 || best.astray > FOLDED || best.torn > 0 {
            let is_true = |made: &Made| {
                let is_true = made.faults() == 0 && made.astray < best.astray.max(ASTRAY);
                is_true && self.bare(made, gone).area() <= self.bare(&best, gone).area()
            };
            let read_off = self.read_off().filter(is_true);
            best = match read_off {
                Some(made) => self.rounded(made),
                None if best.crossing.is_empty() => best,
                None => self.mended(assembled, best),
            };
        }
        let with_all = vec![false; gone.len()];
        let upright = OnceCell::new();
        let without =
            [(gone, kept, Way::Upright), (gone, others, Way::Meeting), (gone, others, Way::Upright)];
        let with: &[_] = &[(&with_all[..], kept, Way::Meeting), (&with_all[..], others, Way::Meeting)];
        let with = if gone.contains(&true) { with } else { &[] };
        let mut with_features = false;
        for (k, (gone, kept, way)) in without.iter().chain(with).enumerate() {
            let is_with = k >= without.len();
            if best.faults() == 0 && (is_with || best.torn == 0 && best.astray < ASTRAY) {
                break;
            }
            // What has no faults is no truer upright.
            if best.faults() == 0 && *way == Way::Upright {
                continue;
            }
            if self.watcher.cancelled() {
                return Err(DeflateError::Cancelled);
            }
            let trial = match way {
                Way::Meeting => self.stitched(gone, kept, &meeting),
                Way::Upright => {
                    self.stitched(gone, kept, upright.get_or_init(|| self.replacement.moved(*way)))
                }
            };
            let whole = trial.torn < best.torn && trial.astray < best.astray.max(ASTRAY);
            let is_as_good = trial.faults() == best.faults() && trial.torn <= best.torn;
            let fewer = trial.faults() < best.faults() || whole && is_as_good;
            let truer = is_as_good && trial.astray < TRUER * best.astray;
            // Where it does not meet the rest, it is in pieces or has holes, or joints beside each other. With features it has more anyway.
            let meets = (is_with && !with_features) || trial.seams() <= best.seams();
            let is_as_whole = || self.bare(&trial, gone).area() <= self.bare(&best, gone).area();
            if (fewer || truer) && meets && is_as_whole() {
                best = trial;
                with_features = is_with;
            }
        }
        let mut bare = self.bare(&best, gone);
        if let Some(kept) = bare.kept_behind_lumps(self.walls, self.middles, kept) {
            let gone = if with_features { &with_all } else { gone };
            let trial = self.stitched(gone, &kept, &meeting);
            let left = self.bare(&trial, gone);
            // The hole before a lump is a border of its own.
            let is_no_worse = trial.faults() <= best.faults() && trial.torn <= best.torn;
            if is_no_worse && trial.seams() < best.seams() && left.area() < bare.area() {
                (best, bare) = (trial, left);
            }
        }
        let gone = if with_features { &with_all } else { gone };
        (best, bare) = self.joined(best, bare, gone);
        let mut buried = self.buried(&best);
        if let Some(kept) = self.turned(&best, &buried, kept) {
            let trial = self.stitched(gone, &kept, &meeting);
            let left = self.bare(&trial, gone);
            let (trial, left) = self.joined(trial, left, gone);
            let still = self.buried(&trial);
            let is_no_worse = trial.faults() <= best.faults() && trial.torn <= best.torn;
            let is_as_true = trial.astray < best.astray.max(ASTRAY) && left.area() <= bare.area();
            if is_no_worse && is_as_true && still.length < TRUER * buried.length {
                (best, bare, buried) = (trial, left, still);
            }
        }
        Ok(Chosen { made: best, with_features, bare, buried })
    }

    /// A sheet with its loose borders on the faces beside them, if it is better so.
    fn joined(&self, made: Made, bare: Bare, gone: &[bool]) -> (Made, Bare) {
        let joined = imprinted(&made.sheet, &self.beside(&made), self.options.edge_length);
        let Some(Imprinted { sheet, length }) = joined else { return (made, bare) };
        let trial = match self.options.edge_length {
            Some(_) => self.followed(sheet, &[]),
            None => self.made(sheet),
        };
        let loose = |made: &Made| self.beside(made).loose_length(&made.sheet);
        let left = self.bare(&trial, gone);
        let is_no_worse =
            trial.faults() <= made.faults() && trial.torn <= made.torn && left.area() <= bare.area();
        if is_no_worse && loose(&trial) < loose(&made) - MOSTLY * length {
            (trial, left)
        } else {
            (made, bare)
        }
    }

    /// The groups that are kept if curved walls with borders inside the material are kept on their other sides: where a web is as wide as the
    /// facets that it ends on, these are seen on the other side only. `None` if there are none such.
    fn turned(&self, made: &Made, buried: &Buried, kept: &[bool]) -> Option<Vec<bool>> {
        let of = |f: &u32| match made.sheet.sources[*f as usize] {
            Source::Facet(f) => Some(self.set_of[self.segments.of(f) as usize]),
            Source::Plane(_) => None,
        };
        let sets: BTreeSet<u32> = buried.faces.iter().filter_map(of).collect();
        let turned =
            |(g, kept): (usize, &bool)| self.walls.is_wall[g] && *kept != sets.contains(&self.set_of[g]);
        (!sets.is_empty()).then(|| kept.iter().enumerate().map(turned).collect())
    }

    fn beside<'b>(&'b self, made: &'b Made) -> Beside<'b> {
        let thickness = mean_thickness(&self.walls.pairs).unwrap_or(self.walls.max_thickness);
        Beside { sheet: &made.caster, solid: self.solid, thickness }
    }

    /// What ends inside the material, but for plates that were to end where the thickness steps.
    fn buried(&self, made: &Made) -> Buried {
        match self.options.steps {
            Steps::Apart => Buried::default(),
            _ => self.beside(made).buried(&made.sheet),
        }
    }

    /// What of the walls has no mid-surface, but for what is to be removed.
    fn bare(&self, made: &Made, gone: &[bool]) -> Bare {
        Bare::new(&made.caster, self.solid, self.segments, self.walls, gone)
    }

    /// The sheet stitched together. If it crosses itself, it is mended.
    fn stitched(&self, gone: &[bool], kept: &[bool], moved: &Moved) -> Made {
        let (assembled, made) = self.as_it_comes(gone, kept, moved);
        if made.crossing.is_empty() { made } else { self.mended(assembled, made) }
    }

    /// The sheet before it follows the middle, and after it.
    fn as_it_comes(&self, gone: &[bool], kept: &[bool], moved: &Moved) -> (Sheet, Made) {
        let Self { solid, segments, walls, middles, options, .. } = *self;
        let kept: Vec<bool> = kept.iter().zip(gone).map(|(kept, gone)| *kept && !gone).collect();
        let assembled = assemble(solid, segments, walls, middles, gone, &kept, moved, options);
        let made = self.followed(assembled.clone(), &[]);
        (assembled, made)
    }

    /// A sheet that follows the middle, but for what is held.
    fn followed(&self, mut sheet: Sheet, held: &[bool]) -> Made {
        let Self { solid, segments, walls, exact, twins, options, .. } = *self;
        let remesh = Remesh { solid, held };
        Follow { remesh, segments, walls, exact, twins }.run(&mut sheet, options.edge_length);
        self.made(sheet)
    }

    /// A sheet that crosses itself after following the middle: what crosses before is drawn, what comes to cross is held as it was.
    fn mended(&self, mut assembled: Sheet, made: Made) -> Made {
        let Self { solid, segments, walls, options, .. } = *self;
        let mut best = made;
        let mut held = vec![false; solid.len() as usize];
        untangle(&mut assembled, solid, segments, walls);
        let holdings = if options.edge_length.is_some() { 1 } else { HOLDINGS };
        for _ in 0..holdings {
            let made = self.followed(assembled.clone(), &held);
            let crossing = made.crossing.iter().flat_map(|(f, g)| [*f, *g]);
            let mut more = false;
            for f in crossing {
                if let Source::Facet(f) = made.sheet.sources[f as usize] {
                    more |= !std::mem::replace(&mut held[f as usize], true);
                }
            }
            if made.faults() < best.faults() {
                best = made;
            }
            if !more || self.watcher.cancelled() {
                break;
            }
        }
        untangle(&mut best.sheet, solid, segments, walls);
        self.made(best.sheet)
    }

    /// The sheet read off facet by facet, if it can be.
    fn read_off(&self) -> Option<Made> {
        let mut sheet = read_off(self.solid, self.segments, self.walls)?;
        if let Some(length) = self.options.edge_length {
            split_to(&mut sheet, self.solid, length);
        }
        Some(self.made(sheet))
    }

    /// A sheet of flat facets that was meshed to an edge length, with its nodes on the exact middles of round walls, unless it crosses
    /// itself then.
    fn rounded(&self, made: Made) -> Made {
        if self.options.edge_length.is_none() {
            return made;
        }
        let mut sheet = made.sheet.clone();
        let remesh = Remesh { solid: self.solid, held: &[] };
        let nodes = remesh.nodes(&sheet);
        self.exact.settle(&mut sheet, &nodes);
        let rounded = self.made(sheet);
        if rounded.faults() == 0 { rounded } else { made }
    }

    fn made(&self, sheet: Sheet) -> Made {
        let Self { solid, segments, walls, .. } = *self;
        let mesh = TriMesh::new(sheet.positions.clone(), sheet.faces.clone());
        let crossings = Crossings::new(&mesh);
        let crossing = crossings.self_crossing();
        let caster = crossings.caster(&mesh);
        let astray = astray(&sheet, solid, segments, walls);
        let parts = components(sheet.positions.len(), &sheet.faces);
        let torn = if self.options.steps == Steps::Apart { 0 } else { parts.saturating_sub(self.parts) };
        Made { sheet, crossing, caster, torn, astray }
    }
}
