//! Changes to one surface, written down so that they can be taken back and made again.
//!
//! An operator that is not hot writes through a [`Recorder`]. What it leaves is a [`Delta`]: for every change the value
//! that is *not* in the surface now. [`Delta::exchange`] swaps these values with what is there, in mirror order, so that
//! one function is both undo and redo, and both give the surface back bit for bit.

use glam::{DVec2, DVec3};

use crate::body::attribute::{AttributeEdge, AttributeNode};
use crate::body::chain::{Chain, Loop};
use crate::body::slots::Slots;
use crate::body::surface::{NO_CHAIN, chain_slot};
use crate::body::{Body, ChainId, NONE, Surface, SurfaceId};

/// What a surface stores of a node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct NodeValue {
    pub(super) position: DVec3,
    /// Used where the surface has backup positions.
    pub(super) backup: DVec3,
    /// Used where the surface is flattened.
    pub(super) planar: DVec2,
}

/// What a surface stores of an edge, its chain apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct EdgeValue {
    ends: [u32; 2],
    faces: [u32; 2],
}

/// What a surface stores of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct FaceValue {
    corners: [u32; 3],
    sides: [u32; 3],
}

const NO_EDGE: EdgeValue = EdgeValue { ends: [NONE; 2], faces: [NONE; 2] };
const NO_FACE: FaceValue = FaceValue { corners: [NONE; 3], sides: [NONE; 3] };

/// How a number is to be made taken or free.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Slot<T> {
    /// At the end of the array.
    Push(T),
    /// The one freed last.
    Take(T),
    /// The last of the array goes.
    Pop,
    /// This one becomes free.
    Release(u32),
}

#[derive(Clone, Debug, PartialEq)]
enum Change {
    Node(Slot<NodeValue>),
    Edge(Slot<EdgeValue>),
    Face(Slot<FaceValue>),
    SetNode(u32, NodeValue),
    SetEdge(u32, EdgeValue),
    SetFace(u32, FaceValue),
    /// Chains and loops, with the free numbers of chains.
    Boundary(Box<(Vec<Chain>, Vec<Loop>, Slots)>),
    Attributes(Box<(Vec<AttributeNode>, Vec<AttributeEdge>)>),
    Backup(Vec<DVec3>),
    Planar(Vec<DVec2>),
    Name(String),
}

impl Change {
    /// Makes the change; gives the one that takes it back.
    fn make(self, s: &mut Surface) -> Self {
        match self {
            Self::Node(slot) => Self::Node(node_slot(s, slot)),
            Self::Edge(slot) => Self::Edge(edge_slot(s, slot)),
            Self::Face(slot) => Self::Face(face_slot(s, slot)),
            Self::SetNode(v, value) => Self::SetNode(v, put_node(s, v, value)),
            Self::SetEdge(e, value) => Self::SetEdge(e, put_edge(s, e, value)),
            Self::SetFace(f, value) => Self::SetFace(f, put_face(s, f, value)),
            Self::Boundary(mut stored) => {
                mark_chains(s, false);
                std::mem::swap(&mut s.chains, &mut stored.0);
                std::mem::swap(&mut s.loops, &mut stored.1);
                std::mem::swap(&mut s.slots.chains, &mut stored.2);
                mark_chains(s, true);
                Self::Boundary(stored)
            }
            Self::Attributes(mut stored) => {
                std::mem::swap(&mut s.attribute_nodes, &mut stored.0);
                std::mem::swap(&mut s.attribute_edges, &mut stored.1);
                Self::Attributes(stored)
            }
            Self::Backup(backup) => Self::Backup(std::mem::replace(&mut s.backup, backup)),
            Self::Planar(planar) => Self::Planar(std::mem::replace(&mut s.planar, planar)),
            Self::Name(name) => Self::Name(std::mem::replace(&mut s.name, name)),
        }
    }
}

/// Writes the chains into the edges that they hold, or takes them out there. Edges that are gone are passed over: a
/// boundary is recorded together with the edges' coming and going, in any order.
fn mark_chains(s: &mut Surface, on: bool) {
    for (c, chain) in s.chains.iter().enumerate() {
        for d in &chain.edges {
            if let Some(slot) = s.edge_chain.get_mut(d.edge().index()) {
                *slot = if on { chain_slot(ChainId(c as u32)) } else { NO_CHAIN };
            }
        }
    }
}

fn put_node(s: &mut Surface, v: u32, value: NodeValue) -> NodeValue {
    let v = v as usize;
    let position = std::mem::replace(&mut s.positions[v], value.position);
    let backup = s.backup.get_mut(v).map(|p| std::mem::replace(p, value.backup)).unwrap_or_default();
    let planar = s.planar.get_mut(v).map(|p| std::mem::replace(p, value.planar)).unwrap_or_default();
    NodeValue { position, backup, planar }
}

