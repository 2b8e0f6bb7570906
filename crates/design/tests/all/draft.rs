//! Drafts: commands, undo, journals, files, recovery.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use design::draft::{
    Autosave, BodySource, Command, Draft, DraftFileError, Edit, EditError, FileKind, History, Journal,
    SourceFile, edges, joints, journal, preview,
};
use design::regenerate::Settings;
use proptest::prelude::*;
use template::WarmStart;
use template::format::{At, EaseSpec, NodeSpec};

fn node(curve: &str, line: &str, centre: bool) -> NodeSpec {
    let at = Some(At::Crossing([curve.to_owned(), line.to_owned()]));
    NodeSpec { at, centre, normal: 15.0, ..NodeSpec::default() }
}

/// A skirt from nothing, by commands alone.
fn skirt() -> History {
    let mut history = History::new(Draft::empty());
    let mut names = Vec::new();
    for level in ["waist_tape", "hip_tape"] {
        for (line, side, centre) in
            [("centre_front", "front", true), ("left_side", "left", false), ("centre_back", "back", true)]
        {
            let name = format!("{side}_{level}");
            names.push(name.clone());
            history.apply(Command::Edit(Edit::CreateNode { name, node: node(level, line, centre) })).unwrap();
        }
    }
    let edge = |a: usize, b: usize| Edit::CreateEdge { from: names[a].clone(), to: names[b].clone() };
    for (a, b) in [(0, 1), (1, 2), (3, 4), (4, 5), (0, 3), (1, 4), (2, 5)] {
        history.apply(Command::Edit(edge(a, b))).unwrap();
    }
    for (surface, f) in [("left_front", [0, 3, 4, 1]), ("left_back", [1, 4, 5, 2])] {
        let nodes = f.map(|k| names[k].clone()).to_vec();
        history.apply(Command::Edit(Edit::FillFace { surface: surface.to_owned(), nodes })).unwrap();
    }
    history
}

#[test]
fn a_skirt_from_nothing_is_built() {
    let history = skirt();
    assert!(history.draft().wires.is_empty(), "faces took the wires");
    let on = history.draft().body.load(None).unwrap();
    let made = history.draft().build(&on, &Settings::default(), &|_| true).unwrap();
    assert_eq!(made.pattern.pieces.len(), 4);
    let coarse = preview(history.draft(), &on, 1, &WarmStart::default(), &AtomicBool::new(false)).unwrap();
    assert!(coarse.body.check().is_empty());
}

#[test]
fn refusals_change_nothing_and_say_what_is_in_the_way() {
    let mut history = skirt();
    let before = (history.draft().to_bytes(), history.journal().len());
    let refused = [
        Edit::DeleteNode { name: "front_hip_tape".into() },
        Edit::CreateNode { name: "front_hip_tape".into(), node: node("hip_tape", "centre_front", true) },
        Edit::CreateEdge { from: "front_hip_tape".into(), to: "front_hip_tape".into() },
        Edit::CreateEdge { from: "front_hip_tape".into(), to: "nobody".into() },
        Edit::FillFace { surface: "left_front".into(), nodes: vec!["front_hip_tape".into(); 3] },
        Edit::SetMeasure { name: "waist".into(), value: Some(5.0) },
        Edit::SetMeasure { name: "ear".into(), value: Some(5.0) },
        Edit::SetEase { level: "hip".into(), ease: None },
        Edit::SplitJoint { joint: 0, first: vec!["left_front".into()] },
        Edit::DeleteFace { surface: "left_front".into(), face: 7 },
    ];
    for edit in refused {
        assert!(history.apply(Command::Edit(edit.clone())).is_err(), "{edit:?}");
        assert_eq!(before, (history.draft().to_bytes(), history.journal().len()));
    }
    let error = history.apply(Command::Edit(Edit::DeleteNode { name: "front_hip_tape".into() })).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the node `front_hip_tape` is used by the surface `left_front`; delete that first"
    );
    assert!(matches!(error, EditError::Used { .. }));
}

#[test]
fn a_drag_is_one_entry() {
    let mut history = skirt();
    let depth = history.labels().0.len();
    for k in 0..50 {
        let mut spec = history.draft().template.nodes["front_hip_tape"].clone();
        spec.normal = f64::from(k);
        let edit = Edit::MoveNode { name: "front_hip_tape".into(), node: spec };
        history.apply(if k == 0 { Command::Edit(edit) } else { Command::Continue(edit) }).unwrap();
    }
    assert_eq!(history.labels().0.len(), depth + 1);
    history.apply(Command::Undo).unwrap();
    assert_eq!(history.draft().template.nodes["front_hip_tape"].normal, 15.0);
}

