//! How large the triangles of plane pieces may be.

use glam::DVec3;

/// How long triangles are at most, over their width, where only the latter matters.
const LONG: f64 = 8.0;
/// Directions are one if the cosine of the angle between them is no less than this by more.
const SAME: f64 = 1e-4;

/// How large triangles may be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cells {
    /// The longest edge, in mm.
    pub(super) length: f64,
    /// If this matters in one direction only, as the thickness of a wall with draft does.
    pub(super) strips: Option<Strips>,
}

/// Triangles that may be longer in one direction than in the other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strips {
    /// Across them, of unit length: in this direction edges are as long as the cells say.
    pub(super) across: DVec3,
    /// Along them edges may be so many times as long.
    pub(super) long: f64,
}

impl Cells {
    /// As large in all directions.
    pub(super) fn even(length: f64) -> Self {
        Self { length, strips: None }
    }

    /// In strips, so large in the direction across them.
    pub(super) fn in_strips(length: f64, across: DVec3) -> Self {
        let strips = across.try_normalize().map(|across| Strips { across, long: LONG });
        Self { length, strips }
    }

    /// Small enough for both.
    pub(super) fn both(a: Self, b: Self) -> Self {
        let [a, b] = if a.length <= b.length { [a, b] } else { [b, a] };
        // The wider ones limit how long the narrower ones are.
        let longest = |long: f64| long.min(b.length / a.length);
        let strips = match (a.strips, b.strips) {
            (Some(s), Some(t)) if s.across.dot(t.across).abs() > 1.0 - SAME => {
                Some(Strips { long: s.long.min(t.long * b.length / a.length), ..s })
            }
            (Some(s), None) => Some(Strips { long: longest(s.long), ..s }),
            _ => None,
        };
        Self { length: a.length, strips }
    }

    /// How long an edge in a direction may be.
    pub(super) fn length_in(&self, direction: DVec3) -> f64 {
        let Some(Strips { across, long }) = self.strips else { return self.length };
        let (far, near) = (across.dot(direction), direction.reject_from_normalized(across).length());
        self.length * direction.length() / far.hypot(near / long).max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is asked for limits how long strips are, and does not make them as long as wide.
    #[test]
    fn an_edge_length_leaves_strips() {
        let strips = Cells::in_strips(0.5, DVec3::Z);
        for (asked, [across, along]) in [(10.0, [0.5, 4.0]), (2.0, [0.5, 2.0]), (0.25, [0.25, 0.25])] {
            let both = [Cells::both(strips, Cells::even(asked)), Cells::both(Cells::even(asked), strips)];
            for cells in both {
                let lengths = [DVec3::Z, DVec3::X].map(|direction| cells.length_in(direction));
                assert_eq!(lengths, [across, along], "{asked} mm");
            }
        }
    }
}
