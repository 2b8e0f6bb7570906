//! A body from a mesh of which nothing is known: groups become surfaces, what is not manifold becomes joints.

use std::collections::BTreeMap;

use super::Body;
use super::adjacency::EdgeIndex;
use super::build::BuildError;
use super::ids::{EdgeId, NONE};
use super::mesh_joints::{touching_nodes, trace_joints};
use super::surface::{NO_CHAIN, Surface};
use super::weld::UnionFind;
use crate::TriMesh;

/// Sides of faces by the mesh's edges: side `3f + i` of face `f` lies on edge `of_side[3f + i]`.
pub(super) struct MeshEdges {
    pub(super) of_side: Vec<u32>,
    pub(super) nodes: Vec<[u32; 2]>,
    /// The first two sides of every edge.
    pairs: Vec<[u32; 2]>,
    /// All sides of edges with more than two.
    many: BTreeMap<u32, Vec<u32>>,
}

impl MeshEdges {
    fn new(mesh: &TriMesh) -> Self {
        let expected = mesh.faces.len() * 3 / 2 + 8;
        let mut index = EdgeIndex::new(mesh.positions.len(), &[]);
        let mut edges = Self {
            of_side: Vec::with_capacity(mesh.faces.len() * 3),
            nodes: Vec::with_capacity(expected),
            pairs: Vec::with_capacity(expected),
            many: BTreeMap::new(),
        };
        for &[a, b, c] in &mesh.faces {
            for (p, q) in [(a, b), (b, c), (c, a)] {
                let side = edges.of_side.len() as u32;
                let Some(EdgeId(e)) = index.find(p, q) else {
                    edges.of_side.push(edges.nodes.len() as u32);
                    index.push(p, q);
                    edges.nodes.push([p, q]);
                    edges.pairs.push([side, NONE]);
                    continue;
                };
                edges.of_side.push(e);
                let pair = &mut edges.pairs[e as usize];
                if pair[1] == NONE {
                    pair[1] = side;
                } else {
                    edges.many.entry(e).or_insert_with(|| pair.to_vec()).push(side);
                }
            }
        }
        edges
    }

    pub(super) fn sides(&self, e: u32) -> &[u32] {
        let pair = &self.pairs[e as usize];
        if pair[1] == NONE {
            return &pair[..1];
        }
        if self.many.is_empty() { pair } else { self.many.get(&e).map_or(pair, Vec::as_slice) }
    }
}

/// How one surface meets an edge that is to be a joint's: by both faces of an inner edge, or by one face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct EdgeUse {
    pub(super) group: u32,
    pub(super) inner: bool,
    /// A side of a face of it.
    pub(super) side: u32,
}

impl Body {
    /// Makes a body of a mesh: every group a surface (faces of no group one more), a joint wherever groups share edges,
    /// three or more faces meet, or two faces of one group are wound differently at an edge. Joints run from branching
    /// to branching. Where surfaces touch at a node only, a joint without edges holds them together.
    ///
    /// Nodes without faces are left out. Joints are numbered in the order of the mesh's edges, and have no names.
    ///
    /// # Errors
    /// Faces that name a node twice or one that does not exist; coordinates that are not finite; too many faces.
    /// O(faces).
    pub fn from_tri_mesh(mesh: &TriMesh) -> Result<Self, BuildError> {
        check_input(mesh)?;
        if mesh.groups.len() < 2
            && let Some(surface) = one_surface(mesh)
        {
            return Self::assemble(vec![surface], Vec::new());
        }
        let groups = Groups::new(mesh);
        let edges = MeshEdges::new(mesh);
        let (uses, joint_edges) = edge_uses(&edges, &groups, mesh);
        // Corners of a face that are one node of the surface.
        let copies = Copies::new(mesh, &groups, &edges, &uses, &joint_edges);
        let surfaces = make_surfaces(mesh, &groups, &copies, &edges, (&uses, &joint_edges));
        let mut joints = trace_joints(mesh, &groups, &edges, &uses, &surfaces);
        joints.extend(touching_nodes(mesh, &groups, &copies, &surfaces, &joints));
        Self::assemble(surfaces, joints)
    }
}

