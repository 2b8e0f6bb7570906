//! What facets of a skin say: where they go, and on which side of the wall they are.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap, VecDeque};

use glam::DVec3;
use rayon::prelude::*;

use super::super::seams::Merged;
use super::super::sides::Parity;
use super::super::solid::{SHARP, Solid};
use super::super::walls::{Walls, spread};

/// Opposite facets are parallel up to this, in radians.
const PARALLEL: f64 = 0.5 / 180.0 * std::f64::consts::PI;
/// Facets in one plane turn by less than this, in radians.
const FLAT: f64 = 1e-4;
/// A facet is looked through from the square of this many points.
const ROWS: u32 = 3;
/// A side of the wall goes on across proud edges as long as they are not sharp, and across hollow ones that fold by less than this,
/// in radians: rounds are proud.
const SLIGHT: f64 = 15.0 / 180.0 * std::f64::consts::PI;
/// The wall is as thick everywhere, up to this share.
const EVEN: f64 = 0.04;
/// A facet is no smaller than this share of what is opposite to it.
const SHARD: f64 = 0.1;
/// This share of the skin has an opposite facet; else it is no sheet made thick.
const SURE: f64 = 0.6;

/// What is known of a facet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    /// The plane that it goes to.
    pub(super) normal: DVec3,
    offset: f64,
    /// How thick the wall is there, in mm.
    pub(super) thickness: f64,
    /// Whether that is known, not just supposed after its neighbours: it has an opposite facet or is a lone one.
    pub(super) is_sure: bool,
    /// The opposite one, or if there is none, the neighbour that told.
    pub(super) seen: u32,
}

impl Facet {
    /// How far a place is from where the facet goes, in mm.
    pub(super) fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(p) - self.offset
    }
}

