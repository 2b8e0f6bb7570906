//! Spanning forests of facets under what lines can bear: eq. 10 of Lipson & Shpitalni, made exact.
//!
//! A bend joins exactly two facets, and a facet bends at a line at most once, so the bends of a line are a matching of its
//! facets. Where a line has three facets at most that is "one bend a line", and the largest forest is a matroid intersection
//! (the forest's and the lines'), found by shortest augmenting paths. Lines of four facets and more are given one of their
//! perfect matchings, all of which are tried where they are few.

use std::collections::{BTreeMap, VecDeque};

use mesh_kernel::complex::SheetCounts;

use super::Join;

/// How many bends a line may get.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PerLine {
    /// As many as its facets allow: ⌊n / 2⌋.
    Matching,
    /// One, so that every line is either a bend or a weld.
    One,
}

/// More combinations of matchings than this are not all tried.
const EXHAUSTIVE: usize = 4096;

/// More matchings of one line than this are not all tried: those of eight facets.
const MATCHINGS: usize = 105;

/// A largest forest that was found.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Forest {
    /// Numbers of joins, ascending.
    pub(crate) joins: Vec<u32>,
    /// Whether no larger one exists.
    pub(crate) largest: bool,
}

/// A largest forest of the joins, preferring those early in `order`. `facets` is their number, `enough` the size of a forest
/// that spans all components.
pub(crate) fn largest_forest(
    joins: &[Join],
    facets: usize,
    order: &[u32],
    per_line: PerLine,
    enough: usize,
) -> Forest {
    let mut by_line: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for &j in order {
        by_line.entry(joins[j as usize].line).or_default().push(j);
    }
    // Matchings of the lines where there is a choice of several bends.
    let many: Vec<Vec<Vec<u32>>> = match per_line {
        PerLine::One => Vec::new(),
        PerLine::Matching => {
            by_line.values().filter(|all| all.len() > 3).map(|all| matchings(joins, all)).collect()
        }
    };
    let few: Vec<u32> = by_line
        .values()
        .filter(|all| per_line == PerLine::One || all.len() <= 3)
        .flatten()
        .copied()
        .collect();
    let solve = |choice: &[usize]| {
        let mut allowed = vec![false; joins.len()];
        let mut exclusive = vec![false; joins.len()];
        few.iter().for_each(|&j| {
            allowed[j as usize] = true;
            exclusive[j as usize] = true;
        });
        for (matchings, &c) in many.iter().zip(choice) {
            matchings[c].iter().for_each(|&j| allowed[j as usize] = true);
        }
        let ground: Vec<u32> = order.iter().copied().filter(|&j| allowed[j as usize]).collect();
        intersect(joins, facets, &ground, &exclusive)
    };
    let mut choice = vec![0; many.len()];
    let mut best = solve(&choice);
    let capacity: usize = by_line
        .values()
        .map(|all| if per_line == PerLine::One { 1 } else { largest_matching(joins, all) })
        .sum();
    let bound = enough.min(capacity);
    let combinations = many.iter().try_fold(1usize, |n, m| n.checked_mul(m.len())).unwrap_or(usize::MAX);
    if best.len() < bound && combinations <= EXHAUSTIVE {
        let mut next = choice.clone();
        while best.len() < bound && advance(&mut next, &many) {
            let found = solve(&next);
            if found.len() > best.len() {
                best = found;
            }
        }
    } else if best.len() < bound {
        best = climb(&many, &mut choice, best, bound, solve);
    }
    let largest = best.len() >= bound || combinations <= EXHAUSTIVE;
    best.sort_unstable();
    Forest { joins: best, largest }
}

