//! Solids whose facets were divided where they lie, as programs do that bring a mesh to an edge length.

use crate::deflate::solid_models::{prism, revolved};
use mesh_kernel::TriMesh;
use sheet::deflate::{DeflateOptions, DeflateReport, Nobody, deflate};

/// Every face cut in four.
fn divided(mesh: &TriMesh) -> TriMesh {
    let mut finer = TriMesh::default();
    for f in 0..mesh.faces.len() as u32 {
        let [a, b, c] = mesh.corners(f);
        let (d, e, g) = (a.midpoint(b), b.midpoint(c), c.midpoint(a));
        for corners in [[a, d, g], [d, b, e], [g, e, c], [d, e, g]] {
            let n = finer.positions.len() as u32;
            finer.positions.extend(corners);
            finer.faces.push([n, n + 1, n + 2]);
        }
    }
    finer
}

/// Deflates a solid as it is, divided once and divided twice; each time it is three patches at one joint.
fn ribbed_however_divided(solid: &TriMesh, check: impl Fn(&DeflateReport, &str)) {
    for (times, solid) in [solid.clone(), divided(solid), divided(&divided(solid))].iter().enumerate() {
        let thin = deflate(solid, &DeflateOptions::default(), &Nobody).unwrap();
        let r = &thin.report;
        let what = format!("divided {times} times");
        assert_eq!((r.self_intersections, r.lost_edges), (0, 0), "{what}");
        assert_eq!([r.patches, r.joints, r.free_loops, r.components], [3, 1, 2, 1], "{what}");
        check(r, &what);
    }
}

#[test]
fn fillets_of_few_chords_are_told_from_plane_faces() {
    // A rib on a plate with a fillet of two chords on each side; what is between the chords is not quite straight.
    let (r, foot) = (0.6, 1.6);
    let off = r * (1.0 - std::f64::consts::FRAC_1_SQRT_2);
    let profile = [
        [-30.0, 0.0],
        [30.0, 0.0],
        [30.0, 2.0],
        [foot, 2.0],
        [1.0 + off, 2.0 + off],
        [1.0, 2.0 + r],
        [1.0, 22.0],
        [-1.0, 22.0],
        [-1.0, 2.0 + r],
        [-1.0 - off, 2.0 + off],
        [-foot, 2.0],
        [-30.0, 2.0],
    ];
    let mut solid = prism(&profile, 60.0, 40);
    for (k, p) in solid.positions.iter_mut().enumerate() {
        if (p.y - 2.0 - off).abs() < 1e-9 {
            p.y += 3e-4 * ((k * 5 % 7) as f64 / 3.0 - 1.0);
        }
    }
    ribbed_however_divided(&solid, |r, what| {
        let removed: Vec<&str> = r.features.iter().filter(|f| f.removed).map(|f| f.kind).collect();
        assert_eq!(removed, ["fillet", "fillet"], "{what}");
        assert!((r.area - 60.0 * 60.0 - 60.0 * 21.0).abs() < 0.1, "{what}: {} mm²", r.area);
    });
}

#[test]
fn few_chords_between_ribs_are_told_from_folded_plates() {
    // A round wall with a fin outside: four chords on each side of it there, eight in a row inside.
    let (inner, outer, top) = (40.0f64, 42.0f64, 54.0);
    let at = |radius: f64, degrees: f64| {
        let a = degrees.to_radians();
        [radius * a.cos(), radius * a.sin()]
    };
    let beside = |degrees: f64, radius: f64, aside: f64| {
        let (a, along) = (degrees.to_radians(), (radius * radius - aside * aside).sqrt());
        [along * a.cos() - aside * a.sin(), along * a.sin() + aside * a.cos()]
    };
    let mut profile: Vec<[f64; 2]> = [0.0, 12.0, 24.0, 36.0].iter().map(|a| at(outer, *a)).collect();
    profile.extend([beside(48.0, outer, -1.0), beside(48.0, top, -1.0)]);
    profile.extend([beside(48.0, top, 1.0), beside(48.0, outer, 1.0)]);
    profile.extend([60.0, 72.0, 84.0, 96.0].iter().map(|a| at(outer, *a)));
    profile.extend((0..=8).rev().map(|k| at(inner, 12.0 * f64::from(k))));
    let solid = prism(&profile, 50.0, 4);
    ribbed_however_divided(&solid, |_, _| ());
}

/// A strip offset by two slight bends: its legs are planes and the bends cylinders, although all of it runs on smoothly.
#[test]
fn legs_between_slight_bends_are_planes() {
    for chords in [1, 6, 12] {
        // Along the middle: turns by 27 degrees to one side and back, as of a bent strip.
        let turn = 27f64.to_radians();
        let side = |away: f64| {
            let mut line = vec![[0.0, away]];
            let first = [50.0, 6.0];
            line.extend((0..=chords).map(|k| {
                let a = turn * f64::from(k) / f64::from(chords);
                [first[0] + (6.0 - away) * a.sin(), first[1] - (6.0 - away) * a.cos()]
            }));
            let end = [first[0] + 6.0 * turn.sin(), first[1] - 6.0 * turn.cos()];
            let next = [end[0] + 5.0 * turn.cos(), end[1] + 5.0 * turn.sin()];
            let centre = [next[0] + 6.0 * turn.sin(), next[1] - 6.0 * turn.cos()];
            line.extend((0..=chords).rev().map(|k| {
                let a = turn * f64::from(k) / f64::from(chords);
                [centre[0] - (6.0 + away) * a.sin(), centre[1] + (6.0 + away) * a.cos()]
            }));
            line.push([centre[0] + 50.0, centre[1] + 6.0 + away]);
            line
        };
        let mut profile = side(-1.0);
        profile.extend(side(1.0).into_iter().rev());
        let solid = prism(&profile, 30.0, 4);
        let faces = deflate(&solid, &DeflateOptions::default(), &Nobody).unwrap().report.faces;
        let all: f64 = faces.iter().map(|f| f.area).sum();
        let of =
            |kind: &str| faces.iter().filter(|f| f.shape.name() == kind).map(|f| f.area).sum::<f64>() / all;
        // A single chord is not known to be round, and the short leg is not much wider than two of them.
        let [least_plane, most_freeform] = if chords == 1 { [0.85, 0.15] } else { [0.9, 1e-9] };
        assert!(of("freeform") < most_freeform, "{chords} chords: {faces:?}");
        assert!(of("plane") > least_plane, "{chords} chords: {faces:?}");
    }
}

/// Facets of a low round band touch each other along short edges only, and narrow ones of fillets along long ones: they are no planes.
#[test]
fn facets_of_a_low_band_between_fillets_are_no_planes() {
    let rounded = |from: f64, centre: [f64; 2]| {
        (0..=8).map(move |k| {
            let angle = from + std::f64::consts::FRAC_PI_2 * f64::from(k) / 8.0;
            [centre[0] + 0.3 * angle.cos(), centre[1] + 0.3 * angle.sin()]
        })
    };
    let mut profile = vec![[30.0, 1.0], [30.0, 0.0]];
    profile.extend(rounded(-std::f64::consts::FRAC_PI_2, [39.7, 0.3]));
    profile.extend(rounded(0.0, [39.7, 0.7]));
    let faces =
        deflate(&revolved(&profile, 48, true), &DeflateOptions::default(), &Nobody).unwrap().report.faces;
    let planes = faces.iter().filter(|f| f.shape.name() == "plane").count();
    assert_eq!(planes, 2, "{faces:?}");
}
