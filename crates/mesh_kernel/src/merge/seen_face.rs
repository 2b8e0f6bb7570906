//! A face with everything that it is to be cut along, seen along an axis.

use std::collections::{BTreeMap, HashMap};

use super::complex::Complex;
use super::curves::{Course, Curves};
use super::cut_face::{Parts, Seen, cut, flat_parts, turn_flat};
use super::exact::{flat_area, plane_axes};
use super::inspect::Line;
use super::marks::edge;
use super::meeting::{Corners, dominant_axis};
use crate::body::weld::UnionFind;

/// A face that is cut.
pub(super) struct Cut {
    pub(super) face: u32,
    /// Nodes within it.
    pub(super) nodes: Vec<u32>,
    /// Curves through it.
    pub(super) lines: Vec<u32>,
}

/// Nodes of a face seen along an axis.
pub(super) struct View {
    pub(super) axis: usize,
    pub(super) seen: Vec<Seen>,
}

/// A face that is cut, as it is seen along an axis.
pub(super) struct SeenFace {
    pub(super) nodes: View,
    outline: usize,
    pub(super) lines: Vec<Line>,
    /// The sides that nodes of the outline are on, a bit each.
    sides: BTreeMap<u32, u8>,
    /// Whether the face is seen from behind; `None` for a face without area.
    turned: Option<bool>,
}

impl SeenFace {
    /// A cut face with the lines that cut it; `None` where all its corners have become one or two nodes.
    pub(super) fn new(complex: &Complex, curves: &Curves, same: &UnionFind, cut: &Cut) -> Option<Self> {
        let corners = complex.corners(cut.face);
        let (axis, turned) = view(&corners);
        let (x, y) = plane_axes(axis);
        let seen = |node: u32| {
            let p = complex.at[node as usize];
            Seen { node, x: p[x], y: p[y] }
        };
        let rep = |v: u32| same.rep(v);
        // The outline.
        let mut outline: Vec<(u32, Course)> = Vec::new();
        let mut sides: BTreeMap<u32, u8> = BTreeMap::new();
        for k in 0..3 {
            let (a, b) = (corners.nodes[k], corners.nodes[(k + 1) % 3]);
            let course = Course::Edge(edge(a, b));
            match curves.get(course) {
                Some(curve) => {
                    let nodes = &curves.list[curve as usize].nodes;
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
            let crossings = cut.lines.iter().map(|&c| &curves.list[c as usize]);
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
        Some(Self { nodes: View { axis, seen: nodes }, outline: count, lines, sides, turned })
    }

    /// Cuts it.
    pub(super) fn cut(mut self) -> Parts {
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
