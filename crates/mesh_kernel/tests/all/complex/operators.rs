//! Every operator: its delta, its inverse bit for bit, all its refusals.

use crate::complex::support::*;
use mesh_kernel::complex::{
    Corner, Delta, DirectedEdge, EdgeClass, EdgeId, EdgeKind, Editor, End, Entity, FaceId, FaceKind, FaceUse,
    NewFace, Operation, RadialOrder, Reason, Refusal, VertexId,
};
use mesh_kernel::glam::DVec3;

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
