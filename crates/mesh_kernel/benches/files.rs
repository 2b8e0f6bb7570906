//! Mesh files in and out, 200 000 triangles.

use criterion::{Criterion, criterion_group, criterion_main};
use mesh_kernel::TriMesh;
use mesh_kernel::files::{Format, WriteOptions, parse, to_bytes};
use mesh_kernel::glam::DVec3;

/// A torus with a wavy tube in millimetres: 2 · `around` · `across` triangles, coordinates of full precision.
fn wavy_torus(around: u32, across: u32) -> TriMesh {
    let positions = (0..around * across)
        .map(|k| {
            let (u, v) = (k / across, k % across);
            let u = f64::from(u) / f64::from(around) * std::f64::consts::TAU;
            let v = f64::from(v) / f64::from(across) * std::f64::consts::TAU;
            let tube = 100.0 + 10.0 * (5.0 * u).sin() * (3.0 * v).cos();
            let ring = 300.0 + tube * v.cos();
            DVec3::new(ring * u.cos(), tube * v.sin(), ring * u.sin())
        })
        .collect();
    let at = |u: u32, v: u32| (u % around) * across + v % across;
    let faces = (0..around * across)
        .flat_map(|k| {
            let (u, v) = (k / across, k % across);
            [[at(u, v), at(u, v + 1), at(u + 1, v)], [at(u + 1, v), at(u, v + 1), at(u + 1, v + 1)]]
        })
        .collect();
    TriMesh::new(positions, faces)
}

fn files(c: &mut Criterion) {
    let mesh = wavy_torus(400, 250);
    let mut rounded = mesh.clone();
    for p in &mut rounded.positions {
        *p = (*p * 1e5).round() / 1e5;
    }
    let options = WriteOptions::default();
    let mut group = c.benchmark_group("files 200k");
    group.sample_size(20);
    for (name, mesh) in [("17 digits", &mesh), ("5 decimals", &rounded)] {
        for format in [Format::Obj, Format::Ply, Format::Stl, Format::Off, Format::Glb] {
            let bytes = to_bytes(format, mesh, &options);
            group.bench_function(format!("{format} write, {name}"), |b| {
                b.iter(|| to_bytes(format, mesh, &options))
            });
            group.bench_function(format!("{format} read, {name}"), |b| {
                b.iter(|| parse(format, &bytes).is_ok())
            });
        }
    }
    group.finish();
}

criterion_group!(benches, files);
criterion_main!(benches);
