//! `toile view`: the window.

use std::sync::Arc;

use design::draft::{BodySource, Draft, Mesh};

use super::{extension, file_name, read_mesh};
use crate::failure::Failure;
use crate::words::View;

pub(crate) fn run(words: &View) -> Result<(), Failure> {
    let is_mesh = |path: &std::path::Path| !matches!(extension(path).as_str(), "json" | "toile" | "journal");
    let mut body = words.body.clone();
    let mut draft = Draft::empty();
    let mut file = None;
    match &words.file {
        Some(path) if is_mesh(path) => body = Some(path.clone()),
        Some(path) => {
            let bytes = std::fs::read(path)
                .map_err(|e| Failure::new(format!("cannot read {}: {e}", path.display())))?;
            draft = Draft::from_bytes(&bytes).map_err(|e| Failure::from(e).about(path))?;
            file = Some(path.clone());
        }
        None => {}
    }
    if let Some(path) = &body {
        let mesh = read_mesh(path)?;
        let positions = mesh.positions.iter().map(|p| p.to_array()).collect();
        draft.body = Arc::new(BodySource::Mesh(Mesh { file: file_name(path), positions, faces: mesh.faces }));
    }
    window::run(window::Designer::new(draft, file)).map_err(|e| {
        Failure::new(format!("cannot open the window: {e}")).remedy(
            "`toile view` needs a display with OpenGL; `toile regenerate` and `toile render` need none",
        )
    })
}
