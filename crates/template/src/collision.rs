//! Collision with the reference body (T6): the garment is bent outward where it comes too near, as cloth would be.
//!
//! Nodes are not pushed one by one, which dents. One scalar field over the whole garment says how far every node moves
//! along the body's (smoothed) outward direction. It costs bending and stretching energy, and a little for being there at
//! all, in such shares that it fades out over a distance without swinging to the other side; and it must not be less than
//! the gap to the wanted clearance. This obstacle problem is solved by a primal–dual active set (Hintermüller, Ito &
//! Kunisch 2003): each step is one numeric factorisation with the kept symbolic part, and the contacts found are where the
//! next problem begins. Distances are measured again after each move, and triangles are checked exactly at the end.

use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::query::Crossings;
use rayon::prelude::*;

use crate::error::TemplateError;
use crate::fairing::{FactorError, Flap, SparseFactor};
use crate::refine::{NONE, Refined};
use crate::skin::{Sight, Skin};

/// Collision state of a finished garment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CollisionReport {
    /// Garment nodes inside the body.
    pub nodes_inside: usize,
    /// Garment triangles that cross body triangles.
    pub faces_crossing: usize,
    /// Smallest signed distance of a node to the skin, mm.
    pub min_distance: f64,
    /// Nodes that had to be moved outward by more than 0.1 mm.
    pub nodes_pushed: usize,
    /// The largest such move, mm.
    pub largest_push: f64,
}

/// The distance over which a push fades out, mm.
const FADE: f64 = 45.0;
/// Nodes nearer than this to the wanted clearance need no more, mm.
const NEAR_ENOUGH: f64 = 0.05;
/// A gap is over-fulfilled by this, so that the soft contact does not come short, mm.
const MARGIN: f64 = 0.02;
/// Rounds of measuring and pushing.
const ROUNDS: usize = 8;
/// Steps of the active set in a round.
const ACTIVE_STEPS: usize = 12;
/// Extra clearance a round for triangles that still cross, mm.
const CROSSING_STEP: f64 = 1.5;

/// What a garment's obstacle problem leaves for the next one.
pub(crate) struct Contact {
    factor: SparseFactor,
    touching: Vec<bool>,
}

/// The obstacle problem of one garment; keeps its symbolic factor.
pub(crate) struct Drape<'a> {
    refined: &'a Refined,
    skin: &'a Skin<'a>,
    flaps: Vec<Flap>,
    /// Stretching: node pairs with their cotangent weights.
    pairs: Vec<([u32; 2], f64)>,
    mass: Vec<f64>,
    /// Nodes that touched in the last field: where the next search begins.
    touching: Vec<bool>,
    /// Stiffness of a contact.
    contact: f64,
    factor: SparseFactor,
    faces: Vec<[u32; 3]>,
    /// Wanted clearance of each node, mm.
    clearance: Vec<f64>,
    /// Nodes that keep their height.
    level: Vec<bool>,
    symmetric: bool,
}

impl<'a> Drape<'a> {
    pub(crate) fn new(
        refined: &'a Refined,
        skin: &'a Skin<'a>,
        flaps: Vec<Flap>,
        clearance: Vec<f64>,
        level: Vec<bool>,
        symmetric: bool,
        earlier: Option<Contact>,
    ) -> Result<Self, TemplateError> {
        let n = refined.flat.len();
        let faces: Vec<[u32; 3]> = (0..refined.ids.len()).flat_map(|s| refined.welded_faces(s)).collect();
        let mut mass = vec![0.0; n];
        let mut pairs: Vec<([u32; 2], f64)> = Vec::with_capacity(3 * faces.len());
        // A plate under tension on a bed of springs: with a tension of twice the root of stiffness times bed, what is
        // pushed at one place fades out as fast as it can without overshooting.
        let tension = 2.0 / FADE.powi(2);
        for f in &faces {
            let corners = f.map(|v| refined.flat[v as usize]);
            let area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
            f.iter().for_each(|v| mass[*v as usize] += area / 3.0);
            for i in 0..3 {
                let (p, q, r) = (corners[i], corners[(i + 1) % 3], corners[(i + 2) % 3]);
                // Slivers and obtuse corners: a weight that is negative or huge would spoil the matrix.
                let cot = ((p - r).dot(q - r) / (2.0 * area).max(1e-9)).clamp(0.02, 10.0);
                let (a, b) = (f[i], f[(i + 1) % 3]);
                if a != b {
                    pairs.push(([a.max(b), a.min(b)], 0.5 * tension * cot));
                }
            }
        }
        let smallest = 1e-3 * mass.iter().sum::<f64>() / n.max(1) as f64;
        mass.iter_mut().for_each(|m| *m = m.max(smallest) / FADE.powi(4));
        let mut diagonal = mass.clone();
        for f in &flaps {
            for (v, k) in f.nodes.iter().zip(f.stencil) {
                diagonal[*v as usize] += f.weight * k * k;
            }
        }
        diagonal.sort_by(f64::total_cmp);
        let contact = 1e5 * diagonal.get(n / 2).copied().unwrap_or(1.0);
        let places = flaps.iter().flat_map(|f| entries(f).map(|(i, j, _)| [i, j]));
        let places = places.chain(pairs.iter().map(|p| p.0));
        let (earlier, touching) = earlier.map(|c| (c.factor, c.touching)).unzip();
        let mut factor = SparseFactor::reused(earlier, n, places, &refined.flat).map_err(|e| failed(&e))?;
        let touching = touching.filter(|t| t.len() == n).unwrap_or_else(|| vec![false; n]);
        let bending = flaps.iter().flat_map(|f| entries(f).map(|(.., v)| v));
        factor.set_values(bending.chain(pairs.iter().map(|p| -p.1)));
        Ok(Self {
            refined,
            skin,
            flaps,
            pairs,
            mass,
            touching,
            contact,
            factor,
            faces,
            clearance,
            level,
            symmetric,
        })
    }

