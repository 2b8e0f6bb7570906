//! What a person has chosen for all designs, kept between runs.

use std::path::{Path, PathBuf};

use mesh_kernel::files::write_atomically;
use serde::{Deserialize, Serialize};

use crate::layout::{Layout, NamedLayout};
use crate::units::LengthUnit;

/// As many files are remembered.
const RECENT: usize = 10;

/// How light the window is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Theme {
    /// As the system says.
    #[default]
    System,
    Light,
    Dark,
}

/// Choices and recent files. A file that cannot be read counts as none: a window must open.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct Preferences {
    pub(crate) unit: LengthUnit,
    pub(crate) theme: Theme,
    pub(crate) recent: Vec<PathBuf>,
    /// Draw without OpenGL.
    pub(crate) software: bool,
    /// The panels as they are.
    pub(crate) layout: Layout,
    /// Arrangements that were kept.
    pub(crate) layouts: Vec<NamedLayout>,
}

impl Preferences {
    pub(crate) fn load(folder: &Path) -> Self {
        let bytes = std::fs::read(place(folder)).unwrap_or_default();
        serde_json::from_slice(&bytes).unwrap_or_default()
    }

    /// Keeps them; what cannot be written is forgotten at the end of the run, which is no reason to stop anybody.
    pub(crate) fn save(&self, folder: &Path) {
        let made = std::fs::create_dir_all(folder).is_ok();
        if let (true, Ok(bytes)) = (made, serde_json::to_vec_pretty(self)) {
            let _ = write_atomically(&place(folder), &bytes);
        }
    }

    /// The file was opened or saved last.
    pub(crate) fn remember(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.recent.retain(|p| *p != path);
        self.recent.insert(0, path);
        self.recent.truncate(RECENT);
    }
}

fn place(folder: &Path) -> PathBuf {
    folder.join("window.json")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_come_back_and_a_broken_file_counts_as_none() {
        let folder = tempfile::tempdir().unwrap();
        let mut chosen = Preferences { unit: LengthUnit::Inch, theme: Theme::Dark, ..Preferences::default() };
        for k in 0..20 {
            chosen.remember(Path::new(&format!("/tmp/{k}.toile")));
        }
        chosen.remember(Path::new("/tmp/15.toile"));
        assert_eq!(chosen.recent.len(), RECENT);
        assert_eq!(chosen.recent[0], Path::new("/tmp/15.toile"));
        chosen.save(folder.path());
        assert_eq!(Preferences::load(folder.path()), chosen);
        std::fs::write(place(folder.path()), "{\"unit\":").unwrap();
        assert_eq!(Preferences::load(folder.path()), Preferences::default());
    }
}
