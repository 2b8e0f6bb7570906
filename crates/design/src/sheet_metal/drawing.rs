//! Flat plates as drawings.

use pattern::{PlateBend, PlateDrawing, PlateWeld};
use sheet::facets::FacetSheet;
use sheet::unfold::{FlatBend, Metal, Plate};

use super::line_name;

/// A plate as it is drawn: bends with angle and radius, welds with the names of their lines.
pub(super) fn drawn(sheet: &FacetSheet, plate: &Plate, name: String, metal: &Metal) -> PlateDrawing {
    let facet = |f: u32| sheet.facets[f as usize].name.clone();
    PlateDrawing {
        name,
        outlines: plate.outlines.iter().map(|o| o.iter().map(|p| p.at).collect()).collect(),
        bends: plate
            .bends
            .iter()
            .map(|b| PlateBend { ends: b.ends, up: b.up, text: bend_text(b, metal) })
            .collect(),
        welds: plate.welds.iter().map(|w| PlateWeld { ends: w.ends, text: line_name(w.line) }).collect(),
        labels: plate.labels.iter().map(|&(f, at)| (at, facet(f))).collect(),
    }
}

fn bend_text(bend: &FlatBend, metal: &Metal) -> String {
    let degrees = bend.measures.angle.to_degrees();
    if degrees == 0.0 {
        return format!("{} flat", line_name(bend.line));
    }
    let way = if bend.up { "up" } else { "down" };
    // Angles are those of the model; more digits than a brake can set are noise.
    let angle = format!("{:.2}", degrees);
    let angle = angle.trim_end_matches('0').trim_end_matches('.');
    let radius = if metal.thickness > 0.0 { format!(" R{}", metal.inner_radius) } else { String::new() };
    format!("{} {way} {angle}{radius}", line_name(bend.line))
}
