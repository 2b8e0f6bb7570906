//! Unfolding: a folded sheet becomes flat plates with bend lines (Stroud & Nagy 6.3.3; Lipson & Shpitalni 3.1).
//!
//! The facets' joins that bend are a spanning forest, chosen so that the flat sheet does not lie on itself; all other
//! lines are cut, and welded when the part is put together. With a thickness, every bend takes its allowance
//! `angle · (inner radius + k · thickness)` and the facets lose their setbacks.

mod allowance;
mod error;
pub(crate) mod layout;
mod outline;
mod overlap;
mod relief;
pub(crate) mod search;
mod shape;

pub use allowance::{BendMeasures, Metal, Reference};
pub use error::UnfoldError;
pub use outline::OutlinePoint;
pub use relief::{Relief, ReliefShape};
pub use search::Effort;
pub(crate) use shape::flat_triangles;
pub(crate) use shape::inside;

use glam::DVec2;

use crate::bends::forest::{PerLine, spanning_size};
use crate::bends::joins;
use crate::facets::FacetSheet;
use layout::Flattening;
use outline::Outlines;
use search::{Found, Search};

/// How a sheet is unfolded.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UnfoldOptions {
    /// The metal.
    pub metal: Metal,
    /// Reliefs at the ends of bends.
    pub relief: Relief,
    /// How long is searched for a flat sheet that does not lie on itself.
    pub effort: Effort,
    /// Gap between plates, in millimetres.
    pub gap: f64,
}

/// A bend on a plate.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatBend {
    /// The line of the sheet.
    pub line: u32,
    /// The facets on both sides.
    pub facets: [u32; 2],
    /// Ends of the bend's middle line.
    pub ends: [DVec2; 2],
    /// Its measures.
    pub measures: BendMeasures,
    /// Whether it bends toward who looks at the plate.
    pub up: bool,
}

/// A part of an outline that is welded to another one.
#[derive(Clone, Debug, PartialEq)]
pub struct WeldEdge {
    /// The line of the sheet.
    pub line: u32,
    /// Its ends on the plate.
    pub ends: [DVec2; 2],
}

/// A flat plate, from which facets are bent.
#[derive(Clone, Debug, PartialEq)]
pub struct Plate {
    /// Its facets, ascending.
    pub facets: Vec<u32>,
    /// The outer outline, anticlockwise, then holes, clockwise.
    pub outlines: Vec<Vec<OutlinePoint>>,
    /// Bends.
    pub bends: Vec<FlatBend>,
    /// Edges to be welded.
    pub welds: Vec<WeldEdge>,
    /// Where each facet's name may stand, with the facet.
    pub labels: Vec<(u32, DVec2)>,
    /// Lower left corner and upper right corner.
    pub bounds: [DVec2; 2],
}

/// A sheet laid flat.
#[derive(Clone, Debug, PartialEq)]
pub struct Unfolded {
    /// Its plates, that of the largest facet first.
    pub plates: Vec<Plate>,
    /// Whether every component of the sheet is one plate.
    pub one_piece: bool,
    /// Plates that the lines alone ask for: what is more is cut because it would overlap.
    pub least_plates: usize,
    /// Pairs of facets that lie on each other: none.
    pub overlaps: usize,
    /// Largest difference of a facet's edge on the plate, before bends take their share, to that of the sheet.
    pub length_error: f64,
    /// Reliefs cut.
    pub reliefs: usize,
    /// Flat sheets tried.
    pub tried: usize,
}

/// Unfolds a sheet of plane facets. O(facets + lines) a flat sheet tried, and the search's effort.
///
/// ```
/// use mesh_kernel::TriMesh;
/// use mesh_kernel::glam::DVec3;
/// use sheet::facets::{FacetRule, FacetSheet};
/// use sheet::unfold::{UnfoldOptions, unfold};
///
/// // A plate of 10 × 20 mm with a flange of 10 × 5 mm.
/// let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
/// let nodes = vec![at(0., 0., 0.), at(10., 0., 0.), at(10., 20., 0.), at(0., 20., 0.), at(0., 0., 5.), at(10., 0., 5.)];
/// let mesh = TriMesh::new(nodes, vec![[0, 1, 2], [0, 2, 3], [0, 4, 5], [0, 5, 1]]);
/// let sheet = FacetSheet::new(&mesh, FacetRule::Planes)?;
/// let flat = unfold(&sheet, &UnfoldOptions::default())?;
/// let [low, high] = flat.plates[0].bounds;
/// assert!(((high - low).max_element() - 25.0).abs() < 1e-9);
/// assert_eq!(flat.plates[0].bends.len(), 1);
/// # Ok::<(), sheet::unfold::UnfoldError>(())
/// ```
///
/// # Errors
/// [`UnfoldError`].
pub fn unfold(sheet: &FacetSheet, options: &UnfoldOptions) -> Result<Unfolded, UnfoldError> {
    let joins = joins(sheet);
    let flat = Flattening::new(sheet, &joins, &options.metal)?;
    let counts = sheet.counts(|_| true);
    let mut search = Search::new(&flat, PerLine::Matching, spanning_size(&counts), options.effort);
    let found = search.run()?;
    let least_plates = sheet.facets.len() - found.forest.joins.len();
    let found = if found.overlaps.is_empty() { found } else { search.part(found)? };
    Ok(plates(&flat, &found, least_plates, counts.s as usize, options))
}

