//! Putting finished files in their places.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// Writes `bytes` beside `path` and renames: whoever looks sees the old file or the whole new one.
///
/// A symbolic link stays one: the file that it leads to is written. A file that was there hands its permissions on; one that may not be written is
/// not. What is no file, a pipe say, is written as it is, and what a program's output goes to, as `/dev/stdout`, gets it at its end.
///
/// # Errors
/// What the file system says; nothing is left beside `path` then.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> io::Result<()> {
    Part::write(path, bytes)?.place()
}

/// Files that belong together: all are written beside their places first and renamed last, so that a full disk, or a place
/// that cannot be written, leaves the old ones.
///
/// Each is put in place as by [`write_atomically`]. What is not placed leaves nothing behind.
#[derive(Debug, Default)]
pub struct FileSet {
    parts: Vec<Part>,
}

/// A file of a set that could not be put in its place.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {path}: {source}", path = path.display())]
pub struct NotPlaced {
    /// Its place.
    pub path: PathBuf,
    /// What the system says.
    pub source: io::Error,
}

impl FileSet {
    /// Writes a file beside its place.
    ///
    /// # Errors
    /// [`NotPlaced`]; also when the set has another file for that place.
    pub fn add(&mut self, path: &Path, bytes: &[u8]) -> Result<(), NotPlaced> {
        let refused = |source: io::Error| NotPlaced { path: path.to_owned(), source };
        let part = Part::write(path, bytes).map_err(refused)?;
        let is_same = |other: &Part| matches!(part.state, State::Beside(_)) && other.path == part.path;
        if self.parts.iter().any(is_same) {
            let text = "two files would be written to this one place; give one of them another name";
            return Err(refused(io::Error::new(io::ErrorKind::AlreadyExists, text)));
        }
        self.parts.push(part);
        Ok(())
    }

    /// Puts all files in their places, in the order in which they were added.
    ///
    /// # Errors
    /// [`NotPlaced`]: none is placed when one of the places is a folder; those before it are when the system refuses another.
    pub fn place(self) -> Result<(), NotPlaced> {
        if let Some(part) = self.parts.iter().find(|p| p.path.is_dir()) {
            let source = io::Error::from(io::ErrorKind::IsADirectory);
            return Err(NotPlaced { path: part.path.clone(), source });
        }
        for part in self.parts {
            let path = part.path.clone();
            part.place().map_err(|source| NotPlaced { path, source })?;
        }
        Ok(())
    }
}

/// A file that is written and not in its place yet.
#[derive(Debug)]
struct Part {
    path: PathBuf,
    state: State,
}

#[derive(Debug)]
enum State {
    /// Written under this name.
    Beside(PathBuf),
    /// To be written to what is no file.
    Waiting(Vec<u8>),
    Placed,
}

impl Part {
    fn write(path: &Path, bytes: &[u8]) -> io::Result<Self> {
        // Two threads may write the same path at once; each needs a name of its own.
        static COUNTER: AtomicU32 = AtomicU32::new(0);
        let earlier = fs::metadata(path).ok();
        let is_file = earlier.as_ref().is_none_or(|e| e.is_file() || e.is_dir());
        let Some(path) = followed(path)?.filter(|_| is_file) else {
            return Ok(Self { path: path.to_owned(), state: State::Waiting(bytes.to_vec()) });
        };
        if earlier.as_ref().is_some_and(|e| e.is_file() && e.permissions().readonly()) {
            return Err(io::Error::new(
                io::ErrorKind::PermissionDenied,
                "it is protected from being written",
            ));
        }
        let Some(name) = path.file_name() else {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "the path names no file"));
        };
        let mut beside = std::ffi::OsString::from(".");
        beside.push(name);
        beside.push(format!(".{}-{}.part", std::process::id(), COUNTER.fetch_add(1, Ordering::Relaxed)));
        let beside = path.with_file_name(beside);
        let mut file = File::create_new(&beside)?;
        // From here on it is removed when anything fails.
        let part = Self { path, state: State::Beside(beside) };
        // Before there is anything in it to be seen.
        if let Some(earlier) = earlier.filter(fs::Metadata::is_file) {
            file.set_permissions(earlier.permissions())?;
        }
        file.write_all(bytes)?;
        file.sync_all()?;
        Ok(part)
    }

    fn place(mut self) -> io::Result<()> {
        match &self.state {
            State::Beside(beside) => fs::rename(beside, &self.path)?,
            State::Waiting(bytes) => File::options().append(true).open(&self.path)?.write_all(bytes)?,
            State::Placed => {}
        }
        self.state = State::Placed;
        Ok(())
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        if let State::Beside(beside) = &self.state {
            // The first error is the one that tells; a leftover that cannot be removed adds nothing.
            let _ = fs::remove_file(beside);
        }
    }
}

/// Where symbolic links lead, whether there is a file or not; `None` if that is what a program has open: a file by that name is not what is asked
/// for.
fn followed(path: &Path) -> io::Result<Option<PathBuf>> {
    /// As many as systems follow themselves.
    const LINKS: usize = 40;
    let mut path = path.to_owned();
    for _ in 0..LINKS {
        if ["/dev/fd", "/proc"].iter().any(|system| path.starts_with(system)) {
            return Ok(None);
        }
        match fs::read_link(&path) {
            // What is no link, or not there, is where the way ends.
            Err(_) => return Ok(Some(path)),
            Ok(next) => path = path.parent().unwrap_or(Path::new("")).join(next),
        }
    }
    Err(io::Error::other("symbolic links lead round in a circle"))
}
