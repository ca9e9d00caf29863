//! When a run writes a checkpoint, and when it is asked to end: steps, the clock, signals.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use mpi::collective::SystemOperation;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGUSR1};

use crate::case::Resuming;

/// Signals that ask a run to end after the present step.
const SIGNALS: [(i32, &str); 4] = [
    (SIGINT, "SIGINT"),
    (SIGTERM, "SIGTERM"),
    (SIGUSR1, "SIGUSR1"),
    (SIGHUP, "SIGHUP"),
];
/// Before the wall limit, the longest step and the longest checkpoint until now are kept in hand this many times.
const RESERVE: u32 = 2;
/// What the end of a run takes besides, at least.
const LEAST_RESERVE: Duration = Duration::from_millis(300);

/// What is to be done after a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    GoOn,
    Save,
    Stop(StopCause),
}

/// Why a run ends before its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopCause {
    /// A signal was received.
    Signal(&'static str),
    /// The time on the clock is nearly used up.
    WallLimit,
}

impl StopCause {
    /// In words.
    pub fn sentence(self) -> String {
        match self {
            Self::Signal(name) => format!("the run was asked to end by {name}"),
            Self::WallLimit => "the time that -wall_limit allows is nearly used up".to_owned(),
        }
    }
}

/// Whether the process was started with this signal ignored, where Linux says so.
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok());
    mask.is_some_and(|bits| (bits >> (signal - 1)) & 1 == 1)
}

/// Looks at the clock and at signals between steps.
pub(super) struct StopWatch {
    wishes: Resuming,
    /// Place in [`SIGNALS`] of the last signal received, from 1.
    signal: Arc<AtomicUsize>,
    start: Instant,
    saved: Instant,
    steps_since: usize,
    step_began: Instant,
    longest_step: Duration,
    longest_save: Duration,
}

impl StopWatch {
    /// From here on the signals do not end the process at once. The clock of the limit began at `start`.
    ///
    /// # Errors
    /// If a signal cannot be caught.
    pub fn new(wishes: &Resuming, start: Instant) -> std::io::Result<Self> {
        let signal = Arc::new(AtomicUsize::new(0));
        for (place, (number, _)) in SIGNALS.iter().enumerate() {
            // Under nohup the run goes on without its terminal.
            if *number == SIGHUP && is_ignored(SIGHUP) {
                continue;
            }
            signal_hook::flag::register_usize(*number, Arc::clone(&signal), place + 1)?;
        }
        let now = Instant::now();
        Ok(Self {
            wishes: wishes.clone(),
            signal,
            start,
            saved: now,
            steps_since: 0,
            step_began: now,
            longest_step: Duration::ZERO,
            longest_save: Duration::ZERO,
        })
    }

    /// Whether checkpoints are wanted at all, not only when the run is asked to end.
    pub fn saves_regularly(&self) -> bool {
        self.wishes.checkpoint_every > 0 || self.wishes.checkpoint_minutes > 0.0
    }

    /// What is to be done after an accepted step, the same on every rank: rank 0 has the clock, any rank may have got
    /// the signal. Collective.
    pub fn after_step(&mut self, comm: &SimpleCommunicator) -> Order {
        self.steps_since += 1;
        self.longest_step = self.longest_step.max(self.step_began.elapsed());
        self.step_began = Instant::now();
        let signal = self.signal.load(Ordering::Relaxed);
        let mine = match (signal, comm.rank()) {
            (0, 0) if self.out_of_time() => 2,
            (0, 0) if self.save_is_due() => 1,
            (0, _) => 0,
            (place, _) => 2 + place as u64,
        };
        let mut all = 0;
        comm.all_reduce_into(&mine, &mut all, SystemOperation::max());
        match all {
            0 => Order::GoOn,
            1 => Order::Save,
            2 => Order::Stop(StopCause::WallLimit),
            place => Order::Stop(StopCause::Signal(SIGNALS[place as usize - 3].1)),
        }
    }

    fn out_of_time(&self) -> bool {
        let reserve = (RESERVE * (self.longest_step + self.longest_save)).max(LEAST_RESERVE);
        let end = self.start.elapsed() + reserve;
        self.wishes
            .wall_limit
            .is_some_and(|limit| end.as_secs_f64() >= limit)
    }

    fn save_is_due(&self) -> bool {
        let Resuming {
            checkpoint_every: every,
            checkpoint_minutes: minutes,
            ..
        } = self.wishes;
        (every > 0 && self.steps_since >= every)
            || (minutes > 0.0 && self.saved.elapsed().as_secs_f64() >= 60.0 * minutes)
    }

    /// Notes that a checkpoint was written, which began at `began`.
    pub fn saved(&mut self, began: Instant) {
        self.longest_save = self.longest_save.max(began.elapsed());
        self.steps_since = 0;
        self.saved = Instant::now();
        self.step_began = self.saved;
    }
}
