//! From a stroke to profiles: the plane that it is projected on, and its parts on the edges (P2, P3).

use glam::{DMat3, DVec3};

use crate::{Camera, PickedEdge, Plane, SketchError, SpaceEdge, Stroke};

/// The plane on which a stroke over several edges is projected: through the mean of their ends, with the least squared
/// distance to them. Ends on one line leave it free to turn about that line; it then faces the camera as far as it can.
///
/// # Errors
/// [`SketchError::TooFewPoints`] without edges, [`SketchError::SeenEdgeOn`] when the camera looks along the plane.
pub fn fitted_plane(camera: &Camera, edges: &[SpaceEdge]) -> Result<Plane, SketchError> {
    let ends: Vec<DVec3> = edges.iter().flat_map(|e| e.ends).collect();
    if ends.is_empty() {
        return Err(SketchError::TooFewPoints { what: "a projection plane", wanted: 2, given: 0 });
    }
    let point = ends.iter().sum::<DVec3>() / ends.len() as f64;
    let mut scatter = DMat3::ZERO;
    for p in &ends {
        let d = *p - point;
        scatter += DMat3::from_cols(d * d.x, d * d.y, d * d.z);
    }
    let (values, vectors) = eigen(scatter);
    // The middle value tells how far the ends are from one line: below 1e-6 of the largest they are on it (a share of 0.001).
    let along = vectors[2];
    let sight = camera.eye().map_or(camera.back, |eye| (eye - point).normalize_or(camera.back));
    let normal = if values[1] > 1e-6 * values[2] {
        vectors[0]
    } else {
        (sight - along * sight.dot(along)).normalize_or_zero()
    };
    facing(camera, Plane { point, normal })
}

/// The plane on which a stroke on one edge is projected: one of the two through the edge that bisect the dihedral angle of its
/// faces, the one that faces the camera more. `normals` are the unit normals of the faces at the edge; with one face or none
/// the plane through the edge that faces the camera most.
///
/// # Errors
/// [`SketchError::SeenEdgeOn`] when the camera looks along the edge.
pub fn bisecting_plane(camera: &Camera, edge: &SpaceEdge, normals: &[DVec3]) -> Result<Plane, SketchError> {
    let [a, b] = edge.ends;
    let point = a.lerp(b, 0.5);
    let along = (b - a).try_normalize().ok_or(SketchError::NoLength { curve: 1 })?;
    let sight = camera.eye().map_or(camera.back, |eye| (eye - point).normalize_or(camera.back));
    let across = |v: DVec3| (v - along * v.dot(along)).normalize_or_zero();
    let free = across(sight);
    let normal = match normals {
        [m, n, ..] => {
            // Face normals may be oriented either way: the two bisecting planes are the same pair.
            let (m, n) = (across(*m), across(*n));
            let pair = [across(m + n), across(m - n)];
            let better = if pair[0].dot(sight).abs() >= pair[1].dot(sight).abs() { pair[0] } else { pair[1] };
            if better == DVec3::ZERO { free } else { better }
        }
        _ => free,
    };
    facing(camera, Plane { point, normal })
}

/// The plane turned to the camera; refused when that sees only its edge.
fn facing(camera: &Camera, plane: Plane) -> Result<Plane, SketchError> {
    let sight = camera.eye().map_or(camera.back, |eye| (eye - plane.point).normalize_or(camera.back));
    let cosine = plane.normal.dot(sight);
    // Under 3° a pixel of the hand is twenty on the plane.
    if cosine.abs() < 0.05 {
        return Err(SketchError::SeenEdgeOn);
    }
    Ok(Plane { normal: plane.normal * cosine.signum(), ..plane })
}

/// How a stroke becomes profiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfileOptions {
    /// Points of a profile.
    pub points: usize,
    /// The hand's tremble that is taken out: standard deviation of the filter, pixels.
    pub steadying: f64,
}

impl Default for ProfileOptions {
    fn default() -> Self {
        Self { points: 65, steadying: 4.0 }
    }
}

/// A profile drawn on an edge.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnProfile {
    /// The edge's number.
    pub edge: usize,
    /// Its points, from the edge's first end to its second, both exact; even by arc length, mm.
    pub points: Vec<DVec3>,
}

