//! Where two faces meet: which nodes lie on what, which edges cross, along which line.
//!
//! What is found here is only a proposal of where to put nodes; whether faces still cross is asked exactly afterwards, and
//! all of it again for those that do. So distances may be compared with a few cells here: what lies that near is taken to
//! coincide, which is what makes walls in one plane *one* wall although every formula rounds in its own way.

use glam::DVec3;
use robust::{Coord, orient2d};

use super::exact::{plane_axes, volume_sign};
use super::marks::{Edge, Finding, Mark, edge};

/// What asking about two faces came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// They have nothing in common but nodes and edges of both: certain.
    Apart,
    /// They were found to meet.
    Marked,
    /// Nothing was found, nothing is certain: to be asked exactly.
    Unclear,
}

/// A face with its corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corners {
    pub(super) face: u32,
    pub(super) nodes: [u32; 3],
    pub(super) at: [DVec3; 3],
}

impl Corners {
    #[inline]
    fn edge(&self, k: usize) -> Edge {
        edge(self.nodes[k], self.nodes[(k + 1) % 3])
    }

    #[inline]
    fn side(&self, k: usize) -> [DVec3; 2] {
        [self.at[k], self.at[(k + 1) % 3]]
    }

    #[inline]
    fn normal(&self) -> DVec3 {
        (self.at[1] - self.at[0]).cross(self.at[2] - self.at[0])
    }

    /// Where a node at the tip of a face that is no higher than `near` goes: onto the longest side, or to one of its ends.
    /// `None` for a face that is higher.
    pub(super) fn collapsed(&self, near: f64) -> Option<Mark> {
        let lengths = [0, 1, 2].map(|k| self.side(k)[0].distance_squared(self.side(k)[1]));
        let longest = if lengths[0] >= lengths[1] && lengths[0] >= lengths[2] {
            0
        } else {
            1 + usize::from(lengths[2] > lengths[1])
        };
        let height = near.max(0.5);
        if self.normal().length_squared() > height * height * lengths[longest] {
            return None;
        }
        let tip = (longest + 2) % 3;
        for end in [longest, (longest + 1) % 3] {
            if self.at[tip].distance_squared(self.at[end]) <= height * height {
                return Some(Mark::Together(self.nodes[tip], self.nodes[end]));
            }
        }
        Some(Mark::NodeOnEdge(self.nodes[tip], self.edge(longest)))
    }
}

/// The axis along which a normal is longest.
#[inline]
pub(super) fn dominant_axis(normal: DVec3) -> usize {
    let n = normal.abs();
    if n.x >= n.y && n.x >= n.z { 0 } else { 1 + usize::from(n.z > n.y) }
}

#[inline]
fn flat(p: DVec3, axis: usize) -> Coord<f64> {
    let (x, y) = plane_axes(axis);
    Coord { x: p[x], y: p[y] }
}

/// Twice the area of a triangle seen along an axis, above zero when anticlockwise. Exact in its sign.
#[inline]
pub(super) fn flat_turn(axis: usize, a: DVec3, b: DVec3, c: DVec3) -> f64 {
    orient2d(flat(a, axis), flat(b, axis), flat(c, axis))
}

fn flat_length(axis: usize, [p, q]: [DVec3; 2]) -> f64 {
    let (x, y) = plane_axes(axis);
    ((q[x] - p[x]).powi(2) + (q[y] - p[y]).powi(2)).sqrt()
}

/// Sign of a value, zero up to a tolerance.
#[inline]
fn sign(value: f64, tolerance: f64) -> i8 {
    i8::from(value > tolerance) - i8::from(value < -tolerance)
}

/// Where a point is about a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Where {
    Outside,
    Inside,
    Edge(usize),
    Node(usize),
}

