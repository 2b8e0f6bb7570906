//! Finite coordinates; degenerate faces.

use glam::DVec3;

use super::Defect;
use crate::body::radial::collinear;
use crate::body::{Body, EdgeId, NONE, NodeId};

/// Whether all spatial positions are finite.
pub(super) fn check_finite(body: &Body, defects: &mut Vec<Defect>) -> bool {
    let mut finite = true;
    for (id, s) in body.surfaces() {
        let mut rule = |layer, v: usize, position: DVec3| {
            if s.slots.nodes.is_free(v as u32) {
                return true;
            }
            if !position.is_finite() {
                defects.push(Defect::NotFinite { surface: id, node: NodeId(v as u32), layer, position });
            }
            position.is_finite()
        };
        for (v, &p) in s.positions.iter().enumerate() {
            finite &= rule("spatial", v, p);
        }
        for (v, &p) in s.backup.iter().enumerate() {
            rule("backup", v, p);
        }
        for (v, &p) in s.planar.iter().enumerate() {
            rule("planar", v, p.extend(0.0));
        }
    }
    finite
}

/// A computed sine of an angle above this is certainly not zero: far above the rounding of its few operations.
const CLEAR_SINE: f64 = 1e-10;

/// Faces whose corners lie on one line, by exact predicates; edges without face and length.
pub(super) fn check_degenerate(body: &Body, defects: &mut Vec<Defect>) {
    for (id, s) in body.surfaces() {
        for face in s.live_faces() {
            let [a, b, c] = s.corners(face);
            let (p, q) = (b - a, c - a);
            let double = p.cross(q).length();
            let scale = p.length() * q.length();
            // Coordinates far from the origin are rounded before they are subtracted, but that is exact input here.
            if (double > CLEAR_SINE * scale && scale > 0.0) || !collinear(a, b, c) {
                continue;
            }
            defects.push(Defect::DegenerateFace { surface: id, face, area: 0.5 * double });
        }
        for (e, &[a, b]) in s.edges.iter().enumerate().filter(|(_, ends)| ends[0] != NONE) {
            if s.edge_faces[e] == [NONE; 2] && s.positions[a as usize] == s.positions[b as usize] {
                defects.push(Defect::EdgeWithoutLength { surface: id, edge: EdgeId(e as u32) });
            }
        }
    }
}
