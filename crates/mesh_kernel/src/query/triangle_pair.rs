//! Whether two triangles have a point in common, decided exactly.
//!
//! All decisions are signs of `orient2d` and `orient3d` (Shewchuk 1997). Triangles are closed: touching counts. What lies
//! in one plane is compared in all three axis projections: the one that keeps the plane decides, and the others cannot
//! contradict it.

use std::cmp::Ordering;

use glam::DVec3;
use robust::{Coord, Coord3D, orient2d, orient3d};

type Triangle = [DVec3; 3];
type Point = Coord<f64>;

/// Side of `p` about the plane of a triangle.
#[inline]
fn side([a, b, c]: &Triangle, p: DVec3) -> Ordering {
    let at = |p: DVec3| Coord3D { x: p.x, y: p.y, z: p.z };
    sign(orient3d(at(*a), at(*b), at(*c), at(p)))
}

#[inline]
fn sign(value: f64) -> Ordering {
    value.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
}

/// Whether both are strictly on the same side.
#[inline]
fn apart(a: Ordering, b: Ordering) -> bool {
    a == b && a != Ordering::Equal
}

/// The projection in which a triangle is seen largest.
fn widest([a, b, c]: &Triangle) -> usize {
    let n = (*b - *a).cross(*c - *a).abs();
    if n.x >= n.y && n.x >= n.z {
        0
    } else if n.y >= n.z {
        1
    } else {
        2
    }
}

/// Whether the line through `p` and `q`, seen in a plane, has all of `others` strictly on one side and `apex` not.
fn parts(p: Point, q: Point, apex: Point, others: &[Point]) -> bool {
    let on = sign(orient2d(p, q, others[0]));
    on != Ordering::Equal
        && others[1..].iter().all(|o| sign(orient2d(p, q, *o)) == on)
        && sign(orient2d(p, q, apex)) != on
}

/// Whether a line along a side of either parts two triangles seen along an axis: a quick way to see that they do not
/// meet, which takes no determinants of three rows. Neighbours in a flat mesh mostly are.
fn seen_apart(one: &Triangle, other: &Triangle) -> bool {
    let axis = widest(one);
    let (one, other) = (one.map(|p| project(p, axis)), other.map(|p| project(p, axis)));
    let by_side_of =
        |t: &[Point; 3], u: &[Point; 3]| (0..3).any(|i| parts(t[i], t[(i + 1) % 3], t[(i + 2) % 3], u));
    by_side_of(&one, &other) || by_side_of(&other, &one)
}

/// The same for triangles with a common corner, but for that corner. Sides of the two may lie on one line, if they leave
/// the corner in opposite directions.
fn seen_apart_beyond_corner(shared: DVec3, one: [DVec3; 2], other: [DVec3; 2]) -> bool {
    let axis = widest(&[shared, one[0], one[1]]);
    let shared = project(shared, axis);
    let (one, other) = (one.map(|p| project(p, axis)), other.map(|p| project(p, axis)));
    // Along the side from the corner to `p`, the third corner being `apex`.
    let by_side = |p: Point, apex: Point, rest: [Point; 2]| {
        let on = sign(orient2d(shared, p, apex)).reverse();
        let goes_back = |o: Point| {
            let (a, b) = if p.x == shared.x {
                (p.y - shared.y, o.y - shared.y)
            } else {
                (p.x - shared.x, o.x - shared.x)
            };
            (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0)
        };
        let turns = rest.map(|o| sign(orient2d(shared, p, o)));
        on != Ordering::Equal
            && turns.contains(&on)
            && (0..2).all(|i| turns[i] == on || (turns[i] == Ordering::Equal && goes_back(rest[i])))
    };
    let by_side_of = |[a, b]: [Point; 2], rest| by_side(a, b, rest) || by_side(b, a, rest);
    by_side_of(one, other) || by_side_of(other, one)
}

/// Whether two triangles touch or cross.
pub(super) fn triangles_meet(one: &Triangle, other: &Triangle) -> bool {
    if seen_apart(one, other) {
        return false;
    }
    let [a, b, c] = other.map(|p| side(one, p));
    if apart(a, b) && apart(b, c) {
        return false;
    }
    let [d, e, f] = one.map(|p| side(other, p));
    if apart(d, e) && apart(e, f) {
        return false;
    }
    if [a, b, c, d, e, f].iter().all(|s| *s == Ordering::Equal) {
        return flat_meet(one, other);
    }
    let sides = |t: &Triangle| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    sides(other).iter().any(|s| segment_meets(*s, one)) || sides(one).iter().any(|s| segment_meets(*s, other))
}

