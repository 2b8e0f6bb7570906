//! Where parts of the body join, going up: legs at the crotch, arms at the armpits, the head on its neck; and what that
//! tells about the proportions.

use mesh_kernel::glam::{DVec2, DVec3};

use super::figure::{Figure, Level, Side};
use super::plates::arm_plate;
use super::ring::{Ring, depth_at};
use crate::dress_form::HEADLESS_HEIGHT_RATIO;

/// The stature, also of a form without a head, which is taken to end at the neck as [the program's own forms](HEADLESS_HEIGHT_RATIO) do.
pub(crate) fn stature_guess(figure: &Figure<'_>) -> f64 {
    if has_head(figure) { figure.height } else { figure.height / HEADLESS_HEIGHT_RATIO }
}

/// Heights of a body by the parts of an average adult's stature, so that children and forms compare.
pub(crate) struct Proportions {
    stature: f64,
    crotch: f64,
    armpit: f64,
}

impl Proportions {
    /// Crotch and armpits of the average adult over the stature.
    const CROTCH: f64 = 0.475;
    const ARMPIT: f64 = 0.757;

    pub(crate) fn of(figure: &Figure<'_>) -> Self {
        let stature = stature_guess(figure);
        let i = lowest_joined(figure);
        let crotch =
            if i > figure.index(0.3 * figure.height) { figure.levels[i].y } else { Self::CROTCH * stature };
        let found = Side::BOTH.map(|s| armpit(figure, stature, s).or_else(|| plate(figure, stature, s)));
        let armpits: Vec<f64> = found.iter().flatten().map(|a| a.place.y).collect();
        let armpit = if armpits.is_empty() {
            Self::ARMPIT * stature
        } else {
            armpits.iter().sum::<f64>() / armpits.len() as f64
        };
        Self { stature, crotch, armpit: armpit.clamp(crotch + 0.1 * stature, 0.95 * stature) }
    }

    /// The stature.
    pub(crate) fn stature(&self) -> f64 {
        self.stature
    }

    /// Height of the place that lies at a part of the stature on the average adult.
    pub(crate) fn height(&self, part: f64) -> f64 {
        let knots =
            [(0.0, 0.0), (Self::CROTCH, self.crotch), (Self::ARMPIT, self.armpit), (1.0, self.stature)];
        let i = knots[1..3].iter().filter(|k| part > k.0).count();
        let t = (part - knots[i].0) / (knots[i + 1].0 - knots[i].0);
        knots[i].1 + t * (knots[i + 1].1 - knots[i].1)
    }
}

/// The lowest level, going down from the waist, that crosses the plane of symmetry.
fn lowest_joined(figure: &Figure<'_>) -> usize {
    let mut i = figure.index(0.58 * figure.height);
    while i > 0 && joined(&figure.levels[i - 1]) {
        i -= 1;
    }
    i
}

fn joined(level: &Level) -> bool {
    level.trunk().is_some_and(|t| depth_at(&t.points, 0.0).is_some())
}

/// Where the legs join: the crotch point, the height at which they do, and whether there are two at all.
pub(crate) struct Crotch {
    pub(crate) point: DVec3,
    pub(crate) level: f64,
    pub(crate) legs: bool,
}

