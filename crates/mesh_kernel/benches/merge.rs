//! Unions of two solids of 100,000 triangles each, beside boolmesh: from arrays to arrays, on one thread.
//!
//! boolmesh needs two-manifolds and decides with tolerances; ours takes any models and decides exactly.

use boolmesh::prelude::{Manifold, OpType, compute_boolean};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DQuat, DVec3};
use mesh_kernel::merge::{Boolean, MergeOptions, boolean};

#[allow(dead_code, reason = "the tests use more of it")]
#[path = "../tests/all/shapes.rs"]
mod shapes;
use shapes::torus;

/// Pairs that cross a little, along long curves, and nowhere.
fn pairs() -> [(&'static str, TriMesh, TriMesh); 3] {
    let one = || torus(60.0, 20.0, 316, 158);
    let moved = |turn: f64, shift: DVec3| {
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, 0.3, 0.2).normalize(), turn);
        let mut mesh = one();
        mesh.positions.iter_mut().for_each(|p| *p = turn * *p + shift);
        mesh
    };
    [
        ("linked", one(), moved(1.3, DVec3::new(60.0, 3.0, 1.0))),
        ("nearly the same", one(), moved(0.05, DVec3::new(0.5, 0.3, 0.2))),
        ("apart", one(), moved(1.3, DVec3::new(300.0, 0.0, 0.0))),
    ]
}

/// As boolmesh takes it.
fn flat(mesh: &TriMesh) -> (Vec<f64>, Vec<usize>) {
    let positions = mesh.positions.iter().flat_map(|p| p.to_array()).collect();
    let faces = mesh.faces.iter().flatten().map(|v| *v as usize).collect();
    (positions, faces)
}

fn unions(c: &mut Criterion) {
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for (name, a, b) in pairs() {
        let mut group = c.benchmark_group(format!("union, {name}"));
        group.sample_size(10).throughput(Throughput::Elements((a.faces.len() + b.faces.len()) as u64));
        group.bench_function("ours", |bencher| {
            bencher
                .iter(|| one_thread.install(|| boolean(&[&a, &b], Boolean::Union, &MergeOptions::default())));
        });
        let peers = [flat(&a), flat(&b)];
        group.bench_function("boolmesh", |bencher| {
            bencher.iter(|| {
                let [a, b] = peers.each_ref().map(|(p, f)| Manifold::new(p, f).expect("a torus is manifold"));
                compute_boolean(&a, &b, OpType::Add)
            });
        });
        group.finish();
        let ours = boolean(&[&a, &b], Boolean::Union, &MergeOptions::default()).expect("tori are closed");
        let theirs = peers.each_ref().map(|(p, f)| Manifold::new(p, f).expect("a torus is manifold"));
        let theirs: Manifold = compute_boolean(&theirs[0], &theirs[1], OpType::Add).expect("a union");
        let difference = volume(&theirs) / ours.volume() - 1.0;
        assert!(difference.abs() < 1e-11, "{name}: volumes differ by {difference:e}");
    }
}

/// Volume of boolmesh's own mesh, whose half-edges come in threes.
fn volume(mesh: &Manifold) -> f64 {
    let at = |h: usize| DVec3::from_array(mesh.ps[mesh.hs[h].tail].to_array());
    (0..mesh.nf).map(|f| at(3 * f).cross(at(3 * f + 1)).dot(at(3 * f + 2)) / 6.0).sum()
}

criterion_group!(benches, unions);
criterion_main!(benches);
