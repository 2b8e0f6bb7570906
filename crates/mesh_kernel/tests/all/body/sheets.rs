//! The shared sheets: sound, counted as their table says, and the queries of sectors, shells and regions on them.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use mesh_kernel::TriMesh;
use mesh_kernel::body::{Body, EdgeId, FaceId, FaceSide, FaceUse, Pairing, PairingError, SurfaceId};
use mesh_kernel::files;

fn sheets() -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/sheets");
    if path.exists() {
        return Some(path);
    }
    assert!(
        std::env::var("TOILE_REQUIRE_SHARED").as_deref() != Ok("1"),
        "{} is required and not there",
        path.display()
    );
    None
}

/// Every OBJ in the folder with its row in the table, which names them all.
fn all() -> Vec<(String, TriMesh, serde_json::Value)> {
    let Some(folder) = sheets() else { return Vec::new() };
    let table = std::fs::read_to_string(folder.join("sheets.json")).unwrap();
    let table: serde_json::Value = serde_json::from_str(&table).unwrap();
    let mut names: Vec<String> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|f| f.unwrap().file_name().into_string().unwrap())
        .filter(|n| n.ends_with(".obj"))
        .collect();
    names.sort();
    let listed: Vec<&String> = table.as_object().unwrap().keys().collect();
    assert_eq!(names.iter().collect::<BTreeSet<_>>(), listed.into_iter().collect::<BTreeSet<_>>());
    names
        .into_iter()
        .map(|n| (n.clone(), files::read(&folder.join(&n)).unwrap(), table[&n].clone()))
        .collect()
}

fn number(row: &serde_json::Value, key: &str) -> i64 {
    row[key].as_i64().unwrap()
}

/// How many faces meet at every edge of the mesh, found without the body.
fn valences(mesh: &TriMesh) -> BTreeMap<[u32; 2], i64> {
    let mut valences = BTreeMap::new();
    for f in &mesh.faces {
        for (p, q) in [(f[0], f[1]), (f[1], f[2]), (f[2], f[0])] {
            *valences.entry([p.min(q), p.max(q)]).or_default() += 1;
        }
    }
    valences
}

#[test]
fn every_sheet_is_sound_and_has_the_counts_of_its_table() {
    for (name, mesh, row) in all() {
        let body = Body::from_tri_mesh(&mesh).unwrap();
        assert_eq!(body.check(), [], "{name}");
        let counts = body.counts();
        assert!(counts.identity_holds(), "{name}: {counts}");
        // Each is one connected model without tunnels; what it encloses is listed.
        assert_eq!((counts.c, counts.ch, counts.cc), (1, 0, number(&row, "volumes")), "{name}");
        assert_eq!(counts.v - counts.e + counts.f, number(&row, "euler_number"), "{name}");

        // Edges by the number of sheets at them, from the body: joints by their sheets, the rest by their faces.
        let mut by_valence: BTreeMap<i64, i64> = BTreeMap::new();
        for (id, joint) in body.joints() {
            *by_valence.entry(joint.radial().len() as i64).or_default() += body.joint_len(id) as i64;
        }
        for (_, s) in body.surfaces() {
            for (e, faces) in s.edge_faces().iter().enumerate() {
                if s.edge_chain(EdgeId(e as u32)).is_none_or(|c| s.chain(c).joint().is_none()) {
                    let there = faces.iter().filter(|f| **f != mesh_kernel::body::NONE).count() as i64;
                    *by_valence.entry(there).or_default() += 1;
                }
            }
        }
        let mut expected: BTreeMap<i64, i64> = BTreeMap::new();
        valences(&mesh).values().for_each(|n| *expected.entry(*n).or_default() += 1);
        assert_eq!(by_valence, expected, "{name}");
        let of = |n: i64| by_valence.get(&n).copied().unwrap_or(0);
        assert_eq!(of(1), number(&row, "boundary_edges"), "{name}");
        assert_eq!(of(2), number(&row, "manifold_edges"), "{name}");
        let many: i64 = by_valence.range(3..).map(|(_, n)| n).sum();
        assert_eq!(many, number(&row, "non_manifold_edges"), "{name}");
        let branching: Vec<i64> = row["faces_at_non_manifold_edges"]
            .as_array()
            .unwrap()
            .iter()
            .map(|n| n.as_i64().unwrap())
            .collect();
        assert_eq!(by_valence.range(3..).map(|(n, _)| *n).collect::<Vec<_>>(), branching, "{name}");

        let junctions = body.non_manifold_joints();
        assert_eq!(junctions.len() as i64, number(&row, "junction_curves"), "{name}");
        assert_eq!(body.non_manifold_nodes(), [], "{name}");
    }
}

