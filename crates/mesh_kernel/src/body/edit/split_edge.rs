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

use glam::{DVec2, DVec3};

use super::Editor;
use super::journal::{Attributes, Record, SplitMore};
use super::loops::{Loops, rebuild, split_unsettles};
use super::stars::{LAST, NEXT};
use crate::body::carry::Piece;
use crate::body::slots::Slots;
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
        if !s.is_edge(edge) {
            return Err(missing);
        }
        let [a, b] = s.edges[edge.index()];
        if !(at > 0.0 && at < 1.0) {
            return Err(SplitEdgeError::Parameter(at));
        }
        let position = between(s.positions[a as usize], s.positions[b as usize], at);
        if s.edges.len() + 3 >= 1 << 31 {
            return Err(SplitEdgeError::TooLarge(surface));
        }
        if s.edge_chain(edge).is_none_or(|c| s.chain(c).joint.is_none()) {
            let edge = self.split_one(surface, edge, at, None);
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
            let edge = editor.split_one(surface, edge, at, None);
            let partners = partners
                .iter()
                .map(|&(t, e, at)| editor.follow(|x| x.split_one(t, e, at, Some(position))))
                .collect();
            Ok(EdgeSplit { edge, partners })
        });
        let Ok(split) = done;
        Ok(split)
    }

    fn split_one(&mut self, surface: SurfaceId, edge: EdgeId, at: f64, position: Option<DVec3>) -> SplitEdge {
        let s = self.body.surface(surface);
        let slots = &s.slots;
        let node = slots.nodes.next(s.positions.len());
        let second = EdgeId(slots.edges.next(s.edges.len()));
        let faces = s.edge_faces[edge.index()].iter().filter(|f| **f != NONE).count();
        let reused = |slots: &Slots, n: usize| slots.free().len().min(n) as u8;
        let reused = [reused(&slots.nodes, 1), reused(&slots.edges, 1 + faces), reused(&slots.faces, faces)];
        let attributes = (!s.attribute_nodes.is_empty()).then(|| Attributes::of(s));
        let loops = split_unsettles(s, edge, second.0).then(|| Loops::of(s));
        let plain = position.is_none() && attributes.is_none() && loops.is_none();
        let more = (!plain).then(|| Box::new(SplitMore { position, attributes, loops }));
        self.perform(Record::SplitEdge { surface, edge, second, at, reused, more });
        SplitEdge { surface, edge, second, node }
    }

    /// Whether the joint runs over the edge from its second node to its first.
    pub(super) fn joint_reversed(&self, surface: SurfaceId, edge: EdgeId) -> bool {
        let s = self.body.surface(surface);
        let Some(c) = s.edge_chain(edge) else { return false };
        let chain = s.chain(c);
        let along = chain.edges.iter().find(|d| d.edge() == edge).is_some_and(|d| d.is_reversed());
        let turned = chain.joint.is_some_and(|j| {
            self.body.joint(j).uses().iter().any(|u| (u.surface, u.chain) == (surface, c) && u.reversed)
        });
        along != turned
    }

    pub(super) fn do_split(&mut self, surface: SurfaceId, edge: EdgeId, at: f64, more: Option<&SplitMore>) {
        let s = &mut self.body.surfaces[surface.index()];
        let stars = self.stars[surface.index()].as_mut();
        let [a, b] = s.edges[edge.index()];
        if !s.attribute_nodes.is_empty() {
            carry(s, edge, at);
        }
        let position = between(s.positions[a as usize], s.positions[b as usize], at);
        let m = add_node(s, more.and_then(|m| m.position).unwrap_or(position));
        if !s.backup.is_empty() {
            s.backup[m as usize] = between(s.backup[a as usize], s.backup[b as usize], at);
        }
        if !s.planar.is_empty() {
            s.planar[m as usize] = s.planar[a as usize] * (1.0 - at) + s.planar[b as usize] * at;
        }
        s.edges[edge.index()] = [a, m];
        let faces = s.edge_faces[edge.index()];
        let second = add_edge(s, [m, b]);
        // The edges at the new node, and the tips.
        let (mut ring, mut len) = ([edge.0, second, NONE, NONE], 2);
        for (slot, face) in faces.into_iter().enumerate().filter(|(_, f)| *f != NONE) {
            let cut = cut_face(s, edge.0, second, m, slot, face);
            ring[len] = cut;
            len += 1;
        }
        if let Some(stars) = stars {
            stars.exchange(a, (edge.0, b), (edge.0, m));
            stars.exchange(b, (edge.0, a), (second, m));
            let held = s.edge_chain(edge).is_some_and(|c| s.chain(c).joint.is_some());
            stars.place(m, &ring[..len], held, len == 2);
            for &cut in &ring[2..len] {
                stars.gain(s.edges[cut as usize][1], cut, m);
            }
        }
        if let Some(c) = s.edge_chain(edge) {
            let unsettled = more.is_some_and(|m| m.loops.is_some());
            s.edge_chain[second as usize] = s.edge_chain[edge.index()];
            let edges = &mut s.chains[c.index()].edges;
            if let Some(k) = edges.iter().position(|d| d.edge() == edge) {
                let reversed = edges[k].is_reversed();
                edges.insert(k + usize::from(!reversed), DirectedEdge::new(EdgeId(second), reversed));
            }
            if unsettled {
                rebuild(s);
            }
        }
        s.mend_lines();
    }

    /// The inverse of the last split of this surface: `edge` and `second` become one edge again.
    pub(super) fn do_join(
        &mut self,
        surface: SurfaceId,
        edge: EdgeId,
        second: EdgeId,
        reused: [u8; 3],
        more: Option<&SplitMore>,
    ) {
        let s = &mut self.body.surfaces[surface.index()];
        let mut stars = self.stars[surface.index()].as_mut();
        let [a, m] = s.edges[edge.index()];
        let b = s.edges[second.index()][1];
        let faces = s.edge_faces[edge.index()];
        let loops = more.and_then(|m| m.loops.as_ref());
        if let Some(c) = s.edge_chain(edge)
            && loops.is_none()
        {
            let edges = &mut s.chains[c.index()].edges;
            if let Some(k) = edges.iter().position(|d| d.edge() == second) {
                edges.remove(k);
            }
        }
        let [_, mut old_edges, mut old_faces] = reused.map(usize::from);
        let count = faces.iter().filter(|f| **f != NONE).count();
        // What took a free number came first, so it goes last.
        let (mut edges_left, mut faces_left) = (1 + count, count);
        let next = |left: &mut usize, old: &mut usize| {
            let was_free = *left <= *old;
            *left -= 1;
            was_free
        };
        for (slot, face) in faces.into_iter().enumerate().rev().filter(|(_, f)| *f != NONE) {
            let f = face as usize;
            let i = place(s, face, edge.0);
            // The part at `a` has the cut on its side after the edge on the left, before it on the right.
            let (corner, side) = if slot == 0 { (NEXT[i], NEXT[i]) } else { (i, LAST[i]) };
            let cut = s.face_edges[f][side];
            let new = s.edge_faces[second.index()][slot];
            let sides = s.face_edges[new as usize];
            // The new part's sides stand in the same places.
            s.faces[f][corner] = b;
            s.face_edges[f][side] = sides[side];
            retarget(s, sides[side], new, face);
            if let Some(stars) = &mut stars {
                let [_, tip] = s.edges[cut as usize];
                stars.lose(tip, cut, m, sides[side]);
            }
            remove_edge(s, cut, next(&mut edges_left, &mut old_edges));
            remove_face(s, new, next(&mut faces_left, &mut old_faces));
        }
        remove_edge(s, second.0, next(&mut edges_left, &mut old_edges));
        s.edges[edge.index()] = [a, b];
        if let Some(stars) = &mut stars {
            stars.exchange(a, (edge.0, m), (edge.0, b));
            stars.exchange(b, (second.0, m), (edge.0, a));
            stars.remove(m);
        }
        remove_node(s, m, reused[0] > 0);
        if let Some(loops) = loops {
            loops.restore(s);
        }
        if let Some(before) = more.and_then(|m| m.attributes.as_ref()) {
            before.restore(s);
        }
    }
}

