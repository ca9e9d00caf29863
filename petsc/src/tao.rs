//! Least squares within bounds.
//!
//! In: a residual `r(x)`, its derivative `dr/dx` and bounds, as closures and vectors. Out: the `x` within the
//! bounds with the least `|r|²`, and the reason why the search stopped. Never: a choice of method beyond the
//! bounded Gauss-Newton method (`brgn`); the rest is made by options.

use std::{
    cell::Cell,
    ffi::{c_int, c_void},
    ptr,
    rc::Rc,
};

use mpi::topology::Communicator;
use petsc_sys as sys;

use crate::{
    CallbackError, Evaluation, Matrix, MatrixRef, TaoReason, VectorRef,
    callback::{Outcome, Slot, evaluate, run, table},
    error::{Cause, Error, Result, check, fail},
    handle::{petsc_object, plain_getters},
    session::keep,
};

petsc_object! {
    /// A solver of least-squares problems within bounds.
    Tao,
    /// A borrowed [`Tao`].
    TaoRef,
    Tao, TaoDestroy
}

/// The closures of one problem.
#[derive(Default)]
#[allow(
    clippy::type_complexity,
    reason = "the signatures of the closures are the contents"
)]
struct TaoTable {
    residual: Slot<dyn Fn(&VectorRef, &mut VectorRef) -> Evaluation>,
    jacobian: Slot<dyn Fn(&VectorRef, &mut MatrixRef) -> std::result::Result<(), CallbackError>>,
    /// Whether the point of the last residual lies outside the domain.
    outside: Cell<bool>,
    running: Cell<bool>,
}

impl Tao {
    /// A bounded Gauss-Newton solver (`brgn`) without a problem. Collective.
    ///
    /// # Errors
    /// If PETSc is not running.
    pub fn new<C: Communicator>(comm: &C) -> Result<Self> {
        let keep = keep()?;
        let mut raw = ptr::null_mut();
        // SAFETY: a valid communicator; PETSc writes the new object, which is owned at once; the name is
        // a C string.
        unsafe {
            check(sys::TaoCreate(comm.as_raw(), &mut raw))?;
            let tao = Self::own(raw, keep)?;
            check(sys::TaoSetType(raw, sys::TAOBRGN.as_ptr()))?;
            Ok(tao)
        }
    }

    /// Goes from the start `x` to the least sum of squares. Collective.
    ///
    /// # Errors
    /// If PETSc or a closure fails, among them a residual outside its domain at the start; a search
    /// that gives up is a [`TaoReason`].
    pub fn solve(&mut self, x: &mut VectorRef) -> Result<TaoReason> {
        self.require_idle()?;
        let table = self.table()?;
        if !table.residual.is_set() || !table.jacobian.is_set() {
            return Err(Error::usage("set residual and derivative before"));
        }
        // PETSc keeps the vector it is given, and lends it to closures: it gets one of its own.
        let work = x.to_owned()?;
        // SAFETY: live objects; PETSc counts its reference.
        check(unsafe { sys::TaoSetSolution(self.raw(), work.raw()) })?;
        table.running.set(true);
        // SAFETY: a live solver with everything it needs.
        let solved = check(unsafe { sys::TaoSolve(self.raw()) });
        table.running.set(false);
        solved?;
        x.copy_from(&work)?;
        self.converged_reason()
    }
}

impl TaoRef {
    fn table(&self) -> Result<Rc<TaoTable>> {
        // SAFETY: a live object, and a name used for this type only.
        unsafe { table(self.object(), c"petsc.rs: closures of the least squares") }
    }

    /// What the callbacks get: PETSc calls them on a solver of its own inside this one, which knows no
    /// table. The object holds the table as long as it lives, and the inner solver lives no longer.
    fn context(&self) -> Result<*mut c_void> {
        Ok(Rc::as_ptr(&self.table()?).cast_mut().cast())
    }

    fn require_idle(&self) -> Result<()> {
        if self.table()?.running.get() {
            return Err(Error::usage("the optimisation is running"));
        }
        Ok(())
    }

    /// Sets the residual `r(x)`. `template` gives the layout of `r`. A point outside the domain has an
    /// infinite residual for PETSc, so the line search has to be one that steps back from there
    /// (`-tao_brgn_subsolver_tao_ls_type armijo`).
    ///
    /// # Errors
    /// If the solver is running.
    pub fn set_residual(
        &mut self,
        template: &VectorRef,
        residual: impl Fn(&VectorRef, &mut VectorRef) -> Evaluation + 'static,
    ) -> Result<()> {
        self.require_idle()?;
        self.table()?.residual.set(Rc::new(residual));
        let r = template.duplicate()?;
        // SAFETY: live objects; PETSc counts its reference to `r`.
        check(unsafe {
            sys::TaoSetResidualRoutine(self.raw(), r.raw(), Some(on_residual), self.context()?)
        })
    }

