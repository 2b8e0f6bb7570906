//! Edge split: a new node on an edge, its faces cut in two; on a joint all partners alike.
//!
//! ```text
//!        c                 c
//!      /   \             / | \
//!     a-----b    →      a--m--b
//!      \   /             \ | /
//!        d                 d
//! ```
//!
//! In K3 terms: split_edge (v + 1, e + 1) and, for every face, an edge that makes a face (MEF: e + 1, f + 1).

use glam::DVec3;

use super::Editor;
use super::journal::{Attributes, Record};
use crate::body::carry::Piece;
use crate::body::surface::NO_CHAIN;
use crate::body::{DirectedEdge, EdgeId, FaceId, NONE, SplitEdge, Surface, SurfaceId};

/// Why an edge was not split.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SplitEdgeError {
    /// No such edge.
    #[error("surface {surface} has no edge {edge}")]
    NoEdge {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
    },
    /// A parameter that is not inside the edge.
    #[error("an edge is split at a parameter between 0 and 1, not at {0}")]
    Parameter(f64),
    /// Ids would run out.
    #[error("surface {0} has no ids left for more edges")]
    TooLarge(SurfaceId),
}

/// What an edge was split into.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EdgeSplit {
    /// The edge.
    pub edge: SplitEdge,
    /// Its partners on the joint, in order of surfaces and edges.
    pub partners: Vec<SplitEdge>,
}

impl Editor {
    /// Splits an edge at parameter `at` (0 at its first node), on a joint together with all its partners, whose new nodes
    /// are bit-equal in position. New nodes, edges and faces are numbered from the end; old ones keep their numbers: the
    /// edge is its half at its first node, a face its part there. Chains, loops, attributes, backup and planar positions
    /// follow.
    ///
    /// # Errors
    /// Unknown edge; a parameter outside the edge; ids run out. Nothing is changed then. O(1) inside a surface,
    /// O(length of the chain) on one.
    pub fn split_edge(
        &mut self,
        surface: SurfaceId,
        edge: EdgeId,
        at: f64,
    ) -> Result<EdgeSplit, SplitEdgeError> {
        let missing = SplitEdgeError::NoEdge { surface, edge };
        let s = self.body.surfaces.get(surface.index()).ok_or(missing.clone())?;
        let &[a, b] = s.edges.get(edge.index()).ok_or(missing)?;
        if !(at > 0.0 && at < 1.0) {
            return Err(SplitEdgeError::Parameter(at));
        }
        let position = between(s.positions[a as usize], s.positions[b as usize], at);
        if s.edges.len() + 3 >= 1 << 31 {
            return Err(SplitEdgeError::TooLarge(surface));
        }
        if s.edge_chain(edge).is_none_or(|c| s.chain(c).joint.is_none()) {
            let edge = self.split_one(surface, edge, at, position);
            return Ok(EdgeSplit { edge, partners: Vec::new() });
        }
        let own = self.joint_reversed(surface, edge);
        let mut partners: Vec<(SurfaceId, EdgeId, f64)> = Vec::new();
        for (t, d) in self.body.partners(surface, edge) {
            partners.push((t, d.edge(), if d.is_reversed() == own { at } else { 1.0 - at }));
        }
        partners.sort_by_key(|(t, e, _)| (*t, *e));
        for (t, ..) in &partners {
            if self.body.surface(*t).edges.len() + 3 * (partners.len() + 1) >= 1 << 31 {
                return Err(SplitEdgeError::TooLarge(*t));
            }
        }
        let done: Result<EdgeSplit, std::convert::Infallible> = self.transaction(|editor| {
            let edge = editor.split_one(surface, edge, at, position);
            let partners = partners.iter().map(|&(t, e, at)| editor.split_one(t, e, at, position)).collect();
            Ok(EdgeSplit { edge, partners })
        });
        let Ok(split) = done;
        Ok(split)
    }

