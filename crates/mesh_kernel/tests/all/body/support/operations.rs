//! Random operations on a body: most of them valid, some not.

use std::collections::BTreeMap;

use mesh_kernel::body::edit::{EdgeRole, Editor, FaceRole, Guard, Operation};
use mesh_kernel::body::{
    AttributeEdge, AttributeEdgeId, AttributeNode, AttributeNodeId, Body, ChainSpec, EdgeId, FaceId, JointId,
    JointSpec, NONE, NodeId, Surface, SurfaceId,
};
use mesh_kernel::glam::{DVec2, DVec3};

use super::Random;

/// Above so many faces no operator that makes many is drawn.
const MANY: usize = 160;

/// Draws operations.
pub(crate) struct Source {
    pub(crate) random: Random,
    /// Joints that were killed, to be made again.
    pub(crate) killed: Vec<JointSpec>,
    /// Sides of faces that were to be killed, to be made again.
    opened: Vec<(SurfaceId, [EdgeId; 3])>,
    /// Whether attributes are drawn.
    pub(crate) attributes: bool,
}

fn pick<T: Copy>(random: &mut Random, of: &[T]) -> Option<T> {
    (!of.is_empty()).then(|| of[random.below(of.len())])
}

impl Source {
    pub(crate) fn new(seed: u64) -> Self {
        let mut random = Random(seed);
        let attributes = random.below(3) == 0;
        Self { random, killed: Vec::new(), opened: Vec::new(), attributes }
    }

    fn surface(&mut self, body: &Body) -> SurfaceId {
        let n = body.surfaces().len();
        // Now and then one that is not there.
        let beyond = usize::from(self.random.below(100) == 0);
        SurfaceId(self.random.below((n + beyond).max(1)) as u32)
    }

    fn any(&mut self, len: usize) -> u32 {
        self.random.below(len + 2) as u32
    }

    fn node(&mut self, s: &Surface) -> NodeId {
        let live: Vec<NodeId> = s.live_nodes().collect();
        match pick(&mut self.random, &live) {
            Some(v) if self.random.below(40) > 0 => v,
            _ => NodeId(self.any(s.positions().len())),
        }
    }

    fn edge(&mut self, s: &Surface) -> EdgeId {
        let live: Vec<EdgeId> = s.live_edges().collect();
        match pick(&mut self.random, &live) {
            Some(e) if self.random.below(40) > 0 => e,
            _ => EdgeId(self.any(s.edges().len())),
        }
    }

    fn wire(&mut self, s: &Surface) -> EdgeId {
        let bare: Vec<EdgeId> = s.live_edges().filter(|e| s.edge_faces()[e.index()] == [NONE; 2]).collect();
        match pick(&mut self.random, &bare) {
            Some(e) if self.random.below(8) > 0 => e,
            _ => self.edge(s),
        }
    }

    fn face(&mut self, s: &Surface) -> FaceId {
        let live: Vec<FaceId> = s.live_faces().collect();
        match pick(&mut self.random, &live) {
            Some(f) if self.random.below(40) > 0 => f,
            _ => FaceId(self.any(s.faces().len())),
        }
    }

    /// A node with `degree` edges, all of them wires, where there is one.
    fn bare_node(&mut self, s: &Surface, degree: usize) -> NodeId {
        let mut at = vec![0; s.positions().len()];
        for e in s.live_edges() {
            let step = if s.edge_faces()[e.index()] == [NONE; 2] { 1 } else { 100 };
            s.edges()[e.index()].iter().for_each(|&v| at[v as usize] += step);
        }
        let fits: Vec<NodeId> = s.live_nodes().filter(|v| at[v.index()] == degree).collect();
        match pick(&mut self.random, &fits) {
            Some(v) if self.random.below(8) > 0 => v,
            _ => self.node(s),
        }
    }

