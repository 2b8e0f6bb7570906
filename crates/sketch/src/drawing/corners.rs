//! Corners rounded, shapes trimmed.

use glam::DVec2;

use super::{Crossing, Drawing, DrawingError, PointId, Shape, ShapeId, crossings};
use crate::{Curve, SketchError};

impl Drawing {
    /// Rounds the corner of two lines with an arc that touches both; returns the arc.
    ///
    /// # Errors
    /// [`DrawingError`]: not two lines there, a straight corner, a radius for which their sides are too short.
    pub fn round(&mut self, corner: PointId, radius: f64) -> Result<ShapeId, DrawingError> {
        if !(radius.is_finite() && radius > 0.0) {
            return Err(SketchError::Number { what: "the radius", wanted: "finite and more than 0" }.into());
        }
        let at = self.place(corner)?;
        let found = self.at_point(corner);
        let [one, other] = found[..] else {
            return Err(DrawingError::NotACorner { what: "rounding", found: found.len() });
        };
        let far = |(id, end): (ShapeId, usize)| match self.shape(id)? {
            Shape::Line(ends) => self.place(ends[1 - end]),
            _ => Err(DrawingError::Kind { what: "rounding", wanted: "corners of two lines" }),
        };
        let (p, q) = (far(one)?, far(other)?);
        let (u, v) = ((p - at).normalize(), (q - at).normalize());
        let half = u.angle_to(v).abs() / 2.0;
        let shorter = p.distance(at).min(q.distance(at));
        let most = shorter * half.tan();
        if half <= 1e-9 || std::f64::consts::FRAC_PI_2 - half <= 1e-9 || radius >= most {
            let most = if half <= 1e-9 || std::f64::consts::FRAC_PI_2 - half <= 1e-9 { 0.0 } else { most };
            return Err(DrawingError::RoundTooLarge { radius, most });
        }
        let cut = radius / half.tan();
        // From one side to the other it turns by what the corner lacks to a straight line.
        let sweep = std::f64::consts::PI - 2.0 * half;
        let bulge = (sweep / 4.0).tan() * -u.perp_dot(v).signum();
        self.whole(|drawing| {
            let a = drawing.add_point(at + u * cut)?;
            let b = drawing.add_point(at + v * cut)?;
            for ((id, end), new) in [(one, a), (other, b)] {
                if let Some(Shape::Line(ends)) = drawing.shapes.get_mut(&id) {
                    ends[end] = new;
                }
            }
            drawing.points.remove(&corner);
            drawing.rules.retain(|rule| !rule.points().contains(&corner));
            drawing.add(Shape::Arc { ends: [a, b], bulge })
        })
    }

    /// Takes away the part of a line, an arc or a Bézier curve at a place, as far as to the next crossings with other shapes.
    /// Without a crossing all of it goes.
    ///
    /// # Errors
    /// [`DrawingError`]: an unknown shape, a circle or a spline.
    pub fn trim(&mut self, shape: ShapeId, near: DVec2) -> Result<(), DrawingError> {
        let [before, after] = self.part(shape, near)?;
        self.whole(|drawing| {
            // The last part first: parameters of what is before it stay as they are, but for scale.
            let mut middle = shape;
            if after < 1.0 {
                drawing.split(shape, after)?;
            }
            if before > 0.0 {
                drawing.split(shape, before / after)?;
                // Of a split the second part is the newest shape.
                middle = drawing.shapes.keys().next_back().copied().unwrap_or(shape);
            }
            drawing.delete_shape(middle)
        })
    }

    /// The parameters between which trimming takes a shape away at a place.
    ///
    /// # Errors
    /// [`DrawingError`]: an unknown shape, a circle or a spline.
    pub fn part(&self, shape: ShapeId, near: DVec2) -> Result<[f64; 2], DrawingError> {
        let curve = self.curve(shape)?;
        if matches!(self.shape(shape)?, Shape::Circle { .. } | Shape::Spline(_)) {
            return Err(DrawingError::Kind { what: "trimming", wanted: "lines, arcs and Bézier curves" });
        }
        let t = curve.nearest(near).t;
        let mut cuts: Vec<f64> = Vec::new();
        for (id, _) in self.shapes().filter(|(id, _)| *id != shape) {
            cuts.extend(crossings(&curve, &self.curve(id)?).iter().map(|c| c.t[0]));
        }
        const END: f64 = 1e-9;
        cuts.retain(|c| (END..=1.0 - END).contains(c));
        let before = cuts.iter().copied().filter(|c| *c <= t).fold(0.0, f64::max);
        let after = cuts.iter().copied().filter(|c| *c > t).fold(1.0, f64::min);
        Ok([before, after])
    }

    /// Prolongs a line at one of its ends (0 or 1) to the next shape that it meets.
    ///
    /// # Errors
    /// [`DrawingError`]: not a line, nothing that it would meet.
    pub fn extend(&mut self, shape: ShapeId, end: usize) -> Result<(), DrawingError> {
        let Shape::Line(ends) = *self.shape(shape)? else {
            return Err(DrawingError::Kind { what: "extending", wanted: "lines" });
        };
        let end = end.min(1);
        let (from, at) = (self.place(ends[1 - end])?, self.place(ends[end])?);
        let along = (at - from).normalize();
        let reach = self
            .points()
            .map(|(_, p)| p.distance(at))
            .chain(self.shapes().filter_map(|(id, _)| Some(self.curve(id).ok()?.length())))
            .fold(0.0, f64::max);
        let ray = Curve::line(at, at + along * (2.0 * reach + 1.0))?;
        let mut met: Option<DVec2> = None;
        for (id, other) in self.shapes().filter(|(id, _)| *id != shape) {
            if other.points().contains(&ends[end]) {
                continue;
            }
            // What it ends at already is no further.
            let beyond = |c: &Crossing| c.at.distance(at) > 1e-6 * reach;
            let first = crossings(&ray, &self.curve(id)?).into_iter().find(beyond).map(|c| c.at);
            met = [met, first].into_iter().flatten().min_by(|p, q| p.distance(at).total_cmp(&q.distance(at)));
        }
        let to =
            met.ok_or(DrawingError::Kind { what: "extending", wanted: "lines that point at another shape" })?;
        self.move_point(ends[end], to)
    }
}