    fn split_one(&mut self, surface: SurfaceId, edge: EdgeId, at: f64, position: DVec3) -> SplitEdge {
        let s = self.body.surface(surface);
        let (node, second) = (s.positions.len() as u32, EdgeId(s.edges.len() as u32));
        let attributes = (!s.attribute_nodes.is_empty()).then(|| {
            Box::new(Attributes { nodes: s.attribute_nodes.clone(), edges: s.attribute_edges.clone() })
        });
        self.apply(Record::SplitEdge { surface, edge, at, position, attributes });
        SplitEdge { surface, edge, second, node }
    }

    /// Whether the joint runs over the edge from its second node to its first.
    fn joint_reversed(&self, surface: SurfaceId, edge: EdgeId) -> bool {
        let s = self.body.surface(surface);
        let Some(c) = s.edge_chain(edge) else { return false };
        let chain = s.chain(c);
        let along = chain.edges.iter().find(|d| d.edge() == edge).is_some_and(|d| d.is_reversed());
        let turned = chain.joint.is_some_and(|j| {
            self.body.joint(j).uses().iter().any(|u| (u.surface, u.chain) == (surface, c) && u.reversed)
        });
        along != turned
    }

    pub(super) fn do_split(&mut self, surface: SurfaceId, edge: EdgeId, at: f64, position: DVec3) {
        let s = &mut self.body.surfaces[surface.index()];
        let mut joined = self.joined[surface.index()].as_mut();
        let e = edge.0;
        let [a, b] = s.edges[edge.index()];
        let (m, second) = (s.positions.len() as u32, s.edges.len() as u32);
        if !s.attribute_nodes.is_empty() {
            carry(s, edge, at);
        }
        s.positions.push(position);
        if !s.backup.is_empty() {
            s.backup.push(between(s.backup[a as usize], s.backup[b as usize], at));
        }
        if !s.planar.is_empty() {
            s.planar.push(s.planar[a as usize] * (1.0 - at) + s.planar[b as usize] * at);
        }
        s.edges[edge.index()] = [a, m];
        s.edges.push([m, b]);
        s.edge_faces.push([NONE; 2]);
        s.edge_chain.push(NO_CHAIN);
        if let Some(joined) = &mut joined {
            joined.remove(a, b);
            joined.insert(a, m);
            joined.insert(m, b);
        }
        for (slot, face) in s.edge_faces[edge.index()].into_iter().enumerate().filter(|(_, f)| *f != NONE) {
            // On the left (slot 0) the face runs a → b, on the right b → a; the part at `a` stays.
            let f = face as usize;
            let i = s.face_edges[f].iter().position(|&x| x == e).unwrap_or(0);
            let [j, k] = [(i + 1) % 3, (i + 2) % 3];
            let (new, cut) = (s.faces.len() as u32, s.edges.len() as u32);
            let (mut corners, mut sides) = (s.faces[f], s.face_edges[f]);
            let tip = corners[k];
            if slot == 0 {
                // New part m, b, c.
                corners[i] = m;
                sides[i] = second;
                sides[k] = cut;
                s.faces[f][j] = m;
                s.face_edges[f][j] = cut;
                retarget(s, sides[j], face, new);
                s.edge_faces.push([face, new]);
            } else {
                // New part b, m, d.
                corners[j] = m;
                sides[i] = second;
                sides[j] = cut;
                s.faces[f][i] = m;
                s.face_edges[f][k] = cut;
                retarget(s, sides[k], face, new);
                s.edge_faces.push([new, face]);
            }
            s.edges.push([m, tip]);
            s.edge_chain.push(NO_CHAIN);
            s.edge_faces[second as usize][slot] = new;
            s.faces.push(corners);
            s.face_edges.push(sides);
            if let Some(joined) = &mut joined {
                joined.insert(m, tip);
            }
        }
        if let Some(c) = s.edge_chain(edge) {
            s.edge_chain[second as usize] = s.edge_chain[edge.index()];
            let edges = &mut s.chains[c.index()].edges;
            if let Some(k) = edges.iter().position(|d| d.edge() == edge) {
                let reversed = edges[k].is_reversed();
                edges.insert(k + usize::from(!reversed), DirectedEdge::new(EdgeId(second), reversed));
            }
        }
    }

