//! Tight places: where a sheet bends more tightly than its depth, the material ends at the axis of the bend.
//!
//! Past the axis of curvature a half-prism is turned over, and what it would fill there is nearer to another part of the
//! sheet, whose material fills it. The offsets of tight face-uses therefore end a little before the volume element vanishes;
//! then offset points that have come near each other, those of all faces about one axis or centre, are made one. What the
//! faces enclose about the axis is so closed without a crossing, whereas full half-prisms would cross there each with each.
//! A point in which offsets end is no farther from any of its nodes than the depth, so that no material lies where there
//! should be none.

use std::collections::HashMap;

use glam::DVec3;

use super::clean_sheet::CleanSheet;
use super::entities::{Entities, use_of};
use super::half_prism::HalfPrism;
use super::runs::CornerOffset;

/// Share of the volume element at the base that a tight half-prism keeps.
const LEFT: f64 = 0.03;
/// Rounds in which offsets are made shorter, each a little more where neighbours have become so.
const ROUNDS: usize = 12;
/// Least share of an offset that is left by a round.
const LEAST: f64 = 0.1;
/// Offset points within this of each other, in lengths of their offsets, are made one; those for which there is no common
/// point are looked through again for nearer neighbours, down to the least.
const ONE_POINT: f64 = 0.4;
const LEAST_ONE_POINT: f64 = ONE_POINT / 64.0;
/// How much farther from a node than its depth a common point may be, as a share: as far as the offset point of a fold that
/// is just smooth (1/cos 15°), for nearer than that offsets do meet about the axis of a bend drawn with few faces.
pub(super) const BEYOND: f64 = 0.0353;
/// How far a common point goes on past the axis, as a share of what the depth lets it: neighbours' material overlaps there.
const PAST: f64 = 0.5;

/// Makes the offsets of tight face-uses so short that none is turned over.
pub(super) fn shorten(sheet: &CleanSheet, entities: &Entities, tight: &[bool], offsets: &mut [CornerOffset]) {
    let uses: Vec<u32> = (0..tight.len() as u32).filter(|&u| tight[u as usize]).collect();
    let mut share = vec![1.0f64; offsets.len()];
    for _ in 0..ROUNDS {
        let mut less: Vec<(u32, f64)> = Vec::new();
        for &u in &uses {
            let corners = [3 * u, 3 * u + 1, 3 * u + 2];
            let own = corners.map(|c| offsets[entities.place[c as usize] as usize]);
            let prism = HalfPrism {
                base: corners.map(|c| sheet.positions[entities.node[c as usize] as usize]),
                offset: own.map(|o| share[o.run as usize] * o.x),
            };
            let height = prism.height_of_element(LEFT);
            if height < 1.0 {
                let height = height.max(LEAST);
                less.extend(own.map(|o| (o.run, height * share[o.run as usize])));
            }
        }
        if less.is_empty() {
            break;
        }
        less.iter().for_each(|&(run, s)| share[run as usize] = share[run as usize].min(s));
    }
    for &u in &uses {
        for corner in 3 * u..3 * u + 3 {
            let offset = &mut offsets[entities.place[corner as usize] as usize];
            offset.x *= share[offset.run as usize];
        }
    }
}

/// An offset point that is about to be made one with others.
pub(super) struct End {
    pub(super) point: u32,
    pub(super) at: DVec3,
    pub(super) node: DVec3,
    pub(super) depth: f64,
}

