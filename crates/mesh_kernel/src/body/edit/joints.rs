//! Joints made and killed.

use super::Editor;
use super::operation::Operation;
use crate::body::joint::Joint;
use crate::body::surface::NO_CHAIN;
use crate::body::{Body, BuildError, Chain, ChainSpec, EdgeId, JointId, JointSpec, SurfaceId};

/// Why a joint was not made or killed. Nothing is changed then.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum JointError {
    /// No such joint.
    #[error("the body has no joint {0}")]
    NoJoint(JointId),
    /// Without the joint a surface would have an edge twice.
    #[error(
        "joint {joint} makes edges {} and {} of surface {surface} one; without it they would join the same nodes twice: \
         split one of them first",
        edges[0], edges[1]
    )]
    HoldsSlit {
        /// Joint.
        joint: JointId,
        /// Surface.
        surface: SurfaceId,
        /// The edges.
        edges: [EdgeId; 2],
    },
    /// The chains cannot be joined.
    #[error(transparent)]
    Build(#[from] BuildError),
}

impl Body {
    /// What a joint is made of, so that [`Editor::make_joint`] makes it again.
    ///
    /// Chains come in the stored order, by their nodes in the joint's direction.
    pub fn joint_spec(&self, joint: JointId) -> JointSpec {
        let j = self.joint(joint);
        let chain = |(i, u): (usize, &crate::body::JointUse)| {
            let mut nodes = self.joint_nodes(joint, i);
            let closed = self.surface(u.surface).chain_is_closed(u.chain);
            if closed {
                nodes.pop();
            }
            ChainSpec { surface: u.surface.index(), nodes, closed }
        };
        JointSpec {
            name: j.name().map(str::to_owned),
            chains: j.uses().iter().enumerate().map(chain).collect(),
        }
    }

    /// Edges of one surface on the joint that have the same ends.
    fn slit(&self, joint: JointId) -> Option<(SurfaceId, [EdgeId; 2])> {
        let mut ends: Vec<(SurfaceId, [u32; 2], EdgeId)> = Vec::new();
        for (i, u) in self.joint(joint).uses().iter().enumerate() {
            for d in self.joint_edges(joint, i) {
                let mut nodes = self.surface(u.surface).edges[d.edge().index()];
                nodes.sort_unstable();
                ends.push((u.surface, nodes, d.edge()));
            }
        }
        ends.sort_unstable();
        let same = ends.windows(2).find(|w| (w[0].0, w[0].1) == (w[1].0, w[1].1))?;
        Some((same[0].0, [same[0].2, same[1].2]))
    }

    fn without_joint(&self, joint: JointId) -> Self {
        let mut next = self.clone();
        let uses = std::mem::take(&mut next.joints[joint.index()].uses);
        // Mirror image of making, which takes the numbers freed last first.
        for u in uses.iter().rev() {
            let s = &mut next.surfaces[u.surface.index()];
            let chain = std::mem::replace(&mut s.chains[u.chain.index()], Chain::FREE);
            for d in chain.edges {
                s.edge_chain[d.edge().index()] = NO_CHAIN;
            }
            s.slots.chains.release(u.chain.0);
        }
        next.joints[joint.index()] = Joint { name: None, uses: Vec::new(), radial: Vec::new() };
        next.joint_slots.release(joint.0);
        let mut touched: Vec<usize> = uses.iter().map(|u| u.surface.index()).collect();
        touched.sort_unstable();
        touched.dedup();
        for s in touched {
            next.surfaces[s].drop_loops();
            next.surfaces[s].find_loops();
        }
        next
    }
}

impl Editor {
    /// Joins chains of edges that are there. The joint and its chains get the numbers freed last, or new ones; nodes that
    /// it holds together become equal bit for bit (within [`crate::body::JOINT_SNAP`]); boundary loops of its surfaces are
    /// cut anew. Inverse: [`Editor::kill_joint`].
    ///
    /// # Errors
    /// As [`Body::build`]. O(size of the body).
    pub fn make_joint(&mut self, spec: &JointSpec) -> Result<JointId, JointError> {
        let (next, joint) = self.body.with_joint(spec)?;
        self.replace(next, || Operation::MakeJoint { joint: spec.clone() });
        Ok(joint)
    }

    /// Takes a joint apart: its chains become ordinary boundary, inner edges or wires, each with nodes of its own. Gives
    /// what [`Editor::make_joint`] needs to make it again. Joints that are stored in geometric order come back bit for bit,
    /// with the same numbers.
    ///
    /// # Errors
    /// Unknown joint; a joint that holds a slit of one edge together. O(size of the body).
    pub fn kill_joint(&mut self, joint: JointId) -> Result<JointSpec, JointError> {
        if !self.body.is_joint(joint) {
            return Err(JointError::NoJoint(joint));
        }
        if let Some((surface, edges)) = self.body.slit(joint) {
            return Err(JointError::HoldsSlit { joint, surface, edges });
        }
        let spec = self.body.joint_spec(joint);
        let next = self.body.without_joint(joint);
        self.replace(next, || Operation::KillJoint { joint });
        Ok(spec)
    }
}
