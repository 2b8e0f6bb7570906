//! Which groups are walls, and which groups lie opposite to each other (Sheen et al. 2008, section 6.1).

use std::collections::BTreeMap;

use glam::DVec3;
use rayon::prelude::*;

use super::DeflateOptions;
use super::regions::width;
use super::segments::Segments;
use super::solid::{SHARP, Solid};

/// Facets of curved walls that lie opposite to each other may be inclined by this much, in radians: both are chords.
pub(super) const FACET_LEAN: f64 = 35.0 / 180.0 * std::f64::consts::PI;
/// A group is a wall if this share of it has a partner; a curved one, a fillet's sides of which look at walls by chance,
/// needs more.
const PAIRED_PLANE: f64 = 0.3;
const PAIRED_CURVED: f64 = 0.6;
/// Thicknesses of one part differ from one to the next by no more than this factor; what is beyond is not thickness but
/// the part's extent.
const THICKNESS_GAP: f64 = 2.5;
/// Where this share of all is thinner, a smaller factor is enough: the rest is lumps and heights of ribs.
const NEARLY_ALL: f64 = 0.9;
const SMALL_GAP: f64 = 1.6;
/// What is broad tells the thickness if it has more than this share of what looks at something.
const BROAD: f64 = 0.4;
/// A thickness told from the solid is no more than this share of how far its walls reach.
const SLENDER: f64 = 0.35;
/// A wall is a plate whatever the others are if it has this share of the skin, is less thick than this share of its width,
/// and evenly so up to this share.
const PLATE: f64 = 0.02;
const FLAT: f64 = 0.2;
const PLATE_ALIKE: f64 = 0.2;
/// Walls are thicker than this share of what walls are on the whole.
const HAIR: f64 = 0.03;
/// Walls are wider than this share of it.
const TRIFLE: f64 = 0.3;
/// A strip that is narrower than this share of its thickness is no wall.
const NARROW: f64 = 0.5;
/// What is thinner than this share of what its end would be as a wall ends there.
const THINNER: f64 = 0.9;
/// Or than so many times that, if its faces are so many times larger than the end: of a bar, those sides that go on in a plate are the wall.
const GOES_ON_AS: f64 = 2.0;
const LARGER: f64 = 3.0;
/// More than this share of an end's outline is on both sides of the wall that ends.
const MOST_OF: f64 = 0.6;
/// An end is no wider than this many times the thickness of that wall.
const AS_WIDE: f64 = 1.2;
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

/// Two groups that lie opposite to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pair {
    /// The group that was looked from.
    pub(super) group: u32,
    /// The one that was seen.
    pub(super) partner: u32,
    /// Area of `group` from which `partner` is seen, in mm².
    pub(super) area: f64,
    /// Mean distance in mm.
    pub(super) thickness: f64,
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

