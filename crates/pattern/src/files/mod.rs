//! Patterns as files: DXF, SVG, PDF, JSON. All are made in memory.

mod drawing;
mod dxf;
mod json;
mod lettering;
mod pdf;
mod plates;
mod svg;

pub use dxf::{Dialect, DxfOptions, to_dxf};
pub use json::{JsonOptions, to_json};
pub use pdf::{Paper, PdfOptions, to_pdf};
pub use plates::{PlateBend, PlateDrawing, PlateWeld, plates_to_dxf, plates_to_svg};
pub use svg::{SvgOptions, to_svg};
