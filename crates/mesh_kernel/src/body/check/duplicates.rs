//! Edges and faces that are there twice.

use super::Defect;
use crate::body::adjacency::EdgeIndex;
use crate::body::{Body, EdgeId, FaceId, JointId, NONE, Surface, SurfaceId};

pub(super) fn check(body: &Body, defects: &mut Vec<Defect>) {
    for (id, s) in body.surfaces() {
        duplicate_edges(id, s, defects);
    }
    duplicate_faces(body, defects);
}

/// Edges with the same nodes are one edge twice, unless a joint makes them one (a slit of one edge's length).
fn duplicate_edges(id: SurfaceId, s: &Surface, defects: &mut Vec<Defect>) {
    let mut index = EdgeIndex::new(s.positions.len(), &[]);
    let joint = |e: EdgeId| -> Option<JointId> { s.chain(s.edge_chain(e)?).joint };
    for (e, &[a, b]) in s.edges.iter().enumerate() {
        let edge = EdgeId(e as u32);
        if a == NONE {
            index.push_none();
            continue;
        }
        if let Some(other) = index.find(a, b)
            && (joint(edge).is_none() || joint(edge) != joint(other))
        {
            defects.push(Defect::DuplicateEdge { surface: id, edges: [other, edge], nodes: [a, b] });
        }
        index.push(a, b);
    }
}

/// Faces with the same three welded nodes.
fn duplicate_faces(body: &Body, defects: &mut Vec<Defect>) {
    let weld = body.weld();
    let mut faces: Vec<([u32; 3], SurfaceId, u32)> = Vec::with_capacity(body.face_count());
    for (id, s) in body.surfaces() {
        for f in s.live_faces() {
            let mut nodes = s.faces[f.index()].map(|v| weld.node(id, v));
            nodes.sort_unstable();
            faces.push((nodes, id, f.0));
        }
    }
    faces.sort_unstable();
    for pair in faces.windows(2) {
        if pair[0].0 == pair[1].0 {
            let surfaces = [pair[0].1, pair[1].1];
            let faces = [pair[0].2, pair[1].2].map(FaceId);
            defects.push(Defect::DuplicateFace { surfaces, faces });
        }
    }
}
