//! The extended Euler operators on triangle surfaces (K3; Wang et al., table A-1), each with its inverse.
//!
//! They are the small steps of which every change of topology is made; each changes [`Body::counts`](crate::body::Body::counts)
//! by exactly what [`EulerOperator::delta`] says:
//!
//! | operator | v | e | f | c | ch | cc | Lee & Kim |
//! |---|---|---|---|---|---|---|---|
//! | [`Editor::make_vertex_complex`](super::Editor::make_vertex_complex) | +1 | | | +1 | | | MVS |
//! | [`Editor::make_vertex_edge`](super::Editor::make_vertex_edge) | +1 | +1 | | | | | MEV |
//! | [`Editor::make_edge_chole`](super::Editor::make_edge_chole) | | +1 | | | +1 | | MEC |
//! | [`Editor::make_edge_kill_complex`](super::Editor::make_edge_kill_complex) | | +1 | | −1 | | | MEKS |
//! | [`Editor::make_face_kill_chole`](super::Editor::make_face_kill_chole) | | | +1 | | −1 | | MFKC |
//! | [`Editor::make_face_make_cavity`](super::Editor::make_face_make_cavity) | | | +1 | | | +1 | MFR |
//! | [`Editor::split_wire`](super::Editor::split_wire) | +1 | +1 | | | | | SEMV |
//! | [`Editor::make_vertex_ring`](super::Editor::make_vertex_ring) | | | | | | | MVL |
//! | [`Editor::make_edge_kill_ring`](super::Editor::make_edge_kill_ring) | | | | | | | MEKL |
//!
//! The inverses (kill ↔ make, merge ↔ split: Lee & Kim's KVS, KEV, KEC, KEMS, KFMC, KFR, JEKV, KVL, KEML) have the
//! negative deltas. MEF is `make_edge_chole` followed by `make_face_kill_chole`, KEF its reverse.
//!
//! *Rings.* The paper's make_vertex_ring adds a vertex and a ring inside a face, v + 1 and r + 1, which cancel in the
//! identity; make_edge_kill_ring adds an edge and takes a ring, e + 1 and r − 1, which cancel too. A face here is a
//! triangle without rings; what lies in it before it is triangulated is an attribute node (ATTRIB_FACENODE) or edge
//! (ATTRIB_EDGE), which the counts leave out on both sides. So ring operators change no count.
//!
//! *Kinds.* Whether an edge closes a cycle or joins two complexes, and whether a face fills a hole or closes a cavity, is
//! decided on the welded body, joints included ([`EdgeRole`], [`FaceRole`]). The strict operators refuse the other kind;
//! [`Editor::make_edge`](super::Editor::make_edge), [`make_face`](super::Editor::make_face),
//! [`kill_edge`](super::Editor::kill_edge) and [`kill_face`](super::Editor::kill_face) take both and say which it was.
//!
//! *Numbers.* Killing frees a number, making takes the one freed last, so that killing and then making in mirror order
//! gives the same body bit for bit. Making and then killing does so too where numbers were free; else the arrays stay one
//! longer, with a free number, until the body is made compact. Undoing leaves no trace in either case.
//!
//! # High-level operators as sequences (K4; Wang et al., table 3)
//!
//! Each of these sequences gives the body that the operator gives, bit for bit, numbers included
//! (`tests/all/body/sequences.rs` carries them out). n is the number of faces at the edge.
//!
//! | operator | sequence | v | e | f |
//! |---|---|---|---|---|
//! | edge split | kill_face right, left; split_wire; make_edge from the new node to the tips, left, right; make_face for the parts at the edge's first node, left, right, then for those at its second | +1 | +1+n | +n |
//! | edge swap | kill_face right, left; kill_edge; make_edge from the right tip to the left; make_face left, right | | | |
//! | edge collapse | kill_face left, right, then all others at the node that goes; kill_edge for the edge, the sides there, left, right, and all others there; kill_vertex_complex; in mirror order make_edge and make_face for the others, to the node that stays | −1 | −1−n | −n |
//! | face split, m faces on its other sides | kill_face for it and those, highest number first; split_wire for the sides; make_edge for the cuts; make_face for the parts with old numbers, lowest first, then for the new ones | +3 | +6+m | +3+m |
//! | face triangulation | the same with split_wire for every attribute node on a side and make_vertex_complex for every one inside | | | |
//!
//! *On joints.* kill_joint for every joint that a face which goes has a side on, or that runs past one; the sequence on
//! the edge and then on its partners in order of surfaces and edges (face split and triangulation: on one surface
//! after the other); make_joint in mirror order, their chains longer or shorter by the nodes that came or went. Radial
//! orders are found anew from the geometry by make_joint, while the operators keep the stored ones.
//!
//! *Where a node goes elsewhere* (collapse to a place along the edge, partners of a split), move_nodes puts it there.
//!
//! *What the paper passes over.* kill_face and make_face stand for the form that the surroundings ask for: killing one
//! face of a closed shell opens its cavity, killing the next makes a hole; the paper lists only the latter. The last edge
//! at a node that goes is a bridge: kill_edge_make_complex, and then kill_vertex_complex takes the complex away. Attributes
//! are carried by the operators only; the sequences refuse faces and edges that carry some.

