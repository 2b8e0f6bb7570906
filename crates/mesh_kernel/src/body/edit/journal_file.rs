//! A journal on disk: a body and the operations that were carried out on it, to be looked at, sent and carried out again.

use serde::{Deserialize, Serialize};

use super::Editor;
use super::operation::{Operation, Refusal};
use crate::body::Body;
use crate::body::file::{
    BodyFileError, BodyRecord, check_finite_operation, check_head, check_writable, from_json, write_body,
};

/// The word that a journal's file begins with.
const FORMAT: &str = "toile-journal";

/// Version of the format that this program writes and reads.
pub const JOURNAL_FILE_VERSION: u32 = 1;

/// A body and what was done to it.
///
/// ```
/// use mesh_kernel::body::edit::{Editor, JournalFile};
/// use mesh_kernel::body::Body;
/// use mesh_kernel::glam::DVec3;
///
/// let mut editor = Editor::new(Body::default());
/// let surface = editor.add_surface("sketch");
/// let node = editor.make_vertex_complex(surface, DVec3::ZERO)?;
/// editor.make_vertex_edge(surface, node, DVec3::X * 40.0)?;
///
/// let bytes = JournalFile::of(&editor).to_bytes()?;
/// let again = JournalFile::from_bytes(&bytes)?.replay()?;
/// assert_eq!(again.body(), editor.body());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct JournalFile {
    /// The body at the beginning.
    pub start: Body,
    /// What was done, oldest first.
    pub operations: Vec<Operation>,
}

/// An operation that was refused when a journal was carried out again.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("operation {number} of the journal was refused: {refusal}")]
pub struct ReplayError {
    /// Its place, from 0.
    pub number: usize,
    /// The operation.
    pub operation: Box<Operation>,
    /// Why.
    pub refusal: Box<Refusal>,
}

impl JournalFile {
    /// What an editor did since it was made, without what was undone. O(body + operations).
    pub fn of(editor: &Editor) -> Self {
        let operations = editor.operations();
        let mut begin = editor.clone();
        while begin.undo() {}
        Self { start: begin.into_body(), operations }
    }

    /// The bytes of the file; the same journal gives the same bytes. `docs/body-file.md` describes the format.
    ///
    /// # Errors
    /// As [`Body::to_file_bytes`]; numbers in operations that are not finite.
    pub fn to_bytes(&self) -> Result<Vec<u8>, BodyFileError> {
        check_writable(&self.start)?;
        let mut out = format!("{{\"format\":\"{FORMAT}\",\n\"version\":{JOURNAL_FILE_VERSION},\n\"body\":")
            .into_bytes();
        write_body(&self.start, &mut out);
        out.extend_from_slice(b",\n\"operations\":[");
        for (number, operation) in self.operations.iter().enumerate() {
            out.extend_from_slice(if number == 0 { b"\n" } else { b",\n" });
            let begin = out.len();
            operation_text(operation, &mut out);
            check_finite_operation(number, operation, &out[begin..])?;
        }
        out.extend_from_slice(b"]}\n");
        Ok(out)
    }

    /// Reads a journal, in memory proportional to its size. Whether its operations can be carried out, only
    /// [`JournalFile::replay`] tells.
    ///
    /// # Errors
    /// As [`Body::from_file_bytes`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, BodyFileError> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Record {
            #[serde(rename = "format")]
            _format: String,
            #[serde(rename = "version")]
            _version: u32,
            body: BodyRecord,
            operations: Vec<Operation>,
        }
        check_head(bytes, FORMAT, JOURNAL_FILE_VERSION)?;
        let record: Record = from_json(bytes)?;
        Ok(Self { start: record.body.into_body()?, operations: record.operations })
    }

    /// Carries the operations out on the body of the beginning. The editor that comes of it can undo them.
    ///
    /// # Errors
    /// The first operation that is refused. Operators are deterministic, so that a journal that an editor wrote has none.
    pub fn replay(&self) -> Result<Editor, ReplayError> {
        let mut editor = Editor::new(self.start.clone());
        for (number, operation) in self.operations.iter().enumerate() {
            editor.apply(operation).map_err(|refusal| {
                let operation = Box::new(operation.clone());
                ReplayError { number, operation, refusal: Box::new(refusal) }
            })?;
        }
        Ok(editor)
    }
}

fn operation_text(operation: &impl Serialize, out: &mut Vec<u8>) {
    // Memory takes every byte, and there are no maps with strange keys.
    let written = serde_json::to_writer(out, operation);
    debug_assert!(written.is_ok());
}
