//! `toile deflate`: a thin solid to its mid-surface.

use std::path::Path;
use std::time::Instant;

use design::deflate::{
    DeflateFileError, DeflateFileReport, DeflateSettings, Element, InpOptions, Sections, deflate,
};
use mesh_kernel::files::Format;
use sheet::deflate::{DeflateError, DeflateOptions, Step, Steps, Watcher};

use super::{extension, read_mesh, write_together};
use crate::failure::Failure;
use crate::speech::{Speech, table};
use crate::words::{Deflate, ShellElement, ShellSections, ThicknessSteps, Unit};

pub(crate) fn run(words: &Deflate, speech: &Speech) -> Result<(), Failure> {
    let started = Instant::now();
    let format = Format::of_path(&words.output)
        .ok_or_else(|| Failure::words("the sheet's name must end in .obj, .ply, .stl, .off or .glb"))?;
    for (path, wanted) in [(&words.inp, "inp"), (&words.vtk, "vtk"), (&words.picture, "png")] {
        if let Some(path) = path.as_deref().filter(|p| extension(p) != wanted) {
            return Err(Failure::words(format!("{} must end in .{wanted}", path.display())));
        }
    }
    speech.step("reading");
    let solid = read_mesh(&words.solid)?;
    let settings = settings(words, format);
    let made = deflate(&solid, &settings, &Telling { speech });
    let mut made = made.map_err(|e| refusal(e, &words.solid))?;
    speech.step("writing");
    let thickness = words.output.with_extension("thickness.json");
    let mut files: Vec<(&Path, &[u8])> = vec![(&words.output, &made.sheet), (&thickness, &made.thickness)];
    for (path, bytes) in [(&words.inp, &made.inp), (&words.vtk, &made.vtk), (&words.picture, &made.picture)] {
        if let (Some(path), Some(bytes)) = (path, bytes) {
            files.push((path, bytes));
        }
    }
    write_together(&files)?;
    made.report.file = words.output.display().to_string();
    made.report.seconds = started.elapsed().as_secs_f64();
    for warning in &made.report.warnings {
        speech.warn(warning);
    }
    speech.report(&made.report, || summary(&made.report))
}

fn settings(words: &Deflate, format: Format) -> DeflateSettings {
    let defaults = DeflateOptions::default();
    DeflateSettings {
        options: DeflateOptions {
            max_thickness: words.max_thickness,
            max_draft: words.max_draft.map_or(defaults.max_draft, f64::to_radians),
            simplify: words.simplify,
            keep: words.keep.iter().map(|k| *k as usize - 1).collect(),
            steps: match words.steps {
                ThicknessSteps::Joined => Steps::Joined,
                ThicknessSteps::Apart => Steps::Apart,
                ThicknessSteps::Aligned => Steps::Aligned,
            },
            edge_length: words.edge_length,
        },
        unit: words.unit.map(Unit::millimetres),
        read_from: Format::of_path(&words.solid),
        format,
        inp: words.inp.is_some().then(|| InpOptions {
            element: match words.elements {
                ShellElement::S6 => Element::S6,
                ShellElement::S3 => Element::S3,
            },
            sections: match words.sections {
                ShellSections::Thickness => Sections::ByThickness,
                ShellSections::Nodal => Sections::Nodal,
            },
            ..InpOptions::default()
        }),
        vtk: words.vtk.is_some(),
        picture: words.picture.is_some(),
    }
}

/// What was wrong, and what can be done.
fn refusal(error: DeflateFileError, solid: &Path) -> Failure {
    let remedy = match &error {
        DeflateFileError::Solid(DeflateError::Bulky { .. }) | DeflateFileError::Nothing => {
            Some("--max-thickness MM says how thick walls may be")
        }
        DeflateFileError::Solid(DeflateError::Open { .. } | DeflateError::NotManifold { .. }) => {
            Some("toile check names every such edge")
        }
        _ => None,
    };
    let failure = Failure::from(error).about(solid);
    match remedy {
        Some(remedy) => failure.remedy(remedy),
        None => failure,
    }
}

/// Tells the steps of the work. An interrupt ends the program as a whole; files are put in place whole or not at all.
struct Telling<'a> {
    speech: &'a Speech,
}

impl Watcher for Telling<'_> {
    fn step(&self, step: Step) {
        self.speech.step(match step {
            Step::Check => "checking the solid",
            Step::Segments => "finding faces",
            Step::Pairs => "finding walls",
            Step::Replace => "moving walls to their middle",
            Step::Stitch => "stitching",
            Step::Measure => "measuring",
        });
    }
}

fn summary(done: &DeflateFileReport) -> String {
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let thickness = &done.thickness;
    let rows = [
        row("triangles", format!("{} of {}", done.faces, done.solid_faces)),
        row("patches", done.patches.to_string()),
        row("joints", done.joints.to_string()),
        row("free loops", done.free_loops.to_string()),
        row("parts", done.components.to_string()),
        row("area [mm²]", format!("{:.3}", done.area)),
        row("thickness [mm]", range(thickness.min, thickness.max)),
        row("area × thickness [% of the volume]", format!("{:.2}", 100.0 * done.volume_ratio)),
        row("pairs of walls", done.pairs.to_string()),
        row("faces without a partner", done.unpaired_faces.to_string()),
        row("features removed", done.removed_features.len().to_string()),
        row("seconds", format!("{:.2}", done.seconds)),
    ];
    let mut text = table(&[&done.file, ""], &rows);
    let features: Vec<_> = done.removed_features.iter().chain(&done.kept_features).collect();
    if !features.is_empty() {
        /// More lines than this nobody reads; JSON has them all.
        const SHOWN: usize = 30;
        let rows: Vec<Vec<String>> = features
            .iter()
            .take(SHOWN)
            .map(|f| {
                let fate = if f.removed { "removed" } else { f.kept_because.unwrap_or("kept") };
                vec![
                    f.kind.to_owned(),
                    format!("{:.3}", f.size),
                    format!("{:.3} {:.3} {:.3}", f.at.x, f.at.y, f.at.z),
                    fate.to_owned(),
                ]
            })
            .collect();
        text.push('\n');
        text.push_str(&table(&["feature", "size [mm]", "at", ""], &rows));
        if features.len() > SHOWN {
            text.push_str(&format!("  and {} more; --json lists all\n", features.len() - SHOWN));
        }
    }
    text
}

/// Thinnest and thickest, as one number where they are the same.
fn range(min: f64, max: f64) -> String {
    let (min, max) = (format!("{min:.3}"), format!("{max:.3}"));
    if min == max { min } else { format!("{min} to {max}") }
}
