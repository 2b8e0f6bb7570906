//! Whether the lines that a face is to be cut along cross, or run over nodes that they do not have.

use std::cmp::Ordering;

use robust::{Coord, orient2d};

use super::curves::Course;
use super::seen_face::View;

/// A straight piece of a curve in a face, between two of the nodes seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    pub(super) ends: [u32; 2],
    pub(super) course: Course,
    /// Whether it is part of the outline.
    pub(super) border: bool,
}

/// What has to be done about a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fix {
    /// It runs over a node.
    Insert { course: Course, node: u32 },
    /// It crosses another; the nodes are the ends of the pieces that cross, seen along an axis.
    Cross { courses: [Course; 2], ends: [[u32; 2]; 2], axis: usize },
}

impl Fix {
    /// An order that does not depend on which face came first.
    pub(super) fn compare(&self, other: &Self) -> Ordering {
        self.key().cmp(&other.key())
    }

    /// Whether both do the same, though perhaps seen from different faces.
    pub(super) fn same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Cross { courses: a, .. }, Self::Cross { courses: b, .. }) => a == b,
            _ => self == other,
        }
    }

    fn key(&self) -> (bool, [Course; 2], [[u32; 2]; 2], usize) {
        match *self {
            Self::Insert { course, node } => (false, [course; 2], [[node; 2]; 2], 0),
            Self::Cross { courses, ends, axis } => (true, courses, ends, axis),
        }
    }
}

/// What is wrong with the lines of a face. O(n log n + pairs of lines whose boxes overlap).
pub(super) fn inspect(view: &View, lines: &[Line], near: f64) -> Vec<Fix> {
    let mut fixes = Vec::new();
    let seen = &view.seen;
    let point = |i: u32| {
        let s = &seen[i as usize];
        Coord { x: s.x, y: s.y }
    };
    // Nodes and lines from left to right.
    let mut by_x: Vec<u32> = (0..seen.len() as u32).collect();
    by_x.sort_unstable_by(|a, b| point(*a).x.total_cmp(&point(*b).x).then(a.cmp(b)));
    struct Piece {
        line: Line,
        lo: Coord<f64>,
        hi: Coord<f64>,
    }
    let mut pieces: Vec<Piece> = lines
        .iter()
        .map(|line| {
            let [p, q] = line.ends.map(point);
            Piece {
                line: *line,
                lo: Coord { x: p.x.min(q.x), y: p.y.min(q.y) },
                hi: Coord { x: p.x.max(q.x), y: p.y.max(q.y) },
            }
        })
        .collect();
    pieces.sort_by(|a, b| a.lo.x.total_cmp(&b.lo.x));
    for piece in &pieces {
        let [a, b] = piece.line.ends;
        let (p, q) = (point(a), point(b));
        let (dx, dy) = (q.x - p.x, q.y - p.y);
        let length = dx.hypot(dy);
        let start = by_x.partition_point(|&i| point(i).x < piece.lo.x - near);
        for &i in by_x[start..].iter().take_while(|&&i| point(i).x <= piece.hi.x + near) {
            let r = point(i);
            if r.y < piece.lo.y - near || r.y > piece.hi.y + near || i == a || i == b {
                continue;
            }
            let node = seen[i as usize].node;
            if node == seen[a as usize].node || node == seen[b as usize].node {
                continue;
            }
            let along = (r.x - p.x) * dx + (r.y - p.y) * dy;
            if along > 0.0 && along < length * length && orient2d(p, q, r).abs() <= near * length {
                fixes.push(Fix::Insert { course: piece.line.course, node });
            }
        }
    }
    for (k, one) in pieces.iter().enumerate() {
        let [a, b] = one.line.ends;
        let (p, q) = (point(a), point(b));
        for other in pieces[k + 1..].iter().take_while(|o| o.lo.x <= one.hi.x) {
            let [c, d] = other.line.ends;
            if one.line.course == other.line.course
                || other.lo.y > one.hi.y
                || one.lo.y > other.hi.y
                || [c, d].iter().any(|&i| i == a || i == b)
            {
                continue;
            }
            let (r, s) = (point(c), point(d));
            let opposite = |x: f64, y: f64| (x > 0.0 && y < 0.0) || (x < 0.0 && y > 0.0);
            if opposite(orient2d(p, q, r), orient2d(p, q, s))
                && opposite(orient2d(r, s, p), orient2d(r, s, q))
            {
                let (mut one, mut other) = (one.line, other.line);
                if other.course < one.course {
                    std::mem::swap(&mut one, &mut other);
                }
                let ends = [one, other].map(|l| l.ends.map(|i| seen[i as usize].node));
                fixes.push(Fix::Cross { courses: [one.course, other.course], ends, axis: view.axis });
            }
        }
    }
    fixes
}
