//! Walls that came to have no mid-surface, as a whole or before a lump.
//!
//! A sheet may be without a crossing and lack a wall nevertheless: both of its sides were taken for the same one, or what was tried last had
//! no place for it. Where something solid stands on one side of a wall, that side has a hole there and the other one has none. Looks through
//! the material tell both.

use std::collections::BTreeSet;

use mesh_kernel::query::RayCaster;
use rayon::prelude::*;

use super::looks::mean_thickness;
use super::middle::Middles;
use super::segments::Segments;
use super::solid::Solid;
use super::walls::{Through, Walls};

/// Of the faces that are smaller than if the skin had so many, about so many are looked from.
const LOOKED_AT: usize = 20_000;
/// Where nothing is opposite, the middle of a wall beside is looked for in so many directions within this share of the thickness.
const AROUND: u32 = 8;
const BESIDE: f64 = 0.8;
/// A wall is bare if more than this share of it is.
const MOSTLY: f64 = 0.5;

/// What of a solid's walls has no mid-surface.
#[derive(Debug, Default)]
pub(super) struct Bare {
    /// Groups that are so for the greater part, with the area in mm².
    pub(super) walls: Vec<(u32, f64)>,
    /// Groups in one plane that are so where something thick is behind them.
    before_lumps: Vec<(u32, f64)>,
}

impl Bare {
    /// Looks for walls without a mid-surface, but for those that are gone. `sheet`: rays that its faces stop. O(log n) for each of few looks.
    pub(super) fn new(
        sheet: &RayCaster,
        solid: &Solid,
        segments: &Segments,
        walls: &Walls,
        gone: &[bool],
    ) -> Self {
        let thickness: Vec<Option<f64>> =
            (0..segments.groups.len() as u32).map(|g| mean_thickness(walls.partners(g))).collect();
        let is_bare = |look: &Through| {
            let Some(usual) = thickness[segments.of(look.face) as usize] else { return false };
            let inward = -solid.normals[look.face as usize];
            let through = look.thickness.unwrap_or(usual);
            if sheet.first(look.from, inward, 0.0, through).is_some() {
                return false;
            }
            // In the corner of two walls the middle of the other one is beside it.
            let middle = look.from + inward * (through / 2.0);
            let (x, y) = inward.any_orthonormal_pair();
            let is_beside = |k: u32| {
                let (sine, cosine) = (std::f64::consts::TAU * f64::from(k) / f64::from(AROUND)).sin_cos();
                sheet.first(middle, x * cosine + y * sine, 0.0, BESIDE * usual).is_some()
            };
            look.thickness.is_some() || !(0..AROUND).any(is_beside)
        };
        let whole: f64 = solid.areas.iter().sum();
        let every = solid.len() as usize / LOOKED_AT + 1;
        // What is seen, what of this is bare, and what is bare before lumps.
        let of_group = |g: u32| {
            let group = segments.group(g);
            let is_large = |f: &u32| solid.areas[*f as usize] * LOOKED_AT as f64 > whole;
            let (large, small): (Vec<u32>, Vec<u32>) = group.faces.iter().partition(|f| is_large(f));
            let looked_at: Vec<u32> = small.iter().copied().step_by(every).collect();
            let area = |faces: &[u32]| faces.iter().map(|f| solid.areas[*f as usize]).sum::<f64>();
            // Some of the small ones stand for all.
            let sampled = area(&looked_at);
            let share = if sampled > 0.0 { area(&small) / sampled } else { 1.0 };
            let faces = large.iter().map(|f| (*f, 1.0)).chain(looked_at.iter().map(|f| (*f, share)));
            let [mut seen, mut unseen, mut before_lump] = [0.0; 3];
            for (f, share) in faces {
                for look in walls.looks(solid, segments, f) {
                    let area = look.area * share;
                    let bare = if is_bare(&look) { area } else { 0.0 };
                    if look.thickness.is_some() {
                        seen += area;
                        unseen += bare;
                    } else if look.is_thick && group.plane.is_some() {
                        before_lump += bare;
                    }
                }
            }
            (g, [seen, unseen, before_lump])
        };
        let of_group: Vec<(u32, [f64; 3])> = (0..segments.groups.len() as u32)
            .into_par_iter()
            .filter(|g| walls.is_wall[*g as usize] && !gone[*g as usize])
            .map(of_group)
            .collect();
        // Lugs that are no wider than they are thick are ends.
        let least = walls.max_thickness * walls.max_thickness;
        let mut found = Self::default();
        for (g, [seen, unseen, before_lump]) in of_group {
            if unseen > least.max(MOSTLY * seen) {
                found.walls.push((g, unseen));
            }
            if before_lump > least {
                found.before_lumps.push((g, before_lump));
            }
        }
        found
    }

    /// All of it, in mm².
    pub(super) fn area(&self) -> f64 {
        self.walls.iter().chain(&self.before_lumps).map(|wall| wall.1).sum()
    }

    /// The groups that are kept if plane walls with lumps on their kept side are kept on the other one; `None` if there are none such.
    pub(super) fn kept_behind_lumps(
        &self,
        walls: &Walls,
        middles: &Middles,
        kept: &[bool],
    ) -> Option<Vec<bool>> {
        let mut turned = kept.to_vec();
        for &(first, _) in self.before_lumps.iter().filter(|lump| !kept[lump.0 as usize]) {
            let Some(middle) = middles.only(first) else { continue };
            let is_in_it = |g: u32| middles.only(g).is_some_and(|m| m == middle || m == middle.flipped());
            // All that lies opposite to each other in this plane.
            let mut plate = BTreeSet::from([first]);
            let mut next = vec![first];
            while let Some(g) = next.pop() {
                for partner in walls.partners(g).iter().map(|p| p.partner) {
                    if is_in_it(partner) && plate.insert(partner) {
                        next.push(partner);
                    }
                }
            }
            plate.into_iter().for_each(|g| turned[g as usize] = !kept[g as usize]);
        }
        (turned != kept).then_some(turned)
    }
}
