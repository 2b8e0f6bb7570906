//! The point of a mesh that is closest to a given point.

use glam::{DVec3, Vec4};

use super::bvh::{Bvh, Child, LEAF, STACK, VACANT};
use super::triangle_pack::TrianglePack;
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
/// Boxes of the hierarchy and faces are skipped by f32 bounds that are lowered by their own rounding error; distances to
/// the faces that are left are computed in f64. Faces with corners that are not finite are left out.
#[derive(Clone, Debug)]
pub struct ClosestPoint {
    bvh: Bvh,
    /// Faces in the order of the hierarchy's leaves.
    triangles: Vec<Triangle>,
    /// The same for the bounds, a leaf each.
    packs: Vec<TrianglePack>,
}

/// A face as a corner and two sides.
#[derive(Clone, Debug)]
struct Triangle {
    a: DVec3,
    ab: DVec3,
    ac: DVec3,
}

impl ClosestPoint {
    /// Builds the hierarchy. O(n log n).
    pub fn new(mesh: &TriMesh) -> Self {
        Self::with_bvh(Bvh::new(mesh), mesh)
    }

    pub(super) fn with_bvh(bvh: Bvh, mesh: &TriMesh) -> Self {
        let corners = |f: u32| if f == VACANT { [DVec3::ZERO; 3] } else { mesh.corners(f) };
        let triangles = bvh.order.iter().map(|f| Triangle::new(corners(*f))).collect();
        let local = |f: &u32| corners(*f).map(|p| p - bvh.origin);
        let packs =
            bvh.order.chunks_exact(LEAF).map(|leaf| TrianglePack::new(leaf.iter().map(local))).collect();
        Self { bvh, triangles, packs }
    }

    pub(super) fn bvh(&self) -> &Bvh {
        &self.bvh
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
        let at = local.as_vec3().to_array().map(Vec4::splat);
        let mut search = Search::new(p, max, local.abs().max_element() + self.bvh.extent);
        let mut stack = [(0f32, Child::ROOT); STACK];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (bound, mut child) = stack[height];
            if bound > search.limit2 {
                continue;
            }
            loop {
                match child.get() {
                    Err(node) => {
                        let node = &self.bvh.nodes[node];
                        let mut bounds = Vec4::ZERO;
                        for (at, (lo, hi)) in at.into_iter().zip(node.lo.iter().zip(&node.hi)) {
                            let d = (*lo - at).max(at - *hi).max(Vec4::ZERO);
                            bounds += d * d;
                        }
                        let mut near = bounds.cmple(Vec4::splat(search.limit2)).bitmask();
                        if near == 0 {
                            break;
                        }
                        // The nearest child is next; the others wait.
                        let bounds = bounds.to_array();
                        let mut nearest = near.trailing_zeros() as usize;
                        near &= near - 1;
                        while near != 0 {
                            let k = near.trailing_zeros() as usize;
                            near &= near - 1;
                            let farther = if bounds[k] < bounds[nearest] { nearest } else { k };
                            nearest = if farther == k { nearest } else { k };
                            stack[height] = (bounds[farther], node.children[farther]);
                            height += 1;
                        }
                        child = node.children[nearest];
                    }
                    Ok(leaf) => {
                        search.leaf(&self.packs[leaf.start / LEAF], at, leaf, &self.triangles);
                        break;
                    }
                }
            }
        }
        search.finish(&self.triangles);
        search.best
    }
}

/// Candidates that wait for their exact distance; more are rarely within rounding of each other.
const WAITING: usize = 24;

/// The state of a search. Distances in f32 come with bounds of their error; `limit` is what a computed f32 distance can
/// be at most if the face is to be the closest.
struct Search {
    p: DVec3,
    slack: f64,
    limit: f32,
    /// Its square, rounded up.
    limit2: f32,
    best_d2: f64,
    best: Option<(usize, [f64; 3], DVec3)>,
    /// Least distance and place of faces whose exact distance is not known yet.
    waiting: [(f32, u32); WAITING],
    count: usize,
}

