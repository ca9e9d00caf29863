//! In: what is seen of the solves, and the rows of a run. Out: why a solve was refused and a run stopped, what the user
//! can do about it, and what else should be known of it.
//! Never: a change to the run, or how the text is laid out.

mod notes;
mod refusal;
mod remedies;
mod solve_watch;

use petsc::SnesReason;

use super::Failure;
use crate::case::Case;
use crate::output::Diagnosis;

pub(super) use notes::notes;
pub use refusal::Refusal;
pub(super) use solve_watch::SolveWatch;
pub use solve_watch::{Course, Flip};

/// What kept the last solves from converging.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cause {
    /// The matrix could not be factorised.
    Matrix,
    /// An element turned over.
    Element,
    /// There were not enough iterations.
    Iterations,
    /// Contact points open and close.
    Closing,
    /// Contact points stick and slip.
    Slipping,
    /// The residual does not fall, and no contact point is to blame.
    Residual,
}

impl Cause {
    fn of(refusal: &Refusal) -> Self {
        let flips = |kind: Flip| refusal.flips.iter().any(|(_, flip)| *flip == kind);
        if refusal.element.is_some() {
            Self::Element
        } else if refusal.reason == SnesReason::DivergedLinearSolve {
            Self::Matrix
        } else if matches!(
            refusal.course,
            Course::Short | Course::Falls(_) | Course::Small
        ) {
            Self::Iterations
        } else if flips(Flip::Closing) {
            Self::Closing
        } else if flips(Flip::Slipping) {
            Self::Slipping
        } else {
            Self::Residual
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Matrix => "Its matrix cannot be factorised: something is not held.",
            Self::Element => "An element turned over on the way.",
            Self::Iterations => "It was on its way, but its iterations were used up.",
            Self::Closing => {
                "Contact points open and close from iteration to iteration, and the residual does not fall."
            }
            Self::Slipping => {
                "Contact points stick and slip from iteration to iteration, and the residual does not fall."
            }
            Self::Residual => {
                "The residual does not fall, and contact does not change: the material or the mesh keeps it up."
            }
        }
    }
}

/// What is known about the end of a run that did not finish.
pub(super) fn diagnose(case: &Case, failure: &Failure, steps: u64) -> Diagnosis {
    let (cause, typical) = typical(&failure.refusals).unzip();
    let words = cause.map_or("", Cause::words);
    Diagnosis {
        place: format!(
            "after step {steps}, t = {:.4} ms, punch down by {:.4} mm",
            failure.time, failure.depth
        ),
        cause: format!("{}. {words}", failure.reason).trim_end().to_owned(),
        observed: typical.map_or_else(Vec::new, |refusal| observed(case, refusal)),
        tried: tried(&failure.refusals),
        remedies: cause.map_or_else(Vec::new, |cause| {
            remedies::remedies(case, cause, &failure.refusals)
        }),
    }
}

/// The most frequent cause, and the last refusal it is behind; of equally frequent ones the later. The shortest step
/// alone may be a chance.
fn typical(refusals: &[Refusal]) -> Option<(Cause, &Refusal)> {
    let count = |cause: Cause| {
        refusals
            .iter()
            .filter(|refusal| Cause::of(refusal) == cause)
            .count()
    };
    refusals
        .iter()
        .map(|refusal| (Cause::of(refusal), refusal))
        .max_by_key(|(cause, _)| count(*cause))
}

fn observed(case: &Case, refusal: &Refusal) -> Vec<String> {
    let mut seen = refusal.seen();
    if let (Some(element), Some(first)) = (&refusal.element, seen.first_mut()) {
        let nx = case.discretisation.nx;
        let along = (0.5 + (element.element % nx) as f64) * case.sheet.half_length() / nx as f64;
        first.push_str(&format!(
            "; it lies {along:.2} mm along the sheet from its middle, in layer {} of {} from below",
            element.element / nx + 1,
            case.discretisation.ny
        ));
    }
    seen
}

/// The refused solves, the first and the last ones if there are many.
fn tried(refusals: &[Refusal]) -> Vec<String> {
    const FIRST: usize = 1;
    const LAST: usize = 3;
    let hidden = refusals.len().saturating_sub(FIRST + LAST);
    if hidden < 2 {
        return refusals.iter().map(Refusal::to_string).collect();
    }
    let mut lines: Vec<_> = refusals[..FIRST].iter().map(Refusal::to_string).collect();
    lines.push(format!("... {hidden} more ..."));
    lines.extend(refusals[FIRST + hidden..].iter().map(Refusal::to_string));
    lines
}
