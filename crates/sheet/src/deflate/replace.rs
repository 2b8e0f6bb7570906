//! Every node of the solid moves to where the replaced geometries of its faces meet; topology stays as it is (Sheen et
//! al. 2008, section 6.2).

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::assemble::Moved;
use super::blends::{Belongs, Blends};
use super::faces::Faces;
use super::flush::Flush;
use super::middle::{Middle, Middles};
use super::plane::Plane;
use super::segments::Segments;
use super::solid::Solid;
use super::star::Star;
use super::twins::Twins;
use super::walls::Walls;

/// Two planes meet in a line if the sine of the angle between them is more than this.
pub(super) const MEETING: f64 = 0.03;
/// The same for the plane of an end face.
const MEETING_END: f64 = 0.3;
/// The same for facets: a chamfer slants by more, a hole that is drilled askew by less.
const SLANTING: f64 = 0.6;
/// An end turns by less than this from where it begins to its middle, in radians.
const GOES_ON: f64 = 20.0 / 180.0 * std::f64::consts::PI;
/// Cosine of the angle between a wall and a face that runs into it at less than that.
const PARALLEL_END: f64 = 0.954;
/// A face stands upright on a wall if the cosine of the angle between them is less than this.
const UPRIGHT: f64 = 0.3;
/// Faces without a partner smaller than this many squares of the thickness hold nothing.
const TRIFLE: f64 = 0.05;
/// How much staying beside the starting point weighs against the planes of facets that do not agree on a point, as where
/// both sides of a wall are tessellated in their own way.
const STAY: f64 = 3e-3;
/// The same for facets that do agree.
const STAY_AGREED: f64 = 1e-4;
/// Facets agree on a point that is this near to all of them, over the thickness.
const AGREED: f64 = 2e-3;
/// The middle between twins is within this share of the thickness of all planes that meet there.
const TWIN_OFF: f64 = 0.01;
/// A node does not move farther than this many thicknesses for it.
const REACH: f64 = 0.75;
/// Nodes slide on planes to those of facets that are inclined to them by a sine of more than this; others meet them too far aside.
const STEEP: f64 = 0.3;
/// A wall is smooth at a node if its facets lean by less than this from their mean, in radians.
const SMOOTH: f64 = 20.0 / 180.0 * std::f64::consts::PI;
/// A round face is finely meshed if its facets lean by no more than this from it in the mean, in radians.
const FINE: f64 = 4.0 / 180.0 * std::f64::consts::PI;
/// Round faces run smoothly into each other if their normals are no farther apart, in radians.
const ONE: f64 = 2.0 / 180.0 * std::f64::consts::PI;
/// Rounds of moving the nodes of facets that turned over upright.
const TURNED_ROUNDS: usize = 4;
/// Rounds of taking nodes along that no wall holds.
const ALONG_ROUNDS: usize = 60;
/// It ends when none moves by more than this share of the solid's size.
const ALONG_SETTLED: f64 = 1e-7;
/// A chain of edges is straight as long as it turns by less than this, in radians.
const STRAIGHT: f64 = 3.0 / 180.0 * std::f64::consts::PI;
/// The shift of its end is taken up over so many times its length at least.
const ROOM: f64 = 3.0;
/// A chain of edges that turns by more than this, in radians, has a corner there.
const CORNER_TURN: f64 = std::f64::consts::FRAC_PI_4;

/// How nodes of smooth curved walls move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// To where the middles of their facets meet.
    Meeting,
    /// Along their normals. Where the thickness changes in a bend, the middles of facets meet aside, so far that fine facets pass each
    /// other.
    Upright,
}

/// What is needed to move nodes.
pub(super) struct Replacement<'a> {
    pub(super) solid: &'a Solid,
    pub(super) segments: &'a Segments,
    pub(super) faces: &'a Faces,
    pub(super) walls: &'a Walls,
    pub(super) middles: &'a Middles,
    pub(super) blends: &'a Blends,
    /// The middles at the corners of every face.
    pub(super) corners: &'a [[Option<Middle>; 3]],
    pub(super) twins: &'a Twins,
    pub(super) flush: &'a Flush,
    /// Faces at every node, with the corner: `3 face + corner`.
    pub(super) star: &'a Star,
}

