//! Edge collapse: one end of an edge drawn into the other, with the edge and its faces; on a joint all partners alike.
//!
//! ```text
//!      \  c  /            \  c  /
//!       \/ \/              \ | /
//!     --a---b--    →     ----b----
//!       /\ /\              / | \
//!      /  d  \            /  d  \
//! ```
//!
//! In K3 terms, for each of its faces kill_face_make_chole and kill_edge_chole (f − 1, e − 1), then the inverse of
//! split_edge (v − 1, e − 1). Paper: Wang et al., fig. 5a and table 3.

mod carry_out;
mod error;

use glam::DVec3;

pub(super) use carry_out::Collapse;
use carry_out::{Gone, Layers, host, unsettles};
pub use error::CollapseError;

use super::Editor;
use super::carry_attributes::lines_hold;
use super::journal::{Attributes, Record};
use super::link_condition::{Neighbourhood, Obstacle, Place, obstacle};
use super::loops::Loops;
use super::split_edge::between;
use super::stars::{Ring, Stars, corner};
use super::swap_edge::Guard;
use crate::body::radial::collinear;
use crate::body::{Body, EdgeId, FaceId, JointId, NONE, NodeId, Surface, SurfaceId};

/// How an edge is to be collapsed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CollapseOptions {
    /// Where along the edge the kept node goes, 0 at the edge's first node, 1 at its second; it stays where `None`. All
    /// nodes that joints hold together with it move along.
    pub at: Option<f64>,
    /// Whether faces may be turned over or flattened.
    pub guard: Guard,
}

/// What was collapsed in one surface. All but what was kept are free numbers now.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CollapsedEdge {
    /// Surface.
    pub surface: SurfaceId,
    /// The edge.
    pub edge: EdgeId,
    /// The node that stayed.
    pub kept: NodeId,
    /// The node that went.
    pub removed: NodeId,
    /// Faces that went, left and right of the edge.
    pub faces: [Option<FaceId>; 2],
    /// Of each face the side that went, and the one that stands for both now.
    pub sides: [Option<[EdgeId; 2]>; 2],
}

/// What collapsed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EdgeCollapse {
    /// The edge.
    pub edge: CollapsedEdge,
    /// Its partners on the joint, in order of surfaces and edges.
    pub partners: Vec<CollapsedEdge>,
}

impl Editor {
    /// Collapses an edge into its end `keep`, on a joint together with all its partners. The other end goes, and the edge, and
    /// its faces, and of each face the side at the removed node; the side at the kept node takes over that one's outer face
    /// and its place on a chain. Numbers become free in this order: faces (left, right), the edge, the sides (left, right),
    /// the node; with partners the edge itself first, then these in order of surfaces and edges.
    ///
    /// The shape of the body and of every single patch stays (see [`Obstacle`]): components, cycles and voids are the same
    /// after it, joints and boundaries run as before.
    ///
    /// # Errors
    /// See [`CollapseError`]; nothing is changed then. O(edges at both ends), on joints times their sheets and lengths.
    pub fn collapse_edge(
        &mut self,
        surface: SurfaceId,
        edge: EdgeId,
        keep: NodeId,
        options: &CollapseOptions,
    ) -> Result<EdgeCollapse, CollapseError> {
        let missing = CollapseError::NoEdge { surface, edge };
        let Some(s) = self.body.surfaces.get(surface.index()) else { return Err(missing) };
        if !s.is_edge(edge) {
            return Err(missing);
        }
        let ends = s.edges[edge.index()];
        if !ends.contains(&keep.0) {
            let ends = ends.map(NodeId);
            return Err(CollapseError::NotAnEnd { surface, edge, ends, node: keep });
        }
        let removed = ends[0] ^ ends[1] ^ keep.0;
        if let Some(at) = options.at
            && !(0.0..=1.0).contains(&at)
        {
            return Err(CollapseError::Parameter(at));
        }
        let [p, q] = ends.map(|v| s.positions[v as usize]);
        let position = options.at.map_or(s.positions[keep.index()], |at| between(p, q, at));
        if !position.is_finite() {
            return Err(CollapseError::NotFinite { surface, edge, position });
        }
        let mut members = vec![Member { surface, edge, kept: keep.0, removed }];
        let mut moved = vec![(surface, keep.0)];
        let plain = self.plain(surface, edge, keep.0, removed);
        let ringed = plain.is_some();
        match plain {
            Some(None) => {}
            Some(Some(obstacle)) => return Err(self.shape(surface, edge, obstacle)),
            None => self.joined_members(&mut members, &mut moved)?,
        }
        if options.at.is_none() {
            moved.clear();
        }
        if options.guard == Guard::NoTurn {
            self.guard_turns(&members, &moved, position)?;
        }
        // How far from the kept node towards the removed one.
        let share = options.at.map_or(0.0, |at| if ends[0] == keep.0 { at } else { 1.0 - at });
        let bare = |m: &Member| self.body.surface(m.surface).attribute_nodes.is_empty();
        if let &[member] = &members[..]
            && bare(&member)
        {
            let edge = self.collapse_one(member, ringed, options.at, share, position, &moved);
            return Ok(EdgeCollapse { edge, partners: Vec::new() });
        }
        let undone = std::mem::take(&mut self.journal.undone);
        let done = self.transaction(|editor| {
            let edge = editor.collapse_one(members[0], false, options.at, share, position, &moved);
            let partners = members[1..]
                .iter()
                .map(|&m| editor.follow(|e| e.collapse_one(m, false, None, share, position, &[])))
                .collect();
            for m in &members {
                if !lines_hold(editor.body.surface(m.surface)) {
                    return Err(CollapseError::CarriesAttributes { surface: m.surface, edge: m.edge });
                }
            }
            Ok(EdgeCollapse { edge, partners })
        });
        if done.is_err() {
            self.journal.undone = undone;
        }
        done
    }

