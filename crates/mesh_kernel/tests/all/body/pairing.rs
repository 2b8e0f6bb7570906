//! 'Touch and join' or 'touch but miss' (Stroud & Nagy §6.1): what is reported, what comes of each choice.

use crate::body::pairing_support::{
    Solids, all_resolved, counts, kept, near, only_joint, resolve_edge, sound, volumes,
};
use crate::body::support::Random;
use mesh_kernel::body::edit::Editor;
use mesh_kernel::body::{
    AttributeEdge, AttributeNode, Body, ChainSpec, Crossing, EdgeId, FaceId, FanKind, JointId, JointSpec,
    NodeId, Pairing, PairingError, SurfaceSpec, Through,
};
use mesh_kernel::glam::DVec3;

const BOTH: [Pairing; 2] = [Pairing::Miss, Pairing::Join];

#[test]
fn two_boxes_that_touch_along_an_edge() {
    for cells in [2u32, 3] {
        for grouping in 0..3 {
            let mut solids = Solids::new(grouping);
            solids.block([0, 0, 0], [cells; 3]);
            solids.block([cells, cells, 0], [cells; 3]);
            let body = solids.body();
            let joint = only_joint(&body);
            let m = i64::from(cells);
            assert_eq!(body.joint_len(joint), cells as usize);
            let pairings = body.edge_pairings(joint).unwrap();
            let of_box = |s: &mesh_kernel::body::Sheet| {
                let (surface, face) = body.sheet_face(joint, *s, 0).unwrap();
                let s = body.surface(surface);
                s.corners(face).iter().all(|p| p.x <= m as f64 && p.y <= m as f64)
            };
            assert!(pairings.material.iter().all(|[a, b]| of_box(a) == of_box(b)));
            assert!(pairings.empty.iter().all(|[a, b]| of_box(a) != of_box(b)));
            assert!(pairings.material.iter().all(|[a, _]| a.crossing() == Crossing::Enters));
            let each = (m * m * m) as f64;
            near(&volumes(&body), &[each, each]);
            assert_eq!(counts(&body), (1, 0, 2));

            let miss = resolve_edge(&body, joint, Pairing::Miss);
            near(&volumes(&miss.body), &[each, each]);
            assert_eq!(miss.after.v - miss.before.v, m - 1);
            // They still touch at the two ends, so there is a way round through both.
            assert_eq!((counts(&miss.body), miss.touching.len()), ((1, 1, 2), 2));
            let ends = miss.body.non_manifold_nodes();
            assert_eq!(ends.len(), 2);
            let apart = all_resolved(&miss.body, Pairing::Miss);
            assert_eq!(counts(&apart), (2, 0, 2));
            assert!(apart.joints().all(|(_, j)| j.radial().len() == 2));
            near(&volumes(&apart), &[each, each]);

            let join = resolve_edge(&body, joint, Pairing::Join);
            near(&volumes(&join.body), &[2.0 * each]);
            assert_eq!(join.after.v - join.before.v, m - 1);
            assert_eq!((counts(&join.body), join.touching.len()), ((1, 0, 1), 0));
            assert_eq!(join.body.non_manifold_nodes(), []);
            assert_eq!(join.body.regions().shell_count(), 2);
        }
    }
}

#[test]
fn boxes_of_one_edge_are_joined_after_a_split() {
    // Each box one surface: joined, a surface would have two edges between the same nodes.
    let mut solids = Solids::new(1);
    solids.block([0, 0, 0], [1; 3]);
    solids.block([1, 1, 0], [1; 3]);
    let body = solids.body();
    let joint = only_joint(&body);
    let refused = body.resolve_edge(joint, Pairing::Join).unwrap_err();
    assert!(matches!(refused, PairingError::SlitOfOneEdge { .. }), "{refused}");
    let miss = resolve_edge(&body, joint, Pairing::Miss);
    // Both pairs are ordinary edges of the boxes: no joint is left but those that touch.
    assert!(miss.pairs.is_empty() && miss.joints[joint.index()].is_none());
    assert!(miss.body.joints().all(|(_, j)| j.radial().is_empty()));

    let mut editor = Editor::new(body);
    let u = editor.body().joint(joint).uses()[0];
    let edge = editor.body().joint_edge(joint, 0, 0).edge();
    editor.split_edge(u.surface, edge, 0.5).unwrap();
    let join = resolve_edge(editor.body(), joint, Pairing::Join);
    assert_eq!(counts(&join.body), (1, 0, 1));
    near(&volumes(&join.body), &[2.0]);
    // Every facet a surface: nothing stands against it, also with one edge.
    let mut solids = Solids::new(2);
    solids.block([0, 0, 0], [1; 3]);
    solids.block([1, 1, 0], [1; 3]);
    let body = solids.body();
    let join = resolve_edge(&body, only_joint(&body), Pairing::Join);
    assert_eq!(counts(&join.body), (1, 0, 1));
}

