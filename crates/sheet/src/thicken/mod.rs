//! Thickening: a sheet, manifold or not, becomes a clean solid (Lee & Kim 2001, sections 4–6).

mod arcs;
mod chain;
mod clean_sheet;
mod disks;
mod entities;
mod error;
mod half_prism;
mod offset_point;
mod offsets;
mod options;
mod orientation;
mod polar_polygon;
mod report;
mod runs;
mod sphere_patch;
mod wedges;

pub use chain::{OffsetChain, offset_chain};
pub use error::ThickenError;
pub use options::{Corners, Side, ThickenOptions, Thickness};
pub use report::{Origin, Place, PlaceKind, Purged, Role, ThickenReport};

use mesh_kernel::TriMesh;

/// A thickness of more than this many times the sheet's diagonal is refused.
pub const MAX_THICKNESS: f64 = 10.0;

/// A thickened sheet.
#[derive(Clone, Debug)]
pub struct Thickened {
    /// The solid: closed, oriented outward, two-manifold, without self-intersections. Groups are the roles.
    pub solid: TriMesh,
    /// What each face came from.
    pub origins: Vec<Origin>,
    /// Counts, measures, and the places that deserve a look.
    pub report: ThickenReport,
}

/// Steps of the work, for progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Face-uses, wedges and disks are found.
    Entities,
    /// Their offsets are made.
    Offsets,
    /// The offsets are united.
    Union,
    /// What is not on the boundary is purged.
    Purge,
    /// The solid is measured.
    Measure,
}

/// Who is told of the progress, and may end the work.
pub trait Watcher: Sync {
    /// A step begins.
    fn step(&self, _step: Step) {}
    /// `true` ends the work with [`ThickenError::Cancelled`].
    fn cancelled(&self) -> bool {
        false
    }
}

/// Nobody watches.
#[derive(Clone, Copy, Debug)]
pub struct Nobody;
impl Watcher for Nobody {}

/// Thickens a sheet; its groups are its patches.
pub fn thicken(
    sheet: &TriMesh,
    options: &ThickenOptions,
    watcher: &dyn Watcher,
) -> Result<Thickened, ThickenError> {
    let _ = (sheet, options, watcher);
    Err(ThickenError::Empty)
}