    /// Sets the derivative `dr/dx`, with as many rows as `r` and as many columns as `x`. It is asked for
    /// wherever the residual is, except outside the domain.
    ///
    /// # Errors
    /// If the solver is running.
    pub fn set_residual_jacobian(
        &mut self,
        matrix: Matrix,
        jacobian: impl Fn(&VectorRef, &mut MatrixRef) -> std::result::Result<(), CallbackError>
        + 'static,
    ) -> Result<()> {
        self.require_idle()?;
        self.table()?.jacobian.set(Rc::new(jacobian));
        let (tao, raw, context) = (self.raw(), matrix.raw(), self.context()?);
        // SAFETY: live objects; PETSc counts its references to the matrix.
        check(unsafe {
            sys::TaoSetJacobianResidualRoutine(tao, raw, raw, Some(on_jacobian), context)
        })
    }

    /// Bounds the unknowns; PETSc copies neither.
    ///
    /// # Errors
    /// If the solver is running, or the layouts differ.
    pub fn set_variable_bounds(&mut self, lower: &VectorRef, upper: &VectorRef) -> Result<()> {
        self.require_idle()?;
        if lower.local_size()? != upper.local_size()? {
            return Err(Error::usage("both bounds need the same layout"));
        }
        let (lower, upper) = (lower.to_owned()?, upper.to_owned()?);
        // SAFETY: live objects; PETSc counts its references to both.
        check(unsafe { sys::TaoSetVariableBounds(self.raw(), lower.raw(), upper.raw()) })
    }

    /// Ends the search where the norm of the gradient of `|r|²/2` is below `absolute`, and nowhere else;
    /// `-tao_gatol` and its like go over it. Where an unknown is nearer to its bound than its gradient is
    /// large, PETSc counts that distance (the function of Fischer), so the tolerance has to be small
    /// against the distances between the bounds.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_gradient_tolerance(&mut self, absolute: f64) -> Result<()> {
        // SAFETY: a live solver.
        check(unsafe { sys::TaoSetTolerances(self.raw(), absolute, 0.0, 0.0) })
    }

    /// Reads the options `-tao_…`.
    ///
    /// # Errors
    /// If an option has an impossible value, or the solver is running.
    pub fn set_from_options(&mut self) -> Result<()> {
        self.require_idle()?;
        // SAFETY: a live solver.
        check(unsafe { sys::TaoSetFromOptions(self.raw()) })
    }

    plain_getters! {
        /// The number of iterations of the last solve.
        iteration_number, TaoGetIterationNumber => i32;
    }

    /// Why the last solve stopped.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn converged_reason(&self) -> Result<TaoReason> {
        let mut reason = sys::TAO_CONTINUE_ITERATING;
        // SAFETY: a live solver, one value to write.
        check(unsafe { sys::TaoGetConvergedReason(self.raw(), &mut reason) })?;
        Ok(TaoReason::from_raw(reason))
    }
}

unsafe extern "C" fn on_residual(
    tao: sys::Tao,
    x: sys::Vec,
    r: sys::Vec,
    context: *mut c_void,
) -> c_int {
    let outcome = evaluate(tao.cast(), || {
        // SAFETY: the table that `set_residual` gave; PETSc's live objects; `r` is PETSc's to fill and
        // lent to nobody else.
        let (table, x, r) = unsafe {
            (
                &*context.cast::<TaoTable>(),
                VectorRef::from_raw(x)?,
                VectorRef::from_raw_mut(r)?,
            )
        };
        table.residual.get()?(x, r)
    });
    let outcome = match outcome {
        Ok(outcome) => outcome,
        Err(code) => return code,
    };
    // SAFETY: as above; the closure has given `r` back.
    let (table, r) = unsafe { (&*context.cast::<TaoTable>(), VectorRef::from_raw_mut(r)) };
    table.outside.set(outcome == Outcome::Domain);
    match outcome {
        Outcome::Done => 0,
        Outcome::Domain => match r.and_then(|r| r.set_all(f64::INFINITY)) {
            Ok(()) => 0,
            Err(error) => fail(Cause::Callback(error.into())),
        },
    }
}

unsafe extern "C" fn on_jacobian(
    tao: sys::Tao,
    x: sys::Vec,
    matrix: sys::Mat,
    _preconditioning: sys::Mat,
    context: *mut c_void,
) -> c_int {
    run(tao.cast(), || {
        // SAFETY: the table that `set_residual_jacobian` gave; PETSc's live objects; the matrix is PETSc's
        // to fill and lent to nobody else.
        let (table, x, matrix) = unsafe {
            (
                &*context.cast::<TaoTable>(),
                VectorRef::from_raw(x)?,
                MatrixRef::from_raw_mut(matrix)?,
            )
        };
        if table.outside.get() {
            return Ok(());
        }
        table.jacobian.get()?(x, matrix)
    })
}