    fn shape(&self, surface: SurfaceId, edge: EdgeId, obstacle: Obstacle) -> CollapseError {
        let s = self.body.surface(surface);
        if matches!(obstacle, Obstacle::ShortCycle { .. })
            && let Some(l) = s.edge_chain(edge).and_then(|c| s.chain(c).on_loop)
        {
            let edges = s.loops[l.index()].chains.iter().map(|&c| s.chain(c).edges.len()).sum();
            if edges <= 3 {
                return CollapseError::LoopTooShort { surface, edge, edges };
            }
        }
        CollapseError::Shape { surface, edge, obstacle }
    }

    /// The condition where both ends are ordinary nodes on no joint, and no joint comes near both: `None` where that is not
    /// so. O(edges at both ends).
    fn plain(
        &mut self,
        surface: SurfaceId,
        edge: EdgeId,
        kept: u32,
        removed: u32,
    ) -> Option<Option<Obstacle>> {
        let (s, stars) = self.stars_of(surface);
        let faces = s.edge_faces[edge.index()];
        if faces == [NONE; 2] || stars.is_held(kept) || stars.is_held(removed) {
            return None;
        }
        let mut rings = stars.take_rings();
        let answer = stars
            .rings(s, edge.0, [removed, kept], &mut rings)
            .then(|| plain_obstacle(surface, s, stars, edge.0, removed, &rings))
            .flatten();
        stars.give_rings(rings);
        answer
    }

    /// The partners of an edge, and all nodes that joints make one with the kept one, if the condition holds.
    fn joined_members(
        &mut self,
        members: &mut Vec<Member>,
        moved: &mut Vec<Place>,
    ) -> Result<(), CollapseError> {
        let Member { surface, edge, kept, removed } = members[0];
        let s = self.body.surface(surface);
        let own = self.joint_reversed(surface, edge);
        let kept_first = (s.edges[edge.index()][0] == kept) != own;
        for (t, d) in self.body.partners(surface, edge) {
            let [p, q] = self.body.surface(t).ends(d).map(|v| v.0);
            let (kept, removed) = if kept_first { (p, q) } else { (q, p) };
            members.push(Member { surface: t, edge: d.edge(), kept, removed });
        }
        members[1..].sort_by_key(|m| (m.surface, m.edge));
        if let Some(joint) = s.edge_chain(edge).and_then(|c| s.chain(c).joint) {
            let edges = self.body.joint_len(joint);
            if edges <= if self.body.joint_is_closed(joint) { 3 } else { 1 } {
                return Err(CollapseError::JointTooShort { joint, edges });
            }
        }
        let mut around = Neighbourhood::new(self);
        let ab = around.edge(surface, edge.0);
        let stars = [around.star((surface, removed)), around.star((surface, kept))];
        let ends = |end: fn(&Member) -> Place| {
            let mut ends: Vec<Place> = members.iter().map(end).collect();
            ends.sort_unstable();
            ends
        };
        // A joint without edges may hold nodes that are one already: they must not go under it.
        let free = [
            !stars[0].pinned && stars[0].class == ends(|m| (m.surface, m.removed)),
            !stars[1].pinned && stars[1].class == ends(|m| (m.surface, m.kept)),
        ];
        if !free[0] {
            let on = s_joint(self.body(), surface, edge);
            if free[1] {
                let joints = self.joints_at(&stars[0].class, on);
                let (removed, kept) = (NodeId(removed), NodeId(kept));
                return Err(CollapseError::HeldByJoints { surface, removed, kept, joints });
            }
            let mut joints = self.joints_at(&stars[0].class, on);
            joints.extend(self.joints_at(&stars[1].class, on));
            joints.sort_unstable();
            joints.dedup();
            return Err(CollapseError::BothHeld { surface, edge, joints });
        }
        // Joints without edges: they hold exactly the nodes that would go.
        let joints = self.point_joints_at(&stars[0].class);
        if !joints.is_empty() {
            let (removed, kept) = (NodeId(removed), NodeId(kept));
            return Err(CollapseError::HeldByJoints { surface, removed, kept, joints });
        }
        if let Some(obstacle) = obstacle(&stars[0], &stars[1], ab) {
            return Err(self.shape(surface, edge, obstacle));
        }
        let [_, star] = stars;
        *moved = star.class;
        Ok(())
    }

