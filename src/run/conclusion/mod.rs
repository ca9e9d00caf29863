//! In: the outcome of a run. Out: verdicts, summary, figures, report, and the word whether it holds.
//! Never: another step of the run, or how a file is written.

mod angles;
mod banner;
mod inputs;
mod judgement;
mod sensitivity;
mod summary;

use mpi::traits::Communicator;
use petsc::Session;

use super::error::RunError;
use super::outcome::Outcome;
use super::recorder::right_halves;
use super::setup::unread;
use crate::case::Case;
use crate::output::Report;
use crate::output::summary::Status;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// It finished, and every verdict holds.
    Holds,
    /// It could not be solved to the end, or a verdict does not hold.
    DoesNotHold,
    /// It was ended on request, and can go on.
    Interrupted,
}

/// Judges, writes and shows what came out. Collective.
///
/// # Errors
/// If a file cannot be written.
pub fn conclude(
    case: &Case,
    mut outcome: Outcome,
    session: &Session,
    comm: &impl Communicator,
) -> Result<Ending, RunError> {
    let to_the_end = outcome.failure.is_none() && outcome.interruption.is_none();
    let verdicts = judgement::judge(case, outcome.recorder.records(), to_the_end)?;
    let reference = case.reference_force()?;
    let summary = summary::summarise(case, &outcome, session, comm, verdicts.clone())?;
    if comm.rank() == 0 {
        summary.write(outcome.recorder.folder().summary())?;
    }
    let mut text = if verdicts.rows.is_empty() {
        "\n".to_owned()
    } else {
        format!("\n{}\n", verdicts.text())
    };
    text.push_str(&unread::warnings()?);
    text.push_str(&banner::last_words(case, &summary, &outcome));
    // Who is asked to end may be killed soon after, so the figures come last then. A good end is said when all is written.
    let interrupted = summary.status == Status::Interrupted;
    if interrupted {
        outcome.recorder.tell(&text);
    }
    if comm.rank() == 0 {
        outcome.recorder.force_figure(&reference)?;
        outcome.recorder.derivative_figure()?;
    }
    if !interrupted {
        outcome.recorder.tell(&text);
    }
    // The page is made from the files of the run, which all ranks must have closed.
    let (folder, records) = outcome.recorder.close();
    if comm.rank() == 0 {
        let report = Report {
            case,
            summary: &summary,
            records: &records,
            reference: &reference,
            tools: right_halves([Some(&case.die()), Some(&case.punch())]),
        };
        report.write(&folder)?;
    }
    Ok(match summary.status {
        Status::Interrupted => Ending::Interrupted,
        Status::Finished if verdicts.failures() == 0 => Ending::Holds,
        Status::Finished | Status::NotConverged => Ending::DoesNotHold,
    })
}
