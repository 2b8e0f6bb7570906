//! Runs: corners of a disk that share one offset point.
//!
//! A disk is cut into runs at its wedges that are not smooth. Where the offset planes of a run do not meet in one point
//! near the node, the run is cut further: first at concave folds, then at mitres, at last everywhere.

use glam::DVec3;
use rayon::prelude::*;

use super::clean_sheet::CleanSheet;
use super::entities::{Entities, face_of, next, previous, use_of};
use super::offset_point::{Plane, meeting};

/// A wedge that bends by no more than this, in radians, is smooth (30°).
pub(super) const SMOOTH: f64 = std::f64::consts::FRAC_PI_6;
/// A concave wedge that bends by more than this, in radians, is left to the union (130°).
const DEEPEST_CONCAVE: f64 = 130.0 / 180.0 * std::f64::consts::PI;
/// A convex wedge that bends by more than this, in radians, has no mitre (175°).
const SHARPEST_MITRE: f64 = 175.0 / 180.0 * std::f64::consts::PI;
/// Farthest that the offset point of a smooth run may be, and that of one with a concave fold, in depths.
const FAR_SMOOTH: f64 = 1.5;
const FAR_CONCAVE: f64 = 2.5;
/// The same for a smooth run that is nowhere convex: in a hollow cone the offset planes do meet that far inside.
const FAR_HOLLOW: f64 = 10.0;
/// A wedge that turns by no more than this, in radians, is flat.
const FLAT: f64 = 1e-9;
/// Farthest that a plane may miss the offset point of a smooth run, and that of one with a fold inside, in depths.
const MISS_SMOOTH: f64 = 0.05;
const MISS_FOLD: f64 = 0.01;
/// How far the offset point of a run with a concave fold may leave the plane across the edge at its end, in depths:
/// else arcs and thickness faces there would slant.
const SLANT: f64 = 1e-7;
/// Depths within this share of each other are one.
const SAME_DEPTH: f64 = 1e-12;

/// The offset point of a corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct CornerOffset {
    /// The point, seen from the node.
    pub(super) x: DVec3,
    /// Name of its run, equal for the corners of one.
    pub(super) run: u32,
    /// Whether the run goes over a concave fold.
    pub(super) over_fold: bool,
}

/// What the offset points depend on.
#[derive(Clone, Copy, Debug)]
pub(super) struct RunRules<'a> {
    pub(super) sheet: &'a CleanSheet,
    pub(super) entities: &'a Entities,
    /// Depth of every corner, in millimetres.
    pub(super) depth: &'a [f64],
    /// Longest mitre in depths; `None`: round folds.
    pub(super) mitre_limit: Option<f64>,
    /// Face-uses that are tight (see [`super::tight`]): none is in a run with one that is not.
    pub(super) tight: &'a [bool],
}

/// How far a run has been cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Cut {
    Nowhere,
    AtConcaveFolds,
    AtMitres,
    Everywhere,
}

/// What lies between a corner and the next of its disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Join {
    Smooth,
    Concave,
    Mitre,
    Break,
}

impl Join {
    fn holds(self, cut: Cut) -> bool {
        match self {
            Self::Smooth => cut < Cut::Everywhere,
            Self::Mitre => cut < Cut::AtMitres,
            Self::Concave => cut < Cut::AtConcaveFolds,
            Self::Break => false,
        }
    }
}

/// A corner of a disk as its runs see it.
#[derive(Clone, Copy, Debug)]
struct DiskCorner {
    plane: Plane,
    join: Join,
    /// How far the wedge between this corner and the next opens beyond 180°, in radians.
    turn: f64,
    /// Direction of the edge shared with the next corner, away from the node.
    edge: DVec3,
}

/// A disk on its way to offset points.
struct Disk<'a> {
    corners: &'a [DiskCorner],
    mitre_limit: f64,
    /// Place of its first corner.
    start: u32,
    offsets: Vec<CornerOffset>,
    /// A mitre was given up.
    gave_up_mitre: bool,
    planes: Vec<Plane>,
}

/// Disks that one thread handles at a time.
const CHUNK: usize = 1024;

/// The offset points of all corners, by place, and the disks where a mitre was longer than the limit.
///
/// Disks for which `cut_concave` holds are cut at their concave folds. O(n) on all threads.
pub(super) fn corner_offsets(
    rules: RunRules<'_>,
    cut_concave: &(dyn Fn(usize) -> bool + Sync),
) -> (Vec<CornerOffset>, Vec<usize>) {
    let disks = rules.entities.disks();
    let chunks: Vec<(Vec<CornerOffset>, Vec<usize>)> = (0..disks.div_ceil(CHUNK))
        .into_par_iter()
        .map(|chunk| {
            let (mut all, mut long) = (Vec::new(), Vec::new());
            let (mut corners, mut offsets, mut planes) = (Vec::new(), Vec::new(), Vec::new());
            for d in chunk * CHUNK..((chunk + 1) * CHUNK).min(disks) {
                rules.gather(d, &mut corners);
                let mut disk = Disk {
                    corners: &corners,
                    mitre_limit: rules.mitre_limit.unwrap_or(0.0),
                    start: rules.entities.disk_start[d],
                    offsets,
                    gave_up_mitre: false,
                    planes,
                };
                let blank = CornerOffset { x: DVec3::ZERO, run: 0, over_fold: false };
                disk.offsets.clear();
                disk.offsets.resize(corners.len(), blank);
                let cut = if cut_concave(d) { Cut::AtConcaveFolds } else { Cut::Nowhere };
                disk.cut_cycle(0, corners.len(), cut, true);
                all.extend_from_slice(&disk.offsets);
                if disk.gave_up_mitre {
                    long.push(d);
                }
                (offsets, planes) = (disk.offsets, disk.planes);
            }
            (all, long)
        })
        .collect();
    let (mut offsets, mut long) = (Vec::with_capacity(rules.depth.len()), Vec::new());
    for (some, some_long) in chunks {
        offsets.extend(some);
        long.extend(some_long);
    }
    (offsets, long)
}

