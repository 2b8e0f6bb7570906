//! Operators on edges: wires, edges between the loops of a face, split and merge, class and order.

use glam::DVec3;

use super::connected::Without;
use super::ids::{
    Corner, DirectedEdge, EdgeClass, EdgeId, End, FaceId, FaceUse, Loop, VertexId, turn_to_least,
};
use super::operation::{Delta, EdgeKind, Operation, Outcome, RadialOrder};
use super::plan::{Step, must_be_finite};
use super::refusal::Reason;
use super::{Complex, Edge};

fn make_edge(kind: EdgeKind, ends: [VertexId; 2], class: EdgeClass) -> (Operation, Delta) {
    match kind {
        EdgeKind::Chole => {
            (Operation::MakeEdgeChole { ends, class }, Delta { e: 1, ch: 1, ..Delta::default() })
        }
        EdgeKind::Complex => {
            (Operation::MakeEdgeKillComplex { ends, class }, Delta { e: 1, c: -1, ..Delta::default() })
        }
    }
}

fn kill_edge(kind: EdgeKind, edge: EdgeId) -> Operation {
    match kind {
        EdgeKind::Chole => Operation::KillEdgeChole { edge },
        EdgeKind::Complex => Operation::KillEdgeMakeComplex { edge },
    }
}

impl Complex {
    pub(super) fn plan_make_edge(
        &self,
        ends: [VertexId; 2],
        class: EdgeClass,
        wanted: Option<EdgeKind>,
    ) -> Result<(EdgeKind, Step), Reason> {
        self.must_have_room()?;
        for v in ends {
            self.vertex(v)?;
        }
        if ends[0] == ends[1] {
            return Err(Reason::SelfLoop(ends[0]));
        }
        let found = if self.connected(ends[0], ends[1]) { EdgeKind::Chole } else { EdgeKind::Complex };
        if wanted.is_some_and(|w| w != found) {
            return Err(Reason::EdgeKind { between: ends, found });
        }
        let (operation, delta) = make_edge(found, ends, class);
        Ok((found, Step { operation, inverse: kill_edge(found, self.next_edge()), delta }))
    }

    pub(super) fn plan_kill_edge(
        &self,
        edge: EdgeId,
        wanted: Option<EdgeKind>,
    ) -> Result<(EdgeKind, Step), Reason> {
        let e = self.edge(edge)?;
        if !e.uses.is_empty() {
            return Err(Reason::FacesAtEdge { edge, faces: self.faces_of(edge) });
        }
        let without = Without { edge: Some(edge), ..Without::default() };
        let still = self.connected_without(e.ends[0], e.ends[1], without);
        let found = if still { EdgeKind::Chole } else { EdgeKind::Complex };
        if wanted.is_some_and(|w| w != found) {
            return Err(Reason::EdgeKind { between: e.ends, found });
        }
        let (inverse, delta) = make_edge(found, e.ends, e.class);
        Ok((found, Step { operation: kill_edge(found, edge), inverse, delta: -delta }))
    }

    pub(super) fn plan_make_edge_kill_ring(
        &self,
        face: FaceId,
        from: Corner,
        to: Corner,
        class: EdgeClass,
    ) -> Result<Step, Reason> {
        self.must_have_room()?;
        let (i, _) = self.must_be_corner(face, from, None)?;
        let (j, _) = self.must_be_corner(face, to, None)?;
        if i == j {
            return Err(Reason::SameLoop(face));
        }
        if let (Some(a), Some(b)) = (self.corner_vertex(from), self.corner_vertex(to))
            && a == b
        {
            return Err(Reason::SelfLoop(a));
        }
        Ok(Step {
            operation: Operation::MakeEdgeKillRing { face, from, to, class },
            inverse: Operation::KillEdgeMakeRing {
                edge: self.next_edge(),
                // Where both loops are rings, both parts stay rings.
                ring: if j == 0 { End::Start } else { End::End },
            },
            delta: Delta { e: 1, r: -1, ..Delta::default() },
        })
    }

