//! Named sizes.

use super::measurements::{Figure, Measurements};

/// A named set of measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct Preset {
    /// For instance `astm-12`, `eu-38`, `man-50`, `child-128`, `average-woman`.
    pub name: String,
    /// Where the numbers come from.
    pub source: &'static str,
    /// What the form is built from.
    pub measurements: Measurements,
}

/// All presets.
pub fn presets() -> &'static [Preset] {
    &[]
}
