//! Analytic meshes and the bodies that lie beside the workspace.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use mesh_kernel::TriMesh;
use mesh_kernel::files::read;
use mesh_kernel::glam::DVec3;

/// An octahedron split `levels` times and blown up to `radius`.
pub(crate) fn icosphere(radius: f64, levels: u32) -> TriMesh {
    let mut positions = vec![DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let mut faces: Vec<[u32; 3]> =
        vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    for _ in 0..levels {
        let mut middle = BTreeMap::new();
        let mut split = Vec::with_capacity(faces.len() * 4);
        for [a, b, c] in faces {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(a, b)| {
                *middle.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    positions.push((positions[a as usize] + positions[b as usize]).normalize());
                    positions.len() as u32 - 1
                })
            });
            split.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        faces = split;
    }
    TriMesh::new(positions.into_iter().map(|p| p * radius).collect(), faces)
}

/// A torus about the y axis, faces outward.
pub(crate) fn torus(ring: f64, tube: f64, around: u32, across: u32) -> TriMesh {
    let positions = (0..around * across)
        .map(|k| {
            let u = f64::from(k / across) / f64::from(around) * TAU;
            let v = f64::from(k % across) / f64::from(across) * TAU;
            let r = ring + tube * v.cos();
            DVec3::new(r * u.cos(), tube * v.sin(), r * u.sin())
        })
        .collect();
    let at = |u: u32, v: u32| (u % around) * across + v % across;
    let faces = (0..around * across)
        .flat_map(|k| {
            let (u, v) = (k / across, k % across);
            [[at(u, v), at(u, v + 1), at(u + 1, v)], [at(u + 1, v), at(u, v + 1), at(u + 1, v + 1)]]
        })
        .collect();
    TriMesh::new(positions, faces)
}

/// A body of the shared folder, in its file's metres; `None` where the folder is absent and need not be there.
pub(crate) fn shared_body(name: &str) -> Option<TriMesh> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/bodies");
    let path = folder.join(format!("{name}.obj"));
    if !path.exists() {
        let required = std::env::var_os("TOILE_REQUIRE_SHARED").is_some_and(|v| v == "1");
        assert!(!required, "{} is missing", path.display());
        return None;
    }
    Some(read(&path).unwrap_or_else(|error| panic!("{error}")))
}

/// Numbers in [0, 1), the same every time.
pub(crate) struct Random(pub u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn in_box(&mut self, lo: DVec3, hi: DVec3) -> DVec3 {
        lo + (hi - lo) * DVec3::new(self.unit(), self.unit(), self.unit())
    }
}
