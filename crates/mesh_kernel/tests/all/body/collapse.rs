//! Edge collapse: pictures by hand, what is refused and why, and random sequences with splits and swaps.

use std::collections::{BTreeMap, BTreeSet};

use crate::body::support::{Random, add_attributes, add_wires, lattice, random_body};
use mesh_kernel::body::edit::{CollapseError, CollapseOptions, EdgeCollapse, Editor, Guard, Obstacle};
use mesh_kernel::body::{Body, ChainSpec, EdgeId, FaceId, JointSpec, NodeId, SurfaceId, SurfaceSpec};
use mesh_kernel::glam::DVec3;
use proptest::prelude::*;

const S: SurfaceId = SurfaceId(0);

fn spec(positions: Vec<DVec3>, faces: Vec<[u32; 3]>) -> SurfaceSpec {
    SurfaceSpec { name: "s".into(), positions, faces }
}

/// A flat grid of squares, nodes row by row.
fn grid(columns: u32, rows: u32, at: impl Fn(f64, f64) -> DVec3) -> SurfaceSpec {
    let w = columns + 1;
    let positions = (0..w * (rows + 1)).map(|k| at(f64::from(k % w), f64::from(k / w))).collect();
    let squares = (0..rows).flat_map(|j| (0..columns).map(move |i| j * w + i));
    spec(positions, squares.flat_map(|a| [[a, a + 1, a + w + 1], [a, a + w + 1, a + w]]).collect())
}

fn flat(columns: u32, rows: u32) -> SurfaceSpec {
    grid(columns, rows, |x, y| DVec3::new(x, y, 0.0))
}

/// Collapses the edge between two nodes into the first.
fn collapse(editor: &mut Editor, s: SurfaceId, keep: u32, gone: u32) -> Result<EdgeCollapse, CollapseError> {
    let edge = editor.body().surface(s).find_edge(NodeId(keep), NodeId(gone)).unwrap();
    let options = CollapseOptions { at: None, guard: Guard::NoTurn };
    let before = editor.body().clone();
    let done = editor.collapse_edge(s, edge, NodeId(keep), &options);
    match &done {
        Ok(_) => {
            assert_eq!(editor.body().check(), []);
            assert_eq!(shape(editor.body()), shape(&before));
            let after = editor.body().clone();
            assert!(editor.undo());
            assert_eq!(editor.body(), &before);
            assert!(editor.redo());
            assert_eq!(editor.body(), &after);
        }
        Err(e) => {
            assert!(!e.to_string().is_empty());
            assert_eq!(editor.body(), &before);
        }
    }
    done
}

fn obstacle(done: Result<EdgeCollapse, CollapseError>) -> Obstacle {
    match done {
        Err(CollapseError::Shape { obstacle, .. }) => obstacle,
        other => panic!("{other:?}"),
    }
}

#[test]
fn inside_a_disk_and_at_its_rim() {
    let mut editor = Editor::new(Body::build(&[flat(3, 3)], &[]).unwrap());
    let s = editor.body().surface(S);
    let edge = s.find_edge(NodeId(5), NodeId(6)).unwrap();
    let [left, right] = s.edge_faces()[edge.index()].map(FaceId);
    let done = collapse(&mut editor, S, 5, 6).unwrap().edge;
    let s = editor.body().surface(S);
    assert_eq!((done.kept, done.removed, done.faces), (NodeId(5), NodeId(6), [Some(left), Some(right)]));
    assert_eq!(s.live_counts(), [15, 30, 16]);
    assert!(!s.is_node(NodeId(6)) && !s.is_edge(edge) && !s.is_face(left) && !s.is_face(right));
    // A split takes the numbers again, last ones first.
    let split = editor.split_edge(S, done.sides[0].unwrap()[1], 0.5).unwrap();
    assert_eq!((split.edge.node, Some(split.edge.second)), (6, done.sides[1].map(|s| s[0])));
    assert!(editor.body().is_compact());
    assert!(editor.undo());
    // Along the rim; an ear; not across.
    collapse(&mut editor, S, 1, 2).unwrap();
    collapse(&mut editor, S, 0, 4).unwrap();
    // The whole editor can be taken back.
    while editor.undo() {}
    assert_eq!(editor.body(), &Body::build(&[flat(3, 3)], &[]).unwrap());
}

