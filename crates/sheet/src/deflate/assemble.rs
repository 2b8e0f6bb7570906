//! Extraction and stitching: the kept walls at their middles become one mesh with shared nodes (Sheen et al. 2008,
//! section 7, and what the paper leaves to others).

use std::collections::BTreeSet;

use glam::DVec3;

use super::DeflateOptions;
use super::cells::Cells;
use super::fill::{Outline, fill};
use super::looks::mean_thickness;
use super::middle::Middles;
use super::nearness::Nearness;
use super::plan::{Plan, PlanePiece, border, plan};
use super::plane::Plane;
use super::seams::{Merged, Seams};
use super::segments::Segments;
use super::slivers::{cancel_doubles, contract};
use super::solid::Solid;
use super::terraces::Terraces;
use super::walls::Walls;

/// Edges of curved pieces shorter than this share of the wall's thickness close when they got that short by moving.
const CLOSED: f64 = 0.02;
/// Edges of curved pieces shorter than this share of the thickness are left over from closing and close too.
const SHORT: f64 = 0.015;
/// Borders of curved pieces that are this near, over the thickness, are one.
const CHORDS: f64 = 0.25;
/// What is exact agrees to this share of the solid's size.
const ROUNDING: f64 = 1e-6;
/// Nodes inside plane pieces keep this share of the thickness away from edges.
const MARGIN: f64 = 0.4;

/// What a face of the mid-surface came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Source {
    /// A plane, by its number among the fills.
    Plane(u32),
    /// A face of a curved wall of the solid.
    Facet(u32),
}

/// A mid-surface as it is being made.
#[derive(Clone, Debug, Default)]
pub(super) struct Sheet {
    pub(super) positions: Vec<DVec3>,
    pub(super) faces: Vec<[u32; 3]>,
    /// Of every face.
    pub(super) sources: Vec<Source>,
    /// By their numbers.
    pub(super) planes: Vec<FilledPlane>,
    /// Edges of outlines that were lost.
    pub(super) lost: usize,
}

/// A plane that was filled from its outline.
#[derive(Clone, Debug)]
pub(super) struct FilledPlane {
    pub(super) plane: Plane,
    /// Whether it is a step between two thicknesses.
    pub(super) is_step: bool,
    /// Groups of the solid in it.
    pub(super) groups: Vec<u32>,
    /// How large its triangles may be.
    pub(super) cells: Option<Cells>,
}

/// Where the solid's nodes go.
#[derive(Clone)]
pub(super) struct Moved {
    pub(super) positions: Vec<DVec3>,
    /// Whether a node lies beside facets and not just on planes: then it is only as exact as chords are.
    pub(super) soft: Vec<bool>,
    /// Whether a node is on a blend and belongs to what is behind that.
    pub(super) blended: Vec<bool>,
    /// Whether a node is where a wall is nothing but the end of another.
    pub(super) flush: Vec<bool>,
}

/// Makes the mid-surface. `gone`: groups that it is made without, as if walls went on below. O(n log n).
#[allow(clippy::too_many_arguments, reason = "one call, all of them what was found before")]
pub(super) fn assemble(
    solid: &Solid,
    segments: &Segments,
    walls: &Walls,
    middles: &Middles,
    gone: &[bool],
    kept: &[bool],
    moved: &Moved,
    options: &DeflateOptions,
) -> Sheet {
    let (mut kept, mut moved) = (kept.to_vec(), moved.clone());
    let terraces = Terraces { solid, segments, walls, middles, gone, steps: options.steps };
    let terraces = terraces.pieces(&mut kept, &mut moved);
    let plan = plan(solid, segments, walls, middles, gone, &kept, &moved, terraces, options);
    let Moved { positions: moved, soft, .. } = &moved;
    let thickness = mean_thickness(&walls.pairs).unwrap_or(0.0);
    let near = Nearness { rounding: ROUNDING * solid.size, chords: CHORDS * thickness };
    let merged = closed_edges(solid, segments, &plan, moved, CLOSED * thickness);
    let mut borders: Vec<([u32; 2], u32)> = Vec::new();
    for (k, piece) in (0..).zip(&plan.planes) {
        borders.extend(piece.edges(solid, segments, gone).into_iter().map(|e| (e, k)));
    }
    let first_curved = plan.planes.len() as u32;
    for (k, g) in (first_curved..).zip(&plan.curved) {
        borders.extend(border(solid, segments, gone, *g).map(|e| (e, k)));
    }
    let mut seams = Seams::new(moved.clone(), merged, &borders, first_curved, soft, near);
    let plane_of =
        |k: u32| plan.planes.get(k as usize).filter(|piece| !piece.is_step).map(|piece| piece.plane);
    seams.put_on_planes(plane_of, near);
    let length_of = |k: u32, direction: DVec3| {
        let cells = cells(plan.planes.get(k as usize), options);
        cells.map_or(f64::INFINITY, |cells| cells.length_in(direction))
    };
    seams.refine(length_of);
    let mut sheet = Sheet { positions: seams.positions.clone(), ..Sheet::default() };
    add_planes(&mut sheet, solid, segments, gone, &plan, &seams, &borders, options, MARGIN * thickness);
    let first_curved = sheet.faces.len();
    add_curved(&mut sheet, solid, segments, &plan, &seams);
    let mut on_border = vec![false; sheet.positions.len()];
    for v in borders.iter().flat_map(|([a, b], _)| seams.path(*a, *b)) {
        on_border[v as usize] = true;
    }
    contract(&mut sheet, first_curved, &on_border, SHORT * thickness);
    cancel_doubles(&mut sheet);
    sheet.without_unused_nodes()
}