/// A node with the number freed last, or a new one; the layers that the surface has grow along.
fn add_node(s: &mut Surface, position: DVec3) -> u32 {
    if let Some(v) = s.slots.nodes.take() {
        s.positions[v as usize] = position;
        return v;
    }
    s.positions.push(position);
    if !s.backup.is_empty() {
        s.backup.push(DVec3::ZERO);
    }
    if !s.planar.is_empty() {
        s.planar.push(DVec2::ZERO);
    }
    s.positions.len() as u32 - 1
}

#[inline]
fn add_edge(s: &mut Surface, ends: [u32; 2]) -> u32 {
    if let Some(e) = s.slots.edges.take() {
        s.edges[e as usize] = ends;
        return e;
    }
    s.edges.push(ends);
    s.edge_faces.push([NONE; 2]);
    s.edge_chain.push(NO_CHAIN);
    s.edges.len() as u32 - 1
}

#[inline]
fn add_face(s: &mut Surface, corners: [u32; 3], sides: [u32; 3]) -> u32 {
    if let Some(f) = s.slots.faces.take() {
        (s.faces[f as usize], s.face_edges[f as usize]) = (corners, sides);
        return f;
    }
    s.faces.push(corners);
    s.face_edges.push(sides);
    s.faces.len() as u32 - 1
}

