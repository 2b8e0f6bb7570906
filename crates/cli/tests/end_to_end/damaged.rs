//! Damaged, empty and unsuitable inputs: exit 1, a message that names the file, and no file left behind.

use std::path::Path;

use crate::call::{Folder, list, toile, word};
use crate::fixtures::{ball, dress, form, three_sheets};

/// Every command that reads a mesh, reading `mesh` and writing into `out`.
fn readers(mesh: &Path, out: &Path) -> Vec<Vec<String>> {
    let own = |words: &[&str]| words.iter().map(|w| (*w).to_owned()).collect::<Vec<_>>();
    let (mesh, at) = (word(mesh), |name: &str| out.join(name).to_str().unwrap().to_owned());
    vec![
        own(&["regenerate", word(dress()), "--body", mesh, "--out", &at("garment")]),
        own(&["features", mesh, "-o", &at("features.json"), "--picture", &at("features.png")]),
        own(&["check", mesh]),
        own(&["info", mesh]),
        own(&["flatten", mesh, "-o", &at("flat.svg")]),
        own(&["thicken", mesh, "--thickness", "1", "-o", &at("solid.stl")]),
        own(&["render", mesh, "-o", &at("picture.png"), "--size", "64x64"]),
        own(&["render", mesh, "--with", mesh, "-o", &at("both.png"), "--size", "64x64"]),
    ]
}

#[track_caller]
fn all_refuse(name: &str, bytes: impl AsRef<[u8]>) {
    let folder = Folder::new(&format!("damaged-{}", name.replace('.', "-")));
    let mesh = folder.write(name, bytes);
    let out = folder.join("out");
    std::fs::create_dir(&out).unwrap();
    for call in readers(&mesh, &out) {
        let told = toile(&call).refused(1, name);
        assert!(told.stdout.is_empty(), "no report of a failure: {}", told.stdout);
    }
    assert_eq!(list(&out), Vec::<String>::new(), "nothing is left behind");
}

#[test]
fn empty_files() {
    for name in ["a.obj", "a.ply", "a.stl", "a.off", "a.glb"] {
        all_refuse(name, "");
    }
}

