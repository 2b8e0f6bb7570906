//! Why an Euler operator was not carried out.

use crate::body::ids::listed;
use crate::body::{
    AttributeEdgeId, AttributeError, AttributeNodeId, EdgeId, FaceId, JointId, NodeId, SurfaceId,
};

/// Why an Euler operator was not carried out. Nothing is changed then.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EulerError {
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
    /// No such edge.
    #[error("surface {surface} has no edge {edge}")]
    NoEdge {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
    },
    /// No such face.
    #[error("surface {surface} has no face {face}")]
    NoFace {
        /// Surface.
        surface: SurfaceId,
        /// Face.
        face: FaceId,
    },
    /// A position is not finite.
    #[error("a position must be finite numbers")]
    NotFinite,
    /// An entity names one node twice.
    #[error("node {0} is named twice")]
    RepeatedNode(NodeId),
    /// An edge names one ring twice.
    #[error("attribute node {0} is named twice")]
    RepeatedRing(AttributeNodeId),
    /// The nodes are joined already.
    #[error("surface {surface}: edge {edge} joins these nodes already; use that one")]
    EdgeExists {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
    },
    /// Joints hold both ends together.
    #[error(
        "surface {surface}: nodes {} and {} are one node, held together by joints; an edge needs two: kill a joint \
         between them first",
        nodes[0], nodes[1]
    )]
    SameNode {
        /// Surface.
        surface: SurfaceId,
        /// The nodes.
        nodes: [NodeId; 2],
    },
    /// The three edges are no triangle.
    #[error(
        "edges {}, {} and {} of surface {surface} are no triangle: each must end where the next starts",
        edges[0], edges[1], edges[2]
    )]
    NoTriangle {
        /// Surface.
        surface: SurfaceId,
        /// The edges.
        edges: [EdgeId; 3],
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
    /// A face has the same three nodes.
    #[error(
        "face {face} of surface {surface} has the same three nodes; a second one would lie in the same place"
    )]
    FaceExists {
        /// Surface of the face that is there.
        surface: SurfaceId,
        /// The face.
        face: FaceId,
    },
    /// The edge lies on a joint.
    #[error(
        "edge {edge} of surface {surface} lies on joint {joint}; kill the joint first, and make it again after"
    )]
    EdgeOnJoint {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// Joint.
        joint: JointId,
    },
    /// The node lies on a joint.
    #[error(
        "node {node} of surface {surface} lies on joint {joint}; kill the joint first, and make it again after"
    )]
    NodeOnJoint {
        /// Surface.
        surface: SurfaceId,
        /// Node.
        node: NodeId,
        /// Joint.
        joint: JointId,
    },
    /// A joint's chain passes the face in a node.
    #[error(
        "joint {joint} runs past face {face} of surface {surface} at node {node}; without the face its chain would leave \
         the boundary loop: kill the joint first, and make it again in two parts"
    )]
    JointPassesFace {
        /// Surface.
        surface: SurfaceId,
        /// Face.
        face: FaceId,
        /// Node.
        node: NodeId,
        /// Joint.
        joint: JointId,
    },
    /// Edges stand on the node.
    #[error("edges {} of surface {surface} end in node {node}; {remedy}", listed(edges))]
    NodeHasEdges {
        /// Surface.
        surface: SurfaceId,
        /// Node.
        node: NodeId,
        /// Edges there.
        edges: Vec<EdgeId>,
        /// What to do.
        remedy: &'static str,
    },
    /// No edge stands on the node.
    #[error("no edge of surface {surface} ends in node {node}; kill it with kill_vertex_complex")]
    NodeAlone {
        /// Surface.
        surface: SurfaceId,
        /// Node.
        node: NodeId,
    },
    /// The edge has faces.
    #[error("faces {} of surface {surface} have edge {edge} as a side; {remedy}", listed(faces))]
    EdgeHasFaces {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// Its faces.
        faces: Vec<FaceId>,
        /// What to do.
        remedy: &'static str,
    },
    /// The edge closes a cycle.
    #[error(
        "nodes {} and {} of surface {surface} are connected without the edge, which so closes a cycle; use the \
         operator for holes (…_edge_chole)",
        nodes[0], nodes[1]
    )]
    ClosesCycle {
        /// Surface.
        surface: SurfaceId,
        /// Ends of the edge.
        nodes: [NodeId; 2],
    },
    /// The edge joins two complexes.
    #[error(
        "nodes {} and {} of surface {surface} are connected by nothing but the edge, which so joins two complexes; use \
         the operator for complexes (make_edge_kill_complex, kill_edge_make_complex)",
        nodes[0], nodes[1]
    )]
    JoinsComplexes {
        /// Surface.
        surface: SurfaceId,
        /// Ends of the edge.
        nodes: [NodeId; 2],
    },
    /// The face fills a hole.
    #[error(
        "the face of nodes {}, {}, {} of surface {surface} has one region on both sides: it fills a hole; use the \
         operator for holes (make_face_kill_chole, kill_face_make_chole)",
        nodes[0], nodes[1], nodes[2]
    )]
    FillsHole {
        /// Surface.
        surface: SurfaceId,
        /// Corners of the face.
        nodes: [NodeId; 3],
    },
    /// The face closes a cavity.
    #[error(
        "the face of nodes {}, {}, {} of surface {surface} parts two regions: it closes a cavity; use the operator for \
         cavities (make_face_make_cavity, kill_face_kill_cavity)",
        nodes[0], nodes[1], nodes[2]
    )]
    ClosesCavity {
        /// Surface.
        surface: SurfaceId,
        /// Corners of the face.
        nodes: [NodeId; 3],
    },
    /// A parameter that is not inside the edge.
    #[error("an edge is split at a parameter between 0 and 1, not at {0}")]
    Parameter(f64),
    /// The two edges at a node would become one that is there already.
    #[error(
        "surface {surface}: merged at node {node} the edges would join nodes that edge {edge} joins already; kill that \
         edge first"
    )]
    MergeExists {
        /// Surface.
        surface: SurfaceId,
        /// Node.
        node: NodeId,
        /// The edge that is there.
        edge: EdgeId,
    },
    /// Attributes lie on the entity.
    #[error(
        "{what} of surface {surface} carries attributes; remove them first or triangulate them into edges"
    )]
    CarriesAttributes {
        /// Surface.
        surface: SurfaceId,
        /// The entity.
        what: String,
    },
    /// An attribute was not taken.
    #[error(transparent)]
    Attribute(#[from] AttributeError),
    /// An attribute node that is no ring: it lies on an edge.
    #[error("attribute node {node} of surface {surface} lies on an edge, not inside a face: it is no ring")]
    NoRing {
        /// Surface.
        surface: SurfaceId,
        /// The attribute node.
        node: AttributeNodeId,
    },
    /// An attribute edge that does not join two rings.
    #[error("attribute edge {line} of surface {surface} is not an edge between two rings")]
    NoRingEdge {
        /// Surface.
        surface: SurfaceId,
        /// The attribute edge.
        line: AttributeEdgeId,
    },
    /// No such attribute edge.
    #[error("surface {surface} has no attribute edge {line}")]
    NoAttributeEdge {
        /// Surface.
        surface: SurfaceId,
        /// The attribute edge.
        line: AttributeEdgeId,
    },
    /// Attributes are removed from the end.
    #[error(
        "surface {surface}: attribute node {node} is not the last, which is {last}; remove those after it first, or set \
         all attributes anew"
    )]
    NotLastNode {
        /// Surface.
        surface: SurfaceId,
        /// The attribute node.
        node: AttributeNodeId,
        /// The last one.
        last: AttributeNodeId,
    },
    /// Attributes are removed from the end.
    #[error(
        "surface {surface}: attribute edge {line} is not the last, which is {last}; remove those after it first, or set \
         all attributes anew"
    )]
    NotLastEdge {
        /// Surface.
        surface: SurfaceId,
        /// The attribute edge.
        line: AttributeEdgeId,
        /// The last one.
        last: AttributeEdgeId,
    },
    /// An attribute edge names the node.
    #[error("attribute edge {line} of surface {surface} runs through attribute node {node}; remove it first")]
    NodeInEdge {
        /// Surface.
        surface: SurfaceId,
        /// The attribute node.
        node: AttributeNodeId,
        /// The attribute edge.
        line: AttributeEdgeId,
    },
    /// Ids would run out.
    #[error("surface {0} has no ids left")]
    TooLarge(SurfaceId),
}
