//! A drawing on a work plane while it is being edited (P4): shapes that share points.
//!
//! Whatever joins shares a point, so moving the point moves both. Every edit is whole or refused with a [`DrawingError`] that
//! leaves the drawing as it was. Lengths are millimetres.
//!
//! ```
//! use sketch::{Drawing, Rule};
//! use glam::DVec2;
//!
//! let mut drawing = Drawing::default();
//! let [a, b] = [DVec2::ZERO, DVec2::new(30.0, 1.0)].map(|p| drawing.add_point(p)).map(Result::unwrap);
//! let line = drawing.add_line(a, b)?;
//! drawing.add_rule(Rule::Level(line))?;
//! drawing.add_rule(Rule::Length(line, 40.0))?;
//! drawing.move_point(b, DVec2::new(100.0, 7.0))?;
//! // The line is still level and 40 mm long; the point that was moved is where it was put.
//! assert!((drawing.place(a)? - DVec2::new(60.0, 7.0)).length() < 1e-6);
//! # Ok::<(), sketch::DrawingError>(())
//! ```

mod corners;
mod crossings;
mod edit;
mod rules;
mod snap;

use std::collections::BTreeMap;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::{Curve, Outline, SketchError};

pub use crossings::{Crossing, crossings};
pub use rules::Rule;
pub use snap::{Snap, SnapKind, SnapOptions};

/// A shape has to be longer than this, mm: a millionth, which no tool can cut.
const SHORTEST: f64 = 1e-6;

/// A point of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct PointId(u32);

/// A shape of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ShapeId(u32);

impl PointId {
    /// Its number, by which people find it: no other point or shape of the drawing has it.
    pub fn number(self) -> u32 {
        self.0
    }
}

impl ShapeId {
    /// Its number, by which people find it: no other point or shape of the drawing has it.
    pub fn number(self) -> u32 {
        self.0
    }
}

/// A shape between points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// A straight line.
    Line([PointId; 2]),
    /// An arc. Its bulge is the tangent of a quarter of its sweep: 0 is straight, 1 a half circle, above 0 anticlockwise.
    Arc {
        /// Where it begins and ends.
        ends: [PointId; 2],
        /// How far it bends.
        bulge: f64,
    },
    /// A circle.
    Circle {
        /// Its centre.
        center: PointId,
        /// Its radius.
        radius: f64,
    },
    /// A cubic Bézier curve.
    Bezier {
        /// Where it begins and ends.
        ends: [PointId; 2],
        /// Its inner control points, each seen from its end.
        handles: [DVec2; 2],
    },
    /// A smooth curve through points; closed when the first is the last.
    Spline(Vec<PointId>),
}

/// Why an edit was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DrawingError {
    /// A number or a curve that cannot be.
    #[error(transparent)]
    Sketch(#[from] SketchError),
    /// The point is not there.
    #[error("the drawing has no point {}", .0.0)]
    NoPoint(PointId),
    /// The shape is not there.
    #[error("the drawing has no shape {}", .0.0)]
    NoShape(ShapeId),
    /// The edit is for other kinds of shapes.
    #[error("{what} is for {wanted} only")]
    Kind {
        /// The edit.
        what: &'static str,
        /// What it is for.
        wanted: &'static str,
    },
    /// Rules contradict each other, or the place where a point was put.
    #[error("the rules of the drawing cannot all hold: {0} is off by {1:.3}")]
    Rules(String, f64),
    /// Two shapes were expected at a point.
    #[error("{what} needs two shapes at the point, not {found}")]
    NotACorner {
        /// The edit.
        what: &'static str,
        /// How many there are.
        found: usize,
    },
    /// A corner cannot be rounded so much.
    #[error("the corner cannot be rounded by {radius} mm: its sides allow {most:.3} mm at most")]
    RoundTooLarge {
        /// What was asked.
        radius: f64,
        /// What is possible.
        most: f64,
    },
}

/// A point as it is kept.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Point {
    at: DVec2,
    /// Whether two shapes meet here in one direction.
    smooth: bool,
}

