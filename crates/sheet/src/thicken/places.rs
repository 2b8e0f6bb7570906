//! Places that deserve a look: tight bends, mitres cut short, sheets grown together.

use glam::DVec3;
use mesh_kernel::TriMesh;

use super::clean_sheet::CleanSheet;
use super::measure::root;
use super::{OffsetChain, Origin, Place, PlaceKind};

/// Most places of one kind that are told; more are gathered into wider ones.
const MOST: usize = 50;
/// Two walls have grown together when their faces are not connected within this many thicknesses of where they meet.
const NEAR: f64 = 2.0;
/// Pairs of walls that are looked at in one cell of the size of that reach.
const PAIRS_PER_CELL: usize = 4;

/// All places, by kind, then by patches, then in space.
pub(super) fn places(
    sheet: &CleanSheet,
    chain: &OffsetChain,
    solid: &TriMesh,
    origins: &[Origin],
) -> Vec<Place> {
    let mut all = Vec::new();
    let at_nodes = FacesAtNodes::new(sheet);
    for (kind, faces) in
        [(PlaceKind::TightCurvature, &chain.tight), (PlaceKind::MitreLimit, &chain.long_mitres)]
    {
        let flagged: Vec<usize> = faces.iter().filter_map(|&f| sheet.face_of_source(f)).collect();
        all.extend(gathered(kind, connected(sheet, &at_nodes, &flagged)));
    }
    all.extend(gathered(PlaceKind::Merged, grown_together(sheet, &at_nodes, solid, origins)));
    all
}

/// One spot of a place.
#[derive(Clone, Debug)]
struct Spot {
    at: DVec3,
    patches: Vec<u32>,
    faces: usize,
}

/// Spots as places, gathered in an ever coarser grid while there are too many.
fn gathered(kind: PlaceKind, mut spots: Vec<Spot>) -> Vec<Place> {
    let mut cell = spots
        .iter()
        .flat_map(|s| spots.first().map(|first| s.at.distance(first.at)))
        .fold(0.0f64, f64::max)
        .max(f64::MIN_POSITIVE)
        / 64.0;
    while spots.len() > MOST && cell.is_finite() {
        cell *= 2.0;
        spots = joined(spots, cell);
    }
    spots.into_iter().map(|Spot { at, patches, faces }| Place { kind, at, patches, faces }).collect()
}

/// Spots of the same patches in one cell made one.
fn joined(mut spots: Vec<Spot>, cell: f64) -> Vec<Spot> {
    let key = |s: &Spot| (s.patches.clone(), (s.at / cell).floor().to_array().map(|x| x as i64));
    spots.sort_by_cached_key(key);
    spots
        .chunk_by(|a, b| key(a) == key(b))
        .map(|same| {
            let faces = same.iter().map(|s| s.faces).sum::<usize>().max(1);
            let at = same.iter().map(|s| s.faces as f64 * s.at).sum::<DVec3>() / faces as f64;
            Spot { at, patches: same[0].patches.clone(), faces }
        })
        .collect()
}

/// The faces at every node.
struct FacesAtNodes {
    start: Vec<u32>,
    faces: Vec<u32>,
}

impl FacesAtNodes {
    fn new(sheet: &CleanSheet) -> Self {
        let mut start = vec![0u32; sheet.positions.len() + 1];
        for &v in sheet.faces.iter().flatten() {
            start[v as usize + 1] += 1;
        }
        for v in 0..sheet.positions.len() {
            start[v + 1] += start[v];
        }
        let (mut fill, mut faces) = (start.clone(), vec![0; 3 * sheet.faces.len()]);
        for (f, corners) in sheet.faces.iter().enumerate() {
            for &v in corners {
                faces[fill[v as usize] as usize] = f as u32;
                fill[v as usize] += 1;
            }
        }
        Self { start, faces }
    }

    fn at(&self, v: u32) -> &[u32] {
        &self.faces[self.start[v as usize] as usize..self.start[v as usize + 1] as usize]
    }
}

/// Flagged faces, connected ones as one spot.
fn connected(sheet: &CleanSheet, at_nodes: &FacesAtNodes, flagged: &[usize]) -> Vec<Spot> {
    if flagged.is_empty() {
        return Vec::new();
    }
    let mut group: Vec<u32> = (0..sheet.faces.len() as u32).collect();
    let mut is_flagged = vec![false; sheet.faces.len()];
    flagged.iter().for_each(|&f| is_flagged[f] = true);
    for &f in flagged {
        for &v in &sheet.faces[f] {
            for &g in at_nodes.at(v).iter().filter(|&&g| is_flagged[g as usize]) {
                let (a, b) = (root(&mut group, f as u32), root(&mut group, g));
                group[a.max(b) as usize] = a.min(b);
            }
        }
    }
    let mut by_group: Vec<(u32, usize)> = flagged.iter().map(|&f| (root(&mut group, f as u32), f)).collect();
    by_group.sort_unstable();
    by_group
        .chunk_by(|a, b| a.0 == b.0)
        .map(|faces| {
            let sum: DVec3 = faces.iter().map(|&(_, f)| sheet.corners(f).iter().sum::<DVec3>() / 3.0).sum();
            Spot {
                at: sum / faces.len() as f64,
                patches: sheet.patches_of(faces.iter().map(|x| x.1)),
                faces: faces.len(),
            }
        })
        .collect()
}

