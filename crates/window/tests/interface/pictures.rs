//! Pictures of the whole window, kept small; and one that must not match.

use eframe::egui::Key;
use egui_kittest::SnapshotOptions;

use crate::support::{Window, sample};
use design::draft::Draft;

/// Pictures may differ in a few pixels where processors round otherwise.
fn options() -> SnapshotOptions {
    SnapshotOptions::new().threshold(1.5).max_failed_pixels(60usize)
}

fn small(draft: Draft) -> Window {
    Window::sized([800.0, 560.0], draft, None, tempfile::tempdir().unwrap())
}

#[test]
fn the_node_tool_shows_feature_points() {
    let mut window = small(Draft::empty());
    window.key(Key::N);
    window.steps();
    window.harness.snapshot_options("node-tool", &options());
}

#[test]
fn a_dress_with_its_pattern() {
    let mut window = small(sample("princess-dress.json"));
    window.wait(window::Designer::is_built);
    window.harness.snapshot_options("dress", &options());
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
        let _ = std::fs::remove_file(format!("tests/snapshots/node-tool.{end}.png"));
    }
    assert!(different.is_err(), "a comparison that accepts everything proves nothing");
}
