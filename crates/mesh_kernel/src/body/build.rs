//! Making a body from patches and the chains where they meet.

use std::collections::BTreeMap;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::Body;
use super::chain::{Chain, Loop};
use super::ids::{ChainId, DirectedEdge, EdgeId, JointId, LoopId, NONE, NodeId, SurfaceId};
use super::joint::{Joint, JointUse};
use super::surface::{Surface, chain_slot};

/// Nodes that a joint holds together may be given this far apart, in millimetres; they are then made equal. It covers
/// rounding of a formula evaluated twice, nothing that a person could mean.
pub const JOINT_SNAP: f64 = 1e-6;

/// A patch to build a surface from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceSpec {
    /// Name.
    pub name: String,
    /// Node positions, in millimetres.
    pub positions: Vec<DVec3>,
    /// Faces, wound alike.
    pub faces: Vec<[u32; 3]>,
}

/// Chains to be joined.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JointSpec {
    /// Name.
    pub name: Option<String>,
    /// Two or more chains of equal length.
    pub chains: Vec<ChainSpec>,
}

/// A chain by its nodes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ChainSpec {
    /// Index of the surface in the list given to [`Body::build`].
    pub surface: usize,
    /// Nodes in the joint's direction, every two in a row joined by an edge. A single node makes surfaces touch there.
    pub nodes: Vec<u32>,
    /// Whether an edge leads from the last node back to the first (which is not named twice then).
    pub closed: bool,
}

/// Why no body could be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BuildError {
    /// A face names a node that does not exist.
    #[error("surface `{surface}`: face {face} names node {node}, but the surface has {nodes} nodes")]
    NodeOutOfRange {
        /// Surface.
        surface: String,
        /// Face.
        face: u32,
        /// The node named.
        node: u32,
        /// How many there are.
        nodes: usize,
    },
    /// A face names one node twice.
    #[error("surface `{surface}`: face {face} {nodes:?} names one node twice; remove it")]
    RepeatedNode {
        /// Surface.
        surface: String,
        /// Face.
        face: u32,
        /// Its nodes.
        nodes: [u32; 3],
    },
    /// A triangle of a mesh names one node twice.
    #[error(
        "triangle {triangle}{} of the mesh has the nodes {}, {}, {} (counted from 1), one of them twice; remove it",
        if group.is_empty() { String::new() } else { format!(", in group `{group}`,") },
        nodes[0],
        nodes[1],
        nodes[2]
    )]
    RepeatedCorner {
        /// The group.
        group: String,
        /// The triangle, counted from 1 through the whole mesh.
        triangle: usize,
        /// Its nodes, likewise.
        nodes: [usize; 3],
    },
    /// A coordinate is not a finite number.
    #[error("surface `{surface}`: node {node} has a coordinate that is no finite number: {position}")]
    NotFinite {
        /// Surface.
        surface: String,
        /// Node.
        node: u32,
        /// Its position.
        position: DVec3,
    },
    /// Two faces run over an edge in the same direction: wound differently, or a third face.
    #[error(
        "surface `{surface}`: faces {faces:?} run over the edge of nodes {nodes:?} in the same direction; turn one round, \
         or where three faces meet put them on surfaces of their own with a joint"
    )]
    EdgeConflict {
        /// Surface.
        surface: String,
        /// The two faces.
        faces: [u32; 2],
        /// The edge's nodes.
        nodes: [u32; 2],
    },
    /// More nodes, edges or faces than ids.
    #[error("surface `{surface}` has {faces} faces and {nodes} nodes, more than 32-bit ids can number")]
    TooLarge {
        /// Surface.
        surface: String,
        /// Faces.
        faces: usize,
        /// Nodes.
        nodes: usize,
    },
    /// A chain names an unknown surface.
    #[error("joint {joint}: a chain names surface {surface}, which does not exist")]
    NoSurface {
        /// Joint.
        joint: JointLabel,
        /// The number named.
        surface: usize,
    },
    /// A chain has no nodes, or a joint less than two chains.
    #[error("joint {joint} needs two chains or more, each with a node or more")]
    TooFew {
        /// Joint.
        joint: JointLabel,
    },
    /// Two nodes of a chain in a row have no edge.
    #[error("joint {joint}: surface `{surface}` has no edge between its nodes {nodes:?}")]
    NoEdge {
        /// Joint.
        joint: JointLabel,
        /// Surface.
        surface: String,
        /// The nodes.
        nodes: [u32; 2],
    },
    /// Chains of different length.
    #[error("joint {joint}: its chains have {lengths:?} edges; they must be equal")]
    Lengths {
        /// Joint.
        joint: JointLabel,
        /// Edges of every chain.
        lengths: Vec<usize>,
    },
    /// Nodes that should coincide do not.
    #[error(
        "joint {joint}: node {node} of surface `{surface}` is {distance} mm from node {other_node} of surface \
         `{other}`; nodes of a joint must coincide"
    )]
    NodesApart {
        /// Joint.
        joint: JointLabel,
        /// Surface.
        surface: String,
        /// Node.
        node: u32,
        /// The other surface.
        other: String,
        /// Its node.
        other_node: u32,
        /// Distance, in millimetres.
        distance: f64,
    },
    /// An edge in two joints, or twice in one.
    #[error(
        "joint {joint}: the edge of nodes {nodes:?} on surface `{surface}` lies on joint {other} already"
    )]
    EdgeTaken {
        /// Joint.
        joint: JointLabel,
        /// Surface.
        surface: String,
        /// The edge's nodes.
        nodes: [u32; 2],
        /// The joint that has it.
        other: JointLabel,
    },
    /// A chain that is partly on the boundary and partly not, or on two loops, or turns back on one.
    #[error(
        "joint {joint}: on surface `{surface}` the chain leaves the boundary loop, or enters it, at node {node}; make a \
         joint of each part"
    )]
    MixedChain {
        /// Joint.
        joint: JointLabel,
        /// Surface.
        surface: String,
        /// Where.
        node: u32,
    },
}

