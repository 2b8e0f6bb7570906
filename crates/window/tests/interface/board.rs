//! The drawing board: tools, snapping, typed numbers, rules, scripts.

use design::draft::Draft;
use design::drawings::of_script;
use eframe::egui::{Key, Modifiers, Pos2, vec2};
use egui_kittest::kittest::Queryable as _;
use glam::DVec2;
use sketch::{Drawing, Rule, Shape};

use crate::from_nothing::half_skirt;
use crate::support::Window;
use window::Designer;

/// An empty board; a millimetre is two points of the screen.
fn board() -> Window {
    let mut window = Window::new(Draft::empty());
    window.key(Key::F3);
    window.harness.get_by_role_and_label(eframe::egui::Role::Canvas, "Drawing board");
    window
}

fn drawing(window: &Window) -> &Drawing {
    &window.draft().drawing
}

/// A place of the plane on the screen of an untouched board.
fn screen(window: &Window, x: f32, y: f32) -> Pos2 {
    let canvas = window.harness.get_by_role_and_label(eframe::egui::Role::Canvas, "Drawing board");
    canvas.rect().center() + 2.0 * vec2(x, -y)
}

fn click(window: &mut Window, x: f32, y: f32) {
    let at = screen(window, x, y);
    window.stroke_click(at);
}

/// Types a number for the tool.
pub(crate) fn typed(window: &mut Window, text: &str) {
    window.write("Length or place", text);
    window.key(Key::Enter);
}

fn lines(window: &Window) -> Vec<[DVec2; 2]> {
    let ends = |(_, shape): (_, &Shape)| match shape {
        Shape::Line(ends) => Some(ends.map(|p| drawing(window).place(p).unwrap())),
        _ => None,
    };
    drawing(window).shapes().filter_map(ends).collect()
}

/// A triangle with a right angle at the origin.
fn triangle() -> Window {
    let mut window = board();
    window.key(Key::L);
    for (x, y) in [(0.0, 0.0), (60.0, 0.0), (0.0, 40.0), (0.0, 0.0)] {
        click(&mut window, x, y);
    }
    window
}

#[test]
fn lines_close_and_each_is_an_entry() {
    let mut window = triangle();
    assert_eq!(lines(&window).len(), 3, "{}", window.message());
    assert_eq!(drawing(&window).points().count(), 3, "the last click took the first point");
    assert!(window.has("1 closed outlines, 0 open"));
    // The row ended: the next click begins another one.
    click(&mut window, -60.0, -60.0);
    assert_eq!(lines(&window).len(), 3);
    window.key(Key::Escape);
    for left in [2, 1, 0] {
        window.keys(Modifiers::COMMAND, Key::Z);
        assert_eq!(lines(&window).len(), left);
    }
    assert_eq!(*window.draft(), Draft::empty());
    window.keys(Modifiers::COMMAND, Key::Y);
    assert_eq!(lines(&window), [[DVec2::ZERO, DVec2::new(60.0, 0.0)]]);
}

#[test]
fn every_shape_is_drawn_by_typed_numbers_alone() {
    let mut window = board();
    window.key(Key::L);
    for text in ["0; 0", "12 in", "2 cm @ 90", "-12 in; 0"] {
        typed(&mut window, text);
    }
    let [.., [_, end]] = lines(&window)[..] else { panic!("{}", window.message()) };
    assert!(end.distance(DVec2::new(0.0, 20.0)) < 1e-9, "{end}");
    assert!((lines(&window)[0][1].x - 304.8).abs() < 1e-9);
    window.key(Key::Escape);
    window.key(Key::O);
    typed(&mut window, "100; 100");
    typed(&mut window, "25");
    window.key(Key::A);
    for text in ["0; -100", "60; 0", "50"] {
        typed(&mut window, text);
    }
    window.key(Key::S);
    for text in ["0; -200", "50; 20", "50; -20"] {
        typed(&mut window, text);
    }
    window.key(Key::Enter);
    window.key(Key::C);
    for text in ["0; 300", "50; 0"] {
        typed(&mut window, text);
    }
    let kinds: Vec<bool> = drawing(&window)
        .shapes()
        .map(|(id, shape)| match shape {
            Shape::Line(_) => true,
            Shape::Circle { radius, .. } => *radius == 25.0,
            Shape::Arc { .. } => match drawing(&window).curve(id).unwrap() {
                sketch::Curve::Arc { radius, .. } => (radius - 50.0).abs() < 1e-9,
                _ => false,
            },
            Shape::Spline(through) => through.len() == 3,
            Shape::Bezier { .. } => true,
        })
        .collect();
    assert_eq!(kinds, [true; 7], "{}", window.message());
    // What cannot be is told, and changes nothing.
    let before = window.draft().clone();
    window.key(Key::O);
    typed(&mut window, "7");
    assert!(window.message().contains("first place"), "{}", window.message());
    typed(&mut window, "seven");
    assert!(window.message().contains("is no length"), "{}", window.message());
    assert_eq!(*window.draft(), before);
}