#[test]
fn files_without_faces() {
    all_refuse("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    all_refuse("none.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n");
}

#[test]
fn numbers_that_are_none() {
    all_refuse("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    all_refuse("inf.obj", "v 0 0 inf\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    all_refuse("far.obj", "v 0 0 1e30\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    all_refuse("huge.obj", "v 0 0 1e999\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    all_refuse("words.off", "OFF\n3 1 0\n0 0 zero\n1 0 0\n0 1 0\n3 0 1 2\n");
    let mut bytes = b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n".to_vec();
    for x in [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, f32::NAN, 1.0, 0.0] {
        bytes.extend(x.to_le_bytes());
    }
    bytes.extend([3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0]);
    all_refuse("nan.ply", bytes);
}

#[test]
fn a_triangle_that_names_a_node_twice_is_found_by_its_number() {
    let folder = Folder::new("damaged-twice");
    let mesh = folder.write("twice.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\ng front\nf 1 2 3\nf 1 2 2\n");
    let told = toile(&["check", word(&mesh)]).refused(1, "twice.obj");
    assert!(told.stderr.contains("triangle 2, in group `front`,"), "{}", told.stderr);
    assert!(told.stderr.contains("1, 2, 2 (counted from 1)"), "{}", told.stderr);
}

#[test]
fn a_picture_that_cannot_be_drawn_names_its_file() {
    let folder = Folder::new("damaged-picture");
    // In metres, beyond what can be drawn in millimetres.
    let mesh = folder.write("far.obj", "v 0 0 0\nv 1e8 0 0\nv 0 1 0\nf 1 2 3\n");
    let out = folder.join("far.png");
    toile(&["render", word(&mesh), "--unit", "m", "-o", word(&out)]).refused(1, "far.obj");
    assert!(!out.exists());
}

#[test]
fn indices_out_of_range() {
    all_refuse("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    all_refuse("zero.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n");
    all_refuse("range.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n");
}

#[test]
fn counts_beyond_the_file_and_beyond_memory() {
    all_refuse("count.off", "OFF\n4000000000 4000000000 0\n0 0 0\n");
    all_refuse(
        "count.ply",
        "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n",
    );
    let mut stl = vec![0u8; 80];
    stl.extend(u32::MAX.to_le_bytes());
    stl.extend([0; 50]);
    all_refuse("count.stl", stl);
    let mut glb = b"glTF".to_vec();
    for x in [2u32, u32::MAX, u32::MAX - 20, 0x4E4F_534A] {
        glb.extend(x.to_le_bytes());
    }
    all_refuse("count.glb", glb);
}

#[test]
fn truncated_files_of_every_format() {
    let folder = Folder::new("whole");
    for format in ["ply", "stl", "off", "glb"] {
        let whole = folder.join(&format!("form.{format}"));
        toile(&["form", "--bust", "90", "-o", word(&whole)]).succeeded();
        let bytes = std::fs::read(&whole).unwrap();
        all_refuse(&format!("cut.{format}"), &bytes[..bytes.len() * 2 / 3]);
    }
    // An OBJ says nothing about its length: cut inside a number or a face, it must be noticed or be no body.
    let bytes = std::fs::read(form()).unwrap();
    let cut = folder.write("cut.obj", &bytes[..bytes.len() / 3]);
    toile(&["regenerate", word(dress()), "--body", word(&cut), "--out", word(&folder.join("o"))])
        .refused(1, "cut.obj");
    assert_eq!(list(&folder.join("o")), Vec::<String>::new());
}

#[test]
fn files_that_are_not_what_they_say() {
    all_refuse("text.glb", three_sheets(2));
    all_refuse("text.stl", "hello, this is no mesh at all");
    all_refuse(
        "noise.obj",
        (0..4000u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect::<Vec<u8>>(),
    );
}

#[test]
fn missing_files_unknown_kinds_and_folders() {
    let folder = Folder::new("missing");
    let out = folder.join("out");
    for call in readers(&folder.join("nowhere.obj"), &out) {
        toile(&call).refused(1, "nowhere.obj");
    }
    let other = folder.write("body.docx", "v 0 0 0\n");
    for call in readers(&other, &out) {
        toile(&call).refused(1, "body.docx");
    }
    std::fs::create_dir(folder.join("folder.obj")).unwrap();
    for call in readers(&folder.join("folder.obj"), &out) {
        toile(&call).refused(1, "folder.obj");
    }
    assert_eq!(list(&out), Vec::<String>::new());
}

#[test]
fn a_ball_is_no_body() {
    let folder = Folder::new("ball");
    let ball = folder.write("ball.obj", ball());
    toile(&["info", word(&ball)]).succeeded();
    let features = folder.join("features.json");
    toile(&["features", word(&ball), "-o", word(&features)]).refused(1, "ball.obj");
    let out = folder.join("out");
    toile(&["regenerate", word(dress()), "--body", word(&ball), "--out", word(&out)]).refused(1, "ball.obj");
    assert_eq!(folder.list(), ["ball.obj"], "nothing is left behind");
}

#[test]
fn damaged_templates() {
    let folder = Folder::new("templates");
    let out = folder.join("out");
    let good = std::fs::read_to_string(dress()).unwrap();
    let cases = [
        ("empty.json", String::new()),
        ("cut.json", good[..good.len() / 2].to_owned()),
        ("other.json", "{\"name\": \"no template\"}".to_owned()),
        ("list.json", "[1, 2, 3]".to_owned()),
        ("version.json", good.replacen("\"toile_template\": 1", "\"toile_template\": 999", 1)),
        ("feature.json", good.replacen("\"centre_front\"", "\"centre_of_nowhere\"", 1)),
        ("deep.json", "[".repeat(100_000)),
    ];
    for (name, text) in cases {
        let template = folder.write(name, text);
        let told = toile(&["regenerate", word(&template), "--body", word(form()), "--out", word(&out)]);
        told.refused(1, if name == "feature.json" { "centre_of_nowhere" } else { name });
    }
    assert_eq!(list(&out), Vec::<String>::new());
}

#[test]
fn a_place_that_cannot_be_written() {
    let folder = Folder::new("unwritable");
    let file = folder.write("file", "in the way");
    let under = file.join("out");
    toile(&["regenerate", word(dress()), "--body", word(form()), "--out", word(&under), "--formats", "json"])
        .refused(1, "");
    toile(&["render", word(form()), "-o", word(&under.join("a.png")), "--size", "32x32"]).refused(1, "");
    toile(&["features", word(form()), "-o", word(&under.join("f.json"))]).refused(1, "");
    let solid = under.join("s.obj");
    toile(&["thicken", word(form()), "--thickness", "1", "-o", word(&solid)]).refused(1, "");
    assert_eq!(std::fs::read(&file).unwrap(), b"in the way");
    assert_eq!(folder.list(), ["file"]);
}

#[test]
fn pictures_beyond_memory_are_refused() {
    let folder = Folder::new("big-picture");
    let picture = folder.join("a.png");
    for size in ["100000x100000", "4000000000x4000000000", "16384x16384"] {
        let told = toile(&["render", word(form()), "-o", word(&picture), "--size", size]);
        assert!(told.code == Some(1) || told.code == Some(2), "{told:?}");
        assert!(told.stderr.starts_with("error:"), "{told:?}");
    }
    assert_eq!(folder.list(), Vec::<String>::new());
}