/// A joint in an error: its name where it has one, else its number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointLabel {
    /// Index in the list given.
    pub index: usize,
    /// Name.
    pub name: Option<String>,
}

impl std::fmt::Display for JointLabel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match &self.name {
            Some(name) => write!(f, "`{name}`"),
            None => write!(f, "number {}", self.index),
        }
    }
}

/// A use of a joint before loops and chains are made.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    pub(crate) surface: u32,
    pub(crate) start: u32,
    pub(crate) edges: Vec<DirectedEdge>,
}

/// A joint before loops and chains are made.
#[derive(Clone, Debug)]
pub(crate) struct RunJoint {
    pub(crate) name: Option<String>,
    pub(crate) runs: Vec<Run>,
}

impl Body {
    /// Builds a body from patches and the chains where they meet.
    ///
    /// The order of surfaces and joints stays: surface `i` gets `SurfaceId(i)`, joint `i` `JointId(i)`. Boundary loops
    /// are found and cut into chains where joints end; sheets are ordered about their joints by exact predicates
    /// (see [`Joint::radial`]). Nodes held together by joints get equal positions (see [`JOINT_SNAP`]).
    ///
    /// # Errors
    /// See [`BuildError`]; nothing is repaired silently. O(faces + joint edges).
    pub fn build(surfaces: &[SurfaceSpec], joints: &[JointSpec]) -> Result<Self, BuildError> {
        let built: Vec<Surface> = surfaces.iter().map(build_surface).collect::<Result<_, _>>()?;
        let mut indices = BTreeMap::new();
        let mut runs = Vec::with_capacity(joints.len());
        for (j, spec) in joints.iter().enumerate() {
            let label = JointLabel { index: j, name: spec.name.clone() };
            let mut joint = RunJoint { name: spec.name.clone(), runs: Vec::with_capacity(spec.chains.len()) };
            for chain in &spec.chains {
                let Some(surface) = built.get(chain.surface) else {
                    return Err(BuildError::NoSurface { joint: label, surface: chain.surface });
                };
                let index = indices.entry(chain.surface).or_insert_with(|| surface.edge_index());
                joint.runs.push(run_of(surface, index, chain, &label)?);
            }
            runs.push(joint);
        }
        Self::assemble(built, runs)
    }

