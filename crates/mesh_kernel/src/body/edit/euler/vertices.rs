//! Operators that make and kill nodes: complexes of one node, nodes at the end of a wire, nodes on a wire.

use glam::{DVec2, DVec3};

use super::EulerError;
use crate::body::edit::Editor;
use crate::body::edit::delta::NodeValue;
use crate::body::edit::operation::Operation;
use crate::body::{EdgeId, NONE, NodeId, Surface, SurfaceId};

/// Layers of a new node: its backup is where it is made, its place in the pattern the origin.
fn new_node(position: DVec3) -> NodeValue {
    NodeValue { position, backup: position, planar: DVec2::ZERO }
}

impl NodeValue {
    /// What a surface stores of a node.
    pub(in crate::body::edit) fn of(s: &Surface, v: u32) -> Self {
        let v = v as usize;
        Self {
            position: s.positions[v],
            backup: s.backup.get(v).copied().unwrap_or_default(),
            planar: s.planar.get(v).copied().unwrap_or_default(),
        }
    }

    /// The value at parameter `at` of the line from this one to another.
    pub(in crate::body::edit) fn between(self, to: Self, at: f64) -> Self {
        Self {
            position: self.position * (1.0 - at) + to.position * at,
            backup: self.backup * (1.0 - at) + to.backup * at,
            planar: self.planar * (1.0 - at) + to.planar * at,
        }
    }
}

impl Editor {
    /// Makes a node that stands alone. Backup and planar positions, where the surface has them, get the position and zero.
    ///
    /// v + 1, c + 1. Inverse: [`Editor::kill_vertex_complex`].
    ///
    /// # Errors
    /// Unknown surface; a position that is not finite. O(1).
    pub fn make_vertex_complex(&mut self, surface: SurfaceId, position: DVec3) -> Result<NodeId, EulerError> {
        self.body.checked_surface(surface)?.has_room(surface)?;
        if !position.is_finite() {
            return Err(EulerError::NotFinite);
        }
        let operation = || Operation::MakeVertexComplex { surface, position };
        Ok(self.record(surface, operation, |r| NodeId(r.add_node(new_node(position)))))
    }

    /// Kills a node that stands alone.
    ///
    /// v − 1, c − 1. Inverse: [`Editor::make_vertex_complex`].
    ///
    /// # Errors
    /// Unknown node; edges at it; a joint that holds it. O(edges of the surface).
    pub fn kill_vertex_complex(&mut self, surface: SurfaceId, node: NodeId) -> Result<(), EulerError> {
        let s = self.body.checked_node(surface, node)?;
        let edges = s.edges_at(node);
        if !edges.is_empty() {
            let remedy = "kill them first";
            return Err(EulerError::NodeHasEdges { surface, node, edges, remedy });
        }
        if let Some(joint) = s.joint_at(node) {
            return Err(EulerError::NodeOnJoint { surface, node, joint });
        }
        let operation = || Operation::KillVertexComplex { surface, node };
        self.record(surface, operation, |r| r.remove_node(node.0));
        Ok(())
    }

    /// Makes a node and a wire to it from a node that is there.
    ///
    /// v + 1, e + 1. Inverse: [`Editor::kill_vertex_edge`].
    ///
    /// # Errors
    /// Unknown node; a position that is not finite. O(1).
    pub fn make_vertex_edge(
        &mut self,
        surface: SurfaceId,
        from: NodeId,
        position: DVec3,
    ) -> Result<(NodeId, EdgeId), EulerError> {
        self.body.checked_node(surface, from)?.has_room(surface)?;
        if !position.is_finite() {
            return Err(EulerError::NotFinite);
        }
        let operation = || Operation::MakeVertexEdge { surface, from, position };
        Ok(self.record(surface, operation, |r| {
            let node = r.add_node(new_node(position));
            (NodeId(node), EdgeId(r.add_edge([from.0, node])))
        }))
    }

    /// Kills a node at the end of a wire together with the wire.
    ///
    /// v − 1, e − 1. Inverse: [`Editor::make_vertex_edge`].
    ///
    /// # Errors
    /// Unknown node; none or several edges at it; an edge with faces; a joint that holds it; attributes on the wire.
    /// O(edges of the surface).
    pub fn kill_vertex_edge(&mut self, surface: SurfaceId, node: NodeId) -> Result<(), EulerError> {
        let s = self.body.checked_node(surface, node)?;
        let edges = s.edges_at(node);
        let &[edge] = &edges[..] else {
            if edges.is_empty() {
                return Err(EulerError::NodeAlone { surface, node });
            }
            let remedy = "kill all but one first";
            return Err(EulerError::NodeHasEdges { surface, node, edges, remedy });
        };
        let faces = s.faces_at(edge);
        if !faces.is_empty() {
            let remedy = "kill them first";
            return Err(EulerError::EdgeHasFaces { surface, edge, faces, remedy });
        }
        if let Some(joint) = s.joint_at(node) {
            return Err(EulerError::NodeOnJoint { surface, node, joint });
        }
        if s.carries_attributes(&[edge.0], &[]) {
            return Err(EulerError::CarriesAttributes { surface, what: format!("edge {edge}") });
        }
        let operation = || Operation::KillVertexEdge { surface, node };
        self.record(surface, operation, |r| {
            r.remove_edge(edge.0);
            r.remove_node(node.0);
        });
        Ok(())
    }

