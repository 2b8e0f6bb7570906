//! Deflation: the solid of a file becomes the mid-surface of a file, with its thickness.
//!
//! The work is [`mod@sheet::deflate`]'s; here are what lies between it and files: units, shell models for analysis, pictures,
//! the report.

mod elements;
mod inp;
mod report;
mod vtk;

use mesh_kernel::TriMesh;
use mesh_kernel::files::{Format, WriteOptions, to_bytes};
use mesh_kernel::glam::DVec3;
use sheet::deflate::{DeflateError, DeflateOptions, Watcher};
use viewer::View;

use crate::pictures::{ModelColor, ModelPicture, ModelPictureError, model_picture};
use crate::units::FileUnit;

pub use inp::{Element, InpOptions, Sections};
pub use report::DeflateFileReport;

/// What is wanted of a mid-surface.
#[derive(Clone, Debug, PartialEq)]
pub struct DeflateSettings {
    /// What is handed to the sheet room; lengths in millimetres.
    pub options: DeflateOptions,
    /// Millimetres in one unit of the solid's coordinates; `None`: metres for GLB, else millimetres.
    pub unit: Option<f64>,
    /// The format that the solid was read from.
    pub read_from: Option<Format>,
    /// The format of the sheet's file.
    pub format: Format,
    /// Whether and how a shell model is written for Abaqus and CalculiX.
    pub inp: Option<InpOptions>,
    /// Whether a VTK file is written.
    pub vtk: bool,
    /// Whether a picture is made.
    pub picture: bool,
}

/// Why no mid-surface came of a solid.
#[derive(Debug, thiserror::Error)]
pub enum DeflateFileError {
    /// The solid could not be deflated.
    #[error(transparent)]
    Solid(#[from] DeflateError),
    /// Nothing is left of the solid.
    #[error("no mid-surface is left of the solid: none of its walls has an opposite one")]
    Nothing,
    /// A feature that is to be kept and is none.
    #[error("there is no feature {number} to keep: the solid has {features} small ones, counted from 1")]
    NoSuchFeature {
        /// Its number, from 1.
        number: usize,
        /// How many there are.
        features: usize,
    },
    /// The edge length asks for more triangles than are made.
    #[error(
        "edges of {edge_length} mm would make some {triangles:.1e} triangles of this solid, and more than {most:.0e} are not \
         made; give edges of {shortest} mm or more",
        most = MOST_TRIANGLES
    )]
    TooFine {
        /// As asked, in millimetres.
        edge_length: f64,
        /// About how many triangles it asks for.
        triangles: f64,
        /// About the shortest that can be had, in millimetres.
        shortest: f64,
    },
    /// The picture could not be made.
    #[error("the picture: {0}")]
    Picture(#[from] ModelPictureError),
}

/// Most triangles that a mid-surface is meshed with.
const MOST_TRIANGLES: f64 = 8e6;

/// A mid-surface, ready to be written.
#[derive(Clone, Debug)]
pub struct DeflatedFile {
    /// All bytes of the sheet's file.
    pub sheet: Vec<u8>,
    /// A JSON list of thicknesses in millimetres, one a triangle.
    pub thickness: Vec<u8>,
    /// The shell model.
    pub inp: Option<Vec<u8>>,
    /// The VTK file.
    pub vtk: Option<Vec<u8>>,
    /// The picture (PNG), coloured by thickness.
    pub picture: Option<Vec<u8>>,
    /// What it holds; `file` and `seconds` are the caller's to fill.
    pub report: DeflateFileReport,
}

/// Makes the mid-surface of a solid whose coordinates are a file's, unit and all. The sheet has the solid's unit (GLB: metres,
/// by its standard), shell models and VTK files are in millimetres.
///
/// # Errors
/// [`DeflateFileError`].
pub fn deflate(
    solid: &TriMesh,
    settings: &DeflateSettings,
    watcher: &dyn Watcher,
) -> Result<DeflatedFile, DeflateFileError> {
    let unit = FileUnit::of_format(settings.unit, settings.read_from).millimetres;
    let mut scaled = TriMesh::new(solid.positions.clone(), solid.faces.clone());
    scaled.positions.iter_mut().for_each(|p| *p *= unit);
    if let Some(edge_length) = settings.options.edge_length {
        check_length(&scaled, edge_length)?;
    }
    let deflated = sheet::deflate::deflate(&scaled, &settings.options, watcher)?;
    let features = deflated.report.features.len();
    if let Some(feature) = settings.options.keep.iter().find(|k| **k >= features) {
        return Err(DeflateFileError::NoSuchFeature { number: feature + 1, features });
    }
    if deflated.sheet.faces.is_empty() {
        return Err(DeflateFileError::Nothing);
    }
    let mut in_file = deflated.sheet.clone();
    in_file.positions.iter_mut().for_each(|p| *p /= unit);
    let write = WriteOptions { glb_scale: unit * 1e-3, ..WriteOptions::default() };
    let inp = settings.inp.as_ref().map(|o| inp::to_bytes(&deflated.sheet, &deflated.thickness, o));
    let picture = settings.picture.then(|| picture(&deflated.sheet, &deflated.thickness)).transpose()?;
    Ok(DeflatedFile {
        sheet: to_bytes(settings.format, &in_file, &write),
        thickness: thickness_list(&deflated.thickness),
        inp,
        vtk: settings.vtk.then(|| vtk::to_bytes(&deflated.sheet, &deflated.thickness)),
        picture,
        report: DeflateFileReport::new(solid.faces.len(), unit, &deflated),
    })
}

/// Whether a mid-surface, which has half the area of the solid's skin, can be meshed with edges of that length.
fn check_length(solid: &TriMesh, edge_length: f64) -> Result<(), DeflateFileError> {
    /// Area of a triangle over the square of its edges' length.
    const EVEN: f64 = 0.433;
    let place = |v: u32| solid.positions.get(v as usize).copied().unwrap_or_default();
    let area = |[a, b, c]: [DVec3; 3]| 0.5 * (b - a).cross(c - a).length();
    let skin: f64 = solid.faces.iter().map(|f| area(f.map(place))).sum();
    let triangles = 0.5 * skin / (EVEN * edge_length * edge_length);
    if triangles > MOST_TRIANGLES {
        // Two digits, a little more than the limit: a length that people type.
        let least = 1.05 * edge_length * (triangles / MOST_TRIANGLES).sqrt();
        let shortest = format!("{least:.1e}").parse().unwrap_or(least);
        return Err(DeflateFileError::TooFine { edge_length, triangles, shortest });
    }
    Ok(())
}

/// One number a line, so that lists can be compared.
fn thickness_list(thickness: &[f64]) -> Vec<u8> {
    let lines: Vec<String> = thickness.iter().map(f64::to_string).collect();
    format!("[\n{}\n]\n", lines.join(",\n")).into_bytes()
}

/// Pixels on a side of the picture.
const PICTURE: u32 = 1024;

fn picture(sheet: &TriMesh, thickness: &[f64]) -> Result<Vec<u8>, DeflateFileError> {
    let image = model_picture(&ModelPicture {
        model: sheet,
        body: None,
        unit: 1.0,
        color: ModelColor::Thickness(thickness.to_vec()),
        view: View::Iso,
        width: PICTURE,
        height: PICTURE,
    })?;
    Ok(image.to_png())
}
