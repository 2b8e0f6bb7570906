//! Shortest paths on the surface.
//!
//! A search over some points on every edge finds a strip of faces; in the unfolded strip the shortest path is a taut string.
//! Where it bends about a node whose other side measures less than π, the strip moves to the other side and the path gets
//! shorter (Xin and Wang 2007). At the end the path is a geodesic: straight in every unfolding, bending only about nodes
//! with at least π on both sides or at the mesh's boundary. It is the shortest near its strip, not proven the shortest
//! of all: on the far side of a hill or a limb another may be shorter by a little.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f64::consts::PI;

use glam::DVec3;

use super::strip::{Bend, Strip};
use super::welded::welded;
use super::{Adjacency, Closest, ClosestPoint};
use crate::TriMesh;

/// A path on the surface of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfacePath {
    /// Its points: the ends, and where it crosses edges.
    pub points: Vec<DVec3>,
    /// The face that holds the piece from point `i` to the next; one fewer than points.
    pub faces: Vec<u32>,
    /// Its length.
    pub length: f64,
}

/// A mesh prepared for many shortest paths. Nodes at the same place count as one.
#[derive(Clone, Debug)]
pub struct Geodesics {
    mesh: TriMesh,
    adjacency: Adjacency,
    closest: ClosestPoint,
    /// Points that the search goes through: those of edge `e` are `steps[step_starts[e]..step_starts[e + 1]]`.
    steps: Vec<DVec3>,
    step_starts: Vec<u32>,
    edge_of_step: Vec<u32>,
}

/// The shortest path on the surface from the point closest to `from` to the one closest to `to`: see [`Geodesics`],
/// which is faster for many. `None` where no path joins them.
pub fn shortest_path(mesh: &TriMesh, from: DVec3, to: DVec3) -> Option<Vec<DVec3>> {
    Geodesics::new(mesh).path(from, to).map(|path| path.points)
}

const NONE: u32 = u32::MAX;
/// Distance of the search's points on an edge, in mean edge lengths, and the most on one edge: with about three an edge
/// the search is a few per cent off, so that it seldom chooses the wrong side of an obstacle.
const STEP: f64 = 0.4;
const MOST_STEPS: f64 = 8.0;

impl Geodesics {
    /// Prepares the mesh. O(n log n).
    pub fn new(mesh: &TriMesh) -> Self {
        let mesh = welded(mesh);
        let adjacency = Adjacency::new(&mesh);
        let ends = |edge: &[u32; 2]| edge.map(|v| mesh.positions[v as usize]);
        let length = |edge: &[u32; 2]| ends(edge)[0].distance(ends(edge)[1]);
        let edges = adjacency.edges();
        let mean = edges.iter().map(length).sum::<f64>() / edges.len().max(1) as f64;
        let (mut steps, mut step_starts, mut edge_of_step) = (Vec::new(), vec![0], Vec::new());
        for (number, edge) in edges.iter().enumerate() {
            let count = (length(edge) / (STEP * mean)).round().clamp(1.0, MOST_STEPS);
            let [a, b] = ends(edge);
            for k in 0..count as u32 {
                steps.push(a.lerp(b, (f64::from(k) + 0.5) / count));
                edge_of_step.push(number as u32);
            }
            step_starts.push(steps.len() as u32);
        }
        Self { closest: ClosestPoint::new(&mesh), mesh, adjacency, steps, step_starts, edge_of_step }
    }

