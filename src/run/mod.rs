//! In: a case and an open PETSc session. Out: one simulation, driven step by step to its end or to
//! the step that cannot be solved, and how it ended.
//! Never: mechanics, or how a file is written.

mod checkpoint;
mod conclusion;
mod diagnosis;
mod dry_run;
mod ledger;
mod newton;
mod recorder;
mod setup;
mod simulation;
mod spent;
mod springback;
mod static_path;
mod step_size;
mod stop_watch;

use std::path::PathBuf;
use std::rc::Rc;
use std::time::Instant;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::{CallbackError, TsReason};

pub use checkpoint::{RestartError, Resumed};
pub use conclusion::{Ending, conclude};
pub use diagnosis::{Course, Flip, Refusal};
pub use ledger::{Ledger, StepEffort};
pub use newton::Damping;
pub use recorder::Recorder;
pub use simulation::{Counts, Interruption};
pub use springback::{Springback, springback};
pub use static_path::StaticPath;
pub use step_size::StepControl;
pub use stop_watch::StopCause;

use crate::case::{self, Case, CaseError};
use crate::output::{OutputError, number};
use crate::system::{Problem, System, SystemError};
use setup::{blas, defaults, linear, unread};
use simulation::Simulation;
use spent::Spent;
use stop_watch::StopWatch;

