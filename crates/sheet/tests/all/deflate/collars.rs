//! Round walls whose two sides are meshed each in its own way, on plates: collars of holes.

use std::f64::consts::{FRAC_PI_6, PI, TAU};

use crate::deflate::solid_models::{revolved, turned};
use crate::deflate::support::{deflated, has_topology, near};
use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DVec2, DVec3};
use mesh_kernel::merge::{Boolean, MergeOptions, boolean};
use sheet::deflate::{DeflateOptions, Nobody, deflate};

/// Rings about z, each joined to the next one and the last to the first: radius, height, and how many nodes.
fn rings(sections: &[(f64, f64, u32)]) -> TriMesh {
    let mut mesh = TriMesh::default();
    let mut starts = Vec::new();
    for (radius, z, nodes) in sections {
        starts.push(mesh.positions.len() as u32);
        let at = |k: u32| TAU * f64::from(k) / f64::from(*nodes);
        mesh.positions
            .extend((0..*nodes).map(|k| DVec3::new(radius * at(k).cos(), radius * at(k).sin(), *z)));
    }
    for k in 0..sections.len() {
        let next = (k + 1) % sections.len();
        let ((a, n), (b, m)) = ((starts[k], sections[k].2), (starts[next], sections[next].2));
        let (mut i, mut j) = (0, 0);
        while i < n || j < m {
            if j == m || (i < n && (i + 1) * m <= (j + 1) * n) {
                mesh.faces.push([a + i, a + (i + 1) % n, b + j % m]);
                i += 1;
            } else {
                mesh.faces.push([a + i % n, b + (j + 1) % m, b + j]);
                j += 1;
            }
        }
    }
    mesh
}

/// The flat facets of the disc have facets opposite to them, those of the collar do not: the collar must not be left out for that.
#[test]
fn a_collar_stays_however_its_sides_are_meshed() {
    for (inner, outer) in [(27, 29), (24, 31), (16, 37), (40, 29)] {
        let rim = 96;
        let solid = rings(&[
            (48.0, 0.0, rim),
            (48.0, 2.0, rim),
            (16.0, 2.0, outer),
            (16.0, 13.0, outer),
            (14.0, 13.0, inner),
            (14.0, 0.0, inner),
        ]);
        for solid in [&solid, &turned(&solid)] {
            let thin = deflate(solid, &DeflateOptions::default(), &Nobody).unwrap();
            let (r, what) = (&thin.report, format!("{inner} chords inside, {outer} outside"));
            assert_eq!([r.patches, r.joints, r.free_loops, r.components], [2, 0, 2, 1], "{what}");
            assert_eq!((r.self_intersections, r.lost_edges), (0, 0), "{what}");
            let area = PI * (48.0f64.powi(2) - 15.0 * 15.0) + TAU * 15.0 * 12.0;
            assert!((r.area / area - 1.0).abs() < 0.02, "{what}: {} mm² of {area}", r.area);
        }
    }
}

/// A boss with draft inside and outside has no exact middle, and runs smoothly into the fillet about its foot: that belongs to the floor
/// nevertheless.
#[test]
fn a_boss_with_draft_and_a_fillet_about_its_foot_stands_on_its_floor() {
    for steps in [24, 48, 96] {
        let draft = 1.5f64.to_radians();
        let (foot, height) = (1.2, 12.0);
        // The fillet touches the floor and the leaning side.
        let centre = [3.4 + foot / draft.cos() - foot * draft.tan(), 2.0 + foot];
        let mut profile = vec![[0.0, 0.0], [30.0, 0.0], [30.0, 2.0]];
        let chords = steps / 6;
        profile.extend((0..=chords).map(|k| {
            let turn = (std::f64::consts::FRAC_PI_2 - draft) * f64::from(k) / f64::from(chords);
            [centre[0] - foot * turn.sin(), centre[1] - foot * turn.cos()]
        }));
        let top = 2.0 + height;
        profile.extend([[3.4 - height * draft.tan(), top], [1.9, top], [1.75, 2.0], [0.0, 2.0]]);
        let thin = deflated(&revolved(&profile, steps, false));
        has_topology(&thin, [3, 1, 2, 1]);
    }
}

/// The web of a wheel with draft on both sides is two flat cones with their tips apart: its middle is a plane all the same.
#[test]
fn the_middle_of_a_web_with_draft_is_flat() {
    for steps in [24, 48] {
        for draft in [0.5f64, 1.0, 2.0] {
            let more = 40.0 * draft.to_radians().tan();
            for [hub, rim] in [[1.0 + more, 1.0], [1.0, 1.0 + more]] {
                let profile = [[10.0, -hub], [50.0, -rim], [50.0, rim], [10.0, hub]];
                let thin = deflated(&revolved(&profile, steps, true));
                let highest = thin.sheet.positions.iter().map(|p| p.z.abs()).fold(0.0, f64::max);
                assert!(highest < 0.01, "{steps} steps, draft {draft}: {highest} mm off");
                assert_eq!(thin.report.self_intersections, 0);
            }
        }
    }
}

