//! A solid that is a sheet of flat facets made thick: the sheet is read off it, facet by facet.
//!
//! Where such a sheet folds sharply again and again, each side has lost what lies on the inner side of folds, and what is left are
//! many small planes with rounds between them; cutting them into walls that are stitched again has little to go by. But every facet
//! that is seen from both sides tells its mid-plane exactly, and a node goes to where the mid-planes about it meet. Rounds close when
//! their nodes have gone there. What one side has lost is taken from the other.

mod places;
mod sides;

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::query::{Adjacency, ClosestPoint};

use super::assemble::{Sheet, Source, cut};
use super::seams::Merged;
use super::segments::Segments;
use super::solid::{Solid, longest_side};
use super::walls::Walls;
use places::{Place, close, join, places, settle, starts};
use sides::{Facet, Sides, facets, flat_parts, grow};

/// Places as near as this share of the thickness are one where rounds were, whose chords tell them less exactly.
const NEAR: f64 = 1e-2;
/// Facets without an opposite one that are no rounds lie as they should up to this share of the thickness and this angle, in radians,
/// and get larger or smaller by no more than this factor.
const OFF: f64 = 1e-2;
const LEAN: f64 = 3.0 / 180.0 * std::f64::consts::PI;
const AS_LARGE: f64 = 1.6;
/// Facets narrower than this share of the thickness are no facets, but left where nodes were on edges.
const NARROW: f64 = 2e-3;
/// Bits of facets are narrower than so many thicknesses.
const BIT: f64 = 0.5;
/// Holes of so few edges are none if they are narrower than a bit, or than so many thicknesses all over.
const NOTCH_EDGES: usize = 8;
const NOTCH: f64 = 3.0;
/// Sheets of flat facets that fold have no more than so many of them, and facets of rounds.
const MOST_FACETS: u32 = 200_000;
const MOST_ROUNDS: usize = 20_000;
/// Passes of looking for lone facets, and for bits that reach past a corner: each may hang on others.
const PASSES: usize = 20;
/// A fold has cut away from a facet if its opposite one is so many times larger.
const CUT: f64 = 1.1;
/// This share of a sheet may not be what its facets say.
const WRONG: f64 = 1e-3;
/// A sheet is there where it is as near as this share of the thickness to the middle of two facets.
const THERE: f64 = 5e-2;
/// Walls that folds have cut away from have their middle as near as this share of the thickness.
const ABOUT: f64 = 0.3;
/// And this share of them may be missing.
const MISSING_WALLS: f64 = 0.03;
/// And this share of what the solid has two facets for may be missing: rounds may lie opposite to each other.
const MISSING: f64 = 1e-2;

/// The sheet that a solid is made of, if it can be read off: a manifold in one piece all facets of which lie between those of the
/// solid. O(n log n), with few rounds.
pub(super) fn read_off(solid: &Solid, segments: &Segments, walls: &Walls) -> Option<Sheet> {
    if solid.len() > MOST_FACETS {
        return None;
    }
    let (mut facets, paired) = facets(solid, walls);
    let sides = Sides::new(solid, &facets)?;
    let starts = starts(solid, &sides);
    let mut lone = BTreeSet::new();
    for _ in 0..PASSES {
        let found = lone_facets(solid, &facets, &places(solid, &facets, &sides, &starts));
        if found.is_empty() {
            break;
        }
        for f in &found {
            if let Some(facet) = &mut facets[*f as usize] {
                facet.is_sure = true;
            }
        }
        lone.extend(found);
    }
    let is_sure: Vec<bool> = (0..solid.len())
        .map(|f| sides.of(f).is_some() && facets[f as usize].is_some_and(|facet| facet.is_sure))
        .collect();
    grow(solid, &mut facets, &sides);
    let mut at = places(solid, &facets, &sides, &starts);
    let is_round = |f: &u32| sides.of(*f).is_some() && !is_sure[*f as usize];
    let rounds: Vec<u32> = (0..solid.len()).filter(is_round).collect();
    if rounds.len() > MOST_ROUNDS {
        return None;
    }
    let mut merged = Merged::new(at.len());
    close(solid, &rounds, &mut merged, &mut at);
    let sure: Vec<u32> = (0..solid.len()).filter(|f| is_sure[*f as usize]).collect();
    // Each side for itself: what a fold has cut away from is smaller there.
    settle(solid, &facets, &sure, &merged, &mut at);
    for _ in 0..PASSES {
        let turned = |f: &u32| is_turned(solid, &facets, &merged, &at, *f);
        let turned: Vec<u32> = sure.iter().copied().filter(turned).collect();
        if turned.is_empty() {
            break;
        }
        close(solid, &turned, &mut merged, &mut at);
        settle(solid, &facets, &sure, &merged, &mut at);
    }
    // Where folds follow on each other closely, both sides have lost so much that they only fit together as they are.
    let read = Read { solid, facets: &facets, sides: &sides, lone: &lone, sure: &sure };
    let sheets = [true, false].into_iter().map(|swaps| read.sheet(merged.clone(), at.clone(), swaps));
    sheets.into_iter().find(|sheet| {
        is_right(sheet, solid, &sides, &paired) && is_whole(sheet, solid, segments, walls, sides.thickness)
    })
}

