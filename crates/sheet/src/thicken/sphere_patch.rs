//! Sphere patches: the offset of a convex disk, as rings of triangles.

use glam::DVec3;

/// Boundary points a ring: triangles then are about as wide as high.
const POINTS_PER_RING: f64 = 6.0;
/// Inner points are never farther off the mean radius than this share of it.
const FARTHEST: f64 = 0.2;
/// Rounds of Newton's method for the radius.
const ROUNDS: usize = 8;

/// The triangles of a patch, and its inner points.
#[derive(Debug, Default)]
pub(super) struct SpherePatch {
    /// Inner points, seen from the node.
    pub(super) inner: Vec<DVec3>,
    /// Triangles, outward: numbers below the boundary's length are boundary points, the others inner points.
    pub(super) triangles: Vec<[u32; 3]>,
}

/// Fills a cycle of points, anticlockwise seen from outside, about a node so that the cone over it has a given volume.
///
/// `boundary` is seen from the node, `centre` a direction from which all of it is visible. O(n²) in its points.
pub(super) fn sphere_patch(boundary: &[DVec3], centre: DVec3, volume: f64) -> SpherePatch {
    let count = boundary.len();
    let rings = ((count as f64 / POINTS_PER_RING).round() as usize).max(1);
    let mut patch = SpherePatch::default();
    let mut outer: Vec<u32> = (0..count as u32).collect();
    for ring in 1..=rings {
        let share = ring as f64 / rings as f64;
        let points = if ring == rings { 1 } else { ((count as f64 * (1.0 - share)).round() as usize).max(3) };
        let first = (count + patch.inner.len()) as u32;
        let inner: Vec<u32> = (first..first + points as u32).collect();
        patch.inner.extend(
            (0..points).map(|j| towards(at_share(boundary, j as f64 / points as f64), centre, share)),
        );
        join_rings(&outer, &inner, &mut patch.triangles);
        outer = inner;
    }
    let radius = radius_for(boundary, &patch, volume);
    patch.inner.iter_mut().for_each(|p| *p *= radius);
    patch
}

/// The solid angle of a spherical polygon seen from `centre`, in steradians; `None` where its sides do not go round the
/// centre anticlockwise. Corners need not be unit vectors.
pub(super) fn solid_angle(corners: &[DVec3], centre: DVec3) -> Option<f64> {
    let mut sum = 0.0;
    for (i, a) in corners.iter().enumerate() {
        let (a, b) = (a.normalize_or_zero(), corners[(i + 1) % corners.len()].normalize_or_zero());
        let volume = centre.dot(a.cross(b));
        if volume <= 0.0 || centre.dot(a) <= 0.0 {
            return None;
        }
        sum += 2.0 * volume.atan2(1.0 + a.dot(b) + b.dot(centre) + centre.dot(a));
    }
    Some(sum)
}

fn at_share(boundary: &[DVec3], share: f64) -> DVec3 {
    let at = share * boundary.len() as f64;
    let i = (at as usize).min(boundary.len() - 1);
    boundary[i].lerp(boundary[(i + 1) % boundary.len()], at - i as f64).normalize_or_zero()
}

/// The direction at `share` of the way from one direction to another on the sphere.
fn towards(from: DVec3, to: DVec3, share: f64) -> DVec3 {
    let angle = from.angle_between(to);
    if angle < 1e-9 {
        return to;
    }
    (((1.0 - share) * angle).sin() * from + (share * angle).sin() * to).normalize_or_zero()
}

/// Triangles between two rings, side by side in step with their shares of the way round.
fn join_rings(outer: &[u32], inner: &[u32], triangles: &mut Vec<[u32; 3]>) {
    let (n, m) = (outer.len(), inner.len());
    let (mut i, mut j) = (0, 0);
    while i < n || (j < m && m > 1) {
        if m == 1 || j == m || (i < n && (2 * i + 1) * m <= (2 * j + 1) * n) {
            triangles.push([outer[i % n], outer[(i + 1) % n], inner[j % m]]);
            i += 1;
        } else {
            triangles.push([outer[i % n], inner[(j + 1) % m], inner[j % m]]);
            j += 1;
        }
    }
}

/// The radius of the inner points, given as directions, for which the cone over the patch has the wanted volume: a cubic
/// equation.
fn radius_for(boundary: &[DVec3], patch: &SpherePatch, volume: f64) -> f64 {
    let count = boundary.len();
    let mean = boundary.iter().map(|p| p.length()).sum::<f64>() / count as f64;
    let mut cubic = [0.0; 4];
    for triangle in &patch.triangles {
        let [a, b, c] = triangle.map(|i| {
            let i = i as usize;
            if i < count { boundary[i] } else { patch.inner[i - count] }
        });
        let inner = triangle.iter().filter(|&&i| i as usize >= count).count();
        cubic[inner] += a.dot(b.cross(c)) / 6.0;
    }
    let mut radius = mean;
    for _ in 0..ROUNDS {
        let value = ((cubic[3] * radius + cubic[2]) * radius + cubic[1]) * radius + cubic[0] - volume;
        let slope = (3.0 * cubic[3] * radius + 2.0 * cubic[2]) * radius + cubic[1];
        radius -= value / slope;
    }
    if (radius - mean).abs() <= FARTHEST * mean { radius } else { mean }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::thicken::arcs::{ArcRule, push_arc};

    #[test]
    fn an_octant_keeps_its_volume() {
        let radius = 2.0;
        let ends = [DVec3::X, DVec3::Y, DVec3::Z].map(|e| e * radius);
        let centre = DVec3::ONE.normalize();
        for chord in [None, Some(0.05), Some(0.002)] {
            let mut boundary = Vec::new();
            for i in 0..3 {
                boundary.push(ends[i]);
                push_arc(ArcRule { chord }, ends[i], ends[(i + 1) % 3], centre, &mut boundary);
            }
            let angle = solid_angle(&ends, centre).unwrap();
            assert!((angle - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
            let wanted = angle * radius.powi(3) / 3.0;
            let patch = sphere_patch(&boundary, centre, wanted);
            let point = |i: u32| *boundary.iter().chain(&patch.inner).nth(i as usize).unwrap();
            let mut volume = 0.0;
            for triangle in &patch.triangles {
                let [a, b, c] = triangle.map(point);
                let six = a.dot(b.cross(c));
                assert!(six > 0.0);
                volume += six / 6.0;
                let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
                assert!((b - a).cross(c - a).length() > 0.3 * longest * longest, "{a} {b} {c}");
            }
            assert!((volume / wanted - 1.0).abs() < 1e-12);
            assert!(patch.inner.iter().all(|p| (p.length() / radius - 1.0).abs() < 0.06));
        }
    }

    #[test]
    fn polygons_that_do_not_go_round_have_no_angle() {
        let corners = [DVec3::X, DVec3::Z, DVec3::Y];
        assert_eq!(solid_angle(&corners, DVec3::ONE.normalize()), None);
    }
}
