//! Why a form is refused.

/// A set of measurements that no form can be made of.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FormError {
    /// NaN or infinite.
    #[error("{name} is not a number; give it in centimetres or leave it out")]
    NotANumber {
        /// Which measurement.
        name: &'static str,
    },
    /// Zero or negative.
    #[error("{name} is {value} cm; a measurement is more than 0 cm (leave it out if it is not known)")]
    NotPositive {
        /// Which measurement.
        name: &'static str,
        /// As given, cm.
        value: f64,
    },
    /// Outside the range that people have.
    #[error(
        "{name} is {value:.1} cm, outside {low:.1} to {high:.1} cm; check the number and its unit (centimetres)"
    )]
    OutOfRange {
        /// Which measurement.
        name: &'static str,
        /// As given, cm.
        value: f64,
        /// Least plausible value, cm.
        low: f64,
        /// Greatest plausible value, cm.
        high: f64,
    },
    /// Two measurements that no body has together.
    #[error(
        "{name} {value:.1} cm does not go with {other} {other_value:.1} cm: people have {low:.1} to {high:.1} cm there; \
         check both numbers"
    )]
    Contradiction {
        /// The measurement at fault.
        name: &'static str,
        /// As given or derived, cm.
        value: f64,
        /// The one it contradicts.
        other: &'static str,
        /// As given or derived, cm.
        other_value: f64,
        /// Least plausible value of `name`, cm.
        low: f64,
        /// Greatest plausible value of `name`, cm.
        high: f64,
    },
    /// The wanted mesh is too coarse or too fine.
    #[error("{triangles} triangles were asked for; a form has {low} to {high}")]
    Resolution {
        /// As asked.
        triangles: usize,
        /// Fewest.
        low: usize,
        /// Most.
        high: usize,
    },
    /// The girth of the finished mesh does not come near enough to the measurement: the set contradicts itself in a way that
    /// the plausible ratios do not show.
    #[error(
        "the {name} of the form became {got:.2} cm instead of {wanted:.2} cm: these measurements do not fit one body"
    )]
    NotReached {
        /// Which measurement.
        name: &'static str,
        /// As asked, cm.
        wanted: f64,
        /// As built, cm.
        got: f64,
    },
    /// The surface would fold or tear.
    #[error(
        "no smooth body has these measurements together: the surface folds near {height:.0} cm above the floor"
    )]
    Folded {
        /// Where, cm.
        height: f64,
    },
}
