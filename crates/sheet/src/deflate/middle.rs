//! The middles that faces are replaced by (Sheen et al. 2008, section 6.2): exact planes between plane walls, and
//! planes beside the facets of curved ones.

use std::f64::consts::TAU;

use glam::DVec3;
use rayon::prelude::*;

use super::faces::{Face, Faces};
use super::looks::Pair;
use super::plane::{Plane, PlaneTable};
use super::segments::Segments;
use super::solid::Solid;
use super::walls::{Opposite, Walls};

/// A partner counts if it covers this share of a wall.
const COUNTED: f64 = 0.02;
/// Or if this share of it lies opposite to the wall: the floor of a small pocket.
const WHOLE: f64 = 0.5;
/// A wall has an exact mid-plane if plane partners cover this share of what has a partner.
const MOSTLY: f64 = 0.8;
/// Mid-planes that are apart by less than this share of the thickness make no step.
const STEP: f64 = 0.01;
/// Cosine of the angle between middles that can be aligned.
const ALIGNED: f64 = 0.999;
/// Axes that lean less than this, in radians, are parallel: those of walls with draft, each fitted by itself.
const PARALLEL: f64 = 1e-2;
/// Looks through the material at a corner begin this far from it towards the middle of the face.
const INSET: f64 = 0.1;

/// The middle of a wall at a corner of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Middle {
    /// The plane that the corner moves to.
    pub(super) plane: Plane,
    /// Number of the exact plane, if it is one.
    pub(super) exact: Option<u32>,
    /// How thick the wall is there, in mm.
    pub(super) thickness: f64,
}

/// A face that stands between two walls where the thickness steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ThicknessStep {
    /// The group of the face.
    pub(super) group: u32,
    /// The kept wall on its thinner side.
    thinner: u32,
    /// And on its thicker side.
    thicker: u32,
    /// Of the face, across the walls, in mm.
    pub(super) height: f64,
}

/// The middles of all walls.
#[derive(Debug)]
pub(super) struct Middles {
    /// Planes of plane groups.
    pub(super) planes: PlaneTable,
    /// Number of every group's plane.
    pub(super) plane_of: Vec<Option<u32>>,
    /// Planes halfway between two plane walls, by the groups of the pair; ordered. Each faces as the first group.
    between: Vec<([u32; 2], Plane, u32)>,
    /// The different mid-planes of every plane wall.
    pub(super) of_group: Vec<Vec<Plane>>,
    pub(super) mid_planes: PlaneTable,
}

impl Middles {
    /// Finds the mid-planes. O(groups · planes).
    pub(super) fn new(solid: &Solid, segments: &Segments, walls: &Walls) -> Self {
        let centre = solid.mesh.bounds().map_or(DVec3::ZERO, |[lo, hi]| (lo + hi) / 2.0);
        let mut planes = PlaneTable::new(solid.size, 0.0, centre);
        let mut mid_planes = PlaneTable::new(solid.size, solid.rounding, centre);
        let plane_of: Vec<Option<u32>> =
            segments.groups.iter().map(|g| g.plane.map(|p| planes.number(p))).collect();
        let mut between = Vec::new();
        let mut of_group: Vec<Vec<Plane>> = vec![Vec::new(); segments.groups.len()];
        // Of planes that are one, that of the largest pair stands for all.
        let mut order: Vec<&Pair> = walls.pairs.iter().collect();
        order.sort_by(|a, b| {
            b.area.total_cmp(&a.area).then_with(|| (a.group, a.partner).cmp(&(b.group, b.partner)))
        });
        for pair in order {
            let of = |g: u32| plane_of[g as usize].map(|k| planes.plane(k));
            let [Some(p), Some(q)] = [of(pair.group), of(pair.partner)] else { continue };
            // From a small wall there is a surer look at a large one than the other way round.
            let back = walls.partners(pair.partner).iter().find(|p| p.partner == pair.group);
            let is_whole = back.is_some_and(|b| b.area > WHOLE * segments.group(b.group).area);
            if pair.area < COUNTED * segments.group(pair.group).area && !is_whole {
                continue;
            }
            let middle = p.middle(&q);
            let canonical = if faces_up(middle.normal) { middle } else { middle.flipped() };
            let number = mid_planes.number(canonical);
            let shared = mid_planes.plane(number);
            let plane = if shared.normal.dot(p.normal) > 0.0 { shared } else { shared.flipped() };
            between.push(([pair.group, pair.partner], plane, number));
            let own = &mut of_group[pair.group as usize];
            if !own.contains(&plane) {
                own.push(plane);
            }
        }
        between.sort_by_key(|between| between.0);
        // A plane wall whose partner is mostly curved follows that one.
        for (g, own) in (0u32..).zip(&mut of_group) {
            let partners = walls.partners(g);
            let flat: f64 =
                partners.iter().filter(|p| plane_of[p.partner as usize].is_some()).map(|p| p.area).sum();
            if flat < MOSTLY * partners.iter().map(|p| p.area).sum::<f64>() {
                own.clear();
            }
        }
        Self { planes, plane_of, between, of_group, mid_planes }
    }

