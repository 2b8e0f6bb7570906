//! Journals through their files, and failing ones made short.

use crate::body::support::operations::Source;
use crate::body::support::random_body;
use mesh_kernel::body::edit::{
    CollapseError, Editor, Guard, JournalFile, Operation, Refusal, minimise, minimise_with,
};
use mesh_kernel::body::{Body, BodyFileError, ChainSpec, JointId, JointSpec, NodeId, SurfaceId, SurfaceSpec};
use mesh_kernel::glam::DVec3;

/// So many operators drawn at random and done.
fn edited(seed: u64, operators: usize) -> Editor {
    let mut source = Source::new(seed);
    let mut editor = Editor::new(random_body(source.random.below(3) as u8, seed));
    while editor.undo_len() < operators {
        let operation = source.operation(editor.body());
        // Refused ones do not count.
        let _ = editor.apply(&operation);
    }
    editor
}

#[test]
fn journals_are_carried_out_again_bit_for_bit() {
    for seed in 0..60 {
        let editor = edited(seed, 40);
        let journal = JournalFile::of(&editor);
        assert_eq!(journal.operations, editor.operations());
        let bytes = journal.to_bytes().unwrap();
        let read = JournalFile::from_bytes(&bytes).unwrap();
        assert!(read == journal, "seed {seed}");
        assert_eq!(read.to_bytes().unwrap(), bytes);
        let mut again = read.replay().unwrap();
        assert!(again.body() == editor.body(), "seed {seed}");
        // The bodies on the way go through their own files, free numbers and all.
        while again.undo() {
            let file = again.body().to_file_bytes().unwrap();
            assert!(Body::from_file_bytes(&file).unwrap() == *again.body(), "seed {seed}");
        }
        assert!(*again.body() == journal.start, "seed {seed}");
    }
}

#[test]
fn damaged_journals_are_refused_in_words() {
    let editor = edited(3, 10);
    let text = String::from_utf8(JournalFile::of(&editor).to_bytes().unwrap()).unwrap();
    for (from, to, words) in [
        ("toile-journal", "toile-body", "no toile-journal file"),
        ("\"version\":1,\n\"body\"", "\"version\":7,\n\"body\"", "format version 7"),
        ("toile-body", "toile-flesh", "no toile-body file"),
        ("\"operations\"", "\"operators\"", "unknown field `operators`"),
        ("\"operations\":[\n", "\"operations\":[\n{\"make_coffee\":{}},\n", "unknown variant `make_coffee`"),
    ] {
        assert!(text.contains(from), "{from}");
        let error = JournalFile::from_bytes(text.replacen(from, to, 1).as_bytes()).unwrap_err();
        assert!(error.to_string().contains(words) && error.to_string().len() < 400, "{error}");
    }
    for end in (0..text.len() - 2).step_by(7) {
        let error = JournalFile::from_bytes(&text.as_bytes()[..end]).unwrap_err();
        assert!(matches!(error, BodyFileError::Truncated { .. }), "{end}: {error}");
    }
}

#[test]
fn what_cannot_be_read_or_done_again_is_said() {
    let mut journal = JournalFile { start: Body::default(), operations: vec![] };
    let position = DVec3::new(0.0, f64::NAN, 0.0);
    journal.operations = vec![
        Operation::AddSurface { name: "a".into() },
        Operation::MakeVertexComplex { surface: SurfaceId(0), position },
    ];
    let error = journal.to_bytes().unwrap_err();
    assert!(matches!(error, BodyFileError::OperationNotFinite { number: 1 }), "{error}");
    journal.operations[1] = Operation::KillJoint { joint: JointId(5) };
    let error = journal.replay().unwrap_err();
    assert_eq!((error.number, *error.operation), (1, Operation::KillJoint { joint: JointId(5) }));
    assert!(journal.to_bytes().is_ok());
}

/// The body after as many of the operations as are not refused.
fn carried_out(start: &Body, operations: &[Operation]) -> Body {
    let mut editor = Editor::new(start.clone());
    for operation in operations {
        // What was built on an operation that was left out is refused.
        let _ = editor.apply(operation);
    }
    editor.into_body()
}

