//! The extended Euler operators, each with its inverse (Wang et al., appendix III; SPEC names in brackets).
//!
//! Pictures: `•` a vertex, `───` an edge, `░` a face. Deltas are those of `v − e + f − r = C − Ch + Cc`; what is not named stays.

use glam::DVec3;

use super::editor::Editor;
use super::ids::{Corner, EdgeClass, EdgeId, End, FaceId, VertexId};
use super::operation::{Delta, EdgeKind, FaceCorner, FaceKind, NewFace, Operation, Outcome, RadialOrder};
use super::refusal::{Reason, Refusal};

/// A new vertex at the end of a new edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VertexEdge {
    /// The vertex.
    pub vertex: VertexId,
    /// The edge, from the old vertex to the new.
    pub edge: EdgeId,
}

/// A new wire edge, and what it did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MadeEdge {
    /// The edge.
    pub edge: EdgeId,
    /// What it did.
    pub kind: EdgeKind,
    /// Change of the counts.
    pub delta: Delta,
}

/// A new face, and what it did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MadeFace {
    /// The face.
    pub face: FaceId,
    /// What it did.
    pub kind: FaceKind,
    /// Change of the counts.
    pub delta: Delta,
}

fn vertex_of(o: &Outcome) -> VertexId {
    o.vertex.unwrap_or(VertexId(u32::MAX))
}

fn edge_of(o: &Outcome) -> EdgeId {
    o.edge.unwrap_or(EdgeId(u32::MAX))
}

fn face_of(o: &Outcome) -> FaceId {
    o.face.unwrap_or(FaceId(u32::MAX))
}

impl Editor {
    /// A vertex that stands alone.
    ///
    /// ```text
    ///            →      •
    /// ```
    /// v +1, C +1. Inverse: [`Self::kill_vertex_complex`]. O(1). Lee & Kim: MVS; Lipson: MCV.
    ///
    /// # Errors
    /// [`Reason::NotFinite`], [`Reason::Full`].
    pub fn make_vertex_complex(&mut self, position: DVec3) -> Result<VertexId, Refusal> {
        self.apply(&Operation::MakeVertexComplex { position }).map(|o| vertex_of(&o))
    }

    /// Takes a vertex away that stands alone. v −1, C −1. O(1). Lee & Kim: KVS; Lipson: KCV.
    ///
    /// # Errors
    /// [`Reason::NoVertex`]; [`Reason::VertexInUse`] with its edges and the faces of which it is a loop.
    pub fn kill_vertex_complex(&mut self, vertex: VertexId) -> Result<Delta, Refusal> {
        self.apply(&Operation::KillVertexComplex { vertex }).map(|o| o.delta)
    }

    /// A wire edge to a new vertex.
    ///
    /// ```text
    ///   from •        →      from •──────• new
    /// ```
    /// v +1, e +1. Inverse: [`Self::kill_vertex_edge`]. O(edges at `from`). Lee & Kim, Lipson: MEV.
    ///
    /// # Errors
    /// [`Reason::NoVertex`], [`Reason::NotFinite`], [`Reason::Full`].
    pub fn make_vertex_edge(&mut self, from: VertexId, position: DVec3) -> Result<VertexEdge, Refusal> {
        self.vertex_edge(from, position, None)
    }

    /// An edge to a new vertex inside a face: a strut. It goes into the loop of the corner, walked to and fro.
    ///
    /// ```text
    ///   •──────────•          •──────────•
    ///   │░░░░░░░░░░│          │░░░•░░░░░░│
    ///   │░░░░░░░░░░│    →     │░░╱░░░░░░░│
    ///   •──────────•          •──────────•
    ///  from                  from
    /// ```
    /// v +1, e +1. Where the face is bent or not star-shaped is the caller's affair. Inverse: [`Self::kill_vertex_edge`].
    /// O(loops of the face). Lee & Kim: MEV.
    ///
    /// # Errors
    /// [`Reason::NoFace`], [`Reason::NoCorner`], [`Reason::NotFinite`], [`Reason::Full`].
    pub fn make_vertex_edge_in_face(
        &mut self,
        face: FaceId,
        corner: Corner,
        position: DVec3,
    ) -> Result<VertexEdge, Refusal> {
        let from = self
            .complex()
            .corner_vertex(corner)
            .ok_or(Refusal { operator: "make_vertex_edge", reason: Reason::NoCorner { face, corner } })?;
        self.vertex_edge(from, position, Some(FaceCorner { face, corner }))
    }