    fn point_joints_at(&self, nodes: &[Place]) -> Vec<JointId> {
        let at = |&(surface, v): &Place| {
            let chains = &self.body.surface(surface).chains;
            chains.iter().filter(move |c| c.edges.is_empty() && c.start.0 == v).filter_map(|c| c.joint)
        };
        let mut joints: Vec<JointId> = nodes.iter().flat_map(at).collect();
        joints.sort_unstable();
        joints.dedup();
        joints
    }

    /// Joints at nodes, in order, other than the one that an edge lies on; that one where there is no other.
    fn joints_at(&mut self, nodes: &[Place], on: Option<JointId>) -> Vec<JointId> {
        let mut joints = Vec::new();
        let mut edges = Vec::new();
        for &(surface, v) in nodes {
            let (s, stars) = self.stars_of(surface);
            stars.edges_at(s, v, &mut edges);
            joints.extend(edges.iter().filter_map(|&e| s.chain(s.edge_chain(EdgeId(e))?).joint));
            joints.extend(
                s.chains.iter().filter(|c| c.edges.is_empty() && c.start.0 == v).filter_map(|c| c.joint),
            );
        }
        joints.sort_unstable();
        joints.dedup();
        if joints.len() > 1 {
            joints.retain(|&j| Some(j) != on);
        }
        joints
    }

    /// Whether a face that stays would turn over or become degenerate.
    fn guard_turns(&mut self, members: &[Member], moved: &[Place], to: DVec3) -> Result<(), CollapseError> {
        let Member { edge, .. } = members[0];
        let mut edges = Vec::new();
        let removed = members.iter().map(|m| (m.surface, m.removed));
        for (surface, v) in removed.chain(moved.iter().copied()) {
            let (s, stars) = self.stars_of(surface);
            stars.edges_at(s, v, &mut edges);
            for face in faces_at(s, &edges, v) {
                // Faces at one of the edges go.
                let gone = members
                    .iter()
                    .any(|m| m.surface == surface && s.edge_faces[m.edge.index()].contains(&face));
                if !gone && turned(s, face, corner(s, face, v), to) {
                    return Err(CollapseError::Turns { surface, edge, face: FaceId(face) });
                }
            }
        }
        Ok(())
    }

    /// Does one of the collapses. `ringed` where the rings kept with the stars are those of this edge.
    fn collapse_one(
        &mut self,
        m: Member,
        ringed: bool,
        at: Option<f64>,
        share: f64,
        position: DVec3,
        moved: &[Place],
    ) -> CollapsedEdge {
        let Member { surface, edge, kept, removed } = m;
        let (s, stars) = self.stars_of(surface);
        let mut rings = stars.take_rings();
        let ring = &mut rings[0];
        if !ringed {
            stars.edges_at(s, removed, &mut ring.edges);
            ring.edges.retain(|&e| e != edge.0);
            let far = |&e: &u32| s.edges[e as usize][0] ^ s.edges[e as usize][1] ^ removed;
            ring.nodes.clear();
            ring.nodes.extend(ring.edges.iter().map(far));
        }
        let s = self.body.surface(surface);
        let edge_faces = s.edge_faces[edge.index()];
        let faces = edge_faces.map(|f| (f != NONE).then(|| Gone::of(s, f, edge.0, removed)));
        let sides = faces.map(|g| g.map_or(NONE, |g| g.side));
        let mut spokes = Vec::with_capacity(ring.edges.len());
        spokes.extend(
            ring.edges.iter().zip(&ring.nodes).filter(|(e, _)| !sides.contains(e)).map(|(&e, &far)| [e, far]),
        );
        let mut fan = Vec::with_capacity(ring.edges.len());
        fan.extend(faces_at(s, &ring.edges, removed).filter(|f| !edge_faces.contains(f)));
        // Inside a surface, away from joints, no chain passes.
        let near_chain = !ringed || ring.open;
        let touched =
            near_chain && ring.edges.iter().chain([&edge.0]).any(|&e| s.edge_chain[e as usize] != 0);
        let unsettled = touched && unsettles(s, edge, &faces);
        let planar = |v: u32| s.planar.get(v as usize).copied().unwrap_or_default();
        let planar = [planar(removed), planar(kept), planar(kept) * (1.0 - share) + planar(removed) * share];
        let [from, node] = [Layers::of(s, kept), Layers::of(s, removed)];
        let to = Layers { position, backup: between(from.backup, node.backup, share) };
        let old = |&(t, v): &Place| ((t, v), Layers::of(self.body.surface(t), v));
        let host = host(&faces, &spokes, s, kept, removed, edge.0);
        let collapse = Collapse {
            surface,
            edge,
            at,
            kept,
            removed,
            ends: s.edges[edge.index()],
            edge_faces,
            faces,
            spokes,
            fan,
            node,
            planar,
            moved: moved.iter().map(old).collect(),
            to,
            loops: touched.then(|| Loops::of(s)),
            unsettled,
            attributes: (!s.attribute_nodes.is_empty()).then(|| Attributes::of(s)),
            host,
        };
        if let Some(stars) = &mut self.stars[surface.index()] {
            stars.give_rings(rings);
        }
        self.perform(Record::CollapseEdge(Box::new(collapse)));
        CollapsedEdge {
            surface,
            edge,
            kept: NodeId(kept),
            removed: NodeId(removed),
            faces: faces.map(|g| g.map(|g| FaceId(g.face))),
            sides: faces.map(|g| g.map(|g| [EdgeId(g.side), EdgeId(g.into)])),
        }
    }
}