    /// Where the thickness steps: faces that stand between two kept walls whose mid-planes are parallel and apart. O(n).
    pub(super) fn steps(
        &self,
        solid: &Solid,
        segments: &Segments,
        walls: &Walls,
        kept: &[bool],
    ) -> Vec<ThicknessStep> {
        let mut found = Vec::new();
        for (g, group) in (0u32..).zip(&segments.groups) {
            if walls.is_wall[g as usize] || group.plane.is_none() {
                continue;
            }
            let sides = group.faces.iter().flat_map(|f| 3 * f..3 * f + 3);
            let mut beside: Vec<u32> = sides.map(|h| segments.of(solid.across(h))).collect();
            beside.retain(|o| kept[*o as usize] && self.only(*o).is_some());
            beside.sort_unstable();
            beside.dedup();
            let thick = |g: u32| walls.partners(g).iter().map(|p| p.thickness).fold(0.0, f64::max);
            let thickest = beside.iter().copied().max_by(|a, b| thick(*a).total_cmp(&thick(*b)));
            let Some((thicker, to)) = thickest.and_then(|t| Some((t, self.only(t)?))) else { continue };
            let range = |plane: Plane| {
                let corners = group.faces.iter().flat_map(|f| solid.mesh.corners(*f));
                let heights = corners.map(|p| plane.height(p));
                heights.fold((f64::MAX, f64::MIN), |(low, high), h| (low.min(h), high.max(h)))
            };
            for thinner in beside.into_iter().filter(|b| *b != thicker) {
                let Some(from) = self.only(thinner) else { continue };
                let apart = (from.offset - to.offset).abs() > STEP * thick(thinner);
                // An end of both reaches over their middles, a step stands on one side.
                let (low, high) = range(from);
                let on_a_side = low > 0.0 || high < 0.0;
                if from.normal.dot(to.normal) > ALIGNED && apart && on_a_side {
                    found.push(ThicknessStep { group: g, thinner, thicker, height: high - low });
                }
            }
        }
        found
    }

    /// Moves the middle of the thinner wall at a step to that of the thicker.
    pub(super) fn align_step(&mut self, walls: &Walls, step: &ThicknessStep) {
        self.align(walls, step.thinner, step.thicker);
    }

    fn align(&mut self, walls: &Walls, thinner: u32, thicker: u32) {
        let [Some(from), Some(to)] = [thinner, thicker].map(|g| self.only(g)) else { return };
        let pair = walls.partners(thicker).iter().find_map(|p| self.between(thicker, p.partner));
        let Some((_, number)) = pair.filter(|_| from.normal.dot(to.normal) > ALIGNED) else { return };
        for entry in self.between.iter_mut().filter(|b| b.0.contains(&thinner)) {
            let faces = entry.1.normal.dot(to.normal) > 0.0;
            entry.1 = if faces { to } else { to.flipped() };
            entry.2 = number;
        }
        self.of_group[thinner as usize] = vec![to];
    }

