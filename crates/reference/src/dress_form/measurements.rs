//! Tape measurements: what may be given, what is derived from it, and what no body can have.

use serde::{Deserialize, Serialize};

use super::FormError;

/// Whose proportions fill in what was not measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Figure {
    /// A grown woman; the bust is shaped as two breasts.
    #[default]
    Woman,
    /// A grown man; `bust` is the chest girth.
    Man,
    /// A child of either sex; `bust` is the chest girth.
    Child,
}

/// Tape measurements in centimetres; every one may be left out.
///
/// The girths follow ISO 8559-1. What is missing is derived by [`Measurements::resolve`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "snake_case", default)]
pub struct Measurements {
    /// Proportions and shape to use.
    pub figure: Figure,
    /// Stature, crown to floor, without shoes (also for a form without a head).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// Horizontal girth at the bust points; the chest girth of men and children.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bust: Option<f64>,
    /// Horizontal girth just below the breasts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub underbust: Option<f64>,
    /// Horizontal girth at the natural waist.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub waist: Option<f64>,
    /// Horizontal girth at the top of the hip bones, between waist and hip.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub high_hip: Option<f64>,
    /// Horizontal girth at the fullest of the seat.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hip: Option<f64>,
    /// Neck *base* girth, over the nape and above the collar bones.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub neck: Option<f64>,
    /// Straight width across the shoulders, shoulder point to shoulder point.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shoulder_width: Option<f64>,
    /// Nape to waist along the back.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub back_length: Option<f64>,
    /// Fullest girth of the upper arm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub upper_arm: Option<f64>,
    /// Fullest girth of one thigh, just below the crotch.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thigh: Option<f64>,
    /// Girth of one knee.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub knee: Option<f64>,
    /// Fullest girth of one calf.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub calf: Option<f64>,
    /// Least girth of one lower leg, above the ankle bones.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ankle: Option<f64>,
}

/// A full set of measurements, centimetres; fields as in [`Measurements`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[allow(missing_docs, reason = "every field is described in `Measurements`")]
pub struct Resolved {
    pub figure: Figure,
    pub height: f64,
    pub bust: f64,
    pub underbust: f64,
    pub waist: f64,
    pub high_hip: f64,
    pub hip: f64,
    pub neck: f64,
    pub shoulder_width: f64,
    pub back_length: f64,
    pub upper_arm: f64,
    pub thigh: f64,
    pub knee: f64,
    pub calf: f64,
    pub ankle: f64,
}

/// Bust, waist and hip of the average figure that missing ones are scaled from, with its height (cm).
///
/// Women and men: the average figures of large national surveys as pattern makers quote them (bust 97.4, waist 80.3,
/// hip 104.1, height 166.2; 102.8, 89.0, 102.9, 178.9). Children: EN 13402-3 at 128 cm.
fn average(figure: Figure) -> [f64; 4] {
    match figure {
        Figure::Woman => [97.4, 80.3, 104.1, 166.2],
        Figure::Man => [102.8, 89.0, 102.9, 178.9],
        Figure::Child => [64.0, 58.5, 69.0, 128.0],
    }
}

/// Stature range that forms are made for, cm.
pub const HEIGHT_RANGE: [f64; 2] = [80.0, 220.0];

