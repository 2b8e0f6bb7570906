//! The symmetric system of a patch: two unknowns a node, 2×2 blocks at nodes and edges, one symbolic analysis for all
//! factorisations of the same patch.

use faer::{
    Conj, MatMut, Par, Side,
    dyn_stack::{MemBuffer, MemStack},
    linalg::cholesky::llt::factor::LltRegularization,
    sparse::{
        SparseColMatRef, SymbolicSparseColMatRef,
        linalg::{
            SupernodalThreshold, SymbolicSupernodalParams,
            cholesky::{
                CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
                factorize_symbolic_cholesky,
            },
        },
    },
};
use glam::DVec3;

use super::ordering::{Neighbours, nested_dissection};

/// The system did not factorise: it is not positive definite.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NotDefinite;

/// How much fill merged columns may bring, by their number: wide blocks are worth some zeros.
const RELAX: [(usize, f64); 4] = [(8, 1.0), (32, 0.9), (96, 0.3), (usize::MAX, 0.1)];

/// Lower triangle in compressed columns; unknown `2 place + axis`.
pub(crate) struct BlockSystem {
    /// Elimination place of every node.
    pub(crate) place: Vec<u32>,
    column_start: Vec<u32>,
    rows: Vec<u32>,
    values: Vec<f64>,
    edge_slots: Vec<EdgeSlot>,
    symbolic: SymbolicCholesky<u32>,
    factor: Vec<f64>,
    buffer: MemBuffer,
    solution: Vec<f64>,
}

/// Where the block of an edge lies in the values.
#[derive(Clone, Copy)]
struct EdgeSlot {
    /// Entry (row axis 0, column axis 0); the next is (1, 0).
    first: u32,
    /// Entry (row axis 0, column axis 1).
    second: u32,
    /// Whether the edge's first node is the column (eliminated first).
    first_is_column: bool,
}

