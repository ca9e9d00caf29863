//! The derivatives of the angle to which the sheet springs back when the tools vanish.

use petsc::VectorRef;

use super::solve::{Tangent, Wanted};
use super::step::Sensitivity;
use crate::ranks;
use crate::system::{CondensedSolve, EvaluationError, History, System, SystemError};

/// Derivatives of a released angle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReleasedSlopes {
    /// Time at which the tools vanished, ms.
    pub t_ms: f64,
    /// In the order of the parameters, degrees per unit; NaN where there is none.
    pub angles: Vec<f64>,
}

/// A sheet without tools that is at rest, whose material remembers what it did when the tools were there.
pub struct ReleasedState<'a> {
    /// The sheet; point A is held at its height.
    pub system: &'a System,
    /// Solves with its tangent.
    pub solve: &'a CondensedSolve,
    /// Its history.
    pub history: &'a History,
    /// Its displacements.
    pub unknowns: &'a VectorRef,
    /// Time at which the tools vanished, ms.
    pub t_ms: f64,
    /// Whether it came to rest without yielding.
    pub elastic: bool,
}

impl Sensitivity {
    /// Derivatives of the angle of a sheet that was released from the last accepted state. If it yielded until it was at rest there
    /// are none: they would depend on the steps. Collective.
    ///
    /// # Errors
    /// If PETSc fails, or an element cannot be evaluated.
    pub fn release(&mut self, state: &ReleasedState<'_>) -> Result<(), SystemError> {
        let mut angles = vec![f64::NAN; self.tracked.len()];
        if state.elastic && !self.lost {
            self.release_elastically(state, &mut angles)?;
        }
        let t_ms = state.t_ms;
        self.released.push(ReleasedSlopes { t_ms, angles });
        Ok(())
    }

    fn release_elastically(
        &mut self,
        state: &ReleasedState<'_>,
        angles: &mut [f64],
    ) -> Result<(), SystemError> {
        let (system, end) = (state.system, 1.0);
        let comm = system.comm();
        let u = system.local_values(state.unknowns)?;
        let still = vec![0.0; u.len()];
        let mut entries = system.jacobian_entries();
        let evaluated = system.jacobian(state.history, end, state.unknowns, 0.0, &mut entries);
        let failed = match evaluated {
            Err(EvaluationError::Petsc(error)) => return Err(error.into()),
            Err(EvaluationError::Element(_)) => true,
            Ok(()) => false,
        };
        if ranks::lowest_failing(comm, failed).is_some() || !state.solve.factor(&entries, &[])? {
            return Ok(());
        }
        let step = system.local().evaluated(state.history, end, &u, &still);
        let failing = ranks::lowest_failing(comm, step.is_err()).is_some();
        let Some(step) = step.ok().filter(|_| !failing) else {
            return Ok(());
        };
        let tangent = Tangent {
            system,
            entries: &entries,
            solve: state.solve,
            closed: &[],
            scheme: None,
        };
        // The nodes are those of the sheet with its tools, and so is their variation.
        let histories = self.tracked.iter().map(|t| t.history.without_contact());
        let histories: Vec<History> = histories.collect();
        let mut wanted = Vec::with_capacity(histories.len());
        for (tracked, history) in self.tracked.iter().zip(&histories) {
            wanted.push(Wanted {
                unknowns: system.vector()?,
                history,
                tracked,
            });
        }
        self.cost.solves += tangent.solve(&step, &mut wanted)?;
        for (one, angle) in wanted.iter().zip(angles) {
            let du = system.local_values(&one.unknowns)?;
            let slopes = one.tracked.variation.shape_slopes(&step, &du);
            [_, *angle] = slopes.over_ranks(comm);
        }
        Ok(())
    }
}
