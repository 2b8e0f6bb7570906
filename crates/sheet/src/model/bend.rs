//! BEND: a part of a sheet is turned about a line (Lee & Kim 2001, fig. 4d).

use std::collections::{BTreeSet, VecDeque};

use glam::{DQuat, DVec2, DVec3};
use mesh_kernel::complex::{EdgeId, FaceId, Loop, NewFace, VertexId};

use super::build::{Builder, SAME_POINT, area_vector, within};
use super::{Model, ModelError};
use crate::unfold::inside;

/// The edges of a cut, and the faces to the left of it.
type Cut = (Vec<EdgeId>, Vec<FaceId>);

impl Model {
    /// Turns what hangs on a patch about a line by an angle in radians, right-handed from `from` to `to`. Where no edge leads from
    /// one point to the other, a face of the patch is first cut there, and the part to the left of the cut is turned.
    pub(super) fn bend(
        &mut self,
        from: DVec3,
        to: DVec3,
        moving: &str,
        angle: f64,
    ) -> Result<(), ModelError> {
        if !(angle.is_finite() && angle.abs() <= std::f64::consts::PI) {
            return Err(ModelError::Number { what: "the angle of a bend", wanted: "from −180° to 180°" });
        }
        let axis = (to - from).try_normalize().ok_or(ModelError::NoEdge { from, to })?;
        let (edges, start) = match self.edges_along(from, to) {
            Ok(edges) => {
                let faces: BTreeSet<FaceId> = self.faces_of(moving)?.into_iter().collect();
                let start: Vec<FaceId> = edges
                    .iter()
                    .flat_map(|e| self.complex().faces_of(*e))
                    .filter(|f| faces.contains(f))
                    .collect();
                (edges, start)
            }
            Err(missing) => self.cut(from, to, moving)?.ok_or(missing)?,
        };
        if start.is_empty() {
            return Err(ModelError::NoEdge { from, to });
        }
        let axis_edges: BTreeSet<EdgeId> = edges.iter().copied().collect();
        let faces = self.hanging_on(&start, &axis_edges);
        let fixed = edges
            .iter()
            .flat_map(|e| self.complex().faces_of(*e))
            .find(|f| faces.contains(f) && !start.contains(f));
        if let Some(face) = fixed {
            return Err(ModelError::Tears { at: self.corners_of(face)[0][0] });
        }
        let on_axis = |p: DVec3| (p - from - axis * (p - from).dot(axis)).length() <= SAME_POINT;
        let list: Vec<FaceId> = faces.iter().copied().collect();
        let moved: Vec<VertexId> =
            self.vertices_of(&list).into_iter().filter(|v| !on_axis(self.at(*v))).collect();
        for &v in &moved {
            let complex = self.complex();
            let others = complex.edges_at(v).iter().flat_map(|e| complex.faces_of(*e));
            let mut others = others.chain(complex.faces_pierced_at(v).iter().copied());
            if others.any(|f| !faces.contains(&f)) {
                return Err(ModelError::Tears { at: self.at(v) });
            }
        }
        // Faces whose place about the axis changes are taken up and laid down again.
        let mut lifted: Vec<(FaceId, Vec<Loop>, Option<u32>)> = Vec::new();
        for &f in &list {
            let shares = self
                .complex()
                .loops(f)
                .iter()
                .flat_map(Loop::edges)
                .any(|d| axis_edges.contains(&d.edge) && self.complex().uses(d.edge).len() > 2);
            if shares {
                let loops = self.complex().loops(f).to_vec();
                lifted.push((f, loops, self.tables.patch_of.remove(&f)));
                self.editor.kill_face(f)?;
            }
        }
        let turn = DQuat::from_axis_angle(axis, angle);
        for v in moved {
            let p = from + turn * (self.at(v) - from);
            self.editor.move_vertex(v, p)?;
        }
        for (_, mut loops, patch) in lifted.into_iter().rev() {
            let outer = loops.remove(0);
            let made = self.editor.make_face(NewFace { outer, rings: loops, radial: Vec::new() })?.face;
            self.enter([made], patch.unwrap_or(0));
        }
        Ok(())
    }

