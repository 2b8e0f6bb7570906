//! Round shapes moved to where they are nearest to some nodes: Levenberg and Marquardt's steps, with exact slopes.

use glam::DVec3;

use super::shape::Shape;

/// Steps, at most.
const STEPS: usize = 24;
/// After so many steps a mean error of this many times the wanted one is not worth more of them.
const FIRST_STEPS: usize = 5;
const HOPELESS: f64 = 8.0;
/// A step has to promise this share: where the mean error is larger than the wanted one; where it is larger than this share of it, so
/// that no digits are to be won; and elsewhere.
const SLOW: f64 = 0.1;
const SETTLED: f64 = 1e-3;
const COARSE: f64 = 1e-2;
/// Where the matrix is less than this share of its largest entry, the shape moves within itself, and stays.
const IDLE: f64 = 1e-11;
const GAIN: f64 = 1e-14;
/// As many numbers as a torus has; shapes with fewer leave the last ones alone.
const NUMBERS: usize = 8;

/// A shape as numbers.
type Numbers = [f64; NUMBERS];

/// The least squares shape of extent about one, from a guess; one that clearly will not come within `wanted` is given up.
pub(super) fn refined(guess: Shape, nodes: &[DVec3], wanted: f64) -> Shape {
    let mut at = guess;
    let mut misfit = Misfit::new(&at, nodes);
    let mut damping = 1e-3;
    let enough = wanted * wanted * nodes.len() as f64;
    for step in 0..STEPS {
        if step >= FIRST_STEPS && misfit.square > HOPELESS * HOPELESS * enough {
            break;
        }
        let Some(by) = misfit.step(damping) else { break };
        let promised: f64 = by.iter().zip(&misfit.slope).map(|(b, s)| b * s).sum();
        let least = match misfit.square {
            s if s > enough => SLOW,
            s if s > COARSE * COARSE * enough => SETTLED,
            _ => GAIN,
        };
        if promised < least * misfit.square {
            break;
        }
        let from = numbers(at);
        let next = shape_of(guess, &std::array::from_fn(|k| from[k] - by[k]));
        let there = Misfit::new(&next, nodes);
        if there.square < misfit.square {
            let gain = misfit.square - there.square;
            let last = gain < GAIN * misfit.square;
            (at, misfit, damping) = (next, there, damping / 10.0);
            if last {
                break;
            }
        } else {
            damping *= 10.0;
            if damping > 1e6 {
                break;
            }
        }
    }
    at
}

/// How far nodes are from a shape, and how that changes with its numbers.
struct Misfit {
    /// Sum of the squares of the distances.
    square: f64,
    /// Half of its derivative.
    slope: Numbers,
    /// Sum of the products of the distances' derivatives.
    matrix: [Numbers; NUMBERS],
}

impl Misfit {
    fn new(shape: &Shape, nodes: &[DVec3]) -> Self {
        let mut sum = Self { square: 0.0, slope: [0.0; NUMBERS], matrix: [[0.0; NUMBERS]; NUMBERS] };
        for p in nodes {
            let (distance, derivative) = slopes(shape, *p);
            sum.square += distance * distance;
            for i in 0..NUMBERS {
                sum.slope[i] += derivative[i] * distance;
                for j in 0..NUMBERS {
                    sum.matrix[i][j] += derivative[i] * derivative[j];
                }
            }
        }
        sum
    }

    /// What to go back by (Cholesky).
    fn step(&self, damping: f64) -> Option<Numbers> {
        let largest: f64 = (0..NUMBERS).map(|k| self.matrix[k][k]).sum();
        let least = largest * (damping * 1e-3).max(IDLE);
        let mut lower = self.matrix;
        for i in 0..NUMBERS {
            lower[i][i] += least;
            for j in 0..=i {
                let known: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
                let rest = lower[i][j] - known;
                lower[i][j] = if i > j {
                    rest / lower[j][j]
                } else if rest > 0.0 {
                    rest.sqrt()
                } else {
                    return None;
                };
            }
        }
        let mut x = self.slope;
        for i in 0..NUMBERS {
            let known: f64 = (0..i).map(|k| lower[i][k] * x[k]).sum();
            x[i] = (x[i] - known) / lower[i][i];
        }
        for i in (0..NUMBERS).rev() {
            let known: f64 = (i + 1..NUMBERS).map(|k| lower[k][i] * x[k]).sum();
            x[i] = (x[i] - known) / lower[i][i];
        }
        Some(x)
    }
}