    pub(super) fn act_make_edge_kill_ring(
        &mut self,
        face: FaceId,
        from: Corner,
        to: Corner,
        class: EdgeClass,
    ) -> Outcome {
        let (Some(a), Some(b)) = (self.corner_vertex(from), self.corner_vertex(to)) else {
            return Outcome::default();
        };
        let (Some((i, at)), Some((j, and))) = (self.find_corner(face, from), self.find_corner(face, to))
        else {
            return Outcome::default();
        };
        let edge = self.insert_edge([a, b], class);
        self.edit_loops(face, |loops| {
            let turned = |l: &Loop, at: usize| {
                let mut walk = l.edges().to_vec();
                // A single vertex has no edges to turn.
                let at = at.min(walk.len());
                walk.rotate_left(at);
                walk
            };
            let mut walk = vec![DirectedEdge::along(edge)];
            walk.extend(turned(&loops[j], and));
            walk.push(DirectedEdge::against(edge));
            walk.extend(turned(&loops[i], at));
            loops[i.min(j)] = Loop::Walk(walk);
            loops.remove(i.max(j));
        });
        self.set_uses(edge, vec![FaceUse { face, along: false }, FaceUse { face, along: true }]);
        Outcome { edge: Some(edge), face: Some(face), ..Outcome::default() }
    }

    /// The loop that walks an edge to and fro: its number, the part at the edge's end, the part at its start.
    fn isthmus(&self, edge: EdgeId) -> Option<(FaceId, usize, Vec<DirectedEdge>, Vec<DirectedEdge>)> {
        let [x, y] = self.uses(edge)[..] else { return None };
        if x.face != y.face {
            return None;
        }
        let loops = self.loops(x.face);
        let i = loops.iter().position(|l| l.edges().contains(&DirectedEdge::along(edge)))?;
        let mut walk = loops[i].edges().to_vec();
        let start = walk.iter().position(|d| *d == DirectedEdge::along(edge))?;
        walk.rotate_left(start);
        let back = walk.iter().position(|d| *d == DirectedEdge::against(edge))?;
        Some((x.face, i, walk[1..back].to_vec(), walk[back + 1..].to_vec()))
    }

    pub(super) fn plan_kill_edge_make_ring(&self, edge: EdgeId, ring: End) -> Result<Step, Reason> {
        let e = self.edge(edge)?;
        let Some((face, _, at_end, at_start)) = self.isthmus(edge) else {
            return Err(Reason::NotIsthmus { edge, faces: self.faces_of(edge) });
        };
        // A vertex is a loop of a face once at most.
        let single = [(&at_start, e.ends[0]), (&at_end, e.ends[1])];
        for (_, v) in single.iter().filter(|(part, _)| part.is_empty()) {
            if self.faces_pierced_at(*v).binary_search(&face).is_ok() {
                return Err(Reason::RingTwice(*v));
            }
        }
        let corner =
            |part: &[DirectedEdge], v| part.first().map_or(Corner::Vertex(v), |d| Corner::Leaving(*d));
        Ok(Step {
            operation: Operation::KillEdgeMakeRing { edge, ring },
            inverse: Operation::MakeEdgeKillRing {
                face,
                from: corner(&at_start, e.ends[0]),
                to: corner(&at_end, e.ends[1]),
                class: e.class,
            },
            delta: Delta { e: -1, r: 1, ..Delta::default() },
        })
    }

    pub(super) fn act_kill_edge_make_ring(&mut self, edge: EdgeId, ring: End) -> Outcome {
        let (Some([a, b]), Some((face, i, at_end, at_start))) = (self.ends(edge), self.isthmus(edge)) else {
            return Outcome::default();
        };
        let part =
            |walk: Vec<DirectedEdge>, v| if walk.is_empty() { Loop::Vertex(v) } else { Loop::Walk(walk) };
        let (at_end, at_start) = (part(at_end, b), part(at_start, a));
        let (stays, goes) = if ring == End::End { (at_start, at_end) } else { (at_end, at_start) };
        self.edit_loops(face, |loops| {
            loops[i] = stays;
            loops.push(goes);
        });
        self.remove_edge(edge);
        Outcome { edge: Some(edge), face: Some(face), ..Outcome::default() }
    }

