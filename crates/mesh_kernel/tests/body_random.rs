//! Random bodies with joints, random splits: what must hold holds after every step.

// A test that cannot go on fails.
#![allow(clippy::unwrap_used)]

use mesh_kernel::body::{
    AttributeEdge, AttributeNode, AttributeNodeId, Body, ChainSpec, EdgeId, FaceId, JointSpec, NodeId, SurfaceId,
    SurfaceSpec,
};
use mesh_kernel::glam::DVec3;
use mesh_kernel::{Group, TriMesh};
use proptest::prelude::*;

/// A small generator: the same sequence for the same seed on every machine.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    fn unit(&mut self) -> f64 {
        self.next() as f64 / (1u64 << 31) as f64
    }
}

/// Squares of a lattice of cells, a random part of them, in random groups, windings and diagonals: T, X and Y joints,
/// closed joints, voids, bow ties, touching nodes, surfaces that meet a joint several times.
fn lattice(seed: u64, cells: [usize; 3], density: f64, groups: usize) -> TriMesh {
    let mut random = Random(seed);
    let [nx, ny, nz] = cells.map(|n| n + 1);
    let id = |p: [usize; 3]| ((p[2] * ny + p[1]) * nx + p[0]) as u32;
    let mut mesh = TriMesh::default();
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                let jitter = DVec3::new(random.unit(), random.unit(), random.unit()) * 0.2;
                mesh.positions.push(DVec3::new(x as f64, y as f64, z as f64) + jitter);
            }
        }
    }
    let mut faces: Vec<(usize, [u32; 3])> = Vec::new();
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                for axis in 0..3 {
                    let (u, w) = ((axis + 1) % 3, (axis + 2) % 3);
                    let at = [x, y, z];
                    if at[u] + 1 >= [nx, ny, nz][u] || at[w] + 1 >= [nx, ny, nz][w] || random.unit() > density
                    {
                        continue;
                    }
                    let corner = |du: usize, dw: usize| {
                        let mut p = at;
                        p[u] += du;
                        p[w] += dw;
                        id(p)
                    };
                    let mut square = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                    if random.below(2) == 0 {
                        square.reverse();
                    }
                    square.rotate_left(random.below(2));
                    let [a, b, c, d] = square;
                    let group = random.below(groups);
                    faces.push((group, [a, b, c]));
                    faces.push((group, [a, c, d]));
                }
            }
        }
    }
    faces.sort_by_key(|f| f.0);
    for (group, face) in faces {
        let at = mesh.faces.len() as u32;
        if mesh.groups.last().is_none_or(|g| g.name != group.to_string()) {
            mesh.groups.push(Group { name: group.to_string(), faces: at..at });
        }
        mesh.faces.push(face);
        mesh.groups.last_mut().unwrap().faces.end = at + 1;
    }
    mesh
}

/// Sheets about an axis at random angles, each a grid; some run through the axis with an inner chain.
fn fan(seed: u64, sheets: usize, rows: usize) -> Body {
    let mut random = Random(seed);
    let axis: Vec<DVec3> =
        (0..=rows).map(|k| DVec3::new(0.1 * random.unit(), 0.1 * random.unit(), k as f64)).collect();
    let mut angle = 0.0;
    let outs: Vec<DVec3> = (0..sheets)
        .map(|_| {
            angle += (0.2 + 0.8 * random.unit()) * std::f64::consts::TAU / sheets as f64;
            DVec3::new(angle.cos(), angle.sin(), 0.0)
        })
        .collect();
    let mut specs = Vec::new();
    let mut chains = Vec::new();
    let mut k = 0;
    while k < sheets {
        let through = k + 1 < sheets && random.below(2) == 0;
        let columns: Vec<DVec3> =
            if through { vec![outs[k], DVec3::ZERO, outs[k + 1]] } else { vec![DVec3::ZERO, outs[k]] };
        let zero = usize::from(through);
        let width = columns.len();
        let mut spec = SurfaceSpec { name: format!("sheet {k}"), ..SurfaceSpec::default() };
        for p in &axis {
            spec.positions.extend(columns.iter().map(|c| *p + *c * 2.0));
        }
        let id = |row: usize, column: usize| (row * width + column) as u32;
        let turned = random.below(2) == 0;
        for row in 0..rows {
            for column in 0..width - 1 {
                let (a, b) = (id(row, column), id(row, column + 1));
                let (c, d) = (id(row + 1, column + 1), id(row + 1, column));
                for mut face in [[a, b, c], [a, c, d]] {
                    if turned {
                        face.swap(1, 2);
                    }
                    spec.faces.push(face);
                }
            }
        }
        let nodes: Vec<u32> = (0..=rows).map(|row| id(row, zero)).collect();
        chains.push(ChainSpec { surface: specs.len(), nodes, closed: false });
        specs.push(spec);
        k += if through { 2 } else { 1 };
    }
    let joints =
        if chains.len() > 1 { vec![JointSpec { name: Some("axis".into()), chains }] } else { Vec::new() };
    Body::build(&specs, &joints).unwrap()
}

