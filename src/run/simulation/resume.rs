//! How a simulation is written to a checkpoint, and how it goes on from one.

use std::path::PathBuf;
use std::time::Instant;

use mpi::collective::SystemOperation;
use mpi::traits::CommunicatorCollectives;
use petsc::{Alpha2State, CallbackError, Ts, TsReason, TsRef, Vector, VectorRef};

use super::Simulation;
use crate::output::OutputError;
use crate::run::RunError;
use crate::run::checkpoint::{Resumed, RunState};
use crate::run::stop_watch::{Order, StopCause};

/// A run that was ended before its end.
#[derive(Clone, Debug)]
pub struct Interruption {
    /// Why.
    pub cause: StopCause,
    /// Time of the last accepted step, ms.
    pub time: f64,
    /// From where it can go on.
    pub checkpoint: PathBuf,
}

impl Interruption {
    /// Where and why, in one sentence.
    pub fn sentence(&self) -> String {
        format!("at t = {:.6} ms: {}", self.time, self.cause.sentence())
    }
}

impl Simulation {
    /// After an accepted step that is not the last: writes a checkpoint if one is due, and ends the run if it is asked
    /// to.
    pub(super) fn save_or_stop(&self, ts: &mut TsRef) -> Result<(), CallbackError> {
        let order = self.stop_watch.borrow_mut().after_step(self.system.comm());
        match order {
            Order::GoOn => {}
            Order::Save => {
                self.save()?;
            }
            Order::Stop(cause) => {
                let checkpoint = self.save()?;
                self.interruption.replace(Some(Interruption {
                    cause,
                    time: self.accepted_time.get(),
                    checkpoint,
                }));
                ts.set_converged_reason(TsReason::ConvergedUser)?;
            }
        }
        Ok(())
    }

    /// Writes the state after the last accepted step to a checkpoint. Collective.
    pub(super) fn save(&self) -> Result<PathBuf, CallbackError> {
        let began = Instant::now();
        let state = self.state()?;
        let path = self.recorder.borrow().checkpoint(&self.system, &state)?;
        self.stop_watch.borrow_mut().saved(began);
        Ok(path)
    }

    /// The state of the run; its arrays are complete on rank 0 only. Collective.
    fn state(&self) -> Result<RunState, CallbackError> {
        let system = &self.system;
        let nodes = 2 * system.local().problem().mesh.nodes.len();
        // Multipliers and gaps have no mass: their rates are numbers without a meaning.
        let of_nodes = |vector: &VectorRef| -> petsc::Result<Vec<f64>> {
            let mut values = system.in_mesh_order(vector)?;
            values.truncate(nodes);
            Ok(values)
        };
        let (velocity, acceleration) = match &*self.alpha.borrow() {
            Some(alpha) => {
                let (mine, mut all) = (alpha.is_exact(), false);
                let and = SystemOperation::logical_and();
                system.comm().all_reduce_into(&mine, &mut all, and);
                if !all {
                    return Err(
                        "the acceleration of the time stepper could not be followed: \
                                no checkpoint of this run can be written"
                            .into(),
                    );
                }
                (of_nodes(alpha.velocity())?, of_nodes(alpha.acceleration())?)
            }
            None => (Vec::new(), Vec::new()),
        };
        let before = match &*self.before.borrow() {
            Some((before, dt)) => Some((system.in_mesh_order(before)?, *dt)),
            None => None,
        };
        Ok(RunState {
            time: self.accepted_time.get(),
            unknowns: system.in_mesh_order(&self.accepted.borrow())?,
            before,
            velocity,
            acceleration,
            snapshot: system.snapshot(),
            step_control: self.control.borrow().memory(),
            ledger: self.ledger.borrow().memory(),
            counts: self.counts.get(),
            springbacks: self.springbacks.borrow().clone(),
            spent: self.spent.so_far(system.comm()),
            file_rows: system.file_rows(),
            ..self.identity.clone()
        })
    }

    /// Takes the state of a checkpoint over, the system's history excepted. Collective.
    pub(super) fn put_back(&self, ts: &mut Ts, resumed: &Resumed) -> Result<(), RunError> {
        let state = &resumed.state;
        let unknowns = self.vector(resumed, &state.unknowns)?;
        let before = match &state.before {
            Some((before, dt)) => Some((self.vector(resumed, before)?, *dt)),
            None => None,
        };
        let step = i32::try_from(state.counts.steps).map_err(CallbackError::from)?;
        if self.alpha.borrow().is_some() {
            let rate = |of_nodes: &[f64]| {
                let mut values = of_nodes.to_vec();
                values.resize(state.unknowns.len(), 0.0);
                self.vector(resumed, &values)
            };
            let (velocity, acceleration) = (rate(&state.velocity)?, rate(&state.acceleration)?);
            ts.alpha2_set_state(&unknowns, &velocity, &acceleration, state.time, step)?;
            self.alpha
                .replace(Some(Alpha2State::new(ts, &acceleration)?));
        } else {
            ts.set_solution(&unknowns)?;
            ts.set_time(state.time)?;
            ts.set_step_number(step)?;
        }
        self.accepted.replace(unknowns);
        self.accepted_time.set(state.time);
        self.before.replace(before);
        self.control
            .borrow_mut()
            .recall(state.time, state.step_control);
        self.ledger.borrow_mut().recall(state.ledger);
        self.counts.set(state.counts);
        self.springbacks.replace(state.springbacks.clone());
        Ok(())
    }

    fn vector(&self, resumed: &Resumed, values: &[f64]) -> Result<Vector, RunError> {
        let vector = self.system.from_mesh_order(values)?;
        vector.map_err(|reason| {
            let path = resumed.path.clone();
            OutputError::Checkpoint { path, reason }.into()
        })
    }
}
