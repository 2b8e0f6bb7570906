//! Edits of a drawing: points and shapes are made, moved, split, merged, deleted.

use glam::DVec2;

use super::{Drawing, DrawingError, Point, PointId, Shape, ShapeId};
use crate::{Curve, SketchError};

impl Drawing {
    /// Does an edit, or, where it or what it leads to is refused, nothing.
    pub(super) fn whole<T>(
        &mut self,
        edit: impl FnOnce(&mut Self) -> Result<T, DrawingError>,
    ) -> Result<T, DrawingError> {
        let mut edited = self.clone();
        let made = edit(&mut edited)?;
        edited.shapes.values().try_for_each(|shape| edited.curve_of(shape).map(|_| ()))?;
        *self = edited;
        Ok(made)
    }

    pub(super) fn add(&mut self, shape: Shape) -> Result<ShapeId, DrawingError> {
        self.whole(|drawing| Ok(drawing.insert(shape)))
    }

    /// Adds a shape that is checked later.
    pub(super) fn insert(&mut self, shape: Shape) -> ShapeId {
        let id = ShapeId(self.number());
        // Where a third shape joins, no two can be said to go on in one direction.
        for end in shape.points() {
            if let Some(point) = self.points.get_mut(end) {
                point.smooth = false;
            }
        }
        self.shapes.insert(id, shape);
        id
    }

    fn number(&mut self) -> u32 {
        self.next += 1;
        self.next
    }

    /// A new point.
    ///
    /// # Errors
    /// Coordinates that are not finite.
    pub fn add_point(&mut self, at: DVec2) -> Result<PointId, DrawingError> {
        if !at.is_finite() {
            return Err(SketchError::Number { what: "a point", wanted: "made of finite numbers" }.into());
        }
        let id = PointId(self.number());
        self.points.insert(id, Point { at, smooth: false });
        Ok(id)
    }

    /// A line between two points.
    ///
    /// # Errors
    /// [`DrawingError`]: unknown points, points in one place.
    pub fn add_line(&mut self, from: PointId, to: PointId) -> Result<ShapeId, DrawingError> {
        self.add(Shape::Line([from, to]))
    }

    /// The arc from one point to another over a place.
    ///
    /// # Errors
    /// [`DrawingError`]: unknown points, three places on one line.
    pub fn add_arc(&mut self, from: PointId, over: DVec2, to: PointId) -> Result<ShapeId, DrawingError> {
        let bulge = bulge_through(self.place(from)?, over, self.place(to)?)?;
        self.add(Shape::Arc { ends: [from, to], bulge })
    }

    /// A circle.
    ///
    /// # Errors
    /// [`DrawingError`]: an unknown point, a radius that is not positive.
    pub fn add_circle(&mut self, center: PointId, radius: f64) -> Result<ShapeId, DrawingError> {
        self.add(Shape::Circle { center, radius })
    }

    /// A Bézier curve; `leave` and `arrive` are its inner control points.
    ///
    /// # Errors
    /// [`DrawingError`]: unknown points, a curve without length.
    pub fn add_bezier(
        &mut self,
        from: PointId,
        leave: DVec2,
        arrive: DVec2,
        to: PointId,
    ) -> Result<ShapeId, DrawingError> {
        let handles = [leave - self.place(from)?, arrive - self.place(to)?];
        self.add(Shape::Bezier { ends: [from, to], handles })
    }

    /// A smooth curve through points.
    ///
    /// # Errors
    /// [`DrawingError`]: unknown points, fewer than two, neighbours in one place.
    pub fn add_spline(&mut self, through: &[PointId]) -> Result<ShapeId, DrawingError> {
        self.add(Shape::Spline(through.to_vec()))
    }