    /// Puts a node on an edge without faces, at parameter `at` (0 at its first node). The edge keeps its number as the
    /// half at its first node; attributes, backup and planar positions follow. Gives the node and the other half.
    ///
    /// v + 1, e + 1 (the paper's split_edge). Inverse: [`Editor::merge_wire`].
    ///
    /// # Errors
    /// Unknown edge; a parameter outside it; faces or a joint at it, for which there is
    /// [`Editor::split_edge`]. O(1), and O(attributes) where there are any.
    pub fn split_wire(
        &mut self,
        surface: SurfaceId,
        edge: EdgeId,
        at: f64,
    ) -> Result<(NodeId, EdgeId), EulerError> {
        let s = self.body.checked_edge(surface, edge)?;
        if !(at > 0.0 && at < 1.0) {
            return Err(EulerError::Parameter(at));
        }
        let faces = s.faces_at(edge);
        if !faces.is_empty() {
            let remedy = "split edge and faces together by split_edge";
            return Err(EulerError::EdgeHasFaces { surface, edge, faces, remedy });
        }
        if let Some(joint) = s.joint_of(edge) {
            return Err(EulerError::EdgeOnJoint { surface, edge, joint });
        }
        s.has_room(surface)?;
        let operation = || Operation::SplitWire { surface, edge, at };
        Ok(self.record(surface, operation, |r| {
            let s = r.surface();
            let [a, b] = s.edges[edge.index()];
            let (p, q) = (NodeValue::of(s, a), NodeValue::of(s, b));
            if !s.attribute_nodes.is_empty() {
                let second = EdgeId(s.slots.edges.next(s.edges.len()));
                r.change_attributes(|s| {
                    s.carry_attributes(|e| (e == edge.0).then_some(([edge, second], at)), |_| None);
                });
            }
            let node = r.add_node(p.between(q, at));
            r.set_ends(edge.0, [a, node]);
            (NodeId(node), EdgeId(r.add_edge([node, b])))
        }))
    }

    /// Takes a node off a wire: its two edges become one. The one that ends in the node is kept, if the other starts
    /// there, as [`Editor::split_wire`] leaves them; else the one with the lower number. Gives the edge kept.
    ///
    /// v − 1, e − 1 (the paper's merge_edge). Inverse: [`Editor::split_wire`].
    ///
    /// # Errors
    /// Unknown node; not two edges at it; faces, joints or attributes on them; the merged edge would be there twice.
    /// O(edges of the surface).
    pub fn merge_wire(&mut self, surface: SurfaceId, node: NodeId) -> Result<EdgeId, EulerError> {
        let s = self.body.checked_node(surface, node)?;
        let edges = s.edges_at(node);
        let &[x, y] = &edges[..] else {
            if edges.is_empty() {
                return Err(EulerError::NodeAlone { surface, node });
            }
            let remedy = "only a node between two wires can be taken off";
            return Err(EulerError::NodeHasEdges { surface, node, edges, remedy });
        };
        for edge in [x, y] {
            let faces = s.faces_at(edge);
            if !faces.is_empty() {
                let remedy = "take edge and faces away together by collapse_edge";
                return Err(EulerError::EdgeHasFaces { surface, edge, faces, remedy });
            }
        }
        if let Some(joint) = s.joint_at(node) {
            return Err(EulerError::NodeOnJoint { surface, node, joint });
        }
        if s.carries_attributes(&[x.0, y.0], &[]) {
            return Err(EulerError::CarriesAttributes { surface, what: format!("an edge at node {node}") });
        }
        let ends_there = |e: EdgeId| s.edges[e.index()][1] == node.0;
        let (kept, gone) = if ends_there(y) && !ends_there(x) { (y, x) } else { (x, y) };
        let [far, near] = [gone, kept].map(|e| s.edges[e.index()]);
        let far = if far[0] == node.0 { far[1] } else { far[0] };
        let ends = near.map(|v| if v == node.0 { far } else { v });
        if ends[0] == ends[1] {
            return Err(EulerError::RepeatedNode(NodeId(far)));
        }
        if let Some(edge) = s.find_edge(NodeId(ends[0]), NodeId(ends[1])) {
            return Err(EulerError::MergeExists { surface, node, edge });
        }
        debug_assert!(far != NONE, "edges that live have ends");
        let operation = || Operation::MergeWire { surface, node };
        self.record(surface, operation, |r| {
            r.remove_edge(gone.0);
            r.set_ends(kept.0, ends);
            r.remove_node(node.0);
        });
        Ok(kept)
    }
}
