//! Solids that touch themselves in an edge or a node are joined there by beads.
//!
//! Where two walls meet in an edge only, more than two faces are at it, and no file tells which belong together. *Touch and
//! join* (Stroud & Nagy 2011, fig. 6.7) is what holds in a print: a bead about the edge, too small to be seen, is united
//! with the solid.

use glam::DVec3;

use super::grid::Grid;
use super::select::Boundary;
use super::{MergeError, MergeOptions, merge_nodes};
use crate::TriMesh;

/// Radius of a bead, as a power of two of the grid's half size.
const BEAD: i32 = -17;
/// Tries, each with beads of twice the radius, until a solid is joined everywhere.
const TRIES: u32 = 6;

/// Where a boundary is no two-manifold.
#[derive(Default)]
struct Touches {
    /// Edges with more than two faces, and a face at each.
    edges: Vec<([u32; 2], u32)>,
    /// Nodes with more than one fan of faces, on no such edge, and a face at each.
    nodes: Vec<(u32, u32)>,
}

/// Joins a boundary where it touches itself; returns how many beads that took.
pub(super) fn join(
    boundary: &mut Boundary,
    grid: Grid,
    options: &MergeOptions<'_>,
) -> Result<usize, MergeError> {
    let mut beads = 0;
    for attempt in 0..=TRIES {
        let touches = touches(boundary);
        if touches.edges.is_empty() && touches.nodes.is_empty() {
            return Ok(beads);
        }
        if attempt == TRIES {
            break;
        }
        beads += touches.edges.len() + touches.nodes.len();
        let half = boundary.nodes.iter().fold(0.0f64, |m, p| m.max(p.abs().max_element()));
        let radius = (half * f64::from(BEAD + attempt as i32).exp2()).round().max(8.0);
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
        *boundary = merge_nodes(chain, &parents, grid, options)?;
    }
    Err(MergeError::Tangled { faces: boundary.faces.len() })
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

fn touches(boundary: &Boundary) -> Touches {
    let mut found = Touches::default();
    let mut uses: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * boundary.faces.len());
    for (f, &[a, b, c]) in (0..).zip(&boundary.faces) {
        uses.extend([(a, b), (b, c), (c, a)].map(|(p, q)| ([p.min(q), p.max(q)], f)));
    }
    uses.sort_unstable();
    // Corners of faces at a node, joined over edges: more than one set is more than one fan.
    let mut corners = crate::body::weld::UnionFind::new(3 * boundary.faces.len());
    let corner = |f: u32, v: u32| {
        let k = boundary.faces[f as usize].iter().position(|x| *x == v).unwrap_or(0);
        3 * f + k as u32
    };
    let mut on_edge = vec![false; boundary.nodes.len()];
    for fan in uses.chunk_by(|a, b| a.0 == b.0) {
        let (ends, face) = fan[0];
        if fan.len() > 2 {
            found.edges.push((ends, face));
            ends.iter().for_each(|&v| on_edge[v as usize] = true);
        }
        for (_, other) in &fan[1..] {
            for v in ends {
                corners.union(corner(face, v), corner(*other, v));
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