/// Splits a stroke at the places nearest to the picked edges' ends and makes a profile of each part on the plane.
///
/// A part is moved so that it begins and ends at the edge's ends: what is missing at either end is added with a weight that
/// runs from 1 there to 0 at the other end, smoothly (3t² − 2t³), so that the ends stay smooth.
///
/// # Errors
/// [`SketchError::SeenEdgeOn`] where the line of sight misses the plane.
pub fn profiles(
    camera: &Camera,
    stroke: &Stroke,
    edges: &[SpaceEdge],
    picked: &[PickedEdge],
    plane: &Plane,
    options: &ProfileOptions,
) -> Result<Vec<DrawnProfile>, SketchError> {
    let steady = stroke.steadied(options.steadying);
    let stretch = steady.length() / stroke.length();
    let count = options.points.max(3);
    let mut out = Vec::with_capacity(picked.len());
    for pick in picked {
        // Steadying rounds corners, so the split is looked for again near where the stroke had it.
        let window = 2.0 * options.steadying + 0.02 * steady.length();
        let split = |end: usize| {
            let about = pick.span[end] * stretch;
            let at = camera.project(edges[pick.edge].ends[end])?;
            Some(steady.nearest_between(at, about - window, about + window).1)
        };
        let (Some(from), Some(to)) = (split(0), split(1)) else { return Err(SketchError::SeenEdgeOn) };
        // Perspective makes even pixels uneven on the plane: sample finely, then space evenly there.
        let fine = steady.resampled(from, to, 4 * count + 1);
        let on_plane: Option<Vec<DVec3>> = fine.iter().map(|at| camera.unproject(*at, plane)).collect();
        let raw = spaced(&on_plane.ok_or(SketchError::SeenEdgeOn)?, count);
        let [a, b] = edges[pick.edge].ends;
        let mut points = spaced(&eased(&raw, [a, b]), count);
        points[0] = a;
        points[count - 1] = b;
        out.push(DrawnProfile { edge: pick.edge, points });
    }
    Ok(out)
}

/// Evenly spaced points moved so that they begin and end at two places: what is missing at either end is added with a weight that
/// runs from 1 there to 0 at the other end, smoothly.
pub(crate) fn eased(points: &[DVec3], [a, b]: [DVec3; 2]) -> Vec<DVec3> {
    let last = points.len() - 1;
    let (gap_a, gap_b) = (a - points[0], b - points[last]);
    let ease = |t: f64| t * t * (3.0 - 2.0 * t);
    let moved = |(k, p): (usize, &DVec3)| {
        let t = k as f64 / last as f64;
        *p + ease(1.0 - t) * gap_a + ease(t) * gap_b
    };
    points.iter().enumerate().map(moved).collect()
}

/// `count` points evenly spaced along a polyline.
pub(crate) fn spaced(points: &[DVec3], count: usize) -> Vec<DVec3> {
    let mut sums = vec![0.0];
    for w in points.windows(2) {
        sums.push(sums[sums.len() - 1] + w[0].distance(w[1]));
    }
    let total = sums[sums.len() - 1];
    (0..count)
        .map(|k| {
            let s = total * k as f64 / (count - 1) as f64;
            let after = sums.partition_point(|v| *v < s).clamp(1, sums.len() - 1);
            let step = sums[after] - sums[after - 1];
            let t = if step > 0.0 { ((s - sums[after - 1]) / step).clamp(0.0, 1.0) } else { 0.0 };
            points[after - 1].lerp(points[after], t)
        })
        .collect()
}

/// Eigenvalues, rising, and unit eigenvectors of a symmetric matrix, by Jacobi's rotations.
fn eigen(mut m: DMat3) -> ([f64; 3], [DVec3; 3]) {
    let mut turn = DMat3::IDENTITY;
    for _ in 0..32 {
        let off = [(0, 1), (0, 2), (1, 2)];
        let (p, q) = off
            .into_iter()
            .max_by(|a, b| m.col(a.0)[a.1].abs().total_cmp(&m.col(b.0)[b.1].abs()))
            .unwrap_or((0, 1));
        let element = m.col(p)[q];
        if element.abs() <= f64::EPSILON * (m.col(0)[0] + m.col(1)[1] + m.col(2)[2]).abs() {
            break;
        }
        let angle = 0.5 * (2.0 * element).atan2(m.col(q)[q] - m.col(p)[p]);
        let (s, c) = angle.sin_cos();
        let mut r = DMat3::IDENTITY;
        r.col_mut(p)[p] = c;
        r.col_mut(q)[q] = c;
        r.col_mut(p)[q] = -s;
        r.col_mut(q)[p] = s;
        m = r.transpose() * m * r;
        turn *= r;
    }
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| m.col(*a)[*a].total_cmp(&m.col(*b)[*b]));
    (order.map(|i| m.col(i)[i]), order.map(|i| turn.col(i)))
}
