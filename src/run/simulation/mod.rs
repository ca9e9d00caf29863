//! One simulation: PETSc's time stepper with our residual, and what happens around each step.

mod accepted;
mod attempt;

mod equations;
mod interruption;
mod progress;
mod resume;
mod sensitivity;
mod solve;
mod step;

use std::cell::RefCell;
use std::path::PathBuf;
use std::rc::Rc;

use petsc::{Alpha2State, Ts, TsReason};

use super::RunError;
use super::checkpoint::{Resumed, RunState, hardening_checksum, tool_checksums};
use super::diagnosis::Refusal;
use super::ledger::{Counts, Spent};
use super::outcome::SensitivityEnd;
use super::recorder::Recorder;
use super::setup::{LinearSolve, defaults};
use super::springback::Springback;
use super::step_size::StepControl;
use super::stop_watch::StopWatch;
use crate::case::{Case, Dynamics};
use crate::sensitivity::Beside;
use crate::system::{History, System};
use crate::tool::PunchMotion;
use accepted::Accepted;
use attempt::Attempt;
use progress::Progress;

pub use interruption::Interruption;

/// What the hooks of the time stepper share.
pub(super) struct Simulation {
    settings: Settings,
    progress: RefCell<Progress>,
}

/// What stays as it is during a run.
struct Settings {
    system: Rc<System>,
    dynamics: Dynamics,
    motion: PunchMotion,
    /// Absolute tolerance on the residual norm, mm, and most iterations of a solve.
    tolerance: f64,
    most_iterations: usize,
    /// Shortest step, ms.
    least_step: f64,
    extrapolate: bool,
    /// The user has not fixed the steps.
    free_steps: bool,
    show_iterations: bool,
    spent: Spent,
    /// What a checkpoint says about the case it belongs to.
    identity: RunState,
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
    pub sensitivity: SensitivityEnd,
    /// PETSc's direct solver in use.
    pub factor_solver: Option<String>,
}

impl Simulation {
    /// Of a sheet with this history, from the start or from a checkpoint.
    pub(super) fn new(
        case: &Case,
        system: Rc<System>,
        history: History,
        recorder: Recorder,
        landmarks: Vec<f64>,
        stop_watch: StopWatch,
        spent: Spent,
    ) -> Result<Self, RunError> {
        let stepping = &case.stepping;
        let free_steps = stepping.fixed_steps_load == 0 && stepping.fixed_steps_unload == 0;
        let progress = Progress {
            accepted: Accepted::start(system.initial_unknowns()?, history),
            attempt: Attempt::default(),
            refusals: Vec::new(),
            sensitivity: None,
            control: StepControl::new(stepping.dt_initial, stepping.dt_max, landmarks)
                .with_equal_steps(!free_steps),
            stop_watch,
            recorder,
            shown: Vec::new(),
            interruption: None,
        };
        let settings = Settings {
            system,
            dynamics: case.loading.dynamics,
            motion: case.loading.motion(),
            tolerance: stepping.newton_tolerance,
            most_iterations: stepping.newton_max_iterations,
            least_step: stepping.dt_min,
            extrapolate: stepping.extrapolate,
            free_steps,
            show_iterations: case.output.iterations,
            spent,
            identity: identity(case),
        };
        Ok(Self {
            settings,
            progress: RefCell::new(progress),
        })
    }

    /// Runs from the start or from a checkpoint to the end of the motion, until a step cannot be solved, or until it is
    /// asked to end. Collective.
    pub(super) fn run(
        self: &Rc<Self>,
        case: &Case,
        beside: Vec<Beside>,
        resumed: Option<&Resumed>,
    ) -> Result<Finish, RunError> {
        let system = &self.settings.system;
        defaults::set(case)?;
        let mut ts = Ts::new(system.comm())?;
        let linear = LinearSolve::chosen(system)?;
        self.set_problem(&mut ts, &linear)?;
        self.set_hooks(&mut ts)?;
        let (lower, upper) = system.bounds()?;
        ts.snes_mut()?.set_type("vinewtonrsls")?;
        linear.install(ts.snes_mut()?)?;
        ts.set_from_options()?;
        ts.snes_mut()?.set_variable_bounds(&lower, &upper)?;
        ts.set_max_time(self.progress.borrow().control.end())?;
        self.begin(&mut ts, resumed)?;
        self.differentiate(&linear, beside, resumed)?;
        let reason = self.solve(&mut ts)?;
        let checkpoint = self.save_before_failure(reason)?;
        let factor_solver = linear.factor_solver(ts.snes()?)?;
        let progress = &mut *self.progress.borrow_mut();
        Ok(Finish {
            reason,
            counts: progress.accepted.counts,
            refusals: std::mem::take(&mut progress.refusals),
            time: progress.accepted.time,
            springbacks: std::mem::take(&mut progress.accepted.springbacks),
            interruption: progress.interruption.take(),
            checkpoint,
            sensitivity: progress.sensitivity_end(system.comm()),
            factor_solver,
        })
    }

    /// Puts the time stepper at the start or at the state of a checkpoint.
    fn begin(&self, ts: &mut Ts, resumed: Option<&Resumed>) -> Result<(), RunError> {
        if self.settings.dynamics == Dynamics::Slow {
            let at_rest = self.settings.system.vector()?;
            self.progress.borrow_mut().accepted.rates = Some(Alpha2State::new(ts, &at_rest)?);
        }
        match resumed {
            Some(resumed) => self.put_back(ts, resumed)?,
            None => {
                let start = self.progress.borrow().accepted.unknowns.to_owned()?;
                self.write_fields(0.0, &start, None)?;
            }
        }
        ts.set_time_step(self.plan_step()?)?;
        self.progress.borrow_mut().recorder.begin(resumed);
        Ok(())
    }

    /// The recorder, when the time stepper is gone.
    pub(super) fn into_recorder(self) -> Recorder {
        self.progress.into_inner().recorder
    }
}

fn identity(case: &Case) -> RunState {
    RunState {
        options: case
            .options()
            .into_iter()
            .map(|(name, value)| (name.to_owned(), value))
            .collect(),
        hardening: hardening_checksum(case),
        tools: tool_checksums(case),
        revision: env!("SSNP155_REVISION").to_owned(),
        ..RunState::default()
    }
}
