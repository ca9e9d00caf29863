//! The closures of a nonlinear solver.

use std::{
    cell::{Cell, RefCell},
    ptr,
    rc::Rc,
};

use petsc_sys as sys;

use super::{LineSearchInfo, SnesRef, trampolines};
use crate::{
    CallbackError, Evaluation, Matrix, MatrixRef, SnesReason, Vector, VectorRef,
    callback::{Slot, table},
    error::{Result, check},
};

type Done = std::result::Result<(), CallbackError>;

/// Everything Rust keeps for one solver.
#[derive(Default)]
#[allow(
    clippy::type_complexity,
    reason = "the signatures of the closures are the contents"
)]
pub(crate) struct SnesTable {
    pub(super) residual: Slot<dyn Fn(&VectorRef, &mut VectorRef) -> Evaluation>,
    pub(super) jacobian: Slot<dyn Fn(&VectorRef, &mut MatrixRef) -> Done>,
    pub(super) initial_guess: Slot<dyn Fn(&mut VectorRef) -> Done>,
    pub(super) update: Slot<dyn Fn(&mut SnesRef, i32) -> Done>,
    pub(super) monitor: Slot<dyn Fn(&SnesRef, i32, f64) -> Done>,
    pub(super) convergence:
        Slot<dyn Fn(&SnesRef, &ConvergenceCheck) -> std::result::Result<SnesReason, CallbackError>>,
    pub(super) line_search:
        Slot<dyn Fn(&LineSearchInfo<'_>) -> std::result::Result<f64, CallbackError>>,
    /// The residual norms of the solve at work, one per iteration.
    pub(super) norms: RefCell<Vec<f64>>,
    /// How many bounds this rank has, if any are set.
    pub(super) bounds_size: Cell<Option<usize>>,
    pub(crate) running: Cell<bool>,
    /// Whether the last residual evaluation has left the domain; cleared by who wants to know.
    pub(super) outside_domain: Cell<bool>,
    /// What every solve has to answer at once while a state is put into the time integration.
    pub(crate) placed: RefCell<Option<Vector>>,
    pub(crate) shell_setup: Slot<dyn Fn(&SnesRef, &MatrixRef) -> Evaluation>,
    pub(crate) shell_apply: Slot<dyn Fn(&VectorRef, &mut VectorRef) -> Done>,
}

/// What a convergence test looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConvergenceCheck {
    /// The iteration just made; 0 before the first.
    pub iteration: i32,
    /// The norm of the iterate.
    pub solution_norm: f64,
    /// The norm of the step.
    pub step_norm: f64,
    /// The residual norm; with bounds, that of the inactive unknowns.
    pub residual_norm: f64,
    /// What PETSc's own test for this type of solver says.
    pub default: SnesReason,
}

/// The table of a solver.
///
/// # Safety
/// `snes` is alive.
pub(crate) unsafe fn snes_table(snes: sys::SNES) -> Result<Rc<SnesTable>> {
    // SAFETY: a live object, and a name used for this type only.
    unsafe { table(snes.cast(), c"petsc.rs: closures of the nonlinear solver") }
}

impl SnesRef {
    pub(crate) fn table(&self) -> Result<Rc<SnesTable>> {
        // SAFETY: a live object.
        unsafe { snes_table(self.raw()) }
    }

    /// Sets the residual `f(x)`. `template` gives the layout.
    ///
    /// # Errors
    /// If the solver is running.
    pub fn set_function(
        &mut self,
        template: &VectorRef,
        residual: impl Fn(&VectorRef, &mut VectorRef) -> Evaluation + 'static,
    ) -> Result<()> {
        self.require_idle()?;
        self.table()?.residual.set(Rc::new(residual));
        let f = template.duplicate()?;
        // SAFETY: live objects; PETSc counts its reference to `f`.
        check(unsafe {
            sys::SNESSetFunction(
                self.raw(),
                f.raw(),
                Some(trampolines::on_residual),
                ptr::null_mut(),
            )
        })
    }

