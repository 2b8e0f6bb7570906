//! Plane sections, hulls, adjacency.

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use mesh_kernel::query::{Adjacency, SectionStack, convex_hull_in_plane, plane_section, tape_length};

use crate::shapes::{icosphere, shared_body, torus};

#[test]
fn sphere_cuts_are_circles() {
    let sphere = icosphere(100.0, 5);
    let stack = SectionStack::new(&sphere, DVec3::Y * 3.0);
    for k in -99..=99 {
        let h = f64::from(k);
        let cut = stack.cut(h);
        assert_eq!(cut.len(), 1, "{h}");
        let ring = &cut[0];
        assert!(ring.closed && ring.faces.len() == ring.points.len());
        assert!(ring.points.iter().all(|p| (p.y - h).abs() < 1e-9));
        let r = (100.0f64.powi(2) - h * h).sqrt();
        assert!((ring.length() / (std::f64::consts::TAU * r) - 1.0).abs() < 0.03, "{h} {}", ring.length());
        assert!(ring.area(DVec3::Y) > 0.0, "anticlockwise");
        assert!((tape_length(&ring.points, DVec3::Y) - ring.length()).abs() < 1e-6 * r + 0.02 * r);
        let other = plane_section(&sphere, DVec3::Y * h, DVec3::Y);
        assert_eq!(other.len(), 1);
        assert!((other[0].length() - ring.length()).abs() < 1e-9);
        for (k, f) in ring.faces.iter().enumerate() {
            let [a, b, c] = sphere.corners(*f);
            let n = (b - a).cross(c - a).normalize();
            let mid = (ring.points[k] + ring.points[(k + 1) % ring.points.len()]) / 2.0;
            assert!((mid - a).dot(n).abs() < 1e-9, "the piece lies in its face");
        }
    }
    assert!(stack.cut(101.0).is_empty() && stack.cut(-101.0).is_empty() && stack.cut(f64::NAN).is_empty());
    assert!(SectionStack::new(&TriMesh::default(), DVec3::Y).cut(0.0).is_empty());
    assert!(SectionStack::new(&sphere, DVec3::ZERO).cut(0.0).is_empty());
}

