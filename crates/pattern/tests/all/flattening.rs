//! Flattening: exact where the surface is developable, least stretch elsewhere, seams equal, never a flip.

use crate::surfaces::{cap, column, cone, cylinder, grid, saddle, tube};
use glam::DVec3;
use pattern::*;
use proptest::prelude::*;

fn alone(patch: Patch) -> PatternInput {
    PatternInput { patches: vec![patch], ..PatternInput::default() }
}

fn flatten(input: &PatternInput) -> Pattern {
    make(input, &PatternOptions::default()).unwrap()
}

/// A sleeve-like doubly curved patch between two angles.
fn barrel(name: &str, from: f64, to: f64, n: u32, m: u32) -> Patch {
    grid(name, n, m, |u, v| {
        let (s, c) = (from + (to - from) * u).sin_cos();
        let r = 110.0 + 25.0 * (std::f64::consts::PI * v).sin();
        DVec3::new(r * s, 300.0 * v, r * c)
    })
}

#[test]
fn developable_surfaces_keep_all_lengths() {
    for patch in [cylinder(30), cone(30)] {
        let name = patch.name.clone();
        let pattern = flatten(&alone(patch));
        let report = &pattern.pieces[0].report;
        assert!(report.max_stretch < 1e-8, "{name}: {report:?}");
        assert_eq!((report.flipped, report.overlaps), (0, 0));
    }
}

#[test]
fn curved_surfaces_reach_the_least_energy_known() {
    // Energies that SLIM reaches on these surfaces when run long (finer meshes: 4.0655 and 4.01218).
    let input = PatternInput { patches: vec![cap(60), saddle(60)], ..PatternInput::default() };
    let pattern = make(&input, &PatternOptions { area_weight: 0.0, ..PatternOptions::default() }).unwrap();
    for (piece, [low, high]) in pattern.pieces.iter().zip([[4.060, 4.0660], [4.0118, 4.0123]]) {
        let report = &piece.report;
        assert!(report.energy > low && report.energy < high, "{}: {report:?}", piece.name);
        assert_eq!((report.flipped, report.overlaps), (0, 0));
    }
}

#[test]
fn a_weight_on_areas_keeps_areas() {
    let input = PatternInput { patches: vec![cap(30), saddle(30)], ..PatternInput::default() };
    let change = |area_weight: f64| {
        let pattern = make(&input, &PatternOptions { area_weight, ..PatternOptions::default() }).unwrap();
        assert!(pattern.pieces.iter().all(|p| p.report.flipped == 0));
        pattern.pieces.iter().map(|p| p.report.mean_area_change).collect::<Vec<_>>()
    };
    let (free, weighted) = (change(0.0), change(10.0));
    assert!(free.iter().zip(&weighted).all(|(a, b)| b < &(0.4 * a)), "{free:?} {weighted:?}");
}

#[test]
fn seam_partners_get_equal_lengths() {
    let (n, m) = (12, 20);
    let patches =
        vec![barrel("front", 0.0, 0.9, n, m), barrel("side", 0.9, 1.4, n, m), barrel("back", 1.4, 2.6, n, m)];
    let seam = |name: &str, a: usize, b: usize| SeamInput {
        name: name.to_owned(),
        sides: vec![SeamSide { patch: a, nodes: column(m, n) }, SeamSide { patch: b, nodes: column(m, 0) }],
    };
    let mut input = PatternInput { patches, ..PatternInput::default() };
    let free = flatten(&input);
    input.seams = vec![seam("front side", 0, 1), seam("side back", 1, 2)];
    let sewn = flatten(&input);
    for check in &sewn.seams {
        assert!(check.edge_mismatch < 1e-4, "{check:?}");
        assert!(check.mismatch < 1e-6 * check.length_3d, "{check:?}");
        assert!((check.lengths_2d[0] / check.length_3d - 1.0).abs() < 0.05);
    }
    for (a, b) in free.pieces.iter().zip(&sewn.pieces) {
        assert!(
            b.report.energy < 4.0 + 4.0 * (a.report.energy - 4.0).max(2e-4),
            "{} {}",
            a.report.energy,
            b.report.energy
        );
        assert_eq!((b.report.flipped, b.report.overlaps), (0, 0));
    }
}

