//! The end of a run: verdicts, summary, figures, and the word whether it holds.

use std::collections::BTreeMap;

use mpi::traits::Communicator;
use petsc::Session;

use super::blas::Blas;
use super::judgement::{BALANCE_LIMIT, PULL_LIMIT, judge};
use super::{Failure, Interruption, Outcome, Refusal, RunError, unread};
use crate::case::Case;
use crate::output::monitor::{failed_banner, finished_banner, interrupted_banner};
use crate::output::number;
use crate::output::summary::{Certificates, Counts, Provenance, Status, Summary, Timing};
use crate::output::{StepRecord, VerdictTable};

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
    if comm.rank() == 0 {
        let summary = summarise(case, &outcome, session, comm, verdicts.clone());
        summary.write(outcome.recorder.folder().summary())?;
        outcome.recorder.force_figure()?;
    }
    let mut text = if verdicts.rows.is_empty() {
        "\n".to_owned()
    } else {
        format!("\n{}\n", verdicts.text())
    };
    text.push_str(&unread::warnings()?);
    let (banner, ending) = match (&outcome.failure, &outcome.interruption) {
        (Some(failure), _) => (failed(case, failure, &outcome), Ending::DoesNotHold),
        (None, Some(stop)) => (interrupted(case, stop, &outcome), Ending::Interrupted),
        (None, None) => {
            let holds = verdicts.failures() == 0;
            let ending = if holds {
                Ending::Holds
            } else {
                Ending::DoesNotHold
            };
            (finished(case, &outcome, &verdicts), ending)
        }
    };
    text.push_str(&banner);
    outcome.recorder.show(&text);
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

fn finished(case: &Case, outcome: &Outcome, verdicts: &VerdictTable) -> String {
    let title = match verdicts.failures() {
        0 => "every verdict holds".to_owned(),
        1 => "but 1 verdict does not hold".to_owned(),
        count => format!("but {count} verdicts do not hold"),
    };
    finished_banner(&title, &effort(case, outcome))
}

fn interrupted(case: &Case, stop: &Interruption, outcome: &Outcome) -> String {
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
    interrupted_banner(
        &place,
        &stop.cause.sentence(),
        &resume,
        &effort(case, outcome),
    )
}

/// The refused solves, the first and the last ones if there are many.
fn tried(refusals: &[Refusal]) -> Vec<(&'static str, String)> {
    const FIRST: usize = 1;
    const LAST: usize = 3;
    let show = |refusal: &Refusal| ("tried", refusal.to_string());
    let hidden = refusals.len().saturating_sub(FIRST + LAST);
    if hidden < 2 {
        return refusals.iter().map(show).collect();
    }
    let mut facts: Vec<_> = refusals[..FIRST].iter().map(show).collect();
    facts.push(("", format!("... {hidden} more ...")));
    facts.extend(refusals[FIRST + hidden..].iter().map(show));
    facts
}

fn failed(case: &Case, failure: &Failure, outcome: &Outcome) -> String {
    let place = format!(
        "after step {}, t = {:.4} ms, punch down by {:.4} mm",
        outcome.counts.steps, failure.time, failure.depth
    );
    let mut facts = tried(&failure.refusals);
    facts.push((
        "try",
        "a smaller -dt_max, more -contact_points_per_edge, a larger \
                        -contact_compliance or a finer mesh"
            .to_owned(),
    ));
    if let Some(path) = &failure.checkpoint {
        let advice = format!(
            "with other options for steps and solver, -restart {}",
            path.display()
        );
        facts.push(("resume", advice));
    }
    facts.extend(effort(case, outcome));
    failed_banner(&place, &failure.reason, &facts)
}