#[test]
fn planes_through_nodes_edges_and_faces() {
    // An octahedron: four nodes lie on the plane, and the plane y = 1 touches one node.
    let octahedron = icosphere(1.0, 0);
    let top = octahedron.positions.iter().map(|p| p.y).fold(f64::MIN, f64::max);
    assert!(plane_section(&octahedron, DVec3::Y * top, DVec3::Y).is_empty());
    // A box with faces on the plane: one loop below the lid, none above.
    let corner = |k: u32| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2 & 1));
    let cube = TriMesh::new(
        (0..8).map(corner).collect(),
        vec![
            [0, 4, 6],
            [0, 6, 2],
            [1, 3, 7],
            [1, 7, 5],
            [0, 1, 5],
            [0, 5, 4],
            [2, 6, 7],
            [2, 7, 3],
            [0, 2, 3],
            [0, 3, 1],
            [4, 5, 7],
            [4, 7, 6],
        ],
    );
    let adjacency = Adjacency::new(&cube);
    assert!(adjacency.is_closed_manifold() && adjacency.is_closed() && adjacency.edges().len() == 18);
    let stack = SectionStack::new(&cube, DVec3::Y);
    for (height, loops) in [(0.0, 0), (0.5, 1), (1.0, 1)] {
        let cut = stack.cut(height);
        assert_eq!(cut.len(), loops, "{height}");
        for ring in cut {
            assert!((ring.length() - 4.0).abs() < 1e-12 && (ring.area(DVec3::Y) - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn holes_open_chains() {
    let mut sphere = icosphere(100.0, 4);
    sphere.faces.retain(|f| {
        let mid = f.map(|v| sphere.positions[v as usize]).into_iter().sum::<DVec3>() / 3.0;
        mid.x < 80.0 && mid.z < 80.0
    });
    let adjacency = Adjacency::new(&sphere);
    assert!(!adjacency.is_closed());
    let loops = adjacency.boundary_loops();
    assert_eq!(loops.len(), 2);
    assert_eq!(
        loops.iter().map(Vec::len).sum::<usize>(),
        (0..adjacency.edges().len() as u32).filter(|e| adjacency.half_edges(*e).len() == 1).count()
    );
    let stack = SectionStack::new(&sphere, DVec3::Y);
    let cut = stack.cut(1.234);
    assert_eq!(cut.len(), 2);
    for chain in &cut {
        assert!(!chain.closed && chain.faces.len() + 1 == chain.points.len());
        assert!(chain.points.windows(2).all(|p| p[0].distance(p[1]) < 20.0));
    }
    let whole = stack.cut(99.0);
    assert!(whole.len() == 1 && whole[0].closed);
}

#[test]
fn a_torus_has_two_rings_and_a_turned_mesh_still_chains() {
    let mut torus = torus(300.0, 100.0, 64, 32);
    let areas = |mesh: &TriMesh| -> Vec<f64> {
        plane_section(mesh, DVec3::X * 0.1, DVec3::X).iter().map(|c| c.area(DVec3::X)).collect()
    };
    let before = areas(&torus);
    assert!(
        before.len() == 2 && before.iter().all(|a| (a / (std::f64::consts::PI * 1e4) - 1.0).abs() < 0.02)
    );
    // Every third face turned over: still two closed rings.
    for face in torus.faces.iter_mut().step_by(3) {
        face.swap(1, 2);
    }
    let after = plane_section(&torus, DVec3::X * 0.1, DVec3::X);
    assert!(after.len() == 2 && after.iter().all(|c| c.closed));
    // Three sheets at one edge: the section of the third ends there.
    let fin = TriMesh::new(
        vec![DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::NEG_X, DVec3::Z],
        vec![[0, 1, 2], [1, 0, 3], [0, 1, 4]],
    );
    let cut = plane_section(&fin, DVec3::Y * 0.5, DVec3::Y);
    assert_eq!(cut.len(), 2);
    assert!((cut.iter().map(|c| c.length()).sum::<f64>() - 1.5).abs() < 1e-12);
}

#[test]
fn hulls() {
    let square: Vec<DVec3> =
        [[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [2.0, 2.0], [1.0, 1.0], [0.0, 2.0], [0.0, 1.0]]
            .iter()
            .map(|p| DVec3::new(p[0], 5.0, -p[1]))
            .collect();
    let hull = convex_hull_in_plane(&square, DVec3::Y);
    assert_eq!(hull.len(), 4);
    let twice: DVec3 = hull.windows(2).map(|p| (p[0] - hull[0]).cross(p[1] - hull[0])).sum();
    assert!(twice.y > 0.0);
    assert_eq!(tape_length(&square, DVec3::Y), 8.0);
    assert_eq!(tape_length(&square[..2], DVec3::Y), 4.0);
    assert_eq!(tape_length(&[], DVec3::Y), 0.0);
    assert_eq!(tape_length(&[DVec3::ONE, DVec3::ONE], DVec3::Y), 0.0);
    assert_eq!(convex_hull_in_plane(&[DVec3::NAN, DVec3::ONE], DVec3::Y), [DVec3::ONE]);
}

#[test]
fn cuts_of_scanned_bodies() {
    for name in ["scan-noisy-plus", "scan-remeshed", "female-average"] {
        let Some(body) = shared_body(name) else { return };
        let stack = SectionStack::new(&body, DVec3::Y);
        let [low, high] = stack.heights();
        for k in 1..200 {
            let h = low + (high - low) * f64::from(k) / 200.0;
            let cut = stack.cut(h);
            let plane = plane_section(&body, DVec3::Y * h, DVec3::Y);
            let total =
                |chains: &[mesh_kernel::query::SectionLoop]| chains.iter().map(|c| c.length()).sum::<f64>();
            assert!((total(&cut) - total(&plane)).abs() < 1e-9 * total(&plane), "{name} {h}");
            assert!(!cut.is_empty());
            if name != "scan-noisy-plus" {
                assert!(cut.iter().all(|c| c.closed), "{name} {h}");
            }
        }
    }
}
