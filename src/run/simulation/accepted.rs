//! The run after its last accepted step.

use petsc::{Alpha2State, Vector, VectorRef};

use crate::run::ledger::{Counts, Ledger};
use crate::run::springback::Springback;
use crate::sensitivity::{AcceptedStep, Inertia};
use crate::system::{AcceptedState, History, System, SystemError, Work};
use crate::tool::PunchMotion;

/// Everything the next step depends on, but for the control of its length.
pub(in crate::run) struct Accepted {
    /// Time, ms.
    pub time: f64,
    pub unknowns: Vector,
    /// What the sheet remembers there.
    pub history: History,
    /// None at the start and where the punch turns.
    pub before: Option<Before>,
    /// Velocity and acceleration; none in statics.
    pub rates: Option<Alpha2State>,
    /// The acceleration in the equations of the last step; none in statics and at the start.
    pub stage_acceleration: Option<Vector>,
    pub ledger: Ledger,
    pub counts: Counts,
    pub springbacks: Vec<Springback>,
}

/// The unknowns before the last accepted step, and its length, ms.
pub(in crate::run) struct Before {
    pub unknowns: Vector,
    pub dt: f64,
}

impl Accepted {
    /// The start of a run.
    pub fn start(unknowns: Vector, history: History) -> Self {
        Self {
            time: 0.0,
            unknowns,
            history,
            before: None,
            rates: None,
            stage_acceleration: None,
            ledger: Ledger::default(),
            counts: Counts::default(),
            springbacks: Vec::new(),
        }
    }

    /// Moves on to the solution at time `t` after a step of length `dt` (ms); what was before is forgotten where the
    /// punch has turned.
    pub fn move_on(
        &mut self,
        solution: &VectorRef,
        t: f64,
        dt: f64,
        turned: bool,
    ) -> petsc::Result<()> {
        let unknowns = std::mem::replace(&mut self.unknowns, solution.to_owned()?);
        self.before = (!turned).then_some(Before { unknowns, dt });
        self.stage_acceleration = match &self.rates {
            Some(rates) => Some(rates.stage_acceleration().to_owned()?),
            None => None,
        };
        self.time = t;
        self.counts.steps += 1;
        Ok(())
    }

    /// Work of the step that has just led to the solution at time `t` (ms) with this history. The rates are those at its
    /// end. Collective.
    pub fn work_of_step(
        &self,
        system: &System,
        history: &History,
        t: f64,
        solution: &VectorRef,
    ) -> Result<Work, SystemError> {
        let mut rest = system.vector()?;
        rest.set_all(0.0)?;
        let from = AcceptedState {
            history: &self.history,
            t: self.time,
            // The multipliers of the first guess are no forces.
            u: if self.counts.steps == 0 {
                &rest
            } else {
                &self.unknowns
            },
            acceleration: self.stage_acceleration.as_deref(),
        };
        let to = AcceptedState {
            history,
            t,
            u: solution,
            acceleration: self.rates.as_ref().map(Alpha2State::stage_acceleration),
        };
        system.work(&from, &to)
    }

    /// The step that has just led to the solution at time `t` (ms) with this history, as the derivatives see it. The rates
    /// are those at its end.
    pub fn differentiable_step<'a>(
        &'a self,
        history: &'a History,
        t: f64,
        solution: &'a VectorRef,
    ) -> AcceptedStep<'a> {
        let inertia = self.rates.as_ref().map(|rates| {
            let (dt, parameters) = rates.last_step();
            Inertia {
                dt,
                parameters,
                stage_acceleration: rates.stage_acceleration(),
            }
        });
        AcceptedStep {
            before: &self.history,
            after: history,
            t,
            unknowns: solution,
            inertia,
        }
    }

    /// The largest displacement that a step of length `dt` (ms) to time `t` is expected to bring, mm: that of the
    /// punch, or of the sheet if it moved faster in the last step. Collective.
    pub fn expected_displacement(
        &self,
        system: &System,
        motion: &PunchMotion,
        t: f64,
        dt: f64,
    ) -> petsc::Result<f64> {
        let punch = (motion.depth(t) - motion.depth(t - dt)).abs();
        let Some(before) = &self.before else {
            return Ok(punch);
        };
        let mut moved = self.unknowns.to_owned()?;
        moved.axpy(-1.0, &before.unknowns)?;
        Ok(punch.max(system.largest_displacement(&moved)? * dt / before.dt))
    }

    /// Moves the first guess of a step of length `dt` (ms) on along the last step: its first `displacements` unknowns
    /// only, with multipliers, gaps and so the active set as they were.
    pub fn extrapolate(
        &self,
        dt: f64,
        displacements: usize,
        guess: &mut VectorRef,
    ) -> petsc::Result<()> {
        let Some(before) = &self.before else {
            return Ok(());
        };
        let ratio = dt / before.dt;
        let (now, before) = (self.unknowns.read()?, before.unknowns.read()?);
        let mut guess = guess.write()?;
        for i in 0..displacements {
            guess[i] = now[i] + ratio * (now[i] - before[i]);
        }
        Ok(())
    }
}
