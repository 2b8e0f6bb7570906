//! Attributes where edges are swapped and collapsed.
//!
//! A swap keeps every point where it was, as far as the two new faces allow: it goes to their nearest place. A line that
//! passes from one to the other gets a node on the new edge.
//!
//! A collapse moves points with what carries them: those on the edge to the kept node, those on the side at the removed node
//! to the same place of the side that stands for both, those in a face that goes onto that side, at the same share of the
//! face's third node. All others keep their parameters.

use std::cell::OnceCell;

use glam::DVec3;

use crate::body::attribute::{AttributeNode, Carrier};
use crate::body::{AttributeNodeId, EdgeId, FaceId, Surface};

/// What a swap has to carry, as it is before.
pub(super) struct SwapCarry {
    edge: EdgeId,
    faces: [u32; 2],
    ends: [u32; 2],
    /// Nodes on the edge or in the faces, with their places.
    nodes: Vec<(usize, DVec3)>,
    /// Pieces of lines in the faces: line, index of its first node, places of both.
    pieces: Vec<(usize, usize, [DVec3; 2])>,
}

impl SwapCarry {
    /// `None` where nothing lies on the edge or in its faces. O(attributes).
    pub(super) fn of(s: &Surface, edge: EdgeId) -> Option<Self> {
        let faces = s.edge_faces[edge.index()];
        if s.attribute_nodes.is_empty() || !s.carries_attributes(&[edge.0], &faces) {
            return None;
        }
        let place = |n: usize| s.attribute_position(AttributeNodeId(n as u32));
        let affected = |n: &AttributeNode| match n {
            AttributeNode::OnEdge { edge: e, .. } => *e == edge,
            AttributeNode::InFace { face, .. } => faces.contains(&face.0),
        };
        let nodes = s.attribute_nodes.iter().enumerate().filter(|(_, n)| affected(n));
        let nodes = nodes.map(|(i, _)| (i, place(i))).collect();
        let index = OnceCell::new();
        let mut pieces = Vec::new();
        for (l, line) in s.attribute_edges.iter().enumerate() {
            for (i, pair) in line.nodes.windows(2).enumerate() {
                let [a, b] = [pair[0], pair[1]].map(|n| &s.attribute_nodes[n.index()]);
                if let Some(Carrier::Face(f)) = s.carrier(a, b, &index)
                    && faces.contains(&f)
                {
                    pieces.push((l, i, [place(pair[0].index()), place(pair[1].index())]));
                }
            }
        }
        Some(Self { edge, faces, ends: s.edges[edge.index()], nodes, pieces })
    }

    /// Puts everything into the new faces.
    pub(super) fn put(self, s: &mut Surface) {
        for &(n, p) in &self.nodes {
            let old = s.attribute_nodes[n];
            // What lay at an end of the edge stays there, on the side of a face that begins or ends there.
            let at = match old {
                AttributeNode::OnEdge { u: 0.0, .. } => Some(self.ends[0]),
                AttributeNode::OnEdge { u: 1.0, .. } => Some(self.ends[1]),
                _ => None,
            };
            s.attribute_nodes[n] = match at.and_then(|v| self.side_at(s, v)) {
                Some(host) => host,
                None => self.nearest(s, p),
            };
        }
        let index = OnceCell::new();
        // From behind, so that indices stay right.
        for &(l, i, [p, q]) in self.pieces.iter().rev() {
            let pair = [s.attribute_edges[l].nodes[i], s.attribute_edges[l].nodes[i + 1]];
            let [a, b] = pair.map(|n| &s.attribute_nodes[n.index()]);
            if s.carrier(a, b, &index).is_some() {
                continue;
            }
            let [c, d] = s.edges[self.edge.index()].map(|v| s.positions[v as usize]);
            let node = AttributeNode::OnEdge { edge: self.edge, u: crossing(c, d, p, q) };
            let id = AttributeNodeId(s.attribute_nodes.len() as u32);
            s.attribute_nodes.push(node);
            s.attribute_edges[l].nodes.insert(i + 1, id);
        }
    }

    /// Node `v` as the end of a side of the faces.
    fn side_at(&self, s: &Surface, v: u32) -> Option<AttributeNode> {
        let sides = self.faces.into_iter().flat_map(|f| s.face_edges[f as usize]);
        let e = sides.into_iter().find(|&e| e != self.edge.0 && s.edges[e as usize].contains(&v))?;
        Some(end_of(s, e, v))
    }

