//! Bad input gives a typed error that says what and where.

use crate::surfaces::{column, grid, tube};
use glam::DVec3;
use pattern::*;

fn flat() -> Patch {
    grid("front", 4, 4, |u, v| DVec3::new(100.0 * u, 100.0 * v, 0.0))
}

fn error(patch: Patch) -> PatternError {
    make(&PatternInput { patches: vec![patch], ..PatternInput::default() }, &PatternOptions::default())
        .unwrap_err()
}

#[test]
fn nothing_at_all() {
    let none = make(&PatternInput::default(), &PatternOptions::default());
    assert_eq!(none.unwrap_err(), PatternError::Empty);
    assert!(matches!(error(Patch { faces: vec![], ..flat() }), PatternError::EmptyPatch { .. }));
    let mesh = mesh_kernel::TriMesh::default();
    assert_eq!(flatten_mesh(&mesh, &FlattenMeshOptions::default()).unwrap_err(), PatternError::Empty);
}

#[test]
fn numbers_that_are_none() {
    let mut patch = flat();
    patch.positions[7].y = f64::NAN;
    assert_eq!(error(patch), PatternError::NotFinite { patch: "front".to_owned(), node: 7 });
    let mut patch = flat();
    patch.faces[3] = [0, 1, 99];
    assert!(matches!(error(patch), PatternError::NodeOutOfRange { node: 99, nodes: 25, .. }));
    let mesh = mesh_kernel::TriMesh::new(vec![DVec3::ZERO; 3], vec![[0, 1, 7]]);
    let refused = flatten_mesh(&mesh, &FlattenMeshOptions::default()).unwrap_err();
    assert!(matches!(refused, PatternError::NodeOutOfRange { node: 7, .. }));
}

#[test]
fn faces_without_area() {
    let mut patch = flat();
    patch.positions[6] = patch.positions[5];
    assert!(matches!(error(patch), PatternError::DegenerateFace { .. }));
    let mut patch = flat();
    patch.faces[0] = [3, 3, 4];
    assert!(matches!(error(patch), PatternError::DegenerateFace { face: 0, .. }));
}

#[test]
fn shapes_that_are_no_patch() {
    let mut fin = flat();
    fin.positions.push(DVec3::new(50.0, 50.0, 80.0));
    fin.faces.push([12, 13, 25]);
    assert!(matches!(error(fin), PatternError::NonManifoldEdge { faces: 3, .. }));

    let mut turned = flat();
    turned.faces[0].swap(0, 1);
    assert!(matches!(error(turned), PatternError::NonManifoldEdge { .. }));

    let mut bow_tie = flat();
    bow_tie.positions = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]
        .map(|(x, y)| DVec3::new(x, y, 0.0))
        .to_vec();
    bow_tie.faces = vec![[0, 1, 2], [0, 3, 4]];
    assert_eq!(error(bow_tie), PatternError::PinchedNode { patch: "front".to_owned(), node: 0 });

    let mut apart = flat();
    apart.faces.remove(0);
    let shift = apart.positions.len() as u32;
    let second = flat();
    apart.positions.extend(second.positions.iter().map(|p| *p + DVec3::X * 500.0));
    apart.faces.extend(second.faces.iter().map(|f| f.map(|v| v + shift)));
    assert!(matches!(error(apart), PatternError::Disconnected { parts: 2, .. }));
}

#[test]
fn closed_surfaces_and_handles() {
    let ball = Patch {
        name: "ball".to_owned(),
        positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
        faces: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
        ..Patch::default()
    };
    assert_eq!(error(ball.clone()), PatternError::Closed { patch: "ball".to_owned() });
    let cuts = vec![PatchLine { patch: 0, nodes: vec![1, 0, 2], name: "cut".to_owned() }];
    let opened = PatternInput { patches: vec![ball], cuts, ..PatternInput::default() };
    let pattern = make(&opened, &PatternOptions::default()).unwrap();
    assert_eq!(pattern.pieces[0].report.flipped, 0);

    let mut torus = tube("torus", 20, 12, |u, v| {
        let ((s, c), (p, q)) = ((std::f64::consts::TAU * u).sin_cos(), (std::f64::consts::TAU * v).sin_cos());
        DVec3::new((100.0 + 30.0 * q) * c, 30.0 * p, (100.0 + 30.0 * q) * s)
    });
    for face in &mut torus.faces {
        *face = face.map(|v| if v % 13 == 12 { v - 12 } else { v });
    }
    assert!(matches!(error(torus.clone()), PatternError::Closed { .. }));
    torus.faces.remove(0);
    assert_eq!(error(torus), PatternError::Handles { patch: "torus".to_owned(), handles: 1 });
}

