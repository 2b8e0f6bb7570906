//! Lee & Kim's operators by their names (§3.1; counts of Yamaguchi & Kimura: `V − E + F − L = S − C + R`).
//!
//! | name | here | V | E | F | L | S | C | R |
//! |---|---|---|---|---|---|---|---|---|
//! | MVS, KVS | make_vertex_complex | 1 | | | | 1 | | |
//! | MVL, KVL | make_vertex_ring | 1 | | | 1 | | | |
//! | MEV, KEV | make_vertex_edge | 1 | 1 | | | | | |
//! | MEC, KEC | make_edge_chole | | 1 | | | | 1 | |
//! | MEF, KEF | kill the face, make_edge_chole, make two faces; on wires: make_edge_chole, make_face_kill_chole | | 1 | 1 | | | | |
//! | MEKS, KEMS | make_edge_kill_complex | | 1 | | | −1 | | |
//! | MEKL, KEML | make_edge_kill_ring | | 1 | | −1 | | | |
//! | MFKC, KFMC | make_face_kill_chole | | | 1 | | | −1 | |
//! | MFR, KFR | make_face_make_cavity: closes a region | | | 1 | | | | 1 |
//! | SEMV, JEKV | split_edge, merge_edge | 1 | 1 | | | | | |
//!
//! V, E, F, L, S, C, R are v, e, f, r, C, Ch, Cc of [`crate::body::Counts`].

use std::collections::BTreeSet;

use glam::DVec3;
use robust::orient2d;

use super::Complex;
use super::editor::Editor;
use super::ids::{Corner, DirectedEdge, EdgeId, End, FaceId, FaceUse, Loop, VertexId};
use super::operation::{Delta, NewFace};
use super::operators::VertexEdge;
use super::radial::drop_axis;
use super::refusal::{Reason, Refusal};

/// Which rings go to the new face when an edge parts a face.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum RingsTo {
    /// Those that lie inside the new face, in the plane picture of the face (a coordinate dropped, compared exactly).
    #[default]
    ByPosition,
    /// Those that pass one of these vertices.
    NewFace(Vec<VertexId>),
}

/// Where an edge parts a face.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EdgeInFace {
    /// The face.
    pub face: FaceId,
    /// Where the edge begins.
    pub from: Corner,
    /// Where it ends, on the same loop.
    pub to: Corner,
    /// Which rings go to the new face.
    pub rings: RingsTo,
}

/// An edge that parted a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NewFaceInFace {
    /// The edge.
    pub edge: EdgeId,
    /// The part that kept the id: to the left of the edge, or with the old outer loop where the edge parts a ring.
    pub kept: FaceId,
    /// The other part.
    pub new: FaceId,
    /// Change of the counts: e +1, f +1.
    pub delta: Delta,
}

/// The loops of the two parts of a face.
struct Parts {
    kept: Vec<Loop>,
    new: Vec<Loop>,
}

impl Editor {
    /// MVS, make vertex and shell: [`Self::make_vertex_complex`].
    ///
    /// # Errors
    /// Those of it.
    pub fn mvs(&mut self, position: DVec3) -> Result<VertexId, Refusal> {
        self.make_vertex_complex(position)
    }

    /// KVS: [`Self::kill_vertex_complex`].
    ///
    /// # Errors
    /// Those of it.
    pub fn kvs(&mut self, vertex: VertexId) -> Result<Delta, Refusal> {
        self.kill_vertex_complex(vertex)
    }

    /// MVL, make vertex and (hole) loop: [`Self::make_vertex_ring`].
    ///
    /// # Errors
    /// Those of it.
    pub fn mvl(&mut self, face: FaceId, position: DVec3) -> Result<VertexId, Refusal> {
        self.make_vertex_ring(face, position)
    }

    /// KVL: [`Self::kill_vertex_ring`].
    ///
    /// # Errors
    /// Those of it.
    pub fn kvl(&mut self, vertex: VertexId) -> Result<Delta, Refusal> {
        self.kill_vertex_ring(vertex)
    }

