//! General non-manifold cell complexes and the extended Euler operators on them.
//!
//! A [`Complex`] holds vertices, edges and faces of any number of corners: wires, struts, faces with holes (*rings*), any number
//! of faces at an edge, closed cavities, several components. It is what modelling commands edit; a [`crate::body::Body`]
//! of triangles is what they hand on.
//!
//! ```text
//!   vertex ── position, its edges, faces of which it is a loop by itself
//!   edge ──── two ends; its face uses, clockwise about the edge
//!   face ──── loops, the outer one first, then rings; a loop is a closed walk of directed edges or a single vertex
//! ```
//!
//! * [`Editor`] has the operators. Each first finds out whether it may ([`Refusal`]: reason, entities in the way, remedy), then acts
//!   and logs itself and its inverse: undo, redo, transactions that roll back whole, journals that can be saved and replayed.
//! * Operators that exist in two kinds (an edge joins two components or closes a cycle, a face fills a hole or closes a cavity)
//!   find the kind out from the topology alone; the strict names refuse the other kind, [`Editor::make_edge`] and
//!   [`Editor::make_face`] tell it.
//! * [`Complex::counts`] and [`Complex::check`] prove the result: the two sides of the Euler–Poincaré identity are found
//!   independently.
//!
//! # Canonical form
//! Everything whose order means nothing is sorted: a loop starts at its smallest directed edge, rings are in ascending order, the
//! radial list starts at its smallest use, a vertex's edges ascend. Ids come from stacks, last freed first. So an operator and its
//! inverse give back the equal complex, bit for bit and with the same ids, without any hidden state in the journal.
//!
//! # Edges that are refused
//! Edges are straight between two different vertices; there may be several between the same two (free edges that touch but are not
//! joined). A face walks an edge at most once in each direction.
//!
//! Sources: Wang et al. (appendix III: extended Euler operators), Lee & Kim 2001 (§3.1), Lipson & Shpitalni (§4), Weiler 1986
//! (radial order), Masuda 1993 (complexes, holes and cavities).

mod check;
mod connected;
mod counts;
mod edge_operators;
mod editor;
mod face_operators;
mod facet;
mod homology;
mod ids;
mod lee_kim;
mod lipson;
mod operation;
mod operators;
mod plan;
mod radial;
mod refusal;
mod regions;
mod sequences;
mod slots;
mod vertex_operators;

pub use check::{CheckOptions, Defect};
pub use editor::{Editor, Journal, Record, ReplayError};
pub use ids::{Corner, DirectedEdge, EdgeClass, EdgeId, End, FaceId, FaceUse, Loop, VertexId};
pub use lee_kim::{EdgeInFace, NewFaceInFace, RingsTo};
pub use lipson::{SheetCounts, SheetDelta, SheetPlan};
pub use operation::{Delta, EdgeKind, FaceCorner, FaceKind, NewFace, Operation, Outcome, RadialOrder};
pub use operators::{MadeEdge, MadeFace, VertexEdge};
pub use refusal::{Entity, Reason, Refusal};

use glam::DVec3;
use serde::{Deserialize, Serialize};