#[test]
fn edges_and_joints_of_the_samples() {
    let text =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../samples/princess-dress.json"))
            .unwrap();
    let draft = Draft::from_bytes(text.as_bytes()).unwrap();
    assert!(edges(&draft.template).len() > 50);
    for joint in joints(&draft.template) {
        assert!(joint.nodes.len() >= 2 && joint.surfaces.len() >= 2);
    }
}

#[test]
fn files_are_whole_or_refused_with_one_message() {
    let bytes = skirt().draft().to_bytes();
    assert_eq!(Draft::from_bytes(&bytes).unwrap().to_bytes(), bytes);
    for cut in (0..bytes.len() - 1).step_by(37) {
        assert!(matches!(Draft::from_bytes(&bytes[..cut]), Err(DraftFileError::Format(_))), "cut at {cut}");
    }
    let text = String::from_utf8(bytes).unwrap();
    let newer = text.replace("\"toile_draft\":1", "\"toile_draft\":7");
    assert!(matches!(Draft::from_bytes(newer.as_bytes()), Err(DraftFileError::Newer { found: 7, .. })));
    let foreign = text.replace("\"body\":{\"form\"", "\"body\":{\"shape\"");
    assert!(matches!(Draft::from_bytes(foreign.as_bytes()), Err(DraftFileError::Format(_))));
    for other in ["", "{}", "[1]", "v 0 0 0\n", "\u{feff}{}"] {
        assert!(Draft::from_bytes(other.as_bytes()).is_err());
    }
}

#[test]
fn a_journal_that_is_left_behind_is_found_and_replayed() {
    let folder = tempfile::tempdir().unwrap();
    let history = skirt();
    // The number of a process says nothing: another one may have it by now, as 1 is always taken.
    for name in ["4294967294-1.journal", "1-1.journal"] {
        std::fs::write(folder.path().join(name), journal::to_bytes(&history)).unwrap();
        let found = design::draft::recoveries(folder.path());
        assert_eq!(found.len(), 1, "{name}");
        let opened = found[0].open().unwrap();
        assert_eq!(opened.history.draft(), history.draft());
        assert_eq!(opened.file, None);
        found[0].discard();
        assert!(design::draft::recoveries(folder.path()).is_empty());
    }
}

