//! Face triangulation: attribute nodes and lines become real nodes and edges.

use crate::body::support::{Random, add_attributes, add_wires, random_body};
use mesh_kernel::body::edit::{Editor, TriangulateError};
use mesh_kernel::body::{
    AttributeEdge, AttributeNode, AttributeNodeId, Body, ChainSpec, EdgeId, FaceId, JointSpec, NodeId,
    SurfaceId, SurfaceSpec,
};
use mesh_kernel::glam::DVec3;
use proptest::prelude::*;

const S: SurfaceId = SurfaceId(0);

/// Three flaps of one triangle each at a rib along z.
fn flaps() -> Body {
    let flap = |apex: DVec3| SurfaceSpec {
        name: "flap".into(),
        positions: vec![DVec3::ZERO, DVec3::Z * 40.0, apex],
        faces: vec![[0, 1, 2]],
    };
    let flaps = [DVec3::X, DVec3::NEG_X, DVec3::Y].map(|d| flap(d * 30.0));
    let chains = (0..3).map(|surface| ChainSpec { surface, nodes: vec![0, 1], closed: false }).collect();
    Body::build(&flaps, &[JointSpec { name: None, chains }]).unwrap()
}

#[test]
fn nodes_and_lines_become_real_and_partners_are_cut() {
    let mut body = flaps();
    let s = body.surface_mut(S);
    let on = s.add_attribute_node(AttributeNode::OnEdge { edge: EdgeId(0), u: 0.25 }).unwrap();
    let inside =
        s.add_attribute_node(AttributeNode::InFace { face: FaceId(0), areal: [0.3, 0.3, 0.4] }).unwrap();
    let other = s.add_attribute_node(AttributeNode::OnEdge { edge: EdgeId(1), u: 0.5 }).unwrap();
    s.add_attribute_edge(AttributeEdge { name: Some("dart".into()), nodes: vec![on, inside, other] })
        .unwrap();
    let before = body.clone();
    let places: Vec<DVec3> = [on, inside, other].map(|n| before.surface(S).attribute_position(n)).to_vec();
    let mut editor = Editor::new(body);
    let done = editor.triangulate_face(S, FaceId(0)).unwrap();
    let body = editor.body();
    assert_eq!(body.check(), []);
    // One inner node, two on sides: 1 + 2 · 1 + 2 faces; the partners are cut in two.
    assert_eq!((done.faces.len(), done.nodes.len(), done.crossings.len()), (5, 3, 0));
    assert_eq!(body.face_count(), 9);
    let s = body.surface(S);
    for ((n, v), place) in done.nodes.iter().zip(&places) {
        assert_eq!(s.positions()[v.index()], *place);
        assert_eq!(s.attribute_position(*n), *place);
    }
    assert!(s.find_edge(done.nodes[0].1, done.nodes[1].1).is_some());
    assert!(s.find_edge(done.nodes[1].1, done.nodes[2].1).is_some());
    let counts = (before.counts(), body.counts());
    assert_eq!([counts.0.c, counts.0.ch, counts.0.cc], [counts.1.c, counts.1.ch, counts.1.cc]);
    // All is real now.
    let after = body.clone();
    assert!(editor.undo());
    assert_eq!(editor.body(), &before);
    assert!(editor.redo());
    assert_eq!(editor.body(), &after);
}

#[test]
fn crossing_lines_get_a_node_there() {
    let mut body = flaps();
    let s = body.surface_mut(S);
    let mut line = |a: (u32, f64), b: (u32, f64)| {
        let nodes =
            [a, b].map(|(e, u)| s.add_attribute_node(AttributeNode::OnEdge { edge: EdgeId(e), u }).unwrap());
        s.add_attribute_edge(AttributeEdge { name: None, nodes: nodes.to_vec() }).unwrap();
    };
    line((0, 0.5), (2, 0.0));
    line((1, 0.5), (2, 1.0));
    line((1, 0.0), (2, 0.5));
    line((0, 0.1), (0, 0.9));
    let mut editor = Editor::new(body);
    let done = editor.triangulate_face(S, FaceId(0)).unwrap();
    assert_eq!(editor.body().check(), []);
    // Three medians: one node in the middle, or three beside each other where rounding keeps them apart.
    assert!([1, 3].contains(&done.crossings.len()), "{done:?}");
    for n in 0..editor.body().surface(S).attribute_nodes().len() as u32 {
        let AttributeNode::OnEdge { u, .. } = editor.body().surface(S).attribute_nodes()[n as usize] else {
            panic!("node {n} lies in a face")
        };
        assert!(u == 0.0 || u == 1.0);
    }
}