mod edges;
mod faces;
mod refusal;
mod rings;
mod shell_walk;
mod vertices;

pub use refusal::EulerError;

use crate::body::{Body, Chain, Counts, EdgeId, FaceId, JointId, NONE, NodeId, Surface, SurfaceId};

/// The operators of K3, by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum EulerOperator {
    MakeVertexComplex,
    KillVertexComplex,
    MakeVertexEdge,
    KillVertexEdge,
    MakeEdgeChole,
    KillEdgeChole,
    MakeEdgeKillComplex,
    KillEdgeMakeComplex,
    MakeFaceKillChole,
    KillFaceMakeChole,
    MakeFaceMakeCavity,
    KillFaceKillCavity,
    SplitWire,
    MergeWire,
    MakeVertexRing,
    KillVertexRing,
    MakeEdgeKillRing,
    KillEdgeMakeRing,
}

impl EulerOperator {
    /// All of them, each followed by its inverse.
    pub const ALL: [Self; 18] = [
        Self::MakeVertexComplex,
        Self::KillVertexComplex,
        Self::MakeVertexEdge,
        Self::KillVertexEdge,
        Self::MakeEdgeChole,
        Self::KillEdgeChole,
        Self::MakeEdgeKillComplex,
        Self::KillEdgeMakeComplex,
        Self::MakeFaceKillChole,
        Self::KillFaceMakeChole,
        Self::MakeFaceMakeCavity,
        Self::KillFaceKillCavity,
        Self::SplitWire,
        Self::MergeWire,
        Self::MakeVertexRing,
        Self::KillVertexRing,
        Self::MakeEdgeKillRing,
        Self::KillEdgeMakeRing,
    ];

    /// The paper's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::MakeVertexComplex => "make_vertex_complex",
            Self::KillVertexComplex => "kill_vertex_complex",
            Self::MakeVertexEdge => "make_vertex_edge",
            Self::KillVertexEdge => "kill_vertex_edge",
            Self::MakeEdgeChole => "make_edge_chole",
            Self::KillEdgeChole => "kill_edge_chole",
            Self::MakeEdgeKillComplex => "make_edge_kill_complex",
            Self::KillEdgeMakeComplex => "kill_edge_make_complex",
            Self::MakeFaceKillChole => "make_face_kill_chole",
            Self::KillFaceMakeChole => "kill_face_make_chole",
            Self::MakeFaceMakeCavity => "make_face_make_cavity",
            Self::KillFaceKillCavity => "kill_face_kill_cavity",
            Self::SplitWire => "split_wire",
            Self::MergeWire => "merge_wire",
            Self::MakeVertexRing => "make_vertex_ring",
            Self::KillVertexRing => "kill_vertex_ring",
            Self::MakeEdgeKillRing => "make_edge_kill_ring",
            Self::KillEdgeMakeRing => "kill_edge_make_ring",
        }
    }

    /// What it adds to the counts of the body.
    pub fn delta(self) -> Counts {
        let none = Counts { v: 0, e: 0, f: 0, r: 0, c: 0, ch: 0, cc: 0 };
        match self {
            Self::MakeVertexComplex => Counts { v: 1, c: 1, ..none },
            Self::KillVertexComplex => Counts { v: -1, c: -1, ..none },
            Self::MakeVertexEdge | Self::SplitWire => Counts { v: 1, e: 1, ..none },
            Self::KillVertexEdge | Self::MergeWire => Counts { v: -1, e: -1, ..none },
            Self::MakeEdgeChole => Counts { e: 1, ch: 1, ..none },
            Self::KillEdgeChole => Counts { e: -1, ch: -1, ..none },
            Self::MakeEdgeKillComplex => Counts { e: 1, c: -1, ..none },
            Self::KillEdgeMakeComplex => Counts { e: -1, c: 1, ..none },
            Self::MakeFaceKillChole => Counts { f: 1, ch: -1, ..none },
            Self::KillFaceMakeChole => Counts { f: -1, ch: 1, ..none },
            Self::MakeFaceMakeCavity => Counts { f: 1, cc: 1, ..none },
            Self::KillFaceKillCavity => Counts { f: -1, cc: -1, ..none },
            Self::MakeVertexRing | Self::KillVertexRing | Self::MakeEdgeKillRing | Self::KillEdgeMakeRing => {
                none
            }
        }
    }

    /// The operator that takes it back.
    pub fn inverse(self) -> Self {
        let at = Self::ALL.iter().position(|&o| o == self).unwrap_or(0);
        Self::ALL[at ^ 1]
    }
}

