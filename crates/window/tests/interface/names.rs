//! Names of things, changed in the inspector.

use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;

use crate::from_nothing::half_skirt;
use crate::support::{Window, sample};
use window::Designer;

/// Writes a name into the field that F2 has given the keyboard.
fn rename(window: &mut Window, to: &str) {
    window.key(Key::F2);
    window.harness.event(eframe::egui::Event::Text(to.to_owned()));
    window.steps();
    window.key(Key::Enter);
}

#[test]
fn nodes_surfaces_and_profiles_get_other_names() {
    let mut window = half_skirt();
    window.key(Key::F5);
    window.key(Key::V);
    let before = window.draft().clone();
    window.click("node left_side_hip");
    rename(&mut window, "left_hip");
    assert!(window.draft().template.nodes.contains_key("left_hip"), "{}", window.message());
    let faces = window.draft().template.surfaces["left_front"].faces.clone().unwrap();
    assert!(faces[0].contains(&"left_hip".to_owned()));
    assert!(window.has("node left_hip"), "it is still selected");
    window.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(*window.draft(), before);
    window.keys(Modifiers::COMMAND, Key::Y);

    window.key(Key::Num3);
    let [a, b] = ["node centre_front_waist", "node left_hip"].map(|n| window.at(n));
    window.stroke_click(a + (b - a) * 0.5);
    rename(&mut window, "left_panel");
    assert!(window.draft().template.surfaces.contains_key("left_panel"), "{}", window.message());
    window.write("Piece label", "Front panel");
    window.key(Key::Enter);
    assert_eq!(window.draft().template.pieces["left_panel"].label.as_deref(), Some("Front panel"));

    window.key(Key::K);
    let [from, to] = ["node centre_front_hip", "node left_hip"].map(|n| window.at(n));
    window.stroke(&[from, from + (to - from) * 0.5 + eframe::egui::vec2(0.0, 22.0), to]);
    let middle = window.at("edge centre_front_hip – left_hip");
    window.key(Key::Num2);
    window.stroke_click(middle);
    rename(&mut window, "hem");
    assert!(window.draft().template.lines.contains_key("hem"), "{}", window.message());
    // It is built under its new names.
    window.wait(Designer::is_built);
    assert_eq!(window.harness.state().pieces(), 4);
}

#[test]
fn names_that_cannot_be_are_refused_and_escape_gives_up() {
    let mut window = half_skirt();
    window.key(Key::F5);
    window.key(Key::V);
    let before = window.draft().clone();
    window.key(Key::F2);
    assert!(window.message().contains("have names"), "{}", window.message());
    window.click("node left_side_hip");
    rename(&mut window, "left_side_waist");
    assert!(window.message().contains("already"), "{}", window.message());
    rename(&mut window, "hip");
    assert!(window.message().contains("twin"), "{}", window.message());
    window.key(Key::F2);
    window.harness.event(eframe::egui::Event::Text("left_other".to_owned()));
    window.steps();
    window.key(Key::Escape);
    assert_eq!(*window.draft(), before);
    let field = window.harness.get_by_label("Node name").value();
    assert_eq!(field.as_deref(), Some("left_side_hip"));
    // The design has a name too.
    window.key(Key::Escape);
    window.write("Design name", "Skirt");
    window.key(Key::Enter);
    assert_eq!(window.draft().template.name, "Skirt");
}

#[test]
fn a_joint_is_split_and_named_and_edges_are_cut_out_of_it() {
    let mut draft = sample("joints/one-joint.json");
    draft.template.joints = Some(design::draft::joints(&draft.template));
    let mut window = Window::new(draft);
    window.wait(Designer::is_built);
    let before = window.draft().clone();
    let joints = before.template.joints.as_ref().unwrap().len();
    assert_eq!(before.template.joints.as_ref().unwrap()[0].surfaces.len(), 5);
    window.key(Key::J);
    window.key(Key::X);
    let label = window.labels().into_iter().find(|l| l.starts_with("joint 1: ")).unwrap();
    window.click(&label);
    rename(&mut window, "back");
    assert_eq!(window.draft().template.joints.as_ref().unwrap()[0].name.as_deref(), Some("back"));
    let [a, b] = [0, 1].map(|k| before.template.joints.as_ref().unwrap()[0].surfaces[k].clone());
    window.click(&format!("{a} + {b}"));
    let split = window.draft().template.joints.clone().unwrap();
    assert_eq!((split.len(), split[0].surfaces.len(), split[1].surfaces.len()), (joints + 1, 2, 3));
    assert_eq!(split[0].name.as_deref(), Some("back_first"));
    window.wait(Designer::is_built);
    window.keys(Modifiers::COMMAND, Key::Z);
    window.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(*window.draft(), before);

    // Clicked again the joint is taken edge by edge.
    window.key(Key::Escape);
    window.click(&label);
    let nodes = &before.template.joints.as_ref().unwrap()[0].nodes;
    let [p, q] = [&nodes[0], &nodes[1]];
    let edge = if p < q { format!("edge {p} – {q}") } else { format!("edge {q} – {p}") };
    window.click(&edge);
    window.key(Key::Enter);
    let cut = window.draft().template.joints.clone().unwrap();
    assert_eq!(cut.len(), joints + 1, "{}", window.message());
    assert_eq!(cut[0].nodes.len(), 2);
    assert_eq!(cut[1].nodes.len(), nodes.len() - 1);
    window.wait(Designer::is_built);
    // The same once more is refused, and the joint in the way can be shown.
    window.key(Key::Escape);
    let label = window.labels().into_iter().find(|l| l.starts_with("joint 1: ")).unwrap();
    window.click(&label);
    window.click(&edge);
    window.key(Key::Enter);
    assert!(window.message().contains("very joint"), "{}", window.message());
    assert!(window.has("Show"));
    window.click("Show");
    assert_eq!(window.draft().template.joints.as_ref(), Some(&cut));
}