    /// Three edges in a row that close, one of them with a free side; in the direction that is free there.
    fn triangle(&mut self, s: &Surface) -> [EdgeId; 3] {
        let any = |x: &mut Self| [(); 3].map(|()| x.edge(s));
        if self.random.below(20) == 0 {
            return any(self);
        }
        let free: Vec<EdgeId> =
            s.live_edges().filter(|e| s.edge_faces()[e.index()].contains(&NONE)).collect();
        for _ in 0..6 {
            let Some(e) = pick(&mut self.random, &free) else { return any(self) };
            let [mut a, mut b] = s.edges()[e.index()];
            let [left, _] = s.edge_faces()[e.index()];
            if left != NONE {
                (a, b) = (b, a);
            }
            let joins = |x: EdgeId, v: u32| s.edges()[x.index()].contains(&v) && x != e;
            let from_b: Vec<EdgeId> = s.live_edges().filter(|&x| joins(x, b)).collect();
            let mut found = Vec::new();
            for second in from_b {
                let [p, q] = s.edges()[second.index()];
                let c = if p == b { q } else { p };
                found.extend(s.live_edges().filter(|&x| joins(x, a) && joins(x, c)).map(|x| [e, second, x]));
            }
            // Those that are faces already are not so interesting.
            let taken = |t: &[EdgeId; 3]| {
                s.faces()
                    .iter()
                    .zip(s.face_edges())
                    .any(|(f, sides)| f[0] != NONE && t.iter().all(|e| sides.contains(&e.0)))
            };
            if self.random.below(10) > 0 {
                found.retain(|t| !taken(t));
            }
            if let Some(mut t) = pick(&mut self.random, &found) {
                t.rotate_left(self.random.below(3));
                return t;
            }
        }
        any(self)
    }

    fn place(&mut self, body: &Body) -> DVec3 {
        if self.random.below(200) == 0 {
            return DVec3::new(0.0, f64::NAN, 1.0);
        }
        let mut unit = || self.random.unit() * 2.0;
        let p = DVec3::new(unit(), unit(), unit());
        // Sometimes where another node is, so that joints can be made.
        let s = SurfaceId(self.random.below(body.surfaces().len().max(1)) as u32);
        if self.random.below(4) == 0 && body.surfaces().len() > 0 {
            let s = body.surface(s);
            let live: Vec<NodeId> = s.live_nodes().collect();
            if let Some(v) = pick(&mut self.random, &live) {
                return s.positions()[v.index()];
            }
        }
        p
    }

    /// Nodes of different surfaces, or of one, in one place; runs of edges from there that stay together.
    fn joint(&mut self, body: &Body) -> JointSpec {
        if !self.killed.is_empty() && self.random.below(3) > 0 {
            let i = self.random.below(self.killed.len());
            return self.killed.swap_remove(i);
        }
        type Place = [u64; 3];
        let key = |p: DVec3| -> Place { p.to_array().map(f64::to_bits) };
        let mut edges: BTreeMap<[Place; 2], Vec<(u32, [u32; 2])>> = BTreeMap::new();
        let mut nodes: BTreeMap<Place, Vec<(u32, u32)>> = BTreeMap::new();
        for (id, s) in body.surfaces() {
            let at = |v: u32| key(s.positions()[v as usize]);
            for v in s.live_nodes() {
                nodes.entry(at(v.0)).or_default().push((id.0, v.0));
            }
            for e in s.live_edges() {
                if s.edge_chain(e).and_then(|c| s.chain(c).joint()).is_some() {
                    continue;
                }
                let [a, b] = s.edges()[e.index()];
                let (a, b) = if at(a) < at(b) { (a, b) } else { (b, a) };
                edges.entry([at(a), at(b)]).or_default().push((id.0, [a, b]));
            }
        }
        let chain =
            |surface: u32, nodes: Vec<u32>| ChainSpec { surface: surface as usize, nodes, closed: false };
        let edges: Vec<_> = edges.into_values().filter(|l| l.len() > 1).collect();
        let nodes: Vec<_> = nodes.into_values().filter(|l| l.len() > 1).collect();
        let name = (self.random.below(2) == 0).then(|| "seam".to_owned());
        let mut chains: Vec<ChainSpec> = if !edges.is_empty() && self.random.below(5) > 0 {
            let list = &edges[self.random.below(edges.len())];
            list.iter().map(|(s, ends)| chain(*s, ends.to_vec())).collect()
        } else if !nodes.is_empty() {
            let list = &nodes[self.random.below(nodes.len())];
            list.iter().map(|(s, v)| chain(*s, vec![*v])).collect()
        } else {
            // Hardly valid.
            let n = body.surfaces().len();
            (0..2).map(|_| chain(self.random.below(n + 1) as u32, vec![self.any(4), self.any(4)])).collect()
        };
        while chains.len() > 2 && self.random.below(3) == 0 {
            let i = self.random.below(chains.len());
            chains.swap_remove(i);
        }
        if self.random.below(2) == 0 {
            chains.reverse();
        }
        JointSpec { name, chains }
    }

