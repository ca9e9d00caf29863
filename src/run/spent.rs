//! What a run has cost so far, including the runs it goes on from.

use std::time::Instant;

use cpu_time::ProcessTime;
use mpi::collective::SystemOperation;
use mpi::topology::SimpleCommunicator;
use mpi::traits::CommunicatorCollectives;

/// Time of processors and on the clock.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spent {
    start: Instant,
    /// Of the runs before this one, s.
    earlier: [f64; 2],
}

impl Spent {
    /// The clock began at `start`; the runs before took `earlier` (s).
    pub fn new(start: Instant, earlier: [f64; 2]) -> Self {
        Self { start, earlier }
    }

    /// Time of all processors, and on the clock, s. Collective.
    pub fn so_far(&self, comm: &SimpleCommunicator) -> [f64; 2] {
        let mine = ProcessTime::now().as_duration().as_secs_f64();
        let mut all = 0.0;
        comm.all_reduce_into(&mine, &mut all, SystemOperation::sum());
        let [processors, clock] = self.earlier;
        [processors + all, clock + self.start.elapsed().as_secs_f64()]
    }
}
