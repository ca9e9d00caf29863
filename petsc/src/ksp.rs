//! Linear solvers.

use std::ptr;

use mpi::topology::Communicator;
use petsc_sys as sys;

use crate::{
    KspReason,
    block::BlockRef,
    error::{Result, check, text_of},
    handle::petsc_object,
    matrix::MatrixRef,
    session::{c_string, keep},
    vector::VectorRef,
};

petsc_object! {
    /// A linear solver.
    Ksp,
    /// A borrowed [`Ksp`].
    KspRef,
    KSP, KSPDestroy
}

impl Ksp {
    /// A linear solver without a matrix. Collective.
    ///
    /// # Errors
    /// If PETSc is not running.
    pub fn new<C: Communicator>(comm: &C) -> Result<Self> {
        let keep = keep()?;
        let mut raw = ptr::null_mut();
        // SAFETY: a valid communicator; PETSc writes the new object, which is owned at once.
        unsafe {
            check(sys::KSPCreate(comm.as_raw(), &mut raw))?;
            Self::own(raw, keep)
        }
    }

    /// Solves `A x = b`. Collective.
    ///
    /// # Errors
    /// If PETSc fails; a solver that gives up is a [`KspReason`].
    pub fn solve(&mut self, b: &VectorRef, x: &mut VectorRef) -> Result<KspReason> {
        // SAFETY: live objects; PETSc checks the layouts.
        check(unsafe { sys::KSPSolve(self.raw(), b.raw(), x.raw()) })?;
        self.converged_reason()
    }

    /// Solves `A X = B` for all columns at once. Collective.
    ///
    /// # Errors
    /// As [`Ksp::solve`].
    pub fn solve_block(&mut self, b: &BlockRef, x: &mut BlockRef) -> Result<KspReason> {
        // SAFETY: live objects; PETSc checks the layouts.
        check(unsafe { sys::KSPMatSolve(self.raw(), b.raw(), x.raw()) })?;
        self.converged_reason()
    }
}

impl KspRef {
    /// Sets the matrix to solve with, which is also what the preconditioner is built from. PETSc
    /// keeps a reference: later changes of the matrix are seen by the next solve.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_operator(&mut self, matrix: &MatrixRef) -> Result<()> {
        // SAFETY: live objects; PETSc counts its reference.
        check(unsafe { sys::KSPSetOperators(self.raw(), matrix.raw(), matrix.raw()) })
    }

    /// Sets the type, for example `preonly` or `gmres`.
    ///
    /// # Errors
    /// If there is no such type.
    pub fn set_type(&mut self, name: &str) -> Result<()> {
        let name = c_string(name)?;
        // SAFETY: a live solver and a C string, which PETSc copies.
        check(unsafe { sys::KSPSetType(self.raw(), name.as_ptr()) })
    }

    /// Sets the type of the preconditioner, for example `lu`, `cholesky` or `redundant`.
    ///
    /// # Errors
    /// If there is no such type.
    pub fn set_preconditioner(&mut self, name: &str) -> Result<()> {
        let name = c_string(name)?;
        // SAFETY: a live preconditioner and a C string, which PETSc copies.
        check(unsafe { sys::PCSetType(self.pc()?, name.as_ptr()) })
    }

    /// Prepares for solves with the matrix: a direct solver factorises, with the symbolic part of the last time if the
    /// pattern is the same. Does nothing a second time, also for other values (the next solve finds them by itself), unless
    /// the matrix was set again. Collective.
    ///
    /// # Errors
    /// If PETSc fails; a matrix that cannot be used is a [`KspReason`].
    pub fn set_up(&mut self) -> Result<KspReason> {
        // SAFETY: a live solver.
        check(unsafe { sys::KSPSetUp(self.raw()) })?;
        self.converged_reason()
    }

    /// Makes the solver read its options with `prefix` before their names.
    ///
    /// # Errors
    /// If PETSc rejects the prefix.
    pub fn set_options_prefix(&mut self, prefix: &str) -> Result<()> {
        let prefix = c_string(prefix)?;
        // SAFETY: a live solver and a C string, which PETSc copies.
        check(unsafe { sys::KSPSetOptionsPrefix(self.raw(), prefix.as_ptr()) })
    }

    /// Reads the options `-ksp_…` and `-pc_…`.
    ///
    /// # Errors
    /// If an option has an impossible value.
    pub fn set_from_options(&mut self) -> Result<()> {
        // SAFETY: a live solver.
        check(unsafe { sys::KSPSetFromOptions(self.raw()) })
    }

    /// Why the last solve stopped.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn converged_reason(&self) -> Result<KspReason> {
        let mut reason = sys::KSP_CONVERGED_ITERATING;
        // SAFETY: a live solver, one value to write.
        check(unsafe { sys::KSPGetConvergedReason(self.raw(), &mut reason) })?;
        Ok(KspReason::from_raw(reason))
    }

    /// The iterations of the last solve.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn iteration_number(&self) -> Result<i32> {
        let mut count = 0;
        // SAFETY: a live solver, one integer to write.
        check(unsafe { sys::KSPGetIterationNumber(self.raw(), &mut count) })?;
        Ok(count)
    }

    /// The type of the preconditioner, for example `lu`, once it is known.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn preconditioner(&self) -> Result<Option<String>> {
        let mut name = ptr::null();
        // SAFETY: a live preconditioner; PETSc writes null or a pointer to its own string.
        check(unsafe { sys::PCGetType(self.pc()?, &mut name) })?;
        // SAFETY: as said above.
        Ok(Some(unsafe { text_of(name) }).filter(|name| !name.is_empty()))
    }

    /// The package that factorises, for example `mumps`, once it is known.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn factor_solver(&self) -> Result<Option<String>> {
        let mut name = ptr::null();
        // SAFETY: a live preconditioner; PETSc writes null or a pointer to its own string, also if
        // the preconditioner does not factorise.
        check(unsafe { sys::PCFactorGetMatSolverType(self.pc()?, &mut name) })?;
        // SAFETY: as said above.
        Ok(Some(unsafe { text_of(name) }).filter(|name| !name.is_empty()))
    }

    pub(crate) fn pc(&self) -> Result<sys::PC> {
        let mut pc = ptr::null_mut();
        // SAFETY: a live solver; PETSc writes its preconditioner, which the solver owns.
        check(unsafe { sys::KSPGetPC(self.raw(), &mut pc) })?;
        Ok(pc)
    }
}
