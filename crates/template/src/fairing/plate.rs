//! The thin plate: bending energy of a triangle surface, quadratic in the positions.
//!
//! The energy is a sum over *flaps*, pairs of triangles at an edge: the jump of the gradient's normal component across the
//! edge, times the edge's length, squared, over the flap's area (the quadratic bending of Bergou, Wardetzky, Harmon, Zorin
//! & Grinspun 2006). For smooth functions it tends to the integral of squared second derivatives in the directions across
//! the edges. Two properties make it the right one for cloth: linear functions cost nothing whatever the triangles' sizes,
//! so uneven spacing leaves no dents, and free edges behave as those of a free plate, so that a hem does not flare.

use glam::DVec3;

use super::factor::{FactorError, SparseFactor};

/// Triangles flatter than this (height over longest side) count as this high: a sliver of the template, where nodes have
/// come close on some body, must not be stiffer than all the rest.
const FLATTEST: f64 = 0.1;

/// Two triangles at an edge: the edge's nodes and the two opposite ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flap {
    /// Edge start, edge end, apex on one side, apex on the other.
    pub nodes: [u32; 4],
    /// Gradient jump's coefficients at the nodes.
    pub stencil: [f64; 4],
    /// Reciprocal of the flap's area, mm⁻².
    pub weight: f64,
}

impl Flap {
    /// The flap of triangles `a b c` and `b a d` with their shapes taken from `places` (of a, b, c and of b, a, d in
    /// their own planes). `size` scales areas, for triangles that are similar to the ones given.
    pub fn new(nodes: [u32; 4], first: [DVec3; 3], second: [DVec3; 3], size: f64) -> Self {
        let [a1, b1, area1] = cotangents(first);
        // The second triangle comes as b, a, d.
        let [b2, a2, area2] = cotangents(second);
        let stencil = [b1 + b2, a1 + a2, -(a1 + b1), -(a2 + b2)];
        Self { nodes, stencil, weight: 1.0 / (size * (area1 + area2)).max(1e-9) }
    }
}

/// Cotangents at the first two corners, and the area, of a triangle that is made at least [`FLATTEST`] high.
fn cotangents([a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let lengths = [b.distance_squared(a), c.distance_squared(b), a.distance_squared(c)];
    // Stand the triangle on its longest side.
    let base = (0..3).fold(0, |m, i| if lengths[i] > lengths[m] { i } else { m });
    let corner = |i: usize| [a, b, c][(base + i) % 3];
    let (p, q, r) = (corner(0), corner(1), corner(2));
    let width = lengths[base].sqrt().max(1e-12);
    let foot = ((r - p).dot(q - p) / width).clamp(0.0, width);
    let height = ((q - p).cross(r - p).length() / width).max(FLATTEST * width);
    let (at_p, at_q) = (foot / height, (width - foot) / height);
    let at_r = (1.0 - at_p * at_q) / (at_p + at_q);
    // Back to the order a, b, c.
    let cot = [at_p, at_q, at_r];
    [cot[(3 - base) % 3], cot[(4 - base) % 3], 0.5 * width * height]
}

/// The flaps of a triangle surface in the order of its faces: one for each edge with exactly two faces, shapes taken from
/// `positions`. O(n log n).
pub fn flaps(positions: &[DVec3], faces: &[[u32; 3]]) -> Vec<Flap> {
    let mut sides: Vec<([u32; 2], u32, u8)> = Vec::with_capacity(3 * faces.len());
    for (f, face) in faces.iter().enumerate() {
        for i in 0..3 {
            let (a, b) = (face[i], face[(i + 1) % 3]);
            sides.push(([a.min(b), a.max(b)], f as u32, i as u8));
        }
    }
    sides.sort_unstable();
    let mut out = Vec::with_capacity(sides.len() / 2);
    let place = |n: u32| positions[n as usize];
    for pair in sides.chunk_by(|a, b| a.0 == b.0) {
        let [(edge, f, i), (_, g, j)] = pair else { continue };
        let apex = |f: u32, i: u8| faces[f as usize][(i as usize + 2) % 3];
        let ([a, b], c, d) = (*edge, apex(*f, *i), apex(*g, *j));
        let first = [place(a), place(b), place(c)];
        let second = [place(b), place(a), place(d)];
        out.push(Flap::new([a, b, c, d], first, second, 1.0));
    }
    out
}

/// How a node takes part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hold {
    /// It stays where it is.
    Fixed,
    /// The plate finds its place.
    Free,
    /// Free, and drawn to a target with this stiffness (mm⁻², relative to the plate's bending stiffness).
    Drawn(f64),
}

/// A thin plate with its factorisation.
pub struct Plate {
    flaps: Vec<Flap>,
    /// Unknown of each node; `u32::MAX` for fixed ones.
    unknown: Vec<u32>,
    springs: Vec<f64>,
    factor: Option<SparseFactor>,
}

const FIXED: u32 = u32::MAX;

impl Plate {
    /// Prepares the plate over `hold.len()` nodes: assembles and factors the stiffness matrix of the free nodes.
    ///
    /// `places` serve the fill-reducing order only (nested dissection), not the weights.
    ///
    /// # Errors
    /// [`FactorError`] when what is fixed does not hold the plate (fewer than three nodes not in line).
    pub fn new(flaps: Vec<Flap>, hold: &[Hold], places: &[DVec3]) -> Result<Self, FactorError> {
        Self::reusing(None, flaps, hold, places)
    }

