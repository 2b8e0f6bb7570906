//! Our side of `tests/peers/run.sh`.
//!
//! `peer_ours panel DIR` writes a curved panel and the orders in which its edges are edited; `peer_ours run DIR` times edits of it and
//! prints a line each: library, operation, valid operations, CPU seconds.

// An example speaks to the person who runs it, and one that cannot go on stops.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

use std::fmt::Write as _;
use std::path::Path;

use mesh_kernel::TriMesh;
use mesh_kernel::body::edit::{CollapseOptions, Editor, Guard};
use mesh_kernel::body::{Body, EdgeId, NONE, NodeId, SurfaceId, SurfaceSpec};
use mesh_kernel::glam::DVec3;

/// Cells on a side of the panel: some 200,000 triangles.
const CELLS: usize = 316;
const SPLITS: usize = 100_000;
const COLLAPSES: usize = 50_000;

const SURFACE: SurfaceId = SurfaceId(0);

/// The panel of `benches/body.rs`.
fn panel(n: usize) -> TriMesh {
    let mut mesh = TriMesh::default();
    let m = n + 1;
    for j in 0..m {
        for i in 0..m {
            let (x, y) = (i as f64 / n as f64, j as f64 / n as f64);
            mesh.positions.push(DVec3::new(400.0 * x, 500.0 * y, 60.0 * (3.0 * x).sin() * (1.0 + y)));
        }
    }
    let id = |i: usize, j: usize| (j * m + i) as u32;
    for j in 0..n {
        for i in 0..n {
            mesh.faces.push([id(i, j), id(i + 1, j), id(i + 1, j + 1)]);
            mesh.faces.push([id(i, j), id(i + 1, j + 1), id(i, j + 1)]);
        }
    }
    mesh
}

fn spec() -> SurfaceSpec {
    let mesh = panel(CELLS);
    SurfaceSpec { name: "panel".into(), positions: mesh.positions, faces: mesh.faces }
}

/// The order of `benches/body.rs`.
fn shuffled(n: usize) -> Vec<u32> {
    let mut order: Vec<u32> = (0..n as u32).collect();
    let mut state = 12_345u64;
    for i in (1..n).rev() {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        order.swap(i, (state >> 33) as usize % (i + 1));
    }
    order
}

fn write_panel(folder: &Path) {
    let spec = spec();
    let mut obj = String::new();
    for p in &spec.positions {
        writeln!(obj, "v {} {} {}", p.x, p.y, p.z).unwrap();
    }
    for [a, b, c] in &spec.faces {
        writeln!(obj, "f {} {} {}", a + 1, b + 1, c + 1).unwrap();
    }
    let body = Body::build(&[spec], &[]).unwrap();
    let edges = body.surface(SURFACE).edges();
    let list = |numbers: &[u32]| {
        let mut text = String::new();
        for &e in numbers {
            let [a, b] = edges[e as usize];
            writeln!(text, "{a} {b}").unwrap();
        }
        text
    };
    let Orders { random, flips, splits } = Orders::new(&body);
    std::fs::write(folder.join("panel.obj"), obj).unwrap();
    for (name, numbers) in [("random", random), ("flips", flips), ("splits", splits)] {
        std::fs::write(folder.join(format!("{name}.txt")), list(&numbers)).unwrap();
    }
}

/// In which order edges are edited.
struct Orders {
    /// All.
    random: Vec<u32>,
    /// In mesh order such that no two share a face: flipped one after the other, all edges would gather at few nodes.
    flips: Vec<u32>,
    /// In mesh order.
    splits: Vec<u32>,
}

impl Orders {
    fn new(body: &Body) -> Self {
        let s = body.surface(SURFACE);
        let mut free = vec![true; s.faces().len()];
        let mut flips = Vec::new();
        for (e, &[l, r]) in s.edge_faces().iter().enumerate() {
            if l != NONE && r != NONE && free[l as usize] && free[r as usize] {
                (free[l as usize], free[r as usize]) = (false, false);
                flips.push(e as u32);
            }
        }
        let edges = s.edges().len();
        Self { random: shuffled(edges), flips, splits: (0..edges as u32).collect() }
    }
}

/// CPU time of this thread, in seconds, as the Linux scheduler counts it.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    stat.split_whitespace().next().unwrap().parse::<f64>().unwrap() * 1e-9
}

fn timed(library: &str, operation: &str, work: impl FnOnce() -> usize) {
    let start = cpu_seconds();
    let valid = work();
    let seconds = cpu_seconds() - start;
    println!("{library}\t{operation}\t{valid}\t{seconds:.9}");
}

fn run() {
    let specs = [spec()];
    let mut built = None;
    timed("ours", "build", || {
        let body = Body::build(&specs, &[]).unwrap();
        let faces = body.face_count();
        built = Some(body);
        faces
    });
    let body = built.unwrap();
    let Orders { random, flips, splits } = Orders::new(&body);
    for (library, open) in
        [("ours", Editor::new as fn(Body) -> Editor), ("ours without journal", Editor::without_journal)]
    {
        for (name, order) in [("random", &random), ("mesh order", &flips)] {
            let mut editor = open(body.clone());
            timed(library, &format!("flip, {name}"), || {
                let flip = |e: &&u32| editor.swap_edge(SURFACE, EdgeId(**e), Guard::None).is_ok();
                order.iter().filter(flip).count()
            });
        }
        for (name, order) in [("random", &random), ("mesh order", &splits)] {
            let mut editor = open(body.clone());
            timed(library, &format!("split, {name}"), || {
                let split = |e: &&u32| editor.split_edge(SURFACE, EdgeId(**e), 0.5).is_ok();
                order[..SPLITS].iter().filter(split).count()
            });
        }
        let mut editor = open(body.clone());
        timed(library, "collapse, random", || {
            let options = CollapseOptions::default();
            let mut valid = 0;
            for &e in &random {
                // An edge that went with another is no edge any more.
                let [_, keep] = editor.body().surface(SURFACE).edges()[e as usize];
                let done = editor.collapse_edge(SURFACE, EdgeId(e), NodeId(keep), &options);
                valid += usize::from(done.is_ok());
                if valid == COLLAPSES {
                    break;
                }
            }
            valid
        });
    }
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["panel", folder] => write_panel(Path::new(folder)),
        ["run", ..] => run(),
        _ => println!("peer_ours panel DIR | peer_ours run DIR"),
    }
}
