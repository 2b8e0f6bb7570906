//! Walls whose two sides are meshed alike, as offsets are: faces and nodes that belong to each other.
//!
//! Halfway between two such nodes lies the middle, exactly, however rough the mesh is: what the offset of one side is off by at a
//! node, that of the other is off by in the other direction. Planes of facets only know it to the first order.

use std::collections::VecDeque;

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::seams::Merged;
use super::solid::Solid;
use super::star::Star;
use super::walls::Walls;

/// Twin faces are parallel up to this, in radians.
const LEAN: f64 = 3.0 / 180.0 * std::f64::consts::PI;
/// The thickness at the corners of one differs by no more than this share of it.
const EVEN: f64 = 0.03;
/// Corners of the first pair of a set of twins are opposite to each other up to this share of the sides.
const ASIDE_FIRST: f64 = 0.25;
/// How much staying beside the mean of its nodes weighs against the middles that a node lies on.
const STAY: f64 = 1e-6;
/// A node is within this share of the thickness of all middles that meet there.
const OFF: f64 = 0.01;
/// Corners of the others up to this share of the thickness: folds shift them.
const ASIDE: f64 = 1.2;
/// They are so far aside, over the thickness, without any.
const HARDLY_ASIDE: f64 = 0.02;

/// Folds of twins are alike up to this, in radians, or this share of the larger; but one beyond that angle may be a fan's.
const FOLDS_OFF: f64 = 1.0 / 180.0 * std::f64::consts::PI;
const ALIKE: f64 = 0.4;
const SHARP_FOLD: f64 = 15.0 / 180.0 * std::f64::consts::PI;

/// Twin of a face: the other face, and which of its corners belongs to the first one.
type Twin = (u32, u32);

/// Faces opposite to each other, and where the nodes that belong to them have their middle.
#[derive(Debug)]
pub(super) struct Twins {
    faces: Vec<Option<Twin>>,
    /// Of every node.
    middles: Vec<Option<DVec3>>,
}

impl Twins {
    /// Finds pairs of faces that lie opposite to each other, and from these on their neighbours. O(n log n).
    pub(super) fn new(solid: &Solid, walls: &Walls, star: &Star) -> Self {
        let mut twins = Self { faces: vec![None; solid.len() as usize], middles: Vec::new() };
        let first = |f: u32| twins.first(solid, walls, star, f);
        let firsts: Vec<Option<Twin>> = (0..solid.len()).into_par_iter().map(first).collect();
        let mut queue = VecDeque::new();
        for (f, found) in (0u32..).zip(firsts) {
            let Some(found) = found else { continue };
            twins.join(f, found, &mut queue);
            while let Some(f) = queue.pop_front() {
                for (other, twin) in twins.beside(solid, f) {
                    if is_pair(solid, walls, star, other, twin) {
                        twins.join(other, twin, &mut queue);
                    }
                }
            }
        }
        twins.middles = twins.middles(solid);
        twins
    }

    /// Whether a face has a twin.
    pub(super) fn has(&self, f: u32) -> bool {
        self.faces[f as usize].is_some()
    }