/// Changes the matching of one line after the other as long as that helps.
fn climb(
    many: &[Vec<Vec<u32>>],
    choice: &mut [usize],
    mut best: Vec<u32>,
    bound: usize,
    solve: impl Fn(&[usize]) -> Vec<u32>,
) -> Vec<u32> {
    let mut improved = true;
    while improved && best.len() < bound {
        improved = false;
        for line in 0..many.len() {
            let kept = choice[line];
            for other in 0..many[line].len() {
                choice[line] = other;
                let found = solve(choice);
                if found.len() > best.len() {
                    best = found;
                    improved = true;
                    break;
                }
                choice[line] = kept;
            }
        }
    }
    best
}

/// The next choice in counting order; `false` after the last.
fn advance(choice: &mut [usize], many: &[Vec<Vec<u32>>]) -> bool {
    for (c, matchings) in choice.iter_mut().zip(many) {
        *c += 1;
        if *c < matchings.len() {
            return true;
        }
        *c = 0;
    }
    false
}

/// The uses of a line that joins connect.
fn ports(joins: &[Join], all: &[u32]) -> Vec<u32> {
    let mut ports: Vec<u32> = all.iter().flat_map(|&j| joins[j as usize].uses).collect();
    ports.sort_unstable();
    ports.dedup();
    ports
}

fn largest_matching(joins: &[Join], all: &[u32]) -> usize {
    ports(joins, all).len() / 2
}

/// All matchings of a line that leave at most one facet out, those of early joins first.
fn matchings(joins: &[Join], all: &[u32]) -> Vec<Vec<u32>> {
    fn extend(
        joins: &[Join],
        all: &[u32],
        size: usize,
        taken: &mut Vec<u32>,
        from: usize,
        out: &mut Vec<Vec<u32>>,
    ) {
        if taken.len() == size {
            out.push(taken.clone());
            return;
        }
        for (i, &j) in all.iter().enumerate().skip(from) {
            if out.len() >= MATCHINGS {
                return;
            }
            let uses = joins[j as usize].uses;
            let free = taken.iter().all(|t| joins[*t as usize].uses.iter().all(|u| !uses.contains(u)));
            if free {
                taken.push(j);
                extend(joins, all, size, taken, i + 1, out);
                taken.pop();
            }
        }
    }
    let mut out = Vec::new();
    extend(joins, all, largest_matching(joins, all), &mut Vec::new(), 0, &mut out);
    out
}

/// A largest set of joins that is a forest and has at most one join on every line marked exclusive.
fn intersect(joins: &[Join], facets: usize, ground: &[u32], exclusive: &[bool]) -> Vec<u32> {
    let mut taken = vec![false; joins.len()];
    let mut line_of: BTreeMap<u32, u32> = BTreeMap::new();
    let mut roots = Roots::new(facets);
    for &j in ground {
        let join = &joins[j as usize];
        if exclusive[j as usize] && line_of.contains_key(&join.line) {
            continue;
        }
        if roots.union(join.facets[0], join.facets[1]) {
            taken[j as usize] = true;
            if exclusive[j as usize] {
                line_of.insert(join.line, j);
            }
        }
    }
    while augment(joins, facets, ground, exclusive, &mut taken) {}
    ground.iter().copied().filter(|&j| taken[j as usize]).collect()
}