    pub(super) fn plan_split_edge(
        &self,
        edge: EdgeId,
        position: DVec3,
        kept: End,
        flipped: bool,
    ) -> Result<Step, Reason> {
        must_be_finite(position)?;
        self.must_have_room()?;
        self.edge(edge)?;
        Ok(Step {
            operation: Operation::SplitEdge { edge, position, kept, flipped },
            inverse: Operation::MergeEdge { kept: edge, vertex: self.next_vertex() },
            delta: Delta { v: 1, e: 1, ..Delta::default() },
        })
    }

    pub(super) fn act_split_edge(
        &mut self,
        edge: EdgeId,
        position: DVec3,
        kept: End,
        flipped: bool,
    ) -> Outcome {
        let Some(Edge { ends: [a, b], class, uses }) = self.edges.get(edge.0).cloned() else {
            return Outcome::default();
        };
        let m = self.insert_vertex(position);
        self.tell_ends(edge, [a, b], false);
        let ends = if kept == End::Start { [a, m] } else { [m, b] };
        if let Some(e) = self.edges.get_mut(edge.0) {
            e.ends = ends;
        }
        self.tell_ends(edge, ends, true);
        let mut ends = if kept == End::Start { [m, b] } else { [a, m] };
        if flipped {
            ends.reverse();
        }
        let new = self.insert_edge(ends, class);
        // Both halves in the direction of the edge.
        let halves = match kept {
            End::Start => [DirectedEdge::along(edge), DirectedEdge { edge: new, reversed: flipped }],
            End::End => [DirectedEdge { edge: new, reversed: flipped }, DirectedEdge::along(edge)],
        };
        for f in self.faces_of(edge) {
            self.edit_loops(f, |loops| {
                for l in loops.iter_mut() {
                    if let Loop::Walk(walk) = l
                        && walk.iter().any(|d| d.edge == edge)
                    {
                        *walk = walk.iter().flat_map(|d| through(*d, edge, halves)).collect();
                    }
                }
            });
        }
        self.set_uses(new, if flipped { turned_round(&uses) } else { uses });
        Outcome { vertex: Some(m), edge: Some(new), ..Outcome::default() }
    }

    /// The other edge at a vertex between two, and both in one direction, the one that begins the pair first.
    fn pair(&self, kept: EdgeId, vertex: VertexId) -> Result<(EdgeId, [DirectedEdge; 2]), Reason> {
        let e = self.edge(kept)?;
        let v = self.vertex(vertex)?;
        let other = match v.edges[..] {
            [x, y] if x == kept => y,
            [x, y] if y == kept => x,
            _ => return Err(Reason::NotTwoEdges { vertex, edges: v.edges.clone() }),
        };
        if !v.faces.is_empty() {
            return Err(Reason::VertexInUse { vertex, edges: v.edges.clone(), faces: v.faces.clone() });
        }
        let o = self.edge(other)?;
        let first = e.ends[1] == vertex;
        // In the direction of the kept edge.
        let other_reversed = if first { o.ends[0] != vertex } else { o.ends[1] != vertex };
        let o = DirectedEdge { edge: other, reversed: other_reversed };
        let k = DirectedEdge::along(kept);
        Ok((other, if first { [k, o] } else { [o, k] }))
    }

