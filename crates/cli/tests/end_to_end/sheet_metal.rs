//! `model`, `bends`, `unfold`: scripts and sheets to counts, plates and drawings.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::call::{Folder, has_keys, number, toile, word};
use crate::fixtures::{read, root};

fn sample(name: &str) -> PathBuf {
    root().join("samples/sheets").join(format!("{name}.json"))
}

fn bends(sheet: &Path) -> Value {
    toile(&["bends", word(sheet), "--json"]).succeeded().json()
}

fn int(value: &Value) -> i64 {
    value.as_i64().unwrap_or_else(|| panic!("{value} is no whole number"))
}

/// v, free e, f, s, g_nm, m, b + w, d.
fn row(report: &Value) -> [i64; 8] {
    let of = |key: &str| int(&report[key]);
    [of("v"), of("e"), of("f"), of("s"), of("g_nm"), of("m"), of("b") + of("w"), of("d")]
}

#[test]
fn the_papers_examples_are_modelled_and_counted() {
    let folder = Folder::new("sheet-metal-papers");
    for (name, wanted, one_piece) in [
        ("bracket", [26, 24, 11, 1, 0, 0, 12, 2], true),
        ("y-extrusion", [8, 9, 3, 1, 0, 0, 1, -1], false),
        ("corner", [7, 6, 3, 1, 0, 0, 3, 1], true),
        ("three-cells", [16, 20, 10, 1, 3, 0, 8, -1], true),
        ("four-cells", [18, 24, 12, 1, 4, 0, 9, -2], false),
        ("box-partition", [12, 0, 11, 1, 0, 2, 20, 10], true),
        ("square-torus", [16, 0, 12, 1, 2, 1, 28, 17], true),
        ("hexagon-prism", [12, 12, 5, 1, 2, 0, 6, 2], true),
    ] {
        // The script itself, and the file that it makes.
        let obj = folder.join(&format!("{name}.obj"));
        let model = toile(&["model", word(&sample(name)), "-o", word(&obj), "--json"]).succeeded().json();
        assert_eq!(model["identity_holds"], true);
        for sheet in [sample(name), obj] {
            let report = bends(&sheet);
            assert_eq!(row(&report), wanted, "{}", sheet.display());
            assert_eq!((&report["identity_holds"], &report["one_piece"]), (&true.into(), &one_piece.into()));
            let o = &report["operators"];
            let [mcv, mev, mef, mgb, mbke, muke, mwkb] =
                ["MCV", "MEV", "MEF", "MGB", "MBKE", "MUKE", "MWKB"].map(|k| int(&o[k]));
            let built = [mcv + mev, mev + mef - mbke - muke, mef, mcv, mgb, muke, mgb + mbke];
            assert_eq!(built, wanted[..7], "P · M⁻¹ builds the part");
            assert_eq!(mwkb, int(&report["w"]));
        }
    }
    let bracket = bends(&sample("bracket"));
    let plan = ["MCV", "MEV", "MEF", "MGB", "MBKE", "MUKE", "MWKB"].map(|k| int(&bracket["operators"][k]));
    assert_eq!(plan, [1, 25, 11, 0, 12, 0, 2]);
    // Its four holes are rings, which the paper leaves out: vertices and free edges come to it, d stays.
    let holes = bends(&sample("bracket-with-holes"));
    assert_eq!((int(&holes["g_nm"]), int(&holes["d"]), int(&holes["rings"])), (0, 2, 4));
}

#[test]
fn fig_10_has_its_alternatives() {
    let report = bends(&sample("three-cells"));
    has_keys(
        &report,
        &[
            "s",
            "b",
            "e",
            "w",
            "v",
            "g_nm",
            "m",
            "f",
            "d",
            "operators",
            "one_piece",
            "bend_lines",
            "weld_lines",
        ],
    );
    assert_eq!(report["bend_lines"].as_array().unwrap().len(), 9);
    let others = report["alternatives"].as_array().unwrap();
    assert!(others.iter().any(|a| a["bends"] == 8 && a["needed_welds"] == 1 && a["overlaps"] == 0));
    let refused = bends(&sample("four-cells"));
    assert!(refused["one_piece_reason"].as_str().unwrap().contains("eq. 10"));
    assert_eq!((int(&refused["least_joints"]), int(&refused["most_bends"])), (11, 10));
}

/// Corners of all outlines on layer CUT, and lines by layer.
fn dxf(text: &str) -> (Vec<Vec<[f64; 2]>>, BTreeMap<String, usize>) {
    let lines: Vec<&str> = text.lines().collect();
    let pairs: Vec<(&str, &str)> = lines.chunks_exact(2).map(|p| (p[0].trim(), p[1])).collect();
    let (mut outlines, mut counts, mut kind) = (Vec::new(), BTreeMap::new(), "");
    for (code, value) in pairs {
        match (code, value) {
            ("0", v) => {
                kind = v;
                if v == "POLYLINE" {
                    outlines.push(Vec::new());
                }
                if v == "VERTEX" {
                    outlines.last_mut().unwrap().push([0.0; 2]);
                }
            }
            ("8", layer) if kind == "LINE" => *counts.entry(layer.to_owned()).or_default() += 1,
            ("10" | "20", v) if kind == "VERTEX" => {
                outlines.last_mut().unwrap().last_mut().unwrap()[usize::from(code == "20")] =
                    v.parse().unwrap();
            }
            _ => {}
        }
    }
    (outlines, counts)
}