/// How far a point is from a shape, and the derivatives of that by the numbers of the shape. Axes stay unit vectors, so only what
/// turns them counts.
fn slopes(shape: &Shape, p: DVec3) -> (f64, Numbers) {
    // By the point and the axis, and by the other numbers.
    let all = |place: DVec3, axis: DVec3, [m, n]: [f64; 2]| {
        [place.x, place.y, place.z, axis.x, axis.y, axis.z, m, n]
    };
    // Along an axis, away from it, and which way that is.
    let about = |origin: DVec3, axis: DVec3| {
        let d = p - origin;
        let along = axis.dot(d);
        let aside = d - axis * along;
        let away = aside.length();
        (along, away, aside / away.max(f64::MIN_POSITIVE))
    };
    match *shape {
        Shape::Plane { normal, offset } => {
            (normal.dot(p) - offset, [p.x, p.y, p.z, -1.0, 0.0, 0.0, 0.0, 0.0])
        }
        Shape::Cylinder { point, axis, radius } => {
            let (along, away, out) = about(point, axis);
            (away - radius, all(-out, -out * along, [-1.0, 0.0]))
        }
        Shape::Cone { apex, axis, half_angle } => {
            let (along, away, out) = about(apex, axis);
            let (sine, cosine) = half_angle.sin_cos();
            let across = along * cosine + away * sine;
            (away * cosine - along * sine, all(axis * sine - out * cosine, -out * across, [-across, 0.0]))
        }
        Shape::Sphere { centre, radius } => {
            let d = p - centre;
            let away = d.length();
            let out = d / away.max(f64::MIN_POSITIVE);
            (away - radius, [-out.x, -out.y, -out.z, -1.0, 0.0, 0.0, 0.0, 0.0])
        }
        Shape::Torus { centre, axis, major, minor } => {
            let (along, away, out) = about(centre, axis);
            let from_tube = ((away - major) * (away - major) + along * along).sqrt();
            let [u, v] = [away - major, along].map(|x| x / from_tube.max(f64::MIN_POSITIVE));
            (from_tube - minor, all(-(out * u + axis * v), out * (v * major), [-u, -1.0]))
        }
        Shape::Freeform => (0.0, [0.0; NUMBERS]),
    }
}

fn numbers(shape: Shape) -> Numbers {
    let all = |p: DVec3, a: DVec3, [m, n]: [f64; 2]| [p.x, p.y, p.z, a.x, a.y, a.z, m, n];
    match shape {
        Shape::Plane { normal: p, offset: r } | Shape::Sphere { centre: p, radius: r } => {
            [p.x, p.y, p.z, r, 0.0, 0.0, 0.0, 0.0]
        }
        Shape::Cylinder { point, axis, radius } => all(point, axis, [radius, 0.0]),
        Shape::Cone { apex, axis, half_angle } => all(apex, axis, [half_angle, 0.0]),
        Shape::Torus { centre, axis, major, minor } => all(centre, axis, [major, minor]),
        Shape::Freeform => [0.0; NUMBERS],
    }
}

/// The shape of some numbers, of the same kind as another.
fn shape_of(kind: Shape, x: &Numbers) -> Shape {
    let vector = |k: usize| DVec3::new(x[k], x[k + 1], x[k + 2]);
    let axis = || vector(3).normalize_or_zero();
    match kind {
        Shape::Plane { .. } => Shape::Plane { normal: vector(0).normalize_or_zero(), offset: x[3] },
        Shape::Cylinder { .. } => {
            // Of all points of the axis, the one beside the middle of what is fitted.
            let point = vector(0) - axis() * axis().dot(vector(0));
            Shape::Cylinder { point, axis: axis(), radius: x[6] }
        }
        Shape::Cone { .. } => Shape::Cone { apex: vector(0), axis: axis(), half_angle: x[6] },
        Shape::Sphere { .. } => Shape::Sphere { centre: vector(0), radius: x[3] },
        Shape::Torus { .. } => Shape::Torus { centre: vector(0), axis: axis(), major: x[6], minor: x[7] },
        Shape::Freeform => Shape::Freeform,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_what_differences_say() {
        let axis = DVec3::new(0.3, -0.5, 0.7).normalize();
        let centre = DVec3::new(0.1, 0.2, -0.3);
        let p = DVec3::new(0.9, 0.4, 0.35);
        let shapes = [
            Shape::Cylinder { point: centre - axis * axis.dot(centre), axis, radius: 0.8 },
            Shape::Cone { apex: centre, axis, half_angle: 0.4 },
            Shape::Sphere { centre, radius: 0.7 },
            Shape::Torus { centre, axis, major: 0.9, minor: 0.3 },
        ];
        for kind in shapes {
            let at = numbers(kind);
            let distance = |x: &Numbers| shape_of(kind, x).distance(p);
            let (here, derivative) = slopes(&kind, p);
            assert!((here - distance(&at)).abs() < 1e-12, "{kind:?}");
            for k in 0..NUMBERS {
                let [mut less, mut more] = [at; 2];
                less[k] -= 1e-6;
                more[k] += 1e-6;
                let wanted = (distance(&more) - distance(&less)) / 2e-6;
                assert!((derivative[k] - wanted).abs() < 1e-8, "{kind:?} {k}");
            }
        }
    }
}
