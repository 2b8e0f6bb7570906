//! Rules: what stays true of a drawing while points are moved.
//!
//! Rules are projections of a few points each onto what the rule allows, with the least movement; they take turns until all
//! hold (Gauss–Seidel, as position-based dynamics do it: Müller et al. 2007). The point under the pointer does not give way.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::{Drawing, DrawingError, PointId, Shape, ShapeId};
use crate::SketchError;

/// What stays true.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rule {
    /// A line is level.
    Level(ShapeId),
    /// A line is plumb.
    Plumb(ShapeId),
    /// A line has a length, mm.
    Length(ShapeId, f64),
    /// Two lines are parallel.
    Parallel(ShapeId, ShapeId),
    /// Two lines stand square on each other.
    Square(ShapeId, ShapeId),
    /// Two lines have one length.
    Equal(ShapeId, ShapeId),
    /// A point stays where it is.
    Fixed(PointId, DVec2),
}

/// Rounds after which rules that do not hold contradict each other.
const ROUNDS: usize = 4000;
/// A rule holds when no point would move by more than this share of the drawing's size.
const HOLDS: f64 = 1e-9;
/// What may be left when rounds end.
const LEFT: f64 = 1e-6;

impl Rule {
    /// The shapes that it is about.
    pub fn shapes(&self) -> Vec<ShapeId> {
        match *self {
            Self::Level(a) | Self::Plumb(a) | Self::Length(a, _) => vec![a],
            Self::Parallel(a, b) | Self::Square(a, b) | Self::Equal(a, b) => vec![a, b],
            Self::Fixed(..) => Vec::new(),
        }
    }

    /// The points that it names itself.
    pub fn points(&self) -> Vec<PointId> {
        if let Self::Fixed(point, _) = self { vec![*point] } else { Vec::new() }
    }

    pub(super) fn rename(&mut self, from: PointId, to: PointId) {
        if let Self::Fixed(point, _) = self
            && *point == from
        {
            *point = to;
        }
    }

    fn words(&self) -> String {
        match self {
            Self::Level(_) => "a level line".to_owned(),
            Self::Plumb(_) => "a plumb line".to_owned(),
            Self::Length(_, length) => format!("the length of {length} mm"),
            Self::Parallel(..) => "a pair of parallel lines".to_owned(),
            Self::Square(..) => "a right angle".to_owned(),
            Self::Equal(..) => "a pair of equal lengths".to_owned(),
            Self::Fixed(..) => "a fixed point".to_owned(),
        }
    }
}

impl Drawing {
    /// Adds a rule and moves points so that all rules hold.
    ///
    /// # Errors
    /// [`DrawingError`]: shapes that are no lines, numbers that cannot be, rules that contradict each other.
    pub fn add_rule(&mut self, rule: Rule) -> Result<(), DrawingError> {
        self.check_rule(&rule)?;
        self.whole(|drawing| {
            drawing.rules.push(rule);
            drawing.obey(None)
        })
    }

    /// Whether a rule can be one of this drawing; whether it can hold is another question.
    pub(super) fn check_rule(&self, rule: &Rule) -> Result<(), DrawingError> {
        for shape in rule.shapes() {
            self.line(shape)?;
        }
        if let Rule::Length(_, length) = *rule
            && !(length.is_finite() && length > 0.0)
        {
            return Err(SketchError::Number { what: "a length", wanted: "finite and more than 0" }.into());
        }
        if let Rule::Fixed(point, at) = *rule {
            self.place(point)?;
            if !at.is_finite() {
                return Err(SketchError::Number { what: "a point", wanted: "made of finite numbers" }.into());
            }
        }
        Ok(())
    }

    /// Takes back a rule, by its place in [`rules`](Self::rules).
    pub fn delete_rule(&mut self, place: usize) {
        if place < self.rules.len() {
            self.rules.remove(place);
        }
    }

    fn line(&self, shape: ShapeId) -> Result<[PointId; 2], DrawingError> {
        match self.shape(shape)? {
            Shape::Line(ends) => Ok(*ends),
            _ => Err(DrawingError::Kind { what: "this rule", wanted: "lines" }),
        }
    }

    /// Moves points until all rules hold; `held` stays.
    pub(super) fn obey(&mut self, held: Option<PointId>) -> Result<(), DrawingError> {
        let rules = self.rules.clone();
        let size = self.points().map(|(_, p)| p.length()).fold(1.0, f64::max);
        let mut worst = 0.0;
        let mut at_fault = 0;
        for _ in 0..ROUNDS {
            (worst, at_fault) = (0.0, 0);
            for (i, rule) in rules.iter().enumerate() {
                let moved = self.project(rule, held)?;
                if moved > worst {
                    (worst, at_fault) = (moved, i);
                }
            }
            if worst <= HOLDS * size {
                break;
            }
        }
        if worst <= LEFT * size { Ok(()) } else { Err(DrawingError::Rules(rules[at_fault].words(), worst)) }
    }

    /// Moves the points of one rule onto what it allows; returns by how much that was missed before.
    fn project(&mut self, rule: &Rule, held: Option<PointId>) -> Result<f64, DrawingError> {
        if let Rule::Fixed(point, at) = *rule {
            let off = self.place(point)?.distance(at);
            if held != Some(point) {
                self.put(point, at);
            }
            return Ok(off);
        }
        let lines: Result<Vec<[PointId; 2]>, _> = rule.shapes().iter().map(|s| self.line(*s)).collect();
        let lines = lines?;
        let span = |drawing: &Self, [a, b]: [PointId; 2]| {
            Ok::<_, DrawingError>(drawing.place(b)? - drawing.place(a)?)
        };
        let first = span(self, lines[0])?;
        let wanted: Vec<DVec2> = match *rule {
            Rule::Level(_) => vec![DVec2::new(first.x, 0.0)],
            Rule::Plumb(_) => vec![DVec2::new(0.0, first.y)],
            Rule::Length(_, length) => vec![first.try_normalize().unwrap_or(DVec2::X) * length],
            Rule::Parallel(..) | Rule::Square(..) => {
                let second = span(self, lines[1])?;
                let turn = matches!(rule, Rule::Square(..));
                let turned = if turn { second.perp() } else { second };
                let turned = if turned.dot(first) < 0.0 { -turned } else { turned };
                let mean = (first.normalize_or_zero() + turned.normalize_or_zero()).try_normalize();
                let mean = mean.unwrap_or(DVec2::X);
                let other = if turn { -mean.perp() } else { mean };
                vec![mean * mean.dot(first), other * other.dot(second)]
            }
            Rule::Equal(..) => {
                let second = span(self, lines[1])?;
                let mean = (first.length() + second.length()) / 2.0;
                [first, second].map(|v| v.try_normalize().unwrap_or(DVec2::X) * mean).to_vec()
            }
            Rule::Fixed(..) => Vec::new(),
        };
        let mut worst: f64 = 0.0;
        for ([a, b], wanted) in lines.into_iter().zip(wanted) {
            let off = wanted - span(self, [a, b])?;
            worst = worst.max(off.length());
            let share = match held {
                Some(h) if h == a => [0.0, 1.0],
                Some(h) if h == b => [1.0, 0.0],
                _ => [0.5, 0.5],
            };
            let (p, q) = (self.place(a)?, self.place(b)?);
            self.put(a, p - off * share[0]);
            self.put(b, q + off * share[1]);
        }
        Ok(worst)
    }
}
