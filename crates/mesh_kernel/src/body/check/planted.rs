//! Defects of every kind, planted one at a time: the checker must find each.

use glam::{DVec2, DVec3};

use super::Defect;
use crate::body::surface::{NO_CHAIN, chain_slot};
use crate::body::{
    AttributeEdge, AttributeNode, AttributeNodeId, Body, ChainId, ChainSpec, DirectedEdge, EdgeId, FaceId,
    JointId, JointSpec, LoopId, NONE, NodeId, SurfaceId, SurfaceSpec,
};

/// Three flaps of two faces on one joint, split once, with an attribute line on the first.
fn sound() -> Body {
    let flap = |name: &str, out: DVec3| SurfaceSpec {
        name: name.into(),
        positions: vec![DVec3::ZERO, DVec3::Z, DVec3::Z + out, out],
        faces: vec![[0, 1, 2], [0, 2, 3]],
    };
    let flaps = [flap("a", DVec3::X), flap("b", DVec3::Y), flap("c", DVec3::NEG_X)];
    let chains = (0..3).map(|surface| ChainSpec { surface, nodes: vec![0, 1], closed: false }).collect();
    let mut body = Body::build(&flaps, &[JointSpec { name: None, chains }]).unwrap();
    let s = body.surface_mut(SurfaceId(0));
    let a = s.add_attribute_node(AttributeNode::OnEdge { edge: EdgeId(0), u: 0.2 }).unwrap();
    let b = s.add_attribute_node(AttributeNode::InFace { face: FaceId(0), areal: [0.1, 0.3, 0.6] }).unwrap();
    s.add_attribute_edge(AttributeEdge { name: None, nodes: vec![a, b] }).unwrap();
    body.split_all(None).unwrap();
    body
}

/// Plants a defect in a sound body and expects one of the given kind.
fn finds(code: &str, plant: impl FnOnce(&mut Body)) {
    let mut body = sound();
    assert_eq!(body.check(), []);
    plant(&mut body);
    let defects = body.check();
    assert!(defects.iter().any(|d| d.code() == code), "{code} not found in {defects:?}");
    for d in defects {
        assert!(!d.to_string().is_empty());
    }
}

#[test]
fn arrays_and_ids() {
    finds("array_length", |b| b.surfaces[0].planar = vec![DVec2::ZERO]);
    finds("array_length", |b| _ = b.surfaces[0].edge_chain.pop());
    finds("unknown_id", |b| b.surfaces[0].slots.nodes.release(0));
    finds("free_number", |b| b.surfaces[0].slots.edges.release(0));
    finds("free_number", |b| b.surfaces[0].slots.faces.release(99));
    finds("unknown_id", |b| b.surfaces[0].faces[0] = [NONE; 3]);
    finds("free_number", |b| (b.surfaces[0].faces[0], b.surfaces[0].face_edges[0]) = ([NONE; 3], [NONE; 3]));
    finds("free_number", |b| b.joint_slots.release(0));
    finds("unknown_id", |b| b.surfaces[0].edges[1][0] = 99);
    finds("unknown_id", |b| b.surfaces[0].edge_faces[1][0] = 99);
    finds("unknown_id", |b| b.surfaces[0].edge_chain[1] = 99);
    finds("unknown_id", |b| b.surfaces[0].faces[1][0] = 99);
    finds("unknown_id", |b| b.surfaces[0].face_edges[1][0] = 99);
    finds("unknown_id", |b| b.surfaces[0].chains[0].start = NodeId(99));
    finds("unknown_id", |b| b.surfaces[0].chains[0].edges[0] = DirectedEdge::new(EdgeId(99), false));
    finds("unknown_id", |b| b.surfaces[0].chains[0].on_loop = Some(LoopId(9)));
    finds("unknown_id", |b| b.surfaces[0].chains[0].joint = Some(JointId(9)));
    finds("unknown_id", |b| b.surfaces[0].loops[0].chains[0] = ChainId(9));
    finds("unknown_id", |b| b.surfaces[0].attribute_edges[0].nodes[0] = AttributeNodeId(99));
    finds("unknown_id", |b| {
        b.surfaces[0].attribute_nodes[0] = AttributeNode::OnEdge { edge: EdgeId(99), u: 0.0 };
    });
    finds("unknown_id", |b| b.joints[0].uses[0].surface = SurfaceId(9));
    finds("unknown_id", |b| b.joints[0].uses[0].chain = ChainId(9));
    finds("unknown_id", |b| b.joints[0].radial[0].use_index = 9);
}

#[test]
fn incidence_and_winding() {
    finds("edge_of_one_node", |b| b.surfaces[0].edges[3] = [1, 1]);
    finds("repeated_corner", |b| b.surfaces[0].faces[2][0] = b.surfaces[0].faces[2][1]);
    finds("side_nodes", |b| b.surfaces[0].faces[2].swap(0, 1));
    finds("side_nodes", |b| b.surfaces[0].face_edges[2].swap(0, 1));
    finds("face_not_on_edge", |b| b.surfaces[0].edge_faces[0] = [NONE; 2]);
    finds("edge_not_in_face", |b| b.surfaces[0].edge_faces[0][0] = 5);
    finds("orientation", |b| b.surfaces[0].edge_faces[0].swap(0, 1));
    finds("orientation", |b| {
        // A face turned round, with its own lists kept consistent.
        let s = &mut b.surfaces[0];
        s.faces[3].swap(0, 1);
        s.face_edges[3].swap(1, 2);
    });
    finds("duplicate_edge", |b| {
        let s = &mut b.surfaces[0];
        s.edges.push(s.edges[0]);
        s.edge_faces.push([NONE; 2]);
        s.edge_chain.push(NO_CHAIN);
    });
}

