//! The first face that a ray meets.

use glam::{DVec3, Vec4};

use super::bvh::{Bvh, Child, STACK, VACANT};
use crate::TriMesh;

/// Where a ray meets a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// The face; of several at one distance, the one with the smallest number.
    pub face: u32,
    /// How far along the ray, in lengths of its direction.
    pub distance: f64,
}

/// A mesh prepared for ray queries.
///
/// Boxes are skipped by f32 tests that are widened by their own rounding; faces are met in f64, their edges widened by
/// some rounding too, so that rays do not slip through between two faces. Faces with corners that are not finite are left
/// out.
#[derive(Clone, Debug)]
pub struct RayCaster {
    bvh: Bvh,
    /// A corner and two sides of every face, in the order of the hierarchy's leaves.
    triangles: Vec<[DVec3; 3]>,
}

/// How far outside a face, in barycentric coordinates, a ray may pass and still meet it.
const EDGE_SLACK: f64 = 1e-10;
/// Stands for the zero components of a direction.
const NEARLY_ZERO: f32 = 1e-20;

impl RayCaster {
    /// Builds the hierarchy. O(n log n).
    pub fn new(mesh: &TriMesh) -> Self {
        Self::with_bvh(Bvh::new(mesh), mesh)
    }

    /// The same for a mesh of the same faces whose nodes have moved, all finite: answers are as after [`Self::new`], the
    /// hierarchy is this one's. O(n).
    pub fn moved(&self, mesh: &TriMesh) -> Self {
        Self::with_bvh(self.bvh.refit(mesh), mesh)
    }

    pub(super) fn with_bvh(bvh: Bvh, mesh: &TriMesh) -> Self {
        let corners = |f: &u32| if *f == VACANT { [DVec3::ZERO; 3] } else { mesh.corners(*f) };
        let triangles = bvh.order.iter().map(corners).map(|[a, b, c]| [a, b - a, c - a]).collect();
        Self { bvh, triangles }
    }

    /// The faces with finite corners, such that those which follow each other are near each other: rays from one after the other
    /// run through the same part of the hierarchy.
    pub fn faces(&self) -> impl Iterator<Item = u32> {
        self.bvh.order.iter().copied().filter(|f| *f != VACANT)
    }

    /// The first face met at a distance above `from` and at most `to`, in lengths of `direction`; both sides of a face
    /// count. `None` where there is none, or nothing is finite. About O(log n).
    ///
    /// ```
    /// use mesh_kernel::TriMesh;
    /// use mesh_kernel::glam::DVec3;
    /// use mesh_kernel::query::RayCaster;
    ///
    /// let mesh = TriMesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]]);
    /// let hit = RayCaster::new(&mesh).first(DVec3::new(0.2, 0.2, 3.0), -DVec3::Z, 0.0, f64::INFINITY);
    /// assert_eq!(hit.map(|h| (h.face, h.distance)), Some((0, 3.0)));
    /// ```
    pub fn first(&self, origin: DVec3, direction: DVec3, from: f64, to: f64) -> Option<RayHit> {
        let local = origin - self.bvh.origin;
        if !local.is_finite() || !direction.is_finite() || self.triangles.is_empty() {
            return None;
        }
        let slack = (local.abs().max_element() + self.bvh.extent) * 2.0 * f64::from(f32::EPSILON);
        let slack = Vec4::splat((slack as f32).next_up());
        let at = local.as_vec3().to_array().map(Vec4::splat);
        let inverse = direction.to_array().map(|d| {
            let d = d as f32;
            Vec4::splat(1.0 / if d.abs() < NEARLY_ZERO { NEARLY_ZERO.copysign(d) } else { d })
        });
        let mut best: Option<RayHit> = None;
        let mut limit = to;
        let mut stack = [(0f32, Child::ROOT); STACK];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (bound, child) = stack[height];
            if f64::from(bound) > limit {
                continue;
            }
            match child.get() {
                Err(node) => {
                    let node = &self.bvh.nodes[node];
                    let (mut enter, mut leave) = (Vec4::ZERO, Vec4::INFINITY);
                    for axis in 0..3 {
                        let a = (node.lo[axis] - slack - at[axis]) * inverse[axis];
                        let b = (node.hi[axis] + slack - at[axis]) * inverse[axis];
                        enter = enter.max(a.min(b));
                        leave = leave.min(a.max(b));
                    }
                    // A few units in the last place of the products.
                    let (enter, leave) = (enter * 0.999_999, leave * 1.000_001);
                    let mut met = enter.cmple(leave).bitmask();
                    let enter = enter.to_array();
                    let first = height;
                    while met != 0 {
                        let k = met.trailing_zeros() as usize;
                        met &= met - 1;
                        if f64::from(enter[k]) <= limit {
                            // The nearest child is looked at first.
                            let mut at = height;
                            while at > first && stack[at - 1].0 < enter[k] {
                                stack[at] = stack[at - 1];
                                at -= 1;
                            }
                            stack[at] = (enter[k], node.children[k]);
                            height += 1;
                        }
                    }
                }
                Ok(leaf) => {
                    for slot in leaf {
                        let face = self.bvh.order[slot];
                        let Some(distance) = meets(&self.triangles[slot], origin, direction) else {
                            continue;
                        };
                        let nearer =
                            distance < limit || distance == limit && best.is_none_or(|b| face < b.face);
                        if distance > from && nearer {
                            limit = distance;
                            best = Some(RayHit { face, distance });
                        }
                    }
                }
            }
        }
        best
    }
}

