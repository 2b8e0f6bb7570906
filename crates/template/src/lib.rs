//! Feature templates: encoding, profiles, shape construction, collision, regeneration.
//!
//! After Wang et al., *feature templates for non-manifold freeform objects*: a template is a coarse complex of patches
//! whose nodes are stored relative to the features of a body. [`regenerate`](regenerate()) rebuilds it on any body with the same
//! features.

mod adapt;
mod collision;
mod complex;
mod construct;
mod crowding;
mod ease;
pub mod encoding;
pub mod error;
pub mod fairing;
pub mod format;
mod garment;
mod joints;
mod layout;
pub mod lines;
mod outline;
mod place;
mod refine;
mod regenerate;
mod skin;

pub use collision::CollisionReport;
pub use construct::Method;
pub use error::TemplateError;
pub use garment::{
    Garment, GarmentLine, GarmentPiece, GarmentSurface, Mark, PieceEdge, Seam, Seconds, SurfaceChain,
};
pub use place::{SCALE_STATURE, node_frame, node_places};
pub use regenerate::{Progress, Reference, RegenerateOptions, WarmStart, regenerate};
pub use skin::Prepared;

/// A template that was read, checked and written out.
#[derive(Clone, Debug)]
pub struct Template {
    file: format::TemplateFile,
    pub(crate) layout: layout::Layout,
}

impl Template {
    /// Reads a template from its JSON text (see [`format`]).
    ///
    /// # Errors
    /// [`TemplateError::Format`] with the path of the value at fault, [`TemplateError::Version`].
    pub fn from_json(text: &str) -> Result<Self, TemplateError> {
        let file = format::strict::from_str(text).map_err(|e| TemplateError::format(e.path, e.message))?;
        Self::from_file(file)
    }

    /// Takes a template file made in memory, with the same checks as [`Template::from_json`].
    ///
    /// # Errors
    /// [`TemplateError::Format`], [`TemplateError::Version`].
    pub fn from_file(file: format::TemplateFile) -> Result<Self, TemplateError> {
        format::check::check(&file)?;
        let layout = layout::Layout::new(&file)?;
        Ok(Self { file, layout })
    }

    /// Checks a template that is being made, which may still lack nodes or surfaces; what is there must make sense.
    ///
    /// # Errors
    /// [`TemplateError::Format`], [`TemplateError::Version`].
    pub fn check_incomplete(file: &format::TemplateFile) -> Result<(), TemplateError> {
        format::check::check_incomplete(file)?;
        layout::Layout::new(file).map(|_| ())
    }

    /// The template as it stands in the file.
    pub fn file(&self) -> &format::TemplateFile {
        &self.file
    }

    /// The template as JSON text, ready to be read again.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(&self.file).unwrap_or_default()
    }

    /// The JSON Schema of the format.
    pub fn schema() -> serde_json::Value {
        schemars::schema_for!(format::TemplateFile).to_value()
    }
}
