//! Voids in the material that only the ends of tight offsets leave.
//!
//! Offsets of tight face-uses end short of the axis of curvature (see [`super::tight`]); where the curvature changes from
//! face to face, what they leave is not always covered by others. A void all of whose nodes are nearer to the sheet than the
//! depth is no void: every point nearer than the depth is material.

use mesh_kernel::TriMesh;
use mesh_kernel::merge::Solid;
use mesh_kernel::query::{ClosestPoint, WindingNumber};

use super::clean_sheet::CleanSheet;
use super::measure::{Shells, shells};
use super::{OffsetChain, Role, Side};

/// A node counts as nearer than the depth below this share of it: offset points of smooth runs may miss by as much.
const NEARER: f64 = 0.95;

/// Fills such voids; returns how many. O(n log n), where there is a tight face; else O(1).
pub(super) fn fill_voids(sheet: &CleanSheet, chain: &OffsetChain, side: Side, solid: &mut Solid) -> usize {
    if chain.tight.is_empty() {
        return 0;
    }
    let shells = shells(&solid.mesh);
    let mut spurious: Vec<bool> = shells.volumes.iter().map(|v| *v < 0.0).collect();
    let mut tight = vec![false; spurious.len()];
    let untouched = match side {
        Side::Both => None,
        Side::Front => Some(Role::BackWall),
        Side::Back => Some(Role::FrontWall),
    };
    for (face, parent) in solid.mesh.faces.iter().zip(&solid.parents) {
        let shell = shells.of_node[face[0] as usize] as usize;
        let origin = chain.origins[*parent as usize];
        tight[shell] |= chain.tight.binary_search(&origin.face).is_ok();
        spurious[shell] &= Some(origin.role) != untouched;
    }
    spurious.iter_mut().zip(tight).for_each(|(s, tight)| *s &= tight);
    if !spurious.contains(&true) {
        return 0;
    }
    let share = if side == Side::Both { 0.5 } else { 1.0 };
    let deepest = share * sheet.thickness.iter().flatten().fold(0.0f64, |m, t| m.max(*t));
    let closest = ClosestPoint::new(&TriMesh::new(sheet.positions.clone(), sheet.faces.clone()));
    let is_near = |v: u32| {
        closest.closest_within(solid.mesh.positions[v as usize], deepest).is_some_and(|found| {
            let depth = sheet.thickness[found.face as usize].iter().fold(f64::INFINITY, |m, t| m.min(*t));
            found.distance < NEARER * share * depth
        })
    };
    for face in &solid.mesh.faces {
        let shell = shells.of_node[face[0] as usize] as usize;
        spurious[shell] = spurious[shell] && face.iter().all(|v| is_near(*v));
    }
    let islands = islands(&solid.mesh, &shells, &spurious);
    let keep = |face: &[u32; 3]| {
        let shell = shells.of_node[face[0] as usize] as usize;
        !spurious[shell] && !islands[shell]
    };
    let faces = std::mem::take(&mut solid.mesh.faces);
    let parents = std::mem::take(&mut solid.parents);
    (solid.mesh.faces, solid.parents) = faces.into_iter().zip(parents).filter(|(f, _)| keep(f)).unzip();
    spurious.iter().filter(|s| **s).count()
}

/// Whether a shell is material within a void that is filled: then it is no boundary any more.
fn islands(mesh: &TriMesh, shells: &Shells, filled: &[bool]) -> Vec<bool> {
    let shell = |face: &[u32; 3]| shells.of_node[face[0] as usize] as usize;
    // Voids are wound inward.
    let faces = mesh.faces.iter().filter(|f| filled[shell(f)]).map(|&[a, b, c]| [a, c, b]).collect();
    let voids = WindingNumber::new(&TriMesh::new(mesh.positions.clone(), faces));
    let mut seed = vec![None; filled.len()];
    mesh.faces.iter().for_each(|f| seed[shell(f)] = Some(f[0]));
    let is_island = |(shell, node): (usize, Option<u32>)| {
        node.is_some_and(|v| !filled[shell] && voids.is_above(mesh.positions[v as usize], 0.5))
    };
    seed.into_iter().enumerate().map(is_island).collect()
}
