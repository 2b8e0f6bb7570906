//! Faces of a skin with their geometry: what a modeller would have called a face, told from triangles (Sheen et al. 2008,
//! sections 6.1 and 9.4).
//!
//! A smooth group may be many faces that run into each other: a cylinder, a sphere in the corner, another cylinder. From some flat
//! shapes are fitted to its surroundings, grown as far as nodes lie on them, and the one that reaches farthest is a face.

use std::cell::OnceCell;

use glam::DVec3;
use rayon::prelude::*;

use super::fit::Cloud;
use super::flats::Flats;
use super::plane::Plane;
use super::regions::{WIDER, mean_plane, width};
use super::segments::Segments;
use super::shape::Shape;
use super::solid::Solid;

/// Nodes are on a shape within this share of the solid's size: files round.
const ROUNDING: f64 = 3e-6;
/// Or, where there are many, within this share of what the facets bulge by.
const BULGE: f64 = 1e-3;
const MANY: usize = 30;
/// Flats fitted at first: as many as will do, or fewer where faces are narrow.
const SURROUNDINGS: [usize; 3] = [40, 16, 7];
/// Or those that are at least as large as this share of the first.
const AS_LARGE: f64 = 0.25;
/// Shapes are compared when they have grown to so many flats.
const COMPARED: usize = 600;
/// After so many flats in a row about which no shape fits, or none that covers this share of its group, the rest is freeform.
const FAILURES: usize = 300;
const SMALL: f64 = 2e-3;
/// Passes over a group, at most.
const PASSES: usize = 4;
/// A group of which this share is freeform, or in pieces smaller than that share of it, is freeform as a whole, if at least this
/// share is freeform beyond doubt.
const MOSTLY: f64 = 0.9;
const PIECE: f64 = 1e-2;
const LEAST: f64 = 0.5;
/// A shape is fitted to less than twice as many flats.
const FITTED: usize = 240;
/// A flat leans by no more than this, in radians, from the shape at its middle.
const LEAN: f64 = 35.0 / 180.0 * std::f64::consts::PI;
/// A flat leans clearly less from one shape than from another if by more than this, in radians.
const CLEARLY: f64 = 0.5 / 180.0 * std::f64::consts::PI;
/// A less simple shape has to cover this many times more.
const SIMPLER: f64 = 1.02;

const NONE: u32 = u32::MAX;

/// A face of the skin.
#[derive(Clone, Debug)]
pub(super) struct Face {
    pub(super) shape: Shape,
    /// Its triangles, ascending.
    pub(super) triangles: Vec<u32>,
    /// Area in mm².
    pub(super) area: f64,
    /// Whether the material is outside of what is round: a hole, the inner side of a bend.
    pub(super) concave: bool,
    /// By how much its triangles lean from it at their corners, in radians, in the mean over their area.
    pub(super) lean: f64,
}

/// All faces.
#[derive(Debug)]
pub(super) struct Faces {
    pub(super) list: Vec<Face>,
    /// Face of every triangle.
    pub(super) of: Vec<u32>,
}

impl Faces {
    /// Finds the faces of all groups. O(n log n) where faces are large beside their facets.
    pub(super) fn new(solid: &Solid, segments: &Segments) -> Self {
        let flats = Flats::new(solid, segments);
        let mut list: Vec<Face> = (0..segments.groups.len() as u32)
            .into_par_iter()
            .flat_map_iter(|g| match segments.group(g).plane {
                Some(plane) => {
                    let shape = Shape::Plane { normal: plane.normal, offset: plane.offset };
                    vec![face(solid, shape, segments.group(g).faces.clone())]
                }
                None => Growth::new(solid, segments, &flats, g).faces(),
            })
            .collect();
        list.sort_by_key(|f| f.triangles[0]);
        let mut of = vec![NONE; solid.len() as usize];
        for (k, face) in (0u32..).zip(&list) {
            face.triangles.iter().for_each(|f| of[*f as usize] = k);
        }
        Self { list, of }
    }

    /// The face that a triangle is part of.
    pub(super) fn at(&self, f: u32) -> &Face {
        &self.list[self.of[f as usize] as usize]
    }
}

