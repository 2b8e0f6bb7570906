//! Free numbers closed: a sparse body made compact again.

use super::attribute::AttributeNode;
use super::ids::{ChainId, DirectedEdge, EdgeId, FaceId, JointId, NONE, NodeId};
use super::slots::Slots;
use super::surface::Surface;
use super::{Body, Chain};

/// New numbers of a surface's entities by their old ones, [`NONE`] for numbers that were free.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SurfaceCompaction {
    /// Nodes.
    pub nodes: Vec<u32>,
    /// Edges.
    pub edges: Vec<u32>,
    /// Faces.
    pub faces: Vec<u32>,
    /// Chains.
    pub chains: Vec<u32>,
}

/// New numbers by old ones.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Compaction {
    /// By surface.
    pub surfaces: Vec<SurfaceCompaction>,
    /// Of the joints.
    pub joints: Vec<u32>,
}

/// New numbers of `len` slots: those taken, in order.
fn numbers(len: usize, slots: &Slots) -> Vec<u32> {
    let mut next = 0;
    (0..len as u32)
        .map(|i| {
            if slots.is_free(i) {
                return NONE;
            }
            next += 1;
            next - 1
        })
        .collect()
}

fn keep<T>(items: &mut Vec<T>, slots: &Slots) {
    let mut i = 0;
    items.retain(|_| {
        i += 1;
        !slots.is_free(i - 1)
    });
}

impl Body {
    /// Closes the gaps that operators left, so that all numbers run from 0 without a break; their order stays. The inverse
    /// is not kept: compact a body when its editing is over. O(size), nothing where the body is compact.
    pub fn compact(&mut self) -> Compaction {
        let joints = numbers(self.joints.len(), &self.joint_slots);
        let surfaces = self.surfaces.iter().map(SurfaceCompaction::new).collect::<Vec<_>>();
        if self.is_compact() {
            return Compaction { surfaces, joints };
        }
        for (s, map) in self.surfaces.iter_mut().zip(&surfaces) {
            map.apply(s, &joints);
        }
        keep(&mut self.joints, &self.joint_slots);
        self.joint_slots = Slots::default();
        for u in self.joints.iter_mut().flat_map(|j| &mut j.uses) {
            u.chain = ChainId(surfaces[u.surface.index()].chains[u.chain.index()]);
        }
        Compaction { surfaces, joints }
    }
}

impl SurfaceCompaction {
    fn new(s: &Surface) -> Self {
        Self {
            nodes: numbers(s.positions.len(), &s.slots.nodes),
            edges: numbers(s.edges.len(), &s.slots.edges),
            faces: numbers(s.faces.len(), &s.slots.faces),
            chains: numbers(s.chains.len(), &s.slots.chains),
        }
    }

    fn apply(&self, s: &mut Surface, joints: &[u32]) {
        let slots = std::mem::take(&mut s.slots);
        keep(&mut s.positions, &slots.nodes);
        if !s.backup.is_empty() {
            keep(&mut s.backup, &slots.nodes);
        }
        if !s.planar.is_empty() {
            keep(&mut s.planar, &slots.nodes);
        }
        keep(&mut s.edges, &slots.edges);
        keep(&mut s.edge_faces, &slots.edges);
        keep(&mut s.edge_chain, &slots.edges);
        keep(&mut s.faces, &slots.faces);
        keep(&mut s.face_edges, &slots.faces);
        keep(&mut s.chains, &slots.chains);
        let node = |v: u32| self.nodes[v as usize];
        let edge = |e: u32| self.edges[e as usize];
        for ends in &mut s.edges {
            *ends = ends.map(node);
        }
        for sides in &mut s.edge_faces {
            *sides = sides.map(|f| if f == NONE { NONE } else { self.faces[f as usize] });
        }
        for slot in s.edge_chain.iter_mut().filter(|slot| **slot != super::surface::NO_CHAIN) {
            *slot = super::surface::chain_slot(ChainId(self.chains[*slot as usize - 1]));
        }
        for corners in &mut s.faces {
            *corners = corners.map(node);
        }
        for sides in &mut s.face_edges {
            *sides = sides.map(edge);
        }
        for Chain { start, edges, joint, .. } in &mut s.chains {
            *start = NodeId(node(start.0));
            for d in edges {
                *d = DirectedEdge::new(EdgeId(edge(d.edge().0)), d.is_reversed());
            }
            *joint = joint.map(|j| JointId(joints[j.index()]));
        }
        for chain in s.loops.iter_mut().flat_map(|l| &mut l.chains) {
            *chain = ChainId(self.chains[chain.index()]);
        }
        for host in &mut s.attribute_nodes {
            match host {
                AttributeNode::OnEdge { edge: e, .. } => *e = EdgeId(edge(e.0)),
                AttributeNode::InFace { face, .. } => *face = FaceId(self.faces[face.index()]),
            }
        }
    }
}
