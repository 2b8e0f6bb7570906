//! One call of the binary and what came of it.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

/// What a call left behind.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
    words: String,
}

/// The program that is tested.
pub(crate) fn binary() -> OsString {
    std::env::var_os("TOILE_BIN").unwrap_or_else(|| env!("CARGO_BIN_EXE_toile").into())
}

/// Calls the binary with nothing on standard input.
pub(crate) fn toile<S: AsRef<OsStr>>(words: &[S]) -> Outcome {
    let output = Command::new(binary()).args(words).stdin(Stdio::null()).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the program speaks UTF-8");
    let words = words.iter().map(|w| w.as_ref().to_string_lossy()).collect::<Vec<_>>().join(" ");
    Outcome { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr), words }
}

impl Outcome {
    /// The call must have gone through.
    #[track_caller]
    pub(crate) fn succeeded(self) -> Self {
        assert_eq!(self.code, Some(0), "toile {}\n{}", self.words, self.stderr);
        self
    }

    /// The call must have been refused with `code` and a message for people; `about` must be in it.
    #[track_caller]
    pub(crate) fn refused(self, code: i32, about: &str) -> Self {
        let told = format!("toile {}\n{}", self.words, self.stderr);
        assert_eq!(self.code, Some(code), "{told}");
        assert!(self.stderr.starts_with("error:"), "{told}");
        assert!(!self.stderr.contains("panicked") && !self.stderr.contains("RUST_BACKTRACE"), "{told}");
        assert!(self.stderr.to_lowercase().contains(&about.to_lowercase()), "{about:?} is not said: {told}");
        assert!(self.stderr.len() < 4000, "a message, not a flood: {} bytes", self.stderr.len());
        self
    }

    /// Standard output as JSON.
    #[track_caller]
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.stdout)
            .unwrap_or_else(|e| panic!("toile {}: {e}\n{}", self.words, self.stdout))
    }
}

/// A folder for one test, empty at first, gone at the end.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(crate) fn join(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Writes a file into the folder.
    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    }

    /// Names of everything in the folder, sorted; folders end in `/`.
    pub(crate) fn list(&self) -> Vec<String> {
        list(&self.0)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Names of everything in a folder, sorted; folders end in `/`. Empty when there is no such folder.
pub(crate) fn list(folder: &Path) -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut names: Vec<String> = entries
        .map(|entry| {
            let entry = entry.unwrap();
            let end = if entry.file_type().unwrap().is_dir() { "/" } else { "" };
            format!("{}{end}", entry.file_name().to_string_lossy())
        })
        .collect();
    names.sort();
    names
}

/// A path as a word of a call.
pub(crate) fn word(path: &Path) -> &str {
    path.to_str().expect("test paths are UTF-8")
}

/// `value` must be an object with all of `keys`.
#[track_caller]
pub(crate) fn has_keys(value: &Value, keys: &[&str]) {
    let object = value.as_object().unwrap_or_else(|| panic!("an object with {keys:?}, not {value}"));
    for key in keys {
        assert!(object.contains_key(*key), "key {key:?} is missing among {:?}", object.keys());
    }
}

/// A number of a report.
#[track_caller]
pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("a number, not {value}"))
}
