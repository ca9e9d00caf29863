//! The linear solve of a Newton step on the reduced set, without its contact unknowns.
//!
//! The condensed matrix has the same pattern for the whole run, so a direct solver analyses it once.

use std::cell::RefCell;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::log::Event;
use petsc::{Block, FactorKind, Ksp, Matrix, Scatter, Vector, VectorRef};

use super::System;
use super::condensation::{Condensation, CondensedPattern};
use super::substructures::Substructures;
use super::tangent::JacobianEntries;

/// How the condensed system is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SolverChoice {
    /// By whom.
    pub method: CondensedMethod,
    /// What PETSc's options for its solver begin with.
    pub options_prefix: &'static str,
}

/// Who solves the condensed system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CondensedMethod {
    /// Slices of the sheet by dense matrices, and what is left by a direct solver of PETSc, on several ranks each its own
    /// part; as [`CondensedMethod::Whole`] where too much lies between the ranks.
    Substructures,
    /// A linear solver of PETSc for the whole matrix.
    Whole,
}

/// Solves with a Jacobian and an active set.
pub struct CondensedSolve {
    scatter: Scatter,
    comm: SimpleCommunicator,
    /// Displacements this rank owns.
    owned: usize,
    parts: RefCell<Parts>,
    factoring: Event,
    solving: Event,
}

/// What changes from solve to solve, allocated once.
struct Parts {
    condensation: Condensation,
    solver: Solver,
    right_side: Vector,
    step: Vector,
    /// Of all local displacements: steps, and additions to the right-hand side.
    local_step: Vec<f64>,
    local_right_side: Vec<f64>,
}

/// Who solves the condensed system.
enum Solver {
    /// A linear solver of PETSc, with its matrix and room for its entries.
    Whole(Matrix, Ksp, Vec<f64>),
    /// Each rank its own elements slice by slice, and all together what is between them.
    Substructures(Box<Substructures>),
}