impl RunRules<'_> {
    fn gather(&self, d: usize, out: &mut Vec<DiskCorner>) {
        out.clear();
        let disk = self.entities.disk(d);
        for (i, &corner) in disk.iter().enumerate() {
            let following = disk[(i + 1) % disk.len()];
            let at = |c: u32| self.sheet.positions[self.entities.node[c as usize] as usize];
            let (to, from) = (at(next(corner)) - at(corner), at(previous(corner)) - at(corner));
            let plane = Plane {
                normal: self.entities.normal(self.sheet, corner),
                depth: self.depth[corner as usize],
                weight: to.angle_between(from),
            };
            out.push(DiskCorner {
                plane,
                join: self.join(corner, following),
                turn: self.entities.turn[following as usize],
                edge: self.entities.direction(self.sheet, following),
            });
        }
    }

    fn join(&self, corner: u32, following: u32) -> Join {
        if face_of(corner) == face_of(following) && self.entities.is_sharp(following) {
            return Join::Break;
        }
        if self.tight[use_of(corner) as usize] != self.tight[use_of(following) as usize] {
            return Join::Break;
        }
        let turn = self.entities.turn[following as usize];
        let (d, e) = (self.depth[corner as usize], self.depth[following as usize]);
        if turn.abs() <= SMOOTH {
            if (d - e).abs() <= SAME_DEPTH * d.max(e) { Join::Smooth } else { Join::Break }
        } else if turn > 0.0 {
            if self.mitre_limit.is_some() && turn <= SHARPEST_MITRE { Join::Mitre } else { Join::Break }
        } else if turn >= -DEEPEST_CONCAVE {
            Join::Concave
        } else {
            Join::Break
        }
    }
}

impl Disk<'_> {
    fn corner(&self, i: usize) -> &DiskCorner {
        &self.corners[i % self.corners.len()]
    }

    /// Cuts `len` corners from `start` on into runs; `whole`: they close a cycle without a break between last and first.
    fn cut_cycle(&mut self, mut start: usize, len: usize, cut: Cut, whole: bool) {
        if whole {
            match (start..start + len).find(|&i| !self.corner(i).join.holds(cut)) {
                None => return self.make_run(start, len, cut, true),
                Some(at) => start = at + 1,
            }
        }
        let end = start + len;
        let mut first = start;
        for i in start..end {
            if i + 1 == end || !self.corner(i).join.holds(cut) {
                self.make_run(first, i + 1 - first, cut, false);
                first = i + 1;
            }
        }
    }

    /// Gives a run its offset point, or cuts it further.
    fn make_run(&mut self, start: usize, len: usize, cut: Cut, whole: bool) {
        self.planes.clear();
        for i in start..start + len {
            let plane = self.corner(i).plane;
            self.planes.push(plane);
        }
        let met = meeting(&self.planes);
        let joins = start..start + len - usize::from(!whole);
        let has = |join| joins.clone().any(|i| self.corner(i).join == join);
        let (concave, mitre) = (has(Join::Concave), has(Join::Mitre));
        let depth = self.planes.iter().map(|p| p.depth).fold(0.0, f64::max);
        let hollow = joins.clone().all(|i| self.corner(i).turn <= FLAT);
        let far = match (concave, mitre) {
            (false, false) if hollow => FAR_HOLLOW,
            (false, false) => FAR_SMOOTH,
            (true, false) => FAR_CONCAVE,
            (false, true) => FAR_SMOOTH.max(self.mitre_limit),
            (true, true) => FAR_CONCAVE.max(self.mitre_limit),
        };
        let miss = if concave || mitre { MISS_FOLD } else { MISS_SMOOTH };
        // A little more, lest a mitre of exactly the limit hang on rounding.
        let fits = met.x.length() <= far * depth * (1.0 + 1e-9)
            && met.residual <= miss * depth
            && (whole || !concave || self.is_square_at_ends(start, len, met.x, depth));
        if fits || len == 1 {
            let run = self.start + (start % self.corners.len()) as u32;
            for i in start..start + len {
                let at = i % self.corners.len();
                self.offsets[at] = CornerOffset { x: met.x, run, over_fold: concave };
            }
            return;
        }
        let further = match cut {
            Cut::Nowhere => Cut::AtConcaveFolds,
            Cut::AtConcaveFolds => {
                self.gave_up_mitre |= mitre;
                Cut::AtMitres
            }
            Cut::AtMitres | Cut::Everywhere => Cut::Everywhere,
        };
        self.cut_cycle(start, len, further, whole);
    }

    /// Whether the offset point lies in the planes across the edges at both ends of a run.
    fn is_square_at_ends(&self, start: usize, len: usize, x: DVec3, depth: f64) -> bool {
        let ends = [
            (self.corner(start), self.corner(start + self.corners.len() - 1).edge),
            (self.corner(start + len - 1), self.corner(start + len - 1).edge),
        ];
        ends.iter().all(|(corner, edge)| x.dot(corner.plane.normal.cross(*edge)).abs() <= SLANT * depth)
    }
}
