//! Building bodies: loops, chains, joints, radial order, welding, splitting.

use mesh_kernel::body::edit::EulerError;
use mesh_kernel::body::{
    Body, BuildError, ChainSpec, DirectedEdge, FaceId, JointId, JointSpec, NodeId, Side, SurfaceId,
    SurfaceSpec,
};
use mesh_kernel::glam::DVec3;
use mesh_kernel::{Group, TriMesh};

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// A square flap on the edge (0,0,0)–(0,0,1), its other side at `out`.
fn flap(name: &str, out: DVec3) -> SurfaceSpec {
    SurfaceSpec {
        name: name.into(),
        positions: vec![DVec3::ZERO, DVec3::Z, DVec3::Z + out, out],
        faces: vec![[0, 1, 2], [0, 2, 3]],
    }
}

fn chain(surface: usize, nodes: &[u32]) -> ChainSpec {
    ChainSpec { surface, nodes: nodes.to_vec(), closed: false }
}

fn joint(chains: Vec<ChainSpec>) -> JointSpec {
    JointSpec { name: None, chains }
}

#[test]
fn sheets_stand_clockwise_for_one_who_looks_along_the_joint() {
    // About +z the right hand turns x → y → -x → -y.
    let flaps = [v(1., 0., 0.), v(0., -1., 0.), v(-1., 0., 0.), v(0., 1., 0.)].map(|o| flap("f", o));
    let chains = (0..4).map(|s| chain(s, &[0, 1])).collect();
    let body = Body::build(&flaps, &[joint(chains)]).unwrap();
    let j = body.joint(JointId(0));
    let order: Vec<u32> = j.uses().iter().map(|u| u.surface.0).collect();
    assert_eq!(order, [0, 3, 2, 1]);
    assert!(j.radial().iter().all(|s| s.side == Side::Left));
    // The joint's direction turned round turns the order round.
    let chains = (0..4).map(|s| chain(s, &[1, 0])).collect();
    let body = Body::build(&flaps, &[joint(chains)]).unwrap();
    let order: Vec<u32> = body.joint(JointId(0)).uses().iter().map(|u| u.surface.0).collect();
    assert_eq!(order, [0, 1, 2, 3]);
    assert!(body.joint(JointId(0)).uses().iter().all(|u| u.reversed));
    assert_eq!(body.joint_nodes(JointId(0), 0), [1, 0]);
}

#[test]
fn an_inner_chain_gives_two_sheets_with_others_between_them() {
    // A plane with the edge inside, and two flaps above and below.
    let plane = SurfaceSpec {
        name: "plane".into(),
        positions: vec![DVec3::ZERO, DVec3::Z, DVec3::X, DVec3::NEG_X],
        faces: vec![[0, 1, 2], [1, 0, 3]],
    };
    let specs = [plane, flap("up", DVec3::Y), flap("down", DVec3::NEG_Y)];
    let chains = (0..3).map(|s| chain(s, &[0, 1])).collect();
    let body = Body::build(&specs, &[joint(chains)]).unwrap();
    let j = body.joint(JointId(0));
    let radial: Vec<(u32, Side)> =
        j.radial().iter().map(|s| (j.uses()[s.use_index as usize].surface.0, s.side)).collect();
    assert_eq!(radial, [(0, Side::Left), (1, Side::Left), (0, Side::Right), (2, Side::Left)]);
    let plane = body.surface(SurfaceId(0));
    assert_eq!(plane.loops().len(), 1);
    assert_eq!(plane.chains().len(), 2);
    assert!(plane.chains()[0].on_loop().is_none());
}

/// An n × m grid of squares, x along its columns, y along its rows.
fn grid(name: &str, n: usize, m: usize, at: impl Fn(f64, f64) -> DVec3) -> SurfaceSpec {
    let mut spec = SurfaceSpec { name: name.into(), ..SurfaceSpec::default() };
    for j in 0..=m {
        for i in 0..=n {
            spec.positions.push(at(i as f64 / n as f64, j as f64 / m as f64));
        }
    }
    let id = |i: usize, j: usize| (j * (n + 1) + i) as u32;
    for j in 0..m {
        for i in 0..n {
            spec.faces.push([id(i, j), id(i + 1, j), id(i + 1, j + 1)]);
            spec.faces.push([id(i, j), id(i + 1, j + 1), id(i, j + 1)]);
        }
    }
    spec
}