fn remove_node(s: &mut Surface, v: u32, was_free: bool) {
    if was_free {
        release_node(s, v);
        return;
    }
    s.positions.pop();
    s.backup.pop();
    s.planar.pop();
}

/// Frees a node that nothing names any more.
pub(super) fn release_node(s: &mut Surface, v: u32) {
    s.positions[v as usize] = DVec3::ZERO;
    if let Some(p) = s.backup.get_mut(v as usize) {
        *p = DVec3::ZERO;
    }
    if let Some(p) = s.planar.get_mut(v as usize) {
        *p = DVec2::ZERO;
    }
    s.slots.nodes.release(v);
}

fn remove_edge(s: &mut Surface, e: u32, was_free: bool) {
    if was_free {
        release_edge(s, e);
        return;
    }
    s.edges.pop();
    s.edge_faces.pop();
    s.edge_chain.pop();
}

/// Frees an edge that nothing names any more.
pub(super) fn release_edge(s: &mut Surface, e: u32) {
    s.edges[e as usize] = [NONE; 2];
    s.edge_faces[e as usize] = [NONE; 2];
    s.edge_chain[e as usize] = NO_CHAIN;
    s.slots.edges.release(e);
}

fn remove_face(s: &mut Surface, f: u32, was_free: bool) {
    if was_free {
        release_face(s, f);
        return;
    }
    s.faces.pop();
    s.face_edges.pop();
}

/// Frees a face that nothing names any more.
pub(super) fn release_face(s: &mut Surface, f: u32) {
    s.faces[f as usize] = [NONE; 3];
    s.face_edges[f as usize] = [NONE; 3];
    s.slots.faces.release(f);
}

/// Cuts a face, left (slot 0) or right of the edge, from the edge's new node `m` to its tip; gives the new edge.
#[inline]
fn cut_face(s: &mut Surface, edge: u32, second: u32, m: u32, slot: usize, face: u32) -> u32 {
    // On the left the face runs a → b, on the right b → a; the part at `a` stays.
    let f = face as usize;
    let i = place(s, face, edge);
    let (mut corners, mut sides) = (s.faces[f], s.face_edges[f]);
    let tip = corners[LAST[i]];
    let (gone, on) = if slot == 0 { (NEXT[i], NEXT[i]) } else { (i, LAST[i]) };
    let (kept, cut_side) = if slot == 0 { (i, LAST[i]) } else { (NEXT[i], NEXT[i]) };
    let outer = sides[on];
    // New part m, b, c on the left; b, m, d on the right.
    corners[kept] = m;
    sides[i] = second;
    let new = s.slots.faces.next(s.faces.len());
    let cut = add_edge(s, [m, tip]);
    s.edge_faces[cut as usize] = if slot == 0 { [face, new] } else { [new, face] };
    sides[cut_side] = cut;
    s.faces[f][gone] = m;
    s.face_edges[f][on] = cut;
    retarget(s, outer, face, new);
    s.edge_faces[second as usize][slot] = new;
    add_face(s, corners, sides);
    cut
}

/// The side of a face that an edge is.
#[inline]
fn place(s: &Surface, face: u32, edge: u32) -> usize {
    let [x, y, _] = s.face_edges[face as usize];
    if x == edge { 0 } else { 1 + usize::from(y != edge) }
}

pub(super) fn between(a: DVec3, b: DVec3, at: f64) -> DVec3 {
    a * (1.0 - at) + b * at
}

/// The number that is given when `k` more have been given before.
fn number(slots: &Slots, len: usize, k: usize) -> u32 {
    let free = slots.free();
    if k < free.len() { free[free.len() - 1 - k] } else { (len + k - free.len()) as u32 }
}

/// Edge `e` has face `to` where it had `from`.
fn retarget(s: &mut Surface, e: u32, from: u32, to: u32) {
    let faces = &mut s.edge_faces[e as usize];
    faces[usize::from(faces[0] != from)] = to;
}

/// Attributes onto the halves of the edge and the parts of its faces, before the surface is changed.
fn carry(s: &mut Surface, edge: EdgeId, at: f64) {
    let second = EdgeId(number(&s.slots.edges, s.edges.len(), 0));
    let mut parts = Vec::new();
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
        let new = number(&s.slots.faces, s.faces.len(), parts.len());
        let cut = number(&s.slots.edges, s.edges.len(), 1 + parts.len());
        parts.push((FaceId(face), old, new, other, cut, [m, corner(k)]));
    }
    s.carry_attributes(
        |e| (e == edge.0).then_some(([edge, second], at)),
        |f| {
            let (_, old, new, other, cut, ends) = parts.iter().find(|p| p.0.0 == f)?;
            Some(Piece { faces: vec![(f, *old), (*new, *other)], cuts: vec![(*cut, *ends)] })
        },
    );
}
