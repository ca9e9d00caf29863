//! What changes during a run, each piece with one owner.

use super::accepted::Accepted;
use super::attempt::Attempt;
use super::interruption::Interruption;
use crate::contact::ContactState;
use crate::run::diagnosis::Refusal;
use crate::run::recorder::Recorder;
use crate::run::step_size::StepControl;
use crate::run::stop_watch::StopWatch;
use crate::sensitivity::Sensitivity;

/// Everything of a run that changes. It is borrowed for a moment at a time: never across a call of PETSc that can call
/// back.
pub(in crate::run) struct Progress {
    pub accepted: Accepted,
    pub attempt: Attempt,
    /// Refused solves of the step being tried.
    pub refusals: Vec<Refusal>,
    /// The derivatives, if the case asks for any.
    pub sensitivity: Option<Sensitivity>,
    pub control: StepControl,
    pub stop_watch: StopWatch,
    pub recorder: Recorder,
    /// States of this rank's contact points at the last iteration shown.
    pub shown: Vec<ContactState>,
    pub interruption: Option<Interruption>,
}
