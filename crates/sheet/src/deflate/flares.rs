//! Where curved walls end: rims that are round, and flares and fillets towards other walls, which smooth facets hide.

use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use rayon::prelude::*;

use super::faces::{Face, Faces};
use super::report::WallPair;
use super::segments::Segments;
use super::shape::Shape;
use super::solid::{SHARP, Solid};
use super::walls::Walls;

/// A flare meets the wall that it runs into at less than this, in radians.
const OBLIQUE: f64 = 70.0 / 180.0 * std::f64::consts::PI;
/// Facets lean by no more than the folds about them and this, in radians, where their walls are parallel.
const FLARE: f64 = 5.0 / 180.0 * std::f64::consts::PI;
/// A rim turns away from its walls until the cosine to the direction away from them is this.
const TURNED: f64 = 0.5;
/// Faces belong to a rim if they are within this share of the thickness of it: where a round begins is told facet by facet, and
/// raggedly so if these are fine. Walls go on to the end of the material anyway.
const RIM: f64 = 0.3;
/// The inside of a bend is parallel to the outside up to this, in radians, on this share of it.
const ALONG: f64 = 20.0 / 180.0 * std::f64::consts::PI;
const MOST: f64 = 0.6;
/// The same against a round about another centre; it is opposite to this share of the inside at least, and turns by this there, in radians.
const ALONG_ROUND: f64 = 32.0 / 180.0 * std::f64::consts::PI;
const ROUND: f64 = 0.1;
const TURNS: f64 = 30.0 / 180.0 * std::f64::consts::PI;
/// A part of a wall is more than this share of its group; less is parallel to what is opposite by chance.
const PIECE: f64 = 1e-2;
/// Facets are of a fillet if their nodes are on it up to this share of its radius.
const ON: f64 = 2e-3;
/// Looks beside a border begin this share of the way from it to the middle of the face.
const INSET: f64 = 0.05;

impl Walls {
    /// Where curved walls flare into fillets: sets of faces at their borders that look past the opposite wall. Smooth facets hide
    /// where a wall ends and a fillet begins; what is opposite tells.
    pub(super) fn flares(&self, solid: &Solid, segments: &Segments) -> Vec<Vec<u32>> {
        let fold = |f: u32| {
            let cosine =
                |k: u32| Some(solid.fold_cosine(3 * f + k)).filter(|c| *c > SHARP.cos()).unwrap_or(1.0);
            let mut cosines = [0, 1, 2].map(cosine);
            cosines.sort_by(f64::total_cmp);
            // On rounds, which may be meshed unevenly, one edge that folds more says nothing.
            cosines[usize::from(self.is_proud[f as usize])].clamp(-1.0, 1.0).acos()
        };
        let curved = |f: u32| {
            let g = segments.of(f);
            self.is_wall[g as usize] && segments.group(g).plane.is_none()
        };
        let looks_past: Vec<bool> = (0..solid.len())
            .into_par_iter()
            .map(|f| {
                if !curved(f) {
                    return false;
                }
                let opposite = self.opposite_middle(solid, segments, f);
                let Some(opposite) = opposite else { return true };
                let lean = solid.normals[f as usize].dot(-solid.normals[opposite.face as usize]);
                let allowed = fold(f).max(fold(opposite.face)) + FLARE;
                lean < allowed.cos()
            })
            .collect();
        let mut seen = vec![false; solid.len() as usize];
        let mut found = Vec::new();
        for seed in (0..solid.len()).filter(|f| looks_past[*f as usize]) {
            if seen[seed as usize] {
                continue;
            }
            let (g, mut part, mut at) = (segments.of(seed), vec![seed], 0);
            seen[seed as usize] = true;
            let (mut border, mut hollow) = (0.0, 0.0);
            let (mut sides, mut ends) = (Vec::new(), BTreeSet::new());
            while at < part.len() {
                for h in 3 * part[at]..3 * part[at] + 3 {
                    let other = solid.across(h);
                    let to = segments.of(other);
                    if self.is_wall[to as usize] && solid.fold_cosine(h) > OBLIQUE.cos() {
                        hollow -= solid.bend(h);
                        border += if to == g { 0.0 } else { solid.length(h) };
                    }
                    if to == g && looks_past[other as usize] {
                        if !seen[other as usize] {
                            seen[other as usize] = true;
                            part.push(other);
                        }
                    } else if self.is_wall[to as usize] {
                        sides.push(h);
                    } else {
                        ends.insert(to);
                    }
                }
                at += 1;
            }
            // A fillet runs along another wall, is hollow and narrow.
            let area: f64 = part.iter().map(|f| solid.areas[*f as usize]).sum();
            let is_flare = border > 0.0
                && hollow > 0.0
                && area < self.max_thickness * border
                && !self.is_inside_of_a_bend(solid, segments, &part);
            let is_rim = !is_flare && self.is_rim(solid, segments, &looks_past, &part, &sides, &ends);
            if is_rim {
                self.widen(solid, segments, &mut part, &mut seen);
            }
            if is_flare || is_rim {
                part.sort_unstable();
                found.push(part);
            }
        }
        found
    }

