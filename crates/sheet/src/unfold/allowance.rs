//! What a bend does to lengths.

use serde::Serialize;

use super::UnfoldError;

/// Which layer of the metal the sheet stands for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reference {
    /// The middle of the thickness.
    #[default]
    Middle,
    /// The inner surface of every bend: inside dimensions.
    Inside,
    /// The outer surface of every bend: outside dimensions.
    Outside,
}

/// Thickness and bends of the metal. Lengths in millimetres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Metal {
    /// Thickness; 0 for a sheet that is folded sharply, as paper is.
    pub thickness: f64,
    /// Radius on the inner side of bends.
    pub inner_radius: f64,
    /// How far the layer that keeps its length is from the inner side, as a share of the thickness.
    pub k_factor: f64,
    /// Which layer of the metal the sheet stands for.
    pub reference: Reference,
}

impl Default for Metal {
    fn default() -> Self {
        Self { thickness: 0.0, inner_radius: 0.0, k_factor: 0.44, reference: Reference::Middle }
    }
}

/// A bend's measures. Lengths in millimetres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BendMeasures {
    /// By what angle the flat sheet is bent, in radians; 0 stays flat.
    pub angle: f64,
    /// From the facets' common line to where the bend begins, on either side.
    pub setback: f64,
    /// Width of the bent strip when flat: `angle · (inner radius + k · thickness)`.
    pub allowance: f64,
}

impl BendMeasures {
    /// Distance of the facets' lines on the flat sheet; negative where the flat sheet is shorter than both legs.
    pub fn gap(&self) -> f64 {
        self.allowance - 2.0 * self.setback
    }
}

/// Bends of more than this are hems: their legs never meet in a line, so no setback exists.
const FOLDED_BACK: f64 = std::f64::consts::PI - 1e-3;

impl Metal {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`UnfoldError::Option`] for numbers that are not finite or out of range.
    pub fn check(&self) -> Result<(), UnfoldError> {
        let bad = |option, value, wanted| Err(UnfoldError::Option { option, value, wanted });
        let length = |x: f64| x.is_finite() && x >= 0.0;
        if !length(self.thickness) {
            return bad("thickness", self.thickness, "0 or more");
        }
        if !length(self.inner_radius) {
            return bad("inner radius", self.inner_radius, "0 or more");
        }
        if !(0.0..=1.0).contains(&self.k_factor) {
            return bad("k-factor", self.k_factor, "from 0 to 1");
        }
        Ok(())
    }

    /// The measures of a bend by an angle in radians, not negative; `None` where facets lie back on each other and the metal
    /// has a thickness or a radius.
    pub fn bend(&self, angle: f64) -> Option<BendMeasures> {
        let radius = match self.reference {
            Reference::Middle => self.inner_radius + self.thickness / 2.0,
            Reference::Inside => self.inner_radius,
            Reference::Outside => self.inner_radius + self.thickness,
        };
        let allowance = angle * (self.inner_radius + self.k_factor * self.thickness);
        if radius == 0.0 && allowance == 0.0 {
            return Some(BendMeasures { angle, setback: 0.0, allowance: 0.0 });
        }
        (angle < FOLDED_BACK).then(|| BendMeasures {
            angle,
            setback: radius * (angle / 2.0).tan(),
            allowance,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_right_angle_by_hand() {
        // Sheet-metal table: t 2, r 3, K 0.4: allowance π/2 · 3.8; outside setback 5; deduction 10 − 5.969.
        let metal = Metal { thickness: 2.0, inner_radius: 3.0, k_factor: 0.4, reference: Reference::Outside };
        let bend = metal.bend(std::f64::consts::FRAC_PI_2).expect("a right angle bends");
        assert!((bend.allowance - 5.969_026_041_820_607).abs() < 1e-12);
        assert!((bend.setback - 5.0).abs() < 1e-12);
        assert!((bend.gap() + 4.030_973_958_179_393).abs() < 1e-12);
    }

    #[test]
    fn sharp_folds_need_nothing_and_hems_have_no_setback() {
        let paper = Metal::default().bend(std::f64::consts::PI).expect("paper folds flat");
        assert_eq!((paper.setback, paper.allowance), (0.0, 0.0));
        let metal = Metal { thickness: 1.0, inner_radius: 1.0, ..Metal::default() };
        assert_eq!(metal.bend(std::f64::consts::PI), None);
        assert_eq!(metal.bend(0.0).map(|b| b.gap()), Some(0.0));
        assert!(Metal { k_factor: 2.0, ..metal }.check().is_err());
        assert!(Metal { thickness: f64::NAN, ..metal }.check().is_err());
    }
}
