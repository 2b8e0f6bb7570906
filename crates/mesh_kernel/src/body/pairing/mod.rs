//! 'Touch and join' or 'touch but miss': what a non-manifold edge or node means, chosen by the caller (K6).
//!
//! At a joint where faces bound material, entering and leaving alternate (Stroud & Nagy, fig. 6.5), so sheets can be
//! paired in two ways, and a star of sheets does not say which is meant (figs. 6.6–6.8):
//!
//! ```text
//!     1 \  empty  / 4           1 \       / 4          1 \     / 4
//!        \       /                 \     /                \   /
//!         \     /                   \   /                  \ /
//! material  ●  material    material  ● ●  material  material ● material
//!         /     \                   /   \                   ●
//!        /       \                 /     \                 / \
//!     2 /  empty  \ 3           2 /       \ 3          2 /     \ 3
//!         star                miss: (1 2) (3 4)      join: (4 1) (2 3)
//! ```
//!
//! *Miss*: the two sheets of a material sector get an edge of their own, so the bodies only touch. *Join*: the two
//! sheets of an empty sector do, so the material is one across the edge. At a node the fans of faces that share it are
//! told apart, with what lies between them.
//!
//! [`Body::edge_pairings`] and [`Body::node_fans`] report, [`Body::resolve_edge`] and [`Body::resolve_node`] act.

mod fans;
mod locate;
mod recut;
mod resolve_edge;
mod resolve_node;

pub use fans::{Contact, Fan, FanKind, NodeFans, Through};

use super::build::BuildError;
use super::counts::Counts;
use super::ids::{AttributeEdgeId, JointId, NodeId, SurfaceId};
use super::joint::{Sheet, Side};
use super::sectors::Crossing;
use super::{Body, JointUse};

/// What is meant where sheets meet at a non-manifold edge or node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Pairing {
    /// Touch and join: material is one across the edge or through the node.
    Join,
    /// Touch but miss: what touches stays apart; empty space is one across the edge or through the node.
    Miss,
}

/// The two ways to pair the sheets of a joint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EdgePairings {
    /// The joint.
    pub joint: JointId,
    /// Sheets that bound the same material sector, in radial order: first the one where one enters. Pairing these makes
    /// the bodies miss each other.
    pub material: Vec<[Sheet; 2]>,
    /// Sheets that bound the same empty sector, in radial order: first the one where one leaves. Pairing these joins the
    /// material.
    pub empty: Vec<[Sheet; 2]>,
}

impl EdgePairings {
    /// The pairs that share an edge after [`Body::resolve_edge`] with that choice.
    pub fn pairs(&self, pairing: Pairing) -> &[[Sheet; 2]] {
        match pairing {
            Pairing::Miss => &self.material,
            Pairing::Join => &self.empty,
        }
    }
}

/// A body in which an edge or a node has been resolved.
#[derive(Clone, Debug, PartialEq)]
pub struct Resolution {
    /// The body. Surfaces, nodes, edges and faces keep their ids; copies come after them. Chains and loops are numbered
    /// anew, and joints without gaps.
    pub body: Body,
    /// New id of every joint that there was, `None` where it is gone.
    pub joints: Vec<Option<JointId>>,
    /// Joints of two sheets that took the place of the one resolved.
    pub pairs: Vec<JointId>,
    /// Joints without edges that hold together what still touches at a node.
    pub touching: Vec<JointId>,
    /// Counts before.
    pub before: Counts,
    /// Counts after.
    pub after: Counts,
}