    pub(super) fn plan_merge_edge(&self, kept: EdgeId, vertex: VertexId) -> Result<Step, Reason> {
        let (other, pair) = self.pair(kept, vertex)?;
        let (e, o) = (self.edge(kept)?, self.edge(other)?);
        if e.class != o.class {
            return Err(Reason::ClassesDiffer([kept, other]));
        }
        if self.origin(pair[0]) == self.target(pair[1]) {
            return Err(Reason::SelfLoop(self.origin(pair[0]).unwrap_or(vertex)));
        }
        let flipped = pair.iter().any(|d| d.reversed);
        // Every walk that comes to the vertex by one edge must leave it by the other.
        let mut turns: Vec<FaceId> = Vec::new();
        for f in self.faces_of(kept).into_iter().chain(self.faces_of(other)) {
            for l in self.loops(f) {
                let walk = l.edges();
                let next = walk.iter().cycle().skip(1);
                let turn = |(d, n): (&DirectedEdge, &DirectedEdge)| {
                    self.target(*d) == Some(vertex) && d.edge == n.edge
                };
                if walk.iter().zip(next).any(turn) {
                    turns.push(f);
                }
            }
        }
        let mut uses = if flipped { turned_round(&o.uses) } else { o.uses.clone() };
        turn_to_least(&mut uses);
        if turns.is_empty() && uses != e.uses {
            turns = [self.faces_of(kept), self.faces_of(other)].concat();
        }
        if !turns.is_empty() {
            turns.sort_unstable();
            turns.dedup();
            return Err(Reason::FacesTurn { vertex, faces: turns });
        }
        Ok(Step {
            operation: Operation::MergeEdge { kept, vertex },
            inverse: Operation::SplitEdge {
                edge: kept,
                position: self.vertex(vertex)?.position,
                kept: if pair[0].edge == kept { End::Start } else { End::End },
                flipped,
            },
            delta: Delta { v: -1, e: -1, ..Delta::default() },
        })
    }

    pub(super) fn act_merge_edge(&mut self, kept: EdgeId, vertex: VertexId) -> Outcome {
        let Ok((other, pair)) = self.pair(kept, vertex) else { return Outcome::default() };
        let (Some(a), Some(b), Some(old)) = (self.origin(pair[0]), self.target(pair[1]), self.ends(kept))
        else {
            return Outcome::default();
        };
        for f in self.faces_of(kept) {
            self.edit_loops(f, |loops| {
                for l in loops.iter_mut() {
                    if let Loop::Walk(walk) = l {
                        walk.retain(|d| d.edge != other);
                    }
                }
            });
        }
        self.remove_edge(other);
        self.tell_ends(kept, old, false);
        if let Some(e) = self.edges.get_mut(kept.0) {
            e.ends = [a, b];
        }
        self.tell_ends(kept, [a, b], true);
        self.vertices.remove(vertex.0);
        Outcome { vertex: Some(vertex), edge: Some(other), ..Outcome::default() }
    }

    pub(super) fn plan_set_edge_class(&self, edge: EdgeId, class: EdgeClass) -> Result<Step, Reason> {
        let old = self.edge(edge)?.class;
        Ok(Step {
            operation: Operation::SetEdgeClass { edge, class },
            inverse: Operation::SetEdgeClass { edge, class: old },
            delta: Delta::default(),
        })
    }

    pub(super) fn plan_order_edge(&self, order: &RadialOrder) -> Result<Step, Reason> {
        let RadialOrder { edge, uses } = order;
        let old = self.edge(*edge)?.uses.clone();
        let mut uses = uses.clone();
        turn_to_least(&mut uses);
        let [mut x, mut y] = [&uses, &old].map(Clone::clone);
        x.sort_unstable();
        y.sort_unstable();
        if x != y {
            return Err(Reason::RadialGiven { edge: *edge, faces: self.faces_of(*edge) });
        }
        let mut after = self.clone();
        after.set_uses(*edge, uses.clone());
        let change = after.cavities() - self.cavities();
        if change != 0 {
            return Err(Reason::OrderChangesRegions { edge: *edge, change });
        }
        Ok(Step {
            operation: Operation::OrderEdge { order: RadialOrder { edge: *edge, uses } },
            inverse: Operation::OrderEdge { order: RadialOrder { edge: *edge, uses: old } },
            delta: Delta::default(),
        })
    }
}

/// A directed edge after its edge was split into halves.
fn through(d: DirectedEdge, edge: EdgeId, [p, q]: [DirectedEdge; 2]) -> Vec<DirectedEdge> {
    match (d.edge == edge, d.reversed) {
        (false, _) => vec![d],
        (true, false) => vec![p, q],
        (true, true) => vec![q.flipped(), p.flipped()],
    }
}

/// Uses seen from the edge turned round: the other way about it.
pub(super) fn turned_round(uses: &[FaceUse]) -> Vec<FaceUse> {
    uses.iter().rev().map(|u| u.flipped()).collect()
}
