//! One answer on every rank: if any rank failed, all ranks return the failure of the lowest one.

use mpi::traits::{Communicator, CommunicatorCollectives, Root};

use super::OutputError;

/// Collective over `comm`. Returns this rank's value if every rank succeeded; otherwise every rank returns the
/// error of the lowest rank that failed, so that no rank goes on alone into a collective call.
pub(crate) fn agree<T>(
    comm: &impl Communicator,
    mine: Result<T, OutputError>,
) -> Result<T, OutputError> {
    let vote = if mine.is_err() { comm.rank() } else { i32::MAX };
    let mut lowest = i32::MAX;
    comm.all_reduce_into(&vote, &mut lowest, mpi::collective::SystemOperation::min());
    if lowest == i32::MAX {
        return mine;
    }
    let root = comm.process_at_rank(lowest);
    let mut text = match &mine {
        Err(error) if comm.rank() == lowest => serde_json::to_vec(error).unwrap_or_default(),
        _ => Vec::new(),
    };
    let mut length = text.len() as u64;
    root.broadcast_into(&mut length);
    text.resize(length as usize, 0);
    root.broadcast_into(&mut text[..]);
    Err(
        serde_json::from_slice(&text).unwrap_or_else(|error| OutputError::Read {
            path: format!("the error message of rank {lowest}").into(),
            reason: error.to_string(),
        }),
    )
}
