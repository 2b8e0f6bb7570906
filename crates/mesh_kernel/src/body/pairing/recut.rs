//! A body taken apart into surfaces without chains and joints as runs of edges, cut, and sewn again.

use super::PairingError;
use crate::body::build::{Run, RunJoint};
use crate::body::ids::{DirectedEdge, EdgeId, JointId, NONE, NodeId, SurfaceId};
use crate::body::joint::Sheet;
use crate::body::slots::Slots;
use crate::body::surface::{NO_CHAIN, Surface};
use crate::body::weld::UnionFind;
use crate::body::{AttributeEdgeId, Body};

/// A joint of the body that is to be sewn.
pub(super) struct Seam {
    /// The joint that it was.
    pub(super) old: Option<JointId>,
    pub(super) name: Option<String>,
    pub(super) runs: Vec<Run>,
    /// Radial order, by run.
    pub(super) radial: Vec<Sheet>,
}

/// Surfaces without chains and loops, and the joints to be.
pub(super) struct Unsewn {
    pub(super) surfaces: Vec<Surface>,
    pub(super) seams: Vec<Seam>,
    /// Surface, node and copy of every copy made.
    pub(super) copies: Vec<(u32, u32, u32)>,
}

/// What sewing gives.
pub(super) struct Sewn {
    pub(super) body: Body,
    /// New id of every old joint.
    pub(super) joints: Vec<Option<JointId>>,
}

impl Unsewn {
    pub(super) fn new(body: &Body) -> Self {
        let seams = body
            .joints()
            .map(|(id, joint)| Seam {
                old: Some(id),
                name: joint.name.clone(),
                runs: (0..joint.uses.len()).map(|i| run_of(body, id, i)).collect(),
                radial: joint.radial.clone(),
            })
            .collect();
        let mut surfaces = body.surfaces.clone();
        for s in &mut surfaces {
            s.chains.clear();
            s.loops.clear();
            s.slots.chains = Slots::default();
            s.edge_chain.fill(NO_CHAIN);
        }
        Self { surfaces, seams, copies: Vec::new() }
    }

    /// The nodes of a run, one more than it has edges.
    pub(super) fn run_nodes(&self, run: &Run) -> Vec<u32> {
        let s = &self.surfaces[run.surface as usize];
        std::iter::once(run.start).chain(run.edges.iter().map(|&d| s.ends(d)[1].0)).collect()
    }

    /// Sets of nodes that seams hold together, over the surfaces' nodes laid end to end.
    pub(super) fn node_sets(&self) -> (Vec<u32>, UnionFind) {
        let mut offsets = vec![0u32];
        for s in &self.surfaces {
            offsets.push(offsets[offsets.len() - 1] + s.positions.len() as u32);
        }
        let mut sets = UnionFind::new(offsets[self.surfaces.len()] as usize);
        for seam in &self.seams {
            let Some((first, rest)) = seam.runs.split_first() else { continue };
            let nodes = self.run_nodes(first);
            for run in rest {
                for (&a, b) in nodes.iter().zip(self.run_nodes(run)) {
                    sets.union(offsets[first.surface as usize] + a, offsets[run.surface as usize] + b);
                }
            }
        }
        (offsets, sets)
    }

    /// Gives the right face of an edge an edge of its own, with the same nodes.
    pub(super) fn cut_edge(&mut self, surface: u32, edge: EdgeId) -> EdgeId {
        let s = &mut self.surfaces[surface as usize];
        let e = edge.index();
        let new = s.edges.len() as u32;
        let face = std::mem::replace(&mut s.edge_faces[e][1], NONE);
        s.edges.push(s.edges[e]);
        s.edge_faces.push([NONE, face]);
        s.edge_chain.push(NO_CHAIN);
        if face != NONE {
            for side in s.face_edges[face as usize].iter_mut().filter(|x| **x == edge.0) {
                *side = new;
            }
        }
        EdgeId(new)
    }

