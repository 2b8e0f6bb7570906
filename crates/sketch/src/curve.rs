//! Single curves.

use glam::DVec2;

use crate::SketchError;

/// A curve in the plane; parameters run from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// A straight line.
    Line {
        /// Where it begins.
        from: DVec2,
        /// Where it ends.
        to: DVec2,
    },
    /// An arc of a circle.
    Arc {
        /// Its centre.
        center: DVec2,
        /// Its radius.
        radius: f64,
        /// Direction from the centre to where it begins, in radians.
        start: f64,
        /// By how much it turns; negative clockwise.
        sweep: f64,
    },
    /// A cubic Bézier curve.
    Bezier {
        /// Its control points.
        points: [DVec2; 4],
    },
    /// A natural cubic spline through points, its parameter by chord length: smooth tangents and curvatures.
    Spline {
        /// The points that it runs through.
        points: Vec<DVec2>,
        /// Parameters of the points.
        at: Vec<f64>,
        /// Second derivatives there.
        second: Vec<DVec2>,
    },
}

/// The point of a curve that is nearest to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestPoint {
    /// Its parameter.
    pub t: f64,
    /// Where it is.
    pub at: DVec2,
    /// How far.
    pub distance: f64,
}

fn finite(what: &'static str, points: &[DVec2]) -> Result<(), SketchError> {
    if points.iter().all(|p| p.is_finite()) {
        Ok(())
    } else {
        Err(SketchError::Number { what, wanted: "made of finite numbers" })
    }
}

impl Curve {
    /// A straight line.
    ///
    /// # Errors
    /// Coordinates that are not finite.
    pub fn line(from: DVec2, to: DVec2) -> Result<Self, SketchError> {
        finite("a line", &[from, to])?;
        Ok(Self::Line { from, to })
    }

    /// An arc about a centre; a sweep of ±2π is a circle.
    ///
    /// # Errors
    /// Numbers that are not finite; a radius that is not positive; a sweep of more than a turn, or none.
    pub fn arc(center: DVec2, radius: f64, start: f64, sweep: f64) -> Result<Self, SketchError> {
        finite("an arc", &[center, DVec2::new(start, sweep)])?;
        if !(radius.is_finite() && radius > 0.0) {
            return Err(SketchError::Number {
                what: "the radius of an arc",
                wanted: "finite and more than 0",
            });
        }
        if sweep == 0.0 || sweep.abs() > std::f64::consts::TAU * (1.0 + 1e-12) {
            return Err(SketchError::Number {
                what: "the sweep of an arc",
                wanted: "a turn at most, and not 0",
            });
        }
        Ok(Self::Arc { center, radius, start, sweep })
    }

    /// The arc from one point over a second to a third.
    ///
    /// # Errors
    /// Coordinates that are not finite; points on one line.
    pub fn arc_through(a: DVec2, b: DVec2, c: DVec2) -> Result<Self, SketchError> {
        finite("an arc", &[a, b, c])?;
        let (u, v) = (b - a, c - a);
        let twice = 2.0 * u.perp_dot(v);
        if twice.abs() <= 1e-12 * u.length() * v.length() || !twice.is_finite() {
            return Err(SketchError::NoArc);
        }
        let off = DVec2::new(
            v.y * u.length_squared() - u.y * v.length_squared(),
            u.x * v.length_squared() - v.x * u.length_squared(),
        ) / twice;
        let center = a + off;
        let angle = |p: DVec2| (p - center).to_angle();
        let turn = |from: f64, to: f64| (to - from).rem_euclid(std::f64::consts::TAU);
        let (start, mid, end) = (angle(a), angle(b), angle(c));
        let anticlockwise = turn(start, end);
        let sweep = if turn(start, mid) <= anticlockwise {
            anticlockwise
        } else {
            anticlockwise - std::f64::consts::TAU
        };
        Self::arc(center, off.length(), start, sweep)
    }

    /// A Bézier curve of three (quadratic) or four control points.
    ///
    /// # Errors
    /// Another number of points; coordinates that are not finite.
    pub fn bezier(points: &[DVec2]) -> Result<Self, SketchError> {
        finite("a Bézier curve", points)?;
        match *points {
            [a, b, c] => Ok(Self::Bezier { points: [a, a.lerp(b, 2.0 / 3.0), c.lerp(b, 2.0 / 3.0), c] }),
            [a, b, c, d] => Ok(Self::Bezier { points: [a, b, c, d] }),
            _ => Err(SketchError::TooFewPoints { what: "a Bézier curve", wanted: 3, given: points.len() }),
        }
    }

    /// A smooth curve through points. O(n).
    ///
    /// # Errors
    /// Fewer than two points; coordinates that are not finite; points in a row in one place.
    pub fn spline(points: &[DVec2]) -> Result<Self, SketchError> {
        finite("a spline", points)?;
        if points.len() < 2 {
            return Err(SketchError::TooFewPoints { what: "a spline", wanted: 2, given: points.len() });
        }
        let mut at = vec![0.0];
        for (i, w) in points.windows(2).enumerate() {
            let step = w[0].distance(w[1]);
            if step == 0.0 {
                return Err(SketchError::NoLength { curve: i + 1 });
            }
            at.push(at[i] + step);
        }
        let total = at[at.len() - 1];
        at.iter_mut().for_each(|t| *t /= total);
        let second = second_derivatives(points, &at);
        Ok(Self::Spline { points: points.to_vec(), at, second })
    }

