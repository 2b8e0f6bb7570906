//! Planes, and which of many are one.

use glam::DVec3;

/// The points x with `normal · x = offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plane {
    /// Of unit length.
    pub(super) normal: DVec3,
    /// Distance from the origin along the normal.
    pub(super) offset: f64,
}

impl Plane {
    /// How far a point is in front of it.
    pub(super) fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(p) - self.offset
    }

    /// The plane whose points are as far behind `self` as behind `other`, which faces the other way. It faces as `self`.
    pub(super) fn middle(&self, other: &Self) -> Self {
        let normal = self.normal - other.normal;
        let length = normal.length();
        Self { normal: normal / length, offset: (self.offset - other.offset) / length }
    }

    /// Two unit vectors that with the normal make a right-handed frame.
    pub(super) fn frame(&self) -> [DVec3; 2] {
        let (x, y) = self.normal.any_orthonormal_pair();
        [x, y]
    }

    /// The same points, seen from the other side.
    pub(super) fn flipped(&self) -> Self {
        Self { normal: -self.normal, offset: -self.offset }
    }
}

/// Planes that are one within tolerance share a number; the first one stands for all.
#[derive(Debug)]
pub(super) struct PlaneTable {
    planes: Vec<Plane>,
    centre: DVec3,
    /// How far two that are one are apart at the centre, in mm, and how much they lean, in radians.
    apart: f64,
    lean: f64,
}

/// Two planes are one if they are this near to each other, over the solid's size; or if they are apart by so many times what its file rounds
/// by, and lean by so many times that over its size: planes of small faces lean more than they are off.
const SAME_PLANE: f64 = 2e-6;
const ROUNDED: f64 = 4.0;
const ROUNDED_LEAN: f64 = 20.0;

impl PlaneTable {
    /// For a solid of the given diagonal about `centre`, whose file rounds by so much.
    pub(super) fn new(size: f64, rounding: f64, centre: DVec3) -> Self {
        let apart = (SAME_PLANE * size).max(ROUNDED * rounding);
        let lean = (2.0 * SAME_PLANE).max(ROUNDED_LEAN * rounding / size);
        Self { planes: Vec::new(), centre, apart, lean }
    }

    /// The number of a plane with its side, added if it is new. O(planes).
    pub(super) fn number(&mut self, plane: Plane) -> u32 {
        let same = |q: &Plane| {
            let lean = (q.normal - plane.normal).length();
            let apart = (q.height(self.centre) - plane.height(self.centre)).abs();
            lean < self.lean && apart < self.apart
        };
        if let Some(k) = self.planes.iter().position(same) {
            return k as u32;
        }
        self.planes.push(plane);
        self.planes.len() as u32 - 1
    }

    /// The plane of a number.
    pub(super) fn plane(&self, number: u32) -> Plane {
        self.planes[number as usize]
    }
}