/// Facets with an opposite one as far away as usual, and others beside them on the same side; ends of walls are neither. And all that
/// have an opposite one, however far. O(n log n).
pub(super) fn facets(solid: &Solid, walls: &Walls) -> (Vec<Option<Facet>>, Vec<u32>) {
    let flat = flat_parts(solid);
    let look = |f: u32| {
        let normal = solid.normals[f as usize];
        let looks = spread(solid.mesh.corners(f), ROWS).filter_map(move |p| {
            let seen = walls.first(solid, p, -normal)?;
            let other = solid.normals[seen.face as usize];
            let middle = (normal - other).normalize_or_zero();
            // Looked along the normal, the way to the middle is half of that through.
            let offset = middle.dot(p - normal * (seen.distance / 2.0));
            let facet =
                Facet { normal: middle, offset, thickness: seen.distance, is_sure: true, seen: seen.face };
            let lean = normal.distance(-other);
            (lean < PARALLEL).then_some((lean, facet))
        });
        looks.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let looks: Vec<Option<(f64, Facet)>> = (0..solid.len()).into_par_iter().map(look).collect();
    // The look with the least lean of all facets in one plane.
    let mut best: Vec<Option<(f64, Facet)>> = vec![None; flat.len()];
    for (look, part) in looks.into_iter().zip(&flat) {
        let slot = &mut best[*part as usize];
        if let Some(look) = look
            && slot.is_none_or(|b| look.0 < b.0)
        {
            *slot = Some(look);
        }
    }
    let usual = usual_thickness(solid, flat.iter().map(|part| best[*part as usize].map(|b| b.1.thickness)));
    let mut areas = vec![0.0; flat.len()];
    flat.iter().zip(&solid.areas).for_each(|(part, area)| areas[*part as usize] += area);
    let of_part = |part: &u32| {
        let facet = best[*part as usize].map(|b| b.1)?;
        // Chords of rounds happen to be parallel to what is behind them.
        let is_shard = areas[*part as usize] < SHARD * areas[flat[facet.seen as usize] as usize];
        (!is_shard).then_some(facet)
    };
    let opposed: Vec<Option<Facet>> = flat.iter().map(of_part).collect();
    let paired = (0..solid.len()).filter(|f| opposed[*f as usize].is_some()).collect();
    let is_usual = |facet: &Facet| (facet.thickness - usual).abs() < EVEN * usual;
    let mut known: Vec<Option<Facet>> = opposed.into_iter().map(|facet| facet.filter(is_usual)).collect();
    let mut queue: VecDeque<u32> = (0..solid.len()).filter(|f| known[*f as usize].is_some()).collect();
    while let Some(f) = queue.pop_front() {
        let Some(Facet { thickness, .. }) = known[f as usize] else { continue };
        for h in 3 * f..3 * f + 3 {
            let other = solid.across(h);
            if known[other as usize].is_none() && runs_on(solid, h) {
                let normal = solid.normals[other as usize];
                let offset = normal.dot(solid.centroid(other)) - thickness / 2.0;
                known[other as usize] = Some(Facet { normal, offset, thickness, is_sure: false, seen: f });
                queue.push_back(other);
            }
        }
    }
    (known, paired)
}

/// The thickness in the middle of all, each facet for its area.
fn usual_thickness(solid: &Solid, thickness: impl Iterator<Item = Option<f64>>) -> f64 {
    let mut all: Vec<(f64, f64)> =
        thickness.zip(&solid.areas).filter_map(|(t, area)| Some((t?, *area))).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = all.iter().map(|t| t.1).sum::<f64>() / 2.0;
    let mut sum = 0.0;
    let middle = all.iter().find(|(_, area)| {
        sum += area;
        sum >= half
    });
    middle.map_or(0.0, |t| t.0)
}

/// Of every facet, a number for the part of the skin in one plane that it belongs to. O(n log n).
pub(super) fn flat_parts(solid: &Solid) -> Vec<u32> {
    let mut merged = Merged::new(solid.len() as usize);
    for h in 0..3 * solid.len() {
        let other = solid.across(h);
        if solid.normals[h as usize / 3].distance(solid.normals[other as usize]) < FLAT {
            merged.join(h / 3, other);
        }
    }
    (0..solid.len()).map(|f| merged.find(f)).collect()
}

/// Whether a side of the wall goes on across an edge.
fn runs_on(solid: &Solid, h: u32) -> bool {
    let most = if solid.is_convex(h) { SHARP } else { SLIGHT };
    solid.fold_cosine(h) > most.cos()
}

/// Rounds go where the facets beside their longest edges go. O(n log n).
pub(super) fn grow(solid: &Solid, facets: &mut [Option<Facet>], sides: &Sides) {
    // Lengths are compared by their bits: they are not negative.
    let mut queue: BinaryHeap<(u64, Reverse<u32>, u32)> = BinaryHeap::new();
    let is_open = |f: u32, facets: &[Option<Facet>]| facets[f as usize].is_some_and(|facet| !facet.is_sure);
    let push = |f: u32, facets: &[Option<Facet>], queue: &mut BinaryHeap<(u64, Reverse<u32>, u32)>| {
        for h in 3 * f..3 * f + 3 {
            let other = solid.across(h);
            if sides.of(other) == sides.of(f) && is_open(other, facets) {
                queue.push((solid.length(h).to_bits(), Reverse(other), f));
            }
        }
    };
    for f in (0..solid.len()).filter(|f| facets[*f as usize].is_some_and(|facet| facet.is_sure)) {
        push(f, facets, &mut queue);
    }
    while let Some((_, Reverse(f), from)) = queue.pop() {
        if is_open(f, facets) {
            facets[f as usize] = facets[from as usize];
            push(f, facets, &mut queue);
        }
    }
}

/// The two sides of a wall.
#[derive(Debug)]
pub(super) struct Sides {
    /// Of every facet; ends have none.
    of: Vec<Option<bool>>,
    /// The larger one.
    main: bool,
    /// How thick the wall is, in mm.
    pub(super) thickness: f64,
}

impl Sides {
    /// Tells the sides apart, if there are two and they are as far from each other everywhere. O(n log n).
    pub(super) fn new(solid: &Solid, facets: &[Option<Facet>]) -> Option<Self> {
        let n = solid.len();
        let is_sure = |f: u32| facets[f as usize].is_some_and(|f| f.is_sure);
        let sure: Vec<u32> = (0..n).filter(|f| is_sure(*f)).collect();
        let mut parity = Parity::new(n as usize);
        for &f in &sure {
            let opposite = facets[f as usize].map_or(f, |facet| facet.seen);
            let beside = (3 * f..3 * f + 3).map(|h| solid.across(h)).filter(|other| is_sure(*other));
            for (other, is_opposite) in beside.map(|other| (other, false)).chain([(opposite, true)]) {
                if !parity.relate(f, other, is_opposite) {
                    return None;
                }
            }
        }
        // Facets that happen to see each other far from all others are of no side.
        let mut areas: BTreeMap<u32, f64> = BTreeMap::new();
        for &f in &sure {
            *areas.entry(parity.find(f).0).or_default() += solid.areas[f as usize];
        }
        let (root, area) = areas.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        if area < SURE * solid.areas.iter().sum::<f64>() {
            return None;
        }
        let mut queue: VecDeque<u32> = sure.into_iter().filter(|f| parity.find(*f).0 == root).collect();
        let mut of = vec![None; n as usize];
        queue.iter().for_each(|f| of[*f as usize] = Some(parity.find(*f).1));
        while let Some(f) = queue.pop_front() {
            for h in 3 * f..3 * f + 3 {
                let other = solid.across(h) as usize;
                if of[other].is_none() && facets[other].is_some() && runs_on(solid, h) {
                    of[other] = of[f as usize];
                    queue.push_back(other as u32);
                }
            }
        }
        let area = |side: bool| -> f64 {
            let own = of.iter().zip(&solid.areas).filter(|(of, _)| **of == Some(side));
            own.map(|(_, area)| area).sum()
        };
        let main = area(true) > area(false);
        let thickness =
            usual_thickness(solid, facets.iter().map(|f| f.filter(|f| f.is_sure).map(|f| f.thickness)));
        Some(Self { of, main, thickness })
    }

    /// The side that a facet is on; ends are on none.
    pub(super) fn of(&self, f: u32) -> Option<bool> {
        self.of[f as usize]
    }

    /// Whether a facet is on the larger side.
    pub(super) fn is_main(&self, f: u32) -> bool {
        self.of[f as usize] == Some(self.main)
    }
}