    /// The shortest path between the surface points closest to `from` and `to`. `None` without faces, for points that
    /// are not finite, and where no faces joined by edges lead from one to the other. O(n log n) at worst; the search
    /// heads for the target and usually sees a small part of the mesh.
    pub fn path(&self, from: DVec3, to: DVec3) -> Option<SurfacePath> {
        let (start, end) = (self.closest.closest(from)?, self.closest.closest(to)?);
        let (source, target) = (start.point, end.point);
        let straight = |face| SurfacePath {
            points: vec![source, target],
            faces: vec![face],
            length: source.distance(target),
        };
        let (first_faces, last_faces) = (self.faces_about(&start), self.faces_about(&end));
        if let Some(common) = first_faces.iter().find(|face| last_faces.contains(face)) {
            return Some(straight(*common));
        }
        let mut strip = self.search(&first_faces, source, &last_faces, target)?;
        let mut taut = strip.taut(&self.mesh.positions, &self.mesh.faces, source, target);
        // Every round shortens the path; the limit only guards against rounding.
        for _ in 0..10 * strip.faces.len() + 100 {
            let mut moved = strip.clone();
            if !self.move_aside(&mut moved, &taut.bends) {
                break;
            }
            moved.simplify();
            if moved.portals.is_empty() {
                return Some(straight(moved.faces[0]));
            }
            let shorter = moved.taut(&self.mesh.positions, &self.mesh.faces, source, target);
            if shorter.length >= taut.length {
                // All bends at once went too far: one at a time, if that helps.
                let Some((better, shorter)) = self.move_one(&strip, &taut.bends, source, target, taut.length)
                else {
                    break;
                };
                (strip, taut) = (better, shorter);
                continue;
            }
            (strip, taut) = (moved, shorter);
        }
        let mut path = SurfacePath { points: vec![source], faces: Vec::new(), length: 0.0 };
        for (point, face) in taut.points.iter().chain([&target]).zip(&strip.faces) {
            let last = path.points[path.points.len() - 1];
            if *point != last {
                path.length += last.distance(*point);
                path.points.push(*point);
                path.faces.push(*face);
            }
        }
        if path.faces.is_empty() {
            return Some(straight(strip.faces[0]));
        }
        Some(path)
    }

    /// The faces that hold a point: several where it lies on an edge or a node.
    fn faces_about(&self, point: &Closest) -> Vec<u32> {
        let mut faces = vec![point.face];
        let between: Vec<usize> = (0..3).filter(|k| point.barycentric[*k] != 0.0).collect();
        let nodes: Vec<u32> = between.iter().map(|k| self.mesh.faces[point.face as usize][*k]).collect();
        if nodes.len() == 3 {
            return faces;
        }
        // Across all edges that hold the point.
        let mut done = 0;
        while done < faces.len() {
            let face = faces[done];
            done += 1;
            for edge in (0..3).filter_map(|k| self.adjacency.edge_of(3 * face + k)) {
                if nodes.iter().all(|node| self.adjacency.edges()[edge as usize].contains(node)) {
                    for other in self.adjacency.half_edges(edge).iter().map(|h| h / 3) {
                        if !faces.contains(&other) {
                            faces.push(other);
                        }
                    }
                }
            }
        }
        faces
    }

    /// A strip of faces from one of `from` to one of `to`: A* over points on the edges.
    fn search(&self, from: &[u32], source: DVec3, to: &[u32], target: DVec3) -> Option<Strip> {
        // Distance so far, the step before, the face between the two.
        let mut known = vec![(f64::INFINITY, NONE, NONE); self.steps.len()];
        let mut heap = BinaryHeap::new();
        // Length, last step and last face.
        let mut goal = (f64::INFINITY, NONE, NONE);
        let at = |step: u32| self.steps[step as usize];
        // Distances are not negative: their bits are in the same order.
        let priority = |cost: f64, step: u32| Reverse(((cost + at(step).distance(target)).to_bits(), step));
        let sides = |face: u32| (0..3).filter_map(move |k| self.adjacency.edge_of(3 * face + k));
        let steps = |edge: u32| self.step_starts[edge as usize]..self.step_starts[edge as usize + 1];
        for (face, step) in
            from.iter().flat_map(|face| sides(*face).flat_map(steps).map(move |step| (*face, step)))
        {
            let cost = source.distance(at(step));
            if cost < known[step as usize].0 {
                known[step as usize] = (cost, NONE, face);
                heap.push(priority(cost, step));
            }
        }
        while let Some(Reverse((bits, step))) = heap.pop() {
            if f64::from_bits(bits) >= goal.0 {
                break;
            }
            let (cost, _, via) = known[step as usize];
            if f64::from_bits(bits) > cost + at(step).distance(target) {
                continue;
            }
            let edge = self.edge_of_step[step as usize];
            for face in self.adjacency.half_edges(edge).iter().map(|h| h / 3).filter(|face| *face != via) {
                if to.contains(&face) {
                    let whole = cost + at(step).distance(target);
                    if whole < goal.0 {
                        goal = (whole, step, face);
                    }
                    continue;
                }
                for next in sides(face).filter(|side| *side != edge).flat_map(steps) {
                    let further = cost + at(step).distance(at(next));
                    if further < known[next as usize].0 {
                        known[next as usize] = (further, step, face);
                        heap.push(priority(further, next));
                    }
                }
            }
        }
        let mut strip = Strip { faces: vec![goal.2], portals: Vec::new() };
        let mut step = goal.1;
        while step != NONE {
            let (_, before, via) = known[step as usize];
            strip.portals.push(self.adjacency.edges()[self.edge_of_step[step as usize] as usize]);
            strip.faces.push(via);
            step = before;
        }
        strip.faces.reverse();
        strip.portals.reverse();
        (!strip.portals.is_empty()).then_some(strip)
    }

