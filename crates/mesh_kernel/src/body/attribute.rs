//! Attributes: points and polylines on a surface, stored by parameters of the edges and faces that carry them, so
//! that they follow every move of the nodes.

use std::cell::OnceCell;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::adjacency::EdgeIndex;
use super::ids::{AttributeEdgeId, AttributeNodeId, EdgeId, FaceId, NONE};
use super::surface::Surface;

/// Where an attribute node lies.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AttributeNode {
    /// On an edge (ATTRIB_EDGENODE): 0 at its first node, 1 at its second.
    OnEdge {
        /// The edge.
        edge: EdgeId,
        /// Parameter along it.
        u: f64,
    },
    /// In a face (ATTRIB_FACENODE): areal coordinates, sum 1.
    InFace {
        /// The face.
        face: FaceId,
        /// Share of every corner.
        areal: [f64; 3],
    },
}

/// What carries a piece of an attribute edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Carrier {
    Face(u32),
    /// An edge without a face.
    Edge(u32),
}

/// A polyline over the surface (ATTRIB_EDGE): two nodes that follow each other lie in, or on the sides of, one face.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct AttributeEdge {
    /// What the line means.
    pub name: Option<String>,
    /// The nodes in order.
    pub nodes: Vec<AttributeNodeId>,
}

/// Why an attribute was not taken.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AttributeError {
    /// No such edge or face.
    #[error("the attribute names an edge or a face that the surface does not have")]
    NoHost,
    /// A parameter out of range.
    #[error("the attribute's parameters {0:?} are out of range: 0 to 1, areal coordinates with sum 1")]
    Range(Vec<f64>),
    /// An attribute edge names an unknown node.
    #[error("the attribute edge names node {0}, which the surface does not have")]
    NoNode(AttributeNodeId),
    /// Two nodes in a row without a common face.
    #[error(
        "attribute nodes {0} and {1} follow each other but share no face: add nodes where the line crosses edges"
    )]
    Apart(AttributeNodeId, AttributeNodeId),
}

/// How far areal coordinates may be from sum 1.
pub(crate) const AREAL_TOLERANCE: f64 = 1e-9;

impl AttributeNode {
    /// Whether the parameters are in range.
    pub(crate) fn in_range(&self) -> bool {
        match *self {
            Self::OnEdge { u, .. } => (0.0..=1.0).contains(&u),
            Self::InFace { areal, .. } => {
                areal.iter().all(|w| (0.0..=1.0).contains(w))
                    && (areal.iter().sum::<f64>() - 1.0).abs() <= AREAL_TOLERANCE
            }
        }
    }

    /// The parameters.
    pub(crate) fn parameters(&self) -> Vec<f64> {
        match *self {
            Self::OnEdge { u, .. } => vec![u],
            Self::InFace { areal, .. } => areal.to_vec(),
        }
    }
}

impl Surface {
    /// The attribute nodes.
    pub fn attribute_nodes(&self) -> &[AttributeNode] {
        &self.attribute_nodes
    }

    /// The attribute edges.
    pub fn attribute_edges(&self) -> &[AttributeEdge] {
        &self.attribute_edges
    }

    /// Adds an attribute node.
    ///
    /// # Errors
    /// Unknown host; parameters out of range.
    pub fn add_attribute_node(&mut self, node: AttributeNode) -> Result<AttributeNodeId, AttributeError> {
        if !self.has_host(&node) {
            return Err(AttributeError::NoHost);
        }
        if !node.in_range() {
            return Err(AttributeError::Range(node.parameters()));
        }
        self.attribute_nodes.push(node);
        Ok(AttributeNodeId(self.attribute_nodes.len() as u32 - 1))
    }