    fn vertex_edge(
        &mut self,
        from: VertexId,
        position: DVec3,
        corner: Option<FaceCorner>,
    ) -> Result<VertexEdge, Refusal> {
        let class = EdgeClass::Free;
        let operation = Operation::MakeVertexEdge { from, position, corner, inward: false, class };
        self.apply(&operation).map(|o| VertexEdge { vertex: vertex_of(&o), edge: edge_of(&o) })
    }

    /// Takes a vertex away with its only edge: a wire, or a strut in a face. v −1, e −1. O(loops of the face). Lee & Kim, Lipson: KEV.
    ///
    /// # Errors
    /// [`Reason::NoVertex`]; [`Reason::NotLooseEnd`] with the edges; [`Reason::VertexInUse`] where it is a loop too;
    /// [`Reason::FacesAtEdge`] where several faces have the strut; [`Reason::RingTwice`] where the vertex left would be a loop of the
    /// face twice.
    pub fn kill_vertex_edge(&mut self, vertex: VertexId) -> Result<Delta, Refusal> {
        self.apply(&Operation::KillVertexEdge { vertex }).map(|o| o.delta)
    }

    /// A wire edge between two vertices of one component: it closes a cycle.
    ///
    /// ```text
    ///   •─────•          •─────•
    ///   │             →  │     │     a hole of the complex
    ///   •─────•          •─────•
    /// ```
    /// e +1, Ch +1. Inverse: [`Self::kill_edge_chole`]. O(vertices nearer to the ends than these to each other). Lee & Kim: MEC.
    ///
    /// # Errors
    /// [`Reason::NoVertex`], [`Reason::SelfLoop`], [`Reason::Full`]; [`Reason::EdgeKind`] where the ends lie in two components.
    pub fn make_edge_chole(&mut self, from: VertexId, to: VertexId) -> Result<EdgeId, Refusal> {
        let class = EdgeClass::Free;
        self.apply(&Operation::MakeEdgeChole { ends: [from, to], class }).map(|o| edge_of(&o))
    }

    /// Takes a wire edge away without which its component still hangs together. e −1, Ch −1. O(component) at most. Lee & Kim: KEC.
    ///
    /// # Errors
    /// [`Reason::NoEdge`]; [`Reason::FacesAtEdge`]; [`Reason::EdgeKind`] where it is the only link.
    pub fn kill_edge_chole(&mut self, edge: EdgeId) -> Result<Delta, Refusal> {
        self.apply(&Operation::KillEdgeChole { edge }).map(|o| o.delta)
    }

    /// A wire edge between two components, which become one.
    ///
    /// ```text
    ///   •──•   •──•    →    •──•───•──•
    /// ```
    /// e +1, C −1. Inverse: [`Self::kill_edge_make_complex`]. O(smaller component). Lee & Kim: MEKS.
    ///
    /// # Errors
    /// [`Reason::NoVertex`], [`Reason::SelfLoop`], [`Reason::Full`]; [`Reason::EdgeKind`] where the ends hang together already.
    pub fn make_edge_kill_complex(&mut self, from: VertexId, to: VertexId) -> Result<EdgeId, Refusal> {
        let class = EdgeClass::Free;
        self.apply(&Operation::MakeEdgeKillComplex { ends: [from, to], class }).map(|o| edge_of(&o))
    }

    /// Takes a wire edge away that is the only link of its two ends. e −1, C +1. O(smaller of the components made). Lee & Kim: KEMS.
    ///
    /// # Errors
    /// [`Reason::NoEdge`]; [`Reason::FacesAtEdge`]; [`Reason::EdgeKind`] where the ends hang together without it.
    pub fn kill_edge_make_complex(&mut self, edge: EdgeId) -> Result<Delta, Refusal> {
        self.apply(&Operation::KillEdgeMakeComplex { edge }).map(|o| o.delta)
    }

