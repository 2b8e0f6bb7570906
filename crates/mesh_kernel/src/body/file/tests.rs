//! What only the crate itself can make: free numbers in any order, and damage of every kind.

use glam::{DVec2, DVec3};
use serde_json::{Value, json};

use super::BodyFileError;
use crate::body::{
    AttributeEdge, AttributeNode, Body, Chain, ChainSpec, EdgeId, FaceId, Joint, JointSpec, NONE, NodeId,
    SurfaceId, SurfaceSpec,
};

/// Three flaps on one joint, a wire, a node that stands alone, attributes, backup and flat positions, free numbers of every
/// kind.
fn sample() -> Body {
    let flap = |name: &str, out: DVec3| SurfaceSpec {
        name: name.into(),
        positions: vec![DVec3::ZERO, DVec3::Z, DVec3::Z + out, out],
        faces: vec![[0, 1, 2], [0, 2, 3]],
    };
    let flaps = [flap("a", DVec3::X), flap("b \"quoted\"\n", DVec3::Y), flap("c", DVec3::NEG_X)];
    let chains = (0..3).map(|surface| ChainSpec { surface, nodes: vec![0, 1], closed: false }).collect();
    let mut body = Body::build(&flaps, &[JointSpec { name: Some("rib".into()), chains }]).unwrap();
    let id = SurfaceId(0);
    let [p, q, _] = [1.0, 2.0, 3.0].map(|x| body.add_node(id, DVec3::splat(0.1 * x)).unwrap());
    body.add_edge(id, p, q).unwrap();
    let s = body.surface_mut(id);
    let a = s.add_attribute_node(AttributeNode::OnEdge { edge: EdgeId(0), u: 0.2 }).unwrap();
    let b = s.add_attribute_node(AttributeNode::InFace { face: FaceId(0), areal: [0.1, 0.3, 0.6] }).unwrap();
    s.add_attribute_edge(AttributeEdge { name: Some("dart".into()), nodes: vec![a, b] }).unwrap();
    s.store_backup();
    s.positions[4] = DVec3::new(-0.0, 5e-324, f64::MAX);
    let planar = (0..s.positions.len()).map(|v| DVec2::new(1.0 / (v as f64 + 3.0), -1e-300)).collect();
    assert!(s.set_planar(planar));
    let n = s.positions.len() as u32;
    for k in 0..3 {
        s.positions.push(DVec3::splat(f64::from(k)));
        s.backup.push(DVec3::ZERO);
        s.planar.push(DVec2::ONE);
    }
    [n + 1, n, n + 2].into_iter().for_each(|v| s.slots.nodes.release(v));
    let e = s.edges.len() as u32;
    for k in [1, 0] {
        s.edges.push([NONE; 2]);
        s.edge_faces.push([NONE; 2]);
        s.edge_chain.push(0);
        s.slots.edges.release(e + 1 - k);
    }
    s.slots.faces.release(s.faces.len() as u32);
    s.faces.push([NONE; 3]);
    s.face_edges.push([NONE; 3]);
    s.slots.chains.release(s.chains.len() as u32);
    s.chains.push(Chain::FREE);
    body.joint_slots.release(body.joints.len() as u32);
    body.joints.push(Joint { name: None, uses: Vec::new(), radial: Vec::new() });
    assert_eq!(body.check_topology(), []);
    body
}

fn value(body: &Body) -> Value {
    serde_json::from_slice(&body.to_file_bytes().unwrap()).unwrap()
}

fn refusal(value: &Value) -> BodyFileError {
    Body::from_file_bytes(value.to_string().as_bytes()).unwrap_err()
}

#[test]
fn everything_comes_back_bit_for_bit() {
    for body in [sample(), Body::default()] {
        let bytes = body.to_file_bytes().unwrap();
        let back = Body::from_file_bytes(&bytes).unwrap();
        assert_eq!(back, body);
        // Equal floats may differ in the sign of zero; equal bytes do not.
        assert_eq!(back.to_file_bytes().unwrap(), bytes);
        if let Some(p) = back.surfaces.first().map(|s| s.positions[4]) {
            let bits = [-0.0, 5e-324, f64::MAX].map(f64::to_bits);
            assert_eq!(p.to_array().map(f64::to_bits), bits);
        }
    }
}

#[test]
fn the_number_freed_last_is_still_given_next() {
    let back = Body::from_file_bytes(&sample().to_file_bytes().unwrap()).unwrap();
    assert_eq!(back.surfaces[0].slots, sample().surfaces[0].slots);
    assert_eq!(back.surfaces[0].slots.nodes.free(), [8, 7, 9]);
}

#[test]
fn other_files_are_refused_in_words() {
    let good = value(&sample());
    for (key, with, words) in [
        ("format", json!("toile-journal"), "its \"format\" is \"toile-journal\""),
        ("format", json!(null), "its \"format\" is missing"),
        ("version", json!(2), "format version 2; this program reads version 1"),
        ("version", json!(null), "format version none"),
        ("version", json!("1"), "invalid type: string"),
        ("surfaces", json!(7), "invalid type: integer"),
        ("colour", json!("red"), "unknown field `colour`"),
    ] {
        let mut bad = good.clone();
        bad[key] = with;
        let error = refusal(&bad).to_string();
        assert!(error.contains(words), "{error}");
    }
    for bytes in [&b"\xff\xfe"[..], b"ply\n", b"[]", b"{}", b"null"] {
        let error = Body::from_file_bytes(bytes).unwrap_err();
        assert!(matches!(error, BodyFileError::Malformed { .. } | BodyFileError::Format { .. }), "{error}");
    }
}

