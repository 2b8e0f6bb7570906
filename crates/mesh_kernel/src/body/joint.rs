//! Joints: where surfaces meet along chains of equal length.

use super::Body;
use super::ids::{ChainId, DirectedEdge, EdgeId, JointId, SurfaceId};

/// One chain in a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JointUse {
    /// The surface.
    pub surface: SurfaceId,
    /// The chain, of that surface.
    pub chain: ChainId,
    /// Whether the chain runs against the joint's direction.
    pub reversed: bool,
}

/// Which face of an edge: the one on the left of the joint's direction or the one on the right, where left means
/// that the face's own anticlockwise turn runs along the joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// The face runs along the joint's direction.
    Left,
    /// The face runs against the joint's direction.
    Right,
}

/// One sheet that leaves a joint: a use and the side on which its faces lie. A boundary chain gives one, an inner
/// chain two, a wire none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Sheet {
    /// Index into [`Joint::uses`].
    pub use_index: u32,
    /// The side of the joint's direction.
    pub side: Side,
}

/// A non-manifold junction (MESHJOINT): chains whose edges correspond one to one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Joint {
    pub(crate) name: Option<String>,
    pub(crate) uses: Vec<JointUse>,
    pub(crate) radial: Vec<Sheet>,
}

impl Joint {
    /// The joint's name.
    pub fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// The uses, in the order in which their first sheets stand in [`Joint::radial`]; wires last.
    pub fn uses(&self) -> &[JointUse] {
        &self.uses
    }

    /// All sheets in clockwise order for one who looks along the joint, which is how the right hand's fingers turn
    /// when its thumb points along it. The order is cyclic; it starts with the sheet that was named first.
    pub fn radial(&self) -> &[Sheet] {
        &self.radial
    }
}

impl Body {
    /// Number of edges in the joint's chains.
    pub fn joint_len(&self, joint: JointId) -> usize {
        self.joint(joint).uses.first().map_or(0, |u| self.surface(u.surface).chain(u.chain).edges.len())
    }

    /// Edge `k` of use `use_index`, counted and directed along the joint.
    pub fn joint_edge(&self, joint: JointId, use_index: usize, k: usize) -> DirectedEdge {
        let u = self.joint(joint).uses[use_index];
        let edges = &self.surface(u.surface).chain(u.chain).edges;
        if u.reversed { edges[edges.len() - 1 - k].flipped() } else { edges[k] }
    }

    /// All edges of use `use_index`, in the joint's order and direction.
    pub fn joint_edges(&self, joint: JointId, use_index: usize) -> Vec<DirectedEdge> {
        let u = self.joint(joint).uses[use_index];
        let edges = &self.surface(u.surface).chain(u.chain).edges;
        if u.reversed { edges.iter().rev().map(|e| e.flipped()).collect() } else { edges.clone() }
    }

    /// Nodes of use `use_index` in the joint's direction, one to one across the uses: one more than the joint has
    /// edges. Where the chain is closed the last node is the first again. O(length).
    pub fn joint_nodes(&self, joint: JointId, use_index: usize) -> Vec<u32> {
        let u = self.joint(joint).uses[use_index];
        let mut nodes = self.surface(u.surface).chain_nodes(u.chain);
        if u.reversed {
            nodes.reverse();
        }
        nodes
    }

    /// Whether every chain of the joint is closed. (A closed chain may also lie on an open one, whose two ends another
    /// joint sews together.)
    pub fn joint_is_closed(&self, joint: JointId) -> bool {
        self.joint(joint).uses.iter().all(|u| self.surface(u.surface).chain_is_closed(u.chain))
    }

    /// Whether the joint that an edge lies on runs over it from its second node to its first. O(length of the chain).
    pub(crate) fn runs_against_joint(&self, surface: SurfaceId, edge: EdgeId) -> bool {
        let s = self.surface(surface);
        let Some(c) = s.edge_chain(edge) else { return false };
        let chain = s.chain(c);
        let along = chain.edges.iter().find(|d| d.edge() == edge).is_some_and(|d| d.is_reversed());
        let turned = chain.joint.is_some_and(|j| {
            self.joint(j).uses().iter().any(|u| (u.surface, u.chain) == (surface, c) && u.reversed)
        });
        along != turned
    }

    /// The uses of the joint that `edge` lies on, other than `edge` itself, with the edge of each that corresponds.
    /// Empty where the edge is on no joint. O(length of the chain).
    pub fn partners(&self, surface: SurfaceId, edge: EdgeId) -> Vec<(SurfaceId, DirectedEdge)> {
        let s = self.surface(surface);
        let Some(chain_id) = s.edge_chain(edge) else { return Vec::new() };
        let chain = s.chain(chain_id);
        let (Some(joint), Some(at)) = (chain.joint, chain.edges.iter().position(|d| d.edge() == edge)) else {
            return Vec::new();
        };
        let uses = &self.joint(joint).uses;
        let Some(own) = uses.iter().position(|u| u.surface == surface && u.chain == chain_id) else {
            return Vec::new();
        };
        let k = if uses[own].reversed { chain.edges.len() - 1 - at } else { at };
        (0..uses.len())
            .filter(|&i| i != own)
            .map(|i| (uses[i].surface, self.joint_edge(joint, i, k)))
            .collect()
    }
}
