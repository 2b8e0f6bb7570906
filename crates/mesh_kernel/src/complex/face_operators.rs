//! Operators that make and kill faces.

use std::collections::{BTreeMap, BTreeSet};

use super::connected::Without;
use super::ids::{DirectedEdge, EdgeId, FaceId, FaceUse, Loop, VertexId, turn_to_least};
use super::operation::{Delta, FaceKind, NewFace, Operation, RadialOrder};
use super::plan::Step;
use super::radial::radial_order;
use super::refusal::Reason;
use super::{Complex, Face};

fn make_face(kind: FaceKind, face: NewFace) -> Operation {
    match kind {
        FaceKind::Chole => Operation::MakeFaceKillChole { face },
        FaceKind::Cavity => Operation::MakeFaceMakeCavity { face },
    }
}

fn kill_face(kind: FaceKind, face: FaceId) -> Operation {
    match kind {
        FaceKind::Chole => Operation::KillFaceMakeChole { face },
        FaceKind::Cavity => Operation::KillFaceKillCavity { face },
    }
}

/// Change of the counts by a new face with `rings` rings, whose loops lie in `components` components before.
fn delta(kind: FaceKind, rings: usize, components: usize) -> Delta {
    let (r, joined) = (rings as i64, components as i64 - 1);
    let (fills, closes) = match kind {
        FaceKind::Chole => (1, 0),
        FaceKind::Cavity => (0, 1),
    };
    // Each ring is a bridge to the outer loop: it joins components or closes a cycle. Then the face fills or closes.
    Delta { f: 1, r, c: -joined, ch: r - joined - fills, cc: closes, ..Delta::default() }
}

impl Complex {
    pub(super) fn plan_make_face(
        &self,
        new: &NewFace,
        wanted: Option<FaceKind>,
    ) -> Result<(FaceKind, Step), Reason> {
        self.must_have_room()?;
        let firsts = self.must_be_loops(new)?;
        let loops: Vec<Loop> = new.loops().cloned().collect();
        let orders = self.orders_with(self.next_face(), &loops, &new.radial)?;
        let found = self.kind_of_new_face(self.next_face(), &loops, &orders)?;
        if wanted.is_some_and(|w| w != found) {
            return Err(Reason::FaceKind {
                beside: beside(self.next_face(), orders.values().flatten()),
                found,
            });
        }
        let components = self.components_of(&firsts, Without::default());
        let radial = orders.into_iter().filter(|(_, uses)| uses.len() > 2);
        let resolved = NewFace {
            outer: new.outer.clone(),
            rings: new.rings.clone(),
            radial: radial.map(|(edge, uses)| RadialOrder { edge, uses }).collect(),
        };
        Ok((
            found,
            Step {
                operation: make_face(found, resolved),
                inverse: kill_face(found, self.next_face()),
                delta: delta(found, new.rings.len(), components),
            },
        ))
    }

    /// That all loops are closed walks of edges that live, each walked once a direction, or single vertices. A vertex of each.
    fn must_be_loops(&self, new: &NewFace) -> Result<Vec<VertexId>, Reason> {
        let mut walked = BTreeSet::new();
        let mut single = BTreeSet::new();
        let mut firsts = Vec::new();
        for l in new.loops() {
            match l {
                Loop::Vertex(v) => {
                    self.vertex(*v)?;
                    if !single.insert(*v) {
                        return Err(Reason::RingTwice(*v));
                    }
                    firsts.push(*v);
                }
                Loop::Walk(walk) => {
                    let first = walk.first().ok_or(Reason::EmptyLoop)?;
                    for d in walk {
                        self.edge(d.edge)?;
                        if !walked.insert(*d) {
                            return Err(Reason::UsedTwice(*d));
                        }
                    }
                    for (this, next) in walk.iter().zip(walk.iter().cycle().skip(1)) {
                        if self.target(*this) != self.origin(*next) {
                            return Err(Reason::OpenLoop { this: *this, next: *next });
                        }
                    }
                    firsts.extend(self.origin(*first));
                }
            }
        }
        Ok(firsts)
    }

    /// Orders about all edges of a new face with the face put in, as given or as the positions tell.
    fn orders_with(
        &self,
        face: FaceId,
        loops: &[Loop],
        given: &[RadialOrder],
    ) -> Result<BTreeMap<EdgeId, Vec<FaceUse>>, Reason> {
        let mut own: BTreeMap<EdgeId, Vec<FaceUse>> = BTreeMap::new();
        for d in loops.iter().flat_map(Loop::edges) {
            own.entry(d.edge).or_default().push(FaceUse { face, along: !d.reversed });
        }
        let given: BTreeMap<EdgeId, &[FaceUse]> = given.iter().map(|o| (o.edge, &o.uses[..])).collect();
        if let Some((&edge, _)) = given.iter().find(|(e, _)| !own.contains_key(e)) {
            return Err(Reason::RadialGiven { edge, faces: self.faces_of(edge) });
        }
        let mut orders = BTreeMap::new();
        let mut apexes = None;
        for (edge, new) in own {
            let old = self.uses(edge);
            let mut order = if let Some(order) = given.get(&edge) {
                must_extend(edge, old, &new, order)?;
                order.to_vec()
            } else if old.len() + new.len() > 2 {
                let apexes = apexes.get_or_insert_with(|| self.apexes(loops));
                self.order_by_position(edge, &new, apexes)?
            } else {
                [old, &new].concat()
            };
            turn_to_least(&mut order);
            orders.insert(edge, order);
        }
        Ok(orders)
    }

