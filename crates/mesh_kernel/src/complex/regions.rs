//! The two sides of faces, joined round edges in radial order: which regions a face parts.
//!
//! About an edge, the side of a use that looks onwards (clockwise) and the side of the next use that looks back bound one sector.
//! Sides that one can walk to from each other bound one region. In faces that hang together by edges (a *sheet*) these classes
//! and the regions of space correspond one to one, so voids = classes − sheets; meeting at vertices changes neither.

use std::collections::{BTreeMap, HashSet, VecDeque};

use super::Complex;
use super::connected::Sets;
use super::homology::rank_of_faces;
use super::ids::{EdgeId, FaceId, FaceUse, Loop};
use super::operation::FaceKind;
use super::refusal::Reason;

/// A side of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Side {
    face: FaceId,
    /// Where the normal looks.
    front: bool,
}

/// The side of a use that looks clockwise. A face that runs along the edge has its normal clockwise of it: seen along the edge
/// with the face below, the normal points to the left, and clockwise from below is left.
fn onwards(u: FaceUse) -> Side {
    Side { face: u.face, front: u.along }
}

/// The side of a use that looks counterclockwise.
fn back(u: FaceUse) -> Side {
    Side { face: u.face, front: !u.along }
}

/// A face that is not yet there, with the radial orders that its edges would have.
struct Plus<'a> {
    face: FaceId,
    loops: &'a [Loop],
    orders: &'a BTreeMap<EdgeId, Vec<FaceUse>>,
}

/// A walk over sides.
struct Walk<'a> {
    complex: &'a Complex,
    plus: Option<Plus<'a>>,
}

impl Walk<'_> {
    fn uses(&self, e: EdgeId) -> &[FaceUse] {
        match &self.plus {
            Some(plus) if plus.orders.contains_key(&e) => &plus.orders[&e],
            _ => self.complex.uses(e),
        }
    }

    fn loops(&self, f: FaceId) -> &[Loop] {
        match &self.plus {
            Some(plus) if plus.face == f => plus.loops,
            _ => self.complex.loops(f),
        }
    }

    /// Sides met round the edges of a side's face.
    fn beside(&self, s: Side, mut visit: impl FnMut(Side)) {
        for d in self.loops(s.face).iter().flat_map(Loop::edges) {
            let uses = self.uses(d.edge);
            let this = FaceUse { face: s.face, along: !d.reversed };
            let Some(i) = uses.iter().position(|u| *u == this) else { continue };
            let n = uses.len();
            visit(if onwards(this) == s { back(uses[(i + 1) % n]) } else { onwards(uses[(i + n - 1) % n]) });
        }
    }

    /// Walks from a side until all wanted are found; tells which were not.
    fn seek(&self, from: Side, wanted: &[Side]) -> Vec<Side> {
        let mut missing: HashSet<Side> = wanted.iter().copied().collect();
        missing.remove(&from);
        let mut seen = HashSet::from([from]);
        let mut queue = VecDeque::from([from]);
        while !missing.is_empty()
            && let Some(s) = queue.pop_front()
        {
            self.beside(s, |next| {
                if seen.insert(next) {
                    missing.remove(&next);
                    queue.push_back(next);
                }
            });
        }
        wanted.iter().copied().filter(|s| missing.contains(s)).collect()
    }

    /// Faces that hang on one by edges.
    fn sheet(&self, from: FaceId) -> HashSet<FaceId> {
        let mut seen = HashSet::from([from]);
        let mut queue = VecDeque::from([from]);
        while let Some(f) = queue.pop_front() {
            for d in self.loops(f).iter().flat_map(Loop::edges) {
                for u in self.uses(d.edge) {
                    if seen.insert(u.face) {
                        queue.push_back(u.face);
                    }
                }
            }
        }
        seen
    }
}

fn free_edge(loops: &[Loop], uses: impl Fn(EdgeId) -> usize) -> bool {
    loops.iter().flat_map(Loop::edges).any(|d| uses(d.edge) == 1)
}

impl Complex {
    /// What a face does that is there. O(loops) where it has a free edge, else O(its component) at most.
    pub(super) fn kind_of_face(&self, f: FaceId) -> FaceKind {
        if free_edge(self.loops(f), |e| self.uses(e).len()) {
            return FaceKind::Chole;
        }
        let walk = Walk { complex: self, plus: None };
        let [front, behind] = [true, false].map(|front| Side { face: f, front });
        if walk.seek(front, &[behind]).is_empty() { FaceKind::Chole } else { FaceKind::Cavity }
    }

