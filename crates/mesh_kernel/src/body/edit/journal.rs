//! What was done, so that it can be undone and done again, bit for bit.

use glam::DVec3;

use super::collapse_edge::Collapse;
use super::loops::Loops;
use crate::body::attribute::{AttributeEdge, AttributeNode};
use crate::body::{EdgeId, SurfaceId};

/// One operator. Its inverse needs nothing more than this and the body after it.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Record {
    /// The edge turned by a quarter. Inverse: turned back.
    SwapEdge { surface: SurfaceId, edge: EdgeId, clockwise: bool },
    /// One edge split (its partners on a joint have records of their own). Inverse: joined.
    SplitEdge {
        surface: SurfaceId,
        edge: EdgeId,
        /// The half at the edge's old end.
        second: EdgeId,
        at: f64,
        /// How many nodes, edges and faces took numbers that were free.
        reused: [u8; 3],
        more: Option<Box<SplitMore>>,
    },
    /// One edge collapsed (its partners on a joint have records of their own). Inverse: drawn out again.
    CollapseEdge(Box<Collapse>),
}

/// What few splits need.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct SplitMore {
    /// Where the node is, if that is not to be computed from the edge itself: partners on a joint share it.
    pub(super) position: Option<DVec3>,
    pub(super) attributes: Option<Attributes>,
    /// Before the split, where they had to be found anew.
    pub(super) loops: Option<Loops>,
}

/// The attributes of a surface before an operator that changed them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Attributes {
    pub(super) nodes: Vec<AttributeNode>,
    pub(super) edges: Vec<AttributeEdge>,
}

/// Operators in order, grouped to transactions.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Journal {
    pub(super) done: Vec<Record>,
    /// Length of `done` at the end of every transaction.
    pub(super) marks: Vec<usize>,
    /// Transactions undone, last first.
    pub(super) undone: Vec<Vec<Record>>,
}
