//! `toile unfold`: a folded sheet to flat plates.

use std::time::Instant;

use design::sheet_metal::{DrawingFormat, SheetReading, UnfoldFileReport, mid_surface, unfold};
use design::units::FileUnit;
use mesh_kernel::TriMesh;
use mesh_kernel::files::Format;
use sheet::deflate::Nobody;
use sheet::facets::FacetRule;
use sheet::unfold::{Effort, Metal, Reference, Relief, ReliefShape, UnfoldOptions};

use super::{extension, file_name, read_mesh, read_sheet, unit_of_sheet, write};
use crate::failure::Failure;
use crate::speech::{Speech, table};
use crate::words::{Layer, Reliefs, Unfold, Unit};

pub(crate) fn run(words: &Unfold, speech: &Speech) -> Result<(), Failure> {
    let started = Instant::now();
    let format = match extension(&words.output).as_str() {
        "dxf" => DrawingFormat::Dxf,
        "svg" => DrawingFormat::Svg,
        _ => return Err(Failure::words("the drawing's name must end in .dxf or .svg")),
    };
    speech.step("reading");
    let (sheet, thickness, unit) = sheet_of(words, speech)?;
    let unit_warning = unit.warning();
    let options = UnfoldOptions {
        metal: Metal {
            thickness,
            inner_radius: words.radius.unwrap_or(thickness),
            k_factor: words.k_factor,
            reference: match words.layer {
                Layer::Middle => Reference::Middle,
                Layer::Inside => Reference::Inside,
                Layer::Outside => Reference::Outside,
            },
        },
        relief: Relief {
            shape: match words.relief {
                Reliefs::None => ReliefShape::None,
                Reliefs::Rectangle => ReliefShape::Rectangle,
                Reliefs::Round => ReliefShape::Round,
            },
            width: words.relief_width,
            depth: words.relief_depth,
        },
        effort: Effort::default(),
        gap: 10.0,
    };
    let reading = SheetReading { unit: unit.millimetres, rule: FacetRule::Planes };
    speech.step("looking for a flat sheet that does not lie on itself");
    let made = unfold(&sheet, &reading, &options, format, &file_name(&words.sheet));
    let mut made = made.map_err(|e| Failure::from(e).about(&words.sheet))?;
    speech.step("writing");
    write(&words.output, &made.bytes)?;
    made.report.warnings.splice(0..0, unit_warning);
    made.report.file = words.output.display().to_string();
    made.report.seconds = started.elapsed().as_secs_f64();
    for warning in &made.report.warnings {
        speech.warn(warning);
    }
    speech.report(&made.report, || summary(&made.report))
}

/// The sheet, its thickness and its unit; of a solid all three are found.
fn sheet_of(words: &Unfold, speech: &Speech) -> Result<(TriMesh, f64, FileUnit), Failure> {
    if !words.from_solid {
        let sheet = read_sheet(&words.sheet)?;
        let thickness = words.thickness.unwrap_or(0.0);
        let unit = unit_of_sheet(words.unit, &words.sheet, &sheet, thickness);
        return Ok((sheet, thickness, unit));
    }
    let solid = read_mesh(&words.sheet)?;
    let unit = FileUnit::of_format(words.unit.map(Unit::millimetres), Format::of_path(&words.sheet));
    speech.step("looking for the middle of its walls");
    let made = mid_surface(&solid, unit.millimetres, &Nobody);
    let (sheet, thickness) = made.map_err(|e| Failure::from(e).about(&words.sheet))?;
    Ok((sheet, thickness, FileUnit { millimetres: 1.0, guessed: false }))
}

fn summary(r: &UnfoldFileReport) -> String {
    let rows: Vec<Vec<String>> = r
        .plates
        .iter()
        .map(|p| {
            vec![
                p.name.clone(),
                format!("{:.2} × {:.2}", p.size[0], p.size[1]),
                format!("{:.2}", p.area / 100.0),
                p.bends.len().to_string(),
                p.facets.join(" "),
            ]
        })
        .collect();
    let mut text = table(&["plate", "size [mm]", "area [cm²]", "bends", "facets"], &rows);
    text.push_str(&format!(
        "\n  {} facets on {} plates, {} bends, {} lines welded, {} overlaps, {} reliefs; written to {}\n",
        r.facets,
        r.plates.len(),
        r.bends,
        r.weld_lines.len(),
        r.overlaps,
        r.reliefs,
        r.file
    ));
    text
}
