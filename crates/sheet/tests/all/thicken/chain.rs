//! The chain of offsets: closed on every sheet, with the volume that formulas give.

use std::f64::consts::PI;

use crate::thicken::sheet_models as models;
use mesh_kernel::TriMesh;
use sheet::thicken::{Corners, OffsetChain, Side, ThickenOptions, Thickness, offset_chain};

fn options(t: f64, corners: Corners) -> ThickenOptions {
    ThickenOptions { corners, ..ThickenOptions::new(t) }
}

fn assert_closed(name: &str, chain: &OffsetChain) {
    let mut edges: Vec<(u32, u32, i32)> = chain
        .mesh
        .faces
        .iter()
        .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
        .map(|(a, b)| if a < b { (a, b, 1) } else { (b, a, -1) })
        .collect();
    edges.sort_unstable();
    for same in edges.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
        let sum: i32 = same.iter().map(|e| e.2).sum();
        assert_eq!(sum, 0, "{name}: edge {:?} is open", &same[0]);
    }
    assert!(chain.mesh.positions.iter().all(|p| p.is_finite()), "{name}");
    assert_eq!(chain.mesh.faces.len(), chain.origins.len(), "{name}");
}

fn volume(chain: &OffsetChain) -> f64 {
    let at = |v: u32| chain.mesh.positions[v as usize] - chain.mesh.positions[0];
    chain.mesh.faces.iter().map(|f| at(f[0]).dot(at(f[1]).cross(at(f[2]))) / 6.0).sum()
}

fn assert_volume(name: &str, sheet: &TriMesh, options: &ThickenOptions, wanted: f64, tolerance: f64) {
    let chain = offset_chain(sheet, options).unwrap();
    assert_closed(name, &chain);
    let error = volume(&chain) / wanted - 1.0;
    assert!(error.abs() < tolerance, "{name}: {error:e}");
}

#[test]
fn chains_are_closed_on_every_sheet() {
    for (name, sheet) in models::all() {
        for t in [0.5, 2.0, 5.0, 30.0] {
            for corners in [Corners::Round, Corners::Mitre] {
                let chain = offset_chain(&sheet, &options(t, corners)).unwrap();
                assert_closed(&format!("{name}, t {t}, {corners:?}"), &chain);
                let volume = volume(&chain);
                assert!(volume > 0.0, "{name}, t {t}, {corners:?}: {volume}");
            }
        }
    }
}

#[test]
fn plates_are_exact() {
    for n in [1, 2, 9] {
        for sheet in [models::plate(n, n), models::turned(models::plate(n, n))] {
            for side in [Side::Both, Side::Front, Side::Back] {
                let options = ThickenOptions { side, ..ThickenOptions::new(2.0) };
                assert_volume("plate", &sheet, &options, 40.0 * 30.0 * 2.0, 1e-12);
                let chain = offset_chain(&sheet, &options).unwrap();
                assert_eq!(chain.holes_filled, 0);
                // A wall each side, two triangles an edge of the boundary.
                assert_eq!(chain.mesh.faces.len(), 4 * n * n + 8 * n);
            }
        }
    }
}