impl CondensedSolve {
    /// For the Jacobians of this system. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn new(system: &System, choice: SolverChoice) -> petsc::Result<Self> {
        let (comm, local, numbering) = (system.comm(), system.local(), system.numbering());
        let (condensation, pattern) = Condensation::new(local, numbering, comm.rank() as usize);
        let owned = system.owned_displacements();
        let right_side = Vector::new(comm, owned)?;
        let rows: Vec<i32> = local
            .nodes
            .iter()
            .map(|&node| numbering.displacement_row(node) as i32)
            .flat_map(|row| [row, row + 1])
            .collect();
        let parts = Parts {
            solver: Solver::new(system, pattern, &rows, choice)?,
            condensation,
            step: right_side.duplicate()?,
            local_step: vec![0.0; rows.len()],
            local_right_side: vec![0.0; rows.len()],
            right_side,
        };
        let scatter = Scatter::new(&parts.right_side, &rows)?;
        Ok(Self {
            scatter,
            comm: comm.duplicate(),
            owned,
            parts: RefCell::new(parts),
            factoring: Event::new("SheetFactor")?,
            solving: Event::new("SheetSolve")?,
        })
    }

    /// Factorises for a Jacobian and this rank's active set (ascending global rows). Says whether the matrix can be
    /// used. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn factor(&self, jacobian: &JacobianEntries, active: &[i32]) -> petsc::Result<bool> {
        let _event = self.factoring.begin();
        let Parts {
            condensation,
            solver,
            ..
        } = &mut *self.parts.borrow_mut();
        let entries = condensation.condense(jacobian, active);
        match solver {
            Solver::Whole(matrix, solver, all) => {
                entries.copy_to(all);
                matrix.set_values_coo(all)?;
                factorise(solver, matrix)
            }
            Solver::Substructures(solver) => solver.factor(entries),
        }
    }

    /// Solves for a right-hand side `r` on the reduced set, whose unknowns are in the order of their
    /// global rows. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn solve(&self, r: &VectorRef, step: &mut VectorRef) -> petsc::Result<()> {
        let _event = self.solving.begin();
        let parts = &mut *self.parts.borrow_mut();
        self.condense(parts, r)?;
        match &mut parts.solver {
            Solver::Whole(_, solver, _) => {
                solver.solve(&parts.right_side, &mut parts.step)?;
            }
            Solver::Substructures(solver) => {
                self.scatter
                    .forward(&parts.right_side, &mut parts.local_step)?;
                solver.solve(&parts.local_step, &mut parts.step)?;
            }
        }
        self.expand(parts, r, step)
    }

    /// The same for several right-hand sides, where possible at once, which costs MUMPS less than one after the other.
    /// Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn solve_all(&self, r: &[Vector], steps: &mut [Vector]) -> petsc::Result<()> {
        let together = matches!(self.parts.borrow().solver, Solver::Whole(..));
        if together && r.len() > 1 {
            return self.solve_together(r, steps);
        }
        let mut pairs = r.iter().zip(steps);
        pairs.try_for_each(|(r, step)| self.solve(r, step))
    }

    fn solve_together(&self, r: &[Vector], steps: &mut [Vector]) -> petsc::Result<()> {
        let parts = &mut *self.parts.borrow_mut();
        let mut right_sides = Block::new(&self.comm, self.owned, r.len())?;
        let mut condensed_steps = Block::new(&self.comm, self.owned, r.len())?;
        for (column, r) in r.iter().enumerate() {
            self.condense(parts, r)?;
            right_sides.set_column(column, &parts.right_side)?;
        }
        if let Solver::Whole(_, solver, _) = &mut parts.solver {
            solver.solve_block(&right_sides, &mut condensed_steps)?;
        }
        for (column, (r, step)) in r.iter().zip(steps).enumerate() {
            condensed_steps.copy_column(column, &mut parts.step)?;
            self.expand(parts, r, step)?;
        }
        Ok(())
    }

    /// The right-hand side of the condensed system.
    fn condense(&self, parts: &mut Parts, r: &VectorRef) -> petsc::Result<()> {
        let Parts {
            condensation,
            right_side,
            local_step,
            local_right_side,
            ..
        } = parts;
        let r = r.read()?;
        right_side.write()?.copy_from_slice(&r[..self.owned]);
        // The row of a prescribed displacement is its step.
        self.scatter.forward(right_side, local_step)?;
        condensation.forward(&r, local_step, local_right_side);
        self.scatter.reverse_add(local_right_side, right_side)
    }

    /// The step that belongs to the solution of the condensed system.
    fn expand(&self, parts: &mut Parts, r: &VectorRef, step: &mut VectorRef) -> petsc::Result<()> {
        let local_step = &mut parts.local_step;
        self.scatter.forward(&parts.step, local_step)?;
        let mut step = step.write()?;
        step[..self.owned].copy_from_slice(&parts.step.read()?);
        parts
            .condensation
            .backward(&r.read()?, local_step, &mut step);
        Ok(())
    }

    /// The package that factorises, or the method that chooses it on each rank.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn factor_solver(&self) -> petsc::Result<Option<String>> {
        match &self.parts.borrow().solver {
            Solver::Whole(_, solver, _) => Ok(solver.factor_solver()?.or(solver.preconditioner()?)),
            Solver::Substructures(solver) => solver.factor_solver(),
        }
    }
}

impl Solver {
    /// For a pattern in local displacements, whose global rows these are.
    fn new(
        system: &System,
        mut pattern: CondensedPattern,
        rows: &[i32],
        choice: SolverChoice,
    ) -> petsc::Result<Self> {
        let kind = match system.problem().friction_coefficient {
            0.0 => FactorKind::Symmetric,
            _ => FactorKind::General,
        };
        let prefix = choice.options_prefix;
        if choice.method == CondensedMethod::Substructures {
            pattern = match Substructures::new(system, pattern, kind, prefix)? {
                Ok(solver) => return Ok(Self::Substructures(Box::new(solver))),
                Err(pattern) => pattern,
            };
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
        let solver = direct_solver(system.comm(), &matrix, kind, prefix)?;
        Ok(Self::Whole(matrix, solver, vec![0.0; pattern.rows.len()]))
    }
}

/// Lets a solver take over the values of its matrix. Says whether it can be used.
pub(super) fn factorise(solver: &mut Ksp, matrix: &Matrix) -> petsc::Result<bool> {
    // Told anew, or it would factorise within the next solve, where a failure comes too late.
    solver.set_operator(matrix)?;
    Ok(!solver.set_up()?.is_diverged())
}

/// A solver of PETSc for this matrix, direct unless the options behind this prefix say otherwise.
pub(super) fn direct_solver(
    comm: &SimpleCommunicator,
    matrix: &Matrix,
    kind: FactorKind,
    options_prefix: &str,
) -> petsc::Result<Ksp> {
    let mut solver = Ksp::new(comm)?;
    solver.set_options_prefix(options_prefix)?;
    solver.set_operator(matrix)?;
    solver.set_type("preonly")?;
    solver.set_preconditioner(match kind {
        FactorKind::Symmetric => "cholesky",
        FactorKind::General => "lu",
    })?;
    solver.set_from_options()?;
    Ok(solver)
}
