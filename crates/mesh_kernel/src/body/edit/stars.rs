//! The edges at every node of a surface, kept while it is edited.

use crate::body::{NONE, Surface};

/// A list of edges for every node: wires and faces that meet only at the node are in it too. Derived from the edges;
/// order within a list means nothing.
#[derive(Clone, Debug, Default)]
pub(super) struct Stars {
    head: Vec<u32>,
    /// The next edge at the first and at the second node of an edge.
    next: Vec<[u32; 2]>,
}

impl Stars {
    /// O(nodes + edges).
    pub(super) fn new(s: &Surface) -> Self {
        let mut stars = Self { head: vec![NONE; s.positions().len()], next: Vec::with_capacity(s.edges().len()) };
        for (e, &ends) in s.edges().iter().enumerate() {
            stars.next.push(ends.map(|v| stars.head[v as usize]));
            ends.iter().for_each(|&v| stars.head[v as usize] = e as u32);
        }
        stars
    }

    pub(super) fn push_node(&mut self) {
        self.head.push(NONE);
    }

    pub(super) fn pop_node(&mut self) {
        self.head.pop();
    }

    /// Adds edge `e` at its end `side` (0 or 1), node `v`. New edges are added in order of their numbers.
    pub(super) fn link(&mut self, e: u32, side: usize, v: u32) {
        if e as usize == self.next.len() {
            self.next.push([NONE; 2]);
        }
        self.next[e as usize][side] = self.head[v as usize];
        self.head[v as usize] = e;
    }

    /// Takes edge `e` out of the list of node `v`, an end of it. `edges` are the surface's, `e` still ending at `v`.
    pub(super) fn unlink(&mut self, e: u32, v: u32, edges: &[[u32; 2]]) {
        let slot = |x: u32| usize::from(edges[x as usize][0] != v);
        let after = self.next[e as usize][slot(e)];
        let mut at = self.head[v as usize];
        if at == e {
            self.head[v as usize] = after;
            return;
        }
        while at != NONE {
            let next = &mut self.next[at as usize][slot(at)];
            if *next == e {
                *next = after;
                return;
            }
            at = *next;
        }
    }

    /// Forgets the last edge, which is in no list any more.
    pub(super) fn pop_edge(&mut self) {
        self.next.pop();
    }

    /// Whether an edge joins `v` and `w`. O(edges at `v`).
    pub(super) fn joined(&self, v: u32, w: u32, edges: &[[u32; 2]]) -> bool {
        let mut at = self.head[v as usize];
        while at != NONE {
            let [a, b] = edges[at as usize];
            if a ^ b ^ v == w {
                return true;
            }
            at = self.next[at as usize][usize::from(a != v)];
        }
        false
    }
}
