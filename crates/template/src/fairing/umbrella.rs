//! The paper's fairing: the second-order umbrella, iterated (Kobbelt, Campagna, Vorsatz & Seidel 1998; Kobbelt 2000).
//!
//! `U(p)` is the mean of the neighbours less `p`; `U²(p)` the mean of the neighbours' `U` less `U(p)`. One step moves every
//! free node by `−U²(p) / ν` with `ν = 1 + (1/n) Σ 1/nⱼ`, all at once. All neighbours count alike, whatever their distance,
//! so uneven triangles bend the result: [`plate`](super::plate) does without that and is the default.

use std::collections::VecDeque;

use faer::sparse::{SparseColMat, Triplet};
use glam::DVec3;

use super::factor::FactorError;

/// A neighbourhood graph in flat arrays, renumbered so that neighbours lie close in memory.
pub struct Umbrella {
    /// New number of each node.
    order: Vec<u32>,
    starts: Vec<u32>,
    neighbours: Vec<u32>,
    /// 1/n
    share: Vec<f64>,
    /// −1/ν of free nodes, 0 for fixed ones.
    step: Vec<f64>,
}

/// A position on its own 32 bytes: two loads of two lanes each.
#[derive(Clone, Copy, Default)]
#[repr(align(32))]
struct Lane([f64; 4]);

impl Umbrella {
    /// Prepares the iteration over `fixed.len()` nodes. Nodes without faces never move. O(n log n).
    pub fn new(faces: &[[u32; 3]], fixed: &[bool]) -> Self {
        let n = fixed.len();
        let mut edges: Vec<[u32; 2]> = Vec::with_capacity(6 * faces.len());
        for f in faces {
            for i in 0..3 {
                let (a, b) = (f[i], f[(i + 1) % 3]);
                edges.push([a, b]);
                edges.push([b, a]);
            }
        }
        edges.sort_unstable();
        edges.dedup();
        let mut raw = vec![0u32; n + 1];
        for e in &edges {
            raw[e[0] as usize + 1] += 1;
        }
        for i in 0..n {
            raw[i + 1] += raw[i];
        }
        let around = |v: usize| &edges[raw[v] as usize..raw[v + 1] as usize];
        // Breadth first: neighbours get near numbers.
        let mut order = vec![u32::MAX; n];
        let mut old = Vec::with_capacity(n);
        let mut queue = VecDeque::new();
        for seed in 0..n {
            if order[seed] != u32::MAX {
                continue;
            }
            order[seed] = old.len() as u32;
            old.push(seed);
            queue.push_back(seed);
            while let Some(v) = queue.pop_front() {
                for e in around(v) {
                    let w = e[1] as usize;
                    if order[w] == u32::MAX {
                        order[w] = old.len() as u32;
                        old.push(w);
                        queue.push_back(w);
                    }
                }
            }
        }
        let mut starts = Vec::with_capacity(n + 1);
        starts.push(0);
        let mut neighbours = Vec::with_capacity(edges.len());
        let (mut share, mut step) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for &v in &old {
            let mut ring: Vec<u32> = around(v).iter().map(|e| order[e[1] as usize]).collect();
            ring.sort_unstable();
            neighbours.extend(&ring);
            starts.push(neighbours.len() as u32);
            let valence = ring.len() as f64;
            share.push(if ring.is_empty() { 0.0 } else { 1.0 / valence });
            let inverse: f64 = around(v).iter().map(|e| 1.0 / around(e[1] as usize).len() as f64).sum();
            let nu = 1.0 + inverse / valence.max(1.0);
            step.push(if fixed[v] || ring.is_empty() { 0.0 } else { -1.0 / nu });
        }
        Self { order, starts, neighbours, share, step }
    }

