//! Where borders of pieces come to lie on each other they become one: the same nodes, the same edges.
//!
//! Both sides of a rib end on the same line of the plate, each with the nodes that its own side of the solid had there.
//! Nodes in one place are merged, edges are cut at nodes that lie on them and where they cross, so that afterwards edges
//! are the same or have at most a node in common.

use std::cmp::{Ordering, Reverse};
use std::collections::BTreeMap;

use glam::DVec3;

use super::nearness::{Nearness, crossing, near_pairs};
use super::plane::Plane;
use super::replace::{MEETING, independent, on_planes};

/// Union–find in which the smaller number stands for both.
#[derive(Clone, Debug)]
pub(super) struct Merged {
    parent: Vec<u32>,
}

impl Merged {
    pub(super) fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).collect() }
    }

    /// Who stands for `x`.
    pub(super) fn find(&self, mut x: u32) -> u32 {
        while self.parent[x as usize] != x {
            x = self.parent[x as usize];
        }
        x
    }

    pub(super) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.halved(a), self.halved(b));
        let (low, high) = (a.min(b), a.max(b));
        self.parent[high as usize] = low;
    }

    /// Who stands for `x`; every other step of the way there is left out from now on.
    fn halved(&mut self, mut x: u32) -> u32 {
        while self.parent[x as usize] != x {
            let next = self.parent[self.parent[x as usize] as usize];
            self.parent[x as usize] = next;
            x = next;
        }
        x
    }

    fn push(&mut self) -> u32 {
        self.parent.push(self.parent.len() as u32);
        self.parent.len() as u32 - 1
    }

    /// Makes every path one step long.
    pub(super) fn flatten(&mut self) {
        for x in 0..self.parent.len() as u32 {
            self.parent[x as usize] = self.find(x);
        }
    }
}

/// Borders that were made to agree.
#[derive(Debug)]
pub(super) struct Seams {
    pub(super) positions: Vec<DVec3>,
    pub(super) merged: Merged,
    /// Whether a node is only as exact as chords are.
    soft: Vec<bool>,
    /// The different edges of borders, smaller node first, ascending.
    edges: Vec<[u32; 2]>,
    /// The nodes of each, from the smaller end on.
    paths: Vec<Vec<u32>>,
    /// The pieces that each borders.
    pieces: Vec<Vec<u32>>,
    /// One of the edges whose path has these ends, the smaller node first.
    by_ends: BTreeMap<[u32; 2], usize>,
    /// Pieces with smaller numbers are plane.
    first_curved: u32,
}

/// A part of a border between two neighbouring nodes.
#[derive(Clone, Copy, Debug)]
struct Part {
    /// The smaller node first.
    ends: [u32; 2],
    /// How many pieces it borders.
    pieces: usize,
    /// Whether two of them are plane: then it lies on a line, however soft its ends are along that.
    is_exact: bool,
}

impl Seams {
    /// Makes borders agree. `borders`: edges with the number of their piece, those before `first_curved` plane; `soft`: whether each
    /// node is only as exact as chords are. O(n log n) and what lies beside each other.
    pub(super) fn new(
        positions: Vec<DVec3>,
        merged: Merged,
        borders: &[([u32; 2], u32)],
        first_curved: u32,
        soft: &[bool],
        near: Nearness,
    ) -> Self {
        let mut all: Vec<([u32; 2], u32)> =
            borders.iter().map(|([a, b], piece)| ([*a.min(b), *a.max(b)], *piece)).collect();
        all.sort_unstable();
        all.dedup();
        let runs: Vec<&[([u32; 2], u32)]> = all.chunk_by(|a, b| a.0 == b.0).collect();
        let edges: Vec<[u32; 2]> = runs.iter().map(|run| run[0].0).collect();
        let pieces = runs.iter().map(|run| run.iter().map(|e| e.1).collect()).collect();
        let paths = edges.iter().map(|e| e.to_vec()).collect();
        let (soft, by_ends) = (soft.to_vec(), BTreeMap::new());
        let mut seams = Self { positions, merged, soft, edges, paths, pieces, by_ends, first_curved };
        seams.update();
        let nodes = seams.nodes();
        let most = MOST_CUTS * nodes.len() + MOST_ANYWAY;
        for (a, b) in near_pairs(&seams.positions, &nodes, near.rounding) {
            seams.merged.join(a, b);
        }
        seams.update();
        for _ in 0..ROUNDS {
            // Where three borders come together, pairs merge one after the other.
            let merging = (0..ROUNDS).take_while(|_| seams.merge_across(near.chords)).count();
            if seams.cut(near, most) == 0 && merging == 0 {
                break;
            }
        }
        for _ in 0..SHORT_ROUNDS {
            seams.merge_short(near.chords);
        }
        seams
    }