/// A strip rolled to a tube that meets itself in a joint, with collars on rings of it: closed chains on open ones, inner
/// and at the rim.
fn tube(seed: u64, around: usize, rows: usize) -> Body {
    let mut random = Random(seed);
    let place = |k: usize, y: f64, r: f64| {
        let a = std::f64::consts::TAU * (k % around) as f64 / around as f64;
        DVec3::new(r * a.cos(), y, r * a.sin())
    };
    let mut strip = SurfaceSpec { name: "tube".into(), ..SurfaceSpec::default() };
    for row in 0..=rows {
        strip.positions.extend((0..=around).map(|k| place(k, row as f64, 1.0)));
    }
    let id = |row: usize, k: usize| (row * (around + 1) + k) as u32;
    for row in 0..rows {
        for k in 0..around {
            strip.faces.push([id(row, k), id(row, k + 1), id(row + 1, k + 1)]);
            strip.faces.push([id(row, k), id(row + 1, k + 1), id(row + 1, k)]);
        }
    }
    let open = |surface, nodes: Vec<u32>| ChainSpec { surface, nodes, closed: false };
    let column = |k: usize| (0..=rows).map(|row| id(row, k)).collect::<Vec<u32>>();
    let mut joints =
        vec![JointSpec { name: None, chains: vec![open(0, column(0)), open(0, column(around))] }];
    let mut specs = vec![strip];
    for row in 0..=rows {
        if random.below(2) == 0 {
            continue;
        }
        let mut collar = SurfaceSpec { name: format!("collar {row}"), ..SurfaceSpec::default() };
        collar.positions.extend((0..around).map(|k| place(k, row as f64, 1.0)));
        collar.positions.extend((0..around).map(|k| place(k, row as f64 + 0.3, 2.0)));
        for k in 0..around as u32 {
            let n = around as u32;
            let (a, b) = (k, (k + 1) % n);
            collar.faces.extend([[a, b, b + n], [a, b + n, a + n]]);
        }
        let chains = vec![
            open(0, (0..=around).map(|k| id(row, k)).collect()),
            ChainSpec { surface: specs.len(), nodes: (0..around as u32).collect(), closed: true },
        ];
        joints.push(JointSpec { name: None, chains });
        specs.push(collar);
    }
    Body::build(&specs, &joints).unwrap()
}

fn random_body(kind: u8, seed: u64) -> Body {
    let mut random = Random(seed);
    match kind {
        0 => fan(seed, 1 + random.below(6), 1 + random.below(4)),
        1 => tube(seed, 3 + random.below(5), 1 + random.below(3)),
        _ => {
            let cells = [1 + random.below(2), 1 + random.below(2), 1 + random.below(2)];
            let mesh = lattice(seed, cells, 0.3 + 0.7 * random.unit(), 1 + random.below(6));
            Body::from_tri_mesh(&mesh).unwrap()
        }
    }
}

/// What an incomplete surface may hold besides faces: a node that stands alone, a wire between new nodes, one to an old node.
fn add_wires(body: &mut Body, random: &mut Random) {
    let id = SurfaceId(random.below(body.surfaces().len().max(1)) as u32);
    if body.surfaces().len() == 0 {
        return;
    }
    let old = body.surface(id).positions().len();
    let place = |random: &mut Random| DVec3::new(random.unit(), random.unit(), random.unit()) * 9.0 + 20.0;
    let [a, b, c] = [(); 3].map(|()| body.add_node(id, place(random)).unwrap());
    body.add_edge(id, a, b).unwrap();
    if old > 0 {
        let tail = body.add_edge(id, NodeId(random.below(old) as u32), c).unwrap();
        let s = body.surface_mut(id);
        let [p, q] = [0.25, 0.75]
            .map(|u| s.add_attribute_node(AttributeNode::OnEdge { edge: tail, u }).unwrap());
        s.add_attribute_edge(AttributeEdge { name: None, nodes: vec![p, q] }).unwrap();
    }
}

/// Attribute nodes and lines at random places; returns nothing to remember but what `places` reads.
fn add_attributes(body: &mut Body, random: &mut Random) {
    for id in body.surface_ids() {
        let s = body.surface_mut(id);
        let (faces, sides) = (s.faces().len(), s.face_edges().to_vec());
        for _ in 0..2.min(faces) {
            let f = random.below(faces);
            let inside = |random: &mut Random| {
                let (u, v) = (random.unit(), random.unit());
                let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                AttributeNode::InFace { face: FaceId(f as u32), areal: [u, v, 1.0 - u - v] }
            };
            let on = AttributeNode::OnEdge { edge: EdgeId(sides[f][random.below(3)]), u: random.unit() };
            let ends = [0.0, 0.25, 0.5, 1.0][random.below(4)];
            let end = AttributeNode::OnEdge { edge: EdgeId(sides[f][random.below(3)]), u: ends };
            let (first, second) = (inside(random), inside(random));
            let nodes = [on, first, second, end].map(|n| s.add_attribute_node(n).unwrap()).to_vec();
            s.add_attribute_edge(AttributeEdge { name: None, nodes }).unwrap();
        }
    }
}

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
