//! Tape lengths: the perimeter of the convex hull of a section.

/// Perimeter of the convex hull of points in a plane (Andrew's monotone chain). Sorts `points`. O(n log n).
pub(super) fn hull_length(points: &mut [[f64; 2]]) -> f64 {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    if points.len() < 2 {
        return 0.0;
    }
    chain_length(points.iter()) + chain_length(points.iter().rev())
}

/// Length of the chain that turns left only, from the first point to the last.
fn chain_length<'a>(points: impl Iterator<Item = &'a [f64; 2]>) -> f64 {
    let mut chain: Vec<[f64; 2]> = Vec::new();
    for &p in points {
        while let [.., a, b] = chain[..] {
            let cross = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
            if cross > 0.0 {
                break;
            }
            chain.pop();
        }
        chain.push(p);
    }
    chain.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum()
}