    fn attribute(&mut self, s: &Surface) -> AttributeNode {
        if self.random.below(2) == 0 {
            let u = [0.0, 0.25, 0.5, 1.0, self.random.unit(), 1.5][self.random.below(6)];
            AttributeNode::OnEdge { edge: self.edge(s), u }
        } else {
            let areal = self.areal();
            AttributeNode::InFace { face: self.face(s), areal }
        }
    }

    fn areal(&mut self) -> [f64; 3] {
        let (u, v) = (self.random.unit(), self.random.unit());
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        if self.random.below(20) == 0 { [u, v, 1.0] } else { [u, v, 1.0 - u - v] }
    }

    /// One operation; groups of up to four now and then.
    pub(crate) fn operation(&mut self, body: &Body) -> Operation {
        if self.random.below(40) == 0 {
            let n = 1 + self.random.below(4);
            return Operation::Group((0..n).map(|_| self.single(body)).collect());
        }
        self.single(body)
    }

    fn single(&mut self, body: &Body) -> Operation {
        let surface = self.surface(body);
        if body.surfaces().len() == 0 || (body.surfaces().len() < 6 && self.random.below(80) == 0) {
            return Operation::AddSurface { name: format!("new {}", surface.0) };
        }
        let Some((_, s)) = body.surfaces().nth(surface.index()) else {
            // No such surface.
            return Operation::KillVertexComplex { surface, node: NodeId(0) };
        };
        let big = body.face_count() > MANY;
        loop {
            let drawn = match self.random.below(24) {
                0 | 1 => self.vertices(body, surface, s),
                2..=4 => self.edges(body, surface, s),
                5..=8 => self.faces(body, surface, s),
                9 => self.joints(body),
                10 => self.layers(body, surface, s),
                11 | 12 if self.attributes => self.attributes(surface, s),
                13..=21 => {
                    let carrying = body.surfaces().any(|(_, s)| !s.attribute_nodes().is_empty());
                    self.high_level(surface, s, big, carrying)
                }
                22 if self.random.below(3) == 0 => Operation::Compact,
                23 if self.random.below(8) == 0 && body.face_count() < MANY / 4 => {
                    Operation::SplitAll { midpoints: None }
                }
                _ => continue,
            };
            return drawn;
        }
    }

    fn vertices(&mut self, body: &Body, surface: SurfaceId, s: &Surface) -> Operation {
        match self.random.below(6) {
            0 => Operation::MakeVertexComplex { surface, position: self.place(body) },
            1 => Operation::KillVertexComplex { surface, node: self.bare_node(s, 0) },
            2 => Operation::MakeVertexEdge { surface, from: self.node(s), position: self.place(body) },
            3 => Operation::KillVertexEdge { surface, node: self.bare_node(s, 1) },
            4 => {
                let at = [0.5, self.random.unit(), 1.0][self.random.below(3)];
                Operation::SplitWire { surface, edge: self.wire(s), at }
            }
            _ => Operation::MergeWire { surface, node: self.bare_node(s, 2) },
        }
    }

    fn edges(&mut self, body: &Body, surface: SurfaceId, s: &Surface) -> Operation {
        let (mut from, to) = (self.node(s), self.node(s));
        if self.random.below(2) == 0 && s.is_node(to) {
            // Two steps away: makes triangles.
            let mut at = to.0;
            for _ in 0..2 {
                let next: Vec<u32> = s
                    .live_edges()
                    .map(|e| s.edges()[e.index()])
                    .filter(|ends| ends.contains(&at))
                    .map(|[a, b]| if a == at { b } else { a })
                    .collect();
                at = pick(&mut self.random, &next).unwrap_or(at);
            }
            from = NodeId(at);
        }
        let mut trial = Editor::without_journal(body.clone());
        let strict = self.random.below(3) > 0;
        // Mostly the form that fits.
        let other = self.random.below(5) == 0;
        if self.random.below(2) == 0 {
            return match trial.make_edge(surface, from, to) {
                Ok((_, role)) if strict && (role == EdgeRole::Cycle) != other => {
                    Operation::MakeEdgeChole { surface, from, to }
                }
                Ok(_) if strict => Operation::MakeEdgeKillComplex { surface, from, to },
                _ => Operation::MakeEdge { surface, from, to },
            };
        }
        let edge = self.wire(s);
        match trial.kill_edge(surface, edge) {
            Ok(role) if strict && (role == EdgeRole::Cycle) != other => {
                Operation::KillEdgeChole { surface, edge }
            }
            Ok(_) if strict => Operation::KillEdgeMakeComplex { surface, edge },
            _ => Operation::KillEdge { surface, edge },
        }
    }