/// One of the edges that collapse together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Member {
    surface: SurfaceId,
    edge: EdgeId,
    kept: u32,
    removed: u32,
}

fn s_joint(body: &Body, surface: SurfaceId, edge: EdgeId) -> Option<JointId> {
    let s = body.surface(surface);
    s.edge_chain(edge).and_then(|c| s.chain(c).joint)
}

/// Faces that have one of `edges` as the side that leaves `node`: all at it, each once, if these are all its edges.
fn faces_at<'a>(s: &'a Surface, edges: &'a [u32], node: u32) -> impl Iterator<Item = u32> + 'a {
    edges
        .iter()
        .map(move |&e| s.edge_faces[e as usize][usize::from(s.edges[e as usize][0] != node)])
        .filter(|f| *f != NONE)
}

/// A computed sine of an angle above this is certainly not zero.
const CLEAR_SINE: f64 = 1e-10;

/// Whether a face turns over or becomes degenerate when its corner `i` moves. A degenerate face cannot turn.
fn turned(s: &Surface, face: u32, i: usize, to: DVec3) -> bool {
    let mut p = s.corners(FaceId(face));
    let normal = |p: &[DVec3; 3]| (p[1] - p[0]).cross(p[2] - p[0]);
    let before = normal(&p);
    p[i] = to;
    let after = normal(&p);
    let scale = (p[1] - p[0]).length() * (p[2] - p[0]).length();
    let clear = after.length() > CLEAR_SINE * scale && scale > 0.0;
    before.dot(after) < 0.0
        || after == DVec3::ZERO
        || (before.dot(after) == 0.0 && before != DVec3::ZERO)
        || (!clear && collinear(p[0], p[1], p[2]))
}

/// The condition where both nodes are ordinary, given their rings. `None` where joints are near both.
fn plain_obstacle(
    surface: SurfaceId,
    s: &Surface,
    stars: &Stars,
    edge: u32,
    removed: u32,
    rings: &[Ring; 2],
) -> Option<Option<Obstacle>> {
    let [near, far] = [&rings[0].nodes, &rings[1].nodes];
    let opens = [rings[0].open, rings[1].open];
    let faces = s.edge_faces[edge as usize];
    let inside = !faces.contains(&NONE);
    if near.iter().any(|&v| stars.is_held(v)) && far.iter().any(|&v| stars.is_held(v)) {
        return None;
    }
    if inside && opens == [true; 2] {
        return Some(Some(Obstacle::Pinch));
    }
    let gone = faces.map(|f| (f != NONE).then(|| Gone::of(s, f, edge, removed)));
    for &v in near.iter().filter(|v| far.contains(v)) {
        if !gone.iter().flatten().any(|g| g.tip == v) {
            return Some(Some(Obstacle::ShortCycle { surface, node: NodeId(v) }));
        }
    }
    for g in gone.iter().flatten() {
        if g.outer == NONE && s.edge_faces[g.into as usize].contains(&NONE) {
            return Some(Some(Obstacle::LastFace { surface, node: NodeId(g.tip) }));
        }
    }
    if let [Some(l), Some(r)] = gone
        && opens == [false; 2]
        && near.len() == 2
        && far.len() == 2
    {
        let other = |g: &Gone| s.edge_faces[g.into as usize][1 - g.slot];
        let faces = [(surface, FaceId(l.outer)), (surface, FaceId(other(&r)))];
        return Some(Some(Obstacle::FacesMeet { faces }));
    }
    Some(None)
}