    /// Adds an attribute edge.
    ///
    /// # Errors
    /// Unknown nodes; nodes in a row that share no face.
    pub fn add_attribute_edge(&mut self, edge: AttributeEdge) -> Result<AttributeEdgeId, AttributeError> {
        if let Some(&n) = edge.nodes.iter().find(|n| n.index() >= self.attribute_nodes.len()) {
            return Err(AttributeError::NoNode(n));
        }
        let index = OnceCell::new();
        for pair in edge.nodes.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|n| self.attribute_nodes[n.index()]);
            if self.carrier(&a, &b, &index).is_none() {
                return Err(AttributeError::Apart(pair[0], pair[1]));
            }
        }
        self.attribute_edges.push(edge);
        Ok(AttributeEdgeId(self.attribute_edges.len() as u32 - 1))
    }

    /// Position of an attribute node, from its host's nodes.
    pub fn attribute_position(&self, id: AttributeNodeId) -> DVec3 {
        match self.attribute_nodes[id.index()] {
            AttributeNode::OnEdge { edge, u } => {
                let [a, b] = self.edges[edge.index()].map(|v| self.positions[v as usize]);
                a * (1.0 - u) + b * u
            }
            AttributeNode::InFace { face, areal } => {
                let [a, b, c] = self.corners(face);
                a * areal[0] + b * areal[1] + c * areal[2]
            }
        }
    }

    pub(crate) fn has_host(&self, node: &AttributeNode) -> bool {
        match node {
            AttributeNode::OnEdge { edge, .. } => self.is_edge(*edge),
            AttributeNode::InFace { face, .. } => self.is_face(*face),
        }
    }

    /// Whether attribute nodes lie on one of the edges or in one of the faces, or attribute edges run through one.
    pub(crate) fn carries_attributes(&self, edges: &[u32], faces: &[u32]) -> bool {
        let hosted = self.attribute_nodes.iter().any(|n| match n {
            AttributeNode::OnEdge { edge, .. } => edges.contains(&edge.0),
            AttributeNode::InFace { face, .. } => faces.contains(&face.0),
        });
        let index = OnceCell::new();
        hosted
            || self.attribute_edges.iter().flat_map(|l| l.nodes.windows(2)).any(|pair| {
                let [a, b] = [pair[0], pair[1]].map(|n| &self.attribute_nodes[n.index()]);
                match self.carrier(a, b, &index) {
                    Some(Carrier::Face(f)) => faces.contains(&f),
                    Some(Carrier::Edge(e)) => edges.contains(&e),
                    None => false,
                }
            })
    }

    /// The node at which an attribute node lies, if it is an end of its edge.
    pub(crate) fn at_node(&self, node: &AttributeNode) -> Option<u32> {
        match *node {
            AttributeNode::OnEdge { edge, u: 0.0 } => Some(self.edges[edge.index()][0]),
            AttributeNode::OnEdge { edge, u: 1.0 } => Some(self.edges[edge.index()][1]),
            _ => None,
        }
    }

    fn hosts(&self, node: &AttributeNode) -> [u32; 2] {
        match node {
            AttributeNode::OnEdge { edge, .. } => self.edge_faces[edge.index()],
            AttributeNode::InFace { face, .. } => [face.0, NONE],
        }
    }

    /// What carries the straight line between two attribute nodes. `index` is made when it is needed.
    pub(crate) fn carrier(
        &self,
        a: &AttributeNode,
        b: &AttributeNode,
        index: &OnceCell<EdgeIndex>,
    ) -> Option<Carrier> {
        let faces = self.hosts(a).into_iter().chain(self.hosts(b)).filter(|&f| f != NONE);
        for f in faces {
            if self.areal_in(a, f).is_some() && self.areal_in(b, f).is_some() {
                return Some(Carrier::Face(f));
            }
        }
        // An edge without faces carries what lies on it, its ends included.
        for (x, y) in [(a, b), (b, a)] {
            if let AttributeNode::OnEdge { edge, .. } = *y {
                let same = matches!(x, AttributeNode::OnEdge { edge: other, .. } if *other == edge);
                if same || self.at_node(x).is_some_and(|v| self.edges[edge.index()].contains(&v)) {
                    return Some(Carrier::Edge(edge.0));
                }
            }
        }
        let (Some(p), Some(q)) = (self.at_node(a), self.at_node(b)) else { return None };
        let e = index.get_or_init(|| self.edge_index()).find(p, q)?;
        Some(
            self.edge_faces[e.index()]
                .into_iter()
                .find(|&f| f != NONE)
                .map_or(Carrier::Edge(e.0), Carrier::Face),
        )
    }

    /// Areal coordinates of an attribute node in `face`, if it lies in it or on its boundary.
    pub(crate) fn areal_in(&self, node: &AttributeNode, face: u32) -> Option<[f64; 3]> {
        let AttributeNode::OnEdge { edge, u } = *node else {
            let AttributeNode::InFace { face: f, areal } = *node else { return None };
            return (f.0 == face).then_some(areal);
        };
        let nodes = &self.faces[face as usize];
        let mut areal = [0.0; 3];
        if let Some(i) = self.face_edges[face as usize].iter().position(|&e| e == edge.0) {
            let along = if self.edges[edge.index()][0] == nodes[i] { u } else { 1.0 - u };
            areal[i] = 1.0 - along;
            areal[(i + 1) % 3] = along;
        } else {
            let v = self.at_node(node)?;
            areal[nodes.iter().position(|&n| n == v)?] = 1.0;
        }
        Some(areal)
    }
}