#[test]
fn folds_and_joints_with_cells_wider_than_the_depth_are_exact() {
    let (t, d) = (2.0, 1.0);
    let q = (1.0 - PI / 4.0) * d * d;
    let e = 1.0 - PI / 6.0;
    for turn in [false, true] {
        let sheet = |s: TriMesh| if turn { models::turned(s) } else { s };
        for n in [1, 3, 8] {
            let l = sheet(models::l_sheet(n));
            assert_volume("L", &l, &options(t, Corners::Mitre), 60.0 * 2.0 * d * 150.0, 1e-12);
            assert_volume("L", &l, &options(t, Corners::Round), 60.0 * (2.0 * d * 150.0 - q), 1e-12);
            let wanted = 60.0 * (4.0 * d * 50.0 + 2.0 * d * 50.0 - 2.0 * d * d);
            assert_volume("T", &sheet(models::t_sheet(n)), &options(t, Corners::Round), wanted, 1e-12);
            let wanted = 60.0 * (8.0 * d * 50.0 - 4.0 * d * d);
            assert_volume("X", &sheet(models::x_sheet(n)), &options(t, Corners::Round), wanted, 1e-12);
            let wanted = 60.0 * (6.0 * d * 60.0 - 3f64.sqrt() * d * d);
            assert_volume("Y", &sheet(models::y_sheet(n)), &options(t, Corners::Round), wanted, 1e-12);

            let (w, b, h) = (100.0, 60.0, 40.0);
            let mitred = (w + t) * (b + t) * (h + d) - (w - t) * (b - t) * (h - d);
            let rounded = mitred - q * (4.0 * h + 2.0 * w + 2.0 * b) - 4.0 * e * d.powi(3);
            let open = sheet(models::open_box(n, false));
            assert_volume("open box", &open, &options(t, Corners::Mitre), mitred, 1e-12);
            assert_volume("open box", &open, &options(t, Corners::Round), rounded, 1e-12);
            let partition = sheet(models::open_box(n, true));
            let wall = (b - t) * (h - d) * t;
            assert_volume("partition", &partition, &options(t, Corners::Mitre), mitred + wall, 1e-12);
            assert_volume("partition", &partition, &options(t, Corners::Round), rounded + wall, 1e-12);

            let (w, b, h) = (20.0, 30.0, 40.0);
            let mitred = (w + t) * (b + t) * (h + t) - (w - t) * (b - t) * (h - t);
            let rounded = mitred - q * 4.0 * (w + b + h) - 8.0 * e * d.powi(3);
            let closed = sheet(models::closed_box(n));
            assert_volume("closed box", &closed, &options(t, Corners::Mitre), mitred, 1e-12);
            assert_volume("closed box", &closed, &options(t, Corners::Round), rounded, 1e-12);
        }
    }
}

#[test]
fn one_side_of_a_sphere() {
    for k in 2..5 {
        let sheet = models::sphere(k, false);
        for (side, t, outer, inner) in [(Side::Front, 3.0, 53.0f64, 50.0f64), (Side::Back, 3.0, 50.0, 47.0)] {
            let options = ThickenOptions { side, ..ThickenOptions::new(t) };
            let wanted = 4.0 / 3.0 * PI * (outer.powi(3) - inner.powi(3));
            assert_volume("sphere", &sheet, &options, wanted, 0.35 / 4f64.powi(k as i32 - 1));
        }
    }
}

#[test]
fn thickness_per_patch_and_per_node() {
    let sheet = models::t_sheet(3);
    let even = ThickenOptions::new(2.0);
    let patches = ThickenOptions { thickness: Thickness::PerPatch(vec![2.0; 3]), ..even.clone() };
    let nodes =
        ThickenOptions { thickness: Thickness::PerNode(vec![2.0; sheet.positions.len()]), ..even.clone() };
    let chain = offset_chain(&sheet, &even).unwrap();
    for other in [patches, nodes] {
        assert_eq!(chain.mesh.faces, offset_chain(&sheet, &other).unwrap().mesh.faces);
    }
    // A wedge of a plate: thickness from 1 to 3 along x.
    let plate = models::plate(4, 3);
    let thickness: Vec<f64> = plate.positions.iter().map(|p| 1.0 + 2.0 * p.x / 40.0).collect();
    let options = ThickenOptions { thickness: Thickness::PerNode(thickness), ..even.clone() };
    assert_volume("wedge", &plate, &options, 2.0 * 40.0 * 30.0, 1e-12);
    // Two plates in one plane with a step.
    let step = models::Patches::default()
        .plane([0., 0., 0.], [10., 0., 0.], [0., 30., 0.], 2, 3)
        .plane([10., 0., 0.], [20., 0., 0.], [0., 30., 0.], 2, 3)
        .mesh;
    let options = ThickenOptions { thickness: Thickness::PerPatch(vec![1.0, 4.0]), ..even };
    assert_volume("step", &step, &options, 30.0 * (10.0 * 1.0 + 20.0 * 4.0), 1e-12);
    assert_volume("step", &models::turned(step), &options, 30.0 * (10.0 * 1.0 + 20.0 * 4.0), 1e-12);
}
