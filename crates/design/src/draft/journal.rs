//! The journal: a draft and every command after it, a JSON value a line. Replayed headless it gives the same draft.

use super::{Command, Draft, DraftFileError, History};

/// The journal's bytes: the first draft's file as one line, then a line a command.
pub fn to_bytes(history: &History) -> Vec<u8> {
    let mut bytes = history.first().to_bytes();
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
