//! What happens after an accepted step: the history is committed, the row and the fields are written, the next step is
//! planned.

use petsc::{CallbackError, TsReason, TsRef, VectorRef};

use super::Simulation;
use crate::output::StepRecord;
use crate::run::ledger::StepEffort;
use crate::run::springback::springback;

impl Simulation {
    /// Takes an accepted step, and plans the next one unless the run ends here.
    pub(super) fn after_step(&self, ts: &mut TsRef) -> Result<(), CallbackError> {
        if ts.converged_reason()?.is_diverged() {
            return Ok(());
        }
        if let Some(alpha) = &mut *self.alpha.borrow_mut() {
            alpha.accepted(ts)?;
        }
        let t = ts.time()?;
        let dt = t - self.accepted_time.get();
        let record = self.accept(ts, t, dt)?;
        let (next, ended) = {
            let mut control = self.control.borrow_mut();
            let next = control.accepted(t, dt, record.newton_iterations as usize);
            (next, control.is_at(t, control.end()))
        };
        let turning = self.control.borrow().is_at(t, self.motion.time_load);
        let label = match (turning, ended) {
            (true, _) => Some("full stroke"),
            (false, true) => Some("end"),
            (false, false) => None,
        };
        if self.recorder.borrow().fields_due(label.is_some()) {
            self.write_fields(t, ts.solution()?, label)?;
        }
        if label.is_some() {
            let found = springback(&self.system, t, ts.solution()?)?;
            self.springbacks.borrow_mut().extend(found);
        }
        if ended {
            ts.set_converged_reason(TsReason::ConvergedTime)?;
        } else {
            ts.set_time_step(next)?;
            self.save_or_stop(ts)?;
        }
        Ok(())
    }

    /// Commits the history at an accepted solution and writes its row.
    fn accept(&self, ts: &TsRef, t: f64, dt: f64) -> Result<StepRecord, CallbackError> {
        let solution = ts.solution()?;
        let velocity = self.velocity(ts)?;
        self.system.commit(t, solution)?;
        let measures = self.system.measures(t, solution, velocity)?;
        let refused = self.refusals.take().len();
        let effort = StepEffort {
            t,
            dt,
            depth: self.motion.depth(t),
            newton_iterations: ts.snes()?.iteration_number()?.unsigned_abs(),
            residual_norm: ts.snes()?.function_norm()?,
            refused_solves: u32::try_from(refused)?,
        };
        let record = self.ledger.borrow_mut().record(&effort, &measures);
        self.recorder.borrow_mut().step(&record)?;
        let mut counts = self.counts.get();
        counts.steps += 1;
        self.counts.set(counts);
        self.remember(solution, t, dt)?;
        Ok(record)
    }

    fn velocity<'a>(&self, ts: &'a TsRef) -> Result<Option<&'a VectorRef>, CallbackError> {
        if self.system.local().problem().density > 0.0 {
            Ok(Some(ts.solution2()?.1))
        } else {
            Ok(None)
        }
    }

    fn remember(&self, solution: &VectorRef, t: f64, dt: f64) -> Result<(), CallbackError> {
        let turned = self.control.borrow().is_at(t, self.motion.time_load);
        let before = self.accepted.replace(solution.to_owned()?);
        self.before
            .replace(if turned { None } else { Some((before, dt)) });
        self.accepted_time.set(t);
        Ok(())
    }

    pub(super) fn write_fields(
        &self,
        t: f64,
        solution: &VectorRef,
        label: Option<&str>,
    ) -> Result<(), CallbackError> {
        let values = self.system.local_values(solution)?;
        let nodes = self.system.node_samples(&self.sampler, t, &values)?;
        let mut recorder = self.recorder.borrow_mut();
        recorder.fields(t, &nodes, &self.system, &values)?;
        if let Some(label) = label {
            recorder.shape(label, t, &nodes, &self.system)?;
        }
        Ok(())
    }
}