    /// A wire edge of either kind, found out from the topology: [`Self::make_edge_chole`] or [`Self::make_edge_kill_complex`].
    ///
    /// # Errors
    /// [`Reason::NoVertex`], [`Reason::SelfLoop`], [`Reason::Full`].
    pub fn make_edge(&mut self, from: VertexId, to: VertexId) -> Result<MadeEdge, Refusal> {
        self.make_edge_of_class(from, to, EdgeClass::Free)
    }

    /// [`Self::make_edge`] with a class.
    ///
    /// # Errors
    /// Those of [`Self::make_edge`].
    pub fn make_edge_of_class(
        &mut self,
        from: VertexId,
        to: VertexId,
        class: EdgeClass,
    ) -> Result<MadeEdge, Refusal> {
        let plan = self.complex().plan_make_edge([from, to], class, None);
        let (kind, step) = plan.map_err(|reason| Refusal { operator: "make_edge", reason })?;
        let o = self.take(step);
        Ok(MadeEdge { edge: edge_of(&o), kind, delta: o.delta })
    }

    /// Takes a wire edge away, of either kind, and tells the kind: [`Self::kill_edge_chole`] or [`Self::kill_edge_make_complex`].
    ///
    /// # Errors
    /// [`Reason::NoEdge`], [`Reason::FacesAtEdge`].
    pub fn kill_edge(&mut self, edge: EdgeId) -> Result<MadeEdge, Refusal> {
        let plan = self.complex().plan_kill_edge(edge, None);
        let (kind, step) = plan.map_err(|reason| Refusal { operator: "kill_edge", reason })?;
        Ok(MadeEdge { edge, kind, delta: self.take(step).delta })
    }

    /// A face that fills a hole of its complex: one region lies on both sides of it.
    ///
    /// ```text
    ///   •─────•          •─────•
    ///   │     │     →    │░░░░░│
    ///   •─────•          •─────•
    /// ```
    /// f +1, Ch −1. Each ring adds to that what a bridge from it to the outer loop does: r +1, and C −1 where they were two
    /// components, Ch +1 where they were one. (A frame of two square wires: f +1, r +1, C −1, Ch −1.)
    ///
    /// The place about edges that have other faces is given in [`NewFace::radial`] or found from the positions: each facet leaves an
    /// edge along the triangle there of a constrained triangulation, exactly compared.
    ///
    /// Inverse: [`Self::kill_face_make_chole`]. O(loops); where several edges have other faces, O(their component) at most; plus
    /// O(n log n) for the corners of faces at edges where places are found. Lee & Kim: MFKC.
    ///
    /// # Errors
    /// [`Reason::NoEdge`], [`Reason::NoVertex`], [`Reason::EmptyLoop`], [`Reason::OpenLoop`], [`Reason::UsedTwice`],
    /// [`Reason::RingTwice`], [`Reason::Full`]: not a face. [`Reason::RadialTie`], [`Reason::RadialStored`],
    /// [`Reason::RadialGiven`]: no place about an edge. [`Reason::TwoRegions`], [`Reason::NotSeparating`]: no such face lies in
    /// space with these places. [`Reason::FaceKind`]: it closes a cavity.
    pub fn make_face_kill_chole(&mut self, face: NewFace) -> Result<FaceId, Refusal> {
        self.apply(&Operation::MakeFaceKillChole { face }).map(|o| face_of(&o))
    }

    /// Takes a face away that has one region on both sides; its edges stay. f −1, Ch +1, and for each ring the inverse of what it adds,
    /// see [`Self::make_face_kill_chole`]. O(loops) where it has a free edge, else O(component) at most. Lee & Kim: KFMC.
    ///
    /// # Errors
    /// [`Reason::NoFace`]; [`Reason::FaceKind`] where it bounds a cavity.
    pub fn kill_face_make_chole(&mut self, face: FaceId) -> Result<Delta, Refusal> {
        self.apply(&Operation::KillFaceMakeChole { face }).map(|o| o.delta)
    }

