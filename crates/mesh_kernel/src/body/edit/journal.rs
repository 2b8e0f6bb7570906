//! What was done, so that it can be undone and done again, bit for bit.

use glam::DVec3;

use crate::body::attribute::{AttributeEdge, AttributeNode};
use crate::body::{EdgeId, SurfaceId};

/// One operator. Its inverse needs nothing more than this and the body after it.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Record {
    Deltas(Vec<super::delta::Delta>),
    /// The edge turned by a quarter. Inverse: turned back.
    SwapEdge {
        surface: SurfaceId,
        edge: EdgeId,
        clockwise: bool,
    },
    /// One edge split (its partners on a joint have records of their own). Inverse: joined.
    SplitEdge {
        surface: SurfaceId,
        edge: EdgeId,
        at: f64,
        position: DVec3,
        attributes: Option<Box<Attributes>>,
    },
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
