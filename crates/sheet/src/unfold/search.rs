//! The search for bends whose flat sheet does not lie on itself.
//!
//! Every spanning forest of the facets is a way to cut and bend. The first one tried bends long lines rather than short ones, and
//! those that stay flat before all: that keeps welds short. Where its flat sheet overlaps, single joins are exchanged as long
//! as fewer facets overlap; then other forests are tried. The sequence of tries is fixed: same sheet, same answer.

use super::UnfoldError;
use super::layout::{Flattening, Layout};
use crate::bends::Join;
use crate::bends::forest::{Forest, PerLine, Tree, largest_forest};

/// How long is searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Flat sheets tried, at most.
    pub layouts: usize,
    /// Times facets of them, so that large sheets do not take for ever.
    pub facets: usize,
}

impl Default for Effort {
    fn default() -> Self {
        Self { layouts: 4000, facets: 120_000 }
    }
}

/// What was found.
pub(crate) struct Found {
    pub(crate) forest: Forest,
    pub(crate) layout: Layout,
    /// Pairs of facets that lie on each other.
    pub(crate) overlaps: Vec<[u32; 2]>,
    /// Flat sheets tried.
    pub(crate) tried: usize,
}

/// A fixed sequence of numbers in 0..1.
pub(crate) struct Dice(u64);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub(crate) fn throw(&mut self) -> f64 {
        // Xorshift of 64 bits (Marsaglia 2003).
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

pub(crate) struct Search<'a> {
    pub(crate) flat: &'a Flattening<'a>,
    pub(crate) per_line: PerLine,
    /// Size of a forest that spans all components.
    pub(crate) enough: usize,
    budget: usize,
    tried: usize,
}

impl<'a> Search<'a> {
    pub(crate) fn new(flat: &'a Flattening<'a>, per_line: PerLine, enough: usize, effort: Effort) -> Self {
        let facets = flat.sheet.facets.len().max(1);
        let budget = effort.layouts.min(effort.facets / facets).max(8);
        Self { flat, per_line, enough, budget, tried: 0 }
    }

    /// Joins that can be bent, in the order of a try: 0 is by length, others are shuffled more and more.
    pub(crate) fn order(&self, attempt: usize) -> Vec<u32> {
        let joins = self.flat.joins;
        let mut dice = Dice::new(attempt as u64 + 1);
        let spread = (attempt as f64 / 8.0).min(4.0);
        let mut keyed: Vec<(f64, u32)> = (0..joins.len() as u32)
            .filter(|&j| self.flat.measures[j as usize].is_some())
            .map(|j| (self.worth(j) * (spread * (dice.throw() - 0.5)).exp(), j))
            .collect();
        keyed.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        keyed.into_iter().map(|x| x.1).collect()
    }

    /// How much is saved by bending a join instead of welding it: its length, and all the work where it stays flat.
    fn worth(&self, j: u32) -> f64 {
        let length = self.flat.sheet.lines[self.flat.joins[j as usize].line as usize].length;
        let flat = self.flat.measures[j as usize].is_some_and(|m| m.measures.angle == 0.0);
        if flat { length * 100.0 } else { length }
    }

    /// Looks for a largest forest whose flat sheet does not lie on itself; gives the one with the fewest overlaps.
    pub(crate) fn run(&mut self) -> Result<Found, UnfoldError> {
        let mut best: Option<Found> = None;
        let mut failed = None;
        for attempt in 0.. {
            let forest = largest_forest(
                self.flat.joins,
                self.flat.sheet.facets.len(),
                &self.order(attempt),
                self.per_line,
                self.enough,
            );
            match self.mend(forest) {
                Ok(found) => {
                    let better = best.as_ref().is_none_or(|b| found.overlaps.len() < b.overlaps.len());
                    if better {
                        best = Some(found);
                    }
                }
                Err(error) => failed = Some(error),
            }
            let done = best.as_ref().is_some_and(|b| b.overlaps.is_empty());
            // Where the first tries do not even leave anything of a facet, others will not.
            if done || self.tried >= self.budget || (best.is_none() && attempt > 8) {
                break;
            }
        }
        match (best, failed) {
            (Some(best), _) => Ok(Found { tried: self.tried, ..best }),
            (None, Some(error)) => Err(error),
            (None, None) => Err(UnfoldError::Facets(crate::facets::FacetError::Empty)),
        }
    }

    fn lay(&mut self, joins: &[u32]) -> Result<(Layout, Vec<[u32; 2]>), UnfoldError> {
        self.tried += 1;
        let layout = self.flat.lay(joins)?;
        let overlaps = self.flat.overlaps(&layout);
        Ok((layout, overlaps))
    }

