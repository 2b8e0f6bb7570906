//! `regenerate` on a form: everything that is written, and what the report says.

use std::path::Path;

use mesh_kernel::query::ClosestPoint;
use serde_json::Value;

use crate::call::{Folder, binary, has_keys, list, number, toile, word};
use crate::fixtures::{dress, form, read, templates};

/// What one regeneration writes.
const FILES: [&str; 11] = [
    "back.png",
    "design.toile",
    "front.png",
    "garment.glb",
    "garment.obj",
    "pattern.dxf",
    "pattern.json",
    "pattern.pdf",
    "pattern.png",
    "pattern.svg",
    "report.json",
];

/// Checks the keys of a report.
#[track_caller]
pub(crate) fn report_is_complete(report: &Value) {
    let keys = [
        "toile",
        "template",
        "body",
        "surfaces",
        "joints",
        "collision",
        "ease",
        "pieces",
        "seams",
        "warnings",
        "seconds",
    ];
    has_keys(report, &keys);
    has_keys(&report["body"], &["file", "height", "units_guessed", "girths"]);
    has_keys(&report["body"]["girths"], &["bust", "underbust", "waist", "hip", "neck_base"]);
    has_keys(&report["collision"], &["nodes_inside", "faces_crossing", "min_distance"]);
    has_keys(&report["seconds"], &["load", "features", "construct", "flatten", "export", "total"]);
    let each = |name: &str, keys: &[&str]| {
        let items = report[name].as_array().unwrap();
        assert!(!items.is_empty(), "{name}");
        items.iter().for_each(|item| has_keys(item, keys));
    };
    each("surfaces", &["name", "nodes", "faces", "area"]);
    each("joints", &["name", "surfaces", "length"]);
    each("pieces", &["name", "area_3d", "area_2d", "mean_stretch", "max_stretch", "flipped", "overlaps"]);
    each("seams", &["name", "lengths_2d", "mismatch"]);
    assert_eq!(report["toile"], env!("CARGO_PKG_VERSION"));
    assert!(report["warnings"].as_array().unwrap().iter().all(Value::is_string));
}

/// What of a report breaks the promises made for every body; empty when all hold.
pub(crate) fn broken_promises(report: &Value) -> Vec<String> {
    let mut broken = Vec::new();
    let mut promise = |holds: bool, what: String| {
        if !holds {
            broken.push(what);
        }
    };
    let collision = &report["collision"];
    promise(collision["nodes_inside"] == 0, format!("{} nodes inside the body", collision["nodes_inside"]));
    promise(
        collision["faces_crossing"] == 0,
        format!("{} triangles cross the body", collision["faces_crossing"]),
    );
    promise(
        number(&collision["min_distance"]) > 0.0,
        format!("least distance {}", collision["min_distance"]),
    );
    for (girth, wanted) in report["ease_wanted"].as_object().expect("ease_wanted") {
        let ease = report["ease"][girth].as_f64().unwrap_or(f64::NAN);
        let off = ease - number(wanted);
        promise(off.abs() <= 10.0, format!("{girth} has {ease:.1} mm of ease, not {wanted}"));
    }
    for piece in report["pieces"].as_array().unwrap() {
        let name = &piece["name"];
        let change = 100.0 * (number(&piece["area_2d"]) / number(&piece["area_3d"]) - 1.0);
        promise(change.abs() <= 1.0, format!("piece {name}: area changes by {change:.2} %"));
        promise(piece["flipped"] == 0, format!("piece {name}: {} triangles flipped", piece["flipped"]));
        promise(piece["overlaps"] == 0, format!("piece {name}: {} overlaps", piece["overlaps"]));
    }
    for seam in report["seams"].as_array().unwrap() {
        let mismatch = number(&seam["mismatch"]);
        promise(mismatch <= 0.5, format!("seam {}: {mismatch:.3} mm mismatch", seam["name"]));
        let lengths: Vec<f64> = seam["lengths_2d"].as_array().unwrap().iter().map(number).collect();
        let spread = lengths.iter().fold(0.0, |m, l| f64::max(m, (l - lengths[0]).abs()));
        promise(
            spread <= mismatch + 0.01,
            format!("seam {}: lengths {lengths:?} differ by more than said", seam["name"]),
        );
    }
    broken
}

/// Largest distance (in the file's unit) of the garment's mirror image from the garment itself; x = 0 is the mirror.
pub(crate) fn asymmetry(garment: &Path) -> f64 {
    let mesh = read(garment);
    let surface = ClosestPoint::new(&mesh);
    let mirrored = mesh.positions.iter().map(|p| glam::DVec3::new(-p.x, p.y, p.z));
    mirrored.map(|p| surface.closest(p).map_or(f64::INFINITY, |c| c.distance)).fold(0.0, f64::max)
}

