//! Options nobody read: ours are read first, so that a slip of the pen is found before the run; what
//! PETSc did not read is known after it.

use super::{defaults, linear};
use crate::case::{CaseError, check_unused};
use crate::run::RunError;

/// Options of PETSc with the only value that leaves the steps to this program: another one would make them ever
/// shorter, or step otherwise than the equations are written for.
const OURS_TO_CHOOSE: &[(&str, &str)] = &[("ts_adapt_type", "none"), ("ts_type", "alpha2")];

/// Refuses the first option that is neither one of ours nor of PETSc's, or not the user's to choose. All of ours must
/// have been read.
pub(in crate::run) fn refuse_slips() -> Result<(), RunError> {
    for &(option, allowed) in OURS_TO_CHOOSE {
        if let Some(given) = petsc::options::get(option)?
            && given != allowed
        {
            return Err(CaseError::NotYours {
                option,
                given,
                allowed,
            }
            .into());
        }
    }
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
        !ours && !LATE.contains(&name.as_str())
    });
    let (_, warnings) = check_unused(&unused);
    Ok(warnings
        .iter()
        .map(|warning| format!("warning: {warning}\n"))
        .collect())
}

/// Options that PETSc reads when it ends.
const LATE: &[&str] = &[
    "options_left",
    "options_view",
    "malloc_dump",
    "objects_dump",
];
