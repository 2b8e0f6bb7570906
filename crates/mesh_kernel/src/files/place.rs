//! Putting a finished file in its place.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

/// Writes `bytes` beside `path` and renames: whoever looks sees the old file or the whole new one.
///
/// # Errors
/// What the file system says; nothing is left beside `path` then.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> io::Result<()> {
    // Two threads may write the same path at once; each needs a name of its own.
    static COUNTER: AtomicU32 = AtomicU32::new(0);
    let Some(name) = path.file_name() else {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "the path names no file"));
    };
    let mut beside = std::ffi::OsString::from(".");
    beside.push(name);
    beside.push(format!(".{}-{}.part", std::process::id(), COUNTER.fetch_add(1, Ordering::Relaxed)));
    let beside = path.with_file_name(beside);
    let written = File::create_new(&beside)
        .and_then(|mut file| {
            file.write_all(bytes)?;
            file.sync_all()
        })
        .and_then(|()| fs::rename(&beside, path));
    if written.is_err() {
        // The first error is the one that tells; a leftover that cannot be removed adds nothing.
        let _ = fs::remove_file(&beside);
    }
    written
}