/// Whether two faces have more in common than the nodes they share. Faces with the same three nodes, or with a node
/// twice, have.
pub(crate) fn faces_meet_beyond_shared(one: [u32; 3], other: [u32; 3], at: impl Fn(u32) -> DVec3) -> bool {
    let is_shared = [0, 1, 2].map(|k| other.contains(&one[k]));
    let is_shared_too = [0, 1, 2].map(|k| one.contains(&other[k]));
    let count = |flags: [bool; 3]| flags.iter().filter(|flag| **flag).count();
    // The corner number `k` places after the first whose flag is `flag`.
    let find = |flags: [bool; 3], flag: bool| flags.iter().position(|f| *f == flag).unwrap_or(0);
    let after = |face: [u32; 3], corner: usize, k: usize| at(face[(corner + k) % 3]);
    match (count(is_shared), count(is_shared_too)) {
        (0, 0) => {
            let (one, other) = (one.map(&at), other.map(&at));
            !parted_by_side(&one, &other) && triangles_meet(&one, &other)
        }
        (1, 1) => {
            let (i, k) = (find(is_shared, true), find(is_shared_too, true));
            let rest = |face, corner| [after(face, corner, 1), after(face, corner, 2)];
            let (centre, rest) = (at(one[i]), [rest(one, i), rest(other, k)]);
            !parted_at_corner(centre, rest) && triangles_meet_beyond_corner(centre, rest[0], rest[1])
        }
        (2, 2) => {
            let (i, k) = (find(is_shared, false), find(is_shared_too, false));
            let (shared, tips) = ([after(one, i, 1), after(one, i, 2)], [at(one[i]), at(other[k])]);
            !parted_at_side(shared, tips) && triangles_meet_beyond_side(shared, tips[0], tips[1])
        }
        _ => true,
    }
}

// Most pairs of faces whose boxes meet are neighbours in a surface that is nearly flat there. Seen along the axis nearest to
// their normal they lie side by side, and so they do in space; that is told by few and cheap signs.

/// The axis along which a triangle looks largest.
fn widest_axis([a, b, c]: &Triangle) -> usize {
    let n = (*b - *a).cross(*c - *a).abs();
    if n.x >= n.y && n.x >= n.z { 0 } else { 1 + usize::from(n.z > n.y) }
}

/// Whether a side of one of two triangles parts them, seen along an axis.
fn parted_by_side(one: &Triangle, other: &Triangle) -> bool {
    let axis = widest_axis(one);
    let (one, other) = (one.map(|p| project(p, axis)), other.map(|p| project(p, axis)));
    let parts = |t: &[Point; 3], u: &[Point; 3]| {
        (0..3).any(|k| {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            let own = sign(orient2d(a, b, t[(k + 2) % 3]));
            own != Ordering::Equal && u.iter().all(|p| sign(orient2d(a, b, *p)) == own.reverse())
        })
    };
    parts(&one, &other) || parts(&other, &one)
}

/// Whether two triangles at a common corner, given by their other corners, lie on either side of a line through it, seen
/// along an axis.
fn parted_at_corner(centre: DVec3, rest: [[DVec3; 2]; 2]) -> bool {
    let axis = widest_axis(&[centre, rest[0][0], rest[0][1]]);
    let o = project(centre, axis);
    let [[a, b], [c, d]] = rest.map(|ends| ends.map(|p| project(p, axis)));
    // On the line to an end, but on the far side of the corner, or beyond the line.
    let beyond = |end: Point, own: Ordering, p: Point| {
        let turn = sign(orient2d(o, end, p));
        let opposite = (end.x - o.x) * (p.x - o.x) + (end.y - o.y) * (p.y - o.y) < 0.0;
        turn == own.reverse() || (turn == Ordering::Equal && opposite)
    };
    let parts = |end: Point, own_end: Point, ends: [Point; 2]| {
        let own = sign(orient2d(o, end, own_end));
        own != Ordering::Equal && ends.iter().all(|p| beyond(end, own, *p))
    };
    parts(a, b, [c, d]) || parts(b, a, [c, d]) || parts(c, d, [a, b]) || parts(d, c, [a, b])
}

/// Whether two triangles on a common side lie on either side of it, seen along an axis.
fn parted_at_side([a, b]: [DVec3; 2], tips: [DVec3; 2]) -> bool {
    let axis = widest_axis(&[a, b, tips[0]]);
    let (a, b) = (project(a, axis), project(b, axis));
    let [one, other] = tips.map(|p| sign(orient2d(a, b, project(p, axis))));
    one != Ordering::Equal && other == one.reverse()
}

