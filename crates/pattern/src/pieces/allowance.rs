//! The cut line: the sewing line widened by the allowance of each chain.
//!
//! ```text
//!        cut ┌───────────────┐ mitre        Every sewing segment gets a strip of its own width, every outward
//!            │   ┌───────┐   │              corner a wedge in the wanted style; the union of piece, strips and
//!            │   │ sewn  │   │              wedges has a clean outline by construction, also where strips of a
//!            │   └───────┘   │              narrow bay run into each other.
//!            └───────────────┘
//! ```

use glam::DVec2;
use i_overlay::{
    core::{fill_rule::FillRule, overlay_rule::OverlayRule},
    float::single::SingleFloatOverlay,
};

use super::{
    outline::{SewingLine, turn},
    simplify::{needed, signed_area},
};
use crate::{CornerStyle, CutLoop, PatternOptions, flatten::crossings};

/// One sewing segment with its allowance.
#[derive(Clone, Copy)]
struct Segment {
    from: DVec2,
    to: DVec2,
    width: f64,
    style: CornerStyle,
    /// Whether a chain ends at `to`.
    ends_chain: bool,
}

impl Segment {
    fn along(&self) -> DVec2 {
        (self.to - self.from).normalize_or_zero()
    }

    /// Away from the piece, which lies at the left.
    fn outward(&self) -> DVec2 {
        -self.along().perp()
    }
}

/// Cut lines of a piece, the outer one first and anticlockwise, holes clockwise.
pub(crate) fn cut_lines(lines: &[SewingLine], options: &PatternOptions) -> Vec<CutLoop> {
    let body: Vec<Vec<[f64; 2]>> =
        lines.iter().map(|l| l.outline.points().iter().map(|p| p.to_array()).collect()).collect();
    let mut added: Vec<Vec<[f64; 2]>> = Vec::new();
    let mut trimmed: Vec<Vec<[f64; 2]>> = Vec::new();
    for line in lines {
        let segments = segments(line);
        for (i, s) in segments.iter().enumerate() {
            let next = &segments[(i + 1) % segments.len()];
            if s.width > 0.0 {
                let n = s.outward() * s.width;
                added.push(polygon(&[s.to, s.from, s.from + n, s.to + n]));
            }
            if let Some(wedge) = wedge(s, next, options.mitre_limit) {
                added.push(polygon(&wedge));
            }
            trimmed.extend(trim(s, next).map(|t| polygon(&t)));
        }
    }
    let widened = !(added.is_empty() && trimmed.is_empty());
    let shapes = if added.is_empty() {
        vec![body]
    } else {
        body.overlay(&added, OverlayRule::Union, FillRule::NonZero)
    };
    let shapes = if trimmed.is_empty() {
        shapes
    } else {
        shapes.overlay(&trimmed, OverlayRule::Difference, FillRule::NonZero)
    };
    let mut loops: Vec<Vec<DVec2>> = shapes
        .into_iter()
        .flatten()
        .map(|contour| contour.into_iter().map(DVec2::from_array).collect::<Vec<_>>())
        .filter(|c| c.len() > 2)
        .collect();
    loops.sort_by(|a, b| signed_area(b).abs().total_cmp(&signed_area(a).abs()));
    let largest = loops.first().map_or(0.0, |c| signed_area(c).abs());
    loops.retain(|c| {
        let area = signed_area(c).abs();
        area > 0.0 && area == largest || area > speck(c, widened.then_some(largest))
    });
    loops.into_iter().enumerate().map(|(i, points)| finish(points, i == 0, options)).collect()
}

/// Area up to which a loop is not to be cut, in mm²: what strips leave between them in a piece of this area, or, where there
/// are none, a slit that is closed.
fn speck(points: &[DVec2], widened: Option<f64>) -> f64 {
    let length: f64 = (0..points.len()).map(|i| points[i].distance(points[(i + 1) % points.len()])).sum();
    (1e-4 * widened.unwrap_or(length * length)).min(1.0)
}

fn polygon(points: &[DVec2]) -> Vec<[f64; 2]> {
    points.iter().map(|p| p.to_array()).collect()
}

fn segments(line: &SewingLine) -> Vec<Segment> {
    let mut out = Vec::new();
    for (chain, &style) in line.outline.chains.iter().zip(&line.corners) {
        let last = chain.points.len() - 2;
        for (i, w) in chain.points.windows(2).enumerate() {
            out.push(Segment {
                from: w[0],
                to: w[1],
                width: chain.allowance_mm.max(0.0),
                style,
                ends_chain: i == last,
            });
        }
    }
    out
}

