//! What happens around and within one Newton solve: where it starts, when it has converged, and what becomes of one that
//! has not.

use petsc::{
    CallbackError, ConvergenceCheck, LineSearchInfo, SnesReason, SnesRef, Ts, TsRef, VectorRef,
};

use super::Simulation;
use super::attempt::Attempt;
use crate::ranks;
use crate::run::diagnosis::{Refusal, SolveWatch};
use crate::run::ledger::LEAST_FORCE;
use crate::run::setup::defaults;

/// Largest imbalance and largest tensile force of a contact point after a converged solve, as a share of the
/// last punch force.
const BALANCE_SHARE: f64 = 3e-7;
/// A residual norm (mm) that rounding may keep a second iteration from lowering.
const ROUNDING: f64 = 1e-12;

impl Simulation {
    /// A small residual is not enough: its vertical sum is the imbalance of the tools' forces, which
    /// must be small against those; and the force of a point about to open may be tensile within the tolerance.
    pub(super) fn balanced(
        &self,
        snes: &SnesRef,
        check: &ConvergenceCheck,
    ) -> Result<SnesReason, CallbackError> {
        self.watch_solve(snes, check)?;
        if check.default != SnesReason::ConvergedAbsolute {
            return Ok(check.default);
        }
        let progress = &*self.progress.borrow();
        let low = |norms: &[f64; 2]| norms.iter().all(|&norm| norm <= ROUNDING);
        if progress.attempt.watch.norms().last_chunk().is_some_and(low) {
            return Ok(check.default);
        }
        let system = &self.settings.system;
        let imbalance = system.vertical_sum(snes.function()?)?;
        let force = progress.accepted.ledger.force();
        let limit = BALANCE_SHARE * force.abs().max(LEAST_FORCE);
        let tensile = system.largest_tensile_force(snes.solution()?)?;
        Ok(if imbalance.abs() <= limit && tensile <= limit {
            check.default
        } else {
            SnesReason::Iterating
        })
    }

    fn watch_solve(&self, snes: &SnesRef, check: &ConvergenceCheck) -> Result<(), CallbackError> {
        let iteration = check.iteration.unsigned_abs() as usize;
        let progress = &mut *self.progress.borrow_mut();
        let Attempt { watch, time, .. } = &mut progress.attempt;
        watch.residual(iteration, check.residual_norm);
        if SolveWatch::looks(iteration, self.settings.most_iterations) {
            let (system, history) = (&self.settings.system, &progress.accepted.history);
            watch.states(system.contact_states(history, *time, snes.solution()?)?);
        }
        Ok(())
    }

    pub(super) fn before_solve(&self, ts: &mut TsRef, t: f64) -> Result<(), CallbackError> {
        let dt = ts.time_step()?;
        let progress = &mut *self.progress.borrow_mut();
        if let Some(rates) = &mut progress.accepted.rates {
            rates.attempt(ts)?;
        }
        let (system, motion) = (&self.settings.system, &self.settings.motion);
        let accepted = &progress.accepted;
        let expected = accepted.expected_displacement(system, motion, t, dt)?;
        progress.attempt = Attempt::new(t, dt, expected);
        Ok(())
    }

    /// Length of a Newton step.
    pub(super) fn step_length(&self, info: &LineSearchInfo<'_>) -> Result<f64, CallbackError> {
        let iteration = info.iteration.unsigned_abs() as usize;
        let correction = self.settings.system.largest_displacement(info.step)?;
        let attempt = &mut self.progress.borrow_mut().attempt;
        Ok(attempt.step_length(iteration, info.residual_norm, correction))
    }

    /// Where a solve starts: not beyond the last accepted state after a refused solve.
    pub(super) fn first_guess(&self, guess: &mut VectorRef) -> Result<(), CallbackError> {
        let progress = &*self.progress.borrow();
        if self.settings.extrapolate && progress.refusals.is_empty() {
            let Attempt { dt, time, .. } = progress.attempt;
            let system = &self.settings.system;
            progress.accepted.extrapolate(system, dt, guess)?;
            progress.accepted.expect_contact(system, dt, time, guess)?;
        }
        Ok(())
    }

    /// Counts a solve, and ends the attempts where a shorter step must not be tried.
    pub(super) fn after_solve(&self, ts: &mut TsRef, t: f64) -> Result<(), CallbackError> {
        let snes: &SnesRef = ts.snes()?;
        let reason: SnesReason = snes.converged_reason()?;
        let iterations = snes.iteration_number()?.unsigned_abs();
        let dt = ts.time_step()?;
        let refused = reason.is_diverged();
        let started = {
            let counts = &mut self.progress.borrow_mut().accepted.counts;
            counts.newton += u64::from(iterations);
            counts.refused += u64::from(refused);
            counts.steps > 0
        };
        if refused {
            self.refuse(t, dt, reason, iterations);
        }
        // PETSc would go on shortening the step, or repeating the first one: stop it where it must not.
        let next = dt * defaults::CUT_BACK;
        let repeats = !started && Ts::START_FORGETS_CUT_BACK;
        if refused && (repeats || next < self.settings.least_step) {
            ts.set_max_step_rejections(0)?;
        }
        Ok(())
    }

    /// Notes a solve that did not converge, and shows it. Collective.
    fn refuse(&self, t: f64, dt: f64, reason: SnesReason, iterations: u32) {
        let progress = &mut *self.progress.borrow_mut();
        let refusal = Refusal::new(
            &self.settings.system,
            &progress.attempt.watch,
            (t, dt),
            reason,
            iterations,
            self.settings.tolerance,
            progress.attempt.failure.take(),
        );
        let text = format!("         refused: {refusal}\n");
        progress.recorder.show(&text);
        progress.refusals.push(refusal);
    }

    pub(super) fn show_iteration(
        &self,
        snes: &SnesRef,
        iteration: i32,
        norm: f64,
    ) -> Result<(), CallbackError> {
        let system = &self.settings.system;
        let progress = &mut *self.progress.borrow_mut();
        let (history, time) = (&progress.accepted.history, progress.attempt.time);
        let now = system.contact_states(history, time, snes.solution()?)?;
        let before = std::mem::replace(&mut progress.shown, now);
        let now = &progress.shown;
        let changed = if before.len() == now.len() {
            now.iter().zip(&before).filter(|(a, b)| a != b).count()
        } else {
            0
        };
        let mine = [
            now.iter().filter(|state| state.is_closed()).count(),
            now.iter().filter(|state| state.slips()).count(),
            changed,
        ];
        let [active, slipping, changed] =
            ranks::sums(system.comm(), mine.map(|count| count as u64));
        progress.recorder.show(&format!(
            "    {iteration:>3}  residual {norm:.3e} mm  {active} points in contact, \
             {slipping} slip, {changed} changed\n"
        ));
        Ok(())
    }
}
