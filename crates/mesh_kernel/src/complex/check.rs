//! Every broken rule of a complex, typed, with ids and values.

use std::collections::{BTreeMap, BTreeSet};

use super::Complex;
use super::ids::{DirectedEdge, EdgeId, FaceId, FaceUse, Loop, VertexId, turn_to_least};
use super::radial::radial_order;
use super::refusal::Entity;
use super::slots::{SlotFault, Slots};
use crate::body::Counts;

/// A face counts as plane where no corner is farther from its plane than this part of its size.
const FLAT: f64 = 1e-9;

/// A broken rule.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Defect {
    /// Numbering: a number is free and taken, lost, or the stack of free numbers is not in normal form.
    #[error("the number of {0} is free and taken at once, lost, or out of order")]
    Slot(Entity),
    /// A coordinate is not a number or is infinite.
    #[error("vertex {vertex} is at {position:?}")]
    NotFinite {
        /// The vertex.
        vertex: VertexId,
        /// Its coordinates.
        position: [f64; 3],
    },
    /// Something refers to an id that does not live.
    #[error("{from} refers to {to}, which does not live")]
    Dead {
        /// Who refers.
        from: Entity,
        /// To whom.
        to: Entity,
    },
    /// Incidence is stored on one side only.
    #[error("{from} has {to}, but {to} does not have {from}")]
    OneSided {
        /// Who has.
        from: Entity,
        /// Whom.
        to: Entity,
    },
    /// An edge begins and ends at one vertex.
    #[error("edge {0} begins and ends at one vertex")]
    SelfLoop(EdgeId),
    /// A face without loops, or a loop without edges.
    #[error("face {0} has an empty loop or none")]
    EmptyLoop(FaceId),
    /// A loop is not a closed walk.
    #[error("loop {number} of face {face} is open: {this} does not end where {next} begins")]
    OpenLoop {
        /// The face.
        face: FaceId,
        /// Number of the loop; 0 is the outer one.
        number: usize,
        /// An edge.
        this: DirectedEdge,
        /// The next.
        next: DirectedEdge,
    },
    /// A face walks an edge twice in one direction, or has a vertex as a loop twice.
    #[error("face {face} uses {what} twice")]
    Twice {
        /// The face.
        face: FaceId,
        /// The edge or vertex.
        what: Entity,
    },
    /// A list is not in its canonical order.
    #[error("a list of {0} is not in canonical order")]
    NotCanonical(Entity),
    /// The stored radial order is not that of the positions.
    #[error("faces about edge {edge} are stored in another order than their positions have")]
    Radial {
        /// The edge.
        edge: EdgeId,
        /// As stored.
        stored: Vec<FaceUse>,
        /// As the positions have it.
        found: Vec<FaceUse>,
    },
    /// A ring of a plane face runs the same way round as its outer loop.
    #[error(
        "ring {number} of face {face} runs the same way round as the outer loop (areas {outer} and {ring} mm²)"
    )]
    RingDirection {
        /// The face.
        face: FaceId,
        /// Number of the loop.
        number: usize,
        /// Area within the outer loop, along the face's normal.
        outer: f64,
        /// Area within the ring, along the face's normal.
        ring: f64,
    },
    /// The Euler–Poincaré identity does not hold.
    #[error("the counts do not fit: {0}")]
    Identity(Counts),
}

/// What [`Complex::check_with`] looks at besides the topology.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CheckOptions {
    /// Radial orders and directions of rings against the positions, where these can tell.
    pub positions: bool,
}

impl Default for CheckOptions {
    fn default() -> Self {
        Self { positions: true }
    }
}

impl Complex {
    /// All broken rules: numbering, finite positions, incidence both ways, closed loops, canonical form, radial orders and directions
    /// of rings against the positions, and the identity of the counts where nothing else is broken. O(n log n).
    pub fn check(&self) -> Vec<Defect> {
        self.check_with(CheckOptions::default())
    }

