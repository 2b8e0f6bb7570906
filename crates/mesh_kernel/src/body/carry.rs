//! Attributes carried through splits of their edges and faces.

use std::cell::OnceCell;

use super::attribute::{AttributeNode, Carrier};
use super::ids::{AttributeNodeId, EdgeId, FaceId};
use super::surface::Surface;

/// What a face was cut into.
pub(crate) struct Piece {
    /// New faces with the areal coordinates, in the old face, of their corners.
    pub(crate) faces: Vec<(u32, [[f64; 3]; 3])>,
    /// New edges inside the old face with those of their ends.
    pub(crate) cuts: Vec<(u32, [[f64; 3]; 2])>,
}

/// Where a line meets a cut this near to another crossing, in shares of the line, both are one.
const SAME_CROSSING: f64 = 1e-12;

/// A parameter of an edge; so near an end that only rounding is in between, that end. A line that passes a node must not
/// pass beside it.
fn snapped(u: f64) -> f64 {
    if u <= SAME_CROSSING {
        0.0
    } else if u >= 1.0 - SAME_CROSSING {
        1.0
    } else {
        u
    }
}

fn determinant(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

impl Piece {
    /// The new host of a point of the old face: a cut where it lies exactly on one, else a face.
    fn locate(&self, p: [f64; 3]) -> AttributeNode {
        for &(edge, [a, b]) in &self.cuts {
            if determinant(a, b, p).abs() <= SAME_CROSSING {
                let u = along(a, b, p);
                if (-SAME_CROSSING..=1.0 + SAME_CROSSING).contains(&u) {
                    return AttributeNode::OnEdge { edge: EdgeId(edge), u: snapped(u) };
                }
            }
        }
        let mut best = (f64::NEG_INFINITY, 0, [0.0; 3]);
        for &(face, [a, b, c]) in &self.faces {
            let whole = determinant(a, b, c);
            let areal = [determinant(p, b, c), determinant(a, p, c), determinant(a, b, p)].map(|d| d / whole);
            let least = areal.iter().copied().fold(f64::INFINITY, f64::min);
            if least > best.0 {
                best = (least, face, areal);
            }
        }
        // Rounding may leave a share of -1e-17.
        let mut areal = best.2.map(|w| w.max(0.0));
        let sum: f64 = areal.iter().sum();
        areal = areal.map(|w| w / sum);
        AttributeNode::InFace { face: FaceId(best.1), areal }
    }

    /// Where the line from `p` to `q` crosses the cuts, in order.
    fn crossings(&self, p: [f64; 3], q: [f64; 3]) -> Vec<AttributeNode> {
        let mut found: Vec<(f64, AttributeNode)> = Vec::new();
        for &(edge, [a, b]) in &self.cuts {
            let (from, to) = (determinant(a, b, p), determinant(a, b, q));
            if from * to >= 0.0 || from.abs() <= SAME_CROSSING || to.abs() <= SAME_CROSSING {
                continue;
            }
            let t = from / (from - to);
            let x = [0, 1, 2].map(|i| p[i] + (q[i] - p[i]) * t);
            let u = along(a, b, x);
            if (-SAME_CROSSING..=1.0 + SAME_CROSSING).contains(&u) {
                found.push((t, AttributeNode::OnEdge { edge: EdgeId(edge), u: snapped(u) }));
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.dedup_by(|b, a| b.0 - a.0 <= SAME_CROSSING);
        found.into_iter().map(|(_, node)| node).collect()
    }
}

/// Parameter of `p` along `a` → `b`, all three on one line.
fn along(a: [f64; 3], b: [f64; 3], p: [f64; 3]) -> f64 {
    let mut i = 0;
    for k in 1..3 {
        if (b[k] - a[k]).abs() > (b[i] - a[i]).abs() {
            i = k;
        }
    }
    (p[i] - a[i]) / (b[i] - a[i])
}

impl Surface {
    /// Parameter on an edge of an attribute node that lies on it, its ends included.
    fn parameter_on(&self, node: &AttributeNode, e: u32) -> Option<f64> {
        match *node {
            AttributeNode::OnEdge { edge, u } if edge.0 == e => Some(u),
            _ => {
                let v = self.at_node(node)?;
                Some(if v == self.edges[e as usize][0] { 0.0 } else { 1.0 })
            }
        }
    }

    /// Moves attributes to the parts of their hosts, before the surface itself is changed.
    ///
    /// `halves` gives the two edges, in its direction, that an edge is cut into, and the parameter where; `pieces` gives
    /// what a face is cut into; `None` where it stays. Attribute edges get a node wherever they cross a cut.
    pub(crate) fn carry_attributes(
        &mut self,
        halves: impl Fn(u32) -> Option<([EdgeId; 2], f64)>,
        pieces: impl Fn(u32) -> Option<Piece>,
    ) {
        let parts = |e| halves(e).map(|([first, second], at)| vec![(first, at), (second, 1.0)]);
        self.carry_attributes_to_parts(parts, pieces);
    }

    /// The same where edges are cut into any number of parts: each with the parameter of its far end on the old edge.
    pub(crate) fn carry_attributes_to_parts(
        &mut self,
        parts: impl Fn(u32) -> Option<Vec<(EdgeId, f64)>>,
        pieces: impl Fn(u32) -> Option<Piece>,
    ) {
        let index = OnceCell::new();
        let old = self.attribute_nodes.clone();
        let mut added = Vec::new();
        let mut lines = self.attribute_edges.clone();
        for line in &mut lines {
            let mut nodes = Vec::with_capacity(line.nodes.len());
            for (i, &n) in line.nodes.iter().enumerate() {
                nodes.push(n);
                let Some(&next) = line.nodes.get(i + 1) else { break };
                let [a, b] = [n, next].map(|n| &old[n.index()]);
                let mut add = |node: AttributeNode| {
                    nodes.push(AttributeNodeId((old.len() + added.len()) as u32));
                    added.push(node);
                };
                let f = match self.carrier(a, b, &index) {
                    Some(Carrier::Face(f)) => f,
                    Some(Carrier::Edge(e)) => {
                        let (Some(u), Some(w)) = (self.parameter_on(a, e), self.parameter_on(b, e)) else {
                            continue;
                        };
                        let mut passed: Vec<(EdgeId, f64)> = parts(e).unwrap_or_default();
                        passed.retain(|&(_, at)| (u - at) * (w - at) < 0.0);
                        if u > w {
                            passed.reverse();
                        }
                        passed.iter().for_each(|&(edge, _)| add(AttributeNode::OnEdge { edge, u: 1.0 }));
                        continue;
                    }
                    None => continue,
                };
                let Some(piece) = pieces(f) else { continue };
                let (Some(p), Some(q)) = (self.areal_in(a, f), self.areal_in(b, f)) else { continue };
                piece.crossings(p, q).into_iter().for_each(&mut add);
            }
            line.nodes = nodes;
        }
        for node in &mut self.attribute_nodes {
            match *node {
                AttributeNode::OnEdge { edge, u } => {
                    let Some(parts) = parts(edge.0) else { continue };
                    let k = parts.iter().position(|&(_, end)| u <= end).unwrap_or(parts.len() - 1);
                    let start = if k == 0 { 0.0 } else { parts[k - 1].1 };
                    let (edge, end) = parts[k];
                    *node = AttributeNode::OnEdge { edge, u: snapped((u - start) / (end - start)) };
                }
                AttributeNode::InFace { face, areal } => {
                    if let Some(piece) = pieces(face.0) {
                        *node = piece.locate(areal);
                    }
                }
            }
        }
        self.attribute_nodes.append(&mut added);
        self.attribute_edges = lines;
    }
}
