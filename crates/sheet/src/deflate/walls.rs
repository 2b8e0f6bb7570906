//! Which groups are walls, and which groups lie opposite to each other (Sheen et al. 2008, section 6.1).

use glam::DVec3;
use rayon::prelude::*;

use super::DeflateOptions;
use super::ends::{Borders, ends_of_thinner_walls, sides_of_low_things};
use super::looks::{Look, Looks, Pair, mean_thickness, partners_in};
use super::segments::Segments;
use super::solid::{SHARP, Solid};

/// Facets of curved walls that lie opposite to each other may be inclined by this much, in radians: both are chords.
pub(super) const FACET_LEAN: f64 = 35.0 / 180.0 * std::f64::consts::PI;
/// A group is a wall if this share of it has a partner; a curved one, a fillet's sides of which look at walls by chance,
/// needs more.
const PAIRED_PLANE: f64 = 0.3;
const PAIRED_CURVED: f64 = 0.6;
/// Walls are thicker than this share of what walls are on the whole.
const HAIR: f64 = 0.03;
/// Walls are wider than this share of it.
const TRIFLE: f64 = 0.3;
/// Neighbours are as thick if they are by this share.
const ALIKE: f64 = 0.1;
/// Rays begin this far inside, over the solid's size.
const START: f64 = 1e-9;

/// What is opposite to a point of the skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Opposite {
    /// The face there.
    pub(super) face: u32,
    /// How far through the material, in mm.
    pub(super) distance: f64,
}

/// What is seen from a point of a wall's face into the material.
#[derive(Clone, Copy, Debug)]
pub(super) struct Through {
    /// The face.
    pub(super) face: u32,
    /// The point.
    pub(super) from: DVec3,
    /// How far the other side of the wall is, in mm; `None` where there is none.
    pub(super) thickness: Option<f64>,
    /// Whether there is material for more than walls are thick.
    pub(super) is_thick: bool,
    /// The area that it stands for, in mm².
    pub(super) area: f64,
}

/// The walls of a solid.
#[derive(Debug)]
pub(super) struct Walls {
    casts: Vec<Cast>,
    /// The first cast of every face; the others follow.
    firsts: Vec<u32>,
    /// Walls are thinner than this, in mm.
    pub(super) max_thickness: f64,
    max_draft: f64,
    /// Ordered by group, then by partner.
    pub(super) pairs: Vec<Pair>,
    /// Whether each group is a wall.
    pub(super) is_wall: Vec<bool>,
    /// Whether the skin is proud about each face: its smooth edges bend away from each other.
    pub(super) is_proud: Vec<bool>,
    /// Share of the skin that has a partner.
    pub(super) paired_share: f64,
}

/// A ray into the material from a point of a face, for a part of its area in mm².
#[derive(Debug)]
struct Cast {
    face: u32,
    area: f64,
    hit: Option<Opposite>,
}

impl Walls {
    /// Looks through the material from everywhere. O(n log n).
    pub(super) fn new(solid: &Solid, segments: &Segments, options: &DeflateOptions) -> Self {
        let mut walls = Self {
            casts: Vec::new(),
            firsts: vec![0; solid.len() as usize],
            max_thickness: f64::INFINITY,
            max_draft: options.max_draft,
            pairs: Vec::new(),
            is_wall: Vec::new(),
            is_proud: is_proud(solid),
            paired_share: 0.0,
        };
        let cell = solid.areas.iter().sum::<f64>() / SAMPLES;
        let rows = |f: u32| ((solid.areas[f as usize] / cell).sqrt().ceil() as u32).clamp(1, MOST_ROWS);
        let cast = |f: u32| {
            let (rows, normal) = (rows(f), solid.normals[f as usize]);
            let area = solid.areas[f as usize] / f64::from(rows * rows);
            let walls = &walls;
            spread(solid.mesh.corners(f), rows).map(move |p| Cast {
                face: f,
                area,
                hit: walls.first(solid, p, -normal),
            })
        };
        let faces: Vec<u32> = solid.caster.faces().collect();
        let casts = faces.par_iter().flat_map_iter(|f| cast(*f)).collect();
        walls.casts = casts;
        let mut at = 0;
        for f in faces {
            walls.firsts[f as usize] = at;
            at += rows(f).pow(2);
        }
        walls.pair(solid, segments, options);
        walls
    }

