//! Plane pieces triangulated anew from their outlines.
//!
//! When walls move to the middle, outlines shrink past nodes inside, holes close to slits, and several pieces come to lie
//! side by side in one plane. Only the outlines count: what they wind about is the piece.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, HasPosition, Point2, RefinementParameters, Triangulation,
};

use super::cells::Cells;
use super::plane::Plane;

/// A node of the triangulation; nodes that refinement adds have no number yet.
#[derive(Clone, Copy, Debug)]
struct Corner {
    at: Point2<f64>,
    node: Option<u32>,
}

impl HasPosition for Corner {
    type Scalar = f64;
    fn position(&self) -> Point2<f64> {
        self.at
    }
}

impl From<Point2<f64>> for Corner {
    fn from(at: Point2<f64>) -> Self {
        Self { at, node: None }
    }
}

/// What is to be triangulated in a plane.
#[derive(Debug)]
pub(super) struct Outline {
    pub(super) plane: Plane,
    /// Directed edges, the piece on the left as seen from the plane's front.
    pub(super) edges: Vec<[u32; 2]>,
    /// Edges that the triangles must not cross.
    pub(super) lines: Vec<[u32; 2]>,
    /// Nodes that may be used inside, far enough from all edges.
    pub(super) inside: Vec<u32>,
}

/// Triangles over old nodes and new ones, which are numbered after the old.
#[derive(Debug, Default)]
pub(super) struct Filled {
    pub(super) faces: Vec<[u32; 3]>,
    pub(super) added: Vec<DVec3>,
    /// Edges that could not be kept: they cross others.
    pub(super) lost: usize,
}

type Cdt = ConstrainedDelaunayTriangulation<Corner>;

/// Triangulates what the outline winds about. With `cells`, triangles inside are refined to about that size; edges
/// of the outline stay as they are. O(n log n).
pub(super) fn fill(outline: &Outline, positions: &[DVec3], cells: Option<Cells>) -> Filled {
    // Drawn so much narrower that cells are as long as wide.
    let strips = cells.and_then(|cells| {
        let strips = cells.strips?;
        Some((strips.across.reject_from(outline.plane.normal).try_normalize()?, strips.long))
    });
    let ([x, y], long) = match strips {
        Some((across, long)) => ([across, outline.plane.normal.cross(across)], long),
        None => (outline.plane.frame(), 1.0),
    };
    let origin = outline.edges.first().map_or(DVec3::ZERO, |e| positions[e[0] as usize]);
    let flat = |v: u32| {
        let p = positions[v as usize] - origin;
        DVec2::new(p.dot(x), p.dot(y) / long)
    };
    let mut cdt = Cdt::new();
    let mut handles = BTreeMap::new();
    let mut numbers = BTreeMap::new();
    let mut filled = Filled::default();
    let all = outline.edges.iter().chain(&outline.lines).flatten().chain(&outline.inside);
    for &node in all {
        if handles.contains_key(&node) {
            continue;
        }
        let p = flat(node);
        let at = spade::mitigate_underflow(Point2::new(p.x, p.y));
        if let Ok(handle) = cdt.insert(Corner { at, node: Some(node) }) {
            // Nodes in one place of the plane are one.
            numbers.entry(handle).or_insert(node);
            handles.insert(node, handle);
        }
    }
    let mut winding: BTreeMap<[usize; 2], i32> = BTreeMap::new();
    let directed = outline.edges.iter().map(|e| (e, 1)).chain(outline.lines.iter().map(|e| (e, 0)));
    for ([a, b], turns) in directed {
        let (Some(&p), Some(&q)) = (handles.get(a), handles.get(b)) else { continue };
        if p == q {
            continue;
        }
        if !cdt.exists_constraint(p, q) {
            cdt.try_add_constraint(p, q);
        }
        // The edge may run over nodes on its way; every part counts.
        let parts = parts(&cdt, p, q);
        if !parts.iter().all(|[a, b]| is_constraint(&cdt, *a, *b)) {
            filled.lost += usize::from(turns != 0);
            continue;
        }
        for [from, to] in parts {
            *winding.entry([from.min(to), from.max(to)]).or_default() +=
                if from < to { turns } else { -turns };
        }
    }
    if let Some(Cells { length, .. }) = cells {
        // Keeping the edges, so that neighbours still agree; outside is refined in vain but not by much.
        let area = 0.433 * length * length;
        let whole: f64 = cdt.inner_faces().map(|f| f.area()).sum();
        let most = (MOST_TIMES * whole / area + 1000.0).min(MOST_ADDED) as usize;
        let parameters = RefinementParameters::<f64>::new()
            .keep_constraint_edges()
            // Edges much shorter than the wanted ones would be surrounded by ever more triangles.
            .with_angle_limit(AngleLimit::from_deg(LEAST_ANGLE))
            .with_min_required_area(LEAST_AREA * area)
            .with_max_allowed_area(area)
            .with_max_additional_vertices(most);
        cdt.refine(parameters);
    }
    let inside = inside_faces(&cdt, &winding);
    let mut added: BTreeMap<usize, u32> = BTreeMap::new();
    let first = positions.len() as u32;
    for face in cdt.inner_faces().filter(|f| inside[f.index()]) {
        let corners = face.vertices().map(|v| {
            let corner = v.data();
            corner.node.map_or_else(
                || {
                    *added.entry(v.index()).or_insert_with(|| {
                        let lifted = origin + x * corner.at.x + y * (long * corner.at.y);
                        filled.added.push(lifted - outline.plane.normal * outline.plane.height(lifted));
                        first + filled.added.len() as u32 - 1
                    })
                },
                |node| numbers.get(&v.fix()).copied().unwrap_or(node),
            )
        });
        filled.faces.push(corners);
    }
    filled
}