/// The planes that a node has to lie on, and those that it should lie beside.
#[derive(Default)]
struct Wanted {
    walls: Vec<Plane>,
    ends: Vec<Plane>,
    /// With weights.
    facets: Vec<(Plane, f64)>,
    /// The same for facets of end faces.
    end_facets: Vec<(Plane, f64)>,
    /// Of the thinnest wall about it, in mm.
    thickness: f64,
}

impl Wanted {
    /// Whether it is only as exact as chords are: beside facets of walls, or of ends.
    fn is_soft(&self) -> bool {
        !(self.facets.is_empty() && self.end_facets.is_empty())
    }
}

impl Replacement<'_> {
    /// Where all nodes move to; those of facets that would turn over move upright in any case. O(n).
    pub(super) fn moved(&self, way: Way) -> Moved {
        let nodes = self.solid.mesh.positions.len() as u32;
        let mut ways = vec![way; nodes as usize];
        let mut positions = self.positions(&ways);
        for _ in 0..TURNED_ROUNDS {
            let mut more = false;
            for f in (0..self.solid.len()).filter(|f| self.turns_over(*f, &positions)) {
                for v in self.solid.mesh.faces[f as usize] {
                    more |= std::mem::replace(&mut ways[v as usize], Way::Upright) != Way::Upright;
                }
            }
            if !more {
                break;
            }
            positions = self.positions(&ways);
        }
        self.take_along(&mut positions);
        Moved {
            positions,
            soft: (0..nodes).into_par_iter().map(|v| self.wanted(v).is_soft()).collect(),
            blended: (0..nodes).map(|v| !self.blends.behind(v).is_empty()).collect(),
            flush: (0..nodes).map(|v| self.flush.is_at(v)).collect(),
        }
    }

    /// Nodes that no wall holds, inside the side of a sign or of a blind hole, go along with those of its border: as far as these do in the
    /// mean, nearer ones counting more. O(n).
    fn take_along(&self, positions: &mut [DVec3]) {
        let solid = self.solid;
        let is_wall =
            |v: u32| self.star.of(v).iter().any(|c| self.walls.is_wall[self.segments.of(c / 3) as usize]);
        let is_loose =
            |v: &u32| !self.star.of(*v).is_empty() && self.blends.behind(*v).is_empty() && !is_wall(*v);
        let loose: Vec<u32> = (0..positions.len() as u32).filter(is_loose).collect();
        let at = |v: u32| solid.mesh.positions[v as usize];
        for &v in &loose {
            positions[v as usize] = at(v);
        }
        let settled = ALONG_SETTLED * solid.size;
        for round in 0..ALONG_ROUNDS {
            let mut farthest = 0.0f64;
            for k in 0..loose.len() {
                // There and back, so that it does not matter much how nodes are numbered.
                let v = loose[if round % 2 == 0 { k } else { loose.len() - 1 - k }];
                let (mut shift, mut weight) = (DVec3::ZERO, 0.0);
                for corner in self.star.of(v) {
                    let [_, w] = solid.adjacency.ends(*corner);
                    let near = 1.0 / at(v).distance(at(w));
                    shift += (positions[w as usize] - at(w)) * near;
                    weight += near;
                }
                let p = at(v) + shift / weight;
                farthest = farthest.max(p.distance(positions[v as usize]));
                positions[v as usize] = p;
            }
            if farthest < settled {
                break;
            }
        }
    }

    /// Whether a facet of a curved wall faces away from where it faced. Plane walls are filled anew from their outlines.
    fn turns_over(&self, f: u32, positions: &[DVec3]) -> bool {
        let [a, b, c] = self.solid.mesh.faces[f as usize].map(|v| positions[v as usize]);
        let g = self.segments.of(f);
        let is_curved = self.walls.is_wall[g as usize] && self.segments.group(g).plane.is_none();
        is_curved && (b - a).cross(c - a).dot(self.solid.normals[f as usize]) < 0.0
    }

    fn positions(&self, ways: &[Way]) -> Vec<DVec3> {
        let nodes = self.solid.mesh.positions.len() as u32;
        let mut moved: Vec<DVec3> =
            (0..nodes).into_par_iter().map(|v| self.place(v, DVec3::ZERO, ways[v as usize])).collect();
        // Along a chain between two corners nodes go with its ends, or those near a corner would be passed by it.
        for chain in self.chains() {
            let at = |v: u32| self.solid.mesh.positions[v as usize];
            let last = chain.len() - 1;
            let tangent = |k: usize| {
                let (a, b) = (chain[k.saturating_sub(1)], chain[(k + 1).min(last)]);
                (at(b) - at(a)).normalize_or_zero()
            };
            // How much farther the ends move along it than the nodes beside them do by themselves.
            let way = |k: usize| moved[chain[k] as usize] - at(chain[k]);
            let shift = |end: usize, beside: usize| (way(end) - way(beside)).dot(tangent(end));
            let (first_shift, last_shift) = (shift(0, 1), shift(last, last - 1));
            let mut lengths = vec![0.0];
            for pair in chain.windows(2) {
                lengths.push(lengths[lengths.len() - 1] + at(pair[0]).distance(at(pair[1])));
            }
            let whole = lengths[last];
            // What a border runs straight takes up the shift of its end; where it bends, a shift would lead away from it, unless there is no
            // room before.
            let taken_up = |end: usize, shift: f64| {
                let run = |k: &usize| tangent(*k).dot(tangent(end)) > STRAIGHT.cos();
                let far = |k: usize| (lengths[k] - lengths[end]).abs();
                let straight = if end == 0 {
                    (1..=last).take_while(run).last().map_or(0.0, far)
                } else {
                    (0..last).rev().take_while(run).last().map_or(0.0, far)
                };
                straight.max((ROOM * shift.abs()).min(whole)).max(f64::MIN_POSITIVE)
            };
            let (first_run, last_run) = (taken_up(0, first_shift), taken_up(last, last_shift));
            let places: Vec<DVec3> = (1..last)
                .map(|k| {
                    let first = first_shift * (1.0 - lengths[k] / first_run).max(0.0);
                    let last = last_shift * (1.0 - (whole - lengths[k]) / last_run).max(0.0);
                    self.place(chain[k], tangent(k) * (first + last), ways[chain[k] as usize])
                })
                .collect();
            for (k, place) in (1..last).zip(places) {
                moved[chain[k] as usize] = place;
            }
        }
        moved
    }

    /// Chains of edges between groups, from corner to corner; those that close without one are left out.
    fn chains(&self) -> Vec<Vec<u32>> {
        let solid = self.solid;
        let borders = |h: u32| self.segments.of(h / 3) != self.segments.of(solid.across(h));
        let mut links: Vec<[u32; 2]> = Vec::new();
        for h in (0..3 * solid.len()).filter(|h| borders(*h)) {
            let [a, b] = solid.adjacency.ends(h);
            links.push([a, b]);
        }
        links.sort_unstable();
        links.dedup();
        let out = |v: u32| {
            let from = links.partition_point(|l| l[0] < v);
            let to = links.partition_point(|l| l[0] <= v);
            &links[from..to]
        };
        let at = |v: u32| solid.mesh.positions[v as usize];
        let is_corner = |v: u32| match out(v) {
            [[_, a], [_, b]] => {
                let (p, q) = ((at(v) - at(*a)).normalize_or_zero(), (at(*b) - at(v)).normalize_or_zero());
                p.dot(q) < CORNER_TURN.cos()
            }
            _ => true,
        };
        let mut chains = Vec::new();
        for link in &links {
            let [first, mut v] = *link;
            if !is_corner(first) {
                continue;
            }
            let mut chain = vec![first, v];
            while !is_corner(v) {
                let before = chain[chain.len() - 2];
                let Some(next) = out(v).iter().map(|l| l[1]).find(|w| *w != before) else { break };
                chain.push(next);
                v = next;
            }
            // Each chain is walked from both ends; one is enough.
            if chain.len() > 2 && (first, chain[1]) <= (v, chain[chain.len() - 2]) {
                chains.push(chain);
            }
        }
        chains
    }

    fn place(&self, v: u32, along: DVec3, way: Way) -> DVec3 {
        let p = self.solid.mesh.positions[v as usize];
        let mut wanted = self.wanted(v);
        let planes = held_by(&wanted);
        if let Some(middle) = self.between_twins(v, &wanted, &planes) {
            return middle;
        }
        let start = on_planes(p + along, &planes);
        // Round walls behind a blend are met, not gone along.
        let planes_behind =
            self.blends.behind(v).iter().all(|b| self.segments.group(b.group).plane.is_some());
        if planes_behind
            && wanted.end_facets.is_empty()
            && !wanted.facets.is_empty()
            && let Some(normal) = self.normal_of_faces(v)
            && let Some(place) = along_normal(start, &planes, &wanted.facets, normal)
        {
            return place;
        }
        // Folds between the facets of an end lead to wherever its mesher put nodes; the end itself stands upright on walls.
        let way = if wanted.facets.is_empty() { Way::Upright } else { way };
        wanted.facets.append(&mut wanted.end_facets);
        if wanted.facets.is_empty() {
            start
        } else {
            beside_facets(start, &planes, &wanted.facets, wanted.thickness, way)
        }
    }

    /// The normal of the round faces of walls that meet at a node, if they run smoothly into each other there and their facets are fine: it
    /// knows nothing of how these facets lie, and on the way to the middle of a small fillet, many times its radius, they pass each other.
    fn normal_of_faces(&self, v: u32) -> Option<DVec3> {
        let mut sum = DVec3::ZERO;
        let mut first: Option<DVec3> = None;
        for &corner in self.star.of(v) {
            let f = corner / 3;
            let group = self.segments.of(f);
            if !self.is_wall(&Belongs { group, at: v }) {
                continue;
            }
            let middle = self.corners[f as usize][corner as usize % 3]?;
            if middle.exact.is_some() {
                continue;
            }
            let face = self.faces.at(f);
            let outward = face.shape.outward(self.solid.mesh.positions[v as usize]);
            let facing = if face.concave { -outward } else { outward };
            if face.lean > FINE || facing.dot(*first.get_or_insert(facing)) < ONE.cos() {
                return None;
            }
            sum += facing;
        }
        sum.try_normalize()
    }

    /// The middle between twins, if it is so for all that meets there.
    fn between_twins(&self, v: u32, wanted: &Wanted, planes: &[Plane]) -> Option<DVec3> {
        let middle = self.twins.middle(v)?;
        let is_near = |plane: &Plane| plane.height(middle).abs() < TWIN_OFF * wanted.thickness;
        let all = planes.iter().chain(wanted.facets.iter().map(|f| &f.0)).all(is_near);
        // Twins at the end of a wall have it in common: a node of the border and one beside it only resemble each other.
        let ends = &wanted.end_facets;
        let at_end = ends.is_empty() || ends.iter().any(|f| is_near(&f.0));
        (all && at_end && !wanted.facets.is_empty()).then_some(middle)
    }

    fn wanted(&self, v: u32) -> Wanted {
        let mut wanted = Wanted::default();
        let mut groups: Vec<u32> = self.star.of(v).iter().map(|c| self.segments.of(c / 3)).collect();
        groups.sort_unstable();
        groups.dedup();
        let own = groups.iter().map(|&group| Belongs { group, at: v });
        let behind = self.blends.behind(v).iter().copied().filter(|b| !groups.contains(&b.group));
        let belongs: Vec<Belongs> = own.chain(behind).collect();
        // Walls first: ends that are trifles beside their thickness do not hold anything.
        let (walls, ends): (Vec<Belongs>, Vec<Belongs>) = belongs.into_iter().partition(|b| self.is_wall(b));
        wanted.thickness = f64::INFINITY;
        for b in walls.into_iter().chain(ends) {
            self.want(b, &mut wanted);
        }
        wanted
    }

    /// Where a face without a partner holds a node: in its plane, or if it is curved, beside the planes of its facets.
    fn want_end(&self, belongs: Belongs, wanted: &mut Wanted) {
        let g = belongs.group as usize;
        let trifle = TRIFLE * wanted.thickness * wanted.thickness;
        if self.segments.groups[g].area < trifle {
            return;
        }
        if self.blends.is_blend[g] && !self.blends.behind(belongs.at).is_empty() {
            return;
        }
        if let Some(k) = self.middles.plane_of[g] {
            let plane = self.middles.planes.plane(k);
            let upright = wanted.walls.iter().all(|w| w.normal.dot(plane.normal).abs() < UPRIGHT);
            let within = if upright { vec![] } else { self.ends_within(belongs, wanted) };
            wanted.ends.extend(if within.is_empty() { vec![plane] } else { within });
            return;
        }
        let p = self.solid.mesh.positions[belongs.at as usize];
        let mut facets = Vec::new();
        let mut slants = false;
        for &corner in self.star.of(belongs.at) {
            let f = corner / 3;
            let normal = self.solid.normals[f as usize];
            if self.segments.of(f) != belongs.group {
                continue;
            }
            let lean = |wall: &Plane| wall.normal.dot(normal).abs();
            let leans = wanted.walls.iter().map(lean).chain(wanted.facets.iter().map(|w| lean(&w.0)));
            let lean = leans.fold(0.0, f64::max);
            slants |= lean > SLANTING;
            // What is nearly parallel to the wall is not its end.
            if lean < PARALLEL_END && self.solid.areas[f as usize] >= 0.2 * trifle {
                facets.push((Plane { normal, offset: normal.dot(p) }, self.angle(corner)));
            }
        }
        let within = if slants { self.ends_within(belongs, wanted) } else { vec![] };
        if within.is_empty() {
            wanted.end_facets.extend(facets);
        } else {
            wanted.ends.extend(within);
        }
    }

    /// Where a wall with a round or slanting end has its end: as far as its middle goes through the material, away from its border.
    fn ends_within(&self, belongs: Belongs, wanted: &Wanted) -> Vec<Plane> {
        let Belongs { group, at } = belongs;
        let solid = self.solid;
        let p = solid.mesh.positions[at as usize];
        let facets = || wanted.facets.iter().max_by(|a, b| a.1.total_cmp(&b.1)).map(|f| f.0);
        let Some(wall) = wanted.walls.first().copied().or_else(facets) else { return Vec::new() };
        let middle = p - wall.normal * wall.height(p);
        let borders = self.star.of(at).iter().flat_map(|corner| {
            let f = corner / 3;
            // The two sides of the face that meet in the node.
            [*corner, 3 * f + (corner + 2) % 3].map(|h| (f, h))
        });
        let away = borders.filter_map(|(f, h)| {
            let is_border = self.walls.is_wall[self.segments.of(f) as usize]
                && self.segments.of(solid.across(h)) == group;
            let [a, b] = solid.adjacency.ends(h).map(|v| solid.mesh.positions[v as usize]);
            let away = (b - a).cross(solid.normals[f as usize]);
            let away = (away - wall.normal * wall.normal.dot(away)).normalize_or_zero();
            (is_border && away != DVec3::ZERO).then_some(away)
        });
        // Along a smooth border there is one direction, in a corner there are two.
        let mut directions: Vec<DVec3> = Vec::new();
        for away in away {
            match directions.iter_mut().find(|d| d.normalize_or_zero().dot(away) > CORNER_TURN.cos()) {
                Some(same) => *same += away,
                None => directions.push(away),
            }
        }
        let end = |direction: DVec3| {
            let normal = direction.normalize_or_zero();
            let hit = self.walls.first(solid, middle, normal)?;
            let leaves = solid.normals[hit.face as usize].dot(normal) > 0.0;
            let on_wall = self.walls.is_wall[self.segments.of(hit.face) as usize];
            // One that goes on as it begins at the node is told better by its own planes.
            let goes_on = self.star.of(at).iter().map(|c| c / 3).any(|f| {
                let same = self.segments.of(f) == group;
                same && solid.normals[f as usize].dot(solid.normals[hit.face as usize]) > GOES_ON.cos()
            });
            (leaves && !on_wall && !goes_on)
                .then(|| Plane { normal, offset: normal.dot(middle) + hit.distance })
        };
        directions.into_iter().filter_map(end).collect()
    }

    /// The angle of a face at a corner; 0 where it has none.
    fn angle(&self, corner: u32) -> f64 {
        let [a, b, c] = self.solid.mesh.corners(corner / 3);
        let [p, q, r] = [[a, b, c], [b, c, a], [c, a, b]][corner as usize % 3];
        Some((q - p).angle_between(r - p)).filter(|angle| angle.is_finite()).unwrap_or(0.0)
    }

    /// Whether what a node belongs to is a wall there.
    fn is_wall(&self, belongs: &Belongs) -> bool {
        self.walls.is_wall[belongs.group as usize] && !self.flush.is_end(belongs.group, belongs.at)
    }

    fn want(&self, belongs: Belongs, wanted: &mut Wanted) {
        if !self.is_wall(&belongs) {
            self.want_end(belongs, wanted);
            return;
        }
        for &corner in self.star.of(belongs.at) {
            let f = corner / 3;
            if self.segments.of(f) != belongs.group {
                continue;
            }
            let Some(middle) = self.corners[f as usize][corner as usize % 3] else { continue };
            wanted.thickness = wanted.thickness.min(middle.thickness);
            if middle.exact.is_some() {
                if !wanted.walls.contains(&middle.plane) {
                    wanted.walls.push(middle.plane);
                }
            } else {
                wanted.facets.push((middle.plane, self.angle(corner)));
            }
        }
    }
}