use ids::turn_to_least;
use slots::Slots;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Vertex {
    position: DVec3,
    /// Ascending.
    edges: Vec<EdgeId>,
    /// Faces of which the vertex is a loop, ascending.
    faces: Vec<FaceId>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Edge {
    ends: [VertexId; 2],
    class: EdgeClass,
    /// Clockwise for one who looks along the edge, the smallest first.
    uses: Vec<FaceUse>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Face {
    /// The outer loop, then the rings in ascending order.
    loops: Vec<Loop>,
}

/// A non-manifold cell complex; see the [module](self).
///
/// It can be stored with serde, ids and free ids included; what is read is checked ([`Complex::check_with`] without positions), and a
/// broken one is an error that tells the first defect.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Stored")]
pub struct Complex {
    vertices: Slots<Vertex>,
    edges: Slots<Edge>,
    faces: Slots<Face>,
}

/// A complex as read, not yet checked.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    vertices: Slots<Vertex>,
    edges: Slots<Edge>,
    faces: Slots<Face>,
}

impl TryFrom<Stored> for Complex {
    type Error = Defect;

    fn try_from(stored: Stored) -> Result<Self, Defect> {
        let Stored { vertices, edges, faces } = stored;
        let complex = Self { vertices, edges, faces };
        let defects = complex.check_with(CheckOptions { positions: false });
        defects.into_iter().next().map_or(Ok(complex), Err)
    }
}

impl Complex {
    /// An empty complex.
    pub fn new() -> Self {
        Self::default()
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    /// Number of edges.
    pub fn edge_count(&self) -> usize {
        self.edges.len()
    }

    /// Number of faces.
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// All vertices, ascending.
    pub fn vertices(&self) -> impl Iterator<Item = VertexId> + '_ {
        self.vertices.iter().map(|(i, _)| VertexId(i))
    }

    /// All edges, ascending.
    pub fn edges(&self) -> impl Iterator<Item = EdgeId> + '_ {
        self.edges.iter().map(|(i, _)| EdgeId(i))
    }

    /// All faces, ascending.
    pub fn faces(&self) -> impl Iterator<Item = FaceId> + '_ {
        self.faces.iter().map(|(i, _)| FaceId(i))
    }

    /// The id that the next vertex gets. O(1).
    pub fn next_vertex(&self) -> VertexId {
        VertexId(self.vertices.next())
    }

    /// The id that the next edge gets. O(1).
    pub fn next_edge(&self) -> EdgeId {
        EdgeId(self.edges.next())
    }

    /// The id that the next face gets. O(1).
    pub fn next_face(&self) -> FaceId {
        FaceId(self.faces.next())
    }

    /// Where a vertex is, in mm; `None` for a dead id.
    pub fn position(&self, v: VertexId) -> Option<DVec3> {
        Some(self.vertices.get(v.0)?.position)
    }

    /// Edges at a vertex, ascending; none for a dead id. O(1).
    pub fn edges_at(&self, v: VertexId) -> &[EdgeId] {
        self.vertices.get(v.0).map_or(&[], |x| &x.edges)
    }

    /// Faces of which the vertex is a loop by itself, ascending. O(1).
    pub fn faces_pierced_at(&self, v: VertexId) -> &[FaceId] {
        self.vertices.get(v.0).map_or(&[], |x| &x.faces)
    }

    /// Start and end of an edge; `None` for a dead id.
    pub fn ends(&self, e: EdgeId) -> Option<[VertexId; 2]> {
        Some(self.edges.get(e.0)?.ends)
    }

    /// Free, bend or weld; `None` for a dead id.
    pub fn class(&self, e: EdgeId) -> Option<EdgeClass> {
        Some(self.edges.get(e.0)?.class)
    }

    /// Uses of an edge by faces, clockwise for one who looks along it; none for a wire or a dead id. O(1).
    pub fn uses(&self, e: EdgeId) -> &[FaceUse] {
        self.edges.get(e.0).map_or(&[], |x| &x.uses)
    }

    /// The use that follows clockwise about the edge; itself where it is the only one. O(uses).
    pub fn next_use(&self, e: EdgeId, u: FaceUse) -> Option<FaceUse> {
        let uses = self.uses(e);
        let i = uses.iter().position(|x| *x == u)?;
        Some(uses[(i + 1) % uses.len()])
    }

    /// Loops of a face, the outer one first; none for a dead id. O(1).
    pub fn loops(&self, f: FaceId) -> &[Loop] {
        self.faces.get(f.0).map_or(&[], |x| &x.loops)
    }

    /// Where a directed edge begins; `None` for a dead id.
    pub fn origin(&self, d: DirectedEdge) -> Option<VertexId> {
        Some(self.edges.get(d.edge.0)?.ends[usize::from(d.reversed)])
    }

    /// Where a directed edge ends; `None` for a dead id.
    pub fn target(&self, d: DirectedEdge) -> Option<VertexId> {
        self.origin(d.flipped())
    }

    /// Vertices of a loop in the order of its walk. O(loop).
    pub fn loop_vertices(&self, l: &Loop) -> Vec<VertexId> {
        match l {
            Loop::Vertex(v) => vec![*v],
            Loop::Walk(walk) => walk.iter().filter_map(|d| self.origin(*d)).collect(),
        }
    }

    /// Faces that use an edge, each once, ascending. O(uses log uses).
    pub fn faces_of(&self, e: EdgeId) -> Vec<FaceId> {
        let mut faces: Vec<FaceId> = self.uses(e).iter().map(|u| u.face).collect();
        faces.sort_unstable();
        faces.dedup();
        faces
    }

    /// Corners of a face at a vertex, in the order of its loops. O(loops of the face).
    pub fn corners_at(&self, f: FaceId, v: VertexId) -> Vec<Corner> {
        let mut corners = Vec::new();
        for l in self.loops(f) {
            match l {
                Loop::Vertex(w) if *w == v => corners.push(Corner::Vertex(v)),
                Loop::Vertex(_) => {}
                Loop::Walk(walk) => corners
                    .extend(walk.iter().filter(|d| self.origin(**d) == Some(v)).map(|d| Corner::Leaving(*d))),
            }
        }
        corners
    }

    /// Edges that join two vertices, ascending. O(edges at the vertices).
    pub fn edges_between(&self, a: VertexId, b: VertexId) -> Vec<EdgeId> {
        let mut edges = self.edges_at(a).to_vec();
        edges.retain(|e| self.edges_at(b).binary_search(e).is_ok());
        edges
    }

    /// The closed walk through vertices.
    ///
    /// # Errors
    /// [`Reason::NotOneEdge`] where not exactly one edge joins a vertex and the next. O(sum of edges at the vertices).
    pub fn walk(&self, vertices: &[VertexId]) -> Result<Loop, Refusal> {
        if let [v] = vertices {
            return Ok(Loop::Vertex(*v));
        }
        let next = vertices.iter().cycle().skip(1);
        let directed = vertices.iter().zip(next).map(|(&from, &to)| {
            let edges = self.edges_between(from, to);
            match edges[..] {
                [edge] => Ok(DirectedEdge {
                    edge,
                    reversed: self.edges.get(edge.0).is_some_and(|e| e.ends[1] == from),
                }),
                _ => Err(Refusal { operator: "walk", reason: Reason::NotOneEdge { from, to, edges } }),
            }
        });
        Ok(Loop::Walk(directed.collect::<Result<_, _>>()?))
    }

    /// The order about an edge with a new use put in after (clockwise) an old one; for [`NewFace::placed`]. O(uses).
    pub fn order_after(&self, edge: EdgeId, old: FaceUse, new: FaceUse) -> RadialOrder {
        let mut uses = self.uses(edge).to_vec();
        let at = uses.iter().position(|u| *u == old).map_or(uses.len(), |i| i + 1);
        uses.insert(at, new);
        RadialOrder { edge, uses }
    }

    /// Puts the uses of an edge into canonical form.
    fn set_uses(&mut self, e: EdgeId, mut uses: Vec<FaceUse>) {
        turn_to_least(&mut uses);
        if let Some(edge) = self.edges.get_mut(e.0) {
            edge.uses = uses;
        }
    }

    /// Changes the loops of a face: tells vertices that become or cease to be loops, and keeps the canonical form.
    fn edit_loops(&mut self, f: FaceId, edit: impl FnOnce(&mut Vec<Loop>)) {
        let Some(mut loops) = self.faces.get_mut(f.0).map(|x| std::mem::take(&mut x.loops)) else { return };
        self.tell_single(f, &loops, false);
        edit(&mut loops);
        let mut loops: Vec<Loop> = loops.into_iter().map(Loop::canonical).collect();
        if let Some(rings) = loops.get_mut(1..) {
            rings.sort_unstable();
        }
        self.tell_single(f, &loops, true);
        if let Some(face) = self.faces.get_mut(f.0) {
            face.loops = loops;
        }
    }

    /// Enters or strikes the face at the vertices that are loops by themselves.
    fn tell_single(&mut self, f: FaceId, loops: &[Loop], enter: bool) {
        for l in loops {
            if let Loop::Vertex(v) = l
                && let Some(vertex) = self.vertices.get_mut(v.0)
            {
                match (vertex.faces.binary_search(&f), enter) {
                    (Err(i), true) => vertex.faces.insert(i, f),
                    (Ok(i), false) => {
                        vertex.faces.remove(i);
                    }
                    _ => {}
                }
            }
        }
    }

    /// Enters or strikes an edge at its two ends.
    fn tell_ends(&mut self, e: EdgeId, ends: [VertexId; 2], enter: bool) {
        for v in ends {
            if let Some(vertex) = self.vertices.get_mut(v.0) {
                match (vertex.edges.binary_search(&e), enter) {
                    (Err(i), true) => vertex.edges.insert(i, e),
                    (Ok(i), false) => {
                        vertex.edges.remove(i);
                    }
                    _ => {}
                }
            }
        }
    }

    fn insert_vertex(&mut self, position: DVec3) -> VertexId {
        VertexId(self.vertices.insert(Vertex { position, edges: Vec::new(), faces: Vec::new() }))
    }

    fn insert_edge(&mut self, ends: [VertexId; 2], class: EdgeClass) -> EdgeId {
        let e = EdgeId(self.edges.insert(Edge { ends, class, uses: Vec::new() }));
        self.tell_ends(e, ends, true);
        e
    }

    fn remove_edge(&mut self, e: EdgeId) {
        if let Some(edge) = self.edges.remove(e.0) {
            self.tell_ends(e, edge.ends, false);
        }
    }

    /// Loop and place in it of a corner. O(loops of the face).
    fn find_corner(&self, f: FaceId, corner: Corner) -> Option<(usize, usize)> {
        self.loops(f).iter().enumerate().find_map(|(i, l)| match (l, corner) {
            (Loop::Vertex(v), Corner::Vertex(w)) if *v == w => Some((i, 0)),
            (Loop::Walk(walk), Corner::Leaving(d)) => Some((i, walk.iter().position(|x| *x == d)?)),
            _ => None,
        })
    }

    /// The vertex of a corner.
    fn corner_vertex(&self, corner: Corner) -> Option<VertexId> {
        match corner {
            Corner::Vertex(v) => Some(v),
            Corner::Leaving(d) => self.origin(d),
        }
    }
}
