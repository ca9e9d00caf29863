//! Nonlinear solvers.
//!
//! In: a residual, a tangent matrix, bounds and hooks as closures. Out: a solution and the reason why
//! the solver stopped. Never: a choice of method; that is made by options.

mod bounds;
mod closures;
mod line_search;
mod trampolines;

use std::ptr;

use mpi::topology::Communicator;
use petsc_sys as sys;

use crate::{
    KspReason, KspRef, MatrixRef, SnesReason, VectorRef,
    error::{Error, Result, check, text_of},
    handle::{petsc_object, plain_getters, plain_setters},
    options,
    session::{c_string, keep},
};

pub use closures::ConvergenceCheck;
pub(crate) use closures::snes_table;
pub use line_search::LineSearchInfo;
pub(crate) use trampolines::{assemble_operator, finish_residual};

petsc_object! {
    /// A nonlinear solver.
    Snes,
    /// A borrowed [`Snes`]: the solver inside a [`Ts`](crate::Ts), or the one that calls a closure.
    SnesRef,
    SNES, SNESDestroy
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
        self.check_layout(x)?;
        // PETSc keeps the vector it is given, and lends it to closures: it gets one of its own.
        let work = x.to_owned()?;
        let table = self.table()?;
        table.running.set(true);
        // SAFETY: live objects; a null right-hand side means zero; PETSc counts its reference.
        let solved = check(unsafe { sys::SNESSolve(self.raw(), ptr::null_mut(), work.raw()) });
        table.running.set(false);
        solved?;
        x.copy_from(&work)?;
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
    /// If there is no such type, or the solver is running.
    pub fn set_type(&mut self, name: &str) -> Result<()> {
        self.require_idle()?;
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
    /// If an option has an impossible value, or the solver is running.
    pub fn set_from_options(&mut self) -> Result<()> {
        self.require_idle()?;
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

    plain_getters! {
        /// The iteration at work, or the number of iterations of the last solve.
        iteration_number, SNESGetIterationNumber => i32;
        /// The linear iterations of the last solve.
        linear_iterations, SNESGetLinearSolveIterations => i32;
        /// The residual evaluations of the last solve.
        function_evaluations, SNESGetNumberFunctionEvals => i32;
        /// The residual norm the solver judges by: with bounds, that of the inactive unknowns.
        function_norm, SNESGetFunctionNorm => f64;
    }

    plain_setters! {
        /// Sets how many linear solves may fail before the solver gives up.
        set_max_linear_solve_failures, SNESSetMaxLinearSolveFailures <= i32;
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

    /// The current iterate, or that of the last solve.
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

    /// Declares the residual evaluation at work a failure of the domain, on all ranks.
    pub(crate) fn set_function_domain_error(&mut self) -> Result<()> {
        self.table()?.outside_domain.set(true);
        // SAFETY: a live solver.
        check(unsafe { sys::SNESSetFunctionDomainError(self.raw()) })
    }

    /// The layout all vectors of this solver need: PETSc does not always check it.
    pub(crate) fn check_layout(&self, x: &VectorRef) -> Result<()> {
        let function = self
            .function()
            .map_err(|_| Error::usage("set the residual function before"))?;
        let size = function.local_size()?;
        let bounds = self.table()?.bounds_size.get().unwrap_or(size);
        if x.local_size()? == size && bounds == size {
            return Ok(());
        }
        Err(Error::usage(
            "iterate, bounds and residual need the same layout",
        ))
    }

    /// A running solver holds on to its parts.
    pub(crate) fn require_idle(&self) -> Result<()> {
        if self.table()?.running.get() {
            return Err(Error::usage("the nonlinear solver is running"));
        }
        Ok(())
    }
}
