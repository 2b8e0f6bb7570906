//! Operators that leave the topology: names, positions, backup, flattened pattern, attributes; and new surfaces.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::Editor;
use super::delta::NodeValue;
use super::euler::EulerError;
use super::journal::Record;
use super::operation::Operation;
use crate::body::{
    AttributeEdge, AttributeEdgeId, AttributeError, AttributeNode, AttributeNodeId, Body, NONE, NodeId,
    Surface, SurfaceId,
};

/// Why positions or other layers were not set. Nothing is changed then.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LayerError {
    /// No such surface.
    #[error("the body has no surface {0}")]
    NoSurface(SurfaceId),
    /// No such node.
    #[error("surface {surface} has no node {node}")]
    NoNode {
        /// Surface.
        surface: SurfaceId,
        /// Node.
        node: NodeId,
    },
    /// A position is not finite.
    #[error("node {node} of surface {surface}: a position must be finite numbers")]
    NotFinite {
        /// Surface.
        surface: SurfaceId,
        /// Node.
        node: NodeId,
    },
    /// Two nodes that are one in the welded body would be parted.
    #[error(
        "nodes {} and {} of surface {surface} are held together by joints and cannot be moved to different places; give \
         both the same, or kill the joint first",
        nodes[0], nodes[1]
    )]
    Parted {
        /// Surface.
        surface: SurfaceId,
        /// The nodes.
        nodes: [NodeId; 2],
    },
    /// Not one position a node.
    #[error("surface {surface} has {nodes} nodes, but {given} positions were given")]
    Length {
        /// Surface.
        surface: SurfaceId,
        /// Positions given.
        given: usize,
        /// Numbers of nodes, free ones included.
        nodes: usize,
    },
    /// No backup was stored.
    #[error("surface {0} has no backup; store one first")]
    NoBackup(SurfaceId),
    /// Attributes that do not fit the surface.
    #[error(transparent)]
    Attribute(#[from] AttributeError),
}

impl Body {
    fn layer_surface(&self, surface: SurfaceId) -> Result<&Surface, LayerError> {
        self.surfaces.get(surface.index()).ok_or(LayerError::NoSurface(surface))
    }

    /// All places to be set, by surface, when nodes of one surface move: joints take their partners along.
    fn moved_together(
        &self,
        surface: SurfaceId,
        nodes: &[(NodeId, DVec3)],
    ) -> Result<Vec<Vec<(u32, DVec3)>>, LayerError> {
        let mut moves = vec![Vec::new(); self.surfaces.len()];
        let jointed = self.surface(surface).chains.iter().any(|c| c.joint.is_some());
        let weld = jointed.then(|| self.weld());
        let mut places: BTreeMap<u32, (NodeId, DVec3)> = BTreeMap::new();
        for &(node, place) in nodes {
            let welded = weld.as_ref().map_or(node.0, |w| w.node(surface, node.0));
            let (first, before) = *places.entry(welded).or_insert((node, place));
            if before.to_array().map(f64::to_bits) != place.to_array().map(f64::to_bits) {
                return Err(LayerError::Parted { surface, nodes: [first, node] });
            }
        }
        match weld {
            None => moves[surface.index()] = places.into_iter().map(|(v, (_, p))| (v, p)).collect(),
            Some(weld) => {
                for (numbers, moves) in weld.nodes.iter().zip(&mut moves) {
                    let place = |(v, w): (usize, &u32)| places.get(w).map(|(_, p)| (v as u32, *p));
                    moves.extend(numbers.iter().enumerate().filter(|(_, w)| **w != NONE).filter_map(place));
                }
            }
        }
        Ok(moves)
    }
}

impl Editor {
    /// Adds an empty surface. Its inverse is undoing. O(1).
    pub fn add_surface(&mut self, name: &str) -> SurfaceId {
        let surface = SurfaceId(self.body.surfaces.len() as u32);
        let made = Surface { name: name.into(), ..Surface::default() };
        self.push_surface(made, Operation::AddSurface { name: name.into() });
        surface
    }

    /// Gives a surface another name. O(1).
    ///
    /// # Errors
    /// Unknown surface.
    pub fn rename_surface(&mut self, surface: SurfaceId, name: &str) -> Result<(), LayerError> {
        self.body.layer_surface(surface)?;
        let operation = || Operation::RenameSurface { surface, name: name.into() };
        self.record_layer(surface, operation, |r| r.set_name(name));
        Ok(())
    }

