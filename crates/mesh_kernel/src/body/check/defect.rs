//! What can be wrong with a body, with the values measured.

use glam::DVec3;

use crate::body::{
    AttributeEdgeId, AttributeNodeId, ChainId, Counts, EdgeId, FaceId, JointId, LoopId, NodeId, Sheet,
    SurfaceId,
};

/// A broken rule. [`std::fmt::Display`] says it in words; [`Defect::code`] names its kind.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Defect {
    /// An array of a surface has not one entry an entity.
    #[error("surface {surface}: {array} has {len} entries for {expected}")]
    ArrayLength {
        /// Surface.
        surface: SurfaceId,
        /// Which array.
        array: &'static str,
        /// Its length.
        len: usize,
        /// The length that it should have.
        expected: usize,
    },
    /// A number is given as free and is not, or is free and not given as such, or is given twice.
    #[error("{}{what} {id} is free in one list and taken in another", surface.map_or(String::new(), |s| format!("surface {s}: ")))]
    FreeNumber {
        /// Surface; none for joints.
        surface: Option<SurfaceId>,
        /// The kind of entity.
        what: &'static str,
        /// The number.
        id: u32,
    },
    /// An id names nothing.
    #[error("{of} names {what} {id}, which is free or not below {limit}")]
    UnknownId {
        /// The entity that names it, in words.
        of: String,
        /// The kind of the entity named.
        what: &'static str,
        /// The number named.
        id: u32,
        /// How many there are.
        limit: usize,
    },
    /// An edge joins a node with itself.
    #[error("surface {surface}: edge {edge} joins node {node} with itself")]
    EdgeOfOneNode {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// Node.
        node: NodeId,
    },
    /// A face names a node twice.
    #[error("surface {surface}: face {face} has corners {nodes:?}, one of them twice")]
    RepeatedCorner {
        /// Surface.
        surface: SurfaceId,
        /// Face.
        face: FaceId,
        /// Corners.
        nodes: [u32; 3],
    },
    /// Side and corners of a face disagree.
    #[error(
        "surface {surface}: side {side} of face {face} is edge {edge} {edge_nodes:?}, but joins corners {corners:?}"
    )]
    SideNodes {
        /// Surface.
        surface: SurfaceId,
        /// Face.
        face: FaceId,
        /// Side.
        side: usize,
        /// Edge.
        edge: EdgeId,
        /// Nodes of the edge.
        edge_nodes: [u32; 2],
        /// Corners of the side.
        corners: [u32; 2],
    },
    /// A face names an edge that does not name it.
    #[error("surface {surface}: face {face} has edge {edge}, but the edge has faces {faces:?} (left, right)")]
    FaceNotOnEdge {
        /// Surface.
        surface: SurfaceId,
        /// Face.
        face: FaceId,
        /// Edge.
        edge: EdgeId,
        /// Its left and right faces.
        faces: [u32; 2],
    },
    /// An edge names a face that does not have it.
    #[error("surface {surface}: edge {edge} names face {face}, which has edges {sides:?}")]
    EdgeNotInFace {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// Face.
        face: FaceId,
        /// Edges of the face.
        sides: [u32; 3],
    },
    /// A face runs over an edge in the direction of its other side: it is wound against its neighbour.
    #[error(
        "surface {surface}: face {face} lies on the wrong side of edge {edge}: it is wound against its neighbours"
    )]
    Orientation {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// Face.
        face: FaceId,
    },
    /// Two edges of a surface join the same nodes, and no joint makes them one.
    #[error("surface {surface}: edges {} and {} both join nodes {nodes:?}", edges[0], edges[1])]
    DuplicateEdge {
        /// Surface.
        surface: SurfaceId,
        /// The edges.
        edges: [EdgeId; 2],
        /// Their nodes.
        nodes: [u32; 2],
    },
    /// Edges of a chain do not follow each other.
    #[error(
        "surface {surface}: edge {at} of chain {chain} starts at node {found}, the chain has come to node {expected}"
    )]
    ChainBroken {
        /// Surface.
        surface: SurfaceId,
        /// Chain.
        chain: ChainId,
        /// Position in the chain.
        at: usize,
        /// Where the chain had come.
        expected: NodeId,
        /// Where the edge starts.
        found: NodeId,
    },
    /// An edge and a chain disagree on whether it is the chain's.
    #[error("surface {surface}: edge {edge} says chain {recorded:?}, but is in chains {found:?}")]
    EdgeChain {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// The chain that the edge names.
        recorded: Option<ChainId>,
        /// The chains that hold it.
        found: Vec<ChainId>,
    },
    /// A chain on a loop has an edge that is no boundary with the face on the left, or one on no loop has a boundary edge.
    #[error(
        "surface {surface}: edge {edge} of chain {chain} has faces {faces:?} (left, right), which does not fit {place}"
    )]
    ChainPlace {
        /// Surface.
        surface: SurfaceId,
        /// Chain.
        chain: ChainId,
        /// Edge.
        edge: EdgeId,
        /// Its faces.
        faces: [u32; 2],
        /// A loop, or inside.
        place: &'static str,
    },
    /// A loop does not close, or leaps from one boundary to another.
    #[error(
        "surface {surface}: loop {cycle} goes from edge {from} to edge {to}, but the boundary goes on to {expected:?}"
    )]
    LoopOpen {
        /// Surface.
        surface: SurfaceId,
        /// Loop.
        cycle: LoopId,
        /// The edge before the leap.
        from: EdgeId,
        /// The edge after it.
        to: EdgeId,
        /// The edge that follows on the boundary.
        expected: Option<EdgeId>,
    },
    /// A chain and the loops disagree on whose it is.
    #[error("surface {surface}: chain {chain} says loop {recorded:?}, but is in loops {found:?}")]
    ChainLoop {
        /// Surface.
        surface: SurfaceId,
        /// Chain.
        chain: ChainId,
        /// The loop that the chain names.
        recorded: Option<LoopId>,
        /// The loops that hold it.
        found: Vec<LoopId>,
    },
    /// A boundary edge on no loop.
    #[error("surface {surface}: boundary edge {edge} is on no loop")]
    BoundaryNotInLoop {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
    },
    /// A joint with less than two uses.
    #[error("joint {joint} has {uses} uses; it needs two")]
    TooFewUses {
        /// Joint.
        joint: JointId,
        /// How many.
        uses: usize,
    },
    /// Chains of a joint differ in length.
    #[error("joint {joint}: its chains have {lengths:?} edges")]
    JointLength {
        /// Joint.
        joint: JointId,
        /// Edges of every use.
        lengths: Vec<usize>,
    },
    /// A chain and the joints disagree on whose it is.
    #[error("surface {surface}: chain {chain} says joint {recorded:?}, but is in joints {found:?}")]
    ChainJoint {
        /// Surface.
        surface: SurfaceId,
        /// Chain.
        chain: ChainId,
        /// The joint that the chain names.
        recorded: Option<JointId>,
        /// The joints that hold it.
        found: Vec<JointId>,
    },
    /// A use runs against the joint: turned round, its nodes would coincide.
    #[error("joint {joint}: use {use_index} has the wrong direction flag")]
    JointDirection {
        /// Joint.
        joint: JointId,
        /// Use.
        use_index: usize,
    },
    /// Corresponding nodes do not have the same position.
    #[error("joint {joint}: node {at} of use {use_index} (node {node}) is {distance} mm from that of use 0")]
    JointApart {
        /// Joint.
        joint: JointId,
        /// Use.
        use_index: usize,
        /// Position along the joint.
        at: usize,
        /// The node.
        node: NodeId,
        /// Distance, in millimetres.
        distance: f64,
    },
    /// The radial order does not list every sheet once, or the uses do not stand in the order of their first sheets.
    #[error("joint {joint}: the radial order lists {stored:?}, the sheets are {found:?}")]
    RadialSheets {
        /// Joint.
        joint: JointId,
        /// Sheets stored.
        stored: Vec<Sheet>,
        /// Sheets that leave the joint, by use and side.
        found: Vec<Sheet>,
    },
    /// The stored radial order is not the one that geometry has.
    #[error(
        "joint {joint}: on {edges} of its edges, first {at}, the sheets stand as {geometric:?}, stored is {stored:?}"
    )]
    RadialOrder {
        /// Joint.
        joint: JointId,
        /// First edge where they differ.
        at: usize,
        /// Number of edges where they differ.
        edges: usize,
        /// The order stored.
        stored: Vec<Sheet>,
        /// The order at that edge.
        geometric: Vec<Sheet>,
    },
    /// A parameter of an attribute node is out of range.
    #[error(
        "surface {surface}: attribute node {node} has parameters {parameters:?}: 0 to 1, areal coordinates with sum 1"
    )]
    AttributeRange {
        /// Surface.
        surface: SurfaceId,
        /// Attribute node.
        node: AttributeNodeId,
        /// Its parameters.
        parameters: Vec<f64>,
    },
    /// Two nodes in a row of an attribute edge share no face.
    #[error("surface {surface}: nodes {at} and the next of attribute edge {line} share no face")]
    AttributeApart {
        /// Surface.
        surface: SurfaceId,
        /// Attribute edge.
        line: AttributeEdgeId,
        /// Position of the first.
        at: usize,
    },
    /// A coordinate is not a finite number.
    #[error("surface {surface}: the {layer} position of node {node} is {position}")]
    NotFinite {
        /// Surface.
        surface: SurfaceId,
        /// Node.
        node: NodeId,
        /// Spatial, backup or planar.
        layer: &'static str,
        /// The position.
        position: DVec3,
    },
    /// Corners of a face lie on one line.
    #[error("surface {surface}: the corners of face {face} lie on one line (area {area} mm²)")]
    DegenerateFace {
        /// Surface.
        surface: SurfaceId,
        /// Face.
        face: FaceId,
        /// Its computed area, in mm².
        area: f64,
    },
    /// An edge without faces has no length.
    #[error("surface {surface}: edge {edge}, which has no face, has no length")]
    EdgeWithoutLength {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
    },
    /// Two faces have the same three nodes.
    #[error(
        "face {} of surface {} and face {} of surface {} have the same corners", faces[0], surfaces[0], faces[1],
        surfaces[1]
    )]
    DuplicateFace {
        /// Their surfaces.
        surfaces: [SurfaceId; 2],
        /// The faces.
        faces: [FaceId; 2],
    },
    /// The Euler–Poincaré identity does not hold.
    #[error("the counts do not agree: {0}; sheets pass through each other or the radial order is wrong")]
    Identity(Counts),
}

