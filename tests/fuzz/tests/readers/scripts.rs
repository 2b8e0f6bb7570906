//! Scripts of modelling commands: read, and carried out on small models.

use std::path::Path;

use design::drawings::of_script;
use fuzz::{Reader, Reading, Shape};
use mesh_kernel::glam::DVec2;
use sheet::model::{Limits, Script, ScriptError};
use sketch::{Drawing, Rule};

use crate::run;

/// All samples.
fn seeds() -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/sheets");
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut paths: Vec<_> = entries.filter_map(|e| e.ok().map(|e| e.path())).collect();
    paths.sort();
    let mut seeds: Vec<Vec<u8>> = paths.iter().filter_map(|p| std::fs::read(p).ok()).collect();
    assert!(seeds.len() > 5);
    seeds.push(EVERY_COMMAND.into());
    seeds
}

/// Commands and drawings that the samples do not have.
const EVERY_COMMAND: &str = r#"{"toile_script": 1, "tolerance": 2, "commands": [
{"do": "create", "name": "a", "outline": {"path": [{"line": [[0, 0], [60, 0]]}, {"arc_through": [[60, 0], [70, 20], [60, 40]]},
 {"bezier": [[60, 40], [30, 60], [0, 40]]}, {"spline": [[0, 40], [-9, 20], [0, 0]]}]}, "plane": "xy"},
{"do": "punch", "patch": "a", "outline": {"circle": {"center": [30, 20], "radius": 6}}},
{"do": "draw", "patch": "a", "name": "cup", "outline": {"rectangle": {"at": [10, 5], "size": [9, 9], "round": 2}}, "by": [0, 0, 5]},
{"do": "round", "corners": [[0, 0, 0]], "radius": 1},
{"do": "bend", "moving": "a", "about": [[60, 0, 0], [60, 40, 0]], "angle": 30},
{"do": "undo"}, {"do": "redo"},
{"do": "extrude", "name": "s", "solid": true, "outline": {"rectangle": {"at": [100, 0], "size": [20, 20]}}, "along": [[0, 0, 0], [0, 0, 9], [0, 9, 20]]},
{"do": "chamfer", "edge": [[100, 0, 0], [120, 0, 0]], "depth": 3, "name": "c"},
{"do": "create", "name": "p", "outline": {"rectangle": {"at": [0, 0], "size": [50, 50]}}, "plane": {"origin": [0, 0, 99], "x": [1, 0, 0], "y": [0, 1, 0]}},
{"do": "partial", "patch": "p"},
{"do": "join", "patches": ["a", "cup"], "split": true, "edges": "keep"},
{"do": "remove", "patches": ["s"]}
]}"#;

#[test]
fn script() {
    let limits = Limits { points: 60, faces: 300, ..Limits::default() };
    run(Reader {
        name: "script",
        shape: Shape::Json,
        seeds: seeds(),
        words: &[
            "null", "0", "-1", "1e308", "1e-308", "[0,0,0]", "[0,0]", "by", "along", "undo", "redo", "split",
            "true",
        ],
        inputs: 4_000,
        // A model of 300 faces and its triangles, whatever the text.
        base_memory: 16 << 20,
        memory_factor: 2_000,
        read: Box::new(move |bytes| {
            let Ok(text) = std::str::from_utf8(bytes) else { return Reading::Refused("no text".into()) };
            let run = match Script::read(text).and_then(|script| script.run(limits)) {
                Ok(run) => run,
                // What comes of geometry differs from input to input in its numbers.
                Err(ScriptError::Refused { name, source, .. }) => {
                    return Reading::Refused(format!("{name} {:.30}", source.to_string()));
                }
                Err(error) => return Reading::Refused(error.to_string().chars().take(200).collect()),
            };
            let complex = run.model.complex();
            assert!(complex.counts().identity_holds());
            let mesh = run.model.to_mesh();
            assert!(mesh.positions.iter().all(|p| p.is_finite()));
            let mut model = run.model.clone();
            while model.undo() {}
            assert_eq!(model.complex().face_count(), 0);
            vec_of(complex.vertex_count(), complex.edge_count(), complex.face_count())
        }),
    });
}

