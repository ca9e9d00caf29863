//! In: a case, and what is looked for. Out: the parameters that a measured curve or a wanted angle asks for, found by whole
//! runs, and what is known about them.
//! Never: mechanics, or what happens within a run.

mod design;
mod design_report;
mod error;
mod fit;
mod identification;
mod least_change;
mod quadratic;
mod report;
mod runs;
mod search;
mod statistics;

use std::rc::Rc;

use mpi::topology::SimpleCommunicator;
use petsc::Session;

pub use error::InverseError;
pub use least_change::least_change;
pub use statistics::{Statistics, singular_values};

use crate::case::Case;
use crate::run::{Ending, simulate};

/// Looks for what the case asks for. Collective.
///
/// # Errors
/// If the measured curve or a run is refused, or PETSc or a file fails; the same on every rank.
pub fn solve(
    case: &Case,
    session: &Rc<Session>,
    comm: &SimpleCommunicator,
) -> Result<Ending, InverseError> {
    if case.output.dry_run || petsc::options::has("help")? {
        // One run answers: the model is that of all of them.
        return Ok(simulate(case, comm).map(|_| Ending::Holds)?);
    }
    match (&case.inverse.identify, case.inverse.design) {
        (Some(path), _) => identification::identify(case, path, session, comm),
        (None, Some(angle)) => design::design(case, angle, session, comm),
        (None, None) => Ok(Ending::Holds),
    }
}
