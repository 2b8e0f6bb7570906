//! A design that is being made: a template that may be incomplete, and the body that it is made on.
//!
//! [`Draft`] is a value; [`Edit`]s are the only way to change one. [`History`] keeps every state with a label, so undo gives the
//! bit-equal draft back; [`Command`]s in a [`journal`] replay to the same one.

mod autosave;
mod body;
mod build;
mod edit;
mod error;
mod file;
mod history;
pub mod journal;
mod rename;
mod seams;
mod shared;
mod topology;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sketch::Drawing;
use template::format::TemplateFile;

pub use autosave::{Autosave, Recovery, recoveries, state_folder};
pub use body::{BodySource, DraggedForm, MEASURES, Mesh, OnBody, measure, set_measure};
pub use build::{BuildError, preview, with_drawn_features};
pub use edit::Edit;
pub use error::{DraftFileError, EditError};
pub use file::{DRAFT_VERSION, FileKind, template_of};
pub use history::{Command, History};
pub use journal::{Journal, SourceFile};
pub use rename::Named;
pub use topology::{edges, faces, joints};

/// A feature curve drawn by hand on the body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DrawnFeature {
    /// Points, mm, in the body's canonical frame.
    pub points: Vec<[f64; 3]>,
    /// Whether it closes.
    #[serde(default)]
    pub closed: bool,
}

/// A design that is being made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Draft {
    /// The template; it may still lack nodes or surfaces.
    pub template: TemplateFile,
    /// Edges that no face has yet; the names of a pair are in order.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    pub wires: BTreeSet<[String; 2]>,
    /// Feature curves drawn by hand.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub features: BTreeMap<String, DrawnFeature>,
    /// What is drawn in the plane, beside the garment.
    #[serde(default, skip_serializing_if = "is_blank")]
    pub drawing: Drawing,
    /// The body; shared, as it may be large.
    #[serde(with = "shared")]
    pub body: Arc<BodySource>,
}

fn is_blank(drawing: &Drawing) -> bool {
    *drawing == Drawing::default()
}

impl Draft {
    /// A draft of a template on a body.
    pub fn new(template: TemplateFile, body: BodySource) -> Self {
        Self {
            template,
            wires: BTreeSet::new(),
            features: BTreeMap::new(),
            drawing: Drawing::default(),
            body: Arc::new(body),
        }
    }

    /// Whether the same garment comes of both: they differ in the drawing at most.
    pub fn has_garment_of(&self, other: &Self) -> bool {
        let body = Arc::ptr_eq(&self.body, &other.body) || self.body == other.body;
        body && self.template == other.template
            && self.wires == other.wires
            && self.features == other.features
    }

    /// Nothing but a body: a woman of the average size.
    pub fn empty() -> Self {
        let template = TemplateFile {
            toile_template: template::format::FORMAT_VERSION,
            name: "New design".to_owned(),
            description: String::new(),
            mirrored: true,
            symmetric: None,
            level: 3,
            adaptive: None,
            clearance: 4.0,
            nodes: BTreeMap::new(),
            surfaces: BTreeMap::new(),
            joints: None,
            lines: BTreeMap::new(),
            fair_across: Vec::new(),
            ease: BTreeMap::new(),
            pieces: BTreeMap::new(),
        };
        Self::new(template, BodySource::default())
    }
}