/// From on which sides of a triangle's three edges a point is (inside: all 1, on one: 0).
fn place(sides: [i8; 3]) -> Where {
    if sides.contains(&-1) {
        return Where::Outside;
    }
    match sides {
        [1, 1, 1] => Where::Inside,
        [0, 1, 1] => Where::Edge(0),
        [1, 0, 1] => Where::Edge(1),
        [1, 1, 0] => Where::Edge(2),
        [0, 0, 1] => Where::Node(1),
        [1, 0, 0] => Where::Node(2),
        [0, 1, 0] => Where::Node(0),
        _ => Where::Outside,
    }
}

/// Where a point in the plane of a face is.
fn locate(t: &Corners, axis: usize, p: DVec3, near: f64) -> Where {
    if let Some(k) = (0..3).find(|&k| t.at[k].distance_squared(p) <= near * near) {
        return Where::Node(k);
    }
    let round = if flat_turn(axis, t.at[0], t.at[1], t.at[2]) < 0.0 { -1.0 } else { 1.0 };
    let sides = [0, 1, 2].map(|k| {
        let [a, b] = t.side(k);
        sign(round * flat_turn(axis, a, b, p), near * flat_length(axis, [a, b]))
    });
    match place(sides) {
        // Between two edges that part slowly: on the nearer one, as far as it reaches.
        Where::Node(_) => {
            let off = |k: usize| {
                let [a, b] = t.side(k);
                (flat_turn(axis, a, b, p) / flat_length(axis, [a, b])).abs()
            };
            let nearest = (0..3).filter(|&k| sides[k] == 0).min_by(|a, b| off(*a).total_cmp(&off(*b)));
            match nearest {
                Some(k) if beside(t.side(k), p) => Where::Edge(k),
                _ => Where::Outside,
            }
        }
        other => other,
    }
}

/// Whether a point projects into a segment.
fn beside([a, b]: [DVec3; 2], p: DVec3) -> bool {
    let along = (p - a).dot(b - a);
    along > 0.0 && along < (b - a).length_squared()
}

/// Where a segment that has its ends on different sides of a face's plane pierces it; `up`: it comes from below.
fn pierce(t: &Corners, [p, q]: [DVec3; 2], up: bool, near: f64) -> Where {
    let round = if up { 1.0 } else { -1.0 };
    let volumes = [0, 1, 2].map(|k| {
        let [a, b] = t.side(k);
        round * volume_sign(p, q, a, b)
    });
    if near == 0.0 {
        return place(volumes.map(|v| sign(v, 0.0)));
    }
    // Distances of the lines from each other.
    let off = [0, 1, 2].map(|k| {
        let [a, b] = t.side(k);
        volumes[k] / (q - p).cross(b - a).length()
    });
    match place(off.map(|d| sign(d, near))) {
        // Between two sides of a sharp corner the corner itself may be far away.
        Where::Node(corner) if !near_line([p, q], t.at[corner], 2.0 * near) => {
            let sides = [corner, (corner + 2) % 3];
            Where::Edge(if off[sides[0]].abs() <= off[sides[1]].abs() { sides[0] } else { sides[1] })
        }
        place => place,
    }
}

/// Whether a point is within a distance of the line through two others.
fn near_line([p, q]: [DVec3; 2], r: DVec3, distance: f64) -> bool {
    (q - p).cross(r - p).length_squared() <= distance * distance * (q - p).length_squared()
}

/// Whether two segments in a plane cross, farther than `near` from their ends.
fn cross(axis: usize, [a, b]: [DVec3; 2], [p, q]: [DVec3; 2], near: f64) -> bool {
    let one = near * flat_length(axis, [a, b]);
    let (at_p, at_q) = (sign(flat_turn(axis, a, b, p), one), sign(flat_turn(axis, a, b, q), one));
    if at_p * at_q != -1 {
        return false;
    }
    let other = near * flat_length(axis, [p, q]);
    sign(flat_turn(axis, p, q, a), other) * sign(flat_turn(axis, p, q, b), other) == -1
}

/// A face seen from another.
struct View {
    /// Sides of the other's plane that the corners are on; common corners are on it.
    sides: [i8; 3],
    shared: [bool; 3],
}

