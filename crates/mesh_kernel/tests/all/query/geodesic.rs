//! Shortest paths on the surface.

use std::f64::consts::{PI, TAU};

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use mesh_kernel::query::{ClosestPoint, Geodesics, SurfacePath, shortest_path};

use crate::shapes::{Random, icosphere, shared_body, torus};

/// A flat or bent sheet: nodes of a jittered grid of `n` × `n` on the unit square, mapped.
fn sheet(n: u32, seed: u64, map: impl Fn(f64, f64) -> DVec3) -> TriMesh {
    let mut random = Random(seed);
    let positions = (0..(n + 1) * (n + 1))
        .map(|k| {
            let (i, j) = (k / (n + 1), k % (n + 1));
            let inside = |c: u32| c > 0 && c < n;
            let mut jitter = |c: u32| if inside(c) { (random.unit() - 0.5) * 0.6 } else { 0.0 };
            let (u, v) = (f64::from(i) + jitter(i), f64::from(j) + jitter(j));
            map(u / f64::from(n), v / f64::from(n))
        })
        .collect();
    let at = |i: u32, j: u32| i * (n + 1) + j;
    let faces = (0..n * n)
        .flat_map(|k| {
            let (i, j) = (k / n, k % n);
            [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
        })
        .collect();
    TriMesh::new(positions, faces)
}

fn check(query: &ClosestPoint, path: &SurfacePath) {
    assert_eq!(path.points.len(), path.faces.len() + 1);
    let length: f64 = path.points.windows(2).map(|p| p[0].distance(p[1])).sum();
    assert!((length - path.length).abs() < 1e-9 * (1.0 + length));
    for pair in path.points.windows(2) {
        for t in [0.0, 0.3, 0.5] {
            let p = pair[0].lerp(pair[1], t);
            assert!(query.closest(p).unwrap().distance < 1e-9 * (1.0 + p.length()), "off the surface");
        }
    }
}

#[test]
fn straight_on_a_plane() {
    let plane = sheet(30, 1, |u, v| DVec3::new(u * 100.0, 3.0, v * 100.0));
    let paths = Geodesics::new(&plane);
    let surface = ClosestPoint::new(&plane);
    let mut random = Random(2);
    let place = |u: f64, v: f64| DVec3::new(u * 100.0, 3.0, v * 100.0);
    for _ in 0..300 {
        let (a, b) = (place(random.unit(), random.unit()), place(random.unit(), random.unit()));
        let path = paths.path(a, b).unwrap();
        assert!((path.length - a.distance(b)).abs() < 1e-9, "{} {}", path.length, a.distance(b));
        check(&surface, &path);
    }
    // From node to node along a row of nodes, and from a point to itself.
    let path = shortest_path(&plane, place(0.0, 0.0), place(0.0, 1.0)).unwrap();
    assert!((path.windows(2).map(|p| p[0].distance(p[1])).sum::<f64>() - 100.0).abs() < 1e-9);
    assert_eq!(shortest_path(&plane, place(0.3, 0.3), place(0.3, 0.3)).unwrap().len(), 2);
}

#[test]
fn helices_on_a_cylinder() {
    // A polygonal prism unrolls exactly: the flat distance between corner angles is known.
    let (n, height) = (48, 200.0);
    let radius = 100.0;
    let side = 2.0 * radius * (PI / f64::from(n)).sin();
    let around = |u: f64| {
        // u in sides; between corners on the flat face.
        let (whole, part) = (u.floor(), u - u.floor());
        let corner =
            |k: f64| DVec3::new((k / f64::from(n) * TAU).cos(), 0.0, (k / f64::from(n) * TAU).sin()) * radius;
        corner(whole).lerp(corner(whole + 1.0), part)
    };
    let mut prism = sheet(n, 3, |u, v| around(u * f64::from(n)) + DVec3::Y * (v * height));
    // Rows stay on the prism's edges: no jitter around, only along.
    for (k, p) in prism.positions.iter_mut().enumerate() {
        let i = k as u32 / (n + 1);
        *p = around(f64::from(i % n)) + DVec3::Y * p.y;
    }
    // The last row is the first: the seam closes by place.
    let last = prism.positions.len() - (n + 1) as usize;
    for j in 0..=n as usize {
        prism.positions[last + j] = prism.positions[j];
    }
    let paths = Geodesics::new(&prism);
    let surface = ClosestPoint::new(&prism);
    let mut random = Random(4);
    for _ in 0..200 {
        let (u, v, w, x) =
            (random.unit() * 48.0, random.unit() * height, random.unit() * 48.0, random.unit() * height);
        let (a, b) = (around(u) + DVec3::Y * v, around(w) + DVec3::Y * x);
        let turn = (u - w).abs().min(48.0 - (u - w).abs()) * side;
        if turn > 22.0 * side {
            continue; // Both ways round are nearly as long.
        }
        let path = paths.path(a, b).unwrap();
        let exact = turn.hypot(v - x);
        assert!((path.length - exact).abs() < 1e-9 * exact.max(1.0), "{} {exact}", path.length);
        check(&surface, &path);
    }
}

#[test]
fn around_corners_of_holes_and_boundaries() {
    // A square ring: the path bends at the inner corner.
    let mut ring = sheet(20, 5, |u, v| DVec3::new(u * 20.0, v * 20.0, 0.0));
    let grid = sheet(20, 5, |u, v| DVec3::new((u * 20.0).round(), (v * 20.0).round(), 0.0));
    ring.positions = grid.positions;
    let positions = ring.positions.clone();
    ring.faces.retain(|f| {
        let mid = f.map(|v| positions[v as usize]).into_iter().sum::<DVec3>() / 3.0;
        !(mid.x > 5.0 && mid.x < 15.0 && mid.y > 5.0 && mid.y < 15.0)
    });
    let paths = Geodesics::new(&ring);
    let surface = ClosestPoint::new(&ring);
    let path = paths.path(DVec3::new(4.0, 12.0, 0.0), DVec3::new(12.0, 3.0, 0.0)).unwrap();
    let corner = DVec3::new(5.0, 5.0, 0.0);
    let exact = corner.distance(DVec3::new(4.0, 12.0, 0.0)) + corner.distance(DVec3::new(12.0, 3.0, 0.0));
    assert!((path.length - exact).abs() < 1e-9, "{} {exact}", path.length);
    check(&surface, &path);
    // Two sheets without a joint.
    let mut two = sheet(4, 6, |u, v| DVec3::new(u, v, 0.0));
    let n = two.positions.len() as u32;
    let other = sheet(4, 6, |u, v| DVec3::new(u, v, 5.0));
    two.positions.extend(other.positions);
    two.faces.extend(other.faces.iter().map(|f| f.map(|v| v + n)));
    assert!(shortest_path(&two, DVec3::ZERO, DVec3::Z * 5.0).is_none());
    assert!(shortest_path(&TriMesh::default(), DVec3::ZERO, DVec3::Z).is_none());
    assert!(shortest_path(&two, DVec3::NAN, DVec3::Z).is_none());
}

#[test]
fn great_circles_and_no_shortcuts() {
    let sphere = icosphere(100.0, 5);
    let paths = Geodesics::new(&sphere);
    let surface = ClosestPoint::new(&sphere);
    let mut random = Random(7);
    for _ in 0..100 {
        let mut end = || random.in_box(DVec3::splat(-1.0), DVec3::ONE).normalize();
        let (a, b) = (end(), end());
        let exact = 100.0 * a.cross(b).length().atan2(a.dot(b));
        let path = paths.path(a * 100.0, b * 100.0).unwrap();
        assert!((path.length / exact - 1.0).abs() < 2e-3, "{} {exact}", path.length);
        check(&surface, &path);
        let back = paths.path(b * 100.0, a * 100.0).unwrap();
        assert!((back.length / path.length - 1.0).abs() < 1e-3, "{} {}", back.length, path.length);
    }
    // A saddle-shaped surface: paths bend about nodes with more than a full turn.
    let ring = torus(300.0, 100.0, 60, 30);
    let paths = Geodesics::new(&ring);
    let surface = ClosestPoint::new(&ring);
    for k in 0..60 {
        let path = paths.path(ring.positions[k * 7], ring.positions[(k * 131 + 500) % 1800]).unwrap();
        check(&surface, &path);
    }
}

#[test]
fn on_a_body() {
    let Some(body) = shared_body("female-average") else { return };
    let paths = Geodesics::new(&body);
    let surface = ClosestPoint::new(&body);
    // From the left to the right side of the waist, front and back: about half a girth.
    let path = paths.path(DVec3::new(0.2, 1.05, 0.0), DVec3::new(-0.2, 1.05, 0.0)).unwrap();
    check(&surface, &path);
    assert!(path.length > 0.25 && path.length < 0.6, "{}", path.length);
}
