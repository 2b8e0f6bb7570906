//! All operators in random order on random bodies: sound after each, counted as declared, taken back and done again bit
//! for bit.
//!
//! `TOILE_RANDOM_OPERATORS=n` runs at least n operators, with progress on the error stream, instead of the usual number.

// A long run says how far it is.
#![allow(clippy::print_stderr)]

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::body::support::operations::Source;
use crate::body::support::{add_attributes, add_wires, random_body};
use mesh_kernel::body::edit::{Editor, Operation, Outcome, Refusal, minimise};
use mesh_kernel::body::{Body, Counts};
use mesh_kernel::query::Crossings;

/// Operators that run on one body.
const ON_ONE: usize = 150;

/// Bodies of a usual run, and operators that must have been carried out on them.
const USUAL: (u64, u64) = (400, 20_000);

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
        | Operation::MakeJoint { .. }
        | Operation::KillJoint { .. } => true,
        _ => false,
    }
}

const GEOMETRIC: [&str; 4] = ["degenerate_face", "edge_without_length", "radial_order", "duplicate_face"];

/// Whether sheets pass through each other, or lie on each other. No body in space looks so: radial orders about joints may
/// contradict each other then, and the regions that they tell are none.
fn crosses_itself(body: &Body) -> bool {
    let geometric = body.check().iter().any(|d| GEOMETRIC.contains(&d.code()));
    let mesh = body.to_tri_mesh();
    // Sheets that a joint no longer holds lie in one place still, or pass through each other there.
    let mut places: Vec<_> = mesh.positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect();
    places.sort_unstable();
    let touches = places.windows(2).any(|w| w[0] == w[1]);
    // The same for edges whose ends other joints still hold.
    let weld = body.weld();
    let mut edges = Vec::new();
    for (id, s) in body.surfaces() {
        for e in s.live_edges() {
            if body.partners(id, e).iter().all(|(t, d)| (id, e) < (*t, d.edge())) {
                let mut ends = s.edges()[e.index()].map(|v| weld.node(id, v));
                ends.sort_unstable();
                edges.push(ends);
            }
        }
    }
    edges.sort_unstable();
    let touches = touches || edges.windows(2).any(|w| w[0] == w[1]);
    geometric || touches || !Crossings::new(&mesh).self_crossing().is_empty()
}

/// A body under operations, each of which is checked.
struct Checked {
    start: Body,
    editor: Editor,
    /// Whether the geometry may be wrong.
    bent: bool,
    counts: Counts,
    /// By operator: carried out, refused.
    tally: BTreeMap<String, [u64; 2]>,
    /// The body crosses itself, and its counts are no longer those of a body in space.
    crossed: bool,
}

impl Checked {
    fn new(start: Body) -> Self {
        let editor = Editor::new(start.clone());
        let (bent, counts) = (!start.check().is_empty(), start.counts());
        Self { start, editor, bent, counts, tally: BTreeMap::new(), crossed: false }
    }

    /// Tries an operation; what it made, or what is wrong.
    fn step(&mut self, operation: &Operation) -> Result<Option<Outcome>, String> {
        let before = self.editor.body().clone();
        let steps = self.editor.undo_len();
        let name = format!("{operation:?}");
        let name = name.split([' ', '(']).next().unwrap().to_owned();
        let tally = self.tally.entry(name).or_default();
        let outcome = match self.editor.apply(operation) {
            Ok(outcome) => outcome,
            Err(error) => {
                tally[1] += 1;
                if self.editor.body() != &before || self.editor.undo_len() != steps {
                    return Err(format!("refused ({error}) but something is changed"));
                }
                return Ok(None);
            }
        };
        tally[0] += 1;
        self.bent |= may_bend(operation);
        let now = self.editor.body().counts();
        let found = difference(now, self.counts);
        self.counts = now;
        let miscounted = declared(operation, &outcome, &before).is_some_and(|d| d != found);
        let defects = self.editor.body().check();
        let misjudged = miscounted || defects.iter().any(|d| d.code() == "identity");
        if self.bent && misjudged && crosses_itself(self.editor.body()) {
            self.crossed = true;
            return Ok(Some(outcome));
        }
        let wrong: Vec<_> =
            defects.iter().filter(|d| !(self.bent && GEOMETRIC.contains(&d.code()))).collect();
        if !wrong.is_empty() {
            return Err(format!("{wrong:?}"));
        }
        if miscounted {
            return Err(format!("the counts differ by {found}"));
        }
        Ok(Some(outcome))
    }