    /// The point at a parameter.
    pub fn point(&self, t: f64) -> DVec2 {
        match self {
            Self::Line { from, to } => from.lerp(*to, t),
            Self::Arc { center, radius, start, sweep } => {
                *center + DVec2::from_angle(start + sweep * t) * *radius
            }
            Self::Bezier { points: [a, b, c, d] } => {
                let s = 1.0 - t;
                *a * (s * s * s) + *b * (3.0 * s * s * t) + *c * (3.0 * s * t * t) + *d * (t * t * t)
            }
            Self::Spline { points, at, second } => {
                let (i, h, a, b) = span(at, t);
                points[i] * a
                    + points[i + 1] * b
                    + (second[i] * (a * a * a - a) + second[i + 1] * (b * b * b - b)) * (h * h / 6.0)
            }
        }
    }

    /// First and second derivative at a parameter.
    pub fn derivatives(&self, t: f64) -> [DVec2; 2] {
        match self {
            Self::Line { from, to } => [*to - *from, DVec2::ZERO],
            Self::Arc { radius, start, sweep, .. } => {
                let out = DVec2::from_angle(start + sweep * t) * *radius;
                [out.perp() * *sweep, -out * (sweep * sweep)]
            }
            Self::Bezier { points: [a, b, c, d] } => {
                let s = 1.0 - t;
                let (ab, bc, cd) = (*b - *a, *c - *b, *d - *c);
                let first = (ab * (s * s) + bc * (2.0 * s * t) + cd * (t * t)) * 3.0;
                [first, ((bc - ab) * s + (cd - bc) * t) * 6.0]
            }
            Self::Spline { points, at, second } => {
                let (i, h, a, b) = span(at, t);
                let first = (points[i + 1] - points[i]) / h
                    + (second[i + 1] * (3.0 * b * b - 1.0) - second[i] * (3.0 * a * a - 1.0)) * (h / 6.0);
                [first, second[i] * a + second[i + 1] * b]
            }
        }
    }

    /// Unit tangent at a parameter; where the derivative is 0, that of a chord.
    pub fn tangent(&self, t: f64) -> DVec2 {
        let first = self.derivatives(t)[0];
        first.try_normalize().unwrap_or_else(|| {
            let (a, b) = ((t - 1e-4).max(0.0), (t + 1e-4).min(1.0));
            (self.point(b) - self.point(a)).normalize_or_zero()
        })
    }

    /// Curvature at a parameter, in 1/mm; positive to the left.
    pub fn curvature(&self, t: f64) -> f64 {
        let [first, second] = self.derivatives(t);
        let speed = first.length();
        if speed == 0.0 { 0.0 } else { first.perp_dot(second) / (speed * speed * speed) }
    }

    /// Where it begins.
    pub fn start(&self) -> DVec2 {
        self.point(0.0)
    }

    /// Where it ends.
    pub fn end(&self) -> DVec2 {
        self.point(1.0)
    }

    /// Length; exact for lines and arcs, else to some 1e-9 of it (Gauss–Legendre over 64 parts).
    pub fn length(&self) -> f64 {
        match self {
            Self::Line { from, to } => from.distance(*to),
            Self::Arc { radius, sweep, .. } => radius * sweep.abs(),
            _ => {
                const PARTS: u32 = 64;
                const GAUSS: [(f64, f64); 3] = [
                    (0.0, 8.0 / 9.0),
                    (-0.774_596_669_241_483_4, 5.0 / 9.0),
                    (0.774_596_669_241_483_4, 5.0 / 9.0),
                ];
                let half = 0.5 / f64::from(PARTS);
                let part = |k: u32| -> f64 {
                    let middle = (2.0 * f64::from(k) + 1.0) * half;
                    GAUSS.iter().map(|(x, w)| w * self.derivatives(middle + x * half)[0].length()).sum()
                };
                (0..PARTS).map(part).sum::<f64>() * half
            }
        }
    }

    /// The curve walked the other way.
    #[must_use]
    pub fn reversed(&self) -> Self {
        match self {
            Self::Line { from, to } => Self::Line { from: *to, to: *from },
            Self::Arc { center, radius, start, sweep } => {
                Self::Arc { center: *center, radius: *radius, start: start + sweep, sweep: -sweep }
            }
            Self::Bezier { points: [a, b, c, d] } => Self::Bezier { points: [*d, *c, *b, *a] },
            Self::Spline { points, at, second } => {
                let back = |list: &[DVec2]| list.iter().rev().copied().collect();
                let at = at.iter().rev().map(|t| 1.0 - t).collect();
                Self::Spline { points: back(points), at, second: back(second) }
            }
        }
    }

