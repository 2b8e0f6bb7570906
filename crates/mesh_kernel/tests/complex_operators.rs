//! Every operator: its delta, its inverse bit for bit, all its refusals.

// A test that cannot go on fails.
#![allow(clippy::unwrap_used)]

mod complex_support;

use complex_support::*;
use mesh_kernel::complex::{
    Corner, Delta, DirectedEdge, EdgeClass, EdgeId, EdgeKind, Editor, End, Entity, FaceId, FaceKind, FaceUse,
    Loop, NewFace, Operation, RadialOrder, Reason, Refusal, VertexId,
};
use mesh_kernel::glam::DVec3;

/// Applies an operator; its delta must be the one counted, its inverse must give the complex back, undo and redo too.
fn done(editor: &mut Editor, operation: Operation, wanted: Delta) {
    let before = editor.complex().clone();
    assert_eq!(before.can(&operation), Ok(wanted));
    let outcome = editor.apply(&operation).unwrap();
    assert_eq!(outcome.delta, wanted);
    assert_eq!(Delta::between(&before.counts(), &editor.complex().counts()), wanted);
    assert_sound_topology(editor.complex());
    let after = editor.complex().clone();
    let record = editor.journal().done.last().unwrap()[0].clone();
    let mut back = Editor::new(after.clone());
    assert_eq!(back.apply(&record.inverse).unwrap().delta, -wanted);
    assert_bit_equal(back.complex(), &before);
    // The inverse's inverse is the operator.
    let again = back.journal().done.last().unwrap()[0].inverse.clone();
    back.apply(&again).unwrap();
    assert_bit_equal(back.complex(), &after);
    assert!(editor.undo());
    assert_bit_equal(editor.complex(), &before);
    assert!(editor.redo());
    assert_bit_equal(editor.complex(), &after);
    let text = serde_json::to_string(&record).unwrap();
    assert_eq!(serde_json::from_str::<mesh_kernel::complex::Record>(&text).unwrap(), record);
}

/// The operator must be refused with this reason, and nothing change.
fn refused(editor: &mut Editor, operation: Operation, reason: Reason) {
    let before = editor.clone();
    let refusal = editor.apply(&operation).unwrap_err();
    assert_eq!(refusal.reason, reason);
    assert_eq!(editor.complex().can(&operation), Err(refusal.clone()));
    assert!(*editor == before);
    let text = refusal.to_string();
    assert!(text.starts_with(operation.name()) && text.ends_with(reason.remedy()), "{text}");
}

fn square(editor: &mut Editor) -> ([VertexId; 4], FaceId) {
    let at = [p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(1.0, 1.0, 0.0), p(0.0, 1.0, 0.0)];
    let (v, f) = add_faces(editor, &at, &[vec![vec![0, 1, 2, 3]]]);
    ([v[0], v[1], v[2], v[3]], f[0])
}

const NO_V: VertexId = VertexId(77);
const NO_E: EdgeId = EdgeId(77);
const NO_F: FaceId = FaceId(77);
const FREE: EdgeClass = EdgeClass::Free;

#[test]
fn vertices_alone() {
    let mut m = Editor::default();
    done(&mut m, Operation::MakeVertexComplex { position: DVec3::X }, delta(1, 0, 0, 0, 1, 0, 0));
    let a = m.complex().vertices().next().unwrap();
    done(&mut m, Operation::KillVertexComplex { vertex: a }, delta(-1, 0, 0, 0, -1, 0, 0));
    refused(&mut m, Operation::KillVertexComplex { vertex: a }, Reason::NoVertex(a));
    let nan = m.apply(&Operation::MakeVertexComplex { position: p(f64::NAN, 0.0, 0.0) });
    assert!(matches!(nan, Err(Refusal { reason: Reason::NotFinite(_), .. })));
    let (v, f) = square(&mut m);
    let edges = m.complex().edges_at(v[0]).to_vec();
    let reason = Reason::VertexInUse { vertex: v[0], edges: edges.clone(), faces: vec![] };
    assert_eq!(reason.entities(), edges.iter().map(|e| Entity::Edge(*e)).collect::<Vec<_>>());
    refused(&mut m, Operation::KillVertexComplex { vertex: v[0] }, reason);
    let ring = m.make_vertex_ring(f, p(0.5, 0.5, 0.0)).unwrap();
    let reason = Reason::VertexInUse { vertex: ring, edges: vec![], faces: vec![f] };
    refused(&mut m, Operation::KillVertexComplex { vertex: ring }, reason);
    done(&mut m, Operation::MoveVertex { vertex: ring, position: p(0.4, 0.5, 0.0) }, Delta::default());
    refused(&mut m, Operation::MoveVertex { vertex: NO_V, position: DVec3::X }, Reason::NoVertex(NO_V));
    refused(
        &mut m,
        Operation::MoveVertex { vertex: ring, position: DVec3::INFINITY },
        Reason::NotFinite([f64::INFINITY; 3]),
    );
}

