//! Signed distance against exact winding numbers.

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use mesh_kernel::query::{SignedDistance, WindingNumber, winding_number};

use crate::shapes::{Random, icosphere, shared_body, torus};

fn band(mesh: &TriMesh, count: usize, width: f64, seed: u64) -> Vec<DVec3> {
    let mut random = Random(seed);
    (0..count)
        .map(|_| {
            let f = (random.next() % mesh.faces.len() as u64) as u32;
            let [a, b, c] = mesh.corners(f);
            let (u, v) = (random.unit(), random.unit());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let n = mesh.area_normal(f).normalize_or_zero();
            a + (b - a) * u + (c - a) * v + n * (random.unit() - 0.5) * 2.0 * width
        })
        .collect()
}

/// Every sign agrees with the sum of all solid angles; points where that sum itself is within rounding of one half are
/// left out.
fn check_signs(name: &str, mesh: &TriMesh, points: &[DVec3]) {
    let query = SignedDistance::new(mesh);
    for p in points {
        let exact = winding_number(mesh, *p);
        if (exact - 0.5).abs() > 1e-9 {
            let signed = query.signed(*p);
            assert_eq!(signed.distance < 0.0, exact > 0.5, "{name} {p} {exact} {signed:?}");
            assert_eq!(query.is_inside(*p), exact > 0.5, "{name} {p} {exact}");
        }
    }
}

#[test]
fn analytic_distances() {
    let sphere = icosphere(100.0, 6);
    let query = SignedDistance::new(&sphere);
    let mut random = Random(5);
    for _ in 0..2000 {
        let p = random.in_box(DVec3::splat(-200.0), DVec3::splat(200.0));
        let signed = query.signed(p);
        assert!((signed.distance - (p.length() - 100.0)).abs() < 0.06, "{p} {signed:?}");
        assert!(signed.normal.dot(signed.point.normalize()) > 0.99);
    }
    assert!(query.is_inside(DVec3::ZERO) && !query.is_inside(DVec3::splat(1e9)));
    let none = SignedDistance::new(&TriMesh::default());
    assert!(none.signed(DVec3::ZERO).distance == f64::INFINITY && !none.is_inside(DVec3::ZERO));
    assert_eq!(query.signed(DVec3::NAN).distance, f64::INFINITY);
}

