//! Deflation: a thin solid becomes its mid-surface, stitched and with its thickness (Sheen et al. 2008).

mod assemble;
mod bare;
mod blends;
mod cells;
mod closing;
mod descent;
mod eigen;
mod ends;
mod error;
mod exact;
mod faces;
mod features;
mod fill;
mod fit;
mod flares;
mod flats;
mod flush;
mod follow;
mod imprint;
mod looks;
mod loose;
mod middle;
mod nearness;
mod offset;
mod options;
mod patches;
mod places;
mod plan;
mod plane;
mod refill;
mod regions;
mod remesh;
mod replace;
mod report;
mod seams;
mod segments;
mod shape;
mod short;
mod sides;
mod slivers;
mod solid;
mod star;
mod straighten;
mod terraces;
mod thickness;
mod topology;
mod trials;
mod twins;
mod untangle;
mod walls;

pub use error::DeflateError;
pub use options::{DeflateOptions, Steps};
pub use report::{DeflateReport, Feature, LooseEnds, NamedFace, SkinFace, ThicknessRange, WallPair};
pub use shape::Shape;

use mesh_kernel::TriMesh;

use assemble::{Sheet, Source};
use blends::Blends;
use exact::Exact;
use faces::Faces;
use features::Features;
use flush::Flush;
use middle::Middles;
use patches::patched;
use replace::{Replacement, Way};
use segments::Segments;
use sides::Sets;
use solid::Solid;
use star::Star;
use straighten::straightened;
use thickness::thicknesses;
use topology::Topology;
use trials::{Chosen, Made, Trials};
use twins::Twins;
use walls::Walls;

/// A solid is thin if this share of its skin has a partner.
const THIN: f64 = 0.5;

/// The mid-surface of a solid.
#[derive(Clone, Debug)]
pub struct Deflated {
    /// The mid-surface; a group a patch, nodes shared wherever patches meet.
    pub sheet: TriMesh,
    /// Thickness at every face, in mm.
    pub thickness: Vec<f64>,
    /// Counts and measures.
    pub report: DeflateReport,
}

/// Steps of the work, for progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// The solid is checked.
    Check,
    /// Its skin is cut into face groups.
    Segments,
    /// Walls that lie opposite to each other are found.
    Pairs,
    /// Nodes move to the middle.
    Replace,
    /// One wall of every pair is taken and stitched to the others.
    Stitch,
    /// The mid-surface is measured.
    Measure,
}

/// Who is told of the progress, and may end the work.
pub trait Watcher: Sync {
    /// A step begins.
    fn step(&self, _step: Step) {}
    /// `true` ends the work with [`DeflateError::Cancelled`].
    fn cancelled(&self) -> bool {
        false
    }
}

/// Nobody watches.
#[derive(Clone, Copy, Debug)]
pub struct Nobody;
impl Watcher for Nobody {}

