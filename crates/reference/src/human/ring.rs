//! Outlines in a horizontal plane: gaps closed, inner pockets dropped, hulls, extreme points.

use mesh_kernel::glam::{DVec2, DVec3};
use mesh_kernel::query::SectionLoop;

/// Most open chains of one section that are joined.
const MOST_CHAINS: usize = 48;

/// A closed outline in the plane; `x` is the body's left, `y` its front. Runs anticlockwise seen from above, that is
/// from the front over the left to the back.
#[derive(Clone, Debug)]
pub(crate) struct Ring {
    pub(crate) points: Vec<DVec2>,
    pub(crate) area: f64,
    pub(crate) centroid: DVec2,
    pub(crate) lo: DVec2,
    pub(crate) hi: DVec2,
}

impl Ring {
    /// `None` for less than three points or no area.
    pub(crate) fn new(mut points: Vec<DVec2>) -> Option<Self> {
        if points.len() < 3 {
            return None;
        }
        let o = points[0];
        let mut twice = 0.0;
        let mut moment = DVec2::ZERO;
        let (mut lo, mut hi) = (o, o);
        for i in 0..points.len() {
            let (a, b) = (points[i] - o, points[(i + 1) % points.len()] - o);
            let c = a.perp_dot(b);
            twice += c;
            moment += (a + b) * c;
            lo = lo.min(points[i]);
            hi = hi.max(points[i]);
        }
        if twice.abs() < 1e-9 {
            return None;
        }
        let centroid = o + moment / (3.0 * twice);
        // Front to left is clockwise in (left, front) coordinates.
        if twice > 0.0 {
            points.reverse();
        }
        Some(Self { points, area: twice.abs() / 2.0, centroid, lo, hi })
    }

    /// The smallest convex outline around it: what a taut tape follows.
    pub(crate) fn hull(&self) -> Vec<DVec2> {
        hull(&self.points)
    }

    /// Length of the taut tape.
    pub(crate) fn tape(&self) -> f64 {
        perimeter(&self.hull())
    }

    /// What lies within `x * side <= reach` (Sutherland and Hodgman).
    pub(crate) fn cut_off(&self, side: f64, reach: f64) -> Option<Self> {
        let n = self.points.len();
        let over = |p: DVec2| p.x * side - reach;
        let mut kept = Vec::with_capacity(n + 4);
        for i in 0..n {
            let (a, b) = (self.points[i], self.points[(i + 1) % n]);
            if over(a) <= 0.0 {
                kept.push(a);
            }
            if (over(a) <= 0.0) != (over(b) <= 0.0) {
                kept.push(a.lerp(b, over(a) / (over(a) - over(b))));
            }
        }
        Self::new(kept)
    }

    /// Whether the point lies inside (even-odd).
    pub(crate) fn contains(&self, p: DVec2) -> bool {
        let mut inside = false;
        let n = self.points.len();
        for i in 0..n {
            let (a, b) = (self.points[i], self.points[(i + 1) % n]);
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                inside = !inside;
            }
        }
        inside
    }

    /// Reverses left and front: the ring seen after a half turn about the vertical.
    pub(crate) fn half_turn(&mut self) {
        for p in &mut self.points {
            *p = -*p;
        }
        self.centroid = -self.centroid;
        (self.lo, self.hi) = (-self.hi, -self.lo);
    }
}

/// Smallest and largest front coordinate where the outline crosses the line `x = at`.
pub(crate) fn depth_at(points: &[DVec2], at: f64) -> Option<[f64; 2]> {
    extent_across(points, at, |p| (p.x, p.y))
}

/// Smallest and largest left coordinate where the outline crosses the line `front = at`.
pub(crate) fn breadth_at(points: &[DVec2], at: f64) -> Option<[f64; 2]> {
    extent_across(points, at, |p| (p.y, p.x))
}

fn extent_across(points: &[DVec2], at: f64, split: impl Fn(DVec2) -> (f64, f64)) -> Option<[f64; 2]> {
    let mut out: Option<[f64; 2]> = None;
    for i in 0..points.len() {
        let (a, b) = (split(points[i]), split(points[(i + 1) % points.len()]));
        if (a.0 >= at) == (b.0 >= at) {
            continue;
        }
        let v = a.1 + (at - a.0) / (b.0 - a.0) * (b.1 - a.1);
        out = Some(out.map_or([v, v], |[lo, hi]| [lo.min(v), hi.max(v)]));
    }
    out
}