fn check_input(mesh: &TriMesh) -> Result<(), BuildError> {
    let (nodes, faces) = (mesh.positions.len(), mesh.faces.len());
    let surface_of = |f: usize| {
        let group = mesh.groups.iter().find(|g| g.faces.contains(&(f as u32)));
        group.map_or(String::new(), |g| g.name.clone())
    };
    if nodes >= NONE as usize || faces >= (1 << 31) / 3 {
        return Err(BuildError::TooLarge { surface: surface_of(0), faces, nodes });
    }
    for (f, face) in mesh.faces.iter().enumerate() {
        if let Some(&node) = face.iter().find(|&&v| v as usize >= nodes) {
            return Err(BuildError::NodeOutOfRange { surface: surface_of(f), face: f as u32, node, nodes });
        }
        let [a, b, c] = *face;
        if a == b || b == c || c == a {
            let nodes = face.map(|v| v as usize + 1);
            return Err(BuildError::RepeatedCorner { group: surface_of(f), triangle: f + 1, nodes });
        }
    }
    if let Some(v) = mesh.positions.iter().position(|p| !p.is_finite()) {
        let position = mesh.positions[v];
        return Err(BuildError::NotFinite { surface: surface_of(0), node: v as u32, position });
    }
    Ok(())
}

/// The mesh as one surface, its nodes in their order, if nothing in it calls for a joint. `None` where edges have more
/// than two faces or faces are wound differently, or the one group leaves faces out.
fn one_surface(mesh: &TriMesh) -> Option<Surface> {
    let name = match &mesh.groups[..] {
        [] => String::new(),
        [group] if group.faces == (0..mesh.faces.len() as u32) => group.name.clone(),
        _ => return None,
    };
    if mesh.faces.is_empty() {
        return None;
    }
    let mut surface = Surface { name, faces: mesh.faces.clone(), ..Surface::default() };
    let mut used = vec![false; mesh.positions.len()];
    mesh.faces.iter().flatten().for_each(|&v| used[v as usize] = true);
    if used.iter().all(|u| *u) {
        surface.positions.clone_from(&mesh.positions);
    } else {
        let mut numbers = vec![NONE; mesh.positions.len()];
        for v in (0..used.len()).filter(|&v| used[v]) {
            numbers[v] = surface.positions.len() as u32;
            surface.positions.push(mesh.positions[v]);
        }
        surface.faces.iter_mut().for_each(|f| *f = f.map(|v| numbers[v as usize]));
    }
    surface.build_edges().is_ok().then_some(surface)
}

/// The surface of every face.
pub(super) struct Groups {
    names: Vec<String>,
    pub(super) of_face: Vec<u32>,
    /// Number of every face within its surface.
    pub(super) local: Vec<u32>,
}

impl Groups {
    fn new(mesh: &TriMesh) -> Self {
        let mut of_face = vec![NONE; mesh.faces.len()];
        let mut names = Vec::new();
        for group in &mesh.groups {
            let range = group.faces.start as usize..(group.faces.end as usize).min(mesh.faces.len());
            if range.is_empty() {
                continue;
            }
            of_face[range].fill(names.len() as u32);
            names.push(group.name.clone());
        }
        if of_face.contains(&NONE) {
            let rest = names.len() as u32;
            of_face.iter_mut().filter(|g| **g == NONE).for_each(|g| *g = rest);
            names.push(String::new());
        }
        let mut counts = vec![0; names.len()];
        let local = of_face
            .iter()
            .map(|&g| {
                counts[g as usize] += 1;
                counts[g as usize] - 1
            })
            .collect();
        Self { names, of_face, local }
    }
}

/// For every edge that is to be on a joint, how surfaces meet it.
pub(super) type Uses = BTreeMap<u32, Vec<EdgeUse>>;