impl View {
    fn of(seen: &Corners, from: &Corners, normal: DVec3, near: f64) -> Self {
        let shared = seen.nodes.map(|v| from.nodes.contains(&v));
        let tolerance = near * normal.length();
        let [a, b, c] = from.at;
        let sides =
            [0, 1, 2].map(|k| if shared[k] { 0 } else { sign(volume_sign(a, b, c, seen.at[k]), tolerance) });
        Self { sides, shared }
    }

    fn apart(&self) -> bool {
        !self.sides.contains(&0) && self.sides.iter().all(|s| *s == self.sides[0])
    }

    /// Nothing but the common corners is on the plane, and nothing is on the other side of it.
    fn touches_in_shared(&self) -> bool {
        let beyond = |wanted: i8| (0..3).all(|k| self.shared[k] || self.sides[k] == wanted);
        beyond(1) || beyond(-1)
    }
}

/// Finds out where two faces meet beside the nodes that they share. What lies within `near` of each other coincides; with
/// 0 all is exact. Faces that are thinner than `near` are not to be asked.
pub(super) fn meet(one: &Corners, other: &Corners, near: f64, out: &mut Vec<Finding>) -> Verdict {
    let (normal, other_normal) = (one.normal(), other.normal());
    let shared_count = other.nodes.iter().filter(|v| one.nodes.contains(v)).count();
    let axis = dominant_axis(normal);
    match shared_count {
        0 if parted_by_side(one, other, axis, near) => return Verdict::Apart,
        1 if parted_at_corner(one, other, axis, near) => return Verdict::Apart,
        3 => return Verdict::Apart,
        _ => {}
    }
    let seen = View::of(other, one, normal, near);
    if seen.apart() || seen.touches_in_shared() {
        return Verdict::Apart;
    }
    let back = View::of(one, other, other_normal, near);
    if back.apart() || back.touches_in_shared() {
        return Verdict::Apart;
    }
    let mut marks: Vec<Mark> = Vec::new();
    let mut in_plane = false;
    for (host, host_normal, guest, view) in [(one, normal, other, &seen), (other, other_normal, one, &back)] {
        let axis = dominant_axis(host_normal);
        if shared_count == 2 && parted(host, guest, view, axis) {
            return Verdict::Apart;
        }
        for k in 0..3 {
            if view.sides[k] == 0 && !view.shared[k] {
                match locate(host, axis, guest.at[k], near) {
                    Where::Outside => {}
                    Where::Inside => marks.push(Mark::NodeOnFace(guest.nodes[k], host.face)),
                    Where::Edge(side) => marks.push(Mark::NodeOnEdge(guest.nodes[k], host.edge(side))),
                    Where::Node(corner) => {
                        let (a, b) = (guest.nodes[k], host.nodes[corner]);
                        marks.push(Mark::Together(a.min(b), a.max(b)));
                    }
                }
            }
            let next = (k + 1) % 3;
            let (guest_edge, guest_side) = (guest.edge(k), guest.side(k));
            match (view.sides[k], view.sides[next]) {
                (0, 0) if !(view.shared[k] && view.shared[next]) => {
                    in_plane = true;
                    out.push(Finding::EdgeInFace(guest_edge, host.face));
                    for side in 0..3 {
                        let host_edge = host.edge(side);
                        if !host_edge.contains(&guest_edge[0])
                            && !host_edge.contains(&guest_edge[1])
                            && cross(axis, host.side(side), guest_side, near)
                        {
                            marks
                                .push(Mark::EdgesCross(host_edge.min(guest_edge), host_edge.max(guest_edge)));
                        }
                    }
                }
                (a, b) if a * b == -1 => match pierce(host, guest_side, a < 0, near) {
                    Where::Outside => {}
                    Where::Inside => marks.push(Mark::EdgeThroughFace(guest_edge, host.face)),
                    Where::Edge(side) => {
                        let host_edge = host.edge(side);
                        marks.push(Mark::EdgesCross(host_edge.min(guest_edge), host_edge.max(guest_edge)));
                    }
                    Where::Node(corner) => marks.push(Mark::NodeOnEdge(host.nodes[corner], guest_edge)),
                },
                _ => {}
            }
        }
    }
    marks.sort_unstable();
    marks.dedup();
    out.extend(marks.iter().map(|m| Finding::Mark(*m)));
    let shared = (0..3).find(|&k| seen.shared[k]).map(|k| other.nodes[k]);
    if !in_plane && marks.len() + usize::from(shared.is_some()) >= 2 {
        let faces = [one.face.min(other.face), one.face.max(other.face)];
        out.push(Finding::Line { faces, marks: marks.clone(), shared });
    }
    if marks.is_empty() { Verdict::Unclear } else { Verdict::Marked }
}

