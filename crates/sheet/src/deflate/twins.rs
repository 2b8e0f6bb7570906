//! Walls whose two sides are meshed alike, as offsets are: faces and nodes that belong to each other.
//!
//! Halfway between two such nodes lies the middle, exactly, however rough the mesh is: what the offset of one side is off by at a
//! node, that of the other is off by in the other direction. Planes of facets only know it to the first order.

use std::collections::VecDeque;

use glam::DVec3;
use rayon::prelude::*;

use super::solid::Solid;
use super::walls::Walls;

/// Twin faces are parallel up to this, in radians.
const LEAN: f64 = 3.0 / 180.0 * std::f64::consts::PI;
/// The thickness at the corners of one differs by no more than this share of it.
const EVEN: f64 = 0.03;
/// Corners of the first pair of a set of twins are opposite to each other up to this share of the sides.
const ASIDE_FIRST: f64 = 0.25;
/// Corners of the others up to this share of the thickness: folds shift them.
const ASIDE: f64 = 1.2;

/// Twin of a face: the other face, and which of its corners belongs to the first one.
type Twin = (u32, u32);

/// Faces and nodes opposite to each other.
#[derive(Debug)]
pub(super) struct Twins {
    faces: Vec<Option<Twin>>,
    /// Of every node.
    nodes: Vec<Option<u32>>,
}

impl Twins {
    /// Finds pairs of faces that lie opposite to each other, and from these on their neighbours. O(n log n).
    pub(super) fn new(solid: &Solid, walls: &Walls) -> Self {
        let mut twins = Self { faces: vec![None; solid.len() as usize], nodes: Vec::new() };
        let first = |f: u32| twins.first(solid, walls, f);
        let firsts: Vec<Option<Twin>> = (0..solid.len()).into_par_iter().map(first).collect();
        let mut queue = VecDeque::new();
        for (f, found) in (0u32..).zip(firsts) {
            let Some(found) = found else { continue };
            twins.join(f, found, &mut queue);
            while let Some(f) = queue.pop_front() {
                for (other, twin) in twins.beside(solid, f) {
                    if is_pair(solid, walls, other, twin) {
                        twins.join(other, twin, &mut queue);
                    }
                }
            }
        }
        twins.nodes = twins.nodes(solid);
        twins
    }

    /// Whether a face has a twin.
    pub(super) fn has(&self, f: u32) -> bool {
        self.faces[f as usize].is_some()
    }

    /// The twin of a node, if the faces about it agree on one.
    pub(super) fn of_node(&self, v: u32) -> Option<u32> {
        self.nodes[v as usize]
    }

    /// Twins, unless one of both is taken.
    fn join(&mut self, f: u32, (g, first): Twin, queue: &mut VecDeque<u32>) {
        if f == g || self.faces[f as usize].is_some() || self.faces[g as usize].is_some() {
            return;
        }
        self.faces[f as usize] = Some((g, first));
        // Corners run the other way round over there: k belongs to first − k, and that to k again.
        self.faces[g as usize] = Some((f, first));
        queue.push_back(f);
    }

    /// The faces about one, with the twins that they should have.
    fn beside(&self, solid: &Solid, f: u32) -> Vec<(u32, Twin)> {
        let Some(twin) = self.faces[f as usize] else { return Vec::new() };
        (0..3).filter_map(|k| beside(solid, f, twin, k)).collect()
    }

    /// Whether a face and what is seen from its middle are twins beyond doubt: their neighbours are so too.
    fn first(&self, solid: &Solid, walls: &Walls, f: u32) -> Option<Twin> {
        let seen = walls.first(solid, solid.centroid(f), -solid.normals[f as usize])?;
        let [a, b, c] = solid.mesh.corners(f);
        let shortest = a.distance(b).min(b.distance(c)).min(c.distance(a));
        let candidate = (0..3).map(|first| (seen.face, first)).find(|twin| {
            let near = |k| aside(solid, f, *twin, k).0 < ASIDE_FIRST * shortest;
            (0..3).all(near) && is_pair(solid, walls, f, *twin)
        })?;
        let sound = |k| beside(solid, f, candidate, k).is_some_and(|(other, twin)| is_pair(solid, walls, other, twin));
        (0..3).all(sound).then_some(candidate)
    }

