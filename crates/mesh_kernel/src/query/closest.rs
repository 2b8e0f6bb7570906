//! The point of a mesh that is closest to a given point.

use glam::DVec3;

use super::bvh::{Bvh, Child, STACK};
use crate::TriMesh;

/// The closest point of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// The point.
    pub point: DVec3,
    /// The face that holds it; of several, always the same one.
    pub face: u32,
    /// Its barycentric coordinates there; exactly 0 off the corners it lies between.
    pub barycentric: [f64; 3],
    /// How far away it is.
    pub distance: f64,
}

/// A mesh prepared for closest-point queries.
///
/// Boxes of the hierarchy are skipped by an f32 bound that is lowered by its own rounding error; distances to faces are
/// computed in f64. Faces with corners that are not finite are left out.
#[derive(Clone, Debug)]
pub struct ClosestPoint {
    bvh: Bvh,
    /// Faces in the order of the hierarchy's leaves.
    triangles: Vec<Triangle>,
}

/// A face with what its distance needs again and again.
#[derive(Clone, Debug)]
struct Triangle {
    a: DVec3,
    ab: DVec3,
    ac: DVec3,
    ab_ab: f64,
    ab_ac: f64,
    ac_ac: f64,
    /// Sine of the angle at `a` below 1e-4: projecting into the face is ill-conditioned.
    thin: bool,
}

impl ClosestPoint {
    /// Builds the hierarchy. O(n log n).
    pub fn new(mesh: &TriMesh) -> Self {
        let bvh = Bvh::new(mesh);
        let triangles = bvh.order.iter().map(|f| Triangle::new(mesh.corners(*f))).collect();
        Self { bvh, triangles }
    }

    /// The closest point; `None` without faces or when `p` is not finite. O(log n) near the mesh.
    pub fn closest(&self, p: DVec3) -> Option<Closest> {
        self.closest_within(p, f64::INFINITY)
    }

    /// The closest point at a distance of `max` at most. The smaller `max`, the faster.
    pub fn closest_within(&self, p: DVec3, max: f64) -> Option<Closest> {
        let (slot, barycentric, point) = self.find(p, max)?;
        let distance = point.distance(p);
        (distance <= max).then(|| Closest { point, face: self.bvh.order[slot], barycentric, distance })
    }

    fn find(&self, p: DVec3, max: f64) -> Option<(usize, [f64; 3], DVec3)> {
        let local = p - self.bvh.origin;
        if !local.is_finite() || max.is_nan() || max < 0.0 || self.triangles.is_empty() {
            return None;
        }
        let at = local.as_vec3();
        // Rounding of the point and of the differences, absolute.
        let slack = (local.abs().max_element() + self.bvh.extent) * f64::from(f32::EPSILON) * 2.0;
        let reach = |d2: f64| (((d2.sqrt() + slack) * 1.000_001).powi(2) as f32).next_up();
        // A little above max², whose root may be max after rounding.
        let mut best_d2 = if max < 1e150 { (max * max * (1.0 + 1e-15)).next_up() } else { f64::INFINITY };
        let mut best = None;
        let mut limit = reach(best_d2);
        let mut stack = [(0f32, Child::ROOT); STACK];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (bound, mut child) = stack[height];
            if bound > limit {
                continue;
            }
            loop {
                match child.get() {
                    Err(node) => {
                        let node = &self.bvh.nodes[node];
                        let mut bounds = [0f32; 4];
                        for (axis, at) in at.to_array().into_iter().enumerate() {
                            for (bound, (lo, hi)) in
                                bounds.iter_mut().zip(node.lo[axis].iter().zip(&node.hi[axis]))
                            {
                                let d = (lo - at).max(at - hi).max(0.0);
                                *bound += d * d;
                            }
                        }
                        // The nearest child is next; the others wait, the nearest of them on top.
                        let first = height;
                        for (bound, child) in bounds.into_iter().zip(node.children) {
                            if bound <= limit {
                                let mut slot = height;
                                while slot > first && stack[slot - 1].0 < bound {
                                    stack[slot] = stack[slot - 1];
                                    slot -= 1;
                                }
                                stack[slot] = (bound, child);
                                height += 1;
                            }
                        }
                        if height == first {
                            break;
                        }
                        height -= 1;
                        child = stack[height].1;
                    }
                    Ok(leaf) => {
                        for slot in leaf {
                            let (barycentric, point) = self.triangles[slot].closest(p);
                            let d2 = point.distance_squared(p);
                            if d2 < best_d2 {
                                best_d2 = d2;
                                best = Some((slot, barycentric, point));
                                limit = reach(d2);
                            }
                        }
                        break;
                    }
                }
            }
        }
        best
    }
}

