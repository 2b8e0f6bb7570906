//! Why an operator was refused, what is in the way, and what to do.

use super::ids::{Corner, DirectedEdge, EdgeId, FaceId, VertexId};
use super::operation::{EdgeKind, FaceKind};

/// A vertex, an edge or a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Entity {
    /// A vertex.
    Vertex(VertexId),
    /// An edge.
    Edge(EdgeId),
    /// A face.
    Face(FaceId),
}

impl std::fmt::Display for Entity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Vertex(v) => v.fmt(f),
            Self::Edge(e) => e.fmt(f),
            Self::Face(x) => x.fmt(f),
        }
    }
}

/// An operator that was refused. Nothing was changed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{operator}: {reason}; {remedy}", remedy = .reason.remedy())]
pub struct Refusal {
    /// Name of the operator.
    pub operator: &'static str,
    /// Why, with the entities in the way.
    #[source]
    pub reason: Reason,
}

/// Why an operator was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Reason {
    /// The id names nothing that lives.
    #[error("there is no vertex {0}")]
    NoVertex(VertexId),
    /// The id names nothing that lives.
    #[error("there is no edge {0}")]
    NoEdge(EdgeId),
    /// The id names nothing that lives.
    #[error("there is no face {0}")]
    NoFace(FaceId),
    /// A coordinate is not a number or is infinite.
    #[error("the position {0:?} is not finite")]
    NotFinite([f64; 3]),
    /// There are as many entities as ids.
    #[error("the complex is full")]
    Full,
    /// An edge would begin and end at one vertex.
    #[error("an edge would begin and end at vertex {0}")]
    SelfLoop(VertexId),
    /// The vertex still has edges, or is a loop of faces.
    #[error("vertex {vertex} still has edges {} and is a loop of faces {}", list(.edges), list(.faces))]
    VertexInUse {
        /// The vertex.
        vertex: VertexId,
        /// Its edges.
        edges: Vec<EdgeId>,
        /// Faces of which it is a loop.
        faces: Vec<FaceId>,
    },
    /// The vertex is not the loose end of an edge.
    #[error("vertex {vertex} has {} edges ({}), not one", .edges.len(), list(.edges))]
    NotLooseEnd {
        /// The vertex.
        vertex: VertexId,
        /// Its edges.
        edges: Vec<EdgeId>,
    },
    /// Faces use the edge.
    #[error("edge {edge} is used by faces {}", list(.faces))]
    FacesAtEdge {
        /// The edge.
        edge: EdgeId,
        /// Its faces.
        faces: Vec<FaceId>,
    },
    /// The edge is of the other kind.
    #[error("edge {between:?} {}", match .found { EdgeKind::Chole => "closes a cycle within one complex", EdgeKind::Complex => "is the only link between two complexes" })]
    EdgeKind {
        /// Its ends.
        between: [VertexId; 2],
        /// What it does.
        found: EdgeKind,
    },
    /// The face is of the other kind.
    #[error("the face {}", match .found { FaceKind::Chole => "has the same region on both sides: it fills a hole", FaceKind::Cavity => "parts two regions: it bounds a cavity" })]
    FaceKind {
        /// Its edges' face uses that lie beside it.
        beside: Vec<FaceId>,
        /// What it does.
        found: FaceKind,
    },
    /// The face has no such corner.
    #[error("face {face} has no corner {corner:?}")]
    NoCorner {
        /// The face.
        face: FaceId,
        /// What was asked for.
        corner: Corner,
    },
    /// The corner of the face is at another vertex.
    #[error("the corner of face {face} is at vertex {found}, not at {asked}")]
    OtherVertex {
        /// The face.
        face: FaceId,
        /// The corner's vertex.
        found: VertexId,
        /// The edge's vertex.
        asked: VertexId,
    },
    /// Both corners are on one loop.
    #[error("both corners are on one loop of face {0}: the edge would part the face in two")]
    SameLoop(FaceId),
    /// The corners are on two loops.
    #[error("the corners are on two loops of face {0}: the edge would join them")]
    DifferentLoops(FaceId),
    /// The edge is not walked twice, once each way, by one loop.
    #[error("edge {edge} is not walked to and fro by one loop of one face, but by faces {}", list(.faces))]
    NotIsthmus {
        /// The edge.
        edge: EdgeId,
        /// Its faces.
        faces: Vec<FaceId>,
    },
    /// The vertex is not a ring.
    #[error("vertex {vertex} is a ring of {} faces ({}), not of one", .faces.len(), list(.faces))]
    NotRing {
        /// The vertex.
        vertex: VertexId,
        /// Faces of which it is a ring.
        faces: Vec<FaceId>,
    },
    /// A loop without edges.
    #[error("a loop has no edges")]
    EmptyLoop,
    /// The loop is not a closed walk.
    #[error("the loop is open: {this} does not end where {next} begins")]
    OpenLoop {
        /// An edge.
        this: DirectedEdge,
        /// The next.
        next: DirectedEdge,
    },
    /// The face would walk an edge twice in one direction.
    #[error("the face would walk {0} twice in the same direction")]
    UsedTwice(DirectedEdge),
    /// A vertex is given twice as a loop.
    #[error("vertex {0} is given as a loop twice")]
    RingTwice(VertexId),
    /// No edge, or more than one, joins two vertices.
    #[error("{} edges join vertices {from} and {to} ({})", .edges.len(), list(.edges))]
    NotOneEdge {
        /// A vertex.
        from: VertexId,
        /// The next.
        to: VertexId,
        /// The edges that join them.
        edges: Vec<EdgeId>,
    },
    /// The positions do not tell the order of faces about an edge.
    #[error("positions do not tell the order of faces {} about edge {edge}", list(.faces))]
    RadialTie {
        /// The edge.
        edge: EdgeId,
        /// Faces that leave it in one direction, or whose direction cannot be told.
        faces: Vec<FaceId>,
    },
    /// The stored order is not that of the positions.
    #[error("faces {} about edge {edge} are not stored in the order of their positions", list(.faces))]
    RadialStored {
        /// The edge.
        edge: EdgeId,
        /// Its faces as stored.
        faces: Vec<FaceId>,
    },
    /// The order given does not hold all uses of the edge, or changes the order of old ones.
    #[error("the order given for edge {edge} is not the order of its faces {} with the new uses put in", list(.faces))]
    RadialGiven {
        /// The edge.
        edge: EdgeId,
        /// Its faces as stored.
        faces: Vec<FaceId>,
    },
    /// The face would lie in two regions at once.
    #[error("the face would pass from one region into another between faces {} and {}", .between[0], .between[1])]
    TwoRegions {
        /// Faces beside which it would lie, in different regions.
        between: [FaceId; 2],
    },
    /// The face would close a surface that does not part space.
    #[error("the face would close a surface that has one region on both sides, together with faces {}", list(.faces))]
    NotSeparating {
        /// Faces beside it.
        faces: Vec<FaceId>,
    },
    /// The order would change which regions there are.
    #[error("the new order about edge {edge} would change the number of cavities by {change:+}")]
    OrderChangesRegions {
        /// The edge.
        edge: EdgeId,
        /// By how many.
        change: i64,
    },
    /// Not two edges meet at the vertex.
    #[error("vertex {vertex} has {} edges ({}), not two", .edges.len(), list(.edges))]
    NotTwoEdges {
        /// The vertex.
        vertex: VertexId,
        /// Its edges.
        edges: Vec<EdgeId>,
    },
    /// The two edges are not one for their faces.
    #[error("faces {} do not pass vertex {vertex} from one edge to the other", list(.faces))]
    FacesTurn {
        /// The vertex.
        vertex: VertexId,
        /// The faces that do not pass.
        faces: Vec<FaceId>,
    },
    /// The two edges are of different classes.
    #[error("edges {} and {} differ in class (free, bend, weld)", .0[0], .0[1])]
    ClassesDiffer([EdgeId; 2]),
    /// The edge does not have the class that the operator takes.
    #[error("edge {edge} has another class (free, bend, weld) than the operator takes")]
    WrongClass {
        /// The edge.
        edge: EdgeId,
    },
    /// The edge has too few faces to be a bend or a weld.
    #[error("edge {edge} has {} face uses; a joint has two at least", .faces.len())]
    NotJoint {
        /// The edge.
        edge: EdgeId,
        /// Its faces.
        faces: Vec<FaceId>,
    },
    /// The two faces look at the edge in one direction.
    #[error("faces {} and {} are oriented against each other at edge {edge}", .faces[0], .faces[1])]
    Orientation {
        /// The edge.
        edge: EdgeId,
        /// The faces.
        faces: [FaceId; 2],
    },
    /// The edge does not have two different faces.
    #[error("edge {edge} does not part two faces: its faces are {}", list(.faces))]
    NotBetweenTwo {
        /// The edge.
        edge: EdgeId,
        /// Its faces.
        faces: Vec<FaceId>,
    },
    /// The edges do not join the same vertices.
    #[error("edges {} and {} do not have the same ends", .0[0], .0[1])]
    NotParallel([EdgeId; 2]),
    /// Positions do not tell on which side of the new edge something lies.
    #[error("positions do not tell on which side of the new edge in face {face} the loop at {at} lies")]
    SideUnknown {
        /// The face.
        face: FaceId,
        /// A vertex of the loop.
        at: VertexId,
    },
    /// The sequence would change the counts in another way than its name says.
    #[error("the sequence would give {found}, not {wanted}")]
    WrongDelta {
        /// What would come.
        found: Box<super::Delta>,
        /// What the name says.
        wanted: Box<super::Delta>,
    },
}