    /// Everything taken back, done again, saved, read and replayed.
    fn finish(mut self) -> Result<(), String> {
        let rule = |holds: bool, what: &str| if holds { Ok(()) } else { Err(what.to_owned()) };
        let end = self.editor.body().clone();
        let steps = self.editor.undo_len();
        let operations = self.editor.operations();
        while self.editor.undo() {}
        rule(self.editor.body() == &self.start, "undone is not the start")?;
        rule(self.editor.redo_len() == steps, "not all can be done again")?;
        while self.editor.redo() {}
        rule(self.editor.body() == &end, "done again is not the end")?;
        let text = serde_json::to_string(&operations).unwrap();
        let read: Vec<Operation> = serde_json::from_str(&text).unwrap();
        rule(read == operations, "read is not written")?;
        let mut replay = Editor::new(self.start);
        for operation in &read {
            replay.apply(operation).map_err(|e| format!("replay: {e}"))?;
        }
        rule(replay.body() == &end, "replayed is not the end")
    }
}

/// What is wrong with a sequence of operations.
fn fault(seed: u64, operations: &[Operation]) -> Option<String> {
    let mut checked = Checked::new(start(seed));
    for operation in operations {
        if let Err(what) = checked.step(operation) {
            return Some(what);
        }
        if checked.crossed {
            break;
        }
    }
    checked.finish().err()
}

fn fail(seed: u64, what: &str, operations: &[Operation]) -> ! {
    let few = minimise(operations, |o| fault(seed, o).is_some()).unwrap_or_else(|| operations.to_vec());
    let now = fault(seed, &few).unwrap_or_default();
    panic!(
        "seed {seed}: {what}\n{} operations do it ({now}):\n{}",
        few.len(),
        serde_json::to_string(&few).unwrap()
    );
}

/// What came of a run.
#[derive(Clone, Debug, Default)]
struct Run {
    done: u64,
    refused: u64,
    /// 1 where the run ended early, on a body that crosses itself.
    crossed: u64,
    tally: BTreeMap<String, [u64; 2]>,
}

/// Runs operations on the body of a seed.
fn run(seed: u64, operators: usize) -> Run {
    let mut source = Source::new(seed ^ 0x0b5e_55ed);
    let mut checked = Checked::new(start(seed));
    let mut tried = Vec::with_capacity(operators);
    for _ in 0..operators {
        tried.push(source.operation(checked.editor.body()));
        match checked.step(&tried[tried.len() - 1]) {
            Err(what) => fail(seed, &what, &tried),
            Ok(Some(Outcome::JointKilled(spec))) => source.killed.push(spec),
            Ok(_) => {}
        }
        if checked.crossed {
            break;
        }
    }
    let mut run = Run { crossed: u64::from(checked.crossed), ..Run::default() };
    run.tally = std::mem::take(&mut checked.tally);
    for [done, refused] in run.tally.values() {
        run.done += done;
        run.refused += refused;
    }
    if let Err(what) = checked.finish() {
        fail(seed, &what, &tried);
    }
    run
}

#[test]
fn random_operators_keep_bodies_sound_and_are_undone_bit_for_bit() {
    let wanted: Option<u64> = std::env::var("TOILE_RANDOM_OPERATORS").ok().and_then(|n| n.parse().ok());
    let first: u64 = std::env::var("TOILE_RANDOM_SEED").ok().and_then(|n| n.parse().ok()).unwrap_or(0);
    let seed = AtomicU64::new(first);
    let goal = wanted.unwrap_or(USUAL.1);
    // A usual run is always the same.
    let last = if wanted.is_some() { u64::MAX } else { first + USUAL.0 };
    let total = Mutex::new(Run::default());
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while wanted.is_none() || total.lock().unwrap().done < goal {
                    let seed_now = seed.fetch_add(1, Ordering::Relaxed);
                    if seed_now >= last {
                        break;
                    }
                    let run = run(seed_now, ON_ONE);
                    let mut total = total.lock().unwrap();
                    let before = total.done;
                    total.done += run.done;
                    total.refused += run.refused;
                    total.crossed += run.crossed;
                    for (name, [done, refused]) in run.tally {
                        let tally = total.tally.entry(name).or_default();
                        tally[0] += done;
                        tally[1] += refused;
                    }
                    if wanted.is_some() && before / 100_000 != total.done / 100_000 {
                        let bodies = seed.load(Ordering::Relaxed) - first;
                        let Run { done, refused, crossed, .. } = *total;
                        eprintln!(
                            "{done} operators done, {refused} refused, {bodies} bodies, {crossed} crossed"
                        );
                    }
                }
            });
        }
    });
    let bodies = seed.into_inner() - first;
    let Run { done, refused, crossed, tally } = total.into_inner().unwrap();
    if wanted.is_some() {
        eprintln!("{done} operators done, {refused} refused, {bodies} bodies, {crossed} crossed; {tally:?}");
    }
    assert!(done >= goal && refused > done / 20, "{done} operators done, {refused} refused");
    assert!(crossed <= bodies / 20, "{crossed} bodies of {bodies} crossed themselves");
    // Every operator has been carried out.
    let never: Vec<_> = tally.iter().filter(|(_, [done, _])| *done == 0).collect();
    assert!(never.is_empty() && tally.len() >= 42, "{never:?} of {}", tally.len());
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
