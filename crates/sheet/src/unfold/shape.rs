//! A facet in its own plane: its loops, trimmed where bends take their share.

use glam::{DVec2, DVec3};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::UnfoldError;
use crate::facets::{FacetSheet, Side};

/// Where the corner between two sides turns by no more than this, or inward, a trimmed side ends square instead of being
/// extended to meet its neighbour; cosine of the turn.
const SQUARE_END: f64 = 0.866;

/// A side of a facet in its plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FlatSide {
    pub(crate) side: Side,
    pub(crate) from: DVec2,
    pub(crate) to: DVec2,
}

/// A facet in its plane; seen from the tip of its normal it lies to the left of its sides.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FacetShape {
    pub(crate) loops: Vec<Vec<FlatSide>>,
}

impl FacetShape {
    pub(crate) fn new(sheet: &FacetSheet, facet: u32) -> Result<Self, UnfoldError> {
        let f = &sheet.facets[facet as usize];
        let curved = || UnfoldError::Curved { facet: f.name.clone() };
        if !f.plane {
            return Err(curved());
        }
        let first = f.loops.first().and_then(|l| l.first()).ok_or_else(curved)?;
        let node = |side: &Side, end: usize| {
            let ends = sheet.lines[side.line as usize].ends();
            sheet.positions[ends[if side.along { end } else { 1 - end }] as usize]
        };
        let origin = node(first, 0);
        let along = node(first, 1) - origin;
        // The first side may be off the plane by rounding; its direction in the plane is taken.
        let u = (along - f.normal * along.dot(f.normal)).try_normalize().unwrap_or(DVec3::X);
        let v = f.normal.cross(u);
        let place = |p: DVec3| DVec2::new((p - origin).dot(u), (p - origin).dot(v));
        let loops = f.loops.iter().map(|sides| {
            let flat =
                |side: &Side| FlatSide { side: *side, from: place(node(side, 0)), to: place(node(side, 1)) };
            sides.iter().map(flat).collect()
        });
        Ok(Self { loops: loops.collect() })
    }
}

/// A trimmed side: what is left of it, moved inward by its setback, and the corner before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TrimmedSide {
    pub(crate) from: DVec2,
    pub(crate) to: DVec2,
}

/// A facet's loops with what bends take cut off: `setback` gives it for every side.
///
/// Corners are where the moved sides meet. Where a bend ends on a straight edge or in a notch, it is cut off square.
pub(crate) fn trimmed(
    shape: &FacetShape,
    setback: impl Fn(Side) -> f64,
    name: &str,
) -> Result<Vec<Vec<TrimmedSide>>, UnfoldError> {
    let mut loops = Vec::with_capacity(shape.loops.len());
    for sides in &shape.loops {
        let n = sides.len();
        let by: Vec<f64> = sides.iter().map(|s| setback(s.side)).collect();
        let direction: Vec<DVec2> = sides.iter().map(|s| (s.to - s.from).normalize_or_zero()).collect();
        let mut out: Vec<TrimmedSide> =
            sides.iter().map(|s| TrimmedSide { from: s.from, to: s.to }).collect();
        for i in 0..n {
            let h = (i + n - 1) % n;
            if by[h] == 0.0 && by[i] == 0.0 {
                continue;
            }
            let (d, e) = (direction[h], direction[i]);
            let corner = sides[i].from;
            let turn = d.perp_dot(e);
            if turn <= 0.0 || d.dot(e) > SQUARE_END {
                out[h].to = corner + d.perp() * by[h];
                out[i].from = corner + e.perp() * by[i];
            } else {
                // Distances along both directions solve for the point at both setbacks.
                let at = corner + (d * -by[i] + e * by[h]) / turn;
                out[h].to = at;
                out[i].from = at;
            }
        }
        for (side, (left, d)) in sides.iter().zip(out.iter().zip(&direction)) {
            if (left.to - left.from).dot(*d) <= 0.0 {
                let setback = by.iter().copied().fold(0.0, f64::max);
                return Err(UnfoldError::TooSmall {
                    facet: name.to_owned(),
                    setback,
                    length: side.from.distance(side.to),
                });
            }
        }
        loops.push(out);
    }
    Ok(loops)
}

/// Corners of a trimmed loop, none twice in a row.
pub(crate) fn corners(sides: &[TrimmedSide]) -> Vec<DVec2> {
    let mut points: Vec<DVec2> = Vec::with_capacity(sides.len());
    for p in sides.iter().flat_map(|s| [s.from, s.to]) {
        if points.last() != Some(&p) {
            points.push(p);
        }
    }
    while points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    points
}

/// Triangles of what lies inside an outer loop and outside the others. Empty where loops cross.
pub(crate) fn triangulate(loops: &[Vec<DVec2>]) -> Vec<[DVec2; 3]> {
    let points: Vec<DVec2> = loops.concat();
    triangulate_numbers(loops).into_iter().map(|t| t.map(|k| points[k])).collect()
}

/// The same as numbers of the loops' points, counted through all loops; anticlockwise.
fn triangulate_numbers(loops: &[Vec<DVec2>]) -> Vec<[usize; 3]> {
    if let [points] = loops
        && points.len() == 3
    {
        let anticlockwise = (points[1] - points[0]).perp_dot(points[2] - points[0]) >= 0.0;
        return vec![if anticlockwise { [0, 1, 2] } else { [0, 2, 1] }];
    }
    let mut plane = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    // Points in one place are one: the first number of each.
    let mut numbers = Vec::new();
    let mut count = 0;
    for points in loops {
        let mut handles = Vec::with_capacity(points.len());
        for p in points {
            let Ok(handle) = plane.insert(Point2::new(p.x, p.y)) else { return Vec::new() };
            if handle.index() == numbers.len() {
                numbers.push(count);
            }
            handles.push(handle);
            count += 1;
        }
        for (i, &a) in handles.iter().enumerate() {
            let b = handles[(i + 1) % handles.len()];
            if a != b && plane.can_add_constraint(a, b) {
                plane.add_constraint(a, b);
            }
        }
    }
    plane
        .inner_faces()
        .map(|f| f.vertices())
        .filter(|v| {
            let at = v.map(|v| DVec2::new(v.position().x, v.position().y));
            inside((at[0] + at[1] + at[2]) / 3.0, loops)
        })
        .map(|v| v.map(|v| numbers[v.fix().index()]))
        .collect()
}

/// Triangles of a plane polygon with holes in space, as numbers of the loops' points, counted through all loops; they are
/// anticlockwise as the outer loop is.
pub(crate) fn flat_triangles(loops: &[Vec<DVec3>]) -> Vec<[usize; 3]> {
    let Some(&o) = loops.first().and_then(|l| l.first()) else { return Vec::new() };
    let area: DVec3 = loops[0].windows(2).map(|w| (w[0] - o).cross(w[1] - o)).sum();
    let Some(normal) = area.try_normalize() else { return Vec::new() };
    let u = normal.any_orthonormal_vector();
    let v = normal.cross(u);
    let flat: Vec<Vec<DVec2>> = loops
        .iter()
        .map(|l| l.iter().map(|p| DVec2::new((*p - o).dot(u), (*p - o).dot(v))).collect())
        .collect();
    triangulate_numbers(&flat)
}

/// Whether a point lies within an odd number of loops.
pub(crate) fn inside(p: DVec2, loops: &[Vec<DVec2>]) -> bool {
    let mut odd = false;
    for points in loops {
        for (i, a) in points.iter().enumerate() {
            let b = points[(i + 1) % points.len()];
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y) {
                odd = !odd;
            }
        }
    }
    odd
}
