//! Plates whose thickness steps on both sides.
//!
//! Where a plate is stepped on one side only, that side is cut where its middle steps and is kept ([`super::sides`]). Where both sides have
//! steps, neither knows of the other's: the outlines of both are laid over each other, and every cell between them has the middle of the
//! two faces that lie over and under it there. Between cells of different middles stand steps. A plate that forks, as one with a slot milled
//! into its edge does, has cells with several middles, one over the other.

mod cells;
mod overlay;

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};
use spade::handles::FixedVertexHandle;
use spade::{Point2, Triangulation};

use self::cells::{Layer, align};
use self::overlay::{Cdt, Outlines, regions};
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
        let mut table = PlaneTable::new(self.solid.size, self.solid.rounding, centre);
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
            moved.flush.push(false);
            moved.positions.len() as u32 - 1
        })
    }
}
