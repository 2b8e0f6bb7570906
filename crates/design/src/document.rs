//! `design.toile`: a template together with the body that it was rebuilt on, so that work goes on where it stopped.
//!
//! JSON. Coordinates are millimetres in the canonical frame (y up, the body faces +z, its left is +x), rounded to a
//! thousandth; `placement` leads back to the frame of the body's own file.

use std::collections::BTreeMap;

use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DMat3, DVec3};
use reference::human::{HumanBody, Placement};
use serde::{Deserialize, Serialize};
use template::format::TemplateFile;
use template::{Garment, Template, TemplateError};

/// Version of the format that this program writes and reads.
pub const DOCUMENT_VERSION: u32 = 1;

/// A design as it stands in the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Document {
    /// Format version: 1.
    pub toile_design: u32,
    /// Version of the program that wrote it.
    pub program: String,
    /// The template.
    pub template: TemplateFile,
    /// How often every triangle of the template is split; the template's own number when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub levels: Option<u8>,
    /// Where the template's nodes came to lie.
    pub nodes: BTreeMap<String, [f64; 3]>,
    /// The body.
    pub body: DocumentBody,
}

/// The body of a [`Document`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DocumentBody {
    /// Name of the file that it came from.
    pub file: String,
    /// The way back to the file's frame.
    pub placement: DocumentPlacement,
    /// Node positions.
    pub positions: Vec<[f64; 3]>,
    /// Node indices of the triangles.
    pub faces: Vec<[u32; 3]>,
}

/// `file = translation + scale · rotation · canonical`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DocumentPlacement {
    /// File units in a millimetre.
    pub scale: f64,
    /// Columns of the rotation.
    pub rotation: [[f64; 3]; 3],
    /// Where the canonical origin lies in the file, file units.
    pub translation: [f64; 3],
}

/// Why a design could not be read.
#[derive(Debug, thiserror::Error)]
pub enum DocumentError {
    /// No JSON of this shape.
    #[error("this is no design file: {0}")]
    Format(String),
    /// Written by a newer program.
    #[error("the design has format version {found}; this program reads {DOCUMENT_VERSION}")]
    Version {
        /// The version in the file.
        found: u32,
    },
    /// The template in it.
    #[error(transparent)]
    Template(#[from] TemplateError),
    /// The body in it.
    #[error("triangle {face} of the body refers to node {node}, but there are only {nodes}")]
    Index {
        /// The triangle.
        face: usize,
        /// The index.
        node: u32,
        /// Nodes of the body.
        nodes: usize,
    },
    /// The way back to the file's frame.
    #[error(
        "the body's placement leads nowhere: its scale must be above zero and its rotation a rotation (three orthogonal \
         unit vectors, right-handed)"
    )]
    Placement,
    /// The number of splits.
    #[error("{levels} splits are too many; at most {}", template::format::DEEPEST)]
    Levels {
        /// The number in the file.
        levels: u8,
    },
}

impl From<serde_json::Error> for DocumentError {
    fn from(error: serde_json::Error) -> Self {
        // What it quotes from the file may be of any length.
        let text = error.to_string();
        match text.char_indices().nth(300) {
            Some((end, _)) => {
                Self::Format(format!("{}… at line {}, column {}", &text[..end], error.line(), error.column()))
            }
            None => Self::Format(text),
        }
    }
}

impl Document {
    /// What is worth keeping of a regeneration.
    pub fn new(
        template: &Template,
        levels: Option<u8>,
        file: &str,
        body: &HumanBody,
        garment: &Garment,
    ) -> Self {
        let round = |p: &DVec3| p.to_array().map(|v| (v * 1000.0).round() / 1000.0);
        let placement = &body.placement;
        let nodes = garment.marks.iter().map(|mark| {
            let positions = garment.body.surface(garment.surfaces[mark.surface].id).positions();
            (mark.name.clone(), round(&positions[mark.node as usize]))
        });
        Self {
            toile_design: DOCUMENT_VERSION,
            program: env!("CARGO_PKG_VERSION").to_owned(),
            template: template.file().clone(),
            levels,
            nodes: nodes.collect(),
            body: DocumentBody {
                file: file.to_owned(),
                placement: DocumentPlacement {
                    scale: placement.scale,
                    rotation: placement.rotation.to_cols_array_2d(),
                    translation: placement.translation.to_array(),
                },
                positions: body.mesh.positions.iter().map(round).collect(),
                faces: body.mesh.faces.clone(),
            },
        }
    }

    /// The file's bytes; the same document gives the same bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        // Maps have text keys and numbers are finite or become null, so this cannot fail.
        let mut bytes = serde_json::to_vec(self).unwrap_or_default();
        bytes.push(b'\n');
        bytes
    }

    /// Reads a design and checks that it can be worked with.
    ///
    /// # Errors
    /// [`DocumentError`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, DocumentError> {
        #[derive(Deserialize)]
        struct Head {
            toile_design: u32,
        }
        let Head { toile_design: found } = serde_json::from_slice(bytes)?;
        if found != DOCUMENT_VERSION {
            return Err(DocumentError::Version { found });
        }
        let document: Self = serde_json::from_slice(bytes)?;
        let nodes = document.body.positions.len();
        for (face, corners) in document.body.faces.iter().enumerate() {
            if let Some(&node) = corners.iter().find(|v| **v as usize >= nodes) {
                return Err(DocumentError::Index { face, node, nodes });
            }
        }
        if let Some(levels) = document.levels.filter(|levels| *levels > template::format::DEEPEST) {
            return Err(DocumentError::Levels { levels });
        }
        let placement = document.placement();
        // Not a number fails every comparison.
        let turned = placement.rotation * placement.rotation.transpose() - DMat3::IDENTITY;
        let rigid =
            turned.to_cols_array().iter().all(|v| v.abs() < 1e-6) && placement.rotation.determinant() > 0.0;
        if !(placement.scale > 0.0 && rigid) {
            return Err(DocumentError::Placement);
        }
        document.template()?;
        Ok(document)
    }

    /// The template, checked.
    ///
    /// # Errors
    /// As [`Template::from_file`].
    pub fn template(&self) -> Result<Template, TemplateError> {
        Template::from_file(self.template.clone())
    }

    /// The body's mesh in the canonical frame.
    pub fn mesh(&self) -> TriMesh {
        TriMesh::new(
            self.body.positions.iter().map(|p| DVec3::from_array(*p)).collect(),
            self.body.faces.clone(),
        )
    }

    /// The way back to the frame of the body's file.
    pub fn placement(&self) -> Placement {
        let p = &self.body.placement;
        Placement {
            scale: p.scale,
            rotation: DMat3::from_cols_array_2d(&p.rotation),
            translation: DVec3::from_array(p.translation),
        }
    }
}