fn plates(
    flat: &Flattening<'_>,
    found: &Found,
    least_plates: usize,
    components: usize,
    options: &UnfoldOptions,
) -> Unfolded {
    let layout = &found.layout;
    let mut outlines = Outlines::new(flat, layout, options.relief.cut(options.metal.thickness));
    let mut plates: Vec<Plate> =
        (0..layout.pieces as u32).map(|piece| plate(flat, found, piece, &mut outlines)).collect();
    let reliefs = outlines.reliefs;
    arrange(&mut plates, options.gap);
    Unfolded {
        one_piece: plates.len() == components,
        plates,
        least_plates,
        overlaps: found.overlaps.len(),
        length_error: length_error(flat),
        reliefs,
        tried: found.tried,
    }
}

fn plate(flat: &Flattening<'_>, found: &Found, piece: u32, outlines: &mut Outlines<'_>) -> Plate {
    let layout = &found.layout;
    let loops = outlines.of_piece(piece);
    let mut welds = Vec::new();
    for outline in &loops {
        for (k, p) in outline.iter().enumerate() {
            if let Some(line) = p.line
                && !flat.sheet.lines[line as usize].is_free()
            {
                welds.push(WeldEdge { line, ends: [p.at, outline[(k + 1) % outline.len()].at] });
            }
        }
    }
    let facets: Vec<u32> =
        (0..layout.piece.len() as u32).filter(|&f| layout.piece[f as usize] == piece).collect();
    for &f in &facets {
        let sides: Vec<_> = flat.shapes[f as usize].loops.iter().flatten().collect();
        let other = |line: u32| sides.iter().any(|s| s.side.line == line && !s.side.along);
        for s in sides.iter().filter(|s| s.side.along && other(s.side.line)) {
            let ends = [s.from, s.to].map(|p| layout.placements[f as usize].apply(p));
            welds.push(WeldEdge { line: s.side.line, ends });
        }
    }
    let mut bends = Vec::new();
    for (number, bend) in (0..).zip(&layout.bends) {
        let join = &flat.joins[bend.join as usize];
        let first = join.facets[0];
        if layout.piece[first as usize] != piece {
            continue;
        }
        let [a0, a1, b1, b0] = flat.strip(layout, number);
        // Where nothing is cut at an end (a flat vertex inside a plate) the strip's own end is the line's.
        let ends = match outlines.bend_ends[number as usize][..] {
            [p, q] => [p, q],
            _ => [(a0 + b0) / 2.0, (a1 + b1) / 2.0],
        };
        let up = bend.to_front != layout.placements[first as usize].mirrored;
        bends.push(FlatBend { line: join.line, facets: join.facets, ends, measures: bend.measures, up });
    }
    bends.sort_by_key(|b| b.line);
    let labels = facets
        .iter()
        .map(|&f| {
            let loops: Vec<Vec<DVec2>> =
                layout.trimmed[f as usize].iter().map(|l| shape::corners(l)).collect();
            (f, layout.placements[f as usize].apply(middle(&loops)))
        })
        .collect();
    let all = loops.iter().flatten().map(|p| p.at);
    let bounds = all.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[l, h], p| [l.min(p), h.max(p)]);
    Plate { facets, outlines: loops, bends, welds, labels, bounds }
}

/// The centre of the largest triangle: a point inside.
fn middle(loops: &[Vec<DVec2>]) -> DVec2 {
    let area = |t: &[DVec2; 3]| (t[1] - t[0]).perp_dot(t[2] - t[0]).abs();
    let all = shape::triangulate(loops);
    let largest = all.iter().max_by(|a, b| area(a).total_cmp(&area(b)));
    largest.map_or_else(
        || loops.first().and_then(|l| l.first()).copied().unwrap_or_default(),
        |t| (t[0] + t[1] + t[2]) / 3.0,
    )
}

/// Lays plates in rows, none higher than the first is wide or high.
fn arrange(plates: &mut [Plate], gap: f64) {
    let row = plates.iter().map(|p| (p.bounds[1] - p.bounds[0]).max_element()).fold(0.0, f64::max) * 2.0;
    let (mut x, mut y, mut height) = (0.0, 0.0, 0.0f64);
    for plate in plates {
        let size = plate.bounds[1] - plate.bounds[0];
        if x > 0.0 && x + size.x > row {
            (x, y, height) = (0.0, y + height + gap, 0.0);
        }
        let by = DVec2::new(x, y) - plate.bounds[0];
        plate.outlines.iter_mut().flatten().for_each(|p| p.at += by);
        plate.bends.iter_mut().for_each(|b| b.ends = b.ends.map(|p| p + by));
        plate.welds.iter_mut().for_each(|w| w.ends = w.ends.map(|p| p + by));
        plate.labels.iter_mut().for_each(|l| l.1 += by);
        plate.bounds = plate.bounds.map(|p| p + by);
        x += size.x + gap;
        height = height.max(size.y);
    }
}

/// Largest difference between a side in its facet's plane and in space.
fn length_error(flat: &Flattening<'_>) -> f64 {
    let all = flat.shapes.iter().flat_map(|s| s.loops.iter().flatten());
    let off = all.map(|s| {
        let [a, b] = flat.sheet.line_ends(s.side.line);
        (s.from.distance(s.to) - a.distance(b)).abs()
    });
    off.fold(0.0, f64::max)
}
