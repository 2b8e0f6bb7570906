//! Fairing, factorisation and solves on a curved panel (the sizes of the project's bars), and whole regenerations.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use template::fairing::plate::Hold;
use template::fairing::{Plate, Umbrella, flaps};

/// A doubly curved panel of `2 n²` triangles, 400 × 500 mm, its rim and a few inner nodes fixed.
fn panel(n: usize) -> (Vec<DVec3>, Vec<[u32; 3]>, Vec<Hold>) {
    let at = |i: usize, j: usize| (i * (n + 1) + j) as u32;
    let (mut positions, mut hold, mut faces) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..=n {
        for j in 0..=n {
            let (u, v) = (i as f64 / n as f64, j as f64 / n as f64);
            let bulge = 60.0 * (3.0 * u).sin() * (2.0 * v).cos();
            positions.push(DVec3::new(400.0 * u, 500.0 * v, bulge));
            let rim = i == 0 || j == 0 || i == n || j == n;
            let inner = (i * 5).is_multiple_of(n) && (j * 5).is_multiple_of(n);
            hold.push(if rim || inner { Hold::Fixed } else { Hold::Free });
        }
    }
    for i in 0..n {
        for j in 0..n {
            let q = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            faces.push([q[0], q[1], q[2]]);
            faces.push([q[0], q[2], q[3]]);
        }
    }
    (positions, faces, hold)
}

fn umbrella(c: &mut Criterion) {
    let mut group = c.benchmark_group("umbrella");
    let (positions, faces, hold) = panel(316);
    let fixed: Vec<bool> = hold.iter().map(|h| *h == Hold::Fixed).collect();
    let engine = Umbrella::new(&faces, &fixed);
    let steps = 20;
    group.sample_size(10).throughput(Throughput::Elements((steps * positions.len()) as u64));
    group.bench_function("node steps, 100k nodes", |b| {
        let mut p = positions.clone();
        b.iter(|| engine.iterate(black_box(&mut p), steps));
    });
    group.finish();
}

fn plate(c: &mut Criterion) {
    let mut group = c.benchmark_group("plate");
    group.sample_size(10).warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(3));
    for (name, n) in [("20k triangles", 100), ("200k triangles", 316)] {
        let (positions, faces, hold) = panel(n);
        let stencils = flaps(&positions, &faces);
        group.bench_function(BenchmarkId::new("from faces to solution", name), |b| {
            b.iter(|| {
                let plate =
                    Plate::new(flaps(&positions, &faces), &hold, &positions).expect("held at the rim");
                let mut p = positions.clone();
                plate.solve(&mut p, &positions).expect("regular");
                p
            });
        });
        let mut plate = Plate::new(stencils, &hold, &positions).expect("held at the rim");
        group.bench_function(BenchmarkId::new("numeric factor, pattern kept", name), |b| {
            b.iter(|| plate.set_springs(|_| 0.0).expect("regular"));
        });
        group.bench_function(BenchmarkId::new("new right-hand side (3 columns)", name), |b| {
            let mut p = positions.clone();
            b.iter(|| plate.solve(black_box(&mut p), &positions).expect("regular"));
        });
    }
    group.finish();
}

criterion_group!(benches, umbrella, plate);
criterion_main!(benches);
