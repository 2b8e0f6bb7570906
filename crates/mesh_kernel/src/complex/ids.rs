//! Typed ids of vertices, edges and faces, and what walks are made of.

use serde::{Deserialize, Serialize};

macro_rules! id {
    ($(#[$doc:meta])* $name:ident, $letter:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(pub u32);

        impl $name {
            /// The id as an array index.
            #[inline]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, concat!($letter, "{}"), self.0)
            }
        }
    };
}

id!(
    /// A vertex of a complex.
    VertexId,
    "v"
);
id!(
    /// An edge of a complex.
    EdgeId,
    "e"
);
id!(
    /// A face of a complex.
    FaceId,
    "f"
);

/// One of the two ends of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// Where the edge begins.
    Start,
    /// Where it ends.
    End,
}

/// An edge and the direction in which it is walked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct DirectedEdge {
    /// The edge.
    pub edge: EdgeId,
    /// Whether the walk is from the edge's second end to its first.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub reversed: bool,
}

impl DirectedEdge {
    /// The edge walked from its first end to its second.
    pub fn along(edge: EdgeId) -> Self {
        Self { edge, reversed: false }
    }

    /// The edge walked from its second end to its first.
    pub fn against(edge: EdgeId) -> Self {
        Self { edge, reversed: true }
    }

    /// The same edge, the other way.
    #[must_use]
    pub fn flipped(self) -> Self {
        Self { reversed: !self.reversed, ..self }
    }
}

impl std::fmt::Display for DirectedEdge {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}{}", if self.reversed { '-' } else { '+' }, self.edge)
    }
}

/// A use of an edge by a face. A face uses an edge at most once in each direction, so this names a use at its edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct FaceUse {
    /// The face.
    pub face: FaceId,
    /// Whether the face's loop walks the edge in the edge's own direction. The face then lies to the left of the edge, seen
    /// from where the face's normal points.
    pub along: bool,
}

impl FaceUse {
    /// The use, seen from the edge turned round.
    #[must_use]
    pub fn flipped(self) -> Self {
        Self { along: !self.along, ..self }
    }

    /// The directed edge by which the face walks.
    pub fn at(self, edge: EdgeId) -> DirectedEdge {
        DirectedEdge { edge, reversed: !self.along }
    }
}

/// A closed walk of edges, or a single vertex.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Loop {
    /// A vertex that stands alone in the face.
    Vertex(VertexId),
    /// Edges, each ending where the next one begins; the face lies to their left. Stored with the smallest directed edge first.
    Walk(Vec<DirectedEdge>),
}

impl Loop {
    /// The edges walked; none for a single vertex.
    pub fn edges(&self) -> &[DirectedEdge] {
        match self {
            Self::Vertex(_) => &[],
            Self::Walk(walk) => walk,
        }
    }

    /// The loop walked the other way.
    #[must_use]
    pub fn reversed(&self) -> Self {
        match self {
            Self::Vertex(v) => Self::Vertex(*v),
            Self::Walk(walk) => Self::Walk(walk.iter().rev().map(|d| d.flipped()).collect()),
        }
    }

    /// Turned so that the smallest directed edge comes first: equal loops are then equal lists.
    pub(super) fn canonical(self) -> Self {
        match self {
            Self::Walk(mut walk) => {
                turn_to_least(&mut walk);
                Self::Walk(walk)
            }
            single => single,
        }
    }
}

impl From<Vec<DirectedEdge>> for Loop {
    fn from(walk: Vec<DirectedEdge>) -> Self {
        Self::Walk(walk)
    }
}

impl From<VertexId> for Loop {
    fn from(vertex: VertexId) -> Self {
        Self::Vertex(vertex)
    }
}

/// Rotates a cyclic list of distinct things so that the least comes first.
pub(super) fn turn_to_least<T: Ord>(list: &mut [T]) {
    let least = list.iter().enumerate().min_by(|a, b| a.1.cmp(b.1)).map_or(0, |(i, _)| i);
    list.rotate_left(least);
}

/// A place in a face where an edge can be put in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Corner {
    /// The corner from which the face's loop walks on by this edge. It names one corner even where a loop passes a vertex
    /// several times.
    Leaving(DirectedEdge),
    /// The vertex that is a loop of its own.
    Vertex(VertexId),
}

/// How a joint of sheets is made (Lipson & Shpitalni); the default is a free edge.
///
/// It is a label: what "free" means for wires and inner edges is the designer's affair, as in the paper ("a free edge can be
/// internal in any other sense").
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EdgeClass {
    /// Neither bend nor weld.
    #[default]
    Free,
    /// Bent there: one piece of material on both sides.
    Bend,
    /// Welded, or bonded in any other way.
    Weld,
}

impl EdgeClass {
    pub(super) fn is_free(&self) -> bool {
        *self == Self::Free
    }
}
