//! High-level operators as sequences of Euler operators.

use mesh_kernel::body::edit::{EdgeCollapse, EdgeSplit, Editor};
use mesh_kernel::body::{Body, EdgeId, FaceId, JointId, JointSpec, NONE, NodeId, Surface, SurfaceId};

/// Kills all joints, runs `between`, which may lengthen or shorten them, and makes them again in mirror order. `None`
/// where a joint cannot be killed.
pub(crate) fn without_joints(
    editor: &mut Editor,
    between: impl FnOnce(&mut Editor, &mut Vec<JointSpec>),
) -> Option<()> {
    let joints: Vec<JointId> = editor.body().joint_ids().collect();
    let mut specs = Vec::new();
    for joint in joints {
        specs.push(editor.kill_joint(joint).ok()?);
    }
    between(editor, &mut specs);
    for spec in specs.iter().rev() {
        editor.make_joint(spec).unwrap();
    }
    Some(())
}

/// The body with all its joints killed and made again: radial orders are those of the geometry then.
pub(crate) fn joints_anew(body: &Body) -> Option<Body> {
    let mut editor = Editor::new(body.clone());
    without_joints(&mut editor, |_, _| ())?;
    Some(editor.into_body())
}

/// Numbers in the order in which they are given: those that are not in `before` and are in `after`. Free ones were given
/// last in, first out, which the lengths cannot tell: `order` is the order of the free list before, the next one last.
fn given(before: impl Fn(u32) -> bool, after: impl Fn(u32) -> bool, len: usize, order: &[u32]) -> Vec<u32> {
    let mut new: Vec<u32> = (0..len as u32).filter(|&i| !before(i) && after(i)).collect();
    let place = |i: &u32| match order.iter().rposition(|x| x == i) {
        Some(p) => order.len() - 1 - p,
        None => order.len() + *i as usize,
    };
    new.sort_by_key(place);
    new
}

/// Free numbers of a surface in the order in which they are given, found by making on a copy.
fn free_numbers(body: &Body, surface: SurfaceId) -> [Vec<u32>; 3] {
    let mut editor = Editor::new(body.clone());
    let s = body.surface(surface);
    let counts = s.live_counts();
    let free = [s.positions().len() - counts[0], s.edges().len() - counts[1], s.faces().len() - counts[2]];
    let place = mesh_kernel::glam::DVec3::splat(1e3);
    // Nodes first; each edge needs a node of its own, each face three.
    let mut nodes = Vec::new();
    for _ in 0..free[0] {
        nodes.push(editor.make_vertex_complex(surface, place).unwrap().0);
    }
    let (mut edges, mut faces) = (Vec::new(), Vec::new());
    while edges.len() < free[1] || faces.len() < free[2] {
        let [a, b, c] = [(); 3].map(|()| editor.make_vertex_complex(surface, place).unwrap());
        let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| editor.make_edge(surface, p, q).unwrap().0);
        edges.extend(sides.map(|e| e.0));
        faces.push(editor.make_face(surface, sides).unwrap().0.0);
    }
    edges.truncate(free[1]);
    faces.truncate(free[2]);
    // Last given first.
    [nodes, edges, faces].map(|mut n| {
        n.reverse();
        n
    })
}

/// Splits of edges and faces, and triangulations, on every surface that they changed: kill_face for every face that is
/// cut, highest number first; split_wire for every node on an edge, in order of the nodes; make_vertex_complex for
/// those inside; make_edge for the cuts; make_face for the parts with old numbers, lowest first, then for the others.
/// Positions follow by move_nodes where they are not those of split_wire.
pub(crate) fn refine(editor: &mut Editor, after: &Body) -> Option<()> {
    let before = editor.body().clone();
    without_joints(editor, |editor, specs| {
        for (id, new) in after.surfaces() {
            if before.surface(id) != new {
                refine_surface(editor, id, before.surface(id), new, specs, &free_numbers(&before, id));
            }
        }
    })
}

