//! PLY, STL, OFF and glTF in and out.

use mesh_kernel::files::{Encoding, Format, Place, Polyline, ReadError, WriteOptions, parse, to_bytes};
use mesh_kernel::glam::{DVec2, DVec3};
use mesh_kernel::{Group, MAX_COORDINATE, TriMesh};

use crate::shapes::torus;

fn options(encoding: Encoding) -> WriteOptions {
    WriteOptions { encoding, glb_scale: 1.0, comments: vec!["made here".into()], ..WriteOptions::default() }
}

fn with_flats(mut mesh: TriMesh) -> TriMesh {
    let flat = |v: u32| DVec2::new(f64::from(v) * 0.25, 7.0 - f64::from(v) / 3.0);
    mesh.corner_uvs = Some(mesh.faces.iter().map(|f| f.map(flat)).collect());
    mesh
}

/// Positions of the corners: what stays when nodes are renumbered.
fn corners(mesh: &TriMesh) -> Vec<[DVec3; 3]> {
    (0..mesh.faces.len() as u32).map(|f| mesh.corners(f)).collect()
}

#[test]
fn ply_and_off_come_back_exactly() {
    let mesh = with_flats(torus(300.0, 100.0, 24, 12));
    for encoding in [Encoding::Binary, Encoding::Ascii] {
        assert_eq!(parse(Format::Ply, &to_bytes(Format::Ply, &mesh, &options(encoding))).unwrap(), mesh);
    }
    let off = parse(Format::Off, &to_bytes(Format::Off, &mesh, &options(Encoding::Ascii))).unwrap();
    assert_eq!((off.positions, off.faces), (mesh.positions, mesh.faces));
}

#[test]
fn stl_corners_are_welded() {
    let mut mesh = torus(300.0, 100.0, 24, 12);
    mesh.positions.iter_mut().for_each(|p| *p = p.as_vec3().as_dvec3());
    mesh.groups =
        vec![Group { name: "a".into(), faces: 0..100 }, Group { name: "b".into(), faces: 100..576 }];
    for encoding in [Encoding::Binary, Encoding::Ascii] {
        let back = parse(Format::Stl, &to_bytes(Format::Stl, &mesh, &options(encoding))).unwrap();
        assert_eq!(corners(&back), corners(&mesh));
        assert_eq!(back.positions.len(), mesh.positions.len());
        assert_eq!(back.groups, if encoding == Encoding::Ascii { mesh.groups.clone() } else { vec![] });
    }
    let text = b"  SOLID x\n facet normal 0 0 1\n outer loop\n vertex 0 0 -0\n vertex 1 0 0\n vertex 0 1 0\n endloop\n endfacet\nendsolid";
    assert_eq!(parse(Format::Stl, text).unwrap().faces, [[0, 1, 2]]);
    // A binary file whose comment begins with "solid".
    let mut bytes = to_bytes(Format::Stl, &mesh, &options(Encoding::Binary));
    bytes[..6].copy_from_slice(b"solid ");
    assert_eq!(parse(Format::Stl, &bytes).unwrap().faces.len(), 576);
}

#[test]
fn glb_keeps_groups_flats_and_scale() {
    let mut mesh = with_flats(torus(300.0, 100.0, 24, 12));
    mesh.groups =
        vec![Group { name: "front".into(), faces: 0..100 }, Group { name: "back".into(), faces: 100..576 }];
    let line = Polyline { name: "waist".into(), points: vec![DVec3::X, DVec3::Y, DVec3::Z] };
    let options = WriteOptions { polylines: vec![line], ..WriteOptions::default() };
    let back = parse(Format::Glb, &to_bytes(Format::Glb, &mesh, &options)).unwrap();
    assert_eq!(back.groups, mesh.groups);
    for (got, want) in corners(&back).iter().flatten().zip(corners(&mesh).iter().flatten()) {
        assert!((*got * 1000.0).distance(*want) < 1e-4);
    }
    for (got, want) in
        back.corner_uvs.unwrap().iter().flatten().zip(mesh.corner_uvs.unwrap().iter().flatten())
    {
        assert!(got.distance(*want) < 1e-4);
    }
    let nothing = to_bytes(Format::Glb, &TriMesh::default(), &WriteOptions::default());
    assert!(matches!(parse(Format::Glb, &nothing), Err(ReadError::NoFaces { vertices: 0 })));
}

