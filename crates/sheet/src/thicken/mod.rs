//! Thickening: a sheet, manifold or not, becomes a clean solid (Lee & Kim 2001, sections 4–6).

mod arcs;
mod chain;
mod clean_sheet;
mod disks;
mod entities;
mod error;
mod half_prism;
mod measure;
mod offset_point;
mod offsets;
mod options;
mod orientation;
mod places;
mod polar_polygon;
mod report;
mod runs;
mod sphere_patch;
mod tidy;
mod tight;
mod tips;
mod voids;
mod wedges;

pub use chain::{OffsetChain, offset_chain};
pub use error::ThickenError;
pub use options::{Corners, Side, ThickenOptions, Thickness};
pub use report::{Origin, Place, PlaceKind, Purged, Role, ThickenReport};

use mesh_kernel::merge::{MergeOptions, Solid, film_thickness, solid_of_chain};
use mesh_kernel::query::Crossings;
use mesh_kernel::{Group, TriMesh};

use chain::{Offsetting, check_options};
use clean_sheet::CleanSheet;
use entities::Entities;
use measure::{Shells, WholeWall, pieces, shells, volume, wall_range, whole_walls};
use places::places;
use tidy::tidy;
use voids::fill_voids;

/// A thickness of more than this many times the sheet's diagonal is refused.
pub const MAX_THICKNESS: f64 = 10.0;

/// A wall is so many times as thick as what the union takes for rounding: of two offsets and what is between them, each must
/// be told from it.
const WALL_OF_FILMS: f64 = 4.0;

/// A thickened sheet.
#[derive(Clone, Debug)]
pub struct Thickened {
    /// The solid: closed, oriented outward, two-manifold, without self-intersections. Groups are the roles.
    pub solid: TriMesh,
    /// What each face came from.
    pub origins: Vec<Origin>,
    /// Counts, measures, and the places that deserve a look.
    pub report: ThickenReport,
    walls: Vec<WholeWall>,
}

impl Thickened {
    /// The report on the solid as something else made it anew, with coordinates that a file can hold, say, of `unit`
    /// millimetres. `origins` are those of its faces. O(n log n).
    pub fn measured_on(&self, solid: &TriMesh, unit: f64, origins: &[Origin]) -> ThickenReport {
        let pieces = pieces(solid);
        let walls = wall_range(&self.walls, solid, origins);
        let [min_wall, max_wall] = walls.map(|wall| wall * unit);
        ThickenReport {
            faces: solid.faces.len(),
            closed: pieces.closed,
            self_intersections: Crossings::new(solid).self_crossing().len(),
            volume: volume(solid) * unit.powi(3),
            components: pieces.solids,
            genus: pieces.genus,
            min_wall,
            max_wall,
            ..self.report.clone()
        }
    }

    /// Connected solids none of whose faces is among `parents`: what something that made the solid anew left out. Those that are next to nothing
    /// beside the whole do not count. O(n).
    pub fn lost_parts(&self, parents: &[u32]) -> usize {
        /// The volume of a crumb that the union left, over that of all.
        const CRUMB: f64 = 1e-6;
        let Shells { of_node, volumes } = shells(&self.solid);
        let crumb = CRUMB * volumes.iter().filter(|v| **v > 0.0).sum::<f64>();
        let mut is_kept: Vec<bool> = volumes.iter().map(|v| *v <= crumb).collect();
        for &f in parents {
            is_kept[of_node[self.solid.faces[f as usize][0] as usize] as usize] = true;
        }
        is_kept.iter().filter(|kept| !**kept).count()
    }
}

/// Steps of the work, for progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Face-uses, wedges and disks are found.
    Entities,
    /// Their offsets are made.
    Offsets,
    /// The offsets are united, and what is not on the solid's boundary is purged.
    Union,
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

