//! What tools of the drawing board see: parts of the drawing, places, what is under the pointer.

use glam::DVec2;
use sketch::{Curve, Drawing, PointId, Shape, ShapeId, Snap, SnapKind};

use crate::region::Region;

/// A part of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Part {
    Point(PointId),
    Shape(ShapeId),
    /// An inner control point of a Bézier curve: that of its beginning (0) or its end (1).
    Handle(ShapeId, usize),
}

impl Part {
    pub(crate) fn is_in(self, drawing: &Drawing) -> bool {
        match self {
            Self::Point(point) => drawing.place(point).is_ok(),
            Self::Shape(shape) => drawing.shape(shape).is_ok(),
            Self::Handle(shape, _) => matches!(drawing.shape(shape), Ok(Shape::Bezier { .. })),
        }
    }

    /// What people call it: also the name under which it is found by screen readers.
    pub(crate) fn label(self, drawing: &Drawing) -> String {
        match self {
            Self::Point(point) => format!("point {}", point.number()),
            Self::Handle(shape, end) => format!("handle {} of curve {}", end + 1, shape.number()),
            Self::Shape(shape) => {
                let kind = match drawing.shape(shape) {
                    Ok(Shape::Line(_)) | Err(_) => "line",
                    Ok(Shape::Arc { .. }) => "arc",
                    Ok(Shape::Circle { .. }) => "circle",
                    Ok(Shape::Bezier { .. }) => "curve",
                    Ok(Shape::Spline(_)) => "spline",
                };
                format!("{kind} {}", shape.number())
            }
        }
    }
}

/// A place that the pointer means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    /// Where the pointer is, mm.
    pub(crate) pointer: DVec2,
    pub(crate) snap: Option<Snap>,
}

impl Place {
    pub(crate) fn at(&self) -> DVec2 {
        self.snap.map_or(self.pointer, |s| s.at)
    }

    /// The point that it snaps to.
    pub(crate) fn point(&self) -> Option<PointId> {
        match self.snap?.kind {
            SnapKind::Point(point) => Some(point),
            _ => None,
        }
    }
}

/// What tools may look at.
#[derive(Clone, Copy)]
pub(crate) struct World<'a> {
    pub(crate) drawing: &'a Drawing,
    pub(crate) selection: &'a [Part],
    /// How far the pointer reaches, mm.
    pub(crate) reach: f64,
    /// The grid that places snap to, mm.
    pub(crate) grid: Option<f64>,
    /// Corners are rounded by this, mm.
    pub(crate) radius: f64,
}

impl World<'_> {
    /// Points before handles before shapes: what is smaller is meant.
    pub(crate) fn pick(&self, at: DVec2) -> Option<Part> {
        let near = |p: DVec2| Some(p.distance(at)).filter(|d| *d <= self.reach);
        let least =
            |found: Vec<(f64, Part)>| found.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).map(|f| f.1);
        let points = self.drawing.points().filter_map(|(id, p)| Some((near(p)?, Part::Point(id)))).collect();
        let handles = self.handles().filter_map(|(part, p)| Some((near(p)?, part))).collect();
        least(points).or_else(|| least(handles)).or_else(|| self.shape(at).map(Part::Shape))
    }

    /// The shape under the pointer.
    pub(crate) fn shape(&self, at: DVec2) -> Option<ShapeId> {
        let distance = |id| Some(self.drawing.curve(id).ok()?.nearest(at).distance);
        let near = self.drawing.shapes().filter_map(|(id, _)| Some((distance(id)?, id)));
        near.filter(|(d, _)| *d <= self.reach).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, id)| id)
    }

    /// Handles that can be taken: of curves that are selected, or that end at a selected point.
    pub(crate) fn handles(&self) -> impl Iterator<Item = (Part, DVec2)> + '_ {
        let is_shown = |id: ShapeId, ends: &[PointId; 2]| {
            let parts = [Part::Shape(id), Part::Handle(id, 0), Part::Handle(id, 1)];
            parts.iter().chain(&ends.map(Part::Point)).any(|p| self.selection.contains(p))
        };
        self.drawing.shapes().flat_map(move |(id, shape)| match shape {
            Shape::Bezier { ends, handles } if is_shown(id, ends) => (0..2)
                .filter_map(|k| Some((Part::Handle(id, k), self.drawing.place(ends[k]).ok()? + handles[k])))
                .collect(),
            _ => Vec::new(),
        })
    }

    /// Everything that lies whole within a part of the plane.
    pub(crate) fn within(&self, region: &Region) -> Vec<Part> {
        let inside = |p: DVec2| region.holds(p);
        let curve = |id| self.drawing.curve(id).ok();
        let whole = |c: Curve| c.parameters(self.reach).into_iter().all(|t| inside(c.point(t)));
        let points = self.drawing.points().filter(|(_, p)| inside(*p)).map(|(id, _)| Part::Point(id));
        let shapes = self.drawing.shapes().filter(|(id, _)| curve(*id).is_some_and(whole));
        points.chain(shapes.map(|(id, _)| Part::Shape(id))).collect()
    }
}
