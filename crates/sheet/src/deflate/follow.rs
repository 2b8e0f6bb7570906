//! Curved pieces refined until they follow the middle between both sides of their walls, and meshed anew to an edge length.
//!
//! The two sides of a curved wall are tessellated each in its own way, so the middle between them bends at the edges of
//! both. Edges are split where their middle is off, nodes are put halfway, and triangles kept from becoming slivers, which
//! would fold at the least unevenness.

use std::collections::BTreeMap;

use glam::DVec3;
use rayon::prelude::*;

use super::assemble::{Sheet, Source};
use super::exact::Exact;
use super::remesh::{Diagonal, Nodes, Remesh};
use super::segments::Segments;
use super::solid::{Solid, longest_side};
use super::twins::Twins;
use super::walls::{FACET_LEAN, Opposite, Walls};

/// An edge is split if its middle is off by more than this share of the thickness.
const OFF: f64 = 8e-3;
/// A diagonal is right if its middle is off by less than this share of it.
const RIGHT: f64 = 1e-3;
/// Nodes are put right if they are off by more than this share of it.
const NODE_OFF: f64 = 1e-3;
/// A node is moved by at most this share of its shortest edge, or it would fold the faces about it.
const NODE_REACH: f64 = 0.35;
/// A new node stands off by at most this share of its edge.
const BEND: f64 = 0.2;
/// Edges shorter than this share of the thickness are not split.
const SHORTEST: f64 = 0.5;
/// Edges shorter than this share of it close.
const CLOSED: f64 = 0.2;
/// Nor do edges that are longer than this share of the mean one; equal triangles of edges e have an area of e² / 2.31.
const SHORTER: f64 = 0.35;
const EVEN: f64 = 2.31;
/// Sides of faces along which the thickness changes by more than this share of it are split, if longer than that one.
const EVEN_THICKNESS: f64 = 8e-3;
const NARROWEST: f64 = 0.1;
/// Rounds of it.
const EVENINGS: usize = 2;
/// The thickness at a corner is seen from this share of the way to the middle of the face.
const WITHIN: f64 = 0.25;
/// Splitting ends when there is less than one in so many edges to be split.
const FEW: usize = 300;
/// Rounds of splitting.
const ROUNDS: usize = 6;
/// Rounds of meshing to an edge length, and which edges are split and closed, over that length.
const MESHINGS: usize = 8;
const LONG: f64 = 4.0 / 3.0;
const SHORT: f64 = 4.0 / 5.0;
/// Diagonals of a plane are as near as this share of their lengths.
const FLAT: f64 = 1e-6;
/// Looks from a free edge begin this far from it towards the middle of its face: at the edge there is nothing to be seen.
const INSET: f64 = 0.04;
/// The middle is looked for within this share of the thickness.
const FAR: f64 = 0.3;
/// So many widths of a face from where it is met its plane still holds.
const BESIDE: f64 = 2.0;
/// Refinement stops at this many times the solid's faces, or of that many.
const MOST_TIMES: usize = 6;
const MOST_ANYWAY: usize = 5000;
/// Meshing to an edge length stops at so many faces.
const MOST_FACES: usize = 8_000_000;

/// The wall about a point of its middle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Between {
    /// The way from the point to the middle, in mm.
    pub(super) off: DVec3,
    /// How thick the wall is, in mm.
    pub(super) thickness: f64,
}

/// Looks both ways through the material from a point beside the middle of a wall. The middle is where the planes of the faces
/// that are met are equally far: whatever way one looks, it is the same.
pub(super) fn between(
    solid: &Solid,
    segments: &Segments,
    walls: &Walls,
    p: DVec3,
    normal: DVec3,
) -> Option<Between> {
    let (up, down) = (walls.first(solid, p, normal)?, walls.first(solid, p, -normal)?);
    let sound = [(up.face, normal), (down.face, -normal)].into_iter().all(|(f, d)| {
        walls.is_wall[segments.of(f) as usize] && solid.normals[f as usize].dot(d) > FACET_LEAN.cos()
    });
    let [above, below] = [up.face, down.face].map(|f| solid.normals[f as usize]);
    let far = |f: u32, n: DVec3| n.dot(solid.mesh.positions[solid.mesh.faces[f as usize][0] as usize] - p);
    let (to_above, to_below) = (far(up.face, above), far(down.face, below));
    let across = above - below;
    // The planes of small faces say nothing of where one does not look.
    let seen = [(up, above, to_above, normal), (down, below, to_below, -normal)];
    let is_beside = |(hit, n, far, d): &(Opposite, DVec3, f64, DVec3)| {
        (*d * hit.distance - *n * *far).length() < BESIDE * narrow(solid, hit.face)
    };
    let (off, thickness) = if seen.iter().all(is_beside) {
        // Along the normal of one of them, as far as it is to the middle twice.
        let thickness = 2.0 * (to_above + to_below) / (1.0 - above.dot(below));
        (across * ((to_above - to_below) / across.length_squared()), thickness)
    } else {
        (normal * ((up.distance - down.distance) / 2.0), up.distance + down.distance)
    };
    (sound && thickness <= walls.max_thickness && off.length() < FAR * thickness)
        .then_some(Between { off, thickness })
}