/// Deflates a solid.
///
/// Walls between plane faces get exact mid-planes; curved walls follow the tessellation of the solid, or with an edge length
/// have their nodes on the exact middles of round faces. The solid may be wound either way; nodes in one place are welded.
///
/// ```
/// use mesh_kernel::TriMesh;
/// use mesh_kernel::glam::DVec3;
/// use sheet::deflate::{DeflateOptions, Nobody, deflate};
///
/// // A plate of 100 × 60 × 2 mm.
/// let corner = |k: u32| DVec3::new(100. * f64::from(k & 1), 60. * f64::from(k >> 1 & 1), 2. * f64::from(k >> 2));
/// let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
/// let faces = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
/// let plate = TriMesh::new((0..8).map(corner).collect(), faces);
///
/// let thin = deflate(&plate, &DeflateOptions::default(), &Nobody)?;
/// assert!((thin.report.area - 6000.0).abs() < 1e-9);
/// assert!(thin.thickness.iter().all(|t| (t - 2.0).abs() < 1e-12));
/// # Ok::<(), sheet::deflate::DeflateError>(())
/// ```
///
/// # Errors
/// [`DeflateError`]. O(n log n) in faces.
pub fn deflate(
    solid: &TriMesh,
    options: &DeflateOptions,
    watcher: &dyn Watcher,
) -> Result<Deflated, DeflateError> {
    let begin = |step| {
        if watcher.cancelled() {
            return Err(DeflateError::Cancelled);
        }
        watcher.step(step);
        Ok(())
    };
    begin(Step::Check)?;
    options.check()?;
    let solid = straightened(Solid::new(solid)?);
    begin(Step::Segments)?;
    let mut segments = Segments::new(&solid);
    begin(Step::Pairs)?;
    let mut walls = Walls::new(&solid, &segments, options);
    let flares = walls.flares(&solid, &segments);
    if !flares.is_empty() {
        segments.split_off(&flares, &solid);
        walls.pair(&solid, &segments, options);
    }
    let mut faces = Faces::new(&solid, &segments);
    let mut wall_pairs = report::wall_pairs(&solid, &segments, &walls, &faces);
    let mut parts = walls.fillets(&solid, &segments, &faces, &wall_pairs);
    parts.extend(walls.bends(&solid, &segments, &faces));
    let rows = walls.first_rows(&solid, &segments, &faces, &wall_pairs);
    if !parts.is_empty() || !rows.is_empty() {
        segments.hand_over(&rows, &solid);
        segments.split_off(&parts, &solid);
        walls.pair(&solid, &segments, options);
        faces = Faces::new(&solid, &segments);
        wall_pairs = report::wall_pairs(&solid, &segments, &walls, &faces);
    }
    let (exact, blends) =
        rayon::join(|| Exact::new(&faces, &wall_pairs), || Blends::new(&solid, &segments, &walls));
    if walls.paired_share < THIN {
        let unpaired = unpaired(&solid, &segments, &walls, &[], 0.0);
        let (paired, max_thickness) = (walls.paired_share, walls.max_thickness);
        return Err(DeflateError::Bulky { paired, max_thickness, unpaired });
    }
    begin(Step::Replace)?;
    let mut features = Features::new(&solid, &segments, &walls, &blends, &faces, options);
    let mut middles = Middles::new(&solid, &segments, &walls);
    let flush = Flush::new(&solid, &segments, &walls);
    let mut sets = Sets::new(&solid, &segments, &walls, &blends);
    let kept = sets.kept(&flush, &middles.of_group, false);
    for step in middles.steps(&solid, &segments, &walls, &kept) {
        let removed = features.add_step(&solid, &segments, &step, options);
        if removed || options.steps == Steps::Aligned {
            middles.align_step(&walls, &step);
        }
    }
    let corners = middles.at_corners(&solid, &segments, &walls, &faces);
    let star = Star::new(&solid.mesh.faces, solid.mesh.positions.len());
    let twins = Twins::new(&solid, &walls, &star);
    let replacement = Replacement {
        solid: &solid,
        segments: &segments,
        faces: &faces,
        walls: &walls,
        middles: &middles,
        blends: &blends,
        corners: &corners,
        twins: &twins,
        flush: &flush,
        star: &star,
    };
    let meeting = replacement.moved(Way::Meeting);
    begin(Step::Stitch)?;
    let others = sets.kept(&flush, &middles.of_group, true);
    let trials = Trials {
        solid: &solid,
        parts: solid.parts(),
        segments: &segments,
        walls: &walls,
        set_of: sets.numbers(),
        middles: &middles,
        replacement: &replacement,
        exact: &exact,
        twins: &twins,
        options,
        watcher,
    };
    let Chosen { made: Made { sheet, crossing, .. }, with_features, bare, buried } =
        trials.best(&features.gone, &kept, &others, meeting)?;
    if sheet.faces.is_empty()
        && let Some(error) = one_sided(&solid, &segments, &walls)
    {
        return Err(error);
    }
    if with_features {
        features.undo();
    }
    // A mesh of its own has nodes on exact middles; one that follows the facets is as thick as they are apart.
    let on_exact = options.edge_length.map(|_| &exact);
    let thickness = thicknesses(&sheet, &solid, &segments, &walls, &middles, &corners, on_exact);
    let patched = patched(&sheet, &segments);
    let unpaired = unpaired(&solid, &segments, &walls, &features.gone, END_WIDTH);
    begin(Step::Measure)?;
    let thickness: Vec<f64> = patched.order.iter().map(|f| thickness[*f as usize]).collect();
    let mesh = patched.mesh;
    let topology = Topology::of(&mesh);
    let areas: Vec<f64> = (0..mesh.faces.len() as u32).map(|f| mesh.area_normal(f).length() / 2.0).collect();
    let area: f64 = areas.iter().sum();
    let report = DeflateReport {
        features: features.list,
        wall_pairs,
        faces: report::skin_faces(&solid, &faces),
        pairs: walls.pairs.iter().filter(|p| p.group < p.partner).count(),
        unpaired,
        loose_ends: buried.at.map(|at| LooseEnds { length: buried.length, at }),
        bare: bare.walls.iter().map(|(g, area)| named(&solid, &segments, *g, *area)).collect(),
        patches: mesh.groups.len(),
        joints: topology.joints,
        free_loops: topology.free_loops,
        components: topology.components,
        area,
        thickness: ThicknessRange {
            min: thickness.iter().copied().fold(f64::INFINITY, f64::min),
            max: thickness.iter().copied().fold(0.0, f64::max),
            mean: thickness.iter().zip(&areas).map(|(t, a)| t * a).sum::<f64>() / area,
        },
        max_thickness: walls.max_thickness,
        paired_share: walls.paired_share,
        steps: steps_of(&mesh, &patched.order, &sheet, &segments, &walls),
        self_intersections: crossing.len(),
        lost_edges: sheet.lost,
        solid_volume: solid.volume,
    };
    Ok(Deflated { sheet: mesh, thickness, report })
}

