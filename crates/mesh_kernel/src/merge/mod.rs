//! The non-manifold merge: any triangle models become one complex in which faces meet in shared nodes and edges only.
//!
//! It is the *merge and selection* of non-manifold Booleans (Lee & Kim 2001, section 5.3): [`merge`] unites,
//! [`Merged::regions`] tells which parts of space the faces bound and how often each model winds about them, and
//! [`Merged::select`] keeps the boundary of the wanted ones. One machine serves unions, thickening, imprints and joins.
//!
//! Models may be open, non-manifold, overlap in planes, cross themselves and each other. Coordinates are rounded to a
//! [grid](MAX_GRID_BITS) of about 10⁻¹² of the size of the models; on it all decisions are exact, and the result is on
//! it, so that handing it out moves nothing.
//!
//! ```
//! use mesh_kernel::TriMesh;
//! use mesh_kernel::glam::DVec3;
//! use mesh_kernel::merge::{Boolean, MergeOptions, boolean};
//!
//! let corners = [DVec3::ZERO, DVec3::X * 10.0, DVec3::Y * 10.0, DVec3::Z * 10.0];
//! let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let one = TriMesh::new(corners.to_vec(), faces.clone());
//! let other = TriMesh::new(corners.map(|p| p + DVec3::splat(1.0)).to_vec(), faces);
//! let union = boolean(&[&one, &other], Boolean::Union, &MergeOptions::default())?;
//! let common = boolean(&[&one, &other], Boolean::Intersection, &MergeOptions::default())?;
//! let volume = |t: f64| t.powi(3) / 6.0;
//! assert!((common.volume() - volume(7.0)).abs() < 1e-9);
//! assert!((union.volume() - (2.0 * volume(10.0) - volume(7.0))).abs() < 1e-9);
//! # Ok::<(), mesh_kernel::merge::MergeError>(())
//! ```

mod box_tree;
mod complex;
mod curves;
mod cut_face;
mod edge_uses;
mod error;
mod exact;
mod grid;
mod inspect;
mod marks;
mod meeting;
mod regions;
mod round;
mod rounds;
mod seen_face;
mod select;
mod touching;
mod windings;

use glam::DVec3;

use crate::TriMesh;
use complex::Complex;
use grid::Grid;

pub use error::MergeError;
pub use grid::MAX_GRID_BITS;
pub use regions::Regions;
pub use select::{Purged, Solid};

/// How a merge is done.
#[derive(Clone, Copy)]
pub struct MergeOptions<'a> {
    /// Bits of the grid over half the size of the models, at most [`MAX_GRID_BITS`].
    pub grid_bits: u32,
    /// Asked now and then, from any thread; `true` ends the work with [`MergeError::Cancelled`].
    pub cancelled: &'a (dyn Fn() -> bool + Sync),
}

impl Default for MergeOptions<'_> {
    fn default() -> Self {
        Self { grid_bits: MAX_GRID_BITS, cancelled: &|| false }
    }
}

/// A face of an input that a merged face is part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Parent {
    /// Its number, counted through all models.
    pub face: u32,
    /// Whether the merged face is wound the other way round.
    pub reversed: bool,
}

/// Models made one.
#[derive(Clone, Debug)]
pub struct Merged {
    /// Nodes, in the models' unit; no two in one place.
    pub positions: Vec<DVec3>,
    /// Faces: no two on the same nodes, none without area; two that have a point in common have it in a node or an edge
    /// of both.
    pub faces: Vec<[u32; 3]>,
    /// Number of the first face of every model, counted through all, and that behind the last.
    pub first_faces: Vec<u32>,
    /// Rounds of cutting that it took.
    pub rounds: u32,
    /// The nodes on the grid.
    nodes: Vec<DVec3>,
    grid: Grid,
    /// Parents of all faces, in a row, and where those of every face begin.
    parents: Vec<Parent>,
    first_parents: Vec<u32>,
}

