//! Bodies: adjacency, splits, checks, counts. Throughput is in the elements that each bench names.

// A bench speaks to the person who runs it.
#![allow(clippy::print_stdout)]

use std::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{BatchSize, BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use mesh_kernel::body::edit::{CollapseOptions, Editor, Guard};
use mesh_kernel::body::{Body, EdgeId, FaceId, NodeId, SurfaceId, SurfaceSpec};
use mesh_kernel::glam::DVec3;
use mesh_kernel::{Group, TriMesh};

/// A curved panel of about `2 n²` triangles.
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

/// The panel in 8 strips, joined.
fn strips(n: usize) -> TriMesh {
    let mut mesh = panel(n);
    let each = (mesh.faces.len() / 8) as u32;
    mesh.groups = (0..8)
        .map(|k| {
            let end = if k == 7 { mesh.faces.len() as u32 } else { (k + 1) * each };
            Group { name: format!("strip {k}"), faces: k * each..end }
        })
        .collect();
    mesh
}

fn spec(mesh: &TriMesh) -> SurfaceSpec {
    SurfaceSpec { name: "panel".into(), positions: mesh.positions.clone(), faces: mesh.faces.clone() }
}

fn shuffled(n: usize) -> Vec<u32> {
    let mut order: Vec<u32> = (0..n as u32).collect();
    let mut state = 12_345u64;
    for i in (1..n).rev() {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        order.swap(i, (state >> 33) as usize % (i + 1));
    }
    order
}

/// Swaps, splits and collapses that are valid one after the other, in one random order and in the mesh's.
fn operators(group: &mut BenchmarkGroup<'_, WallTime>, one: &Body) {
    const S: SurfaceId = SurfaceId(0);
    let edges = one.surface(S).edges().len();
    let swap = |editor: &mut Editor, e: u32| editor.swap_edge(S, EdgeId(e), Guard::None).is_ok();
    let split = |editor: &mut Editor, e: u32| editor.split_edge(S, EdgeId(e), 0.5).is_ok();
    let collapse = |editor: &mut Editor, e: u32| {
        let keep = NodeId(editor.body().surface(S).edges()[e as usize][1]);
        editor.collapse_edge(S, EdgeId(e), keep, &CollapseOptions::default()).is_ok()
    };
    type Operator<'a> = (&'a str, &'a dyn Fn(&mut Editor, u32) -> bool, usize);
    let operators: [Operator; 3] =
        [("swap", &swap, edges), ("split", &split, 100_000), ("collapse", &collapse, 50_000)];
    for (order_name, order) in [("random", shuffled(edges)), ("mesh order", (0..edges as u32).collect())] {
        for (name, operator, most) in operators {
            let mut trial = Editor::without_journal(one.clone());
            let valid = order.iter().copied().filter(|&e| operator(&mut trial, e)).take(most);
            let valid: Vec<u32> = valid.collect();
            group.throughput(Throughput::Elements(valid.len() as u64));
            for (journal, make) in
                [("journal", Editor::new as fn(Body) -> Editor), ("no journal", Editor::without_journal)]
            {
                group.bench_function(format!("edge {name}, {order_name}, {journal}: edges"), |b| {
                    b.iter_batched(
                        || make(one.clone()),
                        |mut editor| {
                            valid.iter().for_each(|&e| _ = operator(&mut editor, e));
                            editor
                        },
                        BatchSize::LargeInput,
                    );
                });
            }
        }
    }
}

fn body(c: &mut Criterion) {
    let mesh = panel(316);
    let triangles = mesh.faces.len() as u64;
    let one = Body::build(&[spec(&mesh)], &[]).expect("sound");
    let joined = Body::from_tri_mesh(&strips(316)).expect("sound");

    let mut group = c.benchmark_group("body");
    group.sample_size(20);
    group.throughput(Throughput::Elements(triangles));
    let specs = [spec(&mesh)];
    group.bench_function("build: triangles of one surface", |b| {
        b.iter(|| Body::build(black_box(&specs), &[]))
    });
    group.bench_function("from_tri_mesh: triangles", |b| b.iter(|| Body::from_tri_mesh(black_box(&mesh))));
    let grouped = strips(316);
    group.bench_function("from_tri_mesh, 8 joined strips: triangles", |b| {
        b.iter(|| Body::from_tri_mesh(black_box(&grouped)));
    });
    group.bench_function("to_tri_mesh: triangles", |b| b.iter(|| black_box(&joined).to_tri_mesh()));
    group.bench_function("counts: triangles", |b| b.iter(|| black_box(&joined).counts()));
    group.bench_function("check: triangles", |b| b.iter(|| black_box(&joined).check()));

    group.throughput(Throughput::Elements(4 * triangles));
    group.bench_function("split_all: new triangles", |b| {
        b.iter_batched(|| one.clone(), |mut body| body.split_all(None).map(|_| body), BatchSize::LargeInput);
    });
    group.bench_function("split_all, 8 joined strips: new triangles", |b| {
        b.iter_batched(
            || joined.clone(),
            |mut body| body.split_all(None).map(|_| body),
            BatchSize::LargeInput,
        );
    });
    group.throughput(Throughput::Elements(1000));
    group.bench_function("split_face: faces", |b| {
        b.iter_batched(
            || joined.clone(),
            |mut body| {
                for k in 0..1000u32 {
                    let _ = body.split_face(SurfaceId(k % 8), FaceId(k * 7919 % 20_000));
                }
                body
            },
            BatchSize::LargeInput,
        );
    });

    operators(&mut group, &one);
    group.finish();

    let bytes = one.surface(SurfaceId(0)).bytes() as f64 / triangles as f64;
    println!("bytes a triangle, {triangles} triangles: {bytes:.1}");
}

criterion_group!(benches, body);
criterion_main!(benches);