#[test]
fn a_rolled_strip_meets_itself_and_carries_a_closed_ring() {
    let (n, m) = (12, 3);
    let turn = |x: f64| {
        let a = std::f64::consts::TAU * if x == 1.0 { 0.0 } else { x };
        v(a.cos(), 0.0, a.sin()) * 100.0
    };
    let tube = grid("tube", n, m, |x, y| turn(x) + v(0.0, 200.0 * y, 0.0));
    // A closed collar on the tube's lower rim: 12 nodes round, doubled outwards.
    let mut collar = SurfaceSpec { name: "collar".into(), ..SurfaceSpec::default() };
    for k in 0..2 * n {
        let p = turn((k % n) as f64 / n as f64);
        collar.positions.push(p * if k < n { 1.0 } else { 2.0 });
    }
    for k in 0..n as u32 {
        let (a, b) = (k, (k + 1) % n as u32);
        let (c, d) = (a + n as u32, b + n as u32);
        collar.faces.push([a, b, d]);
        collar.faces.push([a, d, c]);
    }
    let column = |i: usize| -> Vec<u32> { (0..=m).map(|j| (j * (n + 1) + i) as u32).collect() };
    let rim: Vec<u32> = (0..=n as u32).collect();
    let side = joint(vec![chain(0, &column(0)), chain(0, &column(n))]);
    let ring =
        joint(vec![chain(0, &rim), ChainSpec { surface: 1, nodes: (0..n as u32).collect(), closed: true }]);
    let mut body = Body::build(&[tube, collar], &[side, ring]).unwrap();
    for level in 0..3 {
        let nodes = body.weld().count;
        let len = n << level;
        assert_eq!(nodes, len * ((m << level) + 1) + len * (1 << level));
        assert!(!body.joint_is_closed(JointId(1)));
        for j in body.joint_ids() {
            for i in 0..body.joint(j).uses().len() {
                assert_eq!(body.joint_nodes(j, i).len(), body.joint_len(j) + 1);
            }
        }
        let mesh = body.to_tri_mesh();
        assert_eq!(mesh.groups.len(), 2);
        assert_eq!(mesh.positions.len(), nodes);
        body.split_all(None).unwrap();
    }
}

#[test]
fn split_numbers_are_as_documented() {
    let mut body = Body::build(&[grid("g", 2, 2, |x, y| v(x, y, 0.0))], &[]).unwrap();
    let old = body.surface(SurfaceId(0)).clone();
    let map = body.split_all(None).unwrap();
    let (s, split) = (body.surface(SurfaceId(0)), map.surface(SurfaceId(0)));
    assert_eq!(&s.positions()[..old.positions().len()], old.positions());
    for (e, &[a, b]) in old.edges().iter().enumerate() {
        let m = split.old_nodes + e as u32;
        assert_eq!(s.edges()[2 * e], [a, m]);
        assert_eq!(s.edges()[2 * e + 1], [m, b]);
    }
    for (f, corners) in old.faces().iter().enumerate() {
        for (i, corner) in corners.iter().enumerate() {
            assert_eq!(s.faces()[4 * f + i][i], *corner);
        }
    }
    // Incidence as a fresh build would make it.
    for (f, sides) in s.face_edges().iter().enumerate() {
        for (i, &e) in sides.iter().enumerate() {
            let (a, b) = (s.faces()[f][i], s.faces()[f][(i + 1) % 3]);
            let forward = s.edges()[e as usize] == [a, b];
            assert!(forward || s.edges()[e as usize] == [b, a]);
            assert_eq!(s.edge_faces()[e as usize][usize::from(!forward)], f as u32);
        }
    }
    let loops = s.loop_nodes(mesh_kernel::body::LoopId(0));
    assert_eq!(loops.len(), 16);
}

#[test]
fn a_mesh_of_one_group_with_a_fin_becomes_a_body_and_comes_back() {
    // One triangle of fin on one edge inside a plane, all in one group: a slit of one edge.
    let mut mesh = TriMesh::default();
    let plane = grid("p", 4, 4, |x, y| v(x, y, 0.0));
    mesh.positions = plane.positions;
    mesh.faces = plane.faces;
    mesh.positions.push(v(0.5, 0.5, 1.0));
    mesh.faces.push([11, 12, 25]);
    let mut body = Body::from_tri_mesh(&mesh).unwrap();
    assert_eq!(body.joint_count(), 1);
    assert_eq!(body.joint(JointId(0)).uses().len(), 3);
    let back = body.to_tri_mesh();
    assert_eq!(back.positions.len(), mesh.positions.len());
    assert_eq!(back.faces.len(), mesh.faces.len());
    body.split_all(None).unwrap();
    assert_eq!(body.to_tri_mesh().faces.len(), 4 * mesh.faces.len());
    assert_eq!(body.to_tri_mesh().positions.len(), mesh.positions.len() + 56 + 2);
}

