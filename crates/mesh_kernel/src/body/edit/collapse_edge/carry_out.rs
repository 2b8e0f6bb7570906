//! The collapse of one edge in one surface: carried out, and taken back.

use glam::{DVec2, DVec3};

use crate::body::edit::Editor;
use crate::body::edit::carry_attributes::{EndOf, GoneFace, carry_collapse};
use crate::body::edit::journal::Attributes;
use crate::body::edit::link_condition::Place;
use crate::body::edit::loops::{Loops, lowest_of_whole, rebuild};
use crate::body::edit::operation::Operation;
use crate::body::edit::split_edge::{release_edge, release_face, release_node};
use crate::body::edit::stars::{LAST, NEXT, corner};
use crate::body::edit::swap_edge::Guard;
use crate::body::{DirectedEdge, EdgeId, NONE, NodeId, Surface, SurfaceId};

/// What is needed to collapse one edge, and to take it back.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::body::edit) struct Collapse {
    pub(in crate::body::edit) surface: SurfaceId,
    pub(in crate::body::edit) edge: EdgeId,
    /// As it was asked for.
    pub(in crate::body::edit) at: Option<f64>,
    pub(in crate::body::edit) kept: u32,
    pub(in crate::body::edit) removed: u32,
    pub(in crate::body::edit) ends: [u32; 2],
    pub(in crate::body::edit) edge_faces: [u32; 2],
    /// Left and right.
    pub(in crate::body::edit) faces: [Option<Gone>; 2],
    /// Edges of the removed node that stay, with their other ends.
    pub(in crate::body::edit) spokes: Vec<[u32; 2]>,
    /// Faces of the removed node that stay.
    pub(in crate::body::edit) fan: Vec<u32>,
    /// The removed node.
    pub(in crate::body::edit) node: Layers,
    /// Places on the pattern: of the removed node, of the kept one, and where that goes.
    pub(in crate::body::edit) planar: [DVec2; 3],
    /// Nodes that move, with their old places, and where they go.
    pub(in crate::body::edit) moved: Vec<(Place, Layers)>,
    pub(in crate::body::edit) to: Layers,
    /// Before, where a chain is touched.
    pub(in crate::body::edit) loops: Option<Loops>,
    /// Whether the loops are to be found anew.
    pub(in crate::body::edit) unsettled: bool,
    pub(in crate::body::edit) attributes: Option<Attributes>,
    /// An edge that stays, by the end that will be the kept node, for attributes of the edge that goes.
    pub(in crate::body::edit) host: EndOf,
}

impl Collapse {
    /// The operator that was asked for; its guard has been passed.
    pub(in crate::body::edit) fn operation(&self) -> Operation {
        let (surface, edge, keep) = (self.surface, self.edge, NodeId(self.kept));
        Operation::CollapseEdge { surface, edge, keep, at: self.at, guard: Guard::None }
    }
}

/// Positions of a node in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::body::edit) struct Layers {
    pub(super) position: DVec3,
    pub(super) backup: DVec3,
}

impl Layers {
    pub(super) fn of(s: &Surface, v: u32) -> Self {
        let backup = s.backup.get(v as usize).copied().unwrap_or_default();
        Self { position: s.positions[v as usize], backup }
    }

    fn put(self, s: &mut Surface, v: u32) {
        s.positions[v as usize] = self.position;
        if let Some(backup) = s.backup.get_mut(v as usize) {
            *backup = self.backup;
        }
    }
}

/// A face at the edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::body::edit) struct Gone {
    pub(super) face: u32,
    pub(super) corners: [u32; 3],
    pub(super) sides: [u32; 3],
    /// The side at the removed node, its ends and faces.
    pub(super) side: u32,
    pub(super) side_ends: [u32; 2],
    pub(super) side_faces: [u32; 2],
    /// The side at the kept node, and which of its faces this is.
    pub(super) into: u32,
    pub(super) slot: usize,
    /// The face beyond the side at the removed node.
    pub(super) outer: u32,
    pub(super) tip: u32,
}

impl Gone {
    pub(super) fn of(s: &Surface, face: u32, edge: u32, removed: u32) -> Self {
        let (corners, sides) = (s.faces[face as usize], s.face_edges[face as usize]);
        // The edge runs from corner i to the next.
        let i = if sides[0] == edge { 0 } else { 1 + usize::from(sides[1] != edge) };
        let (side, into) = if corners[i] == removed {
            (sides[LAST[i]], sides[NEXT[i]])
        } else {
            (sides[NEXT[i]], sides[LAST[i]])
        };
        let side_faces = s.edge_faces[side as usize];
        Self {
            face,
            corners,
            sides,
            side,
            side_ends: s.edges[side as usize],
            side_faces,
            into,
            slot: usize::from(s.edge_faces[into as usize][0] != face),
            outer: side_faces[0] ^ side_faces[1] ^ face,
            tip: corners[LAST[i]],
        }
    }