/// Edges of curved pieces that got very short close.
fn closed_edges(solid: &Solid, segments: &Segments, plan: &Plan, moved: &[DVec3], short: f64) -> Merged {
    let mut merged = Merged::new(moved.len());
    for &g in &plan.curved {
        for &f in &segments.group(g).faces {
            for h in 3 * f..3 * f + 3 {
                let [a, b] = solid.adjacency.ends(h);
                let before = solid.mesh.positions[a as usize].distance(solid.mesh.positions[b as usize]);
                let after = moved[a as usize].distance(moved[b as usize]);
                if after < short && after < 0.3 * before {
                    merged.join(a, b);
                }
            }
        }
    }
    merged
}

/// How large the triangles of a piece may be. A length that was asked for is one in all directions.
fn cells(piece: Option<&PlanePiece>, options: &DeflateOptions) -> Option<Cells> {
    let asked = options.edge_length.map(Cells::even);
    piece.and_then(|piece| piece.cells).into_iter().chain(asked).reduce(Cells::both)
}

#[allow(clippy::too_many_arguments, reason = "one call, all of them what the piece is made of")]
fn add_planes(
    sheet: &mut Sheet,
    solid: &Solid,
    segments: &Segments,
    gone: &[bool],
    plan: &Plan,
    seams: &Seams,
    borders: &[([u32; 2], u32)],
    options: &DeflateOptions,
    margin: f64,
) {
    let rounding = ROUNDING * solid.size;
    let mut all: Vec<[u32; 2]> = borders
        .iter()
        .flat_map(|([a, b], _)| {
            let path = seams.path(*a, *b);
            path.windows(2).map(|w| [w[0].min(w[1]), w[0].max(w[1])]).collect::<Vec<_>>()
        })
        .collect();
    all.sort_unstable();
    all.dedup();
    for piece in &plan.planes {
        let mut outline = Outline { plane: piece.plane, edges: vec![], lines: vec![], inside: vec![] };
        let mut on_border: BTreeSet<u32> = BTreeSet::new();
        for [a, b] in piece.edges(solid, segments, gone) {
            let path = seams.path(a, b);
            on_border.extend(&path);
            outline.edges.extend(path.windows(2).map(|w| [w[0], w[1]]));
        }
        let on = |v: u32| piece.plane.height(sheet.positions[v as usize]).abs() < rounding;
        outline.lines = all.iter().copied().filter(|[a, b]| on(*a) && on(*b)).collect();
        let cells = cells(Some(piece), options);
        if cells.is_none() && !piece.is_step && piece.outline.is_empty() {
            let near = Near::new(&outline, &sheet.positions, margin);
            let mut inside: BTreeSet<u32> = BTreeSet::new();
            for (g, _) in &piece.groups {
                let faces = &segments.group(*g).faces;
                inside.extend(faces.iter().flat_map(|f| solid.mesh.faces[*f as usize]));
            }
            outline.inside = inside
                .into_iter()
                .filter(|v| seams.merged.find(*v) == *v && !on_border.contains(v))
                .filter(|v| !near.is_near(sheet.positions[*v as usize]))
                .collect();
        }
        let number = sheet.planes.len() as u32;
        let filled = fill(&outline, &sheet.positions, cells);
        sheet.positions.extend(filled.added);
        sheet.sources.extend(filled.faces.iter().map(|_| Source::Plane(number)));
        sheet.faces.extend(filled.faces);
        sheet.lost += filled.lost;
        let groups = piece.groups.iter().map(|g| g.0).collect();
        sheet.planes.push(FilledPlane { plane: piece.plane, is_step: piece.is_step, groups, cells });
    }
}

