//! One face into four, through joints.

use std::collections::{BTreeMap, BTreeSet};

use super::Body;
use super::carry::Piece;
use super::ids::{ChainId, DirectedEdge, EdgeId, FaceId, NONE, SurfaceId};
use super::surface::{NO_CHAIN, Surface};

/// Why a face was not split.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SplitFaceError {
    /// No such surface.
    #[error("the body has no surface {0}")]
    NoSurface(SurfaceId),
    /// No such face.
    #[error("surface {surface} has no face {face}")]
    NoFace {
        /// Surface.
        surface: SurfaceId,
        /// Face.
        face: FaceId,
    },
    /// Ids would run out.
    #[error("surface {0} has no ids left for more edges")]
    TooLarge(SurfaceId),
}

/// What a face was split into.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FaceSplit {
    /// The faces with corners 0, 1 and 2 (the first has the old id), and the one in the middle.
    pub children: [FaceId; 4],
    /// The new nodes on sides 0, 1 and 2.
    pub nodes: [u32; 3],
    /// All edges that got a node, on any surface, with the node; in order of surfaces and edges.
    pub edges: Vec<SplitEdge>,
}

/// An edge that got a node in its middle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SplitEdge {
    /// Surface.
    pub surface: SurfaceId,
    /// The edge; it is now the half at its first node.
    pub edge: EdgeId,
    /// The new edge: the half at its second node.
    pub second: EdgeId,
    /// The new node.
    pub node: u32,
}

/// Points of a face that is cut: corners 0, 1, 2 and middles 3, 4, 5 of sides 0, 1, 2.
type Local = u8;

const AREAL: [[f64; 3]; 6] =
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]];

/// How a face is cut, in its local points.
struct Cutting {
    children: Vec<[Local; 3]>,
    cuts: Vec<[Local; 2]>,
}

