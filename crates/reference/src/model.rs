//! Feature curves and feature points on a reference mesh, and the frames that template nodes are encoded in.
//!
//! After Wang et al., *feature templates*: a feature curve is a sorted polyline on the surface with a name; a feature
//! point is where two of them cross.

use std::collections::BTreeMap;

use mesh_kernel::glam::{DVec2, DVec3};

/// How far curves may pass each other and still cross, millimetres: in general, and a line beside a level curve, one of
/// which may span a hollow that the other follows.
const NEAR: f64 = 25.0;
const NEAR_LEVEL: f64 = 110.0;
/// Tangents are chords of this length about the point, millimetres.
const CHORD: f64 = 24.0;
/// Curves that meet under a smaller sine than this make no frame.
const FLATTEST: f64 = 0.05;

/// A named polyline on (or, for tape curves, tautly over) the reference surface.
#[derive(Clone, Debug, PartialEq)]
pub struct FeatureCurve {
    /// Closed curves do not repeat their first point.
    pub closed: bool,
    /// Points in order, millimetres, in the frame of the mesh.
    pub points: Vec<DVec3>,
    /// Outward unit normal at each point, smoothed over a neighbourhood so that scan noise does not turn it.
    pub normals: Vec<DVec3>,
}

/// A named place on the reference surface.
#[derive(Clone, Debug, PartialEq)]
pub struct FeaturePoint {
    /// Position in millimetres, in the frame of the mesh.
    pub position: DVec3,
    /// Outward unit normal, smoothed.
    pub normal: DVec3,
}

/// The frame `(q; n, t1, t2)` of a template node's encoding. The three unit directions need not be orthogonal, but
/// their triple product is not zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The feature point, millimetres.
    pub origin: DVec3,
    /// Outward surface normal.
    pub normal: DVec3,
    /// Unit tangent of the first curve at the point.
    pub first: DVec3,
    /// Unit tangent of the second curve at the point.
    pub second: DVec3,
}

/// Everything that is known by name about a reference mesh. Ordered maps, so that files come out the same each time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Features {
    /// Unit vector to the body's front, horizontal, in the frame of the mesh.
    pub facing: DVec3,
    /// Unit vector upward, in the frame of the mesh.
    pub up: DVec3,
    /// Stature in millimetres.
    pub height: f64,
    /// Curves by name, for instance `waist`, `left_princess_front`.
    pub curves: BTreeMap<String, FeatureCurve>,
    /// Points by name, for instance `left_armpit`.
    pub points: BTreeMap<String, FeaturePoint>,
    /// What was guessed or could not be found, in words for people.
    pub warnings: Vec<String>,
}

impl FeatureCurve {
    /// Pairs of neighbouring point numbers, with the closing one if closed.
    fn segments(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let n = self.points.len();
        let count = if self.closed { n } else { n.saturating_sub(1) };
        (0..count).map(move |i| (i, (i + 1) % n))
    }

    /// Length along the curve.
    pub fn length(&self) -> f64 {
        self.segments().map(|(a, b)| self.points[a].distance(self.points[b])).sum()
    }

    /// Tape measure of a closed curve: length of the convex hull in the plane that fits it. An open curve's is its
    /// length.
    pub fn girth(&self) -> f64 {
        if !self.closed || self.points.len() < 3 {
            return self.length();
        }
        let o = self.points[0];
        let normal: DVec3 =
            self.segments().map(|(a, b)| (self.points[a] - o).cross(self.points[b] - o)).sum();
        let Some(normal) = normal.try_normalize() else { return self.length() };
        let (u, v) = normal.any_orthonormal_pair();
        let flat: Vec<DVec2> = self.points.iter().map(|p| DVec2::new(p.dot(u), p.dot(v))).collect();
        crate::human::taut_length(&flat)
    }

