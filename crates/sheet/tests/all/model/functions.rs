//! Lee & Kim's modelling functions (fig. 4), undo, and scripts.

use crate::model::support::*;
use mesh_kernel::complex::CheckOptions;
use mesh_kernel::glam::DVec3;
use sheet::model::{Limits, Model, ModelError, Script, ScriptError};

// Lee & Kim, fig. 4.

const PLATE: &str =
    r#"{"do": "create", "name": "plate", "outline": {"rectangle": {"at": [0, 0], "size": [80, 50]}}}"#;

#[test]
fn sheets_are_punched_where_the_hole_lies_inside() {
    let mut model = made(&[
        PLATE,
        r#"{"do": "punch", "patch": "plate", "outline": {"rectangle": {"at": [10, 10], "size": [20, 20], "round": 4}}}"#,
    ]);
    assert_eq!(model.complex().counts().r, 1);
    let punch = |at: &str| {
        format!(
            r#"{{"do": "punch", "patch": "plate", "outline": {{"rectangle": {{"at": {at}, "size": [20, 20]}}}}}}"#
        )
    };
    for outside in ["[-10, 10]", "[0, 10]", "[20, 20]", "[200, 0]"] {
        let error = refused(&mut model, &punch(outside));
        assert!(matches!(error, ModelError::LeavesFace { .. }), "{outside}: {error}");
    }
    // A hole that would swallow another.
    let big =
        r#"{"do": "punch", "patch": "plate", "outline": {"rectangle": {"at": [5, 5], "size": [40, 40]}}}"#;
    assert!(matches!(refused(&mut model, big), ModelError::LeavesFace { .. }));
    done(&mut model, &punch("[50, 20]"));
    assert_eq!(model.complex().counts().r, 2);
    let none = r#"{"do": "punch", "patch": "lid", "outline": {"circle": {"center": [9, 9], "radius": 1}}}"#;
    assert!(matches!(refused(&mut model, none), ModelError::NoPatch { .. }));
}