    /// MEV, make edge and vertex, as a wire: [`Self::make_vertex_edge`]; inside a face: [`Self::make_vertex_edge_in_face`]. Also Lipson's
    /// MEV (e +1, v +1).
    ///
    /// # Errors
    /// Those of it.
    pub fn mev(&mut self, from: VertexId, position: DVec3) -> Result<VertexEdge, Refusal> {
        self.make_vertex_edge(from, position)
    }

    /// KEV: [`Self::kill_vertex_edge`].
    ///
    /// # Errors
    /// Those of it.
    pub fn kev(&mut self, vertex: VertexId) -> Result<Delta, Refusal> {
        self.kill_vertex_edge(vertex)
    }

    /// MEC, make edge and cycle: [`Self::make_edge_chole`].
    ///
    /// # Errors
    /// Those of it.
    pub fn mec(&mut self, from: VertexId, to: VertexId) -> Result<EdgeId, Refusal> {
        self.make_edge_chole(from, to)
    }

    /// KEC: [`Self::kill_edge_chole`].
    ///
    /// # Errors
    /// Those of it.
    pub fn kec(&mut self, edge: EdgeId) -> Result<Delta, Refusal> {
        self.kill_edge_chole(edge)
    }

    /// MEKS, make edge and kill shell: [`Self::make_edge_kill_complex`].
    ///
    /// # Errors
    /// Those of it.
    pub fn meks(&mut self, from: VertexId, to: VertexId) -> Result<EdgeId, Refusal> {
        self.make_edge_kill_complex(from, to)
    }

    /// KEMS: [`Self::kill_edge_make_complex`].
    ///
    /// # Errors
    /// Those of it.
    pub fn kems(&mut self, edge: EdgeId) -> Result<Delta, Refusal> {
        self.kill_edge_make_complex(edge)
    }

    /// MEKL, make edge and kill (hole) loop: [`Self::make_edge_kill_ring`].
    ///
    /// # Errors
    /// Those of it.
    pub fn mekl(&mut self, face: FaceId, from: Corner, to: Corner) -> Result<EdgeId, Refusal> {
        self.make_edge_kill_ring(face, from, to)
    }

    /// KEML: [`Self::kill_edge_make_ring`].
    ///
    /// # Errors
    /// Those of it.
    pub fn keml(&mut self, edge: EdgeId, ring: End) -> Result<Delta, Refusal> {
        self.kill_edge_make_ring(edge, ring)
    }

    /// MFKC, make face and kill cycle: [`Self::make_face_kill_chole`].
    ///
    /// # Errors
    /// Those of it.
    pub fn mfkc(&mut self, face: NewFace) -> Result<FaceId, Refusal> {
        self.make_face_kill_chole(face)
    }

    /// KFMC: [`Self::kill_face_make_chole`].
    ///
    /// # Errors
    /// Those of it.
    pub fn kfmc(&mut self, face: FaceId) -> Result<Delta, Refusal> {
        self.kill_face_make_chole(face)
    }

    /// MFR, make face and region: [`Self::make_face_make_cavity`].
    ///
    /// # Errors
    /// Those of it.
    pub fn mfr(&mut self, face: NewFace) -> Result<FaceId, Refusal> {
        self.make_face_make_cavity(face)
    }

    /// KFR: [`Self::kill_face_kill_cavity`].
    ///
    /// # Errors
    /// Those of it.
    pub fn kfr(&mut self, face: FaceId) -> Result<Delta, Refusal> {
        self.kill_face_kill_cavity(face)
    }

    /// SEMV, split edge and make vertex: [`Self::split_edge`].
    ///
    /// # Errors
    /// Those of it.
    pub fn semv(&mut self, edge: EdgeId, position: DVec3) -> Result<VertexEdge, Refusal> {
        self.split_edge(edge, position)
    }

    /// JEKV, join edges and kill vertex: [`Self::merge_edge`].
    ///
    /// # Errors
    /// Those of it.
    pub fn jekv(&mut self, kept: EdgeId, vertex: VertexId) -> Result<Delta, Refusal> {
        self.merge_edge(kept, vertex)
    }

