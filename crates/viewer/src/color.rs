//! Colours: sRGB bytes outside, linear light or Oklab inside.

use std::sync::LazyLock;

/// An opaque colour, sRGB encoded, eight bits a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Color(pub [u8; 3]);

impl Color {
    /// White.
    pub const WHITE: Self = Self([255, 255, 255]);
    /// Ink of lines and text: nearly black, a little blue.
    pub const INK: Self = Self([38, 42, 50]);
    /// Ink of what shall stay in the background: ticks, grids, hidden lines.
    pub const FAINT_INK: Self = Self([142, 147, 156]);
    /// A dress form's or a body's skin: warm light grey.
    pub const SKIN: Self = Self([232, 216, 203]);
    /// Background of pictures.
    pub const PAPER: Self = Self([248, 248, 246]);
    /// What has no value (`NaN`) where colours show a quantity.
    pub const NO_VALUE: Self = Self([176, 176, 176]);
    /// Seams.
    pub const SEAM: Self = Self([52, 58, 70]);
    /// Centre and feature lines, grain lines, whatever must catch the eye.
    pub const ACCENT: Self = Self([196, 52, 60]);

    /// The colour of Oklab lightness `l` (0 to 1), chroma `c` and hue `h` in radians; chroma is reduced until
    /// the colour exists in sRGB. Oklab: B. Ottosson, "A perceptual color space for image processing", 2020.
    pub fn from_oklch(l: f64, c: f64, h: f64) -> Self {
        let mut inside = 0.0;
        let mut outside = c;
        let mut best = oklab_to_linear([l, c * h.cos(), c * h.sin()]);
        if !in_gamut(best) {
            for _ in 0..12 {
                let mid = 0.5 * (inside + outside);
                let candidate = oklab_to_linear([l, mid * h.cos(), mid * h.sin()]);
                if in_gamut(candidate) {
                    inside = mid;
                } else {
                    outside = mid;
                }
            }
            best = oklab_to_linear([l, inside * h.cos(), inside * h.sin()]);
        }
        Self(best.map(|x| (encode(x.clamp(0.0, 1.0)) * 255.0).round() as u8))
    }

    /// Oklab lightness, a, b.
    pub fn to_oklab(self) -> [f64; 3] {
        let [r, g, b] = self.0.map(|x| decode(f64::from(x) / 255.0));
        let l = (0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b).cbrt();
        let m = (0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b).cbrt();
        let s = (0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b).cbrt();
        [
            0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
            1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
            0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
        ]
    }

    /// The colour between `self` (at 0) and `other` (at 1), mixed in Oklab.
    pub fn mix(self, other: Self, t: f64) -> Self {
        let (a, b) = (self.to_oklab(), other.to_oklab());
        let lab = [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * t.clamp(0.0, 1.0));
        Self(oklab_to_linear(lab).map(|x| (encode(x.clamp(0.0, 1.0)) * 255.0).round() as u8))
    }

    /// The same colour in less light: `share` of it, linearly.
    pub(crate) fn dimmed(self, share: f64) -> Self {
        Self(self.0.map(|x| (encode(decode(f64::from(x) / 255.0) * share) * 255.0).round() as u8))
    }

    /// Linear light, 0 to 1 a channel.
    pub(crate) fn linear(self) -> [f32; 3] {
        self.0.map(|x| LINEAR[x as usize])
    }
}

/// Linear light of every byte.
static LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|i| decode(i as f64 / 255.0) as f32));

fn in_gamut(rgb: [f64; 3]) -> bool {
    rgb.iter().all(|x| (-1e-4..=1.0001).contains(x))
}

fn oklab_to_linear([l, a, b]: [f64; 3]) -> [f64; 3] {
    let l_ = (l + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m_ = (l - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s_ = (l - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    [
        4.076_741_662_1 * l_ - 3.307_711_591_3 * m_ + 0.230_969_929_2 * s_,
        -1.268_438_004_6 * l_ + 2.609_757_401_1 * m_ - 0.341_319_396_5 * s_,
        -0.004_196_086_3 * l_ - 0.703_418_614_7 * m_ + 1.707_614_701_0 * s_,
    ]
}

/// sRGB value (0 to 1) to linear light (IEC 61966-2-1).
pub(crate) fn decode(x: f64) -> f64 {
    if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

/// Linear light (0 to 1) to the sRGB value.
pub(crate) fn encode(x: f64) -> f64 {
    if x <= 0.003_130_8 { x * 12.92 } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

/// Encodes linear light to sRGB bytes by table: 4096 steps are finer than a byte's step everywhere above the
/// linear toe, and the toe is black to the eye.
pub(crate) struct Encoder {
    table: Vec<u8>,
}

impl Encoder {
    const STEPS: usize = 4096;

    pub(crate) fn new() -> Self {
        let table = (0..=Self::STEPS)
            .map(|i| (encode(i as f64 / Self::STEPS as f64) * 255.0).round() as u8)
            .collect();
        Self { table }
    }

    pub(crate) fn byte(&self, linear: f32) -> u8 {
        // `as` saturates and sends NaN to 0.
        self.table[((linear * Self::STEPS as f32 + 0.5) as usize).min(Self::STEPS)]
    }
}

/// The `i`-th colour of cloth: muted, light, and far from its neighbours in the list (hues step by the golden
/// angle, lightness alternates). Endless.
pub fn cloth_color(i: usize) -> Color {
    const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;
    // Starts at a dusty blue; the three lightnesses keep hues apart that come round again.
    let hue = 4.35 + i as f64 * GOLDEN_ANGLE;
    let l = [0.70, 0.77, 0.64][i % 3];
    Color::from_oklch(l, 0.085, hue)
}