fn vertex_edge(from: VertexId, corner: Option<(FaceId, Corner)>, inward: bool) -> Operation {
    let corner = corner.map(|(face, corner)| mesh_kernel::complex::FaceCorner { face, corner });
    Operation::MakeVertexEdge { from, position: p(0.3, 0.2, 0.0), corner, inward, class: FREE }
}

#[test]
fn vertices_at_edges_free_and_in_a_face() {
    let mut m = Editor::default();
    let (v, f) = square(&mut m);
    let one = delta(1, 1, 0, 0, 0, 0, 0);
    for inward in [false, true] {
        done(&mut m, vertex_edge(v[0], None, inward), one);
        let loose = m.complex().vertices().last().unwrap();
        done(&mut m, Operation::KillVertexEdge { vertex: loose }, -one);
        let corner = m.complex().corners_at(f, v[0])[0];
        done(&mut m, vertex_edge(v[0], Some((f, corner)), inward), one);
        let strut = m.complex().vertices().last().unwrap();
        // Two corners now at the vertex; a strut into each, and one on the strut's end.
        let corners = m.complex().corners_at(f, v[0]);
        assert!(corners.len() >= 2);
        for corner in corners {
            done(&mut m, vertex_edge(v[0], Some((f, corner)), inward), one);
        }
        let end = m.complex().corners_at(f, strut)[0];
        done(&mut m, vertex_edge(strut, Some((f, end)), inward), one);
        let edges = m.complex().edges_at(strut).to_vec();
        refused(
            &mut m,
            Operation::KillVertexEdge { vertex: strut },
            Reason::NotLooseEnd { vertex: strut, edges },
        );
        let last = m.complex().vertices().last().unwrap();
        done(&mut m, Operation::KillVertexEdge { vertex: last }, -one);
        assert_sound(m.complex());
    }
    // On a ring of one vertex.
    let ring = m.make_vertex_ring(f, p(0.5, 0.5, 0.0)).unwrap();
    done(&mut m, vertex_edge(ring, Some((f, Corner::Vertex(ring))), false), one);
    let end = m.complex().vertices().last().unwrap();
    done(&mut m, Operation::KillVertexEdge { vertex: end }, -one);
    // A pole on the ring: it stays a ring, and cannot go with the pole.
    let pole = m.make_vertex_edge(ring, p(0.5, 0.5, 1.0)).unwrap();
    let reason = Reason::VertexInUse { vertex: ring, edges: vec![pole.edge], faces: vec![f] };
    refused(&mut m, Operation::KillVertexEdge { vertex: ring }, reason.clone());
    refused(&mut m, Operation::KillVertexRing { vertex: ring }, reason);
    refused(&mut m, vertex_edge(NO_V, None, false), Reason::NoVertex(NO_V));
    let corner = Corner::Vertex(v[1]);
    refused(&mut m, vertex_edge(v[1], Some((f, corner)), false), Reason::NoCorner { face: f, corner });
    refused(&mut m, vertex_edge(v[1], Some((NO_F, corner)), false), Reason::NoFace(NO_F));
    let corner = m.complex().corners_at(f, v[1])[0];
    let reason = Reason::OtherVertex { face: f, found: v[1], asked: v[2] };
    refused(&mut m, vertex_edge(v[2], Some((f, corner)), false), reason);
    refused(&mut m, Operation::KillVertexEdge { vertex: NO_V }, Reason::NoVertex(NO_V));
    assert!(m.make_vertex_edge_in_face(f, Corner::Leaving(DirectedEdge::along(NO_E)), DVec3::X).is_err());
}

#[test]
fn struts_that_cannot_go() {
    // Two faces that walk one strut to and fro: neither may lose it alone.
    let mut m = Editor::default();
    let (v, _) = square(&mut m);
    let strut = m.make_vertex_edge(v[0], p(-1.0, -1.0, 0.0)).unwrap();
    let walk = vec![DirectedEdge::along(strut.edge), DirectedEdge::against(strut.edge)];
    for _ in 0..2 {
        let face = m.complex().next_face();
        let mut uses = m.complex().uses(strut.edge).to_vec();
        uses.extend([false, true].map(|along| FaceUse { face, along }));
        let order = RadialOrder { edge: strut.edge, uses };
        let kind = m.make_face(NewFace::new(walk.clone()).placed(order)).unwrap().kind;
        assert_eq!(kind, FaceKind::Cavity);
    }
    let faces = m.complex().faces_of(strut.edge);
    let reason = Reason::FacesAtEdge { edge: strut.edge, faces: faces.clone() };
    refused(&mut m, Operation::KillVertexEdge { vertex: strut.vertex }, reason);
    assert_sound_topology(m.complex());
    // A vertex that is a loop of the face already.
    m.kill_face(faces[1]).unwrap();
    m.kill_face(faces[0]).unwrap();
    let f = m.make_face(NewFace::new(walk).ring(v[0])).unwrap().face;
    refused(&mut m, Operation::KillVertexEdge { vertex: strut.vertex }, Reason::RingTwice(v[0]));
    refused(
        &mut m,
        Operation::KillEdgeMakeRing { edge: strut.edge, ring: End::End },
        Reason::RingTwice(v[0]),
    );
    assert_eq!(m.complex().faces_pierced_at(v[0]), [f]);
}