#[test]
fn two_boxes_that_touch_in_a_node() {
    for grouping in 0..3 {
        let mut solids = Solids::new(grouping);
        solids.block([0, 0, 0], [2; 3]);
        solids.block([2, 2, 2], [2; 3]);
        let body = solids.body();
        let nodes = body.non_manifold_nodes();
        assert_eq!(nodes.len(), 1);
        let (surface, node) = nodes[0];
        let fans = body.node_fans(surface, node).unwrap();
        assert_eq!(fans.fans.iter().map(|f| f.kind).collect::<Vec<_>>(), [FanKind::Disk; 2]);
        assert_eq!(fans.contacts.len(), 1);
        let contact = &fans.contacts[0];
        assert_eq!((contact.through, &contact.fans[..]), (Through::Empty, &[0, 1][..]));
        assert_ne!(contact.shells[0], contact.shells[1]);
        let regions = body.regions();
        let outside: Vec<_> = contact.shells.iter().map(|s| regions.faces_of_shell(s.unwrap())[0]).collect();
        assert!(outside.iter().all(|u| regions.region(u.surface, u.face, u.side) == 0));

        let miss = body.resolve_node(surface, node, Pairing::Miss).unwrap();
        kept(&body, &miss);
        assert_eq!((counts(&body), counts(&miss.body)), ((1, 0, 2), (2, 0, 2)));
        assert!(miss.body.non_manifold_nodes().is_empty() && miss.touching.is_empty());
        let join = body.resolve_node(surface, node, Pairing::Join).unwrap();
        kept(&body, &join);
        assert_eq!((counts(&join.body), join.touching.len()), ((1, 0, 2), 1));
        // What was said can be said again, and changed.
        let (surface, node) = join.body.non_manifold_nodes()[0];
        let again = join.body.resolve_node(surface, node, Pairing::Join).unwrap();
        assert_eq!(counts(&again.body), (1, 0, 2));
        let miss = again.body.resolve_node(surface, node, Pairing::Miss).unwrap();
        assert_eq!(counts(&miss.body), (2, 0, 2));
        let one = miss.body.resolve_node(surface, node, Pairing::Miss).unwrap_err();
        assert_eq!(one, PairingError::OneFan { surface, node });
    }
}

#[test]
fn hollows_that_touch_are_parted_by_joining_the_material() {
    for grouping in 0..3 {
        let mut solids = Solids::new(grouping);
        solids.block([0, 0, 0], [6; 3]);
        solids.hollow([1, 1, 1], [2; 3]);
        solids.hollow([3, 3, 3], [2; 3]);
        let body = solids.body();
        near(&volumes(&body), &[8.0, 8.0, 200.0]);
        let (surface, node) = body.non_manifold_nodes()[0];
        let fans = body.node_fans(surface, node).unwrap();
        assert_eq!(fans.contacts[0].through, Through::Material);
        let join = body.resolve_node(surface, node, Pairing::Join).unwrap();
        kept(&body, &join);
        assert_eq!((counts(&body), counts(&join.body)), ((2, 0, 3), (3, 0, 3)));
        let miss = body.resolve_node(surface, node, Pairing::Miss).unwrap();
        kept(&body, &miss);
        assert_eq!((counts(&miss.body), miss.touching.len()), ((2, 0, 3), 1));

        let mut solids = Solids::new(grouping);
        solids.block([0, 0, 0], [6; 3]);
        solids.hollow([1, 1, 2], [2; 3]);
        solids.hollow([3, 3, 2], [2; 3]);
        let body = solids.body();
        let joint = only_joint(&body);
        // The material misses itself across the edge: the hollows are one.
        near(&volumes(&resolve_edge(&body, joint, Pairing::Miss).body), &[16.0, 200.0]);
        near(&volumes(&resolve_edge(&body, joint, Pairing::Join).body), &[8.0, 8.0, 200.0]);
    }
}