    /// Puts nodes back on the planes of the pieces that they border, if they were merged with what lies beside these: a node off its plane
    /// draws all of a piece along. `plane_of`: by piece. O(n log n).
    pub(super) fn put_on_planes(&mut self, plane_of: impl Fn(u32) -> Option<Plane>, near: Nearness) {
        let shortest = self.shortest_edges(&self.parts());
        for run in self.planes_at().chunk_by(|a, b| a.0 == b.0) {
            let most = near.chords.min(MOVED * shortest[run[0].0 as usize]);
            let planes: Vec<Plane> = run.iter().filter_map(|(_, piece)| plane_of(*piece)).collect();
            let p = &mut self.positions[run[0].0 as usize];
            if planes.iter().any(|plane| plane.height(*p).abs() > near.rounding) {
                let moved = on_planes(*p, &independent(planes.iter().map(|plane| (plane, MEETING))));
                // Planes that hardly lean to each other do not meet here.
                let is_on_all = planes.iter().all(|plane| plane.height(moved).abs() < near.rounding);
                if is_on_all && moved.distance(*p) < most {
                    *p = moved;
                }
            }
        }
    }

    /// Closes parts between nodes that are only as exact as chords and so near to each other that the border would zigzag.
    fn merge_short(&mut self, chords: f64) {
        let length = |[a, b]: &[u32; 2]| self.positions[*a as usize].distance(self.positions[*b as usize]);
        let parts: Vec<[u32; 2]> = self.parts().into_iter().map(|p| p.ends).collect();
        let mut at_node = vec![0u32; self.positions.len()];
        parts.iter().flatten().for_each(|v| at_node[*v as usize] += 1);
        let parts = parts.into_iter();
        let is_soft = |[a, b]: &[u32; 2]| self.soft[*a as usize] && self.soft[*b as usize];
        // Where borders end and branch, they do so for good.
        let is_for_good = |[a, b]: &[u32; 2]| [*a, *b].map(|v| at_node[v as usize] != 2);
        let least =
            |part: &[u32; 2]| chords * if is_for_good(part) == [true; 2] { SHORT_ENDS } else { SHORT };
        let mut short: Vec<(f64, [u32; 2])> =
            parts.filter(is_soft).map(|p| (length(&p), p)).filter(|p| p.0 < least(&p.1)).collect();
        short.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let planes = self.plane_counts();
        let mut used = vec![false; self.positions.len()];
        for (_, [a, b]) in short {
            if !(used[a as usize] || used[b as usize]) {
                (used[a as usize], used[b as usize]) = (true, true);
                let stays = a.min(b) as usize;
                let (p, q) = (self.positions[a as usize], self.positions[b as usize]);
                let firmness = [a, b].map(|v| (at_node[v as usize] != 2, planes[v as usize]));
                self.positions[stays] = match firmness[0].cmp(&firmness[1]) {
                    Ordering::Greater => p,
                    Ordering::Less => q,
                    Ordering::Equal => p.midpoint(q),
                };
                self.merged.join(a, b);
            }
        }
        self.update();
    }

    /// The nodes from `a` to `b` along an edge, both ends included, after merging and cutting; one node where they are one. An edge
    /// inside of a piece whose ends came to be those of a border is that border.
    pub(super) fn path(&self, a: u32, b: u32) -> Vec<u32> {
        let directed = |k: usize, forward: bool| {
            let path = &self.paths[k];
            if forward { path.clone() } else { path.iter().rev().copied().collect() }
        };
        if let Ok(k) = self.edges.binary_search(&[a.min(b), a.max(b)]) {
            return directed(k, a < b);
        }
        let [from, to] = [a, b].map(|v| self.merged.find(v));
        match self.by_ends.get(&[from.min(to), from.max(to)]) {
            Some(k) => directed(*k, self.paths[*k][0] == from),
            None if from == to => vec![from],
            None => vec![from, to],
        }
    }