    /// A face that parts a region in two: the last one of a shell, a partition of a box, a face on a single vertex (a sphere).
    ///
    /// ```text
    ///    •────•               •────•
    ///   ╱    ╱│              ╱░░░░╱│
    ///  •────• │  open   →   •────• │  closed: one region more
    ///  │░░░░│ •  at the     │░░░░│ •
    ///  │░░░░│╱   top        │░░░░│╱
    ///  •────•               •────•
    /// ```
    /// f +1, Cc +1; rings add what they add in [`Self::make_face_kill_chole`], but no hole is filled. The kind is found by walking
    /// from side to side of faces round the edges in radial order. Inverse: [`Self::kill_face_kill_cavity`]. O(component). Lee & Kim: MFR.
    ///
    /// # Errors
    /// Those of [`Self::make_face_kill_chole`]; [`Reason::FaceKind`] where it fills a hole.
    pub fn make_face_make_cavity(&mut self, face: NewFace) -> Result<FaceId, Refusal> {
        self.apply(&Operation::MakeFaceMakeCavity { face }).map(|o| face_of(&o))
    }

    /// Takes a face away that parts two regions. f −1, Cc −1. O(component). Lee & Kim: KFR.
    ///
    /// # Errors
    /// [`Reason::NoFace`]; [`Reason::FaceKind`] where one region lies on both sides.
    pub fn kill_face_kill_cavity(&mut self, face: FaceId) -> Result<Delta, Refusal> {
        self.apply(&Operation::KillFaceKillCavity { face }).map(|o| o.delta)
    }

    /// A face of either kind, found out from the topology: [`Self::make_face_kill_chole`] or [`Self::make_face_make_cavity`].
    ///
    /// # Errors
    /// Those of [`Self::make_face_kill_chole`] without [`Reason::FaceKind`].
    pub fn make_face(&mut self, face: NewFace) -> Result<MadeFace, Refusal> {
        let plan = self.complex().plan_make_face(&face, None);
        let (kind, step) = plan.map_err(|reason| Refusal { operator: "make_face", reason })?;
        let o = self.take(step);
        Ok(MadeFace { face: face_of(&o), kind, delta: o.delta })
    }

    /// Takes a face away, of either kind, and tells the kind.
    ///
    /// # Errors
    /// [`Reason::NoFace`].
    pub fn kill_face(&mut self, face: FaceId) -> Result<MadeFace, Refusal> {
        let plan = self.complex().plan_kill_face(face, None);
        let (kind, step) = plan.map_err(|reason| Refusal { operator: "kill_face", reason })?;
        Ok(MadeFace { face, kind, delta: self.take(step).delta })
    }

    /// A vertex inside a face, as a ring.
    ///
    /// ```text
    ///   •─────────•          •─────────•
    ///   │░░░░░░░░░│     →    │░░░░•░░░░│
    ///   •─────────•          •─────────•
    /// ```
    /// v +1, r +1. Inverse: [`Self::kill_vertex_ring`]. O(loops of the face). Lee & Kim: MVL.
    ///
    /// # Errors
    /// [`Reason::NoFace`], [`Reason::NotFinite`], [`Reason::Full`].
    pub fn make_vertex_ring(&mut self, face: FaceId, position: DVec3) -> Result<VertexId, Refusal> {
        self.apply(&Operation::MakeVertexRing { face, position }).map(|o| vertex_of(&o))
    }

    /// Takes a vertex away that is a ring of one face and has no edges. v −1, r −1. O(loops of the face). Lee & Kim: KVL.
    ///
    /// # Errors
    /// [`Reason::NoVertex`]; [`Reason::VertexInUse`] with its edges; [`Reason::NotRing`].
    pub fn kill_vertex_ring(&mut self, vertex: VertexId) -> Result<Delta, Refusal> {
        self.apply(&Operation::KillVertexRing { vertex }).map(|o| o.delta)
    }

    /// An edge inside a face from one of its loops to another: the two become one.
    ///
    /// ```text
    ///   •─────────•          •─────────•
    ///   │░░░•─•░░░│          │░░░•─•░░░│
    ///   │░░░│ │░░░│     →    │░░░│ │░░░│
    ///   │░░░•─•░░░│          │░░░•─•░░░│
    ///   │░░░░░░░░░│          │░░╱░░░░░░│
    ///   •─────────•          •─────────•
    /// ```
    /// e +1, r −1. Inverse: [`Self::kill_edge_make_ring`]. O(loops of the face). Lee & Kim: MEKL; Lipson: MGB with a bend.
    ///
    /// # Errors
    /// [`Reason::NoFace`], [`Reason::NoCorner`], [`Reason::SameLoop`] (that is [`Self::mef`]), [`Reason::SelfLoop`], [`Reason::Full`].
    pub fn make_edge_kill_ring(&mut self, face: FaceId, from: Corner, to: Corner) -> Result<EdgeId, Refusal> {
        let class = EdgeClass::Free;
        self.apply(&Operation::MakeEdgeKillRing { face, from, to, class }).map(|o| edge_of(&o))
    }

