//! Borders of the sheet that end beside faces which they should be joined to.

use std::collections::BTreeMap;

use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::query::{Adjacency, RayCaster, RayHit};

use super::assemble::{Sheet, Source};
use super::seams::Merged;
use super::solid::Solid;

/// How far beside a border the face may be that it should be on, over the thickness of walls.
const BESIDE: f64 = 0.35;
/// Looks along a face begin this share of the way beside it, and no farther back than this share of the piece; those for the skin begin this
/// share of the way back.
const ASIDE: f64 = 1e-3;
const WITHIN: f64 = 0.5;
const ASIDE_SKIN: f64 = 0.02;
/// Borders end on faces that they run into at a sine of more than this.
const STEEP: f64 = 0.5;
/// A curved piece goes on from a face to another if the cosine of the angle between them is more than this, over so many faces.
const SMOOTH: f64 = 0.9;
const MOST_FACES: usize = 256;

/// Borders are in the middle of the material if that goes on for more than this share of the thickness: ends that are round are not as long
/// as the material by less.
const DEEP: f64 = 0.25;
/// And count if they are longer than so many thicknesses.
const LONG: f64 = 2.0;

/// A free edge that ends beside a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Loose {
    /// As its face goes along it.
    pub(super) ends: [u32; 2],
    pub(super) face: u32,
    /// In the face, away from it.
    pub(super) away: DVec3,
}

/// What tells whether borders end beside faces.
pub(super) struct Beside<'a> {
    /// Rays that the faces of the sheet stop.
    pub(super) sheet: &'a RayCaster,
    pub(super) solid: &'a Solid,
    /// How thick walls are, in mm.
    pub(super) thickness: f64,
}

impl Beside<'_> {
    /// How far borders look for a face, in mm.
    pub(super) fn reach(&self) -> f64 {
        BESIDE * self.thickness
    }

    /// How long the borders are that end beside a face, in mm. O(n log n).
    pub(super) fn loose_length(&self, sheet: &Sheet) -> f64 {
        let mesh = TriMesh::new(sheet.positions.clone(), sheet.faces.clone());
        let loose = self.loose_edges(&mesh, &Adjacency::new(&mesh), &sheet.sources);
        let length = |l: &Loose| {
            let [p, q] = l.ends.map(|v| mesh.positions[v as usize]);
            p.distance(q)
        };
        loose.iter().map(length).sum()
    }

    /// Borders that end in the middle of the material instead of at its skin; those that are about as
    /// short as the foot of a rib's end, which does so, do not count. O(n log n).
    pub(super) fn buried(&self, sheet: &Sheet) -> Buried {
        let mesh = TriMesh::new(sheet.positions.clone(), sheet.faces.clone());
        let adjacency = Adjacency::new(&mesh);
        let is_buried = |h: &u32| {
            let [p, q] = adjacency.ends(*h).map(|v| mesh.positions[v as usize]);
            let away = (q - p).cross(mesh.area_normal(h / 3)).normalize_or_zero();
            let from = p.midpoint(q) - away * (ASIDE * self.reach());
            let skin = self.solid.caster.first(from, away, 0.0, f64::INFINITY);
            let is_inside = |hit: &RayHit| self.solid.normals[hit.face as usize].dot(away) > 0.0;
            skin.is_some_and(|hit| hit.distance > DEEP * self.thickness && is_inside(&hit))
        };
        let buried: Vec<u32> = free_edges(&adjacency).filter(is_buried).collect();
        let mut chains = Merged::new(mesh.positions.len());
        let mut lengths: BTreeMap<u32, f64> = BTreeMap::new();
        for &h in &buried {
            let [a, b] = adjacency.ends(h);
            chains.join(a, b);
        }
        let length = |h: u32| {
            let [p, q] = adjacency.ends(h).map(|v| mesh.positions[v as usize]);
            p.distance(q)
        };
        for &h in &buried {
            *lengths.entry(chains.find(adjacency.ends(h)[0])).or_default() += length(h);
        }
        let mut found = Buried::default();
        for h in buried {
            if lengths[&chains.find(adjacency.ends(h)[0])] > LONG * self.thickness {
                let [p, q] = adjacency.ends(h).map(|v| mesh.positions[v as usize]);
                found.length += length(h);
                found.at = found.at.or(Some(p.midpoint(q)));
                found.faces.push(h / 3);
            }
        }
        found
    }

    /// Free edges from the middles of which another face is met within some way through the material, on or off the own one.
    pub(super) fn loose_edges(
        &self,
        mesh: &TriMesh,
        adjacency: &Adjacency,
        sources: &[Source],
    ) -> Vec<Loose> {
        free_edges(adjacency).filter_map(|h| self.loose_edge(mesh, adjacency, sources, h)).collect()
    }

    fn loose_edge(&self, mesh: &TriMesh, adjacency: &Adjacency, sources: &[Source], h: u32) -> Option<Loose> {
        let reach = self.reach();
        let face = h / 3;
        let ends = adjacency.ends(h);
        let [p, q] = ends.map(|v| mesh.positions[v as usize]);
        let normal = mesh.area_normal(face).try_normalize()?;
        let away = (q - p).cross(normal).try_normalize()?;
        let middle = p.midpoint(q);
        // Not from behind the piece: a low web stands on what is there.
        let room = Room { mesh, adjacency, sources }.behind(h, middle, -away, reach / WITHIN);
        let back = WITHIN * room;
        let from = middle - away * back + normal * (ASIDE * reach);
        let hit = self.sheet.first(from, away, 0.0, back + reach)?;
        let nodes = mesh.faces[face as usize];
        let common = mesh.faces[hit.face as usize].iter().filter(|v| nodes.contains(v)).count();
        // What is as good as parallel is a wall beside it, not one that it ends on; nor is one beyond a gap.
        let other = mesh.area_normal(hit.face).normalize_or_zero();
        let start = back.min(ASIDE_SKIN * reach);
        let to = hit.distance - back;
        let inside = |from: f64, to: f64| {
            let way = to - from;
            self.solid.caster.first(middle + away * from, away * way.signum(), 0.0, way.abs()).is_none()
        };
        let is_loose = common < 2 && other.dot(away).abs() > STEEP && inside(-start, to);
        is_loose.then_some(Loose { ends, face, away })
    }
}

