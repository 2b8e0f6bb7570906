//! Solids that touch themselves in an edge or a node are joined there by beads.
//!
//! Where two walls meet in an edge only, more than two faces are at it, and no file tells which belong together. *Touch and
//! join* (Stroud & Nagy 2011, figs. 6.6–6.8) is what holds in a print: a bead about the edge, too small to be seen, is
//! united with the solid. Where walls part so slowly that a bead only moves the place, the parts *touch but miss*: each
//! gets nodes of its own there, a little withdrawn.

use std::collections::BTreeMap;

use glam::DVec3;

use super::edge_uses::{Use, edge_uses};
use super::grid::Grid;
use super::select::Boundary;
use super::{MergeError, MergeOptions, merge_nodes};
use crate::TriMesh;
use crate::body::radial::radial_order;
use crate::body::weld::UnionFind;
use crate::query::Crossings;

/// Radii of beads to be tried, as powers of two of the boundary's half size.
const BEADS: [i32; 3] = [-17, -14, -11];

/// How far nodes that touch are moved towards their neighbours, as powers of two of the way.
const WITHDRAWALS: [i32; 3] = [-16, -11, -6];

/// Where a boundary is no two-manifold.
#[derive(Default)]
struct Touches {
    /// Edges with more than two faces, and a face at each.
    edges: Vec<([u32; 2], u32)>,
    /// Nodes with more than one fan of faces, on no such edge, and a face at each.
    nodes: Vec<(u32, u32)>,
}

/// How a boundary was made a two-manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Joins {
    /// Beads that were united with it.
    pub(super) beads: usize,
    /// Nodes that were doubled, both in one place.
    pub(super) doubled: usize,
}

/// Makes a boundary that touches itself a two-manifold.
pub(super) fn join(
    boundary: &mut Boundary,
    grid: Grid,
    options: &MergeOptions<'_>,
) -> Result<Joins, MergeError> {
    let mut joins = Joins::default();
    for exponent in BEADS {
        let touches = touches(boundary);
        if touches.edges.is_empty() && touches.nodes.is_empty() {
            return Ok(joins);
        }
        let half = boundary.nodes.iter().fold(0.0f64, |m, p| m.max(p.abs().max_element()));
        let radius = (half * f64::from(exponent).exp2()).round().max(8.0);
        let count = touches.edges.len() + touches.nodes.len();
        let (chain, parents) = with_beads(boundary, touches, radius);
        match merge_nodes(chain, &parents, grid, options) {
            Ok(joined) => *boundary = joined,
            Err(MergeError::Tangled { .. }) => continue,
            Err(error) => return Err(error),
        }
        joins.beads += count;
    }
    joins.doubled = part(boundary);
    withdraw(boundary);
    Ok(joins)
}

/// Moves nodes that stand in one place into the parts that they belong to, by the least of some steps after which nothing
/// touches; leaves them where they are if none does.
fn withdraw(boundary: &mut Boundary) {
    let mut order: Vec<u32> = (0..boundary.nodes.len() as u32).collect();
    let place = |v: u32| boundary.nodes[v as usize].to_array().map(f64::to_bits);
    order.sort_unstable_by_key(|&v| (place(v), v));
    let mut link: BTreeMap<u32, (DVec3, f64)> = order
        .chunk_by(|a, b| place(*a) == place(*b))
        .filter(|group| group.len() > 1)
        .flatten()
        .map(|v| (*v, (DVec3::ZERO, 0.0)))
        .collect();
    for face in &boundary.faces {
        for k in 0..3 {
            if let Some((sum, count)) = link.get_mut(&face[k]) {
                *sum +=
                    boundary.nodes[face[(k + 1) % 3] as usize] + boundary.nodes[face[(k + 2) % 3] as usize];
                *count += 2.0;
            }
        }
    }
    for exponent in WITHDRAWALS {
        let mut moved = TriMesh::new(boundary.nodes.clone(), boundary.faces.clone());
        for (&v, &(sum, count)) in &link {
            let p = boundary.nodes[v as usize];
            moved.positions[v as usize] =
                p.lerp(sum / f64::max(count, 1.0), f64::from(exponent).exp2()).round();
        }
        if Crossings::new(&moved).self_crossing().is_empty() {
            boundary.nodes = moved.positions;
            return;
        }
    }
}

fn with_beads(boundary: &Boundary, touches: Touches, radius: f64) -> (TriMesh, Vec<u32>) {
    let mut chain = TriMesh::new(boundary.nodes.clone(), boundary.faces.clone());
    let mut parents = boundary.parents.clone();
    for ([a, b], face) in touches.edges {
        let ends = [a, b].map(|v| boundary.nodes[v as usize]);
        add_spindle(&mut chain, ends, radius);
        parents.resize(chain.faces.len(), boundary.parents[face as usize]);
    }
    for (node, face) in touches.nodes {
        let p = boundary.nodes[node as usize];
        add_spindle(&mut chain, [p, p], radius);
        parents.resize(chain.faces.len(), boundary.parents[face as usize]);
    }
    (chain, parents)
}

/// A closed body about a segment or a point, its faces in no plane that a model is likely to have.
fn add_spindle(chain: &mut TriMesh, [a, b]: [DVec3; 2], radius: f64) {
    let axis = (b - a).normalize_or(DVec3::new(0.36, 0.48, 0.8));
    let u = axis.any_orthonormal_vector();
    let v = axis.cross(u);
    let first = chain.positions.len() as u32;
    let ring = |p: DVec3, turn: f64| {
        [0, 1, 2, 3, 4].map(|k| {
            let angle = turn + f64::from(k) * std::f64::consts::TAU / 5.0;
            (p + (u * angle.cos() + v * angle.sin()) * radius).round()
        })
    };
    chain.positions.push((a - axis * 1.3 * radius).round());
    chain.positions.extend(ring(a, 0.37));
    chain.positions.extend(ring(b + axis * 0.21 * radius, 0.91));
    chain.positions.push((b + axis * 1.7 * radius).round());
    for k in 0..5 {
        let next = (k + 1) % 5;
        let (p, q, r, s) = (first + 1 + k, first + 1 + next, first + 6 + k, first + 6 + next);
        chain.faces.extend([[first, q, p], [p, q, r], [q, s, r], [r, s, first + 11]]);
    }
}

