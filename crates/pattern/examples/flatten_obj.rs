//! tmp
#![allow(clippy::print_stdout, clippy::unwrap_used)]
use mesh_kernel::{TriMesh, glam::DVec3};
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string(&args[1]).unwrap();
    let mut m = TriMesh::default();
    for l in text.lines() {
        let w: Vec<&str> = l.split_whitespace().collect();
        match w.first() {
            Some(&"v") => m.positions.push(DVec3::new(w[1].parse().unwrap(), w[2].parse().unwrap(), w[3].parse().unwrap()) * 10.0),
            Some(&"f") => m.faces.push([1, 2, 3].map(|i| w[i].split('/').next().unwrap().parse::<u32>().unwrap() - 1)),
            _ => {}
        }
    }
    let input = pattern::input_of_mesh(&m, &Default::default()).unwrap();
    let options = pattern::PatternOptions { match_seams: args.get(3).is_none_or(|s| s != "free"), ..Default::default() };
    let t = std::time::Instant::now(); let pat = pattern::make(&input, &options).unwrap();
    println!("{} ms {:.1}", args[1], t.elapsed().as_secs_f64() * 1e3);
    for r in &pat.pieces { println!("{:?}", r.report); }
    for n in &pat.warnings { println!("{n}"); } for s in &pat.seams { println!("{s:?}"); }
    use std::fmt::Write;
    let mut out = String::new();
    let f = &pat.flats[0];
    for n in &f.node_of { let p = input.patches[0].positions[*n as usize]; writeln!(out, "v {} {} {}", p.x, p.y, p.z).unwrap(); }
    for n in &f.uv { writeln!(out, "vt {} {}", n.x, n.y).unwrap(); }
    for t in &f.faces { writeln!(out, "f {0}/{0} {1}/{1} {2}/{2}", t[0] + 1, t[1] + 1, t[2] + 1).unwrap(); }
    std::fs::write(&args[2], out).unwrap();
}
