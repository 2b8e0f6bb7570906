//! Parallel plane sections of a triangle soup whose nodes may be repeated.

use std::collections::HashMap;

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;

/// One polyline of a section.
pub(crate) struct SectionLoop {
    /// Whether the last point joins the first.
    pub(crate) closed: bool,
    /// Points in order.
    pub(crate) points: Vec<DVec3>,
}

/// Faces sorted into layers along an axis, so that a cut looks at few of them.
pub(crate) struct SectionStack {
    positions: Vec<DVec3>,
    heights: Vec<f64>,
    faces: Vec<[u32; 3]>,
    bins: Vec<Vec<u32>>,
    low: f64,
    inverse_step: f64,
}

impl SectionStack {
    pub(crate) fn new(mesh: &TriMesh, axis: DVec3) -> Self {
        let heights: Vec<f64> = mesh.positions.iter().map(|p| p.dot(axis)).collect();
        let mut low = f64::INFINITY;
        let mut high = f64::NEG_INFINITY;
        for f in &mesh.faces {
            for v in f {
                low = low.min(heights[*v as usize]);
                high = high.max(heights[*v as usize]);
            }
        }
        let count = 400usize;
        let inverse_step = count as f64 / (high - low).max(1e-9);
        let mut bins = vec![Vec::new(); count + 1];
        for (i, f) in mesh.faces.iter().enumerate() {
            let h = f.map(|v| heights[v as usize]);
            let a = h[0].min(h[1]).min(h[2]);
            let b = h[0].max(h[1]).max(h[2]);
            let from = ((a - low) * inverse_step) as usize;
            let to = (((b - low) * inverse_step) as usize).min(count);
            for bin in &mut bins[from..=to] {
                bin.push(i as u32);
            }
        }
        Self { positions: mesh.positions.clone(), heights, faces: mesh.faces.clone(), bins, low, inverse_step }
    }

    pub(crate) fn cut(&self, height: f64) -> Vec<SectionLoop> {
        let bin = (height - self.low) * self.inverse_step;
        if !(bin >= 0.0) || bin as usize >= self.bins.len() {
            return Vec::new();
        }
        let mut segments: Vec<[u64; 2]> = Vec::new();
        for &f in &self.bins[bin as usize] {
            let face = self.faces[f as usize];
            let above = face.map(|v| self.heights[v as usize] >= height);
            let n = above.iter().filter(|a| **a).count();
            if n == 0 || n == 3 {
                continue;
            }
            let lone = if n == 1 { above.iter().position(|a| *a) } else { above.iter().position(|a| !*a) };
            let k = lone.unwrap_or(0);
            let key = |a: u32, b: u32| (u64::from(a.min(b)) << 32) | u64::from(a.max(b));
            let (v, a, b) = (face[k], face[(k + 1) % 3], face[(k + 2) % 3]);
            segments.push([key(v, a), key(v, b)]);
        }
        let mut at: HashMap<u64, [u32; 2]> = HashMap::with_capacity(segments.len() * 2);
        for (i, s) in segments.iter().enumerate() {
            for k in s {
                let slot = at.entry(*k).or_insert([u32::MAX; 2]);
                if slot[0] == u32::MAX {
                    slot[0] = i as u32;
                } else if slot[1] == u32::MAX {
                    slot[1] = i as u32;
                }
            }
        }
        let point = |k: u64| {
            let (a, b) = ((k >> 32) as usize, (k & 0xffff_ffff) as usize);
            let t = (height - self.heights[a]) / (self.heights[b] - self.heights[a]);
            self.positions[a].lerp(self.positions[b], t)
        };
        let mut used = vec![false; segments.len()];
        let mut out = Vec::new();
        for start in 0..segments.len() {
            if used[start] {
                continue;
            }
            used[start] = true;
            let mut keys = vec![segments[start][0], segments[start][1]];
            let mut closed = false;
            for direction in 0..2 {
                let mut segment = start as u32;
                loop {
                    let end = *keys.last().unwrap_or(&0);
                    let pair = at[&end];
                    let next = if pair[0] == segment { pair[1] } else { pair[0] };
                    if next == u32::MAX || used[next as usize] {
                        if next == start as u32 && keys.len() > 2 && direction == 0 {
                            closed = true;
                            keys.pop();
                        }
                        break;
                    }
                    used[next as usize] = true;
                    let s = segments[next as usize];
                    keys.push(if s[0] == end { s[1] } else { s[0] });
                    segment = next;
                }
                if closed {
                    break;
                }
                keys.reverse();
            }
            out.push(SectionLoop { closed, points: keys.into_iter().map(point).collect() });
        }
        out
    }
}