#[test]
fn a_digit_on_the_board_begins_a_number() {
    let mut window = board();
    window.key(Key::L);
    click(&mut window, 0.0, 0.0);
    window.harness.event(eframe::egui::Event::Text("3".to_owned()));
    window.steps();
    window.harness.event(eframe::egui::Event::Text("5 mm".to_owned()));
    window.steps();
    let field = window.harness.get_by_label("Length or place");
    assert_eq!((field.value().as_deref(), field.is_focused()), (Some("35 mm"), true));
    window.key(Key::Enter);
    assert_eq!(lines(&window), [[DVec2::ZERO, DVec2::new(35.0, 0.0)]], "{}", window.message());
}

#[test]
fn a_number_typed_at_once_is_taken_whole() {
    let mut window = board();
    window.key(Key::L);
    click(&mut window, 0.0, 0.0);
    // A fast hand: letters of the unit are keys of tools too, and Enter ends rows.
    for (text, key) in [("4", Key::Num4), ("c", Key::C), ("m", Key::M)] {
        window.harness.event(eframe::egui::Event::Text(text.to_owned()));
        window.harness.key_press(key);
    }
    window.harness.key_press(Key::Enter);
    window.steps();
    assert_eq!(lines(&window), [[DVec2::ZERO, DVec2::new(40.0, 0.0)]], "{}", window.message());
    // The row goes on.
    typed(&mut window, "1 cm @ 90");
    assert_eq!(lines(&window).len(), 2);
    // A double click ends it, without a line of no length.
    for (x, y) in [(80.0, 40.0), (80.0, 40.0)] {
        click(&mut window, x, y);
    }
    assert_eq!(lines(&window).len(), 3);
    assert!(!window.message().contains("length"), "{}", window.message());
    window.keys(Modifiers::COMMAND, Key::Z);
    window.keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(lines(&window).len(), 3, "made again");
}

#[test]
fn the_pointer_says_what_it_snaps_to() {
    let mut window = triangle();
    window.key(Key::L);
    let hover = |window: &mut Window, x, y| {
        let at = screen(window, x, y);
        window.harness.event(eframe::egui::Event::PointerMoved(at));
        window.steps();
    };
    hover(&mut window, 31.0, 1.5);
    assert!(window.has("snaps to middle"), "{:?}", window.labels());
    hover(&mut window, 1.0, 38.5);
    assert!(window.has("snaps to point"));
    hover(&mut window, 47.0, 1.0);
    assert!(window.has("snaps to on the shape"));
    hover(&mut window, -61.0, -41.0);
    assert!(window.has("snaps to grid"));
    window.key(Key::G);
    hover(&mut window, -61.0, -42.0);
    assert!(!window.has("snaps to grid"));
}

#[test]
fn points_are_moved_and_joined_by_dragging() {
    let mut window = triangle();
    click(&mut window, -60.0, 0.0);
    click(&mut window, -60.0, 40.0);
    window.key(Key::Escape);
    window.key(Key::V);
    let labels = window.labels();
    let loose: Vec<&String> = labels.iter().filter(|l| l.starts_with("point ")).collect();
    assert_eq!(drawing(&window).points().count(), 5, "{loose:?}");
    let [from, to] = [screen(&window, -60.0, 40.0), screen(&window, 0.0, 40.0)];
    window.stroke(&[from, to]);
    assert_eq!(
        drawing(&window).points().count(),
        4,
        "let go on a point it is that point: {}",
        window.message()
    );
    window.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(drawing(&window).points().count(), 5, "a drag is one entry");
    // A line goes as a whole.
    let [from, to] = [screen(&window, -60.0, 20.0), screen(&window, -80.0, 10.0)];
    window.stroke(&[from, to]);
    let moved = lines(&window)[3];
    assert!(moved[0].distance(DVec2::new(-80.0, -10.0)) < 1e-6, "{moved:?}");
    // A box takes what lies in it whole.
    let [from, to] = [screen(&window, -100.0, -20.0), screen(&window, -70.0, 60.0)];
    window.stroke(&[from, to]);
    assert!(window.has("3 selected"), "a line and its ends");
    window.key(Key::Escape);
    let around = [(-100.0, -20.0), (-100.0, 60.0), (-70.0, 60.0), (-70.0, -20.0)];
    let around = around.map(|(x, y)| screen(&window, x, y));
    window.drag(eframe::egui::PointerButton::Primary, &around, 4, Modifiers::COMMAND);
    assert!(window.has("3 selected"), "so does a lasso");
    window.key(Key::Delete);
    assert_eq!((lines(&window).len(), drawing(&window).points().count()), (3, 3));
}

