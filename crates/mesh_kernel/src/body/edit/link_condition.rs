//! The link condition: whether an edge may be collapsed without changing the shape of anything.
//!
//! After Dey, Edelsbrunner, Guha & Nekhayev, *Topology preserving edge contraction* (1999), for complexes of nodes,
//! edges and triangles. Every node and edge has an *order*, how far its neighbourhood is from the inside of a sheet:
//!
//! - an edge is of order 0 where two faces meet, else of order 1 (boundary, wire, branching);
//! - a node is of order 0 inside a sheet, of order 1 on a line of such edges along which nothing changes, else of order 2
//!   (ends, corners, branchings, places where sheets touch).
//!
//! The edge ab may go if and only if, (i) in the complex with a cone over all that is of order 1 or more, the links of a
//! and b share the link of ab and nothing else, and (ii) the same one order up: in the graph of edges of order 1 with a
//! cone over the nodes of order 2, the links of a and b share nothing.
//!
//! The neighbourhood is that of the *welded* body, sheets of all joints together, and every edge on a joint counts as order
//! 1 also where just two sheets meet: what a joint runs along stays what it is, and so does every single patch.

use std::collections::BTreeMap;

use super::Editor;
use super::stars::{LAST, Stars, corner};
use crate::body::{EdgeId, FaceId, JointId, NONE, NodeId, Surface, SurfaceId};

/// A node, edge or face of a surface; of those that joints make one, the first stands for all.
pub(super) type Place = (SurfaceId, u32);

/// Why collapsing would change the shape.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Obstacle {
    /// A third node is joined to both ends, without a face in between.
    #[error("both its ends are joined to node {node} of surface {surface} with no face in between")]
    ShortCycle {
        /// Surface.
        surface: SurfaceId,
        /// The third node.
        node: NodeId,
    },
    /// Two faces would fall into one.
    #[error("faces {} of surface {} and {} of surface {} would become one", faces[0].1, faces[0].0, faces[1].1, faces[1].0)]
    FacesMeet {
        /// The two faces.
        faces: [(SurfaceId, FaceId); 2],
    },
    /// Both other sides of a face at the edge end a sheet or lie on joints.
    #[error(
        "the face at it with node {node} of surface {surface} has all its other sides on the boundary or on joints"
    )]
    LastFace {
        /// Surface.
        surface: SurfaceId,
        /// The face's third node.
        node: NodeId,
    },
    /// Both ends lie on the boundary or on joints, the edge itself inside.
    #[error("it runs inside from boundary or joint to boundary or joint, which would touch")]
    Pinch,
    /// Boundary, joints or wires end or branch at both ends.
    #[error("boundaries, joints or wires end or branch at both its ends")]
    Branchings,
}

/// An edge at a welded node.
#[derive(Clone, Copy, Debug)]
struct Spoke {
    far: Place,
    faces: u32,
    joint: Option<JointId>,
}

impl Spoke {
    /// Whether the edge is of order 1.
    fn special(&self) -> bool {
        self.faces != 2 || self.joint.is_some()
    }
}

/// A corner of a face at a welded node: the two edges of the face there.
#[derive(Clone, Copy, Debug)]
struct Wedge {
    spokes: [Place; 2],
    face: Place,
}

/// The star of a welded node.
#[derive(Clone, Debug, Default)]
pub(super) struct WeldedStar {
    /// The nodes that joints make one, in order.
    pub(super) class: Vec<Place>,
    /// Joints without edges hold it.
    pub(super) pinned: bool,
    spokes: BTreeMap<Place, Spoke>,
    wedges: Vec<Wedge>,
}

