//! Least stretch: Newton's method on the symmetric Dirichlet energy, with a line search that never flips a triangle.
//!
//! The full Hessian is tried first near the solution (quadratic convergence); where it is not positive definite its
//! projection takes over (J. Smith, S. Schaefer, *Bijective Parameterization with Free Boundaries*, 2015, for the
//! longest step; B. Smith et al. 2019 for the projection). Edge lengths are held by an augmented Lagrangian.

use glam::DVec2;

use super::{energy, sheet::Sheet, sparse::NotDefinite};

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop {
    /// Predicted decrease of energy per area of a last step with the projected Hessian; with the full one its root.
    pub(crate) decrease: f64,
    /// Largest relative length error of a held edge.
    pub(crate) hold: f64,
    pub(crate) steps: usize,
}

impl Stop {
    /// Good enough as a start for the solve with seams.
    pub(crate) const ROUGH: Stop = Stop { decrease: 1e-6, hold: 1e-6, steps: 200 };
}

impl Default for Stop {
    fn default() -> Self {
        Self { decrease: 1e-10, hold: 1e-6, steps: 200 }
    }
}

/// How a minimisation ended.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Outcome {
    pub(crate) steps: usize,
    pub(crate) converged: bool,
    /// Largest relative length error of a held edge.
    pub(crate) hold_error: f64,
}

/// Penalty of a pair's relative difference of lengths. A triangle's own stiffness is 8 per area, so that one multiplier
/// update leaves some 3 % of the error.
const PENALTY: f64 = 300.0;

/// Moves `sheet.flat` to the least energy; it must be free of flips and stays so.
pub(crate) fn minimise(sheet: &mut Sheet, stop: Stop) -> Result<Outcome, NotDefinite> {
    let n = sheet.flat.len();
    let mut slope = vec![[0.0; 2]; n];
    let mut step = vec![[0.0; 2]; n];
    let mut trial = sheet.flat.clone();
    let mut value = merit(sheet, &sheet.flat);
    let mut near = sheet.excess(&sheet.flat) < 0.5 * sheet.area;
    let mut outcome = Outcome { hold_error: hold_error(sheet), ..Outcome::default() };
    while outcome.steps < stop.steps {
        outcome.steps += 1;
        assemble(sheet, &mut slope, !near);
        if sheet.system.factorise().is_err() {
            assemble(sheet, &mut slope, true);
            if sheet.system.factorise().is_err() {
                return Err(NotDefinite);
            }
        }
        slope.iter_mut().for_each(|s| *s = [-s[0], -s[1]]);
        sheet.system.solve(&slope, &mut step);
        let promise: f64 = slope.iter().zip(&step).map(|(s, d)| s[0] * d[0] + s[1] * d[1]).sum();
        if !promise.is_finite() {
            return Err(NotDefinite);
        }
        // With the full Hessian the error after this step is about the square of this.
        let last =
            promise <= 2.0 * sheet.area * if near { stop.decrease.sqrt() * 0.1 } else { stop.decrease };
        let mut length = longest_step(sheet, &step).min(1.0);
        let mut accepted = false;
        for _ in 0..40 {
            for ((t, p), d) in trial.iter_mut().zip(&sheet.flat).zip(&step) {
                *t = *p + length * DVec2::from_array(*d);
            }
            let reached = merit(sheet, &trial);
            // At the end the decrease drowns in rounding: any flip-free step that does no harm will do.
            let slack = if last { 1e-9 * (value.abs() + promise) + 1e-14 * sheet.area } else { 0.0 };
            if reached <= value - 1e-4 * length * promise + slack {
                value = reached;
                accepted = true;
                break;
            }
            length *= 0.5;
        }
        if accepted {
            std::mem::swap(&mut sheet.flat, &mut trial);
        }
        outcome.hold_error = hold_error(sheet);
        if (last || !accepted) && outcome.hold_error <= stop.hold {
            outcome.converged = last;
            return Ok(outcome);
        }
        if !accepted && sheet.holds.is_empty() {
            return Ok(outcome);
        }
        near = accepted && length > 0.5 && promise < 0.05 * sheet.area;
        if !sheet.holds.is_empty() && (length > 0.5 || !accepted) {
            update_multipliers(sheet);
            value = merit(sheet, &sheet.flat);
        }
    }
    Ok(outcome)
}

/// Difference of lengths of a pair over its length in space.
fn relative_error(sheet: &Sheet, flat: &[DVec2], hold: usize) -> f64 {
    let h = &sheet.holds[hold];
    let [a, b] = h.ends.map(|e| flat[e[0] as usize].distance(flat[e[1] as usize]));
    (a - b) / h.length
}

fn hold_error(sheet: &Sheet) -> f64 {
    (0..sheet.holds.len()).map(|i| relative_error(sheet, &sheet.flat, i).abs()).fold(0.0, f64::max)
}

fn update_multipliers(sheet: &mut Sheet) {
    for i in 0..sheet.holds.len() {
        let error = relative_error(sheet, &sheet.flat, i);
        sheet.holds[i].multiplier += PENALTY * error;
    }
}

/// Energy plus augmented Lagrangian.
fn merit(sheet: &Sheet, flat: &[DVec2]) -> f64 {
    let mut sum = sheet.objective(flat);
    for (i, h) in sheet.holds.iter().enumerate() {
        let c = relative_error(sheet, flat, i);
        sum += h.length * h.length * c * (h.multiplier + 0.5 * PENALTY * c);
    }
    sum
}