impl Triangle {
    fn new([a, b, c]: [DVec3; 3]) -> Self {
        let (ab, ac) = (b - a, c - a);
        let (ab_ab, ab_ac, ac_ac) = (ab.dot(ab), ab.dot(ac), ac.dot(ac));
        let thin = ab.cross(ac).length_squared() <= 1e-8 * ab_ab * ac_ac;
        Self { a, ab, ac, ab_ab, ab_ac, ac_ac, thin }
    }

    /// Closest point by the Voronoi regions of the corners and sides (Ericson, Real-Time Collision Detection, 5.1.5).
    #[inline]
    fn closest(&self, p: DVec3) -> ([f64; 3], DVec3) {
        if self.thin {
            return self.closest_thin(p);
        }
        let ap = p - self.a;
        let (d1, d2) = (self.ab.dot(ap), self.ac.dot(ap));
        if d1 <= 0.0 && d2 <= 0.0 {
            return ([1.0, 0.0, 0.0], self.a);
        }
        let (d3, d4) = (d1 - self.ab_ab, d2 - self.ab_ac);
        if d3 >= 0.0 && d4 <= d3 {
            return ([0.0, 1.0, 0.0], self.a + self.ab);
        }
        let (d5, d6) = (d1 - self.ab_ac, d2 - self.ac_ac);
        if d6 >= 0.0 && d5 <= d6 {
            return ([0.0, 0.0, 1.0], self.a + self.ac);
        }
        let vc = d1 * d4 - d3 * d2;
        if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            let t = d1 / self.ab_ab;
            return ([1.0 - t, t, 0.0], self.a + self.ab * t);
        }
        let vb = d5 * d2 - d1 * d6;
        if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            let t = d2 / self.ac_ac;
            return ([1.0 - t, 0.0, t], self.a + self.ac * t);
        }
        let va = d3 * d6 - d5 * d4;
        let (from_b, from_c) = (d4 - d3, d5 - d6);
        if va <= 0.0 && from_b >= 0.0 && from_c >= 0.0 {
            let t = from_b / (from_b + from_c);
            return ([0.0, 1.0 - t, t], self.a + self.ab + (self.ac - self.ab) * t);
        }
        let scale = 1.0 / (va + vb + vc);
        let (v, w) = (vb * scale, vc * scale);
        ([1.0 - v - w, v, w], self.a + self.ab * v + self.ac * w)
    }

    /// The same for faces that are nearly a segment or a point: the best of the sides and, where it makes sense, the
    /// projection into the face.
    #[cold]
    fn closest_thin(&self, p: DVec3) -> ([f64; 3], DVec3) {
        let ap = p - self.a;
        let segment = |from: DVec3, along: DVec3| {
            let t = (along.dot(ap - from) / along.length_squared()).clamp(0.0, 1.0);
            if t.is_finite() { t } else { 0.0 }
        };
        let bc = self.ac - self.ab;
        let (s, t, r) = (segment(DVec3::ZERO, self.ab), segment(DVec3::ZERO, self.ac), segment(self.ab, bc));
        let mut candidates = vec![
            ([1.0 - s, s, 0.0], self.a + self.ab * s),
            ([1.0 - t, 0.0, t], self.a + self.ac * t),
            ([0.0, 1.0 - r, r], self.a + self.ab + bc * r),
        ];
        let normal = self.ab.cross(self.ac);
        let scale = 1.0 / normal.length_squared();
        let (v, w) = (ap.cross(self.ac).dot(normal) * scale, self.ab.cross(ap).dot(normal) * scale);
        if v > 0.0 && w > 0.0 && v + w < 1.0 {
            candidates.push(([1.0 - v - w, v, w], self.a + self.ab * v + self.ac * w));
        }
        let mut best = candidates[0];
        for candidate in &candidates[1..] {
            if candidate.1.distance_squared(p) < best.1.distance_squared(p) {
                best = *candidate;
            }
        }
        best
    }
}