impl WeldedStar {
    /// 0, 1 or 2.
    fn order(&self) -> u8 {
        if self.pinned {
            return 2;
        }
        let special: Vec<Place> = self.spokes.iter().filter(|(_, s)| s.special()).map(|(k, _)| *k).collect();
        let beyond = |w: &Wedge, from: Place| if w.spokes[0] == from { w.spokes[1] } else { w.spokes[0] };
        // From a spoke over a wedge to the next special spoke, or back to `start`; and the spokes in between.
        let walk = |start: Place, first: usize| {
            let (mut at, mut over, mut between) = (start, first, 0);
            loop {
                at = beyond(&self.wedges[over], at);
                if at == start || self.spokes[&at].special() || between > self.spokes.len() {
                    return (at, between);
                }
                between += 1;
                let next = (0..self.wedges.len()).find(|&k| k != over && self.wedges[k].spokes.contains(&at));
                let Some(next) = next else { return (at, between) };
                over = next;
            }
        };
        match special[..] {
            [] => {
                let (Some((&start, _)), false) = (self.spokes.first_key_value(), self.wedges.is_empty())
                else {
                    return 2;
                };
                let Some(first) = self.wedges.iter().position(|w| w.spokes.contains(&start)) else {
                    return 2;
                };
                let (end, between) = walk(start, first);
                if end == start && between + 1 == self.spokes.len() { 0 } else { 2 }
            }
            [p, q] => {
                let (sp, sq) = (self.spokes[&p], self.spokes[&q]);
                if sp.joint != sq.joint || sp.faces != sq.faces {
                    return 2;
                }
                let mut visited = 2;
                for first in (0..self.wedges.len()).filter(|&k| self.wedges[k].spokes.contains(&p)) {
                    let (end, between) = walk(p, first);
                    if end != q {
                        return 2;
                    }
                    visited += between;
                }
                if visited == self.spokes.len() { 1 } else { 2 }
            }
            _ => 2,
        }
    }

    fn to(&self, far: Place) -> impl Iterator<Item = (&Place, &Spoke)> {
        self.spokes.iter().filter(move |(_, s)| s.far == far)
    }

    /// The face between two spokes, if there is just one.
    fn face(&self, p: Place, q: Place) -> Option<Place> {
        let mut faces = self.wedges.iter().filter(|w| w.spokes == [p, q] || w.spokes == [q, p]);
        let (found, more) = (faces.next(), faces.next());
        if more.is_some() { None } else { found.map(|w| w.face) }
    }

    /// The far nodes of a wedge, in order.
    fn far(&self, w: &Wedge) -> [Place; 2] {
        let mut far = w.spokes.map(|k| self.spokes[&k].far);
        far.sort_unstable();
        far
    }
}

/// The condition for welded nodes `a` and `b` with the edge `ab`.
pub(super) fn obstacle(a: &WeldedStar, b: &WeldedStar, ab: Place) -> Option<Obstacle> {
    let third = |(surface, node): Place| Obstacle::ShortCycle { surface, node: NodeId(node) };
    let (at_a, at_b) = (a.class[0], b.class[0]);
    if a.class.iter().any(|x| b.class.contains(x)) || a.to(at_b).count() != 1 {
        return Some(third(at_b));
    }
    for (k, s) in a.spokes.iter().filter(|(k, _)| **k != ab) {
        let c = s.far;
        let mut of_b = b.to(c);
        let Some((l, t)) = of_b.next() else { continue };
        let between = a.face(ab, *k);
        if of_b.next().is_some() || a.to(c).count() != 1 || between.is_none() || between != b.face(ab, *l) {
            return Some(third(c));
        }
        if s.special() && t.special() {
            return Some(Obstacle::LastFace { surface: c.0, node: NodeId(c.1) });
        }
    }
    let mut opposite: BTreeMap<[Place; 2], Place> = BTreeMap::new();
    for w in a.wedges.iter().filter(|w| !w.spokes.contains(&ab)) {
        opposite.insert(a.far(w), w.face);
    }
    for w in b.wedges.iter().filter(|w| !w.spokes.contains(&ab)) {
        if let Some(face) = opposite.get(&b.far(w)) {
            return Some(Obstacle::FacesMeet { faces: [*face, w.face].map(|(s, f)| (s, FaceId(f))) });
        }
    }
    debug_assert!(a.spokes.contains_key(&ab) && b.spokes.contains_key(&ab) && b.to(at_a).count() == 1);
    let orders = [a.order(), b.order()];
    if !a.spokes.get(&ab).is_some_and(Spoke::special) {
        return (orders[0] > 0 && orders[1] > 0).then_some(Obstacle::Pinch);
    }
    (orders == [2, 2]).then_some(Obstacle::Branchings)
}

/// What the condition gathers of one body.
pub(super) struct Neighbourhood<'a> {
    editor: &'a mut Editor,
    /// The first node of the class of every node asked.
    first: BTreeMap<Place, Place>,
}

impl<'a> Neighbourhood<'a> {
    pub(super) fn new(editor: &'a mut Editor) -> Self {
        Self { editor, first: BTreeMap::new() }
    }

