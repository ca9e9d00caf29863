//! The partition of the mesh, the same on every rank.

use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, Root};

use crate::mesh::{Partition, PartitionError, SheetMesh, partition};

/// Every element's rank: METIS runs on rank 0, its result or its failure is the same everywhere. Collective.
pub(super) fn on_root(
    mesh: &SheetMesh,
    comm: &SimpleCommunicator,
) -> Result<Partition, PartitionError> {
    let ranks = comm.size() as usize;
    if ranks == 1 {
        return partition(mesh, 1);
    }
    // METIS is deterministic, so a rank that needs the message of a failure can ask it again.
    let mut parts: Vec<u64> = vec![u64::MAX; mesh.elements.len()];
    if comm.rank() == 0 {
        if let Ok(found) = partition(mesh, ranks) {
            parts = found.into_iter().map(|part| part as u64).collect();
        }
    }
    comm.process_at_rank(0).broadcast_into(&mut parts[..]);
    if parts[0] == u64::MAX {
        return partition(mesh, ranks);
    }
    Ok(parts.into_iter().map(|part| part as usize).collect())
}
