//! In: what is seen of the solves, and the rows of a run. Out: why a solve was refused and a run stopped, what the user
//! can do about it, and what else should be known about it.
//! Never: a change to the run, or how the text is laid out.

mod cause;
mod notes;
mod refusal;
mod remedies;
mod residual_history;
mod solve_watch;

use super::outcome::Failure;
use crate::case::{Case, CaseError};
use crate::output::Diagnosis;
use cause::Cause;
use remedies::{Stopped, remedies};

pub(super) use notes::notes;
pub use refusal::Refusal;
pub use residual_history::ResidualHistory;
pub use solve_watch::Chattering;
pub(super) use solve_watch::SolveWatch;

/// Most refused solves of the last step that are listed: this many first ones and this many last ones.
const FIRST: usize = 1;
const LAST: usize = 3;

/// What is known about the end of a run that did not finish.
///
/// # Errors
/// None unless the table of options is broken, which the tests exclude.
pub(super) fn diagnose(case: &Case, failure: &Failure, steps: u64) -> Result<Diagnosis, CaseError> {
    let reference = Case::reference()?;
    let (cause, typical) = typical(&failure.refusals).unzip();
    let words = match cause {
        Some(Cause::Matrix) if !failure.suspects.is_empty() => {
            "The linear solve that the options choose did not succeed."
        }
        cause => cause.map_or("", Cause::words),
    };
    let suspects = failure.suspects.iter();
    let suspects = suspects.map(|(option, effect)| format!("leave out {option}: {effect}"));
    let advice = |cause| {
        remedies(&Stopped {
            case,
            reference: &reference,
            cause,
            refusals: &failure.refusals,
        })
    };
    Ok(Diagnosis {
        place: format!(
            "after step {steps}, t = {:.4} ms, punch down by {:.4} mm",
            failure.time, failure.depth
        ),
        cause: format!("{}. {words}", failure.reason).trim_end().to_owned(),
        observed: typical.map_or_else(Vec::new, |refusal| observed(case, refusal)),
        tried: tried(&failure.refusals),
        remedies: suspects
            .chain(cause.map_or_else(Vec::new, advice))
            .collect(),
    })
}

/// The most frequent cause, and the last solve it kept from converging; of equally frequent causes the later one. The
/// shortest step alone may be an exception.
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
    let hidden = refusals.len().saturating_sub(FIRST + LAST);
    if hidden < 2 {
        return refusals.iter().map(Refusal::to_string).collect();
    }
    let mut lines: Vec<_> = refusals[..FIRST].iter().map(Refusal::to_string).collect();
    lines.push(format!("... {hidden} more ..."));
    lines.extend(refusals[FIRST + hidden..].iter().map(Refusal::to_string));
    lines
}
