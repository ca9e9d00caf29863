//! Options of PETSc's that would break the run, and options nobody read: ours are read first, so that a mistyped one is
//! found before the run; what PETSc did not read is known after it.

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;

use super::{defaults, forbidden, linear};
use crate::case::{Case, CaseError, Dynamics, check_unused};
use crate::run::error::RunError;

/// An option of PETSc's that the user may not change.
struct Reserved {
    option: &'static str,
    /// The only value that does no harm; none does without.
    allowed: Option<&'static str>,
    /// Why, in words that fit behind "option -name value:".
    reason: &'static str,
    /// What to do instead, in words that fit behind "leave it out, and".
    instead: &'static str,
}

const STEPS: &str = "the program chooses the steps itself";
const STEP_OPTIONS: &str = "set the steps with -dt_initial, -dt_max, -dt_min or -fixed_steps_load";
const END_OF_STEP: &str = "contact, stress and inertia hold at the end of a step only with the \
                           parameters the program sets (spectral radius 0)";
const SHORTER_STEPS: &str = "shorten the steps with -dt_max where vibrations are damped too much";
const TIMES: &str = "set the times with -time_load and -time_unload";

const fn never(option: &'static str, reason: &'static str, instead: &'static str) -> Reserved {
    Reserved {
        option,
        allowed: None,
        reason,
        instead,
    }
}

/// Options that would make the run step otherwise than its equations are written for.
const RESERVED: &[Reserved] = &[
    Reserved {
        option: "ts_adapt_type",
        allowed: Some("none"),
        reason: STEPS,
        instead: STEP_OPTIONS,
    },
    never("ts_dt", STEPS, STEP_OPTIONS),
    never("ts_init_time", "every run begins at time 0", TIMES),
    never("ts_max_time", "the motion of the punch ends the run", TIMES),
    never("ts_alpha_radius", END_OF_STEP, SHORTER_STEPS),
    never("ts_alpha_alpha_m", END_OF_STEP, SHORTER_STEPS),
    never("ts_alpha_alpha_f", END_OF_STEP, SHORTER_STEPS),
    never("ts_alpha_gamma", END_OF_STEP, SHORTER_STEPS),
    never("ts_alpha_beta", END_OF_STEP, SHORTER_STEPS),
];

/// PETSc's time stepper for the equations of a case: the only one their callbacks are written for.
const fn stepper(dynamics: Dynamics) -> Reserved {
    let instead = "choose between inertia and statics with -dynamics";
    let (allowed, reason) = match dynamics {
        Dynamics::Slow => (
            "alpha2",
            "the equations with inertia (-dynamics slow) are of second order in time",
        ),
        Dynamics::None => (
            "beuler",
            "the static equations (-dynamics none) hold at the end of each step",
        ),
    };
    Reserved {
        option: "ts_type",
        allowed: Some(allowed),
        reason,
        instead,
    }
}

/// Refuses the first option that is neither ours nor PETSc's, or not the user's to choose. All of ours must have been
/// read.
///
/// # Errors
/// Which one, why, and what to do.
pub fn refuse_bad_options(case: &Case, comm: &SimpleCommunicator) -> Result<(), RunError> {
    let stepper = stepper(case.loading.dynamics);
    for reserved in RESERVED.iter().chain([&stepper]) {
        let refused = |given: &String| reserved.allowed != Some(given);
        if let Some(given) = petsc::options::get(reserved.option)?.filter(refused) {
            return Err(CaseError::Reserved {
                option: reserved.option,
                given,
                reason: reserved.reason,
                allowed: reserved.allowed,
                instead: reserved.instead,
            }
            .into());
        }
    }
    forbidden::refuse(comm.size())?;
    let (errors, _) = check_unused(&petsc::options::unused()?);
    errors
        .into_iter()
        .next()
        .map_or(Ok(()), |error| Err(error.into()))
}

/// A line for each option of PETSc's family that PETSc did not read, after a run. Our own choices are
/// left out: who chooses another solver need not take back the options of the one chosen here.
pub(in crate::run) fn warnings() -> Result<String, RunError> {
    let mut unused = petsc::options::unused()?;
    unused.retain(|(name, value)| {
        let value = value.as_deref();
        let ours = defaults::is_default(name, value) || linear::is_default(name, value);
        !ours && !READ_AT_THE_END.contains(&name.as_str())
    });
    let (_, warnings) = check_unused(&unused);
    Ok(warnings
        .iter()
        .map(|warning| format!("warning: {warning}\n"))
        .collect())
}

/// Options that PETSc reads when it ends.
const READ_AT_THE_END: &[&str] = &[
    "options_left",
    "options_view",
    "malloc_dump",
    "objects_dump",
];