impl Cutting {
    /// The cutting of a face whose sides in `split` get a node. Of the two ways to cut a quadrilateral the shorter
    /// diagonal is taken, the one from the side split first if they are equal.
    fn new(split: [bool; 3], squared: impl Fn(Local, Local) -> f64) -> Self {
        let at = |i: usize| (i % 3) as Local;
        let middle = |i: usize| 3 + (i % 3) as Local;
        match split.iter().filter(|s| **s).count() {
            3 => Self {
                children: vec![[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
                cuts: vec![[3, 5], [4, 3], [5, 4]],
            },
            2 => {
                // Sides i and i + 1 meet in corner i + 1, which is cut off.
                let i = if !split[2] {
                    0
                } else if !split[0] {
                    1
                } else {
                    2
                };
                let (m, n) = (middle(i), middle(i + 1));
                let (a, c) = (at(i), at(i + 2));
                let corner = [m, at(i + 1), n];
                if squared(m, c) <= squared(a, n) {
                    Self { children: vec![[a, m, c], corner, [m, n, c]], cuts: vec![[m, n], [m, c]] }
                } else {
                    Self { children: vec![[a, m, n], corner, [a, n, c]], cuts: vec![[m, n], [a, n]] }
                }
            }
            _ => {
                let i = split.iter().position(|s| *s).unwrap_or(0);
                let (m, a, b, c) = (middle(i), at(i), at(i + 1), at(i + 2));
                Self { children: vec![[a, m, c], [m, b, c]], cuts: vec![[m, c]] }
            }
        }
    }
}

/// The changes to one surface, found before anything is changed.
struct Plan {
    /// Edges that get nodes, in order.
    edges: Vec<u32>,
    /// Faces that are cut, in order, with the cutting and the numbers of their first new face and first cut.
    faces: BTreeMap<u32, (Cutting, u32, u32)>,
}

impl Body {
    /// Splits a face into four by nodes in the middle of its sides.
    ///
    /// Edges that correspond to its sides on joints get nodes too, bit-equal in position, and all faces on edges that got
    /// nodes, here and on other surfaces, are cut along: into two, three or four. Nodes, edges and faces keep their
    /// numbers (an edge as its first half, a face as its first part); new ones are added at the end. Chains, loops,
    /// attributes, backup and planar positions follow.
    ///
    /// # Errors
    /// Unknown ids; ids run out. Nothing is changed then. O(edges of the chains concerned).
    pub fn split_face(&mut self, surface: SurfaceId, face: FaceId) -> Result<FaceSplit, SplitFaceError> {
        let s = self.surfaces.get(surface.index()).ok_or(SplitFaceError::NoSurface(surface))?;
        let &sides = s.face_edges.get(face.index()).ok_or(SplitFaceError::NoFace { surface, face })?;
        let mut wanted: BTreeSet<(SurfaceId, u32)> = BTreeSet::new();
        for e in sides {
            wanted.insert((surface, e));
            wanted.extend(self.partners(surface, EdgeId(e)).into_iter().map(|(t, d)| (t, d.edge().0)));
        }
        let mut plans: BTreeMap<SurfaceId, Vec<u32>> = BTreeMap::new();
        for (t, e) in wanted {
            plans.entry(t).or_default().push(e);
        }
        let plans: Vec<(SurfaceId, Plan)> =
            plans.into_iter().map(|(t, edges)| (t, Plan::new(self.surface(t), edges))).collect();
        for (t, plan) in &plans {
            let more: usize = plan.faces.values().map(|(c, ..)| c.cuts.len()).sum();
            if self.surface(*t).edges.len() + plan.edges.len() + more >= 1 << 31 {
                return Err(SplitFaceError::TooLarge(*t));
            }
        }
        let mut result = FaceSplit { children: [face; 4], nodes: [NONE; 3], edges: Vec::new() };
        for (t, plan) in &plans {
            let s = &self.surfaces[t.index()];
            let (node, second) = (s.positions.len() as u32, s.edges.len() as u32);
            for (k, &e) in plan.edges.iter().enumerate() {
                let k = k as u32;
                let edge = EdgeId(e);
                result.edges.push(SplitEdge {
                    surface: *t,
                    edge,
                    second: EdgeId(second + k),
                    node: node + k,
                });
                if *t == surface
                    && let Some(i) = sides.iter().position(|&x| x == e)
                {
                    result.nodes[i] = node + k;
                }
            }
            if *t == surface
                && let Some((_, first, _)) = plan.faces.get(&face.0)
            {
                result.children = [face, FaceId(*first), FaceId(first + 1), FaceId(first + 2)];
            }
            plan.apply(&mut self.surfaces[t.index()]);
        }
        Ok(result)
    }
}

impl Plan {
    fn new(s: &Surface, edges: Vec<u32>) -> Self {
        let touched: BTreeSet<u32> =
            edges.iter().flat_map(|&e| s.edge_faces[e as usize]).filter(|&f| f != NONE).collect();
        let (mut next_face, mut next_edge) = (s.faces.len() as u32, (s.edges.len() + edges.len()) as u32);
        let mut faces = BTreeMap::new();
        for f in touched {
            let split = s.face_edges[f as usize].map(|e| edges.binary_search(&e).is_ok());
            let corners = s.corners(FaceId(f));
            let place = |p: Local| {
                let areal = AREAL[p as usize];
                (0..3).map(|i| corners[i] * areal[i]).sum::<glam::DVec3>()
            };
            let cutting = Cutting::new(split, |p, q| place(p).distance_squared(place(q)));
            let (new_faces, new_edges) = (cutting.children.len() as u32 - 1, cutting.cuts.len() as u32);
            faces.insert(f, (cutting, next_face, next_edge));
            next_face += new_faces;
            next_edge += new_edges;
        }
        Self { edges, faces }
    }

    fn place(&self, e: u32) -> Option<u32> {
        self.edges.binary_search(&e).ok().map(|k| k as u32)
    }

    fn apply(&self, s: &mut Surface) {
        let (first_node, first_half) = (s.positions.len() as u32, s.edges.len() as u32);
        if !s.attribute_nodes.is_empty() {
            s.carry_attributes(
                |e| self.place(e).map(|k| ([EdgeId(e), EdgeId(first_half + k)], 0.5)),
                |f| self.faces.get(&f).map(|(cutting, faces, cuts)| cutting.piece(f, *faces, *cuts)),
            );
        }
        for &e in &self.edges {
            let [a, b] = s.edges[e as usize].map(|v| v as usize);
            s.positions.push((s.positions[a] + s.positions[b]) * 0.5);
            if !s.backup.is_empty() {
                s.backup.push((s.backup[a] + s.backup[b]) * 0.5);
            }
            if !s.planar.is_empty() {
                s.planar.push((s.planar[a] + s.planar[b]) * 0.5);
            }
        }
        // Points of every face to be cut, and its sides as halves or whole, before edges change.
        let frames: Vec<Frame> =
            self.faces.keys().map(|&f| self.frame(s, f, first_node, first_half)).collect();
        for (k, &e) in self.edges.iter().enumerate() {
            let m = first_node + k as u32;
            let [a, b] = s.edges[e as usize];
            s.edges[e as usize] = [a, m];
            s.edges.push([m, b]);
            s.edge_faces.push([NONE; 2]);
            s.edge_chain.push(s.edge_chain[e as usize]);
        }
        for ((&f, (cutting, faces, cuts)), frame) in self.faces.iter().zip(&frames) {
            cutting.apply(s, frame, f, *faces, *cuts);
        }
        self.lengthen_chains(s, first_half);
    }

    fn frame(&self, s: &Surface, f: u32, first_node: u32, first_half: u32) -> Frame {
        let corners = s.faces[f as usize];
        let mut frame =
            Frame { nodes: [corners[0], corners[1], corners[2], NONE, NONE, NONE], sides: [[NONE; 2]; 3] };
        for (i, &e) in s.face_edges[f as usize].iter().enumerate() {
            frame.sides[i] = match self.place(e) {
                Some(k) => {
                    frame.nodes[3 + i] = first_node + k;
                    let forward = s.edges[e as usize][0] == corners[i];
                    if forward { [e, first_half + k] } else { [first_half + k, e] }
                }
                None => [e, e],
            };
        }
        frame
    }

    fn lengthen_chains(&self, s: &mut Surface, first_half: u32) {
        let chains: BTreeSet<ChainId> = self.edges.iter().filter_map(|&e| s.edge_chain(EdgeId(e))).collect();
        for c in chains {
            let old = std::mem::take(&mut s.chains[c.index()].edges);
            let mut edges = Vec::with_capacity(old.len() + self.edges.len());
            for d in old {
                match self.place(d.edge().0) {
                    None => edges.push(d),
                    Some(k) => {
                        let second = DirectedEdge::new(EdgeId(first_half + k), d.is_reversed());
                        edges.extend(if d.is_reversed() { [second, d] } else { [d, second] });
                    }
                }
            }
            s.chains[c.index()].edges = edges;
        }
    }
}

/// Nodes of a face's local points; halves of its sides in its direction (the whole side twice where it is not split).
struct Frame {
    nodes: [u32; 6],
    sides: [[u32; 2]; 3],
}

impl Cutting {
    fn piece(&self, f: u32, faces: u32, cuts: u32) -> Piece {
        let face = |k: usize| if k == 0 { f } else { faces + k as u32 - 1 };
        Piece {
            faces: self
                .children
                .iter()
                .enumerate()
                .map(|(k, child)| (face(k), child.map(|p| AREAL[p as usize])))
                .collect(),
            cuts: self
                .cuts
                .iter()
                .enumerate()
                .map(|(k, cut)| (cuts + k as u32, cut.map(|p| AREAL[p as usize])))
                .collect(),
        }
    }

    fn apply(&self, s: &mut Surface, frame: &Frame, f: u32, faces: u32, cuts: u32) {
        debug_assert_eq!(cuts as usize, s.edges.len(), "cuts are numbered in order of faces");
        for cut in &self.cuts {
            s.edges.push(cut.map(|p| frame.nodes[p as usize]));
            s.edge_faces.push([NONE; 2]);
            s.edge_chain.push(NO_CHAIN);
        }
        for (k, child) in self.children.iter().enumerate() {
            let face = if k == 0 { f } else { faces + k as u32 - 1 };
            let mut sides = [NONE; 3];
            for i in 0..3 {
                let (p, q) = (child[i], child[(i + 1) % 3]);
                let edge = self.edge(frame, p, q, cuts);
                let slot = usize::from(s.edges[edge as usize][0] != frame.nodes[p as usize]);
                s.edge_faces[edge as usize][slot] = face;
                sides[i] = edge;
            }
            let nodes = child.map(|p| frame.nodes[p as usize]);
            if k == 0 {
                s.faces[f as usize] = nodes;
                s.face_edges[f as usize] = sides;
            } else {
                s.faces.push(nodes);
                s.face_edges.push(sides);
            }
        }
    }

    /// The edge from local point `p` to `q`: a cut, a half of a side, or a whole side.
    fn edge(&self, frame: &Frame, p: Local, q: Local, cuts: u32) -> u32 {
        if let Some(k) = self.cuts.iter().position(|&c| c == [p, q] || c == [q, p]) {
            return cuts + k as u32;
        }
        // From a corner runs the whole of its side, or the first half; from a middle the second.
        if p < 3 { frame.sides[p as usize][0] } else { frame.sides[p as usize - 3][1] }
    }
}
