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

use glam::{DVec2, DVec3};

use super::Editor;
use super::carry_attributes::{EndOf, GoneFace, carry_collapse, lines_hold};
use super::journal::{Attributes, Record};
use super::link_condition::{Neighbourhood, Obstacle, Place, obstacle};
use super::loops::{Loops, lowest_of_whole, rebuild};
use super::operation::Operation;
use super::split_edge::{between, release_edge, release_face, release_node};
use super::stars::{LAST, NEXT, Ring, Stars, corner};
use super::swap_edge::Guard;
use crate::body::radial::collinear;
use crate::body::{Body, DirectedEdge, EdgeId, FaceId, JointId, NONE, NodeId, Surface, SurfaceId};

/// How an edge is to be collapsed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CollapseOptions {
    /// Where along the edge the kept node goes, 0 at the edge's first node, 1 at its second; it stays where `None`. All
    /// nodes that joints hold together with it move along.
    pub at: Option<f64>,
    /// Whether faces may be turned over or flattened.
    pub guard: Guard,
}

/// Why an edge was not collapsed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CollapseError {
    /// No such edge.
    #[error("surface {surface} has no edge {edge}")]
    NoEdge {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
    },
    /// The node to keep is not on the edge.
    #[error("node {node} is no end of edge {edge} of surface {surface}; keep one of {}, {}", ends[0], ends[1])]
    NotAnEnd {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// Its ends.
        ends: [NodeId; 2],
        /// The node named.
        node: NodeId,
    },
    /// A parameter that is not on the edge.
    #[error("the kept node goes to a parameter from 0 to 1 of the edge, not to {0}")]
    Parameter(f64),
    /// The place where the kept node would go is no finite number.
    #[error("the kept node of edge {edge} of surface {surface} would go to {position}, which is not finite")]
    NotFinite {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// The place.
        position: DVec3,
    },
    /// Joints that do not run along the edge hold the node that would be removed.
    #[error(
        "node {removed} of surface {surface} is held by joints {joints:?}, which would lose it; keep it and remove node \
         {kept} instead"
    )]
    HeldByJoints {
        /// Surface.
        surface: SurfaceId,
        /// The node that would be removed.
        removed: NodeId,
        /// The other end.
        kept: NodeId,
        /// Joints at it.
        joints: Vec<JointId>,
    },
    /// The same at both ends.
    #[error(
        "both ends of edge {edge} of surface {surface} are held by joints {joints:?} that do not run along it; take one \
         end off its joints first"
    )]
    BothHeld {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// Joints at the ends.
        joints: Vec<JointId>,
    },
    /// The joint would have too few edges left.
    #[error(
        "joint {joint} has {edges} edges; an open joint keeps one at least, a closed one three. Split one of its edges \
         first, or remove the joint"
    )]
    JointTooShort {
        /// Joint.
        joint: JointId,
        /// Edges that it has.
        edges: usize,
    },
    /// The boundary loop would have too few edges left.
    #[error(
        "the boundary loop of surface {surface} at edge {edge} has {edges} edges and needs three; fill it or split one"
    )]
    LoopTooShort {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// Edges that it has.
        edges: usize,
    },
    /// The body's shape would change.
    #[error(
        "edge {edge} of surface {surface} cannot be collapsed without changing the shape: {obstacle}; split or swap edges near it first"
    )]
    Shape {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// What is in the way.
        obstacle: Obstacle,
    },
    /// A face would be turned over or degenerate.
    #[error("collapsing edge {edge} would turn face {face} of surface {surface} over or flatten it")]
    Turns {
        /// Surface of the face.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// Face.
        face: FaceId,
    },
    /// An attribute line would no longer lie on the surface.
    #[error(
        "edge {edge} of surface {surface} carries attributes that collapsing would tear; triangulate them into edges first"
    )]
    CarriesAttributes {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
    },
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

/// What is needed to collapse one edge, and to take it back.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Collapse {
    pub(super) surface: SurfaceId,
    pub(super) edge: EdgeId,
    /// As it was asked for.
    at: Option<f64>,
    kept: u32,
    removed: u32,
    ends: [u32; 2],
    edge_faces: [u32; 2],
    /// Left and right.
    faces: [Option<Gone>; 2],
    /// Edges of the removed node that stay, with their other ends.
    spokes: Vec<[u32; 2]>,
    /// Faces of the removed node that stay.
    fan: Vec<u32>,
    /// The removed node.
    node: Layers,
    /// Places on the pattern: of the removed node, of the kept one, and where that goes.
    planar: [DVec2; 3],
    /// Nodes that move, with their old places, and where they go.
    moved: Vec<(Place, Layers)>,
    to: Layers,
    /// Before, where a chain is touched.
    loops: Option<Loops>,
    /// Whether the loops are to be found anew.
    unsettled: bool,
    attributes: Option<Attributes>,
    /// An edge that stays, by the end that will be the kept node, for attributes of the edge that goes.
    host: EndOf,
}

impl Collapse {
    /// The operator that was asked for; its guard has been passed.
    pub(super) fn operation(&self) -> Operation {
        let (surface, edge, keep) = (self.surface, self.edge, NodeId(self.kept));
        Operation::CollapseEdge { surface, edge, keep, at: self.at, guard: Guard::None }
    }
}

/// Positions of a node in space.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Layers {
    position: DVec3,
    backup: DVec3,
}

impl Layers {
    fn of(s: &Surface, v: u32) -> Self {
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
struct Gone {
    face: u32,
    corners: [u32; 3],
    sides: [u32; 3],
    /// The side at the removed node, its ends and faces.
    side: u32,
    side_ends: [u32; 2],
    side_faces: [u32; 2],
    /// The side at the kept node, and which of its faces this is.
    into: u32,
    slot: usize,
    /// The face beyond the side at the removed node.
    outer: u32,
    tip: u32,
}

impl Gone {
    fn of(s: &Surface, face: u32, edge: u32, removed: u32) -> Self {
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

    pub(super) fn do_collapse(&mut self, c: &Collapse) {
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

    pub(super) fn undo_collapse(&mut self, c: &Collapse) {
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
fn host(
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

/// The side of a face that an edge is.
fn place(s: &Surface, face: u32, edge: u32) -> usize {
    let [x, y, _] = s.face_edges[face as usize];
    if x == edge { 0 } else { 1 + usize::from(y != edge) }
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

/// Whether the loops have to be found anew: an edge that starts one goes, or another one comes before it.
fn unsettles(s: &Surface, edge: EdgeId, faces: &[Option<Gone>; 2]) -> bool {
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
