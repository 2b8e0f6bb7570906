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
    size: f64,
    centre: DVec3,
}

/// Two planes are one if they are this near to each other, over the solid's size.
const SAME_PLANE: f64 = 2e-6;

impl PlaneTable {
    /// For a solid of the given diagonal about `centre`.
    pub(super) fn new(size: f64, centre: DVec3) -> Self {
        Self { planes: Vec::new(), size, centre }
    }

    /// The number of a plane with its side, added if it is new. O(planes).
    pub(super) fn number(&mut self, plane: Plane) -> u32 {
        let same = |q: &Plane| {
            let lean = (q.normal - plane.normal).length();
            lean < 2.0 * SAME_PLANE
                && (q.height(self.centre) - plane.height(self.centre)).abs() < SAME_PLANE * self.size
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
