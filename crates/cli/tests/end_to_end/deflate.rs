//! `deflate`: solids to sheets, in every format, with what analysts and other commands read.

use std::path::{Path, PathBuf};

use mesh_kernel::TriMesh;
use serde_json::Value;

use crate::call::{Folder, has_keys, number, toile, word};
use crate::fixtures::read;

const KEYS: [&str; 11] = [
    "removed_features",
    "pairs",
    "unpaired_faces",
    "patches",
    "joints",
    "free_loops",
    "components",
    "area",
    "thickness",
    "warnings",
    "seconds",
];

/// A T drawn along z, `length` long, in millimetres times `scale`: a bar of 60 and a stem of 25, all 2 thick.
fn tee(length: f64, scale: f64) -> String {
    let profile = [[-30, -1], [30, -1], [30, 1], [1, 1], [1, 25], [-1, 25], [-1, 1], [-30, 1]]
        .map(|p| p.map(f64::from));
    let mut text = String::new();
    for z in [0.0, length] {
        for [x, y] in profile {
            text.push_str(&format!("v {} {} {}\n", x * scale, y * scale, z * scale));
        }
    }
    for i in 0..8 {
        let (a, b) = (i + 1, (i + 1) % 8 + 1);
        text.push_str(&format!("f {a} {b} {} {}\n", b + 8, a + 8));
    }
    for [a, b, c, d] in [[1, 2, 3, 4], [1, 4, 7, 8], [4, 5, 6, 7]] {
        text.push_str(&format!("f {a} {d} {c} {b}\nf {} {} {} {}\n", a + 8, b + 8, c + 8, d + 8));
    }
    text
}

fn deflated(solid: &Path, sheet: &Path, more: &[&str]) -> Value {
    let words = ["deflate", word(solid), "-o", word(sheet), "--json"];
    toile(&[&words[..], more].concat()).succeeded().json()
}

#[track_caller]
fn near(value: f64, wanted: f64, relative: f64) {
    assert!((value - wanted).abs() <= relative * wanted.abs(), "{value} is not {wanted}");
}

