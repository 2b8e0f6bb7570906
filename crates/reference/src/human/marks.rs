//! Landmarks of trunk, neck and shoulders.

use mesh_kernel::glam::{DVec2, DVec3};
use mesh_kernel::query::SectionStack;

use super::figure::{Figure, Level, Side, ramp, smooth};
use super::plates::arm_plate;
use super::ring::{Ring, breadth_at, depth_at};

/// How far a trunk may lean and still count as upright, radians (people that stand: below 0.2).
const STEEPEST_LEAN: f64 = 0.35;

/// Landmarks in the canonical frame. Pairs are left, right.
#[derive(Clone, Debug)]
pub(crate) struct Marks {
    /// Length that anatomical proportions refer to: the stature, also where the head is missing.
    pub(crate) stature: f64,
    pub(crate) crotch: DVec3,
    /// Height at which the legs join.
    pub(crate) crotch_level: f64,
    pub(crate) armpit: [DVec3; 2],
    /// Height from which the trunk's outline holds the arm.
    pub(crate) joined: [f64; 2],
    /// Whether a flat plate ends the shoulder instead of an arm.
    pub(crate) plates: [bool; 2],
    /// Front and back edge of the neck plate of a form without a head.
    pub(crate) neck_plate: Option<[DVec3; 2]>,
    pub(crate) shoulder: [DVec3; 2],
    pub(crate) neck_side: [DVec3; 2],
    pub(crate) nape: DVec3,
    pub(crate) front_neck: DVec3,
    pub(crate) bust: [DVec3; 2],
    pub(crate) navel: DVec3,
    pub(crate) crown: Option<DVec3>,
    pub(crate) shoulder_line: [Vec<DVec3>; 2],
    /// 0 for a flat chest, 1 for distinct breasts.
    pub(crate) breasts: f64,
    pub(crate) legs: bool,
}

impl Marks {
    /// The trunk's outline without the arms: from where an arm has joined it, it ends at the armpit.
    pub(crate) fn trunk(&self, level: &Level) -> Option<Ring> {
        let mut ring = level.trunk()?.clone();
        for side in Side::BOTH {
            let (i, s) = (side.index(), side.sign());
            if level.y > self.joined[i] - 1.0 {
                ring = ring.cut_off(s, self.armpit[i].x.abs())?;
            }
        }
        Some(ring)
    }

    pub(crate) fn armpit_height(&self) -> f64 {
        (self.armpit[0].y + self.armpit[1].y) / 2.0
    }
}

