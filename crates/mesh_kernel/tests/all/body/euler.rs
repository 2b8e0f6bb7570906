//! Each Euler operator: its exact delta, its inverse, its refusals.

use crate::body::support::{fan, tube};
use mesh_kernel::body::edit::{
    EdgeRole, Editor, EulerError, EulerOperator, FaceRole, JointError, LayerError,
};
use mesh_kernel::body::{
    AttributeEdge, AttributeEdgeId, AttributeNode, AttributeNodeId, Body, ChainSpec, Counts, EdgeId, FaceId,
    JointId, JointSpec, NodeId, SurfaceId, SurfaceSpec,
};
use mesh_kernel::glam::{DVec2, DVec3};

const S: SurfaceId = SurfaceId(0);

fn difference(a: Counts, b: Counts) -> Counts {
    let [v, e, f, r] = [a.v - b.v, a.e - b.e, a.f - b.f, a.r - b.r];
    Counts { v, e, f, r, c: a.c - b.c, ch: a.ch - b.ch, cc: a.cc - b.cc }
}

/// Runs an operator, which must change the counts as its table says, leave a sound body, and be undone and redone.
#[track_caller]
fn step<T>(editor: &mut Editor, operator: EulerOperator, run: impl FnOnce(&mut Editor) -> T) -> T {
    let before = editor.body().clone();
    let made = run(editor);
    let after = editor.body().clone();
    assert_eq!(difference(after.counts(), before.counts()), operator.delta(), "{}", operator.name());
    assert_eq!(after.check(), [], "{}", operator.name());
    assert!(after != before);
    assert!(editor.undo());
    assert!(editor.body() == &before, "{} undone", operator.name());
    assert!(editor.redo());
    assert!(editor.body() == &after, "{} done again", operator.name());
    made
}

fn tetrahedron() -> Body {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let faces = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    Body::build(&[SurfaceSpec { name: "tetrahedron".into(), positions, faces }], &[]).unwrap()
}

