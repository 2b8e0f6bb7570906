//! Lines: runs of edges with the same facets on them, from vertex to vertex.

use glam::DVec3;

use super::regions::{Edges, Regions};
use super::{Line, LineUse};

/// A line turns by less than this at a node inside it, in radians: what rounding of coordinates does, no more.
const STRAIGHT: f64 = 1e-4;

/// A line of a curved facet turns by less than this at a node, in radians; more is a corner.
const SMOOTH: f64 = 0.55;

/// The turned triangles of a sheet.
pub(super) struct Shape<'a> {
    pub(super) positions: &'a [DVec3],
    pub(super) triangles: &'a [[u32; 3]],
    pub(super) edges: &'a Edges,
}

/// Lines and vertices.
pub(super) struct Traced {
    pub(super) lines: Vec<Line>,
    pub(super) vertices: Vec<u32>,
    /// Line of every edge; `u32::MAX` inside facets.
    pub(super) of_edge: Vec<u32>,
    /// Whether the line runs over the edge from the smaller node to the larger.
    pub(super) along_edge: Vec<bool>,
}

/// The facets at an edge, each with whether it walks from the smaller node to the larger.
fn uses(shape: &Shape<'_>, regions: &Regions, edge: u32) -> Vec<LineUse> {
    let [a, _] = shape.edges.nodes[edge as usize];
    let mut uses: Vec<LineUse> = shape
        .edges
        .sides(edge)
        .iter()
        .map(|s| {
            // Turned triangles have their sides elsewhere; the corner before the larger node tells the direction.
            let face = shape.triangles[s.triangle as usize];
            let at = face.iter().position(|v| *v == a).unwrap_or(0);
            let along = face[(at + 1) % 3] == shape.edges.nodes[edge as usize][1];
            LineUse { facet: regions.of[s.triangle as usize], along }
        })
        .collect();
    uses.sort_unstable();
    uses
}

fn flipped(uses: &[LineUse]) -> Vec<LineUse> {
    let mut uses: Vec<LineUse> = uses.iter().map(|u| LineUse { along: !u.along, ..*u }).collect();
    uses.sort_unstable();
    uses
}

/// Traces all lines. O(n log n).
pub(super) fn trace(shape: &Shape<'_>, regions: &Regions) -> Traced {
    let count = shape.edges.nodes.len();
    let on_line: Vec<u32> = (0..count as u32).filter(|&e| !regions.is_inner(shape.edges, e)).collect();
    let mut edge_uses: Vec<Vec<LineUse>> = vec![Vec::new(); count];
    let mut at_node: Vec<Vec<u32>> = vec![Vec::new(); shape.positions.len()];
    for &e in &on_line {
        edge_uses[e as usize] = uses(shape, regions, e);
        for v in shape.edges.nodes[e as usize] {
            at_node[v as usize].push(e);
        }
    }
    let tracer = Tracer { shape, regions, edge_uses: &edge_uses, at_node: &at_node };
    let mut is_vertex: Vec<bool> = (0..shape.positions.len() as u32).map(|v| tracer.is_vertex(v)).collect();
    let mut traced = Traced {
        lines: Vec::new(),
        vertices: Vec::new(),
        of_edge: vec![u32::MAX; count],
        along_edge: vec![true; count],
    };
    for v in 0..shape.positions.len() as u32 {
        if is_vertex[v as usize] {
            for &e in &at_node[v as usize] {
                if traced.of_edge[e as usize] == u32::MAX {
                    tracer.run(v, e, &is_vertex, &mut traced);
                }
            }
        }
    }
    // What is left are closed smooth lines of curved facets: they get two vertices, for lines have two ends.
    for &e in &on_line {
        if traced.of_edge[e as usize] == u32::MAX {
            let [v, _] = shape.edges.nodes[e as usize];
            let ring = tracer.ring(v, e);
            let half = ring[ring.len() / 2];
            is_vertex[v as usize] = true;
            is_vertex[half as usize] = true;
            for start in [v, half] {
                for &e in &at_node[start as usize] {
                    if traced.of_edge[e as usize] == u32::MAX {
                        tracer.run(start, e, &is_vertex, &mut traced);
                    }
                }
            }
        }
    }
    traced.vertices = (0..is_vertex.len() as u32).filter(|&v| is_vertex[v as usize]).collect();
    traced
}

struct Tracer<'a> {
    shape: &'a Shape<'a>,
    regions: &'a Regions,
    edge_uses: &'a [Vec<LineUse>],
    at_node: &'a [Vec<u32>],
}

impl Tracer<'_> {
    /// The facets at an edge walked from a node.
    fn uses_from(&self, v: u32, e: u32) -> Vec<LineUse> {
        let uses = &self.edge_uses[e as usize];
        if self.shape.edges.nodes[e as usize][0] == v { uses.clone() } else { flipped(uses) }
    }

    fn other_end(&self, v: u32, e: u32) -> u32 {
        let [a, b] = self.shape.edges.nodes[e as usize];
        if a == v { b } else { a }
    }

    /// Whether lines end at a node.
    fn is_vertex(&self, v: u32) -> bool {
        let [d, e] = match self.at_node[v as usize][..] {
            [] => return false,
            [d, e] => [d, e],
            _ => return true,
        };
        if flipped(&self.uses_from(v, d)) != self.uses_from(v, e) {
            return true;
        }
        let at = |v: u32| self.shape.positions[v as usize];
        let to = at(v) - at(self.other_end(v, d));
        let on = at(self.other_end(v, e)) - at(v);
        let curved = self.edge_uses[d as usize].iter().any(|u| !self.regions.plane[u.facet as usize]);
        to.cross(on).length().atan2(to.dot(on)) > if curved { SMOOTH } else { STRAIGHT }
    }

    /// Follows a line from a vertex.
    fn run(&self, start: u32, first: u32, is_vertex: &[bool], traced: &mut Traced) {
        let number = traced.lines.len() as u32;
        let uses = self.uses_from(start, first);
        let (mut nodes, mut v, mut e) = (vec![start], start, first);
        loop {
            traced.of_edge[e as usize] = number;
            traced.along_edge[e as usize] = self.shape.edges.nodes[e as usize][0] == v;
            v = self.other_end(v, e);
            nodes.push(v);
            let next = self.at_node[v as usize].iter().find(|x| **x != e);
            match next {
                Some(next) if !is_vertex[v as usize] => e = *next,
                _ => break,
            }
        }
        let at: Vec<DVec3> = nodes.iter().map(|v| self.shape.positions[*v as usize]).collect();
        let length = at.windows(2).map(|w| w[0].distance(w[1])).sum();
        let turn = |w: &[DVec3]| {
            let (to, on) = (w[1] - w[0], w[2] - w[1]);
            to.cross(on).length().atan2(to.dot(on))
        };
        let straight = at.windows(3).all(|w| turn(w) <= STRAIGHT) && at.first() != at.last();
        traced.lines.push(Line { nodes, uses, straight, length });
    }

    /// Nodes of a closed line without vertices.
    fn ring(&self, start: u32, first: u32) -> Vec<u32> {
        let (mut nodes, mut v, mut e) = (vec![start], start, first);
        loop {
            v = self.other_end(v, e);
            if v == start {
                return nodes;
            }
            nodes.push(v);
            match self.at_node[v as usize].iter().find(|x| **x != e) {
                Some(next) => e = *next,
                None => return nodes,
            }
        }
    }
}