/// A run that could not be made.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The case or a file it needs.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// Partition or evaluation.
    #[error(transparent)]
    System(#[from] SystemError),
    /// Files.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// PETSc.
    #[error("{0}; if a value of one of PETSc's options is to blame: -help lists what each can be")]
    Petsc(#[from] petsc::Error),
    /// There is nothing to go on from.
    #[error(transparent)]
    Restart(#[from] RestartError),
    /// A signal cannot be caught.
    #[error("signals cannot be caught: {0}")]
    Signals(#[from] std::io::Error),
    /// A hook of the time stepper.
    #[error(transparent)]
    Hook(#[from] CallbackError),
}

/// How a run ended.
pub struct Outcome {
    /// The files, still open, and the rows of all accepted steps.
    pub recorder: Recorder,
    /// Work done.
    pub counts: Counts,
    /// Why it stopped before the end, if it did.
    pub failure: Option<Failure>,
    /// What ended it on request before its end, if something did.
    pub interruption: Option<Interruption>,
    /// Angles after the tools vanish at the turning point and at the end, where they could be had.
    pub springbacks: Vec<Springback>,
    /// PETSc's direct solver in use.
    pub factor_solver: Option<String>,
    /// Unknowns over all ranks.
    pub unknowns: usize,
    /// Processor time of all ranks, s; with that of the runs it went on from.
    pub cpu_seconds: f64,
    /// Time on the clock, s; likewise.
    pub wall_seconds: f64,
}

/// The step that could not be solved.
pub struct Failure {
    /// Time of the last accepted step, ms.
    pub time: f64,
    /// Depth of the punch there, mm.
    pub depth: f64,
    /// PETSc's reason in words.
    pub reason: String,
    /// The solves that were refused, longest step first.
    pub refusals: Vec<Refusal>,
    /// The state before the step, to go on from with other options.
    pub checkpoint: Option<PathBuf>,
}

impl Failure {
    /// Where and why, in one sentence.
    pub fn sentence(&self) -> String {
        let last = self
            .refusals
            .last()
            .map_or_else(String::new, |r| format!("; last tried: {r}"));
        format!("at t = {:.6} ms: {}{last}", self.time, self.reason)
    }
}

/// Runs the case to its end or to the step that cannot be solved. Collective.
///
/// # Errors
/// If the run cannot be set up, or PETSc or a file fails on the way.
pub fn simulate(case: &Case, comm: &SimpleCommunicator) -> Result<Option<Outcome>, RunError> {
    let clock = Instant::now();
    // Before any file is made: neither a slip of the pen nor a question may cost an earlier run's results.
    if petsc::options::has("help")? {
        return defaults::read_options(case, comm).map(|()| None);
    }
    unread::refuse_slips()?;
    defaults::read_options(case, comm)?;
    if case.output.dry_run {
        return dry_run::describe(case, comm).map(|()| None);
    }
    let stop_watch = StopWatch::new(&case.resuming, clock)?;
    let resumed = checkpoint::open(case, comm)?;
    let spent = Spent::new(clock, resumed.as_ref().map_or([0.0; 2], Resumed::spent));
    let problem = Problem::new(case);
    let motion = case.loading.motion();
    let landmarks = landmarks(case)?;
    let system = Rc::new(System::new(problem, comm.duplicate())?);
    let unknowns = system.unknown_count();
    if let Some(resumed) = &resumed {
        resumed.restore_history(&system)?;
    }
    let mut recorder = Recorder::new(case, &system, resumed.as_ref())?;
    recorder.show(&blas::report(comm));
    recorder.show(&linear::report(comm)?);
    let simulation = Rc::new(Simulation::new(
        case, system, recorder, landmarks, stop_watch, spent,
    )?);
    let finish = simulation.run(case, resumed.as_ref())?;
    // A limit of the user's (-ts_max_steps) is a good end for PETSc, but not for the motion.
    let short = finish.interruption.is_none() && finish.time < motion.end() * (1.0 - 1e-9);
    let failure = (short || finish.reason.is_diverged()).then(|| Failure {
        time: finish.time,
        depth: motion.depth(finish.time),
        reason: why(case, finish.reason, &finish.refusals),
        refusals: finish.refusals,
        checkpoint: finish.checkpoint,
    });
    let [cpu_seconds, wall_seconds] = spent.so_far(comm);
    let simulation = Rc::into_inner(simulation)
        .ok_or_else(|| CallbackError::from("the time stepper still holds the simulation"))?;
    Ok(Some(Outcome {
        cpu_seconds,
        wall_seconds,
        recorder: simulation.into_recorder(),
        counts: finish.counts,
        failure,
        interruption: finish.interruption,
        springbacks: finish.springbacks,
        factor_solver: finish.factor_solver,
        unknowns,
    }))
}

/// Why no further step could be made. The time stepper only knows that its last attempts were refused.
fn why(case: &Case, reason: TsReason, refusals: &[Refusal]) -> String {
    let (Some(first), Some(last)) = (refusals.first(), refusals.last()) else {
        return reason.sentence().to_owned();
    };
    let tried = match refusals.len() {
        1 => format!(
            "the solve of the next step, {} ms long, was refused",
            number(first.dt)
        ),
        count => format!(
            "{count} solves of the next step were refused, {} down to {} ms long",
            number(first.dt),
            number(last.dt)
        ),
    };
    if last.dt * defaults::CUT_BACK < case.stepping.dt_min {
        let least = number(case.stepping.dt_min);
        format!("{tried}; a shorter one would be below -dt_min {least} ms")
    } else {
        format!("{tried}; {}", reason.sentence())
    }
}

/// Times to hit exactly: both ends, where reference values are compared, and where the user wants a row.
fn landmarks(case: &Case) -> Result<Vec<f64>, CaseError> {
    let motion = case.loading.motion();
    let mut depths = case.stepping.report_strokes.clone();
    for value in case.reference_values()? {
        if let case::Instant::Travel(depth) = value.when {
            depths.push(depth);
        }
    }
    depths.retain(|&depth| depth < motion.stroke);
    let mut times: Vec<f64> = depths
        .iter()
        .map(|&depth| motion.time_at_depth(depth))
        .collect();
    times.extend([motion.time_load, motion.end()]);
    let equal = |start: f64, end: f64, count: usize| {
        (1..count).map(move |k| start + (end - start) * k as f64 / count as f64)
    };
    times.extend(equal(0.0, motion.time_load, case.stepping.fixed_steps_load));
    if motion.end() > motion.time_load {
        let count = case.stepping.fixed_steps_unload;
        times.extend(equal(motion.time_load, motion.end(), count));
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    Ok(times)
}
