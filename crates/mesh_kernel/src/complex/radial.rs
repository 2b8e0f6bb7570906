//! The order of faces about an edge, by exact predicates.

use std::cmp::Ordering;

use glam::DVec3;
use robust::{Coord, Coord3D, orient2d, orient3d};

fn coord(p: DVec3) -> Coord3D<f64> {
    Coord3D { x: p.x, y: p.y, z: p.z }
}

/// Drops a coordinate so that the other two keep their cyclic order. Exact.
pub(super) fn drop_axis(p: DVec3, axis: usize) -> Coord<f64> {
    match axis {
        0 => Coord { x: p.y, y: p.z },
        1 => Coord { x: p.z, y: p.x },
        _ => Coord { x: p.x, y: p.y },
    }
}

/// Greater than zero where turning from `p` to `q` about the axis from `a` to `b` by the right hand takes less than half a turn;
/// zero where all four are coplanar.
fn turn(a: DVec3, b: DVec3, p: DVec3, q: DVec3) -> f64 {
    -orient3d(coord(a), coord(b), coord(p), coord(q))
}

/// Whether three points lie on one line.
pub(super) fn collinear(a: DVec3, b: DVec3, p: DVec3) -> bool {
    (0..3).all(|axis| orient2d(drop_axis(a, axis), drop_axis(b, axis), drop_axis(p, axis)) == 0.0)
}

/// For coplanar points: whether `p` and `q` lie on one side of the line through `a` and `b`.
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

/// Where `q` lies seen from `p`: 0 at `p` itself, 1 within the first half turn, 2 opposite, 3 within the second.
fn quarter(a: DVec3, b: DVec3, p: DVec3, q: DVec3) -> u8 {
    match turn(a, b, p, q) {
        t if t > 0.0 => 1,
        t if t < 0.0 => 3,
        _ if same_side(a, b, p, q) => 0,
        _ => 2,
    }
}

/// Indices of the apexes, clockwise for one who looks from `a` to `b`, starting at the first.
///
/// # Errors
/// Indices of those that leave in one direction or lie on the axis. O(k log k) exact predicates.
pub(super) fn radial_order(a: DVec3, b: DVec3, apexes: &[DVec3]) -> Result<Vec<usize>, Vec<usize>> {
    let on_axis: Vec<usize> = (0..apexes.len()).filter(|&i| collinear(a, b, apexes[i])).collect();
    if !on_axis.is_empty() {
        return Err(on_axis);
    }
    let Some(&first) = apexes.first() else { return Ok(Vec::new()) };
    let mut order: Vec<(u8, usize)> =
        apexes.iter().enumerate().map(|(i, &q)| (quarter(a, b, first, q), i)).collect();
    let compare = |x: &(u8, usize), y: &(u8, usize)| {
        x.0.cmp(&y.0).then_with(|| match x.0 {
            1 | 3 => turn(a, b, apexes[y.1], apexes[x.1]).partial_cmp(&0.0).unwrap_or(Ordering::Equal),
            _ => Ordering::Equal,
        })
    };
    order.sort_by(compare);
    let tie = order.windows(2).find(|w| compare(&w[0], &w[1]) == Ordering::Equal);
    match tie {
        Some(w) => Err(vec![w[0].1, w[1].1]),
        None => Ok(order.into_iter().map(|(_, i)| i).collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seven_spokes_come_clockwise() {
        let (a, b) = (DVec3::ZERO, DVec3::Z);
        let at = |k: usize| {
            let t = k as f64 * std::f64::consts::TAU / 7.0;
            DVec3::new(t.cos(), t.sin(), 0.3)
        };
        // For one who looks along +z, from x to y is clockwise.
        let shuffled = [3, 0, 6, 1, 5, 2, 4];
        let order = radial_order(a, b, &shuffled.map(at)).unwrap();
        assert_eq!(order.iter().map(|&i| shuffled[i]).collect::<Vec<_>>(), [3, 4, 5, 6, 0, 1, 2]);
        assert_eq!(radial_order(a, b, &[at(0), at(1), at(0) * 2.0]), Err(vec![0, 2]));
        assert_eq!(radial_order(a, b, &[at(0), DVec3::Z * 3.0]), Err(vec![1]));
    }
}
