//! Which of two walls that lie opposite to each other becomes the mid-surface.
//!
//! Both would do in the paper's drawings. A mesh wants the one that knows more: where a rib stands on a plate, the plate's
//! face on that side is cut along the rib and the other is not; where a plate is folded, the inner faces grow when
//! they move to the middle and the outer ones shrink, past their own nodes if they are finely meshed.

use std::collections::{BTreeMap, BTreeSet};

use super::blends::Blends;
use super::flush::Flush;
use super::looks::Pair;
use super::plane::Plane;
use super::segments::Segments;
use super::solid::{SHARP, Solid};
use super::walls::Walls;

/// Union–find whose members know on which of two sides they are.
pub(super) struct Parity {
    parent: Vec<u32>,
    flipped: Vec<bool>,
}

impl Parity {
    pub(super) fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).collect(), flipped: vec![false; n] }
    }

    /// The representative, and whether `x` is on the other side of it.
    pub(super) fn find(&mut self, x: u32) -> (u32, bool) {
        let (mut root, mut side) = (x, false);
        while self.parent[root as usize] != root {
            side ^= self.flipped[root as usize];
            root = self.parent[root as usize];
        }
        // Paths are shortened on the way.
        let (mut at, mut at_side) = (x, side);
        while self.parent[at as usize] != root && at != root {
            let (next, flip) = (self.parent[at as usize], self.flipped[at as usize]);
            self.parent[at as usize] = root;
            self.flipped[at as usize] = at_side;
            at = next;
            at_side ^= flip;
        }
        (root, side)
    }

    /// Says that two are on one side, or not; `false` if the contrary is known.
    pub(super) fn relate(&mut self, a: u32, b: u32, other_side: bool) -> bool {
        let ((ra, sa), (rb, sb)) = (self.find(a), self.find(b));
        if ra == rb {
            return (sa ^ sb) == other_side;
        }
        self.parent[rb as usize] = ra;
        self.flipped[rb as usize] = sa ^ sb ^ other_side;
        true
    }
}

/// Walls that are on one side or the other of the same set: what runs smoothly into each other, and what lies opposite to it.
pub(super) struct Sets<'a> {
    segments: &'a Segments,
    walls: &'a Walls,
    parity: Parity,
    creases: Creases,
}

impl<'a> Sets<'a> {
    /// O(n log n).
    pub(super) fn new(solid: &Solid, segments: &'a Segments, walls: &'a Walls, blends: &Blends) -> Self {
        let mut parity = Parity::new(segments.groups.len());
        let creases = Creases::new(solid, segments, walls, blends);
        // Smooth neighbours stay together: nothing else would join them.
        for &[a, b] in &creases.smooth {
            parity.relate(a, b, false);
        }
        let mut order: Vec<usize> = (0..walls.pairs.len()).collect();
        order.sort_by(|a, b| walls.pairs[*b].area.total_cmp(&walls.pairs[*a].area).then(a.cmp(b)));
        for k in order {
            let pair = walls.pairs[k];
            let least = segments.group(pair.group).area.min(segments.group(pair.partner).area);
            if pair.area > TOUCHED * least {
                parity.relate(pair.group, pair.partner, true);
            }
        }
        Self { segments, walls, parity, creases }
    }

    /// One number for all groups of a set, by group.
    pub(super) fn numbers(&mut self) -> Vec<u32> {
        (0..self.segments.groups.len() as u32).map(|g| self.parity.find(g).0).collect()
    }