fn area(outlines: &[Vec<[f64; 2]>]) -> f64 {
    let ring = |o: &Vec<[f64; 2]>| -> f64 {
        (0..o.len()).map(|i| (o[i], o[(i + 1) % o.len()])).map(|([a, b], [c, d])| a * d - b * c).sum()
    };
    outlines.iter().map(ring).sum::<f64>() / 2.0
}

#[test]
fn plates_have_the_sheets_area_and_bends_on_their_own_layer() {
    let folder = Folder::new("sheet-metal-plates");
    for name in ["bracket", "box-partition", "three-cells", "mount", "hexagon-prism"] {
        let (obj, out) = (folder.join("sheet.obj"), folder.join("plates.dxf"));
        toile(&["model", word(&sample(name)), "-o", word(&obj)]).succeeded();
        let report = toile(&["unfold", word(&sample(name)), "-o", word(&out), "--json"]).succeeded().json();
        assert_eq!(report["overlaps"], 0);
        assert!(number(&report["length_error"]) <= 1e-9);
        let (outlines, lines) = dxf(&std::fs::read_to_string(&out).unwrap());
        let mesh = read(&obj);
        let wanted: f64 = (0..mesh.faces.len() as u32).map(|f| mesh.area_normal(f).length() / 2.0).sum();
        assert!(
            (area(&outlines) - wanted).abs() < 1e-9 * wanted,
            "{name}: {} is not {wanted}",
            area(&outlines)
        );
        assert_eq!(lines["BEND"] as i64, int(&report["bends"]), "{name}");
        assert!(lines.keys().all(|layer| layer == "BEND" || layer == "WELD"));
        // The same bytes again, and as SVG.
        let bytes = std::fs::read(&out).unwrap();
        toile(&["unfold", word(&sample(name)), "-o", word(&out), "--threads", "1"]).succeeded();
        assert!(bytes == std::fs::read(&out).unwrap());
        let svg = folder.join("plates.svg");
        toile(&["unfold", word(&sample(name)), "-o", word(&svg)]).succeeded();
        let text = std::fs::read_to_string(&svg).unwrap();
        assert_eq!(text.matches("class=\"bend").count() as i64, int(&report["bends"]));
        assert_eq!(text.matches("class=\"plate\"").count(), report["plates"].as_array().unwrap().len());
    }
}

#[test]
fn an_assembly_is_modelled_analysed_unfolded_and_thickened() {
    let folder = Folder::new("sheet-metal-assembly");
    let report = bends(&sample("mount"));
    assert!(int(&report["f"]) >= 30, "{}", report["f"]);
    assert_eq!((int(&report["s"]), &report["identity_holds"]), (1, &true.into()));
    let plates = toile(&[
        "unfold",
        word(&sample("mount")),
        "-o",
        word(&folder.join("mount.dxf")),
        "--thickness",
        "2",
        "--json",
    ])
    .succeeded()
    .json();
    assert_eq!(plates["overlaps"], 0);
    assert_eq!(plates["plates"].as_array().unwrap().len() as i64, int(&report["pieces"]));
    let solid = folder.join("mount.stl");
    let thick = toile(&["thicken", word(&sample("mount")), "--thickness", "2", "-o", word(&solid), "--json"])
        .succeeded()
        .json();
    assert_eq!(
        (&thick["closed"], &thick["self_intersections"], &thick["components"]),
        (&true.into(), &0.into(), &1.into())
    );
}

#[test]
fn allowances_change_the_plate_as_the_tables_say() {
    let folder = Folder::new("sheet-metal-allowance");
    let fold = folder.write(
        "fold.obj",
        "v 0 0 0\nv 40 0 0\nv 40 30 0\nv 0 30 0\nv 0 0 20\nv 40 0 20\ng floor\nf 1 2 3\nf 1 3 4\ng wall\nf 1 5 6\nf 1 6 2\n",
    );
    let size = |more: &[&str]| {
        let out = folder.join("fold.dxf");
        let words = ["unfold", word(&fold), "-o", word(&out), "--json"];
        let report = toile(&[&words[..], more].concat()).succeeded().json();
        let size = report["plates"][0]["size"].as_array().unwrap().iter().map(number).fold(0.0, f64::max);
        (size, int(&report["reliefs"]))
    };
    assert_eq!(size(&[]), (50.0, 0));
    let quarter = std::f64::consts::FRAC_PI_2;
    let (flat, _) = size(&["--thickness", "2", "--radius", "3", "--k-factor", "0.4", "--layer", "outside"]);
    assert!((flat - (50.0 - 10.0 + quarter * 3.8)).abs() < 1e-9, "{flat}");
    let (flat, _) = size(&["--thickness", "2"]);
    assert!((flat - (50.0 - 6.0 + quarter * 2.88)).abs() < 1e-9, "{flat}");
    // The same part as a solid.
    let solid = folder.join("solid.stl");
    toile(&["thicken", word(&fold), "-o", word(&solid), "--thickness", "2", "--corners", "mitre"])
        .succeeded();
    let out = folder.join("solid.dxf");
    let words = ["unfold", word(&solid), "-o", word(&out), "--from-solid", "--json"];
    let report = toile(&words).succeeded().json();
    let plates = report["plates"].as_array().unwrap();
    let size = plates[0]["size"].as_array().unwrap().iter().map(number).fold(0.0, f64::max);
    assert!(plates.len() == 1 && (size - flat).abs() < 1e-4, "{size} {flat}");
    let words = ["unfold", word(&fold), "-o", word(&out), "--from-solid"];
    toile(&words).refused(1, "");
    let out = folder.join("no.dxf");
    let words = ["unfold", word(&fold), "-o", word(&out), "--thickness", "2", "--radius", "40"];
    toile(&words).refused(1, "too small for its bends");
    toile(&["unfold", word(&fold), "-o", word(&folder.join("no.pdf"))]).refused(2, ".dxf");
    assert!(!out.exists());
}

