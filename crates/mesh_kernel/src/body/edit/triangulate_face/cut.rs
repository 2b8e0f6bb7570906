//! The planned cut of a face carried out: new nodes, edges, faces, chains and attributes of one surface.

use std::collections::BTreeSet;

use super::super::delta::{Delta, NodeValue, Recorder};
use super::super::face_mesh::FaceMesh;
use super::super::loops::rebuild;
use super::{Step, SurfacePlan, Target};
use crate::body::carry::Piece;
use crate::body::{
    AttributeNode, AttributeNodeId, Body, ChainId, DirectedEdge, EdgeId, FaceId, NONE, Surface, SurfaceId,
};

/// The numbers that a plan's new entities will have.
pub(super) struct Numbers {
    /// New nodes of every edge in [`SurfacePlan::edges`].
    nodes: Vec<Vec<u32>>,
    /// Parts behind the first of every edge.
    parts: Vec<Vec<u32>>,
    /// Nodes of every face's local points.
    pub(super) points: Vec<Vec<u32>>,
    /// New inner edges of every face, by local points, the lower first.
    cuts: Vec<Vec<([u32; 2], u32)>>,
    /// Every face's children.
    pub(super) children: Vec<Vec<u32>>,
}

impl Numbers {
    pub(super) fn new(s: &Surface, plan: &SurfacePlan) -> Self {
        let mut given = 0;
        let mut node = || {
            given += 1;
            s.slots.nodes.upcoming(s.positions.len(), given - 1)
        };
        let nodes: Vec<Vec<u32>> =
            plan.edges.iter().map(|(_, points)| points.iter().map(|_| node()).collect()).collect();
        let mut points = Vec::with_capacity(plan.faces.len());
        for (f, mesh) in &plan.faces {
            let corners = s.faces[*f as usize];
            let mut own = corners.to_vec();
            for i in 0..3 {
                let d = s.face_side(FaceId(*f), i);
                if let Some(k) = plan.place(d.edge().0) {
                    let mut side = nodes[k].clone();
                    if d.is_reversed() {
                        side.reverse();
                    }
                    own.extend(side);
                }
            }
            while own.len() < mesh.points.len() {
                own.push(node());
            }
            points.push(own);
        }
        let mut given = 0;
        let mut edge = || {
            given += 1;
            s.slots.edges.upcoming(s.edges.len(), given - 1)
        };
        let parts: Vec<Vec<u32>> =
            plan.edges.iter().map(|(_, points)| points.iter().map(|_| edge()).collect()).collect();
        let mut cuts = Vec::with_capacity(plan.faces.len());
        for (f, mesh) in &plan.faces {
            let outline = outline(s, plan, *f);
            let mut own: Vec<([u32; 2], u32)> = Vec::new();
            for t in &mesh.triangles {
                for i in 0..3 {
                    let pair = [t[i].min(t[(i + 1) % 3]), t[i].max(t[(i + 1) % 3])];
                    let known = own.iter().any(|(p, _)| *p == pair);
                    if !known && !outline.iter().any(|w| *w == pair || *w == [pair[1], pair[0]]) {
                        own.push((pair, edge()));
                    }
                }
            }
            cuts.push(own);
        }
        let mut given = 0;
        let children = plan
            .faces
            .iter()
            .map(|(f, mesh)| {
                let mut own = vec![*f];
                for _ in 1..mesh.triangles.len() {
                    own.push(s.slots.faces.upcoming(s.faces.len(), given));
                    given += 1;
                }
                own
            })
            .collect();
        Self { nodes, parts, points, cuts, children }
    }
}

/// Pairs of local points that follow each other round a face.
fn outline(s: &Surface, plan: &SurfacePlan, f: u32) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    let mut next = 3;
    for i in 0..3u32 {
        let e = s.face_edges[f as usize][i as usize];
        let n = plan.place(e).map_or(0, |k| plan.edges[k].1.len() as u32);
        let mut run = vec![i];
        run.extend(next..next + n);
        run.push((i + 1) % 3);
        next += n;
        pairs.extend(run.windows(2).map(|w| [w[0], w[1]]));
    }
    pairs
}

