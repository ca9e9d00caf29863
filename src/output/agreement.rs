//! One answer on every rank: if any rank failed, all ranks return the failure of the lowest one.

use mpi::traits::Communicator;

use super::OutputError;
use crate::ranks::{broadcast_bytes, lowest_failing};

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
