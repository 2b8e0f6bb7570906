//! The clicks of `tests/window/from_nothing.sh`: that run has no names to go by, so they are written down here.

use eframe::egui::{Key, Modifiers, Pos2};

use crate::support::Window;
use design::draft::Draft;
use window::Designer;

/// Writes down what the hand does, and does it.
struct Hand {
    window: Window,
    script: String,
}

impl Hand {
    fn key(&mut self, name: &str, modifiers: Modifiers, key: Key) {
        self.script += &format!("key {name}\n");
        self.window.keys(modifiers, key);
    }

    fn click(&mut self, name: &str) {
        let at = self.window.at(name);
        self.script += &format!("click {:.0} {:.0} {name}\n", at.x, at.y);
        self.window.stroke_click(Pos2::new(at.x.round(), at.y.round()));
    }

    fn write(&mut self, field: &str, text: &str) {
        let at = self.window.field(field);
        self.script += &format!("click {:.0} {:.0} the field {field}\nkey ctrl+a\ntype {text}\n", at.x, at.y);
        self.window.write(field, text);
    }
}

#[test]
fn the_clicks_of_the_run_with_a_display_are_where_things_are() {
    let mut hand = Hand { window: Window::new(Draft::empty()), script: String::new() };
    hand.key("n", Modifiers::NONE, Key::N);
    for name in ["centre_front_waist", "left_side_waist", "left_side_hip", "centre_front_hip"] {
        hand.click(&format!("feature point {name}"));
    }
    hand.key("F6", Modifiers::NONE, Key::F6);
    for name in ["centre_back_waist", "centre_back_hip"] {
        hand.click(&format!("feature point {name}"));
    }
    hand.key("F5", Modifiers::NONE, Key::F5);
    hand.write("New faces go to", "left_front");
    hand.script += "away\n";
    hand.window.away();
    hand.key("f", Modifiers::NONE, Key::F);
    for name in ["centre_front_waist", "centre_front_hip", "left_side_hip", "left_side_waist"] {
        hand.click(&format!("node {name}"));
    }
    hand.key("F6", Modifiers::NONE, Key::F6);
    hand.write("New faces go to", "left_back");
    hand.script += "away\n";
    hand.window.away();
    for name in ["left_side_waist", "left_side_hip", "centre_back_hip", "centre_back_waist"] {
        hand.click(&format!("node {name}"));
    }
    hand.window.wait(Designer::is_built);
    assert_eq!(hand.window.harness.state().pieces(), 4, "{}", hand.window.message());
    hand.script += "wait\n";
    hand.key("ctrl+e", Modifiers::COMMAND, Key::E);
    hand.script += "key ctrl+a\ntype $OUT\nkey Return\n";

    let kept = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/window/from_nothing.hand");
    if std::env::var_os("UPDATE_SNAPSHOTS").is_some() {
        std::fs::write(kept, &hand.script).unwrap();
    }
    let kept = std::fs::read_to_string(kept).unwrap();
    assert_eq!(kept, hand.script, "UPDATE_SNAPSHOTS=1 writes it anew");
}