#[test]
fn three_patches_share_a_seam_and_one_of_them_inside() {
    let (n, m) = (10, 16);
    let patches =
        vec![barrel("left", 0.0, 0.8, n, m), barrel("right", 0.8, 1.6, n, m), barrel("over", 0.4, 1.2, n, m)];
    let sides =
        [(0, n), (1, 0), (2, n / 2)].map(|(patch, i)| SeamSide { patch, nodes: column(m, i) }).to_vec();
    let seams = vec![SeamInput { name: "joint".to_owned(), sides }];
    let pattern = flatten(&PatternInput { patches, seams, ..PatternInput::default() });
    let check = &pattern.seams[0];
    assert_eq!(check.lengths_2d.len(), 3);
    assert!(check.mismatch < 1e-3 && check.edge_mismatch < 1e-4, "{check:?}");
    assert_eq!(pattern.pieces[2].lines.len(), 1, "the inner side is drawn");
}

#[test]
fn a_dart_along_a_given_cut_opens_and_its_sides_match() {
    let (n, m) = (20, 20);
    let dome = |u: f64, v: f64| {
        let (x, y) = (2.0 * u - 1.0, 2.0 * v - 1.0);
        DVec3::new(150.0 * x, 150.0 * y, 60.0 * (-2.0 * (x * x + y * y)).exp())
    };
    let patch = grid("front", n, m, dome);
    let nodes = column(m, n / 2)[..=(m / 2) as usize].to_vec();
    let plain = flatten(&alone(patch.clone()));
    let cuts = vec![PatchLine { patch: 0, nodes, name: "dart".to_owned() }];
    let pattern = flatten(&PatternInput { patches: vec![patch], cuts, ..PatternInput::default() });
    assert!(pattern.pieces[0].report.energy < plain.pieces[0].report.energy);
    assert_eq!(pattern.seams.len(), 1);
    assert!(pattern.seams[0].from_cut && pattern.seams[0].mismatch < 1e-3, "{:?}", pattern.seams[0]);
    assert_eq!(pattern.flats[0].uv.len(), 21 * 21 + 10, "ten nodes of the cut are double, its tip is not");
    assert_eq!(pattern.pieces[0].report.overlaps, 0);
}

#[test]
fn a_tube_is_cut_open_and_a_ring_is_not() {
    let sleeve = tube("sleeve", 40, 20, |u, v| {
        let (s, c) = (std::f64::consts::TAU * u).sin_cos();
        DVec3::new(60.0 * s, 400.0 * v, 60.0 * c)
    });
    let yoke = tube("yoke", 40, 8, |u, v| {
        let (s, c) = (std::f64::consts::TAU * u).sin_cos();
        let r = 150.0 - 80.0 * v;
        DVec3::new(r * c, 0.001 * r * r, -r * s)
    });
    let pattern = flatten(&PatternInput { patches: vec![sleeve, yoke], ..PatternInput::default() });
    let [sleeve, yoke] = &pattern.pieces[..] else { panic!() };
    assert_eq!((sleeve.sew.len(), yoke.sew.len()), (1, 2));
    assert!(sleeve.report.max_stretch < 1e-6, "{:?}", sleeve.report);
    assert!(yoke.report.mean_stretch < 0.02 && yoke.report.flipped == 0, "{:?}", yoke.report);
    assert_eq!(pattern.seams.len(), 1);
    assert!(pattern.seams[0].from_cut && pattern.seams[0].mismatch < 1e-3);
}

#[test]
fn a_flounce_of_more_than_a_turn_is_reported_to_lie_on_itself() {
    let patch = grid("flounce", 80, 4, |u, v| {
        let (s, c) = (8.5 * u).sin_cos();
        let r = 250.0 - 150.0 * v;
        DVec3::new(r * c, 3.0 * u, -r * s)
    });
    let pattern = flatten(&alone(patch));
    assert!(pattern.pieces[0].report.overlaps > 0 && pattern.pieces[0].report.flipped == 0);
    assert!(pattern.warnings.iter().any(|w| w.contains("lies on itself")), "{:?}", pattern.warnings);
}