fn face(solid: &Solid, shape: Shape, mut triangles: Vec<u32>) -> Face {
    triangles.sort_unstable();
    let area: f64 = triangles.iter().map(|f| solid.areas[*f as usize]).sum();
    let out = |f: &u32| {
        shape.outward(solid.centroid(*f)).dot(solid.normals[*f as usize]) * solid.areas[*f as usize]
    };
    let concave = triangles.iter().map(out).sum::<f64>() < 0.0;
    let lean = |f: &u32| {
        let normal = solid.normals[*f as usize];
        let lean = |p: DVec3| shape.outward(p).dot(normal).abs().min(1.0).acos();
        solid.mesh.corners(*f).map(lean).iter().sum::<f64>() / 3.0 * solid.areas[*f as usize]
    };
    let lean = triangles.iter().map(lean).sum::<f64>() / area.max(f64::MIN_POSITIVE);
    Face { shape, triangles, area, concave, lean }
}

/// The faces of one group as they are being found.
struct Growth<'a> {
    solid: &'a Solid,
    segments: &'a Segments,
    flats: &'a Flats,
    group: u32,
    /// Flats of the group in their order: whether they have a face.
    taken: Vec<bool>,
    /// And the last walk that came by.
    seen: Vec<u32>,
    walk: u32,
}

/// A face as flats.
struct Found {
    shape: Shape,
    flats: Vec<u32>,
    area: f64,
}

impl<'a> Growth<'a> {
    fn new(solid: &'a Solid, segments: &'a Segments, flats: &'a Flats, group: u32) -> Self {
        let n = flats.of_group(group).len();
        Self { solid, segments, flats, group, taken: vec![false; n], seen: vec![0; n], walk: 0 }
    }

    /// The place of a flat in its group.
    fn place(&self, flat: u32) -> usize {
        (flat - self.flats.of_group(self.group).start) as usize
    }

    fn is_free(&self, flat: u32) -> bool {
        self.flats.of_group(self.group).contains(&flat) && !self.taken[self.place(flat)]
    }

    fn take(&mut self, shape: Shape, flats: Vec<u32>) -> Found {
        for flat in &flats {
            let place = self.place(*flat);
            self.taken[place] = true;
        }
        Found { shape, area: self.area(&flats), flats }
    }

    fn area(&self, flats: &[u32]) -> f64 {
        flats.iter().map(|flat| self.flats.area(*flat)).sum()
    }

    fn face(&self, found: &Found) -> Face {
        let triangles = found.flats.iter().flat_map(|flat| self.flats.triangles(*flat));
        face(self.solid, found.shape, triangles.copied().collect())
    }

    fn faces(mut self) -> Vec<Face> {
        let own = &self.segments.group(self.group).faces;
        // Anywhere, large flats sooner, so that large faces are met soon and no part of the group is forgotten.
        let weighted = |flat: u32| {
            let first = self.flats.triangles(flat)[0];
            let scattered = f64::from(first.wrapping_mul(0x9E37_79B1)) / f64::from(u32::MAX);
            (-scattered.ln() / self.flats.area(flat).max(f64::MIN_POSITIVE), flat)
        };
        let mut keyed: Vec<(f64, u32)> = self.flats.of_group(self.group).map(weighted).collect();
        keyed.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let order: Vec<u32> = keyed.into_iter().map(|k| k.1).collect();
        let small = SMALL * self.segments.group(self.group).area;
        let mut found = self.planes(small);
        // What runs into a face is seen better once that one is gone.
        for _ in 0..PASSES {
            let before = found.len();
            self.pass(&order, small, &mut found);
            if found[before..].iter().all(|f| f.area < small) {
                break;
            }
        }
        self.give_back(&mut found);
        // What has no shape is freeform, as it hangs together.
        for seed in self.flats.of_group(self.group) {
            if self.is_free(seed) {
                let part = self.around(seed, usize::MAX);
                found.push(self.take(Shape::Freeform, part));
            }
        }
        // Here and there a freeform face is nearly round.
        let area: f64 = found.iter().map(|f| f.area).sum();
        let sum =
            |is_in: &dyn Fn(&Found) -> bool| found.iter().filter(|f| is_in(f)).map(|f| f.area).sum::<f64>();
        let freeform = sum(&|f| f.shape == Shape::Freeform);
        let in_pieces = sum(&|f| f.shape != Shape::Freeform && f.area < PIECE * area);
        if freeform > LEAST * area && freeform + in_pieces > MOSTLY * area {
            return vec![face(self.solid, Shape::Freeform, own.clone())];
        }
        found.iter().map(|found| self.face(found)).collect()
    }

