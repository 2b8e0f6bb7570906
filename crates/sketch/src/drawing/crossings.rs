//! Where two curves cross.

use glam::{DMat2, DVec2};

use crate::Curve;

/// A place where two curves cross or touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Its parameters on the two.
    pub t: [f64; 2],
    /// Where it is.
    pub at: DVec2,
}

/// Share of the curves' size within which chords stand for them in the search.
const CHORD: f64 = 1e-4;
/// Crossings nearer than this share of the curves' size are one.
const ONE: f64 = 1e-7;
const NEWTON_STEPS: usize = 30;

/// The places where two curves cross, in the order of the first's parameter. Chords are intersected and the places refined by
/// Newton's method; curves that run along each other have no crossings there. O(chords of the one · chords of the other).
pub fn crossings(one: &Curve, other: &Curve) -> Vec<Crossing> {
    let size = one.length().min(other.length());
    let chords = |curve: &Curve| -> Vec<(f64, DVec2)> {
        curve.parameters(CHORD * size).into_iter().map(|t| (t, curve.point(t))).collect()
    };
    let (first, second) = (chords(one), chords(other));
    let mut found: Vec<Crossing> = Vec::new();
    for p in first.windows(2) {
        for q in second.windows(2) {
            let Some([s, t]) = chords_cross([p[0].1, p[1].1], [q[0].1, q[1].1], CHORD * size) else {
                continue;
            };
            let start = [p[0].0 + s * (p[1].0 - p[0].0), q[0].0 + t * (q[1].0 - q[0].0)];
            if let Some(crossing) = refined(one, other, start, ONE * size) {
                let known = found.iter().any(|f| f.at.distance(crossing.at) <= 10.0 * ONE * size);
                if !known {
                    found.push(crossing);
                }
            }
        }
    }
    found.sort_by(|a, b| a.t[0].total_cmp(&b.t[0]));
    found
}

/// The shares of two chords at which they cross, be it a little beyond their ends; none for parallel ones.
fn chords_cross([a, b]: [DVec2; 2], [c, d]: [DVec2; 2], slack: f64) -> Option<[f64; 2]> {
    let (u, v) = (b - a, d - c);
    let parallel = u.perp_dot(v);
    if parallel.abs() <= 1e-12 * u.length() * v.length() {
        return None;
    }
    let (s, t) = ((c - a).perp_dot(v) / parallel, (c - a).perp_dot(u) / parallel);
    let within = |x: f64, length: f64| (-slack / length..=1.0 + slack / length).contains(&x);
    (within(s, u.length()) && within(t, v.length())).then_some([s, t])
}

fn refined(one: &Curve, other: &Curve, mut t: [f64; 2], near: f64) -> Option<Crossing> {
    for _ in 0..NEWTON_STEPS {
        let apart = other.point(t[1]) - one.point(t[0]);
        let slopes = DMat2::from_cols(one.derivatives(t[0])[0], -other.derivatives(t[1])[0]);
        if slopes.determinant().abs() <= f64::MIN_POSITIVE {
            break;
        }
        let step = slopes.inverse() * apart;
        t = [t[0] + step.x, t[1] + step.y].map(|t| t.clamp(0.0, 1.0));
        if step.abs().max_element() < 1e-15 {
            break;
        }
    }
    let [p, q] = [one.point(t[0]), other.point(t[1])];
    (p.distance(q) <= near).then(|| Crossing { t, at: (p + q) / 2.0 })
}