/// A look through the material from a point of a face.
struct Look {
    group: u32,
    area: f64,
    seen: Option<(u32, f64)>,
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
        let look = |cast: &Cast| Look {
            group: segments.of(cast.face),
            area: cast.area,
            seen: cast
                .hit
                .filter(|hit| walls.faces_back(solid, segments, cast.face, hit.face))
                .map(|hit| (segments.of(hit.face), hit.distance)),
        };
        let mut looks: Vec<Look> = walls.casts.par_iter().map(look).collect();
        walls.max_thickness = options.max_thickness.unwrap_or_else(|| {
            let told = told_thickness(&broad(solid, segments, &looks), total);
            thick_plates(solid, segments, &looks, total).into_iter().fold(told, f64::max)
        });
        for look in &mut looks {
            look.seen = look.seen.filter(|(_, s)| *s <= walls.max_thickness);
        }
        let paired: f64 = looks.iter().filter(|l| l.seen.is_some()).map(|l| l.area).sum();
        // An empty sum is a negative zero.
        walls.paired_share = paired.max(0.0) / total + 0.0;
        walls.pairs = pairs_of(&looks);
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
        let ends = ends_of_thinner_walls(solid, segments, &walls.pairs, &thick);
        for g in sides_of_low_things(solid, segments, &thick).into_iter().chain(ends) {
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

/// Groups with a thickness that are narrow strips and do not run into anything wider, not even over other strips: the sides of embossed
/// letters. O(n).
fn sides_of_low_things(solid: &Solid, segments: &Segments, thick: &[Option<f64>]) -> Vec<u32> {
    let beside = |h: u32| segments.of(solid.across(h));
    let is_narrow = |(g, thick): (u32, &Option<f64>)| {
        let outline: f64 = sides(segments, g).filter(|h| beside(*h) != g).map(|h| solid.length(h)).sum();
        thick.is_some_and(|thick| 2.0 * segments.group(g).area < NARROW * thick * outline)
    };
    let mut is_side: Vec<bool> = (0..).zip(thick).map(is_narrow).collect();
    let wide = |g: &u32| thick[*g as usize].is_some() && !is_side[*g as usize];
    let mut stack: Vec<u32> = (0..thick.len() as u32).filter(wide).collect();
    while let Some(g) = stack.pop() {
        for other in sides(segments, g).filter(|h| solid.fold_cosine(*h) > SHARP.cos()).map(beside) {
            if std::mem::replace(&mut is_side[other as usize], false) {
                stack.push(other);
            }
        }
    }
    (0..thick.len() as u32).filter(|g| is_side[*g as usize]).collect()
}

/// Groups that are the ends of thinner walls, even if they have a partner: the sides of slats that are wider than thick. What is about
/// both of them, across sharp edges that stick out, lies opposite to each other. O(n log n).
fn ends_of_thinner_walls(
    solid: &Solid,
    segments: &Segments,
    pairs: &[Pair],
    thick: &[Option<f64>],
) -> Vec<u32> {
    // How long the outline of a group is, and its sharp borders that stick out, by the group beyond.
    let about = |g: u32| {
        let (mut outline, mut about) = (0.0, BTreeMap::new());
        for h in sides(segments, g) {
            let other = segments.of(solid.across(h));
            if other != g {
                outline += solid.length(h);
                if solid.fold_cosine(h) < SHARP.cos() && solid.is_convex(h) {
                    *about.entry(other).or_insert(0.0) += solid.length(h);
                }
            }
        }
        (outline, about)
    };
    let surroundings: Vec<(f64, BTreeMap<u32, f64>)> =
        (0..thick.len() as u32).into_par_iter().map(about).collect();
    let is_end = |(g, own): (u32, f64)| {
        let (outline, beside) = &surroundings[g as usize];
        let area = segments.group(g).area;
        // How thick the wall is that ends here at what is beside, with its other side among `others`.
        let ending = |o: u32, others: &dyn Fn(u32) -> bool| {
            let is_larger = segments.group(o).area > LARGER * area;
            let thinner = if is_larger { GOES_ON_AS } else { THINNER } * own;
            let found = partners_in(pairs, o).iter().find(|p| p.thickness < thinner && others(p.partner));
            found.map(|p| p.thickness)
        };
        let ends = |counts: &dyn Fn(u32) -> bool| {
            let ending = beside.iter().filter(|(o, _)| counts(**o)).filter_map(|(o, length)| {
                Some((*length, ending(*o, &|other| counts(other) && beside.contains_key(&other))?))
            });
            // Both sides of the wall are counted. An end is as wide as the wall is thick; what has many holes is not.
            let (along, reach) =
                ending.fold((0.0, 0.0), |(l, r), (length, thick)| (l + length, r + length * thick / 2.0));
            along > MOST_OF * outline && area < AS_WIDE * reach
        };
        ends(&|_| true) && {
            let main = partners_in(pairs, g).iter().max_by(|p, q| p.area.total_cmp(&q.area));
            main.is_some_and(|p| ends(&|o| surroundings[p.partner as usize].1.contains_key(&o)))
        }
    };
    let walled = (0..).zip(thick).filter_map(|(g, t)| Some((g, (*t)?)));
    walled.filter(|wall| is_end(*wall)).map(|(g, _)| g).collect()
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

/// Thicknesses and areas of looks from what is no end of a wall and no side of something low, the thinnest first. Where hardly anything
/// else is, as in a block, from everywhere.
fn broad(solid: &Solid, segments: &Segments, looks: &[Look]) -> Vec<(f64, f64)> {
    let pairs = pairs_of(looks);
    let thick: Vec<Option<f64>> =
        (0..segments.groups.len() as u32).map(|g| mean_thickness(partners_in(&pairs, g))).collect();
    let mut is_broad = vec![true; thick.len()];
    let ends = ends_of_thinner_walls(solid, segments, &pairs, &thick);
    for g in sides_of_low_things(solid, segments, &thick).into_iter().chain(ends) {
        is_broad[g as usize] = false;
    }
    let seen = |look: &Look| Some((look.seen?.1, look.area));
    let area = |seen: &[(f64, f64)]| seen.iter().map(|s| s.1).sum::<f64>();
    let all: Vec<(f64, f64)> = looks.iter().filter_map(seen).collect();
    let broad: Vec<(f64, f64)> =
        looks.iter().filter(|l| is_broad[l.group as usize]).filter_map(seen).collect();
    let mut seen = if area(&broad) > BROAD * area(&all) { broad } else { all };
    seen.par_sort_by(|a, b| a.0.total_cmp(&b.0));
    seen
}

/// The largest thickness, told from looks and their areas: the median one, and what follows on it without a gap.
fn told_thickness(seen: &[(f64, f64)], area: f64) -> f64 {
    let all: f64 = seen.iter().map(|s| s.1).sum();
    let (mut sum, mut largest) = (0.0, 0.0);
    for (thickness, part) in seen {
        let gap = if sum >= NEARLY_ALL * all { SMALL_GAP } else { THICKNESS_GAP };
        if sum >= 0.4 * all && *thickness > gap * largest {
            break;
        }
        largest = *thickness;
        sum += part;
    }
    // Walls that are seen from both sides cover half of the skin.
    (1.02 * largest).min(SLENDER * (area / 2.0).sqrt())
}

/// How thick walls are that are much broader than thick, evenly so, and not just a trifle of the skin, whatever the rest is: the base
/// below thin fins, the thick end of a tube, a plate that forks.
fn thick_plates(solid: &Solid, segments: &Segments, looks: &[Look], area: f64) -> Vec<f64> {
    let mut seen: Vec<(u32, u32, f64, f64)> = looks
        .iter()
        .filter_map(|l| {
            let (partner, thickness) = l.seen?;
            (l.group != partner).then_some((l.group, partner, thickness, l.area))
        })
        .collect();
    seen.sort_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2)));
    let wide = |g: u32| width(solid, &segments.group(g).faces);
    // Most of a group, or what two have of each other; `of` is its area, `broad` how wide it is.
    let plate = |run: &[(u32, u32, f64, f64)], of: f64, broad: &dyn Fn() -> f64| {
        let all: f64 = run.iter().map(|r| r.3).sum();
        let mut sum = 0.0;
        let middle = run.iter().find(|r| {
            sum += r.3;
            sum >= all / 2.0
        })?;
        let alike = run.iter().filter(|r| (r.2 - middle.2).abs() < PLATE_ALIKE * middle.2);
        let is_plate = of >= PLATE * area
            && middle.2 < FLAT * of.sqrt().min(broad())
            && alike.map(|r| r.3).sum::<f64>() >= 0.5 * of;
        is_plate.then_some(1.02 * middle.2)
    };
    let area_of = |run: &[(u32, u32, f64, f64)]| run.iter().map(|r| r.3).sum::<f64>();
    let of_pairs = seen
        .chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))
        .filter_map(|run| plate(run, area_of(run), &|| wide(run[0].0).min(wide(run[0].1))));
    let mut plates: Vec<f64> = of_pairs.collect();
    seen.sort_by(|a, b| a.0.cmp(&b.0).then(a.2.total_cmp(&b.2)));
    let of_groups = seen.chunk_by(|a, b| a.0 == b.0);
    plates.extend(of_groups.filter_map(|run| plate(run, segments.group(run[0].0).area, &|| wide(run[0].0))));
    plates
}

