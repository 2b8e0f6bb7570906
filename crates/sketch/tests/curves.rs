//! Curves against formulas, and drawings as data.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec2;
use proptest::prelude::*;
use sketch::{Branch, Curve, Outline, Path, SketchError, order_of_branches};

fn v(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

#[test]
fn arcs_have_their_length_curvature_and_middle() {
    let arc = Curve::arc(v(1.0, 2.0), 5.0, 0.0, -PI).unwrap();
    assert!((arc.length() - 5.0 * PI).abs() < 1e-12);
    assert!((arc.curvature(0.3) + 0.2).abs() < 1e-12, "clockwise turns right");
    assert!(arc.point(0.5).distance(v(1.0, -3.0)) < 1e-12);
    let through = Curve::arc_through(v(0.0, 0.0), v(1.0, 1.0), v(2.0, 0.0)).unwrap();
    assert!(through.point(0.5).distance(v(1.0, 1.0)) < 1e-12);
    assert!(through.curvature(0.5) < 0.0);
    assert_eq!(Curve::arc_through(v(0.0, 0.0), v(1.0, 1.0), v(2.0, 2.0)), Err(SketchError::NoArc));
    // An even number of parts: the middle is a point.
    let parameters = arc.parameters(0.1);
    assert!(parameters.contains(&0.5) && parameters.len() % 2 == 1);
}

#[test]
fn a_spline_runs_through_its_points_with_one_curvature_on_both_sides() {
    let points = [v(0.0, 0.0), v(3.0, 1.0), v(5.0, -2.0), v(9.0, 0.0)];
    let spline = Curve::spline(&points).unwrap();
    let Curve::Spline { at, .. } = &spline else { panic!("a spline") };
    for (t, p) in at.iter().zip(points) {
        assert!(spline.point(*t).distance(p) < 1e-12);
    }
    let inner = at[1];
    assert!((spline.curvature(inner - 1e-9) - spline.curvature(inner + 1e-9)).abs() < 1e-5);
    assert!(spline.curvature(0.0).abs() < 1e-12, "natural ends");
    let line = Curve::spline(&[v(0.0, 0.0), v(3.0, 4.0)]).unwrap();
    assert!((line.length() - 5.0).abs() < 1e-12);
}

#[test]
fn a_quadratic_bezier_is_raised_exactly() {
    let curve = Curve::bezier(&[v(0.0, 0.0), v(1.0, 2.0), v(2.0, 0.0)]).unwrap();
    assert!(curve.point(0.5).distance(v(1.0, 1.0)) < 1e-15);
    assert!(Curve::bezier(&[v(0.0, 0.0)]).is_err());
    // y = 2x − x²: curvature 2 at the top.
    assert!((curve.curvature(0.5) + 2.0).abs() < 1e-12);
    let exact = 5f64.sqrt() + (2.0 + 5f64.sqrt()).ln() / 2.0;
    assert!((curve.length() - exact).abs() < 1e-8, "{} {exact}", curve.length());
}

#[test]
fn drawings_come_from_json_and_must_close() {
    let of = |text: &str| Path::of(&serde_json::from_str::<Outline>(text).unwrap());
    let round = of(r#"{"rectangle": {"at": [0, 0], "size": [40, 20], "round": 5}}"#).unwrap();
    assert!(round.closed && (round.length() - (30.0 + 10.0) * 2.0 - 10.0 * PI).abs() < 1e-9);
    assert_eq!(round.curves.len(), 8);
    let slot = of(
        r#"{"path": [{"line": [[0, 0], [10, 0]]}, {"arc": {"center": [10, 2], "radius": 2, "from": -90, "to": 90}},
        {"line": [[10, 4], [0, 4]]}, {"arc_through": [[0, 4], [-2, 2], [0, 0]]}]}"#,
    )
    .unwrap();
    assert!(slot.closed && (slot.length() - 20.0 - 4.0 * PI).abs() < 1e-9);
    let gap = of(r#"{"path": [{"line": [[0, 0], [10, 0]]}, {"line": [[11, 0], [20, 0]]}]}"#);
    assert!(matches!(gap, Err(SketchError::Gap { curve: 2, .. })));
    let open = of(r#"{"polyline": [[0, 0], [1, 0], [1, 1]]}"#).unwrap();
    assert!(matches!(open.simple_loop(0.1, 1000), Err(SketchError::Open { .. })));
    let eight = of(r#"{"polygon": [[0, 0], [2, 2], [2, 0], [0, 2]]}"#).unwrap();
    assert!(matches!(eight.simple_loop(0.1, 1000), Err(SketchError::Crosses { .. })));
    assert!(of(r#"{"circle": {"center": [0, 0], "radius": -1}}"#).is_err());
    assert_eq!(round.sampled_within(1e-9, 100), Err(SketchError::TooFine { most: 100 }));
    assert!(
        serde_json::from_str::<Outline>(r#"{"circle": {"center": [0, 0], "radius": 1, "x": 1}}"#).is_err()
    );
}

#[test]
fn branches_are_ordered_by_tangent_then_by_curvature() {
    // Fig. 6.19: 3 and 4 leave in one direction; the one that turns left comes later.
    let branch = |angle: f64, curvature: f64| Branch { tangent: DVec2::from_angle(angle), curvature };
    let all = [branch(0.0, 0.0), branch(2.0, 0.0), branch(1.0, 0.1), branch(1.0, -0.1), branch(4.0, 3.0)];
    assert_eq!(order_of_branches(&all), Ok(vec![0, 3, 2, 1, 4]));
    assert_eq!(order_of_branches(&[all[0], all[1], all[1]]), Err(SketchError::SameBranch(1, 2)));
}

proptest! {
    #[test]
    fn samples_are_within_the_tolerance(
        points in proptest::collection::vec((-50f64..50.0, -50f64..50.0), 4),
        tolerance in 0.01f64..1.0,
    ) {
        let points: Vec<DVec2> = points.into_iter().map(DVec2::from).collect();
        for curve in [Curve::bezier(&points).unwrap(), Curve::spline(&points).unwrap()] {
            let at = curve.parameters(tolerance);
            for w in at.windows(2) {
                let (a, b) = (curve.point(w[0]), curve.point(w[1]));
                for k in 1..8 {
                    let p = curve.point(w[0] + (w[1] - w[0]) * f64::from(k) / 8.0);
                    let d = (b - a).normalize_or_zero();
                    prop_assert!((p - a).perp_dot(d).abs() <= 1.6 * tolerance);
                }
            }
            let near = curve.nearest(curve.point(0.37));
            prop_assert!(near.distance < 1e-5);
        }
    }

    #[test]
    fn reversed_curves_are_the_same_points(r in 1f64..50.0, start in -4f64..4.0, sweep in 0.1f64..TAU) {
        let arc = Curve::arc(v(3.0, -1.0), r, start, sweep).unwrap();
        let back = arc.reversed();
        for k in 0..=10 {
            let t = f64::from(k) / 10.0;
            prop_assert!(arc.point(t).distance(back.point(1.0 - t)) < 1e-9);
        }
        prop_assert!((arc.curvature(0.2) + back.curvature(0.8)).abs() < 1e-9);
        prop_assert!((arc.tangent(0.0).perp_dot(DVec2::from_angle(start)).abs() - 1.0).abs() < 1e-9);
        let _ = FRAC_PI_2;
    }
}
