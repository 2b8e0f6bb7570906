//! `toile form`: a dress form from tape measurements.

use std::path::Path;

use design::pictures;
use mesh_kernel::files::{Format, WriteOptions, to_bytes};
use reference::dress_form::{DressForm, Figure, FormOptions, Measurements, Resolved, presets};
use reference::human::{self, HumanOptions};
use serde::Serialize;

use super::{file_name, read_text, write_together};
use crate::failure::Failure;
use crate::speech::{Speech, table};
use crate::words;

/// A hundredth of a millimetre is finer than any tape.
const DECIMALS: u8 = 3;

#[derive(Serialize)]
struct Made {
    file: String,
    features: String,
    faces: usize,
    measurements: Resolved,
}

pub(crate) fn run(words: &words::Form, speech: &Speech) -> Result<(), Failure> {
    if words.list_presets {
        return list(speech);
    }
    let Some(output) = &words.output else { return Err(Failure::words("name the file to write with -o")) };
    let format = Format::of_path(output).ok_or_else(|| {
        Failure::words(format!("{}: the name must end in .obj, .ply, .stl, .off or .glb", output.display()))
    })?;
    let measurements = measurements(words)?;
    speech.step("building the form");
    let form = DressForm::build(&measurements, &FormOptions { head: words.head, ..FormOptions::default() })?;
    let features = human::extract(&form.mesh, &HumanOptions::default())?.exported();
    let features_path = output.with_extension("features.json");
    let mut text = serde_json::to_string_pretty(&features)?;
    text.push('\n');
    let options = WriteOptions { decimals: Some(DECIMALS), ..WriteOptions::default() };
    let mesh = to_bytes(format, &form.mesh, &options);
    let mut files: Vec<(&Path, &[u8])> = vec![(output, &mesh), (&features_path, text.as_bytes())];
    let picture;
    if let Some(path) = &words.picture {
        speech.step("drawing");
        picture = pictures::body_picture(&file_name(output), &form.mesh)?.to_png();
        files.push((path, &picture));
    }
    write_together(&files)?;
    let made = Made {
        file: output.display().to_string(),
        features: features_path.display().to_string(),
        faces: form.mesh.faces.len(),
        measurements: form.measurements,
    };
    speech.report(&made, || {
        let rows: Vec<Vec<String>> = pairs(&made.measurements)
            .into_iter()
            .map(|(name, cm)| {
                // A neck is measured where collars sit, and `neck` is the narrowest girth above.
                let girth = if name == "neck" { "neck_base" } else { name.as_str() };
                let found =
                    features.girths.get(girth).map_or_else(String::new, |mm| format!("{:.1}", mm / 10.0));
                vec![name, format!("{cm:.1}"), found]
            })
            .collect();
        let mut text = table(&["measurement [cm]", "form", "found on it"], &rows);
        text.push_str(&format!(
            "  {} triangles; written to {}, its features to {}\n",
            made.faces, made.file, made.features
        ));
        text
    })
}

/// Preset, then the file, then single words: the later wins.
fn measurements(words: &words::Form) -> Result<Measurements, Failure> {
    let mut all = match &words.preset {
        None => Measurements::default(),
        Some(name) => {
            let wanted = name.to_ascii_lowercase();
            let found = presets().iter().find(|p| p.name == wanted);
            let found = found.ok_or_else(|| {
                Failure::new(format!("there is no preset {name:?}"))
                    .remedy("`toile form --list-presets` lists them")
            })?;
            found.measurements.clone()
        }
    };
    if let Some(path) = &words.measurements {
        let text = read_text("the measurements", path)?;
        // Lists would be taken for measurements in some order.
        if text.trim_start().starts_with('[') {
            return Err(Failure::new("this is a list; measurements have names")
                .about(path)
                .remedy("write an object such as {\"bust\": 92, \"waist\": 74}, in centimetres"));
        }
        let given: Measurements = serde_json::from_str(&text).map_err(|e| Failure::from(e).about(path))?;
        all.figure = given.figure;
        for (mine, theirs) in fields(&mut all).into_iter().zip(fields(&mut given.clone())) {
            if theirs.is_some() {
                *mine = *theirs;
            }
        }
    }
    if let Some(figure) = words.figure {
        all.figure = match figure {
            words::Figure::Woman => Figure::Woman,
            words::Figure::Man => Figure::Man,
            words::Figure::Child => Figure::Child,
        };
    }
    let t = &words.tape;
    let given = [
        t.height,
        t.bust,
        t.underbust,
        t.waist,
        t.high_hip,
        t.hip,
        t.neck,
        t.shoulder_width,
        t.back_length,
        t.upper_arm,
        t.thigh,
        t.knee,
        t.calf,
        t.ankle,
    ];
    for (mine, theirs) in fields(&mut all).into_iter().zip(given) {
        if theirs.is_some() {
            *mine = theirs;
        }
    }
    Ok(all)
}

/// All measurements in one order.
fn fields(m: &mut Measurements) -> [&mut Option<f64>; 14] {
    [
        &mut m.height,
        &mut m.bust,
        &mut m.underbust,
        &mut m.waist,
        &mut m.high_hip,
        &mut m.hip,
        &mut m.neck,
        &mut m.shoulder_width,
        &mut m.back_length,
        &mut m.upper_arm,
        &mut m.thigh,
        &mut m.knee,
        &mut m.calf,
        &mut m.ankle,
    ]
}

fn pairs(r: &Resolved) -> Vec<(String, f64)> {
    match serde_json::to_value(r) {
        Ok(serde_json::Value::Object(map)) => {
            map.into_iter().filter_map(|(name, value)| Some((name, value.as_f64()?))).collect()
        }
        _ => Vec::new(),
    }
}

#[derive(Serialize)]
struct PresetLine {
    name: String,
    source: String,
    measurements: Measurements,
}

fn list(speech: &Speech) -> Result<(), Failure> {
    let lines: Vec<PresetLine> = presets()
        .iter()
        .map(|p| PresetLine {
            name: p.name.clone(),
            source: p.source.to_owned(),
            measurements: p.measurements.clone(),
        })
        .collect();
    speech.report(&lines, || {
        let cell = |v: Option<f64>| v.map_or_else(|| "–".to_owned(), |v| format!("{v:.1}"));
        let rows: Vec<Vec<String>> = lines
            .iter()
            .map(|l| {
                let m = &l.measurements;
                vec![
                    l.name.clone(),
                    cell(m.bust),
                    cell(m.underbust),
                    cell(m.waist),
                    cell(m.hip),
                    cell(m.height),
                ]
            })
            .collect();
        table(&["preset [cm]", "bust", "underbust", "waist", "hip", "height"], &rows)
    })
}
