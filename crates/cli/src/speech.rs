//! What the program says while it works and when it is done.

use std::io::{IsTerminal, Write};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;

use crate::failure::Failure;
use crate::words::Common;

/// Standard output for reports, standard error for progress and warnings.
pub(crate) struct Speech {
    pub(crate) json: bool,
    quiet: bool,
    verbose: bool,
    progress: ProgressBar,
}

impl Speech {
    pub(crate) fn new(common: &Common) -> Self {
        let shown = !common.quiet && !common.json && std::io::stderr().is_terminal();
        let target = if shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let progress = ProgressBar::with_draw_target(None, target)
            .with_style(ProgressStyle::default_spinner().tick_strings(&["-", "\\", "|", "/", " "]));
        if shown {
            progress.enable_steady_tick(Duration::from_millis(120));
        }
        Self { json: common.json, quiet: common.quiet, verbose: common.verbose, progress }
    }

    /// Says what is being done now; shown on a terminal only, or line by line when asked to say more.
    pub(crate) fn step(&self, what: impl Into<String>) {
        let what = what.into();
        if self.verbose {
            self.progress.suspend(|| eprintln!("{what}"));
        }
        self.progress.set_message(what);
    }

    /// Takes the progress line away.
    pub(crate) fn end_progress(&self) {
        self.progress.finish_and_clear();
    }

    /// Something the user should know although the command went through.
    pub(crate) fn warn(&self, what: &str) {
        if !self.quiet {
            self.progress.suspend(|| eprintln!("warning: {what}"));
        }
    }

    /// The report: JSON when asked for, else the text.
    pub(crate) fn report<T: Serialize>(
        &self,
        data: &T,
        text: impl FnOnce() -> String,
    ) -> Result<(), Failure> {
        self.end_progress();
        let out = if self.json {
            serde_json::to_string_pretty(data)? + "\n"
        } else if self.quiet {
            return Ok(());
        } else {
            text()
        };
        match std::io::stdout().write_all(out.as_bytes()) {
            // A reader that has read enough (`toile … | head`) is no failure.
            Err(e) if e.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
            other => Ok(other?),
        }
    }
}

/// A table with a header, columns as wide as their cells; the first column left, the rest right.
pub(crate) fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    let mut widths: Vec<usize> = header.iter().map(|h| h.chars().count()).collect();
    for row in rows {
        for (w, cell) in widths.iter_mut().zip(row) {
            *w = (*w).max(cell.chars().count());
        }
    }
    let line = |cells: &mut dyn Iterator<Item = &str>| {
        let mut text = String::new();
        for (i, (cell, &w)) in cells.zip(&widths).enumerate() {
            if i == 0 {
                text.push_str(&format!("  {cell:<w$}"));
            } else {
                text.push_str(&format!("  {cell:>w$}"));
            }
        }
        text.trim_end().to_owned() + "\n"
    };
    let mut out = line(&mut header.iter().copied());
    for row in rows {
        out.push_str(&line(&mut row.iter().map(String::as_str)));
    }
    out
}
