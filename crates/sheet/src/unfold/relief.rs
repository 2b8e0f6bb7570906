//! Reliefs: what is cut away at the ends of bends so that the metal beside them does not tear.

use glam::DVec2;
use serde::Serialize;

/// Shape of reliefs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ReliefShape {
    /// None.
    None,
    /// Square corners.
    #[default]
    Rectangle,
    /// A round bottom.
    Round,
}

/// Reliefs. Lengths in millimetres; without a thickness none are cut.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Relief {
    /// Shape.
    pub shape: ReliefShape,
    /// Width along the bend; `None`: the thickness.
    pub width: Option<f64>,
    /// How much deeper than the bend; `None`: half the thickness.
    pub depth: Option<f64>,
}

/// A relief with all its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cut {
    pub(crate) shape: ReliefShape,
    pub(crate) width: f64,
    pub(crate) depth: f64,
}

impl Relief {
    pub(crate) fn cut(&self, thickness: f64) -> Option<Cut> {
        let width = self.width.unwrap_or(thickness);
        let depth = self.depth.unwrap_or(thickness / 2.0);
        (self.shape != ReliefShape::None && thickness > 0.0 && width > 0.0).then_some(Cut {
            shape: self.shape,
            width,
            depth: depth.max(0.0),
        })
    }
}

/// Chords of a half circle.
const ARC: u32 = 12;

impl Cut {
    /// Beside a bend that ends at `corner` of a facet whose edge goes on: from the edge to where the bend begins. `back` points
    /// along the bend away from it, `inward` into the facet.
    ///
    /// ```text
    ///   edge ───┐  ┌── bend ──   goes from the edge down, over and up to the bend
    ///           └──┘
    /// ```
    pub(crate) fn beside(
        &self,
        corner: DVec2,
        back: DVec2,
        inward: DVec2,
        setback: f64,
        room: f64,
    ) -> Vec<DVec2> {
        let width = self.width.min(0.9 * room);
        let depth = setback + self.depth;
        let [outer, inner] = [back * width, DVec2::ZERO].map(|x| corner + x);
        if self.shape == ReliefShape::Round && depth > width / 2.0 {
            let straight = inward * (depth - width / 2.0);
            let middle = corner + back * (width / 2.0) + straight;
            let mut points = vec![outer];
            points.extend((0..=ARC).map(|k| {
                let angle = std::f64::consts::PI * f64::from(k) / f64::from(ARC);
                middle + (back * angle.cos() + inward * angle.sin()) * (width / 2.0)
            }));
            return points;
        }
        vec![outer, outer + inward * depth, inner + inward * depth]
    }

    /// At a corner of a facet where two bends end: from the end of the first to the beginning of the second. `before` and
    /// `after` are the directions in which the facet's sides are walked.
    pub(crate) fn corner(&self, at: DVec2, before: DVec2, after: DVec2, room: f64) -> Vec<DVec2> {
        let size = self.width.min(0.45 * room);
        if self.shape == ReliefShape::Round {
            // About the corner, from one side over the inside to the other.
            let turn = (-before).perp_dot(after).atan2((-before).dot(after));
            return (0..=ARC)
                .map(|k| {
                    let angle = turn * f64::from(k) / f64::from(ARC);
                    at + DVec2::from_angle(angle).rotate(-before) * size
                })
                .collect();
        }
        vec![at - before * size, at - before * size + after * size, at + after * size]
    }
}