/// Where the legs join, going down from the waist: the lowest point of the section through the plane of symmetry.
pub(crate) fn crotch(figure: &Figure<'_>, warnings: &mut Vec<String>) -> Crotch {
    let h = figure.height;
    let i = lowest_joined(figure);
    let mut torn = false;
    let mut legs = i > figure.index(0.36 * h);
    let mut y = figure.levels[i].y;
    if legs {
        y = lowest(figure.levels[i - 1].y, y, |y| joined(&figure.at(y)));
        if !joined(&figure.parted_at(y + 2.0)) {
            // A hole in the skin: the legs join somewhere between the lowest place where its rims may be bridged and the
            // lowest place where nothing is missing.
            let above = figure.between(y, y + 0.05 * h).iter().find(|l| joined(&figure.parted_at(l.y)));
            if let Some(l) = above {
                warnings.push("the skin has a hole at the crotch: its height is an estimate".to_owned());
                y = (y + l.y) / 2.0;
                torn = true;
            }
        }
        // Thighs that touch join lower than the legs do; the bridge between them is shallow, the pelvis is deep at once.
        let depth = |l: &Level| {
            let t = l.trunk()?;
            depth_at(&t.points, 0.0).map(|[back, front]| (front - back) / (t.hi.y - t.lo.y))
        };
        if !torn && depth(&figure.at(y + 0.007 * h)).is_some_and(|d| d < 0.22) {
            let above = figure.between(y, 0.54 * h);
            if let Some(l) = above.iter().find(|l| depth(l).is_some_and(|d| d > 0.36)) {
                y = l.y - 0.004 * h;
                warnings
                    .push("the thighs touch: the crotch was put where the pelvis becomes deep".to_owned());
            }
        }
    } else {
        legs = false;
        y = 0.475 * h;
        warnings.push("the legs do not part: the crotch was put by proportion".to_owned());
    }
    // The skin between the legs rises from front to back; the crotch point is where it reaches 0.5 % of the stature.
    let point_y = y + 0.0048 * h;
    let z = figure
        .midline(point_y)
        .map_or(0.0, |[back, front]| if torn { back + 0.25 * (front - back) } else { back });
    Crotch { point: DVec3::new(0.0, point_y, z), level: y, legs }
}

/// The lowest height between two at which a test begins to hold, by bisection.
fn lowest(mut fails: f64, mut holds: f64, test: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..5 {
        let middle = (fails + holds) / 2.0;
        if test(middle) {
            holds = middle;
        } else {
            fails = middle;
        }
    }
    holds
}

/// Half breadth of the trunk (with the arm, where that has joined it) on one side.
fn half_breadth(level: &Level, side: Side) -> Option<f64> {
    level.trunk().map(|t| if side == Side::Left { t.hi.x } else { -t.lo.x })
}

/// Going up, the height where the trunk's outline takes in the arm: it becomes broader faster than any flank does.
pub(crate) fn armpit(figure: &Figure<'_>, h: f64, side: Side) -> Option<Armpit> {
    let (low, high) = (figure.index(0.655 * h), figure.index(0.86 * h));
    let breadth: Vec<Option<f64>> = figure.levels[low..=high].iter().map(|l| half_breadth(l, side)).collect();
    let ahead = ((0.018 * h / figure.step) as usize).max(1);
    let jump = (1.7 * figure.step).max(6.0);
    let at = (0..breadth.len() - ahead).find(|&i| {
        let (Some(here), Some(next)) = (breadth[i], breadth[i + 1]) else { return false };
        let soon = breadth[i + 1..=i + ahead].iter().flatten().fold(0.0_f64, |a, b| a.max(*b));
        next - here > jump && soon - here > 0.028 * h
    })?;
    let below = breadth[at]?;
    let taken_in = |l: &Level| half_breadth(l, side).is_some_and(|b| b - below > 0.6 * jump);
    let mut y = lowest(figure.levels[low + at].y, figure.levels[low + at + 1].y, |y| taken_in(&figure.at(y)));
    let joined = y;
    if !taken_in(&figure.parted_at(y + 2.0)) {
        // A hole in the skin, whose rims may have been bridged too low.
        let above = figure.between(y, y + 0.04 * h).iter().find(|l| taken_in(&figure.parted_at(l.y)));
        y += above.map_or(0.0, |l| 0.75 * (l.y - y));
    }
    let level = figure.parted_at(y - 0.003 * h);
    let trunk = level.trunk()?;
    let s = side.sign();
    let arm = level
        .rings
        .iter()
        .filter(|r| r.centroid.x * s > 0.5 * below && !std::ptr::eq(*r, trunk) && r.area > 300.0)
        .min_by(|a, b| (a.centroid.x * s).total_cmp(&(b.centroid.x * s)));
    let spot = arm.and_then(|a| between(trunk, a, 0.03 * h)).unwrap_or_else(|| extreme(trunk, side));
    // The web between front and back fold is not level: it is lowest in front of its middle.
    let z = spot.y - 0.006 * h;
    Some(Armpit { place: DVec3::new(spot.x, y, z), joined, plate_top: None })
}

