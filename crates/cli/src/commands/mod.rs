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

use design::units::FileUnit;
use mesh_kernel::body::{BODY_FILE_EXTENSION, Body};
use mesh_kernel::files::{self, FileSet, Format};
use mesh_kernel::glam::DVec3;
use mesh_kernel::{MAX_COORDINATE, TriMesh};
use reference::human::HumanError;

use crate::failure::Failure;
use crate::words::Unit;

/// Reads a mesh; the message names the file.
fn read_mesh(path: &Path) -> Result<TriMesh, Failure> {
    files::read(path).map_err(|e| Failure::from(e).about(path))
}

/// Why a mesh is no body to be measured, and what can be done.
fn body_refusal(error: HumanError, path: &Path) -> Failure {
    let remedy = match &error {
        HumanError::Height { height } if (500.0..2500.0).contains(&(height * Unit::Inch.millimetres())) => {
            Some("--unit inch takes it for one in inches")
        }
        _ => None,
    };
    let failure = Failure::from(error).about(path);
    match remedy {
        Some(remedy) => failure.remedy(remedy),
        None => failure,
    }
}

/// Reads a body: a native body file, or a mesh whose groups are its surfaces. The message names the file.
fn read_body(path: &Path) -> Result<Body, Failure> {
    if !is_body_file(path) {
        return Body::from_tri_mesh(&read_mesh(path)?).map_err(|e| Failure::from(e).about(path));
    }
    let bytes =
        std::fs::read(path).map_err(|e| Failure::new(format!("cannot read {}: {e}", path.display())))?;
    let body = Body::from_file_bytes(&bytes).map_err(|e| Failure::new(format!("{}: {e}", path.display())))?;
    let is_far = |p: &DVec3| p.abs().max_element() > MAX_COORDINATE;
    if let Some((_, s)) = body.surfaces().find(|(_, s)| s.positions().iter().any(is_far)) {
        let text = format!("surface `{}` has a coordinate beyond ±{MAX_COORDINATE:e}; mend it", s.name());
        return Err(Failure::new(text).about(path));
    }
    Ok(body)
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

/// Reads a text, without the byte-order mark that some editors put before it; `what` it is, for the message.
fn read_text(what: &str, path: &Path) -> Result<String, Failure> {
    let text = std::fs::read_to_string(path)
        .map_err(|e| Failure::new(format!("cannot read {what} {}: {e}", path.display())))?;
    Ok(text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text))
}

/// The unit of a sheet: said, told by the format, or guessed from its size and thickness.
fn unit_of_sheet(said: Option<Unit>, path: &Path, sheet: &TriMesh, thickness: f64) -> FileUnit {
    FileUnit::of_sheet(said.map(Unit::millimetres), mesh_format(path), sheet, thickness)
}

/// The format of a mesh file; `None` for a native body and a script, whose numbers are millimetres.
fn mesh_format(path: &Path) -> Option<Format> {
    if is_body_file(path) { None } else { Format::of_path(path) }
}

/// Whether the name is that of a native body file.
fn is_body_file(path: &Path) -> bool {
    file_name(path).to_ascii_lowercase().ends_with(BODY_FILE_EXTENSION)
}

/// Writes a file whole or not at all.
fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    write_together(&[(path, bytes)])
}

/// Writes files that belong together: all of them, or none when one cannot be written.
fn write_together(files: &[(&Path, &[u8])]) -> Result<(), Failure> {
    let mut set = FileSet::default();
    for (path, bytes) in files {
        if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder)
                .map_err(|e| Failure::new(format!("cannot make the folder {}: {e}", folder.display())))?;
        }
        set.add(path, bytes)?;
    }
    Ok(set.place()?)
}

/// The extension in lower case.
fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

/// The file's name without its folder.
fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned())
}