/// Half-edges without another face.
fn free_edges(adjacency: &Adjacency) -> impl Iterator<Item = u32> {
    (0..adjacency.edges().len() as u32).filter_map(|e| match adjacency.half_edges(e) {
        [h] => Some(*h),
        _ => None,
    })
}

/// Borders that end in the middle of the material.
#[derive(Clone, Debug, Default)]
pub(super) struct Buried {
    /// Of all, in mm.
    pub(super) length: f64,
    /// In the middle of one.
    pub(super) at: Option<DVec3>,
    /// Faces at them.
    pub(super) faces: Vec<u32>,
}

/// How far pieces go.
struct Room<'a> {
    mesh: &'a TriMesh,
    adjacency: &'a Adjacency,
    sources: &'a [Source],
}

impl Room<'_> {
    /// How far the piece goes from a point on one of its borders in a direction along it, up to a limit, in mm.
    fn behind(&self, border: u32, from: DVec3, mut direction: DVec3, limit: f64) -> f64 {
        let (mut h, mut at, mut gone) = (border, from, 0.0);
        for _ in 0..MOST_FACES {
            let (face, k) = (h / 3, h % 3);
            let normal = self.mesh.area_normal(face).normalize_or_zero();
            direction = direction.reject_from_normalized(normal).normalize_or_zero();
            // Out over the side that is met last within its ends.
            let sides = [1, 2].map(|j| 3 * face + (k + j) % 3);
            let met = sides.map(|side| {
                let [a, b] = self.adjacency.ends(side).map(|v| self.mesh.positions[v as usize]);
                let along = b - a;
                let across = direction.cross(along).dot(normal);
                let way = (a - at).cross(along).dot(normal) / across;
                let share = (a - at).cross(direction).dot(normal) / across;
                let is_met = way.is_finite() && (-1e-9..1.0 + 1e-9).contains(&share);
                (side, if is_met { way } else { f64::NEG_INFINITY })
            });
            let (side, way) = if met[0].1 > met[1].1 { met[0] } else { met[1] };
            gone += way.max(0.0);
            let Some(beyond) = self.goes_on(side).filter(|_| gone < limit && way.is_finite()) else { break };
            at += direction * way;
            h = beyond;
        }
        gone.min(limit)
    }

    /// The half-edge beyond another one in the same piece.
    fn goes_on(&self, h: u32) -> Option<u32> {
        let [a, b] = *self.adjacency.half_edges(self.adjacency.edge_of(h)?) else { return None };
        let beyond = if a == h { b } else { a };
        let of = |h: u32| self.sources[h as usize / 3];
        let normal = |h: u32| self.mesh.area_normal(h / 3).normalize_or_zero();
        let both_curved = [h, beyond].iter().all(|h| matches!(of(*h), Source::Facet(_)));
        let is_one = of(h) == of(beyond) || both_curved && normal(h).dot(normal(beyond)) > SMOOTH;
        is_one.then_some(beyond)
    }
}