#[test]
fn every_template_writes_everything_and_keeps_its_promises() {
    let folder = Folder::new("regenerate");
    for template in templates() {
        let out = folder.join(&template.file_stem().unwrap().to_string_lossy());
        let words = ["regenerate", word(&template), "--body", word(form()), "--out", word(&out), "--json"];
        let said = toile(&words).succeeded();
        assert_eq!(list(&out), FILES, "{}", template.display());
        let report = said.json();
        let written: Value =
            serde_json::from_slice(&std::fs::read(out.join("report.json")).unwrap()).unwrap();
        assert_eq!(report, written, "the report on standard output and in the folder are one");
        report_is_complete(&report);
        assert_eq!(broken_promises(&report), Vec::<String>::new(), "{}", template.display());
        garment_files_agree(&out, &report);
        assert!(asymmetry(&out.join("garment.obj")) < 1.0, "the garment is symmetric");
    }
}

/// The garment's files hold what the report says.
fn garment_files_agree(out: &Path, report: &Value) {
    let obj = read(&out.join("garment.obj"));
    let surfaces = report["surfaces"].as_array().unwrap();
    let names: Vec<&str> = surfaces.iter().map(|s| s["name"].as_str().unwrap()).collect();
    let groups: Vec<&str> = obj.groups.iter().map(|g| g.name.as_str()).collect();
    assert_eq!(groups, names, "a group a surface");
    for (group, surface) in obj.groups.iter().zip(surfaces) {
        assert_eq!(u64::from(group.faces.end - group.faces.start), surface["faces"].as_u64().unwrap());
    }
    assert!(obj.corner_uvs.is_some(), "the flat pattern travels as texture coordinates");
    let info = toile(&["info", word(&out.join("garment.obj")), "--json"]).succeeded().json();
    assert_eq!(info["surfaces"], surfaces.len());
    assert_eq!(info["identity_holds"], true);
    assert_eq!(info["components"], 1, "everything is sewn together");
    let three =
        report["joints"].as_array().unwrap().iter().filter(|j| j["surfaces"].as_array().unwrap().len() > 2);
    assert!(three.count() > 0, "some joint holds three patches or more");
    let check = toile(&["check", word(&out.join("garment.obj")), "--json"]).succeeded().json();
    assert_eq!(check["ok"], true);

    // The form is in millimetres, so is its OBJ; GLB is in metres.
    let extent = |mesh: &mesh_kernel::TriMesh| mesh.bounds().map(|[lo, hi]| hi - lo).unwrap();
    let glb = read(&out.join("garment.glb"));
    let ratio = extent(&obj) / extent(&glb);
    assert!((ratio - 1000.0).abs().max_element() < 0.1, "{ratio}");
    assert_eq!(glb.faces.len(), obj.faces.len());
    // It lies over the body.
    let body = read(form());
    let ([lo, hi], [body_lo, body_hi]) = (obj.bounds().unwrap(), body.bounds().unwrap());
    assert!(lo.y > body_lo.y && hi.y < body_hi.y);

    let pieces = report["pieces"].as_array().unwrap().len();
    let dxf = std::fs::read_to_string(out.join("pattern.dxf")).unwrap();
    assert_eq!(dxf.lines().filter(|l| l.trim() == "INSERT").count(), pieces);
    let pattern: Value = serde_json::from_slice(&std::fs::read(out.join("pattern.json")).unwrap()).unwrap();
    assert_eq!(pattern["pieces"].as_array().unwrap().len(), pieces);
    assert!(std::fs::read(out.join("pattern.pdf")).unwrap().starts_with(b"%PDF-"));
    assert!(std::fs::read_to_string(out.join("pattern.svg")).unwrap().contains("mm\""));
}

#[test]
fn only_the_asked_formats_are_written() {
    let folder = Folder::new("formats");
    let run = |formats: &str, out: &Path| {
        let words =
            ["regenerate", word(dress()), "--body", word(form()), "--out", word(out), "--formats", formats];
        toile(&[&words[..], &["--levels", "2"]].concat()).succeeded();
    };
    let out = folder.join("some");
    run("obj,svg", &out);
    let found = list(&out);
    for (name, wanted) in [
        ("garment.obj", true),
        ("pattern.svg", true),
        ("garment.glb", false),
        ("front.png", false),
        ("pattern.pdf", false),
    ] {
        assert_eq!(found.iter().any(|f| f == name), wanted, "{name} among {found:?}");
    }
    // The old files of a folder stay; nothing unfinished lies about.
    run("pdf", &out);
    let after = list(&out);
    assert!(
        found.iter().all(|f| after.contains(f)) && after.contains(&"pattern.pdf".to_owned()),
        "{after:?}"
    );
    assert!(after.iter().all(|f| FILES.contains(&f.as_str())), "{after:?}");
}

#[test]
fn levels_and_size_names_do_what_they_say() {
    let folder = Folder::new("levels");
    let run = |levels: &str| {
        let out = folder.join(levels);
        let words =
            ["regenerate", word(dress()), "--body", word(form()), "--out", word(&out), "--levels", levels];
        let report =
            toile(&[&words[..], &["--formats", "dxf", "--sample-size", "SAMPLE 7", "--json"]].concat());
        let report = report.succeeded().json();
        let dxf = std::fs::read_to_string(out.join("pattern.dxf")).unwrap();
        assert!(dxf.contains("SAMPLE 7"), "the size's name is in the DXF");
        report["surfaces"].as_array().unwrap().iter().map(|s| s["faces"].as_u64().unwrap()).sum::<u64>()
    };
    let (coarse, fine) = (run("2"), run("3"));
    assert_eq!(fine, 4 * coarse, "a level splits every triangle in four");
}

