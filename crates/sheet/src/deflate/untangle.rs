//! Curved pieces that cross themselves are drawn smooth again.
//!
//! Where what is opposite jumps, as at the border of a fillet, nodes beside each other are put halfway to different faces and may
//! pass each other. Drawn between the nodes about them, as a skin of soap would be, they do not; where that leaves the middle of
//! the wall, they stay as they were.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::query::Crossings;
use rayon::prelude::*;

use super::assemble::{Sheet, Source};
use super::follow::between;
use super::remesh::{Nodes, Remesh};
use super::seams::Merged;
use super::segments::Segments;
use super::solid::Solid;
use super::walls::Walls;

/// Rings of nodes about what crosses that are drawn as well, one round after the other.
const RINGS: [usize; 4] = [1, 2, 4, 7];
/// Steps of drawing.
const STEPS: usize = 80;
/// What is drawn may be off the middle by this share of the thickness.
const OFF: f64 = 0.1;
/// This share of it may be so anyway.
const ASTRAY: f64 = 0.1;
/// About so many faces tell how much of a sheet is astray.
const LOOKED_AT: usize = 20_000;
/// Nodes hold each other as if they were at least this share of all edges apart.
const LEAST: f64 = 1e-3;

/// Draws what crosses. O(n log n).
pub(super) fn untangle(sheet: &mut Sheet, solid: &Solid, segments: &Segments, walls: &Walls) {
    let mut crossing = crossing_faces(sheet, |_| true);
    if crossing.is_empty() {
        return;
    }
    let mut nodes = Remesh { solid, held: &[] }.nodes(sheet);
    for rings in RINGS {
        let mut drawn: Vec<BTreeSet<u32>> = Vec::new();
        for cluster in clusters(sheet, &nodes, &crossing, rings) {
            let faces: BTreeSet<u32> = cluster.iter().flat_map(|v| nodes.faces(*v)).collect();
            let look =
                |sheet: &Sheet| Extent::new(sheet, faces.iter().copied(), solid, segments, walls, false);
            let was = look(sheet);
            draw(sheet, &nodes, &cluster);
            let is = look(sheet);
            if is.area > was.area || is.astray > was.astray.max(ASTRAY) {
                cluster.iter().for_each(|v| sheet.positions[*v as usize] = nodes.mesh.positions[*v as usize]);
            } else {
                drawn.push(faces);
            }
        }
        let now = crossing_now(sheet, &crossing, &drawn);
        if now.len() < crossing.len() {
            crossing = now;
            nodes.mesh.positions.clone_from(&sheet.positions);
        } else {
            sheet.positions.clone_from(&nodes.mesh.positions);
        }
        if crossing.is_empty() {
            break;
        }
    }
}

/// The share of the curved pieces that has left the middle of its wall, told from some of the faces. O(log n).
pub(super) fn astray(sheet: &Sheet, solid: &Solid, segments: &Segments, walls: &Walls) -> f64 {
    let is_wall = |f: &u32| match sheet.sources[*f as usize] {
        Source::Facet(source) => walls.is_wall[segments.of(source) as usize],
        Source::Plane(_) => false,
    };
    let every = sheet.faces.len() / LOOKED_AT + 1;
    let faces = (0..sheet.faces.len() as u32).step_by(every).filter(is_wall);
    Extent::new(sheet, faces, solid, segments, walls, true).astray
}

/// Pairs of faces that cross, of those that are looked at.
pub(super) fn crossing_faces(sheet: &Sheet, looked_at: impl Fn(&[u32; 3]) -> bool + Sync) -> Vec<(u32, u32)> {
    let faces: Vec<u32> = (0..sheet.faces.len() as u32)
        .into_par_iter()
        .filter(|f| looked_at(&sheet.faces[*f as usize]))
        .collect();
    let part = faces.iter().map(|f| sheet.faces[*f as usize]).collect();
    let pairs = Crossings::new(&TriMesh::new(sheet.positions.clone(), part)).self_crossing();
    pairs.into_iter().map(|(f, g)| (faces[f as usize], faces[g as usize])).collect()
}

