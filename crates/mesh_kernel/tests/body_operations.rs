//! All operators in random order on random bodies: sound after each, counted as declared, taken back and done again bit
//! for bit.
//!
//! `TOILE_RANDOM_OPERATORS=n` runs at least n operators, with progress on the error stream, instead of the usual number.

// A test that cannot go on fails, and a long run says how far it is.
#![allow(clippy::unwrap_used, clippy::print_stderr)]

mod body_support;

use std::sync::atomic::{AtomicU64, Ordering};

use body_support::operations::Source;
use body_support::{add_attributes, add_wires, random_body};
use mesh_kernel::body::edit::{Editor, Operation, Outcome, Refusal};
use mesh_kernel::body::{Body, Counts};
use mesh_kernel::query::Crossings;

/// Operators that run on one body.
const ON_ONE: usize = 150;

/// Operators of a usual run.
const USUAL: u64 = 12_000;

fn start(seed: u64) -> Body {
    let mut source = Source::new(seed);
    let mut body = random_body(source.random.below(4) as u8, seed);
    if body.surfaces().len() > 0 {
        if source.attributes {
            add_attributes(&mut body, &mut source.random);
        }
        if source.random.below(3) == 0 {
            add_wires(&mut body, &mut source.random);
        }
    }
    body
}

/// What the operation adds to the counts, where it says.
fn declared(operation: &Operation, outcome: &Outcome, before: &Body) -> Option<Counts> {
    if let Some(euler) = operation.euler(outcome) {
        return Some(euler.delta());
    }
    let zero = Counts { v: 0, e: 0, f: 0, r: 0, c: 0, ch: 0, cc: 0 };
    match (operation, outcome) {
        (
            Operation::SplitEdge { surface, edge, .. } | Operation::CollapseEdge { surface, edge, .. },
            outcome,
        ) => {
            let faces_at = |s, e: mesh_kernel::body::EdgeId| {
                let body: &Body = before;
                let faces = body.surface(s).edge_faces()[e.index()];
                faces.iter().filter(|f| **f != mesh_kernel::body::NONE).count() as i64
            };
            let partners = before.partners(*surface, *edge);
            let n =
                faces_at(*surface, *edge) + partners.iter().map(|(s, d)| faces_at(*s, d.edge())).sum::<i64>();
            let sign = if matches!(outcome, Outcome::EdgeSplit(_)) { 1 } else { -1 };
            Some(Counts { v: sign, e: sign * (1 + n), f: sign * n, ..zero })
        }
        (
            Operation::SwapEdge { .. }
            | Operation::Compact
            | Operation::MoveNodes { .. }
            | Operation::StoreBackup { .. }
            | Operation::RestoreBackup { .. }
            | Operation::SetPlanar { .. }
            | Operation::RenameSurface { .. }
            | Operation::AddSurface { .. }
            | Operation::AddAttributeNode { .. }
            | Operation::RemoveAttributeNode { .. }
            | Operation::AddAttributeEdge { .. }
            | Operation::RemoveAttributeEdge { .. }
            | Operation::SetAttributes { .. },
            _,
        ) => Some(zero),
        _ => None,
    }
}

fn difference(a: Counts, b: Counts) -> Counts {
    Counts {
        v: a.v - b.v,
        e: a.e - b.e,
        f: a.f - b.f,
        r: a.r - b.r,
        c: a.c - b.c,
        ch: a.ch - b.ch,
        cc: a.cc - b.cc,
    }
}

/// Whether an operation may leave what is wrong in the geometry only.
fn may_bend(operation: &Operation) -> bool {
    match operation {
        Operation::Group(all) => all.iter().any(may_bend),
        Operation::MoveNodes { .. }
        | Operation::RestoreBackup { .. }
        | Operation::SwapEdge { .. }
        | Operation::CollapseEdge { .. }
        | Operation::MakeVertexEdge { .. }
        | Operation::MakeEdge { .. }
        | Operation::MakeEdgeChole { .. }
        | Operation::MakeEdgeKillComplex { .. }
        | Operation::MakeFace { .. }
        | Operation::MakeFaceKillChole { .. }
        | Operation::MakeFaceMakeCavity { .. }
        | Operation::MakeJoint { .. } => true,
        _ => false,
    }
}

const GEOMETRIC: [&str; 4] = ["degenerate_face", "edge_without_length", "radial_order", "duplicate_face"];

/// Whether sheets pass through each other, or lie on each other. No body in space looks so: radial orders about joints may
/// contradict each other then, and the regions that they tell are none.
fn crosses_itself(body: &Body) -> bool {
    let geometric = body.check().iter().any(|d| GEOMETRIC.contains(&d.code()));
    geometric || !Crossings::new(&body.to_tri_mesh()).self_crossing().is_empty()
}

/// What came of a run.
#[derive(Clone, Copy, Debug, Default)]
struct Run {
    done: u64,
    refused: u64,
    /// 1 where the run ended early, on a body that crosses itself.
    crossed: u64,
}

