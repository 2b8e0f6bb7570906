//! What went wrong, in the user's words: what, where, what to do.

use std::fmt;
use std::path::Path;

/// A failed command.
#[derive(Debug)]
pub(crate) struct Failure {
    what: String,
    remedy: Option<String>,
    code: u8,
}

impl Failure {
    /// The input or the result is not acceptable: exit 1.
    pub(crate) fn new(what: impl fmt::Display) -> Self {
        Self { what: what.to_string(), remedy: None, code: 1 }
    }

    /// The call's words are wrong: exit 2.
    pub(crate) fn words(what: impl fmt::Display) -> Self {
        Self { what: what.to_string(), remedy: None, code: 2 }
    }

    /// Names the file that it is about, unless the message does already.
    pub(crate) fn about(mut self, path: &Path) -> Self {
        let name = path.display().to_string();
        if !self.what.contains(&name) {
            self.what = format!("{name}: {}", self.what);
        }
        self
    }

    /// Adds what the user can do.
    pub(crate) fn remedy(mut self, remedy: impl fmt::Display) -> Self {
        self.remedy = Some(remedy.to_string());
        self
    }

    pub(crate) fn exit_code(&self) -> u8 {
        self.code
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "error: {}", self.what)?;
        if let Some(remedy) = &self.remedy {
            write!(f, "\n  help: {remedy}")?;
        }
        Ok(())
    }
}

impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        let mut what = error.to_string();
        let mut source = error.source();
        while let Some(cause) = source {
            let cause_text = cause.to_string();
            if !what.contains(&cause_text) {
                what.push_str(": ");
                what.push_str(&cause_text);
            }
            source = cause.source();
        }
        // A message may quote a name from a file, and names may be of any length.
        if let Some((end, _)) = what.char_indices().nth(LONGEST) {
            what.truncate(end);
            what.push('…');
        }
        Self::new(what)
    }
}

/// Most characters of a message.
const LONGEST: usize = 1500;