    /// What the next garment of the same faces can begin with.
    pub(crate) fn into_contact(self) -> Contact {
        Contact { factor: self.factor, touching: self.touching }
    }

    /// Begins the next search with the contacts of a coarser garment: nodes keep their numbers on their surfaces.
    pub(crate) fn start_from(&mut self, coarse: &Drape) {
        for (own, other) in self.refined.weld.iter().zip(&coarse.refined.weld) {
            for (w, c) in own.iter().zip(other) {
                self.touching[*w as usize] |= coarse.touching[*c as usize];
            }
        }
    }

    fn look(&self, positions: &[DVec3]) -> Vec<Sight> {
        positions.par_iter().map(|p| self.skin.look(*p)).collect()
    }

    /// Outward directions: the body's, averaged over the garment's neighbours, horizontal where heights are kept.
    fn directions(&self, sights: &[Sight]) -> Vec<DVec3> {
        let mut out: Vec<DVec3> = sights.iter().map(|s| s.normal).collect();
        let mut sums = out.clone();
        for _ in 0..4 {
            sums.copy_from_slice(&out);
            for f in &self.faces {
                let all: DVec3 = f.iter().map(|v| out[*v as usize]).sum();
                f.iter().for_each(|v| sums[*v as usize] += all);
            }
            out.iter_mut().zip(&sums).for_each(|(o, s)| *o = s.normalize_or(*o));
        }
        let mirror = |d: DVec3| DVec3::new(-d.x, d.y, d.z);
        let smooth = out.clone();
        for (w, d) in out.iter_mut().enumerate() {
            let twin = self.refined.twins[w];
            if self.symmetric && twin != NONE {
                *d = (smooth[w] + mirror(smooth[twin as usize])).normalize_or(smooth[w]);
            }
            if self.level[w] {
                let flat = DVec3::new(d.x, 0.0, d.z);
                // On top of a shoulder no horizontal move leads out.
                if flat.length() > 0.2 {
                    *d = flat.normalize();
                }
            }
        }
        out
    }

    /// Moves nodes outward until the clearance is kept; returns how far each was moved. At most `rounds` rounds of
    /// measuring and moving, the last ones with triangles checked if `exact`.
    pub(crate) fn push_out(
        &mut self,
        positions: &mut [DVec3],
        rounds: usize,
        exact: Option<&Crossings>,
    ) -> Result<Vec<f64>, TemplateError> {
        let n = positions.len();
        let mut extra = vec![0.0; n];
        let mut moved = vec![0.0; n];
        for round in 0..rounds.min(ROUNDS) {
            let sights = self.look(positions);
            let directions = self.directions(&sights);
            let mut gaps = vec![0.0; n];
            for w in 0..n {
                // Along a direction that is not the shortest one the way is longer.
                let slope = directions[w].dot(sights[w].normal).max(0.35);
                gaps[w] = (self.clearance[w] + extra[w] - sights[w].distance) / slope;
            }
            if self.symmetric {
                for w in 0..n {
                    let t = self.refined.twins[w];
                    if t != NONE && w < t as usize {
                        let both = gaps[w].max(gaps[t as usize]);
                        gaps[w] = both;
                        gaps[t as usize] = both;
                    }
                }
            }
            if gaps.iter().all(|g| *g <= NEAR_ENOUGH) {
                let Some(crossings) = exact else { break };
                let crossing = crossings.faces_crossing(&self.mesh(positions));
                if crossing.is_empty() || round + 1 == rounds {
                    break;
                }
                // A face that crosses many others counts once.
                let mut near = vec![false; n];
                for v in crossing.iter().flat_map(|(face, _)| self.faces[*face as usize]) {
                    near[v as usize] = true;
                    let twin = self.refined.twins[v as usize];
                    if twin != NONE {
                        near[twin as usize] = true;
                    }
                }
                (0..n).filter(|w| near[*w]).for_each(|w| extra[w] += CROSSING_STEP);
                continue;
            }
            let push = self.field(&gaps)?;
            for w in 0..n {
                positions[w] += push[w] * directions[w];
                moved[w] += push[w];
            }
            if self.symmetric {
                self.refined.symmetrise(positions);
            }
        }
        Ok(moved)
    }

