//! Joints cut out of joints.

use design::draft::{Draft, Edit, EditError};
use template::format::JointSpec;

fn names(text: &str) -> Vec<String> {
    text.chars().map(|c| c.to_string()).collect()
}

/// A spine of nodes a b c d e with surfaces P Q R S T on all of it, or a ring of them.
fn spine(closed: bool) -> Draft {
    let mut draft =
        Draft::from_bytes(&std::fs::read("../../samples/joints/one-joint.json").unwrap()).unwrap();
    draft.template.joints = Some(vec![joint("PQRST", "abcde", closed)]);
    draft.template.joints.as_mut().unwrap()[0].name = Some("spine".to_owned());
    draft
}

fn joint(surfaces: &str, nodes: &str, closed: bool) -> JointSpec {
    JointSpec { name: None, surfaces: names(surfaces), nodes: names(nodes), closed }
}

fn made(draft: &Draft, surfaces: &str, nodes: &str) -> Result<Vec<(String, String, bool)>, EditError> {
    let edit = Edit::MakeJoint { joint: joint(surfaces, nodes, false) };
    let told = |j: &JointSpec| (j.surfaces.concat(), j.nodes.concat(), j.closed);
    Ok(edit.apply(draft)?.template.joints.unwrap().iter().map(told).collect())
}

fn rows(list: &[(&str, &str)]) -> Vec<(String, String, bool)> {
    list.iter().map(|(s, n)| ((*s).to_owned(), (*n).to_owned(), false)).collect()
}

#[test]
fn a_joint_is_cut_out_of_the_one_that_holds_its_edges() {
    let open = spine(false);
    // Along the chain: what is before and after stays.
    let cut = made(&open, "PQRST", "cd").unwrap();
    assert_eq!(cut, rows(&[("PQRST", "cd"), ("PQRST", "abc"), ("PQRST", "de")]));
    // Across it too: the other surfaces stay joined beside.
    let cut = made(&open, "PR", "ba").unwrap();
    assert_eq!(cut, rows(&[("PR", "ba"), ("QST", "ba"), ("PQRST", "bcde")]));
    // All along it is a split.
    let cut = made(&open, "PQ", "edcba").unwrap();
    assert_eq!(cut, rows(&[("PQ", "edcba"), ("RST", "edcba")]));
    // Of a ring one chain is left.
    let cut = made(&spine(true), "PQRST", "abc").unwrap();
    assert_eq!(cut, rows(&[("PQRST", "abc"), ("PQRST", "cdea")]));
    let cut = made(&spine(true), "PQRST", "deab").unwrap();
    assert_eq!(cut, rows(&[("PQRST", "deab"), ("PQRST", "bcd")]));
    // The name is given once, to the first part that is left.
    let edit = Edit::MakeJoint { joint: joint("PQRST", "cd", false) };
    let all = edit.apply(&open).unwrap().template.joints.unwrap();
    let named: Vec<Option<&str>> = all.iter().map(|j| j.name.as_deref()).collect();
    assert_eq!(named, [None, Some("spine"), None]);
    let name = Edit::NameJoint { joint: 2, name: Some("spine".to_owned()) };
    let twice = name.apply(&edit.apply(&open).unwrap());
    assert!(matches!(twice, Err(EditError::Template(_))));
}

#[test]
fn what_cannot_be_cut_out_is_refused_with_the_joint_in_the_way() {
    let mut draft = spine(false);
    for (surfaces, nodes, word) in [
        ("PQRST", "abcde", "very joint"),
        ("PQRS", "ab", "`T` would be left alone"),
        ("PQX", "ab", "`X` has no part"),
        ("PQ", "dex", "no edge of it"),
    ] {
        let e = made(&draft, surfaces, nodes).unwrap_err();
        assert!(matches!(e, EditError::Held { joint: 0, .. }), "{surfaces} {nodes}: {e}");
        assert!(e.to_string().contains(word) && e.to_string().contains("joint 1 (spine)"), "{e}");
    }
    // Other surfaces at the same edges are nobody's business; nor are other edges.
    draft.template.joints.as_mut().unwrap()[0].surfaces = names("PQ");
    assert_eq!(made(&draft, "RS", "abc").unwrap(), rows(&[("PQ", "abcde"), ("RS", "abc")]));
    assert_eq!(made(&draft, "PQ", "xy").unwrap().len(), 2);
}
