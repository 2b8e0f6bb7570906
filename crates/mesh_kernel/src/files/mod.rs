//! Mesh files in and out: OBJ, PLY, STL, OFF and GLB (glTF).
//!
//! Coordinates come in exactly as the file holds them, whatever its unit; polygons are cut into triangles as fans.
//! Every reader checks what it reads: a damaged file is a [`ReadError`] with the place, never a panic, and no memory is
//! reserved on the word of a header. Writers make the whole file in memory; [`write_atomically`] puts it in place, and
//! [`FileSet`] several together.
//!
//! ```
//! use mesh_kernel::files::{Format, WriteOptions, parse, to_bytes};
//!
//! let mesh = parse(Format::Obj, b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")?;
//! let bytes = to_bytes(Format::Ply, &mesh, &WriteOptions::default());
//! assert_eq!(parse(Format::Ply, &bytes)?, mesh);
//!
//! let error = parse(Format::Obj, b"v 0 0 0\nf 1 2 3\n").unwrap_err();
//! assert_eq!(error.to_string(), "line 2: vertex 3 does not exist, the file has 1 (indices count from 1)");
//! # Ok::<(), mesh_kernel::files::ReadError>(())
//! ```

mod error;
mod glb;
mod gltf;
mod number;
mod obj;
mod off;
mod place;
mod ply;
mod stl;
pub(crate) mod weld;

use std::fmt;
use std::path::Path;

use crate::{MAX_COORDINATE, TriMesh};
use glam::DVec3;

pub use error::{Place, ReadError};
pub use place::{FileSet, NotPlaced, write_atomically};

/// Most vertices, and most triangles, that a file may unfold to; beyond it 32-bit indices and memory end.
pub const MAX_ELEMENTS: usize = 1 << 26;

/// A mesh file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Wavefront OBJ, text.
    Obj,
    /// Stanford PLY, text or binary of either byte order.
    Ply,
    /// Stereolithography, text or binary.
    Stl,
    /// Geomview OFF, text.
    Off,
    /// glTF 2.0, binary container; JSON (`.gltf`) is read too.
    Glb,
}

impl Format {
    /// The format that the extension of `path` names, whatever the case.
    pub fn of_path(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "stl" => Some(Self::Stl),
            "off" => Some(Self::Off),
            "glb" | "gltf" => Some(Self::Glb),
            _ => None,
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Stl => "STL",
            Self::Off => "OFF",
            Self::Glb => "glTF",
        })
    }
}

/// A named polyline that goes into a file beside the triangles (OBJ `l`, GLB line strip); other formats leave it out.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyline {
    /// Its name, a group of its own.
    pub name: String,
    /// Its points, in the unit of the mesh.
    pub points: Vec<DVec3>,
}

/// How the bytes of PLY and STL are laid down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// Little-endian binary.
    #[default]
    Binary,
    /// Text.
    Ascii,
}

/// What goes into a file beside the mesh, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct WriteOptions {
    /// Decimal places in text files; `None` writes the shortest text that reads back exactly.
    pub decimals: Option<u8>,
    /// Byte layout of PLY and STL.
    pub encoding: Encoding,
    /// Lines of comment at the head of OBJ, PLY and OFF files.
    pub comments: Vec<String>,
    /// Polylines that lie beside the mesh.
    pub polylines: Vec<Polyline>,
    /// What coordinates are multiplied with in GLB files, which are in metres by their standard.
    pub glb_scale: f64,
}

impl Default for WriteOptions {
    fn default() -> Self {
        Self {
            decimals: None,
            encoding: Encoding::Binary,
            comments: vec![],
            polylines: vec![],
            glb_scale: 1e-3,
        }
    }
}

/// Reads a mesh file; the extension names the format. Coordinates are exactly as in the file, whatever the unit.
///
/// # Errors
/// [`ReadError`]: what is wrong with the file and where.
pub fn read(path: &Path) -> Result<TriMesh, ReadError> {
    let format = Format::of_path(path).ok_or_else(|| ReadError::UnknownFormat { path: path.to_owned() })?;
    let bytes = std::fs::read(path).map_err(|source| ReadError::Io { path: path.to_owned(), source })?;
    parse(format, &bytes)
}

/// Reads a mesh from the bytes of a file. O(bytes), apart from welding STL corners (a hash look-up each).
///
/// # Errors
/// [`ReadError`]: what is wrong with the bytes and where.
pub fn parse(format: Format, bytes: &[u8]) -> Result<TriMesh, ReadError> {
    let mesh = match format {
        Format::Obj => obj::parse(bytes),
        Format::Ply => ply::parse(bytes),
        Format::Stl => stl::parse(bytes),
        Format::Off => off::parse(bytes),
        Format::Glb => glb::parse(bytes),
    }?;
    if mesh.faces.is_empty() {
        return Err(ReadError::NoFaces { vertices: mesh.positions.len() });
    }
    Ok(mesh)
}

/// The bytes of a file that holds `mesh`. Same mesh and options, same bytes.
pub fn to_bytes(format: Format, mesh: &TriMesh, options: &WriteOptions) -> Vec<u8> {
    match format {
        Format::Obj => obj::to_bytes(mesh, options),
        Format::Ply => ply::to_bytes(mesh, options),
        Format::Stl => stl::to_bytes(mesh, options),
        Format::Off => off::to_bytes(mesh, options),
        Format::Glb => glb::to_bytes(mesh, options),
    }
}

/// Whether all numbers may be coordinates; none of those that are not finite is.
#[inline]
fn are_coordinates(numbers: &[f64]) -> bool {
    numbers.iter().all(|x| x.abs() <= MAX_COORDINATE)
}

/// Fails when a mesh would outgrow [`MAX_ELEMENTS`].
fn check_room(what: &'static str, count: usize) -> Result<(), ReadError> {
    if count > MAX_ELEMENTS { Err(ReadError::TooMany { what, limit: MAX_ELEMENTS }) } else { Ok(()) }
}
