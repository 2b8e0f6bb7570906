//! Edges from faces, edges by their nodes, and the walk along a boundary.

use super::ids::{DirectedEdge, EdgeId, FaceId, NONE};
use super::surface::{NO_CHAIN, Surface};

/// Finds edges by their two nodes: the edges of every lower-numbered node in a list.
#[derive(Clone, Debug, Default)]
pub struct EdgeIndex {
    head: Vec<u32>,
    /// Higher node of the edge and the next edge of the same lower node.
    link: Vec<[u32; 2]>,
}

impl EdgeIndex {
    /// The index over `edges` of a surface with `nodes` nodes. O(nodes + edges).
    pub fn new(nodes: usize, edges: &[[u32; 2]]) -> Self {
        let mut index = Self { head: vec![NONE; nodes], link: Vec::with_capacity(edges.len()) };
        for &[a, b] in edges {
            if a == NONE {
                index.push_none();
            } else {
                index.push(a, b);
            }
        }
        index
    }

    /// Leaves out an edge whose number is free.
    pub(super) fn push_none(&mut self) {
        self.link.push([NONE; 2]);
    }

    #[inline]
    pub(super) fn push(&mut self, a: u32, b: u32) {
        let (lo, hi) = if a < b { (a, b) } else { (b, a) };
        self.link.push([hi, self.head[lo as usize]]);
        self.head[lo as usize] = self.link.len() as u32 - 1;
    }

    /// The edge between two nodes; where there are several, the one with the highest number. O(edges of the lower
    /// node to higher ones), some three on average.
    #[inline]
    pub fn find(&self, a: u32, b: u32) -> Option<EdgeId> {
        let (lo, hi) = if a < b { (a, b) } else { (b, a) };
        let mut e = *self.head.get(lo as usize)?;
        while e != NONE {
            let [other, next] = self.link[e as usize];
            if other == hi {
                return Some(EdgeId(e));
            }
            e = next;
        }
        None
    }
}

/// A side of a face that has no place: two faces lie on the edge already, or one wound the same way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SideConflict {
    pub(crate) face: u32,
    pub(crate) edge: u32,
    /// The face on the edge that runs over it in the same direction.
    pub(crate) same_way: u32,
}

impl Surface {
    /// Makes edges, in the order in which the faces name them first and in that direction, from the faces' nodes.
    ///
    /// All nodes must be in range and a face's three different. O(faces).
    pub(crate) fn build_edges(&mut self) -> Result<(), SideConflict> {
        let expected = self.faces.len() * 3 / 2 + self.positions.len() / 8 + 8;
        let mut index =
            EdgeIndex { head: vec![NONE; self.positions.len()], link: Vec::with_capacity(expected) };
        let mut edges: Vec<[u32; 2]> = Vec::with_capacity(expected);
        let mut edge_faces: Vec<[u32; 2]> = Vec::with_capacity(expected);
        let mut face_edges: Vec<[u32; 3]> = Vec::with_capacity(self.faces.len());
        for (f, &[a, b, c]) in self.faces.iter().enumerate() {
            let f = f as u32;
            let mut sides = [NONE; 3];
            for (i, (p, q)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
                sides[i] = match index.find(p, q) {
                    Some(e) => {
                        let slot = usize::from(edges[e.index()][0] != p);
                        let there = &mut edge_faces[e.index()][slot];
                        if *there != NONE {
                            return Err(SideConflict { face: f, edge: e.0, same_way: *there });
                        }
                        *there = f;
                        e.0
                    }
                    None => {
                        index.push(p, q);
                        edges.push([p, q]);
                        edge_faces.push([f, NONE]);
                        edges.len() as u32 - 1
                    }
                };
            }
            face_edges.push(sides);
        }
        edges.shrink_to_fit();
        edge_faces.shrink_to_fit();
        self.edge_chain = vec![NO_CHAIN; edges.len()];
        self.edges = edges;
        self.edge_faces = edge_faces;
        self.face_edges = face_edges;
        Ok(())
    }

    /// The boundary edge that follows boundary edge `d` (its face on the left): the next one round the fan of faces
    /// at its end. O(faces of the fan).
    pub(crate) fn next_on_boundary(&self, d: DirectedEdge) -> Option<DirectedEdge> {
        let mut edge = d.edge().0;
        let mut face = self.face_left(d);
        for _ in 0..self.faces.len() {
            if face == NONE {
                return None;
            }
            let i = self.face_edges[face as usize].iter().position(|&e| e == edge)?;
            let next = self.face_side(FaceId(face), (i + 1) % 3);
            let beyond = self.face_left(next.flipped());
            if beyond == NONE {
                return Some(next);
            }
            edge = next.edge().0;
            face = beyond;
        }
        None
    }

    /// The boundary as cycles of directed edges with the surface on the left, each started at its edge with the
    /// lowest number and the cycles in order of these. O(edges).
    pub(crate) fn boundary_cycles(&self) -> Vec<Vec<DirectedEdge>> {
        let mut seen = vec![false; self.edges.len()];
        let mut cycles = Vec::new();
        for (e, &[left, right]) in self.edge_faces.iter().enumerate() {
            if seen[e] || (left == NONE) == (right == NONE) {
                continue;
            }
            let first = DirectedEdge::new(EdgeId(e as u32), left == NONE);
            let mut cycle = Vec::new();
            let mut at = first;
            loop {
                seen[at.edge().index()] = true;
                cycle.push(at);
                match self.next_on_boundary(at) {
                    Some(next) if next != first && !seen[next.edge().index()] => at = next,
                    _ => break,
                }
            }
            cycles.push(cycle);
        }
        cycles
    }
}
