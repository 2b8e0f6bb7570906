//! Undo and redo without limit, and the commands that a journal holds.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::{Draft, Edit, EditError};

/// What a person does to a design.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "command", rename_all = "snake_case")]
pub enum Command {
    /// A change.
    Edit(Edit),
    /// A change that goes on the one before: a drag or a slider is one entry of the history.
    Continue(Edit),
    /// The last change is taken back; nothing when there is none.
    Undo,
    /// The change taken back last is made again; nothing when there is none.
    Redo,
}

impl Command {
    fn is_overridden_by(&self, edit: &Edit) -> bool {
        matches!(self, Self::Continue(earlier) if edit.overrides(earlier))
    }
}

/// A draft with all that it was.
///
/// Drafts share their bodies; what an entry costs is a template, some tens of kilobytes. Undo and redo are O(1).
#[derive(Clone, Debug)]
pub struct History {
    states: Vec<Arc<Draft>>,
    labels: Vec<String>,
    now: usize,
    journal: Vec<Command>,
}

impl History {
    /// A history that begins with `draft`.
    pub fn new(draft: Draft) -> Self {
        Self { states: vec![Arc::new(draft)], labels: Vec::new(), now: 0, journal: Vec::new() }
    }

    /// The draft as it is.
    pub fn draft(&self) -> &Arc<Draft> {
        &self.states[self.now]
    }

    /// The draft that the journal starts from.
    pub fn first(&self) -> &Arc<Draft> {
        &self.states[0]
    }

    /// Everything done so far.
    pub fn journal(&self) -> &[Command] {
        &self.journal
    }

    /// Labels of all changes, and how many of them hold now.
    pub fn labels(&self) -> (&[String], usize) {
        (&self.labels, self.now)
    }

    /// What undo would take back.
    pub fn undo_label(&self) -> Option<&str> {
        self.now.checked_sub(1).map(|k| self.labels[k].as_str())
    }

    /// What redo would make again.
    pub fn redo_label(&self) -> Option<&str> {
        self.labels.get(self.now).map(String::as_str)
    }

    /// Carries a command out.
    ///
    /// # Errors
    /// [`EditError`]; a refused command changes nothing and is not in the journal.
    pub fn apply(&mut self, command: Command) -> Result<(), EditError> {
        match &command {
            Command::Edit(edit) => {
                let new = edit.apply(self.draft())?;
                self.push(new, edit.label());
            }
            Command::Continue(edit) => {
                let new = edit.apply(self.draft())?;
                let label = edit.label();
                if self.now > 0 && self.now == self.labels.len() && self.labels[self.now - 1] == label {
                    self.states[self.now] = Arc::new(new);
                    // A slider sends sixty values a second; the journal keeps the last, so that it stays short.
                    let last = self.journal.last_mut();
                    if let Some(Command::Continue(last)) = last.filter(|c| c.is_overridden_by(edit)) {
                        *last = edit.clone();
                        return Ok(());
                    }
                } else {
                    self.push(new, label);
                }
            }
            Command::Undo if self.now > 0 => self.now -= 1,
            Command::Redo if self.now < self.labels.len() => self.now += 1,
            Command::Undo | Command::Redo => return Ok(()),
        }
        self.journal.push(command);
        Ok(())
    }

    fn push(&mut self, new: Draft, label: String) {
        self.states.truncate(self.now + 1);
        self.labels.truncate(self.now);
        self.states.push(Arc::new(new));
        self.labels.push(label);
        self.now += 1;
    }
}
