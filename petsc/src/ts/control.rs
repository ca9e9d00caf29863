//! Times, steps and limits of a time integration.

use std::ptr;

use petsc_sys as sys;

use super::TsRef;
use crate::{
    error::{Error, Result, check, text_of},
    handle::{plain_getters, plain_setters},
};

/// What happens when a step would go beyond the final time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExactFinalTime {
    /// The last step goes beyond.
    StepOver,
    /// The last step is shortened. The default here.
    MatchStep,
}

impl TsRef {
    plain_getters! {
        /// The time reached.
        time, TSGetTime => f64;
        /// The time before the last step.
        previous_time, TSGetPrevTime => f64;
        /// The size of the step at work, or of the next one.
        time_step, TSGetTimeStep => f64;
        /// The final time.
        max_time, TSGetMaxTime => f64;
        /// The largest number of steps.
        max_steps, TSGetMaxSteps => i32;
        /// The number of steps done.
        step_number, TSGetStepNumber => i32;
        /// How often the nonlinear solver has failed.
        snes_failures, TSGetSNESFailures => i32;
        /// How often a step was refused.
        step_rejections, TSGetStepRejections => i32;
        /// The nonlinear iterations so far.
        snes_iterations, TSGetSNESIterations => i32;
        /// The linear iterations so far.
        ksp_iterations, TSGetKSPIterations => i32;
    }

    plain_setters! {
        /// Sets the present time.
        set_time, TSSetTime <= f64;
        /// Sets the size of the next step. For the post-step hook, or before the solve.
        set_time_step, TSSetTimeStep <= f64;
        /// Sets the final time.
        set_max_time, TSSetMaxTime <= f64;
        /// Sets the largest number of steps.
        set_max_steps, TSSetMaxSteps <= i32;
        /// Sets the number of steps done, for example after a restart from a file; call
        /// [`TsRef::restart_step`] too.
        set_step_number, TSSetStepNumber <= i32;
        /// Sets how many failures of the nonlinear solver end the run; -1 for no limit.
        set_max_snes_failures, TSSetMaxSNESFailures <= i32;
        /// Sets how often one step may be refused; -1 for no limit.
        set_max_step_rejections, TSSetMaxStepRejections <= i32;
    }

    /// The method, for example `alpha2`, once it is known.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn method(&self) -> Result<Option<String>> {
        let mut name = ptr::null();
        // SAFETY: a live object; PETSc writes null or a pointer to its own string.
        check(unsafe { sys::TSGetType(self.raw(), &mut name) })?;
        // SAFETY: as said above.
        Ok(Some(unsafe { text_of(name) }).filter(|name| !name.is_empty()))
    }

    /// Sets what happens when a step would go beyond the final time.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn set_exact_final_time(&mut self, choice: ExactFinalTime) -> Result<()> {
        let choice = match choice {
            ExactFinalTime::StepOver => sys::TS_EXACTFINALTIME_STEPOVER,
            ExactFinalTime::MatchStep => sys::TS_EXACTFINALTIME_MATCHSTEP,
        };
        // SAFETY: a live object.
        check(unsafe { sys::TSSetExactFinalTime(self.raw(), choice) })
    }

    /// TSALPHA2 cannot interpolate, and PETSc wants a second vector for it.
    pub(super) fn require_no_interpolation(&self) -> Result<()> {
        let mut choice = sys::TS_EXACTFINALTIME_MATCHSTEP;
        // SAFETY: a live object, one value to write.
        check(unsafe { sys::TSGetExactFinalTime(self.raw(), &mut choice) })?;
        if choice == sys::TS_EXACTFINALTIME_INTERPOLATE {
            return Err(Error::usage(
                "-ts_exact_final_time must be stepover or matchstep",
            ));
        }
        Ok(())
    }

    /// Sets the factor by which a step is cut back when the nonlinear solver fails.
    ///
    /// # Errors
    /// If the factor is not between 0 and 1.
    pub fn set_adapt_scale_solve_failed(&mut self, factor: f64) -> Result<()> {
        // SAFETY: a live object.
        check(unsafe { sys::TSAdaptSetScaleSolveFailed(self.adapt()?, factor) })
    }

    fn adapt(&self) -> Result<sys::TSAdapt> {
        let mut adapt = ptr::null_mut();
        // SAFETY: a live object; PETSc writes its adaptor, which it owns.
        check(unsafe { sys::TSGetAdapt(self.raw(), &mut adapt) })?;
        Ok(adapt)
    }
}
