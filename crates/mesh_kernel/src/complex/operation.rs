//! Operators as values: what a journal holds.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::ids::{Corner, DirectedEdge, EdgeClass, EdgeId, End, FaceId, FaceUse, Loop, VertexId};

/// The order of all uses of an edge, clockwise for one who looks along the edge.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RadialOrder {
    /// The edge.
    pub edge: EdgeId,
    /// All its uses as they shall be, those of the new face included (its id: [`super::Complex::next_face`]). Where the list
    /// begins does not matter.
    pub uses: Vec<FaceUse>,
}

/// A face to be made.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NewFace {
    /// Outer loop. Its direction gives the normal: the face lies to the left of its edges, seen from the normal's tip.
    pub outer: Loop,
    /// Hole loops. The face lies to the left of their edges too: in a planar face they run the other way round.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rings: Vec<Loop>,
    /// Places about edges that have three and more uses then. Where an edge is not mentioned, the place is found from the
    /// positions; the journal holds what was found. Faces that are far from plane leave their edges along the triangles of their
    /// picture in the plane nearest to theirs: for such, the order is better said.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub radial: Vec<RadialOrder>,
}

impl NewFace {
    /// A face with an outer loop, without rings.
    pub fn new(outer: impl Into<Loop>) -> Self {
        Self { outer: outer.into(), rings: Vec::new(), radial: Vec::new() }
    }

    /// Adds a hole loop.
    #[must_use]
    pub fn ring(mut self, ring: impl Into<Loop>) -> Self {
        self.rings.push(ring.into());
        self
    }

    /// Says the order about an edge instead of having it found from the positions.
    #[must_use]
    pub fn placed(mut self, order: RadialOrder) -> Self {
        self.radial.push(order);
        self
    }

    /// All loops, the outer one first.
    pub fn loops(&self) -> impl Iterator<Item = &Loop> {
        std::iter::once(&self.outer).chain(&self.rings)
    }
}

/// A corner of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FaceCorner {
    /// The face.
    pub face: FaceId,
    /// Where in it.
    pub corner: Corner,
}

/// An operator with its arguments. [`super::Editor`] has a method of the same name for each, with its picture and its rules.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Operation {
    /// See [`super::Editor::make_vertex_complex`].
    MakeVertexComplex {
        /// Where, in mm.
        position: DVec3,
    },
    /// See [`super::Editor::kill_vertex_complex`].
    KillVertexComplex {
        /// The vertex.
        vertex: VertexId,
    },
    /// See [`super::Editor::make_vertex_edge`].
    MakeVertexEdge {
        /// Old end of the edge.
        from: VertexId,
        /// Where the new vertex is, in mm.
        position: DVec3,
        /// Where in a face the edge goes in; a wire where there is none.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        corner: Option<FaceCorner>,
        /// Whether the edge's direction is from the new vertex to the old.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        inward: bool,
        /// Free, bend or weld.
        #[serde(default, skip_serializing_if = "EdgeClass::is_free")]
        class: EdgeClass,
    },
    /// See [`super::Editor::kill_vertex_edge`].
    KillVertexEdge {
        /// The vertex at the edge's loose end.
        vertex: VertexId,
    },
    /// See [`super::Editor::make_edge_chole`].
    MakeEdgeChole {
        /// Start and end.
        ends: [VertexId; 2],
        /// Free, bend or weld.
        #[serde(default, skip_serializing_if = "EdgeClass::is_free")]
        class: EdgeClass,
    },
    /// See [`super::Editor::kill_edge_chole`].
    KillEdgeChole {
        /// The edge.
        edge: EdgeId,
    },
    /// See [`super::Editor::make_edge_kill_complex`].
    MakeEdgeKillComplex {
        /// Start and end.
        ends: [VertexId; 2],
        /// Free, bend or weld.
        #[serde(default, skip_serializing_if = "EdgeClass::is_free")]
        class: EdgeClass,
    },
    /// See [`super::Editor::kill_edge_make_complex`].
    KillEdgeMakeComplex {
        /// The edge.
        edge: EdgeId,
    },
    /// See [`super::Editor::make_face_kill_chole`].
    MakeFaceKillChole {
        /// The face.
        face: NewFace,
    },
    /// See [`super::Editor::kill_face_make_chole`].
    KillFaceMakeChole {
        /// The face.
        face: FaceId,
    },
    /// See [`super::Editor::make_face_make_cavity`].
    MakeFaceMakeCavity {
        /// The face.
        face: NewFace,
    },
    /// See [`super::Editor::kill_face_kill_cavity`].
    KillFaceKillCavity {
        /// The face.
        face: FaceId,
    },
    /// See [`super::Editor::make_vertex_ring`].
    MakeVertexRing {
        /// The face in which the vertex stands.
        face: FaceId,
        /// Where, in mm.
        position: DVec3,
    },
    /// See [`super::Editor::kill_vertex_ring`].
    KillVertexRing {
        /// The vertex.
        vertex: VertexId,
    },
    /// See [`super::Editor::make_edge_kill_ring`].
    MakeEdgeKillRing {
        /// The face.
        face: FaceId,
        /// Where the edge begins.
        from: Corner,
        /// Where it ends, in another loop.
        to: Corner,
        /// Free, bend or weld.
        #[serde(default, skip_serializing_if = "EdgeClass::is_free")]
        class: EdgeClass,
    },
    /// See [`super::Editor::kill_edge_make_ring`].
    KillEdgeMakeRing {
        /// The edge.
        edge: EdgeId,
        /// The end whose part of the loop becomes the ring. Where the loop is a ring itself, both parts are.
        ring: End,
    },
    /// See [`super::Editor::split_edge`].
    SplitEdge {
        /// The edge.
        edge: EdgeId,
        /// Where the new vertex is, in mm.
        position: DVec3,
        /// Which half keeps the edge's id.
        kept: End,
        /// Whether the other half runs against the edge.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        flipped: bool,
    },
    /// See [`super::Editor::merge_edge`].
    MergeEdge {
        /// The edge that stays.
        kept: EdgeId,
        /// The vertex between the two, which goes.
        vertex: VertexId,
    },
    /// See [`super::Editor::move_vertex`].
    MoveVertex {
        /// The vertex.
        vertex: VertexId,
        /// Where to, in mm.
        position: DVec3,
    },
    /// See [`super::Editor::set_edge_class`].
    SetEdgeClass {
        /// The edge.
        edge: EdgeId,
        /// Free, bend or weld.
        class: EdgeClass,
    },
    /// See [`super::Editor::order_edge`].
    OrderEdge {
        /// The edge and its uses.
        order: RadialOrder,
    },
}

