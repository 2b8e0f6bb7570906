//! Face triangulation: attribute nodes and lines of a face become real nodes and edges.
//!
//! ```text
//!         c                   c
//!        / \                 /|\
//!       /   ×               / | ×
//!      /  ·  \      →      /  ·/ \
//!     /       \           / / \ \ \
//!    a----×----b         a----×----b
//! ```
//!
//! Nodes in the face and on its sides become nodes, lines between them edges, by constrained Delaunay triangulation in
//! the face's plane; lines that cross get a node there. Sides that get nodes are cut on all partners of a joint, and
//! every face on them is cut along. The attributes stay and lie on the new nodes from now on.
//!
//! In K3 terms (Wang et al., table 3), for k inner nodes, crossings included, m nodes on sides: kill_face_make_chole for
//! every face concerned, split_edge m times, make_vertex_edge k times, make_edge_chole and make_face_kill_chole for the
//! rest. Deltas on an inner face whose neighbours are on no joint: v + k + m, e + 3k + 3m, f + 2k + 2m.

mod cut;

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use cut::{Numbers, apply};

use super::face_mesh::{FaceInput, FaceMesh};
use super::{Editor, Operation};
use crate::body::attribute::Carrier;
use crate::body::{AttributeNodeId, Body, FaceId, NONE, NodeId, Surface, SurfaceId};

/// Why a face was not triangulated.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TriangulateError {
    /// No such face.
    #[error("surface {surface} has no face {face}")]
    NoFace {
        /// Surface.
        surface: SurfaceId,
        /// Face.
        face: FaceId,
    },
    /// Nothing lies in the face or on its sides.
    #[error("face {face} of surface {surface} carries no attribute nodes that could become real ones")]
    NothingToDo {
        /// Surface.
        surface: SurfaceId,
        /// Face.
        face: FaceId,
    },
    /// Points of a face lie too near each other.
    #[error(
        "points in face {face} of surface {surface} lie too near each other or a side: merge or move them"
    )]
    Crowded {
        /// Surface of the face that could not be cut.
        surface: SurfaceId,
        /// The face.
        face: FaceId,
    },
    /// Two sides of the face are one edge of the body.
    #[error(
        "face {face} of surface {surface} is folded: a joint makes two of its sides one; kill the joint first"
    )]
    Folded {
        /// Surface.
        surface: SurfaceId,
        /// Face.
        face: FaceId,
    },
    /// Ids would run out.
    #[error("surface {0} has no ids left for more edges")]
    TooLarge(SurfaceId),
}

/// What a face was cut into.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FaceTriangulation {
    /// The parts of the face; the first has its number.
    pub faces: Vec<FaceId>,
    /// Attribute nodes with the nodes that they have become or lie on.
    pub nodes: Vec<(AttributeNodeId, NodeId)>,
    /// Nodes where lines crossed.
    pub crossings: Vec<NodeId>,
}

/// Points nearer than this to a corner, a side or each other, in areal coordinates, are taken to be there.
const NEAR: f64 = 1e-9;

/// Where an attribute node lies in the face that is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    Corner(usize),
    /// Parameter along the face.
    Side(usize, f64),
    Inner([f64; 3]),
}

impl Place {
    fn of(areal: [f64; 3]) -> Self {
        if let Some(i) = (0..3).find(|&i| areal[i] > 1.0 - NEAR) {
            return Self::Corner(i);
        }
        match (0..3).find(|&i| areal[i] < NEAR) {
            Some(i) => {
                let [p, q] = [(i + 1) % 3, (i + 2) % 3];
                Self::Side(p, areal[q] / (areal[p] + areal[q]))
            }
            None => Self::Inner(areal),
        }
    }
}

/// The cut of one surface, found before anything is changed.
#[derive(Clone, Debug)]
struct SurfacePlan {
    /// Edges that get nodes, in order, with parameters along the edge and positions.
    edges: Vec<(u32, Vec<(f64, DVec3)>)>,
    faces: Vec<(u32, FaceMesh)>,
}

/// The face's input with what lies in it.
struct Target {
    input: FaceInput,
    /// The local point of every attribute node that lies in the face or on its boundary.
    points: BTreeMap<u32, u32>,
    /// Consecutive nodes of lines in the face, with the line of the input between them.
    steps: BTreeMap<[u32; 2], Step>,
}

#[derive(Clone, Copy, Debug)]
enum Step {
    Line(usize),
    /// Along a side.
    Side(usize),
}