/// Shapes that share points. In files its parts are checked: what is read is what edits could have made.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Parts", into = "Parts")]
pub struct Drawing {
    points: BTreeMap<PointId, Point>,
    shapes: BTreeMap<ShapeId, Shape>,
    rules: Vec<Rule>,
    /// Number of the newest point or shape; none is used twice.
    next: u32,
}

/// A drawing as it stands in a file. Pairs, for maps with numbers as keys do not survive in tagged values.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Parts {
    points: Vec<(PointId, Point)>,
    shapes: Vec<(ShapeId, Shape)>,
    rules: Vec<Rule>,
    next: u32,
}

/// Parts of files have numbers up to this; as many are left for edits.
const NUMBERS: u32 = u32::MAX / 2;

impl From<Drawing> for Parts {
    fn from(d: Drawing) -> Self {
        let (points, shapes) = (d.points.into_iter().collect(), d.shapes.into_iter().collect());
        Self { points, shapes, rules: d.rules, next: d.next }
    }
}

impl TryFrom<Parts> for Drawing {
    type Error = DrawingError;

    fn try_from(p: Parts) -> Result<Self, DrawingError> {
        let newest = p.points.iter().map(|(id, _)| id.0).chain(p.shapes.iter().map(|(id, _)| id.0)).max();
        let next = p.next.max(newest.unwrap_or_default());
        if next > NUMBERS {
            return Err(
                SketchError::Number { what: "a number of a part", wanted: "2147483647 at most" }.into()
            );
        }
        let (points, shapes) = (p.points.into_iter().collect(), p.shapes.into_iter().collect());
        let mut drawing = Self { points, shapes, rules: Vec::new(), next };
        if drawing.points.values().any(|point| !point.at.is_finite()) {
            return Err(SketchError::Number { what: "a point", wanted: "made of finite numbers" }.into());
        }
        drawing.shapes.values().try_for_each(|shape| drawing.curve_of(shape).map(|_| ()))?;
        // Smooth points that no edit could align would have every later edit refused.
        drawing.clone().align_all()?;
        for rule in p.rules {
            drawing.check_rule(&rule)?;
            drawing.rules.push(rule);
        }
        Ok(drawing)
    }
}

impl Shape {
    /// The points that it needs, in order.
    pub fn points(&self) -> &[PointId] {
        match self {
            Self::Line(ends) | Self::Arc { ends, .. } | Self::Bezier { ends, .. } => ends,
            Self::Circle { center, .. } => std::slice::from_ref(center),
            Self::Spline(through) => through,
        }
    }

    fn points_mut(&mut self) -> &mut [PointId] {
        match self {
            Self::Line(ends) | Self::Arc { ends, .. } | Self::Bezier { ends, .. } => ends,
            Self::Circle { center, .. } => std::slice::from_mut(center),
            Self::Spline(through) => through,
        }
    }

    /// Where it begins and ends; `None` for a circle.
    pub fn ends(&self) -> Option<[PointId; 2]> {
        match self {
            Self::Line(ends) | Self::Arc { ends, .. } | Self::Bezier { ends, .. } => Some(*ends),
            Self::Circle { .. } => None,
            Self::Spline(through) => Some([*through.first()?, *through.last()?]),
        }
    }
}

