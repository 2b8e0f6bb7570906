//! Why a mesh file could not be read: always a typed error with a place in the file.

use std::fmt;
use std::path::PathBuf;

use super::Format;

/// A place in a mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Line of a text file, counted from 1.
    Line(usize),
    /// Offset into a binary file, counted from 0.
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// A mesh file that cannot be used, and why.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file could not be opened or read.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file name's extension names no mesh format.
    #[error("{}: not a mesh format; the extension must be obj, ply, stl, off, glb or gltf", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// The content is not of the format that the name promises.
    #[error("this is no {format} file: {reason}")]
    WrongMagic {
        /// The format that was expected.
        format: Format,
        /// What was missing.
        reason: String,
    },
    /// The file ends too early.
    #[error("the file is cut off at {place}: {expected}")]
    Truncated {
        /// Where it ends.
        place: Place,
        /// What should have followed.
        expected: String,
    },
    /// Something that cannot be understood.
    #[error("{place}: {reason}")]
    Malformed {
        /// Where.
        place: Place,
        /// What is wrong.
        reason: String,
    },
    /// A number that is no number.
    #[error("{place}: '{text}' is not a number")]
    BadNumber {
        /// Where.
        place: Place,
        /// The text in question, shortened.
        text: String,
    },
    /// A coordinate is NaN or infinite.
    #[error("{place}: a coordinate is not finite (NaN or infinity)")]
    NotFinite {
        /// Where.
        place: Place,
    },
    /// A coordinate is larger than that of any model.
    #[error(
        "{place}: a coordinate is beyond ±{limit:e}; mend it, or write the file in a larger unit",
        limit = crate::MAX_COORDINATE
    )]
    TooFar {
        /// Where.
        place: Place,
    },
    /// A face refers to a vertex that does not exist.
    #[error("{place}: vertex {index} does not exist, the file has {count} (indices count from {first})")]
    IndexOutOfRange {
        /// Where.
        place: Place,
        /// The index as the file writes it.
        index: i64,
        /// Number of vertices.
        count: usize,
        /// What the format calls the first vertex.
        first: u32,
    },
    /// A face with fewer than three corners.
    #[error("{place}: a face with {corners} corners; a face needs three")]
    TooFewCorners {
        /// Where.
        place: Place,
        /// Corners found.
        corners: usize,
    },
    /// A header promises more than the file can hold.
    #[error("{place}: {count} {what} are announced, but only {room} bytes follow")]
    CountTooLarge {
        /// Where.
        place: Place,
        /// What is counted.
        what: String,
        /// The announced number.
        count: u64,
        /// Bytes left in the file.
        room: usize,
    },
    /// More elements than a mesh can hold.
    #[error("too many {what}: at most {limit} are supported")]
    TooMany {
        /// What.
        what: &'static str,
        /// The limit.
        limit: usize,
    },
    /// A part of the format that is not supported.
    #[error("{what} is not supported; save the mesh without it")]
    Unsupported {
        /// The part.
        what: String,
    },
    /// A file without a single face.
    #[error("the file has {vertices} vertices but no faces; a surface mesh is needed, not points or lines")]
    NoFaces {
        /// Number of vertices.
        vertices: usize,
    },
}

/// What is wrong with numbers that are no coordinates.
#[cold]
pub(super) fn bad_coordinates(place: Place, numbers: &[f64]) -> ReadError {
    if numbers.iter().all(|x| x.is_finite()) {
        ReadError::TooFar { place }
    } else {
        ReadError::NotFinite { place }
    }
}

/// At most 40 characters of `bytes` from `from` to the next blank, for messages.
pub(super) fn excerpt(bytes: &[u8], from: usize) -> String {
    let rest = &bytes[from.min(bytes.len())..];
    let end = rest.iter().position(|b| b.is_ascii_whitespace()).unwrap_or(rest.len());
    let text: String = String::from_utf8_lossy(&rest[..end.min(160)])
        .chars()
        .map(|c| if c.is_control() { '?' } else { c })
        .take(40)
        .collect();
    text
}

/// At most 100 characters of a text from the file, for messages.
pub(super) fn shortened(text: &str) -> String {
    let mut out: String = text.chars().take(100).map(|c| if c.is_control() { '?' } else { c }).collect();
    if out.len() < text.len() {
        out.push('…');
    }
    out
}