/// Finds all of them; what had to be guessed goes to `warnings`.
pub(crate) fn find(figure: &Figure<'_>, warnings: &mut Vec<String>) -> Result<Marks, String> {
    let h = figure.height;
    let Crotch { point: crotch, level: crotch_level, legs } = crotch(figure, warnings);
    let head = has_head(figure);
    let stature = stature_guess(figure);
    let found = Side::BOTH.map(|s| armpit(figure, stature, s).or_else(|| plate(figure, stature, s)));
    let armpits = match found {
        [Some(l), Some(r)] => [l, r],
        [Some(one), None] | [None, Some(one)] => {
            warnings.push("one armpit was not found: the other one's mirror image is taken".to_owned());
            let mirrored = |p: DVec3| DVec3::new(-p.x, p.y, p.z);
            let other = Armpit { place: mirrored(one.place), plate_top: one.plate_top.map(mirrored), ..one };
            if one.place.x > 0.0 { [one, other] } else { [other, one] }
        }
        [None, None] => return Err("no arms or armholes stand out from the trunk".to_owned()),
    };
    let (armpit, joined) = (armpits.map(|a| a.place), armpits.map(|a| a.joined));
    let armpit_y = (armpit[0].y + armpit[1].y) / 2.0;
    if !(0.62..0.85).contains(&(armpit_y / stature)) {
        return Err(format!(
            "the armpits would lie at {:.0} % of the height (people: 72 to 79 %)",
            armpit_y / stature * 100.0
        ));
    }
    let lean = lean(figure, crotch_level + 0.1 * stature, armpit_y - 0.02 * stature);
    if lean > STEEPEST_LEAN {
        return Err(format!("it leans by {:.0} degrees; turn it upright", lean.to_degrees()));
    }
    let profile = Profile::new(figure, armpit_y - 0.12 * stature, (armpit_y + 0.19 * stature).min(0.995 * h));
    let NeckMarks { nape, front: front_neck, plate: neck_plate } =
        neck_marks(&profile, armpit_y, stature, head, warnings)?;
    let plates = armpits.map(|a| a.plate_top.is_some());
    let neck_side = [
        neck_side(figure, nape, front_neck, stature, Side::Left),
        neck_side(figure, nape, front_neck, stature, Side::Right),
    ];
    let across = SectionStack::new(figure.mesh, DVec3::X);
    let mut shoulder = [DVec3::ZERO; 2];
    let mut shoulder_line = [Vec::new(), Vec::new()];
    for side in Side::BOTH {
        let i = side.index();
        shoulder[i] =
            armpits[i].plate_top.unwrap_or_else(|| shoulder_point(&across, armpit[i], stature, side));
        shoulder_line[i] = ridge(&across, neck_side[i], shoulder[i]);
    }
    let navel = navel(figure, crotch_level, armpit_y, stature);
    let (bust, breasts) = bust_points(figure, &armpit, stature);
    let crown = head.then(|| crown(figure)).flatten();
    Ok(Marks {
        stature,
        crotch,
        crotch_level,
        armpit,
        joined,
        plates,
        neck_plate,
        shoulder,
        neck_side,
        nape,
        front_neck,
        bust,
        navel,
        crown,
        shoulder_line,
        breasts,
        legs,
    })
}

