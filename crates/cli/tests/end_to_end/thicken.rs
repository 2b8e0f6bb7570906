//! `thicken`: sheets to solids, in every format, with the figures that the geometry has.

use std::collections::BTreeMap;
use std::path::Path;

use mesh_kernel::TriMesh;
use serde_json::Value;

use crate::call::{Folder, has_keys, number, toile, word};
use crate::fixtures::{dress, read, root, three_sheets};

const KEYS: [&str; 12] = [
    "faces",
    "closed",
    "self_intersections",
    "volume",
    "components",
    "genus",
    "min_wall",
    "max_wall",
    "purged",
    "holes_filled",
    "seconds",
    "places",
];

/// A T of three square plates of `size` millimetres: a bar along x in two patches, a stem along z, cells of `size`/`n`.
/// Groups `left`, `right`, `stem`. Coordinates are multiplied with `scale`.
fn tee(size: f64, n: u32, scale: f64) -> String {
    plates(&[("left", [-1.0, 0.0]), ("right", [1.0, 0.0]), ("stem", [0.0, 1.0])], size, n, scale)
}

/// Square plates that stand on the y axis, each in its direction (x, z).
fn plates(directions: &[(&str, [f64; 2])], size: f64, n: u32, scale: f64) -> String {
    let (mut nodes, mut faces) = (String::new(), String::new());
    let at = |k: u32| size * f64::from(k) / f64::from(n) * scale;
    for j in 0..=n {
        nodes.push_str(&format!("v 0 {} 0\n", at(j)));
    }
    for (s, (name, [x, z])) in (0..).zip(directions) {
        faces.push_str(&format!("g {name}\n"));
        let node = |i: u32, j: u32| if i == 0 { j + 1 } else { (n + 1) * (1 + s * n + i - 1) + j + 1 };
        for i in 1..=n {
            for j in 0..=n {
                nodes.push_str(&format!("v {} {} {}\n", at(i) * x, at(j), at(i) * z));
            }
        }
        for i in 0..n {
            for j in 0..n {
                let [p, q, r, t] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
                faces.push_str(&format!("f {p} {q} {r}\nf {p} {r} {t}\n"));
            }
        }
    }
    nodes + &faces
}

fn volume(mesh: &TriMesh) -> f64 {
    let six = |f: u32| {
        let [a, b, c] = mesh.corners(f);
        a.cross(b).dot(c)
    };
    (0..mesh.faces.len() as u32).map(six).sum::<f64>() / 6.0
}

/// Every edge must have two faces that run along it in opposite directions. Formats that do not share nodes between
/// groups share places.
#[track_caller]
fn is_closed(mesh: &TriMesh) {
    let place = |v: u32| mesh.positions[v as usize].to_array().map(|x| (x + 0.0).to_bits());
    let mut uses: BTreeMap<_, i32> = BTreeMap::new();
    for face in &mesh.faces {
        for i in 0..3 {
            let (a, b) = (place(face[i]), place(face[(i + 1) % 3]));
            assert!(a != b, "a degenerate face");
            *uses.entry((a, b)).or_default() += 1;
        }
    }
    let once = |((a, b), n): (&(_, _), &i32)| *n == 1 && uses.get(&(*b, *a)) == Some(&1);
    assert!(uses.iter().all(once), "not every edge has two faces");
}

fn thickened(sheet: &Path, solid: &Path, more: &[&str]) -> Value {
    let words = ["thicken", word(sheet), "-o", word(solid), "--json"];
    toile(&[&words[..], more].concat()).succeeded().json()
}

#[track_caller]
fn near(value: f64, wanted: f64, relative: f64) {
    assert!((value - wanted).abs() <= relative * wanted.abs(), "{value} is not {wanted}");
}

/// Of a T with legs `size` and width `size`, everywhere 2 `d` thick.
fn tee_volume(size: f64, d: f64) -> f64 {
    size * (6.0 * d * size - 2.0 * d * d)
}

