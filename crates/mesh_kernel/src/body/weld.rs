//! Nodes and edges that joints hold together, seen as one.

use super::Body;
use super::ids::{JointId, NONE, SurfaceId};
use crate::{Group, TriMesh};

/// The body as one complex: which node of the welded mesh a node of a surface is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Weld {
    /// For every surface, for every node, its number in the welded mesh; [`NONE`] for a free number of a sparse surface.
    pub nodes: Vec<Vec<u32>>,
    /// How many welded nodes there are.
    pub count: usize,
}

impl Weld {
    /// The welded number of a node.
    #[inline]
    pub fn node(&self, surface: SurfaceId, node: u32) -> u32 {
        self.nodes[surface.index()][node as usize]
    }
}

/// Sets that grow together; the lowest member names a set.
#[derive(Clone, Debug)]
pub(crate) struct UnionFind {
    parent: Vec<u32>,
}

impl UnionFind {
    pub(crate) fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).collect() }
    }

    pub(crate) fn find(&mut self, mut x: u32) -> u32 {
        while self.parent[x as usize] != x {
            let up = self.parent[self.parent[x as usize] as usize];
            self.parent[x as usize] = up;
            x = up;
        }
        x
    }

    /// How many members there are in all sets.
    pub(crate) fn len(&self) -> usize {
        self.parent.len()
    }

    /// What [`UnionFind::find`] says, without shortening ways; of a member that came later, itself.
    pub(crate) fn rep(&self, mut x: u32) -> u32 {
        while let Some(&up) = self.parent.get(x as usize)
            && up != x
        {
            x = up;
        }
        x
    }

    /// Joins the sets of both; `false` where they were one.
    pub(crate) fn union(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        if a == b {
            return false;
        }
        let (lo, hi) = if a < b { (a, b) } else { (b, a) };
        self.parent[hi as usize] = lo;
        true
    }

    /// Numbers the sets 0, 1, … in order of their lowest members.
    pub(crate) fn number(self) -> (Vec<u32>, usize) {
        self.number_where(|_| true)
    }

    /// The same without the sets whose lowest member is not to be counted; these have no number ([`NONE`]).
    pub(crate) fn number_where(mut self, counted: impl Fn(u32) -> bool) -> (Vec<u32>, usize) {
        let mut count = 0;
        let mut out = vec![0; self.parent.len()];
        for x in 0..self.parent.len() as u32 {
            let root = self.find(x);
            if root == x && counted(x) {
                out[x as usize] = count;
                count += 1;
            } else if root == x {
                out[x as usize] = NONE;
            } else {
                out[x as usize] = out[root as usize];
            }
        }
        (out, count as usize)
    }
}

impl Body {
    /// First number of every surface when the `length` of each is laid end to end.
    pub(crate) fn offsets(&self, length: impl Fn(&super::Surface) -> usize) -> Vec<u32> {
        let mut at = 0;
        let mut offsets = vec![0];
        for s in &self.surfaces {
            at += length(s) as u32;
            offsets.push(at);
        }
        offsets
    }

    pub(crate) fn node_sets(&self, offsets: &[u32]) -> UnionFind {
        let mut sets = UnionFind::new(*offsets.last().unwrap_or(&0) as usize);
        for (j, joint) in self.joints.iter().enumerate() {
            let id = JointId(j as u32);
            let Some(first) = joint.uses.first() else { continue };
            let nodes = self.joint_nodes(id, 0);
            for (i, u) in joint.uses.iter().enumerate().skip(1) {
                for (&a, &b) in nodes.iter().zip(&self.joint_nodes(id, i)) {
                    sets.union(offsets[first.surface.index()] + a, offsets[u.surface.index()] + b);
                }
            }
        }
        sets
    }

    /// The nodes as joints hold them together, however many joints meet at a node. Welded nodes are numbered in order
    /// of surfaces and their nodes. O(nodes + joint nodes).
    pub fn weld(&self) -> Weld {
        let offsets = self.offsets(|s| s.positions.len());
        let slots = |s: &super::Surface| s.slots.nodes.clone();
        let (numbers, count) = self.number_live(self.node_sets(&offsets), &offsets, slots);
        let nodes = offsets.windows(2).map(|w| numbers[w[0] as usize..w[1] as usize].to_vec()).collect();
        Weld { nodes, count }
    }

