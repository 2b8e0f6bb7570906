//! The grid on which everything is merged: whole numbers held in doubles.
//!
//! On a grid a node is at its place or it is not: what two formulae put at the same place is one node, differences of
//! coordinates have no rounding, and determinants fit in 128 bits. The grid's cell is a power of two and its origin a
//! multiple of the cell, so that every node is a double in the model's own coordinates too: nothing moves, and so nothing
//! can come to cross, when the result is handed out.

use glam::DVec3;

/// Most bits of the grid: determinants of three differences then fit in 128 bits.
pub const MAX_GRID_BITS: u32 = 40;

/// Bits of a coordinate that a double holds, less one so that a place on the grid and the origin add up.
const DOUBLE_BITS: i32 = 52;

/// From model coordinates to whole numbers and back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    cell: f64,
    origin: DVec3,
    /// How near things coincide, in cells.
    pub(super) near: f64,
    /// Farthest that this is ever stretched to, in cells.
    pub(super) farthest_near: f64,
    /// How thin a region is that rounding made, in cells.
    pub(super) film: f64,
}

/// How near things coincide, in cells of the finest grid: 6·10⁻¹¹ of the size. What rounding the corners of two walls in
/// one plane leaves between them is a few cells; the rest keeps what is told apart well above what rounding does.
const NEAR: f64 = 64.0;
/// The same on a coarse grid, whose cells are larger than what any formula leaves.
const NEAR_ON_COARSE: f64 = 4.0;
/// A region thinner than this many times the distance at which things coincide is a film.
const FILM: f64 = 16.0;
/// The same on a coarse grid, where walls of few cells are walls: what coincides there is apart by no more than two of that
/// distance.
const FILM_ON_COARSE: f64 = 2.0;
/// Cells that it is stretched to on a coarse grid at most.
const FARTHEST_ON_COARSE: f64 = 256.0;

impl Grid {
    /// A grid of 2^`bits` cells over half the size of a box, cells never finer than doubles are there.
    pub(super) fn over(lo: DVec3, hi: DVec3, bits: u32) -> Self {
        let middle = lo + (hi - lo) / 2.0;
        let half = ((hi - lo) / 2.0).max_element();
        let farthest = lo.abs().max(hi.abs()).max_element();
        let cell = power_above(half, bits as i32).max(power_above(farthest, DOUBLE_BITS));
        let near = (NEAR * (f64::from(bits) - f64::from(MAX_GRID_BITS)).exp2()).max(NEAR_ON_COARSE);
        Self {
            cell,
            origin: (middle / cell).round() * cell,
            near,
            farthest_near: farthest_near(bits),
            film: FILM * near,
        }
    }

    /// A grid about the origin whose every node is a number of `bits` binary digits.
    pub(super) fn about_zero(farthest: f64, bits: u32) -> Self {
        let cell = power_above(farthest, bits as i32);
        let near = NEAR_ON_COARSE;
        let film = FILM_ON_COARSE * near;
        Self { cell, origin: DVec3::ZERO, near, farthest_near: farthest_near(bits), film }
    }

    /// How thin a region is that rounding made, in the models' unit.
    pub(super) fn thinnest(&self) -> f64 {
        self.film * self.cell
    }

    /// The nearest node of the grid.
    #[inline]
    pub(super) fn snap(&self, p: DVec3) -> DVec3 {
        ((p - self.origin) / self.cell).round() + 0.0
    }

    /// The model's place of a node of the grid. Exact.
    #[inline]
    pub(super) fn place(&self, p: DVec3) -> DVec3 {
        self.origin + p * self.cell
    }
}

/// A millionth of the size, or some cells of a coarse grid.
fn farthest_near(bits: u32) -> f64 {
    (f64::from(bits) - 20.0).exp2().max(FARTHEST_ON_COARSE)
}

/// The least power of two not below `length` · 2^−`bits`; of a vanishing length the least normal number.
fn power_above(length: f64, bits: i32) -> f64 {
    let exponent = (length.log2().ceil() - f64::from(bits)).max(-1021.0);
    if exponent.is_finite() { exponent.exp2() } else { f64::MIN_POSITIVE }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_exact_near_and_far() {
        for far in [0.0, 1.0, 1e3, -1e6, 1e9] {
            let lo = DVec3::splat(far) + DVec3::new(0.1, -3.7, 0.0);
            let hi = lo + DVec3::new(100.0, 60.0, 1.0);
            let grid = Grid::over(lo, hi, MAX_GRID_BITS);
            let limit = (MAX_GRID_BITS as f64).exp2() + 1.0;
            for p in [lo, hi, lo.lerp(hi, 0.3)] {
                let node = grid.snap(p);
                assert!(node.abs().max_element() <= limit);
                assert_eq!(grid.snap(grid.place(node)), node);
                assert!((grid.place(node) - p).abs().max_element() <= grid.cell);
            }
        }
    }

    #[test]
    fn whole_millimetres_stay_where_they_are() {
        let grid = Grid::over(DVec3::ZERO, DVec3::new(100.0, 60.0, 51.0), MAX_GRID_BITS);
        for p in [DVec3::new(1.0, 0.5, 0.25), DVec3::new(50.0, 0.0, 51.0)] {
            assert_eq!(grid.place(grid.snap(p)), p);
        }
    }
}
