//! `toile view`: the window.

use std::sync::Arc;

use design::draft::{BodySource, Draft, Mesh, journal, state_folder};

use super::{extension, file_name, is_body_file, read_sheet};
use crate::failure::Failure;
use crate::words::View;

pub(crate) fn run(words: &View) -> Result<(), Failure> {
    let is_mesh = |path: &std::path::Path| {
        is_body_file(path) || !matches!(extension(path).as_str(), "json" | "toile" | "journal")
    };
    let mut model = None;
    let mut body = words.body.clone();
    let mut draft = Draft::empty();
    let mut file = None;
    match &words.file {
        Some(path) if is_mesh(path) => body = Some(path.clone()),
        Some(path) => {
            let bytes = std::fs::read(path)
                .map_err(|e| Failure::new(format!("cannot read {}: {e}", path.display())))?;
            if extension(path) == "journal" {
                let history = journal::replay(&bytes).map_err(|e| Failure::from(e).about(path))?;
                draft = Draft::clone(history.draft());
            } else {
                let (read, kind) = Draft::read(&bytes).map_err(|e| Failure::from(e).about(path))?;
                draft = read;
                file = Some((path.clone(), kind));
            }
        }
        None => {}
    }
    if let Some(path) = &body {
        let mesh = read_sheet(path)?;
        let positions = mesh.positions.iter().map(|p| p.to_array()).collect();
        let faces = mesh.faces.clone();
        draft.body = Arc::new(BodySource::Mesh(Mesh { file: file_name(path), positions, faces }));
        model = Some(mesh);
    }
    let refused = |why: String| {
        Failure::new(format!("cannot open the window: {why}")).remedy(
            "`toile view` needs a display with OpenGL; `toile regenerate` and `toile render` need none",
        )
    };
    if is_without_display() {
        return Err(refused("there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set)".to_owned()));
    }
    let start = window::Start { draft, file, model, state: state_folder() };
    window::run(window::Designer::new(start)).map_err(|e| refused(e.to_string()))
}

/// Where windows need a display server, whether none is named.
fn is_without_display() -> bool {
    let is_unset = |name: &str| std::env::var_os(name).is_none_or(|v| v.is_empty());
    cfg!(target_os = "linux") && ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].iter().all(|v| is_unset(v))
}
