//! What was done, so that it can be undone and done again, bit for bit.

use glam::DVec3;

use super::collapse_edge::Collapse;
use super::delta::Delta;
use super::loops::Loops;
use super::operation::Operation;
use super::swap_edge::Guard;
use super::whole::Whole;
use crate::body::attribute::{AttributeEdge, AttributeNode};
use crate::body::{EdgeId, Surface, SurfaceId};

/// One operator. Its inverse needs nothing more than this and the body after it.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Record {
    /// The edge turned by a quarter. Inverse: turned back.
    SwapEdge { surface: SurfaceId, edge: EdgeId, attributes: Option<Box<Attributes>> },
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
    /// A record that belongs to the operator of the one before, as a partner on a joint.
    Following(Box<Record>),
    /// Changes to surfaces; its inverse is to exchange them.
    Deltas { operation: Box<Operation>, deltas: Vec<Delta>, stars_kept: bool },
    /// Whole surfaces and joints exchanged.
    Whole { operation: Box<Operation>, whole: Box<Whole> },
    /// A surface put at the end (nothing kept), or taken off it (kept).
    Surface { operation: Box<Operation>, surface: Option<Box<Surface>> },
}

impl Record {
    /// The operation whose first, or only, record this is.
    fn operation(&self) -> Option<Operation> {
        match self {
            // The guard has been passed; replay needs none.
            Self::SwapEdge { surface, edge, .. } => {
                Some(Operation::SwapEdge { surface: *surface, edge: *edge, guard: Guard::None })
            }
            Self::SplitEdge { surface, edge, at, .. } => {
                Some(Operation::SplitEdge { surface: *surface, edge: *edge, at: *at })
            }
            Self::CollapseEdge(collapse) => Some(collapse.operation()),
            Self::Following(_) => None,
            Self::Deltas { operation, .. }
            | Self::Whole { operation, .. }
            | Self::Surface { operation, .. } => Some((**operation).clone()),
        }
    }
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

impl Attributes {
    pub(super) fn of(s: &Surface) -> Self {
        Self { nodes: s.attribute_nodes.clone(), edges: s.attribute_edges.clone() }
    }

    pub(super) fn restore(&self, s: &mut Surface) {
        s.attribute_nodes.clone_from(&self.nodes);
        s.attribute_edges.clone_from(&self.edges);
    }
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

impl Journal {
    pub(super) fn operations(&self) -> Vec<Operation> {
        let starts = std::iter::once(0).chain(self.marks.iter().copied());
        let steps = starts.zip(&self.marks).map(|(from, &to)| &self.done[from..to]);
        steps
            .filter_map(|records| {
                let mut group: Vec<Operation> = records.iter().filter_map(Record::operation).collect();
                if group.len() > 1 { Some(Operation::Group(group)) } else { group.pop() }
            })
            .collect()
    }
}
