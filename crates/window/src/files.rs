//! Files in and out: opened whole or not at all, saved as what they are.

use std::path::{Path, PathBuf};
use std::time::Instant;

use design::draft::{BodySource, Draft, FileKind, History, Journal, Mesh, SourceFile};
use design::regenerate::{Artifact, ExportStep, Regenerated};
use mesh_kernel::files::{Format, write_atomically};
use sketch::Drawing;
use template::Template;

use crate::workshop::Stop;

/// What was in a file.
pub(crate) enum Opened {
    Design {
        history: History,
        file: SourceFile,
    },
    /// Work as a journal holds it.
    Journal(Journal),
    Body(Mesh),
}

/// Larger files are no designs and would only fill the memory, bytes.
const LARGEST: u64 = 2 << 30;

/// Reads a design, a template, a journal or a body's mesh.
///
/// # Errors
/// One sentence: what is wrong with the file.
pub(crate) fn open(path: &Path) -> Result<Opened, String> {
    let name = path.display();
    let about = |e: &dyn std::fmt::Display| format!("{name} was not opened: {e}");
    let facts = std::fs::metadata(path).map_err(|e| about(&e))?;
    if facts.is_dir() {
        return Err(about(&"it is a folder; choose a file in it"));
    }
    if facts.len() > LARGEST {
        return Err(about(&"it is larger than two gigabytes"));
    }
    if Format::of_path(path).is_some() {
        let mesh = mesh_kernel::files::read(path).map_err(|e| about(&e))?;
        if mesh.faces.is_empty() {
            return Err(about(&"its mesh has no faces"));
        }
        let file = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let positions = mesh.positions.iter().map(|p| p.to_array()).collect();
        return Ok(Opened::Body(Mesh { file, positions, faces: mesh.faces }));
    }
    let bytes = std::fs::read(path).map_err(|e| about(&e))?;
    if path.extension().is_some_and(|e| e == "journal") {
        return Journal::read(&bytes).map(Opened::Journal).map_err(|e| about(&e));
    }
    let (draft, kind) = Draft::read(&bytes).map_err(|e| about(&e))?;
    let file = SourceFile::holding(path.to_owned(), kind, &bytes);
    Ok(Opened::Design { history: History::new(draft), file })
}

/// What a draft becomes under a name: a `.json` is a template, everything else a draft.
pub(crate) fn kind_of_name(path: &Path) -> FileKind {
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json")) {
        FileKind::Template
    } else {
        FileKind::Draft
    }
}

/// Writes a draft whole or not at all.
///
/// # Errors
/// One sentence.
pub(crate) fn save(draft: &Draft, path: &Path) -> Result<SourceFile, String> {
    let kind = kind_of_name(path);
    let bytes = match kind {
        FileKind::Template => {
            let template = Template::from_file(draft.template.clone())
                .map_err(|e| format!("a template that is not complete is saved as a .toile only: {e}"))?;
            template.to_json().into_bytes()
        }
        FileKind::Draft | FileKind::Design => draft.to_bytes(),
    };
    let written = write_atomically(path, &bytes);
    written
        .map(|()| SourceFile::holding(path.to_owned(), kind, &bytes))
        .map_err(|e| format!("{} could not be saved: {e}; choose another place", path.display()))
}

/// Whether a file of some kind holds all that was made. A template is without the body, which has a file of its own.
pub(crate) fn holds_work(kind: FileKind, draft: &Draft) -> bool {
    let is_made =
        !draft.wires.is_empty() || !draft.features.is_empty() || draft.drawing != Drawing::default();
    kind != FileKind::Template || !is_made
}

/// What a template file does not hold of a draft, in words; `None` when it holds all.
pub(crate) fn left_out(draft: &Draft) -> Option<String> {
    let wires = draft.wires.len();
    let curves = draft.features.len();
    let body = *draft.body != BodySource::default();
    let parts = [
        (wires > 0).then(|| format!("{wires} edges without faces")),
        (curves > 0).then(|| format!("{curves} drawn curves")),
        body.then(|| "the body".to_owned()),
        (draft.drawing != Drawing::default()).then(|| "the drawing board".to_owned()),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    (!parts.is_empty()).then(|| parts.join(", "))
}

/// Writes all files of a garment into a folder.
///
/// # Errors
/// One sentence.
pub(crate) fn export(made: &Regenerated, folder: &Path, stop: &Stop) -> Result<String, String> {
    // The report learns its seconds while it is written.
    let mut made = made.clone();
    let goes_on = |step: ExportStep| match step {
        ExportStep::Making => !stop.is_wanted(),
        ExportStep::Writing => stop.may_write(),
    };
    made.write_while(folder, &Artifact::DEFAULT, Instant::now(), &goes_on).map_err(|e| e.to_string())?;
    Ok(format!("exported to {}", folder.display()))
}

/// Templates that come with the program.
pub(crate) const LIBRARY: [(&str, &str); 2] = [
    ("Princess-line dress", include_str!("../../../samples/princess-dress.json")),
    ("Fitted bodice", include_str!("../../../samples/fitted-bodice.json")),
];

/// Files of a folder that can be opened, and its folders.
pub(crate) fn listing(folder: &Path) -> (Vec<PathBuf>, Vec<PathBuf>) {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = std::fs::read_dir(folder).map(|all| all.flatten().map(|e| e.path()).collect::<Vec<_>>());
    let mut entries = entries.unwrap_or_default();
    entries.retain(|p| p.file_name().is_some_and(|n| !n.to_string_lossy().starts_with('.')));
    entries.sort();
    let (folders, files): (Vec<_>, Vec<_>) = entries.into_iter().partition(|p| p.is_dir());
    let known = |p: &PathBuf| {
        let other = p.extension().is_some_and(|e| ["toile", "json", "journal"].iter().any(|k| e == *k));
        other || Format::of_path(p).is_some()
    };
    (folders, files.into_iter().filter(known).collect())
}