/// What an edge does for the connection of the welded body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EdgeRole {
    /// Its ends are connected without it too: it closes a cycle (a *Chole* while no face fills it).
    Cycle,
    /// It alone connects its ends: without it there is one complex more.
    Bridge,
}

impl EdgeRole {
    /// The operator that makes such an edge.
    pub fn made_by(self) -> EulerOperator {
        match self {
            Self::Cycle => EulerOperator::MakeEdgeChole,
            Self::Bridge => EulerOperator::MakeEdgeKillComplex,
        }
    }
}

/// What a face does for the welded body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FaceRole {
    /// Both its sides look into one region: it fills a hole.
    Filling,
    /// It parts two regions: it closes a cavity.
    Closing,
}

impl FaceRole {
    /// The operator that makes such a face.
    pub fn made_by(self) -> EulerOperator {
        match self {
            Self::Filling => EulerOperator::MakeFaceKillChole,
            Self::Closing => EulerOperator::MakeFaceMakeCavity,
        }
    }
}

/// What operators ask a body before they act.
impl Body {
    fn checked_surface(&self, surface: SurfaceId) -> Result<&Surface, EulerError> {
        self.surfaces.get(surface.index()).ok_or(EulerError::NoSurface(surface))
    }

    fn checked_node(&self, surface: SurfaceId, node: NodeId) -> Result<&Surface, EulerError> {
        let s = self.checked_surface(surface)?;
        if s.is_node(node) { Ok(s) } else { Err(EulerError::NoNode { surface, node }) }
    }

    fn checked_edge(&self, surface: SurfaceId, edge: EdgeId) -> Result<&Surface, EulerError> {
        let s = self.checked_surface(surface)?;
        if s.is_edge(edge) { Ok(s) } else { Err(EulerError::NoEdge { surface, edge }) }
    }

    fn checked_face(&self, surface: SurfaceId, face: FaceId) -> Result<&Surface, EulerError> {
        let s = self.checked_surface(surface)?;
        if s.is_face(face) { Ok(s) } else { Err(EulerError::NoFace { surface, face }) }
    }
}

impl Surface {
    /// Edges that end in a node, in order. O(edges).
    fn edges_at(&self, node: NodeId) -> Vec<EdgeId> {
        let at = |(_, ends): &(usize, &[u32; 2])| ends.contains(&node.0);
        self.edges.iter().enumerate().filter(at).map(|(e, _)| EdgeId(e as u32)).collect()
    }

    /// The faces of an edge.
    fn faces_at(&self, edge: EdgeId) -> Vec<FaceId> {
        self.edge_faces[edge.index()].into_iter().filter(|&f| f != NONE).map(FaceId).collect()
    }

    /// The joint that an edge lies on.
    fn joint_of(&self, edge: EdgeId) -> Option<JointId> {
        self.chain(self.edge_chain(edge)?).joint
    }

    /// A joint whose chains pass a node. O(length of the surface's joints).
    fn joint_at(&self, node: NodeId) -> Option<JointId> {
        let passes = |c: &&Chain| {
            c.start == node || c.edges.iter().any(|d| self.edges[d.edge().index()].contains(&node.0))
        };
        self.chains.iter().filter(|c| c.joint.is_some()).find(passes).and_then(|c| c.joint)
    }

    fn has_room(&self, surface: SurfaceId) -> Result<(), EulerError> {
        // Directed edges take one bit of an id.
        let full = self.positions.len() >= NONE as usize - 1 || self.edges.len() >= (1 << 31) - 1;
        if full { Err(EulerError::TooLarge(surface)) } else { Ok(()) }
    }
}
