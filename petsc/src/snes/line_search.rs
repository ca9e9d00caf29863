//! A damped Newton step whose damping the caller chooses.

use std::{
    ffi::{c_int, c_void},
    ptr,
    rc::Rc,
};

use petsc_sys as sys;

use super::{SnesRef, closures::snes_table};
use crate::{
    CallbackError, VectorRef,
    callback::run,
    error::{Result, check},
};

/// How often a step that cannot be computed is halved before the line search gives up.
const HALVINGS: usize = 6;

/// What the choice of the damping can look at.
#[non_exhaustive]
pub struct LineSearchInfo<'a> {
    /// The number of iterations done.
    pub iteration: i32,
    /// The residual norm before the step; with bounds, that of the inactive unknowns.
    pub residual_norm: f64,
    /// The residual norms of this solve so far, the current one last.
    pub history: &'a [f64],
    /// The solver, with its iterate, residual and active set.
    pub snes: &'a SnesRef,
    /// The Newton step, which is subtracted from the iterate.
    pub step: &'a VectorRef,
}

impl SnesRef {
    /// Makes each iteration take the Newton step times the factor that `damping` returns, projected
    /// onto the bounds. If the residual cannot be computed there, or is not finite, the step is
    /// halved up to six times. The factor must be the same on all ranks. The option
    /// `-snes_linesearch_type` goes before it.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_shell_line_search(
        &mut self,
        damping: impl Fn(&LineSearchInfo<'_>) -> std::result::Result<f64, CallbackError> + 'static,
    ) -> Result<()> {
        self.table()?.line_search.set(Rc::new(damping));
        self.install_line_search()
    }

    pub(super) fn install_line_search(&mut self) -> Result<()> {
        if !self.table()?.line_search.is_set() || self.option_is_given("snes_linesearch_type")? {
            return Ok(());
        }
        let mut search = ptr::null_mut();
        let shell = sys::SNESLINESEARCHSHELL.as_ptr();
        // SAFETY: a live solver; PETSc writes its line search, which lives as long as itself; the
        // function finds its closure by itself.
        unsafe {
            check(sys::SNESGetLineSearch(self.raw(), &mut search))?;
            check(sys::SNESLineSearchSetType(search, shell))?;
            check(sys::petsc_rs_line_search_set_apply(
                search,
                Some(on_search),
                ptr::null_mut(),
            ))
        }
    }
}

unsafe extern "C" fn on_search(search: sys::SNESLineSearch, _context: *mut c_void) -> c_int {
    let mut chosen = None;
    // The ranks agree on the closure's outcome before they take the step together.
    let code = run(search.cast(), || {
        let mut snes = ptr::null_mut();
        // SAFETY: PETSc's live line search; PETSc writes its solver.
        check(unsafe { sys::SNESLineSearchGetSNES(search, &mut snes) })?;
        // SAFETY: PETSc's live line search and solver.
        let step = unsafe { Step::begin(search, snes) }?;
        let damping = step.damping()?;
        chosen = Some((step, damping));
        Ok(())
    });
    match chosen {
        Some((step, damping)) if code == 0 => run(search.cast(), || Ok(step.take(damping)?)),
        _ => code,
    }
}

/// One application of the line search: PETSc's objects, which live while it runs.
struct Step {
    search: sys::SNESLineSearch,
    snes: sys::SNES,
    /// Iterate, residual, Newton step, and work space for the new iterate.
    x: sys::Vec,
    f: sys::Vec,
    y: sys::Vec,
    w: sys::Vec,
    residual_norm: f64,
    project: sys::petsc_rs_project,
    bounded_norm: sys::petsc_rs_norm,
}

impl Step {
    /// # Safety
    /// Both objects are alive, and the line search was called by the solver.
    unsafe fn begin(search: sys::SNESLineSearch, snes: sys::SNES) -> Result<Self> {
        let none = ptr::null_mut();
        let mut this = Step {
            search,
            snes,
            x: none,
            f: none,
            y: none,
            w: none,
            residual_norm: 0.0,
            project: None,
            bounded_norm: None,
        };
        let (mut x_norm, mut y_norm) = (0.0, 0.0);
        let mut changed = sys::PETSC_FALSE;
        // SAFETY: as promised by the caller; one value is written behind each pointer.
        unsafe {
            let (x, f, y, w) = (&mut this.x, &mut this.f, &mut this.y, &mut this.w);
            check(sys::SNESLineSearchGetVecs(
                search,
                x,
                f,
                y,
                w,
                ptr::null_mut(),
            ))?;
            let norm = &mut this.residual_norm;
            check(sys::SNESLineSearchGetNorms(
                search,
                &mut x_norm,
                norm,
                &mut y_norm,
            ))?;
            let (project, norm) = (&mut this.project, &mut this.bounded_norm);
            check(sys::petsc_rs_line_search_get_vi(search, project, norm))?;
            check(sys::SNESLineSearchPreCheck(
                search,
                this.x,
                this.y,
                &mut changed,
            ))?;
        }
        Ok(this)
    }