#[test]
fn corners_are_rounded_lines_trimmed_extended_split_and_bent() {
    let mut window = triangle();
    window.key(Key::R);
    typed(&mut window, "10");
    click(&mut window, 0.0, 0.0);
    let rounded = drawing(&window).shapes().filter(|(_, s)| matches!(s, Shape::Arc { .. })).count();
    assert_eq!(rounded, 1, "{}", window.message());
    window.keys(Modifiers::COMMAND, Key::Z);
    typed(&mut window, "500");
    click(&mut window, 0.0, 0.0);
    assert!(window.message().contains("cannot be rounded"), "{}", window.message());

    // A line across, trimmed between the two that it crosses.
    window.key(Key::L);
    click(&mut window, -20.0, 10.0);
    click(&mut window, 80.0, 10.0);
    window.key(Key::Escape);
    window.key(Key::T);
    click(&mut window, 20.0, 10.0);
    let level: Vec<[DVec2; 2]> =
        lines(&window).into_iter().filter(|[a, b]| a.y == b.y && a.y != 0.0).collect();
    assert_eq!(level.len(), 2, "{}", window.message());
    assert!(level.iter().any(|l| l[1].distance(DVec2::new(0.0, 10.0)) < 1e-6), "{level:?}");

    window.key(Key::X);
    click(&mut window, 58.0, 10.0);
    let reached = lines(&window).into_iter().flatten().filter(|p| p.distance(DVec2::new(0.0, 10.0)) < 1e-6);
    assert_eq!(reached.count(), 2, "{}", window.message());

    window.key(Key::P);
    let count = drawing(&window).shapes().count();
    click(&mut window, 30.0, 0.0);
    assert_eq!(drawing(&window).shapes().count(), count + 1, "{}", window.message());
    assert!(lines(&window).iter().flatten().any(|p| p.distance(DVec2::new(30.0, 0.0)) < 1e-9));

    window.key(Key::B);
    let [from, to] = [screen(&window, 45.0, 0.0), screen(&window, 45.0, -10.0)];
    window.stroke(&[from, to]);
    assert!(drawing(&window).shapes().any(|(_, s)| matches!(s, Shape::Arc { .. })), "{}", window.message());
}

#[test]
fn handles_are_pulled_and_smooth_points_stay_smooth() {
    let mut window = board();
    window.key(Key::C);
    for (at, pull) in
        [((-60.0, 0.0), (-60.0, 30.0)), ((0.0, 30.0), (30.0, 30.0)), ((60.0, 0.0), (60.0, -30.0))]
    {
        let [at, pull] = [at, pull].map(|(x, y)| screen(&window, x, y));
        window.stroke(&[at, pull]);
    }
    window.key(Key::Enter);
    assert_eq!(drawing(&window).shapes().count(), 2, "{}", window.message());
    let bend = |window: &Window| {
        let curves: Vec<_> =
            drawing(window).shapes().map(|(id, _)| drawing(window).curve(id).unwrap()).collect();
        curves[0].tangent(1.0).angle_to(curves[1].tangent(0.0)).abs()
    };
    assert!(bend(&window) < 1e-9);
    window.key(Key::V);
    click(&mut window, 0.0, 30.0);
    // The handle that was pulled to (30, 30), and is seen since its point is selected.
    let [from, to] = [screen(&window, 30.0, 30.0), screen(&window, 30.0, 50.0)];
    window.stroke(&[from, to]);
    assert!(bend(&window) < 1e-9, "{}", window.message());
    let curve = drawing(&window).shapes().next().map(|(id, _)| drawing(&window).curve(id).unwrap()).unwrap();
    assert!(curve.tangent(1.0).y > 0.3, "the other handle turned with it");
}

