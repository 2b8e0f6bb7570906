//! Check first, then act: what an operator would do, and doing it.

use glam::DVec3;

use super::ids::{EdgeId, FaceId, VertexId};
use super::operation::{Delta, EdgeKind, FaceKind, Operation, Outcome};
use super::refusal::{Reason, Refusal};
use super::{Complex, Edge, Face, Vertex};

/// An operator that was found possible.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Step {
    /// As asked, with everything that was found out written down (radial places).
    pub(super) operation: Operation,
    /// What gives the complex back, bit for bit.
    pub(super) inverse: Operation,
    pub(super) delta: Delta,
}

/// More entities than that have no ids.
const FULL: usize = i32::MAX as usize;

impl Complex {
    /// Whether an operator may be applied, and how it would change the counts. Cost: that of the operator's search, see there.
    ///
    /// # Errors
    /// The refusal that [`super::Editor::apply`] would give.
    pub fn can(&self, operation: &Operation) -> Result<Delta, Refusal> {
        self.plan(operation).map(|step| step.delta)
    }

    pub(super) fn plan(&self, operation: &Operation) -> Result<Step, Refusal> {
        let step = self.plan_any(operation);
        step.map_err(|reason| Refusal { operator: operation.name(), reason })
    }

    fn plan_any(&self, operation: &Operation) -> Result<Step, Reason> {
        use Operation as O;
        match operation {
            O::MakeVertexComplex { position } => self.plan_make_vertex_complex(*position),
            O::KillVertexComplex { vertex } => self.plan_kill_vertex_complex(*vertex),
            O::MakeVertexEdge { .. } => self.plan_make_vertex_edge(operation),
            O::KillVertexEdge { vertex } => self.plan_kill_vertex_edge(*vertex),
            O::MakeEdgeChole { ends, class } => {
                self.plan_make_edge(*ends, *class, Some(EdgeKind::Chole)).map(|x| x.1)
            }
            O::MakeEdgeKillComplex { ends, class } => {
                self.plan_make_edge(*ends, *class, Some(EdgeKind::Complex)).map(|x| x.1)
            }
            O::KillEdgeChole { edge } => self.plan_kill_edge(*edge, Some(EdgeKind::Chole)).map(|x| x.1),
            O::KillEdgeMakeComplex { edge } => {
                self.plan_kill_edge(*edge, Some(EdgeKind::Complex)).map(|x| x.1)
            }
            O::MakeFaceKillChole { face } => self.plan_make_face(face, Some(FaceKind::Chole)).map(|x| x.1),
            O::MakeFaceMakeCavity { face } => self.plan_make_face(face, Some(FaceKind::Cavity)).map(|x| x.1),
            O::KillFaceMakeChole { face } => self.plan_kill_face(*face, Some(FaceKind::Chole)).map(|x| x.1),
            O::KillFaceKillCavity { face } => self.plan_kill_face(*face, Some(FaceKind::Cavity)).map(|x| x.1),
            O::MakeVertexRing { face, position } => self.plan_make_vertex_ring(*face, *position),
            O::KillVertexRing { vertex } => self.plan_kill_vertex_ring(*vertex),
            O::MakeEdgeKillRing { face, from, to, class } => {
                self.plan_make_edge_kill_ring(*face, *from, *to, *class)
            }
            O::KillEdgeMakeRing { edge, ring } => self.plan_kill_edge_make_ring(*edge, *ring),
            O::SplitEdge { edge, position, kept, flipped } => {
                self.plan_split_edge(*edge, *position, *kept, *flipped)
            }
            O::MergeEdge { kept, vertex } => self.plan_merge_edge(*kept, *vertex),
            O::MoveVertex { vertex, position } => self.plan_move_vertex(*vertex, *position),
            O::SetEdgeClass { edge, class } => self.plan_set_edge_class(*edge, *class),
            O::OrderEdge { order } => self.plan_order_edge(order),
        }
    }

