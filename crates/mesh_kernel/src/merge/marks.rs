//! What faces have in common: the points where they meet, by what meets there.

use glam::DVec3;

use super::complex::Complex;
use super::exact::{between, flat_area, volume};
use super::meeting::dominant_axis;

/// Edges that would cross farther than this many times the distance of what coincides beyond the end of one do not cross.
pub(super) const OVERSHOOT: f64 = 4.0;

/// Two nodes, the smaller first.
pub(super) type Edge = [u32; 2];

/// The edge between two nodes.
#[inline]
pub(super) fn edge(a: u32, b: u32) -> Edge {
    if a < b { [a, b] } else { [b, a] }
}

/// Something that two faces have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Mark {
    /// Two nodes in one place.
    Together(u32, u32),
    /// A node on an edge.
    NodeOnEdge(u32, Edge),
    /// A node within a face.
    NodeOnFace(u32, u32),
    /// Two edges that cross, the smaller first.
    EdgesCross(Edge, Edge),
    /// An edge through a face.
    EdgeThroughFace(Edge, u32),
}

/// What a pair of faces gives.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Finding {
    /// A common point.
    Mark(Mark),
    /// Faces that cross along a line, which runs through some marks and perhaps a node of both.
    Line { faces: [u32; 2], marks: Vec<Mark>, shared: Option<u32> },
    /// An edge that lies in the plane of a face and on it.
    EdgeInFace(Edge, u32),
}

/// Where the node of a mark goes; `None` for marks of nodes that there are, and for edges that run alongside each other.
pub(super) fn place_of(complex: &Complex, mark: Mark, near: f64) -> Option<DVec3> {
    let at = |v: u32| complex.at[v as usize];
    match mark {
        Mark::EdgeThroughFace([p, q], face) => {
            let [a, b, c] = complex.corners(face).at;
            let [n, m] = [at(p), at(q)].map(|x| volume(a, b, c, x));
            (n.signum() * m.signum() == -1).then(|| between(at(p), at(q), n, m))
        }
        Mark::EdgesCross([p, q], [r, s]) => {
            let [p, q, r, s] = [p, q, r, s].map(at);
            let across = (q - p).cross(s - r);
            if across == DVec3::ZERO {
                return None;
            }
            let axis = dominant_axis(across);
            let [n, m] = [p, q].map(|x| flat_area(axis, r, s, x));
            if n.signum() * m.signum() == -1 {
                return Some(between(p, q, n, m));
            }
            // They pass each other near the end of one.
            let (end, n, m) = if n.unsigned_abs() < m.unsigned_abs() { (p, n, m) } else { (q, m, n) };
            let overshot = n as f64 / (m as f64 - n as f64) * p.distance(q);
            (overshot.abs() <= OVERSHOOT * near).then_some(end)
        }
        _ => None,
    }
}