/// Most nodes that refinement may add to a plane, and how many times those that its area wants.
const MOST_ADDED: f64 = 4e6;
const MOST_TIMES: f64 = 6.0;
/// Triangles with a smaller angle, in degrees, are refined, unless they are smaller than this share of the wanted area.
const LEAST_ANGLE: f64 = 20.0;
const LEAST_AREA: f64 = 0.1;

/// The parts of a constraint between two nodes: it is split at nodes on its way.
fn parts(
    cdt: &Cdt,
    p: spade::handles::FixedVertexHandle,
    q: spade::handles::FixedVertexHandle,
) -> Vec<[usize; 2]> {
    if cdt.get_edge_from_neighbors(p, q).is_some() {
        return vec![[p.index(), q.index()]];
    }
    let mut on_way = vec![p];
    let line = spade::LineIntersectionIterator::new_from_handles(cdt, p, q);
    for met in line {
        if let spade::Intersection::VertexIntersection(v) = met
            && v.fix() != p
        {
            on_way.push(v.fix());
        }
    }
    on_way.windows(2).map(|w| [w[0].index(), w[1].index()]).collect()
}

fn is_constraint(cdt: &Cdt, a: usize, b: usize) -> bool {
    let [a, b] = [a, b].map(spade::handles::FixedVertexHandle::from_index);
    cdt.exists_constraint(a, b)
}

/// Which faces the edges wind about at least once. O(n).
fn inside_faces(cdt: &Cdt, winding: &BTreeMap<[usize; 2], i32>) -> Vec<bool> {
    let mut turns: Vec<Option<i32>> = vec![None; cdt.num_all_faces()];
    let outer = cdt.outer_face();
    turns[outer.index()] = Some(0);
    let mut stack = Vec::new();
    // From the outside over the hull, then from face to face. An edge's left has one turn more than its right.
    for edge in cdt.directed_edges().filter(|e| e.is_outer_edge()) {
        stack.push((edge.rev().fix(), 0));
    }
    while let Some((edge, from)) = stack.pop() {
        let edge = cdt.directed_edge(edge);
        let face = edge.face();
        if turns[face.index()].is_some() {
            continue;
        }
        let (a, b) = (edge.from().index(), edge.to().index());
        let net = winding.get(&[a.min(b), a.max(b)]).copied().unwrap_or(0);
        let own = from + if a < b { net } else { -net };
        turns[face.index()] = Some(own);
        for next in [edge.next(), edge.prev()] {
            stack.push((next.rev().fix(), own));
        }
    }
    turns.into_iter().map(|t| t.is_some_and(|t| t > 0)).collect()
}
