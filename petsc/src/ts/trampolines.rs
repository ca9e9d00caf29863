//! The C functions that call the closures of a time integration.

use std::{
    ffi::{c_int, c_void},
    ptr,
    rc::Rc,
};

use petsc_sys as sys;

use super::{
    TsRef,
    closures::{TsTable, ts_table},
};
use crate::{
    MatrixRef, VectorRef,
    callback::{Outcome, evaluate, run},
    error::Result,
    snes::{assemble_operator, finish_residual},
};

/// After a residual evaluation, as for the nonlinear solver alone.
///
/// # Safety
/// `ts` and `f` are alive, and nobody else uses `f`.
unsafe fn finish(ts: sys::TS, f: sys::Vec, outcome: std::result::Result<Outcome, c_int>) -> c_int {
    let mut snes = ptr::null_mut();
    // SAFETY: as promised by the caller; PETSc writes its solver.
    unsafe {
        match sys::TSGetSNES(ts, &mut snes) {
            0 => finish_residual(snes, f, outcome),
            code => code,
        }
    }
}

pub(super) unsafe extern "C" fn on_residual2(
    ts: sys::TS,
    t: f64,
    u: sys::Vec,
    v: sys::Vec,
    a: sys::Vec,
    f: sys::Vec,
    _context: *mut c_void,
) -> c_int {
    let outcome = evaluate(ts.cast(), || {
        // SAFETY: PETSc's live objects; `f` is PETSc's to fill and lent to nobody else.
        let (table, u, v, a, f) = unsafe {
            let (u, v, a) = (
                VectorRef::from_raw(u)?,
                VectorRef::from_raw(v)?,
                VectorRef::from_raw(a)?,
            );
            (ts_table(ts)?, u, v, a, VectorRef::from_raw_mut(f)?)
        };
        if table.placing.get() {
            return Ok(f.set_all(0.0)?);
        }
        table.residual2.get()?(t, u, v, a, f)
    });
    // SAFETY: as above; the closure has given `f` back.
    unsafe { finish(ts, f, outcome) }
}

pub(super) unsafe extern "C" fn on_jacobian2(
    ts: sys::TS,
    t: f64,
    u: sys::Vec,
    v: sys::Vec,
    a: sys::Vec,
    shift_v: f64,
    shift_a: f64,
    operator: sys::Mat,
    matrix: sys::Mat,
    _context: *mut c_void,
) -> c_int {
    let code = run(ts.cast(), || {
        // SAFETY: PETSc's live objects; the matrix is PETSc's to fill and lent to nobody else.
        let (table, u, v, a, matrix) = unsafe {
            let (u, v, a) = (
                VectorRef::from_raw(u)?,
                VectorRef::from_raw(v)?,
                VectorRef::from_raw(a)?,
            );
            (ts_table(ts)?, u, v, a, MatrixRef::from_raw_mut(matrix)?)
        };
        table.jacobian2.get()?(t, u, v, a, shift_v, shift_a, matrix)
    });
    if code != 0 {
        return code;
    }
    // SAFETY: PETSc's live matrices.
    unsafe { assemble_operator(operator, matrix) }
}

pub(super) unsafe extern "C" fn on_residual(
    ts: sys::TS,
    t: f64,
    u: sys::Vec,
    udot: sys::Vec,
    f: sys::Vec,
    _context: *mut c_void,
) -> c_int {
    let outcome = evaluate(ts.cast(), || {
        // SAFETY: PETSc's live objects; `f` is PETSc's to fill and lent to nobody else.
        let (table, u, udot, f) = unsafe {
            let (u, udot) = (VectorRef::from_raw(u)?, VectorRef::from_raw(udot)?);
            (ts_table(ts)?, u, udot, VectorRef::from_raw_mut(f)?)
        };
        table.residual.get()?(t, u, udot, f)
    });
    // SAFETY: as above; the closure has given `f` back.
    unsafe { finish(ts, f, outcome) }
}