/// Convex hull, from front over left to back; no repeated first point. O(n log n).
pub(crate) fn hull(points: &[DVec2]) -> Vec<DVec2> {
    let mut p: Vec<DVec2> = points.to_vec();
    p.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    p.dedup();
    if p.len() < 3 {
        return p;
    }
    let mut out: Vec<DVec2> = Vec::with_capacity(p.len());
    for pass in 0..2 {
        let floor = out.len() + 1;
        for k in 0..p.len() {
            let q = if pass == 0 { p[k] } else { p[p.len() - 1 - k] };
            while out.len() > floor {
                let n = out.len();
                if (out[n - 1] - out[n - 2]).perp_dot(q - out[n - 2]) > 0.0 {
                    break;
                }
                out.pop();
            }
            out.push(q);
        }
        out.pop();
    }
    out.reverse();
    out
}

/// Length of a closed outline.
pub(crate) fn perimeter(points: &[DVec2]) -> f64 {
    (0..points.len()).map(|i| points[i].distance(points[(i + 1) % points.len()])).sum()
}

/// How chains that end at holes of the skin are closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Gaps {
    /// The two nearest free ends are joined, again and again.
    Join,
    /// Every chain closes on itself: nothing is taken for joined that is not seen to be.
    Part,
}

/// Outer outlines of a section, largest first. Chains shorter than `dust` and outlines inside others (mouth, eye
/// sockets) are dropped.
pub(crate) fn outer_rings(
    section: &[SectionLoop],
    dust: f64,
    gaps: Gaps,
    flat: impl Fn(DVec3) -> DVec2,
) -> Vec<Ring> {
    let mut rings = Vec::new();
    let mut open: Vec<Vec<DVec2>> = Vec::new();
    for l in section {
        let points: Vec<DVec2> = l.points.iter().map(|p| flat(*p)).collect();
        if l.closed {
            rings.extend(Ring::new(points).filter(|r| (r.hi - r.lo).max_element() > dust));
        } else if points.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>() > dust {
            open.push(points);
        }
    }
    let whole = match gaps {
        Gaps::Join => join_chains(open),
        Gaps::Part => open,
    };
    rings.extend(whole.into_iter().filter_map(Ring::new));
    rings.sort_by(|a, b| b.area.total_cmp(&a.area));
    let mut outer: Vec<Ring> = Vec::new();
    for r in rings {
        if !outer.iter().any(|o| o.lo.cmple(r.lo).all() && o.hi.cmpge(r.hi).all() && o.contains(r.points[0]))
        {
            outer.push(r);
        }
    }
    outer
}

/// Joins the two nearest free ends again and again. A chain's own ends count as nearer by a third: a limb with a hole
/// in its side closes on itself rather than on its neighbour.
fn join_chains(mut open: Vec<Vec<DVec2>>) -> Vec<Vec<DVec2>> {
    // Torn meshes have crumbs without number; the longest chains carry the outline.
    open.sort_by_key(|chain| std::cmp::Reverse(chain.len()));
    open.truncate(MOST_CHAINS);
    let mut done = Vec::new();
    while !open.is_empty() {
        let mut best = (f64::INFINITY, 0, 0, false, false);
        for i in 0..open.len() {
            let (a0, a1) = (open[i][0], open[i][open[i].len() - 1]);
            let own = a0.distance(a1) * 0.67;
            if own < best.0 {
                best = (own, i, i, false, false);
            }
            for (j, other) in open.iter().enumerate().skip(i + 1) {
                let (b0, b1) = (other[0], other[other.len() - 1]);
                for (d, flip_a, flip_b) in [
                    (a1.distance(b0), false, false),
                    (a1.distance(b1), false, true),
                    (a0.distance(b0), true, false),
                    (a0.distance(b1), true, true),
                ] {
                    if d < best.0 {
                        best = (d, i, j, flip_a, flip_b);
                    }
                }
            }
        }
        let (_, i, j, flip_a, flip_b) = best;
        if i == j {
            done.push(open.remove(i));
            continue;
        }
        let mut second = open.remove(j);
        if flip_b {
            second.reverse();
        }
        if flip_a {
            open[i].reverse();
        }
        open[i].extend(second);
    }
    done
}