/// The planes that a node is put on, walls before ends.
fn held_by(wanted: &Wanted) -> Vec<Plane> {
    let walls = wanted.walls.iter().map(|p| (p, MEETING));
    // An end face that runs into a wall at a small angle would pull the node far along it.
    let is_beside = |plane: &Plane| {
        let facets = wanted.facets.iter().map(|f| f.0.normal.cross(plane.normal).length());
        facets.fold(1.0, f64::min) < MEETING_END
    };
    let ends = wanted.ends.iter().filter(|p| !is_beside(p)).map(|p| (p, MEETING_END));
    independent(walls.chain(ends))
}

/// At most three planes that meet in one point, those before others that come first. With each comes the sine of the angle at which it must
/// meet those before.
pub(super) fn independent<'a>(planes: impl Iterator<Item = (&'a Plane, f64)>) -> Vec<Plane> {
    let mut chosen: Vec<Plane> = Vec::with_capacity(3);
    let mut basis: Vec<DVec3> = Vec::with_capacity(3);
    for (plane, least) in planes {
        let rest = basis.iter().fold(plane.normal, |n, b| n - *b * b.dot(n));
        if rest.length() > least && chosen.len() < 3 {
            basis.push(rest.normalize());
            chosen.push(*plane);
        }
    }
    chosen
}