impl Measurements {
    /// Checks what is given and derives the rest.
    ///
    /// * Bust, waist, hip: the average figure's value times the geometric mean of the given ones' ratios to theirs.
    ///   Without any, they stay the average's (children: with height, chest = 56 + (height − 104) / 2.27, the slope of
    ///   EN 13402-3's children's table). Height: the average's, for children by the same line from the chest.
    /// * Underbust: women bust · (0.826 + 0.00106 (bust − 83.8)), the regression line of the five sizes of ASTM D5585-11; men 0.905 bust, children 0.94 bust.
    /// * High hip: waist + 0.66 (hip − waist). Neck base: women 34.9 + 0.2016 (bust − 83.8) (ASTM D5585-11 again),
    ///   men 17.5 + 0.24 bust, children 11.5 + 0.3 bust.
    /// * Shoulder width: 0.185 height + 0.055 bust; men and children 0.2 height + 0.05 / 0.045 bust.
    /// * Back length: 0.2435 height; children 0.232. Limbs: fixed shares of bust (upper arm) and hip (legs).
    ///
    /// # Errors
    /// [`FormError`] when a value is not a number, lies outside what people have, or two contradict each other.
    pub fn resolve(&self) -> Result<Resolved, FormError> {
        self.check_numbers()?;
        let figure = self.figure;
        let [average_bust, average_waist, average_hip, average_height] = average(figure);
        let ratios: Vec<f64> = [
            self.bust.map(|v| v / average_bust),
            self.waist.map(|v| v / average_waist),
            self.hip.map(|v| v / average_hip),
            // An underbust alone still says how large the trunk is.
            self.underbust
                .filter(|_| self.bust.is_none())
                .map(|v| v / (average_bust * underbust_share(figure, average_bust))),
        ]
        .into_iter()
        .flatten()
        .collect();
        let scale = if !ratios.is_empty() {
            Some((ratios.iter().map(|r| r.ln()).sum::<f64>() / ratios.len() as f64).exp())
        } else {
            None
        };
        let child = figure == Figure::Child;
        let bust = self.bust.unwrap_or_else(|| match (scale, self.height) {
            (Some(scale), _) => {
                let bust = average_bust * scale;
                // The bust is never below the underbust that was given.
                self.underbust.map_or(bust, |u| bust.max(u / underbust_share(figure, bust)))
            }
            (None, Some(height)) if child => 56.0 + (height - 104.0) / 2.27,
            _ => average_bust,
        });
        let scale = scale.unwrap_or(bust / average_bust);
        let height = self.height.unwrap_or_else(|| {
            if child { (104.0 + 2.27 * (bust - 56.0)).clamp(80.0, 176.0) } else { average_height }
        });
        let waist = self.waist.unwrap_or(average_waist * scale);
        let hip = self.hip.unwrap_or(average_hip * scale);
        let underbust = self.underbust.unwrap_or(bust * underbust_share(figure, bust));
        let by_figure = |woman: f64, man: f64, child: f64| match figure {
            Figure::Woman => woman,
            Figure::Man => man,
            Figure::Child => child,
        };
        let thigh = self.thigh.unwrap_or_else(|| {
            let usual = hip * by_figure(0.575, 0.56, 0.55);
            // A given knee or calf keeps the thigh above it.
            usual.max(self.knee.map_or(0.0, |k| k * 1.15)).max(self.calf.map_or(0.0, |c| c * 1.15))
        });
        let knee = self.knee.unwrap_or(thigh * by_figure(0.655, 0.68, 0.69));
        let calf = self.calf.unwrap_or(thigh * by_figure(0.655, 0.675, 0.70));
        let resolved = Resolved {
            figure,
            height,
            bust,
            underbust,
            waist,
            high_hip: self.high_hip.unwrap_or(waist + 0.66 * (hip - waist)),
            hip,
            neck: self.neck.unwrap_or(by_figure(
                34.9 + 0.2016 * (bust - 83.8),
                17.5 + 0.24 * bust,
                11.5 + 0.3 * bust,
            )),
            shoulder_width: self.shoulder_width.unwrap_or(by_figure(
                0.185 * height + 0.055 * bust,
                0.200 * height + 0.050 * bust,
                0.200 * height + 0.045 * bust,
            )),
            back_length: self.back_length.unwrap_or(height * by_figure(0.2435, 0.2435, 0.232)),
            upper_arm: self.upper_arm.unwrap_or(bust * by_figure(0.29, 0.30, 0.30)),
            thigh,
            knee,
            calf,
            ankle: self.ankle.unwrap_or(calf * 0.6),
        };
        resolved.check()?;
        Ok(resolved)
    }

