//! Solids whose facets were divided where they lie, as programs do that bring a mesh to an edge length.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[allow(dead_code, reason = "shared by test files")]
mod solid_models;

use mesh_kernel::TriMesh;
use sheet::deflate::{DeflateOptions, Nobody, deflate};
use solid_models::prism;

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
    for (times, solid) in [solid.clone(), divided(&solid), divided(&divided(&solid))].iter().enumerate() {
        let thin = deflate(solid, &DeflateOptions::default(), &Nobody).unwrap();
        let r = &thin.report;
        let what = format!("divided {times} times");
        assert_eq!((r.self_intersections, r.lost_edges), (0, 0), "{what}");
        assert_eq!([r.patches, r.joints, r.free_loops, r.components], [3, 1, 2, 1], "{what}");
        let removed: Vec<&str> = r.features.iter().filter(|f| f.removed).map(|f| f.kind).collect();
        assert_eq!(removed, ["fillet", "fillet"], "{what}");
        assert!((r.area - 60.0 * 60.0 - 60.0 * 21.0).abs() < 0.1, "{what}: {} mm²", r.area);
    }
}