#[test]
fn a_journal_whose_program_runs_is_not_offered() {
    let folder = tempfile::tempdir().unwrap();
    let autosave = Autosave::start(folder.path());
    autosave.save_now(&skirt(), None).unwrap();
    assert!(design::draft::recoveries(folder.path()).is_empty());
    // What a program that ended otherwise leaves is its journal and a lock that nobody holds.
    for name in ["9-9.journal", "9-9.lock"] {
        std::fs::write(folder.path().join(name), journal::to_bytes(&skirt())).unwrap();
    }
    let found = design::draft::recoveries(folder.path());
    assert_eq!(found.len(), 1);
    found[0].discard();
    drop(autosave);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn what_is_saved_leaves_no_journal_and_later_work_does() {
    let folder = tempfile::tempdir().unwrap();
    let autosave = Autosave::start(folder.path());
    autosave.save_now(&skirt(), None).unwrap();
    autosave.saved();
    let wait_until = |there: bool| {
        let started = std::time::Instant::now();
        while autosave.path().exists() != there {
            assert!(
                started.elapsed().as_secs() < 5,
                "the journal is not {}",
                if there { "written" } else { "gone" }
            );
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
    };
    wait_until(false);
    // It still runs, and its lock stays.
    assert!(design::draft::recoveries(folder.path()).is_empty());
    assert!(autosave.path().with_extension("lock").exists());
    autosave.changed(&skirt(), None);
    wait_until(true);
    assert!(design::draft::recoveries(folder.path()).is_empty());
    std::fs::write(folder.path().join("8-8.lock"), "").unwrap();
    assert!(design::draft::recoveries(folder.path()).is_empty());
    assert!(!folder.path().join("8-8.lock").exists(), "of a program that ended without work to save");
}

#[test]
fn a_journal_knows_the_file_that_its_work_is_of() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("skirt.toile");
    let history = skirt();
    std::fs::write(&path, history.draft().to_bytes()).unwrap();
    let file = SourceFile::holding(path.clone(), FileKind::Draft, &history.draft().to_bytes());
    let read = Journal::read(&journal::to_bytes_of(&history, Some(&file))).unwrap();
    assert_eq!(read.history.draft(), history.draft());
    assert_eq!(read.file, Some(file.clone()));
    assert!(!file.is_changed());
    std::fs::write(&path, "by another program").unwrap();
    assert!(file.is_changed());
    std::fs::remove_file(&path).unwrap();
    assert!(!file.is_changed(), "nothing can be lost");
}

#[test]
fn autosave_writes_within_five_seconds_and_cleans_up() {
    let folder = tempfile::tempdir().unwrap();
    let autosave = Autosave::start(folder.path());
    let mut history = skirt();
    for k in 0..40 {
        let ease = Some(EaseSpec { ease: f64::from(k), curve: None, surfaces: Vec::new() });
        history.apply(Command::Edit(Edit::SetEase { level: "hip".into(), ease })).unwrap();
        autosave.changed(&history, None);
    }
    let started = std::time::Instant::now();
    loop {
        let saved = std::fs::read(autosave.path()).ok().and_then(|b| journal::replay(&b).ok());
        if saved.is_some_and(|s| s.draft() == history.draft()) {
            break;
        }
        assert!(started.elapsed().as_secs() < 5, "not saved");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    drop(autosave);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// A command from four random numbers; many of them are refused, as a hand's are.
fn command(draft: &Draft, [a, b, c, d]: [usize; 4]) -> Command {
    let pick = |names: Vec<String>, k: usize| names.get(k % names.len().max(1)).cloned().unwrap_or_default();
    let nodes = || draft.template.nodes.keys().cloned().collect::<Vec<_>>();
    let surfaces = || draft.template.surfaces.keys().cloned().collect::<Vec<_>>();
    Command::Edit(match a % 15 {
        0 => {
            Edit::CreateNode { name: format!("left_n{}", b % 9), node: node("hip_tape", "left_side", false) }
        }
        1 => {
            let name = pick(nodes(), b);
            let mut spec = draft.template.nodes.get(&name).cloned().unwrap_or_default();
            spec.normal = c as f64 / 7.0;
            Edit::MoveNode { name, node: spec }
        }
        2 => Edit::DeleteNode { name: pick(nodes(), b) },
        3 => Edit::CreateEdge { from: pick(nodes(), b), to: pick(nodes(), c) },
        4 => Edit::DeleteEdge { from: pick(nodes(), b), to: pick(nodes(), c) },
        5 => Edit::FillFace {
            surface: format!("left_s{}", d % 3),
            nodes: vec![pick(nodes(), b), pick(nodes(), c), pick(nodes(), d)],
        },
        6 => Edit::DeleteFace { surface: pick(surfaces(), b), face: c % 2 },
        7 => Edit::AssignSurface { surface: pick(surfaces(), b), face: 0, to: format!("left_s{}", d % 3) },
        8 => Edit::DeleteSurface { surface: pick(surfaces(), b) },
        9 => Edit::SetEase {
            level: "hip".into(),
            ease: Some(EaseSpec { ease: c as f64, curve: None, surfaces: vec![] }),
        },
        10 => Edit::SetMeasure { name: "waist".into(), value: Some(60.0 + (c % 40) as f64) },
        11 => match draft.template.surfaces.values().next().map(|s| design::draft::faces(s)[0].clone()) {
            Some(f) => Edit::DrawProfile {
                name: format!("left_p{}", b % 3),
                nodes: [f[0].clone(), f[1].clone()],
                points: vec![[0.0; 3], [c as f64, 1.0, d as f64], [0.0, 9.0, 0.0]],
            },
            None => Edit::AutomaticJoints,
        },
        12 => Edit::DeleteProfile { name: format!("left_p{}", b % 3) },
        13 => return Command::Undo,
        _ => return Command::Redo,
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, ..ProptestConfig::default() })]
    #[test]
    fn undone_to_the_start_the_first_draft_comes_back(steps in prop::collection::vec(prop::array::uniform4(0usize..10_000), 1..60)) {
        let start = skirt().draft().as_ref().clone();
        let mut history = History::new(start.clone());
        for step in steps {
            let _ = history.apply(command(history.draft(), step));
        }
        let replayed = journal::replay(&journal::to_bytes(&history)).unwrap();
        prop_assert_eq!(replayed.draft().to_bytes(), history.draft().to_bytes());
        let end = history.draft().to_bytes();
        let mut count = 0;
        while history.undo_label().is_some() {
            history.apply(Command::Undo).unwrap();
            count += 1;
        }
        prop_assert_eq!(history.draft().to_bytes(), start.to_bytes());
        for _ in 0..count {
            history.apply(Command::Redo).unwrap();
        }
        prop_assert_eq!(history.draft().to_bytes(), end);
    }
}

#[test]
fn a_mesh_as_body_has_no_measurements() {
    let mesh =
        design::draft::Mesh { file: "m.obj".into(), positions: vec![[0.0; 3]; 3], faces: vec![[0, 1, 2]] };
    let draft = Draft { body: Arc::new(BodySource::Mesh(mesh)), ..Draft::empty() };
    let edit = Edit::SetMeasure { name: "waist".into(), value: Some(70.0) };
    assert!(edit.apply(&draft).unwrap_err().to_string().contains("mesh"));
}

/// Set for the child of the test below: the folder that it saves into.
const CHILD: &str = "TOILE_TEST_AUTOSAVE_CHILD";

/// Not a test of its own: the program that is killed. It works on and on.
#[test]
fn a_child_that_works_until_it_is_killed() {
    let Some(folder) = std::env::var_os(CHILD) else { return };
    let autosave = Autosave::start(std::path::Path::new(&folder));
    let mut history = skirt();
    for k in 0u32.. {
        let ease = Some(EaseSpec { ease: f64::from(k % 300), curve: None, surfaces: Vec::new() });
        history.apply(Command::Edit(Edit::SetEase { level: "hip".into(), ease })).unwrap();
        autosave.changed(&history, None);
        // Whole in one go: the kill may come at any moment.
        let [new, done] = ["new", "done"].map(|name| std::path::Path::new(&folder).join(name));
        std::fs::write(&new, format!("{k}")).unwrap();
        std::fs::rename(&new, &done).unwrap();
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
}

#[test]
fn a_kill_loses_less_than_five_seconds_of_work() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = std::process::Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "draft::a_child_that_works_until_it_is_killed"])
        .env(CHILD, folder.path())
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_secs(4));
    // SIGKILL: nothing of it can clean up.
    child.kill().unwrap();
    // Nobody has asked yet what became of it: the system still knows its number.
    let started = std::time::Instant::now();
    while design::draft::recoveries(folder.path()).is_empty() && started.elapsed().as_secs() < 5 {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let before_it_is_asked_for = design::draft::recoveries(folder.path()).len();
    child.wait().unwrap();
    assert_eq!(before_it_is_asked_for, 1, "a program that is dead but not yet asked for has left its work");
    let done: usize = std::fs::read_to_string(folder.path().join("done")).unwrap().parse().unwrap();
    let found = design::draft::recoveries(folder.path());
    assert_eq!(found.len(), 1, "one journal, and its program is known to be dead");
    let kept = found[0].open().unwrap().history.labels().1 - skirt().labels().1;
    // A change each 50 ms and more: five seconds are a hundred of them.
    assert!(kept > 0 && done - kept.min(done) < 100, "{kept} of {done}");
}

