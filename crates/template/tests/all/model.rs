//! Analytic reference models with features drawn by formula.

use std::f64::consts::{PI, TAU};

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use reference::{FeatureCurve, FeaturePoint, Features};

/// A closed surface of revolution-like grid: `place(u, v)` with u round (closed) and v from pole to pole.
fn grid(place: &dyn Fn(f64, f64) -> DVec3, around: usize, along: usize, poles: bool) -> TriMesh {
    let mut positions = Vec::new();
    let mut faces = Vec::new();
    let rows = if poles { along - 1 } else { along };
    for j in 0..rows {
        let v = if poles { (j + 1) as f64 / along as f64 } else { j as f64 / along as f64 };
        for i in 0..around {
            positions.push(place(i as f64 / around as f64, v));
        }
    }
    let at = |i: usize, j: usize| ((j % rows) * around + i % around) as u32;
    for j in 0..if poles { rows - 1 } else { rows } {
        for i in 0..around {
            let q = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            faces.push([q[0], q[1], q[2]]);
            faces.push([q[0], q[2], q[3]]);
        }
    }
    if poles {
        let (south, north) = (positions.len() as u32, positions.len() as u32 + 1);
        positions.push(place(0.0, 0.0));
        positions.push(place(0.0, 1.0));
        for i in 0..around {
            faces.push([south, at(i + 1, 0), at(i, 0)]);
            faces.push([north, at(i, rows - 1), at(i + 1, rows - 1)]);
        }
    }
    TriMesh::new(positions, faces)
}

fn curve(closed: bool, count: usize, at: &dyn Fn(f64) -> (DVec3, DVec3)) -> FeatureCurve {
    let last = if closed { count } else { count - 1 };
    let (points, normals) = (0..count).map(|k| at(k as f64 / last as f64)).unzip();
    FeatureCurve { closed, points, normals }
}

/// A trunk: an upright ellipsoid with half axes 170 (left), 850 (up), 120 (front) mm on the floor, with `waist`,
/// `hip` (closed, anticlockwise from above) and the vertical curves `centre_front`, `centre_back`, `left_side`, `right_side`.
pub(crate) fn trunk() -> (TriMesh, Features) {
    let (a, b, c) = (170.0, 850.0, 120.0);
    let place = |angle: f64, height: f64| {
        let r = (1.0 - ((height - b) / b).powi(2)).max(0.0).sqrt();
        DVec3::new(a * r * angle.sin(), height, c * r * angle.cos())
    };
    let normal = |p: DVec3| DVec3::new(p.x / (a * a), (p.y - b) / (b * b), p.z / (c * c)).normalize();
    let both = |p: DVec3| (p, normal(p));
    // Anticlockwise from above: from the front to the left.
    let mesh = grid(&|u, v| place(TAU * u, b - b * (PI * v).cos()), 96, 80, true);
    let mut features = Features { facing: DVec3::Z, up: DVec3::Y, height: 2.0 * b, ..Features::default() };
    for (name, height) in [("waist", 1050.0), ("hip", 850.0)] {
        features.curves.insert(name.into(), curve(true, 180, &|t| both(place(TAU * t, height))));
    }
    for (name, angle) in
        [("centre_front", 0.0), ("left_side", 0.5 * PI), ("centre_back", PI), ("right_side", 1.5 * PI)]
    {
        let line = curve(false, 200, &|t| both(place(angle, 1600.0 - 1500.0 * t)));
        features.curves.insert(name.into(), line);
    }
    let chest = both(place(0.0, 1250.0));
    features.points.insert("chest".into(), FeaturePoint { position: chest.0, normal: chest.1 });
    (mesh, features)
}

/// Only a point `origin` with the frame of the axes; the body is a small ball five metres away.
pub(crate) fn nothing() -> (TriMesh, Features) {
    let ball = |u: f64, v: f64| {
        let (t, p) = (TAU * u, PI * v);
        DVec3::new(10.0 * p.sin() * t.sin(), -10.0 * p.cos(), 10.0 * p.sin() * t.cos() - 5000.0)
    };
    let mut features = Features { facing: DVec3::Z, up: DVec3::Y, height: 1680.0, ..Features::default() };
    features.points.insert("origin".into(), FeaturePoint { position: DVec3::ZERO, normal: DVec3::Z });
    (grid(&ball, 12, 8, true), features)
}

/// A ball of radius 200 about (0, 1000, 0) with the point `origin` in its middle.
pub(crate) fn ball() -> (TriMesh, Features) {
    let place = |u: f64, v: f64| {
        let (t, p) = (TAU * u, PI * v);
        DVec3::new(200.0 * p.sin() * t.sin(), 1000.0 - 200.0 * p.cos(), 200.0 * p.sin() * t.cos())
    };
    let (_, mut features) = nothing();
    features.points.insert("origin".into(), FeaturePoint { position: 1000.0 * DVec3::Y, normal: DVec3::Z });
    (grid(&place, 96, 64, true), features)
}

/// A ring of radii 220 and 60 about the vertical axis, in the plane y = 1000, with the point `origin` in its middle.
pub(crate) fn ring() -> (TriMesh, Features) {
    let place = |u: f64, v: f64| {
        let (t, p) = (TAU * u, TAU * v);
        let r = 220.0 - 60.0 * p.cos();
        DVec3::new(r * t.sin(), 1000.0 - 60.0 * p.sin(), r * t.cos())
    };
    let (_, features) = ball();
    (grid(&place, 128, 48, false), features)
}
