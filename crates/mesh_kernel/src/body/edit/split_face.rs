//! Face split: one face into four, through joints.
//!
//! ```text
//!          c                 c
//!         / \               / \
//!        /   \             5---4
//!       /     \     →     / \ / \
//!      a-------b         a---3---b
//! ```
//!
//! In K3 terms (Wang et al., table 3), n being the faces on other sides of its edges: kill_face n + 1 times, split_wire
//! three times, make_edge 3 + n times, make_face 4 + 2n times.

use std::collections::{BTreeMap, BTreeSet};

use super::Editor;
use super::delta::{Delta, NodeValue, Recorder};
use super::loops::rebuild;
use super::operation::Operation;
use crate::body::carry::Piece;
use crate::body::surface::chain_slot;
use crate::body::{Body, ChainId, DirectedEdge, EdgeId, FaceId, NONE, Surface, SurfaceId};

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
    /// Edges that get nodes, in order, with the node and the second half.
    edges: Vec<(u32, u32, u32)>,
    /// Faces that are cut, in order.
    faces: BTreeMap<u32, Cut>,
}

/// A face that is cut, with the numbers of its parts.
struct Cut {
    cutting: Cutting,
    /// The parts; the first has the face's number.
    faces: Vec<u32>,
    /// The edges between them.
    cuts: Vec<u32>,
}

impl Editor {
    /// Splits a face into four by nodes in the middle of its sides.
    ///
    /// Edges that correspond to its sides on joints get nodes too, bit-equal in position, and all faces on edges that got
    /// nodes, here and on other surfaces, are cut along: into two, three or four. Edges and faces keep their numbers (an
    /// edge as its first half, a face as its first part); new entities get the numbers freed last, then new ones. Chains,
    /// loops, attributes, backup and planar positions follow.
    ///
    /// # Errors
    /// Unknown ids; ids run out. Nothing is changed then. O(edges of the surfaces' chains).
    pub fn split_face(&mut self, surface: SurfaceId, face: FaceId) -> Result<FaceSplit, SplitFaceError> {
        let plans = self.body.plan_split(surface, face)?;
        let sides = self.body.surface(surface).face_edges[face.index()];
        let mut result = FaceSplit { children: [face; 4], nodes: [NONE; 3], edges: Vec::new() };
        let mut deltas: Vec<Delta> = Vec::with_capacity(plans.len());
        for (t, plan) in &plans {
            for &(e, node, second) in &plan.edges {
                let split = SplitEdge { surface: *t, edge: EdgeId(e), second: EdgeId(second), node };
                result.edges.push(split);
                if *t == surface
                    && let Some(i) = sides.iter().position(|&x| x == e)
                {
                    result.nodes[i] = node;
                }
            }
            if *t == surface
                && let Some(&[a, b, c, d]) = plan.faces.get(&face.0).map(|c| &c.faces[..])
            {
                result.children = [a, b, c, d].map(FaceId);
            }
            deltas.push(self.change(*t, |r| plan.apply(r)).1);
        }
        self.log_deltas(Operation::SplitFace { surface, face }, deltas);
        Ok(result)
    }
}

impl Body {
    fn plan_split(&self, surface: SurfaceId, face: FaceId) -> Result<Vec<(SurfaceId, Plan)>, SplitFaceError> {
        let s = self.surfaces.get(surface.index()).ok_or(SplitFaceError::NoSurface(surface))?;
        if !s.is_face(face) {
            return Err(SplitFaceError::NoFace { surface, face });
        }
        let mut wanted: BTreeMap<SurfaceId, BTreeSet<u32>> = BTreeMap::new();
        for e in s.face_edges[face.index()] {
            wanted.entry(surface).or_default().insert(e);
            for (t, d) in self.partners(surface, EdgeId(e)) {
                wanted.entry(t).or_default().insert(d.edge().0);
            }
        }
        let plans: Vec<(SurfaceId, Plan)> = wanted
            .into_iter()
            .map(|(t, edges)| (t, Plan::new(self.surface(t), &edges.into_iter().collect::<Vec<_>>())))
            .collect();
        for (t, plan) in &plans {
            let more: usize = plan.faces.values().map(|c| c.cuts.len()).sum();
            if self.surface(*t).edges.len() + plan.edges.len() + more >= 1 << 31 {
                return Err(SplitFaceError::TooLarge(*t));
            }
        }
        Ok(plans)
    }
}

impl Plan {
    fn new(s: &Surface, edges: &[u32]) -> Self {
        let touched: BTreeSet<u32> =
            edges.iter().flat_map(|&e| s.edge_faces[e as usize]).filter(|&f| f != NONE).collect();
        let node = |k: usize| s.slots.nodes.upcoming(s.positions.len(), k);
        let edge = |k: usize| s.slots.edges.upcoming(s.edges.len(), k);
        let (mut next_face, mut next_edge) = (0, edges.len());
        let mut faces = BTreeMap::new();
        for f in touched {
            let split = s.face_edges[f as usize].map(|e| edges.binary_search(&e).is_ok());
            let corners = s.corners(FaceId(f));
            let place = |p: Local| {
                let areal = AREAL[p as usize];
                (0..3).map(|i| corners[i] * areal[i]).sum::<glam::DVec3>()
            };
            let cutting = Cutting::new(split, |p, q| place(p).distance_squared(place(q)));
            let mut parts = vec![f];
            for _ in 1..cutting.children.len() {
                parts.push(s.slots.faces.upcoming(s.faces.len(), next_face));
                next_face += 1;
            }
            let cuts = (0..cutting.cuts.len()).map(|k| edge(next_edge + k)).collect::<Vec<_>>();
            next_edge += cuts.len();
            faces.insert(f, Cut { cutting, faces: parts, cuts });
        }
        let edges = edges.iter().enumerate().map(|(k, &e)| (e, node(k), edge(k))).collect();
        Self { edges, faces }
    }

