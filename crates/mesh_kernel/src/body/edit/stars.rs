//! The edges at every node of a surface, kept while it is edited.
//!
//! Most nodes are *ordinary*: their faces form one fan, and whoever holds one edge of it walks to all others by faces, without
//! any table. At the few others, *singular* ones, several fans or wires end; their edges are listed, from the first time that
//! one is met. Which nodes are singular need not be known beforehand: a walk that meets fewer edges than end at the node
//! has found one.

use std::collections::BTreeMap;

use crate::body::{EdgeId, NONE, Surface};

/// What is kept of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct At {
    /// One of its edges, [`NONE`] where there is none.
    anchor: u32,
    /// How many edges end there; the top bit is set where a joint holds the node.
    degree: u32,
}

const ALONE: At = At { anchor: NONE, degree: 0 };
const HELD: u32 = 1 << 31;

/// The edges at every node of one surface.
#[derive(Clone, Debug, Default)]
pub(super) struct Stars {
    nodes: Vec<At>,
    /// All edges of every singular node; `None` until one is met.
    singular: Option<BTreeMap<u32, Vec<u32>>>,
}

/// The other face of an edge.
#[inline]
fn beyond(s: &Surface, edge: u32, face: u32) -> u32 {
    let [left, right] = s.edge_faces[edge as usize];
    left ^ right ^ face
}

/// The corner of a face at a node that it has.
#[inline]
pub(super) fn corner(s: &Surface, face: u32, node: u32) -> usize {
    let [a, b, _] = s.faces[face as usize];
    if a == node { 0 } else { 1 + usize::from(b != node) }
}

/// The index after a corner or side, and the one before.
pub(super) const NEXT: [usize; 3] = [1, 2, 0];
pub(super) const LAST: [usize; 3] = [2, 0, 1];

/// A walk round a node, face by face.
#[derive(Clone, Copy)]
struct Walk {
    /// The face that is entered next, [`NONE`] behind the last one.
    face: u32,
    /// The edge at the node over which it is entered.
    edge: u32,
}

impl Walk {
    /// Anticlockwise beyond `face`, of which the node is corner `i`.
    #[inline]
    fn ahead(s: &Surface, face: u32, i: usize) -> Self {
        let edge = s.face_edges[face as usize][LAST[i]];
        Self { face: beyond(s, edge, face), edge }
    }

    /// Clockwise beyond `face`.
    #[inline]
    fn behind(s: &Surface, face: u32, i: usize) -> Self {
        let edge = s.face_edges[face as usize][i];
        Self { face: beyond(s, edge, face), edge }
    }
}

impl Stars {
    /// O(nodes + edges).
    pub(super) fn new(s: &Surface) -> Self {
        let mut nodes = vec![ALONE; s.positions.len()];
        for (e, &[a, b]) in s.edges.iter().enumerate().filter(|(_, ends)| ends[0] != NONE) {
            for v in [a, b] {
                let at = &mut nodes[v as usize];
                at.anchor = e as u32;
                at.degree += 1;
            }
        }
        for chain in s.chains.iter().filter(|c| c.joint.is_some()) {
            nodes[chain.start.index()].degree |= HELD;
            for v in chain.edges.iter().flat_map(|d| s.edges[d.edge().index()]) {
                nodes[v as usize].degree |= HELD;
            }
        }
        Self { nodes, singular: None }
    }

    /// How many edges end at a node.
    #[inline]
    pub(super) fn degree(&self, node: u32) -> u32 {
        self.nodes[node as usize].degree & !HELD
    }

    /// Whether a joint holds the node.
    #[inline]
    pub(super) fn is_held(&self, node: u32) -> bool {
        self.nodes[node as usize].degree & HELD != 0
    }

    /// All edges at a node. O(edges there); once, where the first singular node is met, O(edges of the surface).
    pub(super) fn edges_at(&mut self, s: &Surface, node: u32, out: &mut Vec<u32>) {
        out.clear();
        let At { anchor, .. } = self.nodes[node as usize];
        if anchor == NONE {
            return;
        }
        if !self.fan(s, node, anchor, out) {
            out.clear();
            out.extend(self.list(s, node));
            out.sort_unstable();
        }
    }

    /// The edges of an ordinary node, anticlockwise, from `edge` or from where the fan begins; `false`, and some of the
    /// edges only, where the node is singular.
    pub(super) fn fan(&self, s: &Surface, node: u32, edge: u32, out: &mut Vec<u32>) -> bool {
        let degree = self.degree(node) as usize;
        let [a, _] = s.edges[edge as usize];
        // The face that runs over the edge away from the node has it on its clockwise side.
        let [left, right] = s.edge_faces[edge as usize];
        let (mut face, back) = if a == node { (left, right) } else { (right, left) };
        out.push(edge);
        while face != NONE && out.len() <= degree {
            let step = Walk::ahead(s, face, corner(s, face, node));
            if step.edge == edge {
                return out.len() == degree;
            }
            out.push(step.edge);
            face = step.face;
        }
        face = back;
        let ahead = out.len();
        while face != NONE && out.len() <= degree {
            let step = Walk::behind(s, face, corner(s, face, node));
            out.push(step.edge);
            face = step.face;
        }
        // Clockwise ones first, outermost first.
        out.reverse();
        let behind = out.len() - ahead;
        out[behind..].reverse();
        out.len() == degree && s.edge_faces[edge as usize] != [NONE; 2]
    }

