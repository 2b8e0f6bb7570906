//! Every tool by the mouse.

use eframe::egui::{Key, Modifiers, Pos2, vec2};

use crate::from_nothing::half_skirt;
use crate::support::Window;
use design::draft::Draft;
use window::Designer;

#[test]
fn a_drag_moves_a_node_and_is_one_entry() {
    let mut window = half_skirt();
    window.key(Key::F5);
    window.key(Key::V);
    let before = window.draft().clone();
    for by in [vec2(15.0, 12.0), vec2(-6.0, 9.0)] {
        let from = window.at("node left_side_hip");
        window.stroke(&[from, from + by]);
        let moved = window.at("node left_side_hip") - from;
        assert!((moved - by).length() < 3.0, "{moved:?} instead of {by:?}: {}", window.message());
    }
    window.keys(Modifiers::COMMAND, Key::Z);
    assert_ne!(*window.draft(), before, "two drags are two entries");
    window.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(*window.draft(), before, "each is one");
}

#[test]
fn clicks_select_by_kind_and_a_box_selects_many() {
    let mut window = half_skirt();
    window.wait(Designer::is_built);
    window.key(Key::F5);
    window.key(Key::Num2);
    window.click("edge centre_front_hip – left_side_hip");
    assert!(window.has("Delete"), "the inspector speaks of the edge");
    window.key(Key::Num3);
    let [a, b] = ["node centre_front_waist", "node left_side_hip"].map(|n| window.at(n));
    let middle = a + (b - a) * 0.5;
    window.stroke_click(middle);
    assert!(window.has("face 1 of left_front"), "{}", window.message());
    window.key(Key::Escape);
    assert!(!window.has("face 1 of left_front"));
    // The twin is picked as what it mirrors.
    let axis = window.at("node centre_front_waist").x;
    window.stroke_click(Pos2::new(2.0 * axis - middle.x, middle.y));
    assert!(window.has("face 1 of left_front"), "{}", window.message());
    window.key(Key::Num1);
    window.stroke(&[Pos2::new(230.0, 90.0), Pos2::new(900.0, 760.0)]);
    assert!(window.has("6 selected"), "four in front and two twins: {:?}", window.labels());
    window.key(Key::Escape);
    assert!(!window.has("6 selected"));
}

#[test]
fn a_lasso_takes_what_it_goes_round() {
    let mut window = half_skirt();
    window.key(Key::F5);
    window.key(Key::V);
    let [waist, hip, side] =
        ["centre_front_waist", "centre_front_hip", "left_side_hip"].map(|n| window.at(&format!("node {n}")));
    let before = window.draft().clone();
    // Round the front's middle and the hip at the side, past the waist at the side; it begins on a node, which stays.
    let through = [
        waist,
        waist - vec2(20.0, 20.0),
        hip + vec2(-20.0, 20.0),
        side + vec2(20.0, 20.0),
        side + vec2(20.0, -20.0),
        hip + vec2(20.0, -20.0),
        waist + vec2(20.0, -20.0),
    ];
    window.drag(eframe::egui::PointerButton::Primary, &through, 4, Modifiers::COMMAND);
    assert!(window.has("3 selected"), "{:?}", window.labels());
    assert_eq!(*window.draft(), before);
    window.drag(
        eframe::egui::PointerButton::Primary,
        &[
            waist - vec2(30.0, 30.0),
            waist + vec2(20.0, -30.0),
            waist + vec2(20.0, 20.0),
            waist + vec2(-30.0, 20.0),
        ],
        4,
        Modifiers::COMMAND | Modifiers::SHIFT,
    );
    assert!(window.has("2 selected"), "with Shift what was selected is taken out: {:?}", window.labels());
}

#[test]
fn a_node_anywhere_on_the_body_is_bound_to_the_nearest_feature_point() {
    let mut window = Window::new(Draft::empty());
    window.key(Key::N);
    let [a, b] =
        ["feature point centre_front_hip", "feature point left_princess_front_hip"].map(|n| window.at(n));
    let at = a + (b - a) * 0.5 + vec2(0.0, 25.0);
    window.stroke_click(at);
    let nodes = &window.draft().template.nodes;
    let (name, node) = nodes.iter().next().expect("a node was made");
    assert!(name.starts_with("left_") && name.ends_with("_beside"), "{name}");
    assert!(node.first != 0.0 && node.second != 0.0);
    let there = window.at(&format!("node {name}"));
    assert!(there.distance(at) < 12.0, "{there:?} {at:?}");
}