fn refine_surface(
    editor: &mut Editor,
    id: SurfaceId,
    old: &Surface,
    new: &Surface,
    specs: &mut [JointSpec],
    free: &[Vec<u32>; 3],
) {
    let cut: Vec<FaceId> = old
        .live_faces()
        .filter(|f| {
            let i = f.index();
            old.faces()[i] != new.faces()[i] || old.face_edges()[i] != new.face_edges()[i]
        })
        .collect();
    for &face in cut.iter().rev() {
        editor.kill_face(id, face).unwrap();
    }
    let nodes =
        given(|v| old.is_node(NodeId(v)), |v| new.is_node(NodeId(v)), new.positions().len(), &free[0]);
    let edges = given(|e| old.is_edge(EdgeId(e)), |e| new.is_edge(EdgeId(e)), new.edges().len(), &free[1]);
    let faces = given(|f| old.is_face(FaceId(f)), |f| new.is_face(FaceId(f)), new.faces().len(), &free[2]);
    let mut edges = edges.into_iter();
    let mut on_edges = 0;
    for e in old.live_edges() {
        let [mut at, end] = old.edges()[e.index()];
        let mut part = e;
        // From part to part to the old end.
        while new.edges()[part.index()][1] != end && old.edges()[e.index()] != new.edges()[e.index()] {
            let node = new.edges()[part.index()][1];
            let [p, q, m] = [at, end, node].map(|v| new.positions()[v as usize]);
            let share = (p.distance(m) / p.distance(q)).clamp(0.01, 0.99);
            // The half where it is one.
            let share = if (p + q) * 0.5 == m { 0.5 } else { share };
            let (made, second) = editor.split_wire(id, part, share).unwrap();
            assert_eq!((made.0, Some(second.0)), (nodes[on_edges], edges.next()));
            assert_eq!(made.0, node);
            editor.move_nodes(id, &[(made, m)]).unwrap();
            for chain in specs.iter_mut().flat_map(|s| &mut s.chains).filter(|c| c.surface == id.index()) {
                insert_between(&mut chain.nodes, chain.closed, [at, end], node);
            }
            on_edges += 1;
            (at, part) = (node, second);
        }
    }
    for &v in &nodes[on_edges..] {
        let made = editor.make_vertex_complex(id, new.positions()[v as usize]).unwrap();
        assert_eq!(made.0, v);
    }
    for e in edges {
        let [a, b] = new.edges()[e as usize].map(NodeId);
        assert_eq!(editor.make_edge(id, a, b).unwrap().0, EdgeId(e));
    }
    for f in cut.into_iter().chain(faces.into_iter().map(FaceId)) {
        let sides = new.face_edges()[f.index()].map(EdgeId);
        assert_eq!(editor.make_face(id, sides).unwrap().0, f);
    }
}

fn insert_between(nodes: &mut Vec<u32>, closed: bool, [a, b]: [u32; 2], node: u32) {
    let pairs = if closed { nodes.len() } else { nodes.len().saturating_sub(1) };
    let joins = |i: usize| {
        let pair = [nodes[i], nodes[(i + 1) % nodes.len()]];
        pair == [a, b] || pair == [b, a]
    };
    if let Some(i) = (0..pairs).find(|&i| joins(i)) {
        nodes.insert(i + 1, node);
    }
}

/// Edge split, on a joint on the edge first and then on its partners: kill_face right and left; split_wire; make_edge from
/// the new node to the tips, left and right; make_face for the parts at the edge's first node, left and right, then for
/// those at its second. move_nodes where partners get the position of the first.
pub(crate) fn split(editor: &mut Editor, done: &EdgeSplit, at: f64, after: &Body) -> Option<()> {
    without_joints(editor, |editor, specs| {
        for part in std::iter::once(&done.edge).chain(&done.partners) {
            let id = part.surface;
            let s = editor.body().surface(id).clone();
            let ends = s.edges()[part.edge.index()];
            let faces = s.edge_faces()[part.edge.index()];
            for f in faces.into_iter().rev().filter(|f| *f != NONE) {
                editor.kill_face(id, FaceId(f)).unwrap();
            }
            let (node, second) = editor.split_wire(id, part.edge, at).unwrap();
            assert_eq!((node.0, second), (part.node, part.second));
            editor.move_nodes(id, &[(node, after.surface(id).positions()[node.index()])]).unwrap();
            let (mut first, mut rest) = (Vec::new(), Vec::new());
            for (slot, f) in faces.into_iter().enumerate().filter(|(_, f)| *f != NONE) {
                let sides = s.face_edges()[f as usize].map(EdgeId);
                let i = sides.iter().position(|e| *e == part.edge).unwrap();
                let [j, k] = [(i + 1) % 3, (i + 2) % 3];
                let tip = NodeId(s.faces()[f as usize][k]);
                let (cut, _) = editor.make_edge(id, node, tip).unwrap();
                let (mut near, mut far) = (sides, sides);
                far[i] = second;
                // On the left the face runs from the edge's first node to its second.
                let [keeps, gives] = if slot == 0 { [j, k] } else { [k, j] };
                near[keeps] = cut;
                far[gives] = cut;
                first.push((FaceId(f), near));
                rest.push(far);
            }
            for (face, sides) in first {
                assert_eq!(editor.make_face(id, sides).unwrap().0, face);
            }
            for sides in rest {
                editor.make_face(id, sides).unwrap();
            }
            for chain in specs.iter_mut().flat_map(|s| &mut s.chains).filter(|c| c.surface == id.index()) {
                insert_between(&mut chain.nodes, chain.closed, ends, node.0);
            }
        }
    })
}

