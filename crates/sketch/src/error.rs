//! What can be wrong with a drawing.

use glam::DVec2;

/// What is wrong with a drawing. Lengths in millimetres.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SketchError {
    /// A number is not finite, or is out of range.
    #[error("{what} must be {wanted}")]
    Number {
        /// Which.
        what: &'static str,
        /// What it may be.
        wanted: &'static str,
    },
    /// Too few points.
    #[error("{what} needs {wanted} points at least, not {given}")]
    TooFewPoints {
        /// What they make.
        what: &'static str,
        /// How many it needs.
        wanted: usize,
        /// How many came.
        given: usize,
    },
    /// Three points on one line have no arc through them.
    #[error("no arc goes through three points on one line")]
    NoArc,
    /// A curve does not begin where the one before ends.
    #[error("curve {curve} begins at ({:.3}, {:.3}), but the one before ends at ({:.3}, {:.3})", .begins.x, .begins.y, .ends.x, .ends.y)]
    Gap {
        /// Its number, from 1.
        curve: usize,
        /// Where it begins.
        begins: DVec2,
        /// Where the one before ends.
        ends: DVec2,
    },
    /// A curve has no length.
    #[error("curve {curve} has no length")]
    NoLength {
        /// Its number, from 1.
        curve: usize,
    },
    /// An outline must be closed.
    #[error("the outline is open: it begins at ({:.3}, {:.3}) and ends at ({:.3}, {:.3})", .begins.x, .begins.y, .ends.x, .ends.y)]
    Open {
        /// Where it begins.
        begins: DVec2,
        /// Where it ends.
        ends: DVec2,
    },
    /// The outline crosses or touches itself.
    #[error("the outline crosses or touches itself near ({:.3}, {:.3})", .at.x, .at.y)]
    Crosses {
        /// About where.
        at: DVec2,
    },
    /// A corner cannot be rounded so much.
    #[error("the corner at ({:.3}, {:.3}) cannot be rounded by {radius}: its sides are too short", .at.x, .at.y)]
    RoundTooLarge {
        /// The corner.
        at: DVec2,
        /// The radius.
        radius: f64,
    },
    /// More points than allowed.
    #[error("the drawing has more than {most} points: take a larger tolerance")]
    TooFine {
        /// How many are allowed.
        most: usize,
    },
    /// Branches cannot be ordered.
    #[error("branches {0} and {1} leave in one direction with one curvature")]
    SameBranch(usize, usize),
}