pub(super) unsafe extern "C" fn on_jacobian(
    ts: sys::TS,
    t: f64,
    u: sys::Vec,
    udot: sys::Vec,
    shift: f64,
    operator: sys::Mat,
    matrix: sys::Mat,
    _context: *mut c_void,
) -> c_int {
    let code = run(ts.cast(), || {
        // SAFETY: PETSc's live objects; the matrix is PETSc's to fill and lent to nobody else.
        let (table, u, udot, matrix) = unsafe {
            let (u, udot) = (VectorRef::from_raw(u)?, VectorRef::from_raw(udot)?);
            (ts_table(ts)?, u, udot, MatrixRef::from_raw_mut(matrix)?)
        };
        table.jacobian.get()?(t, u, udot, shift, matrix)
    });
    if code != 0 {
        return code;
    }
    // SAFETY: PETSc's live matrices.
    unsafe { assemble_operator(operator, matrix) }
}

/// The table and the integration itself, for a hook.
///
/// # Safety
/// `ts` is alive and waits for the hook.
unsafe fn for_hook<'a>(ts: sys::TS) -> Result<(Rc<TsTable>, &'a mut TsRef)> {
    // SAFETY: as promised by the caller.
    unsafe { Ok((ts_table(ts)?, TsRef::from_raw_mut(ts)?)) }
}

pub(super) unsafe extern "C" fn on_pre_step(ts: sys::TS) -> c_int {
    run(ts.cast(), || {
        // SAFETY: PETSc's live object, which waits for this function.
        let (table, ts) = unsafe { for_hook(ts) }?;
        ts.restore_params(&table)?;
        if table.pre_step.is_set() && !table.placing.get() {
            table.pre_step.get()?(ts)?;
        }
        Ok(ts.begin_step(&table)?)
    })
}

pub(super) unsafe extern "C" fn on_pre_stage(ts: sys::TS, time: f64) -> c_int {
    run(ts.cast(), || {
        // SAFETY: PETSc's live object, which waits for this function.
        let (table, ts) = unsafe { for_hook(ts) }?;
        if table.placing.get() {
            return Ok(());
        }
        table.pre_stage.get()?(ts, time)
    })
}

pub(super) unsafe extern "C" fn on_post_stage(
    ts: sys::TS,
    time: f64,
    stage: c_int,
    solutions: *mut sys::Vec,
) -> c_int {
    run(ts.cast(), || {
        // SAFETY: PETSc's live objects; PETSc passes an array with at least `stage + 1` vectors.
        let (table, ts, u) = unsafe {
            let (table, ts) = for_hook(ts)?;
            let u = *solutions.add(usize::try_from(stage).unwrap_or(0));
            (table, ts, VectorRef::from_raw(u)?)
        };
        if table.placing.get() {
            return Ok(());
        }
        table.post_stage.get()?(ts, time, u)
    })
}

pub(super) unsafe extern "C" fn on_stage_check(
    ts: sys::TS,
    time: f64,
    u: sys::Vec,
    accept: *mut sys::PetscBool,
) -> c_int {
    let outcome = evaluate(ts.cast(), || {
        // SAFETY: PETSc's live objects.
        let (table, ts, u) = unsafe {
            let (table, ts) = for_hook(ts)?;
            (table, ts, VectorRef::from_raw(u)?)
        };
        if table.placing.get() {
            return Ok(());
        }
        table.stage_check.get()?(ts, time, u)
    });
    let verdict = match outcome {
        Ok(Outcome::Done) => sys::PETSC_TRUE,
        Ok(Outcome::Domain) => sys::PETSC_FALSE,
        Err(code) => return code,
    };
    // SAFETY: PETSc's place for the answer.
    unsafe { *accept = verdict };
    0
}

pub(super) unsafe extern "C" fn on_post_step(ts: sys::TS) -> c_int {
    run(ts.cast(), || {
        // SAFETY: PETSc's live object, which waits for this function.
        let (table, ts) = unsafe { for_hook(ts) }?;
        if table.placing.get() {
            return Ok(());
        }
        table.post_step.get()?(ts)
    })
}

pub(super) unsafe extern "C" fn on_monitor(
    ts: sys::TS,
    step: c_int,
    time: f64,
    u: sys::Vec,
    _context: *mut c_void,
) -> c_int {
    run(ts.cast(), || {
        // SAFETY: PETSc's live objects.
        let (table, ts, u) =
            unsafe { (ts_table(ts)?, TsRef::from_raw(ts)?, VectorRef::from_raw(u)?) };
        if table.placing.get() {
            return Ok(());
        }
        table.monitor.get()?(ts, step, time, u)
    })
}
