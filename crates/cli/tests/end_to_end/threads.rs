//! The number of threads changes no byte.

use std::path::Path;

use serde_json::Value;

use crate::call::{Folder, list, toile, word};
use crate::fixtures::{form, templates};

/// A report without what only the clock knows.
fn timeless(path: &Path) -> Value {
    let mut report: Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    report.as_object_mut().unwrap().remove("seconds");
    report
}

#[test]
fn files_are_the_same_on_one_thread_and_on_more() {
    let folder = Folder::new("threads");
    for template in templates() {
        let run = |threads: &str| {
            let out = folder.join(&format!("{}-{threads}", template.file_stem().unwrap().to_string_lossy()));
            let words = ["regenerate", word(&template), "--body", word(form()), "--out", word(&out)];
            toile(&[&words[..], &["--threads", threads]].concat()).succeeded();
            out
        };
        let (one, two) = (run("1"), run("2"));
        assert_eq!(list(&one), list(&two));
        for name in list(&one) {
            let (a, b) = (one.join(&name), two.join(&name));
            if name == "report.json" {
                assert_eq!(timeless(&a), timeless(&b));
            } else {
                assert!(std::fs::read(a).unwrap() == std::fs::read(b).unwrap(), "{name} differs");
            }
        }
    }
}

#[test]
fn other_commands_are_the_same_too() {
    let folder = Folder::new("threads-others");
    let run = |threads: &str| {
        let at = |name: &str| folder.join(&format!("{threads}-{name}"));
        let features = ["features", word(form()), "-o", word(&at("f.json")), "--picture", word(&at("f.png"))]
            .map(str::to_owned);
        let render = ["render", word(form()), "-o", word(&at("r.png")), "--view", "iso"].map(str::to_owned);
        let made = ["form", "--bust", "100", "--waist", "80", "-o", word(&at("form.glb"))].map(str::to_owned);
        for words in [features.as_slice(), render.as_slice(), made.as_slice()] {
            toile(&[words, &["--threads".to_owned(), threads.to_owned()]].concat()).succeeded();
        }
        ["f.json", "f.png", "r.png", "form.glb"].map(|name| std::fs::read(at(name)).unwrap())
    };
    assert!(run("1") == run("2"));
}
