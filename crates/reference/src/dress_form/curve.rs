//! Smooth functions of height through given values.

/// Monotone cubic interpolation (Fritsch and Carlson 1980): no overshoot between the values, and level exactly where a
/// value is larger or smaller than both neighbours, so that a girth is stationary at its own height.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    at: Vec<f64>,
    value: Vec<f64>,
    slope: Vec<f64>,
}

impl Curve {
    /// Through `(height, value)` pairs; sorted here; a height given twice (within a micrometre) keeps its first value.
    pub(super) fn through(points: &[(f64, f64)]) -> Self {
        let mut points = points.to_vec();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points.dedup_by(|b, a| b.0 - a.0 < 1e-3);
        let n = points.len();
        let at: Vec<f64> = points.iter().map(|p| p.0).collect();
        let value: Vec<f64> = points.iter().map(|p| p.1).collect();
        let width = |i: usize| at[i + 1] - at[i];
        let secant: Vec<f64> =
            (0..n.saturating_sub(1)).map(|i| (value[i + 1] - value[i]) / width(i)).collect();
        let mut slope = vec![0.0; n];
        for i in 1..n.saturating_sub(1) {
            let (left, right) = (secant[i - 1], secant[i]);
            if left * right > 0.0 {
                // Weighted harmonic mean (Fritsch and Butland).
                let (a, b) = (2.0 * width(i) + width(i - 1), width(i) + 2.0 * width(i - 1));
                slope[i] = (a + b) / (a / left + b / right);
            }
        }
        if n >= 2 {
            slope[0] = secant[0];
            slope[n - 1] = secant[n - 2];
        }
        Self { at, value, slope }
    }

    /// Value at height `t`; constant outside.
    pub(super) fn get(&self, t: f64) -> f64 {
        let n = self.at.len();
        if n == 0 {
            return 0.0;
        }
        if t <= self.at[0] {
            return self.value[0];
        }
        if t >= self.at[n - 1] {
            return self.value[n - 1];
        }
        let i = self.at.partition_point(|&a| a <= t) - 1;
        let h = self.at[i + 1] - self.at[i];
        let s = (t - self.at[i]) / h;
        let (s2, s3) = (s * s, s * s * s);
        self.value[i] * (2.0 * s3 - 3.0 * s2 + 1.0)
            + self.slope[i] * h * (s3 - 2.0 * s2 + s)
            + self.value[i + 1] * (3.0 * s2 - 2.0 * s3)
            + self.slope[i + 1] * h * (s3 - s2)
    }
}