fn put_edge(s: &mut Surface, e: u32, value: EdgeValue) -> EdgeValue {
    let e = e as usize;
    EdgeValue {
        ends: std::mem::replace(&mut s.edges[e], value.ends),
        faces: std::mem::replace(&mut s.edge_faces[e], value.faces),
    }
}

fn put_face(s: &mut Surface, f: u32, value: FaceValue) -> FaceValue {
    let f = f as usize;
    FaceValue {
        corners: std::mem::replace(&mut s.faces[f], value.corners),
        sides: std::mem::replace(&mut s.face_edges[f], value.sides),
    }
}

/// The number that [`Slot::Take`] is given. It is only recorded where a number was free.
fn take(slots: &mut Slots) -> u32 {
    slots.take().unwrap_or(NONE)
}

fn node_slot(s: &mut Surface, slot: Slot<NodeValue>) -> Slot<NodeValue> {
    match slot {
        Slot::Push(value) => {
            // Layers that the surface has grow along.
            if !s.backup.is_empty() {
                s.backup.push(value.backup);
            }
            if !s.planar.is_empty() {
                s.planar.push(value.planar);
            }
            s.positions.push(value.position);
            Slot::Pop
        }
        Slot::Pop => {
            let last = s.positions.len() as u32 - 1;
            let value = put_node(s, last, NodeValue::default());
            s.positions.pop();
            s.backup.pop();
            s.planar.pop();
            Slot::Push(value)
        }
        Slot::Take(value) => {
            let v = take(&mut s.slots.nodes);
            put_node(s, v, value);
            Slot::Release(v)
        }
        Slot::Release(v) => {
            let value = put_node(s, v, NodeValue::default());
            s.slots.nodes.release(v);
            Slot::Take(value)
        }
    }
}

fn edge_slot(s: &mut Surface, slot: Slot<EdgeValue>) -> Slot<EdgeValue> {
    match slot {
        Slot::Push(value) => {
            s.edges.push(value.ends);
            s.edge_faces.push(value.faces);
            s.edge_chain.push(NO_CHAIN);
            Slot::Pop
        }
        Slot::Pop => {
            let last = s.edges.len() as u32 - 1;
            let value = put_edge(s, last, NO_EDGE);
            s.edges.pop();
            s.edge_faces.pop();
            s.edge_chain.pop();
            Slot::Push(value)
        }
        Slot::Take(value) => {
            let e = take(&mut s.slots.edges);
            put_edge(s, e, value);
            Slot::Release(e)
        }
        Slot::Release(e) => {
            let value = put_edge(s, e, NO_EDGE);
            s.slots.edges.release(e);
            Slot::Take(value)
        }
    }
}

fn face_slot(s: &mut Surface, slot: Slot<FaceValue>) -> Slot<FaceValue> {
    match slot {
        Slot::Push(value) => {
            s.faces.push(value.corners);
            s.face_edges.push(value.sides);
            Slot::Pop
        }
        Slot::Pop => {
            let last = s.faces.len() as u32 - 1;
            let value = put_face(s, last, NO_FACE);
            s.faces.pop();
            s.face_edges.pop();
            Slot::Push(value)
        }
        Slot::Take(value) => {
            let f = take(&mut s.slots.faces);
            put_face(s, f, value);
            Slot::Release(f)
        }
        Slot::Release(f) => {
            let value = put_face(s, f, NO_FACE);
            s.slots.faces.release(f);
            Slot::Take(value)
        }
    }
}

/// What an operator did to a surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Delta {
    pub(super) surface: SurfaceId,
    changes: Vec<Change>,
}

impl Delta {
    /// Takes the changes back, or makes them again. O(changes).
    pub(super) fn exchange(&mut self, body: &mut Body) {
        let s = &mut body.surfaces[self.surface.index()];
        // The last change is taken back first; what takes it back stands first then.
        let changes = std::mem::take(&mut self.changes);
        self.changes = changes.into_iter().rev().map(|change| change.make(s)).collect();
    }
}

/// A surface under an operator. Every change goes through here; the operator sees the surface as it is by now.
#[derive(Debug)]
pub(super) struct Recorder<'a> {
    id: SurfaceId,
    surface: &'a mut Surface,
    /// What takes the changes back, in the order in which they were made.
    back: Vec<Change>,
}

impl<'a> Recorder<'a> {
    pub(super) fn new(body: &'a mut Body, id: SurfaceId) -> Self {
        Self { id, surface: &mut body.surfaces[id.index()], back: Vec::new() }
    }

    /// The surface as it is by now.
    pub(super) fn surface(&self) -> &Surface {
        self.surface
    }

    /// What was done.
    pub(super) fn finish(self) -> Delta {
        Delta { surface: self.id, changes: self.back }
    }

    fn make(&mut self, change: Change) {
        let back = change.make(self.surface);
        self.back.push(back);
    }

