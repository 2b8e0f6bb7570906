//! Feature curves and feature points on a reference mesh, and the frames that template nodes are encoded in.
//!
//! After Wang et al., *feature templates*: a feature curve is a sorted polyline on the surface with a name; a feature
//! point is where two of them cross.

use std::collections::BTreeMap;

use mesh_kernel::glam::DVec3;

/// A named polyline on (or, for tape curves, tautly over) the reference surface.
#[derive(Clone, Debug, PartialEq)]
pub struct FeatureCurve {
    /// Closed curves do not repeat their first point.
    pub closed: bool,
    /// Points in order, millimetres, in the frame of the mesh.
    pub points: Vec<DVec3>,
    /// Outward unit normal at each point, smoothed over a neighbourhood so that scan noise does not turn it.
    pub normals: Vec<DVec3>,
}

/// A named place on the reference surface.
#[derive(Clone, Debug, PartialEq)]
pub struct FeaturePoint {
    /// Position in millimetres, in the frame of the mesh.
    pub position: DVec3,
    /// Outward unit normal, smoothed.
    pub normal: DVec3,
}

/// The frame `(q; n, t1, t2)` of a template node's encoding. The three unit directions need not be orthogonal, but
/// their triple product is not zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The feature point, millimetres.
    pub origin: DVec3,
    /// Outward surface normal.
    pub normal: DVec3,
    /// Unit tangent of the first curve at the point.
    pub first: DVec3,
    /// Unit tangent of the second curve at the point.
    pub second: DVec3,
}

/// Everything that is known by name about a reference mesh. Ordered maps, so that files come out the same each time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Features {
    /// Unit vector to the body's front, horizontal, in the frame of the mesh.
    pub facing: DVec3,
    /// Unit vector upward, in the frame of the mesh.
    pub up: DVec3,
    /// Stature in millimetres.
    pub height: f64,
    /// Curves by name, for instance `waist`, `left_princess_front`.
    pub curves: BTreeMap<String, FeatureCurve>,
    /// Points by name, for instance `left_armpit`.
    pub points: BTreeMap<String, FeaturePoint>,
    /// What was guessed or could not be found, in words for people.
    pub warnings: Vec<String>,
}