#[test]
fn wires() {
    let mut m = Editor::default();
    let a = m.make_vertex_complex(DVec3::ZERO).unwrap();
    let b = m.make_vertex_complex(DVec3::X).unwrap();
    let make = |ends, kind| match kind {
        EdgeKind::Chole => Operation::MakeEdgeChole { ends, class: EdgeClass::Weld },
        EdgeKind::Complex => Operation::MakeEdgeKillComplex { ends, class: EdgeClass::Bend },
    };
    refused(
        &mut m,
        make([a, b], EdgeKind::Chole),
        Reason::EdgeKind { between: [a, b], found: EdgeKind::Complex },
    );
    refused(&mut m, make([a, a], EdgeKind::Chole), Reason::SelfLoop(a));
    refused(&mut m, make([a, NO_V], EdgeKind::Complex), Reason::NoVertex(NO_V));
    done(&mut m, make([a, b], EdgeKind::Complex), delta(0, 1, 0, 0, -1, 0, 0));
    let reason = Reason::EdgeKind { between: [b, a], found: EdgeKind::Chole };
    refused(&mut m, make([b, a], EdgeKind::Complex), reason.clone());
    done(&mut m, make([b, a], EdgeKind::Chole), delta(0, 1, 0, 0, 0, 1, 0));
    let [x, y]: [EdgeId; 2] = m.complex().edges().collect::<Vec<_>>().try_into().unwrap();
    refused(&mut m, Operation::KillEdgeMakeComplex { edge: y }, reason);
    done(&mut m, Operation::KillEdgeChole { edge: x }, delta(0, -1, 0, 0, 0, -1, 0));
    let reason = Reason::EdgeKind { between: [b, a], found: EdgeKind::Complex };
    refused(&mut m, Operation::KillEdgeChole { edge: y }, reason);
    done(&mut m, Operation::KillEdgeMakeComplex { edge: y }, delta(0, -1, 0, 0, 1, 0, 0));
    refused(&mut m, Operation::KillEdgeChole { edge: y }, Reason::NoEdge(y));
    assert_eq!(m.make_edge(a, b).unwrap().kind, EdgeKind::Complex);
    let (v, f) = square(&mut m);
    let e = m.complex().edges_between(v[0], v[1])[0];
    for operation in [Operation::KillEdgeChole { edge: e }, Operation::KillEdgeMakeComplex { edge: e }] {
        refused(&mut m, operation, Reason::FacesAtEdge { edge: e, faces: vec![f] });
    }
}

#[test]
fn wires_see_through_faces_with_rings() {
    // A ring hangs on its face: an edge from it to the outer loop closes a cycle.
    let mut m = Editor::default();
    let (v, f) = square(&mut m);
    let ring = m.make_vertex_ring(f, p(0.5, 0.5, 0.0)).unwrap();
    let pole = m.make_vertex_edge(ring, p(0.5, 0.5, 1.0)).unwrap().vertex;
    let made = m.make_edge(pole, v[0]).unwrap();
    assert_eq!((made.kind, made.delta), (EdgeKind::Chole, delta(0, 1, 0, 0, 0, 1, 0)));
    assert_sound(m.complex());
    // Without the face the pole is the only link.
    m.kill_face(f).unwrap();
    assert_eq!(m.complex().counts(), counts(6, 6, 0, 0, 1, 1, 0));
    assert_eq!(m.kill_edge(made.edge).unwrap().kind, EdgeKind::Complex);
}

fn make_face(face: NewFace, kind: FaceKind) -> Operation {
    match kind {
        FaceKind::Chole => Operation::MakeFaceKillChole { face },
        FaceKind::Cavity => Operation::MakeFaceMakeCavity { face },
    }
}

