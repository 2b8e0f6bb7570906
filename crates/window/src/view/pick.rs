//! What of the template lies under the pointer.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use sketch::Sight;

use super::{Eye, Solids};
use crate::model::Wireframe;
use crate::region::Region;
use crate::selection::{Element, Mode};

/// A node within this of the pointer is under it, points.
const NODE_REACH: f64 = 10.0;
/// The same for edges and joints.
const EDGE_REACH: f64 = 7.0;
/// A node may lie this deep behind what is seen and still count as seen, mm: cloth that passes it by.
const NODE_SLACK: f64 = 30.0;
/// Edges are chords; the cloth bulges over them by up to this share of their length.
const BULGE: f64 = 0.25;

/// Where sight is tried about a place, points.
const BESIDE: [(f64, f64); 5] = [(0.0, 0.0), (6.0, 0.0), (-6.0, 0.0), (0.0, 6.0), (0.0, -6.0)];

/// What is needed to find elements.
#[derive(Clone, Copy)]
pub(crate) struct Picker<'a> {
    pub(crate) eye: &'a Eye,
    pub(crate) solids: &'a Solids,
    pub(crate) places: &'a BTreeMap<String, DVec3>,
    pub(crate) wires: &'a Wireframe,
    /// What is hidden can be picked too.
    pub(crate) x_ray: bool,
}

