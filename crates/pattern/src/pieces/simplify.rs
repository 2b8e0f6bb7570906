//! Fewer points within a tolerance.

use glam::DVec2;

/// Indices of the points that a polyline needs to stay within `tolerance` of its full self; ends and `keep` stay.
///
/// D. Douglas, T. Peucker, *Algorithms for the reduction of the number of points*, 1973.
pub(crate) fn needed(points: &[DVec2], tolerance: f64, keep: impl Fn(usize) -> bool) -> Vec<usize> {
    let n = points.len();
    if n < 3 {
        return (0..n).collect();
    }
    let mut stays = vec![false; n];
    let fixed: Vec<usize> = (0..n).filter(|&i| i == 0 || i == n - 1 || keep(i)).collect();
    let mut stack: Vec<(usize, usize)> = fixed.windows(2).map(|w| (w[0], w[1])).collect();
    fixed.iter().for_each(|&i| stays[i] = true);
    while let Some((a, b)) = stack.pop() {
        let mut worst = (tolerance, usize::MAX);
        for i in a + 1..b {
            let d = distance_to_segment(points[i], points[a], points[b]);
            if d > worst.0 {
                worst = (d, i);
            }
        }
        if worst.1 != usize::MAX {
            stays[worst.1] = true;
            stack.push((a, worst.1));
            stack.push((worst.1, b));
        }
    }
    (0..n).filter(|&i| stays[i]).collect()
}

/// The polyline with only the points it needs.
pub(crate) fn simplified(points: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    needed(points, tolerance, |_| false).into_iter().map(|i| points[i]).collect()
}

/// Distance of a point to a segment.
pub(crate) fn distance_to_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let d = b - a;
    let t =
        if d.length_squared() > 0.0 { ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0) } else { 0.0 };
    p.distance(a + t * d)
}

/// Signed area of a closed polygon, anticlockwise positive.
pub(crate) fn signed_area(points: &[DVec2]) -> f64 {
    (0..points.len()).map(|i| 0.5 * points[i].perp_dot(points[(i + 1) % points.len()])).sum()
}