#[test]
fn faces_fill_or_close() {
    let mut m = Editor::default();
    let (_, faces) = add_box(&mut m, DVec3::ZERO, DVec3::ONE);
    for f in faces {
        let reason = Reason::FaceKind {
            beside: {
                let mut all: Vec<FaceId> = m.complex().faces().collect();
                // The four around it: not itself, not the opposite one.
                let mine = m.complex().loops(f)[0].clone();
                let touches = |g: &FaceId| {
                    let edges = m.complex().loops(*g)[0].edges().to_vec();
                    edges.iter().any(|d| mine.edges().contains(&d.flipped()))
                };
                all.retain(touches);
                all
            },
            found: FaceKind::Cavity,
        };
        refused(&mut m, Operation::KillFaceMakeChole { face: f }, reason.clone());
        done(&mut m, Operation::KillFaceKillCavity { face: f }, delta(0, 0, -1, 0, 0, 0, -1));
        let back = m.journal().done.last().unwrap()[0].inverse.clone();
        let Operation::MakeFaceMakeCavity { face } = back else { unreachable!() };
        refused(&mut m, make_face(face.clone(), FaceKind::Chole), reason);
        done(&mut m, make_face(face, FaceKind::Cavity), delta(0, 0, 1, 0, 0, 0, 1));
    }
    let mut m = Editor::default();
    let (_, f) = square(&mut m);
    let reason = Reason::FaceKind { beside: vec![], found: FaceKind::Chole };
    refused(&mut m, Operation::KillFaceKillCavity { face: f }, reason.clone());
    done(&mut m, Operation::KillFaceMakeChole { face: f }, delta(0, 0, -1, 0, 0, 1, 0));
    let walk: Loop = m.journal().done.last().unwrap()[0].inverse.clone().pipe();
    refused(&mut m, make_face(NewFace::new(walk.clone()), FaceKind::Cavity), reason);
    done(&mut m, make_face(NewFace::new(walk.clone()), FaceKind::Chole), delta(0, 0, 1, 0, 0, -1, 0));
    // A second one on the same edges closes a pillow.
    done(&mut m, make_face(NewFace::new(walk), FaceKind::Cavity), delta(0, 0, 1, 0, 0, 0, 1));
    refused(&mut m, Operation::KillFaceKillCavity { face: NO_F }, Reason::NoFace(NO_F));
}

trait OuterLoop {
    fn pipe(self) -> Loop;
}

impl OuterLoop for Operation {
    fn pipe(self) -> Loop {
        match self {
            Operation::MakeFaceKillChole { face } | Operation::MakeFaceMakeCavity { face } => face.outer,
            _ => unreachable!(),
        }
    }
}

#[test]
fn what_is_not_a_face() {
    let mut m = Editor::default();
    let (v, f) = square(&mut m);
    let strut = m.make_vertex_edge(v[0], p(-1.0, 0.0, 0.0)).unwrap();
    let walk = m.complex().loops(f)[0].edges().to_vec();
    let chole = FaceKind::Chole;
    refused(&mut m, make_face(NewFace::new(Vec::new()), chole), Reason::EmptyLoop);
    let open = NewFace::new(walk[..3].to_vec());
    refused(&mut m, make_face(open, chole), Reason::OpenLoop { this: walk[2], next: walk[0] });
    let twice = NewFace::new(walk.clone()).ring(walk.clone());
    refused(&mut m, make_face(twice, chole), Reason::UsedTwice(walk[0]));
    let rings = NewFace::new(walk.clone()).ring(strut.vertex).ring(strut.vertex);
    refused(&mut m, make_face(rings, chole), Reason::RingTwice(strut.vertex));
    let dead = NewFace::new(vec![DirectedEdge::along(NO_E)]);
    refused(&mut m, make_face(dead, chole), Reason::NoEdge(NO_E));
    refused(&mut m, make_face(NewFace::new(NO_V), chole), Reason::NoVertex(NO_V));
    // An existing vertex as ring: the bridge closes a cycle, the face a pillow.
    let pierced = NewFace::new(walk).ring(strut.vertex);
    done(&mut m, make_face(pierced, FaceKind::Cavity), delta(0, 0, 1, 1, 0, 1, 1));
    assert_eq!(
        m.complex().walk(&[v[0], v[2]]).unwrap_err().reason,
        Reason::NotOneEdge { from: v[0], to: v[2], edges: vec![] }
    );
}

/// An edge along z with plates to the given directions, and the edge's id.
fn fan(directions: &[[f64; 2]]) -> (Editor, EdgeId, Vec<FaceId>) {
    let nodes: Vec<[f64; 2]> = [[0.0, 0.0]].into_iter().chain(directions.iter().copied()).collect();
    let links: Vec<[usize; 2]> = (1..nodes.len()).map(|k| [0, k]).collect();
    let editor = extruded(&nodes, &links);
    let e = editor.complex().edges().max_by_key(|e| editor.complex().uses(*e).len()).unwrap();
    let faces = editor.complex().faces().collect();
    (editor, e, faces)
}

