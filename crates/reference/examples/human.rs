//! Prints the features of a body mesh as JSON: `human MESH`.

use std::io::Write;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("usage: human MESH")?;
    let mesh = mesh_kernel::files::read(Path::new(&path))?;
    let started = std::time::Instant::now();
    let found = reference::human::extract(&mesh, &reference::human::HumanOptions::default());
    let seconds = started.elapsed().as_secs_f64();
    let value = match found {
        Ok(body) => {
            let mut value = serde_json::to_value(body.exported())?;
            value["seconds"] = seconds.into();
            value
        }
        Err(error) => serde_json::json!({ "error": error.to_string(), "seconds": seconds }),
    };
    writeln!(std::io::stdout().lock(), "{value}")?;
    Ok(())
}
