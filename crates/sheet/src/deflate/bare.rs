//! Walls that came to have no mid-surface, as a whole or before a lump.
//!
//! A sheet may be without a crossing and lack a wall nevertheless: both of its sides were taken for the same one, or what was tried last had
//! no place for it. Where something solid stands on one side of a wall, that side has a hole there and the other one has none. Looks through
//! the material tell both.

use std::collections::{BTreeMap, BTreeSet};

use mesh_kernel::TriMesh;
use mesh_kernel::query::ClosestPoint;
use rayon::prelude::*;

use super::assemble::Sheet;
use super::looks::mean_thickness;
use super::middle::Middles;
use super::segments::Segments;
use super::solid::Solid;
use super::walls::{Through, Walls};

/// About so many faces are looked through.
const LOOKED_AT: usize = 20_000;
/// The sheet is within this share of a wall's thickness of its middle, or it is not there.
const WITHIN: f64 = 0.5;
/// The same where the thickness is not seen: corners of walls have their middles aside.
const WITHIN_LUMP: f64 = 0.75;
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
    /// Looks for walls without a mid-surface, but for those that are gone. O(log n) in faces of the sheet for each of few looks, and O(n log n).
    pub(super) fn new(
        sheet: &Sheet,
        solid: &Solid,
        segments: &Segments,
        walls: &Walls,
        gone: &[bool],
    ) -> Self {
        let closest = ClosestPoint::new(&TriMesh::new(sheet.positions.clone(), sheet.faces.clone()));
        let every = solid.len() as usize / LOOKED_AT + 1;
        let thickness: Vec<Option<f64>> =
            (0..segments.groups.len() as u32).map(|g| mean_thickness(walls.partners(g))).collect();
        let is_bare = |look: &Through| {
            let group = segments.of(look.face);
            let (thickness, within) = match (look.thickness, thickness[group as usize]) {
                (Some(thickness), _) => (thickness, WITHIN),
                (None, Some(thickness)) => (thickness, WITHIN_LUMP),
                _ => return false,
            };
            let middle = look.from - solid.normals[look.face as usize] * (thickness / 2.0);
            closest.closest_within(middle, within * thickness).is_none()
        };
        let looks: Vec<(Through, bool)> =
            walls.looks(solid, segments, every).map(|look| (look, is_bare(&look))).collect();
        // What is seen, what of this is bare, and what is bare before lumps.
        let mut of_group: BTreeMap<u32, [f64; 3]> = BTreeMap::new();
        for (look, is_bare) in looks {
            let group = segments.of(look.face);
            let area = look.area * every as f64;
            let bare = if is_bare { area } else { 0.0 };
            let [seen, unseen, before_lump] = of_group.entry(group).or_default();
            if look.thickness.is_some() {
                *seen += area;
                *unseen += bare;
            } else if look.is_thick && segments.group(group).plane.is_some() {
                *before_lump += bare;
            }
        }
        of_group.retain(|g, _| !gone[*g as usize]);
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

    /// Area in mm².
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
