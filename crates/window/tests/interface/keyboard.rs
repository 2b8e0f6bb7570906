//! Everything by the keyboard, and by name.

use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;

use crate::support::Window;
use design::draft::Draft;

#[test]
fn every_input_has_a_name() {
    let mut window = Window::sample("princess-dress.json");
    window.steps();
    assert_eq!(window.harness.unnamed_widgets(), Vec::<String>::new());
    for menu in ["File", "Edit", "Tool", "Selection", "View", "Window"] {
        window.click(menu);
        assert_eq!(window.harness.unnamed_widgets(), Vec::<String>::new(), "{menu}");
        window.key(Key::Escape);
    }
}

#[test]
fn the_palette_finds_and_runs_by_a_part_of_a_name() {
    let mut window = Window::new(Draft::empty());
    window.keys(Modifiers::COMMAND, Key::P);
    window.harness.get_by_label("Find an action").type_text("mirr");
    window.steps();
    window.key(Key::Enter);
    assert!(!window.draft().template.mirrored, "{}", window.message());
    assert!(!window.has("Find an action"));
    window.keys(Modifiers::COMMAND, Key::P);
    window.key(Key::Escape);
    assert!(!window.has("Find an action"), "Escape leaves it");
    assert!(!window.draft().template.mirrored);
}

#[test]
fn the_sheet_of_keys_opens_and_closes() {
    let mut window = Window::new(Draft::empty());
    window.keys(Modifiers::SHIFT, Key::Questionmark);
    assert!(window.has("Close"));
    window.harness.run_steps(20);
    window.click("Close");
    assert!(!window.has("Close"), "{:?}", window.labels());
}

#[test]
fn letters_are_text_while_a_field_is_written() {
    let mut window = Window::new(Draft::empty());
    window.write("New faces go to", "menfjk");
    assert!(window.draft().template.mirrored, "m is a letter here");
    let field = window.harness.get_by_label("New faces go to").value();
    assert_eq!(field.as_deref(), Some("menfjk"));
}

#[test]
fn the_view_turns_about_what_is_under_the_pointer() {
    let mut window = Window::sample("princess-dress.json");
    window.harness.get_by_role_and_label(eframe::egui::Role::Canvas, "3D view");
    let pointer = window.at("node front_waist");
    let other = window.at("node front_neck");
    window.drag(
        eframe::egui::PointerButton::Secondary,
        &[pointer, pointer + eframe::egui::vec2(40.0, 10.0)],
        8,
        Modifiers::NONE,
    );
    assert!(window.at("node front_waist").distance(pointer) < 12.0, "it stays about where it was");
    assert!(window.at("node front_neck").distance(other) > 1.0, "others turn");
    let neck = window.at("node front_neck");
    window.wheel(pointer, 3.0);
    let farther = window.at("node front_neck").distance(pointer);
    assert!(farther > 1.05 * neck.distance(pointer), "nearer");
    window.key(Key::Home);
    window.key(Key::F5);
    window.key(Key::O);
    assert!(window.has("node front_waist"));
}