    fn for_attributes(&self) -> GoneFace {
        let tip_corner =
            usize::from(self.corners[0] != self.tip) * (1 + usize::from(self.corners[1] != self.tip));
        GoneFace { face: self.face, tip_corner, tip: self.tip, side: self.side, into: self.into }
    }
}

impl Editor {
    pub(in crate::body::edit) fn do_collapse(&mut self, c: &Collapse) {
        let mut stars = self.stars[c.surface.index()].as_mut();
        let s = &mut self.body.surfaces[c.surface.index()];
        let mut around = Vec::new();
        if let Some(stars) = &mut stars
            && stars.knows_singular()
        {
            stars.edges_at(s, c.kept, &mut around);
        }
        if c.attributes.is_some() {
            let gone: Vec<GoneFace> = c.faces.iter().flatten().map(Gone::for_attributes).collect();
            carry_collapse(s, c.edge.0, c.host, &gone);
        }
        for &f in &c.fan {
            let i = corner(s, f, c.removed);
            s.faces[f as usize][i] = c.kept;
        }
        for &[e, _] in &c.spokes {
            let ends = &mut s.edges[e as usize];
            ends[usize::from(ends[0] != c.removed)] = c.kept;
        }
        if c.loops.is_some() {
            draw_chains(s, c);
        }
        for g in c.faces.iter().flatten() {
            s.edge_faces[g.into as usize][g.slot] = g.outer;
            if g.outer != NONE {
                let i = place(s, g.outer, g.side);
                s.face_edges[g.outer as usize][i] = g.into;
            }
        }
        for g in c.faces.iter().flatten() {
            release_face(s, g.face);
        }
        release_edge(s, c.edge.0);
        for g in c.faces.iter().flatten() {
            release_edge(s, g.side);
        }
        release_node(s, c.removed);
        if let Some(planar) = s.planar.get_mut(c.kept as usize) {
            *planar = c.planar[2];
        }
        if c.unsettled {
            rebuild(s);
        }
        if let Some(stars) = stars {
            for &[e, far] in &c.spokes {
                stars.exchange(far, (e, c.removed), (e, c.kept));
            }
            for g in c.faces.iter().flatten() {
                stars.lose(g.tip, g.side, c.removed, g.into);
            }
            stars.remove(c.removed);
            if stars.knows_singular() {
                around.retain(|&e| e != c.edge.0);
                around.extend(c.spokes.iter().map(|s| s[0]));
                let held = stars.is_held(c.kept);
                stars.recount(s, c.kept, &around, held);
            } else {
                let other =
                    c.faces.iter().flatten().map(|g| g.into).chain(c.spokes.iter().map(|s| s[0])).next();
                // A wire's free end: what is left at the kept node is not at hand.
                let other =
                    other.or_else(|| s.edges.iter().position(|x| x.contains(&c.kept)).map(|e| e as u32));
                stars.lose(c.kept, c.edge.0, c.removed, other.unwrap_or(NONE));
                for &[e, far] in &c.spokes {
                    stars.gain(c.kept, e, far);
                }
            }
        }
        for ((t, v), _) in &c.moved {
            c.to.put(&mut self.body.surfaces[t.index()], *v);
        }
    }