impl BlockSystem {
    /// Analyses a system with a block for every node and every edge.
    pub(crate) fn new(positions: &[DVec3], edges: &[[u32; 2]]) -> Result<Self, NotDefinite> {
        let n = positions.len();
        let place = nested_dissection(positions, &Neighbours::new(n, edges));
        // Column blocks: (column place, row place, edge), sorted.
        let mut blocks: Vec<(u32, u32, u32)> = edges
            .iter()
            .enumerate()
            .map(|(e, &[a, b])| {
                let (p, q) = (place[a as usize], place[b as usize]);
                (p.min(q), p.max(q), e as u32)
            })
            .collect();
        blocks.sort_unstable();
        let mut column_start = Vec::with_capacity(2 * n + 1);
        let mut rows = Vec::with_capacity(3 * n + 4 * edges.len());
        let mut edge_slots = vec![EdgeSlot { first: 0, second: 0, first_is_column: true }; edges.len()];
        let mut at = 0;
        for p in 0..n as u32 {
            let from = at;
            while at < blocks.len() && blocks[at].0 == p {
                at += 1;
            }
            let below = &blocks[from..at];
            let (c0, degree) = (rows.len() as u32, below.len() as u32);
            let c1 = c0 + 2 + 2 * degree;
            column_start.push(c0);
            rows.extend([2 * p, 2 * p + 1]);
            rows.extend(below.iter().flat_map(|b| [2 * b.1, 2 * b.1 + 1]));
            column_start.push(c1);
            rows.push(2 * p + 1);
            rows.extend(below.iter().flat_map(|b| [2 * b.1, 2 * b.1 + 1]));
            for (k, b) in below.iter().enumerate() {
                let k = k as u32;
                edge_slots[b.2 as usize] = EdgeSlot {
                    first: c0 + 2 + 2 * k,
                    second: c1 + 1 + 2 * k,
                    first_is_column: place[edges[b.2 as usize][0] as usize] == p,
                };
            }
        }
        column_start.push(rows.len() as u32);
        // The analysis reads the upper triangle, the numeric factorisation the lower one.
        let (upper_start, upper_rows) = transpose(&column_start, &rows);
        let structure = SymbolicSparseColMatRef::new_checked(2 * n, 2 * n, &upper_start, None, &upper_rows);
        let threshold = if n < 150 {
            SupernodalThreshold::FORCE_SIMPLICIAL
        } else {
            SupernodalThreshold::FORCE_SUPERNODAL
        };
        let symbolic = factorize_symbolic_cholesky(
            structure,
            Side::Upper,
            SymmetricOrdering::Identity,
            CholeskySymbolicParams {
                supernodal_flop_ratio_threshold: threshold,
                supernodal_params: SymbolicSupernodalParams { relax: Some(&RELAX) },
                ..Default::default()
            },
        )
        .map_err(|_| NotDefinite)?;
        let need =
            symbolic
                .factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default())
                .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        Ok(Self {
            values: vec![0.0; rows.len()],
            factor: vec![0.0; symbolic.len_val()],
            buffer: MemBuffer::try_new(need).map_err(|_| NotDefinite)?,
            solution: vec![0.0; 2 * n],
            place,
            column_start,
            rows,
            edge_slots,
            symbolic,
        })
    }

    /// Sets all entries to zero.
    pub(crate) fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// Adds a symmetric block `[xx, xy, yy]` at a node.
    #[inline]
    pub(crate) fn add_node(&mut self, v: u32, block: [f64; 3]) {
        let p = 2 * self.place[v as usize] as usize;
        let (c0, c1) = (self.column_start[p] as usize, self.column_start[p + 1] as usize);
        self.values[c0] += block[0];
        self.values[c0 + 1] += block[1];
        self.values[c1] += block[2];
    }

    /// Adds a block at edge `e`: `block[i][j]` couples axis `i` of the node that is the edge's first when `forward`,
    /// else its second, with axis `j` of the other.
    #[inline]
    pub(crate) fn add_edge(&mut self, e: u32, forward: bool, block: [[f64; 2]; 2]) {
        let slot = self.edge_slots[e as usize];
        let (first, second) = (slot.first as usize, slot.second as usize);
        if slot.first_is_column == forward {
            self.values[first] += block[0][0];
            self.values[first + 1] += block[0][1];
            self.values[second] += block[1][0];
            self.values[second + 1] += block[1][1];
        } else {
            self.values[first] += block[0][0];
            self.values[first + 1] += block[1][0];
            self.values[second] += block[0][1];
            self.values[second + 1] += block[1][1];
        }
    }

    /// Mean diagonal entry: the scale of the matrix.
    pub(crate) fn mean_diagonal(&self) -> f64 {
        let n = self.solution.len();
        let sum: f64 = self.column_start[..n].iter().map(|&c| self.values[c as usize]).sum();
        sum / n as f64
    }

    /// Cholesky factorisation of the current entries.
    pub(crate) fn factorise(&mut self) -> Result<(), NotDefinite> {
        let n = self.solution.len();
        let structure = SymbolicSparseColMatRef::new_checked(n, n, &self.column_start, None, &self.rows);
        self.symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                SparseColMatRef::new(structure, &self.values),
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut self.buffer),
                Default::default(),
            )
            .map(|_| ())
            .map_err(|_| NotDefinite)
    }

    /// Solves with the last factor; `right` and the result are two numbers a node, in the nodes' order.
    pub(crate) fn solve(&mut self, right: &[[f64; 2]], out: &mut [[f64; 2]]) {
        for (v, r) in right.iter().enumerate() {
            let p = 2 * self.place[v] as usize;
            self.solution[p..p + 2].copy_from_slice(r);
        }
        let n = self.solution.len();
        LltRef::<'_, u32, f64>::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut self.solution, n, 1),
            Par::Seq,
            MemStack::new(&mut self.buffer),
        );
        for (v, o) in out.iter_mut().enumerate() {
            let p = 2 * self.place[v] as usize;
            o.copy_from_slice(&self.solution[p..p + 2]);
        }
    }
}

/// Transposed structure of compressed columns.
fn transpose(start: &[u32], rows: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let n = start.len() - 1;
    let mut out_start = vec![0u32; n + 1];
    rows.iter().for_each(|&r| out_start[r as usize + 1] += 1);
    for r in 0..n {
        out_start[r + 1] += out_start[r];
    }
    let mut fill = out_start.clone();
    let mut out = vec![0u32; rows.len()];
    for c in 0..n {
        for &r in &rows[start[c] as usize..start[c + 1] as usize] {
            out[fill[r as usize] as usize] = c as u32;
            fill[r as usize] += 1;
        }
    }
    (out_start, out)
}