    /// Moves nodes of a surface; nodes of other surfaces, or of the same, that joints hold together with them move along.
    /// The radial order of joints stays as it is stored ([`Body::order_joint`]). Nothing is logged where nothing is given.
    ///
    /// # Errors
    /// Unknown ids; positions that are not finite; different places for nodes held together. O(nodes moved), and
    /// O(nodes of the body) where the surface has joints.
    pub fn move_nodes(&mut self, surface: SurfaceId, nodes: &[(NodeId, DVec3)]) -> Result<(), LayerError> {
        let s = self.body.layer_surface(surface)?;
        for &(node, place) in nodes {
            if !s.is_node(node) {
                return Err(LayerError::NoNode { surface, node });
            }
            if !place.is_finite() {
                return Err(LayerError::NotFinite { surface, node });
            }
        }
        let moves = self.body.moved_together(surface, nodes)?;
        self.move_all(&moves, Operation::MoveNodes { surface, nodes: nodes.to_vec() });
        Ok(())
    }

    fn move_all(&mut self, moves: &[Vec<(u32, DVec3)>], operation: Operation) {
        let mut deltas = Vec::new();
        for (i, moves) in moves.iter().enumerate().filter(|(_, m)| !m.is_empty()) {
            let (_, delta) = self.change(SurfaceId(i as u32), |r| {
                for &(v, position) in moves {
                    let value = NodeValue { position, ..NodeValue::of(r.surface(), v) };
                    r.set_node(v, value);
                }
            });
            deltas.push(delta);
        }
        if !deltas.is_empty() {
            self.log(Record::Deltas { operation: Box::new(operation), deltas, stars_kept: true });
        }
    }

    /// Keeps the present positions of a surface as its backup. O(nodes).
    ///
    /// # Errors
    /// Unknown surface.
    pub fn store_backup(&mut self, surface: SurfaceId) -> Result<(), LayerError> {
        let backup = self.body.layer_surface(surface)?.positions.clone();
        self.record_layer(surface, || Operation::StoreBackup { surface }, |r| r.set_backup(backup));
        Ok(())
    }

    /// Moves the nodes of a surface back to their backup positions, and with them the nodes that joints hold together
    /// with them. Of several nodes that are one in the welded body the lowest decides. O(nodes of the body).
    ///
    /// # Errors
    /// Unknown surface; no backup.
    pub fn restore_backup(&mut self, surface: SurfaceId) -> Result<(), LayerError> {
        let s = self.body.layer_surface(surface)?;
        let backup = s.backup().ok_or(LayerError::NoBackup(surface))?;
        let weld = self.body.weld();
        let mut first: BTreeMap<u32, DVec3> = BTreeMap::new();
        let mut nodes = Vec::new();
        for node in s.live_nodes() {
            let place = *first.entry(weld.node(surface, node.0)).or_insert(backup[node.index()]);
            nodes.push((node, place));
        }
        let moves = self.body.moved_together(surface, &nodes)?;
        self.move_all(&moves, Operation::RestoreBackup { surface });
        Ok(())
    }

    /// Sets the flattened pattern of a surface, in millimetres, one position a number of a node; `None` takes it away.
    /// O(nodes).
    ///
    /// # Errors
    /// Unknown surface; not one position a node; positions of live nodes that are not finite.
    pub fn set_planar(&mut self, surface: SurfaceId, planar: Option<Vec<DVec2>>) -> Result<(), LayerError> {
        let s = self.body.layer_surface(surface)?;
        if let Some(planar) = &planar {
            let (given, nodes) = (planar.len(), s.positions.len());
            if given != nodes {
                return Err(LayerError::Length { surface, given, nodes });
            }
            if let Some(node) = s.live_nodes().find(|v| !planar[v.index()].is_finite()) {
                return Err(LayerError::NotFinite { surface, node });
            }
        }
        let operation = || Operation::SetPlanar { surface, planar: planar.clone() };
        let mut flat = planar.clone().unwrap_or_default();
        for (v, place) in flat.iter_mut().enumerate() {
            // What stands under a free number is always the same.
            if !s.is_node(NodeId(v as u32)) {
                *place = DVec2::ZERO;
            }
        }
        self.record_layer(surface, operation, |r| r.set_planar(flat));
        Ok(())
    }

    /// Adds an attribute node. Inverse: [`Editor::remove_attribute_node`].
    ///
    /// # Errors
    /// Unknown surface or host; parameters out of range. O(attributes).
    pub fn add_attribute_node(
        &mut self,
        surface: SurfaceId,
        node: AttributeNode,
    ) -> Result<AttributeNodeId, EulerError> {
        self.add_attribute_node_as(surface, node, || Operation::AddAttributeNode { surface, node })
    }

    pub(super) fn add_attribute_node_as(
        &mut self,
        surface: SurfaceId,
        node: AttributeNode,
        operation: impl Fn() -> Operation,
    ) -> Result<AttributeNodeId, EulerError> {
        self.change_attributes(surface, operation, |s| s.add_attribute_node(node))
    }

    /// Removes the last attribute node. Inverse: [`Editor::add_attribute_node`].
    ///
    /// # Errors
    /// Unknown ids; a node that is not the last, or that an attribute edge names. O(attributes).
    pub fn remove_attribute_node(
        &mut self,
        surface: SurfaceId,
        node: AttributeNodeId,
    ) -> Result<(), EulerError> {
        self.remove_attribute_node_as(surface, node, || Operation::RemoveAttributeNode { surface, node })
    }

