//! One simulation: PETSc's time stepper with our residual, and what happens around each step.

mod resume;
mod solve;

use std::cell::{Cell, RefCell};
use std::path::PathBuf;
use std::rc::Rc;

use petsc::{
    Alpha2State, CallbackError, Matrix, SnesReason, SnesRef, Ts, TsReason, TsRef, Vector, VectorRef,
};

use super::RunError;
use super::checkpoint::{Resumed, RunState, hardening_checksum};
use super::diagnosis::{Refusal, SolveWatch};
use super::ledger::{Ledger, StepEffort};
use super::newton::{Damping, TangentInertia};
use super::recorder::Recorder;
use super::setup::{LinearSolve, defaults};
use super::spent::Spent;
use super::springback::{Springback, springback};
use super::step_size::StepControl;
use super::stop_watch::StopWatch;
use crate::case::{Case, Dynamics};
use crate::output::StepRecord;
use crate::system::{FieldSampler, System};
use crate::tool::PunchMotion;

pub use resume::Interruption;

/// What the hooks of the time stepper share.
pub(super) struct Simulation {
    system: Rc<System>,
    sampler: FieldSampler,
    recorder: RefCell<Recorder>,
    control: RefCell<StepControl>,
    ledger: RefCell<Ledger>,
    damping: RefCell<Damping>,
    inertia: Rc<TangentInertia>,
    watch: RefCell<SolveWatch>,
    /// Absolute tolerance on the residual norm, mm, and most iterations of a solve.
    tolerance: f64,
    most_iterations: usize,
    /// Solution before the last accepted step, and the length of that step (ms); none at the start
    /// and where the punch turns.
    before: RefCell<Option<(Vector, f64)>>,
    /// The last accepted solution.
    accepted: RefCell<Vector>,
    accepted_time: Cell<f64>,
    extrapolate: bool,
    show_iterations: bool,
    /// Contact status of this rank's points at the last iteration shown.
    status: RefCell<Vec<u8>>,
    /// Length of the step being tried, ms.
    attempted: Cell<f64>,
    /// Time it is to reach, ms.
    attempted_time: Cell<f64>,
    /// Largest displacement expected of it, mm.
    expected: Cell<f64>,
    least_step: f64,
    motion: PunchMotion,
    /// Solves of the present step so far.
    refusals: RefCell<Vec<Refusal>>,
    counts: Cell<Counts>,
    springbacks: RefCell<Vec<Springback>>,
    /// Velocity and acceleration; none in statics.
    alpha: RefCell<Option<Alpha2State>>,
    stop_watch: RefCell<StopWatch>,
    spent: Spent,
    /// What a checkpoint says about the case it belongs to.
    identity: RunState,
    interruption: RefCell<Option<Interruption>>,
}

/// Work done over the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Accepted steps.
    pub steps: u64,
    /// Solves refused.
    pub refused: u64,
    /// Newton iterations of all solves; each is one linear solve.
    pub newton: u64,
}

/// How a simulation ended.
pub(super) struct Finish {
    pub reason: TsReason,
    pub counts: Counts,
    /// Why the solves of the last step were refused, if it never was accepted.
    pub refusals: Vec<Refusal>,
    pub time: f64,
    pub springbacks: Vec<Springback>,
    pub interruption: Option<Interruption>,
    /// The state before a step that could not be solved.
    pub checkpoint: Option<PathBuf>,
    /// PETSc's direct solver in use.
    pub factor_solver: Option<String>,
}

impl Simulation {
    pub(super) fn new(
        case: &Case,
        system: Rc<System>,
        recorder: Recorder,
        landmarks: Vec<f64>,
        stop_watch: StopWatch,
        spent: Spent,
    ) -> Result<Self, RunError> {
        let stepping = &case.stepping;
        let accepted = system.initial_unknowns()?;
        let sampler = system.local().field_sampler();
        Ok(Self {
            sampler,
            recorder: RefCell::new(recorder),
            control: RefCell::new(StepControl::new(
                stepping.dt_initial,
                stepping.dt_max,
                landmarks,
            )),
            ledger: RefCell::default(),
            damping: RefCell::default(),
            inertia: Rc::new(TangentInertia::own()),
            watch: RefCell::default(),
            tolerance: stepping.newton_tolerance,
            most_iterations: stepping.newton_max_iterations,
            before: RefCell::new(None),
            accepted: RefCell::new(accepted),
            accepted_time: Cell::new(0.0),
            extrapolate: stepping.extrapolate,
            show_iterations: case.output.iterations,
            status: RefCell::default(),
            attempted: Cell::new(0.0),
            attempted_time: Cell::new(0.0),
            expected: Cell::new(0.0),
            least_step: stepping.dt_min,
            motion: case.loading.motion(),
            refusals: RefCell::default(),
            counts: Cell::default(),
            springbacks: RefCell::default(),
            alpha: RefCell::new(None),
            stop_watch: RefCell::new(stop_watch),
            spent,
            identity: RunState {
                options: case
                    .options()
                    .into_iter()
                    .map(|(name, value)| (name.to_owned(), value))
                    .collect(),
                hardening: hardening_checksum(case),
                revision: env!("SSNP155_REVISION").to_owned(),
                ..RunState::default()
            },
            interruption: RefCell::new(None),
            system,
        })
    }