/// The height of a face on its longest side, in mm.
fn narrow(solid: &Solid, f: u32) -> f64 {
    2.0 * solid.areas[f as usize] / longest_side(&solid.mesh.corners(f))
}

/// What is needed to look at a sheet from within.
pub(super) struct Follow<'a> {
    pub(super) remesh: Remesh<'a>,
    pub(super) segments: &'a Segments,
    pub(super) walls: &'a Walls,
    pub(super) exact: &'a Exact,
    pub(super) twins: &'a Twins,
}

impl Follow<'_> {
    /// Refines the curved pieces of a sheet; with an edge length, meshes them anew to about that. O(n log n) a round.
    pub(super) fn run(&self, sheet: &mut Sheet, edge_length: Option<f64>) {
        if !sheet.sources.iter().any(|s| matches!(s, Source::Facet(_))) {
            return;
        }
        self.remesh.turn_back(sheet);
        match edge_length {
            Some(length) => self.mesh_to(sheet, length),
            None => self.refine(sheet),
        }
        // Edges have closed.
        *sheet = std::mem::take(sheet).without_unused_nodes();
    }

    fn refine(&self, sheet: &mut Sheet) {
        let most = MOST_TIMES * self.remesh.solid.mesh.faces.len().max(MOST_ANYWAY);
        let short: Vec<f64> = (0..self.segments.groups.len() as u32).map(|g| self.short(g)).collect();
        // Faces with twins are as they should be.
        let of = |(f, g): (u32, &u32)| if self.twins.has(f) { 0.0 } else { short[*g as usize] };
        let of_face: Vec<f64> = (0u32..).zip(&self.segments.of_face).map(of).collect();
        for round in 0..=ROUNDS {
            self.close(sheet, &of_face);
            self.remesh.turn(sheet, &|diagonal| self.follows(diagonal));
            self.settle(sheet);
            let wanted = |look: &Look| {
                let bend = look.off.length() / look.length;
                look.length > SHORTEST * look.thickness
                    && look.off.length() > OFF * look.thickness
                    && bend < BEND
            };
            if round == ROUNDS || !self.split(sheet, most, &wanted) {
                break;
            }
        }
        self.even_out(sheet, most);
    }

    /// Splits the side of a face along which the thickness changes most, so that one number a face says it.
    fn even_out(&self, sheet: &mut Sheet, most: usize) {
        for _ in 0..EVENINGS {
            let nodes = self.remesh.nodes(sheet);
            let side =
                |f: u32| self.uneven_side(sheet, &nodes, f).and_then(|k| nodes.adjacency.edge_of(3 * f + k));
            let mut split: Vec<u32> =
                (0..sheet.faces.len() as u32).into_par_iter().filter_map(side).collect();
            split.par_sort_unstable();
            split.dedup();
            if split.is_empty() || sheet.faces.len() + 2 * split.len() > most {
                return;
            }
            let mut middles: BTreeMap<u32, u32> = BTreeMap::new();
            for e in split {
                let [p, q] = nodes.adjacency.edges()[e as usize].map(|v| sheet.positions[v as usize]);
                sheet.positions.push(p.midpoint(q));
                middles.insert(e, sheet.positions.len() as u32 - 1);
            }
            divide(sheet, &nodes, &middles);
        }
    }

    /// The side of a curved face along which the thickness changes most, if it does so by too much.
    fn uneven_side(&self, sheet: &Sheet, nodes: &Nodes, f: u32) -> Option<u32> {
        self.remesh.normal(sheet, f)?;
        let corners = nodes.mesh.corners(f);
        let [p, q, r] = corners;
        let normal = (q - p).cross(r - p).normalize_or_zero();
        let middle = (p + q + r) / 3.0;
        let seen = |k: usize| {
            let from = corners[k].lerp(middle, WITHIN);
            between(self.remesh.solid, self.segments, self.walls, from, normal).map(|seen| seen.thickness)
        };
        let thickness = [seen(0)?, seen(1)?, seen(2)?];
        let change = |k: usize| (thickness[k] - thickness[(k + 1) % 3]).abs() / (1.0 - WITHIN);
        let k = (0..3).max_by(|a, b| change(*a).total_cmp(&change(*b)))?;
        let wide = corners[k].distance(corners[(k + 1) % 3]) > NARROWEST * thickness[k];
        // What is split may not have a plane piece beside it: those end in straight lines.
        let beside = nodes.adjacency.half_edges(nodes.adjacency.edge_of(3 * f + k as u32)?);
        let curved = beside.iter().all(|h| self.remesh.normal(sheet, h / 3).is_some());
        (change(k) > EVEN_THICKNESS * thickness[k] && wide && curved).then_some(k as u32)
    }

    fn mesh_to(&self, sheet: &mut Sheet, length: f64) {
        let short = vec![SHORT * length; self.segments.of_face.len()];
        for _ in 0..MESHINGS {
            self.split(sheet, MOST_FACES, &|look| look.length > LONG * length);
            self.close(sheet, &short);
            self.remesh.turn(sheet, &|_| true);
            self.remesh.smooth(sheet);
            self.settle(sheet);
            self.name_sources(sheet);
            self.exact.settle(sheet, &self.remesh.nodes(sheet));
        }
        self.remesh.turn(sheet, &|_| true);
    }

    /// Whether a diagonal follows the middle, or the old one does not: what both sides agree on stays as it is.
    fn follows(&self, diagonal: &Diagonal<'_>) -> bool {
        let twins = |source: &Source| matches!(*source, Source::Facet(f) if self.twins.has(f));
        let [f, g] = diagonal.sources;
        if f != g && twins(&f) && twins(&g) {
            // An edge of both sides; looks along it may meet one face above and the other below.
            return false;
        }
        let ends = [diagonal.old, diagonal.new].map(|ends| ends.map(|v| diagonal.positions[v as usize]));
        let [[a, b], [c, d]] = ends;
        let normal = (b - a).cross(d - c).normalize_or_zero();
        // What leaves the wall is not seen between its sides.
        let off = |[p, q]: [DVec3; 2]| {
            let seen = between(self.remesh.solid, self.segments, self.walls, p.midpoint(q), normal);
            seen.map_or(f64::INFINITY, |seen| seen.off.length() / seen.thickness)
        };
        let new = off([c, d]);
        new < RIGHT || new <= off([a, b])
    }

    /// Closes edges shorter than is said for faces of the solid.
    fn close(&self, sheet: &mut Sheet, short: &[f64]) {
        for _ in 0..ROUNDS {
            let sources = sheet.sources.clone();
            let least = |f: u32| match sources[f as usize] {
                Source::Facet(source) => short[source as usize],
                Source::Plane(_) => 0.0,
            };
            if !self.remesh.close(sheet, &least) {
                break;
            }
        }
    }

    /// Edges of a group close if they are shorter than this: a share of the thickness, but not those of an evenly fine mesh.
    fn short(&self, g: u32) -> f64 {
        let most = self.walls.partners(g).iter().max_by(|a, b| a.area.total_cmp(&b.area));
        let group = self.segments.group(g);
        let edge = (EVEN * group.area / group.faces.len().max(1) as f64).sqrt();
        most.map_or(0.0, |p| (CLOSED * p.thickness).min(SHORTER * edge))
    }

    /// Puts nodes inside of curved pieces halfway. O(n log n).
    fn settle(&self, sheet: &mut Sheet) {
        let nodes = self.remesh.nodes(sheet);
        let n = sheet.positions.len();
        let (mut normals, mut shortest) = (vec![DVec3::ZERO; n], vec![f64::INFINITY; n]);
        for f in 0..sheet.faces.len() as u32 {
            let normal = nodes.mesh.area_normal(f);
            for v in sheet.faces[f as usize] {
                normals[v as usize] += normal;
            }
        }
        for [a, b] in nodes.adjacency.edges() {
            let length = sheet.positions[*a as usize].distance(sheet.positions[*b as usize]);
            for v in [a, b] {
                shortest[*v as usize] = shortest[*v as usize].min(length);
            }
        }
        let moved: Vec<Option<DVec3>> = (0..n)
            .into_par_iter()
            .map(|v| {
                let normal = Some(normals[v].normalize_or_zero());
                let normal = normal.filter(|n| nodes.inside[v] && *n != DVec3::ZERO)?;
                let p = sheet.positions[v];
                let seen = between(self.remesh.solid, self.segments, self.walls, p, normal)?;
                let off = seen.off.clamp_length_max(NODE_REACH * shortest[v]);
                (off.length() > NODE_OFF * seen.thickness).then_some(p + off)
            })
            .collect();
        let before = sheet.positions.clone();
        for (p, moved) in sheet.positions.iter_mut().zip(&moved) {
            *p = moved.unwrap_or(*p);
        }
        self.withdraw(sheet, &before);
    }

    /// Puts nodes of faces that lean too much back to where they were.
    fn withdraw(&self, sheet: &mut Sheet, before: &[DVec3]) {
        for _ in 0..ROUNDS {
            let leans = |f: u32, positions: &[DVec3]| {
                let corners = sheet.faces[f as usize].map(|v| positions[v as usize]);
                self.remesh.leans(sheet, f, corners)
            };
            let leaning: Vec<u32> = (0..sheet.faces.len() as u32)
                .filter(|f| leans(*f, &sheet.positions) && !leans(*f, before))
                .collect();
            if leaning.is_empty() {
                return;
            }
            for v in leaning.into_iter().flat_map(|f| sheet.faces[f as usize]) {
                sheet.positions[v as usize] = before[v as usize];
            }
        }
    }

    /// Splits the wanted edges of curved pieces in the middle; whether there were any.
    fn split(&self, sheet: &mut Sheet, most: usize, wanted: &(dyn Fn(&Look) -> bool + Sync)) -> bool {
        let nodes = self.remesh.nodes(sheet);
        let split: Vec<Option<Look>> = (0..nodes.adjacency.edges().len() as u32)
            .into_par_iter()
            .map(|e| self.look(sheet, &nodes, e).filter(wanted))
            .collect();
        let count = split.iter().flatten().count();
        if count <= split.len() / FEW || sheet.faces.len() + 2 * count > most {
            return false;
        }
        let mut before = sheet.positions.clone();
        let mut middles: BTreeMap<u32, u32> = BTreeMap::new();
        for (e, look) in (0u32..).zip(split) {
            if let Some(look) = look {
                before.push(look.middle);
                sheet.positions.push(look.middle + look.off);
                middles.insert(e, sheet.positions.len() as u32 - 1);
            }
        }
        divide(sheet, &nodes, &middles);
        self.withdraw(sheet, &before);
        true
    }

    /// What is to be seen from the middle of an edge of curved pieces; nothing where a plane piece has a part in it: those end in
    /// straight lines.
    fn look(&self, sheet: &Sheet, nodes: &Nodes, e: u32) -> Option<Look> {
        let half_edges = nodes.adjacency.half_edges(e);
        let [a, b] = nodes.adjacency.edges()[e as usize].map(|v| nodes.mesh.positions[v as usize]);
        let (middle, length) = (a.midpoint(b), a.distance(b));
        let (mut off, mut thickness, mut count) = (DVec3::ZERO, 0.0, 0.0);
        for h in half_edges {
            self.remesh.normal(sheet, h / 3)?;
            let [p, q, r] = nodes.mesh.corners(h / 3);
            let normal = (q - p).cross(r - p).normalize_or_zero();
            let from = middle.lerp((p + q + r) / 3.0, INSET);
            if let Some(seen) = between(self.remesh.solid, self.segments, self.walls, from, normal) {
                (off, thickness, count) = (off + seen.off, thickness + seen.thickness, count + 1.0);
            }
        }
        let (off, thickness) = if count > 0.0 { (off / count, thickness / count) } else { (off, thickness) };
        Some(Look { middle, length, off, thickness })
    }

    /// Gives faces that have moved the facets that they lie below now.
    fn name_sources(&self, sheet: &mut Sheet) {
        let named = |(face, source): (&[u32; 3], &Source)| -> Source {
            let Source::Facet(old) = *source else { return *source };
            let [a, b, c] = face.map(|v| sheet.positions[v as usize]);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let hit = self.walls.first(self.remesh.solid, (a + b + c) / 3.0, normal);
            let same = |f: u32| {
                self.segments.of(f) == self.segments.of(old)
                    && self.remesh.solid.normals[f as usize].dot(normal) > 0.5
            };
            hit.filter(|hit| same(hit.face)).map_or(*source, |hit| Source::Facet(hit.face))
        };
        let sources: Vec<Source> = sheet.faces.par_iter().zip(&sheet.sources).map(named).collect();
        sheet.sources = sources;
    }
}

