//! Which groups are walls, and which groups lie opposite to each other (Sheen et al. 2008, section 6.1).

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use rayon::prelude::*;

use super::DeflateOptions;
use super::faces::{Face, Faces};
use super::report::WallPair;
use super::segments::{SHARP, Segments, width};
use super::shape::Shape;
use super::solid::Solid;

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
/// A thickness told from the solid is no more than this share of how far its walls reach.
const SLENDER: f64 = 0.35;
/// A plane wall is a plate whatever the others are if it has this share of the skin, is less thick than this share of its width,
/// and evenly so up to this share.
const PLATE: f64 = 0.02;
const FLAT: f64 = 0.2;
const PLATE_ALIKE: f64 = 0.2;
/// A flare meets the wall that it runs into at less than this, in radians.
const OBLIQUE: f64 = 70.0 / 180.0 * std::f64::consts::PI;
/// Facets lean by no more than the folds about them and this, in radians, where their walls are parallel.
const FLARE: f64 = 5.0 / 180.0 * std::f64::consts::PI;
/// A rim turns away from its walls until the cosine to the direction away from them is this.
const TURNED: f64 = 0.5;
/// Faces belong to a rim if they are within this share of the thickness of it.
const RIM: f64 = 0.1;
/// Looks beside a border begin this share of the way from it to the middle of the face.
const INSET: f64 = 0.05;
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
            let told = told_thickness(&looks, total);
            thick_plates(solid, segments, &looks, total).fold(told, f64::max)
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
                let thick = partners.iter().map(|p| p.area * p.thickness).sum::<f64>() / paired;
                (paired > 0.0 && paired >= least * group.area).then_some(thick)
            })
            .collect();
        let walled = || thick.iter().zip(&segments.groups).filter_map(|(t, g)| t.map(|t| (t, g.area)));
        let typical = walled().map(|(t, a)| t * a).sum::<f64>() / walled().map(|(_, a)| a).sum::<f64>();
        // Splinters of a hair's thickness are left where meshes were cut; they are no walls.
        let thick: Vec<Option<f64>> = thick.into_iter().map(|t| t.filter(|t| *t > HAIR * typical)).collect();
        walls.is_wall = thick.iter().map(Option::is_some).collect();
        for (g, group) in (0u32..).zip(&segments.groups) {
            // What is not even as wide as it is thick is the end of something, unless it goes on in a wall that is as thick.
            let width = |t: f64| t.max(TRIFLE * typical);
            let Some(own) = thick[g as usize].filter(|t| group.area <= width(*t) * width(*t)) else {
                continue;
            };
            let mut beside =
                group.faces.iter().flat_map(|f| 3 * f..3 * f + 3).map(|h| segments.of(solid.across(h)));
            let alike = |other: f64| (other - own).abs() < ALIKE * own;
            walls.is_wall[g as usize] = beside.any(|o| o != g && thick[o as usize].is_some_and(alike));
        }
        // Who is no wall is nobody's partner.
        let is_wall = &walls.is_wall;
        walls.pairs.retain(|p| is_wall[p.group as usize] && is_wall[p.partner as usize]);
    }

    /// The pairs that begin with a group.
    pub(super) fn partners(&self, group: u32) -> &[Pair] {
        let from = self.pairs.partition_point(|p| p.group < group);
        let to = self.pairs.partition_point(|p| p.group <= group);
        &self.pairs[from..to]
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
        let planes = [f, seen].map(|f| segments.group(segments.of(f)).plane);
        let lean = if planes.iter().all(Option::is_none) {
            FACET_LEAN
        } else {
            // Both lean by half of the draft; a curved face next to a plane one is seen through its chords.
            self.max_draft.max(SMALLEST_LEAN)
        };
        solid.normals[seen as usize].dot(-solid.normals[f as usize]) >= lean.cos()
    }

    /// The first thing met from a point in a direction, within the largest thickness.
    pub(super) fn first(&self, solid: &Solid, p: DVec3, direction: DVec3) -> Option<Opposite> {
        let hit = solid.caster.first(p, direction, START * solid.size, self.max_thickness)?;
        Some(Opposite { face: hit.face, distance: hit.distance })
    }

    /// Where curved walls flare into fillets: sets of faces at their borders that look past the opposite wall. Smooth facets hide
    /// where a wall ends and a fillet begins; what is opposite tells.
    pub(super) fn flares(&self, solid: &Solid, segments: &Segments) -> Vec<Vec<u32>> {
        let fold = |f: u32| {
            let cosines = (3 * f..3 * f + 3).map(|h| solid.fold_cosine(h)).filter(|c| *c > SHARP.cos());
            cosines.fold(1.0, f64::min).clamp(-1.0, 1.0).acos()
        };
        let curved = |f: u32| {
            let g = segments.of(f);
            self.is_wall[g as usize] && segments.group(g).plane.is_none()
        };
        let looks_past: Vec<bool> = (0..solid.len())
            .into_par_iter()
            .map(|f| {
                if !curved(f) {
                    return false;
                }
                let opposite = self.opposite_middle(solid, segments, f);
                let Some(opposite) = opposite else { return true };
                let lean = solid.normals[f as usize].dot(-solid.normals[opposite.face as usize]);
                let allowed = fold(f).max(fold(opposite.face)) + FLARE;
                lean < allowed.cos()
            })
            .collect();
        let mut seen = vec![false; solid.len() as usize];
        let mut found = Vec::new();
        for seed in (0..solid.len()).filter(|f| looks_past[*f as usize]) {
            if seen[seed as usize] {
                continue;
            }
            let (g, mut part, mut at) = (segments.of(seed), vec![seed], 0);
            seen[seed as usize] = true;
            let (mut border, mut sides, mut ends) = (0.0, Vec::new(), BTreeSet::new());
            while at < part.len() {
                for h in 3 * part[at]..3 * part[at] + 3 {
                    let other = solid.across(h);
                    let to = segments.of(other);
                    if to != g && self.is_wall[to as usize] && solid.fold_cosine(h) > OBLIQUE.cos() {
                        border += length_of(solid, h);
                    }
                    if to == g && looks_past[other as usize] {
                        if !seen[other as usize] {
                            seen[other as usize] = true;
                            part.push(other);
                        }
                    } else if self.is_wall[to as usize] {
                        sides.push(h);
                    } else {
                        ends.insert(to);
                    }
                }
                at += 1;
            }
            // A fillet runs along another wall, and is narrow.
            let area: f64 = part.iter().map(|f| solid.areas[*f as usize]).sum();
            let is_flare = border > 0.0 && area < self.max_thickness * border;
            let is_rim = !is_flare && self.is_rim(solid, segments, &looks_past, &part, &sides, &ends);
            if is_rim {
                self.widen(solid, segments, &mut part, &mut seen);
            }
            if is_flare || is_rim {
                part.sort_unstable();
                found.push(part);
            }
        }
        found
    }

    /// Whether what looks past the opposite wall is the round end of the walls beyond its sides: halfway between these and what is
    /// opposite, one leaves the material through such faces, or through the ends that they touch.
    fn is_rim(
        &self,
        solid: &Solid,
        segments: &Segments,
        looks_past: &[bool],
        part: &[u32],
        sides: &[u32],
        ends: &BTreeSet<u32>,
    ) -> bool {
        let ends_here = |h: u32| {
            let Some(beyond) = solid.adjacency.partner(h).map(|k| k / 3) else { return false };
            let normal = solid.normals[beyond as usize];
            let [a, b] = solid.adjacency.ends(h).map(|v| solid.mesh.positions[v as usize]);
            // The side runs against the face beyond it.
            let away = (a - b).cross(normal).normalize_or_zero();
            // What does not turn just has nothing opposite: a hole, or one drilled askew.
            if !part.iter().any(|f| solid.normals[*f as usize].dot(away) > TURNED) {
                return false;
            }
            let from = a.midpoint(b).lerp(solid.centroid(beyond), INSET);
            let Some(opposite) = self.first(solid, from, -normal) else { return false };
            let hit = self.first(solid, from - normal * (opposite.distance / 2.0), away);
            hit.is_some_and(|hit| looks_past[hit.face as usize] || ends.contains(&segments.of(hit.face)))
        };
        let length = |all: &mut dyn Iterator<Item = u32>| all.map(|h| length_of(solid, h)).sum::<f64>();
        let whole = length(&mut sides.iter().copied());
        whole > 0.0 && length(&mut sides.iter().copied().filter(|h| ends_here(*h))) > 0.5 * whole
    }

    /// Adds the faces of the group about a rim that are within a trifle of it: the first facets of a round hardly lean.
    fn widen(&self, solid: &Solid, segments: &Segments, part: &mut Vec<u32>, seen: &mut [bool]) {
        let at = |v: u32| solid.mesh.positions[v as usize];
        let nodes = part.iter().flat_map(|f| solid.mesh.faces[*f as usize]);
        let mut reached: BTreeMap<u32, f64> = nodes.map(|v| (v, 0.0)).collect();
        let mut k = 0;
        while k < part.len() {
            for h in 3 * part[k]..3 * part[k] + 3 {
                let other = solid.across(h);
                if seen[other as usize] || segments.of(other) != segments.of(part[k]) {
                    continue;
                }
                let face = solid.mesh.faces[other as usize];
                let how_far = |v: u32| {
                    let by_edge = |w: &u32| reached.get(w).map(|d| d + at(*w).distance(at(v)));
                    reached
                        .get(&v)
                        .copied()
                        .unwrap_or_else(|| face.iter().filter_map(by_edge).fold(f64::INFINITY, f64::min))
                };
                let far = face.map(|v| (v, how_far(v)));
                if far.iter().all(|(_, d)| *d < RIM * self.max_thickness) {
                    reached.extend(far);
                    seen[other as usize] = true;
                    part.push(other);
                }
            }
            k += 1;
        }
    }

    /// Fillets that curved walls run into: hollow faces without an exact partner, beside faces of their group that have one. What is
    /// opposite to facets of them is so by chance.
    pub(super) fn fillets(&self, segments: &Segments, faces: &Faces, pairs: &[WallPair]) -> Vec<Vec<u32>> {
        let mut has_partner = vec![false; faces.list.len()];
        pairs.iter().flat_map(|p| p.faces).for_each(|f| has_partner[f] = true);
        let group = |face: &Face| segments.of(face.triangles[0]);
        let mut has_wall = vec![false; segments.groups.len()];
        for (face, has_partner) in faces.list.iter().zip(&has_partner) {
            has_wall[group(face) as usize] |= *has_partner;
        }
        let is_fillet = |(face, has_partner): &(&Face, &bool)| {
            let small = match face.shape {
                Shape::Cylinder { radius, .. } | Shape::Sphere { radius, .. } => radius < self.max_thickness,
                Shape::Torus { minor, .. } => minor < self.max_thickness,
                _ => false,
            };
            let g = group(face);
            !**has_partner && face.concave && small && has_wall[g as usize] && self.is_wall[g as usize]
        };
        faces
            .list
            .iter()
            .zip(&has_partner)
            .filter(is_fillet)
            .map(|(face, _)| face.triangles.clone())
            .collect()
    }
}