/// The drawing that a script begins with.
#[test]
fn drawing_of_script() {
    let draws = |seed: &Vec<u8>| std::str::from_utf8(seed).is_ok_and(|s| s.contains("outline"));
    let seeds: Vec<Vec<u8>> = seeds().into_iter().filter(draws).collect();
    assert!(seeds.len() > 5);
    run(Reader {
        name: "drawing_of_script",
        shape: Shape::Json,
        seeds,
        words: &[
            "null", "0", "-1", "1e308", "1e-308", "[0,0]", "outline", "holes", "drawings", "wire", "draw",
        ],
        inputs: 4_000,
        // Two thousand points, and the copies that edits work on.
        base_memory: 16 << 20,
        memory_factor: 2_000,
        read: Box::new(|bytes| {
            let Ok(text) = std::str::from_utf8(bytes) else { return Reading::Refused("no text".into()) };
            match of_script(text) {
                Ok((drawing, _)) => sound(&drawing),
                Err(error) => Reading::Refused(error.to_string().chars().take(60).collect()),
            }
        }),
    });
}

/// A drawing as drafts hold it.
#[test]
fn drawing() {
    let mut drawing = Drawing::default();
    let [a, b, c, d] = [(0.0, 0.0), (50.0, 0.0), (50.0, 40.0), (0.0, 40.0)]
        .map(|(x, y)| drawing.add_point(DVec2::new(x, y)).expect("finite"));
    let one = drawing.add_line(a, b).expect("a line");
    let other = drawing.add_bezier(b, DVec2::new(60.0, 5.0), DVec2::new(60.0, 35.0), c).expect("a curve");
    drawing.set_smooth(b, true).expect("a line and a curve");
    drawing.add_arc(c, DVec2::new(25.0, 50.0), d).expect("an arc");
    drawing.add_spline(&[d, c, a]).expect("a spline");
    drawing.add_circle(d, 5.0).expect("a circle");
    for rule in [Rule::Level(one), Rule::Length(one, 50.0), Rule::Fixed(a, DVec2::ZERO)] {
        drawing.add_rule(rule).expect("rules that hold");
    }
    assert!(drawing.curve(other).is_ok());
    run(Reader {
        name: "drawing",
        shape: Shape::Json,
        seeds: vec![serde_json::to_vec(&drawing).expect("pairs and numbers")],
        words: &[
            "null",
            "0",
            "-1",
            "4294967295",
            "1e308",
            "1e-308",
            "true",
            "[1,1]",
            "fixed",
            "parallel",
            "circle",
        ],
        inputs: 8_000,
        base_memory: 16 << 20,
        memory_factor: 2_000,
        read: Box::new(|bytes| match serde_json::from_slice::<Drawing>(bytes) {
            Ok(drawing) => sound(&drawing),
            Err(error) => Reading::Refused(error.to_string().chars().take(60).collect()),
        }),
    });
}

/// What holds of every drawing: it is read as it was written, its shapes have curves, and it can be edited.
fn sound(drawing: &Drawing) -> Reading {
    let text = serde_json::to_string(drawing).expect("pairs and numbers");
    assert_eq!(serde_json::from_str::<Drawing>(&text).expect("what was written is read"), *drawing);
    assert!(drawing.shapes().all(|(id, _)| drawing.curve(id).is_ok_and(|c| c.length() > 0.0)));
    let mut edited = drawing.clone();
    if edited.add_point(DVec2::ONE).is_ok() {
        assert_eq!(edited.points().count(), drawing.points().count() + 1, "numbers are given once");
    }
    let ids: Vec<_> = drawing.shapes().map(|(id, _)| id).collect();
    for id in ids {
        edited.delete_shape(id).expect("it is there");
    }
    assert!(edited.rules().iter().all(|rule| rule.shapes().is_empty()));
    Reading::Sound(vec![drawing.points().count(), drawing.shapes().count(), drawing.rules().len()])
}

fn vec_of(v: usize, e: usize, f: usize) -> Reading {
    Reading::Sound(vec![v, e, f])
}
