//! Why models could not be merged.

/// Why models could not be merged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MergeError {
    /// A coordinate is not a finite number.
    #[error("face {face} has a coordinate that is no finite number")]
    NotFinite {
        /// The face.
        face: u32,
    },
    /// The caller ended it.
    #[error("cancelled")]
    Cancelled,
}