/// The armhole of an armless dress form.
pub(crate) fn plate(figure: &Figure<'_>, stature: f64, side: Side) -> Option<Armpit> {
    let plate = arm_plate(figure.mesh, side, 0.66 * stature, 0.88 * stature, stature)?;
    Some(Armpit { place: plate.bottom, joined: f64::INFINITY, plate_top: Some(plate.top) })
}

/// An armpit, and the height from which outlines take in the arm: lower than the armpit if there is a hole.
#[derive(Clone, Copy)]
pub(crate) struct Armpit {
    pub(crate) place: DVec3,
    pub(crate) joined: f64,
    /// Upper end of the plate of an armless form.
    pub(crate) plate_top: Option<DVec3>,
}

/// Outermost place of an outline, averaged over the outermost 2 mm.
fn extreme(ring: &Ring, side: Side) -> DVec2 {
    let s = side.sign();
    let far = ring.points.iter().map(|p| p.x * s).fold(f64::NEG_INFINITY, f64::max);
    let near: Vec<DVec2> = ring.points.iter().copied().filter(|p| p.x * s > far - 2.0).collect();
    DVec2::new(far * s, near.iter().map(|p| p.y).sum::<f64>() / near.len() as f64)
}

/// Middle of the gap between trunk and arm, averaged over where it is hardly wider than at its narrowest; `None` where
/// it is wider than `widest`.
fn between(trunk: &Ring, arm: &Ring, widest: f64) -> Option<DVec2> {
    let onto = |p: DVec2, ring: &Ring| {
        let n = ring.points.len();
        (0..n)
            .map(|i| {
                let (s, d) = (ring.points[i], ring.points[(i + 1) % n] - ring.points[i]);
                s + d * ((p - s).dot(d) / d.length_squared().max(1e-12)).clamp(0.0, 1.0)
            })
            .min_by(|a, b| a.distance_squared(p).total_cmp(&b.distance_squared(p)))
    };
    let near = 2.0 * widest;
    let mut pairs: Vec<(f64, DVec2)> = Vec::new();
    for (from, to) in [(trunk, arm), (arm, trunk)] {
        for i in 0..from.points.len() {
            let (a, b) = (from.points[i], from.points[(i + 1) % from.points.len()]);
            let pieces = (a.distance(b) / 3.0).ceil().clamp(1.0, 64.0) as u32;
            for k in 0..pieces {
                let p = a.lerp(b, f64::from(k) / f64::from(pieces));
                if p.x < to.lo.x - near || p.x > to.hi.x + near {
                    continue;
                }
                pairs.extend(onto(p, to).map(|q| (p.distance(q), (p + q) / 2.0)));
            }
        }
    }
    let least = pairs.iter().map(|p| p.0).reduce(f64::min).filter(|d| *d < widest)?;
    let (mut weight, mut sum) = (0.0, DVec2::ZERO);
    for (gap, middle) in pairs {
        let w = (0.4 * widest - (gap - least)).max(0.0);
        weight += w;
        sum += middle * w;
    }
    Some(sum / weight)
}

/// Angle between the vertical and the line through the middles of the trunk's outlines at two heights.
pub(crate) fn lean(figure: &Figure<'_>, low: f64, high: f64) -> f64 {
    let middle = |y: f64| figure.at(y).trunk().map(|t| t.centroid);
    match (middle(low), middle(high)) {
        (Some(a), Some(b)) => (a.distance(b) / (high - low)).atan(),
        _ => 0.0,
    }
}

/// A head is broader than the neck below it.
pub(crate) fn has_head(figure: &Figure<'_>) -> bool {
    let h = figure.height;
    let areas: Vec<f64> =
        figure.between(0.76 * h, 0.985 * h).iter().filter_map(|l| l.trunk().map(|t| t.area)).collect();
    let chest =
        figure.between(0.5 * h, 0.8 * h).iter().filter_map(Level::trunk).map(|t| t.area).fold(0.0, f64::max);
    // The narrowest level that is not at the very top: a rounded head is narrow there, too.
    let neck = areas[..areas.len() * 4 / 5].iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1));
    neck.is_some_and(|(i, neck)| {
        *neck < 0.35 * chest && areas[i..].iter().copied().fold(0.0, f64::max) > 1.25 * neck
    })
}
