//! Operators: what they do, what they refuse, and that undoing gives the same body bit for bit.

use crate::body::support::{Random, add_attributes, add_wires, fan, lattice, random_body};
use mesh_kernel::body::edit::{Editor, Guard, SplitEdgeError, SwapError};
use mesh_kernel::body::{Body, EdgeId, FaceId, NodeId, SurfaceId, SurfaceSpec};
use mesh_kernel::glam::DVec3;
use proptest::prelude::*;

fn square() -> Editor {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
    let faces = vec![[0, 1, 2], [0, 2, 3]];
    Editor::new(Body::build(&[SurfaceSpec { name: "square".into(), positions, faces }], &[]).unwrap())
}

const S: SurfaceId = SurfaceId(0);

#[test]
fn a_swap_turns_the_diagonal_and_four_are_none() {
    let mut editor = square();
    let before = editor.body().clone();
    let diagonal = editor.body().surface(S).find_edge(NodeId(0), NodeId(2)).unwrap();
    editor.swap_edge(S, diagonal, Guard::NoTurn).unwrap();
    assert_eq!(editor.body().check(), []);
    let mut ends = editor.body().surface(S).edges()[diagonal.index()];
    ends.sort_unstable();
    assert_eq!(ends, [1, 3]);
    for _ in 0..3 {
        editor.swap_edge(S, diagonal, Guard::NoTurn).unwrap();
    }
    assert_eq!(editor.body(), &before);
    for _ in 0..4 {
        assert!(editor.undo());
    }
    assert!(!editor.undo());
    assert_eq!((editor.body(), editor.redo_len()), (&before, 4));
}

#[test]
fn a_split_puts_a_node_and_cuts_the_faces() {
    let mut editor = square();
    let before = editor.body().clone();
    let diagonal = before.surface(S).find_edge(NodeId(0), NodeId(2)).unwrap();
    let split = editor.split_edge(S, diagonal, 0.25).unwrap();
    let s = editor.body().surface(S);
    assert_eq!((s.positions().len(), s.edges().len(), s.faces().len()), (5, 8, 4));
    // The diagonal runs from node 2 to node 0, as its first face does.
    assert_eq!(s.positions()[split.edge.node as usize], DVec3::new(0.75, 0.75, 0.0));
    assert_eq!(editor.body().check(), []);
    let rim = s.find_edge(NodeId(0), NodeId(1)).unwrap();
    editor.split_edge(S, rim, 0.5).unwrap();
    assert_eq!(editor.body().check(), []);
    assert_eq!(editor.body().surface(S).loop_nodes(mesh_kernel::body::LoopId(0)).len(), 5);
    let after = editor.body().clone();
    assert!(editor.undo() && editor.undo());
    assert_eq!(editor.body(), &before);
    assert!(editor.redo() && editor.redo() && !editor.redo());
    assert_eq!(editor.body(), &after);
}

#[test]
fn what_may_not_be_is_refused_and_changes_nothing() {
    let mut editor = square();
    let body = editor.body().clone();
    let rim = body.surface(S).find_edge(NodeId(0), NodeId(1)).unwrap();
    let diagonal = body.surface(S).find_edge(NodeId(0), NodeId(2)).unwrap();
    let none = EdgeId(99);
    assert!(matches!(editor.swap_edge(S, rim, Guard::None), Err(SwapError::NotInside { .. })));
    assert!(matches!(editor.swap_edge(S, none, Guard::None), Err(SwapError::NoEdge { .. })));
    assert!(matches!(editor.swap_edge(SurfaceId(7), rim, Guard::None), Err(SwapError::NoEdge { .. })));
    for at in [0.0, 1.0, -1.0, f64::NAN] {
        assert!(matches!(editor.split_edge(S, diagonal, at), Err(SplitEdgeError::Parameter(_))));
    }
    assert!(matches!(editor.split_edge(S, none, 0.5), Err(SplitEdgeError::NoEdge { .. })));
    assert_eq!((editor.body(), editor.undo_len()), (&body, 0));

    // A tetrahedron: the other diagonal is there already. A dart: the swapped face would turn over.
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let faces = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    let closed = Body::build(&[SurfaceSpec { name: "t".into(), positions, faces }], &[]).unwrap();
    assert!(matches!(
        Editor::new(closed).swap_edge(S, EdgeId(0), Guard::None),
        Err(SwapError::EdgeExists { .. })
    ));
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.1, 0.1, 0.0)];
    let spec = SurfaceSpec { name: "dart".into(), positions, faces: vec![[0, 1, 3], [0, 3, 2]] };
    let mut dart = Editor::new(Body::build(&[spec], &[]).unwrap());
    let edge = dart.body().surface(S).find_edge(NodeId(0), NodeId(3)).unwrap();
    assert!(matches!(dart.swap_edge(S, edge, Guard::NoTurn), Err(SwapError::Turns { .. })));

    // An inner chain on a joint.
    for seed in 0.. {
        let body = fan(seed, 3, 2);
        let inner = body.joints().find_map(|(_, j)| {
            let u = j.uses().iter().find(|u| body.surface(u.surface).chain(u.chain).on_loop().is_none())?;
            Some((u.surface, body.surface(u.surface).chain(u.chain).edges()[0].edge()))
        });
        let Some((surface, edge)) = inner else { continue };
        let mut editor = Editor::new(body);
        let refused = editor.swap_edge(surface, edge, Guard::None);
        assert!(
            matches!(refused, Err(SwapError::OnJoint { ref sheets, .. }) if sheets.len() == 2),
            "{refused:?}"
        );
        // A split takes the partners along.
        let split = editor.split_edge(surface, edge, 0.3).unwrap();
        assert_eq!((split.partners.len(), editor.undo_len()), (1, 1));
        assert_eq!(editor.body().check(), []);
        break;
    }
}