    /// Puts a point somewhere else. Handles go with their ends, arcs keep their bulge; rules move other points.
    ///
    /// # Errors
    /// [`DrawingError`]: an unknown point, a shape that would lose its length, rules that cannot hold then.
    pub fn move_point(&mut self, point: PointId, to: DVec2) -> Result<(), DrawingError> {
        self.place(point)?;
        if !to.is_finite() {
            return Err(SketchError::Number { what: "a point", wanted: "made of finite numbers" }.into());
        }
        self.whole(|drawing| {
            drawing.put(point, to);
            drawing.obey(Some(point))?;
            drawing.align_all()
        })
    }

    pub(super) fn put(&mut self, point: PointId, to: DVec2) {
        if let Some(point) = self.points.get_mut(&point) {
            point.at = to;
        }
    }

    /// Puts an inner control point of a Bézier curve, that of its beginning (0) or its end (1), to a place. At a smooth point
    /// the handle on the other side turns with it and keeps its length.
    ///
    /// # Errors
    /// [`DrawingError`]: not a Bézier curve, or at a smooth point beside a shape that has no handle to turn.
    pub fn move_handle(&mut self, shape: ShapeId, end: usize, to: DVec2) -> Result<(), DrawingError> {
        let Shape::Bezier { ends, .. } = *self.shape(shape)? else {
            return Err(DrawingError::Kind { what: "moving a handle", wanted: "Bézier curves" });
        };
        let end = end.min(1);
        let at = self.place(ends[end])?;
        self.whole(|drawing| {
            if let Some(Shape::Bezier { handles, .. }) = drawing.shapes.get_mut(&shape) {
                handles[end] = to - at;
            }
            if drawing.is_smooth(ends[end])? {
                drawing.align(ends[end], Some((shape, end)))?;
            }
            Ok(())
        })
    }

    /// Bends a line or an arc so that it runs over a place.
    ///
    /// # Errors
    /// [`DrawingError`]: another shape, a place at its ends.
    pub fn bend(&mut self, shape: ShapeId, over: DVec2) -> Result<(), DrawingError> {
        let (Shape::Line(ends) | Shape::Arc { ends, .. }) = *self.shape(shape)? else {
            return Err(DrawingError::Kind { what: "bending", wanted: "lines and arcs" });
        };
        let [a, b] = ends;
        let (from, to) = (self.place(a)?, self.place(b)?);
        let on_line = (to - from).perp_dot(over - from).abs() <= 1e-9 * from.distance_squared(to);
        let shapes = if on_line {
            Shape::Line(ends)
        } else {
            Shape::Arc { ends, bulge: bulge_through(from, over, to)? }
        };
        self.whole(|drawing| {
            if matches!(shapes, Shape::Arc { .. }) {
                // Rules are of lines.
                drawing.rules.retain(|rule| !rule.shapes().contains(&shape));
            }
            drawing.shapes.insert(shape, shapes);
            drawing.align_all()
        })
    }

    /// Lets shapes meet in one direction at a point, or no longer.
    ///
    /// # Errors
    /// [`DrawingError`]: not two shapes there, or none with a handle that could be turned.
    pub fn set_smooth(&mut self, point: PointId, smooth: bool) -> Result<(), DrawingError> {
        self.place(point)?;
        self.whole(|drawing| {
            if let Some(kept) = drawing.points.get_mut(&point) {
                kept.smooth = smooth;
            }
            if smooth { drawing.align(point, None) } else { Ok(()) }
        })
    }

    pub(super) fn align_all(&mut self) -> Result<(), DrawingError> {
        let smooth: Vec<PointId> = self.points.iter().filter(|(_, p)| p.smooth).map(|(id, _)| *id).collect();
        smooth.into_iter().try_for_each(|point| self.align(point, None))
    }

