//! A skirt on real bodies, when they are there.

use std::path::Path;

use mesh_kernel::files;
use reference::human::{HumanOptions, extract};
use template::{Reference, RegenerateOptions, regenerate};

use super::collision::skirt;

#[test]
fn a_skirt_fits_a_woman_and_a_child() {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/bodies");
    if !shared.exists() {
        assert!(std::env::var_os("TOILE_REQUIRE_SHARED").is_none(), "{} is missing", shared.display());
        return;
    }
    for name in ["female-average.obj", "child-10.obj"] {
        let raw = files::read(&shared.join(name)).unwrap();
        let body = extract(&raw, &HumanOptions::default()).unwrap();
        let reference = Reference { mesh: &body.mesh, features: &body.features };
        let garment = regenerate(&skirt(15.0, 60.0), &reference, &RegenerateOptions::default()).unwrap();
        assert_eq!((garment.collision.nodes_inside, garment.collision.faces_crossing), (0, 0), "{name}");
        for (level, got) in &garment.ease {
            assert!((got - 60.0).abs() < 10.0, "{name} {level}: {got}");
        }
    }
}