#[test]
fn places_about_an_edge() {
    let (mut m, e, faces) = fan(&[[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]]);
    assert_eq!(m.complex().uses(e).len(), 3);
    assert_sound(m.complex());
    let [a, b] = m.complex().ends(e).unwrap();
    let wing = |m: &mut Editor, to: DVec3| {
        let at = m.complex().position(b).unwrap();
        let c = m.make_vertex_edge(b, at + to).unwrap().vertex;
        let d = m.make_vertex_edge(c, m.complex().position(a).unwrap() + to).unwrap().vertex;
        m.make_edge_chole(d, a).unwrap();
        NewFace::new(m.complex().walk(&[a, b, c, d]).unwrap())
    };
    // In the same direction as an old one: the positions do not tell.
    let same = wing(&mut m, p(2.0, 0.0, 0.0));
    let tie = m.apply(&make_face(same.clone(), FaceKind::Chole)).unwrap_err();
    let Reason::RadialTie { edge, faces: tied } = &tie.reason else { unreachable!("{tie}") };
    assert_eq!((*edge, tied.contains(&m.complex().next_face())), (e, true));
    let new = FaceUse { face: m.complex().next_face(), along: m.complex().ends(e) == Some([a, b]) };
    // Given, both places are possible.
    for old in m.complex().uses(e).to_vec() {
        let order = m.complex().order_after(e, old, new);
        done(&mut m, make_face(same.clone().placed(order), FaceKind::Chole), delta(0, 0, 1, 0, 0, -1, 0));
        assert_eq!(m.complex().next_use(e, old), Some(new));
        m.undo();
    }
    // Orders that are none.
    let stored = m.complex().uses(e).to_vec();
    let given = Reason::RadialGiven { edge: e, faces: stored.iter().map(|u| u.face).collect() };
    let mut swapped = stored.clone();
    swapped.swap(0, 1);
    swapped.push(new);
    for uses in [stored.clone(), vec![new], swapped, [&stored[..], &[new, new]].concat()] {
        let face = same.clone().placed(RadialOrder { edge: e, uses });
        refused(&mut m, make_face(face, FaceKind::Chole), given.clone());
    }
    let other = m.complex().edges().find(|x| !same.outer.edges().iter().any(|d| d.edge == *x)).unwrap();
    let face = same.placed(RadialOrder { edge: other, uses: vec![] });
    let reason = Reason::RadialGiven { edge: other, faces: m.complex().faces_of(other) };
    refused(&mut m, make_face(face, FaceKind::Chole), reason);
    // Found from the positions, exactly: hardly beside an old one.
    let near = wing(&mut m, p(3.0, 1e-15, 0.0));
    m.make_face_kill_chole(near).unwrap();
    assert_sound(m.complex());
    // Vertices moved: the stored order is no longer that of the positions.
    let moved =
        m.complex().vertices().filter(|v| m.complex().position(*v).unwrap().x == -1.0).collect::<Vec<_>>();
    for v in moved {
        let at = m.complex().position(v).unwrap();
        m.move_vertex(v, p(1.0, 0.5, at.z)).unwrap();
    }
    assert_eq!(m.complex().check().len(), 1);
    let late = wing(&mut m, p(0.0, -5.0, 0.0));
    let reason =
        Reason::RadialStored { edge: e, faces: m.complex().uses(e).iter().map(|u| u.face).collect() };
    refused(&mut m, make_face(late, FaceKind::Chole), reason);
    // Put in order again.
    let mesh_kernel::complex::Defect::Radial { edge, found, .. } = m.complex().check()[0].clone() else {
        unreachable!()
    };
    done(&mut m, Operation::OrderEdge { order: RadialOrder { edge, uses: found } }, Delta::default());
    assert_sound(m.complex());
    let wrong = RadialOrder { edge: e, uses: vec![] };
    let mut all = m.complex().faces_of(e);
    all.sort_unstable();
    refused(
        &mut m,
        Operation::OrderEdge { order: wrong.clone() },
        Reason::RadialGiven { edge: e, faces: all },
    );
    refused(
        &mut m,
        Operation::OrderEdge { order: RadialOrder { edge: NO_E, ..wrong } },
        Reason::NoEdge(NO_E),
    );
    assert!(faces.len() == 3);
}

#[test]
fn a_face_lies_in_one_region() {
    // A wall that would lie inside a closed box at one edge and outside at the opposite one.
    let mut m = Editor::default();
    let (v, _) = add_box(&mut m, DVec3::ZERO, DVec3::ONE);
    let top = m.make_edge_chole(v[0], v[2]).unwrap();
    let low = m.make_edge_chole(v[4], v[6]).unwrap();
    let walk = m.complex().walk(&[v[0], v[2], v[6], v[4]]).unwrap();
    // By positions it is inside; it parts nothing, as its other two edges are wires that only lie on the box.
    done(&mut m, make_face(NewFace::new(walk.clone()), FaceKind::Chole), delta(0, 0, 1, 0, 0, -1, 0));
    m.undo();
    let new = m.complex().next_face();
    let upright = [(v[0], v[4]), (v[2], v[6])].map(|(a, b)| m.complex().edges_between(a, b)[0]);
    let placed = |m: &Editor, at: [usize; 2]| {
        let mut face = NewFace::new(walk.clone());
        for (e, i) in upright.iter().zip(at) {
            let along = walk.edges().iter().any(|d| *d == DirectedEdge::along(*e));
            let old = m.complex().uses(*e)[i];
            face = face.placed(m.complex().order_after(*e, old, FaceUse { face: new, along }));
        }
        face
    };
    let kinds: Vec<_> = [[0, 0], [0, 1], [1, 0], [1, 1]]
        .map(|at| m.complex().can(&make_face(placed(&m, at), FaceKind::Chole)))
        .to_vec();
    let two =
        kinds.iter().filter(|k| matches!(k, Err(Refusal { reason: Reason::TwoRegions { .. }, .. }))).count();
    assert_eq!(two, 2, "{kinds:?}");
    assert_eq!(m.complex().uses(top).len() + m.complex().uses(low).len(), 0);
    assert_sound(m.complex());
}