#[test]
fn signs_on_broken_meshes() {
    let mut random = Random(7);
    let ring = torus(300.0, 100.0, 48, 24);
    let lo = DVec3::new(-450.0, -150.0, -450.0);
    let box_points: Vec<DVec3> = (0..600).map(|_| random.in_box(lo, -lo)).collect();
    let check = |name: &str, mesh: &TriMesh| {
        let mut points = box_points.clone();
        points.extend(band(mesh, 900, 30.0, 8));
        check_signs(name, mesh, &points);
    };
    check("closed", &ring);
    let mut holed = ring.clone();
    let mut k = 0;
    holed.faces.retain(|f| {
        k += 1;
        ring.positions[f[0] as usize].x < 330.0 && k % 97 != 0
    });
    check("holes", &holed);
    let mut soup = TriMesh::default();
    for f in 0..ring.faces.len() as u32 {
        let first = soup.positions.len() as u32;
        soup.positions.extend(ring.corners(f));
        soup.faces.push([first, first + 1, first + 2]);
    }
    check("unwelded", &soup);
    let mut shaken = soup.clone();
    for p in &mut shaken.positions {
        *p += random.in_box(DVec3::splat(-3.0), DVec3::splat(3.0));
    }
    check("loose faces", &shaken);
    let mut flipped = ring.clone();
    flipped.faces.iter_mut().step_by(41).for_each(|f| f.swap(0, 1));
    check("some faces turned", &flipped);
    let mut inverted = ring.clone();
    inverted.faces.iter_mut().for_each(|f| f.swap(0, 1));
    check("inside out", &inverted);
    let mut double = ring.clone();
    double.positions.extend(ring.positions.iter().map(|p| *p + DVec3::new(50.0, 20.0, 0.0)));
    double.faces.extend(ring.faces.iter().map(|f| f.map(|v| v + ring.positions.len() as u32)));
    check("overlapping", &double);
    let mut bubble = ring.clone();
    let inner = torus(300.0, 60.0, 48, 24);
    bubble
        .faces
        .extend(inner.faces.iter().map(|f| [f[0], f[2], f[1]].map(|v| v + ring.positions.len() as u32)));
    bubble.positions.extend(inner.positions);
    check("hollow", &bubble);
    let mut fins = ring.clone();
    for k in 0..40u32 {
        fins.positions.push(random.in_box(lo, -lo));
        fins.faces.push([k * 20, k * 20 + 1, fins.positions.len() as u32 - 1]);
    }
    check("fins", &fins);
    let mut touching = icosphere(100.0, 3);
    let other = icosphere(100.0, 3);
    let n = touching.positions.len() as u32;
    touching.faces.extend(other.faces.iter().map(|f| f.map(|v| v + n)));
    touching.positions.extend(other.positions.iter().map(|p| *p + DVec3::X * 200.0));
    check("touching in a node", &touching);
    // The cone over a hole runs through a ball that lies in the hole.
    let mut bowl = icosphere(100.0, 4);
    let positions = bowl.positions.clone();
    bowl.faces.retain(|f| f.iter().any(|v| positions[*v as usize].x < 60.0));
    let n = bowl.positions.len() as u32;
    let ball = icosphere(30.0, 3);
    bowl.faces.extend(ball.faces.iter().map(|f| f.map(|v| v + n)));
    bowl.positions.extend(ball.positions.iter().map(|p| *p + DVec3::X * 60.0));
    check("ball in a hole", &bowl);
}

#[test]
fn winding_errors_are_bounded() {
    let ring = torus(300.0, 100.0, 96, 48);
    let query = WindingNumber::new(&ring);
    let mut random = Random(9);
    for _ in 0..500 {
        let p = random.in_box(DVec3::splat(-500.0), DVec3::splat(500.0));
        let exact = winding_number(&ring, p);
        for tolerance in [1e-2, 1e-4, 1e-8, 0.0] {
            let got = query.winding(p, tolerance);
            assert!((got.value - exact).abs() <= got.error + 1e-11, "{p} {got:?} {exact}");
        }
    }
}

#[test]
fn signs_on_bodies_and_scans() {
    for name in ["female-average", "scan-noisy-plus", "scan-noisy-tall"] {
        let Some(body) = shared_body(name) else { return };
        check_signs(name, &body, &band(&body, 300, 0.02, 11));
    }
}

#[test]
fn a_moved_mesh_answers_as_a_new_one() {
    let mut mesh = torus(300.0, 100.0, 48, 24);
    let before = SignedDistance::new(&mesh);
    for p in &mut mesh.positions {
        *p += DVec3::new(50.0 + 0.2 * p.y, 0.1 * p.x, 0.0003 * p.x * p.x);
    }
    let (moved, new) = (before.moved(&mesh).unwrap(), SignedDistance::new(&mesh));
    let mut points = band(&mesh, 1500, 60.0, 11);
    points.extend(mesh.positions.iter().step_by(5));
    for p in points {
        // At a side both faces are as near: which one is told hangs on the hierarchy.
        let (got, wanted) = (moved.signed(p), new.signed(p));
        assert_eq!((got.distance, got.normal), (wanted.distance, wanted.normal), "{p}");
        assert!(got.point.distance(wanted.point) < 1e-9, "{p}");
    }
    // Other faces, and a mesh with a hole, must be prepared anew.
    let faces = mesh.faces.split_off(1);
    assert!(before.moved(&TriMesh::new(mesh.positions.clone(), faces.clone())).is_none());
    let open = TriMesh::new(mesh.positions, faces);
    assert!(SignedDistance::new(&open).moved(&open).is_none());
}