/// The wall about the middle of an edge.
struct Look {
    middle: DVec3,
    /// Of the edge.
    length: f64,
    /// The way to the middle of the wall; none where nothing is seen.
    off: DVec3,
    thickness: f64,
}

/// Meshes a sheet of flat facets to about an edge length where it lies: long edges are split, and diagonals turned within planes.
/// O(n log n) a round.
pub(super) fn split_to(sheet: &mut Sheet, solid: &Solid, length: f64) {
    let remesh = Remesh { solid, held: &[] };
    let is_flat = |diagonal: &Diagonal<'_>| {
        let [[a, b], [c, d]] =
            [diagonal.old, diagonal.new].map(|ends| ends.map(|v| diagonal.positions[v as usize]));
        let normal = (b - a).cross(d - c).normalize_or_zero();
        normal.dot(c - a).abs() < FLAT * a.distance(b).max(c.distance(d))
    };
    for _ in 0..MESHINGS {
        let nodes = remesh.nodes(sheet);
        let mut middles: BTreeMap<u32, u32> = BTreeMap::new();
        for (e, ends) in (0u32..).zip(nodes.adjacency.edges()) {
            let [p, q] = ends.map(|v| sheet.positions[v as usize]);
            if p.distance(q) > LONG * length && sheet.faces.len() + 2 * middles.len() < MOST_FACES {
                sheet.positions.push(p.midpoint(q));
                middles.insert(e, sheet.positions.len() as u32 - 1);
            }
        }
        if middles.is_empty() {
            break;
        }
        divide(sheet, &nodes, &middles);
        remesh.turn(sheet, &is_flat);
    }
}

