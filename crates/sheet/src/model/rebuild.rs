//! Faces made anew from triangles: what the kernel's merge gives becomes plane faces with names again.

use std::collections::BTreeSet;

use glam::DVec3;
use mesh_kernel::complex::FaceId;
use mesh_kernel::merge::{MergeOptions, merge};
use mesh_kernel::{Group, TriMesh};

use super::build::{Builder, SAME_POINT};
use super::{Model, ModelError};
use crate::facets::{FacetRule, FacetSheet};

impl Model {
    /// Cuts faces wherever they meet and joins them there, through the kernel's merge.
    pub(super) fn split_and_join(&mut self, faces: &[FaceId]) -> Result<(), ModelError> {
        let wanted: BTreeSet<FaceId> = faces.iter().copied().collect();
        let mesh = self.mesh_of(|f| wanted.contains(&f), |f| f.0);
        if mesh.faces.is_empty() {
            return Err(ModelError::NothingToJoin);
        }
        let patch_of_group: Vec<u32> =
            faces.iter().map(|f| self.tables.patch_of.get(f).copied().unwrap_or(0)).collect();
        let merged = merge(&[&mesh], &MergeOptions::default())?;
        let parts = (0..merged.faces.len() as u32).map(|f| {
            let parent = merged.parents(f)[0];
            let group = mesh.groups.partition_point(|g| g.faces.end <= parent.face);
            let mut corners = merged.faces[f as usize];
            if parent.reversed {
                corners.swap(1, 2);
            }
            (patch_of_group[group], corners)
        });
        let parts: Vec<(u32, [u32; 3])> = parts.collect();
        self.replace(faces, &merged.positions, parts)
    }

    /// Replaces faces by triangles, each with its patch; those of one patch in one plane become one face.
    pub(super) fn replace(
        &mut self,
        old: &[FaceId],
        positions: &[DVec3],
        mut parts: Vec<(u32, [u32; 3])>,
    ) -> Result<(), ModelError> {
        let vertices = self.vertices_of(old);
        // The merge's grid moves nodes by some 1e-12 of the size; those that were there stay where they were.
        let known: Vec<DVec3> = vertices.iter().map(|v| self.at(*v)).collect();
        let home = |p: &DVec3| known.iter().find(|q| q.distance(*p) <= SAME_POINT).copied().unwrap_or(*p);
        parts.sort_by_key(|p| p.0);
        let mut mesh =
            TriMesh::new(positions.iter().map(home).collect(), parts.iter().map(|p| p.1).collect());
        let mut patches = Vec::new();
        let mut first = 0;
        for same in parts.chunk_by(|a, b| a.0 == b.0) {
            let end = first + same.len() as u32;
            mesh.groups
                .push(Group { name: self.tables.names[same[0].0 as usize].clone(), faces: first..end });
            patches.push(same[0].0);
            first = end;
        }
        let sheet = FacetSheet::new(&mesh, FacetRule::Planes)?;
        let edges = self.edges_of(old);
        for &f in old {
            self.editor.kill_face(f)?;
            self.tables.patch_of.remove(&f);
        }
        let wires: BTreeSet<_> = self.tables.wires.values().flat_map(|w| &w.edges).copied().collect();
        let edges = edges.difference(&wires).copied().collect();
        self.sweep_up(&edges, &vertices)?;
        let known: Vec<_> = vertices.into_iter().filter(|v| self.complex().position(*v).is_some()).collect();
        let mut builder = Builder::on(&mut self.editor, known);
        for v in &sheet.vertices {
            builder.node(sheet.positions[*v as usize])?;
        }
        for facet in &sheet.facets {
            // Corners only: what lies within a line is no vertex.
            let corners = |sides: &Vec<crate::facets::Side>| -> Vec<DVec3> {
                let start = |s: &crate::facets::Side| {
                    let ends = sheet.lines[s.line as usize].ends();
                    sheet.positions[ends[usize::from(!s.along)] as usize]
                };
                sides.iter().map(start).collect()
            };
            builder.face(&facet.loops.iter().map(corners).collect::<Vec<_>>())?;
        }
        let made = builder.faces;
        for (f, facet) in made.into_iter().zip(&sheet.facets) {
            self.enter([f], patches[facet.group as usize]);
        }
        Ok(())
    }
}
