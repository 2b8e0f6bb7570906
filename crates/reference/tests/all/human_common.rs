//! Bodies for the tests of feature extraction.

use std::path::PathBuf;

use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DMat3, DVec3};
use reference::human::{HumanBody, HumanOptions, extract};

/// The twelve models and four scans.
pub(crate) const BODIES: [&str; 16] = [
    "female-average",
    "female-slim-tall",
    "female-plus",
    "female-petite",
    "female-bust-large",
    "female-hips-large",
    "female-old",
    "male-average",
    "male-tall",
    "male-heavy",
    "male-muscular",
    "child-10",
    "scan-decimated",
    "scan-remeshed",
    "scan-noisy-plus",
    "scan-noisy-tall",
];

/// The folder of bodies beside the checkout; `None` skips the test, unless the environment demands the data.
pub(crate) fn shared_bodies() -> Option<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/bodies");
    if folder.is_dir() {
        return Some(folder);
    }
    assert!(std::env::var_os("TOILE_REQUIRE_SHARED").is_none(), "{} is missing", folder.display());
    None
}

pub(crate) fn read(name: &str) -> Option<TriMesh> {
    let path = shared_bodies()?.join(format!("{name}.obj"));
    Some(mesh_kernel::files::read(&path).unwrap())
}

pub(crate) fn features(mesh: &TriMesh) -> HumanBody {
    extract(mesh, &HumanOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

/// The mesh after `p -> scale * rotation * p + shift`.
pub(crate) fn moved(mesh: &TriMesh, scale: f64, rotation: DMat3, shift: DVec3) -> TriMesh {
    mapped(mesh, |p| rotation * p * scale + shift)
}

pub(crate) fn mapped(mesh: &TriMesh, map: impl Fn(DVec3) -> DVec3) -> TriMesh {
    TriMesh { positions: mesh.positions.iter().map(|p| map(*p)).collect(), ..mesh.clone() }
}

/// Uniform numbers in -1..1, always the same ones.
pub(crate) struct Dice(u64);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(crate) fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
