//! Voids in the material that only the ends of tight offsets leave.
//!
//! Offsets of tight face-uses end short of the axis of curvature (see [`super::tight`]); where the curvature changes from
//! face to face, what they leave is not always covered by others. A void all of whose nodes are nearer to the sheet than the
//! depth is no void: every point nearer than the depth is material.

use mesh_kernel::TriMesh;
use mesh_kernel::merge::Solid;
use mesh_kernel::query::ClosestPoint;

use super::clean_sheet::CleanSheet;
use super::measure::shells;
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
    let keep = |face: &[u32; 3]| !spurious[shells.of_node[face[0] as usize] as usize];
    let faces = std::mem::take(&mut solid.mesh.faces);
    let parents = std::mem::take(&mut solid.parents);
    (solid.mesh.faces, solid.parents) = faces.into_iter().zip(parents).filter(|(f, _)| keep(f)).unzip();
    spurious.iter().filter(|s| **s).count()
}