/// Flaps on the edge along z at angles in degrees; `along` those that run along it.
fn flap_specs(angles: &[(f64, bool)], edges: u32) -> Vec<SurfaceSpec> {
    angles
        .iter()
        .map(|&(angle, along)| {
            let out = DVec3::new(angle.to_radians().cos(), angle.to_radians().sin(), 0.0) * 3.0;
            let mut spec = SurfaceSpec { name: format!("at {angle}"), ..SurfaceSpec::default() };
            for k in 0..=edges {
                spec.positions.extend([DVec3::Z * f64::from(k), DVec3::Z * f64::from(k) + out]);
            }
            for k in 0..edges {
                let (a, b, c, d) = (2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1);
                for [p, q, r] in [[a, b, c], [a, c, d]] {
                    spec.faces.push(if along { [p, q, r] } else { [q, p, r] });
                }
            }
            spec
        })
        .collect()
}

fn flaps(angles: &[(f64, bool)], edges: u32) -> Body {
    let specs = flap_specs(angles, edges);
    let chains = (0..specs.len())
        .map(|surface| ChainSpec { surface, nodes: (0..=edges).map(|k| 2 * k).collect(), closed: false })
        .collect();
    Body::build(&specs, &[JointSpec { name: Some("axis".into()), chains }]).unwrap()
}

#[test]
fn four_sheets_that_cross_as_an_x() {
    let body = flaps(&[(45.0, true), (135.0, false), (225.0, true), (315.0, false)], 3);
    let joint = JointId(0);
    assert!(body.alternates(joint));
    assert_eq!(counts(&body), (1, 0, 0));
    for pairing in BOTH {
        let done = resolve_edge(&body, joint, pairing);
        assert_eq!((done.pairs.len(), done.touching.len()), (2, 2));
        assert!(done.pairs.iter().all(|&j| done.body.joint(j).name() == Some("axis")));
        assert_eq!(counts(&done.body), (1, 1, 0));
        let (surface, node) = done.body.non_manifold_nodes()[0];
        let fans = done.body.node_fans(surface, node).unwrap();
        assert_eq!(fans.fans.iter().map(|f| f.kind).collect::<Vec<_>>(), [FanKind::HalfDisk; 2]);
        assert_eq!(fans.contacts[0].through, Through::Sheets);
        assert_eq!(counts(&all_resolved(&done.body, Pairing::Miss)), (2, 0, 0));
        assert_eq!(counts(&all_resolved(&done.body, Pairing::Join)), (1, 1, 0));
    }
    // By which sectors the two choices pair: 45° and 315° enclose the normal of the flap at 45° looking back.
    let angle = |s: &mesh_kernel::body::Sheet| {
        let u = body.joint(joint).uses()[s.use_index as usize];
        body.surface(u.surface).name()[3..].parse::<f64>().unwrap()
    };
    let pairings = body.edge_pairings(joint).unwrap();
    let mut empty: Vec<[f64; 2]> = pairings.empty.iter().map(|p| p.each_ref().map(angle)).collect();
    empty.sort_by(|a, b| a[0].total_cmp(&b[0]));
    // A flap that runs along the axis has its normal onwards, anticlockwise seen from above.
    assert_eq!(empty, [[45.0, 135.0], [225.0, 315.0]]);

    // Two sheets that run through each other do not alternate.
    let sheet = |name: &str, out: DVec3| SurfaceSpec {
        name: name.into(),
        positions: vec![DVec3::ZERO, DVec3::Z, out, -out],
        faces: vec![[0, 1, 2], [1, 0, 3]],
    };
    let chains = (0..2).map(|surface| ChainSpec { surface, nodes: vec![0, 1], closed: false }).collect();
    let specs = [sheet("a", DVec3::X), sheet("b", DVec3::Y)];
    let body = Body::build(&specs, &[JointSpec { name: None, chains }]).unwrap();
    for pairing in BOTH {
        let refused = body.resolve_edge(joint, pairing).unwrap_err();
        let PairingError::InARow { crossing, sheets, .. } = &refused else { panic!("{refused}") };
        assert!(sheets.iter().all(|s| s.crossing() == *crossing), "{refused}");
        assert!(refused.to_string().contains("material"), "{refused}");
    }
}

