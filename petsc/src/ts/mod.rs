//! Time integration.
//!
//! In: a residual and its tangent matrix in time, a start, hooks. Out: the solution at the end and the
//! reason why it ended. Never: committed state; that is the caller's, after an accepted step.
//!
//! # Known failures of PETSc, and until when
//! - `TS_LINEAR` with TSALPHA2 leaves velocity and acceleration stale without a word (3.18 to 3.26). This
//!   wrapper always says `TS_NONLINEAR`.
//! - Before 3.22 TSALPHA2's start makes the initial acceleration twice too large, which leaves first order for
//!   a spectral radius below 1. This wrapper takes the first step, and each one after
//!   [`TsRef::restart_step`], with [`AlphaParameters::START`], which does not need that acceleration, and puts
//!   the parameters back for the next step: second order. It does so with every version, so that all of
//!   them compute the same; [`TsRef::alpha2_set_own_start`] leaves the start to PETSc.
//! - TSALPHA2's start makes two hidden half steps (pre- and post-stage are called for them too). Before 3.21
//!   it puts the time step back when one of them fails: the reduction of the *first* step is lost, and
//!   the same failing solve is repeated until [`TsRef::set_max_step_rejections`] ends the run
//!   ([`Ts::START_FORGETS_CUT_BACK`]). To recover, make the first step small enough, or lower the time step
//!   and solve again after a [`TsReason::DivergedStepRejected`] at step 0.
//! - Since 3.19 a residual outside its domain is not counted by [`TsRef::snes_failures`].
//! - The first failed nonlinear solve ends the run unless [`TsRef::set_max_snes_failures`] is -1.
//! - The default adaptor never makes the step larger again.
//! - A step is repeated inside PETSc: the pre-*stage* hook runs for each attempt, the pre-*step* hook
//!   only once. The post-step hook runs also after a failed step: look at
//!   [`TsRef::converged_reason`] first.

mod alpha;
mod alpha_state;
mod closures;
mod control;
mod trampolines;

use std::ptr;

use mpi::topology::Communicator;
use petsc_sys as sys;

use crate::{
    SnesRef, TsReason, VectorRef,
    error::{Error, Result, check},
    handle::petsc_object,
    session::{c_string, keep},
};

pub use alpha::AlphaParameters;
pub use alpha_state::Alpha2State;
pub use control::ExactFinalTime;

petsc_object! {
    /// A time integration.
    Ts,
    /// A borrowed [`Ts`], as given to hooks.
    TsRef,
    TS, TSDestroy
}

impl Ts {
    /// Whether TSALPHA2 repeats a refused first step at the same length for ever.
    pub const START_FORGETS_CUT_BACK: bool = cfg!(not(petsc_ge_3_21));

    /// The option that limits how often a step is refused; PETSc warns of its old name since 3.25.
    pub const REJECTIONS_OPTION: &str = if cfg!(petsc_ge_3_25) {
        "ts_max_step_rejections"
    } else {
        "ts_max_reject"
    };

    /// Whether TSALPHA2's own start makes its first acceleration twice too large.
    pub const OWN_START_IS_OF_FIRST_ORDER: bool = cfg!(not(petsc_ge_3_22));

    /// A time integration without a problem. Collective.
    ///
    /// # Errors
    /// If PETSc is not running.
    pub fn new<C: Communicator>(comm: &C) -> Result<Self> {
        let keep = keep()?;
        let mut raw = ptr::null_mut();
        // SAFETY: a valid communicator; PETSc writes the new object, which is owned at once.
        unsafe {
            check(sys::TSCreate(comm.as_raw(), &mut raw))?;
            let ts = Self::own(raw, keep)?;
            check(sys::TSSetProblemType(raw, sys::TS_NONLINEAR))?;
            check(sys::TSSetErrorIfStepFails(raw, sys::PETSC_FALSE))?;
            check(sys::TSSetExactFinalTime(
                raw,
                sys::TS_EXACTFINALTIME_MATCHSTEP,
            ))?;
            Ok(ts)
        }
    }

    /// Integrates from the present time and solution. Collective.
    ///
    /// # Errors
    /// If PETSc or a closure fails; an integration that gives up is a [`TsReason`] (unless
    /// `-ts_error_if_step_fails` says otherwise).
    pub fn solve(&mut self) -> Result<TsReason> {
        self.require_no_interpolation()?;
        self.require_fitting_method()?;
        let (table, snes_table) = (self.table()?, self.snes()?.table()?);
        self.snes()?.check_layout(self.solution()?)?;
        self.prepare_start(&table)?;
        table.running.set(true);
        snes_table.running.set(true);
        // SAFETY: a live object; null means the solution set before.
        let solved = check(unsafe { sys::TSSolve(self.raw(), ptr::null_mut()) });
        snes_table.running.set(false);
        table.running.set(false);
        self.restore_params(&table)?;
        solved?;
        self.converged_reason()
    }
}

impl TsRef {
    /// Makes the integration read its options with `prefix` before their names.
    ///
    /// # Errors
    /// If PETSc rejects the prefix.
    pub fn set_options_prefix(&mut self, prefix: &str) -> Result<()> {
        let prefix = c_string(prefix)?;
        // SAFETY: a live object and a C string, which PETSc copies.
        check(unsafe { sys::TSSetOptionsPrefix(self.raw(), prefix.as_ptr()) })
    }

