//! Which groups of the solid become which pieces of the mid-surface.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::assemble::Moved;
use super::cells::Cells;
use super::looks::Pair;
use super::middle::Middles;
use super::plane::Plane;
use super::segments::Segments;
use super::solid::Solid;
use super::straighten::WITHIN;
use super::walls::Walls;
use super::{DeflateOptions, Steps};

/// Sides of a wall whose normals differ by less than this are parallel.
const PARALLEL: f64 = 1e-4;
/// The thickness changes by this share along an edge of a wall with draft.
const EVEN: f64 = 0.0125;
/// Between walls whose normals differ by a sine of more than this are no steps.
const PARALLEL_LEVELS: f64 = 0.15;
/// Nodes are in a plane to this share of the solid's size.
const ROUNDING: f64 = 1e-6;
/// Strips narrower than this share of the thickness are no steps.
const STEP: f64 = 0.02;

/// Which groups are made into what.
pub(super) struct Plan {
    pub(super) planes: Vec<PlanePiece>,
    /// Curved groups.
    pub(super) curved: Vec<u32>,
}

/// Groups in one plane.
pub(super) struct PlanePiece {
    pub(super) plane: Plane,
    /// With whether each faces as the plane.
    pub(super) groups: Vec<(u32, bool)>,
    /// Whether it joins two middles where the thickness steps.
    pub(super) is_step: bool,
    /// How long edges may be so that the thickness is nearly even in every triangle; `None` where it is even.
    pub(super) cells: Option<Cells>,
    /// Directed edges about the piece, as its plane faces; if there are any, the borders of its groups do not count.
    pub(super) outline: Vec<[u32; 2]>,
}

impl PlanePiece {
    pub(super) fn new(plane: Plane, is_step: bool) -> Self {
        Self { plane, groups: Vec::new(), is_step, cells: None, outline: Vec::new() }
    }

    /// The directed edges about the piece, as its plane faces.
    pub(super) fn edges(&self, solid: &Solid, segments: &Segments, gone: &[bool]) -> Vec<[u32; 2]> {
        if !self.outline.is_empty() {
            return self.outline.clone();
        }
        let of_group = |(g, same): &(u32, bool)| {
            let same = *same;
            border(solid, segments, gone, *g).map(move |[a, b]| if same { [a, b] } else { [b, a] })
        };
        self.groups.iter().flat_map(of_group).collect()
    }
}

/// The directed edges of a group to other groups, but for those that are gone.
pub(super) fn border(
    solid: &Solid,
    segments: &Segments,
    gone: &[bool],
    g: u32,
) -> impl Iterator<Item = [u32; 2]> {
    let faces = &segments.group(g).faces;
    let sides = faces.iter().flat_map(|f| 3 * f..3 * f + 3);
    let beyond = move |h: &u32| segments.of(solid.across(*h));
    sides.filter(move |h| beyond(h) != g && !gone[beyond(h) as usize]).map(|h| solid.adjacency.ends(h))
}

/// Sorts the kept groups into plane pieces and curved ones; `terraces` are pieces of plates that are made already, steps and all.
/// O(groups · planes).
#[allow(clippy::too_many_arguments, reason = "one call, all of them what was found before")]
pub(super) fn plan(
    solid: &Solid,
    segments: &Segments,
    walls: &Walls,
    middles: &Middles,
    gone: &[bool],
    kept: &[bool],
    moved: &Moved,
    terraces: Vec<PlanePiece>,
    options: &DeflateOptions,
) -> Plan {
    let mut by_plane: BTreeMap<u32, PlanePiece> = BTreeMap::new();
    let mut curved = Vec::new();
    for g in (0..segments.groups.len() as u32).filter(|g| kept[*g as usize]) {
        let exact = middles.only(g).and_then(|plane| {
            let pair = walls.partners(g).iter().find_map(|p| middles.between(g, p.partner))?;
            Some((plane, pair.1))
        });
        match exact {
            Some((plane, number)) => {
                let shared = middles.mid_planes.plane(number);
                let piece = by_plane.entry(number);
                let piece = piece.or_insert_with(|| PlanePiece::new(shared, false));
                piece.groups.push((g, plane.normal.dot(shared.normal) > 0.0));
                let even = even_length(segments, walls, g);
                piece.cells = piece.cells.into_iter().chain(even).reduce(Cells::both);
            }
            None => curved.push(g),
        }
    }
    let level = level_sides(solid, segments, walls, middles, gone, kept, moved);
    for &(g, number, same) in &level {
        by_plane.entry(number).and_modify(|piece| piece.groups.push((g, same)));
    }
    let mut planes: Vec<PlanePiece> = by_plane.into_values().collect();
    // The piece faces as most of it did on the solid.
    for piece in &mut planes {
        let area = |(g, same): &(u32, bool)| if *same { 1.0 } else { -1.0 } * segments.group(*g).area;
        if piece.groups.iter().map(area).sum::<f64>() < 0.0 {
            piece.plane = piece.plane.flipped();
            piece.groups.iter_mut().for_each(|g| g.1 = !g.1);
        }
    }
    if options.steps != Steps::Apart {
        let terraced: BTreeSet<u32> = terraces.iter().flat_map(|piece| &piece.groups).map(|g| g.0).collect();
        let level: BTreeSet<u32> = level.iter().map(|side| side.0).collect();
        let steps = steps(solid, segments, walls, middles, gone, kept, &terraced, moved);
        planes.extend(steps.into_iter().filter(|step| !level.contains(&step.groups[0].0)));
        let round = round_steps(solid, segments, walls, gone, kept, moved);
        curved.extend(round.into_iter().filter(|g| !level.contains(g)));
    }
    planes.extend(terraces);
    Plan { planes, curved }
}

