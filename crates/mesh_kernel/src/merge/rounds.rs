//! Rounds of cutting until no two faces meet but in nodes and edges of both.
//!
//! A round finds the faces that meet, puts nodes where they do, rounded to the grid, and cuts the faces there. Rounding
//! moves nodes by up to a cell and so may make faces cross that did not before: the next round looks at the new faces
//! against all. It ends when an *exact* test finds nothing left (iterated snap rounding in space; Lazard & Valque, *Removing
//! self-intersections in triangle meshes*, 2025). Two things hold after every round whatever rounding did, for a face is
//! only ever replaced by faces with the same boundary, and nodes that come to one place are made one: a closed chain stays
//! closed, and no face is farther from the input than the cells that nodes moved by.

use std::collections::{BTreeMap, HashMap};

use glam::DVec3;
use rayon::prelude::*;

use super::MergeError;
use super::box_tree::BoxTree;
use super::complex::{Complex, distinct};
use super::curves::{Course, Curves, Placed};
use super::cut_face::{Parts, Seen, cut, flat_parts, turn_flat};
use super::exact::{between, flat_area, plane_axes, volume};
use super::inspect::{Fix, Line, inspect};
use super::meeting::{Corners, Edge, Finding, Mark, Verdict, dominant_axis, edge, meet};
use crate::body::weld::UnionFind;
use crate::query::faces_meet_beyond_shared;

/// Every round after the first, which only concerns what is still in a knot, takes twice the distance of the one before for
/// coincident, so that what rounding turns over is not left as it is; so often at most.
const MOST_DOUBLINGS: u32 = 14;
/// A new node within this many times that distance of an old one is not made: the old one takes its place.
const CAPTURE: f64 = 2.0;
/// Edges that would cross farther than this many times that distance beyond the end of one do not cross.
const OVERSHOOT: f64 = 4.0;
/// Parts that all faces together are cut into, times their number, after which a knot is reported.
const MOST_PARTS: usize = 200;
/// Rounds after which a knot is reported.
const MAX_ROUNDS: u32 = 40;

/// What resolving took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Effort {
    pub(super) rounds: u32,
    /// Faces that were cut.
    pub(super) cut: usize,
}