#[test]
fn what_cannot_be_is_refused_and_changes_nothing() {
    let mut body = flaps();
    let mut editor = Editor::new(body.clone());
    assert!(matches!(editor.triangulate_face(S, FaceId(0)), Err(TriangulateError::NothingToDo { .. })));
    assert!(matches!(editor.triangulate_face(S, FaceId(9)), Err(TriangulateError::NoFace { .. })));
    assert!(matches!(editor.triangulate_face(SurfaceId(9), FaceId(0)), Err(TriangulateError::NoFace { .. })));
    // At a corner is nothing to be made real.
    body.surface_mut(S).add_attribute_node(AttributeNode::OnEdge { edge: EdgeId(0), u: 1.0 }).unwrap();
    let mut editor = Editor::new(body.clone());
    assert!(matches!(editor.triangulate_face(S, FaceId(0)), Err(TriangulateError::NothingToDo { .. })));
    assert_eq!((editor.body(), editor.undo_len()), (&body, 0));
}

/// Attributes of random places in and on one face, many of them on sides and on each other.
fn crowd(body: &mut Body, random: &mut Random, surface: SurfaceId, face: FaceId) {
    let s = body.surface_mut(surface);
    let mut nodes: Vec<AttributeNodeId> = Vec::new();
    for _ in 0..2 + random.below(8) {
        let node = if random.below(3) == 0 {
            let edge = EdgeId(s.face_edges()[face.index()][random.below(3)]);
            AttributeNode::OnEdge { edge, u: [0.0, 1.0, 0.5, random.unit(), random.unit()][random.below(5)] }
        } else {
            let mut w = [0, 1, 2].map(|_| random.unit());
            if random.below(4) == 0 {
                w[random.below(3)] = 0.0;
            }
            let sum: f64 = w.iter().sum();
            AttributeNode::InFace { face, areal: w.map(|w| w / sum) }
        };
        nodes.push(s.add_attribute_node(node).unwrap());
    }
    for _ in 0..random.below(4) {
        let length = 2 + random.below(3);
        let line = (0..length).map(|_| nodes[random.below(nodes.len())]).collect();
        let _ = s.add_attribute_edge(AttributeEdge { name: None, nodes: line });
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn bodies_stay_sound_and_come_back(kind in 0u8..4, seed: u64) {
        let mut random = Random(seed ^ 0x7a1e);
        let mut body = random_body(kind, seed);
        if seed % 2 == 0 {
            add_attributes(&mut body, &mut random);
            add_wires(&mut body, &mut random);
        }
        if seed % 3 == 0 {
            body.surface_ids().for_each(|s| body.surface_mut(s).store_backup());
        }
        if body.surfaces().len() == 0 {
            return Ok(());
        }
        let surface = SurfaceId(random.below(body.surfaces().len()) as u32);
        let faces = body.surface(surface).faces().len();
        if faces == 0 {
            return Ok(());
        }
        let face = FaceId(random.below(faces) as u32);
        crowd(&mut body, &mut random, surface, face);
        let before = body.clone();
        let places: Vec<DVec3> = (0..body.surface(surface).attribute_nodes().len() as u32)
            .map(|n| body.surface(surface).attribute_position(AttributeNodeId(n)))
            .collect();
        let mut editor = Editor::new(body);
        match editor.triangulate_face(surface, face) {
            Ok(done) => {
                let body = editor.body();
                prop_assert_eq!(body.check(), []);
                let (a, b) = (before.counts(), body.counts());
                prop_assert_eq!([a.c, a.ch, a.cc], [b.c, b.ch, b.cc]);
                prop_assert!((a.v + (done.crossings.len() as i64)) <= b.v);
                prop_assert!((body.area() - before.area()).abs() <= 1e-9 * before.area());
                let s = body.surface(surface);
                for (n, place) in places.iter().enumerate() {
                    let now = s.attribute_position(AttributeNodeId(n as u32));
                    prop_assert!(now.distance(*place) < 1e-6, "{n}: {now} {place}");
                }
                for (n, v) in &done.nodes {
                    prop_assert!(s.attribute_position(*n).distance(s.positions()[v.index()]) < 1e-6);
                    prop_assert!(s.is_node(NodeId(v.0)));
                }
                let after = body.clone();
                prop_assert!(editor.undo());
                prop_assert_eq!(editor.body(), &before);
                prop_assert!(editor.redo());
                prop_assert_eq!(editor.body(), &after);
            }
            Err(TriangulateError::NothingToDo { .. } | TriangulateError::Crowded { .. }) => {
                prop_assert_eq!(editor.body(), &before);
            }
            Err(other) => prop_assert!(false, "{other}"),
        }
    }
}