#[test]
fn a_tetrahedron_is_made_and_taken_apart() {
    use EulerOperator as Op;
    let mut e = Editor::new(Body::default());
    let s = e.add_surface("tetrahedron");
    let empty = e.body().clone();
    let a = step(&mut e, Op::MakeVertexComplex, |e| e.make_vertex_complex(s, DVec3::ZERO).unwrap());
    let (b, ab) = step(&mut e, Op::MakeVertexEdge, |e| e.make_vertex_edge(s, a, DVec3::X).unwrap());
    let (c, ac) = step(&mut e, Op::MakeVertexEdge, |e| e.make_vertex_edge(s, a, DVec3::Y).unwrap());
    let bc = step(&mut e, Op::MakeEdgeChole, |e| e.make_edge_chole(s, b, c).unwrap());
    let d = step(&mut e, Op::MakeVertexComplex, |e| e.make_vertex_complex(s, DVec3::Z).unwrap());
    let ad = step(&mut e, Op::MakeEdgeKillComplex, |e| e.make_edge_kill_complex(s, a, d).unwrap());
    let bd = step(&mut e, Op::MakeEdgeChole, |e| e.make_edge_chole(s, b, d).unwrap());
    let cd = step(&mut e, Op::MakeEdgeChole, |e| e.make_edge_chole(s, c, d).unwrap());
    let mut faces = Vec::new();
    for sides in [[ac, bc, ab], [ab, bd, ad], [bc, cd, bd]] {
        faces.push(step(&mut e, Op::MakeFaceKillChole, |e| e.make_face_kill_chole(s, sides).unwrap()));
    }
    let last = [ad, cd, ac];
    assert!(matches!(e.make_face_kill_chole(s, last), Err(EulerError::ClosesCavity { .. })));
    let lid = step(&mut e, Op::MakeFaceMakeCavity, |e| e.make_face_make_cavity(s, last).unwrap());
    let whole = e.body().clone();
    let counts = whole.counts();
    assert_eq!((counts.v, counts.e, counts.f, counts.c, counts.ch, counts.cc), (4, 6, 4, 1, 0, 1));
    assert_eq!(whole.surface(s).faces(), [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]);

    // All of it taken apart and made again in mirror order: the same body, bit for bit.
    assert!(matches!(e.kill_face_make_chole(s, lid), Err(EulerError::ClosesCavity { .. })));
    step(&mut e, Op::KillFaceKillCavity, |e| e.kill_face_kill_cavity(s, lid).unwrap());
    assert!(matches!(e.kill_face_kill_cavity(s, faces[2]), Err(EulerError::FillsHole { .. })));
    for &f in faces.iter().rev() {
        step(&mut e, Op::KillFaceMakeChole, |e| e.kill_face_make_chole(s, f).unwrap());
    }
    step(&mut e, Op::KillEdgeChole, |e| e.kill_edge_chole(s, cd).unwrap());
    step(&mut e, Op::KillEdgeChole, |e| e.kill_edge_chole(s, bd).unwrap());
    assert!(matches!(e.kill_edge_chole(s, ad), Err(EulerError::JoinsComplexes { .. })));
    step(&mut e, Op::KillEdgeMakeComplex, |e| e.kill_edge_make_complex(s, ad).unwrap());
    step(&mut e, Op::KillVertexComplex, |e| e.kill_vertex_complex(s, d).unwrap());
    assert!(matches!(e.kill_edge_make_complex(s, bc), Err(EulerError::ClosesCycle { .. })));
    step(&mut e, Op::KillEdgeChole, |e| e.kill_edge_chole(s, bc).unwrap());
    step(&mut e, Op::KillVertexEdge, |e| e.kill_vertex_edge(s, c).unwrap());
    step(&mut e, Op::KillVertexEdge, |e| e.kill_vertex_edge(s, b).unwrap());
    step(&mut e, Op::KillVertexComplex, |e| e.kill_vertex_complex(s, a).unwrap());
    let mut compact = e.body().clone();
    compact.compact();
    assert_eq!(compact, empty);

    assert_eq!(e.make_vertex_complex(s, DVec3::ZERO).unwrap(), a);
    assert_eq!(e.make_vertex_edge(s, a, DVec3::X).unwrap(), (b, ab));
    assert_eq!(e.make_vertex_edge(s, a, DVec3::Y).unwrap(), (c, ac));
    assert_eq!(e.make_edge(s, b, c).unwrap(), (bc, EdgeRole::Cycle));
    assert_eq!(e.make_vertex_complex(s, DVec3::Z).unwrap(), d);
    assert_eq!(e.make_edge(s, a, d).unwrap(), (ad, EdgeRole::Bridge));
    assert_eq!(e.make_edge(s, b, d).unwrap(), (bd, EdgeRole::Cycle));
    assert_eq!(e.make_edge(s, c, d).unwrap(), (cd, EdgeRole::Cycle));
    for (sides, face) in [[ac, bc, ab], [ab, bd, ad], [bc, cd, bd]].into_iter().zip(faces) {
        assert_eq!(e.make_face(s, sides).unwrap(), (face, FaceRole::Filling));
    }
    assert_eq!(e.make_face(s, last).unwrap(), (lid, FaceRole::Closing));
    assert_eq!(e.body(), &whole);
    while e.undo() {}
    assert_eq!(e.body(), &Body::default());
}

#[test]
fn operators_and_inverses_pair_up() {
    for operator in EulerOperator::ALL {
        assert_eq!(operator.inverse().inverse(), operator);
        let (d, back) = (operator.delta(), operator.inverse().delta());
        assert_eq!(
            difference(d, difference(Counts { v: 0, e: 0, f: 0, r: 0, c: 0, ch: 0, cc: 0 }, back)).v,
            0
        );
        assert!(d.identity_holds(), "{}", operator.name());
        let sum = [d.v + back.v, d.e + back.e, d.f + back.f, d.r + back.r, d.c + back.c, d.ch + back.ch];
        assert_eq!((sum, d.cc + back.cc), ([0; 6], 0), "{}", operator.name());
    }
}