    /// Finds walls and pairs anew for other groups. O(n log n).
    pub(super) fn pair(&mut self, solid: &Solid, segments: &Segments, options: &DeflateOptions) {
        let walls = self;
        let total: f64 = solid.areas.iter().sum();
        let look = |cast: &Cast| {
            let hit = cast.hit.filter(|hit| walls.faces_back(solid, segments, cast.face, hit.face))?;
            let [group, partner] = [cast.face, hit.face].map(|f| segments.of(f));
            Some(Look { group, partner, thickness: hit.distance, area: cast.area })
        };
        let (mut looks, borders) = rayon::join(
            || Looks::new(walls.casts.par_iter().filter_map(look).collect()),
            || Borders::new(solid, segments),
        );
        let told = || looks.told_thickness(solid, segments, &borders);
        walls.max_thickness = options.max_thickness.unwrap_or_else(told);
        looks.retain_within(walls.max_thickness);
        // An empty sum is a negative zero.
        walls.paired_share = looks.area().max(0.0) / total + 0.0;
        walls.pairs = looks.pairs();
        let thick: Vec<Option<f64>> = (0..segments.groups.len() as u32)
            .map(|g| {
                let group = segments.group(g);
                let least = if group.plane.is_some() { PAIRED_PLANE } else { PAIRED_CURVED };
                let partners = walls.partners(g);
                let paired: f64 = partners.iter().map(|p| p.area).sum();
                mean_thickness(partners).filter(|_| paired >= least * group.area)
            })
            .collect();
        let walled = || thick.iter().zip(&segments.groups).filter_map(|(t, g)| t.map(|t| (t, g.area)));
        let typical = walled().map(|(t, a)| t * a).sum::<f64>() / walled().map(|(_, a)| a).sum::<f64>();
        // Splinters of a hair's thickness are left where meshes were cut; they are no walls.
        let thick: Vec<Option<f64>> = thick.into_iter().map(|t| t.filter(|t| *t > HAIR * typical)).collect();
        walls.is_wall = thick.iter().map(Option::is_some).collect();
        for (g, group) in (0u32..).zip(&segments.groups) {
            let Some(own) = thick[g as usize] else { continue };
            // What is not even as wide as it is thick is the end of something, unless it goes on in a wall that is as thick.
            let width = own.max(TRIFLE * typical);
            if group.area <= width * width {
                let alike = |other: f64| (other - own).abs() < ALIKE * own;
                let mut beside = sides(segments, g).map(|h| segments.of(solid.across(h)));
                walls.is_wall[g as usize] = beside.any(|o| o != g && thick[o as usize].is_some_and(alike));
            }
        }
        let ends = ends_of_thinner_walls(segments, &borders, &walls.pairs, &thick);
        for g in sides_of_low_things(segments, &borders, &thick).into_iter().chain(ends) {
            walls.is_wall[g as usize] = false;
        }
        // Who is no wall is nobody's partner.
        let is_wall = &walls.is_wall;
        walls.pairs.retain(|p| is_wall[p.group as usize] && is_wall[p.partner as usize]);
    }

    /// The pairs that begin with a group.
    pub(super) fn partners(&self, group: u32) -> &[Pair] {
        partners_in(&self.pairs, group)
    }

    /// What is opposite to a point of a face, if it is near enough and looks back.
    pub(super) fn opposite(&self, solid: &Solid, segments: &Segments, f: u32, p: DVec3) -> Option<Opposite> {
        let inward = -solid.normals[f as usize];
        let hit = solid.caster.first(p, inward, START * solid.size, self.max_thickness)?;
        self.faces_back(solid, segments, f, hit.face)
            .then_some(Opposite { face: hit.face, distance: hit.distance })
    }

    /// What is opposite to the middle of a face, if it is near enough and looks back.
    pub(super) fn opposite_middle(&self, solid: &Solid, segments: &Segments, f: u32) -> Option<Opposite> {
        self.behind(solid, f).filter(|hit| self.faces_back(solid, segments, f, hit.face))
    }

