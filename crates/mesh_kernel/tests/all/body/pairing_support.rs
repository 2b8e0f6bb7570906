//! Solids that touch: blocks, hollows, prisms, rings, cells, welded where they meet; and what must hold when they are resolved.

use std::collections::BTreeMap;

use mesh_kernel::body::edit::Editor;
use mesh_kernel::body::{Body, JointId, Pairing, Resolution};
use mesh_kernel::glam::DVec3;
use mesh_kernel::{Group, TriMesh};

use crate::body::support::Random;

/// Faces gathered by group, nodes shared where they coincide.
pub(crate) struct Solids {
    /// 0: all one surface; 1: each solid one; 2: each facet one; 3: faces at random.
    grouping: usize,
    nodes: BTreeMap<[u64; 3], u32>,
    positions: Vec<DVec3>,
    faces: Vec<(usize, [u32; 3])>,
    solids: usize,
    facets: usize,
}

impl Solids {
    pub(crate) fn new(grouping: usize) -> Self {
        let (nodes, positions, faces) = (BTreeMap::new(), Vec::new(), Vec::new());
        Self { grouping, nodes, positions, faces, solids: 0, facets: 0 }
    }

    fn node(&mut self, p: DVec3) -> u32 {
        let key = p.to_array().map(|x| (x + 0.0).to_bits());
        let next = self.positions.len() as u32;
        let id = *self.nodes.entry(key).or_insert(next);
        if id == next {
            self.positions.push(p);
        }
        id
    }

    fn facet(&mut self) {
        self.facets += 1;
    }

    fn face(&mut self, corners: [DVec3; 3]) {
        let face = corners.map(|p| self.node(p));
        let group = match self.grouping {
            0 => 0,
            1 => self.solids,
            _ => self.facets,
        };
        self.faces.push((group, face));
    }

    fn quad(&mut self, [a, b, c, d]: [DVec3; 4]) {
        self.face([a, b, c]);
        self.face([a, c, d]);
    }

    /// A box of unit squares, its normals outward.
    pub(crate) fn block(&mut self, at: [u32; 3], size: [u32; 3]) {
        self.squares(at, size, false);
    }

    /// The same with normals inward.
    pub(crate) fn hollow(&mut self, at: [u32; 3], size: [u32; 3]) {
        self.squares(at, size, true);
    }

    fn squares(&mut self, at: [u32; 3], size: [u32; 3], inward: bool) {
        self.solids += 1;
        for axis in 0..3 {
            let (u, w) = ((axis + 1) % 3, (axis + 2) % 3);
            for far in [false, true] {
                self.facet();
                for i in 0..size[u] {
                    for j in 0..size[w] {
                        let corner = |di: u32, dj: u32| {
                            let mut p = [0u32; 3];
                            p[axis] = at[axis] + if far { size[axis] } else { 0 };
                            p[u] = at[u] + i + di;
                            p[w] = at[w] + j + dj;
                            DVec3::from(p.map(f64::from))
                        };
                        let mut square = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                        if far == inward {
                            square.reverse();
                        }
                        self.quad(square);
                    }
                }
            }
        }
    }

    /// A prism over a triangle that turns anticlockwise seen from where it is drawn to; with no steps the tetrahedron
    /// over the triangle to a point in the middle above.
    pub(crate) fn prism(&mut self, base: [DVec3; 3], step: DVec3, steps: u32) {
        if steps == 0 {
            let [a, b, c] = base;
            let top = (a + b + c) / 3.0 + (b - a).cross(c - a).normalize() * 0.5;
            self.tetrahedron(a, [b, c, top]);
            return;
        }
        self.solids += 1;
        let [a, b, c] = base;
        self.facet();
        self.face([a, c, b]);
        self.facet();
        self.face([a, b, c].map(|p| p + step * f64::from(steps)));
        for (p, q) in [(a, b), (b, c), (c, a)] {
            self.facet();
            for k in 0..steps {
                let [low, high] = [k, k + 1].map(|k| step * f64::from(k));
                self.quad([p + low, q + low, q + high, p + high]);
            }
        }
    }

