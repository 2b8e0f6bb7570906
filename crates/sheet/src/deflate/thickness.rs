//! The thickness of every face of the mid-surface (paper's section 7; what shells are analysed with).

use std::collections::VecDeque;

use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::query::Adjacency;
use rayon::prelude::*;

use super::assemble::{FilledPlane, Sheet, Source};
use super::exact::Exact;
use super::follow::between;
use super::middle::{Middle, Middles};
use super::segments::Segments;
use super::solid::Solid;
use super::walls::Walls;

/// A thickness a face, in mm; with `exact`, that of the faces' geometry where there is one. O(n log n).
pub(super) fn thicknesses(
    sheet: &Sheet,
    solid: &Solid,
    segments: &Segments,
    walls: &Walls,
    middles: &Middles,
    corners: &[[Option<Middle>; 3]],
    exact: Option<&Exact>,
) -> Vec<f64> {
    let mesh = TriMesh::new(sheet.positions.clone(), sheet.faces.clone());
    let of = |f: usize| match sheet.sources[f] {
        Source::Facet(source) if !walls.is_wall[segments.of(source) as usize] => None,
        Source::Facet(source) => {
            if let Some((_, thickness)) = exact.and_then(|e| e.of(sheet.sources[f])) {
                return Some(thickness);
            }
            let [a, b, c] = mesh.corners(f as u32);
            let normal = solid.normals[source as usize];
            between(solid, segments, walls, (a + b + c) / 3.0, normal)
                .map(|seen| seen.thickness)
                .or_else(|| beside_facet(solid, segments, walls, corners, source))
        }
        Source::Plane(k) => {
            let FilledPlane { plane, is_step, .. } = sheet.planes[k as usize];
            if is_step {
                return None;
            }
            let [a, b, c] = mesh.corners(f as u32);
            between_planes(solid, segments, walls, middles, (a + b + c) / 3.0, plane.normal)
        }
    };
    let known: Vec<Option<f64>> = (0..sheet.faces.len()).into_par_iter().map(of).collect();
    let fallback = |f: usize| match sheet.sources[f] {
        Source::Plane(k) => sheet.planes[k as usize].groups.iter().find_map(|g| main_thickness(walls, *g)),
        Source::Facet(source) => main_thickness(walls, segments.of(source)),
    };
    let is_step = |source: &Source| match source {
        Source::Plane(k) => sheet.planes[*k as usize].is_step,
        Source::Facet(f) => !walls.is_wall[segments.of(*f) as usize],
    };
    let steps: Vec<bool> = sheet.sources.iter().map(is_step).collect();
    let mut spread = spread(&mesh, sheet, &steps, known);
    for (f, t) in spread.iter_mut().enumerate() {
        if t.is_none() {
            *t = fallback(f);
        }
    }
    spread.into_iter().map(|t| t.unwrap_or(walls.max_thickness)).collect()
}

fn main_thickness(walls: &Walls, g: u32) -> Option<f64> {
    let most = walls.partners(g).iter().max_by(|a, b| a.area.total_cmp(&b.area));
    most.map(|p| p.thickness)
}

/// The mean of what was seen through the material from a face of a curved wall.
fn beside_facet(
    solid: &Solid,
    segments: &Segments,
    walls: &Walls,
    corners: &[[Option<Middle>; 3]],
    f: u32,
) -> Option<f64> {
    let at_corners = corners[f as usize].iter().flatten().map(|m| m.thickness);
    let middle = walls.opposite_middle(solid, segments, f).map(|o| o.distance);
    let seen: Vec<f64> = at_corners.chain(middle).collect();
    (!seen.is_empty()).then(|| seen.iter().sum::<f64>() / seen.len() as f64)
}

/// How far it is from a point of a mid-plane through the material to both sides, if both are walls of one pair; where the plane
/// was aligned to another wall's, how thick the wall beside it is.
fn between_planes(
    solid: &Solid,
    segments: &Segments,
    walls: &Walls,
    middles: &Middles,
    p: DVec3,
    normal: DVec3,
) -> Option<f64> {
    let seen = [normal, -normal].map(|d| (d, walls.first(solid, p, d)));
    if let [(_, Some(up)), (_, Some(down))] = seen {
        let [g, h] = [up.face, down.face].map(|f| segments.of(f));
        if middles.between(g, h).or_else(|| middles.between(h, g)).is_some() {
            return Some(up.distance + down.distance);
        }
    }
    let beside = seen.into_iter().filter_map(|(d, hit)| {
        let hit = hit?;
        let back = walls.opposite(solid, segments, hit.face, p + d * hit.distance)?;
        let [g, h] = [hit.face, back.face].map(|f| segments.of(f));
        middles.between(g, h).or_else(|| middles.between(h, g)).map(|_| back.distance)
    });
    beside.min_by(f64::total_cmp)
}

/// Faces that do not know take what their neighbours in the same plane have, the nearest first.
fn spread(mesh: &TriMesh, sheet: &Sheet, is_step: &[bool], mut known: Vec<Option<f64>>) -> Vec<Option<f64>> {
    let adjacency = Adjacency::new(mesh);
    let mut queue: VecDeque<u32> = (0..known.len() as u32).filter(|f| known[*f as usize].is_some()).collect();
    // Steps are as thin as the thinnest wall that they join, so they ask last and across folds.
    let steps: Vec<u32> = (0..is_step.len() as u32).filter(|f| is_step[*f as usize]).collect();
    while let Some(f) = queue.pop_front() {
        for other in adjacency.neighbours(f).into_iter().flatten() {
            let same = match (sheet.sources[f as usize], sheet.sources[other as usize]) {
                (Source::Plane(a), Source::Plane(b)) => a == b,
                (Source::Facet(_), Source::Facet(_)) => !is_step[f as usize] && !is_step[other as usize],
                _ => false,
            };
            if same && known[other as usize].is_none() {
                known[other as usize] = known[f as usize];
                queue.push_back(other);
            }
        }
    }
    for _ in 0..2 {
        for &f in &steps {
            let beside = adjacency.neighbours(f).into_iter().flatten().filter_map(|g| known[g as usize]);
            let thinnest = beside.chain(known[f as usize]).fold(f64::INFINITY, f64::min);
            if thinnest.is_finite() {
                known[f as usize] = Some(thinnest);
            }
        }
    }
    known
}
