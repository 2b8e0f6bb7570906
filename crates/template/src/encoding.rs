//! Node encoding (Wang et al., eq. 1 and 2): a node is stored as its offset from a feature point, not as a place.

use glam::{DMat3, DVec3};
use reference::Frame;

/// Offset of a node in the frame of its feature point, mm: `p = q + α n + β t₁ + γ t₂`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Offset {
    /// α, along the surface normal.
    pub normal: f64,
    /// β, along the first curve's tangent.
    pub first: f64,
    /// γ, along the second curve's tangent.
    pub second: f64,
}

/// Smallest triple product of a frame's unit directions that still holds an offset: about 0.06° between a tangent and
/// the plane of the other two.
pub const FLATTEST_FRAME: f64 = 1e-3;

/// The place of an offset in a frame (eq. 1).
pub fn decode(frame: &Frame, offset: Offset) -> DVec3 {
    frame.origin + offset.normal * frame.normal + offset.first * frame.first + offset.second * frame.second
}

/// The offset of a place in a frame (eq. 1 solved): the inverse of [`decode`]. The directions need not be orthogonal;
/// `None` when they lie (nearly) in one plane.
pub fn encode(frame: &Frame, place: DVec3) -> Option<Offset> {
    let matrix = DMat3::from_cols(frame.normal, frame.first, frame.second);
    let triple = matrix.determinant();
    if triple.abs() < FLATTEST_FRAME || !triple.is_finite() {
        return None;
    }
    let x = matrix.inverse() * (place - frame.origin);
    Some(Offset { normal: x.x, first: x.y, second: x.z })
}

/// The place of a world-axis offset `[left, up, front]` from a feature point (eq. 2), the weaker alternative: it does not
/// turn with the body.
pub fn decode_axes(origin: DVec3, axes: [f64; 3]) -> DVec3 {
    origin + DVec3::from_array(axes)
}

/// The world-axis offset of a place from a feature point (eq. 2).
pub fn encode_axes(origin: DVec3, place: DVec3) -> [f64; 3] {
    (place - origin).to_array()
}
