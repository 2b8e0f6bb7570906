//! Flattening and finishing on analytic patches: one large panel, a garment of 24 pieces, the file writers.
#![allow(missing_docs, clippy::unwrap_used)]

use criterion::{Criterion, criterion_group, criterion_main};
use mesh_kernel::{Group, TriMesh, glam::DVec3};
use pattern::*;

/// Half front bodice over n × m cells: a doubly curved panel 400 mm high.
fn bodice(n: u32, m: u32) -> TriMesh {
    let mut mesh = TriMesh::default();
    for i in 0..=n {
        for j in 0..=m {
            let (u, v) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(m));
            let angle = u * std::f64::consts::FRAC_PI_2;
            let top = 400.0 - 70.0 * (-(u / 0.22).powi(2)).exp() - 130.0 / (1.0 + (-(u - 0.72) / 0.06).exp());
            let h = v * top;
            let bust = 55.0 * (-((angle - 0.62) / 0.36).powi(2) - ((h - 210.0) / 60.0).powi(2)).exp();
            let r = 130.0 + 18.0 * (std::f64::consts::PI * (h - 80.0) / 400.0).sin().powi(2) + bust;
            mesh.positions.push(DVec3::new(1.15 * r * angle.sin(), h, r * angle.cos()));
        }
    }
    let at = |i: u32, j: u32| i * (m + 1) + j;
    for i in 0..n {
        for j in 0..m {
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            mesh.faces.extend(if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
    }
    mesh
}

/// The bodice cut into 6 × 4 panels of 500 triangles.
fn panels() -> TriMesh {
    let (n, m) = (60, 100);
    let whole = bodice(n, m);
    let mut mesh = TriMesh { positions: whole.positions, ..TriMesh::default() };
    for (i, j) in (0..6).flat_map(|i| (0..4).map(move |j| (i, j))) {
        let first = mesh.faces.len() as u32;
        for (k, face) in whole.faces.iter().enumerate() {
            let cell = k as u32 / 2;
            if cell / m / 10 == i && cell % m / 25 == j {
                mesh.faces.push(*face);
            }
        }
        mesh.groups.push(Group { name: format!("panel {i} {j}"), faces: first..mesh.faces.len() as u32 });
    }
    mesh
}

fn benches(c: &mut Criterion) {
    let mut group = c.benchmark_group("flatten");
    group.sample_size(10);
    for (name, n, m) in [("bodice_2k", 24, 42), ("bodice_20k", 77, 130)] {
        let input = input_of_mesh(&bodice(n, m), &FlattenMeshOptions::default()).unwrap();
        group.bench_function(name, |b| b.iter(|| make(&input, &PatternOptions::default()).unwrap()));
    }
    let input = input_of_mesh(&panels(), &FlattenMeshOptions::default()).unwrap();
    assert_eq!(input.patches.len(), 24);
    group.bench_function("garment_24x500", |b| b.iter(|| make(&input, &PatternOptions::default()).unwrap()));
    let pattern = make(&input, &PatternOptions::default()).unwrap();
    group.bench_function("dxf", |b| b.iter(|| to_dxf(&pattern, &DxfOptions::default())));
    group.bench_function("svg", |b| b.iter(|| to_svg(&pattern, &SvgOptions::default())));
    group.bench_function("pdf_a4", |b| b.iter(|| to_pdf(&pattern, &PdfOptions::default())));
    group.finish();
}

criterion_group!(flatten, benches);
criterion_main!(flatten);
