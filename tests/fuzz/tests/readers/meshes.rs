//! Mesh files of every format.

use fuzz::{LONGEST, Reader, Reading, Shape};
use mesh_kernel::files::{Encoding, Format, Polyline, ReadError, WriteOptions, parse, to_bytes};
use mesh_kernel::glam::{DVec2, DVec3};
use mesh_kernel::{Group, TriMesh};

use crate::run;

/// A grid bent to a saddle, `n` cells a side.
fn saddle(n: u32) -> TriMesh {
    let node = |i: u32, j: u32| i * (n + 1) + j;
    let place = |i: u32, j: u32| {
        let [x, y] = [i, j].map(|k| f64::from(k) / f64::from(n) - 0.5);
        DVec3::new(x, y, x * x - y * y)
    };
    let nodes = (0..=n).flat_map(|i| (0..=n).map(move |j| place(i, j)));
    let cells = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let faces = cells.flat_map(|(i, j)| {
        [[node(i, j), node(i + 1, j), node(i + 1, j + 1)], [node(i, j), node(i + 1, j + 1), node(i, j + 1)]]
    });
    TriMesh::new(nodes.collect(), faces.collect())
}

/// Files that the program itself writes, with and without groups, flat coordinates and polylines.
fn written(format: Format) -> Vec<Vec<u8>> {
    let bare = saddle(2);
    let mut full = saddle(4);
    full.corner_uvs =
        Some(full.faces.iter().map(|f| f.map(|v| DVec2::new(f64::from(v) / 8.0, 0.5))).collect());
    full.groups =
        vec![Group { name: "front".into(), faces: 0..10 }, Group { name: "back".into(), faces: 10..32 }];
    let mut files = vec![to_bytes(format, &saddle(12), &WriteOptions::default())];
    for mesh in [bare, full] {
        for encoding in [Encoding::Binary, Encoding::Ascii] {
            for decimals in [None, Some(3)] {
                let polylines = vec![Polyline { name: "line".into(), points: vec![DVec3::ZERO, DVec3::ONE] }];
                let comments = vec!["made for a test".into()];
                let options =
                    WriteOptions { encoding, decimals, polylines, comments, ..WriteOptions::default() };
                files.push(to_bytes(format, &mesh, &options));
            }
        }
    }
    files.sort();
    files.dedup();
    files
}

fn read(format: Format, bytes: &[u8]) -> Reading {
    match parse(format, bytes) {
        Ok(mesh) => {
            check(&mesh);
            let flats = mesh.corner_uvs.as_ref().map_or(0, Vec::len);
            Reading::Sound(vec![mesh.positions.len(), mesh.faces.len(), mesh.groups.len(), flats])
        }
        Err(error) => {
            assert!(!matches!(error, ReadError::Io { .. }));
            let words = error.to_string();
            assert!(words.len() < 600, "a message of {} bytes", words.len());
            Reading::Refused(words)
        }
    }
}

fn check(mesh: &TriMesh) {
    let count = mesh.positions.len();
    assert!(!mesh.faces.is_empty());
    assert!(mesh.faces.as_flattened().iter().all(|v| (*v as usize) < count));
    assert!(mesh.positions.iter().all(|p| p.is_finite()));
    if let Some(flats) = &mesh.corner_uvs {
        assert_eq!(flats.len(), mesh.faces.len());
        assert!(flats.as_flattened().iter().all(|uv| uv.is_finite()));
    }
    let mut end = 0;
    for group in &mesh.groups {
        assert!(group.faces.start >= end && group.faces.end > group.faces.start);
        end = group.faces.end;
    }
    assert!(end as usize <= mesh.faces.len());
}