    /// Whether what looks past the opposite wall is the round end of the walls beyond its sides: halfway between these and what is
    /// opposite, one leaves the material through such faces, or through the ends that they touch.
    fn is_rim(
        &self,
        solid: &Solid,
        segments: &Segments,
        looks_past: &[bool],
        part: &[u32],
        sides: &[u32],
        ends: &BTreeSet<u32>,
    ) -> bool {
        let ends_here = |h: u32| {
            let Some(beyond) = solid.adjacency.partner(h).map(|k| k / 3) else { return false };
            let normal = solid.normals[beyond as usize];
            let [a, b] = solid.adjacency.ends(h).map(|v| solid.mesh.positions[v as usize]);
            // The side runs against the face beyond it.
            let away = (a - b).cross(normal).normalize_or_zero();
            // What does not turn just has nothing opposite: a hole, or one drilled askew.
            if !part.iter().any(|f| solid.normals[*f as usize].dot(away) > TURNED) {
                return false;
            }
            let from = a.midpoint(b).lerp(solid.centroid(beyond), INSET);
            let Some(opposite) = self.first(solid, from, -normal) else { return false };
            let hit = self.first(solid, from - normal * (opposite.distance / 2.0), away);
            hit.is_some_and(|hit| looks_past[hit.face as usize] || ends.contains(&segments.of(hit.face)))
        };
        let length = |all: &mut dyn Iterator<Item = u32>| all.map(|h| solid.length(h)).sum::<f64>();
        let whole = length(&mut sides.iter().copied());
        whole > 0.0 && length(&mut sides.iter().copied().filter(|h| ends_here(*h))) > 0.5 * whole
    }

    /// Adds the faces of the group about a rim that are near to it: the first facets of a round hardly lean.
    fn widen(&self, solid: &Solid, segments: &Segments, part: &mut Vec<u32>, seen: &mut [bool]) {
        let at = |v: u32| solid.mesh.positions[v as usize];
        let nodes = part.iter().flat_map(|f| solid.mesh.faces[*f as usize]);
        let mut reached: BTreeMap<u32, f64> = nodes.map(|v| (v, 0.0)).collect();
        let mut k = 0;
        while k < part.len() {
            for h in 3 * part[k]..3 * part[k] + 3 {
                let other = solid.across(h);
                if seen[other as usize] || segments.of(other) != segments.of(part[k]) {
                    continue;
                }
                let face = solid.mesh.faces[other as usize];
                let how_far = |v: u32| {
                    let by_edge = |w: &u32| reached.get(w).map(|d| d + at(*w).distance(at(v)));
                    reached
                        .get(&v)
                        .copied()
                        .unwrap_or_else(|| face.iter().filter_map(by_edge).fold(f64::INFINITY, f64::min))
                };
                let far = face.map(|v| (v, how_far(v)));
                if far.iter().all(|(_, d)| *d < RIM * self.max_thickness) {
                    reached.extend(far);
                    seen[other as usize] = true;
                    part.push(other);
                }
            }
            k += 1;
        }
    }

