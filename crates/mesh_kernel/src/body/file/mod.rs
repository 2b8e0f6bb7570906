//! The native file of a body: everything that it holds, incomplete topology, joints, attributes, free numbers and all,
//! so that the body that is read is the body that was written, bit for bit. `docs/body-file.md` describes the format.
//!
//! What the file says it says once: which faces an edge has, which chain it lies on, which loop and joint a chain belongs
//! to follow from faces, chains, loops and joints, and cannot contradict them.

mod error;
mod record;
#[cfg(test)]
mod tests;
mod write;

use serde::Deserialize;

use super::Body;
pub use error::BodyFileError;
pub(crate) use error::check_finite_operation;
pub(crate) use record::BodyRecord;
pub(crate) use write::write_body;

/// The word that a body file begins with.
const FORMAT: &str = "toile-body";

/// Version of the format that this program writes and reads.
pub const BODY_FILE_VERSION: u32 = 1;

/// What the name of a body's file ends in.
pub const BODY_FILE_EXTENSION: &str = ".body.json";

impl Body {
    /// The bytes of a file that holds the body; the same body gives the same bytes. [`crate::files::write_atomically`]
    /// puts them in place. O(size).
    ///
    /// # Errors
    /// A body that could not be read again is not written: [`BodyFileError::NotFinite`], [`BodyFileError::Unsound`].
    pub fn to_file_bytes(&self) -> Result<Vec<u8>, BodyFileError> {
        check_writable(self)?;
        let mut out = Vec::new();
        write_body(self, &mut out);
        out.push(b'\n');
        Ok(out)
    }

    /// Reads a body. Its topology is sound then; what its geometry is worth, [`Body::check`] tells. O(size · log size),
    /// in memory proportional to the size of `bytes`.
    ///
    /// # Errors
    /// [`BodyFileError`]: no body file, of a newer version, cut off, damaged, or of a body whose topology is not sound.
    pub fn from_file_bytes(bytes: &[u8]) -> Result<Self, BodyFileError> {
        check_head(bytes, FORMAT, BODY_FILE_VERSION)?;
        from_json::<BodyRecord>(bytes)?.into_body()
    }
}

/// Whether a body that is written can be read again.
pub(crate) fn check_writable(body: &Body) -> Result<(), BodyFileError> {
    error::check_finite(body)?;
    error::check_sound(body)
}

/// Reads JSON.
pub(crate) fn from_json<'a, T: Deserialize<'a>>(bytes: &'a [u8]) -> Result<T, BodyFileError> {
    serde_json::from_slice(bytes).map_err(|error| error::of_json(&error, bytes))
}

/// Whether `bytes` are a file of this format and of a version that can be read.
pub(crate) fn check_head(bytes: &[u8], format: &'static str, known: u32) -> Result<(), BodyFileError> {
    #[derive(Deserialize)]
    struct Head {
        format: Option<String>,
        version: Option<u64>,
    }
    let head: Head = from_json(bytes)?;
    check_format(head.format.as_deref(), head.version, format, known)
}

fn check_format(
    format: Option<&str>,
    version: Option<u64>,
    expected: &'static str,
    known: u32,
) -> Result<(), BodyFileError> {
    if format != Some(expected) {
        return Err(BodyFileError::Format { expected, found: format.map(error::shortened) });
    }
    match version {
        Some(version) if version == u64::from(known) => Ok(()),
        found => Err(BodyFileError::Version { found, known }),
    }
}