#[test]
fn surfaces_that_touch_at_a_node_stay_together() {
    let positions = vec![v(0., 0., 0.), v(1., 0., 0.), v(0., 1., 0.), v(-1., 0., 0.), v(0., -1., 0.)];
    let mut mesh = TriMesh::new(positions, vec![[0, 1, 2], [0, 3, 4]]);
    // One surface with a bow tie.
    let body = Body::from_tri_mesh(&mesh).unwrap();
    assert_eq!((body.joint_count(), body.surface(SurfaceId(0)).positions().len()), (0, 5));
    // Two surfaces, held at a point.
    mesh.groups = vec![Group { name: "a".into(), faces: 0..1 }, Group { name: "b".into(), faces: 1..2 }];
    let body = Body::from_tri_mesh(&mesh).unwrap();
    assert_eq!((body.joint_count(), body.weld().count), (1, 5));
    assert_eq!(body.joint_len(JointId(0)), 0);
}

#[test]
fn faces_wound_differently_in_one_group_are_joined_not_refused() {
    let positions = vec![v(0., 0., 0.), v(1., 0., 0.), v(0., 1., 0.), v(0., -1., 0.)];
    let mesh = TriMesh::new(positions, vec![[0, 1, 2], [0, 1, 3]]);
    let body = Body::from_tri_mesh(&mesh).unwrap();
    assert_eq!(body.joint(JointId(0)).uses().len(), 2);
    assert_eq!(body.to_tri_mesh().positions.len(), 4);
}

#[test]
fn what_cannot_be_built_is_refused_with_the_reason() {
    let ok = flap("a", DVec3::X);
    let build = |f: &dyn Fn(&mut SurfaceSpec)| {
        let mut spec = ok.clone();
        f(&mut spec);
        Body::build(&[spec], &[]).unwrap_err()
    };
    assert!(matches!(build(&|s| s.faces[0][1] = 9), BuildError::NodeOutOfRange { node: 9, .. }));
    assert!(matches!(build(&|s| s.faces[0][1] = 0), BuildError::RepeatedNode { face: 0, .. }));
    assert!(matches!(build(&|s| s.positions[2].y = f64::NAN), BuildError::NotFinite { node: 2, .. }));
    assert!(matches!(build(&|s| s.faces[1].swap(0, 1)), BuildError::EdgeConflict { faces: [0, 1], .. }));
    let two = [ok.clone(), flap("b", DVec3::Y)];
    let join = |chains| Body::build(&two, &[joint(chains)]).unwrap_err();
    assert!(matches!(join(vec![chain(0, &[0, 1])]), BuildError::TooFew { .. }));
    assert!(matches!(
        join(vec![chain(0, &[0, 1]), chain(5, &[0, 1])]),
        BuildError::NoSurface { surface: 5, .. }
    ));
    assert!(matches!(
        join(vec![chain(0, &[1, 3]), chain(1, &[0, 1])]),
        BuildError::NoEdge { nodes: [1, 3], .. }
    ));
    assert!(matches!(join(vec![chain(0, &[0, 1, 2]), chain(1, &[0, 1])]), BuildError::Lengths { .. }));
    assert!(matches!(
        join(vec![chain(0, &[0, 1]), chain(1, &[1, 0])]),
        BuildError::NodesApart { distance: 1.0, .. }
    ));
    assert!(matches!(join(vec![chain(0, &[0, 1]), chain(0, &[0, 1])]), BuildError::EdgeTaken { .. }));
    let mixed = join(vec![chain(0, &[1, 0, 2]), chain(1, &[1, 0, 2])]);
    assert!(matches!(mixed, BuildError::MixedChain { node: 0, .. }), "{mixed}");
}

#[test]
fn boundary_chains_run_with_the_surface_on_their_left() {
    let body = Body::build(&[flap("a", DVec3::X)], &[]).unwrap();
    let s = body.surface(SurfaceId(0));
    assert_eq!(s.loop_nodes(mesh_kernel::body::LoopId(0)), [0, 1, 2, 3]);
    let e = s.find_edge(NodeId(1), NodeId(0)).unwrap();
    assert_eq!(s.ends(DirectedEdge::new(e, false)), [NodeId(0), NodeId(1)]);
}

