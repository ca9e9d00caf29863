//! What a run was, as it goes to `summary.json` and the report.

use std::collections::BTreeMap;

use mpi::traits::Communicator;
use petsc::Session;

use super::angles::{NamedAngle, angles};
use super::judgement::{BALANCE_LIMIT, CONE_LIMIT, RESIDUAL_LIMIT, TENSION_LIMIT, WORK_LIMIT};
use super::{inputs, sensitivity};
use crate::case::Case;
use crate::output::VerdictTable;
use crate::output::summary::{Counts, Provenance, Status, Summary, Timing, worst_values};
use crate::run::diagnosis::{diagnose, notes};
use crate::run::error::RunError;
use crate::run::outcome::Outcome;
use crate::run::setup::blas::Blas;
use crate::run::setup::given;

/// The summary of an outcome and its verdicts.
///
/// # Errors
/// If PETSc cannot name its options.
pub(super) fn summarise(
    case: &Case,
    outcome: &Outcome,
    session: &Session,
    comm: &impl Communicator,
    verdicts: VerdictTable,
) -> Result<Summary, RunError> {
    let records = outcome.recorder.records();
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
    let petsc_options = given::by_the_user(case)?;
    Ok(Summary {
        status,
        reason,
        diagnosis: outcome
            .failure
            .as_ref()
            .map(|failure| diagnose(case, failure, outcome.counts.steps))
            .transpose()?,
        notes: notes(case, records),
        last: records.last().copied(),
        angles_deg: by_name(|angle| angle.degrees),
        angle_fit_residuals_mm: by_name(|angle| angle.fit_residual),
        sensitivity: sensitivity::summarise(case, outcome),
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
            (text("residual_mm"), RESIDUAL_LIMIT),
            (text("tensile_force"), TENSION_LIMIT),
            (text("balance"), BALANCE_LIMIT),
            (text("cone"), CONE_LIMIT),
            (text("work"), WORK_LIMIT),
        ]),
        worst: worst_values(records),
        verdicts,
        provenance: provenance(case, outcome, session, comm, petsc_options),
        timing: Timing {
            cpu_s: outcome.cpu_seconds,
            wall_s: outcome.wall_seconds,
        },
    })
}

/// What made the result.
fn provenance(
    case: &Case,
    outcome: &Outcome,
    session: &Session,
    comm: &impl Communicator,
    petsc_options: Vec<(String, String)>,
) -> Provenance {
    let text = |value: &str| value.to_owned();
    Provenance {
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
            .chain(petsc_options)
            .collect(),
    }
}
