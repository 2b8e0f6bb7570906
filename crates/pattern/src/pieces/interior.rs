//! What stands inside a piece: grain line, text, and which way up it lies.

use glam::{DVec2, DVec3};

use super::simplify::distance_to_segment;
use crate::{Patch, flatten::FlatPatch};

/// Angle by which the flat patch must be turned so that the grain runs along +y.
pub(crate) fn grain_turn(patch: &Patch, flat: &FlatPatch) -> f64 {
    let wanted = patch.grain.filter(|g| g.is_finite() && g.length() > 0.0);
    let direction = wanted.unwrap_or(DVec3::Y).normalize();
    let mut mean = DVec2::ZERO;
    let mut area = 0.0;
    for (f, face) in patch.faces.iter().enumerate() {
        let [a, b, c] = face.map(|v| patch.positions[v as usize]);
        let normal = (b - a).cross(c - a);
        let doubled = normal.length();
        let unit = normal / doubled;
        // Gradient of a corner's hat function: its opposite side turned by a right angle, over twice the area.
        let slope = |side: DVec3| unit.cross(side).dot(direction) / doubled;
        let [p, q, r] = flat.flat.corners(f);
        mean += 0.5 * doubled * (p * slope(c - b) + q * slope(a - c) + r * slope(b - a));
        area += 0.5 * doubled;
    }
    // A lying patch has no vertical worth the name: its longest direction is the grain then.
    let axis = if mean.length() > 0.2 * area || (wanted.is_some() && mean.length() > 1e-6 * area) {
        mean
    } else {
        longest_direction(&flat.flat.uv, mean)
    };
    axis.angle_to(DVec2::Y)
}

/// Main axis of points, on the side of `hint`.
fn longest_direction(points: &[DVec2], hint: DVec2) -> DVec2 {
    let centre = points.iter().copied().sum::<DVec2>() / points.len() as f64;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for p in points {
        let d = *p - centre;
        xx += d.x * d.x;
        xy += d.x * d.y;
        yy += d.y * d.y;
    }
    let axis = DVec2::from_angle(0.5 * (2.0 * xy).atan2(xx - yy));
    if axis.dot(hint) < 0.0 { -axis } else { axis }
}

/// Whether a point lies inside loops (even–odd).
pub(crate) fn inside(p: DVec2, loops: &[Vec<DVec2>]) -> bool {
    let mut odd = false;
    for one in loops {
        for i in 0..one.len() {
            let (a, b) = (one[i], one[(i + 1) % one.len()]);
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                odd = !odd;
            }
        }
    }
    odd
}

/// Distance to the nearest loop, negative outside.
fn depth(p: DVec2, loops: &[Vec<DVec2>]) -> f64 {
    let mut nearest = f64::INFINITY;
    for one in loops {
        for i in 0..one.len() {
            nearest = nearest.min(distance_to_segment(p, one[i], one[(i + 1) % one.len()]));
        }
    }
    if inside(p, loops) { nearest } else { -nearest }
}

/// Bounds of points.
pub(crate) fn bounds(points: impl Iterator<Item = DVec2>) -> [DVec2; 2] {
    points.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)])
}

/// A point deep inside: the best of a grid, improved by halving steps.
pub(crate) fn deep_point(loops: &[Vec<DVec2>]) -> DVec2 {
    const GRID: usize = 12;
    let [low, high] = bounds(loops.iter().flatten().copied());
    let step = (high - low) / GRID as f64;
    let mut best = (f64::NEG_INFINITY, 0.5 * (low + high));
    for i in 0..GRID {
        for j in 0..GRID {
            let p = low + step * DVec2::new(i as f64 + 0.5, j as f64 + 0.5);
            let d = depth(p, loops);
            if d > best.0 + 1e-9 {
                best = (d, p);
            }
        }
    }
    let mut reach = 0.5 * step;
    for _ in 0..6 {
        let centre = best.1;
        for d in [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y] {
            let p = centre + d * reach;
            let deep = depth(p, loops);
            if deep > best.0 + 1e-9 {
                best = (deep, p);
            }
        }
        reach *= 0.5;
    }
    best.1
}

/// Grain line: a vertical through the piece beside the text, as long as fits, at most 400 mm.
pub(crate) fn grain_line(loops: &[Vec<DVec2>], text_at: DVec2, letters: usize) -> [DVec2; 2] {
    let text_half = (0.6 * depth(text_at, loops)).min(3.5 * letters.max(8) as f64) + 3.0;
    let [low, high] = bounds(loops.iter().flatten().copied());
    let mut best: Option<(f64, [DVec2; 2])> = None;
    for k in 0..24 {
        let x = low.x + (high.x - low.x) * (k as f64 + 0.5) / 24.0;
        let Some([from, to]) = longest_chord(loops, x) else { continue };
        let beside = (x - text_at.x).abs();
        // Long is good; far from the text is bad; on the text too.
        let score = (to - from) - 0.5 * beside - if beside < text_half { 0.5 * (to - from) } else { 0.0 };
        if best.is_none_or(|b| score > b.0) {
            let middle = 0.5 * (from + to);
            let half = (0.35 * (to - from)).min(200.0);
            best = Some((score, [DVec2::new(x, middle - half), DVec2::new(x, middle + half)]));
        }
    }
    best.map_or([text_at - DVec2::Y, text_at + DVec2::Y], |b| b.1)
}

/// The longest part of the vertical at `x` inside the loops.
fn longest_chord(loops: &[Vec<DVec2>], x: f64) -> Option<[f64; 2]> {
    let mut hits: Vec<f64> = Vec::new();
    for one in loops {
        for i in 0..one.len() {
            let (a, b) = (one[i], one[(i + 1) % one.len()]);
            if (a.x > x) != (b.x > x) {
                hits.push(a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y));
            }
        }
    }
    hits.sort_by(f64::total_cmp);
    let chords = hits.as_chunks::<2>().0;
    chords.iter().copied().max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))
}
