//! Why a sheet could not be thickened.

use mesh_kernel::merge::MergeError;

/// Why a sheet could not be thickened.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ThickenError {
    /// There is nothing to thicken.
    #[error("the sheet has no faces with an area")]
    Empty,
    /// The caller ended it.
    #[error("cancelled")]
    Cancelled,
    /// The offsets could not be united.
    #[error(transparent)]
    Merge(#[from] MergeError),
}
