//! Sequences of operators that take faces up and lay them down again on other edges: what uniting, dividing and turning are made of.
//!
//! Faces that are laid down in the opposite order in which they were taken up get their ids back.

use std::collections::{BTreeMap, BTreeSet};

use super::edge_operators::turned_round;
use super::editor::Editor;
use super::ids::{DirectedEdge, EdgeClass, EdgeId, FaceId, FaceUse, Loop, VertexId};
use super::operation::{Delta, NewFace, Outcome, RadialOrder};
use super::refusal::{Reason, Refusal};

/// Faces taken up, and the orders about their edges before.
#[derive(Clone, Debug, Default)]
pub(super) struct Lifted {
    /// In the order in which they were taken up.
    pub(super) faces: Vec<(FaceId, Vec<Loop>)>,
    /// Orders to come, by edge. An edge that is not named gets its order from the positions.
    pub(super) orders: BTreeMap<EdgeId, Vec<FaceUse>>,
}

/// An edge taken up.
#[derive(Clone, Copy, Debug)]
struct LiftedEdge {
    edge: EdgeId,
    ends: [VertexId; 2],
    class: EdgeClass,
}

impl Editor {
    /// Takes faces up.
    pub(super) fn lift(
        &mut self,
        faces: impl IntoIterator<Item = FaceId>,
        delta: &mut Delta,
    ) -> Result<Lifted, Refusal> {
        let mut lifted = Lifted::default();
        let faces: Vec<FaceId> = faces.into_iter().collect();
        for &f in &faces {
            for d in self.complex().loops(f).iter().flat_map(Loop::edges) {
                lifted.orders.insert(d.edge, self.complex().uses(d.edge).to_vec());
            }
        }
        for f in faces {
            lifted.faces.push((f, self.complex().loops(f).to_vec()));
            *delta = *delta + self.kill_face(f)?.delta;
        }
        Ok(lifted)
    }

    /// Lays a face down: of the orders to come, that of the faces which are there by now.
    pub(super) fn lay(
        &mut self,
        loops: &[Loop],
        orders: &BTreeMap<EdgeId, Vec<FaceUse>>,
        delta: &mut Delta,
    ) -> Result<FaceId, Refusal> {
        let face = self.complex().next_face();
        let edges: BTreeSet<DirectedEdge> = loops.iter().flat_map(Loop::edges).copied().collect();
        let mut radial = BTreeMap::new();
        for d in &edges {
            if let Some(order) = orders.get(&d.edge) {
                let there = self.complex().uses(d.edge);
                let new = |u: &FaceUse| u.face == face && edges.contains(&u.at(d.edge));
                let uses: Vec<_> = order.iter().copied().filter(|u| there.contains(u) || new(u)).collect();
                radial.insert(d.edge, uses);
            }
        }
        let Some((outer, rings)) = loops.split_first() else {
            return Err(Refusal { operator: "make_face", reason: Reason::EmptyLoop });
        };
        let radial = radial.into_iter().map(|(edge, uses)| RadialOrder { edge, uses }).collect();
        let made = self.make_face(NewFace { outer: outer.clone(), rings: rings.to_vec(), radial })?;
        *delta = *delta + made.delta;
        Ok(made.face)
    }

    /// Lays all faces down again, with edges and vertices substituted.
    pub(super) fn lay_all(
        &mut self,
        lifted: &Lifted,
        edge: impl Fn(FaceId, DirectedEdge) -> DirectedEdge,
        vertex: impl Fn(VertexId) -> VertexId,
        delta: &mut Delta,
    ) -> Result<(), Refusal> {
        for (f, loops) in lifted.faces.iter().rev() {
            let substituted = loops.iter().map(|l| match l {
                Loop::Vertex(v) => Loop::Vertex(vertex(*v)),
                Loop::Walk(walk) => Loop::Walk(walk.iter().map(|d| edge(*f, *d)).collect()),
            });
            self.lay(&substituted.collect::<Vec<_>>(), &lifted.orders, delta)?;
        }
        Ok(())
    }

    /// Turns a face over: its normal points the other way. No count changes.
    ///
    /// Sequence: kill the face, make it with all loops reversed. O(component).
    ///
    /// # Errors
    /// [`Reason::NoFace`].
    pub fn flip_face(&mut self, face: FaceId) -> Result<Delta, Refusal> {
        let ((), delta) = self.sequence(|editor, delta| {
            let mut lifted = editor.lift([face], delta)?;
            for uses in lifted.orders.values_mut() {
                for u in uses.iter_mut().filter(|u| u.face == face) {
                    *u = u.flipped();
                }
            }
            let loops: Vec<Loop> = lifted.faces.iter().flat_map(|(_, l)| l).map(Loop::reversed).collect();
            editor.lay(&loops, &lifted.orders, delta).map(|_| ())
        })?;
        Ok(delta)
    }

