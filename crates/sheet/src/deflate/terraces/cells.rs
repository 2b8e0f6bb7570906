//! What lies over and under every cell of the overlay.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use spade::{Point2, Triangulation};

use super::overlay::{Cdt, Outlines, width};
use super::{Plate, ROUNDING, SHARP, Terraces};

/// A line across a plate begins this many of the largest thickness before it.
const START: f64 = 1.5;

/// Faces of one side lie over each other where a plate forks, if by more than this share of the largest thickness: chords may by less.
const FORK: f64 = 0.1;

/// A middle of a cell, and the faces over and under it.
pub(super) type Layer = (u32, [u32; 2]);

/// The middles of a cell, the highest first; none outside.
pub(super) type Cell = Vec<Layer>;

impl Terraces<'_> {
    /// Whether a line across the plate at a point meets its material.
    fn is_inside(&self, plate: &Plate, p: DVec3) -> bool {
        let start = p + plate.normal * (START * self.walls.max_thickness);
        let hit = self.solid.caster.first(start, -plate.normal, 0.0, 2.0 * START * self.walls.max_thickness);
        hit.is_some()
    }

    /// Whether a face of a plate goes on in a wall that is none of it, smoothly or around a corner: leaves would have to be cut to other lengths
    /// than the plate there.
    fn runs_on(&self, plate: &Plate, g: u32) -> bool {
        let Self { solid, segments, walls, .. } = *self;
        let is_other =
            |o: u32| walls.is_wall[o as usize] && !plate.facing.contains(&o) && !plate.opposite.contains(&o);
        let is_hollow = |h: u32| solid.fold_cosine(h) < SHARP.cos() && !solid.is_convex(h);
        let mut sides = segments.group(g).faces.iter().flat_map(|f| 3 * f..3 * f + 3);
        sides.any(|h| is_other(segments.of(solid.across(h))) && !is_hollow(h))
    }

    /// What lies over and under every region; `None` where faces lie over each other that do not belong together, and where a plate forks that
    /// runs on in another wall.
    pub(super) fn cells(
        &self,
        plate: &Plate,
        outlines: &Outlines,
        cdt: &Cdt,
        regions: &[Option<usize>],
    ) -> Option<Vec<Cell>> {
        let count = regions.iter().flatten().max().map_or(0, |r| r + 1);
        // A point in the largest triangle of each.
        let mut largest = vec![(0.0f64, DVec2::ZERO); count];
        for face in cdt.inner_faces() {
            let Some(r) = regions[face.index()] else { continue };
            let longest = face.adjacent_edges().into_iter().map(|e| e.length_2()).fold(0.0, f64::max).sqrt();
            // What is no wider than rounding lies between outlines that should be one.
            if face.area() > largest[r].0.max(ROUNDING * self.solid.size * longest) {
                let Point2 { x, y } = face.center();
                largest[r] = (face.area(), DVec2::new(x, y));
            }
        }
        let over: Vec<BTreeSet<u32>> = largest.par_iter().map(|(_, p)| outlines.about(*p)).collect();
        let wide = FORK * self.walls.max_thickness;
        let is_forked = |side: &[u32], r: usize| side.iter().filter(|g| over[r].contains(g)).count() > 1;
        let forked = (0..count).filter(|r| is_forked(&plate.facing, *r) || is_forked(&plate.opposite, *r));
        let mut forks: BTreeMap<usize, Cell> = BTreeMap::new();
        for r in forked.filter(|r| largest[*r].0 > 0.0) {
            let runs_on = || over[r].iter().any(|g| self.runs_on(plate, *g));
            match self.layers(plate, &over[r], outlines.lifted(largest[r].1)) {
                Some(layers) if !runs_on() => _ = forks.insert(r, layers),
                // Chords may lie over each other by a little.
                _ if width(cdt, regions, r) > wide => return None,
                _ => {}
            }
        }
        let of = |side: &[u32], r: usize| side.iter().copied().find(|g| over[r].contains(g));
        let mut sides: Vec<[Option<u32>; 2]> =
            (0..count).map(|r| [of(&plate.facing, r), of(&plate.opposite, r)]).collect();
        // How long the borders of regions with each other are.
        let mut shared: BTreeMap<[usize; 2], f64> = BTreeMap::new();
        let mut is_outer = vec![false; count];
        for edge in cdt.directed_edges() {
            let Some(r) = regions[edge.face().index()] else { continue };
            match regions[edge.rev().face().index()] {
                Some(other) if other != r => *shared.entry([r, other]).or_default() += edge.length_2().sqrt(),
                None => is_outer[r] = true,
                _ => {}
            }
        }
        // What is over nothing on either side is a hole, but where slanting steps of both sides lie over each other; what is beside a hole
        // and not over the kept side is so too.
        let is_sliver: Vec<bool> = largest.iter().map(|(area, _)| *area == 0.0).collect();
        let is_hole = |r: usize| {
            sides[r] == [None, None] && !is_sliver[r] && !self.is_inside(plate, outlines.lifted(largest[r].1))
        };
        let mut is_out: Vec<bool> = (0..count).map(is_hole).collect();
        let mut more = true;
        while std::mem::take(&mut more) {
            for [r, other] in shared.keys() {
                let beside = is_out[*other] || is_outer[*r];
                if beside && sides[*r][0].is_none() && !is_out[*r] && !is_sliver[*r] {
                    (is_out[*r], more) = (true, true);
                }
            }
        }
        let number = |s: [Option<u32>; 2]| {
            let pair = [s[0]?, s[1]?];
            Some((self.middles.between(pair[0], pair[1])?.1, pair))
        };
        let known = sides.iter().zip(&is_sliver).map(|(s, is_sliver)| number(*s).filter(|_| !is_sliver));
        let mut cells: Vec<Option<Layer>> = known.collect();
        for (r, layers) in &forks {
            cells[*r] = layers.first().copied();
        }
        // Where only one side is known, as below a rib, it is as beside that.
        let mut by_length: Vec<([usize; 2], f64)> = shared.into_iter().collect();
        by_length.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        let mut more = true;
        while std::mem::take(&mut more) {
            for ([r, other], _) in &by_length {
                if is_out[*r] || cells[*r].is_some() {
                    continue;
                }
                if is_out[*other] {
                    (is_out[*r], more) = (is_sliver[*r], more || is_sliver[*r]);
                    continue;
                }
                let Some(beside) = cells[*other] else { continue };
                let own = sides[*r];
                let filled = [own[0].or(Some(beside.1[0])), own[1].or(Some(beside.1[1]))];
                sides[*r] = filled;
                cells[*r] = number(filled).or(Some(beside));
                more = true;
            }
        }
        cells.iter_mut().zip(is_out).filter(|(_, is_out)| *is_out).for_each(|(cell, _)| *cell = None);
        let mut cells: Vec<Cell> = cells.into_iter().map(Vec::from_iter).collect();
        forks.into_iter().for_each(|(r, layers)| cells[r] = layers);
        Some(cells)
    }

    /// The layers of a plate over a point where it forks, from the highest to the lowest; `None` unless its faces there face up and down in
    /// turn.
    fn layers(&self, plate: &Plate, over: &BTreeSet<u32>, at: DVec3) -> Option<Cell> {
        let height = |g: &u32| {
            let plane = self.segments.group(*g).plane?;
            Some((-plane.height(at) / plane.normal.dot(plate.normal), *g))
        };
        let mut faces: Vec<(f64, u32)> = over.iter().map(height).collect::<Option<_>>()?;
        faces.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let layer = |pair: &[(f64, u32)]| {
            let [(_, over), (_, under)] = *pair else { return None };
            let belong = plate.facing.contains(&over) && plate.opposite.contains(&under);
            Some((self.middles.between(over, under).filter(|_| belong)?.1, [over, under]))
        };
        faces.chunks(2).map(layer).collect()
    }
}

/// Gives all cells the middle that most of the plate has; `None` if it forks.
pub(super) fn align(cells: &mut [Cell], cdt: &Cdt, regions: &[Option<usize>]) -> Option<()> {
    if cells.iter().any(|cell| cell.len() > 1) {
        return None;
    }
    let mut areas: BTreeMap<u32, f64> = BTreeMap::new();
    for face in cdt.inner_faces() {
        if let Some((number, _)) = regions[face.index()].and_then(|r| cells[r].first()) {
            *areas.entry(*number).or_default() += face.area();
        }
    }
    if let Some((most, _)) = areas.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)) {
        cells.iter_mut().flatten().for_each(|layer| layer.0 = most);
    }
    Some(())
}