/// Fills the system with the Hessian and `slope` with the gradient at `sheet.flat`.
fn assemble(sheet: &mut Sheet, slope: &mut [[f64; 2]], project: bool) {
    sheet.system.clear();
    slope.fill([0.0; 2]);
    for f in 0..sheet.faces.len() {
        let j = sheet.jacobian(&sheet.flat, f);
        let rest = sheet.rest[f];
        let mut p = energy::gradient(j);
        let mut h = energy::hessian(j, project);
        if sheet.area_weight > 0.0 {
            energy::add_area_gradient(j, sheet.area_weight, &mut p);
            energy::add_area_hessian(j, sheet.area_weight, project, &mut h);
        }
        for (c, &v) in sheet.faces[f].iter().enumerate() {
            let g = rest.gradients[c];
            slope[v as usize][0] += rest.area * (p[0] * g[0] + p[1] * g[1]);
            slope[v as usize][1] += rest.area * (p[2] * g[0] + p[3] * g[1]);
        }
        sheet.add_face(f, &h);
    }
    for i in 0..sheet.holds.len() {
        add_hold(sheet, slope, i, project);
    }
    // Energy does not notice rigid motions: hold one node, and another one across the line between them. The slope
    // has no part along rigid motions, so that these springs carry no force.
    let weight = sheet.system.mean_diagonal();
    for &[a, b] in &sheet.pins {
        let across = (sheet.flat[b] - sheet.flat[a]).perp().normalize_or(DVec2::Y);
        sheet.system.add_node(a as u32, [weight, 0.0, weight]);
        sheet.system.add_node(
            b as u32,
            [weight * across.x * across.x, weight * across.x * across.y, weight * across.y * across.y],
        );
    }
}

/// Adds the augmented Lagrangian of a pair of edges.
fn add_hold(sheet: &mut Sheet, slope: &mut [[f64; 2]], hold: usize, project: bool) {
    let h = &sheet.holds[hold];
    let error = relative_error(sheet, &sheet.flat, hold);
    let force = h.length * (h.multiplier + PENALTY * error);
    let count = h.nodes.len();
    // Derivative of (first − second length) at every node, and the second derivatives of the lengths.
    let mut q = [DVec2::ZERO; 4];
    let mut block = [[[0.0; 3]; 4]; 4];
    for (side, sign) in [(0, 1.0), (1, -1.0)] {
        let [a, b] = h.ends[side].map(|v| sheet.flat[v as usize]);
        let (i, j) = (h.slots[side][0], h.slots[side][1]);
        let length = a.distance(b);
        let unit = (b - a) / length;
        q[i] -= sign * unit;
        q[j] += sign * unit;
        let bend = sign * force / length;
        let bend = if project { bend.max(0.0) } else { bend };
        let across =
            [bend * (1.0 - unit.x * unit.x), -bend * unit.x * unit.y, bend * (1.0 - unit.y * unit.y)];
        for k in 0..3 {
            block[i][i][k] += across[k];
            block[j][j][k] += across[k];
            block[i.min(j)][i.max(j)][k] -= across[k];
        }
    }
    let (nodes, edges) = (h.nodes.clone(), h.edges.clone());
    let mut pair = 0;
    for i in 0..count {
        slope[nodes[i] as usize][0] += force * q[i].x;
        slope[nodes[i] as usize][1] += force * q[i].y;
        let own = block[i][i];
        sheet.system.add_node(
            nodes[i],
            [
                PENALTY * q[i].x * q[i].x + own[0],
                PENALTY * q[i].x * q[i].y + own[1],
                PENALTY * q[i].y * q[i].y + own[2],
            ],
        );
        for j in i + 1..count {
            let b = block[i][j];
            let k = |x: f64, y: f64| PENALTY * x * y;
            let full = [
                [k(q[i].x, q[j].x) + b[0], k(q[i].x, q[j].y) + b[1]],
                [k(q[i].y, q[j].x) + b[1], k(q[i].y, q[j].y) + b[2]],
            ];
            sheet.system.add_edge(edges[pair].edge, edges[pair].forward, full);
            pair += 1;
        }
    }
}

/// The longest step that flips no triangle, less a margin.
fn longest_step(sheet: &Sheet, step: &[[f64; 2]]) -> f64 {
    let mut longest = f64::INFINITY;
    for (f, face) in sheet.faces.iter().enumerate() {
        let x = sheet.jacobian(&sheet.flat, f);
        let d = sheet.rest[f].jacobian(face.map(|v| DVec2::from_array(step[v as usize])));
        let a = energy::determinant(d);
        let b = d[0] * x[3] + d[3] * x[0] - d[1] * x[2] - d[2] * x[1];
        let c = energy::determinant(x);
        // Smallest positive root of a t² + b t + c, c > 0, in the form that does not cancel.
        let disc = b * b - 4.0 * a * c;
        if disc < 0.0 {
            continue;
        }
        let root = disc.sqrt();
        let t = if b < 0.0 {
            2.0 * c / (-b + root)
        } else if a < 0.0 {
            (-b - root) / (2.0 * a)
        } else {
            continue;
        };
        if t > 0.0 {
            longest = longest.min(t);
        }
    }
    0.9 * longest
}