#[test]
fn a_transaction_that_fails_is_taken_back_whole() {
    let mut editor = square();
    let before = editor.body().clone();
    let diagonal = before.surface(S).find_edge(NodeId(0), NodeId(2)).unwrap();
    let failed: Result<(), SplitEdgeError> = editor.transaction(|e| {
        e.split_edge(S, diagonal, 0.5)?;
        e.split_edge(S, EdgeId(0), 0.5)?;
        e.split_edge(S, EdgeId(0), 2.0)?;
        Ok(())
    });
    assert_eq!(failed, Err(SplitEdgeError::Parameter(2.0)));
    assert_eq!((editor.body(), editor.undo_len()), (&before, 0));
    let kept: Result<(), SplitEdgeError> = editor.transaction(|e| {
        e.split_edge(S, diagonal, 0.5)?;
        e.split_edge(S, EdgeId(0), 0.5)?;
        Ok(())
    });
    assert_eq!((kept, editor.undo_len()), (Ok(()), 1));
    assert!(editor.undo());
    assert_eq!(editor.body(), &before);
}

/// Defects that a swap may bring about in the geometry, where it is not planar; never in the topology.
fn topology_sound(body: &Body) {
    let geometric = ["degenerate_face", "radial_order", "duplicate_face"];
    let defects: Vec<_> = body.check().into_iter().filter(|d| !geometric.contains(&d.code())).collect();
    assert_eq!(defects, []);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn what_is_done_can_be_undone(kind in 0u8..4, seed: u64, steps in proptest::collection::vec(any::<u32>(), 1..40)) {
        let mut random = Random(seed ^ 0xed17);
        let mut body = random_body(kind, seed);
        if seed % 3 == 0 {
            add_attributes(&mut body, &mut random);
            add_wires(&mut body, &mut random);
        }
        if seed % 5 == 0 {
            body.surface_ids().for_each(|s| body.surface_mut(s).store_backup());
        }
        let mut editor = Editor::new(body);
        let mut states = vec![editor.body().clone()];
        let area = editor.body().area();
        let mut swapped = false;
        for step in steps {
            let surfaces = editor.body().surfaces().len();
            if surfaces == 0 {
                break;
            }
            let surface = SurfaceId(step % surfaces as u32);
            let edges = editor.body().surface(surface).edges().len();
            if edges == 0 {
                continue;
            }
            let edge = EdgeId(random.below(edges) as u32);
            let done = if random.below(3) == 0 {
                let at = [0.5, 0.25 + 0.5 * random.unit()][random.below(2)];
                editor.split_edge(surface, edge, at).is_ok()
            } else {
                let done = editor.swap_edge(surface, edge, Guard::NoTurn).is_ok();
                swapped |= done;
                done
            };
            if done {
                topology_sound(editor.body());
                if !swapped {
                    // Every place of the surface stays where it is.
                    prop_assert!((editor.body().area() - area).abs() < 1e-9 * (1.0 + area));
                }
                let (before, now) = (states[0].counts(), editor.body().counts());
                prop_assert_eq!([before.c, before.ch, before.cc], [now.c, now.ch, now.cc]);
                states.push(editor.body().clone());
            }
            prop_assert_eq!(editor.undo_len(), states.len() - 1);
        }
        for state in states.iter().rev().skip(1) {
            prop_assert!(editor.undo());
            prop_assert_eq!(editor.body(), state);
        }
        for state in &states[1..] {
            prop_assert!(editor.redo());
            prop_assert_eq!(editor.body(), state);
        }
        // Splits of the whole follow on edited bodies as on built ones.
        let mut body = editor.into_body();
        body.split_all(None).unwrap();
        topology_sound(&body);
    }
}

#[test]
fn lattices_with_bow_ties_never_get_an_edge_twice() {
    for seed in 0..60 {
        let body = Body::from_tri_mesh(&lattice(seed, [2, 2, 2], 0.5, 2)).unwrap();
        let mut editor = Editor::new(body);
        for surface in editor.body().surface_ids() {
            for e in 0..editor.body().surface(surface).edges().len() as u32 {
                let _ = editor.swap_edge(surface, EdgeId(e), Guard::None);
            }
        }
        topology_sound(editor.body());
        assert!(
            editor.body().face_count() == 0 || editor.body().surface(S).faces().len() > FaceId(0).index()
        );
    }
}
