//! Any mesh to a pattern input: one patch a group and connected part, seams where parts touch.

use mesh_kernel::TriMesh;

use crate::{
    Patch, PatchLine, PatternError, PatternInput, PieceSpec, SeamInput, SeamSide,
    flatten::topology::{DisjointSets, next},
};

/// Settings of [`flatten_mesh`](crate::flatten_mesh).
#[derive(Clone, Debug)]
pub struct FlattenMeshOptions {
    /// Paths of mesh nodes along which the mesh is cut open; consecutive nodes share an edge.
    pub cuts: Vec<Vec<u32>>,
    /// Seam allowance, in millimetres.
    pub allowance_mm: f64,
    /// Everything else.
    pub pattern: crate::PatternOptions,
}

impl Default for FlattenMeshOptions {
    /// No cuts, no allowance, least stretch: the mesh may be anything, not only cloth.
    fn default() -> Self {
        let pattern = crate::PatternOptions { area_weight: 0.0, ..crate::PatternOptions::default() };
        Self { cuts: Vec::new(), allowance_mm: 0.0, pattern }
    }
}

/// A seam side's edge in the seam's direction: patch, local node at its start, local node at its end.
type SideEdge = (u32, u32, u32);

/// Half-edges `h = 3 f + c` of the whole mesh that border on the same welded edge.
struct WeldedEdge {
    uses: Vec<u32>,
}

/// Splits a mesh into patches with seams between them.
///
/// Faces hang together across edges that exactly two faces of one group share in opposite directions. Boundary edges
/// of patches at the same places (same nodes, or nodes of equal coordinates) become seams, one a run. O(n log n).
///
/// # Errors
/// Faces that name missing nodes; an empty mesh; cuts along what is no edge. Everything else is left to
/// [`make`](crate::make).
pub fn input_of_mesh(mesh: &TriMesh, options: &FlattenMeshOptions) -> Result<PatternInput, PatternError> {
    if mesh.faces.is_empty() {
        return Err(PatternError::Empty);
    }
    let nodes = mesh.positions.len();
    for (f, face) in mesh.faces.iter().enumerate() {
        if let Some(&node) = face.iter().find(|&&v| v as usize >= nodes) {
            return Err(PatternError::NodeOutOfRange {
                patch: "mesh".to_owned(),
                what: format!("triangle {f}"),
                node,
                nodes,
            });
        }
    }
    let group = groups_of_faces(mesh);
    let origin = |h: u32| mesh.faces[h as usize / 3][h as usize % 3];
    let welded = weld(mesh);

    // Which faces and corners hang together.
    let halves = 3 * mesh.faces.len() as u32;
    let mut parts = DisjointSets::new(mesh.faces.len());
    let mut fans = DisjointSets::new(halves as usize);
    let mut inner = vec![false; halves as usize];
    let by_nodes = edges_by(halves, |h| (origin(h), origin(next(h))), |h| group[h as usize / 3]);
    for edge in &by_nodes {
        if let [g, h] = edge.uses[..]
            && origin(g) != origin(h)
        {
            parts.join(g / 3, h / 3);
            fans.join(g, next(h));
            fans.join(next(g), h);
            inner[g as usize] = true;
            inner[h as usize] = true;
        }
    }

    // Patches: faces of a part, in order; a node for every fan of corners.
    let mut patch_of_root = vec![u32::MAX; mesh.faces.len()];
    let mut patches: Vec<Patch> = Vec::new();
    let mut patch_of_face = vec![0u32; mesh.faces.len()];
    let mut local = vec![u32::MAX; halves as usize];
    let mut parts_of_group = vec![0usize; mesh.groups.len() + 1];
    let mut group_of_patch = Vec::new();
    for f in 0..mesh.faces.len() {
        let root = parts.root(f as u32) as usize;
        if patch_of_root[root] == u32::MAX {
            patch_of_root[root] = patches.len() as u32;
            parts_of_group[group[f] as usize] += 1;
            group_of_patch.push((group[f] as usize, parts_of_group[group[f] as usize]));
            patches.push(Patch {
                piece: PieceSpec { allowance_mm: options.allowance_mm, ..PieceSpec::default() },
                ..Patch::default()
            });
        }
        let p = patch_of_root[root];
        patch_of_face[f] = p;
        let patch = &mut patches[p as usize];
        let corners = [0, 1, 2].map(|c| {
            let h = 3 * f as u32 + c;
            let fan = fans.root(h) as usize;
            if local[fan] == u32::MAX {
                local[fan] = patch.positions.len() as u32;
                patch.positions.push(mesh.positions[origin(h) as usize]);
            }
            local[h as usize] = local[fan];
            local[fan]
        });
        patch.faces.push(corners);
    }
    for (patch, (g, part)) in patches.iter_mut().zip(group_of_patch) {
        let base = match mesh.groups.get(g) {
            Some(group) if !group.name.is_empty() => group.name.clone(),
            _ => "piece".to_owned(),
        };
        patch.name = if parts_of_group[g] > 1 { format!("{base} {part}") } else { base };
    }

    let seams = seams(mesh, &welded, &inner, &patch_of_face, &local);
    let mut cuts = Vec::new();
    for path in &options.cuts {
        cuts.extend(cut_lines(mesh, path, &by_nodes, &patch_of_face, &local)?);
    }
    Ok(PatternInput { patches, seams, cuts, ..PatternInput::default() })
}