    /// Makes one vertex of two: the edges and faces of `gone` hang on `kept`, which stays where it is.
    ///
    /// ```text
    ///    ╲       ╱          ╲ ╱
    ///     •     •     →      •
    ///    ╱ kept  ╲          ╱ ╲
    /// ```
    /// v −1, and C −1 where they hung on two components, else Ch +1. Two edges to one vertex stay two (touching free edges), see
    /// [`Self::unite_edges`]. Sequence: kill the faces and edges at `gone`, kill it, make the edges and faces again at `kept`; all
    /// keep their ids. O(star of `gone`), and the searches of its operators. Lipson: KCV (b) where C −1.
    ///
    /// # Errors
    /// [`Reason::NoVertex`]; [`Reason::SelfLoop`] where an edge joins the two, or they are one; refusals of the face operators where a
    /// face cannot be there then.
    pub fn merge_vertices(&mut self, kept: VertexId, gone: VertexId) -> Result<Outcome, Refusal> {
        let operator = "merge_vertices";
        for v in [kept, gone] {
            self.complex().vertex(v).map_err(|reason| Refusal { operator, reason })?;
        }
        if kept == gone || !self.complex().edges_between(kept, gone).is_empty() {
            return Err(Refusal { operator, reason: Reason::SelfLoop(kept) });
        }
        let ((), delta) = self.sequence(|editor, delta| {
            let edges = editor.complex().edges_at(gone).to_vec();
            let (lifted, taken) = editor.lift_star(&edges, Some(gone), delta)?;
            *delta = *delta + editor.kill_vertex_complex(gone)?;
            let vertex = |v| if v == gone { kept } else { v };
            editor.make_edges(&taken, vertex, delta)?;
            editor.lay_all(&lifted, |_, d| d, vertex, delta)
        })?;
        Ok(Outcome { vertex: Some(kept), delta, ..Outcome::default() })
    }

    /// Makes two vertices of one: the given edges, with their faces, hang on a new vertex at `position`.
    ///
    /// v +1, and C +1 where that parts the component, else Ch −1 (or what the faces that part do). Inverse of
    /// [`Self::merge_vertices`]. Sequence: kill these edges and their faces, make the vertex, make them again there.
    /// O(star of the vertex), and the searches of its operators. Lipson: MCV (b), the split operation, where C +1.
    ///
    /// # Errors
    /// [`Reason::NoVertex`], [`Reason::NoEdge`], [`Reason::NotFinite`]; [`Reason::OpenLoop`] where a face has one of the edges and
    /// another edge of the vertex: its loop would break.
    pub fn split_vertex(
        &mut self,
        vertex: VertexId,
        edges: &[EdgeId],
        position: glam::DVec3,
    ) -> Result<Outcome, Refusal> {
        let operator = "split_vertex";
        let here =
            self.complex().vertex(vertex).map_err(|reason| Refusal { operator, reason })?.edges.clone();
        if let Some(e) = edges.iter().find(|e| here.binary_search(e).is_err()) {
            return Err(Refusal { operator, reason: Reason::NoEdge(*e) });
        }
        let edges: Vec<EdgeId> = here.into_iter().filter(|e| edges.contains(e)).collect();
        let (new, delta) = self.sequence(|editor, delta| {
            let (lifted, taken) = editor.lift_star(&edges, None, delta)?;
            let new = editor.make_vertex_complex(position)?;
            *delta = *delta + Delta { v: 1, c: 1, ..Delta::default() };
            editor.make_edges(&taken, |v| if v == vertex { new } else { v }, delta)?;
            editor.lay_all(&lifted, |_, d| d, |v| v, delta)?;
            Ok(new)
        })?;
        Ok(Outcome { vertex: Some(new), delta, ..Outcome::default() })
    }

    /// Takes up edges with all their faces, and the faces that have `single` as a loop.
    fn lift_star(
        &mut self,
        edges: &[EdgeId],
        single: Option<VertexId>,
        delta: &mut Delta,
    ) -> Result<(Lifted, Vec<LiftedEdge>), Refusal> {
        let mut faces: BTreeSet<FaceId> = edges.iter().flat_map(|e| self.complex().faces_of(*e)).collect();
        faces.extend(single.iter().flat_map(|v| self.complex().faces_pierced_at(*v)));
        let lifted = self.lift(faces, delta)?;
        let mut taken = Vec::new();
        for &edge in edges {
            let e = self.complex().edge(edge).map_err(|reason| Refusal { operator: "kill_edge", reason })?;
            taken.push(LiftedEdge { edge, ends: e.ends, class: e.class });
            *delta = *delta + self.kill_edge(edge)?.delta;
        }
        Ok((lifted, taken))
    }

    /// Makes edges again in the opposite order: they get their ids back.
    fn make_edges(
        &mut self,
        taken: &[LiftedEdge],
        vertex: impl Fn(VertexId) -> VertexId,
        delta: &mut Delta,
    ) -> Result<(), Refusal> {
        for LiftedEdge { edge, ends: [a, b], class } in taken.iter().rev() {
            let made = self.make_edge_of_class(vertex(*a), vertex(*b), *class)?;
            debug_assert_eq!(made.edge, *edge);
            *delta = *delta + made.delta;
        }
        Ok(())
    }