#[test]
fn a_file_cut_off_anywhere_is_refused() {
    let bytes = sample().to_file_bytes().unwrap();
    for end in 0..bytes.len() - 2 {
        let error = Body::from_file_bytes(&bytes[..end]).unwrap_err();
        assert!(matches!(error, BodyFileError::Truncated { .. }), "{end}: {error}");
    }
}

#[test]
fn numbers_that_name_nothing_are_refused_with_who_names_them() {
    let good = value(&sample());
    type Change = fn(&mut Value);
    let changes: [(Change, &str); 18] = [
        (|v| v["surfaces"][0]["edges"][1] = json!([0, 99]), "surface 0: edge 1 names node 99"),
        (|v| v["surfaces"][0]["edges"][1] = json!([4294967295u32, 0]), "surface 0: edge 1 names node"),
        (|v| v["surfaces"][0]["edges"][1] = json!([0, 8]), "surface 0: edge 1 names node 8, which is free"),
        (|v| v["surfaces"][0]["faces"][1] = json!([0, 1, 99]), "surface 0: face 1 names edge 99"),
        (|v| v["surfaces"][0]["faces"][1] = json!([0, 1, -100]), "surface 0: face 1 names edge 99"),
        (|v| v["surfaces"][0]["faces"][1] = json!([0, 1, i64::MIN]), "surface 0: face 1 names edge"),
        (|v| v["surfaces"][0]["faces"][1] = json!([0, 1, 7]), "surface 0: face 1 names edge 7"),
        (|v| v["surfaces"][0]["chains"][0]["start"] = json!(4294967295u32), "surface 0: chain 0 names node"),
        (|v| v["surfaces"][0]["chains"][0]["edges"] = json!([99]), "surface 0: chain 0 names edge 99"),
        (|v| v["surfaces"][0]["loops"][0] = json!([99]), "surface 0: loop 0 names chain 99"),
        (|v| v["surfaces"][0]["attribute_nodes"][0]["on_edge"]["edge"] = json!(99), "names edge 99"),
        (|v| v["surfaces"][0]["attribute_nodes"][1]["in_face"]["face"] = json!(99), "names face 99"),
        (|v| v["surfaces"][0]["attribute_edges"][0]["nodes"] = json!([0, 99]), "names attribute node 99"),
        (|v| v["surfaces"][0]["free"]["nodes"] = json!([4294967295u32]), "free nodes names node 4294967295"),
        (|v| v["joints"][0]["uses"][0]["surface"] = json!(99), "joint 0 names surface 99"),
        (|v| v["joints"][0]["uses"][0]["chain"] = json!(99), "joint 0 names chain 99"),
        (|v| v["joints"][0]["radial"][0][0] = json!(99), "joint 0 names use 99"),
        (|v| v["free_joints"] = json!([9]), "free joints names joint 9"),
    ];
    for (change, words) in changes {
        let mut bad = good.clone();
        change(&mut bad);
        let error = refusal(&bad);
        assert!(matches!(error, BodyFileError::UnknownId { .. }), "{words}: {error}");
        assert!(error.to_string().contains(words), "{words}: {error}");
    }
}

#[test]
fn contradictions_are_refused_with_the_first_of_them() {
    let good = value(&sample());
    type Change = fn(&mut Value);
    let changes: [(Change, &str); 12] = [
        (|v| v["surfaces"][0]["faces"][1] = v["surfaces"][0]["faces"][0].clone(), "face_not_on_edge"),
        (|v| v["surfaces"][0]["faces"][0] = json!([0, 0, 0]), "repeated_corner"),
        (|v| v["surfaces"][0]["edges"][0] = json!([1, 1]), "edge_of_one_node"),
        (|v| v["surfaces"][0]["free"]["edges"] = json!([6]), "free_number"),
        (|v| v["surfaces"][0]["free"]["nodes"] = json!([8, 7, 9, 7]), "free_number"),
        (|v| v["surfaces"][0]["loops"] = json!([]), "chain_place"),
        (|v| v["surfaces"][1]["chains"][0]["edges"] = json!([]), "boundary_not_in_loop"),
        (|v| v["joints"][0]["uses"][2] = v["joints"][0]["uses"][1].clone(), "chain_joint"),
        (|v| v["joints"][0]["uses"] = json!([]), "too_few_uses"),
        (|v| v["joints"][0]["radial"] = json!([]), "radial_sheets"),
        (|v| v["surfaces"][0]["attribute_nodes"][0]["on_edge"]["u"] = json!(1.5), "attribute_range"),
        (|v| v["free_joints"] = json!([]), "free_number"),
    ];
    for (change, code) in changes {
        let mut bad = good.clone();
        change(&mut bad);
        let error = refusal(&bad);
        let BodyFileError::Unsound { count, first } = &error else { panic!("{code}: {error}") };
        assert!(*count >= first.len() && first.len() <= 3);
        assert!(first.iter().any(|d| d.code() == code), "{code}: {error}");
    }
    let mut bad = good;
    bad["surfaces"][0]["planar"] = json!([[0.0, 1.0]]);
    assert!(matches!(
        refusal(&bad),
        BodyFileError::Length { array: "planar positions", len: 1, nodes: 10, .. }
    ));
}

#[test]
fn what_could_not_be_read_is_not_written() {
    let mut body = sample();
    body.surfaces[0].backup[3].y = f64::NAN;
    let error = body.to_file_bytes().unwrap_err();
    assert!(matches!(error, BodyFileError::NotFinite { node: NodeId(3), layer: "backup", .. }), "{error}");
    let mut body = sample();
    body.surfaces[0].faces[0].swap(0, 1);
    assert!(matches!(body.to_file_bytes().unwrap_err(), BodyFileError::Unsound { .. }));
}
