//! How the derivatives of a run begin and end.

use std::rc::Rc;

use mpi::traits::Communicator;

use super::Simulation;
use super::progress::Progress;
use crate::output::OutputError;
use crate::run::RunError;
use crate::run::checkpoint::Resumed;
use crate::run::outcome::SensitivityEnd;
use crate::run::setup::LinearSolve;
use crate::sensitivity::{Beside, Sensitivity};
use crate::system::MeshOrderError;

impl Simulation {
    /// Lets the derivatives by these parameters be carried along from here. Collective.
    pub(super) fn differentiate(
        &self,
        linear: &LinearSolve,
        beside: Vec<Beside>,
        resumed: Option<&Resumed>,
    ) -> Result<(), RunError> {
        let Some(solve) = linear.condensed().filter(|_| !beside.is_empty()) else {
            return Ok(());
        };
        let progress = &mut *self.progress.borrow_mut();
        let (system, accepted) = (&self.settings.system, &progress.accepted);
        let (history, unknowns) = (&accepted.history, &accepted.unknowns);
        let mut sensitivity =
            Sensitivity::start(system, Rc::clone(solve), beside, history, unknowns)?;
        if let Some((resumed, kept)) = resumed.and_then(|from| Some((from, from.derivatives()?))) {
            sensitivity.put_back(kept).map_err(|error| match error {
                MeshOrderError::Petsc(error) => RunError::from(error),
                MeshOrderError::Size(size) => OutputError::Checkpoint {
                    path: resumed.path.clone(),
                    reason: size.to_string(),
                }
                .into(),
            })?;
        }
        progress.sensitivity = Some(sensitivity);
        Ok(())
    }
}

impl Progress {
    /// What is left of the derivatives. Collective.
    pub fn sensitivity_end(&mut self, comm: &impl Communicator) -> SensitivityEnd {
        let end = |sensitivity: Sensitivity| SensitivityEnd {
            cost: sensitivity.cost().over_ranks(comm),
            released: sensitivity.into_released(),
        };
        self.sensitivity.take().map(end).unwrap_or_default()
    }
}
