//! `check`, `info`, `flatten` and `render` on models made here.

use std::path::Path;

use crate::call::{Folder, has_keys, number, toile, word};
use crate::fixtures::{dress, form, read, three_sheets};

const INFO_KEYS: [&str; 14] = [
    "surfaces",
    "joints",
    "nodes",
    "edges",
    "faces",
    "rings",
    "components",
    "cycles",
    "voids",
    "identity_holds",
    "boundary_loops",
    "closed",
    "area",
    "volume",
];

#[test]
fn three_sheets_that_share_a_line() {
    let folder = Folder::new("sheets");
    let model = folder.write("sheets.obj", three_sheets(4));
    let info = toile(&["info", word(&model), "--json"]).succeeded().json();
    has_keys(&info, &INFO_KEYS);
    assert_eq!(info["surfaces"], 3);
    assert_eq!(info["joints"], 1);
    // 5 nodes on the line and 4 x 5 on each sheet; 32 triangles a sheet; edges: 3 (16 + 12 + 16 + ...) by Euler.
    assert_eq!(info["nodes"], 5 + 3 * 20);
    assert_eq!(info["faces"], 3 * 32);
    assert_eq!(info["edges"], 5 + 60 + 96 - 1);
    assert_eq!((info["components"].clone(), info["identity_holds"].clone()), (1.into(), true.into()));
    assert_eq!(info["closed"], false);
    assert!((number(&info["area"]) - 3.0 * 1600.0).abs() < 1e-3, "{}", info["area"]);

    let check = toile(&["check", word(&model), "--json"]).succeeded().json();
    has_keys(&check, &["ok", "defects"]);
    assert_eq!(check["ok"], true);
    // The table for people names the same numbers.
    let text = toile(&["info", word(&model)]).succeeded().stdout;
    assert!(text.contains("65") && text.contains("96"), "{text}");
    assert!(toile(&["info", word(&model), "--quiet"]).succeeded().stdout.is_empty());
}

#[test]
fn a_form_is_sound() {
    let info = toile(&["info", word(form()), "--json"]).succeeded().json();
    assert_eq!(info["identity_holds"], true);
    assert_eq!(info["closed"], true);
    assert_eq!(info["boundary_loops"], 0);
    assert!(number(&info["volume"]) > 0.0);
    let check = toile(&["check", word(form()), "--json"]).succeeded().json();
    assert_eq!(check["ok"], true, "{check}");
}

#[test]
fn flat_pieces_of_flat_sheets_are_the_sheets() {
    let folder = Folder::new("flatten");
    let model = folder.write("sheets.obj", three_sheets(4));
    for kind in ["svg", "dxf", "pdf", "obj"] {
        let file = folder.join(&format!("flat.{kind}"));
        let report = toile(&["flatten", word(&model), "-o", word(&file), "--json"]).succeeded().json();
        let pieces = report["pieces"].as_array().unwrap();
        assert_eq!(pieces.len(), 3);
        for piece in pieces {
            assert!((number(&piece["area_2d"]) - 1600.0).abs() < 0.01, "{piece}");
            assert_eq!((piece["flipped"].clone(), piece["overlaps"].clone()), (0.into(), 0.into()));
            assert!(number(&piece["max_stretch"]).abs() < 1e-4, "{piece}");
        }
        assert!(std::fs::metadata(&file).unwrap().len() > 200);
    }
    let flat = read(&folder.join("flat.obj"));
    assert_eq!(flat.faces.len(), 96);
    assert!(flat.positions.iter().all(|p| p.z.abs() < 1e-6));
}

#[test]
fn units_and_cuts_of_flatten() {
    let folder = Folder::new("flatten-units");
    let model = folder.write("sheets.obj", three_sheets(2));
    let area = |unit: &str| {
        let file = folder.join("flat.svg");
        let report =
            toile(&["flatten", word(&model), "-o", word(&file), "--unit", unit, "--json"]).succeeded().json();
        number(&report["pieces"][0]["area_2d"])
    };
    let mm = area("mm");
    assert!((area("cm") / mm - 100.0).abs() < 0.01);
    assert!((area("inch") / mm - 645.16).abs() < 0.1);
    // A form has no flat shape in one piece; what is refused is said, not guessed.
    let closed = toile(&["flatten", word(form()), "-o", word(&folder.join("form.svg"))]);
    closed.refused(1, "form");
    assert!(!folder.join("form.svg").exists());
    // Nodes that are not there cannot be cut along.
    toile(&["flatten", word(&model), "-o", word(&folder.join("x.svg")), "--cut", "1-999999"])
        .refused(1, "cut");
    assert!(!folder.join("x.svg").exists());
}