    /// Does what was found possible. The delta is left zero.
    pub(super) fn act(&mut self, operation: &Operation) -> Outcome {
        use Operation as O;
        match operation {
            O::MakeVertexComplex { position } => {
                Outcome { vertex: Some(self.insert_vertex(*position)), ..Outcome::default() }
            }
            O::KillVertexComplex { vertex } => {
                self.vertices.remove(vertex.0);
                Outcome { vertex: Some(*vertex), ..Outcome::default() }
            }
            O::MakeVertexEdge { from, position, corner, inward, class } => {
                self.act_make_vertex_edge(*from, *position, *corner, *inward, *class)
            }
            O::KillVertexEdge { vertex } => self.act_kill_vertex_edge(*vertex),
            O::MakeEdgeChole { ends, class } | O::MakeEdgeKillComplex { ends, class } => {
                Outcome { edge: Some(self.insert_edge(*ends, *class)), ..Outcome::default() }
            }
            O::KillEdgeChole { edge } | O::KillEdgeMakeComplex { edge } => {
                self.remove_edge(*edge);
                Outcome { edge: Some(*edge), ..Outcome::default() }
            }
            O::MakeFaceKillChole { face } | O::MakeFaceMakeCavity { face } => {
                Outcome { face: Some(self.act_make_face(face)), ..Outcome::default() }
            }
            O::KillFaceMakeChole { face } | O::KillFaceKillCavity { face } => {
                self.act_kill_face(*face);
                Outcome { face: Some(*face), ..Outcome::default() }
            }
            O::MakeVertexRing { face, position } => self.act_make_vertex_ring(*face, *position),
            O::KillVertexRing { vertex } => self.act_kill_vertex_ring(*vertex),
            O::MakeEdgeKillRing { face, from, to, class } => {
                self.act_make_edge_kill_ring(*face, *from, *to, *class)
            }
            O::KillEdgeMakeRing { edge, ring } => self.act_kill_edge_make_ring(*edge, *ring),
            O::SplitEdge { edge, position, kept, flipped } => {
                self.act_split_edge(*edge, *position, *kept, *flipped)
            }
            O::MergeEdge { kept, vertex } => self.act_merge_edge(*kept, *vertex),
            O::MoveVertex { vertex, position } => {
                if let Some(v) = self.vertices.get_mut(vertex.0) {
                    v.position = *position;
                }
                Outcome { vertex: Some(*vertex), ..Outcome::default() }
            }
            O::SetEdgeClass { edge, class } => {
                if let Some(e) = self.edges.get_mut(edge.0) {
                    e.class = *class;
                }
                Outcome { edge: Some(*edge), ..Outcome::default() }
            }
            O::OrderEdge { order } => {
                self.set_uses(order.edge, order.uses.clone());
                Outcome { edge: Some(order.edge), ..Outcome::default() }
            }
        }
    }

    pub(super) fn vertex(&self, v: VertexId) -> Result<&Vertex, Reason> {
        self.vertices.get(v.0).ok_or(Reason::NoVertex(v))
    }

    pub(super) fn edge(&self, e: EdgeId) -> Result<&Edge, Reason> {
        self.edges.get(e.0).ok_or(Reason::NoEdge(e))
    }

    pub(super) fn face(&self, f: FaceId) -> Result<&Face, Reason> {
        self.faces.get(f.0).ok_or(Reason::NoFace(f))
    }

    pub(super) fn must_have_room(&self) -> Result<(), Reason> {
        let full = [self.vertices.bound(), self.edges.bound(), self.faces.bound()].iter().any(|n| *n >= FULL);
        if full { Err(Reason::Full) } else { Ok(()) }
    }
}

pub(super) fn must_be_finite(p: DVec3) -> Result<(), Reason> {
    if p.is_finite() { Ok(()) } else { Err(Reason::NotFinite(p.to_array())) }
}