    /// Fillets that curved walls run into: hollow faces without an exact partner, beside faces of their group that have one or are parallel
    /// to what is opposite, as a boss with draft is. What is opposite to facets of fillets is so by chance.
    /// What a round faces all along is no fillet but the inside of a bend.
    pub(super) fn fillets(
        &self,
        solid: &Solid,
        segments: &Segments,
        faces: &Faces,
        pairs: &[WallPair],
    ) -> Vec<Vec<u32>> {
        let mut has_partner = vec![false; faces.list.len()];
        pairs.iter().flat_map(|p| p.faces).for_each(|f| has_partner[f] = true);
        let group = |face: &Face| segments.of(face.triangles[0]);
        let mut of_group: Vec<Vec<usize>> = vec![Vec::new(); segments.groups.len()];
        for (k, face) in faces.list.iter().enumerate() {
            of_group[group(face) as usize].push(k);
        }
        let parallel: Vec<OnceCell<bool>> = vec![OnceCell::new(); faces.list.len()];
        let is_parallel = |k: usize| {
            *parallel[k].get_or_init(|| self.is_inside_of_a_bend(solid, segments, &faces.list[k].triangles))
        };
        let has_wall = |g: u32, fillet: usize| {
            let others = || of_group[g as usize].iter().copied().filter(|k| *k != fillet);
            let is_piece = |k: usize| faces.list[k].area > PIECE * segments.group(g).area;
            others().any(|k| has_partner[k]) || others().any(|k| is_piece(k) && is_parallel(k))
        };
        let is_fillet = |k: &usize| {
            let face = &faces.list[*k];
            let g = group(face);
            !has_partner[*k]
                && face.concave
                && fillet_radius(&face.shape).is_some_and(|radius| radius < self.max_thickness)
                && self.is_wall[g as usize]
                && !is_parallel(*k)
                && has_wall(g, *k)
        };
        let fillets = (0..faces.list.len()).filter(is_fillet);
        let with_first_row = |k: usize| {
            let face = &faces.list[k];
            let mut all =
                [&face.triangles[..], &self.first_row(solid, segments, faces, &has_partner, face)].concat();
            all.sort_unstable();
            all.dedup();
            all
        };
        fillets.map(with_first_row).collect()
    }

    /// Facets of fillets that are taken for the wall that these run into: beside a wall of few chords, where what is opposite leans by up to half
    /// the turn of one, the first row of a fillet looks parallel. What has its nodes on the fillet is part of it. By group.
    pub(super) fn first_rows(
        &self,
        solid: &Solid,
        segments: &Segments,
        faces: &Faces,
        pairs: &[WallPair],
    ) -> Vec<(u32, Vec<u32>)> {
        let mut has_partner = vec![false; faces.list.len()];
        pairs.iter().flat_map(|p| p.faces).for_each(|f| has_partner[f] = true);
        let row = |(k, face): (usize, &Face)| {
            let group = segments.of(face.triangles[0]);
            let small = fillet_radius(&face.shape).is_some_and(|radius| radius < self.max_thickness);
            if !small || !face.concave || has_partner[k] || self.is_wall[group as usize] {
                return None;
            }
            let row = self.first_row(solid, segments, faces, &has_partner, face);
            row.iter().any(|f| segments.of(*f) != group).then_some((group, row))
        };
        faces.list.iter().enumerate().filter_map(row).collect()
    }

    /// The facets of curved walls about a fillet that are on it, ascending.
    fn first_row(
        &self,
        solid: &Solid,
        segments: &Segments,
        faces: &Faces,
        has_partner: &[bool],
        fillet: &Face,
    ) -> Vec<u32> {
        let Some(radius) = fillet_radius(&fillet.shape) else { return Vec::new() };
        let own = segments.of(fillet.triangles[0]);
        let is_on = |f: u32| {
            let g = segments.of(f);
            let lean = fillet.shape.outward(solid.centroid(f)).dot(-solid.normals[f as usize]);
            segments.group(g).plane.is_none()
                && (g == own || self.is_wall[g as usize])
                && !has_partner[faces.of[f as usize] as usize]
                && lean > SHARP.cos()
                && solid.mesh.corners(f).iter().all(|p| fillet.shape.distance(*p).abs() < ON * radius)
        };
        let mut row: BTreeSet<u32> = BTreeSet::new();
        let mut next = fillet.triangles.clone();
        while let Some(f) = next.pop() {
            for h in 3 * f..3 * f + 3 {
                let other = solid.across(h);
                let is_new = fillet.triangles.binary_search(&other).is_err() && !row.contains(&other);
                if is_new && solid.fold_cosine(h) > SHARP.cos() && is_on(other) {
                    row.insert(other);
                    next.push(other);
                }
            }
        }
        row.into_iter().collect()
    }

