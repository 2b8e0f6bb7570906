//! The shortest path through a strip of faces: unfold it into the plane and pull the string taut.

use glam::{DVec2, DVec3};

/// A strip of faces that are joined side by side, from the face of the source to the face of the target.
#[derive(Clone, Debug, Default)]
pub(super) struct Strip {
    /// Faces in order.
    pub(super) faces: Vec<u32>,
    /// The two nodes of the side between a face and the next: one fewer than faces.
    pub(super) portals: Vec<[u32; 2]>,
}

/// Where the taut string bends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bend {
    /// The node it bends about.
    pub(super) node: u32,
    /// First and last portal at that node.
    pub(super) portals: [usize; 2],
    /// Angle about the node on the strip's side.
    pub(super) angle: f64,
}

/// The taut string.
#[derive(Clone, Debug)]
pub(super) struct Taut {
    pub(super) length: f64,
    /// Where it crosses each portal.
    pub(super) points: Vec<DVec3>,
    pub(super) bends: Vec<Bend>,
}

/// A portal in the plane, as seen from the source.
#[derive(Clone, Copy)]
struct Flat {
    left: DVec2,
    right: DVec2,
    left_node: u32,
    right_node: u32,
}

impl Strip {
    /// Drops detours that leave a face and come back through the same side.
    pub(super) fn simplify(&mut self) {
        let (mut faces, mut portals): (Vec<u32>, Vec<[u32; 2]>) = (vec![self.faces[0]], Vec::new());
        let same = |a: &[u32; 2], b: &[u32; 2]| a == b || *a == [b[1], b[0]];
        for (face, portal) in self.faces[1..].iter().zip(&self.portals) {
            let back = faces.len() >= 2 && faces[faces.len() - 2] == *face;
            if back && portals.last().is_some_and(|last| same(last, portal)) {
                faces.pop();
                portals.pop();
            } else {
                faces.push(*face);
                portals.push(*portal);
            }
        }
        *self = Self { faces, portals };
    }

    /// The shortest path in the strip from `source` in its first face to `target` in its last. O(portals) but for the
    /// rescans behind each bend.
    pub(super) fn taut(
        &self,
        positions: &[DVec3],
        mesh_faces: &[[u32; 3]],
        source: DVec3,
        target: DVec3,
    ) -> Taut {
        let (flats, start, end) = self.unfold(positions, mesh_faces, source, target);
        let corners = pull(&flats, start, end);
        let mut taut = Taut { length: 0.0, points: Vec::with_capacity(flats.len()), bends: Vec::new() };
        // Corners with their portal: the source before the first, the target behind the last.
        let mut from = start;
        let mut next_portal = 0;
        for k in 0..=corners.len() {
            let (to, last) =
                corners.get(k).map_or((end, flats.len()), |corner| (corner.at, corner.portal + 1));
            taut.length += from.distance(to);
            let along = to - from;
            for flat in &flats[next_portal..last] {
                let (l, r) = (along.perp_dot(flat.left - from), along.perp_dot(flat.right - from));
                let t = if l == r { 0.5 } else { (l / (l - r)).clamp(0.0, 1.0) };
                // Corners are met exactly.
                let t = if flat.left == to || flat.left == from {
                    0.0
                } else if flat.right == to || flat.right == from {
                    1.0
                } else {
                    t
                };
                let [left, right] = [flat.left_node, flat.right_node].map(|v| positions[v as usize]);
                taut.points.push(if t == 1.0 { right } else { left.lerp(right, t) });
            }
            next_portal = last;
            from = to;
        }
        for (k, corner) in corners.iter().enumerate() {
            let before = if k == 0 { start } else { corners[k - 1].at };
            let after = corners.get(k + 1).map_or(end, |next| next.at);
            let has = |flat: &Flat| flat.left_node == corner.node || flat.right_node == corner.node;
            let mut first = flats[..=corner.portal].iter().rposition(|f| !has(f)).map_or(0, |k| k + 1);
            let behind = flats[corner.portal..].iter().position(|f| !has(f));
            let mut last = behind.map_or(flats.len(), |n| corner.portal + n) - 1;
            // Where the string comes or goes along a portal, the strip's part on that side of it is no part of the bend.
            let joins = |flat: &Flat, end: DVec2| flat.left == end || flat.right == end;
            if let Some(k) = flats[first..=last].iter().rposition(|f| joins(f, before)) {
                first += k;
            }
            if let Some(k) = flats[first..=last].iter().position(|f| joins(f, after)) {
                last = first + k;
            }
            // The strip's angle about the corner, face by face: it may be more than a full turn.
            let mut angle = 0.0;
            let mut ray = before - corner.at;
            let others =
                flats[first..=last].iter().map(|f| if f.left_node == corner.node { f.right } else { f.left });
            for other in others.chain([after]) {
                let next = other - corner.at;
                angle += ray.angle_to(next).abs();
                ray = next;
            }
            if before != corner.at && after != corner.at {
                taut.bends.push(Bend { node: corner.node, portals: [first, last], angle });
            }
        }
        taut
    }

