//! Counts, identity and volumes on worked examples (Lipson & Shpitalni) and on the shared sheets.

use std::path::PathBuf;

use mesh_kernel::body::{Body, Counts, FaceId, FaceSide};
use mesh_kernel::glam::DVec3;
use mesh_kernel::{Group, TriMesh};

fn body(positions: &[[f64; 3]], facets: &[&[u32]]) -> Body {
    // Every facet a group, fanned from its first corner.
    let mut mesh = TriMesh::new(positions.iter().map(|&p| DVec3::from(p)).collect(), Vec::new());
    for (i, facet) in facets.iter().enumerate() {
        let from = mesh.faces.len() as u32;
        for k in 1..facet.len() - 1 {
            mesh.faces.push([facet[0], facet[k], facet[k + 1]]);
        }
        mesh.groups.push(Group { name: format!("f{i}"), faces: from..mesh.faces.len() as u32 });
    }
    Body::from_tri_mesh(&mesh).unwrap()
}

/// (components, cycles, voids), the same before and after a split, with the identity.
fn shape(mut body: Body) -> (i64, i64, i64) {
    let before = body.counts();
    assert_eq!(body.check(), []);
    assert!(before.identity_holds(), "{before}");
    body.split_all(None).unwrap();
    let Counts { c, ch, cc, .. } = body.counts();
    assert!(body.counts().identity_holds(), "{}", body.counts());
    assert_eq!((c, ch, cc), (before.c, before.ch, before.cc));
    (c, ch, cc)
}

const CUBE: [[f64; 3]; 8] = [
    [0., 0., 0.],
    [1., 0., 0.],
    [1., 1., 0.],
    [0., 1., 0.],
    [0., 0., 1.],
    [1., 0., 1.],
    [1., 1., 1.],
    [0., 1., 1.],
];
const CUBE_FACETS: [&[u32]; 6] =
    [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];

#[test]
fn extruded_y() {
    let y = body(
        &[
            [0., 0., 0.],
            [0., 0., 1.],
            [0., -1., 0.],
            [0., -1., 1.],
            [1., 1., 0.],
            [1., 1., 1.],
            [-1., 1., 0.],
            [-1., 1., 1.],
        ],
        &[&[0, 1, 3, 2], &[0, 1, 5, 4], &[0, 1, 7, 6]],
    );
    assert_eq!(y.free_edges().len(), 9);
    // Three lines from one end of the joint to the other.
    let (joint, _) = y.joints().next().unwrap();
    let sectors = y.sectors(joint, 0);
    assert!(
        (sectors.iter().map(|s| s.angle).sum::<f64>() - std::f64::consts::TAU).abs() < 1e-12,
        "{sectors:?}"
    );
    assert_eq!((sectors.len(), y.regions().regions().len(), y.alternates(joint)), (3, 1, false));
    let lines = y.boundary_loops();
    assert!(lines.len() == 3 && lines.iter().all(|l| !l.is_closed() && l.edges.len() == 3), "{lines:?}");
    assert_eq!(y.volume(), None);
    assert_eq!(y.counts().v, 8);
    assert_eq!(shape(y), (1, 0, 0));
}

#[test]
fn corner_of_three_facets() {
    let corner = body(&CUBE, &[CUBE_FACETS[0], CUBE_FACETS[2], CUBE_FACETS[5]]);
    assert_eq!((corner.counts().v, corner.free_edges().len()), (7, 6));
    let rim = corner.boundary_loops();
    assert!(rim.len() == 1 && rim[0].is_closed() && rim[0].edges.len() == 6, "{rim:?}");
    assert_eq!(shape(corner), (1, 0, 0));
}

#[test]
fn box_with_a_partition() {
    let mut positions = CUBE.to_vec();
    positions.extend([[2., 0., 0.], [2., 1., 0.], [2., 0., 1.], [2., 1., 1.]]);
    let partitioned = body(
        &positions,
        &[
            &[0, 1, 2, 3],
            &[4, 5, 6, 7],
            &[0, 1, 5, 4],
            &[1, 2, 6, 5],
            &[2, 3, 7, 6],
            &[3, 0, 4, 7],
            &[1, 8, 9, 2],
            &[5, 10, 11, 6],
            &[1, 8, 10, 5],
            &[2, 9, 11, 6],
            &[8, 9, 11, 10],
        ],
    );
    assert_eq!((partitioned.counts().v, partitioned.free_edges().len()), (12, 0));
    let regions = partitioned.regions();
    let wall = partitioned.surface_named("f3").unwrap();
    let sides = [FaceSide::Front, FaceSide::Back].map(|s| regions.region(wall, FaceId(0), s));
    assert!(sides == [1, 2] || sides == [2, 1], "{sides:?}");
    assert_eq!(regions.regions().len(), 3);
    let volumes = partitioned.void_volumes();
    assert!(volumes.len() == 2 && volumes.iter().all(|v| (v - 1.0).abs() < 1e-15), "{volumes:?}");
    assert!((partitioned.volume().unwrap() - 2.0).abs() < 1e-15);
    assert_eq!(shape(partitioned), (1, 0, 2));
}