#[test]
fn every_format_holds_the_same_solid() {
    let folder = Folder::new("thicken-formats");
    let sheet = folder.write("tee.obj", tee(40.0, 3, 1.0));
    for format in ["obj", "ply", "stl", "off", "glb"] {
        let path = folder.join(&format!("solid.{format}"));
        let report = thickened(&sheet, &path, &["--thickness", "2"]);
        has_keys(&report, &KEYS);
        has_keys(&report["purged"], &["laminar", "screen", "wire", "isthmus", "strut", "redundant"]);
        assert_eq!((&report["closed"], &report["self_intersections"]), (&true.into(), &0.into()));
        assert_eq!((&report["components"], &report["genus"]), (&1.into(), &0.into()));
        // Seven digits of 40 mm are some millionths of a wall of 2 mm.
        let rounding = if matches!(format, "stl" | "glb") { 4e-6 } else { 1e-9 };
        near(number(&report["volume"]), tee_volume(40.0, 1.0), rounding);
        near(number(&report["min_wall"]), 2.0, rounding.max(1e-6));
        near(number(&report["max_wall"]), 2.0, rounding.max(1e-6));
        let mesh = read(&path);
        is_closed(&mesh);
        assert_eq!(mesh.faces.len() as u64, report["faces"].as_u64().unwrap());
        let metres = if format == "glb" { 1e-3f64 } else { 1.0 };
        near(volume(&mesh), tee_volume(40.0, 1.0) * metres.powi(3), rounding);
        let roles: u64 = report["roles"].as_object().unwrap().values().map(|n| n.as_u64().unwrap()).sum();
        assert_eq!(roles, mesh.faces.len() as u64);
    }
    // Formats with groups name the parts of the solid.
    for format in ["obj", "glb"] {
        let mesh = read(&folder.join(&format!("solid.{format}")));
        let names: Vec<&str> = mesh.groups.iter().map(|g| g.name.as_str()).collect();
        for part in ["front_wall", "back_wall", "thickness_faces"] {
            assert!(names.contains(&part), "{format}: {names:?}");
        }
    }
}

#[test]
fn corners_are_round_or_mitred_and_may_be_refined() {
    let folder = Folder::new("thicken-corners");
    let fold = folder.write("fold.obj", plates(&[("floor", [1.0, 0.0]), ("wall", [0.0, 1.0])], 40.0, 2, 1.0));
    let solid = folder.join("solid.obj");
    let mitred = thickened(&fold, &solid, &["--thickness", "4", "--corners", "mitre"]);
    near(number(&mitred["volume"]), 40.0 * (2.0 * 2.0 * 80.0), 1e-9);
    let d: f64 = 2.0;
    let exact = 40.0 * (2.0 * d * 80.0 - d * d + std::f64::consts::PI * d * d / 4.0);
    let round = thickened(&fold, &solid, &["--thickness", "4"]);
    near(number(&round["volume"]), exact, 1e-3);
    let fine = thickened(&fold, &solid, &["--thickness", "4", "--chord", "0.0005"]);
    near(number(&fine["volume"]), exact, 1e-5);
    assert!(fine["faces"].as_u64() > round["faces"].as_u64());
    is_closed(&read(&solid));
}

#[test]
fn one_side_holds_all_of_it_and_joints_refuse() {
    let folder = Folder::new("thicken-sides");
    let plate = folder.write("plate.obj", plates(&[("floor", [1.0, 0.0])], 40.0, 2, 1.0));
    let solid = folder.join("solid.obj");
    let mut lowest_and_highest = Vec::new();
    for side in ["front", "back"] {
        let report = thickened(&plate, &solid, &["--thickness", "2", "--side", side]);
        near(number(&report["volume"]), 2.0 * 1600.0, 1e-9);
        let [low, high] = read(&solid).bounds().unwrap();
        lowest_and_highest.push((low.z, high.z));
    }
    lowest_and_highest.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert_eq!(lowest_and_highest, [(-2.0, 0.0), (0.0, 2.0)]);

    let tee = folder.write("tee.obj", tee(40.0, 2, 1.0));
    let refused = folder.join("refused.obj");
    let words = ["thicken", word(&tee), "--thickness", "2", "--side", "front", "-o", word(&refused)];
    let told = toile(&words).refused(1, "tee.obj");
    // The joint is named by the patches that meet in it, and there is a way out.
    for said in ["left", "right", "stem", "--side both"] {
        assert!(told.stderr.contains(said), "{said} is not said: {}", told.stderr);
    }
    assert!(!refused.exists());
}

