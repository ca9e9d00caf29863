//! A preconditioner made of closures.

use std::{ffi::c_int, ptr, rc::Rc};

use petsc_sys as sys;

use crate::{
    CallbackError, Evaluation, MatrixRef, SnesRef, VectorRef,
    callback::{Outcome, evaluate, run},
    error::{Cause, Result, check, fail},
    snes::snes_table,
};

impl SnesRef {
    /// Replaces the preconditioner by closures. Options read later (`-pc_type`) replace it again.
    ///
    /// `setup` is called when the matrix has changed, with the matrix of the linear system; for a
    /// reduced-space solver with bounds this is the matrix of the
    /// [inactive unknowns](SnesRef::inactive_set), and [`SnesRef::jacobian`] is the whole one.
    /// [`Failure::Domain`](crate::Failure::Domain) says that the matrix cannot be used: the linear
    /// solve fails, and with it the nonlinear one. `apply(b, x)` solves for one right-hand side.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_shell_preconditioner(
        &mut self,
        setup: impl Fn(&SnesRef, &MatrixRef) -> Evaluation + 'static,
        apply: impl Fn(&VectorRef, &mut VectorRef) -> std::result::Result<(), CallbackError> + 'static,
    ) -> Result<()> {
        let table = self.table()?;
        table.shell_setup.set(Rc::new(setup));
        table.shell_apply.set(Rc::new(apply));
        let pc = self.ksp()?.pc()?;
        // SAFETY: a live preconditioner, owned by this solver, so that the solver is alive whenever
        // the functions get it as their context.
        unsafe {
            check(sys::PCSetType(pc, sys::PCSHELL.as_ptr()))?;
            check(sys::PCShellSetContext(pc, self.raw().cast()))?;
            check(sys::PCShellSetSetUp(pc, Some(on_setup)))?;
            check(sys::PCShellSetApply(pc, Some(on_apply)))
        }
    }
}

/// # Safety
/// `pc` is alive and was made by `set_shell_preconditioner`.
unsafe fn solver_of(pc: sys::PC) -> Result<sys::SNES> {
    let mut snes: sys::SNES = ptr::null_mut();
    // SAFETY: as promised by the caller; PETSc writes the context.
    check(unsafe { sys::PCShellGetContext(pc, ptr::from_mut(&mut snes).cast()) })?;
    Ok(snes)
}

unsafe extern "C" fn on_setup(pc: sys::PC) -> c_int {
    let outcome = evaluate(pc.cast(), || {
        let mut matrix = ptr::null_mut();
        // SAFETY: PETSc's live objects; PETSc writes the matrix to build from.
        let (table, snes, matrix) = unsafe {
            let snes = solver_of(pc)?;
            check(sys::PCGetOperators(pc, ptr::null_mut(), &mut matrix))?;
            (
                snes_table(snes)?,
                SnesRef::from_raw(snes)?,
                MatrixRef::from_raw(matrix)?,
            )
        };
        table.shell_setup.get()?(snes, matrix)
    });
    let reason = match outcome {
        Ok(Outcome::Done) => sys::PC_NOERROR,
        Ok(Outcome::Domain) => sys::PC_FACTOR_OTHER,
        Err(code) => return code,
    };
    // SAFETY: PETSc's live preconditioner.
    match check(unsafe { sys::PCSetFailedReason(pc, reason) }) {
        Ok(()) => 0,
        Err(error) => fail(Cause::Callback(error.into())),
    }
}

unsafe extern "C" fn on_apply(pc: sys::PC, b: sys::Vec, x: sys::Vec) -> c_int {
    run(pc.cast(), || {
        // SAFETY: PETSc's live objects; `x` is PETSc's to fill and lent to nobody else.
        let (table, b, x) = unsafe {
            (
                snes_table(solver_of(pc)?)?,
                VectorRef::from_raw(b)?,
                VectorRef::from_raw_mut(x)?,
            )
        };
        table.shell_apply.get()?(b, x)
    })
}
