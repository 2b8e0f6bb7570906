//! The geometries that faces of machined and moulded parts have, and what lies halfway between two of them.

use glam::DVec3;
use serde::Serialize;

/// Axes and normals that lean less than this, in radians, are one; centres may be apart by this share of a radius.
const SAME: f64 = 2e-3;

/// The geometry of a face. Lengths in millimetres, angles in radians, directions of unit length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Shape {
    /// The points x with `normal · x = offset`.
    Plane {
        /// Out of the material.
        normal: DVec3,
        /// Distance from the origin along the normal.
        offset: f64,
    },
    /// A round cylinder.
    Cylinder {
        /// On the axis, beside the face's middle.
        point: DVec3,
        /// Along the axis.
        axis: DVec3,
        /// Distance from the axis.
        radius: f64,
    },
    /// A round cone.
    Cone {
        /// The tip.
        apex: DVec3,
        /// From the tip into the cone.
        axis: DVec3,
        /// Between the axis and the surface.
        half_angle: f64,
    },
    /// A sphere.
    Sphere {
        /// The middle.
        centre: DVec3,
        /// Distance from the middle.
        radius: f64,
    },
    /// A torus: a fillet along a circle.
    Torus {
        /// The middle.
        centre: DVec3,
        /// Of the turn.
        axis: DVec3,
        /// Radius of the circle that the tube follows.
        major: f64,
        /// Radius of the tube.
        minor: f64,
    },
    /// None of the others.
    Freeform,
}

impl Shape {
    /// How far a point is outside, in mm: beyond the plane, farther than the radius. 0 for a freeform face.
    pub fn distance(&self, p: DVec3) -> f64 {
        match *self {
            Self::Plane { normal, offset } => normal.dot(p) - offset,
            Self::Cylinder { point, axis, radius } => {
                let d = p - point;
                (d - axis * axis.dot(d)).length() - radius
            }
            Self::Cone { apex, axis, half_angle } => {
                let d = p - apex;
                let along = axis.dot(d);
                (d - axis * along).length() * half_angle.cos() - along * half_angle.sin()
            }
            Self::Sphere { centre, radius } => centre.distance(p) - radius,
            Self::Torus { centre, axis, major, minor } => {
                let d = p - centre;
                let along = axis.dot(d);
                ((d - axis * along).length() - major).hypot(along) - minor
            }
            Self::Freeform => 0.0,
        }
    }

    /// The unit vector in which the distance grows fastest; zero where there is none.
    pub fn outward(&self, p: DVec3) -> DVec3 {
        match *self {
            Self::Plane { normal, .. } => normal,
            Self::Cylinder { point, axis, .. } => {
                let d = p - point;
                (d - axis * axis.dot(d)).normalize_or_zero()
            }
            Self::Cone { apex, axis, half_angle } => {
                let d = p - apex;
                let radial = (d - axis * axis.dot(d)).normalize_or_zero();
                radial * half_angle.cos() - axis * half_angle.sin()
            }
            Self::Sphere { centre, .. } => (p - centre).normalize_or_zero(),
            Self::Torus { centre, axis, major, .. } => {
                let d = p - centre;
                let along = axis.dot(d);
                let radial = d - axis * along;
                (radial - radial.normalize_or_zero() * major + axis * along).normalize_or_zero()
            }
            Self::Freeform => DVec3::ZERO,
        }
    }

    /// What lies halfway between two faces that are as far from each other everywhere, and how far that is: parallel planes, coaxial
    /// cylinders and cones, concentric spheres, tori along one circle. `None` for others.
    pub fn middle(&self, other: &Self) -> Option<(Self, f64)> {
        let one = |a: DVec3, b: DVec3| a.cross(b).length() < SAME;
        match (*self, *other) {
            (Self::Plane { normal, offset }, Self::Plane { normal: m, offset: o }) => {
                let middle = Self::Plane { normal, offset: (offset - o) / 2.0 };
                (one(normal, m) && normal.dot(m) < 0.0).then(|| (middle, (offset + o).abs()))
            }
            (Self::Cylinder { point, axis, radius }, Self::Cylinder { point: q, axis: b, radius: r }) => {
                let apart = (q - point) - axis * axis.dot(q - point);
                let same = one(axis, b) && apart.length() < SAME * radius.max(r);
                let axis = (axis + b * axis.dot(b).signum()).normalize();
                let middle = Self::Cylinder { point: point + apart / 2.0, axis, radius: (radius + r) / 2.0 };
                same.then(|| (middle, (radius - r).abs()))
            }
            (Self::Cone { apex, axis, half_angle }, Self::Cone { apex: q, axis: b, half_angle: h }) => {
                let along = axis.dot(q - apex);
                let apart = ((q - apex) - axis * along).length();
                let same = one(axis, b) && axis.dot(b) > 0.0 && (half_angle - h).abs() < SAME;
                let middle = Self::Cone {
                    apex: apex.midpoint(q),
                    axis: (axis + b).normalize(),
                    half_angle: (half_angle + h) / 2.0,
                };
                (same && apart < SAME * along.abs().max(apart))
                    .then(|| (middle, along.abs() * half_angle.sin()))
            }
            (Self::Sphere { centre, radius }, Self::Sphere { centre: q, radius: r }) => {
                let middle = Self::Sphere { centre: centre.midpoint(q), radius: (radius + r) / 2.0 };
                (centre.distance(q) < SAME * radius.max(r)).then(|| (middle, (radius - r).abs()))
            }
            (
                Self::Torus { centre, axis, major, minor },
                Self::Torus { centre: q, axis: b, major: m, minor: r },
            ) => {
                let near = SAME * minor.max(r).max(major);
                let same = one(axis, b) && centre.distance(q) < near && (major - m).abs() < near;
                let middle = Self::Torus {
                    centre: centre.midpoint(q),
                    axis: (axis + b * axis.dot(b).signum()).normalize(),
                    major: (major + m) / 2.0,
                    minor: (minor + r) / 2.0,
                };
                same.then(|| (middle, (minor - r).abs()))
            }
            _ => None,
        }
    }

    /// The axis of a cylinder or a cone; `None` for others.
    pub(super) fn axis(&self) -> Option<DVec3> {
        match *self {
            Self::Cylinder { axis, .. } | Self::Cone { axis, .. } => Some(axis),
            _ => None,
        }
    }

    /// Its name, as files have it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Plane { .. } => "plane",
            Self::Cylinder { .. } => "cylinder",
            Self::Cone { .. } => "cone",
            Self::Sphere { .. } => "sphere",
            Self::Torus { .. } => "torus",
            Self::Freeform => "freeform",
        }
    }
}