    /// Turns handles at a point so that its two shapes meet in one direction; `leads`: the one whose handle stays.
    fn align(&mut self, point: PointId, leads: Option<(ShapeId, usize)>) -> Result<(), DrawingError> {
        let found = self.at_point(point);
        let [one, other] = found[..] else {
            return Err(DrawingError::NotACorner { what: "a smooth point", found: found.len() });
        };
        let out = |(id, end): (ShapeId, usize)| -> Result<DVec2, DrawingError> {
            let curve = self.curve(id)?;
            Ok(if end == 0 { curve.tangent(0.0) } else { -curve.tangent(1.0) })
        };
        let turns = |(id, _): (ShapeId, usize)| matches!(self.shapes.get(&id), Some(Shape::Bezier { .. }));
        let (a, b) = (out(one)?, out(other)?);
        // Directions in which the two leave afterwards: opposite.
        let direction = match (turns(one), turns(other)) {
            (true, true) if leads == Some(one) => a,
            (true, true) if leads == Some(other) => -b,
            (true, true) => (a - b).try_normalize().unwrap_or(a.perp()),
            (true, false) => -b,
            (false, true) => a,
            (false, false) => {
                return Err(DrawingError::Kind {
                    what: "a smooth point",
                    wanted: "corners with a Bézier curve",
                });
            }
        };
        for ((id, end), along) in [(one, direction), (other, -direction)] {
            if let Some(Shape::Bezier { handles, .. }) = self.shapes.get_mut(&id) {
                handles[end] = along * handles[end].length();
            }
        }
        Ok(())
    }

    /// Splits a shape at a parameter; both parts together are the shape. Returns the new point.
    ///
    /// # Errors
    /// [`DrawingError`]: a parameter that is not between 0 and 1, a circle, a spline between its points.
    pub fn split(&mut self, shape: ShapeId, t: f64) -> Result<PointId, DrawingError> {
        if !(t > 0.0 && t < 1.0) {
            return Err(
                SketchError::Number { what: "the place of a split", wanted: "between 0 and 1" }.into()
            );
        }
        let curve = self.curve(shape)?;
        let old = self.shape(shape)?.clone();
        self.whole(|drawing| {
            let [first, second, middle] = match (&old, &curve) {
                (Shape::Circle { .. }, _) => {
                    return Err(DrawingError::Kind { what: "splitting", wanted: "shapes with two ends" });
                }
                (Shape::Spline(through), Curve::Spline { at, .. }) => {
                    // At a point that it has it falls apart in two splines; elsewhere it first gets a point.
                    let nearest = (1..at.len() - 1).find(|&i| (at[i] - t).abs() < 1e-9);
                    let Some(k) = nearest else {
                        let middle = drawing.add_point(curve.point(t))?;
                        let mut through = through.clone();
                        through.insert(at.partition_point(|x| *x <= t), middle);
                        drawing.shapes.insert(shape, Shape::Spline(through));
                        return Ok(middle);
                    };
                    let (head, tail) = (through[..=k].to_vec(), through[k..].to_vec());
                    return drawing.replace(shape, Shape::Spline(head), Shape::Spline(tail), through[k]);
                }
                (Shape::Line([a, b]), _) => {
                    let m = drawing.add_point(curve.point(t))?;
                    return drawing.replace(shape, Shape::Line([*a, m]), Shape::Line([m, *b]), m);
                }
                (Shape::Arc { ends: [a, b], bulge }, _) => {
                    let m = drawing.add_point(curve.point(t))?;
                    let sweep = 4.0 * bulge.atan();
                    let part = |share: f64| (share * sweep / 4.0).tan();
                    let first = Shape::Arc { ends: [*a, m], bulge: part(t) };
                    let second = Shape::Arc { ends: [m, *b], bulge: part(1.0 - t) };
                    return drawing.replace(shape, first, second, m);
                }
                (Shape::Bezier { .. }, Curve::Bezier { points: [p, q, r, s] }) => {
                    let (pq, qr, rs) = (p.lerp(*q, t), q.lerp(*r, t), r.lerp(*s, t));
                    let (pqr, qrs) = (pq.lerp(qr, t), qr.lerp(rs, t));
                    let middle = pqr.lerp(qrs, t);
                    [[pq - *p, pqr - middle], [qrs - middle, rs - *s], [middle, middle]]
                }
                _ => return Err(DrawingError::NoShape(shape)),
            };
            let Some([a, b]) = old.ends() else { return Err(DrawingError::NoShape(shape)) };
            let m = drawing.add_point(middle[0])?;
            let halves = [([a, m], first), ([m, b], second)];
            let [first, second] = halves.map(|(ends, handles)| Shape::Bezier { ends, handles });
            let m = drawing.replace(shape, first, second, m)?;
            if let Some(point) = drawing.points.get_mut(&m) {
                point.smooth = true;
            }
            Ok(m)
        })
    }