/// Cuts one surface; what was done comes back to be logged.
pub(super) fn apply(
    body: &mut Body,
    id: SurfaceId,
    plan: &SurfacePlan,
    numbers: &Numbers,
    own: Option<(FaceId, &Target)>,
) -> Delta {
    let mut rec = Recorder::new(body, id);
    if !rec.surface().attribute_nodes.is_empty() {
        rec.change_attributes(|s| carry(s, plan, numbers, own));
    }
    for (k, (e, points)) in plan.edges.iter().enumerate() {
        let [a, b] = rec.surface().edges[*e as usize];
        for (n, &(u, position)) in points.iter().enumerate() {
            let s = rec.surface();
            let mut value = blend(s, &[(a, 1.0 - u), (b, u)]);
            value.position = position;
            let v = rec.add_node(value);
            debug_assert_eq!(v, numbers.nodes[k][n], "nodes are numbered as planned");
        }
    }
    for ((f, mesh), points) in plan.faces.iter().zip(&numbers.points) {
        let corners = rec.surface().faces[*f as usize];
        let (sides, _) = mesh.points.split_at(outline(rec.surface(), plan, *f).len());
        for (w, &v) in mesh.points.iter().zip(points).skip(sides.len()) {
            let value = blend(rec.surface(), &[(corners[0], w[0]), (corners[1], w[1]), (corners[2], w[2])]);
            let made = rec.add_node(value);
            debug_assert_eq!(made, v, "nodes are numbered as planned");
        }
    }
    // The outlines before their edges change: local points to edges.
    let outlines: Vec<Vec<([u32; 2], u32)>> =
        plan.faces.iter().map(|(f, _)| outline_edges(rec.surface(), plan, numbers, *f)).collect();
    for (k, (e, points)) in plan.edges.iter().enumerate() {
        let [_, b] = rec.surface().edges[*e as usize];
        for n in 0..points.len() {
            let far = numbers.nodes[k].get(n + 1).copied().unwrap_or(b);
            rec.add_edge([numbers.nodes[k][n], far]);
        }
    }
    for (cuts, points) in numbers.cuts.iter().zip(&numbers.points) {
        for (pair, _) in cuts {
            rec.add_edge(pair.map(|p| points[p as usize]));
        }
    }
    // Faces last: they look up the direction of their sides in the edges' final ends.
    for (k, (e, _)) in plan.edges.iter().enumerate() {
        let [a, _] = rec.surface().edges[*e as usize];
        rec.set_ends(*e, [a, numbers.nodes[k][0]]);
    }
    for (i, (f, mesh)) in plan.faces.iter().enumerate() {
        let side = |p: u32, q: u32| {
            let found =
                outlines[i].iter().chain(&numbers.cuts[i]).find(|(w, _)| *w == [p, q] || *w == [q, p]);
            found.map_or(NONE, |(_, e)| *e)
        };
        for (n, &[p, q, r]) in mesh.triangles.iter().enumerate() {
            let corners = [p, q, r].map(|x| numbers.points[i][x as usize]);
            let sides = [side(p, q), side(q, r), side(r, p)];
            if n == 0 {
                rec.set_face(*f, corners, sides);
            } else {
                rec.add_face(corners, sides);
            }
        }
    }
    let on_chain = |(e, _): &(u32, _)| rec.surface().edge_chain(EdgeId(*e)).is_some();
    if plan.edges.iter().any(on_chain) {
        rec.change_boundary(|s| {
            lengthen_chains(s, plan, numbers);
            rebuild(s);
        });
    }
    if !rec.surface().attribute_edges.is_empty() {
        rec.change_attributes(Surface::mend_lines);
    }
    rec.finish()
}

/// A node between others.
fn blend(s: &Surface, shares: &[(u32, f64)]) -> NodeValue {
    let mut value = NodeValue::default();
    for &(v, w) in shares {
        let v = v as usize;
        value.position += s.positions[v] * w;
        value.backup += s.backup.get(v).copied().unwrap_or_default() * w;
        value.planar += s.planar.get(v).copied().unwrap_or_default() * w;
    }
    value
}

/// The edges between local points that follow each other round a face, in the numbering after the cut.
fn outline_edges(s: &Surface, plan: &SurfacePlan, numbers: &Numbers, f: u32) -> Vec<([u32; 2], u32)> {
    let mut edges = Vec::new();
    for i in 0..3 {
        let d = s.face_side(FaceId(f), i);
        match plan.place(d.edge().0) {
            None => edges.push(d.edge().0),
            Some(k) => {
                let mut parts = vec![d.edge().0];
                parts.extend(&numbers.parts[k]);
                if d.is_reversed() {
                    parts.reverse();
                }
                edges.extend(parts);
            }
        }
    }
    outline(s, plan, f).into_iter().zip(edges).collect()
}

fn lengthen_chains(s: &mut Surface, plan: &SurfacePlan, numbers: &Numbers) {
    let chains: BTreeSet<ChainId> = plan.edges.iter().filter_map(|(e, _)| s.edge_chain(EdgeId(*e))).collect();
    for c in chains {
        let old = std::mem::take(&mut s.chains[c.index()].edges);
        let mut edges = Vec::with_capacity(old.len());
        for d in old {
            let Some(k) = plan.place(d.edge().0) else {
                edges.push(d);
                continue;
            };
            let mut parts = vec![d];
            for &e in &numbers.parts[k] {
                parts.push(DirectedEdge::new(EdgeId(e), d.is_reversed()));
                s.edge_chain[e as usize] = s.edge_chain[d.edge().index()];
            }
            if d.is_reversed() {
                parts.reverse();
            }
            edges.extend(parts);
        }
        s.chains[c.index()].edges = edges;
    }
}

