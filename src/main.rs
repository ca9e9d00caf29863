//! The program: opens MPI and PETSc, reads the case, runs it, and ends with a code that says how.

#![deny(clippy::unwrap_used, clippy::expect_used)]

use std::fmt::Display;
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::rc::Rc;

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;
use petsc::{Session, options};
use ssnp155::case::{
    Case, CaseError, ENVIRONMENT, OptionSource, arguments_as_text, check_arguments,
    check_environment, check_ranks, help_text,
};
use ssnp155::inverse;
use ssnp155::ranks::lowest_failing;
use ssnp155::run::{Ending, compare, conclude, simulate};

/// What PETSc is told before the user's options: no signal handlers, and no words about options at its end.
const PETSC_ARGUMENTS: [&str; 3] = ["-no_signal_handler", "-options_left", "no"];
/// Exit code of a run that did not finish, or whose verdicts do not hold.
const NOT_HELD: u8 = 1;
/// Exit code of a run that was ended on request and can go on.
const INTERRUPTED: u8 = 3;
/// Exit code of a run that could not be made.
const REFUSED: u8 = 2;

fn main() -> ExitCode {
    let Some((universe, _)) = mpi::initialize_with_threading(mpi::Threading::Funneled) else {
        complain("MPI cannot be started");
        return ExitCode::from(REFUSED);
    };
    let world = universe.world();
    // A panic on one rank would leave the others waiting for ever, so it ends them all.
    match catch_unwind(AssertUnwindSafe(|| program(&world))) {
        Ok(Ok(Ending::Holds)) => ExitCode::SUCCESS,
        Ok(Ok(Ending::DoesNotHold)) => ExitCode::from(NOT_HELD),
        Ok(Ok(Ending::Interrupted)) => ExitCode::from(INTERRUPTED),
        Ok(Err(Refused)) => ExitCode::from(REFUSED),
        Err(_) => world.abort(i32::from(REFUSED)),
    }
}

/// There was no run; the reason has been shown.
struct Refused;

/// How the run ended. Collective.
fn program(world: &SimpleCommunicator) -> Result<Ending, Refused> {
    let args = agree(world, arguments_as_text(std::env::args_os()))?;
    agree(world, check_environment(std::env::var_os(ENVIRONMENT)))?;
    agree(world, check_arguments(args.get(1..).unwrap_or_default()))?;
    let session = Rc::new(agree(world, open_session(&args))?);
    let case = agree(world, Case::read(&PetscOptions))?;
    agree(
        world,
        check_ranks(world.size().unsigned_abs() as usize, &case),
    )?;
    if let Some(pair) = &case.output.compare {
        return agree(world, compare(&case, pair, world)).map(|()| Ending::Holds);
    }
    if case.inverse.is_asked() {
        return agree(world, inverse::solve(&case, &session, world));
    }
    let outcome = agree(world, simulate(&case, world))?;
    match outcome {
        Some(outcome) => agree(world, conclude(&case, outcome, &session, world)),
        // Help was asked for and shown.
        None => Ok(Ending::Holds),
    }
}

/// The last sentence; nobody may be listening any more, which must not change the code.
fn complain(sentence: impl Display) {
    let _ = writeln!(std::io::stderr(), "ssnp155: {sentence}");
}

/// Starts PETSc, which reads the options. It would end with words of its own about options that nobody read, of which
/// the program has said what there is to say. Its signal handlers would end the run with a traceback where a pipe closes or
/// a terminal goes away, so they stay out unless asked for; the run has handlers of its own.
fn open_session(args: &[String]) -> Result<Session, String> {
    let (program, given) = args.split_at(1.min(args.len()));
    let args = [program, &PETSC_ARGUMENTS.map(str::to_owned), given].concat();
    Session::with_help(&args, &help_text()).map_err(|error| {
        format!(
            "PETSc refuses its options ({error}); look at the command line, the option files, {ENVIRONMENT} and .petscrc"
        )
    })
}

/// The value if every rank has one; otherwise the lowest rank that failed says why. Collective.
fn agree<T, E: Display>(world: &SimpleCommunicator, mine: Result<T, E>) -> Result<T, Refused> {
    let lowest = lowest_failing(world, mine.is_err());
    match mine {
        Ok(value) if lowest.is_none() => Ok(value),
        Err(error) if lowest == Some(world.rank()) => {
            complain(error);
            Err(Refused)
        }
        _ => Err(Refused),
    }
}

/// PETSc's option database as the source of ours.
struct PetscOptions;

impl OptionSource for PetscOptions {
    fn get(&self, name: &str) -> Result<Option<String>, CaseError> {
        // PETSc stores an option without a value, and one with an empty value, alike: as an empty text.
        options::get(name).map_err(|error| CaseError::Unreadable {
            option: name.to_owned(),
            reason: error.to_string(),
        })
    }
}
