//! Interpolating cubic splines with continuous curvature over centripetal parameters.

use glam::DVec3;

/// A C² cubic spline through given points: natural at open ends, periodic when closed.
///
/// Parameters are centripetal (square roots of chord lengths): for unevenly spaced nodes this keeps the curve close to
/// the polygon, without loops (Lee 1989).
#[derive(Clone, Debug)]
pub struct Spline {
    knots: Vec<f64>,
    points: Vec<DVec3>,
    /// Second derivatives at the knots.
    bends: Vec<DVec3>,
}

impl Spline {
    /// The spline through `points`. A closed spline does not repeat its first point. O(n).
    pub fn new(points: &[DVec3], closed: bool) -> Self {
        let mut points = points.to_vec();
        if closed && let Some(&first) = points.first() {
            points.push(first);
        }
        let mut knots = vec![0.0];
        for pair in points.windows(2) {
            // Equal neighbours still need a step, or the system is singular.
            let step = (pair[1] - pair[0]).length().sqrt().max(1e-9);
            knots.push(knots[knots.len() - 1] + step);
        }
        let bends =
            if closed && points.len() > 3 { periodic(&points, &knots) } else { natural(&points, &knots) };
        Self { knots, points, bends }
    }

    /// Number of spans: points less one, or as many as points when closed.
    pub fn spans(&self) -> usize {
        self.points.len().saturating_sub(1)
    }

    /// The place at share `u` (0 to 1, by parameter) of span `span`.
    pub fn place(&self, span: usize, u: f64) -> DVec3 {
        let h = self.knots[span + 1] - self.knots[span];
        let (a, b) = (1.0 - u, u);
        a * self.points[span]
            + b * self.points[span + 1]
            + ((a * a * a - a) * self.bends[span] + (b * b * b - b) * self.bends[span + 1]) * (h * h / 6.0)
    }

    /// A span as a polyline of `pieces` + 1 points.
    pub fn polyline(&self, span: usize, pieces: usize) -> Vec<DVec3> {
        (0..=pieces).map(|k| self.place(span, k as f64 / pieces as f64)).collect()
    }
}

/// The slope jump at knot `i` that the second derivatives must make up for.
fn right_side(points: &[DVec3], knots: &[f64], before: usize, at: usize) -> DVec3 {
    let h = |k: usize| knots[k + 1] - knots[k];
    6.0 * ((points[at + 1] - points[at]) / h(at) - (points[before + 1] - points[before]) / h(before))
}

fn natural(points: &[DVec3], knots: &[f64]) -> Vec<DVec3> {
    let n = points.len();
    let mut bends = vec![DVec3::ZERO; n];
    if n < 3 {
        return bends;
    }
    let h = |k: usize| knots[k + 1] - knots[k];
    let mut upper = vec![0.0; n];
    for i in 1..n - 1 {
        let pivot = 2.0 * (h(i - 1) + h(i)) - h(i - 1) * upper[i - 1];
        upper[i] = h(i) / pivot;
        bends[i] = (right_side(points, knots, i - 1, i) - h(i - 1) * bends[i - 1]) / pivot;
    }
    for i in (1..n - 1).rev() {
        let next = bends[i + 1];
        bends[i] -= upper[i] * next;
    }
    bends
}

/// Cyclic tridiagonal system by the Sherman–Morrison formula.
fn periodic(points: &[DVec3], knots: &[f64]) -> Vec<DVec3> {
    let n = points.len() - 1;
    let h = |k: usize| knots[k % n + 1] - knots[k % n];
    let corner = h(n - 1);
    let gamma = -2.0 * (h(n - 1) + h(0));
    let solve = |rhs: &dyn Fn(usize) -> DVec3| {
        let (mut out, mut upper) = (vec![DVec3::ZERO; n], vec![0.0; n]);
        for i in 0..n {
            let mut diagonal = 2.0 * (h(i + n - 1) + h(i));
            if i == 0 {
                diagonal -= gamma;
            }
            if i == n - 1 {
                diagonal -= corner * corner / gamma;
            }
            let lower = if i == 0 { 0.0 } else { h(i - 1) };
            let pivot = diagonal - lower * if i == 0 { 0.0 } else { upper[i - 1] };
            upper[i] = h(i) / pivot;
            out[i] = (rhs(i) - if i == 0 { DVec3::ZERO } else { lower * out[i - 1] }) / pivot;
        }
        for i in (0..n - 1).rev() {
            let next = out[i + 1];
            out[i] -= upper[i] * next;
        }
        out
    };
    let x = solve(&|i| right_side(points, knots, (i + n - 1) % n, i));
    let z = solve(&|i| {
        DVec3::splat(if i == 0 {
            gamma
        } else if i == n - 1 {
            corner
        } else {
            0.0
        })
    });
    let (z0, zn) = (z[0].x, z[n - 1].x);
    let factor = (x[0] + corner / gamma * x[n - 1]) / (1.0 + z0 + corner / gamma * zn);
    let mut bends: Vec<DVec3> = x.iter().zip(&z).map(|(x, z)| *x - factor * z.x).collect();
    bends.push(bends[0]);
    bends
}
