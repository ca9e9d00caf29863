//! In: a case and an open PETSc session. Out: one simulation, driven step by step to its end or to
//! the step that cannot be solved, and how it ended.
//! Never: mechanics, or how a file is written.

mod checkpoint;
mod compare;
mod conclusion;
mod diagnosis;
mod dry_run;
mod error;
mod ledger;
mod newton;
mod outcome;
mod recorder;
mod setup;
mod simulation;
mod springback;
mod static_path;
mod step_size;
mod stop_watch;

use std::rc::Rc;
use std::time::Instant;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::CallbackError;

pub use checkpoint::Resumed;
pub use compare::compare;
pub use conclusion::{Ending, conclude};
pub use diagnosis::{Chattering, Refusal, ResidualHistory};
pub use error::{RestartError, RunError};
pub use ledger::{Counts, Ledger, StepEffort};
pub use newton::Damping;
pub use outcome::{Failure, Outcome, SensitivityEnd};
pub use recorder::Recorder;
pub use simulation::Interruption;
pub use springback::Springback;
pub use static_path::StaticPath;
pub use step_size::StepControl;
pub use stop_watch::StopCause;

use crate::case::Case;
use crate::output::OutputDir;
use crate::sensitivity::Beside;
use crate::system::{History, Problem, System};
use ledger::Spent;
use outcome::why;
use setup::{blas, defaults, doubtful, given, help, linear};
pub use setup::{fate_of_petsc_option, refuse_bad_options};
use simulation::Simulation;
use step_size::landmarks;
use stop_watch::StopWatch;

/// Runs the case to its end or to the step that cannot be solved. Collective.
///
/// # Errors
/// If the run cannot be set up, or PETSc or a file fails during it.
pub fn simulate(case: &Case, comm: &SimpleCommunicator) -> Result<Option<Outcome>, RunError> {
    let clock = Instant::now();
    // Before any file is made: neither a typing mistake nor a question may cost an earlier run's results.
    if petsc::options::has("help")? {
        return help::show(case, comm).map(|()| None);
    }
    refuse_bad_options(case, comm)?;
    defaults::read_options(case, comm)?;
    if case.output.dry_run {
        return dry_run::describe(case, comm).map(|()| None);
    }
    let beside = Beside::of(case)?;
    if let Some(first) = beside.first() {
        if linear::left_to_petsc()? {
            return Err(linear::no_derivatives(first.parameter.name).into());
        }
    }
    let stop_watch = StopWatch::new(&case.resuming, clock)?;
    // The lock comes before the look at the checkpoints; a refused restart makes no folder.
    let existing = OutputDir::existing(&case.output.dir, comm)?;
    let resumed = checkpoint::open(case, comm)?;
    let folder = match existing {
        Some(folder) => folder,
        None => OutputDir::create(&case.output.dir, comm)?,
    };
    let from = resumed.as_ref().map(|earlier| earlier.path.as_path());
    let replaced = folder.replace(from, case.resuming.overwrite, comm)?;
    let spent = Spent::new(clock, resumed.as_ref().map_or([0.0; 2], Resumed::spent));
    let problem = Problem::new(case);
    let motion = case.loading.motion();
    let landmarks = landmarks(case)?;
    let system = Rc::new(System::new(problem, comm.duplicate())?);
    blas::find_room(comm)?;
    let unknowns = system.unknown_count();
    let history = match &resumed {
        Some(resumed) => resumed.history(&system)?,
        None => History::virgin(system.local()),
    };
    let mut recorder = Recorder::new(case, &system, resumed.as_ref(), folder)?;
    recorder.show(&replaced);
    recorder.show(&blas::report(comm));
    recorder.tell(&linear::report(comm)?);
    recorder.tell(&given::report(case)?);
    let simulation = Rc::new(Simulation::new(
        case, system, history, recorder, landmarks, stop_watch, spent,
    )?);
    let finish = simulation.run(case, beside, resumed.as_ref())?;
    // A limit of the user's (-ts_max_steps) is a good end for PETSc, but not for the motion.
    let short = finish.interruption.is_none() && finish.time < motion.end() * (1.0 - 1e-9);
    let suspects = doubtful::given()?;
    let failure = (short || finish.reason.is_diverged()).then(|| Failure {
        suspects,
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
        sensitivity: finish.sensitivity,
        factor_solver: finish.factor_solver,
        unknowns,
    }))
}
