//! Why something could not be written or read, as one sentence with the path in it.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use mpi::traits::Communicator;
use serde::{Deserialize, Serialize};

use crate::ranks::{broadcast_bytes, lowest_failing};

/// A failure of the output room. It can be sent from rank to rank, so that every rank reports the same one.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
pub enum OutputError {
    /// The output folder does not exist and could not be made.
    #[error("cannot create the output folder {}: {reason}; choose another one with -output_dir", path.display())]
    CannotCreateFolder {
        /// The folder asked for.
        path: PathBuf,
        /// The system's words.
        reason: String,
    },
    /// Something that is not a folder has the name of the output folder.
    #[error("the output folder {} is a file, not a folder; choose another one with -output_dir, or move the file away", path.display())]
    NotAFolder {
        /// The folder asked for.
        path: PathBuf,
    },
    /// The folder exists, but no file can be made in it.
    #[error("the output folder {} takes no files: {reason}; choose another one with -output_dir", path.display())]
    NotWritable {
        /// The folder asked for.
        path: PathBuf,
        /// The system's words.
        reason: String,
    },
    /// Another run writes into the folder.
    #[error("the output folder {} is in use by {holder}; wait until it has ended, or choose another one with -output_dir", path.display())]
    InUse {
        /// The folder asked for.
        path: PathBuf,
        /// Who, and since when.
        holder: String,
    },
    /// A new run would remove the checkpoint of one that can go on.
    #[error("the output folder {} holds an interrupted run ({checkpoint}): resume it with -restart, replace it with -overwrite, or choose another one with -output_dir", path.display())]
    WouldBeLost {
        /// The folder asked for.
        path: PathBuf,
        /// The newest checkpoint's name.
        checkpoint: String,
    },
    /// Something in the output folder has the name of a file of the run and cannot be written over.
    #[error("{} cannot be written over: {reason}; move it away, or choose another folder with -output_dir", path.display())]
    NotReplaceable {
        /// The file.
        path: PathBuf,
        /// What is in the way.
        reason: String,
    },
    /// A file could not be written.
    #[error("cannot write {}: {reason}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's words.
        reason: String,
    },
    /// The disk is full, or the user's share of it.
    #[error("cannot write {}: {reason}; make room and go on with -restart, or choose another folder with -output_dir", path.display())]
    NoSpace {
        /// The file.
        path: PathBuf,
        /// What is needed and what is there, or the system's words.
        reason: String,
    },
    /// A file could not be read, or does not hold what it should.
    #[error("cannot read {}: {reason}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What is wrong, with the place where possible.
        reason: String,
    },
    /// HDF5 refused an operation.
    #[error("HDF5 failed on {} while {doing}: {reason}", path.display())]
    Hdf5 {
        /// The file.
        path: PathBuf,
        /// What was being done.
        doing: String,
        /// HDF5's words.
        reason: String,
    },
    /// The data handed over do not fit the file they are meant for (a mistake in the calling code).
    #[error("the data for {} do not fit: {reason}", path.display())]
    Mismatch {
        /// The file.
        path: PathBuf,
        /// What does not fit.
        reason: String,
    },
    /// A checkpoint is damaged, or not one.
    #[error("the checkpoint {} cannot be used: {reason}", path.display())]
    Checkpoint {
        /// Its folder.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// A folder to compare holds no run that has ended.
    #[error("-compare: {} holds no run that has ended: {reason}; specify the output folders of two runs", path.display())]
    NoRun {
        /// The folder.
        path: PathBuf,
        /// What is missing.
        reason: String,
    },
    /// A figure could not be drawn.
    #[error("cannot draw the figure {}: {reason}", path.display())]
    Figure {
        /// The file the figure was meant for.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
}

impl OutputError {
    /// [`OutputError::NoSpace`] if that is the reason, [`OutputError::Write`] else.
    pub(crate) fn write(path: &Path, error: impl Into<io::Error>) -> Self {
        let (path, error) = (path.into(), error.into());
        let reason = error.to_string();
        match error.kind() {
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded => Self::NoSpace { path, reason },
            _ => Self::Write { path, reason },
        }
    }

    pub(crate) fn read(path: &Path, reason: impl ToString) -> Self {
        Self::Read {
            path: path.into(),
            reason: reason.to_string(),
        }
    }

    pub(crate) fn hdf5(path: &Path, doing: impl ToString, reason: impl ToString) -> Self {
        Self::Hdf5 {
            path: path.into(),
            doing: doing.to_string(),
            reason: reason.to_string(),
        }
    }

    pub(crate) fn mismatch(path: &Path, reason: impl ToString) -> Self {
        Self::Mismatch {
            path: path.into(),
            reason: reason.to_string(),
        }
    }
}

/// Collective over `comm`. Returns this rank's value if every rank succeeded; otherwise every rank returns the
/// error of the lowest rank that failed, so that no rank goes on alone into a collective call.
pub(crate) fn agree<T>(
    comm: &impl Communicator,
    mine: Result<T, OutputError>,
) -> Result<T, OutputError> {
    let Some(lowest) = lowest_failing(comm, mine.is_err()) else {
        return mine;
    };
    let text = match &mine {
        Err(error) if comm.rank() == lowest => serde_json::to_vec(error).unwrap_or_default(),
        _ => Vec::new(),
    };
    let text = broadcast_bytes(comm, lowest, text);
    Err(
        serde_json::from_slice(&text).unwrap_or_else(|error| OutputError::Read {
            path: format!("the error message of rank {lowest}").into(),
            reason: error.to_string(),
        }),
    )
}