/// Where a ray meets a triangle (Möller & Trumbore 1997).
fn meets([a, ab, ac]: &[DVec3; 3], origin: DVec3, direction: DVec3) -> Option<f64> {
    let p = direction.cross(*ac);
    let inverse = 1.0 / ab.dot(p);
    let s = origin - *a;
    let u = s.dot(p) * inverse;
    let q = s.cross(*ab);
    let v = direction.dot(q) * inverse;
    let inside = u >= -EDGE_SLACK && v >= -EDGE_SLACK && u + v <= 1.0 + EDGE_SLACK;
    let distance = ac.dot(q) * inverse;
    (inside && distance.is_finite()).then_some(distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of unit squares in the plane z = 0, two faces each, and the same at z = 1.
    fn two_floors(n: u32) -> TriMesh {
        let mut mesh = TriMesh::default();
        for z in 0..2 {
            let first = mesh.positions.len() as u32;
            for j in 0..=n {
                for i in 0..=n {
                    mesh.positions.push(DVec3::new(f64::from(i), f64::from(j), f64::from(z)));
                }
            }
            for j in 0..n {
                for i in 0..n {
                    let at = |di: u32, dj: u32| first + (j + dj) * (n + 1) + i + di;
                    mesh.faces.push([at(0, 0), at(1, 0), at(1, 1)]);
                    mesh.faces.push([at(0, 0), at(1, 1), at(0, 1)]);
                }
            }
        }
        mesh
    }

    #[test]
    fn rays_meet_what_all_faces_tried_one_by_one_say() {
        let mesh = two_floors(9);
        let caster = RayCaster::new(&mesh);
        let mut state = 7u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        for _ in 0..2000 {
            let origin = DVec3::new(random() * 12.0 - 1.0, random() * 12.0 - 1.0, random() * 4.0 - 1.5);
            let direction = DVec3::new(random() - 0.5, random() - 0.5, random() - 0.5).normalize();
            let all = (0..mesh.faces.len() as u32).filter_map(|f| {
                let [a, b, c] = mesh.corners(f);
                meets(&[a, b - a, c - a], origin, direction).filter(|t| *t > 0.0 && *t <= 5.0)
            });
            let wanted = all.min_by(f64::total_cmp);
            let got = caster.first(origin, direction, 0.0, 5.0).map(|h| h.distance);
            assert_eq!(got, wanted, "{origin} {direction}");
        }
    }

    #[test]
    fn a_moved_mesh_is_met_as_a_new_one() {
        let mut mesh = two_floors(9);
        let before = RayCaster::new(&mesh);
        for (k, p) in mesh.positions.iter_mut().enumerate() {
            *p += DVec3::new(3.0 + 0.3 * p.y, 0.2 * p.x, 0.05 * (k % 7) as f64);
        }
        let (moved, new) = (before.moved(&mesh), RayCaster::new(&mesh));
        let mut met = 0;
        for k in 0..600 {
            let origin = DVec3::new(f64::from(k % 25) * 0.6, f64::from(k / 25) * 0.5, 4.0);
            let direction = DVec3::new(0.1, -0.05, -1.0);
            let hit = moved.first(origin, direction, 0.0, 9.0);
            met += usize::from(hit.is_some());
            assert_eq!(hit, new.first(origin, direction, 0.0, 9.0), "{origin}");
        }
        assert!(met > 100 && met < 600, "{met}");
    }

    #[test]
    fn all_faces_are_listed_and_crossings_go_on_as_a_caster() {
        let mesh = two_floors(7);
        let caster = crate::query::Crossings::new(&mesh).caster(&mesh);
        let mut faces: Vec<u32> = caster.faces().collect();
        faces.sort_unstable();
        assert!(faces.into_iter().eq(0..mesh.faces.len() as u32));
        let hit = caster.first(DVec3::new(2.3, 4.6, 3.0), -DVec3::Z, 0.0, 9.0);
        assert_eq!(hit, RayCaster::new(&mesh).first(DVec3::new(2.3, 4.6, 3.0), -DVec3::Z, 0.0, 9.0));
        assert!(hit.is_some());
    }

    #[test]
    fn axis_parallel_rays_through_nodes_and_edges_meet_a_face() {
        let mesh = two_floors(4);
        let caster = RayCaster::new(&mesh);
        for p in &mesh.positions[..25] {
            let up = caster.first(*p - DVec3::Z, DVec3::Z, 0.0, 10.0);
            assert_eq!(up.map(|h| h.distance), Some(1.0), "{p}");
            let beyond = caster.first(*p, DVec3::Z, 0.5, 10.0);
            assert_eq!(beyond.map(|h| h.distance), Some(1.0), "{p}");
        }
        assert_eq!(caster.first(DVec3::NAN, DVec3::Z, 0.0, 1.0), None);
        assert_eq!(RayCaster::new(&TriMesh::default()).first(DVec3::ZERO, DVec3::Z, 0.0, 1.0), None);
    }
}
