//! Bodies built up step by step: nodes that stand alone, wires, single faces, joints.
//!
//! A surface is sound at every step (K1: it may be *incomplete*), so a designer can stop anywhere. Whole patches are made
//! faster by [`Body::build`].

use glam::{DVec2, DVec3};

use super::Body;
use super::build::{BuildError, JointLabel, JointSpec, LoopPlaces, make_loop, place_run, run_of};
use super::ids::{EdgeId, FaceId, JointId, NONE, NodeId, SurfaceId};
use super::joint::Joint;
use super::surface::{NO_CHAIN, Surface};

/// Why an entity was not added. Nothing is changed then.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AddError {
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
    #[error("a position must be finite numbers")]
    NotFinite,
    /// An entity names one node twice.
    #[error("node {0} is named twice")]
    RepeatedNode(NodeId),
    /// The nodes are joined already.
    #[error("surface {surface}: edge {edge} joins these nodes already")]
    EdgeExists {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
    },
    /// A face runs over the edge in this direction already.
    #[error(
        "surface {surface}: face {face} runs over edge {edge} in the same direction; turn the new face round"
    )]
    SideTaken {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// The face there.
        face: FaceId,
    },
    /// The edge lies on a joint, which a further face would change.
    #[error("surface {surface}: edge {edge} lies on joint {joint}; make faces before their joints")]
    EdgeOnJoint {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// Joint.
        joint: JointId,
    },
}

impl Body {
    /// Adds an empty surface.
    pub fn add_surface(&mut self, name: &str) -> SurfaceId {
        self.surfaces.push(Surface { name: name.into(), ..Surface::default() });
        SurfaceId(self.surfaces.len() as u32 - 1)
    }

    fn checked(&self, surface: SurfaceId, nodes: &[NodeId]) -> Result<&Surface, AddError> {
        let s = self.surfaces.get(surface.index()).ok_or(AddError::NoSurface(surface))?;
        for (i, &node) in nodes.iter().enumerate() {
            if node.index() >= s.positions.len() {
                return Err(AddError::NoNode { surface, node });
            }
            if nodes[..i].contains(&node) {
                return Err(AddError::RepeatedNode(node));
            }
        }
        Ok(s)
    }

    /// Adds a node that stands alone. Backup and planar positions, where the surface has them, get the position and zero.
    ///
    /// # Errors
    /// Unknown surface; a position that is not finite.
    pub fn add_node(&mut self, surface: SurfaceId, position: DVec3) -> Result<NodeId, AddError> {
        self.checked(surface, &[])?;
        if !position.is_finite() {
            return Err(AddError::NotFinite);
        }
        let s = self.surface_mut(surface);
        if s.backup().is_some() {
            s.backup.push(position);
        }
        if s.planar().is_some() {
            s.planar.push(DVec2::ZERO);
        }
        s.positions.push(position);
        Ok(NodeId(s.positions.len() as u32 - 1))
    }

    /// Adds an edge without faces, from `a` to `b`.
    ///
    /// # Errors
    /// Unknown ids; one node twice; an edge that is there. O(edges).
    pub fn add_edge(&mut self, surface: SurfaceId, a: NodeId, b: NodeId) -> Result<EdgeId, AddError> {
        let s = self.checked(surface, &[a, b])?;
        if let Some(edge) = s.find_edge(a, b) {
            return Err(AddError::EdgeExists { surface, edge });
        }
        Ok(self.surface_mut(surface).push_edge(a, b))
    }

