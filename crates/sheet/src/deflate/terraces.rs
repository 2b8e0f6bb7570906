//! Plates whose thickness steps on both sides.
//!
//! Where a plate is stepped on one side only, that side is cut where its middle steps and is kept ([`super::sides`]). Where both sides have
//! steps, neither knows of the other's: the outlines of both are laid over each other, and every cell between them has the middle of the
//! two faces that lie over and under it there. Between cells of different middles stand steps. A plate that forks, as one with a slot milled
//! into its edge does, has cells with several middles, one over the other.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};

use super::Steps;
use super::assemble::Moved;
use super::middle::Middles;
use super::nearness::near_pairs;
use super::plan::{PlanePiece, border};
use super::plane::{Plane, PlaneTable};
use super::seams::Merged;
use super::segments::Segments;
use super::sides::Parity;
use super::solid::{SHARP, Solid};
use super::walls::Walls;

/// Faces of a plate are parallel to this cosine.
const PARALLEL: f64 = 1.0 - 1e-9;
/// The end of a slot stands on its sides to this cosine.
const UPRIGHT: f64 = 0.3;
/// Nodes over each other to this share of the solid's size are one.
const ROUNDING: f64 = 1e-6;
/// A line across a plate begins this many of the largest thickness before it.
const START: f64 = 1.5;
/// Faces of one side lie over each other where a plate forks, if by more than this share of the largest thickness: chords may by less.
const FORK: f64 = 0.1;
/// Plates with more edges than this are left as they are.
const MOST_EDGES: usize = 10_000;

/// A middle of a cell, and the faces over and under it.
type Layer = (u32, [u32; 2]);
/// The middles of a cell, the highest first; none outside.
type Cell = Vec<Layer>;

/// A node of the overlay.
#[derive(Clone, Copy, Debug)]
struct Corner {
    at: Point2<f64>,
    soft: bool,
}

impl HasPosition for Corner {
    type Scalar = f64;
    fn position(&self) -> Point2<f64> {
        self.at
    }
}

type Cdt = ConstrainedDelaunayTriangulation<Corner>;

/// What is needed to lay outlines over each other.
pub(super) struct Terraces<'a> {
    pub(super) solid: &'a Solid,
    pub(super) segments: &'a Segments,
    pub(super) walls: &'a Walls,
    pub(super) middles: &'a Middles,
    /// Groups that the sheet is made without.
    pub(super) gone: &'a [bool],
    pub(super) steps: Steps,
}

/// A plate's faces on the side of the first kept one, those opposite to them, and where the former face.
struct Plate {
    facing: Vec<u32>,
    opposite: Vec<u32>,
    normal: DVec3,
}

/// The outlines of a plate's faces, seen from the side of the first kept one.
struct Outlines {
    frame: [DVec3; 2],
    origin: DVec3,
    places: Vec<DVec2>,
    /// Nodes of the solid, with their places.
    nodes: Vec<(u32, u32)>,
    /// Of every place, whether it is only as exact as chords are.
    soft: Vec<bool>,
    /// With their groups.
    edges: Vec<(u32, [u32; 2])>,
    /// What is nearer than this is one, in mm.
    rounding: f64,
}

