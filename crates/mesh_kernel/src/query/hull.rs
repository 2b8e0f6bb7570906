//! Convex hulls of planar points: what a tape measure lies along.

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};

/// Two unit vectors that make a right-handed frame with `normal`.
pub(super) fn plane_axes(normal: DVec3) -> (DVec3, DVec3) {
    let n = normal.normalize_or(DVec3::Z);
    let u = n.any_orthonormal_vector();
    (u, n.cross(u))
}

/// The corners of the convex hull of `points` seen along `normal`, anticlockwise about it. Corners are points of the
/// input; those on a side of the hull are left out, and so are points that are not finite. O(n log n), exact turns
/// (Andrew 1979).
pub fn convex_hull_in_plane(points: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let (u, v) = plane_axes(normal);
    let mut sorted: Vec<(DVec2, DVec3)> =
        points.iter().filter(|p| p.is_finite()).map(|p| (DVec2::new(p.dot(u), p.dot(v)), *p)).collect();
    sorted.sort_by(|a, b| a.0.x.total_cmp(&b.0.x).then(a.0.y.total_cmp(&b.0.y)));
    sorted.dedup_by(|a, b| a.0 == b.0);
    if sorted.len() < 3 {
        return sorted.into_iter().map(|p| p.1).collect();
    }
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    let mut hull: Vec<(DVec2, DVec3)> = Vec::with_capacity(64);
    let mut grow = |point: &(DVec2, DVec3), keep: usize| {
        while let [.., a, b] = hull[keep..] {
            if orient2d(coord(a.0), coord(b.0), coord(point.0)) > 0.0 {
                break;
            }
            hull.pop();
        }
        hull.push(*point);
        hull.len()
    };
    let mut lower = 0;
    for point in &sorted {
        lower = grow(point, 0);
    }
    for point in sorted.iter().rev().skip(1) {
        grow(point, lower - 1);
    }
    hull.pop();
    hull.into_iter().map(|p| p.1).collect()
}

/// Length of a tape laid tight around `points` in the plane across `normal`: the perimeter of their convex hull, in
/// the unit of the points; twice the distance for two points. O(n log n).
pub fn tape_length(points: &[DVec3], normal: DVec3) -> f64 {
    let n = normal.normalize_or(DVec3::Z);
    let hull = convex_hull_in_plane(points, normal);
    let side = |a: &DVec3, b: &DVec3| (*b - *a).reject_from_normalized(n).length();
    let around: f64 = hull.windows(2).map(|pair| side(&pair[0], &pair[1])).sum();
    match (hull.first(), hull.last()) {
        (Some(first), Some(last)) => around + side(last, first),
        _ => 0.0,
    }
}
