//! Curves end to end.

use glam::DVec2;

use crate::{Branch, Curve, Outline, SketchError};

/// Curves, each beginning where the one before ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// The curves, at least one.
    pub curves: Vec<Curve>,
    /// Whether the last one ends where the first begins.
    pub closed: bool,
}

/// A point of a sampled path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Where.
    pub at: DVec2,
    /// The curve that begins here or goes on from here.
    pub curve: usize,
    /// Whether two curves meet here, or the path begins or ends.
    pub corner: bool,
}

/// Ends of curves may be apart by this share of the path's size.
const GAP: f64 = 1e-9;

impl Path {
    /// The path of a drawing.
    ///
    /// # Errors
    /// [`SketchError`]: bad numbers, gaps, curves without length.
    pub fn of(outline: &Outline) -> Result<Self, SketchError> {
        Self::new(outline.curves()?)
    }

    /// A path of curves.
    ///
    /// # Errors
    /// [`SketchError`]: none, gaps between them, curves without length.
    pub fn new(curves: Vec<Curve>) -> Result<Self, SketchError> {
        if let Some(curve) = curves.iter().position(|c| c.length() <= 0.0) {
            return Err(SketchError::NoLength { curve: curve + 1 });
        }
        let (Some(first), Some(last)) = (curves.first(), curves.last()) else {
            return Err(SketchError::TooFewPoints { what: "a path", wanted: 2, given: 0 });
        };
        let size: f64 = curves.iter().map(Curve::length).sum();
        for (k, w) in curves.windows(2).enumerate() {
            let (ends, begins) = (w[0].end(), w[1].start());
            if ends.distance(begins) > GAP * size {
                return Err(SketchError::Gap { curve: k + 2, begins, ends });
            }
        }
        let closed = first.start().distance(last.end()) <= GAP * size;
        Ok(Self { curves, closed })
    }

    /// Length of all curves.
    pub fn length(&self) -> f64 {
        self.curves.iter().map(Curve::length).sum()
    }

    /// Where it begins.
    pub fn start(&self) -> DVec2 {
        self.curves[0].start()
    }

    /// Where it ends.
    pub fn end(&self) -> DVec2 {
        self.curves[self.curves.len() - 1].end()
    }

    /// Points between which the path is no farther than `tolerance` from its chords. The first point of a closed path is not
    /// repeated. O(points).
    pub fn sampled(&self, tolerance: f64) -> Vec<PathPoint> {
        self.sampled_within(tolerance, usize::MAX).unwrap_or_default()
    }

    /// The same, for drawings of which nothing is known: no more than `most` points.
    ///
    /// # Errors
    /// [`SketchError::TooFine`].
    pub fn sampled_within(&self, tolerance: f64, most: usize) -> Result<Vec<PathPoint>, SketchError> {
        let mut points = Vec::new();
        for (k, curve) in self.curves.iter().enumerate() {
            let parameters = curve.parameters(tolerance);
            for (i, t) in parameters[..parameters.len() - 1].iter().enumerate() {
                points.push(PathPoint { at: curve.point(*t), curve: k, corner: i == 0 });
            }
            if points.len() > most {
                return Err(SketchError::TooFine { most });
            }
        }
        if !self.closed {
            points.push(PathPoint { at: self.end(), curve: self.curves.len() - 1, corner: true });
        }
        Ok(points)
    }

    /// How the path leaves its beginning and, walked back, its end.
    pub fn branches(&self) -> [Branch; 2] {
        let first = &self.curves[0];
        let last = &self.curves[self.curves.len() - 1];
        [
            Branch { tangent: first.tangent(0.0), curvature: first.curvature(0.0) },
            Branch { tangent: -last.tangent(1.0), curvature: -last.curvature(1.0) },
        ]
    }

    /// Corners of the closed, sampled path, anticlockwise, if it neither crosses nor touches itself, and has no more than `most` of
    /// them. O(n log n) where few parts
    /// lie over each other.
    ///
    /// # Errors
    /// [`SketchError::Open`], [`SketchError::Crosses`], [`SketchError::TooFine`].
    pub fn simple_loop(&self, tolerance: f64, most: usize) -> Result<Vec<DVec2>, SketchError> {
        if !self.closed {
            return Err(SketchError::Open { begins: self.start(), ends: self.end() });
        }
        let mut points: Vec<DVec2> = self.sampled_within(tolerance, most)?.iter().map(|p| p.at).collect();
        if points.len() < 3 {
            return Err(SketchError::TooFewPoints { what: "an outline", wanted: 3, given: points.len() });
        }
        if let Some(at) = crossing(&points) {
            return Err(SketchError::Crosses { at });
        }
        let area: f64 = (0..points.len()).map(|i| points[i].perp_dot(points[(i + 1) % points.len()])).sum();
        if area < 0.0 {
            points.reverse();
        }
        Ok(points)
    }
}

/// Whether a closed polygon holds a place: whether an odd number of its sides lie to the right of it. O(points).
pub fn polygon_holds(points: &[DVec2], p: DVec2) -> bool {
    let sides = points.iter().zip(points.iter().cycle().skip(1));
    let crossed = |(a, b): &(&DVec2, &DVec2)| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
    };
    sides.filter(crossed).count() % 2 == 1
}

/// Where a closed polygon crosses or touches itself.
fn crossing(points: &[DVec2]) -> Option<DVec2> {
    let n = points.len();
    let mut segments: Vec<usize> = (0..n).collect();
    let ends = |i: usize| [points[i], points[(i + 1) % n]];
    let low = |i: usize| ends(i)[0].x.min(ends(i)[1].x);
    let high = |i: usize| ends(i)[0].x.max(ends(i)[1].x);
    segments.sort_by(|a, b| low(*a).total_cmp(&low(*b)).then(a.cmp(b)));
    for (k, &i) in segments.iter().enumerate() {
        for &j in &segments[k + 1..] {
            if low(j) > high(i) {
                break;
            }
            let neighbours = (i + 1) % n == j || (j + 1) % n == i;
            let ([a, b], [c, d]) = (ends(i), ends(j));
            let side = |a: DVec2, b: DVec2, p: DVec2| (b - a).perp_dot(p - a);
            if neighbours {
                // They may share their common end, but not run back on each other.
                let (first, second) = if (i + 1) % n == j { (b - a, d - c) } else { (d - c, b - a) };
                if first.perp_dot(second) == 0.0 && first.dot(second) < 0.0 {
                    return Some(if (i + 1) % n == j { b } else { a });
                }
                continue;
            }
            let (p, q) = (side(a, b, c), side(a, b, d));
            let (r, s) = (side(c, d, a), side(c, d, b));
            let boxes = a.min(b).cmple(c.max(d)).all() && c.min(d).cmple(a.max(b)).all();
            if boxes && p * q <= 0.0 && r * s <= 0.0 {
                return Some((c + d) / 2.0);
            }
        }
    }
    None
}
