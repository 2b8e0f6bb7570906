//! The outlines of a plate's faces laid over each other.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};

/// Plates with more edges than this are left as they are.
const MOST_EDGES: usize = 10_000;

/// A node of the overlay.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) at: Point2<f64>,
    pub(super) soft: bool,
}

impl HasPosition for Corner {
    type Scalar = f64;
    fn position(&self) -> Point2<f64> {
        self.at
    }
}

pub(super) type Cdt = ConstrainedDelaunayTriangulation<Corner>;

/// The outlines of a plate's faces, seen from the side of the first kept one.
pub(super) struct Outlines {
    pub(super) frame: [DVec3; 2],
    pub(super) origin: DVec3,
    pub(super) places: Vec<DVec2>,
    /// Nodes of the solid, with their places.
    pub(super) nodes: Vec<(u32, u32)>,
    /// Of every place, whether it is only as exact as chords are.
    pub(super) soft: Vec<bool>,
    /// With their groups.
    pub(super) edges: Vec<(u32, [u32; 2])>,
    /// What is nearer than this is one, in mm.
    pub(super) rounding: f64,
}

impl Outlines {
    pub(super) fn lifted(&self, p: DVec2) -> DVec3 {
        let [x, y] = self.frame;
        self.origin + x * p.x + y * p.y
    }

    /// The outlines cut where they cross, and the nodes of their places.
    pub(super) fn overlay(&self) -> Option<(Cdt, BTreeMap<u32, FixedVertexHandle>)> {
        if self.edges.len() > MOST_EDGES {
            return None;
        }
        let mut cdt = Cdt::new();
        let mut handles: BTreeMap<u32, FixedVertexHandle> = BTreeMap::new();
        for v in self.edges.iter().flat_map(|e| e.1) {
            let (p, soft) = (self.places[v as usize], self.soft[v as usize]);
            let at = spade::mitigate_underflow(Point2::new(p.x, p.y));
            handles.insert(v, cdt.insert(Corner { at, soft }).ok()?);
        }
        let mut edges: Vec<[u32; 2]> = self.parts();
        edges.iter_mut().for_each(|[a, b]| (*a, *b) = ((*a).min(*b), (*a).max(*b)));
        edges.sort_unstable();
        edges.dedup();
        for [a, b] in edges {
            let (p, q) = (handles[&a], handles[&b]);
            if p != q {
                cdt.add_constraint_and_split(p, q, |at| Corner { at, soft: false });
            }
        }
        Some((cdt, handles))
    }

    /// The edges cut at places on them.
    fn parts(&self) -> Vec<[u32; 2]> {
        let mut places: Vec<u32> = self.edges.iter().flat_map(|e| e.1).collect();
        places.sort_unstable();
        places.dedup();
        let parts = |(_, [a, b]): &(u32, [u32; 2])| {
            let (p, q) = (self.places[*a as usize], self.places[*b as usize]);
            let along = q - p;
            let on_edge = |v: &u32| {
                let to = self.places[*v as usize] - p;
                let s = to.dot(along) / along.length_squared();
                let is_within = v != a && v != b && s > 0.0 && s < 1.0;
                (is_within && (to - along * s).length() <= self.rounding).then_some((s, *v))
            };
            let mut on: Vec<(f64, u32)> = places.iter().filter_map(on_edge).collect();
            on.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
            let nodes: Vec<u32> = [*a].into_iter().chain(on.into_iter().map(|n| n.1)).chain([*b]).collect();
            nodes.windows(2).map(|w| [w[0], w[1]]).collect::<Vec<_>>()
        };
        self.edges.par_iter().flat_map_iter(parts).collect()
    }

    /// The groups whose outline winds about a point.
    pub(super) fn about(&self, p: DVec2) -> BTreeSet<u32> {
        let mut turns: BTreeMap<u32, i32> = BTreeMap::new();
        for (g, ends) in &self.edges {
            let [a, b] = ends.map(|v| self.places[v as usize]);
            if (a.y <= p.y) != (b.y <= p.y) {
                let left = (b - a).perp_dot(p - a) > 0.0;
                if left == (b.y > a.y) {
                    *turns.entry(*g).or_default() += if b.y > a.y { 1 } else { -1 };
                }
            }
        }
        turns.into_iter().filter(|(_, turns)| *turns != 0).map(|(g, _)| g).collect()
    }
}

/// Twice the area of a region over its outline. O(faces).
pub(super) fn width(cdt: &Cdt, regions: &[Option<usize>], r: usize) -> f64 {
    let is_own = |face: usize| regions[face] == Some(r);
    let area: f64 = cdt.inner_faces().filter(|f| is_own(f.index())).map(|f| f.area()).sum();
    let outline =
        cdt.directed_edges().filter(|e| is_own(e.face().index()) && !is_own(e.rev().face().index()));
    2.0 * area / outline.map(|e| e.length_2().sqrt()).sum::<f64>().max(f64::MIN_POSITIVE)
}

/// The region of every face: what no outline divides. `None` outside.
pub(super) fn regions(cdt: &Cdt) -> Vec<Option<usize>> {
    let mut regions: Vec<Option<usize>> = vec![None; cdt.num_all_faces()];
    let mut count = 0;
    for seed in cdt.inner_faces() {
        if regions[seed.index()].is_some() {
            continue;
        }
        regions[seed.index()] = Some(count);
        let mut stack = vec![seed.fix()];
        while let Some(face) = stack.pop() {
            for edge in cdt.face(face).adjacent_edges() {
                let Some(other) = edge.rev().face().as_inner() else { continue };
                if !edge.is_constraint_edge() && regions[other.index()].is_none() {
                    regions[other.index()] = Some(count);
                    stack.push(other.fix());
                }
            }
        }
        count += 1;
    }
    regions
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    /// Two rectangles that cross in the middle of their sides.
    fn cross() -> Outlines {
        let rectangle = |x: f64, y: f64| [[-x, -y], [x, -y], [x, y], [-x, y]].map(DVec2::from);
        let places = [rectangle(3.0, 1.0), rectangle(1.0, 2.0)].concat();
        let edges = (0..8).map(|k| (k / 4, [k, k / 4 * 4 + (k + 1) % 4])).collect();
        Outlines {
            frame: [DVec3::X, DVec3::Y],
            origin: DVec3::ZERO,
            soft: vec![false; 8],
            nodes: vec![],
            places,
            edges,
            rounding: 1e-9,
        }
    }

    #[test]
    fn outlines_are_cut_where_they_cross() {
        let outlines = cross();
        let (cdt, _) = outlines.overlay().unwrap();
        assert_eq!(cdt.num_vertices(), 12);
        let regions = regions(&cdt);
        // By the groups about it, the area of every region.
        let mut areas: BTreeMap<Vec<u32>, f64> = BTreeMap::new();
        for face in cdt.inner_faces() {
            let Point2 { x, y } = face.center();
            let about = outlines.about(DVec2::new(x, y)).into_iter().collect();
            *areas.entry(about).or_default() += face.area();
        }
        assert_eq!(areas[&vec![0, 1]], 4.0);
        assert_eq!((areas[&vec![0]], areas[&vec![1]]), (8.0, 4.0));
        // One in the middle, four arms, and four corners of the hull that are outside.
        let different: BTreeSet<usize> = regions.into_iter().flatten().collect();
        assert_eq!(different.len(), 9);
    }
}
