//! What can be wrong with a mesh that should be a human body.

use thiserror::Error;

use super::Unit;

/// Why a mesh was refused.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum HumanError {
    /// There are no triangles.
    #[error("the body mesh is empty: it has no triangles; export the body as a triangle mesh")]
    Empty,
    /// A position is not a number or is infinite.
    #[error("node {node} of the body mesh has a coordinate that is not a finite number; repair the file")]
    NotFinite {
        /// The offending node, counted from 0.
        node: u32,
    },
    /// A face names a node that does not exist.
    #[error("triangle {face} of the body mesh names a node that does not exist; the file is damaged")]
    BadIndex {
        /// The offending face, counted from 0.
        face: u32,
    },
    /// Too coarse to carry features.
    #[error("the body mesh has {faces} usable triangles; features need at least {needed}")]
    TooCoarse {
        /// Triangles that have an area.
        faces: usize,
        /// The least number.
        needed: usize,
    },
    /// All nodes lie in a plane or on a line.
    #[error(
        "the body mesh is flat: it measures {thin:.3} across where it is thinnest and {long:.3} where it is longest \
         (file units)"
    )]
    Flat {
        /// Smallest extent, file units.
        thin: f64,
        /// Largest extent, file units.
        long: f64,
    },
    /// No unit makes a person of the mesh's height.
    #[error(
        "the mesh is {height:.4} units high: in metres, centimetres or millimetres that is no person's height (0.5 m to \
         2.5 m); say its unit, or scale it to one of these"
    )]
    Height {
        /// Extent along the body's axis, file units.
        height: f64,
    },
    /// The unit that was said makes no person of it.
    #[error(
        "the mesh is {height:.4} {} high, {:.2} m: that is no person's height (0.5 m to 2.5 m); its unit is another one",
        .unit.plural(),
        .height * .unit.millimetres() / 1000.0
    )]
    HeightInUnit {
        /// Extent along the body's axis, in that unit.
        height: f64,
        /// The unit.
        unit: Unit,
    },
    /// The shape is not that of an upright person or dress form.
    #[error("the mesh is not an upright human body or dress form: {reason}")]
    NotUpright {
        /// What is missing, in words.
        reason: String,
    },
    /// The two halves of the mesh do not mirror each other about any upright plane.
    #[error(
        "the mesh has no left and right half that mirror each other (they differ by {residual:.0} mm); a body must stand \
         upright with both sides alike"
    )]
    NotSymmetric {
        /// Typical distance between one half and the mirrored other, millimetres.
        residual: f64,
    },
}
