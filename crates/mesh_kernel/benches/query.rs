//! Distance, inside, sections, crossings, paths: on bodies of the shared folder where it is there, and on a torus.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use mesh_kernel::query::{ClosestPoint, Crossings, Geodesics, SectionStack, SignedDistance};

#[allow(dead_code, reason = "the tests use more of it")]
#[path = "../tests/all/shapes.rs"]
mod shapes;
use shapes::{Random, shared_body, torus};

/// Meshes in metres.
fn meshes() -> Vec<(&'static str, TriMesh)> {
    let mut meshes = vec![("torus 27k", torus(0.6, 0.2, 164, 82))];
    for name in ["female-average", "scan-noisy-plus"] {
        meshes.extend(shared_body(name).map(|body| (name, body)));
    }
    meshes
}

/// Points within 2 cm of the skin: random faces, random places on them, moved along the normal.
fn band(mesh: &TriMesh, count: usize) -> Vec<DVec3> {
    let mut random = Random(1);
    (0..count)
        .map(|_| {
            let f = (random.next() % mesh.faces.len() as u64) as u32;
            let [a, b, c] = mesh.corners(f);
            let (u, v) = (random.unit(), random.unit());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let normal = mesh.area_normal(f).normalize_or_zero();
            a + (b - a) * u + (c - a) * v + normal * (random.unit() - 0.5) * 0.04
        })
        .collect()
}

fn distance(c: &mut Criterion) {
    for (name, mesh) in meshes() {
        let points = band(&mesh, 50_000);
        let mut group = c.benchmark_group(format!("distance, {name}"));
        group.sample_size(10);
        group.bench_function("build closest", |b| b.iter(|| ClosestPoint::new(&mesh)));
        group.bench_function("build signed", |b| b.iter(|| SignedDistance::new(&mesh)));
        let (closest, signed) = (ClosestPoint::new(&mesh), SignedDistance::new(&mesh));
        group.throughput(Throughput::Elements(points.len() as u64));
        group.bench_function("closest, band", |b| {
            b.iter(|| {
                points.iter().filter_map(|p| closest.closest(*p)).map(|found| found.distance).sum::<f64>()
            });
        });
        group.bench_function("signed, band", |b| {
            b.iter(|| points.iter().map(|p| signed.signed(*p).distance).sum::<f64>());
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

fn crossings(c: &mut Criterion) {
    for (name, mesh) in meshes() {
        let moved: Vec<DVec3> = mesh.positions.iter().map(|p| *p + DVec3::new(0.003, 0.002, 0.001)).collect();
        let other = TriMesh::new(moved, mesh.faces.clone());
        let mut group = c.benchmark_group(format!("crossings, {name}"));
        group.sample_size(10);
        let crossings = Crossings::new(&mesh);
        group.bench_function("with a copy moved 4 mm", |b| b.iter(|| crossings.faces_crossing(&other).len()));
        group.bench_function("with itself", |b| b.iter(|| crossings.self_crossing().len()));
        group.finish();
    }
}

fn paths(c: &mut Criterion) {
    for (name, mesh) in meshes() {
        let mut group = c.benchmark_group(format!("paths, {name}"));
        group.sample_size(10);
        group.bench_function("build", |b| b.iter(|| Geodesics::new(&mesh)));
        let paths = Geodesics::new(&mesh);
        let mut random = Random(5);
        let ends: Vec<[DVec3; 2]> = (0..20)
            .map(|_| {
                let mut end = || mesh.positions[(random.next() % mesh.positions.len() as u64) as usize];
                [end(), end()]
            })
            .collect();
        group.throughput(Throughput::Elements(ends.len() as u64));
        group.bench_function("path", |b| {
            b.iter(|| {
                ends.iter().filter_map(|[a, b]| paths.path(*a, *b)).map(|path| path.length).sum::<f64>()
            });
        });
        group.finish();
    }
}

criterion_group!(benches, distance, sections, crossings, paths);
criterion_main!(benches);