#[test]
fn a_wire_is_split_and_merged() {
    let mut e = Editor::new(Body::default());
    let s = e.add_surface("wire");
    let a = e.make_vertex_complex(s, DVec3::ZERO).unwrap();
    let (b, wire) = e.make_vertex_edge(s, a, DVec3::X * 4.0).unwrap();
    e.store_backup(s).unwrap();
    e.set_planar(s, Some(vec![DVec2::ZERO, DVec2::new(8.0, 4.0)])).unwrap();
    // A number that is free, so that the inverse is exact.
    let spare = e.make_vertex_edge(s, b, DVec3::Y).unwrap().0;
    e.kill_vertex_edge(s, spare).unwrap();
    let before = e.body().clone();
    let (m, second) = step(&mut e, EulerOperator::SplitWire, |e| e.split_wire(s, wire, 0.25).unwrap());
    let t = e.body().surface(s);
    assert_eq!(t.positions()[m.index()], DVec3::X);
    assert_eq!(t.backup().unwrap()[m.index()], DVec3::X);
    assert_eq!(t.planar().unwrap()[m.index()], DVec2::new(2.0, 1.0));
    assert_eq!((t.edges()[wire.index()], t.edges()[second.index()]), ([a.0, m.0], [m.0, b.0]));
    assert_eq!(step(&mut e, EulerOperator::MergeWire, |e| e.merge_wire(s, m).unwrap()), wire);
    assert_eq!(e.body(), &before);

    for at in [0.0, 1.0, f64::NAN] {
        assert!(matches!(e.split_wire(s, wire, at), Err(EulerError::Parameter(_))));
    }
    assert!(matches!(e.split_wire(s, EdgeId(9), 0.5), Err(EulerError::NoEdge { .. })));
    assert!(matches!(e.merge_wire(s, a), Err(EulerError::NodeHasEdges { .. })));
    let alone = e.make_vertex_complex(s, DVec3::Z).unwrap();
    assert!(matches!(e.merge_wire(s, alone), Err(EulerError::NodeAlone { .. })));
    assert!(matches!(e.kill_vertex_edge(s, alone), Err(EulerError::NodeAlone { .. })));
    // A triangle of wires: merged, two of them would be the third.
    let c = e.make_vertex_edge(s, a, DVec3::Y).unwrap().0;
    let close = e.make_edge_chole(s, b, c).unwrap();
    assert!(matches!(e.merge_wire(s, c), Err(EulerError::MergeExists { edge, .. }) if edge == wire));
    // Attributes go along with a split, and are not to be lost in a merge or a kill.
    let on = AttributeNode::OnEdge { edge: close, u: 0.75 };
    e.add_attribute_node(s, on).unwrap();
    assert!(matches!(e.kill_edge(s, close), Err(EulerError::CarriesAttributes { .. })));
    let place = e.body().surface(s).attribute_position(AttributeNodeId(0));
    let (m, _) = e.split_wire(s, close, 0.5).unwrap();
    assert_eq!(e.body().surface(s).attribute_position(AttributeNodeId(0)), place);
    assert!(matches!(e.merge_wire(s, m), Err(EulerError::CarriesAttributes { .. })));
    e.remove_attribute_node(s, AttributeNodeId(0)).unwrap();
    let tail = e.make_vertex_edge(s, m, DVec3::Z).unwrap();
    e.add_attribute_node(s, AttributeNode::OnEdge { edge: tail.1, u: 0.5 }).unwrap();
    assert!(matches!(e.kill_vertex_edge(s, tail.0), Err(EulerError::CarriesAttributes { .. })));
}