/// What fills the gap between the strips of two segments at an outward corner.
fn wedge(a: &Segment, b: &Segment, limit: f64) -> Option<Vec<DVec2>> {
    let (ta, tb, na, nb) = (a.along(), b.along(), a.outward(), b.outward());
    let sin = ta.perp_dot(tb);
    let p = a.to;
    let (wa, wb) = (a.width, b.width);
    // Inward corners and straight runs need none; the strips overlap or meet.
    if sin <= 1e-9 || (wa <= 0.0 && wb <= 0.0) {
        return None;
    }
    let (ea, eb) = (p + na * wa, p + nb * wb);
    let reach = limit * wa.max(wb);
    if a.ends_chain {
        // Where a's sewing line, run on, meets b's cut line, and the other way round.
        let on_a = p + ta * (wb / sin);
        let on_b = p - tb * (wa / sin);
        let special = |style: CornerStyle| matches!(style, CornerStyle::Square | CornerStyle::Mirrored);
        if special(a.style) && wb / sin <= reach {
            let end = match a.style {
                CornerStyle::Square => on_a + na * wa,
                _ => on_a + (tb - 2.0 * tb.dot(na) * na) * (wa / -tb.dot(na)),
            };
            if end.distance(p) <= 2.0 * reach {
                return Some(vec![p, ea, end, on_a, eb]);
            }
        }
        if special(b.style) && wa / sin <= reach {
            let end = match b.style {
                CornerStyle::Square => on_b + nb * wb,
                _ => on_b - (ta - 2.0 * ta.dot(nb) * nb) * (wb / ta.dot(nb)),
            };
            if end.distance(p) <= 2.0 * reach {
                return Some(vec![p, ea, on_b, end, eb]);
            }
        }
        if a.style == CornerStyle::Bevel || b.style == CornerStyle::Bevel {
            return Some(vec![p, ea, eb]);
        }
    }
    // Both cut lines meet at p + ta s + na wa with (p + ta s + na wa − p)·nb = wb.
    let s = (wb - wa * na.dot(nb)) / sin;
    let tip = ea + ta * s;
    // Unequal widths at a nearly straight corner: the lines meet far off or behind; a step joins them.
    let backward = s < 0.0 || (tip - eb).dot(tb) > 0.0;
    if backward {
        return Some(vec![p, ea, eb]);
    }
    if tip.distance(p) <= reach {
        return Some(vec![p, ea, tip, eb]);
    }
    // Blunt the mitre square to the bisector at the limit.
    let axis = (tip - p).normalize_or_zero();
    let cut = |from: DVec2| {
        let run = tip - from;
        let along = run.dot(axis);
        let t = if along > 0.0 { ((reach - (from - p).dot(axis)) / along).clamp(0.0, 1.0) } else { 0.0 };
        from + run * t
    };
    Some(vec![p, ea, cut(ea), cut(eb), eb])
}

/// What a mirrored allowance loses where its neighbour's edge slopes inward: folded back it would stick out.
fn trim(a: &Segment, b: &Segment) -> Option<[DVec2; 4]> {
    let (ta, tb, na, nb) = (a.along(), b.along(), a.outward(), b.outward());
    let (sin, p) = (ta.perp_dot(tb), a.to);
    if !a.ends_chain || sin <= 1e-9 || ta.dot(tb) >= 0.0 {
        return None;
    }
    let far = 2.0 * (a.width + b.width);
    if a.style == CornerStyle::Mirrored && a.width > 0.0 {
        let on_a = p + ta * (b.width / sin);
        let end = on_a + (tb - 2.0 * tb.dot(na) * na) * (a.width / sin) * 1.01;
        return Some([on_a, end, end + ta * (far + (on_a - end).dot(ta)), on_a + ta * far]);
    }
    if b.style == CornerStyle::Mirrored && b.width > 0.0 {
        let on_b = p - tb * (a.width / sin);
        let end = on_b - (ta - 2.0 * ta.dot(nb) * nb) * (b.width / sin) * 1.01;
        return Some([on_b, on_b - tb * far, end - tb * (far - (on_b - end).dot(tb)), end]);
    }
    None
}

/// Orders, thins and classifies the points of a loop.
fn finish(mut points: Vec<DVec2>, outer: bool, options: &PatternOptions) -> CutLoop {
    if (signed_area(&points) > 0.0) != outer {
        points.reverse();
    }
    // Corners of the raw loop stay; between them only what the tolerance needs.
    let n = points.len();
    let is_corner = |i: usize| {
        turn(points[(i + n - 1) % n], points[i], points[(i + 1) % n]).abs() > 0.5 * options.corner_angle
    };
    let start = (0..n).find(|&i| is_corner(i)).unwrap_or(0);
    let walked: Vec<DVec2> = (0..=n).map(|i| points[(start + i) % n]).collect();
    let corner: Vec<bool> = (0..=n).map(|i| is_corner((start + i) % n)).collect();
    let kept = needed(&walked, 0.5 * options.line_tolerance_mm, |i| corner[i] || i == n / 2);
    // Where the cut line all but touches itself, thinning may make it cross.
    let kept = if is_simple(&walked, &kept) { kept } else { (0..=n).collect() };
    let kept = &kept[..kept.len() - 1];
    let points: Vec<DVec2> = kept.iter().map(|&i| walked[i]).collect();
    // A raw corner of a dense curve may turn out smooth once thinned, never the other way round.
    let m = points.len();
    let corner = (0..m)
        .map(|i| {
            corner[kept[i]]
                && turn(points[(i + m - 1) % m], points[i], points[(i + 1) % m]).abs()
                    > 0.5 * options.corner_angle
        })
        .collect();
    CutLoop { points, corner }
}

/// Whether the closed line through some of the points does not cross itself.
fn is_simple(points: &[DVec2], kept: &[usize]) -> bool {
    let rim: Vec<u32> = kept[..kept.len() - 1].iter().map(|&i| i as u32).collect();
    crossings(points, &[rim]) == 0
}
