//! A part of a curve in space, drawn again by a stroke that begins and ends on it.

use glam::{DVec2, DVec3};

use crate::profile::{eased, spaced};
use crate::{Camera, PICK_DISTANCE, Plane, ProfileOptions, SketchError, Stroke};

/// A place on a polyline: after so many of its points, and this share of the way to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Along {
    after: usize,
    share: f64,
}

/// The part of a curve that a stroke draws again.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnOver {
    /// What is before it, up to where it begins; what is replaced; what is after it.
    pub parts: [Vec<DVec3>; 3],
    /// Whether the stroke runs against the curve.
    pub against: bool,
}

/// What of a curve a stroke draws over: from the place nearest to its beginning to that nearest to its end. `None` where one of
/// them is not on the curve (within [`PICK_DISTANCE`] · `pixel_scale`), both are in one place, or the stroke is much shorter
/// than what it would replace: it only touches the curve then. O(points).
pub fn drawn_over(camera: &Camera, stroke: &Stroke, curve: &[DVec3], pixel_scale: f64) -> Option<DrawnOver> {
    let seen: Option<Vec<DVec2>> = curve.iter().map(|p| camera.project(*p)).collect();
    let seen = seen?;
    let (first, last) = (*stroke.points().first()?, *stroke.points().last()?);
    let near = PICK_DISTANCE * pixel_scale;
    let ([from, to], against) = match (nearest(&seen, first, near)?, nearest(&seen, last, near)?) {
        (a, b) if (a.after, a.share) < (b.after, b.share) => ([a, b], false),
        (a, b) => ([b, a], true),
    };
    let place = |at: Along| curve[at.after].lerp(curve[at.after + 1], at.share);
    let (begin, end) = (place(from), place(to));
    let mut replaced = vec![begin];
    replaced.extend(&curve[from.after + 1..=to.after]);
    replaced.push(end);
    let on_screen = |points: &[DVec3]| -> f64 {
        let at: Vec<DVec2> = points.iter().filter_map(|p| camera.project(*p)).collect();
        at.windows(2).map(|w| w[0].distance(w[1])).sum()
    };
    let long = on_screen(&replaced);
    if long < 2.0 * near || stroke.length() < 0.5 * long {
        return None;
    }
    let before = curve[..=from.after].iter().copied().chain([begin]).collect();
    let after = std::iter::once(end).chain(curve[to.after + 1..].iter().copied()).collect();
    Some(DrawnOver { parts: [before, replaced, after], against })
}

/// Where a polyline is nearest to a place, if it is as near.
fn nearest(line: &[DVec2], p: DVec2, near: f64) -> Option<Along> {
    let at = |(after, w): (usize, &[DVec2])| {
        let along = w[1] - w[0];
        let share = ((p - w[0]).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
        ((w[0] + along * share).distance(p), Along { after, share })
    };
    let found = line.windows(2).enumerate().map(at).min_by(|a, b| a.0.total_cmp(&b.0));
    found.filter(|(distance, _)| *distance < near).map(|(_, along)| along)
}

/// The whole curve with its part drawn again: the stroke on the plane, steadied, moved so that it meets what is left, as
/// [`profiles`](crate::profiles) moves strokes to ends of edges; evenly spaced, its ends exact.
///
/// # Errors
/// [`SketchError::SeenEdgeOn`] where the line of sight misses the plane.
pub fn redrawn(
    camera: &Camera,
    stroke: &Stroke,
    over: &DrawnOver,
    plane: &Plane,
    options: &ProfileOptions,
) -> Result<Vec<DVec3>, SketchError> {
    let steady = stroke.steadied(options.steadying);
    let count = options.points.max(3);
    let fine = steady.resampled(0.0, steady.length(), 4 * count + 1);
    let on_plane: Option<Vec<DVec3>> = fine.iter().map(|at| camera.unproject(*at, plane)).collect();
    let mut raw = spaced(&on_plane.ok_or(SketchError::SeenEdgeOn)?, count);
    if over.against {
        raw.reverse();
    }
    let [before, replaced, after] = &over.parts;
    let ends = [replaced[0], replaced[replaced.len() - 1]];
    let mut whole = before.clone();
    whole.extend(eased(&raw, ends));
    whole.extend(after);
    let (first, last) = (whole[0], whole[whole.len() - 1]);
    let mut points = spaced(&whole, count);
    (points[0], points[count - 1]) = (first, last);
    Ok(points)
}
