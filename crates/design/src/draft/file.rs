//! Drafts in files: versioned, checked whole before anything is opened.

use serde::{Deserialize, Serialize};
use template::Template;
use template::format::TemplateFile;

use super::journal::SourceFile;
use super::{BodySource, Draft, DraftFileError, EditError, Mesh};
use crate::document::Document;

/// Version of the format that this program reads; it writes 1 where there is no drawing, for older programs to read.
pub const DRAFT_VERSION: u32 = 2;

/// What a file is that a draft can be made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FileKind {
    /// A draft: it is written back as it was read.
    Draft,
    /// A design of `regenerate`: a template with the body that it was rebuilt on.
    Design,
    /// A template without a body.
    Template,
}

impl FileKind {
    /// What people call it.
    pub fn words(self) -> &'static str {
        match self {
            Self::Draft => "a draft",
            Self::Design => "a rebuilt design",
            Self::Template => "a template without a body",
        }
    }
}

/// The template in a text: that alone, or the one in a design of `regenerate` or in a draft.
///
/// Messages about a template alone say where in it.
///
/// # Errors
/// [`DraftFileError`].
pub fn template_of(text: &str) -> Result<Template, DraftFileError> {
    #[derive(Deserialize)]
    struct Head {
        toile_draft: Option<u64>,
        toile_design: Option<u64>,
    }
    // A list would be read in the fields' order.
    let head =
        if text.trim_start().starts_with('{') { serde_json::from_str::<Head>(text).ok() } else { None };
    match head {
        Some(Head { toile_design: Some(_), .. }) => {
            let design = Document::from_bytes(text.as_bytes())?;
            let level = design.levels.unwrap_or(design.template.level);
            Ok(Template::from_file(TemplateFile { level, ..design.template })?)
        }
        Some(Head { toile_draft: Some(_), .. }) => {
            Ok(Template::from_file(Draft::from_bytes(text.as_bytes())?.template)?)
        }
        _ => Ok(Template::from_json(text)?),
    }
}

#[derive(Serialize, Deserialize)]
struct DraftFile {
    toile_draft: u32,
    program: String,
    /// In journals only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    file: Option<SourceFile>,
    draft: Draft,
}

impl Draft {
    /// The file's bytes, one line; the same draft gives the same bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        self.to_bytes_with(None)
    }

    /// The same as the first line of a journal, which says what file the work is of.
    pub(super) fn to_bytes_with(&self, source: Option<&SourceFile>) -> Vec<u8> {
        let file = DraftFile {
            toile_draft: if super::is_blank(&self.drawing) { 1 } else { DRAFT_VERSION },
            program: env!("CARGO_PKG_VERSION").to_owned(),
            // A path that is no text cannot be written in a journal.
            file: source.filter(|s| s.path.to_str().is_some()).cloned(),
            draft: self.clone(),
        };
        // Maps have text keys, so this cannot fail.
        let mut bytes = serde_json::to_vec(&file).unwrap_or_default();
        bytes.push(b'\n');
        bytes
    }

    /// Reads a draft, a design of `regenerate`, or a template (on the average form).
    ///
    /// # Errors
    /// [`DraftFileError`]: one message for a file that is cut off, foreign, newer, or contradicts itself.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, DraftFileError> {
        Self::read(bytes).map(|(draft, _)| draft)
    }

    /// The same, and what the file was.
    ///
    /// # Errors
    /// As [`Draft::from_bytes`].
    pub fn read(bytes: &[u8]) -> Result<(Self, FileKind), DraftFileError> {
        #[derive(Deserialize)]
        struct Head {
            toile_draft: Option<u64>,
            toile_design: Option<u64>,
            toile_template: Option<u64>,
        }
        let wrong = |e: serde_json::Error| {
            let text: String = e.to_string().chars().take(300).collect();
            DraftFileError::Format(text)
        };
        // Some editors put a mark before the text.
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let head: Head = serde_json::from_slice(bytes).map_err(wrong)?;
        let newer = |found: u64, known: u32| {
            if found > u64::from(known) { Err(DraftFileError::Newer { found, known }) } else { Ok(()) }
        };
        let (draft, kind) = match head {
            Head { toile_draft: Some(version), .. } => {
                newer(version, DRAFT_VERSION)?;
                if version == 0 {
                    return Err(DraftFileError::Format("there is no format version 0".to_owned()));
                }
                (serde_json::from_slice::<DraftFile>(bytes).map_err(wrong)?.draft, FileKind::Draft)
            }
            Head { toile_design: Some(version), .. } => {
                newer(version, crate::document::DOCUMENT_VERSION)?;
                let design = Document::from_bytes(bytes)?;
                let mesh = Mesh {
                    file: design.body.file,
                    positions: design.body.positions,
                    faces: design.body.faces,
                };
                (Self::new(design.template, BodySource::Mesh(mesh)), FileKind::Design)
            }
            Head { toile_template: Some(version), .. } => {
                newer(version, template::format::FORMAT_VERSION)?;
                let file: TemplateFile = serde_json::from_slice(bytes).map_err(wrong)?;
                (Self::new(file, BodySource::default()), FileKind::Template)
            }
            _ => {
                return Err(DraftFileError::Format(
                    "it names no version of a draft, design or template".to_owned(),
                ));
            }
        };
        draft.check()?;
        Ok((draft, kind))
    }

    fn check(&self) -> Result<(), EditError> {
        Template::check_incomplete(&self.template)?;
        self.body.check()?;
        for name in self.wires.iter().flatten() {
            let nodes = &self.template.nodes;
            let twin = name.strip_prefix("right_");
            let twin =
                twin.is_some_and(|r| nodes.contains_key(&format!("left_{r}")) || nodes.contains_key(r));
            if !nodes.contains_key(name) && !twin {
                return Err(EditError::Missing { kind: "node", name: name.clone() });
            }
        }
        Ok(())
    }
}
