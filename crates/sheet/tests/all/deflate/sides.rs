//! Which side of a wall is kept: the one that knows what stands on it.

use crate::deflate::solid_models::{block, prism, revolved, united};
use crate::deflate::support::{deflated, has_topology, near};
use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DMat3, DQuat, EulerRot};
use sheet::deflate::{DeflateOptions, Nobody, deflate};

/// Half a tube whose edges are bent sharply inward would rather be kept on its inside, which does not know of the fin.
#[test]
fn fins_outside_of_a_bent_wall_share_its_nodes() {
    let arc = |radius: f64, from: f64, to: f64, chords: u32| {
        (0..=chords).map(move |k| {
            let angle = from + (to - from) * f64::from(k) / f64::from(chords);
            [radius * angle.cos(), radius * angle.sin()]
        })
    };
    for (outer, inner) in [(9, 17), (20, 20), (40, 31)] {
        let low = (-2.0f64 / 20.0).asin();
        let fin = (1.0f64 / 20.0).acos();
        let mut profile = vec![[10.0, -2.0]];
        profile.extend(arc(20.0, low, fin, outer));
        profile.extend([[1.0, 30.0], [-1.0, 30.0]]);
        profile.extend(arc(20.0, std::f64::consts::PI - fin, std::f64::consts::PI - low, outer));
        profile.extend([[-10.0, -2.0], [-10.0, 0.0]]);
        profile.extend(arc(18.0, std::f64::consts::PI, 0.0, inner));
        profile.push([10.0, 0.0]);
        let solid = prism(&profile, 40.0, 2);
        let thin = deflate(&solid, &DeflateOptions::default(), &Nobody).unwrap();
        let r = &thin.report;
        assert_eq!([r.patches, r.joints, r.components], [5, 1, 1], "{outer} chords, {inner} inside");
        assert_eq!((r.self_intersections, r.lost_edges), (0, 0), "{outer} chords, {inner} inside");
    }
}

/// A few ribs in a long bend that has a flange on its outside: only the inner facets of the bend are cut where the ribs stand, however much
/// longer the flange's edge is.
#[test]
fn ribs_inside_of_a_bend_share_its_nodes_whatever_is_outside() {
    let arc = |radius: f64, chords: u32| {
        (0..=chords).map(move |k| {
            let angle = std::f64::consts::FRAC_PI_2 * (2.0 + f64::from(k) / f64::from(chords));
            [4.0 + radius * angle.cos(), 4.0 + radius * angle.sin()]
        })
    };
    let mut profile = vec![[60.0, 0.0], [60.0, 1.5], [4.0, 1.5]];
    profile.extend(arc(2.5, 5).collect::<Vec<_>>().into_iter().rev().skip(1));
    profile.extend([[1.5, 30.0], [-12.0, 30.0], [-12.0, 28.5], [0.0, 28.5]]);
    profile.extend(arc(4.0, 5));
    let mut solids = vec![prism(&profile, 300.0, 1)];
    for at in [100.0, 200.0] {
        // Round where it reaches into the material of the bend.
        let mut outline: Vec<[f64; 2]> = arc(3.2, 40).collect();
        outline.extend([[40.0, 0.8], [40.0, 10.0], [10.0, 20.0], [0.8, 20.0]]);
        let mut rib = prism(&outline, 1.2, 1);
        rib.positions.iter_mut().for_each(|p| p.z += at);
        solids.push(rib);
    }
    let solid = united(&solids);
    let thin = deflate(&solid, &DeflateOptions::default(), &Nobody).unwrap();
    let r = &thin.report;
    assert_eq!([r.patches, r.joints, r.components], [4, 2, 1]);
    assert_eq!((r.self_intersections, r.lost_edges), (0, 0));
}