/// The point on all planes that is nearest to `p`.
pub(super) fn on_planes(p: DVec3, planes: &[Plane]) -> DVec3 {
    // The second round takes away what the first one rounded.
    (0..2).fold(p, |p, _| p + step_to(p, planes))
}

fn step_to(p: DVec3, planes: &[Plane]) -> DVec3 {
    match planes {
        [a] => -a.normal * a.height(p),
        [a, b] => {
            let cosine = a.normal.dot(b.normal);
            let (ha, hb) = (a.height(p), b.height(p));
            let scale = 1.0 / (1.0 - cosine * cosine);
            -(a.normal * ((ha - cosine * hb) * scale) + b.normal * ((hb - cosine * ha) * scale))
        }
        [a, b, c] => {
            let rows = DMat3::from_cols(a.normal, b.normal, c.normal).transpose();
            -(rows.inverse() * DVec3::new(a.height(p), b.height(p), c.height(p)))
        }
        _ => DVec3::ZERO,
    }
}

/// The point on the planes that is reached along a normal and is as near to the planes of facets as can be; `None` where it runs into a plane
/// at a small angle, and the point is where both meet.
fn along_normal(start: DVec3, planes: &[Plane], facets: &[(Plane, f64)], normal: DVec3) -> Option<DVec3> {
    let Some(free) = free(planes) else { return Some(start) };
    let way = free * normal;
    if way.length() < ONE.sin() {
        return Some(start);
    }
    (way.length() > STEEP).then(|| on_planes(to_mean(start, way.normalize(), facets), planes))
}

