//! Operators that make and kill a vertex: alone, at the end of an edge, as a ring.

use glam::DVec3;

use super::Complex;
use super::ids::{Corner, DirectedEdge, EdgeClass, EdgeId, FaceId, FaceUse, Loop, VertexId};
use super::operation::{Delta, FaceCorner, Operation, Outcome};
use super::plan::{Step, must_be_finite};
use super::refusal::Reason;

impl Complex {
    pub(super) fn plan_make_vertex_complex(&self, position: DVec3) -> Result<Step, Reason> {
        must_be_finite(position)?;
        self.must_have_room()?;
        Ok(Step {
            operation: Operation::MakeVertexComplex { position },
            inverse: Operation::KillVertexComplex { vertex: self.next_vertex() },
            delta: Delta { v: 1, c: 1, ..Delta::default() },
        })
    }

    pub(super) fn plan_kill_vertex_complex(&self, vertex: VertexId) -> Result<Step, Reason> {
        let v = self.vertex(vertex)?;
        if !v.edges.is_empty() || !v.faces.is_empty() {
            return Err(Reason::VertexInUse { vertex, edges: v.edges.clone(), faces: v.faces.clone() });
        }
        Ok(Step {
            operation: Operation::KillVertexComplex { vertex },
            inverse: Operation::MakeVertexComplex { position: v.position },
            delta: Delta { v: -1, c: -1, ..Delta::default() },
        })
    }

    pub(super) fn plan_move_vertex(&self, vertex: VertexId, position: DVec3) -> Result<Step, Reason> {
        must_be_finite(position)?;
        Ok(Step {
            operation: Operation::MoveVertex { vertex, position },
            inverse: Operation::MoveVertex { vertex, position: self.vertex(vertex)?.position },
            delta: Delta::default(),
        })
    }

    pub(super) fn plan_make_vertex_edge(&self, operation: &Operation) -> Result<Step, Reason> {
        let Operation::MakeVertexEdge { from, position, corner, .. } = operation else {
            return Err(Reason::EmptyLoop);
        };
        must_be_finite(*position)?;
        self.must_have_room()?;
        self.vertex(*from)?;
        if let Some(FaceCorner { face, corner }) = *corner {
            self.must_be_corner(face, corner, Some(*from))?;
        }
        Ok(Step {
            operation: operation.clone(),
            inverse: Operation::KillVertexEdge { vertex: self.next_vertex() },
            delta: Delta { v: 1, e: 1, ..Delta::default() },
        })
    }

    /// That the face has the corner, at the vertex.
    pub(super) fn must_be_corner(
        &self,
        face: FaceId,
        corner: Corner,
        at: Option<VertexId>,
    ) -> Result<(usize, usize), Reason> {
        self.face(face)?;
        let place = self.find_corner(face, corner).ok_or(Reason::NoCorner { face, corner })?;
        let found = self.corner_vertex(corner).ok_or(Reason::NoCorner { face, corner })?;
        match at {
            Some(asked) if asked != found => Err(Reason::OtherVertex { face, found, asked }),
            _ => Ok(place),
        }
    }

    pub(super) fn plan_kill_vertex_edge(&self, vertex: VertexId) -> Result<Step, Reason> {
        let v = self.vertex(vertex)?;
        let [e] = v.edges[..] else {
            return Err(Reason::NotLooseEnd { vertex, edges: v.edges.clone() });
        };
        if !v.faces.is_empty() {
            return Err(Reason::VertexInUse { vertex, edges: v.edges.clone(), faces: v.faces.clone() });
        }
        let edge = self.edge(e)?;
        let inward = edge.ends[0] == vertex;
        let from = edge.ends[usize::from(inward)];
        let corner = match edge.uses[..] {
            [] => None,
            // A loop that comes by the only edge goes by it too.
            [a, b] if a.face == b.face => {
                Some(FaceCorner { face: a.face, corner: self.corner_behind(e, a.face, from) })
            }
            _ => return Err(Reason::FacesAtEdge { edge: e, faces: self.faces_of(e) }),
        };
        // What is left may be a vertex that is a loop of the face already.
        if let Some(FaceCorner { face, corner: Corner::Vertex(v) }) = corner
            && self.faces_pierced_at(v).binary_search(&face).is_ok()
        {
            return Err(Reason::RingTwice(v));
        }
        Ok(Step {
            operation: Operation::KillVertexEdge { vertex },
            inverse: Operation::MakeVertexEdge {
                from,
                position: v.position,
                corner,
                inward,
                class: edge.class,
            },
            delta: Delta { v: -1, e: -1, ..Delta::default() },
        })
    }