#[test]
fn what_operators_refuse() {
    let none = SurfaceId(7);
    let mut e = Editor::new(tetrahedron());
    let far = e.make_vertex_complex(S, DVec3::splat(9.0)).unwrap();
    let before = e.body().clone();
    let steps = e.undo_len();
    let nan = DVec3::new(f64::NAN, 0.0, 0.0);
    let (n, g) = (NodeId(99), FaceId(99));
    assert_eq!(e.make_vertex_complex(none, DVec3::ZERO), Err(EulerError::NoSurface(none)));
    assert_eq!(e.make_vertex_complex(S, nan), Err(EulerError::NotFinite));
    assert_eq!(e.make_vertex_edge(S, far, nan), Err(EulerError::NotFinite));
    assert_eq!(e.make_vertex_edge(S, n, DVec3::X), Err(EulerError::NoNode { surface: S, node: n }));
    assert_eq!(e.kill_vertex_complex(S, n), Err(EulerError::NoNode { surface: S, node: n }));
    assert!(
        matches!(e.kill_vertex_complex(S, NodeId(0)), Err(EulerError::NodeHasEdges { ref edges, .. }) if edges.len() == 3)
    );
    assert!(matches!(e.kill_vertex_edge(S, NodeId(0)), Err(EulerError::NodeHasEdges { .. })));
    assert_eq!(e.make_edge(S, far, far), Err(EulerError::RepeatedNode(far)));
    assert!(matches!(e.make_edge(S, NodeId(0), NodeId(1)), Err(EulerError::EdgeExists { .. })));
    assert!(matches!(e.make_edge_chole(S, NodeId(0), far), Err(EulerError::JoinsComplexes { .. })));
    assert_eq!(e.kill_edge(S, EdgeId(99)), Err(EulerError::NoEdge { surface: S, edge: EdgeId(99) }));
    assert!(
        matches!(e.kill_edge(S, EdgeId(0)), Err(EulerError::EdgeHasFaces { ref faces, .. }) if faces.len() == 2)
    );
    assert!(matches!(e.split_wire(S, EdgeId(0), 0.5), Err(EulerError::EdgeHasFaces { .. })));
    assert_eq!(e.kill_face(S, g), Err(EulerError::NoFace { surface: S, face: g }));
    let sides = before.surface(S).face_edges()[0].map(EdgeId);
    assert!(matches!(e.make_face(S, sides), Err(EulerError::SideTaken { .. })));
    assert!(matches!(e.make_face(S, [sides[0]; 3]), Err(EulerError::NoTriangle { .. })));
    assert!(matches!(e.make_face(S, [sides[0], sides[1], EdgeId(99)]), Err(EulerError::NoEdge { .. })));
    assert!(matches!(e.make_vertex_ring(S, g, [0.2, 0.3, 0.5]), Err(EulerError::NoFace { .. })));
    assert!(matches!(e.make_vertex_ring(S, FaceId(0), [0.2, 0.3, 0.6]), Err(EulerError::Attribute(_))));
    assert_eq!((e.body(), e.undo_len()), (&before, steps));

    // A free number names nothing.
    e.kill_vertex_complex(S, far).unwrap();
    assert!(matches!(e.make_vertex_edge(S, far, DVec3::X), Err(EulerError::NoNode { .. })));
    assert!(matches!(e.move_nodes(S, &[(far, DVec3::X)]), Err(LayerError::NoNode { .. })));
    e.kill_face(S, FaceId(0)).unwrap();
    assert!(matches!(e.kill_face(S, FaceId(0)), Err(EulerError::NoFace { .. })));
    // A closed cycle of edges in one complex.
    assert!(matches!(e.make_edge_kill_complex(S, NodeId(0), NodeId(1)), Err(EulerError::EdgeExists { .. })));
    // The other side of a face that is there.
    let mut e = Editor::new(Body::default());
    let s = e.add_surface("face");
    let nodes = [DVec3::ZERO, DVec3::X, DVec3::Y].map(|p| e.make_vertex_complex(s, p).unwrap());
    let sides = [0, 1, 2].map(|i| e.make_edge(s, nodes[i], nodes[(i + 1) % 3]).unwrap().0);
    e.make_face(s, sides).unwrap();
    let turned = [sides[2], sides[1], sides[0]];
    assert!(matches!(e.make_face(s, turned), Err(EulerError::FaceExists { .. })));
    assert!(matches!(e.make_face_make_cavity(s, turned), Err(EulerError::FaceExists { .. })));
    let tail = e.make_vertex_edge(s, nodes[0], DVec3::Z).unwrap();
    assert!(matches!(e.merge_wire(s, nodes[1]), Err(EulerError::EdgeHasFaces { .. })));
    let other = e.make_edge(s, tail.0, nodes[1]).unwrap().0;
    assert!(matches!(e.make_edge_kill_complex(s, tail.0, nodes[2]), Err(EulerError::ClosesCycle { .. })));
    let third = [tail.1, other, sides[0]];
    assert!(matches!(e.make_face_make_cavity(s, third), Err(EulerError::FillsHole { .. })));
    for error in [e.kill_edge(s, sides[0]).unwrap_err(), e.make_face(s, turned).unwrap_err()] {
        assert!(error.to_string().len() > 30, "{error}");
    }
}