    /// What a new face would do, `orders` being those of all its edges with it.
    ///
    /// O(loops) where at most one edge has other faces and another none; else O(component) at most, near O(loops) where its
    /// neighbours are near to each other.
    pub(super) fn kind_of_new_face(
        &self,
        face: FaceId,
        loops: &[Loop],
        orders: &BTreeMap<EdgeId, Vec<FaceUse>>,
    ) -> Result<FaceKind, Reason> {
        self.must_be_in_one_region(face, orders)?;
        if free_edge(loops, |e| orders.get(&e).map_or(0, Vec::len)) {
            return Ok(FaceKind::Chole);
        }
        let walk = Walk { complex: self, plus: Some(Plus { face, loops, orders }) };
        let [front, behind] = [true, false].map(|front| Side { face, front });
        if !walk.seek(front, &[behind]).is_empty() {
            return Ok(FaceKind::Cavity);
        }
        // One region on both sides. If it closes a surface all the same, that surface does not lie in space.
        let old = Walk { complex: self, plus: None };
        let mut faces = HashSet::new();
        for u in orders.values().flatten().filter(|u| u.face != face) {
            if !faces.contains(&u.face) {
                faces.extend(old.sheet(u.face));
            }
        }
        let mut faces: Vec<FaceId> = faces.into_iter().collect();
        faces.sort_unstable();
        let before = rank_of_faces(faces.iter().map(|f| self.loops(*f)));
        let after = rank_of_faces(faces.iter().map(|f| self.loops(*f)).chain([loops]));
        if before == after {
            let beside: Vec<FaceUse> = orders.values().flatten().copied().collect();
            let mut faces: Vec<FaceId> = beside.iter().map(|u| u.face).filter(|f| *f != face).collect();
            faces.sort_unstable();
            faces.dedup();
            return Err(Reason::NotSeparating { faces });
        }
        Ok(FaceKind::Chole)
    }

    /// Of each sheet that a new face touches, all sectors into which it goes must be of one region.
    fn must_be_in_one_region(
        &self,
        face: FaceId,
        orders: &BTreeMap<EdgeId, Vec<FaceUse>>,
    ) -> Result<(), Reason> {
        let mut sectors: Vec<Side> = Vec::new();
        for uses in orders.values() {
            let n = uses.len();
            for (i, _) in uses.iter().enumerate().filter(|(_, u)| u.face == face) {
                // The old use before it; a face that has the edge alone has no sector to lie in.
                let before = (1..n).map(|k| uses[(i + n - k) % n]).find(|u| u.face != face);
                sectors.extend(before.map(onwards));
            }
        }
        let walk = Walk { complex: self, plus: None };
        while let Some(from) = sectors.pop() {
            if sectors.is_empty() {
                break;
            }
            sectors = walk.seek(from, &sectors);
            if !sectors.is_empty() {
                let sheet = walk.sheet(from.face);
                if let Some(other) = sectors.iter().find(|s| sheet.contains(&s.face)) {
                    return Err(Reason::TwoRegions { between: [from.face, other.face] });
                }
            }
        }
        Ok(())
    }

    /// Number of cavities, from the radial order alone. O(loops of all faces).
    pub(super) fn cavities(&self) -> i64 {
        let mut sides = Sets::new(2 * self.faces.bound());
        let mut sheets = Sets::new(self.faces.bound());
        let number = |s: Side| 2 * s.face.0 + u32::from(!s.front);
        let (mut classes, mut count) = (2 * self.face_count() as i64, self.face_count() as i64);
        for (_, edge) in self.edges.iter() {
            for (u, next) in edge.uses.iter().zip(edge.uses.iter().cycle().skip(1)) {
                classes -= i64::from(sides.union(number(onwards(*u)), number(back(*next))));
                count -= i64::from(sheets.union(u.face.0, next.face.0));
            }
        }
        classes - count
    }

    /// The classes of sides that one can walk to from each other: for every face id that of its front and that of its back, numbered
    /// from 0 in the order of faces; dead ids have none. O(loops of all faces).
    pub fn side_classes(&self) -> BTreeMap<FaceId, [u32; 2]> {
        let mut sides = Sets::new(2 * self.faces.bound());
        let number = |s: Side| 2 * s.face.0 + u32::from(!s.front);
        for (_, edge) in self.edges.iter() {
            for (u, next) in edge.uses.iter().zip(edge.uses.iter().cycle().skip(1)) {
                sides.union(number(onwards(*u)), number(back(*next)));
            }
        }
        let mut numbers = BTreeMap::new();
        let mut name = |root: u32| {
            let n = numbers.len() as u32;
            *numbers.entry(root).or_insert(n)
        };
        self.faces().map(|f| (f, [2 * f.0, 2 * f.0 + 1].map(|s| name(sides.find(s))))).collect()
    }
}
