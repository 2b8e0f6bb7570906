//! Booleans with known answers.

use crate::merge::support::{Random, block, fault, moved, sphere, tetrahedron, volume};
use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use mesh_kernel::merge::{Boolean, MergeOptions, boolean, solid_of_chain};

#[track_caller]
fn sound(models: &[&TriMesh], operation: Boolean) -> f64 {
    let solid = boolean(models, operation, &MergeOptions::default()).unwrap();
    assert_eq!(fault(&solid.mesh), None, "{operation:?}");
    let size: f64 = models.iter().map(|m| volume(m)).sum();
    assert!((solid.volume() - volume(&solid.mesh)).abs() <= 1e-9 * size);
    solid.volume()
}

/// All operations fit together.
fn consistent(one: &TriMesh, other: &TriMesh) -> [f64; 3] {
    let both = [one, other];
    let [u, i, d] = [Boolean::Union, Boolean::Intersection, Boolean::Difference].map(|o| sound(&both, o));
    let (a, b) = (volume(one), volume(other));
    let near = |x: f64, y: f64| assert!((x - y).abs() < 1e-6 * (a + b), "{x} {y}: {:?}", [u, i, d]);
    near(u + i, a + b);
    near(d + i, a);
    [u, i, d]
}

#[test]
fn blocks_through_each_other() {
    let one = block(DVec3::ZERO, DVec3::splat(10.0));
    let other = block(DVec3::new(2.0, 3.0, -5.0), DVec3::new(5.0, 7.0, 15.0));
    let [u, i, ..] = consistent(&one, &other);
    assert!((i - 120.0).abs() < 1e-9 && (u - 1120.0).abs() < 1e-9);
}

#[test]
fn blocks_with_faces_in_one_plane() {
    let one = block(DVec3::ZERO, DVec3::splat(10.0));
    // On the side, on the top half beside, inside touching from within, the same.
    for (lo, hi, common) in [
        ([10.0, 0.0, 0.0], [20.0, 10.0, 10.0], 0.0),
        ([10.0, 3.0, 2.0], [20.0, 12.0, 8.0], 0.0),
        ([5.0, 0.0, 0.0], [15.0, 10.0, 10.0], 500.0),
        ([2.0, 2.0, 0.0], [5.0, 5.0, 10.0], 90.0),
        ([0.0, 0.0, 0.0], [10.0, 10.0, 10.0], 1000.0),
        ([0.0, 0.0, 0.0], [5.0, 5.0, 5.0], 125.0),
        ([20.0, 0.0, 0.0], [30.0, 10.0, 10.0], 0.0),
        ([3.0, 3.0, 3.0], [6.0, 6.0, 6.0], 27.0),
    ] {
        let other = block(DVec3::from_array(lo), DVec3::from_array(hi));
        let [_, i, ..] = consistent(&one, &other);
        assert!((i - common).abs() < 1e-9, "{lo:?}: {i}");
    }
}

#[test]
fn blocks_that_touch_in_an_edge_or_a_node_are_joined_by_beads() {
    let one = block(DVec3::ZERO, DVec3::splat(10.0));
    for lo in [[10.0, 10.0, 0.0], [10.0, 10.0, 10.0], [10.0, 10.0, 5.0]] {
        let lo = DVec3::from_array(lo);
        let other = block(lo, lo + 10.0);
        let solid = boolean(&[&one, &other], Boolean::Union, &MergeOptions::default()).unwrap();
        assert_eq!(fault(&solid.mesh), None);
        assert!(solid.beads > 0);
        assert!((solid.volume() - 2000.0).abs() < 2000.0 * 1e-5);
    }
}

#[test]
fn spheres_in_general_position() {
    let mut random = Random::new(5);
    for k in 0..20 {
        let one = sphere(DVec3::ZERO, 10.0, k % 4);
        let other = sphere(random.point() * 12.0, 3.0 + 9.0 * random.next(), (k + 1) % 4);
        consistent(&one, &other);
    }
}

#[test]
fn the_same_sphere_turned_a_little() {
    let mut random = Random::new(8);
    for size in [1.0, 1e-3, 1e-6, 1e-9, 1e-11, 1e-12, 1e-13] {
        let one = sphere(DVec3::ZERO, 10.0, 2);
        let turn = mesh_kernel::glam::DQuat::from_axis_angle(random.point().normalize(), size);
        let other = moved(&one, |p| turn * p);
        let [u, ..] = consistent(&one, &other);
        assert!(u >= volume(&one) * (1.0 - 1e-9) && u < volume(&one) * (1.0 + 0.2 * size.min(1.0) + 1e-9));
    }
}

#[test]
fn many_tetrahedra_at_once() {
    let mut random = Random::new(3);
    for n in [3usize, 10, 40] {
        let mut chain = TriMesh::default();
        for _ in 0..n {
            let centre = random.point() * 6.0;
            let t = tetrahedron([0; 4].map(|_| centre + random.point() * 5.0));
            let first = chain.positions.len() as u32;
            chain.positions.extend(&t.positions);
            chain.faces.extend(t.faces.iter().map(|f| f.map(|v| v + first)));
        }
        let solid = solid_of_chain(&chain, &MergeOptions::default()).unwrap();
        assert_eq!(fault(&solid.mesh), None, "{n}");
        assert_eq!(solid.parents.len(), solid.mesh.faces.len());
    }
}