#[test]
fn rings_are_attributes_and_change_no_count() {
    use EulerOperator as Op;
    let mut e = Editor::new(tetrahedron());
    let before = e.body().clone();
    let a = step(&mut e, Op::MakeVertexRing, |e| e.make_vertex_ring(S, FaceId(1), [0.2, 0.3, 0.5]).unwrap());
    let b = step(&mut e, Op::MakeVertexRing, |e| e.make_vertex_ring(S, FaceId(1), [0.5, 0.3, 0.2]).unwrap());
    let line = step(&mut e, Op::MakeEdgeKillRing, |e| e.make_edge_kill_ring(S, [a, b]).unwrap());
    assert!(matches!(e.kill_vertex_ring(S, a), Err(EulerError::NotLastNode { last, .. }) if last == b));
    assert!(matches!(e.kill_vertex_ring(S, b), Err(EulerError::NodeInEdge { line: l, .. }) if l == line));
    assert!(matches!(e.kill_face(S, FaceId(1)), Err(EulerError::CarriesAttributes { .. })));
    assert!(matches!(e.make_edge_kill_ring(S, [a, a]), Err(EulerError::RepeatedRing(n)) if n == a));
    assert!(matches!(e.kill_edge_make_ring(S, AttributeEdgeId(4)), Err(EulerError::NoRingEdge { .. })));
    let elsewhere = e.make_vertex_ring(S, FaceId(2), [0.2, 0.3, 0.5]).unwrap();
    assert!(matches!(e.make_edge_kill_ring(S, [a, elsewhere]), Err(EulerError::Attribute(_))));
    let on = e.add_attribute_node(S, AttributeNode::OnEdge { edge: EdgeId(0), u: 0.5 }).unwrap();
    assert!(matches!(e.make_edge_kill_ring(S, [a, on]), Err(EulerError::NoRing { .. })));
    assert!(matches!(e.kill_vertex_ring(S, on), Err(EulerError::NoRing { .. })));
    let second = e.make_edge_kill_ring(S, [b, a]).unwrap();
    assert!(
        matches!(e.kill_edge_make_ring(S, line), Err(EulerError::NotLastEdge { last, .. }) if last == second)
    );
    assert!(matches!(
        e.remove_attribute_edge(S, AttributeEdgeId(9)),
        Err(EulerError::NoAttributeEdge { .. })
    ));
    e.remove_attribute_edge(S, second).unwrap();
    e.remove_attribute_node(S, on).unwrap();
    step(&mut e, Op::KillVertexRing, |e| e.kill_vertex_ring(S, elsewhere).unwrap());
    step(&mut e, Op::KillEdgeMakeRing, |e| e.kill_edge_make_ring(S, line).unwrap());
    step(&mut e, Op::KillVertexRing, |e| e.kill_vertex_ring(S, b).unwrap());
    step(&mut e, Op::KillVertexRing, |e| e.kill_vertex_ring(S, a).unwrap());
    assert_eq!(e.body(), &before);

    let line = AttributeEdge { name: None, nodes: vec![AttributeNodeId(5)] };
    assert!(matches!(e.set_attributes(S, &[], &[line]), Err(EulerError::Attribute(_))));
    assert_eq!(e.body(), &before);
}