/// Sides of what is raised as much on both sides of a wall: all about them has one mid-plane, so they come to lie in it. With the number of the
/// plane, and whether they face as it does.
fn level_sides(
    solid: &Solid,
    segments: &Segments,
    walls: &Walls,
    middles: &Middles,
    gone: &[bool],
    kept: &[bool],
    moved: &Moved,
) -> Vec<(u32, u32, bool)> {
    let level = |g: u32| {
        if walls.is_wall[g as usize] || gone[g as usize] {
            return None;
        }
        let beside = beside(solid, segments, g);
        let is_flush = |f: &u32| solid.mesh.faces[*f as usize].iter().any(|v| moved.flush[*v as usize]);
        if is_end(walls, &beside, kept) || segments.group(g).faces.iter().any(is_flush) {
            return None;
        }
        let mut of_kept = beside.iter().filter(|o| kept[**o as usize]).map(|o| {
            let middle = middles.only(*o)?;
            let (_, number) = walls.partners(*o).iter().find_map(|p| middles.between(*o, p.partner))?;
            Some((number, middle.normal.dot(middles.mid_planes.plane(number).normal) > 0.0))
        });
        let first = of_kept.next()??;
        let mut others = of_kept.peekable();
        others.peek()?;
        let plane = middles.mid_planes.plane(first.0);
        let tolerance = (ROUNDING * solid.size).max(WITHIN * solid.rounding);
        let is_in_it = |v: u32| plane.height(moved.positions[v as usize]).abs() < tolerance;
        // A bead that runs across a plate arches out of it at its ends.
        let is_level = || border(solid, segments, gone, g).all(|edge| edge.into_iter().all(is_in_it));
        (others.all(|other| other == Some(first)) && is_level()).then_some((g, first.0, first.1))
    };
    (0..segments.groups.len() as u32).filter_map(level).collect()
}

/// The groups that have edges with a group, itself too.
fn beside(solid: &Solid, segments: &Segments, g: u32) -> BTreeSet<u32> {
    let sides = segments.group(g).faces.iter().flat_map(|f| 3 * f..3 * f + 3);
    sides.map(|h| segments.of(solid.across(h))).collect()
}

/// How long edges may be in a wall whose sides are not parallel.
fn even_length(segments: &Segments, walls: &Walls, g: u32) -> Option<Cells> {
    let own = segments.group(g).plane?;
    let of_pair = |p: &Pair| {
        let slope = own.normal + segments.group(p.partner).plane?.normal;
        let cells = Cells::in_strips(EVEN * p.thickness / slope.length(), slope);
        (slope.length() > PARALLEL).then_some(cells)
    };
    walls.partners(g).iter().filter_map(of_pair).reduce(Cells::both)
}