    /// The corner of the face that is left at `from` once its strut is gone.
    fn corner_behind(&self, strut: EdgeId, face: FaceId, from: VertexId) -> Corner {
        for l in self.loops(face) {
            let walk = l.edges();
            // The way back along the strut ends at `from`.
            let back = walk.iter().position(|d| d.edge == strut && self.target(*d) == Some(from));
            if let Some(i) = back {
                let next = walk[(i + 1) % walk.len()];
                return if next.edge == strut { Corner::Vertex(from) } else { Corner::Leaving(next) };
            }
        }
        Corner::Vertex(from)
    }

    pub(super) fn act_make_vertex_edge(
        &mut self,
        from: VertexId,
        position: DVec3,
        corner: Option<FaceCorner>,
        inward: bool,
        class: EdgeClass,
    ) -> Outcome {
        let vertex = self.insert_vertex(position);
        let edge = self.insert_edge(if inward { [vertex, from] } else { [from, vertex] }, class);
        if let Some(FaceCorner { face, corner }) = corner {
            let out = DirectedEdge { edge, reversed: inward };
            if let Some((i, at)) = self.find_corner(face, corner) {
                self.edit_loops(face, |loops| match &mut loops[i] {
                    Loop::Walk(walk) => {
                        walk.splice(at..at, [out, out.flipped()]);
                    }
                    single => *single = Loop::Walk(vec![out, out.flipped()]),
                });
            }
            self.set_uses(edge, vec![FaceUse { face, along: false }, FaceUse { face, along: true }]);
        }
        let face = corner.map(|c| c.face);
        Outcome { vertex: Some(vertex), edge: Some(edge), face, ..Outcome::default() }
    }

    pub(super) fn act_kill_vertex_edge(&mut self, vertex: VertexId) -> Outcome {
        let Some(&e) = self.edges_at(vertex).first() else { return Outcome::default() };
        let face = self.uses(e).first().map(|u| u.face);
        let from = self.ends(e).map(|[a, b]| if a == vertex { b } else { a });
        if let (Some(face), Some(from)) = (face, from) {
            self.edit_loops(face, |loops| {
                for l in loops.iter_mut() {
                    if let Loop::Walk(walk) = l {
                        walk.retain(|d| d.edge != e);
                        if walk.is_empty() {
                            *l = Loop::Vertex(from);
                        }
                    }
                }
            });
        }
        self.remove_edge(e);
        self.vertices.remove(vertex.0);
        Outcome { vertex: Some(vertex), edge: Some(e), face, ..Outcome::default() }
    }

    pub(super) fn plan_make_vertex_ring(&self, face: FaceId, position: DVec3) -> Result<Step, Reason> {
        must_be_finite(position)?;
        self.must_have_room()?;
        self.face(face)?;
        Ok(Step {
            operation: Operation::MakeVertexRing { face, position },
            inverse: Operation::KillVertexRing { vertex: self.next_vertex() },
            delta: Delta { v: 1, r: 1, ..Delta::default() },
        })
    }

    pub(super) fn plan_kill_vertex_ring(&self, vertex: VertexId) -> Result<Step, Reason> {
        let v = self.vertex(vertex)?;
        if !v.edges.is_empty() {
            return Err(Reason::VertexInUse { vertex, edges: v.edges.clone(), faces: v.faces.clone() });
        }
        let ring = match v.faces[..] {
            [f] if self.loops(f).first() != Some(&Loop::Vertex(vertex)) => Some(f),
            _ => None,
        };
        let Some(face) = ring else { return Err(Reason::NotRing { vertex, faces: v.faces.clone() }) };
        Ok(Step {
            operation: Operation::KillVertexRing { vertex },
            inverse: Operation::MakeVertexRing { face, position: v.position },
            delta: Delta { v: -1, r: -1, ..Delta::default() },
        })
    }

    pub(super) fn act_make_vertex_ring(&mut self, face: FaceId, position: DVec3) -> Outcome {
        let vertex = self.insert_vertex(position);
        self.edit_loops(face, |loops| loops.push(Loop::Vertex(vertex)));
        Outcome { vertex: Some(vertex), face: Some(face), ..Outcome::default() }
    }

    pub(super) fn act_kill_vertex_ring(&mut self, vertex: VertexId) -> Outcome {
        let face = self.faces_pierced_at(vertex).first().copied();
        if let Some(f) = face {
            self.edit_loops(f, |loops| loops.retain(|l| *l != Loop::Vertex(vertex)));
        }
        self.vertices.remove(vertex.0);
        Outcome { vertex: Some(vertex), face, ..Outcome::default() }
    }
}
