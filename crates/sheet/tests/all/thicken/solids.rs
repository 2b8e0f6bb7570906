//! Thickened sheets: valid solids with the volume that formulas give, whatever merges.

use std::f64::consts::PI;

use crate::thicken::sheet_models as models;
use mesh_kernel::TriMesh;
use mesh_kernel::files;
use mesh_kernel::glam::DVec3;
use sheet::thicken::{
    Corners, Nobody, PlaceKind, Role, Side, ThickenError, ThickenOptions, Thickened, Thickness, thicken,
};

fn options(t: f64, corners: Corners) -> ThickenOptions {
    ThickenOptions { corners, ..ThickenOptions::new(t) }
}

fn solid(name: &str, sheet: &TriMesh, options: &ThickenOptions) -> Thickened {
    let thick = thicken(sheet, options, &Nobody).unwrap_or_else(|e| panic!("{name}: {e}"));
    let report = &thick.report;
    assert!(report.closed, "{name}: open");
    assert_eq!(report.self_intersections, 0, "{name}");
    assert!(report.volume > 0.0 && report.components > 0, "{name}: {report:?}");
    assert_eq!(thick.origins.len(), thick.solid.faces.len());
    assert_eq!(report.faces, thick.solid.faces.len());
    let ends = thick.solid.groups.iter().map(|g| g.faces.len()).sum::<usize>();
    assert_eq!(ends, report.faces, "{name}: every face has a group");
    thick
}

fn assert_volume(name: &str, thick: &Thickened, wanted: f64, tolerance: f64) {
    let error = thick.report.volume / wanted - 1.0;
    assert!(error.abs() < tolerance, "{name}: {error:e}");
}

#[test]
fn every_sheet_becomes_a_valid_solid() {
    for (name, sheet) in models::all() {
        for (t, corners) in
            [(0.5, Corners::Round), (2.0, Corners::Round), (2.0, Corners::Mitre), (5.0, Corners::Round)]
        {
            solid(&format!("{name}, t {t}, {corners:?}"), &sheet, &options(t, corners));
        }
    }
}

#[test]
fn joints_finer_than_the_depth_are_exact() {
    let (t, d) = (2.0, 1.0);
    let q = (1.0 - PI / 4.0) * d * d;
    for n in [12, 30, 70] {
        for turn in [false, true] {
            let sheet = |s: TriMesh| if turn { models::turned(s) } else { s };
            let name = |kind: &str| format!("{kind} {n} {turn}");
            let thick = solid(&name("L"), &sheet(models::l_sheet(n)), &options(t, Corners::Round));
            assert_volume(&name("L"), &thick, 60.0 * (2.0 * d * 150.0 - q), 1e-9);
            let thick = solid(&name("T"), &sheet(models::t_sheet(n)), &options(t, Corners::Round));
            assert_volume(&name("T"), &thick, 60.0 * (4.0 * d * 50.0 + 2.0 * d * 50.0 - 2.0 * d * d), 1e-9);
        }
    }
}

#[test]
fn walls_have_the_thickness_that_was_asked_for() {
    let flat = solid("open box", &models::turned(models::open_box(8, true)), &options(2.0, Corners::Round));
    assert!((flat.report.min_wall - 2.0).abs() < 1e-9 && (flat.report.max_wall - 2.0).abs() < 1e-9);
    for (k, wanted) in [(3, 3e-3), (5, 2e-4)] {
        let curved = solid("hemisphere", &models::sphere(k, true), &options(2.0, Corners::Round));
        let report = &curved.report;
        assert!(report.min_wall > 2.0 - wanted && report.max_wall < 2.0 + wanted, "{report:?}");
        assert!(report.places.is_empty(), "{report:?}");
    }
}

#[test]
fn sheets_nearer_than_the_thickness_grow_together() {
    let thick = solid("near plates", &models::near_plates(1.3), &options(2.0, Corners::Round));
    assert_volume("near plates", &thick, 40.0 * 30.0 * 3.3, 1e-9);
    assert_eq!(thick.report.components, 1);
    assert!(thick.report.places.iter().any(|p| p.kind == PlaceKind::Merged && p.patches == [0, 1]));
    let thick = solid("far plates", &models::near_plates(2.5), &options(2.0, Corners::Round));
    assert_eq!((thick.report.components, thick.report.places.len()), (2, 0));
}