#[test]
fn a_klein_bottle_does_not_lie_in_space() {
    // A tube of four walls, bent in two halves, closed the wrong way round: its last face would have one region on both sides,
    // though it closes a surface.
    let n = 3usize;
    let mut points = Vec::new();
    for k in 0..n {
        for i in 0..n {
            points.push(p(k as f64, i as f64, (k * i) as f64 * 0.1));
        }
    }
    // A grid n × n whose columns close in order and whose rows close reversed.
    let id = |k: usize, i: usize| {
        let (turns, k) = (k / n, k % n);
        let i = i % n;
        let i = if turns % 2 == 1 { (n - i) % n } else { i };
        k * n + i
    };
    let mut faces = Vec::new();
    for k in 0..n {
        for i in 0..n {
            faces.push(vec![id(k, i), id(k + 1, i), id(k + 1, i + 1), id(k, i + 1)]);
        }
    }
    let last = faces.pop().unwrap();
    let mut m = build(&points, &faces);
    let c = m.complex().counts();
    assert_eq!((c.cc, c.c), (0, 1));
    let v: Vec<VertexId> = last
        .iter()
        .map(|i| m.complex().vertices().find(|v| m.complex().position(*v) == Some(points[*i])).unwrap())
        .collect();
    let walk = m.complex().walk(&v).unwrap();
    let refusal = m.apply(&make_face(NewFace::new(walk), FaceKind::Cavity)).unwrap_err();
    assert!(matches!(refusal.reason, Reason::NotSeparating { ref faces } if faces.len() == 4), "{refusal}");
    assert_sound_topology(m.complex());
}

#[test]
fn rings_and_edges_between_loops() {
    let mut m = Editor::default();
    let (v, f) = square(&mut m);
    let (up, down) = (delta(1, 0, 0, 1, 0, 0, 0), delta(0, 1, 0, -1, 0, 0, 0));
    done(&mut m, Operation::MakeVertexRing { face: f, position: p(0.3, 0.5, 0.0) }, up);
    done(&mut m, Operation::MakeVertexRing { face: f, position: p(0.6, 0.5, 0.0) }, up);
    let ids: Vec<VertexId> = m.complex().vertices().collect();
    let (x, y) = (ids[4], ids[5]);
    done(&mut m, Operation::KillVertexRing { vertex: y }, -up);
    m.undo();
    let at = |m: &Editor, v: VertexId| m.complex().corners_at(f, v)[0];
    let bridge = |m: &Editor, a, b| Operation::MakeEdgeKillRing {
        face: f,
        from: at(m, a),
        to: at(m, b),
        class: EdgeClass::Bend,
    };
    // Ring to ring, ring to outer, outer to ring.
    let operation = bridge(&m, x, y);
    done(&mut m, operation, down);
    let operation = bridge(&m, y, v[1]);
    done(&mut m, operation, down);
    assert_sound(m.complex());
    let both = [at(&m, x), at(&m, y)];
    let same = Operation::MakeEdgeKillRing { face: f, from: both[0], to: both[1], class: FREE };
    refused(&mut m, same, Reason::SameLoop(f));
    let missing = Corner::Vertex(x);
    let none = Operation::MakeEdgeKillRing { face: f, from: missing, to: both[0], class: FREE };
    refused(&mut m, none, Reason::NoCorner { face: f, corner: missing });
    let none = Operation::MakeEdgeKillRing { face: NO_F, from: missing, to: missing, class: FREE };
    refused(&mut m, none, Reason::NoFace(NO_F));
    let edges: Vec<EdgeId> = m.complex().edges().collect();
    for ring in [End::Start, End::End] {
        for &edge in &edges[4..] {
            done(&mut m, Operation::KillEdgeMakeRing { edge, ring }, -down);
            m.undo();
        }
    }
    refused(
        &mut m,
        Operation::KillEdgeMakeRing { edge: edges[0], ring: End::End },
        Reason::NotIsthmus { edge: edges[0], faces: vec![f] },
    );
    refused(&mut m, Operation::KillEdgeMakeRing { edge: NO_E, ring: End::End }, Reason::NoEdge(NO_E));
    refused(&mut m, Operation::MakeVertexRing { face: NO_F, position: DVec3::X }, Reason::NoFace(NO_F));
    refused(&mut m, Operation::KillVertexRing { vertex: NO_V }, Reason::NoVertex(NO_V));
    let alone = m.make_vertex_complex(DVec3::Z).unwrap();
    refused(
        &mut m,
        Operation::KillVertexRing { vertex: alone },
        Reason::NotRing { vertex: alone, faces: vec![] },
    );
    let ball = m.make_face(NewFace::new(alone)).unwrap().face;
    refused(
        &mut m,
        Operation::KillVertexRing { vertex: alone },
        Reason::NotRing { vertex: alone, faces: vec![ball] },
    );
    // An edge cannot lead from a vertex to itself, even where it is on two loops.
    let pierced = m.make_face(NewFace::new(m.complex().loops(f)[0].edges()[..0].to_vec()));
    assert!(pierced.is_err());
    let walk = m.complex().loops(f)[0].clone();
    let order = |m: &Editor, d: &DirectedEdge| {
        let mut uses = m.complex().uses(d.edge).to_vec();
        uses.push(FaceUse { face: m.complex().next_face(), along: !d.reversed });
        RadialOrder { edge: d.edge, uses }
    };
    let square: Vec<DirectedEdge> =
        walk.edges().iter().copied().filter(|d| edges[..4].contains(&d.edge)).collect();
    let mut touching = NewFace::new(square.clone()).ring(v[0]);
    touching.radial = square.iter().map(|d| order(&m, d)).collect();
    let g = m.make_face(touching).unwrap().face;
    let from = m.complex().corners_at(g, v[0]);
    assert_eq!(from.len(), 2);
    let operation = Operation::MakeEdgeKillRing { face: g, from: from[0], to: from[1], class: FREE };
    refused(&mut m, operation, Reason::SelfLoop(v[0]));
}

