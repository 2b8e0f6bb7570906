//! What `regenerate` reports: the keys of `report.json`, fixed for scripts.
//!
//! Lengths are millimetres, areas mm², angles degrees, times seconds.

use std::collections::BTreeMap;

use pattern::Pattern;
use reference::human::HumanBody;
use serde::Serialize;
use template::{Garment, Template};

/// The whole report of one regeneration.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Version of the program.
    pub toile: String,
    /// Name of the template.
    pub template: String,
    /// The body as it was understood.
    pub body: BodyReport,
    /// Every surface of the garment.
    pub surfaces: Vec<SurfaceReport>,
    /// Every joint of the garment.
    pub joints: Vec<JointReport>,
    /// How the garment keeps off the body.
    pub collision: CollisionReport,
    /// Garment girth less body girth on the same plane, by girth.
    pub ease: BTreeMap<String, f64>,
    /// The ease that the template asks for, by girth.
    pub ease_wanted: BTreeMap<String, f64>,
    /// Every flat piece.
    pub pieces: Vec<PieceReport>,
    /// Every seam between pieces.
    pub seams: Vec<SeamReport>,
    /// What could not be met or had to be guessed, in words.
    pub warnings: Vec<String>,
    /// Of template, body and settings, in a batch: the same fingerprint, the same results.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fingerprint: Option<String>,
    /// Where the time went.
    pub seconds: Seconds,
}

/// The body that the garment was built on.
#[derive(Clone, Debug, Serialize)]
pub struct BodyReport {
    /// File name as given.
    pub file: String,
    /// Stature.
    pub height: f64,
    /// Unit that the file is in, told from the body's height: `m`, `cm` or `mm`.
    pub units_guessed: String,
    /// Tape girths by feature curve.
    pub girths: BTreeMap<String, f64>,
}

/// Size of one surface.
#[derive(Clone, Debug, Serialize)]
pub struct SurfaceReport {
    /// Name in the template.
    pub name: String,
    /// Nodes, those on joints included.
    pub nodes: usize,
    /// Triangles.
    pub faces: usize,
    /// Area in space.
    pub area: f64,
}

/// One joint of the garment.
#[derive(Clone, Debug, Serialize)]
pub struct JointReport {
    /// Name, made of its surfaces when the template gives none.
    pub name: String,
    /// Surfaces in radial order.
    pub surfaces: Vec<String>,
    /// Length in space.
    pub length: f64,
}

/// Distance between garment and body.
#[derive(Clone, Debug, Serialize)]
pub struct CollisionReport {
    /// Garment nodes inside the body.
    pub nodes_inside: usize,
    /// Garment triangles that cross the body.
    pub faces_crossing: usize,
    /// Least distance of a garment node to the body.
    pub min_distance: f64,
}

/// One flat piece against its patch in space.
#[derive(Clone, Debug, Serialize)]
pub struct PieceReport {
    /// Name as printed.
    pub name: String,
    /// Area of the patch in space.
    pub area_3d: f64,
    /// Area of the sewn shape, without allowance.
    pub area_2d: f64,
    /// Area-weighted mean of |1 − stretch|, both directions of every triangle.
    pub mean_stretch: f64,
    /// Largest of them.
    pub max_stretch: f64,
    /// Triangles that came out face down.
    pub flipped: usize,
    /// Places where the piece lies on itself.
    pub overlaps: usize,
}

/// One seam: the lengths of what is sewn together.
#[derive(Clone, Debug, Serialize)]
pub struct SeamReport {
    /// Name of the joint.
    pub name: String,
    /// Length of each side on its flat piece.
    pub lengths_2d: Vec<f64>,
    /// Largest less smallest of them.
    pub mismatch: f64,
}

/// Wall-clock seconds by stage.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Seconds {
    /// Reading files.
    pub load: f64,
    /// Finding the features.
    pub features: f64,
    /// Building the surfaces.
    pub construct: f64,
    /// Flattening and pieces.
    pub flatten: f64,
    /// Making and writing files.
    pub export: f64,
    /// All of it.
    pub total: f64,
}

impl Report {
    /// Collects the figures; `seconds` are left zero.
    pub(crate) fn new(
        template: &Template,
        file: &str,
        body: &HumanBody,
        garment: &Garment,
        pattern: &Pattern,
    ) -> Self {
        let surfaces = garment.body.surfaces().map(|(_, s)| SurfaceReport {
            name: s.name().to_owned(),
            nodes: s.positions().len(),
            faces: s.faces().len(),
            area: s.area(),
        });
        let warnings = body.features.warnings.iter().chain(&garment.warnings).chain(&pattern.warnings);
        Self {
            toile: env!("CARGO_PKG_VERSION").to_owned(),
            template: template.file().name.clone(),
            body: BodyReport {
                file: file.to_owned(),
                height: body.features.height,
                units_guessed: body.unit.symbol().to_owned(),
                girths: body.girths.clone(),
            },
            surfaces: surfaces.collect(),
            joints: joints(garment),
            collision: CollisionReport {
                nodes_inside: garment.collision.nodes_inside,
                faces_crossing: garment.collision.faces_crossing,
                min_distance: garment.collision.min_distance,
            },
            ease: garment.ease.clone(),
            ease_wanted: garment.ease_wanted.clone(),
            pieces: pattern
                .pieces
                .iter()
                .map(|p| PieceReport {
                    name: p.name.clone(),
                    area_3d: p.report.area_3d,
                    area_2d: p.report.area_2d,
                    mean_stretch: p.report.mean_stretch,
                    max_stretch: p.report.max_stretch,
                    flipped: p.report.flipped,
                    overlaps: p.report.overlaps,
                })
                .collect(),
            seams: pattern
                .seams
                .iter()
                .map(|s| SeamReport {
                    name: s.name.clone(),
                    lengths_2d: s.lengths_2d.clone(),
                    mismatch: s.mismatch,
                })
                .collect(),
            warnings: warnings.cloned().collect(),
            fingerprint: None,
            seconds: Seconds::default(),
        }
    }
}

/// The joints with their surfaces in radial order and their length in space.
fn joints(garment: &Garment) -> Vec<JointReport> {
    let name = |surface: usize| garment.surfaces[surface].name.clone();
    garment
        .seams
        .iter()
        .map(|seam| JointReport {
            name: seam.name.clone(),
            surfaces: seam.sides.iter().map(|side| name(side.surface)).collect(),
            length: seam.length,
        })
        .collect()
}
