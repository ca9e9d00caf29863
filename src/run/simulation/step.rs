//! What happens after an accepted step: the history moves on, the row and the fields are written, the next step is
//! planned.

use petsc::{CallbackError, TsReason, TsRef, VectorRef};

use super::Simulation;
use crate::output::StepRecord;
use crate::run::ledger::StepEffort;
use crate::run::springback::ReleasedSheet;
use crate::system::Rates;

impl Simulation {
    /// Takes an accepted step, and plans the next one unless the run ends here.
    pub(super) fn after_step(&self, ts: &mut TsRef) -> Result<(), CallbackError> {
        if ts.converged_reason()?.is_diverged() {
            return Ok(());
        }
        let t = ts.time()?;
        let dt = t - self.progress.borrow().accepted.time;
        let record = self.accept(ts, t, dt)?;
        let (next, label, fields_due) = {
            let progress = &mut *self.progress.borrow_mut();
            let control = &mut progress.control;
            let next = control.accepted(t, dt, record.newton_iterations as usize);
            let ended = control.is_at(t, control.end());
            let label = if control.is_at(t, self.settings.motion.time_load) {
                Some("full stroke")
            } else {
                ended.then_some("end")
            };
            let next = (!ended).then_some(next);
            (next, label, progress.recorder.fields_due(label.is_some()))
        };
        if fields_due {
            self.write_fields(t, ts.solution()?, label)?;
        }
        if label.is_some() {
            self.release_tools(t, ts.solution()?)?;
        }
        match next {
            Some(next) => {
                ts.set_time_step(next)?;
                self.save_or_stop(ts)
            }
            None => Ok(ts.set_converged_reason(TsReason::ConvergedTime)?),
        }
    }

    /// Moves the accepted state on to the solution of the time stepper, and writes its row.
    fn accept(&self, ts: &TsRef, t: f64, dt: f64) -> Result<StepRecord, CallbackError> {
        let (solution, system) = (ts.solution()?, &self.settings.system);
        let progress = &mut *self.progress.borrow_mut();
        let accepted = &mut progress.accepted;
        let history = system.advance(&accepted.history, t, solution)?;
        if let Some(rates) = &mut accepted.rates {
            rates.accepted(ts)?;
        }
        let work = accepted.work_of_step(system, &history, t, solution)?;
        let slopes = match &mut progress.sensitivity {
            Some(sensitivity) => {
                let step = accepted.differentiable_step(&history, t, solution);
                Some(sensitivity.step(&step)?)
            }
            None => None,
        };
        accepted.history = history;
        let measures = match &accepted.rates {
            Some(rates) => {
                let rates = Rates {
                    velocity: rates.velocity(),
                    acceleration: rates.stage_acceleration(),
                };
                system.measures(&accepted.history, t, solution, Some(rates))?
            }
            None => system.measures(&accepted.history, t, solution, None)?,
        };
        let refused = std::mem::take(&mut progress.refusals).len();
        let effort = StepEffort {
            t,
            dt,
            depth: self.settings.motion.depth(t),
            newton_iterations: ts.snes()?.iteration_number()?.unsigned_abs(),
            residual_norm: ts.snes()?.function_norm()?,
            refused_solves: u32::try_from(refused)?,
        };
        let record = accepted.ledger.record(&effort, &measures, &work);
        progress.recorder.step(&record, system.comm())?;
        if let Some(slopes) = slopes {
            let recorder = &mut progress.recorder;
            recorder.derivatives_of_step(&record, slopes, system.comm())?;
        }
        let turned = progress.control.is_at(t, self.settings.motion.time_load);
        accepted.move_on(solution, t, dt, turned)?;
        Ok(record)
    }

    /// Finds out to where the sheet would spring back from here.
    fn release_tools(&self, t: f64, solution: &VectorRef) -> Result<(), CallbackError> {
        let mut sheet = {
            let history = &self.progress.borrow().accepted.history;
            ReleasedSheet::new(&self.settings.system, history, t, solution)?
        };
        let found = sheet.spring_back()?;
        let progress = &mut *self.progress.borrow_mut();
        if let (Some(_), Some(sensitivity)) = (&found, &mut progress.sensitivity) {
            sheet.differentiate(sensitivity)?;
        }
        progress.accepted.springbacks.extend(found);
        Ok(())
    }

    pub(super) fn write_fields(
        &self,
        t: f64,
        solution: &VectorRef,
        label: Option<&str>,
    ) -> Result<(), CallbackError> {
        let system = &self.settings.system;
        let progress = &mut *self.progress.borrow_mut();
        let (history, recorder) = (&progress.accepted.history, &mut progress.recorder);
        let values = system.local_values(solution)?;
        let nodes = system.node_samples(history, t, &values)?;
        let points = system.local().contact_points(history, t, &values);
        recorder.fields(t, &nodes, &points)?;
        if let Some(label) = label {
            recorder.shape(label, t, &nodes, system)?;
        }
        Ok(())
    }
}
