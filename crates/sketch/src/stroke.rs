//! Strokes: what a hand draws, made steady and evenly spaced.

use glam::DVec2;

use crate::SketchError;

/// A drawn line in pixels: two points at least, no point twice in a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    points: Vec<DVec2>,
    /// Length up to each point.
    sums: Vec<f64>,
}

impl Stroke {
    /// A stroke of pointer positions; points that repeat the one before are left out.
    ///
    /// # Errors
    /// [`SketchError`]: a coordinate that is no finite number, fewer than two different points.
    pub fn new(points: &[DVec2]) -> Result<Self, SketchError> {
        if points.iter().any(|p| !p.is_finite()) {
            return Err(SketchError::Number { what: "a point of a stroke", wanted: "finite" });
        }
        let mut kept: Vec<DVec2> = Vec::with_capacity(points.len());
        for p in points {
            if kept.last() != Some(p) {
                kept.push(*p);
            }
        }
        if kept.len() < 2 {
            return Err(SketchError::TooFewPoints { what: "a stroke", wanted: 2, given: kept.len() });
        }
        let mut sums = vec![0.0];
        for w in kept.windows(2) {
            sums.push(sums[sums.len() - 1] + w[0].distance(w[1]));
        }
        Ok(Self { points: kept, sums })
    }

    /// Its points.
    pub fn points(&self) -> &[DVec2] {
        &self.points
    }

    /// Length, pixels.
    pub fn length(&self) -> f64 {
        self.sums[self.sums.len() - 1]
    }

    /// The place at a length from the beginning, held at the ends. O(log n).
    pub fn at(&self, length: f64) -> DVec2 {
        let after = self.sums.partition_point(|s| *s < length).clamp(1, self.sums.len() - 1);
        let (a, b) = (self.sums[after - 1], self.sums[after]);
        let t = ((length - a) / (b - a)).clamp(0.0, 1.0);
        self.points[after - 1].lerp(self.points[after], t)
    }

    /// Distance of a place to the stroke, and the length from the beginning at which it is nearest. O(n).
    pub fn nearest(&self, p: DVec2) -> (f64, f64) {
        self.nearest_between(p, 0.0, self.length())
    }

    /// The same on the part between two lengths: where a stroke comes back to a place, another pass is not meant. O(n).
    pub fn nearest_between(&self, p: DVec2, from: f64, to: f64) -> (f64, f64) {
        let mut best = (f64::INFINITY, from);
        for (k, w) in self.points.windows(2).enumerate() {
            if self.sums[k + 1] < from || self.sums[k] > to {
                continue;
            }
            let d = w[1] - w[0];
            let length = d.length();
            let share = |s: f64| ((s - self.sums[k]) / length).clamp(0.0, 1.0);
            let t = ((p - w[0]).dot(d) / d.length_squared()).clamp(share(from), share(to));
            let distance = (w[0] + t * d).distance(p);
            if distance < best.0 {
                best = (distance, self.sums[k] + t * length);
            }
        }
        best
    }

    /// `count` points evenly spaced by arc length between two lengths, both ends included; `from` may be above `to`.
    pub fn resampled(&self, from: f64, to: f64, count: usize) -> Vec<DVec2> {
        let last = count.max(2) - 1;
        (0..=last).map(|k| self.at(from + (to - from) * k as f64 / last as f64)).collect()
    }

    /// The stroke without the hand's tremble: a Gaussian of standard deviation `radius` (pixels along the stroke) over points
    /// one pixel apart. The reach shrinks towards the ends, so that they stay where they are. Straight lines stay straight.
    /// O(length · radius).
    #[must_use]
    pub fn steadied(&self, radius: f64) -> Self {
        if radius.is_nan() || radius <= 0.0 {
            return self.clone();
        }
        // A stroke across ten screens is still cheap; longer ones are sampled more coarsely.
        let count = (self.length().ceil().clamp(2.0, 20_000.0)) as usize + 1;
        let even = self.resampled(0.0, self.length(), count);
        let step = self.length() / (count - 1) as f64;
        let sigma = radius / step;
        let smooth = |i: usize| {
            let reach = ((3.0 * sigma) as usize).min(i).min(count - 1 - i);
            if reach == 0 {
                return even[i];
            }
            let (mut sum, mut weight) = (DVec2::ZERO, 0.0);
            let sigma = sigma.min(reach as f64 / 2.0);
            for (j, p) in even.iter().enumerate().take(i + reach + 1).skip(i - reach) {
                let d = (j as f64 - i as f64) / sigma;
                let w = (-0.5 * d * d).exp();
                sum += w * *p;
                weight += w;
            }
            sum / weight
        };
        let points: Vec<DVec2> = (0..count).map(smooth).collect();
        Self::new(&points).unwrap_or_else(|_| self.clone())
    }
}

/// Steadies a stroke while it is drawn: the pen hangs on a string, and the line follows only when the string is taut.
#[derive(Clone, Debug)]
pub struct Stabiliser {
    string: f64,
    points: Vec<DVec2>,
}

impl Stabiliser {
    /// A string of `length` pixels; 0 follows every move.
    pub fn new(length: f64) -> Self {
        Self { string: length.max(0.0), points: Vec::new() }
    }

    /// The pen is here now. Positions that are no numbers are left out.
    pub fn push(&mut self, pen: DVec2) {
        if !pen.is_finite() {
            return;
        }
        let Some(last) = self.points.last().copied() else {
            self.points.push(pen);
            return;
        };
        let away = pen - last;
        if away.length() > self.string {
            self.points.push(pen - away.normalize_or_zero() * self.string);
        }
    }

    /// The line so far.
    pub fn points(&self) -> &[DVec2] {
        &self.points
    }

    /// The pen is lifted: the line goes on to where it is.
    pub fn finish(mut self, pen: DVec2) -> Vec<DVec2> {
        if pen.is_finite() && self.points.last() != Some(&pen) {
            self.points.push(pen);
        }
        self.points
    }
}
