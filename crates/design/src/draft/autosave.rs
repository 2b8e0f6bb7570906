//! Work that survives a kill: journals written in the background, found again at the next start.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use mesh_kernel::files::write_atomically;

use super::{DraftFileError, History, journal};

/// At most this much work is lost.
const EVERY: Duration = Duration::from_secs(2);

/// Where work in progress is kept: `$XDG_STATE_HOME/toile`, else `~/.local/state/toile`, else beside temporary files.
pub fn state_folder() -> PathBuf {
    let set = |name: &str| std::env::var_os(name).filter(|v| !v.is_empty()).map(PathBuf::from);
    set("XDG_STATE_HOME")
        .or_else(|| set("HOME").map(|home| home.join(".local/state")))
        .unwrap_or_else(std::env::temp_dir)
        .join("toile")
}

/// Saves a history in the background while it lives; dropped, it removes what it saved, for work was ended in order.
#[derive(Debug)]
pub struct Autosave {
    sender: Option<Sender<History>>,
    writer: Option<JoinHandle<()>>,
    path: PathBuf,
}

impl Autosave {
    /// Starts saving into `folder`, which is made when missing. What cannot be written is tried again at the next change.
    pub fn start(folder: &Path) -> Self {
        let stamp =
            std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |d| d.as_nanos());
        let path = folder.join(format!("{}-{stamp}.journal", std::process::id()));
        let (sender, receiver) = channel();
        let to = path.clone();
        let writer = std::thread::spawn(move || write_changes(&to, &receiver));
        Self { sender: Some(sender), writer: Some(writer), path }
    }

    /// The history has changed. Returns at once.
    pub fn changed(&self, history: &History) {
        if let Some(sender) = &self.sender {
            // The writer ends only with this value.
            let _ = sender.send(history.clone());
        }
    }

    /// Saves now, in the foreground: work that was taken over from another journal must be in this one before that one goes.
    ///
    /// # Errors
    /// What the system says.
    pub fn save_now(&self, history: &History) -> std::io::Result<()> {
        if let Some(folder) = self.path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        write_atomically(&self.path, &journal::to_bytes(history))
    }

    /// Where it saves.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

fn write_changes(path: &Path, receiver: &Receiver<History>) {
    let mut last: Option<Instant> = None;
    let mut waiting: Option<History> = None;
    loop {
        let patience = match (&waiting, last) {
            (None, _) => Duration::from_secs(3600),
            (Some(_), None) => Duration::ZERO,
            (Some(_), Some(last)) => EVERY.saturating_sub(last.elapsed()),
        };
        match receiver.recv_timeout(patience) {
            Ok(history) => waiting = Some(history),
            Err(RecvTimeoutError::Disconnected) => return,
            Err(RecvTimeoutError::Timeout) => {
                let Some(history) = waiting.take() else { continue };
                let made = path.parent().is_none_or(|folder| std::fs::create_dir_all(folder).is_ok());
                if made {
                    // A full disk must not stop the work; the next change tries again.
                    let _ = write_atomically(path, &journal::to_bytes(&history));
                }
                last = Some(Instant::now());
            }
        }
    }
}

impl Drop for Autosave {
    fn drop(&mut self) {
        self.sender = None;
        if let Some(writer) = self.writer.take() {
            // A writer that panicked has nothing more to write.
            let _ = writer.join();
        }
        let _ = std::fs::remove_file(&self.path);
    }
}

/// Work that a program left behind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recovery {
    /// The journal.
    pub path: PathBuf,
}

impl Recovery {
    /// The work as it was.
    ///
    /// # Errors
    /// [`DraftFileError`].
    pub fn open(&self) -> Result<History, DraftFileError> {
        let bytes = std::fs::read(&self.path).map_err(|e| DraftFileError::Format(e.to_string()))?;
        journal::replay(&bytes)
    }

    /// Throws it away; a file that is gone already is no error.
    pub fn discard(&self) {
        let _ = std::fs::remove_file(&self.path);
    }
}

/// Journals in `folder` whose programs run no more, in order of their names.
pub fn recoveries(folder: &Path) -> Vec<Recovery> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut found: Vec<Recovery> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|e| e == "journal") && !runs(path))
        .map(|path| Recovery { path })
        .collect();
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

/// Whether the program that a journal is named after still runs. Without `/proc` only our own is known.
fn runs(path: &Path) -> bool {
    let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let Some(id) = stem.split('-').next().and_then(|s| s.parse::<u32>().ok()) else { return false };
    id == std::process::id() || Path::new("/proc").join(id.to_string()).exists()
}
