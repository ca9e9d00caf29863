//! How a run ended, with everything that is to be said about it.

use std::path::PathBuf;

use petsc::TsReason;

use super::diagnosis::Refusal;
use super::ledger::Counts;
use super::recorder::Recorder;
use super::setup::defaults;
use super::simulation::Interruption;
use super::springback::Springback;
use crate::case::Case;
use crate::sensitivity::ReleasedSlopes;
use crate::text::number;

/// How a run ended.
pub struct Outcome {
    /// The files, still open, and the rows of all accepted steps.
    pub recorder: Recorder,
    /// Work done.
    pub counts: Counts,
    /// Why it stopped before the end, if it did.
    pub failure: Option<Failure>,
    /// What ended it on request before its end, if something did.
    pub interruption: Option<Interruption>,
    /// Angles after the tools vanish at the turning point and at the end, where they could be had.
    pub springbacks: Vec<Springback>,
    /// What the derivatives cost, and those of the released angles; the rows are the recorder's.
    pub sensitivity: SensitivityEnd,
    /// PETSc's direct solver in use.
    pub factor_solver: Option<String>,
    /// Unknowns over all ranks.
    pub unknowns: usize,
    /// Processor time of all ranks, s; with that of the runs it went on from.
    pub cpu_seconds: f64,
    /// Time on the clock, s; likewise.
    pub wall_seconds: f64,
}

/// The end of the derivatives; all empty without `-sensitivity`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensitivityEnd {
    /// Counts and processor times of all ranks, in the order of [`crate::sensitivity::Cost`].
    pub cost: [f64; 4],
    /// Of the angles after the tools vanish.
    pub released: Vec<ReleasedSlopes>,
}

/// The step that could not be solved.
pub struct Failure {
    /// Time of the last accepted step, ms.
    pub time: f64,
    /// Depth of the punch there, mm.
    pub depth: f64,
    /// PETSc's reason in words.
    pub reason: String,
    /// The solves that were refused, longest step first.
    pub refusals: Vec<Refusal>,
    /// Options of PETSc's that may be to blame, and what they do.
    pub suspects: Vec<(String, &'static str)>,
    /// The state before the step, to go on from with other options.
    pub checkpoint: Option<PathBuf>,
}

impl Failure {
    /// Where and why, in one sentence.
    pub fn sentence(&self) -> String {
        let last = self
            .refusals
            .last()
            .map_or_else(String::new, |r| format!("; last tried: {r}"));
        format!("at t = {:.6} ms: {}{last}", self.time, self.reason)
    }
}

/// Why no further step could be made. The time stepper only knows that its last attempts were refused.
pub(super) fn why(case: &Case, reason: TsReason, refusals: &[Refusal]) -> String {
    let (Some(first), Some(last)) = (refusals.first(), refusals.last()) else {
        return reason.sentence().to_owned();
    };
    let tried = match refusals.len() {
        1 => format!(
            "the solve of the next step, {} ms long, was refused",
            number(first.dt)
        ),
        count => format!(
            "{count} solves of the next step were refused, {} down to {} ms long",
            number(first.dt),
            number(last.dt)
        ),
    };
    if last.dt * defaults::CUT_BACK < case.stepping.dt_min {
        let least = number(case.stepping.dt_min);
        format!("{tried}; a shorter one would be below -dt_min {least} ms")
    } else {
        format!("{tried}; {}", reason.sentence())
    }
}
