//! An indexed triangle mesh without any claim of being a manifold: what files hold, what queries run on.

use glam::{DVec2, DVec3};

/// Coordinates beyond this, in whatever unit, are those of a broken file: no model is a thousand kilometres wide, and their
/// squares and cubes would soon be no numbers.
pub const MAX_COORDINATE: f64 = 1e9;

/// A named run of faces of a [`TriMesh`]: an OBJ group, one surface of a body.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// Name as the file or the template gives it.
    pub name: String,
    /// First face and one past the last; groups are disjoint and ordered.
    pub faces: std::ops::Range<u32>,
}

/// Triangles over shared positions.
///
/// Invariant: every index of `faces` is below `positions.len()`. Faces may be open, non-manifold or
/// degenerate; who needs more asks the checks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriMesh {
    /// Node positions, in millimetres.
    pub positions: Vec<DVec3>,
    /// Three node indices a face, anticlockwise seen from outside.
    pub faces: Vec<[u32; 3]>,
    /// Groups, ordered by their faces. Empty: one nameless group.
    pub groups: Vec<Group>,
    /// The flat pattern's position of every corner (same order as `faces`), in millimetres, where known.
    pub corner_uvs: Option<Vec<[DVec2; 3]>>,
}

impl TriMesh {
    /// A mesh without groups or flat pattern.
    pub fn new(positions: Vec<DVec3>, faces: Vec<[u32; 3]>) -> Self {
        Self { positions, faces, ..Self::default() }
    }

    /// The three corners of face `f`.
    #[inline]
    pub fn corners(&self, f: u32) -> [DVec3; 3] {
        self.faces[f as usize].map(|v| self.positions[v as usize])
    }

    /// Twice-area-scaled normal of face `f` (cross product of two sides; zero when degenerate), in mm².
    #[inline]
    pub fn area_normal(&self, f: u32) -> DVec3 {
        let [a, b, c] = self.corners(f);
        (b - a).cross(c - a)
    }

    /// Smallest and largest coordinates over all positions; `None` without positions.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        let first = *self.positions.first()?;
        Some(self.positions.iter().fold([first, first], |[lo, hi], p| [lo.min(*p), hi.max(*p)]))
    }

    /// Unit node normals, weighted by face area; zero where no face or only degenerate faces meet. O(n).
    pub fn node_normals(&self) -> Vec<DVec3> {
        let mut normals = vec![DVec3::ZERO; self.positions.len()];
        for f in 0..self.faces.len() as u32 {
            let n = self.area_normal(f);
            for v in self.faces[f as usize] {
                normals[v as usize] += n;
            }
        }
        normals.into_iter().map(DVec3::normalize_or_zero).collect()
    }
}
