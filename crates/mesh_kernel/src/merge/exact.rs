//! Determinants of grid nodes without rounding, and points where lines pierce planes, rounded once.
//!
//! Nodes have 41 bits with their sign, differences 42, so that a determinant of three differences has at most 126.

use glam::DVec3;

/// A difference of nodes.
#[inline]
fn whole(p: DVec3) -> [i128; 3] {
    p.to_array().map(|x| x as i64 as i128)
}

/// Six times the volume of the tetrahedron, above zero where `p` lies on the side from which `a`, `b`, `c` run
/// anticlockwise. Exact.
pub(super) fn volume(a: DVec3, b: DVec3, c: DVec3, p: DVec3) -> i128 {
    let ([ux, uy, uz], [vx, vy, vz], [wx, wy, wz]) = (whole(b - a), whole(c - a), whole(p - a));
    (uy * vz - uz * vy) * wx + (uz * vx - ux * vz) * wy + (ux * vy - uy * vx) * wz
}

/// [`volume`] as a double with the right sign: by doubles where they tell it.
#[inline]
pub(super) fn volume_sign(a: DVec3, b: DVec3, c: DVec3, p: DVec3) -> f64 {
    let (u, v, w) = (b - a, c - a, p - a);
    let minors = [(u.y * v.z, u.z * v.y), (u.z * v.x, u.x * v.z), (u.x * v.y, u.y * v.x)];
    let [x, y, z] = minors.map(|(m, n)| m - n);
    let six = x * w.x + y * w.y + z * w.z;
    let [x, y, z] = minors.map(|(m, n)| m.abs() + n.abs());
    // Differences have no error; products, sums and their rounding stay below this (Shewchuk 1997).
    let error = 8.0 * f64::EPSILON * (x * w.x.abs() + y * w.y.abs() + z * w.z.abs());
    if six.abs() > error { six } else { volume(a, b, c, p) as f64 }
}

/// Twice the area of the triangle in the plane without `axis`. Exact.
pub(super) fn flat_area(axis: usize, a: DVec3, b: DVec3, c: DVec3) -> i128 {
    let (x, y) = plane_axes(axis);
    let (u, v) = (whole(b - a), whole(c - a));
    u[x] * v[y] - u[y] * v[x]
}

/// The two axes that remain without one, so that a normal along the dropped axis sees them anticlockwise.
#[inline]
pub(super) fn plane_axes(axis: usize) -> (usize, usize) {
    ((axis + 1) % 3, (axis + 2) % 3)
}

/// A number as the sum of two doubles, 106 bits.
#[derive(Clone, Copy, Debug)]
struct Pair {
    high: f64,
    low: f64,
}

impl Pair {
    fn of(n: i128) -> Self {
        let high = n as f64;
        Self { high, low: (n - high as i128) as f64 }
    }

    /// `n / d`, good to some 100 bits.
    fn quotient(n: Self, d: Self) -> Self {
        let high = n.high / d.high;
        let rest = (-high).mul_add(d.high, n.high) + (n.low - high * d.low);
        Self { high, low: rest / d.high }
    }
}

/// The node nearest to `p + (q − p) · n / (n − m)`: where a line from `p` to `q` pierces what has the signed distance `n`
/// at `p` and `m` at `q`. `n` and `m` must differ and have no equal signs.
pub(super) fn between(p: DVec3, q: DVec3, n: i128, m: i128) -> DVec3 {
    let t = Pair::quotient(Pair::of(n), Pair::of(n - m));
    let along = |p: f64, d: f64| {
        let product = d * t.high;
        let rest = d.mul_add(t.high, -product) + d * t.low;
        let near = product.round();
        p + near + ((product - near) + rest).round() + 0.0
    };
    let d = q - p;
    DVec3::new(along(p.x, d.x), along(p.y, d.y), along(p.z, d.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn volumes_of_the_largest_coordinates_do_not_overflow() {
        let far = (40f64).exp2();
        let corner = DVec3::splat(-far);
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|a| corner + a * 2.0 * far);
        assert_eq!(volume(corner, x, y, z), 1i128 << 123);
        assert_eq!(volume(corner, y, x, z), -(1i128 << 123));
        assert_eq!(flat_area(2, corner, x, y), 1i128 << 82);
    }

    #[test]
    fn piercing_points_are_rounded_once() {
        let (p, q) = (DVec3::new(-7.0, 0.0, 3.0), DVec3::new(1e12, 3.0, 3.0));
        assert_eq!(between(p, q, 1, -2), DVec3::new(333_333_333_329.0, 1.0, 3.0));
        // A long edge and a plane that is nearly along it: 2⁸⁰ to 1.
        let (n, m) = (1i128 << 80, -1);
        assert_eq!(between(p, q, n, m), q);
        assert_eq!(between(p, q, 1, -(1i128 << 80)), p);
    }
}
