//! The time stepper: the equations it solves, what it calls around each solve and step, and how it is started.

use std::rc::Rc;

use petsc::{CallbackError, Evaluation, MatrixRef, Ts, TsReason, VectorRef};

use super::Simulation;
use crate::case::Dynamics;
use crate::run::RunError;
use crate::run::setup::{LinearSolve, defaults};
use crate::system::EvaluationError;

impl Simulation {
    /// Poses the equations and the state to start from.
    pub(super) fn set_problem(
        self: &Rc<Self>,
        ts: &mut Ts,
        linear: &Rc<LinearSolve>,
    ) -> Result<(), RunError> {
        let matrix = linear.matrix()?;
        let start = &self.progress.borrow().accepted.unknowns.to_owned()?;
        let (for_residual, for_jacobian) = (Rc::clone(self), Rc::clone(self));
        let (linear, with_residual) = (Rc::clone(linear), Rc::clone(linear));
        match self.settings.dynamics {
            Dynamics::Slow => {
                ts.set_second_order(
                    start,
                    matrix,
                    move |t, u, _, a, out| {
                        for_residual.residual(&with_residual, t, (u, Some(a)), out)
                    },
                    move |t, u, _, _, _, shift, out| {
                        for_jacobian.jacobian(&linear, t, u, shift, out)
                    },
                )?;
                let mut still = self.settings.system.vector()?;
                still.set_all(0.0)?;
                ts.set_solution2(start, &still)?;
                // Radius 0 puts contact, stress and inertia at the end of the step, and damps the
                // frequencies the step cannot resolve within one step.
                ts.alpha2_set_radius(0.0)?;
            }
            Dynamics::None => {
                ts.set_implicit(
                    start,
                    matrix,
                    move |t, u, _, out| for_residual.residual(&with_residual, t, (u, None), out),
                    move |t, u, _, _, out| for_jacobian.jacobian(&linear, t, u, 0.0, out),
                )?;
                ts.set_solution(start)?;
            }
        }
        Ok(())
    }

    /// The residual from the last accepted state; the attempt keeps which element could not be evaluated.
    fn residual(
        &self,
        linear: &LinearSolve,
        t: f64,
        at: (&VectorRef, Option<&VectorRef>),
        out: &mut VectorRef,
    ) -> Evaluation {
        let progress = &mut *self.progress.borrow_mut();
        let history = &progress.accepted.history;
        let expected = progress.attempt.goes_on(self.settings.tolerance);
        let evaluated = linear.residual(history, t, at, expected, out);
        if let Err(EvaluationError::Element(failure)) = &evaluated {
            progress.attempt.failure = Some(failure.clone());
        }
        Ok(evaluated?)
    }

    fn jacobian(
        &self,
        linear: &LinearSolve,
        t: f64,
        u: &VectorRef,
        shift: f64,
        out: &mut MatrixRef,
    ) -> Result<(), CallbackError> {
        let progress = &*self.progress.borrow();
        let shift = progress.attempt.inertia() * shift;
        linear.evaluate(&progress.accepted.history, t, u, shift, out)
    }

    /// Sets what it calls.
    pub(super) fn set_hooks(self: &Rc<Self>, ts: &mut Ts) -> Result<(), RunError> {
        let this = Rc::clone(self);
        ts.set_pre_stage(move |ts, t| this.before_solve(ts, t))?;
        let this = Rc::clone(self);
        ts.set_post_stage(move |ts, t, _| this.after_solve(ts, t))?;
        let this = Rc::clone(self);
        ts.set_post_step(move |ts| this.after_step(ts))?;
        let snes = ts.snes_mut()?;
        let this = Rc::clone(self);
        snes.set_convergence_test(move |snes, check| this.balanced(snes, check))?;
        if self.settings.show_iterations {
            let this = Rc::clone(self);
            snes.set_monitor(move |snes, iteration, norm| {
                this.show_iteration(snes, iteration, norm)
            })?;
        }
        let this = Rc::clone(self);
        snes.set_initial_guess(move |guess| this.first_guess(guess))?;
        let this = Rc::clone(self);
        snes.set_shell_line_search(move |info| this.step_length(info))?;
        Ok(())
    }

    /// Lets PETSc step to the end. Its second-order stepper begins with two half steps, and when they are
    /// refused before PETSc 3.21 it repeats them at the same length: the first step is shortened here.
    pub(super) fn solve(&self, ts: &mut Ts) -> Result<TsReason, RunError> {
        let mut dt = self.progress.borrow().control.planned();
        loop {
            let reason = ts.solve()?;
            dt *= defaults::CUT_BACK;
            let steps = self.progress.borrow().accepted.counts.steps;
            let repeats = steps == 0 && Ts::START_FORGETS_CUT_BACK;
            if !reason.is_diverged() || !repeats || dt < self.settings.least_step {
                return Ok(reason);
            }
            ts.set_time_step(dt)?;
            ts.set_max_step_rejections(defaults::MOST_REJECTIONS)?;
        }
    }
}
