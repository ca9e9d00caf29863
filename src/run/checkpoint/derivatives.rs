//! The derivatives of a run in its checkpoint: arrays beside the others, and only where there are parameters.

use std::path::Path;

use super::state::RunState;
use crate::case::Case;
use crate::output::{Arrays, OutputError};
use crate::run::error::RestartError;
use crate::sensitivity::{Kept, KeptParameter, ReleasedSlopes};
use crate::system::Snapshot;

/// The array that names the parameters, a line each.
const NAMES: &str = "sensitivity";

/// Refuses a checkpoint that does not have the derivatives the case asks for.
pub(super) fn check(case: &Case, path: &Path, state: &RunState) -> Result<(), RestartError> {
    let wanted = &case.output.sensitivity;
    let found: Vec<&str> = state
        .derivatives
        .iter()
        .flat_map(|kept| kept.parameters.iter().map(|kept| kept.name.as_str()))
        .collect();
    if wanted.is_empty() || *wanted == found {
        return Ok(());
    }
    Err(RestartError::OtherParameters {
        path: path.into(),
        found: if found.is_empty() {
            "none".to_owned()
        } else {
            found.join(",")
        },
    })
}

/// Writes them.
pub(super) fn put(kept: &Kept, to: &Arrays) -> Result<(), OutputError> {
    let names: Vec<&str> = kept.parameters.iter().map(|kept| &kept.name[..]).collect();
    to.put_text(NAMES, &names.join("\n"))?;
    to.put("sensitivity_flowing", &kept.flowing)?;
    to.put("sensitivity_cost", &kept.cost)?;
    to.put("sensitivity_lost", &[u8::from(kept.lost)])?;
    let times: Vec<f64> = kept.released.iter().map(|slopes| slopes.t_ms).collect();
    to.put("sensitivity_released_t", &times)?;
    let angles = kept.released.iter().flat_map(|slopes| &slopes.angles);
    let angles: Vec<f64> = angles.copied().collect();
    to.put("sensitivity_released_angle", &angles)?;
    for kept in &kept.parameters {
        let name = |what: &str| format!("sensitivity_{}_{what}", kept.name);
        to.put(&name("unknowns"), &kept.unknowns)?;
        to.put(&name("velocity"), &kept.velocity)?;
        to.put(&name("acceleration"), &kept.acceleration)?;
        to.put(&name("gauss_points"), &kept.history.gauss_points)?;
        to.put(&name("contact_points"), &kept.history.contact_points)?;
        to.put(&name("friction_work"), &kept.history.friction_work)?;
    }
    Ok(())
}

/// Reads them, if there are any.
pub(super) fn get(from: &Arrays) -> Result<Option<Kept>, OutputError> {
    if !from.has(NAMES) {
        return Ok(None);
    }
    let names = from.get_text(NAMES)?;
    let parameter = |parameter: &str| {
        let name = |what: &str| format!("sensitivity_{parameter}_{what}");
        Ok(KeptParameter {
            name: parameter.to_owned(),
            unknowns: from.get(&name("unknowns"))?,
            velocity: from.get(&name("velocity"))?,
            acceleration: from.get(&name("acceleration"))?,
            history: Snapshot {
                gauss_points: from.get(&name("gauss_points"))?,
                contact_points: from.get(&name("contact_points"))?,
                friction_work: from.get(&name("friction_work"))?,
            },
        })
    };
    let parameters: Vec<KeptParameter> = names
        .lines()
        .map(parameter)
        .collect::<Result<_, OutputError>>()?;
    let times: Vec<f64> = from.get("sensitivity_released_t")?;
    let angles: Vec<f64> = from.get("sensitivity_released_angle")?;
    let [lost] = from.get_exactly::<u8, 1>("sensitivity_lost")?;
    Ok(Some(Kept {
        flowing: from.get("sensitivity_flowing")?,
        cost: from.get_exactly("sensitivity_cost")?,
        lost: lost != 0,
        released: times
            .iter()
            .zip(angles.chunks_exact(parameters.len().max(1)))
            .map(|(&t_ms, angles)| ReleasedSlopes {
                t_ms,
                angles: angles.to_vec(),
            })
            .collect(),
        parameters,
    }))
}