    /// Faces that hang on some faces over edges other than those of the axis.
    fn hanging_on(&self, start: &[FaceId], axis: &BTreeSet<EdgeId>) -> BTreeSet<FaceId> {
        let mut found: BTreeSet<FaceId> = start.iter().copied().collect();
        let mut queue: VecDeque<FaceId> = found.iter().copied().collect();
        while let Some(f) = queue.pop_front() {
            let edges: Vec<EdgeId> =
                self.complex().loops(f).iter().flat_map(Loop::edges).map(|d| d.edge).collect();
            for e in edges.into_iter().filter(|e| !axis.contains(e)) {
                for next in self.complex().faces_of(e) {
                    if found.insert(next) {
                        queue.push_back(next);
                    }
                }
            }
        }
        found
    }

    /// Cuts a face of a patch from one border point to another. Gives the edge, and the part to the left of it.
    fn cut(&mut self, from: DVec3, to: DVec3, patch: &str) -> Result<Option<Cut>, ModelError> {
        let on_border = |corners: &[DVec3], p: DVec3| {
            (0..corners.len()).any(|i| {
                let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
                a.distance(p) <= SAME_POINT || within(p, a, b)
            })
        };
        let faces = self.faces_of(patch)?;
        let Some(face) = faces.into_iter().find(|f| {
            let corners = self.corners_of(*f);
            on_border(&corners[0], from) && on_border(&corners[0], to)
        }) else {
            return Ok(None);
        };
        let number = self.tables.patch_of[&face];
        let vertices = self.vertices_of(&[face]);
        let mut builder = Builder::on(&mut self.editor, vertices);
        let [a, b] = [builder.node(from)?, builder.node(to)?];
        let corners: Vec<VertexId> =
            self.complex().loops(face).first().map(|l| self.complex().loop_vertices(l)).unwrap_or_default();
        let [Some(i), Some(j)] = [a, b].map(|v| corners.iter().position(|w| *w == v)) else {
            return Ok(None);
        };
        let part = |from: usize, to: usize| -> Vec<VertexId> {
            let n = corners.len();
            (0..=(to + n - from) % n).map(|k| corners[(from + k) % n]).collect()
        };
        let parts = [part(j, i), part(i, j)];
        if parts.iter().any(|p| p.len() < 3) {
            return Ok(None);
        }
        let normal = area_vector(&corners.iter().map(|v| self.at(*v)).collect::<Vec<_>>());
        let whole = normal.length();
        let areas = parts
            .iter()
            .map(|p| area_vector(&p.iter().map(|v| self.at(*v)).collect::<Vec<_>>()).dot(normal / whole));
        // Both parts must be turned as the whole, else the cut runs outside.
        if areas.clone().any(|a| a <= 0.0) {
            return Err(ModelError::LeavesFace { patch: patch.to_owned(), at: (from + to) / 2.0 });
        }
        let rings = self.rings_of_parts(face, &parts, normal / whole, patch)?;
        self.editor.kill_face(face)?;
        self.tables.patch_of.remove(&face);
        let edge = self.editor.make_edge(a, b)?.edge;
        let mut made = Vec::new();
        for (vertices, rings) in parts.iter().zip(rings) {
            let walk = self.complex().walk(vertices)?;
            let new = NewFace { rings, ..NewFace::new(walk) };
            made.push(self.editor.make_face(new)?.face);
        }
        self.enter(made.iter().copied(), number);
        // The part whose loop runs from the cut's end back to its beginning has it walked forward: it lies to the left.
        Ok(Some((vec![edge], vec![made[0]])))
    }

    /// The hole loops of a face that lie in each of two parts.
    fn rings_of_parts(
        &self,
        face: FaceId,
        parts: &[Vec<VertexId>; 2],
        normal: DVec3,
        patch: &str,
    ) -> Result<[Vec<Loop>; 2], ModelError> {
        let u = normal.any_orthonormal_vector();
        let v = normal.cross(u);
        let flat = |w: &VertexId| DVec2::new(self.at(*w).dot(u), self.at(*w).dot(v));
        let outlines = parts.each_ref().map(|p| vec![p.iter().map(flat).collect::<Vec<_>>()]);
        let mut rings = [Vec::new(), Vec::new()];
        for ring in self.complex().loops(face).iter().skip(1) {
            let corners = self.complex().loop_vertices(ring);
            let all_in = |o: &Vec<Vec<DVec2>>| corners.iter().all(|w| inside(flat(w), o));
            let Some(part) = outlines.iter().position(all_in) else {
                let at = corners.first().map_or(DVec3::ZERO, |w| self.at(*w));
                return Err(ModelError::LeavesFace { patch: patch.to_owned(), at });
            };
            rings[part].push(ring.clone());
        }
        Ok(rings)
    }
}