#[test]
fn sheets_are_bent_about_edges_and_across_faces() {
    let mut model = made(&[PLATE]);
    // Across the plate, from border to border: it is cut there, and the left part turns.
    done(&mut model, r#"{"do": "bend", "moving": "plate", "about": [[60, 0, 0], [60, 50, 0]], "angle": 90}"#);
    let [low, high] = model.to_mesh().bounds().unwrap();
    near(area(&model.to_mesh()), 4000.0, 1e-12);
    assert_eq!((low.x.round(), low.z.round(), high.x, high.z.round()), (60.0, 0.0, 80.0, 60.0));
    assert_eq!(counts(&model), [6, 7, 2, 0, 1, 0, 0]);
    // Holes stay in their parts; a line through a hole is refused.
    let punched =
        r#"{"do": "punch", "patch": "plate", "outline": {"circle": {"center": [20, 25], "radius": 8}}}"#;
    let mut holed = made(&[PLATE, punched]);
    let across = |x: f64| {
        format!(r#"{{"do": "bend", "moving": "plate", "about": [[{x}, 0, 0], [{x}, 50, 0]], "angle": 45}}"#)
    };
    assert!(matches!(refused(&mut holed, &across(20.0)), ModelError::LeavesFace { .. }));
    done(&mut holed, &across(40.0));
    assert_eq!((holed.complex().face_count(), holed.complex().counts().r), (2, 1));
    // About an edge that is there: back again.
    let mut flat = made(&[
        PLATE,
        r#"{"do": "sweep", "name": "flange", "edges": [[0, 0, 0], [80, 0, 0]], "by": [0, 0, 15]}"#,
    ]);
    done(&mut flat, r#"{"do": "bend", "moving": "flange", "about": [[0, 0, 0], [80, 0, 0]], "angle": 90}"#);
    let [low, high] = flat.to_mesh().bounds().unwrap();
    assert!((low - DVec3::new(0.0, -15.0, 0.0)).length() < 1e-9 && high.z.abs() < 1e-9, "{low} {high}");
    // Three sheets at the edge: the order about it follows.
    let mut tee = made(&[
        PLATE,
        r#"{"do": "sweep", "name": "up", "edges": [[0, 0, 0], [80, 0, 0]], "by": [0, 0, 15]}"#,
        r#"{"do": "sweep", "name": "down", "edges": [[0, 0, 0], [80, 0, 0]], "by": [0, -10, -10]}"#,
    ]);
    done(&mut tee, r#"{"do": "bend", "moving": "up", "about": [[0, 0, 0], [80, 0, 0]], "angle": 160}"#);
    // A corner whose three faces hang together cannot be bent open.
    let mut corner = made(&[
        PLATE,
        r#"{"do": "sweep", "name": "front", "edges": [[0, 0, 0], [80, 0, 0]], "by": [0, 0, 15]}"#,
        r#"{"do": "add", "name": "side", "points": [[0, 0, 0], [0, 0, 15], [0, 50, 15], [0, 50, 0]]}"#,
    ]);
    let error = refused(
        &mut corner,
        r#"{"do": "bend", "moving": "front", "about": [[0, 0, 0], [80, 0, 0]], "angle": 30}"#,
    );
    assert!(matches!(error, ModelError::Tears { .. }), "{error}");
    let error = refused(
        &mut corner,
        r#"{"do": "bend", "moving": "front", "about": [[0, 9, 9], [80, 0, 0]], "angle": 30}"#,
    );
    assert!(matches!(error, ModelError::NoEdge { .. }), "{error}");
}

#[test]
fn parts_of_sheets_are_drawn() {
    let mut model = made(&[
        PLATE,
        r#"{"do": "draw", "patch": "plate", "name": "cup", "outline": {"circle": {"center": [40, 25], "radius": 15}}, "by": [0, 0, -20], "scale": 0.8}"#,
    ]);
    assert_eq!(model.complex().counts().c, 1);
    assert_eq!(
        (model.complex().counts().ch, model.complex().counts().cc, model.complex().counts().r),
        (0, 0, 1)
    );
    let flat = r#"{"do": "draw", "patch": "plate", "name": "x", "outline": {"circle": {"center": [10, 10], "radius": 5}}, "by": [5, 0, 0]}"#;
    assert!(matches!(refused(&mut model, flat), ModelError::Number { .. }));
}

#[test]
fn folds_and_corners_are_rounded() {
    let mut model = made(&[
        PLATE,
        r#"{"do": "sweep", "name": "wall", "edges": [[0, 0, 0], [80, 0, 0]], "by": [0, 0, 30]}"#,
        r#"{"do": "round", "edge": [[0, 0, 0], [80, 0, 0]], "radius": 10, "name": "fillet"}"#,
    ]);
    assert_eq!(model.complex().counts().c, 1);
    let exact = 80.0 * (40.0 + 20.0 + 10.0 * std::f64::consts::FRAC_PI_2);
    near(area(&model.to_mesh()), exact, 0.01);
    done(&mut model, r#"{"do": "round", "corners": [[0, 50, 0], [80, 50, 0], [0, 0, 30]], "radius": 5}"#);
    assert!(matches!(
        refused(&mut model, r#"{"do": "round", "corners": [[0, 10, 0]], "radius": 5}"#),
        ModelError::CornerShared { .. }
    ));
    assert!(matches!(
        refused(&mut model, r#"{"do": "round", "edge": [[5, 50, 0], [75, 50, 0]], "radius": 5}"#),
        ModelError::NotAFold { .. }
    ));
    // On a solid the faces across the ends follow.
    let mut solid = made(&[
        &cube("box", 0., 0., 0.),
        r#"{"do": "round", "edge": [[0, 0, 0], [0, 0, 100]], "radius": 20}"#,
    ]);
    near(volume(&solid.to_mesh()), 1e6 - 100.0 * 400.0 * (1.0 - std::f64::consts::FRAC_PI_4), 1e-3);
    assert!(matches!(
        refused(&mut solid, r#"{"do": "round", "edge": [[100, 0, 0], [100, 100, 0]], "radius": 120}"#),
        ModelError::TooShort { .. }
    ));
}

#[test]
fn a_volume_becomes_a_sheet() {
    let mut model = made(&[
        r#"{"do": "extrude", "name": "walls", "outline": {"rectangle": {"at": [0, 0], "size": [60, 40]}}, "by": [0, 0, 30]}"#,
        r#"{"do": "add", "name": "floor", "points": [[0, 0, 0], [0, 40, 0], [60, 40, 0], [60, 0, 0]]}"#,
        r#"{"do": "add", "name": "lid", "points": [[0, 0, 30], [60, 0, 30], [60, 40, 30], [0, 40, 30]]}"#,
    ]);
    assert_eq!(model.complex().counts().cc, 1);
    done(&mut model, r#"{"do": "remove", "patches": ["lid"]}"#);
    assert_eq!(counts(&model), [8, 12, 5, 0, 1, 0, 0]);
    assert_eq!(model.patches(), ["walls", "floor"]);
}

#[test]
fn undo_and_redo_are_commands_too() {
    let mut model = Model::default();
    assert_eq!(refused(&mut model, r#"{"do": "undo"}"#), ModelError::Nothing("undo"));
    model.apply(&command(PLATE)).unwrap();
    let with = model.complex().clone();
    model.apply(&command(r#"{"do": "undo"}"#)).unwrap();
    assert_eq!(model.complex().face_count(), 0);
    model.apply(&command(r#"{"do": "redo"}"#)).unwrap();
    assert!(*model.complex() == with);
    let options = CheckOptions { positions: false };
    assert!(model.complex().check_with(options).is_empty());
    assert!(matches!(refused(&mut model, PLATE), ModelError::NameTaken { .. }));
}

// Scripts.

#[test]
fn bad_scripts_are_told_with_line_and_command() {
    let error = |text: &str| match Script::read(text) {
        Ok(script) => script.run(Limits::default()).map(|_| ()).expect_err(text),
        Err(error) => error,
    };
    let script = |commands: &str| format!("{{\n\"toile_script\": 1,\n\"commands\": [\n{commands}\n]\n}}");
    for (text, wanted) in [
        (script("{\"do\": \"create\"}"), "line 4, command 1 (create): missing field `name`"),
        (
            script("{\"do\": \"crate\", \"name\": \"x\"}"),
            "line 4, command 1 (crate): unknown variant `crate`",
        ),
        (
            script(&format!("{PLATE},\n\n{{\"do\": \"undo\", \"x\": 1}}")),
            "line 6, command 2 (undo): unknown field `x`",
        ),
        (script(&format!("{PLATE},\n{PLATE}")), "line 5, command 2 (create): the name \"plate\" is taken"),
        (
            script("{\"do\": \"join\"}"),
            "line 4, command 1 (join): the sheets have no edges or corners in one place",
        ),
        ("{\"toile_script\": 2, \"commands\": []}".into(), "the script is of version 2"),
        ("{\"toile_script\": 1,\n \"commands\": [}".into(), "line 2: expected value"),
        ("".into(), "line 1: EOF"),
        ("{\"toile_script\": 1, \"tolerance\": 0, \"commands\": []}".into(), "the tolerance is 0"),
        ("{\"toile_script\": 1, \"comands\": []}".into(), "line 1: unknown field `comands`"),
    ] {
        let told = error(&text).to_string();
        assert!(told.starts_with(wanted), "{told}\nis not\n{wanted}");
    }
    assert!(matches!(error(&script("{\"do\": \"join\"}")), ScriptError::Refused { line: 4, number: 1, .. }));
}