/// Group of every face; faces outside all groups come last.
fn groups_of_faces(mesh: &TriMesh) -> Vec<u32> {
    let mut group = vec![mesh.groups.len() as u32; mesh.faces.len()];
    for (g, run) in mesh.groups.iter().enumerate() {
        for f in run.faces.clone() {
            if let Some(slot) = group.get_mut(f as usize) {
                *slot = g as u32;
            }
        }
    }
    group
}

/// Number of the first node with the same coordinates, for every node.
fn weld(mesh: &TriMesh) -> Vec<u32> {
    let key = |v: u32| mesh.positions[v as usize].to_array().map(|x| (x + 0.0).to_bits());
    let mut order: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    order.sort_unstable_by_key(|&v| (key(v), v));
    let mut first = vec![0u32; order.len()];
    for run in order.chunk_by(|&a, &b| key(a) == key(b)) {
        run.iter().for_each(|&v| first[v as usize] = run[0]);
    }
    first
}

/// Half-edges by class and unordered pair of ends.
fn edges_by(halves: u32, ends: impl Fn(u32) -> (u32, u32), class: impl Fn(u32) -> u32) -> Vec<WeldedEdge> {
    let mut keyed: Vec<(u32, u32, u32, u32)> = (0..halves)
        .map(|h| {
            let (a, b) = ends(h);
            (class(h), a.min(b), a.max(b), h)
        })
        .collect();
    keyed.sort_unstable();
    keyed
        .chunk_by(|x, y| (x.0, x.1, x.2) == (y.0, y.1, y.2))
        .map(|run| WeldedEdge { uses: run.iter().map(|x| x.3).collect() })
        .collect()
}

