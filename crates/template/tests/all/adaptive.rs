//! Adaptive splits keep to the uniform shape with fewer triangles.

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use mesh_kernel::query::ClosestPoint;
use template::{Garment, Reference, RegenerateOptions, Template, regenerate};

use super::collision::skirt;
use super::model;

fn garment(adaptive: Option<f64>) -> Garment {
    let mut file = skirt(15.0, 60.0).file().clone();
    file.adaptive = adaptive;
    file.level = 5;
    let (mesh, features) = model::trunk();
    let reference = Reference { mesh: &mesh, features: &features };
    let template = Template::from_json(&serde_json::to_string(&file).unwrap()).unwrap();
    let garment = regenerate(&template, &reference, &RegenerateOptions::default()).unwrap();
    assert!(garment.body.check().is_empty() && garment.body.counts().identity_holds());
    garment
}

/// Farthest that a node of the one is from the faces of the other, surface by surface.
fn apart(fine: &Garment, coarse: &Garment) -> f64 {
    let surface = |g: &Garment, k: usize| {
        let surface = g.body.surface(g.surfaces[k].id);
        TriMesh::new(surface.positions().to_vec(), surface.faces().to_vec())
    };
    (0..fine.surfaces.len())
        .flat_map(|k| {
            let near = ClosestPoint::new(&surface(coarse, k));
            surface(fine, k).positions.into_iter().map(move |p| near.closest(p).unwrap().distance)
        })
        .fold(0.0, f64::max)
}

#[test]
fn what_is_left_is_within_the_tolerance() {
    let uniform = garment(None);
    let faces = |g: &Garment| g.body.to_tri_mesh().faces.len();
    let mut last = faces(&uniform) + 1;
    for tolerance in [0.1, 0.5, 3.0, 20.0] {
        let adaptive = garment(Some(tolerance));
        assert!(apart(&uniform, &adaptive) <= tolerance * (1.0 + 1e-9), "{tolerance}");
        assert!(faces(&adaptive) < last, "{tolerance}: {} faces", faces(&adaptive));
        last = faces(&adaptive);
        assert_eq!((adaptive.collision.nodes_inside, adaptive.collision.faces_crossing), (0, 0));
        // Nodes that stay have not moved.
        let places: Vec<DVec3> = uniform.body.to_tri_mesh().positions;
        let is_there = |p: &DVec3| places.contains(p);
        assert!(adaptive.body.to_tri_mesh().positions.iter().all(is_there));
    }
    assert!(faces(&garment(Some(3.0))) < faces(&uniform) / 4);
}

#[test]
fn seams_lines_and_marks_survive() {
    let (uniform, adaptive) = (garment(None), garment(Some(1.0)));
    assert_eq!(uniform.seams.len(), adaptive.seams.len());
    for (one, other) in uniform.seams.iter().zip(&adaptive.seams) {
        assert_eq!(one.name, other.name);
        assert!((one.length - other.length).abs() < 1.0);
        let places: Vec<Vec<DVec3>> = other
            .sides
            .iter()
            .map(|side| {
                let positions = adaptive.body.surface(adaptive.surfaces[side.surface].id).positions();
                side.nodes.iter().map(|v| positions[*v as usize]).collect()
            })
            .collect();
        assert!(places[0].len() < one.sides[0].nodes.len());
        assert!(places.iter().all(|side| *side == places[0]), "a seam's sides keep their nodes one to one");
    }
    assert_eq!(uniform.lines.len(), adaptive.lines.len());
    for (one, other) in uniform.lines.iter().zip(&adaptive.lines) {
        assert_eq!((&one.name, one.chains.len()), (&other.name, other.chains.len()));
        assert_eq!(one.points.first(), other.points.first());
        assert_eq!(one.points.last(), other.points.last());
        assert!(one.points.iter().any(|p| other.points.contains(p)));
    }
    assert_eq!(uniform.marks.len(), adaptive.marks.len());
    let twins = |side: &str| {
        let id = adaptive.body.surface_named(side).unwrap();
        adaptive.body.surface(id).positions().len()
    };
    assert_eq!(twins("left_back"), twins("right_back"));
}

#[test]
fn tolerances_out_of_range_are_refused() {
    for bad in [0.0, -1.0, 1e6, f64::MIN_POSITIVE] {
        let mut file = skirt(15.0, 60.0).file().clone();
        file.adaptive = Some(bad);
        let error = Template::from_json(&serde_json::to_string(&file).unwrap()).unwrap_err();
        assert!(error.to_string().contains("adaptive"), "{error}");
    }
}
