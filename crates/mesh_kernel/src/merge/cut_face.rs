//! One face cut along lines: a constrained Delaunay triangulation of it, seen along the axis nearest to its normal.
//!
//! Seen so, nodes keep their whole-number coordinates and predicates stay exact. Rounded nodes are up to a cell off the
//! face's plane, and its sides are no longer quite straight; what counts is that the triangles have the face's outline,
//! with its nodes, for their boundary. Where the outline crosses itself by that cell, a fan has too.

use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};

/// A node as it is seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) node: u32,
    pub(super) x: f64,
    pub(super) y: f64,
}

impl HasPosition for Seen {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        Point2::new(self.x, self.y)
    }
}

/// A face's cut parts.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Parts {
    /// Wound as the outline.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Nodes that are seen in one place.
    pub(super) together: Vec<[u32; 2]>,
}

/// Cuts a face. `nodes` begins with the outline, anticlockwise, of `outline` nodes; `lines` are pairs of indices into it.
/// O(n log n).
pub(super) fn cut(nodes: &[Seen], outline: usize, lines: &[[u32; 2]]) -> Parts {
    let mut parts = Parts::default();
    for ring in simple_rings(nodes, outline) {
        match triangulate(nodes, &ring, lines) {
            Some(mut cut) => {
                parts.triangles.append(&mut cut.triangles);
                parts.together.append(&mut cut.together);
            }
            None => parts.triangles.extend(fan(nodes, &ring)),
        }
    }
    parts
}

/// Fans over the outline of a face without area.
pub(super) fn flat_parts(nodes: &[Seen], outline: usize) -> Parts {
    let triangles = simple_rings(nodes, outline).iter().flat_map(|ring| fan(nodes, ring)).collect();
    Parts { triangles, together: Vec::new() }
}

/// Turns edges so that no triangle has all its corners on one side of the face. Nodes on a side are a little off its line, and
/// one that stands out would leave a triangle as thin as that; put onto the side because the face beyond was that thin, it
/// would leave that face again. `sides_of` tells for a node the sides that it is on, a bit each.
pub(super) fn turn_flat(triangles: &mut [[u32; 3]], sides_of: impl Fn(u32) -> u8) {
    let common = |t: &[u32; 3]| t.iter().fold(u8::MAX, |all, v| all & sides_of(*v));
    for _ in 0..triangles.len() {
        let mut turned = false;
        for i in 0..triangles.len() {
            let side = common(&triangles[i]);
            if side == 0 {
                continue;
            }
            for k in 0..3 {
                let t = triangles[i];
                let (p, q, r) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
                let beyond = triangles.iter().enumerate().find_map(|(j, t)| {
                    let m = (0..3).find(|&m| t[m] == q && t[(m + 1) % 3] == p)?;
                    Some((j, t[(m + 2) % 3]))
                });
                if let Some((j, x)) = beyond
                    && sides_of(x) & side == 0
                {
                    triangles[i] = [p, x, r];
                    triangles[j] = [x, q, r];
                    turned = true;
                    break;
                }
            }
        }
        if !turned {
            return;
        }
    }
}

/// An outline in rings that pass no node twice; where it runs back the way it came nothing is left.
fn simple_rings(nodes: &[Seen], outline: usize) -> Vec<Vec<u32>> {
    let mut rings = Vec::new();
    let mut open: Vec<u32> = Vec::with_capacity(outline);
    for i in 0..outline as u32 {
        let node = nodes[i as usize].node;
        if let Some(k) = open.iter().position(|&j| nodes[j as usize].node == node) {
            let ring = open.split_off(k);
            if ring.len() > 2 {
                rings.push(ring);
            }
        }
        open.push(i);
    }
    if open.len() > 2 {
        rings.push(open);
    }
    rings
}

/// The fan over a ring from that of its nodes from which it covers least.
fn fan(nodes: &[Seen], ring: &[u32]) -> Vec<[u32; 3]> {
    let area = |[a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|i| nodes[i as usize]);
        ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)).abs()
    };
    let from = |start: usize| {
        let at = move |k: usize| ring[(start + k) % ring.len()];
        (1..ring.len() - 1).map(move |k| [at(0), at(k), at(k + 1)])
    };
    let covered = |start: usize| from(start).map(area).sum::<f64>();
    let best = (0..ring.len()).min_by(|a, b| covered(*a).total_cmp(&covered(*b))).unwrap_or(0);
    from(best).map(|t| t.map(|i| nodes[i as usize].node)).collect()
}

