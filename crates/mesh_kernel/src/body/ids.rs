//! Typed ids: an id of one kind cannot be used for another by mistake.
//!
//! Nodes, edges, faces, chains, loops and attributes are numbered per surface; surfaces and joints per body.
//! Numbers are dense and stay as long as the entity lives.

/// No entity: an edge's missing face.
pub const NONE: u32 = u32::MAX;

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
        )]
        #[serde(transparent)]
        pub struct $name(pub u32);

        impl $name {
            /// The id as an array index.
            #[inline]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

id!(
    /// A surface (MESHSURFACE) of a body.
    SurfaceId
);
id!(
    /// A joint (MESHJOINT) of a body.
    JointId
);
id!(
    /// A node (TRGLNODE) of a surface.
    NodeId
);
id!(
    /// An edge (TRGLEDGE) of a surface.
    EdgeId
);
id!(
    /// A face (TRGLFACE) of a surface.
    FaceId
);
id!(
    /// A chain of edges (MESHEDGE) of a surface.
    ChainId
);
id!(
    /// A boundary loop (MESHLOOP) of a surface.
    LoopId
);
id!(
    /// An attribute node (ATTRIB_EDGENODE, ATTRIB_FACENODE) of a surface.
    AttributeNodeId
);
id!(
    /// An attribute edge (ATTRIB_EDGE) of a surface.
    AttributeEdgeId
);

/// Ids in a message: `3, 7, 9`.
pub(crate) fn listed<T: std::fmt::Display>(ids: &[T]) -> String {
    ids.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

/// An edge with the direction in which a chain runs over it.
///
/// Packed: the edge's number shifted left by one, the low bit set where the chain runs from the edge's second
/// node to its first. A surface therefore holds less than 2³¹ edges.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct DirectedEdge(u32);

impl DirectedEdge {
    /// Edge `edge`, run over backwards where `reversed`.
    #[inline]
    pub fn new(edge: EdgeId, reversed: bool) -> Self {
        Self(edge.0 << 1 | u32::from(reversed))
    }

    /// The edge.
    #[inline]
    pub fn edge(self) -> EdgeId {
        EdgeId(self.0 >> 1)
    }

    /// Whether the run is from the edge's second node to its first.
    #[inline]
    pub fn is_reversed(self) -> bool {
        self.0 & 1 == 1
    }

    /// The same edge, the other way.
    #[inline]
    pub fn flipped(self) -> Self {
        Self(self.0 ^ 1)
    }
}

impl std::fmt::Debug for DirectedEdge {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}{}", if self.is_reversed() { '-' } else { '+' }, self.edge())
    }
}