impl Terraces<'_> {
    /// Pieces of the plates that step on both sides, whose groups are kept no longer; their nodes are added to those that moved.
    /// O(n log n) and cells times edges.
    pub(super) fn pieces(&self, kept: &mut [bool], moved: &mut Moved) -> Vec<PlanePiece> {
        let mut pieces = Vec::new();
        for plate in self.plates(kept) {
            if let Some(made) = self.cut(&plate, moved) {
                plate.facing.iter().chain(&plate.opposite).for_each(|g| kept[*g as usize] = false);
                pieces.extend(made);
            }
        }
        pieces
    }

    /// Plates a kept face of which has several middles.
    fn plates(&self, kept: &[bool]) -> Vec<Plate> {
        let n = self.segments.groups.len() as u32;
        let mut sets = Parity::new(n as usize);
        let has_middle = |g: u32| !self.middles.of_group[g as usize].is_empty();
        for pair in self.walls.pairs.iter().filter(|p| has_middle(p.group) && has_middle(p.partner)) {
            if self.middles.between(pair.group, pair.partner).is_some() {
                sets.relate(pair.group, pair.partner, false);
            }
        }
        for [a, b] in self.slots(&has_middle) {
            sets.relate(a, b, false);
        }
        let mut members: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for g in (0..n).filter(|g| has_middle(*g)) {
            members.entry(sets.find(g).0).or_default().push(g);
        }
        let plate = |members: Vec<u32>| {
            let mut of_kept = members.iter().filter(|g| kept[**g as usize]);
            if !of_kept.clone().any(|g| self.middles.of_group[*g as usize].len() > 1) {
                return None;
            }
            let normal = self.segments.group(*of_kept.next()?).plane?.normal;
            let faces = |g: &u32| self.segments.group(*g).plane.map_or(0.0, |p| p.normal.dot(normal));
            let is_plate = members.iter().all(|g| faces(g).abs() > PARALLEL);
            let (facing, opposite) = members.into_iter().partition(|g| faces(g) > 0.0);
            is_plate.then_some(Plate { facing, opposite, normal })
        };
        members.into_values().filter_map(plate).collect()
    }

    /// Pairs of faces that look at each other across a slot: both stand upright in the same hollow on what is no wall, the slot's end.
    fn slots(&self, has_middle: &dyn Fn(u32) -> bool) -> Vec<[u32; 2]> {
        let Self { solid, segments, walls, .. } = *self;
        let within = 0.0..walls.max_thickness;
        let mut found = Vec::new();
        for (group, is_wall) in segments.groups.iter().zip(&walls.is_wall) {
            let Some(end) = group.plane.filter(|_| !is_wall) else { continue };
            let sides = group.faces.iter().flat_map(|f| 3 * f..3 * f + 3);
            let hollow = sides.filter(|h| solid.fold_cosine(*h) < SHARP.cos() && !solid.is_convex(*h));
            let beside: BTreeSet<u32> = hollow.map(|h| segments.of(solid.across(h))).collect();
            let wall = |g: &u32| Some((*g, segments.group(*g).plane.filter(|_| has_middle(*g))?));
            let is_upright = |wall: &(u32, Plane)| wall.1.normal.dot(end.normal).abs() < UPRIGHT;
            let walls: Vec<(u32, Plane)> = beside.iter().filter_map(wall).filter(is_upright).collect();
            for (k, (a, plane)) in walls.iter().enumerate() {
                let faces_it = |(b, other): &&(u32, Plane)| {
                    let across = solid.centroid(segments.group(*b).faces[0]);
                    plane.normal.dot(other.normal) < -PARALLEL && within.contains(&plane.height(across))
                };
                found.extend(walls[k + 1..].iter().filter(faces_it).map(|(b, _)| [*a, *b]));
            }
        }
        found
    }

    /// The pieces of a plate; `None` where outlines cannot be laid over each other.
    fn cut(&self, plate: &Plate, moved: &mut Moved) -> Option<Vec<PlanePiece>> {
        let outlines = self.outlines(plate, moved);
        let (cdt, handles) = outlines.overlay()?;
        let regions = regions(&cdt);
        let mut cells = self.cells(plate, &outlines, &cdt, &regions)?;
        if self.steps == Steps::Aligned {
            align(&mut cells, &cdt, &regions)?;
        }
        let cell = |face: usize| regions[face].map_or(&[][..], |r| &cells[r]);
        // What stands on the plate or is beside it stands where the plate is now: a step below a wall is not in its middle.
        for &(node, place) in &outlines.nodes {
            let Some(vertex) = handles.get(&place) else { continue };
            let faces = cdt.vertex(*vertex).out_edges().map(|edge| edge.face().index());
            let about: BTreeSet<u32> =
                faces.flat_map(|face| cell(face).iter().map(|layer| layer.0)).collect();
            if about.len() == 1
                && let Some(number) = about.first()
            {
                let level = self.level(plate, *number);
                let p = &mut moved.positions[node as usize];
                *p -= level.normal * level.height(*p);
            }
        }
        let mut nodes = Nodes { outlines: &outlines, cdt: &cdt, numbers: BTreeMap::new() };
        let mut levels: BTreeMap<u32, (BTreeSet<u32>, Vec<[u32; 2]>)> = BTreeMap::new();
        let mut steps = Vec::new();
        for edge in cdt.directed_edges() {
            let (left, right) = (cell(edge.face().index()), cell(edge.rev().face().index()));
            let ends = [edge.from().fix(), edge.to().fix()];
            let mut lifted = |number: u32| {
                let level = self.level(plate, number);
                ends.map(|v| nodes.lifted(v, number, level, moved))
            };
            for layer in left.iter().filter(|layer| !right.contains(layer)) {
                let (of, outline) = levels.entry(layer.0).or_default();
                of.extend(layer.1);
                outline.push(lifted(layer.0));
            }
            // A step has a cell on both sides; it is made from the one whose numbers come first.
            let numbers = |cell: &[Layer]| cell.iter().map(|layer| layer.0).collect::<Vec<_>>();
            if numbers(left) < numbers(right) && self.steps != Steps::Apart {
                let Point2 { x, y } = edge.center();
                let middle = outlines.lifted(DVec2::new(x, y));
                for [low, high] in self.steps_at(plate, left, right, middle) {
                    let ([a, b], [c, d]) = (lifted(low), lifted(high));
                    steps.push([a, b, d, c]);
                }
            }
        }
        let levels = levels.into_iter().map(|(number, (groups, outline))| PlanePiece {
            groups: groups.into_iter().map(|g| (g, true)).collect(),
            outline,
            ..PlanePiece::new(self.level(plate, number), false)
        });
        let mut pieces: Vec<PlanePiece> = levels.collect();
        pieces.extend(self.steps(&steps, &moved.positions));
        Some(pieces)
    }

    /// Pairs of middles between which steps stand over a point that two different cells share: those of the two; where one forks, all that
    /// follow on each other within the material.
    fn steps_at(&self, plate: &Plate, left: &[Layer], right: &[Layer], at: DVec3) -> Vec<[u32; 2]> {
        match (left, right) {
            ([], _) | (_, []) => return Vec::new(),
            ([(a, _)], [(b, _)]) => return vec![[*a, *b]],
            _ => {}
        }
        let height = |plane: Plane| -plane.height(at) / plane.normal.dot(plate.normal);
        let of_group = |g: u32| self.segments.group(g).plane.map_or(0.0, height);
        let layers = || left.iter().chain(right);
        let mut levels: Vec<(f64, u32)> = layers().map(|l| (height(self.level(plate, l.0)), l.0)).collect();
        levels.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        levels.dedup_by_key(|l| l.1);
        let filled = |low: f64, high: f64| {
            let mut ranges = layers().map(|(_, [over, under])| [of_group(*under), of_group(*over)]);
            ranges.any(|[bottom, top]| bottom <= low && high <= top)
        };
        let pairs = levels.windows(2).filter(|w| filled(w[0].0, w[1].0));
        pairs.map(|w| [w[0].1, w[1].1]).collect()
    }

    /// The middle of a number, facing as the first kept face.
    fn level(&self, plate: &Plate, number: u32) -> Plane {
        let plane = self.middles.mid_planes.plane(number);
        if plane.normal.dot(plate.normal) > 0.0 { plane } else { plane.flipped() }
    }

    /// Upright rectangles, those in one plane as one piece.
    fn steps(&self, steps: &[[u32; 4]], positions: &[DVec3]) -> Vec<PlanePiece> {
        let centre = self.solid.mesh.bounds().map_or(DVec3::ZERO, |[lo, hi]| (lo + hi) / 2.0);
        let mut table = PlaneTable::new(self.solid.size, centre);
        let mut pieces: BTreeMap<u32, PlanePiece> = BTreeMap::new();
        for &[a, b, c, d] in steps {
            let [p, q, r] = [a, b, c].map(|v| positions[v as usize]);
            let normal = (q - p).cross(r - q).normalize_or_zero();
            if normal == DVec3::ZERO {
                continue;
            }
            let number = table.number(Plane { normal, offset: normal.dot(p) });
            let piece = pieces.entry(number).or_insert_with(|| PlanePiece::new(table.plane(number), true));
            piece.outline.extend([[a, b], [b, c], [c, d], [d, a]]);
        }
        pieces.into_values().collect()
    }

    /// Borders of all faces of a plate, from where its nodes moved to.
    fn outlines(&self, plate: &Plate, moved: &Moved) -> Outlines {
        let (x, y) = plate.normal.any_orthonormal_pair();
        let sides = plate.facing.iter().chain(&plate.opposite);
        let edges: Vec<(u32, [u32; 2])> =
            sides.flat_map(|g| border(self.solid, self.segments, self.gone, *g).map(|e| (*g, e))).collect();
        let mut nodes: Vec<u32> = edges.iter().flat_map(|e| e.1).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let origin = nodes.first().map_or(DVec3::ZERO, |v| moved.positions[*v as usize]);
        let place = |v: &u32| {
            let p = moved.positions[*v as usize] - origin;
            DVec3::new(p.dot(x), p.dot(y), 0.0)
        };
        let places: Vec<DVec3> = nodes.iter().map(place).collect();
        let all: Vec<u32> = (0..nodes.len() as u32).collect();
        let mut merged = Merged::new(nodes.len());
        for (a, b) in near_pairs(&places, &all, ROUNDING * self.solid.size) {
            merged.join(a, b);
        }
        let number = |v: u32| nodes.binary_search(&v).map_or(0, |k| merged.find(k as u32));
        let edges = edges.into_iter().map(|(g, e)| (g, e.map(number))).filter(|(_, [a, b])| a != b).collect();
        let soft = nodes.iter().map(|v| moved.soft[*v as usize]).collect();
        let nodes = nodes.iter().map(|v| (*v, number(*v))).collect();
        Outlines {
            frame: [x, y],
            origin,
            places: places.into_iter().map(DVec3::truncate).collect(),
            soft,
            nodes,
            edges,
            rounding: ROUNDING * self.solid.size,
        }
    }

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
    fn cells(
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

/// Nodes of the pieces by place and level.
struct Nodes<'a> {
    outlines: &'a Outlines,
    cdt: &'a Cdt,
    numbers: BTreeMap<(usize, u32), u32>,
}