    /// The mid-plane between two groups, facing as the first, and its number.
    pub(super) fn between(&self, group: u32, partner: u32) -> Option<(Plane, u32)> {
        let k = self.between.binary_search_by_key(&[group, partner], |b| b.0).ok()?;
        Some((self.between[k].1, self.between[k].2))
    }

    /// The exact mid-plane that a group has everywhere, if there is just one.
    pub(super) fn only(&self, group: u32) -> Option<Plane> {
        match self.of_group[group as usize][..] {
            [plane] => Some(plane),
            _ => None,
        }
    }

    /// The middles at the corners of all faces of walls; `None` elsewhere, and where nothing is opposite. O(n log n).
    pub(super) fn at_corners(
        &self,
        solid: &Solid,
        segments: &Segments,
        walls: &Walls,
        faces: &Faces,
    ) -> Vec<[Option<Middle>; 3]> {
        let seen: Vec<[Option<Middle>; 3]> = (0..solid.len())
            .into_par_iter()
            .map(|f| {
                let group = segments.of(f);
                if !walls.is_wall[group as usize] {
                    return [None; 3];
                }
                self.corners_of(solid, segments, walls, faces, f)
            })
            .collect();
        self.filled(solid, segments, walls, seen)
    }

    fn corners_of(
        &self,
        solid: &Solid,
        segments: &Segments,
        walls: &Walls,
        faces: &Faces,
        f: u32,
    ) -> [Option<Middle>; 3] {
        let group = segments.of(f);
        let normal = solid.normals[f as usize];
        let middle = solid.centroid(f);
        if let Some(plane) = self.only(group)
            && let [pair] = walls.partners(group)
        {
            // One plane wall opposite to one other: nothing to look for.
            let exact = self.between(group, pair.partner).map(|b| b.1);
            return [Some(Middle { plane, exact, thickness: pair.thickness }); 3];
        }
        solid.mesh.corners(f).map(|corner| {
            let p = corner.lerp(middle, INSET);
            // Behind a fillet the wall is thicker than it is.
            let wall = |o: &Opposite| walls.is_wall[segments.of(o.face) as usize];
            let beside = walls.opposite(solid, segments, f, p).filter(wall).map(|o| (p, o));
            let at_middle = || walls.opposite_middle(solid, segments, f).filter(wall).map(|o| (middle, o));
            let (p, opposite) = beside.or_else(at_middle)?;
            let partner = segments.of(opposite.face);
            if let Some((plane, number)) = self.between(group, partner) {
                let thickness = opposite.distance;
                return Some(Middle { plane, exact: Some(number), thickness });
            }
            let seen = [(faces.at(f), p), (faces.at(opposite.face), p - normal * opposite.distance)];
            let halfway = halfway(normal, seen);
            let offset = halfway.dot(p - normal * (opposite.distance / 2.0));
            let plane = Plane { normal: halfway, offset };
            Some(Middle { plane, exact: None, thickness: opposite.distance })
        })
    }

    /// Corners where nothing is opposite (below a rib, say) take what their group has elsewhere.
    fn filled(
        &self,
        solid: &Solid,
        segments: &Segments,
        walls: &Walls,
        mut seen: Vec<[Option<Middle>; 3]>,
    ) -> Vec<[Option<Middle>; 3]> {
        for (g, group) in segments.groups.iter().enumerate() {
            if !walls.is_wall[g] {
                continue;
            }
            if let Some(plane) = self.only(g as u32) {
                let main = walls.partners(g as u32).iter().max_by(|a, b| a.area.total_cmp(&b.area));
                let Some(pair) = main else { continue };
                let exact = self.between(g as u32, pair.partner).map(|b| b.1);
                for &f in &group.faces {
                    for m in &mut seen[f as usize] {
                        if m.is_none_or(|m| m.exact.is_none()) {
                            *m = Some(Middle { plane, exact, thickness: pair.thickness });
                        }
                    }
                }
            } else {
                fill_from_neighbours(solid, segments, g as u32, &mut seen);
            }
        }
        seen
    }
}

