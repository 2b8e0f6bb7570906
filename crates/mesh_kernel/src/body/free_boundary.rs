//! Where the body as a whole ends: edges with one face only, strung together.

use std::collections::BTreeMap;

use super::Body;
use super::ids::{DirectedEdge, NONE, SurfaceId};

/// An edge with exactly one face in the whole body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FreeEdge {
    /// Its surface.
    pub surface: SurfaceId,
    /// The edge, with its face on the left.
    pub edge: DirectedEdge,
}

/// A line of free edges, from branching to branching or closed. Surfaces that are wound against each other make its edges
/// run both ways.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BoundaryLine {
    /// The edges in order.
    pub edges: Vec<FreeEdge>,
    /// Welded nodes in order ([`Body::weld`]), one more than edges; the first again at the end of a closed line.
    pub nodes: Vec<u32>,
}

impl BoundaryLine {
    /// Whether the line is a loop.
    pub fn is_closed(&self) -> bool {
        self.nodes.first() == self.nodes.last()
    }
}

impl Body {
    /// Edges with exactly one face in the whole body, in order of surfaces, loops and chains. O(boundary edges).
    pub fn free_edges(&self) -> Vec<FreeEdge> {
        let mut free = Vec::new();
        for (id, s) in self.surfaces() {
            for &c in s.loops.iter().flat_map(|l| l.chains()) {
                let chain = s.chain(c);
                // Partners without any face leave a joint's edges free.
                let alone = chain.joint.is_none_or(|j| {
                    self.joint(j).uses.iter().filter(|u| (u.surface, u.chain) != (id, c)).all(|u| {
                        let t = self.surface(u.surface);
                        let bare = |d: &DirectedEdge| t.edge_faces[d.edge().index()] == [NONE; 2];
                        t.chain(u.chain).edges.first().is_none_or(bare)
                    })
                });
                if alone {
                    free.extend(chain.edges.iter().map(|&edge| FreeEdge { surface: id, edge }));
                }
            }
        }
        free
    }

    /// The boundary of the body as a whole: free edges strung together through joints. Where another number than two of
    /// them meet at a node, as at the end of a joint of three sheets, lines end. Closed lines start at their first edge by
    /// surface and number. O(boundary edges · log).
    pub fn boundary_loops(&self) -> Vec<BoundaryLine> {
        let weld = self.weld();
        let free = self.free_edges();
        let ends: Vec<[u32; 2]> = free
            .iter()
            .map(|f| self.surface(f.surface).ends(f.edge).map(|v| weld.node(f.surface, v.0)))
            .collect();
        let mut at_node: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (i, ends) in ends.iter().enumerate() {
            ends.iter().for_each(|&v| at_node.entry(v).or_default().push(i));
        }
        let mut done = vec![false; free.len()];
        let mut lines = Vec::new();
        // From branchings first; what is left then is closed.
        let branches = |i: usize| ends[i].into_iter().find(|v| at_node[v].len() != 2);
        for closed in [false, true] {
            for i in 0..free.len() {
                let start = if closed { Some(ends[i][0]) } else { branches(i) };
                let Some(start) = start.filter(|_| !done[i]) else { continue };
                let mut line = BoundaryLine { edges: Vec::new(), nodes: vec![start] };
                let (mut edge, mut node) = (i, start);
                loop {
                    done[edge] = true;
                    node = if ends[edge][0] == node { ends[edge][1] } else { ends[edge][0] };
                    line.edges.push(free[edge]);
                    line.nodes.push(node);
                    match at_node[&node][..] {
                        [a, _] if !done[a] => edge = a,
                        [_, b] if !done[b] => edge = b,
                        _ => break,
                    }
                }
                lines.push(line);
            }
        }
        lines
    }
}
