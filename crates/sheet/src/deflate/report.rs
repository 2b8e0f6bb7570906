//! What came of deflating.

use std::fmt;

use glam::DVec3;
use serde::Serialize;

/// A face of the solid that has no partner and is no thickness face of a wall.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnpairedFace {
    /// A point of it, about its middle.
    pub at: DVec3,
    /// Area in mm².
    pub area: f64,
    /// `"plane"` or `"curved"`.
    pub kind: &'static str,
}

impl fmt::Display for UnpairedFace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let p = self.at;
        write!(f, "the {} face of {:.1} mm² at ({:.2}, {:.2}, {:.2})", self.kind, self.area, p.x, p.y, p.z)
    }
}

/// A small feature that was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Feature {
    /// `"fillet"`, `"round"`, `"hole"`, `"boss"`, `"chamfer"` or `"step"`.
    pub kind: &'static str,
    /// About its middle.
    pub at: DVec3,
    /// Radius, diameter, width or height, as its kind has it, in mm.
    pub size: f64,
    /// How many faces of the solid it has.
    pub faces: usize,
    /// Whether it was removed.
    pub removed: bool,
    /// Why it was not, if it should have been.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kept_because: Option<&'static str>,
}

/// The range of a thickness field in mm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ThicknessRange {
    /// Thinnest.
    pub min: f64,
    /// Thickest.
    pub max: f64,
    /// Mean over the area.
    pub mean: f64,
}

/// Counts and measures of a mid-surface; lengths in millimetres.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct DeflateReport {
    /// Features that were found, in the order of their faces.
    pub features: Vec<Feature>,
    /// Pairs of walls that lie opposite to each other.
    pub pairs: usize,
    /// Faces without a partner, other than the ends of walls; the largest first.
    pub unpaired: Vec<UnpairedFace>,
    /// Smooth pieces of the mid-surface.
    pub patches: usize,
    /// Lines in which three and more faces meet, from branching to branching.
    pub joints: usize,
    /// Independent cycles of the free edges: of a sheet without joints its borders.
    pub free_loops: usize,
    /// Connected parts.
    pub components: usize,
    /// Area in mm².
    pub area: f64,
    /// The thickness field.
    pub thickness: ThicknessRange,
    /// Walls thicker than this were not looked for.
    pub max_thickness: f64,
    /// Share of the solid's skin that has a partner.
    pub paired_share: f64,
    /// Strips that join middles where the thickness steps.
    pub steps: usize,
    /// Pairs of faces of the mid-surface that cross.
    pub self_intersections: usize,
    /// Outline edges that could not be kept.
    pub lost_edges: usize,
    /// Volume of the solid in mm³.
    pub solid_volume: f64,
}