    /// Moves the strip to the other side of all bends that allow it and do not touch. Whether it moved.
    fn move_aside(&self, strip: &mut Strip, bends: &[Bend]) -> bool {
        let mut moved = false;
        let mut free = strip.portals.len();
        for bend in bends.iter().rev() {
            if bend.portals[1] >= free {
                continue;
            }
            if let Some(around) = self.around(strip, bend) {
                around.replace(strip);
                // The faces before and behind the moved portals belong to the bend too.
                free = bend.portals[0].saturating_sub(1);
                moved = true;
            }
        }
        moved
    }

    /// The first bend whose move alone shortens the path.
    fn move_one(
        &self,
        strip: &Strip,
        bends: &[Bend],
        source: DVec3,
        target: DVec3,
        length: f64,
    ) -> Option<(Strip, super::strip::Taut)> {
        bends.iter().find_map(|bend| {
            let mut moved = strip.clone();
            self.around(strip, bend)?.replace(&mut moved);
            moved.simplify();
            if moved.portals.is_empty() {
                return None;
            }
            let taut = moved.taut(&self.mesh.positions, &self.mesh.faces, source, target);
            (taut.length < length).then_some((moved, taut))
        })
    }

    /// The faces on the other side of a bend, if it is shorter there.
    fn around(&self, strip: &Strip, bend: &Bend) -> Option<Detour> {
        let [first, last] = bend.portals;
        let goal = strip.faces[last + 1];
        let mut face = strip.faces[first];
        let mut side = self.adjacency.find_edge(strip.portals[first][0], strip.portals[first][1])?;
        let mut detour = Detour { portals: [first, last], new_faces: Vec::new(), new_portals: Vec::new() };
        let mut total: f64 =
            strip.faces[first..=last + 1].iter().map(|f| self.corner_angle(*f, bend.node)).sum();
        for _ in 0..self.mesh.faces.len() {
            side = (0..3)
                .filter_map(|k| self.adjacency.edge_of(3 * face + k))
                .find(|edge| *edge != side && self.adjacency.edges()[*edge as usize].contains(&bend.node))?;
            let [a, b] = self.adjacency.half_edges(side) else { return None };
            face = if a / 3 == face { b / 3 } else { a / 3 };
            detour.new_portals.push(self.adjacency.edges()[side as usize]);
            if face == goal {
                return (total - bend.angle < PI - 1e-12).then_some(detour);
            }
            total += self.corner_angle(face, bend.node);
            detour.new_faces.push(face);
        }
        None
    }

    fn corner_angle(&self, face: u32, node: u32) -> f64 {
        let corners = self.mesh.faces[face as usize];
        let Some(k) = corners.iter().position(|v| *v == node) else { return 0.0 };
        let at = |k: usize| self.mesh.positions[corners[k % 3] as usize];
        let (a, b) = (at(k + 1) - at(k), at(k + 2) - at(k));
        a.cross(b).length().atan2(a.dot(b))
    }
}

/// What stands in for the portals about a bend and the faces between them.
struct Detour {
    portals: [usize; 2],
    new_faces: Vec<u32>,
    new_portals: Vec<[u32; 2]>,
}

impl Detour {
    fn replace(self, strip: &mut Strip) {
        let [first, last] = self.portals;
        strip.faces.splice(first + 1..=last, self.new_faces);
        strip.portals.splice(first..=last, self.new_portals);
    }
}