impl Nodes<'_> {
    fn lifted(&mut self, v: FixedVertexHandle, number: u32, level: Plane, moved: &mut Moved) -> u32 {
        *self.numbers.entry((v.index(), number)).or_insert_with(|| {
            let corner = *self.cdt.vertex(v).data();
            let p = self.outlines.lifted(DVec2::new(corner.at.x, corner.at.y));
            moved.positions.push(p - level.normal * level.height(p));
            moved.soft.push(corner.soft);
            moved.blended.push(false);
            moved.positions.len() as u32 - 1
        })
    }
}

impl Outlines {
    fn lifted(&self, p: DVec2) -> DVec3 {
        let [x, y] = self.frame;
        self.origin + x * p.x + y * p.y
    }

    /// The outlines cut where they cross, and the nodes of their places.
    fn overlay(&self) -> Option<(Cdt, BTreeMap<u32, FixedVertexHandle>)> {
        if self.edges.len() > MOST_EDGES {
            return None;
        }
        let mut cdt = Cdt::new();
        let mut handles: BTreeMap<u32, FixedVertexHandle> = BTreeMap::new();
        for v in self.edges.iter().flat_map(|e| e.1) {
            let (p, soft) = (self.places[v as usize], self.soft[v as usize]);
            let at = spade::mitigate_underflow(Point2::new(p.x, p.y));
            handles.insert(v, cdt.insert(Corner { at, soft }).ok()?);
        }
        let mut edges: Vec<[u32; 2]> = self.parts();
        edges.iter_mut().for_each(|[a, b]| (*a, *b) = ((*a).min(*b), (*a).max(*b)));
        edges.sort_unstable();
        edges.dedup();
        for [a, b] in edges {
            let (p, q) = (handles[&a], handles[&b]);
            if p != q {
                cdt.add_constraint_and_split(p, q, |at| Corner { at, soft: false });
            }
        }
        Some((cdt, handles))
    }

