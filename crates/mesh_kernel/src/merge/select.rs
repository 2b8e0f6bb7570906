//! The boundary of the wanted regions.

use glam::DVec3;

use super::edge_uses::edge_uses;
use super::{MergeError, MergeOptions, Merged, Regions, touching};
use crate::TriMesh;

/// What selection took away: every merged face that does not part wanted space from unwanted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Purged {
    /// Faces with one region on both sides (*laminar*, Lee & Kim 2001, fig. 12).
    pub laminar: usize,
    /// Faces between two regions that are both wanted, or both not (*screen*).
    pub screen: usize,
    /// Edges that have lost all their faces (*wire*).
    pub wire: usize,
}

/// A solid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solid {
    /// Closed and oriented outward; every edge has two faces and every node one fan of them; faces that have a point in
    /// common have it in a node or an edge of both.
    pub mesh: TriMesh,
    /// An input face that each face is part of, counted through all models.
    pub parents: Vec<u32>,
    /// What was taken away.
    pub purged: Purged,
    /// Edges and nodes where parts only touched and were joined by a bead.
    pub beads: usize,
    /// Nodes that stand in the place of another, where parts touch and no bead could join them.
    pub doubled_nodes: usize,
}

impl Solid {
    /// Volume, in cubes of the models' unit. O(n).
    pub fn volume(&self) -> f64 {
        let Some([lo, hi]) = self.mesh.bounds() else { return 0.0 };
        let middle = (lo + hi) / 2.0;
        let six = |f: u32| {
            let [a, b, c] = self.mesh.corners(f).map(|p| p - middle);
            a.cross(b).dot(c)
        };
        (0..self.mesh.faces.len() as u32).map(six).sum::<f64>() / 6.0
    }
}

/// Part of a film's boundary that is its rim.
const FEW: f64 = 0.05;

impl Merged {
    /// The boundary of the regions about which the models wind as `wanted` likes it.
    ///
    /// Where the boundary touches itself in an edge or a node, so that it is no two-manifold there, a bead of some 10⁻⁵ of
    /// the model's size joins what touches; where that does not help each part gets nodes of its own there.
    ///
    /// # Errors
    /// [`MergeError::Cancelled`].
    pub fn select(
        &self,
        regions: &Regions,
        wanted: impl Fn(&[i32]) -> bool,
        options: &MergeOptions<'_>,
    ) -> Result<Solid, MergeError> {
        let (mut boundary, purged) = self.boundary(regions, wanted);
        let joins = touching::join(&mut boundary, self.grid, options)?;
        let positions = boundary.nodes.iter().map(|p| self.grid.place(*p)).collect();
        Ok(Solid {
            mesh: TriMesh::new(positions, boundary.faces),
            parents: boundary.parents,
            purged,
            beads: joins.beads,
            doubled_nodes: joins.doubled,
        })
    }

    /// The faces between wanted and unwanted regions, which may touch each other in edges and nodes.
    pub(super) fn boundary(&self, regions: &Regions, wanted: impl Fn(&[i32]) -> bool) -> (Boundary, Purged) {
        let mut keep: Vec<bool> = (0..regions.count as u32).map(|r| wanted(regions.windings(r))).collect();
        self.drop_films(regions, &mut keep);
        let mut purged = Purged::default();
        let mut boundary = Boundary::default();
        let mut parents = Vec::new();
        let mut used = vec![false; self.nodes.len()];
        for (f, [front, back]) in (0..).zip(&regions.sides) {
            let inside = [front, back].map(|r| keep[*r as usize]);
            if inside[0] == inside[1] {
                if front == back {
                    purged.laminar += 1;
                } else {
                    purged.screen += 1;
                }
                continue;
            }
            let [a, b, c] = self.faces[f as usize];
            let outward = inside[1];
            boundary.faces.push(if outward { [a, b, c] } else { [a, c, b] });
            // Of several the one that is wound as the boundary.
            let parent = self.parents(f).iter().find(|p| p.reversed != outward).or(self.parents(f).first());
            parents.push(parent.map_or(0, |p| p.face));
            [a, b, c].iter().for_each(|&v| used[v as usize] = true);
        }
        let kept = edge_uses(&boundary.faces, self.nodes.len());
        purged.wire = regions.edges - kept.chunk_by(|a, b| a.0 == b.0).count();
        let mut number = vec![0; self.nodes.len()];
        for (v, _) in used.iter().enumerate().filter(|(_, used)| **used) {
            number[v] = boundary.nodes.len() as u32;
            boundary.nodes.push(self.nodes[v]);
        }
        boundary.faces.iter_mut().for_each(|f| *f = f.map(|v| number[v as usize]));
        boundary.parents = parents;
        (boundary, purged)
    }

    /// Regions no thicker than rounding makes them, between walls that were meant to be one, count as what most of their
    /// boundary borders on.
    fn drop_films(&self, regions: &Regions, keep: &mut [bool]) {
        let mut volume = vec![0.0; regions.count];
        let mut area = vec![0.0; regions.count];
        // Area towards wanted regions.
        let mut towards = vec![0.0; regions.count];
        for (face, [front, back]) in self.faces.iter().zip(&regions.sides) {
            let [front, back] = [*front as usize, *back as usize];
            if front == back {
                continue;
            }
            let [a, b, c] = face.map(|v| self.nodes[v as usize]);
            let six = a.cross(b).dot(c);
            let face_area = (b - a).cross(c - a).length() / 2.0;
            volume[back] += six / 6.0;
            volume[front] -= six / 6.0;
            for (region, other) in [(front, back), (back, front)] {
                area[region] += face_area;
                towards[region] += if keep[other] { face_area } else { 0.0 };
            }
        }
        for r in 0..regions.count {
            let thin = volume[r] >= 0.0 && 2.0 * volume[r] < self.grid.film * area[r];
            // A film between wanted and unwanted space may stay what it is.
            if thin && (towards[r] < FEW * area[r] || towards[r] > (1.0 - FEW) * area[r]) {
                keep[r] = towards[r] > 0.5 * area[r];
            }
        }
    }
}

/// The boundary of a solid on the grid.
#[derive(Clone, Debug, Default)]
pub(super) struct Boundary {
    pub(super) nodes: Vec<DVec3>,
    pub(super) faces: Vec<[u32; 3]>,
    pub(super) parents: Vec<u32>,
}