    /// Point, unit tangent and normal at segment `i`, part `t` of it.
    fn at(&self, i: usize, t: f64) -> Frame {
        let n = self.points.len();
        let j = (i + 1) % n;
        let origin = self.points[i].lerp(self.points[j], t);
        let walk = |forward: bool| {
            let (mut from, mut at, mut left) = (origin, if forward { j } else { i }, CHORD / 2.0);
            loop {
                let to = self.points[at];
                let d = from.distance(to);
                if d >= left {
                    return from.lerp(to, left / d);
                }
                left -= d;
                from = to;
                let last = if forward { at + 1 == n } else { at == 0 };
                if (last && !self.closed) || left <= 0.0 {
                    return to;
                }
                at = if forward { (at + 1) % n } else { (at + n - 1) % n };
                if at == i && forward {
                    return to;
                }
            }
        };
        let tangent = (walk(true) - walk(false)).normalize_or_zero();
        let normal = self.normals[i].lerp(self.normals[j], t).normalize_or_zero();
        Frame { origin, normal, first: tangent, second: tangent }
    }
}

impl Features {
    /// The frame where two curves cross: `first` is the tangent of `curve_a`, `second` that of `curve_b`, the normal is
    /// the mean of both curves' smoothed normals. `None` if a name is unknown, if the curves stay too far apart, or if
    /// they run along each other there.
    ///
    /// A line down the body crosses a level curve at its height. Where the two differ there (the level curve follows
    /// the cleft and the line bridges it, or the level curve is a taut `*_tape` and the line lies on the skin), the level
    /// curve's point is the one in the same direction from the middle of its outline; the origin is the line's point,
    /// on a tape curve the tape's. All other pairs meet where they come nearest, within 25 mm, half-way between; where
    /// they meet more than once, the frontmost meeting counts.
    pub fn crossing(&self, curve_a: &str, curve_b: &str) -> Option<Frame> {
        let (a, b) = (self.curves.get(curve_a)?, self.curves.get(curve_b)?);
        let (at_a, at_b, origin) = match (self.level_of(a), self.level_of(b)) {
            (Some(_), None) if !b.closed => {
                let (line, level) = self.level_meeting(b, a)?;
                (level, line, if curve_a.ends_with("_tape") { level.origin } else { line.origin })
            }
            (None, Some(_)) if !a.closed => {
                let (line, level) = self.level_meeting(a, b)?;
                (line, level, if curve_b.ends_with("_tape") { level.origin } else { line.origin })
            }
            _ => {
                let (a_at, b_at) = self.nearest_meeting(a, b)?;
                (a_at, b_at, (a_at.origin + b_at.origin) / 2.0)
            }
        };
        let normal = (at_a.normal + at_b.normal).try_normalize()?;
        let frame = Frame { origin, normal, first: at_a.first, second: at_b.first };
        (normal.dot(frame.first.cross(frame.second)).abs() > FLATTEST).then_some(frame)
    }

    /// The frame at a named point: `first` runs down the surface, `second` along it anticlockwise seen from above (to
    /// the left in front, to the right behind). Where the surface lies level, `first` runs backward.
    pub fn point_frame(&self, point: &str) -> Option<Frame> {
        let p = self.points.get(point)?;
        let along = if p.normal.dot(self.up).abs() < 0.95 { -self.up } else { -self.facing };
        let first = (along - p.normal * along.dot(p.normal)).try_normalize()?;
        Some(Frame { origin: p.position, normal: p.normal, first, second: p.normal.cross(first) })
    }

