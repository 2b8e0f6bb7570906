//! Which triangles are one facet.

use glam::DVec3;
use mesh_kernel::TriMesh;

use super::FacetRule;

/// A triangle's side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct TriangleSide {
    pub(super) triangle: u32,
    pub(super) side: u8,
}

/// The edges of the triangles.
pub(super) struct Edges {
    /// Edge on every side of every triangle.
    pub(super) of_side: Vec<[u32; 3]>,
    /// Nodes of every edge, the smaller first; edges ascend by them.
    pub(super) nodes: Vec<[u32; 2]>,
    sides: Vec<TriangleSide>,
    first: Vec<u32>,
}

impl Edges {
    pub(super) fn new(triangles: &[[u32; 3]]) -> Self {
        let mut all: Vec<([u32; 2], TriangleSide)> = Vec::with_capacity(3 * triangles.len());
        for (t, face) in (0..).zip(triangles) {
            for side in 0..3u8 {
                let (a, b) = (face[side as usize], face[(side as usize + 1) % 3]);
                all.push(([a.min(b), a.max(b)], TriangleSide { triangle: t, side }));
            }
        }
        all.sort_unstable();
        let mut edges = Self {
            of_side: vec![[0; 3]; triangles.len()],
            nodes: Vec::new(),
            sides: all.iter().map(|x| x.1).collect(),
            first: vec![0],
        };
        for same in all.chunk_by(|a, b| a.0 == b.0) {
            let number = edges.nodes.len() as u32;
            for (_, at) in same {
                edges.of_side[at.triangle as usize][at.side as usize] = number;
            }
            edges.nodes.push(same[0].0);
            edges.first.push(edges.first[number as usize] + same.len() as u32);
        }
        edges
    }

    /// The triangles' sides on an edge.
    pub(super) fn sides(&self, edge: u32) -> &[TriangleSide] {
        &self.sides[self.first[edge as usize] as usize..self.first[edge as usize + 1] as usize]
    }

    /// The other side of an edge that has two.
    pub(super) fn across(&self, at: TriangleSide) -> Option<TriangleSide> {
        match self.sides(self.of_side[at.triangle as usize][at.side as usize]) {
            [a, b] => Some(if *a == at { *b } else { *a }),
            _ => None,
        }
    }
}

/// The facets as sets of triangles.
pub(super) struct Regions {
    /// Facet of every triangle.
    pub(super) of: Vec<u32>,
    pub(super) count: usize,
    /// Whether each facet lies in a plane.
    pub(super) plane: Vec<bool>,
    /// Whether each triangle is wound against its facet's first.
    turned: Vec<bool>,
}

/// A plane that a facet may lie in.
struct Plane {
    at: DVec3,
    normal: DVec3,
    tolerance: f64,
}

impl Plane {
    fn of(mesh: &TriMesh, triangle: u32, tolerance: f64) -> Self {
        let at = mesh.positions[mesh.faces[triangle as usize][0] as usize];
        Self { at, normal: mesh.area_normal(triangle).normalize_or_zero(), tolerance }
    }

    fn holds(&self, mesh: &TriMesh, triangle: u32) -> bool {
        mesh.corners(triangle).iter().all(|p| (*p - self.at).dot(self.normal).abs() <= self.tolerance)
    }
}

