//! Both garments and the features on the bodies of `../shared/bodies`.

use serde_json::Value;

use crate::call::{Folder, toile, word};
use crate::fixtures::{shared_bodies, templates};
use crate::forms::features_are_complete;
use crate::regenerate::{asymmetry, broken_promises, report_is_complete};

/// How far a garment may be from its mirror image on a body that is symmetric itself, in millimetres.
const ASYMMETRY: f64 = 3.0;

#[test]
fn both_garments_fit_every_body() {
    let Some(bodies) = shared_bodies() else { return };
    let folder = Folder::new("bodies");
    let names: Vec<String> = bodies.iter().map(|b| word(&b.canonicalize().unwrap()).to_owned()).collect();
    let names = folder.write("list.txt", names.join("\n"));
    let mut broken = Vec::new();
    for template in templates() {
        let garment = template.file_stem().unwrap().to_string_lossy().into_owned();
        let out = folder.join(&garment);
        let words = [
            "batch",
            word(&template),
            "--bodies",
            word(&names),
            "--out",
            word(&out),
            "--formats",
            "obj",
            "--json",
        ];
        let batch = toile(&words).json();
        let results = batch["bodies"].as_array().unwrap();
        assert_eq!(results.len(), bodies.len());
        for body in results {
            let name = body["name"].as_str().unwrap();
            let at = format!("{garment} on {name}");
            if body["state"] != "built" {
                broken.push(format!("{at}: {}", body["error"]));
                continue;
            }
            let report = std::fs::read(out.join(name).join("report.json")).unwrap();
            let report: Value = serde_json::from_slice(&report).unwrap();
            report_is_complete(&report);
            assert_eq!(report["body"]["units_guessed"], "m");
            broken.extend(broken_promises(&report).into_iter().map(|b| format!("{at}: {b}")));
            if !name.starts_with("scan-") {
                // The bodies' files are in metres, and the garments lie over them.
                let off = 1000.0 * asymmetry(&out.join(name).join("garment.obj"));
                if off > ASYMMETRY {
                    broken.push(format!("{at}: {off:.2} mm from symmetric"));
                }
            }
        }
    }
    assert!(broken.is_empty(), "{} broken promises:\n{}", broken.len(), broken.join("\n"));
}

#[test]
fn features_of_every_body_have_all_names() {
    let Some(bodies) = shared_bodies() else { return };
    for body in bodies {
        let features = toile(&["features", word(&body), "--json"]).succeeded().json();
        features_are_complete(&features, true);
    }
}