#[test]
fn an_earlier_run_is_a_good_start() {
    let mut input = alone(saddle(40));
    let first = flatten(&input);
    for p in &mut input.patches[0].positions {
        p.z *= 1.03;
    }
    let cold = flatten(&input);
    input.start = first.flats;
    let warm = flatten(&input);
    let (a, b) = (&cold.pieces[0].report, &warm.pieces[0].report);
    assert!(b.steps < a.steps + 1 && (a.energy - b.energy).abs() < 1e-6, "{a:?} {b:?}");
    // A start that does not fit is passed over.
    input.start[0].faces.pop();
    assert_eq!(flatten(&input).pieces[0].report, *a);
}

#[test]
fn threads_do_not_change_a_bit() {
    let (n, m) = (12, 20);
    let patches = vec![barrel("a", 0.0, 0.9, n, m), barrel("b", 0.9, 1.4, n, m), cap(20), saddle(20)];
    let sides = vec![SeamSide { patch: 0, nodes: column(m, n) }, SeamSide { patch: 1, nodes: column(m, 0) }];
    let seams = vec![SeamInput { name: "ab".to_owned(), sides }];
    let input = PatternInput { patches, seams, ..PatternInput::default() };
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| to_json(&flatten(&input), &JsonOptions::default()))
    };
    assert_eq!(run(1), run(2));
}

#[test]
fn groups_of_a_mesh_become_pieces_with_seams() {
    let (n, m) = (16, 10);
    let whole = barrel("all", 0.0, 1.6, n, m);
    let half = whole.faces.len() as u32 / 2;
    let mut mesh = mesh_kernel::TriMesh::new(whole.positions, whole.faces);
    let group = |name: &str, faces| mesh_kernel::Group { name: name.to_owned(), faces };
    mesh.groups = vec![group("left", 0..half), group("right", half..2 * half)];
    let pattern = flatten_mesh(&mesh, &FlattenMeshOptions::default()).unwrap();
    assert_eq!(pattern.pieces.iter().map(|p| p.name.as_str()).collect::<Vec<_>>(), ["left", "right"]);
    assert_eq!(pattern.seams.len(), 1);
    assert_eq!(pattern.seams[0].patches, [0, 1]);
    assert!(pattern.seams[0].mismatch < 1e-3, "{:?}", pattern.seams[0]);
    let uvs: usize = pattern.flats.iter().map(|f| f.corner_uvs().len()).sum();
    assert_eq!(uvs, mesh.faces.len());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    /// Whatever the triangles look like: no flip, finite numbers, no energy below an isometry's.
    #[test]
    fn random_patches_never_flip(
        (n, m) in (2u32..14, 2u32..14),
        jitter in prop::collection::vec(-0.45f64..0.45, 15 * 15 * 2),
        heights in prop::collection::vec(-1.0f64..1.0, 6),
        stretch in 0.05f64..1.0,
    ) {
        let mut patch = grid("random", n, m, |u, v| DVec3::new(u, v, 0.0));
        for (k, p) in patch.positions.iter_mut().enumerate() {
            let q = DVec3::new(
                p.x + jitter[2 * k] / f64::from(n) * 0.7,
                p.y + jitter[2 * k + 1] / f64::from(m) * 0.7,
                0.0,
            );
            let z = heights[0] * (5.0 * q.x).sin() + heights[1] * (4.0 * q.y).cos()
                + heights[2] * (9.0 * q.x + 3.0 * q.y).sin() + heights[3] * q.x * q.y
                + heights[4] * (8.0 * q.y).sin() * q.x + heights[5] * q.x * q.x;
            *p = DVec3::new(300.0 * q.x, 300.0 * stretch * q.y, 40.0 * z);
        }
        let pattern = flatten(&alone(patch));
        let report = &pattern.pieces[0].report;
        prop_assert_eq!(report.flipped, 0);
        prop_assert!(report.energy >= 4.0 - 1e-12 && report.energy.is_finite());
        prop_assert!(pattern.flats[0].uv.iter().all(|p| p.is_finite()));
    }
}
