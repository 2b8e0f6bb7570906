//! Panels: shown and hidden, resized, kept under names, and units of what stands in them.

use design::draft::Draft;
use eframe::egui::{Key, Rect, Role, vec2};
use egui_kittest::kittest::Queryable as _;

use crate::from_nothing::half_skirt;
use crate::support::Window;
use window::Designer;

fn canvas(window: &Window) -> Rect {
    window.harness.get_by_role_and_label(Role::Canvas, "3D view").rect()
}

#[test]
fn layouts_are_kept_under_names_and_come_back_at_the_next_start() {
    let mut window = Window::new(Draft::empty());
    let usual = canvas(&window);
    // The border at the left is dragged, the inspector goes.
    let border = usual.left_center() - vec2(2.0, 0.0);
    window.stroke(&[border, border + vec2(60.0, 0.0)]);
    window.action("Inspector panel");
    let own = canvas(&window);
    assert!(own.left() > usual.left() + 40.0, "{own:?} {usual:?}");
    assert!(!window.has("Body") || !window.has("Size"), "the inspector is gone");
    window.action("Keep layout");
    window.write("Name", "Sewing");
    window.click("Keep");
    window.action("Usual layout");
    assert_eq!(canvas(&window), usual);
    window.action("Layout: Sewing");
    assert_eq!(canvas(&window), own);
    window.action("Outline panel");
    window.action("Pattern panel");
    assert!(canvas(&window).width() > 1270.0, "nothing but the view: {:?}", canvas(&window));
    window.action("Layout: Sewing");
    assert_eq!(canvas(&window), own);

    // What is kept is deleted by name.
    let Window { harness, folder } = window;
    drop(harness);
    let mut window = Window::open(Draft::empty(), None, folder);
    assert_eq!(canvas(&window), own, "the next start begins with it");
    window.action("Keep layout");
    window.click("Delete layout Sewing");
    window.click("Cancel");
    window.key(Key::Escape);
    window.click("Window");
    assert!(!window.has("Layout: Sewing"));
}

#[test]
fn lengths_stand_in_the_unit_that_is_chosen_and_take_others() {
    let mut window = half_skirt();
    window.wait(Designer::is_built);
    window.key(Key::F5);
    window.key(Key::V);
    window.click("node left_side_hip");
    let normal = |window: &Window| window.draft().template.nodes["left_side_hip"].normal;
    let shown =
        |window: &Window| window.harness.get_by_role_and_label(Role::SpinButton, "outward").value().unwrap();
    assert_eq!((normal(&window), shown(&window).as_str()), (12.0, "12.0 mm"));
    let write = |window: &mut Window, text: &str| {
        let at = window.harness.get_by_role_and_label(Role::SpinButton, "outward").rect();
        window.stroke_click(at.right_center() - vec2(10.0, 0.0));
        window.harness.event(eframe::egui::Event::Text(text.to_owned()));
        window.steps();
        window.key(Key::Enter);
    };
    write(&mut window, "1/2 in");
    assert!((normal(&window) - 12.7).abs() < 1e-9, "{}", normal(&window));
    window.action("Inches");
    assert_eq!(shown(&window), "0.50 in");
    write(&mut window, "1");
    assert!((normal(&window) - 25.4).abs() < 1e-9, "a number alone is of the unit that is shown");
    write(&mut window, "15 mm");
    assert!((normal(&window) - 15.0).abs() < 1e-9);
    // What is no length changes nothing.
    write(&mut window, "wide");
    assert!((normal(&window) - 15.0).abs() < 1e-9);
}
