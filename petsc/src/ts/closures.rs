//! The closures of a time integration, and the C functions that call them.

use std::{
    cell::Cell,
    ffi::{c_int, c_void},
    ptr,
    rc::Rc,
};

use petsc_sys as sys;

use super::{AlphaParameters, TsRef};
use crate::{
    CallbackError, Evaluation, Matrix, MatrixRef, VectorRef,
    callback::{Outcome, Slot, evaluate, run, table},
    error::{Result, check},
    snes::{assemble_operator, finish_residual},
};

type Done = std::result::Result<(), CallbackError>;
type Residual2 = dyn Fn(f64, &VectorRef, &VectorRef, &VectorRef, &mut VectorRef) -> Evaluation;
type Jacobian2 = dyn Fn(f64, &VectorRef, &VectorRef, &VectorRef, f64, f64, &mut MatrixRef) -> Done;
type Residual = dyn Fn(f64, &VectorRef, &VectorRef, &mut VectorRef) -> Evaluation;
type Jacobian = dyn Fn(f64, &VectorRef, &VectorRef, f64, &mut MatrixRef) -> Done;

/// Everything Rust keeps for one time integration.
#[derive(Default)]
#[allow(
    clippy::type_complexity,
    reason = "the signatures of the closures are the contents"
)]
pub(super) struct TsTable {
    residual2: Slot<Residual2>,
    jacobian2: Slot<Jacobian2>,
    residual: Slot<Residual>,
    jacobian: Slot<Jacobian>,
    pre_step: Slot<dyn Fn(&mut TsRef) -> Done>,
    pre_stage: Slot<dyn Fn(&mut TsRef, f64) -> Done>,
    post_stage: Slot<dyn Fn(&mut TsRef, f64, &VectorRef) -> Done>,
    stage_check: Slot<dyn Fn(&mut TsRef, f64, &VectorRef) -> Evaluation>,
    post_step: Slot<dyn Fn(&mut TsRef) -> Done>,
    monitor: Slot<dyn Fn(&TsRef, i32, f64, &VectorRef) -> Done>,
    /// Whether the next step is a start.
    pub(super) starting: Cell<bool>,
    /// The caller's parameters, while those for the start are in use.
    pub(super) params_after_start: Cell<Option<AlphaParameters>>,
}

/// # Safety
/// `ts` is alive.
unsafe fn ts_table(ts: sys::TS) -> Result<Rc<TsTable>> {
    // SAFETY: a live object, and a name used for this type only.
    unsafe { table(ts.cast(), c"petsc.rs: closures of the time integration") }
}

impl TsRef {
    pub(super) fn table(&self) -> Result<Rc<TsTable>> {
        // SAFETY: a live object.
        unsafe { ts_table(self.raw()) }
    }