impl Defect {
    /// The kind of defect, for reports: a fixed word.
    pub fn code(&self) -> &'static str {
        match self {
            Self::ArrayLength { .. } => "array_length",
            Self::FreeNumber { .. } => "free_number",
            Self::UnknownId { .. } => "unknown_id",
            Self::EdgeOfOneNode { .. } => "edge_of_one_node",
            Self::RepeatedCorner { .. } => "repeated_corner",
            Self::SideNodes { .. } => "side_nodes",
            Self::FaceNotOnEdge { .. } => "face_not_on_edge",
            Self::EdgeNotInFace { .. } => "edge_not_in_face",
            Self::Orientation { .. } => "orientation",
            Self::DuplicateEdge { .. } => "duplicate_edge",
            Self::ChainBroken { .. } => "chain_broken",
            Self::EdgeChain { .. } => "edge_chain",
            Self::ChainPlace { .. } => "chain_place",
            Self::LoopOpen { .. } => "loop_open",
            Self::ChainLoop { .. } => "chain_loop",
            Self::BoundaryNotInLoop { .. } => "boundary_not_in_loop",
            Self::TooFewUses { .. } => "too_few_uses",
            Self::JointLength { .. } => "joint_length",
            Self::ChainJoint { .. } => "chain_joint",
            Self::JointDirection { .. } => "joint_direction",
            Self::JointApart { .. } => "joint_apart",
            Self::RadialSheets { .. } => "radial_sheets",
            Self::RadialOrder { .. } => "radial_order",
            Self::AttributeRange { .. } => "attribute_range",
            Self::AttributeApart { .. } => "attribute_apart",
            Self::NotFinite { .. } => "not_finite",
            Self::DegenerateFace { .. } => "degenerate_face",
            Self::EdgeWithoutLength { .. } => "edge_without_length",
            Self::DuplicateFace { .. } => "duplicate_face",
            Self::Identity(_) => "identity",
        }
    }
}
