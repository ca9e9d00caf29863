//! Why a run cannot be made, in one sentence each.

use std::path::PathBuf;

use petsc::CallbackError;

use crate::case::CaseError;
use crate::output::OutputError;
use crate::system::SystemError;

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
    Petsc(petsc::Error),
    /// A limit on memory that would make the BLAS hang.
    #[error(
        "a limit on memory (ulimit -v, or one of the batch system) leaves less than {megabytes} MB for the factorisation on a \
         rank; raise it, or use fewer ranks on this machine"
    )]
    NoRoom {
        /// What is needed besides what the run has so far.
        megabytes: usize,
    },
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

impl From<petsc::Error> for RunError {
    /// What a hook of ours failed with has only come through PETSc, and none of its options is to blame, unless the hook
    /// called PETSc and failed with that.
    fn from(error: petsc::Error) -> Self {
        match error {
            petsc::Error::Callback { source, .. } => match source.downcast::<petsc::Error>() {
                Ok(error) => Self::from(*error),
                Err(source) => Self::Hook(source),
            },
            error => Self::Petsc(error),
        }
    }
}

/// Why there is nothing to go on from.
#[derive(Debug, thiserror::Error)]
pub enum RestartError {
    /// No checkpoint in the output folder.
    #[error(
        "-restart: there is no checkpoint in {}; run without -restart, or specify the path of a checkpoint", folder.display()
    )]
    None {
        /// The folder.
        folder: PathBuf,
    },
    /// The checkpoint belongs to another problem.
    #[error(
        "-restart: the checkpoint {} belongs to another problem ({differences}); use the same options, or run without \
         -restart", path.display()
    )]
    OtherProblem {
        /// The checkpoint.
        path: PathBuf,
        /// The options that differ.
        differences: String,
    },
    /// The checkpoint has not the derivatives that are asked for.
    #[error(
        "-restart: the checkpoint {} carries {}; use -sensitivity {found}, or run without -restart", path.display(),
        if found == "none" { "no derivatives".to_owned() } else { format!("derivatives by {found}") }
    )]
    OtherParameters {
        /// The checkpoint.
        path: PathBuf,
        /// Its parameters as -sensitivity takes them.
        found: String,
    },
}
