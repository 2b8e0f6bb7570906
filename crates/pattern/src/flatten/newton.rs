//! Least stretch: Newton's method on the symmetric Dirichlet energy, with a line search that never flips a triangle.
//!
//! The full Hessian is tried first near the solution (quadratic convergence); where it is not positive definite its
//! projection takes over (J. Smith, S. Schaefer, *Bijective Parameterization with Free Boundaries*, 2015, for the
//! longest step; B. Smith et al. 2019 for the projection). Edge lengths are held by an augmented Lagrangian.

use glam::DVec2;

use super::{
    energy,
    initial::far_pair,
    sheet::Sheet,
    sparse::NotDefinite,
};

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop {
    /// Predicted decrease of energy per area.
    pub(crate) decrease: f64,
    /// Largest relative length error of a held edge.
    pub(crate) hold: f64,
    pub(crate) steps: usize,
}

impl Default for Stop {
    fn default() -> Self {
        Self { decrease: 1e-10, hold: 1e-8, steps: 200 }
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

/// Penalty of a held edge's relative length error. A triangle's own stiffness is 8 per area, so that one multiplier
/// update leaves about 1 % of the error.
const PENALTY: f64 = 1000.0;

/// Moves `sheet.flat` to the least energy; it must be free of flips and stays so.
pub(crate) fn minimise(sheet: &mut Sheet, stop: Stop) -> Result<Outcome, NotDefinite> {
    let n = sheet.flat.len();
    let pins = far_pair(&sheet.space);
    let mut slope = vec![[0.0; 2]; n];
    let mut step = vec![[0.0; 2]; n];
    let mut trial = sheet.flat.clone();
    let mut value = merit(sheet, &sheet.flat);
    let mut near = sheet.excess(&sheet.flat) < 0.5 * sheet.area;
    let mut outcome = Outcome { hold_error: hold_error(sheet), ..Outcome::default() };
    while outcome.steps < stop.steps {
        outcome.steps += 1;
        assemble(sheet, &mut slope, !near, pins);
        if sheet.system.factorise().is_err() {
            assemble(sheet, &mut slope, true, pins);
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
        let last = promise <= 2.0 * stop.decrease * sheet.area;
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

fn relative_error(sheet: &Sheet, flat: &[DVec2], hold: usize) -> f64 {
    let h = sheet.holds[hold];
    flat[h.nodes[0] as usize].distance(flat[h.nodes[1] as usize]) / h.target - 1.0
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
    let mut sum = sheet.excess(flat);
    for (i, h) in sheet.holds.iter().enumerate() {
        let c = relative_error(sheet, flat, i);
        sum += h.target * h.target * c * (h.multiplier + 0.5 * PENALTY * c);
    }
    sum
}

/// Fills the system with the Hessian and `slope` with the gradient at `sheet.flat`.
fn assemble(sheet: &mut Sheet, slope: &mut [[f64; 2]], project: bool, pins: [usize; 2]) {
    sheet.system.clear();
    slope.fill([0.0; 2]);
    for f in 0..sheet.faces.len() {
        let j = sheet.jacobian(&sheet.flat, f);
        let rest = sheet.rest[f];
        let p = energy::gradient(j);
        for (c, &v) in sheet.faces[f].iter().enumerate() {
            let g = rest.gradients[c];
            slope[v as usize][0] += rest.area * (p[0] * g[0] + p[1] * g[1]);
            slope[v as usize][1] += rest.area * (p[2] * g[0] + p[3] * g[1]);
        }
        sheet.add_face(f, &energy::hessian(j, project));
    }
    for i in 0..sheet.holds.len() {
        let h = sheet.holds[i];
        let [a, b] = h.nodes.map(|v| v as usize);
        let d = sheet.flat[b] - sheet.flat[a];
        let length = d.length();
        let unit = d / length;
        let force = h.target * (h.multiplier + PENALTY * (length / h.target - 1.0));
        let side = force / length;
        let side = if project { side.max(0.0) } else { side };
        let k = |x: f64, y: f64, same: f64| PENALTY * x * y + side * (same - x * y);
        let (xx, xy, yy) = (k(unit.x, unit.x, 1.0), k(unit.x, unit.y, 0.0), k(unit.y, unit.y, 1.0));
        sheet.system.add_node(h.nodes[0], [xx, xy, yy]);
        sheet.system.add_node(h.nodes[1], [xx, xy, yy]);
        sheet.system.add_edge(h.edge, h.forward, [[-xx, -xy], [-xy, -yy]]);
        for (v, sign) in [(a, -1.0), (b, 1.0)] {
            slope[v][0] += sign * force * unit.x;
            slope[v][1] += sign * force * unit.y;
        }
    }
    // Energy does not notice rigid motions: hold one node, and another one across the line between them. The slope
    // has no part along rigid motions, so that these springs carry no force.
    let [a, b] = pins;
    let weight = sheet.system.mean_diagonal();
    let across = (sheet.flat[b] - sheet.flat[a]).perp().normalize_or(DVec2::Y);
    sheet.system.add_node(a as u32, [weight, 0.0, weight]);
    sheet.system.add_node(
        b as u32,
        [weight * across.x * across.x, weight * across.x * across.y, weight * across.y * across.y],
    );
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