    /// Name and value of what was given.
    fn given(&self) -> [(&'static str, Option<f64>); 14] {
        [
            ("height", self.height),
            ("bust", self.bust),
            ("underbust", self.underbust),
            ("waist", self.waist),
            ("high_hip", self.high_hip),
            ("hip", self.hip),
            ("neck", self.neck),
            ("shoulder_width", self.shoulder_width),
            ("back_length", self.back_length),
            ("upper_arm", self.upper_arm),
            ("thigh", self.thigh),
            ("knee", self.knee),
            ("calf", self.calf),
            ("ankle", self.ankle),
        ]
    }

    fn check_numbers(&self) -> Result<(), FormError> {
        for (name, value) in self.given() {
            let Some(value) = value else { continue };
            if !value.is_finite() {
                return Err(FormError::NotANumber { name });
            }
            if value <= 0.0 {
                return Err(FormError::NotPositive { name, value });
            }
        }
        let Some(height) = self.height else { return Ok(()) };
        if !(HEIGHT_RANGE[0]..=HEIGHT_RANGE[1]).contains(&height) {
            return Err(FormError::OutOfRange {
                name: "height",
                value: height,
                low: HEIGHT_RANGE[0],
                high: HEIGHT_RANGE[1],
            });
        }
        Ok(())
    }
}

/// Underbust over bust of the figure at that bust (see [`Measurements::resolve`]).
fn underbust_share(figure: Figure, bust: f64) -> f64 {
    match figure {
        Figure::Woman => (0.826 + 0.00106 * (bust - 83.8)).clamp(0.80, 0.90),
        Figure::Man => 0.905,
        Figure::Child => 0.94,
    }
}

/// A measure must lie between two multiples of another one.
struct Ratio {
    name: &'static str,
    of: &'static str,
    low: f64,
    high: f64,
}

/// Plausible ratios. Wide on purpose: ANSUR II and CAESAR adults, CDC growth charts' children and the size tables of
/// women 0 to 30 lie inside with a tenth to spare; what is outside is a slip of the pen or of the unit.
const RATIOS: &[Ratio] = &[
    Ratio { name: "bust", of: "height", low: 0.36, high: 1.05 },
    Ratio { name: "waist", of: "height", low: 0.28, high: 1.05 },
    Ratio { name: "hip", of: "height", low: 0.40, high: 1.08 },
    Ratio { name: "underbust", of: "bust", low: 0.68, high: 1.0 },
    Ratio { name: "waist", of: "bust", low: 0.52, high: 1.22 },
    Ratio { name: "waist", of: "hip", low: 0.50, high: 1.22 },
    Ratio { name: "waist", of: "underbust", low: 0.62, high: 1.35 },
    Ratio { name: "hip", of: "bust", low: 0.70, high: 1.60 },
    Ratio { name: "neck", of: "bust", low: 0.28, high: 0.60 },
    Ratio { name: "shoulder_width", of: "height", low: 0.17, high: 0.31 },
    Ratio { name: "back_length", of: "height", low: 0.19, high: 0.29 },
    Ratio { name: "upper_arm", of: "bust", low: 0.18, high: 0.46 },
    Ratio { name: "thigh", of: "hip", low: 0.46, high: 0.655 },
    Ratio { name: "knee", of: "thigh", low: 0.42, high: 0.95 },
    Ratio { name: "calf", of: "thigh", low: 0.42, high: 0.95 },
    Ratio { name: "ankle", of: "calf", low: 0.42, high: 0.95 },
];

impl Resolved {
    /// The measure called `name`, cm.
    pub fn get(&self, name: &str) -> Option<f64> {
        Some(match name {
            "height" => self.height,
            "bust" => self.bust,
            "underbust" => self.underbust,
            "waist" => self.waist,
            "high_hip" => self.high_hip,
            "hip" => self.hip,
            "neck" => self.neck,
            "shoulder_width" => self.shoulder_width,
            "back_length" => self.back_length,
            "upper_arm" => self.upper_arm,
            "thigh" => self.thigh,
            "knee" => self.knee,
            "calf" => self.calf,
            "ankle" => self.ankle,
            _ => return None,
        })
    }

    /// The same measures, each as if it had been given.
    pub fn to_measurements(self) -> Measurements {
        Measurements {
            figure: self.figure,
            height: Some(self.height),
            bust: Some(self.bust),
            underbust: Some(self.underbust),
            waist: Some(self.waist),
            high_hip: Some(self.high_hip),
            hip: Some(self.hip),
            neck: Some(self.neck),
            shoulder_width: Some(self.shoulder_width),
            back_length: Some(self.back_length),
            upper_arm: Some(self.upper_arm),
            thigh: Some(self.thigh),
            knee: Some(self.knee),
            calf: Some(self.calf),
            ankle: Some(self.ankle),
        }
    }

    fn check(&self) -> Result<(), FormError> {
        let value = |name: &str| self.get(name).unwrap_or(f64::NAN);
        for ratio in RATIOS {
            let (measure, base) = (value(ratio.name), value(ratio.of));
            if !(measure >= ratio.low * base && measure <= ratio.high * base) {
                return Err(FormError::Contradiction {
                    name: ratio.name,
                    value: measure,
                    other: ratio.of,
                    other_value: base,
                    low: ratio.low * base,
                    high: ratio.high * base,
                });
            }
        }
        let [least, most] = [self.waist.min(self.hip) * 0.97, self.waist.max(self.hip) * 1.03];
        if !(self.high_hip >= least && self.high_hip <= most) {
            return Err(FormError::OutOfRange {
                name: "high_hip",
                value: self.high_hip,
                low: least,
                high: most,
            });
        }
        Ok(())
    }
}