fn length_of(solid: &Solid, h: u32) -> f64 {
    let [a, b] = solid.adjacency.ends(h).map(|v| solid.mesh.positions[v as usize]);
    a.distance(b)
}

/// About how many looks there are in all, beside one a face.
const SAMPLES: f64 = 4000.0;
/// A face is looked through from at most the square of this many points.
const MOST_ROWS: u32 = 32;
/// Planes that lean less than this are parallel: files round.
const SMALLEST_LEAN: f64 = 1e-3;

/// The middles of the n² parts of a triangle that equal divisions of the sides make.
fn spread([a, b, c]: [DVec3; 3], n: u32) -> impl Iterator<Item = DVec3> {
    let step = 1.0 / f64::from(n);
    let at = move |u: f64, v: f64| a + (b - a) * (u * step) + (c - a) * (v * step);
    let cells = (0..n).flat_map(move |i| (0..n - i).map(move |j| (i, j)));
    cells.flat_map(move |(i, j)| {
        let shifts = if i + j + 1 < n { &[1.0 / 3.0, 2.0 / 3.0][..] } else { &[1.0 / 3.0] };
        shifts.iter().map(move |shift| at(f64::from(i) + shift, f64::from(j) + shift))
    })
}

/// The largest thickness, told from the looks: the median one, and what follows on it without a gap.
fn told_thickness(looks: &[Look], area: f64) -> f64 {
    let mut seen: Vec<(f64, f64)> = looks.iter().filter_map(|l| Some((l.seen?.1, l.area))).collect();
    seen.par_sort_by(|a, b| a.0.total_cmp(&b.0));
    let all: f64 = seen.iter().map(|s| s.1).sum();
    let mut sum = 0.0;
    let mut largest = 0.0;
    for (thickness, part) in seen {
        let gap = if sum >= NEARLY_ALL * all { SMALL_GAP } else { THICKNESS_GAP };
        if sum >= 0.4 * all && thickness > gap * largest {
            break;
        }
        largest = thickness;
        sum += part;
    }
    // Walls that are seen from both sides cover half of the skin.
    (1.02 * largest).min(SLENDER * (area / 2.0).sqrt())
}

