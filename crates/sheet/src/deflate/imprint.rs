//! Walls that end on round ones which know nothing of them.
//!
//! Of the two sides of a round wall one is kept, with the edges of what stands on it. Webs on the other side end on its middle all the same, up
//! to the chords of both: they are drawn out a little, merged with it, and what sticks out beyond is cut off.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::merge::{MergeOptions, merge};
use mesh_kernel::query::RayCaster;
use rayon::prelude::*;

use super::assemble::Sheet;
use super::seams::Merged;

/// How far beside a border the face may be that it should be on, over the thickness of walls.
const BESIDE: f64 = 0.35;
/// Borders are drawn out by so many times this.
const DRAWN_OUT: f64 = 2.0;
/// What is farther out than so many times this is cut off.
const BEYOND: f64 = 1.5;
/// Looks along a face begin this share of the way beside it.
const ASIDE: f64 = 1e-3;
/// What was in one place before is so to this share of the way after.
const SAME: f64 = 1e-6;

/// A free edge that ends beside a face.
#[derive(Clone, Copy, Debug)]
struct Loose {
    /// As its face goes along it.
    ends: [u32; 2],
    face: u32,
    /// In the face, away from it.
    away: DVec3,
}

/// The sheet, whose faces stop the caster's rays, with its loose borders on the faces beside them; `None` if there are none, or if more than these would change.
/// O(n log n).
pub(super) fn imprinted(sheet: &Sheet, caster: &RayCaster, thickness: f64) -> Option<Sheet> {
    let reach = BESIDE * thickness;
    let mesh = TriMesh::new(sheet.positions.clone(), sheet.faces.clone());
    let uses = Uses::new(&sheet.faces);
    let loose = loose_edges(&mesh, caster, &uses, reach);
    if loose.is_empty() {
        return None;
    }
    let (mesh, flaps) = with_flaps(mesh, &uses, &loose, DRAWN_OUT * reach);
    let old = sheet.faces.len() as u32;
    let merged = merge(&[&mesh], &MergeOptions::default()).ok()?;
    // Nothing else may have been cut.
    let segments: Vec<[DVec3; 2]> =
        loose.iter().map(|l| l.ends.map(|v| mesh.positions[v as usize])).collect();
    let known = Places::new(&mesh.positions, SAME * reach);
    let is_near = |p: DVec3| segments.iter().any(|s| to_segment(p, *s) < DRAWN_OUT * reach);
    if !merged.positions.iter().all(|p| known.has(*p) || is_near(*p)) {
        return None;
    }
    let parent = |f: u32| merged.parents(f).first().map(|parent| (parent.face, parent.reversed));
    // Pieces between joints; those that reach the far ends of flaps are cut off.
    let uses = Uses::new(&merged.faces);
    let mut pieces = Merged::new(merged.faces.len());
    for edge in uses.edges() {
        if let [(_, f), (_, g)] = *edge {
            pieces.join(f, g);
        }
    }
    let mut cut_off = BTreeSet::new();
    for edge in uses.edges() {
        let [([a, b], f)] = *edge else { continue };
        let Some(flap) = parent(f).and_then(|(f, _)| flaps.get(f.checked_sub(old)? as usize)) else {
            continue;
        };
        let out =
            |v: u32| (merged.positions[v as usize] - mesh.positions[flap.ends[0] as usize]).dot(flap.away);
        if out(a).max(out(b)) > BEYOND * reach {
            cut_off.insert(pieces.find(f));
        }
    }
    let mut made = Sheet { positions: merged.positions.clone(), ..sheet.clone() };
    made.faces.clear();
    made.sources.clear();
    let (mut lost, mut lost_flaps) = (0.0, 0.0);
    for (f, &face) in (0u32..).zip(&merged.faces) {
        let (of, reversed) = parent(f)?;
        let flap = of.checked_sub(old).and_then(|k| flaps.get(k as usize));
        if cut_off.contains(&pieces.find(f)) {
            let [a, b, c] = face.map(|v| merged.positions[v as usize]);
            let area = (b - a).cross(c - a).length();
            *(if flap.is_some() { &mut lost_flaps } else { &mut lost }) += area;
            continue;
        }
        made.faces.push(if reversed { [face[0], face[2], face[1]] } else { face });
        made.sources.push(sheet.sources[flap.map_or(of, |flap| flap.face) as usize]);
    }
    // Only ends stick out.
    (lost <= lost_flaps).then(|| made.without_unused_nodes())
}

/// How long the borders are that end beside a face, in mm. O(n log n).
pub(super) fn loose_length(sheet: &Sheet, caster: &RayCaster, thickness: f64) -> f64 {
    let mesh = TriMesh::new(sheet.positions.clone(), sheet.faces.clone());
    let loose = loose_edges(&mesh, caster, &Uses::new(&sheet.faces), BESIDE * thickness);
    loose
        .iter()
        .map(|l| mesh.positions[l.ends[0] as usize].distance(mesh.positions[l.ends[1] as usize]))
        .sum()
}

