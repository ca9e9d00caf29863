//! Adds up what a run spends and gains: counts, processor time, and the work of the punch.

use std::time::Instant;

use cpu_time::ProcessTime;
use mpi::collective::SystemOperation;
use mpi::topology::SimpleCommunicator;
use mpi::traits::CommunicatorCollectives;

use crate::output::StepRecord;
use crate::output::record::Step;
use crate::system::{Measures, Work};

pub(super) use crate::output::record::LEAST_FORCE;
pub use crate::output::record::StepEffort;

/// Work done over the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Accepted steps.
    pub steps: u64,
    /// Solves refused.
    pub refused: u64,
    /// Newton iterations of all solves; each is one linear solve.
    pub newton: u64,
}

/// Time of processors and on the clock that a run takes, with the runs it goes on from.
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

/// Numbers a ledger remembers.
pub(super) const LEDGER_NUMBERS: usize = 6;

/// The work of the punch and where it went, and what they are summed from.
#[derive(Clone, Debug, Default)]
pub struct Ledger {
    depth: f64,
    force: f64,
    external_work: f64,
    work: Work,
}

impl Ledger {
    /// Punch force of the last row, N.
    pub fn force(&self) -> f64 {
        self.force
    }

    /// What the ledger remembers: depth (mm), force (N) and work of the punch, and of internal, inertia and contact
    /// forces (mJ).
    pub(super) fn memory(&self) -> [f64; LEDGER_NUMBERS] {
        let Self {
            depth,
            force,
            external_work,
            work:
                Work {
                    internal,
                    inertia,
                    contact,
                },
        } = *self;
        [depth, force, external_work, internal, inertia, contact]
    }

    /// Goes on with the memory of another ledger.
    pub(super) fn recall(&mut self, memory: [f64; LEDGER_NUMBERS]) {
        let [depth, force, external_work, internal, inertia, contact] = memory;
        *self = Self {
            depth,
            force,
            external_work,
            work: Work {
                internal,
                inertia,
                contact,
            },
        };
    }

    /// The row of an accepted step and its `work`. The punch's work is the trapezoidal sum of its force over its
    /// travel: second order in the step.
    pub fn record(&mut self, effort: &StepEffort, measures: &Measures, work: &Work) -> StepRecord {
        let force = measures.punch_force;
        self.external_work += 0.5 * (self.force + force) * (effort.depth - self.depth);
        (self.force, self.depth) = (force, effort.depth);
        self.work = self.work.and(*work);
        StepRecord::of(&Step {
            effort,
            measures,
            external_work: self.external_work,
            work: &self.work,
        })
    }
}
