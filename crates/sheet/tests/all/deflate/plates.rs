//! Plates with slots: what is left between these is no wall of its own, and leaves beside them hang on the plate.

use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DMat3, DVec3};

use crate::deflate::solid_models::{block, prism, revolved, turned, united};
use crate::deflate::support::{deflated, has_topology, near};

/// Slats that are wider than thick: their sides lie opposite to each other as well, and are ends nevertheless.
#[test]
fn slats_between_slots_are_as_thick_as_their_plate() {
    for (slat, slot) in [(4.0, 4.0), (5.5, 3.0), (2.9, 2.9), (2.5, 4.0)] {
        let mut comb = vec![[0.0, 0.0], [8.0 * slat + 7.0 * slot, 0.0]];
        for k in (0..8).map(f64::from).rev() {
            let right = k * (slat + slot) + slat;
            comb.extend([[right, 40.0], [right - slat, 40.0]]);
            if k > 0.0 {
                comb.extend([[right - slat, 6.0], [right - slat - slot, 6.0]]);
            }
        }
        let plate = prism(&comb, 2.5, 1);
        for plate in [&plate, &turned(&plate)] {
            let thin = deflated(plate);
            has_topology(&thin, [1, 0, 1, 1]);
            near(thin.report.area, 8.0 * slat * 40.0 + 7.0 * slot * 6.0, 1e-9);
            near(thin.report.thickness.min, 2.5, 1e-9);
            near(thin.report.thickness.max, 2.5, 1e-9);
            near(thin.report.max_thickness, 2.55, 1e-9);
        }
    }
}

/// A plate with many slots nearer to each other than it is thick: their sides see each other, and all of its outline is about thin webs.
#[test]
fn a_plate_full_of_slots_is_a_plate() {
    for web in [1.6, 2.0, 2.4] {
        let mut comb = vec![[0.0, 0.0], [150.0, 0.0], [150.0, 60.0]];
        for k in (0..20).map(f64::from).rev() {
            let left = 5.0 + k * (web + 3.0);
            comb.extend([[left + 3.0, 60.0], [left + 3.0, 30.0], [left, 30.0], [left, 60.0]]);
        }
        comb.push([0.0, 60.0]);
        let thin = deflated(&prism(&comb, 2.5, 1));
        has_topology(&thin, [1, 0, 1, 1]);
        near(thin.report.area, 150.0 * 60.0 - 20.0 * 3.0 * 30.0, 0.02);
    }
}

/// A plate with slots milled into its edge goes on in as many leaves, one over the other, joined to it at the slots' ends.
#[test]
fn a_plate_that_forks_is_joined_to_its_leaves() {
    for leaves in [2u32, 3] {
        let (leaf, slot) = (2.2, 1.6);
        let thick = f64::from(leaves) * leaf + f64::from(leaves - 1) * slot;
        // In x and y along and across the plate, of which the leaves are the right part.
        let mut profile = vec![[0.0, 0.0]];
        for k in 0..leaves {
            let y = f64::from(k) * (leaf + slot);
            if k > 0 {
                let end = 120.0 + 3.0 * f64::from(k);
                profile.extend([[end, y - slot], [end, y]]);
            }
            profile.extend([[170.0, y], [170.0, y + leaf]]);
        }
        profile.push([0.0, thick]);
        let solid = prism(&profile, 90.0, 1);
        for solid in [&solid, &turned(&solid)] {
            let thin = deflated(solid);
            let r = &thin.report;
            assert_eq!(
                (r.components, r.self_intersections, r.lost_edges),
                (1, 0, 0),
                "{leaves} leaves: {r:?}"
            );
            let areas =
                (0..).zip(&thin.thickness).map(|(f, t)| (thin.sheet.area_normal(f).length() / 2.0, t));
            let of =
                |wanted: f64| areas.clone().filter(|a| (a.1 - wanted).abs() < 1e-9).map(|a| a.0).sum::<f64>();
            near(of(thick), 123.0 * 90.0, 1e-9);
            assert!(of(leaf) > f64::from(leaves) * 90.0 * 41.0, "{leaves} leaves: {}", of(leaf));
            near(r.max_thickness, 1.02 * thick, 1e-9);
        }
    }
}