    /// Cuts borders into parts of about a length at most that their pieces ask for in a direction. With this they are done.
    pub(super) fn refine(&mut self, length_of: impl Fn(u32, DVec3) -> f64) {
        let mut lengths: BTreeMap<[u32; 2], f64> = BTreeMap::new();
        for (path, pieces) in self.paths.iter().zip(&self.pieces) {
            for pair in path.windows(2) {
                let [p, q] = [pair[0], pair[1]].map(|v| self.positions[v as usize]);
                let length = pieces.iter().map(|k| length_of(*k, q - p)).fold(f64::INFINITY, f64::min);
                let least = lengths.entry([pair[0].min(pair[1]), pair[0].max(pair[1])]).or_insert(length);
                *least = least.min(length);
            }
        }
        let mut inner: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
        for ([a, b], length) in lengths {
            let [p, q] = [a, b].map(|v| self.positions[v as usize]);
            let count = (p.distance(q) / length * 0.999).ceil().clamp(1.0, MOST_PARTS) as u32;
            let added = (1..count).map(|k| self.add(p.lerp(q, f64::from(k) / f64::from(count)))).collect();
            inner.insert([a, b], added);
        }
        self.insert(&inner);
        // A path that closed up stands for no edge between two nodes.
        for (k, path) in self.paths.iter().enumerate() {
            let (from, to) = (path[0], path[path.len() - 1]);
            if from != to {
                self.by_ends.entry([from.min(to), from.max(to)]).or_insert(k);
            }
        }
    }

    /// Puts nodes into the parts that they lie on, in order from the smaller end.
    fn insert(&mut self, inner: &BTreeMap<[u32; 2], Vec<u32>>) {
        for path in &mut self.paths {
            let mut longer = Vec::with_capacity(path.len());
            for pair in path.windows(2) {
                longer.push(pair[0]);
                let key = [pair[0].min(pair[1]), pair[0].max(pair[1])];
                let between = inner.get(&key).map_or(&[][..], Vec::as_slice);
                if pair[0] < pair[1] {
                    longer.extend(between);
                } else {
                    longer.extend(between.iter().rev());
                }
            }
            longer.extend(path.last());
            *path = longer;
        }
    }

    /// Brings paths up to date with what was merged.
    fn update(&mut self) {
        self.merged.flatten();
        for path in &mut self.paths {
            let mut kept = 0;
            for k in 0..path.len() {
                let v = self.merged.find(path[k]);
                if kept > 0 && path[kept - 1] == v {
                    continue;
                }
                // There and back again is nothing.
                if kept > 1 && path[kept - 2] == v {
                    kept -= 1;
                    continue;
                }
                path[kept] = v;
                kept += 1;
            }
            path.truncate(kept);
        }
    }

    fn add(&mut self, p: DVec3) -> u32 {
        self.positions.push(p);
        self.soft.push(true);
        self.merged.push()
    }

    /// The different parts of all borders, ascending.
    fn parts(&self) -> Vec<Part> {
        let mut parts: Vec<([u32; 2], u32)> = Vec::new();
        for (path, pieces) in self.paths.iter().zip(&self.pieces) {
            for pair in path.windows(2) {
                let ends = [pair[0].min(pair[1]), pair[0].max(pair[1])];
                parts.extend(pieces.iter().map(|piece| (ends, *piece)));
            }
        }
        parts.sort_unstable();
        parts.dedup();
        let part = |run: &[([u32; 2], u32)]| {
            let planes = run.iter().filter(|p| p.1 < self.first_curved).count();
            Part { ends: run[0].0, pieces: run.len(), is_exact: planes > 1 }
        };
        parts.chunk_by(|a, b| a.0 == b.0).map(part).collect()
    }

