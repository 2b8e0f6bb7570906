//! Outlines of plates: a walk round facets and over bends.

use std::collections::BTreeMap;

use glam::DVec2;

use super::layout::{Flattening, Layout};
use super::relief::Cut;
use crate::facets::Side;

/// A corner of an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlinePoint {
    /// Where.
    pub at: DVec2,
    /// The line of the sheet along which the outline goes on from here; `None` at the ends of bends and in reliefs.
    pub line: Option<u32>,
}

/// A side of a facet as it lies on the flat sheet, walked with the material to the left.
#[derive(Clone, Copy)]
struct PlanSide {
    side: Side,
    from: DVec2,
    to: DVec2,
    /// Where the side would begin and end without setbacks.
    whole: [DVec2; 2],
}

/// A place in the walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct At {
    facet: u32,
    ring: u32,
    side: u32,
}

pub(crate) struct Outlines<'a> {
    flat: &'a Flattening<'a>,
    layout: &'a Layout,
    relief: Option<Cut>,
    sides: Vec<Vec<Vec<PlanSide>>>,
    /// The other side of every bend.
    twin: BTreeMap<At, At>,
    /// Ends of the drawn bend lines.
    pub(crate) bend_ends: Vec<Vec<DVec2>>,
    /// Reliefs that were cut.
    pub(crate) reliefs: usize,
}

impl<'a> Outlines<'a> {
    pub(crate) fn new(flat: &'a Flattening<'a>, layout: &'a Layout, relief: Option<Cut>) -> Self {
        let mut sides = Vec::with_capacity(flat.shapes.len());
        for (f, shape) in flat.shapes.iter().enumerate() {
            let place = layout.placements[f];
            let rings = shape.loops.iter().zip(&layout.trimmed[f]).map(|(ring, left)| {
                let mut plan: Vec<PlanSide> = ring
                    .iter()
                    .zip(left)
                    .map(|(s, t)| {
                        let [a, b, c, d] = [t.from, t.to, s.from, s.to].map(|p| place.apply(p));
                        if place.mirrored {
                            PlanSide { side: s.side, from: b, to: a, whole: [d, c] }
                        } else {
                            PlanSide { side: s.side, from: a, to: b, whole: [c, d] }
                        }
                    })
                    .collect();
                if place.mirrored {
                    plan.reverse();
                }
                plan
            });
            sides.push(rings.collect::<Vec<_>>());
        }
        let mut ends: BTreeMap<u32, Vec<At>> = BTreeMap::new();
        for (facet, rings) in (0..).zip(&sides) {
            for (ring, plan) in (0..).zip(rings) {
                for (side, s) in (0..).zip(plan) {
                    if let Some(&bend) = layout.bend_at.get(&(facet, s.side)) {
                        ends.entry(bend).or_default().push(At { facet, ring, side });
                    }
                }
            }
        }
        let mut twin = BTreeMap::new();
        for both in ends.values() {
            if let [a, b] = both[..] {
                twin.insert(a, b);
                twin.insert(b, a);
            }
        }
        // A line with the same facet on both sides is no border: something is welded on there.
        let mut through: BTreeMap<(u32, u32), Vec<At>> = BTreeMap::new();
        for (facet, rings) in (0..).zip(&sides) {
            for (ring, plan) in (0..).zip(rings) {
                for (side, s) in (0..).zip(plan) {
                    through.entry((facet, s.side.line)).or_default().push(At { facet, ring, side });
                }
            }
        }
        for both in through.values() {
            if let [a, b] = both[..] {
                twin.insert(a, b);
                twin.insert(b, a);
            }
        }
        let bend_ends = vec![Vec::new(); layout.bends.len()];
        Self { flat, layout, relief, sides, twin, bend_ends, reliefs: 0 }
    }

    fn plan(&self, at: At) -> PlanSide {
        self.sides[at.facet as usize][at.ring as usize][at.side as usize]
    }

    fn next(&self, at: At) -> At {
        let n = self.sides[at.facet as usize][at.ring as usize].len() as u32;
        At { side: (at.side + 1) % n, ..at }
    }

    fn before(&self, at: At) -> At {
        let n = self.sides[at.facet as usize][at.ring as usize].len() as u32;
        At { side: (at.side + n - 1) % n, ..at }
    }

    /// All outlines of a piece, the outer one first.
    pub(crate) fn of_piece(&mut self, piece: u32) -> Vec<Vec<OutlinePoint>> {
        let mut seen: BTreeMap<At, bool> = BTreeMap::new();
        let mut outlines = Vec::new();
        for facet in (0..self.sides.len() as u32).filter(|&f| self.layout.piece[f as usize] == piece) {
            for ring in 0..self.sides[facet as usize].len() as u32 {
                for side in 0..self.sides[facet as usize][ring as usize].len() as u32 {
                    let start = At { facet, ring, side };
                    if !self.twin.contains_key(&start) && !seen.contains_key(&start) {
                        outlines.push(self.walk(start, &mut seen));
                    }
                }
            }
        }
        let area = |o: &Vec<OutlinePoint>| -> f64 {
            (0..o.len()).map(|i| o[i].at.perp_dot(o[(i + 1) % o.len()].at)).sum()
        };
        if let Some(outer) =
            (0..outlines.len()).max_by(|&a, &b| area(&outlines[a]).total_cmp(&area(&outlines[b])))
        {
            outlines.swap(0, outer);
        }
        outlines
    }

