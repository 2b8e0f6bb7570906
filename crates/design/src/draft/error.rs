//! Why an edit is refused or a file is not opened.

use template::TemplateError;

/// An edit that does not fit the draft; nothing was changed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EditError {
    /// There is no such thing.
    #[error("there is no {kind} `{name}`")]
    Missing {
        /// What it should be.
        kind: &'static str,
        /// Its name.
        name: String,
    },
    /// The name is taken.
    #[error("there is a {kind} `{name}` already; choose another name")]
    Taken {
        /// What it is.
        kind: &'static str,
        /// Its name.
        name: String,
    },
    /// Something else needs it.
    #[error("the {kind} `{name}` is used by {by}; delete that first")]
    Used {
        /// What it is.
        kind: &'static str,
        /// Its name.
        name: String,
        /// What uses it.
        by: String,
    },
    /// The edge is there already, or both ends are one node.
    #[error("an edge from `{from}` to `{to}`: {why}")]
    Edge {
        /// First end.
        from: String,
        /// Second end.
        to: String,
        /// Why not.
        why: &'static str,
    },
    /// A face that cannot be.
    #[error("a face of {nodes}: {why}")]
    Face {
        /// Its nodes.
        nodes: String,
        /// Why not and what to do.
        why: String,
    },
    /// A joint over edges that another one holds.
    #[error("joint {} ({name}) holds these edges already: {why}", .joint + 1)]
    Held {
        /// The other one's number, from 0.
        joint: usize,
        /// Its name for people.
        name: String,
        /// Why the new one is not cut out of it.
        why: String,
    },
    /// A value that cannot be.
    #[error("{what}: {why}")]
    Value {
        /// Which.
        what: String,
        /// Why not.
        why: String,
    },
    /// What would come of it is no template.
    #[error(transparent)]
    Template(#[from] TemplateError),
}

/// A file that is not opened.
#[derive(Debug, thiserror::Error)]
pub enum DraftFileError {
    /// No file of this kind, or cut off.
    #[error("this is no design of toile, or it is cut off: {0}")]
    Format(String),
    /// Written by a newer program.
    #[error(
        "the design has format version {found}; this program reads up to {known}: update toile to open it"
    )]
    Newer {
        /// The version in the file.
        found: u64,
        /// What this program reads.
        known: u32,
    },
    /// The content contradicts itself.
    #[error(transparent)]
    Content(#[from] EditError),
    /// A design of `regenerate`.
    #[error(transparent)]
    Document(#[from] crate::document::DocumentError),
    /// A template, which a file of another kind may hold.
    #[error(transparent)]
    Template(#[from] TemplateError),
}