/// One augmentation along a shortest path of the exchange graph; `false` where there is none.
fn augment(joins: &[Join], facets: usize, ground: &[u32], exclusive: &[bool], taken: &mut [bool]) -> bool {
    let tree = Tree::new(joins, facets, ground, taken);
    let mut on_line: BTreeMap<u32, u32> = BTreeMap::new();
    for &j in ground.iter().filter(|&&j| taken[j as usize] && exclusive[j as usize]) {
        on_line.insert(joins[j as usize].line, j);
    }
    let blocking =
        |j: u32| if exclusive[j as usize] { on_line.get(&joins[j as usize].line).copied() } else { None };
    let apart = |j: u32| {
        let [a, b] = joins[j as usize].facets;
        tree.root[a as usize] != tree.root[b as usize]
    };
    // From joins that the forest can take, over joins that the lines make leave, to joins that the lines can take.
    let mut before: BTreeMap<u32, Option<u32>> = BTreeMap::new();
    let mut queue: VecDeque<u32> = VecDeque::new();
    for &j in ground.iter().filter(|&&j| !taken[j as usize] && apart(j)) {
        before.insert(j, None);
        queue.push_back(j);
    }
    // What a taken join could be replaced by in the forest: joins whose path runs over it.
    let mut over: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    let mut prepared = false;
    while let Some(x) = queue.pop_front() {
        let Some(y) = blocking(x) else {
            let mut at = Some(x);
            while let Some(j) = at {
                taken[j as usize] = !taken[j as usize];
                at = before.get(&j).copied().flatten();
            }
            return true;
        };
        if before.contains_key(&y) {
            continue;
        }
        before.insert(y, Some(x));
        if !prepared {
            prepared = true;
            for &z in ground.iter().filter(|&&z| !taken[z as usize] && !apart(z)) {
                for on_path in tree.path(joins[z as usize].facets) {
                    over.entry(on_path).or_default().push(z);
                }
            }
        }
        for &z in over.get(&y).map_or(&[][..], Vec::as_slice) {
            if let std::collections::btree_map::Entry::Vacant(entry) = before.entry(z) {
                entry.insert(Some(y));
                queue.push_back(z);
            }
        }
    }
    false
}

/// A forest with roots, to walk the path between two facets.
pub(crate) struct Tree {
    pub(crate) root: Vec<u32>,
    parent: Vec<Option<(u32, u32)>>,
    depth: Vec<u32>,
}

impl Tree {
    /// The forest of the joins taken.
    pub(crate) fn new(joins: &[Join], facets: usize, ground: &[u32], taken: &[bool]) -> Self {
        let mut at: Vec<Vec<(u32, u32)>> = vec![Vec::new(); facets];
        for &j in ground.iter().filter(|&&j| taken[j as usize]) {
            let [a, b] = joins[j as usize].facets;
            at[a as usize].push((b, j));
            at[b as usize].push((a, j));
        }
        let mut tree =
            Self { root: vec![u32::MAX; facets], parent: vec![None; facets], depth: vec![0; facets] };
        let mut stack = Vec::new();
        for start in 0..facets as u32 {
            if tree.root[start as usize] != u32::MAX {
                continue;
            }
            tree.root[start as usize] = start;
            stack.push(start);
            while let Some(f) = stack.pop() {
                for &(g, j) in &at[f as usize] {
                    if tree.root[g as usize] == u32::MAX {
                        tree.root[g as usize] = start;
                        tree.parent[g as usize] = Some((f, j));
                        tree.depth[g as usize] = tree.depth[f as usize] + 1;
                        stack.push(g);
                    }
                }
            }
        }
        tree
    }

    /// The joins between two facets of one tree.
    pub(crate) fn path(&self, [mut a, mut b]: [u32; 2]) -> Vec<u32> {
        let mut path = Vec::new();
        while a != b {
            let lower = if self.depth[a as usize] >= self.depth[b as usize] { &mut a } else { &mut b };
            let Some((up, join)) = self.parent[*lower as usize] else { return path };
            path.push(join);
            *lower = up;
        }
        path
    }
}

/// Union–find.
pub(crate) struct Roots(Vec<u32>);

impl Roots {
    pub(crate) fn new(n: usize) -> Self {
        Self((0..n as u32).collect())
    }

    pub(crate) fn find(&mut self, mut x: u32) -> u32 {
        while self.0[x as usize] != x {
            self.0[x as usize] = self.0[self.0[x as usize] as usize];
            x = self.0[x as usize];
        }
        x
    }

    pub(crate) fn union(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a as usize] = b;
        a != b
    }
}

/// The size of a forest that spans every component (eq. 8).
pub(crate) fn spanning_size(counts: &SheetCounts) -> usize {
    (counts.f - counts.s).max(0) as usize
}
