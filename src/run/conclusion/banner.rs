//! The last words of a run on the terminal.

use super::angles::angles;
use crate::case::Case;
use crate::output::monitor::{failed_banner, finished_banner, interrupted_banner};
use crate::output::{Diagnosis, VerdictTable};
use crate::run::outcome::Outcome;
use crate::run::simulation::Interruption;

/// Of one that came to its end.
pub(super) fn finished(
    case: &Case,
    outcome: &Outcome,
    verdicts: &VerdictTable,
    notes: &[String],
) -> String {
    let title = match verdicts.failures() {
        0 => "every verdict holds".to_owned(),
        1 => "but 1 verdict does not hold".to_owned(),
        count => format!("but {count} verdicts do not hold"),
    };
    let mut facts = named("note", notes);
    facts.extend(effort(case, outcome));
    finished_banner(&title, &facts)
}

/// Of one that was ended on request.
pub(super) fn interrupted(
    case: &Case,
    stop: &Interruption,
    outcome: &Outcome,
    notes: &[String],
) -> String {
    let place = format!(
        "after step {}, t = {:.4} ms, punch down by {:.4} mm",
        outcome.counts.steps,
        stop.time,
        case.loading.motion().depth(stop.time)
    );
    let resume = format!(
        "the same options with -restart, from {}",
        stop.checkpoint.display()
    );
    let mut facts = named("note", notes);
    facts.extend(effort(case, outcome));
    interrupted_banner(&place, &stop.cause.sentence(), &resume, &facts)
}

/// Of one that could not be solved to its end.
pub(super) fn failed(
    case: &Case,
    diagnosis: &Diagnosis,
    outcome: &Outcome,
    notes: &[String],
) -> String {
    let mut facts = named("seen", &diagnosis.observed);
    facts.extend(named("tried", &diagnosis.tried));
    facts.extend(named("try", &diagnosis.remedies));
    if let Some(path) = outcome.failure.as_ref().and_then(|f| f.checkpoint.as_ref()) {
        let advice = format!("with what is to be tried, -restart {}", path.display());
        facts.push(("resume", advice));
    }
    facts.push((
        "read",
        "docs/it-does-not-converge.md, and report.html beside the results".to_owned(),
    ));
    facts.extend(named("note", notes));
    facts.extend(effort(case, outcome));
    failed_banner(&diagnosis.place, &diagnosis.cause, &facts)
}

fn effort(case: &Case, outcome: &Outcome) -> Vec<(&'static str, String)> {
    let counts = &outcome.counts;
    let angles = angles(case, outcome)
        .into_iter()
        .map(|angle| format!("{:.2} {}", angle.degrees, angle.name))
        .collect::<Vec<_>>()
        .join(", ");
    let mut facts = Vec::new();
    if !angles.is_empty() {
        facts.push(("angles", format!("deg: {angles}")));
    }
    facts.extend([
        (
            "steps",
            format!(
                "{} accepted, {} solves refused",
                counts.steps, counts.refused
            ),
        ),
        (
            "Newton",
            format!(
                "{} iterations, {} unknowns",
                counts.newton, outcome.unknowns
            ),
        ),
        (
            "time",
            format!(
                "{:.1} s of processors, {:.1} s",
                outcome.cpu_seconds, outcome.wall_seconds
            ),
        ),
        (
            "results",
            outcome.recorder.folder().path().display().to_string(),
        ),
    ]);
    facts
}

/// The same name before each line; none before one that tells of others left out.
fn named(name: &'static str, lines: &[String]) -> Vec<(&'static str, String)> {
    let shown = |line: &String| if line.starts_with("...") { "" } else { name };
    lines
        .iter()
        .map(|line| (shown(line), line.clone()))
        .collect()
}
