//! Solids, mid-surfaces and flat plates: work from file to file that the design has no part in, but for the garment that is
//! made thick.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use design::deflate::{DeflateSettings, deflate};
use design::modelling::model;
use design::sheet_metal::{DrawingFormat, SheetReading, unfold};
use design::thicken::{Settings, ThicknessWish, thicken};
use design::units::FileUnit;
use mesh_kernel::TriMesh;
use mesh_kernel::files::{FileSet, Format, NotPlaced, read};
use sheet::deflate::DeflateOptions;
use sheet::facets::FacetRule;
use sheet::thicken::{Corners, Side};
use sheet::unfold::{Effort, Metal, Reference, Relief, ReliefShape, UnfoldOptions};

/// How far work for a file is, and whether a person has stopped it. Work that writes can be stopped no more: so either it is
/// stopped and nothing is written, or it is done.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stop(Arc<AtomicU8>);

const AT_WORK: u8 = 0;
const STOPPED: u8 = 1;
const WRITING: u8 = 2;

impl Stop {
    /// Stops the work; whether it could be.
    pub(crate) fn now(&self) -> bool {
        self.change(STOPPED)
    }

    pub(crate) fn is_wanted(&self) -> bool {
        self.0.load(Ordering::Relaxed) == STOPPED
    }

    /// Whether it may write; from now on it cannot be stopped.
    pub(crate) fn may_write(&self) -> bool {
        self.change(WRITING)
    }

    /// Whether it is so now.
    fn change(&self, to: u8) -> bool {
        match self.0.compare_exchange(AT_WORK, to, Ordering::Relaxed, Ordering::Relaxed) {
            Ok(_) => true,
            Err(now) => now == to,
        }
    }
}

impl sheet::thicken::Watcher for Stop {
    fn cancelled(&self) -> bool {
        self.is_wanted()
    }
}

impl sheet::deflate::Watcher for Stop {
    fn cancelled(&self) -> bool {
        self.is_wanted()
    }
}

/// The share of the metal's thickness, from the inner side, at which a bend keeps its length: mild steel, bent in air.
const K_FACTOR: f64 = 0.44;

const MODELS: &str = ".obj, .ply, .stl, .off or .glb";

fn format_of(path: &Path, what: &str) -> Result<Format, String> {
    Format::of_path(path).ok_or_else(|| format!("the {what}'s name must end in {MODELS}"))
}

/// Writes all of the files, or none.
fn written(files: &[(&Path, &[u8])], stop: &Stop) -> Result<(), String> {
    if !stop.may_write() {
        return Err("stopped".to_owned());
    }
    let told = |e: NotPlaced| format!("{} could not be written: {}", e.path.display(), e.source);
    let mut set = FileSet::default();
    for (path, bytes) in files {
        set.add(path, bytes).map_err(told)?;
    }
    set.place().map_err(told)
}

/// Makes a solid of the garment, `thickness` mm thick, and writes it.
///
/// # Errors
/// One sentence.
pub(crate) fn thicken_to(mesh: &TriMesh, thickness: f64, path: &Path, stop: &Stop) -> Result<String, String> {
    let settings = Settings {
        thickness: ThicknessWish::Patches { elsewhere: Some(thickness), named: Vec::new() },
        side: Side::Both,
        corners: Corners::default(),
        chord: None,
        mitre_limit: None,
        unit: Some(1.0),
        read_from: None,
        format: format_of(path, "solid")?,
    };
    let made = thicken(mesh, &settings, stop).map_err(|e| e.to_string())?;
    written(&[(path, &made.bytes)], stop)?;
    Ok(format!("solid of {} triangles written to {}", made.report.faces, path.display()))
}

/// Makes the mid-surface of a thin solid in a file and writes it, with its thickness beside it.
///
/// # Errors
/// One sentence.
pub(crate) fn deflate_to(solid: &Path, path: &Path, stop: &Stop) -> Result<String, String> {
    let about = |e: &dyn std::fmt::Display| format!("{}: {e}", solid.display());
    let settings = DeflateSettings {
        options: DeflateOptions::default(),
        unit: None,
        read_from: Format::of_path(solid),
        format: format_of(path, "mid-surface")?,
        inp: None,
        vtk: false,
        picture: false,
    };
    let mesh = read(solid).map_err(|e| about(&e))?;
    let made = deflate(&mesh, &settings, stop).map_err(|e| about(&e))?;
    let thickness = path.with_extension("thickness.json");
    written(&[(path, &made.sheet), (&thickness, &made.thickness)], stop)?;
    let report = &made.report;
    let text = format!("mid-surface of {} patches written to {}", report.patches, path.display());
    Ok(report.warnings.iter().fold(text, |text, warning| format!("{text}; {warning}")))
}

/// Lays a folded sheet in a file, or a script that makes one, flat and draws its plates. Without a thickness it is folded
/// sharply, as paper is.
///
/// # Errors
/// One sentence.
pub(crate) fn unfold_to(sheet: &Path, thickness: f64, path: &Path, stop: &Stop) -> Result<String, String> {
    let about = |e: &dyn std::fmt::Display| format!("{}: {e}", sheet.display());
    let ends_in = |end: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(end));
    let format = match (ends_in("dxf"), ends_in("svg")) {
        (true, _) => DrawingFormat::Dxf,
        (_, true) => DrawingFormat::Svg,
        _ => return Err("the drawing's name must end in .dxf or .svg".to_owned()),
    };
    let is_script = sheet.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"));
    let mesh = if is_script {
        let text = std::fs::read_to_string(sheet).map_err(|e| about(&e))?;
        model(&text).map_err(|e| about(&e))?.mesh
    } else {
        read(sheet).map_err(|e| about(&e))?
    };
    // A script's name is that of no mesh format.
    let unit = FileUnit::of_sheet(None, Format::of_path(sheet), &mesh, thickness).millimetres;
    let options = UnfoldOptions {
        metal: Metal { thickness, inner_radius: thickness, k_factor: K_FACTOR, reference: Reference::Middle },
        relief: Relief { shape: ReliefShape::Rectangle, width: None, depth: None },
        effort: Effort::default(),
        gap: 10.0,
    };
    let name = sheet.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let reading = SheetReading { unit, rule: FacetRule::Planes };
    let made = unfold(&mesh, &reading, &options, format, &name).map_err(|e| about(&e))?;
    written(&[(path, &made.bytes)], stop)?;
    let report = &made.report;
    let text = format!(
        "{} plates with {} bends, {} lines welded, written to {}",
        report.plates.len(),
        report.bends,
        report.weld_lines.len(),
        path.display()
    );
    Ok(report.warnings.iter().fold(text, |text, warning| format!("{text}; {warning}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_is_stopped_or_written_never_both() {
        let stop = Stop::default();
        assert!(stop.now() && stop.now() && !stop.may_write() && stop.is_wanted());
        let stop = Stop::default();
        assert!(stop.may_write() && stop.may_write() && !stop.now() && !stop.is_wanted());
    }

    #[test]
    fn what_was_stopped_leaves_no_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("flat.dxf");
        let tray = format!("{}/../../samples/desk-tray.obj", env!("CARGO_MANIFEST_DIR"));
        let stop = Stop::default();
        assert!(stop.now());
        assert!(unfold_to(Path::new(&tray), 0.0, &path, &stop).is_err());
        assert!(!path.exists());
        assert!(unfold_to(Path::new(&tray), 0.0, &path, &Stop::default()).is_ok());
        assert!(path.exists());
    }
}