#[test]
fn bends_tighter_than_the_depth_are_told() {
    let thick = solid("bend", &models::bent_strip(0.6, 6, 5), &options(2.0, Corners::Round));
    let tight: Vec<_> = thick.report.places.iter().filter(|p| p.kind == PlaceKind::TightCurvature).collect();
    assert_eq!(tight.len(), 1);
    assert!(tight[0].at.distance(DVec3::new(0.4, 15.0, 0.2)) < 1.0 && tight[0].patches == [0]);
    let thick = solid("bend", &models::bent_strip(3.0, 6, 5), &options(2.0, Corners::Round));
    assert!(thick.report.places.is_empty());
}

/// A ring about the axis `z`, its tube of radius `narrow` about a circle of radius `wide`.
fn torus(wide: f64, narrow: f64, n: usize) -> TriMesh {
    let patch = models::Patches::default().grid(n, 2 * n, |s, t| {
        // Whole turns are none, lest rounding part the ends.
        let (s, t) = ((2.0 * PI * (s % 1.0)).sin_cos(), (2.0 * PI * (t % 1.0)).sin_cos());
        let r = wide + narrow * s.1;
        DVec3::new(r * t.1, r * t.0, narrow * s.0)
    });
    patch.mesh
}

#[test]
fn a_tube_narrower_than_its_wall_is_filled() {
    let (wide, narrow) = (10.0, 3.0);
    let sheet = torus(wide, narrow, 24);
    for t in [6.0, 6.1, 6.5, 8.0, 12.0, 13.8] {
        let thick = solid(&format!("torus {t}"), &sheet, &options(t, Corners::Round));
        assert_eq!((thick.report.components, thick.report.genus), (1, 1), "{t}");
        let radius = narrow + t / 2.0;
        assert_volume(&format!("torus {t}"), &thick, 2.0 * PI * PI * wide * radius * radius, 0.01);
    }
}

/// Half the thickness from a little less than the ring's hole to far more: dozens of walls go through the axis.
#[test]
fn a_ring_closes_on_its_own_axis() {
    let (wide, narrow) = (10.0, 3.0);
    let sheet = torus(wide, narrow, 24);
    for t in [13.9, 14.0, 14.05, 14.1, 14.2, 14.5, 15.0, 16.0, 20.0] {
        let thick = solid(&format!("ring {t}"), &sheet, &options(t, Corners::Round));
        assert_eq!((thick.report.components, thick.report.genus), (1, 0), "{t}");
        // A spindle torus: what is inside its lemon is counted once.
        let radius: f64 = narrow + t / 2.0;
        let square = (radius * radius - wide * wide).max(0.0);
        let tip = square.sqrt();
        let lemon = (wide * wide + radius * radius) * tip
            - tip.powi(3) / 3.0
            - wide * (tip * wide + radius * radius * (tip / radius).asin());
        let volume = 2.0 * PI * (PI * wide * radius * radius + lemon);
        assert_volume(&format!("ring {t}"), &thick, volume, 0.01);
    }
}

#[test]
fn mitres_beyond_the_limit_are_told() {
    let sharp = models::fan(&[0.0, 0.3], 50.0, 3);
    let thick = solid("sharp fold", &sharp, &options(1.0, Corners::Mitre));
    assert!(thick.report.places.iter().any(|p| p.kind == PlaceKind::MitreLimit));
    let thick = solid("L", &models::l_sheet(3), &options(1.0, Corners::Mitre));
    assert!(thick.report.places.is_empty());
}

#[test]
fn roles_and_holes_of_a_t() {
    let thick = solid("T", &models::t_sheet(3), &options(2.0, Corners::Round));
    assert_eq!(thick.report.holes_filled, 2);
    let names: Vec<&str> = thick.solid.groups.iter().map(|g| g.name.as_str()).collect();
    assert_eq!(names, ["front_wall", "back_wall", "thickness_faces", "fills"]);
    let walls = thick.origins.iter().filter(|o| matches!(o.role, Role::FrontWall | Role::BackWall)).count();
    assert_eq!(walls, 2 * 54);
}

