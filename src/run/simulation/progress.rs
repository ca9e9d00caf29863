//! What changes during a run, each piece with one owner: the last accepted state, the attempt at the next step, and
//! what goes on beside them.

use petsc::{Alpha2State, Vector};

use super::{Counts, Interruption};
use crate::contact::ContactState;
use crate::run::diagnosis::{Refusal, SolveWatch};
use crate::run::ledger::Ledger;
use crate::run::newton::{Damping, TangentInertia};
use crate::run::recorder::Recorder;
use crate::run::springback::Springback;
use crate::run::step_size::StepControl;
use crate::run::stop_watch::StopWatch;
use crate::system::{ElementFailure, History};

/// Everything of a run that changes. It is borrowed for a moment at a time: never across a call of PETSc that can call
/// back.
pub(in crate::run) struct Progress {
    pub accepted: Accepted,
    pub attempt: Attempt,
    /// Refused solves of the step being tried.
    pub refusals: Vec<Refusal>,
    pub control: StepControl,
    pub stop_watch: StopWatch,
    pub recorder: Recorder,
    /// States of this rank's contact points at the last iteration shown.
    pub shown: Vec<ContactState>,
    pub interruption: Option<Interruption>,
}

/// The run after its last accepted step.
pub(in crate::run) struct Accepted {
    /// Time, ms.
    pub time: f64,
    pub unknowns: Vector,
    /// What the sheet remembers there.
    pub history: History,
    /// None at the start and where the punch turns.
    pub before: Option<Before>,
    /// Velocity and acceleration; none in statics.
    pub rates: Option<Alpha2State>,
    pub ledger: Ledger,
    pub counts: Counts,
    pub springbacks: Vec<Springback>,
}

/// The unknowns before the last accepted step, and its length, ms.
pub(in crate::run) struct Before {
    pub unknowns: Vector,
    pub dt: f64,
}

/// One nonlinear solve: it begins before the solve and is over when the step is accepted or refused.
#[derive(Default)]
pub(in crate::run) struct Attempt {
    /// Length of the step, ms.
    pub dt: f64,
    /// Time it is to reach, ms.
    pub time: f64,
    /// Largest displacement expected of it, mm.
    pub expected: f64,
    pub damping: Damping,
    pub inertia: TangentInertia,
    pub watch: SolveWatch,
    /// The element of this rank that could not be evaluated.
    pub failure: Option<ElementFailure>,
}

impl Accepted {
    /// The start of a run.
    pub fn start(unknowns: Vector, history: History) -> Self {
        Self {
            time: 0.0,
            unknowns,
            history,
            before: None,
            rates: None,
            ledger: Ledger::default(),
            counts: Counts::default(),
            springbacks: Vec::new(),
        }
    }
}

impl Attempt {
    /// At a step to `time` of length `dt` (ms).
    pub fn new(time: f64, dt: f64, expected: f64) -> Self {
        Self {
            dt,
            time,
            expected,
            ..Self::default()
        }
    }
}
