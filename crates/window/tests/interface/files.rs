//! Files: opened whole or not at all, saved as what they are, and work that survives.

use std::path::{Path, PathBuf};

use design::draft::{Draft, FileKind, History, journal};
use eframe::egui::{Key, Modifiers};
use window::Designer;

use crate::from_nothing::half_skirt;
use crate::support::Window;

fn drop_file(window: &mut Window, path: &Path) {
    window.drop_on(path);
    window.steps();
}

#[test]
fn bad_files_are_one_message_and_change_nothing() {
    let mut window = half_skirt();
    window.wait(Designer::is_built);
    window.keys(Modifiers::COMMAND, Key::S);
    let own = window.folder.path().join("own.toile");
    window.write("Path", &own.display().to_string());
    window.click("Save");
    assert!(own.is_file(), "{}", window.message());
    let bytes = window.draft().to_bytes();
    let text = String::from_utf8(bytes.clone()).unwrap();
    let newer = text.replace("\"toile_draft\":1", "\"toile_draft\":9");
    let cases: [(&str, &[u8]); 7] = [
        ("cut.toile", &bytes[..bytes.len() / 2]),
        ("newer.toile", newer.as_bytes()),
        ("foreign.json", b"{\"type\": \"FeatureCollection\"}"),
        ("empty.toile", b""),
        ("noise.toile", &[0xff, 0x00, 0x13, 0x37]),
        ("broken.obj", b"v 1 2\nf 1 2 3\n"),
        ("cut.journal", &bytes[..40]),
    ];
    for (name, content) in cases {
        let path = window.folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        drop_file(&mut window, &path);
        assert!(window.message().contains("was not opened"), "{name}: {}", window.message());
        assert_eq!(window.draft().to_bytes(), bytes, "{name}");
    }
    drop_file(&mut window, &PathBuf::from("/nowhere/at/all.toile"));
    assert!(window.message().contains("was not opened"), "{}", window.message());
}

#[test]
fn a_draft_is_saved_in_its_place_and_a_template_asks() {
    let folder = tempfile::tempdir().unwrap();
    let template = format!("{}/../../samples/fitted-bodice.json", env!("CARGO_MANIFEST_DIR"));
    let copy = folder.path().join("bodice.json");
    std::fs::copy(&template, &copy).unwrap();
    let (draft, kind) = Draft::read(&std::fs::read(&copy).unwrap()).unwrap();
    assert_eq!(kind, FileKind::Template);
    let mut window = Window::open(draft, Some((copy.clone(), kind)), folder);
    window.keys(Modifiers::COMMAND, Key::S);
    assert!(window.has("Path"), "it asks");
    window.click("Save");
    let saved = window.folder.path().join("bodice.toile");
    assert_eq!(Draft::read(&std::fs::read(&saved).unwrap()).unwrap().1, FileKind::Draft);
    assert_eq!(std::fs::read(&copy).unwrap(), std::fs::read(&template).unwrap(), "the template is as it was");
    window.key(Key::M);
    window.keys(Modifiers::COMMAND, Key::S);
    assert!(!window.has("Path"), "it does not ask again");
    assert_eq!(Draft::from_bytes(&std::fs::read(&saved).unwrap()).unwrap(), *window.draft());
}

/// A window with a skirt in a file of its own, and the file.
fn saved_skirt() -> (Window, PathBuf) {
    let mut window = half_skirt();
    window.wait(Designer::is_built);
    let path = window.folder.path().join("own.toile");
    window.keys(Modifiers::COMMAND, Key::S);
    window.write("Path", &path.display().to_string());
    window.click("Save");
    assert!(path.is_file(), "{}", window.message());
    (window, path)
}

