//! Which faces meet at which edge.

use crate::TriMesh;

/// No partner, no component yet.
const NONE: u32 = u32::MAX;

/// Edges of a triangle mesh and the faces at them, for any mesh: open, non-manifold, inconsistently oriented.
///
/// *Half-edge* `3 f + k` runs from corner `k` to corner `(k + 1) % 3` of face `f`. Sides of a face that joins a node to
/// itself are left out.
#[derive(Clone, Debug)]
pub struct Adjacency {
    faces: Vec<[u32; 3]>,
    node_count: usize,
    edges: Vec<[u32; 2]>,
    /// Half-edges of edge `e`: `half_edges[edge_starts[e]..edge_starts[e + 1]]`.
    edge_starts: Vec<u32>,
    half_edges: Vec<u32>,
    edge_of: Vec<u32>,
    partner: Vec<u32>,
}

impl Adjacency {
    /// Finds all edges. O(faces), apart from sorting the edges at a node by their other end.
    pub fn new(mesh: &TriMesh) -> Self {
        let faces = mesh.faces.clone();
        let node_count = mesh.positions.len();
        let ends = |h: u32| {
            let face = faces[h as usize / 3];
            let (a, b) = (face[h as usize % 3], face[(h as usize + 1) % 3]);
            (a.min(b), a.max(b))
        };
        let count = 3 * faces.len() as u32;
        let mut starts = vec![0u32; node_count + 1];
        for (lo, hi) in (0..count).map(ends) {
            starts[lo as usize + 1] += u32::from(lo != hi);
        }
        for node in 0..node_count {
            starts[node + 1] += starts[node];
        }
        let mut fill = starts.clone();
        let mut sorted = vec![(0u32, 0u32); starts[node_count] as usize];
        for h in 0..count {
            let (lo, hi) = ends(h);
            if lo != hi {
                sorted[fill[lo as usize] as usize] = (hi, h);
                fill[lo as usize] += 1;
            }
        }
        let mut adjacency = Self {
            node_count,
            edges: Vec::with_capacity(sorted.len() / 2),
            edge_starts: Vec::with_capacity(sorted.len() / 2 + 1),
            half_edges: Vec::with_capacity(sorted.len()),
            edge_of: vec![NONE; count as usize],
            partner: vec![NONE; count as usize],
            faces: Vec::new(),
        };
        for node in 0..node_count {
            let at_node = &mut sorted[starts[node] as usize..starts[node + 1] as usize];
            at_node.sort_unstable();
            for same in at_node.chunk_by(|a, b| a.0 == b.0) {
                let edge = adjacency.edges.len() as u32;
                adjacency.edges.push([node as u32, same[0].0]);
                adjacency.edge_starts.push(adjacency.half_edges.len() as u32);
                for (_, h) in same {
                    adjacency.edge_of[*h as usize] = edge;
                    adjacency.half_edges.push(*h);
                }
            }
        }
        adjacency.edge_starts.push(adjacency.half_edges.len() as u32);
        adjacency.faces = faces;
        adjacency.pair();
        adjacency
    }

    /// Pairs the half-edges of every edge: opposite directions first, then what is left over.
    fn pair(&mut self) {
        let mut left_over: [Vec<u32>; 2] = [Vec::new(), Vec::new()];
        for edge in 0..self.edges.len() {
            let lo = self.edges[edge][0];
            let range = self.edge_starts[edge] as usize..self.edge_starts[edge + 1] as usize;
            left_over.iter_mut().for_each(Vec::clear);
            for &h in &self.half_edges[range] {
                let forward = self.faces[h as usize / 3][h as usize % 3] == lo;
                left_over[usize::from(forward)].push(h);
            }
            let [back, forth] = &mut left_over;
            let opposite = back.len().min(forth.len());
            for (a, b) in back.drain(..opposite).zip(forth.drain(..opposite)) {
                self.partner[a as usize] = b;
                self.partner[b as usize] = a;
            }
            for pair in back.chunks_exact(2).chain(forth.chunks_exact(2)) {
                self.partner[pair[0] as usize] = pair[1];
                self.partner[pair[1] as usize] = pair[0];
            }
        }
    }

    /// The edges: smaller node first, ordered by it and then by the other node.
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// The half-edges on edge `edge`, in ascending order.
    pub fn half_edges(&self, edge: u32) -> &[u32] {
        &self.half_edges
            [self.edge_starts[edge as usize] as usize..self.edge_starts[edge as usize + 1] as usize]
    }

    /// The edge that half-edge `h` lies on; `None` for a side that joins a node to itself.
    pub fn edge_of(&self, h: u32) -> Option<u32> {
        Some(self.edge_of[h as usize]).filter(|edge| *edge != NONE)
    }

    /// The edge between two nodes. O(log edges).
    pub fn find_edge(&self, a: u32, b: u32) -> Option<u32> {
        self.edges.binary_search(&[a.min(b), a.max(b)]).ok().map(|edge| edge as u32)
    }

