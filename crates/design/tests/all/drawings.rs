//! Drawings to scripts and back.

use design::drawings::{DrawingFileError, Making, of_script, to_script};
use design::modelling::model;
use glam::DVec2;
use sketch::{Drawing, Outline};

fn circle(x: f64, radius: f64) -> Outline {
    Outline::Circle { center: DVec2::new(x, 0.0), radius }
}

fn drawing(outlines: &[Outline]) -> Drawing {
    let mut drawing = Drawing::default();
    outlines.iter().for_each(|o| drawing.add_outline(o).unwrap());
    drawing
}

#[test]
fn outlines_inside_others_are_holes_and_what_is_in_holes_is_a_sheet() {
    let square = Outline::Rectangle { at: DVec2::splat(-50.0), size: DVec2::splat(100.0), round: 5.0 };
    let open = Outline::Line([DVec2::new(200.0, 0.0), DVec2::new(300.0, 0.0)]);
    let drawn = drawing(&[circle(0.0, 30.0), square, circle(0.0, 10.0), circle(120.0, 20.0), open]);
    let (text, left_out) = to_script(&drawn, Making::Sheets).unwrap();
    assert_eq!(left_out.as_deref(), Some("1 open outlines"));
    let made = model(&text).unwrap();
    assert_eq!(made.report.patches.len(), 3);
    let area: f64 = made
        .mesh
        .faces
        .iter()
        .map(|f| {
            let [a, b, c] = f.map(|v| made.mesh.positions[v as usize]);
            0.5 * (b - a).cross(c - a).length()
        })
        .sum();
    let pi = std::f64::consts::PI;
    let wanted = 100.0 * 100.0 - (4.0 - pi) * 25.0 - pi * 900.0 + pi * 100.0 + pi * 400.0;
    assert!((area - wanted).abs() < 0.005 * wanted, "{area} {wanted}");
    // All but the open line comes back.
    let (back, left_out) = of_script(&text).unwrap();
    assert_eq!((back.outlines().unwrap().len(), left_out), (4, None));
}

#[test]
fn walls_stand_on_branching_lines() {
    let arms = [0.0, 2.1, 4.2].map(|a: f64| Outline::Line([DVec2::ZERO, DVec2::from_angle(a) * 40.0]));
    let (text, left_out) = to_script(&drawing(&arms), Making::Walls(25.0)).unwrap();
    assert_eq!(left_out, None);
    let made = model(&text).unwrap();
    assert!(made.report.identity_holds);
    let high = made.mesh.positions.iter().map(|p| p.z).fold(0.0, f64::max);
    assert_eq!((made.report.counts.f, high), (3, 25.0));
    let (text, _) = to_script(&drawing(&arms), Making::Wires).unwrap();
    assert_eq!(model(&text).unwrap().report.wires, ["drawing"]);
}

#[test]
fn what_cannot_be_made_is_told() {
    assert!(matches!(to_script(&Drawing::default(), Making::Wires), Err(DrawingFileError::Empty)));
    let open = drawing(&[Outline::Line([DVec2::ZERO, DVec2::X])]);
    assert!(matches!(to_script(&open, Making::Sheets), Err(DrawingFileError::NoneClosed)));
    assert!(matches!(to_script(&open, Making::Walls(0.0)), Err(DrawingFileError::Script(_))));
    assert!(matches!(of_script("{}"), Err(DrawingFileError::Script(_))));
    let many: Vec<[f64; 2]> = (0..3000).map(|k| [f64::from(k), 0.5 * f64::from(k % 7)]).collect();
    let many = format!(
        "{{\"toile_script\": 1, \"commands\": [{{\"do\": \"wire\", \"name\": \"w\", \"drawings\": [{{\"polyline\": {many:?}}}]}}]}}"
    );
    assert!(matches!(of_script(&many), Err(DrawingFileError::TooMany { found: 3000 })));
    let none = r#"{"toile_script": 1, "commands": [{"do": "undo"}]}"#;
    assert!(matches!(of_script(none), Err(DrawingFileError::NoDrawing)));
}

#[test]
fn drawings_on_other_planes_are_counted() {
    let text = std::fs::read_to_string("../../samples/sheets/mount.json").unwrap();
    let (drawn, left_out) = of_script(&text).unwrap();
    assert!(drawn.shapes().count() > 3, "{left_out:?}");
}

#[test]
fn a_draft_with_a_drawing_is_of_the_newer_format() {
    use design::draft::{Command, Draft, Edit, History, journal};
    let mut history = History::new(Draft::empty());
    let text = String::from_utf8(history.draft().to_bytes()).unwrap();
    assert!(text.starts_with("{\"toile_draft\":1,"));
    let drawn = drawing(&[circle(0.0, 30.0), circle(5.0, 30.0)]);
    history.apply(Command::Edit(Edit::Draw { label: "draw".to_owned(), drawing: drawn.clone() })).unwrap();
    let text = String::from_utf8(history.draft().to_bytes()).unwrap();
    assert!(text.starts_with("{\"toile_draft\":2,"));
    assert_eq!(Draft::from_bytes(text.as_bytes()).unwrap().drawing, drawn);
    assert!(history.draft().has_garment_of(history.first()));
    assert_eq!(journal::replay(&journal::to_bytes(&history)).unwrap().draft(), history.draft());
}
