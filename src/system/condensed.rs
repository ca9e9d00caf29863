//! The linear solve of a Newton step on the reduced set, without its contact unknowns.
//!
//! The condensed matrix has the same pattern for the whole run, so a direct solver analyses it once.
//! PETSc's options for its solver begin with `-condensed_`.

use std::cell::RefCell;
use std::rc::Rc;

use mpi::traits::Communicator;
use petsc::{Ksp, Matrix, Scatter, Vector, VectorRef};

use super::System;
use super::elimination::Elimination;

/// Prefix of the options of the condensed system's solver.
const PREFIX: &str = "condensed_";

/// Solves with the last Jacobian of a [`System`] and an active set.
pub struct CondensedSolve {
    system: Rc<System>,
    scatter: Scatter,
    parts: RefCell<Parts>,
}

/// What changes from solve to solve, allocated once.
struct Parts {
    elimination: Elimination,
    matrix: Matrix,
    solver: Ksp,
    right_side: Vector,
    step: Vector,
    /// Of all local displacements: steps, and additions to the right-hand side.
    local_step: Vec<f64>,
    local_right_side: Vec<f64>,
}

impl CondensedSolve {
    /// Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn new(system: Rc<System>) -> petsc::Result<Self> {
        let (comm, local, numbering) = (system.comm(), system.local(), &system.numbering);
        let (elimination, pattern) = Elimination::new(&local, numbering, comm.rank() as usize);
        let owned = system.owned_displacements();
        let matrix = Matrix::from_coo(comm, owned, &pattern.rows, &pattern.columns)?;
        let right_side = Vector::new(comm, owned)?;
        let rows: Vec<i32> = local
            .nodes
            .iter()
            .map(|&node| numbering.displacement_row(node) as i32)
            .flat_map(|row| [row, row + 1])
            .collect();
        let parts = Parts {
            solver: solver(comm, &matrix, local.problem.friction_coefficient == 0.0)?,
            elimination,
            matrix,
            step: right_side.duplicate()?,
            local_step: vec![0.0; rows.len()],
            local_right_side: vec![0.0; rows.len()],
            right_side,
        };
        let scatter = Scatter::new(&parts.right_side, &rows)?;
        drop(local);
        Ok(Self {
            system,
            scatter,
            parts: RefCell::new(parts),
        })
    }

    /// Factorises for the system's last Jacobian and this rank's active set (ascending global rows).
    /// Says whether the matrix can be used. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn factor(&self, active: &[i32]) -> petsc::Result<bool> {
        let Parts {
            elimination,
            matrix,
            solver,
            ..
        } = &mut *self.parts.borrow_mut();
        let jacobian = self.system.jacobian_values();
        matrix.set_values_coo(elimination.condense(&jacobian, active))?;
        Ok(!solver.set_up()?.is_diverged())
    }

    /// Solves for a right-hand side `r` on the reduced set, whose unknowns are in the order of their
    /// global rows. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn solve(&self, r: &VectorRef, step: &mut VectorRef) -> petsc::Result<()> {
        let Parts {
            elimination,
            solver,
            right_side,
            step: condensed_step,
            local_step,
            local_right_side,
            ..
        } = &mut *self.parts.borrow_mut();
        let r = r.read()?;
        let owned = self.system.owned_displacements();
        right_side.write()?.copy_from_slice(&r[..owned]);
        // The row of a prescribed displacement is its step.
        self.scatter.forward(right_side, local_step)?;
        elimination.forward(&r, local_step, local_right_side);
        self.scatter.reverse_add(local_right_side, right_side)?;
        solver.solve(right_side, condensed_step)?;
        self.scatter.forward(condensed_step, local_step)?;
        let mut step = step.write()?;
        step[..owned].copy_from_slice(&condensed_step.read()?);
        elimination.backward(&r, local_step, &mut step);
        Ok(())
    }

    /// The package that factorises, or the method that chooses it on each rank.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn factor_solver(&self) -> petsc::Result<Option<String>> {
        let solver = &self.parts.borrow().solver;
        Ok(solver.factor_solver()?.or(solver.preconditioner()?))
    }
}

/// The solver of the condensed system: a direct one, whose package and ordering the options choose.
fn solver<C: Communicator>(comm: &C, matrix: &Matrix, symmetric: bool) -> petsc::Result<Ksp> {
    let mut solver = Ksp::new(comm)?;
    solver.set_options_prefix(PREFIX)?;
    solver.set_operator(matrix)?;
    solver.set_type("preonly")?;
    solver.set_preconditioner(if symmetric { "cholesky" } else { "lu" })?;
    solver.set_from_options()?;
    Ok(solver)
}