#[test]
fn thicknesses_by_patch_and_from_a_list() {
    let folder = Folder::new("thicken-thicknesses");
    let tee = folder.write("tee.obj", tee(40.0, 2, 1.0));
    let solid = folder.join("solid.obj");
    let all = ["--thickness", "2", "--patch-thickness", "stem=4"];
    let named = thickened(&tee, &solid, &all);
    // The bar as before; the stem begins a millimetre above the middle of it.
    near(number(&named["volume"]), 40.0 * (2.0 * 80.0 + 4.0 * 39.0), 1e-9);
    let list: Vec<f64> = (0..24).map(|f| if f < 16 { 2.0 } else { 4.0 }).collect();
    let file = folder.write("list.json", serde_json::to_string(&list).unwrap());
    let listed = thickened(&tee, &solid, &["--thickness-file", word(&file)]);
    near(number(&listed["volume"]), number(&named["volume"]), 1e-9);
    // A number a node: linear, here from 2 at the foot of a plate to 4 at its end.
    let plate = folder.write("plate.obj", plates(&[("floor", [1.0, 0.0])], 40.0, 2, 1.0));
    let nodes: Vec<f64> = (0..9).map(|v| 2.0 + f64::from(v / 3)).collect();
    let file = folder.write("nodes.json", serde_json::to_string(&nodes).unwrap());
    let linear = thickened(&plate, &solid, &["--thickness-file", word(&file)]);
    near(number(&linear["volume"]), 3.0 * 1600.0, 1e-3);

    let refused = |more: &[&str], about: &str| {
        let out = folder.join("refused.obj");
        let words = ["thicken", word(&tee), "-o", word(&out)];
        toile(&[&words[..], more].concat()).refused(1, about);
        assert!(!out.exists());
    };
    refused(&["--thickness", "2", "--patch-thickness", "roof=4"], "\"left\", \"right\", \"stem\"");
    refused(&["--patch-thickness", "stem=4"], "--thickness");
    refused(&["--thickness-file", word(&folder.join("nowhere.json"))], "nowhere.json");
    for (text, about) in [
        ("[1, 2, 3]", "24 triangles"),
        ("{}", "list of numbers"),
        ("[1, null]", "list of numbers"),
        ("[1,", "list of numbers"),
        ("", "list of numbers"),
    ] {
        let file = folder.write("bad.json", text);
        refused(&["--thickness-file", word(&file)], about);
        refused(&["--thickness-file", word(&file)], "bad.json");
    }
    let mut list = list;
    list[6] = -2.0;
    let file = folder.write("bad.json", serde_json::to_string(&list).unwrap());
    refused(&["--thickness-file", word(&file)], "number 7");
}

#[test]
fn thickness_is_in_millimetres_whatever_the_unit_of_the_sheet() {
    let folder = Folder::new("thicken-units");
    let solid = folder.join("solid.obj");
    let plain = folder.write("tee-mm.obj", tee(400.0, 2, 1.0));
    let wanted = number(&thickened(&plain, &solid, &["--thickness", "2"])["volume"]);
    near(volume(&read(&solid)), wanted, 1e-9);
    // Metres are told by the size, and it is said.
    let metres = folder.write("tee-m.obj", tee(400.0, 2, 1e-3));
    let words = ["thicken", word(&metres), "--thickness", "2", "-o", word(&solid), "--json"];
    let told = toile(&words).succeeded();
    assert!(told.stderr.contains("metres"), "{}", told.stderr);
    let report = told.json();
    near(number(&report["volume"]), wanted, 1e-9);
    assert_eq!(number(&report["sheet"]["unit_mm"]), 1000.0);
    is_closed(&read(&solid));
    near(volume(&read(&solid)), wanted * 1e-9, 1e-9);
    // Said, nothing is guessed.
    let centimetres = folder.write("tee-cm.obj", tee(400.0, 2, 0.1));
    let report = thickened(&centimetres, &solid, &["--thickness", "2", "--unit", "cm"]);
    near(number(&report["volume"]), wanted, 1e-9);
    assert_eq!(report["warnings"].as_array().unwrap().len(), 0);
    near(volume(&read(&solid)), wanted * 1e-3, 1e-9);
}