    /// A tetrahedron, outward whichever way its corners turn.
    pub(crate) fn tetrahedron(&mut self, a: DVec3, [b, c, d]: [DVec3; 3]) {
        self.solids += 1;
        let (b, c) = if (b - a).cross(c - a).dot(d - a) > 0.0 { (b, c) } else { (c, b) };
        for face in [[a, c, b], [a, b, d], [b, c, d], [a, d, c]] {
            self.facet();
            self.face(face);
        }
    }

    /// A ring of `n` pieces about z, of rectangular section.
    pub(crate) fn ring(&mut self, n: u32, r: [f64; 2], z: [f64; 2]) {
        self.solids += 1;
        let section = [(r[0], z[0]), (r[1], z[0]), (r[1], z[1]), (r[0], z[1])];
        let place = |k: u32, (r, z): (f64, f64)| {
            let a = std::f64::consts::TAU * f64::from(k % n) / f64::from(n);
            DVec3::new(r * a.cos(), r * a.sin(), z)
        };
        for i in 0..4 {
            self.facet();
            let (p, q) = (section[i], section[(i + 1) % 4]);
            for k in 0..n {
                self.quad([place(k, p), place(k + 1, p), place(k + 1, q), place(k, q)]);
            }
        }
    }

    pub(crate) fn body(self) -> Body {
        let body = self.unchecked();
        sound(&body);
        body
    }

    /// Solids may run through each other.
    pub(crate) fn unchecked(mut self) -> Body {
        self.faces.sort_by_key(|f| f.0);
        let mut mesh = TriMesh { positions: self.positions, ..TriMesh::default() };
        for (group, face) in self.faces {
            let (at, name) = (mesh.faces.len() as u32, group.to_string());
            if mesh.groups.last().is_none_or(|g| g.name != name) {
                mesh.groups.push(Group { name, faces: at..at });
            }
            mesh.faces.push(face);
            mesh.groups.last_mut().unwrap().faces.end = at + 1;
        }
        Body::from_tri_mesh(&mesh).unwrap()
    }
}

/// Components, cycles and voids.
pub(crate) fn counts(body: &Body) -> (i64, i64, i64) {
    let counts = body.counts();
    assert!(counts.identity_holds(), "{counts}");
    (counts.c, counts.ch, counts.cc)
}

pub(crate) fn sound(body: &Body) {
    assert_eq!(body.check(), []);
    assert!(body.counts().identity_holds());
}

/// Every node with several fans resolved; edges must be already.
pub(crate) fn all_resolved(body: &Body, pairing: Pairing) -> Body {
    let mut body = body.clone();
    let (volume, nodes) = (body.volume(), body.non_manifold_nodes());
    for (surface, node) in nodes {
        let fans = body.node_fans(surface, node).unwrap().fans.len() as i64;
        let done = body.resolve_node(surface, node, pairing).unwrap();
        sound(&done.body);
        assert!(fans > 1);
        body = done.body;
    }
    if let (Some(a), Some(b)) = (volume, body.volume()) {
        assert!((a - b).abs() <= 1e-12 * a.abs(), "{a} {b}");
    }
    body
}

/// Which cells of a lattice are full; all around is empty.
pub(crate) struct Cells {
    size: [usize; 3],
    full: Vec<bool>,
}

impl Cells {
    fn at(&self, p: [i64; 3]) -> bool {
        (0..3).all(|i| p[i] >= 0 && (p[i] as usize) < self.size[i])
            && self.full[(p[2] as usize * self.size[1] + p[1] as usize) * self.size[0] + p[0] as usize]
    }

    /// Connected parts of full or of empty cells, where cells are neighbours that differ by one in at most `many`
    /// coordinates: 1 through faces, 2 through edges as well.
    pub(crate) fn parts(&self, full: bool, many: i64) -> usize {
        let [nx, ny, nz] = self.size.map(|n| n as i64);
        let mut left: std::collections::BTreeSet<[i64; 3]> = (-1..=nx)
            .flat_map(|x| (-1..=ny).flat_map(move |y| (-1..=nz).map(move |z| [x, y, z])))
            .filter(|p| self.at(*p) == full)
            .collect();
        let mut parts = 0;
        while let Some(seed) = left.pop_first() {
            parts += 1;
            let mut stack = vec![seed];
            while let Some(p) = stack.pop() {
                for code in 0..27i64 {
                    let d = [code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1];
                    if d.iter().map(|x| x.abs()).sum::<i64>() <= many {
                        let q = [p[0] + d[0], p[1] + d[1], p[2] + d[2]];
                        if left.remove(&q) {
                            stack.push(q);
                        }
                    }
                }
            }
        }
        parts
    }
}

