//! The lines along which faces are cut, each with all nodes on it, known to every face that it concerns.
//!
//! A curve is an edge of the complex or the line in which two faces cross. That faces on either side of an edge, or on
//! either side of a crossing, are cut at the same nodes follows from there being one list of them.

use std::collections::HashMap;

use glam::DVec3;

use super::marks::Edge;

/// What a curve runs along.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Course {
    /// An edge.
    Edge(Edge),
    /// The crossing of two faces, the smaller number first.
    Crossing([u32; 2]),
}

/// A run of nodes.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    pub(super) course: Course,
    /// In their order along it; an edge's ends are the first and the last.
    pub(super) nodes: Vec<u32>,
    /// Axis that nodes are ordered along, and whether against it.
    axis: usize,
    down: bool,
    /// Faces that it is a side of or that it runs through.
    pub(super) faces: Vec<u32>,
}

impl Curve {
    fn rank(&self, p: DVec3) -> f64 {
        if self.down { -p[self.axis] } else { p[self.axis] }
    }
}

/// What became of a node put onto a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Placed {
    /// It was there already.
    Known,
    /// It is there now.
    New,
    /// It is beyond an end: the two are one.
    AtEnd(u32),
}

/// All curves of a round.
#[derive(Default)]
pub(super) struct Curves {
    pub(super) list: Vec<Curve>,
    number: HashMap<Course, u32>,
}

impl Curves {
    pub(super) fn get(&self, course: Course) -> Option<u32> {
        self.number.get(&course).copied()
    }

    /// The curve along an edge, new or known.
    pub(super) fn of_edge(&mut self, edge: Edge, at: &[DVec3]) -> u32 {
        let direction = at[edge[1] as usize] - at[edge[0] as usize];
        self.of(Course::Edge(edge), direction, || edge.to_vec())
    }

    /// The curve along which two faces cross in a direction, new or known.
    pub(super) fn of_crossing(&mut self, faces: [u32; 2], direction: DVec3) -> u32 {
        self.of(Course::Crossing(faces), direction, Vec::new)
    }

    fn of(&mut self, course: Course, direction: DVec3, nodes: impl FnOnce() -> Vec<u32>) -> u32 {
        let next = self.list.len() as u32;
        let number = *self.number.entry(course).or_insert(next);
        if number == next {
            let axis = super::meeting::dominant_axis(direction);
            let down = direction[axis] < 0.0;
            self.list.push(Curve { course, nodes: nodes(), axis, down, faces: Vec::new() });
        }
        number
    }

    /// Puts a node onto a curve at its place along it.
    pub(super) fn place(&mut self, curve: u32, node: u32, at: &[DVec3]) -> Placed {
        let curve = &mut self.list[curve as usize];
        let rank = curve.rank(at[node as usize]);
        if let (Course::Edge(_), [first, .., last]) = (curve.course, &curve.nodes[..]) {
            if node == *first || node == *last {
                return Placed::Known;
            }
            if rank <= curve.rank(at[*first as usize]) {
                return Placed::AtEnd(*first);
            }
            if rank >= curve.rank(at[*last as usize]) {
                return Placed::AtEnd(*last);
            }
        }
        let before =
            |other: &u32| curve.rank(at[*other as usize]).total_cmp(&rank).then(other.cmp(&node)).is_lt();
        let place = curve.nodes.partition_point(before);
        if curve.nodes.get(place) == Some(&node) {
            return Placed::Known;
        }
        curve.nodes.insert(place, node);
        Placed::New
    }

    /// The nearest node of a curve to a place, not farther than `radius`.
    pub(super) fn near(&self, curve: u32, place: DVec3, radius: f64, at: &[DVec3]) -> Option<u32> {
        let curve = &self.list[curve as usize];
        let rank = curve.rank(place);
        let start = curve.nodes.partition_point(|v| curve.rank(at[*v as usize]) < rank - radius);
        let reach = curve.nodes[start..].iter().take_while(|v| curve.rank(at[**v as usize]) <= rank + radius);
        let distance = |v: u32| at[v as usize].distance_squared(place);
        let nearest = reach.copied().min_by(|a, b| distance(*a).total_cmp(&distance(*b)).then(a.cmp(b)));
        nearest.filter(|v| distance(*v) <= radius * radius)
    }
}