    /// [`Self::check`] with options.
    pub fn check_with(&self, options: CheckOptions) -> Vec<Defect> {
        let mut defects = Vec::new();
        check_slots(&self.vertices, |i| Entity::Vertex(VertexId(i)), &mut defects);
        check_slots(&self.edges, |i| Entity::Edge(EdgeId(i)), &mut defects);
        check_slots(&self.faces, |i| Entity::Face(FaceId(i)), &mut defects);
        self.check_vertices(&mut defects);
        self.check_edges(&mut defects);
        self.check_faces(&mut defects);
        if !defects.is_empty() {
            return defects;
        }
        if options.positions {
            self.check_radial(&mut defects);
            self.check_rings(&mut defects);
        }
        let counts = self.counts();
        if !counts.identity_holds() {
            defects.push(Defect::Identity(counts));
        }
        defects
    }

    fn check_vertices(&self, defects: &mut Vec<Defect>) {
        for (i, v) in self.vertices.iter() {
            let (vertex, from) = (VertexId(i), Entity::Vertex(VertexId(i)));
            if !v.position.is_finite() {
                defects.push(Defect::NotFinite { vertex, position: v.position.to_array() });
            }
            for &e in &v.edges {
                let to = Entity::Edge(e);
                match self.edges.get(e.0) {
                    None => defects.push(Defect::Dead { from, to }),
                    Some(edge) if !edge.ends.contains(&vertex) => defects.push(Defect::OneSided { from, to }),
                    Some(_) => {}
                }
            }
            for &f in &v.faces {
                let to = Entity::Face(f);
                match self.faces.get(f.0) {
                    None => defects.push(Defect::Dead { from, to }),
                    Some(face) if !face.loops.contains(&Loop::Vertex(vertex)) => {
                        defects.push(Defect::OneSided { from, to });
                    }
                    Some(_) => {}
                }
            }
            if !v.edges.is_sorted_by(|a, b| a < b) || !v.faces.is_sorted_by(|a, b| a < b) {
                defects.push(Defect::NotCanonical(from));
            }
        }
    }

    fn check_edges(&self, defects: &mut Vec<Defect>) {
        for (i, e) in self.edges.iter() {
            let (edge, from) = (EdgeId(i), Entity::Edge(EdgeId(i)));
            for v in e.ends {
                let to = Entity::Vertex(v);
                match self.vertices.get(v.0) {
                    None => defects.push(Defect::Dead { from, to }),
                    Some(vertex) if vertex.edges.binary_search(&edge).is_err() => {
                        defects.push(Defect::OneSided { from, to });
                    }
                    Some(_) => {}
                }
            }
            if e.ends[0] == e.ends[1] {
                defects.push(Defect::SelfLoop(edge));
            }
            let mut seen = BTreeSet::new();
            for u in &e.uses {
                let to = Entity::Face(u.face);
                match self.faces.get(u.face.0) {
                    None => defects.push(Defect::Dead { from, to }),
                    Some(face) => {
                        if !face.loops.iter().any(|l| l.edges().contains(&u.at(edge))) {
                            defects.push(Defect::OneSided { from, to });
                        }
                    }
                }
                if !seen.insert(*u) {
                    defects.push(Defect::Twice { face: u.face, what: from });
                }
            }
            if e.uses.iter().min() != e.uses.first() {
                defects.push(Defect::NotCanonical(from));
            }
        }
    }

