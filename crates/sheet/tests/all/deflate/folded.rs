//! Sheets of flat facets that fold sharply, made thick and deflated: every facet comes back.

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use mesh_kernel::query::ClosestPoint;
use sheet::deflate::{DeflateOptions, Deflated, Nobody, deflate};
use sheet::thicken::{self, ThickenOptions, thicken};

/// A grid of cells, each cut along the same diagonal.
fn grid(along: u32, across: u32, at: impl Fn(f64, f64) -> DVec3) -> TriMesh {
    let nodes = (0..=along).flat_map(|i| (0..=across).map(move |j| (i, j)));
    let positions = nodes.map(|(i, j)| at(f64::from(i), f64::from(j))).collect();
    let row = across + 1;
    let cells = (0..along).flat_map(|i| (0..across).map(move |j| i * row + j));
    let faces = cells.flat_map(|a| [[a, a + row, a + row + 1], [a, a + row + 1, a + 1]]).collect();
    TriMesh::new(positions, faces)
}

/// A square grid drawn over half a sphere, a ring of it on a parallel: at its corners flat flaps stand out at the rim, folded by
/// some 70°.
fn squared_dome(cells: u32, radius: f64) -> TriMesh {
    grid(cells, cells, |i, j| {
        let [x, y] = [i, j].map(|k| 2.0 * k / f64::from(cells) - 1.0);
        let (sin, cos) = (x.abs().max(y.abs()) * std::f64::consts::FRAC_PI_2).sin_cos();
        let away = DVec3::new(x, y, 0.0).normalize_or_zero();
        (away * sin + DVec3::Z * cos) * radius
    })
}

/// Ridges that run out towards one side, folded up and down by up to 74°.
fn ridges() -> TriMesh {
    grid(8, 4, |i, j| {
        let height = if j % 2.0 == 0.0 { 2.4 } else { 6.0 };
        DVec3::new(8.0 * i, 10.0 * j, height * (i % 2.0))
    })
}

fn thick_and_back(sheet: &TriMesh, thickness: f64, edge_length: Option<f64>) -> Deflated {
    let solid = thicken(sheet, &ThickenOptions::new(thickness), &thicken::Nobody).unwrap().solid;
    let thin =
        deflate(&solid, &DeflateOptions { edge_length, ..DeflateOptions::default() }, &Nobody).unwrap();
    let r = &thin.report;
    assert_eq!((r.joints, r.free_loops, r.components), (0, 1, 1), "{r:?}");
    assert_eq!((r.self_intersections, r.lost_edges), (0, 0));
    assert!(thin.thickness.iter().all(|t| (t - thickness).abs() < 0.2 * thickness));
    thin
}

/// Nodes and middles of faces of each are on the other, up to a share of the thickness.
#[track_caller]
fn is_the_same(sheet: &TriMesh, thin: &TriMesh, thickness: f64, share: f64) {
    for (mesh, other) in [(sheet, thin), (thin, sheet)] {
        let closest = ClosestPoint::new(other);
        let middles = (0..mesh.faces.len() as u32).map(|f| mesh.corners(f).iter().sum::<DVec3>() / 3.0);
        for p in mesh.positions.iter().copied().chain(middles) {
            let off = closest.closest(p).unwrap().distance;
            assert!(off < share * thickness, "{p} is off by {off}");
        }
    }
}

#[test]
fn a_dome_with_flaps_comes_back() {
    let dome = squared_dome(4, 30.0);
    // At 6 % the wall's thickness has swallowed the inner side of the flaps.
    for thickness in [0.6, 1.8, 3.6] {
        let thin = thick_and_back(&dome, thickness, None);
        is_the_same(&dome, &thin.sheet, thickness, 1e-3);
    }
}

#[test]
fn ridges_up_and_down_come_back() {
    for thickness in [0.64, 1.9, 3.8] {
        let thin = thick_and_back(&ridges(), thickness, None);
        is_the_same(&ridges(), &thin.sheet, thickness, 1e-6);
    }
}

#[test]
fn an_edge_length_leaves_the_folds_where_they_are() {
    let thin = thick_and_back(&ridges(), 1.9, Some(2.0));
    is_the_same(&ridges(), &thin.sheet, 1.9, 1e-6);
    assert!(thin.sheet.faces.len() > 1000);
    for f in 0..thin.sheet.faces.len() as u32 {
        let [a, b, c] = thin.sheet.corners(f);
        assert!(a.distance(b).max(b.distance(c)).max(c.distance(a)) < 4.0);
    }
}
