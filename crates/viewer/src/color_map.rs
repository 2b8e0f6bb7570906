//! Colour maps: a number to a colour, so that equal steps of the number look like equal steps.

use crate::color::Color;

/// How numbers become colours.
///
/// Both maps are computed in Oklab, with lightness linear in the number (sequential) or in its distance from the
/// middle (diverging): they order rightly also in grey print and for colour-blind eyes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ColorMap {
    /// Dark violet over blue and green to light yellow.
    #[default]
    Sequential,
    /// Blue over white to red; the middle of the range is white.
    Diverging,
    /// White to a deep blue: quiet, for errors that should be absent.
    Ramp,
}

impl ColorMap {
    /// Colour at `t`; below 0 and above 1 the end colours, for NaN [`Color::NO_VALUE`].
    pub fn at(self, t: f64) -> Color {
        if t.is_nan() {
            return Color::NO_VALUE;
        }
        let t = t.clamp(0.0, 1.0);
        match self {
            Self::Sequential => {
                // Chroma dips in the blue-greens, where sRGB has little of it: no kinks from clipping.
                let hue = 5.45 - 3.60 * t;
                let chroma = 0.13 + 0.05 * t - 0.27 * t * (1.0 - t);
                Color::from_oklch(0.30 + 0.62 * t, chroma, hue)
            }
            Self::Diverging => {
                let s = 2.0 * t - 1.0;
                let hue = if s < 0.0 { 4.45 } else { 0.47 };
                let away = s.abs();
                Color::from_oklch(0.965 - 0.475 * away, 0.19 * away.powf(0.85), hue)
            }
            Self::Ramp => Color::from_oklch(0.965 - 0.6 * t, 0.13 * t.powf(0.8), 4.5),
        }
    }

    /// The map as a table of `n` ≥ 2 colours from 0 to 1: what pictures look colours up in.
    pub fn table(self, n: usize) -> Vec<Color> {
        let n = n.max(2);
        (0..n).map(|i| self.at(i as f64 / (n - 1) as f64)).collect()
    }
}

/// Numbers shown as colours: the range that the map spans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// The colour map.
    pub map: ColorMap,
    /// Number at the map's lower end.
    pub low: f64,
    /// Number at the map's upper end.
    pub high: f64,
}

impl Scale {
    /// A scale from `low` to `high`.
    pub fn new(map: ColorMap, low: f64, high: f64) -> Self {
        Self { map, low, high }
    }

    /// The scale over all finite `values`: their least and greatest for a one-way map; symmetric about zero for the
    /// diverging one. A range of no width is widened, so that the scale is always usable.
    pub fn of(map: ColorMap, values: &[f64]) -> Self {
        let finite = values.iter().copied().filter(|v| v.is_finite());
        let (mut low, mut high) =
            finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        if map == ColorMap::Diverging {
            high = low.abs().max(high.abs());
            low = -high;
        }
        if high - low <= 1e-12 * high.abs().max(low.abs()) || high == low {
            let half = if high == 0.0 { 0.5 } else { 0.5 * high.abs() };
            low -= half;
            high += half;
        }
        Self { map, low, high }
    }

    /// Where `value` lies: 0 at `low`, 1 at `high`, not clamped; NaN stays NaN.
    pub fn position(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    /// Colour of `value`.
    pub fn color(&self, value: f64) -> Color {
        self.map.at(self.position(value))
    }

    /// Round numbers inside the range, some `wanted` of them, rising: 1, 2 or 5 times a power of ten apart.
    pub fn ticks(&self, wanted: usize) -> Vec<f64> {
        let span = self.high - self.low;
        if !(span.is_finite() && span > 0.0) {
            return vec![self.low];
        }
        let raw = span / wanted.max(1) as f64;
        let power = 10f64.powf(raw.log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|s| *s >= raw * 0.999).unwrap_or(raw);
        let first = (self.low / step - 1e-9).ceil() as i64;
        let last = (self.high / step + 1e-9).floor() as i64;
        (first..=last).map(|i| i as f64 * step).collect()
    }
}

/// `value` as short text beside neighbours `step` apart.
pub(crate) fn tick_text(value: f64, step: f64) -> String {
    let decimals = if step > 0.0 { (-(step.log10() + 1e-9).floor()).clamp(0.0, 9.0) as usize } else { 2 };
    let text = format!("{:.*}", decimals, value);
    // Minus sign proper; no minus before zero.
    if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') {
        text.trim_start_matches('-').to_owned()
    } else {
        text.replace('-', "−")
    }
}
