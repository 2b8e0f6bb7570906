//! `toile render`: a picture of a model.

use std::path::Path;

use design::pictures::{ModelColor, ModelPicture, model_picture};
use design::thicken::list_from_json;
use design::units::guess_of_model;
use serde::Serialize;
use viewer::View;

use super::{extension, read_mesh, write};
use crate::failure::Failure;
use crate::speech::Speech;
use crate::words::{Colour, Render, Side, Unit};

#[derive(Serialize)]
struct Done {
    file: String,
    width: u32,
    height: u32,
}

pub(crate) fn run(words: &Render, speech: &Speech) -> Result<(), Failure> {
    if extension(&words.output) != "png" {
        return Err(Failure::words("the picture's name must end in .png"));
    }
    let (width, height) = size(&words.size)?;
    speech.step("reading");
    let model = read_mesh(&words.model)?;
    let body = words.with.as_deref().map(read_mesh).transpose()?;
    let color = match words.color {
        Colour::None => ModelColor::Groups,
        Colour::Stretch => ModelColor::Stretch,
        Colour::Distance => ModelColor::Distance,
        Colour::Thickness => ModelColor::Thickness(thickness(&words.model)?),
    };
    let view = match words.view {
        Side::Front => View::Front,
        Side::Back => View::Back,
        Side::Left => View::Left,
        Side::Right => View::Right,
        Side::Top => View::Top,
        Side::Iso => View::Iso,
    };
    let unit = words.unit.map_or_else(|| guess_of_model(&model), Unit::millimetres);
    speech.step("drawing");
    let picture =
        model_picture(&ModelPicture { model: &model, body: body.as_ref(), unit, color, view, width, height })
            .map_err(|e| Failure::from(e).about(&words.model))?;
    write(&words.output, &picture.to_png())?;
    let done = Done { file: words.output.display().to_string(), width, height };
    speech.report(&done, || format!("{} ({width} x {height})\n", done.file))
}

/// `WxH` in pixels.
pub(super) fn size(text: &str) -> Result<(u32, u32), Failure> {
    let parts =
        text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.trim().parse().ok()?, h.trim().parse().ok()?)));
    match parts {
        Some((w, h)) if w > 0 && h > 0 => Ok((w, h)),
        _ => Err(Failure::words(format!("--size is WIDTHxHEIGHT in pixels, such as 1024x768, not {text:?}"))),
    }
}

/// The thicknesses beside a sheet: `NAME.thickness.json`, a list with one number a triangle, in millimetres.
fn thickness(model: &Path) -> Result<Vec<f64>, Failure> {
    let path = model.with_extension("thickness.json");
    let text = std::fs::read_to_string(&path)
        .map_err(|e| Failure::new(format!("cannot read the thicknesses {}: {e}", path.display())))?;
    list_from_json(&text).map_err(|e| Failure::from(e).about(&path))
}
