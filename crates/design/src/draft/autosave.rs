//! Work that survives a kill: journals written in the background, found again at the next start.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use mesh_kernel::files::write_atomically;

use super::journal::{Journal, SourceFile};
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

/// What the writer is told.
#[derive(Debug)]
enum News {
    /// The work, and the file that it is of.
    Changed(History, Option<SourceFile>),
    /// All of it is in its file.
    Saved,
}

/// Saves a history in the background while it lives; dropped, it removes what it saved, for work was ended in order.
#[derive(Debug)]
pub struct Autosave {
    sender: Option<Sender<News>>,
    writer: Option<JoinHandle<()>>,
    place: Arc<Place>,
}

impl Autosave {
    /// Starts saving into `folder`, which is made when missing. What cannot be written is tried again at the next change.
    pub fn start(folder: &Path) -> Self {
        let stamp =
            std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |d| d.as_nanos());
        let path = folder.join(format!("{}-{stamp}.journal", std::process::id()));
        let (sender, receiver) = channel();
        let place = Arc::new(Place { path, lock: Mutex::new(None) });
        let to = Arc::clone(&place);
        let writer = std::thread::spawn(move || write_changes(&to, &receiver));
        Self { sender: Some(sender), writer: Some(writer), place }
    }

    /// The history has changed since it was in `file`. Returns at once.
    pub fn changed(&self, history: &History, file: Option<&SourceFile>) {
        self.tell(News::Changed(history.clone(), file.cloned()));
    }

    /// All work is in its file: nothing is left to be recovered. Returns at once.
    pub fn saved(&self) {
        self.tell(News::Saved);
    }

    fn tell(&self, news: News) {
        if let Some(sender) = &self.sender {
            // The writer ends only with this value.
            let _ = sender.send(news);
        }
    }

    /// Saves now, in the foreground: work that was taken over from another journal must be in this one before that one goes.
    ///
    /// # Errors
    /// What the system says.
    pub fn save_now(&self, history: &History, file: Option<&SourceFile>) -> std::io::Result<()> {
        self.place.write(history, file)
    }

    /// Where it saves.
    pub fn path(&self) -> &Path {
        &self.place.path
    }
}

/// A journal's file, and the lock beside it that tells others that its program runs: systems let go of locks however a
/// program ends.
#[derive(Debug)]
struct Place {
    path: PathBuf,
    lock: Mutex<Option<File>>,
}

impl Place {
    fn write(&self, history: &History, file: Option<&SourceFile>) -> std::io::Result<()> {
        if let Some(folder) = self.path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        let mut lock = self.lock.lock().unwrap_or_else(PoisonError::into_inner);
        if lock.is_none() {
            *lock = locked(&lock_of(&self.path));
        }
        write_atomically(&self.path, &journal::to_bytes_of(history, file))
    }

    fn clear(&self) {
        let _ = std::fs::remove_file(&self.path);
    }
}

/// Makes a file that is locked from the moment that it has its name; nothing where the system has no locks.
fn locked(path: &Path) -> Option<File> {
    let before = path.with_extension("locking");
    let file = File::create(&before).ok()?;
    let made = file.try_lock().is_ok() && std::fs::rename(&before, path).is_ok();
    if !made {
        let _ = std::fs::remove_file(&before);
    }
    made.then_some(file)
}

fn lock_of(journal: &Path) -> PathBuf {
    journal.with_extension("lock")
}

fn write_changes(place: &Place, receiver: &Receiver<News>) {
    let mut last: Option<Instant> = None;
    let mut waiting = None;
    loop {
        let patience = match (&waiting, last) {
            (None, _) => Duration::from_secs(3600),
            (Some(_), None) => Duration::ZERO,
            (Some(_), Some(last)) => EVERY.saturating_sub(last.elapsed()),
        };
        match receiver.recv_timeout(patience) {
            Ok(News::Changed(history, file)) => waiting = Some((history, file)),
            Ok(News::Saved) => {
                waiting = None;
                place.clear();
            }
            Err(RecvTimeoutError::Disconnected) => return,
            Err(RecvTimeoutError::Timeout) => {
                let Some((history, file)) = waiting.take() else { continue };
                // A full disk must not stop the work; the next change tries again.
                let _ = place.write(&history, file.as_ref());
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
        // What a panic ends is what a journal is for.
        if std::thread::panicking() {
            return;
        }
        self.place.clear();
        let _ = std::fs::remove_file(lock_of(&self.place.path));
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
    pub fn open(&self) -> Result<Journal, DraftFileError> {
        let bytes = std::fs::read(&self.path).map_err(|e| DraftFileError::Format(e.to_string()))?;
        Journal::read(&bytes)
    }

    /// Throws it away; a file that is gone already is no error.
    pub fn discard(&self) {
        let _ = std::fs::remove_file(&self.path);
        let _ = std::fs::remove_file(lock_of(&self.path));
    }
}

/// Journals in `folder` whose programs run no more, in order of their names. Locks that such programs left are removed.
pub fn recoveries(folder: &Path) -> Vec<Recovery> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let entries: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    for lock in entries.iter().filter(|path| path.extension().is_some_and(|e| e == "lock")) {
        let journal = lock.with_extension("journal");
        if !journal.exists() && !runs(&journal) {
            let _ = std::fs::remove_file(lock);
        }
    }
    let mut found: Vec<Recovery> = entries
        .into_iter()
        .filter(|path| path.extension().is_some_and(|e| e == "journal") && !runs(path))
        .map(|path| Recovery { path })
        .collect();
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

/// Whether the program that writes a journal still runs: its lock is held, or cannot be told from a held one. Where there are no locks none does.
fn runs(journal: &Path) -> bool {
    // Network file systems lock only what is open to be written.
    match File::options().read(true).write(true).open(lock_of(journal)) {
        Ok(lock) => lock.try_lock().is_err(),
        Err(error) => error.kind() != std::io::ErrorKind::NotFound,
    }
}