    /// The edges cut at places on them.
    fn parts(&self) -> Vec<[u32; 2]> {
        let mut places: Vec<u32> = self.edges.iter().flat_map(|e| e.1).collect();
        places.sort_unstable();
        places.dedup();
        let parts = |(_, [a, b]): &(u32, [u32; 2])| {
            let (p, q) = (self.places[*a as usize], self.places[*b as usize]);
            let along = q - p;
            let on_edge = |v: &u32| {
                let to = self.places[*v as usize] - p;
                let s = to.dot(along) / along.length_squared();
                let is_within = v != a && v != b && s > 0.0 && s < 1.0;
                (is_within && (to - along * s).length() <= self.rounding).then_some((s, *v))
            };
            let mut on: Vec<(f64, u32)> = places.iter().filter_map(on_edge).collect();
            on.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
            let nodes: Vec<u32> = [*a].into_iter().chain(on.into_iter().map(|n| n.1)).chain([*b]).collect();
            nodes.windows(2).map(|w| [w[0], w[1]]).collect::<Vec<_>>()
        };
        self.edges.par_iter().flat_map_iter(parts).collect()
    }

    /// The groups whose outline winds about a point.
    fn about(&self, p: DVec2) -> BTreeSet<u32> {
        let mut turns: BTreeMap<u32, i32> = BTreeMap::new();
        for (g, ends) in &self.edges {
            let [a, b] = ends.map(|v| self.places[v as usize]);
            if (a.y <= p.y) != (b.y <= p.y) {
                let left = (b - a).perp_dot(p - a) > 0.0;
                if left == (b.y > a.y) {
                    *turns.entry(*g).or_default() += if b.y > a.y { 1 } else { -1 };
                }
            }
        }
        turns.into_iter().filter(|(_, turns)| *turns != 0).map(|(g, _)| g).collect()
    }
}

