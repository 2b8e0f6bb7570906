//! Distance, inside, sections, crossings: on a body of the shared folder where it is there, else on a torus.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use mesh_kernel::query::{ClosestPoint, SectionStack};

#[path = "../tests/query_shapes/mod.rs"]
mod query_shapes;
use query_shapes::{Random, shared_body, torus};

fn meshes() -> Vec<(&'static str, TriMesh)> {
    let mut meshes = vec![("torus 27k", torus(0.6, 0.2, 164, 82))];
    for name in ["female-average", "scan-noisy-plus"] {
        meshes.extend(shared_body(name).map(|body| (name, body)));
    }
    meshes
}

/// Points within 2 cm of the skin (metres): random faces, random places on them, moved along the normal.
fn band(mesh: &TriMesh, count: usize) -> Vec<DVec3> {
    let mut random = Random(1);
    (0..count)
        .map(|_| {
            let f = (random.next() % mesh.faces.len() as u64) as u32;
            let [a, b, c] = mesh.corners(f);
            let (u, v) = (random.unit(), random.unit());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            a + (b - a) * u
                + (c - a) * v
                + mesh.area_normal(f).normalize_or_zero() * (random.unit() - 0.5) * 0.04
        })
        .collect()
}

fn distance(c: &mut Criterion) {
    for (name, mesh) in meshes() {
        let points = band(&mesh, 100_000);
        let mut group = c.benchmark_group(format!("distance, {name}"));
        group.sample_size(10);
        group.bench_function("build closest", |b| b.iter(|| ClosestPoint::new(&mesh)));
        let closest = ClosestPoint::new(&mesh);
        group.throughput(Throughput::Elements(points.len() as u64));
        group.bench_function("closest, band", |b| {
            b.iter(|| points.iter().map(|p| closest.closest(*p).unwrap().distance).sum::<f64>());
        });
        group.finish();
    }
}

fn sections(c: &mut Criterion) {
    let Some(body) = shared_body("scan-remeshed") else { return };
    let mut group = c.benchmark_group("sections, 59k");
    group.sample_size(10);
    group.bench_function("build", |b| b.iter(|| SectionStack::new(&body, DVec3::Y)));
    let stack = SectionStack::new(&body, DVec3::Y);
    let [low, high] = stack.heights();
    group.bench_function("400 cuts", |b| {
        b.iter(|| {
            (0..400).map(|k| stack.cut(low + (high - low) * f64::from(k) / 400.0).len()).sum::<usize>()
        });
    });
    group.finish();
}

criterion_group!(benches, distance, sections);
criterion_main!(benches);