#[test]
fn gltf_documents_with_transforms_and_other_layouts() {
    // Bytes 0..9: three u8 positions with a stride of 4 (normalised), then u8 indices 0 1 2 2 1 0 at 12.
    let data = "AAAAAP8AAAAA/wAAAAECAgEA";
    let document = |nodes: &str, mode: u32, kind: u32| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":{nodes},
            "meshes":[{{"name":"m","primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"mode":{mode}}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5121,"normalized":true,"count":3,"type":"VEC3"}},
                         {{"bufferView":1,"componentType":{kind},"count":6,"type":"SCALAR"}}],
            "bufferViews":[{{"buffer":0,"byteLength":12,"byteStride":4}},{{"buffer":0,"byteOffset":12,"byteLength":6}}],
            "buffers":[{{"byteLength":18,"uri":"data:application/octet-stream;base64,{data}"}}]}}"#
        )
    };
    let read = |text: String| parse(Format::Glb, text.as_bytes());
    let nested = r#"[{"children":[1,2],"translation":[10,0,0]},
        {"mesh":0,"name":"one","rotation":[0,0,0.7071067811865476,0.7071067811865476]},{"mesh":0,"scale":[-1,2,1]}]"#;
    let mesh = read(document(nested, 4, 5121)).unwrap();
    let names: Vec<_> = mesh.groups.iter().map(|g| (g.name.as_str(), g.faces.clone())).collect();
    assert_eq!(names, [("one", 0..2), ("m", 2..4)]);
    let near = |p: DVec3, x: f64, y: f64, z: f64| assert!(p.distance(DVec3::new(x, y, z)) < 1e-12, "{p}");
    near(mesh.positions[1], 10.0, 1.0, 0.0);
    near(mesh.positions[2], 9.0, 0.0, 0.0);
    near(mesh.positions[4], 9.0, 0.0, 0.0);
    near(mesh.positions[5], 10.0, 2.0, 0.0);
    assert_eq!(mesh.faces, [[0, 1, 2], [2, 1, 0], [3, 5, 4], [5, 3, 4]], "mirrored faces are turned");
    assert_eq!(read(document(r#"[{"mesh":0}]"#, 5, 5121)).unwrap().faces.len(), 4);
    assert_eq!(read(document(r#"[{"mesh":0}]"#, 6, 5121)).unwrap().faces[1], [2, 2, 0]);
    assert!(matches!(read(document(r#"[{"mesh":0}]"#, 1, 5121)), Err(ReadError::NoFaces { .. })));
    for (nodes, kind) in [
        (r#"[{"mesh":0,"children":[0]}]"#, 5121),
        (r#"[{"mesh":1}]"#, 5121),
        (r#"[{"mesh":0,"children":[7]}]"#, 5121),
        (r#"[{"mesh":0,"scale":[1e308,1e308,1e308],"children":[1]},{"mesh":0,"scale":[1e308,1,1]}]"#, 5121),
        (r#"[{"mesh":0}]"#, 5126),
        (r#"[{"mesh":0}]"#, 5120),
        (r#"[{"mesh":0}]"#, 99),
        (r#"[{"mesh":0,"matrix":[1,2]}]"#, 5121),
        ("[", 5121),
    ] {
        let error = read(document(nodes, 4, kind)).unwrap_err();
        assert!(!error.to_string().is_empty(), "{nodes} {error}");
    }
}

#[test]
fn coordinates_have_one_limit_in_every_format() {
    let mesh = |far: f64| {
        TriMesh::new(vec![DVec3::ZERO, DVec3::X * far, DVec3::new(0.0, 1.0, -far)], vec![[0, 1, 2]])
    };
    let options = WriteOptions { glb_scale: 1.0, ..WriteOptions::default() };
    let texts =
        [Encoding::Ascii, Encoding::Binary].map(|encoding| WriteOptions { encoding, ..options.clone() });
    for format in [Format::Obj, Format::Ply, Format::Stl, Format::Off, Format::Glb] {
        for options in &texts {
            let read = |far: f64| parse(format, &to_bytes(format, &mesh(far), options));
            assert!(read(MAX_COORDINATE).is_ok(), "{format}");
            for far in [1.01 * MAX_COORDINATE, 1e30] {
                let told = read(far).unwrap_err().to_string();
                assert!(told.contains("beyond ±1e9"), "{format}: {told}");
            }
        }
    }
}

#[test]
fn ply_variants() {
    let text = "ply\r\nformat ascii 1.0\r\ncomment x\r\nelement vertex 4\r\nproperty float x\r\nproperty float y\r\n\
        property float z\r\nproperty uchar red\r\nproperty float s\r\nproperty float t\r\nelement face 1\r\n\
        property uchar flags\r\nproperty list uchar int vertex_index\r\nelement edge 1\r\nproperty int a\r\nend_header\r\n\
        0 0 0 255 0 0\r\n1 0 0 255 1 0\r\n1 1 0 255 1 1\r\n0 1 0 255 0 1\r\n7 4 0 1 2 3\r\n9\r\n";
    let mesh = parse(Format::Ply, text.as_bytes()).unwrap();
    assert_eq!(mesh.faces, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.corner_uvs.unwrap()[1], [DVec2::ZERO, DVec2::ONE, DVec2::Y]);
    // Big-endian floats and a strip of shorts with a restart.
    let mut bytes = b"ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        element tristrips 1\nproperty list uint short vertex_indices\nend_header\n".to_vec();
    for value in [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0] {
        bytes.extend(value.to_be_bytes());
    }
    bytes.extend(8u32.to_be_bytes());
    for index in [0i16, 1, 2, 3, -1, 2, 1, 0] {
        bytes.extend(index.to_be_bytes());
    }
    let mesh = parse(Format::Ply, &bytes).unwrap();
    assert_eq!(mesh.faces, [[0, 1, 2], [2, 1, 3], [2, 1, 0]]);
    assert_eq!(mesh.positions[3], DVec3::new(1.0, 1.0, 0.0));
}

#[test]
fn off_variants() {
    let text = "# first\nCOFF # colours\n4 1 0 # counts\n0 0 0 1 0 0 1\n\n1 0 0 1 0 0 1\n1 1 0 1 0 0 1 # here\n0 1 0 1 0 0 1\n4 0 1 2 3 255 0 0\n";
    assert_eq!(parse(Format::Off, text.as_bytes()).unwrap().faces, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(parse(Format::Off, b"OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2").unwrap().faces, [[0, 1, 2]]);
}

#[test]
fn faults_are_typed() {
    let mesh = torus(3.0, 1.0, 6, 5);
    for format in [Format::Ply, Format::Stl, Format::Off, Format::Glb] {
        let error = parse(format, b"").unwrap_err();
        let magic = matches!(error, ReadError::WrongMagic { .. });
        assert!(magic, "{format} {error}");
        assert!(
            matches!(parse(format, b"hello world, this is text\n"), Err(ReadError::WrongMagic { .. })),
            "{format}"
        );
        for encoding in [Encoding::Binary, Encoding::Ascii] {
            let bytes = to_bytes(format, &mesh, &options(encoding));
            for cut in [bytes.len() / 3, bytes.len() / 2, bytes.len() * 9 / 10] {
                let error = parse(format, &bytes[..cut]).unwrap_err();
                assert!(
                    matches!(
                        error,
                        ReadError::Truncated { .. }
                            | ReadError::CountTooLarge { .. }
                            | ReadError::BadNumber { .. }
                            | ReadError::Malformed { .. }
                    ),
                    "{format} {cut} {error:?}"
                );
            }
        }
    }
    let ply = |counts: (u64, u64), body: &str| {
        let text = format!(
            "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\nelement face {}\n\
             property list uchar int vertex_indices\nend_header\n{body}",
            counts.0, counts.1
        );
        parse(Format::Ply, text.as_bytes()).unwrap_err()
    };
    assert!(matches!(ply((u64::MAX, 1), "0 0 0\n"), ReadError::CountTooLarge { place: Place::Line(3), .. }));
    assert!(matches!(ply((1, 1), "0 0 nan\n3 0 0 0\n"), ReadError::NotFinite { place: Place::Line(10) }));
    assert!(matches!(
        ply((1, 1), "0 0 0\n3 0 0 1\n"),
        ReadError::IndexOutOfRange { place: Place::Line(11), index: 1, .. }
    ));
    assert!(matches!(ply((1, 1), "0 0 0\n3 0 0 -1\n"), ReadError::IndexOutOfRange { index: -1, .. }));
    assert!(matches!(ply((1, 1), "0 0 0\n2 0 0\n"), ReadError::TooFewCorners { corners: 2, .. }));
    assert!(matches!(ply((1, 1), "0 0 0\n200 0 0\n"), ReadError::CountTooLarge { .. }));
    assert!(matches!(ply((1, 0), "0 0 0\n"), ReadError::NoFaces { vertices: 1 }));
    let off = |text: &str| parse(Format::Off, text.as_bytes()).unwrap_err();
    assert!(matches!(
        off("OFF\n999999999999 1 0\n0 0 0\n"),
        ReadError::CountTooLarge { place: Place::Line(2), .. }
    ));
    assert!(matches!(
        off("OFF\n1 1 0\n0 0 0\n3 0 0 1\n"),
        ReadError::IndexOutOfRange { place: Place::Line(4), .. }
    ));
    assert!(matches!(off("OFF\n1 1 0\n0 inf 0\n3 0 0 0\n"), ReadError::NotFinite { place: Place::Line(3) }));
    assert!(matches!(off("4OFF\n1 1 0\n"), ReadError::Unsupported { .. }));
    let mut stl = to_bytes(Format::Stl, &mesh, &options(Encoding::Binary));
    stl[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(matches!(parse(Format::Stl, &stl), Err(ReadError::NotFinite { place: Place::Byte(96) })));
    stl[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(matches!(parse(Format::Stl, &stl), Err(ReadError::CountTooLarge { place: Place::Byte(80), .. })));
}
