//! Array lengths, and ids that name something.

use super::Defect;
use crate::body::attribute::AttributeNode;
use crate::body::{Body, EdgeId, NONE, Surface, SurfaceId};

pub(super) fn check(body: &Body, defects: &mut Vec<Defect>) {
    for (id, s) in body.surfaces() {
        lengths(id, s, defects);
        surface_ids(body, id, s, defects);
    }
    for (id, joint) in body.joints() {
        for u in &joint.uses {
            let of = || format!("joint {id}");
            let surfaces = body.surfaces.len();
            if named(of, "surface", u.surface.0, surfaces, defects) {
                named(of, "chain", u.chain.0, body.surface(u.surface).chains.len(), defects);
            }
        }
        for sheet in &joint.radial {
            named(|| format!("joint {id}"), "use", sheet.use_index, joint.uses.len(), defects);
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

fn named(
    of: impl Fn() -> String,
    what: &'static str,
    id: u32,
    limit: usize,
    defects: &mut Vec<Defect>,
) -> bool {
    let known = (id as usize) < limit;
    if !known {
        defects.push(Defect::UnknownId { of: of(), what, id, limit });
    }
    known
}

fn surface_ids(body: &Body, id: SurfaceId, s: &Surface, defects: &mut Vec<Defect>) {
    let (nodes, edges, faces) = (s.positions.len(), s.edges.len(), s.faces.len());
    for (e, ends) in s.edges.iter().enumerate() {
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
            named(|| format!("surface {id}: edge {e}"), "chain", c.0, s.chains.len(), defects);
        }
    }
    for (f, corners) in s.faces.iter().enumerate() {
        for &v in corners {
            named(|| format!("surface {id}: face {f}"), "node", v, nodes, defects);
        }
    }
    for (f, sides) in s.face_edges.iter().enumerate() {
        for &e in sides {
            named(|| format!("surface {id}: face {f}"), "edge", e, edges, defects);
        }
    }
    for (c, chain) in s.chains.iter().enumerate() {
        let of = || format!("surface {id}: chain {c}");
        named(of, "node", chain.start.0, nodes, defects);
        for d in &chain.edges {
            named(of, "edge", d.edge().0, edges, defects);
        }
        if let Some(l) = chain.on_loop {
            named(of, "loop", l.0, s.loops.len(), defects);
        }
        if let Some(j) = chain.joint {
            named(of, "joint", j.0, body.joints.len(), defects);
        }
    }
    for (l, cycle) in s.loops.iter().enumerate() {
        for c in &cycle.chains {
            named(|| format!("surface {id}: loop {l}"), "chain", c.0, s.chains.len(), defects);
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
            named(of, "attribute node", n.0, s.attribute_nodes.len(), defects);
        }
    }
}