    /// Merges nodes of open edges that are nearest to each other across a gap between chords; whether there were any.
    fn merge_across(&mut self, chords: f64) -> bool {
        let parts = self.parts();
        let open = self.open_nodes(&parts);
        let nodes = self.nodes();
        let linked = |a: u32, b: u32| parts.binary_search_by_key(&[a.min(b), a.max(b)], |e| e.ends).is_ok();
        let mut nearest: BTreeMap<u32, (f64, u32)> = BTreeMap::new();
        let shortest = self.shortest_edges(&parts);
        for (a, b) in near_pairs(&self.positions, &nodes, chords) {
            let is_soft = self.soft[a as usize] || self.soft[b as usize];
            if linked(a, b) || !is_soft || !(open[a as usize] || open[b as usize]) {
                continue;
            }
            let d = self.positions[a as usize].distance(self.positions[b as usize]);
            // Nodes that are far apart for their edges are cut into each other's edges instead.
            if d > (MERGED_EDGE * shortest[a as usize].max(shortest[b as usize])).max(SURELY * chords) {
                continue;
            }
            for (from, to) in [(a, b), (b, a)] {
                let best = nearest.entry(from).or_insert((f64::INFINITY, to));
                if d < best.0 {
                    *best = (d, to);
                }
            }
        }
        let mutual: Vec<(u32, u32)> = nearest
            .iter()
            .filter(|(a, (_, b))| **a < *b && nearest.get(b).is_some_and(|n| n.1 == **a))
            .map(|(a, (_, b))| (*a, *b))
            .collect();
        let planes = self.plane_counts();
        for &(a, b) in &mutual {
            // What is exact stays where it is, and of the rest what lies in more planes.
            let (p, q) = (self.positions[a as usize], self.positions[b as usize]);
            let looseness = [a, b].map(|v| (self.soft[v as usize], Reverse(planes[v as usize])));
            self.positions[a as usize] = match looseness[0].cmp(&looseness[1]) {
                Ordering::Less => p,
                Ordering::Greater => q,
                Ordering::Equal if !self.soft[a as usize] => p,
                Ordering::Equal => (p + q) / 2.0,
            };
            self.soft[a as usize] &= self.soft[b as usize];
            self.merged.join(a, b);
        }
        self.update();
        !mutual.is_empty()
    }

    /// The plane pieces that nodes border: node and piece, ascending.
    fn planes_at(&self) -> Vec<(u32, u32)> {
        let mut at: Vec<(u32, u32)> = Vec::new();
        for (path, pieces) in self.paths.iter().zip(&self.pieces) {
            let planes = pieces.iter().filter(|piece| **piece < self.first_curved);
            at.extend(planes.flat_map(|piece| path.iter().map(|v| (*v, *piece))));
        }
        at.sort_unstable();
        at.dedup();
        at
    }

    /// In how many plane pieces' borders each node is.
    fn plane_counts(&self) -> Vec<u32> {
        let mut counts = vec![0; self.positions.len()];
        self.planes_at().iter().for_each(|(v, _)| counts[*v as usize] += 1);
        counts
    }

