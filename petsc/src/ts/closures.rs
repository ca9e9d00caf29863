//! The closures of a time integration.

use std::{cell::Cell, ptr, rc::Rc};

use petsc_sys as sys;

use super::{AlphaParameters, TsRef, trampolines};
use crate::{
    CallbackError, Evaluation, Matrix, MatrixRef, VectorRef,
    callback::{Slot, table},
    error::{Result, check},
};

type Done = std::result::Result<(), CallbackError>;
type Residual2 = dyn Fn(f64, &VectorRef, &VectorRef, &VectorRef, &mut VectorRef) -> Evaluation;
type Jacobian2 = dyn Fn(f64, &VectorRef, &VectorRef, &VectorRef, f64, f64, &mut MatrixRef) -> Done;
type Residual = dyn Fn(f64, &VectorRef, &VectorRef, &mut VectorRef) -> Evaluation;
type Jacobian = dyn Fn(f64, &VectorRef, &VectorRef, f64, &mut MatrixRef) -> Done;

/// The problem that was set, and with it the methods that can solve it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Problem {
    SecondOrder,
    Implicit,
}

impl Problem {
    /// Methods that call the closures this problem has; another one calls what was never set.
    pub(super) fn methods(self) -> &'static [&'static str] {
        match self {
            Problem::SecondOrder => &["alpha2"],
            Problem::Implicit => &["beuler", "cn", "theta", "bdf", "alpha"],
        }
    }
}

/// Everything Rust keeps for one time integration.
#[derive(Default)]
#[allow(
    clippy::type_complexity,
    reason = "the signatures of the closures are the contents"
)]
pub(super) struct TsTable {
    pub(super) residual2: Slot<Residual2>,
    pub(super) jacobian2: Slot<Jacobian2>,
    pub(super) residual: Slot<Residual>,
    pub(super) jacobian: Slot<Jacobian>,
    pub(super) pre_step: Slot<dyn Fn(&mut TsRef) -> Done>,
    pub(super) pre_stage: Slot<dyn Fn(&mut TsRef, f64) -> Done>,
    pub(super) post_stage: Slot<dyn Fn(&mut TsRef, f64, &VectorRef) -> Done>,
    pub(super) stage_check: Slot<dyn Fn(&mut TsRef, f64, &VectorRef) -> Evaluation>,
    pub(super) post_step: Slot<dyn Fn(&mut TsRef) -> Done>,
    pub(super) monitor: Slot<dyn Fn(&TsRef, i32, f64, &VectorRef) -> Done>,
    pub(super) problem: Cell<Option<Problem>>,
    pub(super) running: Cell<bool>,
    /// Whether a state is being put into the method: its closures are not called then.
    pub(super) placing: Cell<bool>,
    /// Whether the method has seen the past of the present solution; if not, the next step is a start.
    pub(super) has_history: Cell<bool>,
    /// Whether PETSc makes the start by itself.
    pub(super) own_start: Cell<bool>,
    /// The number of the last step that was a start.
    pub(super) start_step: Cell<Option<i32>>,
    /// The caller's parameters, while those for the start are in use.
    pub(super) params_after_start: Cell<Option<AlphaParameters>>,
}

/// # Safety
/// `ts` is alive.
pub(super) unsafe fn ts_table(ts: sys::TS) -> Result<Rc<TsTable>> {
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
    /// If the integration is running.
    pub fn set_second_order(
        &mut self,
        template: &VectorRef,
        matrix: Matrix,
        residual: impl Fn(f64, &VectorRef, &VectorRef, &VectorRef, &mut VectorRef) -> Evaluation
        + 'static,
        jacobian: impl Fn(f64, &VectorRef, &VectorRef, &VectorRef, f64, f64, &mut MatrixRef) -> Done
        + 'static,
    ) -> Result<()> {
        self.require_idle()?;
        let table = self.table()?;
        table.residual2.set(Rc::new(residual));
        table.jacobian2.set(Rc::new(jacobian));
        table.problem.set(Some(Problem::SecondOrder));
        let f = template.duplicate()?;
        let (ts, m, none) = (self.raw(), matrix.raw(), ptr::null_mut());
        // SAFETY: live objects; PETSc counts its references; the functions find their closures by
        // themselves.
        unsafe {
            check(sys::TSSetType(ts, sys::TSALPHA2.as_ptr()))?;
            check(sys::TSSetI2Function(
                ts,
                f.raw(),
                Some(trampolines::on_residual2),
                none,
            ))?;
            check(sys::TSSetI2Jacobian(
                ts,
                m,
                m,
                Some(trampolines::on_jacobian2),
                none,
            ))
        }
    }

    /// Poses the implicit first-order problem `f(t, u, du/dt) = 0`, or a static one that does not
    /// depend on du/dt, and chooses TSBEULER. `template` gives the layout.
    ///
    /// `residual(t, u, udot, f)` fills f and must have no memory: it is evaluated at trial points.
    /// `jacobian(t, u, udot, shift, matrix)` fills the matrix with `df/du + shift df/dudot`.
    ///
    /// # Errors
    /// If the integration is running.
    pub fn set_implicit(
        &mut self,
        template: &VectorRef,
        matrix: Matrix,
        residual: impl Fn(f64, &VectorRef, &VectorRef, &mut VectorRef) -> Evaluation + 'static,
        jacobian: impl Fn(f64, &VectorRef, &VectorRef, f64, &mut MatrixRef) -> Done + 'static,
    ) -> Result<()> {
        self.require_idle()?;
        let table = self.table()?;
        table.residual.set(Rc::new(residual));
        table.jacobian.set(Rc::new(jacobian));
        table.problem.set(Some(Problem::Implicit));
        let f = template.duplicate()?;
        let (ts, m, none) = (self.raw(), matrix.raw(), ptr::null_mut());
        // SAFETY: as in `set_second_order`.
        unsafe {
            check(sys::TSSetType(ts, sys::TSBEULER.as_ptr()))?;
            check(sys::TSSetIFunction(
                ts,
                f.raw(),
                Some(trampolines::on_residual),
                none,
            ))?;
            check(sys::TSSetIJacobian(
                ts,
                m,
                m,
                Some(trampolines::on_jacobian),
                none,
            ))
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
        check(unsafe { sys::TSSetPreStep(self.raw(), Some(trampolines::on_pre_step)) })
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
        check(unsafe { sys::TSSetPreStage(self.raw(), Some(trampolines::on_pre_stage)) })
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
        check(unsafe { sys::TSSetPostStage(self.raw(), Some(trampolines::on_post_stage)) })
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
        check(unsafe {
            sys::TSSetFunctionDomainError(self.raw(), Some(trampolines::on_stage_check))
        })
    }

    /// Sets the hook after each step: called also after a failed one.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_post_step(&mut self, hook: impl Fn(&mut TsRef) -> Done + 'static) -> Result<()> {
        self.table()?.post_step.set(Rc::new(hook));
        // SAFETY: as in `install_pre_step`.
        check(unsafe { sys::TSSetPostStep(self.raw(), Some(trampolines::on_post_step)) })
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
        let (function, none) = (Some(trampolines::on_monitor as _), ptr::null_mut());
        // SAFETY: as in `install_pre_step`.
        check(unsafe { sys::TSMonitorSet(self.raw(), function, none, None) })
    }
}