/// The pairs that cross after some sets of faces were drawn: those that have to do with these are looked for anew.
fn crossing_now(sheet: &Sheet, before: &[(u32, u32)], drawn: &[BTreeSet<u32>]) -> Vec<(u32, u32)> {
    let extent = |nodes: &mut dyn Iterator<Item = u32>| {
        nodes
            .map(|v| sheet.positions[v as usize])
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)))
    };
    let of_set = |set: &BTreeSet<u32>| extent(&mut set.iter().flat_map(|f| sheet.faces[*f as usize]));
    let extents: Vec<(DVec3, DVec3)> = drawn.iter().map(of_set).collect();
    let is_near = |face: &[u32; 3]| {
        let (lo, hi) = extent(&mut face.iter().copied());
        extents.iter().any(|e| lo.cmple(e.1).all() && hi.cmpge(e.0).all())
    };
    let is_drawn = |f: u32| drawn.iter().any(|set| set.contains(&f));
    let has_part = |(f, g): &(u32, u32)| is_drawn(*f) || is_drawn(*g);
    let new = crossing_faces(sheet, is_near).into_iter().filter(has_part);
    before.iter().copied().filter(|pair| !has_part(pair)).chain(new).collect()
}

/// Sets of nodes inside of curved pieces, within some rings of what crosses.
fn clusters(sheet: &Sheet, nodes: &Nodes, crossing: &[(u32, u32)], rings: usize) -> Vec<Vec<u32>> {
    let faces = crossing.iter().flat_map(|(f, g)| [*f, *g]);
    let curved = faces.filter(|f| matches!(sheet.sources[*f as usize], Source::Facet(_)));
    let mut near: BTreeSet<u32> = curved.flat_map(|f| sheet.faces[f as usize]).collect();
    for _ in 0..rings {
        let about: Vec<u32> = near.iter().flat_map(|v| nodes.about(*v)).collect();
        near.extend(about);
    }
    near.retain(|v| nodes.inside[*v as usize]);
    let mut merged = Merged::new(sheet.positions.len());
    for &v in &near {
        nodes.about(v).filter(|w| near.contains(w)).for_each(|w| merged.join(v, w));
    }
    let mut sets: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for v in near {
        sets.entry(merged.find(v)).or_default().push(v);
    }
    sets.into_values().collect()
}

/// Puts every node in the middle of those about it, over and over; the nearer ones hold it more.
fn draw(sheet: &mut Sheet, nodes: &Nodes, cluster: &[u32]) {
    let at = |v: u32| nodes.mesh.positions[v as usize];
    let hold = |v: u32| {
        let mut about: Vec<(u32, f64)> = nodes.about(v).map(|w| (w, at(v).distance(at(w)))).collect();
        let least = LEAST * about.iter().map(|a| a.1).sum::<f64>();
        about.iter_mut().for_each(|a| a.1 = 1.0 / a.1.max(least));
        (v, about)
    };
    let holds: Vec<(u32, Vec<(u32, f64)>)> = cluster.iter().map(|v| hold(*v)).collect();
    for _ in 0..STEPS {
        for (v, about) in &holds {
            let add = |(sum, all): (DVec3, f64), (w, weight): &(u32, f64)| {
                (sum + sheet.positions[*w as usize] * *weight, all + weight)
            };
            let (sum, all) = about.iter().fold((DVec3::ZERO, 0.0), add);
            if all > 0.0 {
                sheet.positions[*v as usize] = sum / all;
            }
        }
    }
}

/// How far some faces reach, and how much of them has left the middle of the wall.
struct Extent {
    /// In mm².
    area: f64,
    /// A share of it.
    astray: f64,
}

impl Extent {
    /// `with_rims`: where no wall is seen, or one that leans, as in a round rim, what is halfway between the faces that are met is in the middle.
    fn new(
        sheet: &Sheet,
        faces: impl IntoIterator<Item = u32>,
        solid: &Solid,
        segments: &Segments,
        walls: &Walls,
        with_rims: bool,
    ) -> Self {
        let (mut area, mut astray) = (0.0, 0.0);
        for f in faces {
            let [a, b, c] = sheet.faces[f as usize].map(|v| sheet.positions[v as usize]);
            let across = (b - a).cross(c - a);
            let own = across.length() / 2.0;
            let (p, normal) = ((a + b + c) / 3.0, across.normalize_or_zero());
            let seen = between(solid, segments, walls, p, normal);
            let is_halfway = || {
                let seen = [normal, -normal].map(|way| walls.first(solid, p, way));
                let [Some(up), Some(down)] = seen else { return false };
                (up.distance - down.distance).abs() / 2.0 < OFF * (up.distance + down.distance)
            };
            area += own;
            if seen
                .map_or_else(|| !(with_rims && is_halfway()), |seen| seen.off.length() > OFF * seen.thickness)
            {
                astray += own;
            }
        }
        Self { area, astray: astray / f64::max(area, f64::MIN_POSITIVE) }
    }
}