    /// Plane faces that run smoothly into others and are not told from these by their folds alone: all that is beside them is narrow.
    /// O(n log n).
    fn planes(&mut self, small: f64) -> Vec<Found> {
        let part_of = |flat: u32| self.segments.plane_part[self.flats.triangles(flat)[0] as usize];
        let mut flats: Vec<(u32, u32)> =
            self.flats.of_group(self.group).map(|flat| (part_of(flat), flat)).collect();
        flats.sort_unstable();
        let parts: Vec<&[(u32, u32)]> = flats.chunk_by(|a, b| a.0 == b.0).collect();
        let widths: Vec<OnceCell<f64>> = vec![OnceCell::new(); parts.len()];
        let width_of = |k: usize| {
            let own = || parts[k].iter().flat_map(|(_, flat)| self.flats.triangles(*flat)).copied();
            *widths[k].get_or_init(|| width(self.solid, &own().collect::<Vec<u32>>()))
        };
        let is_face = |k: usize| {
            let part = parts[k];
            let area: f64 = part.iter().map(|(_, flat)| self.flats.area(*flat)).sum();
            if area < small {
                return false;
            }
            let triangles = part.iter().flat_map(|(_, flat)| self.flats.triangles(*flat));
            let others = triangles.flat_map(|f| 3 * f..3 * f + 3).map(|h| self.solid.across(h));
            let mut beside: Vec<u32> = others
                .filter(|other| self.segments.of(*other) == self.group)
                .map(|other| self.segments.plane_part[other as usize])
                .filter(|other| *other != part[0].0)
                .collect();
            beside.sort_unstable();
            beside.dedup();
            // However short the edge to it, what is as wide may be the next facet of the same round face.
            let is_narrow = |other: &u32| {
                let other = parts.binary_search_by_key(other, |p| p[0].0);
                other.is_ok_and(|other| width_of(other) * WIDER < width_of(k))
            };
            !beside.is_empty() && beside.iter().all(is_narrow)
        };
        let whole: Vec<Vec<u32>> = (0..parts.len())
            .filter(|k| is_face(*k))
            .map(|k| parts[k].iter().map(|(_, flat)| *flat).collect())
            .collect();
        let plane = |growth: &Self, flats: &[u32]| {
            let triangles: Vec<u32> =
                flats.iter().flat_map(|flat| growth.flats.triangles(*flat)).copied().collect();
            let Plane { normal, offset } = mean_plane(growth.solid, &triangles);
            Shape::Plane { normal, offset }
        };
        whole.into_iter().map(|flats| self.take(plane(self, &flats), flats)).collect()
    }

    /// Gives flats to larger faces whose shapes they lie on as well as on their own: smaller ones that were met before may have taken them.
    /// Faces are as large as they were before. O(n) in flats and their neighbours, and n log n in faces.
    fn give_back(&mut self, found: &mut Vec<Found>) {
        let mut owner = vec![NONE; self.taken.len()];
        for (k, face) in (0..).zip(&*found) {
            face.flats.iter().for_each(|flat| owner[self.place(*flat)] = k);
        }
        let mut order: Vec<u32> = (0..found.len() as u32).collect();
        let size = |k: u32| found.get(k as usize).map_or(0.0, |face| face.area);
        order.sort_by(|a, b| size(*b).total_cmp(&size(*a)).then(a.cmp(b)));
        let own = self.flats.of_group(self.group);
        let tolerances: Vec<f64> =
            found.iter().map(|face| self.tolerance(&self.cloud(&face.flats))).collect();
        for k in order {
            let face = &found[k as usize];
            let tolerance = tolerances[k as usize];
            let mut stack: Vec<u32> =
                face.flats.iter().copied().filter(|flat| owner[self.place(*flat)] == k).collect();
            while let Some(flat) = stack.pop() {
                for other in self.flats.beside(self.solid, flat).filter(|other| own.contains(other)) {
                    let place = self.place(other);
                    if owner[place] == k || size(owner[place]) >= face.area {
                        continue;
                    }
                    let before = found.get(owner[place] as usize).map(|face| self.off(&face.shape, other));
                    let near =
                        before.map_or(tolerance, |off| tolerance.min(off + ROUNDING * self.solid.size));
                    if self.is_on(&face.shape, near, other) {
                        owner[place] = k;
                        self.taken[place] = true;
                        stack.push(other);
                    }
                }
            }
        }
        self.settle_borders(found, &tolerances, &mut owner);
        let mut pieces = Vec::new();
        for first in own.clone() {
            let k = std::mem::replace(&mut owner[self.place(first)], NONE);
            let Some(face) = found.get(k as usize) else { continue };
            let (mut flats, mut at) = (vec![first], 0);
            while at < flats.len() {
                for other in self.flats.beside(self.solid, flats[at]).filter(|other| own.contains(other)) {
                    if owner[self.place(other)] == k {
                        owner[self.place(other)] = NONE;
                        flats.push(other);
                    }
                }
                at += 1;
            }
            pieces.push(Found { shape: face.shape, area: self.area(&flats), flats });
        }
        *found = pieces;
    }

