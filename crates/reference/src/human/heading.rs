//! The plane that mirrors one half of the body onto the other, by trimmed iterative reflection.
//!
//! Surface samples are mirrored and moved onto the tangent planes of their nearest neighbours; the two unknowns (turn of
//! the plane about the vertical, offset) follow by Gauss-Newton steps in which the worst third of the samples (bent arms,
//! holes) has no say.

use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Samples that are looked up, and samples that are looked at.
const SAMPLES: usize = 6000;
/// Part of the samples that a step trusts.
const TRUSTED: f64 = 0.65;

/// An upright mirror plane: points with `dot(normal, p) = offset`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MirrorPlane {
    /// Angle of the plane's normal from x towards z, radians.
    pub(crate) angle: f64,
    pub(crate) offset: f64,
    /// Root mean square distance of the trusted samples, millimetres.
    pub(crate) residual: f64,
}

impl MirrorPlane {
    pub(crate) fn normal(&self) -> DVec3 {
        DVec3::new(self.angle.cos(), 0.0, self.angle.sin())
    }
}

struct Sample {
    at: DVec3,
    normal: DVec3,
}

/// Samples in cubes, for near-neighbour queries.
struct Cubes {
    low: DVec3,
    side: f64,
    count: [usize; 3],
    starts: Vec<u32>,
    order: Vec<u32>,
}