    /// The middle of the wall at a node, if the twins about it agree on one.
    pub(super) fn middle(&self, v: u32) -> Option<DVec3> {
        self.middles[v as usize]
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
    fn first(&self, solid: &Solid, walls: &Walls, star: &Star, f: u32) -> Option<Twin> {
        let seen = walls.behind(solid, f)?;
        let [a, b, c] = solid.mesh.corners(f);
        let shortest = a.distance(b).min(b.distance(c)).min(c.distance(a));
        let candidate = (0..3).map(|first| (seen.face, first)).find(|twin| {
            let near = |k| aside(solid, f, *twin, k).0 < ASIDE_FIRST * shortest;
            (0..3).all(near) && is_pair(solid, walls, star, f, *twin)
        })?;
        let sound = |k| {
            beside(solid, f, candidate, k)
                .is_some_and(|(other, twin)| is_pair(solid, walls, star, other, twin))
        };
        (0..3).all(sound).then_some(candidate)
    }

    /// Nodes that belong to each other have one middle. Mostly they are two; where a wall folds, its outer side has a fan of them.
    fn middles(&self, solid: &Solid) -> Vec<Option<DVec3>> {
        let n = solid.mesh.positions.len();
        let mut sets = Merged::new(n);
        let mut corners: Vec<(u32, Pairing)> = Vec::new();
        for (f, twin) in (0u32..).zip(&self.faces) {
            let Some((g, first)) = twin.filter(|(g, _)| f < *g) else { continue };
            let normal = (solid.normals[f as usize] - solid.normals[g as usize]).normalize_or_zero();
            for k in 0..3 {
                let v = solid.mesh.faces[f as usize][k as usize];
                let w = solid.mesh.faces[g as usize][opposite(first, k)];
                sets.join(v, w);
                corners.push((v, Pairing { nodes: [v, w], normal }));
            }
        }
        let mut of_set: Vec<(u32, Pairing)> = corners.into_iter().map(|(v, c)| (sets.find(v), c)).collect();
        of_set.sort_by_key(|c| c.0);
        let mut middles = vec![None; n];
        for run in of_set.chunk_by(|a, b| a.0 == b.0) {
            let middle = middle_of(solid, run);
            for v in run.iter().flat_map(|c| c.1.nodes) {
                middles[v as usize] = middle;
            }
        }
        middles
    }
}

/// Two corners of twins.
#[derive(Clone, Copy)]
struct Pairing {
    nodes: [u32; 2],
    /// Of the middle of the faces.
    normal: DVec3,
}

/// The middle of nodes that belong together: halfway between two; of more, where the middles of their faces meet.
fn middle_of(solid: &Solid, pairings: &[(u32, Pairing)]) -> Option<DVec3> {
    let at = |v: u32| solid.mesh.positions[v as usize];
    let halfway = |c: &Pairing| at(c.nodes[0]).midpoint(at(c.nodes[1]));
    let first = &pairings[0].1;
    let one_pair =
        pairings.iter().all(|(_, c)| c.nodes == first.nodes || c.nodes == [first.nodes[1], first.nodes[0]]);
    // A fan belongs to one node; else faces that only resemble each other have been mixed up.
    let hub = first.nodes.into_iter().any(|v| pairings.iter().all(|(_, c)| c.nodes.contains(&v)));
    if !hub {
        return None;
    }
    let thickness =
        pairings.iter().map(|(_, c)| at(c.nodes[0]).distance(at(c.nodes[1]))).fold(f64::INFINITY, f64::min);
    let start = pairings.iter().map(|(_, c)| halfway(c)).sum::<DVec3>() / pairings.len() as f64;
    let middle = if one_pair {
        start
    } else {
        let (mut matrix, mut right) = (DMat3::IDENTITY * (STAY * pairings.len() as f64), DVec3::ZERO);
        for (_, c) in pairings {
            let n = c.normal;
            matrix += DMat3::from_cols(n * n.x, n * n.y, n * n.z);
            right += n * n.dot(halfway(c) - start);
        }
        start + matrix.inverse() * right
    };
    let is_near = |c: &Pairing| c.normal.dot(middle - halfway(c)).abs() < OFF * thickness;
    (middle.is_finite() && pairings.iter().all(|(_, c)| is_near(c))).then_some(middle)
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

/// Whether the folds about the two nodes that corner `k` belongs to explain how far it stands aside: what does so anywhere else is not an
/// offset, but meshed in nearly the same way.
fn is_aside_by_folds(
    solid: &Solid,
    star: &Star,
    f: u32,
    (g, first): Twin,
    k: u32,
    (aside, thickness): (f64, f64),
) -> bool {
    if aside < HARDLY_ASIDE * thickness {
        return true;
    }
    let least = |f: u32, k: usize| {
        let normal = solid.normals[f as usize];
        let about = star.of(solid.mesh.faces[f as usize][k]).iter();
        about.map(|c| normal.dot(solid.normals[*c as usize / 3])).fold(1.0, f64::min)
    };
    let cosine = least(f, k as usize).min(least(g, opposite(first, k)));
    let tangent = (1.0 - cosine * cosine).max(0.0).sqrt() / cosine;
    cosine <= 0.0 || aside < (tangent + HARDLY_ASIDE) * thickness
}

/// Whether two faces are parallel, as far from each other at all corners, and opposite to each other.
fn is_pair(solid: &Solid, walls: &Walls, star: &Star, f: u32, twin: Twin) -> bool {
    let (g, first) = twin;
    if f == g || solid.normals[f as usize].dot(-solid.normals[g as usize]) < LEAN.cos() {
        return false;
    }
    let corners = [0, 1, 2].map(|k| aside(solid, f, twin, k));
    let [thinnest, thickest] =
        [f64::min, f64::max].map(|of| corners[1..].iter().fold(corners[0].1, |t, c| of(t, c.1)));
    let even = thinnest > 0.0 && thickest <= walls.max_thickness && thickest - thinnest < EVEN * thickest;
    let near = (0..3u32)
        .zip(&corners)
        .all(|(k, c)| c.0 < ASIDE * thickest && is_aside_by_folds(solid, star, f, twin, k, *c));
    let at = |f: u32, k: usize| solid.mesh.positions[solid.mesh.faces[f as usize][k] as usize];
    let [a, b, c] = [0, 1, 2].map(|k: u32| at(f, k as usize).midpoint(at(g, opposite(first, k))));
    let upright = (b - a).cross(c - a).dot(solid.normals[f as usize]) > 0.0;
    even && near && upright && (0..3).all(|k| folds_alike(solid, f, twin, k))
}

/// Whether both faces fold alike at side `k`: offsets do, but chords of one round face and more or fewer of the other do not. Beyond a sharp
/// fold one side may have a fan.
fn folds_alike(solid: &Solid, f: u32, (g, first): Twin, k: u32) -> bool {
    let fold = |h: u32| {
        let normals = [h / 3, solid.across(h)].map(|f| solid.normals[f as usize]);
        normals[0].angle_between(normals[1])
    };
    let (one, other) = (fold(3 * f + k), fold(3 * g + opposite(first, (k + 1) % 3) as u32));
    one.max(other) > SHARP_FOLD || (one - other).abs() < FOLDS_OFF.max(ALIKE * one.max(other))
}
