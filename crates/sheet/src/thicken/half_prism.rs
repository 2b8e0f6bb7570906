//! Half-prisms: the material between a face and its offset, and whether it is turned inside out.

use glam::DVec3;

/// A face and the offset points of its corners, in the order of its face-use.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfPrism {
    /// Corners of the face.
    pub(super) base: [DVec3; 3],
    /// Offset points, seen from their corners.
    pub(super) offset: [DVec3; 3],
}

/// A prism whose volume element is anywhere less than this share of that at its base counts as turned over.
const LEAST_ELEMENT: f64 = 1e-6;
/// Halvings of the interval in which a height is looked for.
const HALVINGS: usize = 16;
/// Least height of the top over a concave fold, as a share of the base's: thinner ones are left to the union.
const LEAST_HEIGHT: f64 = 0.25;

impl HalfPrism {
    /// Whether the volume element is positive in all of the prism.
    ///
    /// At height `z` in 0..1 the area vector is quadratic in `z` and the offset linear over the face, so that the element
    /// is positive when its Bernstein coefficients over `z` are, at all three corners. O(1).
    pub(super) fn is_positive(&self) -> bool {
        self.keeps_element(LEAST_ELEMENT)
    }

    /// How much of the offsets can be gone, at most all of them, until the volume element falls below `share` of that at
    /// the base.
    pub(super) fn height_of_element(&self, share: f64) -> f64 {
        if self.keeps_element(share) {
            return 1.0;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let part = Self { base: self.base, offset: self.offset.map(|o| middle * o) };
            *(if part.keeps_element(share) { &mut low } else { &mut high }) = middle;
        }
        low
    }

    fn keeps_element(&self, share: f64) -> bool {
        let [p, q, r] = self.base;
        let [x, y, z] = self.offset;
        let (side, other) = (q - p, r - p);
        let (side_change, other_change) = (y - x, z - x);
        let bottom = side.cross(other);
        let mixed = bottom + 0.5 * (side.cross(other_change) + side_change.cross(other));
        let top = (side + side_change).cross(other + other_change);
        self.offset.iter().all(|o| {
            let least = share * bottom.length() * o.length();
            [bottom, mixed, top].iter().all(|area| area.dot(*o) > least)
        })
    }

    /// Whether the top keeps a fair share of the base's height over its longest side.
    pub(super) fn keeps_shape(&self) -> bool {
        let height = |[p, q, r]: [DVec3; 3]| {
            let longest =
                (q - p).length_squared().max((r - q).length_squared()).max((p - r).length_squared());
            (q - p).cross(r - p).length() / longest.sqrt()
        };
        let top = std::array::from_fn(|i| self.base[i] + self.offset[i]);
        height(top) >= LEAST_HEIGHT * height(self.base)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BASE: [DVec3; 3] = [DVec3::ZERO, DVec3::X, DVec3::Y];

    #[test]
    fn right_prisms_are_positive_and_folded_ones_are_not() {
        let prism = |offset| HalfPrism { base: BASE, offset };
        assert!(prism([DVec3::Z; 3]).is_positive());
        assert!(!prism([DVec3::NEG_Z; 3]).is_positive());
        // Walls that lean over the opposite corner turn the top over.
        let past = prism([DVec3::new(0.8, 0.8, 1.0), DVec3::Z, DVec3::Z]);
        assert!(!past.is_positive());
        let near = prism([DVec3::new(0.4, 0.4, 1.0), DVec3::Z, DVec3::Z]);
        assert!(near.is_positive() && !near.keeps_shape());
        // Walls that meet in a line at half the height.
        let meet = prism([DVec3::new(2.0, 0.0, 1.0), DVec3::Z, DVec3::new(2.0, 0.0, 1.0)]);
        assert!((meet.height_of_element(0.0) - 0.5).abs() < 1e-4);
        let wanted = 0.5 * (1.0 - 0.1 * 5f64.sqrt());
        assert!((meet.height_of_element(0.1) - wanted).abs() < 1e-4);
        // Twisted by more than a quarter turn: base and top look the right way, the middle does not.
        let turn = |v: DVec3, c: DVec3| c + DVec3::new(-(v - c).x, -(v - c).y, 1.0) - v;
        let centre = DVec3::new(1.0, 1.0, 0.0) / 3.0;
        assert!(!prism(BASE.map(|v| turn(v, centre))).is_positive());
    }
}