/// Thickens a sheet; its groups are its patches (faces in none are one more).
///
/// Nodes in one place are welded; faces without an area, and doubles, are left out. Patches may be wound as they like
/// where both sides get material; one side needs a two-manifold sheet, whose patches are turned to agree.
///
/// ```
/// use mesh_kernel::TriMesh;
/// use mesh_kernel::glam::DVec3;
/// use sheet::thicken::{Nobody, ThickenOptions, thicken};
///
/// // A plate of 10 × 20 mm, bent up by 90° to a flange of 10 × 5 mm.
/// let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
/// let nodes = vec![at(0., 0., 0.), at(10., 0., 0.), at(10., 20., 0.), at(0., 20., 0.), at(0., 0., 5.), at(10., 0., 5.)];
/// let sheet = TriMesh::new(nodes, vec![[0, 1, 2], [0, 2, 3], [0, 4, 5], [0, 5, 1]]);
/// let thick = thicken(&sheet, &ThickenOptions::new(1.0), &Nobody)?;
/// let (d, arc) = (0.5, std::f64::consts::FRAC_PI_4 * 0.25);
/// let wanted = 10.0 * (2.0 * d * (20.0 + 5.0) - d * d + arc);
/// assert!(thick.report.closed && (thick.report.volume - wanted).abs() < 1e-9 * wanted);
/// # Ok::<(), sheet::thicken::ThickenError>(())
/// ```
///
/// # Errors
/// [`ThickenError`]. O(n log n) in faces of the sheet, plus what crosses.
pub fn thicken(
    sheet: &TriMesh,
    options: &ThickenOptions,
    watcher: &dyn Watcher,
) -> Result<Thickened, ThickenError> {
    let begin = |step| {
        if watcher.cancelled() {
            return Err(ThickenError::Cancelled);
        }
        watcher.step(step);
        Ok(())
    };
    begin(Step::Entities)?;
    check_options(options)?;
    let sheet = CleanSheet::new(sheet, options)?;
    let entities = Entities::new(&sheet);
    let offsetting = Offsetting::new(&sheet, &entities, options)?;
    begin(Step::Offsets)?;
    let chain = offsetting.chain(options);
    begin(Step::Union)?;
    let cancelled = || watcher.cancelled();
    let merge = MergeOptions { cancelled: &cancelled, ..MergeOptions::default() };
    sheet.check_thinnest(WALL_OF_FILMS * film_thickness(&[&chain.mesh], &merge)?)?;
    let mut united = solid_of_chain(&chain.mesh, &merge)?;
    let voids_filled = fill_voids(&sheet, &chain, options.side, &mut united);
    let (redundant, self_intersections) = purge_redundant(&chain, &mut united);
    begin(Step::Measure)?;
    let volume = united.volume();
    let (purged, beads) = (united.purged, united.beads);
    let (solid, origins) = by_role(united, &chain.origins);
    let pieces = pieces(&solid);
    let walls = whole_walls(&sheet, &chain, &solid, &origins);
    let [min_wall, max_wall] = wall_range(&walls, &solid, &origins);
    let report = ThickenReport {
        faces: solid.faces.len(),
        closed: pieces.closed,
        self_intersections,
        volume,
        components: pieces.solids,
        genus: pieces.genus,
        min_wall,
        max_wall,
        purged: Purged {
            laminar: purged.laminar,
            screen: purged.screen,
            wire: purged.wire,
            redundant,
            ..Purged::default()
        },
        holes_filled: chain.holes_filled,
        beads,
        voids_filled,
        places: places(&sheet, &chain, &solid, &origins),
        turned: chain.turned,
    };
    Ok(Thickened { solid, origins, report, walls })
}

/// Takes redundant entities away, unless faces would cross then, which no plane that is one allows; returns how many, and
/// how many pairs of faces cross.
fn purge_redundant(chain: &OffsetChain, united: &mut Solid) -> (usize, usize) {
    let crossing = |mesh: &TriMesh| Crossings::new(mesh).self_crossing().len();
    let untidied = united.clone();
    let redundant = tidy(chain, united);
    let crossings = crossing(&united.mesh);
    if redundant > 0 && crossings > 0 {
        *united = untidied;
        return (0, crossing(&united.mesh));
    }
    (redundant, crossings)
}

/// The faces in the order of their roles, each role a group; without nodes that no face has.
fn by_role(united: Solid, origins: &[Origin]) -> (TriMesh, Vec<Origin>) {
    let Solid { mesh, parents, .. } = united;
    let mut order: Vec<(Origin, usize)> =
        parents.iter().enumerate().map(|(f, &parent)| (origins[parent as usize], f)).collect();
    order.sort_by_key(|(origin, f)| (origin.role, *f));
    let mut number = vec![u32::MAX; mesh.positions.len()];
    mesh.faces.iter().flatten().for_each(|&v| number[v as usize] = 0);
    let mut positions = Vec::with_capacity(mesh.positions.len());
    for (number, p) in number.iter_mut().zip(mesh.positions).filter(|(n, _)| **n == 0) {
        *number = positions.len() as u32;
        positions.push(p);
    }
    let face = |f: usize| mesh.faces[f].map(|v| number[v as usize]);
    let mut solid = TriMesh::new(positions, order.iter().map(|&(_, f)| face(f)).collect());
    let mut first = 0;
    for same in order.chunk_by(|a, b| a.0.role == b.0.role) {
        let end = first + same.len() as u32;
        solid.groups.push(Group { name: same[0].0.role.name().to_owned(), faces: first..end });
        first = end;
    }
    (solid, order.into_iter().map(|(origin, _)| origin).collect())
}
