//! Walls that end on round ones which know nothing of them.
//!
//! Of the two sides of a round wall one is kept, with the edges of what stands on it. Webs on the other side end on its middle all the same, up
//! to the chords of both: they are drawn out a little, merged with it, and what sticks out beyond is cut off.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::merge::{self, MergeOptions, merge};
use mesh_kernel::query::Adjacency;

use super::assemble::{Sheet, Source};
use super::loose::{Beside, Loose};
use super::places::Places;
use super::seams::Merged;
use super::short::close_short;

/// Borders are drawn out by so many times the way that they look for a face.
const DRAWN_OUT: f64 = 2.0;
/// What is farther out than so many times this is cut off.
const BEYOND: f64 = 1.5;
/// What sticks out is less than this share of what borders were drawn out.
const STICKS_OUT: f64 = 0.75;
/// Edges that cutting left and that are shorter than this share of the wanted length close; without one, than this share of the thickness.
const SHORT: f64 = 0.4;
const SHORT_ANYWAY: f64 = 0.15;
/// Ends that stick out too far are left as they are in so many rounds.
const ROUNDS: usize = 4;
/// What was in one place before is so to this share of the way after.
const SAME: f64 = 1e-6;

/// A sheet whose loose borders are joined to the faces beside them.
pub(super) struct Imprinted {
    pub(super) sheet: Sheet,
    /// How long the borders are that were, in mm.
    pub(super) length: f64,
}

/// The sheet with its loose borders on the faces beside them; `None` if there are none, or if more than these would change. Those that would
/// stick out on the other side stay as they are. O(n log n).
pub(super) fn imprinted(sheet: &Sheet, beside: &Beside, edge_length: Option<f64>) -> Option<Imprinted> {
    let mesh = TriMesh::new(sheet.positions.clone(), sheet.faces.clone());
    let adjacency = Adjacency::new(&mesh);
    let mut loose = beside.loose_edges(&mesh, &adjacency, &sheet.sources);
    for _ in 0..ROUNDS {
        if loose.is_empty() {
            return None;
        }
        let cut = Cut::new(&mesh, &adjacency, &loose, beside.reach())?;
        let sticking_out = cut.sticking_out();
        if sticking_out.is_empty() {
            let made = cut.sheet(sheet);
            let ends = loose.iter().map(|l| l.ends.map(|v| sheet.positions[v as usize]));
            let segments: Vec<[DVec3; 2]> = ends.collect();
            let short = edge_length.map_or(SHORT_ANYWAY * beside.thickness, |length| SHORT * length);
            let sheet = tidied(made, &cut.planes(sheet), short, &Places::along(&segments, short / SHORT));
            return Some(Imprinted { sheet, length: segments.iter().map(|[p, q]| p.distance(*q)).sum() });
        }
        let mut chains = Merged::new(mesh.positions.len());
        loose.iter().for_each(|l| chains.join(l.ends[0], l.ends[1]));
        let bad: BTreeSet<u32> = sticking_out.into_iter().map(|k| chains.find(loose[k].ends[0])).collect();
        loose.retain(|l| !bad.contains(&chains.find(l.ends[0])));
    }
    None
}

/// Without the slivers and short edges that cutting left.
fn tidied(mut sheet: Sheet, planes: &BTreeSet<u32>, short: f64, near: &Places) -> Sheet {
    sheet.refill(planes);
    close_short(&mut sheet, short, near);
    sheet.refill(planes);
    sheet.without_unused_nodes()
}

/// A sheet with its loose borders drawn out, cut where this meets something.
struct Cut<'a> {
    loose: &'a [Loose],
    merged: merge::Merged,
    /// Faces of the sheet; those that follow are flaps.
    old: usize,
    /// For every flap, of which loose edge it is.
    flaps: Vec<usize>,
    /// For every face, which piece it is of: pieces end at joints.
    piece: Vec<u32>,
    /// Pieces that reach the far ends of flaps.
    outer: BTreeSet<u32>,
}

impl<'a> Cut<'a> {
    /// `None` if more is cut than what is beside the borders.
    fn new(mesh: &TriMesh, adjacency: &Adjacency, loose: &'a [Loose], reach: f64) -> Option<Self> {
        let old = mesh.faces.len();
        let (drawn_out, flaps) = with_flaps(mesh.clone(), adjacency, loose, DRAWN_OUT * reach);
        let merged = merge(&[&drawn_out], &MergeOptions::default()).ok()?;
        let at = |v: u32| drawn_out.positions[v as usize];
        let segments: Vec<[DVec3; 2]> = loose.iter().map(|l| l.ends.map(at)).collect();
        let known = Places::new(drawn_out.positions.iter().copied(), SAME * reach);
        let near = Places::along(&segments, DRAWN_OUT * reach);
        if !merged.positions.iter().all(|p| known.has(*p) || near.has(*p)) {
            return None;
        }
        let adjacency = Adjacency::new(&TriMesh::new(merged.positions.clone(), merged.faces.clone()));
        let edges = (0..adjacency.edges().len() as u32).map(|e| adjacency.half_edges(e));
        let mut pieces = Merged::new(merged.faces.len());
        for half_edges in edges.clone() {
            if let [g, h] = half_edges {
                pieces.join(g / 3, h / 3);
            }
        }
        let piece: Vec<u32> = (0..merged.faces.len() as u32).map(|f| pieces.find(f)).collect();
        let mut cut = Self { loose, merged, old, flaps, piece, outer: BTreeSet::new() };
        for half_edges in edges {
            let [h] = *half_edges else { continue };
            let Some(edge) = cut.loose_edge_of(h / 3) else { continue };
            let Loose { ends, away, .. } = cut.loose[edge];
            let out = |v: u32| (cut.merged.positions[v as usize] - at(ends[0])).dot(away);
            let farthest = adjacency.ends(h).map(out).into_iter().fold(0.0, f64::max);
            if farthest > BEYOND * reach {
                cut.outer.insert(cut.piece[h as usize / 3]);
            }
        }
        Some(cut)
    }

