//! Wrong words are refused with 2 and told what is wrong; right ones are explained.

use crate::call::{Folder, toile, word};
use crate::fixtures::{dress, form};

/// All commands.
const COMMANDS: [&str; 13] = [
    "regenerate",
    "batch",
    "features",
    "form",
    "check",
    "info",
    "flatten",
    "thicken",
    "deflate",
    "model",
    "bends",
    "unfold",
    "render",
];

#[test]
fn help_explains_every_command() {
    let help = toile(&["help"]).succeeded().stdout;
    for command in COMMANDS {
        assert!(help.contains(command), "{command} is missing:\n{help}");
        let one = toile(&[command, "--help"]).succeeded().stdout;
        assert!(one.contains("Usage: toile") && one.contains("Example"), "{command}:\n{one}");
    }
    let version = toile(&["--version"]).succeeded().stdout;
    assert!(version.starts_with("toile "), "{version}");
}

#[test]
fn unknown_and_missing_words_are_refused() {
    let calls: [&[&str]; 50] = [
        &["sew"],
        &["regenerate"],
        &["regenerate", "t.json"],
        &["regenerate", "t.json", "--body", "b.obj"],
        &["regenerate", "t.json", "--body", "b.obj", "--out"],
        &["regenerate", "t.json", "--body", "b.obj", "--out", "o", "--formats", "docx"],
        &["regenerate", "t.json", "--body", "b.obj", "--out", "o", "--levels", "99"],
        &["regenerate", "t.json", "--body", "b.obj", "--out", "o", "--levels", "two"],
        &["regenerate", "t.json", "--body", "b.obj", "--out", "o", "--paper", "a17"],
        &["regenerate", "t.json", "--body", "b.obj", "--out", "o", "--dxf", "acme"],
        &["regenerate", "t.json", "--body", "b.obj", "--out", "o", "--threads", "0"],
        &["regenerate", "t.json", "--body", "b.obj", "--out", "o", "--quiet", "--verbose"],
        &["batch", "t.json", "--bodies", "b"],
        &["features"],
        &["features", "a.obj", "b.obj"],
        &["form"],
        &["form", "--bust", "wide", "-o", "f.obj"],
        &["check"],
        &["info", "--volume", "a.obj"],
        &["flatten", "a.obj"],
        &["deflate", "a.obj"],
        &["deflate", "-o", "b.obj"],
        &["deflate", "a.obj", "-o", "b.obj", "--simplify", "0"],
        &["deflate", "a.obj", "-o", "b.obj", "--keep", "first"],
        &["deflate", "a.obj", "-o", "b.obj", "--elements", "s8"],
        &["thicken", "a.obj", "--thickness", "2"],
        &["thicken", "a.obj", "-o", "b.obj"],
        &["thicken", "--thickness", "2", "-o", "b.obj"],
        &["thicken", "a.obj", "-o", "b.obj", "--thickness", "thick"],
        &["thicken", "a.obj", "-o", "b.obj", "--thickness", "0"],
        &["thicken", "a.obj", "-o", "b.obj", "--thickness", "-1"],
        &["thicken", "a.obj", "-o", "b.obj", "--thickness", "nan"],
        &["thicken", "a.obj", "-o", "b.obj", "--thickness", "2", "--side", "inner"],
        &["thicken", "a.obj", "-o", "b.obj", "--thickness", "2", "--corners", "sharp"],
        &["thicken", "a.obj", "-o", "b.obj", "--thickness", "2", "--patch-thickness", "floor"],
        &["thicken", "a.obj", "-o", "b.obj", "--thickness", "2", "--thickness-file", "t.json"],
        &["thicken", "a.obj", "-o", "b.obj", "--thickness", "2", "--mitre-limit", "0.5"],
        &["thicken", "a.obj", "-o", "b.obj", "--thickness", "2", "--chord", "inf"],
        &["model"],
        &["bends"],
        &["bends", "a.obj", "--facets", "all"],
        &["unfold", "a.obj"],
        &["unfold", "-o", "a.dxf"],
        &["unfold", "a.obj", "-o", "a.dxf", "--thickness", "0"],
        &["unfold", "a.obj", "-o", "a.dxf", "--radius", "-1"],
        &["unfold", "a.obj", "-o", "a.dxf", "--k-factor", "1.5"],
        &["unfold", "a.obj", "-o", "a.dxf", "--relief", "star"],
        &["unfold", "a.obj", "-o", "a.dxf", "--layer", "top"],
        &["render", "a.obj", "-o", "a.png", "--view", "inside"],
        &["render", "a.obj"],
    ];
    for call in calls {
        toile(call).refused(2, "");
    }
    assert_eq!(toile::<&str>(&[]).code, Some(2), "no words at all");
}

#[test]
fn words_that_only_the_program_can_judge_are_refused_too() {
    let folder = Folder::new("judged-words");
    let form = word(form());
    let dress = word(dress());
    let out = folder.join("out");
    for shard in ["0/3", "4/3", "1/0", "1", "a/b", "1/2/3", "-1/2"] {
        let shard = format!("--shard={shard}");
        toile(&["batch", dress, "--bodies", form, "--out", word(&out), &shard]).refused(2, "shard");
    }
    for size in ["0x100", "100x0", "100", "axb", "-5x5", "100x100x100"] {
        let size = format!("--size={size}");
        let picture = folder.join("a.png");
        toile(&["render", form, "-o", word(&picture), &size]).refused(2, "size");
    }
    let wrong_kind = [
        vec!["render", form, "-o", "a.jpg"],
        vec!["flatten", form, "-o", "a.docx"],
        vec!["flatten", form, "-o", "a"],
        vec!["form", "--bust", "90", "-o", "a.docx"],
        vec!["thicken", form, "--thickness", "2", "-o", "a.docx"],
        vec!["thicken", form, "--thickness", "2", "-o", "a"],
        vec!["deflate", form, "-o", "a.docx"],
        vec!["deflate", form, "-o", "a.obj", "--vtk", "a.vtu"],
        vec!["flatten", form, "-o", "a.svg", "--cut", "1-x"],
        vec!["flatten", form, "-o", "a.svg", "--cut", "0-1"],
    ];
    for call in wrong_kind {
        let call: Vec<String> = call
            .iter()
            .map(|w| {
                if w.starts_with("a.") || *w == "a" {
                    word(&folder.join(w)).to_owned()
                } else {
                    (*w).to_owned()
                }
            })
            .collect();
        toile(&call).refused(2, "");
    }
    assert_eq!(folder.list(), Vec::<String>::new(), "nothing was written");
}
