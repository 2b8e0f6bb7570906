//! Drawings in the plane: curves, and outlines made of them.
//!
//! * [`Curve`]: line, arc, Bézier curve, spline, each with points, tangents, curvatures and length;
//! * [`Outline`]: what a person draws, as data: a rectangle, a circle, a polygon, curves end to end;
//! * [`Path`]: curves end to end, checked, to be sampled to a tolerance.
//!
//! Lengths are millimetres, angles radians; where data name degrees, their fields say so.
//!
//! ```
//! use sketch::{Outline, Path};
//! use glam::DVec2;
//!
//! let circle = Outline::Circle { center: DVec2::ZERO, radius: 10.0 };
//! let path = Path::of(&circle)?;
//! assert!(path.closed && (path.length() - std::f64::consts::TAU * 10.0).abs() < 1e-9);
//! assert!(path.sampled(0.01).len() > 60);
//! # Ok::<(), sketch::SketchError>(())
//! ```

mod branches;
mod curve;
mod error;
mod outline;
mod path;

pub use branches::{Branch, order_of_branches};
pub use curve::{Curve, NearestPoint};
pub use error::SketchError;
pub use outline::Outline;
pub use path::{Path, PathPoint};