/// What planes leave free; `None` if that is nothing.
fn free(planes: &[Plane]) -> Option<DMat3> {
    match planes {
        [] => Some(DMat3::IDENTITY),
        [a] => Some(DMat3::IDENTITY - outer(a.normal)),
        [a, b] => Some(outer(a.normal.cross(b.normal).normalize_or_zero())),
        _ => None,
    }
}

/// Goes to where the mean facet's plane is; nowhere if that runs along the direction.
fn to_mean(p: DVec3, direction: DVec3, facets: &[(Plane, f64)]) -> DVec3 {
    let (mut above, mut below, mut weight) = (0.0, 0.0, 0.0);
    for (plane, w) in facets {
        let slope = plane.normal.dot(direction);
        above += w * slope * plane.height(p);
        below += w * slope * slope;
        weight += w;
    }
    if below > STEEP * STEEP * weight { p - direction * (above / below) } else { p }
}

/// The point on the planes that is as near to the planes of facets as can be (least squares), and otherwise beside `p`.
fn beside_facets(p: DVec3, planes: &[Plane], facets: &[(Plane, f64)], thickness: f64, way: Way) -> DVec3 {
    let Some(free) = free(planes) else { return p };
    let weight: f64 = facets.iter().map(|f| f.1).sum();
    let normal: DVec3 = facets.iter().map(|(plane, w)| plane.normal * *w).sum();
    // Start where the mean facet's plane is, so that staying costs nothing on a smooth wall.
    let direction = (free * normal).normalize_or_zero();
    let start = to_mean(p, direction, facets);
    if way == Way::Upright && facets.iter().all(|(plane, _)| plane.normal.dot(direction) > SMOOTH.cos()) {
        return on_planes(start, planes);
    }
    let (mut matrix, mut right) = (DMat3::ZERO, DVec3::ZERO);
    for (plane, w) in facets {
        let n = free * plane.normal;
        matrix += outer(n) * *w;
        right -= n * (w * plane.height(start));
    }
    let with = |stay: f64| {
        let moved = start + free * ((matrix + DMat3::IDENTITY * (stay * weight)).inverse() * right);
        if moved.is_finite() { on_planes(moved, planes) } else { p }
    };
    let agreed = with(STAY_AGREED);
    let off = facets.iter().map(|(plane, _)| plane.height(agreed).abs()).fold(0.0, f64::max);
    let near = agreed.distance(start) < REACH * thickness;
    if off < AGREED * thickness && near { agreed } else { with(STAY) }
}

fn outer(n: DVec3) -> DMat3 {
    DMat3::from_cols(n * n.x, n * n.y, n * n.z)
}
