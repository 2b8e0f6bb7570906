//! A template from nothing in the window alone, from the first node to the cutter's file.

use eframe::egui::{Key, Modifiers};

use crate::support::Window;
use design::draft::Draft;
use window::Designer;

/// A half skirt of two patches: nodes, edges, faces.
pub(crate) fn half_skirt() -> Window {
    half_skirt_in(Window::new(Draft::empty()))
}

pub(crate) fn half_skirt_in(mut window: Window) -> Window {
    window.key(Key::N);
    for name in ["centre_front_waist", "left_side_waist", "left_side_hip", "centre_front_hip"] {
        window.click(&format!("feature point {name}"));
    }
    window.key(Key::F6);
    for name in ["centre_back_waist", "centre_back_hip"] {
        window.click(&format!("feature point {name}"));
    }
    assert_eq!(window.draft().template.nodes.len(), 6, "{}", window.message());

    window.key(Key::F5);
    window.key(Key::E);
    for name in
        ["centre_front_waist", "left_side_waist", "left_side_hip", "centre_front_hip", "centre_front_waist"]
    {
        window.click(&format!("node {name}"));
    }
    assert_eq!(window.draft().wires.len(), 4, "{}", window.message());

    window.key(Key::F);
    window.write("New faces go to", "left_front");
    for name in ["centre_front_waist", "centre_front_hip", "left_side_hip", "left_side_waist"] {
        window.click(&format!("node {name}"));
    }
    window.key(Key::F6);
    window.write("New faces go to", "left_back");
    for name in ["left_side_waist", "left_side_hip", "centre_back_hip", "centre_back_waist"] {
        window.click(&format!("node {name}"));
    }
    assert_eq!(window.draft().template.surfaces.len(), 2, "{}", window.message());
    assert!(window.draft().wires.is_empty(), "faces took the edges");
    window
}

#[test]
fn a_skirt_is_drawn_built_flattened_and_exported() {
    let mut window = half_skirt();
    window.wait(Designer::is_built);
    // Mirrored: four pieces of two patches.
    let garment = window.harness.state();
    assert_eq!(garment.pieces(), 4);

    // The joint at the side is found by itself, and is made smooth.
    window.key(Key::J);
    window.key(Key::F7);
    let joint = "joint 1: left_back + left_front";
    window.click(joint);
    window.click("Smooth across");
    assert_eq!(window.draft().template.fair_across.len(), 1, "{}", window.message());

    // The hem is drawn a little lower.
    window.key(Key::F5);
    window.key(Key::K);
    let [from, to] = ["node centre_front_hip", "node left_side_hip"].map(|n| window.at(n));
    let middle = from + (to - from) * 0.5 + eframe::egui::vec2(0.0, 22.0);
    window.stroke(&[from, middle, to]);
    assert_eq!(window.draft().template.lines.len(), 1, "{}", window.message());
    window.wait(Designer::is_built);

    let folder = window.folder.path().join("skirt.export");
    window.keys(Modifiers::COMMAND, Key::E);
    window.write("Path", &folder.display().to_string());
    window.key(Key::Enter);
    window.wait(Designer::is_idle);
    assert!(window.message().starts_with("exported"), "{}", window.message());
    let dxf = std::fs::read_to_string(folder.join("pattern.dxf")).unwrap();
    assert!(dxf.contains("ENTITIES") && dxf.trim_end().ends_with("EOF"));
    for name in ["garment.obj", "pattern.svg", "pattern.pdf", "report.json", "design.toile"] {
        assert!(folder.join(name).is_file(), "{name}");
    }

    // Back to nothing, entry by entry, and forward again.
    let bytes = window.draft().to_bytes();
    for _ in 0..40 {
        window.keys(Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(window.draft().to_bytes(), Draft::empty().to_bytes());
    for _ in 0..40 {
        window.keys(Modifiers::COMMAND, Key::Y);
    }
    assert_eq!(window.draft().to_bytes(), bytes);
}