/// Twice the area of a region over its outline. O(faces).
fn width(cdt: &Cdt, regions: &[Option<usize>], r: usize) -> f64 {
    let is_own = |face: usize| regions[face] == Some(r);
    let area: f64 = cdt.inner_faces().filter(|f| is_own(f.index())).map(|f| f.area()).sum();
    let outline =
        cdt.directed_edges().filter(|e| is_own(e.face().index()) && !is_own(e.rev().face().index()));
    2.0 * area / outline.map(|e| e.length_2().sqrt()).sum::<f64>().max(f64::MIN_POSITIVE)
}

/// Gives all cells the middle that most of the plate has; `None` if it forks.
fn align(cells: &mut [Cell], cdt: &Cdt, regions: &[Option<usize>]) -> Option<()> {
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

/// The region of every face: what no outline divides. `None` outside.
fn regions(cdt: &Cdt) -> Vec<Option<usize>> {
    let mut regions: Vec<Option<usize>> = vec![None; cdt.num_all_faces()];
    let mut count = 0;
    for seed in cdt.inner_faces() {
        if regions[seed.index()].is_some() {
            continue;
        }
        regions[seed.index()] = Some(count);
        let mut stack = vec![seed.fix()];
        while let Some(face) = stack.pop() {
            for edge in cdt.face(face).adjacent_edges() {
                let Some(other) = edge.rev().face().as_inner() else { continue };
                if !edge.is_constraint_edge() && regions[other.index()].is_none() {
                    regions[other.index()] = Some(count);
                    stack.push(other.fix());
                }
            }
        }
        count += 1;
    }
    regions
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    /// Two rectangles that cross in the middle of their sides.
    fn cross() -> Outlines {
        let rectangle = |x: f64, y: f64| [[-x, -y], [x, -y], [x, y], [-x, y]].map(DVec2::from);
        let places = [rectangle(3.0, 1.0), rectangle(1.0, 2.0)].concat();
        let edges = (0..8).map(|k| (k / 4, [k, k / 4 * 4 + (k + 1) % 4])).collect();
        Outlines {
            frame: [DVec3::X, DVec3::Y],
            origin: DVec3::ZERO,
            soft: vec![false; 8],
            nodes: vec![],
            places,
            edges,
            rounding: 1e-9,
        }
    }

    #[test]
    fn outlines_are_cut_where_they_cross() {
        let outlines = cross();
        let (cdt, _) = outlines.overlay().unwrap();
        assert_eq!(cdt.num_vertices(), 12);
        let regions = regions(&cdt);
        // By the groups about it, the area of every region.
        let mut areas: BTreeMap<Vec<u32>, f64> = BTreeMap::new();
        for face in cdt.inner_faces() {
            let Point2 { x, y } = face.center();
            let about = outlines.about(DVec2::new(x, y)).into_iter().collect();
            *areas.entry(about).or_default() += face.area();
        }
        assert_eq!(areas[&vec![0, 1]], 4.0);
        assert_eq!((areas[&vec![0]], areas[&vec![1]]), (8.0, 4.0));
        // One in the middle, four arms, and four corners of the hull that are outside.
        let different: BTreeSet<usize> = regions.into_iter().flatten().collect();
        assert_eq!(different.len(), 9);
    }
}
