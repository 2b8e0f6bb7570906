//! Every operator as data, to be saved, sent, and carried out again.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::Editor;
use super::collapse_edge::{CollapseError, CollapseOptions, EdgeCollapse};
use super::euler::{EdgeRole, EulerError, EulerOperator, FaceRole};
use super::joints::JointError;
use super::layers::LayerError;
use super::split_edge::{EdgeSplit, SplitEdgeError};
use super::swap_edge::{Guard, SwapError};
use super::triangulate_face::{FaceTriangulation, TriangulateError};
use crate::body::{
    AttributeEdge, AttributeEdgeId, AttributeNode, AttributeNodeId, Compaction, EdgeId, FaceId, FaceSplit,
    JointId, JointSpec, NodeId, Pairing, PairingError, Resolution, SplitError, SplitFaceError, SplitMap,
    SurfaceId,
};

/// One operator of [`Editor`] with all that it needs; each variant is documented at the method of the same name.
///
/// Operators are deterministic: the same operations on the same body give the same body, bit for bit, numbers of new
/// entities included. Serialised as `{"operator_name": {fields}}`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs)]
pub enum Operation {
    /// Several operators as one step, [`Editor::transaction`].
    Group(Vec<Operation>),
    /// [`Editor::add_surface`].
    AddSurface { name: String },
    /// [`Editor::rename_surface`].
    RenameSurface { surface: SurfaceId, name: String },
    /// [`Editor::make_vertex_complex`].
    MakeVertexComplex { surface: SurfaceId, position: DVec3 },
    /// [`Editor::kill_vertex_complex`].
    KillVertexComplex { surface: SurfaceId, node: NodeId },
    /// [`Editor::make_vertex_edge`].
    MakeVertexEdge { surface: SurfaceId, from: NodeId, position: DVec3 },
    /// [`Editor::kill_vertex_edge`].
    KillVertexEdge { surface: SurfaceId, node: NodeId },
    /// [`Editor::make_edge`].
    MakeEdge { surface: SurfaceId, from: NodeId, to: NodeId },
    /// [`Editor::make_edge_chole`].
    MakeEdgeChole { surface: SurfaceId, from: NodeId, to: NodeId },
    /// [`Editor::make_edge_kill_complex`].
    MakeEdgeKillComplex { surface: SurfaceId, from: NodeId, to: NodeId },
    /// [`Editor::kill_edge`].
    KillEdge { surface: SurfaceId, edge: EdgeId },
    /// [`Editor::kill_edge_chole`].
    KillEdgeChole { surface: SurfaceId, edge: EdgeId },
    /// [`Editor::kill_edge_make_complex`].
    KillEdgeMakeComplex { surface: SurfaceId, edge: EdgeId },
    /// [`Editor::make_face`].
    MakeFace { surface: SurfaceId, sides: [EdgeId; 3] },
    /// [`Editor::make_face_kill_chole`].
    MakeFaceKillChole { surface: SurfaceId, sides: [EdgeId; 3] },
    /// [`Editor::make_face_make_cavity`].
    MakeFaceMakeCavity { surface: SurfaceId, sides: [EdgeId; 3] },
    /// [`Editor::kill_face`].
    KillFace { surface: SurfaceId, face: FaceId },
    /// [`Editor::kill_face_make_chole`].
    KillFaceMakeChole { surface: SurfaceId, face: FaceId },
    /// [`Editor::kill_face_kill_cavity`].
    KillFaceKillCavity { surface: SurfaceId, face: FaceId },
    /// [`Editor::split_wire`].
    SplitWire { surface: SurfaceId, edge: EdgeId, at: f64 },
    /// [`Editor::merge_wire`].
    MergeWire { surface: SurfaceId, node: NodeId },
    /// [`Editor::make_vertex_ring`].
    MakeVertexRing { surface: SurfaceId, face: FaceId, areal: [f64; 3] },
    /// [`Editor::kill_vertex_ring`].
    KillVertexRing { surface: SurfaceId, node: AttributeNodeId },
    /// [`Editor::make_edge_kill_ring`].
    MakeEdgeKillRing { surface: SurfaceId, nodes: [AttributeNodeId; 2] },
    /// [`Editor::kill_edge_make_ring`].
    KillEdgeMakeRing { surface: SurfaceId, line: AttributeEdgeId },
    /// [`Editor::make_joint`].
    MakeJoint { joint: JointSpec },
    /// [`Editor::kill_joint`].
    KillJoint { joint: JointId },
    /// [`Editor::move_nodes`].
    MoveNodes { surface: SurfaceId, nodes: Vec<(NodeId, DVec3)> },
    /// [`Editor::store_backup`].
    StoreBackup { surface: SurfaceId },
    /// [`Editor::restore_backup`].
    RestoreBackup { surface: SurfaceId },
    /// [`Editor::set_planar`].
    SetPlanar { surface: SurfaceId, planar: Option<Vec<DVec2>> },
    /// [`Editor::add_attribute_node`].
    AddAttributeNode { surface: SurfaceId, node: AttributeNode },
    /// [`Editor::remove_attribute_node`].
    RemoveAttributeNode { surface: SurfaceId, node: AttributeNodeId },
    /// [`Editor::add_attribute_edge`].
    AddAttributeEdge { surface: SurfaceId, line: AttributeEdge },
    /// [`Editor::remove_attribute_edge`].
    RemoveAttributeEdge { surface: SurfaceId, line: AttributeEdgeId },
    /// [`Editor::set_attributes`].
    SetAttributes { surface: SurfaceId, nodes: Vec<AttributeNode>, lines: Vec<AttributeEdge> },
    /// [`Editor::split_edge`].
    SplitEdge { surface: SurfaceId, edge: EdgeId, at: f64 },
    /// [`Editor::swap_edge`].
    SwapEdge {
        surface: SurfaceId,
        edge: EdgeId,
        #[serde(default)]
        guard: Guard,
    },
    /// [`Editor::collapse_edge`].
    CollapseEdge {
        surface: SurfaceId,
        edge: EdgeId,
        keep: NodeId,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        at: Option<f64>,
        #[serde(default)]
        guard: Guard,
    },
    /// [`Editor::split_face`].
    SplitFace { surface: SurfaceId, face: FaceId },
    /// [`Editor::triangulate_face`].
    TriangulateFace { surface: SurfaceId, face: FaceId },
    /// [`Editor::split_all`]; halves where no midpoints are given.
    SplitAll {
        #[serde(default, skip_serializing_if = "Option::is_none")]
        midpoints: Option<Vec<Vec<DVec3>>>,
    },
    /// [`Editor::resolve_edge`].
    ResolveEdge { joint: JointId, pairing: Pairing },
    /// [`Editor::resolve_node`].
    ResolveNode { surface: SurfaceId, node: NodeId, pairing: Pairing },
    /// [`Editor::compact`].
    Compact,
}