    fn nodes(&self) -> Vec<u32> {
        let mut nodes: Vec<u32> = self.paths.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// The shortest edge at every node.
    fn shortest_edges(&self, edges: &[Part]) -> Vec<f64> {
        let mut shortest = vec![f64::INFINITY; self.positions.len()];
        for [a, b] in edges.iter().map(|part| &part.ends) {
            let length = self.positions[*a as usize].distance(self.positions[*b as usize]);
            for v in [a, b] {
                shortest[*v as usize] = shortest[*v as usize].min(length);
            }
        }
        shortest
    }

    /// Whether each node has an edge that borders one piece only.
    fn open_nodes(&self, edges: &[Part]) -> Vec<bool> {
        let mut open = vec![false; self.positions.len()];
        for Part { ends, pieces, .. } in edges {
            if *pieces == 1 {
                ends.iter().for_each(|v| open[*v as usize] = true);
            }
        }
        open
    }

    /// Cuts parts at nodes on them, and where they cross; how many were cut. A tangle that wants more than `most` cuts is left alone.
    fn cut(&mut self, near: Nearness, most: usize) -> usize {
        let borders = self.parts();
        let open = self.open_nodes(&borders);
        let edges: Vec<[u32; 2]> = borders.iter().map(|e| e.ends).collect();
        let mut order: Vec<usize> = (0..edges.len()).collect();
        let low =
            |e: usize| edges[e].map(|v| self.positions[v as usize].x).into_iter().fold(f64::MAX, f64::min);
        let lows: Vec<f64> = (0..edges.len()).map(low).collect();
        order.sort_by(|a, b| lows[*a].total_cmp(&lows[*b]).then(a.cmp(b)));
        let mut inner: Vec<Vec<(f64, u32)>> = vec![Vec::new(); edges.len()];
        let mut crossings: Vec<(usize, usize, f64, f64, DVec3)> = Vec::new();
        for (i, &e) in order.iter().enumerate() {
            let [a, b] = edges[e].map(|v| self.positions[v as usize]);
            let (lo, hi) = (a.min(b) - near.chords, a.max(b) + near.chords);
            for &f in &order[i + 1..] {
                if lows[f] > hi.x {
                    break;
                }
                let [c, d] = edges[f].map(|v| self.positions[v as usize]);
                if c.min(d).cmpgt(hi).any() || c.max(d).cmplt(lo).any() {
                    continue;
                }
                self.nodes_on(&borders, e, f, &open, near, &mut inner);
                self.nodes_on(&borders, f, e, &open, near, &mut inner);
                let apart = edges[e].iter().all(|v| !edges[f].contains(v));
                if apart && let Some((s, t)) = crossing(a, b, c, d, near.rounding) {
                    crossings.push((e, f, s, t, a.lerp(b, s)));
                }
            }
        }
        if crossings.len() + inner.iter().map(Vec::len).sum::<usize>() > most {
            return 0;
        }
        for (e, f, s, t, p) in crossings {
            let taken = |list: &[(f64, u32)]| {
                list.iter().map(|n| n.1).find(|v| self.positions[*v as usize].distance(p) <= near.rounding)
            };
            let node = taken(&inner[e]).or_else(|| taken(&inner[f]));
            let node = node.unwrap_or_else(|| self.add(p));
            inner[e].push((s, node));
            inner[f].push((t, node));
        }
        let mut cuts: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
        for (edge, mut nodes) in edges.iter().zip(inner) {
            nodes.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            nodes.dedup_by_key(|n| n.1);
            if !nodes.is_empty() {
                cuts.insert(*edge, nodes.into_iter().map(|n| n.1).collect());
            }
        }
        self.insert(&cuts);
        self.update();
        cuts.len()
    }

    /// Ends of edge `f` that lie on edge `e`.
    fn nodes_on(
        &self,
        edges: &[Part],
        e: usize,
        f: usize,
        open: &[bool],
        near: Nearness,
        inner: &mut [Vec<(f64, u32)>],
    ) {
        let [a, b] = edges[e].ends.map(|v| self.positions[v as usize]);
        let along = b - a;
        let length = along.length();
        for (k, &v) in edges[f].ends.iter().enumerate() {
            if edges[e].ends.contains(&v) || inner[e].iter().any(|n| n.1 == v) {
                continue;
            }
            let p = self.positions[v as usize] - a;
            let s = p.dot(along) / (length * length);
            let off = (p - along * s).length();
            let within = s * length > near.rounding && (1.0 - s) * length > near.rounding;
            // Chords lie beside each other; what crosses at an angle is not the same border.
            let other = self.positions[edges[f].ends[1 - k] as usize] - self.positions[v as usize];
            let beside = other.cross(along).length() < BESIDE * other.length() * length;
            let gap = open[v as usize] || edges[e].pieces == 1;
            let is_soft = self.soft[v as usize]
                || !edges[e].is_exact && edges[e].ends.iter().any(|w| self.soft[*w as usize]);
            let chord = gap
                && is_soft
                && beside
                && off <= near.chords.min((SAGITTA * length).max(SURELY * near.chords));
            if within && (off <= near.rounding || chord) {
                inner[e].push((s, v));
            }
        }
    }
}

/// Parts of borders shorter than this share of what chords may be apart close, in so many rounds.
const SHORT: f64 = 0.42;
/// The same between nodes at both of which borders end or branch.
const SHORT_ENDS: f64 = 0.35;
const SHORT_ROUNDS: usize = 2;
/// Parts that an edge is cut into, at most.
const MOST_PARTS: f64 = 1e5;
/// Rounds of merging nodes across gaps, at most.
const ROUNDS: usize = 6;
/// Borders are cut in at most so many places for every node of them, and so many more: those that lie in a tangle, as about the pole of a
/// dome whose needles a file has rounded, would be cut without end.
const MOST_CUTS: usize = 10;
const MOST_ANYWAY: usize = 2000;
/// Nodes of chords that are one are no farther apart than this share of an edge.
const MERGED_EDGE: f64 = 0.4;
/// A chord is no farther than this share of its length from its arc, if one of eight closes a circle.
const SAGITTA: f64 = 0.2;
/// A node is put back on planes over this share of its shortest edge, or it may pass what is beside it.
const MOVED: f64 = 0.5;
/// What is nearer than this share of the distance that chords may have is one, however short its edges: walls are not so thin.
const SURELY: f64 = 0.25;
/// Sine of the angle between chords of the same border, at most.
const BESIDE: f64 = 0.5;

#[cfg(test)]
mod tests {
    use super::*;

