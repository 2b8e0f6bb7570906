//! The body welded to one complex of numbered nodes, edges and faces: what counts and checks run on.

use super::Body;
use super::ids::{FaceId, JointId, NONE, SurfaceId};
use super::joint::Side;
use super::surface::Surface;
use super::weld::Weld;

/// A use of an edge by a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FaceUse {
    /// Face, numbered through all surfaces.
    pub(crate) face: u32,
    /// Whether the face runs over the edge in the edge's own direction.
    pub(crate) along: bool,
}

/// Welded nodes, edges and faces. The uses of an edge stand in radial order.
pub(crate) struct Welded {
    pub(crate) weld: Weld,
    /// Welded nodes of every welded edge.
    pub(crate) edges: Vec<[u32; 2]>,
    /// Uses of edge `e`: `uses[starts[e]..starts[e + 1]]`.
    starts: Vec<u32>,
    uses: Vec<FaceUse>,
    pub(crate) faces: FaceNumbers,
}

/// Numbers of the faces through all surfaces; free numbers of sparse surfaces are left out.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FaceNumbers {
    /// The first of every surface, and the total.
    first: Vec<u32>,
    /// Free numbers of every surface, in order.
    free: Vec<Vec<u32>>,
}

impl FaceNumbers {
    fn new(body: &Body) -> Self {
        let sorted = |s: &Surface| {
            let mut free = s.slots.faces.free().to_vec();
            free.sort_unstable();
            free
        };
        let first = body.offsets(|s| s.faces.len() - s.slots.faces.free().len());
        Self { first, free: body.surfaces.iter().map(sorted).collect() }
    }

    #[inline]
    pub(crate) fn number(&self, surface: SurfaceId, face: u32) -> u32 {
        let free = &self.free[surface.index()];
        self.first[surface.index()] + face - free.partition_point(|&f| f < face) as u32
    }

    /// Surface and face of a number. O(log surfaces + free numbers before the face).
    pub(crate) fn face(&self, number: u32) -> (SurfaceId, FaceId) {
        let s = self.first.partition_point(|&first| first <= number) - 1;
        let mut face = number - self.first[s];
        for &free in &self.free[s] {
            if free > face {
                break;
            }
            face += 1;
        }
        (SurfaceId(s as u32), FaceId(face))
    }

    /// How many faces there are.
    pub(crate) fn count(&self) -> u32 {
        *self.first.last().unwrap_or(&0)
    }
}

impl Welded {
    /// O(faces).
    pub(crate) fn new(body: &Body) -> Self {
        let weld = body.weld();
        let (edge_numbers, edge_count) = body.weld_edges();
        let faces = FaceNumbers::new(body);
        let mut edges = vec![[NONE; 2]; edge_count];
        let mut counts = vec![0u32; edge_count + 1];
        let mut on_joint = vec![false; edge_count];
        for ((s, numbers), nodes) in body.surfaces.iter().zip(&edge_numbers).zip(&weld.nodes) {
            for (e, &w) in numbers.iter().enumerate().filter(|(_, w)| **w != NONE) {
                let w = w as usize;
                if edges[w] == [NONE; 2] {
                    edges[w] = s.edges[e].map(|v| nodes[v as usize]);
                }
                counts[w + 1] += s.edge_faces[e].iter().filter(|&&f| f != NONE).count() as u32;
            }
        }
        for i in 1..counts.len() {
            counts[i] += counts[i - 1];
        }
        let starts = counts;
        let mut uses = vec![FaceUse { face: NONE, along: false }; *starts.last().unwrap_or(&0) as usize];
        // Joints first: their sheets in radial order, directed as the joint.
        for (j, joint) in body.joints.iter().enumerate() {
            if joint.uses.is_empty() {
                continue;
            }
            let id = JointId(j as u32);
            let runs: Vec<_> = (0..joint.uses.len()).map(|i| body.joint_edges(id, i)).collect();
            for k in 0..runs.first().map_or(0, Vec::len) {
                let first = runs[0][k];
                let u = joint.uses[0];
                let w = edge_numbers[u.surface.index()][first.edge().index()] as usize;
                let ends = body.surface(u.surface).ends(first);
                edges[w] = ends.map(|v| weld.node(u.surface, v.0));
                on_joint[w] = true;
                let mut at = starts[w] as usize;
                for sheet in &joint.radial {
                    let i = sheet.use_index as usize;
                    let (Some(u), Some(run)) = (joint.uses.get(i), runs.get(i)) else { continue };
                    let Some(&d) = run.get(k) else { continue };
                    let along = sheet.side == Side::Left;
                    let face = body.surface(u.surface).face_left(if along { d } else { d.flipped() });
                    if face != NONE && at < starts[w + 1] as usize {
                        uses[at] = FaceUse { face: faces.number(u.surface, face), along };
                        at += 1;
                    }
                }
            }
        }
        for ((id, s), numbers) in body.surfaces().zip(&edge_numbers) {
            for (sides, &w) in s.edge_faces.iter().zip(numbers) {
                if w == NONE || on_joint[w as usize] {
                    continue;
                }
                let mut at = starts[w as usize] as usize;
                for (i, &f) in sides.iter().enumerate() {
                    if f != NONE {
                        uses[at] = FaceUse { face: faces.number(id, f), along: i == 0 };
                        at += 1;
                    }
                }
            }
        }
        Self { weld, edges, starts, uses, faces }
    }

    pub(crate) fn face_count(&self) -> u32 {
        self.faces.count()
    }

    /// Uses of an edge in radial order. A broken joint may leave uses without a face; they are left out here.
    pub(crate) fn uses(&self, e: usize) -> impl ExactSizeIterator<Item = FaceUse> + Clone + '_ {
        let all = &self.uses[self.starts[e] as usize..self.starts[e + 1] as usize];
        let end = all.iter().position(|u| u.face == NONE).unwrap_or(all.len());
        all[..end].iter().copied()
    }
}