    /// The first thing met through the material from the middle of a face.
    pub(super) fn behind(&self, solid: &Solid, f: u32) -> Option<Opposite> {
        match &self.casts[self.firsts[f as usize] as usize..] {
            [_, next, ..] if next.face == f => {
                self.first(solid, solid.centroid(f), -solid.normals[f as usize])
            }
            // A face that was looked through once was so from its middle.
            [cast, ..] => cast.hit.filter(|hit| hit.distance <= self.max_thickness),
            [] => None,
        }
    }

    /// Looks from a face into the material.
    pub(super) fn looks<'a>(
        &'a self,
        solid: &'a Solid,
        segments: &'a Segments,
        f: u32,
    ) -> impl Iterator<Item = Through> + 'a {
        let casts = &self.casts[self.firsts[f as usize] as usize..];
        let casts = casts.iter().take_while(move |cast| cast.face == f);
        let rows = casts.clone().count().isqrt() as u32;
        let through = move |(from, cast): (DVec3, &Cast)| {
            let hit = cast.hit.filter(|hit| hit.distance <= self.max_thickness);
            let faces = |hit: &Opposite| {
                self.is_wall[segments.of(hit.face) as usize] && self.faces_back(solid, segments, f, hit.face)
            };
            let thickness = hit.filter(faces).map(|hit| hit.distance);
            Through { face: f, from, thickness, is_thick: hit.is_none(), area: cast.area }
        };
        spread(solid.mesh.corners(f), rows).zip(casts).map(through)
    }

    /// Whether a face that is seen from another one through the material faces it.
    fn faces_back(&self, solid: &Solid, segments: &Segments, f: u32, seen: u32) -> bool {
        let is_plane = [f, seen].map(|f| segments.group(segments.of(f)).plane.is_some());
        let lean = match is_plane {
            [false, false] => FACET_LEAN,
            // What is round outside of a corner has walls opposite; a fillet looks at one by chance.
            [false, true] if self.is_proud[f as usize] => FACET_LEAN,
            [true, false] if self.is_proud[seen as usize] => FACET_LEAN,
            // Both lean by half of the draft; a curved face next to a plane one is seen through its chords.
            _ => self.max_draft.max(SMALLEST_LEAN),
        };
        solid.normals[seen as usize].dot(-solid.normals[f as usize]) >= lean.cos()
    }

    /// The first thing met from a point in a direction, within the largest thickness.
    pub(super) fn first(&self, solid: &Solid, p: DVec3, direction: DVec3) -> Option<Opposite> {
        let hit = solid.caster.first(p, direction, START * solid.size, self.max_thickness)?;
        Some(Opposite { face: hit.face, distance: hit.distance })
    }
}

fn sides(segments: &Segments, g: u32) -> impl Iterator<Item = u32> {
    segments.group(g).faces.iter().flat_map(|f| 3 * f..3 * f + 3)
}

/// Whether smooth edges about each face bend away from each other on the whole. O(n).
fn is_proud(solid: &Solid) -> Vec<bool> {
    let bend = |h: u32| if solid.fold_cosine(h) > SHARP.cos() { solid.bend(h) } else { 0.0 };
    (0..solid.len()).into_par_iter().map(|f| (3 * f..3 * f + 3).map(bend).sum::<f64>() > 0.0).collect()
}

/// About how many looks there are in all, beside one a face.
const SAMPLES: f64 = 4000.0;
/// A face is looked through from at most the square of this many points.
const MOST_ROWS: u32 = 32;
/// Planes that lean less than this are parallel: files round.
const SMALLEST_LEAN: f64 = 1e-3;

/// The middles of the n² parts of a triangle that equal divisions of the sides make.
pub(super) fn spread([a, b, c]: [DVec3; 3], n: u32) -> impl Iterator<Item = DVec3> {
    let step = 1.0 / f64::from(n);
    let at = move |u: f64, v: f64| a + (b - a) * (u * step) + (c - a) * (v * step);
    let cells = (0..n).flat_map(move |i| (0..n - i).map(move |j| (i, j)));
    cells.flat_map(move |(i, j)| {
        let shifts = if i + j + 1 < n { &[1.0 / 3.0, 2.0 / 3.0][..] } else { &[1.0 / 3.0] };
        shifts.iter().map(move |shift| at(f64::from(i) + shift, f64::from(j) + shift))
    })
}
