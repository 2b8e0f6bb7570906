//! Counts and measures of a thickened sheet.

use glam::DVec3;
use mesh_kernel::TriMesh;
use rayon::prelude::*;

use super::clean_sheet::CleanSheet;
use super::{OffsetChain, Origin, Role};

/// A side of a face is whole when its walls have its area but for this share.
const WHOLE: f64 = 1e-6;

/// What a closed mesh is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Pieces {
    /// Whether every edge has two faces, in opposite directions.
    pub(super) closed: bool,
    /// Shells with material inside: connected solids.
    pub(super) solids: usize,
    /// Handles of all shells.
    pub(super) genus: usize,
}

/// The connected parts of a closed surface.
pub(super) struct Shells {
    /// The shell of every node.
    pub(super) of_node: Vec<u32>,
    /// What every shell encloses, in cubes of the unit: below 0 about a void, 0 for a node without faces.
    pub(super) volumes: Vec<f64>,
}

/// Tells shells apart. O(n).
pub(super) fn shells(mesh: &TriMesh) -> Shells {
    let mut parents: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    for &[a, b, c] in &mesh.faces {
        for v in [b, c] {
            let (r, s) = (root(&mut parents, a), root(&mut parents, v));
            parents[r.max(s) as usize] = r.min(s);
        }
    }
    let mut of_node = vec![0; parents.len()];
    let mut count = 0;
    for v in 0..parents.len() as u32 {
        // Roots come before what they stand for.
        let r = root(&mut parents, v);
        of_node[v as usize] = if r == v { count } else { of_node[r as usize] };
        count += u32::from(r == v);
    }
    let middle = mesh.bounds().map_or(DVec3::ZERO, |[lo, hi]| 0.5 * (lo + hi));
    let mut volumes = vec![0.0; count as usize];
    for (f, face) in mesh.faces.iter().enumerate() {
        let [a, b, c] = mesh.corners(f as u32).map(|p| p - middle);
        volumes[of_node[face[0] as usize] as usize] += a.dot(b.cross(c)) / 6.0;
    }
    Shells { of_node, volumes }
}

/// Counts shells and handles. O(n log n).
pub(super) fn pieces(mesh: &TriMesh) -> Pieces {
    let mut edges: Vec<(u64, bool)> = Vec::with_capacity(3 * mesh.faces.len());
    for face in &mesh.faces {
        for k in 0..3 {
            let (a, b) = (face[k], face[(k + 1) % 3]);
            edges.push((u64::from(a.min(b)) << 32 | u64::from(a.max(b)), a < b));
        }
    }
    edges.par_sort_unstable();
    let closed = edges.len().is_multiple_of(2)
        && edges.chunks(2).all(|e| e[0].0 == e[1].0 && !e[0].1 && e[1].1)
        && edges.chunks(2).zip(edges.chunks(2).skip(1)).all(|(e, f)| e[0].0 != f[0].0);
    let Shells { of_node, volumes } = shells(mesh);
    let mut used = vec![false; mesh.positions.len()];
    let mut has_faces = vec![false; volumes.len()];
    for &v in mesh.faces.iter().flatten() {
        used[v as usize] = true;
        has_faces[of_node[v as usize] as usize] = true;
    }
    let nodes = used.iter().filter(|u| **u).count();
    let shells = has_faces.iter().filter(|h| **h).count();
    let solids = volumes.iter().filter(|v| **v > 0.0).count();
    // Σ (2 − 2 genus) = v − e + f.
    let euler = nodes as i64 - (edges.len() / 2) as i64 + mesh.faces.len() as i64;
    let genus = ((2 * shells as i64 - euler) / 2).max(0) as usize;
    Pieces { closed, solids, genus }
}

/// What a closed mesh encloses, in cubes of its unit. O(n).
pub(super) fn volume(mesh: &TriMesh) -> f64 {
    let middle = mesh.bounds().map_or(DVec3::ZERO, |[lo, hi]| 0.5 * (lo + hi));
    let six = |f: u32| {
        let [a, b, c] = mesh.corners(f).map(|p| p - middle);
        a.dot(b.cross(c))
    };
    (0..mesh.faces.len() as u32).map(six).sum::<f64>() / 6.0
}

/// The representative of `v`, with paths halved on the way.
pub(super) fn root(parents: &mut [u32], mut v: u32) -> u32 {
    while parents[v as usize] != v {
        parents[v as usize] = parents[parents[v as usize] as usize];
        v = parents[v as usize];
    }
    v
}

/// A face of the sheet whose walls are whole on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WholeWall {
    /// The face, counted in the input sheet.
    face: u32,
    normal: DVec3,
}

/// The faces of the sheet whose two sides are whole in the solid, ascending. O(n).
pub(super) fn whole_walls(
    sheet: &CleanSheet,
    chain: &OffsetChain,
    solid: &TriMesh,
    origins: &[Origin],
) -> Vec<WholeWall> {
    let sides = |mesh: &TriMesh, origins: &[Origin]| {
        let mut areas = vec![[0.0; 2]; sheet.faces.len()];
        for (f, origin) in origins.iter().enumerate() {
            if let (Some(side), Some(face)) = (side_of(origin.role), sheet.face_of_source(origin.face)) {
                areas[face][side] += mesh.area_normal(f as u32).length();
            }
        }
        areas
    };
    let (ideal, found) = (sides(&chain.mesh, &chain.origins), sides(solid, origins));
    let is_whole = |f: &usize| {
        (0..2).all(|s| ideal[*f][s] > 0.0 && (found[*f][s] - ideal[*f][s]).abs() <= WHOLE * ideal[*f][s])
    };
    let wall = |f: usize| WholeWall { face: sheet.sources[f], normal: sheet.normals[f] };
    (0..sheet.faces.len()).filter(is_whole).map(wall).collect()
}

/// The thinnest and the thickest of some walls, as far apart as the middles of their two sides are in a solid; zeros where
/// there is none. O(n log n).
pub(super) fn wall_range(walls: &[WholeWall], solid: &TriMesh, origins: &[Origin]) -> [f64; 2] {
    // Twice the area and the sum of middles by it, for both sides; the middle of the first face is the origin, for accuracy.
    let mut sums = vec![[(0.0, DVec3::ZERO); 2]; walls.len()];
    let base = solid.faces.first().map_or(DVec3::ZERO, |f| solid.positions[f[0] as usize]);
    for (f, origin) in (0..).zip(origins) {
        let wall = walls.binary_search_by_key(&origin.face, |w| w.face);
        if let (Some(side), Ok(wall)) = (side_of(origin.role), wall) {
            let (area, sum) = &mut sums[wall][side];
            let twice = solid.area_normal(f).length();
            let middle = solid.corners(f).iter().map(|p| *p - base).sum::<DVec3>() / 3.0;
            *area += twice;
            *sum += twice * middle;
        }
    }
    let mut range: Option<[f64; 2]> = None;
    for (wall, sides) in walls.iter().zip(sums).filter(|(_, s)| s.iter().all(|(area, _)| *area > 0.0)) {
        let [front, back] = sides.map(|(area, sum)| sum / area);
        let thick = wall.normal.dot(front - back).abs();
        range = Some(range.map_or([thick; 2], |[lo, hi]| [lo.min(thick), hi.max(thick)]));
    }
    range.unwrap_or_default()
}

fn side_of(role: Role) -> Option<usize> {
    match role {
        Role::FrontWall => Some(0),
        Role::BackWall => Some(1),
        Role::ThicknessFace | Role::Fill | Role::Corner => None,
    }
}