/// Wedges of solid (prisms over triangles) about the z axis, by their first and last angle in degrees.
fn wedges(spans: &[[f64; 2]], grouping: usize, edges: u32) -> Body {
    let body = wedges_unchecked(spans, grouping, edges);
    sound(&body);
    body
}

fn wedges_unchecked(spans: &[[f64; 2]], grouping: usize, edges: u32) -> Body {
    let mut solids = Solids::new(grouping);
    for span in spans {
        let [p, q] = span.map(|a| DVec3::new(a.to_radians().cos(), a.to_radians().sin(), 0.0) * 4.0);
        solids.prism([DVec3::ZERO, p, q], DVec3::Z, edges);
    }
    solids.unchecked()
}

#[test]
fn three_boxes_at_one_edge() {
    for grouping in 0..3 {
        for edges in [2u32, 4] {
            let body = wedges(&[[0.0, 60.0], [90.0, 170.0], [200.0, 300.0]], grouping, edges);
            let joint = only_joint(&body);
            let each = volumes(&body);
            let pairings = body.edge_pairings(joint).unwrap();
            assert_eq!((pairings.material.len(), pairings.empty.len()), (3, 3));
            assert_eq!((counts(&body), each.len()), ((1, 0, 3), 3));
            let miss = resolve_edge(&body, joint, Pairing::Miss);
            // Two more ways round: three bodies hang together at two nodes.
            assert_eq!((counts(&miss.body), volumes(&miss.body).len()), ((1, 2, 3), 3));
            near(&volumes(&miss.body), &each);
            assert_eq!(counts(&all_resolved(&miss.body, Pairing::Miss)), (3, 0, 3));
            let join = resolve_edge(&body, joint, Pairing::Join);
            assert_eq!(counts(&join.body), (1, 0, 1));
            near(&volumes(&join.body), &[each.iter().sum()]);
            assert!(join.body.non_manifold_nodes().is_empty());
        }
    }
}

#[test]
fn what_bounds_no_material_is_refused() {
    let t = flaps(&[(0.0, true), (90.0, true), (180.0, false)], 2);
    let refused = t.resolve_edge(JointId(0), Pairing::Miss).unwrap_err();
    assert_eq!(
        refused,
        PairingError::Odd { joint: JointId(0), sheets: t.joint(JointId(0)).radial().to_vec() }
    );
    // A wedge that lies in the material of another, on a part of its edge.
    let mut solids = Solids::new(2);
    let wide = [0.0f64, 120.0].map(|a| DVec3::new(a.to_radians().cos(), a.to_radians().sin(), 0.0) * 4.0);
    solids.prism([DVec3::ZERO, wide[0], wide[1]], DVec3::Z, 3);
    let inner = [30.0f64, 60.0].map(|a| DVec3::new(a.to_radians().cos(), a.to_radians().sin(), 1.5));
    solids.tetrahedron(DVec3::Z, [DVec3::Z * 2.0, inner[0], inner[1]]);
    let nested = solids.body();
    let joint = only_joint(&nested);
    assert!(!nested.alternates(joint));
    for pairing in BOTH {
        let refused = nested.resolve_edge(joint, pairing).unwrap_err();
        assert!(matches!(refused, PairingError::InARow { .. }), "{refused}");
    }
    // Partly in it; the check sees that they run through each other.
    let lapped = wedges_unchecked(&[[0.0, 120.0], [100.0, 160.0]], 2, 2);
    assert!(matches!(lapped.edge_pairings(only_joint(&lapped)), Err(PairingError::InARow { .. })));
    // Turned round it is a hollow.
    let two = flaps(&[(0.0, true), (90.0, false)], 1);
    assert_eq!(
        two.resolve_edge(JointId(0), Pairing::Join),
        Err(PairingError::Manifold { joint: JointId(0) })
    );
    assert_eq!(two.edge_pairings(JointId(7)), Err(PairingError::NoJoint(JointId(7))));
    let nowhere = (mesh_kernel::body::SurfaceId(0), NodeId(99));
    assert_eq!(
        two.node_fans(nowhere.0, nowhere.1),
        Err(PairingError::NoNode { surface: nowhere.0, node: nowhere.1 })
    );
    // A body that touches another from within its material at a node.
    let mut solids = Solids::new(2);
    solids.block([0, 0, 0], [4; 3]);
    solids.prism([DVec3::ZERO, DVec3::new(2.0, 1.0, 1.0), DVec3::new(1.0, 2.0, 1.0)], DVec3::ZERO, 0);
    let body = solids.body();
    let (surface, node) = body.non_manifold_nodes()[0];
    assert_eq!(body.node_fans(surface, node).unwrap().contacts[0].through, Through::Conflict);
    for pairing in BOTH {
        let refused = body.resolve_node(surface, node, pairing).unwrap_err();
        assert!(matches!(refused, PairingError::MaterialInMaterial { fans: [0, 1], .. }), "{refused}");
    }
}