/// What a sheet is read off from.
struct Read<'a> {
    solid: &'a Solid,
    facets: &'a [Option<Facet>],
    sides: &'a Sides,
    lone: &'a BTreeSet<u32>,
    /// Facets with an opposite one, and lone ones.
    sure: &'a [u32],
}

impl Read<'_> {
    /// The sheet of the main side; with `swaps`, where folds have cut away from that, of the other one. Nodes are `merged` and `at` their
    /// places.
    fn sheet(&self, mut merged: Merged, mut at: Vec<Place>, swaps: bool) -> Sheet {
        let Self { solid, facets, sides, lone, .. } = *self;
        let image = |f: &u32| solid.mesh.faces[*f as usize].map(|v| at[merged.find(v) as usize].at);
        let mut kept = self.taken(&image, swaps);
        let seen = Closest::new(kept.iter().filter(|f| sides.is_main(**f)).map(image));
        kept.retain(|f| {
            sides.is_main(*f) || !lone.contains(f) || !seen.is_near(middle(image(f)), NEAR * sides.thickness)
        });
        for _ in 0..2 {
            settle(solid, facets, &kept, &merged, &mut at);
            join(solid, sides, &kept, &mut merged, &mut at);
        }
        settle(solid, facets, &kept, &merged, &mut at);
        let mut sheet = Sheet { positions: at.iter().map(|place| place.at).collect(), ..Sheet::default() };
        for f in kept {
            let [a, b, c] = solid.mesh.faces[f as usize].map(|v| merged.find(v));
            if width([a, b, c].map(|v| at[v as usize].at)) > NARROW * sides.thickness {
                sheet.faces.push(if sides.is_main(f) { [a, b, c] } else { [a, c, b] });
                sheet.sources.push(Source::Facet(f));
            }
        }
        let mut sheet = without_strays(conforming(sheet, NEAR * sides.thickness));
        fill_notches(&mut sheet, sides.thickness);
        sheet.without_unused_nodes()
    }

    /// The facets that become the sheet: of those opposite to each other the ones of the main side, or the others where folds have cut
    /// away from them; and lone ones.
    fn taken(&self, image: &dyn Fn(&u32) -> [DVec3; 3], swaps: bool) -> Vec<u32> {
        let Self { solid, facets, sides, lone, sure } = *self;
        let flat = flat_parts(solid);
        let part = |f: u32| flat[f as usize] as usize;
        let mut areas = vec![0.0; flat.len()];
        for f in sure {
            let [a, b, c] = image(f);
            areas[part(*f)] += (b - a).cross(c - a).length() / 2.0;
        }
        let mut is_swapped = vec![false; flat.len()];
        for &f in sure.iter().filter(|f| swaps && sides.is_main(**f) && !lone.contains(f)) {
            let other = facets[f as usize].map_or(f, |facet| facet.seen);
            if areas[part(other)] > CUT * areas[part(f)] {
                is_swapped[part(f)] = true;
                is_swapped[part(other)] = true;
            }
        }
        let is_taken = |f: &u32| lone.contains(f) || sides.is_main(*f) != is_swapped[part(*f)];
        sure.iter().copied().filter(is_taken).collect()
    }
}

/// Facets without an opposite one that are no rounds: put where all others say, they lie as they should.
fn lone_facets(solid: &Solid, facets: &[Option<Facet>], places: &[Place]) -> Vec<u32> {
    let is_lone = |f: &u32| {
        let Some(facet) = facets[*f as usize].filter(|facet| !facet.is_sure) else { return false };
        let corners = solid.mesh.faces[*f as usize].map(|v| places[v as usize].at);
        let [a, b, c] = corners;
        let across = (b - a).cross(c - a);
        let share = across.length() / (2.0 * solid.areas[*f as usize]);
        let is_off = |p: &DVec3| facet.height(*p).abs() > OFF * facet.thickness;
        width(corners) > NEAR * facet.thickness
            && (1.0 / AS_LARGE..AS_LARGE).contains(&share)
            && across.dot(facet.normal) > LEAN.cos() * across.length()
            && !corners.iter().any(is_off)
    };
    (0..solid.len()).filter(is_lone).collect()
}