#[test]
fn rules_hold_and_go() {
    let mut window = triangle();
    window.key(Key::V);
    click(&mut window, 30.0, 20.0);
    window.click("Keep the length");
    click(&mut window, 30.0, 0.0);
    window.click("Level");
    click(&mut window, 0.0, 0.0);
    window.click("Fixed");
    assert_eq!(drawing(&window).rules().len(), 3, "{}", window.message());
    let long = lines(&window)[1][0].distance(lines(&window)[1][1]);
    let [from, to] = [screen(&window, 60.0, 0.0), screen(&window, 50.0, 30.0)];
    window.stroke(&[from, to]);
    let now = lines(&window);
    assert!((now[1][0].distance(now[1][1]) - long).abs() < 1e-4, "{now:?}");
    assert!((now[0][0].y - now[0][1].y).abs() < 1e-4 && now[0][0].length() < 1e-4, "{now:?}");
    // What contradicts is refused.
    let before = window.draft().clone();
    window.key(Key::Escape);
    let line = drawing(&window).shapes().next().unwrap().0.number();
    window.click(&format!("line {line}"));
    assert!(!window.has("Square"), "that takes two lines");
    window.click("Plumb");
    assert_eq!(*window.draft(), before, "{}", window.message());
    // A length is typed, in any unit.
    window.write("length", "2 in");
    window.key(Key::Enter);
    let is_typed = |r: &Rule| matches!(r, Rule::Length(_, l) if (*l - 50.8).abs() < 1e-9);
    assert!(drawing(&window).rules().iter().any(is_typed), "{}", window.message());
    let rule = format!("Delete rule line {line} is 50.8 mm long");
    window.click(&rule);
    assert!(!window.has(&rule));
}

#[test]
fn a_drawing_goes_to_a_script_and_comes_back() {
    let mut window = triangle();
    window.key(Key::O);
    typed(&mut window, "12; 12");
    typed(&mut window, "6");
    let path = window.folder.path().join("plate.json");
    window.action("Write a script");
    window.write("Path", &path.display().to_string());
    window.click("Write");
    let text = std::fs::read_to_string(&path).unwrap();
    let made = design::modelling::model(&text).unwrap();
    assert_eq!((made.report.patches.len(), made.report.counts.r), (1, 1), "{}", window.message());

    window.action("Write a script");
    window.click("Walls");
    window.write("Height", "20");
    window.write("Path", &path.display().to_string());
    window.click("Write over the file that is there");
    let walls = design::modelling::model(&std::fs::read_to_string(&path).unwrap()).unwrap();
    let high = walls.mesh.positions.iter().map(|p| p.z).fold(0.0, f64::max);
    assert_eq!(high, 20.0, "{}", window.message());

    // The drawing is a part of the design, and comes back from scripts too.
    let before = drawing(&window).outlines().unwrap();
    window.keys(Modifiers::COMMAND, Key::A);
    window.key(Key::Delete);
    assert_eq!(drawing(&window).points().count() + drawing(&window).shapes().count(), 0);
    window.action("Open a drawing");
    window.write("Path", &path.display().to_string());
    window.steps();
    window.steps();
    window.click("Open");
    assert_eq!(drawing(&window).outlines().unwrap().len(), before.len(), "{}", window.message());
    assert_eq!(of_script(&text).unwrap().0.outlines().unwrap().len(), before.len());
    let bad = window.folder.path().join("bad.json");
    std::fs::write(&bad, "{\"toile_script\": 9}").unwrap();
    let kept = window.draft().clone();
    window.action("Open a drawing");
    window.write("Path", &bad.display().to_string());
    window.steps();
    window.steps();
    window.click("Open");
    assert!(window.message().contains("was not opened"), "{}", window.message());
    assert_eq!(*window.draft(), kept);
}

#[test]
fn the_garment_does_not_wait_for_the_drawing() {
    let mut window = half_skirt();
    window.wait(Designer::is_built);
    window.key(Key::F3);
    window.key(Key::L);
    click(&mut window, 0.0, 0.0);
    click(&mut window, 60.0, 0.0);
    assert_eq!(lines(&window).len(), 1, "{}", window.message());
    assert!(window.harness.state().is_built() && window.harness.state().is_idle());
    window.key(Key::Escape);
    window.keys(Modifiers::COMMAND, Key::Z);
    assert!(window.harness.state().is_built() && window.harness.state().is_idle());
    // One more belongs to the garment.
    window.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.draft().template.surfaces.len(), 1);
}

#[test]
fn every_part_of_the_board_has_a_name() {
    let mut window = triangle();
    window.keys(Modifiers::COMMAND, Key::A);
    assert_eq!(window.harness.unnamed_widgets(), Vec::<String>::new());
    window.key(Key::R);
    window.key(Key::Escape);
    click(&mut window, 0.0, 0.0);
    assert_eq!(window.harness.unnamed_widgets(), Vec::<String>::new());
    window.key(Key::F3);
    assert!(!window.has("Length or place"));
    window.harness.get_by_role_and_label(eframe::egui::Role::Canvas, "3D view");
}