    /// The node and the second half of an edge that is split.
    fn place(&self, e: u32) -> Option<(u32, u32)> {
        self.edges.binary_search_by_key(&e, |x| x.0).ok().map(|k| (self.edges[k].1, self.edges[k].2))
    }

    fn apply(&self, r: &mut Recorder) {
        if !r.surface().attribute_nodes.is_empty() {
            r.change_attributes(|s| {
                s.carry_attributes(
                    |e| self.place(e).map(|(_, second)| ([EdgeId(e), EdgeId(second)], 0.5)),
                    |f| self.faces.get(&f).map(Cut::piece),
                );
            });
        }
        // Points of every face to be cut, and its sides as halves or whole, before edges change.
        let frames: Vec<Frame> = self.faces.keys().map(|&f| self.frame(r.surface(), f)).collect();
        for &(e, ..) in &self.edges {
            let [a, b] = r.surface().edges[e as usize].map(|v| NodeValue::of(r.surface(), v));
            r.add_node(a.between(b, 0.5));
        }
        for &(e, node, _) in &self.edges {
            let [a, b] = r.surface().edges[e as usize];
            r.set_ends(e, [a, node]);
            r.add_edge([node, b]);
        }
        for (cut, frame) in self.faces.values().zip(&frames) {
            cut.cutting.cuts.iter().for_each(|ends| {
                r.add_edge(ends.map(|p| frame.nodes[p as usize]));
            });
        }
        for (cut, frame) in self.faces.values().zip(&frames) {
            cut.apply(r, frame);
        }
        if self.edges.iter().any(|&(e, ..)| r.surface().edge_chain(EdgeId(e)).is_some()) {
            r.change_boundary(|s| {
                self.lengthen_chains(s);
                rebuild(s);
            });
        }
        if !r.surface().attribute_edges.is_empty() {
            r.change_attributes(Surface::mend_lines);
        }
    }

    fn frame(&self, s: &Surface, f: u32) -> Frame {
        let corners = s.faces[f as usize];
        let mut frame =
            Frame { nodes: [corners[0], corners[1], corners[2], NONE, NONE, NONE], sides: [[NONE; 2]; 3] };
        for (i, &e) in s.face_edges[f as usize].iter().enumerate() {
            frame.sides[i] = match self.place(e) {
                Some((node, second)) => {
                    frame.nodes[3 + i] = node;
                    let forward = s.edges[e as usize][0] == corners[i];
                    if forward { [e, second] } else { [second, e] }
                }
                None => [e, e],
            };
        }
        frame
    }

    fn lengthen_chains(&self, s: &mut Surface) {
        let chains: BTreeSet<ChainId> =
            self.edges.iter().filter_map(|&(e, ..)| s.edge_chain(EdgeId(e))).collect();
        for c in chains {
            let old = std::mem::take(&mut s.chains[c.index()].edges);
            let mut edges = Vec::with_capacity(old.len() + self.edges.len());
            for d in old {
                match self.place(d.edge().0) {
                    None => edges.push(d),
                    Some((_, second)) => {
                        s.edge_chain[second as usize] = chain_slot(c);
                        let second = DirectedEdge::new(EdgeId(second), d.is_reversed());
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

impl Cut {
    fn piece(&self) -> Piece {
        let Cutting { children, cuts } = &self.cutting;
        let areal = |p: Local| AREAL[p as usize];
        Piece {
            faces: self.faces.iter().zip(children).map(|(&f, child)| (f, child.map(areal))).collect(),
            cuts: self.cuts.iter().zip(cuts).map(|(&e, cut)| (e, cut.map(areal))).collect(),
        }
    }

    fn apply(&self, r: &mut Recorder, frame: &Frame) {
        for (k, child) in self.cutting.children.iter().enumerate() {
            let sides = [0, 1, 2].map(|i| self.edge(frame, child[i], child[(i + 1) % 3]));
            let nodes = child.map(|p| frame.nodes[p as usize]);
            if k == 0 {
                r.set_face(self.faces[0], nodes, sides);
            } else {
                r.add_face(nodes, sides);
            }
        }
    }

    /// The edge from local point `p` to `q`: a cut, a half of a side, or a whole side.
    fn edge(&self, frame: &Frame, p: Local, q: Local) -> u32 {
        if let Some(k) = self.cutting.cuts.iter().position(|&c| c == [p, q] || c == [q, p]) {
            return self.cuts[k];
        }
        // From a corner runs the whole of its side, or the first half; from a middle the second.
        if p < 3 { frame.sides[p as usize][0] } else { frame.sides[p as usize - 3][1] }
    }
}