#[test]
fn edges_with_any_number_of_faces_are_split_and_merged() {
    for n in 0..6usize {
        let directions: Vec<[f64; 2]> =
            (0..n).map(|k| (k as f64 * 1.1).sin_cos()).map(|(s, c)| [c, s]).collect();
        let (mut m, e) = if n == 0 {
            let mut m = Editor::default();
            let a = m.make_vertex_complex(DVec3::ZERO).unwrap();
            let e = m.make_vertex_edge(a, DVec3::Z).unwrap().edge;
            (m, e)
        } else {
            let (m, e, _) = fan(&directions);
            (m, e)
        };
        let one = delta(1, 1, 0, 0, 0, 0, 0);
        for kept in [End::Start, End::End] {
            for flipped in [false, true] {
                let position = p(0.0, 0.0, 0.25);
                done(&mut m, Operation::SplitEdge { edge: e, position, kept, flipped }, one);
                assert_sound(m.complex());
                let middle = m.complex().vertices().last().unwrap();
                let [x, y] = m.complex().edges_at(middle).to_vec().try_into().unwrap();
                for kept in [x, y] {
                    done(&mut m, Operation::MergeEdge { kept, vertex: middle }, -one);
                    assert_sound(m.complex());
                    m.undo();
                }
                m.undo();
            }
        }
    }
}

