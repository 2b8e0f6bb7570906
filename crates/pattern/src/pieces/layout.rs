//! Places for the pieces on the cloth: bounding boxes, tallest first, each as low as it goes (skyline).
//!
//! Pieces are not turned: the grain must run along the cloth.

use glam::DVec2;

use super::interior::bounds;
use crate::{Layout, Piece};

/// Level of the filled part from `x` for `width`.
struct Step {
    x: f64,
    width: f64,
    y: f64,
}

/// Lays out the pieces' cut lines without overlap; a box of size `reserved` at the origin stays free. O(n²) in the
/// number of pieces.
pub(crate) fn lay_out(pieces: &[Piece], fabric_width: f64, gap: f64, reserved: DVec2) -> Layout {
    let boxes: Vec<[DVec2; 2]> =
        pieces.iter().map(|p| bounds(p.cut.iter().flat_map(|c| c.points.iter().copied()))).collect();
    let widest = boxes.iter().map(|[l, h]| h.x - l.x).fold(reserved.x, f64::max);
    let width = fabric_width.max(widest + 2.0 * gap);
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    order.sort_by(|&a, &b| {
        let height = |i: usize| boxes[i][1].y - boxes[i][0].y;
        height(b).total_cmp(&height(a)).then(a.cmp(&b))
    });
    let mut skyline = vec![Step { x: gap, width: width - gap, y: gap }];
    let mut offsets = vec![DVec2::ZERO; pieces.len()];
    let mut length = gap;
    if reserved != DVec2::ZERO {
        raise(&mut skyline, gap, reserved.x + gap, reserved.y + 2.0 * gap);
        length += reserved.y + gap;
    }
    for i in order {
        let size = boxes[i][1] - boxes[i][0] + DVec2::splat(gap);
        let mut best: Option<(f64, f64)> = None;
        for step in &skyline {
            let x = step.x;
            if x + size.x > width + 1e-9 {
                continue;
            }
            let y = skyline
                .iter()
                .filter(|s| s.x < x + size.x - 1e-9 && s.x + s.width > x + 1e-9)
                .map(|s| s.y)
                .fold(0.0, f64::max);
            if best.is_none_or(|(by, bx)| (y, x) < (by, bx)) {
                best = Some((y, x));
            }
        }
        let (y, x) = best.unwrap_or((length, gap));
        offsets[i] = DVec2::new(x, y) - boxes[i][0];
        length = length.max(y + size.y);
        raise(&mut skyline, x, size.x, y + size.y);
    }
    Layout { width, length, offsets }
}

/// Sets the level from `x` for `width` to `y`.
fn raise(skyline: &mut Vec<Step>, x: f64, width: f64, y: f64) {
    let mut out: Vec<Step> = Vec::with_capacity(skyline.len() + 2);
    for s in skyline.drain(..) {
        let end = s.x + s.width;
        if s.x < x {
            out.push(Step { x: s.x, width: (end.min(x) - s.x).max(0.0), y: s.y });
        }
        if end > x + width {
            let from = s.x.max(x + width);
            out.push(Step { x: from, width: end - from, y: s.y });
        }
    }
    out.push(Step { x, width, y });
    out.retain(|s| s.width > 1e-9);
    out.sort_by(|a, b| a.x.total_cmp(&b.x));
    *skyline = out;
}
