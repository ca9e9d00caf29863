//! Nonlinear solvers.
//!
//! In: a residual, a tangent matrix, bounds and hooks as closures. Out: a solution and the reason why
//! the solver stopped. Never: a choice of method; that is made by options.

mod bounds;
mod closures;
mod line_search;

use std::ptr;

use mpi::topology::Communicator;
use petsc_sys as sys;

use crate::{
    KspReason, KspRef, MatrixRef, SnesReason, VectorRef,
    error::{Error, Result, check, text_of},
    handle::petsc_object,
    options,
    session::{c_string, keep},
};

pub use closures::ConvergenceCheck;
pub(crate) use closures::{assemble_operator, finish_residual, snes_table};
pub use line_search::LineSearchInfo;

petsc_object! {
    /// A nonlinear solver.
    Snes,
    /// A borrowed [`Snes`]: the solver inside a [`Ts`](crate::Ts), or the one that calls a closure.
    SnesRef,
    SNES, SNESDestroy
}

/// When a nonlinear solver stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// The residual norm that is small enough.
    pub absolute: f64,
    /// The part of the first residual norm that is small enough.
    pub relative: f64,
    /// The part of the solution's norm below which a step is small enough.
    pub step: f64,
    /// The largest number of iterations.
    pub max_iterations: i32,
    /// The largest number of residual evaluations; negative for no limit.
    pub max_evaluations: i32,
}

impl Snes {
    /// A nonlinear solver of PETSc's default type. Collective.
    ///
    /// # Errors
    /// If PETSc is not running.
    pub fn new<C: Communicator>(comm: &C) -> Result<Self> {
        let keep = keep()?;
        let mut raw = ptr::null_mut();
        // SAFETY: a valid communicator; PETSc writes the new object, which is owned at once.
        unsafe {
            check(sys::SNESCreate(comm.as_raw(), &mut raw))?;
            Self::own(raw, keep)
        }
    }

    /// Solves `f(x) = 0`, within the bounds if there are any, from the start `x`. Collective.
    ///
    /// After [`SnesReason::DivergedLineSearch`] of a solver with bounds, `x` is worthless: PETSc uses
    /// it as work space when it looks for a local minimum.
    ///
    /// # Errors
    /// If PETSc or a closure fails; a solver that gives up is a [`SnesReason`].
    pub fn solve(&mut self, x: &mut VectorRef) -> Result<SnesReason> {
        // SAFETY: live objects; a null right-hand side means zero; PETSc checks the layouts and
        // counts its reference to `x`.
        let solved = check(unsafe { sys::SNESSolve(self.raw(), ptr::null_mut(), x.raw()) });
        solved?;
        self.converged_reason()
    }
}