/// The largest wall most of which lies opposite to itself.
fn one_sided(solid: &Solid, segments: &Segments, walls: &Walls) -> Option<DeflateError> {
    let own = walls.pairs.iter().filter(|p| p.group == p.partner);
    let mostly = own.filter(|p| p.area > segments.group(p.group).area / 2.0);
    let largest = mostly.max_by(|p, q| p.area.total_cmp(&q.area).then(q.group.cmp(&p.group)))?;
    let group = segments.group(largest.group);
    let at = solid.centroid(*group.faces.first()?);
    Some(DeflateError::OneSided { area: group.area, at })
}

/// How many patches stand between two middles.
fn steps_of(mesh: &TriMesh, order: &[u32], sheet: &Sheet, segments: &Segments, walls: &Walls) -> usize {
    let is_step = |f: u32| match sheet.sources[order[f as usize] as usize] {
        Source::Plane(k) => sheet.planes[k as usize].is_step,
        Source::Facet(f) => !walls.is_wall[segments.of(f) as usize],
    };
    mesh.groups.iter().filter(|patch| patch.faces.clone().any(is_step)).count()
}

/// A face no wider than this many thicknesses is the end of a wall, or a blend.
const END_WIDTH: f64 = 1.5;
/// So many times this if it is round, and has the first facets of the wall as well.
const ROUND_END: f64 = 1.5;

/// Groups that are no walls, did not go and are wider than some thicknesses, the largest first.
fn unpaired(solid: &Solid, segments: &Segments, walls: &Walls, gone: &[bool], wider: f64) -> Vec<NamedFace> {
    let mut found = Vec::new();
    for ((g, group), is_wall) in segments.groups.iter().enumerate().zip(&walls.is_wall) {
        if *is_wall || gone.get(g).copied().unwrap_or(false) {
            continue;
        }
        let outline: f64 = group
            .faces
            .iter()
            .flat_map(|f| 3 * f..3 * f + 3)
            .filter(|h| segments.of(solid.across(*h)) != segments.of(h / 3))
            .map(|h| solid.length(h))
            .sum();
        let wider = if group.plane.is_some() { wider } else { wider * ROUND_END };
        if 2.0 * group.area < wider * walls.max_thickness * outline {
            continue;
        }
        found.push(named(solid, segments, g as u32, group.area));
    }
    found.sort_by(|a, b| b.area.total_cmp(&a.area));
    found
}

/// A group as reports name it.
fn named(solid: &Solid, segments: &Segments, g: u32, area: f64) -> NamedFace {
    let group = segments.group(g);
    let area_of = |f: &u32| solid.areas[*f as usize];
    let largest = group.faces.iter().max_by(|f, g| area_of(f).total_cmp(&area_of(g)).then(g.cmp(f)));
    let kind = if group.plane.is_some() { "plane" } else { "curved" };
    NamedFace { at: largest.map_or(glam::DVec3::ZERO, |f| solid.centroid(*f)), area, kind }
}
