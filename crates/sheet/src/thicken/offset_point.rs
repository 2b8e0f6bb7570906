//! The point in which the offset planes of some faces about a node meet, as nearly as they do.

use glam::{DMat3, DVec3};

/// A face about a node: its offset plane is `normal · x = depth`, `x` seen from the node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// Unit normal.
    pub(super) normal: DVec3,
    /// How far the plane is offset, in millimetres.
    pub(super) depth: f64,
    /// The face's angle at the node, in radians.
    pub(super) weight: f64,
}

/// Where offset planes meet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    /// The point, seen from the node.
    pub(super) x: DVec3,
    /// Farthest distance of a plane from it, in millimetres.
    pub(super) residual: f64,
}

/// Normals within this of each other (chord) are one normal: a face's own rounding.
const SAME_NORMAL: f64 = 1e-9;
/// Three normals span space well enough to be solved for exactly when their determinant is above this.
const INDEPENDENT: f64 = 1e-3;
/// Weight that holds the point near the mean normal where the planes leave it free, as a share of the planes' own.
const HOLD: f64 = 1e-6;
/// Rounds of refinement, each of which divides what [`HOLD`] spoils by its inverse.
const ROUNDS: usize = 4;
/// Most distinct normals that are looked for one by one.
const FEW: usize = 4;

/// The point that is nearest to all planes by weighted least squares; among several, the nearest to the node.
///
/// One, two or three independent planes are met exactly, and axis-parallel ones to the last bit. O(k).
pub(super) fn meeting(planes: &[Plane]) -> Meeting {
    let mut distinct = [planes[0]; FEW];
    let mut count = 1;
    for plane in &planes[1..] {
        let known = distinct[..count].iter().any(|d| {
            d.normal.distance_squared(plane.normal) < SAME_NORMAL * SAME_NORMAL && d.depth == plane.depth
        });
        if !known {
            if count == FEW {
                count = usize::MAX;
                break;
            }
            distinct[count] = *plane;
            count += 1;
        }
    }
    let exact = match count {
        1 => Some(distinct[0].depth * distinct[0].normal),
        2 => of_two(distinct[0], distinct[1]),
        3 => of_three(distinct[0], distinct[1], distinct[2]),
        _ => None,
    };
    let x = exact.unwrap_or_else(|| least_squares(planes));
    let residual = planes.iter().map(|p| (p.normal.dot(x) - p.depth).abs()).fold(0.0, f64::max);
    Meeting { x, residual }
}

/// The point nearest to the node on the line in which two planes meet.
fn of_two(p: Plane, q: Plane) -> Option<DVec3> {
    let cosine = p.normal.dot(q.normal);
    if p.depth == q.depth {
        return (cosine > -1.0 + INDEPENDENT).then(|| p.depth / (1.0 + cosine) * (p.normal + q.normal));
    }
    let sine_squared = p.normal.cross(q.normal).length_squared();
    (sine_squared > INDEPENDENT).then(|| {
        ((p.depth - cosine * q.depth) * p.normal + (q.depth - cosine * p.depth) * q.normal) / sine_squared
    })
}

fn of_three(p: Plane, q: Plane, r: Plane) -> Option<DVec3> {
    let determinant = p.normal.dot(q.normal.cross(r.normal));
    (determinant.abs() > INDEPENDENT).then(|| {
        (p.depth * q.normal.cross(r.normal)
            + q.depth * r.normal.cross(p.normal)
            + r.depth * p.normal.cross(q.normal))
            / determinant
    })
}

/// Least squares, held near `mean depth · mean normal` where the planes say nothing.
fn least_squares(planes: &[Plane]) -> DVec3 {
    let (mut matrix, mut right) = (DMat3::ZERO, DVec3::ZERO);
    let (mut mean, mut depth, mut weight) = (DVec3::ZERO, 0.0, 0.0);
    for p in planes {
        let n = p.normal;
        matrix += DMat3::from_cols(n * n.x, n * n.y, n * n.z) * p.weight;
        right += p.weight * p.depth * n;
        mean += p.weight * n;
        depth += p.weight * p.depth;
        weight += p.weight;
    }
    let mut x = depth / weight * mean.normalize_or_zero();
    let inverse = (matrix + DMat3::from_diagonal(DVec3::splat(HOLD * weight))).inverse();
    for _ in 0..ROUNDS {
        x += inverse * (right - matrix * x);
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(normal: DVec3, depth: f64, weight: f64) -> Plane {
        Plane { normal, depth, weight }
    }

    #[test]
    fn axis_parallel_planes_are_met_to_the_last_bit() {
        let d = 0.1;
        let flat = meeting(&[plane(DVec3::Z, d, 0.3), plane(DVec3::Z, d, 1.7)]);
        assert_eq!((flat.x, flat.residual), (DVec3::Z * d, 0.0));
        let fold = meeting(&[plane(DVec3::Z, d, 0.3), plane(DVec3::X, d, 1.7), plane(DVec3::Z, d, 1.0)]);
        assert_eq!((fold.x, fold.residual), (DVec3::new(d, 0.0, d), 0.0));
        let corner =
            meeting(&[plane(DVec3::Z, d, 0.3), plane(DVec3::X, 0.7, 1.7), plane(DVec3::NEG_Y, d, 1.0)]);
        assert_eq!((corner.x, corner.residual), (DVec3::new(0.7, -d, d), 0.0));
    }

    #[test]
    fn many_planes_through_one_point_are_met_exactly() {
        let apex = DVec3::new(0.2, -0.4, 1.3);
        let planes: Vec<Plane> = (0..7)
            .map(|i| {
                let (s, c) = (f64::from(i) * 0.9).sin_cos();
                let normal = DVec3::new(0.1 * c, 0.1 * s, 1.0).normalize();
                plane(normal, normal.dot(apex), 1.0 + 0.1 * f64::from(i))
            })
            .collect();
        let found = meeting(&planes);
        assert!(found.residual < 1e-12 && found.x.distance(apex) < 1e-9, "{found:?}");
    }

    #[test]
    fn nearly_parallel_planes_do_not_throw_the_point_far() {
        let tilted = |t: f64, s: f64| DVec3::new(t, s, 1.0).normalize();
        let planes = [
            plane(DVec3::Z, 1.0, 1.0),
            plane(tilted(1e-7, 0.0), 1.0, 1.0),
            plane(tilted(0.0, 3e-7), 1.0, 1.0),
            plane(tilted(-1e-7, -2e-7), 1.0, 1.0),
            plane(tilted(4e-7, -2e-7), 1.0, 1.0),
        ];
        let found = meeting(&planes);
        assert!(found.x.distance(DVec3::Z) < 1e-5 && found.residual < 1e-10, "{found:?}");
    }
}