    pub(super) fn remove_attribute_node_as(
        &mut self,
        surface: SurfaceId,
        node: AttributeNodeId,
        operation: impl Fn() -> Operation,
    ) -> Result<(), EulerError> {
        let s = self.body.surfaces.get(surface.index()).ok_or(EulerError::NoSurface(surface))?;
        if node.index() >= s.attribute_nodes.len() {
            return Err(AttributeError::NoNode(node).into());
        }
        let last = AttributeNodeId(s.attribute_nodes.len() as u32 - 1);
        if node != last {
            return Err(EulerError::NotLastNode { surface, node, last });
        }
        if let Some(line) = s.attribute_edges.iter().position(|l| l.nodes.contains(&node)) {
            return Err(EulerError::NodeInEdge { surface, node, line: AttributeEdgeId(line as u32) });
        }
        self.record_layer(surface, operation, |r| {
            r.change_attributes(|s| {
                s.attribute_nodes.pop();
            });
        });
        Ok(())
    }

    /// Adds an attribute edge. Inverse: [`Editor::remove_attribute_edge`].
    ///
    /// # Errors
    /// Unknown ids; nodes in a row that share no face. O(attributes).
    pub fn add_attribute_edge(
        &mut self,
        surface: SurfaceId,
        line: AttributeEdge,
    ) -> Result<AttributeEdgeId, EulerError> {
        let operation = || Operation::AddAttributeEdge { surface, line: line.clone() };
        self.add_attribute_edge_as(surface, line.clone(), operation)
    }

    pub(super) fn add_attribute_edge_as(
        &mut self,
        surface: SurfaceId,
        line: AttributeEdge,
        operation: impl Fn() -> Operation,
    ) -> Result<AttributeEdgeId, EulerError> {
        self.change_attributes(surface, operation, |s| s.add_attribute_edge(line))
    }

    /// Removes the last attribute edge; its nodes stay. Inverse: [`Editor::add_attribute_edge`].
    ///
    /// # Errors
    /// Unknown ids; an edge that is not the last. O(attributes).
    pub fn remove_attribute_edge(
        &mut self,
        surface: SurfaceId,
        line: AttributeEdgeId,
    ) -> Result<(), EulerError> {
        self.remove_attribute_edge_as(surface, line, || Operation::RemoveAttributeEdge { surface, line })
    }

    pub(super) fn remove_attribute_edge_as(
        &mut self,
        surface: SurfaceId,
        line: AttributeEdgeId,
        operation: impl Fn() -> Operation,
    ) -> Result<(), EulerError> {
        let s = self.body.surfaces.get(surface.index()).ok_or(EulerError::NoSurface(surface))?;
        if line.index() >= s.attribute_edges.len() {
            return Err(EulerError::NoAttributeEdge { surface, line });
        }
        let last = AttributeEdgeId(s.attribute_edges.len() as u32 - 1);
        if line != last {
            return Err(EulerError::NotLastEdge { surface, line, last });
        }
        self.record_layer(surface, operation, |r| {
            r.change_attributes(|s| {
                s.attribute_edges.pop();
            });
        });
        Ok(())
    }

    /// Replaces all attributes of a surface. O(attributes).
    ///
    /// # Errors
    /// Unknown surface or hosts; parameters out of range; attribute edges that leave the surface.
    pub fn set_attributes(
        &mut self,
        surface: SurfaceId,
        nodes: &[AttributeNode],
        lines: &[AttributeEdge],
    ) -> Result<(), EulerError> {
        let operation = || Operation::SetAttributes { surface, nodes: nodes.to_vec(), lines: lines.to_vec() };
        self.change_attributes(surface, operation, |s| {
            s.attribute_nodes.clear();
            s.attribute_edges.clear();
            for &node in nodes {
                s.add_attribute_node(node)?;
            }
            for line in lines {
                s.add_attribute_edge(line.clone())?;
            }
            Ok(())
        })
    }

    /// Carries out a change of attributes; where it fails half-way nothing is changed.
    fn change_attributes<T>(
        &mut self,
        surface: SurfaceId,
        operation: impl FnOnce() -> Operation,
        change: impl FnOnce(&mut Surface) -> Result<T, AttributeError>,
    ) -> Result<T, EulerError> {
        self.body.surfaces.get(surface.index()).ok_or(EulerError::NoSurface(surface))?;
        let mut made = Err(AttributeError::NoHost);
        let ((), mut delta) = self.change(surface, |r| r.change_attributes(|s| made = change(s)));
        if made.is_err() {
            delta.exchange(&mut self.body);
        } else {
            let operation = Box::new(operation());
            self.log(Record::Deltas { operation, deltas: vec![delta], stars_kept: true });
        }
        Ok(made?)
    }
}
