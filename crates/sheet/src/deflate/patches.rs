//! The mid-surface as patches: smooth pieces between folds, joints and free edges.

use mesh_kernel::query::Adjacency;
use mesh_kernel::{Group, TriMesh};

use super::assemble::{Sheet, Source};
use super::segments::Segments;

/// Two pieces that meet without more of a fold than this, in radians, are one patch.
const FOLD: f64 = 30.0 / 180.0 * std::f64::consts::PI;

const NONE: u32 = u32::MAX;

/// Faces in order of their patches; the patches are groups of the mesh.
#[derive(Debug)]
pub(super) struct Patched {
    pub(super) mesh: TriMesh,
    /// Face of the sheet for every face.
    pub(super) order: Vec<u32>,
}

/// Cuts a sheet into patches. O(n log n).
pub(super) fn patched(sheet: &Sheet, segments: &Segments) -> Patched {
    let mut mesh = TriMesh::new(sheet.positions.clone(), sheet.faces.clone());
    let adjacency = Adjacency::new(&mesh);
    let normals: Vec<_> =
        (0..mesh.faces.len() as u32).map(|f| mesh.area_normal(f).normalize_or_zero()).collect();
    let piece = |f: u32| match sheet.sources[f as usize] {
        Source::Plane(k) => (0, k),
        Source::Facet(source) => (1, segments.of(source)),
    };
    let mut patch = vec![NONE; mesh.faces.len()];
    let mut count = 0;
    let mut stack = Vec::new();
    for seed in 0..mesh.faces.len() as u32 {
        if patch[seed as usize] != NONE {
            continue;
        }
        patch[seed as usize] = count;
        stack.push(seed);
        while let Some(f) = stack.pop() {
            for h in 3 * f..3 * f + 3 {
                let Some(edge) = adjacency.edge_of(h) else { continue };
                let [a, b] = adjacency.half_edges(edge) else { continue };
                let other = if *a == h { b / 3 } else { a / 3 };
                let opposed = adjacency.ends(*a) != adjacency.ends(*b);
                let cosine = normals[f as usize].dot(normals[other as usize]);
                let smooth = piece(f) == piece(other) || cosine > FOLD.cos();
                if opposed && smooth && patch[other as usize] == NONE {
                    patch[other as usize] = count;
                    stack.push(other);
                }
            }
        }
        count += 1;
    }
    let mut order: Vec<u32> = (0..mesh.faces.len() as u32).collect();
    order.sort_by_key(|f| (patch[*f as usize], *f));
    mesh.faces = order.iter().map(|f| sheet.faces[*f as usize]).collect();
    let mut first = 0;
    for run in order.chunk_by(|a, b| patch[*a as usize] == patch[*b as usize]) {
        let end = first + run.len() as u32;
        mesh.groups.push(Group { name: format!("patch_{}", mesh.groups.len() + 1), faces: first..end });
        first = end;
    }
    Patched { mesh, order }
}
