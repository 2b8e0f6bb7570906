//! Looks through the material from everywhere, and what they tell: which groups lie opposite to each other, and how thick walls are.

use rayon::prelude::*;

use super::ends::{Borders, ends_of_thinner_walls, sides_of_low_things};
use super::regions::width;
use super::segments::Segments;
use super::solid::Solid;

/// Thicknesses of one part differ from one to the next by no more than this factor; what is beyond is not thickness but
/// the part's extent.
const THICKNESS_GAP: f64 = 2.5;
/// Where this share of all is thinner, a smaller factor is enough: the rest is lumps and heights of ribs.
const NEARLY_ALL: f64 = 0.9;
const SMALL_GAP: f64 = 1.6;
/// Thicknesses are known to this share of them: walls are often just so many times as thick as others.
const ROUNDING: f64 = 1e-5;
/// What is broad tells the thickness if it has more than this share of what looks at something.
const BROAD: f64 = 0.4;
/// A thickness told from the solid is no more than this share of how far its walls reach.
const SLENDER: f64 = 0.35;
/// What is told is a little more than what was seen.
const MARGIN: f64 = 1.02;
/// A wall is a plate whatever the others are if it has this share of the skin, is less thick than this share of its width,
/// and evenly so up to this share.
const PLATE: f64 = 0.02;
const FLAT: f64 = 0.2;
const PLATE_ALIKE: f64 = 0.2;

/// A look through the material from a point of a group that met another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    pub(super) group: u32,
    pub(super) partner: u32,
    /// How far through the material, in mm.
    pub(super) thickness: f64,
    /// The part of the group that it stands for, in mm².
    pub(super) area: f64,
}

/// Two groups that lie opposite to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pair {
    /// The group that was looked from.
    pub(super) group: u32,
    /// The one that was seen.
    pub(super) partner: u32,
    /// Area of `group` from which `partner` is seen, in mm².
    pub(super) area: f64,
    /// Mean distance in mm.
    pub(super) thickness: f64,
}

/// Looks ordered by group, then by partner, then by thickness.
#[derive(Debug)]
pub(super) struct Looks(Vec<Look>);

impl Looks {
    /// O(n log n).
    pub(super) fn new(mut looks: Vec<Look>) -> Self {
        // Thicknesses are compared by their bits: they are not negative.
        let key = |l: &Look| {
            (u64::from(l.group) << 32 | u64::from(l.partner), l.thickness.to_bits(), l.area.to_bits())
        };
        looks.par_sort_unstable_by_key(key);
        Self(looks)
    }

    /// Leaves out those farther than a thickness. O(n).
    pub(super) fn retain_within(&mut self, thickness: f64) {
        self.0.retain(|look| look.thickness <= thickness);
    }

    /// The area from which something is seen, in mm².
    pub(super) fn area(&self) -> f64 {
        self.0.iter().map(|look| look.area).sum()
    }

    /// The pairs that they make, ordered by group, then by partner. O(n).
    pub(super) fn pairs(&self) -> Vec<Pair> {
        let pair = |run: &[Look]| {
            let area = area_of(run);
            let thickness =
                run.iter().map(|l| l.area * l.thickness).sum::<f64>() / area.max(f64::MIN_POSITIVE);
            Pair { group: run[0].group, partner: run[0].partner, area, thickness }
        };
        self.0.chunk_by(is_one_pair).map(pair).collect()
    }

    /// Walls are thinner than this, in mm. O(n log n).
    pub(super) fn told_thickness(&self, solid: &Solid, segments: &Segments, borders: &Borders) -> f64 {
        let total: f64 = solid.areas.iter().sum();
        let told = told_thickness(&self.broad(segments, borders), total);
        self.thick_plates(solid, segments, total).into_iter().fold(told, f64::max)
    }

