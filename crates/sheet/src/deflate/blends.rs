//! Fillets and rounds without a partner: what lies behind them.
//!
//! A fillet at the root of a rib is no wall and has no middle. Its nodes belong to the faces that it blends instead, as if it
//! had been removed and the faces extended until they meet.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use glam::DVec3;
use rayon::prelude::*;

use super::segments::Segments;
use super::solid::Solid;
use super::star::Star;
use super::walls::Walls;

/// A group that a node belongs to, with the node of that group which is nearest to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Belongs {
    /// The group.
    pub(super) group: u32,
    /// The node on it.
    pub(super) at: u32,
}

/// Faces that lie farther away than this many times the nearest wall are not blended there.
const AS_NEAR: f64 = 1.2;
/// The same for walls, which are beside each other along a whole corner.
const AS_NEAR_WALL: f64 = 1.02;
/// A blend that reaches from a wall to its partner over less than this many thicknesses is the wall's end.
const END_WIDTH: f64 = 2.5;
/// Walls that are blended are no farther apart than this many of the largest thickness.
const REACH: f64 = 10.0;
/// Cosine of the angle above which a direction goes along a border.
const ALONG: f64 = 0.6;
/// Cosine of the angle at a corner of a border, at most.
const CORNER: f64 = 0.7;
/// Strips narrower than this share of it blend nothing: they are left where a mesh was cut.
const BURR: f64 = 0.1;
/// A chamfer folds from its walls by less than this, in radians.
const OBLIQUE: f64 = 70.0 / 180.0 * std::f64::consts::PI;
/// One side of a strip is at least this share of its outline.
const ONE_SIDE: f64 = 0.3;
/// Cosine above which two faces are too parallel to meet.
const PARALLEL: f64 = 0.94;

/// For nodes of blends, what they belong to beside their own groups.
#[derive(Debug, Default)]
pub(super) struct Blends {
    of_node: BTreeMap<u32, Vec<Belongs>>,
    /// Whether each group is a blend.
    pub(super) is_blend: Vec<bool>,
    /// Groups with an edge in common, ascending; both ways.
    touching: Vec<[u32; 2]>,
}

/// How far a group is from a node in mm, what the node would belong to, and the nearest point of its border.
type Reach = (f64, Belongs, DVec3);

/// Distances are compared by their bits: they are not negative.
type Reached = Reverse<(u64, u32, u32)>;

/// By node, how far the nearest of some others is, and which one that is.
type Nearest = BTreeMap<u32, (f64, u32)>;

/// What nodes belong to.
type Behind = BTreeMap<u32, Vec<Belongs>>;

/// Edges of a border by both ends.
type Border = BTreeMap<u32, Vec<u32>>;

impl Blends {
    /// Finds what lies behind every curved group that is no wall. O(n log n) in nodes of blends, times their neighbours.
    pub(super) fn new(solid: &Solid, segments: &Segments, walls: &Walls) -> Self {
        let is_blend = |g: u32| {
            let group = segments.group(g);
            !walls.is_wall[g as usize] && (group.plane.is_none() || is_chamfer(solid, segments, walls, g))
        };
        let is_blend: Vec<bool> = (0..segments.groups.len() as u32).into_par_iter().map(is_blend).collect();
        let star = Star::new(&solid.mesh.faces, solid.mesh.positions.len());
        let mut blends = Self { is_blend, touching: touching(solid, segments), ..Self::default() };
        // Blends that run into each other are one: a fillet in facets, and its corners.
        let mut seen = vec![false; segments.groups.len()];
        let mut sets = Vec::new();
        for first in 0..segments.groups.len() as u32 {
            if !blends.is_blend[first as usize] || seen[first as usize] {
                continue;
            }
            let mut together = vec![first];
            seen[first as usize] = true;
            let mut at = 0;
            while at < together.len() {
                let sides = segments.group(together[at]).faces.iter().flat_map(|f| 3 * f..3 * f + 3);
                for other in sides.map(|h| segments.of(solid.across(h))).collect::<Vec<_>>() {
                    if blends.is_blend[other as usize] && !seen[other as usize] {
                        seen[other as usize] = true;
                        together.push(other);
                    }
                }
                at += 1;
            }
            sets.push(together);
        }
        let look = |together: &Vec<u32>| blends.look_behind(solid, segments, walls, &star, together);
        let found: Vec<Behind> = sets.par_iter().map(look).collect();
        for (node, behind) in found.into_iter().flatten() {
            blends.of_node.entry(node).or_default().extend(behind);
        }
        blends
    }

    /// What a node belongs to beside the groups of its faces.
    pub(super) fn behind(&self, node: u32) -> &[Belongs] {
        self.of_node.get(&node).map_or(&[], Vec::as_slice)
    }