impl Drawing {
    /// The points, in the order in which they were made.
    pub fn points(&self) -> impl Iterator<Item = (PointId, DVec2)> + '_ {
        self.points.iter().map(|(id, point)| (*id, point.at))
    }

    /// The shapes, in the order in which they were made.
    pub fn shapes(&self) -> impl Iterator<Item = (ShapeId, &Shape)> {
        self.shapes.iter().map(|(id, shape)| (*id, shape))
    }

    /// The rules that hold.
    pub fn rules(&self) -> &[Rule] {
        &self.rules
    }

    /// Where a point is.
    ///
    /// # Errors
    /// [`DrawingError::NoPoint`].
    pub fn place(&self, point: PointId) -> Result<DVec2, DrawingError> {
        self.points.get(&point).map(|p| p.at).ok_or(DrawingError::NoPoint(point))
    }

    /// Whether shapes meet in one direction at a point.
    ///
    /// # Errors
    /// [`DrawingError::NoPoint`].
    pub fn is_smooth(&self, point: PointId) -> Result<bool, DrawingError> {
        self.points.get(&point).map(|p| p.smooth).ok_or(DrawingError::NoPoint(point))
    }

    /// A shape.
    ///
    /// # Errors
    /// [`DrawingError::NoShape`].
    pub fn shape(&self, shape: ShapeId) -> Result<&Shape, DrawingError> {
        self.shapes.get(&shape).ok_or(DrawingError::NoShape(shape))
    }

    /// The curve of a shape.
    ///
    /// # Errors
    /// [`DrawingError`].
    pub fn curve(&self, shape: ShapeId) -> Result<Curve, DrawingError> {
        self.curve_of(self.shape(shape)?)
    }

    fn curve_of(&self, shape: &Shape) -> Result<Curve, DrawingError> {
        let curve = match shape {
            Shape::Line([a, b]) => Curve::line(self.place(*a)?, self.place(*b)?)?,
            Shape::Arc { ends: [a, b], bulge } => arc(self.place(*a)?, self.place(*b)?, *bulge)?,
            Shape::Circle { center, radius } => {
                Curve::arc(self.place(*center)?, *radius, 0.0, std::f64::consts::TAU)?
            }
            Shape::Bezier { ends: [a, b], handles } => {
                let (a, b) = (self.place(*a)?, self.place(*b)?);
                Curve::bezier(&[a, a + handles[0], b + handles[1], b])?
            }
            Shape::Spline(through) => {
                let places: Result<Vec<DVec2>, _> = through.iter().map(|p| self.place(*p)).collect();
                Curve::spline(&places?)?
            }
        };
        // Written so that a length that is no number is refused too.
        if curve.length() > SHORTEST { Ok(curve) } else { Err(SketchError::NoLength { curve: 1 }.into()) }
    }

    /// The shapes at a point, with the end (0 or 1) that they have there.
    pub fn at_point(&self, point: PointId) -> Vec<(ShapeId, usize)> {
        let ends = |shape: &Shape| shape.ends().into_iter().flatten().enumerate();
        self.shapes
            .iter()
            .flat_map(|(id, shape)| ends(shape).filter(|(_, p)| *p == point).map(|(end, _)| (*id, end)))
            .collect()
    }

    /// The drawing's outlines: circles, and shapes in rows as far as exactly two meet in a point. What a script draws with.
    ///
    /// # Errors
    /// [`DrawingError`].
    pub fn outlines(&self) -> Result<Vec<Outline>, DrawingError> {
        let mut left: Vec<ShapeId> = self.shapes.keys().copied().collect();
        let mut out = Vec::new();
        while let Some(first) = left.first().copied() {
            left.remove(0);
            let Some([begin, end]) = self.shape(first)?.ends() else {
                out.push(self.as_outline(first, false)?);
                continue;
            };
            let mut row = vec![(first, false)];
            for (front, mut at) in [(false, end), (true, begin)] {
                while let [one, other] = self.at_point(at)[..]
                    && let Some(place) = left.iter().position(|id| *id == one.0 || *id == other.0)
                {
                    let id = left.remove(place);
                    let its = if id == one.0 { one.1 } else { other.1 };
                    // Going on from the row's end it is walked from the end that it has there; before its beginning, to it.
                    let step = (id, (its == 1) != front);
                    if front {
                        row.insert(0, step)
                    } else {
                        row.push(step)
                    }
                    at = self.shape(id)?.ends().map_or(at, |ends| ends[1 - its]);
                }
            }
            let mut parts = Vec::with_capacity(row.len());
            for (id, reversed) in row {
                parts.push(self.as_outline(id, reversed)?);
            }
            out.push(if parts.len() == 1 { parts.remove(0) } else { Outline::Path(parts) });
        }
        Ok(out)
    }

    fn as_outline(&self, shape: ShapeId, reversed: bool) -> Result<Outline, DrawingError> {
        let curve = self.curve(shape)?;
        let curve = if reversed { curve.reversed() } else { curve };
        Ok(match curve {
            Curve::Line { from, to } => Outline::Line([from, to]),
            Curve::Arc { center, radius, start, sweep } if sweep.abs() < std::f64::consts::TAU => {
                let from = start.to_degrees();
                Outline::Arc { center, radius, from, to: from + sweep.to_degrees() }
            }
            Curve::Arc { center, radius, .. } => Outline::Circle { center, radius },
            Curve::Bezier { points } => Outline::Bezier(points.to_vec()),
            Curve::Spline { points, .. } => Outline::Spline(points),
        })
    }

    /// A drawing of an outline; ends of its curves that are in one place are one point.
    ///
    /// # Errors
    /// [`DrawingError`].
    pub fn of(outline: &Outline) -> Result<Self, DrawingError> {
        let mut drawing = Self::default();
        drawing.add_outline(outline)?;
        Ok(drawing)
    }

    /// Adds the curves of an outline; ends that are where the drawing has a point are that point. O(curves · points).
    ///
    /// # Errors
    /// [`DrawingError`]: what is wrong with the outline; nothing of it is added then.
    pub fn add_outline(&mut self, outline: &Outline) -> Result<(), DrawingError> {
        let curves = outline.curves()?;
        self.whole(|drawing| drawing.add_curves(curves))
    }

    fn add_curves(&mut self, curves: Vec<Curve>) -> Result<(), DrawingError> {
        for curve in curves {
            if let Curve::Arc { center, radius, sweep, .. } = curve
                && sweep.abs() >= std::f64::consts::TAU
            {
                let center = self.point_at(center)?;
                self.insert(Shape::Circle { center, radius });
                continue;
            }
            let ends = [self.point_at(curve.start())?, self.point_at(curve.end())?];
            let shape = match &curve {
                Curve::Line { .. } => Shape::Line(ends),
                Curve::Arc { sweep, .. } => Shape::Arc { ends, bulge: (sweep / 4.0).tan() },
                Curve::Bezier { points } => {
                    let handles = [points[1] - self.place(ends[0])?, points[2] - self.place(ends[1])?];
                    Shape::Bezier { ends, handles }
                }
                Curve::Spline { points, .. } => {
                    let mut through = vec![ends[0]];
                    for p in &points[1..points.len() - 1] {
                        through.push(self.add_point(*p)?);
                    }
                    through.push(ends[1]);
                    Shape::Spline(through)
                }
            };
            self.insert(shape);
        }
        Ok(())
    }

    /// The point at a place, new where there is none.
    fn point_at(&mut self, at: DVec2) -> Result<PointId, DrawingError> {
        let near = 1e-9 * (1.0 + at.length());
        let known = self.points().find(|(_, p)| p.distance(at) <= near).map(|(id, _)| id);
        known.map_or_else(|| self.add_point(at), Ok)
    }
}

/// Bulges below this are straight: less than a millionth of the chord off it, and the centre so far away that the ends of the
/// arc would be rounded.
const STRAIGHT: f64 = 1e-6;

/// The arc between two places with a bulge; a straight line where it has none.
fn arc(a: DVec2, b: DVec2, bulge: f64) -> Result<Curve, SketchError> {
    let chord = b - a;
    if bulge.abs() < STRAIGHT {
        return Curve::line(a, b);
    }
    if !(-1.0 / STRAIGHT..=1.0 / STRAIGHT).contains(&bulge) {
        return Err(SketchError::Number {
            what: "the sweep of an arc",
            wanted: "less than a turn: draw a circle",
        });
    }
    let sweep = 4.0 * bulge.atan();
    let center = (a + b) / 2.0 + chord.perp() * ((1.0 - bulge * bulge) / (4.0 * bulge));
    Curve::arc(center, center.distance(a), (a - center).to_angle(), sweep)
}
