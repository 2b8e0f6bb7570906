//! Arcs: what the outer side of a fold looks like in the plane across its edge.
//!
//! An arc goes about a node from one offset point to another. It is a polygon with ends on the circle and inner points a
//! little outside, so that its sector has exactly the circle's area: tubes and sphere patches then keep their volume.
//! Between offset points at different distances, or askew, it is the affine image of a circle's arc; two tubes that meet
//! at a node therefore meet in the same ellipse.

use glam::DVec3;

/// Chords are never farther from the circle than this share of the radius, whatever the caller allows; nor nearer.
const COARSEST: f64 = 0.1;
const FINEST: f64 = 1e-5;
/// Share of the radius between an arc and its chords unless the caller says otherwise.
const USUAL: f64 = 0.035;
/// Beyond this angle, in radians, an arc goes through a given middle (about 170°).
const NEARLY_STRAIGHT: f64 = 2.967;

/// How finely arcs are cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArcRule {
    /// Farthest distance between arc and chords in millimetres; `None`: 2 % of the radius.
    pub(super) chord: Option<f64>,
}

impl ArcRule {
    /// Number of chords for an arc of `angle` radians and a radius in millimetres; at least 1.
    pub(super) fn segments(&self, angle: f64, radius: f64) -> usize {
        let share = self.chord.map_or(USUAL, |chord| chord / radius).clamp(FINEST, COARSEST);
        let step = 2.0 * (1.0 - share).acos();
        ((angle / step - 1e-9).ceil() as usize).max(1)
    }
}

/// The inner points of the arc from `from` to `to`, seen from its centre; through the direction `middle` where the ends
/// are nearly opposite. Appends them to `out`.
pub(super) fn push_arc(rule: ArcRule, from: DVec3, to: DVec3, middle: DVec3, out: &mut Vec<DVec3>) {
    let angle = from.angle_between(to);
    let radius = 0.5 * (from.length() + to.length());
    let segments = rule.segments(angle, radius);
    let scale = inner_radius(angle, segments);
    let point = |s: f64| {
        if angle <= NEARLY_STRAIGHT {
            between(from, to, angle, s)
        } else {
            let top = radius * middle;
            if s <= 0.5 {
                between(from, top, 0.5 * angle, 2.0 * s)
            } else {
                between(top, to, 0.5 * angle, 2.0 * s - 1.0)
            }
        }
    };
    out.extend((1..segments).map(|k| scale * point(k as f64 / segments as f64)));
}

/// The point at share `s` of an affine arc whose ends stand for directions `angle` apart.
fn between(from: DVec3, to: DVec3, angle: f64, s: f64) -> DVec3 {
    let sine = angle.sin();
    if sine < 1e-9 {
        return from.lerp(to, s);
    }
    (((1.0 - s) * angle).sin() * from + (s * angle).sin() * to) / sine
}

/// How far, in radii, the inner points of a polygon of `segments` equal steps must be so that it has the area of the
/// sector of `angle` radians, its ends being on the circle.
fn inner_radius(angle: f64, segments: usize) -> f64 {
    // sin δ · (2 r + (n − 2) r²) = angle, twice the areas of n triangles of step δ.
    let (n, wanted) = (segments as f64, angle / (angle / segments as f64).sin());
    match segments {
        0 | 1 => 1.0,
        2 => 0.5 * wanted,
        _ => ((1.0 + (n - 2.0) * wanted).sqrt() - 1.0) / (n - 2.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn area(points: &[DVec3]) -> f64 {
        points.windows(2).map(|p| 0.5 * p[0].cross(p[1]).length()).sum()
    }

    #[test]
    fn sectors_keep_their_area_at_any_angle() {
        let rule = ArcRule { chord: None };
        assert_eq!(rule.segments(FRAC_PI_2, 3.0), 3);
        for degrees in [35.0, 60.0, 90.0, 120.0, 169.0, 171.0, 180.0f64] {
            let angle = degrees.to_radians();
            let (from, to) = (DVec3::X * 2.0, 2.0 * DVec3::new(angle.cos(), angle.sin(), 0.0));
            let middle = DVec3::new((0.5 * angle).cos(), (0.5 * angle).sin(), 0.0);
            let mut points = vec![from];
            push_arc(rule, from, to, middle, &mut points);
            points.push(to);
            let error = area(&points) / (2.0 * angle) - 1.0;
            assert!(error.abs() < 1e-13, "{degrees}: {error}");
            for pair in points.windows(2) {
                let nearest = (0.5 * (pair[0] + pair[1])).length();
                assert!(nearest > 2.0 * 0.97 && pair[0].length() < 2.0 * 1.05, "{degrees}: {nearest}");
            }
        }
        let fine = ArcRule { chord: Some(0.001) };
        assert!(fine.segments(PI, 1.0) > 34);
    }
}