#[test]
fn faces_that_cannot_be_are_refused_with_a_reason() {
    let mut window = half_skirt();
    window.key(Key::F5);
    window.key(Key::F);
    window.write("New faces go to", "left_front");
    for name in ["centre_front_waist", "centre_front_hip", "left_side_hip", "left_side_waist"] {
        window.click(&format!("node {name}"));
    }
    assert!(window.message().contains("has it already"), "{}", window.message());
    window.click("node centre_front_waist");
    window.key(Key::Enter);
    assert!(window.message().contains("three or four nodes"), "{}", window.message());
    let before = window.draft().clone();
    window.key(Key::V);
    window.click("node centre_front_waist");
    window.key(Key::Delete);
    assert!(window.message().contains("delete that first"), "{}", window.message());
    assert_eq!(*window.draft(), before);
}

#[test]
fn a_face_goes_to_another_surface_and_goes() {
    let mut window = half_skirt();
    window.key(Key::F5);
    window.key(Key::Num3);
    let [a, b] = ["node centre_front_waist", "node left_side_hip"].map(|n| window.at(n));
    window.stroke_click(a + (b - a) * 0.5);
    window.click("Delete face");
    assert_eq!(window.draft().template.surfaces.len(), 1, "{}", window.message());
    window.keys(Modifiers::COMMAND, Key::Z);
    window.stroke_click(a + (b - a) * 0.5);
    window.write("New faces go to", "left_panel");
    window.click("Assign to the new surface left_panel");
    assert!(window.draft().template.surfaces.contains_key("left_panel"), "{}", window.message());
}

#[test]
fn a_stroke_over_two_edges_is_one_entry_and_can_be_drawn_again() {
    let mut window = Window::sample("princess-dress.json");
    window.wait(Designer::is_built);
    window.key(Key::K);
    let lines = window.draft().template.lines.len();
    let before = window.draft().clone();
    let [hip, thigh, hem] = ["node front_hip", "node front_thigh", "node front_hem"].map(|n| window.at(n));
    let bent = |by: f32| vec2(by, 0.0);
    window.stroke(&[hip, hip.lerp(thigh, 0.5) + bent(6.0), thigh, thigh.lerp(hem, 0.5) + bent(-6.0), hem]);
    assert_eq!(window.draft().template.lines.len(), lines + 2, "{}", window.message());
    let drawn = window.draft().clone();
    window.stroke(&[hip, hip.lerp(thigh, 0.5) + bent(-9.0), thigh]);
    assert_eq!(
        window.draft().template.lines.len(),
        lines + 2,
        "the profile is drawn again: {}",
        window.message()
    );
    assert_ne!(*window.draft(), drawn, "{}", window.message());
    window.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(*window.draft(), drawn);
    window.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(*window.draft(), before, "two profiles of one stroke are one entry");
}

#[test]
fn a_part_of_a_profile_is_drawn_over_and_the_rest_stays() {
    let mut window = half_skirt();
    window.key(Key::F5);
    window.key(Key::K);
    let [a, b] = ["node centre_front_hip", "node left_side_hip"].map(|n| window.at(n));
    window.stroke(&[a, b]);
    let profile = |window: &Window| {
        let lines = &window.draft().template.lines;
        assert_eq!(lines.len(), 1, "{}", window.message());
        let shape = lines.values().next().unwrap().shape.clone();
        let Some(template::format::Shape::Profile(p)) = shape else { panic!("a profile") };
        p.points
    };
    let before = profile(&window);
    // From a third of the way to two thirds, over a lower place.
    let [from, to] = [0.35, 0.65].map(|t| a + (b - a) * t);
    let middle = a + (b - a) * 0.5 + vec2(0.0, 14.0);
    window.stroke(&[from, middle, to]);
    let after = profile(&window);
    let least = |points: &[[f64; 3]], shares: std::ops::Range<f64>| {
        let count = points.len() as f64;
        let inside = points.iter().enumerate().filter(|(k, _)| shares.contains(&(*k as f64 / count)));
        inside.map(|(_, p)| p[1]).fold(f64::INFINITY, f64::min)
    };
    assert!(least(&before, 0.4..0.6) - least(&after, 0.4..0.6) > 5.0, "{}", window.message());
    for rest in [0.0..0.25, 0.75..1.0] {
        assert!((least(&before, rest.clone()) - least(&after, rest)).abs() < 1.5);
    }
    assert_eq!((before[0], before.last()), (after[0], after.last()));
    window.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(profile(&window), before);
    // A touch is no stroke over a part.
    window.stroke(&[from, from + vec2(0.0, 30.0)]);
    assert_eq!(profile(&window), before);
    assert!(window.message().contains("over a part of a profile"), "{}", window.message());
}