    /// Sets the tangent matrix `df/dx` at x.
    ///
    /// # Errors
    /// If the solver is running.
    pub fn set_jacobian(
        &mut self,
        matrix: Matrix,
        jacobian: impl Fn(&VectorRef, &mut MatrixRef) -> Done + 'static,
    ) -> Result<()> {
        self.require_idle()?;
        self.table()?.jacobian.set(Rc::new(jacobian));
        let (raw, none) = (matrix.raw(), ptr::null_mut());
        // SAFETY: live objects; PETSc counts its references to the matrix.
        check(unsafe {
            sys::SNESSetJacobian(self.raw(), raw, raw, Some(trampolines::on_jacobian), none)
        })
    }

    /// Sets a closure that changes the start of each solve.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_initial_guess(
        &mut self,
        guess: impl Fn(&mut VectorRef) -> Done + 'static,
    ) -> Result<()> {
        self.table()?.initial_guess.set(Rc::new(guess));
        self.install_initial_guess()
    }

    fn install_initial_guess(&mut self) -> Result<()> {
        let (function, none) = (Some(trampolines::on_initial_guess as _), ptr::null_mut());
        // SAFETY: a live solver; the function finds its closure by itself.
        check(unsafe { sys::SNESSetComputeInitialGuess(self.raw(), function, none) })
    }

    /// From here on every solve answers `answer` at once; with none, solves are solves again.
    pub(crate) fn answer_at_once(&mut self, answer: Option<Vector>) -> Result<()> {
        self.table()?.placed.replace(answer);
        self.install_initial_guess()?;
        self.install_convergence_test()
    }

    /// Sets a closure called at the start of each iteration, before the tangent matrix is made, with
    /// the number of iterations done.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_update(
        &mut self,
        update: impl Fn(&mut SnesRef, i32) -> Done + 'static,
    ) -> Result<()> {
        self.table()?.update.set(Rc::new(update));
        // SAFETY: a live solver; the function finds its closure by itself.
        check(unsafe { sys::SNESSetUpdate(self.raw(), Some(trampolines::on_update)) })
    }

    /// Sets a closure called after each iteration (and before the first) with its number and the
    /// residual norm. It replaces the one set before; monitors set by options are called too.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_monitor(
        &mut self,
        monitor: impl Fn(&SnesRef, i32, f64) -> Done + 'static,
    ) -> Result<()> {
        let table = self.table()?;
        let installed = table.monitor.is_set();
        table.monitor.set(Rc::new(monitor));
        if installed {
            return Ok(());
        }
        let (function, none) = (Some(trampolines::on_monitor as _), ptr::null_mut());
        // SAFETY: a live solver; the function finds its closure by itself.
        check(unsafe { sys::SNESMonitorSet(self.raw(), function, none, None) })
    }

    /// Sets the test that ends the solve. The option `-snes_convergence_test` goes before it.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_convergence_test(
        &mut self,
        test: impl Fn(&SnesRef, &ConvergenceCheck) -> std::result::Result<SnesReason, CallbackError>
        + 'static,
    ) -> Result<()> {
        self.table()?.convergence.set(Rc::new(test));
        self.install_convergence_test()
    }

    pub(super) fn install_convergence_test(&mut self) -> Result<()> {
        let table = self.table()?;
        let wanted = table.convergence.is_set() || table.placed.borrow().is_some();
        if !wanted || self.option_is_given("snes_convergence_test")? {
            return Ok(());
        }
        let (function, none) = (Some(trampolines::on_convergence as _), ptr::null_mut());
        // SAFETY: a live solver; the function finds its closure by itself.
        check(unsafe { sys::SNESSetConvergenceTest(self.raw(), function, none, None) })
    }

    /// What PETSc's own test says. For solvers with bounds PETSc's test knows the residual only.
    pub(super) fn default_test(&self, it: i32, x: f64, step: f64, f: f64) -> Result<SnesReason> {
        let mut reason = sys::SNES_CONVERGED_ITERATING;
        // SAFETY: a live solver, one value to write; the context is not used.
        check(unsafe {
            sys::SNESConvergedDefault(self.raw(), it, x, step, f, &mut reason, ptr::null_mut())
        })?;
        let reason = SnesReason::from_raw(reason);
        let residual_only = !matches!(
            reason,
            SnesReason::ConvergedStep | SnesReason::DivergedTolerance
        );
        Ok(if residual_only || !self.is_bounded()? {
            reason
        } else {
            SnesReason::Iterating
        })
    }
}