    /// The inverse of the last split of this surface: `edge` and the last node become one edge again.
    pub(super) fn do_join(&mut self, surface: SurfaceId, edge: EdgeId, attributes: Option<&Attributes>) {
        let s = &mut self.body.surfaces[surface.index()];
        let mut joined = self.joined[surface.index()].as_mut();
        let [a, m] = s.edges[edge.index()];
        let faces = s.edge_faces[edge.index()];
        let second = s.edges.len() as u32 - 1 - faces.iter().filter(|f| **f != NONE).count() as u32;
        let b = s.edges[second as usize][1];
        if let Some(c) = s.edge_chain(edge) {
            s.chains[c.index()].edges.retain(|d| d.edge().0 != second);
        }
        for (slot, face) in faces.into_iter().enumerate().rev().filter(|(_, f)| *f != NONE) {
            let f = face as usize;
            let i = s.face_edges[f].iter().position(|&x| x == edge.0).unwrap_or(0);
            let [j, k] = [(i + 1) % 3, (i + 2) % 3];
            let new = s.faces.len() as u32 - 1;
            let cut = s.edges.len() - 1;
            let sides = s.face_edges[new as usize];
            let (corner, side) = if slot == 0 { (j, j) } else { (i, k) };
            s.faces[f][corner] = b;
            s.face_edges[f][side] = sides[side];
            retarget(s, sides[side], new, face);
            if let Some(joined) = &mut joined {
                joined.remove(m, s.edges[cut][1]);
            }
            s.edges.pop();
            s.edge_faces.pop();
            s.edge_chain.pop();
            s.faces.pop();
            s.face_edges.pop();
        }
        s.edges.pop();
        s.edge_faces.pop();
        s.edge_chain.pop();
        s.edges[edge.index()] = [a, b];
        if let Some(joined) = &mut joined {
            joined.remove(a, m);
            joined.remove(m, b);
            joined.insert(a, b);
        }
        s.positions.pop();
        if !s.backup.is_empty() {
            s.backup.pop();
        }
        if !s.planar.is_empty() {
            s.planar.pop();
        }
        if let Some(before) = attributes {
            s.attribute_nodes.clone_from(&before.nodes);
            s.attribute_edges.clone_from(&before.edges);
        }
    }
}

fn between(a: DVec3, b: DVec3, at: f64) -> DVec3 {
    a * (1.0 - at) + b * at
}

/// Edge `e` has face `to` where it had `from`.
fn retarget(s: &mut Surface, e: u32, from: u32, to: u32) {
    let faces = &mut s.edge_faces[e as usize];
    faces[usize::from(faces[0] != from)] = to;
}

/// Attributes onto the halves of the edge and the parts of its faces, before the surface is changed.
fn carry(s: &mut Surface, edge: EdgeId, at: f64) {
    let second = EdgeId(s.edges.len() as u32);
    let mut parts = Vec::new();
    let (mut new, mut cut) = (s.faces.len() as u32, second.0 + 1);
    for (slot, face) in s.edge_faces[edge.index()].into_iter().enumerate().filter(|(_, f)| *f != NONE) {
        let i = s.face_edges[face as usize].iter().position(|&x| x == edge.0).unwrap_or(0);
        let [j, k] = [(i + 1) % 3, (i + 2) % 3];
        let corner = |i: usize| {
            let mut areal = [0.0; 3];
            areal[i] = 1.0;
            areal
        };
        // The edge's first node is the face's corner i on the left, j on the right.
        let mut m = [0.0; 3];
        let (first, last) = if slot == 0 { (i, j) } else { (j, i) };
        m[first] = 1.0 - at;
        m[last] = at;
        let (mut old, mut other) = ([0, 1, 2].map(corner), [0, 1, 2].map(corner));
        old[last] = m;
        other[first] = m;
        parts.push((FaceId(face), old, new, other, cut, [m, corner(k)]));
        new += 1;
        cut += 1;
    }
    s.carry_attributes(
        |e| (e == edge.0).then_some(([edge, second], at)),
        |f| {
            let (_, old, new, other, cut, ends) = parts.iter().find(|p| p.0.0 == f)?;
            Some(Piece { faces: vec![(f, *old), (*new, *other)], cuts: vec![(*cut, *ends)] })
        },
    );
}