impl Operation {
    /// Name of the operator.
    pub fn name(&self) -> &'static str {
        match self {
            Self::MakeVertexComplex { .. } => "make_vertex_complex",
            Self::KillVertexComplex { .. } => "kill_vertex_complex",
            Self::MakeVertexEdge { .. } => "make_vertex_edge",
            Self::KillVertexEdge { .. } => "kill_vertex_edge",
            Self::MakeEdgeChole { .. } => "make_edge_chole",
            Self::KillEdgeChole { .. } => "kill_edge_chole",
            Self::MakeEdgeKillComplex { .. } => "make_edge_kill_complex",
            Self::KillEdgeMakeComplex { .. } => "kill_edge_make_complex",
            Self::MakeFaceKillChole { .. } => "make_face_kill_chole",
            Self::KillFaceMakeChole { .. } => "kill_face_make_chole",
            Self::MakeFaceMakeCavity { .. } => "make_face_make_cavity",
            Self::KillFaceKillCavity { .. } => "kill_face_kill_cavity",
            Self::MakeVertexRing { .. } => "make_vertex_ring",
            Self::KillVertexRing { .. } => "kill_vertex_ring",
            Self::MakeEdgeKillRing { .. } => "make_edge_kill_ring",
            Self::KillEdgeMakeRing { .. } => "kill_edge_make_ring",
            Self::SplitEdge { .. } => "split_edge",
            Self::MergeEdge { .. } => "merge_edge",
            Self::MoveVertex { .. } => "move_vertex",
            Self::SetEdgeClass { .. } => "set_edge_class",
            Self::OrderEdge { .. } => "order_edge",
        }
    }
}

/// By how much an operator changes the counts; see [`crate::body::Counts`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Delta {
    /// Vertices.
    pub v: i64,
    /// Edges.
    pub e: i64,
    /// Faces.
    pub f: i64,
    /// Rings.
    pub r: i64,
    /// Connected components.
    pub c: i64,
    /// Holes of complexes: independent cycles that no face fills.
    pub ch: i64,
    /// Cavities: enclosed voids.
    pub cc: i64,
}

impl Delta {
    /// Whether it keeps `v − e + f − r = c − ch + cc`.
    pub fn keeps_identity(&self) -> bool {
        self.v - self.e + self.f - self.r == self.c - self.ch + self.cc
    }

    /// The change between two counts.
    pub fn between(before: &crate::body::Counts, after: &crate::body::Counts) -> Self {
        Self {
            v: after.v - before.v,
            e: after.e - before.e,
            f: after.f - before.f,
            r: after.r - before.r,
            c: after.c - before.c,
            ch: after.ch - before.ch,
            cc: after.cc - before.cc,
        }
    }
}

impl std::ops::Add for Delta {
    type Output = Self;

    fn add(self, o: Self) -> Self {
        Self {
            v: self.v + o.v,
            e: self.e + o.e,
            f: self.f + o.f,
            r: self.r + o.r,
            c: self.c + o.c,
            ch: self.ch + o.ch,
            cc: self.cc + o.cc,
        }
    }
}

impl std::ops::Neg for Delta {
    type Output = Self;

    fn neg(self) -> Self {
        Self { v: -self.v, e: -self.e, f: -self.f, r: -self.r, c: -self.c, ch: -self.ch, cc: -self.cc }
    }
}

impl std::fmt::Display for Delta {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { v, e, f: faces, r, c, ch, cc } = self;
        write!(f, "v {v:+} e {e:+} f {faces:+} r {r:+} C {c:+} Ch {ch:+} Cc {cc:+}")
    }
}

/// What an operator did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// The vertex made, killed or moved.
    pub vertex: Option<VertexId>,
    /// The edge made, killed or changed; of a split, the new one; of a merge, the one that went.
    pub edge: Option<EdgeId>,
    /// The face made, killed, or in which it happened.
    pub face: Option<FaceId>,
    /// Change of the counts.
    pub delta: Delta,
}

/// What a wire edge does to the whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EdgeKind {
    /// It closes a cycle: a hole of its complex (W: Chole).
    Chole,
    /// It is the only link of two complexes.
    Complex,
}

/// What a face does to the whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FaceKind {
    /// It fills a hole of a complex: the same region lies on both sides.
    Chole,
    /// It parts two regions: it closes a cavity.
    Cavity,
}

impl From<EdgeId> for DirectedEdge {
    fn from(edge: EdgeId) -> Self {
        Self::along(edge)
    }
}
