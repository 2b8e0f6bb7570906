//! Which template edges a stroke means (P1).

use glam::DVec3;

use crate::{Camera, Ray, Stroke};

/// Ends of an edge within this of a stroke are on it, in pixels of a screen at scale 1.
pub const PICK_DISTANCE: f64 = 4.0;

/// A template edge in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceEdge {
    /// Its ends, mm.
    pub ends: [DVec3; 2],
}

/// An edge that a stroke picks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PickedEdge {
    /// Its number in the list given.
    pub edge: usize,
    /// Lengths from the stroke's beginning, pixels, nearest to the edge's first and second end.
    pub span: [f64; 2],
}

/// What hides things: the first place at which a line of sight meets the body or a surface, as a distance from the ray's
/// origin, mm; parallel sight looks from infinitely far away.
pub trait Sight {
    /// Whether something lies on the line of sight in front of the place `p`, by more than `slack` mm.
    fn hides(&self, ray: &Ray, p: DVec3, slack: f64) -> bool;
}

/// Nothing hides anything.
#[derive(Clone, Copy, Debug, Default)]
pub struct Clear;

impl Sight for Clear {
    fn hides(&self, _: &Ray, _: DVec3, _: f64) -> bool {
        false
    }
}

/// How edges are picked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PickOptions {
    /// Pixels of the picture a pixel of a screen at scale 1: 2 on a screen of double density.
    pub pixel_scale: f64,
    /// What lies in front of an edge by less than this does not hide it, mm: surfaces that end at the edge.
    pub slack: f64,
}

impl Default for PickOptions {
    fn default() -> Self {
        Self { pixel_scale: 1.0, slack: 3.0 }
    }
}

/// Places on an edge at which its visibility is asked, as shares.
const SIGHTS: [f64; 5] = [0.02, 0.25, 0.5, 0.75, 0.98];

/// Edges that a stroke picks: both ends seen nearer to it than [`PICK_DISTANCE`], and most of the edge visible. They come in
/// the order in which the stroke passes their middles. O(edges · points).
///
/// An edge of which both ends are near one place of the stroke is one that the stroke passes by, and is not picked: the part
/// of the stroke between its ends must be half as long as the edge on the screen at least.
pub fn pick_edges(
    camera: &Camera,
    stroke: &Stroke,
    edges: &[SpaceEdge],
    sight: &dyn Sight,
    options: &PickOptions,
) -> Vec<PickedEdge> {
    let near = PICK_DISTANCE * options.pixel_scale;
    let mut picked = Vec::new();
    for (edge, space) in edges.iter().enumerate() {
        let [Some(a), Some(b)] = space.ends.map(|p| camera.project(p)) else { continue };
        let ((da, sa), (db, sb)) = (stroke.nearest(a), stroke.nearest(b));
        if da >= near || db >= near || (sb - sa).abs() < 0.5 * a.distance(b) || sa == sb {
            continue;
        }
        let seen = |t: f64| {
            let p = space.ends[0].lerp(space.ends[1], t);
            camera.project(p).is_some_and(|at| !sight.hides(&camera.ray(at), p, options.slack))
        };
        if 2 * SIGHTS.iter().filter(|t| seen(**t)).count() > SIGHTS.len() {
            picked.push(PickedEdge { edge, span: [sa, sb] });
        }
    }
    picked.sort_by(|p, q| {
        (p.span[0] + p.span[1]).total_cmp(&(q.span[0] + q.span[1])).then(p.edge.cmp(&q.edge))
    });
    picked
}