impl Picker<'_> {
    /// Whether a place can be seen, or could through so much cloth. A sight line that grazes cloth goes through much of it,
    /// so at an outline it is enough that one just beside it is free.
    pub(crate) fn sees(&self, p: DVec3, slack: f64) -> bool {
        let camera = &self.eye.camera;
        let (Some(at), Some(scale)) = (camera.project(p), camera.scale_at(p)) else { return false };
        let sight = self.solids.seen_by(self.eye.is_parallel());
        let is_free = |off: DVec2| {
            let beside = p + (camera.right() * off.x - camera.up * off.y) / scale;
            !sight.hides(&camera.ray(at + off), beside, slack)
        };
        self.x_ray || BESIDE.iter().any(|(x, y)| is_free(DVec2::new(*x, *y)))
    }

    /// Whether a node can be seen.
    pub(crate) fn sees_node(&self, p: DVec3) -> bool {
        self.sees(p, NODE_SLACK)
    }

    /// Whether the middle of an edge can be seen.
    pub(crate) fn sees_edge(&self, [a, b]: [DVec3; 2]) -> bool {
        self.sees(a.lerp(b, 0.5), NODE_SLACK + BULGE * a.distance(b))
    }

    /// Everything of a kind under the pointer, what is meant first first.
    pub(crate) fn all(&self, at: DVec2, mode: Mode) -> Vec<Element> {
        match mode {
            Mode::Nodes => self.nodes(at).into_iter().map(Element::Node).collect(),
            Mode::Edges => self.edges(at),
            Mode::Joints => self.joints(at),
            Mode::Patches => self.faces(at),
        }
    }

    /// Nodes under the pointer: the nearest to it first, of those as near the one in front.
    pub(crate) fn nodes(&self, at: DVec2) -> Vec<String> {
        let camera = &self.eye.camera;
        let mut found: Vec<(i64, f64, &String)> = self
            .places
            .iter()
            .filter_map(|(name, p)| {
                let distance = camera.project(*p)?.distance(at);
                let is_near = distance < NODE_REACH && self.sees_node(*p);
                // Three points are one place to the hand.
                is_near.then(|| ((distance / 3.0) as i64, -camera.depth(*p), name))
            })
            .collect();
        found.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(b.2)));
        found.into_iter().map(|(.., name)| name.clone()).collect()
    }

    /// Distance in points from a chord, where it can be seen there.
    fn near_chord(&self, at: DVec2, [a, b]: [DVec3; 2]) -> Option<f64> {
        let (p, q) = (self.eye.camera.project(a)?, self.eye.camera.project(b)?);
        let along = q - p;
        let t = ((at - p).dot(along) / along.length_squared().max(1e-9)).clamp(0.0, 1.0);
        let distance = p.lerp(q, t).distance(at);
        let seen = || self.sees(a.lerp(b, t), NODE_SLACK + BULGE * a.distance(b));
        (distance < EDGE_REACH && seen()).then_some(distance)
    }

    fn edges(&self, at: DVec2) -> Vec<Element> {
        let near = self.wires.edges.iter().filter_map(|edge| {
            let ends = [*self.places.get(&edge.ends[0])?, *self.places.get(&edge.ends[1])?];
            Some((self.near_chord(at, ends)?, Element::Edge(edge.ends.clone())))
        });
        sorted(near.collect())
    }

    fn joints(&self, at: DVec2) -> Vec<Element> {
        let near = self.wires.joints.iter().enumerate().filter_map(|(k, points)| {
            let chords = points.windows(2).filter_map(|w| self.near_chord(at, [w[0], w[1]]));
            Some((chords.min_by(f64::total_cmp)?, Element::Joint(k)))
        });
        sorted(near.collect())
    }

    /// Faces along the line of sight, the front one first; those of the surface that is seen there before all.
    fn faces(&self, at: DVec2) -> Vec<Element> {
        let ray = self.eye.ray(at);
        let seen = self.solids.first(&ray);
        let surface = seen.and_then(|s| s.garment_face).and_then(|f| self.wires.surface_of(f));
        // A twin is picked as what it is the mirror image of.
        let mirror = DVec3::new(-1.0, 1.0, 1.0);
        let image = sketch::Ray { origin: ray.origin * mirror, direction: ray.direction * mirror };
        let rays = if self.wires.twins.is_empty() { vec![ray] } else { vec![ray, image] };
        let mut found: Vec<(bool, f64, Element)> = Vec::new();
        for face in &self.wires.faces {
            let corners: Vec<DVec3> = face.nodes.iter().filter_map(|n| self.places.get(n).copied()).collect();
            let element = Element::Face { surface: face.surface.clone(), face: face.number };
            let own = surface == Some(face.surface.as_str());
            let triangles =
                (1..corners.len().saturating_sub(1)).map(|k| [corners[0], corners[k], corners[k + 1]]);
            let hits = triangles.flat_map(|t| rays.iter().filter_map(move |ray| meets(ray, t)));
            if let Some(distance) = hits.min_by(f64::total_cmp) {
                found.push((!own, distance, element));
            } else if let (true, Some(s)) = (own, seen) {
                // The cloth is seen beside its own flat faces: the nearest of them is meant, after all that are hit.
                let middle = corners.iter().sum::<DVec3>() / corners.len().max(1) as f64;
                let to = if s.place.x * middle.x < 0.0 { s.place * mirror } else { s.place };
                found.push((false, 1e6 + middle.distance(to), element));
            }
        }
        found.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        found.into_iter().map(|(.., e)| e).take(8).collect()
    }

    /// Everything of a kind whose places all lie within a part of the picture.
    pub(crate) fn within(&self, region: &Region, mode: Mode) -> Vec<Element> {
        let inside = |p: &DVec3| self.eye.camera.project(*p).is_some_and(|at| region.holds(at));
        let node = |name: &String| self.places.get(name).is_some_and(&inside);
        match mode {
            Mode::Nodes => self
                .places
                .iter()
                .filter(|(_, p)| inside(p) && self.sees_node(**p))
                .map(|(n, _)| Element::Node(n.clone()))
                .collect(),
            Mode::Edges => {
                let seen = |ends: &[String; 2]| {
                    let at = |k: usize| self.places.get(&ends[k]).copied();
                    at(0).zip(at(1)).is_some_and(|(a, b)| self.sees_edge([a, b]))
                };
                let edges = self.wires.edges.iter().map(|e| &e.ends);
                edges.filter(|e| e.iter().all(node) && seen(e)).map(|e| Element::Edge(e.clone())).collect()
            }
            Mode::Patches => self
                .wires
                .faces
                .iter()
                .filter(|f| f.nodes.iter().all(node))
                .map(|f| Element::Face { surface: f.surface.clone(), face: f.number })
                .collect(),
            Mode::Joints => self
                .wires
                .joints
                .iter()
                .enumerate()
                .filter(|(_, points)| !points.is_empty() && points.iter().all(inside))
                .map(|(k, _)| Element::Joint(k))
                .collect(),
        }
    }
}

fn sorted(mut found: Vec<(f64, Element)>) -> Vec<Element> {
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.1.cmp(&b.1)));
    found.into_iter().map(|(_, e)| e).collect()
}

/// Where a ray meets a triangle (Möller & Trumbore 1997).
fn meets(ray: &sketch::Ray, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let p = ray.direction.cross(ac);
    let s = ray.origin - a;
    let inverse = 1.0 / ab.dot(p);
    let u = s.dot(p) * inverse;
    let q = s.cross(ab);
    let v = ray.direction.dot(q) * inverse;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| ac.dot(q) * inverse).filter(|t| *t > 0.0)
}
