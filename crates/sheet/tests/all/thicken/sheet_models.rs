//! Sheets made by formulas; lengths in millimetres.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use mesh_kernel::glam::{DQuat, DVec3};
use mesh_kernel::{Group, TriMesh};

/// Collects patches; nodes in one place stay separate, as in files, for thickening welds them.
#[derive(Default)]
pub(crate) struct Patches {
    pub(crate) mesh: TriMesh,
}

impl Patches {
    /// A patch of `nu × nv` cells over the unit square.
    pub(crate) fn grid(mut self, nu: usize, nv: usize, f: impl Fn(f64, f64) -> DVec3) -> Self {
        let first = self.mesh.positions.len() as u32;
        for i in 0..=nu {
            for j in 0..=nv {
                self.mesh.positions.push(f(i as f64 / nu as f64, j as f64 / nv as f64));
            }
        }
        let at = |i: usize, j: usize| first + (i * (nv + 1) + j) as u32;
        let start = self.mesh.faces.len() as u32;
        for i in 0..nu {
            for j in 0..nv {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                let cell = if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                self.mesh.faces.extend(cell);
            }
        }
        self.close(start)
    }

    /// A parallelogram.
    pub(crate) fn plane(self, o: [f64; 3], u: [f64; 3], v: [f64; 3], nu: usize, nv: usize) -> Self {
        let [o, u, v] = [o, u, v].map(DVec3::from);
        self.grid(nu, nv, move |s, t| o + s * u + t * v)
    }

    /// A patch of given triangles.
    pub(crate) fn triangles(mut self, positions: &[DVec3], faces: &[[u32; 3]]) -> Self {
        let (first, start) = (self.mesh.positions.len() as u32, self.mesh.faces.len() as u32);
        self.mesh.positions.extend_from_slice(positions);
        self.mesh.faces.extend(faces.iter().map(|f| f.map(|v| v + first)));
        self.close(start)
    }

    /// All faces from the last group on are one more patch.
    fn close(mut self, start: u32) -> Self {
        let name = format!("patch_{}", self.mesh.groups.len() + 1);
        self.mesh.groups.push(Group { name, faces: start..self.mesh.faces.len() as u32 });
        self
    }
}

pub(crate) fn turned(mut mesh: TriMesh) -> TriMesh {
    let turn = DQuat::from_axis_angle(DVec3::new(0.3, -0.8, 0.5).normalize(), 1.1);
    for p in &mut mesh.positions {
        *p = turn * *p + DVec3::new(13.7, -4.1, 8.9);
    }
    mesh
}

pub(crate) fn plate(nu: usize, nv: usize) -> TriMesh {
    Patches::default().plane([0., 0., 0.], [40., 0., 0.], [0., 30., 0.], nu, nv).mesh
}

/// Legs 100 and 50, width 60.
pub(crate) fn l_sheet(n: usize) -> TriMesh {
    Patches::default()
        .plane([0., 0., 0.], [100., 0., 0.], [0., 60., 0.], n, n)
        .plane([0., 0., 0.], [0., 0., 50.], [0., 60., 0.], n, n)
        .mesh
}

/// Bar 2 × 50, stem 50, width 60.
pub(crate) fn t_sheet(n: usize) -> TriMesh {
    fan(&[0.0, PI, FRAC_PI_2], 50.0, n)
}

pub(crate) fn x_sheet(n: usize) -> TriMesh {
    fan(&[0.0, PI, FRAC_PI_2, -FRAC_PI_2], 50.0, n)
}

pub(crate) fn y_sheet(n: usize) -> TriMesh {
    fan(&[0.0, TAU / 3.0, 2.0 * TAU / 3.0], 60.0, n)
}

/// Planes that leave the y-axis at given angles; width 60.
pub(crate) fn fan(angles: &[f64], leg: f64, n: usize) -> TriMesh {
    let mut patches = Patches::default();
    for angle in angles {
        let (s, c) = angle.sin_cos();
        let snap = |x: f64| if x.abs() < 1e-15 { 0.0 } else { x };
        patches = patches.plane([0.; 3], [leg * snap(c), 0., leg * snap(s)], [0., 60., 0.], n, n);
    }
    patches.mesh
}

/// 100 × 60 × 40, open above; with a partition across the middle when asked.
pub(crate) fn open_box(n: usize, partition: bool) -> TriMesh {
    let (d, h) = (60.0, 40.0);
    let stops: &[f64] = if partition { &[0.0, 50.0, 100.0] } else { &[0.0, 100.0] };
    let mut patches = Patches::default();
    for x in stops.windows(2) {
        let along = [x[1] - x[0], 0., 0.];
        patches = patches
            .plane([x[0], 0., 0.], along, [0., d, 0.], n, n)
            .plane([x[0], 0., 0.], along, [0., 0., h], n, n)
            .plane([x[0], d, 0.], along, [0., 0., h], n, n);
    }
    for &x in stops {
        patches = patches.plane([x, 0., 0.], [0., d, 0.], [0., 0., h], n, n);
    }
    patches.mesh
}

