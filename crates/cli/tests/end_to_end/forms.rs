//! `form` and `features`: forms measure what was asked and carry both garments.

use serde_json::Value;

use crate::call::{Folder, has_keys, number, toile, word};
use crate::fixtures::{form, read, templates};
use crate::regenerate::{asymmetry, broken_promises};

const POINTS: [&str; 10] = [
    "left_armpit",
    "right_armpit",
    "crotch",
    "left_shoulder",
    "right_shoulder",
    "nape",
    "front_neck",
    "left_bust",
    "right_bust",
    "navel",
];
const CURVES: [&str; 20] = [
    "neck",
    "neck_base",
    "bust",
    "underbust",
    "waist",
    "hip",
    "centre_front",
    "centre_back",
    "left_side",
    "right_side",
    "left_princess_front",
    "right_princess_front",
    "left_princess_back",
    "right_princess_back",
    "left_armhole",
    "right_armhole",
    "left_upper_arm",
    "right_upper_arm",
    "left_thigh",
    "right_thigh",
];

/// Checks the keys of a features report. Forms have neither arms nor legs: `limbs` says whether those are asked for.
#[track_caller]
pub(crate) fn features_are_complete(features: &Value, limbs: bool) {
    has_keys(features, &["units", "height", "facing", "points", "curves", "warnings"]);
    assert_eq!(features["units"], "mm");
    assert_eq!(features["facing"].as_array().unwrap().len(), 3);
    let armless = |name: &str| name.contains("upper_arm") || name.contains("thigh");
    for name in POINTS {
        assert_eq!(features["points"][name].as_array().map(Vec::len), Some(3), "point {name}");
    }
    for name in CURVES.into_iter().filter(|name| limbs || !armless(name)) {
        let curve = &features["curves"][name];
        has_keys(curve, &["closed", "length", "polyline"]);
        let polyline = curve["polyline"].as_array().unwrap();
        assert!(polyline.len() >= 2, "curve {name}");
        assert!(
            polyline
                .iter()
                .all(|p| p.as_array().is_some_and(|p| p.len() == 3 && p.iter().all(Value::is_number)))
        );
        if curve["closed"] == true {
            has_keys(curve, &["girth"]);
            let (length, girth) = (number(&curve["length"]), number(&curve["girth"]));
            assert!(
                girth > 0.0 && girth <= length * 1.001 + 0.1,
                "curve {name}: tape {girth}, along the skin {length}"
            );
        }
    }
}

#[test]
fn features_of_a_form_have_all_names() {
    let folder = Folder::new("features");
    let (json, picture) = (folder.join("features.json"), folder.join("features.png"));
    let words = ["features", word(form()), "-o", word(&json), "--picture", word(&picture), "--json"];
    let said = toile(&words).succeeded().json();
    let written: Value = serde_json::from_slice(&std::fs::read(&json).unwrap()).unwrap();
    assert_eq!(said, written);
    features_are_complete(&said, false);
    assert_eq!(&std::fs::read(&picture).unwrap()[1..4], b"PNG");
    for (curve, asked) in [("bust", 974.0), ("waist", 803.0), ("hip", 1041.0)] {
        let girth = number(&said["curves"][curve]["girth"]);
        assert!((girth - asked).abs() < 9.0, "{curve}: {girth} for {asked}");
    }
}