    /// Puts new uses into the stored order of an edge by the positions.
    fn order_by_position(
        &self,
        edge: EdgeId,
        new: &[FaceUse],
        apexes: &BTreeMap<DirectedEdge, VertexId>,
    ) -> Result<Vec<FaceUse>, Reason> {
        let old = self.uses(edge);
        let all: Vec<FaceUse> = old.iter().chain(new).copied().collect();
        let [a, b] = self.edge(edge)?.ends.map(|v| self.position(v).unwrap_or_default());
        let leaves: Vec<_> = (all.iter().enumerate())
            .map(|(i, u)| match i < old.len() {
                true => self.apex(edge, *u),
                false => apexes.get(&u.at(edge)).and_then(|v| self.position(*v)),
            })
            .collect();
        let faces_of = |which: Vec<usize>| which.into_iter().map(|i| all[i].face).collect();
        let unknown: Vec<usize> = (0..all.len()).filter(|&i| leaves[i].is_none()).collect();
        if !unknown.is_empty() {
            return Err(Reason::RadialTie { edge, faces: faces_of(unknown) });
        }
        let leaves: Vec<_> = leaves.into_iter().flatten().collect();
        let order =
            radial_order(a, b, &leaves).map_err(|tie| Reason::RadialTie { edge, faces: faces_of(tie) })?;
        let order: Vec<FaceUse> = order.into_iter().map(|i| all[i]).collect();
        let mut without: Vec<FaceUse> = order.iter().copied().filter(|u| !new.contains(u)).collect();
        turn_to_least(&mut without);
        if without != old {
            return Err(Reason::RadialStored { edge, faces: old.iter().map(|u| u.face).collect() });
        }
        Ok(order)
    }

    pub(super) fn plan_kill_face(
        &self,
        face: FaceId,
        wanted: Option<FaceKind>,
    ) -> Result<(FaceKind, Step), Reason> {
        let loops = &self.face(face)?.loops;
        let found = self.kind_of_face(face);
        let edges: BTreeSet<EdgeId> = loops.iter().flat_map(Loop::edges).map(|d| d.edge).collect();
        if wanted.is_some_and(|w| w != found) {
            let beside = beside(face, edges.iter().flat_map(|e| self.uses(*e)));
            return Err(Reason::FaceKind { beside, found });
        }
        let firsts: Vec<VertexId> =
            loops.iter().filter_map(|l| self.loop_vertices(l).first().copied()).collect();
        let components = match firsts.len() {
            1 => 1,
            _ => self.components_of(&firsts, Without { face: Some(face), ..Without::default() }),
        };
        let radial = edges.into_iter().filter(|e| self.uses(*e).len() > 2);
        let new = NewFace {
            outer: loops.first().cloned().ok_or(Reason::EmptyLoop)?,
            rings: loops[1..].to_vec(),
            radial: radial.map(|edge| RadialOrder { edge, uses: self.uses(edge).to_vec() }).collect(),
        };
        let delta = -delta(found, loops.len() - 1, components);
        Ok((found, Step { operation: kill_face(found, face), inverse: make_face(found, new), delta }))
    }

    pub(super) fn act_make_face(&mut self, new: &NewFace) -> FaceId {
        let face = FaceId(self.faces.insert(Face { loops: Vec::new() }));
        let own: Vec<DirectedEdge> = new.loops().flat_map(Loop::edges).copied().collect();
        self.edit_loops(face, |loops| loops.extend(new.loops().cloned()));
        let given: BTreeMap<EdgeId, &Vec<FaceUse>> = new.radial.iter().map(|o| (o.edge, &o.uses)).collect();
        for d in own {
            let uses = match given.get(&d.edge) {
                Some(order) => (*order).clone(),
                None => {
                    let mut uses = self.uses(d.edge).to_vec();
                    uses.push(FaceUse { face, along: !d.reversed });
                    uses
                }
            };
            self.set_uses(d.edge, uses);
        }
        face
    }

    pub(super) fn act_kill_face(&mut self, face: FaceId) {
        let edges: BTreeSet<EdgeId> = self.loops(face).iter().flat_map(Loop::edges).map(|d| d.edge).collect();
        self.edit_loops(face, Vec::clear);
        for e in edges {
            let uses = self.uses(e).iter().copied().filter(|u| u.face != face).collect();
            self.set_uses(e, uses);
        }
        self.faces.remove(face.0);
    }
}

/// Other faces at the edges, each once.
fn beside<'a>(face: FaceId, uses: impl Iterator<Item = &'a FaceUse>) -> Vec<FaceId> {
    let mut faces: Vec<FaceId> = uses.map(|u| u.face).filter(|f| *f != face).collect();
    faces.sort_unstable();
    faces.dedup();
    faces
}

/// That an order holds the old uses in their order, and the new ones.
fn must_extend(edge: EdgeId, old: &[FaceUse], new: &[FaceUse], order: &[FaceUse]) -> Result<(), Reason> {
    let mut rest: Vec<FaceUse> = order.iter().copied().filter(|u| !new.contains(u)).collect();
    turn_to_least(&mut rest);
    let all_new = new.iter().all(|n| order.iter().filter(|u| *u == n).count() == 1);
    if rest == old && all_new {
        Ok(())
    } else {
        Err(Reason::RadialGiven { edge, faces: old.iter().map(|u| u.face).collect() })
    }
}