/// Whether a side of one of two faces parts them by more than `near`, seen along an axis.
fn parted_by_side(one: &Corners, other: &Corners, axis: usize, near: f64) -> bool {
    let parts = |t: &Corners, u: &Corners| {
        (0..3).any(|k| {
            let [a, b] = t.side(k);
            let slack = near * flat_length(axis, [a, b]);
            let own = sign(flat_turn(axis, a, b, t.at[(k + 2) % 3]), 0.0);
            own != 0 && u.at.iter().all(|p| sign(flat_turn(axis, a, b, *p), slack) == -own)
        })
    };
    parts(one, other) || parts(other, one)
}

/// Whether two faces with one common node lie, seen along an axis, on either side of a line through it, farther from it
/// than `near`.
fn parted_at_corner(one: &Corners, other: &Corners, axis: usize, near: f64) -> bool {
    let Some((i, k)) = (0..3).find_map(|i| Some((i, other.nodes.iter().position(|v| *v == one.nodes[i])?)))
    else {
        return false;
    };
    let centre = one.at[i];
    let [a, b] = [one.at[(i + 1) % 3], one.at[(i + 2) % 3]];
    let [c, d] = [other.at[(k + 1) % 3], other.at[(k + 2) % 3]];
    let turn = |p: DVec3, q: DVec3| flat_turn(axis, centre, p, q);
    // Turns from one's ends to the other's, and how near an end may be to the line through another.
    let turns = [a, b].map(|p| [c, d].map(|q| turn(p, q)));
    let (own, others_own) = (turn(a, b), turn(c, d));
    let slack = |p: DVec3| near * flat_length(axis, [centre, p]);
    let slacks = [[a, b], [c, d]].map(|ends| ends.map(slack));
    let clear = |i: usize, k: usize| turns[i][k].abs() > slacks[0][i].max(slacks[1][k]);
    // On the far side of the common node.
    let (x, y) = plane_axes(axis);
    let opposite = |i: usize, k: usize| {
        let (p, q) = ([a, b][i] - centre, [c, d][k] - centre);
        p[x] * q[x] + p[y] * q[y] < 0.0
    };
    let parts = |i: usize, k: usize, turn: f64| {
        (turn < 0.0 && (clear(i, k) || opposite(i, k))) || (turn == 0.0 && opposite(i, k))
    };
    // The line to an end parts the faces if their other ends lie on either side of it.
    let by_own = |i: usize, inner: f64| inner != 0.0 && (0..2).all(|k| parts(i, k, turns[i][k] * inner));
    let by_other = |k: usize, inner: f64| inner != 0.0 && (0..2).all(|i| parts(i, k, -turns[i][k] * inner));
    by_own(0, own) || by_own(1, -own) || by_other(0, others_own) || by_other(1, -others_own)
}