fn edge_uses(edges: &MeshEdges, groups: &Groups, mesh: &TriMesh) -> (Uses, Vec<bool>) {
    let group = |side: u32| groups.of_face[side as usize / 3];
    let start = |side: u32| mesh.faces[side as usize / 3][side as usize % 3];
    let mut uses = BTreeMap::new();
    let mut on_joint = vec![false; edges.nodes.len()];
    for e in 0..edges.nodes.len() as u32 {
        let sides = edges.sides(e);
        let manifold = match sides {
            [_] => true,
            &[s, t] => group(s) == group(t) && start(s) != start(t),
            _ => false,
        };
        if manifold {
            continue;
        }
        on_joint[e as usize] = true;
        let mut list: Vec<EdgeUse> = Vec::with_capacity(sides.len());
        for &s in sides {
            let g = group(s);
            let own = || sides.iter().filter(|&&t| group(t) == g);
            // Two faces wound alike stay together as an inner edge; any other number is cut.
            let inner = own().count() == 2 && own().any(|&t| start(t) != start(s));
            if !(inner && list.iter().any(|u| u.group == g)) {
                list.push(EdgeUse { group: g, inner, side: s });
            }
        }
        uses.insert(e, list);
    }
    (uses, on_joint)
}

/// Which corners of faces are one node of their surface: at nodes without joint edges all of a group; at nodes with, those
/// connected through edges that stay whole.
pub(super) struct Copies {
    /// The corner `3f + i` that stands for corner `3f + i`.
    pub(super) set: Vec<u32>,
}

impl Copies {
    fn new(mesh: &TriMesh, groups: &Groups, edges: &MeshEdges, uses: &Uses, joint_edges: &[bool]) -> Self {
        let corners = mesh.faces.len() * 3;
        let mut at_joint = vec![false; mesh.positions.len()];
        for &e in uses.keys() {
            edges.nodes[e as usize].iter().for_each(|&v| at_joint[v as usize] = true);
        }
        // Corners at joint nodes, in order, and their places.
        let node = |c: usize| mesh.faces[c / 3][c % 3];
        let group = |c: u32| groups.of_face[c as usize / 3];
        let listed: Vec<u32> = (0..corners as u32).filter(|&c| at_joint[node(c as usize) as usize]).collect();
        let mut place = vec![NONE; if listed.is_empty() { 0 } else { corners }];
        for (k, &c) in listed.iter().enumerate() {
            place[c as usize] = k as u32;
        }
        let mut sets = UnionFind::new(listed.len());
        let corner_at =
            |f: u32, v: u32| 3 * f + mesh.faces[f as usize].iter().position(|&n| n == v).unwrap_or(0) as u32;
        let mut join = |s: u32, t: u32| {
            for v in [node(s as usize), mesh.faces[s as usize / 3][(s as usize + 1) % 3]] {
                if at_joint[v as usize] {
                    let [p, q] = [s, t].map(|side| place[corner_at(side / 3, v) as usize]);
                    sets.union(p, q);
                }
            }
        };
        // Through edges that stay whole.
        let mut done = vec![false; edges.nodes.len()];
        for &c in &listed {
            let f = c / 3 * 3;
            for side in [c, f + (c + 2) % 3] {
                let e = edges.of_side[side as usize];
                if std::mem::replace(&mut done[e as usize], true) {
                    continue;
                }
                match uses.get(&e) {
                    None => {
                        if let &[s, t] = edges.sides(e) {
                            join(s, t);
                        }
                    }
                    Some(list) => {
                        for u in list.iter().filter(|u| u.inner) {
                            for &t in edges.sides(e) {
                                if t != u.side && group(t) == u.group {
                                    join(u.side, t);
                                }
                            }
                        }
                    }
                }
            }
        }
        // Fans of one surface that meet at a node only stay one node, unless joints cut them apart there.
        let mut cut = vec![false; listed.len()];
        for (k, &c) in listed.iter().enumerate() {
            let f = c / 3 * 3;
            if [c, f + (c + 2) % 3].iter().any(|&side| joint_edges[edges.of_side[side as usize] as usize]) {
                let root = sets.find(k as u32);
                cut[root as usize] = true;
            }
        }
        let mut first: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        for (k, &c) in listed.iter().enumerate() {
            let root = sets.find(k as u32);
            if root != k as u32 {
                continue;
            }
            let own = (group(c), node(c as usize));
            match first.get(&own) {
                None => {
                    first.insert(own, root);
                }
                Some(&other) if !cut[root as usize] || !cut[other as usize] => {
                    let both = cut[root as usize] || cut[other as usize];
                    sets.union(root, other);
                    let joined = sets.find(root);
                    cut[joined as usize] = both;
                    first.insert(own, joined);
                }
                Some(_) => {}
            }
        }
        // The first corner of a group at a node without joints stands for all.
        let mut of_node = vec![NONE; mesh.positions.len()];
        let mut others: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        let set = (0..corners as u32)
            .map(|c| {
                let v = node(c as usize);
                if at_joint[v as usize] {
                    return listed[sets.find(place[c as usize]) as usize];
                }
                let there = &mut of_node[v as usize];
                if *there == NONE {
                    *there = c;
                }
                if group(*there) == group(c) { *there } else { *others.entry((group(c), v)).or_insert(c) }
            })
            .collect();
        Self { set }
    }
}

