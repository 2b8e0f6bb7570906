//! Why a sheet could not be thickened.

use glam::DVec3;
use mesh_kernel::merge::MergeError;

/// Why a sheet could not be thickened. Lengths are millimetres; patches are groups of the sheet, counted from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ThickenError {
    /// There is nothing to thicken.
    #[error("the sheet has no faces with an area")]
    Empty,
    /// A coordinate is not a finite number.
    #[error("node {node} has a coordinate that is no finite number")]
    NotFinite {
        /// The node.
        node: u32,
    },
    /// A thickness that nothing can have.
    #[error("a thickness is {value} mm, but must be a finite number above 0")]
    ThicknessNotPositive {
        /// The thickness.
        value: f64,
        /// The patch or the node that it was given for; `None`: all of the sheet.
        index: Option<usize>,
    },
    /// The sheet would be lost in its thickness.
    #[error(
        "a thickness of {value} mm is more than {} times the size of the sheet, {size} mm",
        super::MAX_THICKNESS
    )]
    ThicknessTooLarge {
        /// The thickness.
        value: f64,
        /// The sheet's diagonal.
        size: f64,
    },
    /// A wall would be lost in the rounding of the coordinates.
    #[error(
        "a thickness of {value} mm is too small for the coordinates of the sheet: by its size and how far from the origin \
         it lies, walls must be {least:.1e} mm thick at least; thicken more, or move the sheet nearer to the origin"
    )]
    ThicknessTooSmall {
        /// The thickness.
        value: f64,
        /// What it must be at least.
        least: f64,
        /// The first patch that is so thin.
        patch: u32,
    },
    /// Another number of thicknesses than of patches or nodes.
    #[error("{given} thicknesses are given for {expected} {of}")]
    ThicknessCount {
        /// `"patches"` or `"nodes"`.
        of: &'static str,
        /// How many there are.
        expected: usize,
        /// How many thicknesses came.
        given: usize,
    },
    /// An option is out of its range.
    #[error("the option {option} is {value}, but must be a finite number above {above}")]
    OptionRange {
        /// Its name.
        option: &'static str,
        /// What it was.
        value: f64,
        /// What it must be more than.
        above: f64,
    },
    /// One side was asked for, but more than two faces meet, or fans of faces meet in one node only.
    #[error("one side of the sheet is not clear at ({:.3}, {:.3}, {:.3}): {} faces meet there; thicken both sides",
        at.x, at.y, at.z, faces)]
    NonManifold {
        /// The patches that meet, ascending.
        patches: Vec<u32>,
        /// The middle of the edge, or the node.
        at: DVec3,
        /// How many faces meet.
        faces: usize,
    },
    /// One side was asked for, but the sheet has only one.
    #[error(
        "the sheet has one side only (a Möbius strip, say), as is seen at ({:.3}, {:.3}, {:.3}); thicken both sides",
        at.x, at.y, at.z
    )]
    NotOrientable {
        /// The patches at the place, ascending.
        patches: Vec<u32>,
        /// The middle of an edge where the sides disagree.
        at: DVec3,
    },
    /// The caller ended it.
    #[error("cancelled")]
    Cancelled,
    /// The offsets could not be united.
    #[error(transparent)]
    Merge(MergeError),
}

impl From<MergeError> for ThickenError {
    fn from(error: MergeError) -> Self {
        match error {
            MergeError::Cancelled => Self::Cancelled,
            other => Self::Merge(other),
        }
    }
}