#[test]
fn a_body_built_up_step_by_step_is_sound_at_every_step() {
    let mut body = Body::default();
    let sound = |body: &Body, shape: [i64; 3]| {
        assert_eq!(body.check(), []);
        let counts = body.counts();
        assert_eq!([counts.c, counts.ch, counts.cc], shape, "{counts}");
    };
    sound(&body, [0, 0, 0]);
    let a = body.add_surface("a");
    let nodes: Vec<NodeId> = [DVec3::ZERO, DVec3::Z, DVec3::X, DVec3::X + DVec3::Z, DVec3::X * 2.0]
        .map(|p| body.add_node(a, p).unwrap())
        .to_vec();
    sound(&body, [5, 0, 0]);
    // A wire frame of a square with a diagonal, and a tail.
    for (p, q) in [(0, 1), (1, 3), (3, 2), (2, 0), (0, 3), (2, 4)] {
        body.add_edge(a, nodes[p], nodes[q]).unwrap();
    }
    sound(&body, [1, 2, 0]);
    assert!(matches!(body.add_edge(a, nodes[1], nodes[0]), Err(EulerError::EdgeExists { .. })));
    body.add_face(a, [nodes[0], nodes[1], nodes[3]]).unwrap();
    sound(&body, [1, 1, 0]);
    assert!(matches!(body.add_face(a, [nodes[0], nodes[1], nodes[2]]), Err(EulerError::SideTaken { .. })));
    body.add_face(a, [nodes[0], nodes[3], nodes[2]]).unwrap();
    sound(&body, [1, 0, 0]);
    assert_eq!(body.surface(a).loops().len(), 1);
    // Faces that meet at a node only.
    let far = [DVec3::X * 3.0, DVec3::X * 3.0 + DVec3::Z].map(|p| body.add_node(a, p).unwrap());
    body.add_face(a, [nodes[4], far[0], far[1]]).unwrap();
    sound(&body, [1, 0, 0]);
    assert_eq!(body.surface(a).loops().len(), 2);
    // Joints: a boundary edge with a wire of another surface, then a flap.
    let b = body.add_surface("b");
    for p in [DVec3::ZERO, DVec3::Z, DVec3::Y] {
        body.add_node(b, p).unwrap();
    }
    body.add_edge(b, NodeId(0), NodeId(1)).unwrap();
    let before = body.clone();
    let wrong = JointSpec { name: None, chains: vec![chain(0, &[0, 1]), chain(1, &[1, 0])] };
    assert!(matches!(body.add_joint(&wrong), Err(BuildError::NodesApart { .. })));
    assert_eq!(body, before);
    let mut with_face = body.clone();
    with_face.add_face(b, [NodeId(1), NodeId(0), NodeId(2)]).unwrap();
    let right = JointSpec { name: None, chains: vec![chain(0, &[0, 1]), chain(1, &[0, 1])] };
    for (mut body, sheets) in [(body, 1), (with_face, 2)] {
        body.add_joint(&right).unwrap();
        sound(&body, [if sheets == 1 { 2 } else { 1 }, 0, 0]);
        assert_eq!(body.joint(JointId(0)).radial().len(), sheets);
        if sheets == 1 {
            let refused = body.add_face(b, [NodeId(1), NodeId(0), NodeId(2)]);
            assert!(matches!(refused, Err(EulerError::EdgeOnJoint { .. })));
        }
        let face = FaceId(body.surface(a).faces().len() as u32 - 1);
        body.split_face(a, face).unwrap();
        body.split_face(a, FaceId(0)).unwrap();
        body.split_all(None).unwrap();
        sound(&body, [if sheets == 1 { 2 } else { 1 }, 0, 0]);
    }
}

#[test]
fn a_joint_added_is_a_joint_built() {
    let flaps = [DVec3::X, DVec3::Y, DVec3::NEG_X].map(|o| flap("f", o));
    let spec = joint((0..3).map(|s| chain(s, &[0, 1])).collect());
    let mut body = Body::build(&flaps, &[]).unwrap();
    body.add_joint(&spec).unwrap();
    assert_eq!(body, Body::build(&flaps, &[spec]).unwrap());
}
