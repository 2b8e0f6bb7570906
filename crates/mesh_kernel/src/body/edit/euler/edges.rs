//! Operators that make and kill edges without faces.

use super::{EdgeRole, EulerError};
use crate::body::edit::Editor;
use crate::body::edit::operation::Operation;
use crate::body::weld::UnionFind;
use crate::body::{Body, EdgeId, NONE, NodeId, Surface, SurfaceId};

/// Which form of an operator is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form<T> {
    /// Whatever the surroundings ask for.
    Free,
    /// This one.
    Strict(T),
}

impl Body {
    /// Whether two nodes of a surface are connected in the welded body by edges other than `without`, or are one node.
    /// O(nodes + edges of the body).
    fn connected(&self, surface: SurfaceId, [a, b]: [u32; 2], without: Option<EdgeId>) -> Connection {
        let offsets = self.offsets(|s| s.positions.len());
        let mut sets: UnionFind = self.node_sets(&offsets);
        let [a, b] = [a, b].map(|v| offsets[surface.index()] + v);
        if sets.find(a) == sets.find(b) {
            return Connection::Same;
        }
        for ((id, s), offset) in self.surfaces().zip(&offsets) {
            let edges = s.edges.iter().enumerate().filter(|(_, ends)| ends[0] != NONE);
            for (_, [p, q]) in edges.filter(|(e, _)| id != surface || without != Some(EdgeId(*e as u32))) {
                sets.union(offset + p, offset + q);
            }
        }
        if sets.find(a) == sets.find(b) { Connection::Connected } else { Connection::Apart }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Connection {
    Same,
    Connected,
    Apart,
}

fn check_form(
    form: Form<EdgeRole>,
    role: EdgeRole,
    surface: SurfaceId,
    nodes: [NodeId; 2],
) -> Result<(), EulerError> {
    match (form, role) {
        (Form::Strict(EdgeRole::Bridge), EdgeRole::Cycle) => Err(EulerError::ClosesCycle { surface, nodes }),
        (Form::Strict(EdgeRole::Cycle), EdgeRole::Bridge) => {
            Err(EulerError::JoinsComplexes { surface, nodes })
        }
        _ => Ok(()),
    }
}

impl Editor {
    /// Makes an edge without faces from `from` to `to`; says what it does to the connection of the body.
    ///
    /// e + 1, and ch + 1 for [`EdgeRole::Cycle`], c − 1 for [`EdgeRole::Bridge`]. Inverse: [`Editor::kill_edge`].
    ///
    /// # Errors
    /// Unknown nodes; one node twice, also one held together by joints; an edge of the surface between them.
    /// O(nodes + edges of the body).
    pub fn make_edge(
        &mut self,
        surface: SurfaceId,
        from: NodeId,
        to: NodeId,
    ) -> Result<(EdgeId, EdgeRole), EulerError> {
        self.make_edge_as(surface, [from, to], Form::Free)
    }

    /// Makes an edge that closes a cycle: e + 1, ch + 1. Inverse: [`Editor::kill_edge_chole`].
    ///
    /// # Errors
    /// As [`Editor::make_edge`]; nodes of different complexes.
    pub fn make_edge_chole(
        &mut self,
        surface: SurfaceId,
        from: NodeId,
        to: NodeId,
    ) -> Result<EdgeId, EulerError> {
        Ok(self.make_edge_as(surface, [from, to], Form::Strict(EdgeRole::Cycle))?.0)
    }

    /// Makes an edge that joins two complexes: e + 1, c − 1. Inverse: [`Editor::kill_edge_make_complex`].
    ///
    /// # Errors
    /// As [`Editor::make_edge`]; nodes of one complex.
    pub fn make_edge_kill_complex(
        &mut self,
        surface: SurfaceId,
        from: NodeId,
        to: NodeId,
    ) -> Result<EdgeId, EulerError> {
        Ok(self.make_edge_as(surface, [from, to], Form::Strict(EdgeRole::Bridge))?.0)
    }

    fn make_edge_as(
        &mut self,
        surface: SurfaceId,
        nodes: [NodeId; 2],
        form: Form<EdgeRole>,
    ) -> Result<(EdgeId, EdgeRole), EulerError> {
        let [from, to] = nodes;
        self.body.checked_node(surface, from)?;
        let s = self.body.checked_node(surface, to)?;
        if from == to {
            return Err(EulerError::RepeatedNode(from));
        }
        if let Some(edge) = s.find_edge(from, to) {
            return Err(EulerError::EdgeExists { surface, edge });
        }
        s.has_room(surface)?;
        let role = match self.body.connected(surface, [from.0, to.0], None) {
            Connection::Same => return Err(EulerError::SameNode { surface, nodes }),
            Connection::Connected => EdgeRole::Cycle,
            Connection::Apart => EdgeRole::Bridge,
        };
        check_form(form, role, surface, nodes)?;
        let operation = || match form {
            Form::Free => Operation::MakeEdge { surface, from, to },
            Form::Strict(EdgeRole::Cycle) => Operation::MakeEdgeChole { surface, from, to },
            Form::Strict(EdgeRole::Bridge) => Operation::MakeEdgeKillComplex { surface, from, to },
        };
        Ok((self.record(surface, operation, |r| EdgeId(r.add_edge([from.0, to.0]))), role))
    }

    /// Kills an edge without faces; says what it was for the connection of the body. Its nodes stay.
    ///
    /// e − 1, and ch − 1 for [`EdgeRole::Cycle`], c + 1 for [`EdgeRole::Bridge`]. Inverse: [`Editor::make_edge`].
    ///
    /// # Errors
    /// Unknown edge; faces, a joint or attributes at it. O(nodes + edges of the body).
    pub fn kill_edge(&mut self, surface: SurfaceId, edge: EdgeId) -> Result<EdgeRole, EulerError> {
        self.kill_edge_as(surface, edge, Form::Free)
    }

    /// Kills an edge that closes a cycle: e − 1, ch − 1. Inverse: [`Editor::make_edge_chole`].
    ///
    /// # Errors
    /// As [`Editor::kill_edge`]; an edge that alone connects its ends.
    pub fn kill_edge_chole(&mut self, surface: SurfaceId, edge: EdgeId) -> Result<(), EulerError> {
        self.kill_edge_as(surface, edge, Form::Strict(EdgeRole::Cycle)).map(|_| ())
    }

    /// Kills an edge that alone connects its ends: e − 1, c + 1. Inverse: [`Editor::make_edge_kill_complex`].
    ///
    /// # Errors
    /// As [`Editor::kill_edge`]; an edge that closes a cycle.
    pub fn kill_edge_make_complex(&mut self, surface: SurfaceId, edge: EdgeId) -> Result<(), EulerError> {
        self.kill_edge_as(surface, edge, Form::Strict(EdgeRole::Bridge)).map(|_| ())
    }

    fn kill_edge_as(
        &mut self,
        surface: SurfaceId,
        edge: EdgeId,
        form: Form<EdgeRole>,
    ) -> Result<EdgeRole, EulerError> {
        let s: &Surface = self.body.checked_edge(surface, edge)?;
        let faces = s.faces_at(edge);
        if !faces.is_empty() {
            let remedy = "kill them first";
            return Err(EulerError::EdgeHasFaces { surface, edge, faces, remedy });
        }
        if let Some(joint) = s.joint_of(edge) {
            return Err(EulerError::EdgeOnJoint { surface, edge, joint });
        }
        if s.carries_attributes(&[edge.0], &[]) {
            return Err(EulerError::CarriesAttributes { surface, what: format!("edge {edge}") });
        }
        let ends = s.edges[edge.index()];
        // Ends that joints made one since: the edge is a loop, a cycle of its own.
        let role = match self.body.connected(surface, ends, Some(edge)) {
            Connection::Apart => EdgeRole::Bridge,
            Connection::Connected | Connection::Same => EdgeRole::Cycle,
        };
        check_form(form, role, surface, ends.map(NodeId))?;
        let operation = || match form {
            Form::Free => Operation::KillEdge { surface, edge },
            Form::Strict(EdgeRole::Cycle) => Operation::KillEdgeChole { surface, edge },
            Form::Strict(EdgeRole::Bridge) => Operation::KillEdgeMakeComplex { surface, edge },
        };
        self.record(surface, operation, |r| r.remove_edge(edge.0));
        Ok(role)
    }
}
