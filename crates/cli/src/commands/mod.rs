//! One file a command.

pub(crate) mod batch;
pub(crate) mod check;
pub(crate) mod features;
pub(crate) mod flatten;
pub(crate) mod form;
#[cfg(test)]
mod fuzz;
pub(crate) mod info;
pub(crate) mod regenerate;
pub(crate) mod render;

use std::path::Path;

use mesh_kernel::TriMesh;
use mesh_kernel::files;

use crate::failure::Failure;

/// Reads a mesh; the message names the file.
fn read_mesh(path: &Path) -> Result<TriMesh, Failure> {
    files::read(path).map_err(|e| Failure::from(e).about(path))
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
