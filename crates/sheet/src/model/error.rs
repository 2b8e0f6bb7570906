//! Why a modelling command was refused. Nothing is changed then.

use glam::DVec3;
use mesh_kernel::body::BuildError;
use mesh_kernel::complex::Refusal;
use mesh_kernel::merge::MergeError;
use sketch::SketchError;

use crate::facets::FacetError;

fn place(p: &DVec3) -> String {
    format!("({:.3}, {:.3}, {:.3})", p.x, p.y, p.z)
}

/// Why a modelling command was refused. Lengths in millimetres.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// The drawing is wrong.
    #[error(transparent)]
    Sketch(#[from] SketchError),
    /// The kernel refuses an operator.
    #[error(transparent)]
    Kernel(#[from] Refusal),
    /// A number is not finite, or out of range.
    #[error("{what} must be {wanted}")]
    Number {
        /// Which.
        what: &'static str,
        /// What it may be.
        wanted: &'static str,
    },
    /// The axes of a plane do not span it.
    #[error("the axes of the plane are parallel or have no length")]
    NoPlane,
    /// The drawing has more points than a model is made of.
    #[error("the drawing has {points} points, more than {most}: take a larger tolerance")]
    TooFine {
        /// Its points.
        points: usize,
        /// How many are allowed.
        most: usize,
    },
    /// No such wire.
    #[error("there is no wire {name:?}")]
    NoWire {
        /// What was asked for.
        name: String,
    },
    /// No such patch.
    #[error("there is no patch {name:?}; there are {}", if .known.is_empty() { "none".to_owned() } else { .known.join(", ") })]
    NoPatch {
        /// What was asked for.
        name: String,
        /// All names.
        known: Vec<String>,
    },
    /// The name is taken.
    #[error("the name {name:?} is taken")]
    NameTaken {
        /// The name.
        name: String,
    },
    /// No edges from one point to another.
    #[error("no edge leads from {} to {}", place(.from), place(.to))]
    NoEdge {
        /// Where it should begin.
        from: DVec3,
        /// Where it should end.
        to: DVec3,
    },
    /// No vertex at a point.
    #[error("there is no vertex at {}", place(.at))]
    NoVertex {
        /// The point.
        at: DVec3,
    },
    /// An outline does not lie in a face.
    #[error("the outline leaves the face: {} is not inside patch {patch:?}", place(.at))]
    LeavesFace {
        /// The patch.
        patch: String,
        /// A point outside, or on the border.
        at: DVec3,
    },
    /// An edge along the direction of extrusion ends the wire (Stroud & Nagy, fig. 6.18, left).
    #[error(
        "the wire's edge from {} to {} lies along the extrusion and ends there: it would leave a dangling edge", place(.from), place(.to)
    )]
    Dangling {
        /// The edge's end that hangs on the wire.
        from: DVec3,
        /// The end that would dangle.
        to: DVec3,
    },
    /// An edge along the direction of extrusion is as long as that, or longer: a wire edge stays between two sheets, or parts
    /// degenerate (fig. 6.18, right).
    #[error(
        "the wire's edge from {} to {} lies along the extrusion and is {length:.3} mm long, not less than its {distance:.3} mm: \
         say whether to \"keep\" it as a wire between two sheets or to \"drop\" it", place(.from), place(.to)
    )]
    AmbiguousAlong {
        /// One end.
        from: DVec3,
        /// The other.
        to: DVec3,
        /// Its length.
        length: f64,
        /// How far is extruded.
        distance: f64,
    },
    /// All of the wire lies along the direction of extrusion.
    #[error("nothing of the wire lies across the extrusion")]
    NothingAcross,
    /// Branches cannot be told apart, or not as finely as curves are sampled.
    #[error("the branches at {} cannot be ordered: {why}", place(.at))]
    Branches {
        /// The branching point.
        at: DVec3,
        /// What is wrong.
        why: String,
    },
    /// A sweep turns into itself.
    #[error("the path turns so sharply at {} that the sweep would run into itself", place(.at))]
    TurnsTooSharply {
        /// A corner of the path.
        at: DVec3,
    },
    /// Caps need one closed outline.
    #[error("only a single closed outline can be capped")]
    NotCapped,
    /// Bending would tear the sheet.
    #[error("the parts on both sides of the bend hang together elsewhere too, at {}: bending would tear them", place(.at))]
    Tears {
        /// Where.
        at: DVec3,
    },
    /// An edge has not two faces.
    #[error("the edge from {} to {} has {faces} faces, not two", place(.from), place(.to))]
    NotAFold {
        /// One end.
        from: DVec3,
        /// The other.
        to: DVec3,
        /// How many.
        faces: usize,
    },
    /// An edge between faces in one plane has nothing to round.
    #[error("the faces at the edge from {} to {} lie in one plane or on each other", place(.from), place(.to))]
    NoAngle {
        /// One end.
        from: DVec3,
        /// The other.
        to: DVec3,
    },
    /// Rounding would take more than there is.
    #[error("the edge at {} is too short: rounding takes {takes:.3} mm of its {length:.3} mm", place(.at))]
    TooShort {
        /// Where.
        at: DVec3,
        /// How much is taken.
        takes: f64,
        /// How much there is.
        length: f64,
    },
    /// Other faces meet at the end of an edge, so that it cannot be replaced alone.
    #[error("more faces meet at {} than the edge's own and one across its end", place(.at))]
    CornerShared {
        /// The vertex.
        at: DVec3,
    },
    /// Sheets have no edges or corners in common.
    #[error("the sheets have no edges or corners in one place")]
    NothingToJoin,
    /// Sheets touch where their edges do not match (Stroud & Nagy, fig. 6.22).
    #[error("edges do not match at {}: join with \"split\": true to cut the sheets there", place(.at))]
    EdgesDoNotMatch {
        /// A place where a corner of one lies inside an edge or face of another.
        at: DVec3,
    },
    /// A mixture of sheet and solid (fig. 6.23b).
    #[error(
        "patch {patch:?} is a sheet: with a solid added it would be part sheet, part solid; make it partial first"
    )]
    Mixed {
        /// The sheet.
        patch: String,
    },
    /// The operation goes beyond the boundary of a partial model.
    #[error("the solid goes beyond the boundary of the partial model")]
    BeyondPartial,
    /// A partial model must have one front.
    #[error("patch {patch:?} cannot be partial: {why}")]
    NotPartial {
        /// The patch.
        patch: String,
        /// Why.
        why: &'static str,
    },
    /// A solid must be closed.
    #[error("patch {patch:?} is not closed: it is no solid")]
    NotSolid {
        /// The patch.
        patch: String,
    },
    /// There is nothing to undo or redo.
    #[error("there is nothing to {0}")]
    Nothing(&'static str),
    /// Facets could not be told.
    #[error(transparent)]
    Facets(#[from] FacetError),
    /// Faces could not be merged.
    #[error(transparent)]
    Merge(#[from] MergeError),
    /// The kernel does not take the model.
    #[error(transparent)]
    Build(#[from] BuildError),
}
