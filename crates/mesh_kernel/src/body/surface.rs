//! One surface: flat arrays of nodes, edges and faces, with its chains, loops and attributes.

use glam::{DVec2, DVec3};

use super::adjacency::EdgeIndex;
use super::attribute::{AttributeEdge, AttributeNode};
use super::chain::{Chain, Loop};
use super::ids::{ChainId, DirectedEdge, EdgeId, FaceId, LoopId, NONE, NodeId};
use super::slots::SurfaceSlots;

/// Entry of [`Surface::edge_chain`] for an edge on no chain.
pub(crate) const NO_CHAIN: u32 = 0;

/// Entry of [`Surface::edge_chain`] for an edge on a chain.
pub(crate) fn chain_slot(chain: ChainId) -> u32 {
    chain.0 + 1
}

/// A triangle patch (MESHSURFACE), in which an edge has at most two faces, wound alike.
///
/// It may be incomplete: nodes without edges, edges without faces, faces that meet only at a node.
///
/// Side `i` of a face runs from its corner `i` to corner `i + 1`. Who has a face finds its edges and nodes, who has
/// an edge its nodes and faces, all in O(1); stars of nodes are derived ([`Surface::node_edges`]).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    pub(crate) name: String,
    pub(crate) positions: Vec<DVec3>,
    /// Empty where none was stored.
    pub(crate) backup: Vec<DVec3>,
    /// Empty where the surface has not been flattened.
    pub(crate) planar: Vec<DVec2>,
    pub(crate) edges: Vec<[u32; 2]>,
    pub(crate) edge_faces: Vec<[u32; 2]>,
    /// The chain of every edge as [`chain_slot`] writes it. Few edges have one, and memory of zeros costs nothing
    /// until it is written.
    pub(crate) edge_chain: Vec<u32>,
    pub(crate) faces: Vec<[u32; 3]>,
    pub(crate) face_edges: Vec<[u32; 3]>,
    pub(crate) chains: Vec<Chain>,
    pub(crate) loops: Vec<Loop>,
    pub(crate) attribute_nodes: Vec<AttributeNode>,
    pub(crate) attribute_edges: Vec<AttributeEdge>,
    pub(crate) slots: SurfaceSlots,
}

impl Surface {
    /// The name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Node positions, in millimetres.
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Node positions, to be moved. Nodes that a joint holds together must be moved together;
    /// [`super::Body::sync_joints`] makes them equal again.
    pub fn positions_mut(&mut self) -> &mut [DVec3] {
        &mut self.positions
    }

    /// The positions kept by [`Surface::store_backup`], if any.
    pub fn backup(&self) -> Option<&[DVec3]> {
        (!self.backup.is_empty()).then_some(&self.backup)
    }

    /// Keeps the present positions, so that [`Surface::restore_backup`] can take them back.
    pub fn store_backup(&mut self) {
        self.backup.clone_from(&self.positions);
    }

    /// Takes the kept positions back; `false` where none were kept.
    pub fn restore_backup(&mut self) -> bool {
        let kept = !self.backup.is_empty();
        if kept {
            self.positions.clone_from(&self.backup);
        }
        kept
    }

    /// The flattened pattern's position of every node, in millimetres, if the surface has been flattened.
    pub fn planar(&self) -> Option<&[DVec2]> {
        (!self.planar.is_empty()).then_some(&self.planar)
    }

    /// Sets the flattened pattern; `false`, and nothing set, where there is not one position a node.
    pub fn set_planar(&mut self, planar: Vec<DVec2>) -> bool {
        let fits = planar.len() == self.positions.len();
        if fits {
            self.planar = planar;
        }
        fits
    }

    /// Whether a node of that number lives.
    #[inline]
    pub fn is_node(&self, node: NodeId) -> bool {
        node.index() < self.positions.len() && !self.slots.nodes.is_free(node.0)
    }

    /// Whether an edge of that number lives.
    #[inline]
    pub fn is_edge(&self, edge: EdgeId) -> bool {
        self.edges.get(edge.index()).is_some_and(|ends| ends[0] != NONE)
    }

    /// Whether a face of that number lives.
    #[inline]
    pub fn is_face(&self, face: FaceId) -> bool {
        self.faces.get(face.index()).is_some_and(|corners| corners[0] != NONE)
    }

