//! Operators on faces: kinds, places about edges, regions, all their refusals.

use crate::complex::support::*;
use mesh_kernel::complex::{
    Delta, DirectedEdge, Editor, FaceId, FaceKind, FaceUse, Loop, NewFace, Operation, RadialOrder, Reason,
    Refusal, VertexId,
};
use mesh_kernel::glam::DVec3;

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
fn places_of_facets_that_are_not_convex() {
    // An arch: at the inner edge of its notch both neighbouring corners lie on the other side of the edge than the arch itself. And
    // a plate with a hole, joined at an edge of the hole.
    let arch = [
        [0.0, 0.0],
        [1.0, 0.0],
        [1.0, -1.0],
        [2.0, -1.0],
        [2.0, 2.0],
        [-1.0, 2.0],
        [-1.0, -1.0],
        [0.0, -1.0],
    ];
    for turned in [false, true] {
        for axes in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [1, 0, 2]] {
            let at = |x: f64, y: f64, z: f64| {
                let mut q = [0.0; 3];
                (q[axes[0]], q[axes[1]], q[axes[2]]) = (x, y, z);
                DVec3::from(q)
            };
            let mut points: Vec<DVec3> = arch.iter().map(|[x, y]| at(*x, *y, 0.0)).collect();
            // Leaves at the edge, a little above and a little below the plane of the arch, on both sides of the edge.
            for (y, z) in [(1.0, 0.1), (1.0, -0.1), (-1.0, 0.1), (-1.0, -0.1)] {
                points.push(at(0.5, y, z));
            }
            let mut first: Vec<usize> = (0..8).collect();
            if turned {
                first.reverse();
            }
            let editor =
                build(&points, &[first, vec![0, 1, 8], vec![1, 0, 9], vec![0, 1, 10], vec![1, 0, 11]]);
            assert_sound(editor.complex());
            let c = editor.complex();
            let e = c.edges().find(|e| c.uses(*e).len() == 5).unwrap();
            let order: Vec<u32> = c.uses(e).iter().map(|u| u.face.0).collect();
            // The arch lies between the two leaves on its side: 1, 0, 2 in one direction or the other.
            assert!(order == [0, 1, 3, 4, 2] || order == [0, 2, 4, 3, 1], "{order:?}");
        }
    }
    let square = |a: f64, b: f64| [p(a, a, 0.0), p(b, a, 0.0), p(b, b, 0.0), p(a, b, 0.0)];
    let mut points = [square(0.0, 3.0), square(1.0, 2.0)].concat();
    points.extend([p(1.5, 0.0, 0.1), p(1.5, 0.0, -0.1), p(1.5, 2.0, 0.1)]);
    let mut editor = Editor::default();
    let plate = vec![vec![0, 1, 2, 3], vec![4, 7, 6, 5]];
    let leaves = [[4, 5, 8], [5, 4, 9], [4, 5, 10]].map(|l| vec![l.to_vec()]);
    add_faces(&mut editor, &points, &[vec![plate], leaves.to_vec()].concat());
    assert_sound(editor.complex());
    let c = editor.complex();
    let e = c.edges().find(|e| c.uses(*e).len() == 4).unwrap();
    let order: Vec<u32> = c.uses(e).iter().map(|u| u.face.0).collect();
    assert!(order == [0, 1, 3, 2] || order == [0, 2, 3, 1], "{order:?}");
}