#[test]
fn merges_that_cannot_be() {
    let mut m = Editor::default();
    let (v, f) = square(&mut m);
    let e = m.complex().edges_between(v[0], v[1])[0];
    let next = m.complex().edges_between(v[1], v[2])[0];
    refused(
        &mut m,
        Operation::SplitEdge { edge: NO_E, position: DVec3::X, kept: End::End, flipped: true },
        Reason::NoEdge(NO_E),
    );
    refused(&mut m, Operation::MergeEdge { kept: NO_E, vertex: v[0] }, Reason::NoEdge(NO_E));
    refused(&mut m, Operation::MergeEdge { kept: e, vertex: NO_V }, Reason::NoVertex(NO_V));
    let edges = m.complex().edges_at(v[2]).to_vec();
    refused(
        &mut m,
        Operation::MergeEdge { kept: e, vertex: v[2] },
        Reason::NotTwoEdges { vertex: v[2], edges },
    );
    let classes = Reason::ClassesDiffer([e, next]);
    done(&mut m, Operation::SetEdgeClass { edge: e, class: EdgeClass::Bend }, Delta::default());
    refused(&mut m, Operation::SetEdgeClass { edge: NO_E, class: EdgeClass::Bend }, Reason::NoEdge(NO_E));
    refused(&mut m, Operation::MergeEdge { kept: e, vertex: v[1] }, classes);
    m.undo();
    // Down to two edges, then no farther.
    m.merge_edge(e, v[1]).unwrap();
    let [a, b] = m.complex().ends(e).unwrap();
    let third = m.complex().vertices().find(|x| *x != a && *x != b).unwrap();
    let other = m.complex().edges_at(third)[0];
    m.merge_edge(other, third).unwrap();
    assert_eq!(m.complex().counts(), counts(2, 2, 1, 0, 1, 0, 0));
    let [a, b] = m.complex().ends(e).unwrap();
    let far = |kept_first: bool| if kept_first { b } else { a };
    let reason = m.apply(&Operation::MergeEdge { kept: e, vertex: far(true) }).unwrap_err().reason;
    assert_eq!(reason, Reason::SelfLoop(a));
    // A strut of two edges in a face turns back at its end; a vertex in between it does not.
    let mut m = Editor::default();
    let (v, f2) = square(&mut m);
    assert_eq!(f, f2);
    let corner = m.complex().corners_at(f, v[0])[0];
    let strut = m.make_vertex_edge_in_face(f, corner, p(0.3, 0.3, 0.0)).unwrap();
    let corner = m.complex().corners_at(f, strut.vertex)[0];
    let tip = m.make_vertex_edge_in_face(f, corner, p(0.6, 0.6, 0.0)).unwrap();
    done(
        &mut m,
        Operation::MergeEdge { kept: strut.edge, vertex: strut.vertex },
        delta(-1, -1, 0, 0, 0, 0, 0),
    );
    m.undo();
    // A wire at the tip: the face turns there.
    m.make_vertex_edge(tip.vertex, p(0.6, 0.6, 1.0)).unwrap();
    let reason = Reason::FacesTurn { vertex: tip.vertex, faces: vec![f] };
    refused(&mut m, Operation::MergeEdge { kept: tip.edge, vertex: tip.vertex }, reason);
    // A ring at the vertex.
    let wire = m.make_vertex_complex(p(5.0, 0.0, 0.0)).unwrap();
    let x = m.make_vertex_edge(wire, p(6.0, 0.0, 0.0)).unwrap();
    let y = m.make_vertex_edge(x.vertex, p(7.0, 0.0, 0.0)).unwrap();
    let ball = m.make_face(NewFace::new(x.vertex)).unwrap().face;
    let reason = Reason::VertexInUse { vertex: x.vertex, edges: vec![x.edge, y.edge], faces: vec![ball] };
    refused(&mut m, Operation::MergeEdge { kept: x.edge, vertex: x.vertex }, reason);
}

#[test]
fn an_order_that_would_open_a_cavity_is_refused() {
    // Three faces on one square: two cavities between them, if they lie in the same order about all edges.
    let mut m = Editor::default();
    let (_, f) = square(&mut m);
    let walk = m.complex().loops(f)[0].clone();
    m.make_face_make_cavity(NewFace::new(walk.clone())).unwrap();
    let mut third = NewFace::new(walk.clone());
    for d in walk.edges() {
        let along = !d.reversed;
        let [old, new] = [f, m.complex().next_face()].map(|face| FaceUse { face, along });
        let before = m.complex().uses(d.edge).iter().copied().find(|u| *u != old).unwrap();
        third = third.placed(m.complex().order_after(d.edge, if along { old } else { before }, new));
    }
    m.make_face_make_cavity(third).unwrap();
    assert_eq!(m.complex().counts().cc, 2);
    assert_sound_topology(m.complex());
    let e = walk.edges()[0].edge;
    let mut uses = m.complex().uses(e).to_vec();
    uses.swap(0, 1);
    let operation = Operation::OrderEdge { order: RadialOrder { edge: e, uses } };
    let refusal = m.apply(&operation).unwrap_err();
    assert!(matches!(refusal.reason, Reason::OrderChangesRegions { .. }), "{refusal}");
}

#[test]
fn transactions_roll_back_whole_and_nest() {
    let mut m = Editor::default();
    let (v, _) = square(&mut m);
    m.make_vertex_edge(v[0], p(0.0, 0.0, 1.0)).unwrap();
    m.undo();
    let before = m.clone();
    let result: Result<(), Refusal> = m.transaction(|m| {
        let x = m.make_vertex_edge(v[0], p(0.0, 0.0, 2.0))?.vertex;
        let inner: Result<(), Refusal> = m.transaction(|m| {
            m.make_edge_chole(x, v[2])?;
            m.kill_vertex_complex(x).map(|_| ())
        });
        assert!(inner.is_err());
        assert!(!m.undo() && !m.redo());
        assert!(m.complex().edges_between(x, v[2]).is_empty());
        m.make_edge_kill_complex(x, v[2]).map(|_| ())
    });
    assert!(result.is_err());
    // The journal too, and what can be done again.
    assert!(m == before);
    assert!(m.redo());
    m.transaction(|m| {
        let x = m.make_vertex_edge(v[0], p(0.0, 0.0, 2.0))?.vertex;
        m.make_edge_chole(x, v[2]).map(|_| ())
    })
    .unwrap();
    assert_eq!(m.journal().done.last().unwrap().len(), 2);
    // A journal that does not fit: told where.
    let journal = m.journal().clone();
    let mut other = Editor::default();
    other.make_vertex_complex(DVec3::ONE).unwrap();
    let error = other.replay(&journal).unwrap_err();
    assert!(error.to_string().starts_with("transaction "), "{error}");
}