impl Regions {
    /// Grows facets over edges with two triangles of one group, from large triangles to small, whose planes are surest.
    pub(super) fn grow(
        mesh: &TriMesh,
        edges: &Edges,
        groups: &[u32],
        rule: FacetRule,
        tolerance: f64,
    ) -> Self {
        const NONE: u32 = u32::MAX;
        let n = mesh.faces.len();
        let mut seeds: Vec<u32> = (0..n as u32).collect();
        let area: Vec<f64> = (0..n as u32).map(|t| mesh.area_normal(t).length()).collect();
        seeds.sort_by(|a, b| area[*b as usize].total_cmp(&area[*a as usize]).then(a.cmp(b)));
        let (mut of, mut turned, mut plane) = (vec![NONE; n], vec![false; n], Vec::new());
        let mut stack = Vec::new();
        for seed in seeds {
            if of[seed as usize] != NONE {
                continue;
            }
            let number = plane.len() as u32;
            let in_plane = Plane::of(mesh, seed, tolerance);
            let mut flat = true;
            of[seed as usize] = number;
            stack.push(seed);
            while let Some(t) = stack.pop() {
                for side in 0..3 {
                    let Some(over) = edges.across(TriangleSide { triangle: t, side }) else { continue };
                    let next = over.triangle;
                    if of[next as usize] != NONE || groups[next as usize] != groups[t as usize] {
                        continue;
                    }
                    let against = same_direction(mesh, t, side, over);
                    let turn = turned[t as usize] != against;
                    // Folded flat onto its neighbour a triangle lies in the plane too, upside down.
                    let up = if turn == turned[seed as usize] { 1.0 } else { -1.0 };
                    let coplanar =
                        in_plane.holds(mesh, next) && mesh.area_normal(next).dot(in_plane.normal) * up > 0.0;
                    if rule == FacetRule::Planes && !coplanar {
                        continue;
                    }
                    flat &= coplanar;
                    of[next as usize] = number;
                    turned[next as usize] = turn;
                    stack.push(next);
                }
            }
            plane.push(flat);
        }
        let mut regions = Self { of, count: plane.len(), plane, turned };
        regions.number_by_first_triangle();
        regions
    }

    fn number_by_first_triangle(&mut self) {
        let mut new = vec![u32::MAX; self.count];
        let mut next = 0;
        for r in &mut self.of {
            if new[*r as usize] == u32::MAX {
                new[*r as usize] = next;
                next += 1;
            }
            *r = new[*r as usize];
        }
        let mut plane = vec![false; self.count];
        for (old, flat) in self.plane.iter().enumerate() {
            plane[new[old] as usize] = *flat;
        }
        self.plane = plane;
        // The first triangle of the file gives the facet's front.
        let mut flip: Vec<Option<bool>> = vec![None; self.count];
        for (t, turned) in self.turned.iter_mut().enumerate() {
            *turned ^= *flip[self.of[t] as usize].get_or_insert(*turned);
        }
    }

    /// Winds triangles as their facets' first.
    pub(super) fn turn(&self, triangles: &mut [[u32; 3]]) {
        for (face, turned) in triangles.iter_mut().zip(&self.turned) {
            if *turned {
                face.swap(1, 2);
            }
        }
    }

    /// Whether both sides of an edge belong to one facet, so that it is no line.
    pub(super) fn is_inner(&self, edges: &Edges, edge: u32) -> bool {
        match edges.sides(edge) {
            [a, b] => self.of[a.triangle as usize] == self.of[b.triangle as usize],
            _ => false,
        }
    }

    /// A node and the facet where turned triangles still disagree.
    pub(super) fn one_sided(&self, triangles: &[[u32; 3]], edges: &Edges) -> Option<(u32, u32)> {
        (0..edges.nodes.len() as u32).filter(|&e| self.is_inner(edges, e)).find_map(|e| {
            let [a, b] = edges.nodes[e as usize];
            let forward = |t: u32| {
                let face = triangles[t as usize];
                (0..3).any(|i| face[i] == a && face[(i + 1) % 3] == b)
            };
            let [s, t] = [0, 1].map(|i| edges.sides(e)[i].triangle);
            (forward(s) == forward(t)).then_some((a, self.of[s as usize]))
        })
    }
}

/// Whether two triangles, as the mesh has them, walk their common edge in the same direction.
fn same_direction(mesh: &TriMesh, t: u32, side: u8, over: TriangleSide) -> bool {
    mesh.faces[t as usize][side as usize] == mesh.faces[over.triangle as usize][over.side as usize]
}
