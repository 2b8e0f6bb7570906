//! Templates, designs, measurements and features: the program's own JSON.

use std::collections::BTreeMap;
use std::path::Path;

use design::document::{DOCUMENT_VERSION, Document, DocumentBody, DocumentPlacement};
use fuzz::{Reader, Reading, Shape};
use reference::dress_form::{Measurements, presets};
use reference::human::{ExportedCurve, ExportedFeatures};
use template::Template;

use crate::run;

/// A JSON value of two bytes takes 32, a map's entry of six bytes 100, growing lists twice that and the old while they
/// move; a template is there three times while it is read: as a tree, as the file, written out.
fn reader(
    name: &'static str,
    seeds: Vec<Vec<u8>>,
    read: impl Fn(&[u8]) -> Reading + Send + 'static,
) -> Reader {
    Reader {
        name,
        shape: Shape::Json,
        seeds,
        words: &["left_a", "right_a", "waist", "from", "1e308", "[", "]", "{", "}", ",", "null"],
        inputs: 10_000,
        base_memory: 1 << 16,
        memory_factor: 400,
        read: Box::new(read),
    }
}

/// The caller shortens what it says of JSON.
fn of_json(error: &serde_json::Error) -> String {
    error.to_string().chars().take(300).collect()
}

fn sample(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A template that has every key of the format and still fits on a page.
const SMALL: &str = r#"{"toile_template":1,"name":"tube","description":"d","mirrored":true,"symmetric":false,"level":2,"clearance":3,
"nodes":{
 "left_a":{"at":["waist","left_side"],"normal":8,"first":1,"second":2,"axes":[1,2,3],"slide":{"along":"waist","toward":"left_bust","fraction":0.5},"ease":"waist","scale":"height"},
 "b":{"at":"left_bust","centre":true,"skin":2,"level":{"from":"hip","to":"floor","t":0.4,"plus":3}},
 "c":{"between":["left_a","b"],"t":0.3,"centre":true,"level":"hip"},
 "d":{"at":["hip","back"],"mirror":true,"slide":{"along":"hip","by":4}}},
"surfaces":{"left_s":{"rows":[["b","left_a"],["c","d"]],"interior":"pinned","open_along":["slit"],"layer":1},
 "t":{"faces":[["b","left_a","c"],["left_a","d","c"]],"across_centre":true},"u":{"rows":[["b","left_a"],["c","d"]],"mirror":true,"interior":"free"}},
"joints":[{"name":"j","surfaces":["left_s","t"],"nodes":["b","left_a"],"closed":false}],
"lines":{"hem":{"through":["b","left_a"],"across_centre":true,"corners":["left_a"],"hold":true},"slit":{"through":["left_a","d"],"shape":{"points":[[0,0,0],[1,2,0],[3,0,0]],"turn":true}},
 "left_e":{"through":["c","d"],"shape":{"follow":"waist","clearance":3},"mirror":false},"loop":{"through":["b","left_a","c"],"closed":true,"shape":"straight"},"n":{"through":["left_a","b"],"mirror":true,"continues":"hem2"},"hem2":{"through":["b","c"],"shape":"spline"}},
"fair_across":[["left_s","right_s"]],"ease":{"waist":{"ease":20,"curve":"waist","surfaces":["t"]}},
"pieces":{"left_s":{"label":"L","quantity":2,"allowance":10,"edges":{"hem":30},"grain":["b","left_a"],"on_fold":"hem","fabric":"shell"},"t":{"grain":"down"}}}"#;

pub(crate) fn templates() -> Vec<String> {
    vec![SMALL.into(), sample("fitted-bodice.json")]
}

#[test]
fn template() {
    let seeds = templates().into_iter().map(String::into_bytes).collect();
    run(reader("template", seeds, |bytes| {
        // The file is read as text; what is no text is refused before.
        let Ok(text) = std::str::from_utf8(bytes) else { return Reading::Refused("no text".into()) };
        match Template::from_json(text) {
            Ok(template) => {
                let file = template.file();
                let again = Template::from_json(&template.to_json()).expect("what was written is read");
                assert_eq!(again.file(), file);
                Reading::Sound(vec![
                    file.nodes.len(),
                    file.surfaces.len(),
                    file.lines.len(),
                    file.pieces.len(),
                ])
            }
            Err(error) => Reading::Refused(error.to_string()),
        }
    }));
}