    /// The nodes that joints make one with `at`, in order, and whether a joint without edges is among these. O(edges
    /// there · length of their joints + chains of their surfaces).
    fn class(&mut self, at: Place) -> (Vec<Place>, bool) {
        let (mut class, mut pinned) = (vec![at], false);
        let mut edges = Vec::new();
        let mut i = 0;
        while i < class.len() {
            let (surface, v) = class[i];
            i += 1;
            if !self.editor.stars_of(surface).1.is_held(v) {
                continue;
            }
            let (s, stars) = self.editor.stars_of(surface);
            stars.edges_at(s, v, &mut edges);
            let mut add = |place: Place| {
                if !class.contains(&place) {
                    class.push(place);
                }
            };
            let body = self.editor.body();
            let s = body.surface(surface);
            for &e in &edges {
                let edge = EdgeId(e);
                if s.edge_chain(edge).is_none_or(|c| s.chain(c).joint.is_none()) {
                    continue;
                }
                let at_start = (s.edges[e as usize][0] == v) != self.editor.joint_reversed(surface, edge);
                for (t, d) in body.partners(surface, edge) {
                    add((t, body.surface(t).ends(d)[usize::from(!at_start)].0));
                }
            }
            for chain in s.chains.iter().filter(|c| c.start.0 == v && c.edges.is_empty()) {
                let Some(joint) = chain.joint else { continue };
                pinned = true;
                for u in body.joint(joint).uses() {
                    add((u.surface, body.surface(u.surface).chain(u.chain).start.0));
                }
            }
        }
        class.sort_unstable();
        (class, pinned)
    }

    /// Whether an edge of any surface joins two nodes.
    pub(super) fn joined(&mut self, a: Place, b: Place) -> bool {
        let [(from, _), (to, _)] = [a, b].map(|x| self.class(x));
        let mut edges = Vec::new();
        from.iter().any(|&(surface, v)| {
            let (s, stars) = self.editor.stars_of(surface);
            stars.edges_at(s, v, &mut edges);
            edges
                .iter()
                .any(|&e| to.contains(&(surface, s.edges[e as usize][0] ^ s.edges[e as usize][1] ^ v)))
        })
    }

    /// The first of the nodes that joints make one with `at`.
    fn first(&mut self, at: Place) -> Place {
        if !self.editor.stars_of(at.0).1.is_held(at.1) {
            return at;
        }
        if let Some(&first) = self.first.get(&at) {
            return first;
        }
        let (class, _) = self.class(at);
        for &other in &class {
            self.first.insert(other, class[0]);
        }
        class[0]
    }

    /// The first of the edges that a joint makes one with an edge.
    pub(super) fn edge(&self, surface: SurfaceId, e: u32) -> Place {
        let partners = self.editor.body().partners(surface, EdgeId(e));
        partners.into_iter().map(|(t, d)| (t, d.edge().0)).fold((surface, e), Place::min)
    }

    /// The star of a welded node.
    pub(super) fn star(&mut self, at: Place) -> WeldedStar {
        let (class, pinned) = self.class(at);
        let mut star = WeldedStar { class, pinned, ..WeldedStar::default() };
        let mut edges = Vec::new();
        for &(surface, v) in &star.class {
            let (s, stars) = self.editor.stars_of(surface);
            stars.edges_at(s, v, &mut edges);
            for &e in &edges {
                let key = self.edge(surface, e);
                let s = self.editor.body().surface(surface);
                let [p, q] = s.edges[e as usize];
                let faces = s.edge_faces[e as usize];
                let joint = s.edge_chain(EdgeId(e)).and_then(|c| s.chain(c).joint);
                // The face that runs over the edge away from the node: its other edge there is the one before.
                let face = faces[usize::from(p != v)];
                if face != NONE {
                    let before = s.face_edges[face as usize][LAST[corner(s, face, v)]];
                    let other = self.edge(surface, before);
                    star.wedges.push(Wedge { spokes: [key, other], face: (surface, face) });
                }
                let count = faces.iter().filter(|f| **f != NONE).count() as u32;
                let far = self.first((surface, p ^ q ^ v));
                star.spokes.entry(key).or_insert(Spoke { far, faces: 0, joint }).faces += count;
            }
        }
        star
    }
}

impl Editor {
    /// A surface with its stars.
    pub(super) fn stars_of(&mut self, surface: SurfaceId) -> (&Surface, &mut Stars) {
        let s = &self.body.surfaces[surface.index()];
        (s, self.stars[surface.index()].get_or_insert_with(|| Stars::new(s)))
    }
}