    /// MEF, make edge and face, in a face: an edge between two corners of one loop parts the face. Also Lipson's MEF (e +1, f +1).
    ///
    /// ```text
    ///   •─────────•          •────•────•          •─────────•          •─────────•
    ///   │░░░░░░░░░│          │░░░░│▒▒▒▒│          │░░•──•░░░│          │░░•──•░░░│
    ///   │░░░░░░░░░│    →     │░░░░│▒▒▒▒│    or    │░░•──•░░░│    →     │░░•──•▒╲░│
    ///   │░░░░░░░░░│          │░░░░│▒▒▒▒│          │░░░░░░░░░│          │░░░╲___▒│░│
    ///   •─────────•          •────•────•          •─────────•          •─────────•
    /// ```
    /// e +1, f +1. The part to the left of the edge keeps the id. Where the edge parts a ring, the part that it encloses is the
    /// new face, and the one with the old outer loop keeps the id; with [`RingsTo::NewFace`], the part to the right is the new one.
    ///
    /// Sequence: kill the face (either kind), make_edge_chole, make the two faces (either kinds), in the radial places of the old.
    /// O(component) at most. Inverse: [`Self::kef`].
    ///
    /// # Errors
    /// [`Reason::NoFace`], [`Reason::NoCorner`], [`Reason::DifferentLoops`] (that is [`Self::mekl`]), [`Reason::SelfLoop`],
    /// [`Reason::SideUnknown`].
    pub fn mef(&mut self, at: &EdgeInFace) -> Result<NewFaceInFace, Refusal> {
        let refuse = |reason| Refusal { operator: "mef", reason };
        let complex = self.complex();
        let (kept, new) = (at.face, complex.next_face());
        let d = DirectedEdge::along(complex.next_edge());
        let ends = [at.from, at.to].map(|c| complex.corner_vertex(c));
        let parts = complex.parts(at, d).map_err(refuse)?;
        let [Some(a), Some(b)] = ends else { return Err(refuse(Reason::NoFace(kept))) };
        let (edge, delta) = self.sequence(|editor, delta| {
            let mut lifted = editor.lift([kept], delta)?;
            let go: BTreeSet<DirectedEdge> = parts.new.iter().flat_map(Loop::edges).copied().collect();
            for (e, uses) in &mut lifted.orders {
                for u in uses.iter_mut().filter(|u| u.face == kept && go.contains(&u.at(*e))) {
                    u.face = new;
                }
            }
            let edge = editor.make_edge(a, b)?;
            *delta = *delta + edge.delta;
            editor.lay(&parts.kept, &lifted.orders, delta)?;
            editor.lay(&parts.new, &lifted.orders, delta)?;
            Ok(edge.edge)
        })?;
        Ok(NewFaceInFace { edge, kept, new, delta })
    }

    /// MEF on wires: an edge that closes a path of wires, and the face in it.
    ///
    /// ```text
    ///   •─────•          •─────•
    ///   │     │    →     │░░░░░│
    ///   •     •          •─────•
    /// ```
    /// e +1, f +1. `path` leads from `to` back to `from`; the face lies to the left of it. Sequence: make_edge_chole,
    /// make_face_kill_chole. O(component) at most.
    ///
    /// # Errors
    /// Those of the two operators; [`Reason::OpenLoop`] where the path does not lead there.
    pub fn mef_wire(
        &mut self,
        from: VertexId,
        to: VertexId,
        path: &[DirectedEdge],
    ) -> Result<NewFaceInFace, Refusal> {
        let ((edge, face), delta) = self.sequence(|editor, delta| {
            let edge = editor.make_edge_chole(from, to)?;
            let walk = [&[DirectedEdge::along(edge)], path].concat();
            let face = editor.make_face_kill_chole(NewFace::new(walk))?;
            *delta = Delta { e: 1, f: 1, ..Delta::default() };
            Ok((edge, face))
        })?;
        Ok(NewFaceInFace { edge, kept: face, new: face, delta })
    }

