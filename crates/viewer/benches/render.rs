//! Pictures of 100,000 triangles at 1024 x 768: bars are 100 ms plain and 1.2 s with soft shadows on two cores.

use std::f64::consts::TAU;
use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::{DVec2, DVec3};
use viewer::{
    Camera, Color, Drawing2d, Hidden, Item2d, Lens, PageOptions, Pen, RenderOptions, Scene, SceneLine,
    SceneMesh, View, cloth_color, render,
};

/// A folded tube of `2 n²` triangles, some two thirds of the picture's height and width.
fn cloth(n: u32) -> SceneMesh {
    let mut positions = Vec::new();
    for j in 0..=n {
        for i in 0..n {
            let (a, t) = (f64::from(i) / f64::from(n) * TAU, f64::from(j) / f64::from(n));
            let r = 300.0 + 150.0 * t + 40.0 * (12.0 * a).sin() * t;
            positions.push(DVec3::new(r * a.sin(), -900.0 * t, r * a.cos()));
        }
    }
    let mut faces = Vec::new();
    for j in 0..n {
        for i in 0..n {
            let (a, b) = (j * n + i, j * n + (i + 1) % n);
            faces.extend([[a, a + n, b + n], [a, b + n, b]]);
        }
    }
    SceneMesh::new(positions, faces, cloth_color(0))
}

fn pictures(criterion: &mut Criterion) {
    let mut scene = Scene { meshes: vec![cloth(224)], ..Scene::default() };
    let options = RenderOptions::sized(1024, 768);
    let camera = Camera::new(View::Front, Lens::PORTRAIT).fit(&scene, &options).expect("a sound scene");
    let mut group = criterion.benchmark_group("100k triangles, 1024 x 768");
    group.sample_size(10);
    let plain = options.clone().plain();
    group.bench_function("plain", |b| b.iter(|| render(black_box(&scene), &camera, &plain)));
    group.bench_function("soft shadows", |b| b.iter(|| render(black_box(&scene), &camera, &options)));
    scene.lines = (0..40)
        .map(|i| {
            let a = f64::from(i) / 40.0 * TAU;
            let corners = (0..=200).map(|k| f64::from(k) / 200.0);
            let at = |t: f64| {
                let r = 300.0 + 150.0 * t + 40.0 * (12.0 * a).sin() * t;
                DVec3::new(r * a.sin(), -900.0 * t, r * a.cos())
            };
            SceneLine {
                hidden: Hidden::Dashed,
                ..SceneLine::new(corners.map(at).collect(), Color::SEAM, 1.5)
            }
        })
        .collect();
    group.bench_function("plain with 40 lines", |b| b.iter(|| render(black_box(&scene), &camera, &plain)));
    group.finish();

    let ring = |i: u32| -> Vec<DVec2> {
        let centre = DVec2::new(f64::from(i % 6) * 500.0, f64::from(i / 6) * 700.0);
        (0..=2000)
            .map(|k| centre + DVec2::from_angle(f64::from(k) / 2000.0 * TAU) * DVec2::new(200.0, 300.0))
            .collect()
    };
    let drawing = Drawing2d {
        items: (0..18)
            .flat_map(|i| {
                [
                    Item2d::Polygon { rings: vec![ring(i)], fill: cloth_color(i as usize), opacity: 0.4 },
                    Item2d::Polyline { points: ring(i), pen: Pen::pixels(Color::INK, 1.5) },
                ]
            })
            .collect(),
    };
    criterion.bench_function("18 pieces of 2000 corners, 1600 x 1000", |b| {
        b.iter(|| black_box(&drawing).render(&PageOptions::default()));
    });
}

criterion_group!(benches, pictures);
criterion_main!(benches);
