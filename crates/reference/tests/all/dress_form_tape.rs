//! A tape of its own: sections face by face, hull by the extreme points in many directions.

use mesh_kernel::TriMesh;

/// Convex hull lengths of the horizontal sections at `heights`, mm, each seen from so many directions.
pub(crate) fn tapes(mesh: &TriMesh, heights: &[f64], directions: u32) -> Vec<f64> {
    let mut points: Vec<Vec<(f64, f64)>> = vec![Vec::new(); heights.len()];
    for f in 0..mesh.faces.len() as u32 {
        let c = mesh.corners(f);
        let low = c[0].y.min(c[1].y).min(c[2].y);
        let high = c[0].y.max(c[1].y).max(c[2].y);
        for (k, &y) in heights.iter().enumerate().filter(|(_, y)| (low..=high).contains(*y)) {
            for i in 0..3 {
                let (a, b) = (c[i], c[(i + 1) % 3]);
                if (a.y - y) * (b.y - y) <= 0.0 && a.y != b.y {
                    let t = (y - a.y) / (b.y - a.y);
                    points[k].push((a.x + t * (b.x - a.x), a.z + t * (b.z - a.z)));
                }
            }
        }
    }
    points.iter().map(|points| hull(points, directions)).collect()
}

fn hull(points: &[(f64, f64)], directions: u32) -> f64 {
    let mut corners: Vec<(f64, f64)> = Vec::new();
    for k in 0..directions {
        let (s, c) = (std::f64::consts::TAU * f64::from(k) / f64::from(directions)).sin_cos();
        let far = points.iter().copied().max_by(|a, b| (a.0 * c + a.1 * s).total_cmp(&(b.0 * c + b.1 * s)));
        corners.extend(far);
    }
    corners.dedup();
    let n = corners.len();
    (0..n).map(|i| (corners[(i + 1) % n].0 - corners[i].0).hypot(corners[(i + 1) % n].1 - corners[i].1)).sum()
}