    /// KEF, kill edge and face: the two faces of an edge become one, which has the id of the one that walks along the edge; where one of
    /// them lies in a ring of the other, that of the other.
    ///
    /// e −1, f −1. Sequence: kill both faces, kill the edge, make one face of all loops. Inverse of [`Self::mef`], bit for bit where
    /// that made the edge. O(component) at most. Also Lipson's KEF.
    ///
    /// # Errors
    /// [`Reason::NoEdge`]; [`Reason::NotBetweenTwo`] where it has not two uses by two faces; [`Reason::Orientation`] where both walk it
    /// one way; [`Reason::UsedTwice`] where the one face would walk another edge twice one way.
    pub fn kef(&mut self, edge: EdgeId) -> Result<Delta, Refusal> {
        let refuse = |reason| Refusal { operator: "kef", reason };
        let uses = self.complex().edge(edge).map_err(refuse)?.uses.clone();
        let (kept, gone) = match uses[..] {
            [x, y] if x.face == y.face => {
                return Err(refuse(Reason::NotBetweenTwo { edge, faces: vec![x.face] }));
            }
            [x, y] if x.along == y.along => {
                return Err(refuse(Reason::Orientation { edge, faces: [x.face, y.face] }));
            }
            [x, y] => {
                if x.along {
                    (x.face, y.face)
                } else {
                    (y.face, x.face)
                }
            }
            _ => return Err(refuse(Reason::NotBetweenTwo { edge, faces: self.complex().faces_of(edge) })),
        };
        let loops = self.complex().united(edge, kept, gone);
        // A face in whose ring the other one lies keeps its id.
        let in_outer =
            |f| self.complex().loops(f).first().is_some_and(|l| l.edges().iter().any(|d| d.edge == edge));
        let swap = in_outer(kept) && !in_outer(gone);
        let (kept, gone) = if swap { (gone, kept) } else { (kept, gone) };
        let ((), delta) = self.sequence(|editor, delta| {
            let mut lifted = editor.lift([gone, kept], delta)?;
            lifted.orders.remove(&edge);
            for u in lifted.orders.values_mut().flatten().filter(|u| u.face == gone) {
                u.face = kept;
            }
            *delta = *delta + editor.kill_edge(edge)?.delta;
            editor.lay(&loops, &lifted.orders, delta).map(|_| ())
        })?;
        Ok(delta)
    }
}

impl Complex {
    /// The loops of both parts of a face that the edge `d` parts.
    fn parts(&self, at: &EdgeInFace, d: DirectedEdge) -> Result<Parts, Reason> {
        let (i, p) = self.must_be_corner(at.face, at.from, None)?;
        let (j, q) = self.must_be_corner(at.face, at.to, None)?;
        if i != j {
            return Err(Reason::DifferentLoops(at.face));
        }
        let (Some(a), Some(b)) = (self.corner_vertex(at.from), self.corner_vertex(at.to)) else {
            return Err(Reason::NoFace(at.face));
        };
        if a == b {
            return Err(Reason::SelfLoop(a));
        }
        let loops = self.loops(at.face);
        let mut walk = loops[i].edges().to_vec();
        let n = walk.len();
        walk.rotate_left(p);
        let middle = (q + n - p) % n;
        // Closed by the edge: the part to its left, and the one to its right.
        let left = [&walk[middle..], &[d]].concat();
        let right = [&walk[..middle], &[d.flipped()]].concat();
        let (mut mine, mut other) = (left, right);
        let plane = self.picture_plane(loops);
        let picture = |walk: &[DirectedEdge]| -> Option<Vec<robust::Coord<f64>>> {
            let (axis, _) = plane?;
            let end = |x: &DirectedEdge| {
                if x.edge == d.edge { Some(if x.reversed { b } else { a }) } else { self.origin(*x) }
            };
            walk.iter().map(|x| Some(drop_axis(self.position(end(x)?)?, axis))).collect()
        };
        let by_position = at.rings == RingsTo::ByPosition;
        if i > 0 && by_position {
            // The part that runs round as the outer loop does encloses the new face.
            let unknown = Reason::SideUnknown { face: at.face, at: a };
            let area = |walk| picture(walk).map(|p| signed_area(&p));
            let mirrored = plane.is_some_and(|p| p.1);
            match (area(&mine), area(&other)) {
                (Some(m), Some(o)) if (m > 0.0) != (o > 0.0) => {
                    if (m > 0.0) != mirrored {
                        std::mem::swap(&mut mine, &mut other);
                    }
                }
                _ => return Err(unknown),
            }
        }
        let mut parts = if i == 0 {
            Parts { kept: vec![Loop::Walk(mine)], new: vec![Loop::Walk(other.clone())] }
        } else {
            Parts { kept: vec![loops[0].clone(), Loop::Walk(mine)], new: vec![Loop::Walk(other.clone())] }
        };
        for (k, ring) in loops.iter().enumerate().skip(1).filter(|(k, _)| *k != i) {
            let corners = self.loop_vertices(ring);
            let goes = match &at.rings {
                RingsTo::NewFace(list) => corners.iter().any(|v| list.contains(v)),
                RingsTo::ByPosition => {
                    let first = corners.first().copied().ok_or(Reason::EmptyLoop)?;
                    let unknown = Reason::SideUnknown { face: at.face, at: first };
                    let point = plane.zip(self.position(first)).map(|((axis, _), p)| drop_axis(p, axis));
                    let inside = point.zip(picture(&other)).and_then(|(p, polygon)| inside(&polygon, p));
                    inside.ok_or(unknown)?
                }
            };
            let part = if goes { &mut parts.new } else { &mut parts.kept };
            part.push(loops[k].clone());
        }
        Ok(parts)
    }