    /// Makes a copy of a node that has no edges and faces yet.
    pub(super) fn copy_node(&mut self, surface: u32, node: u32) -> u32 {
        let s = &mut self.surfaces[surface as usize];
        let v = node as usize;
        s.positions.push(s.positions[v]);
        if !s.backup.is_empty() {
            s.backup.push(s.backup[v]);
        }
        if !s.planar.is_empty() {
            s.planar.push(s.planar[v]);
        }
        let copy = s.positions.len() as u32 - 1;
        self.copies.push((surface, node, copy));
        copy
    }

    /// Hands faces, with their sides, from one node over to another.
    pub(super) fn hand_over(&mut self, surface: u32, faces: &[u32], from: u32, to: u32) {
        let s = &mut self.surfaces[surface as usize];
        for &f in faces {
            s.faces[f as usize].iter_mut().filter(|v| **v == from).for_each(|v| *v = to);
            for e in s.face_edges[f as usize] {
                s.edges[e as usize].iter_mut().filter(|v| **v == from).for_each(|v| *v = to);
            }
        }
    }

    /// Whether every run is still in one piece.
    fn runs_hold(&self) -> Result<(), PairingError> {
        for (j, seam) in self.seams.iter().enumerate() {
            for run in &seam.runs {
                let s = &self.surfaces[run.surface as usize];
                if let Some(pair) = run.edges.windows(2).find(|p| s.ends(p[0])[1] != s.ends(p[1])[0]) {
                    return Err(PairingError::JointInTheWay {
                        joint: seam.old.unwrap_or(JointId(j as u32)),
                        surface: SurfaceId(run.surface),
                        node: s.ends(pair[0])[1],
                    });
                }
            }
        }
        Ok(())
    }

    fn attributes_hold(&self) -> Result<(), PairingError> {
        for (i, s) in self.surfaces.iter().enumerate() {
            let index = std::cell::OnceCell::new();
            for (l, line) in s.attribute_edges.iter().enumerate() {
                for pair in line.nodes.windows(2) {
                    let [a, b] = [pair[0], pair[1]].map(|n| &s.attribute_nodes[n.index()]);
                    if s.carrier(a, b, &index).is_none() {
                        let line = AttributeEdgeId(l as u32);
                        return Err(PairingError::AttributeInTheWay { surface: SurfaceId(i as u32), line });
                    }
                }
            }
        }
        Ok(())
    }

    /// Puts the body together; radial orders stay as they were.
    pub(super) fn sew(self, old_joints: usize) -> Result<Sewn, PairingError> {
        self.runs_hold()?;
        self.attributes_hold()?;
        let mut joints = vec![None; old_joints];
        for (j, seam) in self.seams.iter().enumerate() {
            if let Some(old) = seam.old {
                joints[old.index()] = Some(JointId(j as u32));
            }
        }
        let runs =
            self.seams.iter().map(|s| RunJoint { name: s.name.clone(), runs: s.runs.clone() }).collect();
        let mut body = Body::assemble(self.surfaces, runs)?;
        for (j, seam) in self.seams.iter().enumerate() {
            let id = JointId(j as u32);
            // Where the uses of the runs stand now.
            let place: Vec<Option<u32>> = seam
                .runs
                .iter()
                .map(|run| {
                    let same = |i: &usize| {
                        let own = run_of(&body, id, *i);
                        own.surface == run.surface && own.start == run.start && own.edges == run.edges
                    };
                    (0..seam.runs.len()).find(same).map(|i| i as u32)
                })
                .collect();
            let order: Option<Vec<Sheet>> = seam
                .radial
                .iter()
                .map(|s| Some(Sheet { use_index: place.get(s.use_index as usize).copied().flatten()?, ..*s }))
                .collect();
            if let Some(order) = order.filter(|o| !o.is_empty()) {
                body.store_order(id, &order);
            }
        }
        Ok(Sewn { body, joints })
    }
}

/// Use `i` of a joint as a run along it.
fn run_of(body: &Body, joint: JointId, i: usize) -> Run {
    let u = body.joint(joint).uses[i];
    let edges: Vec<DirectedEdge> = body.joint_edges(joint, i);
    let s = body.surface(u.surface);
    let start = edges.first().map_or(s.chain(u.chain).start, |&d| s.ends(d)[0]);
    let NodeId(start) = start;
    Run { surface: u.surface.0, start, edges }
}
