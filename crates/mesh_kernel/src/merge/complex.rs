//! The faces while they are being merged: nodes on the grid, faces with the input faces that they are part of.

use glam::DVec3;

use super::Parent;
use super::edge_uses::by_number;
use super::meeting::Corners;
use crate::files::weld::{Welder, key};

/// End of a list of parents.
const NIL: u32 = u32::MAX;

/// A face that is part of one input face or, where faces coincide, of several.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub(super) nodes: [u32; 3],
    /// First cell of its list of parents.
    parents: u32,
}

/// Lists of parents as chains of cells. Parts of a face share its list.
#[derive(Clone, Debug, Default)]
struct ParentLists(Vec<(Parent, u32)>);

impl ParentLists {
    fn push(&mut self, parent: Parent, rest: u32) -> u32 {
        self.0.push((parent, rest));
        self.0.len() as u32 - 1
    }

    fn iter(&self, mut at: u32) -> impl Iterator<Item = Parent> {
        std::iter::from_fn(move || {
            let (parent, rest) = *self.0.get(at as usize)?;
            at = rest;
            Some(parent)
        })
    }
}

/// Nodes and faces in the making.
pub(super) struct Complex {
    /// Nodes, whole numbers on the grid, no two in one place.
    pub(super) at: Vec<DVec3>,
    weld: Welder<3>,
    pub(super) faces: Vec<Face>,
    /// Faces that were replaced.
    pub(super) gone: Vec<bool>,
    lists: ParentLists,
    /// Whether faces that coincide the other way round undo each other.
    cancel: bool,
}

impl Complex {
    /// The faces of an input whose nodes are on the grid already. With `cancel`, a face and the same face reversed leave
    /// nothing, as in a chain. Faces that the grid makes a point or an edge are left out.
    pub(super) fn new(
        positions: impl ExactSizeIterator<Item = DVec3>,
        faces: &[[u32; 3]],
        cancel: bool,
    ) -> Self {
        let mut new = Self {
            at: Vec::with_capacity(positions.len()),
            weld: Welder::with_capacity(positions.len()),
            faces: Vec::with_capacity(faces.len()),
            gone: Vec::new(),
            lists: ParentLists::default(),
            cancel,
        };
        let numbers: Vec<u32> = positions.map(|p| new.node(p)).collect();
        for (face, corners) in (0..).zip(faces) {
            let nodes = corners.map(|v| numbers[v as usize]);
            if distinct(nodes) {
                let parents = new.lists.push(Parent { face, reversed: false }, NIL);
                new.faces.push(Face { nodes, parents });
            }
        }
        new.gone = vec![false; new.faces.len()];
        let all: Vec<u32> = (0..new.faces.len() as u32).collect();
        new.unite_coincident(&all);
        new
    }

    /// The node at a place, new or known.
    pub(super) fn node(&mut self, p: DVec3) -> u32 {
        let (number, new) = self.weld.number(p.to_array().map(key));
        if new {
            self.at.push(p);
        }
        number
    }

    pub(super) fn corners(&self, face: u32) -> Corners {
        let nodes = self.faces[face as usize].nodes;
        Corners { face, nodes, at: nodes.map(|v| self.at[v as usize]) }
    }

    /// The faces that are there.
    pub(super) fn present(&self) -> impl Iterator<Item = u32> {
        (0..self.faces.len() as u32).filter(|&f| !self.gone[f as usize])
    }

    /// Puts the input faces that a face is part of behind others, ascending.
    pub(super) fn parents(&self, face: u32, all: &mut Vec<Parent>) {
        let first = all.len();
        all.extend(self.lists.iter(self.faces[face as usize].parents));
        all[first..].sort_unstable();
    }

    /// Puts a part of a face beside it, wound as it is.
    pub(super) fn add_part(&mut self, face: u32, nodes: [u32; 3]) {
        self.faces.push(Face { nodes, parents: self.faces[face as usize].parents });
        self.gone.push(false);
    }

    /// Makes one face of those that have the same nodes; at least one of each such group is among `new`. Faces that undo
    /// each other are gone. O(n) in all faces.
    pub(super) fn unite_coincident(&mut self, new: &[u32]) {
        let mut touched = vec![false; self.at.len()];
        for &f in new {
            self.faces[f as usize].nodes.iter().for_each(|&v| touched[v as usize] = true);
        }
        let keys = (0..).zip(&self.faces).filter_map(|(f, face)| {
            let there = !self.gone[f as usize] && face.nodes.iter().all(|&v| touched[v as usize]);
            there.then(|| (sorted(face.nodes), f))
        });
        let mut keys = by_number(keys, self.at.len(), |k| k.0[0]);
        keys.chunk_by_mut(|a, b| a.0[0] == b.0[0]).for_each(<[([u32; 3], u32)]>::sort_unstable);
        for group in keys.chunk_by(|a, b| a.0 == b.0).filter(|g| g.len() > 1) {
            self.unite(group.iter().map(|(_, f)| *f));
        }
    }

    /// Makes the first face the only one of several on the same nodes.
    fn unite(&mut self, mut group: impl Iterator<Item = u32>) {
        let Some(first) = group.next() else { return };
        let nodes = self.faces[first as usize].nodes;
        let mut parents: Vec<Parent> = self.lists.iter(self.faces[first as usize].parents).collect();
        for f in group {
            let turned = odd(nodes) != odd(self.faces[f as usize].nodes);
            parents.extend(
                self.lists
                    .iter(self.faces[f as usize].parents)
                    .map(|p| Parent { face: p.face, reversed: p.reversed != turned }),
            );
            self.gone[f as usize] = true;
        }
        parents.sort_unstable();
        // Parts of one face on both sides of it: it was folded away.
        let mut kept: Vec<Parent> = Vec::with_capacity(parents.len());
        for run in parents.chunk_by(|a, b| a.face == b.face) {
            let reversed = run.iter().filter(|p| p.reversed).count();
            let forward = run.len() - reversed;
            let (count, reversed) = (forward.abs_diff(reversed), reversed > forward);
            kept.extend(std::iter::repeat_n(Parent { face: run[0].face, reversed }, count));
        }
        let winding: i64 = kept.iter().map(|p| if p.reversed { -1 } else { 1 }).sum();
        if kept.is_empty() || (self.cancel && winding == 0) {
            self.gone[first as usize] = true;
            return;
        }
        let list = kept.iter().rev().fold(NIL, |rest, p| self.lists.push(*p, rest));
        self.faces[first as usize].parents = list;
    }
}

/// Whether no node is named twice.
#[inline]
pub(super) fn distinct([a, b, c]: [u32; 3]) -> bool {
    a != b && b != c && c != a
}

fn sorted(mut nodes: [u32; 3]) -> [u32; 3] {
    nodes.sort_unstable();
    nodes
}

/// Whether the nodes are an odd permutation of their ascending order.
fn odd([a, b, c]: [u32; 3]) -> bool {
    (a > b) ^ (b > c) ^ (a > c)
}