#[test]
fn what_would_change_the_shape_is_refused() {
    let strip = || Editor::new(Body::build(&[flat(3, 1)], &[]).unwrap());
    // Across a strip; the last face of one.
    assert_eq!(obstacle(collapse(&mut strip(), S, 1, 5)), Obstacle::Pinch);
    let ear = collapse(&mut strip(), S, 3, 7).unwrap().edge;
    assert!(matches!(ear.faces, [Some(_), None] | [None, Some(_)]));
    let one = spec(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]]);
    let mut one = Editor::new(Body::build(&[one], &[]).unwrap());
    assert!(matches!(obstacle(collapse(&mut one, S, 0, 1)), Obstacle::LastFace { .. }));
    let mut two = Editor::new(Body::build(&[flat(1, 1)], &[]).unwrap());
    assert_eq!(obstacle(collapse(&mut two, S, 0, 3)), Obstacle::Pinch);
    // A tetrahedron.
    let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let closed = spec(corners.clone(), vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]);
    let mut closed = Editor::new(Body::build(&[closed], &[]).unwrap());
    assert!(matches!(obstacle(collapse(&mut closed, S, 0, 1)), Obstacle::FacesMeet { .. }));
    // A hole of three edges, and a cycle of three about a tube.
    let ring = |r: f64, z: f64| {
        (0..3).map(move |k| DVec3::new(r * f64::from(k * 2).cos(), r * f64::from(k * 2).sin(), z))
    };
    let mut tube = spec(ring(1.0, 0.0).chain(ring(1.2, 1.0)).chain(ring(1.1, 2.0)).collect(), Vec::new());
    for row in [0, 3] {
        for k in 0..3 {
            let (a, b) = (row + k, row + (k + 1) % 3);
            tube.faces.extend([[a, b, b + 3], [a, b + 3, a + 3]]);
        }
    }
    let mut tube = Editor::new(Body::build(&[tube], &[]).unwrap());
    assert!(matches!(collapse(&mut tube, S, 0, 1), Err(CollapseError::LoopTooShort { edges: 3, .. })));
    assert!(matches!(obstacle(collapse(&mut tube, S, 3, 4)), Obstacle::ShortCycle { .. }));
    // A face that would turn over.
    let dart = vec![
        DVec3::new(-1.0, 0.0, 0.0),
        DVec3::new(0.0, -1.0, 0.0),
        DVec3::new(3.0, 0.0, 0.0),
        DVec3::new(0.0, 1.0, 0.0),
        DVec3::new(0.4, 0.0, 0.0),
        DVec3::new(0.5, 3.0, 0.0),
    ];
    let faces = vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [3, 2, 5]];
    let mut dart = Editor::new(Body::build(&[spec(dart, faces)], &[]).unwrap());
    assert!(matches!(collapse(&mut dart, S, 0, 3), Err(CollapseError::Turns { .. })));
    // Ids and parameters.
    let mut e = strip();
    let options = CollapseOptions::default();
    let none = e.collapse_edge(S, EdgeId(99), NodeId(0), &options);
    assert!(matches!(none, Err(CollapseError::NoEdge { .. })));
    let none = e.collapse_edge(SurfaceId(9), EdgeId(0), NodeId(0), &options);
    assert!(matches!(none, Err(CollapseError::NoEdge { .. })));
    let none = e.collapse_edge(S, EdgeId(0), NodeId(7), &options);
    assert!(matches!(none, Err(CollapseError::NotAnEnd { .. })));
    for at in [-0.1, 1.1, f64::NAN, f64::INFINITY] {
        let none = e.collapse_edge(S, EdgeId(0), NodeId(0), &CollapseOptions { at: Some(at), ..options });
        assert!(matches!(none, Err(CollapseError::Parameter(_))));
    }
}