/// Whether two triangles with the common corner `shared` have another point in common; the arrays hold the others.
fn triangles_meet_beyond_corner(shared: DVec3, one: [DVec3; 2], other: [DVec3; 2]) -> bool {
    if seen_apart_beyond_corner(shared, one, other) {
        return false;
    }
    // Whatever else they share reaches the side across from the corner in one of the two.
    segment_meets(one, &[shared, other[0], other[1]]) || segment_meets(other, &[shared, one[0], one[1]])
}

/// Whether two triangles on the common side `shared` have a point in common off it: flat on each other.
fn triangles_meet_beyond_side(shared: [DVec3; 2], one: DVec3, other: DVec3) -> bool {
    let axis = widest(&[shared[0], shared[1], one]);
    let [u, v, a, b] = [shared[0], shared[1], one, other].map(|p| project(p, axis));
    // Seen on either side of what they share; the middle test is the dear one.
    if parts(u, v, a, &[b]) || side(&[shared[0], shared[1], one], other) != Ordering::Equal {
        return false;
    }
    let mut all_flat = true;
    for axis in 0..3 {
        let [u, v, a, b] = [shared[0], shared[1], one, other].map(|p| project(p, axis));
        let (left, right) = (sign(orient2d(u, v, a)), sign(orient2d(u, v, b)));
        all_flat &= left == Ordering::Equal || right == Ordering::Equal;
        if apart(left, right) {
            return true;
        }
    }
    // A triangle without area on the side's line: nothing can be said for it.
    all_flat
}

/// Whether a segment touches or crosses a triangle.
fn segment_meets([p, q]: [DVec3; 2], triangle: &Triangle) -> bool {
    let (at_p, at_q) = (side(triangle, p), side(triangle, q));
    if apart(at_p, at_q) {
        return false;
    }
    if at_p == Ordering::Equal && at_q == Ordering::Equal {
        return flat_meet(&[p, q, q], triangle);
    }
    // The line pierces the plane; all turns about it must agree.
    let [a, b, c] = *triangle;
    let turns = [side(&[p, q, a], b), side(&[p, q, b], c), side(&[p, q, c], a)];
    !(turns.contains(&Ordering::Less) && turns.contains(&Ordering::Greater))
}

fn project(p: DVec3, dropped: usize) -> Point {
    match dropped {
        0 => Coord { x: p.y, y: p.z },
        1 => Coord { x: p.z, y: p.x },
        _ => Coord { x: p.x, y: p.y },
    }
}

/// Whether two triangles in one plane (or of no area) meet.
fn flat_meet(one: &Triangle, other: &Triangle) -> bool {
    // Triangles without area may be skew to each other: then no plane holds their sides.
    let skew = |[p, q]: [DVec3; 2], [r, s]: [DVec3; 2]| side(&[p, q, r], s) != Ordering::Equal;
    (0..3).all(|axis| {
        let one_flat = one.map(|p| project(p, axis));
        let other_flat = other.map(|p| project(p, axis));
        let crosses = (0..3).any(|i| {
            (0..3).any(|k| {
                !skew([one[i], one[(i + 1) % 3]], [other[k], other[(k + 1) % 3]])
                    && segments_meet(
                        [one_flat[i], one_flat[(i + 1) % 3]],
                        [other_flat[k], other_flat[(k + 1) % 3]],
                    )
            })
        });
        crosses || contains(&one_flat, other_flat[0]) || contains(&other_flat, one_flat[0])
    })
}

fn contains([a, b, c]: &[Point; 3], p: Point) -> bool {
    if sign(orient2d(*a, *b, *c)) == Ordering::Equal {
        return false;
    }
    let turns = [orient2d(*a, *b, p), orient2d(*b, *c, p), orient2d(*c, *a, p)].map(sign);
    !(turns.contains(&Ordering::Less) && turns.contains(&Ordering::Greater))
}

