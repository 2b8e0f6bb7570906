//! The topological graph (T3): layout and node positions made into triangle patches, facing outward, slit where asked.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::error::TemplateError;
use crate::layout::{Cell, Layout};
use crate::skin::Skin;

/// A patch with its own node numbers.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    /// Template node of each local node. A slit gives one template node several local ones.
    pub(crate) nodes: Vec<u32>,
    /// Faces over local nodes, anticlockwise seen from outside.
    pub(crate) faces: Vec<[u32; 3]>,
}

/// Angles below this are reported, radians (8°).
const SHARP: f64 = 0.14;

/// All patches. `warnings` takes sharp angles and slivers.
pub(crate) fn patches(
    layout: &Layout,
    positions: &[DVec3],
    skin: &Skin,
    warnings: &mut Vec<String>,
) -> Result<Vec<Patch>, TemplateError> {
    let wanted = line_edges(layout);
    // Faces over template nodes; twins take the image of their source, so that both have the same diagonals.
    let mut faces: Vec<Vec<[u32; 3]>> = Vec::with_capacity(layout.surfaces.len());
    for surface in &layout.surfaces {
        let image = |list: &[[u32; 3]]| -> Vec<[u32; 3]> {
            let twin = |n: u32| layout.nodes[n as usize].twin.unwrap_or(n);
            list.iter().map(|[a, b, c]| [twin(*a), twin(*c), twin(*b)]).collect()
        };
        if let Some(source) = surface.made_from {
            let list = image(&faces[source as usize]);
            faces.push(list);
            continue;
        }
        let mut list: Vec<[u32; 3]> = Vec::new();
        for cell in &surface.cells {
            match *cell {
                Cell::Triangle(t) => list.push(t),
                Cell::Quad(q) => list.extend(split_quad(q, positions, &wanted)),
            }
        }
        if faces_inward(&list, positions, skin) {
            list.iter_mut().for_each(|f| f.swap(1, 2));
        }
        if surface.across_centre {
            let other = image(&list);
            let sorted = |f: &[u32; 3]| {
                let mut s = *f;
                s.sort_unstable();
                s
            };
            // A face on the centre plane or listed on both sides is its own image.
            let have: BTreeSet<[u32; 3]> = list.iter().map(sorted).collect();
            list.extend(other.into_iter().filter(|f| !have.contains(&sorted(f))));
        }
        faces.push(list);
    }
    let mut out = Vec::with_capacity(faces.len());
    for (surface, list) in layout.surfaces.iter().zip(&faces) {
        let name = |n: u32| layout.nodes[n as usize].name.as_str();
        check_manifold(&surface.name, list, &name)?;
        if surface.made_from.is_none() {
            warn_shapes(&surface.name, list, positions, &name, warnings);
        }
        let mut slits = BTreeSet::new();
        for line in &surface.open_along {
            let line = &layout.lines[*line as usize];
            slits.extend(chain_edges(&line.nodes, line.closed));
        }
        out.push(slit(list, &slits));
    }
    Ok(out)
}

/// Undirected edges of a chain of nodes.
pub(crate) fn chain_edges(nodes: &[u32], closed: bool) -> Vec<[u32; 2]> {
    let mut out: Vec<[u32; 2]> = nodes.windows(2).map(|w| [w[0].min(w[1]), w[0].max(w[1])]).collect();
    if closed && let (Some(a), Some(b)) = (nodes.first(), nodes.last()) {
        out.push([*a.min(b), *a.max(b)]);
    }
    out
}

fn line_edges(layout: &Layout) -> BTreeSet<[u32; 2]> {
    let mut out: BTreeSet<[u32; 2]> =
        layout.lines.iter().flat_map(|l| chain_edges(&l.nodes, l.closed)).collect();
    let index: BTreeMap<&str, u32> =
        layout.nodes.iter().enumerate().map(|(i, n)| (n.name.as_str(), i as u32)).collect();
    for joint in layout.joints.iter().flatten() {
        let nodes: Vec<u32> = joint.nodes.iter().filter_map(|n| index.get(n.as_str()).copied()).collect();
        out.extend(chain_edges(&nodes, joint.closed));
    }
    out
}

/// Smallest angle of a triangle, radians; 0 for a degenerate one.
fn smallest_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let angle = |p: DVec3, q: DVec3, r: DVec3| {
        let (u, v) = (q - p, r - p);
        u.cross(v).length().atan2(u.dot(v))
    };
    angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b))
}

/// The diagonal 0–2 unless a line runs along 1–3, or 1–3 makes clearly better triangles.
fn split_quad([a, b, c, d]: [u32; 4], positions: &[DVec3], wanted: &BTreeSet<[u32; 2]>) -> [[u32; 3]; 2] {
    let has = |p: u32, q: u32| wanted.contains(&[p.min(q), p.max(q)]);
    let place = |t: [u32; 3]| smallest_angle(t.map(|n| positions[n as usize]));
    let first = [[a, b, c], [a, c, d]];
    let second = [[a, b, d], [b, c, d]];
    if has(a, c) {
        return first;
    }
    if has(b, d) {
        return second;
    }
    let worst = |pair: [[u32; 3]; 2]| place(pair[0]).min(place(pair[1]));
    if worst(second) > 1.2 * worst(first) + 0.02 { second } else { first }
}