pub(crate) fn document(template: &str) -> Document {
    let template = Template::from_json(template).expect("a valid template");
    Document {
        toile_design: DOCUMENT_VERSION,
        program: "0.1.0".into(),
        template: template.file().clone(),
        levels: Some(2),
        nodes: BTreeMap::from([("b".into(), [0.5, 1.0, -2.25])]),
        body: DocumentBody {
            file: "body.obj".into(),
            placement: DocumentPlacement {
                scale: 0.001,
                rotation: [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
                translation: [0.1, -0.2, 0.3],
            },
            positions: (0..12).map(|k| [f64::from(k), 0.125, -1e-3]).collect(),
            faces: (0..10).map(|k| [k, k + 1, k + 2]).collect(),
        },
    }
}

#[test]
fn design() {
    let seeds = templates().iter().map(|t| document(t).to_bytes()).collect();
    run(reader("design", seeds, |bytes| match Document::from_bytes(bytes) {
        Ok(document) => {
            let mesh = document.mesh();
            assert!(mesh.positions.iter().all(|p| p.is_finite()));
            assert!(mesh.faces.as_flattened().iter().all(|v| (*v as usize) < mesh.positions.len()));
            let placement = document.placement();
            assert!(placement.scale > 0.0 && (placement.rotation.determinant() - 1.0).abs() < 1e-3);
            assert_eq!(
                Document::from_bytes(&document.to_bytes()).expect("what was written is read"),
                document
            );
            Reading::Sound(vec![mesh.positions.len(), mesh.faces.len(), document.nodes.len()])
        }
        Err(error) => Reading::Refused(error.to_string()),
    }));
}

#[test]
fn measurements() {
    let seeds =
        presets().iter().step_by(5).filter_map(|p| serde_json::to_vec(&p.measurements).ok()).collect();
    run(reader("measurements", seeds, |bytes| {
        let given: Measurements = match serde_json::from_slice(bytes) {
            Ok(given) => given,
            Err(error) => return Reading::Refused(of_json(&error)),
        };
        match given.resolve() {
            Ok(all) => {
                assert!(["bust", "waist", "hip", "height", "ankle"].iter().all(|m| all.get(m) > Some(0.0)));
                let again = all.to_measurements().resolve().expect("a full set is sound");
                assert_eq!(again, all);
                Reading::Sound(vec![(all.height / 8.0) as usize, (all.bust / 8.0) as usize])
            }
            Err(error) => Reading::Refused(error.to_string()),
        }
    }));
}

#[test]
fn features() {
    let curve = |closed: bool| ExportedCurve {
        closed,
        length: 812.25,
        girth: closed.then_some(800.0),
        polyline: (0..9).map(|k| [f64::from(k) / 3.0, 1.0, 0.0]).collect(),
    };
    let features = ExportedFeatures {
        units: "mm".into(),
        file_units: "m".into(),
        height: 1680.0,
        facing: [0.0, 0.0, 1.0],
        up: [0.0, 1.0, 0.0],
        points: BTreeMap::from([("crown".into(), [0.0, 1680.0, 0.0])]),
        curves: BTreeMap::from([("waist".into(), curve(true)), ("left_side".into(), curve(false))]),
        girths: BTreeMap::from([("waist".into(), 800.0)]),
        warnings: vec!["no head".into()],
    };
    let seeds = vec![serde_json::to_vec(&features).expect("features are written")];
    run(reader("features", seeds, |bytes| match serde_json::from_slice::<ExportedFeatures>(bytes) {
        Ok(features) => {
            let text = serde_json::to_vec(&features).expect("features are written");
            let again: ExportedFeatures = serde_json::from_slice(&text).expect("what was written is read");
            assert_eq!(again, features);
            Reading::Sound(vec![features.points.len(), features.curves.len(), features.girths.len()])
        }
        Err(error) => Reading::Refused(of_json(&error)),
    }));
}

#[test]
fn batch_report() {
    let text = r#"{"template":"t","fingerprint":"0123456789abcdef","warnings":["far","near"],"seconds":{"total":1.5}}"#;
    run(reader("batch report", vec![text.into()], |bytes| {
        match design::batch::finished(bytes, "0123456789abcdef") {
            Some(warnings) => Reading::Sound(vec![warnings]),
            None => Reading::Refused("no report of these inputs".into()),
        }
    }));
}

#[test]
fn thicknesses() {
    run(reader("thicknesses", vec![b"[2, 2.5, 3e-1, 0, 1.25]".to_vec()], |bytes| {
        let Ok(text) = std::str::from_utf8(bytes) else { return Reading::Refused("no text".into()) };
        match design::thicken::list_from_json(text) {
            Ok(all) => {
                assert!(all.iter().all(|t| t.is_finite()));
                Reading::Sound(vec![all.len()])
            }
            Err(error) => Reading::Refused(error.to_string()),
        }
    }));
}
