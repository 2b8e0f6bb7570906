//! Ring operators: what lies inside a face before it is triangulated.
//!
//! On a triangle surface a ring vertex is an attribute node in a face (ATTRIB_FACENODE), an edge between two of them an
//! attribute edge (ATTRIB_EDGE). See the table of [`super`] for the counts.

use super::EulerError;
use crate::body::edit::Editor;
use crate::body::edit::operation::Operation;
use crate::body::{
    AttributeEdge, AttributeEdgeId, AttributeNode, AttributeNodeId, FaceId, Surface, SurfaceId,
};

impl Surface {
    fn ring(&self, surface: SurfaceId, node: AttributeNodeId) -> Result<(), EulerError> {
        match self.attribute_nodes.get(node.index()) {
            None => Err(EulerError::Attribute(crate::body::AttributeError::NoNode(node))),
            Some(AttributeNode::InFace { .. }) => Ok(()),
            Some(AttributeNode::OnEdge { .. }) => Err(EulerError::NoRing { surface, node }),
        }
    }
}

impl Editor {
    /// Makes a stand-alone vertex in a face, at areal coordinates: a ring. No count changes (v + 1 and r + 1 cancel and
    /// are left out). Inverse: [`Editor::kill_vertex_ring`].
    ///
    /// # Errors
    /// Unknown face; coordinates out of range. O(attributes).
    pub fn make_vertex_ring(
        &mut self,
        surface: SurfaceId,
        face: FaceId,
        areal: [f64; 3],
    ) -> Result<AttributeNodeId, EulerError> {
        self.body.checked_face(surface, face)?;
        let operation = || Operation::MakeVertexRing { surface, face, areal };
        self.add_attribute_node_as(surface, AttributeNode::InFace { face, areal }, operation)
    }

    /// Kills a stand-alone vertex in a face; the last attribute node of its surface. Inverse:
    /// [`Editor::make_vertex_ring`].
    ///
    /// # Errors
    /// Unknown node; one on an edge; one that is not the last, or that an attribute edge names. O(attributes).
    pub fn kill_vertex_ring(&mut self, surface: SurfaceId, node: AttributeNodeId) -> Result<(), EulerError> {
        self.body.checked_surface(surface)?.ring(surface, node)?;
        let operation = || Operation::KillVertexRing { surface, node };
        self.remove_attribute_node_as(surface, node, operation)
    }

    /// Makes an edge between two rings of one face, which become one. No count changes (e + 1 and r − 1 cancel and are
    /// left out). Inverse: [`Editor::kill_edge_make_ring`].
    ///
    /// # Errors
    /// Unknown nodes; nodes on edges; nodes of different faces; one node twice. O(attributes).
    pub fn make_edge_kill_ring(
        &mut self,
        surface: SurfaceId,
        nodes: [AttributeNodeId; 2],
    ) -> Result<AttributeEdgeId, EulerError> {
        let s = self.body.checked_surface(surface)?;
        for node in nodes {
            s.ring(surface, node)?;
        }
        if nodes[0] == nodes[1] {
            return Err(EulerError::RepeatedRing(nodes[0]));
        }
        let line = AttributeEdge { name: None, nodes: nodes.to_vec() };
        self.add_attribute_edge_as(surface, line, || Operation::MakeEdgeKillRing { surface, nodes })
    }

    /// Kills an edge between two rings; the last attribute edge of its surface. Inverse:
    /// [`Editor::make_edge_kill_ring`].
    ///
    /// # Errors
    /// Unknown attribute edge; one that is not between two rings, or not the last. O(attributes).
    pub fn kill_edge_make_ring(
        &mut self,
        surface: SurfaceId,
        line: AttributeEdgeId,
    ) -> Result<(), EulerError> {
        let s = self.body.checked_surface(surface)?;
        let between =
            |l: &AttributeEdge| l.nodes.len() == 2 && l.nodes.iter().all(|&n| s.ring(surface, n).is_ok());
        if !s.attribute_edges.get(line.index()).is_some_and(between) {
            return Err(EulerError::NoRingEdge { surface, line });
        }
        self.remove_attribute_edge_as(surface, line, || Operation::KillEdgeMakeRing { surface, line })
    }
}
