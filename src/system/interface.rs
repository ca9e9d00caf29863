//! What the parts of all ranks leave for the unknowns between them, and its solution, the same on every rank.
//!
//! With I the unknowns that only one rank touches and Γ those it shares, its own entries (not summed over the ranks) are
//!
//! ```text
//! [ A_II  A_IΓ ]      S = Σ over ranks of  A_ΓΓ - A_ΓI A_II⁻¹ A_IΓ
//! [ A_ΓI  A_ΓΓ ]      S x_Γ = b_Γ - Σ A_ΓI A_II⁻¹ b_I,   A_II x_I = b_I - A_IΓ x_Γ
//! ```
//!
//! (Przemieniecki 1963, AIAA J. 1, 138-147), by one forward and one backward substitution with what is shared in between. A
//! sheet is long and thin: Γ is a few cuts through its thickness, S is small and dense, and all the rest needs no message.

use mpi::collective::SystemOperation;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives};
use petsc::{FactorKind, FactorStatus, Factorization, Matrix, MatrixRef, Vector};

/// One rank's part of it.
pub(super) struct Interface {
    comm: SimpleCommunicator,
    inner: Factorization,
    shared: Vec<Shared>,
    /// This rank's Schur complement, its place in the sum of all ranks', and that sum; row by row.
    own_schur: Vec<f64>,
    part: Vec<f64>,
    schur: Vec<f64>,
    schur_matrix: Matrix,
    schur_factors: Factorization,
    /// Of one solve: this rank's part of the right-hand side, all of it, and the solution.
    shared_part: Vec<f64>,
    right_side: Vector,
    solution: Vector,
}

/// An unknown that elements of several ranks touch.
pub(super) struct Shared {
    /// Its number on this rank.
    pub unknown: usize,
    /// Its place among those of all ranks.
    pub place: usize,
    /// Whether this rank owns it.
    pub owned: bool,
}

impl Interface {
    /// For this rank's matrix, of whose unknowns these are shared, `count` by all ranks. Collective.
    pub(super) fn new(
        comm: &SimpleCommunicator,
        matrix: &MatrixRef,
        kind: FactorKind,
        shared: Vec<Shared>,
        count: usize,
        options_prefix: &str,
    ) -> petsc::Result<Self> {
        let alone = SimpleCommunicator::self_comm();
        let kept: Vec<i32> = shared.iter().map(|shared| shared.unknown as i32).collect();
        let inner = Factorization::keeping(matrix, kind, &kept, options_prefix)?;
        let full = |index: fn(usize, usize) -> usize| -> Vec<i32> {
            (0..count * count).map(|k| index(k, count) as i32).collect()
        };
        let (rows, columns) = (full(|k, n| k / n), full(|k, n| k % n));
        let mut schur_matrix = Matrix::from_coo(&alone, count, &rows, &columns)?;
        schur_matrix.set_values_coo(&vec![1.0; count * count])?;
        Ok(Self {
            comm: comm.duplicate(),
            inner,
            schur_factors: Factorization::new(&schur_matrix, kind)?,
            schur_matrix,
            own_schur: vec![0.0; shared.len() * shared.len()],
            part: vec![0.0; count * count],
            schur: vec![0.0; count * count],
            shared_part: vec![0.0; count],
            right_side: Vector::new(&alone, count)?,
            solution: Vector::new(&alone, count)?,
            shared,
        })
    }

    /// Factorises this rank's matrix, if it is `usable`. Says whether all ranks can use theirs. Collective.
    pub(super) fn factor(&mut self, matrix: &MatrixRef, usable: bool) -> petsc::Result<bool> {
        self.part.fill(0.0);
        if usable && self.inner.factor(matrix)? == FactorStatus::Ready {
            self.inner.schur_complement(&mut self.own_schur)?;
            let count = self.shared_part.len();
            let rows = self.own_schur.chunks_exact(self.shared.len().max(1));
            for (row, values) in self.shared.iter().zip(rows) {
                for (column, value) in self.shared.iter().zip(values) {
                    self.part[row.place * count + column.place] = *value;
                }
            }
        } else {
            // Every rank learns of it with the sum.
            self.part[0] = f64::NAN;
        }
        let sum = SystemOperation::sum();
        self.comm
            .all_reduce_into(&self.part[..], &mut self.schur[..], sum);
        if self.schur[0].is_nan() {
            return Ok(false);
        }
        self.schur_matrix.set_values_coo(&self.schur)?;
        Ok(self.schur_factors.factor(&self.schur_matrix)? == FactorStatus::Ready)
    }

    /// Solves for this rank's right-hand side, in which the ranks' parts of what is shared are to be added. Collective.
    pub(super) fn solve(&mut self, b: &Vector, x: &mut Vector) -> petsc::Result<()> {
        self.inner.solve_with(b, x, |kept| {
            self.shared_part.fill(0.0);
            for (shared, value) in self.shared.iter().zip(&*kept) {
                self.shared_part[shared.place] = *value;
            }
            let mut sum = self.right_side.write()?;
            self.comm
                .all_reduce_into(&self.shared_part[..], &mut sum[..], SystemOperation::sum());
            drop(sum);
            self.schur_factors
                .solve(&self.right_side, &mut self.solution)?;
            let found = self.solution.read()?;
            for (shared, value) in self.shared.iter().zip(kept) {
                *value = found[shared.place];
            }
            Ok(())
        })
    }
}