/// A surface a group; sides on cut edges get edges of their own. Edges are numbered as [`Surface::build_edges`] would, in
/// the order in which the faces name them first, but found by those of the mesh.
fn make_surfaces(
    mesh: &TriMesh,
    groups: &Groups,
    copies: &Copies,
    edges: &MeshEdges,
    (uses, joint_edges): (&Uses, &[bool]),
) -> Vec<Surface> {
    let mut sizes = vec![0; groups.names.len()];
    groups.of_face.iter().for_each(|&g| sizes[g as usize] += 1);
    let mut surfaces: Vec<Surface> = groups
        .names
        .iter()
        .zip(sizes)
        .map(|(name, faces)| Surface {
            name: name.clone(),
            faces: Vec::with_capacity(faces),
            face_edges: Vec::with_capacity(faces),
            ..Surface::default()
        })
        .collect();
    let mut numbers = vec![NONE; copies.set.len()];
    // The surface's number of an edge inside it; of an edge that several surfaces have, by surface.
    let mut own = vec![NONE; edges.nodes.len()];
    let mut shared: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    for (f, face) in mesh.faces.iter().enumerate() {
        let g = groups.of_face[f];
        let s = &mut surfaces[g as usize];
        let local = s.faces.len() as u32;
        let nodes = [0, 1, 2].map(|i| {
            let number = &mut numbers[copies.set[3 * f + i] as usize];
            if *number == NONE {
                *number = s.positions.len() as u32;
                s.positions.push(mesh.positions[face[i] as usize]);
            }
            *number
        });
        let sides = [0, 1, 2].map(|i| {
            let e = edges.of_side[3 * f + i];
            let next = s.edges.len() as u32;
            let known = if !joint_edges[e as usize] {
                std::mem::replace(&mut own[e as usize], next)
            } else if uses[&e].iter().any(|u| u.group == g && u.inner) {
                shared.insert((e, g), next).unwrap_or(NONE)
            } else {
                NONE
            };
            if known == NONE {
                s.edges.push([nodes[i], nodes[(i + 1) % 3]]);
                s.edge_faces.push([local, NONE]);
                return next;
            }
            // The second and last face of the edge; it runs the other way.
            s.edge_faces[known as usize][1] = local;
            known
        });
        s.faces.push(nodes);
        s.face_edges.push(sides);
    }
    for s in &mut surfaces {
        s.edge_chain = vec![NO_CHAIN; s.edges.len()];
    }
    surfaces
}
