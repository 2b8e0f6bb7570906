//! Sparse Cholesky factors (faer) with a symbolic part that is kept and a residual that is looked at.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side, Spec};
use glam::DVec3;

use super::ordering::nested_dissection;

/// Why a system could not be solved.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FactorError {
    /// Not positive definite: what is fixed does not hold the surface.
    #[error("the fixed nodes do not hold the surface (singular system)")]
    Singular,
    /// Too large for memory or for the index type.
    #[error("the system is too large")]
    TooLarge,
    /// The residual stays large.
    #[error("the relative residual is {residual:.1e}; the triangles are too thin to compute with")]
    Inaccurate {
        /// Largest residual over largest right-hand side.
        residual: f64,
    },
}

/// Largest relative residual that a solution may leave.
const LARGEST_RESIDUAL: f64 = 1e-7;

/// A residual below this is not refined any further.
const GOOD_RESIDUAL: f64 = 1e-11;

/// Where a symmetric matrix (lower triangle by columns) has entries, and its symbolic factor.
pub struct SymmetricPattern {
    matrix: SymbolicSparseColMat<u32>,
    /// Entry of the matrix that each listed pair adds to, in the order of the list.
    slots: Vec<u32>,
    /// Entry of each diagonal element.
    diagonal: Vec<u32>,
    symbolic: SymbolicCholesky<u32>,
}

impl SymmetricPattern {
    /// The pattern of an `n` × `n` matrix from `[row, column]` pairs (row ≥ column; repeated pairs share an entry; the
    /// diagonal is always there). `places` give the elimination order by nested dissection. O(n log n + pairs).
    ///
    /// # Errors
    /// [`FactorError::TooLarge`].
    pub fn new(
        n: usize,
        pairs: impl Iterator<Item = [u32; 2]> + Clone,
        places: &[DVec3],
    ) -> Result<Self, FactorError> {
        let mut starts = vec![0u32; n + 1];
        let mut total = 0usize;
        for [_, column] in pairs.clone() {
            starts[column as usize + 1] += 1;
            total += 1;
        }
        if total + n >= u32::MAX as usize {
            return Err(FactorError::TooLarge);
        }
        // Room for the diagonal too.
        for c in 0..n {
            starts[c + 1] += starts[c] + 1;
        }
        let mut fill = starts.clone();
        let mut rows = vec![0u32; total + n];
        for c in 0..n {
            rows[fill[c] as usize] = c as u32;
            fill[c] += 1;
        }
        for [row, column] in pairs.clone() {
            rows[fill[column as usize] as usize] = row;
            fill[column as usize] += 1;
        }
        // Sort and merge each column.
        let (mut columns, mut row_indices) = (vec![0u32; n + 1], Vec::with_capacity(total / 3 + n));
        for c in 0..n {
            let column = &mut rows[starts[c] as usize..starts[c + 1] as usize];
            column.sort_unstable();
            let mut last = u32::MAX;
            for &r in column.iter() {
                if r != last {
                    row_indices.push(r);
                    last = r;
                }
            }
            columns[c + 1] = row_indices.len() as u32;
        }
        let slot = |row: u32, column: u32| {
            let (from, to) = (columns[column as usize] as usize, columns[column as usize + 1] as usize);
            let column = &row_indices[from..to];
            (from + column.partition_point(|r| *r < row)) as u32
        };
        let slots = pairs.map(|[row, column]| slot(row, column)).collect();
        let diagonal = (0..n as u32).map(|c| slot(c, c)).collect();
        let order = nested_dissection(&columns, &row_indices, places);
        let matrix = SymbolicSparseColMat::new_checked(n, n, columns, None, row_indices);
        let mut inverse = vec![0u32; n];
        for (new, old) in order.iter().enumerate() {
            inverse[*old as usize] = new as u32;
        }
        let perm = faer::perm::PermRef::new_checked(&order, &inverse, n);
        let symbolic = factorize_symbolic_cholesky(
            matrix.as_ref(),
            Side::Lower,
            SymmetricOrdering::Custom(perm),
            CholeskySymbolicParams::default(),
        )
        .map_err(|_| FactorError::TooLarge)?;
        Ok(Self { matrix, slots, diagonal, symbolic })
    }

    /// Whether it was made of these pairs in this order: then it serves their matrix too.
    fn is_of(&self, n: usize, mut pairs: impl Iterator<Item = [u32; 2]>) -> bool {
        let (columns, rows) = (self.matrix.col_ptr(), self.matrix.row_idx());
        let mut slots = self.slots.iter();
        let fits = |[row, column]: [u32; 2]| {
            let (Some(slot), column) = (slots.next(), column as usize) else { return false };
            column < n && (columns[column]..columns[column + 1]).contains(slot) && rows[*slot as usize] == row
        };
        self.diagonal.len() == n && pairs.all(fits) && slots.next().is_none()
    }

    /// Number of entries of the factor.
    pub fn factor_size(&self) -> usize {
        self.symbolic.len_val()
    }
}

/// A pattern with values and their Cholesky factor.
pub struct SparseFactor {
    pattern: SymmetricPattern,
    /// Sums of the pairs' values.
    sums: Vec<f64>,
    /// The matrix: sums and diagonal.
    values: Vec<f64>,
    factor: Vec<f64>,
    memory: Option<MemBuffer>,
}

