//! Random bodies with joints, random splits: what must hold holds after every step.

use crate::body::support::{Random, add_attributes, add_wires, fan, lattice, random_body};
use mesh_kernel::body::{AttributeEdge, AttributeNodeId, Body, FaceId, SurfaceId};
use mesh_kernel::glam::DVec3;
use proptest::prelude::*;

/// Position of every attribute node and length of every attribute line.
fn places(body: &Body) -> Vec<(Vec<DVec3>, Vec<f64>)> {
    body.surfaces()
        .map(|(_, s)| {
            let at = |n: AttributeNodeId| s.attribute_position(n);
            let nodes = (0..s.attribute_nodes().len() as u32).map(|n| at(AttributeNodeId(n))).collect();
            let length = |l: &AttributeEdge| l.nodes.windows(2).map(|w| at(w[0]).distance(at(w[1]))).sum();
            (nodes, s.attribute_edges().iter().map(length).collect())
        })
        .collect()
}

fn assert_bit_equal(body: &Body) {
    for j in body.joint_ids() {
        let position = |i: usize, k: usize| {
            let u = body.joint(j).uses()[i];
            let p = body.surface(u.surface).positions()[body.joint_nodes(j, i)[k] as usize];
            p.to_array().map(f64::to_bits)
        };
        for i in 1..body.joint(j).uses().len() {
            for k in 0..=body.joint_len(j) {
                assert_eq!(position(0, k), position(i, k));
            }
        }
    }
}

/// A body, and what must not change when it is split.
struct Watched {
    body: Body,
    area: f64,
    shape: [i64; 3],
    places: Vec<(Vec<DVec3>, Vec<f64>)>,
}

impl Watched {
    fn new(body: Body) -> Self {
        let counts = body.counts();
        let shape = [counts.c, counts.ch, counts.cc];
        let watched = Self { area: body.area(), shape, places: places(&body), body };
        watched.assert_sound();
        watched
    }

    fn assert_sound(&self) {
        let body = &self.body;
        assert_eq!(body.check(), []);
        let counts = body.counts();
        assert!(counts.identity_holds(), "{counts}");
        assert_eq!([counts.c, counts.ch, counts.cc], self.shape, "{counts}");
        assert!((body.area() - self.area).abs() <= 1e-12 * self.area);
        assert_bit_equal(body);
        for (before, now) in self.places.iter().zip(places(body)) {
            // Lines may have got nodes where they cross new edges; these come after the old ones.
            for (p, q) in before.0.iter().zip(now.0) {
                assert!(p.distance(q) < 1e-12, "{p} {q}");
            }
            for (l, m) in before.1.iter().zip(now.1) {
                assert!((l - m).abs() < 1e-11, "{l} {m}");
            }
        }
        let mesh = body.to_tri_mesh();
        assert_eq!((mesh.positions.len() as i64, mesh.faces.len() as i64), (counts.v, counts.f));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn splits_keep_bodies_sound(kind in 0u8..4, seed: u64, steps in proptest::collection::vec(any::<u32>(), 1..10)) {
        let mut random = Random(seed ^ 0x5eed);
        let mut body = random_body(kind, seed);
        add_attributes(&mut body, &mut random);
        add_wires(&mut body, &mut random);
        let mut watched = Watched::new(body);
        for step in steps {
            let body = &mut watched.body;
            if body.face_count() == 0 || (step % 8 == 0 && body.face_count() < 2000) {
                body.split_all(None).unwrap();
            } else {
                let surface = SurfaceId(step / 8 % body.surfaces().len() as u32);
                let faces = body.surface(surface).faces().len() as u32;
                let face = FaceId(step / 64 % faces);
                let old = body.surface(surface).corners(face);
                let split = body.split_face(surface, face).unwrap();
                let s = body.surface(surface);
                for i in 0..3 {
                    assert_eq!(s.corners(split.children[i])[i], old[i]);
                    assert_eq!(s.positions()[split.nodes[i] as usize], (old[i] + old[(i + 1) % 3]) * 0.5);
                }
                assert_eq!(s.faces()[split.children[3].index()], split.nodes);
            }
            watched.assert_sound();
        }
    }

    #[test]
    fn meshes_come_back(seed: u64, x in 1usize..4, y in 1usize..4, z in 1usize..3, density in 0.1..1.0, groups in 1usize..8) {
        let mesh = lattice(seed, [x, y, z], density, groups);
        let body = Body::from_tri_mesh(&mesh).unwrap();
        assert_eq!(body.check(), []);
        let back = body.to_tri_mesh();
        let mut used: Vec<u32> = mesh.faces.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        assert_eq!(back.positions.len(), used.len());
        assert_eq!(back.groups, mesh.groups);
        for f in 0..mesh.faces.len() as u32 {
            assert_eq!(back.corners(f), mesh.corners(f));
        }
        // Nodes are shared in the same way.
        let mut map = std::collections::BTreeMap::new();
        for (f, g) in mesh.faces.iter().zip(&back.faces) {
            for (a, b) in f.iter().zip(g) {
                assert_eq!(map.entry(*a).or_insert(*b), b);
            }
        }
        // A body of the body is the same again.
        assert_eq!(Body::from_tri_mesh(&back).unwrap().counts(), body.counts());
    }
}

#[test]
fn fixed_seeds_of_every_kind_pass() {
    for kind in 0..3 {
        for seed in 0..40 {
            let mut watched = Watched::new(random_body(kind, seed));
            watched.body.split_all(None).unwrap();
            watched.assert_sound();
        }
    }
}

#[test]
fn midpoints_given_are_taken_and_made_equal_on_joints() {
    let mut body = fan(7, 4, 3);
    let midpoints: Vec<Vec<DVec3>> = body
        .surfaces()
        .map(|(id, s)| {
            let middle = |&[a, b]: &[u32; 2]| {
                (s.positions()[a as usize] + s.positions()[b as usize]) * 0.5
                    + DVec3::Z * 0.01 * f64::from(id.0)
            };
            s.edges().iter().map(middle).collect()
        })
        .collect();
    let map = body.split_all(Some(&midpoints)).unwrap();
    assert_bit_equal(&body);
    let s = body.surface(SurfaceId(0));
    assert_eq!(&s.positions()[map.surfaces[0].old_nodes as usize..], &midpoints[0][..]);
    assert!(body.split_all(Some(&midpoints)).is_err());
    assert!(body.split_all(Some(&[])).is_err());
    assert!(body.split_face(SurfaceId(99), FaceId(0)).is_err());
    assert!(body.split_face(SurfaceId(0), FaceId(u32::MAX)).is_err());
}