#[test]
fn wires_touching_joints_and_attributes_in_the_way() {
    // A wire in the joint.
    let specs = flap_specs(&[(0.0, true), (90.0, false), (180.0, true)], 1);
    let mut body = Body::build(&specs, &[]).unwrap();
    let wire = body.add_surface("wire");
    let [a, b] = [DVec3::ZERO, DVec3::Z].map(|p| body.add_node(wire, p).unwrap());
    body.add_edge(wire, a, b).unwrap();
    let mut chains: Vec<ChainSpec> =
        (0..3).map(|surface| ChainSpec { surface, nodes: vec![0, 2], closed: false }).collect();
    chains.push(ChainSpec { surface: 3, nodes: vec![0, 1], closed: false });
    let joint = body.add_joint(&JointSpec { name: None, chains }).unwrap();
    assert!(matches!(body.edge_pairings(joint), Err(PairingError::Wire { .. })));
    let sectors = body.edge_sectors(wire, EdgeId(0));
    assert_eq!(sectors.len(), 3);

    // A line over the joint, where the sheet is cut there.
    let mut solids = Solids::new(1);
    solids.block([0, 0, 0], [2; 3]);
    solids.block([2, 2, 0], [2; 3]);
    let mut body = solids.body();
    let joint = only_joint(&body);
    let u = body.joint(joint).uses()[0];
    let edge = body.joint_edge(joint, 0, 0).edge();
    let s = body.surface_mut(u.surface);
    let [left, right] = s.edge_faces()[edge.index()];
    let third = [1.0 / 3.0; 3];
    let nodes = [
        AttributeNode::InFace { face: FaceId(left), areal: third },
        AttributeNode::OnEdge { edge, u: 0.5 },
        AttributeNode::InFace { face: FaceId(right), areal: third },
    ]
    .map(|n| s.add_attribute_node(n).unwrap());
    s.add_attribute_edge(AttributeEdge { name: None, nodes: nodes.to_vec() }).unwrap();
    // The pair stays on the box: nothing is cut.
    resolve_edge(&body, joint, Pairing::Miss);
    let refused = body.resolve_edge(joint, Pairing::Join).unwrap_err();
    assert!(matches!(refused, PairingError::AttributeInTheWay { .. }), "{refused}");
}

#[test]
fn rings_that_touch_along_a_closed_line() {
    for grouping in 0..3 {
        // Two square sections that touch in a corner, turned about z.
        let mut solids = Solids::new(grouping);
        solids.ring(7, [2.0, 3.0], [0.0, 1.0]);
        solids.ring(7, [3.0, 4.0], [1.0, 2.0]);
        let body = solids.body();
        let joint = only_joint(&body);
        assert!(body.joint_is_closed(joint) && body.joint_len(joint) == 7);
        assert_eq!(counts(&body), (1, 3, 2));
        let miss = resolve_edge(&body, joint, Pairing::Miss);
        assert_eq!((counts(&miss.body), miss.touching.len()), ((2, 4, 2), 0));
        let join = resolve_edge(&body, joint, Pairing::Join);
        assert_eq!((counts(&join.body), join.touching.len()), ((1, 2, 1), 0));
        assert!(join.body.non_manifold_nodes().is_empty());
    }
}