/// Whether a bit of a facet lies otherwise than it should: where a fold has cut away from it, it may reach past a corner.
fn is_turned(solid: &Solid, facets: &[Option<Facet>], merged: &Merged, at: &[Place], f: u32) -> bool {
    let Some(facet) = facets[f as usize] else { return false };
    let corners = solid.mesh.faces[f as usize].map(|v| at[merged.find(v) as usize].at);
    let [a, b, c] = corners;
    let across = (b - a).cross(c - a);
    let width = width(corners);
    width > 0.0 && width < BIT * facet.thickness && across.dot(facet.normal) < LEAN.cos() * across.length()
}

/// Triangles that places are near to, or not.
struct Closest(ClosestPoint);

impl Closest {
    fn new(triangles: impl Iterator<Item = [DVec3; 3]>) -> Self {
        let positions: Vec<DVec3> = triangles.flatten().collect();
        let faces = (0..positions.len() as u32 / 3).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
        Self(ClosestPoint::new(&TriMesh::new(positions, faces)))
    }

    fn is_near(&self, p: DVec3, distance: f64) -> bool {
        self.0.closest_within(p, distance).is_some()
    }
}

fn middle([a, b, c]: [DVec3; 3]) -> DVec3 {
    (a + b + c) / 3.0
}

/// The height of a triangle on its longest side; nothing if two corners are one.
fn width(corners: [DVec3; 3]) -> f64 {
    let [a, b, c] = corners;
    (b - a).cross(c - a).length() / longest_side(&corners).max(f64::MIN_POSITIVE)
}

/// Cuts faces at the free edges of which there are nodes of other free edges. O(n log n), with short edges.
fn conforming(mut sheet: Sheet, near: f64) -> Sheet {
    let mesh = TriMesh::new(sheet.positions.clone(), sheet.faces.clone());
    let adjacency = Adjacency::new(&mesh);
    let is_free = |h: u32| adjacency.edge_of(h).is_some_and(|e| adjacency.half_edges(e).len() == 1);
    let free: Vec<u32> = (0..3 * mesh.faces.len() as u32).filter(|h| is_free(*h)).collect();
    let mut nodes: Vec<u32> = free.iter().flat_map(|h| adjacency.ends(*h)).collect();
    let at = |v: u32| sheet.positions[v as usize];
    nodes.sort_by(|v, w| at(*v).x.total_cmp(&at(*w).x).then(v.cmp(w)));
    nodes.dedup();
    let mut paths: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for h in free {
        let ends = adjacency.ends(h);
        let [a, b] = ends.map(at);
        let along = |v: u32| (at(v) - a).dot(b - a) / (b - a).length_squared();
        let from = nodes.partition_point(|v| at(*v).x < a.x.min(b.x) - near);
        let within = nodes[from..].iter().copied().take_while(|v| at(*v).x <= a.x.max(b.x) + near);
        let is_on = |v: &u32| {
            let t = along(*v);
            !ends.contains(v) && (0.0..1.0).contains(&t) && at(*v).distance(a.lerp(b, t)) < near
        };
        let mut on: Vec<u32> = within.filter(is_on).collect();
        if !on.is_empty() {
            on.sort_by(|v, w| along(*v).total_cmp(&along(*w)));
            paths.insert(h, [&ends[..1], &on, &ends[1..]].concat());
        }
    }
    let (mut faces, mut sources) = (Vec::new(), Vec::new());
    for (f, source) in (0u32..).zip(&sheet.sources) {
        let sides = [0, 1, 2].map(|k| {
            let h = 3 * f + k;
            paths.get(&h).cloned().unwrap_or_else(|| adjacency.ends(h).to_vec())
        });
        let parts = cut(sides);
        sources.extend(parts.iter().map(|_| *source));
        faces.extend(parts);
    }
    sheet.faces = faces;
    sheet.sources = sources;
    sheet
}

/// Leaves out parts that are too small to be parts: bits that folds have cut off.
fn without_strays(mut sheet: Sheet) -> Sheet {
    let mesh = TriMesh::new(std::mem::take(&mut sheet.positions), std::mem::take(&mut sheet.faces));
    let (part, parts) = Adjacency::new(&mesh).components();
    let mut areas = vec![0.0; parts];
    (0u32..).zip(&part).for_each(|(f, part)| areas[*part as usize] += mesh.area_normal(f).length());
    let all: f64 = areas.iter().sum();
    let stays = |f: &usize| areas[part[*f] as usize] > WRONG * all;
    sheet.sources = (0..mesh.faces.len()).filter(stays).map(|f| sheet.sources[f]).collect();
    sheet.faces = (0..mesh.faces.len()).filter(stays).map(|f| mesh.faces[f]).collect();
    sheet.positions = mesh.positions;
    sheet
}

