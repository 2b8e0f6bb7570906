//! Tips: where offsets that are not tight run past an axis that tight neighbours end at, they end where they meet.
//!
//! About the neck of a hyperboloid or the hole of a torus a ring of tight faces ends in one point of the axis, whereas the
//! faces between two of them, which narrow towards the ring, are not turned over: their offsets run a little past the axis,
//! and there all of them cross each with each, which a union resolves in a time that grows with the cube of their number.
//! The planes of such offsets meet in one point, behind the tips. It is in all of them: moved back there, they enclose the
//! same and do not cross.

use std::collections::{HashMap, HashSet};

use glam::{DMat3, DVec3};

use super::clean_sheet::CleanSheet;
use super::entities::{Entities, next, previous, use_of};
use super::half_prism::HalfPrism;
use super::offset_point::{Plane, meeting};
use super::tight::{BEYOND, End, nearer_and_nearer};

/// Farthest that a plane may miss the common point, in depths.
const MISS: f64 = 0.01;
/// Least determinant of the planes' normals' mean square for the planes to meet in one point: below this they share a line,
/// as those of a flange beside a bend do.
const POINTED: f64 = 1e-5;
/// Fewest tips that are worth it.
const FEWEST: usize = 3;

/// Makes tips one. `point` is the point of every corner. O(n).
pub(super) fn unite_tips(
    sheet: &CleanSheet,
    entities: &Entities,
    depth: &[f64],
    tight: &[bool],
    positions: &mut [DVec3],
    point: &mut [u32],
) {
    let is_tight = |c: &u32| tight[use_of(*c) as usize];
    let first = sheet.positions.len() as u32;
    // Corners of tips, those of one point together.
    let mut corners: Vec<u32> = (0..entities.disks())
        .map(|d| entities.disk(d))
        .filter(|disk| disk.iter().any(is_tight))
        .flat_map(|disk| disk.iter().copied().filter(|c| !is_tight(c)))
        .filter(|&c| point[c as usize] >= first && depth[c as usize] > 0.0)
        .collect();
    corners.sort_unstable_by_key(|&c| (point[c as usize], c));
    let tips: Vec<&[u32]> = corners.chunk_by(|a, b| point[*a as usize] == point[*b as usize]).collect();
    let ends: Vec<End> = tips
        .iter()
        .map(|tip| {
            let (at, node) = (point[tip[0] as usize], entities.node[tip[0] as usize]);
            let depth = depth[tip[0] as usize];
            End { point: at, at: positions[at as usize], node: sheet.positions[node as usize], depth }
        })
        .filter(|end| end.at != end.node)
        .collect();
    let of_point: HashMap<u32, &[u32]> = tips.iter().map(|tip| (point[tip[0] as usize], *tip)).collect();
    let mut one: HashMap<u32, u32> = HashMap::new();
    nearer_and_nearer(&ends, |cluster| {
        if cluster.len() < FEWEST {
            return true;
        }
        let own = || cluster.iter().flat_map(|&i| of_point[&ends[i as usize].point]).copied();
        let middle = cluster.iter().map(|&i| ends[i as usize].at).sum::<DVec3>() / cluster.len() as f64;
        let planes: Vec<Plane> = own()
            .map(|c| {
                let node = sheet.positions[entities.node[c as usize] as usize];
                let normal = entities.normal(sheet, c);
                let to = |c: u32| sheet.positions[entities.node[c as usize] as usize] - node;
                let weight = to(next(c)).angle_between(to(previous(c)));
                Plane { normal, depth: normal.dot(node - middle) + depth[c as usize], weight }
            })
            .collect();
        let deepest = own().map(|c| depth[c as usize]).fold(0.0, f64::max);
        let met = meeting(&planes);
        if !is_pointed(&planes) || met.residual > MISS * deepest {
            return false;
        }
        let place = middle + met.x;
        // Tips go back to where they meet; those that end before it are no tips, and would go where no material should be.
        let is_reached = cluster.iter().all(|&i| {
            let end = &ends[i as usize];
            let side = |c: u32| {
                let to = |d: u32| sheet.positions[entities.node[d as usize] as usize] - end.node;
                to(next(c)).normalize_or_zero() + to(previous(c)).normalize_or_zero()
            };
            let inward: DVec3 = of_point[&end.point].iter().map(|&c| side(c)).sum();
            (place - end.at).dot(inward.normalize_or_zero()) >= -BEYOND * end.depth
        });
        if !is_reached {
            return false;
        }
        let tips: HashSet<u32> = cluster.iter().map(|&i| ends[i as usize].point).collect();
        let moved = |p: u32| tips.contains(&p);
        // What has been made one before stays within its planes too.
        let fits = own().all(|c| {
            let u = use_of(c);
            let corners = [3 * u, 3 * u + 1, 3 * u + 2];
            let base = corners.map(|c| sheet.positions[entities.node[c as usize] as usize]);
            let top = corners.map(|c| {
                let p = point[c as usize];
                if moved(p) { place } else { positions[one.get(&p).copied().unwrap_or(p) as usize] }
            });
            HalfPrism { base, offset: std::array::from_fn(|i| top[i] - base[i]) }.is_positive()
        });
        if fits {
            let keep = ends[cluster[0] as usize].point;
            positions[keep as usize] = place;
            one.extend(cluster.iter().map(|&i| (ends[i as usize].point, keep)));
        }
        fits
    });
    for point in point.iter_mut() {
        if let Some(&keep) = one.get(point) {
            *point = keep;
        }
    }
}

/// Whether planes meet in a point rather than in a line or nowhere.
fn is_pointed(planes: &[Plane]) -> bool {
    let weight: f64 = planes.iter().map(|p| p.weight).sum();
    let square =
        |p: &Plane| DMat3::from_cols(p.normal * p.normal.x, p.normal * p.normal.y, p.normal * p.normal.z);
    let sum = planes.iter().fold(DMat3::ZERO, |sum, p| sum + square(p) * (p.weight / weight));
    sum.determinant() > POINTED
}
