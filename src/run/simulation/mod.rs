//! One simulation: PETSc's time stepper with our residual, and what happens around each step.

mod resume;
mod solve;
mod step;
mod stepper;

use std::cell::{Cell, RefCell};
use std::path::PathBuf;
use std::rc::Rc;

use petsc::{Alpha2State, Ts, TsReason, Vector};

use super::RunError;
use super::checkpoint::{Resumed, RunState, hardening_checksum};
use super::diagnosis::{Refusal, SolveWatch};
use super::ledger::{Counts, Ledger, Spent};
use super::newton::{Damping, TangentInertia};
use super::recorder::Recorder;
use super::setup::{LinearSolve, defaults};
use super::springback::Springback;
use super::step_size::StepControl;
use super::stop_watch::StopWatch;
use crate::case::{Case, Dynamics};
use crate::contact::ContactState;
use crate::system::{FieldSampler, System};
use crate::tool::PunchMotion;

pub use resume::Interruption;
pub(super) use stepper::not_evaluated;

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
    /// States of this rank's contact points at the last iteration shown.
    states: RefCell<Vec<ContactState>>,
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
            states: RefCell::default(),
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

    /// Gives the recorder back when the time stepper is gone.
    pub(super) fn into_recorder(self) -> Recorder {
        self.recorder.into_inner()
    }
}
