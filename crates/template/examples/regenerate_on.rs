//! Builds a template on a human body and writes the garment as OBJ.
//!
//! `cargo run --release -p template --example regenerate_on -- TEMPLATE BODY.obj OUT.obj [BODY_OUT.obj]`

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use mesh_kernel::files::{Format, WriteOptions, read, to_bytes, write_atomically};
use reference::human::{HumanOptions, extract};
use template::{Reference, RegenerateOptions, Template, regenerate};

#[allow(clippy::print_stdout)]
fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [template, body, out, rest @ ..] = &words[..] else {
        return Err("give TEMPLATE BODY.obj OUT.obj [BODY_OUT.obj]".into());
    };
    let template = Template::from_json(&std::fs::read_to_string(template)?)?;
    let start = Instant::now();
    let human = extract(&read(Path::new(body))?, &HumanOptions::default())?;
    println!("features {:.3} s", start.elapsed().as_secs_f64());
    let reference = Reference { mesh: &human.mesh, features: &human.features };
    let garment = regenerate(&template, &reference, &RegenerateOptions::default())?;
    let mesh = garment.body.to_tri_mesh();
    println!("{} faces, {:?}", mesh.faces.len(), garment.seconds);
    println!("{:?}", garment.collision);
    for (name, got) in &garment.ease {
        let height = human
            .features
            .curves
            .get(name)
            .map_or(0.0, |c| c.points.iter().map(|p| p.y).sum::<f64>() / c.points.len() as f64);
        println!("ease {name}: {got:.1} wanted {:.1}, at height {height:.0}", garment.ease_wanted[name]);
    }
    for warning in &garment.warnings {
        println!("warning: {warning}");
    }
    write_atomically(Path::new(out), &to_bytes(Format::Obj, &mesh, &WriteOptions::default()))?;
    if let [body_out] = rest {
        write_atomically(Path::new(body_out), &to_bytes(Format::Obj, &human.mesh, &WriteOptions::default()))?;
    }
    Ok(())
}