/// Random cells of a lattice with jittered corners, as a solid: faces between full and empty cells.
pub(crate) fn cells(random: &mut Random, size: [usize; 3], grouping: usize) -> (Body, Cells) {
    let mut full: Vec<bool> = (0..size.iter().product()).map(|_| random.below(2) == 0).collect();
    full[0] |= !full.contains(&true);
    let cells = Cells { size, full };
    let [nx, ny, nz] = size.map(|n| n as i64 + 1);
    let jitter: Vec<DVec3> =
        (0..nx * ny * nz).map(|_| DVec3::new(random.unit(), random.unit(), random.unit()) * 0.2).collect();
    let place = |p: [i64; 3]| {
        DVec3::new(p[0] as f64, p[1] as f64, p[2] as f64) + jitter[((p[2] * ny + p[1]) * nx + p[0]) as usize]
    };
    let mut solids = Solids::new(grouping);
    for axis in 0..3 {
        let (u, w) = ((axis + 1) % 3, (axis + 2) % 3);
        for x in 0..nx {
            for y in 0..ny {
                for z in 0..nz {
                    let p = [x, y, z];
                    let mut before = p;
                    before[axis] -= 1;
                    if cells.at(p) == cells.at(before) {
                        continue;
                    }
                    let corner = |du: i64, dw: i64| {
                        let mut q = p;
                        q[u] += du;
                        q[w] += dw;
                        place(q)
                    };
                    let mut square = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                    if cells.at(p) {
                        square.reverse();
                    }
                    solids.facets = if grouping == 3 { random.below(4) } else { solids.facets + 1 };
                    solids.quad(square);
                }
            }
        }
    }
    (solids.body(), cells)
}

/// Resolves, and checks what must hold whatever the choice.
pub(crate) fn resolve_edge(body: &Body, joint: JointId, pairing: Pairing) -> Resolution {
    let done = body.resolve_edge(joint, pairing).unwrap();
    kept(body, &done);
    let edges = body.joint_len(joint) as i64;
    let pairs = body.joint(joint).radial().len() as i64 / 2;
    assert_eq!(done.after.e - done.before.e, (pairs - 1) * edges);
    // The same as an operator: undone and done again, bit for bit.
    let mut editor = Editor::new(body.clone());
    editor.resolve_edge(joint, pairing).unwrap();
    assert_eq!(editor.body(), &done.body);
    assert!(editor.undo() && editor.body() == body && editor.redo());
    assert_eq!(editor.body(), &done.body);
    done
}

pub(crate) fn kept(body: &Body, done: &Resolution) {
    sound(&done.body);
    assert_eq!((done.before, done.after), (body.counts(), done.body.counts()));
    assert!(done.before.identity_holds() && done.after.identity_holds());
    assert_eq!(done.after.f, done.before.f);
    match (body.volume(), done.body.volume()) {
        (Some(a), Some(b)) => assert!((a - b).abs() <= 1e-12 * a.abs(), "{a} {b}"),
        (a, b) => assert_eq!(a, b),
    }
    for (old, new) in done.joints.iter().enumerate() {
        if let Some(new) = new {
            assert_eq!(body.joint(JointId(old as u32)).radial().len(), done.body.joint(*new).radial().len());
        }
    }
    for &pair in &done.pairs {
        assert!(done.body.alternates(pair) && done.body.joint(pair).radial().len() == 2);
    }
}

pub(crate) fn volumes(body: &Body) -> Vec<f64> {
    let mut volumes: Vec<f64> = body.regions().regions().iter().filter_map(|r| r.volume).collect();
    volumes.sort_by(f64::total_cmp);
    volumes
}

pub(crate) fn near(a: &[f64], b: &[f64]) {
    assert!(a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12), "{a:?} {b:?}");
}

pub(crate) fn only_joint(body: &Body) -> JointId {
    let found = body.non_manifold_joints();
    assert_eq!(found.len(), 1);
    found[0]
}