#[test]
fn seams_and_lines_that_do_not_fit() {
    let two = |sides: Vec<SeamSide>| {
        let seams = vec![SeamInput { name: "side".to_owned(), sides }];
        let input = PatternInput { patches: vec![flat(), flat()], seams, ..PatternInput::default() };
        make(&input, &PatternOptions::default()).unwrap_err()
    };
    let side = |patch: usize, nodes: Vec<u32>| SeamSide { patch, nodes };
    assert!(matches!(two(vec![side(0, column(4, 4))]), PatternError::ShortSeam { .. }));
    let unequal = two(vec![side(0, column(4, 4)), side(1, vec![0, 1])]);
    assert!(matches!(unequal, PatternError::UnequalSides { first: 5, other: 2, .. }));
    let unknown = two(vec![side(0, column(4, 4)), side(2, column(4, 0))]);
    assert!(matches!(unknown, PatternError::NoSuchPatch { patch: 2, .. }));
    let jump = two(vec![side(0, vec![0, 1]), side(1, vec![0, 24])]);
    assert!(matches!(jump, PatternError::NotAnEdge { a: 0, b: 24, .. }));
    let through = PatternInput {
        cuts: vec![PatchLine { patch: 0, nodes: column(4, 2), name: "cut".to_owned() }],
        patches: vec![flat()],
        ..PatternInput::default()
    };
    let refused = make(&through, &PatternOptions::default()).unwrap_err();
    assert!(matches!(refused, PatternError::CutsThrough { parts: 2, .. }));
}

#[test]
fn a_cut_that_jumps_is_told_in_the_file_s_numbers() {
    let patch = flat();
    let mesh = mesh_kernel::TriMesh::new(patch.positions, patch.faces);
    let options = FlattenMeshOptions { cuts: vec![vec![0, 1, 24]], ..FlattenMeshOptions::default() };
    let refused = flatten_mesh(&mesh, &options).unwrap_err();
    assert_eq!(refused, PatternError::CutNotAlongEdges { a: 1, b: 24 });
    assert!(refused.to_string().contains("nodes 2 and 25"), "{refused}");
}

#[test]
fn a_patch_too_large_to_be_drawn() {
    let mut patch = flat();
    patch.positions.iter_mut().for_each(|p| *p *= 1e200);
    assert!(
        make(&PatternInput { patches: vec![patch], ..PatternInput::default() }, &PatternOptions::default())
            .is_err()
    );
}

#[test]
fn options_out_of_range() {
    let input = PatternInput { patches: vec![flat()], ..PatternInput::default() };
    for options in [
        PatternOptions { mitre_limit: 0.5, ..PatternOptions::default() },
        PatternOptions { fabric_width_mm: f64::NAN, ..PatternOptions::default() },
        PatternOptions { line_tolerance_mm: -1.0, ..PatternOptions::default() },
    ] {
        assert!(matches!(make(&input, &options).unwrap_err(), PatternError::BadOption { .. }));
    }
    for (allowance_mm, named) in [(-3.0, "-3"), (1e9, "1000000000"), (f64::NAN, "NaN")] {
        let mut patch = flat();
        patch.piece.allowance_mm = allowance_mm;
        let text = error(patch).to_string();
        assert!(text.contains("front") && text.contains(named), "{text}");
    }
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig { cases: 300, ..Default::default() })]

    /// Any soup of triangles: pieces with finite numbers, or a typed error; never a panic.
    #[test]
    fn random_soups_are_flattened_or_refused(
        points in proptest::collection::vec([-50.0f64..50.0, -50.0f64..50.0, -50.0f64..50.0], 3..10),
        faces in proptest::collection::vec([0u32..10, 0u32..10, 0u32..10], 1..14),
        cut in proptest::collection::vec(0u32..10, 0..4),
        split in 0u32..14,
    ) {
        let positions = points.into_iter().map(DVec3::from_array).collect();
        let mut mesh = mesh_kernel::TriMesh::new(positions, faces);
        let end = mesh.faces.len() as u32;
        if split < end {
            let group = |name: &str, faces| mesh_kernel::Group { name: name.to_owned(), faces };
            mesh.groups = vec![group("a", 0..split), group("b", split..end)];
        }
        let options = FlattenMeshOptions { cuts: vec![cut], allowance_mm: 5.0, ..FlattenMeshOptions::default() };
        if let Ok(pattern) = flatten_mesh(&mesh, &options) {
            for (piece, flat) in pattern.pieces.iter().zip(&pattern.flats) {
                proptest::prop_assert_eq!(piece.report.flipped, 0);
                proptest::prop_assert!(flat.uv.iter().all(|p| p.is_finite()));
            }
            for (_, dialect) in Dialect::NAMES {
                to_dxf(&pattern, &DxfOptions { dialect, ..DxfOptions::default() });
            }
            for (_, paper) in Paper::NAMES {
                to_pdf(&pattern, &PdfOptions { paper, ..PdfOptions::default() });
            }
            to_svg(&pattern, &SvgOptions::default());
        }
    }
}