/// The stature, also of a form without a head: forms end at the neck, at 0.87 of the stature.
fn stature_guess(figure: &Figure<'_>) -> f64 {
    if has_head(figure) { figure.height } else { figure.height / 0.87 }
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
struct Crotch {
    point: DVec3,
    level: f64,
    legs: bool,
}

/// Where the legs join, going down from the waist: the lowest point of the section through the plane of symmetry.
fn crotch(figure: &Figure<'_>, warnings: &mut Vec<String>) -> Crotch {
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
fn armpit(figure: &Figure<'_>, h: f64, side: Side) -> Option<Armpit> {
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
fn plate(figure: &Figure<'_>, stature: f64, side: Side) -> Option<Armpit> {
    let plate = arm_plate(figure.mesh, side, 0.66 * stature, 0.88 * stature, stature)?;
    Some(Armpit { place: plate.bottom, joined: f64::INFINITY, plate_top: Some(plate.top) })
}

/// An armpit, and the height from which outlines take in the arm: lower than the armpit if there is a hole.
#[derive(Clone, Copy)]
struct Armpit {
    place: DVec3,
    joined: f64,
    /// Upper end of the plate of an armless form.
    plate_top: Option<DVec3>,
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
fn lean(figure: &Figure<'_>, low: f64, high: f64) -> f64 {
    let middle = |y: f64| figure.at(y).trunk().map(|t| t.centroid);
    match (middle(low), middle(high)) {
        (Some(a), Some(b)) => (a.distance(b) / (high - low)).atan(),
        _ => 0.0,
    }
}

/// A head is broader than the neck below it.
fn has_head(figure: &Figure<'_>) -> bool {
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

/// Back and front contour on the plane of symmetry, smoothed over 8 mm.
struct Profile {
    y: Vec<f64>,
    back: Vec<f64>,
    front: Vec<f64>,
}

impl Profile {
    fn new(figure: &Figure<'_>, low: f64, high: f64) -> Self {
        let mut p = Self { y: Vec::new(), back: Vec::new(), front: Vec::new() };
        for l in figure.between(low, high) {
            if let Some([back, front]) = l.trunk().and_then(|t| depth_at(&t.points, 0.0)) {
                p.y.push(l.y);
                p.back.push(back);
                p.front.push(front);
            }
        }
        let sigma = 0.005 * figure.height / figure.step;
        p.back = smooth(&p.back, sigma);
        p.front = smooth(&p.front, sigma);
        p
    }

    fn at(&self, values: &[f64], y: f64) -> f64 {
        let i = self.y.partition_point(|v| *v < y).clamp(1, self.y.len() - 1);
        let t = ((y - self.y[i - 1]) / (self.y[i] - self.y[i - 1])).clamp(0.0, 1.0);
        values[i - 1] + t * (values[i] - values[i - 1])
    }
}

struct NeckMarks {
    nape: DVec3,
    front: DVec3,
    /// Front and back edge of the neck plate of a form without a head.
    plate: Option<[DVec3; 2]>,
}

/// Nape (seventh vertebra) and front neck point (pit above the breastbone).
fn neck_marks(
    profile: &Profile,
    armpit_y: f64,
    stature: f64,
    head: bool,
    warnings: &mut Vec<String>,
) -> Result<NeckMarks, String> {
    if profile.y.len() < 12 {
        return Err("there is no neck above the shoulders".to_owned());
    }
    let mut plate = None;
    let mut top = profile.y[profile.y.len() - 1];
    if !head {
        // The neck plate, whose front edge is low, is not part of the neck's contour.
        let mut i = profile.y.len() - 1;
        while i > 2 && profile.front[i - 1] - profile.front[i] > 1.2 * (profile.y[i] - profile.y[i - 1]) {
            i -= 1;
        }
        // The contour is smoothed: stay clear of the edge.
        i = i.saturating_sub(2);
        top = profile.y[i];
        let last = profile.y.len() - 1;
        plate = Some([
            DVec3::new(0.0, top, profile.front[i]),
            DVec3::new(0.0, profile.y[last], profile.back[last]),
        ]);
    }
    let nape_y = if head {
        // The nape lies below the deepest place of the neck's hollow by 4.9 % of the stature (within 5 mm).
        let range = armpit_y + 0.07 * stature..armpit_y + 0.165 * stature;
        let hollow = (0..profile.y.len())
            .filter(|i| range.contains(&profile.y[*i]))
            .max_by(|a, b| profile.back[*a].total_cmp(&profile.back[*b]))
            .ok_or("there is no neck above the shoulders")?;
        let y = profile.y[hollow] - 0.049 * stature;
        y.clamp(armpit_y + 0.062 * stature, armpit_y + 0.112 * stature)
    } else {
        warnings.push("no head: neck points were put by proportion".to_owned());
        (armpit_y + 0.086 * stature).min(top - 0.012 * stature)
    };
    let nape = DVec3::new(0.0, nape_y, profile.at(&profile.back, nape_y));
    // The front neck point lies farthest behind the line from the breastbone to the throat.
    let (low, high) = (nape_y - 0.06 * stature, (nape_y + 0.02 * stature).min(top));
    let a = DVec2::new(low, profile.at(&profile.front, low));
    let chord = DVec2::new(high, profile.at(&profile.front, high)) - a;
    let mut best = (f64::NEG_INFINITY, nape_y - 0.012 * stature);
    let count = 80;
    for k in 1..count {
        let y = low + (high - low) * f64::from(k) / f64::from(count);
        let behind = -chord.perp_dot(DVec2::new(y, profile.at(&profile.front, y)) - a);
        if behind > best.0 && y > nape_y - 0.04 * stature {
            best = (behind, y);
        }
    }
    let y = best.1;
    Ok(NeckMarks { nape, front: DVec3::new(0.0, y, profile.at(&profile.front, y)), plate })
}

/// Side of the neck base: a little above the nape, on the outline of the neck.
fn neck_side(figure: &Figure<'_>, nape: DVec3, front: DVec3, stature: f64, side: Side) -> DVec3 {
    let y = nape.y + 0.0105 * stature;
    let z = nape.z + 0.62 * (front.z - nape.z);
    let x = figure
        .at(y)
        .trunk()
        .and_then(|t| breadth_at(&t.points, z))
        .map_or(0.03 * stature * side.sign(), |[lo, hi]| if side == Side::Left { hi } else { lo });
    DVec3::new(x, y, z)
}

/// Section across at `x`: chains of `(front, up)` above a height.
fn upper_chain(across: &SectionStack, x: f64, above: f64) -> Vec<[DVec2; 2]> {
    let mut out = Vec::new();
    for l in across.cut(x) {
        let n = l.points.len();
        for i in 0..if l.closed { n } else { n - 1 } {
            let (a, b) = (l.points[i], l.points[(i + 1) % n]);
            if a.y > above || b.y > above {
                out.push([DVec2::new(a.z, a.y), DVec2::new(b.z, b.y)]);
            }
        }
    }
    out
}

/// Highest crossing of the chains with `front = z`.
fn top_at(chains: &[[DVec2; 2]], z: f64) -> Option<f64> {
    chains
        .iter()
        .filter(|[a, b]| (a.x >= z) != (b.x >= z))
        .map(|[a, b]| a.y + (z - a.x) / (b.x - a.x) * (b.y - a.y))
        .reduce(f64::max)
}

/// Highest place of the chains, its depth averaged over the uppermost 4 mm.
fn crest(chains: &[[DVec2; 2]]) -> Option<DVec2> {
    let top = chains.iter().flatten().map(|p| p.y).reduce(f64::max)?;
    let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
    for [a, b] in chains {
        for (p, q) in [(a, b), (b, a)] {
            if p.y >= top - 4.0 {
                let z =
                    if q.y < top - 4.0 { p.x + (p.y - top + 4.0) / (p.y - q.y) * (q.x - p.x) } else { p.x };
                lo = lo.min(z.min(p.x));
                hi = hi.max(z.max(p.x));
            }
        }
    }
    Some(DVec2::new((lo + hi) / 2.0, top))
}

/// Shoulder point (acromion): above the armpit, a little outward, behind the crest of the shoulder.
fn shoulder_point(across: &SectionStack, armpit: DVec3, stature: f64, side: Side) -> DVec3 {
    let x = armpit.x + 0.007 * stature * side.sign();
    let chains = upper_chain(across, x, armpit.y);
    let crest = crest(&chains).unwrap_or(DVec2::new(armpit.z, armpit.y + 0.062 * stature));
    let z = crest.x - 0.0145 * stature;
    DVec3::new(x, top_at(&chains, z).unwrap_or(crest.y), z)
}

/// The shoulder line: from neck side to shoulder point over the top of the shoulder.
fn ridge(across: &SectionStack, neck: DVec3, shoulder: DVec3) -> Vec<DVec3> {
    let n = 24;
    let mut points: Vec<DVec3> = (0..=n)
        .map(|k| {
            let p = neck.lerp(shoulder, f64::from(k) / f64::from(n));
            if k == 0 || k == n {
                return p;
            }
            let chains = upper_chain(across, p.x, shoulder.y.min(neck.y) - 40.0);
            let y = top_at(&chains, p.z).filter(|y| *y < p.y + 60.0).unwrap_or(p.y);
            DVec3::new(p.x, y, p.z)
        })
        .collect();
    let heights = smooth(&points.iter().map(|p| p.y).collect::<Vec<_>>(), 1.2);
    for (p, y) in points.iter_mut().zip(heights) {
        p.y = y;
    }
    points
}

/// The dimple of the belly on the midline, or its usual place.
fn navel(figure: &Figure<'_>, crotch_y: f64, armpit_y: f64, stature: f64) -> DVec3 {
    let usual = crotch_y + 0.483 * (armpit_y - crotch_y);
    let profile = Profile::new(figure, usual - 0.06 * stature, usual + 0.06 * stature);
    let broad = smooth(&profile.front, 0.016 * stature / figure.step);
    let mut best = (1.2, usual);
    for ((y, front), broad) in profile.y.iter().zip(&profile.front).zip(broad) {
        let dimple = broad - front;
        if (y - usual).abs() < 0.018 * stature && dimple > best.0 {
            best = (dimple, *y);
        }
    }
    let z = if profile.y.len() > 1 { profile.at(&profile.front, best.1) } else { 0.0 };
    DVec3::new(0.0, best.1, z)
}

/// Bust points: where a plane turned outward by 20 degrees first touches each breast. On a flat chest, which has no such
/// place, by proportion to the armpit; between the two the answer passes smoothly.
fn bust_points(figure: &Figure<'_>, armpit: &[DVec3; 2], stature: f64) -> ([DVec3; 2], f64) {
    let armpit_y = (armpit[0].y + armpit[1].y) / 2.0;
    let levels = figure.between(armpit_y - 0.088 * stature, armpit_y - 0.012 * stature);
    let direction =
        |side: Side| DVec2::new(side.sign() * 20.0_f64.to_radians().sin(), 20.0_f64.to_radians().cos());
    let mut touch = [DVec3::ZERO; 2];
    for side in Side::BOTH {
        let (d, outer) = (direction(side), armpit[side.index()].x.abs());
        let reach: Vec<(f64, DVec3)> = levels
            .iter()
            .filter_map(|l| {
                let points = &l.trunk()?.points;
                let p = points
                    .iter()
                    .filter(|p| p.x * side.sign() > 0.02 * stature && p.x * side.sign() < outer)
                    .max_by(|a, b| a.dot(d).total_cmp(&b.dot(d)))?;
                Some((p.dot(d), DVec3::new(p.x, l.y, p.y)))
            })
            .collect();
        let Some(best) = reach.iter().map(|r| r.0).reduce(f64::max) else { continue };
        // Averaged over what lies within 1 mm of the plane: noise and facets move the single farthest node.
        let (mut weight, mut sum) = (0.0, DVec3::ZERO);
        for (value, p) in &reach {
            let w = (1.5 - (best - value)).max(0.0);
            weight += w;
            sum += *p * w;
        }
        touch[side.index()] = sum / weight;
    }
    let y = (touch[0].y + touch[1].y) / 2.0;
    let inner = y > armpit_y - 0.086 * stature && y < armpit_y - 0.014 * stature;
    let gap = figure.at(y).trunk().map_or(0.0, |t| {
        let (skin, taut) = (depth_at(&t.points, 0.0), depth_at(&t.hull(), 0.0));
        skin.zip(taut).map_or(0.0, |(s, t)| t[1] - s[1])
    });
    let breasts = if inner { ramp(0.003 * stature, 0.009 * stature, gap) } else { 0.0 };
    let mut bust = [DVec3::ZERO; 2];
    for side in Side::BOTH {
        let i = side.index();
        let flat_x = armpit[i].x * 0.56;
        let flat_y = armpit_y - 0.029 * stature;
        let x = flat_x + breasts * (touch[i].x - flat_x);
        let y = flat_y + breasts * (touch[i].y - 0.003 * stature - flat_y);
        let z = figure.at(y).trunk().and_then(|t| depth_at(&t.points, x)).map_or(touch[i].z, |d| d[1]);
        bust[i] = DVec3::new(x, y, z);
    }
    (bust, breasts)
}

fn crown(figure: &Figure<'_>) -> Option<DVec3> {
    let level = figure.levels.iter().rev().find(|l| l.trunk().is_some())?;
    let [a, b] = depth_at(&level.trunk()?.points, 0.0)?;
    Some(DVec3::new(0.0, figure.height, (a + b) / 2.0))
}