impl Merged {
    /// The input faces that a face is part of, ascending; several where faces coincide.
    pub fn parents(&self, face: u32) -> &[Parent] {
        let f = face as usize;
        &self.parents[self.first_parents[f] as usize..self.first_parents[f + 1] as usize]
    }

    /// The model that an input face belongs to.
    pub fn model_of(&self, input_face: u32) -> u32 {
        self.first_faces.partition_point(|&first| first <= input_face) as u32 - 1
    }

    /// How many models there were.
    pub fn models(&self) -> usize {
        self.first_faces.len() - 1
    }
}

/// Merges models into one complex. O(n log n) in faces, plus what crosses.
///
/// Faces that the grid makes a point or a segment are left out. Faces that coincide become one, with all of them for
/// parents.
///
/// # Errors
/// [`MergeError`]: coordinates that are no numbers, faces that name missing nodes, a cancelled call.
pub fn merge(models: &[&TriMesh], options: &MergeOptions<'_>) -> Result<Merged, MergeError> {
    let grid = grid_over(models, options)?;
    merge_on(models, grid, false, options)
}

/// Merges on a given grid; with `cancel`, faces that coincide and are wound opposite undo each other.
fn merge_on(
    models: &[&TriMesh],
    grid: Grid,
    cancel: bool,
    options: &MergeOptions<'_>,
) -> Result<Merged, MergeError> {
    let mut first_faces = vec![0];
    let mut faces: Vec<[u32; 3]> = Vec::with_capacity(models.iter().map(|m| m.faces.len()).sum());
    let mut positions: Vec<DVec3> = Vec::with_capacity(models.iter().map(|m| m.positions.len()).sum());
    for model in models {
        let first = positions.len() as u32;
        positions.extend(model.positions.iter().map(|p| grid.snap(*p)));
        faces.extend(model.faces.iter().map(|f| f.map(|v| v + first)));
        first_faces.push(faces.len() as u32);
    }
    let complex = || Complex::new(positions.iter().copied(), &faces, cancel);
    let (complex, effort) = rounds::resolve(complex, &grid, options.cancelled)?;
    Ok(finished(&complex, grid, first_faces, effort.rounds))
}

/// What is left of the complex, nodes and faces numbered anew.
fn finished(complex: &Complex, grid: Grid, first_faces: Vec<u32>, rounds: u32) -> Merged {
    let mut number = vec![u32::MAX; complex.at.len()];
    let mut nodes = Vec::new();
    let (mut faces, mut parents, mut first_parents) = (Vec::new(), Vec::new(), vec![0]);
    for f in complex.present() {
        faces.push(complex.faces[f as usize].nodes.map(|v| {
            let number = &mut number[v as usize];
            if *number == u32::MAX {
                *number = nodes.len() as u32;
                nodes.push(complex.at[v as usize]);
            }
            *number
        }));
        complex.parents(f, &mut parents);
        first_parents.push(parents.len() as u32);
    }
    let positions = nodes.iter().map(|p| grid.place(*p)).collect();
    Merged { positions, faces, first_faces, rounds, nodes, grid, parents, first_parents }
}

/// The grid for some models, whose numbers are looked through on the way.
fn grid_over(models: &[&TriMesh], options: &MergeOptions<'_>) -> Result<Grid, MergeError> {
    let mut bounds: Option<[DVec3; 2]> = None;
    let mut first = 0;
    for model in models {
        for (face, corners) in (first..).zip(&model.faces) {
            for &node in corners {
                let nodes = model.positions.len();
                let p = model.positions.get(node as usize);
                let p = *p.ok_or(MergeError::NodeOutOfRange { face, node, nodes })?;
                if !(p.is_finite() && p.abs().max_element() < LARGEST) {
                    return Err(MergeError::NotFinite { face });
                }
                bounds = Some(bounds.map_or([p, p], |[lo, hi]| [lo.min(p), hi.max(p)]));
            }
        }
        first += model.faces.len() as u32;
    }
    let [lo, hi] = bounds.unwrap_or_default();
    Ok(Grid::over(lo, hi, options.grid_bits.clamp(8, MAX_GRID_BITS)))
}

