//! In which sector of a fan another fan lies.
//!
//! Seen from the node, a fan is a graph of arcs on the sphere of directions. From a direction of the other fan a path is
//! laid to an arc; the first arc that it crosses, seen from where the path comes from, tells the sector. Whether arcs are
//! crossed is decided by exact predicates; which crossing comes first by angles, and where these are too near to each
//! other another path is taken.

use glam::DVec3;

use super::fans::{Links, LocalFan};
use crate::body::radial::turn;
use crate::body::{NodeId, SurfaceId};

/// Crossings nearer than this on a path (radians) are not told apart.
const APART: f64 = 1e-9;

/// Where on an arc paths aim, and how many arcs are tried.
const AIMS: [f64; 4] = [0.5, 0.37, 0.71, 0.11];
const ARCS: usize = 64;

/// The sector of `fan` in which `other` lies, by the number that `fan` gives it; `None` where they run through each other
/// or nothing of `other` is clear of `fan`. Fans may touch along lines, as pairs of sheets do at the end of an edge that
/// has been resolved.
pub(super) fn locate(
    links: &Links,
    places: &[(SurfaceId, NodeId)],
    node: u32,
    fan: &LocalFan,
    other: &LocalFan,
) -> Option<u32> {
    let n = links.position(places, node);
    let arcs_of_fan = arcs(links, node, fan);
    let ends: Vec<DVec3> = other.ends.iter().map(|&end| links.position(places, end)).collect();
    let clear = |d: &DVec3| !arcs_of_fan.iter().any(|a| on_arc(n, a, *d));
    let mut directions: Vec<DVec3> = ends.iter().copied().filter(clear).collect();
    if directions.len() < ends.len() {
        directions.extend(arcs(links, node, other).iter().map(|a| a.p.midpoint(a.q)).filter(clear));
    }
    // Every direction of the other fan must lie in the same sector, or they run through each other.
    let mut found = None;
    for d in directions {
        let sector = sector_at(n, &arcs_of_fan, d)?;
        if *found.get_or_insert(sector) != sector {
            return None;
        }
    }
    found
}

/// An arc: a face's corner at the node, so that the face is (node, p, q).
struct Arc {
    p: DVec3,
    q: DVec3,
    sectors: [u32; 2],
}

fn arcs(links: &Links, node: u32, fan: &LocalFan) -> Vec<Arc> {
    let mut arcs = Vec::with_capacity(fan.faces.len());
    for (&f, &sectors) in fan.faces.iter().zip(&fan.sectors) {
        let (s, face) = links.face(f);
        let surface = links.body.surface(s);
        let corners = surface.faces[face.index()];
        for i in 0..3 {
            if links.welded.weld.node(s, corners[i]) == node {
                let [p, q] = [1, 2].map(|k| surface.positions[corners[(i + k) % 3] as usize]);
                arcs.push(Arc { p, q, sectors });
            }
        }
    }
    arcs
}

fn sector_at(n: DVec3, arcs: &[Arc], d: DVec3) -> Option<u32> {
    let from = (d - n).normalize_or_zero();
    for aim in AIMS {
        for a in arcs.iter().take(ARCS) {
            let [p, q] = [a.p, a.q].map(|x| (x - n).normalize_or_zero());
            let middle = (p * (1.0 - aim) + q * aim).normalize_or_zero();
            // A path of nearly half a turn has no sure direction.
            if middle.dot(from) < -0.99 {
                continue;
            }
            // Beyond the arc, so that rounding cannot make the path end before it.
            let to = n + (middle + 0.25 * (middle - from)) * (d - n).length();
            if let Some(sector) = first_crossing(n, arcs, d, to) {
                return Some(sector);
            }
        }
    }
    None
}

fn on_arc(n: DVec3, a: &Arc, d: DVec3) -> bool {
    if turn(n, a.p, a.q, d) != 0.0 {
        return false;
    }
    // In the arc's plane: inside its angle, or along one of its ends.
    let normal = (a.p - n).cross(a.q - n);
    let off = n + normal;
    let [past_p, past_q] = [turn(n, off, a.p, d), turn(n, off, d, a.q)];
    (past_p > 0.0 && past_q > 0.0) || same_direction(n, a.p, d) || same_direction(n, a.q, d)
}

fn same_direction(n: DVec3, p: DVec3, d: DVec3) -> bool {
    crate::body::radial::collinear(n, p, d) && (p - n).dot(d - n) > 0.0
}

/// The sector before the first arc that the path `d` → `to` crosses; `None` where it crosses none, or that is not sure.
fn first_crossing(n: DVec3, arcs: &[Arc], d: DVec3, to: DVec3) -> Option<u32> {
    let side = |a: DVec3, b: DVec3, c: DVec3| turn(n, a, b, c);
    let [from, beyond] = [d, to].map(|p| (p - n).normalize_or_zero());
    let plane = from.cross(beyond);
    let mut first: Option<(f64, u32)> = None;
    let mut second = f64::INFINITY;
    for a in arcs {
        let (of_d, of_to) = (side(a.p, a.q, d), side(a.p, a.q, to));
        // A path that starts in the arc's plane, but not on the arc, leaves the plane for good.
        if of_d == 0.0 {
            continue;
        }
        if of_to == 0.0 {
            return None;
        }
        let (of_p, of_q) = (side(d, to, a.p), side(d, to, a.q));
        if (of_d > 0.0) == (of_to > 0.0) {
            continue;
        }
        if of_p == 0.0 || of_q == 0.0 {
            return None;
        }
        // Arcs cross where all four triangles of their ends turn alike (else the one crosses the other's far side).
        let alike = (of_p < 0.0) == (of_d > 0.0) && (of_q > 0.0) == (of_d > 0.0);
        if !alike {
            continue;
        }
        // Of the two directions in both planes the one on the path, which is less than half a turn long.
        let line = plane.cross((a.p - n).cross(a.q - n));
        let line = if line.dot(from + beyond) < 0.0 { -line } else { line };
        let angle = from.cross(line).length().atan2(from.dot(line));
        let sector = a.sectors[usize::from(of_d < 0.0)];
        match first {
            Some((nearest, _)) if angle >= nearest => second = second.min(angle),
            _ => {
                second = first.map_or(second, |(nearest, _)| nearest);
                first = Some((angle, sector));
            }
        }
    }
    first.filter(|(angle, _)| second - angle > APART).map(|(_, sector)| sector)
}
