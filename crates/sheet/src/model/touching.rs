//! Where a solid touches itself, and what that may mean (Stroud & Nagy 6.1, figs. 6.6–6.8).

use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::body::{Body, BuildError, Counts, Pairing, PairingError, Resolution};

/// A place where a model touches itself: an edge with more than two faces, or a node with several fans of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Touching {
    /// The ends of the edge, or the node once.
    pub at: Vec<DVec3>,
    /// Sheets at the edge, or fans at the node.
    pub sheets: usize,
    /// What 'touch and join' makes of it: the material is one across.
    pub join: Reading,
    /// What 'touch but miss' makes of it: the parts stay apart.
    pub miss: Reading,
}

/// What the model is under one of the readings.
#[derive(Clone, Debug, PartialEq)]
pub enum Reading {
    /// The counts then.
    Counts(Counts),
    /// There is no such reading, and why.
    Refused(String),
}

fn reading(result: Result<Resolution, PairingError>) -> Reading {
    match result {
        Ok(resolution) => Reading::Counts(resolution.after),
        Err(error) => Reading::Refused(error.to_string()),
    }
}

/// All places where a model touches itself, edges first; both readings of each, the others left as they are. The choice is the
/// caller's: nothing is decided here. O(places · faces).
///
/// # Errors
/// [`BuildError`] where the mesh is none that the kernel takes.
pub fn touching(mesh: &TriMesh) -> Result<Vec<Touching>, BuildError> {
    let mut whole = mesh.clone();
    whole.groups.clear();
    let mut body = Body::from_tri_mesh(&whole)?;
    // An edge that is cut apart needs a node between its ends. Where that is too much, readings say so.
    let _ = body.split_all(None);
    let mut found = Vec::new();
    for joint in body.non_manifold_joints() {
        let first = body.joint(joint).uses()[0];
        let nodes = body.joint_nodes(joint, 0);
        let positions = body.surface(first.surface).positions();
        let ends = [nodes.first(), nodes.last()].into_iter().flatten();
        found.push(Touching {
            at: ends.map(|v| positions[*v as usize]).collect(),
            sheets: body.joint(joint).radial().len(),
            join: reading(body.resolve_edge(joint, Pairing::Join)),
            miss: reading(body.resolve_edge(joint, Pairing::Miss)),
        });
    }
    for (surface, node) in body.non_manifold_nodes() {
        let fans = body.node_fans(surface, node).map_or(0, |f| f.fans.len());
        found.push(Touching {
            at: vec![body.surface(surface).positions()[node.index()]],
            sheets: fans,
            join: reading(body.resolve_node(surface, node, Pairing::Join)),
            miss: reading(body.resolve_node(surface, node, Pairing::Miss)),
        });
    }
    Ok(found)
}
