//! Where nodes go: to where the mid-planes about them meet.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use glam::{DMat3, DVec3};

use super::super::eigen::eigen;
use super::super::seams::Merged;
use super::super::solid::Solid;
use super::NEAR;
use super::sides::{Facet, Sides};

/// Directions in which all planes lean by less than some 0.2°, in parts of their weight, are not held.
const HELD: f64 = 1e-5;
/// Nodes go no farther than this many times the thickness.
const REACH: f64 = 1.0;
/// Nodes of one side in places as near as this share of the thickness are one.
const SAME: f64 = 2e-3;
/// Ends of walls are no wider than this many thicknesses.
const END: f64 = 1.5;

/// Where a node goes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place {
    pub(super) at: DVec3,
    /// How many directions planes of sure facets hold it in.
    rank: u32,
}

/// What planes say of a place.
#[derive(Clone, Copy, Debug)]
struct Planes {
    matrix: DMat3,
    right: DVec3,
    weight: f64,
    thickness: f64,
}

impl Planes {
    const NONE: Self = Self { matrix: DMat3::ZERO, right: DVec3::ZERO, weight: 0.0, thickness: 0.0 };

    /// Adds where a facet goes, seen from a place.
    fn add(&mut self, facet: &Facet, weight: f64, from: DVec3) {
        let n = facet.normal;
        self.matrix += DMat3::from_cols(n * n.x, n * n.y, n * n.z) * weight;
        self.right -= n * (weight * facet.height(from));
        self.weight += weight;
        self.thickness = self.thickness.max(facet.thickness);
    }

    /// The shortest way to where all of them meet, and how many directions they hold.
    fn way(&self) -> Option<(DVec3, u32)> {
        let axes = eigen::<3>(|i, j| self.matrix.col(i)[j]).filter(|_| self.weight > 0.0)?;
        let (mut way, mut rank) = (DVec3::ZERO, 0);
        // The surest directions first; what would lead far away is no corner.
        for (value, axis) in axes.into_iter().rev().filter(|(value, _)| *value > HELD * self.weight) {
            let axis = DVec3::from(axis);
            let next = way + axis * (axis.dot(self.right) / value);
            if next.length() > REACH * self.thickness {
                break;
            }
            way = next;
            rank += 1;
        }
        Some((way, rank))
    }
}

/// Where nodes are, or at the border of a side, halfway to the other one. O(n).
pub(super) fn starts(solid: &Solid, sides: &Sides) -> Vec<DVec3> {
    let n = solid.mesh.positions.len();
    let mut of = vec![None; n];
    for f in (0..solid.len()).filter(|f| sides.of(*f).is_some()) {
        solid.mesh.faces[f as usize].iter().for_each(|v| of[*v as usize] = sides.of(f));
    }
    let mut nearest = vec![(END * sides.thickness, None); n];
    for h in 0..3 * solid.len() {
        let [a, b] = solid.adjacency.ends(h);
        if let (Some(s), Some(t)) = (of[a as usize], of[b as usize])
            && s != t
        {
            let length = solid.length(h);
            for (v, w) in [(a as usize, b), (b as usize, a)] {
                if length < nearest[v].0 {
                    nearest[v] = (length, Some(w));
                }
            }
        }
    }
    let at = |v: usize| solid.mesh.positions[v];
    let start = |v: usize| nearest[v].1.map_or(at(v), |w| at(v).midpoint(at(w as usize)));
    (0..n).map(start).collect()
}

/// Where every node goes by what the facets about it say: sure ones, or if there are none, others. O(n).
pub(super) fn places(solid: &Solid, facets: &[Option<Facet>], sides: &Sides, starts: &[DVec3]) -> Vec<Place> {
    let mut about = [vec![Planes::NONE; starts.len()], vec![Planes::NONE; starts.len()]];
    for f in (0..solid.len()).filter(|f| sides.of(*f).is_some()) {
        let Some(facet) = facets[f as usize] else { continue };
        for v in solid.mesh.faces[f as usize].map(|v| v as usize) {
            about[usize::from(facet.is_sure)][v].add(&facet, solid.areas[f as usize], starts[v]);
        }
    }
    let place = |v: usize| {
        let [unsure, sure] = [about[0][v].way(), about[1][v].way()];
        let (way, rank) = sure.or(unsure.map(|(way, _)| (way, 0))).unwrap_or_default();
        Place { at: starts[v] + way, rank }
    };
    (0..starts.len()).map(place).collect()
}