fn segments_meet([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
    let in_box = |a: Point, b: Point, p: Point| {
        p.x >= a.x.min(b.x) && p.x <= a.x.max(b.x) && p.y >= a.y.min(b.y) && p.y <= a.y.max(b.y)
    };
    let [c_side, d_side] = [c, d].map(|p| sign(orient2d(a, b, p)));
    let [a_side, b_side] = [a, b].map(|p| sign(orient2d(c, d, p)));
    let equal = Ordering::Equal;
    if c_side != d_side
        && a_side != b_side
        && c_side != equal
        && d_side != equal
        && a_side != equal
        && b_side != equal
    {
        return true;
    }
    (c_side == equal && in_box(a, b, c))
        || (d_side == equal && in_box(a, b, d))
        || (a_side == equal && in_box(c, d, a))
        || (b_side == equal && in_box(c, d, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn p(x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(x, y, z)
    }

    #[test]
    fn pairs_in_and_out_of_plane() {
        let base = [p(0.0, 0.0, 0.0), p(4.0, 0.0, 0.0), p(0.0, 4.0, 0.0)];
        let cases = [
            ("through", [p(1.0, 1.0, -1.0), p(1.0, 1.0, 1.0), p(5.0, 5.0, 1.0)], true),
            ("touching with a corner", [p(1.0, 1.0, 0.0), p(1.0, 1.0, 1.0), p(5.0, 5.0, 1.0)], true),
            ("a hair above", [p(1.0, 1.0, 5e-324), p(1.0, 1.0, 1.0), p(5.0, 5.0, 1.0)], false),
            ("plane cut, triangle missed", [p(5.0, 5.0, -1.0), p(5.0, 5.0, 1.0), p(9.0, 9.0, 1.0)], false),
            ("touching a side", [p(2.0, -1.0, 0.0), p(2.0, 0.0, 0.0), p(2.0, -1.0, 1.0)], true),
            ("touching a corner", [p(4.0, 0.0, 0.0), p(5.0, 0.0, 1.0), p(5.0, 0.0, -1.0)], true),
            ("parallel", base.map(|q| q + DVec3::Z), false),
            ("same", base, true),
            ("inside, flat", [p(1.0, 1.0, 0.0), p(1.5, 1.0, 0.0), p(1.0, 1.5, 0.0)], true),
            ("around, flat", base.map(|q| (q - p(1.0, 1.0, 0.0)) * 9.0), true),
            ("beside, flat", base.map(|q| q + p(3.0, 3.0, 0.0)), false),
            ("corner on side, flat", base.map(|q| q + p(2.0, 2.0, 0.0)), true),
            ("segment through", [p(1.0, 1.0, -1.0), p(1.0, 1.0, 1.0), p(1.0, 1.0, 0.5)], true),
            ("segment beside", [p(3.0, 3.0, -1.0), p(3.0, 3.0, 1.0), p(3.0, 3.0, 0.5)], false),
            ("point in", [p(1.0, 1.0, 0.0); 3], true),
            ("point beside", [p(3.0, 3.0, 0.0); 3], false),
            ("point above", [p(1.0, 1.0, 1.0); 3], false),
            ("segment in the plane, beside", [p(9.0, 0.0, 0.0), p(5.0, 0.0, 0.0), p(6.0, 0.0, 0.0)], false),
        ];
        for (name, other, meet) in cases {
            // In any turn, order and place.
            let turns: [fn(DVec3) -> DVec3; 3] =
                [|q| q, |q| DVec3::new(q.z, q.x, q.y), |q| DVec3::new(q.y, q.z, -q.x)];
            for turn in turns {
                let (one, mut other) = (base.map(turn), other.map(turn));
                for _ in 0..3 {
                    other.rotate_left(1);
                    let flipped = [other[0], other[2], other[1]];
                    for pair in [[one, other], [other, one], [one, flipped], [flipped, one]] {
                        assert_eq!(triangles_meet(&pair[0], &pair[1]), meet, "{name}");
                    }
                }
            }
        }
        // Segments and points alone.
        let cross = [
            [p(0.0, 0.0, 0.0), p(2.0, 2.0, 2.0), p(1.0, 1.0, 1.0)],
            [p(2.0, 0.0, 1.0), p(0.0, 2.0, 1.0), p(1.0, 1.0, 1.0)],
        ];
        assert!(triangles_meet(&cross[0], &cross[1]));
        assert!(!triangles_meet(&cross[0], &cross[1].map(|q| q + DVec3::X * 0.1)));
    }

    #[test]
    fn neighbours() {
        let (o, x, y, z) = (DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z);
        assert!(!triangles_meet_beyond_corner(o, [x, y], [-x, -y]));
        assert!(!triangles_meet_beyond_corner(o, [x, y], [-x, z]));
        assert!(triangles_meet_beyond_corner(o, [x, y], [x * 0.5, z]), "along a side");
        assert!(triangles_meet_beyond_corner(o, [x, y], [p(1.0, 1.0, -1.0), p(1.0, 1.0, 1.0)]));
        assert!(
            triangles_meet_beyond_corner(o, [x, y], [p(3.0, 1.0, 0.0), p(1.0, 3.0, 0.0)]),
            "flat, around"
        );
        assert!(!triangles_meet_beyond_side([o, x], y, z));
        assert!(!triangles_meet_beyond_side([o, x], y, -y));
        assert!(triangles_meet_beyond_side([o, x], y, p(0.3, 0.1, 0.0)));
    }
}
