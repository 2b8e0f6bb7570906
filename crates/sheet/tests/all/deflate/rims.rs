//! Walls end where their rims do, however these are rounded.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::deflate::rim_support::{
    Rim, area, bracket, circle, half_rounded_rim, outline, plate, plate_with_hole, rounded_rim, tube,
};
use crate::deflate::solid_models::{prism, revolved, turned};
use mesh_kernel::TriMesh;
use sheet::deflate::{DeflateOptions, Deflated, Nobody, deflate};

fn deflated(solid: &TriMesh) -> Deflated {
    deflate(solid, &DeflateOptions::default(), &Nobody).unwrap()
}

#[track_caller]
fn near(value: f64, wanted: f64, relative: f64, what: &str) {
    assert!((value - wanted).abs() <= relative * wanted.abs(), "{what}: {value} is not {wanted}");
}

/// Patches, joints, free loops, parts; no crossings.
#[track_caller]
fn has_topology(thin: &Deflated, wanted: [usize; 4], what: &str) {
    let r = &thin.report;
    assert_eq!([r.patches, r.joints, r.free_loops, r.components], wanted, "{what}: {r:?}");
    assert_eq!((r.self_intersections, r.lost_edges), (0, 0), "{what}");
}

/// Of a closed outline, in mm.
fn length(outline: &[[f64; 2]]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).sum()
}

/// Sheet times thickness as a share of the solid.
fn volume_share(thin: &Deflated) -> f64 {
    let sheet: f64 =
        (0..).zip(&thin.thickness).map(|(f, t)| thin.sheet.area_normal(f).length() / 2.0 * t).sum();
    sheet / thin.report.solid_volume
}

/// Radius and chords of the rounds of a rim 4 thick; one chord is a chamfer.
const RIMS: [(f64, u32); 4] = [(0.5, 6), (0.5, 1), (1.9, 6), (1.9, 12)];

#[test]
fn a_plate_ends_at_its_outline() {
    let shape = |inward| outline([80.0, 50.0], 8.0, 8, inward);
    let wanted = area(&shape(0.0));
    for (radius, chords) in RIMS {
        let what = format!("rounds {radius} in {chords}");
        let solid = plate(shape, &rounded_rim(4.0, radius, chords));
        for solid in [&solid, &turned(&solid)] {
            let thin = deflated(solid);
            has_topology(&thin, [1, 0, 1, 1], &what);
            near(thin.report.area, wanted, 1e-3, &what);
            near(volume_share(&thin), 1.0, 0.05, &what);
        }
    }
}

#[test]
fn a_hole_begins_at_its_edge() {
    let shape = |inward| outline([80.0, 50.0], 8.0, 8, inward);
    let nodes = shape(0.0).len() as u32;
    let wanted = area(&shape(0.0)) - area(&circle(10.0, nodes));
    for (radius, chords) in RIMS {
        let what = format!("rounds {radius} in {chords}");
        let thin = deflated(&plate_with_hole(shape, 10.0, &rounded_rim(4.0, radius, chords)));
        has_topology(&thin, [1, 0, 2, 1], &what);
        near(thin.report.area, wanted, 1e-3, &what);
        near(volume_share(&thin), 1.0, 0.05, &what);
    }
}

#[test]
fn a_rib_goes_up_to_its_top() {
    for (radius, chords) in [(2.0, 8), (1.9, 8), (0.5, 4), (0.5, 1)] {
        // A rib 4 thick on a bar 4 thick, 42 high.
        let mut profile = vec![[-30., -2.], [30., -2.], [30., 2.], [2., 2.]];
        let top = rounded_rim(4.0, radius, chords);
        // A full round has one node on top.
        let mut top: Vec<[f64; 2]> = top.iter().map(|[d, z]| [-z, 42.0 - d]).collect();
        top.dedup_by(|a, b| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-9);
        profile.extend(top);
        profile.extend([[-2., 2.], [-30., 2.]]);
        for cells in [1, 8] {
            let what = format!("rounds {radius} in {chords}, {cells} cells");
            let thin = deflated(&prism(&profile, 50.0, cells));
            has_topology(&thin, [3, 1, 2, 1], &what);
            let top = thin.sheet.positions.iter().map(|p| p.y).fold(f64::MIN, f64::max);
            near(top, 42.0, 1e-3, &what);
            near(thin.report.area, 50.0 * (60.0 + 42.0), 1e-3, &what);
        }
    }
}

#[test]
fn a_tube_is_as_long_as_it_was_with_rounded_rims() {
    for (radius, chords) in [(0.5, 4), (0.5, 1), (0.95, 8)] {
        let what = format!("rounds {radius} in {chords}");
        let rim = rounded_rim(2.0, radius, chords);
        let below = rim.iter().map(|[d, z]| [20.0 + z, *d]);
        let above = rim.iter().rev().map(|[d, z]| [20.0 + z, 50.0 - d]);
        let profile: Vec<[f64; 2]> = below.chain(above).collect();
        let thin = deflated(&revolved(&profile, 72, true));
        has_topology(&thin, [1, 0, 2, 1], &what);
        near(thin.report.area, TAU * 20.0 * 50.0, 3e-3, &what);
    }
}