/// Why sheets cannot be paired. Nothing is changed then.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PairingError {
    /// No such joint.
    #[error("the body has no joint {0}")]
    NoJoint(JointId),
    /// No such node.
    #[error("surface {surface} has no node {node}")]
    NoNode {
        /// Surface.
        surface: SurfaceId,
        /// Node.
        node: NodeId,
    },
    /// The joint has no edges.
    #[error("joint {joint} has no edges, its surfaces touch at a node: resolve the node")]
    NoEdges {
        /// Joint.
        joint: JointId,
    },
    /// A use of the joint has no face, so nothing says which pair it belongs to.
    #[error("joint {joint}: surface {} has a wire there; remove it from the joint first", wire.surface)]
    Wire {
        /// Joint.
        joint: JointId,
        /// The use.
        wire: JointUse,
    },
    /// Two sheets can be paired in one way only.
    #[error("joint {joint} has two sheets and needs no choice")]
    Manifold {
        /// Joint.
        joint: JointId,
    },
    /// An odd number of sheets bounds no material.
    #[error(
        "joint {joint} has {} sheets, an odd number, so they bound no material and cannot be paired: {sheets:?}",
        sheets.len()
    )]
    Odd {
        /// Joint.
        joint: JointId,
        /// Its sheets in radial order.
        sheets: Vec<Sheet>,
    },
    /// Two sheets in a row enter, or leave: material within material.
    #[error(
        "joint {joint}: going round it one {} at two sheets in a row, {sheets:?}: material lies within material; \
         turn one of the surfaces round or cut them apart",
        match crossing { Crossing::Enters => "enters", Crossing::Leaves => "leaves" }
    )]
    InARow {
        /// Joint.
        joint: JointId,
        /// What one does twice.
        crossing: Crossing,
        /// The sheets, in radial order.
        sheets: [Sheet; 2],
    },
    /// The two edges of a pair would join the same nodes of a surface.
    #[error(
        "joint {joint}: cut apart, surface {surface} would have two edges between its nodes {nodes:?}; split an edge of the \
         joint first"
    )]
    SlitOfOneEdge {
        /// Joint.
        joint: JointId,
        /// Surface.
        surface: SurfaceId,
        /// The nodes.
        nodes: [u32; 2],
    },
    /// Another joint runs through a node that must be cut.
    #[error(
        "joint {joint} runs through node {node} of surface {surface}, which would be cut there; end it at that node first"
    )]
    JointInTheWay {
        /// The joint that runs through.
        joint: JointId,
        /// Surface.
        surface: SurfaceId,
        /// Node.
        node: NodeId,
    },
    /// An attribute edge crosses the cut.
    #[error("surface {surface}: attribute edge {line} crosses the cut; end it there first")]
    AttributeInTheWay {
        /// Surface.
        surface: SurfaceId,
        /// The attribute edge.
        line: AttributeEdgeId,
    },
    /// Everything at the node is one fan.
    #[error("node {node} of surface {surface} has one fan of faces and needs no choice")]
    OneFan {
        /// Surface.
        surface: SurfaceId,
        /// Node.
        node: NodeId,
    },
    /// A fan lies in the material of another.
    #[error(
        "node {node} of surface {surface}: between fans {fans:?} lies material for one and empty space for the other; turn \
         one of them round or cut them apart"
    )]
    MaterialInMaterial {
        /// Surface.
        surface: SurfaceId,
        /// Node.
        node: NodeId,
        /// The fans, as [`Body::node_fans`] numbers them.
        fans: [u32; 2],
    },
    /// Fans run into each other.
    #[error("node {node} of surface {surface}: fans {fans:?} touch along lines or run through each other")]
    FansMeet {
        /// Surface.
        surface: SurfaceId,
        /// Node.
        node: NodeId,
        /// The fans, as [`Body::node_fans`] numbers them.
        fans: [u32; 2],
    },
    /// The body cannot be put together again; it was not sound.
    #[error("the body is not sound (see its check): {0}")]
    Build(#[from] BuildError),
}

impl Body {
    /// The two ways to pair the sheets of a joint, by the stored radial order.
    ///
    /// # Errors
    /// No such joint; one without edges; wires in it; an odd number of sheets; two enters or leaves in a row.
    /// O(sheets).
    pub fn edge_pairings(&self, joint: JointId) -> Result<EdgePairings, PairingError> {
        if !self.is_joint(joint) {
            return Err(PairingError::NoJoint(joint));
        }
        let j = self.joint(joint);
        if self.joint_len(joint) == 0 {
            return Err(PairingError::NoEdges { joint });
        }
        let sheets = j.radial();
        if let Some(i) = (0..j.uses.len()).find(|&i| sheets.iter().all(|s| s.use_index as usize != i)) {
            return Err(PairingError::Wire { joint, wire: j.uses[i] });
        }
        let follow = |i: usize| [sheets[i], sheets[(i + 1) % sheets.len()]];
        // Where one enters twice there is a fault even if the number is odd as well; an odd number is the plainer word.
        if sheets.len() % 2 == 1 {
            return Err(PairingError::Odd { joint, sheets: sheets.to_vec() });
        }
        if let Some(pair) = (0..sheets.len()).map(follow).find(|[a, b]| a.side == b.side) {
            return Err(PairingError::InARow { joint, crossing: pair[0].crossing(), sheets: pair });
        }
        let pairs = |first: Side| (0..sheets.len()).map(follow).filter(|[a, _]| a.side == first).collect();
        Ok(EdgePairings { joint, material: pairs(Side::Right), empty: pairs(Side::Left) })
    }

    /// Joints where more than two sheets meet, in order.
    pub fn non_manifold_joints(&self) -> Vec<JointId> {
        self.joints().filter(|(_, j)| j.radial.len() > 2).map(|(id, _)| id).collect()
    }
}
