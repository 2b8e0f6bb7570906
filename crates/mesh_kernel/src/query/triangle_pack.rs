//! Four triangles side by side: bounds of their distances in f32.

use glam::{DVec3, Vec4};

use super::bvh::LEAF;

/// Vectors side by side.
type Vec3x4 = [Vec4; 3];

/// Up to four triangles with a bound of what f32 does to their distances.
#[derive(Clone, Debug)]
pub(super) struct TrianglePack {
    a: Vec3x4,
    ab: Vec3x4,
    ac: Vec3x4,
    /// How far a computed distance may be above the true one, apart from the rounding of coordinates; infinite for
    /// triangles that are too thin.
    error: Vec4,
}

impl TrianglePack {
    pub(super) fn new(triangles: impl Iterator<Item = [DVec3; 3]>) -> Self {
        let zero = [Vec4::ZERO; 3];
        let mut pack = Self { a: zero, ab: zero, ac: zero, error: Vec4::INFINITY };
        for (k, [a, b, c]) in triangles.take(LEAF).enumerate() {
            let (ab, ac) = (b - a, c - a);
            for axis in 0..3 {
                pack.a[axis][k] = a[axis] as f32;
                pack.ab[axis][k] = ab[axis] as f32;
                pack.ac[axis][k] = ac[axis] as f32;
            }
            // The normal turns by about ε / sine when its sides are rounded, and swings over the triangle's size.
            let size = ab.length().max(ac.length()).max(b.distance(c));
            let sine = ab.cross(ac).length() / (size * size);
            let error = 16.0 * f64::from(f32::EPSILON) * size / sine;
            pack.error[k] = if sine > 1e-3 { (error as f32).next_up() } else { f32::INFINITY };
        }
        pack
    }

    /// Bounds of the distances from `p` (four copies of it).
    #[inline]
    pub(super) fn bounds(&self, p: Vec3x4) -> Bounds {
        let Self { ab, ac, .. } = self;
        let ap = sub(p, self.a);
        let (d1, d2) = (dot(*ab, ap), dot(*ac, ap));
        let (ab_ab, ab_ac, ac_ac) = (dot(*ab, *ab), dot(*ab, *ac), dot(*ac, *ac));
        let (d3, d4, d5, d6) = (d1 - ab_ab, d2 - ab_ac, d1 - ab_ac, d2 - ac_ac);
        // Over the face: the distance to the plane, else to the sides. Where rounding leaves that open, the first is a
        // bound from below and the second from above.
        let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
        let largest = ab_ab.max(ac_ac);
        let doubt = largest * (dot(ap, ap) + largest) * 1e-5;
        let least_of = va.min(vb).min(vc);
        let normal = cross(*ab, *ac);
        let height = dot(normal, ap);
        let plane = height * height / dot(normal, normal);
        let side = |from: Vec3x4, along: Vec3x4, product: Vec4, square: Vec4| {
            let t = (product / square).max(Vec4::ZERO).min(Vec4::ONE);
            let off = sub(from, along.map(|c| c * t));
            dot(off, off)
        };
        let bc = sub(*ac, *ab);
        let bp = sub(ap, *ab);
        let sides = side(ap, *ab, d1, ab_ab).min(side(ap, *ac, d2, ac_ac)).min(side(
            bp,
            bc,
            dot(bc, bp),
            dot(bc, bc),
        ));
        Bounds {
            least2: Vec4::select(least_of.cmpge(-doubt), plane.min(sides), sides),
            most2: Vec4::select(least_of.cmpgt(doubt), plane, sides),
            error: self.error,
        }
    }
}

/// Squared distances of four triangles, apart from the triangles' error and the rounding of coordinates.
pub(super) struct Bounds {
    least2: Vec4,
    most2: Vec4,
    error: Vec4,
}

/// Relative rounding of a squared distance.
const ROUNDING: f32 = 1e-5;

impl Bounds {
    /// A bit for each triangle whose distance may be `limit` or less. What is no number counts.
    #[inline]
    pub(super) fn not_beyond(&self, limit: f32) -> u32 {
        let most = self.error + limit;
        !self.least2.cmpgt(most * most * (1.0 + ROUNDING)).bitmask()
    }

    /// The least distance of triangle `k`; −∞ or no number where nothing is known.
    #[inline]
    pub(super) fn least(&self, k: usize) -> f32 {
        self.least2[k].sqrt() * (1.0 - ROUNDING) - self.error[k]
    }

    /// The greatest distance of triangle `k`; infinite or no number where nothing is known.
    #[inline]
    pub(super) fn most(&self, k: usize) -> f32 {
        self.most2[k].sqrt() * (1.0 + ROUNDING) + self.error[k]
    }
}

#[inline]
fn sub(a: Vec3x4, b: Vec3x4) -> Vec3x4 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline]
fn dot(a: Vec3x4, b: Vec3x4) -> Vec4 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
fn cross(a: Vec3x4, b: Vec3x4) -> Vec3x4 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