/// Closes rounds: the nearest of their nodes become one, in the place of that which more planes hold. O(n log n).
pub(super) fn close(solid: &Solid, rounds: &[u32], merged: &mut Merged, at: &mut [Place]) {
    // Lengths are compared by their bits: they are not negative.
    let mut queue: BinaryHeap<Reverse<(u64, u32, u32, u32)>> = BinaryHeap::new();
    let length = |a: u32, b: u32, at: &[Place]| at[a as usize].at.distance(at[b as usize].at).to_bits();
    let mut about: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for &f in rounds {
        let [a, b, c] = solid.mesh.faces[f as usize].map(|v| merged.find(v));
        for [a, b] in [[a, b], [b, c], [c, a]] {
            queue.push(Reverse((length(a, b, at), f, a, b)));
            about.entry(a).or_default().push(f);
        }
    }
    while let Some(Reverse((bits, f, a, b))) = queue.pop() {
        let face = solid.mesh.faces[f as usize].map(|v| merged.find(v));
        let [p, q, r] = face;
        let (a, b) = (merged.find(a), merged.find(b));
        if p == q || q == r || r == p {
            continue;
        }
        let now = length(a, b, at);
        if now != bits {
            queue.push(Reverse((now, f, a, b)));
            continue;
        }
        let better = if at[a as usize].rank >= at[b as usize].rank { at[a as usize] } else { at[b as usize] };
        merged.join(a, b);
        let one = merged.find(a);
        at[one as usize] = better;
        // What was far may be near now.
        let mut faces = [a, b].iter().filter_map(|v| about.remove(v)).flatten().collect::<Vec<u32>>();
        faces.retain(|f| {
            let [p, q, r] = solid.mesh.faces[*f as usize].map(|v| merged.find(v));
            p != q && q != r && r != p
        });
        for f in &faces {
            let [p, q, r] = solid.mesh.faces[*f as usize].map(|v| merged.find(v));
            for [p, q] in [[p, q], [q, r], [r, p]] {
                if p != q {
                    queue.push(Reverse((length(p, q, at), *f, p, q)));
                }
            }
        }
        about.entry(one).or_default().extend(faces);
    }
}

/// Puts nodes to where the planes of all facets meet that are taken. O(n).
pub(super) fn settle(
    solid: &Solid,
    facets: &[Option<Facet>],
    taken: &[u32],
    merged: &Merged,
    at: &mut [Place],
) {
    let mut about = vec![Planes::NONE; at.len()];
    for &f in taken {
        let face = solid.mesh.faces[f as usize].map(|v| merged.find(v));
        let [a, b, c] = face;
        let Some(facet) = facets[f as usize].filter(|_| a != b && b != c && c != a) else { continue };
        for v in face.map(|v| v as usize) {
            about[v].add(&facet, solid.areas[f as usize], at[v].at);
        }
    }
    for (place, planes) in at.iter_mut().zip(&about) {
        if let Some((way, rank)) = planes.way() {
            *place = Place { at: place.at + way, rank };
        }
    }
}

/// Makes one of nodes in one place. O(n log n).
pub(super) fn join(solid: &Solid, sides: &Sides, taken: &[u32], merged: &mut Merged, at: &mut [Place]) {
    let nodes = |f: &u32| solid.mesh.faces[*f as usize].map(|v| (v, sides.is_main(*f)));
    let mut all: Vec<(u32, bool)> =
        taken.iter().flat_map(nodes).map(|(v, main)| (merged.find(v), main)).collect();
    all.sort_unstable();
    all.dedup();
    let cell = NEAR * sides.thickness;
    let key = |v: u32| (at[v as usize].at / cell).floor().to_array().map(|x| x as i64);
    let mut cells: BTreeMap<[i64; 3], Vec<(u32, bool)>> = BTreeMap::new();
    let mut near: Vec<[(u32, bool); 2]> = Vec::new();
    for &node in &all {
        let [x, y, z] = key(node.0);
        let beside =
            (-1..=1).flat_map(|i| (-1..=1).flat_map(move |j| (-1..=1).map(move |k| [x + i, y + j, z + k])));
        near.extend(beside.filter_map(|key| cells.get(&key)).flatten().map(|other| [*other, node]));
        cells.entry([x, y, z]).or_default().push(node);
    }
    for [(v, v_main), (w, w_main)] in near {
        let share = if v_main == w_main { SAME } else { NEAR };
        let (a, b) = (merged.find(v), merged.find(w));
        let (p, q) = (at[a as usize], at[b as usize]);
        if a != b && p.at.distance(q.at) < share * sides.thickness {
            merged.join(a, b);
            at[merged.find(a) as usize] = if p.rank >= q.rank { p } else { q };
        }
    }
}