/// What an operation made or found.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum Outcome {
    /// Nothing to name.
    Done,
    Surface(SurfaceId),
    Node(NodeId),
    NodeAndEdge {
        node: NodeId,
        edge: EdgeId,
    },
    Edge {
        edge: EdgeId,
        role: EdgeRole,
    },
    EdgeKilled(EdgeRole),
    /// The edge that is left.
    EdgeMerged(EdgeId),
    Face {
        face: FaceId,
        role: FaceRole,
    },
    FaceKilled(FaceRole),
    AttributeNode(AttributeNodeId),
    AttributeEdge(AttributeEdgeId),
    Joint(JointId),
    /// What would make the joint again.
    JointKilled(JointSpec),
    EdgeSplit(EdgeSplit),
    EdgeCollapsed(EdgeCollapse),
    FaceSplit(FaceSplit),
    FaceTriangulated(FaceTriangulation),
    AllSplit(SplitMap),
    Resolved(Box<Resolution>),
    Compacted(Compaction),
    Group(Vec<Outcome>),
}

/// Why an operation was refused. Nothing is changed then.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)]
pub enum Refusal {
    #[error(transparent)]
    Euler(#[from] EulerError),
    #[error(transparent)]
    Joint(#[from] JointError),
    #[error(transparent)]
    Layer(#[from] LayerError),
    #[error(transparent)]
    SplitEdge(#[from] SplitEdgeError),
    #[error(transparent)]
    SwapEdge(#[from] SwapError),
    #[error(transparent)]
    CollapseEdge(#[from] CollapseError),
    #[error(transparent)]
    SplitFace(#[from] SplitFaceError),
    #[error(transparent)]
    Triangulate(#[from] TriangulateError),
    #[error(transparent)]
    Pairing(#[from] PairingError),
    #[error(transparent)]
    SplitAll(#[from] SplitError),
}

impl Operation {
    /// The Euler operator that was carried out, given what came out of it; `None` for operators that are none.
    pub fn euler(&self, outcome: &Outcome) -> Option<EulerOperator> {
        Some(match self {
            Self::MakeVertexComplex { .. } => EulerOperator::MakeVertexComplex,
            Self::KillVertexComplex { .. } => EulerOperator::KillVertexComplex,
            Self::MakeVertexEdge { .. } => EulerOperator::MakeVertexEdge,
            Self::KillVertexEdge { .. } => EulerOperator::KillVertexEdge,
            Self::SplitWire { .. } => EulerOperator::SplitWire,
            Self::MergeWire { .. } => EulerOperator::MergeWire,
            Self::MakeVertexRing { .. } => EulerOperator::MakeVertexRing,
            Self::KillVertexRing { .. } => EulerOperator::KillVertexRing,
            Self::MakeEdgeKillRing { .. } => EulerOperator::MakeEdgeKillRing,
            Self::KillEdgeMakeRing { .. } => EulerOperator::KillEdgeMakeRing,
            Self::MakeEdge { .. }
            | Self::MakeEdgeChole { .. }
            | Self::MakeEdgeKillComplex { .. }
            | Self::KillEdge { .. }
            | Self::KillEdgeChole { .. }
            | Self::KillEdgeMakeComplex { .. }
            | Self::MakeFace { .. }
            | Self::MakeFaceKillChole { .. }
            | Self::MakeFaceMakeCavity { .. }
            | Self::KillFace { .. }
            | Self::KillFaceMakeChole { .. }
            | Self::KillFaceKillCavity { .. } => match outcome {
                Outcome::Edge { role, .. } => role.made_by(),
                Outcome::EdgeKilled(role) => role.made_by().inverse(),
                Outcome::Face { role, .. } => role.made_by(),
                Outcome::FaceKilled(role) => role.made_by().inverse(),
                _ => return None,
            },
            _ => return None,
        })
    }
}

impl Editor {
    /// Carries out an operation.
    ///
    /// # Errors
    /// Those of its operator; nothing is changed then, and of a group nothing is done.
    pub fn apply(&mut self, operation: &Operation) -> Result<Outcome, Refusal> {
        use Operation as Op;
        Ok(match *operation {
            Op::Group(ref all) => {
                let done = self.transaction(|e| all.iter().map(|o| e.apply(o)).collect::<Result<_, _>>());
                Outcome::Group(done?)
            }
            Op::AddSurface { ref name } => Outcome::Surface(self.add_surface(name)),
            Op::RenameSurface { surface, ref name } => self.rename_surface(surface, name)?.into(),
            Op::MakeVertexComplex { surface, position } => {
                Outcome::Node(self.make_vertex_complex(surface, position)?)
            }
            Op::KillVertexComplex { surface, node } => self.kill_vertex_complex(surface, node)?.into(),
            Op::MakeVertexEdge { surface, from, position } => {
                let (node, edge) = self.make_vertex_edge(surface, from, position)?;
                Outcome::NodeAndEdge { node, edge }
            }
            Op::KillVertexEdge { surface, node } => self.kill_vertex_edge(surface, node)?.into(),
            Op::MakeEdge { surface, from, to } => {
                let (edge, role) = self.make_edge(surface, from, to)?;
                Outcome::Edge { edge, role }
            }
            Op::MakeEdgeChole { surface, from, to } => {
                let edge = self.make_edge_chole(surface, from, to)?;
                Outcome::Edge { edge, role: EdgeRole::Cycle }
            }
            Op::MakeEdgeKillComplex { surface, from, to } => {
                let edge = self.make_edge_kill_complex(surface, from, to)?;
                Outcome::Edge { edge, role: EdgeRole::Bridge }
            }
            Op::KillEdge { surface, edge } => Outcome::EdgeKilled(self.kill_edge(surface, edge)?),
            Op::KillEdgeChole { surface, edge } => {
                self.kill_edge_chole(surface, edge)?;
                Outcome::EdgeKilled(EdgeRole::Cycle)
            }
            Op::KillEdgeMakeComplex { surface, edge } => {
                self.kill_edge_make_complex(surface, edge)?;
                Outcome::EdgeKilled(EdgeRole::Bridge)
            }
            Op::MakeFace { surface, sides } => {
                let (face, role) = self.make_face(surface, sides)?;
                Outcome::Face { face, role }
            }
            Op::MakeFaceKillChole { surface, sides } => {
                let face = self.make_face_kill_chole(surface, sides)?;
                Outcome::Face { face, role: FaceRole::Filling }
            }
            Op::MakeFaceMakeCavity { surface, sides } => {
                let face = self.make_face_make_cavity(surface, sides)?;
                Outcome::Face { face, role: FaceRole::Closing }
            }
            Op::KillFace { surface, face } => Outcome::FaceKilled(self.kill_face(surface, face)?),
            Op::KillFaceMakeChole { surface, face } => {
                self.kill_face_make_chole(surface, face)?;
                Outcome::FaceKilled(FaceRole::Filling)
            }
            Op::KillFaceKillCavity { surface, face } => {
                self.kill_face_kill_cavity(surface, face)?;
                Outcome::FaceKilled(FaceRole::Closing)
            }
            Op::SplitWire { surface, edge, at } => {
                let (node, edge) = self.split_wire(surface, edge, at)?;
                Outcome::NodeAndEdge { node, edge }
            }
            Op::MergeWire { surface, node } => Outcome::EdgeMerged(self.merge_wire(surface, node)?),
            Op::MakeVertexRing { surface, face, areal } => {
                Outcome::AttributeNode(self.make_vertex_ring(surface, face, areal)?)
            }
            Op::KillVertexRing { surface, node } => self.kill_vertex_ring(surface, node)?.into(),
            Op::MakeEdgeKillRing { surface, nodes } => {
                Outcome::AttributeEdge(self.make_edge_kill_ring(surface, nodes)?)
            }
            Op::KillEdgeMakeRing { surface, line } => self.kill_edge_make_ring(surface, line)?.into(),
            Op::MakeJoint { ref joint } => Outcome::Joint(self.make_joint(joint)?),
            Op::KillJoint { joint } => Outcome::JointKilled(self.kill_joint(joint)?),
            Op::MoveNodes { surface, ref nodes } => self.move_nodes(surface, nodes)?.into(),
            Op::StoreBackup { surface } => self.store_backup(surface)?.into(),
            Op::RestoreBackup { surface } => self.restore_backup(surface)?.into(),
            Op::SetPlanar { surface, ref planar } => self.set_planar(surface, planar.clone())?.into(),
            Op::AddAttributeNode { surface, node } => {
                Outcome::AttributeNode(self.add_attribute_node(surface, node)?)
            }
            Op::RemoveAttributeNode { surface, node } => self.remove_attribute_node(surface, node)?.into(),
            Op::AddAttributeEdge { surface, ref line } => {
                Outcome::AttributeEdge(self.add_attribute_edge(surface, line.clone())?)
            }
            Op::RemoveAttributeEdge { surface, line } => self.remove_attribute_edge(surface, line)?.into(),
            Op::SetAttributes { surface, ref nodes, ref lines } => {
                self.set_attributes(surface, nodes, lines)?.into()
            }
            Op::SplitEdge { surface, edge, at } => Outcome::EdgeSplit(self.split_edge(surface, edge, at)?),
            Op::SwapEdge { surface, edge, guard } => self.swap_edge(surface, edge, guard)?.into(),
            Op::CollapseEdge { surface, edge, keep, at, guard } => {
                let options = CollapseOptions { at, guard };
                Outcome::EdgeCollapsed(self.collapse_edge(surface, edge, keep, &options)?)
            }
            Op::SplitFace { surface, face } => Outcome::FaceSplit(self.split_face(surface, face)?),
            Op::TriangulateFace { surface, face } => {
                Outcome::FaceTriangulated(self.triangulate_face(surface, face)?)
            }
            Op::SplitAll { ref midpoints } => Outcome::AllSplit(self.split_all(midpoints.as_deref())?),
            Op::ResolveEdge { joint, pairing } => {
                Outcome::Resolved(Box::new(self.resolve_edge(joint, pairing)?))
            }
            Op::ResolveNode { surface, node, pairing } => {
                Outcome::Resolved(Box::new(self.resolve_node(surface, node, pairing)?))
            }
            Op::Compact => Outcome::Compacted(self.compact()),
        })
    }
}

impl From<()> for Outcome {
    fn from((): ()) -> Self {
        Self::Done
    }
}
