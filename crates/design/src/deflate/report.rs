//! The report of a deflated solid.

use serde::Serialize;
use sheet::deflate::{Deflated, Feature, LooseEnds, NamedFace, SkinFace, ThicknessRange, WallPair};

/// What `toile deflate` reports; lengths in millimetres, whatever the file's unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DeflateFileReport {
    /// Small features that were taken away before.
    pub removed_features: Vec<Feature>,
    /// Small features that stayed: too large, asked for, or their removal would not have been sound.
    pub kept_features: Vec<Feature>,
    /// Pairs of walls that lie opposite to each other.
    pub pairs: usize,
    /// Faces without a partner, other than the ends of walls.
    pub unpaired_faces: usize,
    /// Smooth pieces of the mid-surface, a group each.
    pub patches: usize,
    /// Curves in which three and more faces meet.
    pub joints: usize,
    /// Independent cycles of the free edges.
    pub free_loops: usize,
    /// Connected parts.
    pub components: usize,
    /// Area in mm².
    pub area: f64,
    /// The thickness field.
    pub thickness: ThicknessRange,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// The whole command.
    pub seconds: f64,
    /// The file of the mid-surface.
    pub file: String,
    /// Triangles of the mid-surface.
    pub faces: usize,
    /// Triangles of the solid.
    pub solid_faces: usize,
    /// Millimetres in one unit of its coordinates.
    pub unit_mm: f64,
    /// Walls thicker than this were not looked for.
    pub max_thickness: f64,
    /// Share of the solid's skin that has a partner.
    pub paired_share: f64,
    /// Strips that join two middles where the thickness steps.
    pub steps: usize,
    /// Pairs of faces of the mid-surface that cross.
    pub self_intersections: usize,
    /// Area times thickness over the volume of the solid.
    pub volume_ratio: f64,
    /// The faces without a partner, the largest first.
    pub unpaired: Vec<NamedFace>,
    /// Walls that came to have no mid-surface.
    pub bare: Vec<NamedFace>,
    /// Borders that end inside the material.
    pub loose_ends: Option<LooseEnds>,
    /// Faces of the solid's skin with their geometry.
    pub skin: Vec<SkinFace>,
    /// Pairs of these that are as far from each other everywhere, and what lies halfway.
    pub walls: Vec<WallPair>,
}

/// Corners and fillets are counted twice or not at all; a volume that is off by more than this share tells of a fault.
const VOLUME_OFF: f64 = 0.08;
/// Faces without a partner named in warnings; JSON has all.
const NAMED: usize = 5;

impl DeflateFileReport {
    pub(super) fn new(solid_faces: usize, unit: f64, deflated: &Deflated) -> Self {
        let report = &deflated.report;
        let (removed, kept): (Vec<Feature>, Vec<Feature>) =
            report.features.iter().cloned().partition(|f| f.removed);
        Self {
            removed_features: removed,
            kept_features: kept,
            pairs: report.pairs,
            unpaired_faces: report.unpaired.len(),
            patches: report.patches,
            joints: report.joints,
            free_loops: report.free_loops,
            components: report.components,
            area: report.area,
            thickness: report.thickness,
            warnings: warnings(deflated),
            seconds: 0.0,
            file: String::new(),
            faces: deflated.sheet.faces.len(),
            solid_faces,
            unit_mm: unit,
            max_thickness: report.max_thickness,
            paired_share: report.paired_share,
            steps: report.steps,
            self_intersections: report.self_intersections,
            volume_ratio: volume_ratio(deflated),
            unpaired: report.unpaired.clone(),
            bare: report.bare.clone(),
            loose_ends: report.loose_ends,
            skin: report.faces.clone(),
            walls: report.wall_pairs.clone(),
        }
    }
}

/// Area times thickness over the volume of the solid.
fn volume_ratio(deflated: &Deflated) -> f64 {
    let report = &deflated.report;
    report.thickness.mean * report.area / report.solid_volume
}

fn warnings(deflated: &Deflated) -> Vec<String> {
    let report = &deflated.report;
    let mut warnings: Vec<String> = report
        .unpaired
        .iter()
        .take(NAMED)
        .map(|face| format!("{face} has no partner within {:.3} mm", report.max_thickness))
        .collect();
    if report.unpaired.len() > NAMED {
        warnings.push(format!("{} more faces have no partner", report.unpaired.len() - NAMED));
    }
    warnings.extend(
        report.bare.iter().take(NAMED).map(|face| format!("{face} is a wall but has no mid-surface")),
    );
    if report.bare.len() > NAMED {
        warnings.push(format!("{} more walls have no mid-surface", report.bare.len() - NAMED));
    }
    if let Some(LooseEnds { length, at }) = report.loose_ends {
        warnings.push(format!(
            "borders of {length:.1} mm end inside the material, as at ({:.2}, {:.2}, {:.2}): walls are not joined there",
            at.x, at.y, at.z
        ));
    }
    if report.steps > 0 {
        warnings.push(format!(
            "the thickness steps at {} places where the mid-planes do not meet; narrow strips join them (--steps says otherwise)",
            report.steps
        ));
    }
    if report.self_intersections > 0 {
        warnings.push(format!("{} pairs of faces of the mid-surface cross", report.self_intersections));
    }
    if report.lost_edges > 0 {
        warnings.push(format!(
            "{} edges of outlines cross others and were left out; look for gaps there",
            report.lost_edges
        ));
    }
    let ratio = volume_ratio(deflated);
    if (ratio - 1.0).abs() > VOLUME_OFF {
        let about = if ratio < 1.0 {
            "some walls are missing or much of it is not thin (see --max-thickness)"
        } else {
            "some walls are there twice or go on too far"
        };
        warnings.push(format!(
            "the mid-surface with its thickness has {:.0} % of the solid's volume: {about}",
            100.0 * ratio
        ));
    }
    if report.components > 1 {
        warnings.push(format!("the mid-surface is in {} parts that do not hang together", report.components));
    }
    warnings
}
