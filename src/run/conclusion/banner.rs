//! The last words of a run on the terminal.

use super::angles::angles;
use crate::case::Case;
use crate::output::banner::banner;
use crate::output::{Diagnosis, Summary};
use crate::run::outcome::Outcome;
use crate::run::simulation::Interruption;
use crate::run::stop_watch::StopCause;

/// The banner of a run: how it ended, where and why if it did not finish, what can be done, and what it took.
pub(super) fn last_words(case: &Case, summary: &Summary, outcome: &Outcome) -> String {
    let mut facts = Vec::new();
    if let Some(diagnosis) = &summary.diagnosis {
        facts.extend(failed(diagnosis, outcome));
    }
    if let Some(stop) = &outcome.interruption {
        facts.extend(interrupted(case, stop, outcome));
        facts.extend(code_of_mpirun(stop.cause));
    }
    facts.extend(named("note", &summary.notes));
    facts.extend(effort(case, outcome));
    banner(summary.status, &summary.headline(), &facts)
}

/// A fact of the banner: its name, and what is to be said.
type Fact = (&'static str, String);

/// A signal to mpirun that makes it end its ranks hides their code behind its own.
fn code_of_mpirun(cause: StopCause) -> Option<Fact> {
    const SET_BY_MPIRUN: [&str; 2] = ["OMPI_COMM_WORLD_SIZE", "PMIX_RANK"];
    let started = SET_BY_MPIRUN
        .iter()
        .any(|name| std::env::var_os(name).is_some());
    let ends_ranks = matches!(cause, StopCause::Signal("SIGTERM" | "SIGINT" | "SIGHUP"));
    (started && ends_ranks).then(|| {
        let words = "this program ends with 3; mpirun, if the signal went to it, with a code of its own (Open MPI 4.1: 1)";
        ("code", words.to_owned())
    })
}

fn interrupted(case: &Case, stop: &Interruption, outcome: &Outcome) -> [Fact; 3] {
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
    [
        ("where", place),
        ("why", stop.cause.sentence()),
        ("resume", resume),
    ]
}

fn failed(diagnosis: &Diagnosis, outcome: &Outcome) -> Vec<Fact> {
    let mut facts = vec![
        ("where", diagnosis.place.clone()),
        ("why", diagnosis.cause.clone()),
    ];
    facts.extend(named("seen", &diagnosis.observed));
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
    facts
}

fn effort(case: &Case, outcome: &Outcome) -> Vec<Fact> {
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

/// The same name before each line; none before one that stands for others.
fn named(name: &'static str, lines: &[String]) -> Vec<Fact> {
    let shown = |line: &String| if line.starts_with("...") { "" } else { name };
    lines
        .iter()
        .map(|line| (shown(line), line.clone()))
        .collect()
}