    /// The nodes that live, in order. O(nodes).
    pub fn live_nodes(&self) -> impl Iterator<Item = NodeId> + Clone + '_ {
        (0..self.positions.len() as u32).map(NodeId).filter(|&v| !self.slots.nodes.is_free(v.0))
    }

    /// The edges that live, in order. O(edges).
    pub fn live_edges(&self) -> impl Iterator<Item = EdgeId> + Clone + '_ {
        (0..self.edges.len() as u32).map(EdgeId).filter(|&e| self.is_edge(e))
    }

    /// The faces that live, in order. O(faces).
    pub fn live_faces(&self) -> impl Iterator<Item = FaceId> + Clone + '_ {
        (0..self.faces.len() as u32).map(FaceId).filter(|&f| self.is_face(f))
    }

    /// Nodes, edges and faces that live.
    pub fn live_counts(&self) -> [usize; 3] {
        let free = [&self.slots.nodes, &self.slots.edges, &self.slots.faces].map(|s| s.free().len());
        [self.positions.len() - free[0], self.edges.len() - free[1], self.faces.len() - free[2]]
    }

    /// Whether no number is free. Bodies are compact until an operator removes something.
    pub fn is_compact(&self) -> bool {
        self.slots.is_compact()
    }

    /// Faces as node triples; three times [`NONE`] where the number is free.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// Edges as node pairs; twice [`NONE`] where the number is free. The left face runs from the first node to the second.
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// Left and right face of every edge, [`super::NONE`] where there is none.
    pub fn edge_faces(&self) -> &[[u32; 2]] {
        &self.edge_faces
    }

    /// The three edges of every face: side `i` joins corners `i` and `i + 1`.
    pub fn face_edges(&self) -> &[[u32; 3]] {
        &self.face_edges
    }

    /// Side `i` of a face as an edge with the face's direction over it.
    #[inline]
    pub fn face_side(&self, face: FaceId, i: usize) -> DirectedEdge {
        let e = self.face_edges[face.index()][i];
        DirectedEdge::new(EdgeId(e), self.edges[e as usize][0] != self.faces[face.index()][i])
    }

    /// The chains.
    pub fn chains(&self) -> &[Chain] {
        &self.chains
    }

    /// One chain.
    pub fn chain(&self, id: ChainId) -> &Chain {
        &self.chains[id.index()]
    }

    /// The boundary loops.
    pub fn loops(&self) -> &[Loop] {
        &self.loops
    }

    /// The chain that an edge lies on.
    #[inline]
    pub fn edge_chain(&self, edge: EdgeId) -> Option<ChainId> {
        self.edge_chain[edge.index()].checked_sub(1).map(ChainId)
    }

    /// Start and end of a directed edge.
    #[inline]
    pub fn ends(&self, d: DirectedEdge) -> [NodeId; 2] {
        let [a, b] = self.edges[d.edge().index()];
        if d.is_reversed() { [NodeId(b), NodeId(a)] } else { [NodeId(a), NodeId(b)] }
    }

    /// The last node of a chain; the first one where the chain is closed or has no edges.
    pub fn chain_end(&self, id: ChainId) -> NodeId {
        let chain = self.chain(id);
        chain.edges.last().map_or(chain.start, |&d| self.ends(d)[1])
    }

    /// Whether the chain comes back to its first node.
    pub fn chain_is_closed(&self, id: ChainId) -> bool {
        let chain = self.chain(id);
        !chain.edges.is_empty() && self.chain_end(id) == chain.start
    }

    /// All nodes of a chain in order, one more than it has edges; a closed chain names its first node twice.
    pub fn chain_nodes(&self, id: ChainId) -> Vec<u32> {
        let chain = self.chain(id);
        let mut nodes = Vec::with_capacity(chain.edges.len() + 1);
        nodes.push(chain.start.0);
        nodes.extend(chain.edges.iter().map(|&d| self.ends(d)[1].0));
        nodes
    }

    /// All nodes of a loop in order, each once a passage, the surface on the left.
    pub fn loop_nodes(&self, id: LoopId) -> Vec<u32> {
        let mut nodes = Vec::new();
        for &c in &self.loops[id.index()].chains {
            nodes.extend(self.chain(c).edges.iter().map(|&d| self.ends(d)[0].0));
        }
        nodes
    }

    /// Corners of a face.
    #[inline]
    pub fn corners(&self, face: FaceId) -> [DVec3; 3] {
        self.faces[face.index()].map(|v| self.positions[v as usize])
    }

    /// The node of `face` that is not on its side `edge`.
    #[inline]
    pub(crate) fn apex(&self, face: u32, edge: u32) -> u32 {
        let i = self.face_edges[face as usize].iter().position(|&e| e == edge).unwrap_or(0);
        self.faces[face as usize][(i + 2) % 3]
    }

    /// The face on a side of a directed edge: left is the one that runs along it.
    #[inline]
    pub(crate) fn face_left(&self, d: DirectedEdge) -> u32 {
        self.edge_faces[d.edge().index()][usize::from(d.is_reversed())]
    }

    /// A table to find edges by their nodes. O(edges) to make.
    pub fn edge_index(&self) -> EdgeIndex {
        EdgeIndex::new(self.positions.len(), &self.edges)
    }

    /// The edges at every node, in order of their numbers. O(nodes + edges).
    pub fn node_edges(&self) -> Star {
        let mut starts = vec![0u32; self.positions.len() + 1];
        for &[a, b] in self.edges.iter().filter(|ends| ends[0] != NONE) {
            starts[a as usize + 1] += 1;
            starts[b as usize + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut fill = starts.clone();
        let mut edges = vec![0; *starts.last().unwrap_or(&0) as usize];
        for (e, ends) in self.edges.iter().enumerate().filter(|(_, ends)| ends[0] != NONE) {
            for &v in ends {
                edges[fill[v as usize] as usize] = e as u32;
                fill[v as usize] += 1;
            }
        }
        Star { starts, edges }
    }

    /// Area, in mm².
    pub fn area(&self) -> f64 {
        let twice = |f: FaceId| {
            let [a, b, c] = self.corners(f);
            (b - a).cross(c - a).length()
        };
        self.live_faces().map(twice).sum::<f64>() * 0.5
    }

    /// Bytes held by the arrays of nodes, edges and faces.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.positions[..])
            + size_of_val(&self.backup[..])
            + size_of_val(&self.planar[..])
            + size_of_val(&self.edges[..])
            + size_of_val(&self.edge_faces[..])
            + size_of_val(&self.edge_chain[..])
            + size_of_val(&self.faces[..])
            + size_of_val(&self.face_edges[..])
    }
}

/// The edges at every node of a surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Star {
    starts: Vec<u32>,
    edges: Vec<u32>,
}

impl Star {
    /// Edges at a node.
    pub fn of(&self, node: NodeId) -> &[u32] {
        &self.edges[self.starts[node.index()] as usize..self.starts[node.index() + 1] as usize]
    }
}