    /// The same with the factor of an earlier plate, whose symbolic part serves again where both hang together alike.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn reusing(
        earlier: Option<SparseFactor>,
        flaps: Vec<Flap>,
        hold: &[Hold],
        places: &[DVec3],
    ) -> Result<Self, FactorError> {
        let mut unknown = vec![FIXED; hold.len()];
        let (mut springs, mut free_places) = (Vec::new(), Vec::new());
        for (i, h) in hold.iter().enumerate() {
            let stiffness = match h {
                Hold::Fixed => continue,
                Hold::Free => 0.0,
                Hold::Drawn(k) => *k,
            };
            unknown[i] = springs.len() as u32;
            springs.push(stiffness);
            free_places.push(places[i]);
        }
        let mut plate = Self { flaps, unknown, springs, factor: None };
        if plate.springs.is_empty() {
            return Ok(plate);
        }
        let places = plate.flaps.iter().flat_map(|f| pairs(f, &plate.unknown).map(|(i, j, _)| [i, j]));
        let mut factor = SparseFactor::reused(earlier, plate.springs.len(), places, &free_places)?;
        let values = plate.flaps.iter().flat_map(|f| pairs(f, &plate.unknown).map(|(.., v)| v));
        factor.refactor(values, &plate.springs)?;
        plate.factor = Some(factor);
        Ok(plate)
    }

    /// Its factor, for another plate; `None` where nothing is free.
    pub fn into_factor(self) -> Option<SparseFactor> {
        self.factor
    }

    /// Number of free nodes.
    pub fn free_count(&self) -> usize {
        self.springs.len()
    }

    /// Changes the stiffness with which free nodes are drawn to their targets and factors anew; the symbolic part stays.
    ///
    /// # Errors
    /// [`FactorError::Singular`].
    pub fn set_springs(&mut self, stiffness: impl Fn(usize) -> f64) -> Result<(), FactorError> {
        for (node, u) in self.unknown.iter().enumerate() {
            if *u != FIXED {
                self.springs[*u as usize] = stiffness(node);
            }
        }
        let Some(factor) = &mut self.factor else { return Ok(()) };
        let unknown = &self.unknown;
        let values = self.flaps.iter().flat_map(|f| pairs(f, unknown).map(|(.., v)| v));
        factor.refactor(values, &self.springs)
    }

    /// Moves the free nodes to where the plate is at rest. `targets` are the places that drawn nodes are drawn to.
    /// Fixed nodes do not change to the bit. O(size of the factor).
    ///
    /// # Errors
    /// [`FactorError::Inaccurate`] when the residual is large even after refinement.
    pub fn solve(&self, positions: &mut [DVec3], targets: &[DVec3]) -> Result<(), FactorError> {
        let Some(factor) = &self.factor else { return Ok(()) };
        let n = self.springs.len();
        let mut rhs = vec![0.0; 3 * n];
        for flap in &self.flaps {
            let mut pull = DVec3::ZERO;
            for (v, k) in flap.nodes.iter().zip(flap.stencil) {
                if self.unknown[*v as usize] == FIXED {
                    pull += k * positions[*v as usize];
                }
            }
            if pull != DVec3::ZERO {
                self.spread(flap, -flap.weight * pull, &mut rhs);
            }
        }
        for (node, u) in self.unknown.iter().enumerate() {
            if *u != FIXED && self.springs[*u as usize] > 0.0 {
                let force = self.springs[*u as usize] * targets[node];
                let at = *u as usize;
                rhs[at] += force.x;
                rhs[n + at] += force.y;
                rhs[2 * n + at] += force.z;
            }
        }
        let x = factor.solve(&rhs, 3, &|x, out| self.apply(x, out))?;
        for (node, u) in self.unknown.iter().enumerate() {
            if *u != FIXED {
                let u = *u as usize;
                positions[node] = DVec3::new(x[u], x[n + u], x[2 * n + u]);
            }
        }
        Ok(())
    }

    /// Product of the stiffness matrix with three columns.
    fn apply(&self, x: &[f64], out: &mut [f64]) {
        let n = self.springs.len();
        for c in 0..3 {
            for u in 0..n {
                out[c * n + u] = self.springs[u] * x[c * n + u];
            }
        }
        for flap in &self.flaps {
            let mut sum = DVec3::ZERO;
            for (v, k) in flap.nodes.iter().zip(flap.stencil) {
                let u = self.unknown[*v as usize];
                if u != FIXED {
                    let u = u as usize;
                    sum += k * DVec3::new(x[u], x[n + u], x[2 * n + u]);
                }
            }
            self.spread(flap, flap.weight * sum, out);
        }
    }

    fn spread(&self, flap: &Flap, force: DVec3, out: &mut [f64]) {
        let n = self.springs.len();
        for (v, k) in flap.nodes.iter().zip(flap.stencil) {
            let u = self.unknown[*v as usize];
            if u != FIXED {
                let u = u as usize;
                out[u] += k * force.x;
                out[n + u] += k * force.y;
                out[2 * n + u] += k * force.z;
            }
        }
    }
}

/// Entries of one flap's stiffness among unknowns, lower triangle: row, column, value.
fn pairs<'a>(flap: &'a Flap, unknown: &'a [u32]) -> impl Iterator<Item = (u32, u32, f64)> + Clone + 'a {
    (0..4).flat_map(move |i| {
        (0..=i).filter_map(move |j| {
            let (u, v) = (unknown[flap.nodes[i] as usize], unknown[flap.nodes[j] as usize]);
            if u == FIXED || v == FIXED {
                return None;
            }
            let value = flap.weight * flap.stencil[i] * flap.stencil[j];
            // Nodes of one flap may be one unknown (a welded closed strip): both halves count then.
            let value = if u == v && i != j { 2.0 * value } else { value };
            Some((u.max(v), u.min(v), value))
        })
    })
}