    /// Adds a face with corners `nodes`, anticlockwise seen from outside; edges that are missing are made. The surface's
    /// boundary loops are found anew, and with them its chains on no joint.
    ///
    /// # Errors
    /// Unknown ids; one node twice; an edge that a face runs over in the same direction, or that lies on a joint. O(faces).
    pub fn add_face(&mut self, surface: SurfaceId, nodes: [NodeId; 3]) -> Result<FaceId, AddError> {
        let s = self.checked(surface, &nodes)?;
        let sides = [0, 1, 2].map(|i| (nodes[i], nodes[(i + 1) % 3]));
        for (a, b) in sides {
            let Some(edge) = s.find_edge(a, b) else { continue };
            let face = s.edge_faces[edge.index()][usize::from(s.edges[edge.index()][0] != a.0)];
            if face != NONE {
                return Err(AddError::SideTaken { surface, edge, face: FaceId(face) });
            }
            if let Some(joint) = s.edge_chain(edge).and_then(|c| s.chain(c).joint) {
                return Err(AddError::EdgeOnJoint { surface, edge, joint });
            }
        }
        let s = self.surface_mut(surface);
        let face = FaceId(s.faces.len() as u32);
        let edges = sides.map(|(a, b)| {
            let edge = s.find_edge(a, b).unwrap_or_else(|| s.push_edge(a, b));
            s.edge_faces[edge.index()][usize::from(s.edges[edge.index()][0] != a.0)] = face.0;
            edge.0
        });
        s.faces.push(nodes.map(|v| v.0));
        s.face_edges.push(edges);
        s.drop_loops();
        s.find_loops();
        Ok(face)
    }

    /// Adds a joint. Boundary loops of its surfaces are cut anew, and with them their chains on no joint.
    ///
    /// # Errors
    /// As [`Body::build`]. Nothing is changed then. O(faces of its surfaces).
    pub fn add_joint(&mut self, spec: &JointSpec) -> Result<JointId, BuildError> {
        let id = JointId(self.joints.len() as u32);
        let mut labels: Vec<JointLabel> = self
            .joints
            .iter()
            .enumerate()
            .map(|(index, j)| JointLabel { index, name: j.name.clone() })
            .collect();
        let label = JointLabel { index: id.index(), name: spec.name.clone() };
        labels.push(label.clone());
        if spec.chains.len() < 2 {
            return Err(BuildError::TooFew { joint: label });
        }
        if let Some(chain) = spec.chains.iter().find(|c| c.surface >= self.surfaces.len()) {
            return Err(BuildError::NoSurface { joint: label, surface: chain.surface });
        }
        let mut touched: Vec<usize> = spec.chains.iter().map(|c| c.surface).collect();
        touched.sort_unstable();
        touched.dedup();
        let mut next = self.clone();
        for &s in &touched {
            next.surfaces[s].drop_loops();
        }
        let mut lengths = Vec::new();
        let mut uses = Vec::new();
        for chain in &spec.chains {
            let surface = &mut next.surfaces[chain.surface];
            let run = run_of(surface, &surface.edge_index(), chain, &label)?;
            lengths.push(run.edges.len());
            let places = LoopPlaces::new(surface.edges.len(), &surface.boundary_cycles());
            uses.push(place_run(surface, &places, run, id.index(), &labels)?);
        }
        if lengths.iter().any(|&n| n != lengths[0]) {
            return Err(BuildError::Lengths { joint: label, lengths });
        }
        for &s in &touched {
            next.surfaces[s].find_loops();
        }
        next.joints.push(Joint { name: spec.name.clone(), uses, radial: Vec::new() });
        next.meet(&labels)?;
        next.order_joint(id);
        *self = next;
        Ok(id)
    }
}

impl Surface {
    fn push_edge(&mut self, a: NodeId, b: NodeId) -> EdgeId {
        self.edges.push([a.0, b.0]);
        self.edge_faces.push([NONE; 2]);
        self.edge_chain.push(NO_CHAIN);
        EdgeId(self.edges.len() as u32 - 1)
    }

    /// Forgets loops and the chains on no joint, which come last: chains of joints keep their numbers.
    pub(crate) fn drop_loops(&mut self) {
        let last = self.chains.iter().rposition(|c| c.joint.is_some()).map_or(0, |i| i + 1);
        let free = self.slots.chains.free().iter().max().map_or(0, |&i| i as usize + 1);
        for chain in self.chains.drain(last.max(free)..) {
            for d in chain.edges {
                self.edge_chain[d.edge().index()] = NO_CHAIN;
            }
        }
        debug_assert!(
            self.chains.iter().all(|c| c.joint.is_some() || c.is_free()),
            "chains of joints come first"
        );
        self.chains.iter_mut().for_each(|c| c.on_loop = None);
        self.loops.clear();
    }

    /// Finds boundary loops and cuts them at the chains of joints.
    pub(crate) fn find_loops(&mut self) {
        for cycle in self.boundary_cycles() {
            make_loop(self, &cycle);
        }
    }
}