#[test]
fn a_file_that_something_else_has_written_is_not_overwritten_unasked() {
    let (mut window, path) = saved_skirt();
    // The window's own writing is no reason to ask.
    window.key(Key::M);
    window.keys(Modifiers::COMMAND, Key::S);
    assert!(!window.has("Save over it") && window.message().contains("saved"), "{}", window.message());
    window.key(Key::M);
    std::fs::write(&path, "by another program").unwrap();
    let text = || std::fs::read_to_string(&path).unwrap();
    window.keys(Modifiers::COMMAND, Key::S);
    window.click("Go on working");
    assert_eq!(text(), "by another program");
    window.keys(Modifiers::COMMAND, Key::S);
    window.click("Save under another name");
    let other = path.with_file_name("other.toile");
    window.write("Path", &other.display().to_string());
    window.click("Save");
    assert_eq!(text(), "by another program");
    assert_eq!(Draft::from_bytes(&std::fs::read(&other).unwrap()).unwrap(), *window.draft());
    window.key(Key::M);
    std::fs::write(&other, "by another program").unwrap();
    window.keys(Modifiers::COMMAND, Key::S);
    window.click("Save over it");
    assert_eq!(Draft::from_bytes(&std::fs::read(&other).unwrap()).unwrap(), *window.draft());
}

/// The journals of a window.
fn journals(window: &Window) -> Vec<PathBuf> {
    let files = std::fs::read_dir(window.folder.path().join("state")).unwrap().flatten().map(|e| e.path());
    files.filter(|p| p.extension().is_some_and(|e| e == "journal")).collect()
}

#[test]
fn saved_work_leaves_no_journal_and_later_work_one_of_its_file() {
    let (mut window, path) = saved_skirt();
    let wait_for = |window: &mut Window, count: usize| {
        let started = std::time::Instant::now();
        while journals(window).len() != count {
            assert!(started.elapsed().as_secs() < 5, "{:?}", journals(window));
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
    };
    wait_for(&mut window, 0);
    window.key(Key::M);
    wait_for(&mut window, 1);
    // Undone, the file holds it all.
    window.keys(Modifiers::COMMAND, Key::Z);
    wait_for(&mut window, 0);
    window.key(Key::M);
    wait_for(&mut window, 1);
    // As a kill would leave it: the journal without its program.
    let folder = tempfile::tempdir().unwrap();
    let state = folder.path().join("state");
    std::fs::create_dir_all(&state).unwrap();
    std::fs::copy(&journals(&window)[0], state.join("1-1.journal")).unwrap();
    let draft = window.draft().clone();
    drop(window);
    let mut window = Window::open(Draft::empty(), None, folder);
    let labels = window.labels();
    assert!(labels.iter().any(|l| l.contains(&format!("of {}", path.display()))), "{labels:?}");
    window.click("Recover");
    assert_eq!(*window.draft(), draft);
    // The folder of the window before is gone, and the file with it: it is written again without a question.
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    window.keys(Modifiers::COMMAND, Key::S);
    assert!(!window.has("Path"), "it knows its file");
    assert_eq!(Draft::from_bytes(&std::fs::read(&path).unwrap()).unwrap(), draft);
    std::fs::remove_dir_all(path.parent().unwrap()).unwrap();
}

#[test]
fn a_mesh_that_is_no_body_is_there_to_be_looked_at() {
    let tray = format!("{}/../../samples/desk-tray.obj", env!("CARGO_MANIFEST_DIR"));
    let mesh = mesh_kernel::files::read(Path::new(&tray)).unwrap();
    let body = design::draft::Mesh {
        file: "desk-tray.obj".to_owned(),
        positions: mesh.positions.iter().map(|p| p.to_array()).collect(),
        faces: mesh.faces.clone(),
    };
    let body = std::sync::Arc::new(design::draft::BodySource::Mesh(body));
    let draft = Draft { body, ..Draft::empty() };
    let mut window = Window::with_model(draft.clone(), mesh);
    let said = window.message();
    assert!(
        said.contains("desk-tray.obj is shown as a mesh to look at") && said.contains("no body"),
        "{said}"
    );
    // It fills the view, in the colours of its patches.
    let middle = window.at("3D view");
    let picture = window.harness.render().unwrap();
    let mut colors = std::collections::BTreeSet::new();
    for (dx, dy) in (-150i32..150).step_by(10).flat_map(|x| (-150i32..150).step_by(10).map(move |y| (x, y))) {
        let pixel = picture.get_pixel((middle.x as i32 + dx) as u32, (middle.y as i32 + dy) as u32);
        colors.insert(pixel.0);
    }
    assert!(colors.len() > 3, "{colors:?}");
    assert_eq!(*window.draft(), draft, "nothing is changed by it");
    // A body takes its place.
    let form = format!("{}/../../samples/form-12.obj", env!("CARGO_MANIFEST_DIR"));
    drop_file(&mut window, Path::new(&form));
    window.wait(|d| d.message().is_some_and(|m| m.contains("is the body now")) && d.is_idle());
}

#[test]
fn an_export_into_a_file_is_not_offered() {
    let mut window = half_skirt();
    window.wait(Designer::is_built);
    let file = window.folder.path().join("a-file");
    std::fs::write(&file, "what was there").unwrap();
    window.keys(Modifiers::COMMAND, Key::E);
    window.write("Path", &file.display().to_string());
    window.steps();
    assert!(window.has("That is a file: write the name of a folder."), "{:?}", window.labels());
    assert!(!window.has("Export over the file that is there"));
    window.key(Key::Enter);
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "what was there");
}

