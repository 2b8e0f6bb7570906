//! The order of sheets about an edge, by exact predicates.
//!
//! Only signs of determinants decide ([`robust`]), never an angle, so that sheets which are nearly coplanar are told
//! apart as long as their coordinates differ at all.

use std::cmp::Ordering;

use glam::DVec3;
use robust::{Coord, Coord3D, orient2d, orient3d};

fn coord(p: DVec3) -> Coord3D<f64> {
    Coord3D { x: p.x, y: p.y, z: p.z }
}

/// Coordinates between these (largest of all) keep products of three, with all their digits, clear of what a double holds.
const SMALL: f64 = 1e-50;
const LARGE: f64 = 1e50;

/// The points times a power of two, which changes no digit, so that predicates neither overflow nor underflow.
fn scaled<const N: usize>(points: [DVec3; N]) -> [DVec3; N] {
    let largest = points.iter().fold(0.0f64, |m, p| m.max(p.abs().max_element()));
    if (SMALL..=LARGE).contains(&largest) || largest == 0.0 || !largest.is_finite() {
        return points;
    }
    // In two steps, for no double holds the inverse of the smallest.
    let half = (-0.5 * largest.log2()).round().exp2();
    points.map(|p| p * half * half)
}

/// Greater than zero where turning from `p` to `q` about the axis from `a` to `b`, as the right hand's fingers turn,
/// takes less than half a turn; zero where all four points are coplanar. Exact.
pub(crate) fn turn(a: DVec3, b: DVec3, p: DVec3, q: DVec3) -> f64 {
    let [a, b, p, q] = scaled([a, b, p, q]).map(coord);
    -orient3d(a, b, p, q)
}

fn drop_axis(p: DVec3, axis: usize) -> Coord<f64> {
    match axis {
        0 => Coord { x: p.y, y: p.z },
        1 => Coord { x: p.z, y: p.x },
        _ => Coord { x: p.x, y: p.y },
    }
}

/// Whether `a`, `b`, `p` lie on one line. Exact.
pub(crate) fn collinear(a: DVec3, b: DVec3, p: DVec3) -> bool {
    let [a, b, p] = scaled([a, b, p]);
    (0..3).all(|axis| orient2d(drop_axis(a, axis), drop_axis(b, axis), drop_axis(p, axis)) == 0.0)
}

/// For coplanar points: whether `p` and `q` lie on the same side of the line through `a` and `b`. Exact.
fn same_side(a: DVec3, b: DVec3, p: DVec3, q: DVec3) -> bool {
    let [a, b, p, q] = scaled([a, b, p, q]);
    for axis in 0..3 {
        let [a, b, p, q] = [a, b, p, q].map(|x| drop_axis(x, axis));
        let of_p = orient2d(a, b, p);
        if of_p != 0.0 {
            return orient2d(a, b, q) * of_p.signum() > 0.0;
        }
    }
    false
}

/// Where a sheet lies seen from another, turning by the right hand about an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Quarter {
    /// In the very same direction.
    Same,
    /// Within the first half turn.
    First,
    /// Exactly opposite.
    Opposite,
    /// Within the second half turn.
    Second,
    /// On the axis: degenerate.
    Nowhere,
}

/// Where `q` lies seen from `p`, which is not on the axis, turning about `a` → `b`. Exact.
pub(crate) fn quarter(a: DVec3, b: DVec3, p: DVec3, q: DVec3) -> Quarter {
    if collinear(a, b, q) {
        return Quarter::Nowhere;
    }
    match turn(a, b, p, q) {
        t if t > 0.0 => Quarter::First,
        t if t < 0.0 => Quarter::Second,
        _ if same_side(a, b, p, q) => Quarter::Same,
        _ => Quarter::Opposite,
    }
}

/// Places of the sheets about the axis `a` → `b`, `apexes` being the third corners of their triangles: clockwise for
/// one who looks along the axis, starting with the first sheet that is not degenerate.
///
/// `None` where `a` and `b` coincide or every sheet is degenerate. O(k log k) exact predicates.
pub(crate) fn radial_order(a: DVec3, b: DVec3, apexes: &[DVec3]) -> Option<Radial> {
    let &first = apexes.iter().find(|&&p| !collinear(a, b, p))?;
    let mut order: Vec<(Quarter, usize)> =
        apexes.iter().enumerate().map(|(i, &q)| (quarter(a, b, first, q), i)).collect();
    let compare = |x: &(Quarter, usize), y: &(Quarter, usize)| {
        x.0.cmp(&y.0).then_with(|| match x.0 {
            Quarter::First | Quarter::Second => match turn(a, b, apexes[x.1], apexes[y.1]) {
                t if t > 0.0 => Ordering::Less,
                t if t < 0.0 => Ordering::Greater,
                _ => Ordering::Equal,
            },
            _ => Ordering::Equal,
        })
    };
    order.sort_by(compare);
    let mut ranks = vec![None; apexes.len()];
    let mut rank = 0;
    for (k, x) in order.iter().enumerate() {
        if k > 0 && compare(&order[k - 1], x) != Ordering::Equal {
            rank += 1;
        }
        ranks[x.1] = (x.0 != Quarter::Nowhere).then_some(rank);
    }
    Some(Radial { order: order.into_iter().map(|(_, i)| i as u32).collect(), ranks })
}

