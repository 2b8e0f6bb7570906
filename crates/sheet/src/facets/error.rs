//! Why the facets of a sheet could not be told.

use glam::DVec3;
use mesh_kernel::body::BuildError;

/// Why the facets of a sheet could not be told. Lengths are those of the sheet's coordinates.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FacetError {
    /// There is nothing to look at.
    #[error("the sheet has no faces with an area")]
    Empty,
    /// A coordinate is not a finite number.
    #[error("node {node} has a coordinate that is no finite number")]
    NotFinite {
        /// The node.
        node: u32,
    },
    /// A facet has one side only.
    #[error("facet {facet:?} has one side only (a Möbius strip, say), as is seen at ({:.3}, {:.3}, {:.3}); cut it into plane facets", at.x, at.y, at.z)]
    OneSided {
        /// Its name.
        facet: String,
        /// A node of the edge where its sides disagree.
        at: DVec3,
    },
    /// A facet is closed, has handles, or has three sheets at an edge of its own.
    #[error("facet {facet:?} is closed, has handles or meets itself at a line; cut it into plane facets")]
    NotAFacet {
        /// Its name.
        facet: String,
    },
    /// The kernel does not take the sheet.
    #[error(transparent)]
    Build(#[from] BuildError),
}
