//! Why models could not be merged.

/// Why models could not be merged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MergeError {
    /// A coordinate is not a finite number.
    #[error("face {face} has a coordinate that is no finite number")]
    NotFinite {
        /// The face.
        face: u32,
    },
    /// A face names a node that does not exist.
    #[error("face {face} names node {node}, but there are {nodes} nodes")]
    NodeOutOfRange {
        /// The face.
        face: u32,
        /// The node named.
        node: u32,
        /// How many there are.
        nodes: usize,
    },
    /// The surface has a border, so that nothing is inside it.
    #[error(
        "the surface of model {model} is open at the edge from {from:?} to {to:?}; close it, or merge it without asking what is inside"
    )]
    Open {
        /// The model.
        model: u32,
        /// The edge's ends, in the model's unit.
        from: [f64; 3],
        /// See `from`.
        to: [f64; 3],
    },
    /// Faces are knotted more finely than numbers can tell apart.
    #[error("{faces} faces are so entangled that they could not be parted; please report the model")]
    Tangled {
        /// Faces that still cross.
        faces: usize,
    },
    /// The caller ended it.
    #[error("cancelled")]
    Cancelled,
}
