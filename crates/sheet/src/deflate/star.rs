//! The faces about every node of a mesh.

/// Corners at every node.
#[derive(Debug)]
pub(super) struct Star {
    starts: Vec<u32>,
    corners: Vec<u32>,
}

impl Star {
    /// O(n).
    pub(super) fn new(faces: &[[u32; 3]], nodes: usize) -> Self {
        let mut starts = vec![0u32; nodes + 1];
        for v in faces.iter().flatten() {
            starts[*v as usize + 1] += 1;
        }
        for v in 0..nodes {
            starts[v + 1] += starts[v];
        }
        let mut fill = starts.clone();
        let mut corners = vec![0; 3 * faces.len()];
        for (k, v) in (0..).zip(faces.iter().flatten()) {
            corners[fill[*v as usize] as usize] = k;
            fill[*v as usize] += 1;
        }
        Self { starts, corners }
    }

    /// The corners at a node: three times the face, and which of its corners.
    pub(super) fn of(&self, v: u32) -> &[u32] {
        &self.corners[self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize]
    }
}
