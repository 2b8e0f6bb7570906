//! Cuts of a mesh with planes.
//!
//! A node on the plane counts as above it. Every face is then either uncut or cut through exactly two sides, so chains
//! never branch in nodes and no tolerance is needed; zero-length pieces that arise on the way are dropped.

use glam::DVec3;

use super::Adjacency;
use crate::TriMesh;

/// One chain of a plane cut.
#[derive(Clone, Debug, PartialEq)]
pub struct SectionLoop {
    /// Whether the last point joins the first; open where the chain ends at a hole of the mesh.
    pub closed: bool,
    /// The points, on the mesh's edges; anticlockwise about the axis where faces look outward. The first point of a
    /// closed chain is not repeated.
    pub points: Vec<DVec3>,
    /// The face that holds the piece from point `i` to the next: as many as points, one fewer when open.
    pub faces: Vec<u32>,
}

impl SectionLoop {
    /// Length along the chain, with the closing piece if closed.
    pub fn length(&self) -> f64 {
        let open: f64 = self.points.windows(2).map(|p| p[0].distance(p[1])).sum();
        match (self.points.first(), self.points.last()) {
            (Some(first), Some(last)) if self.closed => open + first.distance(*last),
            _ => open,
        }
    }

    /// Drops pieces of no length. Expects one point more than faces, for a closed chain the first point again.
    fn drop_empty_pieces(&mut self) {
        let mut kept = 0;
        for k in 0..self.faces.len() {
            if self.points[k + 1] != self.points[kept] {
                self.faces[kept] = self.faces[k];
                kept += 1;
                self.points[kept] = self.points[k + 1];
            }
        }
        self.faces.truncate(kept);
        self.points.truncate(kept + usize::from(!self.closed));
    }

    /// Signed area about `axis` (unit length), positive when anticlockwise; open chains are closed straight.
    pub fn area(&self, axis: DVec3) -> f64 {
        let Some(origin) = self.points.first() else { return 0.0 };
        let twice: DVec3 = self.points.windows(2).map(|p| (p[0] - *origin).cross(p[1] - *origin)).sum();
        0.5 * twice.dot(axis)
    }
}

/// A mesh prepared for many parallel cuts.
///
/// Faces are sorted into layers by height, neighbours are known beforehand; a cut costs the faces of one layer.
#[derive(Clone, Debug)]
pub struct SectionStack {
    positions: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    heights: Vec<f64>,
    adjacency: Adjacency,
    lowest: f64,
    highest: f64,
    layers_per_height: f64,
    layer_starts: Vec<u32>,
    layer_faces: Vec<u32>,
}

impl SectionStack {
    /// Prepares cuts across `axis` (any length; zero gives no cuts). O(faces).
    pub fn new(mesh: &TriMesh, axis: DVec3) -> Self {
        let axis = axis.normalize_or_zero();
        let heights: Vec<f64> = mesh.positions.iter().map(|p| p.dot(axis)).collect();
        let range = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|v| heights[v as usize]);
            (a.min(b).min(c), a.max(b).max(c))
        };
        let (lowest, highest) = mesh
            .faces
            .iter()
            .map(range)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), (a, b)| (lo.min(a), hi.max(b)));
        let span = highest - lowest;
        // Some faces a layer; fewer layers when faces are so tall that they would lie in many of them.
        let mut layers = (mesh.faces.len() / 32).clamp(1, 1 << 14);
        let rate = |layers: usize| if span > 0.0 && span.is_finite() { layers as f64 / span } else { 0.0 };
        let layer_of =
            |height: f64, layers: usize| (((height - lowest) * rate(layers)) as usize).min(layers - 1);
        loop {
            let entries: usize = mesh
                .faces
                .iter()
                .map(range)
                .map(|(a, b)| layer_of(b, layers) - layer_of(a, layers) + 1)
                .sum();
            if layers == 1 || entries <= 6 * mesh.faces.len() {
                break;
            }
            layers /= 2;
        }
        let mut layer_starts = vec![0u32; layers + 1];
        for (a, b) in mesh.faces.iter().map(range) {
            for layer in layer_of(a, layers)..=layer_of(b, layers) {
                layer_starts[layer + 1] += 1;
            }
        }
        for layer in 0..layers {
            layer_starts[layer + 1] += layer_starts[layer];
        }
        let mut fill = layer_starts.clone();
        let mut layer_faces = vec![0u32; layer_starts[layers] as usize];
        for (f, (a, b)) in mesh.faces.iter().map(range).enumerate() {
            for fill in &mut fill[layer_of(a, layers)..=layer_of(b, layers)] {
                layer_faces[*fill as usize] = f as u32;
                *fill += 1;
            }
        }
        Self {
            positions: mesh.positions.clone(),
            faces: mesh.faces.clone(),
            heights,
            adjacency: Adjacency::new(mesh),
            lowest,
            highest,
            layers_per_height: rate(layers),
            layer_starts,
            layer_faces,
        }
    }

    /// Lowest and highest point of the faces along the axis; an empty range (lowest above highest) without faces.
    pub fn heights(&self) -> [f64; 2] {
        [self.lowest, self.highest]
    }

    /// The chains at `height` = position · axis (of unit length). Cost: the faces of one layer.
    pub fn cut(&self, height: f64) -> Vec<SectionLoop> {
        if !(self.lowest..=self.highest).contains(&height) {
            return Vec::new();
        }
        let layers = self.layer_starts.len() - 1;
        let layer = (((height - self.lowest) * self.layers_per_height) as usize).min(layers - 1);
        let faces = self.layer_starts[layer] as usize..self.layer_starts[layer + 1] as usize;
        let cut = Cut { positions: &self.positions, faces: &self.faces, heights: &self.heights, height };
        let mut crossed: Vec<u32> = self.layer_faces[faces].to_vec();
        crossed.retain(|f| cut.crosses(*f));
        cut.chains(&crossed, |h| self.adjacency.partner(h))
    }
}