#[test]
fn edits_together_are_one_entry_and_all_or_none() {
    let mut history = skirt();
    let before = history.draft().to_bytes();
    let depth = history.labels().1;
    let ease = |ease| Some(EaseSpec { ease, curve: None, surfaces: Vec::new() });
    let set = |level: &str, v| Edit::SetEase { level: level.to_owned(), ease: ease(v) };
    let both = |last: Edit| Edit::Together { label: "two".to_owned(), edits: vec![set("hip", 40.0), last] };
    let bad = both(Edit::DeleteNode { name: "nobody".to_owned() });
    assert!(history.apply(Command::Edit(bad)).is_err());
    assert_eq!(history.draft().to_bytes(), before);
    history.apply(Command::Edit(both(set("waist", 50.0)))).unwrap();
    assert_eq!((history.labels().1, history.undo_label()), (depth + 1, Some("two")));
    assert_eq!(journal::replay(&journal::to_bytes(&history)).unwrap().draft(), history.draft());
    history.apply(Command::Undo).unwrap();
    assert_eq!(history.draft().to_bytes(), before);
}

#[test]
fn the_journal_keeps_the_last_value_of_a_drag() {
    let mut history = skirt();
    let lines = history.journal().len();
    for k in 0..500 {
        let ease = Some(EaseSpec { ease: f64::from(k), curve: None, surfaces: Vec::new() });
        let edit = Edit::SetEase { level: "hip".into(), ease };
        history.apply(if k == 0 { Command::Edit(edit) } else { Command::Continue(edit) }).unwrap();
    }
    assert_eq!(history.journal().len(), lines + 2);
    assert_eq!(journal::replay(&journal::to_bytes(&history)).unwrap().draft(), history.draft());
}
