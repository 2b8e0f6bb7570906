//! Offset points of all corners: those of runs; shorter ones where a half-prism would be turned over.

use glam::DVec3;
use rayon::prelude::*;

use super::clean_sheet::CleanSheet;
use super::entities::{Entities, use_of};
use super::half_prism::HalfPrism;
use super::runs::{CornerOffset, RunRules, corner_offsets};
use super::tight::{shorten, unite_ends};
use super::tips::unite_tips;

/// Offset points of neighbours nearer than this, in depths, are one point.
const SAME_POINT: f64 = 1e-9;

/// Rounds after which no run goes over a concave fold any more.
const ROUNDS: usize = 6;

/// The points that the offsets of face-uses have as corners.
#[derive(Debug)]
pub(super) struct Offsets {
    /// The sheet's nodes, then the offset points, node after node.
    pub(super) positions: Vec<DVec3>,
    /// The point of every corner; the node itself where the depth is zero.
    pub(super) point: Vec<u32>,
    /// Whether a face-use is tight: the sheet bends more tightly than its depth there.
    pub(super) tight: Vec<bool>,
    /// Nodes where a mitre was longer than the limit. Ascending.
    pub(super) long_mitres: Vec<u32>,
}

impl Offsets {
    /// Finds the offset points. O(n) on all threads, a few rounds where folds are finer than the depth.
    pub(super) fn new(
        sheet: &CleanSheet,
        entities: &Entities,
        depth: &[f64],
        mitre_limit: Option<f64>,
    ) -> Self {
        let mut tight = vec![false; 2 * sheet.faces.len()];
        let disk_of_place = disk_of_places(entities);
        let mut cut_concave = vec![false; entities.disks()];
        let mut round = 0;
        let (mut offsets, long) = loop {
            let rules = RunRules { sheet, entities, depth, mitre_limit, tight: &tight };
            let (offsets, long) = corner_offsets(rules, &|d| cut_concave[d]);
            let bad = turned_over(sheet, entities, depth, &offsets);
            let mut cut = false;
            for &u in &bad {
                for corner in 3 * u..3 * u + 3 {
                    let place = entities.place[corner as usize] as usize;
                    let disk = disk_of_place[place] as usize;
                    cut |= offsets[place].over_fold && !cut_concave[disk];
                    cut_concave[disk] |= offsets[place].over_fold;
                }
            }
            round += 1;
            if round == ROUNDS {
                cut_concave.fill(true);
            }
            let mut more = false;
            if !cut {
                // What no cut at a fold cures is tight; that its neighbours have runs of their own then may make them so.
                for &u in &bad {
                    more |= !tight[u as usize];
                    tight[u as usize] = true;
                }
            }
            if !cut && !more {
                break (offsets, long);
            }
        };
        shorten(sheet, entities, &tight, &mut offsets);
        let mut long_mitres: Vec<u32> =
            long.into_iter().map(|d| entities.node[entities.disk(d)[0] as usize]).collect();
        long_mitres.dedup();
        let (mut positions, mut point) = number_points(sheet, entities, depth, &tight, &offsets);
        unite_ends(sheet, entities, depth, &tight, &mut positions, &mut point);
        unite_tips(sheet, entities, depth, &tight, &mut positions, &mut point);
        Self { positions, point, tight, long_mitres }
    }
}

fn disk_of_places(entities: &Entities) -> Vec<u32> {
    let mut disks = vec![0; entities.disk_corners.len()];
    for d in 0..entities.disks() {
        disks[entities.disk_start[d] as usize..entities.disk_start[d + 1] as usize].fill(d as u32);
    }
    disks
}

/// Face-uses whose half-prism is turned over, or misshapen by a concave fold; ascending.
fn turned_over(sheet: &CleanSheet, entities: &Entities, depth: &[f64], offsets: &[CornerOffset]) -> Vec<u32> {
    (0..2 * sheet.faces.len() as u32)
        .into_par_iter()
        .filter(|&u| {
            let corners = [3 * u, 3 * u + 1, 3 * u + 2];
            if corners.iter().all(|&c| depth[c as usize] == 0.0) {
                return false;
            }
            let own = corners.map(|c| offsets[entities.place[c as usize] as usize]);
            let prism = HalfPrism {
                base: corners.map(|c| sheet.positions[entities.node[c as usize] as usize]),
                offset: own.map(|o| o.x),
            };
            !prism.is_positive() || (own.iter().any(|o| o.over_fold) && !prism.keeps_shape())
        })
        .collect()
}

/// Gives every run a point, shared with a neighbour in the same place.
fn number_points(
    sheet: &CleanSheet,
    entities: &Entities,
    depth: &[f64],
    tight: &[bool],
    offsets: &[CornerOffset],
) -> (Vec<DVec3>, Vec<u32>) {
    let mut positions = sheet.positions.clone();
    let mut point = vec![0; offsets.len()];
    // Runs of the disk at hand: name, offset, point.
    let mut runs: Vec<(u32, DVec3, u32)> = Vec::new();
    let mut tight_runs: Vec<u32> = Vec::new();
    for d in 0..entities.disks() {
        runs.clear();
        tight_runs.clear();
        let start = entities.disk_start[d] as usize;
        for (i, &corner) in entities.disk(d).iter().enumerate() {
            let CornerOffset { x, run, .. } = offsets[start + i];
            let node = entities.node[corner as usize];
            let known = runs.iter().rev().find(|r| r.0 == run).map(|r| r.2);
            point[corner as usize] = known.unwrap_or_else(|| {
                let near = SAME_POINT * depth[corner as usize];
                // Ends of tight offsets move on: nothing else may have their points.
                let is_tight = tight[use_of(corner) as usize];
                let neighbours = [runs.last(), runs.first()].into_iter().flatten();
                let neighbour = neighbours
                    .filter(|r| !is_tight && !tight_runs.contains(&r.0))
                    .find(|r| r.1.distance(x) <= near)
                    .copied();
                if is_tight {
                    tight_runs.push(run);
                }
                let id = match neighbour {
                    _ if x == DVec3::ZERO => node,
                    Some(neighbour) => neighbour.2,
                    None => {
                        positions.push(sheet.positions[node as usize] + x);
                        positions.len() as u32 - 1
                    }
                };
                runs.push((run, x, id));
                id
            });
        }
    }
    (positions, point)
}

impl Offsets {
    /// The top of a face-use.
    pub(super) fn top(&self, u: u32) -> [u32; 3] {
        [3 * u, 3 * u + 1, 3 * u + 2].map(|c| self.point[c as usize])
    }
}
