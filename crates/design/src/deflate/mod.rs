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
use sheet::deflate::{DeflateError, DeflateOptions, Watcher};
use viewer::View;

use crate::pictures::{ModelColor, ModelPicture, ModelPictureError, model_picture};

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
    /// The picture could not be made.
    #[error("the picture: {0}")]
    Picture(#[from] ModelPictureError),
}

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
    let guessed = if settings.read_from == Some(Format::Glb) { 1000.0 } else { 1.0 };
    let unit = settings.unit.unwrap_or(guessed);
    let mut scaled = TriMesh::new(solid.positions.clone(), solid.faces.clone());
    scaled.positions.iter_mut().for_each(|p| *p *= unit);
    let deflated = sheet::deflate::deflate(&scaled, &settings.options, watcher)?;
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
