//! The opening angles of a run.

use crate::case::Case;
use crate::output::StepRecord;
use crate::run::outcome::Outcome;
use crate::text::number;
use crate::tool::PunchMotion;

/// An angle of the run, with a name that says how the tools went away.
pub(super) struct NamedAngle {
    pub name: String,
    pub degrees: f64,
    /// Root mean square distance of the arm from its straight fit, mm.
    pub fit_residual: f64,
}

/// The angles at both ends of the motion as far as it got, and those after the tools vanished.
pub(super) fn angles(case: &Case, outcome: &Outcome) -> Vec<NamedAngle> {
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
        angles.push(NamedAngle {
            name: released_name(&motion, springback.t_ms),
            degrees: springback.released_angle_deg,
            fit_residual: springback.fit_residual_mm,
        });
    }
    angles
}

/// The name of the angle of a sheet whose tools vanished at this time (ms).
pub(super) fn released_name(motion: &PunchMotion, t_ms: f64) -> String {
    format!("tools vanish at {} mm", number(motion.depth(t_ms)))
}