/// Cuts faces until none meet but in nodes and edges of both; what is within `near` cells of each other coincides. Near linear
/// in faces, plus what crosses.
pub(super) fn resolve(
    complex: &mut Complex,
    near: f64,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Result<Effort, MergeError> {
    let mut effort = Effort::default();
    let first_faces = complex.faces.len();
    let mut layers: Vec<BoxTree> = Vec::new();
    let mut new: Vec<u32> = complex.present().collect();
    loop {
        if cancelled() {
            return Err(MergeError::Cancelled);
        }
        let round = effort.rounds;
        let near = near * f64::from(1u32 << round.min(MOST_DOUBLINGS));
        let findings = look(complex, &new, &mut layers, near, round == 0);
        if findings.is_empty() {
            return Ok(effort);
        }
        if round == MAX_ROUNDS || complex.faces.len() > MOST_PARTS * (first_faces + MOST_PARTS) {
            return Err(MergeError::Tangled { faces: new.len() });
        }
        effort.rounds += 1;
        let before = complex.faces.len();
        new = Round::new(complex, near).run(findings);
        effort.cut += complex.faces.len() - before;
    }
}

/// What new faces and all others have in common, and those that are too thin. In the first round whatever is near counts,
/// afterwards only what meets exactly.
fn look(complex: &Complex, new: &[u32], layers: &mut Vec<BoxTree>, near: f64, first: bool) -> Vec<Finding> {
    let collapses: Vec<(u32, Mark)> =
        new.par_iter().filter_map(|&f| Some((f, complex.corners(f).collapsed(near)?))).collect();
    let mut thin = vec![false; complex.faces.len()];
    collapses.iter().for_each(|(f, _)| thin[*f as usize] = true);
    let mut findings: Vec<Finding> = collapses.into_iter().map(|(_, m)| Finding::Mark(m)).collect();
    let visit = |f: u32, g: u32, out: &mut Vec<Finding>| {
        let skip = |f: u32| complex.gone[f as usize] || thin[f as usize];
        if skip(f) || skip(g) {
            return;
        }
        let (one, other) = (complex.corners(f), complex.corners(g));
        let crossing = || faces_meet_beyond_shared(one.nodes, other.nodes, |v| complex.at[v as usize]);
        if !first && !crossing() {
            return;
        }
        let verdict = meet(&one, &other, near, out);
        if verdict == Verdict::Unclear && (!first || crossing()) {
            meet(&one, &other, 0.0, out);
        }
    };
    let margin = if first { near } else { 0.0 };
    let tree = BoxTree::new(new, |f| complex.corners(f).at, margin);
    findings.extend(tree.own_pairs(&visit));
    for layer in &*layers {
        findings.extend(tree.pairs_with(layer, &visit));
    }
    layers.push(tree);
    findings
}

/// A face that is cut.
struct Cut {
    face: u32,
    /// Nodes within it.
    nodes: Vec<u32>,
    /// Curves through it.
    lines: Vec<u32>,
}

/// One round.
struct Round<'a> {
    complex: &'a mut Complex,
    near: f64,
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
    fn new(complex: &'a mut Complex, near: f64) -> Self {
        let same = UnionFind::new(complex.at.len());
        Self {
            complex,
            near,
            curves: Curves::default(),
            cuts: Vec::new(),
            cut_of: HashMap::new(),
            node_of: HashMap::new(),
            triple: HashMap::new(),
            same,
            together: Vec::new(),
        }
    }

    /// Does all of it; returns the new faces.
    fn run(mut self, findings: Vec<Finding>) -> Vec<u32> {
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
                .filter_map(|&c| self.prepared(&self.cuts[c as usize]))
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

    /// A cut face as it is seen, with the lines that cut it.
    fn prepared(&self, cut: &Cut) -> Option<Prepared> {
        let corners = self.complex.corners(cut.face);
        let (axis, turned) = view(&corners);
        let (x, y) = plane_axes(axis);
        let seen = |node: u32| {
            let p = self.complex.at[node as usize];
            Seen { node, x: p[x], y: p[y] }
        };
        let rep = |v: u32| self.same.rep(v);
        // The outline.
        let mut outline: Vec<(u32, Course)> = Vec::new();
        let mut sides: BTreeMap<u32, u8> = BTreeMap::new();
        for k in 0..3 {
            let (a, b) = (corners.nodes[k], corners.nodes[(k + 1) % 3]);
            let course = Course::Edge(edge(a, b));
            match self.curves.get(course) {
                Some(curve) => {
                    let nodes = &self.curves.list[curve as usize].nodes;
                    nodes.iter().for_each(|n| *sides.entry(*n).or_default() |= 1 << k);
                    let count = nodes.len() - 1;
                    if a < b {
                        outline.extend(nodes[..count].iter().map(|n| (*n, course)));
                    } else {
                        outline.extend(nodes[1..].iter().rev().map(|n| (*n, course)));
                    }
                }
                None => outline.push((rep(a), course)),
            }
        }
        // Of places in a row with one node the last counts: the line that leads away from it is its line.
        outline.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 = next.1;
            }
            same
        });
        while outline.len() > 1 && outline[0].0 == outline[outline.len() - 1].0 {
            outline.pop();
        }
        if outline.len() < 3 {
            return None;
        }
        let count = outline.len();
        let mut nodes: Vec<Seen> = outline.iter().map(|(n, _)| seen(*n)).collect();
        let mut lines: Vec<Line> = (0..count)
            .map(|k| Line { ends: [k as u32, ((k + 1) % count) as u32], course: outline[k].1, border: true })
            .collect();
        if !(cut.nodes.is_empty() && cut.lines.is_empty()) {
            let mut index: HashMap<u32, u32> = HashMap::new();
            for (k, (n, _)) in (0..).zip(&outline) {
                index.entry(*n).or_insert(k);
            }
            let crossings = cut.lines.iter().map(|&c| &self.curves.list[c as usize]);
            let inner = crossings
                .clone()
                .filter(|c| matches!(c.course, Course::Crossing(_)))
                .flat_map(|c| &c.nodes)
                .chain(&cut.nodes);
            for &node in inner {
                index.entry(node).or_insert_with(|| {
                    nodes.push(seen(node));
                    nodes.len() as u32 - 1
                });
            }
            for curve in crossings {
                // An edge in the face's plane: what is between two of its nodes on the face is on it too.
                let first = curve.nodes.iter().position(|n| index.contains_key(n));
                let last = curve.nodes.iter().rposition(|n| index.contains_key(n));
                let (Some(first), Some(last)) = (first, last) else { continue };
                let run = &curve.nodes[first..=last];
                for &node in run {
                    index.entry(node).or_insert_with(|| {
                        nodes.push(seen(node));
                        nodes.len() as u32 - 1
                    });
                }
                lines.extend(
                    run.windows(2)
                        .map(|w| [index[&w[0]], index[&w[1]]])
                        .filter(|[a, b]| !adjacent(*a, *b, count as u32))
                        .map(|ends| Line { ends, course: curve.course, border: false }),
                );
            }
        }
        Some(Prepared { nodes: View { axis, seen: nodes }, outline: count, lines, sides, turned })
    }

    /// Cuts all faces and puts their parts into the complex; returns all faces that are new.
    fn replace(self) -> Vec<u32> {
        let parts: Vec<(u32, Parts)> = self
            .cuts
            .par_iter()
            .map(|cut| (cut.face, self.prepared(cut).map_or_else(Parts::default, |p| p.cut())))
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

/// Times that curves of a round are looked at again; what is left then is left to the next round.
const REFINEMENTS: usize = 12;

enum Crossing {
    Node(u32),
    Mark(Mark),
    Triple([u32; 3]),
}

/// Nodes of a face seen along an axis.
pub(super) struct View {
    pub(super) axis: usize,
    pub(super) seen: Vec<Seen>,
}

struct Prepared {
    nodes: View,
    outline: usize,
    lines: Vec<Line>,
    /// The sides that nodes of the outline are on, a bit each.
    sides: BTreeMap<u32, u8>,
    /// Whether the face is seen from behind; `None` for a face without area.
    turned: Option<bool>,
}

impl Prepared {
    fn cut(mut self) -> Parts {
        let Some(turned) = self.turned else {
            return flat_parts(&self.nodes.seen, self.outline);
        };
        if turned {
            // Seen in a mirror it is seen from the front.
            self.nodes.seen.iter_mut().for_each(|s| s.x = -s.x);
        }
        let lines: Vec<[u32; 2]> = self.lines.iter().filter(|l| !l.border).map(|l| l.ends).collect();
        let mut parts = cut(&self.nodes.seen, self.outline, &lines);
        turn_flat(&mut parts.triangles, |v| self.sides.get(&v).copied().unwrap_or(0));
        parts
    }
}

/// The axis that a face is looked at along, and whether it is seen from behind then.
fn view(corners: &Corners) -> (usize, Option<bool>) {
    let [a, b, c] = corners.at;
    let normal = (b - a).cross(c - a);
    let axis = dominant_axis(normal);
    let area = flat_area(axis, a, b, c);
    if area != 0 && corners.collapsed(0.0).is_none() {
        return (axis, Some(area < 0));
    }
    let span = (a.max(b).max(c) - a.min(b).min(c)).to_array();
    let axis = (0..3).min_by(|i, k| span[*i].total_cmp(&span[*k])).unwrap_or(0);
    (axis, None)
}

/// Whether two places on a closed outline follow each other.
fn adjacent(a: u32, b: u32, outline: u32) -> bool {
    a < outline && b < outline && ((a + 1) % outline == b || (b + 1) % outline == a)
}

/// Where the node of a mark goes; `None` for marks of nodes that there are, and for edges that run alongside each other.
fn place_of(complex: &Complex, mark: Mark, near: f64) -> Option<DVec3> {
    let at = |v: u32| complex.at[v as usize];
    match mark {
        Mark::EdgeThroughFace([p, q], face) => {
            let [a, b, c] = complex.corners(face).at;
            let [n, m] = [at(p), at(q)].map(|x| volume(a, b, c, x));
            (n.signum() * m.signum() == -1).then(|| between(at(p), at(q), n, m))
        }
        Mark::EdgesCross([p, q], [r, s]) => {
            let [p, q, r, s] = [p, q, r, s].map(at);
            let across = (q - p).cross(s - r);
            if across == DVec3::ZERO {
                return None;
            }
            let axis = dominant_axis(across);
            let [n, m] = [p, q].map(|x| flat_area(axis, r, s, x));
            if n.signum() * m.signum() == -1 {
                return Some(between(p, q, n, m));
            }
            // They pass each other near the end of one.
            let (end, n, m) = if n.unsigned_abs() < m.unsigned_abs() { (p, n, m) } else { (q, m, n) };
            let overshot = n as f64 / (m as f64 - n as f64) * p.distance(q);
            (overshot.abs() <= OVERSHOOT * near).then_some(end)
        }
        _ => None,
    }
}
