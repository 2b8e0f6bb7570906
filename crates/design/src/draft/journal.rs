//! The journal: a draft and every command after it, a JSON value a line. Replayed headless it gives the same draft.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::{Command, Draft, DraftFileError, FileKind, History};
use crate::fingerprint::Fingerprint;

/// The file that the work in a journal is of.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SourceFile {
    /// Where it is.
    pub path: PathBuf,
    /// What it is.
    pub kind: FileKind,
    /// Of what was in it when it was read or written last; `None`: not known.
    pub fingerprint: Option<String>,
}

impl SourceFile {
    /// A file that holds, or held, these bytes.
    pub fn holding(path: PathBuf, kind: FileKind, bytes: &[u8]) -> Self {
        Self { path, kind, fingerprint: Some(fingerprint(bytes)) }
    }

    /// Whether something else has written it since. A file that is gone, or cannot be read, has nothing to lose.
    pub fn is_changed(&self) -> bool {
        let now = std::fs::read(&self.path).ok().map(|bytes| fingerprint(&bytes));
        now.is_some() && now != self.fingerprint
    }
}

fn fingerprint(bytes: &[u8]) -> String {
    Fingerprint::default().with(bytes).text()
}

/// What a journal holds.
#[derive(Clone, Debug)]
pub struct Journal {
    /// The work.
    pub history: History,
    /// The file that it is of, where there is one.
    pub file: Option<SourceFile>,
}

impl Journal {
    /// Replays a journal.
    ///
    /// # Errors
    /// As [`replay`].
    pub fn read(bytes: &[u8]) -> Result<Self, DraftFileError> {
        #[derive(Deserialize)]
        struct Head {
            file: Option<SourceFile>,
        }
        let history = replay(bytes)?;
        // Journals of other programs may know no file, or say it in another way.
        let first = bytes.split(|b| *b == b'\n').find(|line| !line.is_empty()).unwrap_or_default();
        let file = serde_json::from_slice::<Head>(first).ok().and_then(|head| head.file);
        Ok(Self { history, file })
    }
}

/// The journal's bytes: the first draft's file as one line, then a line a command.
pub fn to_bytes(history: &History) -> Vec<u8> {
    to_bytes_of(history, None)
}

/// The same, with the file that the work is of beside the first draft.
pub fn to_bytes_of(history: &History, file: Option<&SourceFile>) -> Vec<u8> {
    let mut bytes = history.first().to_bytes_with(file);
    for command in history.journal() {
        // Commands hold names and finite numbers only, or numbers that become null and are refused on reading.
        bytes.extend(serde_json::to_vec(command).unwrap_or_default());
        bytes.push(b'\n');
    }
    bytes
}

/// Replays a journal.
///
/// # Errors
/// [`DraftFileError`]: a first line that is no draft, a line that is no command (with its number), a command that is refused.
pub fn replay(bytes: &[u8]) -> Result<History, DraftFileError> {
    let mut lines = bytes.split(|b| *b == b'\n').filter(|line| !line.is_empty());
    let mut history = History::new(Draft::from_bytes(lines.next().unwrap_or_default())?);
    for (k, line) in lines.enumerate() {
        let command: Command = serde_json::from_slice(line)
            .map_err(|e| DraftFileError::Format(format!("line {} of the journal: {e}", k + 2)))?;
        history.apply(command)?;
    }
    Ok(history)
}
