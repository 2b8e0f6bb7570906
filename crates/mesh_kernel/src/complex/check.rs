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