/// A ring of `n` prisms' side walls; `keep` says which of bottom, top, outer wall and inner wall of segment `k` stay.
fn ring(n: u32, keep: impl Fn(u32) -> [bool; 4]) -> Body {
    let mut positions = Vec::new();
    for (r, z) in [(2., 0.), (4., 0.), (4., 1.), (2., 1.)] {
        for k in 0..n {
            let a = std::f64::consts::TAU * f64::from(k) / f64::from(n);
            positions.push([r * a.cos(), r * a.sin(), z]);
        }
    }
    let mut facets = Vec::new();
    for k in 0..n {
        let l = (k + 1) % n;
        for (row, _) in keep(k).iter().enumerate().filter(|(_, k)| **k) {
            let (p, q) = (row as u32 * n, (row as u32 + 1) % 4 * n);
            facets.push(vec![p + k, p + l, q + l, q + k]);
        }
    }
    let facets: Vec<&[u32]> = facets.iter().map(Vec::as_slice).collect();
    body(&positions, &facets)
}

#[test]
fn square_torus() {
    let torus = ring(4, |_| [true; 4]);
    assert_eq!(torus.counts().v, 16);
    // Square ring: (4·√2)² − (2·√2)² over height 1.
    let volume = torus.volume().unwrap();
    assert!((volume - 24.0).abs() < 1e-12, "{volume}");
    assert_eq!(shape(torus), (1, 2, 1));
    let closed_by_shell = ring(24, |_| [true; 4]);
    assert_eq!(shape(closed_by_shell), (1, 2, 1));
}

#[test]
fn hexagon_prism_without_three_alternate_sides() {
    let n = 6;
    let mut positions = Vec::new();
    for z in [0., 1.] {
        for k in 0..n {
            let a = std::f64::consts::TAU * f64::from(k) / f64::from(n);
            positions.push([a.cos(), a.sin(), z]);
        }
    }
    let (bottom, top): (Vec<u32>, Vec<u32>) = ((0..6).rev().collect(), (6..12).collect());
    let sides: Vec<Vec<u32>> = (0..6).step_by(2).map(|k| vec![k, k + 1, k + 7, k + 6]).collect();
    let mut facets: Vec<&[u32]> = vec![&bottom, &top];
    facets.extend(sides.iter().map(Vec::as_slice));
    let prism = body(&positions, &facets);
    assert_eq!(prism.counts().v, 12);
    assert_eq!(shape(prism), (1, 2, 0));
}

#[test]
fn nested_touching_and_separate_shells() {
    let tetrahedron: [&[u32]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]];
    let place = |at: [f64; 3], size: f64| {
        [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]]
            .map(|p: [f64; 3]| [at[0] + size * p[0], at[1] + size * p[1], at[2] + size * p[2]])
    };
    // One inside the other: two components, two voids of one's own shell each.
    let mut positions = place([0.; 3], 8.0).to_vec();
    positions.extend(place([1.; 3], 1.0));
    let shifted: Vec<Vec<u32>> = tetrahedron.iter().map(|f| f.iter().map(|v| v + 4).collect()).collect();
    let mut facets = tetrahedron.to_vec();
    facets.extend(shifted.iter().map(Vec::as_slice));
    let nested = body(&positions, &facets);
    // Outside, between the two, inside the inner one.
    let regions = nested.regions();
    let volumes: Vec<_> = regions.regions().iter().map(|r| r.volume).collect();
    assert_eq!(volumes.len(), 3);
    assert!(volumes[0].is_none() && (volumes[1].unwrap() - 511.0 / 6.0).abs() < 1e-12, "{volumes:?}");
    assert!((volumes[2].unwrap() - 1.0 / 6.0).abs() < 1e-12, "{volumes:?}");
    assert_eq!(regions.regions()[1].shells.len(), 2);
    let inner = nested.surface_named("f5").unwrap();
    assert_eq!(regions.region(inner, FaceId(0), FaceSide::Front), 1);
    assert_eq!(regions.region(inner, FaceId(0), FaceSide::Back), 2);
    assert_eq!(shape(nested), (2, 0, 2));
    // The inner one turned round is a cavity.
    let turned: Vec<Vec<u32>> = shifted.iter().map(|f| f.iter().rev().copied().collect()).collect();
    let mut facets = tetrahedron.to_vec();
    facets.extend(turned.iter().map(Vec::as_slice));
    let cavity = body(&positions, &facets);
    assert!((cavity.volume().unwrap() - (512.0 - 1.0) / 6.0).abs() < 1e-12);
    // Two that share a node only.
    let touching: Vec<Vec<u32>> =
        tetrahedron.iter().map(|f| f.iter().map(|&v| if v == 0 { 0 } else { v + 3 }).collect()).collect();
    let mut positions = place([0.; 3], 1.0).to_vec();
    positions.extend(&place([0.; 3], -1.0)[1..]);
    let mut facets = tetrahedron.to_vec();
    facets.extend(touching.iter().map(Vec::as_slice));
    let touching = body(&positions, &facets);
    assert_eq!(touching.counts().v, 7);
    assert_eq!(shape(touching), (1, 0, 2));
}