impl Cubes {
    fn new(samples: &[Sample], side: f64) -> Self {
        let (mut low, mut high) = (DVec3::MAX, DVec3::MIN);
        for s in samples {
            low = low.min(s.at);
            high = high.max(s.at);
        }
        let count = ((high - low) / side).to_array().map(|c| c as usize + 1);
        let cell = |p: DVec3| {
            let c = ((p - low) / side).to_array().map(|c| c as usize);
            (c[0] * count[1] + c[1]) * count[2] + c[2]
        };
        let cells: Vec<usize> = samples.iter().map(|s| cell(s.at)).collect();
        let mut starts = vec![0u32; count.iter().product::<usize>() + 1];
        for c in &cells {
            starts[c + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        let mut order = vec![0u32; samples.len()];
        for (i, c) in cells.iter().enumerate() {
            order[next[*c] as usize] = i as u32;
            next[*c] += 1;
        }
        Self { low, side, count, starts, order }
    }

    /// Nearest sample whose normal agrees, within one cube's side.
    fn nearest(&self, samples: &[Sample], p: DVec3, normal: DVec3) -> Option<(usize, f64)> {
        let c = ((p - self.low) / self.side).floor();
        let mut best: Option<(usize, f64)> = None;
        for dx in -1..=1 {
            for dy in -1..=1 {
                for dz in -1..=1 {
                    let q = [c.x as i64 + dx, c.y as i64 + dy, c.z as i64 + dz];
                    if q.iter().zip(self.count).any(|(v, n)| *v < 0 || *v >= n as i64) {
                        continue;
                    }
                    let cell =
                        (q[0] as usize * self.count[1] + q[1] as usize) * self.count[2] + q[2] as usize;
                    for &i in &self.order[self.starts[cell] as usize..self.starts[cell + 1] as usize] {
                        let s = &samples[i as usize];
                        let d = s.at.distance_squared(p);
                        if best.is_none_or(|b| d < b.1) && s.normal.dot(normal) > 0.3 {
                            best = Some((i as usize, d));
                        }
                    }
                }
            }
        }
        best.map(|(i, d)| (i, d.sqrt()))
    }
}

/// Points spread evenly by area, always the same ones.
fn samples(mesh: &TriMesh, count: usize) -> Vec<Sample> {
    let total: f64 = (0..mesh.faces.len() as u32).map(|f| mesh.area_normal(f).length()).sum();
    let step = total / count as f64;
    let mut out = Vec::with_capacity(count + 1);
    let mut next = step * 0.5;
    let mut sum = 0.0;
    for f in 0..mesh.faces.len() as u32 {
        let n = mesh.area_normal(f);
        let area = n.length();
        sum += area;
        while next < sum {
            // The R2 sequence spreads several samples of one large triangle.
            let k = out.len() as f64 + 1.0;
            let (mut u, mut v) =
                ((k * 0.754_877_666_246_692_7).fract(), (k * 0.569_840_290_998_053_2).fract());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let [a, b, c] = mesh.corners(f);
            out.push(Sample { at: a + (b - a) * u + (c - a) * v, normal: n / area });
            next += step;
        }
    }
    out
}

/// Best mirror plane of a mesh in millimetres with y up; `None` if the surface has no area.
pub(crate) fn mirror_plane(mesh: &TriMesh) -> Option<MirrorPlane> {
    // Forms and models are often mirrored to the bit: no plane can be better then.
    if is_mirrored(mesh) {
        return Some(MirrorPlane { angle: 0.0, offset: 0.0, residual: 0.0 });
    }
    let samples = samples(mesh, SAMPLES);
    if samples.len() < 100 {
        return None;
    }
    let cubes = Cubes::new(&samples, 60.0);
    let middle = samples.iter().map(|s| s.at).sum::<DVec3>() / samples.len() as f64;
    let centre = DVec2::new(middle.x, middle.z);
    let steps = 45;
    let coarse: Vec<MirrorPlane> = (0..steps)
        .into_par_iter()
        .map(|i| {
            let angle = std::f64::consts::PI * f64::from(i) / f64::from(steps);
            let offset = centre.dot(DVec2::new(angle.cos(), angle.sin()));
            refine(&samples, &cubes, MirrorPlane { angle, offset, residual: f64::INFINITY }, 13, 1)
        })
        .collect();
    let mut ranked: Vec<usize> = (0..coarse.len()).collect();
    ranked.sort_by(|a, b| coarse[*a].residual.total_cmp(&coarse[*b].residual));
    let mut starts: Vec<MirrorPlane> = Vec::new();
    for i in ranked {
        if starts.len() < 4 && starts.iter().all(|s| apart(s.angle, coarse[i].angle) > 0.12) {
            starts.push(coarse[i]);
        }
    }
    let fine: Vec<MirrorPlane> = starts.into_par_iter().map(|s| refine(&samples, &cubes, s, 3, 14)).collect();
    fine.into_iter().min_by(|a, b| a.residual.total_cmp(&b.residual))
}

/// Whether every node has its mirror image in the plane x = 0, to the bit. O(n log n).
fn is_mirrored(mesh: &TriMesh) -> bool {
    let key = |p: &DVec3| {
        // Of the two zeros the positive one.
        let [x, y, z] = [p.x.abs(), p.y + 0.0, p.z + 0.0].map(f64::to_bits);
        ([y, x, z], i32::from(p.x > 0.0) - i32::from(p.x < 0.0))
    };
    let mut keys: Vec<([u64; 3], i32)> = mesh.positions.iter().map(key).collect();
    keys.sort_unstable();
    !keys.is_empty()
        && keys.chunk_by(|a, b| a.0 == b.0).all(|same| same.iter().map(|k| k.1).sum::<i32>() == 0)
}

/// Angle between two undirected lines.
fn apart(a: f64, b: f64) -> f64 {
    let d = (a - b).rem_euclid(std::f64::consts::PI);
    d.min(std::f64::consts::PI - d)
}

fn refine(
    samples: &[Sample],
    cubes: &Cubes,
    start: MirrorPlane,
    stride: usize,
    rounds: usize,
) -> MirrorPlane {
    let mut plane = start;
    for round in 0..=rounds {
        let n = plane.normal();
        let turn = DVec3::new(-n.z, 0.0, n.x);
        let reflect = |v: DVec3| v - n * (2.0 * n.dot(v));
        let mut pairs: Vec<(f64, DVec2, f64)> = Vec::with_capacity(samples.len() / stride + 1);
        let mut lost = 0usize;
        for s in samples.iter().step_by(stride) {
            let p = s.at - n * (2.0 * (n.dot(s.at) - plane.offset));
            let Some((i, d)) = cubes.nearest(samples, p, reflect(s.normal)) else {
                lost += 1;
                continue;
            };
            let m = samples[i].normal;
            let gap = m.dot(p - samples[i].at);
            // d(p)/d(angle) and d(p)/d(offset)
            let by_angle = -(turn * (2.0 * (n.dot(s.at) - plane.offset)) + n * (2.0 * turn.dot(s.at)));
            pairs.push((d, DVec2::new(m.dot(by_angle), m.dot(n) * 2.0), gap));
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let wanted = ((pairs.len() + lost) as f64 * TRUSTED) as usize;
        let missing = wanted.saturating_sub(pairs.len());
        pairs.truncate(wanted);
        let square = pairs.iter().map(|p| p.2 * p.2).sum::<f64>() + missing as f64 * cubes.side * cubes.side;
        plane.residual = (square / wanted.max(1) as f64).sqrt();
        if round == rounds || pairs.len() < 20 {
            break;
        }
        let (mut aa, mut ab, mut bb, mut ra, mut rb) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (_, j, r) in &pairs {
            aa += j.x * j.x;
            ab += j.x * j.y;
            bb += j.y * j.y;
            ra += j.x * r;
            rb += j.y * r;
        }
        let det = aa * bb - ab * ab;
        if det.abs() < 1e-9 * aa * bb {
            break;
        }
        plane.angle -= (ra * bb - rb * ab) / det;
        plane.offset -= (rb * aa - ra * ab) / det;
    }
    plane
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mirrored_to_the_bit_or_not() {
        let half = [DVec3::new(3.0, 1.0, 2.0), DVec3::new(0.0, -0.0, 1.0), DVec3::new(5.0, 1.0, -2.0)];
        let mut positions = half.to_vec();
        positions.extend(half.iter().map(|p| DVec3::new(-p.x, p.y, p.z)));
        positions.push(DVec3::new(-0.0, 0.0, 1.0));
        let mut mesh = TriMesh::new(positions, vec![[0, 1, 2]]);
        assert!(is_mirrored(&mesh));
        mesh.positions[3].x = (-3.0f64).next_up();
        assert!(!is_mirrored(&mesh));
        mesh.positions[3] = mesh.positions[0];
        assert!(!is_mirrored(&mesh), "twice on one side");
        assert!(!is_mirrored(&TriMesh::new(Vec::new(), Vec::new())));
    }
}