/// Faces without a partner that stand between two middles: where the thickness steps.
#[allow(clippy::too_many_arguments, reason = "one call, all of them what was found before")]
fn steps(
    solid: &Solid,
    segments: &Segments,
    walls: &Walls,
    middles: &Middles,
    gone: &[bool],
    kept: &[bool],
    terraced: &BTreeSet<u32>,
    moved: &Moved,
) -> Vec<PlanePiece> {
    let Moved { positions: moved, flush, .. } = moved;
    let mut found = Vec::new();
    for (g, group) in (0u32..).zip(&segments.groups) {
        let Some(plane) = group.plane.filter(|_| !walls.is_wall[g as usize] && !gone[g as usize]) else {
            continue;
        };
        let mut beside = beside(solid, segments, g);
        // Round ends that run into it have nodes that stay where they are, and so have lumps at the ends of walls.
        let is_round = |o: &u32| segments.group(*o).plane.is_none() && !walls.is_wall[*o as usize];
        // The steps of plates that step on both sides are made already; the end of other walls may be one of them.
        let is_terraced = beside.iter().any(|o| terraced.contains(o));
        let is_level = !has_levels(segments, middles, &beside, kept);
        let may_be_end = is_terraced || beside.iter().any(is_round) || is_level;
        let is_end = may_be_end && is_end(walls, &beside, kept);
        beside.retain(|o| kept[*o as usize]);
        // From the edge of a wall to the middle of what that is flush with, it is the end of the latter.
        let is_flush =
            || group.faces.iter().any(|f| solid.mesh.faces[*f as usize].iter().any(|v| flush[*v as usize]));
        if beside.len() < 2 || is_end || is_level && is_flush() {
            continue;
        }
        // Twice the area that is left, and its outline.
        let (mut area, mut length, mut longest) = (DVec3::ZERO, 0.0, 0.0f64);
        let origin = moved[solid.mesh.faces[group.faces[0] as usize][0] as usize];
        for [a, b] in border(solid, segments, gone, g) {
            let (p, q) = (moved[a as usize] - origin, moved[b as usize] - origin);
            area += p.cross(q);
            length += p.distance(q);
            longest = longest.max(p.length());
        }
        let area = area.dot(plane.normal).abs() / 2.0;
        let width = 2.0 * area / length.max(f64::MIN_POSITIVE);
        let thin =
            beside.iter().flat_map(|b| walls.partners(*b)).map(|p| p.thickness).fold(f64::MAX, f64::min);
        if width > STEP * thin && width < walls.max_thickness && width < 0.5 * longest {
            let origin = moved_plane(solid, segments, gone, g, moved, plane);
            found.push(PlanePiece { groups: vec![(g, true)], ..PlanePiece::new(origin, true) });
        }
    }
    found
}

/// Whether two of some kept groups are parallel and may have different middles.
fn has_levels(segments: &Segments, middles: &Middles, beside: &BTreeSet<u32>, kept: &[bool]) -> bool {
    let of = |g: &u32| segments.group(*g).plane.zip(middles.only(*g));
    let walls: Vec<_> = beside.iter().filter(|g| kept[**g as usize]).map(of).collect();
    let differ = |a: &Option<(Plane, Plane)>, b: &Option<(Plane, Plane)>| match (a, b) {
        (Some((own, middle)), Some((other, other_middle))) => {
            own.normal.cross(other.normal).length() < PARALLEL_LEVELS
                && middle != other_middle
                && *middle != other_middle.flipped()
        }
        _ => true,
    };
    (1..walls.len()).any(|k| walls[..k].iter().any(|a| differ(a, &walls[k])))
}

/// Whether a face beside some groups is the end of all walls there: what reaches from a wall to its partner is the end of both.
fn is_end(walls: &Walls, beside: &BTreeSet<u32>, kept: &[bool]) -> bool {
    let ends = |o: &u32| walls.partners(*o).iter().any(|p| beside.contains(&p.partner));
    beside.iter().filter(|o| kept[**o as usize]).all(ends)
}

/// Curved faces without a partner that stand between two middles: the side of a blind hole.
fn round_steps(
    solid: &Solid,
    segments: &Segments,
    walls: &Walls,
    gone: &[bool],
    kept: &[bool],
    moved: &Moved,
) -> Vec<u32> {
    let Moved { positions: moved, blended, .. } = moved;
    let is_step = |g: &u32| {
        let group = segments.group(*g);
        let is_blend =
            || group.faces.iter().flat_map(|f| solid.mesh.faces[*f as usize]).any(|v| blended[v as usize]);
        if group.plane.is_some() || walls.is_wall[*g as usize] || gone[*g as usize] || is_blend() {
            return false;
        }
        let mut beside = beside(solid, segments, *g);
        if is_end(walls, &beside, kept) {
            return false;
        }
        beside.retain(|o| kept[*o as usize]);
        let length: f64 = border(solid, segments, gone, *g)
            .map(|[a, b]| moved[a as usize].distance(moved[b as usize]))
            .sum();
        let area = |f: &u32| {
            let [a, b, c] = solid.mesh.faces[*f as usize].map(|v| moved[v as usize]);
            (b - a).cross(c - a).length() / 2.0
        };
        let width = 2.0 * group.faces.iter().map(area).sum::<f64>() / length.max(f64::MIN_POSITIVE);
        let thin =
            beside.iter().flat_map(|b| walls.partners(*b)).map(|p| p.thickness).fold(f64::MAX, f64::min);
        beside.len() > 1 && width > STEP * thin && width < walls.max_thickness
    };
    (0..segments.groups.len() as u32).filter(is_step).collect()
}

/// The plane of a step stays where it was: its nodes move within it.
fn moved_plane(
    solid: &Solid,
    segments: &Segments,
    gone: &[bool],
    g: u32,
    moved: &[DVec3],
    plane: Plane,
) -> Plane {
    let nodes: Vec<f64> =
        border(solid, segments, gone, g).map(|[a, _]| plane.normal.dot(moved[a as usize])).collect();
    Plane { offset: nodes.iter().sum::<f64>() / nodes.len().max(1) as f64, ..plane }
}
