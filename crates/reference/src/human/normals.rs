//! Outward normals averaged over some three centimetres of skin, so that neither scan noise nor facets turn them.

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;

use crate::model::FeaturePoint;

/// Standard deviation of the averaging weight, millimetres.
const SIGMA: f64 = 14.0;
/// Edge length above which a face is sampled more than once, millimetres.
const SPACING: f64 = 9.0;
/// Side of the lookup cubes, millimetres.
const CUBE: f64 = 20.0;

/// Area-weighted normals spread over the surface, in cubes.
pub(crate) struct NormalField {
    low: DVec3,
    count: [usize; 3],
    starts: Vec<u32>,
    at: Vec<DVec3>,
    weighted: Vec<DVec3>,
}

impl NormalField {
    pub(crate) fn new(mesh: &TriMesh) -> Self {
        let mut at = Vec::new();
        let mut weighted = Vec::new();
        for f in 0..mesh.faces.len() as u32 {
            let [a, b, c] = mesh.corners(f);
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            let n = ((longest / SPACING).ceil() as usize).clamp(1, 24);
            let share = mesh.area_normal(f) / (n * n) as f64;
            let (u, v) = ((b - a) / n as f64, (c - a) / n as f64);
            for i in 0..n {
                for j in 0..n - i {
                    at.push(a + u * (i as f64 + 1.0 / 3.0) + v * (j as f64 + 1.0 / 3.0));
                    weighted.push(share);
                    if i + j + 2 <= n {
                        at.push(a + u * (i as f64 + 2.0 / 3.0) + v * (j as f64 + 2.0 / 3.0));
                        weighted.push(share);
                    }
                }
            }
        }
        let (mut low, mut high) = (DVec3::MAX, DVec3::MIN);
        for p in &at {
            low = low.min(*p);
            high = high.max(*p);
        }
        let count = ((high - low) / CUBE).to_array().map(|c| c.max(0.0) as usize + 1);
        let cell = |p: &DVec3| {
            let c = ((*p - low) / CUBE).to_array().map(|c| c as usize);
            (c[0] * count[1] + c[1]) * count[2] + c[2]
        };
        let mut starts = vec![0u32; count.iter().product::<usize>() + 1];
        for p in &at {
            starts[cell(p) + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        let (mut sorted_at, mut sorted) = (vec![DVec3::ZERO; at.len()], vec![DVec3::ZERO; at.len()]);
        for (p, w) in at.iter().zip(&weighted) {
            let slot = &mut next[cell(p)];
            sorted_at[*slot as usize] = *p;
            sorted[*slot as usize] = *w;
            *slot += 1;
        }
        Self { low, count, starts, at: sorted_at, weighted: sorted }
    }

    /// Mean outward normal about `p` of the skin that looks roughly along `hint` (any length). Where the skin is far
    /// (a taut curve over a hollow, a hole of a scan) the neighbourhood grows.
    pub(crate) fn at(&self, p: DVec3, hint: DVec3) -> DVec3 {
        let hint = hint.normalize_or(DVec3::Z);
        for grow in [1.0, 2.0, 4.0] {
            let sigma = SIGMA * grow;
            let reach = 2.2 * sigma;
            let from = ((p - self.low - reach) / CUBE).floor().to_array();
            let to = ((p - self.low + reach) / CUBE).floor().to_array();
            let range = |k: usize| {
                let last = self.count[k] as f64 - 1.0;
                (from[k].clamp(0.0, last) as usize, to[k].clamp(0.0, last) as usize)
            };
            let ((x0, x1), (y0, y1), (z0, z1)) = (range(0), range(1), range(2));
            let mut sum = DVec3::ZERO;
            let mut weight = 0.0;
            for x in x0..=x1 {
                for y in y0..=y1 {
                    let row = (x * self.count[1] + y) * self.count[2];
                    for i in self.starts[row + z0] as usize..self.starts[row + z1 + 1] as usize {
                        let d = self.at[i].distance_squared(p);
                        let along = self.weighted[i].dot(hint);
                        if d < reach * reach && along > 0.0 {
                            // Skin that looks aside counts less, so that it enters and leaves smoothly.
                            let w = (-0.5 * d / (sigma * sigma)).exp() * along / self.weighted[i].length();
                            sum += self.weighted[i] * w;
                            weight += self.weighted[i].length() * w;
                        }
                    }
                }
            }
            // At least a fifth of what a plane through the point would give (twice areas).
            if weight > 0.2 * 2.0 * std::f64::consts::TAU * sigma * sigma {
                return sum.normalize_or(hint);
            }
        }
        hint
    }

    /// A feature point with its normal.
    pub(crate) fn point(&self, position: DVec3, hint: DVec3) -> FeaturePoint {
        FeaturePoint { position, normal: self.at(position, hint) }
    }
}

/// Which way the skin roughly looks at a named point.
pub(crate) fn hint(name: &str, p: DVec3) -> DVec3 {
    let side = DVec3::X * p.x.signum();
    if name.ends_with("armpit") {
        side - DVec3::Y * 0.5
    } else if name.ends_with("shoulder") {
        side + DVec3::Y
    } else if name.ends_with("neck_side") {
        side + DVec3::Y * 0.6
    } else {
        match name {
            "crotch" => -DVec3::Y,
            "nape" => DVec3::new(0.0, 0.2, -1.0),
            _ => DVec3::Z,
        }
    }
}