/// The sheets about the axis `a` → `b` as the right hand turns, `apexes` being the third corners of their triangles;
/// `None` where one of them, or the axis, is degenerate. Sheets that leave in the same direction keep their order.
///
/// Exact: only signs of determinants decide. O(k log k).
///
/// ```
/// use mesh_kernel::body::order_about_edge;
/// use mesh_kernel::glam::DVec3;
///
/// let apexes = [DVec3::X, DVec3::NEG_Y, DVec3::NEG_X, DVec3::Y];
/// assert_eq!(order_about_edge(DVec3::ZERO, DVec3::Z, &apexes).unwrap(), [0, 3, 2, 1]);
/// ```
pub fn order_about_edge(a: DVec3, b: DVec3, apexes: &[DVec3]) -> Option<Vec<u32>> {
    let radial = radial_order(a, b, apexes)?;
    radial.ranks.iter().all(Option::is_some).then_some(radial.order)
}

/// Sheets in their order about an axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Radial {
    /// Indices of the sheets. Sheets that leave in exactly the same direction keep the order in which they were given;
    /// degenerate ones come last.
    pub(crate) order: Vec<u32>,
    /// Place of every sheet, equal for those that leave in the same direction; `None` for degenerate ones.
    pub(crate) ranks: Vec<Option<u32>>,
}

impl Radial {
    /// Whether a cyclic order of sheets, given by their indices, goes round the axis once, clockwise. Degenerate sheets
    /// may stand anywhere.
    pub(crate) fn agrees(&self, order: &[u32]) -> bool {
        let ranks: Vec<u32> =
            order.iter().filter_map(|&i| self.ranks.get(i as usize).copied().flatten()).collect();
        let next = ranks.iter().cycle().skip(1);
        ranks.iter().zip(next).filter(|(a, b)| a > b).count() <= 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_right_hand_turns_from_x_to_y_about_z() {
        assert!(turn(DVec3::ZERO, DVec3::Z, DVec3::X, DVec3::Y) > 0.0);
        let apexes = [DVec3::X, DVec3::NEG_Y, DVec3::NEG_X, DVec3::Y];
        let radial = radial_order(DVec3::ZERO, DVec3::Z, &apexes).unwrap();
        assert_eq!(radial.order, [0, 3, 2, 1]);
        assert_eq!(radial.ranks, [Some(0), Some(3), Some(2), Some(1)]);
        let radial = radial_order(DVec3::Z, DVec3::ZERO, &apexes).unwrap();
        assert_eq!(radial.order, [0, 1, 2, 3]);
    }

    #[test]
    fn sheets_one_ulp_apart_are_told_apart() {
        let ulp = f64::EPSILON;
        let near = [DVec3::new(1.0, 0.0, 0.5), DVec3::new(1.0, ulp, 0.3), DVec3::new(1.0, -ulp, 0.7)];
        let radial = radial_order(DVec3::ZERO, DVec3::Z, &near).unwrap();
        assert_eq!(radial.order, [0, 1, 2]);
        assert_eq!(radial.ranks, [Some(0), Some(1), Some(2)]);
    }

    #[test]
    fn ties_keep_their_order_and_degenerate_sheets_come_last() {
        let apexes = [DVec3::Z * 3.0, DVec3::Y, DVec3::X, DVec3::Y * 2.0];
        let radial = radial_order(DVec3::ZERO, DVec3::Z, &apexes).unwrap();
        assert_eq!(radial.order, [1, 3, 2, 0]);
        assert_eq!(radial.ranks, [None, Some(0), Some(1), Some(0)]);
        assert!(radial.agrees(&[2, 0, 3, 1]) && radial.agrees(&[1, 2, 3]) && radial.agrees(&[2, 3, 1, 0]));
        assert!(radial_order(DVec3::ZERO, DVec3::Z, &[DVec3::Z]).is_none());
        let apexes = [DVec3::X, DVec3::Y, DVec3::NEG_X];
        let radial = radial_order(DVec3::ZERO, DVec3::Z, &apexes).unwrap();
        assert!(radial.agrees(&[1, 2, 0]) && !radial.agrees(&[2, 1, 0]));
    }
}
