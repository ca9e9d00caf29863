//! Options of PETSc's that would break the run, and options nobody read: ours are read first, so that a mistyped one is
//! found before the run; what PETSc did not read is known after it.

use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;

use super::{defaults, forbidden, given, linear};
use crate::case::{Case, CaseError, Dynamics, check_unused};
use crate::run::error::RunError;

/// Refuses a time stepper other than the one the callbacks of the equations are written for.
fn refuse_other_stepper(dynamics: Dynamics) -> Result<(), RunError> {
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
    match petsc::options::get("ts_type")? {
        Some(given) if given != allowed => Err(CaseError::Reserved {
            option: "ts_type".to_owned(),
            given,
            reason,
            allowed: Some(allowed),
            instead: "choose between inertia and statics with -dynamics",
        }
        .into()),
        _ => Ok(()),
    }
}

/// Refuses the first option that is neither ours nor PETSc's, or not the user's to choose. All of ours must have been
/// read.
///
/// # Errors
/// Which one, why, and what to do.
pub fn refuse_bad_options(case: &Case, comm: &SimpleCommunicator) -> Result<(), RunError> {
    given::refuse()?;
    refuse_other_stepper(case.loading.dynamics)?;
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
