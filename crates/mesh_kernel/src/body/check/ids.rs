//! Array lengths, and ids that name something.

use super::Defect;
use crate::body::attribute::AttributeNode;
use crate::body::slots::Slots;
use crate::body::{Body, EdgeId, NONE, Surface, SurfaceId};

pub(super) fn check(body: &Body, defects: &mut Vec<Defect>) {
    for (id, s) in body.surfaces() {
        lengths(id, s, defects);
        slots(id, s, defects);
        surface_ids(body, id, s, defects);
    }
    free(None, "joint", &body.joint_slots, body.joints.len(), |j| body.joints[j].uses.is_empty(), defects);
    for (id, joint) in body.joints() {
        for u in &joint.uses {
            let of = || format!("joint {id}");
            let surfaces = Numbers::below(body.surfaces.len());
            if named(of, "surface", u.surface.0, surfaces, defects) {
                let s = body.surface(u.surface);
                named(of, "chain", u.chain.0, Numbers::of(s.chains.len(), &s.slots.chains), defects);
            }
        }
        for sheet in &joint.radial {
            let uses = Numbers::below(joint.uses.len());
            named(|| format!("joint {id}"), "use", sheet.use_index, uses, defects);
        }
    }
}

fn lengths(id: SurfaceId, s: &Surface, defects: &mut Vec<Defect>) {
    let (nodes, edges, faces) = (s.positions.len(), s.edges.len(), s.faces.len());
    let mut rule = |array, len: usize, expected: usize| {
        if len != expected {
            defects.push(Defect::ArrayLength { surface: id, array, len, expected });
        }
    };
    rule("backup positions", if s.backup.is_empty() { nodes } else { s.backup.len() }, nodes);
    rule("planar positions", if s.planar.is_empty() { nodes } else { s.planar.len() }, nodes);
    rule("faces of edges", s.edge_faces.len(), edges);
    rule("chains of edges", s.edge_chain.len(), edges);
    rule("edges of faces", s.face_edges.len(), faces);
}

/// Numbers given as free name nothing, and what names nothing is given as free.
fn slots(id: SurfaceId, s: &Surface, defects: &mut Vec<Defect>) {
    let surface = Some(id);
    free(surface, "node", &s.slots.nodes, s.positions.len(), |v| s.slots.nodes.is_free(v as u32), defects);
    let edge = |e: usize| {
        s.edges[e] == [NONE; 2]
            && s.edge_faces.get(e) == Some(&[NONE; 2])
            && s.edge_chain(EdgeId(e as u32)).is_none()
    };
    free(surface, "edge", &s.slots.edges, s.edges.len(), edge, defects);
    let face = |f: usize| s.faces[f] == [NONE; 3] && s.face_edges.get(f) == Some(&[NONE; 3]);
    free(surface, "face", &s.slots.faces, s.faces.len(), face, defects);
    free(surface, "chain", &s.slots.chains, s.chains.len(), |c| s.chains[c].is_free(), defects);
}

fn free(
    surface: Option<SurfaceId>,
    what: &'static str,
    slots: &Slots,
    len: usize,
    empty: impl Fn(usize) -> bool,
    defects: &mut Vec<Defect>,
) {
    let mut seen = vec![false; len];
    for &id in slots.free() {
        let twice = seen.get_mut(id as usize).is_none_or(|seen| std::mem::replace(seen, true));
        if twice || !empty(id as usize) {
            defects.push(Defect::FreeNumber { surface, what, id });
        }
    }
    for id in (0..len).filter(|&id| !seen[id] && empty(id)) {
        defects.push(Defect::FreeNumber { surface, what, id: id as u32 });
    }
}

/// Numbers that may be named: below a limit and not free.
#[derive(Clone, Copy)]
struct Numbers<'a> {
    limit: usize,
    slots: Option<&'a Slots>,
}

impl<'a> Numbers<'a> {
    fn below(limit: usize) -> Self {
        Self { limit, slots: None }
    }

    fn of(limit: usize, slots: &'a Slots) -> Self {
        Self { limit, slots: Some(slots) }
    }
}

fn named(
    of: impl Fn() -> String,
    what: &'static str,
    id: u32,
    numbers: Numbers,
    defects: &mut Vec<Defect>,
) -> bool {
    let known = (id as usize) < numbers.limit && !numbers.slots.is_some_and(|s| s.is_free(id));
    if !known {
        defects.push(Defect::UnknownId { of: of(), what, id, limit: numbers.limit });
    }
    known
}

fn surface_ids(body: &Body, id: SurfaceId, s: &Surface, defects: &mut Vec<Defect>) {
    let nodes = Numbers::of(s.positions.len(), &s.slots.nodes);
    let edges = Numbers::of(s.edges.len(), &s.slots.edges);
    let faces = Numbers::of(s.faces.len(), &s.slots.faces);
    let chains = Numbers::of(s.chains.len(), &s.slots.chains);
    let loops = Numbers::below(s.loops.len());
    let joints = Numbers::of(body.joints.len(), &body.joint_slots);
    let attribute_nodes = Numbers::below(s.attribute_nodes.len());
    for (e, ends) in s.edges.iter().enumerate().filter(|(e, _)| !s.slots.edges.is_free(*e as u32)) {
        for &v in ends {
            named(|| format!("surface {id}: edge {e}"), "node", v, nodes, defects);
        }
    }
    for (e, sides) in s.edge_faces.iter().enumerate() {
        for &f in sides.iter().filter(|&&f| f != NONE) {
            named(|| format!("surface {id}: edge {e}"), "face", f, faces, defects);
        }
    }
    for e in 0..s.edge_chain.len() as u32 {
        if let Some(c) = s.edge_chain(EdgeId(e)) {
            named(|| format!("surface {id}: edge {e}"), "chain", c.0, chains, defects);
        }
    }
    for (f, corners) in s.faces.iter().enumerate().filter(|(f, _)| !s.slots.faces.is_free(*f as u32)) {
        for &v in corners {
            named(|| format!("surface {id}: face {f}"), "node", v, nodes, defects);
        }
    }
    for (f, sides) in s.face_edges.iter().enumerate().filter(|(f, _)| !s.slots.faces.is_free(*f as u32)) {
        for &e in sides {
            named(|| format!("surface {id}: face {f}"), "edge", e, edges, defects);
        }
    }
    for (c, chain) in s.chains.iter().enumerate().filter(|(c, _)| !s.slots.chains.is_free(*c as u32)) {
        let of = || format!("surface {id}: chain {c}");
        named(of, "node", chain.start.0, nodes, defects);
        for d in &chain.edges {
            named(of, "edge", d.edge().0, edges, defects);
        }
        if let Some(l) = chain.on_loop {
            named(of, "loop", l.0, loops, defects);
        }
        if let Some(j) = chain.joint {
            named(of, "joint", j.0, joints, defects);
        }
    }
    for (l, cycle) in s.loops.iter().enumerate() {
        for c in &cycle.chains {
            named(|| format!("surface {id}: loop {l}"), "chain", c.0, chains, defects);
        }
    }
    for (n, node) in s.attribute_nodes.iter().enumerate() {
        let of = || format!("surface {id}: attribute node {n}");
        match node {
            AttributeNode::OnEdge { edge, .. } => named(of, "edge", edge.0, edges, defects),
            AttributeNode::InFace { face, .. } => named(of, "face", face.0, faces, defects),
        };
    }
    for (l, line) in s.attribute_edges.iter().enumerate() {
        for n in &line.nodes {
            let of = || format!("surface {id}: attribute edge {l}");
            named(of, "attribute node", n.0, attribute_nodes, defects);
        }
    }
}