    /// Reads the options `-ts_…`, and those of the nonlinear solver.
    ///
    /// # Errors
    /// If an option has an impossible value, if `-ts_type` asks for a method that cannot solve the problem
    /// set before, or if the integration is running.
    pub fn set_from_options(&mut self) -> Result<()> {
        self.require_idle()?;
        // SAFETY: a live object.
        check(unsafe { sys::TSSetFromOptions(self.raw()) })?;
        self.require_fitting_method()?;
        self.snes_mut()?.restore_choices()
    }

    /// Refuses a method that would call closures the problem does not have: PETSc would call a null pointer.
    fn require_fitting_method(&self) -> Result<()> {
        let Some(problem) = self.table()?.problem.get() else {
            return Ok(());
        };
        let method = self.method()?.unwrap_or_default();
        if problem.methods().contains(&method.as_str()) {
            return Ok(());
        }
        Err(Error::usage(format!(
            "-ts_type {method} does not fit the problem; use {}",
            problem.methods().join(", ")
        )))
    }

    /// The nonlinear solver.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn snes(&self) -> Result<&SnesRef> {
        let mut snes = ptr::null_mut();
        // SAFETY: a live object; PETSc writes its solver, which lives as long as itself.
        unsafe {
            check(sys::TSGetSNES(self.raw(), &mut snes))?;
            SnesRef::from_raw(snes)
        }
    }

    /// The nonlinear solver, to change it.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn snes_mut(&mut self) -> Result<&mut SnesRef> {
        let raw = self.snes()?.raw();
        // SAFETY: the integration is borrowed mutably, and with it its solver.
        unsafe { SnesRef::from_raw_mut(raw) }
    }

    /// Sets the present solution (a copy is kept). In the hooks before and after a step it may change
    /// it too: the next step is then a start, see [`TsRef::restart_step`].
    ///
    /// # Errors
    /// If the layout differs from the one before.
    pub fn set_solution(&mut self, u: &VectorRef) -> Result<()> {
        if let Ok(present) = self.solution() {
            let raw = present.raw();
            // SAFETY: PETSc's live vector; the integration, and with it the vector, is borrowed
            // mutably. It is not replaced, because a running step holds on to it.
            unsafe { VectorRef::from_raw_mut(raw) }?.copy_from(u)?;
        } else {
            let u = u.to_owned()?;
            // SAFETY: live objects; PETSc counts its reference to the vector.
            check(unsafe { sys::TSSetSolution(self.raw(), u.raw()) })?;
        }
        self.restart_step()
    }

    /// Sets the present solution and velocity, as [`TsRef::set_solution`] does.
    ///
    /// # Errors
    /// If the layout differs from the one before.
    pub fn set_solution2(&mut self, u: &VectorRef, v: &VectorRef) -> Result<()> {
        if let Ok((_, present)) = self.solution2() {
            let raw = present.raw();
            // SAFETY: as in `set_solution`.
            unsafe { VectorRef::from_raw_mut(raw) }?.copy_from(v)?;
            return self.set_solution(u);
        }
        self.require_idle()?;
        let (u, v) = (u.to_owned()?, v.to_owned()?);
        // SAFETY: live objects; PETSc counts its references to the vectors.
        check(unsafe { sys::TS2SetSolution(self.raw(), u.raw(), v.raw()) })?;
        self.restart_step()
    }

    /// Writes into PETSc's vectors without calling it a jump.
    fn replace_solution2(&mut self, u: &VectorRef, v: &VectorRef) -> Result<()> {
        let (own_u, own_v) = self.solution2()?;
        let (own_u, own_v) = (own_u.raw(), own_v.raw());
        // SAFETY: as in `set_solution`; the two are different vectors.
        unsafe {
            VectorRef::from_raw_mut(own_u)?.copy_from(u)?;
            VectorRef::from_raw_mut(own_v)?.copy_from(v)
        }
    }

    /// The solution at the present time.
    ///
    /// # Errors
    /// If none is set.
    pub fn solution(&self) -> Result<&VectorRef> {
        let mut u = ptr::null_mut();
        // SAFETY: a live object; PETSc writes null or a vector that lives as long as the integration
        // keeps it, which no method of `&self` ends.
        unsafe {
            check(sys::TSGetSolution(self.raw(), &mut u))?;
            VectorRef::from_raw(u)
        }
    }

    /// The solution and velocity at the present time, for a second-order problem.
    ///
    /// # Errors
    /// If none is set.
    pub fn solution2(&self) -> Result<(&VectorRef, &VectorRef)> {
        let (mut u, mut v) = (ptr::null_mut(), ptr::null_mut());
        // SAFETY: as for `solution`.
        unsafe {
            check(sys::TS2GetSolution(self.raw(), &mut u, &mut v))?;
            Ok((VectorRef::from_raw(u)?, VectorRef::from_raw(v)?))
        }
    }

    /// Why the integration stopped.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn converged_reason(&self) -> Result<TsReason> {
        let mut reason = sys::TS_CONVERGED_ITERATING;
        // SAFETY: a live object, one value to write.
        check(unsafe { sys::TSGetConvergedReason(self.raw(), &mut reason) })?;
        Ok(TsReason::from_raw(reason))
    }

    /// Makes the running integration stop. Call it from the post-step hook: each step begins by
    /// forgetting the reason.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_converged_reason(&mut self, reason: TsReason) -> Result<()> {
        // SAFETY: a live object.
        check(unsafe { sys::TSSetConvergedReason(self.raw(), reason.to_raw()) })
    }

    /// A running integration holds on to its parts.
    pub(crate) fn require_idle(&self) -> Result<()> {
        if self.table()?.running.get() {
            return Err(Error::usage("the time integration is running"));
        }
        Ok(())
    }
}
