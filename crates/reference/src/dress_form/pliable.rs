//! A form that follows its measurements: nodes move, faces stay.
//!
//! For the eye while a measurement is dragged. No triangle is made anew, so nothing but the surface has to be found: heights go
//! from the old levels to the new ones, sections take their new sizes, nodes are put onto the new zero set, and a tape brings
//! the girths to what was asked.

use mesh_kernel::TriMesh;
use rayon::prelude::*;

use super::curve::Curve;
use super::error::FormError;
use super::field::Field;
use super::levels::Levels;
use super::measurements::{Measurements, Resolved};
use super::patch::Patch;
use super::{FormOptions, TRIANGLES, as_built, half_form, mirrored, remesh, tape};

/// Nodes farther from the surface than this mean that it cannot be followed, mm.
const OFF: f64 = 2.0;

/// A dress form and all that it takes to move its nodes to other measurements.
#[derive(Clone, Debug)]
pub struct Pliable {
    pub(super) half: Patch,
    pub(super) field: Field,
    pub(super) measurements: Resolved,
    /// As built.
    pub(super) levels: Levels,
    /// What the sections were scaled by, one after the other.
    corrections: Vec<Curve>,
    head: bool,
}

impl Pliable {
    /// Builds the form, as [`DressForm::build`](super::DressForm::build) does.
    ///
    /// # Errors
    /// As there.
    pub fn build(measurements: &Measurements, options: &FormOptions) -> Result<Self, FormError> {
        let [low, high] = TRIANGLES;
        if !(low..=high).contains(&options.triangles) {
            return Err(FormError::Resolution { triangles: options.triangles, low, high });
        }
        let resolved = measurements.resolve()?;
        let mut field = Field::new(&resolved, options.head);
        let levels = field.levels;

        // A coarse form first: how far do its girths miss, with all parts joined?
        let mut coarse = half_form(&field, levels.stature / 70.0);
        let mut corrections = Vec::new();
        for _ in 0..2 {
            let correction = tape::correction(&coarse, &field, &resolved);
            field.sections.scale(|y| correction.get(y));
            corrections.push(correction);
            coarse = half_form(&field, levels.stature / 70.0);
        }

        let surface = 2.0 * remesh::area(&coarse);
        let edge = (surface / options.triangles as f64 / (0.25 * 3.0_f64.sqrt())).sqrt();
        let mut half = half_form(&field, edge * 0.95);
        remesh::remesh(&mut half, &field, edge, 5);
        for round in 0..6 {
            // The extremes first; what is left at the levels themselves last.
            let factor = if round < 4 { tape::level_extremes } else { tape::correction };
            let factor = factor(&half, &field, &resolved);
            tape::warp(&mut half, &field, &factor);
        }
        check(&half, &levels, &resolved)?;
        let levels = as_built(levels, &half);
        Ok(Self { half, field, measurements: resolved, levels, corrections, head: options.head })
    }

    /// The form's mesh.
    pub fn mesh(&self) -> TriMesh {
        mirrored(&self.half).0
    }

    /// The mesh at other measurements: the same faces, nodes elsewhere; bust, waist and hip as asked at their levels. Between
    /// these it is near to what is built of the same measurements, within some millimetres. O(nodes).
    ///
    /// # Errors
    /// [`FormError`] when the measurements are not of a person, or too far off for these faces.
    pub fn at(&self, measurements: &Measurements) -> Result<TriMesh, FormError> {
        let resolved = measurements.resolve()?;
        let mut field = Field::new(&resolved, self.head);
        let levels = field.levels;
        let (up, down) = (heights(&self.field.levels, &levels), heights(&levels, &self.field.levels));
        for correction in &self.corrections {
            field.sections.scale(|y| correction.get(down.get(y)));
        }
        let mut half = self.half.clone();
        for p in &mut half.positions {
            let from = self.field.sections.at(p.y);
            p.y = up.get(p.y);
            let to = field.sections.at(p.y);
            p.x *= to.half_width / from.half_width;
            p.z = to.centre + (p.z - from.centre) * to.half_depth / from.half_depth;
        }
        for _ in 0..2 {
            remesh::onto(&mut half, &field, 2);
        }
        let mut on_skin = vec![false; half.positions.len()];
        let skin = half.faces.iter().zip(&half.label).filter(|(_, label)| **label == 0);
        skin.flat_map(|(face, _)| face).for_each(|v| on_skin[*v as usize] = true);
        let nodes = half.positions.par_iter().zip(&on_skin).with_min_len(256).filter(|(_, skin)| **skin);
        if let Some((p, _)) = nodes.find_first(|(p, _)| field.bare(**p).abs() > OFF) {
            return Err(FormError::Folded { height: p.y / 10.0 });
        }
        for _ in 0..3 {
            let factor = tape::correction(&half, &field, &resolved);
            tape::warp(&mut half, &field, &factor);
        }
        check(&half, &levels, &resolved)?;
        Ok(mirrored(&half).0)
    }
}

/// Whether the girths are what was asked for and the skin is sound.
fn check(half: &Patch, levels: &Levels, resolved: &Resolved) -> Result<(), FormError> {
    tape::check(half, levels, resolved)?;
    match half.fault() {
        Some(place) => Err(FormError::Folded { height: place.y / 10.0 }),
        None => Ok(()),
    }
}

/// Heights of one person at those of another.
fn heights(from: &Levels, to: &Levels) -> Curve {
    let named = from.named().into_iter().zip(to.named());
    let mut points: Vec<(f64, f64)> = named.map(|((_, a), (_, b))| (a, b)).collect();
    points.push((0.0, 0.0));
    Curve::through(&points)
}
