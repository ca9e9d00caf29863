//! The end of a run: verdicts, summary, figures, and the word whether it holds.

use std::collections::BTreeMap;

use mpi::traits::Communicator;
use petsc::Session;

use super::blas::Blas;
use super::diagnosis::{diagnose, notes};
use super::judgement::{BALANCE_LIMIT, CONE_LIMIT, PULL_LIMIT, judge};
use super::{Interruption, Outcome, RunError, inputs, unread};
use crate::case::Case;
use crate::output::monitor::{failed_banner, finished_banner, interrupted_banner};
use crate::output::number;
use crate::output::summary::{Certificates, Counts, Provenance, Status, Summary, Timing};
use crate::output::{Diagnosis, Report, StepRecord, VerdictTable};

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
    let verdicts = judge(case, outcome.recorder.records(), to_the_end)?;
    let reference = case.reference_force()?;
    let summary = summarise(case, &outcome, session, comm, verdicts.clone());
    if comm.rank() == 0 {
        summary.write(outcome.recorder.folder().summary())?;
        outcome.recorder.force_figure(&reference)?;
    }
    let mut text = if verdicts.rows.is_empty() {
        "\n".to_owned()
    } else {
        format!("\n{}\n", verdicts.text())
    };
    text.push_str(&unread::warnings()?);
    let (banner, ending) = match (&summary.diagnosis, &outcome.interruption) {
        (Some(diagnosis), _) => (
            failed(case, diagnosis, &outcome, &summary.notes),
            Ending::DoesNotHold,
        ),
        (None, Some(stop)) => (
            interrupted(case, stop, &outcome, &summary.notes),
            Ending::Interrupted,
        ),
        (None, None) => {
            let holds = verdicts.failures() == 0;
            let ending = if holds {
                Ending::Holds
            } else {
                Ending::DoesNotHold
            };
            (finished(case, &outcome, &verdicts, &summary.notes), ending)
        }
    };
    text.push_str(&banner);
    outcome.recorder.show(&text);
    // The page is made from the files of the run, which all ranks must have closed.
    let (folder, records) = outcome.recorder.close();
    if comm.rank() == 0 {
        let report = Report {
            case,
            summary: &summary,
            records: &records,
            reference: &reference,
        };
        report.write(&folder)?;
    }
    Ok(ending)
}

fn summarise(
    case: &Case,
    outcome: &Outcome,
    session: &Session,
    comm: &impl Communicator,
    verdicts: VerdictTable,
) -> Summary {
    let records = outcome.recorder.records();
    let mut certificates = Certificates::default();
    records
        .iter()
        .for_each(|record| certificates.observe(record));
    let (status, reason) = match (&outcome.failure, &outcome.interruption) {
        (Some(failure), _) => (Status::NotConverged, Some(failure.sentence())),
        (None, Some(stop)) => (Status::Interrupted, Some(stop.sentence())),
        (None, None) => (Status::Finished, None),
    };
    let text = |value: &str| value.to_owned();
    let angles = angles(case, outcome);
    let by_name = |value: fn(&NamedAngle) -> f64| {
        let pair = |angle: &NamedAngle| (angle.name.clone(), value(angle));
        angles.iter().map(pair).collect()
    };
    Summary {
        status,
        reason,
        diagnosis: outcome
            .failure
            .as_ref()
            .map(|failure| diagnose(case, failure, outcome.counts.steps)),
        notes: notes(case, records),
        last: records.last().copied(),
        angles_deg: by_name(|angle| angle.degrees),
        angle_fit_residuals_mm: by_name(|angle| angle.fit_residual),
        counts: Counts {
            steps: outcome.counts.steps,
            refused_solves: outcome.counts.refused,
            newton_iterations: outcome.counts.newton,
            linear_solves: outcome.counts.newton,
        },
        tolerances: BTreeMap::from([
            (text("newton_residual_mm"), case.stepping.newton_tolerance),
            (
                text("penetration_mm"),
                case.discretisation.penetration_limit,
            ),
            (text("pull"), PULL_LIMIT),
            (text("balance"), BALANCE_LIMIT),
            (text("cone"), CONE_LIMIT),
        ]),
        worst: certificates.worst(),
        verdicts,
        provenance: Provenance {
            version: text(env!("CARGO_PKG_VERSION")),
            git_revision: text(env!("SSNP155_REVISION")),
            petsc_version: session.version(),
            mpi_ranks: comm.size().unsigned_abs(),
            build: BTreeMap::from([
                (text("petsc_headers"), text(env!("SSNP155_PETSC"))),
                (
                    text("direct_solver"),
                    outcome.factor_solver.clone().unwrap_or_default(),
                ),
                (text("unknowns"), outcome.unknowns.to_string()),
                (
                    text("blas"),
                    Blas::loaded().map_or_else(|| text("not known"), |blas| blas.to_string()),
                ),
            ]),
            inputs: inputs::checksums(case),
            options: case
                .options()
                .into_iter()
                .map(|(name, value)| (text(name), value))
                .collect(),
        },
        timing: Timing {
            cpu_s: outcome.cpu_seconds,
            wall_s: outcome.wall_seconds,
        },
    }
}

/// An angle of the run, with a name that says how the tools went away.
struct NamedAngle {
    name: String,
    degrees: f64,
    /// Root mean square distance of the arm from its straight fit, mm.
    fit_residual: f64,
}

fn angles(case: &Case, outcome: &Outcome) -> Vec<NamedAngle> {
    let motion = case.loading.motion();
    let records = outcome.recorder.records();
    let at = |time: f64| {
        records
            .iter()
            .find(|record| (record.t_ms - time).abs() < 1e-6)
    };
    let recorded = |name: &str, record: &StepRecord| NamedAngle {
        name: name.to_owned(),
        degrees: record.angle_deg,
        fit_residual: record.angle_fit_residual_mm,
    };
    let mut angles = Vec::new();
    if let Some(record) = at(motion.time_load) {
        angles.push(recorded("full stroke", record));
    }
    if let Some(record) = at(motion.end()) {
        angles.push(recorded("end of the motion", record));
    }
    for springback in &outcome.springbacks {
        let depth = number(motion.depth(springback.t_ms));
        angles.push(NamedAngle {
            name: format!("tools vanish at {depth} mm"),
            degrees: springback.released_angle_deg,
            fit_residual: springback.fit_residual_mm,
        });
    }
    angles
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

fn finished(case: &Case, outcome: &Outcome, verdicts: &VerdictTable, notes: &[String]) -> String {
    let title = match verdicts.failures() {
        0 => "every verdict holds".to_owned(),
        1 => "but 1 verdict does not hold".to_owned(),
        count => format!("but {count} verdicts do not hold"),
    };
    let mut facts = named("note", notes);
    facts.extend(effort(case, outcome));
    finished_banner(&title, &facts)
}

fn interrupted(case: &Case, stop: &Interruption, outcome: &Outcome, notes: &[String]) -> String {
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

fn failed(case: &Case, diagnosis: &Diagnosis, outcome: &Outcome, notes: &[String]) -> String {
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

/// The same name before each line; none before one that tells of others left out.
fn named(name: &'static str, lines: &[String]) -> Vec<(&'static str, String)> {
    let shown = |line: &String| if line.starts_with("...") { "" } else { name };
    lines
        .iter()
        .map(|line| (shown(line), line.clone()))
        .collect()
}
