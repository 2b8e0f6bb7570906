//! Why an edge is not collapsed.

use glam::DVec3;

use crate::body::edit::link_condition::Obstacle;
use crate::body::ids::listed;
use crate::body::{EdgeId, FaceId, JointId, NodeId, SurfaceId};

/// Why an edge was not collapsed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CollapseError {
    /// No such edge.
    #[error("surface {surface} has no edge {edge}")]
    NoEdge {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
    },
    /// The node to keep is not on the edge.
    #[error("node {node} is no end of edge {edge} of surface {surface}; keep one of {}, {}", ends[0], ends[1])]
    NotAnEnd {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// Its ends.
        ends: [NodeId; 2],
        /// The node named.
        node: NodeId,
    },
    /// A parameter that is not on the edge.
    #[error("the kept node goes to a parameter from 0 to 1 of the edge, not to {0}")]
    Parameter(f64),
    /// The place where the kept node would go is no finite number.
    #[error("the kept node of edge {edge} of surface {surface} would go to {position}, which is not finite")]
    NotFinite {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// The place.
        position: DVec3,
    },
    /// Joints that do not run along the edge hold the node that would be removed.
    #[error(
        "node {removed} of surface {surface} is held by joints {}, which would lose it; keep it and remove node \
         {kept} instead",
        listed(joints)
    )]
    HeldByJoints {
        /// Surface.
        surface: SurfaceId,
        /// The node that would be removed.
        removed: NodeId,
        /// The other end.
        kept: NodeId,
        /// Joints at it.
        joints: Vec<JointId>,
    },
    /// The same at both ends.
    #[error(
        "both ends of edge {edge} of surface {surface} are held by joints {} that do not run along it; take one \
         end off its joints first",
        listed(joints)
    )]
    BothHeld {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// Joints at the ends.
        joints: Vec<JointId>,
    },
    /// The joint would have too few edges left.
    #[error(
        "joint {joint} has {edges} edges; an open joint keeps one at least, a closed one three. Split one of its edges \
         first, or remove the joint"
    )]
    JointTooShort {
        /// Joint.
        joint: JointId,
        /// Edges that it has.
        edges: usize,
    },
    /// The boundary loop would have too few edges left.
    #[error(
        "the boundary loop of surface {surface} at edge {edge} has {edges} edges and needs three; fill it or split one"
    )]
    LoopTooShort {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// Edges that it has.
        edges: usize,
    },
    /// The body's shape would change.
    #[error(
        "edge {edge} of surface {surface} cannot be collapsed without changing the shape: {obstacle}; split or swap edges near it first"
    )]
    Shape {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// What is in the way.
        obstacle: Obstacle,
    },
    /// A face would be turned over or degenerate.
    #[error("collapsing edge {edge} would turn face {face} of surface {surface} over or flatten it")]
    Turns {
        /// Surface of the face.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// Face.
        face: FaceId,
    },
    /// An attribute line would no longer lie on the surface.
    #[error(
        "edge {edge} of surface {surface} carries attributes that collapsing would tear; triangulate them into edges first"
    )]
    CarriesAttributes {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
    },
}