    /// Gives flats between two faces that lie on both to the one from which they lean less: where a fillet touches a cone, the nodes of its first
    /// rings are on that as well, as far as nodes tell. O(n) in flats and their neighbours.
    fn settle_borders(&self, found: &[Found], tolerances: &[f64], owner: &mut [u32]) {
        let own = self.flats.of_group(self.group);
        let lean = |k: u32, flat: u32| {
            let outward = found[k as usize].shape.outward(self.flats.middle(flat));
            outward.dot(self.flats.normal(flat)).abs().clamp(0.0, 1.0).acos()
        };
        let mut stack: Vec<u32> = own.clone().collect();
        while let Some(flat) = stack.pop() {
            let from = owner[self.place(flat)];
            if from == NONE {
                continue;
            }
            let others = self.flats.beside(self.solid, flat).filter(|other| own.contains(other));
            let others = others.map(|other| owner[self.place(other)]).filter(|k| *k != NONE && *k != from);
            let leaner = |k: &u32| {
                lean(*k, flat) + CLEARLY < lean(from, flat)
                    && self.is_on(&found[*k as usize].shape, tolerances[*k as usize], flat)
            };
            if let Some(to) = others.filter(leaner).min_by(|a, b| lean(*a, flat).total_cmp(&lean(*b, flat))) {
                owner[self.place(flat)] = to;
                stack.extend(self.flats.beside(self.solid, flat).filter(|other| own.contains(other)));
            }
        }
    }

    /// How far the corners of a flat are from a shape, at most.
    fn off(&self, shape: &Shape, flat: u32) -> f64 {
        let at = |v: u32| self.solid.mesh.positions[v as usize];
        self.flats.corners(self.solid, flat).map(|v| shape.distance(at(v)).abs()).fold(0.0, f64::max)
    }

    /// Whether a flat lies on a shape.
    fn is_on(&self, shape: &Shape, tolerance: f64, flat: u32) -> bool {
        let flats = self.flats;
        self.off(shape, flat) <= tolerance
            && shape.outward(flats.middle(flat)).dot(flats.normal(flat)).abs() > LEAN.cos()
    }

    fn pass(&mut self, order: &[u32], small: f64, found: &mut Vec<Found>) {
        let mut tried = vec![false; order.len()];
        let mut failures = 0;
        for &seed in order {
            if tried[self.place(seed)] || !self.is_free(seed) {
                continue;
            }
            if let Some((shape, grown)) = self.largest(seed) {
                let face = self.take(shape, grown);
                // Any bit of a freeform face is nearly round, if only small enough.
                failures = if face.area < small { failures + 1 } else { 0 };
                found.push(face);
                if failures > FAILURES {
                    break;
                }
                continue;
            }
            failures += 1;
            if failures > FAILURES {
                break;
            }
            for flat in self.around(seed, SURROUNDINGS[2]) {
                let place = self.place(flat);
                tried[place] = true;
            }
        }
    }