/// Makes offset points of tight face-uses that are near each other one. `point` is the point of every corner. O(n).
pub(super) fn unite_ends(
    sheet: &CleanSheet,
    entities: &Entities,
    depth: &[f64],
    tight: &[bool],
    positions: &mut [DVec3],
    point: &mut [u32],
) {
    let mut ends: Vec<End> = Vec::new();
    let mut seen = vec![false; positions.len() - sheet.positions.len()];
    let first = sheet.positions.len() as u32;
    let corners = || (0..point.len() as u32).filter(|&c| tight[use_of(c) as usize]);
    for corner in corners() {
        let id = point[corner as usize];
        if id >= first && !std::mem::replace(&mut seen[(id - first) as usize], true) {
            let (at, node) =
                (positions[id as usize], sheet.positions[entities.node[corner as usize] as usize]);
            // An offset so short that it is rounded away has no room about its end.
            if at != node {
                ends.push(End { point: id, at, node, depth: depth[corner as usize] });
            }
        }
    }
    let mut one: HashMap<u32, u32> = HashMap::new();
    nearer_and_nearer(&ends, |cluster| {
        let place = common_point(cluster.iter().map(|&i| &ends[i as usize]));
        if let Some(place) = place {
            let keep = ends[cluster[0] as usize].point;
            positions[keep as usize] = place;
            one.extend(cluster.iter().map(|&i| (ends[i as usize].point, keep)));
        }
        place.is_some()
    });
    for corner in (0..point.len()).filter(|&c| tight[c / 3]) {
        if let Some(&keep) = one.get(&point[corner]) {
            point[corner] = keep;
        }
    }
}

/// Shows ends that are near each other to `unite`; those that it refuses are looked through again for nearer ones.
pub(super) fn nearer_and_nearer(ends: &[End], mut unite: impl FnMut(&[u32]) -> bool) {
    let mut pending = vec![((0..ends.len() as u32).collect(), ONE_POINT)];
    while let Some((some, within)) = pending.pop() {
        for cluster in clusters(ends, some, within) {
            if cluster.len() > 1 && !unite(&cluster) && within > LEAST_ONE_POINT {
                pending.push((cluster, 0.5 * within));
            }
        }
    }
}

/// Some of the ends, those together that are near the first of theirs, in order.
fn clusters(ends: &[End], some: Vec<u32>, within: f64) -> Vec<Vec<u32>> {
    let mut clusters: Vec<Vec<u32>> = Vec::new();
    // Cells are as wide as the cluster's radius, which is rounded to a power of two.
    let mut cells: HashMap<(i32, [i64; 3]), Vec<u32>> = HashMap::new();
    for i in some {
        let end = &ends[i as usize];
        let radius = within * end.at.distance(end.node);
        let level = radius.log2().ceil() as i32;
        let near = (level - 1..=level + 1).flat_map(|level| {
            let width = f64::from(level).exp2();
            let [x, y, z] = (end.at / width).floor().to_array().map(|v| v as i64);
            (0..27).map(move |k| (level, [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]))
        });
        let first = near.filter_map(|cell| cells.get(&cell)).flatten().copied().find(|&c| {
            let seed = &ends[clusters[c as usize][0] as usize];
            let radius = radius.min(within * seed.at.distance(seed.node));
            seed.at.distance(end.at) <= radius
        });
        match first {
            Some(cluster) => clusters[cluster as usize].push(i),
            None => {
                let width = f64::from(level).exp2();
                let cell = (end.at / width).floor().to_array().map(|v| v as i64);
                cells.entry((level, cell)).or_default().push(clusters.len() as u32);
                clusters.push(vec![i]);
            }
        }
    }
    clusters
}

/// Where ends meet: past their middle in the mean direction of their offsets, within the depth of every node.
fn common_point<'a>(ends: impl Iterator<Item = &'a End> + Clone) -> Option<DVec3> {
    let count = ends.clone().count() as f64;
    let middle = ends.clone().map(|e| e.at).sum::<DVec3>() / count;
    let along = ends.clone().map(|e| (e.at - e.node).normalize_or_zero()).sum::<DVec3>() / count;
    let within = ends.clone().all(|e| middle.distance(e.node) <= (1.0 + BEYOND) * e.depth);
    let left = ends.map(|e| e.depth - middle.distance(e.node)).fold(f64::INFINITY, f64::min);
    within.then(|| middle + PAST * left.max(0.0) * along)
}