/// Attributes onto the parts, before the surface is changed.
fn carry(s: &mut Surface, plan: &SurfacePlan, numbers: &Numbers, own: Option<(FaceId, &Target)>) {
    let parts = |e: u32| {
        let k = plan.place(e)?;
        let ends = plan.edges[k].1.iter().map(|(u, _)| *u).chain([1.0]);
        let edges = std::iter::once(e).chain(numbers.parts[k].iter().copied());
        Some(edges.zip(ends).map(|(e, end)| (EdgeId(e), end)).collect())
    };
    let target = own.map_or(NONE, |(f, _)| f.0);
    let pieces = |f: u32| {
        let i = plan.faces.iter().position(|(x, _)| *x == f)?;
        let mesh = &plan.faces[i].1;
        let at = |p: u32| mesh.points[p as usize];
        let faces = mesh.triangles.iter().zip(&numbers.children[i]);
        let cuts = numbers.cuts[i].iter().map(|(pair, e)| (*e, pair.map(at))).collect();
        Some(Piece {
            faces: faces.map(|(t, &f)| (f, t.map(at))).collect(),
            // Lines in the face itself become edges; they do not cross any.
            cuts: if f == target { Vec::new() } else { cuts },
        })
    };
    s.carry_attributes_to_parts(parts, pieces);
    if let Some((face, target)) = own {
        settle(s, plan, numbers, face, target);
    }
}

/// Puts the attribute nodes of the face onto their new nodes, and one wherever a line passes another new node.
fn settle(s: &mut Surface, plan: &SurfacePlan, numbers: &Numbers, face: FaceId, target: &Target) {
    let Some(i) = plan.faces.iter().position(|(f, _)| *f == face.0) else { return };
    let around = outline_edges(s, plan, numbers, face.0);
    // An edge at every local point, and which of its ends the point is, by the edges' directions after the cut.
    let host = |point: u32| {
        let cut = numbers.cuts[i].iter().find_map(|(pair, e)| {
            let at = pair.iter().position(|&p| p == point)?;
            Some(AttributeNode::OnEdge { edge: EdgeId(*e), u: at as f64 })
        });
        cut.or_else(|| {
            // No inner edge ends here, so it lies on a side or is a corner.
            let (pair, e) = around.iter().find(|(pair, _)| pair.contains(&point))?;
            let along = side_runs_along(s, face, plan, numbers, *e);
            let first = if along { pair[0] } else { pair[1] };
            Some(AttributeNode::OnEdge { edge: EdgeId(*e), u: f64::from(u8::from(first != point)) })
        })
    };
    let hosts: Vec<Option<AttributeNode>> = (0..numbers.points[i].len() as u32).map(host).collect();
    for (&n, &point) in &target.points {
        if point >= 3
            && let Some(node) = hosts[point as usize]
        {
            s.attribute_nodes[n as usize] = node;
        }
    }
    let mut lines = std::mem::take(&mut s.attribute_edges);
    for line in &mut lines {
        let mut nodes = Vec::with_capacity(line.nodes.len());
        for (k, &n) in line.nodes.iter().enumerate() {
            nodes.push(n);
            let Some(&next) = line.nodes.get(k + 1) else { break };
            for point in passed(&plan.faces[i].1, target, n.0, next.0) {
                if let Some(node) = hosts[point as usize] {
                    nodes.push(AttributeNodeId(s.attribute_nodes.len() as u32));
                    s.attribute_nodes.push(node);
                }
            }
        }
        line.nodes = nodes;
    }
    s.attribute_edges = lines;
}

/// Whether an edge of the face's outline runs in the face's direction.
fn side_runs_along(s: &Surface, face: FaceId, plan: &SurfacePlan, numbers: &Numbers, e: u32) -> bool {
    (0..3).any(|i| {
        let d = s.face_side(face, i);
        let parts = plan.place(d.edge().0).map_or(&[][..], |k| &numbers.parts[k]);
        (d.edge().0 == e || parts.contains(&e)) && !d.is_reversed()
    })
}

/// Local points that a step of a line passes between its ends.
fn passed(mesh: &FaceMesh, target: &Target, from: u32, to: u32) -> Vec<u32> {
    let (Some(step), Some(&p), Some(&q)) =
        (target.steps.get(&[from, to]), target.points.get(&from), target.points.get(&to))
    else {
        return Vec::new();
    };
    let path = match *step {
        Step::Line(k) => mesh.paths[k].clone(),
        Step::Side(i) => target.input.side_points(i),
    };
    let (Some(a), Some(b)) = (path.iter().position(|&x| x == p), path.iter().position(|&x| x == q)) else {
        return Vec::new();
    };
    let (lo, hi) = (a.min(b), a.max(b));
    let mut between = path[lo + 1..hi].to_vec();
    if a > b {
        between.reverse();
    }
    between
}
