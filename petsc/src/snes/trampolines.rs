//! The C functions that call the closures of a nonlinear solver.

use std::ffi::{c_int, c_void};

use petsc_sys as sys;

use super::{ConvergenceCheck, SnesRef, closures::snes_table};
use crate::{
    MatrixRef, SnesReason, VectorRef,
    callback::{Outcome, evaluate, run},
    error::{Cause, Result, fail},
};

/// After a residual evaluation: a failure of the domain is told to PETSc, and the residual becomes
/// NaN on every rank, because a NaN at an unknown on its bound alone would pass unnoticed.
///
/// # Safety
/// `snes` and `f` are alive, and nobody else uses `f`.
pub(crate) unsafe fn finish_residual(
    snes: sys::SNES,
    f: sys::Vec,
    outcome: std::result::Result<Outcome, c_int>,
) -> c_int {
    let mark = || -> Result<()> {
        // SAFETY: as promised by the caller.
        let (snes, f) = unsafe { (SnesRef::from_raw_mut(snes)?, VectorRef::from_raw_mut(f)?) };
        f.write()?.fill(f64::NAN);
        snes.set_function_domain_error()
    };
    match outcome {
        Ok(Outcome::Done) => 0,
        Ok(Outcome::Domain) => match mark() {
            Ok(()) => 0,
            Err(error) => fail(Cause::Callback(error.into())),
        },
        Err(code) => code,
    }
}

pub(super) unsafe extern "C" fn on_residual(
    snes: sys::SNES,
    x: sys::Vec,
    f: sys::Vec,
    _context: *mut c_void,
) -> c_int {
    let outcome = evaluate(snes.cast(), || {
        // SAFETY: PETSc's live objects; `f` is PETSc's to fill and lent to nobody else.
        let (table, x, f) = unsafe {
            (
                snes_table(snes)?,
                VectorRef::from_raw(x)?,
                VectorRef::from_raw_mut(f)?,
            )
        };
        table.residual.get()?(x, f)
    });
    // SAFETY: as above; the closure has given `f` back.
    unsafe { finish_residual(snes, f, outcome) }
}

pub(super) unsafe extern "C" fn on_jacobian(
    snes: sys::SNES,
    x: sys::Vec,
    operator: sys::Mat,
    matrix: sys::Mat,
    _context: *mut c_void,
) -> c_int {
    let code = run(snes.cast(), || {
        // SAFETY: PETSc's live objects; the matrix is PETSc's to fill and lent to nobody else.
        let (table, x, matrix) = unsafe {
            (
                snes_table(snes)?,
                VectorRef::from_raw(x)?,
                MatrixRef::from_raw_mut(matrix)?,
            )
        };
        table.jacobian.get()?(x, matrix)
    });
    if code != 0 {
        return code;
    }
    // SAFETY: PETSc's live matrices.
    unsafe { assemble_operator(operator, matrix) }
}

/// A matrix-free operator (`-snes_mf_operator`) takes over its new base point when assembled.
///
/// # Safety
/// Both are alive.
pub(crate) unsafe fn assemble_operator(operator: sys::Mat, matrix: sys::Mat) -> c_int {
    if operator == matrix {
        return 0;
    }
    // SAFETY: as promised by the caller.
    unsafe {
        match sys::MatAssemblyBegin(operator, sys::MAT_FINAL_ASSEMBLY) {
            0 => sys::MatAssemblyEnd(operator, sys::MAT_FINAL_ASSEMBLY),
            code => code,
        }
    }
}

pub(super) unsafe extern "C" fn on_initial_guess(
    snes: sys::SNES,
    x: sys::Vec,
    _: *mut c_void,
) -> c_int {
    run(snes.cast(), || {
        // SAFETY: PETSc's live objects; `x` is PETSc's to fill and lent to nobody else.
        let (table, x) = unsafe { (snes_table(snes)?, VectorRef::from_raw_mut(x)?) };
        if let Some(answer) = &*table.placed.borrow() {
            return Ok(x.copy_from(answer)?);
        }
        // PETSc does not take a function back.
        if !table.initial_guess.is_set() {
            return Ok(());
        }
        table.initial_guess.get()?(x)
    })
}

pub(super) unsafe extern "C" fn on_update(snes: sys::SNES, iteration: c_int) -> c_int {
    run(snes.cast(), || {
        // SAFETY: PETSc's live solver, which waits for this function.
        let (table, snes) = unsafe { (snes_table(snes)?, SnesRef::from_raw_mut(snes)?) };
        table.update.get()?(snes, iteration)
    })
}

pub(super) unsafe extern "C" fn on_monitor(
    snes: sys::SNES,
    iteration: c_int,
    norm: f64,
    _context: *mut c_void,
) -> c_int {
    run(snes.cast(), || {
        // SAFETY: PETSc's live solver.
        let (table, snes) = unsafe { (snes_table(snes)?, SnesRef::from_raw(snes)?) };
        if table.placed.borrow().is_some() {
            return Ok(());
        }
        table.monitor.get()?(snes, iteration, norm)
    })
}

pub(super) unsafe extern "C" fn on_convergence(
    snes: sys::SNES,
    iteration: c_int,
    solution_norm: f64,
    step_norm: f64,
    residual_norm: f64,
    reason: *mut sys::SNESConvergedReason,
    _context: *mut c_void,
) -> c_int {
    run(snes.cast(), || {
        // SAFETY: PETSc's live solver.
        let (table, snes) = unsafe { (snes_table(snes)?, SnesRef::from_raw(snes)?) };
        let default = snes.default_test(iteration, solution_norm, step_norm, residual_norm)?;
        let check = ConvergenceCheck {
            iteration,
            solution_norm,
            step_norm,
            residual_norm,
            default,
        };
        let verdict = if table.placed.borrow().is_some() {
            SnesReason::ConvergedAbsolute
        } else if table.convergence.is_set() {
            table.convergence.get()?(snes, &check)?
        } else {
            default
        };
        // SAFETY: PETSc's place for the answer.
        unsafe { *reason = verdict.to_raw() };
        Ok(())
    })
}