    fn nearest(&self, s: &Surface, p: DVec3) -> AttributeNode {
        let mut best = (f64::INFINITY, self.faces[0], [1.0, 0.0, 0.0]);
        for f in self.faces {
            let [a, b, c] = s.corners(FaceId(f));
            let areal = nearest_in(p, a, b, c);
            let distance = p.distance_squared(a * areal[0] + b * areal[1] + c * areal[2]);
            if distance < best.0 {
                best = (distance, f, areal);
            }
        }
        let (_, face, areal) = best;
        // On a side it is the side that carries it, so that cuts through the side's ends find it there.
        let Some(i) = (0..3).find(|&i| areal[i] <= ON_SIDE) else {
            return AttributeNode::InFace { face: FaceId(face), areal };
        };
        let (from, to) = ((i + 1) % 3, (i + 2) % 3);
        let along = areal[to] / (areal[from] + areal[to]);
        let along = if along <= ON_SIDE { 0.0 } else { along };
        let along = if along >= 1.0 - ON_SIDE { 1.0 } else { along };
        let side = s.face_edges[face as usize][from];
        let forward = s.edges[side as usize][0] == s.faces[face as usize][from];
        AttributeNode::OnEdge { edge: EdgeId(side), u: if forward { along } else { 1.0 - along } }
    }
}

/// A point of a face with a smaller share of a corner lies on the side opposite.
const ON_SIDE: f64 = 1e-9;

/// Node `v` as an end of edge `e`.
fn end_of(s: &Surface, e: u32, v: u32) -> AttributeNode {
    AttributeNode::OnEdge { edge: EdgeId(e), u: if s.edges[e as usize][0] == v { 0.0 } else { 1.0 } }
}

/// Share along `c` → `d` of the place nearest to the line from `p` to `q`; where both are parallel, to its middle.
fn crossing(c: DVec3, d: DVec3, p: DVec3, q: DVec3) -> f64 {
    let (u, v, w) = (d - c, q - p, c - p);
    let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
    let det = uu * vv - uv * uv;
    let t = if det > 1e-12 * uu * vv {
        (uv * v.dot(w) - vv * u.dot(w)) / det
    } else {
        u.dot((p + q) * 0.5 - c) / uu
    };
    if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.5 }
}

/// Areal coordinates of the place in a triangle nearest to `p`.
fn nearest_in(p: DVec3, a: DVec3, b: DVec3, c: DVec3) -> [f64; 3] {
    let n = (b - a).cross(c - a);
    let whole = n.dot(n);
    let inside = [(c - b).cross(p - b), (a - c).cross(p - c), (b - a).cross(p - a)].map(|m| m.dot(n) / whole);
    if inside.iter().all(|w| *w >= 0.0) {
        let sum: f64 = inside.iter().sum();
        return inside.map(|w| w / sum);
    }
    // On the nearest side; a degenerate triangle has nothing else.
    let corners = [a, b, c];
    let mut best = (f64::INFINITY, [1.0, 0.0, 0.0]);
    for i in 0..3 {
        let (x, y) = (corners[i], corners[(i + 1) % 3]);
        let along = y - x;
        let t = ((p - x).dot(along) / along.dot(along)).clamp(0.0, 1.0);
        let t = if t.is_finite() { t } else { 0.0 };
        let distance = p.distance_squared(x + along * t);
        if distance < best.0 {
            let mut areal = [0.0; 3];
            (areal[i], areal[(i + 1) % 3]) = (1.0 - t, t);
            best = (distance, areal);
        }
    }
    best.1
}

/// An end of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct EndOf {
    pub(super) edge: u32,
    pub(super) node: u32,
}

/// A face that a collapse removes, for its attributes.
#[derive(Clone, Copy)]
pub(super) struct GoneFace {
    pub(super) face: u32,
    /// Which corner is the face's third node.
    pub(super) tip_corner: usize,
    pub(super) tip: u32,
    pub(super) side: u32,
    pub(super) into: u32,
}

/// Attributes of a surface of which `edge` is collapsed, before that: what lies on the edge goes to `host`.
pub(super) fn carry_collapse(s: &mut Surface, edge: u32, host: EndOf, gone: &[GoneFace]) {
    // Share of the third node on the side at the kept node.
    let onto = |s: &Surface, g: &GoneFace, share: f64| {
        let u = if s.edges[g.into as usize][0] == g.tip { 1.0 - share } else { share };
        AttributeNode::OnEdge { edge: EdgeId(g.into), u }
    };
    for n in 0..s.attribute_nodes.len() {
        let node = match s.attribute_nodes[n] {
            AttributeNode::OnEdge { edge: e, .. } if e.0 == edge => end_of(s, host.edge, host.node),
            AttributeNode::OnEdge { edge: e, u } => {
                let Some(g) = gone.iter().find(|g| g.side == e.0) else { continue };
                let share = if s.edges[e.index()][0] == g.tip { 1.0 - u } else { u };
                onto(s, g, share)
            }
            AttributeNode::InFace { face, areal } => {
                let Some(g) = gone.iter().find(|g| g.face == face.0) else { continue };
                onto(s, g, areal[g.tip_corner].clamp(0.0, 1.0))
            }
        };
        s.attribute_nodes[n] = node;
    }
}

/// Whether every line still lies on the surface. O(attributes · edges at most).
pub(super) fn lines_hold(s: &Surface) -> bool {
    let index = OnceCell::new();
    s.attribute_edges.iter().flat_map(|l| l.nodes.windows(2)).all(|pair| {
        let [a, b] = [pair[0], pair[1]].map(|n| &s.attribute_nodes[n.index()]);
        s.carrier(a, b, &index).is_some()
    })
}