    fn faces(&mut self, body: &Body, surface: SurfaceId, s: &Surface) -> Operation {
        let mut trial = Editor::without_journal(body.clone());
        let strict = self.random.below(3) > 0;
        let other = self.random.below(5) == 0;
        if self.random.below(2) == 0 {
            let (surface, sides) = if !self.opened.is_empty() && self.random.below(2) == 0 {
                let i = self.random.below(self.opened.len());
                self.opened.swap_remove(i)
            } else {
                (surface, self.triangle(s))
            };
            return match trial.make_face(surface, sides) {
                Ok((_, role)) if strict && (role == FaceRole::Filling) != other => {
                    Operation::MakeFaceKillChole { surface, sides }
                }
                Ok(_) if strict => Operation::MakeFaceMakeCavity { surface, sides },
                _ => Operation::MakeFace { surface, sides },
            };
        }
        let face = self.face(s);
        let role = trial.kill_face(surface, face);
        if role.is_ok() {
            self.opened.push((surface, s.face_edges()[face.index()].map(EdgeId)));
        }
        match role {
            Ok(role) if strict && (role == FaceRole::Filling) != other => {
                Operation::KillFaceMakeChole { surface, face }
            }
            Ok(_) if strict => Operation::KillFaceKillCavity { surface, face },
            _ => Operation::KillFace { surface, face },
        }
    }

    fn joints(&mut self, body: &Body) -> Operation {
        let joints: Vec<JointId> = body.joint_ids().collect();
        match pick(&mut self.random, &joints) {
            Some(joint) if self.random.below(2) == 0 => Operation::KillJoint { joint },
            None if self.random.below(6) == 0 => Operation::KillJoint { joint: JointId(self.any(2)) },
            _ => Operation::MakeJoint { joint: self.joint(body) },
        }
    }

    fn layers(&mut self, body: &Body, surface: SurfaceId, s: &Surface) -> Operation {
        match self.random.below(9) {
            0 => Operation::StoreBackup { surface },
            1 => Operation::RestoreBackup { surface },
            2 if self.random.below(4) > 0 => {
                let planar = s.positions().iter().map(|p| DVec2::new(p.x, p.y)).collect();
                Operation::SetPlanar { surface, planar: Some(planar) }
            }
            2 => Operation::SetPlanar {
                surface,
                planar: [None, Some(Vec::new())][self.random.below(2)].clone(),
            },
            3 => Operation::RenameSurface { surface, name: format!("name {}", self.random.below(9)) },
            _ => {
                let n = 1 + self.random.below(2);
                let nodes = (0..n)
                    .map(|_| {
                        let node = self.node(s);
                        let from = s.positions().get(node.index()).copied().unwrap_or_default();
                        let to = if self.random.below(4) == 0 { self.place(body) } else { from };
                        let mut unit = || self.random.unit() - 0.5;
                        (node, to + DVec3::new(unit(), unit(), unit()) * 0.1)
                    })
                    .collect();
                Operation::MoveNodes { surface, nodes }
            }
        }
    }

