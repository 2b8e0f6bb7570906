//! Sewing patterns: flattening, pieces, allowances, notches, DXF, SVG, PDF.
pub mod error;
pub mod input;
pub mod pattern;
pub use error::PatternError;
pub use input::*;
pub use pattern::*;