    /// Poses the second-order problem `f(t, u, v, a) = 0` (v = du/dt, a = dv/dt) and chooses
    /// TSALPHA2. `template` gives the layout.
    ///
    /// `residual(t, u, v, a, f)` fills f and must have no memory: it is evaluated at trial points.
    /// `jacobian(t, u, v, a, shift_v, shift_a, matrix)` fills the matrix with
    /// `df/du + shift_v df/dv + shift_a df/da`.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_second_order(
        &mut self,
        template: &VectorRef,
        matrix: Matrix,
        residual: impl Fn(f64, &VectorRef, &VectorRef, &VectorRef, &mut VectorRef) -> Evaluation
        + 'static,
        jacobian: impl Fn(f64, &VectorRef, &VectorRef, &VectorRef, f64, f64, &mut MatrixRef) -> Done
        + 'static,
    ) -> Result<()> {
        let table = self.table()?;
        table.residual2.set(Rc::new(residual));
        table.jacobian2.set(Rc::new(jacobian));
        let f = template.duplicate()?;
        let (ts, m, none) = (self.raw(), matrix.raw(), ptr::null_mut());
        // SAFETY: live objects; PETSc counts its references; the functions find their closures by
        // themselves.
        unsafe {
            check(sys::TSSetType(ts, sys::TSALPHA2.as_ptr()))?;
            check(sys::TSSetI2Function(ts, f.raw(), Some(on_residual2), none))?;
            check(sys::TSSetI2Jacobian(ts, m, m, Some(on_jacobian2), none))
        }
    }

    /// Poses the implicit first-order problem `f(t, u, du/dt) = 0`, or a static one that does not
    /// depend on du/dt, and chooses TSBEULER. `template` gives the layout.
    ///
    /// `residual(t, u, udot, f)` fills f and must have no memory: it is evaluated at trial points.
    /// `jacobian(t, u, udot, shift, matrix)` fills the matrix with `df/du + shift df/dudot`.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_implicit(
        &mut self,
        template: &VectorRef,
        matrix: Matrix,
        residual: impl Fn(f64, &VectorRef, &VectorRef, &mut VectorRef) -> Evaluation + 'static,
        jacobian: impl Fn(f64, &VectorRef, &VectorRef, f64, &mut MatrixRef) -> Done + 'static,
    ) -> Result<()> {
        let table = self.table()?;
        table.residual.set(Rc::new(residual));
        table.jacobian.set(Rc::new(jacobian));
        let f = template.duplicate()?;
        let (ts, m, none) = (self.raw(), matrix.raw(), ptr::null_mut());
        // SAFETY: as in `set_second_order`.
        unsafe {
            check(sys::TSSetType(ts, sys::TSBEULER.as_ptr()))?;
            check(sys::TSSetIFunction(ts, f.raw(), Some(on_residual), none))?;
            check(sys::TSSetIJacobian(ts, m, m, Some(on_jacobian), none))
        }
    }

    /// Sets the hook before each step (not called again when the step is repeated).
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_pre_step(&mut self, hook: impl Fn(&mut TsRef) -> Done + 'static) -> Result<()> {
        self.table()?.pre_step.set(Rc::new(hook));
        self.install_pre_step()
    }

    pub(super) fn install_pre_step(&mut self) -> Result<()> {
        // SAFETY: a live object; the function finds its closure by itself.
        check(unsafe { sys::TSSetPreStep(self.raw(), Some(on_pre_step)) })
    }

    /// Sets the hook before each stage, with its time: called for each attempt at a step.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_pre_stage(
        &mut self,
        hook: impl Fn(&mut TsRef, f64) -> Done + 'static,
    ) -> Result<()> {
        self.table()?.pre_stage.set(Rc::new(hook));
        // SAFETY: as in `install_pre_step`.
        check(unsafe { sys::TSSetPreStage(self.raw(), Some(on_pre_stage)) })
    }

    /// Sets the hook after each stage, with its time and solution: called also if the nonlinear
    /// solver has failed.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_post_stage(
        &mut self,
        hook: impl Fn(&mut TsRef, f64, &VectorRef) -> Done + 'static,
    ) -> Result<()> {
        self.table()?.post_stage.set(Rc::new(hook));
        // SAFETY: as in `install_pre_step`.
        check(unsafe { sys::TSSetPostStage(self.raw(), Some(on_post_stage)) })
    }

    /// Sets a closure that may refuse a stage that the nonlinear solver has solved, by
    /// [`Failure::Domain`](crate::Failure::Domain): the step is cut back as if the solver had failed.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_stage_check(
        &mut self,
        check_stage: impl Fn(&mut TsRef, f64, &VectorRef) -> Evaluation + 'static,
    ) -> Result<()> {
        self.table()?.stage_check.set(Rc::new(check_stage));
        // SAFETY: as in `install_pre_step`.
        check(unsafe { sys::TSSetFunctionDomainError(self.raw(), Some(on_stage_check)) })
    }

    /// Sets the hook after each step: called also after a failed one.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_post_step(&mut self, hook: impl Fn(&mut TsRef) -> Done + 'static) -> Result<()> {
        self.table()?.post_step.set(Rc::new(hook));
        // SAFETY: as in `install_pre_step`.
        check(unsafe { sys::TSSetPostStep(self.raw(), Some(on_post_step)) })
    }

    /// Sets a closure called before each step and at the end, with the step's number, time and
    /// solution. It replaces the one set before; monitors set by options are called too.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_monitor(
        &mut self,
        monitor: impl Fn(&TsRef, i32, f64, &VectorRef) -> Done + 'static,
    ) -> Result<()> {
        let table = self.table()?;
        let installed = table.monitor.is_set();
        table.monitor.set(Rc::new(monitor));
        if installed {
            return Ok(());
        }
        let (function, none) = (Some(on_monitor as _), ptr::null_mut());
        // SAFETY: as in `install_pre_step`.
        check(unsafe { sys::TSMonitorSet(self.raw(), function, none, None) })
    }
}

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

unsafe extern "C" fn on_residual2(
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
        table.residual2.get()?(t, u, v, a, f)
    });
    // SAFETY: as above; the closure has given `f` back.
    unsafe { finish(ts, f, outcome) }
}

unsafe extern "C" fn on_jacobian2(
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

unsafe extern "C" fn on_residual(
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

unsafe extern "C" fn on_jacobian(
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

unsafe extern "C" fn on_pre_step(ts: sys::TS) -> c_int {
    run(ts.cast(), || {
        // SAFETY: PETSc's live object, which waits for this function.
        let (table, ts) = unsafe { for_hook(ts) }?;
        ts.choose_params(&table)?;
        if table.pre_step.is_set() {
            table.pre_step.get()?(ts)
        } else {
            Ok(())
        }
    })
}

unsafe extern "C" fn on_pre_stage(ts: sys::TS, time: f64) -> c_int {
    run(ts.cast(), || {
        // SAFETY: PETSc's live object, which waits for this function.
        let (table, ts) = unsafe { for_hook(ts) }?;
        table.pre_stage.get()?(ts, time)
    })
}

unsafe extern "C" fn on_post_stage(
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
        table.post_stage.get()?(ts, time, u)
    })
}

unsafe extern "C" fn on_stage_check(
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

unsafe extern "C" fn on_post_step(ts: sys::TS) -> c_int {
    run(ts.cast(), || {
        // SAFETY: PETSc's live object, which waits for this function.
        let (table, ts) = unsafe { for_hook(ts) }?;
        table.post_step.get()?(ts)
    })
}

unsafe extern "C" fn on_monitor(
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
        table.monitor.get()?(ts, step, time, u)
    })
}