#[test]
fn formats_without_groups_are_one_patch_and_corners_at_one_place_are_one_node() {
    let folder = Folder::new("thicken-ungrouped");
    let tee = folder.write("tee.obj", tee(40.0, 2, 1.0));
    let mesh = read(&tee);
    for (name, format) in [
        ("tee.stl", mesh_kernel::files::Format::Stl),
        ("tee.ply", mesh_kernel::files::Format::Ply),
        ("tee.off", mesh_kernel::files::Format::Off),
        ("tee.glb", mesh_kernel::files::Format::Glb),
    ] {
        let bytes = mesh_kernel::files::to_bytes(format, &mesh, &Default::default());
        let sheet = folder.write(name, bytes);
        let solid = folder.join("solid.obj");
        let report = thickened(&sheet, &solid, &["--thickness", "2"]);
        near(number(&report["volume"]), tee_volume(40.0, 1.0), 1e-6);
        let patches = if name == "tee.glb" { 3 } else { 1 };
        assert_eq!(report["sheet"]["patches"], patches, "{name}");
        is_closed(&read(&solid));
    }
}

#[test]
fn threads_change_no_byte() {
    let folder = Folder::new("thicken-threads");
    let sheet = folder.write("sheets.obj", three_sheets(6));
    for format in ["obj", "stl", "glb"] {
        let run = |threads: &str| {
            let solid = folder.join(&format!("{threads}.{format}"));
            let mut report = thickened(&sheet, &solid, &["--thickness", "3", "--threads", threads]);
            for timed in ["seconds", "step_seconds", "file"] {
                report.as_object_mut().unwrap().remove(timed);
            }
            (std::fs::read(solid).unwrap(), report)
        };
        assert!(run("1") == run("2"), "{format}");
    }
}

#[test]
fn a_table_for_people() {
    let folder = Folder::new("thicken-table");
    let sheet = folder.write("tee.obj", tee(40.0, 2, 1.0));
    let words = ["thicken", word(&sheet), "--thickness", "2", "-o", word(&folder.join("solid.stl"))]
        .map(str::to_owned);
    let text = toile(&words).succeeded().stdout;
    for said in ["3 patches", "closed", "yes", "volume", "walls [mm]"] {
        assert!(text.contains(said), "{said}: {text}");
    }
    assert!(toile(&[&words[..], &["--quiet".to_owned()]].concat()).succeeded().stdout.is_empty());
}

#[test]
fn what_has_no_area_is_refused() {
    let folder = Folder::new("thicken-empty");
    let line = folder.write("line.obj", "v 0 0 0\nv 10 0 0\nv 20 0 0\nf 1 2 3\n");
    let out = folder.join("solid.obj");
    toile(&["thicken", word(&line), "--thickness", "1", "-o", word(&out)]).refused(1, "line.obj");
    assert_eq!(folder.list(), ["line.obj"]);
}

/// A tray of two plates, `far` millimetres from the origin along x and y.
fn far_tray(far: f64) -> String {
    let text = plates(&[("floor", [1.0, 0.0]), ("wall", [0.0, 1.0])], 60.0, 2, 1.0);
    let moved = |line: &str| match line.strip_prefix("v ") {
        Some(numbers) => {
            let p: Vec<f64> = numbers.split(' ').map(|n| n.parse().unwrap()).collect();
            format!("v {} {} {}\n", p[0] + far, p[1] + far, p[2])
        }
        None => format!("{line}\n"),
    };
    text.lines().map(moved).collect()
}

