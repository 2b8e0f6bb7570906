//! Bodies through their files: random ones of every kind, and large ones.

use crate::body::support::{Random, add_attributes, add_wires, lattice, random_body};
use mesh_kernel::body::{Body, BodyFileError, ChainSpec, JointSpec, SurfaceId, SurfaceSpec};
use mesh_kernel::files::write_atomically;
use mesh_kernel::glam::{DVec2, DVec3};

/// Any finite number, all exponents alike.
fn any_float(random: &mut Random) -> f64 {
    loop {
        let value = f64::from_bits(random.next() << 33 | random.next() << 2 | (random.next() % 4));
        if value.is_finite() {
            return value;
        }
    }
}

/// The bits of all coordinates.
fn bits(body: &Body) -> Vec<u64> {
    let of = |p: &DVec3| p.to_array().map(f64::to_bits);
    body.surfaces()
        .flat_map(|(_, s)| {
            let spatial = s.positions().iter().chain(s.backup().unwrap_or_default()).flat_map(of);
            let planar = s.planar().unwrap_or_default().iter().map(|p| p.extend(0.0));
            spatial.chain(planar.flat_map(|p| of(&p))).collect::<Vec<_>>()
        })
        .collect()
}

#[test]
fn random_bodies_come_back_bit_for_bit() {
    for kind in 0..3 {
        for seed in 0..60 {
            let mut random = Random(seed ^ 0x5eed);
            let mut body = random_body(kind, seed);
            add_attributes(&mut body, &mut random);
            add_wires(&mut body, &mut random);
            for id in body.surface_ids() {
                let s = body.surface_mut(id);
                s.store_backup();
                // Where nodes are is no matter of the file: any finite numbers will do.
                for p in s.positions_mut() {
                    *p = DVec3::new(any_float(&mut random), any_float(&mut random), any_float(&mut random));
                }
                let flat = |_| DVec2::new(any_float(&mut random), any_float(&mut random));
                let planar = (0..s.positions().len()).map(flat).collect();
                // Every other body has been flattened.
                assert!(seed.is_multiple_of(2) || s.set_planar(planar));
            }
            let bytes = body.to_file_bytes().unwrap();
            let back = Body::from_file_bytes(&bytes).unwrap();
            assert_eq!(back, body, "kind {kind}, seed {seed}");
            assert_eq!(bits(&back), bits(&body));
            assert_eq!(back.to_file_bytes().unwrap(), bytes);
            // Editing goes on as if nothing had happened.
            let (mut a, mut b) = (body, back);
            a.split_all(None).unwrap();
            b.split_all(None).unwrap();
            assert_eq!(a, b);
        }
    }
}

#[test]
fn through_a_file_on_disk() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.body.json");
    let body = random_body(1, 5);
    write_atomically(&path, &body.to_file_bytes().unwrap()).unwrap();
    assert_eq!(Body::from_file_bytes(&std::fs::read(&path).unwrap()).unwrap(), body);
}

#[test]
fn a_large_body_is_read_in_memory_of_its_size() {
    let mut body = Body::from_tri_mesh(&lattice(3, [3, 3, 3], 0.5, 5)).unwrap();
    for _ in 0..5 {
        body.split_all(None).unwrap();
    }
    assert!(body.face_count() > 100_000);
    let bytes = body.to_file_bytes().unwrap();
    assert_eq!(Body::from_file_bytes(&bytes).unwrap(), body);
    // One number wrong anywhere.
    let text = String::from_utf8(bytes).unwrap();
    let at = text.rfind("\"start\":").unwrap();
    let broken = format!("{}\"start\":7{}", &text[..at], &text[at + 8..]);
    assert!(matches!(
        Body::from_file_bytes(broken.as_bytes()),
        Err(BodyFileError::Unsound { .. } | BodyFileError::UnknownId { .. })
    ));
}

#[test]
fn geometry_does_not_keep_a_body_from_being_saved() {
    // Work in progress may be degenerate, apart at its joints, or lie in itself.
    let mut body = random_body(0, 3);
    for p in body.surface_mut(SurfaceId(0)).positions_mut() {
        *p = DVec3::ZERO;
    }
    assert!(!body.check().is_empty());
    assert_eq!(Body::from_file_bytes(&body.to_file_bytes().unwrap()).unwrap(), body);
}

#[test]
fn the_guide_shows_a_file_as_it_is_written() {
    let guide = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/body-file.md");
    let text = std::fs::read_to_string(guide).unwrap();
    let example = text.split("```json\n").nth(1).unwrap().split("```").next().unwrap();
    let flap = |name: &str, x: f64| SurfaceSpec {
        name: name.into(),
        positions: vec![DVec3::ZERO, DVec3::new(0.0, 0.0, 40.0), DVec3::new(x, 0.0, 0.0)],
        faces: vec![[0, 1, 2]],
    };
    let chains = (0..2).map(|surface| ChainSpec { surface, nodes: vec![0, 1], closed: false }).collect();
    let joint = JointSpec { name: Some("rib".into()), chains };
    let body = Body::build(&[flap("front", 30.0), flap("back", -30.0)], &[joint]).unwrap();
    assert_eq!(String::from_utf8(body.to_file_bytes().unwrap()).unwrap(), example);
    assert_eq!(Body::from_file_bytes(example.as_bytes()).unwrap(), body);
}