/// Two faces of the sheet whose walls meet, and where. In the order of fields.
#[derive(Clone, Copy, Debug)]
struct Pair {
    patches: [u32; 2],
    /// Cell of a grid.
    cell: [i64; 3],
    faces: [usize; 2],
    at: DVec3,
}

/// Where two walls of the solid meet whose faces are not connected near there.
fn grown_together(
    sheet: &CleanSheet,
    at_nodes: &FacesAtNodes,
    solid: &TriMesh,
    origins: &[Origin],
) -> Vec<Spot> {
    let thickest = sheet.thickness.iter().flatten().fold(0.0f64, |m, t| m.max(*t));
    let reach = NEAR * thickest;
    let mut sides: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * solid.faces.len());
    for (f, face) in solid.faces.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (face[k], face[(k + 1) % 3]);
            sides.push((a.min(b), a.max(b), f as u32));
        }
    }
    sides.sort_unstable();
    let own_face = |f: u32| sheet.face_of_source(origins[f as usize].face);
    let mut pairs: Vec<Pair> = Vec::new();
    for edge in sides.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let [(a, b, f), (_, _, g)] = edge else { continue };
        let (Some(f), Some(g)) = (own_face(*f), own_face(*g)) else { continue };
        if f == g || sheet.faces[f].iter().any(|v| sheet.faces[g].contains(v)) {
            continue;
        }
        let at = 0.5 * (solid.positions[*a as usize] + solid.positions[*b as usize]);
        let (p, q) = (sheet.patches[f], sheet.patches[g]);
        pairs.push(Pair {
            patches: [p.min(q), p.max(q)],
            cell: (at / reach).floor().to_array().map(|x| x as i64),
            faces: [f.min(g), f.max(g)],
            at,
        });
    }
    let key = |pair: &Pair| (pair.patches, pair.cell);
    pairs.sort_by_key(|pair| (key(pair), pair.faces));
    let mut search = Search { sheet, at_nodes, stamp: vec![0; sheet.faces.len()], now: 0, queue: Vec::new() };
    let mut spots = Vec::new();
    for cell in pairs.chunk_by(|a, b| key(a) == key(b)) {
        let apart: Vec<DVec3> = cell
            .iter()
            .step_by(cell.len().div_ceil(PAIRS_PER_CELL))
            .filter(|pair| !search.connects(pair.faces, pair.at, reach))
            .map(|pair| pair.at)
            .collect();
        if apart.is_empty() {
            continue;
        }
        let mut faces: Vec<usize> = cell.iter().flat_map(|pair| pair.faces).collect();
        faces.sort_unstable();
        faces.dedup();
        let mut patches = cell[0].patches.to_vec();
        patches.dedup();
        let at = apart.iter().sum::<DVec3>() / apart.len() as f64;
        spots.push(Spot { at, patches, faces: faces.len() });
    }
    // Cells follow curves: one place where they touch would be better than many, so the grid is widened once.
    joined(spots, 8.0 * reach.max(f64::MIN_POSITIVE))
}

/// A walk over the faces near a point.
struct Search<'a> {
    sheet: &'a CleanSheet,
    at_nodes: &'a FacesAtNodes,
    stamp: Vec<u32>,
    now: u32,
    queue: Vec<usize>,
}

impl Search<'_> {
    /// Whether face `g` is reached from face `f` over faces that come within `reach` of a point.
    fn connects(&mut self, [f, g]: [usize; 2], at: DVec3, reach: f64) -> bool {
        self.now += 1;
        self.queue.clear();
        self.queue.push(f);
        self.stamp[f] = self.now;
        while let Some(face) = self.queue.pop() {
            for &v in &self.sheet.faces[face] {
                for &next in self.at_nodes.at(v) {
                    let next = next as usize;
                    if next == g {
                        return true;
                    }
                    if self.stamp[next] != self.now {
                        self.stamp[next] = self.now;
                        if distance(at, self.sheet.corners(next)) <= reach {
                            self.queue.push(next);
                        }
                    }
                }
            }
        }
        false
    }
}

/// Distance of a point from a triangle.
fn distance(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let inside = [(a, b), (b, c), (c, a)].iter().all(|(q, r)| (*r - *q).cross(p - *q).dot(normal) >= 0.0);
    if inside && normal != DVec3::ZERO {
        return (p - a).dot(normal).abs() / normal.length();
    }
    let to_segment = |q: DVec3, r: DVec3| {
        let along = ((p - q).dot(r - q) / (r - q).length_squared()).clamp(0.0, 1.0);
        p.distance(q.lerp(r, along))
    };
    to_segment(a, b).min(to_segment(b, c)).min(to_segment(c, a))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_from_a_triangle() {
        let triangle = [DVec3::ZERO, DVec3::X * 2.0, DVec3::Y * 2.0];
        assert_eq!(distance(DVec3::new(0.5, 0.5, 3.0), triangle), 3.0);
        assert_eq!(distance(DVec3::new(-3.0, -4.0, 0.0), triangle), 5.0);
        assert_eq!(distance(DVec3::new(1.0, -1.0, 0.0), triangle), 1.0);
        assert!((distance(DVec3::new(2.0, 2.0, 0.0), triangle) - 2f64.sqrt()).abs() < 1e-15);
    }
}
