//! Attributes: parameters in range, lines that stay on the surface.

use std::cell::OnceCell;

use super::Defect;
use crate::body::{AttributeEdgeId, AttributeNodeId, Body};

pub(super) fn check(body: &Body, defects: &mut Vec<Defect>) {
    for (id, s) in body.surfaces() {
        for (n, node) in s.attribute_nodes.iter().enumerate() {
            if !node.in_range() {
                let parameters = node.parameters();
                let node = AttributeNodeId(n as u32);
                defects.push(Defect::AttributeRange { surface: id, node, parameters });
            }
        }
        let index = OnceCell::new();
        for (l, line) in s.attribute_edges.iter().enumerate() {
            for (at, pair) in line.nodes.windows(2).enumerate() {
                let [a, b] = [pair[0], pair[1]].map(|n| &s.attribute_nodes[n.index()]);
                if s.carrier(a, b, &index).is_none() {
                    defects.push(Defect::AttributeApart { surface: id, line: AttributeEdgeId(l as u32), at });
                }
            }
        }
    }
}
