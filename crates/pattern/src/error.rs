//! What can be wrong with the input.

/// Why no pattern could be made. Names are those of the input.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PatternError {
    /// No patch at all.
    #[error("there is nothing to flatten: no surface has a triangle")]
    Empty,
    /// A patch without faces.
    #[error("surface {patch:?} has no triangles; remove it or give it some")]
    EmptyPatch {
        /// Name of the patch.
        patch: String,
    },
    /// NaN or infinite coordinate.
    #[error("surface {patch:?}: node {node} has a coordinate that is not a number")]
    NotFinite {
        /// Name of the patch.
        patch: String,
        /// Node.
        node: u32,
    },
    /// An index beyond the nodes.
    #[error("surface {patch:?}: {what} uses node {node}, but there are only {nodes} nodes")]
    NodeOutOfRange {
        /// Name of the patch.
        patch: String,
        /// What refers to it.
        what: String,
        /// The index.
        node: u32,
        /// Number of nodes.
        nodes: usize,
    },
    /// A face without area.
    #[error(
        "surface {patch:?}: triangle {face} at ({x:.1}, {y:.1}, {z:.1}) mm has no area; merge or remove its nodes"
    )]
    DegenerateFace {
        /// Name of the patch.
        patch: String,
        /// Face.
        face: u32,
        /// Place.
        x: f64,
        /// Place.
        y: f64,
        /// Place.
        z: f64,
    },
    /// More than two faces at an edge, or two that run through it in the same direction.
    #[error(
        "surface {patch:?}: edge {a}-{b} belongs to {faces} triangles or to two of opposite orientation; split the \
         surface there into several, joined by a seam"
    )]
    NonManifoldEdge {
        /// Name of the patch.
        patch: String,
        /// Node.
        a: u32,
        /// Node.
        b: u32,
        /// Number of faces at the edge.
        faces: usize,
    },
    /// Several fans of faces that meet in one node only.
    #[error(
        "surface {patch:?}: node {node} joins parts that share no edge there; give each part its own node"
    )]
    PinchedNode {
        /// Name of the patch.
        patch: String,
        /// Node.
        node: u32,
    },
    /// More than one connected part.
    #[error("surface {patch:?} falls into {parts} separate parts; make each a surface of its own")]
    Disconnected {
        /// Name of the patch.
        patch: String,
        /// Number of parts.
        parts: usize,
    },
    /// No boundary.
    #[error("surface {patch:?} is closed and cannot lie flat; cut it open along a line (--cut)")]
    Closed {
        /// Name of the patch.
        patch: String,
    },
    /// Handles that no cut opens.
    #[error(
        "surface {patch:?} has {handles} handle(s) like a torus, so it cannot lie flat; cut each open along a line"
    )]
    Handles {
        /// Name of the patch.
        patch: String,
        /// Genus.
        handles: usize,
    },
    /// Consecutive nodes of a line share no edge.
    #[error("{what} on surface {patch:?}: nodes {a} and {b} are not joined by an edge")]
    NotAnEdge {
        /// Name of the patch.
        patch: String,
        /// Which line.
        what: String,
        /// Node.
        a: u32,
        /// Node.
        b: u32,
    },
    /// Consecutive nodes of a cut share no edge of the mesh.
    #[error(
        "cut: nodes {} and {} of the mesh, counted from 1, are not joined by an edge; a cut names every node that it \
         passes",
        .a + 1,
        .b + 1
    )]
    CutNotAlongEdges {
        /// Node of the mesh, from 0.
        a: u32,
        /// Node of the mesh, from 0.
        b: u32,
    },
    /// A patch index beyond the patches.
    #[error("{what} names surface number {patch}, but there are {patches}")]
    NoSuchPatch {
        /// Who refers to it.
        what: String,
        /// The index.
        patch: usize,
        /// Number of patches.
        patches: usize,
    },
    /// Sides of different node counts.
    #[error("seam {seam:?}: its sides have {first} and {other} nodes; they must correspond one to one")]
    UnequalSides {
        /// Name of the seam.
        seam: String,
        /// Nodes of the first side.
        first: usize,
        /// Nodes of the other.
        other: usize,
    },
    /// A seam of one side or of sides with less than two nodes.
    #[error("seam {seam:?} needs at least two sides of two nodes each")]
    ShortSeam {
        /// Name of the seam.
        seam: String,
    },
    /// An option that makes no sense.
    #[error("{what} must be {wanted}, not {value}")]
    BadOption {
        /// Which.
        what: String,
        /// What it may be.
        wanted: String,
        /// What it is.
        value: f64,
    },
    /// A cut that separates the patch.
    #[error("the cuts separate surface {patch:?} into {parts} parts; make these surfaces of their own")]
    CutsThrough {
        /// Name of the patch.
        patch: String,
        /// Number of parts.
        parts: usize,
    },
    /// The linear solver failed: the input's scale or shape is beyond double precision.
    #[error("surface {patch:?} could not be flattened: {reason}")]
    Unsolvable {
        /// Name of the patch.
        patch: String,
        /// Why.
        reason: String,
    },
    /// Nothing is left of a piece's outline: its size is beyond what a drawing in millimetres can hold.
    #[error(
        "surface {patch:?} of {area:e} mm² has no outline that could be drawn in millimetres; say in which unit its \
         coordinates are"
    )]
    NoOutline {
        /// Name of the patch.
        patch: String,
        /// Its area in space, in mm².
        area: f64,
    },
}
