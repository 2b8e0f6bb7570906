//! Disks: how the offset goes about a node, from offset point to offset point, and what closes it there.
//!
//! Between two neighbouring runs of a disk there is a *path*: an arc where their wedge is convex, the two sides by way of
//! the node where it is concave, a straight line at a sharp edge. Wedges end in these paths (see [`super::wedges`]), so
//! that what is open after all face-uses and wedges have been offset is, at every node, the cycle of its disk's paths. It
//! is closed by a sphere patch where the disk is convex; by the cone from the node elsewhere, which is the paper's hole
//! filling at sharp edges (Lee & Kim 2001, section 5.4) and vanishes where all paths go by way of the node.

use glam::DVec3;

use super::arcs::{ArcRule, push_arc};
use super::clean_sheet::CleanSheet;
use super::entities::{Entities, previous, use_of};
use super::offsets::Offsets;
use super::polar_polygon::{PolarSide, polar_polygon};
use super::sphere_patch::{solid_angle, sphere_patch};

/// A wedge that turns by more than this, in radians, is convex or concave whatever its offset points say (60°).
const CLEAR_TURN: f64 = std::f64::consts::FRAC_PI_3;
/// Sine of an angle that is none.
const NO_TURN: f64 = 1e-9;
/// Directions that differ by less are opposite (1 − cosine).
const OPPOSITE: f64 = 1e-12;
/// A hole smaller than this share of the squared depth is none.
const NO_AREA: f64 = 1e-9;
/// How far a corner of a polar polygon may be off an arc, as an angle in radians.
const OFF_ARC: f64 = 1e-6;

/// How the offset goes from the offset point of one corner to that of the next about a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Path {
    /// They are one point.
    Same,
    /// Straight on.
    Straight,
    /// To the node and from there.
    ThroughNode,
    /// Along the points `arc_points[first..first + len]`, the last first when `reversed`.
    Arc { first: u32, len: u32, reversed: bool },
}

/// A triangle that closes a disk.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closing {
    pub(super) corners: [u32; 3],
    /// A corner of the disk.
    pub(super) corner: u32,
    /// Whether it fills a hole between thickness faces.
    pub(super) fill: bool,
}

/// Paths and closings of all disks.
#[derive(Debug, Default)]
pub(super) struct Disks {
    /// The path from every corner to the next of its disk, by place.
    pub(super) paths: Vec<Path>,
    /// Inner points of arcs.
    pub(super) arc_points: Vec<u32>,
    pub(super) closings: Vec<Closing>,
    /// Disks at sharp edges with a hole that had to be filled.
    pub(super) holes_filled: usize,
}

impl Disks {
    /// Finds all paths and closes all disks; adds points to the offsets. O(n).
    pub(super) fn new(
        sheet: &CleanSheet,
        entities: &Entities,
        depth: &[f64],
        rule: ArcRule,
        offsets: &mut Offsets,
    ) -> Self {
        let mut disks = Self { paths: vec![Path::Same; entities.place.len()], ..Self::default() };
        let mut walk = Walk {
            sheet,
            entities,
            depth,
            rule,
            offsets,
            node: u32::MAX,
            arcs: Vec::new(),
            ids: Vec::new(),
            xs: Vec::new(),
            edges: Vec::new(),
            points: Vec::new(),
        };
        for d in 0..entities.disks() {
            walk.close(d, &mut disks);
        }
        disks
    }

    /// Appends the points after the first of the path at `place`, from `from` to `to`.
    pub(super) fn push_path(&self, place: usize, node: u32, to: u32, out: &mut Vec<u32>) {
        match self.paths[place] {
            Path::Same => return,
            Path::Straight => {}
            Path::ThroughNode => out.push(node),
            Path::Arc { first, len, reversed } => {
                let inner = &self.arc_points[first as usize..(first + len) as usize];
                if reversed {
                    out.extend(inner.iter().rev());
                } else {
                    out.extend_from_slice(inner);
                }
            }
        }
        out.push(to);
    }
}

/// The disk at hand.
struct Walk<'a> {
    sheet: &'a CleanSheet,
    entities: &'a Entities,
    depth: &'a [f64],
    rule: ArcRule,
    offsets: &'a mut Offsets,
    node: u32,
    /// Arcs at the node: ends, first inner point, number of inner points.
    arcs: Vec<([u32; 2], u32, u32)>,
    /// Offset points of the disk's corners.
    ids: Vec<u32>,
    /// The same, seen from the node.
    xs: Vec<DVec3>,
    /// Directed edges of the cycle, with the place that they come from.
    edges: Vec<([u32; 2], u32)>,
    points: Vec<DVec3>,
}

