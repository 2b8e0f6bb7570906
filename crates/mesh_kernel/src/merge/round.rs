//! One round of cutting: marks become nodes, nodes are put onto curves, curves cut faces.

use std::collections::HashMap;

use glam::DVec3;
use rayon::prelude::*;

use super::complex::{Complex, distinct};
use super::curves::{Course, Curves, Placed};
use super::cut_face::Parts;
use super::exact::{between, flat_area};
use super::inspect::{Fix, inspect};
use super::marks::{Edge, Finding, Mark, OVERSHOOT, edge, place_of};
use super::seen_face::{Cut, SeenFace};
use crate::body::weld::UnionFind;

/// A new node within this many times that distance of an old one is not made: the old one takes its place.
const CAPTURE: f64 = 2.0;
/// Times that curves of a round are looked at again; what is left then is left to the next round.
const REFINEMENTS: usize = 12;

/// One round.
pub(super) struct Round<'a> {
    complex: &'a mut Complex,
    near: f64,
    cancelled: &'a (dyn Fn() -> bool + Sync),
    curves: Curves,
    cuts: Vec<Cut>,
    /// For every face its number among the cuts.
    cut_of: HashMap<u32, u32>,
    node_of: HashMap<Mark, u32>,
    /// Where three faces meet.
    triple: HashMap<[u32; 3], u32>,
    /// Nodes that are in one place from the start.
    same: UnionFind,
    /// Nodes that were found to be in one place.
    together: Vec<[u32; 2]>,
}

impl<'a> Round<'a> {
    pub(super) fn new(complex: &'a mut Complex, near: f64, cancelled: &'a (dyn Fn() -> bool + Sync)) -> Self {
        let same = UnionFind::new(complex.at.len());
        Self {
            complex,
            near,
            cancelled,
            curves: Curves::default(),
            cuts: Vec::new(),
            cut_of: HashMap::new(),
            node_of: HashMap::new(),
            triple: HashMap::new(),
            same,
            together: Vec::new(),
        }
    }

    /// Does all of it; returns the new faces. Ends early when cancelled, with whatever it has then.
    pub(super) fn run(mut self, findings: Vec<Finding>) -> Vec<u32> {
        self.mark(&findings);
        self.draw(findings);
        self.attach_edges(0);
        self.refine();
        self.replace()
    }

    fn rep(&mut self, node: u32) -> u32 {
        if (node as usize) < self.same.len() { self.same.find(node) } else { node }
    }

    fn cut(&mut self, face: u32) -> &mut Cut {
        let next = self.cuts.len() as u32;
        let number = *self.cut_of.entry(face).or_insert(next);
        if number == next {
            self.cuts.push(Cut { face, nodes: Vec::new(), lines: Vec::new() });
        }
        &mut self.cuts[number as usize]
    }

    fn place(&mut self, curve: u32, node: u32) -> bool {
        match self.curves.place(curve, node, &self.complex.at) {
            Placed::Known => false,
            Placed::New => true,
            Placed::AtEnd(end) => {
                let [p, q] = [end, node].map(|v| self.complex.at[v as usize]);
                if p.distance(q) <= OVERSHOOT * self.near {
                    self.together.push([end, node]);
                }
                false
            }
        }
    }

    /// Makes the nodes of all marks and puts them onto edges and into faces.
    fn mark(&mut self, findings: &[Finding]) {
        let mut marks: Vec<Mark> =
            findings.iter().filter_map(|f| if let Finding::Mark(m) = f { Some(*m) } else { None }).collect();
        marks.par_sort_unstable();
        marks.dedup();
        for mark in &marks {
            if let Mark::Together(a, b) = *mark {
                self.same.union(a, b);
                self.together.push([a, b]);
            }
        }
        let complex = &*self.complex;
        let near = self.near;
        let places: Vec<Option<DVec3>> = marks.par_iter().map(|m| place_of(complex, *m, near)).collect();
        for (mark, place) in marks.into_iter().zip(places) {
            let node = match (mark, place) {
                (Mark::NodeOnEdge(node, _) | Mark::NodeOnFace(node, _) | Mark::Together(node, _), _) => node,
                (_, Some(place)) => match self.captor(mark, place) {
                    Some(node) => node,
                    None => self.complex.node(place),
                },
                (_, None) => continue,
            };
            let node = self.rep(node);
            self.node_of.insert(mark, node);
            match mark {
                Mark::Together(..) => {}
                Mark::NodeOnEdge(_, edge) => self.place_on_edge(edge, node),
                Mark::NodeOnFace(_, face) => self.cut(face).nodes.push(node),
                Mark::EdgesCross(one, other) => {
                    self.place_on_edge(one, node);
                    self.place_on_edge(other, node);
                }
                Mark::EdgeThroughFace(edge, face) => {
                    self.place_on_edge(edge, node);
                    self.cut(face).nodes.push(node);
                }
            }
        }
    }