fn add_curved(sheet: &mut Sheet, solid: &Solid, segments: &Segments, plan: &Plan, seams: &Seams) {
    for &g in &plan.curved {
        for &f in &segments.group(g).faces {
            let sides = [0, 1, 2].map(|k| {
                let [a, b] = solid.adjacency.ends(3 * f + k);
                seams.path(a, b)
            });
            for face in cut(sides) {
                sheet.faces.push(face);
                sheet.sources.push(Source::Facet(f));
            }
        }
    }
}

/// A face whose sides have nodes on them, as triangles; nothing where two corners are one.
pub(super) fn cut(sides: [Vec<u32>; 3]) -> Vec<[u32; 3]> {
    let corners = [sides[0][0], sides[1][0], sides[2][0]];
    let [a, b, c] = corners;
    if a == b || b == c || c == a {
        return Vec::new();
    }
    let mut done = Vec::new();
    // The first side is cut from the opposite corner; the two others are sides of the first and last part.
    let first: Vec<[u32; 3]> = sides[0].windows(2).map(|w| [w[0], w[1], c]).collect();
    let last = first.len() - 1;
    for (k, [p, q, r]) in first.into_iter().enumerate() {
        let second = if k == last { sides[1].clone() } else { vec![q, r] };
        let third = if k == 0 { sides[2].clone() } else { vec![r, p] };
        // Part by part along the second side, seen from p; the last part holds the third side.
        let parts: Vec<[u32; 3]> = second.windows(2).map(|w| [p, w[0], w[1]]).collect();
        let (end, whole) = (parts[parts.len() - 1], &parts[..parts.len() - 1]);
        done.extend_from_slice(whole);
        done.extend(third.windows(2).map(|w| [end[1], w[0], w[1]]));
    }
    done.retain(|[a, b, c]| a != b && b != c && c != a);
    done
}

/// Whether places are near to the edges of an outline: cells along the edges are marked.
struct Near {
    cell: f64,
    frame: [DVec3; 2],
    marked: BTreeSet<(i64, i64)>,
}

impl Near {
    fn new(outline: &Outline, positions: &[DVec3], margin: f64) -> Self {
        let mut near = Self { cell: margin, frame: outline.plane.frame(), marked: BTreeSet::new() };
        for [a, b] in outline.edges.iter().chain(&outline.lines) {
            let (p, q) = (positions[*a as usize], positions[*b as usize]);
            let steps = (p.distance(q) / margin).ceil().clamp(1.0, 1e6) as u32;
            for k in 0..=steps {
                let (i, j) = near.key(p.lerp(q, f64::from(k) / f64::from(steps)));
                for di in -1..=1 {
                    near.marked.extend((-1..=1).map(|dj| (i + di, j + dj)));
                }
            }
        }
        near
    }

    fn key(&self, p: DVec3) -> (i64, i64) {
        let [i, j] = self.frame.map(|axis| (p.dot(axis) / self.cell).floor() as i64);
        (i, j)
    }

    fn is_near(&self, p: DVec3) -> bool {
        self.marked.contains(&self.key(p))
    }
}

impl Sheet {
    /// Leaves out nodes without faces. O(n).
    pub(super) fn without_unused_nodes(mut self) -> Self {
        const NONE: u32 = u32::MAX;
        let mut number = vec![NONE; self.positions.len()];
        let mut positions = Vec::new();
        for v in self.faces.iter_mut().flatten() {
            let slot = &mut number[*v as usize];
            if *slot == NONE {
                *slot = positions.len() as u32;
                positions.push(self.positions[*v as usize]);
            }
            *v = *slot;
        }
        self.positions = positions;
        self
    }
}