impl Search {
    /// `size`: largest coordinates of point and mesh together.
    fn new(p: DVec3, max: f64, size: f64) -> Self {
        // Rounding of the point and of differences, absolute.
        let slack = size * f64::from(f32::EPSILON) * 2.0;
        // A little above max², whose root may be max after rounding.
        let best_d2 = if max < 1e150 { (max * max * (1.0 + 1e-15)).next_up() } else { f64::INFINITY };
        let waiting = [(0.0, 0); WAITING];
        let mut search = Self { p, slack, limit: 0.0, limit2: 0.0, best_d2, best: None, waiting, count: 0 };
        search.set_limit(best_d2.sqrt());
        search
    }

    /// The closest face is at `distance` at most.
    #[inline]
    fn set_limit(&mut self, distance: f64) {
        self.limit = (((distance + self.slack) * 1.000_001) as f32).next_up();
        self.limit2 = self.limit * self.limit * 1.000_001;
    }

    #[inline]
    fn leaf(
        &mut self,
        pack: &TrianglePack,
        at: [Vec4; 3],
        leaf: std::ops::Range<usize>,
        triangles: &[Triangle],
    ) {
        let bounds = pack.bounds(at);
        let mut near = bounds.not_beyond(self.limit) & ((1 << leaf.len()) - 1);
        while near != 0 {
            let k = near.trailing_zeros() as usize;
            near &= near - 1;
            let least = bounds.least(k);
            if least > self.limit {
                continue;
            }
            if self.count == WAITING {
                self.finish(triangles);
            }
            self.waiting[self.count] = (least, (leaf.start + k) as u32);
            self.count += 1;
            let most = f64::from(bounds.most(k)) + self.slack;
            if (most + self.slack) * 1.000_001 < f64::from(self.limit) {
                self.set_limit(most);
            } else if !most.is_finite() {
                // Nothing is known in f32.
                self.finish(triangles);
            }
        }
    }

    /// Exact distances of all that wait and may still be the closest.
    fn finish(&mut self, triangles: &[Triangle]) {
        for k in 0..std::mem::take(&mut self.count) {
            let (least, slot) = self.waiting[k];
            // Not "least <= limit": what is no number is looked at.
            if least > self.limit {
                continue;
            }
            let slot = slot as usize;
            let (barycentric, point) = triangles[slot].closest(self.p);
            let d2 = point.distance_squared(self.p);
            if d2 < self.best_d2 {
                self.best_d2 = d2;
                self.best = Some((slot, barycentric, point));
                if d2.sqrt() < f64::from(self.limit) {
                    self.set_limit(d2.sqrt().min(f64::from(self.limit)));
                }
            }
        }
    }
}

impl Triangle {
    fn new([a, b, c]: [DVec3; 3]) -> Self {
        Self { a, ab: b - a, ac: c - a }
    }

    /// Closest point by the Voronoi regions of the corners and sides (Ericson, Real-Time Collision Detection, 5.1.5).
    #[inline]
    fn closest(&self, p: DVec3) -> ([f64; 3], DVec3) {
        let (ab_ab, ab_ac, ac_ac) = (self.ab.dot(self.ab), self.ab.dot(self.ac), self.ac.dot(self.ac));
        // Sine of the angle at `a` below 1e-4: projecting into the face is ill-conditioned.
        if ab_ab * ac_ac - ab_ac * ab_ac <= 1e-8 * ab_ab * ac_ac {
            return self.closest_thin(p);
        }
        let ap = p - self.a;
        let (d1, d2) = (self.ab.dot(ap), self.ac.dot(ap));
        if d1 <= 0.0 && d2 <= 0.0 {
            return ([1.0, 0.0, 0.0], self.a);
        }
        let (d3, d4) = (d1 - ab_ab, d2 - ab_ac);
        if d3 >= 0.0 && d4 <= d3 {
            return ([0.0, 1.0, 0.0], self.a + self.ab);
        }
        let (d5, d6) = (d1 - ab_ac, d2 - ac_ac);
        if d6 >= 0.0 && d5 <= d6 {
            return ([0.0, 0.0, 1.0], self.a + self.ac);
        }
        let vc = d1 * d4 - d3 * d2;
        if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            let t = d1 / ab_ab;
            return ([1.0 - t, t, 0.0], self.a + self.ab * t);
        }
        let vb = d5 * d2 - d1 * d6;
        if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            let t = d2 / ac_ac;
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
