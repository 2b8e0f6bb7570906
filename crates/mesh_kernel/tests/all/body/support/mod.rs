//! Random bodies with joints, for property tests.

pub(crate) mod operations;
pub(crate) mod sequences;

use mesh_kernel::body::{
    AttributeEdge, AttributeNode, Body, ChainSpec, EdgeId, FaceId, JointSpec, NodeId, SurfaceId, SurfaceSpec,
};
use mesh_kernel::glam::DVec3;
use mesh_kernel::{Group, TriMesh};

/// A small generator: the same sequence for the same seed on every machine.
pub(crate) struct Random(pub u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    pub(crate) fn unit(&mut self) -> f64 {
        self.next() as f64 / (1u64 << 31) as f64
    }
}

/// Squares of a lattice of cells, a random part of them, in random groups, windings and diagonals: T, X and Y joints,
/// closed joints, voids, bow ties, touching nodes, surfaces that meet a joint several times.
pub(crate) fn lattice(seed: u64, cells: [usize; 3], density: f64, groups: usize) -> TriMesh {
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
pub(crate) fn fan(seed: u64, sheets: usize, rows: usize) -> Body {
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
pub(crate) fn tube(seed: u64, around: usize, rows: usize) -> Body {
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

pub(crate) fn random_body(kind: u8, seed: u64) -> Body {
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
pub(crate) fn add_wires(body: &mut Body, random: &mut Random) {
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
        let [p, q] =
            [0.25, 0.75].map(|u| s.add_attribute_node(AttributeNode::OnEdge { edge: tail, u }).unwrap());
        s.add_attribute_edge(AttributeEdge { name: None, nodes: vec![p, q] }).unwrap();
    }
}

/// Attribute nodes and lines at random places; returns nothing to remember but what `places` reads.
pub(crate) fn add_attributes(body: &mut Body, random: &mut Random) {
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