    /// Puts two shapes in the place of one; rules of the old one go.
    fn replace(
        &mut self,
        shape: ShapeId,
        first: Shape,
        second: Shape,
        middle: PointId,
    ) -> Result<PointId, DrawingError> {
        self.shapes.insert(shape, first);
        let id = ShapeId(self.number());
        self.shapes.insert(id, second);
        self.rules.retain(|rule| !rule.shapes().contains(&shape));
        Ok(middle)
    }

    /// Makes two points one, at the place of the first.
    ///
    /// # Errors
    /// [`DrawingError`]: unknown points, a shape that would lose its length, rules that cannot hold then.
    pub fn merge(&mut self, keep: PointId, gone: PointId) -> Result<(), DrawingError> {
        self.place(keep)?;
        self.place(gone)?;
        if keep == gone {
            return Ok(());
        }
        self.whole(|drawing| {
            for shape in drawing.shapes.values_mut() {
                shape.points_mut().iter_mut().filter(|p| **p == gone).for_each(|p| *p = keep);
            }
            drawing.rules.iter_mut().for_each(|rule| rule.rename(gone, keep));
            drawing.points.remove(&gone);
            drawing.obey(Some(keep))?;
            drawing.align_all()
        })
    }

    /// Deletes a shape, its rules, and its points as far as no other shape has them.
    ///
    /// # Errors
    /// [`DrawingError::NoShape`].
    pub fn delete_shape(&mut self, shape: ShapeId) -> Result<(), DrawingError> {
        let gone = self.shapes.remove(&shape).ok_or(DrawingError::NoShape(shape))?;
        self.rules.retain(|rule| !rule.shapes().contains(&shape));
        for point in gone.points() {
            let used = self.shapes.values().any(|s| s.points().contains(point));
            if !used {
                self.points.remove(point);
                self.rules.retain(|rule| !rule.points().contains(point));
            } else if let Some(kept) = self.points.get_mut(point) {
                kept.smooth = false;
            }
        }
        Ok(())
    }

    /// Deletes a point with the shapes that need it. A spline only loses the point, as long as it has three.
    ///
    /// # Errors
    /// [`DrawingError::NoPoint`].
    pub fn delete_point(&mut self, point: PointId) -> Result<(), DrawingError> {
        self.place(point)?;
        let needing: Vec<ShapeId> =
            self.shapes().filter(|(_, s)| s.points().contains(&point)).map(|(id, _)| id).collect();
        for id in needing {
            match self.shapes.get_mut(&id) {
                Some(Shape::Spline(through)) if through.len() > 2 => through.retain(|p| *p != point),
                _ => self.delete_shape(id)?,
            }
        }
        self.points.remove(&point);
        self.rules.retain(|rule| !rule.points().contains(&point));
        Ok(())
    }
}

/// The bulge of the arc from one place over another to a third.
fn bulge_through(a: DVec2, over: DVec2, b: DVec2) -> Result<f64, SketchError> {
    match Curve::arc_through(a, over, b)? {
        Curve::Arc { sweep, .. } => Ok((sweep / 4.0).tan()),
        _ => Err(SketchError::NoArc),
    }
}
