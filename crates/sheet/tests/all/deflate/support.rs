//! What tests of deflation ask of a mid-surface.

use mesh_kernel::TriMesh;
use mesh_kernel::body::Body;
use sheet::deflate::{DeflateOptions, Deflated, Nobody, deflate};

pub(crate) fn deflated(solid: &TriMesh) -> Deflated {
    deflate(solid, &DeflateOptions::default(), &Nobody).unwrap()
}

#[track_caller]
pub(crate) fn near(value: f64, wanted: f64, relative: f64) {
    assert!((value - wanted).abs() <= relative * wanted.abs(), "{value} is not {wanted}");
}

/// Patches, joints, free loops, parts.
#[track_caller]
pub(crate) fn has_topology(thin: &Deflated, wanted: [usize; 4]) {
    let r = &thin.report;
    assert_eq!([r.patches, r.joints, r.free_loops, r.components], wanted, "{r:?}");
    assert_eq!((r.self_intersections, r.lost_edges, r.loose_ends), (0, 0, None));
    // The kernel makes a body of it, and its counts agree.
    let body = Body::from_tri_mesh(&thin.sheet).unwrap();
    assert!(body.counts().identity_holds());
    assert_eq!(body.surfaces().len(), r.patches);
    assert_eq!(thin.thickness.len(), thin.sheet.faces.len());
}
