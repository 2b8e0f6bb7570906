//! Why a sheet could not be unfolded.

use crate::facets::FacetError;

/// Why a sheet could not be unfolded. Lengths in millimetres.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UnfoldError {
    /// Facets could not be told.
    #[error(transparent)]
    Facets(#[from] FacetError),
    /// An option is out of its range.
    #[error("the {option} is {value}, but must be {wanted}")]
    Option {
        /// Its name.
        option: &'static str,
        /// What it was.
        value: f64,
        /// What it may be.
        wanted: &'static str,
    },
    /// A facet is curved.
    #[error("facet {facet:?} is not plane; only plane facets unfold exactly")]
    Curved {
        /// Its name.
        facet: String,
    },
    /// A facet is so small that its bends leave nothing of it.
    #[error(
        "facet {facet:?} is too small for its bends: they take {setback:.3} mm of it and leave nothing of an edge that is \
         {length:.3} mm long; take a smaller radius or thickness"
    )]
    TooSmall {
        /// Its name.
        facet: String,
        /// The largest setback in it.
        setback: f64,
        /// Length of the edge that is lost.
        length: f64,
    },
}