    /// Takes an edge away that one loop walks to and fro; the loop falls in two, and the part at the end `ring` of the edge becomes a
    /// ring. e −1, r +1. O(loops of the face). Lee & Kim: KEML.
    ///
    /// # Errors
    /// [`Reason::NoEdge`]; [`Reason::NotIsthmus`] with the faces; [`Reason::RingTwice`] where a vertex would be a loop of the face twice.
    pub fn kill_edge_make_ring(&mut self, edge: EdgeId, ring: End) -> Result<Delta, Refusal> {
        self.apply(&Operation::KillEdgeMakeRing { edge, ring }).map(|o| o.delta)
    }

    /// A vertex on an edge, in all its faces.
    ///
    /// ```text
    ///   ░░░░░░░░░░            ░░░░░░░░░░
    ///   •────────•     →      •───•────•
    ///   ░░░░░░░░░░            ░░░░░░░░░░
    /// ```
    /// v +1, e +1. The edge keeps the half at its start, the new edge goes on in its direction; class and radial order are those of
    /// the edge. Gives the vertex and the new edge. Inverse: [`Self::merge_edge`]. O(loops of its faces). Lee & Kim: SEMV.
    ///
    /// # Errors
    /// [`Reason::NoEdge`], [`Reason::NotFinite`], [`Reason::Full`].
    pub fn split_edge(&mut self, edge: EdgeId, position: DVec3) -> Result<VertexEdge, Refusal> {
        let operation = Operation::SplitEdge { edge, position, kept: End::Start, flipped: false };
        self.apply(&operation).map(|o| VertexEdge { vertex: vertex_of(&o), edge: edge_of(&o) })
    }

    /// Makes one edge of the two at a vertex; `kept` stays. v −1, e −1. O(loops of its faces). Lee & Kim: JEKV.
    ///
    /// # Errors
    /// [`Reason::NoEdge`], [`Reason::NoVertex`]; [`Reason::NotTwoEdges`]; [`Reason::VertexInUse`] where it is a loop by itself;
    /// [`Reason::SelfLoop`] where the other ends are one vertex; [`Reason::ClassesDiffer`]; [`Reason::FacesTurn`] with the
    /// faces that have one of the edges only, turn back at the vertex, or stand in another order.
    pub fn merge_edge(&mut self, kept: EdgeId, vertex: VertexId) -> Result<Delta, Refusal> {
        self.apply(&Operation::MergeEdge { kept, vertex }).map(|o| o.delta)
    }

    /// Moves a vertex. No count changes; stored radial orders stay, and [`super::Complex::check`] tells where they are no longer those
    /// of the positions. O(1).
    ///
    /// # Errors
    /// [`Reason::NoVertex`], [`Reason::NotFinite`].
    pub fn move_vertex(&mut self, vertex: VertexId, position: DVec3) -> Result<(), Refusal> {
        self.apply(&Operation::MoveVertex { vertex, position }).map(|_| ())
    }

    /// Calls an edge free, a bend or a weld. No count of the complex changes. O(1).
    ///
    /// # Errors
    /// [`Reason::NoEdge`].
    pub fn set_edge_class(&mut self, edge: EdgeId, class: EdgeClass) -> Result<(), Refusal> {
        self.apply(&Operation::SetEdgeClass { edge, class }).map(|_| ())
    }

    /// Sets the radial order about an edge, for instance after vertices were moved. No count changes. O(complex).
    ///
    /// # Errors
    /// [`Reason::NoEdge`]; [`Reason::RadialGiven`] where the uses are not those of the edge; [`Reason::OrderChangesRegions`] where
    /// another order would open or close cavities.
    pub fn order_edge(&mut self, order: RadialOrder) -> Result<(), Refusal> {
        self.apply(&Operation::OrderEdge { order }).map(|_| ())
    }
}