    /// A new node; its number is the one freed last, or a new one.
    pub(super) fn add_node(&mut self, value: NodeValue) -> u32 {
        let v = self.surface.slots.nodes.next(self.surface.positions.len());
        let free = !self.surface.slots.nodes.is_compact();
        self.make(Change::Node(if free { Slot::Take(value) } else { Slot::Push(value) }));
        v
    }

    /// A new edge without faces.
    pub(super) fn add_edge(&mut self, ends: [u32; 2]) -> u32 {
        let e = self.surface.slots.edges.next(self.surface.edges.len());
        let value = EdgeValue { ends, faces: [NONE; 2] };
        let free = !self.surface.slots.edges.is_compact();
        self.make(Change::Edge(if free { Slot::Take(value) } else { Slot::Push(value) }));
        e
    }

    /// A new face; the edges get to know of it.
    pub(super) fn add_face(&mut self, corners: [u32; 3], sides: [u32; 3]) -> u32 {
        let f = self.surface.slots.faces.next(self.surface.faces.len());
        let value = FaceValue { corners, sides };
        let free = !self.surface.slots.faces.is_compact();
        self.make(Change::Face(if free { Slot::Take(value) } else { Slot::Push(value) }));
        self.hang(f, corners, sides);
        f
    }

    /// Frees a node that nothing names any more.
    pub(super) fn remove_node(&mut self, v: u32) {
        self.make(Change::Node(Slot::Release(v)));
    }

    /// Frees an edge that no face and no chain names any more.
    pub(super) fn remove_edge(&mut self, e: u32) {
        self.make(Change::Edge(Slot::Release(e)));
    }

    /// Frees a face; its edges forget it.
    pub(super) fn remove_face(&mut self, f: u32) {
        self.unhang(f);
        self.make(Change::Face(Slot::Release(f)));
    }

    /// Gives a node another place.
    pub(super) fn set_node(&mut self, v: u32, value: NodeValue) {
        self.make(Change::SetNode(v, value));
    }

    /// Gives an edge other ends. Faces at it are the caller's care.
    pub(super) fn set_ends(&mut self, e: u32, ends: [u32; 2]) {
        let faces = self.surface.edge_faces[e as usize];
        self.make(Change::SetEdge(e, EdgeValue { ends, faces }));
    }

    /// Gives a face other corners and sides; the edges follow.
    pub(super) fn set_face(&mut self, f: u32, corners: [u32; 3], sides: [u32; 3]) {
        self.unhang(f);
        self.make(Change::SetFace(f, FaceValue { corners, sides }));
        self.hang(f, corners, sides);
    }

    /// The edges get to know of a face.
    fn hang(&mut self, f: u32, corners: [u32; 3], sides: [u32; 3]) {
        for (corner, e) in corners.into_iter().zip(sides) {
            let ends = self.surface.edges[e as usize];
            let mut faces = self.surface.edge_faces[e as usize];
            faces[usize::from(ends[0] != corner)] = f;
            self.make(Change::SetEdge(e, EdgeValue { ends, faces }));
        }
    }

    /// The edges forget a face.
    fn unhang(&mut self, f: u32) {
        for e in self.surface.face_edges[f as usize] {
            let ends = self.surface.edges[e as usize];
            let faces = self.surface.edge_faces[e as usize].map(|x| if x == f { NONE } else { x });
            self.make(Change::SetEdge(e, EdgeValue { ends, faces }));
        }
    }

    /// Runs `change` on chains and loops. It must keep every edge's chain right, as [`Surface::find_loops`] does.
    pub(super) fn change_boundary(&mut self, change: impl FnOnce(&mut Surface)) {
        let before =
            (self.surface.chains.clone(), self.surface.loops.clone(), self.surface.slots.chains.clone());
        change(self.surface);
        self.back.push(Change::Boundary(Box::new(before)));
    }

    /// Finds the boundary loops anew, cut at the chains of joints. O(edges).
    pub(super) fn rebuild_loops(&mut self) {
        self.change_boundary(|s| {
            s.drop_loops();
            s.find_loops();
        });
    }

    /// Runs `change` on the attributes.
    pub(super) fn change_attributes(&mut self, change: impl FnOnce(&mut Surface)) {
        let before = (self.surface.attribute_nodes.clone(), self.surface.attribute_edges.clone());
        change(self.surface);
        self.back.push(Change::Attributes(Box::new(before)));
    }

    /// Other backup positions, empty for none.
    pub(super) fn set_backup(&mut self, backup: Vec<DVec3>) {
        self.make(Change::Backup(backup));
    }

    /// Another flattened pattern, empty for none.
    pub(super) fn set_planar(&mut self, planar: Vec<DVec2>) {
        self.make(Change::Planar(planar));
    }

    /// Another name.
    pub(super) fn set_name(&mut self, name: &str) {
        self.make(Change::Name(name.into()));
    }
}