/// A closed box of 20 × 30 × 40.
pub(crate) fn closed_box(n: usize) -> TriMesh {
    let (w, d, h) = (20.0, 30.0, 40.0);
    let mut patches = Patches::default();
    for z in [0.0, h] {
        patches = patches.plane([0., 0., z], [w, 0., 0.], [0., d, 0.], n, n);
    }
    for y in [0.0, d] {
        patches = patches.plane([0., y, 0.], [w, 0., 0.], [0., 0., h], n, n);
    }
    for x in [0.0, w] {
        patches = patches.plane([x, 0., 0.], [0., d, 0.], [0., 0., h], n, n);
    }
    patches.mesh
}

/// An octahedron's faces, `k` times split into four, on the sphere of radius 50; the upper half or all.
pub(crate) fn sphere(k: usize, half: bool) -> TriMesh {
    let mut positions = vec![DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let mut faces: Vec<[u32; 3]> = vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
    if half {
        positions.pop();
    } else {
        faces.extend([[1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]]);
    }
    for _ in 0..k {
        let mut middles = std::collections::BTreeMap::new();
        let mut finer = Vec::new();
        for [a, b, c] in faces {
            let [x, y, z] = [[a, b], [b, c], [c, a]].map(|[i, j]| {
                *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    positions.push((positions[i as usize] + positions[j as usize]).normalize());
                    positions.len() as u32 - 1
                })
            });
            finer.extend([[a, x, z], [x, b, y], [z, y, c], [x, y, z]]);
        }
        faces = finer;
    }
    let positions: Vec<DVec3> = positions.into_iter().map(|p| 50.0 * p).collect();
    Patches::default().triangles(&positions, &faces).mesh
}

/// The saddle `z = 0.004 (x² − y²)` over 100 × 100 with a fin standing on `y = 0`.
pub(crate) fn saddle_with_fin(n: usize) -> TriMesh {
    let (c, a, h) = (0.004, 50.0, 30.0);
    let z = move |x: f64, y: f64| c * (x * x - y * y);
    let half = move |sign: f64| {
        move |u: f64, v: f64| {
            let (x, y) = (-a + 2.0 * a * u, sign * a * v);
            DVec3::new(x, if v == 0.0 { 0.0 } else { y }, z(x, y))
        }
    };
    Patches::default()
        .grid(2 * n, n, half(1.0))
        .grid(2 * n, n, half(-1.0))
        .grid(2 * n, n, move |u, v| {
            let x = -a + 2.0 * a * u;
            DVec3::new(x, 0.0, z(x, 0.0) + v * (h + c * a * a - z(x, 0.0)))
        })
        .mesh
}

/// A Möbius strip of radius 30 and width 12.
pub(crate) fn moebius(n: usize) -> TriMesh {
    let mut mesh = Patches::default()
        .grid(n, 4, |u, v| {
            let (turn, w) = (TAU * u, 12.0 * (v - 0.5));
            let (s, c) = turn.sin_cos();
            let r = 30.0 + w * (0.5 * turn).cos();
            DVec3::new(r * c, r * s, w * (0.5 * turn).sin())
        })
        .mesh;
    // The last row is the first one upside down.
    let row = |i: usize, j: usize| i * 5 + j;
    for j in 0..5 {
        mesh.positions[row(n, j)] = mesh.positions[row(0, 4 - j)];
    }
    mesh
}

/// Two flanges of 20 joined by a bend of 90° with a radius of `radius`, width 30.
pub(crate) fn bent_strip(radius: f64, n: usize, m: usize) -> TriMesh {
    let arc = radius * FRAC_PI_2;
    // Cells: m along each flange, n along the bend.
    let stops: Vec<f64> = (0..m)
        .map(|i| 20.0 * i as f64 / m as f64)
        .chain((0..n).map(|i| 20.0 + arc * i as f64 / n as f64))
        .chain((0..=m).map(|i| 20.0 + arc + 20.0 * i as f64 / m as f64))
        .collect();
    let count = stops.len() - 1;
    Patches::default()
        .grid(count, 6, |u, v| {
            let s = stops[(u * count as f64).round() as usize];
            let y = 30.0 * v;
            if s <= 20.0 {
                DVec3::new(s - 20.0, y, 0.0)
            } else if s < 20.0 + arc {
                let (sin, cos) = ((s - 20.0) / radius).sin_cos();
                DVec3::new(radius * sin, y, radius * (1.0 - cos))
            } else {
                DVec3::new(radius, y, radius + (s - 20.0 - arc))
            }
        })
        .mesh
}

