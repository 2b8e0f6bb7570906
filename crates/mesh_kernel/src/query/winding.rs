//! The generalised winding number (Jacobson, Kavan, Sorkine 2013), exactly and by a hierarchy with error bounds.
//!
//! The hierarchy follows Barill, Dickson, Schmidt, Levin, Jacobson (2018): faces far away act as one dipole with a
//! first-order correction. Here every approximation carries a bound of its error, so that comparing with a threshold is
//! certain: where the bound does not decide, the sum is taken more finely, in the end exactly.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};

use super::bvh::{Bvh, LEAF, VACANT};
use crate::TriMesh;

/// How often the mesh winds around `p`: 1 inside and 0 outside a closed mesh with outward faces, in between for meshes
/// with holes. The sum of all solid angles over 4π, O(faces); see [`WindingNumber`] for many points.
pub fn winding_number(mesh: &TriMesh, p: DVec3) -> f64 {
    (0..mesh.faces.len() as u32).map(|f| half_solid_angle(mesh.corners(f), p)).sum::<f64>() / TAU
}

/// Half the solid angle of a triangle seen from `p`, positive from behind (van Oosterom, Strackee 1983).
#[inline]
pub(super) fn half_solid_angle(corners: [DVec3; 3], p: DVec3) -> f64 {
    let [a, b, c] = corners.map(|v| v - p);
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let numerator = a.dot(b.cross(c));
    let denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    if numerator == 0.0 { 0.0 } else { numerator.atan2(denominator) }
}

/// A winding number and how far it can be off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Winding {
    /// The number.
    pub value: f64,
    /// Bound of its error (apart from rounding).
    pub error: f64,
}

/// A mesh prepared for winding numbers at many points.
#[derive(Clone, Debug)]
pub struct WindingNumber {
    bvh: Bvh,
    triangles: Vec<[DVec3; 3]>,
    /// Four a node, in the order of its children.
    moments: Vec<Moments>,
}

/// What a set of faces looks like from afar; positions relative to the hierarchy's origin.
#[derive(Clone, Debug)]
struct Moments {
    area: f64,
    /// Centroid.
    centre: DVec3,
    /// No corner is farther from the centre; negative for no faces.
    radius: f64,
    /// Sum of area vectors.
    dipole: DVec3,
    /// ∫ (x − centre) nᵀ dA.
    first: DMat3,
    /// ∫ |x − centre|² dA: what the error is proportional to.
    spread: f64,
}

/// Error that a single set of faces may add in the first attempt; a later attempt has less.
const FIRST_TOLERANCE: f64 = 2e-3;
const LAST_TOLERANCE: f64 = 1e-8;

impl WindingNumber {
    /// Builds the hierarchy. O(n log n).
    pub fn new(mesh: &TriMesh) -> Self {
        Self::with_bvh(Bvh::new(mesh), mesh)
    }

    pub(super) fn with_bvh(bvh: Bvh, mesh: &TriMesh) -> Self {
        let corners =
            |f: u32| if f == VACANT { [DVec3::ZERO; 3] } else { mesh.corners(f).map(|p| p - bvh.origin) };
        let triangles: Vec<[DVec3; 3]> = bvh.order.iter().map(|f| corners(*f)).collect();
        // From the bottom up: children have larger numbers than their parent.
        let mut moments = vec![Moments::EMPTY; 4 * bvh.nodes.len()];
        for node in (0..bvh.nodes.len()).rev() {
            for slot in 0..4 {
                moments[4 * node + slot] = match bvh.nodes[node].children[slot].get() {
                    Ok(leaf) => {
                        let faces: [Moments; LEAF] =
                            std::array::from_fn(|k| match triangles[leaf.clone()].get(k) {
                                Some(face) => Moments::of_face(face),
                                None => Moments::EMPTY,
                            });
                        Moments::join(&faces)
                    }
                    Err(below) => Moments::join(&moments[4 * below..4 * below + 4]),
                };
            }
        }
        Self { bvh, triangles, moments }
    }

    /// The winding number about `p`, the error bounded by about `tolerance` times the number of face sets it takes
    /// (some hundred).
    pub fn winding(&self, p: DVec3, tolerance: f64) -> Winding {
        self.sum(p, tolerance, None)
    }

