//! Mid-surfaces of solids whose coordinates were rounded, as files do.

use crate::deflate::solid_models::{boxed, plate_with_hole, prism, revolved};
use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DQuat, DVec3, EulerRot};
use sheet::deflate::{DeflateOptions, Deflated, Nobody, deflate};
use sheet::thicken::{self, ThickenOptions, thicken};

fn deflated(solid: &TriMesh) -> Deflated {
    deflate(solid, &DeflateOptions::default(), &Nobody).unwrap()
}

fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

type Rounding = fn(DVec3) -> DVec3;

/// In a car's coordinates in single precision.
fn far_away(p: DVec3) -> DVec3 {
    (p + DVec3::new(2500.0, 600.0, 800.0)).map(single)
}

fn three_decimals(p: DVec3) -> DVec3 {
    p.map(|x| single((x * 1e3).round() / 1e3))
}

fn six_digits(p: DVec3) -> DVec3 {
    p.map(|x| single(format!("{x:.5e}").parse().unwrap()))
}

/// A T whose bar is 60 and whose stem 25, all 2 thick, with a lip of 1 × 1 at one end.
const TEE: [[f64; 2]; 10] = [
    [-30., -1.],
    [30., -1.],
    [30., 1.],
    [1., 1.],
    [1., 25.],
    [-1., 25.],
    [-1., 1.],
    [-29., 1.],
    [-29., 0.],
    [-30., 0.],
];

/// Walls stand askew to all axes, so that every coordinate is rounded.
fn askew(solid: &TriMesh, rounded: Rounding) -> TriMesh {
    let turn = DQuat::from_euler(EulerRot::XYZ, 0.7, -0.4, 1.1);
    TriMesh::new(solid.positions.iter().map(|p| rounded(turn * *p)).collect(), solid.faces.clone())
}

#[test]
fn files_that_round_have_the_same_middles() {
    let cells = thicken(&boxed(), &ThickenOptions::new(1.5), &thicken::Nobody).unwrap().solid;
    let solids = [
        ("tee", prism(&TEE, 100.0, 1)),
        ("fine tee", prism(&TEE, 100.0, 40)),
        ("box with a partition", cells),
        ("plate", plate_with_hole(80.0, 50.0, 3.0, 8.0, 24)),
    ];
    let ways: [(&str, Rounding); 3] =
        [("far away", far_away), ("three decimals", three_decimals), ("six digits", six_digits)];
    for (name, solid) in &solids {
        let exact = deflated(&askew(solid, |p| p)).report;
        for (way, rounded) in ways {
            let report = deflated(&askew(solid, rounded)).report;
            let counts =
                |r: &sheet::deflate::DeflateReport| [r.patches, r.joints, r.free_loops, r.components];
            assert_eq!(counts(&report), counts(&exact), "{name}, {way}");
            assert_eq!((report.self_intersections, report.lost_edges), (0, 0), "{name}, {way}");
            let off = (report.area / exact.area - 1.0).abs();
            assert!(off < 1e-4, "{name}, {way}: the area is off by {off}");
            let off = report.thickness.mean / exact.thickness.mean - 1.0;
            assert!(off.abs() < 1e-3, "{name}, {way}: the thickness is off by {off}");
        }
    }
}

/// One and a half times its size from the origin single precision hardly rounds, but planes of narrow faces lean by it.
#[test]
fn a_rim_beside_the_origin_is_one_plane() {
    let beside: Rounding = |p| (p + DVec3::new(160.0, 120.0, 95.0)).map(single);
    for steps in [96, 240] {
        let tube = revolved(&[[53.0, 0.0], [55.0, 0.0], [55.0, 40.0], [53.0, 40.0]], steps, true);
        let report = deflated(&askew(&tube, beside)).report;
        let kinds: Vec<&str> = report.faces.iter().map(|f| f.shape.name()).collect();
        let planes = kinds.iter().filter(|k| **k == "plane").count();
        assert_eq!((planes, kinds.len()), (2, 4), "{steps} steps: {kinds:?}");
    }
}
