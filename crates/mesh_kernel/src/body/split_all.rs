//! Every face of every surface into four (1 → 4), at once.

use glam::DVec3;

use super::Body;
use super::carry::Piece;
use super::ids::{ChainId, DirectedEdge, EdgeId, NONE, SurfaceId};
use super::surface::{NO_CHAIN, Surface, chain_slot};

/// Why a body was not split.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SplitError {
    /// The midpoints given are not one list a surface and one position an edge.
    #[error("{given} midpoints were given for {what}, which needs {needed}")]
    Midpoints {
        /// What they are for.
        what: String,
        /// How many were given.
        given: usize,
        /// How many it needs.
        needed: usize,
    },
    /// Numbers are free in between.
    #[error("the body has free numbers; make it compact first")]
    Sparse,
    /// The result would have more faces than ids.
    #[error("surface `{0}` has too many faces to be split into four each")]
    TooLarge(String),
}

/// What became of a surface in [`Body::split_all`].
///
/// Old nodes keep their numbers. Edge `e` from `a` to `b` gets node `old_nodes + e` and becomes edges `2e` from `a` and
/// `2e + 1` to `b`. Face `f` with corners 0, 1, 2 becomes `4f`, `4f + 1`, `4f + 2`, each with the old corner of that
/// number, and `4f + 3` in the middle. Edge `2 · old_edges + 3f + i` cuts corner `i` of face `f` off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceSplit {
    /// Nodes before.
    pub old_nodes: u32,
    /// Edges before.
    pub old_edges: u32,
    /// Faces before.
    pub old_faces: u32,
}

impl SurfaceSplit {
    /// The node that split an edge.
    pub fn node_of_edge(&self, edge: EdgeId) -> u32 {
        self.old_nodes + edge.0
    }

    /// The edge that a node split; `None` for a node that was there before.
    pub fn edge_of_node(&self, node: u32) -> Option<EdgeId> {
        (node >= self.old_nodes).then(|| EdgeId(node - self.old_nodes))
    }
}

/// What became of every surface, in order of their ids.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SplitMap {
    /// One entry a surface.
    pub surfaces: Vec<SurfaceSplit>,
}

impl SplitMap {
    /// The entry of a surface.
    pub fn surface(&self, id: SurfaceId) -> &SurfaceSplit {
        &self.surfaces[id.index()]
    }
}

impl Body {
    /// Splits every face into four; edges without faces into two. Numbers are as [`SurfaceSplit`] says.
    ///
    /// `midpoints` gives, for every surface in order of ids, a position for every edge; without it, edges are halved.
    /// Joints, chains, loops, attributes, backup and planar positions follow. Edges that correspond on a joint get one
    /// position, bit for bit: that of the joint's edge on the lowest surface.
    ///
    /// # Errors
    /// A body that is not compact; midpoints of the wrong number; too many faces for 32-bit ids. Nothing is changed then. O(faces).
    pub fn split_all(&mut self, midpoints: Option<&[Vec<DVec3>]>) -> Result<SplitMap, SplitError> {
        if !self.is_compact() {
            return Err(SplitError::Sparse);
        }
        if let Some(given) = midpoints
            && given.len() != self.surfaces.len()
        {
            let what = "the body's surfaces".into();
            return Err(SplitError::Midpoints { what, given: given.len(), needed: self.surfaces.len() });
        }
        for (i, s) in self.surfaces.iter().enumerate() {
            // Directed edges take one bit of an id.
            if 2 * s.edges.len() as u64 + 3 * s.faces.len() as u64 >= 1 << 31 {
                return Err(SplitError::TooLarge(s.name.clone()));
            }
            if let Some(given) = midpoints.map(|m| m[i].len())
                && given != s.edges.len()
            {
                let what = format!("the edges of surface `{}`", s.name);
                return Err(SplitError::Midpoints { what, given, needed: s.edges.len() });
            }
        }
        let mut splits = Vec::with_capacity(self.surfaces.len());
        for (i, s) in self.surfaces.iter_mut().enumerate() {
            splits.push(split_surface(s, midpoints.map(|m| &m[i][..])));
        }
        if midpoints.is_some() {
            self.sync_joints();
        }
        Ok(SplitMap { surfaces: splits })
    }
}

/// Children of a face by the areal coordinates of their corners in it.
const CHILDREN: [[[f64; 3]; 3]; 4] = [
    [[1.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5]],
    [[0.5, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.5, 0.5]],
    [[0.5, 0.0, 0.5], [0.0, 0.5, 0.5], [0.0, 0.0, 1.0]],
    [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]],
];

