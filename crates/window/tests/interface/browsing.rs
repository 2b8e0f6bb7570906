//! The desktop's file dialog: beside the path field, never instead of it, and never in the way.

use std::path::PathBuf;
use std::time::Duration;

use design::draft::Draft;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use window::{FileDialog, FileWish, PathKind};

use crate::support::Window;

fn window(dialog: FileDialog) -> Window {
    Window::with_dialog(Draft::empty(), dialog)
}

fn path(window: &Window) -> String {
    window.harness.get_by_label("Path").value().unwrap()
}

fn saves_beside(wish: &FileWish) -> Option<PathBuf> {
    assert_eq!((wish.kind, wish.name.as_str()), (PathKind::Save, "untitled.toile"));
    Some(wish.folder.join("chosen.toile"))
}

#[test]
fn a_path_that_was_chosen_stands_in_the_field() {
    let mut window = window(saves_beside);
    window.keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    window.click("Browse …");
    let deadline = std::time::Instant::now() + Duration::from_secs(20);
    while !path(&window).ends_with("chosen.toile") {
        assert!(std::time::Instant::now() < deadline, "{}", path(&window));
        window.steps();
    }
    // Nothing is written before a person says so.
    assert!(!PathBuf::from(path(&window)).exists() && window.has("Save"));
}

fn gone(_: &FileWish) -> Option<PathBuf> {
    None
}

fn falls_over(_: &FileWish) -> Option<PathBuf> {
    panic!("as a broken portal might")
}

#[test]
fn without_a_dialog_the_field_is_there_and_says_so() {
    for dialog in [gone as FileDialog, falls_over] {
        let mut window = window(dialog);
        window.keys(Modifiers::COMMAND, Key::O);
        window.click("Browse …");
        let text = "There is no file dialog of the desktop here; write the path.";
        let deadline = std::time::Instant::now() + Duration::from_secs(20);
        while !window.has(text) {
            assert!(std::time::Instant::now() < deadline, "{:?}", window.labels());
            window.steps();
        }
        window.write("Path", "/nowhere.toile");
        assert_eq!(path(&window), "/nowhere.toile");
    }
}

fn never_answers(_: &FileWish) -> Option<PathBuf> {
    std::thread::sleep(Duration::from_secs(3600));
    None
}

#[test]
fn a_dialog_that_never_answers_is_not_waited_for() {
    let mut window = window(never_answers);
    window.keys(Modifiers::COMMAND, Key::O);
    window.click("Browse …");
    window.steps();
    window.steps();
    window.write("Path", "/nowhere.toile");
    window.key(Key::Enter);
    assert!(window.message().contains("was not opened"), "{}", window.message());
}
