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
    /// PETSc 3.18 gets wrong.
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

    /// Tells a multi-step method that the solution has jumped: the next step is a start. For the
    /// pre-step or post-step hook.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn restart_step(&mut self) -> Result<()> {
        self.table()?.starting.set(true);
        // SAFETY: a live object.
        check(unsafe { sys::TSRestartStep(self.raw()) })
    }

    /// Before each step: the right parameters for a start, or the caller's for any other step.
    pub(super) fn choose_params(&mut self, table: &TsTable) -> Result<()> {
        if self.method()?.as_deref() != Some("alpha2") {
            return Ok(());
        }
        if let Some(params) = table.params_after_start.take() {
            self.alpha2_set_params(params)?;
        }
        if table.starting.replace(false) {
            table
                .params_after_start
                .set(Some(self.alpha2_get_params()?));
            self.alpha2_set_params(AlphaParameters::START)?;
        }
        Ok(())
    }

    /// PETSc starts anew whenever it solves from step 0.
    pub(super) fn prepare_start(&mut self) -> Result<()> {
        if self.step_number()? == 0 {
            self.table()?.starting.set(true);
        }
        self.install_pre_step()
    }

    pub(super) fn end_start(&mut self) -> Result<()> {
        match self.table()?.params_after_start.take() {
            Some(params) => self.alpha2_set_params(params),
            None => Ok(()),
        }
    }
}