    /// An ear on the outside of a box, its middle a little above that of the floor: the edge between floor and wall ends in the rounds of
    /// the upright edges, but lies where it lies.
    #[test]
    fn what_two_planes_meet_in_is_not_drawn_to_what_lies_beside_it() {
        let positions =
            [[0.0, 0.0], [80.0, 0.0], [30.0, 0.5], [50.0, 0.5]].map(|[x, z]| DVec3::new(x, 0.0, z));
        let borders = [([0, 1], 0), ([0, 1], 1), ([2, 3], 2)];
        let path = |first_curved: u32| {
            let merged = Merged::new(positions.len());
            let near = Nearness { rounding: 1e-6, chords: 0.7 };
            let soft = [true, true, false, false];
            Seams::new(positions.to_vec(), merged, &borders, first_curved, &soft, near).path(0, 1)
        };
        assert_eq!(path(3), [0, 1]);
        // If one of the two is curved it is a chord, and what is beside it may be the same border.
        assert_eq!(path(1), [0, 2, 3, 1]);
    }

    /// The next chord of a finely meshed bend came to lie on the border that it runs along, and this is cut for the plane on the other side.
    #[test]
    fn what_came_to_lie_on_a_border_is_cut_as_that_is() {
        let positions =
            [[0.0, 0.0], [80.0, 0.0], [0.0, 0.1], [80.0, 0.1]].map(|[x, z]| DVec3::new(x, 0.0, z));
        let borders = [([0, 1], 0), ([0, 1], 1)];
        let mut merged = Merged::new(positions.len());
        merged.join(0, 2);
        merged.join(1, 3);
        let near = Nearness { rounding: 1e-6, chords: 0.7 };
        let mut seams = Seams::new(positions.to_vec(), merged, &borders, 1, &[true; 4], near);
        seams.refine(|piece, _| if piece == 0 { 30.0 } else { f64::INFINITY });
        assert_eq!(seams.path(0, 1).len(), 4);
        assert_eq!(seams.path(2, 3), seams.path(0, 1));
        assert_eq!(seams.path(3, 2), seams.path(1, 0));
        assert_eq!(seams.path(0, 2), [0]);
    }

    /// The side of a wall ends on a boss in chords: drawn to a node of the boss, its own would draw the whole of it aside.
    #[test]
    fn nodes_of_plane_pieces_stay_on_their_planes() {
        let positions =
            [[0.0, 0.0], [40.0, 0.0], [40.1, 0.2], [40.1, 20.0]].map(|[x, z]| DVec3::new(x, 0.0, z));
        let borders = [([0, 1], 0), ([2, 3], 1)];
        let near = Nearness { rounding: 1e-6, chords: 0.5 };
        let end = |first_curved: u32| {
            let merged = Merged::new(positions.len());
            let soft = [false, true, true, false];
            let mut seams = Seams::new(positions.to_vec(), merged, &borders, first_curved, &soft, near);
            let planes = [(DVec3::Z, 0.0), (DVec3::X, 40.1)].map(|(normal, offset)| Plane { normal, offset });
            seams.put_on_planes(|piece| planes[..first_curved as usize].get(piece as usize).copied(), near);
            let [a, b] = [seams.path(0, 1)[1], seams.path(2, 3)[0]];
            assert_eq!(a, b);
            seams.positions[a as usize]
        };
        assert!(end(1).abs_diff_eq(DVec3::new(40.0, 0.0, 0.0), 1e-9));
        // Two planes meet in a line.
        assert!(end(2).abs_diff_eq(DVec3::new(40.1, 0.0, 0.0), 1e-9));
    }
}
