//! The linear solve of a Newton step on the reduced set, without its contact unknowns.
//!
//! The condensed matrix has the same pattern for the whole run, so a direct solver analyses it once.
//! PETSc's options for its solver begin with `-condensed_`. On more than one rank the system is solved by
//! [substructures](super::substructures) unless the options choose otherwise.

use std::cell::RefCell;
use std::rc::Rc;

use mpi::traits::Communicator;
use petsc::{Ksp, Matrix, Scatter, Vector, VectorRef, options};

use super::System;
use super::elimination::{CondensedPattern, Elimination};
use super::substructures::Substructures;

/// Prefix of the options of the condensed system's solver.
pub(super) const PREFIX: &str = "condensed_";

/// Options that choose a solver of the whole condensed system.
const CHOICES: &[&str] = &["condensed_ksp_type", "condensed_pc_type"];
/// The package of that solver, and the only one that substructures work with.
const PACKAGE: (&str, &str) = ("condensed_pc_factor_mat_solver_type", "mumps");

/// Solves with the last Jacobian of a [`System`] and an active set.
pub struct CondensedSolve {
    system: Rc<System>,
    scatter: Scatter,
    parts: RefCell<Parts>,
}

/// What changes from solve to solve, allocated once.
struct Parts {
    elimination: Elimination,
    solver: Solver,
    right_side: Vector,
    step: Vector,
    /// Of all local displacements: steps, and additions to the right-hand side.
    local_step: Vec<f64>,
    local_right_side: Vec<f64>,
}

/// Who solves the condensed system.
enum Solver {
    /// A linear solver of PETSc, which the options choose.
    Whole(Matrix, Ksp),
    /// Each rank its own elements, and all together what is between them.
    Substructures(Box<Substructures>),
}

impl CondensedSolve {
    /// Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn new(system: Rc<System>) -> petsc::Result<Self> {
        let (comm, local, numbering) = (system.comm(), system.local(), &system.numbering);
        let (elimination, pattern) = Elimination::new(&local, numbering, comm.rank() as usize);
        let right_side = Vector::new(comm, system.owned_displacements())?;
        let rows: Vec<i32> = local
            .nodes
            .iter()
            .map(|&node| numbering.displacement_row(node) as i32)
            .flat_map(|row| [row, row + 1])
            .collect();
        let parts = Parts {
            solver: Solver::new(&system, pattern, &rows)?,
            elimination,
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
            solver,
            ..
        } = &mut *self.parts.borrow_mut();
        let jacobian = self.system.jacobian_values();
        let values = elimination.condense(&jacobian, active);
        match solver {
            Solver::Whole(matrix, solver) => {
                matrix.set_values_coo(values)?;
                Ok(!solver.set_up()?.is_diverged())
            }
            Solver::Substructures(solver) => solver.factor(values),
        }
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
        match solver {
            Solver::Whole(_, solver) => {
                solver.solve(right_side, condensed_step)?;
            }
            Solver::Substructures(solver) => {
                self.scatter.forward(right_side, local_step)?;
                solver.solve(local_step, condensed_step)?;
            }
        }
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
        match &self.parts.borrow().solver {
            Solver::Whole(_, solver) => Ok(solver.factor_solver()?.or(solver.preconditioner()?)),
            Solver::Substructures(_) => Ok(Some("mumps, substructures".to_owned())),
        }
    }
}

impl Solver {
    /// For a pattern in local displacements, whose rows are given.
    fn new(system: &System, mut pattern: CondensedPattern, rows: &[i32]) -> petsc::Result<Self> {
        let symmetric = system.local().problem.friction_coefficient == 0.0;
        let mut free = options::get(PACKAGE.0)?.is_none_or(|package| package == PACKAGE.1);
        for name in CHOICES {
            free &= !options::is_given(name)?;
        }
        if free && let Some(solver) = Substructures::new(system, &pattern, symmetric)? {
            return Ok(Self::Substructures(Box::new(solver)));
        }
        for index in pattern.rows.iter_mut().chain(&mut pattern.columns) {
            *index = usize::try_from(*index).map_or(-1, |local| rows[local]);
        }
        let matrix = Matrix::from_coo(
            system.comm(),
            system.owned_displacements(),
            &pattern.rows,
            &pattern.columns,
        )?;
        let solver = whole(system.comm(), &matrix, symmetric)?;
        Ok(Self::Whole(matrix, solver))
    }
}

/// The solver of the condensed system: a direct one, whose package and ordering the options choose.
fn whole<C: Communicator>(comm: &C, matrix: &Matrix, symmetric: bool) -> petsc::Result<Ksp> {
    let mut solver = Ksp::new(comm)?;
    solver.set_options_prefix(PREFIX)?;
    solver.set_operator(matrix)?;
    solver.set_type("preonly")?;
    solver.set_preconditioner(if symmetric { "cholesky" } else { "lu" })?;
    solver.set_from_options()?;
    Ok(solver)
}