    /// Makes one edge of two that have the same ends: the faces of `gone` hang on `kept`.
    ///
    /// ```text
    ///    ░░░░•░░░░           ░░░░•░░░░
    ///    ░░░╱ ╲░░░           ░░░░│░░░░
    ///    ░░│   │░░     →     ░░░░│░░░░
    ///    ░░░╲ ╱░░░           ░░░░│░░░░
    ///    ░░░░•░░░░           ░░░░•░░░░
    /// ```
    /// e −1, and Cc +1 where that closes a region (Lipson fig. 6e: MUKE), else Ch −1 (fig. 6d). Where the edge then has more than two uses,
    /// `order` says their radial order; without, it is found from the positions. Sequence: kill the faces of `gone` and it, make them
    /// again on `kept`; faces keep their ids. To join edges with different ends, [`Self::merge_vertices`] first (figs. 6a–6c).
    ///
    /// # Errors
    /// [`Reason::NoEdge`], [`Reason::NotParallel`]; [`Reason::UsedTwice`] where a face would walk the edge twice one way; refusals of the
    /// radial place.
    pub fn unite_edges(
        &mut self,
        kept: EdgeId,
        gone: EdgeId,
        order: Option<RadialOrder>,
    ) -> Result<Outcome, Refusal> {
        let operator = "unite_edges";
        let [k, g] = [kept, gone].map(|e| self.complex().edge(e).map(|x| x.ends));
        let (k, g) = (
            k.map_err(|reason| Refusal { operator, reason })?,
            g.map_err(|reason| Refusal { operator, reason })?,
        );
        let reversed = k == [g[1], g[0]];
        if kept == gone || (k != g && !reversed) {
            return Err(Refusal { operator, reason: Reason::NotParallel([kept, gone]) });
        }
        let ((), delta) = self.sequence(|editor, delta| {
            let faces = editor.complex().faces_of(gone);
            let mut lifted = editor.lift(faces, delta)?;
            let there = editor.complex().uses(kept).to_vec();
            *delta = *delta + editor.kill_edge(gone)?.delta;
            let coming = lifted.orders.remove(&gone).unwrap_or_default();
            // A face that has both edges was lifted from the kept one too.
            let before = lifted.orders.remove(&kept).unwrap_or(there);
            match order {
                Some(order) => {
                    lifted.orders.insert(kept, order.uses);
                }
                None if before.len() + coming.len() <= 2 => {}
                None if before.is_empty() => {
                    let coming = if reversed { turned_round(&coming) } else { coming };
                    lifted.orders.insert(kept, coming);
                }
                None if coming.is_empty() => {
                    lifted.orders.insert(kept, before);
                }
                None => {}
            }
            let edge = |_, d: DirectedEdge| match d.edge == gone {
                true => DirectedEdge { edge: kept, reversed: d.reversed != reversed },
                false => d,
            };
            editor.lay_all(&lifted, edge, |v| v, delta)
        })?;
        Ok(Outcome { edge: Some(kept), delta, ..Outcome::default() })
    }

    /// Makes two edges of one: the given uses hang on a new edge with the same ends, direction and class. Inverse of
    /// [`Self::unite_edges`]. e +1, and Cc −1 or Ch +1. Lipson: KUME where Cc −1.
    ///
    /// # Errors
    /// [`Reason::NoEdge`]; [`Reason::RadialGiven`] where a use is not one of the edge.
    pub fn divide_edge(&mut self, edge: EdgeId, uses: &[FaceUse]) -> Result<Outcome, Refusal> {
        let operator = "divide_edge";
        let old = self.complex().edge(edge).map_err(|reason| Refusal { operator, reason })?.clone();
        if uses.iter().any(|u| !old.uses.contains(u)) {
            let faces = self.complex().faces_of(edge);
            return Err(Refusal { operator, reason: Reason::RadialGiven { edge, faces } });
        }
        let (new, delta) = self.sequence(|editor, delta| {
            let faces: BTreeSet<FaceId> = uses.iter().map(|u| u.face).collect();
            let mut lifted = editor.lift(faces, delta)?;
            let made = editor.make_edge_of_class(old.ends[0], old.ends[1], old.class)?;
            *delta = *delta + made.delta;
            let (go, stay): (Vec<_>, Vec<_>) = old.uses.iter().copied().partition(|u| uses.contains(u));
            lifted.orders.insert(edge, stay);
            lifted.orders.insert(made.edge, go);
            let substitute = |face, d: DirectedEdge| {
                let moves = d.edge == edge && uses.contains(&FaceUse { face, along: !d.reversed });
                if moves { DirectedEdge { edge: made.edge, ..d } } else { d }
            };
            editor.lay_all(&lifted, substitute, |v| v, delta)?;
            Ok(made.edge)
        })?;
        Ok(Outcome { edge: Some(new), delta, ..Outcome::default() })
    }
}
