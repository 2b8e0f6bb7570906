//! Symmetric Dirichlet energy of one triangle: value, gradient, Hessian.
//!
//! With F the map's 2×2 Jacobian, ψ = |F|² + |F⁻¹|², least and 4 for isometries. In invariants I = |F|² and J = det F:
//! ψ = I (1 + 1/J²). Of the Hessian's eigenvalues only that of the in-plane rotation ("twist") can be negative:
//! B. Smith, F. de Goes, T. Kim, *Analytic Eigensystems for Isotropic Distortion Energies*, 2019. Energies here are
//! given in excess of 4, computed without cancellation as |F − F⁻ᵀ|².

use glam::{DVec2, DVec3};

/// A triangle in its own plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RestTriangle {
    /// Area in space.
    pub(crate) area: f64,
    /// Gradients of the three hat functions in the triangle's own frame.
    pub(crate) gradients: [[f64; 2]; 3],
}

impl RestTriangle {
    /// From corners in space.
    pub(crate) fn new([a, b, c]: [DVec3; 3]) -> Self {
        let (u, v) = (b - a, c - a);
        let x1 = u.length();
        let x2 = u.dot(v) / x1;
        let y2 = u.cross(v).length() / x1;
        let (d, e) = (1.0 / x1, 1.0 / y2);
        // Hat functions of (0,0), (x1,0), (x2,y2).
        let g2 = [0.0, e];
        let g1 = [d, -x2 * d * e];
        Self { area: 0.5 * x1 * y2, gradients: [[-g1[0], -g1[1] - g2[1]], g1, g2] }
    }

    /// Jacobian `[f00, f01, f10, f11]` (row: plane axis) for the corners' positions.
    #[inline]
    pub(crate) fn jacobian(&self, x: [DVec2; 3]) -> [f64; 4] {
        let g = &self.gradients;
        let (p, q) = (x[1] - x[0], x[2] - x[0]);
        [
            p.x * g[1][0] + q.x * g[2][0],
            p.x * g[1][1] + q.x * g[2][1],
            p.y * g[1][0] + q.y * g[2][0],
            p.y * g[1][1] + q.y * g[2][1],
        ]
    }
}

/// Determinant.
#[inline]
pub(crate) fn determinant(f: [f64; 4]) -> f64 {
    f[0] * f[3] - f[1] * f[2]
}

/// ψ − 4; infinite for flipped or collapsed triangles.
#[inline]
pub(crate) fn excess(f: [f64; 4]) -> f64 {
    let j = determinant(f);
    if j <= 0.0 {
        return f64::INFINITY;
    }
    let k = 1.0 / j;
    let (a, b, c, d) = (f[0] - f[3] * k, f[1] + f[2] * k, f[2] + f[1] * k, f[3] - f[0] * k);
    a * a + b * b + c * c + d * d
}

/// Gradient of ψ in F.
#[inline]
pub(crate) fn gradient(f: [f64; 4]) -> [f64; 4] {
    let j = determinant(f);
    let i = f[0] * f[0] + f[1] * f[1] + f[2] * f[2] + f[3] * f[3];
    let k = 1.0 / j;
    let s = 2.0 * (1.0 + k * k);
    let t = 2.0 * i * k * k * k;
    [s * f[0] - t * f[3], s * f[1] + t * f[2], s * f[2] + t * f[1], s * f[3] - t * f[0]]
}

/// Hessian of ψ in F; with `project` its negative part is removed.
#[inline]
pub(crate) fn hessian(f: [f64; 4], project: bool) -> [[f64; 4]; 4] {
    let j = determinant(f);
    let i = f[0] * f[0] + f[1] * f[1] + f[2] * f[2] + f[3] * f[3];
    let k = 1.0 / j;
    let k2 = k * k;
    let k3 = k2 * k;
    let c = [f[3], -f[2], -f[1], f[0]];
    let identity = 2.0 * (1.0 + k2);
    let mixed = -4.0 * k3;
    let outer = 6.0 * i * k2 * k2;
    let cofactor = -2.0 * i * k3;
    let mut h = [[0.0; 4]; 4];
    for a in 0..4 {
        for b in 0..4 {
            h[a][b] = mixed * (f[a] * c[b] + c[a] * f[b]) + outer * c[a] * c[b];
        }
        h[a][a] += identity;
    }
    h[0][3] += cofactor;
    h[3][0] += cofactor;
    h[1][2] -= cofactor;
    h[2][1] -= cofactor;
    if project {
        let twist = 2.0 - 2.0 * (i - j) * k3;
        if twist < 0.0 {
            // The rotation part of F, turned by a right angle, normalised.
            let (p, q) = (f[0] + f[3], f[2] - f[1]);
            let scale = 0.5 / (p * p + q * q);
            let t = [-q, -p, p, -q];
            for a in 0..4 {
                for b in 0..4 {
                    h[a][b] -= twist * scale * t[a] * t[b];
                }
            }
        }
    }
    h
}