#[test]
fn what_touches_the_joint_elsewhere_stays_held() {
    let mut solids = Solids::new(1);
    solids.block([0, 0, 0], [2; 3]);
    solids.block([2, 2, 0], [2; 3]);
    // A small tetrahedron whose corner is the middle of the edge.
    let at = DVec3::new(2.0, 2.0, 1.0);
    let corner = [DVec3::new(0.5, -0.5, -0.3), DVec3::new(0.9, -0.5, 0.2), DVec3::new(0.5, -0.9, 0.2)];
    solids.tetrahedron(at, corner.map(|d| at + d));
    let body = solids.body();
    let joint = only_joint(&body);
    let (surface, node) = body.non_manifold_nodes()[0];
    assert_eq!(body.node_fans(surface, node).unwrap().contacts[0].through, Through::Empty);
    for pairing in BOTH {
        let done = resolve_edge(&body, joint, pairing);
        let ends = if pairing == Pairing::Miss { 3 } else { 1 };
        assert_eq!(done.touching.len(), ends, "{pairing:?}");
        let apart = all_resolved(&done.body, Pairing::Miss);
        let parts = if pairing == Pairing::Miss { 3 } else { 2 };
        assert_eq!(apart.counts().c, parts, "{pairing:?}");
    }
}

#[test]
fn random_solids_of_cells() {
    let (mut resolved, mut slits) = (0, 0);
    for seed in 0..300 {
        let mut random = Random(seed + 1);
        let size = [2 + random.below(2), 2 + random.below(2), 2 + random.below(3)];
        let grouping = random.below(4);
        let (body, cells) = crate::body::pairing_support::cells(&mut random, size, grouping);
        sound(&body);
        let volume = body.volume().unwrap();
        // Radial order alone: neither material nor empty space passes an edge.
        let parts = |body: &Body| body.regions().regions().len();
        assert_eq!(parts(&body), cells.parts(true, 1) + cells.parts(false, 1), "{seed}");
        for pairing in BOTH {
            let mut now = body.clone();
            while let Some(joint) = now.non_manifold_joints().first().copied() {
                match now.resolve_edge(joint, pairing) {
                    Ok(next) => {
                        kept(&now, &next);
                        now = next.body;
                        resolved += 1;
                    }
                    // As the refusal says: split an edge of the joint first.
                    Err(PairingError::SlitOfOneEdge { joint, .. }) => {
                        let u = now.joint(joint).uses()[0];
                        let edge = now.joint_edge(joint, 0, 0).edge();
                        let mut editor = Editor::new(now);
                        editor.split_edge(u.surface, edge, 0.5).unwrap();
                        now = editor.into_body();
                        assert!(now.joint_len(joint) == 2);
                        slits += 1;
                    }
                    Err(e) => panic!("{seed}: {e}"),
                }
            }
            let (material, empty) = if pairing == Pairing::Miss { (1, 2) } else { (2, 1) };
            let expected = cells.parts(true, material) + cells.parts(false, empty);
            assert_eq!(parts(&now), expected, "{seed} {pairing:?}");
            assert!((now.volume().unwrap() - volume).abs() < 1e-9);
            let last = all_resolved(&now, Pairing::Miss);
            assert_eq!(parts(&last), expected, "{seed} {pairing:?}");
            assert!(last.joints().all(|(j, _)| last.alternates(j)));
        }
    }
    assert!(resolved > 400 && slits > 30, "{resolved} {slits}");
}

#[test]
fn wires_and_nodes_that_touch_a_solid() {
    let mut solids = Solids::new(1);
    solids.block([0, 0, 0], [2; 3]);
    let mut body = solids.body();
    let block = mesh_kernel::body::SurfaceId(0);
    let at = DVec3::splat(2.0);
    let corner = body.surface(block).positions().iter().position(|p| *p == at).unwrap() as u32;
    let wires = body.add_surface("wires");
    // One wire outside, one that runs into the block, and a node alone.
    let [a, b] = [at, at + DVec3::X].map(|p| body.add_node(wires, p).unwrap());
    body.add_edge(wires, a, b).unwrap();
    let inside = body.add_surface("inside");
    let [c, d] = [at, DVec3::ONE].map(|p| body.add_node(inside, p).unwrap());
    body.add_edge(inside, c, d).unwrap();
    let alone = body.add_surface("alone");
    let e = body.add_node(alone, at).unwrap();
    let chain = |surface, node: u32| ChainSpec { surface, nodes: vec![node], closed: false };
    let chains = vec![chain(0, corner), chain(1, a.0), chain(2, c.0), chain(3, e.0)];
    body.add_joint(&JointSpec { name: Some("pin".into()), chains }).unwrap();
    sound(&body);
    assert_eq!(body.counts().c, 1);
    let fans = body.node_fans(wires, a).unwrap();
    let kinds: Vec<FanKind> = fans.fans.iter().map(|f| f.kind).collect();
    assert_eq!(kinds, [FanKind::Disk, FanKind::Wire, FanKind::Wire, FanKind::Point]);
    assert_eq!(fans.fans[1].wires, [(wires, EdgeId(0))]);
    let mut through: Vec<(Vec<u32>, Through)> =
        fans.contacts.iter().map(|c| (c.fans.clone(), c.through)).collect();
    through.sort();
    assert_eq!(through, [(vec![0, 1], Through::Empty), (vec![0, 2], Through::Material)]);
    let miss = body.resolve_node(alone, e, Pairing::Miss).unwrap();
    kept(&body, &miss);
    // The wire in the material stays; all else is apart.
    assert_eq!((miss.after.c, miss.touching.len()), (3, 1));
    let join = body.resolve_node(alone, e, Pairing::Join).unwrap();
    kept(&body, &join);
    assert_eq!((join.after.c, join.touching.len()), (2, 1));
}

