//! Patterns as files: DXF, SVG, PDF, JSON. All are made in memory.

mod drawing;
mod dxf;
mod json;
mod lettering;
mod pdf;
mod svg;

pub use dxf::{Dialect, DxfOptions, to_dxf};
pub use json::{JsonOptions, to_json};
pub use pdf::{Paper, PdfOptions, to_pdf};
pub use svg::{SvgOptions, to_svg};
