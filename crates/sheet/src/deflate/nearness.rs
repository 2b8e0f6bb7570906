//! What lies near to each other in space: pairs of nodes, segments that cross.

use glam::DVec3;

/// How near things must be to be one, in mm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearness {
    /// For what is exact: rounding.
    pub(super) rounding: f64,
    /// For borders of curved pieces, which are chords.
    pub(super) chords: f64,
}

/// Pairs of nodes at most `distance` apart, in ascending order. O(n log n).
pub(super) fn near_pairs(positions: &[DVec3], nodes: &[u32], distance: f64) -> Vec<(u32, u32)> {
    let mut order: Vec<u32> = nodes.to_vec();
    // A direction in which regular parts have few nodes level.
    let key = |v: u32| positions[v as usize].dot(DVec3::new(0.743, 0.557, 0.371));
    order.sort_by(|a, b| key(*a).total_cmp(&key(*b)).then(a.cmp(b)));
    let mut pairs = Vec::new();
    for (i, &a) in order.iter().enumerate() {
        for &b in &order[i + 1..] {
            if key(b) - key(a) > distance {
                break;
            }
            if positions[a as usize].distance(positions[b as usize]) <= distance {
                pairs.push((a.min(b), a.max(b)));
            }
        }
    }
    pairs.sort_unstable();
    pairs
}

/// Where two segments that are not parallel cross, as shares of their lengths, both inside.
pub(super) fn crossing(a: DVec3, b: DVec3, c: DVec3, d: DVec3, distance: f64) -> Option<(f64, f64)> {
    let (u, v, w) = (b - a, d - c, c - a);
    let normal = u.cross(v);
    let square = normal.length_squared();
    if square < 1e-6 * u.length_squared() * v.length_squared() {
        return None;
    }
    let (s, t) = (w.cross(v).dot(normal) / square, w.cross(u).dot(normal) / square);
    let (ends_u, ends_v) = (distance / u.length(), distance / v.length());
    let inside = s > ends_u && s < 1.0 - ends_u && t > ends_v && t < 1.0 - ends_v;
    (inside && (a + u * s).distance(c + v * t) <= distance).then_some((s, t))
}