#[test]
fn long_facets_of_a_tube_leave_the_sheet_within_it() {
    for (inner, outer) in [(24, 24), (24, 36), (40, 26)] {
        for slope in [0.0, 0.6] {
            let what = format!("{inner} in {outer} facets, slope {slope}");
            let thin =
                deflated(&tube((19.0, inner), (21.0, outer), |[x, y]| 80.0 + slope * x + 0.2 * slope * y));
            has_topology(&thin, [1, 0, 2, 1], &what);
            let centres = (0..thin.sheet.faces.len() as u32).map(|f| {
                let [a, b, c] = thin.sheet.corners(f);
                (a + b + c) / 3.0
            });
            for p in thin.sheet.positions.iter().copied().chain(centres) {
                let r = p.x.hypot(p.y);
                assert!(19.0 < r && r < 21.0, "{what}: {p} is {r} from the axis");
            }
        }
    }
}

#[test]
fn a_bracket_rounded_on_one_side_is_one_wall() {
    let is_whole = |radius: f64, rim: &[[f64; 2]], beside: bool, what: &str| {
        let thin = deflated(&bracket(40.0, radius, 12, 50.0, rim, beside));
        has_topology(&thin, [1, 0, 1, 1], what);
        near(thin.report.area, 50.0 * (2.0 * 40.0 + FRAC_PI_2 * radius), 1e-3, what);
    };
    for radius in [3.0, 5.0, 10.0] {
        for (round, chords) in [(0.5, 1), (0.5, 5), (0.8, 5)] {
            let what = format!("rounds {round} in {chords}, bend {radius}");
            let inside = half_rounded_rim(2.0, round, chords);
            let outside: Vec<[f64; 2]> = inside.iter().rev().map(|[d, w]| [*d, -w]).collect();
            is_whole(radius, &inside, false, &format!("{what}, inside"));
            is_whole(radius, &outside, false, &format!("{what}, outside"));
            is_whole(radius, &rounded_rim(2.0, round, chords), false, &what);
        }
        is_whole(radius, &rounded_rim(2.0, 0.5, 1), true, &format!("chamfers all around, bend {radius}"));
    }
}

/// A tray with round upright edges that is sharp below and has a fillet about its floor: the insides of its bends run into the fillet.
#[test]
fn upright_bends_above_a_fillet_are_walls() {
    for (chords, fillet) in [(8u32, 3.0), (8, 4.0), (16, 3.0)] {
        let what = format!("fillet {fillet} in {chords}");
        let shape = |inward| outline([90.0, 70.0], 8.0, chords, inward);
        let quarter = (0..=chords).map(|k| FRAC_PI_2 * f64::from(k) / f64::from(chords));
        let down = quarter.map(|a| [2.0 + fillet * (1.0 - a.cos()), 2.0 + fillet * (1.0 - a.sin())]);
        let profile: Rim = [[0.0, 0.0], [0.0, 25.0], [2.0, 25.0]].into_iter().chain(down).collect();
        let solid = plate(shape, &profile);
        for solid in [&solid, &turned(&solid)] {
            let thin = deflated(solid);
            has_topology(&thin, [2, 0, 1, 1], &what);
            near(thin.report.area, area(&shape(1.0)) + length(&shape(1.0)) * 24.0, 2e-3, &what);
        }
    }
}

/// A tray whose walls are half as thick for the last few millimetres, as lids have it. Its corners have few chords, about as wide as that
/// lip is high: the lip's flat sides are planes nevertheless. Or the lip is so low that no facet of the corners' other side looks at it.
#[test]
fn a_lip_at_the_rim_is_half_as_thick_all_round() {
    let cases = [
        (8.0, 3, 2.4, 21.0, 3.0),
        (8.0, 4, 2.4, 21.0, 3.0),
        (8.0, 6, 2.4, 21.0, 3.0),
        (5.0, 7, 2.0, 10.0, 2.0),
    ];
    for (radius, chords, thick, wall, lip) in cases {
        let what = format!("radius {radius} in {chords} chords, {wall} high");
        let shape = |inward| outline([90.0, 60.0], radius, chords, inward);
        let (half, rim) = (thick / 2.0, wall + lip);
        let profile = [[0.0, 0.0], [0.0, wall], [half, wall], [half, rim], [thick, rim], [thick, thick]];
        let solid = plate(shape, &profile);
        for solid in [&solid, &turned(&solid)] {
            let thin = deflated(solid);
            let r = &thin.report;
            assert_eq!([r.free_loops, r.components], [1, 1], "{what}: {r:?}");
            assert_eq!((r.self_intersections, r.lost_edges), (0, 0), "{what}");
            let areas =
                (0..).zip(&thin.thickness).map(|(f, t)| (thin.sheet.area_normal(f).length() / 2.0, t));
            let of_lip: f64 = areas.filter(|(_, t)| **t < 0.58 * thick).map(|a| a.0).sum();
            // The steps between the lip and the wall are as thin as it.
            let steps = length(&shape(1.25 * half)) * half / 2.0;
            near(of_lip, length(&shape(1.5 * half)) * lip + steps, 0.02, &what);
            near(volume_share(&thin), 1.0, 0.03, &what);
        }
    }
}
