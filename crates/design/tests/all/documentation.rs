//! What the guide and the samples say is what the program reads.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mesh_kernel::files::{Format, WriteOptions, to_bytes};
use mesh_kernel::glam::DVec3;
use mesh_kernel::{Group, TriMesh};
use template::Template;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// `UPDATE_DOCS=1 cargo test --release -p design --test all documentation` writes the schema anew.
#[test]
fn the_schema_in_the_guide_is_the_programs() {
    let path = root().join("docs/template.schema.json");
    let text = serde_json::to_string_pretty(&Template::schema()).unwrap() + "\n";
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    assert_eq!(
        std::fs::read_to_string(&path).unwrap(),
        text,
        "run with UPDATE_DOCS=1 and look at the change"
    );
}

#[test]
fn the_guides_example_is_a_template() {
    let guide = std::fs::read_to_string(root().join("docs/templates.md")).unwrap();
    let example = guide.split("```json\n").nth(1).unwrap().split("```").next().unwrap();
    let template = Template::from_json(example).unwrap();
    assert_eq!(template.file().surfaces.len(), 2);
}

#[test]
fn samples_are_templates() {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(root().join("samples")).unwrap() {
        let path = entry.unwrap().path();
        // Folders hold samples of other kinds.
        if !path.is_file() {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        if path.extension().is_some_and(|e| e == "json") && text.contains("toile_template") {
            Template::from_json(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
            names.push(path.file_stem().unwrap().to_string_lossy().into_owned());
        }
    }
    names.sort();
    assert_eq!(names, ["fitted-bodice", "princess-dress"]);
}

/// The sample sheet is made here: `UPDATE_DOCS=1 cargo test --release -p design --test all documentation` writes it anew.
#[test]
fn the_sample_sheet_is_the_one_described() {
    let path = root().join("samples/desk-tray.obj");
    let comments = vec!["a desk tray as a sheet, in millimetres: a group a patch".to_owned()];
    let options = WriteOptions { decimals: Some(4), comments, ..WriteOptions::default() };
    let bytes = to_bytes(Format::Obj, &desk_tray(), &options);
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, &bytes).unwrap();
    }
    assert!(std::fs::read(&path).unwrap() == bytes, "run with UPDATE_DOCS=1 and look at the change");
}

/// An open box with a bulging front and leaning walls, parted once across and once along. Its nodes are those of a
/// lattice, so that patches share them: three patches meet wherever a partition stands on another patch, four where the
/// one along ends on the one across. The fronts of floor and walls look inward.
fn desk_tray() -> TriMesh {
    /// Cells of the lattice from back to front, from left to right, from the floor up.
    const CELLS: [u32; 3] = [12, 10, 5];
    /// Where the partitions stand, and how high.
    const ACROSS: u32 = 7;
    const ALONG: u32 = 4;
    const HEIGHT: u32 = 4;
    /// Millimetres; the lean of the walls as a share of the tray's size.
    const DEPTH: f64 = 90.0;
    const BULGE: f64 = 30.0;
    const WIDTH: f64 = 120.0;
    const WALL: f64 = 40.0;
    const LEAN: f64 = 0.08;

    let place = |[i, j, k]: [u32; 3]| {
        let [u, v, w] = [0, 1, 2].map(|a| f64::from([i, j, k][a]) / f64::from(CELLS[a]));
        let side = 2.0 * v - 1.0;
        let lean = 1.0 + LEAN * w;
        DVec3::new(
            side * WIDTH / 2.0 * lean,
            w * WALL,
            (u * (DEPTH + BULGE * (1.0 - side * side)) - DEPTH / 2.0) * lean,
        )
    };
    let [x, y, z] = CELLS;
    // Name, one corner in the lattice, the two directions in which the patch extends, cells along them.
    type Patch = (&'static str, [u32; 3], [usize; 2], [u32; 2]);
    let patches: [Patch; 7] = [
        ("floor", [0, 0, 0], [0, 1], [x, y]),
        ("back", [0, 0, 0], [1, 2], [y, z]),
        ("front", [x, 0, 0], [2, 1], [z, y]),
        ("left", [0, 0, 0], [2, 0], [z, x]),
        ("right", [0, y, 0], [0, 2], [x, z]),
        ("across", [ACROSS, 0, 0], [1, 2], [y, HEIGHT]),
        ("along", [0, ALONG, 0], [0, 2], [ACROSS, HEIGHT]),
    ];
    let mut mesh = TriMesh::default();
    let mut known: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    for (name, corner, directions, cells) in patches {
        let first = mesh.faces.len() as u32;
        for a in 0..cells[0] {
            for b in 0..cells[1] {
                let [p, q, r, s] = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[da, db]| {
                    let mut at = corner;
                    at[directions[0]] += a + da;
                    at[directions[1]] += b + db;
                    *known.entry(at).or_insert_with(|| {
                        mesh.positions.push(place(at));
                        mesh.positions.len() as u32 - 1
                    })
                });
                mesh.faces.extend(if (a + b) % 2 == 0 {
                    [[p, q, r], [p, r, s]]
                } else {
                    [[p, q, s], [q, r, s]]
                });
            }
        }
        mesh.groups.push(Group { name: name.to_owned(), faces: first..mesh.faces.len() as u32 });
    }
    mesh
}