#[test]
fn joints_stand_in_the_way_and_say_so() {
    // Three sheets on an axis of two edges.
    let mut e = Editor::new(fan(5, 3, 2));
    let joint = e.body().joint_ids().next().unwrap();
    let start = e.body().clone();
    let u = start.joint(joint).uses()[0];
    let s = start.surface(u.surface);
    let edge = s.chain(u.chain).edges()[0].edge();
    let face = FaceId(s.edge_faces()[edge.index()].into_iter().find(|f| *f != u32::MAX).unwrap());
    assert!(
        matches!(e.kill_face(u.surface, face), Err(EulerError::EdgeOnJoint { joint: j, .. }) if j == joint)
    );
    // A face that touches the joint in its middle node only: the chain would leave its loop.
    let middle = s.chain_nodes(u.chain)[1];
    let past = s.live_faces().find(|f| {
        let sides = s.face_edges()[f.index()];
        s.faces()[f.index()].contains(&middle)
            && sides.iter().all(|&x| s.edge_chain(EdgeId(x)).and_then(|c| s.chain(c).joint()).is_none())
    });
    if let (Some(f), true) = (past, s.chain(u.chain).on_loop().is_some()) {
        let refused = e.kill_face(u.surface, f);
        assert!(
            matches!(refused, Err(EulerError::JointPassesFace { node, .. }) if node.0 == middle),
            "{refused:?}"
        );
    }
    assert_eq!(e.body(), &start);

    // Killed, the joint is no longer in the way; undone and done again all is as it was.
    let spec = e.kill_joint(joint).unwrap();
    assert_eq!(e.body().check(), []);
    assert_eq!(e.body().joint_count(), 0);
    let apart = e.body().clone();
    assert_eq!(e.make_joint(&spec).unwrap(), joint);
    assert_eq!(e.body(), &start);
    assert!(e.undo());
    assert_eq!(e.body(), &apart);
    e.kill_face(u.surface, face).unwrap();
    let (again, role) = {
        let sides = start.surface(u.surface).face_edges()[face.index()].map(EdgeId);
        e.make_face(u.surface, sides).unwrap()
    };
    assert_eq!((again, role), (face, FaceRole::Filling));
    e.make_joint(&spec).unwrap();
    assert_eq!(e.body(), &start);
    assert_eq!(e.kill_joint(JointId(9)), Err(JointError::NoJoint(JointId(9))));
    let wrong = JointSpec { chains: spec.chains[..1].to_vec(), name: None };
    assert!(matches!(e.make_joint(&wrong), Err(JointError::Build(_))));
    while e.undo() {}
    assert_eq!(e.body(), &start);
}

#[test]
fn joints_of_every_kind_come_back_bit_for_bit() {
    for seed in 0..60 {
        for body in [fan(seed, 2 + seed as usize % 5, 1 + seed as usize % 3), tube(seed, 5, 2)] {
            let mut e = Editor::new(body.clone());
            let joints: Vec<JointId> = body.joint_ids().collect();
            let specs: Vec<JointSpec> = joints.iter().map(|&j| e.kill_joint(j).unwrap()).collect();
            assert_eq!(e.body().check(), []);
            for (spec, joint) in specs.iter().zip(joints).rev() {
                assert_eq!(e.make_joint(spec).unwrap(), joint);
            }
            assert!(e.body() == &body, "seed {seed}");
            while e.undo() {}
            assert!(e.body() == &body, "seed {seed}");
        }
    }
}

