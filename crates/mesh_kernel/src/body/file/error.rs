//! Why a body was not read or not written.

use glam::DVec3;

use crate::body::edit::Operation;
use crate::body::{Body, Defect, NodeId, SurfaceId};

/// Why a body or a journal was not read or not written.
#[derive(Debug, thiserror::Error)]
pub enum BodyFileError {
    /// Not of this format.
    #[error(
        "this is no {expected} file: its \"format\" is {}",
        found.as_ref().map_or("missing".to_owned(), |f| format!("\"{f}\""))
    )]
    Format {
        /// The format that was expected.
        expected: &'static str,
        /// The format that the file names.
        found: Option<String>,
    },
    /// Of a version that this program does not know.
    #[error(
        "the file has format version {}; this program reads version {known}: take a newer program",
        found.map_or("none".to_owned(), |v| v.to_string())
    )]
    Version {
        /// The version in the file.
        found: Option<u64>,
        /// The version of this program.
        known: u32,
    },
    /// The file ends too early.
    #[error("the file is cut off at line {line}, column {column}")]
    Truncated {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
    },
    /// No JSON, or not of the shape of a body.
    #[error("line {line}, column {column}: {reason}")]
    Malformed {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong.
        reason: String,
    },
    /// An array that has not one entry for every node.
    #[error("surface {surface}: {array} has {len} entries for {nodes} nodes")]
    Length {
        /// Surface.
        surface: SurfaceId,
        /// Which array.
        array: &'static str,
        /// Its length.
        len: usize,
        /// The surface's nodes.
        nodes: usize,
    },
    /// More entities than ids can name.
    #[error("surface {surface} has {count} {what}; at most {limit} can be named")]
    TooMany {
        /// Surface.
        surface: SurfaceId,
        /// Of what.
        what: &'static str,
        /// How many.
        count: usize,
        /// Most.
        limit: usize,
    },
    /// A number that names nothing.
    #[error("{of} names {what} {id}, which is free or not below {limit}")]
    UnknownId {
        /// Who names it.
        of: String,
        /// What it should be.
        what: &'static str,
        /// The number.
        id: u32,
        /// How many there are.
        limit: usize,
    },
    /// A coordinate or parameter is NaN or infinite, which the file cannot hold.
    #[error("surface {surface}: the {layer} position {position} of node {node} is not finite")]
    NotFinite {
        /// Surface.
        surface: SurfaceId,
        /// Node.
        node: NodeId,
        /// Which of its positions: spatial, backup or planar.
        layer: &'static str,
        /// The position.
        position: DVec3,
    },
    /// A number of an operation is NaN or infinite, which the file cannot hold.
    #[error("operation {number} of the journal holds a number that is not finite")]
    OperationNotFinite {
        /// Its place, from 0.
        number: usize,
    },
    /// A body whose incidence, chains, loops, joints or attributes contradict each other.
    #[error("the body is not sound, {count} defects: {}{}", words(first), if *count > first.len() { "; …" } else { "" })]
    Unsound {
        /// How many defects there are.
        count: usize,
        /// The first of them.
        first: Vec<Defect>,
    },
}

/// How many defects a message names.
const NAMED: usize = 3;

fn words(defects: &[Defect]) -> String {
    defects.iter().map(|d| shortened(&d.to_string())).collect::<Vec<_>>().join("; ")
}

/// What `serde_json` found wrong with `bytes`, in our words.
pub(super) fn of_json(error: &serde_json::Error, bytes: &[u8]) -> BodyFileError {
    let (line, column) = (error.line(), error.column());
    // A number cut off after its sign is bad syntax at the very end.
    let last = bytes.iter().rev().take_while(|b| **b != b'\n').count();
    let lines = bytes.iter().filter(|b| **b == b'\n').count() + 1;
    if error.is_eof() || error.is_syntax() && line == lines && column >= last {
        return BodyFileError::Truncated { line, column };
    }
    // The place comes first in our words.
    let text = error.to_string();
    let reason = text.rsplit_once(" at line ").map_or(text.as_str(), |(reason, _)| reason);
    BodyFileError::Malformed { line, column, reason: shortened(reason) }
}

/// At most 200 characters of a text from the file.
pub(super) fn shortened(text: &str) -> String {
    let mut out: String = text.chars().take(200).map(|c| if c.is_control() { '?' } else { c }).collect();
    if out.len() < text.len() {
        out.push('…');
    }
    out
}

/// Every coordinate is finite, those under free numbers too.
pub(super) fn check_finite(body: &Body) -> Result<(), BodyFileError> {
    for (surface, s) in body.surfaces() {
        let rule = |(node, layer, position): (usize, &'static str, DVec3)| {
            if position.is_finite() {
                return Ok(());
            }
            Err(BodyFileError::NotFinite { surface, node: NodeId(node as u32), layer, position })
        };
        s.positions.iter().enumerate().try_for_each(|(v, &p)| rule((v, "spatial", p)))?;
        s.backup.iter().enumerate().try_for_each(|(v, &p)| rule((v, "backup", p)))?;
        s.planar.iter().enumerate().try_for_each(|(v, &p)| rule((v, "planar", p.extend(0.0))))?;
    }
    Ok(())
}

/// Whether the text of an operation is read as the operation again. JSON has no word for numbers that are not finite;
/// they become `null`.
pub(crate) fn check_finite_operation(
    number: usize,
    operation: &Operation,
    text: &[u8],
) -> Result<(), BodyFileError> {
    let suspect = text.windows(4).any(|word| word == b"null");
    if suspect && serde_json::from_slice::<Operation>(text).ok().as_ref() != Some(operation) {
        return Err(BodyFileError::OperationNotFinite { number });
    }
    Ok(())
}

/// The topology is sound.
pub(super) fn check_sound(body: &Body) -> Result<(), BodyFileError> {
    let defects = body.check_topology();
    let count = defects.len();
    let mut first: Vec<Defect> = defects.into_iter().take(NAMED).collect();
    match first.first_mut() {
        None => Ok(()),
        Some(Defect::UnknownId { of, what, id, limit }) => {
            Err(BodyFileError::UnknownId { of: std::mem::take(of), what, id: *id, limit: *limit })
        }
        Some(_) => Err(BodyFileError::Unsound { count, first }),
    }
}
