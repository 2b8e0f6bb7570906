//! A body as it stands in the file, and back.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::error::{BodyFileError, check_sound};
use super::{BODY_FILE_VERSION, FORMAT, check_format};
use crate::body::joint::{JointUse, Sheet, Side};
use crate::body::slots::{Slots, SurfaceSlots};
use crate::body::surface::{NO_CHAIN, chain_slot};
use crate::body::{
    AttributeEdge, AttributeNode, AttributeNodeId, Body, Chain, ChainId, Defect, DirectedEdge, EdgeId,
    FaceId, Joint, JointId, Loop, LoopId, NONE, NodeId, Surface, SurfaceId,
};

/// Most edges of a surface: [`DirectedEdge`] has a bit less.
const MOST_EDGES: usize = (1 << 31) - 1;
/// Most of everything else: [`NONE`] names nothing.
const MOST: usize = NONE as usize - 1;

/// A file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BodyRecord {
    format: String,
    version: u64,
    surfaces: Vec<SurfaceRecord>,
    #[serde(default)]
    joints: Vec<Option<JointRecord>>,
    #[serde(default)]
    free_joints: Vec<u32>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SurfaceRecord {
    name: String,
    positions: Vec<[f64; 3]>,
    #[serde(default)]
    backup: Vec<[f64; 3]>,
    #[serde(default)]
    planar: Vec<[f64; 2]>,
    /// Nodes; nothing under a free number.
    edges: Vec<Option<[u32; 2]>>,
    /// Sides as [`signed`] writes them.
    faces: Vec<Option<[i64; 3]>>,
    #[serde(default)]
    chains: Vec<Option<ChainRecord>>,
    #[serde(default)]
    loops: Vec<Vec<u32>>,
    #[serde(default)]
    attribute_nodes: Vec<AttributeRecord>,
    #[serde(default)]
    attribute_edges: Vec<LineRecord>,
    #[serde(default)]
    free: FreeRecord,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ChainRecord {
    start: u32,
    /// As [`signed`] writes them.
    edges: Vec<i64>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct JointRecord {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    uses: Vec<UseRecord>,
    radial: Vec<(u32, SideRecord)>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct UseRecord {
    surface: u32,
    chain: u32,
    reversed: bool,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum SideRecord {
    Left,
    Right,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub(super) enum AttributeRecord {
    OnEdge { edge: u32, u: f64 },
    InFace { face: u32, areal: [f64; 3] },
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LineRecord {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    nodes: Vec<u32>,
}

/// Free numbers, the one given next last.
#[derive(Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FreeRecord {
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    nodes: Vec<u32>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    edges: Vec<u32>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    faces: Vec<u32>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    chains: Vec<u32>,
}

/// A directed edge: its number, or −1 − its number where it is run over from its second node to its first.
pub(super) fn signed(d: DirectedEdge) -> i64 {
    let e = i64::from(d.edge().0);
    if d.is_reversed() { -1 - e } else { e }
}

/// The edge that [`signed`] wrote, if there is one of that number.
fn directed(
    written: i64,
    edges: &[[u32; 2]],
    of: impl Fn() -> String,
) -> Result<DirectedEdge, BodyFileError> {
    let number = if written < 0 { -1 - written } else { written };
    match usize::try_from(number).ok().and_then(|e| edges.get(e)) {
        Some(ends) if ends[0] != NONE => Ok(DirectedEdge::new(EdgeId(number as u32), written < 0)),
        _ => {
            let id = u32::try_from(number).unwrap_or(NONE);
            Err(BodyFileError::UnknownId { of: of(), what: "edge", id, limit: edges.len() })
        }
    }
}

impl ChainRecord {
    pub(super) fn of(chain: &Chain) -> Option<Self> {
        let edges = || chain.edges.iter().map(|&d| signed(d)).collect();
        (!chain.is_free()).then(|| Self { start: chain.start.0, edges: edges() })
    }
}

impl JointRecord {
    pub(super) fn of(joint: &Joint) -> Option<Self> {
        let of_use =
            |u: &JointUse| UseRecord { surface: u.surface.0, chain: u.chain.0, reversed: u.reversed };
        let sheet = |s: &Sheet| {
            let side = if s.side == Side::Left { SideRecord::Left } else { SideRecord::Right };
            (s.use_index, side)
        };
        (!joint.uses.is_empty()).then(|| Self {
            name: joint.name.clone(),
            uses: joint.uses.iter().map(of_use).collect(),
            radial: joint.radial.iter().map(sheet).collect(),
        })
    }

    fn into_joint(self) -> Joint {
        let side = |s: SideRecord| if matches!(s, SideRecord::Left) { Side::Left } else { Side::Right };
        Joint {
            name: self.name,
            uses: self
                .uses
                .into_iter()
                .map(|u| JointUse {
                    surface: SurfaceId(u.surface),
                    chain: ChainId(u.chain),
                    reversed: u.reversed,
                })
                .collect(),
            radial: self
                .radial
                .into_iter()
                .map(|(use_index, s)| Sheet { use_index, side: side(s) })
                .collect(),
        }
    }
}

impl AttributeRecord {
    pub(super) fn of(node: &AttributeNode) -> Self {
        match *node {
            AttributeNode::OnEdge { edge, u } => Self::OnEdge { edge: edge.0, u },
            AttributeNode::InFace { face, areal } => Self::InFace { face: face.0, areal },
        }
    }

    fn into_node(self) -> AttributeNode {
        match self {
            Self::OnEdge { edge, u } => AttributeNode::OnEdge { edge: EdgeId(edge), u },
            Self::InFace { face, areal } => AttributeNode::InFace { face: FaceId(face), areal },
        }
    }
}

impl LineRecord {
    pub(super) fn of(line: &AttributeEdge) -> Self {
        Self { name: line.name.clone(), nodes: line.nodes.iter().map(|n| n.0).collect() }
    }
}

impl FreeRecord {
    pub(super) fn of(slots: &SurfaceSlots) -> Self {
        let [nodes, edges, faces, chains] =
            [&slots.nodes, &slots.edges, &slots.faces, &slots.chains].map(|s| s.free().to_vec());
        Self { nodes, edges, faces, chains }
    }
}

/// Free numbers of an array that is `len` long.
fn slots(
    free: Vec<u32>,
    len: usize,
    what: &'static str,
    of: impl Fn() -> String,
) -> Result<Slots, BodyFileError> {
    match free.iter().find(|&&id| id as usize >= len) {
        Some(&id) => Err(BodyFileError::UnknownId { of: of(), what, id, limit: len }),
        None => Ok(Slots::from_free(free)),
    }
}

impl BodyRecord {
    pub(crate) fn into_body(self) -> Result<Body, BodyFileError> {
        check_format(Some(&self.format), Some(self.version), FORMAT, BODY_FILE_VERSION)?;
        let mut body = Body::default();
        for (i, record) in self.surfaces.into_iter().enumerate() {
            body.surfaces.push(record.into_surface(SurfaceId(i as u32))?);
        }
        if let Some(j) = self.joints.iter().position(|j| j.as_ref().is_some_and(|j| j.uses.is_empty())) {
            let first = vec![Defect::TooFewUses { joint: JointId(j as u32), uses: 0 }];
            return Err(BodyFileError::Unsound { count: 1, first });
        }
        let free = Joint { name: None, uses: Vec::new(), radial: Vec::new() };
        body.joints =
            self.joints.into_iter().map(|j| j.map_or(free.clone(), JointRecord::into_joint)).collect();
        body.joint_slots =
            slots(self.free_joints, body.joints.len(), "joint", || "the list of free joints".into())?;
        for (j, joint) in body.joints.iter().enumerate() {
            for u in &joint.uses {
                // What names nothing the check finds; of two joints on a chain it finds the second.
                let chains = body.surfaces.get_mut(u.surface.index()).map(|s| &mut s.chains);
                if let Some(chain) = chains.and_then(|c| c.get_mut(u.chain.index())) {
                    chain.joint.get_or_insert(JointId(j as u32));
                }
            }
        }
        check_sound(&body)?;
        Ok(body)
    }
}

impl SurfaceRecord {
    fn check_lengths(&self, surface: SurfaceId) -> Result<(), BodyFileError> {
        let nodes = self.positions.len();
        for (array, len) in [("backup positions", self.backup.len()), ("planar positions", self.planar.len())]
        {
            if len != 0 && len != nodes {
                return Err(BodyFileError::Length { surface, array, len, nodes });
            }
        }
        for (what, count, limit) in [
            ("nodes", nodes, MOST),
            ("edges", self.edges.len(), MOST_EDGES),
            ("faces", self.faces.len(), MOST),
            ("chains", self.chains.len(), MOST),
            ("loops", self.loops.len(), MOST),
            ("attribute nodes", self.attribute_nodes.len(), MOST),
            ("attribute edges", self.attribute_edges.len(), MOST),
        ] {
            if count > limit {
                return Err(BodyFileError::TooMany { surface, what, count, limit });
            }
        }
        Ok(())
    }

    /// Edges and chains name nodes. (A number that stands for nothing would pass for a free entry later.)
    fn check_nodes(&self, surface: SurfaceId) -> Result<(), BodyFileError> {
        let limit = self.positions.len();
        let node = |what: &str, number: usize, id: u32| {
            if (id as usize) < limit {
                return Ok(());
            }
            let of = format!("surface {surface}: {what} {number}");
            Err(BodyFileError::UnknownId { of, what: "node", id, limit })
        };
        for (e, ends) in self.edges.iter().enumerate() {
            ends.iter().flatten().try_for_each(|&v| node("edge", e, v))?;
        }
        for (c, chain) in self.chains.iter().enumerate() {
            chain.iter().try_for_each(|chain| node("chain", c, chain.start))?;
        }
        Ok(())
    }

    fn into_surface(self, id: SurfaceId) -> Result<Surface, BodyFileError> {
        self.check_lengths(id)?;
        self.check_nodes(id)?;
        let free = |kind: &'static str| move || format!("surface {id}: the list of free {kind}s");
        let mut s = Surface {
            name: self.name,
            positions: self.positions.into_iter().map(DVec3::from_array).collect(),
            backup: self.backup.into_iter().map(DVec3::from_array).collect(),
            planar: self.planar.into_iter().map(DVec2::from_array).collect(),
            edges: self.edges.into_iter().map(|ends| ends.unwrap_or([NONE; 2])).collect(),
            loops: self
                .loops
                .into_iter()
                .map(|l| Loop { chains: l.into_iter().map(ChainId).collect() })
                .collect(),
            attribute_nodes: self.attribute_nodes.into_iter().map(AttributeRecord::into_node).collect(),
            attribute_edges: self
                .attribute_edges
                .into_iter()
                .map(|l| AttributeEdge {
                    name: l.name,
                    nodes: l.nodes.into_iter().map(AttributeNodeId).collect(),
                })
                .collect(),
            ..Surface::default()
        };
        s.slots = SurfaceSlots {
            nodes: slots(self.free.nodes, s.positions.len(), "node", free("node"))?,
            edges: slots(self.free.edges, s.edges.len(), "edge", free("edge"))?,
            faces: slots(self.free.faces, self.faces.len(), "face", free("face"))?,
            chains: slots(self.free.chains, self.chains.len(), "chain", free("chain"))?,
        };
        s.edge_faces = vec![[NONE; 2]; s.edges.len()];
        s.edge_chain = vec![NO_CHAIN; s.edges.len()];
        for (f, sides) in self.faces.into_iter().enumerate() {
            let (mut corners, mut edges) = ([NONE; 3], [NONE; 3]);
            for (i, written) in sides.iter().flatten().enumerate() {
                let d = directed(*written, &s.edges, || format!("surface {id}: face {f}"))?;
                corners[i] = s.ends(d)[0].0;
                edges[i] = d.edge().0;
                // Of two faces on one side of an edge the check finds the second.
                let there = &mut s.edge_faces[d.edge().index()][usize::from(d.is_reversed())];
                if *there == NONE {
                    *there = f as u32;
                }
            }
            s.faces.push(corners);
            s.face_edges.push(edges);
        }
        for (c, record) in self.chains.into_iter().enumerate() {
            let Some(record) = record else {
                s.chains.push(Chain::FREE);
                continue;
            };
            let mut edges = Vec::with_capacity(record.edges.len());
            for written in record.edges {
                let d = directed(written, &s.edges, || format!("surface {id}: chain {c}"))?;
                s.edge_chain[d.edge().index()] = chain_slot(ChainId(c as u32));
                edges.push(d);
            }
            s.chains.push(Chain { start: NodeId(record.start), edges, on_loop: None, joint: None });
        }
        for (l, cycle) in s.loops.iter().enumerate() {
            for c in &cycle.chains {
                if let Some(chain) = s.chains.get_mut(c.index()) {
                    chain.on_loop.get_or_insert(LoopId(l as u32));
                }
            }
        }
        Ok(s)
    }
}
