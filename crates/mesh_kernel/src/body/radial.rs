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

/// Greater than zero where turning from `p` to `q` about the axis from `a` to `b`, as the right hand's fingers turn,
/// takes less than half a turn; zero where all four points are coplanar. Exact.
pub(crate) fn turn(a: DVec3, b: DVec3, p: DVec3, q: DVec3) -> f64 {
    -orient3d(coord(a), coord(b), coord(p), coord(q))
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
    (0..3).all(|axis| orient2d(drop_axis(a, axis), drop_axis(b, axis), drop_axis(p, axis)) == 0.0)
}

/// For coplanar points: whether `p` and `q` lie on the same side of the line through `a` and `b`. Exact.
fn same_side(a: DVec3, b: DVec3, p: DVec3, q: DVec3) -> bool {
    for axis in 0..3 {
        let [a, b, p, q] = [a, b, p, q].map(|x| drop_axis(x, axis));
        let of_p = orient2d(a, b, p);
        if of_p != 0.0 {
            return orient2d(a, b, q) * of_p.signum() > 0.0;
        }
    }
    false
}

/// Where `q` lies seen from `p`, turning by the right hand about `a` → `b`: 0 at `p` itself, 1 within the first half
/// turn, 2 opposite, 3 within the second half, 4 nowhere (on the axis).
fn quarter(a: DVec3, b: DVec3, p: DVec3, q: DVec3) -> u8 {
    if collinear(a, b, q) {
        return 4;
    }
    match turn(a, b, p, q) {
        t if t > 0.0 => 1,
        t if t < 0.0 => 3,
        _ if same_side(a, b, p, q) => 0,
        _ => 2,
    }
}

/// Order of the sheets about the axis `a` → `b`, `apexes` being the third corners of their triangles: clockwise for
/// one who looks along the axis, starting with the first sheet that is not degenerate.
///
/// Ties (sheets that leave in exactly the same direction) and degenerate sheets keep the order of `apexes`; degenerate
/// sheets come last. `None` where `a` and `b` coincide or every sheet is degenerate. O(k log k) exact predicates.
pub(crate) fn radial_order(a: DVec3, b: DVec3, apexes: &[DVec3]) -> Option<Radial> {
    let &first = apexes.iter().find(|&&p| !collinear(a, b, p))?;
    let mut order: Vec<(u8, usize)> =
        apexes.iter().enumerate().map(|(i, &q)| (quarter(a, b, first, q), i)).collect();
    let compare = |x: &(u8, usize), y: &(u8, usize)| {
        x.0.cmp(&y.0).then_with(|| match x.0 {
            1 | 3 => match turn(a, b, apexes[x.1], apexes[y.1]) {
                t if t > 0.0 => Ordering::Less,
                t if t < 0.0 => Ordering::Greater,
                _ => Ordering::Equal,
            },
            _ => Ordering::Equal,
        })
    };
    order.sort_by(compare);
    let tied = order.windows(2).any(|w| compare(&w[0], &w[1]) == Ordering::Equal);
    Some(Radial { order: order.into_iter().map(|(_, i)| i as u32).collect(), tied })
}

/// Sheets in their order about an axis.
pub(crate) struct Radial {
    /// Indices of the sheets.
    pub(crate) order: Vec<u32>,
    /// Whether two sheets leave in the same direction, or one is degenerate, so that geometry alone does not order them.
    pub(crate) tied: bool,
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
        assert!(!radial.tied);
        let radial = radial_order(DVec3::Z, DVec3::ZERO, &apexes).unwrap();
        assert_eq!(radial.order, [0, 1, 2, 3]);
    }

    #[test]
    fn sheets_one_ulp_apart_are_told_apart() {
        let ulp = f64::EPSILON;
        let near = [DVec3::new(1.0, 0.0, 0.5), DVec3::new(1.0, ulp, 0.3), DVec3::new(1.0, -ulp, 0.7)];
        let radial = radial_order(DVec3::ZERO, DVec3::Z, &near).unwrap();
        assert_eq!(radial.order, [0, 1, 2]);
        assert!(!radial.tied);
    }

    #[test]
    fn ties_keep_their_order_and_degenerate_sheets_come_last() {
        let apexes = [DVec3::Z * 3.0, DVec3::Y, DVec3::X, DVec3::Y * 2.0];
        let radial = radial_order(DVec3::ZERO, DVec3::Z, &apexes).unwrap();
        assert_eq!(radial.order, [1, 3, 2, 0]);
        assert!(radial.tied);
        assert!(radial_order(DVec3::ZERO, DVec3::Z, &[DVec3::Z]).is_none());
    }
}