/// The normal of the middle beside a facet, from the faces on both sides of the wall and the points on them: its own, but for round walls with
/// draft, whose sides lean against each other along their axis. What they bend by is not asked of facets: these are chords, and lean by
/// chance.
fn halfway(normal: DVec3, [(face, p), (other, q)]: [(&Face, DVec3); 2]) -> DVec3 {
    let (Some(axis), Some(beyond)) = (face.shape.axis(), other.shape.axis()) else { return normal };
    if axis.cross(beyond).length() > PARALLEL {
        return normal;
    }
    // How steep each side is, in the plane of the axis and what points away from it; both face as the facet does.
    let facing = |face: &Face, p: DVec3| {
        let outward = face.shape.outward(p);
        if outward.dot(normal) < 0.0 { -outward } else { outward }
    };
    let (own, theirs) = (facing(face, p), facing(other, q));
    let away = |out: DVec3, axis: DVec3| (out - axis * axis.dot(out)).normalize_or_zero();
    let steep = |out: DVec3, axis: DVec3, away: DVec3| f64::atan2(out.dot(axis), out.dot(away));
    let beyond = if beyond.dot(axis) < 0.0 { -beyond } else { beyond };
    let (own_away, their_away) = (away(own, axis), away(theirs, beyond));
    let their_away = if their_away.dot(own_away) < 0.0 { -their_away } else { their_away };
    let (from, to) = (steep(own, axis, own_away), steep(theirs, beyond, their_away));
    let turn = to - from;
    let lean = (turn - TAU * (turn / TAU).round()) / 2.0;
    let along = (axis - normal * axis.dot(normal)).normalize_or_zero();
    normal * lean.cos() + along * lean.sin()
}

/// Spreads thicknesses over the faces of a group from where they are known.
fn fill_from_neighbours(solid: &Solid, segments: &Segments, g: u32, seen: &mut [[Option<Middle>; 3]]) {
    let group = segments.group(g);
    let known = |seen: &[[Option<Middle>; 3]], f: u32| {
        let own: Vec<Middle> = seen[f as usize].iter().flatten().copied().collect();
        (!own.is_empty()).then(|| {
            (own.iter().map(|m| m.thickness).sum::<f64>() / own.len() as f64, own[0].exact, own[0].plane)
        })
    };
    let mut front: Vec<u32> = group.faces.iter().copied().filter(|f| known(seen, *f).is_some()).collect();
    let mut at = 0;
    for &f in &front {
        complete(solid, f, known(seen, f), seen);
    }
    while at < front.len() {
        let f = front[at];
        at += 1;
        let from = known(seen, f);
        for h in 3 * f..3 * f + 3 {
            let other = solid.across(h);
            if segments.of(other) == g && known(seen, other).is_none() {
                complete(solid, other, from, seen);
                front.push(other);
            }
        }
    }
}

/// Gives the corners of a face that know nothing a thickness.
fn complete(
    solid: &Solid,
    f: u32,
    from: Option<(f64, Option<u32>, Plane)>,
    seen: &mut [[Option<Middle>; 3]],
) {
    let Some((thickness, exact, plane)) = from else { return };
    let normal = solid.normals[f as usize];
    for (m, corner) in seen[f as usize].iter_mut().zip(solid.mesh.corners(f)) {
        if m.is_none() {
            let beside = Plane { normal, offset: normal.dot(corner) - thickness / 2.0 };
            let plane = if exact.is_some() { plane } else { beside };
            *m = Some(Middle { plane, exact, thickness });
        }
    }
}

/// One of a direction and its opposite.
fn faces_up(n: DVec3) -> bool {
    let small = 1e-9;
    if n.z.abs() > small {
        n.z > 0.0
    } else if n.y.abs() > small {
        n.y > 0.0
    } else {
        n.x > 0.0
    }
}