    /// What nodes of blends that run into each other belong to.
    fn look_behind(
        &self,
        solid: &Solid,
        segments: &Segments,
        walls: &Walls,
        star: &Star,
        together: &[u32],
    ) -> Behind {
        // Edges of the blend's border, by the group beyond.
        let mut borders: BTreeMap<u32, Border> = BTreeMap::new();
        let mut links: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for f in together.iter().flat_map(|g| segments.group(*g).faces.iter().copied()) {
            for h in 3 * f..3 * f + 3 {
                let [a, b] = solid.adjacency.ends(h);
                links.entry(a).or_default().push(b);
                links.entry(b).or_default().push(a);
                let other = segments.of(solid.across(h));
                if !self.is_blend[other as usize] {
                    let border = borders.entry(other).or_default();
                    border.entry(a).or_default().push(b);
                    border.entry(b).or_default().push(a);
                }
            }
        }
        let mut found: BTreeMap<u32, Vec<Reach>> = BTreeMap::new();
        let position = |v: u32| solid.mesh.positions[v as usize];
        let outline: f64 = borders
            .values()
            .flat_map(|border| border.iter().flat_map(|(a, ends)| ends.iter().map(move |b| (*a, *b))))
            .map(|(a, b)| position(a).distance(position(b)) / 2.0)
            .sum();
        let area: f64 = together.iter().map(|g| segments.group(*g).area).sum();
        let is_burr = 2.0 * area < BURR * walls.max_thickness * outline;
        let from =
            |(&group, border): (&u32, &Border)| (group, nearest(solid, &links, border.keys().copied()));
        let nearest: Vec<(u32, Nearest)> = borders.par_iter().map(from).collect();
        for (group, nearest) in nearest {
            let border = &borders[&group];
            for (node, (_, at)) in nearest {
                // Along the edges tells which one, about; how far it is, the straight line to the border there.
                let p = position(node);
                let at = nearest_along(border, at, |v| p.distance(position(v)));
                let ends = border.get(&at).map_or(&[][..], Vec::as_slice);
                let points = ends.iter().map(|end| on_segment(p, position(at), position(*end)));
                let Some(point) = points.min_by(|a, b| p.distance(*a).total_cmp(&p.distance(*b))) else {
                    continue;
                };
                found.entry(node).or_default().push((p.distance(point), Belongs { group, at }, point));
            }
        }
        let mut of_node: Behind = BTreeMap::new();
        let mut near_walls_of: BTreeMap<u32, Vec<(f64, Belongs)>> = BTreeMap::new();
        for (node, mut reached) in found {
            reached.sort_by(|a, b| a.0.total_cmp(&b.0));
            let here = reached.iter().filter(|r| r.0 == 0.0).map(|r| r.1);
            let own: Vec<Belongs> = here.filter(|b| walls.is_wall[b.group as usize]).collect();
            if own.is_empty() {
                continue;
            }
            let facing = |b: &Belongs| group_normal_at(solid, segments, star, b);
            let mine: Vec<_> = own.iter().map(facing).collect();
            let meets = |b: &Belongs| {
                // A rib's side touches that of a rib across it, but not the floor that it is blended with.
                let is_own = own.iter().any(|o| o.group == b.group);
                let apart = own.iter().any(|o| !self.touch(o.group, b.group));
                // Where a rib stands, the end of both walls also reaches to the floor's other side.
                let under = walls
                    .partners(b.group)
                    .iter()
                    .any(|p| own.iter().any(|o| o.group != p.partner && self.touch(o.group, p.partner)));
                !is_own
                    && (apart || is_burr)
                    && !under
                    && mine.iter().all(|n| n.dot(facing(b)).abs() < PARALLEL)
            };
            // What lies along the border is beside the wall, not across the blend.
            let p = position(node);
            let is_across = |r: &Reach| {
                let to = (r.2 - p).normalize_or_zero();
                let links = own.iter().filter_map(|o| borders.get(&o.group)?.get(&node)).flatten();
                links.map(|end| (position(*end) - p).normalize_or_zero()).all(|t| t.dot(to).abs() < ALONG)
            };
            let others: Vec<&Reach> = reached.iter().filter(|r| meets(&r.1)).collect();
            let reach = if is_burr { BURR } else { REACH } * walls.max_thickness;
            // A round between a wall and its end has other walls only along it.
            let mut ends = others.iter().filter(|r| r.0 > 0.0 && !walls.is_wall[r.1.group as usize]);
            let reach = ends.find(|r| is_across(r)).map_or(reach, |end| reach.min(AS_NEAR * end.0));
            let near = |r: &&&Reach| r.0 < reach;
            let wall = others.iter().filter(near).find(|r| walls.is_wall[r.1.group as usize]);
            let within = wall.map_or(f64::INFINITY, |w| AS_NEAR * w.0);
            // Between a wall and its partner, and nearer than anything else, is the end of both.
            let is_end = |r: &Reach| {
                own.iter().any(|o| {
                    let mut partners = walls.partners(o.group).iter();
                    let pair = partners.find(|p| p.partner == r.1.group);
                    pair.is_some_and(|p| r.0 <= END_WIDTH * p.thickness && wall.is_none_or(|w| r.0 <= w.0))
                })
            };
            if reached.iter().any(is_end) {
                continue;
            }
            // In a corner two ends are as near.
            let is_near_end = |r: &&&Reach| !walls.is_wall[r.1.group as usize] && r.0 <= within;
            let nearest_end = others.iter().find(is_near_end).map_or(0.0, |r| r.0);
            let ends = others.iter().filter(is_near_end).filter(|r| r.0 <= AS_NEAR * nearest_end);
            // In a corner of three walls two of them are as near.
            let is_near_wall = |r: &&&Reach| {
                walls.is_wall[r.1.group as usize] && wall.is_some_and(|w| r.0 <= AS_NEAR_WALL * w.0)
            };
            let near_walls = others.iter().filter(near).filter(is_near_wall);
            // Fillets of different radii that come together at a corner of a wall have each their own wall behind them.
            let ways = own.iter().flat_map(|o| {
                let border = borders.get(&o.group);
                let ends = border.and_then(|border| border.get(&node)).map_or(&[][..], Vec::as_slice);
                ways_off(p, ends.iter().map(|end| position(*end)))
            });
            let on_the_way = |way: DVec3| {
                let goes = |r: &&&Reach| (r.2 - p).normalize_or_zero().dot(way) > ALONG;
                others.iter().filter(near).filter(goes).find(|r| walls.is_wall[r.1.group as usize])
            };
            let at_corner: Vec<&&Reach> = ways.filter_map(on_the_way).collect();
            let mut behind: Vec<Belongs> = Vec::new();
            for reach in near_walls.chain(at_corner).chain(ends) {
                if !behind.contains(&reach.1) {
                    behind.push(reach.1);
                }
            }
            let behind = if behind.is_empty() { self.at_an_end(walls, &own, &reached) } else { behind };
            if !behind.is_empty() {
                of_node.insert(node, behind);
            }
            let is_wall = |r: &&&Reach| walls.is_wall[r.1.group as usize];
            near_walls_of
                .insert(node, others.iter().filter(near).filter(is_wall).map(|r| (r.0, r.1)).collect());
        }
        for border in borders.iter().filter(|b| segments.group(*b.0).plane.is_some()).map(|b| b.1) {
            into_corners(border, &near_walls_of, &mut of_node);
        }
        of_node
    }