    fn walk(&mut self, start: At, seen: &mut BTreeMap<At, bool>) -> Vec<OutlinePoint> {
        let mut path = Path { points: Vec::new(), tolerance: self.flat.tolerance, skip_next: false };
        let mut at = start;
        loop {
            seen.insert(at, true);
            let here = self.plan(at);
            path.go(here.from, Some(here.side.line));
            path.go(here.to, None);
            at = self.next(at);
            // Over all bends that end here.
            let mut landed: Option<At> = None;
            while let Some(&over) = self.twin.get(&at) {
                self.leave(&mut path, at, landed);
                let (a, b) = (self.last(&path), self.plan(over).to);
                if let Some(&bend) = self.layout.bend_at.get(&(at.facet, self.plan(at).side)) {
                    self.bend_ends[bend as usize].push((a + b) / 2.0);
                }
                path.go(b, None);
                landed = Some(over);
                at = self.next(over);
            }
            if let Some(over) = landed {
                self.arrive(&mut path, over, at);
            }
            if at == start || seen.contains_key(&at) {
                break;
            }
        }
        path.closed()
    }

    fn last(&self, path: &Path) -> DVec2 {
        path.points.last().map_or(DVec2::ZERO, |p| p.at)
    }

    fn setback(&self, at: At) -> f64 {
        let bend = self.layout.bend_at.get(&(at.facet, self.plan(at).side));
        bend.map_or(0.0, |&b| self.layout.bends[b as usize].measures.setback)
    }

    /// Whether the facet's edge goes on straight, or turns away, before or after the end of a bend.
    fn goes_on(d: DVec2, e: DVec2) -> bool {
        d.perp_dot(e) <= 0.0 || d.dot(e) > 0.866
    }

    /// Goes to the beginning of a bend's strip on the facet that is walked.
    fn leave(&mut self, path: &mut Path, at: At, landed: Option<At>) {
        let bend = self.plan(at);
        let before = self.plan(self.before(at));
        let [d, e] = [before, bend].map(|s| (s.whole[1] - s.whole[0]).normalize_or_zero());
        let folds = self.setback(at) > 0.0;
        match (self.relief.filter(|_| folds), landed) {
            (Some(cut), None) if Self::goes_on(d, e) => {
                self.reliefs += 1;
                let room = before.whole[0].distance(before.whole[1]);
                if d.dot(e) > 0.5 {
                    path.points.pop();
                }
                for p in cut.beside(bend.whole[0], -e, e.perp(), self.setback(at), room) {
                    path.go(p, None);
                }
            }
            (Some(cut), Some(_)) if self.setback(self.before(at)) > 0.0 && d.perp_dot(e) > 0.0 => {
                self.reliefs += 1;
                let room = before.from.distance(before.to).min(bend.from.distance(bend.to));
                path.points.pop();
                for p in cut.corner(bend.from, d, e, room) {
                    path.go(p, None);
                }
                return;
            }
            _ => {}
        }
        path.go(bend.from, None);
    }

    /// Goes from the end of a bend's strip on to the facet's next side.
    fn arrive(&mut self, path: &mut Path, bend: At, next: At) {
        let (b, n) = (self.plan(bend), self.plan(next));
        let [e, d] = [b, n].map(|s| (s.whole[1] - s.whole[0]).normalize_or_zero());
        if let Some(cut) = self.relief
            && self.setback(bend) > 0.0
            && Self::goes_on(e, d)
        {
            self.reliefs += 1;
            let room = n.whole[0].distance(n.whole[1]);
            let mut points = cut.beside(b.whole[1], e, e.perp(), self.setback(bend), room);
            points.reverse();
            for p in points {
                path.go(p, None);
            }
            path.skip_next = d.dot(e) > 0.5;
        }
    }
}

/// An outline being walked.
struct Path {
    points: Vec<OutlinePoint>,
    tolerance: f64,
    skip_next: bool,
}

impl Path {
    /// Goes to a point, from which the outline runs along a line. Points in one place are one.
    fn go(&mut self, at: DVec2, line: Option<u32>) {
        if std::mem::take(&mut self.skip_next) {
            // The side begins where the relief ended.
            if let Some(last) = self.points.last_mut() {
                last.line = line;
            }
            return;
        }
        match self.points.last_mut() {
            Some(last) if last.at.distance(at) <= self.tolerance => last.line = line.or(last.line),
            _ => self.points.push(OutlinePoint { at, line }),
        }
    }

    fn closed(mut self) -> Vec<OutlinePoint> {
        // The first side begins where the last relief ended.
        if self.skip_next && self.points.len() > 1 {
            let line = self.points.remove(0).line;
            if let Some(last) = self.points.last_mut() {
                last.line = line;
            }
        }
        while let [first, .., last] = self.points[..]
            && first.at.distance(last.at) <= self.tolerance
        {
            self.points.pop();
        }
        self.points
    }
}
