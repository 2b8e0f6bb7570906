//! From a draft to a garment.

use std::sync::atomic::AtomicBool;

use mesh_kernel::glam::DVec3;
use mesh_kernel::query::ClosestPoint;
use reference::FeatureCurve;
use reference::dress_form::FormError;
use reference::human::{HumanBody, HumanError};
use template::{Garment, Reference, RegenerateOptions, Template, TemplateError, WarmStart};

use super::{Draft, OnBody};
use crate::regenerate::{RegenerateError, Regenerated, Settings, regenerate_prepared};

/// Why a draft cannot be built.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// The measurements.
    #[error(transparent)]
    Form(#[from] FormError),
    /// The body.
    #[error(transparent)]
    Body(#[from] HumanError),
    /// The garment.
    #[error(transparent)]
    Template(#[from] TemplateError),
    /// The pattern.
    #[error(transparent)]
    Regenerate(#[from] RegenerateError),
}

/// The body with the draft's own feature curves, drawn onto its skin: they follow a body that has changed.
pub fn with_drawn_features(draft: &Draft, on: &OnBody) -> HumanBody {
    let mut body = on.body.clone();
    if draft.features.is_empty() {
        return body;
    }
    let skin = ClosestPoint::new(&body.mesh);
    let normals = body.mesh.node_normals();
    for (name, drawn) in &draft.features {
        let mut curve = FeatureCurve { closed: drawn.closed, points: Vec::new(), normals: Vec::new() };
        for p in &drawn.points {
            let Some(near) = skin.closest(DVec3::from_array(*p)) else { continue };
            let corners = body.mesh.faces[near.face as usize].map(|v| normals[v as usize]);
            let normal: DVec3 = corners.iter().zip(near.barycentric).map(|(n, w)| *n * w).sum();
            curve.points.push(near.point);
            curve.normals.push(normal.normalize_or(DVec3::Y));
        }
        body.features.curves.insert(name.clone(), curve);
    }
    body
}

/// A coarse garment without a pattern, for the eye while something is dragged. It begins with what the preview before left in
/// `warm`.
///
/// # Errors
/// [`BuildError`].
pub fn preview(
    draft: &Draft,
    on: &OnBody,
    levels: u8,
    warm: &WarmStart,
    cancel: &AtomicBool,
) -> Result<Garment, BuildError> {
    let template = Template::from_file(draft.template.clone())?;
    let body = with_drawn_features(draft, on);
    let reference = Reference { mesh: &body.mesh, features: &body.features };
    let options = RegenerateOptions {
        levels: Some(levels),
        cancel: Some(cancel),
        prepared: Some(&on.prepared),
        preview: true,
        warm: Some(warm),
        ..RegenerateOptions::default()
    };
    Ok(template::regenerate(&template, &reference, &options)?)
}

impl Draft {
    /// The garment with pattern and report.
    ///
    /// # Errors
    /// [`BuildError`].
    pub fn build(
        &self,
        on: &OnBody,
        settings: &Settings,
        progress: &(dyn Fn(&str) -> bool + Sync),
    ) -> Result<Regenerated, BuildError> {
        let template = Template::from_file(self.template.clone())?;
        let body = with_drawn_features(self, on);
        Ok(regenerate_prepared(&template, &on.name, body, &on.prepared, settings, progress)?)
    }
}
