//! The condensed system solved by substructures: each rank eliminates what only its own elements touch, and what is left,
//! the unknowns between the ranks, is solved by all of them alike.
//!
//! With I the inner unknowns of a rank and Γ those it shares, its own entries (not summed over the ranks) are
//!
//! ```text
//! [ A_II  A_IΓ ]      S = Σ over ranks of  A_ΓΓ - A_ΓI A_II⁻¹ A_IΓ
//! [ A_ΓI  A_ΓΓ ]      S x_Γ = b_Γ - Σ A_ΓI A_II⁻¹ b_I,   A_II x_I = b_I - A_IΓ x_Γ
//! ```
//!
//! (Przemieniecki 1963, AIAA J. 1, 138-147), by one forward and one backward substitution with what is shared in between. A sheet is long and thin: Γ is a few cuts through its thickness, S is small
//! and dense, and all the rest needs no message. The same numbers come out in every run, which the dynamic scheduling of a
//! parallel multifrontal solver does not promise.

use mpi::collective::SystemOperation;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives};
use petsc::{FactorKind, FactorStatus, Factorization, Matrix, Vector};

use super::System;
use super::condensation::CondensedPattern;

/// Beyond this number of shared unknowns the dense S costs more than it saves.
const MOST_SHARED: usize = 2000;

/// One rank's part of the solve.
pub(super) struct Substructures {
    comm: SimpleCommunicator,
    /// This rank's entries, summed over nobody else's.
    matrix: Matrix,
    inner: Factorization,
    /// Shared unknowns of this rank: local displacement, place among those of all ranks, and whether this
    /// rank owns it.
    shared: Vec<Shared>,
    /// Owned displacements: local, and place among those owned.
    owned: Vec<(usize, usize)>,
    /// This rank's Schur complement and the sum of all ranks', row by row.
    own_schur: Vec<f64>,
    part: Vec<f64>,
    schur: Vec<f64>,
    schur_matrix: Matrix,
    schur_factors: Factorization,
    work: Work,
}

struct Shared {
    local: usize,
    place: usize,
    owned: bool,
}

struct Work {
    right_side: Vector,
    solution: Vector,
    shared_part: Vec<f64>,
    shared_right_side: Vector,
    shared_solution: Vector,
}

impl Substructures {
    /// For the pattern of this rank's entries in local displacements; none on one rank, where nothing
    /// would be shared, nor where a rank has nothing of its own or too much is shared. Collective.
    pub(super) fn new(
        system: &System,
        pattern: &CondensedPattern,
        kind: FactorKind,
        options_prefix: &str,
    ) -> petsc::Result<Option<Self>> {
        let (comm, local) = (system.comm(), system.local());
        let all = 2 * local.nodes.len();
        let (shared, count) = shared_unknowns(system);
        let mut unfit = i32::from(count == 0 || count > MOST_SHARED || shared.len() == all);
        let mine = unfit;
        comm.all_reduce_into(&mine, &mut unfit, SystemOperation::max());
        if unfit > 0 {
            return Ok(None);
        }
        let alone = SimpleCommunicator::self_comm();
        let mut matrix = Matrix::from_coo(&alone, all, &pattern.rows, &pattern.columns)?;
        // The analysis wants entries, and must not depend on which: a restart begins with others.
        matrix.set_values_coo(&vec![1.0; pattern.rows.len()])?;
        let kept: Vec<i32> = shared.iter().map(|shared| shared.local as i32).collect();
        let inner = Factorization::keeping(&matrix, kind, &kept, options_prefix)?;
        let full = |index: fn(usize, usize) -> usize| -> Vec<i32> {
            (0..count * count).map(|k| index(k, count) as i32).collect()
        };
        let (rows, columns) = (full(|k, n| k / n), full(|k, n| k % n));
        let mut schur_matrix = Matrix::from_coo(&alone, count, &rows, &columns)?;
        schur_matrix.set_values_coo(&vec![1.0; count * count])?;
        Ok(Some(Self {
            comm: comm.duplicate(),
            schur_factors: Factorization::new(&schur_matrix, kind)?,
            schur_matrix,
            own_schur: vec![0.0; shared.len() * shared.len()],
            part: vec![0.0; count * count],
            schur: vec![0.0; count * count],
            work: Work {
                right_side: Vector::new(&alone, all)?,
                solution: Vector::new(&alone, all)?,
                shared_part: vec![0.0; count],
                shared_right_side: Vector::new(&alone, count)?,
                shared_solution: Vector::new(&alone, count)?,
            },
            matrix,
            inner,
            shared,
            owned: owned_unknowns(system),
        }))
    }