#[test]
fn every_format_and_unit_gives_the_same_features() {
    // A form in another format, in metres, z up and turned about: the girths stay.
    let folder = Folder::new("formats-of-forms");
    let girth = |path: &std::path::Path| {
        let features = toile(&["features", word(path), "--json"]).succeeded().json();
        ["bust", "waist", "hip"].map(|name| number(&features["curves"][name]["girth"]))
    };
    let asked = girth(form());
    let mesh = read(form());
    let mut text = String::new();
    for p in &mesh.positions {
        // Turned by 30 degrees about the vertical, metres, z up.
        let (sin, cos) = 30f64.to_radians().sin_cos();
        let (x, z) = (p.x * cos + p.z * sin, -p.x * sin + p.z * cos);
        text.push_str(&format!("v {:.6} {:.6} {:.6}\n", x / 1000.0 + 3.0, -z / 1000.0, p.y / 1000.0));
    }
    for f in &mesh.faces {
        text.push_str(&format!("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1));
    }
    let turned = girth(&folder.write("turned.obj", text));
    for (a, b) in asked.iter().zip(turned) {
        assert!((a - b).abs() < 3.0, "{asked:?} {turned:?}");
    }
    for format in ["ply", "stl", "off", "glb"] {
        let path = folder.join(&format!("form.{format}"));
        let words =
            ["form", "--bust", "97.4", "--waist", "80.3", "--hip", "104.1", "--height", "166.2", "-o"];
        toile(&[&words[..], &[word(&path)]].concat()).succeeded();
        for (a, b) in asked.iter().zip(girth(&path)) {
            assert!((a - b).abs() < 3.0, "{format}: {asked:?}");
        }
    }
}

#[test]
fn impossible_measurements_are_refused_with_the_reason() {
    let folder = Folder::new("impossible-forms");
    let path = folder.join("form.obj");
    let cases: [(&[&str], &str); 8] = [
        (&["--bust", "150", "--waist", "20"], "waist"),
        (&["--bust=-5"], "bust"),
        (&["--bust", "0"], "bust"),
        (&["--bust", "nan"], "bust"),
        (&["--bust", "100000"], "bust"),
        (&["--height", "3"], "height"),
        (&["--preset", "no-such-size"], "no-such-size"),
        (&["--measurements", "nowhere.json"], "nowhere.json"),
    ];
    for (words, about) in cases {
        let told = toile(&[&["form"], words, &["-o", word(&path)]].concat());
        assert!(told.code == Some(1) || told.code == Some(2), "{words:?}: {told:?}");
        assert!(
            told.stderr.starts_with("error:") && told.stderr.contains(about),
            "{words:?}: {}",
            told.stderr
        );
    }
    for (name, text) in [
        ("words.json", "{\"bust\": \"wide\"}"),
        ("unknown.json", "{\"bosom\": 90}"),
        ("cut.json", "{\"bust\""),
        ("list.json", "[\"woman\", 168, 92]"),
        ("empty-list.json", "[]"),
    ] {
        let file = folder.write(name, text);
        toile(&["form", "--measurements", word(&file), "-o", word(&path)]).refused(1, name);
    }
    assert!(!path.exists());
}

#[test]
fn a_form_that_cannot_be_written_leaves_the_old_features() {
    let folder = Folder::new("form-taken");
    let path = folder.join("form.obj");
    std::fs::create_dir(&path).unwrap();
    let features = folder.write("form.features.json", "old");
    toile(&["form", "-o", word(&path)]).refused(1, "form.obj");
    assert_eq!(std::fs::read(&features).unwrap(), b"old");
    assert_eq!(folder.list(), ["form.features.json", "form.obj/"]);
}

#[test]
fn the_table_compares_a_measurement_with_the_same_girth() {
    let folder = Folder::new("form-table");
    let path = folder.join("form.obj");
    let words = ["form", "--bust", "98.4", "--waist", "81.9", "--hip", "105.4", "--height", "168"];
    let said = toile(&[&words[..], &["-o", word(&path)]].concat()).succeeded().stdout;
    let row = |name: &str| -> Vec<f64> {
        let line = said.lines().find(|l| l.trim_start().starts_with(name)).unwrap();
        line.split_whitespace().skip(1).map(|x| x.parse().unwrap()).collect()
    };
    // The neck is measured at its base.
    for name in ["bust", "waist", "hip", "neck"] {
        let [form, found] = row(name)[..] else { panic!("{name}: {said}") };
        assert!((form - found).abs() < 1.5, "{name}: {form} and {found}");
    }
}

#[test]
fn both_garments_fit_forms_of_all_sizes() {
    let presets = toile(&["form", "--list-presets", "--json"]).succeeded().json();
    let names: Vec<String> =
        presets.as_array().unwrap().iter().map(|p| p["name"].as_str().unwrap().to_owned()).collect();
    let sizes: Vec<&String> = names.iter().filter(|n| n.starts_with("astm-")).collect();
    assert!(sizes.len() >= 5, "sizes 2 to 20 among {names:?}");
    let folder = Folder::new("sizes");
    let bodies = folder.join("bodies");
    for size in sizes {
        let path = bodies.join(format!("{size}.obj"));
        toile(&["form", "--preset", size, "-o", word(&path)]).succeeded();
    }
    let mut broken = Vec::new();
    for template in templates() {
        let out = folder.join(&template.file_stem().unwrap().to_string_lossy());
        let words = [
            "batch",
            word(&template),
            "--bodies",
            word(&bodies),
            "--out",
            word(&out),
            "--formats",
            "obj",
            "--json",
        ];
        let batch = toile(&words);
        for body in batch.json()["bodies"].as_array().unwrap() {
            let name = body["name"].as_str().unwrap();
            let at = format!("{} on {name}", template.file_stem().unwrap().to_string_lossy());
            if body["state"] != "built" {
                broken.push(format!("{at}: {}", body["error"]));
                continue;
            }
            let report = std::fs::read(out.join(name).join("report.json")).unwrap();
            let report: Value = serde_json::from_slice(&report).unwrap();
            broken.extend(broken_promises(&report).into_iter().map(|b| format!("{at}: {b}")));
            let off = asymmetry(&out.join(name).join("garment.obj"));
            if off > 1.0 {
                broken.push(format!("{at}: {off:.2} mm from symmetric"));
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}