#[test]
fn a_moebius_strip_has_one_cycle_and_one_shell() {
    let n = 9u32;
    let mut positions = Vec::new();
    for k in 0..n {
        let a = std::f64::consts::TAU * f64::from(k) / f64::from(n);
        for s in [-1.0, 1.0] {
            let r = 5.0 + s * (a / 2.0).cos();
            positions.push([r * a.cos(), r * a.sin(), s * (a / 2.0).sin()]);
        }
    }
    let mut facets = Vec::new();
    for k in 0..n {
        let (a, b) = (2 * k, 2 * k + 1);
        let (c, d) = if k + 1 < n { (a + 2, b + 2) } else { (1, 0) };
        facets.push(vec![a, b, d, c]);
    }
    let facets: Vec<&[u32]> = facets.iter().map(Vec::as_slice).collect();
    assert_eq!(shape(body(&positions, &facets)), (1, 1, 0));
}

fn shared(path: &str) -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared").join(path);
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

fn read_obj(path: &std::path::Path) -> TriMesh {
    let text = std::fs::read_to_string(path).unwrap();
    let mut mesh = TriMesh::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let p: Vec<f64> = words.map(|w| w.parse().unwrap()).collect();
                mesh.positions.push(DVec3::new(p[0], p[1], p[2]));
            }
            Some("g") => {
                let at = mesh.faces.len() as u32;
                mesh.groups.push(Group { name: words.next().unwrap().into(), faces: at..at });
            }
            Some("f") => {
                let f: Vec<u32> = words.map(|w| w.parse::<u32>().unwrap() - 1).collect();
                mesh.faces.push([f[0], f[1], f[2]]);
                if let Some(g) = mesh.groups.last_mut() {
                    g.faces.end += 1;
                }
            }
            _ => {}
        }
    }
    mesh
}

#[test]
fn shared_sheets_have_the_counts_of_their_table() {
    let Some(table) = shared("sheets/sheets.json") else { return };
    let table: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(table).unwrap()).unwrap();
    for (name, row) in table.as_object().unwrap() {
        let Some(path) = shared(&format!("sheets/{name}")) else { continue };
        let mesh = read_obj(&path);
        let body = Body::from_tri_mesh(&mesh).unwrap();
        let number = |key: &str| row[key].as_i64().unwrap();
        let counts = body.counts();
        assert!(counts.identity_holds(), "{name}: {counts}");
        assert_eq!(body.check(), [], "{name}");
        assert_eq!(counts.v, number("vertices"), "{name}");
        assert_eq!(counts.e, number("edges"), "{name}");
        assert_eq!(counts.f, number("triangles"), "{name}");
        assert_eq!(counts.c - counts.ch + counts.cc, number("euler_number"), "{name}");
        assert_eq!(counts.cc, number("volumes"), "{name}");
        assert_eq!(body.surfaces().len() as i64, number("patches"), "{name}");
        assert_eq!(body.free_edges().len() as i64, number("boundary_edges"), "{name}");
        let area = row["area_mm2"].as_f64().unwrap();
        assert!((body.area() - area).abs() <= 1e-5 * area, "{name}: {} for {area}", body.area());
        let junctions = body.joints().filter(|(_, j)| j.radial().len() > 2).count() as i64;
        assert_eq!(junctions, number("junction_curves"), "{name}");
        if name.starts_with("box-partition") {
            let volumes = body.void_volumes();
            assert!(volumes.iter().all(|v| (v - 36_000.0).abs() < 1e-6), "{name}: {volumes:?}");
        }
        let back = body.to_tri_mesh();
        assert_eq!(back.positions.len(), mesh.positions.len(), "{name}");
        assert_eq!(back.faces.len(), mesh.faces.len(), "{name}");
    }
}