#[test]
fn what_is_reported_is_what_the_file_holds_far_from_the_origin() {
    let folder = Folder::new("thicken-far");
    let wanted = number(
        &thickened(
            &folder.write("near.obj", far_tray(0.0)),
            &folder.join("near-solid.obj"),
            &["--thickness", "2"],
        )["volume"],
    );
    // A step of single precision is 1/32 mm at 300 m, 1/16 mm at 1 km.
    for (far, format) in [(3e5, "stl"), (1e6, "stl"), (1e6, "glb"), (1e8, "obj")] {
        let sheet = folder.write("far.obj", far_tray(far));
        let solid = folder.join(&format!("solid.{format}"));
        let report = thickened(&sheet, &solid, &["--thickness", "2"]);
        let mesh = read(&solid);
        is_closed(&mesh);
        assert_eq!((&report["closed"], &report["components"]), (&true.into(), &1.into()));
        let unit = if format == "glb" { 1e-3f64 } else { 1.0 };
        let origin = mesh.positions[0];
        let near_by = TriMesh::new(mesh.positions.iter().map(|p| *p - origin).collect(), mesh.faces.clone());
        near(number(&report["volume"]), volume(&near_by) / unit.powi(3), 1e-6);
        near(number(&report["volume"]), wanted, 0.03);
        near(number(&report["min_wall"]), 2.0, 0.04);
    }
}

#[test]
fn walls_that_the_file_cannot_hold_are_refused_and_nothing_is_written() {
    let folder = Folder::new("thicken-lost");
    let cases = [
        (1e8, "2", "stl", "nearer to the origin, or write OBJ"),
        (1e8, "2", "glb", "nearer to the origin, or write OBJ"),
        (0.0, "1e-5", "stl", "thicken more"),
        (0.0, "1e-8", "obj", "thicken more"),
        (0.0, "1e-7", "obj", "thicken more"),
    ];
    for (far, thickness, format, said) in cases {
        let sheet = folder.write("sheet.obj", far_tray(far));
        let solid = folder.write(&format!("kept.{format}"), "what was there");
        let words = ["thicken", word(&sheet), "--thickness", thickness, "-o", word(&solid)];
        let told = toile(&words).refused(1, "sheet.obj");
        assert!(told.stderr.contains(said), "{far} {thickness}: {}", told.stderr);
        assert_eq!(std::fs::read_to_string(&solid).unwrap(), "what was there");
    }
    // One thin patch of several is not left out either.
    let sheet = folder.write("sheet.obj", far_tray(0.0));
    let words = ["--thickness", "2", "--patch-thickness", "floor=1e-5", "-o", word(&folder.join("s.stl"))]
        .map(str::to_owned);
    let words = [&["thicken".to_owned(), word(&sheet).to_owned()], &words[..]].concat();
    toile(&words).refused(1, "sheet.obj");
}

#[test]
fn a_garment_becomes_a_solid_from_its_file_and_from_its_native_body() {
    let folder = Folder::new("thicken-garment");
    let out = folder.join("out");
    toile(&[
        "regenerate",
        word(dress()),
        "--body",
        word(&root().join("samples/form-12.obj")),
        "--out",
        word(&out),
        "--formats",
        "obj,body",
        "--levels",
        "2",
    ])
    .succeeded();
    let solid = folder.join("dress.stl");
    let report = thickened(&out.join("garment.obj"), &solid, &["--thickness", "2"]);
    assert_eq!((&report["closed"], &report["self_intersections"]), (&true.into(), &0.into()));
    let mesh = read(&solid);
    is_closed(&mesh);
    // Thin cloth: its volume is nearly area times thickness.
    let info = toile(&["info", word(&out.join("garment.body.json")), "--json"]).succeeded().json();
    near(number(&report["volume"]), 2.0 * number(&info["area"]), 0.05);
    let native = thickened(&out.join("garment.body.json"), &folder.join("native.obj"), &["--thickness", "2"]);
    near(number(&native["volume"]), number(&report["volume"]), 1e-4);
    assert_eq!(number(&native["sheet"]["unit_mm"]), 1.0);
    assert!(toile(&["info", word(&solid), "--json"]).succeeded().json()["closed"].as_bool().unwrap());
}
