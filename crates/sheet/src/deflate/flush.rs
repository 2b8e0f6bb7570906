//! Ends of walls that lie flush with the side of another wall, so that both are one face of the skin: the edge of a floor in the plane
//! of a cheek that closes only a part of it. That face is a wall beside the cheek and an end beside the floor.

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::segments::Segments;
use super::solid::{SHARP, Solid};
use super::walls::{Opposite, Walls};

/// Looks along an end go this share of the thickness beneath it.
const BENEATH: f64 = 0.05;
/// They begin this share of the edge from its end.
const BESIDE: f64 = 0.15;
/// Cosine of the angle between a wall and its end, at most.
const UPRIGHT: f64 = 0.5;
/// Its other side is no farther than so many times its thickness, and faces it with this cosine.
const THICKER: f64 = 1.2;
const FACING: f64 = 0.9;

/// Where plane walls are ends of others.
#[derive(Debug)]
pub(super) struct Flush {
    /// Nodes with the plane walls that are nothing but ends there.
    ends: BTreeSet<(u32, u32)>,
    /// How much of the border of every group is so, in mm.
    pub(super) length: Vec<f64>,
}

impl Flush {
    /// O(m log n) in edges between walls.
    pub(super) fn new(solid: &Solid, segments: &Segments, walls: &Walls) -> Self {
        let look = |h: u32| {
            let [wall, end] = [h / 3, solid.across(h)].map(|f| segments.of(f));
            let both_walls = [wall, end].iter().all(|g| walls.is_wall[*g as usize]);
            if wall == end || !both_walls || segments.group(end).plane.is_none() {
                return None;
            }
            let [a, b] = solid.adjacency.ends(h);
            let [at_first, at_second] =
                [(a, b), (b, a)].map(|(v, w)| is_end(solid, segments, walls, h, v, w));
            Some((h, end, [(a, at_first), (b, at_second)]))
        };
        let seen: Vec<_> = (0..3 * solid.len()).into_par_iter().filter_map(look).collect();
        let (mut ends, mut sides) = (BTreeSet::new(), BTreeSet::new());
        for (_, group, nodes) in &seen {
            for (v, is_end) in nodes {
                if *is_end { &mut ends } else { &mut sides }.insert((*v, *group));
            }
        }
        ends.retain(|key| !sides.contains(key));
        let mut length = vec![0.0; segments.groups.len()];
        for (h, group, nodes) in seen {
            let at_ends = nodes.iter().filter(|(v, _)| ends.contains(&(*v, group))).count();
            length[group as usize] += solid.length(h) * at_ends as f64 / 2.0;
        }
        Self { ends, length }
    }

    /// Whether some plane wall is nothing but the end of others at a node.
    pub(super) fn is_at(&self, node: u32) -> bool {
        self.ends.range((node, 0)..=(node, u32::MAX)).next().is_some()
    }

    /// Whether a plane wall is nothing but the end of others at a node.
    pub(super) fn is_end(&self, group: u32, node: u32) -> bool {
        self.ends.contains(&(node, group))
    }
}

/// Whether behind the edge `h` of a wall, near its node `v`, lies nothing but the end of the wall: just beneath it one comes to the wall's
/// other side, and straight through it to no partner.
fn is_end(solid: &Solid, segments: &Segments, walls: &Walls, h: u32, v: u32, w: u32) -> bool {
    let [wall, end] = [h / 3, solid.across(h)];
    let [normal, out] = [wall, end].map(|f| solid.normals[f as usize]);
    let has_other_side = !walls.partners(segments.of(wall)).is_empty();
    if !has_other_side
        || solid.fold_cosine(h) > SHARP.cos()
        || !solid.is_convex(h)
        || normal.dot(out).abs() > UPRIGHT
    {
        return false;
    }
    let is_partner = |g: u32, f: u32| walls.partners(g).iter().any(|pair| pair.partner == segments.of(f));
    let [wall, end] = [wall, end].map(|f| segments.of(f));
    let own = || walls.partners(wall).iter().map(|pair| pair.thickness);
    let (thinnest, thickest) = (own().fold(f64::INFINITY, f64::min), own().fold(0.0, f64::max));
    let [p, q] = [v, w].map(|v| solid.mesh.positions[v as usize]);
    let beside = p.lerp(q, BESIDE);
    let inward = (normal * normal.dot(out) - out).normalize_or_zero();
    let across = walls.first(solid, beside + inward * (BENEATH * thinnest), -normal);
    // The other side may be another group where a bend begins.
    let is_other_side = |hit: &Opposite| {
        hit.distance < THICKER * thickest && normal.dot(-solid.normals[hit.face as usize]) > FACING
    };
    let Some(across) = across.filter(is_other_side) else { return false };
    let down = (out * normal.dot(out) - normal).normalize_or_zero();
    let through = walls.first(solid, beside + down * (across.distance / 2.0), -out);
    through.is_none_or(|hit| !is_partner(end, hit.face))
}
