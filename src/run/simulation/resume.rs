//! How a simulation is written to a checkpoint, and how it goes on from one.

use std::path::PathBuf;
use std::time::Instant;

use petsc::{Alpha2State, CallbackError, Ts, TsReason, TsRef, Vector, VectorRef};

use super::Simulation;
use super::accepted::Before;
use super::interruption::Interruption;
use super::progress::Progress;
use crate::output::OutputError;
use crate::ranks::lowest_failing;
use crate::run::RunError;
use crate::run::checkpoint::{Resumed, RunState};
use crate::run::stop_watch::Order;
use crate::sensitivity::Sensitivity;
use crate::system::{MeshOrderError, Snapshot};

impl Simulation {
    /// After an accepted step that is not the last: writes a checkpoint if one is due, and ends the run if it is asked
    /// to.
    pub(super) fn save_or_stop(&self, ts: &mut TsRef) -> Result<(), CallbackError> {
        let comm = self.settings.system.comm();
        let progress = &mut *self.progress.borrow_mut();
        match progress.stop_watch.after_step(comm) {
            Order::GoOn => {}
            Order::Save => {
                self.save(progress)?;
            }
            Order::Stop(cause) => {
                progress.interruption = Some(Interruption {
                    cause,
                    time: progress.accepted.time,
                    checkpoint: self.save(progress)?,
                });
                ts.set_converged_reason(TsReason::ConvergedUser)?;
            }
        }
        Ok(())
    }

    /// Writes the last accepted state where the next step could not be solved, if checkpoints are wanted. Collective.
    pub(super) fn save_before_failure(
        &self,
        reason: TsReason,
    ) -> Result<Option<PathBuf>, RunError> {
        let progress = &mut *self.progress.borrow_mut();
        let given_up = reason.is_diverged() && progress.accepted.counts.steps > 0;
        if given_up && progress.stop_watch.saves_regularly() {
            Ok(Some(self.save(progress)?))
        } else {
            Ok(None)
        }
    }

    /// Writes the state after the last accepted step to a checkpoint. Collective.
    fn save(&self, progress: &mut Progress) -> Result<PathBuf, CallbackError> {
        let began = Instant::now();
        let state = self.state(progress)?;
        let path = progress
            .recorder
            .checkpoint(&self.settings.system, &state)?;
        progress.stop_watch.saved(began);
        Ok(path)
    }

    /// The state of the run; its arrays are complete on rank 0 only. Collective.
    fn state(&self, progress: &Progress) -> Result<RunState, CallbackError> {
        let (system, accepted) = (&self.settings.system, &progress.accepted);
        let nodes = 2 * system.problem().mesh.nodes.len();
        // Multipliers and gaps have no mass: their rates are numbers without a meaning.
        let of_nodes = |vector: &VectorRef| -> petsc::Result<Vec<f64>> {
            let mut values = system.in_mesh_order(vector)?;
            values.truncate(nodes);
            Ok(values)
        };
        let (velocity, acceleration, stage_acceleration) = match &accepted.rates {
            Some(rates) => {
                if lowest_failing(system.comm(), !rates.is_exact()).is_some() {
                    return Err(
                        "the acceleration of the time stepper could not be followed: \
                                no checkpoint of this run can be written"
                            .into(),
                    );
                }
                (
                    of_nodes(rates.velocity())?,
                    of_nodes(rates.acceleration())?,
                    of_nodes(rates.stage_acceleration())?,
                )
            }
            None => (Vec::new(), Vec::new(), Vec::new()),
        };
        let before = match &accepted.before {
            Some(before) => Some((system.in_mesh_order(&before.unknowns)?, before.dt)),
            None => None,
        };
        Ok(RunState {
            time: accepted.time,
            unknowns: system.in_mesh_order(&accepted.unknowns)?,
            before,
            velocity,
            acceleration,
            stage_acceleration,
            snapshot: Snapshot::of(system, &accepted.history),
            step_control: progress.control.memory(),
            ledger: accepted.ledger.memory(),
            counts: accepted.counts,
            springbacks: accepted.springbacks.clone(),
            spent: self.settings.spent.so_far(system.comm()),
            derivatives: progress
                .sensitivity
                .as_ref()
                .map(Sensitivity::keep)
                .transpose()?,
            file_rows: system.file_rows(),
            ..self.settings.identity.clone()
        })
    }

    /// Takes the state of a checkpoint over, the sheet's history excepted. Collective.
    pub(super) fn put_back(&self, ts: &mut Ts, resumed: &Resumed) -> Result<(), RunError> {
        let state = &resumed.state;
        let unknowns = self.vector(resumed, &state.unknowns)?;
        let before = match &state.before {
            Some((before, dt)) => Some(Before {
                unknowns: self.vector(resumed, before)?,
                dt: *dt,
            }),
            None => None,
        };
        let step = i32::try_from(state.counts.steps).map_err(CallbackError::from)?;
        let has_rates = self.progress.borrow().accepted.rates.is_some();
        let (rates, stage_acceleration) = if has_rates {
            let rate = |of_nodes: &[f64]| {
                let mut values = of_nodes.to_vec();
                values.resize(state.unknowns.len(), 0.0);
                self.vector(resumed, &values)
            };
            let (velocity, acceleration) = (rate(&state.velocity)?, rate(&state.acceleration)?);
            ts.alpha2_set_state(&unknowns, &velocity, &acceleration, state.time, step)?;
            let stage = rate(&state.stage_acceleration)?;
            (Some(Alpha2State::new(ts, &acceleration)?), Some(stage))
        } else {
            ts.set_solution(&unknowns)?;
            ts.set_time(state.time)?;
            ts.set_step_number(step)?;
            (None, None)
        };
        let Progress {
            accepted, control, ..
        } = &mut *self.progress.borrow_mut();
        control.recall(state.time, state.step_control);
        accepted.ledger.recall(state.ledger);
        accepted.time = state.time;
        accepted.unknowns = unknowns;
        accepted.before = before;
        accepted.rates = rates;
        accepted.stage_acceleration = stage_acceleration;
        accepted.counts = state.counts;
        accepted.springbacks.clone_from(&state.springbacks);
        Ok(())
    }

    fn vector(&self, resumed: &Resumed, values: &[f64]) -> Result<Vector, RunError> {
        let vector = self.settings.system.from_mesh_order(values);
        vector.map_err(|error| match error {
            MeshOrderError::Petsc(error) => error.into(),
            MeshOrderError::Size(size) => OutputError::Checkpoint {
                path: resumed.path.clone(),
                reason: size.to_string(),
            }
            .into(),
        })
    }
}
