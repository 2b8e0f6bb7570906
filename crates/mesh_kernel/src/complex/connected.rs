//! What hangs together: vertices joined by edges and by faces between their loops.

use std::collections::{HashSet, VecDeque};

use super::ids::{EdgeId, FaceId, VertexId};
use super::{Complex, Loop};

/// What a search takes as absent.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Without {
    pub(super) edge: Option<EdgeId>,
    pub(super) face: Option<FaceId>,
}

/// A breadth-first search through one component.
struct Search<'a> {
    complex: &'a Complex,
    without: Without,
    seen: HashSet<VertexId>,
    faces: HashSet<FaceId>,
    queue: VecDeque<VertexId>,
}

impl<'a> Search<'a> {
    fn new(complex: &'a Complex, without: Without, from: VertexId) -> Self {
        Self {
            complex,
            without,
            seen: HashSet::from([from]),
            faces: HashSet::new(),
            queue: VecDeque::from([from]),
        }
    }

    fn reach(&mut self, v: VertexId) {
        if self.seen.insert(v) {
            self.queue.push_back(v);
        }
    }

    /// The rings of a face hang on its outer loop.
    fn through_face(&mut self, f: FaceId) {
        let loops = self.complex.loops(f);
        if loops.len() > 1 && self.without.face != Some(f) && self.faces.insert(f) {
            for l in loops {
                // The rest of the loop hangs on its first vertex by edges.
                let first = match l {
                    Loop::Vertex(v) => Some(*v),
                    Loop::Walk(walk) => walk.iter().find_map(|d| self.complex.origin(*d)),
                };
                if let Some(v) = first {
                    self.reach(v);
                }
            }
        }
    }

    /// Takes the next vertex; `None` at the end.
    fn step(&mut self) -> Option<VertexId> {
        let v = self.queue.pop_front()?;
        for &e in self.complex.edges_at(v) {
            for u in self.complex.uses(e) {
                self.through_face(u.face);
            }
            if self.without.edge != Some(e)
                && let Some([a, b]) = self.complex.ends(e)
            {
                self.reach(if a == v { b } else { a });
            }
        }
        for &f in self.complex.faces_pierced_at(v) {
            self.through_face(f);
        }
        Some(v)
    }
}

impl Complex {
    /// Whether two vertices hang together by edges and faces. Searches from both at once: O(smaller component) where they do not,
    /// O(vertices nearer than they are to each other) where they do.
    pub fn connected(&self, a: VertexId, b: VertexId) -> bool {
        self.connected_without(a, b, Without::default())
    }

    pub(super) fn connected_without(&self, a: VertexId, b: VertexId, without: Without) -> bool {
        let [mut from_a, mut from_b] = [a, b].map(|v| Search::new(self, without, v));
        loop {
            match from_a.step() {
                Some(v) if from_b.seen.contains(&v) => return true,
                Some(_) => {}
                None => return false,
            }
            match from_b.step() {
                Some(v) if from_a.seen.contains(&v) => return true,
                Some(_) => {}
                None => return false,
            }
        }
    }

    /// In how many components the vertices lie. O(those components), less where they are near to each other.
    pub(super) fn components_of(&self, vertices: &[VertexId], without: Without) -> usize {
        let mut rest: Vec<VertexId> = vertices.to_vec();
        rest.sort_unstable();
        rest.dedup();
        let mut components = 0;
        while let Some(from) = rest.pop() {
            components += 1;
            let mut search = Search::new(self, without, from);
            while !rest.is_empty() && search.step().is_some() {
                rest.retain(|v| !search.seen.contains(v));
            }
        }
        components
    }
}

/// Disjoint sets by path halving.
pub(super) struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    pub(super) fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).collect() }
    }

    pub(super) fn find(&mut self, mut x: u32) -> u32 {
        while self.parent[x as usize] != x {
            let up = self.parent[self.parent[x as usize] as usize];
            self.parent[x as usize] = up;
            x = up;
        }
        x
    }

    /// Whether they were apart.
    pub(super) fn union(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        // The lower number stays the root: results do not depend on the order of unions.
        self.parent[a.max(b) as usize] = a.min(b);
        a != b
    }
}