/// Coordinates beyond this are no lengths of anything.
const LARGEST: f64 = 1e100;

/// Which of the space that closed models enclose is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boolean {
    /// What is inside any of them.
    Union,
    /// What is inside all of them.
    Intersection,
    /// What is inside the first and in no other.
    Difference,
}

/// A Boolean operation on closed models; a point is inside a model that winds about it at least once. O(n log n) in
/// faces, plus what crosses.
///
/// # Errors
/// As [`merge`]; [`MergeError::Open`] where a model is not closed.
pub fn boolean(
    models: &[&TriMesh],
    operation: Boolean,
    options: &MergeOptions<'_>,
) -> Result<Solid, MergeError> {
    let merged = merge(models, options)?;
    let regions = merged.regions()?;
    let inside = |w: &i32| *w > 0;
    merged.select(
        &regions,
        |w| match operation {
            Boolean::Union => w.iter().any(inside),
            Boolean::Intersection => w.iter().all(inside),
            Boolean::Difference => w.first().is_some_and(inside) && !w[1..].iter().any(inside),
        },
        options,
    )
}

/// The solid that a closed chain of oriented faces winds about at least once: what the boundaries of many pieces that
/// overlap, added up, enclose. O(n log n) in faces, plus what crosses.
///
/// # Errors
/// As [`boolean`].
pub fn solid_of_chain(chain: &TriMesh, options: &MergeOptions<'_>) -> Result<Solid, MergeError> {
    let grid = grid_over(&[chain], options)?;
    solid_on(chain, grid, options)
}

/// The same for a solid whose coordinates, multiplied by `scale`, are to be single-precision numbers: for files that
/// hold no others, where rounding alone might make faces cross.
///
/// # Errors
/// As [`boolean`].
pub fn snapped_to_singles(
    solid: &TriMesh,
    scale: f64,
    options: &MergeOptions<'_>,
) -> Result<Solid, MergeError> {
    grid_over(&[solid], options)?;
    let mut scaled = solid.clone();
    scaled.positions.iter_mut().for_each(|p| *p *= scale);
    let farthest = scaled.positions.iter().fold(0.0f64, |m, p| m.max(p.abs().max_element()));
    let mut snapped = solid_on(&scaled, Grid::about_zero(farthest, f32::MANTISSA_DIGITS), options)?;
    snapped.mesh.positions.iter_mut().for_each(|p| *p /= scale);
    Ok(snapped)
}

/// What is thinner than this is taken for what rounding leaves between walls, and is not in any result: the models' unit,
/// by their size and how far from the origin they are.
///
/// # Errors
/// As [`merge`] of coordinates that are no numbers and faces that name missing nodes.
pub fn film_thickness(models: &[&TriMesh], options: &MergeOptions<'_>) -> Result<f64, MergeError> {
    Ok(grid_over(models, options)?.thinnest())
}

fn solid_on(chain: &TriMesh, grid: Grid, options: &MergeOptions<'_>) -> Result<Solid, MergeError> {
    let merged = merge_on(&[chain], grid, true, options)?;
    let regions = merged.regions()?;
    merged.select(&regions, |w| w[0] > 0, options)
}

/// The boundary of what a chain of faces on the grid winds about, with the parents that its faces had.
fn merge_nodes(
    chain: TriMesh,
    parents: &[u32],
    grid: Grid,
    options: &MergeOptions<'_>,
) -> Result<select::Boundary, MergeError> {
    let complex = || Complex::new(chain.positions.iter().copied(), &chain.faces, true);
    let (complex, effort) = rounds::resolve(complex, &grid, options.cancelled)?;
    let merged = finished(&complex, grid, vec![0, chain.faces.len() as u32], effort.rounds);
    let regions = merged.regions()?;
    let (mut boundary, _) = merged.boundary(&regions, |w| w[0] > 0);
    boundary.parents.iter_mut().for_each(|p| *p = parents[*p as usize]);
    Ok(boundary)
}