#[test]
fn a_regenerated_design_is_a_template_again() {
    let folder = Folder::new("again");
    let (first, second) = (folder.join("first"), folder.join("second"));
    let words = ["--formats", "toile,obj", "--levels", "2"];
    let call = ["regenerate", word(dress()), "--body", word(form()), "--out", word(&first)];
    toile(&[&call[..], &words].concat()).succeeded();
    let design = first.join("design.toile");
    // The levels are the design's.
    let call = ["regenerate", word(&design), "--body", word(form()), "--out", word(&second)];
    toile(&[&call[..], &["--formats", "obj"]].concat()).succeeded();
    assert!(read(&first.join("garment.obj")) == read(&second.join("garment.obj")));
}

#[test]
fn results_are_written_together() {
    let folder = Folder::new("together");
    let out = folder.join("out");
    std::fs::create_dir_all(out.join("pattern.svg")).unwrap();
    std::fs::write(out.join("garment.obj"), "old").unwrap();
    let words = ["regenerate", word(dress()), "--body", word(form()), "--out", word(&out)];
    toile(&[&words[..], &["--formats", "obj,svg", "--levels", "2"]].concat()).refused(1, "pattern.svg");
    assert_eq!(std::fs::read(out.join("garment.obj")).unwrap(), b"old");
    assert_eq!(list(&out), ["garment.obj", "pattern.svg/"]);
}

#[test]
fn mistakes_are_said_of_the_file_that_makes_them() {
    let folder = Folder::new("mistakes");
    let text = std::fs::read_to_string(dress()).unwrap();
    let template = folder.write("no-such-curve.json", text.replace("\"waist\"", "\"wrist\""));
    let out = folder.join("out");
    let call = |template: &Path, body: &Path| {
        toile(&["regenerate", word(template), "--body", word(body), "--out", word(&out)])
    };
    let said = call(&template, form()).refused(1, "wrist").stderr;
    assert!(said.starts_with(&format!("error: {}", template.display())), "{said}");
    let list = folder.write("list.json", "[]");
    call(&list, form()).refused(1, "this is a list");
    let body = folder.write("ball.obj", crate::fixtures::ball());
    let said = call(dress(), &body).refused(1, "upright").stderr;
    assert!(said.starts_with(&format!("error: {}", body.display())), "{said}");
    assert!(!out.exists());
}

#[test]
fn a_body_in_inches_is_warned_of_and_read_when_said() {
    let folder = Folder::new("inches");
    let mesh = read(form());
    let mut text = String::new();
    for p in &mesh.positions {
        text.push_str(&format!("v {:.5} {:.5} {:.5}\n", p.x / 25.4, p.y / 25.4, p.z / 25.4));
    }
    for f in &mesh.faces {
        text.push_str(&format!("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1));
    }
    let body = folder.write("inches.obj", text);
    let said = toile(&["features", word(&body)]).succeeded();
    assert!(said.stderr.contains("inches"), "{}", said.stderr);
    let out = folder.join("out");
    let words = ["regenerate", word(dress()), "--body", word(&body), "--out", word(&out), "--json"];
    let more = ["--formats", "obj", "--levels", "2", "--unit", "inch"];
    let report = toile(&[&words[..], &more].concat()).succeeded().json();
    assert_eq!(report["body"]["units_guessed"], "in");
    let height = number(&toile(&["features", word(form()), "--json"]).succeeded().json()["height"]);
    assert!((number(&report["body"]["height"]) - height).abs() < 1.0);
    // Decimetres are no unit of a body; what can be done is said, and is there.
    let metres: String = mesh.positions.iter().fold(String::new(), |text, p| {
        text + &format!("v {:.5} {:.5} {:.5}\n", p.x / 100.0, p.y / 100.0, p.z / 100.0)
    });
    let faces: String =
        mesh.faces.iter().map(|f| format!("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1)).collect();
    let body = folder.write("decimetres.obj", metres + &faces);
    toile(&["features", word(&body)]).refused(1, "scale it to one of these");
    toile(&["features", word(&body), "--unit", "m"]).refused(1, "metres high");
}

#[cfg(target_os = "linux")]
#[test]
fn more_splits_than_memory_are_refused_before_they_are_made() {
    let folder = Folder::new("regenerate-memory");
    let out = folder.join("out");
    // Four gigabytes of addresses, of which the threads' stacks take some.
    let shell = "ulimit -v 4000000; exec \"$0\" regenerate \"$1\" --body \"$2\" --out \"$3\" --levels 7";
    let output = std::process::Command::new("sh")
        .args(["-c", shell])
        .arg(binary())
        .args([word(dress()), word(form()), word(&out)])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(told.contains("7 splits make") && told.contains("GB of memory"), "{told}");
    assert!(!out.exists());
}
