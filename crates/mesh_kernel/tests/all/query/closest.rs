//! Closest points.

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use mesh_kernel::query::ClosestPoint;

use crate::shapes::{Random, icosphere, shared_body, torus};

/// Distance to a triangle by another way than the library's: projection if inside, else the sides.
fn distance(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let side = |a: DVec3, b: DVec3| {
        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(if t.is_nan() { a } else { a + (b - a) * t })
    };
    let n = (b - a).cross(c - a).normalize_or_zero();
    let inside = |a: DVec3, b: DVec3| (b - a).cross(p - a).dot(n) >= 0.0;
    let sides = side(a, b).min(side(b, c)).min(side(c, a));
    if n != DVec3::ZERO && inside(a, b) && inside(b, c) && inside(c, a) {
        sides.min((p - a).dot(n).abs())
    } else {
        sides
    }
}

fn check(mesh: &TriMesh, points: impl Iterator<Item = DVec3>) {
    let query = ClosestPoint::new(mesh);
    for p in points {
        let brute =
            (0..mesh.faces.len() as u32).map(|f| distance(p, mesh.corners(f))).fold(f64::INFINITY, f64::min);
        let got = query.closest(p).unwrap();
        let scale = 1e-12 * (1.0 + p.length());
        assert!((got.distance - brute).abs() <= scale + 1e-9 * brute, "{p} {} {brute}", got.distance);
        let [a, b, c] = mesh.corners(got.face);
        let [u, v, w] = got.barycentric;
        assert!((a * u + b * v + c * w).distance(got.point) < 1e-9 * (1.0 + a.length()));
        assert!(u >= -1e-12 && v >= 0.0 && w >= 0.0);
        assert!(query.closest_within(p, got.distance) == Some(got));
        assert!(query.closest_within(p, got.distance * 0.999_999) != Some(got) || got.distance == 0.0);
    }
}

#[test]
fn as_brute_force_finds_it() {
    let mut random = Random(1);
    let torus = torus(300.0, 100.0, 60, 30);
    let lo = DVec3::splat(-500.0);
    let mut points: Vec<DVec3> = (0..1500).map(|_| random.in_box(lo, -lo)).collect();
    points.extend((0..200).map(|_| random.in_box(lo, -lo) * 1e4));
    points.extend(torus.positions.iter().step_by(7));
    check(&torus, points.into_iter());
    // Far from the origin, small: the boxes' f32 must not lose it.
    let mut far = icosphere(1.0, 3);
    far.positions.iter_mut().for_each(|p| *p += DVec3::new(1e6, -2e6, 3e6));
    check(&far, (0..500).map(|_| DVec3::new(1e6, -2e6, 3e6) + random.in_box(-DVec3::ONE, DVec3::ONE) * 1.5));
}

#[test]
fn degenerate_and_empty_meshes() {
    let mut random = Random(2);
    let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let mesh = TriMesh::new(
        vec![
            p(0.0, 0.0, 0.0),
            p(1.0, 0.0, 0.0),
            p(2.0, 0.0, 0.0),
            p(2.0, 1e-9, 0.0),
            p(5.0, 5.0, 5.0),
            p(1.0, 1e-5, 0.3),
        ],
        vec![[0, 0, 0], [0, 1, 2], [2, 0, 3], [4, 4, 2], [4, 2, 4], [0, 5, 1], [0, 2, 5]],
    );
    check(&mesh, (0..2000).map(|_| random.in_box(DVec3::splat(-1.0), DVec3::splat(6.0))));
    let query = ClosestPoint::new(&mesh);
    assert!(query.closest(DVec3::NAN).is_none() && query.closest(DVec3::INFINITY).is_none());
    assert!(query.closest_within(DVec3::ZERO, f64::NAN).is_none());
    assert!(query.closest_within(DVec3::splat(9.0), -1.0).is_none());
    assert!(ClosestPoint::new(&TriMesh::default()).closest(DVec3::ZERO).is_none());
    let bad = TriMesh::new(vec![DVec3::NAN, DVec3::X, DVec3::Y, DVec3::Z], vec![[0, 1, 2], [1, 2, 3]]);
    assert_eq!(ClosestPoint::new(&bad).closest(DVec3::ZERO).unwrap().face, 1);
    // Many copies of one face cannot be split by place.
    let copies = TriMesh::new(vec![DVec3::X, DVec3::Y, DVec3::Z], vec![[0, 1, 2]; 5000]);
    assert!(
        (ClosestPoint::new(&copies).closest(DVec3::ZERO).unwrap().distance - 3f64.sqrt() / 3.0).abs() < 1e-12
    );
    // Sizes that grow by powers make the hierarchy deep.
    let positions: Vec<DVec3> =
        (0..900).map(|k| DVec3::new(2f64.powi(k / 3 - 140), f64::from(k % 3), 0.0)).collect();
    let faces = (0..300).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let deep = TriMesh::new(positions, faces);
    assert!(ClosestPoint::new(&deep).closest(DVec3::Z).is_some());
}

#[test]
fn on_a_body() {
    let Some(body) = shared_body("female-average") else { return };
    let mut random = Random(3);
    let lo = DVec3::new(-1.0, -0.2, -0.5);
    check(&body, (0..300).map(|_| random.in_box(lo, DVec3::new(1.0, 2.0, 0.5))));
}
