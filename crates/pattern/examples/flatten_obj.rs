//! Flattens an OBJ (groups = pieces) and writes every file format beside it:
//! `cargo run --release -p pattern --example flatten_obj -- MESH.obj OUT_STEM [SCALE_TO_MM] [ALLOWANCE_MM]`.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

use std::fmt::Write;

use mesh_kernel::{Group, TriMesh, glam::DVec3};
use pattern::*;

fn read(path: &str, scale: f64) -> TriMesh {
    let mut mesh = TriMesh::default();
    for line in std::fs::read_to_string(path).unwrap().lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.first() {
            Some(&"v") => {
                let [x, y, z] = [1, 2, 3].map(|i| words[i].parse::<f64>().unwrap() * scale);
                mesh.positions.push(DVec3::new(x, y, z));
            }
            Some(&"g") => {
                let end = mesh.faces.len() as u32;
                mesh.groups.push(Group { name: words[1].to_owned(), faces: end..end });
            }
            Some(&"f") => {
                mesh.faces
                    .push([1, 2, 3].map(|i| words[i].split('/').next().unwrap().parse::<u32>().unwrap() - 1));
                if let Some(group) = mesh.groups.last_mut() {
                    group.faces.end = mesh.faces.len() as u32;
                }
            }
            _ => {}
        }
    }
    mesh
}

/// Processor time of all threads so far, in milliseconds (Linux; else 0).
fn processor_ms() -> f64 {
    let tasks = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    tasks
        .filter_map(|t| std::fs::read_to_string(t.path().join("schedstat")).ok())
        .filter_map(|s| s.split_whitespace().next().and_then(|n| n.parse::<f64>().ok()))
        .sum::<f64>()
        / 1e6
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let number = |i: usize, default: f64| args.get(i).map_or(default, |s| s.parse().unwrap());
    let mesh = read(&args[1], number(3, 10.0));
    let mut options = FlattenMeshOptions { allowance_mm: number(4, 10.0), ..FlattenMeshOptions::default() };
    options.pattern.match_seams = std::env::var_os("FREE").is_none();
    if std::env::var_os("KEEP").is_some() {
        options.pattern.holes = HolePolicy::Keep;
    }
    if let Ok(weight) = std::env::var("AREA") {
        options.pattern.area_weight = weight.parse().unwrap();
    }
    let (start, cpu) = (std::time::Instant::now(), processor_ms());
    let pattern = flatten_mesh(&mesh, &options).unwrap();
    let (wall, cpu) = (start.elapsed().as_secs_f64() * 1e3, processor_ms() - cpu);
    println!("{} {wall:.1} ms, processor {cpu:.1} ms", args[1]);
    for piece in &pattern.pieces {
        println!("{}: {:?}", piece.name, piece.report);
    }
    for seam in &pattern.seams {
        println!("{seam:?}");
    }
    for warning in &pattern.warnings {
        println!("warning: {warning}");
    }
    let write = |tail: &str, bytes: Vec<u8>| std::fs::write(format!("{}{tail}", args[2]), bytes).unwrap();
    let start = std::time::Instant::now();
    for (name, dialect) in Dialect::NAMES {
        let dxf = to_dxf(&pattern, &DxfOptions { dialect, ..DxfOptions::default() });
        write(&format!(".{name}.dxf"), dxf.into_bytes());
    }
    for (name, paper) in Paper::NAMES {
        let title = "flatten_obj".to_owned();
        write(
            &format!(".{name}.pdf"),
            to_pdf(&pattern, &PdfOptions { paper, title, sample_size: "38".to_owned() }),
        );
    }
    write(".svg", to_svg(&pattern, &SvgOptions::default()).into_bytes());
    write(".json", to_json(&pattern, &JsonOptions::default()).into_bytes());
    println!("files {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
    // The first piece with its flat positions, for other programs' metrics.
    let flat = &pattern.flats[0];
    let patch = &input_of_mesh(&mesh, &options).unwrap().patches[0];
    let mut out = String::new();
    for v in &flat.node_of {
        let p = patch.positions[*v as usize];
        writeln!(out, "v {} {} {}", p.x, p.y, p.z).unwrap();
    }
    for p in &flat.uv {
        writeln!(out, "vt {} {}", p.x, p.y).unwrap();
    }
    for t in &flat.faces {
        writeln!(out, "f {0}/{0} {1}/{1} {2}/{2}", t[0] + 1, t[1] + 1, t[2] + 1).unwrap();
    }
    write(".obj", out.into_bytes());
}
