//! Sheet metal that is modelled as a solid: its mid-surface is what bends.

use mesh_kernel::TriMesh;
use sheet::deflate::{DeflateError, DeflateOptions, Watcher, deflate};

/// Thicknesses within this share of each other are those of one plate.
const EVEN: f64 = 0.02;

/// Why a solid is no sheet metal.
#[derive(Debug, thiserror::Error)]
pub enum SolidError {
    /// It has no mid-surface.
    #[error(transparent)]
    Solid(#[from] DeflateError),
    /// No wall has an opposite one.
    #[error("no mid-surface is left of the solid: none of its walls has an opposite one")]
    Nothing,
    /// Its walls are not cut from one plate.
    #[error("the solid's walls are {least:.3} to {most:.3} mm thick: they are not cut from one plate")]
    Uneven {
        /// Thinnest wall, in millimetres.
        least: f64,
        /// Thickest wall, in millimetres.
        most: f64,
    },
}

/// The mid-surface of a thin solid whose walls are of one thickness, and that thickness, both in millimetres; `unit` is
/// millimetres in one unit of the solid's coordinates.
///
/// # Errors
/// [`SolidError`]. O(n log n).
pub fn mid_surface(solid: &TriMesh, unit: f64, watcher: &dyn Watcher) -> Result<(TriMesh, f64), SolidError> {
    let mut scaled = TriMesh::new(solid.positions.clone(), solid.faces.clone());
    scaled.positions.iter_mut().for_each(|p| *p *= unit);
    let deflated = deflate(&scaled, &DeflateOptions::default(), watcher)?;
    let area = |f: usize| deflated.sheet.area_normal(f as u32).length();
    let (mut sum, mut total) = (0.0, 0.0);
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    for (f, &t) in deflated.thickness.iter().enumerate() {
        sum += area(f) * t;
        total += area(f);
        least = least.min(t);
        most = most.max(t);
    }
    if total <= 0.0 {
        return Err(SolidError::Nothing);
    }
    let mean = sum / total;
    if most - least > EVEN * mean {
        return Err(SolidError::Uneven { least, most });
    }
    Ok((deflated.sheet, mean))
}
