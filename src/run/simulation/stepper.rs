//! The time stepper: the equations it is given, what it calls around each solve and step, and how it is started.

use std::rc::Rc;

use petsc::{CallbackError, Matrix, Ts, TsReason};

use super::Simulation;
use crate::case::Dynamics;
use crate::run::RunError;
use crate::run::setup::defaults;

impl Simulation {
    /// Gives it the equations and the state to start from.
    pub(super) fn set_problem(
        self: &Rc<Self>,
        ts: &mut Ts,
        dynamics: Dynamics,
        matrix: Matrix,
    ) -> Result<(), RunError> {
        let start = self.accepted.borrow();
        let (for_residual, for_jacobian) = (Rc::clone(&self.system), Rc::clone(&self.system));
        let inertia = Rc::clone(&self.inertia);
        match dynamics {
            Dynamics::Slow => {
                ts.set_second_order(
                    &start,
                    matrix,
                    move |t, u, _, a, out| for_residual.residual(t, u, Some(a), out),
                    move |t, u, _, _, _, shift, out| {
                        for_jacobian
                            .jacobian(t, u, inertia.multiple() * shift, out)
                            .map_err(not_evaluated)
                    },
                )?;
                let mut still = self.system.vector()?;
                still.set_all(0.0)?;
                ts.set_solution2(&start, &still)?;
                // Radius 0 puts contact, stress and inertia at the end of the step, and damps the
                // frequencies the step cannot resolve within one step.
                ts.alpha2_set_radius(0.0)?;
            }
            Dynamics::None => {
                ts.set_implicit(
                    &start,
                    matrix,
                    move |t, u, _, out| for_residual.residual(t, u, None, out),
                    move |t, u, _, _, out| {
                        for_jacobian.jacobian(t, u, 0.0, out).map_err(not_evaluated)
                    },
                )?;
                ts.set_solution(&start)?;
            }
        }
        Ok(())
    }

    /// Tells it what to call.
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
        if self.show_iterations {
            let this = Rc::clone(self);
            snes.set_monitor(move |snes, iteration, norm| {
                this.show_iteration(snes, iteration, norm)
            })?;
        }
        let this = Rc::clone(self);
        snes.set_initial_guess(move |guess| this.extrapolate(guess))?;
        let this = Rc::clone(self);
        snes.set_shell_line_search(move |info| this.step_length(info))?;
        Ok(())
    }

    /// Lets PETSc step to the end. Its second-order stepper begins with two half steps, and when they are
    /// refused before PETSc 3.21 it repeats them at the same length: the first step is shortened here.
    pub(super) fn solve(&self, ts: &mut Ts) -> Result<TsReason, RunError> {
        let mut dt = self.control.borrow().planned();
        loop {
            let reason = ts.solve()?;
            dt *= defaults::CUT_BACK;
            let repeats = self.counts.get().steps == 0 && Ts::START_FORGETS_CUT_BACK;
            if !reason.is_diverged() || !repeats || dt < self.least_step {
                return Ok(reason);
            }
            ts.set_time_step(dt)?;
            ts.set_max_step_rejections(defaults::MOST_REJECTIONS)?;
        }
    }
}

/// The tangent is asked for where the residual was evaluated before: it cannot fail alone.
pub(in crate::run) fn not_evaluated(failure: petsc::Failure) -> CallbackError {
    match failure {
        petsc::Failure::Fatal(error) => error,
        petsc::Failure::Domain => "the tangent cannot be evaluated where the residual was".into(),
    }
}