fn split_surface(s: &mut Surface, midpoints: Option<&[DVec3]>) -> SurfaceSplit {
    let (nodes, edges, faces) = (s.positions.len(), s.edges.len(), s.faces.len());
    let split = SurfaceSplit { old_nodes: nodes as u32, old_edges: edges as u32, old_faces: faces as u32 };
    if !s.attribute_nodes.is_empty() {
        carry_attributes(s, &split);
    }
    s.positions.reserve_exact(edges);
    match midpoints {
        Some(given) => s.positions.extend_from_slice(given),
        None => {
            for &[a, b] in &s.edges {
                let middle = (s.positions[a as usize] + s.positions[b as usize]) * 0.5;
                s.positions.push(middle);
            }
        }
    }
    if !s.backup.is_empty() {
        for &[a, b] in &s.edges {
            s.backup.push((s.backup[a as usize] + s.backup[b as usize]) * 0.5);
        }
    }
    if !s.planar.is_empty() {
        for &[a, b] in &s.edges {
            s.planar.push((s.planar[a as usize] + s.planar[b as usize]) * 0.5);
        }
    }

    let middle = nodes as u32;
    let inner = 2 * edges as u32;
    let mut new_edges = Vec::with_capacity(2 * edges + 3 * faces);
    let mut edge_faces = Vec::with_capacity(2 * edges + 3 * faces);
    for (e, (&[a, b], &[left, right])) in s.edges.iter().zip(&s.edge_faces).enumerate() {
        let m = middle + e as u32;
        new_edges.push([a, m]);
        new_edges.push([m, b]);
        // A face's child at corner i holds the half of its side i next to that corner.
        let side = |f: u32| {
            if f == NONE {
                return [NONE; 2];
            }
            let [p, q, _] = s.face_edges[f as usize];
            let i = if p == e as u32 {
                0
            } else if q == e as u32 {
                1
            } else {
                2
            };
            [4 * f + i, 4 * f + if i == 2 { 0 } else { i + 1 }]
        };
        let ([left_a, left_b], [right_b, right_a]) = (side(left), side(right));
        edge_faces.push([left_a, right_a]);
        edge_faces.push([left_b, right_b]);
    }
    let mut new_faces = Vec::with_capacity(4 * faces);
    let mut face_edges = Vec::with_capacity(4 * faces);
    for (f, (&[v0, v1, v2], &[e0, e1, e2])) in s.faces.iter().zip(&s.face_edges).enumerate() {
        let f = f as u32;
        let [m0, m1, m2] = [middle + e0, middle + e1, middle + e2];
        // Halves of a side: the one at its start, the one at its end, in the face's direction.
        let halves = |e: u32, start: u32| {
            let back = u32::from(s.edges[e as usize][0] != start);
            [2 * e + back, 2 * e + 1 - back]
        };
        let [[a0, b0], [a1, b1], [a2, b2]] = [halves(e0, v0), halves(e1, v1), halves(e2, v2)];
        let [c0, c1, c2] = [inner + 3 * f, inner + 3 * f + 1, inner + 3 * f + 2];
        new_faces.extend_from_slice(&[[v0, m0, m2], [m0, v1, m1], [m2, m1, v2], [m0, m1, m2]]);
        face_edges.extend_from_slice(&[[a0, c0, b2], [b0, a1, c1], [c2, b1, a2], [c1, c2, c0]]);
        new_edges.extend_from_slice(&[[m0, m2], [m1, m0], [m2, m1]]);
        let centre = 4 * f + 3;
        edge_faces.extend_from_slice(&[[4 * f, centre], [4 * f + 1, centre], [4 * f + 2, centre]]);
    }

    let mut edge_chain = vec![NO_CHAIN; new_edges.len()];
    for (c, chain) in s.chains.iter_mut().enumerate() {
        let mut halves = Vec::with_capacity(2 * chain.edges.len());
        for d in &chain.edges {
            let back = u32::from(d.is_reversed());
            let e = d.edge().0;
            for half in [2 * e + back, 2 * e + 1 - back] {
                halves.push(DirectedEdge::new(EdgeId(half), d.is_reversed()));
                edge_chain[half as usize] = chain_slot(ChainId(c as u32));
            }
        }
        chain.edges = halves;
    }
    s.edges = new_edges;
    s.edge_faces = edge_faces;
    s.edge_chain = edge_chain;
    s.faces = new_faces;
    s.face_edges = face_edges;
    s.mend_lines();
    split
}

/// Attributes onto the children, before the surface itself is split.
fn carry_attributes(s: &mut Surface, split: &SurfaceSplit) {
    let inner = 2 * split.old_edges;
    s.carry_attributes(
        |e| Some(([EdgeId(2 * e), EdgeId(2 * e + 1)], 0.5)),
        |f| {
            let faces = (0..4).map(|i| (4 * f + i, CHILDREN[i as usize])).collect();
            let cut = |i: usize| {
                // Middles of sides 0, 1, 2.
                let m = [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]];
                let [p, q] = [[0, 2], [1, 0], [2, 1]][i];
                (inner + 3 * f + i as u32, [m[p], m[q]])
            };
            Some(Piece { faces, cuts: (0..3).map(cut).collect() })
        },
    );
}
