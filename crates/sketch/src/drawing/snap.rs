//! Snapping: what the pointer means.

use glam::DVec2;

use super::{Drawing, PointId, Shape, ShapeId, crossings};
use crate::Curve;

/// What the pointer may snap to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnapOptions {
    /// How near the pointer has to be, mm: some pixels in the scale of the view.
    pub radius: f64,
    /// Spacing of the grid, mm; `None`: no grid.
    pub grid: Option<f64>,
    /// Where what is being drawn begins: for feet, tangents and level or plumb lines from there.
    pub from: Option<DVec2>,
    /// A point that is being moved, which does not snap to itself or its shapes.
    pub moving: Option<PointId>,
}

/// What was snapped to. In this order one wins over the next, however near.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub enum SnapKind {
    /// A point.
    Point(PointId),
    /// A crossing of two shapes.
    Crossing(ShapeId, ShapeId),
    /// The middle of a shape.
    Middle(ShapeId),
    /// The centre of an arc or a circle.
    Center(ShapeId),
    /// The line from the beginning meets the shape square.
    Foot(ShapeId),
    /// The line from the beginning touches the shape.
    Touch(ShapeId),
    /// A place on a shape, level with the beginning.
    LevelOn(ShapeId),
    /// A place on a shape, plumb under or over the beginning.
    PlumbOn(ShapeId),
    /// A place on a shape.
    On(ShapeId),
    /// Level with the beginning.
    Level,
    /// Plumb under or over the beginning.
    Plumb,
    /// A place of the grid.
    Grid,
}

impl SnapKind {
    fn rank(self) -> u8 {
        match self {
            Self::Point(_) => 0,
            Self::Crossing(..) => 1,
            Self::Middle(_) => 2,
            Self::Center(_) => 3,
            Self::Foot(_) | Self::Touch(_) => 4,
            Self::LevelOn(_) | Self::PlumbOn(_) => 5,
            Self::On(_) => 6,
            Self::Level | Self::Plumb => 7,
            Self::Grid => 8,
        }
    }
}

/// Where the pointer snaps to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snap {
    /// The place.
    pub at: DVec2,
    /// What it is.
    pub kind: SnapKind,
}

impl Drawing {
    /// What the pointer means at a place; `None` where nothing is near. O(shapes near it, squared).
    pub fn snap(&self, pointer: DVec2, options: &SnapOptions) -> Option<Snap> {
        let mut found: Vec<Snap> = Vec::new();
        let mut offer = |at: DVec2, kind: SnapKind| {
            if at.distance(pointer) <= options.radius {
                found.push(Snap { at, kind });
            }
        };
        for (id, at) in self.points().filter(|(id, _)| options.moving != Some(*id)) {
            offer(at, SnapKind::Point(id));
        }
        let others: Vec<(ShapeId, &Shape, Curve)> = self
            .shapes()
            .filter(|(_, shape)| options.moving.is_none_or(|p| !shape.points().contains(&p)))
            .filter_map(|(id, shape)| Some((id, shape, self.curve(id).ok()?)))
            .collect();
        for (id, shape, curve) in &others {
            match curve {
                Curve::Arc { center, .. } => offer(*center, SnapKind::Center(*id)),
                _ => offer(curve.point(0.5), SnapKind::Middle(*id)),
            }
            if matches!(shape, Shape::Arc { .. }) {
                offer(curve.point(0.5), SnapKind::Middle(*id));
            }
        }
        let near: Vec<&(ShapeId, &Shape, Curve)> =
            others.iter().filter(|(.., curve)| curve.nearest(pointer).distance <= options.radius).collect();
        for (k, (one, _, curve)) in near.iter().enumerate() {
            offer(curve.nearest(pointer).at, SnapKind::On(*one));
            for (other, _, second) in &near[k + 1..] {
                for crossing in crossings(curve, second) {
                    offer(crossing.at, SnapKind::Crossing(*one, *other));
                }
            }
            if let Some(from) = options.from {
                for (t, square) in square_and_touching(curve, from) {
                    offer(curve.point(t), if square { SnapKind::Foot(*one) } else { SnapKind::Touch(*one) });
                }
                for (direction, kind) in
                    [(DVec2::X, SnapKind::LevelOn(*one)), (DVec2::Y, SnapKind::PlumbOn(*one))]
                {
                    let reach = direction * (pointer.distance(from) + options.radius);
                    if let Ok(line) = Curve::line(from - reach, from + reach) {
                        crossings(curve, &line).iter().for_each(|c| offer(c.at, kind));
                    }
                }
            }
        }
        if let Some(from) = options.from {
            offer(DVec2::new(pointer.x, from.y), SnapKind::Level);
            offer(DVec2::new(from.x, pointer.y), SnapKind::Plumb);
        }
        if let Some(grid) = options.grid.filter(|g| g.is_finite() && *g > 0.0) {
            offer((pointer / grid).round() * grid, SnapKind::Grid);
        }
        let order = |a: &Snap, b: &Snap| {
            let distance = |s: &Snap| s.at.distance(pointer);
            a.kind.rank().cmp(&b.kind.rank()).then(distance(a).total_cmp(&distance(b)))
        };
        found.into_iter().min_by(order)
    }
}

/// Parameters at which a line from a place meets a curve square (`true`) or touches it.
fn square_and_touching(curve: &Curve, from: DVec2) -> Vec<(f64, bool)> {
    const SAMPLES: u32 = 64;
    let mut out = Vec::new();
    for square in [true, false] {
        let value = |t: f64| {
            let (to, along) = (curve.point(t) - from, curve.tangent(t));
            if square { to.dot(along) } else { to.perp_dot(along) }
        };
        for k in 0..SAMPLES {
            let (mut a, mut b) = (f64::from(k) / f64::from(SAMPLES), f64::from(k + 1) / f64::from(SAMPLES));
            if value(a) * value(b) >= 0.0 {
                continue;
            }
            let rises = value(a) < 0.0;
            for _ in 0..60 {
                let middle = (a + b) / 2.0;
                *(if (value(middle) < 0.0) == rises { &mut a } else { &mut b }) = middle;
            }
            let t = (a + b) / 2.0;
            // A place on the curve itself is neither.
            if curve.point(t).distance(from) > 1e-9 {
                out.push((t, square));
            }
        }
    }
    out
}