    /// Height of a closed curve that lies level.
    fn level_of(&self, curve: &FeatureCurve) -> Option<f64> {
        if !curve.closed || curve.points.is_empty() {
            return None;
        }
        let (lo, hi) = curve.points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), p| {
            let h = p.dot(self.up);
            (lo.min(h), hi.max(h))
        });
        (hi - lo < 1.0).then_some((lo + hi) / 2.0)
    }

    /// Where a line passes the height of a level curve, and the level curve's point beside it.
    fn level_meeting(&self, line: &FeatureCurve, level: &FeatureCurve) -> Option<(Frame, Frame)> {
        let height = self.level_of(level)?;
        let above = |i: usize| line.points[i].dot(self.up) - height;
        let (i, j) = line
            .segments()
            .find(|(i, j)| (above(*i) >= 0.0) != (above(*j) >= 0.0))
            .or_else(|| line.segments().min_by(|a, b| above(a.0).abs().total_cmp(&above(b.0).abs())))?;
        let t = (above(i) / (above(i) - above(j))).clamp(0.0, 1.0);
        let on_line = line.at(i, if t.is_finite() { t } else { 0.0 });
        if (on_line.origin.dot(self.up) - height).abs() > NEAR {
            return None;
        }
        let left = self.up.cross(self.facing);
        let flat = |p: DVec3| DVec2::new(p.dot(left), p.dot(self.facing));
        let (mut twice, mut moment) = (0.0, DVec2::ZERO);
        for (i, j) in level.segments() {
            let (p, q) = (flat(level.points[i]), flat(level.points[j]));
            twice += p.perp_dot(q);
            moment += (p + q) * p.perp_dot(q);
        }
        let middle = moment / (3.0 * twice);
        let way = flat(on_line.origin) - middle;
        let mut best: Option<(f64, usize, f64)> = None;
        for (i, j) in level.segments() {
            let (p, q) = (flat(level.points[i]) - middle, flat(level.points[j]) - middle);
            let (u, v) = (way.perp_dot(p), way.perp_dot(q));
            if (u > 0.0) == (v > 0.0) {
                continue;
            }
            let t = u / (u - v);
            let reach = p.lerp(q, t);
            let gap = reach.distance(way);
            if reach.dot(way) > 0.0 && best.is_none_or(|b| gap < b.0) {
                best = Some((gap, i, t));
            }
        }
        let (gap, i, t) = best?;
        (gap < NEAR_LEVEL).then(|| (on_line, level.at(i, t)))
    }

    /// Nearest approach; among equally near ones the frontmost.
    fn nearest_meeting(&self, a: &FeatureCurve, b: &FeatureCurve) -> Option<(Frame, Frame)> {
        let mut found: Vec<(f64, f64, usize, f64, usize, f64)> = Vec::new();
        for (i, i1) in a.segments() {
            for (j, j1) in b.segments() {
                let (s, t, gap) = nearest_on_segments(a.points[i], a.points[i1], b.points[j], b.points[j1]);
                if gap <= NEAR {
                    found.push((gap, a.points[i].lerp(a.points[i1], s).dot(self.facing), i, s, j, t));
                }
            }
        }
        let least = found.iter().map(|f| f.0).reduce(f64::min)?;
        let best = found.iter().filter(|f| f.0 < least + 1.0).max_by(|p, q| p.1.total_cmp(&q.1))?;
        // The nearest pair near that meeting, not the frontmost within the tolerance.
        let place = a.at(best.2, best.3).origin;
        let best = found
            .iter()
            .filter(|f| a.points[f.2].distance(place) < 20.0)
            .min_by(|p, q| p.0.total_cmp(&q.0))?;
        Some((a.at(best.2, best.3), b.at(best.4, best.5)))
    }
}

/// Parameters and distance of the nearest points of two segments (Ericson, *Real-Time Collision Detection*, 5.1.9).
fn nearest_on_segments(p1: DVec3, q1: DVec3, p2: DVec3, q2: DVec3) -> (f64, f64, f64) {
    let (d1, d2, r) = (q1 - p1, q2 - p2, p1 - p2);
    let (a, e, f) = (d1.length_squared().max(1e-12), d2.length_squared().max(1e-12), d2.dot(r));
    let (b, c) = (d1.dot(d2), d1.dot(r));
    let denominator = a * e - b * b;
    let mut s =
        if denominator > 1e-12 * a * e { ((b * f - c * e) / denominator).clamp(0.0, 1.0) } else { 0.0 };
    let mut t = (b * s + f) / e;
    if t < 0.0 {
        t = 0.0;
        s = (-c / a).clamp(0.0, 1.0);
    } else if t > 1.0 {
        t = 1.0;
        s = ((b - c) / a).clamp(0.0, 1.0);
    }
    (s, t, (p1 + d1 * s).distance(p2 + d2 * t))
}
