//! Pictures of the whole window, kept small, which the guide shows; and one that must not match.

use eframe::egui::Key;
use egui_kittest::SnapshotOptions;

use crate::board::typed;
use crate::from_nothing::half_skirt_in;
use crate::support::{Window, sample};
use design::draft::Draft;

/// Pictures may differ in a few pixels where processors round otherwise.
fn options() -> SnapshotOptions {
    let guide = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/window");
    SnapshotOptions::new().threshold(1.5).max_failed_pixels(60usize).output_path(guide)
}

fn small(draft: Draft) -> Window {
    Window::sized([760.0, 440.0], draft, None, tempfile::tempdir().unwrap())
}

#[test]
fn the_node_tool_shows_feature_points() {
    let mut window = small(Draft::empty());
    window.key(Key::N);
    window.steps();
    window.harness.snapshot_options("node-tool", &options());
}

#[test]
fn a_skirt_of_two_patches_and_its_pattern() {
    let mut window = half_skirt_in(small(Draft::empty()));
    window.wait(window::Designer::is_built);
    window.key(Key::F5);
    window.key(Key::Num4);
    window.click("joint 1: left_back + left_front");
    window.harness.snapshot_options("skirt", &options());
}

#[test]
fn a_dress_with_its_pattern() {
    let dress = sample("princess-dress.json");
    let mut window = Window::sized([620.0, 340.0], dress, None, tempfile::tempdir().unwrap());
    window.wait(window::Designer::is_built);
    window.harness.snapshot_options("dress", &options());
}

#[test]
fn a_plate_on_the_drawing_board() {
    let mut window = Window::sized([640.0, 360.0], Draft::empty(), None, tempfile::tempdir().unwrap());
    window.key(Key::F3);
    window.key(Key::L);
    for text in ["-60; -45", "120; 0", "0; 55", "-80; 35", "-40; -90"] {
        typed(&mut window, text);
    }
    window.key(Key::Escape);
    window.key(Key::R);
    window.stroke_click(window.at("point 2"));
    window.key(Key::O);
    typed(&mut window, "15; -10");
    typed(&mut window, "15");
    window.key(Key::V);
    window.click("line 3");
    window.click("Level");
    window.key(Key::L);
    window.stroke_click(window.at("point 4"));
    let at = window.at("line 7") + eframe::egui::vec2(2.0, -3.0);
    window.harness.event(eframe::egui::Event::PointerMoved(at));
    window.steps();
    window.harness.snapshot_options("drawing-board", &options());
}

#[test]
fn another_picture_does_not_match() {
    if std::env::var_os("UPDATE_SNAPSHOTS").is_some() {
        // It would be taken for the right one.
        return;
    }
    let mut window = small(Draft::empty());
    window.key(Key::E);
    window.steps();
    let different = window.harness.try_snapshot_options("node-tool", &options());
    // What the comparison leaves of this is of no use to anybody.
    for end in ["diff", "new", "old"] {
        let _ = std::fs::remove_file(format!("../../docs/window/node-tool.{end}.png"));
    }
    assert!(different.is_err(), "a comparison that accepts everything proves nothing");
}