    /// Exchanges joins of a forest as long as that leaves fewer overlaps.
    fn mend(&mut self, mut forest: Forest) -> Result<Found, UnfoldError> {
        let (mut layout, mut overlaps) = self.lay(&forest.joins)?;
        let mut stuck = 0;
        while !overlaps.is_empty() && stuck < overlaps.len().min(6) && self.tried < self.budget {
            let better = self.exchange(&forest.joins, overlaps[stuck], overlaps.len());
            match better {
                Some((joins, new_layout, new_overlaps)) => {
                    (forest.joins, layout, overlaps, stuck) = (joins, new_layout, new_overlaps, 0);
                }
                None => stuck += 1,
            }
        }
        Ok(Found { forest, layout, overlaps, tried: self.tried })
    }

    /// Cuts the way between two facets that overlap and joins the parts elsewhere.
    fn exchange(
        &mut self,
        joins: &[u32],
        pair: [u32; 2],
        overlaps: usize,
    ) -> Option<(Vec<u32>, Layout, Vec<[u32; 2]>)> {
        let all = self.flat.joins;
        let facets = self.flat.sheet.facets.len();
        let mut taken = vec![false; all.len()];
        joins.iter().for_each(|&j| taken[j as usize] = true);
        let ground: Vec<u32> = (0..all.len() as u32).collect();
        let mut path = Tree::new(all, facets, &ground, &taken).path(pair);
        path.sort_by(|a, b| self.worth(*a).total_cmp(&self.worth(*b)).then(a.cmp(b)));
        for cut in path {
            taken[cut as usize] = false;
            let parts = Tree::new(all, facets, &ground, &taken);
            let mut instead: Vec<u32> = ground
                .iter()
                .copied()
                .filter(|&j| j != cut && !taken[j as usize] && self.flat.measures[j as usize].is_some())
                .filter(|&j| {
                    let [a, b] = all[j as usize].facets;
                    let [p, q] = pair.map(|f| parts.root[f as usize]);
                    let [a, b] = [a, b].map(|f| parts.root[f as usize]);
                    (a == p && b == q) || (a == q && b == p)
                })
                .filter(|&j| self.line_bears(&taken, j))
                .collect();
            instead.sort_by(|a, b| self.worth(*b).total_cmp(&self.worth(*a)).then(a.cmp(b)));
            for j in instead {
                if self.tried >= self.budget {
                    return None;
                }
                let mut new: Vec<u32> = joins.iter().copied().filter(|x| *x != cut).chain([j]).collect();
                new.sort_unstable();
                if let Ok((layout, found)) = self.lay(&new)
                    && found.len() < overlaps
                {
                    return Some((new, layout, found));
                }
            }
            taken[cut as usize] = true;
        }
        None
    }

    /// Whether a line can take one more bend.
    pub(crate) fn line_bears(&self, taken: &[bool], j: u32) -> bool {
        let join: &Join = &self.flat.joins[j as usize];
        self.flat.joins.iter().zip(taken).filter(|(other, t)| **t && other.line == join.line).all(
            |(other, _)| {
                self.per_line == PerLine::Matching && other.uses.iter().all(|u| !join.uses.contains(u))
            },
        )
    }

    /// Cuts joins until nothing overlaps, those first that part most pairs; then joins plates again wherever they fit.
    pub(crate) fn part(&mut self, found: Found) -> Result<Found, UnfoldError> {
        let all = self.flat.joins;
        let facets = self.flat.sheet.facets.len();
        let ground: Vec<u32> = (0..all.len() as u32).collect();
        let Found { mut forest, mut layout, mut overlaps, .. } = found;
        let mut taken = vec![false; all.len()];
        forest.joins.iter().for_each(|&j| taken[j as usize] = true);
        while !overlaps.is_empty() {
            let tree = Tree::new(all, facets, &ground, &taken);
            let mut parts: Vec<usize> = vec![0; all.len()];
            for pair in &overlaps {
                tree.path(*pair).into_iter().for_each(|j| parts[j as usize] += 1);
            }
            let most = (0..all.len()).filter(|&j| parts[j] > 0).max_by(|&a, &b| {
                let worth = |j: usize| self.worth(j as u32);
                parts[a].cmp(&parts[b]).then(worth(b).total_cmp(&worth(a))).then(b.cmp(&a))
            });
            let Some(cut) = most else { break };
            taken[cut] = false;
            forest.joins.retain(|&j| j as usize != cut);
            (layout, overlaps) = self.lay(&forest.joins)?;
        }
        // What was cut to resolve one pair may fit elsewhere.
        let limit = self.tried + self.budget / 2;
        for j in self.order(0) {
            let tree = Tree::new(all, facets, &ground, &taken);
            let [a, b] = all[j as usize].facets.map(|f| tree.root[f as usize]);
            if a == b || taken[j as usize] || !self.line_bears(&taken, j) || self.tried >= limit {
                continue;
            }
            let mut new = forest.joins.clone();
            new.push(j);
            new.sort_unstable();
            if let Ok((joined, found)) = self.lay(&new)
                && found.is_empty()
            {
                taken[j as usize] = true;
                forest.joins = new;
                layout = joined;
            }
        }
        Ok(Found { forest, layout, overlaps, tried: self.tried })
    }
}