#[test]
fn wires_and_bow_ties() {
    // Two squares that meet at node 3 only, with a wire from there.
    let at = |x: i32, y: i32| DVec3::new(f64::from(x), f64::from(y), 0.0);
    let nodes = vec![at(0, 0), at(1, 0), at(0, 1), at(1, 1), at(2, 1), at(2, 2), at(1, 2)];
    let faces = vec![[0, 1, 3], [0, 3, 2], [3, 4, 5], [3, 5, 6]];
    let mut body = Body::build(&[spec(nodes, faces)], &[]).unwrap();
    let [p, q] = [1.0, 2.0].map(|z| body.add_node(S, DVec3::new(1.0, 1.0, z)).unwrap());
    body.add_edge(S, NodeId(3), p).unwrap();
    body.add_edge(S, p, q).unwrap();
    let mut editor = Editor::new(body);
    // The wire's middle node goes; then it is one edge, of which both ends are ends.
    collapse(&mut editor, S, 3, p.0).unwrap();
    assert_eq!(obstacle(collapse(&mut editor, S, 3, q.0)), Obstacle::Branchings);
    assert!(editor.undo());
    collapse(&mut editor, S, q.0, p.0).unwrap();
    // The bow tie's node may be kept, and a sheet drawn into it.
    collapse(&mut editor, S, 3, 1).unwrap();
    // The other square's far corner cannot take it in: lines branch there, and none at 5.
    assert!(collapse(&mut editor, S, 5, 4).is_ok() || editor.body().check().is_empty());
}

/// Flaps of `rows` squares on one open joint along y.
fn flaps(count: usize, rows: u32) -> Body {
    let flap = |k: usize| {
        let a = k as f64 * 1.1;
        grid(2, rows, move |x, y| DVec3::new(x * a.cos(), y, x * a.sin()))
    };
    let specs: Vec<_> = (0..count).map(flap).collect();
    let nodes: Vec<u32> = (0..=rows).map(|r| 3 * r).collect();
    let chains =
        (0..count).map(|surface| ChainSpec { surface, nodes: nodes.clone(), closed: false }).collect();
    Body::build(&specs, &[JointSpec { name: None, chains }]).unwrap()
}

#[test]
fn all_partners_on_a_joint_collapse() {
    for sheets in 2..5 {
        let mut editor = Editor::new(flaps(sheets, 3));
        let done = collapse(&mut editor, S, 3, 6).unwrap();
        assert_eq!((done.partners.len(), editor.undo_len()), (sheets - 1, 1));
        assert_eq!(editor.body().joint_len(mesh_kernel::body::JointId(0)), 2);
        // Moved, all copies go along.
        assert!(editor.undo());
        let edge = editor.body().surface(S).find_edge(NodeId(3), NodeId(6)).unwrap();
        let options = CollapseOptions { at: Some(0.25), guard: Guard::NoTurn };
        editor.collapse_edge(S, edge, NodeId(3), &options).unwrap();
        assert_eq!(editor.body().check(), []);
        // A node on the joint cannot go where the joint does not: keep it.
        let held = collapse(&mut editor, S, 4, 3);
        assert!(
            matches!(held, Err(CollapseError::HeldByJoints { ref joints, .. }) if joints.len() == 1),
            "{held:?}"
        );
        collapse(&mut editor, S, 3, 4).unwrap();
        // Down to one edge, which stays.
        let left = editor.body().surface(S).live_edges();
        let joint: Vec<EdgeId> = left.filter(|&e| !editor.body().partners(S, e).is_empty()).collect();
        assert_eq!(joint.len(), 2);
        let mut last = None;
        for e in joint {
            for keep in editor.body().surface(S).edges()[e.index()] {
                if keep != mesh_kernel::body::NONE {
                    last = Some(editor.collapse_edge(S, e, NodeId(keep), &CollapseOptions::default()));
                }
            }
        }
        assert!(
            matches!(
                last,
                Some(Err(CollapseError::JointTooShort { edges: 1, .. } | CollapseError::NoEdge { .. }))
            ),
            "{last:?}"
        );
        assert_eq!(editor.body().check(), []);
    }
}

