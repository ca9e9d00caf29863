//! The state of TSALPHA2, all of it: PETSc shows displacement and velocity, and keeps the acceleration
//! to itself.

use super::{AlphaParameters, Ts, TsRef};
use crate::{
    TsReason, Vector, VectorRef,
    error::{Error, Result},
};

/// Displacement, velocity and acceleration of an integration by TSALPHA2 at its last accepted step.
///
/// The acceleration is computed a second time, by the operations of `TSAlpha_StageVecs` (PETSc 3.18)
/// in their order, so it has the very bits of PETSc's own. The velocity is computed with it, and
/// compared with the one PETSc shows: [`Alpha2State::is_exact`].
pub struct Alpha2State {
    u: Vector,
    v: Vector,
    a: Vector,
    /// The acceleration of the last step's equations.
    stage: Vector,
    dt: f64,
    params: AlphaParameters,
    exact: bool,
}

impl Alpha2State {
    /// From the present solution of an integration whose acceleration is `a`; that of a start is not
    /// used by the first step, so 0 will do there. Collective.
    ///
    /// # Errors
    /// If no solution is set or the layouts differ.
    pub fn new(ts: &TsRef, a: &VectorRef) -> Result<Self> {
        let (u, v) = ts.solution2()?;
        Ok(Self {
            u: u.to_owned()?,
            v: v.to_owned()?,
            a: a.to_owned()?,
            stage: a.to_owned()?,
            dt: 0.0,
            params: AlphaParameters::START,
            exact: true,
        })
    }

    /// Notes the attempt at a step. For the pre-stage hook: the last one counts.
    ///
    /// # Errors
    /// If the method is not TSALPHA2.
    pub fn attempt(&mut self, ts: &TsRef) -> Result<()> {
        self.dt = ts.time_step()?;
        self.params = ts.alpha2_get_params()?;
        Ok(())
    }

    /// Follows an accepted step. For the post-step hook, before it changes the solution. Collective.
    ///
    /// # Errors
    /// If PETSc fails.
    pub fn accepted(&mut self, ts: &TsRef) -> Result<()> {
        let AlphaParameters {
            alpha_m,
            gamma,
            beta,
            ..
        } = self.params;
        let dt = self.dt;
        let (u, v) = ts.solution2()?;
        let mut a = self.a.duplicate()?;
        a.waxpy(-1.0, &self.u, u)?;
        a.axpy(-dt, &self.v)?;
        let (by_past, by_change) = (-(1.0 - 2.0 * beta) / (2.0 * beta), 1.0 / (dt * dt * beta));
        a.axpby(by_past, by_change, &self.a)?;
        let mut computed = self.a.duplicate()?;
        computed.waxpy((1.0 - gamma) / gamma, &self.a, &a)?;
        computed.aypx(dt * gamma, &self.v)?;
        self.exact &= computed.read()?[..] == v.read()?[..];
        self.u.copy_from(u)?;
        self.v.copy_from(v)?;
        self.stage.waxpy(-1.0, &self.a, &a)?;
        self.stage.aypx(alpha_m, &self.a)?;
        self.a = a;
        Ok(())
    }

    /// Length and parameters of the last step.
    pub fn last_step(&self) -> (f64, AlphaParameters) {
        (self.dt, self.params)
    }

    /// Whether the velocity that belongs to the acceleration had PETSc's own bits in every step, on
    /// this rank.
    pub fn is_exact(&self) -> bool {
        self.exact
    }

    /// The velocity.
    pub fn velocity(&self) -> &VectorRef {
        &self.v
    }

    /// The acceleration with which the equations of the last step were solved, `a_0 + alpha_m (a_1 - a_0)`: in its
    /// bits where PETSc began the step with the acceleration known here, and but for rounding in a start.
    pub fn stage_acceleration(&self) -> &VectorRef {
        &self.stage
    }

    /// The acceleration.
    pub fn acceleration(&self) -> &VectorRef {
        &self.a
    }
}

impl Ts {
    /// Puts displacement, velocity and acceleration at `time`, after `step` steps, into TSALPHA2: the
    /// next step goes on from them as if the integration had come there by itself, to the last bit.
    /// Sets the step size to be set anew. Collective.
    ///
    /// PETSc gives no access to the acceleration, so a step is made that ends with it: from rest, of
    /// length 1, with the parameters of a start, under which the acceleration at its end is twice the
    /// displacement. Its solves answer half the acceleration at once. Halving and doubling are exact
    /// unless an entry is subnormal. Closures are not called; PETSc's own monitors see the step.
    /// An unknown with bounds gets the part of its acceleration that its bounds allow.
    ///
    /// # Errors
    /// If the method is not TSALPHA2, no solution was set before, or the layouts differ.
    pub fn alpha2_set_state(
        &mut self,
        u: &VectorRef,
        v: &VectorRef,
        a: &VectorRef,
        time: f64,
        step: i32,
    ) -> Result<()> {
        let (max_time, max_steps) = (self.max_time()?, self.max_steps()?);
        self.alpha2_get_params()?;
        let rest = u.duplicate()?;
        self.set_solution2(&rest, &rest)?;
        self.set_time(0.0)?;
        self.set_step_number(0)?;
        self.set_time_step(1.0)?;
        self.set_max_time(10.0)?;
        self.set_max_steps(1)?;
        let mut half = a.to_owned()?;
        half.scale(0.5)?;
        let table = self.table()?;
        self.snes_mut()?.answer_at_once(Some(half))?;
        table.placing.set(true);
        let solved = self.solve();
        table.placing.set(false);
        self.snes_mut()?.answer_at_once(None)?;
        if solved? != TsReason::ConvergedSteps {
            return Err(Error::usage(
                "the nonlinear solver's options do not let a state be put into TSALPHA2",
            ));
        }
        self.replace_solution2(u, v)?;
        self.set_time(time)?;
        self.set_step_number(step)?;
        self.set_max_time(max_time)?;
        self.set_max_steps(max_steps)
    }
}