    /// For a node where a blend ends on a wall across it: the two nearest walls that it blends, both of which touch that one but not
    /// each other.
    fn at_an_end(&self, walls: &Walls, own: &[Belongs], reached: &[Reach]) -> Vec<Belongs> {
        let [across] = own else { return Vec::new() };
        let touching = |b: &&Belongs| {
            b.group != across.group && walls.is_wall[b.group as usize] && self.touch(b.group, across.group)
        };
        let beside: Vec<Belongs> = reached.iter().map(|r| &r.1).filter(touching).copied().collect();
        match beside[..] {
            [p, q] if !self.touch(p.group, q.group) => vec![p, q],
            _ => Vec::new(),
        }
    }

    /// Whether two groups have an edge in common. O(log n).
    fn touch(&self, g: u32, other: u32) -> bool {
        self.touching.binary_search(&[g, other]).is_ok()
    }
}

/// Groups with an edge in common.
fn touching(solid: &Solid, segments: &Segments) -> Vec<[u32; 2]> {
    let beside = |h: u32| [segments.of(h / 3), segments.of(solid.across(h))];
    let mut touching: Vec<[u32; 2]> =
        (0..3 * solid.len()).into_par_iter().map(beside).filter(|[g, other]| g != other).collect();
    touching.sort_unstable();
    touching.dedup();
    touching
}

/// Whether a plane face without a partner is a narrow strip that turns in two steps: from wall to wall, or from a wall to its end.
fn is_chamfer(solid: &Solid, segments: &Segments, walls: &Walls, g: u32) -> bool {
    let group = segments.group(g);
    let (mut outline, mut to_walls, mut to_ends) = (0.0, 0.0, 0.0);
    let mut about: Vec<u32> = Vec::new();
    for h in group.faces.iter().flat_map(|f| 3 * f..3 * f + 3) {
        let other = segments.of(solid.across(h));
        if other == g {
            continue;
        }
        let length = solid.length(h);
        outline += length;
        if solid.fold_cosine(h) > OBLIQUE.cos() {
            if walls.is_wall[other as usize] {
                to_walls += length;
                about.push(other);
            } else if segments.group(other).plane.is_some() {
                to_ends += length;
            }
        }
    }
    about.sort_unstable();
    about.dedup();
    // What reaches from a wall to its partner is the end of both.
    let is_end = about.iter().any(|w| walls.partners(*w).iter().any(|p| about.contains(&p.partner)));
    let narrow = 2.0 * group.area < walls.max_thickness * outline;
    let from_wall_to_end = to_walls > ONE_SIDE * outline && to_ends > ONE_SIDE * outline && !is_end;
    narrow && (to_walls > 0.5 * outline || from_wall_to_end)
}

