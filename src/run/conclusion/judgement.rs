//! What a run is judged by: the reference and regression values of its case, and the certificate of every step.

use crate::case::{self, Case, Dynamics, Instant, Origin, ReferenceValue};
use crate::output::{StepRecord, Tolerance, VerdictRow, VerdictTable};
use crate::run::error::RunError;
use crate::run::ledger::LEAST_FORCE;

/// Largest share by which punch force may differ from die force and inertia.
pub(super) const BALANCE_LIMIT: f64 = 1e-6;
/// Largest excess of friction as a share of the largest friction possible.
pub(super) const CONE_LIMIT: f64 = 1e-6;
/// Largest share of the punch's work by which that of internal, contact and inertia forces may differ from it. The residual's
/// tolerance leaves 1e-5 where the steps are so short that one iteration is enough, and 1e-8 else; what the balance is there
/// to find, a force that is not counted, begins at 1e-3.
pub(super) const WORK_LIMIT: f64 = 1e-4;
/// Largest share of the punch's work by which the energies may differ from it, largest value over largest value: one
/// percent is a usual bound for the time steps of a simulation; steps of the benchmark leave 0.35 %.
pub(super) const ENERGY_LIMIT: f64 = 1e-2;
/// Largest share of kinetic energy in the elastic energy, and of inertia in the punch force, largest value over largest
/// value: a forming simulation with more than five percent is not called quasi-static.
pub(super) const MOTION_LIMIT: f64 = 5e-2;
/// Largest tensile force of a contact point as a share of the punch force: what the residual's tolerance leaves.
pub(super) const TENSION_LIMIT: f64 = 1e-6;

/// Largest residual norm an accepted step may leave, mm: ten times what the default tolerance leaves. Loosened tolerances are
/// found by it, which neither the balance (a sum) nor the work (a difference over a step) shows.
pub(super) const RESIDUAL_LIMIT: f64 = 1e-8;

/// The certificate's limits for every run that got anywhere, and the reference values where the
/// case is the one they belong to.
pub(super) fn judge(
    case: &Case,
    records: &[StepRecord],
    finished: bool,
) -> Result<VerdictTable, RunError> {
    let mut table = VerdictTable::default();
    if finished {
        let values = case.reference_values()?.into_iter();
        for value in values.chain(case.regression_values()?) {
            let row = VerdictRow::new(
                format!("{}, {}", value.quantity, when(&value)),
                computed(case, records, &value),
                value.value,
                match value.tolerance {
                    case::Tolerance::Absolute(distance) => Tolerance::Absolute(distance),
                    case::Tolerance::Relative(share) => Tolerance::Relative(share),
                },
                value.unit,
                value.source,
            );
            table.rows.push(match value.origin {
                Origin::Independent => row,
                Origin::Own => row.regression(),
            });
        }
    }
    if !records.is_empty() {
        table.rows.extend(certificate(case, records));
    }
    Ok(table)
}

/// The worst values of the certificate over all steps, each with its limit.
fn certificate(case: &Case, records: &[StepRecord]) -> Vec<VerdictRow> {
    const SOURCE: &str = "certificate of every step";
    let worst = |badness: fn(&StepRecord) -> f64| {
        // NaN wins: it must not pass as small.
        records
            .iter()
            .map(badness)
            .fold(0.0, |a: f64, b| if b.is_nan() || b > a { b } else { a })
    };
    let limit = |quantity: &str, badness, bound: f64, unit: &str| {
        let most = Tolerance::AtMost;
        VerdictRow::new(quantity, worst(badness), bound, most, unit, SOURCE)
    };
    let mut rows = vec![
        limit(
            "deepest penetration",
            |r| r.max_penetration_mm,
            case.discretisation.penetration_limit,
            "mm",
        ),
        limit(
            "largest tensile force of a contact point, of the punch force",
            |r| -r.min_contact_force_N / r.force_N.max(LEAST_FORCE),
            TENSION_LIMIT,
            "1",
        ),
        limit(
            "punch force less die force and inertia",
            |r| r.balance_error.abs(),
            BALANCE_LIMIT,
            "1",
        ),
        limit(
            "residual norm where Newton stopped",
            |r| r.residual_norm_mm,
            RESIDUAL_LIMIT,
            "mm",
        ),
        limit(
            "punch work less internal, contact and inertia work",
            |r| r.work_error.abs(),
            WORK_LIMIT,
            "1",
        ),
    ];
    // Largest value over largest value: at the first touch anything would be large against nothing.
    let share =
        |quantity: &str, part: fn(&StepRecord) -> f64, of: fn(&StepRecord) -> f64, bound| {
            let (part, of) = (worst(part), worst(of).max(LEAST_FORCE));
            let most = Tolerance::AtMost;
            VerdictRow::new(quantity, part / of, bound, most, "1", SOURCE)
        };
    rows.push(share(
        "punch work less energies and dissipation, of the work",
        |r| r.energy_error.abs() * r.external_work_mJ.abs(),
        |r| r.external_work_mJ.abs(),
        ENERGY_LIMIT,
    ));
    if case.loading.dynamics == Dynamics::Slow {
        rows.push(share(
            "kinetic energy, of the elastic energy",
            |r| r.kinetic_energy_mJ,
            |r| r.strain_energy_mJ,
            MOTION_LIMIT,
        ));
        rows.push(share(
            "inertia force, of the punch force",
            |r| r.inertia_N.abs(),
            |r| r.force_N.abs(),
            MOTION_LIMIT,
        ));
    }
    if case.friction.coefficient > 0.0 {
        rows.push(limit(
            "friction beyond its cone, of the largest",
            |r| r.cone_violation,
            CONE_LIMIT,
            "1",
        ));
    }
    rows
}

fn when(value: &ReferenceValue) -> String {
    match value.when {
        Instant::Travel(depth) => format!("d = {depth} mm"),
        Instant::FullStroke => "full stroke".to_owned(),
        Instant::LargestWhileLoading => "largest while loading".to_owned(),
        Instant::EndOfUnloading => "end of unloading".to_owned(),
        Instant::Withdrawn => "tools withdrawn".to_owned(),
    }
}

/// Our value for a reference value; NaN, which never holds, if there is none.
fn computed(case: &Case, records: &[StepRecord], value: &ReferenceValue) -> f64 {
    let motion = case.loading.motion();
    let quantity = |record: &StepRecord| match value.id.as_str() {
        id if id.starts_with("dy_a_punch") => record.dy_A_punch_mm,
        id if id.starts_with("dy_a_sheet") => record.dy_A_sheet_mm,
        id if id.starts_with("force") => record.force_N,
        id if id.starts_with("angle") => record.angle_deg,
        _ => f64::NAN,
    };
    let at = |time: f64| {
        let record = records
            .iter()
            .find(|record| (record.t_ms - time).abs() < 1e-6);
        record.map_or(f64::NAN, quantity)
    };
    match value.when {
        Instant::Travel(depth) => at(motion.time_at_depth(depth)),
        Instant::FullStroke => at(motion.time_load),
        Instant::EndOfUnloading | Instant::Withdrawn => at(motion.end()),
        Instant::LargestWhileLoading => records
            .iter()
            .take_while(|record| record.t_ms <= motion.time_load)
            .map(quantity)
            .fold(f64::NAN, f64::max),
    }
}
