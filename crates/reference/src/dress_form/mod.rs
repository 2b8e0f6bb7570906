//! Dress forms from tape measurements.
//!
//! 1. [`Measurements::resolve`] checks what is given against the ratios that people have and derives the rest.
//! 2. The form is the zero set of a smooth function (module `field`): superellipse sections of trunk and legs with girths that
//!    are monotone splines of height, joined smoothly with breasts, shoulders, neck and arm stumps.
//! 3. Its left half is polygonised, cut flat at the plates and remeshed to even triangles.
//! 4. The sections are scaled until a tape reads what was asked, and reads less (more) beside the fullest (narrowest)
//!    level, so that whoever searches for bust, waist and hip finds them; then the half is mirrored.
//!
//! ```
//! use reference::dress_form::{DressForm, FormOptions, Preset};
//! let preset = Preset::find("eu-38").ok_or("no such preset")?;
//! let form = DressForm::build(&preset.measurements, &FormOptions::default())?;
//! assert_eq!(form.levels.stature, 1680.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod clip;
mod curve;
mod error;
mod field;
mod hull;
mod levels;
mod measurements;
mod patch;
mod pliable;
mod polygonize;
mod presets;
mod remesh;
mod sections;
mod tape;

pub use error::FormError;
pub use levels::{HEADLESS_HEIGHT_RATIO, Levels};
pub use measurements::{Figure, HEIGHT_RANGE, Measurements, Resolved};
pub use pliable::Pliable;
pub use presets::{Preset, presets};

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;

use field::Field;
use patch::Patch;
use polygonize::Bounds;

/// How to build a form.
#[derive(Clone, Debug, PartialEq)]
pub struct FormOptions {
    /// A plain head on the neck instead of the neck plate: the mesh is then as high as the person.
    pub head: bool,
    /// About how many triangles the mesh gets.
    pub triangles: usize,
}

impl Default for FormOptions {
    fn default() -> Self {
        Self { head: false, triangles: 22_000 }
    }
}

/// Fewest and most triangles of [`FormOptions::triangles`].
pub const TRIANGLES: [usize; 2] = [6_000, 200_000];

/// A flat end of the form.
#[derive(Clone, Debug, PartialEq)]
pub struct Plate {
    /// `left_arm`, `right_arm`, `neck`, `left_ankle`, `right_ankle`.
    pub name: &'static str,
    /// A point of its plane, mm.
    pub origin: DVec3,
    /// Unit normal out of the form.
    pub normal: DVec3,
    /// Faces of the mesh that lie in it.
    pub faces: Vec<u32>,
}

/// A dress form.
#[derive(Clone, Debug, PartialEq)]
pub struct DressForm {
    /// Closed, of genus 0, mirrored exactly about x = 0; millimetres, y up, facing +z, its left at +x, on the floor y = 0.
    pub mesh: TriMesh,
    /// Every measurement used, given and derived, cm.
    pub measurements: Resolved,
    /// Where they are.
    pub levels: Levels,
    /// The flat ends.
    pub plates: Vec<Plate>,
}

impl DressForm {
    /// Builds the form: bust, waist and hip within 0.2 mm of what was asked at their levels. About 0.2 s for the default
    /// size; the time is linear in the number of triangles. The same input gives the same mesh on any number of threads.
    ///
    /// # Errors
    /// [`FormError`] when the measurements are not of a person, or the wanted size of the mesh is out of range.
    pub fn build(measurements: &Measurements, options: &FormOptions) -> Result<Self, FormError> {
        let Pliable { half, field, measurements, levels, .. } = Pliable::build(measurements, options)?;
        let (mesh, labels) = mirrored(&half);
        let plates = plates(&mesh, &labels, &field);
        Ok(Self { mesh, measurements, levels, plates })
    }
}

/// Half the surface, cut at the plates, triangles as they come.
fn half_form(field: &Field, cell: f64) -> Patch {
    let h = field.levels.stature;
    let margin = 2.5 * cell;
    let (width, z) = field.extent();
    let bounds = Bounds {
        half_width: width + margin,
        y: [-margin - cell, field.levels.top + margin + 0.02 * h],
        z: [z[0] - margin, z[1] + margin],
    };
    clip::clip(polygonize::polygonize(|p| field.closed(p, margin), &bounds, cell), &field.cuts)
}

/// The levels that the finished surface itself decides: crotch, armpit and shoulder point.
fn as_built(mut levels: Levels, half: &Patch) -> Levels {
    let (knee, hip) = (levels.knee, levels.hip);
    let middle = half.positions.iter().filter(|p| p.x == 0.0 && p.y > knee && p.y < hip);
    levels.crotch = middle.map(|p| p.y).fold(hip, f64::min);
    let arm = half.faces.iter().zip(&half.label).filter(|(_, l)| **l as usize == field::ARM + 1);
    let heights = arm.flat_map(|(face, _)| face.map(|v| half.positions[v as usize].y));
    let [low, high] = heights.fold([f64::MAX, f64::MIN], |[a, b], y| [a.min(y), b.max(y)]);
    if low < high {
        (levels.armpit, levels.shoulder) = (low, high);
    }
    levels
}

/// The whole mesh and the plate label of every face; nodes of the plane of symmetry are shared.
fn mirrored(half: &Patch) -> (TriMesh, Vec<u8>) {
    let mut positions = half.positions.clone();
    let other: Vec<u32> = half
        .positions
        .iter()
        .enumerate()
        .map(|(v, p)| {
            if half.on_border(v as u32) {
                return v as u32;
            }
            positions.push(DVec3::new(-p.x, p.y, p.z));
            positions.len() as u32 - 1
        })
        .collect();
    let mut faces = half.faces.clone();
    faces.extend(
        half.faces.iter().map(|&[a, b, c]| [other[a as usize], other[c as usize], other[b as usize]]),
    );
    let mut labels = half.label.clone();
    labels.extend_from_slice(&half.label);
    (TriMesh::new(positions, faces), labels)
}

fn plates(mesh: &TriMesh, labels: &[u8], field: &Field) -> Vec<Plate> {
    let of = |name: &'static str, cut: usize, side: f64| {
        let plane = &field.cuts[cut];
        let mirror = DVec3::new(if side < 0.0 { -1.0 } else { 1.0 }, 1.0, 1.0);
        let faces: Vec<u32> = (0..labels.len() as u32)
            .filter(|&f| {
                let x: f64 = mesh.corners(f).iter().map(|p| p.x).sum();
                labels[f as usize] as usize == cut + 1 && (side == 0.0 || x * side > 0.0)
            })
            .collect();
        Plate { name, origin: plane.origin * mirror, normal: plane.normal * mirror, faces }
    };
    let mut plates = vec![
        of("left_ankle", 0, 1.0),
        of("right_ankle", 0, -1.0),
        of("left_arm", field::ARM, 1.0),
        of("right_arm", field::ARM, -1.0),
    ];
    if field.cuts.len() > 2 {
        plates.push(of("neck", 2, 0.0));
    }
    plates
}