/// Seams: runs of welded edges at which two or more boundary edges of patches lie.
fn seams(
    mesh: &TriMesh,
    welded: &[u32],
    inner: &[bool],
    patch_of_face: &[u32],
    local: &[u32],
) -> Vec<SeamInput> {
    let halves = 3 * mesh.faces.len() as u32;
    let origin = |h: u32| welded[mesh.faces[h as usize / 3][h as usize % 3] as usize];
    let edges: Vec<WeldedEdge> = edges_by(halves, |h| (origin(h), origin(next(h))), |_| 0)
        .into_iter()
        .filter(|e| e.uses.len() > 1 && e.uses.iter().any(|&h| !inner[h as usize]))
        .map(|mut e| {
            // An inner edge has two half-edges, and is one side.
            e.uses.dedup_by(|h, g| {
                inner[*h as usize]
                    && inner[*g as usize]
                    && patch_of_face[*h as usize / 3] == patch_of_face[*g as usize / 3]
            });
            e
        })
        .filter(|e| e.uses.len() > 1)
        .collect();
    // The uses of an edge in one direction.
    let directed = |e: usize, from: u32| -> Vec<SideEdge> {
        edges[e]
            .uses
            .iter()
            .map(|&h| {
                let (a, b) = (local[h as usize], local[next(h) as usize]);
                let p = patch_of_face[h as usize / 3];
                if origin(h) == from { (p, a, b) } else { (p, b, a) }
            })
            .collect()
    };
    let ends = |e: usize| (origin(edges[e].uses[0]), origin(next(edges[e].uses[0])));
    let mut at: Vec<(u32, usize)> = (0..edges.len()).flat_map(|e| [(ends(e).0, e), (ends(e).1, e)]).collect();
    at.sort_unstable();
    let around = |v: u32| {
        let start = at.partition_point(|x| x.0 < v);
        at[start..].iter().take_while(move |x| x.0 == v).map(|x| x.1)
    };
    // The next edge after `e`, which arrives at `v` with `sides`; its sides in the same order.
    let follow = |e: usize, v: u32, sides: &[SideEdge]| -> Option<(usize, Vec<SideEdge>)> {
        let mut others = around(v).filter(|&g| g != e);
        let (g, None) = (others.next()?, others.next()) else { return None };
        let mut next_sides = directed(g, v);
        if next_sides.len() != sides.len() {
            return None;
        }
        let mut ordered = Vec::with_capacity(sides.len());
        for side in sides {
            let k = next_sides.iter().position(|n| n.0 == side.0 && n.1 == side.2)?;
            ordered.push(next_sides.remove(k));
        }
        Some((g, ordered))
    };
    let mut done = vec![false; edges.len()];
    let mut seams = Vec::new();
    for start in 0..edges.len() {
        if done[start] {
            continue;
        }
        // Back to the run's beginning, then forward.
        let (mut e, (mut from, _)) = (start, ends(start));
        loop {
            let (a, b) = ends(e);
            let to = if a == from { b } else { a };
            let backward = directed(e, to);
            match follow(e, from, &backward) {
                Some((g, _)) if g != start => {
                    let (a, b) = ends(g);
                    from = if a == from { b } else { a };
                    e = g;
                }
                _ => break,
            }
        }
        let mut sides = directed(e, from);
        let mut paths: Vec<SeamSide> =
            sides.iter().map(|s| SeamSide { patch: s.0 as usize, nodes: vec![s.1] }).collect();
        loop {
            done[e] = true;
            for (path, side) in paths.iter_mut().zip(&sides) {
                path.nodes.push(side.2);
            }
            let (a, b) = ends(e);
            from = if a == from { b } else { a };
            match follow(e, from, &sides) {
                Some((g, next_sides)) if !done[g] => {
                    e = g;
                    sides = next_sides;
                }
                _ => break,
            }
        }
        seams.push(SeamInput { name: format!("seam {}", seams.len() + 1), sides: paths });
    }
    seams
}

/// A cut along mesh nodes as cuts of the patches that have these edges inside.
fn cut_lines(
    mesh: &TriMesh,
    path: &[u32],
    edges: &[WeldedEdge],
    patch_of_face: &[u32],
    local: &[u32],
) -> Result<Vec<PatchLine>, PatternError> {
    let origin = |h: u32| mesh.faces[h as usize / 3][h as usize % 3];
    let key = |e: &WeldedEdge| {
        let (a, b) = (origin(e.uses[0]), origin(next(e.uses[0])));
        (a.min(b), a.max(b))
    };
    let mut sorted: Vec<((u32, u32), u32)> =
        edges.iter().flat_map(|e| e.uses.iter().map(move |&h| (key(e), h))).collect();
    sorted.sort_unstable();
    let mut lines: Vec<PatchLine> = Vec::new();
    for pair in path.windows(2) {
        let wanted = (pair[0].min(pair[1]), pair[0].max(pair[1]));
        let start = sorted.partition_point(|x| x.0 < wanted);
        let Some(&(_, h)) = sorted.get(start).filter(|x| x.0 == wanted) else {
            return Err(PatternError::CutNotAlongEdges { a: pair[0], b: pair[1] });
        };
        let (mut a, mut b) = (local[h as usize], local[next(h) as usize]);
        if origin(h) != pair[0] {
            std::mem::swap(&mut a, &mut b);
        }
        let patch = patch_of_face[h as usize / 3] as usize;
        match lines.last_mut() {
            Some(line) if line.patch == patch && line.nodes.last() == Some(&a) => line.nodes.push(b),
            _ => lines.push(PatchLine { patch, nodes: vec![a, b], name: "cut".to_owned() }),
        }
    }
    Ok(lines)
}