    pub(in crate::body::edit) fn undo_collapse(&mut self, c: &Collapse) {
        let mut stars = self.stars[c.surface.index()].as_mut();
        for ((t, v), old) in &c.moved {
            old.put(&mut self.body.surfaces[t.index()], *v);
        }
        let s = &mut self.body.surfaces[c.surface.index()];
        let mut around = Vec::new();
        if let Some(stars) = &mut stars {
            stars.edges_at(s, c.kept, &mut around);
        }
        s.slots.nodes.take();
        for g in c.faces.iter().rev().flatten() {
            s.slots.edges.take();
            s.edges[g.side as usize] = g.side_ends;
            s.edge_faces[g.side as usize] = g.side_faces;
        }
        s.slots.edges.take();
        s.edges[c.edge.index()] = c.ends;
        s.edge_faces[c.edge.index()] = c.edge_faces;
        for g in c.faces.iter().rev().flatten() {
            s.slots.faces.take();
            (s.faces[g.face as usize], s.face_edges[g.face as usize]) = (g.corners, g.sides);
            s.edge_faces[g.into as usize][g.slot] = g.face;
            if g.outer != NONE {
                let i = place(s, g.outer, g.into);
                s.face_edges[g.outer as usize][i] = g.side;
            }
        }
        for &f in &c.fan {
            let i = corner(s, f, c.kept);
            s.faces[f as usize][i] = c.removed;
        }
        for &[e, _] in &c.spokes {
            let ends = &mut s.edges[e as usize];
            ends[usize::from(ends[0] != c.kept)] = c.removed;
        }
        c.node.put(s, c.removed);
        if !s.planar.is_empty() {
            s.planar[c.removed as usize] = c.planar[0];
            s.planar[c.kept as usize] = c.planar[1];
        }
        if let Some(loops) = &c.loops {
            loops.restore(s);
        }
        if let Some(before) = &c.attributes {
            before.restore(s);
        }
        if let Some(stars) = stars {
            for &[e, far] in &c.spokes {
                stars.exchange(far, (e, c.kept), (e, c.removed));
            }
            let mut own: Vec<u32> = c.spokes.iter().map(|s| s[0]).collect();
            around.retain(|e| !own.contains(e));
            around.push(c.edge.0);
            own.push(c.edge.0);
            for g in c.faces.iter().flatten() {
                stars.gain(g.tip, g.side, c.removed);
                own.push(g.side);
            }
            let joint = |&e: &u32| s.edge_chain(EdgeId(e)).is_some_and(|c| s.chain(c).joint.is_some());
            stars.recount(s, c.removed, &own, own.iter().any(joint));
            let held = stars.is_held(c.kept);
            stars.recount(s, c.kept, &around, held);
        }
    }
}

/// An edge that stays at the kept node: the side of a face that goes, else an edge of the removed node, else any.
pub(super) fn host(
    faces: &[Option<Gone>; 2],
    spokes: &[[u32; 2]],
    s: &Surface,
    kept: u32,
    removed: u32,
    edge: u32,
) -> EndOf {
    if s.attribute_nodes.is_empty() {
        return EndOf { edge, node: kept };
    }
    let side = faces.iter().flatten().map(|g| EndOf { edge: g.into, node: kept }).next();
    let spoke = || spokes.first().map(|&[edge, _]| EndOf { edge, node: removed });
    let other = || {
        let at_kept = s.edges.iter().zip(0..).find(|(ends, e)| *e != edge && ends.contains(&kept));
        at_kept.map(|(_, edge)| EndOf { edge, node: kept })
    };
    side.or_else(spoke).or_else(other).unwrap_or(EndOf { edge, node: kept })
}

/// Whether the loops have to be found anew: an edge that starts one goes, or another one comes before it.
pub(super) fn unsettles(s: &Surface, edge: EdgeId, faces: &[Option<Gone>; 2]) -> bool {
    let of = |e: EdgeId| s.edge_chain(e).and_then(|c| s.chain(c).on_loop);
    let gone = std::iter::once((edge, NONE))
        .chain(faces.iter().flatten().map(|g| (EdgeId(g.side), g.into)))
        .filter_map(|(e, into)| Some((e, into, of(e)?)));
    for (e, into, l) in gone {
        // Only loops of one chain are looked at: cuts at joints may begin elsewhere too.
        if lowest_of_whole(s, l).is_none_or(|lowest| e == lowest || into < lowest.0) {
            return true;
        }
    }
    false
}

/// Chains follow: they lose the edge, go over sides at the kept node, and start there.
fn draw_chains(s: &mut Surface, c: &Collapse) {
    let on = |s: &Surface, e: u32| s.edge_chain(EdgeId(e));
    for e in c.spokes.iter().map(|s| s[0]).chain([c.edge.0]).chain(c.faces.iter().flatten().map(|g| g.side)) {
        if let Some(chain) = on(s, e) {
            let start = &mut s.chains[chain.index()].start;
            if start.0 == c.removed {
                *start = NodeId(c.kept);
            }
        }
    }
    for g in c.faces.iter().flatten() {
        let Some(chain) = on(s, g.side) else { continue };
        let outward = g.side_ends[0] == c.removed;
        let into_outward = s.edges[g.into as usize][0] == c.kept;
        s.edge_chain[g.into as usize] = s.edge_chain[g.side as usize];
        for d in s.chains[chain.index()].edges.iter_mut().filter(|d| d.edge().0 == g.side) {
            *d = DirectedEdge::new(EdgeId(g.into), d.is_reversed() != (outward != into_outward));
        }
    }
    if let Some(chain) = on(s, c.edge.0) {
        let edges = &mut s.chains[chain.index()].edges;
        if let Some(k) = edges.iter().position(|d| d.edge() == c.edge) {
            edges.remove(k);
        }
    }
}

/// The side of a face that an edge is.
fn place(s: &Surface, face: u32, edge: u32) -> usize {
    let [x, y, _] = s.face_edges[face as usize];
    if x == edge { 0 } else { 1 + usize::from(y != edge) }
}
