//! One triangle cut along points and lines in it: a constrained Delaunay triangulation in the triangle's own plane.

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};

/// What a face is cut along. Its *local points* are numbered: corners 0, 1, 2, then the points on side 0, side 1,
/// side 2 in the face's direction, then the inner ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct FaceInput {
    /// Parameters on sides 0, 1, 2, along the face, rising, inside (0, 1).
    pub(super) sides: [Vec<f64>; 3],
    /// Areal coordinates, all above zero.
    pub(super) inner: Vec<[f64; 3]>,
    /// Straight lines between local points, not along a side.
    pub(super) lines: Vec<[u32; 2]>,
}

/// The cut face.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FaceMesh {
    /// Areal coordinates of the local points; behind those of the input the points where its lines cross.
    pub(super) points: Vec<[f64; 3]>,
    /// Anticlockwise as the face.
    pub(super) triangles: Vec<[u32; 3]>,
    /// For every line the local points on it, both ends included.
    pub(super) paths: Vec<Vec<u32>>,
}

/// Shape of a face whose corners do not tell one: equilateral.
const EQUILATERAL: [DVec2; 3] = [DVec2::ZERO, DVec2::new(1.0, 0.0), DVec2::new(0.5, 0.866_025_403_784_438_6)];

/// A triangle thinner than this, as height by longest side, is triangulated as if it were equilateral: which diagonals are
/// taken does not matter there, and positions in its plane would have too few digits.
const THIN: f64 = 1e-6;

/// The corners in their own plane, the longest side of length 1.
fn flat(corners: [DVec3; 3]) -> [DVec2; 3] {
    let [a, b, c] = corners;
    let scale = (b - a).length().max((c - b).length()).max((a - c).length());
    let (x, p) = ((b - a) / scale, (c - a) / scale);
    let length = x.length();
    let along = p.dot(x) / length;
    let height = x.cross(p).length() / length;
    if scale.is_finite() && height > THIN && length > THIN {
        [DVec2::ZERO, DVec2::new(length, 0.0), DVec2::new(along, height)]
    } else {
        EQUILATERAL
    }
}

/// Points of the flattened face nearer than this, its longest side being 1, are one.
const SAME_PLACE: f64 = 1e-9;

#[derive(Clone, Copy, Debug)]
struct Vertex {
    at: Point2<f64>,
}

impl HasPosition for Vertex {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

impl FaceInput {
    /// Areal coordinates of the local points.
    pub(super) fn points(&self) -> Vec<[f64; 3]> {
        let mut points = vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        for (i, side) in self.sides.iter().enumerate() {
            for &u in side {
                let mut areal = [0.0; 3];
                areal[i] = 1.0 - u;
                areal[(i + 1) % 3] = u;
                points.push(areal);
            }
        }
        points.extend_from_slice(&self.inner);
        points
    }

    /// The side that each of the first local points lies on, a corner's own side; inner points have none.
    fn sides_of(&self, point: u32) -> [bool; 3] {
        let mut on = [false; 3];
        if point < 3 {
            on[point as usize] = true;
            on[(point as usize + 2) % 3] = true;
            return on;
        }
        let mut first = 3;
        for (i, side) in self.sides.iter().enumerate() {
            on[i] = (first..first + side.len() as u32).contains(&point);
            first += side.len() as u32;
        }
        on
    }

    /// The side that two points both lie on.
    pub(super) fn sides_of_points(&self, p: u32, q: u32) -> Option<usize> {
        let (p, q) = (self.sides_of(p), self.sides_of(q));
        (0..3).find(|&i| p[i] && q[i])
    }

    /// All points on a side, in the face's direction, its corners included.
    pub(super) fn side_points(&self, i: usize) -> Vec<u32> {
        let first = 3 + self.sides[..i].iter().map(Vec::len).sum::<usize>() as u32;
        let mut points = vec![i as u32];
        points.extend(first..first + self.sides[i].len() as u32);
        points.push((i as u32 + 1) % 3);
        points
    }