    fn check_faces(&self, defects: &mut Vec<Defect>) {
        for (i, f) in self.faces.iter() {
            let (face, from) = (FaceId(i), Entity::Face(FaceId(i)));
            if f.loops.is_empty() {
                defects.push(Defect::EmptyLoop(face));
            }
            let mut walked = BTreeSet::new();
            let mut single = BTreeSet::new();
            for (number, l) in f.loops.iter().enumerate() {
                match l {
                    Loop::Vertex(v) => {
                        let to = Entity::Vertex(*v);
                        match self.vertices.get(v.0) {
                            None => defects.push(Defect::Dead { from, to }),
                            Some(vertex) if vertex.faces.binary_search(&face).is_err() => {
                                defects.push(Defect::OneSided { from, to });
                            }
                            Some(_) => {}
                        }
                        if !single.insert(*v) {
                            defects.push(Defect::Twice { face, what: to });
                        }
                    }
                    Loop::Walk(walk) => {
                        if walk.is_empty() {
                            defects.push(Defect::EmptyLoop(face));
                        }
                        for (this, next) in walk.iter().zip(walk.iter().cycle().skip(1)) {
                            let to = Entity::Edge(this.edge);
                            let u = FaceUse { face, along: !this.reversed };
                            match self.edges.get(this.edge.0) {
                                None => defects.push(Defect::Dead { from, to }),
                                Some(e) if !e.uses.contains(&u) => {
                                    defects.push(Defect::OneSided { from, to })
                                }
                                Some(_) => {}
                            }
                            if self.target(*this) != self.origin(*next) {
                                defects.push(Defect::OpenLoop { face, number, this: *this, next: *next });
                            }
                            if !walked.insert(*this) {
                                defects.push(Defect::Twice { face, what: to });
                            }
                        }
                        if walk.iter().min() != walk.first() {
                            defects.push(Defect::NotCanonical(from));
                        }
                    }
                }
            }
            if !f.loops.get(1..).unwrap_or_default().is_sorted() {
                defects.push(Defect::NotCanonical(from));
            }
        }
    }

    fn check_radial(&self, defects: &mut Vec<Defect>) {
        let mut apexes: BTreeMap<FaceId, BTreeMap<DirectedEdge, VertexId>> = BTreeMap::new();
        for (i, e) in self.edges.iter().filter(|(_, e)| e.uses.len() > 2) {
            let edge = EdgeId(i);
            let [a, b] = e.ends.map(|v| self.position(v).unwrap_or_default());
            let leaves: Option<Vec<_>> = (e.uses.iter())
                .map(|u| {
                    let of_face = apexes.entry(u.face).or_insert_with(|| self.apexes(self.loops(u.face)));
                    self.position(*of_face.get(&u.at(edge))?)
                })
                .collect();
            let Some(Ok(order)) = leaves.map(|l| radial_order(a, b, &l)) else { continue };
            let mut found: Vec<FaceUse> = order.into_iter().map(|i| e.uses[i]).collect();
            turn_to_least(&mut found);
            if found != e.uses {
                defects.push(Defect::Radial { edge, stored: e.uses.clone(), found });
            }
        }
    }

    fn check_rings(&self, defects: &mut Vec<Defect>) {
        for (i, f) in self.faces.iter().filter(|(_, f)| f.loops.len() > 1) {
            let face = FaceId(i);
            let area = self.area_vector(&f.loops[0]);
            let normal = area.normalize_or_zero();
            let corners: Vec<_> = (f.loops.iter().flat_map(|l| self.loop_vertices(l)))
                .filter_map(|v| self.position(v))
                .collect();
            let Some(&o) = corners.first() else { continue };
            let size = corners.iter().map(|p| p.distance(o)).fold(0.0, f64::max);
            if normal == glam::DVec3::ZERO || corners.iter().any(|p| (*p - o).dot(normal).abs() > FLAT * size)
            {
                continue;
            }
            for (number, l) in f.loops.iter().enumerate().skip(1) {
                let ring = self.area_vector(l).dot(normal) / 2.0;
                if ring > FLAT * size * size {
                    defects.push(Defect::RingDirection { face, number, outer: area.length() / 2.0, ring });
                }
            }
        }
    }
}