/// The round between the two sides of a corner.
fn fillet(before: [f64; 2], corner: [f64; 2], after: [f64; 2], radius: f64, chords: u32) -> Vec<[f64; 2]> {
    let [p, q, r] = [before, corner, after].map(|[x, y]| DVec2::new(x, y));
    let (a, b) = ((p - q).normalize(), (r - q).normalize());
    let half = a.angle_to(b).abs() / 2.0;
    let centre = q + (a + b).normalize() * (radius / half.sin());
    let [start, end] = [a, b].map(|side| q + side * (radius / half.tan()) - centre);
    let turn = (PI - 2.0 * half) * start.perp_dot(end).signum();
    let at = |k: u32| centre + DVec2::from_angle(turn * f64::from(k) / f64::from(chords)).rotate(start);
    (0..=chords).map(|k| at(k).to_array()).collect()
}

/// A tube of radius 20 stands on a slant ring, with fillets about its foot: what is behind these is round as well as the tube, and both
/// middles are met, not only one of them gone along.
#[test]
fn a_tube_on_a_cone_ends_on_its_middle() {
    let slope = FRAC_PI_6.tan();
    let (top, below) = (|r: f64| [r, slope * (40.0 - r)], 2.0 / FRAC_PI_6.cos());
    let under = |r: f64| [r, slope * (40.0 - r) - below];
    let (inner, outer, high) = (19.2, 20.8, slope * 20.0 + 20.0);
    let foot = fillet(top(40.0), top(outer), [outer, high], 1.0, 8);
    let inside = fillet([inner, high], top(inner), top(8.0), 1.0, 8);
    let profile: Vec<[f64; 2]> = [under(8.0), under(40.0), top(40.0)]
        .into_iter()
        .chain(foot)
        .chain([[outer, high], [inner, high]])
        .chain(inside)
        .chain([top(8.0)])
        .collect();
    let thin = deflated(&revolved(&profile, 60, true));
    assert_eq!((thin.report.self_intersections, thin.report.lost_edges), (0, 0));
    // In chords: the ring, halfway down through its ends, and the tube from the middle of the ring on.
    let chord = 120.0 * (PI / 60.0).sin();
    let ring = chord * (40.0 * 40.0 - 8.0 * 8.0) / 2.0 * (slope * slope + (PI / 60.0).cos().powi(2)).sqrt();
    let tube = chord * 20.0 * (high - slope * 20.0 + below / 2.0);
    near(thin.report.area, ring + tube, 1e-4);
}

/// A hollow boss with a finely meshed fillet at its root and a coarsely meshed hole: beside the chords of the hole the first row of the fillet
/// looks parallel, and is part of the fillet nevertheless. Where it was taken for the wall, the boss flared out towards its plate.
#[test]
fn the_first_row_of_a_fillet_is_no_wall() {
    let (outer, hole, fillet, floor) = (4.5, 3.0, 0.7, 2.1);
    let mut profile = vec![[0.0, 0.0], [20.0, 0.0], [20.0, floor]];
    for k in 0..=4 {
        let turn = std::f64::consts::FRAC_PI_2 * f64::from(k) / 4.0;
        profile.push([outer + fillet * (1.0 - turn.sin()), floor + fillet * (1.0 - turn.cos())]);
    }
    profile.extend([[outer, 17.0], [0.0, 17.0]]);
    let boss = revolved(&profile, 88, false);
    let drill = revolved(&[[0.0, floor], [hole, floor], [hole, 20.0], [0.0, 20.0]], 15, false);
    let boss = boolean(&[&boss, &drill], Boolean::Difference, &MergeOptions::default()).unwrap().mesh;
    let thin = deflated(&boss);
    has_topology(&thin, [3, 1, 2, 1]);
    let radius = (outer + hole) / 2.0;
    let near = thin.sheet.positions.iter().filter(|p| (p.z - floor / 2.0).abs() < 1e-6);
    let joint: Vec<f64> =
        near.map(|p| p.truncate().length()).filter(|r| (r - radius).abs() < 0.5 * radius).collect();
    assert!(joint.len() > 15);
    for r in joint {
        assert!((r - radius).abs() < 0.1, "{r} mm from the axis");
    }
}
