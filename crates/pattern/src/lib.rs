//! Sewing patterns: flattening, pieces, allowances, notches, DXF, SVG, PDF.
mod error;
mod flatten;
mod input;
mod mesh;
mod pattern;

pub use error::PatternError;
pub use input::*;
pub use mesh::{FlattenMeshOptions, input_of_mesh};
pub use pattern::*;

/// tmp
pub fn flat_only(input: &PatternInput, options: &PatternOptions) -> Result<(Vec<Flat>, Vec<PieceReport>, Vec<String>), PatternError> {
    let f = flatten::flatten(input, options)?;
    let seams: Vec<String> = f.seams.iter().map(|s| format!("{} sides {} edges {}", s.name, s.sides.len(), s.sides[0].edges.len())).collect();
    Ok((f.patches.iter().map(|p| p.flat.clone()).collect(), f.patches.into_iter().map(|p| p.report).collect(), [f.warnings, seams].concat()))
}