/// Whether more of the patch's area looks to the body than away from it.
fn faces_inward(faces: &[[u32; 3]], positions: &[DVec3], skin: &Skin) -> bool {
    let mut flux = 0.0;
    for f in faces {
        let [a, b, c] = f.map(|n| positions[n as usize]);
        let sight = skin.look((a + b + c) / 3.0);
        flux += (b - a).cross(c - a).dot(sight.normal);
    }
    flux < 0.0
}

fn check_manifold<'n>(
    surface: &str,
    faces: &[[u32; 3]],
    name: &dyn Fn(u32) -> &'n str,
) -> Result<(), TemplateError> {
    let mut sides: BTreeMap<[u32; 2], [u32; 2]> = BTreeMap::new();
    for f in faces {
        for i in 0..3 {
            let (a, b) = (f[i], f[(i + 1) % 3]);
            let count = sides.entry([a.min(b), a.max(b)]).or_default();
            count[usize::from(a > b)] += 1;
        }
    }
    for ([a, b], [forth, back]) in sides {
        let problem = if forth + back > 2 {
            format!(
                "{} faces meet at the edge {}–{}; a surface has two at most: make several surfaces of it, they join by themselves",
                forth + back,
                name(a),
                name(b)
            )
        } else if forth > 1 || back > 1 {
            format!(
                "the faces at the edge {}–{} turn different ways; list their nodes in the same sense",
                name(a),
                name(b)
            )
        } else {
            continue;
        };
        return Err(TemplateError::BadSurface { surface: surface.into(), problem });
    }
    Ok(())
}

fn warn_shapes<'n>(
    surface: &str,
    faces: &[[u32; 3]],
    positions: &[DVec3],
    name: &dyn Fn(u32) -> &'n str,
    warnings: &mut Vec<String>,
) {
    let mut sharp: Vec<(f64, [u32; 3])> = faces
        .iter()
        .map(|f| (smallest_angle(f.map(|n| positions[n as usize])), *f))
        .filter(|s| s.0 < SHARP)
        .collect();
    sharp.sort_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((angle, [a, b, c])) = sharp.first() {
        warnings.push(format!(
            "surface `{surface}`: {} sharp triangle(s), the sharpest ({}, {}, {}) with {:.1}°",
            sharp.len(),
            name(*a),
            name(*b),
            name(*c),
            angle.to_degrees()
        ));
    }
}

/// Numbers nodes locally and gives every side of a slit its own copies.
fn slit(faces: &[[u32; 3]], slits: &BTreeSet<[u32; 2]>) -> Patch {
    // Corners that are one node: same template node, and faces that follow each other round it over uncut edges.
    let corner_count = 3 * faces.len();
    let mut parent: Vec<u32> = (0..corner_count as u32).collect();
    fn root(parent: &mut [u32], mut i: u32) -> u32 {
        while parent[i as usize] != i {
            parent[i as usize] = parent[parent[i as usize] as usize];
            i = parent[i as usize];
        }
        i
    }
    let mut at_edge: BTreeMap<[u32; 2], Vec<(u32, u32)>> = BTreeMap::new();
    let mut at_node: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (f, face) in faces.iter().enumerate() {
        for i in 0..3 {
            let (ci, cj) = (3 * f + i, 3 * f + (i + 1) % 3);
            let (a, b) = (face[i], face[(i + 1) % 3]);
            at_node.entry(a).or_default().push(ci as u32);
            let (key, ends) =
                if a < b { ([a, b], (ci as u32, cj as u32)) } else { ([b, a], (cj as u32, ci as u32)) };
            at_edge.entry(key).or_default().push(ends);
        }
    }
    let mut join = |a: u32, b: u32| {
        let (a, b) = (root(&mut parent, a), root(&mut parent, b));
        parent[a.max(b) as usize] = a.min(b);
    };
    if slits.is_empty() {
        for corners in at_node.values() {
            corners.windows(2).for_each(|w| join(w[0], w[1]));
        }
    } else {
        let touched: BTreeSet<u32> = slits.iter().flatten().copied().collect();
        for (node, corners) in &at_node {
            if !touched.contains(node) {
                corners.windows(2).for_each(|w| join(w[0], w[1]));
            }
        }
        for (edge, uses) in &at_edge {
            if let [(a, b), (c, d)] = uses[..]
                && !slits.contains(edge)
            {
                join(a, c);
                join(b, d);
            }
        }
    }
    let mut local = vec![u32::MAX; corner_count];
    let mut nodes = Vec::new();
    let mut out = Vec::with_capacity(faces.len());
    for (f, face) in faces.iter().enumerate() {
        out.push([0, 1, 2].map(|i| {
            let r = root(&mut parent, (3 * f + i) as u32) as usize;
            if local[r] == u32::MAX {
                local[r] = nodes.len() as u32;
                nodes.push(face[i]);
            }
            local[r]
        }));
    }
    Patch { nodes, faces: out }
}
