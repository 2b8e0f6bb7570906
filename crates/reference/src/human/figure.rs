//! The upright body as a stack of level outlines: what everything else measures on.

use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DVec2, DVec3};
use mesh_kernel::query::SectionStack;
use rayon::prelude::*;

use super::ring::{Gaps, Ring, depth_at, hull, outer_rings};

/// Level spacing as a part of the height (4 mm for an adult).
const LEVELS: usize = 420;
/// Chains shorter than this are crumbs of a scan, millimetres.
const DUST: f64 = 25.0;

/// Left or right of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Left,
    Right,
}

impl Side {
    pub(crate) const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// +1 on the left, where x is positive.
    pub(crate) fn sign(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }

    pub(crate) fn name(self, what: &str) -> String {
        match self {
            Self::Left => format!("left_{what}"),
            Self::Right => format!("right_{what}"),
        }
    }

    pub(crate) fn index(self) -> usize {
        match self {
            Self::Left => 0,
            Self::Right => 1,
        }
    }
}

/// All outer outlines at one height, largest first.
#[derive(Clone, Debug)]
pub(crate) struct Level {
    pub(crate) y: f64,
    pub(crate) rings: Vec<Ring>,
}

impl Level {
    /// The outline that crosses the plane of symmetry: trunk, neck or head. `None` between the legs.
    pub(crate) fn trunk(&self) -> Option<&Ring> {
        self.rings.iter().find(|r| r.lo.x < -8.0 && r.hi.x > 8.0)
    }

    /// The largest outline on one side that does not cross the plane of symmetry: a leg, below the crotch.
    pub(crate) fn leg(&self, side: Side) -> Option<&Ring> {
        let s = side.sign();
        self.rings.iter().find(|r| r.centroid.x * s > 0.0 && !(r.lo.x < -8.0 && r.hi.x > 8.0))
    }

    /// The taut outline around the trunk, or around both legs.
    pub(crate) fn envelope(&self) -> Option<Vec<DVec2>> {
        if let Some(t) = self.trunk() {
            return Some(t.hull());
        }
        let mut points = self.leg(Side::Left)?.points.clone();
        points.extend_from_slice(&self.leg(Side::Right)?.points);
        Some(hull(&points))
    }
}

/// A mesh in the canonical frame with its level outlines.
pub(crate) struct Figure<'a> {
    pub(crate) mesh: &'a TriMesh,
    stack: SectionStack,
    pub(crate) height: f64,
    pub(crate) step: f64,
    pub(crate) levels: Vec<Level>,
}

impl<'a> Figure<'a> {
    /// Cuts the mesh (millimetres, y up, floor at 0).
    pub(crate) fn new(mesh: &'a TriMesh, height: f64) -> Self {
        let stack = SectionStack::new(mesh, DVec3::Y);
        let step = height / LEVELS as f64;
        let levels = (0..LEVELS)
            .into_par_iter()
            .map(|i| cut(&stack, (i as f64 + 0.5) * step, Gaps::Join))
            .collect::<Vec<_>>();
        Self { mesh, stack, height, step, levels }
    }

    /// The same figure after a half turn about the vertical, without cutting again. `mesh` is the turned mesh.
    pub(crate) fn half_turned<'b>(mut self, mesh: &'b TriMesh) -> Figure<'b> {
        for r in self.levels.iter_mut().flat_map(|l| &mut l.rings) {
            r.half_turn();
        }
        Figure {
            mesh,
            stack: SectionStack::new(mesh, DVec3::Y),
            height: self.height,
            step: self.step,
            levels: self.levels,
        }
    }

    /// Outlines at any height.
    pub(crate) fn at(&self, y: f64) -> Level {
        cut(&self.stack, y, Gaps::Join)
    }

    /// Outlines at any height where a hole of the skin counts as a gap between limbs.
    pub(crate) fn parted_at(&self, y: f64) -> Level {
        cut(&self.stack, y, Gaps::Part)
    }

    /// Index of the level nearest to a height.
    pub(crate) fn index(&self, y: f64) -> usize {
        ((y / self.step) as usize).min(self.levels.len() - 1)
    }

    /// Levels between two heights.
    pub(crate) fn between(&self, low: f64, high: f64) -> &[Level] {
        let (a, b) = (self.index(low), self.index(high));
        &self.levels[a..b.max(a) + 1]
    }

    /// Back and front of the trunk on the plane of symmetry.
    pub(crate) fn midline(&self, y: f64) -> Option<[f64; 2]> {
        depth_at(&self.at(y).trunk()?.points, 0.0)
    }
}

