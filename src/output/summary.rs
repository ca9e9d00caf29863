//! `summary.json`: what was run, how it ended and what came out, for people and programs.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use super::folder::SUMMARY;
use super::record::{Badness, COLUMNS, Column};
use super::{OutputError, StepRecord, VerdictTable, atomic};

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Status {
    /// Everything asked for was computed.
    #[serde(rename = "finished")]
    Finished,
    /// The solver gave up; what came before is valid.
    #[serde(rename = "not converged")]
    NotConverged,
    /// Stopped on request (signal, time limit); what came before is valid.
    #[serde(rename = "interrupted")]
    Interrupted,
}

/// What is known about a run that did not finish.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Diagnosis {
    /// The last accepted step, its time and the depth of the punch.
    pub place: String,
    /// Why there is no further step, in a sentence or two.
    pub cause: String,
    /// What was seen in the last solve.
    pub observed: Vec<String>,
    /// The solves that were refused, the first and the last ones.
    pub tried: Vec<String>,
    /// What the user can do, the most promising first.
    pub remedies: Vec<String>,
}

/// Counts over the whole run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Accepted steps.
    pub steps: u64,
    /// Attempts refused and redone with a shorter step.
    pub refused_solves: u64,
    /// Newton iterations of all attempts.
    pub newton_iterations: u64,
    /// Linear systems solved.
    pub linear_solves: u64,
}

/// What is known of the derivatives at the end; the rows are in sensitivity.csv.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SensitivitySummary {
    /// Derivatives of the opening angles, by the names of the angles and of the parameters, degrees per unit of the
    /// parameter; null where there is none.
    pub angles: BTreeMap<String, BTreeMap<&'static str, f64>>,
    /// What limits them, in sentences.
    pub notes: Vec<String>,
    /// Factorisations they took, one a step.
    pub factorisations: u64,
    /// Linear systems solved for them.
    pub linear_solves: u64,
    /// Processor time of all ranks for what all parameters share, s.
    pub shared_cpu_s: f64,
    /// Processor time of all ranks for one parameter, s.
    pub cpu_s_per_parameter: f64,
}

/// The worst value of one certificate over the run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct WorstValue {
    /// The column of the history it comes from.
    pub certificate: &'static str,
    /// The worst value, in the unit of that column.
    pub value: f64,
    /// The step where it occurred, counted from 1.
    pub step: u64,
    /// Its time, ms.
    pub t_ms: f64,
}

/// The columns that are certificates, each with how bad a value is.
fn certificates() -> impl Iterator<Item = (&'static Column, Badness)> {
    COLUMNS
        .iter()
        .filter_map(|column| Some((column, column.certificate?)))
}

/// The worst value of every certificate over the accepted steps, each with its step. A value that is not a number counts
/// as the worst of all. Empty before the first step.
pub fn worst_values(records: &[StepRecord]) -> Vec<WorstValue> {
    let worst = |(column, badness): (&'static Column, Badness)| {
        let how_bad = |value: f64| {
            if value.is_nan() {
                f64::INFINITY
            } else {
                badness(value)
            }
        };
        let mut worst: Option<WorstValue> = None;
        for (step, record) in (1..).zip(records) {
            let value = (column.value)(record);
            if worst.is_none_or(|old| how_bad(value) > how_bad(old.value)) {
                worst = Some(WorstValue {
                    certificate: column.name,
                    value,
                    step,
                    t_ms: record.t_ms,
                });
            }
        }
        worst
    };
    certificates().filter_map(worst).collect()
}

/// What made the result: enough to make it again.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Provenance {
    /// Version of this program.
    pub version: String,
    /// Git revision of its source, with a mark if the source was changed.
    pub git_revision: String,
    /// Version of PETSc.
    pub petsc_version: String,
    /// Number of MPI ranks.
    pub mpi_ranks: u32,
    /// Compiler, profile and the like; nothing that names the machine.
    pub build: BTreeMap<String, String>,
    /// SHA-256 of what the run was made from, by name.
    pub inputs: BTreeMap<String, String>,
    /// Every option of ours, default or not, and those of PETSc's that the user gave.
    pub options: BTreeMap<String, String>,
}

/// What it cost.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Timing {
    /// Processor time of all ranks, s.
    pub cpu_s: f64,
    /// Time on the clock, s.
    pub wall_s: f64,
}

/// The whole summary. Numbers that are not finite become `null` in JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// How the run ended.
    pub status: Status,
    /// Where and why, if it did not finish.
    pub reason: Option<String>,
    /// The same in detail, and what can be done.
    pub diagnosis: Option<Diagnosis>,
    /// What the run says about itself that no verdict says.
    pub notes: Vec<String>,
    /// The last accepted step, if there was one.
    #[serde(rename = "final")]
    pub last: Option<StepRecord>,
    /// Opening angles between the arms by name, degrees.
    pub angles_deg: BTreeMap<String, f64>,
    /// Root mean square distance of the arm from the straight fit of each of these angles, mm.
    pub angle_fit_residuals_mm: BTreeMap<String, f64>,
    /// The derivatives, of a run with `-sensitivity`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sensitivity: Option<SensitivitySummary>,
    /// Counts over the run.
    pub counts: Counts,
    /// Tolerances by name, units in the names.
    pub tolerances: BTreeMap<String, f64>,
    /// Worst certificate values, see [`worst_values`].
    pub worst: Vec<WorstValue>,
    /// The comparison with the references.
    pub verdicts: VerdictTable,
    /// What made it.
    pub provenance: Provenance,
    /// What it cost.
    pub timing: Timing,
}