    /// The face of the sheet, or the flap behind them, that one of the parts came from, and whether it was turned over.
    fn parent(&self, f: u32) -> Option<(usize, bool)> {
        self.merged.parents(f).first().map(|parent| (parent.face as usize, parent.reversed))
    }

    /// The loose edge whose flap a part is of.
    fn loose_edge_of(&self, f: u32) -> Option<usize> {
        self.flaps.get(self.parent(f)?.0.checked_sub(self.old)?).copied()
    }

    /// The loose edges with outer pieces that are more than what was drawn out: only ends stick out.
    fn sticking_out(&self) -> BTreeSet<usize> {
        // Of every outer piece, the areas of faces and of flaps, and whose these are.
        let mut of_piece: BTreeMap<u32, ([f64; 2], BTreeSet<usize>)> = BTreeMap::new();
        for (f, face) in (0u32..).zip(&self.merged.faces) {
            let piece = self.piece[f as usize];
            if !self.outer.contains(&piece) {
                continue;
            }
            let (areas, edges) = of_piece.entry(piece).or_default();
            let [a, b, c] = face.map(|v| self.merged.positions[v as usize]);
            let edge = self.loose_edge_of(f);
            areas[usize::from(edge.is_some())] += (b - a).cross(c - a).length();
            edges.extend(edge);
        }
        let bad = of_piece.into_values().filter(|([lost, drawn_out], _)| *lost > STICKS_OUT * drawn_out);
        bad.flat_map(|(_, edges)| edges).collect()
    }

    /// The sheet without what sticks out.
    fn sheet(&self, sheet: &Sheet) -> Sheet {
        let (faces, sources) = (Vec::new(), Vec::new());
        let mut made = Sheet { positions: self.merged.positions.clone(), faces, sources, ..sheet.clone() };
        for (f, &face) in (0u32..).zip(&self.merged.faces) {
            let Some((of, reversed)) =
                self.parent(f).filter(|_| !self.outer.contains(&self.piece[f as usize]))
            else {
                continue;
            };
            let of = self.loose_edge_of(f).map_or(of, |edge| self.loose[edge].face as usize);
            made.faces.push(if reversed { [face[0], face[2], face[1]] } else { face });
            made.sources.push(sheet.sources[of]);
        }
        made
    }

    /// The planes with faces that were cut or drawn out.
    fn planes(&self, sheet: &Sheet) -> BTreeSet<u32> {
        let mut parts = vec![0u32; self.old];
        self.flaps.iter().for_each(|edge| parts[self.loose[*edge].face as usize] += 1);
        for f in 0..self.merged.faces.len() as u32 {
            if let Some(parts) = self.parent(f).and_then(|(of, _)| parts.get_mut(of)) {
                *parts += 1;
            }
        }
        let number = |(parts, source): (&u32, &Source)| match source {
            Source::Plane(k) if *parts > 1 => Some(*k),
            _ => None,
        };
        parts.iter().zip(&sheet.sources).filter_map(number).collect()
    }
}

/// The mesh with a strip along every loose edge, and of which of these each face of them is; strips run out where borders end on something
/// else.
fn with_flaps(
    mut mesh: TriMesh,
    adjacency: &Adjacency,
    loose: &[Loose],
    width: f64,
) -> (TriMesh, Vec<usize>) {
    let edges = (0u32..).zip(adjacency.edges());
    let joints = edges.filter(|(e, _)| adjacency.half_edges(*e).len() > 2);
    let joined: BTreeSet<u32> = joints.flat_map(|(_, ends)| *ends).collect();
    let mut away: BTreeMap<u32, DVec3> = BTreeMap::new();
    for edge in loose {
        edge.ends.iter().for_each(|v| *away.entry(*v).or_default() += edge.away);
    }
    let mut outer: BTreeMap<u32, u32> = BTreeMap::new();
    for (v, away) in away {
        if !joined.contains(&v) {
            outer.insert(v, mesh.positions.len() as u32);
            mesh.positions.push(mesh.positions[v as usize] + away.normalize_or_zero() * width);
        }
    }
    let mut flaps = Vec::new();
    for (k, edge) in loose.iter().enumerate() {
        let [a, b] = edge.ends;
        let faces = match (outer.get(&a), outer.get(&b)) {
            (Some(&p), Some(&q)) => vec![[b, a, p], [b, p, q]],
            (Some(&p), None) => vec![[b, a, p]],
            (None, Some(&q)) => vec![[b, a, q]],
            (None, None) => continue,
        };
        flaps.extend(faces.iter().map(|_| k));
        mesh.faces.extend(faces);
    }
    (mesh, flaps)
}