/// The nose of a hook is a lump without a middle; its ends are no walls.
#[test]
fn a_snap_hook_is_a_plate_with_a_leaf() {
    let hook = [
        [0.0, 0.0],
        [40.0, 0.0],
        [40.0, 2.0],
        [21.5, 2.0],
        [21.5, 16.0],
        [23.5, 18.0],
        [21.5, 22.0],
        [20.0, 22.0],
        [20.0, 2.0],
        [0.0, 2.0],
    ];
    let solid = prism(&hook, 10.0, 1);
    for solid in [&solid, &turned(&solid)] {
        let thin = deflated(solid);
        has_topology(&thin, [3, 1, 2, 1]);
        assert_eq!(thin.report.steps, 0);
    }
}

/// A round plate that is thicker in its middle, as much on both sides. The facets of the side there lean in and out, as those with nodes
/// over the middles of chords do, so that its upper and lower edges come to lie beside each other; the plate is one nevertheless.
#[test]
fn what_is_raised_on_both_sides_is_no_step() {
    let (inner, outer, chords) = (14.5, 40.0, 46);
    let profile = [[0.0, -2.0], [inner, -2.0], [inner, -1.0], [outer, -1.0]];
    let above = profile.iter().rev().map(|[r, z]| [*r, -z]);
    let mut plate = revolved(&profile.iter().copied().chain(above).collect::<Vec<_>>(), chords, false);
    let is_side = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|v| plate.positions[v as usize]);
        [a, b, c].iter().all(|p| (p.truncate().length() - inner).abs() < 1e-9)
    };
    let (sides, others): (Vec<_>, Vec<_>) = plate.faces.iter().copied().partition(|face| {
        let [a, b, c] = face.map(|v| plate.positions[v as usize].z);
        is_side(face) && (a != b || b != c)
    });
    assert_eq!(sides.len() as u32, 4 * chords);
    plate.faces = others;
    for pair in sides.chunks(2) {
        let &[[a, b, c], [_, _, d]] = pair else { unreachable!("two faces a chord") };
        let middle = plate.positions[a as usize].midpoint(plate.positions[c as usize]);
        let node = plate.positions.len() as u32;
        let out = middle.truncate().normalize() * inner;
        plate.positions.push(DVec3::new(out.x, out.y, middle.z));
        plate.faces.extend([[a, b, node], [b, c, node], [c, d, node], [d, a, node]]);
    }
    for plate in [&plate, &turned(&plate)] {
        let thin = deflated(plate);
        has_topology(&thin, [1, 0, 1, 1]);
        let polygon = f64::from(chords) / 2.0 * (std::f64::consts::TAU / f64::from(chords)).sin();
        near(thin.report.area, polygon * outer * outer, 1e-9);
        near(thin.report.thickness.max, 4.0, 1e-9);
        assert_eq!(thin.report.steps, 0);
    }
}

/// A pad that is raised as much on both sides is as thick as it is wherever the plate lies, and however its file rounds.
#[test]
fn a_pad_on_both_sides_is_a_wall_in_any_position() {
    for (plate, pad) in [(1.8, 5.0), (2.0, 5.0), (2.0, 4.0)] {
        let raised = (pad - plate) / 2.0;
        let solid = united(&[
            block([0.0, 0.0, 0.0], [100.0, 60.0, plate]),
            block([30.0, 10.0, -raised], [70.0, 50.0, plate + raised]),
        ]);
        for degrees in [0.0f64, 20.0, 45.0, 77.0] {
            let turn = DMat3::from_rotation_z(degrees.to_radians()) * DMat3::from_rotation_x(degrees / 7.0);
            for decimals in [1e3, 1e4, 1e12] {
                let rounded = |p: DVec3| (p * decimals).round() / decimals;
                let positions = solid.positions.iter().map(|p| rounded(turn * *p)).collect();
                let thin = deflated(&TriMesh::new(positions, solid.faces.clone()));
                has_topology(&thin, [1, 0, 1, 1]);
                near(thin.report.area, 6000.0, 1e-4);
                near(thin.report.thickness.max, pad, 1e-3);
            }
        }
    }
}