    /// Takes `steps` steps on all free nodes. O(steps · edges).
    pub fn iterate(&self, positions: &mut [DVec3], steps: usize) {
        let mut p = vec![Lane::default(); positions.len()];
        for (v, at) in positions.iter().zip(&self.order) {
            p[*at as usize] = Lane([v.x, v.y, v.z, 0.0]);
        }
        let mut u = p.clone();
        for _ in 0..steps {
            for (v, u) in u.iter_mut().enumerate() {
                let (mean, at) = (self.mean(v, &p), p[v].0);
                u.0 = [0, 1, 2, 3].map(|c| mean[c] - at[c]);
            }
            for (v, p) in p.iter_mut().enumerate() {
                let (mean, own, step) = (self.mean(v, &u), u[v].0, self.step[v]);
                p.0 = [0, 1, 2, 3].map(|c| p.0[c] + step * (mean[c] - own[c]));
            }
        }
        for (v, at) in positions.iter_mut().zip(&self.order) {
            let [x, y, z, _] = p[*at as usize].0;
            *v = DVec3::new(x, y, z);
        }
    }

    #[inline(always)]
    fn mean(&self, v: usize, of: &[Lane]) -> [f64; 4] {
        let ring = &self.neighbours[self.starts[v] as usize..self.starts[v + 1] as usize];
        let mut sum = [0.0; 4];
        if let Ok(six) = <&[u32; 6]>::try_from(ring) {
            // The common valence without a loop.
            for w in six {
                let q = &of[*w as usize].0;
                for c in 0..4 {
                    sum[c] += q[c];
                }
            }
        } else {
            for w in ring {
                let q = &of[*w as usize].0;
                for c in 0..4 {
                    sum[c] += q[c];
                }
            }
        }
        sum.map(|s| s * self.share[v])
    }

    /// The limit of the iteration, `U² = 0` at every free node, by one sparse LU factorisation.
    ///
    /// # Errors
    /// [`FactorError::Singular`] when the fixed nodes do not hold the surface.
    pub fn limit(&self, positions: &mut [DVec3]) -> Result<(), FactorError> {
        let n = self.order.len();
        let mut unknown = vec![u32::MAX; n];
        let mut count = 0;
        for (u, step) in unknown.iter_mut().zip(&self.step) {
            if *step != 0.0 {
                *u = count as u32;
                count += 1;
            }
        }
        if count == 0 {
            return Ok(());
        }
        let mut place = vec![DVec3::ZERO; n];
        for (p, at) in positions.iter().zip(&self.order) {
            place[*at as usize] = *p;
        }
        let mut triplets = Vec::with_capacity(40 * count);
        let mut rhs = faer::Mat::<f64>::zeros(count, 3);
        let ring = |v: usize| &self.neighbours[self.starts[v] as usize..self.starts[v + 1] as usize];
        for (v, &row) in unknown.iter().enumerate() {
            if row == u32::MAX {
                continue;
            }
            let mut add = |q: usize, k: f64| {
                if unknown[q] == u32::MAX {
                    for c in 0..3 {
                        rhs[(row as usize, c)] -= k * place[q][c];
                    }
                } else {
                    triplets.push(Triplet::new(row, unknown[q], k));
                }
            };
            let mut umbrella = |q: usize, k: f64| {
                add(q, -k);
                for w in ring(q) {
                    add(*w as usize, k * self.share[q]);
                }
            };
            umbrella(v, -1.0);
            for q in ring(v) {
                umbrella(*q as usize, self.share[v]);
            }
        }
        let matrix = SparseColMat::<u32, f64>::try_new_from_triplets(count, count, &triplets)
            .map_err(|_| FactorError::TooLarge)?;
        let lu = matrix.sp_lu().map_err(|_| FactorError::Singular)?;
        use faer::linalg::solvers::Solve;
        lu.solve_in_place(&mut rhs);
        for (p, at) in positions.iter_mut().zip(&self.order) {
            let u = unknown[*at as usize];
            if u != u32::MAX {
                *p = DVec3::new(rhs[(u as usize, 0)], rhs[(u as usize, 1)], rhs[(u as usize, 2)]);
                if !p.is_finite() {
                    return Err(FactorError::Singular);
                }
            }
        }
        Ok(())
    }
}
