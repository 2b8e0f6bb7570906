//! Chains of edges and boundary loops.

use super::ids::{ChainId, DirectedEdge, JointId, LoopId, NONE, NodeId};

/// A run of edges of one surface (MESHEDGE).
///
/// A chain on a loop runs in the loop's direction, with the surface on its left. A chain on no loop is an *inner*
/// chain: its edges have two faces or none. A chain without edges is one node where surfaces touch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chain {
    /// Where the chain starts.
    pub(crate) start: NodeId,
    /// The edges in order, each with the direction in which the chain runs over it.
    pub(crate) edges: Vec<DirectedEdge>,
    pub(crate) on_loop: Option<LoopId>,
    pub(crate) joint: Option<JointId>,
}

impl Chain {
    /// What stands under a free number.
    pub(crate) const FREE: Self = Self { start: NodeId(NONE), edges: Vec::new(), on_loop: None, joint: None };

    pub(crate) fn is_free(&self) -> bool {
        self.start.0 == NONE
    }

    /// The first node.
    pub fn start(&self) -> NodeId {
        self.start
    }

    /// The edges in order.
    pub fn edges(&self) -> &[DirectedEdge] {
        &self.edges
    }

    /// The loop that the chain is part of; `None` for an inner chain.
    pub fn on_loop(&self) -> Option<LoopId> {
        self.on_loop
    }

    /// The joint that uses the chain.
    pub fn joint(&self) -> Option<JointId> {
        self.joint
    }
}

/// A connected portion of a surface's boundary (MESHLOOP): a cycle of chains, each starting where the one before
/// it ends, with the surface on the left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Loop {
    pub(crate) chains: Vec<ChainId>,
}

impl Loop {
    /// The chains in order.
    pub fn chains(&self) -> &[ChainId] {
        &self.chains
    }
}