    /// Factorises for the entries of this rank. Says whether the matrix can be used. Collective.
    pub(super) fn factor(&mut self, values: &[f64]) -> petsc::Result<bool> {
        self.matrix.set_values_coo(values)?;
        let ready = self.inner.factor(&self.matrix)? == FactorStatus::Ready;
        self.part.fill(0.0);
        if ready {
            self.inner.schur_complement(&mut self.own_schur)?;
            let count = self.work.shared_part.len();
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

    /// Solves for the right-hand side `b`, of which this rank knows all its local displacements, and returns
    /// those it owns in `out`. Collective.
    pub(super) fn solve(&mut self, b: &[f64], out: &mut Vector) -> petsc::Result<()> {
        let work = &mut self.work;
        let mut right_side = work.right_side.write()?;
        right_side.copy_from_slice(b);
        for shared in self.shared.iter().filter(|shared| !shared.owned) {
            right_side[shared.local] = 0.0;
        }
        drop(right_side);
        self.inner
            .solve_with(&work.right_side, &mut work.solution, |kept| {
                work.shared_part.fill(0.0);
                for (shared, value) in self.shared.iter().zip(&*kept) {
                    work.shared_part[shared.place] = *value;
                }
                let mut sum = work.shared_right_side.write()?;
                self.comm.all_reduce_into(
                    &work.shared_part[..],
                    &mut sum[..],
                    SystemOperation::sum(),
                );
                drop(sum);
                self.schur_factors
                    .solve(&work.shared_right_side, &mut work.shared_solution)?;
                let found = work.shared_solution.read()?;
                for (shared, value) in self.shared.iter().zip(kept) {
                    *value = found[shared.place];
                }
                Ok(())
            })?;
        let (solution, mut out) = (work.solution.read()?, out.write()?);
        for &(local, place) in &self.owned {
            out[place] = solution[local];
        }
        Ok(())
    }
}

/// The shared unknowns of this rank, and the number of those of all ranks.
fn shared_unknowns(system: &System) -> (Vec<Shared>, usize) {
    let (local, places) = (system.local(), shared_nodes(system));
    let mine = (0..2 * local.nodes.len()).filter_map(|unknown| {
        let place = places[local.nodes[unknown / 2]]?;
        Some(Shared {
            local: unknown,
            place: 2 * place + unknown % 2,
            owned: local.owned[unknown / 2],
        })
    });
    (mine.collect(), 2 * places.iter().flatten().count())
}

/// The owned displacements of this rank: local number, and place among those owned.
fn owned_unknowns(system: &System) -> Vec<(usize, usize)> {
    let (local, numbering) = (system.local(), system.numbering());
    let first = numbering.rank_displacements[system.comm().rank() as usize];
    (0..2 * local.nodes.len())
        .filter(|unknown| local.owned[unknown / 2])
        .map(|unknown| {
            let row = numbering.displacement_row(local.nodes[unknown / 2]);
            (unknown, row + unknown % 2 - first)
        })
        .collect()
}

/// For each node of the mesh its place among those that elements of several ranks touch.
fn shared_nodes(system: &System) -> Vec<Option<usize>> {
    let local = system.local();
    let mesh = &local.problem.mesh;
    let owner = &system.numbering().node_owner;
    let mut shared = vec![false; mesh.nodes.len()];
    for (nodes, &rank) in mesh.elements.iter().zip(system.partition()) {
        for &node in nodes {
            shared[node] |= owner[node] != rank;
        }
    }
    let mut next = 0;
    shared
        .into_iter()
        .map(|shared| {
            shared.then(|| {
                next += 1;
                next - 1
            })
        })
        .collect()
}