#[test]
fn shared_box_with_a_partition_has_the_papers_numbers() {
    let sheet = root().join("../shared/sheets/box-partition-coarse.obj");
    if !sheet.is_file() {
        assert!(
            !std::env::var("TOILE_REQUIRE_SHARED").is_ok_and(|v| v == "1"),
            "{} is missing",
            sheet.display()
        );
        return;
    }
    let report = bends(&sheet);
    assert_eq!(row(&report), [12, 0, 11, 1, 0, 2, 20, 10]);
}

#[test]
fn bad_scripts_are_told_with_line_and_command_and_write_nothing() {
    let folder = Folder::new("sheet-metal-bad");
    let out = folder.join("out.obj");
    for (text, about) in [
        (
            "{\"toile_script\": 1, \"commands\": [\n{\"do\": \"create\", \"name\": \"a\",\n \"outline\": {\"circle\": {\"center\": [0, 0], \"radius\": 0}}}]}",
            "line 2, command 1 (create)",
        ),
        ("{\"toile_script\": 1, \"commands\": [\n\n{\"do\": \"fold\"}]}", "line 3, command 1 (fold)"),
        ("{\"toile_script\": 1, \"commands\": [", "line 1"),
        ("{}", "toile_script"),
        ("[1, 2]", "line 1"),
        ("", "line 1"),
    ] {
        let script = folder.write("bad.json", text);
        let told = toile(&["model", word(&script), "-o", word(&out)]).refused(1, about);
        assert!(told.stderr.contains("bad.json"), "{}", told.stderr);
        toile(&["bends", word(&script)]).refused(1, about);
        assert!(!out.exists());
    }
    let wires = folder.write("wires.json", "{\"toile_script\": 1, \"commands\": [{\"do\": \"wire\", \"name\": \"w\", \"lines\": [[[0, 0, 0], [1, 0, 0]]]}]}");
    toile(&["model", word(&wires), "-o", word(&out)]).refused(1, "only wires");
    toile(&["model", word(&wires)]).succeeded();
    toile(&["bends", word(&folder.join("nowhere.obj"))]).refused(1, "nowhere.obj");
}

#[test]
fn tables_for_people() {
    let text = toile(&["bends", word(&sample("three-cells"))]).succeeded().stdout;
    for said in ["g_nm", "MBKE", "one piece: yes", "other ways"] {
        assert!(text.contains(said), "{said}: {text}");
    }
    let folder = Folder::new("sheet-metal-tables");
    let text =
        toile(&["unfold", word(&sample("bracket")), "-o", word(&folder.join("a.svg"))]).succeeded().stdout;
    assert!(text.contains("plate 1") && text.contains("0 overlaps"), "{text}");
}

#[test]
fn the_guides_script_runs_and_names_every_command() {
    let guide = std::fs::read_to_string(root().join("docs/sheet-modelling.md")).unwrap();
    let script = guide.split("```json\n").nth(1).and_then(|s| s.split("```").next()).unwrap();
    let folder = Folder::new("sheet-metal-guide");
    let path = folder.write("guide.json", script);
    let report =
        toile(&["model", word(&path), "-o", word(&folder.join("tray.obj")), "--json"]).succeeded().json();
    assert_eq!((int(&report["commands"]), int(&report["counts"]["f"])), (3, 2));
    for command in [
        "wire",
        "extrude",
        "create",
        "add",
        "punch",
        "bend",
        "sweep",
        "draw",
        "round",
        "chamfer",
        "join",
        "remove",
        "partial",
        "add_solid",
        "undo",
    ] {
        assert!(guide.contains(&format!("| `{command}`")), "{command} is not in the guide");
    }
    // Every sample is one that the guide or a test names, and runs.
    for entry in std::fs::read_dir(root().join("samples/sheets")).unwrap() {
        toile(&["model", word(&entry.unwrap().path())]).succeeded();
    }
}
