//! What the summary says about the derivatives of a run.

use std::collections::BTreeMap;

use super::angles::released_name;
use crate::case::Case;
use crate::output::DerivativeRow;
use crate::output::summary::SensitivitySummary;
use crate::run::outcome::Outcome;

/// None without parameters.
pub(super) fn summarise(case: &Case, outcome: &Outcome) -> Option<SensitivitySummary> {
    let table = outcome.recorder.derivatives();
    if table.parameters.is_empty() {
        return None;
    }
    let motion = case.loading.motion();
    let by_name = |values: Vec<f64>| -> BTreeMap<&'static str, f64> {
        let names = table.parameters.iter().map(|parameter| parameter.name);
        names.zip(values).collect()
    };
    let of_row = |row: &DerivativeRow| {
        let angles = row.by_parameter.iter().map(|slopes| slopes.angle);
        by_name(angles.collect())
    };
    let mut angles = BTreeMap::new();
    for (name, time) in [
        ("full stroke", motion.time_load),
        ("end of the motion", motion.end()),
    ] {
        let mut rows = table.rows.iter();
        if let Some(row) = rows.find(|row| (row.t_ms - time).abs() < 1e-6) {
            angles.insert(name.to_owned(), of_row(row));
        }
    }
    for slopes in &outcome.sensitivity.released {
        let name = released_name(&motion, slopes.t_ms);
        angles.insert(name, by_name(slopes.angles.clone()));
    }
    let [factorisations, linear_solves, shared_cpu_s, all] = outcome.sensitivity.cost;
    Some(SensitivitySummary {
        angles,
        notes: notes(outcome),
        factorisations: factorisations as u64,
        linear_solves: linear_solves as u64,
        shared_cpu_s,
        cpu_s_per_parameter: all / table.parameters.len() as f64,
    })
}

fn notes(outcome: &Outcome) -> Vec<String> {
    let rows = &outcome.recorder.derivatives().rows;
    let count = |holds: fn(&DerivativeRow) -> bool| rows.iter().filter(|row| holds(row)).count();
    let changed = count(|row| row.changed_points > 0);
    let mut notes = vec![format!(
        "in {changed} of {} steps points began or ceased to yield, to touch or to slip: a derivative holds for parameters so \
         near that the same points do so in the same steps",
        rows.len()
    )];
    let doubtful = count(|row| row.doubtful_points > 0);
    if doubtful > 0 {
        notes.push(format!(
            "in {doubtful} steps Gauss points were about to begin or to cease to yield: the derivatives may be one-sided there"
        ));
    }
    let lost = |row: &&DerivativeRow| row.by_parameter.iter().any(|slopes| slopes.force.is_nan());
    if let Some(row) = rows.iter().find(lost) {
        notes.push(format!(
            "from t = {} ms on there are no derivatives: the tangent is singular there, or an element cannot be evaluated",
            row.t_ms
        ));
    }
    let missing = |slopes: &&crate::sensitivity::ReleasedSlopes| {
        slopes.angles.iter().any(|angle| angle.is_nan())
    };
    for slopes in outcome.sensitivity.released.iter().filter(missing) {
        notes.push(format!(
            "the sheet released at t = {} ms has no derivatives: it yielded before it came to rest, or those before were lost",
            slopes.t_ms
        ));
    }
    notes
}
