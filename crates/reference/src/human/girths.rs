//! Horizontal girths of the trunk, the neck and the armholes.

use mesh_kernel::glam::{DVec2, DVec3};
use mesh_kernel::query::plane_section;
use rayon::prelude::*;

use super::figure::{Figure, Level, Side, ramp, smooth};
use super::marks::Marks;
use super::normals::NormalField;
use super::ring::{Gaps, Ring, depth_at, outer_rings, perimeter};
use crate::model::{FeatureCurve, Features};

/// Spacing of the points of closed curves, millimetres.
const SPACING: f64 = 6.0;
/// Girth that the waist gives up to lie nearer to its usual height, as a part of the distance.
const WAIST_PULL: f64 = 0.025;
/// How far the plane of the neck girth leans forward, degrees.
const NECK_TILT: f64 = 24.0;

/// Heights of the trunk's girths.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TrunkLevels {
    pub(crate) chest: f64,
    pub(crate) bust: f64,
    pub(crate) underbust: f64,
    pub(crate) waist: f64,
    pub(crate) high_hip: f64,
    pub(crate) hip: f64,
}

impl TrunkLevels {
    fn named(&self) -> [(&'static str, f64); 6] {
        [
            ("chest", self.chest),
            ("bust", self.bust),
            ("underbust", self.underbust),
            ("waist", self.waist),
            ("high_hip", self.high_hip),
            ("hip", self.hip),
        ]
    }
}

/// Adds all girths of trunk and neck.
pub(crate) fn add(
    figure: &Figure<'_>,
    marks: &Marks,
    field: &NormalField,
    features: &mut Features,
) -> Result<TrunkLevels, String> {
    let levels = trunk_levels(figure, marks)?;
    for (name, y) in levels.named() {
        let level = figure.at(y);
        let ring = marks.trunk(&level).ok_or_else(|| format!("the trunk has no outline at the {name}"))?;
        let place = |p: &DVec2| DVec3::new(p.x, y, p.y);
        let skin = from_front(&ring.points, SPACING);
        let taut = from_front(&ring.hull(), SPACING);
        features.curves.insert(name.to_owned(), closed(skin.iter().map(place).collect(), DVec3::Y, field));
        features
            .curves
            .insert(format!("{name}_tape"), closed(taut.iter().map(place).collect(), DVec3::Y, field));
    }
    if let Some(curve) = neck(figure, marks, field) {
        features.curves.insert("neck".to_owned(), curve);
    }
    features.curves.insert("neck_base".to_owned(), neck_base(figure, marks, field)?);
    for side in Side::BOTH {
        let curve = armhole(figure, marks, side, field);
        features.curves.insert(side.name("armhole"), curve);
    }
    Ok(levels)
}

/// Tape girths of the trunk between crotch and armpits, and the heights that ISO 8559-1 names by them.
fn trunk_levels(figure: &Figure<'_>, marks: &Marks) -> Result<TrunkLevels, String> {
    let (s, armpit_y, crotch_y) = (marks.stature, marks.armpit_height(), marks.crotch_level);
    let chest = marks.armpit.iter().map(|p| p.y).fold(f64::INFINITY, f64::min) - 2.0;
    let tapes: Vec<(f64, f64)> = figure
        .between(crotch_y, chest)
        .par_iter()
        .filter(|l| l.y > crotch_y && l.y <= chest)
        .filter_map(|l| marks.trunk(l).map(|t| (l.y, t.tape())))
        .collect();
    let fullest = |from: f64, to: f64| {
        tapes.iter().filter(|t| t.0 >= from && t.0 <= to).max_by(|a, b| a.1.total_cmp(&b.1)).map(|t| t.0)
    };
    let missing = |what: &str| {
        format!("the trunk has no outline between crotch and armpits where the {what} should be")
    };
    // The fold under the breasts lies 6.8 % of the stature below the armpits where there are no breasts to show it.
    let underbust = underbust(figure, marks, armpit_y - 0.068 * s);
    let navel = crotch_y + 0.483 * (armpit_y - crotch_y);
    let hip = fullest(crotch_y, navel).ok_or_else(|| missing("hip"))?;
    let ceiling = underbust.min(armpit_y - 0.068 * s);
    let waist = waist(&tapes, hip, ceiling, crotch_y + 0.58 * (armpit_y - crotch_y), s)
        .ok_or_else(|| missing("waist"))?;
    let bust = fullest(underbust, chest).ok_or_else(|| missing("bust"))?;
    let high_hip = hip + 0.5 * (waist - hip);
    Ok(TrunkLevels { chest, bust, underbust, waist, high_hip, hip })
}

/// The narrowest height between hip and underbust. On a trunk that tapers all the way up to the chest, its own shallow
/// narrows if it has any, else `usual`; between the two cases the answer passes smoothly.
fn waist(tapes: &[(f64, f64)], hip: f64, ceiling: f64, usual: f64, stature: f64) -> Option<f64> {
    let range: Vec<(f64, f64)> = tapes.iter().copied().filter(|t| t.0 > hip && t.0 <= ceiling).collect();
    // On a trunk of nearly even girth the usual height decides.
    let cost = |t: &(f64, f64)| t.1 + WAIST_PULL * (t.0 - usual).abs();
    let narrowest = range.iter().min_by(|a, b| cost(a).total_cmp(&cost(b)))?.0;
    let own = ramp(0.001 * stature, 0.006 * stature, ceiling - narrowest);
    if own >= 1.0 || range.len() < 8 {
        return Some(narrowest);
    }
    let even = smooth(&range.iter().map(|t| t.1).collect::<Vec<_>>(), 1.5);
    let narrows = (1..even.len() - 1)
        .filter(|&i| even[i] <= even[i - 1] && even[i] < even[i + 1] && ceiling - range[i].0 > 0.02 * stature)
        .min_by(|a, b| even[*a].total_cmp(&even[*b]))
        .map_or(usual.clamp(hip, ceiling), |i| range[i].0);
    Some(narrows + own * (narrowest - narrows))
}

/// Below the breasts: the deepest fold of the front contour through the bust points.
fn underbust(figure: &Figure<'_>, marks: &Marks, flat: f64) -> f64 {
    if marks.breasts <= 0.0 {
        return flat;
    }
    let s = marks.stature;
    let top = (marks.bust[0].y + marks.bust[1].y) / 2.0;
    let bottom = top - 0.07 * s;
    let mut contour: Vec<DVec2> = Vec::new();
    for l in figure.between(bottom, top) {
        let front = |x: f64| l.trunk().and_then(|t| depth_at(&t.points, x)).map(|d| d[1]);
        if let (Some(a), Some(b)) = (front(marks.bust[0].x), front(marks.bust[1].x)) {
            contour.push(DVec2::new(l.y, (a + b) / 2.0));
        }
    }
    if contour.len() < 4 {
        return flat;
    }
    let a = contour[0];
    let chord = contour[contour.len() - 1] - a;
    let fold = contour
        .iter()
        .min_by(|p, q| chord.perp_dot(**p - a).total_cmp(&chord.perp_dot(**q - a)))
        .map_or(flat, |p| p.x);
    let fold = (fold - 0.004 * s).max(bottom);
    flat + marks.breasts * (fold - flat)
}

/// A closed outline as evenly spaced points that start on the plane of symmetry in front.
pub(crate) fn from_front(points: &[DVec2], spacing: f64) -> Vec<DVec2> {
    let n = points.len();
    let mut start: Option<(usize, DVec2)> = None;
    for i in 0..n {
        let (a, b) = (points[i], points[(i + 1) % n]);
        if (a.x > 0.0) != (b.x > 0.0) {
            let p = a + (b - a) * (a.x / (a.x - b.x));
            if start.is_none_or(|s| p.y > s.1.y) {
                start = Some((i, p));
            }
        }
    }
    let (i, first) = start.unwrap_or((n - 1, points[0]));
    let mut chain = vec![first];
    chain.extend((0..n).map(|k| points[(i + 1 + k) % n]));
    resample_closed(&chain, spacing)
}

/// Evenly spaced points along a closed chain, the first kept.
fn resample_closed(chain: &[DVec2], spacing: f64) -> Vec<DVec2> {
    let length = perimeter(chain);
    let count = ((length / spacing).round() as usize).max(16);
    let step = length / count as f64;
    let mut out = Vec::with_capacity(count);
    let (mut walked, mut next) = (0.0, 0.0);
    for i in 0..chain.len() {
        let (a, b) = (chain[i], chain[(i + 1) % chain.len()]);
        let d = a.distance(b);
        while next <= walked + d && out.len() < count {
            out.push(if d > 0.0 { a.lerp(b, (next - walked) / d) } else { a });
            next += step;
        }
        walked += d;
    }
    out
}

/// A closed planar curve with normals; `axis` is the normal of its plane.
pub(crate) fn closed(points: Vec<DVec3>, axis: DVec3, field: &NormalField) -> FeatureCurve {
    let n = points.len();
    let normals: Vec<DVec3> = (0..n)
        .into_par_iter()
        .map(|i| {
            // Over five points, for a hint that the small folds of a scan do not turn.
            let along = points[(i + 2) % n] - points[(i + n - 2) % n];
            field.at(points[i], along.cross(axis))
        })
        .collect();
    FeatureCurve { closed: true, points, normals }
}

/// Coordinates in a tilted plane whose first axis is the body's left.
pub(crate) struct TiltedPlane {
    pub(crate) normal: DVec3,
    left: DVec3,
    front: DVec3,
}

impl TiltedPlane {
    /// `normal` points up the neck or away from the trunk along a limb.
    pub(crate) fn new(normal: DVec3) -> Self {
        let front = (DVec3::Z - normal * normal.z).normalize_or(DVec3::X);
        Self { normal, left: normal.cross(front), front }
    }

