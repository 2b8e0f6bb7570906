//! Exact middles of round walls: the cylinder between two coaxial ones, the sphere between two concentric ones, and so on (Sheen et al.
//! 2008, section 6.2). A mesh that no longer follows the facets of the solid has its nodes there.

use glam::DVec3;
use mesh_kernel::query::Adjacency;

use super::assemble::{Sheet, Source};
use super::faces::Faces;
use super::remesh::Nodes;
use super::report::WallPair;
use super::shape::Shape;

/// Rounds in which a node is put on the middles that meet at it, one after the other.
const ROUNDS: usize = 12;
/// A node moves by no more than this many thicknesses.
const REACH: f64 = 1.5;

/// The exact middles of triangles of the solid.
#[derive(Debug)]
pub(super) struct Exact {
    of: Vec<Option<(Shape, f64)>>,
}

impl Exact {
    /// From the pairs of faces. Triangles of faces with several partners have the one that is nearest. O(n).
    pub(super) fn new(faces: &Faces, pairs: &[WallPair]) -> Self {
        let mut of_face: Vec<Option<(Shape, f64)>> = vec![None; faces.list.len()];
        for pair in pairs {
            for f in pair.faces {
                if of_face[f].is_none_or(|known| pair.thickness < known.1) {
                    of_face[f] = Some((pair.middle, pair.thickness));
                }
            }
        }
        Self { of: faces.of.iter().map(|f| of_face.get(*f as usize).copied().flatten()).collect() }
    }

    /// The middle of the wall that a face of the sheet came from, and how thick that is, in mm; `None` for plane pieces.
    pub(super) fn of(&self, source: Source) -> Option<(Shape, f64)> {
        match source {
            Source::Facet(f) => self.of[f as usize],
            Source::Plane(_) => None,
        }
    }

    /// Puts nodes that have nothing but exact middles about them on these: nodes inside, and nodes of free borders, which stay in
    /// the surface of the end. O(n).
    pub(super) fn settle(&self, sheet: &mut Sheet, nodes: &Nodes) {
        let n = sheet.positions.len();
        let mut about: Vec<Vec<(Shape, f64)>> = vec![Vec::new(); n];
        let mut is_exact = vec![true; n];
        for (face, source) in sheet.faces.iter().zip(&sheet.sources) {
            for v in face.map(|v| v as usize) {
                match self.of(*source) {
                    Some(own) if about[v].contains(&own) => {}
                    Some(own) => about[v].push(own),
                    None => is_exact[v] = false,
                }
            }
        }
        let across = conormals(nodes);
        for v in 0..n {
            let Some(end) = across[v].filter(|_| is_exact[v] && !about[v].is_empty()) else { continue };
            let from = sheet.positions[v];
            let mut p = from;
            for _ in 0..if about[v].len() > 1 { ROUNDS } else { 2 } {
                for (shape, _) in &about[v] {
                    let outward = shape.outward(p);
                    let way = outward - end * end.dot(outward);
                    let slope = way.dot(outward);
                    p -= if slope > 0.1 { way * (shape.distance(p) / slope) } else { DVec3::ZERO };
                }
            }
            let reach = about[v].iter().map(|m| m.1).fold(f64::INFINITY, f64::min) * REACH;
            if p.distance(from) < reach {
                sheet.positions[v] = p;
            }
        }
    }
}

/// For nodes inside of curved pieces nothing, for nodes of free borders the direction in the sheet straight across the border; `None`
/// for all others.
fn conormals(nodes: &Nodes) -> Vec<Option<DVec3>> {
    let (mesh, adjacency): (_, &Adjacency) = (&nodes.mesh, &nodes.adjacency);
    let mut is_border = vec![false; mesh.positions.len()];
    let mut other = vec![false; mesh.positions.len()];
    let mut across = vec![DVec3::ZERO; mesh.positions.len()];
    for (e, ends) in (0u32..).zip(adjacency.edges()) {
        match adjacency.half_edges(e) {
            [h] => {
                let [a, b] = adjacency.ends(*h).map(|v| mesh.positions[v as usize]);
                let out = (b - a).cross(mesh.area_normal(h / 3)).normalize_or_zero();
                for v in ends.map(|v| v as usize) {
                    is_border[v] = true;
                    across[v] += out;
                }
            }
            [h, k] if adjacency.ends(*h) != adjacency.ends(*k) => {}
            _ => ends.iter().for_each(|v| other[*v as usize] = true),
        }
    }
    (0..mesh.positions.len())
        .map(|v| match (nodes.inside[v], is_border[v] && !other[v]) {
            (true, _) => Some(DVec3::ZERO),
            (false, true) => Some(across[v].normalize_or_zero()).filter(|d| *d != DVec3::ZERO),
            _ => None,
        })
        .collect()
}
