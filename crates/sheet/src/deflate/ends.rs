//! Groups that are no walls although they have a partner: ends of thinner walls, and sides of low things.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::looks::{Pair, partners_in};
use super::segments::Segments;
use super::solid::{SHARP, Solid};

/// A strip that is narrower than this share of its thickness is no wall.
const NARROW: f64 = 0.5;
/// What is thinner than this share of what its end would be as a wall ends there.
const THINNER: f64 = 0.9;
/// Or than so many times that, if its faces are so many times larger than the end: of a bar, those sides that go on in a plate are the wall.
const GOES_ON_AS: f64 = 2.0;
const LARGER: f64 = 3.0;
/// More than this share of an end's outline is on both sides of the wall that ends.
const MOST_OF: f64 = 0.6;
/// An end is no wider than this many times the thickness of that wall.
const AS_WIDE: f64 = 1.2;

/// What two groups that touch have in common.
#[derive(Clone, Copy, Debug)]
struct Border {
    group: u32,
    other: u32,
    /// Length in mm.
    length: f64,
    /// The length of its sharp edges that stick out, in mm.
    proud: f64,
    /// Whether an edge of it is smooth.
    is_smooth: bool,
}

/// The borders of all groups, ordered by group, then by the group beyond.
#[derive(Debug)]
pub(super) struct Borders(Vec<Border>);

impl Borders {
    /// O(n), and m log m in edges between groups.
    pub(super) fn new(solid: &Solid, segments: &Segments) -> Self {
        let border = |h: u32| {
            let [group, other] = [h / 3, solid.across(h)].map(|f| segments.of(f));
            (group != other).then(|| {
                let (length, cosine) = (solid.length(h), solid.fold_cosine(h));
                let is_proud = cosine < SHARP.cos() && solid.is_convex(h);
                let proud = if is_proud { length } else { 0.0 };
                Border { group, other, length, proud, is_smooth: cosine > SHARP.cos() }
            })
        };
        let mut all: Vec<Border> = (0..3 * solid.len()).into_par_iter().filter_map(border).collect();
        all.par_sort_by_key(|b| (b.group, b.other));
        let joined = |run: &[Border]| Border {
            length: run.iter().map(|b| b.length).sum(),
            proud: run.iter().map(|b| b.proud).sum(),
            is_smooth: run.iter().any(|b| b.is_smooth),
            ..run[0]
        };
        Self(all.chunk_by(|a, b| (a.group, a.other) == (b.group, b.other)).map(joined).collect())
    }

    fn of(&self, group: u32) -> &[Border] {
        let from = self.0.partition_point(|b| b.group < group);
        let to = self.0.partition_point(|b| b.group <= group);
        &self.0[from..to]
    }

    fn outline(&self, group: u32) -> f64 {
        self.of(group).iter().map(|b| b.length).sum()
    }
}

/// Groups with a thickness that are narrow strips and do not run into anything wider, not even over other strips: the sides of embossed
/// letters. O(n) in borders.
pub(super) fn sides_of_low_things(segments: &Segments, borders: &Borders, thick: &[Option<f64>]) -> Vec<u32> {
    let is_narrow = |(g, thick): (u32, &Option<f64>)| {
        thick.is_some_and(|thick| 2.0 * segments.group(g).area < NARROW * thick * borders.outline(g))
    };
    let mut is_side: Vec<bool> = (0..).zip(thick).map(is_narrow).collect();
    let wide = |g: &u32| thick[*g as usize].is_some() && !is_side[*g as usize];
    let mut stack: Vec<u32> = (0..thick.len() as u32).filter(wide).collect();
    while let Some(g) = stack.pop() {
        for border in borders.of(g).iter().filter(|b| b.is_smooth) {
            if std::mem::replace(&mut is_side[border.other as usize], false) {
                stack.push(border.other);
            }
        }
    }
    (0..thick.len() as u32).filter(|g| is_side[*g as usize]).collect()
}

/// Groups that are the ends of thinner walls, even if they have a partner: the sides of slats that are wider than thick. What is about
/// both of them, across sharp edges that stick out, lies opposite to each other. O(n log n) in borders, and for every
/// border of an end the pairs of what is beyond.
pub(super) fn ends_of_thinner_walls(
    segments: &Segments,
    borders: &Borders,
    pairs: &[Pair],
    thick: &[Option<f64>],
) -> Vec<u32> {
    // The length of its sharp borders that stick out, by the group beyond.
    let about = |g: u32| -> BTreeMap<u32, f64> {
        borders.of(g).iter().filter(|b| b.proud > 0.0).map(|b| (b.other, b.proud)).collect()
    };
    let surroundings: Vec<BTreeMap<u32, f64>> = (0..thick.len() as u32).map(about).collect();
    let is_end = |(g, own): (u32, f64)| {
        let (outline, beside) = (borders.outline(g), &surroundings[g as usize]);
        let area = segments.group(g).area;
        // How thick the wall is that ends here at what is beside, with its other side among `others`.
        let ending = |o: u32, others: &dyn Fn(u32) -> bool| {
            let is_larger = segments.group(o).area > LARGER * area;
            let thinner = if is_larger { GOES_ON_AS } else { THINNER } * own;
            let found = partners_in(pairs, o).iter().find(|p| p.thickness < thinner && others(p.partner));
            found.map(|p| p.thickness)
        };
        let ends = |counts: &dyn Fn(u32) -> bool| {
            let ending = beside.iter().filter(|(o, _)| counts(**o)).filter_map(|(o, length)| {
                Some((*length, ending(*o, &|other| counts(other) && beside.contains_key(&other))?))
            });
            // Both sides of the wall are counted. An end is as wide as the wall is thick; what has many holes is not.
            let (along, reach) =
                ending.fold((0.0, 0.0), |(l, r), (length, thick)| (l + length, r + length * thick / 2.0));
            along > MOST_OF * outline && area < AS_WIDE * reach
        };
        ends(&|_| true) && {
            let main = partners_in(pairs, g).iter().max_by(|p, q| p.area.total_cmp(&q.area));
            main.is_some_and(|p| ends(&|o| surroundings[p.partner as usize].contains_key(&o)))
        }
    };
    let walled = (0..).zip(thick).filter_map(|(g, t)| Some((g, (*t)?)));
    walled.filter(|wall| is_end(*wall)).map(|(g, _)| g).collect()
}