/// The chains in which the plane through `origin` across `normal` cuts the mesh. O(faces); [`SectionStack`] is much
/// faster for many parallel cuts. A zero normal gives none.
pub fn plane_section(mesh: &TriMesh, origin: DVec3, normal: DVec3) -> Vec<SectionLoop> {
    let normal = normal.normalize_or_zero();
    let heights: Vec<f64> = mesh.positions.iter().map(|p| (*p - origin).dot(normal)).collect();
    let cut = Cut { positions: &mesh.positions, faces: &mesh.faces, heights: &heights, height: 0.0 };
    let crossed: Vec<u32> = (0..mesh.faces.len() as u32).filter(|f| cut.crosses(*f)).collect();
    // Neighbours of the crossed faces alone, numbered within their list.
    let crossed_mesh = TriMesh {
        positions: mesh.positions.clone(),
        faces: crossed.iter().map(|f| mesh.faces[*f as usize]).collect(),
        ..TriMesh::default()
    };
    let adjacency = Adjacency::new(&crossed_mesh);
    let cut = Cut { faces: &crossed_mesh.faces, ..cut };
    let own: Vec<u32> = (0..crossed.len() as u32).collect();
    let mut chains = cut.chains(&own, |h| adjacency.partner(h));
    for face in chains.iter_mut().flat_map(|chain| &mut chain.faces) {
        *face = crossed[*face as usize];
    }
    chains
}

/// A plane among node heights.
struct Cut<'a> {
    positions: &'a [DVec3],
    faces: &'a [[u32; 3]],
    heights: &'a [f64],
    height: f64,
}

impl Cut<'_> {
    #[inline]
    fn above(&self, node: u32) -> bool {
        self.heights[node as usize] >= self.height
    }

    #[inline]
    fn crosses(&self, face: u32) -> bool {
        let [a, b, c] = self.faces[face as usize].map(|v| self.above(v));
        a != b || b != c
    }

    /// The half-edges of a crossed face that go down and up through the plane.
    #[inline]
    fn down_up(&self, face: u32) -> [u32; 2] {
        let above = self.faces[face as usize].map(|v| self.above(v));
        let side = |from: bool| (0..3).find(|k| above[*k] == from && above[(k + 1) % 3] != from).unwrap_or(0);
        [3 * face + side(true) as u32, 3 * face + side(false) as u32]
    }

    /// Where half-edge `h` meets the plane: the same bits from both faces at the edge.
    fn point(&self, h: u32) -> DVec3 {
        let face = self.faces[h as usize / 3];
        let (a, b) = (face[h as usize % 3] as usize, face[(h as usize + 1) % 3] as usize);
        let (low, high) = if self.heights[a] < self.height { (a, b) } else { (b, a) };
        let t = (self.height - self.heights[low]) / (self.heights[high] - self.heights[low]);
        if t >= 1.0 { self.positions[high] } else { self.positions[low].lerp(self.positions[high], t) }
    }

    /// Chains the pieces of the crossed faces; `partner` is symmetric.
    fn chains(&self, crossed: &[u32], partner: impl Fn(u32) -> Option<u32>) -> Vec<SectionLoop> {
        let Some(last) = crossed.iter().max() else { return Vec::new() };
        let mut done = vec![0u64; *last as usize / 64 + 1];
        let mut chains = Vec::new();
        for &start in crossed {
            if done[start as usize / 64] & (1 << (start % 64)) != 0 {
                continue;
            }
            let mut walk = |mut h: u32, pieces: &mut Vec<(u32, u32)>| {
                loop {
                    let face = h / 3;
                    done[face as usize / 64] |= 1 << (face % 64);
                    pieces.push((face, h));
                    let Some(entry) = partner(h) else { return false };
                    if entry / 3 == start {
                        return true;
                    }
                    let [down, up] = self.down_up(entry / 3);
                    h = if entry == down { up } else { down };
                }
            };
            let [down, up] = self.down_up(start);
            let (mut forward, mut backward) = (Vec::new(), Vec::new());
            let closed = walk(up, &mut forward);
            if !closed {
                walk(down, &mut backward);
            }
            // Backward pieces hold the half-edge at their first point, forward pieces at their last; the start is in
            // both.
            let mut chain = SectionLoop { closed, points: Vec::new(), faces: Vec::new() };
            chain.points.reserve(backward.len() + forward.len());
            if closed {
                chain.points.push(self.point(down));
            }
            for (k, (face, h)) in backward.iter().enumerate().rev() {
                chain.points.push(self.point(*h));
                if k > 0 {
                    chain.faces.push(*face);
                }
            }
            for (face, h) in &forward {
                chain.points.push(self.point(*h));
                chain.faces.push(*face);
            }
            chain.drop_empty_pieces();
            if chain.points.len() >= if closed { 3 } else { 2 } {
                chains.push(chain);
            }
        }
        chains
    }
}