/// Divides the faces beside edges with nodes in their middles.
fn divide(sheet: &mut Sheet, nodes: &Nodes, middles: &BTreeMap<u32, u32>) {
    let (faces, sources) = (std::mem::take(&mut sheet.faces), std::mem::take(&mut sheet.sources));
    for ((f, face), source) in (0u32..).zip(&faces).zip(sources) {
        let on_side = |k: u32| nodes.adjacency.edge_of(3 * f + k).and_then(|e| middles.get(&e).copied());
        for part in parts(*face, [on_side(0), on_side(1), on_side(2)], &sheet.positions) {
            sheet.faces.push(part);
            sheet.sources.push(source);
        }
    }
}

/// A face with nodes on some of its sides, as triangles; quadrangles are cut along their shorter diagonal.
fn parts(face: [u32; 3], middles: [Option<u32>; 3], positions: &[DVec3]) -> Vec<[u32; 3]> {
    let turned = |k: usize| {
        let [a, b, c] = [face[k], face[(k + 1) % 3], face[(k + 2) % 3]];
        (a, b, c, middles[k], middles[(k + 1) % 3], middles[(k + 2) % 3])
    };
    let length = |a: u32, b: u32| positions[a as usize].distance(positions[b as usize]);
    match middles.iter().flatten().count() {
        0 => vec![face],
        3 => {
            let (a, b, c, ab, bc, ca) = turned(0);
            let (Some(p), Some(q), Some(r)) = (ab, bc, ca) else { return vec![face] };
            vec![[a, p, r], [p, b, q], [r, q, c], [p, q, r]]
        }
        _ => {
            for k in 0..3 {
                match turned(k) {
                    (a, b, c, Some(p), None, None) => return vec![[a, p, c], [p, b, c]],
                    (a, b, c, Some(p), Some(q), None) => {
                        let rest = if length(a, q) < length(p, c) {
                            [[a, p, q], [a, q, c]]
                        } else {
                            [[a, p, c], [p, q, c]]
                        };
                        return vec![[p, b, q], rest[0], rest[1]];
                    }
                    _ => {}
                }
            }
            vec![face]
        }
    }
}