/// The edges with their faces, in order.
struct Uses(Vec<([u32; 2], u32)>);

impl Uses {
    /// O(n log n).
    fn new(faces: &[[u32; 3]]) -> Self {
        let of_face = |f: u32| {
            let [a, b, c] = faces[f as usize];
            [[a, b], [b, c], [c, a]].map(|[p, q]| ([p.min(q), p.max(q)], f))
        };
        let mut uses: Vec<([u32; 2], u32)> = (0..faces.len() as u32).flat_map(of_face).collect();
        uses.par_sort_unstable();
        Self(uses)
    }

    /// The faces of every edge, one edge after the other.
    fn edges(&self) -> impl Iterator<Item = &[([u32; 2], u32)]> {
        self.0.chunk_by(|a, b| a.0 == b.0)
    }
}

/// Free edges from the middles of which another face is met within some way, on or off the own one.
fn loose_edges(mesh: &TriMesh, caster: &RayCaster, uses: &Uses, reach: f64) -> Vec<Loose> {
    let mut loose = Vec::new();
    for edge in uses.edges() {
        let [([a, b], face)] = *edge else { continue };
        let nodes = mesh.faces[face as usize];
        let forward = (0..3).any(|k| [nodes[k], nodes[(k + 1) % 3]] == [a, b]);
        let ends = if forward { [a, b] } else { [b, a] };
        let [p, q] = ends.map(|v| mesh.positions[v as usize]);
        let Some(normal) = mesh.area_normal(face).try_normalize() else { continue };
        let Some(away) = (q - p).cross(normal).try_normalize() else { continue };
        let from = p.midpoint(q) - away * reach + normal * (ASIDE * reach);
        let Some(hit) = caster.first(from, away, 0.0, 2.0 * reach) else { continue };
        let common = mesh.faces[hit.face as usize].iter().filter(|v| nodes.contains(v)).count();
        // What is as good as parallel is a wall beside it, not one that it ends on.
        let other = mesh.area_normal(hit.face).normalize_or_zero();
        if common < 2 && other.dot(away).abs() > 0.5 {
            loose.push(Loose { ends, face, away });
        }
    }
    loose
}

/// The mesh with a strip along every loose edge; strips run out where borders end on something else.
fn with_flaps(mut mesh: TriMesh, uses: &Uses, loose: &[Loose], width: f64) -> (TriMesh, Vec<Loose>) {
    let joints = uses.edges().filter(|edge| edge.len() > 2);
    let joined: BTreeSet<u32> = joints.flat_map(|edge| edge[0].0).collect();
    let mut away: BTreeMap<u32, DVec3> = BTreeMap::new();
    for edge in loose {
        edge.ends.iter().for_each(|v| *away.entry(*v).or_default() += edge.away);
    }
    let mut outer: BTreeMap<u32, u32> = BTreeMap::new();
    for (v, away) in away {
        if !joined.contains(&v) {
            outer.insert(v, mesh.positions.len() as u32);
            mesh.positions.push(mesh.positions[v as usize] + away.normalize_or_zero() * width);
        }
    }
    let mut flaps = Vec::new();
    for edge in loose {
        let [a, b] = edge.ends;
        let faces = match (outer.get(&a), outer.get(&b)) {
            (Some(&p), Some(&q)) => vec![[b, a, p], [b, p, q]],
            (Some(&p), None) => vec![[b, a, p]],
            (None, Some(&q)) => vec![[b, a, q]],
            (None, None) => continue,
        };
        flaps.extend(faces.iter().map(|_| *edge));
        mesh.faces.extend(faces);
    }
    (mesh, flaps)
}

fn to_segment(p: DVec3, [a, b]: [DVec3; 2]) -> f64 {
    let along = b - a;
    let share = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    p.distance(a + along * share)
}

/// Places, to be found again when rounding moved them.
struct Places {
    cells: BTreeSet<[i64; 3]>,
    size: f64,
}

impl Places {
    fn new(positions: &[DVec3], size: f64) -> Self {
        let cell = |p: &DVec3| (*p / size).round().to_array().map(|x| x as i64);
        Self { cells: positions.iter().map(cell).collect(), size }
    }

    fn has(&self, p: DVec3) -> bool {
        let [x, y, z] = (p / self.size).round().to_array().map(|x| x as i64);
        let near = [-1, 0, 1];
        near.iter()
            .any(|i| near.iter().any(|j| near.iter().any(|k| self.cells.contains(&[x + i, y + j, z + k]))))
    }
}
