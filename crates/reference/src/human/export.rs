//! Features as data for other programs, in the file's own frame, and the tape measures.

use std::collections::BTreeMap;

use mesh_kernel::glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{HumanBody, Unit};
use crate::model::{FeatureCurve, Features};

/// What `toile features` writes. Lengths and coordinates in millimetres, in the axes of the input file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExportedFeatures {
    /// Always `mm`.
    pub units: String,
    /// Unit of the input as told from its height: `m`, `cm`, `mm`.
    pub file_units: String,
    /// Stature.
    pub height: f64,
    /// Unit vector to the front.
    pub facing: [f64; 3],
    /// Unit vector upward.
    pub up: [f64; 3],
    /// Places by name.
    pub points: BTreeMap<String, [f64; 3]>,
    /// Curves by name.
    pub curves: BTreeMap<String, ExportedCurve>,
    /// Tape measures by name.
    pub girths: BTreeMap<String, f64>,
    /// What was guessed, in words.
    pub warnings: Vec<String>,
}

/// A curve of [`ExportedFeatures`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExportedCurve {
    /// Whether the last point joins the first.
    pub closed: bool,
    /// Length along the skin.
    pub length: f64,
    /// Tape measure of a closed curve: length of its convex hull.
    #[serde(default)]
    pub girth: Option<f64>,
    /// Points in order; a closed curve does not repeat the first.
    pub polyline: Vec<[f64; 3]>,
}

impl HumanBody {
    /// The features in the frame of the input file, in millimetres.
    pub fn exported(&self) -> ExportedFeatures {
        let millimetres = self.unit.millimetres();
        let place = |p: DVec3| (self.placement.to_file(p) * millimetres).to_array();
        let direction = |d: DVec3| self.placement.direction_to_file(d).to_array();
        ExportedFeatures {
            units: Unit::Millimetre.symbol().to_owned(),
            file_units: self.unit.symbol().to_owned(),
            height: self.features.height,
            facing: direction(self.features.facing),
            up: direction(self.features.up),
            points: self.features.points.iter().map(|(n, p)| (n.clone(), place(p.position))).collect(),
            curves: self
                .features
                .curves
                .iter()
                .map(|(name, c)| {
                    let curve = ExportedCurve {
                        closed: c.closed,
                        length: c.length(),
                        girth: c.closed.then(|| c.girth()),
                        polyline: c.points.iter().map(|p| place(*p)).collect(),
                    };
                    (name.clone(), curve)
                })
                .collect(),
            girths: self.girths.clone(),
            warnings: self.features.warnings.clone(),
        }
    }
}

/// Tape measures of the closed curves; a curve and its taut twin have one.
pub(crate) fn girths(features: &Features) -> BTreeMap<String, f64> {
    features
        .curves
        .iter()
        .filter(|(name, c)| c.closed && !name.ends_with("_tape"))
        .map(|(name, c): (&String, &FeatureCurve)| (name.clone(), c.girth()))
        .collect()
}