    /// Thicknesses and areas of looks from what is no end of a wall and no side of something low, the thinnest first. Where hardly
    /// anything else is, as in a block, from everywhere.
    fn broad(&self, segments: &Segments, borders: &Borders) -> Vec<(f64, f64)> {
        let pairs = self.pairs();
        let thick: Vec<Option<f64>> =
            (0..segments.groups.len() as u32).map(|g| mean_thickness(partners_in(&pairs, g))).collect();
        let mut is_broad = vec![true; thick.len()];
        let ends = ends_of_thinner_walls(segments, borders, &pairs, &thick);
        for g in sides_of_low_things(segments, borders, &thick).into_iter().chain(ends) {
            is_broad[g as usize] = false;
        }
        let broad = || self.0.iter().filter(|l| is_broad[l.group as usize]);
        let is_enough = broad().map(|l| l.area).sum::<f64>() > BROAD * self.area();
        let seen = |look: &Look| (look.thickness, look.area);
        let mut seen: Vec<(f64, f64)> =
            if is_enough { broad().map(seen).collect() } else { self.0.iter().map(seen).collect() };
        seen.par_sort_unstable_by_key(|s| (s.0.to_bits(), s.1.to_bits()));
        seen
    }

    /// How thick walls are that are much broader than thick, evenly so, and not just a trifle of the skin, whatever the rest is: the base
    /// below thin fins, the thick end of a tube, a plate that forks.
    fn thick_plates(&self, solid: &Solid, segments: &Segments, total: f64) -> Vec<f64> {
        let wide = |g: u32| width(solid, &segments.group(g).faces);
        // Most of a group, or what two have of each other; `of` is its area, `broad` how wide it is.
        let plate = |run: &[Look], of: f64, broad: &dyn Fn() -> f64| {
            let half = area_of(run) / 2.0;
            let mut sum = 0.0;
            let middle = run.iter().find(|l| {
                sum += l.area;
                sum >= half
            })?;
            let middle = middle.thickness;
            let alike = run.iter().filter(|l| (l.thickness - middle).abs() < PLATE_ALIKE * middle);
            let is_plate =
                alike.map(|l| l.area).sum::<f64>() >= 0.5 * of && middle < FLAT * of.sqrt().min(broad());
            is_plate.then_some(MARGIN * middle)
        };
        let of_group = |run: &[Look]| {
            let g = run[0].group;
            let mut plates = Vec::new();
            let mut others: Vec<Look> = Vec::new();
            for run in run.chunk_by(is_one_pair).filter(|run| run[0].partner != g) {
                let area = area_of(run);
                if area >= PLATE * total {
                    plates.extend(plate(run, area, &|| wide(g).min(wide(run[0].partner))));
                }
                others.extend(run);
            }
            let area = segments.group(g).area;
            if area >= PLATE * total {
                others.sort_unstable_by_key(|l| (l.thickness.to_bits(), l.area.to_bits()));
                plates.extend(plate(&others, area, &|| wide(g)));
            }
            plates
        };
        let runs: Vec<&[Look]> = self.0.chunk_by(|a, b| a.group == b.group).collect();
        runs.into_par_iter().flat_map_iter(of_group).collect()
    }
}

fn is_one_pair(a: &Look, b: &Look) -> bool {
    (a.group, a.partner) == (b.group, b.partner)
}

fn area_of(looks: &[Look]) -> f64 {
    looks.iter().map(|look| look.area).sum()
}

/// The largest thickness, told from looks and their areas: the median one, and what follows on it without a gap.
fn told_thickness(seen: &[(f64, f64)], area: f64) -> f64 {
    let all: f64 = seen.iter().map(|s| s.1).sum();
    let (mut sum, mut largest) = (0.0, 0.0);
    for (thickness, part) in seen {
        let gap = if sum >= NEARLY_ALL * all { SMALL_GAP } else { THICKNESS_GAP };
        if sum >= 0.4 * all && *thickness > gap * (1.0 + ROUNDING) * largest {
            break;
        }
        largest = *thickness;
        sum += part;
    }
    // Walls that are seen from both sides cover half of the skin.
    (MARGIN * largest).min(SLENDER * (area / 2.0).sqrt())
}

/// The pairs that begin with a group, of pairs that are ordered by it.
pub(super) fn partners_in(pairs: &[Pair], group: u32) -> &[Pair] {
    let from = pairs.partition_point(|p| p.group < group);
    let to = pairs.partition_point(|p| p.group <= group);
    &pairs[from..to]
}

/// The mean thickness of pairs, by area; `None` if they have none.
pub(super) fn mean_thickness(pairs: &[Pair]) -> Option<f64> {
    let area: f64 = pairs.iter().map(|p| p.area).sum();
    (area > 0.0).then(|| pairs.iter().map(|p| p.area * p.thickness).sum::<f64>() / area)
}