    /// A node of what meets that is so near to the place where it does that it serves. Nodes made for the same edges
    /// count: where several faces go through one line, what crosses one of them there crosses all.
    fn captor(&self, mark: Mark, place: DVec3) -> Option<u32> {
        let radius = CAPTURE * self.near;
        let near = |v: &u32| self.complex.at[*v as usize].distance_squared(place) <= radius * radius;
        let on = |edge: Edge| self.node_near([Course::Edge(edge)], place);
        match mark {
            Mark::EdgesCross(one, other) => {
                one.into_iter().chain(other).find(near).or_else(|| on(one)).or_else(|| on(other))
            }
            Mark::EdgeThroughFace(edge, face) => {
                let corners = self.complex.faces[face as usize].nodes;
                edge.into_iter().chain(corners).find(near).or_else(|| on(edge))
            }
            _ => None,
        }
    }

    /// A node on one of some curves that is so near to a place that it serves.
    fn node_near<const N: usize>(&self, courses: [Course; N], place: DVec3) -> Option<u32> {
        let curves = courses.into_iter().filter_map(|course| self.curves.get(course));
        curves.filter_map(|c| self.curves.near(c, place, CAPTURE * self.near, &self.complex.at)).next()
    }

    fn place_on_edge(&mut self, edge: Edge, node: u32) {
        let curve = self.edge_curve(edge);
        self.place(curve, node);
    }

    /// The curve of an edge; its ends are the nodes that stand for the edge's.
    fn edge_curve(&mut self, edge: Edge) -> u32 {
        let known = self.curves.list.len();
        let curve = self.curves.of_edge(edge, &self.complex.at);
        if self.curves.list.len() > known {
            let ends = edge.map(|v| self.rep(v));
            self.curves.list[curve as usize].nodes = ends.to_vec();
        }
        curve
    }

    /// Draws the lines in which faces cross and the edges that lie in faces.
    fn draw(&mut self, findings: Vec<Finding>) {
        for finding in findings {
            match finding {
                Finding::Mark(_) => {}
                Finding::EdgeInFace(edge, face) => {
                    let curve = self.edge_curve(edge);
                    self.cut(face).lines.push(curve);
                    self.curves.list[curve as usize].faces.push(face);
                }
                Finding::Line { faces, marks, shared } => {
                    let mut nodes: Vec<u32> =
                        marks.iter().filter_map(|m| self.node_of.get(m).copied()).collect();
                    if let Some(node) = shared {
                        nodes.push(self.rep(node));
                    }
                    nodes.sort_unstable();
                    nodes.dedup();
                    if nodes.len() < 2 {
                        continue;
                    }
                    let normal = |f: u32| {
                        let [a, b, c] = self.complex.corners(f).at;
                        (b - a).cross(c - a)
                    };
                    let along = normal(faces[0]).cross(normal(faces[1]));
                    let span = self.complex.at[nodes[1] as usize] - self.complex.at[nodes[0] as usize];
                    let direction = if along == DVec3::ZERO { span } else { along };
                    let curve = self.curves.of_crossing(faces, direction);
                    nodes.into_iter().for_each(|n| {
                        self.place(curve, n);
                    });
                    for face in faces {
                        self.cut(face).lines.push(curve);
                        self.curves.list[curve as usize].faces.push(face);
                    }
                }
            }
        }
    }

    /// Tells edge curves from number `from` on which faces have them for a side.
    fn attach_edges(&mut self, from: usize) {
        let mut is_end = vec![false; self.complex.at.len()];
        for curve in &self.curves.list[from..] {
            if let Course::Edge(ends) = curve.course {
                ends.iter().for_each(|&v| is_end[v as usize] = true);
            }
        }
        let (complex, curves) = (&*self.complex, &self.curves);
        let sides: Vec<(u32, u32)> = (0..complex.faces.len() as u32)
            .into_par_iter()
            .filter(|&f| !complex.gone[f as usize])
            .flat_map_iter(|f| {
                let nodes = complex.faces[f as usize].nodes;
                let is_end = &is_end;
                (0..3).filter_map(move |k| {
                    let (a, b) = (nodes[k], nodes[(k + 1) % 3]);
                    if !is_end[a as usize] || !is_end[b as usize] {
                        return None;
                    }
                    let curve = curves.get(Course::Edge(edge(a, b)))?;
                    (curve as usize >= from).then_some((curve, f))
                })
            })
            .collect();
        for (curve, face) in sides {
            self.curves.list[curve as usize].faces.push(face);
            self.cut(face);
        }
    }

    /// Lets curves that cross in a face, or run over nodes in it, have these nodes, until nothing is left to do.
    fn refine(&mut self) {
        let mut queue: Vec<u32> = (0..self.cuts.len() as u32).collect();
        for _ in 0..REFINEMENTS {
            let mut fixes: Vec<Fix> = queue
                .par_iter()
                .filter_map(|&c| self.seen(&self.cuts[c as usize]))
                .flat_map_iter(|p| inspect(&p.nodes, &p.lines, self.near))
                .collect();
            if fixes.is_empty() {
                return;
            }
            fixes.par_sort_unstable_by(Fix::compare);
            fixes.dedup_by(|a, b| a.same(b));
            let known = self.curves.list.len();
            let mut changed: Vec<u32> = Vec::new();
            for fix in fixes {
                self.apply(fix, &mut changed);
            }
            if self.curves.list.len() > known {
                self.attach_edges(known);
            }
            changed.sort_unstable();
            changed.dedup();
            queue = changed
                .iter()
                .flat_map(|&c| &self.curves.list[c as usize].faces)
                .filter_map(|f| self.cut_of.get(f).copied())
                .collect();
            queue.sort_unstable();
            queue.dedup();
        }
    }