/// A ring with a round top runs through a higher rib: its top is made of chords, and ends in one node all the same.
#[test]
fn a_ring_that_crosses_a_rib_has_one_node_there() {
    let ring = |inner: f64, outer: f64, [from, to]: [f64; 2]| {
        let arc = |radius: f64| {
            (0..=37).map(move |k| {
                let angle = std::f64::consts::PI * f64::from(k) / 37.0;
                [radius * angle.cos(), radius * angle.sin()]
            })
        };
        let inside: Vec<[f64; 2]> = arc(inner).collect();
        let profile: Vec<[f64; 2]> = arc(outer).chain(inside.into_iter().rev()).collect();
        let mut ring = prism(&profile, to - from, 1);
        ring.positions.iter_mut().for_each(|p| p.z += from);
        ring
    };
    let rib = block([9.0, 28.0, 0.0], [11.0, 38.8, 50.0]);
    let solid = united(&[ring(39.0, 41.0, [0.0, 50.0]), ring(34.0, 39.5, [19.0, 21.0]), rib]);
    let thin = deflate(&solid, &DeflateOptions::default(), &Nobody).unwrap();
    assert_eq!([thin.report.free_loops, thin.report.components], [3, 1]);
}

/// A tube with fins outside and others inside, at other angles: the side that is kept has edges of the one kind only, and the others end on it
/// nevertheless.
#[test]
fn fins_on_both_sides_of_a_tube_are_joined_to_it() {
    for (chords, turn) in [(24, 0.07), (24, 0.13), (60, 0.07)] {
        let fin = |from: f64, to: f64, angle: f64| {
            let mut fin = block([from, -0.75, 0.0], [to, 0.75, 30.0]);
            fin.positions.iter_mut().for_each(|p| *p = DMat3::from_rotation_z(angle) * *p);
            fin
        };
        let tube = revolved(&[[19.0, 0.0], [21.0, 0.0], [21.0, 30.0], [19.0, 30.0]], chords, true);
        let outside = (0..5).map(|k| fin(20.0, 35.0, std::f64::consts::TAU * f64::from(k) / 5.0));
        let inside = (0..3).map(|k| fin(8.0, 20.0, turn + std::f64::consts::TAU * f64::from(k) / 3.0));
        let solid = united(&std::iter::once(tube).chain(outside).chain(inside).collect::<Vec<_>>());
        let thin = deflated(&solid);
        // Five pieces of the tube are cut by three more fins.
        has_topology(&thin, [16, 8, 9, 1]);
        let area = std::f64::consts::TAU * 20.0 * 30.0 + 30.0 * (5.0 * 15.0 + 3.0 * 12.0);
        near(thin.report.area, area, 5e-3);
        // Meshed for analysis there are no slivers where they were joined.
        let options = DeflateOptions { edge_length: Some(2.0), ..DeflateOptions::default() };
        let thin = deflate(&solid, &options, &Nobody).unwrap();
        has_topology(&thin, [16, 8, 9, 1]);
        let least = least_angle(&thin.sheet);
        assert!(least > 12.0, "{chords} chords: an angle of {least:.2}°");
    }
}

/// However the same solid stands in space, and however its facets fall beside the fins.
#[test]
fn fins_are_joined_in_any_position() {
    let fin = |from: f64, to: f64, angle: f64| {
        let mut fin = block([from, -0.75, 0.0], [to, 0.75, 30.0]);
        fin.positions.iter_mut().for_each(|p| *p = DMat3::from_rotation_z(angle) * *p);
        fin
    };
    let tube = revolved(&[[19.0, 0.0], [21.0, 0.0], [21.0, 30.0], [19.0, 30.0]], 24, true);
    let outside = (0..5).map(|k| fin(20.0, 35.0, std::f64::consts::TAU * f64::from(k) / 5.0));
    let inside = (0..3).map(|k| fin(8.0, 20.0, 0.07 + std::f64::consts::TAU * f64::from(k) / 3.0));
    let solid = united(&std::iter::once(tube).chain(outside).chain(inside).collect::<Vec<_>>());
    for k in 0..12 {
        let turn = DMat3::from_quat(DQuat::from_euler(EulerRot::XYZ, f64::from(k), 0.3, 1.7 * f64::from(k)));
        let positions = solid.positions.iter().map(|p| turn * *p).collect();
        has_topology(&deflated(&TriMesh::new(positions, solid.faces.clone())), [16, 8, 9, 1]);
    }
}

