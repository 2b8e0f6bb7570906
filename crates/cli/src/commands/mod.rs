//! One file a command.

pub(crate) mod batch;
pub(crate) mod bends;
pub(crate) mod check;
pub(crate) mod deflate;
pub(crate) mod features;
pub(crate) mod flatten;
pub(crate) mod form;
#[cfg(test)]
mod fuzz;
pub(crate) mod info;
pub(crate) mod model;
pub(crate) mod regenerate;
pub(crate) mod render;
pub(crate) mod thicken;
pub(crate) mod unfold;
pub(crate) mod view;

use std::path::Path;

use design::units;
use mesh_kernel::TriMesh;
use mesh_kernel::body::{BODY_FILE_EXTENSION, Body};
use mesh_kernel::files::{self, Format};

use crate::failure::Failure;
use crate::words::Unit;

/// Reads a mesh; the message names the file.
fn read_mesh(path: &Path) -> Result<TriMesh, Failure> {
    files::read(path).map_err(|e| Failure::from(e).about(path))
}

/// Reads a body: a native body file, or a mesh whose groups are its surfaces. The message names the file.
fn read_body(path: &Path) -> Result<Body, Failure> {
    if !is_body_file(path) {
        return Body::from_tri_mesh(&read_mesh(path)?).map_err(|e| Failure::from(e).about(path));
    }
    let bytes =
        std::fs::read(path).map_err(|e| Failure::new(format!("cannot read {}: {e}", path.display())))?;
    Body::from_file_bytes(&bytes).map_err(|e| Failure::new(format!("{}: {e}", path.display())))
}

/// A native body is welded at its joints; of any other file the groups are the patches.
fn read_sheet(path: &Path) -> Result<TriMesh, Failure> {
    if !is_body_file(path) {
        // A script of modelling commands is a sheet too.
        return if extension(path) == "json" { script_sheet(path) } else { read_mesh(path) };
    }
    let mesh = read_body(path)?.to_tri_mesh();
    if mesh.faces.is_empty() { Err(Failure::new("the body has no faces").about(path)) } else { Ok(mesh) }
}

fn script_sheet(path: &Path) -> Result<TriMesh, Failure> {
    let mesh = model::run_script(path)?.mesh;
    if mesh.faces.is_empty() {
        return Err(Failure::new("the script makes no faces, only wires").about(path));
    }
    Ok(mesh)
}

/// Millimetres in one unit of a sheet: said, told by the format, or guessed from its size and thickness.
fn unit_of_sheet(said: Option<Unit>, path: &Path, sheet: &TriMesh, thickness: f64) -> f64 {
    match said {
        Some(unit) => unit.millimetres(),
        None if is_body_file(path) || extension(path) == "json" => 1.0,
        None if Format::of_path(path) == Some(Format::Glb) => 1000.0,
        None => units::guess_of_sheet(sheet, thickness),
    }
}

/// Whether the name is that of a native body file.
fn is_body_file(path: &Path) -> bool {
    file_name(path).to_ascii_lowercase().ends_with(BODY_FILE_EXTENSION)
}

/// Writes a file whole or not at all.
fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder)
            .map_err(|e| Failure::new(format!("cannot make the folder {}: {e}", folder.display())))?;
    }
    files::write_atomically(path, bytes)
        .map_err(|e| Failure::new(format!("cannot write {}: {e}", path.display())))
}

/// The extension in lower case.
fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

/// The file's name without its folder.
fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned())
}
