//! Small features: which are found, which go, which stay.

use crate::deflate::solid_models::{plate_with_hole, prism};
use crate::deflate::support::{deflated, has_topology, near};
use sheet::deflate::{DeflateOptions, Nobody, deflate};

#[test]
fn small_steps_are_listed_and_go_by_size() {
    // Plates of 2 and 2.4 with flush undersides.
    let plates = [[0., 0.], [100., 0.], [100., 2.4], [50., 2.4], [50., 2.], [0., 2.]];
    let solid = prism(&plates, 40.0, 6);
    let with = |simplify: f64, keep: Vec<usize>| {
        let options = DeflateOptions { simplify: Some(simplify), keep, ..DeflateOptions::default() };
        deflate(&solid, &options, &Nobody).unwrap()
    };
    let kept = with(0.3, vec![]);
    assert_eq!(kept.report.features.len(), 1);
    assert_eq!((kept.report.features[0].kind, kept.report.features[0].removed), ("step", false));
    near(kept.report.features[0].size, 0.4, 1e-9);
    let gone = with(0.5, vec![]);
    has_topology(&gone, [1, 0, 1, 1]);
    near(gone.report.area, 4000.0, 1e-12);
    assert!(gone.report.features[0].removed);
    let asked = with(0.5, vec![0]);
    has_topology(&asked, [3, 0, 1, 1]);
    assert_eq!(asked.report.features[0].kept_because, Some("kept as asked"));
}

#[test]
fn a_chamfer_at_the_rim_ends_at_the_rim() {
    let solid = prism(&[[0., 0.], [60., 0.], [60., 2.2], [59.2, 3.], [0.8, 3.], [0., 2.2]], 40.0, 5);
    let thin = deflated(&solid);
    has_topology(&thin, [1, 0, 1, 1]);
    near(thin.report.area, 60.0 * 40.0, 1e-9);
    assert_eq!(thin.report.features.iter().filter(|f| f.kind == "chamfer").count(), 2);
}

#[test]
fn fillets_at_a_root_go_and_the_walls_meet() {
    // The T with a fillet of radius 2 on either side of the stem, in six chords.
    let mut profile = vec![[-30., -1.], [30., -1.], [30., 1.]];
    let arc = |k: i32| std::f64::consts::FRAC_PI_2 * f64::from(k) / 6.0;
    profile.extend((0..=6).map(|k| [3.0 - 2.0 * arc(k).sin(), 3.0 - 2.0 * arc(k).cos()]));
    profile.extend([[1., 25.], [-1., 25.]]);
    profile.extend((0..=6).rev().map(|k| [-3.0 + 2.0 * arc(k).sin(), 3.0 - 2.0 * arc(k).cos()]));
    profile.push([-30., 1.]);
    for cells in [1, 8] {
        let thin = deflated(&prism(&profile, 40.0, cells));
        has_topology(&thin, [3, 1, 2, 1]);
        near(thin.report.area, 40.0 * 85.0, 1e-12);
        let kinds: Vec<&str> = thin.report.features.iter().map(|f| f.kind).collect();
        assert_eq!(kinds, ["fillet", "fillet"]);
        thin.report.features.iter().for_each(|f| near(f.size, 2.0, 0.05));
    }
}

#[test]
fn holes_stay_unless_they_are_small_and_not_kept() {
    let plate = plate_with_hole(60.0, 40.0, 2.0, 3.0, 24);
    let with = |simplify, keep: &[usize]| {
        let keep = keep.to_vec();
        deflate(&plate, &DeflateOptions { simplify, keep, ..DeflateOptions::default() }, &Nobody).unwrap()
    };
    let hole = 24.0 / 2.0 * 9.0 * (std::f64::consts::TAU / 24.0).sin();
    for thin in [with(None, &[]), with(Some(5.0), &[]), with(Some(7.0), &[0])] {
        has_topology(&thin, [1, 0, 2, 1]);
        near(thin.report.area, 2400.0 - hole, 1e-12);
        assert!(!thin.report.features[0].removed);
    }
    let thin = with(Some(7.0), &[]);
    has_topology(&thin, [1, 0, 1, 1]);
    near(thin.report.area, 2400.0, 1e-12);
    let feature = &thin.report.features[0];
    assert_eq!((feature.kind, feature.removed), ("hole", true));
    near(feature.size, 6.0, 1e-9);
}
