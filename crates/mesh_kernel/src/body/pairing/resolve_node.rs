//! Taking fans apart at a node, or having them touch there on purpose.

use super::fans::{NodeFans, Through};
use super::recut::{Seam, Unsewn};
use super::{Pairing, PairingError, Resolution};
use crate::body::build::Run;
use crate::body::weld::UnionFind;
use crate::body::{Body, JointId, NodeId, SurfaceId};

/// Which fans stay together at the node.
fn groups(fans: &NodeFans, pairing: Pairing, at: (SurfaceId, NodeId)) -> Result<UnionFind, PairingError> {
    let mut sets = UnionFind::new(fans.fans.len());
    for c in &fans.contacts {
        let stay = match c.through {
            Through::Empty | Through::Sheets => pairing == Pairing::Join,
            Through::Material => pairing == Pairing::Miss,
            Through::Conflict => {
                let fans = [c.fans[0], c.fans[1]];
                return Err(PairingError::MaterialInMaterial { surface: at.0, node: at.1, fans });
            }
        };
        if stay {
            c.fans.windows(2).for_each(|p| {
                sets.union(p[0], p[1]);
            });
        }
    }
    // Nodes alone look everywhere.
    if pairing == Pairing::Join {
        for (i, _) in fans.fans.iter().enumerate().filter(|(_, f)| f.faces.is_empty() && f.wires.is_empty()) {
            sets.union(0, i as u32);
        }
    }
    Ok(sets)
}

impl Body {
    /// Says what is meant where several fans of faces share a node.
    ///
    /// Where empty space lies between fans, or open sheets touch, [`Pairing::Miss`] takes them apart: every fan gets nodes of
    /// its own and no joint holds them; [`Pairing::Join`] keeps them touching by a joint without edges. Where *material* lies
    /// between them (two hollows that touch) it is the other way round: to join the material is to keep the hollows apart.
    /// Every fan gets a node of its own in its surface in any case, so that it is the joint alone that says so.
    ///
    /// Volume, faces and edges stay; a component is gained, or a cycle lost, for every fan set apart.
    ///
    /// # Errors
    /// See [`PairingError`]; nothing is changed then. O(faces).
    pub fn resolve_node(
        &self,
        surface: SurfaceId,
        node: NodeId,
        pairing: Pairing,
    ) -> Result<Resolution, PairingError> {
        let fans = self.node_fans(surface, node)?;
        if fans.fans.len() < 2 {
            return Err(PairingError::OneFan { surface, node });
        }
        let (group_of, count) = groups(&fans, pairing, (surface, node))?.number();
        let mut unsewn = Unsewn::new(self);
        // Joints without edges at the node are made anew.
        let here = |run: &Run| {
            fans.fans.iter().any(|f| f.nodes.contains(&(SurfaceId(run.surface), NodeId(run.start))))
        };
        unsewn.seams.retain(|s| !s.runs.iter().all(|r| r.edges.is_empty() && here(r)));
        let mut taken: Vec<(SurfaceId, NodeId)> = Vec::new();
        let mut nodes_of_group: Vec<Vec<(u32, u32)>> = vec![Vec::new(); count];
        for (fan, &group) in fans.fans.iter().zip(&group_of) {
            for &(s, v) in &fan.nodes {
                let mut own = v.0;
                if taken.contains(&(s, v)) {
                    own = unsewn.copy_node(s.0, v.0);
                    let faces: Vec<u32> =
                        fan.faces.iter().filter(|(t, _)| *t == s).map(|(_, f)| f.0).collect();
                    unsewn.hand_over(s.0, &faces, v.0, own);
                    for (_, e) in fan.wires.iter().filter(|(t, _)| *t == s) {
                        let ends = &mut unsewn.surfaces[s.index()].edges[e.index()];
                        ends.iter_mut().filter(|x| **x == v.0).for_each(|x| *x = own);
                    }
                }
                taken.push((s, v));
                nodes_of_group[group as usize].push((s.0, own));
            }
        }
        unsewn.start_runs();
        let first_new = unsewn.seams.len();
        unsewn.touch(&nodes_of_group);
        let touching = (first_new..unsewn.seams.len()).map(|j| JointId(j as u32)).collect();
        let sewn = unsewn.sew(self.joints.len())?;
        let (before, after) = (self.counts(), sewn.body.counts());
        Ok(Resolution { body: sewn.body, joints: sewn.joints, pairs: Vec::new(), touching, before, after })
    }
}

impl Unsewn {
    /// Holds together by joints without edges the nodes of every list that other joints do not.
    pub(super) fn touch(&mut self, lists: &[Vec<(u32, u32)>]) {
        let (offsets, mut sets) = self.node_sets();
        for list in lists {
            let mut classes: Vec<u32> = Vec::new();
            let mut runs = Vec::new();
            for &(surface, start) in list {
                let class = sets.find(offsets[surface as usize] + start);
                if !classes.contains(&class) {
                    classes.push(class);
                    runs.push(Run { surface, start, edges: Vec::new() });
                }
            }
            if runs.len() > 1 {
                self.seams.push(Seam { old: None, name: None, runs, radial: Vec::new() });
            }
        }
    }
}