/// Edge swap: kill_face right and left, kill_edge, make_edge from the right tip to the left one, make_face left and right.
pub(crate) fn swap(editor: &mut Editor, id: SurfaceId, edge: EdgeId, after: &Body) -> Option<()> {
    let [left, right] = editor.body().surface(id).edge_faces()[edge.index()].map(FaceId);
    without_joints(editor, |editor, _| {
        editor.kill_face(id, right).unwrap();
        editor.kill_face(id, left).unwrap();
        editor.kill_edge(id, edge).unwrap();
        let s = after.surface(id);
        let [from, to] = s.edges()[edge.index()].map(NodeId);
        assert_eq!(editor.make_edge(id, from, to).unwrap().0, edge);
        for face in [left, right] {
            let sides = s.face_edges()[face.index()].map(EdgeId);
            assert_eq!(editor.make_face(id, sides).unwrap().0, face);
        }
    })
}

/// Edge collapse, on a joint on the edge first and then on its partners: kill_face left and right, then all other faces
/// at the node that goes; kill_edge for the edge, the sides there, left and right, then all other edges there;
/// kill_vertex_complex; then, in mirror order, make_edge and make_face for the others to the node that stays; move_nodes
/// where that is to go elsewhere.
pub(crate) fn collapse(editor: &mut Editor, done: &EdgeCollapse, after: &Body) -> Option<()> {
    without_joints(editor, |editor, specs| {
        for part in std::iter::once(&done.edge).chain(&done.partners) {
            let id = part.surface;
            let s = editor.body().surface(id).clone();
            let gone: Vec<FaceId> = part.faces.iter().flatten().copied().collect();
            let sides: Vec<[EdgeId; 2]> = part.sides.iter().flatten().copied().collect();
            let fan: Vec<FaceId> = s
                .live_faces()
                .filter(|f| s.faces()[f.index()].contains(&part.removed.0) && !gone.contains(f))
                .collect();
            let spokes: Vec<EdgeId> = s
                .live_edges()
                .filter(|e| {
                    let own = *e == part.edge || sides.iter().any(|x| x[0] == *e);
                    s.edges()[e.index()].contains(&part.removed.0) && !own
                })
                .collect();
            for &face in gone.iter().chain(&fan) {
                editor.kill_face(id, face).unwrap();
            }
            for edge in std::iter::once(part.edge).chain(sides.iter().map(|x| x[0])).chain(spokes.clone()) {
                editor.kill_edge(id, edge).unwrap();
            }
            editor.kill_vertex_complex(id, part.removed).unwrap();
            let kept = |v: u32| NodeId(if v == part.removed.0 { part.kept.0 } else { v });
            for &edge in spokes.iter().rev() {
                let [a, b] = s.edges()[edge.index()].map(kept);
                assert_eq!(editor.make_edge(id, a, b).unwrap().0, edge);
            }
            let stands_for = |e: u32| sides.iter().find(|x| x[0].0 == e).map_or(EdgeId(e), |x| x[1]);
            for &face in fan.iter().rev() {
                let sides = s.face_edges()[face.index()].map(stands_for);
                assert_eq!(editor.make_face(id, sides).unwrap().0, face);
            }
            for chain in specs.iter_mut().flat_map(|s| &mut s.chains).filter(|c| c.surface == id.index()) {
                if chain.nodes.contains(&part.kept.0) && chain.nodes.len() > 1 {
                    chain.nodes.retain(|&v| v != part.removed.0);
                }
            }
        }
        // Nodes that moved, which joints make one again.
        for (id, s) in after.surfaces() {
            let moved: Vec<_> = s
                .live_nodes()
                .filter(|v| editor.body().surface(id).positions()[v.index()] != s.positions()[v.index()])
                .map(|v| (v, s.positions()[v.index()]))
                .collect();
            editor.move_nodes(id, &moved).unwrap();
        }
    })
}

/// An edge of the body by its place in the list of all; of the wires alone for every fourth place, where there are any.
pub(crate) fn some_edge(body: &Body, k: usize) -> Option<(SurfaceId, EdgeId)> {
    let bare = |(id, e): &(SurfaceId, EdgeId)| body.surface(*id).edge_faces()[e.index()] == [NONE; 2];
    let wires = body.surfaces().flat_map(|(id, s)| s.live_edges().map(move |e| (id, e))).filter(bare);
    let wires: Vec<_> = wires.collect();
    if k.is_multiple_of(4) && !wires.is_empty() {
        return Some(wires[k / 4 % wires.len()]);
    }
    let all: Vec<_> = body.surfaces().flat_map(|(id, s)| s.live_edges().map(move |e| (id, e))).collect();
    (!all.is_empty()).then(|| all[k % all.len()])
}

/// Whether an edge is inner, on the boundary or a wire.
pub(crate) fn kind_of_edge(s: &Surface, e: EdgeId) -> usize {
    2 - s.edge_faces()[e.index()].iter().filter(|f| **f != NONE).count()
}
