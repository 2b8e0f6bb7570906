//! `toile features`: landmarks, feature curves and girths of a body.

use std::path::Path;

use design::pictures::features_picture;
use reference::human::{self, HumanBody, HumanOptions};

use super::{body_refusal, file_name, read_mesh, write_together};
use crate::failure::Failure;
use crate::speech::{Speech, table};
use crate::words::{Features, Unit};

pub(crate) fn run(words: &Features, speech: &Speech) -> Result<(), Failure> {
    speech.step("reading");
    let mesh = read_mesh(&words.mesh)?;
    speech.step("finding features");
    let options = HumanOptions { unit: words.unit.map(Unit::of_body), ..HumanOptions::default() };
    let body = human::extract(&mesh, &options).map_err(|e| body_refusal(e, &words.mesh))?;
    let exported = body.exported();
    let mut text = serde_json::to_string_pretty(&exported)?;
    text.push('\n');
    let mut files: Vec<(&Path, &[u8])> = Vec::new();
    if let Some(path) = &words.output {
        files.push((path, text.as_bytes()));
    }
    let picture;
    if let Some(path) = &words.picture {
        speech.step("drawing");
        picture = features_picture(&file_name(&words.mesh), &body.mesh, &body.features)?.to_png();
        files.push((path, &picture));
    }
    write_together(&files)?;
    for warning in &body.features.warnings {
        speech.warn(warning);
    }
    speech.report(&exported, || summary(&file_name(&words.mesh), &body))
}

fn summary(file: &str, body: &HumanBody) -> String {
    let mut text = format!("{file}: {:.0} mm tall, file in {}\n\n", body.features.height, body.unit.symbol());
    let rows: Vec<Vec<String>> = body
        .features
        .curves
        .iter()
        .filter(|(name, curve)| curve.closed && !name.ends_with("_tape"))
        .map(|(name, curve)| {
            let girth = body.girths.get(name).copied().unwrap_or(f64::NAN);
            let heights = curve.points.iter().map(|p| p.y);
            let mean = heights.sum::<f64>() / curve.points.len().max(1) as f64;
            vec![name.clone(), format!("{girth:.0}"), format!("{mean:.0}")]
        })
        .collect();
    text.push_str(&table(&["girth", "tape [mm]", "height [mm]"], &rows));
    let rows: Vec<Vec<String>> = body
        .features
        .points
        .iter()
        .map(|(name, p)| {
            let [x, y, z] = p.position.to_array().map(|v| format!("{v:.0}"));
            vec![name.clone(), x, y, z]
        })
        .collect();
    text.push('\n');
    text.push_str(&table(&["point [mm]", "left", "up", "front"], &rows));
    text
}
