//! Files of pymeshlab and trimesh (`tests/reference/make_files.py`), and files for them to read.

use mesh_kernel::files::{Encoding, Format, WriteOptions, read, to_bytes, write_atomically};
use mesh_kernel::glam::{DVec2, DVec3};
use mesh_kernel::{Group, TriMesh};
use serde_json::Value;

use crate::shapes::torus;

#[test]
fn files_of_other_programs_hold_what_they_read_themselves() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/reference/data");
    let text = std::fs::read_to_string(folder.join("files.json")).unwrap();
    let all: Value = serde_json::from_str(&text).unwrap();
    let all = all.as_object().unwrap();
    assert_eq!(all.len(), 12);
    for (name, record) in all {
        let mesh = read(&folder.join("files").join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        let corners = record["corners"].as_array().unwrap();
        assert_eq!(mesh.faces.len(), corners.len(), "{name}");
        assert_eq!(mesh.positions.len(), 40, "{name}: nodes are shared");
        // STL readers may turn a face's corners round.
        for (f, want) in corners.iter().enumerate() {
            let want: Vec<f64> = want.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
            let got = mesh.corners(f as u32);
            let want = [0, 3, 6].map(|k| DVec3::from_slice(&want[k..k + 3]));
            let off = |turn: usize| (0..3).map(|k| got[k].distance(want[(k + turn) % 3])).fold(0.0, f64::max);
            assert!(
                (0..3).map(off).fold(f64::INFINITY, f64::min) < 1e-6,
                "{name}, face {f}: {got:?} {want:?}"
            );
        }
    }
}

#[test]
fn files_for_other_programs() {
    let Some(folder) = std::env::var_os("TOILE_WRITE_FILES").map(std::path::PathBuf::from) else { return };
    let mut mesh: TriMesh = torus(300.0, 100.0, 24, 12);
    mesh.groups =
        vec![Group { name: "front".into(), faces: 0..100 }, Group { name: "back".into(), faces: 100..576 }];
    mesh.corner_uvs = Some(mesh.faces.iter().map(|f| f.map(|v| DVec2::new(f64::from(v), 1.5))).collect());
    std::fs::create_dir_all(&folder).unwrap();
    for (name, format, encoding) in [
        ("mesh.obj", Format::Obj, Encoding::Ascii),
        ("binary.ply", Format::Ply, Encoding::Binary),
        ("ascii.ply", Format::Ply, Encoding::Ascii),
        ("binary.stl", Format::Stl, Encoding::Binary),
        ("ascii.stl", Format::Stl, Encoding::Ascii),
        ("mesh.off", Format::Off, Encoding::Ascii),
        ("mesh.glb", Format::Glb, Encoding::Binary),
    ] {
        let options = WriteOptions { encoding, ..WriteOptions::default() };
        write_atomically(&folder.join(name), &to_bytes(format, &mesh, &options)).unwrap();
    }
}