#[test]
fn curves_are_drawn_on_the_body_in_three_ways() {
    let mut window = Window::new(Draft::empty());
    window.key(Key::N);
    let [waist, side, hip] = ["centre_front_waist", "left_side_waist", "centre_front_hip"]
        .map(|n| window.at(&format!("feature point {n}")));
    window.key(Key::D);
    window.stroke(&[waist, waist + (hip - waist) * 0.5 + vec2(20.0, 0.0), hip]);
    assert_eq!(window.draft().features.len(), 1, "{}", window.message());
    window.action("Curve: Plane section");
    let below = vec2(0.0, 12.0);
    window.stroke(&[waist + below - vec2(30.0, 0.0), side + below]);
    let section = &window.draft().features["drawn_curve_2"];
    assert!(section.closed && section.points.len() > 20, "{}", window.message());
    window.action("Curve: Shortest path");
    window.stroke_click(waist + vec2(5.0, 5.0));
    window.stroke_click(hip + vec2(20.0, 0.0));
    assert_eq!(window.draft().features.len(), 3, "{}", window.message());
    // A node may stand where a drawn curve crosses another.
    window.key(Key::N);
    let crossing =
        window.labels().into_iter().find(|l| l.starts_with("feature point") && l.contains("drawn"));
    window.click(&crossing.expect("the closed curve crosses the centre front"));
    assert_eq!(window.draft().template.nodes.len(), 1, "{}", window.message());
}

#[test]
fn the_body_is_seen_through_the_cloth_in_x_ray() {
    let mut window = half_skirt();
    window.wait(Designer::is_built);
    window.key(Key::F5);
    // In the middle of the left front.
    let [a, b] = ["node centre_front_waist", "node left_side_hip"].map(|n| window.at(n));
    let at = a + (b - a) * 0.5;
    window.key(Key::T);
    let color = |window: &mut Window| {
        window.steps();
        let picture = window.harness.render().unwrap();
        picture.get_pixel(at.x as u32, at.y as u32).0.map(f32::from)
    };
    let cloth = color(&mut window);
    window.key(Key::G);
    let body = color(&mut window);
    window.key(Key::G);
    window.key(Key::X);
    let through = color(&mut window);
    assert!((0..3).any(|k| (cloth[k] - body[k]).abs() > 20.0), "{cloth:?} {body:?}: the place shows cloth");
    for k in 0..3 {
        assert!((through[k] - 0.5 * (cloth[k] + body[k])).abs() < 3.0, "{cloth:?} {body:?} {through:?}");
    }
    window.key(Key::X);
    assert_eq!(color(&mut window), cloth);
}

#[test]
fn a_body_measure_is_dragged_and_is_one_entry() {
    let mut window = Window::sample("princess-dress.json");
    window.wait(Designer::is_built);
    let before = window.draft().clone();
    let slider = window.slider("hip");
    // Slowly, so that previews come while it is dragged; the pointer stays on the knob.
    let end = slider.center() + vec2(8.0, 0.0);
    window.hold(&[slider.center(), slider.center() + vec2(4.0, 0.0)]);
    window.wait(|d| !d.is_built());
    window.pause();
    assert_eq!(window.slider("hip"), slider, "nothing moves under the hand");
    window.let_go(end);
    assert!(!window.has("not built yet"));
    assert_ne!(*window.draft(), before, "{}", window.message());
    window.wait(Designer::is_built);
    window.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(*window.draft(), before);
}