#[test]
fn unsaved_work_is_asked_for_before_another_file_is_opened() {
    let mut window = half_skirt();
    let before = window.draft().clone();
    let other = format!("{}/../../samples/fitted-bodice.json", env!("CARGO_MANIFEST_DIR"));
    drop_file(&mut window, Path::new(&other));
    assert_eq!(*window.draft(), before);
    window.click("Go on working");
    assert_eq!(*window.draft(), before);
    drop_file(&mut window, Path::new(&other));
    window.click("Do not save");
    assert_ne!(*window.draft(), before);
    window.wait(Designer::is_built);
    // Nothing has changed since: the next one is opened at once.
    window.keys(Modifiers::COMMAND, Key::N);
    assert_eq!(*window.draft(), Draft::empty());
}

#[test]
fn a_mesh_that_is_dropped_is_the_body_and_can_be_undone() {
    let mut window = Window::new(Draft::empty());
    let form = format!("{}/../../samples/form-12.obj", env!("CARGO_MANIFEST_DIR"));
    drop_file(&mut window, Path::new(&form));
    window.wait(Designer::is_idle);
    assert_eq!(window.draft().body.name(), "form-12.obj");
    window.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(*window.draft(), Draft::empty());
}

#[test]
fn work_that_a_killed_window_left_is_offered_and_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let state = folder.path().join("state");
    std::fs::create_dir_all(&state).unwrap();
    let history = {
        let mut history = History::new(Draft::empty());
        let edit = design::draft::Edit::CreateNode {
            name: "left_one".to_owned(),
            node: template::format::NodeSpec {
                at: Some(template::format::At::Point("left_armpit".to_owned())),
                ..Default::default()
            },
        };
        history.apply(design::draft::Command::Edit(edit)).unwrap();
        history
    };
    // A number beyond any process's.
    let left = state.join("4294967294-1.journal");
    std::fs::write(&left, journal::to_bytes(&history)).unwrap();
    let mut window = Window::open(Draft::empty(), None, folder);
    let labels = window.labels();
    let told = labels.iter().any(|l| l.contains("1 changes, the last: create node left_one"));
    assert!(told, "{labels:?}");
    window.click("Recover");
    assert_eq!(window.draft(), &**history.draft());
    assert!(!left.exists(), "the new journal holds it now");
    let own: Vec<_> = std::fs::read_dir(&state).unwrap().flatten().map(|e| e.path()).collect();
    let kept = own.iter().find(|p| p.extension().is_some_and(|e| e == "journal")).expect("a journal");
    assert_eq!(journal::replay(&std::fs::read(kept).unwrap()).unwrap().draft(), history.draft());
}

