//! OBJ in and out.

use mesh_kernel::files::{
    Format, Place, Polyline, ReadError, WriteOptions, parse, read, to_bytes, write_atomically,
};
use mesh_kernel::glam::{DVec2, DVec3};
use mesh_kernel::{Group, TriMesh};

fn obj(text: &str) -> Result<TriMesh, ReadError> {
    parse(Format::Obj, text.as_bytes())
}

fn two_groups() -> TriMesh {
    let positions = vec![
        DVec3::new(0.0, 0.1, -0.0),
        DVec3::new(1.0 / 3.0, 0.0, 1e-7),
        DVec3::new(1.0, 1e6, 2.0),
        DVec3::new(-4.0, 5.5, -6.25),
    ];
    let faces = vec![[0, 1, 2], [0, 2, 3], [1, 3, 2]];
    let uv = |k: u32| DVec2::new(f64::from(k) * 0.7, 3.0 - f64::from(k));
    TriMesh {
        corner_uvs: Some(faces.iter().map(|f| f.map(uv)).collect()),
        groups: vec![
            Group { name: "front left".into(), faces: 0..2 },
            Group { name: "back".into(), faces: 2..3 },
        ],
        positions,
        faces,
    }
}

#[test]
fn groups_uvs_and_coordinates_come_back() {
    let mesh = two_groups();
    assert_eq!(parse(Format::Obj, &to_bytes(Format::Obj, &mesh, &WriteOptions::default())).unwrap(), mesh);
}

#[test]
fn every_form_of_corner_is_read() {
    let text = "\u{feff}# a comment\r\n\r\nmtllib x.mtl\r\no thing\r\nv 0 0 0 1 0.5 0.5\r\nv\t1 0 0\r\nv 1 1 \\\r\n0\r\nv 0 1 0\r\n\
        vt 0 0\r\nvt 1 0\r\nvt 1 1\r\nvn 0 0 1\r\ng quad\r\nf 1//1 2//1 3//1 4//1 # trailing\r\n\
        g tri\r\nf -4/1/1 -3/2/-1 -2/-1\r\nf 1 2 \\\r\n 3\r\nl 1 2\r\n  f 1/ 2 3";
    let mesh = obj(text).unwrap();
    assert_eq!(mesh.positions.len(), 4);
    assert_eq!(mesh.faces, [[0, 1, 2], [0, 2, 3], [0, 1, 2], [0, 1, 2], [0, 1, 2]]);
    let names: Vec<_> = mesh.groups.iter().map(|g| (g.name.as_str(), g.faces.clone())).collect();
    assert_eq!(names, [("quad", 0..2), ("tri", 2..5)]);
    assert_eq!(mesh.corner_uvs, None, "some corners have none");
}

#[test]
fn materials_are_groups_where_nothing_else_is() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl skin\nf 1 2 3\nusemtl skin\nf 3 2 1\nusemtl cloth\nf 1 2 3\n";
    let names: Vec<_> = obj(text).unwrap().groups.into_iter().map(|g| (g.name, g.faces)).collect();
    assert_eq!(names, [(String::new(), 0..1), ("skin".into(), 1..3), ("cloth".into(), 3..4)]);
    let text = "o Body\ng\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl skin\nf 1 2 3\nusemtl eye\nf 1 2 3\n";
    let names: Vec<_> = obj(text).unwrap().groups.into_iter().map(|g| (g.name, g.faces)).collect();
    assert_eq!(names, [("Body".to_owned(), 0..2)]);
}

#[test]
fn faults_are_named_with_their_line() {
    let head = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let fault = |tail: &str| obj(&format!("{head}{tail}")).unwrap_err();
    assert!(matches!(fault(""), ReadError::NoFaces { vertices: 3 }));
    assert!(matches!(fault("f 1 2\n"), ReadError::TooFewCorners { place: Place::Line(4), corners: 2 }));
    assert!(matches!(fault("f 1 2 4\nv 1 1"), ReadError::Truncated { place: Place::Line(5), .. }));
    let out = fault("f 1 2 3\nf 1 2 4\n");
    assert!(
        matches!(out, ReadError::IndexOutOfRange { place: Place::Line(5), index: 4, count: 3, .. }),
        "{out}"
    );
    assert!(matches!(fault("f 1 2 -4\n"), ReadError::IndexOutOfRange { index: -4, .. }));
    assert!(matches!(fault("f 1 2 0\n"), ReadError::IndexOutOfRange { index: 0, .. }));
    assert!(matches!(fault("f 1/1 2/1 3/1\n"), ReadError::IndexOutOfRange { index: 1, count: 0, .. }));
    assert!(matches!(fault("f 1 2 99999999999999999999\n"), ReadError::BadNumber { .. }));
    assert!(matches!(fault("f 1 2 x\n"), ReadError::BadNumber { place: Place::Line(4), .. }));
    assert!(matches!(fault("v 0 nan 0\n"), ReadError::NotFinite { place: Place::Line(4) }));
    assert!(matches!(fault("v 0 1e999 0\n"), ReadError::NotFinite { .. }));
    assert!(matches!(fault("v 0 1,5 0\n"), ReadError::BadNumber { .. }));
    // A face may come before its vertices.
    assert_eq!(obj("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").unwrap().faces.len(), 1);
}

#[test]
fn what_is_no_obj_is_told_by_what_it_is() {
    let told = |bytes: &[u8]| match parse(Format::Obj, bytes) {
        Err(e @ ReadError::WrongMagic { format: Format::Obj, .. }) => e.to_string(),
        other => panic!("{other:?}"),
    };
    for (bytes, said) in [
        (&b""[..], "it is empty"),
        (b"\n \r\n", "it is empty"),
        (b"# a comment\n", "only comments"),
        (b"\xff\xfev\x00 \x001\x00", "UTF-16"),
        (b"\x7fELF\x02\x00v 1 2 3\x00", "a zero at byte 5"),
        (b"# saved\n\nsolid part\n facet normal 0 0 1\n", "line 3 is 'solid part'"),
        (b"<html>\n<body>", "line 1 is '<html>'"),
    ] {
        let text = told(bytes);
        assert!(text.contains(said) && text.contains("OBJ"), "{text}");
    }
}

#[test]
fn polylines_and_decimals() {
    let options = WriteOptions {
        decimals: Some(2),
        comments: vec!["one\ntwo".into()],
        polylines: vec![Polyline { name: "waist\nf 1 1 1".into(), points: vec![DVec3::X, DVec3::Y] }],
        ..WriteOptions::default()
    };
    let text = String::from_utf8(to_bytes(Format::Obj, &two_groups(), &options)).unwrap();
    assert!(text.starts_with("# one\n# two\nv 0 0.1 0\nv 0.33 0 0\n"), "{text}");
    assert!(text.ends_with("g waist_f 1 1 1\nv 1 0 0\nv 0 1 0\nl 5 6\n"), "{text}");
    assert_eq!(obj(&text).unwrap().faces.len(), 3);
}

#[test]
fn files_are_written_whole_and_read_by_extension() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("Mesh.OBJ");
    let mesh = two_groups();
    let bytes = to_bytes(Format::Obj, &mesh, &WriteOptions::default());
    write_atomically(&path, b"old").unwrap();
    write_atomically(&path, &bytes).unwrap();
    assert_eq!(read(&path).unwrap(), mesh);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    assert!(write_atomically(&folder.path().join("no/where.obj"), b"x").is_err());
    assert!(matches!(read(&folder.path().join("x.txt")), Err(ReadError::UnknownFormat { .. })));
    assert!(matches!(read(&folder.path().join("x.obj")), Err(ReadError::Io { .. })));
}
