//! Lines on a surface joined again where rounding has torn them.
//!
//! Operators carry attribute nodes into the parts of their hosts by parameters. Where a line passes a hair beside a node or
//! a cut, rounding may put two nodes that follow each other on either side of an edge that the line is not seen to cross.
//! Which edge that is the topology tells; the line gets a node there.

use std::cell::OnceCell;
use std::collections::{BTreeMap, VecDeque};

use glam::DVec3;

use super::attribute::AttributeNode;
use super::ids::{AttributeNodeId, EdgeId, NONE, NodeId};
use super::surface::Surface;

impl Surface {
    /// Puts nodes into every line whose nodes follow each other without a common face or edge: one on every edge of the
    /// shortest way from face to face. O(attributes); O(faces) where a line is torn.
    pub(crate) fn mend_lines(&mut self) {
        if self.attribute_edges.is_empty() {
            return;
        }
        let index = OnceCell::new();
        let mut more: Vec<(usize, usize, Vec<AttributeNode>)> = Vec::new();
        for (l, line) in self.attribute_edges.iter().enumerate() {
            for (at, pair) in line.nodes.windows(2).enumerate() {
                let [a, b] = [pair[0], pair[1]].map(|n| &self.attribute_nodes[n.index()]);
                if self.carrier(a, b, &index).is_none() {
                    let ends = [pair[0], pair[1]].map(|n| self.attribute_position(n));
                    more.push((l, at, self.way(a, b, ends)));
                }
            }
        }
        // From the back, so that places before stay.
        for (l, at, nodes) in more.into_iter().rev() {
            let first = self.attribute_nodes.len() as u32;
            let ids = (first..first + nodes.len() as u32).map(AttributeNodeId);
            self.attribute_edges[l].nodes.splice(at + 1..at + 1, ids);
            self.attribute_nodes.extend(nodes);
        }
    }

    /// Faces that a node lies in or on.
    fn hosts_and_star(&self, node: &AttributeNode) -> Vec<u32> {
        match (node, self.at_node(node)) {
            (AttributeNode::InFace { face, .. }, _) => vec![face.0],
            (_, Some(v)) => {
                let star = self.node_edges();
                star.of(NodeId(v))
                    .iter()
                    .flat_map(|&e| self.edge_faces[e as usize])
                    .filter(|&f| f != NONE)
                    .collect()
            }
            (AttributeNode::OnEdge { edge, .. }, None) => {
                self.edge_faces[edge.index()].into_iter().filter(|&f| f != NONE).collect()
            }
        }
    }

    /// Nodes on the edges between the faces of `a` and those of `b`, near the straight line; empty where there is no way.
    fn way(&self, a: &AttributeNode, b: &AttributeNode, ends: [DVec3; 2]) -> Vec<AttributeNode> {
        let goal = self.hosts_and_star(b);
        // The face and the edge by which a face was first reached.
        let mut reached: BTreeMap<u32, Option<(u32, u32)>> = BTreeMap::new();
        let mut queue: VecDeque<u32> = VecDeque::new();
        for f in self.hosts_and_star(a) {
            if reached.insert(f, None).is_none() {
                queue.push_back(f);
            }
        }
        while let Some(f) = queue.pop_front() {
            if goal.contains(&f) {
                let mut edges = Vec::new();
                let mut at = f;
                while let Some(&Some((from, e))) = reached.get(&at) {
                    edges.push(e);
                    at = from;
                }
                return edges.into_iter().rev().map(|e| self.nearest_on(e, ends)).collect();
            }
            for e in self.face_edges[f as usize] {
                for g in self.edge_faces[e as usize] {
                    if g != NONE && !reached.contains_key(&g) {
                        reached.insert(g, Some((f, e)));
                        queue.push_back(g);
                    }
                }
            }
        }
        Vec::new()
    }

    /// The place on an edge nearest to the straight line between two points.
    fn nearest_on(&self, e: u32, [p, q]: [DVec3; 2]) -> AttributeNode {
        let [a, b] = self.edges[e as usize].map(|v| self.positions[v as usize]);
        let (along, line) = (b - a, q - p);
        let (aa, al, ll) = (along.dot(along), along.dot(line), line.dot(line));
        let (da, dl) = (along.dot(p - a), line.dot(p - a));
        let parallel = aa * ll - al * al;
        // Parallel lines are equally near everywhere: the foot of the first point will do.
        let u = if parallel > 0.0 { (da * ll - al * dl) / parallel } else { da / aa };
        AttributeNode::OnEdge { edge: EdgeId(e), u: if u.is_finite() { u.clamp(0.0, 1.0) } else { 0.5 } }
    }
}