    /// Whether an edge joins `c` and `d`; `face` has `c` at its corner `i` and not `d`. O(edges at one of them).
    #[inline]
    pub(super) fn joined(&mut self, s: &Surface, face: u32, i: usize, c: u32, d: u32) -> bool {
        // Both ways at once: the two walks do not wait for each other's memory.
        let (mut ahead, mut behind) = (Walk::ahead(s, face, i), Walk::behind(s, face, i));
        // Two edges are those of the face.
        let mut rest = self.degree(c) - 2;
        while rest > 0 {
            let open = ahead.face != NONE;
            if open {
                let face = ahead.face;
                let i = corner(s, face, c);
                if s.faces[face as usize][LAST[i]] == d {
                    return true;
                }
                ahead = Walk::ahead(s, face, i);
                if ahead.edge == behind.edge {
                    break;
                }
                rest -= 1;
            }
            if behind.face != NONE {
                if rest == 0 {
                    break;
                }
                let face = behind.face;
                let i = corner(s, face, c);
                if s.faces[face as usize][NEXT[i]] == d {
                    return true;
                }
                behind = Walk::behind(s, face, i);
                if ahead.edge == behind.edge {
                    break;
                }
                rest -= 1;
            } else if !open {
                break;
            }
        }
        rest > 0 && self.list(s, c).iter().any(|&e| s.edges[e as usize].contains(&d))
    }

    /// All edges of a singular node, in no order that matters.
    #[cold]
    fn list(&mut self, s: &Surface, node: u32) -> &[u32] {
        if self.singular.is_none() {
            let mut all: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
            let mut ordinary = Vec::new();
            for v in 0..self.nodes.len() as u32 {
                let At { anchor, .. } = self.nodes[v as usize];
                ordinary.clear();
                if anchor != NONE && !self.fan(s, v, anchor, &mut ordinary) {
                    all.insert(v, Vec::new());
                }
            }
            for (e, ends) in s.edges.iter().enumerate().filter(|(_, ends)| ends[0] != NONE) {
                for v in ends {
                    if let Some(list) = all.get_mut(v) {
                        list.push(e as u32);
                    }
                }
            }
            self.singular = Some(all);
        }
        self.singular.as_ref().and_then(|all| all.get(&node)).map_or(&[], Vec::as_slice)
    }

    /// An edge that has got the end `node`.
    #[inline]
    pub(super) fn gain(&mut self, node: u32, edge: u32) {
        let at = &mut self.nodes[node as usize];
        at.degree += 1;
        if at.anchor == NONE {
            at.anchor = edge;
        }
        if let Some(list) = self.singular.as_mut().and_then(|all| all.get_mut(&node)) {
            list.push(edge);
        }
    }

    /// An edge that has no longer the end `node`; `other` is one that still has ([`NONE`] for none).
    #[inline]
    pub(super) fn lose(&mut self, node: u32, edge: u32, other: u32) {
        let at = &mut self.nodes[node as usize];
        at.degree -= 1;
        if at.anchor == edge {
            at.anchor = other;
        }
        if let Some(list) = self.singular.as_mut().and_then(|all| all.get_mut(&node)) {
            list.retain(|&e| e != edge);
        }
    }

    /// One edge for another at a node.
    pub(super) fn exchange(&mut self, node: u32, edge: u32, other: u32) {
        let at = &mut self.nodes[node as usize];
        if at.anchor == edge {
            at.anchor = other;
        }
        if let Some(list) = self.singular.as_mut().and_then(|all| all.get_mut(&node)) {
            list.iter_mut().filter(|e| **e == edge).for_each(|e| *e = other);
        }
    }

    /// A new node with its edges, `held` where a joint holds it. `singular` where they are not one fan.
    pub(super) fn place(&mut self, node: u32, edges: &[u32], held: bool, singular: bool) {
        if self.nodes.len() <= node as usize {
            self.nodes.resize(node as usize + 1, ALONE);
        }
        let anchor = edges.first().copied().unwrap_or(NONE);
        self.nodes[node as usize] = At { anchor, degree: edges.len() as u32 | if held { HELD } else { 0 } };
        if let Some(all) = &mut self.singular {
            if singular {
                all.insert(node, edges.to_vec());
            } else {
                all.remove(&node);
            }
        }
    }

    /// A node that is no more, or no more there.
    pub(super) fn remove(&mut self, node: u32) {
        self.nodes[node as usize] = ALONE;
        if let Some(all) = &mut self.singular {
            all.remove(&node);
        }
    }

    /// Compares with stars made anew: for tests, and where an operator is doubted.
    #[cfg(test)]
    pub(super) fn assert_right(&mut self, s: &Surface) {
        let mut anew = Self::new(s);
        let (mut own, mut expected) = (Vec::new(), Vec::new());
        for v in s.live_nodes().map(|v| v.0) {
            assert_eq!(self.nodes[v as usize].degree, anew.nodes[v as usize].degree, "degree of node {v}");
            self.edges_at(s, v, &mut own);
            anew.edges_at(s, v, &mut expected);
            own.sort_unstable();
            expected.sort_unstable();
            assert_eq!(own, expected, "edges at node {v}");
        }
    }
}

impl super::Editor {
    /// All edges at a node, in no order; empty where the node stands alone. O(edges there), O(edges of the surface) when
    /// first asked for a surface.
    pub fn edges_at(&mut self, surface: crate::body::SurfaceId, node: crate::body::NodeId) -> Vec<EdgeId> {
        let Some(s) = self.body.surfaces.get(surface.index()) else { return Vec::new() };
        if !s.is_node(node) {
            return Vec::new();
        }
        let mut edges = Vec::new();
        let stars = self.stars[surface.index()].get_or_insert_with(|| Stars::new(s));
        stars.edges_at(s, node.0, &mut edges);
        edges.into_iter().map(EdgeId).collect()
    }

    /// Operators that change a surface without keeping its stars forget them.
    pub(super) fn forget_stars(&mut self, surface: crate::body::SurfaceId) {
        if let Some(stars) = self.stars.get_mut(surface.index()) {
            *stars = None;
        }
    }
}