/// Where a border in a round corner passes from one wall behind the blend to another without a node that is as near to both, the one that
/// is nearest to being so belongs to both.
fn into_corners(border: &Border, near_walls: &BTreeMap<u32, Vec<(f64, Belongs)>>, of_node: &mut Behind) {
    let edges = border.iter().flat_map(|(a, ends)| ends.iter().map(move |b| (*a, *b)));
    for (a, b) in edges.filter(|(a, b)| a < b) {
        let lists = [a, b].map(|v| near_walls.get(&v).map_or(&[][..], Vec::as_slice));
        let [Some((_, p)), Some((_, q))] = lists.map(<[_]>::first) else { continue };
        let has = |v: u32, group: u32| {
            of_node.get(&v).is_some_and(|behind| behind.iter().any(|b| b.group == group))
        };
        let is_passed = p.group != q.group && has(a, p.group) && has(b, q.group);
        if !is_passed || has(a, q.group) || has(b, p.group) {
            continue;
        }
        let other =
            [(a, lists[0], q.group), (b, lists[1], p.group)].into_iter().filter_map(|(v, list, group)| {
                let (far, other) = list.iter().find(|r| r.1.group == group)?;
                Some((far / list[0].0, v, *other))
            });
        if let Some((_, v, other)) = other.min_by(|a, b| a.0.total_cmp(&b.0)) {
            of_node.entry(v).or_default().push(other);
        }
    }
}

/// Which ways lead off a corner of a group's border across either of its two sides: beside the one is along the other. None where it is no
/// corner.
fn ways_off(p: DVec3, ends: impl Iterator<Item = DVec3>) -> Vec<DVec3> {
    let along: Vec<DVec3> = ends.map(|end| (end - p).normalize_or_zero()).collect();
    match along[..] {
        [a, b] if a.dot(b).abs() < CORNER => {
            vec![-(a - b * a.dot(b)).normalize_or_zero(), -(b - a * a.dot(b)).normalize_or_zero()]
        }
        _ => Vec::new(),
    }
}

/// The mean normal of the faces of a group about a node of it.
fn group_normal_at(solid: &Solid, segments: &Segments, star: &Star, b: &Belongs) -> DVec3 {
    if let Some(plane) = segments.group(b.group).plane {
        return plane.normal;
    }
    let about = star.of(b.at).iter().map(|c| c / 3).filter(|f| segments.of(*f) == b.group);
    about.map(|f| solid.normals[f as usize]).sum::<DVec3>().normalize_or_zero()
}

/// The node that one comes to from `at` along a border as long as it gets nearer. Edges of a fine fillet may all slant the same way, and lead
/// far aside.
fn nearest_along(border: &Border, mut at: u32, distance: impl Fn(u32) -> f64) -> u32 {
    while let Some(next) = border.get(&at).and_then(|ends| {
        let nearer = ends.iter().copied().filter(|end| distance(*end) < distance(at));
        nearer.min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
    }) {
        at = next;
    }
    at
}

/// The point of a line between two others that is nearest to one.
fn on_segment(p: DVec3, a: DVec3, b: DVec3) -> DVec3 {
    let ab = b - a;
    let along = (p - a).dot(ab) / ab.length_squared().max(f64::MIN_POSITIVE);
    a + ab * along.clamp(0.0, 1.0)
}

/// For every node, the nearest of some nodes along the edges, and how far it is.
fn nearest(solid: &Solid, links: &BTreeMap<u32, Vec<u32>>, from: impl Iterator<Item = u32>) -> Nearest {
    let mut found = Nearest::new();
    let mut queue: BinaryHeap<Reached> = from.map(|v| Reverse((0, v, v))).collect();
    while let Some(Reverse((bits, node, at))) = queue.pop() {
        let distance = f64::from_bits(bits);
        if found.contains_key(&node) {
            continue;
        }
        found.insert(node, (distance, at));
        for &next in links.get(&node).map_or(&[][..], Vec::as_slice) {
            if !found.contains_key(&next) {
                let step = solid.mesh.positions[node as usize].distance(solid.mesh.positions[next as usize]);
                queue.push(Reverse(((distance + step).to_bits(), next, at)));
            }
        }
    }
    found
}
