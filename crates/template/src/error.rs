//! What can go wrong between a template file and a garment.

/// A template that cannot be read or built, in the words of the person who wrote it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TemplateError {
    /// The text is not JSON or not a template.
    #[error("template: {}{message}", at(.path))]
    Format {
        /// Path of the value at fault, `nodes.left_waist.normal`; empty for the text as a whole.
        path: String,
        /// What is wrong there and what to do.
        message: String,
    },
    /// The file is of a version that this program does not know.
    #[error("template: version {found} is not known; this program reads version {known}")]
    Version {
        /// Version in the file.
        found: u32,
        /// Version of this program.
        known: u32,
    },
    /// The reference model lacks a feature that the template asks for.
    #[error("{path}: the body has no feature `{feature}`; it has {known}")]
    UnknownFeature {
        /// Where the template asks.
        path: String,
        /// Name asked for.
        feature: String,
        /// Names that there are.
        known: String,
    },
    /// Two feature curves do not meet.
    #[error(
        "{path}: the feature curves `{first}` and `{second}` do not cross on this body; choose others or a feature point"
    )]
    NoCrossing {
        /// Where the template asks.
        path: String,
        /// First curve.
        first: String,
        /// Second curve.
        second: String,
    },
    /// A frame whose directions lie in one plane cannot hold an offset.
    #[error(
        "{path}: the frame of `{feature}` is flat (its normal and tangents lie in one plane); use `axes` or other curves"
    )]
    FlatFrame {
        /// Where the template asks.
        path: String,
        /// The feature point.
        feature: String,
    },
    /// A patch that is no 2-manifold.
    #[error("surfaces.{surface}: {problem}")]
    BadSurface {
        /// Surface.
        surface: String,
        /// What is wrong and what to do.
        problem: String,
    },
    /// Joints that do not fit the surfaces.
    #[error("joints: {0}")]
    BadJoint(String),
    /// The kernel refused the complex.
    #[error("the template's surfaces do not make a valid body: {0}")]
    Kernel(String),
    /// The reference mesh or its features are unusable.
    #[error("the reference model is unusable: {0}")]
    BadReference(String),
    /// A linear system could not be solved to the accuracy that is asked.
    #[error("fairing {what}: {problem}")]
    Fairing {
        /// Which surfaces.
        what: String,
        /// What went wrong.
        problem: String,
    },
    /// There is no memory for so many faces.
    #[error(
        "level: {levels} splits make {faces} faces, which take some {:.1} GB of memory; there is less: use fewer splits",
        *bytes as f64 * 1e-9
    )]
    Memory {
        /// Splits asked for.
        levels: u8,
        /// Faces that they make.
        faces: usize,
        /// What they are estimated to take.
        bytes: usize,
    },
    /// The work was cancelled.
    #[error("cancelled")]
    Cancelled,
}

fn at(path: &str) -> String {
    if path.is_empty() { String::new() } else { format!("{path}: ") }
}

impl TemplateError {
    pub(crate) fn format(path: impl Into<String>, message: impl Into<String>) -> Self {
        Self::Format { path: shortened(path.into()), message: shortened(message.into()) }
    }
}

/// At most 300 characters: what is named is quoted, and names may be of any length.
fn shortened(text: String) -> String {
    match text.char_indices().nth(300) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}