impl Walk<'_> {
    fn close(&mut self, d: usize, disks: &mut Disks) {
        let entities = self.entities;
        let corners = entities.disk(d);
        let start = entities.disk_start[d] as usize;
        self.ids.clear();
        self.ids.extend(corners.iter().map(|&c| self.offsets.point[c as usize]));
        if self.ids.iter().all(|&id| id == self.ids[0]) {
            return;
        }
        let node = entities.node[corners[0] as usize];
        if self.node != node {
            self.node = node;
            self.arcs.clear();
        }
        let centre = self.sheet.positions[node as usize];
        self.xs.clear();
        self.xs.extend(self.ids.iter().map(|&id| self.offsets.positions[id as usize] - centre));

        let k = corners.len();
        let is_sharp = |i: usize| entities.is_sharp(previous(corners[i]));
        let mut open = false;
        for i in 0..k {
            open |= is_sharp(i);
            disks.paths[start + i] =
                if is_sharp(i) { Path::Straight } else { self.path_kind(corners, i, (i + 1) % k) };
        }
        if open {
            for i in (0..k).filter(|&i| is_sharp(i)) {
                disks.paths[start + i] = self.sharp_path(corners, i);
            }
        }
        let paths = start..start + k;
        let patch = if open { None } else { self.convex_patch(&disks.paths[paths.clone()]) };
        let polar = if open || patch.is_some() {
            Vec::new()
        } else {
            self.polar_sides(corners, &disks.paths[paths.clone()])
        };
        let mut polar_cycle = Vec::new();
        if !polar.is_empty() {
            polar_cycle = self.polar_arcs(corners, start, &polar, disks);
        }
        for i in 0..k {
            if disks.paths[start + i] == (Path::Arc { first: 0, len: 0, reversed: false }) {
                disks.paths[start + i] = self.arc(corners, i, (i + 1) % k, &mut disks.arc_points);
            }
        }
        self.gather_edges(start, disks);
        if let Some((direction, volume)) = patch {
            let cycle: Vec<u32> = self.edges.iter().map(|e| e.0[0]).collect();
            self.push_patch(&cycle, direction, volume, corners[0], disks);
            return;
        }
        if !polar_cycle.is_empty() {
            let directions: Vec<DVec3> = polar.iter().map(|s| s.from).collect();
            let direction = directions.iter().sum::<DVec3>().normalize_or_zero();
            if let Some(angle) = solid_angle(&directions, direction) {
                let depth = self.xs[0].length();
                self.push_patch(&polar_cycle, direction, angle * depth.powi(3) / 3.0, corners[0], disks);
                for (i, &from) in polar_cycle.iter().enumerate() {
                    let to = polar_cycle[(i + 1) % polar_cycle.len()];
                    self.edges.push(([to, from], 0));
                }
            }
        }
        self.cone(corners, open, disks);
    }

    /// The path over the wedge between corners `i` and `j = i + 1` of a disk, with a blank where it is an arc.
    fn path_kind(&self, corners: &[u32], i: usize, j: usize) -> Path {
        if self.ids[i] == self.ids[j] {
            return Path::Same;
        }
        let turn = self.entities.turn[corners[j] as usize];
        let blank = Path::Arc { first: 0, len: 0, reversed: false };
        if turn.abs() > CLEAR_TURN {
            return if turn > 0.0 { blank } else { Path::ThroughNode };
        }
        let (x, y) = (self.xs[i], self.xs[j]);
        let across = self.entities.direction(self.sheet, corners[j]).dot(y.cross(x));
        let tight = |c: u32| self.offsets.tight[use_of(c) as usize];
        match across / (x.length() * y.length()) {
            // Offsets that end early have no arc about them.
            sine if sine > NO_TURN && (tight(corners[i]) || tight(corners[j])) => Path::Straight,
            sine if sine > NO_TURN => blank,
            sine if sine < -NO_TURN => Path::ThroughNode,
            _ => Path::Straight,
        }
    }

    /// The path at a sharp edge: straight, but by way of the node where the node is on it and no other thickness face
    /// has the same line as its end.
    fn sharp_path(&self, corners: &[u32], i: usize) -> Path {
        let k = corners.len();
        let ends = |i: usize| [self.ids[i], self.ids[(i + 1) % k]];
        let [from, to] = ends(i);
        let back =
            (0..k).filter(|&j| self.entities.is_sharp(previous(corners[j])) && ends(j) == [to, from]).count();
        let same =
            (0..k).filter(|&j| self.entities.is_sharp(previous(corners[j])) && ends(j) == [from, to]).count();
        let (x, y) = (self.xs[i], self.xs[(i + 1) % k]);
        let through = x.dot(y) < -(1.0 - OPPOSITE) * x.length() * y.length();
        if back != same && through { Path::ThroughNode } else { Path::Straight }
    }

    /// Direction and volume of the sphere patch of a convex disk.
    fn convex_patch(&self, paths: &[Path]) -> Option<(DVec3, f64)> {
        if paths.contains(&Path::ThroughNode) {
            return None;
        }
        let ends: Vec<DVec3> =
            (0..paths.len()).filter(|&i| paths[i] != Path::Same).map(|i| self.xs[i]).collect();
        if ends.len() < 3 {
            return None;
        }
        let following = ends.iter().cycle().skip(1);
        let direction =
            ends.iter().zip(following).map(|(a, b)| a.cross(*b)).sum::<DVec3>().normalize_or_zero();
        let angle = solid_angle(&ends, direction)?;
        let radius = ends.iter().map(|x| x.length()).sum::<f64>() / ends.len() as f64;
        Some((direction, angle * radius.powi(3) / 3.0))
    }

    /// The polygon of directions in which the node itself is nearest, where all corners of the disk have one depth and
    /// the polygon's corners lie on arcs.
    fn polar_sides(&self, corners: &[u32], paths: &[Path]) -> Vec<PolarSide> {
        let convex: Vec<bool> = paths.iter().map(|p| matches!(p, Path::Arc { .. })).collect();
        if convex.iter().filter(|c| **c).count() < 3 {
            return Vec::new();
        }
        let k = corners.len();
        let edges: Vec<DVec3> =
            (0..k).map(|i| self.entities.direction(self.sheet, corners[(i + 1) % k])).collect();
        let sides = polar_polygon(&edges, &convex);
        let depth = self.depth[corners[0] as usize];
        let on_arc = |side: &PolarSide, corner: DVec3| {
            let (x, y) = (self.xs[side.edge], self.xs[(side.edge + 1) % k]);
            let bend = x.angle_between(y);
            (x.length() - depth).abs() <= OFF_ARC * depth
                && (y.length() - depth).abs() <= OFF_ARC * depth
                && (corner.angle_between(x) + corner.angle_between(y) - bend).abs() <= OFF_ARC
        };
        let sound = sides
            .iter()
            .enumerate()
            .all(|(s, side)| on_arc(side, side.from) && on_arc(side, sides[(s + 1) % sides.len()].from));
        if sound { sides } else { Vec::new() }
    }

    /// Makes the arcs on which a polar polygon lies, in three parts each, and returns the polygon's cycle of points.
    fn polar_arcs(
        &mut self,
        corners: &[u32],
        start: usize,
        sides: &[PolarSide],
        disks: &mut Disks,
    ) -> Vec<u32> {
        let k = corners.len();
        let depth = self.depth[corners[0] as usize];
        let points: Vec<u32> = sides
            .iter()
            .enumerate()
            .map(|(s, side)| {
                let before = sides[(s + sides.len() - 1) % sides.len()].edge;
                let near = [side.edge, side.edge + 1, before, before + 1].map(|i| i % k);
                match near.iter().find(|&&i| self.xs[i].angle_between(side.from) < OFF_ARC) {
                    Some(&i) => self.ids[i],
                    None => self.add_point(depth * side.from),
                }
            })
            .collect();
        let mut cycle = Vec::new();
        for (s, side) in sides.iter().enumerate() {
            let (i, j) = (side.edge, (side.edge + 1) % k);
            let (p, q) = (points[s], points[(s + 1) % points.len()]);
            let first = disks.arc_points.len() as u32;
            let stops = [self.ids[i], p, q, self.ids[j]];
            let middle = self.arc_middle(corners, i, j);
            let mut from = stops[0];
            for (part, &to) in stops[1..].iter().enumerate().filter(|(_, to)| **to != stops[0]) {
                if to == from {
                    continue;
                }
                let inner = disks.arc_points.len();
                self.push_inner(from, to, middle, &mut disks.arc_points);
                if part == 1 {
                    cycle.push(from);
                    cycle.extend_from_slice(&disks.arc_points[inner..]);
                }
                if to != stops[3] {
                    disks.arc_points.push(to);
                }
                from = to;
            }
            let len = disks.arc_points.len() as u32 - first;
            disks.paths[start + i] =
                if len == 0 { Path::Straight } else { Path::Arc { first, len, reversed: false } };
        }
        cycle
    }

    /// The arc between two corners' offset points, shared by all wedges at the node that have the same ends.
    fn arc(&mut self, corners: &[u32], i: usize, j: usize, arc_points: &mut Vec<u32>) -> Path {
        let (from, to) = (self.ids[i], self.ids[j]);
        let ends = [from.min(to), from.max(to)];
        let known = self.arcs.iter().find(|a| a.0 == ends).copied();
        let (_, first, len) = known.unwrap_or_else(|| {
            let first = arc_points.len() as u32;
            let middle = self.arc_middle(corners, i, j);
            self.push_inner(ends[0], ends[1], middle, arc_points);
            let arc = (ends, first, arc_points.len() as u32 - first);
            self.arcs.push(arc);
            arc
        });
        if len == 0 { Path::Straight } else { Path::Arc { first, len, reversed: from > to } }
    }

    /// The direction away from both faces of a wedge.
    fn arc_middle(&self, corners: &[u32], i: usize, j: usize) -> DVec3 {
        let axis = self.entities.direction(self.sheet, corners[j]);
        let [own, following] = [i, j].map(|c| self.entities.normal(self.sheet, corners[c]));
        (own.cross(axis) - following.cross(axis)).normalize_or_zero()
    }

    /// Adds the inner points of an arc between two points.
    fn push_inner(&mut self, from: u32, to: u32, middle: DVec3, arc_points: &mut Vec<u32>) {
        let centre = self.sheet.positions[self.node as usize];
        let [x, y] = [from, to].map(|id| self.offsets.positions[id as usize] - centre);
        let mut points = std::mem::take(&mut self.points);
        points.clear();
        push_arc(self.rule, x, y, middle, &mut points);
        arc_points.extend(points.iter().map(|p| self.add_point(*p)));
        self.points = points;
    }

    fn add_point(&mut self, x: DVec3) -> u32 {
        self.offsets.positions.push(self.sheet.positions[self.node as usize] + x);
        self.offsets.positions.len() as u32 - 1
    }

    /// The directed edges of the cycle of paths, but those at the node itself.
    fn gather_edges(&mut self, start: usize, disks: &Disks) {
        self.edges.clear();
        let mut path = Vec::new();
        for i in 0..self.ids.len() {
            let mut from = self.ids[i];
            path.clear();
            disks.push_path(start + i, self.node, self.ids[(i + 1) % self.ids.len()], &mut path);
            for &to in &path {
                if from != self.node && to != self.node && from != to {
                    self.edges.push(([from, to], i as u32));
                }
                from = to;
            }
        }
    }

    fn push_patch(&mut self, cycle: &[u32], direction: DVec3, volume: f64, corner: u32, disks: &mut Disks) {
        let centre = self.sheet.positions[self.node as usize];
        let boundary: Vec<DVec3> =
            cycle.iter().map(|&id| self.offsets.positions[id as usize] - centre).collect();
        let patch = sphere_patch(&boundary, direction, volume);
        let first = self.offsets.positions.len() as u32;
        let count = cycle.len() as u32;
        for p in &patch.inner {
            self.add_point(*p);
        }
        disks.closings.extend(patch.triangles.iter().map(|t| Closing {
            corners: t.map(|i| if i < count { cycle[i as usize] } else { first + i - count }),
            corner,
            fill: false,
        }));
    }

    /// Closes what is left of the cycle, opposite edges taken away, by triangles from the node.
    fn cone(&mut self, corners: &[u32], open: bool, disks: &mut Disks) {
        let key = |e: &([u32; 2], u32)| [e.0[0].min(e.0[1]), e.0[0].max(e.0[1])];
        self.edges.sort_by_key(|e| (key(e), e.0, e.1));
        let (mut area, mut depth) = (0.0, 0.0f64);
        for same in self.edges.chunk_by(|a, b| key(a) == key(b)) {
            let forward = same.iter().filter(|e| e.0[0] < e.0[1]).count();
            let left = (2 * forward).abs_diff(same.len());
            // Sorted forward first: those of the side that is more are at its end of the chunk.
            let kept = if 2 * forward > same.len() { &same[..left] } else { &same[same.len() - left..] };
            for &([from, to], place) in kept {
                disks.closings.push(Closing {
                    corners: [self.node, from, to],
                    corner: corners[place as usize],
                    fill: open,
                });
                let centre = self.sheet.positions[self.node as usize];
                let [x, y] = [from, to].map(|id| self.offsets.positions[id as usize] - centre);
                area += x.cross(y).length();
                depth = depth.max(x.length());
            }
        }
        disks.holes_filled += usize::from(open && area > NO_AREA * depth * depth);
    }
}