#[test]
fn copies_keep_flat_and_backup_positions() {
    let mut solids = Solids::new(1);
    solids.block([0, 0, 0], [2; 3]);
    solids.block([2, 2, 0], [2; 3]);
    let mut body = solids.body();
    for id in body.surface_ids() {
        let s = body.surface_mut(id);
        s.store_backup();
        let flat = s.positions().iter().map(|p| p.truncate() * 3.0).collect();
        assert!(s.set_planar(flat));
    }
    let join = resolve_edge(&body, only_joint(&body), Pairing::Join);
    for (id, s) in join.body.surfaces() {
        let old = body.surface(id);
        assert!(s.positions().len() > old.positions().len());
        assert_eq!(&s.positions()[..old.positions().len()], old.positions());
        assert_eq!(s.backup().unwrap(), s.positions());
        assert!(s.planar().unwrap().iter().zip(s.positions()).all(|(q, p)| *q == p.truncate() * 3.0));
        assert_eq!(s.faces().len(), old.faces().len());
    }
}

#[test]
fn bodies_with_free_numbers() {
    for grouping in [1, 2] {
        let mut solids = Solids::new(grouping);
        solids.block([0, 0, 0], [3; 3]);
        solids.block([3, 3, 0], [3; 3]);
        solids.block([6, 6, 3], [3; 3]);
        let body = solids.body();
        let joint = only_joint(&body);
        let near_joint = body.joint_nodes(joint, 0);
        let mut editor = Editor::new(body);
        // A joint of two sheets, and a face in the middle of a facet, are taken away.
        let plain = editor.body().joints().find(|(_, j)| j.radial().len() == 2).map(|(id, _)| id);
        if let Some(plain) = plain {
            editor.kill_joint(plain).unwrap();
        }
        let surface = editor.body().joint(joint).uses()[0].surface;
        let s = editor.body().surface(surface);
        let away = |f: &FaceId| s.faces()[f.index()].iter().all(|v| !near_joint.contains(v));
        let faces: Vec<FaceId> = s.live_faces().filter(away).collect();
        // Some have other joints in the way.
        assert!(faces.iter().any(|&face| editor.kill_face(surface, face).is_ok()));
        let body = editor.into_body();
        assert!(!body.is_compact());
        sound(&body);
        assert!(body.edge_sectors(surface, EdgeId(0)).len() <= 2);
        for pairing in BOTH {
            let done = resolve_edge(&body, joint, pairing);
            let last = all_resolved(&done.body, Pairing::Miss);
            assert!(last.non_manifold_joints().is_empty() && last.non_manifold_nodes().is_empty());
        }
        let (node_surface, node) = body
            .non_manifold_nodes()
            .into_iter()
            .find(|(s, v)| body.surface(*s).positions()[v.index()] == DVec3::new(6.0, 6.0, 3.0))
            .unwrap();
        let done = body.resolve_node(node_surface, node, Pairing::Miss).unwrap();
        kept(&body, &done);
        assert_eq!(done.after.c, done.before.c + 1);
        // A joint that is gone is no joint.
        if let Some(plain) = plain {
            assert_eq!(body.edge_pairings(plain), Err(PairingError::NoJoint(plain)));
        }
    }
}
