//! Everything about a pattern as JSON, seam pairing included, which no DXF holds.

use serde::Serialize;

use crate::{Layout, Pattern, Piece, SeamCheck};

/// Settings of [`to_json`].
#[derive(Clone, Debug, Default)]
pub struct JsonOptions {
    /// Name of the style (garment).
    pub style_name: String,
    /// Size that the pieces are drawn in.
    pub sample_size: String,
}

#[derive(Serialize)]
struct Document<'a> {
    toile: &'a str,
    units: &'a str,
    style_name: &'a str,
    sample_size: &'a str,
    pieces: &'a [Piece],
    seams: &'a [SeamCheck],
    layout: &'a Layout,
    warnings: &'a [String],
}

/// The pattern as JSON text. Chains name the seams that they are sewn in (`seams[].seam` is an index into the list
/// of seams), so that a reader can tell what is sewn to what.
pub fn to_json(pattern: &Pattern, options: &JsonOptions) -> String {
    let document = Document {
        toile: env!("CARGO_PKG_VERSION"),
        units: "mm",
        style_name: &options.style_name,
        sample_size: &options.sample_size,
        pieces: &pattern.pieces,
        seams: &pattern.seams,
        layout: &pattern.layout,
        warnings: &pattern.warnings,
    };
    // Plain structs with string keys always serialise.
    serde_json::to_string_pretty(&document).unwrap_or_default()
}
