//! Models made by commands, checked after every one of them.

use mesh_kernel::TriMesh;
use mesh_kernel::body::Counts;
use sheet::model::{Command, Done, Limits, Model, ModelError};

pub(crate) fn command(text: &str) -> Command {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

/// Applies commands; after each the model is sound, and undone and done again it is the same, bit for bit.
#[track_caller]
pub(crate) fn made(commands: &[&str]) -> Model {
    let mut model = Model::new(Limits { tolerance: 0.5, ..Limits::default() });
    for text in commands {
        done(&mut model, text);
    }
    model
}

#[track_caller]
pub(crate) fn done(model: &mut Model, text: &str) -> Done {
    let before = model.complex().clone();
    let patches = model.patches();
    let done = model.apply(&command(text)).unwrap_or_else(|e| panic!("{e}: {text}"));
    assert_eq!(model.complex().check(), [], "{text}");
    let after = model.complex().clone();
    assert!(model.undo());
    assert!(*model.complex() == before && model.patches() == patches, "undone: {text}");
    assert!(model.redo());
    assert!(*model.complex() == after, "done again: {text}");
    done
}

#[track_caller]
pub(crate) fn refused(model: &mut Model, text: &str) -> ModelError {
    let before = model.clone();
    let error = model.apply(&command(text)).expect_err(text);
    assert!(*model == before, "a refused command changes nothing: {text}");
    error
}

#[track_caller]
pub(crate) fn counts(model: &Model) -> [i64; 7] {
    let Counts { v, e, f, r, c, ch, cc } = model.complex().counts();
    [v, e, f, r, c, ch, cc]
}

pub(crate) fn area(mesh: &TriMesh) -> f64 {
    (0..mesh.faces.len() as u32).map(|f| mesh.area_normal(f).length() / 2.0).sum()
}

pub(crate) fn volume(mesh: &TriMesh) -> f64 {
    let six = |f: u32| {
        let [a, b, c] = mesh.corners(f);
        a.cross(b).dot(c)
    };
    (0..mesh.faces.len() as u32).map(six).sum::<f64>() / 6.0
}

#[track_caller]
pub(crate) fn near(value: f64, wanted: f64, relative: f64) {
    assert!((value - wanted).abs() <= relative * wanted.abs(), "{value} is not {wanted}");
}

pub(crate) fn cube(name: &str, x: f64, y: f64, z: f64) -> String {
    format!(
        r#"{{"do": "extrude", "name": "{name}", "solid": true, "outline": {{"rectangle": {{"at": [{x}, {y}], "size": [100, 100]}}}},
        "plane": {{"origin": [0, 0, {z}], "x": [1, 0, 0], "y": [0, 1, 0]}}, "by": [0, 0, 100]}}"#
    )
}