    /// The last resort: a node that is still inside goes straight to the skin and out.
    pub(crate) fn mend(&self, positions: &mut [DVec3], lift: f64) -> usize {
        let mut count = 0;
        for round in 0..3 {
            let sights = self.look(positions);
            let mut changed = false;
            for (p, s) in positions.iter_mut().zip(&sights) {
                if s.distance <= 0.0 {
                    *p = s.point + (1 + round) as f64 * lift * s.normal;
                    count += 1;
                    changed = true;
                }
            }
            if !changed {
                break;
            }
            if self.symmetric {
                self.refined.symmetrise(positions);
            }
        }
        count
    }

    fn mesh(&self, positions: &[DVec3]) -> TriMesh {
        TriMesh::new(positions.to_vec(), self.faces.clone())
    }

    /// What is to be reported of final positions.
    pub(crate) fn report(
        &self,
        positions: &[DVec3],
        moved: &[f64],
        crossings: &Crossings,
    ) -> CollisionReport {
        let distances: Vec<f64> = positions.par_iter().map(|p| self.skin.signed(*p)).collect();
        let mut crossing: Vec<u32> =
            crossings.faces_crossing(&self.mesh(positions)).into_iter().map(|c| c.0).collect();
        crossing.sort_unstable();
        crossing.dedup();
        CollisionReport {
            nodes_inside: distances.iter().filter(|d| **d < 0.0).count(),
            faces_crossing: crossing.len(),
            min_distance: distances.iter().copied().fold(f64::INFINITY, f64::min),
            nodes_pushed: moved.iter().filter(|m| m.abs() > 0.1).count(),
            largest_push: moved.iter().fold(0.0, |m, v| m.max(v.abs())),
        }
    }

    /// The field of least energy with `s ≥ gap` at every node.
    fn field(&mut self, gaps: &[f64]) -> Result<Vec<f64>, TemplateError> {
        let n = gaps.len();
        let warm = self.touching.iter().any(|t| *t);
        let mut active: Vec<bool> =
            (0..n).map(|w| if warm { self.touching[w] && gaps[w] > -1.0 } else { gaps[w] > 0.0 }).collect();
        if !active.contains(&true) {
            active = gaps.iter().map(|g| *g > 0.0).collect();
        }
        let mut s = vec![0.0; n];
        for step in 0..ACTIVE_STEPS {
            let mut diagonal: Vec<f64> =
                (0..n).map(|w| self.mass[w] + if active[w] { self.contact } else { 0.0 }).collect();
            for ([a, b], k) in &self.pairs {
                diagonal[*a as usize] += k;
                diagonal[*b as usize] += k;
            }
            self.factor.refactor_with(&diagonal).map_err(|e| failed(&e))?;
            let rhs: Vec<f64> =
                (0..n).map(|w| if active[w] { self.contact * (gaps[w] + MARGIN) } else { 0.0 }).collect();
            let apply = |x: &[f64], out: &mut [f64]| {
                out.iter_mut().zip(x).zip(&diagonal).for_each(|((o, x), d)| *o = d * x);
                for ([a, b], k) in &self.pairs {
                    out[*a as usize] -= k * x[*b as usize];
                    out[*b as usize] -= k * x[*a as usize];
                }
                for f in &self.flaps {
                    let sum: f64 = f.nodes.iter().zip(f.stencil).map(|(v, k)| k * x[*v as usize]).sum();
                    for (v, k) in f.nodes.iter().zip(f.stencil) {
                        out[*v as usize] += f.weight * k * sum;
                    }
                }
            };
            s = self.factor.solve(&rhs, 1, &apply).map_err(|e| failed(&e))?;
            let mut changed = false;
            // Towards the end contacts are kept, so that the set cannot go round in circles.
            let release = step + 4 < ACTIVE_STEPS;
            for w in 0..n {
                if active[w] && release && s[w] > gaps[w] + MARGIN {
                    active[w] = false;
                    changed = true;
                } else if !active[w] && s[w] < gaps[w] {
                    active[w] = true;
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
        self.touching = active;
        Ok(s)
    }
}

fn failed(e: &FactorError) -> TemplateError {
    TemplateError::Fairing { what: "around the body".into(), problem: e.to_string() }
}

/// Entries of a flap's stiffness, lower triangle.
fn entries(flap: &Flap) -> impl Iterator<Item = (u32, u32, f64)> + Clone + '_ {
    (0..4).flat_map(move |i| {
        (0..=i).map(move |j| {
            let (u, v) = (flap.nodes[i], flap.nodes[j]);
            let value = flap.weight * flap.stencil[i] * flap.stencil[j];
            (u.max(v), u.min(v), if u == v && i != j { 2.0 * value } else { value })
        })
    })
}