    /// Loops, chains, joints and radial orders for surfaces that have their edges.
    pub(crate) fn assemble(surfaces: Vec<Surface>, joints: Vec<RunJoint>) -> Result<Self, BuildError> {
        let mut body = Body { surfaces, joints: Vec::with_capacity(joints.len()), ..Body::default() };
        let labels: Vec<JointLabel> =
            joints.iter().enumerate().map(|(index, j)| JointLabel { index, name: j.name.clone() }).collect();
        let cycles: Vec<_> = body.surfaces.iter().map(Surface::boundary_cycles).collect();
        let places: Vec<LoopPlaces> =
            body.surfaces.iter().zip(&cycles).map(|(s, c)| LoopPlaces::new(s.edges.len(), c)).collect();
        for (j, joint) in joints.into_iter().enumerate() {
            let lengths: Vec<usize> = joint.runs.iter().map(|r| r.edges.len()).collect();
            if lengths.len() < 2 {
                return Err(BuildError::TooFew { joint: labels[j].clone() });
            }
            if lengths.iter().any(|&n| n != lengths[0]) {
                return Err(BuildError::Lengths { joint: labels[j].clone(), lengths });
            }
            let mut uses = Vec::with_capacity(joint.runs.len());
            for run in joint.runs {
                let surface = &mut body.surfaces[run.surface as usize];
                uses.push(place_run(surface, &places[run.surface as usize], run, j, &labels)?);
            }
            body.joints.push(Joint { name: joint.name, uses, radial: Vec::new() });
        }
        for (surface, cycles) in body.surfaces.iter_mut().zip(&cycles) {
            for cycle in cycles {
                make_loop(surface, cycle);
            }
        }
        body.meet(&labels)?;
        for j in 0..body.joints.len() {
            body.order_joint(JointId(j as u32));
        }
        Ok(body)
    }

    /// Makes nodes that joints hold together equal, where they are within [`JOINT_SNAP`].
    pub(super) fn meet(&mut self, labels: &[JointLabel]) -> Result<(), BuildError> {
        for (j, label) in labels.iter().enumerate() {
            let joint = JointId(j as u32);
            let Some(&first_use) = self.joints[j].uses.first() else { continue };
            let first = self.joint_nodes(joint, 0);
            for i in 1..self.joints[j].uses.len() {
                let own = self.joints[j].uses[i];
                for (&a, &b) in first.iter().zip(&self.joint_nodes(joint, i)) {
                    let [s, t] = [first_use.surface, own.surface].map(|s| &self.surfaces[s.index()]);
                    let distance = s.positions[a as usize].distance(t.positions[b as usize]);
                    if distance > JOINT_SNAP {
                        return Err(BuildError::NodesApart {
                            joint: label.clone(),
                            surface: s.name.clone(),
                            node: a,
                            other: t.name.clone(),
                            other_node: b,
                            distance,
                        });
                    }
                }
            }
        }
        self.sync_joints();
        Ok(())
    }
}

