//! Operators that change most of a body: the parts that changed are kept whole.

use glam::DVec3;

use super::Editor;
use super::operation::Operation;
use crate::body::joint::Joint;
use crate::body::slots::Slots;
use crate::body::{
    Body, Compaction, JointId, NodeId, Pairing, PairingError, Resolution, SplitError, SplitMap, Surface,
    SurfaceId,
};

/// Surfaces and joints that are *not* in the body now: those of before, or, once taken back, those of after.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Whole {
    surfaces: Vec<(u32, Surface)>,
    joints: Option<(Vec<Joint>, Slots)>,
}

impl Whole {
    /// Puts `next` in the place of `body`, which has as many surfaces, and keeps what differs.
    pub(super) fn replace(body: &mut Body, next: Body) -> Self {
        let same_joints = body.joints == next.joints && body.joint_slots == next.joint_slots;
        let before = std::mem::replace(body, next);
        let changed = |(i, old): (usize, Surface)| (old != body.surfaces[i]).then_some((i as u32, old));
        Self {
            surfaces: before.surfaces.into_iter().enumerate().filter_map(changed).collect(),
            joints: (!same_joints).then_some((before.joints, before.joint_slots)),
        }
    }

    /// Swaps what is kept with what is in the body. O(surfaces).
    pub(super) fn exchange(&mut self, body: &mut Body) {
        for (i, s) in &mut self.surfaces {
            std::mem::swap(s, &mut body.surfaces[*i as usize]);
        }
        if let Some((joints, slots)) = &mut self.joints {
            std::mem::swap(joints, &mut body.joints);
            std::mem::swap(slots, &mut body.joint_slots);
        }
    }

    /// Surfaces that it changes.
    pub(super) fn surfaces(&self) -> impl Iterator<Item = usize> + '_ {
        self.surfaces.iter().map(|(i, _)| *i as usize)
    }
}

impl Editor {
    /// Splits every face into four ([`Body::split_all`]).
    ///
    /// # Errors
    /// As [`Body::split_all`]. O(faces).
    pub fn split_all(&mut self, midpoints: Option<&[Vec<DVec3>]>) -> Result<SplitMap, SplitError> {
        let mut next = self.body.clone();
        let map = next.split_all(midpoints)?;
        self.replace(next, || Operation::SplitAll { midpoints: midpoints.map(<[_]>::to_vec) });
        Ok(map)
    }

    /// Says what is meant where more than two sheets meet ([`Body::resolve_edge`]).
    ///
    /// # Errors
    /// As [`Body::resolve_edge`]. O(size).
    pub fn resolve_edge(&mut self, joint: JointId, pairing: Pairing) -> Result<Resolution, PairingError> {
        let resolution = self.body.resolve_edge(joint, pairing)?;
        self.replace(resolution.body.clone(), || Operation::ResolveEdge { joint, pairing });
        Ok(resolution)
    }

    /// Says what is meant where several fans of faces share a node ([`Body::resolve_node`]).
    ///
    /// # Errors
    /// As [`Body::resolve_node`]. O(size).
    pub fn resolve_node(
        &mut self,
        surface: SurfaceId,
        node: NodeId,
        pairing: Pairing,
    ) -> Result<Resolution, PairingError> {
        let resolution = self.body.resolve_node(surface, node, pairing)?;
        self.replace(resolution.body.clone(), || Operation::ResolveNode { surface, node, pairing });
        Ok(resolution)
    }

    /// Closes the gaps that operators left ([`Body::compact`]); nothing is logged where there are none. O(size).
    pub fn compact(&mut self) -> Compaction {
        if self.body.is_compact() {
            return self.body.compact();
        }
        let mut next = self.body.clone();
        let map = next.compact();
        self.replace(next, || Operation::Compact);
        map
    }
}
