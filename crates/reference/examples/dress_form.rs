//! Writes a dress form as OBJ: `dress_form PRESET_OR_JSON OUT.obj [head]`.
use std::fmt::Write as _;

use reference::dress_form::{DressForm, FormOptions, Measurements, presets};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [what, out, rest @ ..] = &args[..] else {
        return Err("usage: dress_form PRESET_OR_JSON OUT.obj [head]".into());
    };
    let measurements: Measurements = match presets().iter().find(|p| p.name == *what) {
        Some(preset) => preset.measurements.clone(),
        None => serde_json::from_str(what)?,
    };
    let options = FormOptions { head: rest.iter().any(|r| r == "head"), ..FormOptions::default() };
    let start = std::time::Instant::now();
    let form = DressForm::build(&measurements, &options)?;
    let seconds = start.elapsed().as_secs_f64();
    let mut text = String::new();
    for p in &form.mesh.positions {
        writeln!(text, "v {} {} {}", p.x, p.y, p.z)?;
    }
    for f in &form.mesh.faces {
        writeln!(text, "f {} {} {}", f[0] + 1, f[1] + 1, f[2] + 1)?;
    }
    std::fs::write(out, text)?;
    std::fs::write(
        format!("{out}.json"),
        serde_json::to_string_pretty(&serde_json::json!({
            "seconds": seconds, "measurements": form.measurements,
            "levels": form.levels.named().into_iter().collect::<std::collections::BTreeMap<_, _>>(),
        }))?,
    )?;
    Ok(())
}
