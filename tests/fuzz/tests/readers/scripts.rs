//! Scripts of modelling commands: read, and carried out on small models.

use std::path::Path;

use fuzz::{Reader, Reading, Shape};
use sheet::model::{Limits, Script, ScriptError};

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

fn vec_of(v: usize, e: usize, f: usize) -> Reading {
    Reading::Sound(vec![v, e, f])
}