    /// The groups that become the mid-surface: of each pair of walls one. With `other`, the other one where it would hardly do worse. O(n).
    pub(super) fn kept(&mut self, flush: &Flush, mids: &[Vec<Plane>], other: bool) -> Vec<bool> {
        let Self { segments, walls, parity, creases } = self;
        let n = segments.groups.len();
        let stood_on = creases.stood_on(walls, parity);
        let levels = widths_of_levels(segments, walls);
        // What speaks for each side of each set.
        let mut score = vec![[0.0f64; 2]; n];
        let mut cut = vec![[0.0f64; 2]; n];
        let mut faces = vec![[0usize; 2]; n];
        // Plane walls are to lie opposite to plane ones: their middle is a plane only there.
        let mut bent = vec![[0.0f64; 2]; n];
        for g in (0..n as u32).filter(|g| walls.is_wall[*g as usize]) {
            let (root, side) = parity.find(g);
            let group = segments.group(g);
            let wide = group.area.sqrt();
            // A wall with two middles would have to be cut in two. Plane ones are cut by what lies in them; a curved one has edges where its
            // thickness steps, or where others stand on it, on that side only.
            let split = match group.plane {
                Some(_) => {
                    4.0 * (wide * (mids[g as usize].len().max(1) - 1) as f64 + flush.length[g as usize])
                }
                None => STEPPED * levels[g as usize],
            };
            let stood_on = STOOD_ON * stood_on[g as usize];
            score[root as usize][usize::from(side)] += creases.concave[g as usize] + stood_on - split;
            cut[root as usize][usize::from(side)] += FIRST * stood_on;
            faces[root as usize][usize::from(side)] += group.faces.len();
            if group.plane.is_some() {
                let curved = |p: &&Pair| segments.group(p.partner).plane.is_none();
                bent[root as usize][usize::from(side)] +=
                    walls.partners(g).iter().filter(curved).map(|p| p.area).sum::<f64>();
            }
        }
        let mut kept: Vec<bool> = (0..n as u32)
            .map(|g| {
                let (root, side) = parity.find(g);
                let ([a, b], [few, many]) = (score[root as usize], faces[root as usize]);
                let [p, q] = bent[root as usize];
                let [cut_a, cut_b] = cut[root as usize];
                let ahead = (b + cut_b) - (a + cut_a);
                let second = if ahead.abs() > DIFFERENT * walls.max_thickness {
                    ahead > 0.0
                } else if (p - q).abs() > MUCH * (p + q) {
                    q < p
                } else {
                    many < few
                };
                let second = second != (other && (a - b).abs() < HARDLY * walls.max_thickness);
                walls.is_wall[g as usize] && side == second
            })
            .collect();
        keep_sides_with_signs(walls, mids, &mut kept);
        kept
    }
}

/// How wide the levels of each group are together, but for the widest: where the other side of a round wall steps, what looks at it from there
/// knows, and its own facets need not. O(n log n) in pairs.
fn widths_of_levels(segments: &Segments, walls: &Walls) -> Vec<f64> {
    let is_level = |p: &&Pair| {
        let whole = p.group != p.partner && p.area > SEEN_WHOLE * segments.group(p.group).area;
        whole && p.area.sqrt() > BROADER * p.thickness
    };
    let mut seen: Vec<&Pair> = walls.pairs.iter().filter(is_level).collect();
    seen.sort_by(|a, b| a.partner.cmp(&b.partner).then(a.thickness.total_cmp(&b.thickness)));
    let mut widths = vec![0.0; segments.groups.len()];
    for run in seen.chunk_by(|a, b| a.partner == b.partner) {
        // The thinnest of a level, and its area.
        let mut levels: Vec<(f64, f64)> = Vec::new();
        for pair in run {
            match levels.last_mut() {
                Some((thin, area)) if pair.thickness <= LEVEL * *thin => *area += pair.area,
                _ => levels.push((pair.thickness, pair.area)),
            }
        }
        let all = levels.iter().map(|level| level.1.sqrt());
        widths[run[0].partner as usize] = all.clone().sum::<f64>() - all.fold(0.0, f64::max);
    }
    widths
}

/// Plates that were kept on the side that does not know where their thickness steps are kept on the other one: what is engraved into the
/// outside of a box is seen there only. Their edges lie in the same middles. O(n log n).
fn keep_sides_with_signs(walls: &Walls, mids: &[Vec<Plane>], kept: &mut [bool]) {
    let is_plate = |g: u32| !mids[g as usize].is_empty();
    let mut plates = Parity::new(kept.len());
    for pair in walls.pairs.iter().filter(|p| is_plate(p.group) && is_plate(p.partner)) {
        plates.relate(pair.group, pair.partner, false);
    }
    // Of each plate, whether the kept side and the other one would have to be cut.
    let mut is_cut = vec![[false; 2]; kept.len()];
    for g in (0..kept.len() as u32).filter(|g| is_plate(*g)) {
        is_cut[plates.find(g).0 as usize][usize::from(!kept[g as usize])] |= mids[g as usize].len() > 1;
    }
    for g in (0..kept.len() as u32).filter(|g| is_plate(*g) && walls.is_wall[*g as usize]) {
        if is_cut[plates.find(g).0 as usize] == [true, false] {
            kept[g as usize] ^= true;
        }
    }
}