/// Number of a face's corner at a node.
fn corner(boundary: &Boundary, face: u32, node: u32) -> u32 {
    let k = boundary.faces[face as usize].iter().position(|x| *x == node).unwrap_or(0);
    3 * face + k as u32
}

fn touches(boundary: &Boundary) -> Touches {
    let mut found = Touches::default();
    // Corners of faces at a node, joined over edges: more than one set is more than one fan.
    let mut corners = UnionFind::new(3 * boundary.faces.len());
    let mut on_edge = vec![false; boundary.nodes.len()];
    for fan in edge_uses(&boundary.faces, boundary.nodes.len()).chunk_by(|a, b| a.0 == b.0) {
        let (ends, face, _) = fan[0];
        if fan.len() > 2 {
            found.edges.push((ends, face));
            ends.iter().for_each(|&v| on_edge[v as usize] = true);
        }
        for (_, other, _) in &fan[1..] {
            for v in ends {
                corners.union(corner(boundary, face, v), corner(boundary, *other, v));
            }
        }
    }
    let mut fan_of = vec![u32::MAX; boundary.nodes.len()];
    for (f, nodes) in (0..).zip(&boundary.faces) {
        for (k, &v) in (0..).zip(nodes) {
            let fan = corners.find(3 * f + k);
            let known = &mut fan_of[v as usize];
            if *known == u32::MAX {
                *known = fan;
            } else if *known != fan && !on_edge[v as usize] {
                on_edge[v as usize] = true;
                found.nodes.push((v, f));
            }
        }
    }
    found
}

/// Gives every part that touches another nodes of its own; returns how many nodes that adds.
fn part(boundary: &mut Boundary) -> usize {
    let before = boundary.nodes.len();
    // Edges whose two pairs of faces hang together at both ends get a node in the middle first, one for each pair.
    for _ in 0..2 {
        double_nodes(boundary);
        let uses = edge_uses(&boundary.faces, boundary.nodes.len());
        let mut cut: Vec<(u32, [u32; 2], u32)> = Vec::new();
        for fan in uses.chunk_by(|a, b| a.0 == b.0).filter(|fan| fan.len() > 2) {
            let [a, b] = fan[0].0.map(|v| boundary.nodes[v as usize]);
            for pair in pairs(boundary, fan) {
                let middle = boundary.nodes.len() as u32;
                boundary.nodes.push(((a + b) / 2.0).round());
                cut.extend(pair.map(|f| (f, fan[0].0, middle)));
            }
        }
        for (face, [a, b], middle) in cut {
            let old = boundary.faces[face as usize];
            boundary.faces[face as usize] = old.map(|v| if v == a { middle } else { v });
            boundary.faces.push(old.map(|v| if v == b { middle } else { v }));
            boundary.parents.push(boundary.parents[face as usize]);
        }
    }
    boundary.nodes.len() - before
}

/// The pairs of faces at an edge that have material between them.
fn pairs(boundary: &Boundary, fan: &[Use]) -> Vec<[u32; 2]> {
    let [a, b] = fan[0].0;
    let apex = |face: u32| {
        let apex = boundary.faces[face as usize].iter().find(|v| **v != a && **v != b);
        boundary.nodes[apex.copied().unwrap_or(a) as usize]
    };
    let apexes: Vec<DVec3> = fan.iter().map(|u| apex(u.1)).collect();
    let order = radial_order(boundary.nodes[a as usize], boundary.nodes[b as usize], &apexes)
        .map_or_else(|| (0..fan.len() as u32).collect(), |r| r.order);
    let turn = |k: usize| fan[order[k % order.len()] as usize];
    // A right hand about the edge comes from a face that runs against the edge into material.
    (0..order.len()).filter(|&k| !turn(k).2).map(|k| [turn(k).1, turn(k + 1).1]).collect()
}

fn double_nodes(boundary: &mut Boundary) {
    let mut corners = UnionFind::new(3 * boundary.faces.len());
    for fan in edge_uses(&boundary.faces, boundary.nodes.len()).chunk_by(|a, b| a.0 == b.0) {
        let mut join = |[one, other]: [u32; 2]| {
            for v in fan[0].0 {
                corners.union(corner(boundary, one, v), corner(boundary, other, v));
            }
        };
        match fan {
            [one, other] => join([one.1, other.1]),
            _ => pairs(boundary, fan).into_iter().for_each(join),
        }
    }
    // The first fan at a node keeps it.
    let mut owner = vec![u32::MAX; boundary.nodes.len()];
    let mut copy = vec![u32::MAX; 3 * boundary.faces.len()];
    for f in 0..boundary.faces.len() {
        for k in 0..3 {
            let v = boundary.faces[f][k];
            let fan = corners.find((3 * f + k) as u32);
            let owner = &mut owner[v as usize];
            if *owner == u32::MAX {
                *owner = fan;
            }
            if *owner != fan {
                let copy = &mut copy[fan as usize];
                if *copy == u32::MAX {
                    *copy = boundary.nodes.len() as u32;
                    let p = boundary.nodes[v as usize];
                    boundary.nodes.push(p);
                }
                boundary.faces[f][k] = *copy;
            }
        }
    }
}
