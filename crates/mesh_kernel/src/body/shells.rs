//! Shells: the sides of faces, joined round the edges in radial order, and what they enclose.
//!
//! Every face has two sides. About an edge, the side of a sheet that looks onwards in the radial order and the side of
//! the next sheet that looks back bound the same sector, so they belong to one shell. In sheets connected through
//! edges, shells and the regions of space that they bound correspond one to one: sheets that meet at nodes only can be
//! pulled apart there without changing either. All regions but the one outside are voids. So the radial order alone
//! tells the voids; orders that contradict each other, or sheets that pass through each other, give another number
//! than homology does.

use glam::DVec3;

use super::Body;
use super::weld::UnionFind;
use super::welded::{FaceUse, Welded};

/// Sides of faces by shell, and shells by connected sheets.
pub(crate) struct Shells {
    /// Shell of side `2f` (the face's normal looks there) and `2f + 1`.
    pub(crate) of_side: Vec<u32>,
    pub(crate) count: usize,
    /// Connected sheets of every face: connected through edges.
    pub(crate) sheet_of_face: Vec<u32>,
    pub(crate) sheets: usize,
}

/// The side of a use that looks onwards in the radial order, and the one that looks back.
pub(crate) fn onwards(u: FaceUse) -> [u32; 2] {
    // A face that runs along the axis has its normal onwards (right hand).
    let normal = 2 * u.face;
    if u.along { [normal, normal + 1] } else { [normal + 1, normal] }
}

impl Shells {
    /// O(faces).
    pub(crate) fn new(complex: &Welded) -> Self {
        let faces = complex.face_count() as usize;
        let mut sides = UnionFind::new(2 * faces);
        let mut sheets = UnionFind::new(faces);
        for e in 0..complex.edges.len() {
            let uses = complex.uses(e);
            for (u, next) in uses.clone().zip(uses.clone().cycle().skip(1)) {
                sides.union(onwards(u)[0], onwards(next)[1]);
                sheets.union(u.face, next.face);
            }
        }
        let (of_side, count) = sides.number();
        let (sheet_of_face, sheets) = sheets.number();
        Self { of_side, count, sheet_of_face, sheets }
    }

    /// Number of voids.
    pub(crate) fn voids(&self) -> usize {
        self.count - self.sheets
    }

    /// For every connected sheets the shell that looks outside: the one with the least volume.
    pub(crate) fn outer(&self, volumes: &[f64]) -> Vec<usize> {
        let mut outer: Vec<Option<usize>> = vec![None; self.sheets];
        for (side, &shell) in self.of_side.iter().enumerate() {
            let there = &mut outer[self.sheet_of_face[side / 2] as usize];
            let shell = shell as usize;
            if there.is_none_or(|s| volumes[shell] < volumes[s]) {
                *there = Some(shell);
            }
        }
        outer.into_iter().flatten().collect()
    }

    /// Volume that each shell encloses, in mm³: positive for voids, negative for the shell that looks outside.
    pub(crate) fn volumes(&self, body: &Body) -> Vec<f64> {
        let mut volumes = vec![0.0; self.count];
        // Seen from a point near the body, so that volumes far from the origin lose no digits.
        let origin = body.surfaces.iter().find_map(|s| s.positions.first()).copied().unwrap_or(DVec3::ZERO);
        let mut f = 0;
        for s in &body.surfaces {
            for face in s.live_faces() {
                let [a, b, c] = s.corners(face).map(|p| p - origin);
                let cone = a.dot(b.cross(c)) / 6.0;
                // The face's normal looks into the region of side 2f.
                volumes[self.of_side[2 * f] as usize] -= cone;
                volumes[self.of_side[2 * f + 1] as usize] += cone;
                f += 1;
            }
        }
        volumes
    }
}
