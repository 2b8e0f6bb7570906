//! `toile model`: a script of modelling commands to a sheet or solid.

use std::path::Path;
use std::time::Instant;

use design::modelling::{ModelReport, Modelled, ReadingReport, TouchingReport, model};
use mesh_kernel::files::{Format, WriteOptions, to_bytes};

use super::{read_text, write};
use crate::failure::Failure;
use crate::speech::{Speech, table};
use crate::words::ModelScript;

pub(crate) fn run(words: &ModelScript, speech: &Speech) -> Result<(), Failure> {
    let started = Instant::now();
    let format = match &words.output {
        Some(path) => Some((
            path,
            Format::of_path(path).ok_or_else(|| {
                Failure::words("the model's name must end in .obj, .ply, .stl, .off or .glb")
            })?,
        )),
        None => None,
    };
    speech.step("carrying out the script");
    let Modelled { mesh, mut report, .. } = run_script(&words.script)?;
    if let Some((path, format)) = format {
        if mesh.faces.is_empty() {
            return Err(Failure::new("the script makes no faces, only wires").about(&words.script));
        }
        speech.step("writing");
        write(path, &to_bytes(format, &mesh, &WriteOptions::default()))?;
        report.file = path.display().to_string();
    }
    report.seconds = started.elapsed().as_secs_f64();
    speech.report(&report, || summary(&report))
}

/// Reads and runs a script; messages name the file, the line and the command.
pub(super) fn run_script(path: &Path) -> Result<Modelled, Failure> {
    let text = read_text("the script", path)?;
    model(&text).map_err(|e| Failure::from(e).about(path))
}

fn summary(r: &ModelReport) -> String {
    let c = &r.counts;
    let counts = [c.v, c.e, c.f, c.r, c.c, c.ch, c.cc].map(|n| n.to_string()).to_vec();
    let mut text = table(&["vertices", "edges", "faces", "rings", "parts", "holes", "volumes"], &[counts]);
    text.push_str(&format!(
        "\n  {} commands; the identity of the counts {}\n  patches: {}\n",
        r.commands,
        if r.identity_holds { "holds" } else { "does NOT hold" },
        r.patches.join(", ")
    ));
    if !r.wires.is_empty() {
        text.push_str(&format!("  wires: {}\n", r.wires.join(", ")));
    }
    if !r.partial.is_empty() {
        text.push_str(&format!("  partial: {}\n", r.partial.join(", ")));
    }
    for answer in &r.answers {
        text.push_str(&format!("  {answer}\n"));
    }
    if !r.touching.is_empty() {
        let rows: Vec<Vec<String>> = r.touching.iter().map(touching_row).collect();
        text.push('\n');
        text.push_str(&table(&["touches at", "sheets", "touch and join", "touch but miss"], &rows));
    }
    if !r.file.is_empty() {
        text.push_str(&format!("  written to {}\n", r.file));
    }
    text
}

fn touching_row(t: &TouchingReport) -> Vec<String> {
    let point = |p: &[f64; 3]| p.map(|x| format!("{x:.2}")).join(" ");
    let reading = |r: &ReadingReport| match r {
        ReadingReport::Counts(c) => format!("parts {}, holes {}, volumes {}", c.c, c.ch, c.cc),
        ReadingReport::Refused(why) => why.clone(),
    };
    let at: Vec<String> = t.at.iter().map(point).collect();
    vec![at.join("  to  "), t.sheets.to_string(), reading(&t.join), reading(&t.miss)]
}