impl Editor {
    /// Makes real nodes and edges of the attribute nodes and edges in a face and on its sides; see the module. Numbers:
    /// new nodes on edges in order of the edges, then inner ones; parts of edges, then inner edges; the face and every
    /// other face concerned keep their numbers as their first parts.
    ///
    /// # Errors
    /// See [`TriangulateError`]; nothing is changed then. O(attributes · log + edges of the chains concerned).
    pub fn triangulate_face(
        &mut self,
        surface: SurfaceId,
        face: FaceId,
    ) -> Result<FaceTriangulation, TriangulateError> {
        let (plans, target) = plan(&self.body, surface, face)?;
        let mut deltas = Vec::with_capacity(plans.len());
        let mut result = None;
        for (id, plan) in &plans {
            let numbers = Numbers::new(self.body.surface(*id), plan);
            let own = (*id == surface).then_some((face, &target));
            if own.is_some() {
                result = Some(outcome(plan, &numbers, face, &target));
            }
            deltas.push(apply(&mut self.body, *id, plan, &numbers, own));
        }
        self.log_deltas(Operation::TriangulateFace { surface, face }, deltas);
        result.ok_or(TriangulateError::NothingToDo { surface, face })
    }
}

fn outcome(plan: &SurfacePlan, numbers: &Numbers, face: FaceId, target: &Target) -> FaceTriangulation {
    let k = plan.faces.iter().position(|(f, _)| *f == face.0).unwrap_or(0);
    let points = &numbers.points[k];
    FaceTriangulation {
        faces: numbers.children[k].iter().map(|&f| FaceId(f)).collect(),
        nodes: target
            .points
            .iter()
            .map(|(&n, &p)| (AttributeNodeId(n), NodeId(points[p as usize])))
            .collect(),
        crossings: points[target.input.points().len()..].iter().map(|&v| NodeId(v)).collect(),
    }
}

impl Target {
    fn new(s: &Surface, face: FaceId) -> Self {
        let mut places: BTreeMap<u32, Place> = BTreeMap::new();
        for (n, node) in s.attribute_nodes.iter().enumerate() {
            if let Some(areal) = s.areal_in(node, face.0) {
                places.insert(n as u32, Place::of(areal));
            }
        }
        let mut input = FaceInput::default();
        for place in places.values() {
            match *place {
                Place::Corner(_) => {}
                Place::Side(i, u) => input.sides[i].push(u),
                Place::Inner(areal) => {
                    let same = |p: &[f64; 3]| (0..3).all(|k| (p[k] - areal[k]).abs() <= NEAR);
                    if !input.inner.iter().any(same) {
                        input.inner.push(areal);
                    }
                }
            }
        }
        for side in &mut input.sides {
            side.sort_by(f64::total_cmp);
            side.dedup_by(|b, a| *b - *a <= NEAR);
        }
        let mut target = Self { input, points: BTreeMap::new(), steps: BTreeMap::new() };
        target.points = places.iter().map(|(&n, place)| (n, target.point(place))).collect();
        let index = std::cell::OnceCell::new();
        for line in &s.attribute_edges {
            for step in line.nodes.windows(2) {
                let [a, b] = [step[0].0, step[1].0];
                let (Some(&p), Some(&q)) = (target.points.get(&a), target.points.get(&b)) else { continue };
                let [m, n] = [a, b].map(|n| &s.attribute_nodes[n as usize]);
                if p == q || !matches!(s.carrier(m, n, &index), Some(Carrier::Face(_))) {
                    continue;
                }
                let sides = target.input.sides_of_points(p, q);
                let step = match sides {
                    Some(i) => Step::Side(i),
                    None => {
                        let known = target.input.lines.iter().position(|l| *l == [p, q] || *l == [q, p]);
                        Step::Line(known.unwrap_or_else(|| {
                            target.input.lines.push([p, q]);
                            target.input.lines.len() - 1
                        }))
                    }
                };
                target.steps.insert([a, b], step);
            }
        }
        target
    }

    /// Local point of a place.
    fn point(&self, place: &Place) -> u32 {
        let lengths: [usize; 3] = [0, 1, 2].map(|i| self.input.sides[i].len());
        let nearest = |errors: &mut dyn Iterator<Item = f64>| {
            errors.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(k, _)| k)
        };
        (match *place {
            Place::Corner(i) => i,
            Place::Side(i, u) => {
                let k = nearest(&mut self.input.sides[i].iter().map(|w| (w - u).abs()));
                3 + lengths[..i].iter().sum::<usize>() + k
            }
            Place::Inner(areal) => {
                let error = |p: &[f64; 3]| (0..3).map(|k| (p[k] - areal[k]).abs()).sum::<f64>();
                3 + lengths.iter().sum::<usize>() + nearest(&mut self.input.inner.iter().map(error))
            }
        }) as u32
    }

    fn is_empty(&self) -> bool {
        self.input.inner.is_empty()
            && self.input.lines.is_empty()
            && self.input.sides.iter().all(Vec::is_empty)
    }
}