#[test]
fn a_closed_joint_keeps_three_edges() {
    // Two cones on one ring.
    let ring: Vec<DVec3> =
        (0..3).map(|k| DVec3::new(f64::from(k * 2).cos(), f64::from(k * 2).sin(), 0.0)).collect();
    let cone = |z: f64| {
        let mut positions = ring.clone();
        positions.push(DVec3::Z * z);
        spec(positions, (0..3).map(|k| [k, (k + 1) % 3, 3]).collect())
    };
    let chain = |surface| ChainSpec { surface, nodes: vec![0, 1, 2], closed: true };
    let joint = JointSpec { name: None, chains: vec![chain(0), chain(1)] };
    let body = Body::build(&[cone(1.0), cone(-1.0)], &[joint]).unwrap();
    let mut editor = Editor::new(body);
    assert!(matches!(collapse(&mut editor, S, 0, 1), Err(CollapseError::JointTooShort { edges: 3, .. })));
}

#[test]
fn a_slit_shortens_from_its_tip() {
    // A slit from node 12 over 13, 14 to 15 of a grid, its upper side with copies of 13 and 14.
    let mut sheet = flat(4, 4);
    for (old, new) in [(11, 25), (12, 26)] {
        sheet.positions.push(sheet.positions[old as usize]);
        let above = sheet.positions[old as usize].y;
        for f in 0..sheet.faces.len() {
            let y: f64 = sheet.faces[f].iter().map(|&v| sheet.positions[v as usize].y).sum::<f64>() / 3.0;
            if y > above {
                sheet.faces[f].iter_mut().filter(|v| **v == old).for_each(|v| *v = new);
            }
        }
    }
    let open = |nodes: Vec<u32>| ChainSpec { surface: 0, nodes, closed: false };
    let joint =
        JointSpec { name: None, chains: vec![open(vec![10, 11, 12, 13]), open(vec![10, 25, 26, 13])] };
    let body = Body::build(&[sheet], &[joint]).unwrap();
    assert_eq!(body.check(), []);
    let mut editor = Editor::new(body);
    // Into the tip; the tip itself cannot go into two nodes.
    let refused = collapse(&mut editor, S, 12, 13);
    assert!(matches!(refused, Err(CollapseError::HeldByJoints { .. })), "{refused:?}");
    let done = collapse(&mut editor, S, 13, 12).unwrap();
    assert_eq!(done.partners.len(), 1);
    assert_eq!(editor.body().joint_len(mesh_kernel::body::JointId(0)), 2);
}

/// Ranks over GF(2): components, cycles and voids of a complex of faces and edges, and of the graph of its edges in
/// `lines`.
fn invariants(faces: &BTreeSet<[u32; 3]>, lines: &BTreeSet<[u32; 2]>) -> [i64; 5] {
    let mut edges: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    for &[a, b, c] in faces {
        for e in [[a, b], [b, c], [a, c]] {
            let next = edges.len();
            edges.entry(e).or_insert(next);
        }
    }
    let components = |edges: &mut dyn Iterator<Item = [u32; 2]>| {
        let mut set: BTreeMap<u32, u32> = BTreeMap::new();
        fn root(set: &BTreeMap<u32, u32>, mut v: u32) -> u32 {
            while set[&v] != v {
                v = set[&v];
            }
            v
        }
        let mut rank = 0;
        for [a, b] in edges {
            set.entry(a).or_insert(a);
            set.entry(b).or_insert(b);
            let (a, b) = (root(&set, a), root(&set, b));
            if a != b {
                set.insert(b, a);
                rank += 1;
            }
        }
        (set.len() as i64, rank)
    };
    let (v, rank1) = components(&mut edges.keys().copied());
    // Elimination of the faces' boundaries.
    let mut pivots: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    let mut rank2 = 0;
    for &[a, b, c] in faces {
        let mut row: BTreeSet<usize> = [[a, b], [b, c], [a, c]].iter().map(|e| edges[e]).collect();
        while let Some(&first) = row.first() {
            let Some(other) = pivots.get(&first) else {
                pivots.insert(first, row);
                rank2 += 1;
                break;
            };
            row = row.symmetric_difference(other).copied().collect();
        }
    }
    let (lv, lrank) = components(&mut lines.iter().copied());
    let e = edges.len() as i64;
    [v - rank1, e - rank1 - rank2, faces.len() as i64 - rank2, lv - lrank, lines.len() as i64 - lrank]
}