/// A surface with its edges, without loops.
fn build_surface(spec: &SurfaceSpec) -> Result<Surface, BuildError> {
    let name = || spec.name.clone();
    let (nodes, faces) = (spec.positions.len(), spec.faces.len());
    if nodes >= NONE as usize || faces >= (1 << 31) / 3 {
        return Err(BuildError::TooLarge { surface: name(), faces, nodes });
    }
    for (f, face) in spec.faces.iter().enumerate() {
        if let Some(&node) = face.iter().find(|&&v| v as usize >= nodes) {
            return Err(BuildError::NodeOutOfRange { surface: name(), face: f as u32, node, nodes });
        }
        let [a, b, c] = *face;
        if a == b || b == c || c == a {
            return Err(BuildError::RepeatedNode { surface: name(), face: f as u32, nodes: *face });
        }
    }
    if let Some(v) = spec.positions.iter().position(|p| !p.is_finite()) {
        return Err(BuildError::NotFinite { surface: name(), node: v as u32, position: spec.positions[v] });
    }
    let mut surface = Surface {
        name: name(),
        positions: spec.positions.clone(),
        faces: spec.faces.clone(),
        ..Surface::default()
    };
    surface.build_edges().map_err(|c| conflict(spec, c))?;
    Ok(surface)
}

fn conflict(spec: &SurfaceSpec, c: super::adjacency::SideConflict) -> BuildError {
    let [f, g] = [c.face, c.same_way].map(|f| spec.faces[f as usize]);
    let sides = |f: [u32; 3]| [[f[0], f[1]], [f[1], f[2]], [f[2], f[0]]];
    let nodes = sides(f).into_iter().find(|s| sides(g).contains(s)).unwrap_or([f[0], f[1]]);
    BuildError::EdgeConflict { surface: spec.name.clone(), faces: [c.same_way, c.face], nodes }
}

pub(super) fn run_of(
    surface: &Surface,
    index: &super::adjacency::EdgeIndex,
    chain: &ChainSpec,
    label: &JointLabel,
) -> Result<Run, BuildError> {
    let mut nodes = chain.nodes.clone();
    let Some(&start) = nodes.first() else { return Err(BuildError::TooFew { joint: label.clone() }) };
    if chain.closed && nodes.last() != Some(&start) {
        nodes.push(start);
    }
    let missing = |nodes| BuildError::NoEdge { joint: label.clone(), surface: surface.name.clone(), nodes };
    if let Some(&v) = nodes.iter().find(|&&v| !surface.is_node(NodeId(v))) {
        return Err(missing([v, v]));
    }
    let mut edges = Vec::with_capacity(nodes.len());
    for pair in nodes.windows(2) {
        let e = index.find(pair[0], pair[1]).ok_or_else(|| missing([pair[0], pair[1]]))?;
        edges.push(DirectedEdge::new(e, surface.edges[e.index()][0] != pair[0]));
    }
    Ok(Run { surface: chain.surface as u32, start, edges })
}

/// Which loop every edge is on and where.
pub(super) struct LoopPlaces {
    of_edge: Vec<u32>,
    at: Vec<u32>,
    lengths: Vec<u32>,
}

impl LoopPlaces {
    pub(super) fn new(edges: usize, cycles: &[Vec<DirectedEdge>]) -> Self {
        let (mut of_edge, mut at) = (vec![NONE; edges], vec![0; edges]);
        for (l, cycle) in cycles.iter().enumerate() {
            for (i, d) in cycle.iter().enumerate() {
                of_edge[d.edge().index()] = l as u32;
                at[d.edge().index()] = i as u32;
            }
        }
        Self { of_edge, at, lengths: cycles.iter().map(|c| c.len() as u32).collect() }
    }
}