    /// Whether the winding number about `p` is above `threshold`, with certainty up to rounding of the exact sum.
    pub fn is_above(&self, p: DVec3, threshold: f64) -> bool {
        let mut tolerance = FIRST_TOLERANCE;
        loop {
            let Winding { value, error } = self.sum(p, tolerance, None);
            if (value - threshold).abs() > error + 1e-9 || error == 0.0 || value.is_nan() {
                return value > threshold;
            }
            tolerance = if tolerance < LAST_TOLERANCE { 0.0 } else { tolerance / 30.0 };
        }
    }

    /// The sum over all faces but `except` (a position in the hierarchy's order is looked up by face number).
    pub(super) fn sum(&self, p: DVec3, tolerance: f64, except: Option<u32>) -> Winding {
        let p = p - self.bvh.origin;
        let (mut angle, mut far, mut error) = (0.0, 0.0, 0.0);
        let mut stack = [0usize; super::bvh::STACK];
        let mut height = usize::from(!self.triangles.is_empty());
        while height > 0 {
            height -= 1;
            let node = stack[height];
            for slot in 0..4 {
                let set = &self.moments[4 * node + slot];
                let d = set.centre - p;
                let d2 = d.length_squared();
                let length = d2.sqrt();
                let gap = length - set.radius;
                let bound = 3.0 * set.spread / (2.0 * TAU * (gap * gap) * (gap * gap));
                if gap > 0.0 && bound <= tolerance {
                    let scale = 1.0 / (d2 * length);
                    let trace = set.first.x_axis.x + set.first.y_axis.y + set.first.z_axis.z;
                    far += scale * (set.dipole.dot(d) + trace - 3.0 * d.dot(set.first * d) / d2);
                    error += bound;
                    continue;
                }
                match self.bvh.nodes[node].children[slot].get() {
                    Err(below) => {
                        stack[height] = below;
                        height += 1;
                    }
                    Ok(leaf) => {
                        for k in leaf {
                            if except.is_none_or(|f| self.bvh.order[k] != f) {
                                angle += half_solid_angle(self.triangles[k], p);
                            }
                        }
                    }
                }
            }
        }
        Winding { value: angle / TAU + far / (2.0 * TAU), error }
    }
}

impl Moments {
    const EMPTY: Self = Self {
        area: 0.0,
        centre: DVec3::ZERO,
        radius: -1.0,
        dipole: DVec3::ZERO,
        first: DMat3::ZERO,
        spread: 0.0,
    };

    fn of_face(corners: &[DVec3; 3]) -> Self {
        let [a, b, c] = *corners;
        let centre = (a + b + c) / 3.0;
        let dipole = 0.5 * (b - a).cross(c - a);
        let area = dipole.length();
        let squares = corners.map(|p| p.distance_squared(centre));
        let radius = squares[0].max(squares[1]).max(squares[2]).sqrt();
        // The first moment about the centroid vanishes; ∫ |x − centre|² dA = area / 12 · Σ |corner − centre|².
        let spread = area / 12.0 * (squares[0] + squares[1] + squares[2]);
        Self { area, centre, radius, dipole, first: DMat3::ZERO, spread }
    }

    /// All in one, moved to the common centroid.
    fn join(parts: &[Self]) -> Self {
        let parts = || parts.iter().filter(|part| part.radius >= 0.0);
        let area: f64 = parts().map(|part| part.area).sum();
        let count = parts().count();
        if count == 0 {
            return Self::EMPTY;
        }
        let centre = if area > 0.0 {
            parts().map(|part| part.centre * part.area).sum::<DVec3>() / area
        } else {
            parts().map(|part| part.centre).sum::<DVec3>() / count as f64
        };
        let mut whole = Self { area, centre, radius: 0.0, ..Self::EMPTY };
        for part in parts() {
            let shift = part.centre - centre;
            whole.radius = whole.radius.max(shift.length() + part.radius);
            whole.dipole += part.dipole;
            whole.spread += part.spread + part.area * shift.length_squared();
            whole.first.x_axis += part.first.x_axis + shift * part.dipole.x;
            whole.first.y_axis += part.first.y_axis + shift * part.dipole.y;
            whole.first.z_axis += part.first.z_axis + shift * part.dipole.z;
        }
        whole
    }
}
