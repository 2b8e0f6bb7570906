//! Mirrored halves are each other's images; the same input gives the same bits.

use mesh_kernel::glam::DVec3;
use template::{Garment, Reference, RegenerateOptions, regenerate};

use super::collision::skirt;
use super::model;

fn garment() -> Garment {
    let (mesh, features) = model::trunk();
    let reference = Reference { mesh: &mesh, features: &features };
    regenerate(&skirt(15.0, 60.0), &reference, &RegenerateOptions::default()).unwrap()
}

#[test]
fn halves_are_mirror_images() {
    let garment = garment();
    let place = |name: &str| {
        let id = garment.body.surface_named(name).unwrap();
        garment.body.surface(id).positions().to_vec()
    };
    let near = |list: &[DVec3], p: DVec3| list.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min);
    let (left, right, front) = (place("left_back"), place("right_back"), place("front"));
    let mirror = |p: &DVec3| DVec3::new(-p.x, p.y, p.z);
    assert!(left.iter().all(|p| near(&right, mirror(p)) < 1e-6));
    assert!(front.iter().all(|p| near(&front, mirror(p)) < 1e-6));
    assert!(front.iter().any(|p| p.x == 0.0));
    let twin = garment.surfaces.iter().find(|s| s.name == "right_back").unwrap();
    assert_eq!(twin.mirrored_of.as_deref(), Some("left_back"));
    // A pair has one name in the template, and the cutting room must tell them apart.
    let labels = ["left_back", "right_back", "front"]
        .map(|name| garment.surfaces.iter().find(|s| s.name == name).unwrap().piece.label.as_str());
    assert_eq!(labels, ["Back, left", "Back, right", "front"]);
    assert_eq!(twin.piece.edges.len(), 1);
    assert_eq!(twin.piece.edges[0].allowance, 30.0);
}

#[test]
fn seams_correspond_node_by_node() {
    let garment = garment();
    // Two side seams and the centre back.
    assert_eq!(garment.seams.len(), 3);
    for seam in &garment.seams {
        let places: Vec<Vec<DVec3>> = seam
            .sides
            .iter()
            .map(|side| {
                let positions = garment.body.surface(garment.surfaces[side.surface].id).positions();
                side.nodes.iter().map(|v| positions[*v as usize]).collect()
            })
            .collect();
        assert_eq!(places.len(), 2);
        assert_eq!(places[0], places[1]);
        assert_eq!(places[0].len(), 17);
    }
    let waist = garment.marks.iter().filter(|m| m.name == "left_waist").count();
    assert_eq!(waist, 2, "the node lies on two surfaces");
}

#[test]
fn the_same_input_gives_the_same_bits() {
    let bits = |g: &Garment| -> Vec<[u64; 3]> {
        let mesh = g.body.to_tri_mesh();
        mesh.positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect()
    };
    assert_eq!(bits(&garment()), bits(&garment()));
}