impl SnesRef {
    /// The type, for example `newtonls` or `vinewtonrsls`, once it is known.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn solver_type(&self) -> Result<Option<String>> {
        let mut name = ptr::null();
        // SAFETY: a live solver; PETSc writes null or a pointer to its own string.
        check(unsafe { sys::SNESGetType(self.raw(), &mut name) })?;
        // SAFETY: as said above.
        Ok(Some(unsafe { text_of(name) }).filter(|name| !name.is_empty()))
    }

    /// Sets the type, for example `newtonls` or `vinewtonrsls`.
    ///
    /// # Errors
    /// If there is no such type.
    pub fn set_type(&mut self, name: &str) -> Result<()> {
        let name = c_string(name)?;
        // SAFETY: a live solver and a C string, which PETSc copies.
        check(unsafe { sys::SNESSetType(self.raw(), name.as_ptr()) })?;
        self.restore_choices()
    }

    /// Makes the solver read its options with `prefix` before their names.
    ///
    /// # Errors
    /// If PETSc rejects the prefix.
    pub fn set_options_prefix(&mut self, prefix: &str) -> Result<()> {
        let prefix = c_string(prefix)?;
        // SAFETY: a live solver and a C string, which PETSc copies.
        check(unsafe { sys::SNESSetOptionsPrefix(self.raw(), prefix.as_ptr()) })
    }

    /// What stands before the names of this solver's options.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn options_prefix(&self) -> Result<String> {
        let mut prefix = ptr::null();
        // SAFETY: a live solver; PETSc writes null or a pointer to its own string.
        check(unsafe { sys::SNESGetOptionsPrefix(self.raw(), &mut prefix) })?;
        // SAFETY: as said above.
        Ok(unsafe { text_of(prefix) })
    }

    /// Reads the options `-snes_…`, `-ksp_…` and `-pc_…`.
    ///
    /// # Errors
    /// If an option has an impossible value.
    pub fn set_from_options(&mut self) -> Result<()> {
        // SAFETY: a live solver.
        check(unsafe { sys::SNESSetFromOptions(self.raw()) })?;
        self.restore_choices()
    }

    /// Puts the line search and the convergence test back that were set by closure: a change of type
    /// replaces them without a word. What the user's options ask for goes first.
    pub(crate) fn restore_choices(&mut self) -> Result<()> {
        self.install_line_search()?;
        self.install_convergence_test()
    }

    /// Whether the user has given this solver's option `name`.
    fn option_is_given(&self, name: &str) -> Result<bool> {
        options::is_given(&format!("{}{name}", self.options_prefix()?))
    }

    /// When the solver stops.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn tolerances(&self) -> Result<Tolerances> {
        let (mut absolute, mut relative, mut step) = (0.0, 0.0, 0.0);
        let (mut max_iterations, mut max_evaluations) = (0, 0);
        // SAFETY: a live solver and one value behind each pointer.
        check(unsafe {
            sys::SNESGetTolerances(
                self.raw(),
                &mut absolute,
                &mut relative,
                &mut step,
                &mut max_iterations,
                &mut max_evaluations,
            )
        })?;
        Ok(Tolerances {
            absolute,
            relative,
            step,
            max_iterations,
            max_evaluations,
        })
    }

    /// Sets when the solver stops.
    ///
    /// # Errors
    /// If a value is impossible.
    pub fn set_tolerances(&mut self, to: Tolerances) -> Result<()> {
        let Tolerances {
            absolute,
            relative,
            step,
            max_iterations,
            max_evaluations,
        } = to;
        // SAFETY: a live solver.
        check(unsafe {
            sys::SNESSetTolerances(
                self.raw(),
                absolute,
                relative,
                step,
                max_iterations,
                max_evaluations,
            )
        })
    }

    /// The iteration at work, or the number of iterations of the last solve.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn iteration_number(&self) -> Result<i32> {
        let mut count = 0;
        // SAFETY: a live solver, one integer to write.
        check(unsafe { sys::SNESGetIterationNumber(self.raw(), &mut count) })?;
        Ok(count)
    }

    /// The linear iterations of the last solve.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn linear_iterations(&self) -> Result<i32> {
        let mut count = 0;
        // SAFETY: a live solver, one integer to write.
        check(unsafe { sys::SNESGetLinearSolveIterations(self.raw(), &mut count) })?;
        Ok(count)
    }

    /// The residual evaluations of the last solve.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn function_evaluations(&self) -> Result<i32> {
        let mut count = 0;
        // SAFETY: a live solver, one integer to write.
        check(unsafe { sys::SNESGetNumberFunctionEvals(self.raw(), &mut count) })?;
        Ok(count)
    }

    /// The residual norm the solver judges by: with bounds, that of the inactive unknowns.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn function_norm(&self) -> Result<f64> {
        let mut norm = 0.0;
        // SAFETY: a live solver, one number to write.
        check(unsafe { sys::SNESGetFunctionNorm(self.raw(), &mut norm) })?;
        Ok(norm)
    }

    /// Why the last solve stopped.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn converged_reason(&self) -> Result<SnesReason> {
        let mut reason = sys::SNES_CONVERGED_ITERATING;
        // SAFETY: a live solver, one value to write.
        check(unsafe { sys::SNESGetConvergedReason(self.raw(), &mut reason) })?;
        Ok(SnesReason::from_raw(reason))
    }

    /// The current iterate.
    ///
    /// # Errors
    /// If there is none yet.
    pub fn solution(&self) -> Result<&VectorRef> {
        let mut x = ptr::null_mut();
        // SAFETY: a live solver; PETSc writes null or a vector that lives as long as the solver
        // keeps it, which no method of `&self` ends.
        unsafe {
            check(sys::SNESGetSolution(self.raw(), &mut x))?;
            VectorRef::from_raw(x)
        }
    }

    /// The residual at the current iterate.
    ///
    /// # Errors
    /// If there is none yet.
    pub fn function(&self) -> Result<&VectorRef> {
        let mut f = ptr::null_mut();
        // SAFETY: a live solver, as for `solution`; null means "not wanted".
        unsafe {
            check(sys::SNESGetFunction(
                self.raw(),
                &mut f,
                ptr::null_mut(),
                ptr::null_mut(),
            ))?;
            VectorRef::from_raw(f)
        }
    }

    /// The last Newton step (before damping), which is subtracted from the iterate.
    ///
    /// # Errors
    /// If there is none yet.
    pub fn solution_update(&self) -> Result<&VectorRef> {
        let mut step = ptr::null_mut();
        // SAFETY: a live solver, as for `solution`.
        unsafe {
            check(sys::SNESGetSolutionUpdate(self.raw(), &mut step))?;
            VectorRef::from_raw(step)
        }
    }

    /// The tangent matrix: inside a solver with bounds still the one of all unknowns.
    ///
    /// # Errors
    /// If there is none yet.
    pub fn jacobian(&self) -> Result<&MatrixRef> {
        let mut matrix = ptr::null_mut();
        let none = ptr::null_mut();
        // SAFETY: a live solver, as for `solution`; null means "not wanted".
        unsafe {
            check(sys::SNESGetJacobian(
                self.raw(),
                none,
                &mut matrix,
                ptr::null_mut(),
                ptr::null_mut(),
            ))?;
            MatrixRef::from_raw(matrix)
        }
    }

    /// The linear solver.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn ksp(&self) -> Result<&KspRef> {
        let mut ksp = ptr::null_mut();
        // SAFETY: a live solver; PETSc writes its linear solver, which lives as long as itself.
        unsafe {
            check(sys::SNESGetKSP(self.raw(), &mut ksp))?;
            KspRef::from_raw(ksp)
        }
    }

    /// The linear solver, to change it.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn ksp_mut(&mut self) -> Result<&mut KspRef> {
        let raw = self.ksp()?.raw();
        // SAFETY: the solver is borrowed mutably, and with it its linear solver.
        unsafe { KspRef::from_raw_mut(raw) }
    }

    /// Why the last linear solve stopped.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn ksp_reason(&self) -> Result<KspReason> {
        self.ksp()?.converged_reason()
    }

    /// Declares the current residual evaluation a failure of the domain. Inside a residual closure,
    /// return [`Failure::Domain`](crate::Failure::Domain) instead. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_function_domain_error(&mut self) -> Result<()> {
        // SAFETY: a live solver.
        check(unsafe { sys::SNESSetFunctionDomainError(self.raw()) })
    }

    /// Sets how many linear solves may fail before the solver gives up.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_max_linear_solve_failures(&mut self, count: i32) -> Result<()> {
        // SAFETY: a live solver.
        check(unsafe { sys::SNESSetMaxLinearSolveFailures(self.raw(), count) })
    }

    /// Makes the solver take at least one iteration even if the start is good enough.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_force_iteration(&mut self, force: bool) -> Result<()> {
        let force = if force {
            sys::PETSC_TRUE
        } else {
            sys::PETSC_FALSE
        };
        // SAFETY: a live solver.
        check(unsafe { sys::SNESSetForceIteration(self.raw(), force) })
    }

    pub(crate) fn local_size(&self) -> Result<usize> {
        self.function()
            .map_err(|_| Error::usage("set the residual function before"))?
            .local_size()
    }
}