fn list<T: std::fmt::Display>(items: &[T]) -> String {
    if items.is_empty() {
        return "none".into();
    }
    items.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

impl Reason {
    /// The entities in the way.
    pub fn entities(&self) -> Vec<Entity> {
        let edges = |x: &[EdgeId]| x.iter().map(|&e| Entity::Edge(e)).collect::<Vec<_>>();
        let faces = |x: &[FaceId]| x.iter().map(|&f| Entity::Face(f)).collect::<Vec<_>>();
        match self {
            Self::NotFinite(_) | Self::Full | Self::EmptyLoop | Self::WrongDelta { .. } => Vec::new(),
            Self::NoVertex(v) | Self::SelfLoop(v) | Self::RingTwice(v) => vec![Entity::Vertex(*v)],
            Self::NoEdge(e) => edges(&[*e]),
            Self::NoFace(f) | Self::SameLoop(f) | Self::DifferentLoops(f) => faces(&[*f]),
            Self::VertexInUse { edges: e, faces: f, .. } => [edges(e), faces(f)].concat(),
            Self::NotLooseEnd { edges: e, .. } | Self::NotTwoEdges { edges: e, .. } => edges(e),
            Self::FacesAtEdge { faces: f, .. }
            | Self::NotIsthmus { faces: f, .. }
            | Self::NotRing { faces: f, .. }
            | Self::RadialTie { faces: f, .. }
            | Self::RadialStored { faces: f, .. }
            | Self::RadialGiven { faces: f, .. }
            | Self::NotSeparating { faces: f }
            | Self::FaceKind { beside: f, .. }
            | Self::FacesTurn { faces: f, .. }
            | Self::NotJoint { faces: f, .. }
            | Self::NotBetweenTwo { faces: f, .. } => faces(f),
            Self::Orientation { faces: f, .. } | Self::TwoRegions { between: f } => faces(f),
            Self::EdgeKind { between, .. } => between.iter().map(|&v| Entity::Vertex(v)).collect(),
            Self::NoCorner { face, .. } => faces(&[*face]),
            Self::OtherVertex { face, found, .. } => vec![Entity::Face(*face), Entity::Vertex(*found)],
            Self::OpenLoop { this, next } => edges(&[this.edge, next.edge]),
            Self::UsedTwice(d) => edges(&[d.edge]),
            Self::NotOneEdge { from, to, edges: e } => {
                [vec![Entity::Vertex(*from), Entity::Vertex(*to)], edges(e)].concat()
            }
            Self::OrderChangesRegions { edge, .. } | Self::WrongClass { edge } => edges(&[*edge]),
            Self::ClassesDiffer(e) | Self::NotParallel(e) => edges(e),
            Self::SideUnknown { face, at } => vec![Entity::Face(*face), Entity::Vertex(*at)],
        }
    }

    /// What to do about it.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::NoVertex(_) | Self::NoEdge(_) | Self::NoFace(_) => "name one that lives",
            Self::NotFinite(_) => "give finite coordinates in mm",
            Self::Full => "kill something first",
            Self::SelfLoop(_) => "split the edge that joins the two, or choose two different vertices",
            Self::VertexInUse { .. } => "kill its edges and faces first, or use kill_vertex_ring for a ring",
            Self::NotLooseEnd { .. } => "name the vertex at the loose end, or kill its other edges first",
            Self::FacesAtEdge { .. } => "kill these faces first",
            Self::EdgeKind { found: EdgeKind::Chole, .. } => "use make_edge_chole or kill_edge_chole",
            Self::EdgeKind { found: EdgeKind::Complex, .. } => {
                "use make_edge_kill_complex or kill_edge_make_complex"
            }
            Self::FaceKind { found: FaceKind::Chole, .. } => {
                "use make_face_kill_chole or kill_face_make_chole"
            }
            Self::FaceKind { found: FaceKind::Cavity, .. } => {
                "use make_face_make_cavity or kill_face_kill_cavity"
            }
            Self::NoCorner { .. } | Self::OtherVertex { .. } => {
                "take a corner from Complex::corners_at for this face and vertex"
            }
            Self::SameLoop(_) => "use mef, which makes an edge and a face",
            Self::DifferentLoops(_) => "use make_edge_kill_ring",
            Self::NotIsthmus { .. } => "kill the faces first, or use kef where it parts two faces",
            Self::NotRing { .. } => "name a vertex made by make_vertex_ring, or kill all faces but one",
            Self::EmptyLoop => "give the edges of a closed walk, or a single vertex",
            Self::OpenLoop { .. } => "give the edges in order, each ending where the next begins",
            Self::UsedTwice(_) => "part the face in two along another edge",
            Self::RingTwice(_) => "give it once",
            Self::NotOneEdge { edges, .. } if edges.is_empty() => "make an edge between them first",
            Self::NotOneEdge { .. } => "give the walk by directed edges",
            Self::RadialTie { .. } | Self::RadialStored { .. } => {
                "give the order with NewFace::placed, or move the vertices"
            }
            Self::RadialGiven { .. } => "start from Complex::uses and put the new uses in",
            Self::TwoRegions { .. } => {
                "give other places about its edges, or open the surface that it passes first"
            }
            Self::NotSeparating { .. } => "give other places about its edges: no such surface lies in space",
            Self::OrderChangesRegions { .. } => "kill the faces and make them again in the new order",
            Self::NotTwoEdges { .. } => "kill the other edges first",
            Self::FacesTurn { .. } => "kill these faces first, or the strut with kill_vertex_edge",
            Self::ClassesDiffer(_) => "set one class with set_edge_class first",
            Self::WrongClass { .. } => "choose the operator that fits its class, or use set_edge_class",
            Self::NotJoint { .. } => "make the second face first, or unite the edge with another",
            Self::Orientation { .. } => "turn one of them with flip_face first",
            Self::NotBetweenTwo { .. } => {
                "use kill_edge_make_ring where one loop walks it to and fro, else kill the faces"
            }
            Self::NotParallel(_) => "merge their end vertices first (merge_vertices)",
            Self::SideUnknown { .. } => "say which loops go to the new face",
            Self::WrongDelta { .. } => "use the single operators, which say what they do",
        }
    }
}
