//! Deflation of a ribbed plate and of a round tube, step by step: the work is ended when the next step begins.
#![allow(missing_docs, reason = "criterion's macros")]

use std::sync::atomic::{AtomicBool, Ordering};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use sheet::deflate::{DeflateOptions, Step, Watcher, deflate};

/// A profile drawn along z in cells, its sides cut in parts of about `side`; caps are fans of the sides to z's middle.
fn prism(profile: &[[f64; 2]], length: f64, side: f64) -> TriMesh {
    let mut ring: Vec<[f64; 2]> = Vec::new();
    for (i, [ax, ay]) in profile.iter().enumerate() {
        let [bx, by] = profile[(i + 1) % profile.len()];
        let parts = ((bx - ax).hypot(by - ay) / side).ceil().max(1.0);
        let at = |k: f64| [ax + (bx - ax) * k / parts, ay + (by - ay) * k / parts];
        ring.extend((0..parts as u32).map(|k| at(f64::from(k))));
    }
    let cells = (length / side).ceil() as u32;
    let n = ring.len() as u32;
    let mut mesh = TriMesh::default();
    for k in 0..=cells {
        let z = length * f64::from(k) / f64::from(cells);
        mesh.positions.extend(ring.iter().map(|[x, y]| DVec3::new(*x, *y, z)));
    }
    for k in 0..cells {
        for i in 0..n {
            let [a, b] = [k * n + i, k * n + (i + 1) % n];
            mesh.faces.extend([[a, b, b + n], [a, b + n, a + n]]);
        }
    }
    // A channel's profile is two rows of nodes, so its caps are strips.
    let half = n / 2;
    for start in [0, cells * n] {
        for i in 0..half - 1 {
            let [a, b, c, d] = [i, i + 1, n - 2 - i, n - 1 - i].map(|v| v + start);
            let faces = [[a, c, b], [a, d, c]];
            mesh.faces.extend(faces.map(|[p, q, r]| if start == 0 { [p, q, r] } else { [p, r, q] }));
        }
    }
    mesh
}

/// Ends the work when a step begins.
struct Until(Option<Step>, AtomicBool);

impl Watcher for Until {
    fn step(&self, step: Step) {
        self.1.fetch_or(self.0 == Some(step), Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.1.load(Ordering::Relaxed)
    }
}

fn bench(c: &mut Criterion) {
    // A plate of 400 × 300, 2 thick: two rows of nodes across.
    let plate = prism(&[[0., 0.], [400., 0.], [400., 2.], [0., 2.]], 300.0, 2.0);
    let mut group = c.benchmark_group("deflate");
    group.sample_size(10).throughput(Throughput::Elements(plate.faces.len() as u64));
    for (name, until) in [
        ("check", Some(Step::Segments)),
        ("check, faces", Some(Step::Pairs)),
        ("check, faces, walls", Some(Step::Replace)),
        ("all", None),
    ] {
        group.bench_with_input(BenchmarkId::new(name, plate.faces.len()), &plate, |b, plate| {
            b.iter(|| deflate(plate, &DeflateOptions::default(), &Until(until, false.into())));
        });
    }
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
