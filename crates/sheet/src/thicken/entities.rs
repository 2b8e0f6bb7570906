//! Face-uses, wedges and disks (Lee & Kim 2001, section 5.1), as one half-edge structure.
//!
//! A *face-use* is a side of a face: use `2f` is the front of face `f`, `2f + 1` its back. Seen from its own side its
//! corners go anticlockwise. Corner `3u + i` of use `u` is also the *edge-use* from that corner to the next. A *wedge*
//! is the empty space between two face-uses that are neighbours about an edge; it pairs two edge-uses of opposite
//! directions. Crossing wedge after wedge about a node closes a cycle of corners: a *disk*. All face-uses together, joined
//! by wedges, are the boundary of the void about the sheet: closed, oriented, and never non-manifold at an edge.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use mesh_kernel::body::order_about_edge;

use super::clean_sheet::CleanSheet;

/// Angles within this of a full turn, in radians, are a hairpin or two faces on one another.
const FULL_TURN: f64 = 1e-6;

/// The half-edge structure of a sheet's sides. Arrays are indexed by corner (= edge-use), 6 a face.
#[derive(Debug)]
pub(super) struct Entities {
    /// The node of every corner.
    pub(super) node: Vec<u32>,
    /// The edge-use on the other side of the wedge.
    pub(super) mate: Vec<u32>,
    /// How far the wedge opens beyond 180°, in radians: above 0 convex (of the material), below 0 concave; in [−π, π].
    pub(super) turn: Vec<f64>,
    /// Corners of every disk, anticlockwise seen from the void, disk after disk.
    pub(super) disk_corners: Vec<u32>,
    /// Where a disk begins in `disk_corners`; one more at the end. Disks are in the order of their nodes.
    pub(super) disk_start: Vec<u32>,
    /// The place of every corner in `disk_corners`.
    pub(super) place: Vec<u32>,
    /// Faces at edges with more than two faces and nodes with more than one fan: what one side cannot have.
    pub(super) joints: Vec<Vec<u32>>,
}

/// The face-use of a corner.
pub(super) fn use_of(corner: u32) -> u32 {
    corner / 3
}

/// The face of a corner.
pub(super) fn face_of(corner: u32) -> usize {
    (corner / 6) as usize
}

/// The next corner of the same face-use.
pub(super) fn next(corner: u32) -> u32 {
    if corner % 3 == 2 { corner - 2 } else { corner + 1 }
}

/// The corner before in the same face-use.
pub(super) fn previous(corner: u32) -> u32 {
    if corner.is_multiple_of(3) { corner + 2 } else { corner - 1 }
}

/// Which corner of the face (0, 1, 2) a corner of a face-use is: backs go the other way round.
pub(super) fn corner_of_face(corner: u32) -> usize {
    let i = corner % 3;
    (if use_of(corner).is_multiple_of(2) { i } else { (3 - i) % 3 }) as usize
}

impl Entities {
    /// Finds wedges by exact radial order, then disks. O(n log n).
    pub(super) fn new(sheet: &CleanSheet) -> Self {
        let corners = 6 * sheet.faces.len();
        let mut node = Vec::with_capacity(corners);
        for &[a, b, c] in &sheet.faces {
            node.extend([a, b, c, a, c, b]);
        }
        let mut entities = Self {
            node,
            mate: vec![0; corners],
            turn: vec![0.0; corners],
            disk_corners: Vec::with_capacity(corners),
            disk_start: vec![0],
            place: vec![u32::MAX; corners],
            joints: Vec::new(),
        };
        entities.pair_edge_uses(sheet);
        entities.walk_disks(sheet.positions.len());
        entities
    }

    /// Number of disks.
    pub(super) fn disks(&self) -> usize {
        self.disk_start.len() - 1
    }

    /// The corners of disk `d`.
    pub(super) fn disk(&self, d: usize) -> &[u32] {
        &self.disk_corners[self.disk_start[d] as usize..self.disk_start[d + 1] as usize]
    }

    /// Whether the wedge of an edge-use lies at an edge with one face only, between its own two sides.
    pub(super) fn is_sharp(&self, edge_use: u32) -> bool {
        use_of(self.mate[edge_use as usize]) == use_of(edge_use) ^ 1
    }

    /// The normal of the face-use of a corner, into the void.
    pub(super) fn normal(&self, sheet: &CleanSheet, corner: u32) -> DVec3 {
        let normal = sheet.normals[face_of(corner)];
        if use_of(corner).is_multiple_of(2) { normal } else { -normal }
    }

    /// The unit direction of an edge-use.
    pub(super) fn direction(&self, sheet: &CleanSheet, edge_use: u32) -> DVec3 {
        let [from, to] = [edge_use, next(edge_use)].map(|c| sheet.positions[self.node[c as usize] as usize]);
        (to - from).normalize_or_zero()
    }

