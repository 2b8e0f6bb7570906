//! Curved pieces refined until they follow the middle between both sides of their walls.
//!
//! The two sides of a curved wall are tessellated each in its own way, so the middle between them bends at the edges of
//! both. Edges are split where their middle is off, and the new nodes put halfway between what is in front and behind.

use std::collections::BTreeMap;

use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::query::Adjacency;
use rayon::prelude::*;

use super::assemble::{Sheet, Source};
use super::segments::Segments;
use super::solid::Solid;
use super::walls::Walls;

/// An edge is split if its middle is off by more than this share of the thickness.
const OFF: f64 = 8e-3;
/// A new node stands off by at most this share of the heights of the faces about it.
const BEND: f64 = 0.2;
/// Edges shorter than this share of the thickness are left as they are.
const SHORTEST: f64 = 0.4;
/// Rounds of splitting.
const ROUNDS: usize = 6;
/// Looks from an edge begin this far from it towards the middle of a face: at a free edge there is nothing to be seen.
const INSET: f64 = 0.04;
/// The middle is looked for within this share of the thickness.
const FAR: f64 = 0.3;

/// The wall about a point of its middle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Between {
    /// How far the middle is in front of the point, in mm.
    pub(super) off: f64,
    /// How thick the wall is, in mm.
    pub(super) thickness: f64,
}

/// Looks both ways through the material from a point beside the middle of a wall.
pub(super) fn between(
    solid: &Solid,
    segments: &Segments,
    walls: &Walls,
    p: DVec3,
    normal: DVec3,
) -> Option<Between> {
    let (up, down) = (walls.first(solid, p, normal)?, walls.first(solid, p, -normal)?);
    let sound = [(up.face, normal), (down.face, -normal)].into_iter().all(|(f, d)| {
        walls.is_wall[segments.of(f) as usize]
            && solid.normals[f as usize].dot(d) > super::walls::FACET_LEAN.cos()
    });
    let thickness = up.distance + down.distance;
    let off = (up.distance - down.distance) / 2.0;
    (sound && thickness <= walls.max_thickness && off.abs() < FAR * thickness)
        .then_some(Between { off, thickness })
}

/// Refines the curved pieces of a sheet. O(n log n) a round.
pub(super) fn follow(sheet: &mut Sheet, solid: &Solid, segments: &Segments, walls: &Walls) {
    let most = MOST_TIMES * solid.mesh.faces.len().max(MOST_ANYWAY);
    for _ in 0..ROUNDS {
        let mesh = TriMesh::new(sheet.positions.clone(), sheet.faces.clone());
        let adjacency = Adjacency::new(&mesh);
        let split: Vec<Option<DVec3>> = (0..adjacency.edges().len() as u32)
            .into_par_iter()
            .map(|e| split_at(sheet, &mesh, &adjacency, solid, segments, walls, e))
            .collect();
        let mut middles: BTreeMap<u32, u32> = BTreeMap::new();
        for (e, place) in (0u32..).zip(split) {
            if let Some(p) = place {
                sheet.positions.push(p);
                middles.insert(e, sheet.positions.len() as u32 - 1);
            }
        }
        if middles.is_empty() || sheet.faces.len() + 2 * middles.len() > most {
            return;
        }
        let (faces, sources) = (std::mem::take(&mut sheet.faces), std::mem::take(&mut sheet.sources));
        for ((f, face), source) in (0u32..).zip(&faces).zip(sources) {
            let on_side = |k: u32| adjacency.edge_of(3 * f + k).and_then(|e| middles.get(&e).copied());
            for part in parts(*face, [on_side(0), on_side(1), on_side(2)], &sheet.positions) {
                sheet.faces.push(part);
                sheet.sources.push(source);
            }
        }
    }
}

/// Refinement stops at this many times the solid's faces, or of that many.
const MOST_TIMES: usize = 6;
const MOST_ANYWAY: usize = 5000;

/// Where an edge of curved pieces is to be split, if it is.
fn split_at(
    sheet: &Sheet,
    mesh: &TriMesh,
    adjacency: &Adjacency,
    solid: &Solid,
    segments: &Segments,
    walls: &Walls,
    e: u32,
) -> Option<DVec3> {
    let [a, b] = adjacency.edges()[e as usize].map(|v| mesh.positions[v as usize]);
    let middle = (a + b) / 2.0;
    let (mut off, mut count) = (DVec3::ZERO, 0.0);
    let (mut worst, mut lowest) = (0.0f64, f64::INFINITY);
    for h in adjacency.half_edges(e) {
        let f = h / 3;
        // Plane pieces end in straight lines.
        let Source::Facet(source) = sheet.sources[f as usize] else { return None };
        let normal = solid.normals[source as usize];
        let [p, q, r] = mesh.corners(f);
        lowest = lowest.min((q - p).cross(r - p).length() / a.distance(b));
        let from = middle.lerp((p + q + r) / 3.0, INSET);
        let Some(seen) = between(solid, segments, walls, from, normal) else { continue };
        if a.distance(b) < SHORTEST * seen.thickness {
            return None;
        }
        off += normal * seen.off;
        worst = worst.max(seen.off.abs() / seen.thickness);
        count += 1.0;
    }
    // A node that leaves a low face would fold it.
    let bend = off.length() / count / lowest.min(a.distance(b) / 2.0);
    (count > 0.0 && worst > OFF && bend < BEND).then(|| middle + off / count)
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