    fn curve(&mut self, course: Course) -> Option<u32> {
        match course {
            Course::Edge(edge) => Some(self.edge_curve(edge)),
            Course::Crossing(_) => self.curves.get(course),
        }
    }

    fn apply(&mut self, fix: Fix, changed: &mut Vec<u32>) {
        match fix {
            Fix::Insert { course, node } => {
                if let Some(curve) = self.curve(course)
                    && self.place(curve, node)
                {
                    changed.push(curve);
                }
            }
            Fix::Cross { courses, ends: [[p, q], [r, s]], axis } => {
                let at = |v: u32| self.complex.at[v as usize];
                let [p, q, r, s] = [p, q, r, s].map(at);
                let [n, m] = [p, q].map(|x| flat_area(axis, r, s, x));
                if (n >= 0) == (m >= 0) {
                    return;
                }
                let place = between(p, q, n, m);
                let node = match self.crossing_of(courses) {
                    Crossing::Node(node) => node,
                    Crossing::Triple(key) => match self.triple.get(&key) {
                        Some(node) => *node,
                        None => {
                            let known = self.node_near(courses, place);
                            let node = known.unwrap_or_else(|| self.complex.node(place));
                            self.triple.insert(key, node);
                            node
                        }
                    },
                    Crossing::Mark(mark) => {
                        let known = self.node_near(courses, place);
                        let node = known.unwrap_or_else(|| self.complex.node(place));
                        self.node_of.insert(mark, node);
                        node
                    }
                };
                let node = self.rep(node);
                for course in courses {
                    if let Some(curve) = self.curve(course)
                        && self.place(curve, node)
                    {
                        changed.push(curve);
                    }
                }
            }
        }
    }

    /// What the crossing of two curves is called, whichever face it is seen in.
    fn crossing_of(&self, courses: [Course; 2]) -> Crossing {
        match courses {
            [Course::Edge(a), Course::Edge(b)] => {
                let mark = Mark::EdgesCross(a.min(b), a.max(b));
                self.node_of.get(&mark).map_or(Crossing::Mark(mark), |n| Crossing::Node(*n))
            }
            [Course::Edge(e), Course::Crossing(faces)] | [Course::Crossing(faces), Course::Edge(e)] => {
                let marks = faces.map(|f| Mark::EdgeThroughFace(e, f));
                let known = marks.iter().find_map(|m| self.node_of.get(m));
                known.map_or(Crossing::Mark(marks[0]), |n| Crossing::Node(*n))
            }
            [Course::Crossing([a, b]), Course::Crossing([c, d])] => {
                let mut faces = [a, b, if c == a || c == b { d } else { c }];
                faces.sort_unstable();
                Crossing::Triple(faces)
            }
        }
    }

    fn seen(&self, cut: &Cut) -> Option<SeenFace> {
        if (self.cancelled)() {
            return None;
        }
        SeenFace::new(self.complex, &self.curves, &self.same, cut)
    }

    /// Cuts all faces and puts their parts into the complex; returns all faces that are new.
    fn replace(self) -> Vec<u32> {
        let parts: Vec<(u32, Parts)> = self
            .cuts
            .par_iter()
            .map(|cut| (cut.face, self.seen(cut).map_or_else(Parts::default, |face| face.cut())))
            .collect();
        let mut joined = UnionFind::new(self.complex.at.len());
        let mut any = false;
        for [a, b] in self.together.iter().chain(parts.iter().flat_map(|(_, p)| &p.together)) {
            any |= joined.union(*a, *b);
        }
        let first_new = self.complex.faces.len();
        let mut map = |nodes: [u32; 3]| if any { nodes.map(|v| joined.find(v)) } else { nodes };
        for (face, parts) in parts {
            self.complex.gone[face as usize] = true;
            for nodes in parts.triangles {
                let nodes = map(nodes);
                if distinct(nodes) {
                    self.complex.add_part(face, nodes);
                }
            }
        }
        if any {
            for face in 0..first_new {
                let nodes = self.complex.faces[face].nodes;
                if self.complex.gone[face] || map(nodes) == nodes {
                    continue;
                }
                self.complex.gone[face] = true;
                if distinct(map(nodes)) {
                    self.complex.add_part(face as u32, map(nodes));
                }
            }
        }
        let new: Vec<u32> = (first_new as u32..self.complex.faces.len() as u32).collect();
        self.complex.unite_coincident(&new);
        new.into_iter().filter(|&f| !self.complex.gone[f as usize]).collect()
    }
}

enum Crossing {
    Node(u32),
    Mark(Mark),
    Triple([u32; 3]),
}