impl SparseFactor {
    /// An empty factor; give it values with [`Self::refactor`].
    pub fn new(pattern: SymmetricPattern) -> Self {
        let (entries, size) = (pattern.matrix.row_idx().len(), pattern.symbolic.len_val());
        let (sums, values) = (vec![0.0; entries], vec![0.0; entries]);
        Self { pattern, sums, values, factor: vec![0.0; size], memory: None }
    }

    /// The factor of an earlier matrix where it has the same pattern (its elimination order stays), else an empty one as
    /// [`SymmetricPattern::new`] makes it.
    ///
    /// # Errors
    /// [`FactorError::TooLarge`].
    pub fn reused(
        earlier: Option<Self>,
        n: usize,
        pairs: impl Iterator<Item = [u32; 2]> + Clone,
        places: &[DVec3],
    ) -> Result<Self, FactorError> {
        match earlier.filter(|factor| factor.pattern.is_of(n, pairs.clone())) {
            Some(factor) => Ok(factor),
            None => Ok(Self::new(SymmetricPattern::new(n, pairs, places)?)),
        }
    }

    /// Sums `values` (one for each pair of the pattern, in its order) and `diagonal` up and factors.
    ///
    /// # Errors
    /// [`FactorError::Singular`] when the matrix is not positive definite.
    pub fn refactor(
        &mut self,
        values: impl Iterator<Item = f64>,
        diagonal: &[f64],
    ) -> Result<(), FactorError> {
        self.set_values(values);
        self.refactor_with(diagonal)
    }

    /// Sums up `values`, one for each pair of the pattern, in its order.
    pub fn set_values(&mut self, values: impl Iterator<Item = f64>) {
        self.sums.fill(0.0);
        for (slot, v) in self.pattern.slots.iter().zip(values) {
            self.sums[*slot as usize] += v;
        }
    }

    /// Factors the sum of the values set last and `diagonal`.
    ///
    /// # Errors
    /// [`FactorError::Singular`] when the matrix is not positive definite.
    pub fn refactor_with(&mut self, diagonal: &[f64]) -> Result<(), FactorError> {
        self.values.copy_from_slice(&self.sums);
        for (slot, v) in self.pattern.diagonal.iter().zip(diagonal) {
            self.values[*slot as usize] += v;
        }
        // One thread: the same sums in the same order everywhere, and small fronts gain nothing from more.
        let scratch = self.pattern.symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
        let mut memory = match self.memory.take() {
            Some(memory) => memory,
            None => MemBuffer::try_new(scratch).map_err(|_| FactorError::TooLarge)?,
        };
        let matrix = SparseColMatRef::new(self.pattern.matrix.as_ref(), &self.values[..]);
        let done = self.pattern.symbolic.factorize_numeric_llt(
            &mut self.factor,
            matrix,
            Side::Lower,
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Spec::default(),
        );
        let done = done.map(|_| ()).map_err(|_| FactorError::Singular);
        self.memory = Some(memory);
        done
    }

    /// Solves for `columns` right-hand sides (column-major). `apply` is the matrix' product with that many columns, for
    /// the residual: one or two steps of refinement are taken when it is not good.
    ///
    /// # Errors
    /// [`FactorError::Inaccurate`].
    pub fn solve(
        &self,
        rhs: &[f64],
        columns: usize,
        apply: &dyn Fn(&[f64], &mut [f64]),
    ) -> Result<Vec<f64>, FactorError> {
        let mut x = rhs.to_vec();
        self.back_substitute(&mut x, columns)?;
        let largest = |v: &[f64]| v.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let scale = largest(rhs);
        if scale == 0.0 {
            return Ok(x);
        }
        let mut residual = vec![0.0; rhs.len()];
        let mut relative = f64::INFINITY;
        for _ in 0..3 {
            apply(&x, &mut residual);
            residual.iter_mut().zip(rhs).for_each(|(r, b)| *r = b - *r);
            let now = largest(&residual) / scale;
            if !now.is_finite() {
                return Err(FactorError::Inaccurate { residual: now });
            }
            let stalled = now > 0.5 * relative;
            relative = now;
            if relative <= GOOD_RESIDUAL || stalled {
                break;
            }
            self.back_substitute(&mut residual, columns)?;
            x.iter_mut().zip(&residual).for_each(|(x, r)| *x += r);
        }
        if relative > LARGEST_RESIDUAL {
            return Err(FactorError::Inaccurate { residual: relative });
        }
        Ok(x)
    }

    fn back_substitute(&self, x: &mut [f64], columns: usize) -> Result<(), FactorError> {
        let n = self.pattern.symbolic.nrows();
        let scratch = self.pattern.symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq);
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| FactorError::TooLarge)?;
        let llt = LltRef::new(&self.pattern.symbolic, &self.factor);
        let rhs = MatMut::from_column_major_slice_mut(x, n, columns);
        llt.solve_in_place_with_conj(Conj::No, rhs, Par::Seq, MemStack::new(&mut memory));
        Ok(())
    }
}
