//! What came of deflating.

use std::fmt;

use std::collections::BTreeMap;

use glam::DVec3;
use rayon::prelude::*;
use serde::Serialize;

use super::faces::Faces;
use super::segments::Segments;
use super::shape::Shape;
use super::solid::Solid;
use super::walls::Walls;

/// A face of the solid that something is to be said about.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NamedFace {
    /// A point of it, about its middle.
    pub at: DVec3,
    /// Area in mm².
    pub area: f64,
    /// `"plane"` or `"curved"`.
    pub kind: &'static str,
}

impl fmt::Display for NamedFace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let p = self.at;
        write!(f, "the {} face of {:.1} mm² at ({:.2}, {:.2}, {:.2})", self.kind, self.area, p.x, p.y, p.z)
    }
}

/// A face of the solid's skin with its geometry.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SkinFace {
    /// What it is, with its measures.
    #[serde(flatten)]
    pub shape: Shape,
    /// Whether it is hollow: the side of a hole, the inner side of a bend.
    pub concave: bool,
    /// A point of it, about its middle.
    pub at: DVec3,
    /// Area in mm².
    pub area: f64,
    /// How many triangles it has.
    pub triangles: usize,
}

/// Two faces that are as far from each other everywhere.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WallPair {
    /// Their numbers in the list of faces, the smaller first.
    pub faces: [usize; 2],
    /// What lies halfway between them.
    pub middle: Shape,
    /// How far they are apart, in mm; told from their geometry, not from facets.
    pub thickness: f64,
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
    /// Faces of the solid's skin, in the order of their first triangles.
    pub faces: Vec<SkinFace>,
    /// Pairs of faces with an exact middle, ordered.
    pub wall_pairs: Vec<WallPair>,
    /// Pairs of walls that lie opposite to each other.
    pub pairs: usize,
    /// Faces without a partner, other than the ends of walls; the largest first.
    pub unpaired: Vec<NamedFace>,
    /// Walls most of which came to have no mid-surface, with the area that has none.
    pub bare: Vec<NamedFace>,
    /// Borders of the mid-surface that end inside the material: walls that should be joined there and are not.
    pub loose_ends: Option<LooseEnds>,
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

/// The faces as the report has them. O(n).
pub(super) fn skin_faces(solid: &Solid, faces: &Faces) -> Vec<SkinFace> {
    let listed = |face: &super::faces::Face| {
        let largest = face
            .triangles
            .iter()
            .max_by(|f, g| solid.areas[**f as usize].total_cmp(&solid.areas[**g as usize]).then(g.cmp(f)));
        SkinFace {
            shape: face.shape,
            concave: face.concave,
            at: largest.map_or(DVec3::ZERO, |f| solid.centroid(*f)),
            area: face.area,
            triangles: face.triangles.len(),
        }
    };
    faces.list.iter().map(listed).collect()
}

/// Faces that see each other through the material over this share of the smaller one are a pair.
const SEEN: f64 = 0.1;

/// Which faces with an exact middle between them see each other. O(n log n).
pub(super) fn wall_pairs(solid: &Solid, segments: &Segments, walls: &Walls, faces: &Faces) -> Vec<WallPair> {
    let looks: Vec<Option<([u32; 2], f64)>> = (0..solid.len())
        .into_par_iter()
        .map(|f| {
            let own = faces.of[f as usize];
            if faces.list[own as usize].shape == Shape::Freeform {
                return None;
            }
            let seen = walls.opposite_middle(solid, segments, f)?;
            let other = faces.of[seen.face as usize];
            (own != other).then(|| ([own.min(other), own.max(other)], solid.areas[f as usize]))
        })
        .collect();
    let mut areas: BTreeMap<[u32; 2], f64> = BTreeMap::new();
    for (pair, area) in looks.into_iter().flatten() {
        *areas.entry(pair).or_default() += area;
    }
    let pair = |([a, b], area): ([u32; 2], f64)| {
        let [f, g] = [a, b].map(|k| &faces.list[k as usize]);
        let (middle, thickness) = f.shape.middle(&g.shape)?;
        (area > SEEN * f.area.min(g.area)).then_some(WallPair {
            faces: [a as usize, b as usize],
            middle,
            thickness,
        })
    };
    areas.into_iter().filter_map(pair).collect()
}

/// Borders that end inside the material.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LooseEnds {
    /// Of all, in mm.
    pub length: f64,
    /// Beside one, in mm.
    pub at: DVec3,
}