    /// Parameters, 0 and 1 among them, between which the curve is no farther than `tolerance` from its chords. Arcs are
    /// divided evenly, and into an even number of parts, so that their middle is a point.
    pub fn parameters(&self, tolerance: f64) -> Vec<f64> {
        let even = |n: u32| (0..=n).map(|k| f64::from(k) / f64::from(n)).collect();
        match self {
            Self::Line { .. } => vec![0.0, 1.0],
            Self::Arc { radius, sweep, .. } => {
                let step = 2.0 * (1.0 - (tolerance / radius).min(0.5)).acos();
                let parts = (sweep.abs() / step.max(1e-6)).ceil().clamp(2.0, 1e4) as u32;
                even(parts + parts % 2)
            }
            _ => {
                let mut found = vec![0.0];
                self.divide(0.0, 1.0, tolerance, 0, &mut found);
                found
            }
        }
    }

    fn divide(&self, a: f64, b: f64, tolerance: f64, depth: u32, out: &mut Vec<f64>) {
        let (p, q) = (self.point(a), self.point(b));
        let off = |t: f64| {
            let r = self.point(a + (b - a) * t) - p;
            let d = (q - p).normalize_or_zero();
            if d == DVec2::ZERO { r.length() } else { r.perp_dot(d).abs() }
        };
        // Three places, so that an S is not taken for a line; two halvings at least.
        let straight = [0.25, 0.5, 0.75].into_iter().all(|t| off(t) <= tolerance);
        if (straight && depth > 1) || depth > 14 {
            out.push(b);
            return;
        }
        let middle = (a + b) / 2.0;
        self.divide(a, middle, tolerance, depth + 1, out);
        self.divide(middle, b, tolerance, depth + 1, out);
    }

    /// The point nearest to another, for snapping: every part of the curve that may come nearer than what was found, for it is
    /// no longer than its chord and a little, is halved some times and searched by golden section.
    pub fn nearest(&self, p: DVec2) -> NearestPoint {
        const SAMPLES: u32 = 64;
        /// Share of the curve's length within which parts are their chords.
        const CHORD: f64 = 1e-4;
        const HALVINGS: u32 = 5;
        let distance = |t: f64| self.point(t).distance(p);
        let mut at: Vec<f64> = (0..=SAMPLES).map(|k| f64::from(k) / f64::from(SAMPLES)).collect();
        let slack = CHORD * self.length();
        if matches!(self, Self::Bezier { .. } | Self::Spline { .. }) {
            at.extend(self.parameters(slack));
            at.sort_by(f64::total_cmp);
            at.dedup();
        }
        let mut best = at.iter().copied().min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(0.0);
        let mut pending: Vec<(f64, f64, u32)> = at.windows(2).map(|w| (w[0], w[1], HALVINGS)).collect();
        while let Some((a, b, halvings)) = pending.pop() {
            let longest = 1.1 * self.point(a).distance(self.point(b)) + 4.0 * slack;
            if distance(a) + distance(b) - longest > 2.0 * distance(best) {
                continue;
            }
            if halvings > 0 {
                let middle = (a + b) / 2.0;
                pending.extend([(a, middle, halvings - 1), (middle, b, halvings - 1)]);
            } else {
                let t = golden(|t| distance(t).powi(2), a, b);
                if distance(t) < distance(best) {
                    best = t;
                }
            }
        }
        let at = self.point(best);
        NearestPoint { t: best, at, distance: at.distance(p) }
    }
}

/// Where a function with one valley is least, ends included.
fn golden(f: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let (mut a, mut b) = (low, high);
    for _ in 0..80 {
        let (p, q) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
        if f(p) <= f(q) { b = q } else { a = p }
    }
    [(a + b) / 2.0, low, high].into_iter().min_by(|x, y| f(*x).total_cmp(&f(*y))).unwrap_or(low)
}

/// The span of a spline that holds a parameter: its number, its width, and the shares of its two ends.
fn span(at: &[f64], t: f64) -> (usize, f64, f64, f64) {
    let i = at.partition_point(|x| *x <= t).clamp(1, at.len() - 1) - 1;
    let h = at[i + 1] - at[i];
    (i, h, (at[i + 1] - t) / h, (t - at[i]) / h)
}

/// Second derivatives of the natural spline: a tridiagonal system, solved by elimination.
fn second_derivatives(points: &[DVec2], at: &[f64]) -> Vec<DVec2> {
    let n = points.len();
    let (mut upper, mut right) = (vec![0.0; n], vec![DVec2::ZERO; n]);
    for i in 1..n - 1 {
        let (h, k) = (at[i] - at[i - 1], at[i + 1] - at[i]);
        let share = h / (h + k);
        let pivot = share * upper[i - 1] + 2.0;
        upper[i] = (share - 1.0) / pivot;
        let jump = (points[i + 1] - points[i]) / k - (points[i] - points[i - 1]) / h;
        right[i] = (jump * 6.0 / (h + k) - right[i - 1] * share) / pivot;
    }
    let mut second = vec![DVec2::ZERO; n];
    for i in (1..n - 1).rev() {
        second[i] = second[i + 1] * upper[i] + right[i];
    }
    second
}
