//! The generalized-alpha method for second-order problems (TSALPHA2) and the cure of its start.

use petsc_sys as sys;

use super::{TsRef, closures::TsTable};
use crate::error::{Result, check};

/// The parameters of the generalized-alpha method (Chung and Hulbert, J. Appl. Mech. 60 (1993) 371).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlphaParameters {
    /// Where between the steps the acceleration is taken.
    pub alpha_m: f64,
    /// Where between the steps displacement, velocity and forces are taken.
    pub alpha_f: f64,
    /// Newmark's gamma.
    pub gamma: f64,
    /// Newmark's beta.
    pub beta: f64,
}

impl AlphaParameters {
    /// Backward-Euler-like parameters that make no use of the acceleration at the start, which
    /// PETSc gets wrong before 3.22.
    pub const START: Self = AlphaParameters {
        alpha_m: 1.0,
        alpha_f: 1.0,
        gamma: 1.0,
        beta: 0.5,
    };
}

impl TsRef {
    /// Sets the parameters by the spectral radius for large steps: from 1, no numerical damping, to
    /// 0, the most. At 0, alpha_f is 1: the residual is taken at the end of the step.
    ///
    /// # Errors
    /// If the radius is not in [0, 1].
    pub fn alpha2_set_radius(&mut self, radius: f64) -> Result<()> {
        // SAFETY: a live object; PETSc ignores the call for other methods.
        check(unsafe { sys::TSAlpha2SetRadius(self.raw(), radius) })
    }

    /// Sets the parameters.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn alpha2_set_params(&mut self, to: AlphaParameters) -> Result<()> {
        let AlphaParameters {
            alpha_m,
            alpha_f,
            gamma,
            beta,
        } = to;
        // SAFETY: a live object; PETSc ignores the call for other methods.
        check(unsafe { sys::TSAlpha2SetParams(self.raw(), alpha_m, alpha_f, gamma, beta) })
    }

    /// The parameters in use; during the first step these are [`AlphaParameters::START`].
    ///
    /// # Errors
    /// If the method is not TSALPHA2.
    pub fn alpha2_get_params(&self) -> Result<AlphaParameters> {
        let (mut alpha_m, mut alpha_f, mut gamma, mut beta) = (0.0, 0.0, 0.0, 0.0);
        // SAFETY: a live object, one number behind each pointer.
        check(unsafe {
            sys::TSAlpha2GetParams(
                self.raw(),
                &mut alpha_m,
                &mut alpha_f,
                &mut gamma,
                &mut beta,
            )
        })?;
        Ok(AlphaParameters {
            alpha_m,
            alpha_f,
            gamma,
            beta,
        })
    }

    /// Leaves the start to PETSc: it begins with an acceleration from two half steps, which is right since
    /// 3.22 ([`Ts::OWN_START_IS_OF_FIRST_ORDER`](super::Ts::OWN_START_IS_OF_FIRST_ORDER)), and which
    /// [`Alpha2State`](super::Alpha2State) cannot follow.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn alpha2_set_own_start(&mut self, own: bool) -> Result<()> {
        self.table()?.own_start.set(own);
        Ok(())
    }

    /// Tells the method that the solution has jumped: the next step is a start. For the hooks before
    /// and after a step.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn restart_step(&mut self) -> Result<()> {
        self.table()?.has_history.set(false);
        // SAFETY: a live object.
        check(unsafe { sys::TSRestartStep(self.raw()) })
    }

    /// Puts the caller's parameters back after a start.
    pub(super) fn restore_params(&mut self, table: &TsTable) -> Result<()> {
        match table.params_after_start.take() {
            Some(params) => self.alpha2_set_params(params),
            None => Ok(()),
        }
    }

    /// Sets the parameters for a start if this step is one: the first, one after a jump, or the
    /// repetition of one that failed.
    pub(super) fn begin_step(&mut self, table: &TsTable) -> Result<()> {
        let step = self.step_number()?;
        let failed_start = table.start_step.get() == Some(step);
        if table.has_history.replace(true) && !failed_start {
            return Ok(());
        }
        table.start_step.set(Some(step));
        if self.method()?.as_deref() == Some("alpha2") && !table.own_start.get() {
            table
                .params_after_start
                .set(Some(self.alpha2_get_params()?));
            self.alpha2_set_params(AlphaParameters::START)?;
        }
        Ok(())
    }

    /// PETSc starts anew whenever it solves from step 0.
    pub(super) fn prepare_start(&mut self, table: &TsTable) -> Result<()> {
        if self.step_number()? == 0 {
            table.has_history.set(false);
        }
        self.install_pre_step()
    }
}