impl Summary {
    /// How the run ended, in a few words.
    pub fn headline(&self) -> String {
        match (self.status, self.verdicts.failures()) {
            (Status::NotConverged, _) => "FAILED: the run did not finish".to_owned(),
            (Status::Interrupted, _) => {
                "INTERRUPTED: the run is not finished and can go on".to_owned()
            }
            (Status::Finished, 0) => "FINISHED: every verdict holds".to_owned(),
            (Status::Finished, 1) => "FINISHED, but 1 verdict does not hold".to_owned(),
            (Status::Finished, count) => format!("FINISHED, but {count} verdicts do not hold"),
        }
    }

    /// The JSON text, ending with a line break.
    ///
    /// # Errors
    /// [`OutputError::Write`]; it cannot happen with the types above, but nothing here relies on that.
    pub fn json(&self) -> Result<String, OutputError> {
        let text = serde_json::to_string_pretty(self);
        text.map(|text| text + "\n")
            .map_err(|error| OutputError::write(Path::new(SUMMARY), error))
    }

    /// Writes the summary: the file is there in full or not at all.
    ///
    /// # Errors
    /// [`OutputError::Write`].
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), OutputError> {
        atomic::write(path.as_ref(), self.json()?.as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::{Tolerance, VerdictRow};

    fn record(t_ms: f64) -> StepRecord {
        StepRecord {
            t_ms,
            ..StepRecord::default()
        }
    }

    #[test]
    fn the_worst_values_know_their_step() {
        let worst = worst_values(&[
            StepRecord {
                max_penetration_mm: 1e-9,
                min_contact_force_N: 0.5,
                ..record(1.0)
            },
            StepRecord {
                energy_error: -2e-3,
                min_contact_force_N: -0.1,
                ..record(2.0)
            },
            StepRecord {
                energy_error: 1e-3,
                balance_error: f64::NAN,
                ..record(3.0)
            },
            record(4.0),
        ]);
        let at = |name: &str| {
            worst
                .iter()
                .find(|w| w.certificate == name)
                .map(|w| (w.value, w.step))
                .unwrap()
        };
        assert_eq!(at("max_penetration_mm"), (1e-9, 1));
        assert_eq!(at("min_contact_force_N"), (-0.1, 2));
        assert_eq!(at("energy_error"), (-2e-3, 2));
        assert_eq!(at("balance_error").1, 3);
        assert!(worst_values(&[]).is_empty());
    }

    #[test]
    fn the_json_has_what_it_promises() {
        let row = VerdictRow::new(
            "force at d = 20",
            180.6,
            181.0,
            Tolerance::Relative(0.02),
            "N",
            "code_aster",
        );
        let summary = Summary {
            status: Status::NotConverged,
            reason: Some("step 12 at t = 40 ms".into()),
            diagnosis: None,
            notes: Vec::new(),
            last: Some(StepRecord {
                gap_A_mm: f64::NAN,
                force_N: 151.5,
                ..record(40.0)
            }),
            angles_deg: BTreeMap::new(),
            angle_fit_residuals_mm: BTreeMap::new(),
            sensitivity: None,
            counts: Counts {
                steps: 11,
                refused_solves: 6,
                newton_iterations: 80,
                linear_solves: 86,
            },
            tolerances: BTreeMap::from([("residual_mm".into(), 1e-8)]),
            worst: Vec::new(),
            verdicts: VerdictTable { rows: vec![row] },
            provenance: Provenance {
                version: "0.1.0".into(),
                git_revision: "0123abc".into(),
                petsc_version: "3.18.5".into(),
                mpi_ranks: 2,
                build: BTreeMap::new(),
                inputs: BTreeMap::new(),
                options: BTreeMap::from([("friction".into(), "0.1342".into())]),
            },
            timing: Timing {
                cpu_s: 12.5,
                wall_s: 6.5,
            },
        };
        let value: serde_json::Value = serde_json::from_str(&summary.json().unwrap()).unwrap();
        assert_eq!(summary.headline(), "FAILED: the run did not finish");
        assert_eq!(value["status"], "not converged");
        assert_eq!(value["final"]["force_N"], 151.5);
        assert!(value["final"]["gap_A_mm"].is_null());
        assert_eq!(value["verdicts"][0]["verdict"], "holds");
        assert_eq!(value["verdicts"][0]["tolerance"]["relative"], 0.02);
        assert_eq!(value["provenance"]["options"]["friction"], "0.1342");
    }
}