/// Whether two faces at one edge lie on either side of it, seen along an axis.
fn parted(host: &Corners, guest: &Corners, view: &View, axis: usize) -> bool {
    let Some(tip) = (0..3).find(|&k| !view.shared[k]) else { return false };
    let ends = [guest.at[(tip + 1) % 3], guest.at[(tip + 2) % 3]];
    let Some(host_tip) = (0..3).find(|&k| !guest.nodes.contains(&host.nodes[k])) else { return false };
    let turns = [guest.at[tip], host.at[host_tip]].map(|p| flat_turn(axis, ends[0], ends[1], p));
    turns[0] * turns[1] < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(face: u32, nodes: [u32; 3], at: [[f64; 3]; 3]) -> Corners {
        Corners { face, nodes, at: at.map(DVec3::from_array) }
    }

    fn marks(one: &Corners, other: &Corners, near: f64) -> Vec<Mark> {
        let mut out = Vec::new();
        meet(one, other, near, &mut out);
        out.into_iter().filter_map(|f| if let Finding::Mark(m) = f { Some(m) } else { None }).collect()
    }

    const BASE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [400.0, 0.0, 0.0], [0.0, 400.0, 0.0]];

    #[test]
    fn what_crosses_and_what_touches() {
        let base = corners(0, [0, 1, 2], BASE);
        let through = corners(1, [3, 4, 5], [[50.0, 50.0, -50.0], [50.0, 50.0, 50.0], [900.0, 900.0, 50.0]]);
        let found = marks(&base, &through, 0.0);
        assert_eq!(found, [Mark::EdgeThroughFace([1, 2], 1), Mark::EdgeThroughFace([3, 4], 0)]);
        let above = corners(1, [3, 4, 5], [[50.0, 50.0, 2.0], [60.0, 50.0, 90.0], [70.0, 90.0, 50.0]]);
        assert!(marks(&base, &above, 0.0).is_empty());
        assert_eq!(marks(&base, &above, 2.0), [Mark::NodeOnFace(3, 0)]);
        let beside = corners(1, [3, 4, 5], [[100.0, -1.0, 0.0], [100.0, -90.0, 9.0], [170.0, -90.0, -20.0]]);
        assert!(marks(&base, &beside, 0.0).is_empty());
        assert_eq!(marks(&base, &beside, 2.0), [Mark::NodeOnEdge(3, [0, 1])]);
    }

    #[test]
    fn neighbours_do_not_meet_unless_folded() {
        let base = corners(0, [0, 1, 2], BASE);
        for (tip, found) in [([300.0, -300.0, 0.0], 0), ([300.0, 300.0, 99.0], 0), ([50.0, 50.0, 0.0], 1)] {
            let next = corners(1, [1, 0, 3], [BASE[1], BASE[0], tip]);
            assert_eq!(marks(&base, &next, 2.0).len(), found, "{tip:?}");
            assert_eq!(marks(&base, &next, 0.0).len(), found, "{tip:?}");
        }
        let fan = corners(1, [0, 3, 4], [BASE[0], [-300.0, 5.0, 0.0], [-300.0, -300.0, 0.0]]);
        assert!(marks(&base, &fan, 2.0).is_empty());
    }

    #[test]
    fn flat_overlaps() {
        let base = corners(0, [0, 1, 2], BASE);
        let turned = corners(1, [3, 4, 5], [[-50.0, 100.0, 1.0], [500.0, 100.0, 1.0], [-50.0, 200.0, 1.0]]);
        let mut out = Vec::new();
        meet(&base, &turned, 2.0, &mut out);
        assert_eq!(out.iter().filter(|f| matches!(f, Finding::EdgeInFace(..))).count(), 6);
        assert_eq!(marks(&base, &turned, 2.0).len(), 4);
    }

    #[test]
    fn thin_faces_collapse_onto_their_longest_side() {
        let thin = corners(0, [0, 1, 2], [[0.0, 0.0, 0.0], [90.0, 1.0, 0.0], [200.0, 0.0, 0.0]]);
        assert_eq!(thin.collapsed(2.0), Some(Mark::NodeOnEdge(1, [0, 2])));
        let short = corners(0, [0, 1, 2], [[0.0, 0.0, 0.0], [199.0, 1.0, 0.0], [200.0, 0.0, 0.0]]);
        assert_eq!(short.collapsed(2.0), Some(Mark::Together(1, 2)));
        assert_eq!(corners(0, [0, 1, 2], BASE).collapsed(2.0), None);
    }
}