#[test]
fn wires_on_joints() {
    // Two surfaces of one wire each, in one place, held together; and a node that a joint without edges holds.
    let mut e = Editor::new(Body::default());
    let mut ends = Vec::new();
    for name in ["a", "b"] {
        let s = e.add_surface(name);
        let p = e.make_vertex_complex(s, DVec3::ZERO).unwrap();
        let (q, edge) = e.make_vertex_edge(s, p, DVec3::X).unwrap();
        let alone = e.make_vertex_complex(s, DVec3::Y).unwrap();
        ends.push((s, p, q, edge, alone));
    }
    let chain = |surface: usize, nodes: Vec<u32>| ChainSpec { surface, nodes, closed: false };
    let wires = JointSpec { name: None, chains: vec![chain(0, vec![0, 1]), chain(1, vec![0, 1])] };
    let joint = e.make_joint(&wires).unwrap();
    let touch =
        e.make_joint(&JointSpec { name: None, chains: vec![chain(0, vec![2]), chain(1, vec![2])] }).unwrap();
    assert_eq!((e.body().counts().v, e.body().counts().e, e.body().counts().c), (3, 1, 2));
    let (s, p, q, edge, alone) = ends[0];
    assert!(matches!(e.kill_edge(s, edge), Err(EulerError::EdgeOnJoint { joint: j, .. }) if j == joint));
    assert!(matches!(e.split_wire(s, edge, 0.5), Err(EulerError::EdgeOnJoint { .. })));
    assert!(matches!(e.kill_vertex_edge(s, q), Err(EulerError::NodeOnJoint { .. })));
    assert!(
        matches!(e.kill_vertex_complex(s, alone), Err(EulerError::NodeOnJoint { joint: j, .. }) if j == touch)
    );
    // Connected through the joints: a cycle, though this surface has two complexes of its own.
    let across = e.make_edge_kill_complex(s, p, alone).unwrap();
    let (t, o, _, _, other_alone) = ends[1];
    assert_eq!(e.make_edge(t, o, other_alone).unwrap().1, EdgeRole::Cycle);
    let c = e.make_vertex_edge(s, q, DVec3::Z).unwrap().0;
    let sides = [edge, e.make_edge(s, q, alone).unwrap().0, across];
    assert!(matches!(e.make_face(s, sides), Err(EulerError::EdgeOnJoint { .. })));
    let (m, _) = e.make_vertex_edge(s, c, DVec3::splat(2.0)).unwrap();
    e.make_vertex_edge(s, m, DVec3::splat(3.0)).unwrap();
    e.merge_wire(s, m).unwrap();
    // Moving takes the partners along.
    e.move_nodes(s, &[(p, DVec3::NEG_X)]).unwrap();
    assert_eq!(e.body().surface(t).positions()[o.index()], DVec3::NEG_X);
    let nan = [(p, DVec3::splat(f64::NAN))];
    assert!(matches!(e.move_nodes(s, &nan), Err(LayerError::NotFinite { .. })));
    let moves = [(p, DVec3::X), (p, DVec3::Y)];
    assert!(matches!(e.move_nodes(s, &moves), Err(LayerError::Parted { .. })));
    assert_eq!(e.body().check(), []);
    // One node by a joint: no edge between its two copies.
    let mut e = Editor::new(Body::default());
    let s = e.add_surface("ring");
    let nodes = [(); 2].map(|()| e.make_vertex_complex(s, DVec3::ZERO).unwrap());
    e.make_joint(&JointSpec { name: None, chains: vec![chain(0, vec![0]), chain(0, vec![1])] }).unwrap();
    assert!(matches!(e.make_edge(s, nodes[0], nodes[1]), Err(EulerError::SameNode { .. })));
}