    /// Cuts the face; `None` where points lie so near each other that no sound triangulation comes of it.
    /// O(points · log points) and what the lines cross.
    pub(super) fn cut(&self, corners: [DVec3; 3]) -> Option<FaceMesh> {
        let flat = flat(corners);
        let mut points = self.points();
        let boundary = points.len() - self.inner.len();
        let mut places: Vec<DVec2> =
            points.iter().map(|w| flat[0] * w[0] + flat[1] * w[1] + flat[2] * w[2]).collect();
        // Crossings first: constraints that cross each other are nothing for the triangulation.
        let paths = part_lines(&mut places, &self.lines);
        for &p in &places[points.len()..] {
            points.push(areal(flat, p)?);
        }
        let mut mesh: ConstrainedDelaunayTriangulation<Vertex> = ConstrainedDelaunayTriangulation::new();
        let mut handles = Vec::with_capacity(places.len());
        for (k, p) in places.iter().enumerate() {
            let handle = mesh.insert(Vertex { at: Point2::new(p.x, p.y) }).ok()?;
            // A point that falls on another would shift all numbers behind it.
            if handle.index() != k {
                return None;
            }
            handles.push(handle);
        }
        let outline = (0..3).map(|i| self.side_points(i));
        for run in outline.chain(paths.iter().cloned()) {
            for pair in run.windows(2) {
                let [from, to] = [pair[0], pair[1]].map(|v| handles[v as usize]);
                if mesh.get_edge_from_neighbors(from, to).is_none() && !mesh.can_add_constraint(from, to) {
                    return None;
                }
                mesh.add_constraint(from, to);
                // A point that rounding has put upon the line would have parted it.
                mesh.get_edge_from_neighbors(from, to)?;
            }
        }
        let mut triangles = Vec::new();
        for face in mesh.inner_faces() {
            let corners = face.vertices().map(|v| v.fix().index() as u32);
            // Between the points of a side and the hull there may be slivers of rounding.
            let sliver =
                (0..3).any(|i| corners.iter().all(|&v| (v as usize) < boundary && self.sides_of(v)[i]));
            if !sliver {
                triangles.push(turned(corners));
            }
        }
        triangles.sort_unstable();
        // Euler: triangles of a disk with these points. Another number means that rounding broke the outline.
        let inner = points.len() - boundary;
        (triangles.len() == boundary - 2 + 2 * inner).then_some(FaceMesh { points, triangles, paths })
    }
}

/// Lines cut where they cross each other or pass a point. New points come behind the given ones; every line becomes the
/// points on it, its ends included. O(lines² + lines · points).
fn part_lines(places: &mut Vec<DVec2>, lines: &[[u32; 2]]) -> Vec<Vec<u32>> {
    let given = places.len();
    let mut on: Vec<Vec<(f64, u32)>> = lines.iter().map(|&[a, b]| vec![(0.0, a), (1.0, b)]).collect();
    let ends = |places: &[DVec2], l: usize| lines[l].map(|v| places[v as usize]);
    for (l, on) in on.iter_mut().enumerate() {
        let [a, b] = ends(places, l);
        for (v, &p) in places.iter().enumerate().take(given) {
            let t = (p - a).dot(b - a) / (b - a).length_squared();
            let beside = p.distance(a.lerp(b, t));
            if !lines[l].contains(&(v as u32)) && (0.0..=1.0).contains(&t) && beside <= SAME_PLACE {
                on.push((t, v as u32));
            }
        }
    }
    for l in 0..lines.len() {
        for m in 0..l {
            if lines[l].iter().any(|v| lines[m].contains(v)) {
                continue;
            }
            let ([a, b], [c, d]) = (ends(places, l), ends(places, m));
            let turn = |p: DVec2, q: DVec2, r: DVec2| {
                let [p, q, r] = [p, q, r].map(|p| Coord { x: p.x, y: p.y });
                orient2d(p, q, r)
            };
            let (from, to) = (turn(c, d, a), turn(c, d, b));
            if from * to >= 0.0 || turn(a, b, c) * turn(a, b, d) >= 0.0 {
                continue;
            }
            let x = a.lerp(b, from / (from - to));
            let known = places.iter().position(|p| p.distance(x) <= SAME_PLACE);
            let v = known.unwrap_or_else(|| {
                places.push(x);
                places.len() - 1
            }) as u32;
            for (k, p, q) in [(l, a, b), (m, c, d)] {
                if on[k].iter().all(|&(_, w)| w != v) {
                    on[k].push(((x - p).dot(q - p) / (q - p).length_squared(), v));
                }
            }
        }
    }
    on.into_iter()
        .map(|mut on| {
            on.sort_by(|a, b| a.0.total_cmp(&b.0));
            on.into_iter().map(|(_, v)| v).collect()
        })
        .collect()
}

/// The same triangle with its lowest corner first.
fn turned([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// Areal coordinates of a point in the plane; `None` where it is not inside.
fn areal([a, b, c]: [DVec2; 3], p: DVec2) -> Option<[f64; 3]> {
    let whole = (b - a).perp_dot(c - a);
    let w = [(b - p).perp_dot(c - p), (c - p).perp_dot(a - p), (a - p).perp_dot(b - p)].map(|d| d / whole);
    w.iter().all(|&w| w > 0.0).then_some({
        let sum: f64 = w.iter().sum();
        w.map(|w| w / sum)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [DVec3; 3] = [DVec3::ZERO, DVec3::new(3.0, 0.0, 1.0), DVec3::new(0.0, 2.0, 5.0)];

    fn doubled(mesh: &FaceMesh) -> f64 {
        let det = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| mesh.points[v as usize]);
            a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        assert!(mesh.triangles.iter().all(|t| det(t) > 0.0));
        mesh.triangles.iter().map(det).sum()
    }

    #[test]
    fn points_on_sides_and_inside_are_corners_of_the_pieces() {
        let sides = [vec![0.1, 1.0 / 3.0, 0.7], vec![], vec![1e-7, 0.9]];
        let input = FaceInput { sides, inner: vec![[0.2, 0.3, 0.5], [0.4, 0.3, 0.3]], lines: vec![] };
        let mesh = input.cut(CORNERS).unwrap();
        assert_eq!((mesh.points.len(), mesh.triangles.len()), (10, 10));
        assert!((doubled(&mesh) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn lines_are_edges_and_get_a_point_where_they_cross() {
        let input = FaceInput {
            sides: [vec![0.5], vec![0.5], vec![0.5]],
            inner: vec![],
            lines: vec![[0, 4], [1, 5], [3, 5]],
        };
        let mesh = input.cut(CORNERS).unwrap();
        // Medians cross in the middle; side middles 3 and 5 cut the first of them.
        assert_eq!(mesh.points.len(), 8);
        assert_eq!(mesh.paths[0].len(), 4);
        assert!((doubled(&mesh) - 1.0).abs() < 1e-12);
        for path in &mesh.paths {
            for step in path.windows(2) {
                assert!(mesh.triangles.iter().any(|t| t.contains(&step[0]) && t.contains(&step[1])));
            }
        }
    }

    #[test]
    fn thin_and_far_faces_are_cut_too() {
        for corners in [
            [DVec3::ZERO, DVec3::X, DVec3::X * 2.0],
            [DVec3::ZERO, DVec3::X, DVec3::new(0.5, 1e-9, 0.0)],
            [DVec3::splat(1e9), DVec3::splat(1e9) + DVec3::X, DVec3::splat(1e9) + DVec3::Y],
        ] {
            let input = FaceInput {
                sides: [vec![0.2, 0.3], vec![0.999], vec![]],
                inner: vec![[0.98, 0.01, 0.01]],
                lines: vec![[6, 2], [3, 5]],
            };
            let mesh = input.cut(corners).unwrap();
            assert!((doubled(&mesh) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn one_place_twice_is_refused() {
        let inner = vec![[0.2, 0.3, 0.5], [0.2, 0.3, 0.5]];
        assert_eq!(FaceInput { inner, ..FaceInput::default() }.cut(CORNERS), None);
    }
}