fn plan(
    body: &Body,
    surface: SurfaceId,
    face: FaceId,
) -> Result<(BTreeMap<SurfaceId, SurfacePlan>, Target), TriangulateError> {
    let missing = TriangulateError::NoFace { surface, face };
    let s = body.surfaces.get(surface.index()).filter(|s| s.is_face(face)).ok_or(missing)?;
    let target = Target::new(s, face);
    if target.is_empty() {
        return Err(TriangulateError::NothingToDo { surface, face });
    }
    let mut cuts: BTreeMap<(SurfaceId, u32), Vec<(f64, DVec3)>> = BTreeMap::new();
    for (i, side) in target.input.sides.iter().enumerate().filter(|(_, side)| !side.is_empty()) {
        let d = s.face_side(face, i);
        let [a, b] = s.edges[d.edge().index()].map(|v| s.positions[v as usize]);
        let along = |u: f64| if d.is_reversed() { 1.0 - u } else { u };
        let mut points: Vec<(f64, DVec3)> =
            side.iter().map(|&u| (along(u), a * (1.0 - along(u)) + b * along(u))).collect();
        points.sort_by(|p, q| p.0.total_cmp(&q.0));
        let own = body.runs_against_joint(surface, d.edge());
        for (t, partner) in body.partners(surface, d.edge()) {
            // A face folded onto itself: two of its sides are one edge of the body.
            if t == surface && s.face_edges[face.index()].contains(&partner.edge().0) {
                return Err(TriangulateError::Folded { surface, face });
            }
            let mut mirrored = points.clone();
            if partner.is_reversed() != own {
                mirrored.iter_mut().for_each(|(u, _)| *u = 1.0 - *u);
                mirrored.reverse();
            }
            cuts.insert((t, partner.edge().0), mirrored);
        }
        cuts.insert((surface, d.edge().0), points);
    }
    let mut plans: BTreeMap<SurfaceId, SurfacePlan> = BTreeMap::new();
    plans.insert(surface, SurfacePlan { edges: Vec::new(), faces: Vec::new() });
    for ((t, e), points) in cuts {
        let plan = plans.entry(t).or_insert_with(|| SurfacePlan { edges: Vec::new(), faces: Vec::new() });
        plan.edges.push((e, points));
    }
    for (&id, plan) in &mut plans {
        let t = body.surface(id);
        let mut touched: BTreeSet<u32> =
            plan.edges.iter().flat_map(|(e, _)| t.edge_faces[*e as usize]).collect();
        touched.remove(&NONE);
        if id == surface {
            touched.insert(face.0);
        }
        for f in touched {
            let own = (id, f) == (surface, face.0);
            let input = if own { target.input.clone() } else { plan.sides(t, f) };
            let mesh = input.cut(t.corners(FaceId(f)));
            let mesh = mesh.ok_or(TriangulateError::Crowded { surface: id, face: FaceId(f) })?;
            plan.faces.push((f, mesh));
        }
        let more: usize = plan.edges.iter().map(|(_, p)| p.len()).sum::<usize>()
            + plan.faces.iter().map(|(_, m)| 3 * m.points.len()).sum::<usize>();
        if t.edges.len() + more >= 1 << 31 {
            return Err(TriangulateError::TooLarge(id));
        }
    }
    Ok((plans, target))
}

impl SurfacePlan {
    fn place(&self, e: u32) -> Option<usize> {
        self.edges.binary_search_by_key(&e, |(x, _)| *x).ok()
    }

    /// The input of a face that only gets nodes on its sides.
    fn sides(&self, s: &Surface, f: u32) -> FaceInput {
        let mut input = FaceInput::default();
        for i in 0..3 {
            let d = s.face_side(FaceId(f), i);
            if let Some(k) = self.place(d.edge().0) {
                let mut side: Vec<f64> = self.edges[k].1.iter().map(|(u, _)| *u).collect();
                if d.is_reversed() {
                    side.iter_mut().for_each(|u| *u = 1.0 - *u);
                    side.reverse();
                }
                input.sides[i] = side;
            }
        }
        input
    }
}
