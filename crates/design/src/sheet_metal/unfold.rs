//! A sheet's file to the drawing of its flat plates.

use mesh_kernel::TriMesh;
use pattern::{plates_to_dxf, plates_to_svg};
use serde::Serialize;
use sheet::facets::FacetRule;
use sheet::unfold::{Metal, UnfoldError, UnfoldOptions};

use super::drawing::drawn;
use super::{DrawingFormat, SheetReading, facets, line_name};

/// What `toile unfold` reports; lengths in millimetres, angles in degrees.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnfoldFileReport {
    /// Whether every component is one plate.
    pub one_piece: bool,
    /// Flat plates.
    pub plates: Vec<PlateReport>,
    /// Plates that the lines alone ask for; more were cut because they would lie on themselves.
    pub least_plates: usize,
    /// Facets.
    pub facets: usize,
    /// Bends.
    pub bends: usize,
    /// Lines that are welded.
    pub weld_lines: Vec<String>,
    /// Pairs of facets that lie on each other.
    pub overlaps: usize,
    /// Largest difference of an edge's length on the plate, before bends take their share, to that of the sheet.
    pub length_error: f64,
    /// Reliefs cut.
    pub reliefs: usize,
    /// Flat sheets tried.
    pub tried: usize,
    /// The metal.
    pub metal: Metal,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// The drawing's file.
    pub file: String,
    /// The whole command.
    pub seconds: f64,
}

/// A flat plate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlateReport {
    /// Its name in the drawing.
    pub name: String,
    /// Its facets.
    pub facets: Vec<String>,
    /// Width and height.
    pub size: [f64; 2],
    /// Area in mm².
    pub area: f64,
    /// Bends.
    pub bends: Vec<PlateBendReport>,
}

/// A bend of a plate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlateBendReport {
    /// The line of the sheet.
    pub line: String,
    /// The facets on both sides.
    pub facets: [String; 2],
    /// By what angle it is bent.
    pub angle: f64,
    /// Whether toward who looks at the drawing.
    pub up: bool,
    /// Length of the bend line on the plate.
    pub length: f64,
    /// Width of the bent strip.
    pub allowance: f64,
    /// From the facets' common line to where the bend begins.
    pub setback: f64,
}

/// A drawing, ready to be written.
#[derive(Clone, Debug)]
pub struct UnfoldedFile {
    /// All bytes of the file.
    pub bytes: Vec<u8>,
    /// The report; `file` and `seconds` are the caller's.
    pub report: UnfoldFileReport,
}

/// Unfolds a sheet and draws its plates.
///
/// # Errors
/// [`UnfoldError`].
pub fn unfold(
    mesh: &TriMesh,
    reading: &SheetReading,
    options: &UnfoldOptions,
    format: DrawingFormat,
    title: &str,
) -> Result<UnfoldedFile, UnfoldError> {
    // Only plane facets unfold, whatever the file's groups are.
    let sheet = facets(mesh, &SheetReading { rule: FacetRule::Planes, ..*reading })?;
    let flat = sheet::unfold::unfold(&sheet, options)?;
    let name = |f: u32| sheet.facets[f as usize].name.clone();
    let plate_name = |k: usize| format!("plate {}", k + 1);
    let drawings: Vec<_> = flat
        .plates
        .iter()
        .enumerate()
        .map(|(k, plate)| drawn(&sheet, plate, plate_name(k), &options.metal))
        .collect();
    let bytes = match format {
        DrawingFormat::Dxf => plates_to_dxf(&drawings),
        DrawingFormat::Svg => plates_to_svg(&drawings, title),
    };
    let plates: Vec<PlateReport> = flat
        .plates
        .iter()
        .enumerate()
        .map(|(k, plate)| PlateReport {
            name: plate_name(k),
            facets: plate.facets.iter().copied().map(name).collect(),
            size: (plate.bounds[1] - plate.bounds[0]).to_array(),
            area: plate
                .outlines
                .iter()
                .map(|o| (0..o.len()).map(|i| o[i].at.perp_dot(o[(i + 1) % o.len()].at)).sum::<f64>() / 2.0)
                .sum(),
            bends: plate
                .bends
                .iter()
                .map(|b| PlateBendReport {
                    line: line_name(b.line),
                    facets: b.facets.map(name),
                    angle: b.measures.angle.to_degrees(),
                    up: b.up,
                    length: b.ends[0].distance(b.ends[1]),
                    allowance: b.measures.allowance,
                    setback: b.measures.setback,
                })
                .collect(),
        })
        .collect();
    let mut welds: Vec<u32> = flat.plates.iter().flat_map(|p| &p.welds).map(|w| w.line).collect();
    welds.sort_unstable();
    welds.dedup();
    let mut warnings = Vec::new();
    if flat.plates.len() > flat.least_plates {
        warnings.push(format!(
            "{} plates where bends would allow {}: none of {} flat sheets tried was free of overlaps",
            flat.plates.len(),
            flat.least_plates,
            flat.tried
        ));
    }
    let report = UnfoldFileReport {
        one_piece: flat.one_piece,
        least_plates: flat.least_plates,
        facets: sheet.facets.len(),
        bends: plates.iter().map(|p| p.bends.len()).sum(),
        plates,
        weld_lines: welds.into_iter().map(line_name).collect(),
        overlaps: flat.overlaps,
        length_error: flat.length_error,
        reliefs: flat.reliefs,
        tried: flat.tried,
        metal: options.metal,
        warnings,
        file: String::new(),
        seconds: 0.0,
    };
    Ok(UnfoldedFile { bytes: bytes.into_bytes(), report })
}
