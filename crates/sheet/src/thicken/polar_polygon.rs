//! Where a mixed disk shows a sphere: the directions from which its node is the nearest point of its faces.
//!
//! They are the polar cone of the disk's edges, a convex spherical polygon or nothing. Its sides lie on arcs of convex
//! wedges, its corners where two such arcs cross.

use glam::DVec3;

/// How far a direction may be beyond a side of the polygon, as a sine.
const BEYOND: f64 = 1e-9;
/// Corners nearer than this are one.
const SAME_CORNER: f64 = 1e-7;
/// Disks with more edges than this show no sphere: they are cones of a mesh too fine for it to matter.
const MOST_EDGES: usize = 64;

/// A side of the polygon.
#[derive(Clone, Copy, Debug)]
pub(super) struct PolarSide {
    /// The edge that it is perpendicular to.
    pub(super) edge: usize,
    /// Unit direction of its first corner; the last is the first of the next side.
    pub(super) from: DVec3,
}

/// The sides of `{u : u · e ≤ 0 for all edges e}`, anticlockwise seen from outside, where they all lie on edges that are
/// `convex`; empty where there is no such polygon with an area. `edges` are unit vectors. O(k³).
pub(super) fn polar_polygon(edges: &[DVec3], convex: &[bool]) -> Vec<PolarSide> {
    if edges.len() > MOST_EDGES {
        return Vec::new();
    }
    let mut corners: Vec<DVec3> = Vec::new();
    let ridges: Vec<usize> = (0..edges.len()).filter(|&i| convex[i]).collect();
    for (k, &i) in ridges.iter().enumerate() {
        for &j in &ridges[k + 1..] {
            let across = edges[i].cross(edges[j]);
            if across.length() < SAME_CORNER {
                continue;
            }
            for corner in [across.normalize(), -across.normalize()] {
                if edges.iter().all(|e| e.dot(corner) <= BEYOND)
                    && corners.iter().all(|c| c.distance(corner) > SAME_CORNER)
                {
                    corners.push(corner);
                }
            }
        }
    }
    if corners.len() < 3 {
        return Vec::new();
    }
    let centre = corners.iter().sum::<DVec3>().normalize_or_zero();
    let (right, up) = centre.any_orthonormal_pair();
    let angle = |c: &DVec3| c.dot(up).atan2(c.dot(right));
    corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    let mut sides = Vec::with_capacity(corners.len());
    for (i, &from) in corners.iter().enumerate() {
        let to = corners[(i + 1) % corners.len()];
        let on = |e: usize| edges[e].dot(from).abs() <= SAME_CORNER && edges[e].dot(to).abs() <= SAME_CORNER;
        match ridges.iter().find(|&&e| on(e)) {
            Some(&edge) => sides.push(PolarSide { edge, from }),
            None => return Vec::new(),
        }
    }
    sides
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_shaped_apex_shows_the_polar_of_its_ridges() {
        let spoke = |i: usize, out: f64| {
            let (s, c) = (i as f64 * std::f64::consts::PI / 5.0).sin_cos();
            DVec3::new(out * c, out * s, -1.0).normalize()
        };
        let edges: Vec<DVec3> = (0..10).map(|i| spoke(i, if i % 2 == 0 { 1.0 } else { 0.4 })).collect();
        let convex: Vec<bool> = (0..10).map(|i| i % 2 == 0).collect();
        let sides = polar_polygon(&edges, &convex);
        assert_eq!(sides.len(), 5);
        for (i, side) in sides.iter().enumerate() {
            let to = sides[(i + 1) % 5].from;
            assert!(side.from.cross(to).z > 0.0);
            assert!(edges[side.edge].dot(side.from).abs() < 1e-12 && edges[side.edge].dot(to).abs() < 1e-12);
        }
    }

    #[test]
    fn a_saddle_shows_nothing() {
        let edges =
            [DVec3::new(1.0, 0.0, 0.2), DVec3::new(0.0, 1.0, -0.2), DVec3::new(-1.0, 0.0, 0.2), DVec3::NEG_Y];
        assert!(polar_polygon(&edges.map(DVec3::normalize), &[true; 4]).is_empty());
    }
}
