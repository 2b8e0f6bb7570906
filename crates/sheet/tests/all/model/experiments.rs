//! The experiments of Stroud & Nagy's chapter on non-manifold models (6.2.4, 6.3.4, 6.4, 6.5.3), as commands, with the answers that
//! the program gives.

use crate::model::support::*;
use mesh_kernel::complex::EdgeId;
use mesh_kernel::glam::{DVec2, DVec3};
use sheet::model::{ExtrusionCase, Limits, LinkSide, Model, ModelError, Reading, joint_links, touching};

// 6.3.4.1: extruding wires.

#[test]
fn open_shapes_are_extruded_straight_and_along_an_arc() {
    let shape = r#"{"path": [{"line": [[0, 0], [20, 0]]}, {"arc": {"center": [20, 10], "radius": 10, "from": -90, "to": 0}}]}"#;
    let straight =
        made(&[&format!(r#"{{"do": "extrude", "name": "s", "outline": {shape}, "by": [0, 0, 30]}}"#)]);
    near(area(&straight.to_mesh()), 30.0 * (20.0 + 5.0 * std::f64::consts::PI), 0.02);
    assert_eq!(straight.to_mesh().groups.len(), 1, "a line and the arc that goes on from it are one curve");
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
    for same in [true, false] {
        for keep in [true, false] {
            let mut model = Model::default();
            model.apply(&command(left)).unwrap();
            // A sheet of its own, with its corners where the first one's are.
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
    assert_eq!(model.complex().counts().cc, 1);
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