fn thicknesses(sheet: &Path) -> Vec<f64> {
    let text = std::fs::read_to_string(sheet.with_extension("thickness.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

fn area(mesh: &TriMesh) -> f64 {
    (0..mesh.faces.len() as u32).map(|f| mesh.area_normal(f).length()).sum::<f64>() / 2.0
}

#[test]
fn a_tee_becomes_three_patches_that_share_a_line() {
    let folder = Folder::new("deflate-tee");
    let solid = folder.write("tee.obj", tee(40.0, 1.0));
    for format in ["obj", "ply", "stl", "off", "glb"] {
        let sheet = folder.join(&format!("sheet.{format}"));
        let report = deflated(&solid, &sheet, &[]);
        has_keys(&report, &KEYS);
        has_keys(&report["thickness"], &["min", "max", "mean"]);
        let counts = ["patches", "joints", "free_loops", "components", "unpaired_faces"];
        assert_eq!(counts.map(|k| report[k].as_u64().unwrap()), [3, 1, 2, 1, 0]);
        near(number(&report["area"]), 40.0 * 85.0, 1e-9);
        let mesh = read(&sheet);
        let metres = if format == "glb" { 1e-3f64 } else { 1.0 };
        near(area(&mesh), 40.0 * 85.0 * metres.powi(2), 1e-6);
        let list = thicknesses(&sheet);
        assert_eq!(list.len(), mesh.faces.len());
        list.iter().for_each(|t| near(*t, 2.0, 1e-9));
    }
    let mesh = read(&folder.join("sheet.obj"));
    assert_eq!(mesh.groups.len(), 3);
    let info = toile(&["info", word(&folder.join("sheet.obj")), "--json"]).succeeded().json();
    assert_eq!(
        (&info["surfaces"], &info["joints"], &info["identity_holds"]),
        (&3.into(), &1.into(), &true.into())
    );
}

#[test]
fn what_deflate_writes_thicken_reads() {
    let folder = Folder::new("deflate-thicken");
    let solid = folder.write("tee.obj", tee(40.0, 1.0));
    let sheet = folder.join("sheet.obj");
    deflated(&solid, &sheet, &[]);
    let again = folder.join("again.obj");
    let list = sheet.with_extension("thickness.json");
    let words =
        ["thicken", word(&sheet), "--thickness-file", word(&list), "--corners", "mitre", "-o", word(&again)];
    let report = toile(&[&words[..], &["--json"]].concat()).succeeded().json();
    near(number(&report["volume"]), 40.0 * (2.0 * 60.0 + 2.0 * 24.0), 1e-9);
}

#[test]
fn shell_models_vtk_and_pictures_are_written_beside_it() {
    let folder = Folder::new("deflate-beside");
    let solid = folder.write("tee.obj", tee(40.0, 1.0));
    let beside = |name: &str| folder.join(name);
    let [inp, vtk, png]: [PathBuf; 3] = ["a.inp", "a.vtk", "a.png"].map(beside);
    let all = ["--inp", word(&inp), "--vtk", word(&vtk), "--picture", word(&png), "--edge-length", "4"];
    let report = deflated(&solid, &folder.join("sheet.obj"), &all);
    let faces = report["faces"].as_u64().unwrap() as usize;
    assert!(faces > 400);
    let text = std::fs::read_to_string(&inp).unwrap();
    for word in ["*NODE, NSET=NALL", "TYPE=S6", "ELSET=PATCH_3", "*SHELL SECTION", "*MATERIAL"] {
        assert!(text.contains(word), "{word}");
    }
    let elements = text.lines().skip_while(|l| !l.starts_with("*ELEMENT")).skip(1);
    assert_eq!(elements.take_while(|l| !l.starts_with('*')).count(), faces);
    let text = std::fs::read_to_string(&vtk).unwrap();
    assert!(text.contains(&format!("CELL_DATA {faces}\nSCALARS thickness double 1\n")));
    assert_eq!(&std::fs::read(&png).unwrap()[1..4], b"PNG");
    let nodal = ["--inp", word(&inp), "--elements", "s3", "--sections", "nodal"];
    deflated(&solid, &folder.join("sheet.obj"), &nodal);
    let text = std::fs::read_to_string(&inp).unwrap();
    assert!(text.contains("TYPE=S3") && text.contains("*NODAL THICKNESS"));
}

#[test]
fn the_unit_is_kept_and_thicknesses_are_millimetres() {
    let folder = Folder::new("deflate-unit");
    let solid = folder.write("tee.obj", tee(40.0, 0.001));
    let sheet = folder.join("sheet.obj");
    let report = deflated(&solid, &sheet, &["--unit", "m"]);
    near(number(&report["area"]), 40.0 * 85.0, 1e-9);
    near(area(&read(&sheet)), 40.0 * 85.0 * 1e-6, 1e-9);
    thicknesses(&sheet).iter().for_each(|t| near(*t, 2.0, 1e-9));
}

#[test]
fn what_cannot_be_deflated_is_refused_and_leaves_nothing() {
    let folder = Folder::new("deflate-refused");
    let out = folder.join("sheet.obj");
    let refused = |name: &str, text: String, about: &str| {
        let solid = folder.write(name, text);
        let told = toile(&["deflate", word(&solid), "-o", word(&out)]).refused(1, about);
        assert!(told.stderr.contains(name), "{}", told.stderr);
        assert!(!out.exists() && !out.with_extension("thickness.json").exists());
        told.stderr
    };
    let cube = "v 0 0 0\nv 50 0 0\nv 50 50 0\nv 0 50 0\nv 0 0 50\nv 50 0 50\nv 50 50 50\nv 0 50 50\n\
        f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let told = refused("cube.obj", cube.to_owned(), "not thin");
    assert!(told.contains("the plane face of 2500.0 mm²") && told.contains("--max-thickness"), "{told}");
    let open: String =
        tee(40.0, 1.0).lines().filter(|l| *l != "f 1 2 10 9").map(|l| format!("{l}\n")).collect();
    refused("open.obj", open, "open");
    let bar = "v -5 -9 10\nv 5 -9 10\nv 5 9 10\nv -5 9 10\nv -5 -9 12\nv 5 -9 12\nv 5 9 12\nv -5 9 12\n\
        f -5 -6 -7 -8\nf -4 -3 -2 -1\nf -8 -7 -3 -4\nf -7 -6 -2 -3\nf -6 -5 -1 -2\nf -5 -8 -4 -1\n";
    refused("crossing.obj", tee(40.0, 1.0) + bar, "crosses itself");
    let solid = folder.write("tee.obj", tee(40.0, 1.0));
    for (more, about) in [
        (["--max-thickness", "0"], "larger than 0"),
        (["--max-draft", "60"], "degrees"),
        (["--inp", "a.txt"], ".inp"),
        (["--steps", "sideways"], "sideways"),
    ] {
        let words = ["deflate", word(&solid), "-o", word(&out)];
        toile(&[&words[..], &more].concat()).refused(2, about);
    }
    assert!(!out.exists());
}

/// Parts and what their middles are: area, patches, joints, free loops, from their truths; plane ones.
#[test]
fn shared_solids_have_their_true_middles() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/solids");
    if !folder.is_dir() {
        let required = std::env::var("TOILE_REQUIRE_SHARED").is_ok_and(|v| v == "1");
        assert!(!required, "{} is missing, and TOILE_REQUIRE_SHARED is set", folder.display());
        return;
    }
    let out = Folder::new("deflate-shared");
    let mut parts: Vec<PathBuf> = std::fs::read_dir(&folder).unwrap().map(|e| e.unwrap().path()).collect();
    parts.sort();
    for truth in parts.iter().filter(|p| p.extension().is_some_and(|e| e == "json")) {
        let name = truth.file_stem().unwrap().to_string_lossy().into_owned();
        let truth: Value = serde_json::from_str(&std::fs::read_to_string(truth).unwrap()).unwrap();
        let is_of = |p: &Path| {
            let stem = p.file_stem().unwrap().to_string_lossy().into_owned();
            let stem = stem.trim_end_matches("-coarse").trim_end_matches("-fine");
            stem == name && p.extension().is_some_and(|e| e == "obj" || e == "stl")
        };
        for solid in parts.iter().filter(|p| is_of(p)) {
            let report = deflated(solid, &out.join("sheet.obj"), &[]);
            let told = format!("{}: {report}", solid.display());
            assert_eq!(report["components"], 1, "{told}");
            let wanted = &truth["mid_surface"];
            let curved =
                ["cover", "hemisphere", "mouse", "rounded-box", "tube", "panel-rib"].contains(&name.as_str());
            // The strip that joins a step is part of the sheet and not of the truth.
            let stepped = name == "stepped-flush";
            let tolerance = if stepped {
                0.011
            } else if curved {
                0.05
            } else {
                1e-6
            };
            near(number(&report["area"]), number(&truth["mid_area_mm2"]), tolerance);
            if name != "cover" {
                assert_eq!(report["free_loops"], wanted["boundary_loops"], "{told}");
                let patches = wanted["smooth_faces"].as_u64().unwrap() + u64::from(stepped);
                assert_eq!(report["patches"], patches, "{told}");
            }
        }
    }
}

#[test]
fn numbers_that_cannot_be_met_are_refused() {
    let folder = Folder::new("deflate-numbers");
    let solid = folder.write("tee.obj", tee(40.0, 1.0));
    let sheet = folder.join("sheet.obj");
    let call = |more: &[&str]| {
        let words = ["deflate", word(&solid), "-o", word(&sheet)];
        toile(&[&words[..], more].concat())
    };
    // What belongs together is written together.
    let inp = folder.join("taken.inp");
    std::fs::create_dir(&inp).unwrap();
    call(&["--inp", word(&inp)]).refused(1, "taken.inp");
    call(&["--keep", "0"]).refused(2, "--keep");
    call(&["--keep", "99"]).refused(1, "no feature 99");
    for length in ["0.01", "1e-6"] {
        call(&["--edge-length", length]).refused(1, "mm or more");
    }
    assert_eq!(folder.list(), ["taken.inp/", "tee.obj"]);
}
