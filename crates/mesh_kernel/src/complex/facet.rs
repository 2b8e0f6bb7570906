//! In which direction a face of many corners leaves each of its edges.

use std::collections::BTreeMap;

use glam::DVec3;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::Complex;
use super::ids::{DirectedEdge, FaceUse, Loop, VertexId};
use super::radial::drop_axis;

impl Complex {
    /// For every directed edge of the loops the third corner of the triangle to its left, in a constrained triangulation of the
    /// face; without those that cannot be told (faces that cross themselves in the plane of their normal, degenerate ones).
    ///
    /// A coordinate is dropped and none computed, so the triangulation is exact in that plane. O(n log n) in the corners.
    pub(super) fn apexes(&self, loops: &[Loop]) -> BTreeMap<DirectedEdge, VertexId> {
        if let [Loop::Walk(walk)] = loops
            && let [x, y, z] = walk[..]
        {
            let opposite = [(x, z), (y, x), (z, y)];
            return opposite.into_iter().filter_map(|(d, next)| Some((d, self.origin(next)?))).collect();
        }
        self.triangulated_apexes(loops).unwrap_or_default()
    }

    /// Where a use of an edge leaves it; `None` where that cannot be told.
    pub(super) fn apex(&self, edge: super::EdgeId, u: FaceUse) -> Option<DVec3> {
        self.position(*self.apexes(self.loops(u.face)).get(&u.at(edge))?)
    }

    /// Twice the area vector of a closed walk.
    pub(super) fn area_vector(&self, l: &Loop) -> DVec3 {
        let corners: Vec<DVec3> =
            self.loop_vertices(l).into_iter().filter_map(|v| self.position(v)).collect();
        let Some(&o) = corners.first() else { return DVec3::ZERO };
        corners.windows(2).map(|w| (w[0] - o).cross(w[1] - o)).sum()
    }

    /// The coordinate to drop for a plane picture of the loops, and whether the picture is mirrored.
    pub(super) fn picture_plane(&self, loops: &[Loop]) -> Option<(usize, bool)> {
        let n = self.area_vector(loops.first()?);
        let a = n.abs();
        let axis = if a.x >= a.y && a.x >= a.z {
            0
        } else if a.y >= a.z {
            1
        } else {
            2
        };
        (n[axis] != 0.0 && n[axis].is_finite()).then_some((axis, n[axis] < 0.0))
    }

    fn triangulated_apexes(&self, loops: &[Loop]) -> Option<BTreeMap<DirectedEdge, VertexId>> {
        let (axis, mirrored) = self.picture_plane(loops)?;
        let mut plane = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
        let mut handles = BTreeMap::new();
        let mut names: Vec<VertexId> = Vec::new();
        for v in loops.iter().flat_map(|l| self.loop_vertices(l)) {
            if handles.contains_key(&v) {
                continue;
            }
            let at = drop_axis(self.position(v)?, axis);
            let handle = plane.insert(Point2::new(at.x, at.y)).ok()?;
            if handle.index() != names.len() {
                // Two corners on one point of the picture.
                return None;
            }
            names.push(v);
            handles.insert(v, handle);
        }
        let edges: Vec<DirectedEdge> = loops.iter().flat_map(Loop::edges).copied().collect();
        let mut ends = Vec::new();
        for d in &edges {
            let [a, b] = [*handles.get(&self.origin(*d)?)?, *handles.get(&self.target(*d)?)?];
            let known = plane.get_edge_from_neighbors(a, b).is_some_and(|e| e.is_constraint_edge());
            if !known {
                if !plane.can_add_constraint(a, b) {
                    return None;
                }
                plane.add_constraint(a, b);
            }
            ends.push([a, b]);
        }
        let mut apexes = BTreeMap::new();
        for (d, [a, b]) in edges.into_iter().zip(ends) {
            let edge = plane.get_edge_from_neighbors(a, b);
            let inner = edge.map(|e| if mirrored { e.rev() } else { e }).and_then(|e| e.face().as_inner());
            let apex =
                inner.and_then(|f| f.vertices().into_iter().map(|v| v.fix()).find(|v| *v != a && *v != b));
            if let Some(v) = apex {
                apexes.insert(d, names[v.index()]);
            }
        }
        Some(apexes)
    }
}