    fn damping(&self) -> std::result::Result<f64, CallbackError> {
        // SAFETY: live objects, which nobody changes while the closure looks at them.
        let (table, snes, step) = unsafe {
            (
                snes_table(self.snes)?,
                SnesRef::from_raw(self.snes)?,
                VectorRef::from_raw(self.y)?,
            )
        };
        let iteration = snes.iteration_number()?;
        let mut norms = table.norms.take();
        if iteration == 0 {
            norms.clear();
        }
        norms.push(self.residual_norm);
        let residual_norm = self.residual_norm;
        let info = LineSearchInfo {
            iteration,
            residual_norm,
            history: &norms,
            snes,
            step,
        };
        let damping = table.line_search.get()?(&info);
        table.norms.replace(norms);
        damping
    }

    /// Takes the step as PETSc's solvers expect it: iterate, residual and norms are those of the new
    /// point, or the reason says why there is none.
    fn take(&self, mut damping: f64) -> Result<()> {
        let mut failure = sys::SNES_LINESEARCH_FAILED_NANORINF;
        for _ in 0..=HALVINGS {
            match self.attempt(damping)? {
                Ok(norm) => return self.accept(damping, norm),
                Err(reason) => failure = reason,
            }
            damping /= 2.0;
        }
        // The domain flag of the last attempt stays, for the solver to read. A norm that is not a
        // number makes it look: with the old norms it may take the last step's size for convergence.
        let (x_norm, y_norm) = self.norms()?;
        // SAFETY: a live line search.
        unsafe {
            check(sys::SNESLineSearchSetNorms(
                self.search,
                x_norm,
                f64::NAN,
                y_norm,
            ))?;
            check(sys::SNESLineSearchSetReason(self.search, failure))
        }
    }

    /// The residual norm at the damped step, or why there is none.
    fn attempt(&self, damping: f64) -> Result<Result<f64, sys::SNESLineSearchReason>> {
        let mut norm = 0.0;
        // SAFETY: PETSc's live solver.
        let table = unsafe { snes_table(self.snes) }?;
        table.outside_domain.set(false);
        // SAFETY: live objects of this line search.
        unsafe {
            check(sys::VecWAXPY(self.w, -damping, self.y, self.x))?;
            if let Some(project) = self.project {
                check(project(self.snes, self.w))?;
            }
            check(sys::SNESComputeFunction(self.snes, self.w, self.f))?;
            // Closures make it the same on all ranks. PETSc's own flag cannot be read since 3.25.
            if table.outside_domain.get() {
                return Ok(Err(sys::SNES_LINESEARCH_FAILED_DOMAIN));
            }
            // The norm of all unknowns, because the one with bounds overlooks a NaN on a bound.
            check(sys::VecNorm(self.f, sys::NORM_2, &mut norm))?;
            if let (true, Some(bounded_norm)) = (norm.is_finite(), self.bounded_norm) {
                check(bounded_norm(self.snes, self.f, self.w, &mut norm))?;
            }
        }
        Ok(if norm.is_finite() {
            Ok(norm)
        } else {
            Err(sys::SNES_LINESEARCH_FAILED_NANORINF)
        })
    }

    fn accept(&self, damping: f64, norm: f64) -> Result<()> {
        // SAFETY: live vectors of this line search.
        check(unsafe { sys::VecCopy(self.w, self.x) })?;
        let (x_norm, y_norm) = self.norms()?;
        let step_norm = damping.abs() * y_norm;
        // SAFETY: a live line search.
        unsafe {
            check(sys::SNESLineSearchSetLambda(self.search, damping))?;
            check(sys::SNESLineSearchSetNorms(
                self.search,
                x_norm,
                norm,
                step_norm,
            ))?;
            check(sys::SNESLineSearchSetReason(
                self.search,
                sys::SNES_LINESEARCH_SUCCEEDED,
            ))
        }
    }

    /// The norms of the iterate and of the whole Newton step.
    fn norms(&self) -> Result<(f64, f64)> {
        let (mut x_norm, mut y_norm) = (0.0, 0.0);
        // SAFETY: live vectors of this line search, one number each to write.
        unsafe {
            check(sys::VecNorm(self.x, sys::NORM_2, &mut x_norm))?;
            check(sys::VecNorm(self.y, sys::NORM_2, &mut y_norm))?;
        }
        Ok((x_norm, y_norm))
    }
}
