//! Thickening: the sheet of a file becomes the solid of a file.
//!
//! The work is [`mod@sheet::thicken`]'s; here are what lies between it and files: units, thicknesses by name and from lists,
//! formats that hold no doubles, the report.

mod place;
mod report;
mod thickness;

use std::sync::Mutex;
use std::time::Instant;

use mesh_kernel::TriMesh;
use mesh_kernel::files::{Format, WriteOptions, to_bytes};
use mesh_kernel::merge::{MergeError, MergeOptions};
use sheet::thicken::{Corners, Origin, Side, Step, ThickenError, ThickenOptions, Watcher};

use crate::units::FileUnit;

pub use place::Lost;
pub use report::{NamedPlace, Roles, SheetFacts, ThickenFileReport};
pub use thickness::{ThicknessError, ThicknessWish, list_from_json};

/// What is wanted of a thickened sheet. Lengths in millimetres.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// How thick, where.
    pub thickness: ThicknessWish,
    /// On which side.
    pub side: Side,
    /// What becomes of folds.
    pub corners: Corners,
    /// Farthest that an arc may be from its chords; `None`: what the sheet room thinks right.
    pub chord: Option<f64>,
    /// A mitre longer than this many times the offset is cut to an arc; `None` likewise.
    pub mitre_limit: Option<f64>,
    /// Millimetres in one unit of the sheet's coordinates; `None`: the format says it, or it is guessed.
    pub unit: Option<f64>,
    /// The format that the sheet was read from; `None` for a native body.
    pub read_from: Option<Format>,
    /// The format of the solid's file.
    pub format: Format,
}

/// Why no solid came of a sheet.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ThickenFileError {
    /// The thicknesses do not fit the sheet.
    #[error(transparent)]
    Thickness(#[from] ThicknessError),
    /// One side was asked for where it is not clear which that is.
    #[error("{source}; the patches there are {patches}")]
    NotOneSided {
        /// Where.
        source: ThickenError,
        /// Names of the patches that meet.
        patches: String,
    },
    /// The sheet could not be thickened.
    #[error(transparent)]
    Sheet(ThickenError),
    /// The solid could not be given the coordinates that the file can hold.
    #[error("the solid is too fine for the coordinates of the file: {0}")]
    Coordinates(MergeError),
    /// The solid would not be the same in the coordinates that the file can hold.
    #[error("{0}")]
    Lost(#[from] Lost),
}

/// A solid, ready to be written.
#[derive(Clone, Debug)]
pub struct ThickenedFile {
    /// All bytes of the file.
    pub bytes: Vec<u8>,
    /// What it holds; `file`, `sheet.file` and `seconds` are the caller's to fill.
    pub report: ThickenFileReport,
}

/// Makes a solid's file of a sheet whose coordinates are a file's, unit and all.
///
/// The solid has the sheet's unit (GLB: metres, by its standard) and a group a [role](sheet::thicken::Role).
///
/// # Errors
/// [`ThickenFileError`].
pub fn thicken(
    sheet: &TriMesh,
    settings: &Settings,
    watcher: &dyn Watcher,
) -> Result<ThickenedFile, ThickenFileError> {
    let clock = Clock::new(watcher);
    let unit = FileUnit::of_sheet(settings.unit, settings.read_from, sheet, settings.thickness.thickest());
    let mut warnings: Vec<String> = unit.warning().into_iter().collect();
    let unit = unit.millimetres;
    let (mut mesh, thickness) = settings.thickness.on(sheet)?;
    mesh.positions.iter_mut().for_each(|p| *p *= unit);
    let mut options = ThickenOptions { thickness, side: settings.side, ..ThickenOptions::new(1.0) };
    options.corners = settings.corners;
    options.chord = settings.chord;
    options.mitre_limit = settings.mitre_limit.unwrap_or(options.mitre_limit);
    let thickened = sheet::thicken::thicken(&mesh, &options, &clock).map_err(|e| refusal(e, sheet))?;
    clock.begin("placing");
    let target = place::Target { unit, format: settings.format };
    let cancelled = || watcher.cancelled();
    let merge_options = MergeOptions { cancelled: &cancelled, ..MergeOptions::default() };
    let (solid, parents) = place::in_file(&thickened.solid, target, &merge_options).map_err(|e| match e {
        MergeError::Cancelled => ThickenFileError::Sheet(ThickenError::Cancelled),
        other => ThickenFileError::Coordinates(other),
    })?;
    let (origins, measured) = match parents {
        Some(parents) => {
            let origins: Vec<Origin> = parents.iter().map(|&f| thickened.origins[f as usize]).collect();
            let measured = thickened.measured_on(&solid, target.unit_of_file(), &origins);
            place::check(&thickened, &solid, &measured, &parents, target)?;
            if measured.components < thickened.report.components {
                warnings.push(format!(
                    "{} parts of the solid are {} in the file: they are nearer to each other than its numbers can tell",
                    thickened.report.components, measured.components
                ));
            }
            (origins, measured)
        }
        None => (thickened.origins, thickened.report),
    };
    let (solid, roles) = report::grouped_by_role(solid, &origins);
    clock.begin("encoding");
    let write = WriteOptions { glb_scale: target.unit_of_file() * 1e-3, ..WriteOptions::default() };
    let bytes = to_bytes(settings.format, &solid, &write);
    let mut report = ThickenFileReport::new(&mesh, unit, &measured, roles, warnings);
    report.step_seconds = clock.end();
    Ok(ThickenedFile { bytes, report })
}

/// Names what the sheet room counts.
fn refusal(source: ThickenError, sheet: &TriMesh) -> ThickenFileError {
    match &source {
        ThickenError::NonManifold { patches, .. } | ThickenError::NotOrientable { patches, .. } => {
            let names = thickness::patch_names(sheet);
            let of = |patch: &u32| names.get(*patch as usize).cloned().unwrap_or_default();
            let patches = thickness::listed(&patches.iter().map(of).collect::<Vec<_>>());
            ThickenFileError::NotOneSided { source, patches }
        }
        _ => ThickenFileError::Sheet(source),
    }
}

/// Passes on to a watcher and keeps the time that each step took.
struct Clock<'a> {
    watcher: &'a dyn Watcher,
    steps: Mutex<Vec<(&'static str, Instant)>>,
}

impl<'a> Clock<'a> {
    fn new(watcher: &'a dyn Watcher) -> Self {
        Self { watcher, steps: Mutex::new(vec![("reading thicknesses", Instant::now())]) }
    }

    fn begin(&self, name: &'static str) {
        if let Ok(mut steps) = self.steps.lock() {
            steps.push((name, Instant::now()));
        }
    }

    /// Names and seconds, in the order of the work.
    fn end(self) -> Vec<report::StepSeconds> {
        self.begin("end");
        let steps = self.steps.into_inner().unwrap_or_default();
        let of = |pair: &[(&'static str, Instant)]| report::StepSeconds {
            step: pair[0].0,
            seconds: (pair[1].1 - pair[0].1).as_secs_f64(),
        };
        steps.windows(2).map(of).collect()
    }
}

impl Watcher for Clock<'_> {
    fn step(&self, step: Step) {
        self.begin(match step {
            Step::Entities => "entities",
            Step::Offsets => "offsets",
            Step::Union => "union",
            Step::Measure => "measure",
        });
        self.watcher.step(step);
    }

    fn cancelled(&self) -> bool {
        self.watcher.cancelled()
    }
}
