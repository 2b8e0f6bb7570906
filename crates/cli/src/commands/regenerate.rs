//! `toile regenerate`: a template on a body, from features to files.

use std::path::Path;
use std::time::Instant;

use design::regenerate::{Artifact, RegenerateError, Regenerated, Settings, regenerate};
use design::report::Report;
use template::{Template, TemplateError};

use super::{body_refusal, file_name, read_mesh, read_text};
use crate::failure::Failure;
use crate::speech::{Speech, table};
use crate::words::{Build, Dialect, Format, Paper, Regenerate, Unit};

pub(crate) fn run(words: &Regenerate, speech: &Speech) -> Result<(), Failure> {
    let started = Instant::now();
    speech.step("reading");
    let template = read_template(&words.template)?;
    let body = read_mesh(&words.body)?;
    let load = started.elapsed().as_secs_f64();
    let built = regenerate(&template, &file_name(&words.body), &body, &settings(&words.build), &|step| {
        speech.step(step);
        true
    });
    let mut built: Regenerated = built.map_err(|e| refusal(e, words))?;
    built.report.seconds.load = load;
    speech.step("writing");
    built.write(&words.out, &artifacts(&words.build), started)?;
    for warning in &built.report.warnings {
        speech.warn(warning);
    }
    speech.report(&built.report, || summary(&built.report, &words.out))
}

/// What was wrong, and with which file.
fn refusal(error: RegenerateError, words: &Regenerate) -> Failure {
    match error {
        RegenerateError::Body(e) => body_refusal(e, &words.body),
        RegenerateError::Template(e @ TemplateError::BadReference(_)) => Failure::from(e).about(&words.body),
        RegenerateError::Template(e) => Failure::from(e).about(&words.template),
        // What it says names a piece, which is the template's on this body.
        RegenerateError::Pattern(e) => Failure::from(e).about(&words.template),
        e => e.into(),
    }
}

pub(crate) fn read_template(path: &Path) -> Result<Template, Failure> {
    let text = read_text("the template", path)?;
    design::draft::template_of(&text).map_err(|e| Failure::from(e).about(path))
}

pub(crate) fn settings(words: &Build) -> Settings {
    Settings {
        levels: words.levels,
        sample_size: words.sample_size.clone(),
        paper: match words.paper {
            Paper::A4 => pattern::Paper::A4,
            Paper::A3 => pattern::Paper::A3,
            Paper::A0 => pattern::Paper::A0,
            Paper::Letter => pattern::Paper::Letter,
            Paper::Plotter => pattern::Paper::Plotter,
        },
        dialect: match words.dxf {
            Dialect::Astm => pattern::Dialect::Astm,
            Dialect::Aama => pattern::Dialect::Aama,
            Dialect::Gerber => pattern::Dialect::Gerber,
            Dialect::Clo => pattern::Dialect::Clo,
            Dialect::Richpeace => pattern::Dialect::Richpeace,
        },
        unit: words.unit.map(Unit::of_body),
    }
}

/// What shall be written; everything when the call does not say.
pub(crate) fn artifacts(words: &Build) -> Vec<Artifact> {
    if words.formats.is_empty() {
        return Artifact::DEFAULT.to_vec();
    }
    let of = |format: &Format| match format {
        Format::Obj => Artifact::Obj,
        Format::Glb => Artifact::Glb,
        Format::Dxf => Artifact::Dxf,
        Format::Svg => Artifact::Svg,
        Format::Pdf => Artifact::Pdf,
        Format::Json => Artifact::Json,
        Format::Png => Artifact::Png,
        Format::Toile => Artifact::Toile,
        Format::Body => Artifact::Body,
    };
    words.formats.iter().map(of).collect()
}

/// The report for people.
fn summary(report: &Report, out: &Path) -> String {
    let faces: usize = report.surfaces.iter().map(|s| s.faces).sum();
    let mut text = format!(
        "{} on {} ({:.0} mm tall, file in {})\n\n",
        report.template, report.body.file, report.body.height, report.body.units_guessed
    );
    let rows: Vec<Vec<String>> = report
        .ease
        .iter()
        .map(|(name, ease)| {
            let girth = report.body.girths.get(name).copied().unwrap_or(f64::NAN);
            let wanted = report.ease_wanted.get(name).map_or_else(String::new, |w| format!("{w:.0}"));
            vec![
                name.clone(),
                format!("{girth:.0}"),
                format!("{:.0}", girth + ease),
                format!("{ease:.1}"),
                wanted,
            ]
        })
        .collect();
    text.push_str(&table(&["girth [mm]", "body", "garment", "ease", "wanted"], &rows));
    text.push('\n');
    let rows: Vec<Vec<String>> = report
        .pieces
        .iter()
        .map(|p| {
            vec![
                p.name.clone(),
                format!("{:.0}", p.area_2d / 100.0),
                format!("{:.2}", 100.0 * (p.area_2d / p.area_3d - 1.0)),
                format!("{:.1}", 100.0 * p.mean_stretch),
                format!("{:.1}", 100.0 * p.max_stretch),
            ]
        })
        .collect();
    text.push_str(&table(&["piece", "area [cm²]", "area [%]", "stretch [%]", "most [%]"], &rows));
    let mismatch = report.seams.iter().map(|s| s.mismatch).fold(0.0, f64::max);
    text.push_str(&format!(
        "\n  {} surfaces, {} joints, {faces} triangles; {} pieces\n  \
         nodes in the body {}, triangles crossing it {}, least distance {:.1} mm\n  \
         {} seams, largest mismatch {mismatch:.3} mm\n  {:.2} s; written to {}\n",
        report.surfaces.len(),
        report.joints.len(),
        report.pieces.len(),
        report.collision.nodes_inside,
        report.collision.faces_crossing,
        report.collision.min_distance,
        report.seams.len(),
        report.seconds.total,
        out.display()
    ));
    text
}