/// Faces by welded nodes; edges with another number than two faces or on joints.
fn soup(body: &Body, fold: Option<[u32; 2]>) -> (BTreeSet<[u32; 3]>, BTreeSet<[u32; 2]>) {
    let weld = body.weld();
    let name = |s: SurfaceId, v: u32| {
        let w = weld.node(s, v);
        fold.map_or(w, |[from, to]| if w == from { to } else { w })
    };
    let sorted = |mut e: [u32; 2]| {
        e.sort_unstable();
        e
    };
    let (mut faces, mut lines) = (BTreeSet::new(), BTreeSet::new());
    let mut counts: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    for (id, s) in body.surfaces() {
        for f in s.live_faces() {
            let mut n = s.faces()[f.index()].map(|v| name(id, v));
            n.sort_unstable();
            if n[0] != n[1] && n[1] != n[2] {
                faces.insert(n);
            }
        }
        for e in s.live_edges() {
            let [a, b] = s.edges()[e.index()];
            let unfolded = sorted([weld.node(id, a), weld.node(id, b)]);
            let count = s.edge_faces()[e.index()].iter().filter(|f| **f != mesh_kernel::body::NONE).count();
            *counts.entry(unfolded).or_default() += count as u32;
            if !body.partners(id, e).is_empty() {
                *counts.entry(unfolded).or_default() += 1000;
            }
        }
    }
    for (e, count) in counts {
        let e = sorted(e.map(|w| fold.map_or(w, |[from, to]| if w == from { to } else { w })));
        if count != 2 && e[0] != e[1] {
            lines.insert(e);
        }
    }
    (faces, lines)
}

/// The condition is exact on small complexes: what is done leaves the ranks of the complex and of the lines on which it is
/// not a sheet; what is refused for its shape, contracted by hand, changes one or folds faces onto each other.
#[test]
fn the_link_condition_is_exact() {
    let (mut done, mut refused) = (0, BTreeMap::<&str, u32>::new());
    for seed in 0..60 {
        let body =
            Body::from_tri_mesh(&lattice(seed, [2, 1, 1 + seed as usize % 2], 0.6, 1 + seed as usize % 3))
                .unwrap();
        let weld = body.weld();
        let (faces, lines) = soup(&body, None);
        let before = invariants(&faces, &lines);
        for id in body.surface_ids() {
            for e in body.surface(id).live_edges() {
                for keep in body.surface(id).edges()[e.index()] {
                    let [a, b] = body.surface(id).edges()[e.index()];
                    let fold = [weld.node(id, a ^ b ^ keep), weld.node(id, keep)];
                    let (folded, folded_lines) = soup(&body, Some(fold));
                    let after = invariants(&folded, &folded_lines);
                    let mut editor = Editor::new(body.clone());
                    match editor.collapse_edge(id, e, NodeId(keep), &CollapseOptions::default()) {
                        Ok(_) => {
                            done += 1;
                            assert_eq!(before, after, "seed {seed} surface {id} edge {e}");
                            assert_eq!(shape(editor.body()), shape(&body));
                            let (own, own_lines) = soup(editor.body(), None);
                            assert_eq!(invariants(&own, &own_lines), after);
                            assert_eq!(own.len(), folded.len());
                        }
                        Err(CollapseError::Shape { obstacle, .. }) => {
                            // A flap of one face that goes and places where sheets touch no rank tells.
                            if matches!(obstacle, Obstacle::ShortCycle { .. } | Obstacle::FacesMeet { .. }) {
                                let gone =
                                    faces.iter().filter(|f| fold.iter().all(|v| f.contains(v))).count();
                                let folds = folded.len() + gone != faces.len();
                                assert!(folds || before != after, "seed {seed} {id} edge {e} {obstacle:?}");
                            }
                            let code = match obstacle {
                                Obstacle::ShortCycle { .. } => "short cycle",
                                Obstacle::FacesMeet { .. } => "faces meet",
                                Obstacle::LastFace { .. } => "last face",
                                Obstacle::Pinch => "pinch",
                                Obstacle::Branchings => "branchings",
                            };
                            *refused.entry(code).or_default() += 1;
                        }
                        Err(_) => *refused.entry("joints").or_default() += 1,
                    }
                }
            }
        }
    }
    assert!(done > 100, "{done} {refused:?}");
}