    /// The portals laid into the plane, the source and the target.
    fn unfold(
        &self,
        positions: &[DVec3],
        mesh_faces: &[[u32; 3]],
        source: DVec3,
        target: DVec3,
    ) -> (Vec<Flat>, DVec2, DVec2) {
        let at = |v: u32| positions[v as usize];
        let third = |face: u32, [a, b]: [u32; 2]| {
            mesh_faces[face as usize].into_iter().find(|v| *v != a && *v != b).unwrap_or(a)
        };
        let [a, b] = self.portals[0];
        // The first portal lies on the x axis, its left end at 0; the source side is above, walking goes down.
        let (mut left_node, mut right_node) = (b, a);
        let mut left = DVec2::new(at(a).distance(at(b)), 0.0);
        let mut right = DVec2::ZERO;
        let start = place(at(right_node), at(left_node), right, left, source, 1.0);
        let mut flats = Vec::with_capacity(self.portals.len());
        flats.push(Flat { left, right, left_node, right_node });
        for k in 1..self.portals.len() {
            let node = third(self.faces[k], [left_node, right_node]);
            let point = place(at(right_node), at(left_node), right, left, at(node), -1.0);
            if self.portals[k].contains(&left_node) {
                (right, right_node) = (point, node);
            } else {
                (left, left_node) = (point, node);
            }
            flats.push(Flat { left, right, left_node, right_node });
        }
        let end = place(at(right_node), at(left_node), right, left, target, -1.0);
        (flats, start, end)
    }
}

/// The place in the plane of a point beside the side `a b` that lies at `a2 b2`; `side` +1 to the left of it.
fn place(a: DVec3, b: DVec3, a2: DVec2, b2: DVec2, p: DVec3, side: f64) -> DVec2 {
    let along = (b - a).normalize_or_zero();
    let x = (p - a).dot(along);
    let y = ((p - a) - along * x).length();
    let along2 = (b2 - a2).normalize_or_zero();
    a2 + along2 * x + along2.perp() * (side * y)
}

struct Corner {
    at: DVec2,
    node: u32,
    portal: usize,
}

/// The corners of the taut string (funnel algorithm: Chazelle 1982, Lee and Preparata 1984; in the form that starts
/// anew behind each corner).
fn pull(flats: &[Flat], start: DVec2, end: DVec2) -> Vec<Corner> {
    // Positive when `c` lies left of the ray from `a` to `b`.
    let turn = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
    let goal = Flat { left: end, right: end, left_node: u32::MAX, right_node: u32::MAX };
    let portal = |k: usize| flats.get(k).copied().unwrap_or(goal);
    let mut corners: Vec<Corner> = Vec::new();
    let mut apex = start;
    let (mut left, mut right) = ((start, u32::MAX, 0), (start, u32::MAX, 0));
    let mut k = 0;
    while k <= flats.len() {
        let next = portal(k);
        if turn(apex, right.0, next.right) >= 0.0 {
            if apex == right.0 || turn(apex, left.0, next.right) < 0.0 {
                right = (next.right, next.right_node, k);
            } else {
                let corner = left;
                corners.push(Corner { at: corner.0, node: corner.1, portal: corner.2 });
                apex = corner.0;
                (left, right) = (corner, corner);
                k = corner.2 + 1;
                continue;
            }
        }
        if turn(apex, left.0, next.left) <= 0.0 {
            if apex == left.0 || turn(apex, right.0, next.left) > 0.0 {
                left = (next.left, next.left_node, k);
            } else {
                let corner = right;
                corners.push(Corner { at: corner.0, node: corner.1, portal: corner.2 });
                apex = corner.0;
                (left, right) = (corner, corner);
                k = corner.2 + 1;
                continue;
            }
        }
        k += 1;
    }
    // The goal itself may have become a corner.
    corners.retain(|corner| corner.node != u32::MAX);
    // A string along several portals of one node finds it again.
    corners.dedup_by(|next, last| next.node == last.node && next.at == last.at);
    corners
}
