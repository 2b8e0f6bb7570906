//! Analytic patches, made here so that no test needs a file. Lengths in millimetres.

use glam::DVec3;
use pattern::{Patch, PieceSpec};

/// Patch over an n × m grid of cells, from a map of the unit square. Faces look along du × dv.
pub(crate) fn grid(name: &str, n: u32, m: u32, map: impl Fn(f64, f64) -> DVec3) -> Patch {
    let mut positions = Vec::new();
    for i in 0..=n {
        for j in 0..=m {
            positions.push(map(f64::from(i) / f64::from(n), f64::from(j) / f64::from(m)));
        }
    }
    let at = |i: u32, j: u32| i * (m + 1) + j;
    let mut faces = Vec::new();
    for i in 0..n {
        for j in 0..m {
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            if (i + j) % 2 == 0 {
                faces.extend([[a, b, c], [a, c, d]]);
            } else {
                faces.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    Patch { name: name.to_owned(), positions, faces, grain: None, piece: PieceSpec::default() }
}

/// The same, closed in the first direction.
pub(crate) fn tube(name: &str, n: u32, m: u32, map: impl Fn(f64, f64) -> DVec3) -> Patch {
    let mut patch = grid(name, n, m, map);
    let kept = n * (m + 1);
    for face in &mut patch.faces {
        *face = face.map(|v| if v >= kept { v - kept } else { v });
    }
    patch.positions.truncate(kept as usize);
    patch
}

/// Nodes of grid column i.
pub(crate) fn column(m: u32, i: u32) -> Vec<u32> {
    (0..=m).map(|j| i * (m + 1) + j).collect()
}

/// Part of a cylinder of radius 120 about the vertical.
pub(crate) fn cylinder(n: u32) -> Patch {
    grid("cylinder", n, n, |u, v| {
        let (s, c) = (2.4 * u).sin_cos();
        DVec3::new(120.0 * s, 300.0 * v, 120.0 * c)
    })
}

/// Part of a cone, slant 120 to 470, half angle 25°.
pub(crate) fn cone(n: u32) -> Patch {
    grid("cone", n, n, |u, v| {
        let (s, c) = (2.6 * u).sin_cos();
        let slant = 470.0 - 350.0 * v;
        let (r, h) = (slant * 25f64.to_radians().sin(), slant * 25f64.to_radians().cos());
        DVec3::new(r * s, -h, r * c)
    })
}

/// A cap of a sphere of radius 100, 75° from the pole: squares bent on.
pub(crate) fn cap(n: u32) -> Patch {
    grid("cap", n, n, |u, v| {
        let (x, y) = (2.0 * u - 1.0, 2.0 * v - 1.0);
        // Square to disk, rings to rings.
        let r = x.abs().max(y.abs());
        let length = x.hypot(y);
        let (p, q) = if length > 0.0 { (x / length, y / length) } else { (0.0, 0.0) };
        let (s, c) = (75f64.to_radians() * r).sin_cos();
        DVec3::new(100.0 * s * p, 100.0 * s * q, 100.0 * c)
    })
}

/// A saddle 300 mm wide.
pub(crate) fn saddle(n: u32) -> Patch {
    grid("saddle", n, n, |u, v| {
        let (x, y) = (2.0 * u - 1.0, 2.0 * v - 1.0);
        DVec3::new(150.0 * x, 150.0 * y, 70.0 * (x * x - y * y))
    })
}
