//! Landmarks of trunk, neck and shoulders.

use mesh_kernel::glam::{DVec2, DVec3};
use mesh_kernel::query::SectionStack;

use super::figure::{Figure, Level, Side, ramp, smooth};
use super::joins::{Armpit, Crotch, armpit, crotch, has_head, lean, plate, stature_guess};
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
        warnings.push("no head: stature and neck points were put by proportion".to_owned());
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