/// Makes a chain of a run: in its loop's direction where it is on one, as given where it is inside.
pub(super) fn place_run(
    surface: &mut Surface,
    places: &LoopPlaces,
    run: Run,
    joint: usize,
    labels: &[JointLabel],
) -> Result<JointUse, BuildError> {
    let mixed = |d: DirectedEdge| BuildError::MixedChain {
        joint: labels[joint].clone(),
        surface: surface.name.clone(),
        node: surface.ends(d)[0].0,
    };
    let reversed = match run.edges.first() {
        Some(&first) => {
            let on = places.of_edge[first.edge().index()];
            let bare = |d: DirectedEdge| surface.edge_faces[d.edge().index()] == [NONE; 2];
            let backwards = on != NONE && surface.face_left(first) == NONE;
            for pair in run.edges.windows(2) {
                let step = |d: DirectedEdge| {
                    let back = on != NONE && surface.face_left(d) == NONE;
                    (places.of_edge[d.edge().index()], back, bare(d))
                };
                if step(pair[0]) != step(pair[1]) {
                    return Err(mixed(pair[1]));
                }
                if on != NONE {
                    let [p, q] = [pair[0], pair[1]].map(|d| places.at[d.edge().index()]);
                    let (p, q) = if backwards { (q, p) } else { (p, q) };
                    if (p + 1) % places.lengths[on as usize] != q {
                        return Err(mixed(pair[1]));
                    }
                }
            }
            backwards
        }
        None => false,
    };
    let id = ChainId(surface.slots.chains.next(surface.chains.len()));
    for d in &run.edges {
        if let Some(taken) = surface.edge_chain(d.edge()) {
            let other = surface.chains.get(taken.index()).and_then(|c| c.joint).map_or(joint, JointId::index);
            return Err(BuildError::EdgeTaken {
                joint: labels[joint].clone(),
                surface: surface.name.clone(),
                nodes: surface.edges[d.edge().index()],
                other: labels[other].clone(),
            });
        }
        surface.edge_chain[d.edge().index()] = chain_slot(id);
    }
    let mut edges = run.edges;
    let mut start = NodeId(run.start);
    if reversed {
        if let Some(&last) = edges.last() {
            start = surface.ends(last)[1];
        }
        edges.reverse();
        edges.iter_mut().for_each(|d| *d = d.flipped());
    }
    let chain = Chain { start, edges, on_loop: None, joint: Some(JointId(joint as u32)) };
    match surface.slots.chains.take() {
        Some(free) => surface.chains[free as usize] = chain,
        None => surface.chains.push(chain),
    }
    Ok(JointUse { surface: SurfaceId(run.surface), chain: id, reversed })
}

/// Cuts a boundary cycle into the chains of joints and, between them, free chains.
pub(super) fn make_loop(surface: &mut Surface, cycle: &[DirectedEdge]) {
    let id = LoopId(surface.loops.len() as u32);
    let chain_at = |surface: &Surface, i: usize| surface.edge_chain(cycle[i].edge());
    // Start where a joint's chain starts, so that no chain is cut by the start of the cycle.
    let starts = |surface: &Surface, i: usize| {
        let c = chain_at(surface, i);
        c.is_some_and(|c| surface.chain(c).edges[0] == cycle[i])
    };
    let begin = (0..cycle.len()).find(|&i| starts(surface, i)).unwrap_or(0);
    let mut chains = Vec::new();
    let mut i = 0;
    while i < cycle.len() {
        let at = (begin + i) % cycle.len();
        let c = chain_at(surface, at);
        if let Some(c) = c {
            let chain = &mut surface.chains[c.index()];
            chain.on_loop = Some(id);
            chains.push(c);
            i += chain.edges.len();
            continue;
        }
        let new = ChainId(surface.chains.len() as u32);
        let mut edges = Vec::new();
        while i < cycle.len() && chain_at(surface, (begin + i) % cycle.len()).is_none() {
            edges.push(cycle[(begin + i) % cycle.len()]);
            i += 1;
        }
        for d in &edges {
            surface.edge_chain[d.edge().index()] = chain_slot(new);
        }
        let start = surface.ends(edges[0])[0];
        surface.chains.push(Chain { start, edges, on_loop: Some(id), joint: None });
        chains.push(new);
    }
    surface.loops.push(Loop { chains });
}

impl Surface {
    /// The edge between two nodes. O(edges); many look-ups go through [`Surface::edge_index`].
    pub fn find_edge(&self, a: NodeId, b: NodeId) -> Option<EdgeId> {
        self.edges.iter().position(|&e| e == [a.0, b.0] || e == [b.0, a.0]).map(|e| EdgeId(e as u32))
    }
}
