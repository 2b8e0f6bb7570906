//! Smooth shells whose two sides are finely meshed, each in its own way.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use sheet::deflate::{DeflateOptions, Nobody, deflate};

const WIDTH: f64 = 60.0;
const CELLS: u32 = 48;
const THICKNESS: f64 = 2.5;

/// A bulged patch at a place of the unit square, and its normal.
fn patch(u: f64, v: f64) -> (DVec3, DVec3) {
    let [x, y] = [u, v].map(|w| WIDTH * (w - 0.5));
    let p = DVec3::new(x, y, 12.0 - (x * x + 0.6 * y * y) / 90.0 + x * y / 200.0);
    let [along_x, along_y] = [-x / 45.0 + y / 200.0, -y / 75.0 + x / 200.0];
    (p, DVec3::new(-along_x, -along_y, 1.0).normalize())
}

/// Nodes of one side of a shell about the patch, `off` from it; `place` says where in the unit square each of the grid is.
fn side(off: f64, place: impl Fn(f64, f64) -> [f64; 2]) -> Vec<DVec3> {
    let steps = || (0..=CELLS).map(|k| f64::from(k) / f64::from(CELLS));
    let node = |u: f64, v: f64| {
        let [u, v] = place(u, v);
        let (p, normal) = patch(u, v);
        p + normal * off
    };
    steps().flat_map(|u| steps().map(move |v| [u, v])).map(|[u, v]| node(u, v)).collect()
}

/// A shell of even thickness whose inner grid drifts by up to `drift` cells away from the outer one, and back again to the rim.
fn shell(drift: f64) -> TriMesh {
    let cell = 1.0 / f64::from(CELLS);
    let bump = |u: f64| (std::f64::consts::PI * u).sin().powi(2);
    let mut positions = side(THICKNESS / 2.0, |u, v| [u, v]);
    let n = positions.len() as u32;
    let aside = |u: f64, v: f64| drift * cell * bump(u) * bump(v);
    positions.extend(side(-THICKNESS / 2.0, |u, v| [u + aside(u, v), v + 0.7 * aside(u, v)]));
    let at = |i: u32, j: u32| i * (CELLS + 1) + j;
    let mut faces = Vec::new();
    for i in 0..CELLS {
        for j in 0..CELLS {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            faces.extend([[a, b, c], [a, c, d], [n + a, n + c, n + b], [n + a, n + d, n + c]]);
        }
    }
    let corners = [(0, 0), (1, 0), (1, 1), (0, 1)];
    for k in 0..4 {
        let (from, to) = (corners[k], corners[(k + 1) % 4]);
        let node = |s: u32| {
            let part = |a: u32, b: u32| a * (CELLS - s) + b * s;
            at(part(from.0, to.0), part(from.1, to.1))
        };
        for s in 0..CELLS {
            let (a, b) = (node(s), node(s + 1));
            faces.extend([[a, n + a, n + b], [a, n + b, b]]);
        }
    }
    TriMesh::new(positions, faces)
}

#[test]
fn sides_that_are_meshed_nearly_alike_are_not_taken_for_offsets() {
    let area: f64 = {
        let steps = || (0..200).map(|k| (f64::from(k) + 0.5) / 200.0);
        let slope = |u: f64, v: f64| 1.0 / patch(u, v).1.z;
        steps().flat_map(|u| steps().map(move |v| slope(u, v))).sum::<f64>() * (WIDTH / 200.0).powi(2)
    };
    for drift in [0.0, 0.4, 0.9, 1.6, 3.0] {
        let thin = deflate(&shell(drift), &DeflateOptions::default(), &Nobody).unwrap();
        let r = &thin.report;
        assert_eq!((r.self_intersections, r.lost_edges), (0, 0), "drift {drift}");
        assert_eq!([r.patches, r.joints, r.free_loops, r.components], [1, 0, 1, 1], "drift {drift}");
        assert!((r.area / area - 1.0).abs() < 5e-3, "drift {drift}: {} mm² instead of {area}", r.area);
        let off = |p: &DVec3| {
            let middle = patch(p.x / WIDTH + 0.5, p.y / WIDTH + 0.5);
            (middle.0 - *p).dot(middle.1).abs() / THICKNESS
        };
        let farthest = thin.sheet.positions.iter().map(off).fold(0.0, f64::max);
        assert!(farthest < 0.02, "drift {drift}: {farthest} of the thickness off the middle");
    }
}