    /// Runs from the start or from a checkpoint to the end of the motion, until a step cannot be solved, or until it is
    /// asked to end. Collective.
    pub(super) fn run(
        self: &Rc<Self>,
        case: &Case,
        resumed: Option<&Resumed>,
    ) -> Result<Finish, RunError> {
        defaults::set(case)?;
        let mut ts = Ts::new(self.system.comm())?;
        let linear = LinearSolve::chosen(&self.system)?;
        self.set_problem(&mut ts, case.loading.dynamics, linear.matrix(&self.system)?)?;
        self.set_hooks(&mut ts)?;
        let (lower, upper) = self.system.bounds()?;
        ts.snes_mut()?.set_type("vinewtonrsls")?;
        linear.install(ts.snes_mut()?)?;
        ts.set_from_options()?;
        ts.snes_mut()?.set_variable_bounds(&lower, &upper)?;
        ts.set_max_time(self.control.borrow().end())?;
        if case.loading.dynamics == Dynamics::Slow {
            let at_rest = self.system.vector()?;
            self.alpha.replace(Some(Alpha2State::new(&ts, &at_rest)?));
        }
        match resumed {
            Some(resumed) => self.put_back(&mut ts, resumed)?,
            None => self.write_fields(0.0, &self.accepted.borrow(), None)?,
        }
        ts.set_time_step(self.control.borrow().planned())?;
        self.recorder.borrow_mut().begin(resumed);
        let reason = self.solve(&mut ts)?;
        let given_up = reason.is_diverged() && self.counts.get().steps > 0;
        let checkpoint = if given_up && self.stop_watch.borrow().saves_regularly() {
            Some(self.save()?)
        } else {
            None
        };
        let factor_solver = linear.factor_solver(ts.snes()?)?;
        Ok(Finish {
            reason,
            counts: self.counts.get(),
            refusals: self.refusals.take(),
            time: self.accepted_time.get(),
            springbacks: self.springbacks.take(),
            interruption: self.interruption.take(),
            checkpoint,
            factor_solver,
        })
    }

    /// Lets PETSc step to the end. Its second-order stepper begins with two half steps, and when they are
    /// refused it repeats them at the same length (`TSAlpha_Restart` puts the old one back, PETSc 3.18):
    /// the first step is shortened here.
    fn solve(&self, ts: &mut Ts) -> Result<TsReason, RunError> {
        let mut dt = self.control.borrow().planned();
        loop {
            let reason = ts.solve()?;
            dt *= defaults::CUT_BACK;
            if !reason.is_diverged() || self.counts.get().steps > 0 || dt < self.least_step {
                return Ok(reason);
            }
            ts.set_time_step(dt)?;
            ts.set_max_step_rejections(defaults::MOST_REJECTIONS)?;
        }
    }

    /// Gives the recorder back when the time stepper is gone.
    pub(super) fn into_recorder(self) -> Recorder {
        self.recorder.into_inner()
    }

    fn set_problem(
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

    fn set_hooks(self: &Rc<Self>, ts: &mut Ts) -> Result<(), RunError> {
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

    fn after_solve(&self, ts: &mut TsRef, t: f64) -> Result<(), CallbackError> {
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
        if reason.is_diverged() && (counts.steps == 0 || next < self.least_step) {
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

    fn after_step(&self, ts: &mut TsRef) -> Result<(), CallbackError> {
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

    fn write_fields(
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

/// The tangent is asked for where the residual was evaluated before: it cannot fail alone.
pub(super) fn not_evaluated(failure: petsc::Failure) -> CallbackError {
    match failure {
        petsc::Failure::Fatal(error) => error,
        petsc::Failure::Domain => "the tangent cannot be evaluated where the residual was".into(),
    }
}
