//! Drawings: curves in the plane and outlines made of them; strokes on a screen that become profiles in space.
//!
//! * [`Camera`]: places to pixels and back; [`Stroke`], [`Stabiliser`]: what a hand draws, made steady;
//! * [`pick_edges`]: which template edges a stroke means; [`fitted_plane`], [`bisecting_plane`], [`profiles`]: what it makes of
//!   them (Wang et al., feature templates, section 4.1.4); [`redrawn`]: a part of a curve drawn again;
//! * [`Curve`]: line, arc, Bézier curve, spline, each with points, tangents, curvatures and length;
//! * [`Outline`]: what a person draws, as data: a rectangle, a circle, a polygon, curves end to end;
//! * [`Path`]: curves end to end, checked, to be sampled to a tolerance;
//! * [`Drawing`]: shapes that share points, edited: moved, bent, split, merged, trimmed, rounded; [`Rule`]s that stay true;
//!   [`Snap`]: what the pointer means.
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
mod camera;
mod curve;
mod drawing;
mod error;
mod outline;
mod path;
mod pick;
mod profile;
mod redraw;
mod stroke;

pub use branches::{Branch, order_of_branches};
pub use camera::{Camera, Plane, Projection, Ray};
pub use curve::{Curve, NearestPoint};
pub use drawing::{
    Crossing, Drawing, DrawingError, PointId, Rule, Shape, ShapeId, Snap, SnapKind, SnapOptions, crossings,
};
pub use error::SketchError;
pub use outline::Outline;
pub use path::{Path, PathPoint, polygon_holds};
pub use pick::{Clear, PICK_DISTANCE, PickOptions, PickedEdge, Sight, SpaceEdge, pick_edges};
pub use profile::{DrawnProfile, ProfileOptions, bisecting_plane, fitted_plane, profiles};
pub use redraw::{DrawnOver, drawn_over, redrawn};
pub use stroke::{Stabiliser, Stroke};