#[test]
fn chains_and_loops() {
    finds("chain_broken", |b| b.surfaces[0].chains[0].edges.swap(0, 1));
    finds("chain_broken", |b| b.surfaces[0].chains[0].start = NodeId(2));
    finds("edge_chain", |b| b.surfaces[0].edge_chain[0] = chain_slot(ChainId(1)));
    finds("edge_chain", |b| {
        let d = b.surfaces[0].chains[0].edges[0];
        b.surfaces[0].chains[1].edges.push(d);
    });
    finds("chain_place", |b| {
        let chain = &mut b.surfaces[0].chains[1];
        chain.on_loop = None;
    });
    finds("loop_open", |b| _ = b.surfaces[0].loops[0].chains.pop());
    finds("chain_loop", |b| b.surfaces[0].chains[1].on_loop = None);
    finds("boundary_not_in_loop", |b| {
        let s = &mut b.surfaces[0];
        s.loops.clear();
        s.chains.truncate(1);
        s.chains[0].on_loop = None;
        s.edge_chain.iter_mut().filter(|c| **c == chain_slot(ChainId(1))).for_each(|c| *c = NO_CHAIN);
    });
}

#[test]
fn joints() {
    finds("too_few_uses", |b| {
        b.joints[0].uses.truncate(1);
        b.joints[0].radial.truncate(1);
    });
    finds("joint_length", |b| _ = b.surfaces[1].chains[0].edges.pop());
    finds("chain_joint", |b| b.surfaces[1].chains[0].joint = None);
    finds("joint_direction", |b| b.joints[0].uses[1].reversed ^= true);
    finds("joint_apart", |b| b.surfaces[1].positions[0].x += 1e-9);
    finds("radial_sheets", |b| _ = b.joints[0].radial.pop());
    finds("radial_order", |b| {
        // The order stays complete and canonical, but goes round the other way.
        b.joints[0].uses.swap(1, 2);
    });
    finds("radial_order", |b| {
        // Geometry that moved on: the first flap folded over between the others.
        for v in 0..b.surfaces[0].positions.len() {
            let p = b.surfaces[0].positions[v];
            b.surfaces[0].positions[v] = DVec3::new(-0.5 * p.x, 0.5 * p.x, p.z);
        }
    });
}

#[test]
fn attributes() {
    finds("attribute_range", |b| {
        b.surfaces[0].attribute_nodes[0] = AttributeNode::OnEdge { edge: EdgeId(0), u: 1.5 };
    });
    finds("attribute_range", |b| {
        b.surfaces[0].attribute_nodes[1] = AttributeNode::InFace { face: FaceId(0), areal: [0.5, 0.5, 0.5] };
    });
    finds("attribute_apart", |b| {
        b.surfaces[0].attribute_nodes[0] = AttributeNode::InFace { face: FaceId(7), areal: [0.2, 0.2, 0.6] };
    });
}

#[test]
fn geometry() {
    finds("not_finite", |b| b.surfaces[0].positions[3].y = f64::NAN);
    finds("not_finite", |b| {
        b.surfaces[0].store_backup();
        b.surfaces[0].backup[2].x = f64::INFINITY;
    });
    finds("degenerate_face", |b| {
        let [p, q, _] = b.surfaces[2].faces[4];
        b.surfaces[2].positions[p as usize] = b.surfaces[2].positions[q as usize];
    });
    finds("edge_without_length", |b| {
        let s = &mut b.surfaces[0];
        s.positions.extend([DVec3::ONE; 2]);
        let n = s.positions.len() as u32;
        s.edges.push([n - 2, n - 1]);
        s.edge_faces.push([NONE; 2]);
        s.edge_chain.push(NO_CHAIN);
    });
}

#[test]
fn two_faces_on_the_same_nodes() {
    let triangle = |name: &str| SurfaceSpec {
        name: name.into(),
        positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
        faces: vec![[0, 1, 2]],
    };
    let chain = |surface| ChainSpec { surface, nodes: vec![0, 1, 2], closed: true };
    let joint = JointSpec { name: None, chains: vec![chain(0), chain(1)] };
    let body = Body::build(&[triangle("a"), triangle("b")], &[joint]).unwrap();
    let defects = body.check();
    assert!(matches!(defects[..], [Defect::DuplicateFace { .. }]), "{defects:?}");
}

#[test]
fn counts_that_disagree() {
    // Two tetrahedra on one triangle, every face a surface: three joints of three sheets. A wrong order at one of them
    // contradicts the other two and lets the voids run together.
    let positions =
        vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.3, 0.3, 1.0), DVec3::new(0.3, 0.3, -1.0)];
    let mut mesh = crate::TriMesh::new(positions, vec![[0, 1, 2]]);
    for top in [3, 4] {
        mesh.faces.extend([[0, 1, top], [1, 2, top], [2, 0, top]]);
    }
    mesh.groups = (0..7).map(|i| crate::Group { name: format!("f{i}"), faces: i..i + 1 }).collect();
    let mut body = Body::from_tri_mesh(&mesh).unwrap();
    assert_eq!(body.check(), []);
    assert_eq!(body.counts().cc, 2);
    let joint = body.joints.iter_mut().find(|j| j.radial.len() == 3).unwrap();
    // The sides stay with their uses.
    let sides: Vec<_> = joint.radial.iter().map(|s| s.side).collect();
    joint.uses.swap(1, 2);
    joint.radial[1].side = sides[2];
    joint.radial[2].side = sides[1];
    let codes: Vec<_> = body.check().iter().map(Defect::code).collect();
    assert_eq!(codes, ["radial_order", "identity"]);
}
