//! High-level operators and the sequences of Euler operators that they stand for give the same body, bit for bit.

use crate::body::support::sequences::{collapse, joints_anew, kind_of_edge, refine, some_edge, split, swap};
use crate::body::support::{Random, add_wires, random_body};
use mesh_kernel::body::edit::{CollapseOptions, Editor, Guard};
use mesh_kernel::body::{AttributeEdge, AttributeNode, Body, EdgeId, NodeId};

/// A body with numbers that are free, and wires.
fn start(seed: u64) -> Option<Body> {
    let mut random = Random(seed);
    let mut body = random_body(random.below(4) as u8, seed);
    if body.surfaces().len() > 0 && random.below(2) == 0 {
        add_wires(&mut body, &mut random);
    }
    let mut editor = Editor::new(body);
    for id in editor.body().surface_ids() {
        editor.set_attributes(id, &[], &[]).unwrap();
    }
    // Wires of several edges.
    for k in 0..8 {
        let (surface, edge) = some_edge(editor.body(), 4 * k)?;
        let _ = editor.split_wire(surface, edge, 0.5);
    }
    // Free numbers in an order of their own.
    for _ in 0..random.below(8) {
        let (surface, edge) = some_edge(editor.body(), random.below(1 << 20))?;
        let keep = NodeId(editor.body().surface(surface).edges()[edge.index()][random.below(2)]);
        let point_joints = editor.body().joint_ids().any(|j| editor.body().joint_len(j) == 0);
        if !point_joints {
            let _ = editor.collapse_edge(surface, edge, keep, &CollapseOptions::default());
        }
    }
    joints_anew(editor.body())
}

/// Asserts that `sequence` gives what the operator gave.
#[track_caller]
fn same(seed: u64, editor: &Editor, after: &Body) {
    let joints = after.joints().count() > 0;
    let expected = if joints { joints_anew(after).unwrap() } else { after.clone() };
    for (id, s) in expected.surfaces() {
        assert!(editor.body().surface(id) == s, "seed {seed}: surface {id} differs");
    }
    assert!(editor.body() == &expected, "seed {seed}: joints differ");
}

#[test]
fn an_edge_split_is_its_sequence() {
    let mut seen = [0; 3];
    for seed in 0..600 {
        let Some(body) = start(seed) else { continue };
        let mut random = Random(seed ^ 77);
        let Some((surface, edge)) = some_edge(&body, random.below(1 << 20)) else { continue };
        let kind = kind_of_edge(body.surface(surface), edge);
        let mut editor = Editor::new(body.clone());
        let at = if random.below(2) == 0 { 0.5 } else { 0.1 + 0.8 * random.unit() };
        let done = editor.split_edge(surface, edge, at).unwrap();
        let after = editor.into_body();
        let mut editor = Editor::new(body);
        if split(&mut editor, &done, at, &after).is_some() {
            same(seed, &editor, &after);
            seen[kind] += 1;
        }
    }
    assert!(seen.iter().all(|n| *n > 20), "inner, boundary, wires: {seen:?}");
}

#[test]
fn an_edge_swap_is_its_sequence() {
    let mut seen = 0;
    for seed in 0..600 {
        let Some(body) = start(seed) else { continue };
        let mut random = Random(seed ^ 77);
        let Some((surface, edge)) = some_edge(&body, random.below(1 << 20)) else { continue };
        let mut editor = Editor::new(body.clone());
        if editor.swap_edge(surface, edge, Guard::NoTurn).is_err() {
            continue;
        }
        let after = editor.into_body();
        let mut editor = Editor::new(body);
        if swap(&mut editor, surface, edge, &after).is_some() {
            same(seed, &editor, &after);
            seen += 1;
        }
    }
    assert!(seen > 100, "{seen}");
}

#[test]
fn an_edge_collapse_is_its_sequence() {
    let mut seen = [0; 3];
    let mut on_joints = 0;
    for seed in 0..2000 {
        let Some(body) = start(seed) else { continue };
        if body.joint_ids().any(|j| body.joint_len(j) == 0) {
            continue;
        }
        let mut random = Random(seed ^ 77);
        let Some((surface, edge)) = some_edge(&body, random.below(1 << 20)) else { continue };
        let kind = kind_of_edge(body.surface(surface), edge);
        let keep = NodeId(body.surface(surface).edges()[edge.index()][random.below(2)]);
        let at = [None, Some(0.5), Some(random.unit())][random.below(3)];
        let mut editor = Editor::new(body.clone());
        let options = CollapseOptions { at, guard: Guard::NoTurn };
        let Ok(done) = editor.collapse_edge(surface, edge, keep, &options) else { continue };
        let after = editor.into_body();
        let mut editor = Editor::new(body);
        if collapse(&mut editor, &done, &after).is_some() {
            same(seed, &editor, &after);
            seen[kind] += 1;
            on_joints += done.partners.len();
        }
    }
    assert!(seen.iter().all(|n| *n > 20) && on_joints > 20, "inner, boundary, wires: {seen:?}; {on_joints}");
}

#[test]
fn a_face_split_is_its_sequence() {
    let mut seen = 0;
    for seed in 0..600 {
        let Some(body) = start(seed) else { continue };
        let mut random = Random(seed ^ 77);
        let faces: Vec<_> =
            body.surfaces().flat_map(|(id, s)| s.live_faces().map(move |f| (id, f))).collect();
        if faces.is_empty() {
            continue;
        }
        let (surface, face) = faces[random.below(faces.len())];
        let mut editor = Editor::new(body.clone());
        editor.split_face(surface, face).unwrap();
        let after = editor.into_body();
        let mut editor = Editor::new(body);
        if refine(&mut editor, &after).is_some() {
            same(seed, &editor, &after);
            seen += 1;
        }
    }
    assert!(seen > 200, "{seen}");
}

/// The body without attributes.
fn bare(body: &Body) -> Body {
    let mut editor = Editor::new(body.clone());
    for id in editor.body().surface_ids() {
        editor.set_attributes(id, &[], &[]).unwrap();
    }
    editor.into_body()
}

#[test]
fn a_face_triangulation_is_its_sequence() {
    let mut seen = 0;
    for seed in 0..600 {
        let Some(body) = start(seed) else { continue };
        let mut random = Random(seed ^ 77);
        let faces: Vec<_> =
            body.surfaces().flat_map(|(id, s)| s.live_faces().map(move |f| (id, f))).collect();
        if faces.is_empty() {
            continue;
        }
        let (surface, face) = faces[random.below(faces.len())];
        let mut editor = Editor::new(body.clone());
        let sides = body.surface(surface).face_edges()[face.index()];
        let mut nodes = Vec::new();
        for _ in 0..1 + random.below(4) {
            let (u, v) = (0.05 + 0.4 * random.unit(), 0.05 + 0.4 * random.unit());
            let node = if random.below(2) == 0 {
                AttributeNode::OnEdge { edge: EdgeId(sides[random.below(3)]), u: u + v }
            } else {
                AttributeNode::InFace { face, areal: [u, v, 1.0 - u - v] }
            };
            nodes.push(editor.add_attribute_node(surface, node).unwrap());
        }
        if random.below(2) == 0 {
            editor.add_attribute_edge(surface, AttributeEdge { name: None, nodes }).unwrap();
        }
        if editor.triangulate_face(surface, face).is_err() {
            continue;
        }
        let after = bare(editor.body());
        let mut editor = Editor::new(body);
        if refine(&mut editor, &after).is_some() {
            same(seed, &editor, &after);
            seen += 1;
        }
    }
    assert!(seen > 200, "{seen}");
}
