//! Modelling functions and the experiments of Stroud & Nagy's chapter on non-manifold models, as commands.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use mesh_kernel::TriMesh;
use mesh_kernel::body::Counts;
use mesh_kernel::complex::{CheckOptions, EdgeId};
use mesh_kernel::glam::{DVec2, DVec3};
use sheet::model::{
    Command, Done, ExtrusionCase, Limits, LinkSide, Model, ModelError, Reading, Script, ScriptError,
    joint_links, touching,
};

fn command(text: &str) -> Command {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

/// Applies commands; after each the model is sound, and undone and done again it is the same, bit for bit.
#[track_caller]
fn made(commands: &[&str]) -> Model {
    let mut model = Model::new(Limits { tolerance: 0.5, ..Limits::default() });
    for text in commands {
        done(&mut model, text);
    }
    model
}

#[track_caller]
fn done(model: &mut Model, text: &str) -> Done {
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
fn refused(model: &mut Model, text: &str) -> ModelError {
    let before = model.clone();
    let error = model.apply(&command(text)).expect_err(text);
    assert!(*model == before, "a refused command changes nothing: {text}");
    error
}

#[track_caller]
fn counts(model: &Model) -> [i64; 7] {
    let Counts { v, e, f, r, c, ch, cc } = model.complex().counts();
    [v, e, f, r, c, ch, cc]
}

fn area(mesh: &TriMesh) -> f64 {
    (0..mesh.faces.len() as u32).map(|f| mesh.area_normal(f).length() / 2.0).sum()
}

fn volume(mesh: &TriMesh) -> f64 {
    let six = |f: u32| {
        let [a, b, c] = mesh.corners(f);
        a.cross(b).dot(c)
    };
    (0..mesh.faces.len() as u32).map(six).sum::<f64>() / 6.0
}

#[track_caller]
fn near(value: f64, wanted: f64, relative: f64) {
    assert!((value - wanted).abs() <= relative * wanted.abs(), "{value} is not {wanted}");
}

// 6.3.4.1: extruding wires.

#[test]
fn open_shapes_are_extruded_straight_and_along_an_arc() {
    let shape = r#"{"path": [{"line": [[0, 0], [20, 0]]}, {"arc": {"center": [20, 10], "radius": 10, "from": -90, "to": 0}}]}"#;
    let straight =
        made(&[&format!(r#"{{"do": "extrude", "name": "s", "outline": {shape}, "by": [0, 0, 30]}}"#)]);
    near(area(&straight.to_mesh()), 30.0 * (20.0 + 5.0 * std::f64::consts::PI), 0.02);
    assert_eq!(straight.to_mesh().groups.len(), 1, "an arc and its tangent are... strips of one curve");
    let along = made(&[&format!(
        r#"{{"do": "extrude", "name": "s", "outline": {shape}, "plane": "xy",
        "path": {{"arc": {{"center": [0, 0], "radius": 60, "from": 0, "to": 90}}}}, "path_plane": {{"origin": [60, 0, 0], "x": [-1, 0, 0], "y": [0, 0, 1]}}}}"#
    )]);
    assert!(along.complex().face_count() > 20);
    assert_eq!(along.complex().counts().c, 1);
}

#[test]
fn the_three_cases_of_fig_6_18_are_told_apart() {
    // Left: an edge along the direction ends the wire.
    let wire = |lines: &str| format!(r#"{{"do": "wire", "name": "w", "lines": [{lines}]}}"#);
    let extrude = r#"{"do": "extrude", "name": "s", "wire": "w", "by": [0, 0, 30]}"#;
    let mut model = made(&[&wire("[[0, 0, 0], [40, 0, 0], [40, 0, 20]]")]);
    let error = refused(&mut model, extrude);
    assert_eq!(
        error,
        ModelError::Dangling { from: DVec3::new(40.0, 0.0, 0.0), to: DVec3::new(40.0, 0.0, 20.0) }
    );
    // Middle: shorter than the distance, between two edges across: valid, with an inner edge.
    let mut model = made(&[&wire("[[0, 0, 0], [40, 0, 0], [40, 0, 20], [80, 0, 20]]")]);
    let answer = done(&mut model, extrude);
    let inner = [[DVec3::new(40.0, 0.0, 20.0), DVec3::new(40.0, 0.0, 30.0)]];
    assert_eq!(answer.extrusion, Some(ExtrusionCase::InnerEdges(inner.to_vec())));
    assert_eq!(counts(&model), [8, 9, 2, 0, 1, 0, 0]);
    // Right: longer than the distance: a wire edge between two sheets, or two sheets; the caller says which.
    let long = wire("[[0, 0, 0], [40, 0, 0], [40, 0, 50], [80, 0, 50]]");
    let mut model = made(&[&long]);
    let error = refused(&mut model, extrude);
    assert!(matches!(error, ModelError::AmbiguousAlong { length: 50.0, distance: 30.0, .. }), "{error}");
    let with = |choice: &str| extrude.replace("\"by\"", &format!("\"edges_along\": \"{choice}\", \"by\""));
    done(&mut model, &with("keep"));
    assert_eq!(counts(&model), [8, 9, 2, 0, 1, 0, 0]);
    assert_eq!(model.complex().edges().filter(|e| model.complex().uses(*e).is_empty()).count(), 1);
    let mut model = made(&[&long]);
    done(&mut model, &with("drop"));
    assert_eq!(counts(&model), [8, 8, 2, 0, 2, 0, 0]);
    // As long as the distance the sheets would meet in a point.
    let mut model = made(&[&wire("[[0, 0, 0], [40, 0, 0], [40, 0, 30], [80, 0, 30]]")]);
    assert!(matches!(refused(&mut model, extrude), ModelError::AmbiguousAlong { .. }));
    let mut model = made(&[&wire("[[0, 0, 0], [0, 0, 30]]")]);
    assert_eq!(refused(&mut model, extrude), ModelError::NothingAcross);
}

// 6.3.4.2: extruding branching wires.

#[test]
fn branching_wires_are_extruded_in_the_order_of_tangents_and_curvatures() {
    // Fig. 6.19: five branches, two of which leave in one direction and turn different ways.
    let branching = r#"{"do": "wire", "name": "w", "drawings": [
        {"line": [[0, 0], [40, 0]]}, {"line": [[0, 0], [-20, 35]]},
        {"arc": {"center": [-40, 0], "radius": 40, "from": 0, "to": 60}},
        {"arc": {"center": [40, 0], "radius": 40, "from": 180, "to": 120}},
        {"line": [[0, 0], [0, -40]]}]}"#;
    let model = made(&[branching, r#"{"do": "extrude", "name": "s", "wire": "w", "by": [0, 0, 30]}"#]);
    let pillar: EdgeId = model.complex().edges().max_by_key(|e| model.complex().uses(*e).len()).unwrap();
    assert_eq!(model.complex().uses(pillar).len(), 5);
    assert_eq!(model.complex().counts().c, 1);
    // Coincident edges are not understood by the method either: the drawing makes one link of them.
    let twice = r#"{"do": "wire", "name": "w", "lines": [[[0, 0, 0], [10, 0, 0]], [[0, 0, 0], [10, 0, 0]], [[0, 0, 0], [0, 9, 0]]]}"#;
    let model = made(&[twice, r#"{"do": "extrude", "name": "s", "wire": "w", "by": [0, 0, 30]}"#]);
    assert_eq!(model.complex().face_count(), 2);
    // An arc sampled so coarsely that its chord leaves on the wrong side of another branch.
    let mut coarse = Model::new(Limits { tolerance: 30.0, ..Limits::default() });
    coarse
        .apply(&command(
            r#"{"do": "wire", "name": "w", "drawings": [{"arc": {"center": [-40, 0], "radius": 40, "from": 0, "to": 120}},
            {"line": [[0, 0], [-10, 40]]}, {"line": [[0, 0], [40, -10]]}]}"#,
        ))
        .unwrap();
    let error = refused(&mut coarse, r#"{"do": "extrude", "name": "s", "wire": "w", "by": [0, 0, 30]}"#);
    assert!(matches!(error, ModelError::Branches { .. }), "{error}");
}

// 6.3.4.3: joining three sheets.

fn three_lines() -> Vec<String> {
    [("a", [-50, 0]), ("b", [30, -50]), ("c", [30, 50])]
        .iter()
        .map(|(name, [x, y])| {
            format!(r#"{{"do": "extrude", "name": "{name}", "outline": {{"line": [[{x}, {y}], [0, 0]]}}, "by": [0, 0, 60]}}"#)
        })
        .collect()
}

#[test]
fn three_sheets_are_joined_at_one_edge() {
    let commands = three_lines();
    let mut model = made(&commands.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(counts(&model), [12, 12, 3, 0, 3, 0, 0]);
    let answer = done(&mut model, r#"{"do": "join"}"#);
    assert_eq!((answer.merged_vertices, answer.merged_edges.len()), (4, 1));
    assert_eq!(counts(&model), [8, 10, 3, 0, 1, 0, 0]);
    assert_eq!(model.complex().uses(answer.merged_edges[0]).len(), 3);
    assert_eq!(refused(&mut model, r#"{"do": "join"}"#), ModelError::NothingToJoin);
}

// 6.3.4.4: joining sheets whose edges do not match.

#[test]
fn a_plate_is_joined_to_the_middle_of_a_half_cylinder() {
    for plate_height in [50, 30] {
        let plate = format!(
            r#"{{"do": "extrude", "name": "plate", "outline": {{"line": [[25, 0], [50, 0]]}}, "by": [0, 0, {plate_height}]}}"#
        );
        let mut model = made(&[
            r#"{"do": "extrude", "name": "half", "outline": {"arc": {"center": [0, 0], "radius": 25, "from": -90, "to": 90}}, "by": [0, 0, 50]}"#,
            &plate,
        ]);
        let before = area(&model.to_mesh());
        if plate_height == 30 {
            let error = refused(&mut model, r#"{"do": "join"}"#);
            assert!(matches!(error, ModelError::EdgesDoNotMatch { .. }), "{error}");
        }
        done(&mut model, r#"{"do": "join", "split": true}"#);
        near(area(&model.to_mesh()), before, 1e-12);
        assert_eq!(model.complex().counts().c, 1);
        let three = model.complex().edges().filter(|e| model.complex().uses(*e).len() == 3);
        let length: f64 = three
            .map(|e| {
                let [a, b] = model.complex().ends(e).unwrap().map(|v| model.complex().position(v).unwrap());
                a.distance(b)
            })
            .sum();
        near(length, f64::from(plate_height), 1e-12);
    }
    // A plate that ends between two columns of the cylinder's strips, and a wall that crosses another.
    let mut model = made(&[
        r#"{"do": "create", "name": "floor", "outline": {"rectangle": {"at": [0, 0], "size": [40, 40]}}}"#,
        r#"{"do": "extrude", "name": "wall", "outline": {"line": [[-10, 20], [50, 20]]}, "plane": {"origin": [0, 0, -10], "x": [1, 0, 0], "y": [0, 1, 0]}, "by": [0, 0, 30]}"#,
    ]);
    done(&mut model, r#"{"do": "join", "split": true}"#);
    assert_eq!(model.complex().edges().filter(|e| model.complex().uses(*e).len() == 4).count(), 1);
}

// 6.3.2: the links of figs. 6.15–6.16.

#[test]
fn links_are_rewired_as_in_fig_6_16() {
    use LinkSide::{Left as L, Right as R};
    let left =
        r#"{"do": "add", "name": "one", "points": [[0, 0, 0], [0, 0, 10], [-10, 0, 10], [-10, 0, 0]]}"#;
    // The second sheet is walked along the common edge in the same direction, or the opposite one.
    for (points, same) in [
        ("[0, 0, 0], [0, 0, 10], [10, 0, 10], [10, 0, 0]", true),
        ("[0, 0, 0], [10, 0, 0], [10, 0, 10], [0, 0, 10]", false),
    ] {
        for keep in [true, false] {
            let mut model = Model::default();
            model.apply(&command(left)).unwrap();
            // A sheet of its own: made elsewhere and shifted onto the first by its coordinates.
            let create = format!(r#"{{"do": "wire", "name": "w", "lines": [[{points}, [0, 0, 0]]]}}"#);
            let _ = create;
            let second = format!(
                r#"{{"do": "create", "name": "two", "outline": {{"polygon": {}}}, "plane": {}}}"#,
                "[[0, 0], [10, 0], [10, 10], [0, 10]]",
                if same {
                    r#"{"origin": [0, 0, 10], "x": [1, 0, 0], "y": [0, 0, -1]}"#
                } else {
                    r#"{"origin": [0, 0, 0], "x": [1, 0, 0], "y": [0, 0, 1]}"#
                }
            );
            model.apply(&command(&second)).unwrap();
            let one = model.faces_of("one").unwrap()[0];
            let edges_before = model.complex().edge_count();
            let join = if keep { r#"{"do": "join", "edges": "keep"}"# } else { r#"{"do": "join"}"# };
            done(&mut model, join);
            assert_eq!(model.complex().edge_count(), if keep { edges_before } else { edges_before - 1 });
            let complex = model.complex();
            let at = |e: EdgeId| complex.ends(e).unwrap().map(|v| complex.position(v).unwrap());
            let on_axis = |e: &EdgeId| at(*e).iter().all(|p| p.x == 0.0);
            let edges: Vec<EdgeId> = complex.edges().filter(on_axis).collect();
            assert_eq!(edges.len(), if keep { 2 } else { 1 });
            let sectors = joint_links(complex, &edges).unwrap();
            assert_eq!(sectors.len(), 2);
            let pairs: Vec<[(bool, LinkSide); 2]> =
                sectors.iter().map(|s| s.map(|l| (l.face == one, l.side))).collect();
            let has =
                |a: (bool, LinkSide), b: (bool, LinkSide)| pairs.contains(&[a, b]) || pairs.contains(&[b, a]);
            if same {
                assert!(has((true, L), (false, R)) && has((true, R), (false, L)), "{pairs:?}");
            } else {
                assert!(has((true, L), (false, L)) && has((true, R), (false, R)), "{pairs:?}");
            }
        }
    }
}

// 6.5.3: non-manifold solids.

fn cube(name: &str, x: f64, y: f64, z: f64) -> String {
    format!(
        r#"{{"do": "extrude", "name": "{name}", "solid": true, "outline": {{"rectangle": {{"at": [{x}, {y}], "size": [100, 100]}}}},
        "plane": {{"origin": [0, 0, {z}], "x": [1, 0, 0], "y": [0, 1, 0]}}, "by": [0, 0, 100]}}"#
    )
}

#[test]
fn touching_edges_by_extrusion_have_two_readings() {
    let model = made(&[&cube("a", 0., 0., 0.), &cube("b", 100., 0., 100.), r#"{"do": "join"}"#]);
    let mesh = model.to_mesh();
    near(volume(&mesh), 2e6, 1e-12);
    assert_eq!(counts(&model), [14, 23, 12, 0, 1, 0, 2]);
    let places = touching(&mesh).unwrap();
    let edge = places.iter().find(|p| p.sheets == 4).expect("four sheets at the common edge");
    assert_eq!(edge.at.len(), 2);
    near(edge.at[0].distance(edge.at[1]), 100.0, 1e-12);
    let (Reading::Counts(join), Reading::Counts(miss)) = (&edge.join, &edge.miss) else { panic!("{edge:?}") };
    // Joined, the material is one: one volume; missed, there are two that hang together at the edge's ends.
    println!("touching edge: join {join}, miss {miss}");
    assert!(join != miss, "{join:?} {miss:?}");
}

#[test]
fn touching_vertices_by_extrusion_have_two_readings() {
    let model = made(&[&cube("a", 0., 0., 0.), &cube("b", 100., 100., 100.), r#"{"do": "join"}"#]);
    assert_eq!(counts(&model), [15, 24, 12, 0, 1, 0, 2]);
    let places = touching(&model.to_mesh()).unwrap();
    let [place] = &places[..] else { panic!("{places:?}") };
    assert_eq!((place.at.clone(), place.sheets), (vec![DVec3::splat(100.0)], 2));
    let (Reading::Counts(join), Reading::Counts(miss)) = (&place.join, &place.miss) else {
        panic!("{place:?}")
    };
    assert_eq!((join.c, miss.c), (1, 2), "joined they hang together, missed they are two");
}

#[test]
fn touching_triangles_are_extruded_with_one_common_edge() {
    let triangle = |name: &str, points: &str| {
        format!(
            r#"{{"do": "extrude", "name": "{name}", "solid": true, "outline": {{"polygon": {points}}}, "by": [0, 0, 40]}}"#
        )
    };
    let model = made(&[
        &triangle("a", "[[-40, 20], [0, 0], [-40, -20]]"),
        &triangle("b", "[[40, 20], [40, -20], [0, 0]]"),
        r#"{"do": "join"}"#,
    ]);
    // "What happens with the common vertex, is it one edge or two?": one, with four faces, and both readings are reported.
    assert_eq!(counts(&model), [10, 17, 10, 0, 1, 0, 2]);
    let places = touching(&model.to_mesh()).unwrap();
    assert_eq!(places.iter().filter(|p| p.sheets == 4).count(), 1);
    // Drawn in one go as p1-p5-p4-p3-p1 there is no vertex in the middle: the outline crosses itself, and is refused.
    let mut model = Model::default();
    let error = refused(&mut model, &triangle("c", "[[-40, 20], [40, -20], [40, 20], [-40, -20]]"));
    assert!(error.to_string().contains("crosses"), "{error}");
}

#[test]
fn a_square_swept_to_touch_itself_joins_at_the_faces() {
    // Fig. 6.28: a path that comes back beside itself: the sweep's faces touch along a strip.
    let sweep = r#"{"do": "extrude", "name": "s", "solid": true, "outline": {"polygon": [[-12.5, -12.5], [12.5, -12.5], [12.5, 12.5], [-12.5, 12.5]]},
        "along": [[0, 0, 0], [0, 0, 100], [0, 75, 100], [0, 75, 25], [0, 25, 25]]}"#;
    let mut model = made(&[sweep]);
    near(volume(&model.to_mesh()), 625.0 * (100.0 + 75.0 + 75.0 + 50.0), 1e-12);
    assert_eq!(model.complex().counts().cc, 1);
    done(&mut model, r#"{"do": "join", "split": true}"#);
    // The end of the sweep lies on its beginning's side: one face there, with material on both sides.
    assert_eq!(model.complex().counts().cc, 1 + 0);
    assert!(model.complex().counts().identity_holds());
}

#[test]
fn a_chamfer_of_arm_times_root_two_touches_the_inner_edge() {
    let arm = 10.0f64;
    let profile = r#"{"do": "extrude", "name": "l", "solid": true,
        "outline": {"polygon": [[0, 0], [75, 0], [75, 10], [10, 10], [10, 75], [0, 75]]}, "by": [0, 0, 75]}"#;
    let chamfer = |depth: f64| {
        format!(r#"{{"do": "chamfer", "edge": [[0, 0, 0], [0, 0, 75]], "depth": {depth}, "name": "cut"}}"#)
    };
    // A little less: a solid as any other.
    let mut model = made(&[profile, &chamfer(arm * 1.2)]);
    assert!(touching(&model.to_mesh()).unwrap().is_empty());
    let leg = arm * 1.2 * 2f64.sqrt();
    near(volume(&model.to_mesh()), 75.0 * (75.0 * 10.0 + 65.0 * 10.0 - leg * leg / 2.0), 1e-12);
    assert!(matches!(refused(&mut model, &chamfer(1e3)), ModelError::NoEdge { .. }), "the edge is gone");
    // Exactly: the plane touches the inner edge, but the local operation does not tell ("the edge may touch the face, but not be
    // associated with it"); joined, it is a non-manifold edge.
    let inner = |model: &Model| {
        let complex = model.complex();
        let on = |e: &EdgeId| {
            let ends = complex.ends(*e).unwrap().map(|v| complex.position(v).unwrap());
            ends.iter().all(|p| (p.truncate() - DVec2::splat(10.0)).length() < 1e-9)
        };
        complex.edges().find(on).map(|e| complex.uses(e).len())
    };
    let mut model = made(&[profile, &chamfer(arm * 2f64.sqrt())]);
    assert_eq!(inner(&model), Some(2));
    done(&mut model, r#"{"do": "join", "split": true}"#);
    assert_eq!(inner(&model), Some(4));
    let places = touching(&model.to_mesh()).unwrap();
    let edges: Vec<_> = places.iter().filter(|p| p.at.len() == 2 && p.sheets == 4).collect();
    assert_eq!(edges.len(), 1, "{places:?}");
    near(edges[0].at[0].distance(edges[0].at[1]), 75.0, 1e-9);
    assert!(matches!((&edges[0].join, &edges[0].miss), (Reading::Counts(_), Reading::Counts(_))));
}

// 6.2.4.1: pipework.

#[test]
fn a_circle_is_extruded_along_a_path_to_a_pipe() {
    let model =
        made(&[r#"{"do": "extrude", "name": "pipe", "outline": {"circle": {"center": [0, 0], "radius": 5}},
        "along": [[0, 0, 0], [0, 0, 100], [0, 80, 100]]}"#]);
    assert_eq!(model.complex().counts().c, 1);
    assert_eq!(model.complex().counts().ch, 1, "open at both ends");
    let mut model = Model::default();
    let sharp = r#"{"do": "extrude", "name": "pipe", "outline": {"circle": {"center": [0, 0], "radius": 5}},
        "along": [[0, 0, 0], [0, 0, 6], [0, 0.5, 0]]}"#;
    assert!(matches!(refused(&mut model, sharp), ModelError::TurnsTooSharply { .. }));
}

// 6.4: partial models.

#[test]
fn a_cylinder_is_added_to_a_partial_model_and_refused_for_a_sheet() {
    let square = r#"{"do": "create", "name": "square", "outline": {"rectangle": {"at": [-50, -50], "size": [100, 100]}}}"#;
    let cylinder = |r: f64, low: f64| {
        format!(
            r#"{{"do": "extrude", "name": "boss", "solid": true, "outline": {{"rectangle": {{"at": [{0}, {0}], "size": [{1}, {1}]}}}},
            "plane": {{"origin": [0, 0, {low}], "x": [1, 0, 0], "y": [0, 1, 0]}}, "by": [0, 0, 40]}}"#,
            -r,
            2.0 * r
        )
    };
    let add = r#"{"do": "add_solid", "solid": "boss", "to": "square"}"#;
    // Fig. 6.23b: part sheet, part solid.
    let mut model = made(&[square, &cylinder(20.0, -20.0)]);
    assert_eq!(refused(&mut model, add), ModelError::Mixed { patch: "square".into() });
    // Fig. 6.23c: only the top is outside the material.
    done(&mut model, r#"{"do": "partial", "patch": "square"}"#);
    done(&mut model, add);
    assert_eq!(model.partial_patches(), ["square", "boss"]);
    near(area(&model.to_mesh()), 1e4 + 4.0 * 40.0 * 20.0, 1e-12);
    assert_eq!(counts(&model), [12, 16, 6, 1, 1, 0, 0]);
    // Beyond the border the material is not defined.
    let mut model = made(&[square, &cylinder(60.0, -20.0), r#"{"do": "partial", "patch": "square"}"#]);
    assert_eq!(refused(&mut model, add), ModelError::BeyondPartial);
    let mut model = made(&[&cube("box", 0., 0., 0.)]);
    assert!(matches!(
        refused(&mut model, r#"{"do": "partial", "patch": "box"}"#),
        ModelError::NotPartial { .. }
    ));
}

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
