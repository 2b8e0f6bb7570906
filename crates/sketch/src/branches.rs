//! The order of curves about the point where they branch (Stroud & Nagy, fig. 6.19).

use std::cmp::Ordering;

use glam::DVec2;

use crate::SketchError;

/// How a curve leaves a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Branch {
    /// Unit tangent, away from the point.
    pub tangent: DVec2,
    /// Curvature there, in 1/mm; positive to the left of the tangent.
    pub curvature: f64,
}

/// Tangents that differ by less than this many radians are one.
const SAME: f64 = 1e-9;

/// Branches in anticlockwise order, the first one first: by tangent, and by curvature where tangents are the same, for the
/// one that turns more to the left comes later. O(n log n).
///
/// # Errors
/// [`SketchError::SameBranch`] where two have the same tangent and the same curvature.
pub fn order_of_branches(branches: &[Branch]) -> Result<Vec<usize>, SketchError> {
    let Some(base) = branches.first() else { return Ok(Vec::new()) };
    let turn = |b: &Branch| {
        let angle = base.tangent.perp_dot(b.tangent).atan2(base.tangent.dot(b.tangent));
        let angle = angle.rem_euclid(std::f64::consts::TAU);
        if angle > std::f64::consts::TAU - SAME { 0.0 } else { angle }
    };
    let compare = |a: usize, b: usize| {
        let (x, y) = (&branches[a], &branches[b]);
        let (s, t) = (turn(x), turn(y));
        if (s - t).abs() > SAME { s.total_cmp(&t) } else { x.curvature.total_cmp(&y.curvature) }
    };
    let mut order: Vec<usize> = (0..branches.len()).collect();
    order.sort_by(|&a, &b| compare(a, b));
    for pair in order.windows(2) {
        if compare(pair[0], pair[1]) == Ordering::Equal {
            return Err(SketchError::SameBranch(pair[0].min(pair[1]), pair[0].max(pair[1])));
        }
    }
    let first = order.iter().position(|i| *i == 0).unwrap_or(0);
    order.rotate_left(first);
    Ok(order)
}