    /// The loops of the face that two faces become when their edge goes.
    fn united(&self, edge: EdgeId, kept: FaceId, gone: FaceId) -> Vec<Loop> {
        let find = |face, d: DirectedEdge| {
            let loops = self.loops(face);
            let place = loops.iter().enumerate().find_map(|(i, l)| {
                let at = l.edges().iter().position(|x| *x == d)?;
                let mut walk = l.edges().to_vec();
                walk.rotate_left(at);
                Some((i, walk[1..].to_vec()))
            });
            place.unwrap_or_default()
        };
        let (i, left) = find(kept, FaceUse { face: kept, along: true }.at(edge));
        let (j, right) = find(gone, FaceUse { face: gone, along: false }.at(edge));
        let joined = Loop::Walk([left, right].concat());
        let rest = |face: FaceId, without: usize| {
            let loops = self.loops(face).iter().enumerate();
            loops.filter(move |(k, _)| *k != without).map(|(_, l)| l.clone())
        };
        let (of_kept, of_gone): (Vec<_>, Vec<_>) = (rest(kept, i).collect(), rest(gone, j).collect());
        match (i, j) {
            (0, 0) => [vec![joined], of_kept, of_gone].concat(),
            // The outer loop of the face in whose ring the edge lies.
            (0, _) => [of_gone, vec![joined], of_kept].concat(),
            _ => [of_kept, vec![joined], of_gone].concat(),
        }
    }
}

/// Twice the area of a polygon, positive where it runs counterclockwise.
fn signed_area(polygon: &[robust::Coord<f64>]) -> f64 {
    let Some(&o) = polygon.first() else { return 0.0 };
    polygon.windows(2).map(|w| (w[0].x - o.x) * (w[1].y - o.y) - (w[0].y - o.y) * (w[1].x - o.x)).sum()
}

/// Whether a point lies inside a polygon; `None` where it lies on its boundary. Exact.
fn inside(polygon: &[robust::Coord<f64>], p: robust::Coord<f64>) -> Option<bool> {
    let mut inside = false;
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let side = orient2d(a, b, p);
        let within = |l: f64, r: f64, x: f64| x >= l.min(r) && x <= l.max(r);
        if side == 0.0 && within(a.x, b.x, p.x) && within(a.y, b.y, p.y) {
            return None;
        }
        if (a.y > p.y) != (b.y > p.y) && (side > 0.0) == (b.y > a.y) {
            inside = !inside;
        }
    }
    Some(inside)
}
