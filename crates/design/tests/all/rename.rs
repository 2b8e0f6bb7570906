//! Other names: everything that refers to them follows, and back they give the draft that was.

use design::draft::{Draft, Edit, EditError, Named, edges};

fn sample(name: &str) -> Draft {
    Draft::from_bytes(&std::fs::read(format!("../../samples/{name}")).unwrap()).unwrap()
}

fn rename(kind: Named, from: &str, to: &str) -> Edit {
    Edit::Rename { kind, from: from.to_owned(), to: to.to_owned() }
}

/// Whether a text of JSON has this as a whole word.
fn says(draft: &Draft, word: &str) -> bool {
    serde_json::to_string(&draft.template).unwrap().contains(&format!("\"{word}\""))
}

#[test]
fn every_name_changes_wherever_it_stands_and_back() {
    let joints = std::fs::read_dir("../../samples/joints").unwrap().flatten().map(|e| e.path());
    let first = joints.filter(|p| p.extension().is_some_and(|e| e == "json")).min().unwrap();
    let listed = format!("joints/{}", first.file_name().unwrap().to_string_lossy());
    for file in ["princess-dress.json", "fitted-bodice.json", &listed] {
        let mut draft = sample(file);
        let ends = {
            let mut nodes = draft.template.nodes.keys();
            [nodes.next().unwrap().clone(), nodes.next_back().unwrap().clone()]
        };
        let wire = Edit::CreateEdge { from: ends[0].clone(), to: ends[1].clone() };
        draft = wire.apply(&draft).unwrap();
        let t = &draft.template;
        let all = (t.nodes.keys().map(|n| (Named::Node, n)))
            .chain(t.surfaces.keys().map(|n| (Named::Surface, n)))
            .chain(t.lines.keys().map(|n| (Named::Line, n)));
        // What nodes and lines say of the body's features is no name of theirs.
        let of_body: Vec<_> = t.nodes.values().map(|n| (&n.at, &n.slide, &n.level)).collect();
        let features = serde_json::to_string(&of_body).unwrap();
        let mut count = 0;
        for (kind, name) in all {
            // Names of different kinds may be the same word; such a word stays.
            let kinds =
                [t.nodes.contains_key(name), t.surfaces.contains_key(name), t.lines.contains_key(name)];
            let is_shared = kinds.iter().filter(|k| **k).count() > 1;
            let is_word = is_shared || t.ease.contains_key(name) || features.contains(&format!("\"{name}\""));
            let new = format!("{name}_zz");
            let renamed = rename(kind, name, &new).apply(&draft).unwrap();
            assert!(says(&renamed, &new), "{file} {name}");
            assert!(is_word || !says(&renamed, name), "{file}: {name} is still there");
            if let Some(rest) = name.strip_prefix("left_").filter(|_| t.mirrored) {
                assert!(is_word || !says(&renamed, &format!("right_{rest}")), "{file}: the twin of {name}");
            }
            assert_eq!(edges(&renamed.template).len(), edges(t).len());
            assert_eq!(rename(kind, &new, name).apply(&renamed).unwrap(), draft, "{file} {name}");
            count += 1;
        }
        assert!(count > 10, "{file}");
    }
}

#[test]
fn names_that_cannot_be_are_refused() {
    let draft = sample("princess-dress.json");
    assert!(draft.template.mirrored);
    let nodes: Vec<&String> = draft.template.nodes.keys().collect();
    let left = nodes.iter().find(|n| n.starts_with("left_")).unwrap();
    let centre = nodes.iter().find(|n| !n.starts_with("left_")).unwrap();
    let why = |from: &str, to: &str| rename(Named::Node, from, to).apply(&draft).unwrap_err();
    assert!(matches!(why(left, "side"), EditError::Value { .. }), "it would lose its twin");
    assert!(matches!(why(centre, "left_thing"), EditError::Value { .. }), "it would gain one");
    assert!(matches!(why(left, "right_thing"), EditError::Value { .. }));
    assert!(matches!(
        why(centre, nodes.iter().rfind(|n| !n.starts_with("left_")).unwrap()),
        EditError::Taken { .. }
    ));
    assert!(matches!(why("nobody", "somebody"), EditError::Missing { .. }));
    assert!(matches!(why(centre, " "), EditError::Template(_)));
    let name = Edit::NameJoint { joint: 0, name: Some("spine".to_owned()) };
    assert!(matches!(name.apply(&draft), Err(EditError::Value { .. })), "joints make themselves here");
}
