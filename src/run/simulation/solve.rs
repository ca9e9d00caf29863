//! What happens within one Newton solve: where it starts, how far its steps go, when it is done or
//! given up.

use petsc::{
    CallbackError, ConvergenceCheck, LineSearchInfo, SnesReason, SnesRef, Ts, TsRef, VectorRef,
};

use super::Simulation;
use crate::run::diagnosis::{Refusal, SolveWatch};
use crate::run::ledger::LEAST_FORCE;
use crate::run::newton::limited_length;
use crate::run::setup::defaults;

/// Largest imbalance and largest pull of a contact point after a converged solve, as a share of the
/// last punch force.
const BALANCE_SHARE: f64 = 3e-7;
/// A residual norm (mm) that rounding may keep a second iteration from lowering.
const ROUNDING: f64 = 1e-12;

impl Simulation {
    /// A small residual is not enough: its vertical sum is the imbalance of the tools' forces, which
    /// must be small against those; and a point about to open may pull within the tolerance.
    pub(super) fn balanced(
        &self,
        snes: &SnesRef,
        check: &ConvergenceCheck,
    ) -> Result<SnesReason, CallbackError> {
        self.watch_solve(snes, check)?;
        if check.default != SnesReason::ConvergedAbsolute {
            return Ok(check.default);
        }
        let low = |norms: &[f64]| norms.iter().all(|&norm| norm <= ROUNDING);
        if self
            .watch
            .borrow()
            .norms()
            .last_chunk::<2>()
            .is_some_and(|last| low(last))
        {
            return Ok(check.default);
        }
        let imbalance = self.system.vertical_sum(snes.function()?)?;
        let limit = BALANCE_SHARE * self.ledger.borrow().force().abs().max(LEAST_FORCE);
        let pull = self.system.strongest_pull(snes.solution()?)?;
        Ok(if imbalance.abs() <= limit && pull <= limit {
            check.default
        } else {
            SnesReason::Iterating
        })
    }

    fn watch_solve(&self, snes: &SnesRef, check: &ConvergenceCheck) -> Result<(), CallbackError> {
        let iteration = check.iteration.unsigned_abs() as usize;
        let mut watch = self.watch.borrow_mut();
        watch.residual(iteration, check.residual_norm);
        if SolveWatch::looks(iteration, self.most_iterations) {
            let t = self.attempted_time.get();
            watch.status(self.system.contact_status(t, snes.solution()?)?);
        }
        Ok(())
    }

    pub(super) fn before_solve(&self, ts: &mut TsRef, t: f64) -> Result<(), CallbackError> {
        if let Some(alpha) = &mut *self.alpha.borrow_mut() {
            alpha.attempt(ts)?;
        }
        self.attempted_time.set(t);
        let dt = ts.time_step()?;
        self.attempted.set(dt);
        self.inertia.reset();
        self.expected.set(self.expected_displacement(t, dt)?);
        Ok(())
    }

    /// Length of a Newton step: damped where the solve stagnates, and limited where it would carry the
    /// sheet much farther than the step in time does.
    pub(super) fn step_length(&self, info: &LineSearchInfo<'_>) -> Result<f64, CallbackError> {
        let iteration = info.iteration.unsigned_abs() as usize;
        let damped = self
            .damping
            .borrow_mut()
            .step_length(iteration, info.residual_norm);
        let correction = self.system.largest_displacement(info.step)?;
        let limited = limited_length(iteration, correction, self.expected.get());
        self.inertia.follow(limited);
        Ok(damped.min(limited))
    }

    /// The largest displacement that a step of length `dt` (ms) is expected to bring, mm: that of the
    /// punch, or of the sheet if it moved faster in the last step.
    pub(super) fn expected_displacement(&self, t: f64, dt: f64) -> Result<f64, CallbackError> {
        let punch = (self.motion.depth(t) - self.motion.depth(t - dt)).abs();
        let before = self.before.borrow();
        let Some((before, last_dt)) = before.as_ref() else {
            return Ok(punch);
        };
        let mut motion = self.accepted.borrow().to_owned()?;
        motion.axpy(-1.0, before)?;
        Ok(punch.max(self.system.largest_displacement(&motion)? * dt / last_dt))
    }

    /// Moves the start of a solve on along the last step: displacements only, with multipliers, gaps
    /// and so the active set as they were. Not after a refused solve, nor where the punch turns.
    pub(super) fn extrapolate(&self, guess: &mut VectorRef) -> Result<(), CallbackError> {
        let before = self.before.borrow();
        let Some((before, last_dt)) = before.as_ref() else {
            return Ok(());
        };
        if !self.extrapolate || !self.refusals.borrow().is_empty() {
            return Ok(());
        }
        let ratio = self.attempted.get() / last_dt;
        let accepted = self.accepted.borrow();
        let (now, before) = (accepted.read()?, before.read()?);
        let mut guess = guess.write()?;
        for i in 0..self.system.owned_displacements() {
            guess[i] = now[i] + ratio * (now[i] - before[i]);
        }
        Ok(())
    }

    /// Counts a solve, and ends the attempts where a shorter step must not be tried.
    pub(super) fn after_solve(&self, ts: &mut TsRef, t: f64) -> Result<(), CallbackError> {
        let snes: &SnesRef = ts.snes()?;
        let reason: SnesReason = snes.converged_reason()?;
        let iterations = snes.iteration_number()?.unsigned_abs();
        let mut counts = self.counts.get();
        counts.newton += u64::from(iterations);
        if reason.is_diverged() {
            counts.refused += 1;
            self.refuse(t, ts.time_step()?, reason, iterations);
        }
        self.counts.set(counts);
        // PETSc would go on shortening the step, or repeating the first one: stop it where it must not.
        let next = ts.time_step()? * defaults::CUT_BACK;
        let repeats = counts.steps == 0 && Ts::START_FORGETS_CUT_BACK;
        if reason.is_diverged() && (repeats || next < self.least_step) {
            ts.set_max_step_rejections(0)?;
        }
        Ok(())
    }

    /// Notes a solve that did not converge, and shows it. Collective.
    fn refuse(&self, t: f64, dt: f64, reason: SnesReason, iterations: u32) {
        let watch = self.watch.borrow();
        let refusal = Refusal::new(
            &self.system,
            &watch,
            (t, dt),
            reason,
            iterations,
            self.tolerance,
        );
        let mut recorder = self.recorder.borrow_mut();
        recorder.show(&format!("         refused: {refusal}\n"));
        self.refusals.borrow_mut().push(refusal);
    }

    pub(super) fn show_iteration(
        &self,
        snes: &SnesRef,
        iteration: i32,
        norm: f64,
    ) -> Result<(), CallbackError> {
        let now = self
            .system
            .contact_status(self.attempted_time.get(), snes.solution()?)?;
        let mut before = self.status.borrow_mut();
        let changed = if before.len() == now.len() {
            now.iter()
                .zip(before.iter())
                .filter(|(a, b)| a != b)
                .count()
        } else {
            0
        };
        let counts = self.system.count_over_ranks([
            now.iter().filter(|&&s| s > 0).count(),
            now.iter().filter(|&&s| s > 1).count(),
            changed,
        ]);
        let [active, slipping, changed] = counts;
        *before = now;
        self.recorder.borrow_mut().show(&format!(
            "    {iteration:>3}  residual {norm:.3e} mm  {active} points in contact, \
             {slipping} slip, {changed} changed\n"
        ));
        Ok(())
    }
}