fn cut(stack: &SectionStack, y: f64, gaps: Gaps) -> Level {
    let mut rings = outer_rings(&stack.cut(y), DUST, gaps, |p| DVec2::new(p.x, p.z));
    rings.retain(|r| r.area > 100.0);
    Level { y, rings }
}

/// Gaussian smoothing of evenly spaced values; the ends keep their value and slope by reflection through them.
pub(crate) fn smooth(values: &[f64], sigma: f64) -> Vec<f64> {
    let n = values.len();
    let reach = (3.0 * sigma).ceil() as i64;
    if n < 3 || reach < 1 || sigma < 0.2 {
        return values.to_vec();
    }
    let weights: Vec<f64> = (-reach..=reach).map(|k| (-0.5 * (k as f64 / sigma).powi(2)).exp()).collect();
    let total: f64 = weights.iter().sum();
    let value = |i: i64| {
        let last = n as i64 - 1;
        if i < 0 {
            2.0 * values[0] - values[(-i).min(last) as usize]
        } else if i > last {
            2.0 * values[n - 1] - values[(2 * last - i).max(0) as usize]
        } else {
            values[i as usize]
        }
    };
    (0..n as i64)
        .map(|i| (-reach..=reach).zip(&weights).map(|(k, w)| w * value(i + k)).sum::<f64>() / total)
        .collect()
}

/// Piecewise cubic through `(at, value)` knots that never overshoots (Fritsch and Carlson 1980), extended by its end
/// values.
pub(crate) fn monotone_cubic(knots: &[(f64, f64)], at: f64) -> f64 {
    let n = knots.len();
    if n == 0 {
        return 0.0;
    }
    if at <= knots[0].0 {
        return knots[0].1;
    }
    if at >= knots[n - 1].0 {
        return knots[n - 1].1;
    }
    let slope = |i: usize| (knots[i + 1].1 - knots[i].1) / (knots[i + 1].0 - knots[i].0);
    let tangent = |i: usize| {
        if i == 0 {
            return slope(0);
        }
        if i == n - 1 {
            return slope(n - 2);
        }
        let (a, b) = (slope(i - 1), slope(i));
        if a * b <= 0.0 {
            return 0.0;
        }
        let (h0, h1) = (knots[i].0 - knots[i - 1].0, knots[i + 1].0 - knots[i].0);
        3.0 * (h0 + h1) / ((2.0 * h1 + h0) / a + (h1 + 2.0 * h0) / b)
    };
    let i = knots.partition_point(|k| k.0 <= at) - 1;
    let h = knots[i + 1].0 - knots[i].0;
    let t = (at - knots[i].0) / h;
    let (t2, t3) = (t * t, t * t * t);
    knots[i].1 * (2.0 * t3 - 3.0 * t2 + 1.0)
        + tangent(i) * h * (t3 - 2.0 * t2 + t)
        + knots[i + 1].1 * (3.0 * t2 - 2.0 * t3)
        + tangent(i + 1) * h * (t3 - t2)
}

/// 0 below `from`, 1 above `to`, smooth between.
pub(crate) fn ramp(from: f64, to: f64, at: f64) -> f64 {
    let t = ((at - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
