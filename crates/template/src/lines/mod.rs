//! Lines: what curves the chains of template edges follow (T4).

pub mod profile;
pub mod spline;

pub use profile::{Detail, Profile};
pub use spline::Spline;

use glam::DVec3;
use reference::{FeatureCurve, Features};

use crate::error::TemplateError;
use crate::format::{NamedShape, Shape};
use crate::layout::LayoutLine;

/// Straight pieces per span of a spline; the sagitta of the longest span that a garment has is then below 0.01 mm.
const PIECES: usize = 96;

/// The curves of all lines: one profile a span (from a node to the next).
///
/// `positions` are the template nodes' places and `on_centre` tells which lie on the plane of symmetry: a spline that ends
/// there meets its mirror image smoothly unless the node is a corner.
pub(crate) fn resolve(
    lines: &[LayoutLine],
    positions: &[DVec3],
    on_centre: &dyn Fn(u32) -> bool,
    features: &Features,
) -> Result<Vec<Vec<Profile>>, TemplateError> {
    let mut out: Vec<Vec<Profile>> = lines.iter().map(|_| Vec::new()).collect();
    let mut entered = vec![false; lines.len()];
    for next in lines.iter().filter_map(|l| l.continues) {
        entered[next as usize] = true;
    }
    let splined = |l: &LayoutLine| matches!(l.shape, None | Some(Shape::Named(NamedShape::Spline)));
    for (i, line) in lines.iter().enumerate() {
        if !splined(line) {
            out[i] = shaped(line, positions, features)?;
            continue;
        }
        if entered[i] || !out[i].is_empty() {
            continue;
        }
        // The chain of lines that run into each other; each is cut out of the common curve.
        let mut chain = vec![i];
        while let Some(next) = lines[chain[chain.len() - 1]].continues.map(|n| n as usize) {
            if chain.contains(&next) || !splined(&lines[next]) || !out[next].is_empty() {
                break;
            }
            chain.push(next);
        }
        splines(lines, &chain, positions, on_centre, &mut out);
    }
    // What is left runs in a ring of `continues`: each on its own.
    for i in 0..lines.len() {
        if out[i].is_empty() {
            splines(lines, &[i], positions, on_centre, &mut out);
        }
    }
    Ok(out)
}

fn splines(
    lines: &[LayoutLine],
    chain: &[usize],
    positions: &[DVec3],
    on_centre: &dyn Fn(u32) -> bool,
    out: &mut [Vec<Profile>],
) {
    let mut nodes: Vec<u32> = Vec::new();
    let mut corners: Vec<u32> = Vec::new();
    for &l in chain {
        nodes.extend(lines[l].nodes.iter().skip(usize::from(!nodes.is_empty())));
        corners.extend(&lines[l].corners);
    }
    let closed = chain.len() == 1 && lines[chain[0]].closed;
    let spans = curve(&nodes, closed, &corners, positions, on_centre);
    let mut spans = spans.into_iter();
    for &l in chain {
        let count = lines[l].nodes.len() - usize::from(!lines[l].closed);
        out[l] = spans.by_ref().take(count).collect();
    }
}

/// A spline through nodes, broken at corners, as one profile a span.
pub(crate) fn curve(
    nodes: &[u32],
    closed: bool,
    corners: &[u32],
    positions: &[DVec3],
    on_centre: &dyn Fn(u32) -> bool,
) -> Vec<Profile> {
    let place = |n: u32| positions[n as usize];
    let spans = nodes.len() - usize::from(!closed);
    let is_corner = |n: u32| corners.contains(&n);
    if closed && !nodes.iter().any(|n| is_corner(*n)) {
        let points: Vec<DVec3> = nodes.iter().map(|n| place(*n)).collect();
        let spline = Spline::new(&points, true);
        return (0..spans)
            .map(|s| span_profile(&spline, s, points[s], points[(s + 1) % points.len()]))
            .collect();
    }
    // A closed line with corners is a row of open ones that begins at a corner.
    let start = if closed { nodes.iter().position(|n| is_corner(*n)).unwrap_or(0) } else { 0 };
    let at = |k: usize| nodes[(start + k) % nodes.len()];
    let mut out: Vec<Option<Profile>> = vec![None; spans];
    let mut first = 0;
    while first < spans {
        let mut last = first + 1;
        while last < spans && !is_corner(at(last)) {
            last += 1;
        }
        let ids: Vec<u32> = (first..=last).map(at).collect();
        let points: Vec<DVec3> = ids.iter().map(|n| place(*n)).collect();
        let reflect = |p: &DVec3| DVec3::new(-p.x, p.y, p.z);
        let smooth_end = |end: u32, inner: u32| on_centre(end) && !on_centre(inner) && !is_corner(end);
        let n = ids.len();
        let mut extended: Vec<DVec3> = Vec::new();
        if smooth_end(ids[0], ids[1]) {
            extended.extend(points[1..].iter().rev().map(reflect));
        }
        let offset = extended.len();
        extended.extend(&points);
        if smooth_end(ids[n - 1], ids[n - 2]) {
            extended.extend(points[..n - 1].iter().rev().map(reflect));
        }
        let spline = Spline::new(&extended, false);
        for k in 0..n - 1 {
            out[(start + first + k) % nodes.len()] =
                Some(span_profile(&spline, offset + k, points[k], points[k + 1]));
        }
        first = last;
    }
    out.into_iter().flatten().collect()
}

fn span_profile(spline: &Spline, span: usize, start: DVec3, end: DVec3) -> Profile {
    let mut points = spline.polyline(span, PIECES);
    points[0] = start;
    points[PIECES] = end;
    Profile::new(points)
}

fn shaped(
    line: &LayoutLine,
    positions: &[DVec3],
    features: &Features,
) -> Result<Vec<Profile>, TemplateError> {
    let place = |n: u32| positions[n as usize];
    let spans = line.nodes.len() - usize::from(!line.closed);
    let ends = |s: usize| (place(line.nodes[s]), place(line.nodes[(s + 1) % line.nodes.len()]));
    match &line.shape {
        Some(Shape::Profile(p)) => {
            let detail = if p.turn { Detail::Turned } else { Detail::Kept };
            let drawn = Profile::new(p.points.iter().map(|q| DVec3::from_array(*q)).collect());
            let (start, end) = ends(0);
            Ok(vec![drawn.moved(start, end, detail)])
        }
        Some(Shape::Follow(f)) => {
            let path = format!("lines.{}.shape.follow", line.name);
            let curve = crate::place::feature_curve(features, &f.follow, &path)?;
            Ok((0..spans).map(|s| follow(curve, ends(s), f.clearance.unwrap_or(0.0))).collect())
        }
        _ => Ok((0..spans).map(|s| Profile::new(vec![ends(s).0, ends(s).1])).collect()),
    }
}

/// The part of a feature curve beside two places, lifted, and moved so that it begins and ends at them.
fn follow(curve: &FeatureCurve, (start, end): (DVec3, DVec3), clearance: f64) -> Profile {
    let arc = crate::place::ArcLength::new(curve);
    let (a, b) = (arc.nearest(start), arc.nearest(end));
    let way = arc.way(a, b);
    let lifted: Vec<DVec3> = (0..=PIECES)
        .map(|k| {
            let at = arc.at(a + way * k as f64 / PIECES as f64);
            at.position + clearance * at.normal
        })
        .collect();
    let (off_start, off_end) = (start - lifted[0], end - lifted[PIECES]);
    let raw = Profile::new(lifted);
    let points = raw.points.iter().zip(&raw.shares).map(|(p, u)| *p + off_start.lerp(off_end, *u)).collect();
    Profile::new(points)
}