/// Fills holes of a few edges that are narrow against the thickness: where folds have cut both sides of a facet, each in another
/// place.
fn fill_notches(sheet: &mut Sheet, thickness: f64) {
    let adjacency = Adjacency::new(&TriMesh::new(sheet.positions.clone(), sheet.faces.clone()));
    let mut found: Vec<([u32; 3], u32)> = Vec::new();
    for mut outline in adjacency.boundary_loops() {
        let [first, second, ..] = outline[..] else { continue };
        let Some([h]) = adjacency.find_edge(first, second).map(|e| adjacency.half_edges(e)) else { continue };
        let (beside, runs_along) = (*h / 3, adjacency.ends(*h) == [first, second]);
        let mut ears = Vec::new();
        while (3..=NOTCH_EDGES).contains(&outline.len()) {
            let n = outline.len();
            let ear = |k: usize| [outline[(k + n - 1) % n], outline[k], outline[(k + 1) % n]];
            let corners = |k: usize| ear(k).map(|v| sheet.positions[v as usize]);
            let area = |k: usize| width(corners(k)) * longest_side(&corners(k));
            // What lies across may not be an edge already.
            let is_open = |k: &usize| n == 3 || adjacency.find_edge(ear(*k)[0], ear(*k)[2]).is_none();
            let Some(k) = (0..n).filter(is_open).min_by(|j, k| area(*j).total_cmp(&area(*k))) else { break };
            if width(corners(k)) > BIT * thickness && longest_side(&corners(k)) > NOTCH * thickness {
                break;
            }
            let [a, b, c] = ear(k);
            // It runs against its neighbours.
            ears.push((if runs_along { [c, b, a] } else { [a, b, c] }, beside));
            outline.remove(k);
        }
        if outline.len() == 2 {
            found.append(&mut ears);
        }
    }
    for (face, beside) in found {
        sheet.faces.push(face);
        sheet.sources.push(sheet.sources[beside as usize]);
    }
}

/// Whether a sheet is a manifold in one piece, lies as its facets say, and is there wherever the solid has facets opposite to each
/// other.
fn is_right(sheet: &Sheet, solid: &Solid, sides: &Sides, paired: &[u32]) -> bool {
    let mesh = TriMesh::new(sheet.positions.clone(), sheet.faces.clone());
    let adjacency = Adjacency::new(&mesh);
    let opposed = |e: u32| match adjacency.half_edges(e) {
        [_] => true,
        [a, b] => adjacency.ends(*a) != adjacency.ends(*b),
        _ => false,
    };
    let is_manifold = (0..adjacency.edges().len() as u32).all(opposed) && adjacency.components().1 == 1;
    if sheet.faces.is_empty() || !is_manifold {
        return false;
    }
    let (mut all, mut turned) = (0.0, 0.0);
    for (f, source) in (0u32..).zip(&sheet.sources) {
        let Source::Facet(source) = *source else { continue };
        let across = mesh.area_normal(f);
        let normal = solid.normals[source as usize] * if sides.is_main(source) { 1.0 } else { -1.0 };
        all += across.length();
        if across.dot(normal) < LEAN.cos() * across.length() {
            turned += across.length();
        }
    }
    let closest = ClosestPoint::new(&mesh);
    let image = |f: u32| solid.centroid(f) - solid.normals[f as usize] * (sides.thickness / 2.0);
    let is_missing = |f: &&u32| closest.closest_within(image(**f), THERE * sides.thickness).is_none();
    let missing: f64 = paired.iter().filter(is_missing).map(|f| solid.areas[*f as usize]).sum();
    turned < WRONG * all && missing < MISSING * all
}

/// Whether a sheet is there wherever the solid has walls, round ones too, whose facets have no facet opposite to them but parts of some.
fn is_whole(sheet: &Sheet, solid: &Solid, segments: &Segments, walls: &Walls, thickness: f64) -> bool {
    let closest = ClosestPoint::new(&TriMesh::new(sheet.positions.clone(), sheet.faces.clone()));
    let (mut all, mut missing) = (0.0, 0.0);
    for f in (0..solid.len()).filter(|f| walls.is_wall[segments.of(*f) as usize]) {
        let Some(opposite) = walls.opposite_middle(solid, segments, f) else { continue };
        let middle = solid.centroid(f) - solid.normals[f as usize] * (opposite.distance / 2.0);
        all += solid.areas[f as usize];
        if closest.closest_within(middle, ABOUT * thickness).is_none() {
            missing += solid.areas[f as usize];
        }
    }
    missing <= MISSING_WALLS * all
}