#[test]
fn windings_of_patches_do_not_matter() {
    for (name, mesh, row) in all() {
        for turned in 1..8u32 {
            let mut mesh = mesh.clone();
            for (g, group) in mesh.groups.iter().enumerate() {
                if turned >> (g % 3) & 1 == 1 {
                    mesh.faces[group.faces.start as usize..group.faces.end as usize]
                        .iter_mut()
                        .for_each(|f| f.swap(1, 2));
                }
            }
            let body = Body::from_tri_mesh(&mesh).unwrap();
            assert_eq!(body.check(), [], "{name}");
            let counts = body.counts();
            assert_eq!((counts.c, counts.ch, counts.cc), (1, 0, number(&row, "volumes")), "{name}");
            let mut volumes: Vec<f64> = body.regions().regions().iter().filter_map(|r| r.volume).collect();
            volumes.iter_mut().for_each(|v| *v = (*v * 1e6).round() / 1e6);
            let boxes = vec![36_000.0; number(&row, "volumes") as usize];
            assert_eq!(volumes, boxes, "{name}");
        }
    }
}

#[test]
fn sectors_go_once_round_every_edge_and_look_into_one_region() {
    for (name, mesh, _) in all() {
        let body = Body::from_tri_mesh(&mesh).unwrap();
        let regions = body.regions();
        let region = |u: FaceUse| regions.region(u.surface, u.face, u.side);
        let shell = |u: FaceUse| regions.shell(u.surface, u.face, u.side);
        for (id, s) in body.surfaces() {
            for e in (0..s.edges().len() as u32).map(EdgeId) {
                let sectors = body.edge_sectors(id, e);
                let sum: f64 = sectors.iter().map(|s| s.angle).sum();
                assert!((sum - TAU).abs() < 1e-9, "{name}: {sum}");
                for s in &sectors {
                    let [from, to] = [s.from, s.to].map(Option::unwrap);
                    assert_eq!((shell(from), region(from)), (shell(to), region(to)), "{name}");
                }
            }
        }
        // Every face-use bounds one region and belongs to one shell.
        let mut seen: Vec<FaceUse> = Vec::new();
        for r in 0..regions.regions().len() as u32 {
            let uses = regions.faces_of(r);
            assert!(!uses.is_empty() && uses.iter().all(|u| region(*u) == r), "{name}");
            seen.extend(uses);
        }
        assert!(regions.faces_of(99).is_empty());
        seen.sort_unstable();
        let every: Vec<FaceUse> = body
            .surfaces()
            .flat_map(|(surface, s)| (0..s.faces().len() as u32).map(move |f| (surface, FaceId(f))))
            .flat_map(|(surface, face)| {
                [FaceSide::Front, FaceSide::Back].map(|side| FaceUse { surface, face, side })
            })
            .collect();
        assert_eq!(seen, every, "{name}");
        let by_shell: usize =
            (0..regions.shell_count() as u32).map(|s| regions.faces_of_shell(s).len()).sum();
        assert_eq!(by_shell, every.len(), "{name}");
        // Neighbours go round.
        for (id, joint) in body.joints() {
            for &sheet in joint.radial() {
                let [before, after] = body.radial_neighbours(id, sheet).unwrap();
                assert_eq!(body.radial_neighbours(id, after).unwrap()[0], sheet);
                assert_eq!(body.radial_neighbours(id, before).unwrap()[1], sheet);
            }
        }
    }
}

#[test]
fn junctions_of_sheets_are_paired_where_they_can_be() {
    for (name, mesh, row) in all() {
        let body = Body::from_tri_mesh(&mesh).unwrap();
        for joint in body.non_manifold_joints() {
            let sheets = body.joint(joint).radial().len();
            if sheets % 2 == 1 {
                let refused = body.resolve_edge(joint, Pairing::Miss).unwrap_err();
                assert!(matches!(refused, PairingError::Odd { .. }), "{name}: {refused}");
                continue;
            }
            // Turn patches so that entering and leaving alternate.
            let mut mesh = mesh.clone();
            for k in (0..sheets).step_by(2).chain((1..sheets).step_by(2)) {
                let sheet = body.joint(joint).radial()[k];
                let (surface, _) = body.sheet_face(joint, sheet, 0).unwrap();
                if (sheet.side == mesh_kernel::body::Side::Left) != (k % 2 == 0) {
                    let SurfaceId(g) = surface;
                    let faces = mesh.groups[g as usize].faces.clone();
                    mesh.faces[faces.start as usize..faces.end as usize]
                        .iter_mut()
                        .for_each(|f| f.swap(1, 2));
                }
            }
            let body = Body::from_tri_mesh(&mesh).unwrap();
            let joint = body.non_manifold_joints()[0];
            assert!(body.alternates(joint), "{name}");
            for pairing in [Pairing::Miss, Pairing::Join] {
                let done = body.resolve_edge(joint, pairing).unwrap();
                assert_eq!(done.body.check(), [], "{name}");
                assert!(done.after.identity_holds(), "{name}");
                // Half the sheets each, touching at both ends.
                assert_eq!((done.after.c, done.after.ch, done.touching.len()), (1, 1, 2), "{name}");
                assert_eq!(done.after.e - done.before.e, number(&row, "non_manifold_edges"), "{name}");
                assert!((done.body.area() - body.area()).abs() < 1e-9 * body.area());
            }
        }
    }
}