/// Creases of two sides differ if their lengths do by this many thicknesses.
const DIFFERENT: f64 = 0.1;
/// Edges to a wall that stands on a curved one weigh so much more than others.
const STOOD_ON: f64 = 10.0;
/// And so much more again where it is decided: only on that side the curved one is cut there. Whether the other side is tried as well is asked
/// without.
const FIRST: f64 = 100.0;
/// And so much the widths of a curved wall's levels.
const STEPPED: f64 = 40.0;
/// Or hardly, if by less than so many.
const HARDLY: f64 = 10.0;
/// One side has more plane walls opposite to curved ones than the other, if by this share of them.
const MUCH: f64 = 0.01;
/// A pair that covers less than this share of the smaller group only touches.
const TOUCHED: f64 = 0.1;

/// A group that looks at another with more than this share of itself tells how thick that is; thicknesses differ by this factor.
const SEEN_WHOLE: f64 = 0.5;
const LEVEL: f64 = 1.2;
/// A level is so many times as broad as thick.
const BROADER: f64 = 2.0;

/// How walls meet walls.
struct Creases {
    /// Pairs of walls that run into each other without a fold.
    smooth: Vec<[u32; 2]>,
    /// Length of the sharp edges to other walls, and of the edges to blends: hollow ones count, proud ones count against.
    concave: Vec<f64>,
    /// Length of those edges of curved walls, by the group beyond.
    folds: BTreeMap<[u32; 2], f64>,
    /// Walls beside each group, but for smooth neighbours.
    beside: Vec<BTreeSet<u32>>,
}

impl Creases {
    fn new(solid: &Solid, segments: &Segments, walls: &Walls, blends: &Blends) -> Self {
        let n = segments.groups.len();
        let mut creases = Self {
            smooth: Vec::new(),
            concave: vec![0.0; n],
            folds: BTreeMap::new(),
            beside: vec![BTreeSet::new(); n],
        };
        let is_wall = |g: u32| walls.is_wall[g as usize];
        for h in 0..3 * solid.len() {
            let [g, other] = [h / 3, solid.across(h)].map(|f| segments.of(f));
            if g == other || !is_wall(g) || !(is_wall(other) || blends.is_blend[other as usize]) {
                continue;
            }
            let both_planes = [g, other].iter().all(|g| segments.group(*g).plane.is_some());
            if is_wall(other) && solid.fold_cosine(h) > SHARP.cos() && !both_planes {
                creases.smooth.push([g.min(other), g.max(other)]);
                continue;
            }
            let length = solid.length(h);
            creases.concave[g as usize] += if solid.is_convex(h) { -length } else { length };
            creases.beside[other as usize].insert(g);
            if segments.group(g).plane.is_none() {
                *creases.folds.entry([g, other]).or_insert(0.0) += length;
            }
        }
        creases.smooth.sort_unstable();
        creases.smooth.dedup();
        creases
    }

    /// Of each curved wall, the length of its folds to walls that stand with both their sides on its side of its set, straight or over a
    /// blend.
    fn stood_on(&self, walls: &Walls, parity: &mut Parity) -> Vec<f64> {
        let beyond = |other: u32| match walls.is_wall[other as usize] {
            true => BTreeSet::from([other]),
            false => self.beside[other as usize].clone(),
        };
        let mut about: BTreeMap<(u32, bool), BTreeSet<u32>> = BTreeMap::new();
        for &[g, other] in self.folds.keys() {
            about.entry(parity.find(g)).or_default().extend(beyond(other).into_iter().filter(|o| *o != g));
        }
        let mut stood_on = vec![0.0; self.concave.len()];
        for (&[g, other], length) in &self.folds {
            let about = &about[&parity.find(g)];
            let both_stand =
                |w: &u32| walls.partners(*w).iter().any(|p| p.partner != *w && about.contains(&p.partner));
            if beyond(other).iter().any(|w| *w != g && both_stand(w)) {
                stood_on[g as usize] += length;
            }
        }
        stood_on
    }
}
