//! Points to vertices, edges and faces by Euler operators.

use std::collections::BTreeSet;

use glam::DVec3;
use mesh_kernel::complex::{DirectedEdge, EdgeId, Editor, FaceId, NewFace, VertexId};

use super::ModelError;

/// Points nearer than this, in millimetres, are one.
pub const SAME_POINT: f64 = 1e-6;

/// Makes faces on vertices that it may use: those given, and its own.
pub(super) struct Builder<'a> {
    pub(super) editor: &'a mut Editor,
    known: Vec<VertexId>,
    /// Faces made.
    pub(super) faces: Vec<FaceId>,
}

impl<'a> Builder<'a> {
    /// A builder that makes everything anew, apart from what hangs on these vertices.
    pub(super) fn on(editor: &'a mut Editor, known: impl IntoIterator<Item = VertexId>) -> Self {
        Self { editor, known: known.into_iter().collect(), faces: Vec::new() }
    }

    /// The vertex at a point that the builder knows, if there is one.
    fn find(&self, p: DVec3) -> Option<VertexId> {
        let here =
            |v: &&VertexId| self.editor.complex().position(**v).is_some_and(|q| q.distance(p) <= SAME_POINT);
        self.known.iter().find(here).copied()
    }

    /// The vertex at a point: one that is known, one put into a known edge, or a new one.
    pub(super) fn node(&mut self, p: DVec3) -> Result<VertexId, ModelError> {
        if let Some(v) = self.find(p) {
            return Ok(v);
        }
        let vertex = match self.edge_through(p) {
            Some(edge) => self.editor.split_edge(edge, p)?.vertex,
            None => self.editor.make_vertex_complex(p)?,
        };
        self.known.push(vertex);
        Ok(vertex)
    }

    /// A known edge inside which a point lies.
    fn edge_through(&self, p: DVec3) -> Option<EdgeId> {
        let complex = self.editor.complex();
        let known: BTreeSet<VertexId> = self.known.iter().copied().collect();
        let edges: BTreeSet<EdgeId> = self.known.iter().flat_map(|v| complex.edges_at(*v)).copied().collect();
        edges.into_iter().find(|&e| {
            let Some(ends) = complex.ends(e) else { return false };
            let [Some(a), Some(b)] = ends.map(|v| complex.position(v)) else { return false };
            ends.iter().all(|v| known.contains(v)) && within(p, a, b)
        })
    }

    /// Edges from one vertex straight to another, over known vertices between; made where they are missing.
    pub(super) fn straight(&mut self, from: VertexId, to: VertexId) -> Result<Vec<DirectedEdge>, ModelError> {
        let at = |v: VertexId| self.editor.complex().position(v).unwrap_or_default();
        let (a, b) = (at(from), at(to));
        let mut between: Vec<(f64, VertexId)> = self
            .known
            .iter()
            .filter(|v| **v != from && **v != to && within(at(**v), a, b))
            .map(|v| (at(*v).distance(a), *v))
            .collect();
        between.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        let mut walk = Vec::new();
        let mut here = from;
        for next in between.into_iter().map(|x| x.1).chain([to]) {
            walk.push(self.edge(here, next)?);
            here = next;
        }
        Ok(walk)
    }

    fn edge(&mut self, from: VertexId, to: VertexId) -> Result<DirectedEdge, ModelError> {
        let complex = self.editor.complex();
        // Of several that touch without being joined, the first.
        let edge = match complex.edges_between(from, to).first() {
            Some(edge) => *edge,
            None => self.editor.make_edge(from, to)?.edge,
        };
        let reversed = self.editor.complex().ends(edge).is_some_and(|ends| ends[0] != from);
        Ok(DirectedEdge { edge, reversed })
    }

    /// A closed walk through points.
    pub(super) fn walk(&mut self, points: &[DVec3]) -> Result<Vec<DirectedEdge>, ModelError> {
        let nodes = points.iter().map(|p| self.node(*p)).collect::<Result<Vec<_>, _>>()?;
        let mut walk = Vec::new();
        for (i, &v) in nodes.iter().enumerate() {
            let next = nodes[(i + 1) % nodes.len()];
            if next != v {
                walk.extend(self.straight(v, next)?);
            }
        }
        Ok(walk)
    }

    /// A face with an outer loop and rings, given by their corners. Rings may be given either way round.
    pub(super) fn face(&mut self, loops: &[Vec<DVec3>]) -> Result<FaceId, ModelError> {
        let Some((outer, rings)) = loops.split_first() else {
            return Err(ModelError::Number { what: "a face", wanted: "made of loops" });
        };
        let normal = area_vector(outer);
        // All corners first, so that edges run over corners that lie on them.
        for p in loops.iter().flatten() {
            self.node(*p)?;
        }
        let walk = self.walk(outer)?;
        let mut face = NewFace::new(walk);
        for ring in rings {
            let turned: Vec<DVec3>;
            let ring = if area_vector(ring).dot(normal) > 0.0 {
                turned = ring.iter().rev().copied().collect();
                &turned
            } else {
                ring
            };
            face = face.ring(self.walk(ring)?);
        }
        let made = self.editor.make_face(face)?.face;
        self.faces.push(made);
        Ok(made)
    }
}

/// Whether a point lies on a segment and not at its ends.
pub(super) fn within(p: DVec3, a: DVec3, b: DVec3) -> bool {
    let along = b - a;
    let Some(d) = along.try_normalize() else { return false };
    let t = (p - a).dot(d);
    t > SAME_POINT && t < along.length() - SAME_POINT && (p - a - d * t).length() <= SAME_POINT
}

/// Twice the area vector of a closed polygon.
pub(super) fn area_vector(points: &[DVec3]) -> DVec3 {
    let Some(&o) = points.first() else { return DVec3::ZERO };
    points.windows(2).map(|w| (w[0] - o).cross(w[1] - o)).sum()
}