    fn pair_edge_uses(&mut self, sheet: &CleanSheet) {
        // Sides of faces by their ends, smaller node first.
        let mut sides: Vec<(u64, u32)> = Vec::with_capacity(3 * sheet.faces.len());
        for (f, corners) in sheet.faces.iter().enumerate() {
            for k in 0..3 {
                let (v, w) = (corners[k], corners[(k + 1) % 3]);
                sides.push((u64::from(v.min(w)) << 32 | u64::from(v.max(w)), (3 * f + k) as u32));
            }
        }
        sides.sort_unstable();
        let (mut apexes, mut uses): (Vec<DVec3>, Vec<[u32; 2]>) = (Vec::new(), Vec::new());
        for fan in sides.chunk_by(|x, y| x.0 == y.0) {
            uses.clear();
            uses.extend(fan.iter().map(|&(_, side)| self.uses_of_side(side)));
            if fan.len() > 2 {
                let [a, b] = [(fan[0].0 >> 32) as usize, (fan[0].0 & 0xffff_ffff) as usize];
                apexes.clear();
                apexes.extend(fan.iter().map(|&(_, side)| {
                    let (f, k) = (side as usize / 3, side as usize % 3);
                    sheet.positions[sheet.faces[f][(k + 2) % 3] as usize]
                }));
                if let Some(order) = order_about_edge(sheet.positions[a], sheet.positions[b], &apexes) {
                    let unordered = uses.clone();
                    uses.clear();
                    uses.extend(order.into_iter().map(|i| unordered[i as usize]));
                }
                self.joints.push(fan.iter().map(|&(_, side)| side / 3).collect());
            }
            self.pair_fan(sheet, &uses);
        }
    }

    /// The two edge-uses of a side of a face: that of the face-use which looks anticlockwise about the edge from its
    /// smaller node to its larger (it runs that way too), and that of the other.
    fn uses_of_side(&self, side: u32) -> [u32; 2] {
        let (f, k) = (side / 3, side % 3);
        let front = 6 * f + k;
        let back = 6 * f + 3 + (2 - k);
        if self.node[front as usize] < self.node[next(front) as usize] {
            [front, back]
        } else {
            [back, front]
        }
    }

    /// Pairs the edge-uses of the faces about one edge, given anticlockwise.
    fn pair_fan(&mut self, sheet: &CleanSheet, uses: &[[u32; 2]]) {
        let axis = self.direction(sheet, uses[0][0]);
        let mut sum = 0.0;
        for (i, &[e, _]) in uses.iter().enumerate() {
            let m = uses[(i + 1) % uses.len()][1];
            self.mate[e as usize] = m;
            self.mate[m as usize] = e;
            let turn = if uses.len() == 1 {
                PI
            } else {
                let (from, to) = (self.normal(sheet, e), self.normal(sheet, m));
                axis.dot(from.cross(to)).atan2(from.dot(to))
            };
            self.turn[e as usize] = turn;
            sum += PI + turn;
        }
        // Faces on one another: all their wedges but one are empty, whatever side rounding puts them on.
        for &[e, _] in uses {
            if sum > TAU + 1.0 && self.turn[e as usize] > PI - FULL_TURN {
                self.turn[e as usize] = -PI;
                sum -= TAU;
            }
        }
        for &[e, _] in uses {
            self.turn[self.mate[e as usize] as usize] = self.turn[e as usize];
        }
    }

    fn walk_disks(&mut self, nodes: usize) {
        let mut start = vec![0u32; nodes + 1];
        for &v in &self.node {
            start[v as usize + 1] += 1;
        }
        for v in 0..nodes {
            start[v + 1] += start[v];
        }
        let mut at_node = vec![0u32; self.node.len()];
        let mut fill = start.clone();
        for (c, &v) in self.node.iter().enumerate() {
            at_node[fill[v as usize] as usize] = c as u32;
            fill[v as usize] += 1;
        }
        for v in 0..nodes {
            let corners = &at_node[start[v] as usize..start[v + 1] as usize];
            let first_disk = self.disk_start.len();
            let mut open_disks = 0;
            for &first in corners {
                if self.place[first as usize] != u32::MAX {
                    continue;
                }
                let mut corner = first;
                let mut sharp = false;
                loop {
                    self.place[corner as usize] = self.disk_corners.len() as u32;
                    self.disk_corners.push(corner);
                    let edge_use = previous(corner);
                    sharp |= use_of(self.mate[edge_use as usize]) == use_of(edge_use) ^ 1;
                    corner = self.mate[edge_use as usize];
                    if corner == first {
                        break;
                    }
                }
                open_disks += usize::from(sharp);
                self.disk_start.push(self.disk_corners.len() as u32);
            }
            // A two-manifold node has one disk at the boundary, two inside: one a side.
            let disks = self.disk_start.len() - first_disk;
            if disks > 2 || (open_disks > 0 && disks > 1) {
                self.joints.push(corners.iter().map(|c| c / 6).collect());
            }
        }
    }
}