/// The pairs that begin with a group, of pairs that are ordered by it.
fn partners_in(pairs: &[Pair], group: u32) -> &[Pair] {
    let from = pairs.partition_point(|p| p.group < group);
    let to = pairs.partition_point(|p| p.group <= group);
    &pairs[from..to]
}

/// The mean thickness of pairs, by area; `None` if they have none.
pub(super) fn mean_thickness(pairs: &[Pair]) -> Option<f64> {
    let area: f64 = pairs.iter().map(|p| p.area).sum();
    (area > 0.0).then(|| pairs.iter().map(|p| p.area * p.thickness).sum::<f64>() / area)
}

/// The pairs that some looks make, ordered by group, then by partner.
fn pairs_of(looks: &[Look]) -> Vec<Pair> {
    let mut seen: Vec<(u32, u32, f64, f64)> =
        looks.iter().filter_map(|l| l.seen.map(|(partner, s)| (l.group, partner, l.area, s))).collect();
    seen.par_sort_by_key(|s| (s.0, s.1));
    let same = |a: &(u32, u32, f64, f64), b: &(u32, u32, f64, f64)| (a.0, a.1) == (b.0, b.1);
    let pair = |run: &[(u32, u32, f64, f64)]| {
        let area: f64 = run.iter().map(|r| r.2).sum();
        let thickness = run.iter().map(|r| r.2 * r.3).sum::<f64>() / area.max(f64::MIN_POSITIVE);
        Pair { group: run[0].0, partner: run[0].1, area, thickness }
    };
    seen.chunk_by(same).map(pair).collect()
}
