//! The closures of a nonlinear solver, and the C functions that call them.

use std::{
    cell::{Cell, RefCell},
    ffi::{c_int, c_void},
    ptr,
    rc::Rc,
};

use petsc_sys as sys;

use super::{LineSearchInfo, SnesRef};
use crate::{
    CallbackError, Evaluation, Matrix, MatrixRef, SnesReason, VectorRef,
    callback::{Outcome, Slot, evaluate, run, table},
    error::{Cause, Result, check, fail},
};

type Done = std::result::Result<(), CallbackError>;

/// Everything Rust keeps for one solver.
#[derive(Default)]
#[allow(
    clippy::type_complexity,
    reason = "the signatures of the closures are the contents"
)]
pub(crate) struct SnesTable {
    residual: Slot<dyn Fn(&VectorRef, &mut VectorRef) -> Evaluation>,
    jacobian: Slot<dyn Fn(&VectorRef, &mut MatrixRef) -> Done>,
    initial_guess: Slot<dyn Fn(&mut VectorRef) -> Done>,
    update: Slot<dyn Fn(&mut SnesRef, i32) -> Done>,
    monitor: Slot<dyn Fn(&SnesRef, i32, f64) -> Done>,
    convergence:
        Slot<dyn Fn(&SnesRef, &ConvergenceCheck) -> std::result::Result<SnesReason, CallbackError>>,
    pub(super) line_search:
        Slot<dyn Fn(&LineSearchInfo<'_>) -> std::result::Result<f64, CallbackError>>,
    /// The residual norms of the solve at work, one per iteration.
    pub(super) norms: RefCell<Vec<f64>>,
    pub(super) has_bounds: Cell<bool>,
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
    /// If PETSc fails.
    pub fn set_function(
        &mut self,
        template: &VectorRef,
        residual: impl Fn(&VectorRef, &mut VectorRef) -> Evaluation + 'static,
    ) -> Result<()> {
        self.table()?.residual.set(Rc::new(residual));
        let f = template.duplicate()?;
        // SAFETY: live objects; PETSc counts its reference to `f`.
        check(unsafe {
            sys::SNESSetFunction(self.raw(), f.raw(), Some(on_residual), ptr::null_mut())
        })
    }

    /// Sets the tangent matrix `df/dx` at x.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_jacobian(
        &mut self,
        matrix: Matrix,
        jacobian: impl Fn(&VectorRef, &mut MatrixRef) -> Done + 'static,
    ) -> Result<()> {
        self.table()?.jacobian.set(Rc::new(jacobian));
        let (raw, none) = (matrix.raw(), ptr::null_mut());
        // SAFETY: live objects; PETSc counts its references to the matrix.
        check(unsafe { sys::SNESSetJacobian(self.raw(), raw, raw, Some(on_jacobian), none) })
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
        let (function, none) = (Some(on_initial_guess as _), ptr::null_mut());
        // SAFETY: a live solver; the function finds its closure by itself.
        check(unsafe { sys::SNESSetComputeInitialGuess(self.raw(), function, none) })
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
        check(unsafe { sys::SNESSetUpdate(self.raw(), Some(on_update)) })
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
        let (function, none) = (Some(on_monitor as _), ptr::null_mut());
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
        if !self.table()?.convergence.is_set() || self.option_is_given("snes_convergence_test")? {
            return Ok(());
        }
        let (function, none) = (Some(on_convergence as _), ptr::null_mut());
        // SAFETY: a live solver; the function finds its closure by itself.
        check(unsafe { sys::SNESSetConvergenceTest(self.raw(), function, none, None) })
    }

    /// What PETSc's own test says. For solvers with bounds PETSc's test knows the residual only.
    fn default_test(&self, it: i32, x: f64, step: f64, f: f64) -> Result<SnesReason> {
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

unsafe extern "C" fn on_residual(
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

unsafe extern "C" fn on_jacobian(
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

unsafe extern "C" fn on_initial_guess(snes: sys::SNES, x: sys::Vec, _: *mut c_void) -> c_int {
    run(snes.cast(), || {
        // SAFETY: PETSc's live objects; `x` is PETSc's to fill and lent to nobody else.
        let (table, x) = unsafe { (snes_table(snes)?, VectorRef::from_raw_mut(x)?) };
        table.initial_guess.get()?(x)
    })
}

unsafe extern "C" fn on_update(snes: sys::SNES, iteration: c_int) -> c_int {
    run(snes.cast(), || {
        // SAFETY: PETSc's live solver, which waits for this function.
        let (table, snes) = unsafe { (snes_table(snes)?, SnesRef::from_raw_mut(snes)?) };
        table.update.get()?(snes, iteration)
    })
}

unsafe extern "C" fn on_monitor(
    snes: sys::SNES,
    iteration: c_int,
    norm: f64,
    _context: *mut c_void,
) -> c_int {
    run(snes.cast(), || {
        // SAFETY: PETSc's live solver.
        let (table, snes) = unsafe { (snes_table(snes)?, SnesRef::from_raw(snes)?) };
        table.monitor.get()?(snes, iteration, norm)
    })
}

unsafe extern "C" fn on_convergence(
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
        let verdict = table.convergence.get()?(snes, &check)?;
        // SAFETY: PETSc's place for the answer.
        unsafe { *reason = verdict.to_raw() };
        Ok(())
    })
}