fn triangulate(nodes: &[Seen], ring: &[u32], lines: &[[u32; 2]]) -> Option<Parts> {
    let mut cdt = ConstrainedDelaunayTriangulation::<Seen>::new();
    let mut handles = Vec::with_capacity(nodes.len());
    let mut together = Vec::new();
    for seen in nodes {
        let before = cdt.num_vertices();
        let handle = cdt.insert(*seen).ok()?;
        if cdt.num_vertices() == before {
            // The first of those in one place stays.
            let first = nodes[handles.iter().position(|h| *h == handle)?].node;
            cdt.vertex_data_mut(handle).node = first;
            if first != seen.node {
                together.push([first, seen.node]);
            }
        }
        handles.push(handle);
    }
    let mut border = Vec::with_capacity(ring.len());
    let mut run = Vec::with_capacity(ring.len());
    for k in 0..ring.len() {
        let [a, b] = [k, (k + 1) % ring.len()].map(|k| handles[ring[k] as usize]);
        if a == b {
            continue;
        }
        if !cdt.can_add_constraint(a, b) {
            return None;
        }
        cdt.add_constraint(a, b);
        // A node exactly on the outline that the outline does not know: its neighbour would not know it either.
        cdt.get_edge_from_neighbors(a, b)?;
        border.push((a.index().min(b.index()), a.index().max(b.index())));
        run.push((a, b));
    }
    border.sort_unstable();
    if border.windows(2).any(|w| w[0] == w[1]) {
        return None;
    }
    for &[a, b] in lines {
        let (a, b) = (handles[a as usize], handles[b as usize]);
        // A line that cannot be had now is found crossing again in the next round.
        if a != b && cdt.can_add_constraint(a, b) {
            cdt.add_constraint(a, b);
        }
    }
    // What can be reached from outside without passing the outline is outside.
    let mut outside = vec![false; cdt.num_all_faces()];
    let mut pending = vec![cdt.outer_face().fix()];
    outside[cdt.outer_face().fix().index()] = true;
    // Directed edges by the face on their left, outer face included.
    let mut edges_of = vec![Vec::new(); cdt.num_all_faces()];
    for edge in cdt.directed_edges() {
        edges_of[edge.face().fix().index()].push(edge.fix());
    }
    while let Some(face) = pending.pop() {
        for &edge in &edges_of[face.index()] {
            let edge = cdt.directed_edge(edge);
            let (a, b) = (edge.from().fix().index(), edge.to().fix().index());
            let next = edge.rev().face().fix();
            if !outside[next.index()] && border.binary_search(&(a.min(b), a.max(b))).is_err() {
                outside[next.index()] = true;
                pending.push(next);
            }
        }
    }
    // The ring has to run round its inside, anticlockwise or, turned over by rounding, clockwise.
    let inside = |left: bool| {
        run.iter().all(|&(a, b)| {
            cdt.get_edge_from_neighbors(a, b).is_some_and(|e| {
                let outside =
                    |e: spade::handles::DirectedEdgeHandle<'_, _, _, _, _>| outside[e.face().fix().index()];
                outside(e) != left && outside(e.rev()) == left
            })
        })
    };
    let turned = !inside(true);
    if turned && !inside(false) {
        return None;
    }
    let triangles = cdt
        .inner_faces()
        .filter(|f| !outside[f.fix().index()])
        .map(|f| f.vertices().map(|v| v.data().node))
        .map(|[a, b, c]| if turned { [a, c, b] } else { [a, b, c] })
        .collect();
    Some(Parts { triangles, together })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(points: &[(f64, f64)]) -> Vec<Seen> {
        points.iter().zip(10..).map(|(&(x, y), node)| Seen { node, x, y }).collect()
    }

    /// The boundary of triangles, directed edges that nothing undoes.
    fn boundary(triangles: &[[u32; 3]]) -> Vec<(u32, u32)> {
        let mut edges = Vec::new();
        for [a, b, c] in triangles {
            for e in [(*a, *b), (*b, *c), (*c, *a)] {
                match edges.iter().position(|&(x, y)| (y, x) == e) {
                    Some(k) => {
                        edges.remove(k);
                    }
                    None => edges.push(e),
                }
            }
        }
        edges.sort_unstable();
        edges
    }

    #[test]
    fn a_cut_face_keeps_its_outline() {
        let nodes = seen(&[(0.0, 0.0), (50.0, 0.0), (100.0, 0.0), (50.0, 50.0), (0.0, 100.0), (20.0, 20.0)]);
        let parts = cut(&nodes, 5, &[[1, 5], [5, 4]]);
        assert_eq!(boundary(&parts.triangles), [(10, 11), (11, 12), (12, 13), (13, 14), (14, 10)]);
        let has = |a, b| parts.triangles.iter().any(|t| t.contains(&a) && t.contains(&b));
        assert!(has(11, 15) && has(15, 14));
    }

    #[test]
    fn an_outline_that_crosses_itself_is_kept_too() {
        let nodes = seen(&[(0.0, 0.0), (100.0, 0.0), (50.0, 1.0), (60.0, -1.0), (0.0, 100.0)]);
        let parts = cut(&nodes, 5, &[]);
        assert_eq!(boundary(&parts.triangles), [(10, 11), (11, 12), (12, 13), (13, 14), (14, 10)]);
    }

    #[test]
    fn nodes_seen_in_one_place_are_named() {
        let nodes = seen(&[(0.0, 0.0), (100.0, 0.0), (0.0, 100.0), (20.0, 20.0), (20.0, 20.0)]);
        let parts = cut(&nodes, 3, &[]);
        assert_eq!(parts.together, [[13, 14]]);
        assert_eq!(parts.triangles.len(), 3);
    }
}
