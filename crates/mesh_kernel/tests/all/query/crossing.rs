//! Crossing faces.

use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DMat3, DVec3};
use mesh_kernel::query::Crossings;

use crate::shapes::{icosphere, shared_body, torus};

fn moved(mesh: &TriMesh, by: DVec3) -> TriMesh {
    TriMesh::new(mesh.positions.iter().map(|p| *p + by).collect(), mesh.faces.clone())
}

#[test]
fn spheres_in_and_out_of_each_other() {
    let sphere = icosphere(100.0, 4);
    let crossings = Crossings::new(&sphere);
    assert!(crossings.self_crossing().is_empty());
    assert!(crossings.faces_crossing(&moved(&sphere, DVec3::X * 200.1)).is_empty());
    assert!(crossings.faces_crossing(&icosphere(98.0, 4)).is_empty(), "inside");
    let turn = DMat3::from_rotation_z(0.3) * DMat3::from_rotation_x(0.4);
    let other = moved(&sphere, DVec3::new(30.0, 40.0, 50.0));
    let other = TriMesh::new(other.positions.iter().map(|p| turn * *p).collect(), other.faces);
    let pairs = crossings.faces_crossing(&other);
    assert!(pairs.len() > 100 && pairs.is_sorted());
    // The same from the other's side.
    let mut back: Vec<(u32, u32)> =
        Crossings::new(&other).faces_crossing(&sphere).into_iter().map(|(a, b)| (b, a)).collect();
    back.sort_unstable();
    assert_eq!(pairs, back);
    // Every face meets its own copy, and the copy of its neighbours.
    let same = crossings.faces_crossing(&sphere);
    assert!((0..sphere.faces.len() as u32).all(|f| same.binary_search(&(f, f)).is_ok()));
    assert!(Crossings::new(&TriMesh::default()).faces_crossing(&sphere).is_empty());
    assert!(crossings.faces_crossing(&TriMesh::default()).is_empty());
}

#[test]
fn a_mesh_across_itself() {
    let mut ring = torus(300.0, 100.0, 40, 20);
    assert!(Crossings::new(&ring).self_crossing().is_empty());
    let other = torus(300.0, 100.0, 40, 20);
    let first = ring.positions.len() as u32;
    ring.positions.extend(other.positions.iter().map(|p| *p + DVec3::new(150.0, 1.0, 7.0)));
    ring.faces.extend(other.faces.iter().map(|f| f.map(|v| v + first)));
    let pairs = Crossings::new(&ring).self_crossing();
    assert!(!pairs.is_empty() && pairs.iter().all(|(a, b)| *a < 1600 && *b >= 1600));
    // A fold flat onto a neighbour, a duplicate, a touching corner.
    let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let mesh = TriMesh::new(
        vec![
            p(0., 0., 0.),
            p(1., 0., 0.),
            p(0., 1., 0.),
            p(0.2, 0.2, 0.),
            p(0.4, 0.2, 0.),
            p(0.4, 0.2, 1.),
            p(1., 1., 1.),
        ],
        vec![[0, 1, 2], [1, 0, 3], [2, 1, 0], [4, 5, 6]],
    );
    assert_eq!(Crossings::new(&mesh).self_crossing(), [(0, 1), (0, 2), (0, 3), (1, 2), (2, 3)]);
}

#[test]
fn a_shell_about_a_body_is_clear_of_it() {
    let Some(body) = shared_body("scan-remeshed") else { return };
    let pairs = Crossings::new(&body).faces_crossing(&moved(&body, DVec3::Y * 3.0));
    assert!(pairs.is_empty());
    let pairs = Crossings::new(&body).faces_crossing(&moved(&body, DVec3::Y * 0.01));
    assert!(pairs.len() > 1000);
}
