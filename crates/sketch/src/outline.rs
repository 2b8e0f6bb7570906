//! What a person draws, as data.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::{Curve, SketchError};

/// A drawing: one shape, or curves end to end. In JSON an object with one key, such as `{"circle": {"center": [0, 0],
/// "radius": 5}}` or `{"polygon": [[0, 0], [10, 0], [0, 10]]}`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Outline {
    /// A rectangle, its corners rounded where a radius is given.
    Rectangle {
        /// Lower left corner.
        at: DVec2,
        /// Width and height.
        size: DVec2,
        /// Radius of its corners.
        #[serde(default)]
        round: f64,
    },
    /// A circle.
    Circle {
        /// Its centre.
        center: DVec2,
        /// Its radius.
        radius: f64,
    },
    /// Straight lines from point to point and back to the first.
    Polygon(Vec<DVec2>),
    /// Straight lines from point to point.
    Polyline(Vec<DVec2>),
    /// A straight line.
    Line([DVec2; 2]),
    /// An arc; angles in degrees, anticlockwise from x.
    Arc {
        /// Its centre.
        center: DVec2,
        /// Its radius.
        radius: f64,
        /// Where it begins.
        from: f64,
        /// Where it ends; less than `from` is clockwise.
        to: f64,
    },
    /// The arc from the first point over the second to the third.
    ArcThrough([DVec2; 3]),
    /// A Bézier curve of three or four control points.
    Bezier(Vec<DVec2>),
    /// A smooth curve through points.
    Spline(Vec<DVec2>),
    /// Shapes end to end.
    Path(Vec<Outline>),
}

/// Shapes in shapes deeper than this are refused.
const DEPTH: usize = 8;

/// More points than this are no drawing.
const POINTS: usize = 100_000;

impl Outline {
    /// The curves of the drawing, in order.
    pub(crate) fn curves(&self) -> Result<Vec<Curve>, SketchError> {
        let mut curves = Vec::new();
        self.add_to(&mut curves, 0)?;
        Ok(curves)
    }

    fn add_to(&self, curves: &mut Vec<Curve>, depth: usize) -> Result<(), SketchError> {
        let lines = |points: &[DVec2], closed: bool, curves: &mut Vec<Curve>| {
            let wanted = if closed { 3 } else { 2 };
            if points.len() < wanted {
                let what = if closed { "a polygon" } else { "a polyline" };
                return Err(SketchError::TooFewPoints { what, wanted, given: points.len() });
            }
            if points.len() > POINTS {
                return Err(SketchError::Number { what: "the number of points", wanted: "100000 at most" });
            }
            for w in points.windows(2) {
                curves.push(Curve::line(w[0], w[1])?);
            }
            if closed && points.first() != points.last() {
                curves.push(Curve::line(points[points.len() - 1], points[0])?);
            }
            Ok(())
        };
        match self {
            Self::Rectangle { at, size, round } => rectangle(*at, *size, *round, curves),
            Self::Circle { center, radius } => {
                curves.push(Curve::arc(*center, *radius, 0.0, std::f64::consts::TAU)?);
                Ok(())
            }
            Self::Polygon(points) => lines(points, true, curves),
            Self::Polyline(points) => lines(points, false, curves),
            Self::Line([a, b]) => lines(&[*a, *b], false, curves),
            Self::Arc { center, radius, from, to } => {
                curves.push(Curve::arc(*center, *radius, from.to_radians(), (to - from).to_radians())?);
                Ok(())
            }
            Self::ArcThrough([a, b, c]) => {
                curves.push(Curve::arc_through(*a, *b, *c)?);
                Ok(())
            }
            Self::Bezier(points) => {
                curves.push(Curve::bezier(points)?);
                Ok(())
            }
            Self::Spline(points) => {
                if points.len() > POINTS {
                    return Err(SketchError::Number {
                        what: "the number of points",
                        wanted: "100000 at most",
                    });
                }
                curves.push(Curve::spline(points)?);
                Ok(())
            }
            Self::Path(parts) => {
                if depth >= DEPTH {
                    return Err(SketchError::Number { what: "the depth of a path", wanted: "8 at most" });
                }
                parts.iter().try_for_each(|p| p.add_to(curves, depth + 1))
            }
        }
    }
}

fn rectangle(at: DVec2, size: DVec2, round: f64, curves: &mut Vec<Curve>) -> Result<(), SketchError> {
    if !(size.is_finite() && size.min_element() > 0.0 && at.is_finite()) {
        return Err(SketchError::Number {
            what: "the size of a rectangle",
            wanted: "finite and more than 0",
        });
    }
    if !(round.is_finite() && round >= 0.0) {
        return Err(SketchError::Number {
            what: "the radius of a corner",
            wanted: "finite and not negative",
        });
    }
    if 2.0 * round > size.min_element() {
        return Err(SketchError::RoundTooLarge { at, radius: round });
    }
    let corners = [at, at + DVec2::new(size.x, 0.0), at + size, at + DVec2::new(0.0, size.y)];
    for k in 0..4u32 {
        let (a, b) = (corners[k as usize], corners[(k as usize + 1) % 4]);
        let along = (b - a).normalize_or_zero();
        let (from, to) = (a + along * round, b - along * round);
        if from.distance(to) > 0.0 {
            curves.push(Curve::line(from, to)?);
        }
        if round > 0.0 {
            let quarter = std::f64::consts::FRAC_PI_2;
            let start = quarter * (f64::from(k) - 1.0);
            curves.push(Curve::arc(to + along.perp() * round, round, start, quarter)?);
        }
    }
    Ok(())
}
