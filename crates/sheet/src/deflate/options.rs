//! How a solid is to be deflated.

use super::DeflateError;

/// What becomes of the mid-surface where the thickness steps and the two mid-planes do not meet (Sheen et al. 2008,
/// section 9.5).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Steps {
    /// Each side keeps its own middle, and a narrow strip joins the two.
    #[default]
    Joined,
    /// The strip is left out: the parts are apart, and a warning says so.
    Apart,
    /// The thinner part is moved over to the mid-plane of the thicker, so that no step is left.
    Aligned,
}

/// Options of [`deflate`](super::deflate()). Lengths in millimetres, angles in radians.
#[derive(Clone, Debug, PartialEq)]
pub struct DeflateOptions {
    /// Walls thicker than this are not looked for; `None`: told from the solid.
    pub max_thickness: Option<f64>,
    /// Plane walls may be inclined to each other by this much.
    pub max_draft: f64,
    /// Fillets, holes, bosses, chamfers and steps up to this size are removed first; `None`: none but the fillets
    /// that have no partner, which no mid-surface can hold.
    pub simplify: Option<f64>,
    /// Features that are kept although they are small: their numbers in the report.
    pub keep: Vec<usize>,
    /// What becomes of steps in thickness.
    pub steps: Steps,
    /// Edges of the mid-surface are about this long, and thicknesses of round walls those of their geometry; `None`: the
    /// mid-surface follows the facets of the solid.
    pub edge_length: Option<f64>,
}

impl Default for DeflateOptions {
    fn default() -> Self {
        Self {
            max_thickness: None,
            max_draft: 8f64.to_radians(),
            simplify: None,
            keep: Vec::new(),
            steps: Steps::default(),
            edge_length: None,
        }
    }
}

impl DeflateOptions {
    pub(super) fn check(&self) -> Result<(), DeflateError> {
        let lengths = [
            ("max_thickness", self.max_thickness),
            ("simplify", self.simplify),
            ("edge_length", self.edge_length),
        ];
        for (option, value) in lengths {
            if let Some(value) = value.filter(|v| !(v.is_finite() && *v > 0.0)) {
                return Err(DeflateError::OptionRange { option, value, wanted: "a finite number above 0" });
            }
        }
        let value = self.max_draft;
        if !(0.0..=std::f64::consts::FRAC_PI_4).contains(&value) {
            return Err(DeflateError::OptionRange { option: "max_draft", value, wanted: "from 0 to π/4" });
        }
        Ok(())
    }
}