    /// Insides of bends that run into fillets, as the upright edges of a box run into those of its floor: round faces of groups that are
    /// no walls which face other round walls all along.
    pub(super) fn bends(&self, solid: &Solid, segments: &Segments, faces: &Faces) -> Vec<Vec<u32>> {
        let is_bend = |face: &&Face| {
            let g = segments.of(face.triangles[0]);
            let is_round = !matches!(face.shape, Shape::Plane { .. } | Shape::Freeform);
            is_round
                && !self.is_wall[g as usize]
                && segments.group(g).faces.len() > face.triangles.len()
                && self.faces_along(solid, segments, &face.triangles, &|o| {
                    let wall = segments.of(o) as usize;
                    self.is_wall[wall] && segments.groups[wall].plane.is_none()
                })
        };
        faces.list.iter().filter(is_bend).map(|face| face.triangles.clone()).collect()
    }

    /// Whether most of a face is nearly parallel to what is opposite: a fillet is so only where it ends.
    fn is_inside_of_a_bend(&self, solid: &Solid, segments: &Segments, triangles: &[u32]) -> bool {
        self.faces_along(solid, segments, triangles, &|_| true) || self.turns_with_a_round(solid, triangles)
    }

    /// Whether a face turns from one wall to another as a round opposite to it does, but about another centre: against its middle it has the
    /// round, and against its ends the walls that this runs into.
    fn turns_with_a_round(&self, solid: &Solid, triangles: &[u32]) -> bool {
        let (mut whole, mut along, mut round) = (0.0, 0.0, 0.0);
        let mut turned: Option<(DVec3, f64)> = None;
        for &f in triangles {
            let (normal, area) = (solid.normals[f as usize], solid.areas[f as usize]);
            whole += area;
            let Some(hit) = self.first(solid, solid.centroid(f), -normal) else { continue };
            let (beyond, is_round) = (-solid.normals[hit.face as usize], self.is_proud[hit.face as usize]);
            let lean = normal.dot(beyond);
            if is_round && lean > ALONG_ROUND.cos() {
                round += area;
                let (first, least) = turned.unwrap_or((beyond, 1.0));
                turned = Some((first, least.min(first.dot(beyond))));
            } else if !is_round && lean > ALONG.cos() {
                along += area;
            }
        }
        let turns = turned.is_some_and(|(_, least)| least < TURNS.cos());
        turns && round > ROUND * whole && round + along > MOST * whole
    }

    /// The same, of what is opposite and counts.
    fn faces_along(
        &self,
        solid: &Solid,
        segments: &Segments,
        triangles: &[u32],
        counts: &dyn Fn(u32) -> bool,
    ) -> bool {
        let is_along = |f: &&u32| {
            let opposite = self.opposite_middle(solid, segments, **f).filter(|o| counts(o.face));
            opposite.is_some_and(|o| {
                solid.normals[**f as usize].dot(-solid.normals[o.face as usize]) > ALONG.cos()
            })
        };
        let area = |of: &mut dyn Iterator<Item = &u32>| of.map(|f| solid.areas[*f as usize]).sum::<f64>();
        area(&mut triangles.iter().filter(is_along)) > MOST * area(&mut triangles.iter())
    }
}

/// The radius of what fillets are; `None` for other shapes.
fn fillet_radius(shape: &Shape) -> Option<f64> {
    match *shape {
        Shape::Cylinder { radius, .. } | Shape::Sphere { radius, .. } => Some(radius),
        Shape::Torus { minor, .. } => Some(minor),
        _ => None,
    }
}