    fn nodes(&self, solid: &Solid) -> Vec<Option<u32>> {
        const NONE: u32 = u32::MAX;
        const MANY: u32 = u32::MAX - 1;
        let mut of = vec![NONE; solid.mesh.positions.len()];
        for (f, twin) in (0u32..).zip(&self.faces) {
            let Some((g, first)) = *twin else { continue };
            for k in 0..3 {
                let v = solid.mesh.faces[f as usize][k as usize];
                let w = solid.mesh.faces[g as usize][opposite(first, k)];
                let slot = &mut of[v as usize];
                *slot = if *slot == NONE || *slot == w { w } else { MANY };
            }
        }
        let mutual = |v: usize| {
            let w = of[v];
            (w < MANY && of[w as usize] == v as u32).then_some(w)
        };
        (0..of.len()).map(mutual).collect()
    }
}

/// Which corner of a twin belongs to corner `k`.
fn opposite(first: u32, k: u32) -> usize {
    ((first + 3 - k) % 3) as usize
}

/// The face across side `k` of one that has a twin, and the twin that it should have.
fn beside(solid: &Solid, f: u32, (g, first): Twin, k: u32) -> Option<(u32, Twin)> {
    // Side k goes from corner k to k + 1; over there it ends at the corner that belongs to k.
    let over = opposite(first, (k + 1) % 3) as u32;
    let h = solid.adjacency.partner(3 * f + k)?;
    let i = solid.adjacency.partner(3 * g + over)?;
    // Corner h % 3 is corner k + 1 of f, which belongs to the corner after i % 3.
    let first = (i % 3 + 1 + h % 3) % 3;
    Some((h / 3, (i / 3, first)))
}

/// How far corner `k` of a face stands aside from that of its twin, and the thickness there, in mm.
fn aside(solid: &Solid, f: u32, (g, first): Twin, k: u32) -> (f64, f64) {
    let normal = (solid.normals[f as usize] - solid.normals[g as usize]).normalize_or_zero();
    let at = |f: u32, k: usize| solid.mesh.positions[solid.mesh.faces[f as usize][k] as usize];
    let across = at(f, k as usize) - at(g, opposite(first, k));
    let thickness = normal.dot(across);
    ((across - normal * thickness).length(), thickness)
}

/// Whether two faces are parallel, as far from each other at all corners, and opposite to each other.
fn is_pair(solid: &Solid, walls: &Walls, f: u32, twin: Twin) -> bool {
    let (g, first) = twin;
    if f == g || solid.normals[f as usize].dot(-solid.normals[g as usize]) < LEAN.cos() {
        return false;
    }
    let corners = [0, 1, 2].map(|k| aside(solid, f, twin, k));
    let [thinnest, thickest] = [f64::min, f64::max].map(|of| corners[1..].iter().fold(corners[0].1, |t, c| of(t, c.1)));
    let even = thinnest > 0.0 && thickest <= walls.max_thickness && thickest - thinnest < EVEN * thickest;
    let near = corners.iter().all(|c| c.0 < ASIDE * thickest);
    let at = |f: u32, k: usize| solid.mesh.positions[solid.mesh.faces[f as usize][k] as usize];
    let [a, b, c] = [0, 1, 2].map(|k: u32| at(f, k as usize).midpoint(at(g, opposite(first, k))));
    let upright = (b - a).cross(c - a).dot(solid.normals[f as usize]) > 0.0;
    even && near && upright
}

/// Halfway between a node and its twin.
pub(super) fn midpoint(solid: &Solid, v: u32, w: u32) -> DVec3 {
    solid.mesh.positions[v as usize].midpoint(solid.mesh.positions[w as usize])
}
