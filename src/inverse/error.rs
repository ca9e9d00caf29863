//! Why a search cannot be made or ends early, in one sentence each.

use crate::case::CaseError;
use crate::output::OutputError;
use crate::run::RunError;

/// A search that could not be made.
#[derive(Debug, thiserror::Error)]
pub enum InverseError {
    /// The case or the measured curve.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// A run.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Files.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// PETSc.
    #[error("{0}; if the value of an option -tao_... is to blame: -help lists what each can be")]
    Petsc(#[from] petsc::Error),
    /// What a rank said, on every rank.
    #[error("{0}")]
    Agreed(String),
    /// The first run cannot be solved, so that there is nothing to start from.
    #[error(
        "the run with the values the search starts from was not solved to its end: see {folder}; start from other values"
    )]
    NoStart {
        /// Its folder.
        folder: String,
    },
    /// The allowed runs are used up.
    #[error("the runs that -most_runs allows are used up")]
    RunsUsedUp,
    /// The best fit is near enough; it ends the optimiser and not the search.
    #[error("the best fit is near enough")]
    Near,
    /// A run was ended on request.
    #[error("a run was asked to end")]
    Interrupted,
}
