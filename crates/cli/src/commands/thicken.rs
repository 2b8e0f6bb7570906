//! `toile thicken`: a sheet to a solid.

use std::time::Instant;

use design::thicken::{
    NamedPlace, Settings, ThickenFileError, ThickenFileReport, ThicknessError, ThicknessWish, list_from_json,
    thicken,
};
use mesh_kernel::files::Format;
use sheet::thicken::{Corners, PlaceKind, Side, Step, Watcher};

use super::{file_name, mesh_format, read_sheet, read_text, write};
use crate::failure::Failure;
use crate::speech::{Speech, table};
use crate::words::{FoldCorners, Thicken, Unit, WallSide};

pub(crate) fn run(words: &Thicken, speech: &Speech) -> Result<(), Failure> {
    let started = Instant::now();
    let format = Format::of_path(&words.output)
        .ok_or_else(|| Failure::words("the solid's name must end in .obj, .ply, .stl, .off or .glb"))?;
    speech.step("reading");
    let sheet = read_sheet(&words.sheet)?;
    let settings = Settings {
        thickness: thickness(words)?,
        side: match words.side {
            WallSide::Both => Side::Both,
            WallSide::Front => Side::Front,
            WallSide::Back => Side::Back,
        },
        corners: match words.corners {
            FoldCorners::Round => Corners::Round,
            FoldCorners::Mitre => Corners::Mitre,
        },
        chord: words.chord,
        mitre_limit: words.mitre_limit,
        unit: words.unit.map(Unit::millimetres),
        read_from: mesh_format(&words.sheet),
        format,
    };
    let made = thicken(&sheet, &settings, &Steps { speech });
    let mut made = made.map_err(|e| refusal(e, words))?;
    speech.step("writing");
    write(&words.output, &made.bytes)?;
    made.report.file = words.output.display().to_string();
    made.report.sheet.file = file_name(&words.sheet);
    made.report.seconds = started.elapsed().as_secs_f64();
    for warning in &made.report.warnings {
        speech.warn(warning);
    }
    speech.report(&made.report, || summary(&made.report))
}

fn thickness(words: &Thicken) -> Result<ThicknessWish, Failure> {
    let Some(path) = &words.thickness_file else {
        return Ok(ThicknessWish::Patches {
            elsewhere: words.thickness,
            named: words.patch_thickness.clone(),
        });
    };
    let text = read_text("the thicknesses", path)?;
    Ok(ThicknessWish::Listed(list_from_json(&text).map_err(|e| Failure::from(e).about(path))?))
}

/// What was wrong, and what can be done.
fn refusal(error: ThickenFileError, words: &Thicken) -> Failure {
    let list = words.thickness_file.as_deref();
    let (about, remedy) = match &error {
        ThickenFileError::Thickness(ThicknessError::NotSaid { .. }) => {
            (words.sheet.as_path(), Some("say it for all other patches with --thickness MM"))
        }
        ThickenFileError::Thickness(ThicknessError::NoSuchPatch { .. }) => (words.sheet.as_path(), None),
        ThickenFileError::Thickness(_) => (list.unwrap_or(&words.sheet), None),
        ThickenFileError::NotOneSided { .. } => (words.sheet.as_path(), Some("--side both takes any sheet")),
        ThickenFileError::Sheet(_) | ThickenFileError::Coordinates(_) | ThickenFileError::Lost(_) => {
            (words.sheet.as_path(), None)
        }
    };
    let failure = Failure::from(error).about(about);
    match remedy {
        Some(remedy) => failure.remedy(remedy),
        None => failure,
    }
}

/// Tells the steps of the work. An interrupt ends the program as a whole; files are put in place whole or not at all.
struct Steps<'a> {
    speech: &'a Speech,
}

impl Watcher for Steps<'_> {
    fn step(&self, step: Step) {
        self.speech.step(match step {
            Step::Entities => "finding folds, joints and free edges",
            Step::Offsets => "offsetting",
            Step::Union => "uniting the offsets and purging what is inside",
            Step::Measure => "measuring",
        });
    }
}

fn summary(done: &ThickenFileReport) -> String {
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let purged = &done.purged;
    let rows = [
        row("triangles", done.faces.to_string()),
        row("closed", if done.closed { "yes" } else { "NO" }.to_owned()),
        row("faces that cross", done.self_intersections.to_string()),
        row("parts", done.components.to_string()),
        row("handles", done.genus.to_string()),
        row("volume [cm³]", format!("{:.3}", done.volume / 1000.0)),
        row("walls [mm]", walls(done.min_wall, done.max_wall)),
        row("holes filled", done.holes_filled.to_string()),
        row("purged faces", format!("{}", purged.laminar + purged.screen)),
        row("purged edges", format!("{}", purged.wire + purged.isthmus + purged.strut + purged.redundant)),
        row("seconds", format!("{:.2}", done.seconds)),
    ];
    let sheet = &done.sheet;
    let mut text = format!(
        "  {} triangles in {} {} of {}\n\n",
        sheet.faces,
        sheet.patches,
        if sheet.patches == 1 { "patch" } else { "patches" },
        sheet.file
    );
    text.push_str(&table(&[&done.file, ""], &rows));
    if !done.places.is_empty() {
        text.push('\n');
        text.push_str(&places(&done.places));
    }
    text
}

/// Thinnest and thickest, as one number where they are the same.
fn walls(min: f64, max: f64) -> String {
    let (min, max) = (format!("{min:.3}"), format!("{max:.3}"));
    if min == max { min } else { format!("{min} to {max}") }
}

fn places(places: &[NamedPlace]) -> String {
    /// More lines than this nobody reads; JSON has them all.
    const SHOWN: usize = 20;
    let line = |place: &NamedPlace| {
        let [x, y, z] = place.at;
        vec![
            match place.kind {
                PlaceKind::TightCurvature => "bends more tightly than the wall is thick",
                PlaceKind::Merged => "nearer than the thickness, grown together",
                PlaceKind::MitreLimit => "mitre over the limit, made an arc",
            }
            .to_owned(),
            format!("{x:.4} {y:.4} {z:.4}"),
            place.faces.to_string(),
            place.patches.join(", "),
        ]
    };
    let rows: Vec<Vec<String>> = places.iter().take(SHOWN).map(line).collect();
    let mut text = table(&["places that deserve a look", "at", "faces", "patches"], &rows);
    if places.len() > SHOWN {
        text.push_str(&format!("  and {} more; --json lists all\n", places.len() - SHOWN));
    }
    text
}