/// Runs operations on the body of a seed.
fn run(seed: u64, operators: usize) -> Run {
    let body = start(seed);
    let fail = |what: &str, editor: &Editor, last: &Operation| -> ! {
        let done = serde_json::to_string(&editor.operations()).unwrap();
        panic!("seed {seed}: {what}\nlast: {}\nall: {done}", serde_json::to_string(last).unwrap());
    };
    let mut source = Source::new(seed ^ 0x0b5e_55ed);
    let mut editor = Editor::new(body.clone());
    let mut bent = !body.check().is_empty();
    let mut counts = body.counts();
    let mut run = Run::default();
    for _ in 0..operators {
        let operation = source.operation(editor.body());
        let before = editor.body().clone();
        let steps = editor.undo_len();
        match editor.apply(&operation) {
            Err(error) => {
                run.refused += 1;
                if editor.body() != &before || editor.undo_len() != steps {
                    fail(&format!("refused ({error}) but something is changed"), &editor, &operation);
                }
                assert!(!error.to_string().is_empty());
            }
            Ok(outcome) => {
                run.done += 1;
                if let Outcome::JointKilled(spec) = &outcome {
                    source.killed.push(spec.clone());
                }
                bent |= may_bend(&operation);
                let defects = editor.body().check();
                let wrong: Vec<_> =
                    defects.iter().filter(|d| !(bent && GEOMETRIC.contains(&d.code()))).collect();
                let now = editor.body().counts();
                let found = difference(now, counts);
                let miscounted = declared(&operation, &outcome, &before).is_some_and(|d| d != found);
                let misjudged = miscounted || wrong.iter().any(|d| d.code() == "identity");
                if bent && misjudged && crosses_itself(editor.body()) {
                    run.crossed = 1;
                    break;
                }
                if !wrong.is_empty() {
                    if let Some(mesh_kernel::body::Defect::AttributeApart { surface, line, at }) =
                        wrong.first()
                    {
                        for b in [&before, editor.body()] {
                            let s = b.surface(*surface);
                            let Some(l) = s.attribute_edges().get(line.index()) else { continue };
                            eprintln!("line {l:?} at {at}");
                            for n in &l.nodes {
                                let n = s.attribute_nodes()[n.index()];
                                eprintln!("{n:?}");
                                if let mesh_kernel::body::AttributeNode::OnEdge { edge, .. } = n {
                                    eprintln!(
                                        "  {:?} {:?}",
                                        s.edges()[edge.index()],
                                        s.edge_faces()[edge.index()]
                                    );
                                }
                            }
                        }
                    }
                    fail(&format!("{wrong:?}"), &editor, &operation);
                }
                if miscounted {
                    fail(&format!("the counts differ by {found}"), &editor, &operation);
                }
                counts = now;
            }
        }
    }
    let end = editor.body().clone();
    let steps = editor.undo_len();
    let operations = editor.operations();
    while editor.undo() {}
    assert!(editor.body() == &body, "seed {seed}: undone is not the start");
    assert_eq!(editor.redo_len(), steps);
    while editor.redo() {}
    assert!(editor.body() == &end, "seed {seed}: done again is not the end");
    let text = serde_json::to_string(&operations).unwrap();
    let read: Vec<Operation> = serde_json::from_str(&text).unwrap();
    assert_eq!(read, operations);
    let mut replay = Editor::new(body);
    for operation in &read {
        replay.apply(operation).unwrap();
    }
    assert!(replay.body() == &end, "seed {seed}: replayed is not the end");
    run
}

#[test]
fn random_operators_keep_bodies_sound_and_are_undone_bit_for_bit() {
    let wanted: Option<u64> = std::env::var("TOILE_RANDOM_OPERATORS").ok().and_then(|n| n.parse().ok());
    let first: u64 = std::env::var("TOILE_RANDOM_SEED").ok().and_then(|n| n.parse().ok()).unwrap_or(0);
    let seed = AtomicU64::new(first);
    let [done, refused, crossed] = [(); 3].map(|()| AtomicU64::new(0));
    let goal = wanted.unwrap_or(USUAL);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while done.load(Ordering::Relaxed) < goal {
                    let run = run(seed.fetch_add(1, Ordering::Relaxed), ON_ONE);
                    let before = done.fetch_add(run.done, Ordering::Relaxed);
                    refused.fetch_add(run.refused, Ordering::Relaxed);
                    crossed.fetch_add(run.crossed, Ordering::Relaxed);
                    if wanted.is_some() && before / 100_000 != (before + run.done) / 100_000 {
                        eprintln!(
                            "{} operators done, {} refused, {} bodies of {} ended across themselves",
                            before + run.done,
                            refused.load(Ordering::Relaxed),
                            crossed.load(Ordering::Relaxed),
                            seed.load(Ordering::Relaxed) - first
                        );
                    }
                }
            });
        }
    });
    let [done, refused, crossed] = [done, refused, crossed].map(AtomicU64::into_inner);
    let bodies = seed.into_inner() - first;
    assert!(done >= goal && refused > done / 20, "{done} operators done, {refused} refused");
    assert!(crossed <= bodies / 4, "{crossed} bodies of {bodies} crossed themselves");
}

#[test]
fn a_group_that_fails_changes_nothing() {
    let body = start(3);
    let mut editor = Editor::new(body.clone());
    let bad = Operation::KillJoint { joint: mesh_kernel::body::JointId(999) };
    let group = Operation::Group(vec![Operation::AddSurface { name: "x".into() }, bad]);
    assert!(matches!(editor.apply(&group), Err(Refusal::Joint(_))));
    assert_eq!((editor.body(), editor.undo_len()), (&body, 0));
}