    /// Numbers the sets of what lives.
    fn number_live(
        &self,
        sets: UnionFind,
        offsets: &[u32],
        slots: impl Fn(&super::Surface) -> super::slots::Slots,
    ) -> (Vec<u32>, usize) {
        if self.is_compact() {
            return sets.number();
        }
        let mut free = vec![false; *offsets.last().unwrap_or(&0) as usize];
        for (s, offset) in self.surfaces.iter().zip(offsets) {
            slots(s).free().iter().for_each(|i| free[(offset + i) as usize] = true);
        }
        sets.number_where(|x| !free[x as usize])
    }

    /// Numbers of the edges with those that correspond on joints seen as one, per surface, and how many there are.
    pub(crate) fn weld_edges(&self) -> (Vec<Vec<u32>>, usize) {
        let offsets = self.offsets(|s| s.edges.len());
        let mut sets = UnionFind::new(*offsets.last().unwrap_or(&0) as usize);
        for (j, joint) in self.joints.iter().enumerate() {
            let id = JointId(j as u32);
            let Some(first) = joint.uses.first() else { continue };
            let edges = self.joint_edges(id, 0);
            for (i, u) in joint.uses.iter().enumerate().skip(1) {
                for (a, b) in edges.iter().zip(self.joint_edges(id, i)) {
                    sets.union(
                        offsets[first.surface.index()] + a.edge().0,
                        offsets[u.surface.index()] + b.edge().0,
                    );
                }
            }
        }
        let (numbers, count) = self.number_live(sets, &offsets, |s| s.slots.edges.clone());
        (offsets.windows(2).map(|w| numbers[w[0] as usize..w[1] as usize].to_vec()).collect(), count)
    }

    /// The body as a mesh: a group a surface, nodes that joints hold together shared ([`Body::weld`] gives the map).
    /// The flat pattern becomes `corner_uvs` where every surface has one. O(nodes + faces).
    pub fn to_tri_mesh(&self) -> TriMesh {
        let weld = self.weld();
        let mut mesh = TriMesh { positions: vec![glam::DVec3::ZERO; weld.count], ..TriMesh::default() };
        let flat = !self.surfaces.is_empty() && self.surfaces.iter().all(|s| s.planar().is_some());
        let mut uvs = Vec::new();
        // Backwards, so that a welded node has the position of its first node.
        for (s, nodes) in self.surfaces.iter().zip(&weld.nodes).rev() {
            for (&w, &p) in nodes.iter().zip(&s.positions).filter(|(w, _)| **w != NONE) {
                mesh.positions[w as usize] = p;
            }
        }
        for (s, nodes) in self.surfaces.iter().zip(&weld.nodes) {
            let from = mesh.faces.len() as u32;
            mesh.faces.extend(s.live_faces().map(|f| s.faces[f.index()].map(|v| nodes[v as usize])));
            mesh.groups.push(Group { name: s.name.clone(), faces: from..mesh.faces.len() as u32 });
            if flat {
                uvs.extend(s.live_faces().map(|f| s.faces[f.index()].map(|v| s.planar[v as usize])));
            }
        }
        mesh.corner_uvs = flat.then_some(uvs);
        mesh
    }

    /// Gives all nodes that joints hold together the position of the first of them (lowest surface, lowest node), bit
    /// for bit; backup positions likewise. To be called after positions were set surface by surface. O(nodes).
    pub fn sync_joints(&mut self) {
        let offsets = self.offsets(|s| s.positions.len());
        let mut sets = self.node_sets(&offsets);
        for s in 0..self.surfaces.len() {
            for v in 0..self.surfaces[s].positions.len() {
                let x = offsets[s] + v as u32;
                let root = sets.find(x);
                if root == x {
                    continue;
                }
                let t = offsets.partition_point(|&o| o <= root) - 1;
                let w = (root - offsets[t]) as usize;
                self.surfaces[s].positions[v] = self.surfaces[t].positions[w];
                if !self.surfaces[s].backup.is_empty() && !self.surfaces[t].backup.is_empty() {
                    self.surfaces[s].backup[v] = self.surfaces[t].backup[w];
                }
            }
        }
    }
}
