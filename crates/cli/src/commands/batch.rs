//! `toile batch`: a template on many bodies.

use std::path::{Path, PathBuf};

use design::batch::{Batch, BatchOptions, Shard, run_batch};

use super::read_text;
use super::regenerate::{artifacts, read_template, settings};
use crate::failure::Failure;
use crate::speech::{Speech, table};
use crate::words;

pub(crate) fn run(words: &words::Batch, speech: &Speech) -> Result<(), Failure> {
    let shard = words.shard.as_deref().map(shard).transpose()?.unwrap_or_default();
    let template = read_template(&words.template)?;
    let bodies = bodies(&words.bodies)?;
    let options = BatchOptions {
        settings: settings(&words.build),
        artifacts: artifacts(&words.build),
        shard,
        again: words.again,
    };
    let progress =
        |done: usize, of: usize, name: &str| speech.step(format!("{done} of {of} done, last {name}"));
    let batch = run_batch(&template, &bodies, &words.out, &options, &progress)?;
    speech.report(&batch, || summary(&batch, &words.out))?;
    match batch.failed() {
        0 => Ok(()),
        failed => Err(Failure::new(format!("{failed} of {} bodies failed", batch.bodies.len()))),
    }
}

/// The meshes of a folder, by name, or the paths in a text file, one a line.
fn bodies(place: &Path) -> Result<Vec<PathBuf>, Failure> {
    let unreadable = |e: std::io::Error| Failure::new(format!("cannot read {}: {e}", place.display()));
    let mut found = Vec::new();
    if place.is_dir() {
        for entry in std::fs::read_dir(place).map_err(unreadable)? {
            let path = entry.map_err(unreadable)?.path();
            if path.is_file() && mesh_kernel::files::Format::of_path(&path).is_some() {
                found.push(path);
            }
        }
        found.sort();
    } else {
        let text = read_text("the list of bodies", place)?;
        found = listed(&text, place.parent().unwrap_or(Path::new("")));
    }
    if found.is_empty() {
        return Err(Failure::new(format!("{} names no bodies", place.display())).remedy(
            "give a folder of OBJ, PLY, STL, OFF or GLB files, or a text file with one path a line",
        ));
    }
    Ok(found)
}

/// The paths in a list, relative to its folder; empty lines and those with `#` are passed over.
pub(super) fn listed(text: &str, folder: &Path) -> Vec<PathBuf> {
    let lines = text.lines().map(str::trim).filter(|l| !l.is_empty() && !l.starts_with('#'));
    lines.map(|line| folder.join(line)).collect()
}

/// `I/N`.
pub(super) fn shard(text: &str) -> Result<Shard, Failure> {
    text.split_once('/')
        .and_then(|(i, n)| Shard::new(i.trim().parse().ok()?, n.trim().parse().ok()?))
        .ok_or_else(|| Failure::words(format!("--shard is I/N with 1 ≤ I ≤ N, such as 2/5, not {text:?}")))
}

fn summary(batch: &Batch, out: &Path) -> String {
    let rows: Vec<Vec<String>> = batch
        .bodies
        .iter()
        .map(|b| vec![b.name.clone(), b.state.to_string(), format!("{:.1}", b.seconds)])
        .collect();
    let mut text = table(&["body", "result", "s"], &rows);
    for body in &batch.bodies {
        if let Some(error) = &body.error {
            text.push_str(&format!("  {}: {error}\n", body.name));
        }
    }
    text.push_str(&format!("  written to {}\n", out.display()));
    text
}
