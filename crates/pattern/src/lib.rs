//! Sewing patterns: flattening, pieces, allowances, notches, DXF, SVG, PDF, JSON.
//!
//! ```
//! use pattern::{Patch, PatternInput, PatternOptions, make};
//! use mesh_kernel::glam::DVec3;
//!
//! let square = [(0.0, 0.0), (200.0, 0.0), (200.0, 300.0), (0.0, 300.0)];
//! let patch = Patch {
//!     name: "front".into(),
//!     positions: square.iter().map(|&(x, y)| DVec3::new(x, y, 0.0)).collect(),
//!     faces: vec![[0, 1, 2], [0, 2, 3]],
//!     ..Patch::default()
//! };
//! let pattern = make(&PatternInput { patches: vec![patch], ..PatternInput::default() }, &PatternOptions::default())?;
//! assert!((pattern.pieces[0].report.area_2d - 60_000.0).abs() < 1e-6);
//! # Ok::<(), pattern::PatternError>(())
//! ```

mod error;
mod files;
mod flatten;
mod input;
mod mesh;
mod pattern;
mod pieces;

pub use error::PatternError;
pub use files::*;
pub use input::*;
pub use mesh::{FlattenMeshOptions, input_of_mesh};
pub use pattern::*;

/// Flattens the patches and makes their pieces. Parallel over patches; the result does not depend on the number of
/// threads. A patch of n nodes costs some ten sparse factorisations, O(n^1.5) each.
///
/// # Errors
/// Everything that [`PatternError`] lists: patches that are no oriented manifolds, closed or with handles; indices out
/// of range; seams that do not correspond; options out of range; patches too small or too large for an outline.
pub fn make(input: &PatternInput, options: &PatternOptions) -> Result<Pattern, PatternError> {
    pieces::check(input, options)?;
    let flat = flatten::flatten(input, options)?;
    pieces::make(input, flat, options)
}

/// Flattens any mesh: one piece a group and connected part; see [`input_of_mesh`].
///
/// # Errors
/// As [`make`].
pub fn flatten_mesh(
    mesh: &mesh_kernel::TriMesh,
    options: &FlattenMeshOptions,
) -> Result<Pattern, PatternError> {
    make(&input_of_mesh(mesh, options)?, &options.pattern)
}
