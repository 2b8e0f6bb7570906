//! Triangles thrown together without any sense: a sound body or a typed refusal, never a panic.

use mesh_kernel::body::{Body, ChainSpec, JointSpec, SurfaceSpec};
use mesh_kernel::glam::DVec3;
use mesh_kernel::{Group, TriMesh};
use proptest::prelude::*;

fn position() -> impl Strategy<Value = DVec3> {
    // Few distinct coordinates, so that collinear, coplanar and coincident nodes are common.
    prop_oneof![
        8 => (0..4i8, 0..4i8, 0..3i8).prop_map(|(x, y, z)| DVec3::new(x.into(), y.into(), z.into())),
        1 => (-1e3..1e3, -1e-9..1e-9, -1e9..1e9).prop_map(|(x, y, z)| DVec3::new(x, y, z)),
    ]
}

fn faces(nodes: u32, most: usize) -> impl Strategy<Value = Vec<[u32; 3]>> {
    let face = (0..nodes, 1..nodes, 1..nodes - 1).prop_map(move |(a, b, c)| {
        // Three different nodes.
        let b = (a + b) % nodes;
        let mut rest: Vec<u32> = (0..nodes).filter(|v| *v != a && *v != b).collect();
        let at = c as usize % rest.len();
        [a, b, rest.swap_remove(at)]
    });
    proptest::collection::vec(face, 0..most)
}

/// Defects of geometry that a soup has by nature; everything else must be right.
fn topology_sound(body: &Body) {
    let natural = ["degenerate_face", "duplicate_face", "duplicate_edge", "radial_order", "identity"];
    let defects: Vec<_> = body.check().into_iter().filter(|d| !natural.contains(&d.code())).collect();
    assert_eq!(defects, []);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn any_soup_becomes_a_sound_body(
        positions in proptest::collection::vec(position(), 9),
        faces in faces(9, 40),
        cuts in proptest::collection::vec(0usize..40, 0..4),
    ) {
        let mut mesh = TriMesh::new(positions, faces);
        let mut cuts: Vec<u32> = cuts.into_iter().map(|c| c.min(mesh.faces.len()) as u32).collect();
        cuts.sort_unstable();
        mesh.groups = cuts.windows(2).map(|w| Group { name: "g".into(), faces: w[0]..w[1] }).collect();
        let mut body = Body::from_tri_mesh(&mesh).expect("finite, in range, no node twice");
        topology_sound(&body);
        let back = body.to_tri_mesh();
        let mut used: Vec<u32> = mesh.faces.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        prop_assert_eq!(back.positions.len(), used.len());
        prop_assert_eq!(back.faces.len(), mesh.faces.len());
        // Cycles by the identity's own left side: over GF(2) it holds for any complex.
        let counts = body.counts();
        prop_assert!(counts.ch >= 0 && counts.cc >= 0 && counts.c >= 0);
        let _ = (body.volume(), body.regions(), body.boundary_loops(), body.area());
        body.split_all(None).expect("small");
        topology_sound(&body);
        prop_assert_eq!(body.counts().c, counts.c);
        prop_assert_eq!(body.counts().ch, counts.ch);
        prop_assert_eq!(body.counts().cc, counts.cc);
    }

    #[test]
    fn any_specification_is_built_soundly_or_refused(
        positions in proptest::collection::vec(position(), 6),
        lists in proptest::collection::vec(proptest::collection::vec([0u32..7, 0u32..6, 0u32..6], 0..6), 0..3),
        joints in proptest::collection::vec(
            proptest::collection::vec((0usize..3, proptest::collection::vec(0u32..7, 0..4), any::<bool>()), 0..4),
            0..3,
        ),
    ) {
        let surfaces: Vec<SurfaceSpec> = lists
            .into_iter()
            .map(|faces| SurfaceSpec { name: "s".into(), positions: positions.clone(), faces })
            .collect();
        let joints: Vec<JointSpec> = joints
            .into_iter()
            .map(|chains| JointSpec {
                name: None,
                chains: chains
                    .into_iter()
                    .map(|(surface, nodes, closed)| ChainSpec { surface, nodes, closed })
                    .collect(),
            })
            .collect();
        match Body::build(&surfaces, &joints) {
            Ok(body) => topology_sound(&body),
            Err(e) => prop_assert!(!e.to_string().is_empty()),
        }
        // The joints one by one on a body that has none.
        if let Ok(mut body) = Body::build(&surfaces, &[]) {
            for spec in &joints {
                let before = body.clone();
                if body.add_joint(spec).is_err() {
                    prop_assert_eq!(&body, &before);
                }
                topology_sound(&body);
            }
        }
    }
}

#[test]
fn broken_meshes_are_refused() {
    let ok = TriMesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]]);
    let broken = |f: &dyn Fn(&mut TriMesh)| {
        let mut mesh = ok.clone();
        f(&mut mesh);
        assert!(Body::from_tri_mesh(&mesh).is_err());
    };
    broken(&|m| m.faces.push([0, 1, 3]));
    broken(&|m| m.faces.push([0, 1, 1]));
    broken(&|m| m.positions[1].x = f64::INFINITY);
    // Nothing is something: an empty body.
    let empty = Body::from_tri_mesh(&TriMesh::default()).expect("empty");
    assert_eq!((empty.surfaces().len(), empty.check().len()), (0, 0));
    // Groups beyond the faces, overlapping, empty.
    let mut odd = ok.clone();
    odd.groups = vec![
        Group { name: "a".into(), faces: 0..9 },
        Group { name: "b".into(), faces: std::ops::Range { start: 5, end: 3 } },
    ];
    assert_eq!(Body::from_tri_mesh(&odd).expect("one face").face_count(), 1);
}