    /// The shape about a flat that reaches farthest.
    fn largest(&mut self, seed: u32) -> Option<(Shape, Vec<u32>)> {
        let least = AS_LARGE * self.flats.area(seed);
        for round in 0..=SURROUNDINGS.len() {
            let near = match SURROUNDINGS.get(round) {
                Some(count) => self.around(seed, *count),
                // A face that is one facet high has others about all of its facets, narrow ones if these are fillets.
                None => self.walked(seed, SURROUNDINGS[1], |growth, flat| growth.flats.area(flat) >= least),
            };
            let cloud = self.cloud(&near);
            let tolerance = self.tolerance(&cloud);
            let mut best: Option<(f64, Shape, Vec<u32>)> = None;
            for (shape, error) in cloud.fits(tolerance) {
                if error > tolerance {
                    continue;
                }
                let (shape, grown) = self.grown(seed, shape, COMPARED);
                let area: f64 = grown.iter().map(|flat| self.flats.area(*flat)).sum();
                if best.as_ref().is_none_or(|b| area > SIMPLER * b.0) {
                    best = Some((area, shape, grown));
                }
            }
            if let Some((_, shape, grown)) = best {
                let whole =
                    if grown.len() < COMPARED { (shape, grown) } else { self.grown(seed, shape, usize::MAX) };
                return Some(whole);
            }
        }
        None
    }

    /// As far as flats lie on a shape, which is fitted again and again on the way.
    fn grown(&mut self, seed: u32, mut shape: Shape, most: usize) -> (Shape, Vec<u32>) {
        let near = self.around(seed, SURROUNDINGS[1]);
        let tolerance = self.tolerance(&self.cloud(&near));
        let mut grown = self.reached(seed, &shape, tolerance, most.min(2 * SURROUNDINGS[0]));
        loop {
            let cloud = self.cloud(&grown);
            let tolerance = self.tolerance(&cloud);
            let Some((fitted, error)) = cloud.refit(shape, tolerance) else { break };
            if error > tolerance {
                break;
            }
            shape = fitted;
            let wider = self.reached(seed, &shape, tolerance, most.min(4 * grown.len()));
            if wider.len() <= grown.len() {
                break;
            }
            grown = wider;
        }
        (shape, grown)
    }

    /// The free flats about one, the nearest rings first.
    fn around(&mut self, seed: u32, most: usize) -> Vec<u32> {
        self.walked(seed, most, |_, _| true)
    }

    fn reached(&mut self, seed: u32, shape: &Shape, tolerance: f64, most: usize) -> Vec<u32> {
        self.walked(seed, most, |growth, flat| growth.is_on(shape, tolerance, flat))
    }

    fn walked(&mut self, seed: u32, most: usize, wanted: impl Fn(&Self, u32) -> bool) -> Vec<u32> {
        self.walk += 1;
        let mut near = vec![seed];
        let place = self.place(seed);
        self.seen[place] = self.walk;
        let mut at = 0;
        while at < near.len() && near.len() < most {
            for other in self.flats.beside(self.solid, near[at]) {
                if self.is_free(other) && self.seen[self.place(other)] != self.walk && wanted(self, other) {
                    let place = self.place(other);
                    self.seen[place] = self.walk;
                    near.push(other);
                }
            }
            at += 1;
        }
        near
    }

    fn tolerance(&self, cloud: &Cloud) -> f64 {
        let rounding = ROUNDING * self.solid.size;
        if cloud.nodes.len() < MANY { rounding } else { rounding.max(BULGE * cloud.sag()) }
    }

    /// Nodes, some of many, and flats.
    fn cloud(&self, flats: &[u32]) -> Cloud {
        let step = (flats.len() / FITTED).max(1);
        let some = || flats.iter().step_by(step).copied();
        let mut corners: Vec<(u32, u32)> =
            some().flat_map(|flat| self.flats.corners(self.solid, flat).map(move |v| (v, flat))).collect();
        corners.sort_unstable();
        corners.dedup();
        let (mut nodes, mut node_normals) = (Vec::new(), Vec::new());
        for run in corners.chunk_by(|a, b| a.0 == b.0) {
            nodes.push(self.solid.mesh.positions[run[0].0 as usize]);
            let normal: DVec3 = run.iter().map(|c| self.flats.normal(c.1)).sum();
            node_normals.push(normal.normalize_or_zero());
        }
        let facet = |flat: u32| (self.flats.middle(flat), self.flats.normal(flat), self.flats.area(flat));
        Cloud { nodes, node_normals, facets: some().map(facet).collect() }
    }
}