/// A web across a tube, over the kink between two facets of its inside, which nothing but the outside knows of; and other webs, with fins outside.
#[test]
fn webs_across_tubes_are_joined_to_both_sides_of_them() {
    let tube = revolved(&[[19.0, 0.0], [21.0, 0.0], [21.0, 30.0], [19.0, 30.0]], 24, true);
    let web = |y: f64| {
        let end = |y: f64| (19.7 * 19.7 - y * y).sqrt();
        let [low, high] = [y - 0.75, y + 0.75];
        prism(&[[-end(low), low], [end(low), low], [end(high), high], [-end(high), high]], 30.0, 1)
    };
    let fins =
        [block([20.0, -0.75, 0.0], [35.0, 0.75, 30.0]), block([-35.0, -0.75, 0.0], [-20.0, 0.75, 30.0])];
    for y in [4.0, 10.0, 12.25, 13.0, 14.0] {
        has_topology(&deflated(&united(&[tube.clone(), web(y)])), [3, 2, 4, 1]);
        let [right, left] = fins.clone();
        has_topology(&deflated(&united(&[tube.clone(), web(y), right, left])), [7, 4, 5, 1]);
    }
}

/// The smallest angle of all faces, in degrees.
fn least_angle(mesh: &TriMesh) -> f64 {
    let of = |f: u32| {
        let [a, b, c] = mesh.corners(f);
        let angles = [[a, b, c], [b, c, a], [c, a, b]].map(|[p, q, r]| (q - p).angle_between(r - p));
        angles.into_iter().fold(f64::INFINITY, f64::min).to_degrees()
    };
    (0..mesh.faces.len() as u32).map(of).fold(f64::INFINITY, f64::min)
}

/// A shelf that ends half a millimetre before a wall is not joined to it, however thick the shelf is; nor does a low lip go for the plate that it
/// stands on.
#[test]
fn what_does_not_touch_is_not_joined() {
    let shelf = |gap: f64| {
        let plate = block([0.0, 0.0, 0.0], [100.0, 60.0, 1.6]);
        let wall = block([0.0, 0.0, 0.0], [1.6, 60.0, 40.0]);
        let post = block([98.0, 0.0, 0.0], [100.0, 60.0, 40.0]);
        united(&[plate, wall, post, block([1.6 + gap, 0.0, 20.0], [99.0, 60.0, 24.0])])
    };
    for gap in [0.3, 0.5, 1.0] {
        let thin = deflated(&shelf(gap));
        has_topology(&thin, [5, 1, 2, 1]);
        near(thin.report.area, 60.0 * (98.2 + 2.0 * 39.2 + 97.4 - gap), 1e-9);
    }
    let options = DeflateOptions { max_thickness: Some(12.0), ..DeflateOptions::default() };
    let lip =
        united(&[block([0.0, 0.0, 0.0], [80.0, 60.0, 2.0]), block([20.0, 0.0, 1.0], [22.0, 60.0, 5.0])]);
    let thin = deflate(&lip, &options, &Nobody).unwrap();
    assert_eq!(thin.report.joints, 1);
}

/// A half-round bead right across a plate: its ends are arcs, and the plate stays flat.
#[test]
fn a_bead_across_a_plate_leaves_it_flat() {
    let mut profile = vec![[0.0, 0.0], [100.0, 0.0], [100.0, 2.0]];
    let turn = |k: u32| std::f64::consts::PI * f64::from(k) / 12.0;
    profile.extend((0..=12).map(|k| [50.0 + 4.0 * turn(k).cos(), 2.0 + 4.0 * turn(k).sin()]));
    profile.push([0.0, 2.0]);
    let thin = deflated(&prism(&profile, 60.0, 1));
    has_topology(&thin, [1, 0, 1, 1]);
    near(thin.report.area, 6000.0, 1e-9);
}