#[test]
fn a_broken_rule_is_traced_to_the_operators_that_break_it() {
    // Rules that some operators keep and others do not, in the place of a fault in the kernel.
    let no_number_is_free = |body: &Body| body.surfaces().all(|(_, s)| s.is_compact());
    let few_wires = |body: &Body| {
        let bare = |s: &mesh_kernel::body::Surface| {
            s.live_edges().filter(|e| s.edge_faces()[e.index()] == [mesh_kernel::body::NONE; 2]).count()
        };
        body.surfaces().map(|(_, s)| bare(s)).sum::<usize>() < 4
    };
    let simpler = |operation: &Operation| match operation {
        Operation::Group(all) => all.clone(),
        Operation::SplitEdge { surface, edge, at } if *at != 0.5 => {
            vec![Operation::SplitEdge { surface: *surface, edge: *edge, at: 0.5 }]
        }
        _ => vec![],
    };
    let mut found = 0;
    for seed in 0..30 {
        let journal = JournalFile::of(&edited(seed, 150));
        for (rule, most) in [(&no_number_is_free as &dyn Fn(&Body) -> bool, 8), (&few_wires, 16)] {
            let holds = |operations: &[Operation]| rule(&carried_out(&journal.start, operations));
            let mut calls = 0;
            let short = minimise_with(&journal.operations, simpler, |operations| {
                calls += 1;
                !holds(operations)
            });
            let Some(short) = short else { continue };
            found += 1;
            assert!(short.len() <= most && calls <= 3000, "{calls} calls: {short:?}");
            assert!(!holds(&short));
            for k in 0..short.len() {
                let mut less = short.clone();
                less.remove(k);
                assert!(holds(&less), "{short:?}");
            }
            // What is left is a journal by itself that shows the fault.
            let bytes = JournalFile { start: journal.start.clone(), operations: short }.to_bytes().unwrap();
            assert!(!rule(JournalFile::from_bytes(&bytes).unwrap().replay().unwrap().body()));
        }
    }
    assert!(found > 20, "{found}");
}

#[test]
fn a_fault_planted_among_a_thousand_operators_is_found() {
    let editor = edited(11, 1000);
    let journal = JournalFile::of(&editor);
    // The fault shows where surfaces of two names exist: two culprits far apart. Nobody else gives names.
    let mut operations = journal.operations.clone();
    // No other operator gives names.
    operations.retain(|o| !matches!(o, Operation::RenameSurface { .. } | Operation::Group(_)));
    let far = operations.len() - 50;
    operations.insert(100, Operation::AddSurface { name: "culprit".into() });
    operations.insert(far, Operation::RenameSurface { surface: SurfaceId(0), name: "accomplice".into() });
    let short = minimise(&operations, |operations| {
        let body = carried_out(&journal.start, operations);
        body.surface_named("culprit").is_some() && body.surface_named("accomplice").is_some()
    });
    assert_eq!(short, Some(vec![operations[100].clone(), operations[far].clone()]));
}

#[test]
fn a_node_under_a_joint_without_edges_is_not_collapsed_away() {
    // Found by a random journal: the joint's chains went on naming the node.
    let strip = |name: &str, out: f64| SurfaceSpec {
        name: name.into(),
        positions: (0..5)
            .flat_map(|k| [DVec3::new(0.0, 0.0, f64::from(k)), DVec3::new(out, 0.0, f64::from(k))])
            .collect(),
        faces: (0..4).flat_map(|k| [[2 * k, 2 * k + 1, 2 * k + 3], [2 * k, 2 * k + 3, 2 * k + 2]]).collect(),
    };
    let chain = |surface, nodes: &[u32]| ChainSpec { surface, nodes: nodes.to_vec(), closed: false };
    let seam = JointSpec { name: None, chains: vec![chain(0, &[0, 2, 4, 6, 8]), chain(1, &[0, 2, 4, 6, 8])] };
    let mut editor = Editor::new(Body::build(&[strip("a", 1.0), strip("b", -1.0)], &[seam]).unwrap());
    editor.make_joint(&JointSpec { name: None, chains: vec![chain(0, &[4]), chain(1, &[4])] }).unwrap();
    let edge = editor.body().surface(SurfaceId(0)).edge_index().find(4, 2).unwrap();
    let collapse = |keep| Operation::CollapseEdge {
        surface: SurfaceId(0),
        edge,
        keep: NodeId(keep),
        at: None,
        guard: Guard::None,
    };
    let before = editor.body().clone();
    let refusal = editor.apply(&collapse(2)).unwrap_err();
    assert!(matches!(refusal, Refusal::CollapseEdge(CollapseError::HeldByJoints { .. })), "{refusal}");
    assert!(*editor.body() == before);
    editor.apply(&collapse(4)).unwrap();
    assert_eq!(editor.body().check(), []);
}