#[test]
fn one_side_needs_two_sides_to_choose_from() {
    let front = ThickenOptions { side: Side::Front, ..ThickenOptions::new(1.0) };
    let refusal = |sheet: &TriMesh| thicken(sheet, &front, &Nobody).unwrap_err();
    match refusal(&models::t_sheet(2)) {
        ThickenError::NonManifold { patches, at, faces } => {
            assert_eq!((patches, faces), (vec![0, 1, 2], 3));
            assert!(at.x == 0.0 && at.z == 0.0);
        }
        other => panic!("{other}"),
    }
    assert!(matches!(refusal(&models::bow_tie()), ThickenError::NonManifold { .. }));
    assert!(matches!(refusal(&models::moebius(40)), ThickenError::NotOrientable { .. }));
    // The second leg of an L is wound against the first: one of the two is turned.
    let thick = solid("L", &models::l_sheet(3), &front);
    assert_eq!(thick.report.turned.len(), 1);
    assert_eq!(thick.report.components, 1);
    let back = ThickenOptions { side: Side::Back, ..front.clone() };
    let other = solid("L", &models::l_sheet(3), &back);
    // Inside the fold the square of the thickness is shared, outside a quarter disk is added.
    let volumes = thick.report.volume + other.report.volume;
    let wanted = 60.0 * (2.0 * 150.0 - 1.0 + PI / 4.0);
    assert!((volumes / wanted - 1.0).abs() < 1e-9, "{volumes} {wanted}");
}

#[test]
fn what_cannot_be_thickened_is_refused() {
    let refusal = |sheet: &TriMesh, options: &ThickenOptions| thicken(sheet, options, &Nobody).unwrap_err();
    let plate = models::plate(2, 2);
    let even = ThickenOptions::new(1.0);
    assert_eq!(refusal(&TriMesh::default(), &even), ThickenError::Empty);
    let flat = TriMesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::X * 2.0], vec![[0, 1, 2]]);
    assert_eq!(refusal(&flat, &even), ThickenError::Empty);
    let mut broken = plate.clone();
    broken.positions[3].y = f64::NAN;
    assert_eq!(refusal(&broken, &even), ThickenError::NotFinite { node: 3 });
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = refusal(&plate, &ThickenOptions::new(bad));
        assert!(matches!(refused, ThickenError::ThicknessNotPositive { index: None, .. }), "{refused}");
    }
    let refused = refusal(&plate, &ThickenOptions::new(1e4));
    assert!(matches!(refused, ThickenError::ThicknessTooLarge { .. }));
    for (thickness, expected) in
        [(Thickness::PerPatch(vec![1.0; 2]), 1), (Thickness::PerNode(vec![1.0; 2]), 9)]
    {
        let refused = refusal(&plate, &ThickenOptions { thickness, ..even.clone() });
        assert!(
            matches!(refused, ThickenError::ThicknessCount { expected: e, given: 2, .. } if e == expected)
        );
    }
    let refused = refusal(&plate, &ThickenOptions { chord: Some(0.0), ..even.clone() });
    assert!(matches!(refused, ThickenError::OptionRange { option: "chord", .. }));
}

#[test]
fn shared_sheets_become_valid_solids() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/sheets");
    if !folder.exists() {
        let required = std::env::var("TOILE_REQUIRE_SHARED").is_ok_and(|v| v == "1");
        assert!(!required, "{} is required and not there", folder.display());
        return;
    }
    let mut names: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|f| f.unwrap().path()).collect();
    names.sort();
    for path in names.iter().filter(|p| p.extension().is_some_and(|e| e == "obj")) {
        let sheet = files::read(path).unwrap();
        for t in [0.5, 2.0, 5.0] {
            solid(&format!("{} t {t}", path.display()), &sheet, &options(t, Corners::Round));
        }
    }
}
