//! What the guide and the samples say is what the program reads.
#![allow(clippy::unwrap_used, reason = "what is unexpected here is a finding")]

use std::path::{Path, PathBuf};

use template::Template;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// `UPDATE_DOCS=1 cargo test --release -p design --test documentation` writes the schema anew.
#[test]
fn the_schema_in_the_guide_is_the_programs() {
    let path = root().join("docs/template.schema.json");
    let text = serde_json::to_string_pretty(&Template::schema()).unwrap() + "\n";
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    assert_eq!(
        std::fs::read_to_string(&path).unwrap(),
        text,
        "run with UPDATE_DOCS=1 and look at the change"
    );
}

#[test]
fn the_guides_example_is_a_template() {
    let guide = std::fs::read_to_string(root().join("docs/templates.md")).unwrap();
    let example = guide.split("```json\n").nth(1).unwrap().split("```").next().unwrap();
    let template = Template::from_json(example).unwrap();
    assert_eq!(template.file().surfaces.len(), 2);
}

#[test]
fn samples_are_templates() {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(root().join("samples")).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        if path.extension().is_some_and(|e| e == "json") && text.contains("toile_template") {
            Template::from_json(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
            names.push(path.file_stem().unwrap().to_string_lossy().into_owned());
        }
    }
    names.sort();
    assert_eq!(names, ["fitted-bodice", "princess-dress"]);
}