#[test]
fn the_garment_becomes_a_solid_of_the_thickness_that_is_written() {
    let mut window = Window::new(Draft::empty());
    window.action("Thicken");
    assert!(window.message().contains("no garment yet"), "{}", window.message());
    let mut window = half_skirt();
    window.wait(Designer::is_built);
    let path = window.folder.path().join("skirt.obj");
    let volume = |window: &mut Window, thickness: &str| {
        let _ = std::fs::remove_file(&path);
        window.action("Thicken");
        window.write("Thickness", thickness);
        window.write("Path", &path.display().to_string());
        window.click("Thicken");
        window.wait(|d| d.is_idle());
        assert!(window.message().contains("solid of"), "{}", window.message());
        let solid = mesh_kernel::files::read(&path).unwrap();
        let corner = |v: u32| solid.positions[v as usize];
        let six: f64 = solid.faces.iter().map(|f| corner(f[0]).cross(corner(f[1])).dot(corner(f[2]))).sum();
        six / 6.0
    };
    let [thin, thick] = ["1", "3"].map(|t| volume(&mut window, t));
    assert!((2.8..3.2).contains(&(thick / thin)), "{thin} {thick}");
    window.action("Thicken");
    window.write("Path", "/tmp/skirt.txt");
    window.click("Thicken");
    window.wait(|d| d.is_idle());
    assert!(window.message().contains("must end in"), "{}", window.message());
}

#[test]
fn an_export_that_is_stopped_writes_nothing() {
    let mut window = half_skirt();
    window.wait(Designer::is_built);
    let folder = window.folder.path().join("skirt.export");
    window.keys(Modifiers::COMMAND, Key::E);
    window.write("Path", &folder.display().to_string());
    window.key(Key::Enter);
    assert!(window.has("exporting"), "{}", window.message());
    window.click("Stop");
    assert!(window.message().contains("nothing is written"), "{}", window.message());
    assert!(window.harness.state().is_idle() && !window.has("exporting"));
    // The next one goes on as ever.
    window.keys(Modifiers::COMMAND, Key::E);
    window.write("Path", &folder.display().to_string());
    assert!(!folder.exists());
    window.key(Key::Enter);
    window.wait(Designer::is_idle);
    assert!(folder.join("report.json").is_file(), "{}", window.message());
}

#[test]
fn solids_and_sheets_go_from_file_to_file() {
    let mut window = Window::new(Draft::empty());
    let tray = format!("{}/../../samples/desk-tray.obj", env!("CARGO_MANIFEST_DIR"));
    let at = |window: &Window, name: &str| window.folder.path().join(name);
    let said = |window: &mut Window, what: &str| {
        window.wait(|d| d.message().is_some_and(|m| m.contains(what)));
        window.message()
    };
    // A folded sheet is laid flat.
    window.action("Flat plates of a sheet");
    window.write("Path", &tray);
    // The list of the folder comes, and the dialog finds its size.
    window.steps();
    window.steps();
    window.click("Next");
    let drawing = at(&window, "tray.dxf");
    window.write("Path", &drawing.display().to_string());
    window.click("Lay it flat");
    let text = said(&mut window, "plates with");
    assert!(text.contains("bends"), "{text}");
    assert!(std::fs::read_to_string(&drawing).unwrap().trim_end().ends_with("EOF"));
    // A solid of the same sheet has it for its middle.
    let sheet = mesh_kernel::files::read(Path::new(&tray)).unwrap();
    let options = sheet::thicken::ThickenOptions::new(2.0);
    let thick = sheet::thicken::thicken(&sheet, &options, &sheet::thicken::Nobody).unwrap();
    let format = mesh_kernel::files::Format::Obj;
    let solid = at(&window, "tray-solid.obj");
    std::fs::write(&solid, mesh_kernel::files::to_bytes(format, &thick.solid, &Default::default())).unwrap();
    window.action("Mid-surface of a solid");
    window.write("Path", &solid.display().to_string());
    window.steps();
    window.steps();
    window.click("Next");
    window.click("Make the mid-surface");
    let text = said(&mut window, "mid-surface of");
    assert!(text.contains("10 patches"), "{text}");
    assert!(at(&window, "tray-solid-mid.obj").is_file());
    let thickness = std::fs::read_to_string(at(&window, "tray-solid-mid.thickness.json")).unwrap();
    assert!(thickness.starts_with('['), "{thickness:.40}");
    // What is no solid is told, and nothing is written.
    window.action("Mid-surface of a solid");
    window.write("Path", &tray);
    window.steps();
    window.steps();
    window.click("Next");
    window.write("Path", &at(&window, "none.obj").display().to_string());
    window.click("Make the mid-surface");
    said(&mut window, "open");
    assert!(!at(&window, "none.obj").exists());
    assert_eq!(*window.draft(), Draft::empty());
}
