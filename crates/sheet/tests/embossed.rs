//! Plates with small things on one side: engraved and embossed signs.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[allow(dead_code, reason = "shared by test files")]
mod solid_models;

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use sheet::deflate::{DeflateOptions, Nobody, deflate};
use solid_models::turned;

const CELL: f64 = 2.2;
const PLATE: f64 = 2.0;
/// Where signs are on the plate, a cell a letter.
const SIGNS: [&str; 13] = [
    "............................",
    "............................",
    "..x......xxxxx..x...x..x....",
    "..x......x...x..x...x..x....",
    "..x......x...x..x...x..x....",
    "..xxxxx..x...x..xxxxx..x....",
    "..x......x...x......x..x....",
    "..x......x...x......x..x....",
    "..xxxxx..xxxxx......x..x....",
    "............................",
    "............................",
    "............................",
    "............................",
];

fn is_sign(i: usize, j: usize) -> bool {
    SIGNS[j].as_bytes()[i] == b'x'
}

/// A plate whose signs are so high, from below.
fn plate(signs: f64) -> TriMesh {
    let (n, m) = (SIGNS[0].len(), SIGNS.len());
    let height = |i: usize, j: usize| if is_sign(i, j) { signs } else { PLATE };
    let mut mesh = TriMesh::new(Vec::new(), Vec::new());
    let mut quad = |corners: [DVec3; 4]| {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(corners);
        mesh.faces.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    };
    let at = |i: usize, j: usize, z: f64| DVec3::new(CELL * i as f64, CELL * j as f64, z);
    for i in 0..n {
        for j in 0..m {
            let z = height(i, j);
            quad([at(i, j, z), at(i + 1, j, z), at(i + 1, j + 1, z), at(i, j + 1, z)]);
            quad([at(i, j, 0.0), at(i, j + 1, 0.0), at(i + 1, j + 1, 0.0), at(i + 1, j, 0.0)]);
        }
    }
    // Upright faces between cells, each from the height of the one to that of the other.
    let mut upright = |a: [usize; 2], b: [usize; 2], from: f64, to: f64| {
        if from != to {
            quad([at(a[0], a[1], from), at(b[0], b[1], from), at(b[0], b[1], to), at(a[0], a[1], to)]);
        }
    };
    for i in 0..=n {
        for j in 0..m {
            let [west, east] =
                [i.checked_sub(1), (i < n).then_some(i)].map(|c| c.map_or(0.0, |c| height(c, j)));
            upright([i, j + 1], [i, j], west, east);
        }
    }
    for j in 0..=m {
        for i in 0..n {
            let [south, north] =
                [j.checked_sub(1), (j < m).then_some(j)].map(|c| c.map_or(0.0, |c| height(i, c)));
            upright([i, j], [i + 1, j], south, north);
        }
    }
    mesh
}

#[test]
fn signs_on_a_plate_are_steps() {
    for signs in [1.2, 1.6, 2.4, 2.8] {
        let solid = plate(signs);
        let thin = deflate(&solid, &DeflateOptions::default(), &Nobody).unwrap();
        let r = &thin.report;
        let what = format!("signs {signs}");
        assert_eq!((r.self_intersections, r.lost_edges, r.components), (0, 0, 1), "{what}");
        // Every cell is in the middle of its own thickness.
        let (mut of_signs, mut of_plate) = (0.0, 0.0);
        for (f, t) in (0u32..).zip(&thin.thickness) {
            let across = thin.sheet.area_normal(f) / 2.0;
            if across.z.abs() < 0.5 * across.length() {
                continue;
            }
            let [p, q, r] = thin.sheet.corners(f);
            let middle = (p + q + r) / 3.0;
            let [i, j] = [middle.x, middle.y].map(|x| (x / CELL) as usize);
            let wanted = if is_sign(i, j) { signs } else { PLATE };
            assert!((middle.z - wanted / 2.0).abs() < 1e-9, "{what}: {middle} is not in the middle");
            assert!((t - wanted).abs() < 1e-9, "{what}: {t} mm thick at {middle}");
            *(if is_sign(i, j) { &mut of_signs } else { &mut of_plate }) += across.length();
        }
        let cells = |sign: bool| {
            let all = (0..SIGNS.len()).flat_map(|j| (0..SIGNS[0].len()).map(move |i| is_sign(i, j)));
            all.filter(|s| *s == sign).count() as f64 * CELL * CELL
        };
        assert!((of_signs - cells(true)).abs() < 1e-6, "{what}: {of_signs} mm² of {}", cells(true));
        assert!((of_plate - cells(false)).abs() < 1e-6, "{what}: {of_plate} mm² of {}", cells(false));
        let other = deflate(&turned(&solid), &DeflateOptions::default(), &Nobody).unwrap();
        assert!((other.report.area / r.area - 1.0).abs() < 1e-6, "{what}");
    }
}