/// How much an area changes: (J − 1/J)² for a determinant J, infinite for flipped triangles.
#[inline]
pub(crate) fn area_excess(j: f64) -> f64 {
    if j <= 0.0 {
        return f64::INFINITY;
    }
    let d = j - 1.0 / j;
    d * d
}

/// Gradient of (J − 1/J)² in F, times `weight`, added.
#[inline]
pub(crate) fn add_area_gradient(f: [f64; 4], weight: f64, out: &mut [f64; 4]) {
    let j = determinant(f);
    let slope = weight * 2.0 * (j - 1.0 / (j * j * j));
    let c = [f[3], -f[2], -f[1], f[0]];
    for a in 0..4 {
        out[a] += slope * c[a];
    }
}

/// Hessian of (J − 1/J)² in F, times `weight`, added; with `project` only its part without negative directions.
#[inline]
pub(crate) fn add_area_hessian(f: [f64; 4], weight: f64, project: bool, out: &mut [[f64; 4]; 4]) {
    let j = determinant(f);
    let k2 = 1.0 / (j * j);
    let bend = weight * (2.0 + 6.0 * k2 * k2);
    let c = [f[3], -f[2], -f[1], f[0]];
    for a in 0..4 {
        for b in 0..4 {
            out[a][b] += bend * c[a] * c[b];
        }
    }
    if !project {
        let slope = weight * 2.0 * (j - k2 / j);
        out[0][3] += slope;
        out[3][0] += slope;
        out[1][2] -= slope;
        out[2][1] -= slope;
    }
}

/// Larger and smaller (signed) singular value.
#[inline]
pub(crate) fn singular_values(f: [f64; 4]) -> [f64; 2] {
    let p = (f[0] + f[3]).hypot(f[2] - f[1]);
    let q = (f[0] - f[3]).hypot(f[2] + f[1]);
    [0.5 * (p + q), 0.5 * (p - q)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_agree_with_differences() {
        let f = [1.1, 0.2, -0.15, 0.8];
        let step = 1e-5;
        let shifted = |a: usize, s: f64| {
            let mut g = f;
            g[a] += s;
            g
        };
        let (g, h) = (gradient(f), hessian(f, false));
        for a in 0..4 {
            let numeric = (excess(shifted(a, step)) - excess(shifted(a, -step))) / (2.0 * step);
            assert!((numeric - g[a]).abs() < 1e-7, "{numeric} {}", g[a]);
            let (up, down) = (gradient(shifted(a, step)), gradient(shifted(a, -step)));
            for b in 0..4 {
                let numeric = (up[b] - down[b]) / (2.0 * step);
                assert!((numeric - h[a][b]).abs() < 1e-6, "{a} {b}: {numeric} {}", h[a][b]);
            }
        }
    }

    #[test]
    fn area_derivatives_agree_with_differences() {
        let f = [1.1, 0.2, -0.15, 0.8];
        let step = 1e-5;
        let shifted = |a: usize, s: f64| {
            let mut g = f;
            g[a] += s;
            g
        };
        let gradient = |f: [f64; 4]| {
            let mut g = [0.0; 4];
            add_area_gradient(f, 3.0, &mut g);
            g
        };
        let mut h = [[0.0; 4]; 4];
        add_area_hessian(f, 3.0, false, &mut h);
        for (a, row) in h.iter().enumerate() {
            let value = |s: f64| 3.0 * area_excess(determinant(shifted(a, s)));
            assert!(((value(step) - value(-step)) / (2.0 * step) - gradient(f)[a]).abs() < 1e-6);
            let (up, down) = (gradient(shifted(a, step)), gradient(shifted(a, -step)));
            for b in 0..4 {
                assert!(((up[b] - down[b]) / (2.0 * step) - row[b]).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn projected_hessian_has_no_negative_direction() {
        for f in [[0.5, 0.1, 0.0, 0.6], [0.9, 0.0, 0.0, 0.7], [0.3, -0.5, 0.6, 0.2]] {
            let h = faer::Mat::from_fn(4, 4, |a, b| hessian(f, true)[a][b]);
            let values = h.self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
            assert!(values.iter().all(|&v| v > -1e-9 * values[3].abs()), "{f:?}: {values:?}");
        }
    }

    #[test]
    fn isometry_has_no_excess() {
        let (s, c) = 0.7f64.sin_cos();
        assert!(excess([c, -s, s, c]) < 1e-30);
    }
}