/// Defects that an operator without a guard may bring about in the geometry; never in the topology.
fn topology_sound(body: &Body) {
    let geometric = ["degenerate_face", "radial_order", "edge_without_length"];
    let defects: Vec<_> = body.check().into_iter().filter(|d| !geometric.contains(&d.code())).collect();
    assert_eq!(defects, []);
}

fn shape(body: &Body) -> [i64; 3] {
    let counts = body.counts();
    [counts.c, counts.ch, counts.cc]
}

/// One random operator; whether it was done.
fn step(editor: &mut Editor, random: &mut Random, guard: Guard) -> bool {
    let surface = SurfaceId(random.below(editor.body().surfaces().len()) as u32);
    let s = editor.body().surface(surface);
    if s.live_counts()[1] == 0 {
        return false;
    }
    let edges = s.edges().len();
    let edge = (0..).map(|_| EdgeId(random.below(edges) as u32)).find(|&e| s.is_edge(e)).unwrap();
    let end = s.edges()[edge.index()][random.below(2)];
    match random.below(8) {
        0 => editor.split_edge(surface, edge, 0.25 + 0.5 * random.unit()).is_ok(),
        1 | 2 => editor.swap_edge(surface, edge, guard).is_ok(),
        _ => {
            let at = [None, Some(0.5), Some(random.unit())][random.below(3)];
            editor.collapse_edge(surface, edge, NodeId(end), &CollapseOptions { at, guard }).is_ok()
        }
    }
}

fn run(kind: u8, seed: u64, steps: usize, guard: Guard, attributes: bool) {
    let mut random = Random(seed ^ 0xc011);
    let mut body = random_body(kind, seed);
    if body.surfaces().len() == 0 {
        return;
    }
    if attributes {
        add_attributes(&mut body, &mut random);
    }
    if seed.is_multiple_of(2) {
        add_wires(&mut body, &mut random);
    }
    if seed.is_multiple_of(5) {
        body.surface_ids().for_each(|s| body.surface_mut(s).store_backup());
    }
    if random.below(2) == 0 && body.face_count() < 100 {
        body.split_all(None).unwrap();
    }
    let mut editor = Editor::new(body);
    let mut states = vec![editor.body().clone()];
    let before = shape(editor.body());
    for _ in 0..steps {
        let done = step(&mut editor, &mut random, guard);
        assert_eq!(editor.undo_len(), states.len() - usize::from(!done));
        if !done {
            assert_eq!(editor.body(), states.last().unwrap());
            continue;
        }
        topology_sound(editor.body());
        assert_eq!(shape(editor.body()), before);
        states.push(editor.body().clone());
    }
    for state in states.iter().rev().skip(1) {
        assert!(editor.undo());
        assert_eq!(editor.body(), state);
    }
    for state in &states[1..] {
        assert!(editor.redo());
        assert_eq!(editor.body(), state);
    }
    let mut body = editor.into_body();
    body.compact();
    topology_sound(&body);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn what_is_done_can_be_undone(kind in 0u8..5, seed: u64, steps in 1usize..60, guard: bool) {
        run(kind, seed, steps, if guard { Guard::NoTurn } else { Guard::None }, seed.is_multiple_of(3));
    }
}

/// The same on fixed bodies; for longer: `TOILE_CASES` bodies, from `TOILE_SEED` on.
#[test]
fn many_random_bodies() {
    let number = |name: &str, or: u64| std::env::var(name).map_or(or, |v| v.parse().unwrap());
    let (first, cases) = (number("TOILE_SEED", 0), number("TOILE_CASES", 200));
    for seed in first..first + cases {
        let mut random = Random(seed);
        let (kind, steps) = (random.below(5) as u8, 1 + random.below(60));
        let guard = [Guard::None, Guard::NoTurn][random.below(2)];
        let ran = std::panic::catch_unwind(|| run(kind, seed, steps, guard, seed.is_multiple_of(3)));
        assert!(ran.is_ok(), "seed {seed}");
    }
}