#[test]
fn flatten_takes_the_units_that_other_commands_take() {
    let folder = Folder::new("flatten-defaults");
    let model = folder.write("sheets.obj", three_sheets(2));
    let flat = folder.join("flat.svg");
    let area = |mesh: &Path, more: &[&str]| {
        let words = ["flatten", word(mesh), "-o", word(&flat), "--json"];
        let said = toile(&[&words[..], more].concat()).succeeded();
        let report = said.json();
        let drawn = std::fs::read_to_string(&flat).unwrap();
        assert!(!drawn.contains("inf") && !drawn.contains("NaN"), "{drawn}");
        (number(&report["pieces"][0]["area_2d"]), said.stderr.contains("metres"))
    };
    assert_eq!(area(&model, &[]), (area(&model, &["--unit", "mm"]).0, false));
    // GLB is in metres by its standard.
    let [metres, millimetres] = ["solid.glb", "solid.obj"].map(|name| {
        let solid = folder.join(name);
        toile(&["thicken", word(&model), "--thickness", "1", "-o", word(&solid)]).succeeded();
        area(&solid, &[]).0
    });
    assert!((metres / millimetres - 1.0).abs() < 1e-3, "{metres} {millimetres}");
    let sheet = |name: &str, size: f64| {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let nodes: String =
            corners.iter().map(|c| format!("v {} {} 0\n", c[0] * size, c[1] * size)).collect();
        folder.write(name, nodes + "f 1 2 3 4\n")
    };
    // No piece is a millimetre large: that is a garment in metres, and said so.
    let (large, guessed) = area(&sheet("garment.obj", 1.0), &[]);
    assert!((large - 1e6).abs() < 1e-3 && guessed);
    let flat_mesh = folder.join("flat.obj");
    toile(&["flatten", word(&sheet("unit.obj", 1.0)), "-o", word(&flat_mesh)]).succeeded();
    let info = toile(&["info", word(&flat_mesh), "--json"]).succeeded().json();
    assert!((number(&info["area"]) - 1.0).abs() < 1e-9, "a mesh keeps its numbers: {info}");
    let (tiny, guessed) = area(&sheet("tiny.obj", 1.0), &["--unit", "mm"]);
    assert!((tiny - 1.0).abs() < 1e-9 && !guessed);
    area(&sheet("tiny.obj", 1.0), &["--unit", "mm", "--allowance", "0.1"]);
}

#[test]
fn flatten_refuses_in_the_user_s_words() {
    let folder = Folder::new("flatten-words");
    let model = folder.write("sheets.obj", three_sheets(4));
    let flat = folder.join("flat.svg");
    let words = ["flatten", word(&model), "-o", word(&flat)];
    // Nodes are counted from 1, as in the file and in the call.
    toile(&[&words[..], &["--cut", "5-60"]].concat()).refused(1, "nodes 5 and 60");
    toile(&[&words[..], &["--allowance", "1e9"]].concat()).refused(1, "10000");
    assert!(!flat.exists());
}

#[test]
fn pictures_have_the_asked_size_and_differ_by_view() {
    let folder = Folder::new("render");
    let model = folder.write("sheets.obj", three_sheets(4));
    let mut pictures = Vec::new();
    for view in ["front", "back", "left", "right", "top", "iso"] {
        let file = folder.join(&format!("{view}.png"));
        let words = ["render", word(form()), "-o", word(&file), "--view", view, "--size", "120x160"];
        toile(&words).succeeded();
        let bytes = std::fs::read(&file).unwrap();
        assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
        assert_eq!(&bytes[16..24], [0, 0, 0, 120, 0, 0, 0, 160]);
        pictures.push(bytes);
    }
    for i in 0..pictures.len() {
        assert!(pictures.iter().skip(i + 1).all(|p| *p != pictures[i]), "views differ");
    }
    let both = folder.join("both.png");
    toile(&["render", word(&model), "--with", word(form()), "-o", word(&both), "--size", "64x64"])
        .succeeded();
    // Thickness needs the file beside the sheet.
    let thick = folder.join("thick.png");
    toile(&["render", word(&model), "-o", word(&thick), "--color", "thickness"]).refused(1, "thickness");
    folder.write("sheets.thickness.json", serde_json::to_string(&vec![2.0; 96]).unwrap());
    toile(&["render", word(&model), "-o", word(&thick), "--color", "thickness", "--size", "64x64"])
        .succeeded();
    folder.write("sheets.thickness.json", "[1, 2]");
    toile(&["render", word(&model), "-o", word(&thick), "--color", "thickness", "--size", "64x64"])
        .refused(1, "");
}

#[test]
fn a_native_body_says_the_same_as_its_mesh_and_damage_is_named() {
    let folder = Folder::new("native-body");
    let out = folder.join("out");
    toile(&[
        "regenerate",
        word(dress()),
        "--body",
        word(form()),
        "--out",
        word(&out),
        "--formats",
        "obj,body",
        "--levels",
        "2",
    ])
    .succeeded();
    let [native, mesh] = ["garment.body.json", "garment.obj"].map(|name| out.join(name));
    let info = |path: &Path| toile(&["info", word(path), "--json"]).succeeded().json();
    let (a, b) = (info(&native), info(&mesh));
    for key in
        ["surfaces", "joints", "nodes", "edges", "faces", "components", "cycles", "voids", "boundary_loops"]
    {
        assert_eq!(a[key], b[key], "{key}");
    }
    assert_eq!(toile(&["check", word(&native), "--json"]).succeeded().json()["ok"], true);

    let text = std::fs::read_to_string(&native).unwrap();
    for (damaged, named) in [
        (text[..text.len() / 2].to_owned(), "cut off"),
        (text.replacen("\"version\":1", "\"version\":7", 1), "version 7"),
        (text.replacen("toile-body", "other", 1), "other"),
    ] {
        let path = folder.write("damaged.body.json", damaged);
        toile(&["check", word(&path)]).refused(1, named);
    }
}
