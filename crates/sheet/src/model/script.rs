//! Scripts: modelling commands as text.

use serde::Deserialize;
use serde_json::value::RawValue;

use super::{Command, Done, Limits, Model, ModelError};

/// The newest version of scripts.
const VERSION: u64 = 1;

/// A list of commands with the lines on which they stand.
#[derive(Clone, Debug, PartialEq)]
pub struct Script {
    /// Farthest that chords may be from curves, in millimetres.
    pub tolerance: f64,
    /// Commands, each with its first line, counted from 1.
    pub commands: Vec<(usize, Command)>,
}

/// A model that a script made.
#[derive(Clone, Debug, PartialEq)]
pub struct ScriptRun {
    /// The model.
    pub model: Model,
    /// What every command did.
    pub done: Vec<Done>,
}

/// What is wrong with a script. Nothing of it counts then.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ScriptError {
    /// It is no JSON of a script.
    #[error("line {line}: {why}")]
    Text {
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        why: String,
    },
    /// A newer script than this program knows.
    #[error("the script is of version {found}; this program reads versions up to {VERSION}")]
    Version {
        /// Its version.
        found: u64,
    },
    /// A number of the script's head is out of range.
    #[error("the tolerance is {value}, but must be a finite number above 0")]
    Tolerance {
        /// What it was.
        value: f64,
    },
    /// A command is not understood.
    #[error("line {line}, command {number}{}: {why}", .name.as_ref().map_or_else(String::new, |n| format!(" ({n})")))]
    Unreadable {
        /// Its first line, or that of what is wrong in it, from 1.
        line: usize,
        /// Its number, from 1.
        number: usize,
        /// Its name, where that can be read.
        name: Option<String>,
        /// What is wrong.
        why: String,
    },
    /// A command is refused.
    #[error("line {line}, command {number} ({name}): {source}")]
    Refused {
        /// Its first line, from 1.
        line: usize,
        /// Its number, from 1.
        number: usize,
        /// Its name.
        name: &'static str,
        /// Why.
        source: Box<ModelError>,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Head<'a> {
    toile_script: u64,
    #[serde(default)]
    #[allow(dead_code, reason = "for people")]
    about: String,
    #[serde(default)]
    tolerance: Option<f64>,
    #[serde(borrow)]
    commands: Vec<&'a RawValue>,
}

/// The name of a command of which no more is known.
#[derive(Deserialize)]
struct Name {
    #[serde(rename = "do")]
    name: String,
}

impl Script {
    /// Reads a script. O(bytes).
    ///
    /// # Errors
    /// [`ScriptError`] with the line, and the command where it is one.
    pub fn read(text: &str) -> Result<Self, ScriptError> {
        let head: Head<'_> = serde_json::from_str(text)
            .map_err(|e| ScriptError::Text { line: e.line().max(1), why: plain(&e) })?;
        if head.toile_script > VERSION || head.toile_script == 0 {
            return Err(ScriptError::Version { found: head.toile_script });
        }
        let tolerance = head.tolerance.unwrap_or(Limits::default().tolerance);
        if !(tolerance.is_finite() && tolerance > 0.0) {
            return Err(ScriptError::Tolerance { value: tolerance });
        }
        let mut commands = Vec::with_capacity(head.commands.len());
        let (mut line, mut reached) = (1, 0);
        for (number, raw) in (1..).zip(head.commands) {
            // The text of a command is a part of the whole text: where it begins tells its line.
            let begins = (raw.get().as_ptr() as usize).saturating_sub(text.as_ptr() as usize).min(text.len());
            line += text.as_bytes()[reached..begins.max(reached)].iter().filter(|b| **b == b'\n').count();
            reached = begins.max(reached);
            let command =
                serde_json::from_str::<Command>(raw.get()).map_err(|e| ScriptError::Unreadable {
                    line: line + e.line().saturating_sub(1),
                    number,
                    name: serde_json::from_str::<Name>(raw.get()).ok().map(|n| n.name),
                    why: plain(&e),
                })?;
            commands.push((line, command));
        }
        Ok(Self { tolerance, commands })
    }

    /// Carries all commands out on an empty model.
    ///
    /// # Errors
    /// [`ScriptError::Refused`] with the first command that is refused.
    pub fn run(&self, limits: Limits) -> Result<ScriptRun, ScriptError> {
        let mut model = Model::new(Limits { tolerance: self.tolerance, ..limits });
        let mut done = Vec::with_capacity(self.commands.len());
        for (number, (line, command)) in (1..).zip(&self.commands) {
            done.push(model.apply(command).map_err(|source| ScriptError::Refused {
                line: *line,
                number,
                name: command.name(),
                source: Box::new(source),
            })?);
        }
        Ok(ScriptRun { model, done })
    }
}

/// An error of the JSON reader without its own place, which counts from the command's beginning.
fn plain(error: &serde_json::Error) -> String {
    let text = error.to_string();
    text.rfind(" at line ").map_or(text.clone(), |i| text[..i].to_owned())
}