fn check_slots<T>(slots: &Slots<T>, name: impl Fn(u32) -> Entity, defects: &mut Vec<Defect>) {
    defects.extend(slots.faults().into_iter().map(|fault| match fault {
        SlotFault::NotFree(i) | SlotFault::Lost(i) | SlotFault::NotNormal(i) => Defect::Slot(name(i)),
    }));
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::complex::{Editor, NewFace};

    /// A square with a ring vertex, a second square on one of its edges, an upright one there too, a wire.
    fn sound() -> Complex {
        let mut m = Editor::default();
        let square = |m: &mut Editor, at: [DVec3; 2], old: Option<[VertexId; 2]>| {
            let [a, b] = old.unwrap_or_else(|| {
                let a = m.make_vertex_complex(DVec3::ZERO).unwrap();
                [a, m.make_vertex_edge(a, DVec3::X).unwrap().vertex]
            });
            let c = m.make_vertex_edge(b, at[0]).unwrap().vertex;
            let d = m.make_vertex_edge(c, at[1]).unwrap().vertex;
            m.make_edge_chole(d, a).unwrap();
            let walk = m.complex().walk(&[a, b, c, d]).unwrap();
            (m.make_face_kill_chole(NewFace::new(walk)).unwrap(), [a, b])
        };
        let (f, old) = square(&mut m, [DVec3::new(1.0, 1.0, 0.0), DVec3::Y], None);
        square(&mut m, [DVec3::new(1.0, -1.0, 0.0), -DVec3::Y], Some(old));
        square(&mut m, [DVec3::new(1.0, 0.0, 1.0), DVec3::Z], Some(old));
        m.make_vertex_ring(f, DVec3::new(0.5, 0.5, 0.0)).unwrap();
        m.make_vertex_edge(old[0], -DVec3::ONE).unwrap();
        m.into_complex()
    }

    /// What `break_it` breaks must be told first.
    fn assert_told(break_it: impl FnOnce(&mut Complex), told: impl Fn(&Defect) -> bool) {
        let mut complex = sound();
        assert_eq!(complex.check(), []);
        break_it(&mut complex);
        let defects = complex.check();
        assert!(defects.iter().any(told), "{defects:?}");
        assert!(defects.iter().all(|d| !d.to_string().is_empty()));
    }

    #[test]
    fn every_broken_rule_is_told() {
        let edge =
            |c: &mut Complex, e: u32, f: &dyn Fn(&mut crate::complex::Edge)| f(c.edges.get_mut(e).unwrap());
        assert_told(
            |c| c.vertices.get_mut(2).unwrap().position.x = f64::NAN,
            |d| matches!(d, Defect::NotFinite { vertex: VertexId(2), .. }),
        );
        assert_told(
            |c| edge(c, 0, &|e| e.ends[1] = VertexId(55)),
            |d| *d == Defect::Dead { from: Entity::Edge(EdgeId(0)), to: Entity::Vertex(VertexId(55)) },
        );
        assert_told(|c| edge(c, 1, &|e| e.ends[1] = e.ends[0]), |d| *d == Defect::SelfLoop(EdgeId(1)));
        assert_told(
            |c| edge(c, 0, &|e| e.uses.truncate(2)),
            |d| matches!(d, Defect::OneSided { from: Entity::Face(_), to: Entity::Edge(EdgeId(0)) }),
        );
        assert_told(
            |c| edge(c, 0, &|e| e.uses[1].face = FaceId(9)),
            |d| *d == Defect::Dead { from: Entity::Edge(EdgeId(0)), to: Entity::Face(FaceId(9)) },
        );
        assert_told(
            |c| edge(c, 0, &|e| e.uses.push(e.uses[0])),
            |d| *d == Defect::Twice { face: FaceId(0), what: Entity::Edge(EdgeId(0)) },
        );
        assert_told(
            |c| edge(c, 0, &|e| e.uses.rotate_left(1)),
            |d| *d == Defect::NotCanonical(Entity::Edge(EdgeId(0))),
        );
        // Exchanged, but from the smallest on: only the positions tell.
        assert_told(
            |c| edge(c, 0, &|e| e.uses.swap(1, 2)),
            |d| matches!(d, Defect::Radial { edge: EdgeId(0), stored, found } if stored != found),
        );
        assert_told(
            |c| c.vertices.get_mut(0).unwrap().edges.retain(|e| e.0 != 0),
            |d| *d == Defect::OneSided { from: Entity::Edge(EdgeId(0)), to: Entity::Vertex(VertexId(0)) },
        );
        assert_told(
            |c| c.vertices.get_mut(0).unwrap().edges.reverse(),
            |d| *d == Defect::NotCanonical(Entity::Vertex(VertexId(0))),
        );
        assert_told(
            |c| c.vertices.get_mut(0).unwrap().faces.push(FaceId(0)),
            |d| *d == Defect::OneSided { from: Entity::Vertex(VertexId(0)), to: Entity::Face(FaceId(0)) },
        );
        let face = |c: &mut Complex, f: &dyn Fn(&mut Vec<Loop>)| f(&mut c.faces.get_mut(0).unwrap().loops);
        assert_told(|c| face(c, &Vec::clear), |d| *d == Defect::EmptyLoop(FaceId(0)));
        assert_told(
            |c| face(c, &|l| l[0] = Loop::Walk(l[0].edges()[1..].to_vec())),
            |d| matches!(d, Defect::OpenLoop { face: FaceId(0), number: 0, .. }),
        );
        assert_told(
            |c| face(c, &|l| l.push(l[1].clone())),
            |d| matches!(d, Defect::Twice { face: FaceId(0), what: Entity::Vertex(_) }),
        );
        assert_told(
            |c| face(c, &|l| l.push(Loop::Vertex(VertexId(0)))),
            |d| *d == Defect::NotCanonical(Entity::Face(FaceId(0))),
        );
        assert_told(
            |c| c.faces.get_mut(1).unwrap().loops.iter_mut().for_each(|l| *l = l.reversed()),
            |d| matches!(d, Defect::OneSided { from: Entity::Face(FaceId(1)), .. }),
        );
    }

    #[test]
    fn a_ring_that_runs_as_the_outer_loop_is_told() {
        let mut m = Editor::default();
        let wire = |m: &mut Editor, at: f64, side: f64| {
            let p = |x: f64, y: f64| DVec3::new(at + x * side, at + y * side, 0.0);
            let a = m.make_vertex_complex(p(0.0, 0.0)).unwrap();
            let b = m.make_vertex_edge(a, p(1.0, 0.0)).unwrap().vertex;
            let c = m.make_vertex_edge(b, p(0.0, 1.0)).unwrap().vertex;
            m.make_edge_chole(c, a).unwrap();
            m.complex().walk(&[a, b, c]).unwrap()
        };
        let (outer, ring) = (wire(&mut m, 0.0, 4.0), wire(&mut m, 1.0, 1.0));
        let good = m.make_face(NewFace::new(outer.clone()).ring(ring.reversed())).unwrap();
        assert_eq!(m.complex().check(), []);
        m.kill_face(good.face).unwrap();
        m.make_face(NewFace::new(outer).ring(ring)).unwrap();
        let defects = m.complex().check();
        assert_eq!(defects, [Defect::RingDirection { face: FaceId(0), number: 1, outer: 8.0, ring: 0.5 }]);
        assert_eq!(m.complex().check_with(CheckOptions { positions: false }), []);
    }

    #[test]
    fn the_identity_can_fail() {
        // Two faces on one square, crossed by a third whose order about one edge contradicts the others.
        let mut m = Editor::default();
        let corners = [DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y];
        let mut v = vec![m.make_vertex_complex(corners[0]).unwrap()];
        for c in &corners[1..] {
            v.push(m.make_vertex_edge(*v.last().unwrap(), *c).unwrap().vertex);
        }
        m.make_edge_chole(v[3], v[0]).unwrap();
        let walk = m.complex().walk(&v).unwrap();
        m.make_face(NewFace::new(walk.clone())).unwrap();
        m.make_face(NewFace::new(walk.clone())).unwrap();
        let mut third = NewFace::new(walk.clone());
        for d in walk.edges() {
            let [old, new] = [FaceId(0), FaceId(2)].map(|face| FaceUse { face, along: true });
            third = third.placed(m.complex().order_after(d.edge, old, new));
        }
        m.make_face(third).unwrap();
        let mut complex = m.into_complex();
        assert_eq!(complex.counts().cc, 2);
        complex.edges.get_mut(0).unwrap().uses.swap(1, 2);
        let defects = complex.check_with(CheckOptions { positions: false });
        assert!(
            matches!(defects[..], [Defect::Identity(c)] if !c.identity_holds() && c.cc == 0),
            "{defects:?}"
        );
    }
}