    fn attributes(&mut self, surface: SurfaceId, s: &Surface) -> Operation {
        let (nodes, lines) = (s.attribute_nodes().len(), s.attribute_edges().len());
        let last = |n: usize, random: &mut Random| {
            if random.below(8) == 0 { random.below(n + 2) as u32 } else { n.saturating_sub(1) as u32 }
        };
        let ring =
            |n: &AttributeNodeId| matches!(s.attribute_nodes()[n.index()], AttributeNode::InFace { .. });
        let ring_edge =
            s.attribute_edges().last().is_some_and(|l| l.nodes.len() == 2 && l.nodes.iter().all(ring));
        if ring_edge && self.random.below(3) == 0 {
            return Operation::KillEdgeMakeRing { surface, line: AttributeEdgeId(lines as u32 - 1) };
        }
        let random = &mut self.random;
        let two = |random: &mut Random| {
            let n = (nodes + 1) as u64;
            [random.next() % n, random.next() % n].map(|n| AttributeNodeId(n as u32))
        };
        match random.below(10) {
            0 => {
                let areal = self.areal();
                Operation::MakeVertexRing { surface, face: self.face(s), areal }
            }
            1 => Operation::KillVertexRing { surface, node: AttributeNodeId(last(nodes, random)) },
            2 => {
                // Two in one face where there are.
                let mut found = two(random);
                for (i, a) in s.attribute_nodes().iter().enumerate() {
                    for (j, b) in s.attribute_nodes().iter().enumerate().take(i) {
                        if let (AttributeNode::InFace { face: f, .. }, AttributeNode::InFace { face: g, .. }) =
                            (a, b)
                            && f == g
                        {
                            found = [i, j].map(|n| AttributeNodeId(n as u32));
                        }
                    }
                }
                Operation::MakeEdgeKillRing { surface, nodes: found }
            }
            3 => Operation::KillEdgeMakeRing { surface, line: AttributeEdgeId(last(lines, random)) },
            4 => Operation::AddAttributeNode { surface, node: self.attribute(s) },
            5 => Operation::RemoveAttributeNode { surface, node: AttributeNodeId(last(nodes, random)) },
            6 => {
                let nodes = two(random).to_vec();
                Operation::AddAttributeEdge { surface, line: AttributeEdge { name: None, nodes } }
            }
            7 => Operation::RemoveAttributeEdge { surface, line: AttributeEdgeId(last(lines, random)) },
            8 => Operation::SetAttributes { surface, nodes: Vec::new(), lines: Vec::new() },
            _ => {
                // A line across a face.
                let face = self.face(s);
                let Some(&sides) = s.face_edges().get(face.index()).filter(|_| s.is_face(face)) else {
                    return Operation::AddAttributeNode { surface, node: self.attribute(s) };
                };
                let mut all = s.attribute_nodes().to_vec();
                let mut lines = s.attribute_edges().to_vec();
                let first = all.len() as u32;
                let u = self.random.unit();
                let side = |i: usize, u: f64| AttributeNode::OnEdge { edge: EdgeId(sides[i]), u };
                all.extend([
                    side(0, u),
                    AttributeNode::InFace { face, areal: self.areal() },
                    side(1, 1.0 - u),
                ]);
                let nodes = (first..first + 3).map(AttributeNodeId).collect();
                lines.push(AttributeEdge { name: Some("line".into()), nodes });
                Operation::SetAttributes { surface, nodes: all, lines }
            }
        }
    }

    fn high_level(&mut self, surface: SurfaceId, s: &Surface, big: bool, carrying: bool) -> Operation {
        let guard = if self.random.below(8) == 0 { Guard::None } else { Guard::NoTurn };
        match self.random.below(10) {
            0..=2 if !big => {
                let at = [0.5, 0.2 + 0.6 * self.random.unit(), -1.0][self.random.below(21) / 10];
                Operation::SplitEdge { surface, edge: self.edge(s), at }
            }
            3 if !big => Operation::SplitFace { surface, face: self.face(s) },
            7 if carrying && !big => {
                // A face that carries something, where one is found.
                let hosts: Vec<FaceId> = s
                    .attribute_nodes()
                    .iter()
                    .map(|n| match n {
                        AttributeNode::InFace { face, .. } => *face,
                        AttributeNode::OnEdge { edge, .. } => {
                            let [left, right] = s.edge_faces()[edge.index()];
                            FaceId(if left == NONE { right } else { left })
                        }
                    })
                    .collect();
                let face = pick(&mut self.random, &hosts).unwrap_or_else(|| self.face(s));
                Operation::TriangulateFace { surface, face }
            }
            4..=6 => {
                let edge = self.edge(s);
                let ends = s.edges().get(edge.index()).copied().unwrap_or([0, 1]);
                let at = [None, Some(0.5), Some(self.random.unit())][self.random.below(3)];
                let end = self.random.below(40);
                let keep = NodeId(if end == 0 { 0 } else { ends[end % 2] });
                Operation::CollapseEdge { surface, edge, keep, at, guard }
            }
            _ => {
                let inner = |e: &EdgeId| {
                    let joint = s.edge_chain(*e).and_then(|c| s.chain(c).joint());
                    !s.edge_faces()[e.index()].contains(&NONE) && joint.is_none()
                };
                let inner: Vec<EdgeId> = s.live_edges().filter(inner).collect();
                let edge = match pick(&mut self.random, &inner) {
                    Some(e) if self.random.below(5) > 0 => e,
                    _ => self.edge(s),
                };
                Operation::SwapEdge { surface, edge, guard }
            }
        }
    }
}
