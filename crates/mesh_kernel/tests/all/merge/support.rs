//! Solids made by formulas, and an examination of results that shares no code with the merge.

use std::collections::BTreeMap;

use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DQuat, DVec3};
use mesh_kernel::query::Crossings;

/// Numbers in [0, 1) from a seed.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x2545_f491_4f6c_dd1d)
    }

    pub(crate) fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() * n as f64) as usize
    }

    pub(crate) fn point(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0
    }

    pub(crate) fn turn(&mut self) -> DQuat {
        DQuat::from_axis_angle(self.point().normalize_or(DVec3::Z), self.next() * std::f64::consts::TAU)
    }
}

/// A box between two corners, faces outward.
pub(crate) fn block(lo: DVec3, hi: DVec3) -> TriMesh {
    let at = |k: usize| {
        DVec3::new(
            if k & 1 == 0 { lo.x } else { hi.x },
            if k & 2 == 0 { lo.y } else { hi.y },
            if k & 4 == 0 { lo.z } else { hi.z },
        )
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriMesh::new((0..8).map(at).collect(), faces)
}

/// A tetrahedron, faces outward.
pub(crate) fn tetrahedron([a, b, c, d]: [DVec3; 4]) -> TriMesh {
    let faces = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let mut mesh = TriMesh::new(vec![a, b, c, d], faces);
    if (b - a).cross(c - a).dot(d - a) < 0.0 {
        mesh.positions.swap(0, 1);
    }
    mesh
}

/// A sphere of 20 · 4^`levels` faces.
pub(crate) fn sphere(centre: DVec3, radius: f64, levels: u32) -> TriMesh {
    let g = (1.0 + 5f64.sqrt()) / 2.0;
    let mut positions: Vec<DVec3> = [
        (-1.0, g, 0.0),
        (1.0, g, 0.0),
        (-1.0, -g, 0.0),
        (1.0, -g, 0.0),
        (0.0, -1.0, g),
        (0.0, 1.0, g),
        (0.0, -1.0, -g),
        (0.0, 1.0, -g),
        (g, 0.0, -1.0),
        (g, 0.0, 1.0),
        (-g, 0.0, -1.0),
        (-g, 0.0, 1.0),
    ]
    .iter()
    .map(|&(x, y, z)| DVec3::new(x, y, z).normalize())
    .collect();
    let mut faces: Vec<[u32; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..levels {
        let mut middle: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let mut next = Vec::with_capacity(4 * faces.len());
        for [a, b, c] in faces {
            let mut half = |p: u32, q: u32| {
                *middle.entry([p.min(q), p.max(q)]).or_insert_with(|| {
                    positions.push((positions[p as usize] + positions[q as usize]).normalize());
                    positions.len() as u32 - 1
                })
            };
            let (x, y, z) = (half(a, b), half(b, c), half(c, a));
            next.extend([[a, x, z], [x, b, y], [z, y, c], [x, y, z]]);
        }
        faces = next;
    }
    TriMesh::new(positions.into_iter().map(|p| centre + p * radius).collect(), faces)
}

/// Moves all positions.
pub(crate) fn moved(mesh: &TriMesh, by: impl Fn(DVec3) -> DVec3) -> TriMesh {
    TriMesh::new(mesh.positions.iter().map(|p| by(*p)).collect(), mesh.faces.clone())
}

/// Six times the volume over six.
pub(crate) fn volume(mesh: &TriMesh) -> f64 {
    let Some([lo, hi]) = mesh.bounds() else { return 0.0 };
    let middle = (lo + hi) / 2.0;
    (0..mesh.faces.len() as u32)
        .map(|f| {
            let [a, b, c] = mesh.corners(f).map(|p| p - middle);
            a.dot(b.cross(c)) / 6.0
        })
        .sum()
}

/// What is wrong with a solid: `None` if nothing.
pub(crate) fn fault(mesh: &TriMesh) -> Option<String> {
    let mut edges: BTreeMap<[u32; 2], Vec<(u32, bool)>> = BTreeMap::new();
    let mut corners: Vec<Vec<u32>> = vec![Vec::new(); mesh.positions.len()];
    for (f, face) in (0..).zip(&mesh.faces) {
        for k in 0..3 {
            let (a, b) = (face[k], face[(k + 1) % 3]);
            if a == b {
                return Some(format!("face {f} names node {a} twice"));
            }
            edges.entry([a.min(b), a.max(b)]).or_default().push((f, a < b));
            corners[a as usize].push(f);
        }
        if mesh.area_normal(f) == DVec3::ZERO {
            return Some(format!("face {f} has no area"));
        }
    }
    for (edge, uses) in &edges {
        if uses.len() != 2 || uses[0].1 == uses[1].1 {
            return Some(format!("edge {edge:?} has {uses:?}"));
        }
    }
    // Walk from face to face about every node.
    for (v, faces) in corners.iter().enumerate().filter(|(_, f)| !f.is_empty()) {
        let v = v as u32;
        let mut reached = vec![faces[0]];
        let mut next = 0;
        while next < reached.len() {
            let face = mesh.faces[reached[next] as usize];
            next += 1;
            for k in 0..3 {
                let (a, b) = (face[k], face[(k + 1) % 3]);
                if a == v || b == v {
                    for (f, _) in &edges[&[a.min(b), a.max(b)]] {
                        if !reached.contains(f) {
                            reached.push(*f);
                        }
                    }
                }
            }
        }
        if reached.len() != faces.len() {
            return Some(format!("node {v} has {} faces, {} in one fan", faces.len(), reached.len()));
        }
    }
    let crossing = Crossings::new(mesh).self_crossing();
    crossing.first().map(|pair| format!("{} pairs of faces cross, first {pair:?}", crossing.len()))
}
