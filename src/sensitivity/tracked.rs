//! The derivatives of the state of the sheet by one parameter, from step to step.

use petsc::{AlphaParameters, Vector};

use super::Beside;
use crate::case::Parameter;
use crate::system::{History, System, Variation};

/// By one parameter.
pub(super) struct Tracked {
    pub parameter: Parameter,
    pub variation: Variation,
    /// Of the unknowns.
    pub unknowns: Vector,
    /// Of the nodes' velocities and accelerations; not used in statics.
    pub velocity: Vector,
    pub acceleration: Vector,
    pub history: History,
}

/// Length and parameters of a step of the generalized-alpha method, which make its acceleration
/// `a_1 = past a_0 + change (u_1 - u_0 - dt v_0)`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scheme {
    dt: f64,
    parameters: AlphaParameters,
}

impl Scheme {
    pub fn new(dt: f64, parameters: AlphaParameters) -> Self {
        Self { dt, parameters }
    }

    /// Of a displacement that changes by `change`, from this velocity and acceleration.
    fn end_acceleration(&self, change: f64, velocity: f64, acceleration: f64) -> f64 {
        let beta = self.parameters.beta;
        let past = -(1.0 - 2.0 * beta) / (2.0 * beta);
        past * acceleration + self.change() * (change - self.dt * velocity)
    }

    fn change(&self) -> f64 {
        1.0 / (self.dt * self.dt * self.parameters.beta)
    }

    /// Derivative of the acceleration in the equations by the unknowns, 1/ms².
    pub fn shift(&self) -> f64 {
        self.parameters.alpha_m * self.change()
    }
}

impl Tracked {
    /// At the start of a run: the sheet is at rest whatever the parameter is.
    pub fn start(system: &System, beside: Beside) -> petsc::Result<Self> {
        let parameter = beside.parameter;
        let variation = system.variation(beside.problems, beside.width, parameter.value);
        Ok(Self {
            parameter,
            history: variation.virgin_slope(system.local()),
            variation,
            unknowns: system.vector()?,
            velocity: system.vector()?,
            acceleration: system.vector()?,
        })
    }

    /// Derivative of the acceleration in the equations of a step to held unknowns, for the `count` displacements this rank
    /// owns.
    pub fn held_acceleration(
        &self,
        scheme: &Scheme,
        count: usize,
        out: &mut Vector,
    ) -> petsc::Result<()> {
        let u: &[f64] = &self.unknowns.read()?;
        let v: &[f64] = &self.velocity.read()?;
        let a: &[f64] = &self.acceleration.read()?;
        let out: &mut [f64] = &mut out.write()?;
        let alpha = scheme.parameters.alpha_m;
        for i in 0..count {
            let end = scheme.end_acceleration(-u[i], v[i], a[i]);
            out[i] = a[i] + alpha * (end - a[i]);
        }
        Ok(())
    }

    /// A guess at the derivatives of the unknowns at the end of a step, for the `count` displacements this rank owns: on at
    /// the velocity.
    pub fn guess(&self, scheme: Option<&Scheme>, count: usize) -> petsc::Result<Vector> {
        let mut guess = self.unknowns.to_owned()?;
        if let Some(scheme) = scheme {
            let v: &[f64] = &self.velocity.read()?;
            let guess: &mut [f64] = &mut guess.write()?;
            for i in 0..count {
                guess[i] += scheme.dt * v[i];
            }
        }
        Ok(guess)
    }

    /// Takes the derivatives of the unknowns at the end of a step over.
    pub fn move_on(
        &mut self,
        unknowns: Vector,
        scheme: Option<&Scheme>,
        count: usize,
    ) -> petsc::Result<()> {
        let before = std::mem::replace(&mut self.unknowns, unknowns);
        let Some(scheme) = scheme else {
            return Ok(());
        };
        let u: &[f64] = &self.unknowns.read()?;
        let before: &[f64] = &before.read()?;
        let v: &mut [f64] = &mut self.velocity.write()?;
        let a: &mut [f64] = &mut self.acceleration.write()?;
        let (dt, gamma) = (scheme.dt, scheme.parameters.gamma);
        for i in 0..count {
            let end = scheme.end_acceleration(u[i] - before[i], v[i], a[i]);
            v[i] += dt * ((1.0 - gamma) * a[i] + gamma * end);
            a[i] = end;
        }
        Ok(())
    }
}
