//! Damaged files: whatever the bytes, reading ends soon, with a sound mesh or a typed error.
//!
//! Seeded mutations of valid files of every format. `TOILE_FUZZ_SECONDS=600` runs longer, from another seed every time
//! it is given another `TOILE_FUZZ_SEED`. A find becomes a named test below.

use std::time::{Duration, Instant};

use mesh_kernel::files::{Encoding, Format, Polyline, ReadError, WriteOptions, parse, to_bytes};
use mesh_kernel::glam::{DVec2, DVec3};
use mesh_kernel::{Group, TriMesh};

mod query_shapes;
use query_shapes::{Random, torus};

/// What is put in place of numbers.
const WORDS: [&str; 22] = [
    "nan",
    "inf",
    "-inf",
    "1e999",
    "-0",
    "0",
    "-1",
    "1",
    "255",
    "256",
    "65536",
    "2147483648",
    "4294967295",
    "4294967296",
    "99999999999",
    "18446744073709551615",
    "1e-400",
    "0x1",
    "",
    "-",
    "f 1 2 3\n",
    "\n",
];
const BINARY_WORDS: [u32; 8] =
    [0, 1, 0x7f80_0000, 0x7fc0_0000, 0x7fff_ffff, 0x8000_0000, 0xffff_ffff, 0x0100_0000];

fn seeds() -> Vec<(Format, Vec<u8>)> {
    let mut mesh = torus(3.0, 1.0, 5, 4);
    mesh.corner_uvs =
        Some(mesh.faces.iter().map(|f| f.map(|v| DVec2::new(f64::from(v) / 8.0, 0.5))).collect());
    mesh.groups =
        vec![Group { name: "front".into(), faces: 0..10 }, Group { name: "back".into(), faces: 10..40 }];
    let bare = TriMesh::new(mesh.positions.clone(), mesh.faces.clone());
    let mut files = Vec::new();
    for mesh in [&mesh, &bare] {
        for format in [Format::Obj, Format::Ply, Format::Stl, Format::Off, Format::Glb] {
            for encoding in [Encoding::Binary, Encoding::Ascii] {
                let polylines = vec![Polyline { name: "line".into(), points: vec![DVec3::ZERO, DVec3::ONE] }];
                let options =
                    WriteOptions { encoding, decimals: Some(3), polylines, ..WriteOptions::default() };
                files.push((format, to_bytes(format, mesh, &options)));
            }
        }
    }
    // A document with everything a transform can hold.
    let text = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,2]}],"nodes":[{"children":[1],"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,5,6,7,1]},
        {"mesh":0,"name":"one","rotation":[0,0,0.7,0.7]},{"mesh":0,"scale":[-1,2,1],"translation":[1,2,3]}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":5},{"attributes":{"POSITION":0},"mode":6}]}],
        "accessors":[{"bufferView":0,"componentType":5121,"normalized":true,"count":3,"type":"VEC3"},{"bufferView":1,"byteOffset":0,"componentType":5121,"count":6,"type":"SCALAR"}],
        "bufferViews":[{"buffer":0,"byteLength":12,"byteStride":4},{"buffer":0,"byteOffset":12,"byteLength":6}],
        "buffers":[{"byteLength":18,"uri":"data:application/octet-stream;base64,AAAAAP8AAAAA/wAAAAECAgEA"}]}"#;
    files.push((Format::Glb, text.into()));
    let mut strips = b"ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        element tristrips 1\nproperty list uint short vertex_indices\nend_header\n"
        .to_vec();
    strips.extend([0u8; 48]);
    strips.extend([0, 0, 0, 6, 0, 0, 0, 1, 0, 2, 255, 255, 0, 3, 0, 1]);
    files.push((Format::Ply, strips));
    files.push((Format::Obj, b"o a\r\nv 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nvt 0 0\r\nusemtl m\r\nf -3/1/1 -2//2 -1/1 \\\r\n 1\r\nf 1 2 3 1\r\n".to_vec()));
    files
}

fn mutate(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.next() % 4 {
        if bytes.is_empty() {
            return;
        }
        let at = (random.next() % bytes.len() as u64) as usize;
        match random.next() % 9 {
            0 => bytes[at] ^= 1 << (random.next() % 8),
            1 => bytes[at] = random.next() as u8,
            2 => bytes.truncate(at),
            3 => {
                let end = (at + (random.next() % 64) as usize).min(bytes.len());
                bytes.drain(at..end);
            }
            4 => {
                let end = (at + (random.next() % 200) as usize).min(bytes.len());
                let copy = bytes[at..end].to_vec();
                let to = (random.next() % bytes.len() as u64) as usize;
                bytes.splice(to..to, copy);
            }
            5 | 6 => {
                // Replaces a whole number or word of text.
                let of_word = |b: &u8| b.is_ascii_alphanumeric() || matches!(b, b'.' | b'-');
                let Some(start) = bytes[at..].iter().position(of_word).map(|k| at + k) else { continue };
                let end = bytes[start..].iter().position(|b| !of_word(b)).map_or(bytes.len(), |k| start + k);
                let word = WORDS[(random.next() % WORDS.len() as u64) as usize];
                bytes.splice(start..end, word.bytes());
            }
            _ => {
                let word = BINARY_WORDS[(random.next() % BINARY_WORDS.len() as u64) as usize].to_le_bytes();
                for (k, byte) in word.into_iter().enumerate() {
                    if let Some(to) = bytes.get_mut(at + k) {
                        *to = byte;
                    }
                }
            }
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

#[test]
fn damaged_files_are_refused_or_sound() {
    let variable = |name: &str| std::env::var(name).ok().and_then(|value| value.parse::<u64>().ok());
    let seconds = variable("TOILE_FUZZ_SECONDS");
    let mut random = Random(variable("TOILE_FUZZ_SEED").unwrap_or(1));
    let files = seeds();
    for (format, bytes) in &files {
        check(&parse(*format, bytes).unwrap_or_else(|error| panic!("{format}: {error}")));
    }
    let start = Instant::now();
    let (mut rounds, mut refused, mut slowest) = (0u64, 0u64, Duration::ZERO);
    let go_on = |rounds: u64| seconds.map_or(rounds < 300_000, |s| start.elapsed() < Duration::from_secs(s));
    while go_on(rounds) {
        let (format, bytes) = &files[(random.next() % files.len() as u64) as usize];
        let state = random.0;
        let mut bytes = bytes.clone();
        mutate(&mut bytes, &mut random);
        // Sometimes read as another format: names lie.
        let format = if random.next().is_multiple_of(50) { Format::Obj } else { *format };
        let begin = Instant::now();
        let outcome = std::panic::catch_unwind(|| parse(format, &bytes));
        let took = begin.elapsed();
        slowest = slowest.max(took);
        assert!(took < Duration::from_secs(5), "{format}, state {state}: {took:?}");
        match outcome
            .unwrap_or_else(|_| panic!("{format}, state {state}: {}", String::from_utf8_lossy(&bytes)))
        {
            Ok(mesh) => check(&mesh),
            Err(error) => {
                let text = error.to_string();
                assert!(
                    !text.is_empty() && text.len() < 400 && !matches!(error, ReadError::Io { .. }),
                    "{text}"
                );
                refused += 1;
            }
        }
        rounds += 1;
    }
    println!("{rounds} files, {refused} refused, slowest {slowest:?}");
    assert!(refused > rounds / 10 && refused < rounds);
}
