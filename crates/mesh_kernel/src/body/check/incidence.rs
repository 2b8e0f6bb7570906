//! Nodes, edges and faces name each other, and faces are wound alike.

use super::Defect;
use crate::body::{Body, EdgeId, FaceId, NONE, NodeId, Surface, SurfaceId};

pub(super) fn check(body: &Body, defects: &mut Vec<Defect>) {
    for (id, s) in body.surfaces() {
        edges(id, s, defects);
        faces(id, s, defects);
    }
}

fn edges(id: SurfaceId, s: &Surface, defects: &mut Vec<Defect>) {
    for (e, (&[a, b], sides)) in s.edges.iter().zip(&s.edge_faces).enumerate() {
        if a == NONE {
            continue;
        }
        let edge = EdgeId(e as u32);
        if a == b {
            defects.push(Defect::EdgeOfOneNode { surface: id, edge, node: NodeId(a) });
        }
        for (i, &f) in sides.iter().enumerate().filter(|(_, f)| **f != NONE) {
            let own = s.face_edges[f as usize];
            let Some(side) = own.iter().position(|&x| x == edge.0) else {
                defects.push(Defect::EdgeNotInFace { surface: id, edge, face: FaceId(f), sides: own });
                continue;
            };
            // On the left (i = 0) the face runs from the edge's first node to its second.
            if s.faces[f as usize][side] != s.edges[e][i] {
                defects.push(Defect::Orientation { surface: id, edge, face: FaceId(f) });
            }
        }
    }
}

fn faces(id: SurfaceId, s: &Surface, defects: &mut Vec<Defect>) {
    for (f, (&nodes, sides)) in s.faces.iter().zip(&s.face_edges).enumerate() {
        if nodes[0] == NONE {
            continue;
        }
        let face = FaceId(f as u32);
        let [a, b, c] = nodes;
        if a == b || b == c || c == a {
            defects.push(Defect::RepeatedCorner { surface: id, face, nodes });
        }
        for (side, &e) in sides.iter().enumerate() {
            let corners = [nodes[side], nodes[(side + 1) % 3]];
            let [p, q] = s.edges[e as usize];
            let edge = EdgeId(e);
            if corners != [p, q] && corners != [q, p] {
                let edge_nodes = [p, q];
                defects.push(Defect::SideNodes { surface: id, face, side, edge, edge_nodes, corners });
            }
            let faces = s.edge_faces[e as usize];
            if !faces.contains(&face.0) {
                defects.push(Defect::FaceNotOnEdge { surface: id, face, edge, faces });
            }
        }
    }
}