/// How thick plane walls are that are much broader than thick and not just a trifle of the skin, whatever the rest is: the base
/// below thin fins.
fn thick_plates<'a>(
    solid: &'a Solid,
    segments: &'a Segments,
    looks: &[Look],
    area: f64,
) -> impl Iterator<Item = f64> + 'a {
    let mut seen: Vec<(u32, f64, f64)> = looks
        .iter()
        .filter_map(|l| {
            let (partner, thickness) = l.seen?;
            let planes = [l.group, partner].iter().all(|g| segments.group(*g).plane.is_some());
            planes.then_some((l.group, thickness, l.area))
        })
        .collect();
    seen.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let plate = |run: &[(u32, f64, f64)]| {
        let all: f64 = run.iter().map(|r| r.2).sum();
        let mut sum = 0.0;
        let middle = run.iter().find(|r| {
            sum += r.2;
            sum >= all / 2.0
        })?;
        let alike = run.iter().filter(|r| (r.1 - middle.1).abs() < PLATE_ALIKE * middle.1);
        (alike.map(|r| r.2).sum::<f64>() >= 0.5 * segments.group(run[0].0).area)
            .then_some((run[0].0, middle.1))
    };
    let plates: Vec<(u32, f64)> = seen.chunk_by(|a, b| a.0 == b.0).filter_map(plate).collect();
    plates.into_iter().filter_map(move |(g, thickness)| {
        let group = segments.group(g);
        let is_large = group.area >= PLATE * area;
        (is_large && thickness < FLAT * width(solid, &group.faces)).then_some(1.02 * thickness)
    })
}

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