    pub(crate) fn flat(&self, p: DVec3) -> DVec2 {
        DVec2::new(p.dot(self.left), p.dot(self.front))
    }

    pub(crate) fn place(&self, p: DVec2, height: f64) -> DVec3 {
        self.left * p.x + self.front * p.y + self.normal * height
    }
}

/// Neck girth: below the larynx, in a plane that leans forward with the neck.
fn neck(figure: &Figure<'_>, marks: &Marks, field: &NormalField) -> Option<FeatureCurve> {
    let (plane, centre) = match marks.neck_plate {
        // A form that is cut off at the neck: just below its plate.
        Some([front, back]) => {
            let normal = (back - front).cross(DVec3::X).normalize();
            (TiltedPlane::new(normal * normal.y.signum()), (front + back) / 2.0 - DVec3::Y * 4.0)
        }
        None => {
            let tilt = NECK_TILT.to_radians();
            let mut centre = (marks.nape + marks.front_neck) / 2.0;
            centre.y = marks.nape.y + 0.020 * marks.stature;
            (TiltedPlane::new(DVec3::new(0.0, tilt.cos(), tilt.sin())), centre)
        }
    };
    let section = plane_section(figure.mesh, centre, plane.normal);
    let rings = outer_rings(&section, 25.0, Gaps::Join, |p| plane.flat(p));
    let inside = plane.flat(centre);
    let ring = rings.into_iter().find(|r| r.contains(inside))?;
    let height = centre.dot(plane.normal);
    let points = from_front(&ring.points, SPACING).into_iter().map(|p| plane.place(p, height)).collect();
    Some(closed(points, plane.normal, field))
}

/// Neck base: over nape, neck sides and front neck point, on the skin.
fn neck_base(figure: &Figure<'_>, marks: &Marks, field: &NormalField) -> Result<FeatureCurve, String> {
    let centre = (marks.nape + marks.front_neck) / 2.0;
    let count = 64;
    let points: Vec<DVec3> = (0..count)
        .into_par_iter()
        .filter_map(|k| {
            let turn = std::f64::consts::TAU * f64::from(k) / f64::from(count);
            let side = marks.neck_side[usize::from(turn > std::f64::consts::PI)];
            // Height over the angle: a + b cos + c cos 2, through the marks in front, at the side and behind.
            let side_turn = DVec2::new(side.x.abs(), side.z - centre.z);
            let cos_side = side_turn.y / side_turn.length();
            let (front, back) = (marks.front_neck.y, marks.nape.y);
            let b = (front - back) / 2.0;
            let c =
                ((front + back) / 2.0 + b * cos_side - side.y) / (1.0 - (2.0 * cos_side * cos_side - 1.0));
            let a = (front + back) / 2.0 - c;
            let y = a + b * turn.cos() + c * (2.0 * turn).cos();
            let direction = DVec2::new(turn.sin(), turn.cos());
            let level = figure.at(y);
            let reach = ray(&level, DVec2::new(0.0, centre.z), direction)?;
            Some(DVec3::new(direction.x * reach, y, centre.z + direction.y * reach))
        })
        .collect();
    if points.len() < 48 {
        return Err("the neck has no outline at its base".to_owned());
    }
    Ok(closed(smooth_closed(points, 1.0), DVec3::Y, field))
}

/// Distance from a centre to the trunk's outline along a direction: the first way out.
fn ray(level: &Level, from: DVec2, direction: DVec2) -> Option<f64> {
    let ring = level.trunk()?;
    let n = ring.points.len();
    let mut best: Option<f64> = None;
    for i in 0..n {
        let (a, b) = (ring.points[i] - from, ring.points[(i + 1) % n] - from);
        let (u, v) = (direction.perp_dot(a), direction.perp_dot(b));
        if (u > 0.0) != (v > 0.0) {
            let t = (a + (b - a) * (u / (u - v))).dot(direction);
            if t > 0.0 && best.is_none_or(|best| t < best) {
                best = Some(t);
            }
        }
    }
    best
}

/// Gaussian smoothing of a closed chain of points.
pub(crate) fn smooth_closed(points: Vec<DVec3>, sigma: f64) -> Vec<DVec3> {
    let n = points.len() as i64;
    let reach = (3.0 * sigma).ceil() as i64;
    (0..n)
        .map(|i| {
            let (mut sum, mut total) = (DVec3::ZERO, 0.0);
            for k in -reach..=reach {
                let w = (-0.5 * (k as f64 / sigma).powi(2)).exp();
                sum += points[(i + k).rem_euclid(n) as usize] * w;
                total += w;
            }
            sum / total
        })
        .collect()
}

/// Armhole: the section through shoulder point and armpit, from the shoulder down in front, under the arm, up behind.
fn armhole(figure: &Figure<'_>, marks: &Marks, side: Side, field: &NormalField) -> FeatureCurve {
    let i = side.index();
    let (top, bottom) = (marks.shoulder[i], marks.armpit[i]);
    let down = (bottom - top).normalize();
    let out = (DVec3::X * side.sign() - down * down.x * side.sign()).normalize();
    let middle = (top + bottom) / 2.0;
    let front = down.cross(out) * side.sign();
    let flat = |p: DVec3| DVec2::new((p - middle).dot(front), (p - middle).dot(-down));
    // Just inside a plate, not in it.
    let cut = if marks.plates[i] { middle - out * 3.0 } else { middle };
    let rings = outer_rings(&plane_section(figure.mesh, cut, out), 25.0, Gaps::Join, flat);
    let reach = top.distance(bottom) / 2.0;
    // Radial about the middle; below the armpit the trunk's side is cut off at the armpit.
    let count = 48;
    let wanted: Vec<f64> = (0..count)
        .map(|k| {
            let turn = std::f64::consts::TAU * f64::from(k) / f64::from(count);
            let d = DVec2::new(turn.sin(), turn.cos());
            let hit = rings.iter().filter_map(|r| ray_any(r, d)).reduce(f64::min);
            let under = if d.y < 0.0 { reach / -d.y } else { f64::INFINITY };
            hit.unwrap_or(reach).min(under).min(1.6 * reach).max(0.35 * reach)
        })
        .collect();
    let points: Vec<DVec3> = wanted
        .iter()
        .enumerate()
        .map(|(k, r)| {
            let turn = std::f64::consts::TAU * k as f64 / f64::from(count);
            middle + front * (turn.sin() * r) - down * (turn.cos() * r)
        })
        .collect();
    let points = smooth_closed(points, 1.2);
    let normals = points
        .par_iter()
        .map(|p| {
            let hint = (*p - middle).normalize_or(DVec3::Y) + out * 0.5;
            field.at(*p, hint)
        })
        .collect();
    FeatureCurve { closed: true, points, normals }
}

/// First way out of a ring from the origin.
fn ray_any(ring: &Ring, direction: DVec2) -> Option<f64> {
    let n = ring.points.len();
    (0..n)
        .filter_map(|i| {
            let (a, b) = (ring.points[i], ring.points[(i + 1) % n]);
            let (u, v) = (direction.perp_dot(a), direction.perp_dot(b));
            ((u > 0.0) != (v > 0.0))
                .then(|| (a + (b - a) * (u / (u - v))).dot(direction))
                .filter(|t| *t > 0.0)
        })
        .reduce(f64::min)
}