/// A quad with two bytes a corner unfolds to 24 bytes a triangle with its numbers and growing lists hold twice as much
/// and the old while they move: 64 bytes a byte are enough for text. The base is for what even an empty file takes.
fn reader(name: &'static str, format: Format, words: &'static [&'static str]) -> Reader {
    Reader {
        name,
        shape: Shape::Bytes,
        seeds: written(format),
        words,
        inputs: 60_000,
        base_memory: 1 << 16,
        memory_factor: 64,
        read: Box::new(move |bytes| read(format, bytes)),
    }
}

#[test]
fn obj() {
    let words =
        &["v ", "vt ", "vn ", "f ", "g ", "o ", "l ", "usemtl ", "/", "//", "\\\n", "\n", "#", "1/1/1", "-1"];
    let mut reader = reader("OBJ", Format::Obj, words);
    reader.seeds.push(
        b"o a\r\nv 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nvt 0 0\r\nusemtl m\r\nf -3/1/1 -2//2 -1/1 \\\r\n 1\r\nf 1 2 3 1\r\n"
            .to_vec(),
    );
    run(reader);
}

#[test]
fn ply() {
    let words = &[
        "ply\n",
        "format ascii 1.0\n",
        "format binary_little_endian 1.0\n",
        "format binary_big_endian 1.0\n",
        "element vertex 3\n",
        "element face 1\n",
        "element tristrips 1\n",
        "property list uchar int vertex_indices\n",
        "property list uchar float texcoord\n",
        "property float s\n",
        "property float t\n",
        "property uchar red\n",
        "property double x\n",
        "end_header\n",
        "comment ",
        "char",
        "uchar",
        "short",
        "ushort",
        "int",
        "uint",
        "float",
        "double",
        "vertex",
        "face",
        "tristrips",
        "vertex_indices",
        "list",
    ];
    let mut reader = reader("PLY", Format::Ply, words);
    let mut strips =
        b"ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
        property float z\nelement tristrips 1\nproperty list uint short vertex_indices\nend_header\n"
            .to_vec();
    strips.extend([0u8; 48]);
    strips.extend([0, 0, 0, 6, 0, 0, 0, 1, 0, 2, 255, 255, 0, 3, 0, 1]);
    reader.seeds.push(strips);
    reader.seeds.push(
        b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property float s\nproperty float t\nelement face 1\nproperty list uchar int vertex_index\nend_header\n\
        0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n"
            .to_vec(),
    );
    run(reader);
}

#[test]
fn stl() {
    let words = &[
        "solid ",
        "endsolid",
        "facet normal 0 0 1\n",
        "endfacet\n",
        "outer loop\n",
        "endloop\n",
        "vertex ",
        "\0",
    ];
    run(reader("STL", Format::Stl, words));
}

#[test]
fn off() {
    let words =
        &["OFF", "COFF", "STOFF", "NOFF", "4OFF", "nOFF", "BINARY", "#", "\n", "3 0 1 2\n", "4 0 1 2 3\n"];
    let mut reader = reader("OFF", Format::Off, words);
    reader.seeds.push(
        b"CNOFF # colours\n\n4 1 0\n0 0 0 1 0 0 255\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 0.5 0.5 1\n".to_vec(),
    );
    run(reader);
}

#[test]
fn gltf() {
    let words = &[
        "POSITION",
        "TEXCOORD_0",
        "VEC2",
        "VEC3",
        "SCALAR",
        "5120",
        "5121",
        "5122",
        "5123",
        "5125",
        "5126",
        "4",
        "5",
        "6",
        "matrix",
        "rotation",
        "scale",
        "translation",
        "children",
        "byteStride",
        "byteOffset",
        "sparse",
        "mode",
        "indices",
        "KHR_draco_mesh_compression",
        "data:application/octet-stream;base64,AAAA",
    ];
    let mut reader = reader("glTF", Format::Glb, words);
    reader.shape = Shape::Gltf;
    // Nodes share meshes and primitives share numbers: the file unfolds, up to the reader's own limit of 2^18 + 4 a byte
    // vertices and triangles (24, 12 and, with flat coordinates, 48 bytes each; growing lists as above).
    reader.base_memory = (3 * 84) << 18;
    reader.memory_factor = 3 * 84 * 4;
    // A document with everything a transform can hold.
    let text = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,2]}],"nodes":[{"children":[1],"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,5,6,7,1]},
        {"mesh":0,"name":"one","rotation":[0,0,0.7,0.7]},{"mesh":0,"scale":[-1,2,1],"translation":[1,2,3]}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":5},{"attributes":{"POSITION":0},"mode":6}]}],
        "accessors":[{"bufferView":0,"componentType":5121,"normalized":true,"count":3,"type":"VEC3"},{"bufferView":1,"byteOffset":0,"componentType":5121,"count":6,"type":"SCALAR"}],
        "bufferViews":[{"buffer":0,"byteLength":12,"byteStride":4},{"buffer":0,"byteOffset":12,"byteLength":6}],
        "buffers":[{"byteLength":18,"uri":"data:application/octet-stream;base64,AAAAAP8AAAAA/wAAAAECAgEA"}]}"#;
    reader.seeds.push(text.into());
    run(reader);
}

#[test]
fn names_that_lie() {
    // Files under another format's name.
    let formats = [Format::Obj, Format::Ply, Format::Stl, Format::Off, Format::Glb];
    let files: Vec<Vec<u8>> = formats.into_iter().flat_map(written).collect();
    for bytes in &files {
        assert!(bytes.len() < LONGEST);
        for format in formats {
            let _ = read(format, bytes);
        }
    }
}
