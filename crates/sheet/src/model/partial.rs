//! Partial models: faces with nothing behind, on which operations act as if material were unlimited there (Stroud & Nagy 6.4).

use std::collections::BTreeMap;

use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::complex::FaceId;
use mesh_kernel::merge::{Boolean, MergeError, MergeOptions, boolean};

use super::{Model, ModelError};

impl Model {
    /// Says that a patch has unlimited material behind it.
    pub(super) fn make_partial(&mut self, patch: &str) -> Result<(), ModelError> {
        let faces = self.faces_of(patch)?;
        let refuse = |why| ModelError::NotPartial { patch: patch.to_owned(), why };
        let mesh = self.patch_mesh(&faces);
        let rim = rim(&mesh).ok_or_else(|| refuse("it has no single front"))?;
        if rim.is_empty() {
            return Err(refuse("it is closed, so what is behind it is limited"));
        }
        self.tables.partial.insert(self.tables.patch_of[&faces[0]]);
        Ok(())
    }

    /// Adds a solid to a partial model: what of the solid is in front of the model stays, and what of the model is inside the
    /// solid goes.
    pub(super) fn add_to_partial(&mut self, solid: &str, to: &str) -> Result<(), ModelError> {
        let [solid_faces, faces] = [self.faces_of(solid)?, self.faces_of(to)?];
        let [solid_patch, patch] = [&solid_faces, &faces].map(|f| self.tables.patch_of[&f[0]]);
        if !self.tables.partial.contains(&patch) {
            return Err(ModelError::Mixed { patch: to.to_owned() });
        }
        let sheet = self.patch_mesh(&faces);
        let tool = self.patch_mesh(&solid_faces);
        let rim = rim(&sheet)
            .ok_or(ModelError::NotPartial { patch: to.to_owned(), why: "it has no single front" })?;
        let block = block_behind(&sheet, &rim, &tool);
        let united =
            boolean(&[&block, &tool], Boolean::Union, &MergeOptions::default()).map_err(|e| match e {
                MergeError::Open { model: 1, .. } => ModelError::NotSolid { patch: solid.to_owned() },
                other => other.into(),
            })?;
        let (front, behind) = (sheet.faces.len() as u32, block.faces.len() as u32);
        let area = |mesh: &TriMesh, f: u32| mesh.area_normal(f).length();
        let (mut parts, mut left) = (Vec::new(), 0.0);
        for (f, &parent) in (0..).zip(&united.parents) {
            let corners = united.mesh.faces[f as usize];
            if parent < front {
                parts.push((patch, corners));
            } else if parent >= behind {
                parts.push((solid_patch, corners));
            } else {
                left += area(&united.mesh, f);
            }
        }
        // What stands for the unlimited material must not have been touched.
        let whole: f64 = (front..behind).map(|f| area(&block, f)).sum();
        if (whole - left).abs() > 1e-9 * whole {
            return Err(ModelError::BeyondPartial);
        }
        let all: Vec<FaceId> = faces.into_iter().chain(solid_faces).collect();
        self.replace(&all, &united.mesh.positions, parts)?;
        self.tables.partial.insert(solid_patch);
        Ok(())
    }

    fn patch_mesh(&self, faces: &[FaceId]) -> TriMesh {
        self.mesh_of(|f| faces.contains(&f), |_| 0)
    }
}

/// Edges with one face, as it walks them; `None` where faces do not have one front.
fn rim(mesh: &TriMesh) -> Option<Vec<[u32; 2]>> {
    let mut uses: BTreeMap<[u32; 2], i32> = BTreeMap::new();
    for [a, b, c] in &mesh.faces {
        for side in [[*a, *b], [*b, *c], [*c, *a]] {
            *uses.entry(side).or_default() += 1;
        }
    }
    if uses.values().any(|n| *n > 1) {
        return None;
    }
    Some(uses.keys().copied().filter(|[a, b]| !uses.contains_key(&[*b, *a])).collect())
}

/// The sheet as the front of a block that reaches far behind it: the sheet's triangles first.
fn block_behind(sheet: &TriMesh, rim: &[[u32; 2]], tool: &TriMesh) -> TriMesh {
    let normal: DVec3 = (0..sheet.faces.len() as u32).map(|f| sheet.area_normal(f)).sum();
    let size = |m: &TriMesh| m.bounds().map_or(0.0, |[lo, hi]| lo.length().max(hi.length()));
    let back = normal.normalize_or_zero() * -(4.0 * (size(sheet) + size(tool)));
    let n = sheet.positions.len() as u32;
    let mut block = sheet.clone();
    block.groups.clear();
    block.positions.extend(sheet.positions.iter().map(|p| *p + back));
    block.faces.extend(rim.iter().flat_map(|[a, b]| [[*b, *a, a + n], [*b, a + n, b + n]]));
    block.faces.extend(sheet.faces.iter().map(|[a, b, c]| [a + n, c + n, b + n]));
    block
}