/// A cone of `n` facets with an apex, every second base corner at `inner` times the radius 20, height 15.
pub(crate) fn pyramid(n: usize, inner: f64) -> TriMesh {
    let mut positions = vec![DVec3::Z * 15.0];
    for i in 0..n {
        let (s, c) = (TAU * i as f64 / n as f64).sin_cos();
        let r = if i % 2 == 0 { 20.0 } else { 20.0 * inner };
        positions.push(DVec3::new(r * c, r * s, 0.0));
    }
    let faces: Vec<[u32; 3]> = (0..n as u32).map(|i| [0, 1 + i, 1 + (i + 1) % n as u32]).collect();
    Patches::default().triangles(&positions, &faces).mesh
}

/// Two plates that cross at right angles without sharing nodes.
pub(crate) fn crossing_plates() -> TriMesh {
    Patches::default()
        .plane([0., 0., 0.], [40., 0., 0.], [0., 30., 0.], 5, 4)
        .plane([19., 2., -17.], [0.7, 0., 40.], [0., 25., 0.], 5, 4)
        .mesh
}

/// Two parallel plates `gap` apart.
pub(crate) fn near_plates(gap: f64) -> TriMesh {
    Patches::default()
        .plane([0., 0., 0.], [40., 0., 0.], [0., 30., 0.], 5, 4)
        .plane([0., 0., gap], [40., 0., 0.], [0., 30., 0.], 3, 3)
        .mesh
}

pub(crate) fn one_triangle() -> TriMesh {
    TriMesh::new(vec![DVec3::ZERO, DVec3::X * 10.0, DVec3::Y * 7.0], vec![[0, 1, 2]])
}

/// Two triangles that share one node only.
pub(crate) fn bow_tie() -> TriMesh {
    let p =
        [DVec3::ZERO, DVec3::X * 10.0, DVec3::new(10., 5., 0.), DVec3::X * -10.0, DVec3::new(-10., -5., 2.)];
    TriMesh::new(p.to_vec(), vec![[0, 1, 2], [0, 3, 4]])
}

/// A closed box with a fin inside that ends in a corner.
pub(crate) fn box_with_corner_fin() -> TriMesh {
    let fin = [DVec3::ZERO, DVec3::new(15., 20., 0.), DVec3::new(10., 15., 20.)];
    Patches { mesh: closed_box(2) }.triangles(&fin, &[[0, 1, 2]]).mesh
}

/// Every kind once, with its name.
pub(crate) fn all() -> Vec<(String, TriMesh)> {
    let mut sheets: Vec<(String, TriMesh)> = Vec::new();
    for n in [1, 3, 8] {
        sheets.push((format!("plate {n}"), plate(n, n)));
        sheets.push((format!("L {n}"), l_sheet(n)));
        sheets.push((format!("T {n}"), t_sheet(n)));
        sheets.push((format!("X {n}"), x_sheet(n)));
        sheets.push((format!("Y {n}"), y_sheet(n)));
        sheets.push((format!("open box {n}"), open_box(n, false)));
        sheets.push((format!("partition {n}"), open_box(n, true)));
        sheets.push((format!("closed box {n}"), closed_box(n)));
    }
    for k in 0..4 {
        sheets.push((format!("hemisphere {k}"), sphere(k, true)));
        sheets.push((format!("sphere {k}"), sphere(k, false)));
    }
    for n in [2, 8] {
        sheets.push((format!("saddle with fin {n}"), saddle_with_fin(n)));
    }
    sheets.push(("Möbius strip".into(), moebius(40)));
    let mut seed = 7u64;
    for k in 3..8 {
        let angles: Vec<f64> = (0..k)
            .map(|_| {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (seed >> 11) as f64 / (1u64 << 53) as f64 * TAU
            })
            .collect();
        sheets.push((format!("fan of {k}"), fan(&angles, 50.0, 3)));
    }
    for (radius, n) in [(3.0, 6), (1.2, 6), (0.6, 6), (0.6, 40), (0.05, 3)] {
        sheets.push((format!("bend of {radius} in {n}"), bent_strip(radius, n, 5)));
    }
    for (n, inner) in [(4, 1.0), (5, 1.0), (36, 1.0), (10, 0.5), (10, 0.8), (24, 0.3), (6, 0.2)] {
        sheets.push((format!("pyramid {n} {inner}"), pyramid(n, inner)));
    }
    sheets.push(("crossing plates".into(), crossing_plates()));
    sheets.push(("near plates".into(), near_plates(1.3)));
    sheets.push(("triangle".into(), one_triangle()));
    sheets.push(("bow tie".into(), bow_tie()));
    sheets.push(("box with a fin in a corner".into(), box_with_corner_fin()));
    let rotated: Vec<_> =
        sheets.iter().map(|(name, s)| (format!("{name}, turned"), turned(s.clone()))).collect();
    sheets.extend(rotated);
    sheets
}
