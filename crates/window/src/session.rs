//! The design under work: its history, its file, what is selected in it.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use design::draft::{Autosave, Command, Draft, Edit, EditError, History, SourceFile};
use eframe::egui;

use crate::files::holds_work;
use crate::selection::{Mode, Selection};

/// A design that is being worked on.
pub(crate) struct Session {
    history: History,
    autosave: Autosave,
    /// The file that it came from or was saved to.
    pub(crate) file: Option<SourceFile>,
    /// The draft that the file holds.
    saved: Arc<Draft>,
    pub(crate) selection: Selection,
    pub(crate) mode: Mode,
    /// New faces go to this surface.
    pub(crate) surface: String,
    /// What is dragged: its commands go on each other.
    gesture: Option<egui::Id>,
}

impl Session {
    /// Begins with a history; what of it is not in `file` counts as unsaved.
    pub(crate) fn new(history: History, file: Option<SourceFile>, is_saved: bool, state: &Path) -> Self {
        let surfaces = &history.draft().template.surfaces;
        let surface = surfaces.keys().next().cloned().unwrap_or_else(|| "surface".to_owned());
        // A draft that no state of the history is: everything is unsaved.
        let saved = if is_saved { Arc::clone(history.draft()) } else { Arc::new(Draft::empty()) };
        Self {
            history,
            autosave: Autosave::start(state),
            file,
            saved,
            selection: Selection::default(),
            mode: Mode::default(),
            surface,
            gesture: None,
        }
    }

    pub(crate) fn draft(&self) -> &Arc<Draft> {
        self.history.draft()
    }

    pub(crate) fn history(&self) -> &History {
        &self.history
    }

    /// Whether work would be lost without saving.
    pub(crate) fn is_unsaved(&self) -> bool {
        !Arc::ptr_eq(&self.saved, self.history.draft())
    }

    /// The draft is in this file now, or what that holds of it: then the journal stays.
    pub(crate) fn saved_to(&mut self, file: SourceFile) {
        let is_whole = holds_work(file.kind, self.history.draft());
        self.file = Some(file);
        if is_whole {
            self.saved = Arc::clone(self.history.draft());
            self.autosave.saved();
        }
    }

    /// The file as a journal names it, for a program that starts elsewhere.
    fn file_from_anywhere(&self) -> Option<SourceFile> {
        let file = self.file.clone()?;
        let path = std::path::absolute(&file.path).unwrap_or_else(|_| file.path.clone());
        Some(SourceFile { path, ..file })
    }

    /// The work was taken over from another journal: this one must hold it before that one goes.
    pub(crate) fn keep_now(&self) -> std::io::Result<()> {
        self.autosave.save_now(&self.history, self.file_from_anywhere().as_ref())
    }

    /// Carries a command out; what was dragged is let go.
    pub(crate) fn apply(&mut self, command: Command) -> Result<(), EditError> {
        self.gesture = None;
        self.carry_out(command)
    }

    /// A step of a drag that `gesture` names: the first is an entry of the history, the others go on it.
    pub(crate) fn live(&mut self, gesture: egui::Id, edit: Edit) -> Result<(), EditError> {
        let command =
            if self.gesture == Some(gesture) { Command::Continue(edit) } else { Command::Edit(edit) };
        self.carry_out(command)?;
        self.gesture = Some(gesture);
        Ok(())
    }

    /// The drag is over; whether there was one.
    pub(crate) fn settle(&mut self) -> bool {
        self.gesture.take().is_some()
    }

    fn carry_out(&mut self, command: Command) -> Result<(), EditError> {
        self.history.apply(command)?;
        if self.is_unsaved() {
            self.autosave.changed(&self.history, self.file_from_anywhere().as_ref());
        } else {
            // Undone to what the file holds.
            self.autosave.saved();
        }
        Ok(())
    }

    /// A name for people and for files that are made of the design.
    pub(crate) fn name(&self) -> String {
        let stem = self.file.as_ref().and_then(|f| f.path.file_stem());
        stem.map_or_else(|| "untitled".to_owned(), |s| s.to_string_lossy().into_owned())
    }

    /// A path beside the design's file, or in the folder where the program runs.
    pub(crate) fn beside(&self, name: &str) -> PathBuf {
        let folder = self.file.as_ref().and_then(|f| f.path.parent()).map(Path::to_owned);
        folder.unwrap_or_default().join(name)
    }
}