#[test]
fn a_cavity_is_found_through_joints() {
    // A tetrahedron of four surfaces with six joints: the last side of one, its joints killed, closes the cavity again.
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let faces = [[0usize, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let specs: Vec<SurfaceSpec> = faces
        .iter()
        .map(|f| SurfaceSpec {
            name: "side".into(),
            positions: f.map(|v| corners[v]).to_vec(),
            faces: vec![[0, 1, 2]],
        })
        .collect();
    let mut joints = Vec::new();
    for i in 0..4 {
        for j in 0..i {
            let common: Vec<usize> = faces[i].into_iter().filter(|v| faces[j].contains(v)).collect();
            let chain = |k: usize| {
                let local = |v: &usize| faces[k].iter().position(|x| x == v).unwrap() as u32;
                ChainSpec { surface: k, nodes: common.iter().map(local).collect(), closed: false }
            };
            joints.push(JointSpec { name: None, chains: vec![chain(i), chain(j)] });
        }
    }
    let mut e = Editor::new(Body::build(&specs, &joints).unwrap());
    assert_eq!(e.body().counts().cc, 1);
    // A face away from the joints. The middle of the first split touches them in its corners.
    let split = e.split_face(S, FaceId(0)).unwrap();
    assert!(matches!(e.kill_face(S, split.children[3]), Err(EulerError::JointPassesFace { .. })));
    let split = e.split_face(S, split.children[3]).unwrap();
    let middle = split.children[3];
    let role = step(&mut e, EulerOperator::KillFaceKillCavity, |e| e.kill_face(S, middle).unwrap());
    assert_eq!(role, FaceRole::Closing);
    let sides = {
        let nodes = split.nodes;
        let t = e.body().surface(S);
        [0, 1, 2].map(|i| t.find_edge(NodeId(nodes[i]), NodeId(nodes[(i + 1) % 3])).unwrap())
    };
    let made =
        step(&mut e, EulerOperator::MakeFaceMakeCavity, |e| e.make_face_make_cavity(S, sides).unwrap());
    assert_eq!(made, middle);
}

#[test]
fn layers_go_and_come_back() {
    let mut e = Editor::new(fan(3, 3, 2));
    let start = e.body().clone();
    assert!(matches!(e.restore_backup(S), Err(LayerError::NoBackup(_))));
    e.store_backup(S).unwrap();
    let n = start.surface(S).positions().len();
    let all: Vec<_> =
        start.surface(S).live_nodes().map(|v| (v, start.surface(S).positions()[v.index()] * 2.0)).collect();
    e.move_nodes(S, &all).unwrap();
    assert_eq!(e.body().check().iter().filter(|d| d.code() == "joint_apart").count(), 0);
    e.restore_backup(S).unwrap();
    for (id, s) in start.surfaces() {
        assert_eq!(e.body().surface(id).positions(), s.positions());
    }
    let planar = vec![DVec2::ONE; n];
    assert!(matches!(e.set_planar(S, Some(planar[1..].to_vec())), Err(LayerError::Length { .. })));
    let broken = vec![DVec2::splat(f64::INFINITY); n];
    assert!(matches!(e.set_planar(S, Some(broken)), Err(LayerError::NotFinite { .. })));
    e.set_planar(S, Some(planar)).unwrap();
    e.set_planar(S, None).unwrap();
    e.rename_surface(S, "other").unwrap();
    assert_eq!(e.body().surface(S).name(), "other");
    assert_eq!(e.rename_surface(SurfaceId(99), "x"), Err(LayerError::NoSurface(SurfaceId(99))));
    let mut replay = Editor::new(start.clone());
    for operation in e.operations() {
        replay.apply(&operation).unwrap();
    }
    assert_eq!(replay.body(), e.body());
    while e.undo() {}
    assert_eq!(e.body(), &start);
}
