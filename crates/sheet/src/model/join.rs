//! Joining sheets: coincident corners and edges become one, or sheets are first cut where they touch (Stroud & Nagy 6.3.2,
//! 6.3.4.3, 6.3.4.4).

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use mesh_kernel::complex::{EdgeId, FaceId, VertexId};

use super::build::{SAME_POINT, within};
use super::command::{Done, JoinEdges};
use super::{Model, ModelError};

impl Model {
    /// Joins patches; all, where none is named.
    pub(super) fn join(
        &mut self,
        patches: &[String],
        edges: JoinEdges,
        split: bool,
    ) -> Result<Done, ModelError> {
        let faces = self.faces_of_all(patches)?;
        if split {
            self.split_and_join(&faces)?;
            return Ok(Done::default());
        }
        let vertices: Vec<VertexId> = self.vertices_of(&faces).into_iter().collect();
        let merged = self.merge_corners(&vertices)?;
        let vertices = self.vertices_of(&faces);
        if let Some(at) = self.edge_touched(&faces, &vertices) {
            return Err(ModelError::EdgesDoNotMatch { at });
        }
        if merged == 0 {
            return Err(ModelError::NothingToJoin);
        }
        let united = if edges == JoinEdges::Merge { self.unite_parallel(&vertices)? } else { Vec::new() };
        Ok(Done { merged_vertices: merged, merged_edges: united, ..Done::default() })
    }

    pub(super) fn faces_of_all(&self, patches: &[String]) -> Result<Vec<FaceId>, ModelError> {
        if patches.is_empty() {
            return Ok(self.complex().faces().collect());
        }
        let mut faces = BTreeSet::new();
        for patch in patches {
            faces.extend(self.faces_of(patch)?);
        }
        Ok(faces.into_iter().collect())
    }

    /// Makes one of vertices in one place. How many went.
    fn merge_corners(&mut self, vertices: &[VertexId]) -> Result<usize, ModelError> {
        let mut sorted: Vec<(DVec3, VertexId)> = vertices.iter().map(|v| (self.at(*v), *v)).collect();
        sorted.sort_by(|a, b| a.0.x.total_cmp(&b.0.x).then(a.1.cmp(&b.1)));
        let mut gone = vec![false; sorted.len()];
        let mut merged = 0;
        for i in 0..sorted.len() {
            if gone[i] {
                continue;
            }
            for j in i + 1..sorted.len() {
                if sorted[j].0.x > sorted[i].0.x + SAME_POINT {
                    break;
                }
                if !gone[j] && sorted[i].0.distance(sorted[j].0) <= SAME_POINT {
                    self.editor.merge_vertices(sorted[i].1, sorted[j].1)?;
                    gone[j] = true;
                    merged += 1;
                }
            }
        }
        Ok(merged)
    }

    /// Makes one of edges with the same ends. The edges that stay.
    fn unite_parallel(&mut self, vertices: &BTreeSet<VertexId>) -> Result<Vec<EdgeId>, ModelError> {
        let mut between: BTreeMap<[VertexId; 2], Vec<EdgeId>> = BTreeMap::new();
        for &v in vertices {
            for &e in self.complex().edges_at(v) {
                let Some(mut ends) = self.complex().ends(e) else { continue };
                ends.sort_unstable();
                if ends[0] == v {
                    between.entry(ends).or_default().push(e);
                }
            }
        }
        let mut united = Vec::new();
        for edges in between.values().filter(|e| e.len() > 1) {
            for gone in &edges[1..] {
                self.editor.unite_edges(edges[0], *gone, None)?;
            }
            united.push(edges[0]);
        }
        Ok(united)
    }

    /// A corner of the faces that lies inside an edge of them.
    fn edge_touched(&self, faces: &[FaceId], vertices: &BTreeSet<VertexId>) -> Option<DVec3> {
        self.edges_of(faces).into_iter().find_map(|e| {
            let [a, b] = self.complex().ends(e)?.map(|v| self.at(v));
            vertices.iter().map(|v| self.at(*v)).find(|p| within(*p, a, b))
        })
    }
}