    /// First and last node of half-edge `h`.
    pub fn ends(&self, h: u32) -> [u32; 2] {
        let face = self.faces[h as usize / 3];
        [face[h as usize % 3], face[(h as usize + 1) % 3]]
    }

    /// The half-edge across `h`: of the opposite direction where there is one. Where more than two faces meet, they are
    /// paired in the order of their numbers; one may be left without a partner.
    #[inline]
    pub fn partner(&self, h: u32) -> Option<u32> {
        Some(self.partner[h as usize]).filter(|partner| *partner != NONE)
    }

    /// The face across each side of `face`.
    pub fn neighbours(&self, face: u32) -> [Option<u32>; 3] {
        [0, 1, 2].map(|k| self.partner(3 * face + k).map(|h| h / 3))
    }

    /// Whether exactly two faces of opposite direction meet at every edge.
    pub fn is_closed_manifold(&self) -> bool {
        (0..self.edges.len() as u32).all(|edge| match self.half_edges(edge) {
            [a, b] => self.ends(*a) != self.ends(*b),
            _ => false,
        })
    }

    /// Whether at every edge as many faces run one way as the other: then the winding number of the mesh is a whole
    /// number everywhere off it.
    pub fn is_closed(&self) -> bool {
        (0..self.edges.len() as u32).all(|edge| {
            let lo = self.edges[edge as usize][0];
            let forth = self.half_edges(edge).iter().filter(|h| self.ends(**h)[0] == lo).count();
            2 * forth == self.half_edges(edge).len()
        })
    }

    /// Boundary loops: the nodes in order, faces to the left (inner holes therefore run clockwise). A chain that does
    /// not close, at edges with several faces or in inconsistently oriented meshes, is returned as it ends.
    pub fn boundary_loops(&self) -> Vec<Vec<u32>> {
        let free: Vec<u32> = (0..self.edges.len() as u32)
            .filter_map(|edge| match self.half_edges(edge) {
                [h] => Some(*h),
                _ => None,
            })
            .collect();
        let mut by_start: Vec<(u32, u32)> = free.iter().map(|h| (self.ends(*h)[0], *h)).collect();
        by_start.sort_unstable();
        let mut used = vec![false; self.partner.len()];
        let mut loops = Vec::new();
        for first in free {
            if used[first as usize] {
                continue;
            }
            let mut nodes = Vec::new();
            let mut h = first;
            loop {
                used[h as usize] = true;
                nodes.push(self.ends(h)[0]);
                let end = self.ends(h)[1];
                // Two sheets may touch in a node: turning about it stays on the sheet. Elsewhere any free edge goes.
                let next =
                    self.turn(h).filter(|next| !used[*next as usize] || *next == first).or_else(|| {
                        let from = by_start.partition_point(|(start, _)| *start < end);
                        let mut out = by_start[from..].iter().take_while(|(start, _)| *start == end);
                        out.find(|(_, h)| !used[*h as usize]).map(|(_, h)| *h)
                    });
                match next {
                    Some(next) if next != first => h = next,
                    Some(_) => break,
                    None => {
                        if end != nodes[0] {
                            nodes.push(end);
                        }
                        break;
                    }
                }
            }
            loops.push(nodes);
        }
        loops
    }

    /// From a free half-edge through the faces about its end to the next free one.
    fn turn(&self, free: u32) -> Option<u32> {
        let pivot = self.ends(free)[1];
        let mut h = free;
        for _ in 0..self.partner.len() {
            h = h / 3 * 3 + (h + 1) % 3;
            if self.ends(h)[0] != pivot {
                return None;
            }
            match self.partner(h) {
                Some(partner) => h = partner,
                None => return Some(h).filter(|h| self.edge_of(*h).is_some()),
            }
        }
        None
    }

    /// Component number of every face (faces that share an edge belong together; numbered by their first face), and
    /// the number of components.
    pub fn components(&self) -> (Vec<u32>, usize) {
        let mut component = vec![NONE; self.faces.len()];
        let mut count = 0;
        let mut stack = Vec::new();
        for seed in 0..self.faces.len() as u32 {
            if component[seed as usize] != NONE {
                continue;
            }
            component[seed as usize] = count;
            stack.push(seed);
            while let Some(face) = stack.pop() {
                for edge in (0..3).filter_map(|k| self.edge_of(3 * face + k)) {
                    for other in self.half_edges(edge).iter().map(|h| h / 3) {
                        if component[other as usize] == NONE {
                            component[other as usize] = count;
                            stack.push(other);
                        }
                    }
                }
            }
            count += 1;
        }
        (component, count as usize)
    }

    /// Number of nodes of the mesh, with those that no face uses.
    pub fn node_count(&self) -> usize {
        self.node_count
    }
}
